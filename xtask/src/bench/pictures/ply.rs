//! Meshes of triangles in and out of PLY, in the one form that `photinus scenes write` uses and every peer reads.

use super::scene::Triple;
use crate::Failure;
use std::fmt::Write;

/// Vertices and triangles of a mesh.
pub type Triangles = (Vec<Triple>, Vec<[u32; 3]>);

/// Reads binary little-endian PLY with positions in 32-bit floats (further float properties are passed over) and lists of
/// three 32-bit indices with 8-bit counts.
pub fn read(bytes: &[u8]) -> Result<Triangles, Failure> {
    const END: &[u8] = b"end_header\n";
    let end = bytes.windows(END.len()).position(|w| w == END).ok_or("no PLY header")? + END.len();
    let header = std::str::from_utf8(&bytes[..end]).map_err(|e| e.to_string())?;
    if !header.contains("format binary_little_endian 1.0\n") {
        return Err("not binary little-endian PLY".into());
    }
    let count = |element: &str| -> Result<usize, Failure> {
        let line = header.lines().find_map(|line| line.strip_prefix("element ")?.strip_prefix(element));
        line.and_then(|n| n.trim().parse().ok()).ok_or_else(|| format!("no count of {element}"))
    };
    let (vertex_count, face_count) = (count("vertex")?, count("face")?);
    let floats = header.lines().filter(|line| line.starts_with("property float ")).count();
    let mut rest = &bytes[end..];
    let mut take = |length: usize| -> Result<&[u8], Failure> {
        let (taken, left) = rest.split_at_checked(length).ok_or("the file ends early")?;
        rest = left;
        Ok(taken)
    };
    let word = |bytes: &[u8], i: usize| -> [u8; 4] { bytes[4 * i..4 * i + 4].try_into().expect("four bytes") };
    let mut vertices = Vec::new();
    for _ in 0..vertex_count {
        let record = take(4 * floats.max(3))?;
        vertices.push([0, 1, 2].map(|i| f32::from_le_bytes(word(record, i))));
    }
    let mut triangles = Vec::new();
    for _ in 0..face_count {
        if take(1)? != [3] {
            return Err("a face that is no triangle".into());
        }
        let record = take(12)?;
        triangles.push([0, 1, 2].map(|i| u32::from_le_bytes(word(record, i))));
    }
    Ok((vertices, triangles))
}

/// Binary little-endian PLY; `normals` may be empty, then faces are flat.
pub fn write(vertices: &[Triple], normals: &[Triple], triangles: &[[u32; 3]]) -> Vec<u8> {
    let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", vertices.len());
    let named = if normals.is_empty() { &["x", "y", "z"][..] } else { &["x", "y", "z", "nx", "ny", "nz"] };
    for name in named {
        let _ = writeln!(header, "property float {name}");
    }
    let _ = write!(header, "element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles.len());
    let mut bytes = header.into_bytes();
    for (i, vertex) in vertices.iter().enumerate() {
        for value in vertex.iter().chain(normals.get(i).into_iter().flatten()) {
            bytes.extend(value.to_le_bytes());
        }
    }
    for triangle in triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        let vertices = [[0.0, 0.5, -1.0], [1.0, 0.1, 2.0], [3.0, 4.0, 5.0], [7.0, 8.0, 9.0]];
        let triangles = [[0, 1, 2], [2, 1, 3]];
        for normals in [&[][..], &[[0.0, 0.0, 1.0]; 4]] {
            let bytes = write(&vertices, normals, &triangles);
            assert_eq!(read(&bytes).unwrap(), (vertices.to_vec(), triangles.to_vec()));
            assert!(read(&bytes[..bytes.len() - 1]).unwrap_err().contains("ends early"));
        }
    }
}
