//! The subcommands, one file each.

pub mod compare;
pub mod info;
pub mod render;
pub mod scenes;
pub mod tree;

use crate::report;
use photinus::Scene;

/// Opens a scene.
fn open(name: &str, allow_outside: bool) -> photinus::Result<Scene> {
    photinus::open(name, &photinus::LoadOptions { allow_outside, ..photinus::LoadOptions::default() })
}

/// Says on standard error what was read otherwise than written, the first few of it.
fn warn(scene: &Scene) {
    const SHOWN: usize = 20;
    for warning in scene.warnings.iter().take(SHOWN) {
        report::warning(&warning.to_string());
    }
    if let Some(more) = scene.warnings.len().checked_sub(SHOWN + 1) {
        report::warning(&format!("{} more; `photinus info` shows all of them", more + 1));
    }
}
