//! Rules that every built-in scene keeps, tried on the whole list.

use super::*;
use crate::{ColorInput, FloatInput, Geometry, Light, Material, Mesh, Shape, TextureKind};
use photinus_geometry::{Aabb, Vec3};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Every entry with its scene, built once for all tests.
fn built() -> impl Iterator<Item = (&'static Builtin, &'static Scene)> {
    static SCENES: OnceLock<Vec<Scene>> = OnceLock::new();
    list().iter().zip(SCENES.get_or_init(|| list().iter().map(Builtin::build).collect()))
}

fn meshes(scene: &Scene) -> impl Iterator<Item = (&str, &Mesh)> {
    scene.shapes.iter().filter_map(|s| match &s.geometry {
        Geometry::Mesh(m) => Some((s.name.as_str(), m)),
        Geometry::Sphere { .. } => None,
    })
}

#[test]
fn names_are_unique_and_descriptions_are_one_sentence() {
    for (i, entry) in list().iter().enumerate() {
        assert!(entry.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{}", entry.name);
        assert!(list()[..i].iter().all(|other| other.name != entry.name), "{} twice", entry.name);
        assert!(entry.description.ends_with('.') && !entry.description.contains(". "), "{}", entry.description);
        assert_eq!(find(&entry.name.replace('-', "_")).map(|b| b.name), Some(entry.name));
    }
    assert!(find(DEFAULT).is_some());
    assert!(build("no-such-scene").is_none());
}

#[test]
fn every_scene_has_its_triangles_a_name_and_light() {
    for (entry, scene) in built() {
        assert_eq!(scene.triangle_count(), entry.triangles, "{}", entry.name);
        assert_eq!(scene.name, entry.name);
        assert!(scene.warnings.is_empty());
        assert!(
            !scene.lights.is_empty() || scene.shapes.iter().any(|s| s.emission.is_some()),
            "{} is dark",
            entry.name
        );
        assert!(scene.lights.iter().filter(|l| matches!(l, Light::Environment(_))).count() <= 1);
        assert!(scene.camera.origin.is_finite() && scene.camera.origin != scene.camera.target);
    }
}

#[test]
fn two_builds_are_equal() {
    for (entry, scene) in built() {
        assert!(entry.build() == *scene, "{}", entry.name);
    }
}

#[test]
fn meshes_are_finite_indexed_in_range_and_not_degenerate() {
    for (entry, scene) in built() {
        for (name, mesh) in meshes(scene) {
            check_mesh(&format!("{}: {name}", entry.name), mesh);
        }
    }
}

/// Asserts what every mesh keeps: finite, complete, indexed in range, no degenerate triangle or sliver, unit shading
/// normals on the side of their faces.
pub(super) fn check_mesh(at: &str, mesh: &Mesh) {
    let n = mesh.positions.len();
    assert!(n > 0 && !mesh.triangles.is_empty(), "{at}");
    assert!(mesh.positions.iter().all(|p| p.is_finite()), "{at}");
    assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < n), "{at}");
    assert!(mesh.normals.is_empty() || mesh.normals.len() == n, "{at}");
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == n, "{at}");
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()), "{at}");
    assert!(mesh.colors.is_empty(), "{at}");
    let bounds = Aabb::around(mesh.positions.iter().copied());
    let extent = (bounds.max - bounds.min).max_element();
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        let cross = (b - a).cross(c - a);
        assert!(0.5 * cross.length() > 1e-9 * extent * extent, "{at}: degenerate {a} {b} {c}");
        let longest = (b - a).length().max((c - a).length()).max((c - b).length());
        assert!(cross.length() > 1e-3 * longest * longest, "{at}: sliver {a} {b} {c}");
        for &v in t {
            if let Some(m) = mesh.normals.get(v as usize) {
                assert!((m.length() - 1.0).abs() < 1e-5, "{at}: normal {m} is not unit");
                assert!(m.dot(cross.normalize()) > 0.0, "{at}: shading normal {m} behind the face {a} {b} {c}");
            }
        }
    }
}

/// The signed volume of every connected piece of a mesh that is closed; none for a piece with an open edge.
///
/// Vertices at exactly the same place are one. Two faces at an edge must run along it in opposite directions.
pub(super) fn closed_volume(at: &str, mesh: &Mesh) -> Vec<Option<f32>> {
    let key = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let mut ids = BTreeMap::new();
    let welded: Vec<usize> = mesh
        .positions
        .iter()
        .map(|&p| {
            let next = ids.len();
            *ids.entry(key(p)).or_insert(next)
        })
        .collect();
    let faces: Vec<[usize; 3]> = mesh.triangles.iter().map(|t| t.map(|v| welded[v as usize])).collect();
    let mut edges: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for f in &faces {
        for k in 0..3 {
            *edges.entry((f[k], f[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    let mut piece: Vec<usize> = (0..ids.len()).collect();
    fn root(piece: &mut [usize], mut i: usize) -> usize {
        while piece[i] != i {
            piece[i] = piece[piece[i]];
            i = piece[i];
        }
        i
    }
    for f in &faces {
        for v in [f[1], f[2]] {
            let (a, b) = (root(&mut piece, f[0]), root(&mut piece, v));
            piece[a] = b;
        }
    }
    let mut volumes: BTreeMap<usize, Option<f64>> = BTreeMap::new();
    let wide = |p: Vec3| p.to_array().map(f64::from);
    let origin = wide(mesh.positions[0]);
    for (f, t) in faces.iter().zip(&mesh.triangles) {
        let volume = volumes.entry(root(&mut piece, f[0])).or_insert(Some(0.0));
        for k in 0..3 {
            let (e, back) = ((f[k], f[(k + 1) % 3]), (f[(k + 1) % 3], f[k]));
            let opposite = edges.get(&back).copied().unwrap_or(0);
            assert!(edges[&e] <= 1 || opposite == edges[&e], "{at}: faces disagree about the outside");
            if opposite != edges[&e] {
                *volume = None;
            }
        }
        let [a, b, c] = t.map(|v| {
            let p = wide(mesh.positions[v as usize]);
            [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]]
        });
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        if let Some(v) = volume {
            *v += (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0;
        }
    }
    volumes.into_values().map(|v| v.map(|v| v as f32)).collect()
}

/// Closed bodies face outwards, but for the furnace, whose inside is all there is; what refracts is closed.
#[test]
fn closed_parts_face_outwards_and_glass_is_closed() {
    for (entry, scene) in built() {
        for shape in &scene.shapes {
            let Geometry::Mesh(mesh) = &shape.geometry else { continue };
            let at = format!("{}: {}", entry.name, shape.name);
            let volumes = closed_volume(&at, mesh);
            for v in volumes.iter().flatten() {
                assert_eq!(*v < 0.0, entry.name == "furnace", "{at}: volume {v}");
            }
            let glass = matches!(scene.materials[shape.material.0 as usize].material, Material::Dielectric { .. });
            if glass && shape.name != "water" {
                assert!(volumes.iter().all(Option::is_some), "{at}: open glass");
            }
        }
    }
}

#[test]
fn materials_and_textures_are_in_range_and_nested_ones_come_first() {
    for (entry, scene) in built() {
        for shape in &scene.shapes {
            assert!((shape.material.0 as usize) < scene.materials.len(), "{}: {}", entry.name, shape.name);
        }
        for (i, m) in scene.materials.iter().enumerate() {
            assert!(m.material.nested().all(|n| (n.0 as usize) < i), "{}: {}", entry.name, m.name);
            assert!(scene.materials[..i].iter().all(|o| o.name != m.name), "{}: {} twice", entry.name, m.name);
            let used = i as u32;
            let shown = scene.shapes.iter().any(|s| s.material.0 == used)
                || scene.materials.iter().any(|o| o.material.nested().any(|n| n.0 == used));
            assert!(shown, "{}: nothing is made of {}", entry.name, m.name);
            for t in textures_of(&m.material) {
                assert!((t.0 as usize) < scene.textures.len(), "{}: {}", entry.name, m.name);
            }
        }
    }
}

fn textures_of(material: &Material) -> Vec<crate::TextureId> {
    let color = |c: &ColorInput| match c {
        ColorInput::Texture(t) => vec![*t],
        ColorInput::Constant(v) => {
            assert!(v.cmpge(Vec3::ZERO).all(), "{v}");
            vec![]
        }
    };
    let float = |c: &FloatInput| match c {
        FloatInput::Texture(t) => vec![*t],
        FloatInput::Constant(v) => {
            assert!((0.0..=1.0).contains(v), "{v}");
            vec![]
        }
    };
    match material {
        Material::Diffuse { reflectance } => color(reflectance),
        Material::Plastic { diffuse_reflectance, .. } => color(diffuse_reflectance),
        Material::RoughPlastic { diffuse_reflectance, alpha, .. } => {
            [color(diffuse_reflectance), float(alpha)].concat()
        }
        Material::Conductor { specular_reflectance, .. } => color(specular_reflectance),
        Material::RoughConductor { specular_reflectance, alpha, .. } => {
            [color(specular_reflectance), float(&alpha[0]), float(&alpha[1])].concat()
        }
        _ => vec![],
    }
}

/// A textured shape carries texture coordinates, and no material that reads a bitmap meets a mesh without them.
#[test]
fn textured_meshes_have_texture_coordinates() {
    for (entry, scene) in built() {
        let textured = |id: crate::MaterialId| {
            let mut open = vec![id];
            while let Some(m) = open.pop() {
                let material = &scene.materials[m.0 as usize].material;
                let bitmap =
                    |t: &crate::TextureId| !matches!(scene.textures[t.0 as usize].kind, TextureKind::VertexColor);
                if textures_of(material).iter().any(bitmap) {
                    return true;
                }
                open.extend(material.nested());
            }
            false
        };
        for shape in scene.shapes.iter().filter(|s| textured(s.material)) {
            if let Geometry::Mesh(mesh) = &shape.geometry {
                assert!(!mesh.uvs.is_empty(), "{}: {}", entry.name, shape.name);
            }
        }
    }
}

/// Table 2 of the thesis: the room's model spans 5000 x 102.812 x 5000 units.
#[test]
fn rooms_have_the_extents_of_the_thesis() {
    let rooms: Vec<_> = built().filter(|(entry, _)| entry.name.starts_with("room-")).collect();
    assert_eq!(rooms.len(), 4);
    for (entry, scene) in rooms {
        let b = scene.bounds();
        assert_eq!(b.min, Vec3::new(-2500.0, 0.0, -2500.0), "{}", entry.name);
        assert_eq!(b.max, Vec3::new(2500.0, 102.812, 2500.0), "{}", entry.name);
    }
}

/// What stands or hangs in a room stays under its ceiling.
#[test]
fn nothing_pokes_through_the_ceiling_of_a_room() {
    let ceiling = 98.4;
    for (entry, scene) in built().filter(|(entry, _)| entry.name.starts_with("room-")) {
        for (name, mesh) in
            meshes(scene).filter(|(name, _)| !["ceiling", "front-wall", "left-wall", "right-wall"].contains(name))
        {
            for p in mesh.positions.iter().filter(|p| p.x.abs() < 84.0 && p.z.abs() < 90.0) {
                assert!(p.y < ceiling + 1e-3, "{}: {name}: {p}", entry.name);
            }
        }
    }
}

/// A stage of the room keeps all shapes of the one before; the garden's lanterns burn with another strength.
#[test]
fn rooms_grow_out_of_one_another() {
    let rooms: Vec<_> = built().filter(|(entry, _)| entry.name.starts_with("room-")).map(|(_, s)| s).collect();
    for pair in rooms.windows(2) {
        for (before, after) in pair[0].shapes.iter().zip(&pair[1].shapes) {
            let kept = if before.name == "lantern" {
                Shape { emission: before.emission, ..after.clone() } == *before && after.emission.is_some()
            } else {
                after == before
            };
            assert!(kept, "{}: {}", pair[1].name, before.name);
        }
        assert!(pair[0].shapes.len() < pair[1].shapes.len());
        assert_eq!(pair[0].camera, pair[1].camera);
    }
}

/// No shape has more than a fifth of its scene's triangles where there are enough shapes to share them.
#[test]
fn triangles_are_spread_over_many_shapes() {
    for (entry, scene) in built().filter(|(_, scene)| scene.triangle_count() > 20_000) {
        for shape in &scene.shapes {
            assert!(shape.triangle_count() * 5 < scene.triangle_count(), "{}: {}", entry.name, shape.name);
        }
    }
}

/// The table of the documentation is the list.
#[test]
fn documentation_lists_every_scene() {
    let page = include_str!("../../../../docs/builtin-scenes.md");
    let rows: Vec<String> =
        list().iter().map(|b| format!("| `{}` | {} | {} |", b.name, b.triangles, b.description)).collect();
    let printed: Vec<&str> = page.lines().filter(|l| l.starts_with("| `")).collect();
    assert_eq!(printed, rows);
}
