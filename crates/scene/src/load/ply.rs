//! PLY: text, binary of both byte orders, gzipped, triangle strips.

use super::{Context, Draft, LoadError, Place};
use crate::Mesh;
use std::path::Path;

/// Whether `head`, a file's first bytes, look like PLY.
pub fn looks_like(head: &[u8]) -> bool {
    head.starts_with(b"ply")
}

/// Reads the mesh of the PLY file at `path`; `place` is who asked for it. Normals, texture coordinates and colours
/// are empty where the file has none.
///
/// # Errors
/// [`LoadError`] where the file is damaged.
pub fn read_ply(place: &Place, path: &Path, context: &mut Context<'_>) -> Result<Mesh, LoadError> {
    let _ = context.read(place, path)?;
    Err(LoadError::invalid(Place::file(path), "PLY is not read yet"))
}

/// Reads a PLY file as a scene of its own.
///
/// # Errors
/// As [`read_ply`].
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    read_ply(&Place::file(path), path, context)?;
    Ok(Draft::default())
}
