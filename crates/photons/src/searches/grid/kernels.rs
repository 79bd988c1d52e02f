//! What a set of vector kernels offers, and the choice among them at run time. All give the same bits.

use super::blocks::{Block, Boxes, LANES};
use super::candidates::Candidates;
use super::scalar;
use super::shared::{Found, Share, Shared};
use crate::inclusion::PreparedQuery;
use crate::photon::NORMAL_MASK;
use crate::{Gathered, GatheredNearest, Kernel};
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
/// position and whose photons face one of these ways. The box distance repeats the operations of the photon distance, so that
/// rounding loses no photon.
pub(crate) type Cull = fn(&Boxes, &[Range<u32>], Vec3, f32, u32, &mut Vec<u32>);
/// Ways in which photons that pass a query's test of normals may face, see [`super::facing::of_query`].
pub(crate) type Facing = fn(Vec3) -> u32;
/// Asks for what [`Gather`] reads of these blocks to be brought near.
pub(crate) type Prefetch = fn(&[Block], &[u32]);
/// Sums what a query finds in these blocks.
pub(crate) type Gather = fn(&[Block], &[u32], &PreparedQuery, &mut NormalMemo) -> Gathered;
/// Finds what a query finds in these blocks: one entry for each block with any.
pub(crate) type Select = fn(&[Block], &[u32], &PreparedQuery, &mut NormalMemo, &mut Vec<Selected>);
/// Collects the photons within a squared radius of a position in these blocks; the ids of all blocks come second.
pub(crate) type Scan = fn(&[Block], &[[u32; LANES]], &[u32], Vec3, f32, &mut Candidates);

/// The k-th least squared distance of photons that were found, of which there are k at least; k is at least 1. The vector
/// is scratch.
pub(crate) type Kth = fn(&[Selected], usize, &mut Vec<f32>) -> f32;
/// Sums the photons that were found up to a query's squared distance.
pub(crate) type GatherSelected = fn(&[Block], &[Selected], &PreparedQuery) -> Gathered;

/// Collects the photons of these blocks that are shared.
pub(crate) type Collect = fn(&[Block], &[u32], &Share, &mut Shared);
/// Finds the nearest of what a query finds among shared photons, `k` at most and 1 at least. A squared distance at which the
/// `k`-th may be saves time where it is near.
pub(crate) type Nearest = fn(&mut Shared, &PreparedQuery, usize, f32) -> Found;
/// Sums what the last query found among shared photons up to a squared distance.
pub(crate) type GatherShared = fn(&Shared, &PreparedQuery) -> Gathered;

/// Sums all that a query finds among shared photons whose sums are whole numbers, where fewer than so many are found: in one
/// pass.
pub(crate) type GatherFew = fn(&Shared, &PreparedQuery, usize) -> Option<GatheredNearest>;

/// Kernels for photons that neighbouring queries share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SharedKernels {
    pub(crate) collect: Collect,
    pub(crate) nearest: Nearest,
    pub(crate) gather: GatherShared,
    pub(crate) gather_few: GatherFew,
}

/// Kernels for one width of vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VectorKernels {
    pub(crate) name: &'static str,
    pub(crate) cull: Cull,
    pub(crate) facing: Facing,
    pub(crate) prefetch: Prefetch,
    pub(crate) gather: Gather,
    pub(crate) select: Select,
    pub(crate) scan: Scan,
    pub(crate) kth: Kth,
    pub(crate) gather_selected: GatherSelected,
    pub(crate) shared: SharedKernels,
}

/// Photons of a block that a query finds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Selected {
    pub(crate) block: u32,
    /// A bit a lane.
    pub(crate) lanes: u32,
    /// Of every lane, found or not.
    pub(crate) distances_sq: [f32; LANES],
}

impl Selected {
    /// Lanes found and their squared distances, in order.
    #[inline]
    pub(crate) fn found(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        let mut lanes = self.lanes;
        std::iter::from_fn(move || {
            (lanes != 0).then(|| {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                (lane, self.distances_sq[lane])
            })
        })
    }
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
