//! Wavefront OBJ.

mod build;
mod parse;
mod scene;

pub use scene::load;
pub(super) use scene::plain_material;

use super::text::{decode, is};
use super::{Context, LoadError, Place};
use crate::Mesh;
use std::path::{Path, PathBuf};

/// The faces of one material of an OBJ file.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjPart {
    /// Object or group name at its first face, else the material's.
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

/// What becomes of faces without normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MissingNormals {
    /// A part without any keeps none; single faces without get their own.
    LeaveOut,
    /// Smooth within a smoothing group and flat outside, as the format has it. A file that never speaks of smoothing
    /// groups is smooth across edges whose faces' normals have at least this cosine between them.
    AsFileSays { crease_cosine: f32 },
}

/// Whether `head`, a file's first bytes, look like OBJ: known statements and nothing else.
pub fn looks_like(head: &[u8]) -> bool {
    let head = decode(head);
    let mut vertices = false;
    let lines: Vec<&[u8]> = head.split(|&b| b == b'\n' || b == b'\r').collect();
    // The last line may be cut off.
    for line in &lines[..lines.len().saturating_sub(1)] {
        let Some(word) = line.split(u8::is_ascii_whitespace).find(|w| !w.is_empty()) else { continue };
        vertices |= word == b"v";
        let known = ["v", "vt", "vn", "f", "g", "o", "s", "mtllib", "usemtl", "l", "p"];
        if !word.starts_with(b"#") && !known.iter().any(|k| is(word, k)) {
            return false;
        }
    }
    vertices
}

/// Reads the geometry of the OBJ file at `path`; `place` is who asked for it.
///
/// # Errors
/// [`LoadError`] with the OBJ file's line where a face, index or number is wrong.
pub fn read_obj(place: &Place, path: &Path, context: &mut Context<'_>) -> Result<ObjFile, LoadError> {
    read(place, path, MissingNormals::LeaveOut, context)
}

fn read(place: &Place, path: &Path, missing: MissingNormals, context: &mut Context<'_>) -> Result<ObjFile, LoadError> {
    let bytes = context.read(place, path)?;
    let in_file = |fault: super::text::Fault| fault.in_file(path);
    let (file, notes) = from_bytes(&bytes, missing).map_err(in_file)?;
    for note in notes {
        context.warn(&Place::new(path, note.line), note.message);
    }
    Ok(file)
}

/// The content of an OBJ file, and what was read otherwise than written.
pub(super) fn from_bytes(
    bytes: &[u8],
    missing: MissingNormals,
) -> Result<(ObjFile, Vec<super::text::Fault>), super::text::Fault> {
    let mut raw = parse::parse(&decode(bytes))?;
    let libraries = std::mem::take(&mut raw.libraries);
    let (parts, notes) = build::build(raw, missing)?;
    let libraries = libraries.into_iter().map(|(line, names)| (line, PathBuf::from(names))).collect();
    Ok((ObjFile { parts, libraries }, notes))
}

#[cfg(test)]
mod tests;
