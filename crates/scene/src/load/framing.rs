//! The camera of a scene whose file has none: into a box through its open side, from within a closed room, or from
//! the front.

use super::defaults::framing_camera;
use crate::{Camera, FilmSettings, FovAxis, Geometry, Projection, Scene};
use photinus_geometry::{Aabb, Vec3};

/// A side is a wall where triangles on it cover at least this share of it.
const WALL: f32 = 0.6;
/// A side is open where they cover at most this share.
const OPEN: f32 = 0.5;
/// Triangles count for a side when they are no farther from it than this share of the scene's extent.
const NEAR: f32 = 0.03;
/// Sides through which one may look in, best first: from +z, the customary front, and the other three around.
const FRONTS: [Vec3; 4] = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X];

/// A camera, y up, that shows what there is to see.
///
/// A box with an open side (the Cornell box) is looked into from outside, so that the opening fills the picture. A
/// closed room with a light in it is looked at from inside. All else is framed from the front, +z.
pub(super) fn default_camera(scene: &Scene) -> Camera {
    let bounds = scene.bounds();
    if bounds.is_empty() || !bounds.diagonal().is_finite() {
        return framing_camera(bounds);
    }
    let sides = Sides::of(scene, bounds);
    let front = FRONTS.into_iter().find(|&f| sides.coverage(f) <= OPEN && sides.coverage(-f) >= WALL);
    match front {
        Some(front) if sides.walls() >= 4 => look_in(bounds, front, &scene.film),
        _ if sides.walls() == 6 && emits(scene, true) && emits(scene, false) => look_around(bounds),
        _ => framing_camera(bounds),
    }
}

fn emits(scene: &Scene, wanted: bool) -> bool {
    scene.shapes.iter().any(|s| s.emission.is_some() == wanted)
}

/// How far each side of the scene's box is covered by triangles.
struct Sides {
    /// Share of the sides at the minimum and maximum of x, y and z.
    shares: [[f32; 2]; 3],
}

impl Sides {
    fn of(scene: &Scene, bounds: Aabb) -> Self {
        let extent = bounds.max - bounds.min;
        let mut areas = [[0.0f32; 2]; 3];
        for shape in &scene.shapes {
            let Geometry::Mesh(mesh) = &shape.geometry else { continue };
            for t in &mesh.triangles {
                let p = t.map(|v| mesh.positions[v as usize]);
                let doubled = (p[1] - p[0]).cross(p[2] - p[0]);
                for axis in 0..3 {
                    for (end, plane) in [bounds.min[axis], bounds.max[axis]].into_iter().enumerate() {
                        if p.iter().all(|q| (q[axis] - plane).abs() <= NEAR * extent[axis]) {
                            // The part of its area that is seen along the axis.
                            areas[axis][end] += 0.5 * doubled[axis].abs();
                        }
                    }
                }
            }
        }
        let shares = [0, 1, 2].map(|axis| {
            let whole = extent[(axis + 1) % 3] * extent[(axis + 2) % 3];
            areas[axis].map(|area| if whole > 0.0 { area / whole } else { 0.0 })
        });
        Self { shares }
    }

    /// Share of the side that faces along `direction`.
    fn coverage(&self, direction: Vec3) -> f32 {
        let axis = if direction.x != 0.0 { 0 } else { 2 };
        self.shares[axis][usize::from(direction[axis] > 0.0)]
    }

    fn walls(&self) -> usize {
        self.shares.iter().flatten().filter(|&&share| share >= WALL).count()
    }
}

/// From outside through the side that faces along `front`, which just fits into the picture.
fn look_in(bounds: Aabb, front: Vec3, film: &FilmSettings) -> Camera {
    const FOV_DEGREES: f32 = 39.0;
    let half = 0.5 * (bounds.max - bounds.min);
    let half_width = if front.z != 0.0 { half.x } else { half.z };
    let depth = if front.z != 0.0 { half.z } else { half.x };
    // The opening angle is that of the picture's shorter edge.
    let (width, height) = (film.width.max(1) as f32, film.height.max(1) as f32);
    let shorter = width.min(height);
    let fit = (half_width * shorter / width).max(half.y * shorter / height);
    let distance = 1.03 * fit / libm::tanf(0.5 * FOV_DEGREES.to_radians());
    let center = bounds.center();
    camera(center + front * (depth + distance), center, FOV_DEGREES, distance)
}

/// From inside, just off the front wall.
fn look_around(bounds: Aabb) -> Camera {
    let center = bounds.center();
    let half_depth = 0.5 * (bounds.max.z - bounds.min.z);
    camera(center + Vec3::Z * (0.9 * half_depth), center, 75.0, half_depth)
}

fn camera(origin: Vec3, target: Vec3, fov_degrees: f32, size: f32) -> Camera {
    Camera {
        origin,
        target,
        up: Vec3::Y,
        mirrored: false,
        projection: Projection::Perspective { fov_degrees, axis: FovAxis::Smaller },
        principal_point: [0.0, 0.0],
        near_clip: 1e-3 * size,
        far_clip: 1e3 * size,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ColorInput, Mesh, Shape};
    use photinus_geometry::{Mat3, Quat};

    fn empty_scene() -> Scene {
        let options = crate::LoadOptions::default();
        let path = std::path::Path::new("empty");
        let mut context = super::super::Context::new(path, &options);
        super::super::defaults::complete(path, super::super::Draft::default(), &mut context).unwrap()
    }

    /// Five walls of a box of 4 x 3 x 2 that is open towards `front`, and a lamp below its ceiling.
    fn open_box(front: Option<Vec3>) -> Scene {
        let mut scene = empty_scene();
        let half = Vec3::new(2.0, 1.5, 1.0);
        let mut quad = |center: Vec3, u: Vec3, v: Vec3, emission| {
            let positions = vec![center - u - v, center + u - v, center + u + v, center - u + v];
            let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
            let (name, material) = (String::new(), crate::MaterialId(0));
            scene.shapes.push(Shape { name, geometry: Geometry::Mesh(mesh), material, emission });
        };
        for side in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
            if Some(side) != front {
                let frame = Mat3::from_quat(Quat::from_rotation_arc(Vec3::Z, side));
                quad(side * half, frame.x_axis * half, frame.y_axis * half, None);
            }
        }
        quad(Vec3::new(0.0, 1.2, 0.0), Vec3::X * 0.2, Vec3::Z * 0.2, Some(ColorInput::Constant(Vec3::ONE)));
        scene
    }

    #[test]
    fn an_open_box_is_looked_into() {
        for front in FRONTS {
            let camera = default_camera(&open_box(Some(front)));
            let view = (camera.target - camera.origin).normalize();
            assert!((view + front).length() < 1e-6, "{front}: {camera:?}");
            // The corners of the opening are inside the picture, and the nearer pair of edges close to its border.
            let Projection::Perspective { fov_degrees, .. } = camera.projection else { panic!("perspective") };
            let half_width = if front.z != 0.0 { 2.0 } else { 1.0 };
            let depth = (camera.origin.length() - if front.z != 0.0 { 1.0 } else { 2.0 }).abs();
            let tangent = libm::tanf(0.5 * fov_degrees.to_radians());
            let (x, y) = (half_width / (depth * tangent * 768.0 / 576.0), 1.5 / (depth * tangent));
            assert!(x.max(y) > 0.95 && x.max(y) < 1.0, "{front}: {x} {y}");
        }
    }

    #[test]
    fn a_closed_room_is_seen_from_inside_and_a_closed_body_from_outside() {
        let mut room = open_box(None);
        let camera = default_camera(&room);
        assert!(room.bounds().contains(camera.origin) && camera.origin.z > 0.5, "{camera:?}");
        room.shapes.pop();
        assert!(!room.bounds().contains(default_camera(&room).origin), "a box without light");
    }
}
