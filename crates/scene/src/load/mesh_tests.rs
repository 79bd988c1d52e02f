//! All mesh readers on real files (where `PHOTINUS_SCENES` is set) and on seeded damage to small good ones.

// Whoever runs the tests must see what did not run.
#![allow(clippy::print_stderr)]

use super::obj::MissingNormals;
use super::*;
use crate::{Geometry, Mesh};
use photinus_num::philox4x32;
use std::path::PathBuf;

/// The folder of the real scenes, or none and a line that says so.
fn scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("PHOTINUS_SCENES").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("PHOTINUS_SCENES is not set: the suite of real mesh files did not run");
    }
    folder
}

/// What must come of a file.
enum Verdict {
    /// It loads, with so many triangles.
    Loads(usize),
    /// It loads with so many triangles and a warning that contains this.
    Warns(usize, &'static str),
    /// It is refused with a message that contains this.
    Refused(&'static str),
}
use Verdict::{Loads, Refused, Warns};

/// Every file of `nasty/obj`, `nasty/ply` and `nasty/stl_off` that is a mesh; see docs/robustness.md.
const NASTY: &[(&str, Verdict)] = &[
    ("obj/box_UTF16BE.obj", Loads(12)),
    ("obj/box_longline.obj", Loads(12)),
    ("obj/concave_polygon.obj", Loads(64)),
    ("obj/empty.obj", Refused("empty.obj: no faces: there is nothing to render")),
    ("obj/invalid-face-definition.obj", Refused("invalid-face-definition.obj: no faces")),
    ("obj/issue-140-zero-face-idx.obj", Refused("issue-140-zero-face-idx.obj:16: vertex index 0: indices begin at 1")),
    ("obj/issue-161-inconsistent-f.obj", Warns(12, "cube.mtl: no such file")),
    ("obj/issue-295-trianguation-failure.obj", Loads(28)),
    ("obj/malformed.obj", Refused("malformed.obj:28: vertex index 0: indices begin at 1")),
    ("obj/missing_material_file.obj", Warns(36, "material \"white\" is in no library: read as grey")),
    ("obj/mtl filename with whitespace issue46.obj", Warns(12, "invalid file with spaces.mtl: no such file")),
    ("obj/nancolor.obj", Warns(12, "nancolor.obj:7: 1 vertex colour(s) not finite: read as white")),
    ("obj/notenoughindices.obj", Warns(1, "notenoughindices.obj:9: 1 face(s) with fewer than 3 corners: skipped")),
    ("obj/number_formats.obj", Refused("number_formats.obj:11: \"3.1+e2\" is not a number")),
    ("obj/obj_with_no_face_in_chunk.obj", Loads(1)),
    ("obj/test-nan.obj", Refused("test-nan.obj:12: vertex (NaN, NaN, NaN) is not finite")),
    ("ply/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", Refused(".ply:6: the header has no end_header")),
    ("ply/cube_binary_header_with_RN_newline.ply", Loads(12)),
    ("ply/empty.ply", Warns(0, "no faces")),
    ("ply/issue623.ply", Warns(0, "no faces")),
    ("ply/ply_empty_header.ply", Refused("no element \"vertex\"")),
    ("ply/points_ascii_with_lists.ply", Warns(0, "no faces")),
    ("stl_off/comments.off", Refused("OFF is not supported; supported are")),
    ("stl_off/invalid.off", Refused("OFF is not supported")),
    ("stl_off/stl_empty_ascii.stl", Warns(0, "no facets")),
    ("stl_off/triangle_with_empty_solid.stl", Loads(1)),
];

/// Triangles of sound files, as the scenes' own list has them.
const SOUND: &[(&str, usize)] = &[
    ("cornell/mcguire/CornellBox-Empty-CO.obj", 12),
    ("cornell/mcguire/CornellBox-Empty-RG.obj", 12),
    ("cornell/mcguire/CornellBox-Empty-Squashed.obj", 12),
    ("cornell/mcguire/CornellBox-Empty-White.obj", 12),
    ("cornell/mcguire/CornellBox-Glossy.obj", 1112),
    ("cornell/mcguire/CornellBox-Mirror.obj", 36),
    ("cornell/mcguire/CornellBox-Original.obj", 36),
    ("cornell/mcguire/CornellBox-Sphere.obj", 2188),
    ("cornell/mcguire/CornellBox-Water.obj", 7088),
    ("cornell/mcguire/water.obj", 4900),
    ("models/beetle.obj", 2053),
    ("models/bunny_lowres.ply", 948),
    ("models/cow.obj", 5804),
    ("models/rectangle.obj", 2),
    ("models/sphere.ply", 840),
    ("models/spot.obj", 5856),
    ("models/suzanne.obj", 968),
    ("models/teapot.obj", 6320),
    ("models/teapot.ply", 2256),
    ("odd/catmark_torus_creases0.obj", 64),
    ("odd/cornell_box.obj", 36),
    ("odd/cornell_box_multimaterial.obj", 36),
    ("odd/cube-vertexcol.obj", 12),
    ("odd/cube.obj", 12),
    ("odd/cube_compressed.obj", 12),
    ("odd/groups.obj", 2308),
    ("odd/issue-162-smoothing-group.obj", 12),
    ("odd/joined_tetrahedra.obj", 8),
    ("odd/mtllib-multiple-files-issue-112.obj", 1),
    ("odd/negative_indices.obj", 12),
    ("odd/nonascii/bench/bench.obj", 2516),
    ("odd/not_convex.obj", 96),
    ("odd/obj/cbox_smallbox.obj", 12),
    ("odd/obj/rectangle_normals.obj", 2),
    ("odd/obj/rectangle_normals_uv.obj", 2),
    ("odd/obj/rectangle_uv.obj", 2),
    ("odd/pbr-mat-ext.obj", 2),
    ("odd/ply/cbox_smallbox.ply", 12),
    ("odd/ply/rectangle_normals.ply", 2),
    ("odd/ply/rectangle_normals_uv.ply", 2),
    ("odd/ply/rectangle_uv.ply", 2),
    ("odd/ply/triangle.ply", 1),
    ("odd/ply/triangle_face_colors.ply", 1),
    ("odd/polygonfaces.obj", 3),
    ("odd/refl.obj", 12),
    ("odd/smoothing-group-two-squares.obj", 3),
    ("odd/texture-filename-with-whitespace.obj", 12),
    ("odd/texture-options-issue-85.obj", 1),
    ("odd/tr-and-d-issue-43.obj", 400),
    ("plants/decorativePlant/decorativePlant.obj", 63428),
    ("plants/plantie/plantie.obj", 22838),
    ("rooms/furniture-obj/beerGlass/beerGlass.obj", 9836),
    ("rooms/furniture-obj/lamp2/lamp2.obj", 12774),
    ("rooms/furniture-obj/oakChair/oakChair.obj", 31786),
];

/// Everything that the model promises of a mesh.
fn assert_sound(mesh: &Mesh, what: &str) {
    let n = mesh.positions.len();
    assert!(mesh.positions.iter().all(|p| p.is_finite()), "{what}: positions");
    assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < n), "{what}: indices");
    assert!([mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()].iter().all(|&l| l == 0 || l == n), "{what}");
    assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "{what}: normals");
    assert!(mesh.uvs.iter().all(|x| x.is_finite()) && mesh.colors.iter().all(|x| x.is_finite()), "{what}: attributes");
}

fn assert_scene_sound(scene: &Scene, what: &str) {
    for shape in &scene.shapes {
        let Geometry::Mesh(mesh) = &shape.geometry else { continue };
        assert_sound(mesh, what);
        assert!((shape.material.0 as usize) < scene.materials.len(), "{what}");
    }
    for (i, m) in scene.materials.iter().enumerate() {
        assert!(m.material.nested().all(|n| (n.0 as usize) < i), "{what}: material {i} nests a later one");
    }
}

#[test]
fn the_page_on_robustness_has_every_verdict() {
    let page = include_str!("../../../../docs/robustness.md");
    for (name, verdict) in NASTY {
        let row = page.lines().find(|l| l.starts_with('|') && l.contains(&format!("`{name}`")));
        let row = row.unwrap_or_else(|| panic!("docs/robustness.md has no row for {name}"));
        let expected = match verdict {
            Loads(1) | Warns(1, _) => "1 triangle".to_owned(),
            Loads(n) | Warns(n, _) => format!("{n} triangles"),
            Refused(_) => "refused".to_owned(),
        };
        assert!(row.contains(&expected), "{row}");
    }
}

fn files_under(folder: &Path, out: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files_under(&path, out);
        } else {
            out.push(path);
        }
    }
}

fn is_mesh(path: &Path) -> bool {
    let name = path.to_string_lossy().to_lowercase();
    ["obj", "ply", "stl", "off"].iter().any(|e| name.ends_with(&format!(".{e}")))
}

#[test]
fn nasty_files_get_their_verdict() {
    let Some(root) = scenes() else { return };
    for (name, verdict) in NASTY {
        let loaded = load(&root.join("nasty").join(name), &LoadOptions::default());
        match (verdict, loaded) {
            (Loads(triangles), Ok(scene)) => assert_eq!(scene.triangle_count(), *triangles, "{name}"),
            (Warns(triangles, warning), Ok(scene)) => {
                assert_eq!(scene.triangle_count(), *triangles, "{name}");
                let warnings: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
                assert!(warnings.iter().any(|w| w.contains(warning)), "{name}: {warnings:?}");
                assert_scene_sound(&scene, name);
            }
            (Refused(message), Err(error)) => {
                let text = error.to_string();
                assert!(text.contains(message) && !text.contains('\n'), "{name}: {text}");
            }
            (_, Ok(scene)) => panic!("{name}: loaded with {} triangles", scene.triangle_count()),
            (_, Err(error)) => panic!("{name}: {error}"),
        }
    }
    // The table is complete.
    let mut files = Vec::new();
    for folder in ["obj", "ply", "stl_off"] {
        files_under(&root.join("nasty").join(folder), &mut files);
    }
    for path in files.iter().filter(|p| is_mesh(p)) {
        assert!(NASTY.iter().any(|(name, _)| path.ends_with(name)), "{} has no verdict", path.display());
    }
}

#[test]
fn sound_files_have_their_triangles() {
    let Some(root) = scenes() else { return };
    for (name, triangles) in SOUND {
        let scene = load(&root.join(name), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(scene.triangle_count(), *triangles, "{name}");
        assert_scene_sound(&scene, name);
    }
}

#[test]
fn every_mesh_of_the_scenes_is_read() {
    let Some(root) = scenes() else { return };
    let mut files = Vec::new();
    for folder in ["atrium", "caustics", "cornell", "mitsuba-tests", "models", "odd", "plants", "rooms"] {
        files_under(&root.join(folder), &mut files);
    }
    let (mut meshes, mut living_room, mut sponza) = (0, 0, 0);
    for path in &files {
        let what = path.display().to_string();
        if is_mesh(path) {
            let scene = load(path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
            assert_scene_sound(&scene, &what);
            meshes += 1;
            if what.contains("living-room") {
                living_room += scene.triangle_count();
            }
        } else if what.ends_with(".serialized") {
            let options = LoadOptions::default();
            let mut context = Context::new(path, &options);
            let count = if what.contains("sponza") { 37 } else { 1 };
            for index in 0..count {
                let read = serialized::read_serialized(&Place::file(path), path, index, &mut context);
                let mesh = read.unwrap_or_else(|e| panic!("{e}")).mesh;
                assert_sound(&mesh, &what);
                sponza += if what.contains("sponza") { mesh.triangles.len() } else { 0 };
            }
            let beyond = serialized::read_serialized(&Place::file(path), path, count, &mut context);
            assert!(beyond.unwrap_err().to_string().contains("there is no such mesh"), "{what}");
            meshes += 1;
        }
    }
    assert!(meshes > 150, "{meshes} files");
    assert_eq!((living_room, sponza), (143_163, 66_445), "triangles as the scenes' list has them");
}

/// Small good files with everything their readers know.
fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let obj = "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1e0 1\nvt 0 0\nvt 1 0.5 0\nvn 0 0 1\n\
               vn 1 2 3\no a b\ng c\nusemtl m 1\ns 1\nf 1/1/1 2/2/1 3//2 \\\n 4\ns off\nf -1 -2 -3\nusemtl n\n\
               f 1 2 5 3 4\nf 2//1 3//1 5//1\n# end";
    let mtl = "newmtl m 1\nKd 1 .5 0\nKs .1 .1 .1\nNs 10\nKe 1 1 1\nmap_Kd -o 1 2 -s 3 -bm 2 a b.png\nd 0.5\nTr 0.5\n\
               illum 7\nTf 1 1 1\nNi 1.5\nPr 0.5\nbump x.png -bm 1\nmap_d -clamp on y.png\nnewmtl n\nKd xyz 1 1 1\n";
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty float \
             z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int \
             vertex_indices\nproperty list uchar float texcoord\nelement tristrips 1\nproperty list int int \
             vertex_indices\nend_header\n"
        )
    };
    let text_ply = header("ascii")
        + "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n6 0 1 2 3 -1 0\n";
    let mut binary_ply = header("binary_little_endian").into_bytes();
    for p in [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        binary_ply.extend(p.iter().flat_map(|x| x.to_le_bytes()).chain([1, 2, 3]));
    }
    binary_ply.push(4);
    binary_ply.extend([0i32, 1, 2, 3].iter().flat_map(|x| x.to_le_bytes()));
    binary_ply.push(8);
    binary_ply.extend([0f32; 8].iter().flat_map(|x| x.to_le_bytes()));
    binary_ply.extend([5i32, 0, 1, 2, -1, 3].iter().flat_map(|x| x.to_le_bytes()));
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
               endsolid a\nsolid b\nendsolid b\n";
    let mut binary_stl = vec![b'x'; 80];
    binary_stl.extend(2u32.to_le_bytes());
    binary_stl.extend([0u8; 100]);
    vec![
        ("obj", obj.into()),
        ("mtl", mtl.into()),
        ("ply", text_ply.into_bytes()),
        ("ply", binary_ply),
        ("stl", stl.into()),
        ("stl", binary_stl),
        ("serialized", serialized::tests::sample_file()),
    ]
}

/// Reads damaged bytes; only a panic or a mesh that breaks the model's promises is wrong.
fn read_damaged(kind: &str, bytes: &[u8], what: &str) {
    match kind {
        "obj" => {
            for missing in [MissingNormals::LeaveOut, MissingNormals::AsFileSays { crease_cosine: 0.9 }] {
                if let Ok((file, _)) = obj::from_bytes(bytes, missing) {
                    file.parts.iter().for_each(|p| assert_sound(&p.mesh, what));
                }
            }
        }
        "mtl" => drop(mtl::parse(bytes)),
        "ply" => drop(ply::from_bytes(bytes).map(|(mesh, _)| assert_sound(&mesh, what))),
        "stl" => drop(stl::from_bytes(bytes).map(|(mesh, _)| assert_sound(&mesh, what))),
        "serialized" => drop(serialized::from_bytes(bytes, 0).map(|(m, _)| assert_sound(&m.mesh, what))),
        other => panic!("no reader for {other}"),
    }
}

/// `bytes` with one to four injuries; a function of `key` alone.
fn damage(bytes: &[u8], key: [u32; 2]) -> Vec<u8> {
    const WORDS: [&[u8]; 12] =
        [b"-1", b"0", b"nan", b"1e999", b"99999999999", b"\n", b"f", b" ", b"\\\n", b"-", b"4294967295", b"/"];
    let mut out = bytes.to_vec();
    let injuries = 1 + philox4x32([0, 0, 0, 1], key)[0] % 4;
    for i in 0..injuries {
        let r = philox4x32([i, 0, 0, 2], key);
        let length = out.len().max(1);
        let at = (r[0] as usize % length).min(out.len());
        let end = (at + 1 + r[1] as usize % 16).min(out.len());
        match r[2] % 6 {
            0 if at < out.len() => out[at] ^= 1 << (r[3] % 8),
            1 if at < out.len() => out[at] = r[3] as u8,
            2 => out.truncate(at),
            3 => drop(out.drain(at..end)),
            4 => {
                let copy = out[at..end].to_vec();
                out.splice(at..at, copy);
            }
            _ => drop(out.splice(at..end, WORDS[r[3] as usize % WORDS.len()].iter().copied())),
        }
    }
    out
}

#[test]
fn damaged_files_are_read_or_refused_and_nothing_else() {
    const SEED: u32 = 20_051;
    let started = std::time::Instant::now();
    for (s, (kind, bytes)) in seeds().iter().enumerate() {
        read_damaged(kind, bytes, "undamaged");
        for case in 0..4000 {
            read_damaged(
                kind,
                &damage(bytes, [SEED + s as u32, case]),
                &format!("{kind}, seed {SEED}, case {s}/{case}"),
            );
        }
        for cut in 0..bytes.len() {
            read_damaged(kind, &bytes[..cut], &format!("{kind} {s} cut at {cut}"));
        }
    }
    assert!(started.elapsed().as_secs() < 20, "{:?}", started.elapsed());
}

#[test]
fn damaged_real_files_are_read_or_refused_and_nothing_else() {
    let Some(root) = scenes() else { return };
    let mut files = Vec::new();
    for folder in ["nasty/obj", "nasty/ply", "nasty/stl_off", "odd"] {
        files_under(&root.join(folder), &mut files);
    }
    let mut cases = 0;
    for path in files {
        let kind = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
        let bytes = std::fs::read(&path).unwrap();
        if bytes.len() > 20_000 || !["obj", "mtl", "ply", "stl", "serialized"].contains(&kind.as_str()) {
            continue;
        }
        for case in 0..40 {
            read_damaged(&kind, &damage(&bytes, [7, case]), &format!("{}, case {case}", path.display()));
            cases += 1;
        }
    }
    assert!(cases > 2000, "{cases} cases");
}

/// Prints the speed at which OBJ text becomes meshes; the floor is far below what an idle machine does.
#[test]
fn obj_text_is_read_fast() {
    let Some(root) = scenes() else { return };
    let mut files = Vec::new();
    files_under(&root.join("rooms/living-room-mitsuba/models"), &mut files);
    let texts: Vec<Vec<u8>> = files.iter().filter(|p| is_mesh(p)).map(|p| std::fs::read(p).unwrap()).collect();
    let bytes: usize = texts.iter().map(Vec::len).sum();
    let seconds = (0..3)
        .map(|_| {
            let started = std::time::Instant::now();
            for text in &texts {
                assert!(!obj::from_bytes(text, MissingNormals::LeaveOut).unwrap().0.parts.is_empty());
            }
            started.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    let megabytes_per_second = bytes as f64 / seconds / 1e6;
    eprintln!("OBJ: {bytes} bytes at {megabytes_per_second:.0} MB/s");
    assert!(megabytes_per_second > 15.0, "{megabytes_per_second:.0} MB/s");
}
