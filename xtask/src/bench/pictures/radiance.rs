//! The scene in Radiance's words: one primitive a paragraph, and the view as options of `rpict`.

use super::scene::{Camera, Material, Scene, Triple};
use crate::Failure;
use std::fmt::Write;
use std::path::Path;

/// Writes `scene.rad` and `view.txt`.
pub fn write(scene: &Scene, folder: &Path) -> Result<(), Failure> {
    for (name, text) in [("scene.rad", text(scene)), ("view.txt", view(&scene.camera))] {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

/// Materials and surfaces.
pub(super) fn text(scene: &Scene) -> String {
    let mut out = String::new();
    let mut primitive = |modifier: &str, kind: &str, name: &str, values: &[f32]| {
        let values: Vec<String> = values.iter().map(f32::to_string).collect();
        let _ = writeln!(out, "{modifier} {kind} {name}\n0\n0\n{} {}\n", values.len(), values.join(" "));
    };
    for (name, material) in &scene.materials {
        match *material {
            // Specularity 0, roughness 0.
            Material::Diffuse { reflectance: [r, g, b] } => primitive("void", "plastic", name, &[r, g, b, 0.0, 0.0]),
            // Transmission of one unit of length, refraction index, Hartmann's constant.
            Material::Glass { ior } => primitive("void", "dielectric", name, &[1.0, 1.0, 1.0, ior, 0.0]),
            // Specularity 1, roughness 0.
            Material::Mirror { reflectance: [r, g, b] } => primitive("void", "metal", name, &[r, g, b, 1.0, 0.0]),
        }
    }
    for mesh in &scene.meshes {
        let mut material = mesh.material.clone();
        if let Some(radiance) = mesh.radiance {
            material = format!("{}-emitter", mesh.name);
            primitive("void", "light", &material, &radiance);
        }
        for (i, polygon) in mesh.polygons().iter().enumerate() {
            primitive(&material, "polygon", &format!("{}-{i}", mesh.name), &polygon.concat());
        }
    }
    for sphere in &scene.spheres {
        let [x, y, z] = sphere.center;
        primitive(&sphere.material, "sphere", &sphere.name, &[x, y, z, sphere.radius]);
    }
    out
}

/// A perspective view; both openings are the scene's, for its picture is square.
pub(super) fn view(camera: &Camera) -> String {
    let words = |v: Triple| v.map(|x| x.to_string()).join(" ");
    let direction = [0, 1, 2].map(|i| camera.target[i] - camera.origin[i]);
    let fov = camera.fov_degrees;
    let (from, to, up) = (words(camera.origin), words(direction), words(camera.up));
    format!("-vtv -vp {from} -vd {to} -vu {up} -vh {fov} -vv {fov} -x {} -y {}\n", camera.width, camera.height)
}
