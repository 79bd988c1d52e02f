//! The irradiance cache: records, and an octree whose cells list those that may hold there (Ward, Rubinstein and Clear,
//! SIGGRAPH 1988, section "Storage").
//!
//! A record lies in the cells, of about the size of its sphere of validity, that the sphere reaches: at most eight. A point is in
//! one cell of each size, so that a look-up goes down one branch and no further.

use super::record::IrradianceRecord;
use crate::PhotonError;
use photinus_geometry::{Aabb, Vec3};

/// Halvings of the root at most: its 2^24th part is about what single precision still resolves.
const MOST_LEVELS: u32 = 24;
/// How much wider than its radius a sphere is taken for its cells, over the radius and over the largest coordinate: more than
/// rounding.
const MARGIN: [f32; 2] = [1e-5, 1e-6];
/// No cell.
const NONE: u32 = u32::MAX;

/// Records that are interpolated between.
#[derive(Clone, Debug)]
pub struct IrradianceCache {
    records: Vec<IrradianceRecord>,
    cells: Vec<Cell>,
    /// Least corner and edge of the root.
    corner: Vec3,
    edge: f32,
    accuracy: f32,
}

#[derive(Clone, Debug)]
struct Cell {
    children: [u32; 8],
    records: Vec<u32>,
}

impl Cell {
    const EMPTY: Self = Self { children: [NONE; 8], records: Vec::new() };
}

impl IrradianceCache {
    /// Without records, for points within `bounds`; what lies elsewhere is found, too, but more slowly. `accuracy` is Ward's a,
    /// above 0: a record is used where its weight is above 1/a.
    pub fn new(bounds: Aabb, accuracy: f32) -> Self {
        // Room around for the spheres of records on the outermost surfaces.
        let edge = bounds.size().max_element() * 2.0;
        let corner = bounds.center() - Vec3::splat(0.5 * edge);
        let is_one = edge > 0.0 && edge.is_finite() && corner.is_finite();
        let (corner, edge) = if is_one { (corner, edge) } else { (Vec3::ZERO, 1.0) };
        Self { records: Vec::new(), cells: vec![Cell::EMPTY], corner, edge, accuracy }
    }

    /// Adds a record.
    ///
    /// # Errors
    /// [`PhotonError::Record`] where a number of it is not finite or its radius is not above 0.
    pub fn insert(&mut self, record: IrradianceRecord) -> Result<(), PhotonError> {
        if !record.is_valid() {
            return Err(PhotonError::Record(record.position));
        }
        let id = self.records.len() as u32;
        let valid = self.accuracy * record.radius;
        let reach = valid * (1.0 + MARGIN[0]) + MARGIN[1] * record.position.abs().max_element();
        let sphere = Aabb { min: record.position - Vec3::splat(reach), max: record.position + Vec3::splat(reach) };
        let root = Aabb { min: self.corner, max: self.corner + Vec3::splat(self.edge) };
        // A sphere that leaves the root lies in the root's own list, which every look-up reads.
        if root.contains(sphere.min) && root.contains(sphere.max) {
            self.list(0, root, sphere, 4.0 * reach, MOST_LEVELS, id);
        } else {
            self.cells[0].records.push(id);
        }
        self.records.push(record);
        Ok(())
    }

    /// Puts a record into those cells of a branch that its sphere reaches and that are no wider than `width`.
    fn list(&mut self, cell: u32, bounds: Aabb, sphere: Aabb, width: f32, levels: u32, id: u32) {
        if levels == 0 || bounds.max.x - bounds.min.x <= width {
            self.cells[cell as usize].records.push(id);
            return;
        }
        let middle = bounds.center();
        for octant in 0..8 {
            let (mut part, mut is_reached) = (bounds, true);
            for axis in 0..3 {
                if octant >> axis & 1 == 0 {
                    part.max[axis] = middle[axis];
                    is_reached &= sphere.min[axis] <= middle[axis];
                } else {
                    part.min[axis] = middle[axis];
                    is_reached &= sphere.max[axis] >= middle[axis];
                }
            }
            if !is_reached {
                continue;
            }
            let mut child = self.cells[cell as usize].children[octant];
            if child == NONE {
                child = self.cells.len() as u32;
                self.cells[cell as usize].children[octant] = child;
                self.cells.push(Cell::EMPTY);
            }
            self.list(child, part, sphere, width, levels - 1, id);
        }
    }

    /// Calls `visit` with every record that may hold at a place, until it says to stop.
    fn records_at(&self, position: Vec3, mut visit: impl FnMut(&IrradianceRecord) -> bool) {
        let mut bounds = Aabb { min: self.corner, max: self.corner + Vec3::splat(self.edge) };
        let is_inside = bounds.contains(position);
        let mut cell = &self.cells[0];
        loop {
            for &id in &cell.records {
                if !visit(&self.records[id as usize]) {
                    return;
                }
            }
            if !is_inside {
                return;
            }
            let middle = bounds.center();
            let mut octant = 0;
            for axis in 0..3 {
                if position[axis] >= middle[axis] {
                    octant |= 1 << axis;
                    bounds.min[axis] = middle[axis];
                } else {
                    bounds.max[axis] = middle[axis];
                }
            }
            match cell.children[octant] {
                NONE => return,
                child => cell = &self.cells[child as usize],
            }
        }
    }

    /// The irradiance at a place with its unit normal, W per scene unit squared: the mean of what the records predict that
    /// hold there, by weight (Ward 1988, equation 5); none where no record does.
    pub fn at(&self, position: Vec3, normal: Vec3) -> Option<Vec3> {
        let mut mean = Mean::default();
        self.records_at(position, |record| {
            mean.add(record, position, normal, self.accuracy);
            true
        });
        mean.value()
    }

    /// [`Self::at`] of each place; `out` is as long as `places`.
    pub fn look_up(&self, places: &[(Vec3, Vec3)], out: &mut [Option<Vec3>]) {
        assert_eq!(places.len(), out.len(), "one result a place");
        for ((position, normal), out) in places.iter().zip(out) {
            *out = self.at(*position, *normal);
        }
    }

    /// The slow answer to [`Self::at`]: every record is looked at.
    pub fn at_by_brute_force(&self, position: Vec3, normal: Vec3) -> Option<Vec3> {
        let mut mean = Mean::default();
        self.records.iter().for_each(|record| mean.add(record, position, normal, self.accuracy));
        mean.value()
    }

    /// Whether a record holds at a place with its unit normal by the accuracy `a`, which is at most the cache's.
    pub fn is_known(&self, position: Vec3, normal: Vec3, a: f32) -> bool {
        let mut is_known = false;
        self.records_at(position, |record| {
            is_known = record.error(position, normal).is_some_and(|error| error < a);
            !is_known
        });
        is_known
    }

    /// The records, in the order in which they were added.
    pub fn records(&self) -> &[IrradianceRecord] {
        &self.records
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let lists: usize = self.cells.iter().map(|cell| cell.records.capacity() * size_of::<u32>()).sum();
        self.records.capacity() * size_of::<IrradianceRecord>() + self.cells.capacity() * size_of::<Cell>() + lists
    }
}

/// A mean by weight.
#[derive(Default)]
struct Mean {
    sum: Vec3,
    weights: f32,
}

impl Mean {
    fn add(&mut self, record: &IrradianceRecord, position: Vec3, normal: Vec3, accuracy: f32) {
        if let Some(error) = record.error(position, normal)
            && error < accuracy
        {
            let weight = 1.0 / error;
            self.sum += record.predicted(position, normal) * weight;
            self.weights += weight;
        }
    }

    fn value(&self) -> Option<Vec3> {
        (self.weights > 0.0).then(|| self.sum / self.weights)
    }
}
