//! Lights without a surface.

use super::texture::{double, is_raw};
use super::xml::numbers;
use super::{WriteError, Writer};
use crate::{EnvironmentLight, Light};
use glam::{DAffine3, DMat3, DVec3};
use photinus_geometry::Vec3;

impl Writer<'_> {
    /// Writes a light.
    pub(super) fn light(&mut self, light: &Light) -> Result<(), WriteError> {
        match light {
            Light::Point { position, intensity } => {
                self.xml.open("emitter", &[("type", "point")]);
                self.xml.value("point", "position", numbers(position.to_array()));
                self.rgb("intensity", *intensity);
            }
            Light::Spot { position, direction, intensity, cutoff_angle, beam_width } => {
                self.xml.open("emitter", &[("type", "spot")]);
                // Local z is the axis; what is beside it means nothing.
                let z = direction.as_dvec3();
                let other = if z.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
                let x = z.cross(other).normalize_or(DVec3::X);
                let matrix3 = DMat3::from_cols(x, z.cross(x), z);
                self.placement(&DAffine3 { matrix3, translation: position.as_dvec3() });
                self.rgb("intensity", *intensity);
                self.xml.value("float", "cutoff_angle", f64::from(*cutoff_angle).to_degrees());
                self.xml.value("float", "beam_width", f64::from(*beam_width).to_degrees());
            }
            Light::Directional { direction, irradiance } => {
                self.xml.open("emitter", &[("type", "directional")]);
                self.xml.value("vector", "direction", numbers(direction.to_array()));
                self.rgb("irradiance", *irradiance);
            }
            Light::Environment(EnvironmentLight::Constant(radiance)) => {
                self.xml.open("emitter", &[("type", "constant")]);
                self.rgb("radiance", *radiance);
            }
            Light::Environment(EnvironmentLight::Image { bitmap, scale, to_world }) => {
                let picture = self.picture(bitmap, "environment")?;
                self.xml.open("emitter", &[("type", "envmap")]);
                self.xml.value("string", "filename", picture);
                if is_raw(bitmap) && matches!(bitmap.pixels, crate::BitmapPixels::Rgba8 { .. }) {
                    self.xml.value("boolean", "raw", true);
                }
                self.xml.value("float", "scale", scale);
                self.placement(&double(to_world));
            }
        }
        self.xml.close("emitter");
        Ok(())
    }

    fn rgb(&mut self, name: &str, color: Vec3) {
        self.xml.value("rgb", name, numbers(color.to_array()));
    }

    /// A placing transform as a matrix.
    fn placement(&mut self, map: &DAffine3) {
        let (m, t) = (&map.matrix3, map.translation);
        let row = |k: usize| [m.x_axis[k], m.y_axis[k], m.z_axis[k], t[k]];
        let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]];
        self.xml.open("transform", &[("name", "to_world")]);
        self.xml.leaf("matrix", &[("value", &numbers(rows.iter().flatten()))]);
        self.xml.close("transform");
    }
}
