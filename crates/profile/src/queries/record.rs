//! What is recorded, as plain data.

/// Parent of a query that no ray led to: a photon's or a camera's first ray.
pub const NO_PARENT: u32 = u32::MAX;

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// A photon's.
    Photon,
    /// From the camera.
    Camera,
    /// Of an eye path after a bounce.
    Specular,
    /// Asks whether a light is visible.
    Shadow,
    /// From a diffuse surface, looks for lights.
    Gather,
    /// Looks how much of an estimate's disc is surface.
    Support,
}

impl RayKind {
    /// Every one, in the order of their numbers in a file.
    pub const ALL: [Self; 6] = [Self::Photon, Self::Camera, Self::Specular, Self::Shadow, Self::Gather, Self::Support];
}

/// Where a ray met a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Ray parameter.
    pub t: f32,
    /// Weight of a triangle's second vertex; 0 for spheres.
    pub alpha: f32,
    /// Weight of a triangle's third vertex; 0 for spheres.
    pub beta: f32,
    /// Primitive id: triangles in the order of the scene, then spheres.
    pub prim: u32,
}

/// What a ray was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayAnswer {
    /// The nearest hit, if there is one.
    Closest(Option<RayHit>),
    /// Whether anything is in the way.
    Any(bool),
}

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayRecord {
    /// What for.
    pub kind: RayKind,
    /// Place in this block's rays of the ray at whose end this one starts, or [`NO_PARENT`]. For a ray that goes on
    /// behind a hole that is the ray that came to the hole.
    pub parent: u32,
    /// Origin, scene units.
    pub origin: [f32; 3],
    /// Direction, not normalised.
    pub dir: [f32; 3],
    /// Least and greatest parameter of a hit.
    pub interval: [f32; 2],
    /// What it was told.
    pub answer: RayAnswer,
}

/// Which photon map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MapKind {
    /// All photons, or those that bounced off a diffuse surface.
    Global,
    /// Photons by mirrors and glass only.
    Caustic,
}

/// Weight of a photon by its distance, as in a search that sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchKernel {
    /// 1.
    Constant,
    /// 1 - (d/r)^2.
    Epanechnikov,
}

/// What a search was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SearchAnswer {
    /// Photons within the radius whose normal and depth fit, summed: kernel weight times flux, W.
    Sum([f32; 3]),
    /// The same photons, handed out one by one.
    Visited,
    /// The `k` nearest of what a sum would count (all at the distance of the last); squared distance of the farthest (0 without
    /// any).
    Nearest {
        /// Most photons asked for.
        k: u32,
        /// Squared distance of the last of them.
        farthest_sq: f32,
    },
}

/// A photon search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchRecord {
    /// Which map.
    pub map: MapKind,
    /// The map's kernel.
    pub kernel: SearchKernel,
    /// Place in this block's rays of the ray at whose end it was made.
    pub parent: u32,
    /// Middle, scene units.
    pub position: [f32; 3],
    /// Radius, scene units.
    pub radius: f32,
    /// Surface normal.
    pub normal: [f32; 3],
    /// Only photons of at most this depth; from 127 on, all.
    pub max_depth: u32,
    /// Photons found.
    pub found: u32,
    /// The rest of the answer.
    pub answer: SearchAnswer,
}

/// What a block of queries belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Rays of a batch of photons.
    PhotonPass,
    /// The photons of a map.
    Map,
    /// Rays and searches of a tile of the picture.
    EyePass,
}

impl Stage {
    /// Every one, in the order of their numbers in a file.
    pub const ALL: [Self; 3] = [Self::PhotonPass, Self::Map, Self::EyePass];
}

/// Names a block; blocks are read in this order, whatever order they lie in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlockKey {
    /// Pass, from 0.
    pub pass: u32,
    /// Part of the pass.
    pub stage: Stage,
    /// Batch of photons, number of the [`MapKind`], or tile. Batches of further photon passes of the same pass count
    /// from 2^31.
    pub index: u32,
}

/// Queries of one batch in the order in which they were asked, or the photons of a map. Paths never leave a batch, so
/// that parents are always in the same block.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its name.
    pub key: BlockKey,
    /// Rays.
    pub rays: Vec<RayRecord>,
    /// Searches.
    pub searches: Vec<SearchRecord>,
    /// Photons as their six words: position (three floats), flux, direction, surface.
    pub photons: Vec<[u32; 6]>,
}

impl Block {
    /// An empty block.
    pub fn new(key: BlockKey) -> Self {
        Self { key, rays: Vec::new(), searches: Vec::new(), photons: Vec::new() }
    }
}

/// Takes recorded blocks, from many threads.
pub trait QuerySink: Send + Sync {
    /// Takes a block.
    fn record(&self, block: &Block);
}
