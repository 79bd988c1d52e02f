//! Meshes with a camera and a lamp: built-in scenes, files, and rooms furnished with the models of a folder.

use crate::furnished;
use photinus_geometry::{Primitives, Vec3};
use photinus_render::Compiled;
use photinus_scene::{LoadOptions, builtin};
use std::path::Path;
use std::sync::Arc;

/// What is traced.
pub struct Mesh {
    /// Its name.
    pub name: String,
    /// Triangles alone: not all engines know spheres.
    pub primitives: Arc<Primitives>,
    /// Where the camera stands, what it looks at, and up.
    pub camera: [Vec3; 3],
    /// The middle of the lamp, a square that faces down.
    pub lamp: Vec3,
    /// Its edge.
    pub lamp_size: f32,
}

/// A built-in scene by its name, `NAME=FILE`, or `TRIANGLES=FOLDER` for a room furnished with the folder's models until
/// it has so many triangles.
pub fn load(word: &str) -> Result<Mesh, String> {
    let (name, scene) = match word.split_once('=') {
        Some((count, folder)) if count.parse::<usize>().is_ok() => {
            return furnished::room(count.parse().expect("a number"), Path::new(folder));
        }
        Some((name, file)) => {
            let scene = photinus_scene::load(Path::new(file), &LoadOptions::default());
            (name, scene.map_err(|error| error.to_string())?)
        }
        None => (word, builtin::build(word).ok_or_else(|| format!("there is no built-in scene {word}"))?),
    };
    let camera = scene.camera;
    let camera = [camera.origin, camera.target, camera.up];
    let mut primitives = Primitives::clone(Compiled::new(scene).primitives());
    primitives.spheres.clear();
    let bounds = (0..primitives.len()).map(|i| primitives.bounds_of(i)).reduce(|a, b| a.union(b));
    let bounds = bounds.ok_or("there are no triangles")?;
    let up = camera[2].normalize();
    let size = bounds.max - bounds.min;
    // Below the ceiling, in the middle of the whole.
    let lamp = (bounds.min + bounds.max) * 0.5 + up * (0.4 * size.dot(up.abs()));
    let lamp_size = 0.05 * size.max_element();
    Ok(Mesh { name: name.to_owned(), primitives: Arc::new(primitives), camera, lamp, lamp_size })
}
