//! The default structure: a tree of eight-wide nodes with triangles in blocks of eight, traversed with vector
//! instructions chosen at run time.

mod any_hit;
mod beam;
mod binary;
mod bins;
mod candidates;
mod collapse;
mod dispatch;
mod doubled;
mod emit;
mod frustum;
mod kernels;
mod layout;
mod pace;
mod packet;
mod packet_test;
mod packet_walk;
mod ray_setup;
mod refit;
mod reinsert;
mod summary;
mod traverse;
mod visits;

use crate::hierarchy::shape::Shape;
use crate::list::method;
use crate::options::{BuildError, BuildOptions, check};
use crate::structure::{RayCounters, RefitError, Structure, StructureSummary};
use collapse::Leaves;
use dispatch::Chosen;
use layout::{Node, TriangleBlock};
use pace::Habit;
use photinus_geometry::{Aabb, Hit, Primitives, Ray};
use photinus_intersect::methods::woop::Woop;
use photinus_intersect::{LeafTester, RtiMethod, sphere_tester};
use photinus_memory::HugeArray;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "wide-bvh";
/// One line for the help.
pub const SUMMARY: &str = "eight-wide bounding volume hierarchy with vector instructions";
/// Where it was published.
pub const SOURCE: &str = "Wald, Benthin, Boulos, RT 2008; Ylitie, Karras, Laine, HPG 2017; Meister, Bittner, EG 2018";

/// Most rounds of reinsertions.
const MAX_ROUNDS: u32 = 100;

/// The tree.
struct WideBvh {
    bounds: Aabb,
    levels: u32,
    stack_places: usize,
    nodes: HugeArray<Node>,
    blocks: HugeArray<TriangleBlock>,
    ids: Vec<u32>,
    tester: Box<dyn LeafTester>,
    /// Prepares the tester anew for primitives that moved.
    retest: fn(&Primitives) -> Box<dyn LeafTester>,
    shape: Shape,
    kernel: Chosen,
    /// Of rays for which the nearest hit counts, and of those for which any will do.
    habits: [Habit; 2],
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    Ok(Box::new(WideBvh::new(&primitives, options)?))
}

impl WideBvh {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        // The blocks hold the triangles of the fused method; the tester is left with the spheres.
        let fused = options.method == <Woop as RtiMethod<f32>>::NAME;
        let retest = if fused { sphere_tester } else { method(options)?.leaf_tester };
        let leaves = if fused { Leaves::Blocks } else { Leaves::Ids };
        let rounds = options.reinsertion_rounds;
        check("the number of rounds of reinsertions", rounds, rounds <= MAX_ROUNDS, "0 to 100")?;
        let (tree, shape) = rayon::join(|| binary::build(primitives, leaves, rounds), || Shape::of(primitives));
        let bounds = tree.bounds();
        let arrays =
            emit::collapse(&tree, primitives).ok_or(BuildError::TooManyPrimitives { count: primitives.len() })?;
        Ok(Self {
            bounds,
            levels: arrays.levels,
            stack_places: traverse::stack_places(arrays.levels),
            nodes: arrays.nodes,
            blocks: arrays.blocks,
            ids: arrays.ids,
            tester: retest(primitives),
            retest,
            shape,
            kernel: Chosen::new(options.kernel),
            habits: Default::default(),
        })
    }
}

impl Structure for WideBvh {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len());
        self.trace_all::<false, false>(rays, |i, hit| hits[i] = hit, &mut RayCounters::default());
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len());
        self.trace_all::<true, false>(rays, |i, hit| occluded[i] = hit.is_hit(), &mut RayCounters::default());
    }

    fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        assert_eq!(rays.len(), hits.len());
        self.trace_all::<false, true>(rays, |i, hit| hits[i] = hit, counters);
    }

    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        assert_eq!(rays.len(), occluded.len());
        self.trace_all::<true, true>(rays, |i, hit| occluded[i] = hit.is_hit(), counters);
    }

    fn summary(&self) -> StructureSummary {
        summary::summary(self)
    }

    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        self.fit(primitives)
    }
}

#[cfg(test)]
mod tests;
