//! PLY: text, binary of both byte orders, gzipped, triangle strips.

mod header;
mod mesh;
mod source;

use super::inflate::{gunzip, is_gzip};
use super::normals::creased_normals;
use super::obj::plain_material;
use super::orient::face_along_normals;
use super::text::Fault;
use super::{Context, Draft, LoadError, Place};
use crate::{Geometry, Mesh, Shape};
use std::borrow::Cow;
use std::path::Path;

/// Faces of a file without normals are smooth across edges up to this angle, degrees.
const CREASE_DEGREES: f32 = 40.0;

/// Whether `head`, a file's first bytes, look like PLY.
pub fn looks_like(head: &[u8]) -> bool {
    head.starts_with(b"ply\n") || head.starts_with(b"ply\r")
}

/// Reads the mesh of the PLY file at `path`; `place` is who asked for it. Normals, texture coordinates and colours
/// are empty where the file has none. Colours of integer type are decoded from sRGB, those of floating-point type are
/// linear.
///
/// # Errors
/// [`LoadError`] where the file is damaged.
pub fn read_ply(place: &Place, path: &Path, context: &mut Context<'_>) -> Result<Mesh, LoadError> {
    let bytes = context.read(place, path)?;
    let (mesh, notes) = from_bytes(&bytes).map_err(|fault| fault.in_file(path))?;
    for note in notes {
        context.warn(&Place::new(path, note.line), note.message);
    }
    Ok(mesh)
}

/// Reads a PLY file as a scene of its own.
///
/// # Errors
/// As [`read_ply`].
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    let place = Place::file(path);
    let mut mesh = read_ply(&place, path, context)?;
    if mesh.normals.is_empty() {
        creased_normals(&mut mesh, CREASE_DEGREES);
    }
    face_along_normals(&mut mesh);
    context.add_triangles(&place, mesh.triangles.len() as u64)?;
    let mut draft = Draft::default();
    let material = plain_material(&mut draft, !mesh.colors.is_empty()).material;
    draft.shapes.push(Shape { name: "mesh".into(), geometry: Geometry::Mesh(mesh), material, emission: None });
    Ok(draft)
}

/// The mesh of a PLY file's bytes, and what was read otherwise than written.
pub(super) fn from_bytes(bytes: &[u8]) -> Result<(Mesh, Vec<Fault>), Fault> {
    let bytes = if is_gzip(bytes) {
        Cow::Owned(gunzip(bytes).map_err(|message| Fault::new(0, message))?)
    } else {
        Cow::Borrowed(bytes)
    };
    let header = header::parse(&bytes)?;
    mesh::read(&header, source::Source::new(&header, &bytes))
}

#[cfg(test)]
mod tests;
