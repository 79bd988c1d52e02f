//! The list of plug-ins: each is read or replaced as it says, and the documentation has the same list.

use crate::common::*;
use photinus_scene::load::mitsuba_plugins::{REPLACED, SUPPORTED};

/// A plug-in with what it cannot do without.
fn minimal(tag: &str, kind: &str) -> String {
    let diffuse = "<bsdf type='diffuse'/>";
    let inner = match (tag, kind) {
        ("shape", "obj" | "ply" | "serialized" | "stl") => "<string name='filename' value='mesh'/>".to_string(),
        ("shape", "instance") => "<shape type='shapegroup'><shape type='cube'/></shape>".to_string(),
        ("bsdf", "twosided" | "mask" | "coating" | "roughcoating") => diffuse.to_string(),
        ("bsdf", "blendbsdf") => format!("<float name='weight' value='0.5'/>{diffuse}{diffuse}"),
        ("bsdf", "mixturebsdf") => format!("<string name='weights' value='0.5, 0.5'/>{diffuse}{diffuse}"),
        ("bsdf", "bumpmap" | "normalmap") => format!("<texture type='checkerboard'/>{diffuse}"),
        ("emitter", "envmap") | ("texture", "bitmap") => "<string name='filename' value='picture.tga'/>".to_string(),
        ("texture", "scale") => "<texture type='checkerboard'/>".to_string(),
        ("sensor", "thinlens") => "<float name='aperture_radius' value='0.1'/>".to_string(),
        _ => String::new(),
    };
    let xml = format!("<{tag} type='{kind}'>{inner}</{tag}>");
    match (tag, kind) {
        ("film", _) => format!("<sensor type='perspective'>{xml}</sensor>"),
        ("rfilter", _) => format!("<sensor type='perspective'><film type='hdrfilm'>{xml}</film></sensor>"),
        ("emitter", "area") => format!("<shape type='cube'>{xml}</shape>"),
        _ => xml,
    }
}

/// A folder with a mesh called `mesh` in the format of a shape, and a picture.
fn folder(kind: &str) -> Folder {
    let folder = Folder::new();
    folder.write_tga("picture.tga", 1, 1, &[[1, 2, 3]]);
    let triangle = "0 0 0\n1 0 0\n0 1 0\n";
    let mesh = match kind {
        "obj" => "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".as_bytes().to_vec(),
        "ply" => format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n{triangle}3 0 1 2\n"
        )
        .into_bytes(),
        "stl" => {
            let corners = triangle.lines().map(|l| format!("vertex {l}\n")).collect::<String>();
            format!("solid a\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid a\n").into_bytes()
        }
        "serialized" => serialized(),
        _ => return folder,
    };
    folder.write("mesh", mesh);
    folder
}

/// One triangle in Mitsuba's serialized format, version 3, single precision, stored without compression.
fn serialized() -> Vec<u8> {
    let mut body = 0x1000_u32.to_le_bytes().to_vec();
    body.extend(3_u64.to_le_bytes());
    body.extend(1_u64.to_le_bytes());
    for v in [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        body.extend(v.to_le_bytes());
    }
    for i in [0_u32, 1, 2] {
        body.extend(i.to_le_bytes());
    }
    // A zlib stream (RFC 1950) of one stored block (RFC 1951).
    let mut bytes = vec![0x1c, 0x04, 0x03, 0x00, 0x78, 0x01, 0x01];
    bytes.extend((body.len() as u16).to_le_bytes());
    bytes.extend((!(body.len() as u16)).to_le_bytes());
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in &body {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    bytes.extend(&body);
    bytes.extend(((b << 16) | a).to_be_bytes());
    bytes.extend(0_u32.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes
}

#[test]
fn every_listed_plugin_is_read_without_a_word() {
    for p in SUPPORTED {
        let s = folder(p.kind).load(&minimal(p.tag, p.kind)).unwrap_or_else(|e| panic!("{} {}: {e}", p.tag, p.kind));
        assert_eq!(warnings(&s), Vec::<String>::new(), "{} {}", p.tag, p.kind);
        match p.tag {
            "shape" if p.kind != "shapegroup" && p.kind != "merge" => assert_eq!(s.shapes.len(), 1, "{}", p.kind),
            "bsdf" => assert!(!s.materials.is_empty()),
            "texture" => assert!(!s.textures.is_empty()),
            _ => {}
        }
    }
}

#[test]
fn every_replaced_plugin_is_one_warning_that_names_it() {
    for (tag, kind, _) in REPLACED {
        let s = folder(kind).load(&minimal(tag, kind)).unwrap_or_else(|e| panic!("{tag} {kind}: {e}"));
        let w = warnings(&s);
        assert!(w.len() == 1 && w[0].contains(&format!("\"{kind}\"")), "{tag} {kind}: {w:?}");
    }
}

#[test]
fn the_documentation_has_the_same_tables() {
    let text = include_str!("../../../../docs/scenes.md");
    let rows = |heading: &str| -> Vec<&str> {
        let section = text.split("\n## ").find(|s| s.starts_with(heading)).expect("the section");
        section.lines().filter(|l| l.starts_with("| ") && !l.starts_with("| kind")).collect()
    };
    let cell = |note: &str| if note.is_empty() { String::from(" |") } else { format!(" {note} |") };
    let supported: Vec<String> =
        SUPPORTED.iter().map(|p| format!("| {} | {} |{}", p.tag, p.kind, cell(p.note))).collect();
    assert_eq!(rows("Plug-ins that are read"), supported);
    let replaced: Vec<String> =
        REPLACED.iter().map(|(tag, kind, what)| format!("| {tag} | {kind} | {what} |")).collect();
    assert_eq!(rows("Plug-ins that are known and replaced"), replaced);
}
