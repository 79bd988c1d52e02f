//! OBJ dialects, errors and normals on small texts.

use super::*;
use photinus_geometry::{Vec2, Vec3};

const AS_FILE_SAYS: MissingNormals = MissingNormals::AsFileSays { crease_cosine: 0.866 };

fn read(text: &str) -> (ObjFile, Vec<String>) {
    read_with(text, MissingNormals::LeaveOut)
}

fn read_with(text: &str, missing: MissingNormals) -> (ObjFile, Vec<String>) {
    let (file, notes) = from_bytes(text.as_bytes(), missing).unwrap_or_else(|f| panic!("{f:?} in {text}"));
    for part in &file.parts {
        let mesh = &part.mesh;
        let n = mesh.positions.len();
        assert!([mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()].iter().all(|&len| len == 0 || len == n));
        assert_eq!(part.points.len(), n);
        assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < n));
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
    }
    (file, notes.into_iter().map(|n| format!("{}: {}", n.line, n.message)).collect())
}

fn error(text: &str) -> String {
    let fault = from_bytes(text.as_bytes(), AS_FILE_SAYS).expect_err(text);
    format!("{}: {}", fault.line, fault.message)
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn every_form_of_index_means_the_same() {
    let attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
    for (faces, uvs, normals) in [
        ("f 1 2 3 4", false, false),
        ("f 1/1 2/2 3/3 4/4", true, false),
        ("f 1//1 2//1 3//1 4//1", false, true),
        ("f 1/1/1 2/2/1 3/3/1 4/4/1", true, true),
        ("f -4 -3 -2 -1", false, false),
        ("f -4/-4/-1 -3/-3/-1 3/3/1 4/4/1", true, true),
        ("f 1// 2// 3/ 4//", false, false),
        ("f 1 2 \\\n 3 \\\r\n4", false, false),
        ("f   1\t2 3 4   # comment", false, false),
    ] {
        let (file, notes) = read(&format!("{SQUARE}{attributes}{faces}\n"));
        let mesh = &file.parts[0].mesh;
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]], "{faces}");
        assert_eq!((!mesh.uvs.is_empty(), !mesh.normals.is_empty()), (uvs, normals), "{faces}");
        assert!(notes.is_empty(), "{faces}: {notes:?}");
        if uvs {
            assert_eq!(mesh.uvs[2], Vec2::ONE);
        }
    }
}

#[test]
fn line_ends_marks_and_utf16_do_not_matter() {
    let text = format!("{SQUARE}g Дом\nusemtl белый мат\nf 1 2 3\nf 1 3 4");
    let (expected, _) = read(&text);
    assert_eq!(expected.parts[0].name, "Дом");
    assert_eq!(expected.parts[0].material.as_deref(), Some("белый мат"));
    let utf16 = |big: bool| -> Vec<u8> {
        let units = std::iter::once(0xfeff).chain(text.encode_utf16());
        units.flat_map(|u: u16| if big { u.to_be_bytes() } else { u.to_le_bytes() }).collect()
    };
    let variants = [
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        format!("\u{feff}{text}").into_bytes(),
        utf16(true),
        utf16(false),
    ];
    for bytes in variants {
        assert_eq!(from_bytes(&bytes, MissingNormals::LeaveOut).unwrap().0, expected);
    }
}

#[test]
fn parts_follow_materials_and_vertices_are_made_unique() {
    let (file, _) = read(&format!(
        "mtllib a b.mtl\n{SQUARE}vt 0 0\nvt 1 1\no house\nf 1/1 2/1 3/1\nusemtl red\ng wall\nf 1/1 3/1 4/1\n\
         usemtl blue\nf 1 2 4\nusemtl red\nf 1/2 3/1 4/1\n"
    ));
    let parts: Vec<_> =
        file.parts.iter().map(|p| (p.name.as_str(), p.material.as_deref(), p.mesh.positions.len())).collect();
    assert_eq!(parts, [("house", None, 3), ("wall", Some("red"), 4), ("wall", Some("blue"), 3)]);
    assert_eq!(file.parts[1].points, [0, 2, 3, 0], "one position, two texture coordinates");
    assert_eq!(file.parts[1].mesh.triangles, [[0, 1, 2], [3, 1, 2]]);
    assert_eq!(file.libraries, [(1, PathBuf::from("a b.mtl"))]);
}

#[test]
fn vertex_colours_and_weights() {
    let (file, notes) =
        read("v 0 0 0 1 0.5 0.25\nv 1 0 0 2\nv 0 1 0 1 0.1 0.2 0.3\nv 0 0 1 nan 0 0\nf 1 2 3\nf 1 2 4\n");
    let white = Vec3::ONE;
    assert_eq!(file.parts[0].mesh.colors, [Vec3::new(1.0, 0.5, 0.25), white, Vec3::new(0.1, 0.2, 0.3), white]);
    assert_eq!(notes, ["4: 1 vertex colour(s) not finite: read as white"]);
}

#[test]
fn errors_name_line_and_cause() {
    for (text, expected) in [
        ("v 0 0\n", "1: a vertex needs 3 coordinates, this one has 2"),
        ("v 0 0 3.1+e2\n", "1: \"3.1+e2\" is not a number"),
        ("\nv 0 nan 0\n", "2: vertex (0, NaN, 0) is not finite: repair or remove it"),
        ("v 0 1e39 0\n", "1: vertex (0, inf, 0) is not finite: repair or remove it"),
        ("v 0 0 0\nf 1 1 2\n", "2: vertex index 2 is out of range: the file has 1 vertices"),
        ("v 0 0 0\nf 1 0 1\n", "2: vertex index 0: indices begin at 1"),
        ("v 0 0 0\nf 1 -2 1\n", "2: vertex index -2 goes back before the first of 1"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/2 1/1\n", "3: texture coordinate index 2 is out of range: the file has 1 texture"),
        ("v 0 0 0\nvn 0 0 1\nf 1//1 1//3 1//1\n", "3: normal index 3 is out of range: the file has 1 normals"),
        ("v 0 0 0\nf 1 99999999999999999999 1\n", "2: vertex index 4294967295 is out of range"),
        ("f a b c\n", "1: face corner \"a\" is not of the form"),
        ("f 1/2/3/4 1 1\n", "1: face corner \"1/2/3/4\" is not"),
        ("f /1 1 1\n", "1: face corner \"/1\" is not"),
        ("f 1- 1 1\n", "1: face corner \"1-\" is not"),
        ("f - 1 1\n", "1: face corner \"-\" is not"),
        ("vn 0 1\n", "1: a normal needs 3 numbers, this one has 2"),
        ("vt\n", "1: a texture coordinate needs a number"),
    ] {
        let got = error(text);
        assert!(got.starts_with(expected), "{text:?}: {got}");
    }
}

#[test]
fn faces_may_come_before_their_vertices() {
    let (file, _) = read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    assert_eq!(file.parts[0].mesh.triangles.len(), 1);
}

#[test]
fn oddities_are_skipped_and_counted() {
    let (file, notes) = read(&format!(
        "{SQUARE}f 1 2\nf 3\nf\nf 1//7 2//8 3//9\nf 1 2 1 2\nf 1 3 2 4\nl 1 2\nfoo 1\nfoo 2\nvt nan 0\n"
    ));
    assert_eq!(file.parts.len(), 1);
    assert_eq!(
        notes,
        [
            "5: 3 face(s) with fewer than 3 corners: skipped",
            "11: 1 point or line element(s) have no surface: skipped",
            "14: 1 texture coordinate(s) not finite: read as 0",
            "12: 2 unknown statement(s) \"foo\": ignored",
            "8: 3 face corner(s) name normals, but the file has none: left out",
            "9: 1 polygon(s) without area: skipped",
            "10: 1 polygon(s) cross themselves: their triangles overlap",
        ]
        .map(String::from)
    );
}

/// Two squares that meet at an angle of 45 degrees along the y axis.
const FOLD: &str = "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv 1 0 -1\nv 1 1 -1\n";

#[test]
fn smoothing_groups_decide_about_missing_normals() {
    let normals_at_fold = |statements: [&str; 2]| {
        let text = format!("{FOLD}{}\nf 1 2 3 4\n{}\nf 2 5 6 3\n", statements[0], statements[1]);
        let (file, _) = read_with(&text, AS_FILE_SAYS);
        let part = &file.parts[0];
        let at_fold = part.points.iter().zip(&part.mesh.normals).filter(|(p, _)| **p == 1);
        at_fold.map(|(_, n)| *n).collect::<Vec<_>>()
    };
    assert_eq!(normals_at_fold(["s off", "s 0"]), [], "flat: no normals needed");
    let smooth = normals_at_fold(["s 1", ""]);
    assert_eq!(smooth.len(), 1);
    let half = std::f32::consts::PI / 8.0;
    assert!((smooth[0] - Vec3::new(libm::sinf(half), 0.0, libm::cosf(half))).length() < 1e-6, "{smooth:?}");
    assert_eq!(normals_at_fold(["s 1", "s 2"]).len(), 2, "each group has its own");
    // Of the flat square two triangles meet there, each with its own.
    assert_eq!(normals_at_fold(["s 1", "s off"]).len(), 3);
    // Nothing said: 45 degrees is a crease, but the two triangles of each square are one.
    assert_eq!(normals_at_fold(["", ""]), [Vec3::Z, Vec3::new(0.5f32.sqrt(), 0.0, 0.5f32.sqrt())]);
}

#[test]
fn mitsuba_gets_no_normals_where_the_file_has_none() {
    let (file, _) = read(&format!("{SQUARE}s 1\nf 1 2 3\nf 1 3 4\n"));
    assert!(file.parts[0].mesh.normals.is_empty());
    // One face with normals makes the part have them; the other gets its own.
    let (file, _) = read(&format!("{SQUARE}vn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\n"));
    let mesh = &file.parts[0].mesh;
    assert_eq!(mesh.normals[..3], [Vec3::X; 3]);
    assert_eq!(mesh.normals[3..], [Vec3::Z; 3]);
}

#[test]
fn content_is_recognised() {
    assert!(looks_like(b"# x\nmtllib a\nv 1 2 3\nf 1 1 1\nhalf a li"));
    for other in [&b"ply\nformat"[..], b"<scene>\n<v/>\n", b"", b"solid a\n v 1\n", b"v"] {
        assert!(!looks_like(other));
    }
}
