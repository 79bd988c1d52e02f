//! Mesh files as shapes: normals, texture coordinates, parts.

use crate::common::*;
use photinus_geometry::{Vec2, Vec3};
use photinus_scene::{Geometry, Mesh, Scene};

fn mesh(scene: &Scene, i: usize) -> &Mesh {
    match &scene.shapes[i].geometry {
        Geometry::Mesh(m) => m,
        other => panic!("{other:?}"),
    }
}

/// A roof: two squares that meet at a right angle along the y axis, with texture coordinates.
const ROOF: &str = "v -1 0 -1\nv -1 2 -1\nv 0 0 0\nv 0 2 0\nv 1 0 -1\nv 1 2 -1\nvt 0 0.25\nvt 1 0.75\n\
    usemtl left\nf 1/1 3/2 4/1 2/2\nusemtl right\nf 3/2 5/1 6/2 4/1\n";

fn roof(inner: &str) -> Scene {
    let folder = Folder::new();
    folder.write("roof.obj", ROOF);
    let s = folder
        .load(&format!("<shape type='obj'><string name='filename' value='roof.obj'/>{inner}</shape>"))
        .unwrap_or_else(|e| panic!("{e}"));
    clean(&s);
    s
}

/// Normals of the vertices on the ridge.
fn ridge(m: &Mesh) -> Vec<Vec3> {
    (0..m.positions.len()).filter(|&i| m.positions[i].x == 0.0).map(|i| m.normals[i]).collect()
}

#[test]
fn normals_are_smooth_flat_or_creased() {
    let s = roof("");
    assert_eq!((s.shapes.len(), s.triangle_count()), (1, 4));
    let smooth = ridge(mesh(&s, 0));
    assert!(smooth.iter().all(|n| (*n - Vec3::Z).length() < 1e-5), "{smooth:?}");
    assert!(mesh(&roof("<boolean name='face_normals' value='true'/>"), 0).normals.is_empty());
    for (degrees, sharp) in [(30, true), (100, false)] {
        let s = roof(&format!("<float name='maxSmoothAngle' value='{degrees}'/>"));
        let up = ridge(mesh(&s, 0)).iter().all(|n| (*n - Vec3::Z).length() < 1e-5);
        assert_eq!(up, !sharp, "{degrees}");
    }
    let flipped = roof("<boolean name='flip_normals' value='true'/>");
    let m = mesh(&flipped, 0);
    assert!(ridge(m).iter().all(|n| (*n + Vec3::Z).length() < 1e-5));
    let p = m.triangles[0].map(|v| m.positions[v as usize]);
    assert!((p[1] - p[0]).cross(p[2] - p[0]).z < 0.0);
}

#[test]
fn texture_coordinates_stand_upright() {
    let vs = |s: &Scene| {
        let mut v: Vec<f32> = mesh(s, 0).uvs.iter().map(|uv| uv.y).collect();
        v.sort_by(f32::total_cmp);
        (v[0], v[v.len() - 1])
    };
    // OBJ is flipped where nothing is said, which is upright in the model.
    assert_eq!(vs(&roof("")), (0.25, 0.75));
    let plain = roof("<boolean name='flip_tex_coords' value='false'/>");
    assert!(mesh(&plain, 0).uvs.iter().any(|uv| *uv == Vec2::new(0.0, 0.75)));

    let folder = Folder::new();
    folder.write(
        "t.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
         property float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
         0 0 0 0 0.25\n1 0 0 1 0.25\n0 1 0 0 0.75\n3 0 1 2\n",
    );
    for (flip, expected) in [("", 0.75), ("<boolean name='flipTexCoords' value='true'/>", 0.25)] {
        let s =
            folder.load(&format!("<shape type='ply'><string name='filename' value='t.ply'/>{flip}</shape>")).unwrap();
        assert_eq!(mesh(&s, 0).uvs[0].y, expected);
    }
}

#[test]
fn named_bsdfs_choose_materials_of_an_obj_file() {
    let s = roof("<bsdf type='diffuse' name='left' id='l'/><bsdf type='conductor' name='right' id='r'/>");
    let made_of: Vec<_> = s.shapes.iter().map(|s2| s.materials[s2.material.0 as usize].name.as_str()).collect();
    assert_eq!(made_of, ["l", "r"]);
    assert_eq!(s.triangle_count(), 4);
}

#[test]
fn faces_turn_to_their_normals() {
    let folder = Folder::new();
    folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n");
    let s = folder.load("<shape type='obj'><string name='filename' value='t.obj'/></shape>").unwrap();
    let m = mesh(&s, 0);
    let p = m.triangles[0].map(|v| m.positions[v as usize]);
    assert!((p[1] - p[0]).cross(p[2] - p[0]).z < 0.0 && m.normals[0] == Vec3::NEG_Z);
}

#[test]
fn damaged_meshes_are_errors_that_name_both_files_place() {
    let folder = Folder::new();
    for (name, content) in [
        ("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
        ("short.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"),
        (
            "huge.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n\
          property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n",
        ),
        ("bad.serialized", "nothing of the kind"),
    ] {
        folder.write(name, content);
        let kind = name.rsplit('.').next().unwrap();
        let e = folder
            .load(&format!("<shape type='{kind}'><string name='filename' value='{name}'/></shape>"))
            .map(|s| s.triangle_count())
            .unwrap_err();
        assert!(one_line(&e).contains(name), "{e}");
    }
    let far = "<transform name='to_world'><scale value='1e39'/></transform>";
    folder.write("roof.obj", ROOF);
    let e = folder
        .load(&format!("<shape type='obj'>\n<string name='filename' value='roof.obj'/>{far}</shape>"))
        .unwrap_err();
    assert!(one_line(&e).contains("scene.xml:3"), "{e}");
}

#[test]
fn a_mesh_without_faces_is_left_out() {
    let folder = Folder::new();
    folder.write("empty.obj", "v 0 0 0\n");
    let s = folder.load("<shape type='obj'><string name='filename' value='empty.obj'/></shape>").unwrap();
    assert!(s.shapes.is_empty() && !warnings(&s).is_empty());
}

#[test]
fn names_of_other_systems_are_found() {
    let folder = Folder::new();
    folder.write("Meshes/R\u{f6}\u{f6}f 1.OBJ", ROOF);
    for name in ["Meshes\\R\u{f6}\u{f6}f 1.OBJ", "Meshes/r\u{f6}\u{f6}f 1.obj"] {
        let s = folder.load(&format!("<shape type='obj'><string name='filename' value='{name}'/></shape>")).unwrap();
        assert_eq!(s.triangle_count(), 4);
    }
}
