//! Integrator, camera and film.

use super::Writer;
use super::xml::numbers;
use crate::{Filter, FovAxis, IntegratorHint, IntegratorKind, Projection};

impl Writer<'_> {
    /// Writes what the scene says of the integrator, if anything.
    pub(super) fn integrator(&mut self) {
        let IntegratorHint { kind, max_depth, hide_emitters } = self.scene.integrator;
        let name = match kind {
            IntegratorKind::Unspecified if max_depth.is_none() && !hide_emitters => return,
            IntegratorKind::Direct => "direct",
            IntegratorKind::Full | IntegratorKind::Unspecified => "path",
        };
        self.xml.open("integrator", &[("type", name)]);
        if kind != IntegratorKind::Direct {
            let depth = max_depth.map_or(-1, i64::from);
            self.xml.value("integer", "max_depth", depth);
        }
        self.xml.value("boolean", "hide_emitters", hide_emitters);
        self.xml.close("integrator");
    }

    /// Writes the camera with its film.
    pub(super) fn sensor(&mut self) {
        let camera = self.scene.camera;
        let kind = match camera.projection {
            Projection::Perspective { .. } => "perspective",
            Projection::ThinLens { .. } => "thinlens",
            Projection::Orthographic { .. } => "orthographic",
        };
        self.xml.open("sensor", &[("type", kind)]);
        let mut scale = [1.0f32, 1.0];
        match camera.projection {
            Projection::Perspective { fov_degrees, axis } => self.field_of_view(fov_degrees, axis),
            Projection::ThinLens { fov_degrees, axis, aperture_radius, focus_distance } => {
                self.field_of_view(fov_degrees, axis);
                self.xml.value("float", "aperture_radius", aperture_radius);
                self.xml.value("float", "focus_distance", focus_distance);
            }
            Projection::Orthographic { half_width } => scale = [half_width; 2],
        }
        if camera.mirrored {
            scale[0] = -scale[0];
        }
        self.xml.value("float", "near_clip", camera.near_clip);
        self.xml.value("float", "far_clip", camera.far_clip);
        for (name, offset) in ["x", "y"].into_iter().zip(camera.principal_point) {
            if offset != 0.0 {
                self.xml.value("float", &format!("principal_point_offset_{name}"), offset);
            }
        }
        self.xml.open("transform", &[("name", "to_world")]);
        if scale != [1.0, 1.0] {
            self.xml.leaf("scale", &[("x", &scale[0].to_string()), ("y", &scale[1].to_string())]);
        }
        let [origin, target, up] = [camera.origin, camera.target, camera.up].map(|v| numbers(v.to_array()));
        self.xml.leaf("lookat", &[("origin", &origin), ("target", &target), ("up", &up)]);
        self.xml.close("transform");
        self.film();
        self.xml.close("sensor");
    }

    fn field_of_view(&mut self, degrees: f32, axis: FovAxis) {
        let name = match axis {
            FovAxis::X => "x",
            FovAxis::Y => "y",
            FovAxis::Diagonal => "diagonal",
            FovAxis::Smaller => "smaller",
            FovAxis::Larger => "larger",
        };
        self.xml.value("float", "fov", degrees);
        self.xml.value("string", "fov_axis", name);
    }

    fn film(&mut self) {
        let film = self.scene.film;
        self.xml.open("film", &[("type", "hdrfilm")]);
        self.xml.value("integer", "width", film.width);
        self.xml.value("integer", "height", film.height);
        if let Some([x, y, width, height]) = film.crop {
            self.xml.value("integer", "crop_offset_x", x);
            self.xml.value("integer", "crop_offset_y", y);
            self.xml.value("integer", "crop_width", width);
            self.xml.value("integer", "crop_height", height);
        }
        match film.filter {
            Filter::Box => self.xml.leaf("rfilter", &[("type", "box")]),
            Filter::CatmullRom => self.xml.leaf("rfilter", &[("type", "catmullrom")]),
            Filter::Tent { radius } => self.filter("tent", &[("radius", radius)]),
            Filter::Gaussian { stddev } => self.filter("gaussian", &[("stddev", stddev)]),
            Filter::Mitchell { b, c } => self.filter("mitchell", &[("B", b), ("C", c)]),
            Filter::Lanczos { lobes } => {
                self.xml.open("rfilter", &[("type", "lanczos")]);
                self.xml.value("integer", "lobes", lobes);
                self.xml.close("rfilter");
            }
        }
        self.xml.close("film");
    }

    fn filter(&mut self, kind: &str, parameters: &[(&str, f32)]) {
        self.xml.open("rfilter", &[("type", kind)]);
        for (name, value) in parameters {
            self.xml.value("float", name, value);
        }
        self.xml.close("rfilter");
    }
}
