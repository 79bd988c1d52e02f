//! What `cargo metadata` says about the workspace, cut down to what the house rules need.

use crate::Failure;
use serde::Deserialize;
use std::path::Path;
use std::process::Command;

/// The answer of `cargo metadata`.
#[derive(Deserialize)]
pub struct Metadata {
    /// Packages: with dependencies' own packages, or the workspace's alone.
    pub packages: Vec<Package>,
}

/// One package.
#[derive(Deserialize)]
pub struct Package {
    /// Name with its prefix.
    pub name: String,
    /// Version.
    pub version: String,
    /// Licence as an SPDX expression.
    pub license: Option<String>,
    /// Declared dependencies of every kind.
    pub dependencies: Vec<Dependency>,
    /// Libraries, programs, examples, tests.
    pub targets: Vec<Target>,
}

/// A declared dependency.
#[derive(Deserialize)]
pub struct Dependency {
    /// Package name.
    pub name: String,
    /// Folder, for a dependency inside the workspace.
    pub path: Option<String>,
}

/// Something that a package builds.
#[derive(Deserialize)]
pub struct Target {
    /// Its name.
    pub name: String,
    /// `lib`, `bin`, `example`, ...
    pub kind: Vec<String>,
    /// Features without which it is not built.
    #[serde(rename = "required-features", default)]
    pub required_features: Vec<String>,
}

impl Metadata {
    /// The workspace's packages in order of name, without dependencies' own packages.
    pub fn of_workspace(root: &Path) -> Result<Self, Failure> {
        let mut metadata = Self::ask(root, &["--no-deps"])?;
        metadata.packages.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(metadata)
    }

    /// Every package that the workspace is built from on Linux.
    pub fn of_everything(root: &Path) -> Result<Self, Failure> {
        Self::ask(root, &["--filter-platform", "x86_64-unknown-linux-gnu"])
    }

    fn ask(root: &Path, options: &[&str]) -> Result<Self, Failure> {
        let output = Command::new(crate::tools::cargo())
            .args(["metadata", "--format-version", "1", "--locked"])
            .args(options)
            .current_dir(root)
            .output()
            .map_err(|e| format!("cargo metadata could not be started: {e}"))?;
        if !output.status.success() {
            return Err(format!("cargo metadata failed:\n{}", String::from_utf8_lossy(&output.stderr).trim_end()));
        }
        serde_json::from_slice(&output.stdout).map_err(|e| format!("cargo metadata gave unexpected JSON: {e}"))
    }
}
