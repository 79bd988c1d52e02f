//! Packets that start at one point, as a camera's rays do, and triangles as seen from there: one look at a block of them
//! serves all packets, and what is left of a triangle for a ray is three edge functions, linear in its shears.
//!
//! A triangle's vertices are sheared by a direction amid those that may hit it, so that what they lose to cancellation is
//! relative to the triangle and not to its distance. A ray differs from that direction by shears `s`; its edge function
//! between vertices i and j is `x_i y_j - y_i x_j - s_x (z_i y_j - y_i z_j) - s_y (x_i z_j - z_i x_j)`, and the one that
//! [`photinus_intersect::methods::woop`] finds from vertices that it shears in floats lies no further from what is computed
//! here than the error below. With u = 2^-24, m the greatest distance of a vertex from the start along an axis, and S the
//! greatest of a sheared vertex for any ray in question: vertices are sheared with an error of 3um at most, by the ray and
//! here, which makes 36umS + 36 u^2 m^2; products, sums and relative shears round by 52uS^2; 64uS(m + S) + 64 u^2 m^2 is
//! more than all.

use super::beam::Beam;
use super::kernels::Kernel;
use super::kernels::sixteen::Sixteen;
use super::layout::{TriangleBlock, WIDTH};
use super::packet::{ByRay, PACKET, Packet};

/// 64 units in the last place of numbers below one.
const ERROR: f32 = 32.0 * f32::EPSILON;

/// Eight triangles, twice: so that two packets are tested at once.
type Twice = ByRay;

/// Triangles of a block as seen from a point, by lane.
#[repr(C, align(64))]
pub struct Seen {
    /// A direction amid those that may hit it, as shears.
    middle: [Twice; 2],
    /// The least shears, from the middle, that may hit.
    low: [Twice; 2],
    /// The greatest.
    high: [Twice; 2],
    /// Edge functions, positive inside: in the middle, and what each shear takes away.
    edges: [[Twice; 3]; 3],
    /// What an edge function must be below so that the exact one is surely negative.
    limit: Twice,
    /// The least distances along the third axis.
    least: Twice,
    /// The greatest.
    most: Twice,
}

impl Seen {
    /// Nothing.
    pub const NONE: Self = Self {
        middle: [[0.0; PACKET]; 2],
        low: [[0.0; PACKET]; 2],
        high: [[0.0; PACKET]; 2],
        edges: [[[0.0; PACKET]; 3]; 3],
        limit: [0.0; PACKET],
        least: [0.0; PACKET],
        most: [0.0; PACKET],
    };

    /// Looks at a block, and returns which triangles rays of these packets may hit within their reach: a mask of eight lanes
    /// for each packet. They are four at most and all start at `start`.
    #[inline(always)]
    pub fn look<K: Kernel>(
        &mut self,
        kernel: K,
        beam: &Beam,
        start: &[f32; 3],
        packets: &[Packet],
        block: &TriangleBlock,
    ) -> u32 {
        let zeros = kernel.zeros();
        let axes = beam.axes.map(|k| k % 3);
        let shear = &beam.bounds.shear;
        let beam_width = (shear[0][1] - shear[0][0]).max(shear[1][1] - shear[1][0]);
        let mut v = [[zeros; 3]; 3];
        let mut inv = [zeros; 3];
        for i in 0..3 {
            for k in 0..3 {
                v[k][i] = zeros.twice(&block.vertices[3 * i + axes[k]]) - zeros.all(start[k]);
            }
            inv[i] = zeros.all(1.0) / v[2][i];
        }
        let z = v[2];
        let (least, most) = (z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2]));
        let (mut far, mut size) = (least.abs().max(most.abs()), zeros);
        let (mut middle, mut low, mut high) = ([zeros; 2], [zeros; 2], [zeros; 2]);
        let mut at = [[zeros; 3]; 2];
        for k in 0..2 {
            // The first vertex, or the next direction that there is a ray of: not far from any that may hit. Of the maximum the
            // second is taken where the first is not a number.
            let [first, last] = shear[k];
            middle[k] = (v[k][0] * inv[0]).max(zeros.all(first)).min(zeros.all(last));
            let mut sheared = [zeros; 3];
            for i in 0..3 {
                at[k][i] = v[k][i] - middle[k] * z[i];
                sheared[i] = at[k][i] * inv[i];
                far = v[k][i].abs().max(far);
                size = at[k][i].abs().max(size);
            }
            low[k] = sheared[0].min(sheared[1]).min(sheared[2]);
            high[k] = sheared[0].max(sheared[1]).max(sheared[2]);
        }
        let [x, y] = at;
        // Of triangles that are not all before the start nothing is known.
        let nearest = if beam.is_forward { least } else { zeros - most };
        let is_before = zeros.lt(nearest);
        let tiny = zeros.all(f32::MIN_POSITIVE);
        let slack = (zeros.all(ERROR) * (far + size) + tiny) * inv[0].abs().max(inv[1].abs()).max(inv[2].abs());
        let mut width = zeros;
        for k in 0..2 {
            low[k] = (low[k] - slack).select(is_before, zeros.all(f32::NEG_INFINITY));
            high[k] = (high[k] + slack).select(is_before, zeros.all(f32::INFINITY));
            width = low[k].abs().max(high[k].abs()).max(width);
        }
        let size = size + width.min(zeros.all(beam_width)) * far;
        let error = zeros.all(ERROR) * size * (far + size) + zeros.all(ERROR * f32::EPSILON) * far * far + tiny;
        let mut edges = [[zeros; 3]; 3];
        let mut volume = zeros;
        for (n, (i, j)) in [(2, 1), (0, 2), (1, 0)].into_iter().enumerate() {
            edges[n] = [x[i] * y[j] - y[i] * x[j], z[i] * y[j] - y[i] * z[j], x[i] * z[j] - z[i] * x[j]];
            volume = volume + edges[n][0] * z[n];
        }
        // A hit's edge functions all have the sign of the volume, where that is sure.
        let doubt = zeros.all(4.0) * far * error + tiny;
        let is_sure = doubt.lt(volume.abs()) & volume.abs().lt(zeros.all(f32::INFINITY));
        let limit = (zeros - error).select(is_sure & is_before, zeros.all(f32::NEG_INFINITY));
        let is_negative = volume.lt(zeros);
        let is_turned = if beam.is_forward { is_negative } else { !is_negative };
        for n in 0..3 {
            for k in 0..3 {
                edges[n][k] = (zeros - edges[n][k]).select(is_turned, edges[n][k]);
                edges[n][k].store(&mut self.edges[n][k]);
            }
        }
        for k in 0..2 {
            middle[k].store(&mut self.middle[k]);
            low[k].store(&mut self.low[k]);
            high[k].store(&mut self.high[k]);
        }
        limit.store(&mut self.limit);
        least.store(&mut self.least);
        most.store(&mut self.most);

        // Lanes without a triangle hold no numbers.
        let used = least.le(most);
        let mut left = 0;
        for pair in 0..packets.len().div_ceil(2) {
            // An odd packet is tested twice.
            let (a, b) = (&packets[2 * pair], &packets[(2 * pair + 1).min(packets.len() - 1)]);
            let both = |a: f32, b: f32| zeros.halved(a, b);
            let (mut from, mut to) = ([zeros; 2], [zeros; 2]);
            let mut none = most.lt(both(a.reach[0], b.reach[0])) | both(a.reach[1], b.reach[1]).lt(least);
            for k in 0..2 {
                let ([a_first, a_last], [b_first, b_last]) = (a.bounds.shear[k], b.bounds.shear[k]);
                from[k] = (both(a_first, b_first) - middle[k]).max(low[k]);
                to[k] = (both(a_last, b_last) - middle[k]).min(high[k]);
                none |= to[k].lt(from[k]);
            }
            for [edge, by_x, by_y] in edges {
                let x = (by_x * from[0]).min(by_x * to[0]);
                let y = (by_y * from[1]).min(by_y * to[1]);
                none |= (edge - x - y).lt(limit);
            }
            left |= u32::from(used & !none) << (PACKET * pair);
        }
        if packets.len() % 2 == 1 { left & (u32::MAX >> (32 - WIDTH * packets.len())) } else { left }
    }

    /// Rays of a packet that may hit the triangle in a lane within their reach.
    #[inline(always)]
    pub fn may_hit<K: Kernel>(&self, kernel: K, packet: &Packet, lane: usize) -> u16 {
        let zeros = kernel.zeros();
        let lane = lane % WIDTH;
        let x = zeros.load(&packet.shear[0]) - zeros.all(self.middle[0][lane]);
        let y = zeros.load(&packet.shear[1]) - zeros.all(self.middle[1][lane]);
        let mut none = zeros.load(&packet.reach_high).lt(zeros.all(self.least[lane]));
        none |= zeros.all(self.most[lane]).lt(zeros.load(&packet.reach_low));
        none |= x.lt(zeros.all(self.low[0][lane])) | zeros.all(self.high[0][lane]).lt(x);
        none |= y.lt(zeros.all(self.low[1][lane])) | zeros.all(self.high[1][lane]).lt(y);
        for [edge, by_x, by_y] in &self.edges {
            let edge = zeros.all(edge[lane]) - x * zeros.all(by_x[lane]) - y * zeros.all(by_y[lane]);
            none |= edge.lt(zeros.all(self.limit[lane]));
        }
        !none
    }
}
