//! `<emitter>` at the top of a scene; area lights belong to shapes.

use super::color::Role;
use super::props::Props;
use super::tree::NodeId;
use super::{Importer, names};
use crate::load::{BitmapEncoding, LoadError};
use crate::{Bitmap, BitmapPixels, EnvironmentLight, Light};
use glam::{DAffine3, DVec3};
use photinus_geometry::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

impl<'t> Importer<'t, '_, '_> {
    /// Adds the light of the element `id`.
    pub(super) fn emitter(&mut self, id: NodeId) -> Result<(), LoadError> {
        let props = self.props(id)?;
        props.ignore(&["sampling_weight", "samples"]);
        let light = match props.kind() {
            // Shapes refer to it.
            "area" => return Ok(()),
            "point" => {
                let position = match props.vector("position")? {
                    Some(position) => position,
                    None => self.map(&props)?.translation.as_vec3(),
                };
                let intensity = self.constant_color(&props, "intensity", Role::Emission, 1.0)?;
                Light::Point { position, intensity }
            }
            "spot" => self.spot(&props)?,
            "directional" => {
                let direction = match props.vector("direction")? {
                    Some(direction) => direction.as_dvec3(),
                    None => self.map(&props)?.transform_vector3(DVec3::Z),
                };
                let Some(direction) = unit(direction) else {
                    return Err(props.error("the direction of a directional light must not be zero"));
                };
                let irradiance = self.constant_color(&props, "irradiance", Role::Emission, 1.0)?;
                Light::Directional { direction, irradiance }
            }
            "constant" => {
                let radiance = self.constant_color(&props, "radiance", Role::Emission, 1.0)?;
                Light::Environment(EnvironmentLight::Constant(radiance))
            }
            "envmap" => {
                props.ignore(&["mis_compensation", "cache", "gamma"]);
                Light::Environment(self.environment_map(&props)?)
            }
            kind => {
                self.context.warn(&props.place(), names::refusal("emitter", kind));
                return Ok(());
            }
        };
        let is_environment = |l: &Light| matches!(l, Light::Environment(_));
        if is_environment(&light) && self.draft.lights.iter().any(is_environment) {
            self.context.warn(&props.place(), "a scene has one environment: this second one is ignored");
            return Ok(());
        }
        self.draft.lights.push(light);
        props.finish(self.context);
        Ok(())
    }

    fn map(&mut self, props: &Props<'t>) -> Result<DAffine3, LoadError> {
        Ok(props.transform("to_world", self.context)?.map_or(DAffine3::IDENTITY, |t| t.matrix))
    }

    fn spot(&mut self, props: &Props<'t>) -> Result<Light, LoadError> {
        let map = self.map(props)?;
        let Some(direction) = unit(map.transform_vector3(DVec3::Z)) else {
            return Err(props.error("the transform leaves a spot light without a direction"));
        };
        let cutoff = props.angle("cutoff_angle", 20.0)?;
        let beam = props.angle("beam_width", cutoff * 3.0 / 4.0)?.min(cutoff);
        if props.has("texture") {
            props.ignore(&["texture"]);
            self.context.warn(&props.place_of("texture"), "a spot light projects no texture: ignored");
        }
        Ok(Light::Spot {
            position: map.translation.as_vec3(),
            direction,
            intensity: self.constant_color(props, "intensity", Role::Emission, 1.0)?,
            cutoff_angle: cutoff.to_radians() as f32,
            beam_width: beam.to_radians() as f32,
        })
    }

    fn environment_map(&mut self, props: &Props<'t>) -> Result<EnvironmentLight, LoadError> {
        let map = self.map(props)?;
        let scale = props.float("scale")?.unwrap_or(1.0);
        if scale < 0.0 {
            return Err(props.error("the scale of an environment is negative"));
        }
        let raw = props.boolean("raw")?.unwrap_or(false);
        let encoding = if raw { BitmapEncoding::Raw } else { BitmapEncoding::Auto };
        let bitmap = self.bitmap(props, encoding)?.unwrap_or_else(|| {
            let pixels = BitmapPixels::RgbaF32(vec![[0.5, 0.5, 0.5, 1.0]]);
            Arc::new(Bitmap { width: 1, height: 1, pixels })
        });
        let m = map.matrix3;
        let to_world = Affine3A::from_mat3_translation(
            Mat3::from_cols(m.x_axis.as_vec3(), m.y_axis.as_vec3(), m.z_axis.as_vec3()),
            map.translation.as_vec3(),
        );
        if to_world.matrix3.determinant() == 0.0 {
            return Err(props.error("the transform of an environment is flat"));
        }
        Ok(EnvironmentLight::Image { bitmap, scale, to_world })
    }
}

/// The direction of a vector, none for zero; what is of unit length to single precision keeps its bits.
fn unit(v: DVec3) -> Option<Vec3> {
    let given = v.as_vec3();
    if (given.length_squared() - 1.0).abs() < 1e-6 { Some(given) } else { Some(v.try_normalize()?.as_vec3()) }
}
