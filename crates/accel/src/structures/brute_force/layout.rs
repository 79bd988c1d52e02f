//! The memory of the triangles: boxes and vertices, sixteen triangles side by side.

use crate::bounds::SLAB_SLACK;
use photinus_geometry::{Primitives, Vec3};
use photinus_intersect::is_degenerate;

/// Triangles of a block: words in the widest register.
pub const LANES: usize = 16;

/// Blocks that all rays of a batch are taken past before the next: 24 KiB of boxes, half of the nearest cache,
/// and a word of flags.
pub const CHUNK: usize = 64;

/// Lengths beyond this, from the middle, leave no room for sums of products: such triangles and rays pass the sieve.
pub const MOST: f64 = 1e37;

/// Boxes of sixteen triangles, relative to the middle: lower x, upper x, lower y, upper y, lower z, upper z.
///
/// Each box holds its triangle with [`SLAB_SLACK`] of the triangle's distance from the middle to spare; see
/// [`super::sieve`].
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Boxes {
    /// `bounds[2 * axis]` and `bounds[2 * axis + 1]`, by lane.
    pub bounds: [[f32; LANES]; 6],
}

/// Vertices of sixteen triangles.
///
/// Lanes without a triangle and degenerate triangles hold NaN, which no ray hits.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Vertices {
    /// `rows[3 * vertex + axis][lane]`.
    pub rows: [[f32; LANES]; 9],
}

/// All triangles: the one in lane `l` of block `b` has id `16 b + l`.
pub struct Blocks {
    /// What boxes are relative to.
    pub middle: [f64; 3],
    /// Boxes of all blocks.
    pub boxes: Vec<Boxes>,
    /// Vertices of all blocks.
    pub vertices: Vec<Vertices>,
}

impl Blocks {
    /// The triangles of `primitives`.
    pub fn new(primitives: &Primitives) -> Self {
        let count = primitives.triangle_count();
        let middle = middle(primitives);
        let nothing = Boxes { bounds: std::array::from_fn(|row| [[f32::MAX, f32::MIN][row % 2]; LANES]) };
        let mut boxes = vec![nothing; count.div_ceil(LANES)];
        let mut vertices = vec![Vertices { rows: [[f32::NAN; LANES]; 9] }; boxes.len()];
        for id in 0..count {
            let triangle = primitives.triangle(id);
            if is_degenerate(&triangle.map(|v| v.to_array())) {
                continue;
            }
            let (block, lane) = (id / LANES, id % LANES);
            for (row, value) in triangle.iter().flat_map(Vec3::to_array).enumerate() {
                vertices[block].rows[row][lane] = value;
            }
            for (row, value) in padded_box(&triangle, &middle).into_iter().enumerate() {
                boxes[block].bounds[row][lane] = value;
            }
        }
        Self { middle, boxes, vertices }
    }

    /// Bytes of the arrays.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.boxes[..]) + size_of_val(&self.vertices[..])) as u64
    }
}

/// The median of the triangles' first vertices along each axis, which a few triangles far out do not move.
fn middle(primitives: &Primitives) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let first = |i| primitives.triangle(i)[0][axis];
        let mut places: Vec<f32> = (0..primitives.triangle_count()).map(first).filter(|x| x.is_finite()).collect();
        if places.is_empty() {
            return 0.0;
        }
        let half = places.len() / 2;
        f64::from(*places.select_nth_unstable_by(half, f32::total_cmp).1)
    })
}

/// The bounds of a triangle of finite vertices as a lane of [`Boxes`]; everything where it lies beyond [`MOST`].
fn padded_box(triangle: &[Vec3; 3], middle: &[f64; 3]) -> [f32; 6] {
    let mut sides = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let mut away = 0.0;
    for (axis, [low, high]) in sides.iter_mut().enumerate() {
        for vertex in triangle {
            let x = f64::from(vertex[axis]) - middle[axis];
            (*low, *high) = (low.min(x), high.max(x));
        }
        away += low.abs().max(high.abs());
    }
    if away > MOST {
        return [f32::NEG_INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::INFINITY];
    }
    let pad = away * f64::from(SLAB_SLACK) + f64::from(f32::MIN_POSITIVE);
    let [x, y, z] = sides.map(|[low, high]| [(low - pad) as f32, (high + pad) as f32]);
    [x[0], x[1], y[0], y[1], z[0], z[1]]
}
