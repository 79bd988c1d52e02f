//! An acceleration structure built for its own sake, and described.

use crate::names::{self, ACCEL, CANDIDATES};
use crate::tree_drawing::{TreeDrawing, TreeView, draw_kd_tree};
use crate::{Error, Result};
use photinus_accel::{BuildOptions, Structure, StructureSummary};
use photinus_geometry::Primitives;
use photinus_render::Compiled;
use photinus_scene::Scene;
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;

/// How to build.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeOptions {
    /// The structure, by name.
    pub accel: String,
    /// Cost of visiting a node in the surface-area heuristic.
    pub node_cost: f64,
    /// Cost of testing a triangle.
    pub triangle_cost: f64,
    /// Where a kd-tree may be split, by name.
    pub candidates: String,
}

impl Default for TreeOptions {
    fn default() -> Self {
        let BuildOptions { node_cost, triangle_cost, .. } = BuildOptions::default();
        let (accel, candidates) = (ACCEL.default.to_owned(), CANDIDATES.default.to_owned());
        Self { accel, node_cost, triangle_cost, candidates }
    }
}

/// A structure over a scene.
pub struct Tree {
    /// What it is built over.
    pub primitives: Arc<Primitives>,
    /// The structure.
    pub structure: Box<dyn Structure>,
    /// What it amounts to.
    pub report: TreeReport,
}

/// A description of a built structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TreeReport {
    /// Name of the scene.
    pub scene: String,
    /// Triangles built over.
    pub triangles: u64,
    /// Spheres built over.
    pub spheres: u64,
    /// Wall seconds of the build, the scene's loading left out.
    pub build_secs: f64,
    /// The structure.
    #[serde(flatten)]
    pub structure: StructureSummary,
}

/// Builds a structure over `scene`.
///
/// # Errors
/// [`crate::Error::UnknownName`] and [`crate::Error::Structure`] for options that do not fit.
pub fn build_tree(scene: Scene, options: &TreeOptions) -> Result<Tree> {
    let accel = ACCEL.find(&options.accel)?;
    let build = BuildOptions {
        node_cost: options.node_cost,
        triangle_cost: options.triangle_cost,
        candidates: names::candidates(&options.candidates)?,
        ..BuildOptions::default()
    };
    let name = scene.name.clone();
    let primitives = Compiled::new(scene).primitives().clone();
    let begun = Instant::now();
    let structure = photinus_accel::build(accel.name, primitives.clone(), &build)?;
    let report = TreeReport {
        scene: name,
        triangles: primitives.triangle_count() as u64,
        spheres: primitives.spheres.len() as u64,
        build_secs: begun.elapsed().as_secs_f64(),
        structure: structure.summary(),
    };
    Ok(Tree { primitives, structure, report })
}

impl Tree {
    /// Draws the tree: planes across x red, across y green, across z blue, leaves white.
    ///
    /// # Errors
    /// [`crate::Error::Setting`] where the structure is no kd-tree: only those are drawn.
    pub fn draw(&self, view: &TreeView) -> Result<TreeDrawing> {
        let tree = self.structure.as_kd_tree().ok_or_else(|| {
            let name = self.report.structure.name;
            Error::setting("--draw", format!("{name} is not drawn; use --accel kd-tree"))
        })?;
        Ok(draw_kd_tree(tree, view))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_structure_is_built_over_all_primitives() {
        for member in ACCEL.members() {
            let scene = photinus_scene::builtin::build("two-spheres").unwrap();
            let options = TreeOptions { accel: member.name.to_owned(), ..TreeOptions::default() };
            let report = build_tree(scene, &options).unwrap().report;
            assert_eq!((report.triangles, report.spheres, report.structure.name), (22, 2, member.name));
            assert!(report.structure.references >= 24, "{}: {}", member.name, report.structure.references);
        }
    }

    #[test]
    fn costs_that_mean_nothing_are_refused() {
        let scene = photinus_scene::builtin::build("furnace").unwrap();
        let options = TreeOptions { accel: "kd-tree".to_owned(), node_cost: f64::NAN, ..TreeOptions::default() };
        assert!(build_tree(scene, &options).is_err());
    }
}
