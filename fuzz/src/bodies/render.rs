//! Scenes that are read and then rendered, very small: what the importer lets through the renderer must bear.

use super::{files, scenes};
use photinus::LoadOptions;
use photinus::render::{Mode, RenderOptions, Session, Settings, Silent, Stop};

/// Reads a Mitsuba scene and renders a few pixels of it in one pass, in a mode that depends on the input's length.
pub fn run(data: &[u8]) {
    let path = files::put("scene.xml", data);
    let Ok(scene) = photinus_scene::load(&path, &LoadOptions { max_triangles: 20_000, ..LoadOptions::default() })
    else {
        return;
    };
    let options = RenderOptions {
        settings: Settings {
            mode: Mode::ALL[data.len() % Mode::ALL.len()],
            photons: Some(64),
            max_depth: Some(8),
            ..Settings::default()
        },
        size: Some([4, 3]),
        // Windows of the scene's film need not fit this size.
        crop: Some([0, 0, 4, 3]),
        threads: Some(1),
        stop: Stop { passes: Some(1), ..Stop::default() },
        ..RenderOptions::default()
    };
    if let Ok(session) = Session::new(scene, options) {
        session.render(&Silent).ok();
    }
}

pub fn seeds() -> Vec<Vec<u8>> {
    scenes::mitsuba_seeds()
}
