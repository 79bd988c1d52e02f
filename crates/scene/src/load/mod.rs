//! Scene files in: one importer per format, listed in [`list`].

mod bitmap;
mod context;
mod defaults;
mod draft;
mod error;
mod framing;
mod inflate;
pub mod list;
mod mitsuba;
mod mtl;
mod normals;
mod obj;
mod options;
mod orient;
mod ply;
mod polygon;
mod serialized;
mod stl;
mod tally;
mod text;
mod weld;

pub use bitmap::BitmapEncoding;
pub use context::Context;
pub use draft::Draft;
pub use error::{LoadError, Place};
pub use mitsuba::names as mitsuba_plugins;
pub use options::LoadOptions;

use crate::Scene;
use std::io::Read;
use std::path::Path;

/// Reads a scene file of any listed format, chosen by its extension or, where that says nothing, by its content.
///
/// The result is complete: a scene without a camera gets one that frames it, a scene without light gets a constant
/// environment of radiance 1. What was read otherwise than written is in [`Scene::warnings`].
///
/// # Errors
/// One [`LoadError`] for the first thing that makes the scene unusable.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Scene, LoadError> {
    let format = choose(path)?;
    let mut context = Context::new(path, options);
    let draft = (format.load)(path, &mut context)?;
    defaults::complete(path, draft, &mut context)
}

fn choose(path: &Path) -> Result<&'static list::Format, LoadError> {
    let io = |source| LoadError::Io { place: Place::file(path), path: path.to_path_buf(), source };
    let file = error::open_regular(&Place::file(path), path)?;
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default().to_lowercase();
    let ends = |extension: &str| name.strip_suffix(extension).is_some_and(|stem| stem.ends_with('.'));
    if let Some(format) = list::FORMATS.iter().find(|f| f.extensions.iter().any(|e| ends(e))) {
        return Ok(format);
    }
    let what = match list::KNOWN_UNSUPPORTED.iter().find(|(e, _)| ends(e)) {
        Some((_, what)) => (*what).to_string(),
        None => {
            let mut head = Vec::new();
            file.take(4096).read_to_end(&mut head).map_err(io)?;
            if let Some(format) = list::FORMATS.iter().find(|f| (f.sniff)(&head)) {
                return Ok(format);
            }
            match Path::new(&name).extension().and_then(|e| e.to_str()) {
                Some(e) => format!("the format .{e}"),
                None => "this kind of file".to_string(),
            }
        }
    };
    Err(LoadError::Unsupported { path: path.to_path_buf(), what, supported: list::supported() })
}

#[cfg(test)]
mod mesh_tests;
