//! Plain Rust: the twin that the other kernels are tested against, and what machines without AVX2 run.

use super::Kernel;
use crate::reach::Reach;
use crate::structures::brute_force::layout::{Boxes, CHUNK, LANES, Vertices};
use crate::structures::brute_force::sieve::Sieve;
use photinus_intersect::methods::woop::Started;

/// The kernel.
#[derive(Clone, Copy)]
pub struct Scalar;

/// The larger; `b` where either is not a number.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller; `b` where either is not a number.
#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl Kernel for Scalar {
    #[inline(always)]
    fn sift(self, sieve: &Sieve, boxes: &[Boxes]) -> u64 {
        let mut passed = 0;
        for (index, block) in boxes.iter().enumerate() {
            let mut out = [false; LANES];
            for axis in 0..2 {
                let row = |start: usize| &block.bounds[start / LANES];
                let (lower, upper) = (row(sieve.side[axis]), row(sieve.side[axis] + LANES));
                let (with_lower, with_upper) = (row(sieve.with_lower[axis]), row(sieve.with_upper[axis]));
                let (shear, most, least) = (sieve.shear[axis], sieve.most[axis], sieve.least[axis]);
                for lane in 0..LANES {
                    out[lane] |= lower[lane] - shear * with_lower[lane] > most;
                    out[lane] |= upper[lane] - shear * with_upper[lane] < least;
                }
            }
            passed |= u64::from(!out.iter().fold(true, |all, out| all & out)) << (index % CHUNK);
        }
        passed
    }

    #[inline(always)]
    fn filter(self, ray: &Started<f32>, reach: &Reach, block: &Vertices) -> u16 {
        let [kx, ky, kz] = ray.axes;
        let (mut x, mut y, mut z) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for v in 0..3 {
            for lane in 0..LANES {
                z[v][lane] = block.rows[3 * v + kz][lane] - ray.origin[kz];
                x[v][lane] = block.rows[3 * v + kx][lane] - ray.origin[kx] - ray.shear[0] * z[v][lane];
                y[v][lane] = block.rows[3 * v + ky][lane] - ray.origin[ky] - ray.shear[1] * z[v][lane];
            }
        }
        let mut mask = 0;
        for lane in 0..LANES {
            let edge = |i: usize, j: usize| x[i][lane] * y[j][lane] - y[i][lane] * x[j][lane];
            let edges = [edge(2, 1), edge(0, 2), edge(1, 0)];
            let straddles =
                min(min(edges[0], edges[1]), edges[2]) < 0.0 && max(max(edges[0], edges[1]), edges[2]) > 0.0;
            let least = min(min(z[0][lane], z[1][lane]), z[2][lane]);
            let most = max(max(z[0][lane], z[1][lane]), z[2][lane]);
            mask |= u16::from(!(straddles || least > reach.high || most < reach.low)) << lane;
        }
        mask
    }
}
