//! The scene in LuxCore's words: properties that name materials and PLY files. Spheres become icospheres, for LuxCore has
//! no exact ones.

use super::scene::{Material, Scene, Triple};
use super::{icosphere, ply};
use crate::Failure;
use std::fmt::Write;
use std::path::Path;

/// Subdivisions of the icospheres: 81,920 triangles each.
const LEVELS: u32 = 6;

/// Writes `scene.scn` and its meshes.
pub fn write(scene: &Scene, folder: &Path) -> Result<(), Failure> {
    let save = |name: &str, bytes: &[u8]| -> Result<(), Failure> {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))
    };
    for mesh in &scene.meshes {
        save(&mesh_file(&mesh.name), &ply::write(&mesh.vertices, &[], &mesh.triangles))?;
    }
    let (unit, triangles) = icosphere::unit(LEVELS);
    for sphere in &scene.spheres {
        let place = |p: &Triple| [0, 1, 2].map(|i| sphere.center[i] + sphere.radius * p[i]);
        let vertices: Vec<Triple> = unit.iter().map(place).collect();
        save(&mesh_file(&sphere.name), &ply::write(&vertices, &unit, &triangles))?;
    }
    save("scene.scn", text(scene).as_bytes())
}

fn mesh_file(name: &str) -> String {
    format!("luxcore-{name}.ply")
}

/// The properties, one a line.
fn text(scene: &Scene) -> String {
    let mut out = String::new();
    let mut set = |key: &str, value: String| {
        let _ = writeln!(out, "scene.{key} = {value}");
    };
    let camera = &scene.camera;
    set("camera.type", quoted("perspective"));
    set("camera.lookat.orig", words(camera.origin));
    set("camera.lookat.target", words(camera.target));
    set("camera.up", words(camera.up));
    set("camera.fieldofview", camera.fov_degrees.to_string());
    // Left on, it looks for a volume around the camera and shifts the clipping planes.
    set("camera.autovolume.enable", "0".into());
    for (name, material) in &scene.materials {
        let key = |property: &str| format!("materials.{name}.{property}");
        match material {
            Material::Diffuse { reflectance } => {
                set(&key("type"), quoted("matte"));
                set(&key("kd"), words(*reflectance));
            }
            Material::Glass { ior } => {
                set(&key("type"), quoted("glass"));
                set(&key("kr"), words([1.0; 3]));
                set(&key("kt"), words([1.0; 3]));
                set(&key("interiorior"), ior.to_string());
                set(&key("exteriorior"), "1".into());
            }
            Material::Mirror { reflectance } => {
                set(&key("type"), quoted("mirror"));
                set(&key("kr"), words(*reflectance));
            }
        }
    }
    for mesh in &scene.meshes {
        let mut material = mesh.material.clone();
        if let Some(radiance) = mesh.radiance {
            // Emission belongs to a material there. Power and efficiency of 0 leave the radiance as it is.
            material = format!("{}-emitter", mesh.name);
            let key = |property: &str| format!("materials.{material}.{property}");
            set(&key("type"), quoted("matte"));
            if let Some(Material::Diffuse { reflectance }) = scene.materials.get(&mesh.material) {
                set(&key("kd"), words(*reflectance));
            }
            set(&key("emission"), words(radiance));
            set(&key("emission.gain"), words([1.0; 3]));
            set(&key("emission.power"), "0".into());
            set(&key("emission.efficency"), "0".into());
            set(&key("emission.theta"), "90".into());
        }
        set(&format!("objects.{}.ply", mesh.name), quoted(&mesh_file(&mesh.name)));
        set(&format!("objects.{}.material", mesh.name), quoted(&material));
    }
    for sphere in &scene.spheres {
        set(&format!("objects.{}.ply", sphere.name), quoted(&mesh_file(&sphere.name)));
        set(&format!("objects.{}.material", sphere.name), quoted(&sphere.material));
    }
    out
}

fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}

fn words(values: Triple) -> String {
    values.map(|v| v.to_string()).join(" ")
}
