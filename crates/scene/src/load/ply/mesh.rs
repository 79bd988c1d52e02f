//! From a PLY file's elements to a mesh.

use super::super::normals::repair_normals;
use super::super::polygon::{Triangulator, Verdict};
use super::super::tally::Tally;
use super::super::text::Fault;
use super::header::{Element, Header, Type};
use super::source::Source;
use crate::Mesh;
use photinus_geometry::{Vec2, Vec3};
use std::collections::HashMap;

/// Most vertices and list entries of one file.
const LIMIT: u64 = 1 << 29;

/// What a vertex property is for: position, normal, texture coordinate, colour, each with its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    Position(usize),
    Normal(usize),
    Uv(usize),
    Color(usize),
    None,
}

fn slot(name: &str) -> Slot {
    match name {
        "x" | "y" | "z" => Slot::Position((name.as_bytes()[0] - b'x') as usize),
        "nx" | "ny" | "nz" => Slot::Normal((name.as_bytes()[1] - b'x') as usize),
        "u" | "s" | "texture_u" | "texture_s" => Slot::Uv(0),
        "v" | "t" | "texture_v" | "texture_t" => Slot::Uv(1),
        "red" | "r" | "diffuse_red" => Slot::Color(0),
        "green" | "g" | "diffuse_green" => Slot::Color(1),
        "blue" | "b" | "diffuse_blue" => Slot::Color(2),
        _ => Slot::None,
    }
}

/// Polygons as read: corners of face `i` are `corners[ends[i - 1]..ends[i]]`.
#[derive(Default)]
struct Faces {
    corners: Vec<u32>,
    ends: Vec<usize>,
    /// Texture coordinates of every corner, or empty.
    corner_uvs: Vec<Vec2>,
    /// A colour for every face, or empty.
    colors: Vec<Vec3>,
    /// Line of every face; empty in binary files.
    lines: Vec<u32>,
    /// Triangles of strips.
    triangles: Vec<[u32; 3]>,
}

#[derive(Default)]
struct Tallies {
    short: Tally,
    degenerate: Tally,
    crossing: Tally,
    bad_uvs: Tally,
    bad_colors: Tally,
}

/// Reads all elements.
pub(super) fn read(header: &Header, mut source: Source<'_>) -> Result<(Mesh, Vec<Fault>), Fault> {
    if !header.elements.iter().any(|e| e.name == "vertex") {
        return Err(Fault::new(0, "the header declares no element \"vertex\""));
    }
    let (mut mesh, mut faces) = (Mesh::default(), Faces::default());
    let (mut tallies, mut notes) = (Tallies::default(), Vec::new());
    for element in &header.elements {
        source.check_count(element)?;
        match element.name.as_str() {
            "vertex" => read_vertices(element, &mut source, &mut mesh, &mut tallies)?,
            "face" => read_faces(element, &mut source, &mut faces, &mut tallies)?,
            "tristrips" => read_strips(element, &mut source, &mut faces)?,
            _ => source.skip(element)?,
        }
    }
    check_indices(&faces, mesh.positions.len() as u32)?;
    assemble(&mut mesh, &faces, &mut tallies);
    let bad_normals = repair_normals(&mut mesh);
    if bad_normals > 0 {
        notes.push(Fault::new(0, format!("{bad_normals} normal(s) without a direction: the faces' own are used")));
    }
    if mesh.triangles.is_empty() {
        notes.push(Fault::new(0, "no faces: there is nothing to see"));
    }
    tallies.short.report(&mut notes, "face(s) with fewer than 3 corners: skipped");
    tallies.degenerate.report(&mut notes, "polygon(s) without area: skipped");
    tallies.crossing.report(&mut notes, "polygon(s) cross themselves: their triangles overlap");
    tallies.bad_uvs.report(&mut notes, "texture coordinate(s) not finite: read as 0");
    tallies.bad_colors.report(&mut notes, "colour(s) not finite: read as white");
    Ok((mesh, notes))
}

fn read_vertices(
    element: &Element,
    source: &mut Source<'_>,
    mesh: &mut Mesh,
    tallies: &mut Tallies,
) -> Result<(), Fault> {
    if element.count > LIMIT {
        return Err(Fault::new(0, format!("{} vertices are beyond the limit of {LIMIT}", element.count)));
    }
    let slots: Vec<Slot> =
        element.properties.iter().map(|p| if p.list.is_none() { slot(&p.name) } else { Slot::None }).collect();
    let has = |wanted: &[Slot]| wanted.iter().all(|s| slots.contains(s));
    if !has(&[Slot::Position(0), Slot::Position(1), Slot::Position(2)]) {
        return Err(Fault::new(0, "the vertices have no x, y and z"));
    }
    let has_normals = has(&[Slot::Normal(0), Slot::Normal(1), Slot::Normal(2)]);
    let has_uvs = has(&[Slot::Uv(0), Slot::Uv(1)]);
    let has_colors = has(&[Slot::Color(0), Slot::Color(1), Slot::Color(2)]);
    let count = element.count as usize;
    mesh.positions.reserve(count);
    mesh.normals.reserve(if has_normals { count } else { 0 });
    mesh.uvs.reserve(if has_uvs { count } else { 0 });
    mesh.colors.reserve(if has_colors { count } else { 0 });

    for index in 0..count {
        let (mut p, mut n, mut uv, mut color) = (Vec3::ZERO, Vec3::ZERO, Vec2::ZERO, Vec3::ZERO);
        let mut line = 0;
        for (property, slot) in element.properties.iter().zip(&slots) {
            if let Some(length) = property.list {
                for _ in 0..source.length(length, property.value, element)? {
                    source.number(property.value)?;
                }
                continue;
            }
            let value = source.number(property.value)?;
            line = source.line();
            match *slot {
                Slot::Position(k) => p[k] = value as f32,
                Slot::Normal(k) => n[k] = value as f32,
                Slot::Uv(k) => uv[k] = value as f32,
                Slot::Color(k) => color[k] = linear_color(value, property.value),
                Slot::None => {}
            }
        }
        if !p.is_finite() {
            let message = format!("vertex {index} ({}, {}, {}) is not finite: repair or remove it", p.x, p.y, p.z);
            return Err(Fault::new(line, message));
        }
        mesh.positions.push(p);
        if has_normals {
            mesh.normals.push(n);
        }
        if has_uvs {
            mesh.uvs.push(finite_uv(uv, line, tallies));
        }
        if has_colors {
            mesh.colors.push(finite_color(color, line, tallies));
        }
    }
    Ok(())
}

fn finite_uv(uv: Vec2, line: u32, tallies: &mut Tallies) -> Vec2 {
    if uv.is_finite() {
        return uv;
    }
    tallies.bad_uvs.add(line);
    Vec2::ZERO
}

fn finite_color(color: Vec3, line: u32, tallies: &mut Tallies) -> Vec3 {
    if color.is_finite() {
        return color;
    }
    tallies.bad_colors.add(line);
    Vec3::ONE
}

/// A colour component as linear: integers are sRGB codes of the type's full range.
fn linear_color(value: f64, kind: Type) -> f32 {
    let full = match kind {
        Type::F32 | Type::F64 => return value as f32,
        Type::I8 | Type::U8 => 255.0,
        Type::I16 | Type::U16 => 65535.0,
        Type::I32 | Type::U32 => 4_294_967_295.0,
    };
    photinus_image::colour::srgb_to_linear((value / full).clamp(0.0, 1.0) as f32)
}

fn read_faces(
    element: &Element,
    source: &mut Source<'_>,
    faces: &mut Faces,
    tallies: &mut Tallies,
) -> Result<(), Fault> {
    let is_index = |name: &str| name == "vertex_indices" || name == "vertex_index";
    let lists = || element.properties.iter().enumerate().filter(|(_, p)| p.list.is_some());
    let indices = lists().find(|(_, p)| is_index(&p.name)).map(|(i, _)| i);
    let Some(indices) = indices else {
        if element.count > 0 {
            return Err(Fault::new(0, "the faces have no list \"vertex_indices\" or \"vertex_index\""));
        }
        return Ok(());
    };
    let uvs = lists().find(|(_, p)| p.name == "texcoord").map(|(i, _)| i);
    let color_slot = |name: &str| match slot(name) {
        Slot::Color(k) => Some(k),
        _ => None,
    };
    let color_count = element.properties.iter().filter(|p| p.list.is_none() && color_slot(&p.name).is_some()).count();
    let in_text = matches!(source, Source::Text(_));

    for _ in 0..element.count {
        let (first, mut color, mut line) = (faces.corners.len(), Vec3::ZERO, 0);
        for (i, property) in element.properties.iter().enumerate() {
            let Some(length) = property.list else {
                let value = source.number(property.value)?;
                if let Some(k) = color_slot(&property.name) {
                    color[k] = linear_color(value, property.value);
                }
                continue;
            };
            let count = source.length(length, property.value, element)?;
            line = source.line();
            if i == indices {
                if faces.corners.len() as u64 + count > LIMIT {
                    return Err(Fault::new(line, format!("more than {LIMIT} face corners")));
                }
                for _ in 0..count {
                    let index = source.number(property.value)?;
                    faces.corners.push(vertex_index(index).ok_or_else(|| {
                        Fault::new(source.line(), format!("face {}: vertex index {index} is wrong", faces.ends.len()))
                    })?);
                }
            } else if Some(i) == uvs {
                read_corner_uvs(count, property.value, source, faces, tallies)?;
            } else {
                for _ in 0..count {
                    source.number(property.value)?;
                }
            }
        }
        if uvs.is_some() {
            faces.corner_uvs.resize(faces.corners.len(), Vec2::ZERO);
        }
        if faces.corners.len() - first < 3 {
            tallies.short.add(line);
            faces.corners.truncate(first);
            faces.corner_uvs.truncate(first);
            continue;
        }
        faces.ends.push(faces.corners.len());
        if color_count == 3 {
            faces.colors.push(finite_color(color, line, tallies));
        }
        if in_text {
            faces.lines.push(line);
        }
    }
    Ok(())
}

/// Texture coordinates of the corners of one face: u and v in turn.
fn read_corner_uvs(
    count: u64,
    kind: Type,
    source: &mut Source<'_>,
    faces: &mut Faces,
    tallies: &mut Tallies,
) -> Result<(), Fault> {
    let mut uv = Vec2::ZERO;
    for i in 0..count {
        uv[(i % 2) as usize] = source.number(kind)? as f32;
        if i % 2 == 1 {
            let uv = finite_uv(uv, source.line(), tallies);
            faces.corner_uvs.push(uv);
        }
    }
    Ok(())
}

fn vertex_index(value: f64) -> Option<u32> {
    (value >= 0.0 && value < f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as u32)
}

/// Strips of triangles: every index makes one with the two before it, in alternating order; -1 begins a new strip.
fn read_strips(element: &Element, source: &mut Source<'_>, faces: &mut Faces) -> Result<(), Fault> {
    for row in 0..element.count {
        for property in &element.properties {
            let Some(length) = property.list else {
                source.number(property.value)?;
                continue;
            };
            let is_strip = property.name == "vertex_indices" || property.name == "vertex_index";
            let mut window: [Option<u32>; 2] = [None; 2];
            let mut odd = false;
            for _ in 0..source.length(length, property.value, element)? {
                let value = source.number(property.value)?;
                if !is_strip {
                    continue;
                }
                // -1 as it reads where the list's type has no sign.
                if value == -1.0 || (property.value == Type::U32 && value == f64::from(u32::MAX)) {
                    (window, odd) = ([None; 2], false);
                    continue;
                }
                let Some(c) = vertex_index(value) else {
                    return Err(Fault::new(source.line(), format!("strip {row}: vertex index {value} is wrong")));
                };
                if let [Some(a), Some(b)] = window {
                    // A repeated index only turns the strip.
                    if a != b && b != c && a != c {
                        faces.triangles.push(if odd { [b, a, c] } else { [a, b, c] });
                    }
                    odd = !odd;
                }
                window = [window[1], Some(c)];
            }
        }
        if faces.triangles.len() as u64 > LIMIT {
            return Err(Fault::new(0, format!("more than {LIMIT} triangles")));
        }
    }
    Ok(())
}

fn check_indices(faces: &Faces, vertices: u32) -> Result<(), Fault> {
    let wrong = |index: u32, line: u32, what: String| {
        Fault::new(line, format!("{what}: vertex index {index} is out of range: the file has {vertices} vertices"))
    };
    let mut first = 0;
    for (i, &end) in faces.ends.iter().enumerate() {
        if let Some(&bad) = faces.corners[first..end].iter().find(|&&v| v >= vertices) {
            return Err(wrong(bad, faces.lines.get(i).copied().unwrap_or(0), format!("face {i}")));
        }
        first = end;
    }
    match faces.triangles.iter().flatten().find(|&&v| v >= vertices) {
        Some(&bad) => Err(wrong(bad, 0, "a triangle strip".into())),
        None => Ok(()),
    }
}

/// Cuts the polygons; where corners or faces have attributes of their own, vertices are split by them.
fn assemble(mesh: &mut Mesh, faces: &Faces, tallies: &mut Tallies) {
    let mut triangulator = Triangulator::new();
    let (mut points, mut cut) = (Vec::new(), Vec::new());
    let splits = !faces.corner_uvs.is_empty() || !faces.colors.is_empty();
    let old = if splits { std::mem::take(mesh) } else { Mesh::default() };
    let mut split = Split { old: &old, vertices: HashMap::new() };

    let mut first = 0;
    for (i, &end) in faces.ends.iter().enumerate() {
        let corners = &faces.corners[first..end];
        let positions = if splits { &old.positions } else { &mesh.positions };
        cut.clear();
        if corners.len() == 3 {
            cut.push([0, 1, 2]);
        } else {
            points.clear();
            points.extend(corners.iter().map(|&v| positions[v as usize]));
            let line = faces.lines.get(i).copied().unwrap_or(0);
            match triangulator.cut(&points, &mut cut) {
                Verdict::Covered => {}
                Verdict::Crossing => tallies.crossing.add(line),
                Verdict::Degenerate => tallies.degenerate.add(line),
            }
        }
        for t in &cut {
            let triangle = t.map(|k| {
                let v = corners[k as usize];
                if !splits {
                    return v;
                }
                let uv = faces.corner_uvs.get(first + k as usize).copied();
                split.vertex(v, uv, faces.colors.get(i).copied(), mesh)
            });
            mesh.triangles.push(triangle);
        }
        first = end;
    }
    for t in &faces.triangles {
        let triangle = if splits { t.map(|v| split.vertex(v, None, None, mesh)) } else { *t };
        mesh.triangles.push(triangle);
    }
}

/// A vertex of the file, and the bits of its corner's texture coordinate and face's colour.
type SplitKey = (u32, Option<[u32; 2]>, Option<[u32; 3]>);

/// Vertices made from those of the file and attributes of corners and faces.
struct Split<'a> {
    old: &'a Mesh,
    vertices: HashMap<SplitKey, u32>,
}

impl Split<'_> {
    fn vertex(&mut self, v: u32, uv: Option<Vec2>, color: Option<Vec3>, mesh: &mut Mesh) -> u32 {
        let key = (v, uv.map(|x| x.to_array().map(f32::to_bits)), color.map(|x| x.to_array().map(f32::to_bits)));
        let old = self.old;
        let any = (uv.is_some(), color.is_some());
        *self.vertices.entry(key).or_insert_with(|| {
            let i = v as usize;
            mesh.positions.push(old.positions[i]);
            mesh.normals.extend(old.normals.get(i));
            // Where some vertices have an attribute all need one.
            if any.0 || !old.uvs.is_empty() || !mesh.uvs.is_empty() {
                mesh.uvs.resize(mesh.positions.len() - 1, Vec2::ZERO);
                mesh.uvs.push(uv.or(old.uvs.get(i).copied()).unwrap_or_default());
            }
            if any.1 || !old.colors.is_empty() || !mesh.colors.is_empty() {
                mesh.colors.resize(mesh.positions.len() - 1, Vec3::ONE);
                mesh.colors.push(color.or(old.colors.get(i).copied()).unwrap_or(Vec3::ONE));
            }
            (mesh.positions.len() - 1) as u32
        })
    }
}
