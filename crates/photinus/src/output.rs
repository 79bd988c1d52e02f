//! Files that this library writes beside pictures.

use crate::tree_drawing::TreeDrawing;
use crate::{Error, Result};
use serde::Serialize;
use std::path::Path;

/// Writes a JSON document: whoever looks finds the old file or the new one, whole.
///
/// # Errors
/// [`Error::Image`] or [`Error::Write`] where the file cannot be written.
pub fn write_json(path: &Path, document: &impl Serialize) -> Result<()> {
    let mut bytes = serde_json::to_vec_pretty(document)
        .map_err(|e| Error::Write { path: path.to_path_buf(), source: std::io::Error::other(e) })?;
    bytes.push(b'\n');
    Ok(photinus_image::write_atomic(path, &bytes)?)
}

/// Writes the drawing of a tree as PNG, or as SVG where the file's name ends in `.svg`.
///
/// # Errors
/// [`Error::Image`] where the file cannot be written.
pub fn write_drawing(path: &Path, drawing: &TreeDrawing) -> Result<()> {
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        return Ok(photinus_image::write_atomic(path, drawing.to_svg().as_bytes())?);
    }
    let (width, height) = (drawing.width as usize, drawing.height as usize);
    Ok(photinus_image::write_png8(path, width, height, &drawing.to_pixels())?)
}

/// Finds out whether a file can be written at `path`, before hours of work depend on it.
///
/// # Errors
/// [`Error::Write`] with what the system says.
pub fn check_writable(path: &Path) -> Result<()> {
    let refuse = |source| Error::Write { path: path.to_path_buf(), source };
    if path.is_dir() {
        return Err(refuse(std::io::Error::new(std::io::ErrorKind::IsADirectory, "it is a folder")));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    // A file of our own in the folder, gone again at once: permissions alone do not tell.
    tempfile::tempfile_in(folder).map_err(refuse)?;
    Ok(())
}

/// Removes temporary files that killed renders left in the folder of `path`: a file is written under another name and
/// renamed, and a program that is killed in between cannot tidy up. Those of running programs stay.
pub fn remove_abandoned(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    photinus_image::remove_abandoned(folder.unwrap_or(Path::new(".")));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_that_cannot_be_written_are_known_beforehand() {
        let folder = tempfile::tempdir().unwrap();
        assert!(check_writable(&folder.path().join("a.png")).is_ok());
        assert!(check_writable(Path::new("a.png")).is_ok());
        assert!(check_writable(&folder.path().join("missing/a.png")).is_err());
        assert!(check_writable(folder.path()).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left behind");
    }

    #[test]
    fn documents_are_json() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write_json(&path, &[1, 2]).unwrap();
        let read: Vec<u32> = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        assert_eq!(read, [1, 2]);
    }
}
