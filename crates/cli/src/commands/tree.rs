//! `photinus tree`: an acceleration structure over a scene, described and drawn.

use crate::args::TreeArgs;
use crate::failure::{Outcome, Result};
use crate::report;
use photinus::geometry::Aabb;
use photinus::{TreeOptions, TreeView};

/// Builds and describes.
pub fn run(args: &TreeArgs) -> Result {
    let scene = super::open(&args.scene, args.source.allow_outside)?;
    super::warn(&scene);
    let options = TreeOptions { accel: args.accel.clone(), build: args.structure.options()? };
    if let Some(path) = &args.draw {
        photinus::check_writable(path)?;
    }
    let tree = photinus::build_tree(scene, &options)?;
    if let Some(path) = &args.draw {
        let mut view = TreeView::default();
        if let Some(direction) = args.view {
            view.direction = direction.into();
        }
        if let Some([x, y, z, u, v, w]) = args.draw_box {
            view.frame = Some(Aabb { min: [x, y, z].into(), max: [u, v, w].into() });
        }
        photinus::write_drawing(path, &tree.draw(&view)?)?;
    }
    let report = &tree.report;
    if args.json {
        report::json(report)?;
    } else {
        let (structure, rays) = (&report.structure, &report.rays);
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
            ("rays of the camera", format!("{} ({} hit)", report::count(rays.rays), report::count(rays.hits))),
            ("nodes a ray", format!("{:.2}", rays.nodes_per_ray)),
            ("leaves a ray", format!("{:.2}", rays.leaves_per_ray)),
            ("tests a ray", format!("{:.2}", rays.tests_per_ray)),
        ])?;
    }
    Ok(Outcome::Done)
}
