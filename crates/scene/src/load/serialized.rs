//! Mitsuba's serialized meshes: deflated, several in one file.

use super::{Context, LoadError, Place};
use crate::Mesh;
use std::path::Path;

/// A mesh of a serialized file.
#[derive(Clone, Debug, PartialEq)]
pub struct SerializedMesh {
    /// Name in the file; empty where it has none.
    pub name: String,
    /// Geometry; normals, texture coordinates and colours are empty where the file has none.
    pub mesh: Mesh,
    /// The file asks for face normals.
    pub face_normals: bool,
}

/// Reads mesh number `shape_index` of the file at `path`; `place` is who asked for it.
///
/// # Errors
/// [`LoadError`] where the file is damaged or has fewer meshes.
pub fn read_serialized(
    place: &Place,
    path: &Path,
    shape_index: usize,
    context: &mut Context<'_>,
) -> Result<SerializedMesh, LoadError> {
    let _ = context.read(place, path)?;
    Err(LoadError::invalid(Place::file(path), format!("mesh {shape_index}: serialized meshes are not read yet")))
}
