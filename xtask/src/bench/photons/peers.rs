//! The peers of the photon searches: nanoflann's header from Debian with our shim around it, trees of Python's packages.

use crate::Failure;
use crate::bench::commands::{debian, run};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Sources of the shim, the Python driver and the lock.
const FOLDER: &str = "benches/peers/photons";

/// Compiles the shim around nanoflann, as its users compile it. The header is fetched once.
pub fn nanoflann(root: &Path, folder: &Path) -> Result<PathBuf, Failure> {
    let place = folder.join("nanoflann");
    let headers = place.join("usr/include");
    if !headers.join("nanoflann.hpp").is_file() {
        debian("libnanoflann-dev", &place)?;
    }
    let library = place.join("libpeer.so");
    run(Command::new("c++")
        .args(["-O3", "-march=native", "-std=c++17", "-shared", "-fPIC", "-isystem"])
        .arg(headers)
        .arg(root.join(FOLDER).join("nanoflann.cpp"))
        .arg("-o")
        .arg(&library))?;
    Ok(library)
}

/// The version of nanoflann that its header names.
pub fn nanoflann_version(folder: &Path) -> Option<String> {
    let header = std::fs::read_to_string(folder.join("nanoflann/usr/include/nanoflann.hpp")).ok()?;
    version_of(&header)
}

fn version_of(header: &str) -> Option<String> {
    let number = header.lines().find_map(|line| line.strip_prefix("#define NANOFLANN_VERSION "))?;
    let digits = number.trim().strip_prefix("0x")?;
    Some(digits.split("").filter(|digit| !digit.is_empty()).collect::<Vec<_>>().join("."))
}

/// A Python environment with the packages of the lock, and the driver for it.
pub fn python(root: &Path, folder: &Path) -> Result<[PathBuf; 2], Failure> {
    let lock = root.join(FOLDER).join("requirements.lock");
    let (place, stamp) = (folder.join("env"), folder.join("env/installed.lock"));
    let python = place.join("bin/python");
    let wanted = std::fs::read_to_string(&lock).map_err(|e| format!("{}: {e}", lock.display()))?;
    if std::fs::read_to_string(&stamp).ok().as_deref() != Some(wanted.as_str()) {
        // The hashes are of wheels for this version.
        let check = "import sys; sys.exit(sys.version_info[:2] != (3, 11))";
        let fits = |python: &&str| run(Command::new(python).args(["-c", check])).is_ok();
        let found = ["python3.11", "python3"].into_iter().find(fits);
        let found = found.ok_or("no Python 3.11 on the path, for which the peers are pinned")?;
        run(Command::new(found).args(["-m", "venv", "--clear"]).arg(&place))?;
        eprintln!("installing the peers of {}", lock.display());
        run(Command::new(&python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"])
            .args(["--only-binary", ":all:", "--no-deps", "--require-hashes", "-r"])
            .arg(&lock))?;
        std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
    }
    Ok([python, root.join(FOLDER).join("trees.py")])
}

/// Versions that the lock pins, in words.
pub fn pinned(root: &Path) -> String {
    let lock = std::fs::read_to_string(root.join(FOLDER).join("requirements.lock")).unwrap_or_default();
    let pins = lock.lines().filter_map(|line| line.split(' ').next()?.split_once("=="));
    pins.map(|(name, version)| format!("{name} {version}")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read() {
        let header = "#include <x>\n#define NANOFLANN_VERSION 0x142\n";
        assert_eq!(version_of(header).as_deref(), Some("1.4.2"));
        assert_eq!(version_of("#define OTHER 1"), None);
        let pins = pinned(&crate::root());
        for package in ["numpy", "pykdtree", "scipy", "threadpoolctl"] {
            assert!(pins.contains(package), "{pins}");
        }
    }
}
