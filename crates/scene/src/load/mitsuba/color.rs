//! Colours that are the same everywhere: RGB, sRGB, spectra, black bodies.

use super::Importer;
use super::props::Props;
use super::tree::NodeId;
use super::value::{parse_f32, parse_f64, parse_list, parse_list_f32, tokens};
use crate::load::{LoadError, Place};
use photinus_geometry::Vec3;
use photinus_image::colour::{SpectrumKind, blackbody_radiance, spectrum_to_rgb, srgb_to_linear};

/// What a colour is used for: a spectrum means different RGB values for light than for a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A share of light from 0 to 1, under the white of sRGB (D65).
    Reflectance,
    /// Light given off.
    Emission,
    /// Any number from 0, such as an index of refraction.
    Unbounded,
}

impl Importer<'_, '_, '_> {
    /// The colour of the value element `id`; none where it is no such element.
    pub(super) fn color_value(&mut self, id: NodeId, role: Role) -> Result<Option<Vec3>, LoadError> {
        let node = self.tree.node(id);
        let place = self.tree.place(id);
        let value = node.attribute("value");
        let color = match (node.tag.as_str(), node.attribute("type")) {
            ("spectrum", Some(_)) => return self.spectrum_object(id, role).map(Some),
            ("float" | "integer", _) => parse_f32(value.unwrap_or_default()).map(Vec3::splat),
            ("rgb", _) => parse_rgb(value.unwrap_or_default()),
            ("srgb", _) => {
                let text = value.unwrap_or_default();
                if text.trim().starts_with('#') { parse_rgb(text) } else { parse_rgb(text).map(decode_srgb) }
            }
            ("spectrum", None) => match (value, node.attribute("filename")) {
                (Some(text), None) => self.spectrum_text(&place, text, role)?,
                (None, Some(name)) => Some(self.spectrum_file(id, name, role)?),
                _ => return Err(LoadError::invalid(place, "<spectrum> has either \"value\" or \"filename\"")),
            },
            ("blackbody", _) => {
                let number = |name| node.attribute(name).map(|t: &str| parse_f64(t.trim_end_matches(['K', 'k'])));
                match (number("temperature"), number("scale").unwrap_or(Some(1.0))) {
                    (Some(Some(kelvin)), Some(scale)) => Some(self.black_body(&place, kelvin, scale)?),
                    _ => None,
                }
            }
            _ => return Ok(None),
        };
        let Some(color) = color.filter(|c| c.is_finite()) else {
            let short: String = value.unwrap_or_default().chars().take(40).collect();
            return Err(LoadError::invalid(place, format!("\"{short}\" is no colour in <{}>", node.tag)));
        };
        Ok(Some(self.in_range(&place, color, role)))
    }

    /// Keeps a colour in the range that its role allows, with a warning.
    fn in_range(&mut self, place: &Place, color: Vec3, role: Role) -> Vec3 {
        let top = if role == Role::Reflectance { Vec3::ONE } else { Vec3::INFINITY };
        let kept = color.clamp(Vec3::ZERO, top);
        if kept != color {
            let range = if role == Role::Reflectance { "0 to 1" } else { "0 up" };
            let [r, g, b] = color.to_array();
            self.context.warn(place, format!("the colour {r} {g} {b} was clamped to {range}"));
        }
        kept
    }

    /// `<spectrum type="...">`, whatever it is called for.
    pub(super) fn spectrum_object(&mut self, id: NodeId, role: Role) -> Result<Vec3, LoadError> {
        let props = self.props(id)?;
        let place = props.place();
        let color = match props.kind() {
            "uniform" | "constant" | "rawconstant" => {
                let value = props.float("value")?.unwrap_or(1.0);
                uniform(value, role)
            }
            "d65" => {
                let scale = props.float("scale")?.unwrap_or(1.0);
                let color = match props.get("color") {
                    Some(id) => self.color_value(id, Role::Unbounded)?.unwrap_or(Vec3::ONE),
                    None => Vec3::ONE,
                };
                color * scale
            }
            "rgb" | "srgb" | "spectrum" => {
                let child = props.get("color").or_else(|| props.get("value"));
                match child {
                    Some(id) if self.tree.node(id).tag == "string" => {
                        let text = self.tree.node(id).attribute("value").unwrap_or_default().to_string();
                        let color = match props.kind() {
                            "spectrum" => self.spectrum_text(&place, &text, role)?,
                            _ => parse_rgb(&text),
                        };
                        color.ok_or_else(|| props.error(format!("\"{text}\" is no colour")))?
                    }
                    Some(id) => self.color_value(id, role)?.unwrap_or(Vec3::ONE),
                    None => return Err(props.error("this colour has no value")),
                }
            }
            "blackbody" => {
                props.ignore(&["wavelength_min", "wavelength_max"]);
                let kelvin = props.float("temperature")?;
                let scale = props.float("scale")?.unwrap_or(1.0);
                let Some(kelvin) = kelvin else { return Err(props.error("a black body needs a temperature")) };
                self.black_body(&place, f64::from(kelvin), f64::from(scale))?
            }
            "regular" => {
                let number = |a: &str, b: &str| Ok::<_, LoadError>(props.float(a)?.or(props.float(b)?));
                let low = f64::from(number("wavelength_min", "lambda_min")?.unwrap_or(360.0));
                let high = f64::from(number("wavelength_max", "lambda_max")?.unwrap_or(830.0));
                let values = number_list(&props, "values")?;
                let step = (high - low) / (values.len().max(2) - 1) as f64;
                let pairs: Vec<_> = values.iter().enumerate().map(|(i, &v)| (low + step * i as f64, v)).collect();
                self.spectrum(&place, &pairs, role)?
            }
            "irregular" => {
                let (lambdas, values) = (number_list(&props, "wavelengths")?, number_list(&props, "values")?);
                if lambdas.len() != values.len() {
                    return Err(props.error("as many values as wavelengths are needed"));
                }
                let pairs: Vec<_> = lambdas.into_iter().zip(values).collect();
                self.spectrum(&place, &pairs, role)?
            }
            other => {
                self.context.warn(&place, format!("unknown spectrum \"{other}\": mid-grey is used"));
                return Ok(Vec3::splat(0.5));
            }
        };
        props.finish(self.context);
        Ok(self.in_range(&place, color, role))
    }

    /// "0.5", "400:0.1, 500:0.2", or the three numbers of an RGB build of Mitsuba 0.x.
    fn spectrum_text(&mut self, place: &Place, text: &str, role: Role) -> Result<Option<Vec3>, LoadError> {
        if !text.contains(':') {
            return Ok(match parse_list_f32(text).as_deref() {
                Some(&[v]) => Some(uniform(v, role)),
                Some(&[r, g, b]) => Some(Vec3::new(r, g, b)),
                _ => None,
            });
        }
        // Blanks may stand after the colon as well as between the pairs.
        let joined = text.split(':').map(str::trim).collect::<Vec<_>>().join(":");
        let pair = |t: &str| t.split_once(':').and_then(|(l, v)| Some((parse_f64(l)?, parse_f64(v)?)));
        match tokens(&joined).map(pair).collect::<Option<Vec<_>>>() {
            Some(pairs) => self.spectrum(place, &pairs, role).map(Some),
            None => Ok(None),
        }
    }

    /// A file of wavelengths in nm and values, one pair a line, # for comments.
    fn spectrum_file(&mut self, id: NodeId, name: &str, role: Role) -> Result<Vec3, LoadError> {
        let place = self.tree.place(id);
        let path = self.context.resolve(&place, name, &self.tree.folders_for(id))?;
        let bytes = self.context.read(&place, &path)?;
        let text = String::from_utf8_lossy(&bytes);
        let mut pairs = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            match parse_list(line).as_deref() {
                Some(&[lambda, value, ..]) => pairs.push((lambda, value)),
                _ => {
                    let message = format!("\"{line}\" is no wavelength and value");
                    return Err(LoadError::invalid(Place::new(path, i as u32 + 1), message));
                }
            }
        }
        self.spectrum(&place, &pairs, role)
    }

    /// RGB of a spectrum given at rising wavelengths in nm.
    fn spectrum(&mut self, place: &Place, pairs: &[(f64, f64)], role: Role) -> Result<Vec3, LoadError> {
        let invalid = |e| LoadError::invalid(place.clone(), format!("{e}: give wavelengths in nm in rising order"));
        if pairs.len() < 2 {
            return Err(LoadError::invalid(place.clone(), "a spectrum needs two or more wavelengths"));
        }
        let rgb = match role {
            Role::Emission => spectrum_to_rgb(pairs, SpectrumKind::Emission).map_err(invalid)?,
            Role::Reflectance => spectrum_to_rgb(pairs, SpectrumKind::Reflectance).map_err(invalid)?,
            Role::Unbounded => {
                // Weighted as a reflectance, but without its limit of 1.
                let top = pairs.iter().fold(1.0, |m: f64, p| m.max(p.1));
                let scaled: Vec<_> = pairs.iter().map(|p| (p.0, p.1 / top)).collect();
                spectrum_to_rgb(&scaled, SpectrumKind::Reflectance)
                    .map_err(invalid)?
                    .map(|c| (f64::from(c) * top) as f32)
            }
        };
        Ok(Vec3::from(rgb))
    }

    /// RGB of a black body's spectral radiance in W/m²/sr/nm times `scale`, as Mitsuba's spectral modes see it.
    fn black_body(&mut self, place: &Place, kelvin: f64, scale: f64) -> Result<Vec3, LoadError> {
        if !(1.0..=1e6).contains(&kelvin) {
            return Err(LoadError::invalid(place.clone(), format!("a temperature of {kelvin} K is out of range")));
        }
        let lambda = (0..=94).map(|i| 360.0 + 5.0 * f64::from(i));
        let pairs: Vec<_> = lambda.map(|nm| (nm, blackbody_radiance(nm, kelvin) * scale)).collect();
        self.spectrum(place, &pairs, Role::Emission)
    }
}

/// RGB of a constant spectrum. As a surface it is neutral; as light it is the equal-energy white E, which is reddish
/// beside the white of sRGB (columns of XYZ to sRGB, IEC 61966-2-1, summed).
fn uniform(value: f32, role: Role) -> Vec3 {
    match role {
        Role::Emission => Vec3::new(1.204_794, 0.948_291, 0.908_916) * value,
        _ => Vec3::splat(value),
    }
}

/// "0.2 0.5 0.3" or "0.5", linear, or "#rrggbb", sRGB.
fn parse_rgb(text: &str) -> Option<Vec3> {
    if let Some(hex) = text.trim().strip_prefix('#') {
        let digits = u32::from_str_radix(hex, 16).ok().filter(|_| hex.len() == 6)?;
        let channel = |shift: u32| ((digits >> shift) & 255) as f32 / 255.0;
        return Some(decode_srgb(Vec3::new(channel(16), channel(8), channel(0))));
    }
    match *parse_list_f32(text)?.as_slice() {
        [v] => Some(Vec3::splat(v)),
        [r, g, b] => Some(Vec3::new(r, g, b)),
        _ => None,
    }
}

fn decode_srgb(c: Vec3) -> Vec3 {
    Vec3::new(srgb_to_linear(c.x), srgb_to_linear(c.y), srgb_to_linear(c.z))
}

fn number_list(props: &Props<'_>, name: &str) -> Result<Vec<f64>, LoadError> {
    let text = props.string(name)?.ok_or_else(|| props.error(format!("this spectrum needs \"{name}\"")))?;
    parse_list(text).ok_or_else(|| props.error(format!("\"{name}\" is no list of numbers")))
}
