//! How a structure is built, and why it could not be.

use photinus_geometry::MAX_PRIMITIVES;
use thiserror::Error;

/// Where a kd-tree may be split (thesis, section 3.1.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SplitCandidates {
    /// Equal steps along each axis: fastest to build, dearest tree.
    Uniform,
    /// The lower and upper bound of every primitive, on each axis: slowest to build, cheapest tree.
    Bounds,
    /// As `Bounds` in nodes of few primitives; in others, evenly picked from the ordered bounds.
    #[default]
    Sampled,
    /// Where pieces of parabolas through a few samples are lowest (Hunt, Mark, Stoll, RT 2006): as `Sampled` in quality,
    /// with fewer candidates.
    Quadratic,
}

impl SplitCandidates {
    /// Every choice with its name on the command line.
    pub const ALL: [(&'static str, Self); 4] = [
        ("uniform", Self::Uniform),
        ("bounds", Self::Bounds),
        ("sampled", Self::Sampled),
        ("quadratic", Self::Quadratic),
    ];
}

/// What of a primitive counts when it is put into the cells of a structure that divides space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clip {
    /// Its bounds: quick to build.
    #[default]
    Box,
    /// Of triangles the part within the cell, cut exactly ("perfect splits": Wald and Havran, "On Building Fast kd-Trees
    /// for Ray Tracing, and on Doing That in O(N log N)", 2006): fewer references.
    Exact,
}

impl Clip {
    /// Every choice with its name on the command line.
    pub const ALL: [(&'static str, Self); 2] = [("box", Self::Box), ("exact", Self::Exact)];
}

/// How a compact grid finds the list of a cell (Lagae and Dutre, "Compact, Fast and Robust Grids for Ray Tracing", 2008).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GridCells {
    /// By an array of offsets, one for each cell.
    #[default]
    Array,
    /// By row displacement: offsets of cells with primitives only, rows pushed into each other's gaps.
    Hashed,
}

impl GridCells {
    /// Every choice with its name on the command line.
    pub const ALL: [(&'static str, Self); 2] = [("array", Self::Array), ("hashed", Self::Hashed)];
}

/// Options of all structures; each reads those that concern it.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildOptions {
    /// Ray-triangle method, by name; any member of [`photinus_intersect::METHODS`].
    pub method: String,
    /// Cost of visiting a node in the surface-area heuristic. Dimensionless; only the ratio to `triangle_cost` matters.
    /// It decides in `kd-tree`, `bsp-tree`, `binned-bvh`, `bkd-tree`, `spatial-split-bvh` and `two-level`, and enters the
    /// cost that the other hierarchies report.
    pub node_cost: f64,
    /// Cost of testing a triangle; used as `node_cost` is.
    pub triangle_cost: f64,
    /// `bsp-tree`: cost of a node whose plane stands across no axis, as a multiple of `node_cost`; 0 to 1000.
    pub oblique_cost: f64,
    /// `bsp-tree`: in nodes of at most so many primitives planes of triangles and of their edges are tried; 0 to 256.
    pub oblique_prims: u32,
    /// `kd-tree`, `octree`, `uniform-grid`, `compact-grid`: what of a triangle is put into cells.
    pub clip: Clip,
    /// `uniform-grid`, `compact-grid`: cells for each primitive; more than 0, at most 1000.
    pub density: f64,
    /// `compact-grid`: how cells find their lists.
    pub grid_cells: GridCells,
    /// Nodes of more primitives are divided, where they can be; 1 to 2^20. None: 6 in `octree`, 16 in `ellipsoid-bvh`,
    /// `sphere-bvh` and `box-bvh`, 4 in `bih`, as costs say in `binned-bvh`, `bkd-tree`, `spatial-split-bvh` and
    /// `two-level`.
    pub leaf_size: Option<u32>,
    /// `octree`: levels below the root at most; 0 to 24.
    pub tree_depth: u32,
    /// `binned-bvh`, `bkd-tree`, `spatial-split-bvh`, `two-level`: bins of an axis; 2 to 64.
    pub bins: u32,
    /// `spatial-split-bvh`: spatial splits are tried where the children of the best object split share more than this
    /// part of the root's surface; 0 to 1 (the paper's alpha).
    pub split_alpha: f64,
    /// Most references for each primitive; 1 to 64. None: 4 in `spatial-split-bvh`, 16 in `ellipsoid-bvh`, `sphere-bvh`
    /// and `box-bvh`.
    pub reference_limit: Option<f64>,
    /// `wide-bvh`: rounds in which subtrees are moved to where rays visit them least; 0 to 100. Three take about as long
    /// as the build without them.
    pub reinsertion_rounds: u32,
    /// `kd-tree`: where nodes may be split.
    pub candidates: SplitCandidates,
    /// `kd-tree`: steps per axis for `uniform`; for `sampled`, the number of primitives above which so many bounds
    /// are picked on each axis (the thesis's x).
    pub candidate_count: u32,
    /// `wide-bvh` and, with `woop`, `brute-force`: the instruction set of the kernel. All give the same bits.
    pub kernel: Kernel,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            method: photinus_intersect::DEFAULT_METHOD.into(),
            node_cost: 0.5,
            triangle_cost: 0.5,
            oblique_cost: 1.0,
            oblique_prims: 8,
            clip: Clip::default(),
            density: 8.0,
            grid_cells: GridCells::default(),
            leaf_size: None,
            tree_depth: 16,
            bins: 16,
            split_alpha: 1e-5,
            reference_limit: None,
            reinsertion_rounds: 3,
            candidates: SplitCandidates::default(),
            candidate_count: 100,
            kernel: Kernel::Auto,
        }
    }
}

impl BuildOptions {
    /// Node cost over triangle cost, rounded to a float, so that equal ratios of different costs are equal.
    ///
    /// # Errors
    /// A cost that is negative or not finite, a triangle cost of zero.
    pub(crate) fn cost_ratio(&self) -> Result<f64, BuildError> {
        let (node, triangle) = (self.node_cost, self.triangle_cost);
        check("the node cost", node, node >= 0.0 && node.is_finite(), "zero or more")?;
        check("the triangle cost", triangle, triangle > 0.0 && triangle.is_finite(), "more than zero")?;
        Ok(f64::from((node / triangle) as f32))
    }
}

/// Refuses an option that is not `good`.
pub(crate) fn check(
    option: &'static str,
    value: impl ToString,
    good: bool,
    expected: &'static str,
) -> Result<(), BuildError> {
    if good { Ok(()) } else { Err(BuildError::BadOption { option, value: value.to_string(), expected }) }
}

/// Instruction set of a kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// The widest that this machine has.
    #[default]
    Auto,
    /// Plain Rust; of `brute-force` the plain way, one primitive after the other.
    Scalar,
    /// AVX2; plain Rust where the machine lacks it.
    Avx2,
    /// AVX-512 (F, VL, DQ, of `brute-force` BW too); the next best where the machine lacks it.
    Avx512,
}

/// Why a structure could not be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildError {
    /// No member of that name.
    #[error("no acceleration structure is called '{name}'; there are {known}")]
    UnknownStructure {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// No ray-triangle method of that name.
    #[error("no ray-triangle method is called '{name}'; there are {known}")]
    UnknownMethod {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// More primitives than ids.
    #[error("{count} primitives, but a structure holds at most {MAX_PRIMITIVES}")]
    TooManyPrimitives {
        /// Triangles and spheres.
        count: usize,
    },
    /// An option out of its range.
    #[error("{option} is {value}, but it must be {expected}")]
    BadOption {
        /// The option.
        option: &'static str,
        /// What it was set to.
        value: String,
        /// What it may be.
        expected: &'static str,
    },
    /// A triangle that names a vertex which does not exist.
    #[error("triangle {triangle} has vertex index {vertex}, but there are {vertices} vertices")]
    VertexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// Its vertex index.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
}
