//! `photinus info`: what is in a scene.

use crate::args::InfoArgs;
use crate::failure::{Outcome, Result};
use crate::report;
use photinus::SceneInfo;

/// Describes the scene.
pub fn run(args: &InfoArgs) -> Result {
    let scene = super::open(&args.scene, args.source.allow_outside)?;
    let info = SceneInfo::of(&scene);
    if args.json {
        report::json(&info)?;
    } else {
        report::table(&rows(&info))?;
        for warning in &info.warnings {
            report::warning(warning);
        }
    }
    Ok(Outcome::Done)
}

fn rows(info: &SceneInfo) -> Vec<(&'static str, String)> {
    let point = |p: [f32; 3]| format!("{} {} {}", p[0], p[1], p[2]);
    let kinds = &info.lights_by_kind;
    let lights: Vec<String> = [
        (kinds.area, "area"),
        (kinds.point, "point"),
        (kinds.spot, "spot"),
        (kinds.directional, "directional"),
        (kinds.environment, "environment"),
    ]
    .iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, kind)| format!("{count} {kind}"))
    .collect();
    let camera = &info.camera;
    let fov = camera.fov_degrees.map(|fov| format!(", {fov} degrees")).unwrap_or_default();
    vec![
        ("scene", info.name.clone()),
        ("triangles", report::count(info.triangles)),
        ("meshes", report::count(info.meshes)),
        ("spheres", report::count(info.spheres)),
        ("materials", report::count(info.materials)),
        ("lights", if lights.is_empty() { "none".to_owned() } else { lights.join(", ") }),
        ("textures", format!("{} ({})", info.textures, report::bytes(info.texture_bytes))),
        (
            "camera",
            format!("{}{fov}, at {}, towards {}", camera.projection, point(camera.origin), point(camera.target)),
        ),
        ("picture", format!("{} x {} pixels", camera.width, camera.height)),
        ("bounds", info.bounds.map_or_else(|| "empty".to_owned(), |b| format!("{} to {}", point(b.min), point(b.max)))),
        ("warnings", info.warnings.len().to_string()),
    ]
}
