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
use super::any_hit::{Lore, Way};
use super::candidates::{Candidates, TOGETHER, choose};
use super::kernels::{Kernel, Lanes, Reach};
use super::layout::{BLOCK, Child, END, IDS, NODE, Node, TriangleBlock, WIDTH};
use super::pace::Pace;
use super::packet::PACKET;
use super::ray_setup::RaySetup;
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::LeafWork;
use photinus_profile::ticks;

/// Rays under way at a time.
pub const SLOTS: usize = 64;

/// Rays whose turn comes so much later are asked for.
const AHEAD: usize = 16;

/// Places that a stack needs in a tree with so many levels of nodes: for the end, for all but one of the children of
/// every node on the way, and for a whole node to be written.
pub fn stack_places(levels: u32) -> usize {
    1 + levels as usize * (WIDTH - 1) + WIDTH
}

/// A ray under way.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Slot {
    setup: RaySetup,
    /// Where the search ends: the end of the ray or the nearest hit.
    t_max: f32,
    best: Hit,
    child: Child,
    /// Index in the batch.
    ray: usize,
    /// First place of its stack, which holds the end.
    bottom: usize,
    /// The place above the last that is filled.
    top: usize,
    /// How a ray for which any hit will do looks for it.
    way: Way,
}

const IDLE: Slot = Slot {
    setup: RaySetup::IDLE,
    t_max: 0.0,
    best: Hit::MISS,
    child: Child::END,
    ray: 0,
    bottom: 0,
    top: 0,
    way: Way::PLAIN,
};

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

    /// Eight places.
    #[inline(always)]
    fn lanes(&mut self, start: usize) -> Lanes<'_> {
        Lanes {
            entries: self.entries[start..][..WIDTH].as_mut_array().expect("WIDTH long"),
            children: self.children[start..][..WIDTH].as_mut_array().expect("WIDTH long"),
        }
    }

    /// Takes children beyond `t_max` out of a slot's stack and returns how many places are left filled.
    #[inline(always)]
    fn shorten<K: Kernel>(&mut self, kernel: K, bottom: usize, top: usize, t_max: f32) -> usize {
        let mut kept = bottom + 1;
        let mut first = bottom + 1;
        // At least once: a loop that may not run at all is a branch to be guessed.
        loop {
            let (entries, children, mask) = kernel.keep(self.lanes(first), t_max);
            let left = top - first;
            let mask = if left < WIDTH { mask & ((1 << left) - 1) } else { mask };
            let to = self.lanes(kept);
            (*to.entries, *to.children) = (entries, children);
            kept += mask.count_ones() as usize;
            if left <= WIDTH {
                return kept;
            }
            first += WIDTH;
        }
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
    lore: Lore,
    /// Groups of rays that ran as packets, from the first.
    done: Vec<bool>,
    next: usize,
    pace: Pace<'a>,
    slots: [Slot; SLOTS],
    stacks: Stacks,
    candidates: Candidates,
    /// Where the children of each kind lie, and how many bytes apart.
    places: [(*const u8, usize); 4],
    states: States,
    set: F,
}

impl WideBvh {
    /// The nearest hits, or with `ANY` any hits, of all rays but those of groups that are done, handed to `set`; counts the work where `COUNT` says so.
    #[inline(always)]
    pub(in crate::structures::wide_bvh) fn trace<K: Kernel, const ANY: bool, const COUNT: bool>(
        &self,
        kernel: K,
        rays: &[Ray],
        done: Vec<bool>,
        set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        let states = States { slots: [[0; SLOTS]; 4], lens: [0; 4] };
        let stacks = Stacks::new(self.stack_places, SLOTS.min(rays.len()));
        let slots = [IDLE; SLOTS];
        let candidates = Candidates::NONE;
        let nodes = (self.nodes.as_ptr().cast::<u8>(), size_of::<Node>());
        let blocks = (self.blocks.as_ptr().cast::<u8>(), size_of::<TriangleBlock>());
        let ids = (self.ids.as_ptr().cast::<u8>(), size_of::<u32>());
        let places = [nodes, nodes, blocks, ids];
        let lore = Lore::default();
        let pace = Pace::new(&self.habits[usize::from(ANY)], rays.len());
        let mut walk = Walk {
            tree: self,
            kernel,
            rays,
            lore,
            done,
            next: 0,
            pace,
            slots,
            stacks,
            candidates,
            places,
            states,
            set,
        };
        // Nodes, tests and the ends of rays take turns, each for all rays of its state: between them stand the stamps.
        // What is set up once for a batch stands before them: the batches that are counted are shorter than most.
        let begun = if COUNT { ticks() } else { 0 };
        walk.start::<ANY>();
        while walk.states.lens != [0; 4] {
            walk.pace.step();
            walk.visit_nodes::<ANY, COUNT>(counters);
            let tests_begun = if COUNT { ticks() } else { 0 };
            walk.visit_blocks::<ANY, COUNT>(counters);
            if walk.states.lens[IDS] > 0 {
                let (indices, len) = walk.states.take(IDS);
                walk.visit_ids::<COUNT>(&indices[..len], counters);
                for &index in &indices[..len] {
                    walk.leave_leaf::<ANY>(index);
                }
            }
            if COUNT {
                counters.ticks.tests += ticks().wrapping_sub(tests_begun);
                counters.ticks.pairs += 1;
            }
            walk.end_rays::<ANY>();
        }
        if COUNT {
            counters.ticks.total += ticks().wrapping_sub(begun);
        }
    }
}

impl<K: Kernel, F: FnMut(usize, Hit)> Walk<'_, K, F> {
    /// Fills the slots.
    #[inline(always)]
    fn start<const ANY: bool>(&mut self) {
        for index in 0..SLOTS.min(self.rays.len()) as u8 {
            self.slots[usize::from(index)].bottom = usize::from(index) * self.stacks.places;
            self.fill::<ANY>(index);
        }
    }

    /// Starts the next ray of the batch that can hit anything in a slot, if one is left; misses are handed out on the
    /// way.
    #[inline(always)]
    fn fill<const ANY: bool>(&mut self, index: u8) {
        while self.next < self.rays.len() {
            if self.next.is_multiple_of(PACKET) && self.done.get(self.next / PACKET) == Some(&true) {
                self.next += PACKET;
                continue;
            }
            let i = self.next;
            self.next += 1;
            self.kernel.prefetch(self.rays.as_ptr().wrapping_add(i + AHEAD).cast(), 1);
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let ray = &self.rays[i];
            if slot.setup.set(ray, &self.tree.bounds) {
                self.pace.rays += 1;
                slot.t_max = ray.t_max;
                slot.best = Hit::MISS;
                slot.child = Child::node(0);
                slot.ray = i;
                slot.top = slot.bottom + 1;
                if ANY {
                    slot.way = self.lore.way(i);
                    slot.setup.octant ^= slot.way.turn();
                    if let Some(block) = self.lore.guess(slot.way) {
                        self.stacks.children[slot.top] = slot.child;
                        (slot.child, slot.top) = (block, slot.top + 1);
                        self.states.push(BLOCK, index);
                        return;
                    }
                }
                self.states.push(NODE, index);
                return;
            }
            (self.set)(i, Hit::MISS);
        }
    }

    /// Takes the child below `top` from a slot's stack.
    #[inline(always)]
    fn pop(&mut self, index: u8, top: usize) {
        let slot = &mut self.slots[usize::from(index) % SLOTS];
        let child = self.stacks.children[top - 1];
        slot.top = top - 1;
        slot.child = child;
        let kind = child.kind();
        let (start, size) = self.places[kind];
        if self.pace.is_early {
            // All lines of a node; those of a block are one more.
            let start = start.wrapping_add(child.index() * size);
            self.kernel.prefetch(start, size_of::<Node>() / 64);
            self.kernel.prefetch(start.wrapping_add(size).wrapping_sub(64), 1);
        }
        self.states.push(kind, index);
    }

    #[inline(always)]
    fn visit_nodes<const ANY: bool, const COUNT: bool>(&mut self, counters: &mut RayCounters) {
        let (indices, len) = self.states.take(NODE);
        if COUNT {
            counters.traversal.nodes_visited += len as u64;
        }
        for &index in &indices[..len] {
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let node = &self.tree.nodes[slot.child.index()];
            let top = slot.top;
            if ANY {
                slot.way.nodes += 1;
            }
            let count = self.kernel.node(&slot.setup, node, slot.t_max, self.stacks.lanes(top));
            self.pop(index, top + count);
        }
    }

    /// Filters the triangles of all leaves first, then finishes those that are left, then takes up the rays again: what
    /// a test says is not known for long, and is nothing that a processor could guess.
    #[inline(always)]
    fn visit_blocks<const ANY: bool, const COUNT: bool>(&mut self, counters: &mut RayCounters) {
        let (indices, len) = self.states.take(BLOCK);
        self.candidates.len = 0;
        for &index in &indices[..len] {
            let slot = &self.slots[usize::from(index) % SLOTS];
            let block = &self.tree.blocks[slot.child.index()];
            let reach = Reach::new(slot.setup.woop.dir_z, slot.setup.t_min, slot.t_max);
            self.candidates.add(index, self.kernel.block(&slot.setup, &reach, block));
            if COUNT {
                counters.add_leaf(block.len(), LeafWork { tests: block.len() as u32, hits: 0 });
            }
        }
        let mut first = 0;
        while first < self.candidates.len {
            let hits = self.finish(first);
            if COUNT {
                counters.intersect.hits += hits;
            }
            first += TOGETHER;
        }
        for &index in &indices[..len] {
            self.leave_leaf::<ANY>(index);
        }
    }

    /// Finishes the next candidates and returns how many are hits.
    #[inline(always)]
    fn finish(&mut self, first: usize) -> u64 {
        let count = (self.candidates.len - first).min(TOGETHER);
        for i in 0..count {
            let (index, lane) = self.candidates.at(first + i);
            let slot = &self.slots[index];
            let block = &self.tree.blocks[slot.child.index()];
            let woop = &slot.setup.woop;
            let sheared = woop.sheared(|vertex, axis| block.vertices[3 * vertex + axis][lane]);
            self.candidates.shear(i, &sheared, woop.dir_z);
        }
        let (are_hits, [t, alpha, beta]) = self.candidates.finish(self.kernel);
        let mut hits = 0;
        for i in 0..count {
            let (index, lane) = self.candidates.at(first + i);
            let slot = &mut self.slots[index];
            let prim = self.tree.blocks[slot.child.index()].ids[lane];
            let (t, alpha, beta) = (t[i], alpha[i], beta[i]);
            let is_hit = are_hits >> i & 1 == 1;
            let accepted = is_hit & (t >= slot.setup.t_min) & (t <= slot.t_max) & t.is_finite();
            let beats = accepted & ((t < slot.best.t) | ((t == slot.best.t) & (prim < slot.best.prim)));
            hits += u64::from(accepted);
            slot.best = choose(beats, Hit { t, alpha, beta, prim }, slot.best);
            slot.t_max = if beats { t } else { slot.t_max };
        }
        hits
    }

    /// Tests primitives one by one. Apart from the rest, and so without the kernel: its instructions are only known there.
    #[inline(never)]
    fn visit_ids<const COUNT: bool>(&mut self, indices: &[u8], counters: &mut RayCounters) {
        for &index in indices {
            let slot = &mut self.slots[usize::from(index) % SLOTS];
            let ids = &self.tree.ids[slot.child.ids_range()];
            let work = self.tree.tester.closest_hit(&self.rays[slot.ray], ids, &mut slot.best);
            slot.t_max = slot.t_max.min(slot.best.t);
            if COUNT {
                counters.add_leaf(ids.len(), work);
            }
        }
    }

    /// Goes on after a leaf, whether or not it was hit: that is a coin tossed for every ray.
    #[inline(always)]
    fn leave_leaf<const ANY: bool>(&mut self, index: u8) {
        let slot = &mut self.slots[usize::from(index) % SLOTS];
        if ANY {
            let leaf = if slot.child.kind() == BLOCK { Some(slot.child) } else { None };
            self.lore.note_leaf(&mut slot.way, leaf, slot.best.is_hit());
        }
        let top = match ANY {
            true if slot.best.is_hit() => slot.bottom + 1,
            true => slot.top,
            false => self.stacks.shorten(self.kernel, slot.bottom, slot.top, slot.t_max),
        };
        self.pop(index, top);
    }

    /// Hands out the hits of rays that have ended and starts others in their slots.
    #[inline(always)]
    fn end_rays<const ANY: bool>(&mut self) {
        let (indices, len) = self.states.take(END);
        for &index in &indices[..len] {
            let slot = &self.slots[usize::from(index) % SLOTS];
            (self.set)(slot.ray, slot.best);
            if ANY {
                self.lore.note_end(slot.way);
            }
            self.fill::<ANY>(index);
        }
    }
}
