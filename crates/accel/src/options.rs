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
}

impl SplitCandidates {
    /// Every choice with its name on the command line.
    pub const ALL: [(&'static str, Self); 3] =
        [("uniform", Self::Uniform), ("bounds", Self::Bounds), ("sampled", Self::Sampled)];
}

/// Options of all structures; each reads those that concern it.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildOptions {
    /// Ray-triangle method, by name; any member of [`photinus_intersect::METHODS`].
    pub method: String,
    /// `kd-tree`: cost of visiting a node in the surface-area heuristic. Dimensionless; only the ratio to
    /// `triangle_cost` matters.
    pub node_cost: f64,
    /// `kd-tree`: cost of testing a triangle.
    pub triangle_cost: f64,
    /// `kd-tree`: where nodes may be split.
    pub candidates: SplitCandidates,
    /// `kd-tree`: steps per axis for `uniform`; for `sampled`, the number of primitives above which so many bounds
    /// are picked on each axis (the thesis's x).
    pub candidate_count: u32,
    /// `wide-bvh`: the instruction set of its kernel. All give the same bits.
    pub kernel: Kernel,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            method: photinus_intersect::DEFAULT_METHOD.into(),
            node_cost: 0.5,
            triangle_cost: 0.5,
            candidates: SplitCandidates::default(),
            candidate_count: 100,
            kernel: Kernel::Auto,
        }
    }
}

/// Instruction set of the wide tree's kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// The widest that this machine has.
    #[default]
    Auto,
    /// Plain Rust.
    Scalar,
    /// AVX2; `Scalar` where the machine lacks it.
    Avx2,
    /// AVX-512 (F, VL, DQ); the next best where the machine lacks it.
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
    /// Costs of the surface-area heuristic that mean nothing.
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
