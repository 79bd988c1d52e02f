//! A scene reads files inside its own folder only, whatever the way out of it, unless the caller allows it.

use photinus_scene::{LoadError, LoadOptions, Scene, load};
use std::io::Write;
use std::path::PathBuf;

/// What the referring file says before and after the path.
struct Reference {
    /// For messages.
    name: &'static str,
    /// The file that holds the reference, `FILE` standing for the path.
    scene: (&'static str, &'static str),
    /// A file beside it through which the reference goes (a material library), if any.
    library: Option<(&'static str, &'static str)>,
    /// The file referred to: its name and content.
    target: (&'static str, fn() -> Vec<u8>),
    /// Line of the reference, in the library where there is one.
    line: u32,
}

const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

fn obj() -> Vec<u8> {
    b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()
}

fn ply() -> Vec<u8> {
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
      element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        .to_vec()
}

fn stl() -> Vec<u8> {
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
        .to_vec()
}

/// One triangle in single precision, version 4.
fn serialized() -> Vec<u8> {
    let mut content = 0x1000u32.to_le_bytes().to_vec();
    content.push(0);
    content.extend(3u64.to_le_bytes());
    content.extend(1u64.to_le_bytes());
    content.extend([0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()));
    content.extend([0u32, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
    let mut zlib = flate2::write::ZlibEncoder::new(vec![0x1c, 0x04, 4, 0], flate2::Compression::default());
    zlib.write_all(&content).unwrap();
    let mut file = zlib.finish().unwrap();
    file.extend(0u64.to_le_bytes());
    file.extend(1u32.to_le_bytes());
    file
}

/// One red pixel.
fn tga() -> Vec<u8> {
    vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0x20, 0, 0, 255]
}

fn xml_part() -> Vec<u8> {
    b"<scene version='3.0.0'><shape type='cube'/></scene>".to_vec()
}

fn spectrum() -> Vec<u8> {
    b"360 0.25\n830 0.25\n".to_vec()
}

fn library() -> Vec<u8> {
    b"newmtl m\nKd 1 0 0\n".to_vec()
}

/// Every way in which a file of any format names another.
const REFERENCES: &[Reference] = &[
    mitsuba("include", "<include filename='FILE'/>", "part.xml", xml_part),
    mitsuba("obj", "<shape type='obj'><string name='filename' value='FILE'/></shape>", "m.obj", obj),
    mitsuba("ply", "<shape type='ply'><string name='filename' value='FILE'/></shape>", "m.ply", ply),
    mitsuba("stl", "<shape type='stl'><string name='filename' value='FILE'/></shape>", "m.stl", stl),
    mitsuba(
        "serialized",
        "<shape type='serialized'><string name='filename' value='FILE'/></shape>",
        "m.serialized",
        serialized,
    ),
    mitsuba("bitmap", "<texture type='bitmap' id='t'><string name='filename' value='FILE'/></texture>", "p.tga", tga),
    mitsuba("envmap", "<emitter type='envmap'><string name='filename' value='FILE'/></emitter>", "p.tga", tga),
    mitsuba(
        "normalmap",
        "<bsdf type='normalmap'><texture type='bitmap'><string name='filename' value='FILE'/></texture><bsdf type='diffuse'/></bsdf>",
        "p.tga",
        tga,
    ),
    mitsuba(
        "spectrum",
        "<bsdf type='diffuse'><spectrum name='reflectance' filename='FILE'/></bsdf>",
        "grey.spd",
        spectrum,
    ),
    Reference {
        name: "mtllib",
        scene: ("scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib FILE\nusemtl m\nf 1 2 3\n"),
        library: None,
        target: ("b.mtl", library),
        line: 4,
    },
    material("map_Kd", "newmtl m\nKd 1 1 1\nmap_Kd FILE\n"),
    material("map_Ks", "newmtl m\nKs 1 1 1\nmap_Ks FILE\n"),
    material("map_Ke", "newmtl m\nKe 1 1 1\nmap_Ke FILE\n"),
    material("map_d", "newmtl m\n\nmap_d FILE\n"),
    material("map_Pr", "newmtl m\n\nmap_Pr FILE\n"),
    material("map_Pm", "newmtl m\n\nmap_Pm FILE\n"),
    material("map_Ps", "newmtl m\n\nmap_Ps FILE\n"),
    material("bump", "newmtl m\n\nbump -bm 2 FILE\n"),
    material("norm", "newmtl m\n\nnorm FILE\n"),
];

const fn mitsuba(name: &'static str, body: &'static str, target: &'static str, content: fn() -> Vec<u8>) -> Reference {
    Reference { name, scene: ("scene.xml", body), library: None, target: (target, content), line: 2 }
}

const fn material(name: &'static str, text: &'static str) -> Reference {
    Reference { name, scene: ("scene.obj", OBJ), library: Some(("a.mtl", text)), target: ("p.tga", tga), line: 3 }
}

/// A folder `inner` for the scene in a folder with others beside it.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("inner")).unwrap();
        Self { folder }
    }

    fn root(&self) -> PathBuf {
        // Without links, as the temporary folder may lie behind one.
        self.folder.path().canonicalize().unwrap()
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.root().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Writes the scene with the path put in, and loads it.
    fn load(&self, reference: &Reference, path: &str, allow_outside: bool) -> Result<Scene, LoadError> {
        let (name, text) = reference.scene;
        let mut text = text.replace("FILE", path);
        if name.ends_with(".xml") {
            text = format!("<scene version='3.0.0'>\n{text}\n</scene>");
        }
        let scene = self.write(&format!("inner/{name}"), text);
        if let Some((name, text)) = reference.library {
            self.write(&format!("inner/{name}"), text.replace("FILE", path));
        }
        load(&scene, &LoadOptions { allow_outside, ..LoadOptions::default() })
    }
}

/// Warnings of a scene apart from those about a missing camera or light.
fn warnings(scene: &Scene) -> Vec<&str> {
    let ours = |m: &str| m.starts_with("no camera") || m.starts_with("no light");
    scene.warnings.iter().map(|w| w.message.as_str()).filter(|m| !ours(m)).collect()
}

/// The error names file and line of the reference, the path and the option, in one line.
fn assert_names_all(error: &LoadError, reference: &Reference, path: &str, way: &str) {
    let said = error.to_string();
    let asking = reference.library.map_or(reference.scene.0, |(name, _)| name);
    let what = format!("{} by {way}: {said}", reference.name);
    assert!(matches!(error, LoadError::Outside { .. }), "{what}");
    assert_eq!(said.lines().count(), 1, "{what}");
    assert!(said.contains(&format!("{asking}:{}: ", reference.line)), "{what}");
    assert!(said.contains(path) && said.contains("--allow-outside"), "{what}");
}

#[test]
fn no_reference_leads_out_of_the_folder_without_permission() {
    for reference in REFERENCES {
        let (name, content) = reference.target;
        let place = Place::new();
        let outside = place.write(&format!("other/{name}"), content());
        // A folder whose name begins like the scene's.
        place.write(&format!("inner2/{name}"), content());
        place.write(&format!("inner/sub/{name}"), content());
        let absolute = outside.to_str().unwrap().to_owned();
        let mut ways = vec![
            ("..", format!("../other/{name}")),
            ("a folder and ..", format!("sub/../../other/{name}")),
            ("backslashes", format!("..\\other\\{name}")),
            ("the other case", format!("../other/{}", name.to_uppercase())),
            ("a name that begins alike", format!("../inner2/{name}")),
            ("an absolute path", absolute),
        ];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&outside, place.root().join("inner").join(format!("link-{name}"))).unwrap();
            std::os::unix::fs::symlink(place.root().join("other"), place.root().join("inner/tied")).unwrap();
            ways.push(("a link", format!("link-{name}")));
            ways.push(("a link to a folder", format!("tied/{name}")));
            ways.push(("a link and back", format!("tied/../other/{name}")));
        }
        for (way, path) in &ways {
            // Where upper and lower case differ, the file is found under its own name.
            let found = if *way == "the other case" { name } else { path.rsplit(['/', '\\']).next().unwrap() };
            let error = place.load(reference, path, false).map(|_| ()).unwrap_err();
            assert_names_all(&error, reference, found, way);
            let scene =
                place.load(reference, path, true).unwrap_or_else(|e| panic!("{} by {way}: {e}", reference.name));
            assert_eq!(warnings(&scene), Vec::<&str>::new(), "{} by {way}", reference.name);
        }
    }
}

#[test]
fn what_stays_inside_needs_no_permission() {
    for reference in REFERENCES {
        let (name, content) = reference.target;
        let place = Place::new();
        let inside = place.write(&format!("inner/sub/{name}"), content());
        let mut ways = vec![
            format!("sub/{name}"),
            format!("sub/../sub/./{name}"),
            format!("../inner/sub/{name}"),
            inside.to_str().unwrap().to_owned(),
        ];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&inside, place.root().join("inner").join(name)).unwrap();
            std::os::unix::fs::symlink(place.root().join("inner/sub"), place.root().join("inner/tied")).unwrap();
            ways.extend([name.to_owned(), format!("tied/{name}")]);
        }
        for path in &ways {
            let scene = place.load(reference, path, false).unwrap_or_else(|e| panic!("{}: {e}", reference.name));
            assert_eq!(warnings(&scene), Vec::<&str>::new(), "{}", reference.name);
        }
    }
}

/// The root stays the scene's own folder: neither an include nor a folder to look in moves it.
#[test]
fn includes_and_search_folders_do_not_move_the_root() {
    for reference in REFERENCES.iter().filter(|r| r.scene.0 == "scene.xml") {
        let (name, content) = reference.target;
        let place = Place::new();
        place.write(&format!("other/{name}"), content());
        place.write(&format!("inner/beside-{name}"), content());
        let part = |path: &str| {
            let text = format!("<scene version='3.0.0'>\n{}\n</scene>", reference.scene.1.replace("FILE", path));
            place.write("inner/sub/deep/outer.xml", text)
        };
        let including = |head: &str| Reference {
            scene: ("scene.xml", if head.is_empty() { INCLUDE } else { INCLUDE_WITH_PATH }),
            ..mitsuba(reference.name, "", name, content)
        };
        // From within an include: up out of the root, and up but still inside.
        part(&format!("../../../other/{name}"));
        let error = place.load(&including(""), "", false).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("outer.xml:2: "), "{error}");
        assert!(matches!(error, LoadError::Outside { .. }), "{error}");
        place.load(&including(""), "", true).unwrap();
        part(&format!("../../beside-{name}"));
        assert_eq!(warnings(&place.load(&including(""), "", false).unwrap()), Vec::<&str>::new());
        // By a folder to look in.
        part(name);
        let error = place.load(&including("path"), "", false).map(|_| ()).unwrap_err();
        assert!(matches!(error, LoadError::Outside { .. }), "{}: {error}", reference.name);
        place.load(&including("path"), "", true).unwrap();
    }
}

const INCLUDE: &str = "<include filename='sub/deep/outer.xml'/>";
const INCLUDE_WITH_PATH: &str = "<path value='../other'/><include filename='sub/deep/outer.xml'/>";

/// Whoever names a file wants it read, even where it is a link; its folder is that of the name.
#[cfg(unix)]
#[test]
fn the_file_that_the_user_names_may_be_a_link() {
    let files: [(&str, Vec<u8>); 4] = [
        (
            "scene.xml",
            b"<scene version='3.0.0'><shape type='ply'><string name='filename' value='m.ply'/></shape></scene>"
                .to_vec(),
        ),
        ("a.obj", obj()),
        ("a.ply", ply()),
        ("a.stl", stl()),
    ];
    for (name, content) in files {
        let place = Place::new();
        let real = place.write(&format!("other/{name}"), content);
        let link = place.root().join("inner").join(name);
        std::os::unix::fs::symlink(real, &link).unwrap();
        place.write("inner/m.ply", ply());
        let scene = load(&link, &LoadOptions::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(scene.triangle_count(), 1, "{name}");
        assert_eq!(warnings(&scene), Vec::<&str>::new());
    }
}
