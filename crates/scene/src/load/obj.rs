//! Wavefront OBJ.

use super::{Context, Draft, LoadError, Place};
use crate::Mesh;
use std::path::{Path, PathBuf};

/// The faces of one group and material of an OBJ file.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjPart {
    /// Object or group name.
    pub name: String,
    /// Material name (`usemtl`), if any.
    pub material: Option<String>,
    /// Geometry as the file has it: polygons triangulated, v = 0 at the bottom, no normals where the file has none.
    pub mesh: Mesh,
    /// For each vertex of `mesh`, the position (`v` line, from 0) that it came from: vertices that differ only in
    /// texture coordinate share it, and smooth normals join over it.
    pub points: Vec<u32>,
}

/// What an OBJ file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjFile {
    /// Parts, in the order of their first face.
    pub parts: Vec<ObjPart>,
    /// Material libraries (`mtllib`) as named, with the line.
    pub libraries: Vec<(u32, PathBuf)>,
}

/// Whether `head`, a file's first bytes, look like OBJ.
pub fn looks_like(_head: &[u8]) -> bool {
    false
}

/// Reads the geometry of the OBJ file at `path`; `place` is who asked for it.
///
/// # Errors
/// [`LoadError`] with the OBJ file's line where a face, index or number is wrong.
pub fn read_obj(place: &Place, path: &Path, context: &mut Context<'_>) -> Result<ObjFile, LoadError> {
    let _ = context.read(place, path)?;
    Err(LoadError::invalid(Place::file(path), "OBJ is not read yet"))
}

/// Reads an OBJ file as a scene of its own, with its materials.
///
/// # Errors
/// As [`read_obj`].
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    read_obj(&Place::file(path), path, context)?;
    Ok(Draft::default())
}
