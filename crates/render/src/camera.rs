//! Cameras: rays through pixels, with the width of a pixel along them.

use photinus_geometry::{Ray, Vec3};
use photinus_num::Sampler;
use photinus_scene::{Camera, FilmSettings, FovAxis, Projection};

/// A ray from the camera, with the cone of the pixel that it stands for.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The ray, of unit direction.
    pub ray: Ray,
    /// Width of the pixel's cone at the origin, in scene units.
    pub width: f32,
    /// Growth of the width with distance.
    pub spread: f32,
}

/// A camera fitted to a film.
#[derive(Clone, Debug)]
pub struct CameraModel {
    origin: Vec3,
    view: Vec3,
    right: Vec3,
    up: Vec3,
    /// From pixels on the film to its place at unit distance (at any distance for parallel rays): factor and offset.
    across: [f32; 2],
    down: [f32; 2],
    lens_radius: f32,
    focus_distance: f32,
    parallel: bool,
    clip: [f32; 2],
}

impl CameraModel {
    /// The camera for a film; a view without direction or with a parallel up falls back to axes that work.
    pub fn new(camera: &Camera, film: &FilmSettings) -> Self {
        let view = (camera.target - camera.origin).try_normalize().unwrap_or(Vec3::NEG_Z);
        let right = view
            .cross(camera.up)
            .try_normalize()
            .or_else(|| view.cross(Vec3::Y).try_normalize())
            .unwrap_or_else(|| view.any_orthonormal_vector());
        let up = right.cross(view);
        let right = if camera.mirrored { -right } else { right };
        let (width, height) = (film.width as f32, film.height as f32);
        let aspect = width / height;
        let half_from_fov = |degrees: f32, axis: FovAxis| {
            let tangent = libm::tanf(0.5 * degrees.clamp(1e-3, 179.9).to_radians());
            let half_width = match axis {
                FovAxis::X => tangent,
                FovAxis::Y => tangent * aspect,
                FovAxis::Diagonal => tangent * aspect / (1.0 + aspect * aspect).sqrt(),
                FovAxis::Smaller => tangent * aspect.max(1.0),
                FovAxis::Larger => tangent * aspect.min(1.0),
            };
            [half_width, half_width / aspect]
        };
        let (half, lens_radius, focus_distance, parallel) = match camera.projection {
            Projection::Perspective { fov_degrees, axis } => (half_from_fov(fov_degrees, axis), 0.0, 1.0, false),
            Projection::ThinLens { fov_degrees, axis, aperture_radius, focus_distance } => {
                (half_from_fov(fov_degrees, axis), aperture_radius, focus_distance, false)
            }
            Projection::Orthographic { half_width } => ([half_width, half_width / aspect], 0.0, 1.0, true),
        };
        let shift = camera.principal_point;
        Self {
            origin: camera.origin,
            view,
            right,
            up,
            across: [2.0 * half[0] / width, (2.0 * shift[0] - 1.0) * half[0]],
            down: [-2.0 * half[1] / height, (1.0 - 2.0 * shift[1]) * half[1]],
            lens_radius,
            focus_distance,
            parallel,
            clip: [camera.near_clip, camera.far_clip],
        }
    }

    /// The ray through a point of the film, in pixels from its upper left corner. Draws from `sampler` only where the
    /// lens has a size.
    pub fn ray(&self, film: [f32; 2], sampler: &mut Sampler) -> CameraRay {
        let x = film[0] * self.across[0] + self.across[1];
        let y = film[1] * self.down[0] + self.down[1];
        let pixel = self.across[0];
        if self.parallel {
            let origin = self.origin + self.right * x + self.up * y;
            let ray = Ray { origin, t_min: self.clip[0], dir: self.view, t_max: self.clip[1] };
            return CameraRay { ray, width: pixel, spread: 0.0 };
        }
        let towards = self.view + self.right * x + self.up * y;
        let (origin, towards) = if self.lens_radius > 0.0 {
            let [dx, dy] = uniform_disk(sampler.next_2d());
            let lens = (self.right * dx + self.up * dy) * self.lens_radius;
            (self.origin + lens, towards * self.focus_distance - lens)
        } else {
            (self.origin, towards)
        };
        let dir = towards.normalize();
        let cos = dir.dot(self.view).max(1e-6);
        let inv_cos = 1.0 / cos;
        let ray = Ray { origin, t_min: self.clip[0] * inv_cos, dir, t_max: self.clip[1] * inv_cos };
        CameraRay { ray, width: 0.0, spread: pixel * cos }
    }
}

/// A point of the unit disc from a point of the unit square (Shirley and Chiu, "A Low Distortion Map Between Disk and
/// Square", JGT 1997). Angles are measured from the nearer axis.
#[inline]
pub(crate) fn uniform_disk(u: [f32; 2]) -> [f32; 2] {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    let along_x = a.abs() > b.abs();
    let (radius, other) = if along_x { (a, b) } else { (b, a) };
    if radius == 0.0 {
        return [0.0, 0.0];
    }
    let (sin, cos) = libm::sincosf(std::f32::consts::FRAC_PI_4 * (other / radius));
    let (near, far) = (radius * cos, radius * sin);
    if along_x { [near, far] } else { [far, near] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::StreamKind;
    use photinus_scene::Filter;

    fn camera(projection: Projection) -> Camera {
        Camera {
            origin: Vec3::new(1.0, 2.0, 3.0),
            target: Vec3::new(1.0, 2.0, -3.0),
            up: Vec3::Y,
            mirrored: false,
            projection,
            principal_point: [0.0; 2],
            near_clip: 0.0,
            far_clip: f32::INFINITY,
        }
    }

    fn film() -> FilmSettings {
        FilmSettings { width: 200, height: 100, crop: None, filter: Filter::Box }
    }

    #[test]
    fn picture_right_is_view_cross_up_and_rows_run_down() {
        let model = CameraModel::new(&camera(Projection::Perspective { fov_degrees: 90.0, axis: FovAxis::X }), &film());
        let mut s = Sampler::new(0, StreamKind::Test, 0, 0);
        let middle = model.ray([100.0, 50.0], &mut s).ray.dir;
        assert!((middle - Vec3::NEG_Z).length() < 1e-6);
        let right = model.ray([200.0, 50.0], &mut s).ray.dir;
        assert!((right - Vec3::new(1.0, 0.0, -1.0).normalize()).length() < 1e-6, "{right}");
        let top = model.ray([100.0, 0.0], &mut s).ray.dir;
        assert!((top - Vec3::new(0.0, 0.5, -1.0).normalize()).length() < 1e-6, "{top}");
    }

    #[test]
    fn a_lens_keeps_the_plane_of_focus_sharp() {
        let projection =
            Projection::ThinLens { fov_degrees: 60.0, axis: FovAxis::X, aperture_radius: 0.3, focus_distance: 4.0 };
        let model = CameraModel::new(&camera(projection), &film());
        let mut first = None;
        for i in 0..32 {
            let mut s = Sampler::new(9, StreamKind::Test, 0, i);
            let ray = model.ray([150.0, 20.0], &mut s).ray;
            let t = (-1.0 - ray.origin.z) / ray.dir.z;
            let p = ray.at(t);
            let expected = *first.get_or_insert(p);
            assert!((p - expected).length() < 1e-5, "{p} {expected}");
        }
    }

    #[test]
    fn discs_are_filled_evenly() {
        let n = 1000;
        let mut inside_half = 0;
        for i in 0..n * n {
            let u = [(i % n) as f32 / n as f32 + 0.5 / n as f32, (i / n) as f32 / n as f32 + 0.5 / n as f32];
            let [x, y] = uniform_disk(u);
            assert!(x * x + y * y <= 1.0 + 1e-6);
            inside_half += u32::from(x * x + y * y < 0.5);
        }
        let share = f64::from(inside_half) / f64::from(n * n);
        assert!((share - 0.5).abs() < 0.01, "{share}");
    }
}
