//! Mitsuba's serialized meshes: deflated, several in one file.
//!
//! A mesh is a mark and version (u16 each), then a zlib stream: flags, name (version 4), counts, arrays. The file ends
//! with the offsets of all meshes and their number (Mitsuba documentation, "serialized" shape). All little endian.

use super::inflate::MAX_UNPACKED;
use super::normals::repair_normals;
use super::text::{Fault, name};
use super::{Context, LoadError, Place};
use crate::Mesh;
use flate2::read::ZlibDecoder;
use photinus_geometry::{Vec2, Vec3};
use std::io::Read;
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

const MARK: u16 = 0x041c;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE_PRECISION: u32 = 0x2000;
/// Most vertices or triangles of one mesh.
const LIMIT: u64 = 1 << 29;
/// Longest name that is believed.
const MAX_NAME: usize = 1 << 16;

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
    let bytes = context.read(place, path)?;
    let (mesh, notes) = from_bytes(&bytes, shape_index)
        .map_err(|message| Fault::new(0, format!("mesh {shape_index}: {message}")).in_file(path))?;
    for note in notes {
        context.warn(&Place::file(path), format!("mesh {shape_index}: {note}"));
    }
    Ok(mesh)
}

/// Mesh number `index` of a file's bytes, and what was read otherwise than written.
pub(super) fn from_bytes(bytes: &[u8], index: usize) -> Result<(SerializedMesh, Vec<String>), String> {
    let range = locate(bytes, index)?;
    let bytes = &bytes[range];
    let version = version(bytes)?;
    let mut stream = Stream(ZlibDecoder::new(&bytes[4..]).take(MAX_UNPACKED));

    let flags = stream.u32()?;
    let name = if version >= 4 { stream.name()? } else { String::new() };
    let (vertices, triangles) = (stream.u64()?, stream.u64()?);
    if vertices > LIMIT || triangles > LIMIT {
        return Err(format!(
            "{vertices} vertices and {triangles} triangles are declared, beyond the limit of {LIMIT}: the file is damaged"
        ));
    }
    let double = flags & DOUBLE_PRECISION != 0;
    let mut mesh = Mesh { positions: stream.vectors(vertices, double)?, ..Mesh::default() };
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(format!("vertex {i} is not finite: export the mesh again"));
    }
    if flags & HAS_NORMALS != 0 {
        mesh.normals = stream.vectors(vertices, double)?;
    }
    if flags & HAS_UVS != 0 {
        mesh.uvs = stream.floats::<2>(vertices, double)?.into_iter().map(Vec2::from_array).collect();
    }
    if flags & HAS_COLORS != 0 {
        mesh.colors = stream.vectors(vertices, double)?;
    }
    // Indices have 32 bits: the limit on vertices excludes the 64-bit form.
    let words = stream.words::<12>(triangles)?;
    let index = |w: &[u8; 12], k: usize| u32::from_le_bytes([w[k], w[k + 1], w[k + 2], w[k + 3]]);
    mesh.triangles = words.iter().map(|w| [index(w, 0), index(w, 4), index(w, 8)]).collect();
    if let Some(bad) = mesh.triangles.iter().flatten().find(|&&v| u64::from(v) >= vertices) {
        return Err(format!("vertex index {bad} is out of range: the mesh has {vertices} vertices"));
    }
    let notes = repair(&mut mesh);
    Ok((SerializedMesh { name, mesh, face_normals: flags & FACE_NORMALS != 0 }, notes))
}

/// Makes attributes usable and says what was wrong with them.
fn repair(mesh: &mut Mesh) -> Vec<String> {
    let mut notes = Vec::new();
    let bad_normals = repair_normals(mesh);
    if bad_normals > 0 {
        notes.push(format!("{bad_normals} normal(s) without a direction: the faces' own are used"));
    }
    let bad_uvs = mesh.uvs.iter_mut().filter(|uv| !uv.is_finite()).map(|uv| *uv = Vec2::ZERO).count();
    if bad_uvs > 0 {
        notes.push(format!("{bad_uvs} texture coordinate(s) not finite: read as 0"));
    }
    let bad_colors = mesh.colors.iter_mut().filter(|c| !c.is_finite()).map(|c| *c = Vec3::ONE).count();
    if bad_colors > 0 {
        notes.push(format!("{bad_colors} colour(s) not finite: read as white"));
    }
    if mesh.triangles.is_empty() {
        notes.push("no triangles: there is nothing to see".into());
    }
    notes
}

/// The bytes of mesh `index`, from its mark to the next mesh or the directory.
fn locate(bytes: &[u8], index: usize) -> Result<std::ops::Range<usize>, String> {
    let offset_size = if version(bytes)? >= 4 { 8 } else { 4 };
    let broken = || "the directory at the end of the file is damaged: the file is cut off".to_string();
    let count_at = bytes.len() - 4;
    let count = u32::from_le_bytes([bytes[count_at], bytes[count_at + 1], bytes[count_at + 2], bytes[count_at + 3]]);
    let count = count as usize;
    let directory = count.checked_mul(offset_size).and_then(|size| count_at.checked_sub(size)).ok_or_else(broken)?;
    if index >= count {
        return Err(format!("there is no such mesh, the file has {count}"));
    }
    let offset = |i: usize| -> usize {
        let at = directory + i * offset_size;
        let mut word = [0; 8];
        word[..offset_size].copy_from_slice(&bytes[at..at + offset_size]);
        usize::try_from(u64::from_le_bytes(word)).unwrap_or(usize::MAX)
    };
    let start = offset(index);
    let end = if index + 1 < count { offset(index + 1) } else { directory };
    if start >= end || end > directory {
        return Err(broken());
    }
    Ok(start..end)
}

fn version(bytes: &[u8]) -> Result<u16, String> {
    if bytes.len() < 8 {
        return Err("the file is cut off".into());
    }
    let word = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
    match (word(0), word(2)) {
        (MARK, version @ 3..=4) => Ok(version),
        (MARK, other) => Err(format!("version {other} is not supported: only 3 and 4 are")),
        _ => Err("no Mitsuba serialized mesh".into()),
    }
}

/// Numbers out of a deflated stream; memory grows with what arrives, not with what is declared.
struct Stream<R>(R);

impl<R: Read> Stream<R> {
    fn exact<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.0.read_exact(&mut bytes).map_err(|e| damaged(&e))?;
        Ok(bytes)
    }

    fn u32(&mut self) -> Result<u32, String> {
        Ok(u32::from_le_bytes(self.exact()?))
    }

    fn u64(&mut self) -> Result<u64, String> {
        Ok(u64::from_le_bytes(self.exact()?))
    }

    /// A text that ends with a zero byte.
    fn name(&mut self) -> Result<String, String> {
        let mut bytes = Vec::new();
        loop {
            match self.exact::<1>()?[0] {
                0 => return Ok(name(&bytes)),
                _ if bytes.len() >= MAX_NAME => return Err("its name has no end: the file is damaged".into()),
                b => bytes.push(b),
            }
        }
    }

    /// `count` groups of `N` bytes.
    fn words<const N: usize>(&mut self, count: u64) -> Result<Vec<[u8; N]>, String> {
        const CHUNK: usize = 4096;
        let mut out = Vec::new();
        let mut buffer = vec![[0; N]; CHUNK.min(count as usize)];
        let mut left = count as usize;
        while left > 0 {
            let n = left.min(CHUNK);
            self.0.read_exact(buffer[..n].as_flattened_mut()).map_err(|e| damaged(&e))?;
            out.extend_from_slice(&buffer[..n]);
            left -= n;
        }
        Ok(out)
    }

    /// `count` groups of `N` numbers.
    fn floats<const N: usize>(&mut self, count: u64, double: bool) -> Result<Vec<[f32; N]>, String> {
        let mut out = Vec::new();
        let mut left = count;
        while left > 0 {
            let n = left.min(4096);
            if double {
                let words = self.words::<8>(n * N as u64)?;
                out.extend(words.chunks_exact(N).map(|w| std::array::from_fn(|k| f64::from_le_bytes(w[k]) as f32)));
            } else {
                let words = self.words::<4>(n * N as u64)?;
                out.extend(words.chunks_exact(N).map(|w| std::array::from_fn(|k| f32::from_le_bytes(w[k]))));
            }
            left -= n;
        }
        Ok(out)
    }

    fn vectors(&mut self, count: u64, double: bool) -> Result<Vec<Vec3>, String> {
        Ok(self.floats::<3>(count, double)?.into_iter().map(Vec3::from_array).collect())
    }
}

fn damaged(error: &std::io::Error) -> String {
    if error.kind() == std::io::ErrorKind::UnexpectedEof {
        format!("its data end too early (or unpack to more than {MAX_UNPACKED} bytes): the file is cut off or damaged")
    } else {
        format!("its compressed data are damaged: {error}")
    }
}

#[cfg(test)]
#[path = "serialized_tests.rs"]
pub(super) mod tests;
