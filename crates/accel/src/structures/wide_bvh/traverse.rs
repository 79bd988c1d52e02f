//! The walk of one ray through the tree, nearest children first.

use super::WideBvh;
use super::binary::MAX_DEPTH;
use super::kernels::Kernel;
use super::layout::{Child, TriangleBlock, WIDTH};
use super::ray_setup::RaySetup;
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::LeafWork;
use photinus_intersect::methods::woop::{self, Started};

/// All but one child of a node wait on every level.
const STACK: usize = MAX_DEPTH as usize * (WIDTH - 1) + 1;

/// A child that waits, and where the ray enters it.
#[derive(Clone, Copy)]
struct Waiting {
    entry: f32,
    child: Child,
}

/// The hit of one lane, in the ray's interval and no farther than `t_max`.
#[inline]
fn lane_hit(ray: &Started<f32>, block: &TriangleBlock, lane: usize, t_min: f32, t_max: f32) -> Option<Hit> {
    let hit = woop::finish(&ray.shear_exactly(&block.triangle(lane)), f64::from(ray.dir_z))?;
    let t = hit.t as f32;
    (t >= t_min && t <= t_max && t.is_finite()).then_some(Hit {
        t,
        alpha: hit.alpha as f32,
        beta: hit.beta as f32,
        prim: block.ids[lane],
    })
}

impl WideBvh {
    /// The nearest hit, or with `ANY` any hit, of one ray; counts its work where `COUNT` says so.
    #[inline(always)]
    pub(super) fn trace<K: Kernel, const ANY: bool, const COUNT: bool>(
        &self,
        kernel: K,
        ray: &Ray,
        counters: &mut RayCounters,
    ) -> Hit {
        let mut best = Hit::MISS;
        if COUNT {
            counters.traversal.rays += 1;
        }
        let Some(setup) = RaySetup::new(ray, &self.bounds) else { return best };
        let mut stack = [Waiting { entry: 0.0, child: Child::node(0) }; STACK];
        let mut waiting = 0;
        let mut child = Child::node(0);
        let mut t_max = ray.t_max;
        let mut entries = [0.0; WIDTH];
        'walk: loop {
            while !child.is_leaf() {
                let node = &self.nodes[child.index()];
                if COUNT {
                    counters.traversal.nodes_visited += 1;
                }
                let mut mask = kernel.node(&setup, node, t_max, &mut entries);
                if mask == 0 {
                    match pop(&stack, &mut waiting, t_max) {
                        Some(next) => child = next,
                        None => break 'walk,
                    }
                    continue;
                }
                // Insertion by falling entry keeps the nearest on top.
                let bottom = waiting;
                while mask != 0 {
                    let lane = mask.trailing_zeros() as usize;
                    mask &= mask - 1;
                    let entry = entries[lane];
                    let mut i = waiting;
                    while i > bottom && stack[i - 1].entry < entry {
                        stack[i] = stack[i - 1];
                        i -= 1;
                    }
                    stack[i] = Waiting { entry, child: node.children[lane] };
                    waiting += 1;
                }
                waiting -= 1;
                child = stack[waiting].child;
            }
            let work = self.leaf::<K, ANY>(kernel, ray, &setup, child, &mut best);
            if COUNT {
                counters.add_leaf(work.tests as usize, work);
            }
            if ANY && best.is_hit() {
                break;
            }
            t_max = t_max.min(best.t);
            match pop(&stack, &mut waiting, t_max) {
                Some(next) => child = next,
                None => break,
            }
        }
        best
    }

    #[inline(always)]
    fn leaf<K: Kernel, const ANY: bool>(
        &self,
        kernel: K,
        ray: &Ray,
        setup: &RaySetup,
        leaf: Child,
        best: &mut Hit,
    ) -> LeafWork {
        if leaf.is_ids() {
            return self.tester.closest_hit(ray, &self.ids[leaf.range()], best);
        }
        let mut work = LeafWork::default();
        for block in &self.blocks[leaf.range()] {
            let mut mask = kernel.block(setup, block);
            work.tests += block.len() as u32;
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                let t_max = ray.t_max.min(best.t);
                if let Some(hit) = lane_hit(&setup.woop, block, lane, ray.t_min, t_max) {
                    work.hits += 1;
                    if hit.beats(best) {
                        *best = hit;
                    }
                    if ANY {
                        return work;
                    }
                }
            }
        }
        work
    }
}

/// The next waiting child that can still matter.
#[inline(always)]
fn pop(stack: &[Waiting; STACK], waiting: &mut usize, t_max: f32) -> Option<Child> {
    while *waiting > 0 {
        *waiting -= 1;
        let next = stack[*waiting];
        if next.entry <= t_max {
            return Some(next.child);
        }
    }
    None
}
