//! Block hashing: Ma, McCool, "Low Latency Photon Mapping Using Block Hashing", Graphics Hardware 2002. Photons that lie close
//! together fill blocks, as memory hands them out; several hash tables, whose functions give points that lie close together
//! the same bucket more often than not (locality-sensitive hashing), tell which blocks a point may need.
//!
//! Each table divides space by planes of its own along each axis, at quantiles of the photons, moved by a part of a step from
//! table to table. A bucket lists the blocks that have a photon in it. Read as the paper does, a search looks into the one bucket
//! of each table that its middle lies in, and may miss what lies beyond; read whole, it looks into all buckets of the first
//! table that the region touches, and misses nothing.

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::space::usual_radius;
use crate::store::positions;
use photinus_geometry::{Aabb, Vec3};

pub(crate) const ABOUT: &str = "block hashing, all buckets of a region read";
pub(crate) const ABOUT_APPROXIMATE: &str = "block hashing, one bucket of each table read: may miss photons";

/// Photons of a block.
const BLOCK: usize = 32;
/// Hash tables.
const TABLES: usize = 4;
/// Radii of a search that a bucket is wide.
const RADII_A_BUCKET: f64 = 2.0;
/// Most buckets of a table for each block, which bounds what empty ones take.
const BUCKETS_A_BLOCK: f64 = 2.0;
/// Most buckets along an axis.
const MOST_STEPS: f64 = 1024.0;

/// A run of places and the box of their photons.
struct Block {
    bounds: Aabb,
    first: u32,
    count: u32,
}

/// Buckets between planes.
struct Table {
    /// Planes by axis, ascending.
    planes: [Vec<f32>; 3],
    /// Where each bucket's blocks begin in `blocks`, and their end.
    starts: Vec<u32>,
    /// Blocks by bucket.
    blocks: Vec<u32>,
}

impl Table {
    /// Buckets along an axis.
    fn steps(&self, axis: usize) -> usize {
        self.planes[axis].len() + 1
    }

    /// The step that a coordinate lies in.
    fn step(&self, axis: usize, x: f32) -> usize {
        self.planes[axis].partition_point(|plane| *plane <= x)
    }

    fn bucket(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.steps(1) + y) * self.steps(2) + z
    }

    fn bucket_of(&self, p: Vec3) -> usize {
        self.bucket(std::array::from_fn(|axis| self.step(axis, p[axis])))
    }

    fn listed(&self, bucket: usize) -> &[u32] {
        &self.blocks[self.starts[bucket] as usize..self.starts[bucket + 1] as usize]
    }

    /// The box of the steps along each axis.
    fn bounds(&self, axis: usize, step: usize) -> [f32; 2] {
        let planes = &self.planes[axis];
        [
            step.checked_sub(1).map_or(f32::NEG_INFINITY, |below| planes[below]),
            planes.get(step).copied().unwrap_or(f32::INFINITY),
        ]
    }
}

/// Blocks and tables; `EXACT` reads all buckets of a region.
pub(crate) struct BlockHash<const EXACT: bool> {
    blocks: Vec<Block>,
    tables: Vec<Table>,
}

impl<const EXACT: bool> BlockHash<EXACT> {
    /// The search over some photons, for balls of about this radius; by default of the size that holds some dozens.
    pub(crate) fn build(photons: &[Photon], radius: Option<f32>) -> Indexed<Self> {
        let positions = positions(photons);
        let mut ids: Vec<u32> = (0..photons.len() as u32).collect();
        fill(&positions, &mut ids);
        let block = |(i, ids): (usize, &[u32])| Block {
            bounds: Aabb::around(ids.iter().map(|id| positions[*id as usize])),
            first: (i * BLOCK) as u32,
            count: ids.len() as u32,
        };
        let blocks: Vec<Block> = ids.chunks(BLOCK).enumerate().map(block).collect();
        let sorted: [Vec<f32>; 3] = std::array::from_fn(|axis| {
            let mut x: Vec<f32> = positions.iter().map(|p| p[axis]).collect();
            x.sort_unstable_by(f32::total_cmp);
            x
        });
        let bounds = Aabb::around(positions.iter().copied());
        let width = RADII_A_BUCKET * f64::from(radius.unwrap_or_else(|| usual_radius(&bounds, photons.len())));
        let wanted = bounds.size().to_array().map(|size| (f64::from(size) / width).clamp(1.0, MOST_STEPS));
        let excess = wanted.iter().product::<f64>() / (BUCKETS_A_BLOCK * blocks.len() as f64 + 1.0);
        let steps = wanted.map(|steps| (steps / libm::cbrt(excess.max(1.0))).ceil() as usize);
        let tables = (0..if EXACT { 1 } else { TABLES }).map(|t| {
            let planes = std::array::from_fn(|axis| {
                let shift = (2 * t + 1) as f64 / (2 * TABLES) as f64;
                let at = |i: usize| ((i as f64 + shift) / steps[axis] as f64 * sorted[axis].len() as f64) as usize;
                let mut planes: Vec<f32> = (0..steps[axis]).filter_map(|i| sorted[axis].get(at(i)).copied()).collect();
                planes.dedup();
                planes
            });
            list(planes, &blocks, &ids, &positions)
        });
        let tables = tables.collect();
        Indexed::new(photons, (Self { blocks, tables }, ids))
    }
}

/// Sorts photons so that each [`BLOCK`] of them is a box: halves along the longest axis, at whole blocks.
fn fill(positions: &[Vec3], ids: &mut [u32]) {
    if ids.len() <= BLOCK {
        return;
    }
    let size = Aabb::around(ids.iter().map(|id| positions[*id as usize])).size();
    let axis = (0..3).fold(0, |longest, axis| if size[axis] > size[longest] { axis } else { longest });
    let middle = ids.len().div_ceil(BLOCK) / 2 * BLOCK;
    ids.select_nth_unstable_by(middle, |a, b| {
        positions[*a as usize][axis].total_cmp(&positions[*b as usize][axis]).then(a.cmp(b))
    });
    let (below, above) = ids.split_at_mut(middle);
    fill(positions, below);
    fill(positions, above);
}

/// The table of these planes.
fn list(planes: [Vec<f32>; 3], blocks: &[Block], ids: &[u32], positions: &[Vec3]) -> Table {
    let mut table = Table { planes, starts: Vec::new(), blocks: Vec::new() };
    let mut pairs = Vec::new();
    let mut buckets = Vec::with_capacity(BLOCK);
    for (i, block) in (0..).zip(blocks) {
        let places = block.first as usize..(block.first + block.count) as usize;
        buckets.clear();
        buckets.extend(ids[places].iter().map(|id| table.bucket_of(positions[*id as usize]) as u32));
        buckets.sort_unstable();
        buckets.dedup();
        pairs.extend(buckets.iter().map(|bucket| (*bucket, i)));
    }
    pairs.sort_unstable();
    let count = table.steps(0) * table.steps(1) * table.steps(2);
    table.starts = vec![0; count + 1];
    for (bucket, _) in &pairs {
        table.starts[*bucket as usize + 1] += 1;
    }
    for bucket in 0..count {
        table.starts[bucket + 1] += table.starts[bucket];
    }
    table.blocks = pairs.into_iter().map(|(_, block)| block).collect();
    table
}

impl<const EXACT: bool> BlockHash<EXACT> {
    /// Blocks of all buckets of the first table within reach; some more than once.
    fn read_all(&self, scan: &impl Scan, found: &mut Vec<u32>) {
        let table = &self.tables[0];
        let whole = [f32::NEG_INFINITY, f32::INFINITY];
        let is_reached = |slabs: [[f32; 2]; 3]| {
            let corner = |end: usize| Vec3::from(slabs.map(|slab| slab[end]));
            !scan.is_out_of_reach(scan.reach(&Aabb { min: corner(0), max: corner(1) }))
        };
        for x in 0..table.steps(0) {
            let slab_x = table.bounds(0, x);
            if !is_reached([slab_x, whole, whole]) {
                continue;
            }
            for y in 0..table.steps(1) {
                let slab_y = table.bounds(1, y);
                if !is_reached([slab_x, slab_y, whole]) {
                    continue;
                }
                for z in 0..table.steps(2) {
                    if is_reached([slab_x, slab_y, table.bounds(2, z)]) {
                        found.extend(table.listed(table.bucket([x, y, z])));
                    }
                }
            }
        }
    }
}

impl<const EXACT: bool> Index for BlockHash<EXACT> {
    const NAME: &'static str = if EXACT { "block-hash" } else { "block-hash-approximate" };

    fn search(&self, scan: &mut impl Scan) {
        let mut found = Vec::new();
        if EXACT {
            self.read_all(scan, &mut found);
        } else {
            for table in &self.tables {
                found.extend(table.listed(table.bucket_of(scan.middle())));
            }
        }
        found.sort_unstable();
        found.dedup();
        let reach = |block: &u32| (scan.reach(&self.blocks[*block as usize].bounds), *block);
        let mut order: Vec<(f32, u32)> = found.iter().map(reach).collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (reach, block) in order {
            if scan.is_out_of_reach(reach) {
                return;
            }
            let block = &self.blocks[block as usize];
            scan.run(block.first as usize..(block.first + block.count) as usize);
        }
    }

    fn bytes(&self) -> usize {
        let table = |t: &Table| {
            let planes: usize = t.planes.iter().map(Vec::capacity).sum();
            (planes + t.starts.capacity() + t.blocks.capacity()) * size_of::<u32>()
        };
        self.blocks.capacity() * size_of::<Block>() + self.tables.iter().map(table).sum::<usize>()
    }
}
