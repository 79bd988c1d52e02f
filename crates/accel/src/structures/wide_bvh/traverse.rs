//! The walk of rays through the tree, many at a time.
//!
//! A ray is in one of four states, the kind of its next child: at a node, at a leaf of blocks, at a leaf of ids, at its
//! end. Rays of one state are stepped together and sorted into the states of their next children, which leaves the
//! processor no branch to guess: it works on several rays at once while memory answers for others.
//!
//! Visiting a node writes its children to the ray's stack from far to near and takes the nearest from the top. When a
//! hit shortens a ray, children that it no longer reaches are taken out of the stack, so that whatever is popped is
//! worth a visit.

use super::WideBvh;
use super::kernels::{Kernel, Lanes, Reach};
use super::layout::{BLOCK, Child, END, IDS, NODE, Node, TriangleBlock, WIDTH};
use super::ray_setup::RaySetup;
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::LeafWork;
use photinus_intersect::methods::woop::{self, Started};
use photinus_profile::ticks;

/// Rays under way at a time.
const SLOTS: usize = 32;

/// Places that a stack needs in a tree with so many levels of nodes: for the end, for all but one of the children of
/// every node on the way, and for a whole node to be written.
pub fn stack_places(levels: u32) -> usize {
    1 + levels as usize * (WIDTH - 1) + WIDTH
}

/// A ray under way.
#[derive(Clone, Copy)]
struct Slot {
    setup: RaySetup,
    /// Where the search ends: the end of the ray or the nearest hit.
    t_max: f32,
    best: Hit,
    child: Child,
    /// Index in the batch.
    ray: usize,
    /// Filled places of the stack.
    waiting: usize,
}

const IDLE: Slot = Slot { setup: RaySetup::IDLE, t_max: 0.0, best: Hit::MISS, child: Child::END, ray: 0, waiting: 0 };

/// The stacks of all slots: children that wait, and where the ray enters them.
struct Stacks {
    /// Places of one slot.
    places: usize,
    entries: Vec<f32>,
    children: Vec<Child>,
}

impl Stacks {
    fn new(places: usize, slots: usize) -> Self {
        Self { places, entries: vec![0.0; places * slots], children: vec![Child::END; places * slots] }
    }

    /// Eight places of a slot's stack.
    #[inline(always)]
    fn lanes(&mut self, slot: u8, place: usize) -> Lanes<'_> {
        let start = usize::from(slot) * self.places + place;
        Lanes {
            entries: self.entries[start..][..WIDTH].as_mut_array().expect("WIDTH long"),
            children: self.children[start..][..WIDTH].as_mut_array().expect("WIDTH long"),
        }
    }

    /// Takes children beyond `t_max` out of a slot's stack and returns how many places are left filled. One by one: the
    /// places were written eight at a time and across one another, and reading so many at once would wait for that.
    #[inline(always)]
    fn shorten(&mut self, slot: u8, waiting: usize, t_max: f32) -> usize {
        let start = usize::from(slot) * self.places;
        let entries = &mut self.entries[start..][..waiting];
        let children = &mut self.children[start..][..waiting];
        let mut kept = 1;
        for i in 1..waiting {
            let (entry, child) = (entries[i], children[i]);
            entries[kept] = entry;
            children[kept] = child;
            kept += usize::from(entry <= t_max);
        }
        kept
    }
}

/// The slots by the kind of their next child.
struct States {
    slots: [[u8; SLOTS]; 4],
    lens: [usize; 4],
}

impl States {
    #[inline(always)]
    fn push(&mut self, kind: usize, slot: u8) {
        self.slots[kind][self.lens[kind] % SLOTS] = slot;
        self.lens[kind] += 1;
    }

    #[inline(always)]
    fn take(&mut self, kind: usize) -> ([u8; SLOTS], usize) {
        (self.slots[kind], std::mem::take(&mut self.lens[kind]))
    }
}

/// Everything that a batch needs.
struct Walk<'a, K: Kernel, F> {
    tree: &'a WideBvh,
    kernel: K,
    rays: &'a [Ray],
    next: usize,
    slots: [Slot; SLOTS],
    stacks: Stacks,
    /// Where the children of each kind lie, and how many bytes apart.
    places: [(*const u8, usize); 4],
    states: States,
    set: F,
}

impl WideBvh {
    /// The nearest hits, or with `ANY` any hits, of all rays, handed to `set`; counts the work where `COUNT` says so.
    #[inline(always)]
    pub(in crate::structures::wide_bvh) fn trace<K: Kernel, const ANY: bool, const COUNT: bool>(
        &self,
        kernel: K,
        rays: &[Ray],
        set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        if COUNT {
            counters.traversal.rays += rays.len() as u64;
        }
        let states = States { slots: [[0; SLOTS]; 4], lens: [0; 4] };
        let nodes = (self.nodes.as_ptr().cast::<u8>(), size_of::<Node>());
        let blocks = (self.blocks.as_ptr().cast::<u8>(), size_of::<TriangleBlock>());
        let ids = (self.ids.as_ptr().cast::<u8>(), size_of::<u32>());
        let places = [nodes, nodes, blocks, ids];
        let stacks = Stacks::new(self.stack_places, SLOTS.min(rays.len()));
        let slots = [IDLE; SLOTS];
        let mut walk = Walk { tree: self, kernel, rays, next: 0, slots, stacks, places, states, set };
        // Nodes, tests and the ends of rays take turns, each for all rays of its state: between them stand the stamps.
        // What is set up once for a batch stands before them: the batches that are counted are shorter than most.
        let begun = if COUNT { ticks() } else { 0 };
        walk.start();
        while walk.states.lens != [0; 4] {
            walk.visit_nodes::<COUNT>(counters);
            let tests_begun = if COUNT { ticks() } else { 0 };
            walk.visit_blocks::<ANY, COUNT>(counters);
            if walk.states.lens[IDS] > 0 {
                walk.visit_ids::<ANY, COUNT>(counters);
            }
            if COUNT {
                counters.ticks.tests += ticks().wrapping_sub(tests_begun);
                counters.ticks.pairs += 1;
            }
            walk.end_rays();
        }
        if COUNT {
            counters.ticks.total += ticks().wrapping_sub(begun);
        }
    }
}

impl<K: Kernel, F: FnMut(usize, Hit)> Walk<'_, K, F> {
    /// Fills the slots.
    #[inline(always)]
    fn start(&mut self) {
        for index in 0..SLOTS.min(self.rays.len()) as u8 {
            self.fill(index);
        }
    }

    /// Starts the next ray of the batch that can hit anything in a slot, if one is left; misses are handed out on the
    /// way.
    #[inline(always)]
    fn fill(&mut self, index: u8) {
        while self.next < self.rays.len() {
            let i = self.next;
            self.next += 1;
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let ray = &self.rays[i];
            if slot.setup.set(ray, &self.tree.bounds) {
                slot.t_max = ray.t_max;
                slot.best = Hit::MISS;
                slot.child = Child::node(0);
                slot.ray = i;
                slot.waiting = 1;
                self.states.push(NODE, index);
                return;
            }
            (self.set)(i, Hit::MISS);
        }
    }

    /// Takes the next of `waiting` children from a slot's stack.
    #[inline(always)]
    fn pop(&mut self, index: u8, waiting: usize) {
        let slot = &mut self.slots[usize::from(index) % SLOTS];
        let child = self.stacks.children[usize::from(index) * self.stacks.places + waiting - 1];
        slot.waiting = waiting - 1;
        slot.child = child;
        let kind = child.kind();
        let (start, size) = self.places[kind];
        self.kernel.prefetch(start.wrapping_add(child.index() * size));
        self.states.push(kind, index);
    }

    #[inline(always)]
    fn visit_nodes<const COUNT: bool>(&mut self, counters: &mut RayCounters) {
        let (indices, len) = self.states.take(NODE);
        if COUNT {
            counters.traversal.nodes_visited += len as u64;
        }
        for &index in &indices[..len] {
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let node = &self.tree.nodes[slot.child.index()];
            let place = slot.waiting;
            let out = self.stacks.lanes(index, place);
            let count = self.kernel.node(&slot.setup, node, slot.t_max, out);
            self.pop(index, place + count);
        }
    }

    /// Filters the triangles of all leaves first, then finishes those that are left, then takes up the rays again:
    /// what a test says is not known for long, and should not be waited for.
    #[inline(always)]
    fn visit_blocks<const ANY: bool, const COUNT: bool>(&mut self, counters: &mut RayCounters) {
        let (indices, len) = self.states.take(BLOCK);
        for &index in &indices[..len] {
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let block = &self.tree.blocks[slot.child.index()];
            let reach = Reach::new(slot.setup.woop.dir_z, slot.setup.t_min, slot.t_max);
            let mut mask = self.kernel.block(&slot.setup, &reach, block);
            let mut hits = 0;
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                if let Some(hit) = lane_hit(&slot.setup.woop, block, lane, slot.setup.t_min, slot.t_max) {
                    hits += 1;
                    if hit.beats(&slot.best) {
                        slot.best = hit;
                        slot.t_max = hit.t;
                    }
                }
            }
            if COUNT {
                counters.add_leaf(block.len(), LeafWork { tests: block.len() as u32, hits });
            }
            self.leave_leaf::<ANY>(index, hits > 0);
        }
    }

    #[inline(never)]
    fn visit_ids<const ANY: bool, const COUNT: bool>(&mut self, counters: &mut RayCounters) {
        let (indices, len) = self.states.take(IDS);
        for &index in &indices[..len] {
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let ids = &self.tree.ids[slot.child.ids_range()];
            let work = self.tree.tester.closest_hit(&self.rays[slot.ray], ids, &mut slot.best);
            slot.t_max = slot.t_max.min(slot.best.t);
            if COUNT {
                counters.add_leaf(ids.len(), work);
            }
            self.leave_leaf::<ANY>(index, work.hits > 0);
        }
    }

    #[inline(always)]
    fn leave_leaf<const ANY: bool>(&mut self, index: u8, hit: bool) {
        let slot = &self.slots[usize::from(index) % SLOTS];
        let mut waiting = slot.waiting;
        if hit {
            waiting = if ANY { 1 } else { self.stacks.shorten(index, waiting, slot.t_max) };
        }
        self.pop(index, waiting);
    }

    /// Hands out the hits of rays that have ended and starts others in their slots.
    #[inline(always)]
    fn end_rays(&mut self) {
        let (indices, len) = self.states.take(END);
        for &index in &indices[..len] {
            let slot = &self.slots[usize::from(index) % SLOTS];
            (self.set)(slot.ray, slot.best);
            self.fill(index);
        }
    }
}

/// The hit of one lane, in the ray's interval and no farther than `t_max`.
#[inline(always)]
fn lane_hit(ray: &Started<f32>, block: &TriangleBlock, lane: usize, t_min: f32, t_max: f32) -> Option<Hit> {
    let sheared = ray.shear_exactly(|vertex, axis| block.vertices[3 * vertex + axis][lane]);
    let hit = woop::finish(&sheared, f64::from(ray.dir_z))?;
    let t = hit.t as f32;
    (t >= t_min && t <= t_max && t.is_finite()).then_some(Hit {
        t,
        alpha: hit.alpha as f32,
        beta: hit.beta as f32,
        prim: block.ids[lane],
    })
}
