//! `<sensor>`.

use super::props::Props;
use super::tree::NodeId;
use super::value::parse_f64;
use super::{Importer, names};
use crate::load::LoadError;
use crate::{Camera, FovAxis, Projection};
use glam::DVec3;
use photinus_geometry::Vec3;

impl<'t> Importer<'t, '_, '_> {
    /// Sets the camera and the film from the element `id`.
    pub(super) fn sensor(&mut self, id: NodeId) -> Result<(), LoadError> {
        let props = self.props(id)?;
        let films = props.objects("film");
        if let Some(&(_, film)) = films.first() {
            self.draft.film = Some(self.film(film)?);
        }
        // How many samples are taken, and when the shutter is open, is the command line's to say.
        props.objects("sampler");
        props.ignore(&["shutter_open", "shutter_close", "srf", "keyframes", "fov_axis_compat"]);
        for (_, id) in props.objects("medium") {
            self.context.warn(&self.tree.place(id), "media are not rendered: ignored");
        }
        if !names::is_supported("sensor", props.kind()) {
            self.context.warn(&props.place(), names::refusal("sensor", props.kind()));
            return Ok(());
        }
        let camera = self.camera(&props)?;
        props.finish(self.context);
        self.draft.camera = Some(camera);
        Ok(())
    }

    fn camera(&mut self, props: &Props<'t>) -> Result<Camera, LoadError> {
        let transform = props.transform("to_world", self.context)?.unwrap_or(super::transform::Transform::IDENTITY);
        let m = transform.matrix.matrix3;
        let (Some(forward), Some(up)) = (m.z_axis.try_normalize(), m.y_axis.try_normalize()) else {
            return Err(props.error("the transform leaves the camera without a view"));
        };
        if forward.cross(up).length() < 1e-9 || m.determinant() == 0.0 {
            return Err(props.error("the transform leaves the camera without a view"));
        }
        let near_clip = props.float("near_clip")?.unwrap_or(1e-2);
        let far_clip = props.float("far_clip")?.unwrap_or(1e4);
        if !(near_clip > 0.0 && near_clip < far_clip) {
            return Err(props.error("near_clip has to be above 0 and below far_clip"));
        }
        let focus_distance = props.float("focus_distance")?;
        let projection = match props.kind() {
            "orthographic" => {
                let (x, y) = (m.x_axis.length(), m.y_axis.length());
                if (x / y - 1.0).abs() > 1e-4 {
                    let message = "the camera's transform scales x and y differently: the width counts";
                    self.context.warn(&props.place(), message);
                }
                let half_width = transform.lookat.map_or(x as f32, |v| v.scale.x.abs());
                Projection::Orthographic { half_width }
            }
            kind => {
                self.warn_about_scale(props, [m.x_axis, m.y_axis, m.z_axis]);
                let (fov_degrees, axis) = self.field_of_view(props)?;
                if kind == "perspective" {
                    Projection::Perspective { fov_degrees, axis }
                } else {
                    let Some(aperture_radius) = props.float("aperture_radius")? else {
                        return Err(props.error("a thinlens camera needs an \"aperture_radius\""));
                    };
                    let focus_distance = focus_distance.unwrap_or(far_clip);
                    if !(aperture_radius >= 0.0 && focus_distance > 0.0) {
                        return Err(props.error("aperture_radius has to be 0 or more, focus_distance above 0"));
                    }
                    Projection::ThinLens { fov_degrees, axis, aperture_radius, focus_distance }
                }
            }
        };
        let offset = |name: &str| Ok::<f32, LoadError>(props.float(name)?.unwrap_or(0.0));
        let principal_point = [offset("principal_point_offset_x")?, offset("principal_point_offset_y")?];
        let (origin, target, up) = match transform.lookat {
            Some(view) => (view.origin, view.target, view.up),
            None => {
                let origin = transform.matrix.translation;
                (origin.as_vec3(), (origin + forward).as_vec3(), up.as_vec3())
            }
        };
        if !(origin.is_finite() && (target - origin).length() > 0.0) {
            return Err(props.error("the camera stands beyond all bounds"));
        }
        let up = if transform.lookat.is_some() && up == Vec3::ZERO { m.y_axis.as_vec3() } else { up };
        Ok(Camera {
            origin,
            target,
            up,
            mirrored: m.determinant() < 0.0,
            projection,
            principal_point,
            near_clip,
            far_clip,
        })
    }

    /// Mitsuba refuses scale in a perspective camera; only mirrors mean something.
    fn warn_about_scale(&mut self, props: &Props<'t>, axes: [DVec3; 3]) {
        if axes.iter().any(|a| (a.length() - 1.0).abs() > 1e-3) {
            self.context.warn(&props.place(), "the camera's transform scales: ignored");
        }
    }

    /// Opening angle in degrees and its axis; 50 mm on 35 mm film where nothing is said.
    fn field_of_view(&mut self, props: &Props<'t>) -> Result<(f32, FovAxis), LoadError> {
        let axis = match props.choice("fov_axis")?.as_deref() {
            None | Some("x") => FovAxis::X,
            Some("y") => FovAxis::Y,
            Some("diagonal") => FovAxis::Diagonal,
            Some("smaller") => FovAxis::Smaller,
            Some("larger") => FovAxis::Larger,
            Some(other) => {
                let message = format!("unknown fov_axis \"{other}\": use x, y, diagonal, smaller or larger");
                return Err(LoadError::invalid(props.place_of("fov_axis"), message));
            }
        };
        if let Some(fov) = props.float("fov")? {
            if props.has("focal_length") {
                props.ignore(&["focal_length"]);
                self.context.warn(&props.place_of("focal_length"), "fov is given: focal_length is ignored");
            }
            if !(fov > 0.0 && fov < 180.0) {
                return Err(LoadError::invalid(
                    props.place_of("fov"),
                    format!("the fov {fov} is not between 0 and 180"),
                ));
            }
            return Ok((fov, axis));
        }
        let text = props.string("focal_length")?.unwrap_or("50mm");
        let millimetres = parse_f64(text.trim().trim_end_matches("mm")).filter(|&v| v > 0.0);
        let Some(millimetres) = millimetres else {
            let message = format!("the focal length \"{text}\" is not of the form 50mm");
            return Err(LoadError::invalid(props.place_of("focal_length"), message));
        };
        let diagonal = f64::from(36 * 36 + 24 * 24).sqrt();
        let fov = 2.0 * libm::atan(diagonal / (2.0 * millimetres)).to_degrees();
        Ok((fov as f32, FovAxis::Diagonal))
    }
}
