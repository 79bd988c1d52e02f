//! The statements of a material library.

use super::super::text::{Fault, Text, is, name, parse_f32, quoted};
use photinus_geometry::Vec3;

/// A material as its library has it: what is not said is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RawMaterial {
    pub(crate) name: String,
    /// Line of `newmtl`.
    pub(crate) line: u32,
    /// Ambient, diffuse, specular, emitted and filter colours.
    pub(crate) ka: Option<Vec3>,
    pub(crate) kd: Option<Vec3>,
    pub(crate) ks: Option<Vec3>,
    pub(crate) ke: Option<Vec3>,
    pub(crate) tf: Option<Vec3>,
    /// Phong exponent, index of refraction, opacity, transparency.
    pub(crate) ns: Option<f32>,
    pub(crate) ni: Option<f32>,
    pub(crate) d: Option<f32>,
    pub(crate) tr: Option<f32>,
    pub(crate) illum: Option<u32>,
    /// Roughness, metalness, sheen, clear coat and its roughness, anisotropy and its rotation.
    pub(crate) pr: Option<f32>,
    pub(crate) pm: Option<f32>,
    pub(crate) ps: Option<f32>,
    pub(crate) pc: Option<f32>,
    pub(crate) pcr: Option<f32>,
    pub(crate) aniso: Option<f32>,
    pub(crate) anisor: Option<f32>,
    /// Pictures, by statement.
    pub(crate) maps: Vec<(MapKind, MapRef)>,
}

impl RawMaterial {
    /// The picture of this kind that was named last.
    pub(crate) fn map(&self, kind: MapKind) -> Option<&MapRef> {
        self.maps.iter().rev().find(|(k, _)| *k == kind).map(|(_, m)| m)
    }
}

/// What a picture is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MapKind {
    Diffuse,
    Specular,
    Emission,
    Opacity,
    Bump,
    Normal,
    Roughness,
    Metallic,
    Sheen,
    /// Named and not used: the statement's own word is in [`MapRef::statement`].
    Unused,
}

/// A picture and how it lies on the surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MapRef {
    pub(crate) line: u32,
    pub(crate) statement: String,
    pub(crate) file: String,
    /// `-o`: added to (u, v).
    pub(crate) offset: [f32; 2],
    /// `-s`: factor on (u, v).
    pub(crate) scale: [f32; 2],
    /// `-clamp on`: the border goes on outside the unit square.
    pub(crate) clamp: bool,
    /// `-bm`: factor on heights.
    pub(crate) bump_multiplier: f32,
    /// `-mm`: added to and factor on the values.
    pub(crate) base: f32,
    pub(crate) gain: f32,
    /// `-imfchan m`: the alpha channel holds the values.
    pub(crate) alpha: bool,
}

/// A library: its materials in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RawLibrary {
    pub(crate) materials: Vec<RawMaterial>,
    /// The file says that Blender wrote it.
    pub(crate) from_blender: bool,
    /// What was read otherwise than written.
    pub(crate) notes: Vec<Fault>,
}

/// Most materials of a library, and most faults that are noted.
const MAX_MATERIALS: usize = 1 << 16;
const MAX_NOTES: usize = 1000;

/// Reads a material library; nothing in it is bad enough to refuse it.
pub(crate) fn parse(bytes: &[u8]) -> RawLibrary {
    let bytes = super::super::text::decode(bytes);
    let first_line = bytes.split(|&b| b == b'\n').find(|l| !l.trim_ascii().is_empty()).unwrap_or_default();
    let mut library = RawLibrary { from_blender: first_line.starts_with(b"# Blender"), ..RawLibrary::default() };
    let mut text = Text::new(&bytes);
    while !text.is_at_end() {
        if let Some(keyword) = text.word() {
            statement(keyword, &mut text, &mut library);
        }
        text.next_line();
    }
    library
}

fn statement(keyword: &[u8], text: &mut Text<'_>, library: &mut RawLibrary) {
    let line = text.line();
    let key = keyword.to_ascii_lowercase();
    // A file of nothing but faults must not become a list of as many.
    library.notes.truncate(MAX_NOTES);
    if key == b"newmtl" {
        let name = name(text.rest_of_line());
        if library.materials.len() >= MAX_MATERIALS {
            library.notes.push(Fault::new(line, format!("more than {MAX_MATERIALS} materials: the rest is ignored")));
            return;
        }
        library.materials.push(RawMaterial { name, line, ..RawMaterial::default() });
        return;
    }
    let RawLibrary { materials, notes, .. } = library;
    let Some(m) = materials.last_mut() else {
        notes.push(Fault::new(line, format!("{} before the first newmtl: ignored", quoted(keyword))));
        return;
    };
    match key.as_slice() {
        b"ka" => m.ka = color(text, notes).or(m.ka),
        b"kd" => m.kd = color(text, notes).or(m.kd),
        b"ks" => m.ks = color(text, notes).or(m.ks),
        b"ke" => m.ke = color(text, notes).or(m.ke),
        b"tf" => m.tf = color(text, notes).or(m.tf),
        b"ns" => m.ns = number(text, notes).or(m.ns),
        b"ni" => m.ni = number(text, notes).or(m.ni),
        b"d" => m.d = dissolve(text, notes).or(m.d),
        b"tr" => m.tr = number(text, notes).or(m.tr),
        b"illum" => m.illum = number(text, notes).map(|x| x as u32).or(m.illum),
        b"pr" => m.pr = number(text, notes).or(m.pr),
        b"pm" => m.pm = number(text, notes).or(m.pm),
        b"ps" => m.ps = number(text, notes).or(m.ps),
        b"pc" => m.pc = number(text, notes).or(m.pc),
        b"pcr" => m.pcr = number(text, notes).or(m.pcr),
        b"aniso" => m.aniso = number(text, notes).or(m.aniso),
        b"anisor" => m.anisor = number(text, notes).or(m.anisor),
        b"sharpness" => {}
        _ => match map_kind(&key) {
            Some(kind) => match map(keyword, text, notes) {
                Some(map) => m.maps.push((kind, map)),
                None => notes.push(Fault::new(line, format!("{} names no file: ignored", quoted(keyword)))),
            },
            None => notes.push(Fault::new(line, format!("unknown statement {}: ignored", quoted(keyword)))),
        },
    }
}

fn map_kind(key: &[u8]) -> Option<MapKind> {
    Some(match key {
        b"map_kd" => MapKind::Diffuse,
        b"map_ks" => MapKind::Specular,
        b"map_ke" => MapKind::Emission,
        b"map_d" => MapKind::Opacity,
        b"map_bump" | b"bump" => MapKind::Bump,
        b"norm" | b"map_norm" | b"map_kn" => MapKind::Normal,
        b"map_pr" => MapKind::Roughness,
        b"map_pm" => MapKind::Metallic,
        b"map_ps" => MapKind::Sheen,
        b"map_ka" | b"map_ns" | b"map_tr" | b"map_tf" | b"map_ni" | b"map_rma" | b"map_orm" | b"map_pc"
        | b"map_pcr" | b"map_aat" | b"map_opacity" | b"disp" | b"map_disp" | b"decal" | b"refl" | b"map_refl" => {
            MapKind::Unused
        }
        _ => return None,
    })
}

/// `r [g b]`, or `xyz x [y z]`; a spectral file is not read.
fn color(text: &mut Text<'_>, notes: &mut Vec<Fault>) -> Option<Vec3> {
    let line = text.line();
    let mut word = text.word();
    let xyz = word.is_some_and(|w| is(w, "xyz"));
    if word.is_some_and(|w| is(w, "spectral")) {
        notes.push(Fault::new(line, "colours from spectral files are not read: ignored"));
        return None;
    }
    if xyz {
        word = text.word();
    }
    let mut c = [0.0f32; 3];
    let mut count = 0;
    while count < 3 {
        let Some(w) = word else { break };
        match parse_f32(w) {
            Some(x) if x.is_finite() => c[count] = x,
            _ => {
                notes.push(Fault::new(line, format!("{} is not a finite number: ignored", quoted(w))));
                return None;
            }
        }
        count += 1;
        word = if count < 3 { text.word().filter(|w| !w.starts_with(b"#")) } else { None };
    }
    let c = match count {
        0 => {
            notes.push(Fault::new(line, "a colour needs a number: ignored"));
            return None;
        }
        1 => Vec3::splat(c[0]),
        _ => Vec3::from_array(c),
    };
    Some(if xyz { xyz_to_rgb(c) } else { c }.max(Vec3::ZERO))
}

/// CIE XYZ to linear sRGB (IEC 61966-2-1).
fn xyz_to_rgb(c: Vec3) -> Vec3 {
    Vec3::new(
        3.240_97 * c.x - 1.537_383_2 * c.y - 0.498_610_76 * c.z,
        -0.969_243_64 * c.x + 1.875_967_5 * c.y + 0.041_555_06 * c.z,
        0.055_630_08 * c.x - 0.203_976_96 * c.y + 1.056_971_5 * c.z,
    )
}

fn number(text: &mut Text<'_>, notes: &mut Vec<Fault>) -> Option<f32> {
    let line = text.line();
    let word = text.word().unwrap_or_default();
    let value = parse_f32(word).filter(|x| x.is_finite());
    if value.is_none() {
        notes.push(Fault::new(line, format!("{} is not a finite number: ignored", quoted(word))));
    }
    value
}

/// `d x`, or `d -halo x`, which depends on the view and is read as plain.
fn dissolve(text: &mut Text<'_>, notes: &mut Vec<Fault>) -> Option<f32> {
    let before = text.clone();
    if text.word().is_some_and(|w| is(w, "-halo")) {
        notes.push(Fault::new(text.line(), "-halo is not supported: read as a plain dissolve"));
    } else {
        *text = before;
    }
    number(text, notes)
}

/// Options in front of or behind a file name, which may hold blanks.
fn map(statement: &[u8], text: &mut Text<'_>, notes: &mut Vec<Fault>) -> Option<MapRef> {
    let mut map = MapRef {
        line: text.line(),
        statement: name(statement),
        file: String::new(),
        offset: [0.0; 2],
        scale: [1.0; 2],
        clamp: false,
        bump_multiplier: 1.0,
        base: 0.0,
        gain: 1.0,
        alpha: false,
    };
    let rest = text.rest_of_line();
    let mut words = Words { bytes: rest, at: 0 };
    let mut file: Option<(usize, usize)> = None;
    while let Some((start, word)) = words.next() {
        if let Some(arguments) = option_arguments(word) {
            option(&mut map, word, arguments, &mut words, notes);
        } else {
            let end = start + word.len();
            file = Some((file.map_or(start, |f| f.0), end));
        }
    }
    let (start, end) = file?;
    map.file = name(rest[start..end].trim_ascii()).trim_matches('"').to_owned();
    (!map.file.is_empty()).then_some(map)
}

/// Words of a line with their positions.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<(usize, &'a [u8])> {
        let blank = |b: &u8| b.is_ascii_whitespace();
        let start = self.at + self.bytes[self.at..].iter().position(|b| !blank(b))?;
        let end = self.bytes[start..].iter().position(blank).map_or(self.bytes.len(), |n| start + n);
        self.at = end;
        Some((start, &self.bytes[start..end]))
    }

    /// The next word if it is a number.
    fn number(&mut self) -> Option<f32> {
        let before = self.at;
        let value = self.next().and_then(|(_, w)| parse_f32(w)).filter(|x| x.is_finite());
        if value.is_none() {
            self.at = before;
        }
        value
    }
}

/// What an option is followed by.
#[derive(Clone, Copy)]
enum Arguments {
    Word,
    Numbers(usize),
}

fn option_arguments(word: &[u8]) -> Option<Arguments> {
    Some(match word.to_ascii_lowercase().as_slice() {
        b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan" | b"-type" => Arguments::Word,
        b"-bm" | b"-boost" | b"-texres" => Arguments::Numbers(1),
        b"-mm" => Arguments::Numbers(2),
        b"-o" | b"-s" | b"-t" => Arguments::Numbers(3),
        _ => return None,
    })
}

fn option(map: &mut MapRef, word: &[u8], arguments: Arguments, words: &mut Words<'_>, notes: &mut Vec<Fault>) {
    let key = word.to_ascii_lowercase();
    match arguments {
        Arguments::Word => {
            let value = words.next().map(|(_, w)| w).unwrap_or_default();
            match key.as_slice() {
                b"-clamp" => map.clamp = is(value, "on"),
                b"-imfchan" => map.alpha = is(value, "m"),
                b"-type" => {
                    notes.push(Fault::new(map.line, format!("{} {}: ignored", name(word), name(value))));
                }
                // Blending between texels is always on; colour correction is not defined by the format.
                _ => {}
            }
        }
        Arguments::Numbers(most) => {
            let numbers: Vec<f32> = std::iter::from_fn(|| words.number()).take(most).collect();
            let or = |i: usize, default: f32| numbers.get(i).copied().unwrap_or(default);
            match key.as_slice() {
                b"-bm" => map.bump_multiplier = or(0, 1.0),
                b"-mm" => (map.base, map.gain) = (or(0, 0.0), or(1, 1.0)),
                b"-o" => map.offset = [or(0, 0.0), or(1, 0.0)],
                b"-s" => map.scale = [or(0, 1.0), or(1, 1.0)],
                b"-t" if numbers.iter().any(|&x| x != 0.0) => {
                    notes.push(Fault::new(map.line, "turbulence (-t) is not supported: ignored"));
                }
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_stand_before_or_after_names_with_blanks() {
        let library = parse(
            b"newmtl a\nmap_Kd -o 0.1 -s 2 3 4 my texture 01.png\nbump -imfchan m b 2.png -bm 1.5\n\
              map_Ks -mm 0.1 0.3 s.jpg # not a comment\nmap_d -clamp on \"q d.png\"\nmap_Ke -o 1 2 3 4.png\nnorm\n",
        );
        let m = &library.materials[0];
        let kd = m.map(MapKind::Diffuse).unwrap();
        assert_eq!((kd.file.as_str(), kd.offset, kd.scale), ("my texture 01.png", [0.1, 0.0], [2.0, 3.0]));
        let bump = m.map(MapKind::Bump).unwrap();
        assert_eq!((bump.file.as_str(), bump.bump_multiplier, bump.alpha), ("b 2.png", 1.5, true));
        let ks = m.map(MapKind::Specular).unwrap();
        assert_eq!((ks.base, ks.gain), (0.1, 0.3));
        let d = m.map(MapKind::Opacity).unwrap();
        assert_eq!((d.file.as_str(), d.clamp), ("q d.png", true));
        assert_eq!(m.map(MapKind::Emission).unwrap().file, "4.png");
        assert_eq!(library.notes, [Fault::new(7, "\"norm\" names no file: ignored")]);
    }

    #[test]
    fn colours_and_numbers() {
        let library = parse(
            b"Kd 1 1 1\nnewmtl \xd0\x9c 1\r\nKd 0.5 # grey\r\nkS 0.1 0.2 0.3 # c\nKe xyz 0.9505 1 1.089\nKa nan 1 1\n\
              Tf spectral f.rfl\nNs 1e2\nd -halo 0.5\nillum 7\nfoo 1\n",
        );
        let m = &library.materials[0];
        assert_eq!((m.name.as_str(), m.line), ("М 1", 2));
        assert_eq!((m.kd, m.ks, m.ka, m.tf), (Some(Vec3::splat(0.5)), Some(Vec3::new(0.1, 0.2, 0.3)), None, None));
        assert!((m.ke.unwrap() - 1.0).abs().max_element() < 1e-3, "white is white: {:?}", m.ke);
        assert_eq!((m.ns, m.d, m.illum), (Some(100.0), Some(0.5), Some(7)));
        let lines: Vec<u32> = library.notes.iter().map(|n| n.line).collect();
        assert_eq!(lines, [1, 6, 7, 9, 11]);
    }
}
