//! Hostile and odd files of the real-scene suite: each is one clear error or an image, never a panic.
// Whoever runs the tests must see what did not run, and the seed.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use photinus_image::{ImageError, decode, read_image, read_layers};
use std::path::{Path, PathBuf};

/// The suite's folder, or `None` (said aloud) where the suite does not run.
fn scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("PHOTINUS_SCENES").map(PathBuf::from);
    if folder.is_none() {
        println!("PHOTINUS_SCENES is not set: the suite of real image files did not run");
    }
    folder
}

fn files_below(folder: &Path, wanted: &dyn Fn(&Path) -> bool) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path, wanted));
        } else if wanted(&path) {
            files.push(path);
        }
    }
    files.sort();
    files
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|e| extensions.iter().any(|x| e.eq_ignore_ascii_case(x)))
}

fn assert_clear(path: &Path, error: &ImageError) {
    let line = error.to_string();
    assert_eq!(line.lines().count(), 1, "{line}");
    assert!(line.starts_with(&path.display().to_string()), "{line}");
    assert!(!error.what.is_empty() && !error.remedy.is_empty(), "{line}");
    assert!(!line.contains("gave up"), "a decoder panicked: {line}");
    assert!(!line.contains('{'), "a dump of a structure is no message: {line}");
}

#[test]
fn nasty_files_are_errors_or_images() {
    let Some(scenes) = scenes() else { return };
    let files: Vec<_> =
        ["exr", "png"].iter().flat_map(|kind| files_below(&scenes.join("nasty").join(kind), &|_| true)).collect();
    assert!(files.len() >= 18, "only {} files", files.len());
    let mut images = Vec::new();
    for path in &files {
        match read_image(path) {
            Ok(image) => {
                assert_eq!(image.pixels.len(), image.width * image.height);
                images.push(path.file_name().unwrap().to_string_lossy().into_owned());
            }
            Err(error) => assert_clear(path, &error),
        }
        if let Err(error) = decode(path) {
            assert_clear(path, &error);
        }
        if let Err(error) = read_layers(path) {
            assert_clear(path, &error);
        }
    }
    assert!(images.iter().any(|name| name == "BrightRingsNanInf.exr"), "a sound file with NaN and Inf was refused");
}

#[test]
fn real_images_are_read() {
    let Some(scenes) = scenes() else { return };
    let wanted = |path: &Path| {
        has_extension(path, &["exr", "png", "jpg", "jpeg", "hdr", "bmp", "tga"])
            && !path.starts_with(scenes.join("nasty"))
    };
    let files = files_below(&scenes, &wanted);
    assert!(files.len() >= 40, "only {} files", files.len());
    for path in &files {
        let image = read_image(path).unwrap_or_else(|error| panic!("{error}"));
        let decoded = decode(path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((image.width, image.height), (decoded.width, decoded.height), "{}", path.display());
        assert!(image.width > 0 && image.height > 0);
    }
}
