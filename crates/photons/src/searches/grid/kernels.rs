//! What a set of vector kernels offers, and the choice among them at run time. All give the same bits.

use super::blocks::{Block, Boxes};
use super::scalar;
use crate::inclusion::PreparedQuery;
use crate::photon::NORMAL_MASK;
use crate::{Gathered, Kernel, Neighbor};
use photinus_geometry::Vec3;
use std::ops::Range;
use std::sync::OnceLock;

/// Kernels by number, for code that is compiled once a kernel.
pub(crate) const CONSTANT: u8 = 0;
pub(crate) const CONE: u8 = 1;
pub(crate) const EPANECHNIKOV: u8 = 2;
pub(crate) const GAUSSIAN: u8 = 3;

/// The number of a kernel.
#[inline]
pub(crate) fn kernel_index(kernel: Kernel) -> u8 {
    match kernel {
        Kernel::Constant => CONSTANT,
        Kernel::Cone { .. } => CONE,
        Kernel::Epanechnikov => EPANECHNIKOV,
        Kernel::Gaussian => GAUSSIAN,
    }
}

/// Appends the blocks, of ascending ranges that do not overlap, whose boxes come within a squared radius of a
/// position. The box distance repeats the operations of the photon distance, so that rounding loses no photon.
pub(crate) type Cull = fn(&Boxes, &[Range<u32>], Vec3, f32, &mut Vec<u32>);
/// Asks for what [`Gather`] reads of these blocks to be brought near.
pub(crate) type Prefetch = fn(&[Block], &[u32]);
/// Sums what a query finds in these blocks.
pub(crate) type Gather = fn(&[Block], &[u32], &PreparedQuery, &mut NormalMemo) -> Gathered;
/// Collects the photons within a squared radius of a position in these blocks; the ids of all slots come second.
pub(crate) type Scan = fn(&[Block], &[u32], &[u32], Vec3, f32, &mut Candidates);

/// Kernels for one width of vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VectorKernels {
    pub(crate) name: &'static str,
    pub(crate) cull: Cull,
    pub(crate) prefetch: Prefetch,
    pub(crate) gather: Gather,
    pub(crate) scan: Scan,
}

/// Every set that this processor runs, the fastest first.
pub(crate) fn available() -> &'static [VectorKernels] {
    static AVAILABLE: OnceLock<Vec<VectorKernels>> = OnceLock::new();
    AVAILABLE.get_or_init(|| {
        let mut sets = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            sets.extend(super::avx512::kernels());
            sets.extend(super::avx2::kernels());
        }
        sets.push(scalar::KERNELS);
        sets
    })
}

/// A stored normal that is known to pass the test of the query at hand: neighbours on a plane share theirs, and equal
/// words need no arithmetic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalMemo {
    /// Normal of the query that `passes` is about.
    normal: Vec3,
    pub(crate) word: u32,
    pub(crate) passes: bool,
}

impl NormalMemo {
    pub(crate) const NONE: Self = Self { normal: Vec3::NAN, word: 0, passes: false };

    /// Keeps what is known where it holds for `query`, too.
    #[inline]
    pub(crate) fn turn_to(&mut self, query: &PreparedQuery) {
        if self.normal != query.normal {
            self.normal = query.normal;
            self.passes = query.normal_within_60(self.word);
        }
    }

    /// A photon's surface word that passes the test.
    #[inline]
    pub(crate) fn learn(&mut self, surface: u32) {
        self.word = surface & NORMAL_MASK;
        self.passes = true;
    }
}

/// The photons of a scan, as keys of distance and id, cut down to the nearest k whenever they get many.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    keys: Vec<u64>,
    len: usize,
    k: usize,
}

/// Candidates beyond k that are collected before the farthest are dropped.
const SURPLUS: usize = 192;

impl Candidates {
    /// Starts a search for the `k` nearest.
    pub(crate) fn start(&mut self, k: usize) {
        (self.len, self.k) = (0, k);
    }

    /// Room for `count` keys behind those held.
    #[inline]
    pub(crate) fn free(&mut self, count: usize) -> &mut [u64] {
        if self.keys.len() < self.len + count {
            self.keys.resize((self.len + count).max(2 * self.keys.len()).max(256), 0);
        }
        &mut self.keys[self.len..]
    }

    /// Keeps `count` keys that were written to [`Candidates::free`]; returns the squared distance beyond which nothing
    /// more can be among the nearest, when that is news.
    #[inline]
    pub(crate) fn push(&mut self, count: usize) -> Option<f32> {
        self.len += count;
        (self.len >= self.k.saturating_add(SURPLUS)).then(|| self.cut())
    }

    /// Drops all but the nearest k; returns the squared distance of the farthest left.
    fn cut(&mut self) -> f32 {
        let (_, farthest, _) = self.keys[..self.len].select_nth_unstable(self.k - 1);
        self.len = self.k;
        f32::from_bits((*farthest >> 32) as u32)
    }

    /// Photons held.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// The nearest k in order.
    pub(crate) fn finish(&mut self, found: &mut Vec<Neighbor>) {
        if self.len > self.k {
            self.cut();
        }
        self.keys[..self.len].sort_unstable();
        self.take_all(found);
    }

    /// All that were collected, in no order.
    pub(crate) fn take_all(&mut self, found: &mut Vec<Neighbor>) {
        let keys = &self.keys[..self.len];
        found.clear();
        found.extend(
            keys.iter().map(|key| Neighbor { distance_sq: f32::from_bits((key >> 32) as u32), photon: *key as u32 }),
        );
    }
}

/// A key of [`Candidates`]: distances are not negative, so that their bits sort as they do.
#[inline]
pub(crate) fn key(distance_sq: f32, id: u32) -> u64 {
    u64::from(distance_sq.to_bits()) << 32 | u64::from(id)
}
