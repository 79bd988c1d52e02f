//! PLY in every encoding, and broken.

use super::*;
use photinus_geometry::{Vec2, Vec3};
use std::io::Write;

/// Numbers of a file, to be written in each encoding.
enum Value {
    F32(f32),
    U8(u8),
    I32(i32),
    F64(f64),
}
use Value::{F32, F64, I32, U8};

fn encode(format: &str, header: &str, rows: &[&[Value]]) -> Vec<u8> {
    let mut out = format!("ply\nformat {format} 1.0\ncomment made here\n{header}end_header\n").into_bytes();
    for row in rows {
        for value in *row {
            match (format, value) {
                ("ascii", F32(x)) => out.extend(format!("{x} ").bytes()),
                ("ascii", U8(x)) => out.extend(format!("{x} ").bytes()),
                ("ascii", I32(x)) => out.extend(format!("{x} ").bytes()),
                ("ascii", F64(x)) => out.extend(format!("{x} ").bytes()),
                (_, U8(x)) => out.push(*x),
                ("binary_little_endian", F32(x)) => out.extend(x.to_le_bytes()),
                ("binary_little_endian", I32(x)) => out.extend(x.to_le_bytes()),
                ("binary_little_endian", F64(x)) => out.extend(x.to_le_bytes()),
                (_, F32(x)) => out.extend(x.to_be_bytes()),
                (_, I32(x)) => out.extend(x.to_be_bytes()),
                (_, F64(x)) => out.extend(x.to_be_bytes()),
            }
        }
        if format == "ascii" {
            out.push(b'\n');
        }
    }
    out
}

const FORMATS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

fn read(bytes: &[u8]) -> (Mesh, Vec<String>) {
    let (mesh, notes) = from_bytes(bytes).unwrap_or_else(|f| panic!("{f:?}"));
    let n = mesh.positions.len();
    assert!([mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()].iter().all(|&len| len == 0 || len == n));
    assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < n));
    (mesh, notes.into_iter().map(|n| n.message).collect())
}

#[test]
fn any_order_and_type_of_properties_in_every_encoding() {
    let header = "element junk 2\nproperty list uchar int bits\nproperty double z\nelement vertex 4\n\
                  property uchar red\nproperty float y\nproperty double x\nproperty uchar green\nproperty float t\n\
                  property list uchar int extra\nproperty float z\nproperty uchar blue\nproperty float s\n\
                  property float nx\nproperty float ny\nproperty float nz\n\
                  element face 2\nproperty float w\nproperty list int int vertex_index\nproperty uchar flags\n\
                  element tail 1\nproperty uchar a\n";
    let vertex = |x: f64, y: f32| -> Vec<Value> {
        let color = [U8(255), F32(y), F64(x), U8(0), F32(1.0 - y), U8(2), I32(7), I32(8), F32(5.0), U8(128)];
        color.into_iter().chain([F32(x as f32), F32(0.0), F32(0.0), F32(2.0)]).collect()
    };
    let (a, b, c, d) = (vertex(0.0, 0.0), vertex(1.0, 0.0), vertex(1.0, 1.0), vertex(0.0, 1.0));
    let rows: [&[Value]; 9] = [
        &[U8(3), I32(1), I32(2), I32(3), F64(1.5)],
        &[U8(0), F64(2.5)],
        &a,
        &b,
        &c,
        &d,
        &[F32(0.5), I32(4), I32(0), I32(1), I32(2), I32(3), U8(1)],
        &[F32(0.5), I32(3), I32(0), I32(1), I32(2), U8(1)],
        &[U8(9)],
    ];
    for format in FORMATS {
        let (mesh, notes) = read(&encode(format, header, &rows));
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]], "{format}");
        assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 5.0), "{format}");
        assert_eq!(mesh.normals[1], Vec3::Z);
        assert_eq!(mesh.uvs[1], Vec2::new(1.0, 1.0));
        assert_eq!((mesh.colors[0].x, mesh.colors[0].y), (1.0, 0.0));
        assert!((mesh.colors[0].z - 0.215_86).abs() < 1e-4, "sRGB 128 is 0.216: {}", mesh.colors[0].z);
        assert!(notes.is_empty(), "{notes:?}");
    }
}

const CORNERS: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";

fn corners() -> [[Value; 3]; 4] {
    [[0., 0.], [1., 0.], [0., 1.], [1., 1.]].map(|p| [F32(p[0]), F32(p[1]), F32(0.0)])
}

#[test]
fn strips_turn_and_restart() {
    let header = format!("{CORNERS}element tristrips 1\nproperty list int int vertex_indices\n");
    let c = corners();
    let strip = [I32(8), I32(0), I32(1), I32(2), I32(3), I32(-1), I32(0), I32(1), I32(3)];
    for format in FORMATS {
        let (mesh, _) = read(&encode(format, &header, &[&c[0], &c[1], &c[2], &c[3], &strip]));
        assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [0, 1, 3]], "{format}");
    }
}

#[test]
fn attributes_of_faces_and_corners_split_vertices() {
    let header = format!(
        "{CORNERS}element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\n"
    );
    let c = corners();
    let face = |v: [i32; 3], u: f32, red: u8| -> Vec<Value> {
        let uvs = (0..6).map(|i| F32(if i % 2 == 0 { u } else { 0.25 }));
        let indices = std::iter::once(U8(3)).chain(v.into_iter().map(I32));
        indices.chain([U8(6)]).chain(uvs).chain([U8(red), U8(0), U8(0)]).collect()
    };
    let (f, g) = (face([0, 1, 2], 0.5, 255), face([2, 1, 3], 0.75, 0));
    for format in FORMATS {
        let (mesh, _) = read(&encode(format, &header, &[&c[0], &c[1], &c[2], &c[3], &f, &g]));
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (6, 2));
        assert_eq!((mesh.uvs[0], mesh.uvs[5]), (Vec2::new(0.5, 0.25), Vec2::new(0.75, 0.25)));
        assert_eq!((mesh.colors[0], mesh.colors[3]), (Vec3::X, Vec3::ZERO));
        assert_eq!(mesh.positions[3], Vec3::Y);
    }
}

#[test]
fn gzip_is_unpacked() {
    let header = format!("{CORNERS}element face 1\nproperty list uchar int vertex_indices\n");
    let c = corners();
    let plain = encode("binary_big_endian", &header, &[&c[0], &c[1], &c[2], &c[3], &[U8(3), I32(0), I32(1), I32(2)]]);
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(&plain).unwrap();
    let packed = gzip.finish().unwrap();
    assert_eq!(read(&packed), read(&plain));
    let fault = from_bytes(&packed[..packed.len() - 12]).unwrap_err();
    assert!(fault.message.contains("gzip"), "{fault:?}");
}

#[test]
fn what_is_broken_is_said() {
    let header = format!("{CORNERS}element face 1\nproperty list uchar int vertex_indices\n");
    let c = corners();
    let with = |face: &[Value], format: &str| encode(format, &header, &[&c[0], &c[1], &c[2], &c[3], face]);
    for format in FORMATS {
        for (face, what) in [
            (vec![U8(3), I32(0), I32(1), I32(4)], "face 0: vertex index 4 is out of range: the file has 4 vertices"),
            (vec![U8(3), I32(0), I32(1), I32(-1)], "face 0: vertex index -1 is wrong"),
            (vec![U8(200), I32(0)], "declares 200 values"),
            (vec![U8(3), I32(0), I32(1)], "cut off"),
            (vec![], "cut off"),
        ] {
            let fault = from_bytes(&with(&face, format)).unwrap_err();
            assert!(fault.message.contains(what), "{format}: {fault:?}");
            assert_eq!(fault.line > 0, format == "ascii", "{fault:?}");
        }
        let (mesh, notes) = read(&with(&[U8(2), I32(0), I32(1)], format));
        assert!(mesh.triangles.is_empty() && notes.len() == 2, "{notes:?}");
        let nan = encode(format, &header, &[&[F32(f32::NAN), F32(0.0), F32(0.0)], &c[1], &c[2], &c[3]]);
        let fault = from_bytes(&[nan, vec![b' '; 40]].concat()).unwrap_err();
        assert!(fault.message.contains("vertex 0 (NaN, 0, 0) is not finite"), "{fault:?}");
        let huge = header.replace("vertex 4", "vertex 500000000").replace("face 1", "face 9000000000000000000");
        let fault = from_bytes(&encode(format, &huge, &[&c[0]])).unwrap_err();
        assert!(fault.message.contains("500000000 of element \"vertex\""), "{fault:?}");
    }
    // An element that is passed over ends one byte behind the file.
    let last = format!("{header}element junk 3\nproperty uchar a\n");
    for format in ["binary_little_endian", "binary_big_endian"] {
        let face = [U8(3), I32(0), I32(1), I32(2)];
        let rows = |junk: &[Value]| encode(format, &last, &[&c[0], &c[1], &c[2], &c[3], &face, junk]);
        let fault = from_bytes(&rows(&[U8(1), U8(2)])).unwrap_err();
        assert!(fault.message.contains("declares 3 of element \"junk\", but only 2 bytes"), "{fault:?}");
        assert_eq!(read(&rows(&[U8(1), U8(2), U8(3)])).0.triangles.len(), 1);
    }
    // Twice this many bytes are none in 64 bits.
    let mut endless = encode("ascii", &header, &[&c[0], &c[1], &c[2], &c[3]]);
    endless.extend(b"9223372036854775807 0 1 2\n");
    let fault = from_bytes(&endless).unwrap_err();
    assert!(fault.message.contains("declares 9223372036854775808 values"), "{fault:?}");
    let no_lists = format!("{CORNERS}element face 0\nelement junk 9000000000000000000\n");
    assert!(read(&encode("ascii", &no_lists, &[&c[0], &c[1], &c[2], &c[3]])).0.triangles.is_empty());
    for (header, what) in [
        ("element face 1\nproperty uchar a\n", "no element \"vertex\""),
        ("element vertex 1\nproperty float x\nproperty float y\n", "no x, y and z"),
    ] {
        assert!(from_bytes(&encode("ascii", header, &[&[U8(1), U8(2)]])).unwrap_err().message.contains(what));
    }
}

#[test]
fn an_element_declared_twice_is_refused() {
    const FACE: &str = "property list uchar int vertex_indices\n";
    const COLOR: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let place = CORNERS.replace("element vertex 4\n", "");
    let c = corners();
    let color = [U8(255), U8(0), U8(0)];
    let face = [U8(3), I32(0), I32(1), I32(2)];
    for format in FORMATS {
        // Four vertices with colours, one face, and four vertices without: eight places, four colours.
        let header = format!("element vertex 4\n{place}{COLOR}element face 1\n{FACE}element vertex 4\n{place}");
        let mut rows: Vec<&[Value]> = c.iter().flat_map(|c| [c.as_slice(), &color]).collect();
        rows.push(&face);
        let read_once = encode(format, header.rsplit_once("element").unwrap().0, &rows);
        assert_eq!(read(&read_once).0.colors.len(), 4);
        rows.extend(c.iter().map(<[_; 3]>::as_slice));
        let fault = from_bytes(&encode(format, &header, &rows)).unwrap_err();
        assert!(fault.message.contains("element \"vertex\" is declared twice"), "{format}: {fault:?}");
        assert_eq!(fault.line, 13, "the line of the second declaration");

        // The second face's colour would be the first one's.
        let header = format!("{CORNERS}element face 1\n{FACE}element face 1\n{FACE}{COLOR}");
        let rows: [&[Value]; 7] = [&c[0], &c[1], &c[2], &c[3], &face, &face, &color];
        let fault = from_bytes(&encode(format, &header, &rows)).unwrap_err();
        assert!(fault.message.contains("element \"face\" is declared twice"), "{format}: {fault:?}");
    }
}
