//! Rules that every built-in scene keeps, tried on the whole list.

use super::*;
use crate::{ColorInput, FloatInput, Geometry, Light, Material, Mesh, TextureKind};
use photinus_geometry::Vec3;

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
    for entry in list() {
        let scene = entry.build();
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
    for entry in list() {
        assert!(entry.build() == entry.build(), "{}", entry.name);
    }
}

#[test]
fn meshes_are_finite_indexed_in_range_and_not_degenerate() {
    for entry in list() {
        let scene = entry.build();
        for (name, mesh) in meshes(&scene) {
            let at = format!("{}: {name}", entry.name);
            let n = mesh.positions.len();
            assert!(n > 0 && !mesh.triangles.is_empty(), "{at}");
            assert!(mesh.positions.iter().all(|p| p.is_finite()), "{at}");
            assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < n), "{at}");
            assert!(mesh.normals.is_empty() || mesh.normals.len() == n, "{at}");
            assert!(mesh.uvs.is_empty() || mesh.uvs.len() == n, "{at}");
            assert!(mesh.colors.is_empty(), "{at}");
            assert!(mesh.normals.iter().all(|m| (m.length() - 1.0).abs() < 1e-5), "{at}: normal not unit");
            assert!(mesh.uvs.iter().all(|m| m.is_finite()), "{at}");
            let extent = {
                let b = photinus_geometry::Aabb::around(mesh.positions.iter().copied());
                (b.max - b.min).max_element()
            };
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
                let (e, f) = (b - a, c - a);
                let cross = e.cross(f);
                assert!(cross.length() > 2e-9 * extent * extent, "{at}: degenerate {a} {b} {c}");
                let longest = e.length().max(f.length()).max((c - b).length());
                assert!(cross.length() > 1e-3 * longest * longest, "{at}: sliver {a} {b} {c}");
                for &v in t {
                    if let Some(m) = mesh.normals.get(v as usize) {
                        assert!(m.dot(cross.normalize()) > 0.0, "{at}: shading normal behind the face at {a} {b} {c}");
                    }
                }
            }
        }
    }
}

#[test]
fn materials_and_textures_are_in_range_and_nested_ones_come_first() {
    for entry in list() {
        let scene = entry.build();
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
    for entry in list() {
        let scene = entry.build();
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
