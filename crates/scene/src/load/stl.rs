//! STL: text and binary.

use super::{Context, Draft, LoadError, Place};
use crate::Mesh;
use std::path::Path;

/// Whether `head`, a file's first bytes, look like STL.
pub fn looks_like(head: &[u8]) -> bool {
    head.starts_with(b"solid ")
}

/// Reads the mesh of the STL file at `path`; `place` is who asked for it.
///
/// # Errors
/// [`LoadError`] where the file is damaged.
pub fn read_stl(place: &Place, path: &Path, context: &mut Context<'_>) -> Result<Mesh, LoadError> {
    let _ = context.read(place, path)?;
    Err(LoadError::invalid(Place::file(path), "STL is not read yet"))
}

/// Reads an STL file as a scene of its own.
///
/// # Errors
/// As [`read_stl`].
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    read_stl(&Place::file(path), path, context)?;
    Ok(Draft::default())
}
