//! The stream of random numbers of one path: a function of seed, kind, stream and index.

use crate::sobol::sobol_owen4;
use crate::splitmix::{GAMMA, mix64};

/// What a stream of random numbers is for. Streams of different kinds are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum StreamKind {
    /// Camera samples: the stream is the pixel, the index the sample (over all passes).
    Eye = 1,
    /// Photons: the stream is the pass, the index the photon.
    Photon = 2,
    /// Pilot photons, which steer radii and never enter an estimate.
    Pilot = 3,
    /// Anything made once for a scene.
    Scene = 4,
    /// Tests.
    Test = 5,
    /// Photons sent out for caustics alone: streams and indices as of photons.
    CausticPhoton = 6,
    /// Which queries are counted: it never reaches a picture.
    Twin = 7,
    /// Directions to the sky that a pass draws from: the stream is the part of the sky, the index the direction (over all
    /// passes).
    Sky = 8,
    /// Points of an estimate's disc that are looked at: streams and indices as of camera samples.
    Support = 9,
    /// Rays of final gathering: the stream is the pixel and the edges of its path, the index the ray (over all passes).
    FinalGather = 10,
    /// Points that records of irradiance are made for, and their rays: the stream is the pixel or the record, the index the ray.
    IrradianceCache = 11,
}

/// Dimensions beyond this many draw plain random numbers: long paths gain nothing from stratification.
const STRATIFIED_GROUPS: u64 = 8;

/// Random numbers of one path, each in `[0, 1)`.
///
/// Within a stream the samples of consecutive indices are well spread in each consecutive group of four dimensions
/// (Owen-scrambled Sobol points); groups are decorrelated from one another by independent shuffles.
#[derive(Clone, Debug)]
pub struct Sampler {
    /// Hash of seed, kind and stream.
    stream: u64,
    /// Bits of the index in reverse.
    reversed_index: u32,
    /// Numbers drawn or skipped; a multiple of four: the next group is still to be made.
    drawn: u32,
    group: [f32; 4],
}

impl Sampler {
    /// The numbers of sample `index` in `stream`. Equal arguments give equal numbers on any machine.
    #[inline]
    pub fn new(seed: u64, kind: StreamKind, stream: u64, index: u32) -> Self {
        let family = mix64(seed.wrapping_add(GAMMA.wrapping_mul(kind as u64)));
        Self {
            stream: mix64(family.wrapping_add(GAMMA.wrapping_mul(stream))),
            reversed_index: index.reverse_bits(),
            drawn: 0,
            group: [0.0; 4],
        }
    }

    fn refill(&mut self) {
        let group = u64::from(self.drawn / 4);
        let words = if group < STRATIFIED_GROUPS {
            // A word of the hash for each dimension, and one for the shuffle.
            let first = self.stream.wrapping_add(GAMMA.wrapping_mul(3 * group));
            sobol_owen4(self.reversed_index, mix64(first) as u32, words(first))
        } else {
            words(mix64(self.stream ^ u64::from(self.reversed_index) << 32 ^ group))
        };
        self.group = words.map(unit_f32);
    }

    /// The next number, uniform in `[0, 1)`.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let i = self.drawn as usize % 4;
        if i == 0 {
            self.refill();
        }
        self.drawn += 1;
        self.group[i]
    }

    /// The next two numbers, jointly stratified over the indices of the stream.
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        if self.drawn % 4 == 3 {
            self.drawn += 1;
        }
        let i = self.drawn as usize % 4;
        if i == 0 {
            self.refill();
        }
        self.drawn += 2;
        [self.group[i], self.group[i + 1]]
    }

    /// Skips what is left of the current group of four, so that the next draws start a fresh one.
    ///
    /// A path calls it once a vertex: a vertex that needs fewer numbers then does not shift those of the next.
    #[inline]
    pub fn start_vertex(&mut self) {
        self.drawn = self.drawn.next_multiple_of(4);
    }
}

/// The next four words of the sequence at `state`.
#[inline]
fn words(state: u64) -> [u32; 4] {
    let a = mix64(state.wrapping_add(GAMMA));
    let b = mix64(state.wrapping_add(GAMMA.wrapping_mul(2)));
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32]
}

/// A random word as a number in `[0, 1)` with 24 bits.
#[inline]
pub fn unit_f32(word: u32) -> f32 {
    (word >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_arguments_give_equal_numbers_and_others_differ() {
        let draw = |seed, kind, stream, index| {
            let mut s = Sampler::new(seed, kind, stream, index);
            (0..64).map(|_| s.next_1d().to_bits()).collect::<Vec<_>>()
        };
        let base = draw(1, StreamKind::Eye, 2, 3);
        assert_eq!(base, draw(1, StreamKind::Eye, 2, 3));
        assert_ne!(base, draw(2, StreamKind::Eye, 2, 3));
        assert_ne!(base, draw(1, StreamKind::Photon, 2, 3));
        assert_ne!(base, draw(1, StreamKind::Eye, 3, 3));
        assert_ne!(base, draw(1, StreamKind::Eye, 2, 4));
    }

    /// Mean and covariance over many streams: each estimate's standard error is sqrt(1/12/N), so that six of them
    /// bound 48 means with a false alarm in about 10^7 runs.
    #[test]
    fn numbers_are_uniform_and_uncorrelated_across_streams() {
        const STREAMS: u64 = 20_000;
        const DIMENSIONS: usize = 48;
        let mut sum = [0.0f64; DIMENSIONS];
        let mut lag = [0.0f64; DIMENSIONS - 1];
        for stream in 0..STREAMS {
            let mut s = Sampler::new(42, StreamKind::Test, stream, (stream % 7) as u32);
            let draws: [f64; DIMENSIONS] = std::array::from_fn(|_| f64::from(s.next_1d()));
            for d in 0..DIMENSIONS {
                sum[d] += draws[d] - 0.5;
                if d + 1 < DIMENSIONS {
                    lag[d] += (draws[d] - 0.5) * (draws[d + 1] - 0.5);
                }
            }
        }
        let n = STREAMS as f64;
        for d in 0..DIMENSIONS {
            assert!((sum[d] / n).abs() < 6.0 * (1.0 / 12.0 / n).sqrt(), "mean of dimension {d}: {}", sum[d] / n);
        }
        for (d, c) in lag.iter().enumerate() {
            assert!((c / n).abs() < 6.0 / 12.0 / n.sqrt(), "covariance of dimensions {d}, {}: {}", d + 1, c / n);
        }
    }
}
