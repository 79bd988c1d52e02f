//! From the statements of an OBJ file to meshes: polygons cut, vertices made unique, missing normals made.

use super::super::normals::corner_normals;
use super::super::polygon::{Triangulator, Verdict};
use super::super::tally::Tally;
use super::super::text::Fault;
use super::super::weld::weld;
use super::parse::{Corner, NONE, RawObj};
use super::{MissingNormals, ObjPart};
use crate::Mesh;
use photinus_geometry::Vec3;
use std::collections::HashMap;

/// Marks a corner's normal as an index into the generated ones.
const GENERATED: u32 = 1 << 31;

/// A triangle: its corners and the part and run it belongs to.
#[derive(Clone, Copy)]
struct Triangle {
    corners: [Corner; 3],
    part: u32,
    smoothing: u32,
}

/// Builds one part per material, in the order of first use.
pub(super) fn build(mut raw: RawObj, missing: MissingNormals) -> Result<(Vec<ObjPart>, Vec<Fault>), Fault> {
    check_ranges(&mut raw)?;
    let (mut parts, mut triangles) = triangles(&mut raw);
    let generated = generate_normals(&raw, &mut triangles, parts.len(), missing);

    let mut vertices: HashMap<(u32, Corner), u32> = HashMap::with_capacity(raw.positions.len());
    let has = |pick: fn(&Corner) -> u32| {
        let mut any = vec![false; parts.len()];
        for t in &triangles {
            any[t.part as usize] |= t.corners.iter().any(|c| pick(c) != NONE);
        }
        any
    };
    let (has_uvs, has_normals) = (has(|c| c.uv), has(|c| c.normal));
    for t in &triangles {
        let p = t.part as usize;
        let ObjPart { mesh, points, .. } = &mut parts[p];
        let ids = t.corners.map(|c| {
            *vertices.entry((t.part, c)).or_insert_with(|| {
                mesh.positions.push(raw.positions[c.position as usize]);
                if has_uvs[p] {
                    mesh.uvs.push(raw.uvs.get(c.uv as usize).copied().unwrap_or_default());
                }
                if has_normals[p] {
                    let normal = match c.normal {
                        NONE => Vec3::Z,
                        n if n & GENERATED != 0 => generated[(n ^ GENERATED) as usize],
                        n => raw.normals[n as usize],
                    };
                    mesh.normals.push(normal);
                }
                mesh.colors.extend(raw.colors.get(c.position as usize));
                points.push(c.position);
                (mesh.positions.len() - 1) as u32
            })
        });
        mesh.triangles.push(ids);
    }
    Ok((parts, raw.notes))
}

/// Refuses vertex indices that do not exist. Texture coordinates and normals that a file refers to without having
/// any are left out; where it has some, a wrong index is an error too.
fn check_ranges(raw: &mut RawObj) -> Result<(), Fault> {
    let (positions, uvs, normals) = (raw.positions.len() as u32, raw.uvs.len() as u32, raw.normals.len() as u32);
    let (mut no_uvs, mut no_normals) = (Tally::default(), Tally::default());
    for (i, face) in raw.faces.iter().enumerate() {
        let end = raw.faces.get(i + 1).map_or(raw.corners.len(), |f| f.first_corner as usize);
        for c in &mut raw.corners[face.first_corner as usize..end] {
            let out_of_range = |index: u32, count: u32, what: &str, plural: &str| {
                let message = format!("{what} index {} is out of range: the file has {count} {plural}", index + 1);
                Err(Fault::new(face.line, message))
            };
            if c.position >= positions {
                return out_of_range(c.position, positions, "vertex", "vertices");
            }
            if c.uv != NONE && c.uv >= uvs {
                if uvs > 0 {
                    return out_of_range(c.uv, uvs, "texture coordinate", "texture coordinates");
                }
                no_uvs.add(face.line);
                c.uv = NONE;
            }
            if c.normal != NONE && c.normal >= normals {
                if normals > 0 {
                    return out_of_range(c.normal, normals, "normal", "normals");
                }
                no_normals.add(face.line);
                c.normal = NONE;
            }
            // A normal without direction is as good as none.
            if c.normal != NONE && raw.normals[c.normal as usize] == Vec3::ZERO {
                c.normal = NONE;
            }
        }
    }
    no_uvs.report(&mut raw.notes, "face corner(s) name texture coordinates, but the file has none: left out");
    no_normals.report(&mut raw.notes, "face corner(s) name normals, but the file has none: left out");
    Ok(())
}

/// Cuts the faces into triangles and sorts out which part each belongs to.
fn triangles(raw: &mut RawObj) -> (Vec<ObjPart>, Vec<Triangle>) {
    let mut parts: Vec<ObjPart> = Vec::new();
    let mut part_of: HashMap<Option<u32>, u32> = HashMap::new();
    let mut triangles = Vec::with_capacity(raw.corners.len().saturating_sub(2 * raw.faces.len()));
    let mut triangulator = Triangulator::new();
    let (mut points, mut cut) = (Vec::new(), Vec::new());
    let (mut degenerate, mut crossing) = (Tally::default(), Tally::default());

    for (r, run) in raw.runs.iter().enumerate() {
        let end = raw.runs.get(r + 1).map_or(raw.faces.len(), |next| next.first_face as usize);
        let part = *part_of.entry(run.material).or_insert_with(|| {
            let material = run.material.map(|m| raw.materials[m as usize].clone());
            let name = run.group.map(|g| raw.groups[g as usize].clone()).filter(|n| !n.is_empty());
            let name = name.or_else(|| material.clone()).unwrap_or_default();
            parts.push(ObjPart { name, material, mesh: Mesh::default(), points: Vec::new() });
            (parts.len() - 1) as u32
        });
        for f in run.first_face as usize..end {
            let face = raw.faces[f];
            let last = raw.faces.get(f + 1).map_or(raw.corners.len(), |next| next.first_corner as usize);
            let corners = &raw.corners[face.first_corner as usize..last];
            let smoothing = run.smoothing;
            if let &[a, b, c] = corners {
                triangles.push(Triangle { corners: [a, b, c], part, smoothing });
                continue;
            }
            points.clear();
            points.extend(corners.iter().map(|c| raw.positions[c.position as usize]));
            cut.clear();
            match triangulator.cut(&points, &mut cut) {
                Verdict::Covered => {}
                Verdict::Crossing => crossing.add(face.line),
                Verdict::Degenerate => degenerate.add(face.line),
            }
            triangles.extend(cut.iter().map(|t| Triangle { corners: t.map(|i| corners[i as usize]), part, smoothing }));
        }
    }
    degenerate.report(&mut raw.notes, "polygon(s) without area: skipped");
    crossing.report(&mut raw.notes, "polygon(s) cross themselves: their triangles overlap");
    (parts, triangles)
}

/// Gives corners without a normal one, as `missing` says, and returns the normals made.
fn generate_normals(raw: &RawObj, triangles: &mut [Triangle], part_count: usize, missing: MissingNormals) -> Vec<Vec3> {
    let mut given = vec![false; part_count];
    let mut lacking = vec![false; part_count];
    for t in triangles.iter() {
        for c in t.corners {
            given[t.part as usize] |= c.normal != NONE;
            lacking[t.part as usize] |= c.normal == NONE;
        }
    }
    let needed = |part: usize| lacking[part] && (given[part] || missing != MissingNormals::LeaveOut);
    if !(0..part_count).any(needed) {
        return Vec::new();
    }

    let points = weld(&raw.positions);
    let corners: Vec<[u32; 3]> = triangles.iter().map(|t| t.corners.map(|c| points.ids[c.position as usize])).collect();
    let made = corner_normals(&points.positions, &corners, |a, b, cosine| match missing {
        MissingNormals::LeaveOut => false,
        MissingNormals::AsFileSays { crease_cosine } => {
            let (a, b) = (triangles[a].smoothing, triangles[b].smoothing);
            if raw.has_smoothing { a == b && a != 0 } else { cosine >= crease_cosine }
        }
    });

    // A part whose faces are all flat needs no normals: the face normal is the default.
    let mut users = vec![0u32; made.normals.len()];
    made.ids.iter().for_each(|&id| users[id as usize] += 1);
    let mut worth = given.clone();
    for (t, ids) in triangles.iter().zip(made.ids.chunks_exact(3)) {
        worth[t.part as usize] |= ids.iter().any(|&id| users[id as usize] > 1);
    }
    for (t, ids) in triangles.iter_mut().zip(made.ids.chunks_exact(3)) {
        if worth[t.part as usize] && needed(t.part as usize) {
            for (c, &id) in t.corners.iter_mut().zip(ids) {
                if c.normal == NONE {
                    c.normal = GENERATED | id;
                }
            }
        }
    }
    made.normals
}
