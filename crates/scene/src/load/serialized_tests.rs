//! Serialized meshes of both versions and precisions, and broken ones.

use super::*;
use std::io::Write;

const TRIANGLE: [[f64; 3]; 3] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];

fn deflate(bytes: &[u8]) -> Vec<u8> {
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    zlib.write_all(bytes).unwrap();
    zlib.finish().unwrap()
}

/// The content of a mesh of one triangle, with `extra` numbers per vertex after the position.
fn content(version: u16, flags: u32, extra: usize, indices: [u32; 3]) -> Vec<u8> {
    let mut out = flags.to_le_bytes().to_vec();
    if version == 4 {
        out.extend("Tür\0".bytes());
    }
    out.extend(3u64.to_le_bytes());
    out.extend(1u64.to_le_bytes());
    let mut number = |x: f64| {
        if flags & DOUBLE_PRECISION != 0 { out.extend(x.to_le_bytes()) } else { out.extend((x as f32).to_le_bytes()) }
    };
    TRIANGLE.iter().flatten().for_each(|x| number(*x));
    (0..3 * extra).for_each(|i| number(0.25 * (1 + i) as f64));
    out.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    out
}

fn file(version: u16, contents: &[Vec<u8>]) -> Vec<u8> {
    let (mut out, mut offsets) = (Vec::new(), Vec::new());
    for content in contents {
        offsets.push(out.len());
        out.extend(MARK.to_le_bytes());
        out.extend(version.to_le_bytes());
        out.extend(deflate(content));
    }
    for offset in &offsets {
        if version == 4 {
            out.extend((*offset as u64).to_le_bytes());
        } else {
            out.extend((*offset as u32).to_le_bytes());
        }
    }
    out.extend((offsets.len() as u32).to_le_bytes());
    out
}

/// A good file of one mesh, for tests that damage it.
pub(in crate::load) fn sample_file() -> Vec<u8> {
    file(4, &[content(4, HAS_NORMALS | HAS_UVS, 5, [0, 1, 2])])
}

#[test]
fn versions_precisions_and_attributes() {
    for version in [3, 4] {
        for double in [0, DOUBLE_PRECISION] {
            let all = HAS_NORMALS | HAS_UVS | HAS_COLORS | FACE_NORMALS | double;
            let bytes = file(version, &[content(version, double, 0, [0, 1, 2]), content(version, all, 8, [2, 1, 0])]);
            let (plain, notes) = from_bytes(&bytes, 0).unwrap();
            assert_eq!((plain.mesh.positions.len(), plain.mesh.triangles.as_slice()), (3, &[[0, 1, 2]][..]));
            assert!(plain.mesh.normals.is_empty() && !plain.face_normals && notes.is_empty());
            let (full, _) = from_bytes(&bytes, 1).unwrap();
            assert_eq!(full.name, if version == 4 { "Tür" } else { "" });
            assert!(full.face_normals && (full.mesh.normals[0].length() - 1.0).abs() < 1e-6);
            assert_eq!(full.mesh.uvs[0], Vec2::new(2.5, 2.75));
            assert_eq!(full.mesh.colors[0], Vec3::new(4.0, 4.25, 4.5));
            assert_eq!(full.mesh.positions[1], Vec3::X);
        }
    }
}

#[test]
fn broken_files_are_refused() {
    let good = content(4, 0, 0, [0, 1, 2]);
    let with = |content: Vec<u8>| from_bytes(&file(4, &[content]), 0).unwrap_err();
    assert!(with(content(4, 0, 0, [0, 1, 3])).contains("vertex index 3 is out of range: the mesh has 3 vertices"));
    assert!(with(good[..good.len() - 1].to_vec()).contains("end too early"));
    let mut huge = good.clone();
    huge[9..17].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(with(huge.clone()).contains("beyond the limit"));
    huge[9..17].copy_from_slice(&(1u64 << 29).to_le_bytes());
    assert!(with(huge).contains("end too early"));
    let mut nan = good.clone();
    nan[25..29].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(with(nan).contains("vertex 0 is not finite"));

    let whole = file(4, &[good]);
    assert!(from_bytes(&whole, 1).unwrap_err().contains("the file has 1"));
    for cut in 0..whole.len() {
        assert!(from_bytes(&whole[..cut], 0).is_err(), "cut at {cut}");
    }
    assert!(from_bytes(b"no mesh at all", 0).unwrap_err().contains("no Mitsuba serialized mesh"));
    let mut version = whole;
    version[2] = 9;
    assert!(from_bytes(&version, 0).unwrap_err().contains("version 9"));
}
