//! Embree's library, from the wheel that ships it.

use crate::Failure;
use crate::bench::commands::{run, unpack};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The version that the lock pins.
pub const EMBREE_VERSION: &str = "4.4.0";

/// A mesh that is there, as the driver takes it, or why it is not.
pub struct Provided {
    /// Its name.
    pub name: &'static str,
    /// The word of `--mesh`.
    pub word: Result<String, Failure>,
}

/// Fetches the wheel, once, and says where the library lies in it.
pub fn embree(root: &Path, folder: &Path) -> Result<PathBuf, Failure> {
    let place = folder.join("embree");
    if let Some(library) = find_library(&place) {
        return Ok(library);
    }
    std::fs::create_dir_all(&place).map_err(|e| format!("{}: {e}", place.display()))?;
    let lock = root.join("benches/peers/rays/requirements.lock");
    run(Command::new("python3")
        .args(["-m", "pip", "download", "--quiet", "--no-deps", "-r"])
        .arg(lock)
        .arg("-d")
        .arg(&place))?;
    let wheel = std::fs::read_dir(&place).map_err(|e| e.to_string())?.flatten().map(|entry| entry.path());
    let wheel = wheel.into_iter().find(|path| path.extension().is_some_and(|extension| extension == "whl"));
    unpack(&wheel.ok_or("pip fetched no wheel")?, &place)?;
    find_library(&place).ok_or_else(|| "the wheel holds no library of Embree 4".into())
}

fn find_library(folder: &Path) -> Option<PathBuf> {
    let libraries = std::fs::read_dir(folder.join("embreex.libs")).ok()?;
    let mut paths = libraries.flatten().map(|entry| entry.path());
    paths.find(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libembree4")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_found_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(find_library(folder.path()), None);
        let libraries = folder.path().join("embreex.libs");
        std::fs::create_dir_all(&libraries).unwrap();
        for name in ["libtbb-1.so.12", "libembree4-1.so.4"] {
            std::fs::write(libraries.join(name), "").unwrap();
        }
        assert_eq!(find_library(folder.path()), Some(libraries.join("libembree4-1.so.4")));
    }
}
