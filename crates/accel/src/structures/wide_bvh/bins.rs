//! The split of some primitives: binned centroids along all three axes at once, by Wald, "On Fast Construction of
//! SAH-based Bounding Volume Hierarchies" (2007).

use super::layout::WIDTH;
use photinus_geometry::{Aabb, Mat4, Vec4};

/// A primitive to be placed: its padded bounds and, in the fourth lane of the lower corner, the bits of its id.
#[derive(Clone, Copy, Debug)]
pub struct BuildPrim {
    low: Vec4,
    high: Vec4,
}

impl BuildPrim {
    /// The primitive `id` of these padded bounds.
    pub fn new(bounds: &Aabb, id: u32) -> Self {
        // One added to whatever number the id's bits are is none of the small ones that take many cycles.
        Self { low: bounds.min.extend(f32::from_bits(id)), high: bounds.max.extend(1.0) }
    }

    /// Primitive id.
    pub fn id(&self) -> u32 {
        self.low.w.to_bits()
    }

    /// Twice the middle of the bounds; infinite beyond half of the greatest number, where an axis divides nothing.
    fn centroid(&self) -> Vec4 {
        self.low + self.high
    }
}

/// A box in vector registers; the fourth lane means nothing.
#[derive(Clone, Copy, Debug)]
pub struct WideBox {
    min: Vec4,
    max: Vec4,
}

impl WideBox {
    /// The identity of [`WideBox::union`].
    const EMPTY: Self = Self { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    fn with(self, low: Vec4, high: Vec4) -> Self {
        Self { min: low.min(self.min), max: high.max(self.max) }
    }

    fn union(self, other: Self) -> Self {
        self.with(other.min, other.max)
    }

    /// The box as others know it.
    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// Bounds of some primitives, and twice the bounds of their centroids.
#[derive(Clone, Copy, Debug)]
pub struct Extents {
    /// Of the primitives.
    pub bounds: WideBox,
    centroids: WideBox,
}

impl Extents {
    /// Of no primitives.
    pub const EMPTY: Self = Self { bounds: WideBox::EMPTY, centroids: WideBox::EMPTY };

    /// Of these: every second apart, since a minimum waits for the one before it.
    pub fn of(prims: &[BuildPrim]) -> Self {
        let mut pairs = prims.chunks_exact(2);
        let both = [Self::EMPTY; 2];
        let [a, b] = (&mut pairs).fold(both, |[a, b], pair| [a.with(&pair[0]), b.with(&pair[1])]);
        pairs.remainder().iter().fold(a.union(b), Self::with)
    }

    fn with(self, p: &BuildPrim) -> Self {
        let centroid = p.centroid();
        Self { bounds: self.bounds.with(p.low, p.high), centroids: self.centroids.with(centroid, centroid) }
    }

    /// Of both.
    pub fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), centroids: self.centroids.union(other.centroids) }
    }
}

/// From so many primitives on it pays to bin every second one apart.
const PAIRED: usize = 32;

/// Added to a small number it leaves its integer in the lowest bits, after rounding to the nearest: bins lie
/// around whole numbers, the first and the last of half the width.
const TO_INTEGER: f32 = 12_582_912.0;

/// Maps centroids to bins.
#[derive(Clone, Copy)]
struct Binning<const BINS: usize> {
    origin: Vec4,
    scale: Vec4,
}

impl<const BINS: usize> Binning<BINS> {
    fn new(centroids: &WideBox) -> Self {
        // Along axes on which there is nothing to divide everything falls into the first bin.
        let size = centroids.max - centroids.min;
        let divides = size.cmpgt(Vec4::ZERO) & size.cmplt(Vec4::INFINITY);
        let scale = Vec4::splat((BINS - 1) as f32) / Vec4::select(divides, size, Vec4::INFINITY);
        Self { origin: Vec4::select(divides, centroids.min, Vec4::ZERO), scale }
    }

    /// The bins of a primitive by axis.
    fn bins(&self, prim: &BuildPrim) -> [usize; 3] {
        let [x, y, z, _] = ((prim.centroid() - self.origin) * self.scale + Vec4::splat(TO_INTEGER)).to_array();
        [x, y, z].map(|x| x.to_bits() as usize % BINS)
    }

    /// The bin of a primitive along one axis: what `bins` says there.
    fn bin(&self, prim: &BuildPrim, axis: usize) -> usize {
        let centroid = prim.low[axis] + prim.high[axis];
        ((centroid - self.origin[axis]) * self.scale[axis] + TO_INTEGER).to_bits() as usize % BINS
    }
}

/// Reorders the primitives by the cheapest split and returns the size of the first part; `None` where no bin border
/// divides them, or where half the areas of the parts, in scaled units, come to `most` or more. Few primitives need few
/// bins.
pub fn split(prims: &mut [BuildPrim], extents: &Extents, scale: f32, most: f32) -> Option<usize> {
    const FEW: usize = WIDTH + 1;
    match prims.len() {
        0..=WIDTH => split_into::<4>(prims, extents, scale, most),
        FEW..64 => split_into::<8>(prims, extents, scale, most),
        _ => split_into::<16>(prims, extents, scale, most),
    }
}

fn split_into<const BINS: usize>(prims: &mut [BuildPrim], extents: &Extents, scale: f32, most: f32) -> Option<usize> {
    let binning = Binning::<BINS>::new(&extents.centroids);
    let (axis, border) = Bins::of(prims, binning).cheapest_border(scale, most)?;
    Some(partition(prims, |p| binning.bin(p, axis) < border))
}

/// What lies in the bins of each axis.
struct Bins<const BINS: usize> {
    boxes: [[WideBox; BINS]; 3],
    counts: [[u32; 4]; BINS],
}

impl<const BINS: usize> Bins<BINS> {
    const EMPTY: Self = Self { boxes: [[WideBox::EMPTY; BINS]; 3], counts: [[0; 4]; BINS] };

    #[inline(always)]
    fn of(prims: &[BuildPrim], binning: Binning<BINS>) -> Self {
        let mut bins = Self::EMPTY;
        if prims.len() < PAIRED {
            prims.iter().for_each(|p| bins.add(p, &binning));
            return bins;
        }
        // Neighbours often fall into the same bin, where one would wait for the other: every second goes elsewhere.
        let mut others = Self::EMPTY;
        let mut pairs = prims.chunks_exact(2);
        for pair in &mut pairs {
            bins.add(&pair[0], &binning);
            others.add(&pair[1], &binning);
        }
        pairs.remainder().iter().for_each(|p| bins.add(p, &binning));
        bins.merge(&others);
        bins
    }

    #[inline(always)]
    fn add(&mut self, p: &BuildPrim, binning: &Binning<BINS>) {
        for (axis, i) in binning.bins(p).into_iter().enumerate() {
            self.boxes[axis][i] = self.boxes[axis][i].with(p.low, p.high);
            self.counts[i][axis] += 1;
        }
    }

    fn merge(&mut self, other: &Self) {
        for axis in 0..3 {
            for i in 0..BINS {
                self.boxes[axis][i] = self.boxes[axis][i].union(other.boxes[axis][i]);
                self.counts[i][axis] += other.counts[i][axis];
            }
        }
    }

    /// The boxes of the three axes' bin `i`.
    fn at(&self, i: usize) -> [WideBox; 3] {
        [self.boxes[0][i], self.boxes[1][i], self.boxes[2][i]]
    }

    /// How many are in the three axes' bin `i`.
    fn count(&self, i: usize) -> Vec4 {
        let [x, y, z, _] = self.counts[i];
        Vec4::new(x as f32, y as f32, z as f32, 0.0)
    }

    /// Axis and first bin on the right of the cheapest split; `None` where none is finite, or where the areas of its sides
    /// come to `most` or more. One that leaves a side empty is not finite: there nothing is multiplied with infinity.
    #[inline(always)]
    fn cheapest_border(&self, scale: f32, most: f32) -> Option<(usize, usize)> {
        let mut right = [(Vec4::ZERO, Vec4::ZERO); BINS];
        let (mut boxes, mut count) = ([WideBox::EMPTY; 3], Vec4::ZERO);
        for i in (1..BINS).rev() {
            boxes = unions(boxes, self.at(i));
            count += self.count(i);
            let areas = half_areas(&boxes, scale);
            right[i] = (areas, areas * count);
        }
        let (mut boxes, mut count) = ([WideBox::EMPTY; 3], Vec4::ZERO);
        let (mut least, mut borders, mut both_areas) = (Vec4::INFINITY, Vec4::ZERO, Vec4::ZERO);
        for i in 1..BINS {
            let (right_areas, right_costs) = right[i];
            boxes = unions(boxes, self.at(i - 1));
            count += self.count(i - 1);
            let areas = half_areas(&boxes, scale);
            let costs = areas * count + right_costs;
            let is_less = costs.cmplt(least);
            least = Vec4::select(is_less, costs, least);
            borders = Vec4::select(is_less, Vec4::splat(i as f32), borders);
            both_areas = Vec4::select(is_less, areas + right_areas, both_areas);
        }
        let mut best = (f32::INFINITY, None);
        for axis in 0..3 {
            if least[axis] < best.0 {
                best = (least[axis], Some(axis));
            }
        }
        best.1.filter(|axis| both_areas[*axis] < most).map(|axis| (axis, borders[axis] as usize))
    }
}

fn unions(a: [WideBox; 3], b: [WideBox; 3]) -> [WideBox; 3] {
    std::array::from_fn(|axis| a[axis].union(b[axis]))
}

/// Half the surface areas of three boxes in scaled units; infinite for the empty box.
fn half_areas(boxes: &[WideBox; 3], scale: f32) -> Vec4 {
    let [a, b, c] = boxes.map(|b| (b.max - b.min) * scale);
    let columns = Mat4::from_cols(a, b, c, Vec4::ZERO).transpose();
    let [x, y, z] = [columns.x_axis, columns.y_axis, columns.z_axis];
    x * (y + z) + y * z
}

/// Moves the primitives for which `is_left` holds to the front and returns how many they are. Without a branch that
/// depends on the answers: half of them would be guessed wrong.
fn partition(prims: &mut [BuildPrim], is_left: impl Fn(&BuildPrim) -> bool) -> usize {
    let mut left = 0;
    for i in 0..prims.len() {
        let goes_left = is_left(&prims[i]);
        prims.swap(i, left);
        left += usize::from(goes_left);
    }
    left
}
