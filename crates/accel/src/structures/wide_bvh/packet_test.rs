//! A triangle with all rays of a packet: filtered as [`Kernel::block`] filters for single rays, what is left finished in
//! doubles where the rays stand, without a branch that depends on single rays.
//!
//! Vectors are handled in plain loops: `map` and its closures would be functions of their own, compiled without the
//! instructions.

use super::kernels::Kernel;
use super::kernels::sixteen::Sixteen;
use super::layout::{TriangleBlock, WIDTH};
use super::packet::{PACKET, Packet};
use photinus_intersect::methods::woop::finish_lanes;

impl Packet {
    /// Takes up hits of those of `rays`, a mask, on the triangle in `lane`, or with `ANY` ends them; returns which were hit
    /// within their reach. With `FILTER` most that miss are told apart first, which does not pay where `rays` are filtered.
    #[inline(always)]
    pub fn test<K: Kernel, const ANY: bool, const FILTER: bool>(
        &mut self,
        kernel: K,
        block: &TriangleBlock,
        lane: usize,
        rays: u16,
    ) -> u16 {
        let zeros = kernel.zeros();
        let [kx, ky, kz] = self.axes.map(|k| k % 3);
        let origin = [zeros.load(&self.origin[kx]), zeros.load(&self.origin[ky]), zeros.load(&self.origin[kz])];
        let shear = [zeros.load(&self.shear[0]), zeros.load(&self.shear[1])];
        let mut v = [[zeros; 3]; 3];
        for i in 0..3 {
            let at = |k: usize| zeros.all(block.vertices[3 * i + k][lane % WIDTH]);
            let z = at(kz) - origin[2];
            v[i] = [at(kx) - origin[0] - shear[0] * z, at(ky) - origin[1] - shear[1] * z, z];
        }
        if !FILTER {
            return self.finish::<K, ANY>(kernel, &v, rays, block.ids[lane % WIDTH]);
        }
        let (mut below, mut above) = (0, 0);
        for (i, j) in [(2, 1), (0, 2), (1, 0)] {
            let edge = v[i][0] * v[j][1] - v[i][1] * v[j][0];
            below |= edge.lt(zeros);
            above |= zeros.lt(edge);
        }
        let (least, most) = (v[0][2].min(v[1][2]).min(v[2][2]), v[0][2].max(v[1][2]).max(v[2][2]));
        let beyond = zeros.load(&self.reach_high).lt(least) | most.lt(zeros.load(&self.reach_low));
        let mask = rays & !beyond & !(below & above);
        if mask == 0 { 0 } else { self.finish::<K, ANY>(kernel, &v, mask, block.ids[lane % WIDTH]) }
    }

    /// Finishes the triangle `prim`, sheared for each ray, for the rays of a mask; see [`Self::test`].
    #[inline(always)]
    fn finish<K: Kernel, const ANY: bool>(
        &mut self,
        kernel: K,
        sheared: &[[K::Sixteen; 3]; 3],
        mask: u16,
        prim: u32,
    ) -> u16 {
        let zeros = kernel.zeros();
        let (mut first, mut second) = ([[zeros.halves()[0]; 3]; 3], [[zeros.halves()[1]; 3]; 3]);
        for i in 0..3 {
            for k in 0..3 {
                [first[i][k], second[i][k]] = sheared[i][k].halves();
            }
        }
        let dir_z = zeros.load(&self.dir_z).halves();
        let (first, second) = (finish_lanes(&first, dir_z[0]), finish_lanes(&second, dir_z[1]));
        let valid = u16::from(first.hits) | u16::from(second.hits) << (PACKET / 2);
        let t_new = K::Sixteen::rounded([first.t, second.t]);
        let alpha = K::Sixteen::rounded([first.alpha, second.alpha]);
        let beta = K::Sixteen::rounded([first.beta, second.beta]);
        let t_best = zeros.load(&self.best_t);
        let is_in = zeros.load(&self.t_min).le(t_new) & t_new.le(zeros.load(&self.t_max));
        let hit = mask & valid & is_in & t_new.abs().lt(zeros.all(f32::INFINITY));
        let mut beats = hit & t_new.lt(t_best);
        let mut ties = hit & t_new.le(t_best) & !beats;
        while ties != 0 {
            let ray = ties.trailing_zeros();
            beats |= u16::from(prim < self.best_prim[ray as usize].to_bits()) << ray;
            ties &= ties - 1;
        }
        t_new.select(beats, t_best).store(&mut self.best_t);
        zeros.all(f32::from_bits(prim)).select(beats, zeros.load(&self.best_prim)).store(&mut self.best_prim);
        if ANY {
            // Of any hits nobody asks where they are.
            self.end(kernel, hit);
            return hit;
        }
        alpha.select(beats, zeros.load(&self.best_alpha)).store(&mut self.best_alpha);
        beta.select(beats, zeros.load(&self.best_beta)).store(&mut self.best_beta);
        self.set_ends(kernel, beats, t_new);
        hit
    }
}
