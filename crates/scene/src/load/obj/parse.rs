//! The statements of an OBJ file as they stand, indices resolved but not yet checked.

use super::super::tally::Tally;
use super::super::text::{Fault, Text, is, name, parse_f32, parse_i64, quoted};
use photinus_geometry::{Vec2, Vec3};
use std::collections::HashMap;

/// No texture coordinate or normal.
pub(super) const NONE: u32 = u32::MAX;
/// Most vertices, corners and faces of one file.
const LIMIT: usize = 1 << 29;
/// Unknown keywords mentioned one by one.
const MAX_UNKNOWN: usize = 16;
/// Most names of materials, and most libraries.
const MAX_MATERIALS: u32 = 1 << 20;
const MAX_LIBRARIES: usize = 64;

/// A corner of a face: indices from 0 into positions, texture coordinates and normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// A face: where its corners begin, and the line that says so.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) first_corner: u32,
    pub(super) line: u32,
}

/// Faces that follow each other under the same names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) first_face: u32,
    /// Index into [`RawObj::materials`].
    pub(super) material: Option<u32>,
    /// Index into [`RawObj::groups`].
    pub(super) group: Option<u32>,
    /// Smoothing group, 0 for none.
    pub(super) smoothing: u32,
}

/// What an OBJ file says.
#[derive(Default)]
pub(super) struct RawObj {
    pub(super) positions: Vec<Vec3>,
    /// Empty, or as long as `positions`.
    pub(super) colors: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    /// As written; zero where that is no direction.
    pub(super) normals: Vec<Vec3>,
    pub(super) corners: Vec<Corner>,
    pub(super) faces: Vec<Face>,
    pub(super) runs: Vec<Run>,
    pub(super) materials: Vec<String>,
    pub(super) groups: Vec<String>,
    /// `mtllib` statements: line and all names.
    pub(super) libraries: Vec<(u32, String)>,
    /// Whether the file speaks of smoothing groups at all.
    pub(super) has_smoothing: bool,
    /// What was read otherwise than written.
    pub(super) notes: Vec<Fault>,
}

/// Reads the statements of an OBJ file (UTF-8, see [`super::super::text::decode`]).
pub(super) fn parse(bytes: &[u8]) -> Result<RawObj, Fault> {
    let mut parser = Parser { text: Text::new(bytes), ..Parser::default() };
    while !parser.text.is_at_end() {
        parser.statement()?;
        parser.text.next_line();
    }
    parser.finish()
}

#[derive(Default)]
struct Parser<'a> {
    text: Text<'a>,
    out: RawObj,
    run: Option<Run>,
    material_ids: HashMap<&'a [u8], u32>,
    short_faces: Tally,
    curves: Tally,
    lines: Tally,
    bad_colors: Tally,
    bad_uvs: Tally,
    bad_normals: Tally,
    unknown: Vec<(String, Tally)>,
}

impl<'a> Parser<'a> {
    fn statement(&mut self) -> Result<(), Fault> {
        let Some(keyword) = self.text.word() else { return Ok(()) };
        match keyword {
            b"v" => self.vertex(),
            b"vt" => self.texture_coordinate(),
            b"vn" => self.normal(),
            b"f" | b"fo" => self.face(),
            b"usemtl" => self.use_material(),
            b"g" | b"o" => {
                self.group();
                Ok(())
            }
            b"s" => {
                self.smoothing();
                Ok(())
            }
            b"mtllib" => {
                self.library();
                Ok(())
            }
            _ => {
                self.other(keyword);
                Ok(())
            }
        }
    }

    fn vertex(&mut self) -> Result<(), Fault> {
        let line = self.text.line();
        let (mut x, mut n) = ([0.0f32; 7], 0);
        while let Some(word) = self.text.word() {
            let value = number(word, line)?;
            if n < 7 {
                x[n] = value;
            }
            n += 1;
        }
        if n < 3 {
            return Err(Fault::new(line, format!("a vertex needs 3 coordinates, this one has {n}")));
        }
        let p = Vec3::new(x[0], x[1], x[2]);
        if !p.is_finite() {
            return Err(Fault::new(
                line,
                format!("vertex ({}, {}, {}) is not finite: repair or remove it", p.x, p.y, p.z),
            ));
        }
        if self.out.positions.len() >= LIMIT {
            return Err(Fault::new(line, format!("more than {LIMIT} vertices")));
        }
        // With w (a weight of curves, which polygons have no use for) 4 or 7 numbers, with a colour 6 or 7.
        let color = match n {
            6 => Some(Vec3::new(x[3], x[4], x[5])),
            7.. => Some(Vec3::new(x[4], x[5], x[6])),
            _ => None,
        };
        let colors = &mut self.out.colors;
        match color {
            Some(c) => {
                colors.resize(self.out.positions.len(), Vec3::ONE);
                if !c.is_finite() {
                    self.bad_colors.add(line);
                }
                colors.push(if c.is_finite() { c } else { Vec3::ONE });
            }
            None if !colors.is_empty() => colors.push(Vec3::ONE),
            None => {}
        }
        self.out.positions.push(p);
        Ok(())
    }

    fn texture_coordinate(&mut self) -> Result<(), Fault> {
        let line = self.text.line();
        let Some(u) = self.text.word() else {
            return Err(Fault::new(line, "a texture coordinate needs a number"));
        };
        let u = number(u, line)?;
        let v = self.text.word().map_or(Ok(0.0), |w| number(w, line))?;
        let mut uv = Vec2::new(u, v);
        if !uv.is_finite() {
            self.bad_uvs.add(line);
            uv = Vec2::ZERO;
        }
        self.out.uvs.push(uv);
        Ok(())
    }

    fn normal(&mut self) -> Result<(), Fault> {
        let line = self.text.line();
        let mut n = Vec3::ZERO;
        for k in 0..3 {
            let Some(word) = self.text.word() else {
                return Err(Fault::new(line, format!("a normal needs 3 numbers, this one has {k}")));
            };
            n[k] = number(word, line)?;
        }
        // Scaled first: the square of a large number overflows.
        let largest = n.abs().max_element();
        let unit = if largest.is_finite() { (n / largest).try_normalize() } else { None };
        if unit.is_none() {
            self.bad_normals.add(line);
        }
        self.out.normals.push(unit.unwrap_or(Vec3::ZERO));
        Ok(())
    }

    fn face(&mut self) -> Result<(), Fault> {
        let line = self.text.line();
        let first = self.out.corners.len();
        while let Some(word) = self.text.word() {
            let corner = self.corner(word, line)?;
            self.out.corners.push(corner);
        }
        let count = self.out.corners.len() - first;
        if count < 3 {
            self.short_faces.add(line);
            self.out.corners.truncate(first);
            return Ok(());
        }
        if self.out.corners.len() > LIMIT {
            return Err(Fault::new(line, format!("more than {LIMIT} face corners")));
        }
        if let Some(run) = self.run.take() {
            let run = Run { first_face: self.out.faces.len() as u32, ..run };
            self.out.runs.push(run);
        } else if self.out.runs.is_empty() {
            self.out.runs.push(Run { first_face: 0, material: None, group: None, smoothing: 0 });
        }
        self.out.faces.push(Face { first_corner: first as u32, line });
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`; empty parts count as absent.
    #[inline]
    fn corner(&self, word: &[u8], line: u32) -> Result<Corner, Fault> {
        let wrong =
            || Fault::new(line, format!("face corner {} is not of the form v, v/vt, v//vn or v/vt/vn", quoted(word)));
        let mut parts = [0i64; 3];
        let mut given = [false; 3];
        let (mut part, mut negative) = (0, false);
        for (i, &b) in word.iter().enumerate() {
            let digit = b.wrapping_sub(b'0');
            if digit < 10 {
                given[part] = true;
                parts[part] = (parts[part] * 10 + i64::from(digit)).min(1 << 40);
                continue;
            }
            let at_start = i == 0 || word[i - 1] == b'/';
            match b {
                b'/' if part < 2 && (given[part] || at_start) => {
                    parts[part] = if negative { -parts[part] } else { parts[part] };
                    (part, negative) = (part + 1, false);
                }
                b'-' if at_start => negative = true,
                _ => return Err(wrong()),
            }
        }
        if negative {
            if !given[part] {
                return Err(wrong());
            }
            parts[part] = -parts[part];
        }
        if !given[0] {
            return Err(wrong());
        }
        let out = &self.out;
        let resolve = |k: usize, count: usize, what: &str| {
            if given[k] { resolve(parts[k], count, what, line) } else { Ok(NONE) }
        };
        Ok(Corner {
            position: resolve(0, out.positions.len(), "vertex")?,
            uv: resolve(1, out.uvs.len(), "texture coordinate")?,
            normal: resolve(2, out.normals.len(), "normal")?,
        })
    }

    /// The names that hold from here on, to be changed.
    fn pending(&mut self) -> &mut Run {
        let last = self.out.runs.last().copied();
        self.run.get_or_insert_with(|| last.unwrap_or(Run { first_face: 0, material: None, group: None, smoothing: 0 }))
    }

    fn library(&mut self) {
        let line = self.text.line();
        let names = name(self.text.rest_of_line());
        // Some writers repeat the statement before every object.
        if self.out.libraries.len() < MAX_LIBRARIES && !self.out.libraries.iter().any(|(_, known)| *known == names) {
            self.out.libraries.push((line, names));
        }
    }

    fn use_material(&mut self) -> Result<(), Fault> {
        let line = self.text.line();
        let bytes = self.text.rest_of_line();
        let known = self.material_ids.len() as u32;
        if known >= MAX_MATERIALS {
            return Err(Fault::new(line, format!("more than {MAX_MATERIALS} materials")));
        }
        let id = *self.material_ids.entry(bytes).or_insert(known);
        if id == known {
            self.out.materials.push(name(bytes));
        }
        self.pending().material = (!bytes.is_empty()).then_some(id);
        Ok(())
    }

    fn group(&mut self) {
        self.out.groups.push(name(self.text.rest_of_line()));
        let id = (self.out.groups.len() - 1) as u32;
        self.pending().group = Some(id);
    }

    fn smoothing(&mut self) {
        self.out.has_smoothing = true;
        let line = self.text.line();
        let word = self.text.word().unwrap_or(b"off");
        let group = match parse_i64(word) {
            Some(n) => n as u32,
            None if is(word, "on") => 1,
            None => {
                if !is(word, "off") && !is(word, "null") {
                    let what = format!("smoothing group {} is not a number: taken as off", quoted(word));
                    self.note_once(line, what);
                }
                0
            }
        };
        self.pending().smoothing = group;
    }

    fn note_once(&mut self, line: u32, message: String) {
        if self.out.notes.len() < MAX_UNKNOWN {
            self.out.notes.push(Fault::new(line, message));
        }
    }

    fn other(&mut self, keyword: &[u8]) {
        /// Statements without a meaning for polygons: display attributes, and tags of subdivision surfaces.
        const SILENT: &[&str] = &[
            "vp",
            "mg",
            "bevel",
            "c_interp",
            "d_interp",
            "lod",
            "shadow_obj",
            "trace_obj",
            "end",
            "t",
            "usemap",
            "maplib",
            "mtl",
            "parm",
            "deg",
            "bmat",
            "step",
            "cstype",
            "trim",
            "hole",
            "scrv",
            "sp",
            "con",
            "ctech",
            "stech",
        ];
        let line = self.text.line();
        if ["curv", "curv2", "surf"].iter().any(|k| is(keyword, k)) {
            self.curves.add(line);
        } else if is(keyword, "p") || is(keyword, "l") {
            self.lines.add(line);
        } else if !SILENT.iter().any(|k| is(keyword, k)) {
            let word = quoted(keyword);
            if let Some((_, tally)) = self.unknown.iter_mut().find(|(w, _)| *w == word) {
                tally.add(line);
            } else if self.unknown.len() < MAX_UNKNOWN {
                let mut tally = Tally::default();
                tally.add(line);
                self.unknown.push((word, tally));
            }
        }
    }

    fn finish(mut self) -> Result<RawObj, Fault> {
        let notes = &mut self.out.notes;
        self.short_faces.report(notes, "face(s) with fewer than 3 corners: skipped");
        self.curves.report(notes, "free-form curve(s) or surface(s): only polygons are read");
        self.lines.report(notes, "point or line element(s) have no surface: skipped");
        self.bad_colors.report(notes, "vertex colour(s) not finite: read as white");
        self.bad_uvs.report(notes, "texture coordinate(s) not finite: read as 0");
        self.bad_normals.report(notes, "normal(s) without a direction: the faces' own are used");
        for (word, tally) in std::mem::take(&mut self.unknown) {
            tally.report(notes, &format!("unknown statement(s) {word}: ignored"));
        }
        Ok(self.out)
    }
}

impl Default for Text<'_> {
    fn default() -> Self {
        Text::new(&[])
    }
}

fn number(word: &[u8], line: u32) -> Result<f32, Fault> {
    parse_f32(word).ok_or_else(|| Fault::new(line, format!("{} is not a number", quoted(word))))
}

/// Index from 0 of what `index` means when `count` items stand before it: from 1, or negative from the end.
#[inline]
fn resolve(index: i64, count: usize, what: &str, line: u32) -> Result<u32, Fault> {
    let from_zero = match index {
        1.. => index - 1,
        0 => return Err(Fault::new(line, format!("{what} index 0: indices begin at 1"))),
        _ => count as i64 + index,
    };
    if from_zero < 0 {
        return Err(Fault::new(line, format!("{what} index {index} goes back before the first of {count}")));
    }
    // Statements may refer to vertices further down, so that the range is checked at the end.
    Ok(from_zero.min(i64::from(NONE) - 1) as u32)
}
