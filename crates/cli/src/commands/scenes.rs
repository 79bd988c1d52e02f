//! `photinus scenes`: the built-in scenes, listed or written as files.

use crate::args::{ScenesArgs, ScenesCommand};
use crate::failure::{Outcome, Result};
use crate::report;
use serde_json::json;
use std::path::Path;

/// Lists or writes.
pub fn run(args: &ScenesArgs) -> Result {
    match &args.command {
        None | Some(ScenesCommand::List) => list(args.json),
        Some(ScenesCommand::Write { name, dir }) => write(name, dir, args.json),
    }
}

fn list(json: bool) -> Result {
    let scenes = photinus::built_in_scenes();
    if json {
        report::json(&json!({ "scenes": scenes }))?;
    } else {
        let rows = scenes
            .iter()
            .map(|s| (s.name, format!("{:>7} triangles  {}", report::count(s.triangles as u64), s.description)));
        report::table(&rows.collect::<Vec<_>>())?;
    }
    Ok(Outcome::Done)
}

fn write(name: &str, folder: &Path, json: bool) -> Result {
    let file = photinus::write_built_in(name, folder)?;
    if json {
        report::json(&json!({ "file": file }))?;
    } else {
        report::line(&file.display().to_string())?;
    }
    Ok(Outcome::Done)
}
