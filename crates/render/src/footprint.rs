//! How large a pixel's footprint is in texture coordinates.

use photinus_geometry::Vec3;

/// Side of the square with the area that a unit square of texture coordinates has on the surface, in scene units.
///
/// Where texture coordinates are stretched, a round pixel footprint is an ellipse in them; the filter is round, and this
/// gives it the ellipse's area, the geometric mean of its axes. Its long axis (the shorter derivative alone) would blur
/// the poles of spheres and stretched pictures, which no number of passes repairs; what the mean leaves unfiltered along
/// the long axis is averaged by the eye paths of many passes.
pub fn uv_scale(dp_du: Vec3, dp_dv: Vec3) -> f32 {
    let (u, v) = (dp_du.length(), dp_dv.length());
    if !(u > 0.0 && v > 0.0) {
        return 0.0;
    }
    // Lengths apart from the angle: their product leaves the range of single precision early.
    let sine = (dp_du / u).cross(dp_dv / v).length();
    u.sqrt() * v.sqrt() * sine.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::SurfaceModel;
    use crate::{Compiled, SurfacePoint};
    use photinus_geometry::{Hit, Ray, Sphere, Vec2};
    use photinus_scene::{ColorInput, Geometry, Material, MaterialId, Mesh, Shape, Texture, TextureId, TextureKind};

    const WIDTH: f32 = 1e-3;

    /// The point of a scene's only shape that a ray hits, seen by a pixel of width [`WIDTH`].
    fn seen(geometry: Geometry, origin: Vec3, direction: Vec3) -> SurfacePoint {
        let mut scene = photinus_scene::builtin::find("furnace").unwrap().build();
        scene.shapes = vec![Shape { name: "only".into(), geometry, material: MaterialId(0), emission: None }];
        // A material that reads a texture.
        scene.textures = vec![Texture {
            name: "colors".into(),
            kind: TextureKind::VertexColor,
            to_uv: photinus_geometry::Affine3A::IDENTITY,
        }];
        scene.materials[0].material = Material::Diffuse { reflectance: ColorInput::Texture(TextureId(0)) };
        let compiled = Compiled::new(scene);
        let options = photinus_accel::BuildOptions::default();
        let structure = photinus_accel::build("brute-force", compiled.primitives().clone(), &options).unwrap();
        let world = compiled.with_structure(structure, SurfaceModel::Physical);
        let ray = Ray::new(origin, direction);
        let mut hits = [Hit::MISS];
        world.structure().closest_hit(&[ray], &mut hits);
        assert_ne!(hits[0], Hit::MISS, "the shape is in front");
        world.surface(&ray, &hits[0], WIDTH)
    }

    fn assert_near(found: f32, expected: f32, what: &str) {
        assert!((found / expected - 1.0).abs() < 1e-3, "{what}: {found}, not {expected}");
    }

    /// A unit of texture coordinates is 2 pi^2 r^2 sin(theta) of a sphere's area: near the poles the footprint grows with
    /// the root of the circle of latitude, not with its circumference.
    #[test]
    fn a_sphere_is_sharp_close_to_its_poles() {
        let radius = 2.0f32;
        for degrees in [90.0f32, 45.0, 10.0, 2.0, 0.5] {
            let theta = degrees.to_radians();
            let outward = Vec3::new(libm::sinf(theta), 0.0, libm::cosf(theta));
            let sphere = Sphere { center: Vec3::new(1.0, 2.0, 3.0), radius };
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            let geometry = Geometry::Sphere { sphere, flip_normals: false, axes };
            let point = seen(geometry, sphere.center + outward * 10.0, -outward);
            let pi = std::f32::consts::PI;
            let expected = WIDTH / (2.0 * pi * pi * radius * radius * libm::sinf(theta)).sqrt();
            assert_near(point.uv_footprint, expected, &format!("{degrees} degrees from the pole"));
        }
    }

    /// A picture once over a plank of 16 x 1, and over a plank whose coordinates are sheared, which keeps areas.
    #[test]
    fn stretched_and_sheared_coordinates_keep_the_area() {
        for shear in [0.0, 0.7, -3.0] {
            let corners = [(0.0, 0.0), (16.0, 0.0), (16.0, 1.0), (0.0, 1.0)];
            let mesh = Mesh {
                positions: corners.iter().map(|&(x, y)| Vec3::new(x, y, 0.0)).collect(),
                normals: Vec::new(),
                uvs: corners.iter().map(|&(x, y)| Vec2::new(x / 16.0 + shear * y, y)).collect(),
                colors: Vec::new(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
            };
            let point = seen(Geometry::Mesh(mesh), Vec3::new(9.0, 0.25, 5.0), -Vec3::Z);
            assert_near(point.uv_footprint, WIDTH / 4.0, &format!("sheared by {shear}"));
        }
    }

    #[test]
    fn scales_from_tiny_to_huge_and_none() {
        for scale in [1e-15f32, 1.0, 1e15] {
            assert_near(uv_scale(Vec3::X * scale, Vec3::Y * (4.0 * scale)), 2.0 * scale, "scale");
        }
        assert_eq!(uv_scale(Vec3::ZERO, Vec3::Y), 0.0);
        assert_eq!(uv_scale(Vec3::X, Vec3::X), 0.0, "no area");
        assert_eq!(uv_scale(Vec3::splat(f32::NAN), Vec3::X), 0.0);
    }
}
