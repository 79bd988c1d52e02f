//! The walk of packets through the tree: a node at a time for all sixteen rays.

use super::WideBvh;
use super::candidates::choose;
use super::kernels::Kernel;
use super::layout::{BLOCK, Child, NODE, WIDTH};
use super::packet::{ByRay, PACKET, Packet, are_alike};
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::LeafWork;
use photinus_intersect::methods::woop::{LaneHits, finish_lanes};
use photinus_profile::ticks;

/// A child that waits: where each ray enters it, and which do.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Waiting {
    entries: ByRay,
    child: Child,
    rays: u16,
}

const NOTHING: Waiting = Waiting { entries: [0.0; PACKET], child: Child::END, rays: 0 };

/// A packet under way, one after the other.
struct PacketWalk<'a, K: Kernel> {
    tree: &'a WideBvh,
    kernel: K,
    packet: Packet,
    stack: Vec<Waiting>,
    candidates: Candidates,
}

/// Triangles finished at a time.
const TOGETHER: usize = 8;
/// All rays with all triangles of a block, and as many places as are read beyond the last.
const ROOM: usize = PACKET * WIDTH + TOGETHER;

/// What the filter left of a block.
struct Candidates {
    /// Sheared vertices, by vertex and axis.
    sheared: [[f32; ROOM]; 9],
    dir_z: [f32; ROOM],
    /// Numbers in the packet and in the block.
    rays: [u8; ROOM],
    lanes: [u8; ROOM],
    len: usize,
}

impl Candidates {
    const NONE: Self =
        Self { sheared: [[0.0; ROOM]; 9], dir_z: [1.0; ROOM], rays: [0; ROOM], lanes: [0; ROOM], len: 0 };

    /// Adds rays of a mask with the triangle in `lane`.
    #[inline(always)]
    fn add(&mut self, mut rays: u16, lane: usize, sheared: &[ByRay; 9], dir_z: &ByRay) {
        while rays != 0 {
            let ray = rays.trailing_zeros() as usize;
            let place = self.len % ROOM;
            for (to, from) in self.sheared.iter_mut().zip(sheared) {
                to[place] = from[ray];
            }
            self.dir_z[place] = dir_z[ray];
            (self.rays[place], self.lanes[place]) = (ray as u8, lane as u8);
            self.len += 1;
            rays &= rays - 1;
        }
    }

    /// Finishes those from `first`.
    #[inline(always)]
    fn finish(&self, first: usize) -> LaneHits<TOGETHER> {
        let (mut sheared, mut dir_z) = ([[[0.0; TOGETHER]; 3]; 3], [0.0; TOGETHER]);
        for (row, values) in self.sheared.iter().enumerate() {
            let values = &values[first..][..TOGETHER];
            for i in 0..TOGETHER {
                sheared[row / 3][row % 3][i] = f64::from(values[i]);
            }
        }
        let values = &self.dir_z[first..][..TOGETHER];
        for i in 0..TOGETHER {
            dir_z[i] = f64::from(values[i]);
        }
        finish_lanes(&sheared, &dir_z)
    }
}

impl<'a, K: Kernel> PacketWalk<'a, K> {
    /// Walks of packets through `tree`.
    fn new(tree: &'a WideBvh, kernel: K) -> Self {
        let stack = vec![NOTHING; tree.stack_places];
        Self { tree, kernel, packet: Packet::IDLE, stack, candidates: Candidates::NONE }
    }

    /// The hits of sixteen rays as the single walk would find them; `None` where they had better go alone.
    #[inline(always)]
    fn trace<const ANY: bool, const COUNT: bool>(
        &mut self,
        rays: &[Ray; PACKET],
        counters: &mut RayCounters,
    ) -> Option<&[Hit; PACKET]> {
        if !self.packet.set(self.kernel, rays, &self.tree.bounds) {
            return None;
        }
        let begun = if COUNT { ticks() } else { 0 };
        self.stack[0] = Waiting { entries: self.packet.t_min, child: Child::node(0), rays: u16::MAX };
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let Waiting { child, rays: waiting, .. } = self.stack[top];
            let reached = waiting & self.kernel.reached(&self.stack[top].entries, &self.packet.t_max);
            if reached == 0 {
                continue;
            }
            match child.kind() {
                NODE => {
                    if COUNT {
                        counters.traversal.nodes_visited += u64::from(reached.count_ones());
                    }
                    top = self.visit_node(child, reached, top);
                }
                BLOCK => {
                    let tests_begun = if COUNT { ticks() } else { 0 };
                    self.visit_block::<ANY, COUNT>(child, reached, counters);
                    if COUNT {
                        counters.ticks.tests += ticks().wrapping_sub(tests_begun);
                        counters.ticks.pairs += 1;
                    }
                }
                _ => self.visit_ids::<ANY, COUNT>(rays, child, reached, counters),
            }
        }
        if COUNT {
            counters.ticks.total += ticks().wrapping_sub(begun);
        }
        Some(&self.packet.best)
    }

    /// Puts the children that any ray enters on the stack, from far to near, and returns its new height.
    #[inline(always)]
    fn visit_node(&mut self, child: Child, rays: u16, mut top: usize) -> usize {
        let node = &self.tree.nodes[child.index()];
        let mut slots = [0; WIDTH];
        let count = self.kernel.beam(&self.packet, node, &mut slots);
        for &slot in &slots[..count] {
            let slot = slot as usize % WIDTH;
            let waiting = &mut self.stack[top];
            waiting.child = node.children[slot];
            waiting.rays = rays & self.kernel.packet_box(&self.packet, node, slot, &mut waiting.entries);
            top += usize::from(waiting.rays != 0);
        }
        top
    }

    #[inline(always)]
    fn visit_block<const ANY: bool, const COUNT: bool>(
        &mut self,
        child: Child,
        reached: u16,
        counters: &mut RayCounters,
    ) {
        let block = &self.tree.blocks[child.index()];
        let len = block.len();
        self.candidates.len = 0;
        let mut sheared = [[0.0; PACKET]; 9];
        for lane in 0..len {
            let passed = reached & self.kernel.packet_triangle(&self.packet, block, lane, &mut sheared);
            self.candidates.add(passed, lane, &sheared, &self.packet.dir_z);
        }
        let mut hits = 0;
        let mut first = 0;
        while first < self.candidates.len {
            hits += self.finish::<ANY>(child, first);
            first += TOGETHER;
        }
        if hits > 0 {
            self.packet.shorten_beam(self.kernel);
        }
        if COUNT {
            for _ in 0..reached.count_ones() {
                counters.add_leaf(len, LeafWork { tests: len as u32, hits: 0 });
            }
            counters.intersect.hits += hits;
        }
    }

    /// Finishes the next candidates and returns how many are hits.
    #[inline(always)]
    fn finish<const ANY: bool>(&mut self, child: Child, first: usize) -> u64 {
        let block = &self.tree.blocks[child.index()];
        let count = (self.candidates.len - first).min(TOGETHER);
        let found = self.candidates.finish(first);
        let mut hits = 0;
        for place in 0..count {
            let lane = usize::from(self.candidates.lanes[first + place]) % WIDTH;
            let ray = usize::from(self.candidates.rays[first + place]) % PACKET;
            let (t, alpha, beta) = (found.t[place] as f32, found.alpha[place] as f32, found.beta[place] as f32);
            let packet = &mut self.packet;
            let best = packet.best[ray];
            let prim = block.ids[lane];
            let accepted = (t >= packet.t_min[ray]) & (t <= packet.t_max[ray]) & t.is_finite();
            let beats = accepted & ((t < best.t) | ((t == best.t) & (prim < best.prim)));
            hits += u64::from(accepted);
            packet.best[ray] = choose(beats, Hit { t, alpha, beta, prim }, best);
            if beats {
                packet.set_end(ray, if ANY { f32::NEG_INFINITY } else { t });
            }
        }
        hits
    }

    #[inline(never)]
    fn visit_ids<const ANY: bool, const COUNT: bool>(
        &mut self,
        rays: &[Ray; PACKET],
        child: Child,
        reached: u16,
        counters: &mut RayCounters,
    ) {
        let ids = &self.tree.ids[child.ids_range()];
        for (i, ray) in rays.iter().enumerate().filter(|(i, _)| reached >> i & 1 == 1) {
            let tests_begun = if COUNT { ticks() } else { 0 };
            let mut best = self.packet.best[i];
            let work = self.tree.tester.closest_hit(ray, ids, &mut best);
            if best.t < self.packet.best[i].t {
                self.packet.set_end(i, if ANY { f32::NEG_INFINITY } else { best.t });
            }
            self.packet.best[i] = best;
            if COUNT {
                counters.add_leaf(ids.len(), work);
                counters.ticks.tests += ticks().wrapping_sub(tests_begun);
                counters.ticks.pairs += 1;
            }
        }
        self.packet.shorten_beam(self.kernel);
    }
}

impl WideBvh {
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
        for (group, rays) in groups.iter().enumerate() {
            if !are_alike(&rays[0], &rays[PACKET - 1]) {
                continue;
            }
            let walk = walk.get_or_insert_with(|| PacketWalk::new(self, kernel));
            if let Some(hits) = walk.trace::<ANY, COUNT>(rays, counters) {
                done.resize(group, false);
                done.push(true);
                for (i, hit) in hits.iter().enumerate() {
                    set(group * PACKET + i, *hit);
                }
            }
        }
        done
    }
}
