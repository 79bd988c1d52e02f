//! The stream of random numbers of one path: a function of seed, kind, stream and index.

use crate::philox::philox4x32;
use crate::sobol::sobol_owen4;

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
}

/// Dimensions beyond this many draw plain random numbers: long paths gain nothing from stratification.
const STRATIFIED_BLOCKS: u32 = 8;

/// Random numbers of one path, each in `[0, 1)`.
///
/// Within a stream the samples of consecutive indices are well spread in each consecutive group of four dimensions
/// (Owen-scrambled Sobol points); groups are decorrelated from one another by independent shuffles.
#[derive(Clone, Debug)]
pub struct Sampler {
    key: [u32; 2],
    stream: [u32; 2],
    index: u32,
    block: u32,
    buffer: [u32; 4],
    used: u32,
}

impl Sampler {
    /// The numbers of sample `index` in `stream`. Equal arguments give equal numbers on any machine.
    #[inline]
    pub fn new(seed: u64, kind: StreamKind, stream: u64, index: u32) -> Self {
        let kind = (kind as u32).wrapping_mul(0x9E37_79B9);
        Self {
            key: [seed as u32 ^ kind, (seed >> 32) as u32],
            stream: [stream as u32, (stream >> 32) as u32],
            index,
            block: 0,
            buffer: [0; 4],
            used: 4,
        }
    }

    #[inline]
    fn refill(&mut self) {
        self.buffer = if self.block < STRATIFIED_BLOCKS {
            // One word of the hash seeds each dimension; the shuffle takes its own mix of them.
            let h = philox4x32([self.stream[0], self.stream[1], self.block, 0x5EED], self.key);
            let shuffle = h[0].rotate_left(16) ^ h[1].wrapping_mul(0x85EB_CA6B) ^ h[2].rotate_left(7) ^ h[3];
            sobol_owen4(self.index, shuffle, h)
        } else {
            philox4x32([self.stream[0], self.stream[1], self.block, self.index], self.key)
        };
        self.block += 1;
        self.used = 0;
    }

    /// The next number, uniform in `[0, 1)`.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        if self.used >= 4 {
            self.refill();
        }
        let word = self.buffer[self.used as usize];
        self.used += 1;
        unit_f32(word)
    }

    /// The next two numbers, jointly stratified over the indices of the stream.
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        if self.used >= 3 {
            self.refill();
        }
        let i = self.used as usize;
        self.used += 2;
        [unit_f32(self.buffer[i]), unit_f32(self.buffer[i + 1])]
    }

    /// Skips what is left of the current group of four, so that the next draws start a fresh one.
    ///
    /// A path calls it once a vertex: a vertex that needs fewer numbers then does not shift those of the next.
    #[inline]
    pub fn start_vertex(&mut self) {
        self.used = 4;
    }
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
