//! Options that the structures share, checked.

use crate::options::{BuildError, BuildOptions, check};

/// Most bins of an axis.
pub(crate) const MAX_BINS: usize = 64;

/// What the surface-area heuristic decides by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rule {
    /// Node cost over triangle cost.
    pub cost_ratio: f64,
    /// Bins of an axis.
    pub bins: usize,
    /// Most primitives in a leaf, where they can be divided.
    pub leaf_size: usize,
}

/// The leaf size of the options, or that of the member.
pub(crate) fn leaf_size(options: &BuildOptions, own: usize) -> Result<usize, BuildError> {
    let Some(size) = options.leaf_size else { return Ok(own) };
    check("the leaf size", size, (1..=1 << 20).contains(&size), "1 to 1048576")?;
    Ok(size as usize)
}

impl Rule {
    /// The rule of the options, for a member whose leaves hold as many as their costs say.
    pub fn new(options: &BuildOptions) -> Result<Self, BuildError> {
        let (cost_ratio, bins) = (options.cost_ratio()?, options.bins as usize);
        check("the number of bins", bins, (2..=MAX_BINS).contains(&bins), "2 to 64")?;
        Ok(Self { cost_ratio, bins, leaf_size: leaf_size(options, usize::MAX)? })
    }
}

/// The part of the root's surface that the children of a node have to share, for a spatial split to be tried.
pub(crate) fn split_alpha(options: &BuildOptions) -> Result<f64, BuildError> {
    let alpha = options.split_alpha;
    check("the alpha of spatial splits", alpha, (0.0..=1.0).contains(&alpha), "0 to 1")?;
    Ok(alpha)
}

/// Most references of a structure over `count` primitives, at so many for each: places fit into words.
pub(crate) fn reference_budget(count: usize, limit: f64) -> usize {
    ((count as f64 * limit) as usize).min(1 << 30).max(count)
}

/// Most references for each primitive: those of the options, or of the member.
pub(crate) fn reference_limit(options: &BuildOptions, own: f64) -> Result<f64, BuildError> {
    let limit = options.reference_limit.unwrap_or(own);
    check("the limit of references", limit, (1.0..=64.0).contains(&limit), "1 to 64")?;
    Ok(limit)
}
