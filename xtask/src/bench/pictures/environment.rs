//! The peers' own environment below `target/`: a Python environment with pinned packages, a home, and the LLVM library that
//! Mitsuba's fast variants need. Nothing of it is part of a build.

use super::engines::Package;
use crate::Failure;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Folder of the drivers and of the lock.
const DRIVERS: &str = "benches/peers/pictures";

/// What the drivers themselves need.
const TOOLS: &[&str] = &["numpy", "OpenEXR", "pillow"];

/// The denoiser.
pub const DENOISER: Package = Package::Python("pyoidn");

/// The Debian package with an LLVM library that Mitsuba accepts.
const LLVM: &str = "libllvm19";

/// Where peers live and run.
pub struct Environment {
    drivers: PathBuf,
    lock: PathBuf,
    folder: PathBuf,
    llvm: Option<String>,
}

impl Environment {
    /// Makes the environment, or finds it made. An error says in one line why no peer can run.
    pub fn make(root: &Path) -> Result<Self, Failure> {
        let drivers = root.join(DRIVERS);
        let folder = root.join("target/peers/pictures");
        let mut here = Self { lock: drivers.join("requirements.lock"), drivers, folder, llvm: None };
        for place in ["home", "stamps", "llvm"] {
            let place = here.folder.join(place);
            std::fs::create_dir_all(&place).map_err(|e| format!("{}: {e}", place.display()))?;
        }
        if !here.python().is_file() {
            // The pins are for this version: Blender's module exists for one version of Python each.
            let python = ["python3.11", "python3"].into_iter().find(|python| {
                let check = "import sys; sys.exit(sys.version_info[:2] != (3, 11))";
                quiet(Command::new(python).args(["-c", check]))
            });
            let python = python.ok_or("no Python 3.11 on the path, for which the peers are pinned")?;
            let place = here.folder.join("env");
            if !quiet(Command::new(python).args(["-m", "venv"]).arg(&place)) {
                // Half an environment would pass for a whole one the next time.
                std::fs::remove_dir_all(&place).ok();
                return Err(format!("`{python} -m venv` failed (Debian: install python3-venv)"));
            }
        }
        for tool in TOOLS {
            here.install(tool)?;
        }
        here.llvm = here.find_llvm();
        Ok(here)
    }

    /// Whether a package's engine can run; an error says why not. Python packages are installed where they are missing.
    pub fn provide(&self, package: Package) -> Result<(), Failure> {
        match package {
            Package::Ours => Ok(()),
            Package::Python(name) => self.install(name),
            Package::Unfit(why) => Err(why.to_owned()),
        }
    }

    /// The words that start a driver.
    pub fn driver(&self, name: &str) -> Vec<String> {
        [self.python(), self.drivers.join(name)].map(|path| path.display().to_string()).to_vec()
    }

    /// Variables under which drivers run: a home of their own, for caches, and no files beside the sources.
    pub fn variables(&self) -> Vec<(String, String)> {
        let path = |name: &str| self.folder.join(name).display().to_string();
        let mut variables =
            vec![("HOME".to_owned(), path("home")), ("PYTHONPYCACHEPREFIX".to_owned(), path("home/pycache"))];
        if let Some(llvm) = &self.llvm {
            variables.push(("DRJIT_LIBLLVM_PATH".into(), llvm.clone()));
        }
        variables
    }

    /// Folder for scenes, pictures and references.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The pinned version of a package.
    pub fn pinned(&self, package: &str) -> Result<String, Failure> {
        let text = std::fs::read_to_string(&self.lock).map_err(|e| format!("{}: {e}", self.lock.display()))?;
        let version = text.lines().find_map(|line| line.strip_prefix(package)?.strip_prefix("=="));
        version.map(str::to_owned).ok_or_else(|| format!("{} does not pin {package}", self.lock.display()))
    }

    fn python(&self) -> PathBuf {
        self.folder.join("env/bin/python")
    }

    /// Installs one package by itself, its dependencies at the versions of the lock.
    fn install(&self, package: &str) -> Result<(), Failure> {
        let version = self.pinned(package)?;
        let stamp = self.folder.join(format!("stamps/{package}-{version}"));
        if stamp.is_file() {
            return Ok(());
        }
        eprintln!("installing {package} {version}");
        let output = Command::new(self.python())
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--constraint"])
            .arg(&self.lock)
            .arg(package)
            .stdin(Stdio::null())
            .output()
            .map_err(|e| format!("pip could not be started: {e}"))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            let last = said.lines().rev().find(|line| line.contains("ERROR")).or(said.lines().last());
            return Err(format!("pip could not install {package} {version}: {}", last.unwrap_or("no word why").trim()));
        }
        std::fs::write(&stamp, "").map_err(|e| format!("{}: {e}", stamp.display()))
    }

    /// The LLVM library that the caller names, or that of Debian 12's package unpacked here, without installing it. None
    /// where there is neither: then Mitsuba looks for itself.
    fn find_llvm(&self) -> Option<String> {
        if let Ok(named) = std::env::var("DRJIT_LIBLLVM_PATH") {
            return Some(named);
        }
        let folder = self.folder.join("llvm");
        let library = |folder: &Path| -> Option<String> {
            let text =
                Command::new("find").arg(folder).args(["-name", "libLLVM.so.19*", "-type", "f"]).output().ok()?;
            String::from_utf8(text.stdout).ok()?.lines().next().map(str::to_owned)
        };
        library(&folder).or_else(|| {
            let fetch = format!("apt-get download {LLVM} && dpkg -x {LLVM}_*.deb . && rm {LLVM}_*.deb");
            quiet(Command::new("sh").args(["-c", &fetch]).current_dir(&folder));
            library(&folder)
        })
    }
}

/// Runs a command without a word; whether it succeeded.
fn quiet(command: &mut Command) -> bool {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}
