//! A hierarchy over hierarchies: primitives that share vertices are one mesh with a tree of its own, and one tree more
//! stands over the meshes (the division of Wald, Benthin, Slusallek, "Distributed Interactive Ray Tracing of Dynamic
//! Scenes", PVG 2003, with every mesh where it is).
//!
//! Both levels are built as `binned-bvh` is. A sphere is a mesh of its own.

mod meshes;

use crate::hierarchy::object_build::{self, ByCost, MAX_DEPTH};
use crate::hierarchy::refs::{BuildRef, Built, gather};
use crate::hierarchy::rule::Rule;
use crate::hierarchy::shape::Shape;
use crate::hierarchy::volume::Volume;
use crate::hierarchy::volume_tree::VolumeTree;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RefitError, Structure, StructureSummary};
use photinus_geometry::{Aabb, Primitives, Ray};
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "two-level";
/// One line for the help.
pub const SUMMARY: &str = "a tree over meshes, each with a tree of its own";
/// Where it was published.
pub const SOURCE: &str = "Wald, Benthin, Slusallek, PVG 2003";

type BoxTree = VolumeTree<Aabb, { MAX_DEPTH + 2 }>;

/// The trees.
struct TwoLevel {
    /// Over the meshes; its references are their numbers.
    top: BoxTree,
    /// Of all meshes.
    bottom: BoxTree,
    /// Where the tree of each mesh begins.
    roots: Vec<usize>,
    shape: Shape,
    cost_ratio: f64,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(TwoLevel::new(&primitives, options)?, &primitives, options)
}

impl TwoLevel {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let rule = Rule::new(options)?;
        let mut meshes = meshes::group(primitives, gather(primitives));
        let built: Vec<Built<Aabb>> =
            meshes.par_iter_mut().map(|refs| object_build::build(&ByCost(rule), refs, ())).collect();
        let mut refs: Vec<BuildRef> =
            built.iter().enumerate().map(|(i, mesh)| BuildRef { bounds: mesh.volume, id: i as u32 }).collect();
        let mut bottom = BoxTree::empty();
        let roots = built.into_iter().map(|mesh| bottom.add(mesh)).collect();
        // Meshes are never tested together: nodes over them are cheap against what is below.
        let one_each = Rule { leaf_size: 1, ..rule };
        let top = BoxTree::new((!refs.is_empty()).then(|| object_build::build(&ByCost(one_each), &mut refs, ())));
        Ok(Self { top, bottom, roots, shape: Shape::of(primitives), cost_ratio: rule.cost_ratio })
    }
}

impl Leaves for TwoLevel {
    fn refs(&self) -> &[u32] {
        &self.bottom.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, mut node: impl FnMut(), mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        let Some(prepared) = Aabb::prepare(ray) else { return };
        let mut seen_above = 0;
        let meshes = |meshes: std::ops::Range<usize>, mut end: f32| {
            for &mesh in &self.top.refs[meshes] {
                let visit = |refs, _| leaf(LeafVisit { refs, exit: f32::NEG_INFINITY });
                end = self.bottom.walk_from(self.roots[mesh as usize], &prepared, end, &mut node, visit)?;
            }
            ControlFlow::Continue(end)
        };
        let _ = self.top.walk_from(0, &prepared, ray.t_max, || seen_above += 1, meshes);
        for _ in 0..seen_above {
            node();
        }
    }

    /// Nodes and depth are those of both levels, the cost is that of the heuristic, in triangle tests; a mesh in a leaf
    /// of the upper one costs nothing by itself.
    fn summary(&self) -> StructureSummary {
        let whole = self.top.nodes.first().map_or(0.0, |root| root.volume.half_surface());
        let (top, bottom) = (self.top.summary(NAME, self.cost_ratio), self.bottom.summary(NAME, self.cost_ratio));
        StructureSummary {
            depth: top.depth + bottom.depth,
            nodes: top.nodes + bottom.nodes,
            sah_cost: self.top.cost(whole, self.cost_ratio, 0.0) + self.bottom.cost(whole, self.cost_ratio, 1.0),
            bytes: top.bytes + bottom.bytes + size_of_val(&self.roots[..]) as u64,
            ..bottom
        }
    }

    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let bounds = self.shape.moved(primitives, &self.bottom.refs, NAME)?;
        self.bottom.refit_boxes(&bounds);
        let meshes: Vec<Aabb> = self.roots.iter().map(|root| self.bottom.nodes[*root].volume).collect();
        self.top.refit_boxes(&meshes);
        Ok(())
    }
}
