//! Shapes, groups, instances.

use crate::common::*;
use photinus_geometry::{Aabb, Vec3};
use photinus_scene::{Geometry, Mesh, Scene};

fn mesh(scene: &Scene, i: usize) -> &Mesh {
    match &scene.shapes[i].geometry {
        Geometry::Mesh(m) => m,
        other => panic!("{other:?}"),
    }
}

fn bounds(m: &Mesh) -> Aabb {
    Aabb::around(m.positions.iter().copied())
}

fn area(m: &Mesh) -> f32 {
    let p = |v: u32| m.positions[v as usize];
    m.triangles.iter().map(|t| 0.5 * (p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).length()).sum()
}

fn mean_normal(m: &Mesh) -> Vec3 {
    let p = |v: u32| m.positions[v as usize];
    m.triangles.iter().map(|t| (p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0]))).sum::<Vec3>().normalize_or_zero()
}

/// Texture coordinates at the vertex nearest to `p`.
fn uv_at(m: &Mesh, p: Vec3) -> (f32, f32) {
    let i = (0..m.positions.len())
        .min_by(|&a, &b| (m.positions[a] - p).length().total_cmp(&(m.positions[b] - p).length()))
        .unwrap();
    (m.uvs[i].x, m.uvs[i].y)
}

#[test]
fn rectangle_faces_z_and_flips() {
    let s =
        scene("<shape type='rectangle'/><shape type='rectangle'><boolean name='flip_normals' value='true'/></shape>");
    clean(&s);
    assert_eq!(s.triangle_count(), 4);
    assert!((mean_normal(mesh(&s, 0)) - Vec3::Z).length() < 1e-6);
    assert!((mean_normal(mesh(&s, 1)) + Vec3::Z).length() < 1e-6);
    assert_eq!(area(mesh(&s, 0)), 4.0);
    // Mitsuba's (0, 0), the top left of a picture, is at (-1, -1); the model's v runs up.
    assert_eq!(uv_at(mesh(&s, 0), Vec3::new(-1.0, -1.0, 0.0)), (0.0, 1.0));
    assert_eq!(uv_at(mesh(&s, 0), Vec3::new(1.0, 1.0, 0.0)), (1.0, 0.0));
}

#[test]
fn cube_looks_outwards() {
    let s = scene("<shape type='cube'/>");
    clean(&s);
    let m = mesh(&s, 0);
    assert_eq!((m.triangles.len(), area(m)), (12, 24.0));
    for t in &m.triangles {
        let p = t.map(|v| m.positions[v as usize]);
        let n = (p[1] - p[0]).cross(p[2] - p[0]);
        assert!(n.dot(p[0] + p[1] + p[2]) > 0.0);
    }
}

#[test]
fn disk_and_cylinder_have_their_area() {
    let s = scene(
        "<shape type='disk'/><shape type='cylinder'><point name='p0' x='1' y='0' z='0'/>\
         <point name='p1' value='1 4 0'/><float name='radius' value='0.5'/></shape>\
         <shape type='cylinder'><boolean name='flip_normals' value='true'/></shape>",
    );
    clean(&s);
    let disk = mesh(&s, 0);
    assert!((area(disk) / std::f32::consts::PI - 1.0).abs() < 2e-4);
    assert!((mean_normal(disk) - Vec3::Z).length() < 1e-5);
    let side = mesh(&s, 1);
    assert!((area(side) / (std::f32::consts::PI * 4.0) - 1.0).abs() < 2e-4, "{}", area(side));
    let b = bounds(side);
    assert!((b.min - Vec3::new(0.5, 0.0, -0.5)).length() < 1e-3 && (b.max - Vec3::new(1.5, 4.0, 0.5)).length() < 1e-3);
    for (m, sign) in [(side, 1.0), (mesh(&s, 2), -1.0)] {
        let axis = bounds(m).center();
        for t in &m.triangles {
            let p = t.map(|v| m.positions[v as usize]);
            let n = (p[1] - p[0]).cross(p[2] - p[0]);
            let mut out = (p[0] + p[1] + p[2]) / 3.0 - axis;
            if sign > 0.0 {
                out.y = 0.0
            } else {
                out.z = 0.0
            }
            assert!(n.dot(out) * sign > 0.0);
            assert!(t.iter().all(|&v| m.normals[v as usize].dot(n) > 0.0));
        }
    }
}

#[test]
fn spheres_stay_exact_where_they_can() {
    let s = scene(
        "<shape type='sphere'><point name='center' value='1 2 3'/><float name='radius' value='2'/>\
         <transform name='to_world'><scale value='3'/><rotate z='1' angle='90'/><translate x='10'/></transform></shape>\
         <shape type='sphere'><transform name='to_world'><scale x='-2' y='2' z='2'/></transform></shape>",
    );
    clean(&s);
    let Geometry::Sphere { sphere, flip_normals, axes } = s.shapes[0].geometry else { panic!() };
    assert!((sphere.center - Vec3::new(10.0 - 6.0, 3.0, 9.0)).length() < 1e-5);
    assert!((sphere.radius - 6.0).abs() < 1e-6 && !flip_normals);
    assert!((axes[0] - Vec3::Y).length() < 1e-6 && (axes[2] - Vec3::Z).length() < 1e-6);
    // A mirror turns a sphere's normals in Mitsuba.
    let Geometry::Sphere { sphere, flip_normals, .. } = s.shapes[1].geometry else { panic!() };
    assert!(sphere.radius == 2.0 && flip_normals);

    let s = scene("<shape type='sphere'><transform name='to_world'><scale x='1' y='2' z='3'/></transform></shape>");
    assert!(warnings(&s)[0].contains("ellipsoid"));
    let b = bounds(mesh(&s, 0));
    assert!((b.max - Vec3::new(1.0, 2.0, 3.0)).length() < 5e-3, "{b:?}");
    for t in &mesh(&s, 0).triangles {
        let m = mesh(&s, 0);
        let p = t.map(|v| m.positions[v as usize]);
        assert!((p[1] - p[0]).cross(p[2] - p[0]).dot(p[0] + p[1] + p[2]) > 0.0);
    }
}

const GROUP: &str = "<shape type='shapegroup' id='g'><shape type='cube'/><shape type='sphere'/></shape>";

#[test]
fn instances_are_expanded() {
    let s = scene(&format!(
        "{GROUP}<shape type='instance'><ref id='g'/></shape>\
         <shape type='instance' id='second'><ref id='g'/><transform name='to_world'><scale value='2'/><translate z='5'/></transform></shape>"
    ));
    clean(&s);
    assert_eq!((s.shapes.len(), s.triangle_count()), (4, 24));
    let Geometry::Sphere { sphere, .. } = s.shapes[3].geometry else { panic!() };
    assert_eq!((sphere.center, sphere.radius), (Vec3::new(0.0, 0.0, 5.0), 2.0));
    assert!(s.shapes[2].name.starts_with("second/"));
    // A group alone is not seen.
    assert_eq!(scene(GROUP).shapes.len(), 0);
}

#[test]
fn mirrored_and_skewed_instances_keep_their_outside() {
    let s = scene(&format!(
        "{GROUP}<shape type='instance'><ref id='g'/><transform name='to_world'><scale x='-1'/></transform></shape>\
         <shape type='instance'><ref id='g'/><transform name='to_world'><scale x='-1' y='3'/></transform></shape>"
    ));
    let Geometry::Sphere { flip_normals, .. } = s.shapes[1].geometry else { panic!() };
    assert!(!flip_normals);
    for i in [0, 2, 3] {
        let m = mesh(&s, i);
        for t in &m.triangles {
            let p = t.map(|v| m.positions[v as usize]);
            assert!((p[1] - p[0]).cross(p[2] - p[0]).dot(p[0] + p[1] + p[2]) > 0.0, "shape {i}");
        }
    }
    assert_eq!(warnings(&s).len(), 1, "{:?}", warnings(&s));
}

#[test]
fn merge_keeps_its_children() {
    let s = scene("<shape type='merge'><shape type='cube'/><shape type='rectangle'/></shape>");
    clean(&s);
    assert_eq!(s.triangle_count(), 14);
}

#[test]
fn shapes_have_materials_and_light() {
    let s = scene(
        "<bsdf type='conductor' id='m'/><shape type='cube'><ref id='m'/></shape><shape type='cube'/>\
         <shape type='cube'><emitter type='area'><rgb name='radiance' value='1 2 3'/></emitter></shape>",
    );
    clean(&s);
    assert_eq!(s.shapes[0].material.0, 0);
    assert_ne!(s.shapes[1].material, s.shapes[2].material);
    let light = photinus_scene::ColorInput::Constant(Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(s.shapes[2].emission, Some(light));
    assert!(s.lights.is_empty(), "a light of its own needs no default");
}

#[test]
fn what_is_missing_or_unknown() {
    assert!(error("<shape type='obj'/>").contains("filename"));
    let e = error("\n<shape type='ply'><string name='filename' value='absent.ply'/></shape>");
    assert!(e.contains("scene.xml:3") && e.contains("absent.ply"), "{e}");
    assert!(error("<shape type='sphere'><float name='radius' value='0'/></shape>").contains("radius"));
    assert!(error("<shape type='instance'/>").contains("shapegroup"));
    assert!(error(&format!("{GROUP}<shape type='shapegroup' id='h'><shape type='instance'><ref id='g'/></shape></shape><shape type='instance'><ref id='h'/></shape>")).contains("groups inside groups"));
    let s = scene("<shape type='heightfield'/><shape type='teapot'/>");
    assert!(s.shapes.is_empty());
    assert!(warnings(&s)[0].contains("heightfield") && warnings(&s)[1].contains("teapot"));
}

#[test]
fn a_flattened_cube_has_finite_normals() {
    let s = scene("<shape type='cube'><transform name='to_world'><scale z='0'/></transform></shape>");
    assert!(mesh(&s, 0).normals.iter().all(|n| n.is_finite()));
}
