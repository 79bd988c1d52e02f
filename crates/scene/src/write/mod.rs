//! Scenes out: Mitsuba 3 XML with binary PLY meshes and PNG or EXR pictures beside it.
//!
//! Reading the result back gives the same scene to the last bit, up to names: numbers are written as the shortest
//! decimals that read back as the same bits. Two things have no twin in Mitsuba 3 and are read by this library only:
//! the bsdf `photinus_thesis` and the texture `scale`.

mod camera;
mod light;
mod material;
mod names;
mod ply;
mod shape;
mod texture;
mod xml;

use crate::{Scene, TextureId};
use names::Names;
use photinus_image::ImageError;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use xml::Xml;

/// Why a scene could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// A folder cannot be made.
    #[error("{}: cannot make this folder: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] ImageError),
    /// The scene itself is broken.
    #[error("the scene cannot be written: {0}")]
    Scene(String),
}

/// Writes `scene` into the folder `folder` (made if it is not there) as `NAME.xml`, `meshes/*.ply` and `textures/*`,
/// and returns the path of the XML file. Files of the same names are replaced, each at once.
///
/// # Errors
/// [`WriteError`] where a file cannot be written or an index of the scene points nowhere.
pub fn write_mitsuba(scene: &Scene, folder: &Path) -> Result<PathBuf, WriteError> {
    check(scene)?;
    make_folder(folder)?;
    let mut writer = Writer {
        scene,
        folder,
        xml: Xml::new(),
        materials: Names::new(scene.materials.iter().map(|m| m.name.as_str())),
        textures: Names::new(scene.textures.iter().map(|t| t.name.as_str())),
        shapes: Names::new(scene.shapes.iter().map(|s| s.name.as_str())),
        pictures: HashMap::new(),
    };
    Names::separate(&mut [&mut writer.materials, &mut writer.textures, &mut writer.shapes]);
    writer.xml.open("scene", &[("version", "3.0.0")]);
    writer.integrator();
    writer.sensor();
    for id in 0..scene.textures.len() {
        writer.texture(TextureId(id as u32))?;
    }
    for id in 0..scene.materials.len() {
        writer.material(id);
    }
    for id in 0..scene.shapes.len() {
        writer.shape(id)?;
    }
    for light in &scene.lights {
        writer.light(light)?;
    }
    writer.xml.close("scene");
    let stem = names::file_name(&scene.name);
    let path = folder.join(format!("{}.xml", if stem.is_empty() { "scene" } else { &stem }));
    photinus_image::write_atomic(&path, writer.xml.finish().as_bytes())?;
    Ok(path)
}

/// A scene on its way out.
struct Writer<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    xml: Xml,
    materials: Names,
    textures: Names,
    shapes: Names,
    /// Pictures written so far, by address: shared ones are written once.
    pictures: HashMap<usize, String>,
}

fn make_folder(path: &Path) -> Result<(), WriteError> {
    std::fs::create_dir_all(path).map_err(|source| WriteError::Folder { path: path.to_path_buf(), source })
}

/// Every index points at something that was there before.
fn check(scene: &Scene) -> Result<(), WriteError> {
    let broken = |what: String| Err(WriteError::Scene(what));
    for (i, m) in scene.materials.iter().enumerate() {
        if m.material.nested().any(|n| n.0 as usize >= i) {
            return broken(format!("material {i} \"{}\" comes before one that it is made of", m.name));
        }
    }
    for (i, s) in scene.shapes.iter().enumerate() {
        if s.material.0 as usize >= scene.materials.len() {
            return broken(format!("shape {i} \"{}\" has no material", s.name));
        }
    }
    Ok(())
}
