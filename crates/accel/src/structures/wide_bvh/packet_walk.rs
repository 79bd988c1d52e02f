//! The walk of packets through the tree: a node at a time for all rays of up to four packets.

use super::WideBvh;
use super::beam::{Beam, BeamSlots};
use super::frustum::Seen;
use super::kernels::Kernel;
use super::layout::{BLOCK, Child, NODE, Node, TriangleBlock, WIDTH};
use super::packet::{PACKET, Packet, are_alike};
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::LeafWork;
use photinus_profile::ticks;

/// Most packets that walk together: an eight times eight pixels' worth.
const BUNDLE: usize = 4;

/// Bundles whose turn comes so much later are asked for, as far as it takes to tell whether they run together.
const AHEAD: usize = 2;

/// What visits of a node and of a leaf by a beam cost, in visits of a node.
const NODE_WORK: usize = 1;
const LEAF_WORK: usize = 4;
/// What the visits for a ray may cost, and those for each hit besides: what costs more had better go alone, as where triangles
/// are as small as pixels and each leaf is met for one ray.
const RAY_WORK: usize = 2;
const HIT_WORK: usize = 2;
/// After bundles that were given up so many go alone at most before the next is tried.
const MOST_ALONE: usize = 8;

/// Rays of a bundle, by packet.
type Rays = [u16; BUNDLE];

/// A child that waits: where it stands, and where the beam enters it.
#[derive(Clone, Copy)]
struct Waiting {
    entry: f32,
    child: Child,
    parent: Child,
    slot: usize,
}

/// Packets under way.
struct PacketWalk<'a, K: Kernel> {
    tree: &'a WideBvh,
    tree_size: f32,
    kernel: K,
    packets: [Packet; BUNDLE],
    /// The packets that walk now.
    first: usize,
    count: usize,
    beam: Beam,
    /// Where all rays start, along the axes of the ray-triangle test, if they start at one point.
    start: Option<[f32; 3]>,
    seen: Seen,
    stack: Vec<Waiting>,
}

impl<'a, K: Kernel> PacketWalk<'a, K> {
    /// Walks of packets through `tree`.
    fn new(tree: &'a WideBvh, kernel: K) -> Self {
        let nothing = Waiting { entry: 0.0, child: Child::END, parent: Child::END, slot: 0 };
        Self {
            tree,
            tree_size: (tree.bounds.max - tree.bounds.min).max_element(),
            kernel,
            packets: [Packet::IDLE; BUNDLE],
            first: 0,
            count: 0,
            beam: Beam::NONE,
            start: None,
            seen: Seen::NONE,
            stack: vec![nothing; tree.stack_places],
        }
    }

    /// Takes up the packets of some rays, at most [`BUNDLE`], and says which groups of sixteen are some.
    #[inline(always)]
    fn set(&mut self, rays: &[[Ray; PACKET]]) -> [bool; BUNDLE] {
        let mut are_packets = [false; BUNDLE];
        for ((packet, rays), is_packet) in self.packets.iter_mut().zip(rays).zip(&mut are_packets) {
            *is_packet = are_alike(&rays[0], &rays[PACKET - 1]) && packet.set(self.kernel, rays, self.tree_size);
        }
        are_packets
    }

    /// Whether `count` packets from `first` can walk together; they are the ones that walk next.
    #[inline(always)]
    fn choose(&mut self, first: usize, count: usize) -> bool {
        let Some(beam) = Beam::new(&self.packets[first..first + count], self.tree_size) else { return false };
        (self.first, self.count, self.beam) = (first, count, beam);
        self.start = beam.point();
        true
    }

    /// Finds the hits of the chosen packets as single walks would; false where that is given up, as their beam meets so much
    /// that each ray had better walk alone.
    #[inline(always)]
    fn trace<const ANY: bool, const COUNT: bool>(
        &mut self,
        rays: &[[Ray; PACKET]],
        counters: &mut RayCounters,
    ) -> bool {
        let begun = if COUNT { ticks() } else { 0 };
        self.stack[0] = Waiting { entry: self.beam.start, child: Child::node(0), parent: Child::END, slot: 0 };
        let mut top = 1;
        let (mut work, mut most_work) = (0, self.count * PACKET * RAY_WORK);
        while top > 0 && work <= most_work {
            top -= 1;
            let Waiting { entry, child, parent, slot } = self.stack[top];
            // False too where all rays have ended.
            if !(entry <= self.beam.end) {
                continue;
            }
            match child.kind() {
                NODE => {
                    if COUNT {
                        counters.traversal.nodes_visited += (self.count * PACKET) as u64;
                    }
                    work += NODE_WORK;
                    top = self.visit_node(child, top);
                }
                BLOCK => {
                    let tests_begun = if COUNT { ticks() } else { 0 };
                    work += LEAF_WORK;
                    let hits = match self.start {
                        Some(start) => self.see_block::<ANY, COUNT>(&start, child, counters),
                        None => {
                            let reached = self.enter(parent, slot);
                            self.visit_block::<ANY, COUNT>(child, reached, counters)
                        }
                    };
                    most_work += HIT_WORK * hits;
                    if COUNT {
                        counters.ticks.tests += ticks().wrapping_sub(tests_begun);
                        counters.ticks.pairs += 1;
                    }
                }
                _ => {
                    let reached = self.enter(parent, slot);
                    self.visit_ids::<ANY, COUNT>(rays, child, reached, counters);
                    for packet in &mut self.packets[self.first..self.first + self.count] {
                        packet.shorten(self.kernel);
                    }
                    self.beam.shorten(&self.packets[self.first..self.first + self.count]);
                }
            }
        }
        if COUNT {
            counters.ticks.total += ticks().wrapping_sub(begun);
        }
        top == 0
    }

    /// Rays that may enter the leaf in a slot of a node.
    #[inline(always)]
    fn enter(&self, parent: Child, slot: usize) -> Rays {
        let mut rays = [0; BUNDLE];
        for p in 0..self.count {
            rays[p] =
                self.packets[self.first + p].enter(self.kernel, &self.beam, &self.tree.nodes[parent.index()], slot);
        }
        rays
    }

    /// Puts the children that the beam enters on the stack, from far to near, and returns its new height.
    #[inline(always)]
    fn visit_node(&mut self, child: Child, mut top: usize) -> usize {
        let node = &self.tree.nodes[child.index()];
        let mut entered = BeamSlots { slots: [0; WIDTH], entries: [0.0; WIDTH] };
        let count = self.kernel.beam(&self.beam, node, &mut entered);
        for i in 0..count {
            let slot = entered.slots[i] as usize % WIDTH;
            let waiting = &mut self.stack[top];
            (waiting.child, waiting.entry) = (node.children[slot], entered.entries[i]);
            (waiting.parent, waiting.slot) = (child, slot);
            self.kernel.prefetch(self.tree.address(waiting.child), size_of::<TriangleBlock>() / 64);
            top += 1;
        }
        top
    }

    #[inline(always)]
    fn visit_block<const ANY: bool, const COUNT: bool>(
        &mut self,
        child: Child,
        reached: Rays,
        counters: &mut RayCounters,
    ) -> usize {
        let block = &self.tree.blocks[child.index()];
        let len = block.len();
        let mut hits = 0;
        // All packets first: what is left to test is known late, and a branch that waits for it holds up the next packet.
        let mut lanes = [0; BUNDLE];
        for p in 0..self.count {
            if reached[p] != 0 {
                lanes[p] = self.kernel.packet_block(&self.packets[self.first + p], block);
            }
        }
        for p in 0..self.count {
            let packet = &mut self.packets[self.first + p];
            let (mut lanes, mut hit) = (lanes[p], 0);
            while lanes != 0 {
                let found =
                    packet.test::<K, ANY, true>(self.kernel, block, lanes.trailing_zeros() as usize, reached[p]);
                hits += found.count_ones() as usize;
                hit |= found;
                lanes &= lanes - 1;
            }
            if hit != 0 {
                packet.shorten(self.kernel);
            }
            if COUNT {
                for _ in 0..reached[p].count_ones() {
                    counters.add_leaf(len, LeafWork { tests: len as u32, hits: 0 });
                }
            }
        }
        if hits > 0 {
            self.beam.shorten(&self.packets[self.first..self.first + self.count]);
        }
        if COUNT {
            counters.intersect.hits += hits as u64;
        }
        hits
    }

    /// Tests a block for packets that start at one point, and returns how many hits there are.
    #[inline(always)]
    fn see_block<const ANY: bool, const COUNT: bool>(
        &mut self,
        start: &[f32; 3],
        child: Child,
        counters: &mut RayCounters,
    ) -> usize {
        let block = &self.tree.blocks[child.index()];
        let packets = &mut self.packets[self.first..self.first + self.count];
        let all = self.seen.look(self.kernel, &self.beam, start, packets, block);
        let (mut left, mut hits, mut hit) = (all, 0, 0);
        while left != 0 {
            let (p, lane) = (left.trailing_zeros() as usize / WIDTH, left.trailing_zeros() as usize % WIDTH);
            let rays = self.seen.may_hit(self.kernel, &packets[p], lane);
            let found = if rays == 0 { 0 } else { packets[p].test::<K, ANY, false>(self.kernel, block, lane, rays) };
            hits += found.count_ones() as usize;
            hit |= u32::from(found != 0) << p;
            left &= left - 1;
        }
        if hit != 0 {
            for (p, packet) in packets.iter_mut().enumerate() {
                if hit >> p & 1 == 1 {
                    packet.shorten(self.kernel);
                }
            }
            self.beam.shorten(&self.packets[self.first..self.first + self.count]);
        }
        if COUNT {
            let len = block.len();
            for _ in (0..self.count).filter(|p| all >> (WIDTH * p) & 0xFF != 0) {
                for _ in 0..PACKET {
                    counters.add_leaf(len, LeafWork { tests: len as u32, hits: 0 });
                }
            }
            counters.intersect.hits += hits as u64;
        }
        hits
    }

    /// Tests primitives one by one. Apart from the rest, and so without a kernel: its instructions are only known there.
    #[inline(never)]
    fn visit_ids<const ANY: bool, const COUNT: bool>(
        &mut self,
        rays: &[[Ray; PACKET]],
        child: Child,
        reached: Rays,
        counters: &mut RayCounters,
    ) {
        let ids = &self.tree.ids[child.ids_range()];
        for (p, i) in (0..self.count).flat_map(|p| (0..PACKET).map(move |i| (p, i))) {
            let packet = &mut self.packets[self.first + p];
            // Where any hit ended a ray, that is all.
            if reached[p] >> i & 1 == 0 || packet.t_max[i] == f32::NEG_INFINITY {
                continue;
            }
            let tests_begun = if COUNT { ticks() } else { 0 };
            let mut best = packet.best(i);
            let work = self.tree.tester.closest_hit(&rays[self.first + p][i], ids, &mut best);
            if best.t < packet.best_t[i] {
                packet.set_best(i, best, ANY);
            }
            if COUNT {
                counters.add_leaf(ids.len(), work);
                counters.ticks.tests += ticks().wrapping_sub(tests_begun);
                counters.ticks.pairs += 1;
            }
        }
    }
}

impl WideBvh {
    /// Where a node or a block of triangles lies; nowhere in particular for others.
    #[inline(always)]
    fn address(&self, child: Child) -> *const u8 {
        let (start, size) = match child.kind() {
            NODE => (self.nodes.as_ptr().cast::<u8>(), size_of::<Node>()),
            _ => (self.blocks.as_ptr().cast::<u8>(), size_of::<TriangleBlock>()),
        };
        start.wrapping_add(child.index() * size)
    }

    /// Traces the rays that run together in packets, hands out their hits, and says of each group of [`PACKET`] whether
    /// it was one.
    #[inline(always)]
    pub(in crate::structures::wide_bvh) fn trace_packets<K: Kernel, const ANY: bool, const COUNT: bool>(
        &self,
        kernel: K,
        rays: &[Ray],
        set: &mut impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) -> Vec<bool> {
        let (groups, _) = rays.as_chunks::<PACKET>();
        let mut done = Vec::new();
        let mut walk: Option<PacketWalk<K>> = None;
        // Bundles that go alone after the next that is given up, and that still go alone.
        let (mut doubt, mut alone) = (0, 0);
        for (number, rays) in groups.chunks(BUNDLE).enumerate() {
            for group in groups.iter().skip((number + AHEAD) * BUNDLE).take(BUNDLE) {
                kernel.prefetch((&raw const group[0]).cast(), PACKET / 2);
            }
            if !rays.iter().any(|rays| are_alike(&rays[0], &rays[PACKET - 1])) {
                continue;
            }
            let walk = walk.get_or_insert_with(|| PacketWalk::new(self, kernel));
            if alone > 0 {
                alone -= 1;
                continue;
            }
            let mut are_packets = walk.set(rays);
            let (mut tried, mut given_up) = (false, false);
            if are_packets == [true; BUNDLE] && walk.choose(0, BUNDLE) {
                tried = true;
                given_up = !walk.trace::<ANY, COUNT>(rays, counters);
                are_packets = [!given_up; BUNDLE];
            } else {
                for p in 0..BUNDLE {
                    if are_packets[p] && walk.choose(p, 1) {
                        tried = true;
                        are_packets[p] = walk.trace::<ANY, COUNT>(rays, counters);
                        given_up |= !are_packets[p];
                    }
                }
            }
            if tried {
                doubt = if given_up { (2 * doubt + 1).min(MOST_ALONE) } else { 0 };
                alone = doubt;
            }
            done.resize(number * BUNDLE, false);
            done.extend(are_packets);
            for (p, packet) in walk.packets.iter().enumerate().filter(|(p, _)| are_packets[*p]) {
                for i in 0..PACKET {
                    set((number * BUNDLE + p) * PACKET + i, packet.best(i));
                }
            }
        }
        done
    }
}
