//! Inclusion tests of many photons for a few regions at once, in plain Rust that compilers turn into vectors of whatever
//! width a function may use: each instruction set compiles it once.

use crate::Region;
use photinus_geometry::Vec3;

/// Photons of a block.
pub(crate) const LANES: usize = 16;
/// Regions that are tested together: one look at a photon serves all.
pub(crate) const TOGETHER: usize = 4;

/// Coordinates of blocks, by axis; lanes without a photon hold NaN, which no region holds.
pub(crate) type Blocks<'a> = [&'a [[f32; LANES]]; 3];

/// Blocks with a photon that a region holds: index of the block, and for each lane a bit for each region.
pub(crate) type Found = Vec<(u32, [u8; LANES])>;

/// An inclusion test, the same operations as [`Region::holds`].
pub(crate) trait Inclusion: Copy {
    /// Whether a photon is in.
    fn holds(&self, p: [f32; 3]) -> bool;
}

/// A ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    center: Vec3,
    r2: f32,
}

/// A box by middle and half its size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cuboid {
    center: Vec3,
    half: Vec3,
}

/// A box by bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    min: Vec3,
    max: Vec3,
}

impl Inclusion for Ball {
    #[inline(always)]
    fn holds(&self, [x, y, z]: [f32; 3]) -> bool {
        let (dx, dy, dz) = (x - self.center.x, y - self.center.y, z - self.center.z);
        (dx * dx + dy * dy) + dz * dz <= self.r2
    }
}

impl Inclusion for Cuboid {
    #[inline(always)]
    fn holds(&self, [x, y, z]: [f32; 3]) -> bool {
        ((x - self.center.x).abs() <= self.half.x)
            & ((y - self.center.y).abs() <= self.half.y)
            & ((z - self.center.z).abs() <= self.half.z)
    }
}

impl Inclusion for Bounds {
    #[inline(always)]
    fn holds(&self, [x, y, z]: [f32; 3]) -> bool {
        (self.min.x <= x)
            & (x <= self.max.x)
            & (self.min.y <= y)
            & (y <= self.max.y)
            & (self.min.z <= z)
            & (z <= self.max.z)
    }
}

/// Regions of one kind; missing ones hold nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Group {
    /// Balls.
    Balls([Ball; TOGETHER]),
    /// Boxes by middle.
    Cuboids([Cuboid; TOGETHER]),
    /// Boxes by bounds.
    Bounds([Bounds; TOGETHER]),
}

impl Group {
    /// A group of the first of some regions, and how many they are: as many as are of one kind.
    pub(crate) fn of(regions: &[Region]) -> (Self, usize) {
        let kind = std::mem::discriminant(&regions[0]);
        let count = regions.iter().take(TOGETHER).take_while(|r| std::mem::discriminant(*r) == kind).count();
        let at = |i: usize| regions.get(i).filter(|region| i < count && region.is_valid()).copied();
        let nowhere = Vec3::splat(f32::NAN);
        let group = match regions[0] {
            Region::Sphere { .. } => Self::Balls(std::array::from_fn(|i| match at(i) {
                Some(Region::Sphere { center, radius }) => Ball { center, r2: radius * radius },
                _ => Ball { center: nowhere, r2: -1.0 },
            })),
            Region::Cuboid { .. } => Self::Cuboids(std::array::from_fn(|i| match at(i) {
                Some(Region::Cuboid { center, half }) => Cuboid { center, half },
                _ => Cuboid { center: nowhere, half: nowhere },
            })),
            Region::Bounds { .. } => Self::Bounds(std::array::from_fn(|i| match at(i) {
                Some(Region::Bounds { min, max }) => Bounds { min, max },
                _ => Bounds { min: nowhere, max: nowhere },
            })),
        };
        (group, count)
    }
}

/// Adds the blocks that hold a photon of any of the regions to `found`, in order; `first` is the index of the first.
#[inline(always)]
pub(crate) fn sieve<T: Inclusion>([x, y, z]: Blocks<'_>, first: u32, tests: &[T; TOGETHER], found: &mut Found) {
    for (i, ((x, y), z)) in (first..).zip(x.iter().zip(y).zip(z)) {
        let mut held = [0u32; LANES];
        for (q, test) in tests.iter().enumerate() {
            for lane in 0..LANES {
                held[lane] |= u32::from(test.holds([x[lane], y[lane], z[lane]])) << q;
            }
        }
        let mut any = 0;
        for lane in held {
            any |= lane;
        }
        if any != 0 {
            found.push((i, held.map(|lane| lane as u8)));
        }
    }
}

/// [`sieve`] for a group.
#[inline(always)]
pub(crate) fn sieve_group(blocks: Blocks<'_>, first: u32, group: &Group, found: &mut Found) {
    match group {
        Group::Balls(tests) => sieve(blocks, first, tests, found),
        Group::Cuboids(tests) => sieve(blocks, first, tests, found),
        Group::Bounds(tests) => sieve(blocks, first, tests, found),
    }
}
