//! Scenes from strings, in a folder of their own.

use photinus_scene::{LoadError, LoadOptions, Material, Scene, load};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder with files, the scene among them.
pub struct Folder(pub TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(TempDir::new().expect("a temporary folder"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    /// A red 2 x 2 PNG would need an encoder; a TGA needs 18 bytes of header.
    pub fn write_tga(&self, name: &str, width: u16, height: u16, bgr: &[[u8; 3]]) {
        let mut bytes = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        bytes.extend(width.to_le_bytes());
        bytes.extend(height.to_le_bytes());
        // 24 bits, top row first.
        bytes.extend([24, 0x20]);
        bytes.extend(bgr.iter().flatten());
        self.write(name, bytes);
    }

    pub fn load(&self, body: &str) -> Result<Scene, LoadError> {
        self.load_version("3.0.0", body)
    }

    pub fn load_version(&self, version: &str, body: &str) -> Result<Scene, LoadError> {
        let path = self.write("scene.xml", format!("<scene version=\"{version}\">\n{body}\n</scene>\n"));
        load(&path, &LoadOptions::default())
    }
}

/// The scene of a body; panics with the error.
pub fn scene(body: &str) -> Scene {
    Folder::new().load(body).unwrap_or_else(|e| panic!("{body}\n{e}"))
}

/// As [`scene`], of an older version.
pub fn scene_of(version: &str, body: &str) -> Scene {
    Folder::new().load_version(version, body).unwrap_or_else(|e| panic!("{body}\n{e}"))
}

/// The error of a body, as its one line; panics where it loads.
pub fn error(body: &str) -> String {
    match Folder::new().load(body) {
        Ok(_) => panic!("should be refused:\n{body}"),
        Err(e) => one_line(&e),
    }
}

/// An error's text, which has to be one line.
pub fn one_line(error: &LoadError) -> String {
    let text = error.to_string();
    assert!(!text.contains('\n') && text.len() < 3000, "not one line: {text}");
    text
}

/// Warnings apart from those about a missing camera or light.
pub fn warnings(scene: &Scene) -> Vec<String> {
    let ours = |m: &str| m.starts_with("no camera") || m.starts_with("no light");
    scene.warnings.iter().filter(|w| !ours(&w.message)).map(|w| format!("{}: {}", w.line, w.message)).collect()
}

/// The scene has no warnings of interest.
pub fn clean(scene: &Scene) {
    assert_eq!(warnings(scene), Vec::<String>::new());
}

/// The last material of a scene.
pub fn last_material(scene: &Scene) -> &Material {
    &scene.materials.last().expect("a material").material
}

/// The folder of real scenes; says so in one line where it is not set.
#[allow(clippy::print_stdout, reason = "a suite that does not run has to say so")]
pub fn real_scenes() -> Option<PathBuf> {
    match std::env::var_os("PHOTINUS_SCENES") {
        Some(path) => Some(Path::new(&path).to_path_buf()),
        None => {
            println!("PHOTINUS_SCENES is not set: the suite of real scenes did not run");
            None
        }
    }
}
