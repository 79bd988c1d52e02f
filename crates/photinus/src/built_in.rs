//! Built-in scenes as data: for lists and documents, and written as files.

use crate::Result;
use crate::names::SCENES;
use photinus_scene::{builtin, write_mitsuba};
use serde::Serialize;
use std::path::{Path, PathBuf};

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
    let scenes = builtin::list().iter();
    scenes.map(|s| BuiltInScene { name: s.name, description: s.description, triangles: s.triangles }).collect()
}

/// Writes a built-in scene into a folder, as Mitsuba XML with PLY meshes and pictures beside it; returns the XML file.
/// Rendered from there it gives the same picture.
///
/// # Errors
/// [`crate::Error::UnknownName`] for no such scene, [`crate::Error::WriteScene`] where a file cannot be written.
pub fn write_built_in(name: &str, folder: &Path) -> Result<PathBuf> {
    let scene = builtin::build(name).ok_or_else(|| SCENES.unknown(name))?;
    Ok(write_mitsuba(&scene, folder)?)
}
