//! STL: text and binary.

use super::obj::plain_material;
use super::tally::Tally;
use super::text::{Fault, Text, parse_f32, quoted};
use super::weld::weld;
use super::{Context, Draft, LoadError, Place};
use crate::{Geometry, Mesh, Shape};
use photinus_geometry::Vec3;
use std::path::Path;

/// Bytes before the facets of a binary file: a comment of 80 and the count.
const HEADER: usize = 84;
/// Bytes of a facet: normal, three vertices, attribute.
const FACET: usize = 50;
/// Most facets of one file.
const LIMIT: usize = 1 << 29;

/// Whether `head`, a file's first bytes, look like STL in text form; the binary form has no mark.
pub fn looks_like(head: &[u8]) -> bool {
    let head = head.trim_ascii_start();
    head.starts_with(b"solid") && head.windows(5).any(|w| w.eq_ignore_ascii_case(b"facet"))
}

/// Reads the mesh of the STL file at `path`; `place` is who asked for it. Equal vertices are made one; there are no
/// normals, as the facets are flat.
///
/// # Errors
/// [`LoadError`] where the file is damaged.
pub fn read_stl(place: &Place, path: &Path, context: &mut Context<'_>) -> Result<Mesh, LoadError> {
    let bytes = context.read(place, path)?;
    let (mesh, notes) = from_bytes(&bytes).map_err(|fault| fault.in_file(path))?;
    for note in notes {
        context.warn(&Place::new(path, note.line), note.message);
    }
    Ok(mesh)
}

/// Reads an STL file as a scene of its own.
///
/// # Errors
/// As [`read_stl`].
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    let place = Place::file(path);
    let mesh = read_stl(&place, path, context)?;
    context.add_triangles(&place, mesh.triangles.len() as u64)?;
    let mut draft = Draft::default();
    let material = plain_material(&mut draft, false).material;
    draft.shapes.push(Shape { name: "mesh".into(), geometry: Geometry::Mesh(mesh), material, emission: None });
    Ok(draft)
}

/// The mesh of an STL file's bytes, and what was read otherwise than written.
pub(super) fn from_bytes(bytes: &[u8]) -> Result<(Mesh, Vec<Fault>), Fault> {
    let mut notes = Vec::new();
    let declared = bytes.get(80..HEADER).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let room = bytes.len().saturating_sub(HEADER) / FACET;
    // Many binary files begin with "solid" too: the length decides.
    let corners = if declared.is_some_and(|n| HEADER + n * FACET == bytes.len()) {
        binary_facets(bytes, room)?
    } else if bytes.trim_ascii_start().get(..5).is_some_and(|w| w.eq_ignore_ascii_case(b"solid")) {
        text_facets(bytes, &mut notes)?
    } else {
        match declared {
            Some(n) if n > room => {
                return Err(Fault::new(
                    0,
                    format!("{n} facets are declared, but the file has room for {room}: it is cut off or no STL"),
                ));
            }
            Some(n) => {
                notes.push(Fault::new(0, "bytes behind the last facet: ignored"));
                binary_facets(bytes, n)?
            }
            None => return Err(Fault::new(0, "neither text nor binary STL: the file is cut off or of another kind")),
        }
    };
    if corners.is_empty() {
        notes.push(Fault::new(0, "no facets: there is nothing to see"));
    }
    let welded = weld(&corners);
    let triangles = welded.ids.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Ok((Mesh { positions: welded.positions, triangles, ..Mesh::default() }, notes))
}

fn binary_facets(bytes: &[u8], count: usize) -> Result<Vec<Vec3>, Fault> {
    if count > LIMIT {
        return Err(Fault::new(0, format!("more than {LIMIT} facets")));
    }
    let mut corners = Vec::with_capacity(3 * count);
    for (i, facet) in bytes[HEADER..].chunks_exact(FACET).take(count).enumerate() {
        let number = |k: usize| f32::from_le_bytes([facet[k], facet[k + 1], facet[k + 2], facet[k + 3]]);
        for corner in 0..3 {
            let at = 12 + 12 * corner;
            let p = Vec3::new(number(at), number(at + 4), number(at + 8));
            if !p.is_finite() {
                return Err(Fault::new(0, format!("facet {i}: vertex ({}, {}, {}) is not finite", p.x, p.y, p.z)));
            }
            corners.push(p);
        }
    }
    Ok(corners)
}

/// `solid [name] { facet normal x y z  outer loop  vertex x y z ...  endloop  endfacet } endsolid [name]`, any number
/// of times.
fn text_facets(bytes: &[u8], notes: &mut Vec<Fault>) -> Result<Vec<Vec3>, Fault> {
    let mut text = Text::new(bytes);
    let mut corners: Vec<Vec3> = Vec::new();
    let mut first = 0;
    let mut skipped = Tally::default();
    let mut open_facet = None;
    while let Some(word) = text.word_anywhere() {
        let line = text.line();
        match word.to_ascii_lowercase().as_slice() {
            b"vertex" => {
                let p = vertex(&mut text)?;
                if open_facet.is_none() {
                    return Err(Fault::new(line, "a vertex outside a facet"));
                }
                corners.push(p);
            }
            b"facet" => {
                if let Some(before) = open_facet.replace(line) {
                    return Err(Fault::new(before, "this facet has no endfacet"));
                }
                first = corners.len();
            }
            // The normal follows from the vertices; that in the file is often 0 or wrong.
            b"normal" => (0..3).for_each(|_| {
                text.word();
            }),
            b"outer" | b"loop" | b"endloop" => {}
            b"endfacet" => {
                if open_facet.take().is_none() {
                    return Err(Fault::new(line, "endfacet without a facet"));
                }
                // A loop of more than three corners is against the format, but clear: facets are planar and convex.
                let outline = corners.split_off(first);
                if outline.len() < 3 {
                    skipped.add(line);
                }
                for i in 2..outline.len() {
                    corners.extend([outline[0], outline[i - 1], outline[i]]);
                }
            }
            b"solid" | b"endsolid" | b"color" => text.next_line(),
            _ => return Err(Fault::new(line, format!("unknown word {} in a text STL file", quoted(word)))),
        }
    }
    if let Some(line) = open_facet {
        return Err(Fault::new(line, "this facet has no endfacet: the file is cut off"));
    }
    if corners.len() / 3 > LIMIT {
        return Err(Fault::new(0, format!("more than {LIMIT} facets")));
    }
    skipped.report(notes, "facet(s) with fewer than 3 vertices: skipped");
    Ok(corners)
}

fn vertex(text: &mut Text<'_>) -> Result<Vec3, Fault> {
    let line = text.line();
    let mut p = Vec3::ZERO;
    for k in 0..3 {
        let Some(word) = text.word_anywhere() else { return Err(Fault::new(line, "the file ends inside a vertex")) };
        p[k] = parse_f32(word).ok_or_else(|| Fault::new(text.line(), format!("{} is not a number", quoted(word))))?;
    }
    if p.is_finite() {
        Ok(p)
    } else {
        Err(Fault::new(line, format!("vertex ({}, {}, {}) is not finite: repair or remove it", p.x, p.y, p.z)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary(header: &[u8], facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, 0);
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            bytes.extend([0u8; 12]);
            bytes.extend(facet.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0u8; 2]);
        }
        bytes
    }

    const SQUARE: [[[f32; 3]; 3]; 2] =
        [[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]], [[-0., 0., 0.], [1., 1., 0.], [0., 1., 0.]]];

    #[test]
    fn binary_files_are_told_by_their_length() {
        for header in [&b"solid but binary"[..], b"", b"facet"] {
            let (mesh, notes) = from_bytes(&binary(header, &SQUARE)).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]], "-0 is 0: four vertices");
            assert!(mesh.positions.len() == 4 && notes.is_empty());
        }
        let mut long = binary(b"x", &SQUARE);
        long.push(7);
        assert_eq!(from_bytes(&long).unwrap().1.len(), 1);
        long.truncate(120);
        assert!(from_bytes(&long).unwrap_err().message.contains("2 facets are declared, but the file has room for 0"));
        assert!(from_bytes(b"xyz").is_err());
        let mut nan = SQUARE;
        nan[1][2][0] = f32::NAN;
        assert!(from_bytes(&binary(b"", &nan)).unwrap_err().message.contains("facet 1: vertex (NaN"));
    }

    #[test]
    fn text_files_may_hold_several_solids() {
        let text = "SOLID a b\n facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0\n 0\nvertex 1 1 0 endloop \
                    endfacet\nendsolid\nsolid e\r\nendsolid\r\nsolid c\nfacet normal nan 0 1\nouter loop\nvertex 0 0 \
                    0\nvertex 1 1 0\nvertex 0 1e0 0\nendloop\nendfacet\nendsolid\n";
        let (mesh, notes) = from_bytes(text.as_bytes()).unwrap();
        assert_eq!((mesh.triangles, notes), (vec![[0, 1, 2], [0, 2, 3]], vec![]));
    }

    #[test]
    fn broken_text_files_name_the_line() {
        for (text, line, what) in [
            ("solid\nfacet normal 0 0 1\nvertex 0 0 x\n", 3, "\"x\" is not a number"),
            ("solid\nvertex 0 0 0\n", 2, "outside a facet"),
            ("solid\nfacet\nvertex 0 0 inf\n", 3, "not finite"),
            ("solid\nfacet\nvertex 0 0\n", 3, "ends inside a vertex"),
            ("solid\nfacet\nvertex 0 0 0\n", 2, "cut off"),
            ("solid\nfacet\nfacet\n", 2, "no endfacet"),
            ("solid\nblah\n", 2, "\"blah\""),
        ] {
            let fault = from_bytes(text.as_bytes()).unwrap_err();
            assert!(fault.line == line && fault.message.contains(what), "{text:?}: {fault:?}");
        }
    }
}
