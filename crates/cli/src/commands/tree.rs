//! `photinus tree`: an acceleration structure over a scene, described and drawn.

use crate::args::TreeArgs;
use crate::failure::{Outcome, Result};
use crate::report;
use photinus::{TreeOptions, TreeView};

/// Builds and describes.
pub fn run(args: &TreeArgs) -> Result {
    let scene = super::open(&args.scene, args.source.allow_outside)?;
    super::warn(&scene);
    let options = TreeOptions {
        accel: args.accel.clone(),
        node_cost: args.node_cost,
        triangle_cost: args.triangle_cost,
        candidates: args.candidates.clone(),
    };
    if let Some(path) = &args.draw {
        photinus::check_writable(path)?;
    }
    let tree = photinus::build_tree(scene, &options)?;
    if let Some(path) = &args.draw {
        photinus::write_drawing(path, &tree.draw(&TreeView::default())?)?;
    }
    let report = &tree.report;
    if args.json {
        report::json(report)?;
    } else {
        let structure = &report.structure;
        report::table(&[
            ("scene", report.scene.clone()),
            ("structure", structure.name.to_owned()),
            ("triangles", report::count(report.triangles)),
            ("spheres", report::count(report.spheres)),
            ("build", format!("{:.3} s", report.build_secs)),
            ("depth", structure.depth.to_string()),
            ("interior nodes", report::count(structure.nodes)),
            ("leaves", report::count(structure.leaves)),
            ("empty leaves", report::count(structure.empty_leaves)),
            ("references", report::count(structure.references)),
            ("primitives a leaf", format!("{:.2}", structure.prims_per_leaf)),
            ("SAH cost", format!("{:.2}", structure.sah_cost)),
            ("memory", report::bytes(structure.bytes)),
        ])?;
    }
    Ok(Outcome::Done)
}
