//! An acceleration structure built for its own sake, and described.

use crate::names::ACCEL;
use crate::tree_drawing::{TreeDrawing, TreeView, draw_kd_tree};
use crate::{Error, Result};
use photinus_accel::{BuildOptions, RayCounters, Structure, StructureSummary};
use photinus_geometry::{Hit, Primitives, Ray};
use photinus_num::{Sampler, StreamKind};
use photinus_render::{CameraModel, Compiled};
use photinus_scene::{Camera, FilmSettings, Scene};
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;

/// What to build.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeOptions {
    /// The structure, by name.
    pub accel: String,
    /// How it is built.
    pub build: BuildOptions,
}

impl Default for TreeOptions {
    fn default() -> Self {
        Self { accel: ACCEL.default.to_owned(), build: BuildOptions::default() }
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
    /// What rays of the scene's camera meet in it.
    pub rays: TreeRays,
}

/// The work of rays through the middles of the pixels of a scene's picture, or of some of them, evenly picked. Counts
/// are the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TreeRays {
    /// How many.
    pub rays: u64,
    /// How many hit anything.
    pub hits: u64,
    /// Interior nodes, or cells of a grid, that a ray visits, in the mean.
    pub nodes_per_ray: f64,
    /// Leaves with primitives, likewise.
    pub leaves_per_ray: f64,
    /// Primitives that it is tested against, likewise.
    pub tests_per_ray: f64,
}

/// Rays of a description at most.
const MAX_RAYS: f64 = (1 << 18) as f64;
/// Tests of a description, as a rough bound: where leaves are huge, fewer rays do.
const MAX_TESTS: f64 = (1 << 29) as f64;

impl TreeRays {
    /// Traces rays from the camera through a structure.
    fn measure(structure: &dyn Structure, summary: &StructureSummary, camera: &Camera, film: &FilmSettings) -> Self {
        let most = (MAX_TESTS / summary.prims_per_leaf.max(1.0)).clamp(256.0, MAX_RAYS);
        let pixels = f64::from(film.width) * f64::from(film.height);
        let step = (pixels / most).sqrt().ceil().max(1.0) as u32;
        let model = CameraModel::new(camera, film);
        let mut sampler = Sampler::new(0, StreamKind::Eye, 0, 0);
        let mut counters = RayCounters::default();
        let mut found = 0;
        for y in (step / 2..film.height).step_by(step as usize) {
            let columns = (step / 2..film.width).step_by(step as usize);
            let middle = |x: u32| [x as f32 + 0.5, y as f32 + 0.5];
            let rays: Vec<Ray> = columns.map(|x| model.ray(middle(x), &mut sampler).ray).collect();
            let mut hits = vec![Hit::MISS; rays.len()];
            structure.closest_hit_counted(&rays, &mut hits, &mut counters);
            found += hits.iter().filter(|hit| hit.is_hit()).count() as u64;
        }
        let work = counters.traversal;
        let mean = |count: u64| if work.rays == 0 { 0.0 } else { count as f64 / work.rays as f64 };
        Self {
            rays: work.rays,
            hits: found,
            nodes_per_ray: mean(work.nodes_visited),
            leaves_per_ray: mean(work.leaves_visited),
            tests_per_ray: mean(counters.intersect.tests),
        }
    }
}

/// Builds a structure over `scene`.
///
/// # Errors
/// [`crate::Error::UnknownName`] and [`crate::Error::Structure`] for options that do not fit.
pub fn build_tree(scene: Scene, options: &TreeOptions) -> Result<Tree> {
    let accel = ACCEL.find(&options.accel)?;
    let (name, camera, film) = (scene.name.clone(), scene.camera, scene.film);
    let primitives = Compiled::new(scene).primitives().clone();
    let begun = Instant::now();
    let structure = photinus_accel::build(accel.name, primitives.clone(), &options.build)?;
    let build_secs = begun.elapsed().as_secs_f64();
    let summary = structure.summary();
    let report = TreeReport {
        scene: name,
        triangles: primitives.triangle_count() as u64,
        spheres: primitives.spheres.len() as u64,
        build_secs,
        rays: TreeRays::measure(&*structure, &summary, &camera, &film),
        structure: summary,
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
            let rays = report.rays;
            assert!(
                rays.rays > 200 && rays.hits * 2 > rays.rays && rays.tests_per_ray >= 1.0,
                "{}: {rays:?}",
                member.name
            );
            assert!(report.structure.references >= 24, "{}: {}", member.name, report.structure.references);
        }
    }

    #[test]
    fn costs_that_mean_nothing_are_refused() {
        let scene = photinus_scene::builtin::build("furnace").unwrap();
        let build = BuildOptions { node_cost: f64::NAN, ..BuildOptions::default() };
        let options = TreeOptions { accel: "kd-tree".to_owned(), build };
        assert!(build_tree(scene, &options).is_err());
    }
}
