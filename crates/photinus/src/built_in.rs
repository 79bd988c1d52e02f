//! Built-in scenes as data: for lists and documents.

use serde::Serialize;

/// A built-in scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct BuiltInScene {
    /// Name on the command line.
    pub name: &'static str,
    /// What it shows, in a sentence.
    pub description: &'static str,
    /// Triangles; exact spheres have none.
    pub triangles: usize,
}

/// All built-in scenes, the one that is rendered where none is named first.
pub fn built_in_scenes() -> Vec<BuiltInScene> {
    let scenes = photinus_scene::builtin::list().iter();
    scenes.map(|s| BuiltInScene { name: s.name, description: s.description, triangles: s.triangles }).collect()
}
