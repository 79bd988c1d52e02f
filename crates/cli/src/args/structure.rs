//! Options of acceleration structures, the same in every command that builds one.

use super::{members::parser, values};
use clap::{Args, value_parser};
use photinus::{BuildOptions, Result, names};

/// How structures are built; each reads what concerns it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Acceleration structure")]
pub struct StructureArgs {
    /// Cost of visiting a node in the surface-area heuristic, relative to --triangle-cost
    #[arg(long, value_name = "X", default_value_t = 0.5, value_parser = values::positive)]
    pub node_cost: f64,
    /// Cost of testing a triangle in the surface-area heuristic
    #[arg(long, value_name = "X", default_value_t = 0.5, value_parser = values::positive)]
    pub triangle_cost: f64,
    /// kd-tree: where it may be split
    #[arg(long, value_name = "NAME", default_value = names::CANDIDATES.default,
        value_parser = parser(names::CANDIDATES))]
    pub candidates: String,
    /// kd-tree: split candidates of an axis, and the number of primitives above which so many are picked
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = value_parser!(u32).range(1..=100_000))]
    pub candidate_count: u32,
    /// kd-tree, octree, uniform-grid, compact-grid: what of a triangle is put into cells
    #[arg(long, value_name = "NAME", default_value = names::CLIP.default, value_parser = parser(names::CLIP))]
    pub clip: String,
    /// bsp-tree: cost of a node with an oblique plane, as a multiple of --node-cost
    #[arg(long, value_name = "X", default_value_t = BuildOptions::default().oblique_cost, value_parser = values::positive)]
    pub oblique_cost: f64,
    /// bsp-tree: oblique planes are tried in nodes of at most N primitives
    #[arg(long, value_name = "N", default_value_t = BuildOptions::default().oblique_prims,
        value_parser = value_parser!(u32).range(0..=256))]
    pub oblique_prims: u32,
    /// octree and hierarchies: nodes of more primitives are divided [default: as suits the structure]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1 << 20))]
    pub leaf_size: Option<u32>,
    /// octree: levels below the root at most
    #[arg(long, value_name = "N", default_value_t = BuildOptions::default().tree_depth,
        value_parser = value_parser!(u32).range(0..=24))]
    pub tree_depth: u32,
    /// binned-bvh, spatial-split-bvh, bkd-tree, two-level: bins of an axis
    #[arg(long, value_name = "N", default_value_t = BuildOptions::default().bins,
        value_parser = value_parser!(u32).range(2..=64))]
    pub bins: u32,
    /// spatial-split-bvh: part of the root's surface that children may share before space is split, 0 to 1
    #[arg(long, value_name = "X", default_value_t = BuildOptions::default().split_alpha, value_parser = values::part)]
    pub split_alpha: f64,
    /// spatial-split-bvh, ellipsoid-bvh, sphere-bvh, box-bvh: most references for each primitive, 1 to 64 [default: as
    /// suits the structure]
    #[arg(long, value_name = "X", value_parser = values::positive)]
    pub reference_limit: Option<f64>,
    /// wide-bvh: rounds in which subtrees are moved to where rays visit them least
    #[arg(long, value_name = "N", default_value_t = BuildOptions::default().reinsertion_rounds,
        value_parser = value_parser!(u32).range(0..=100))]
    pub reinsertion_rounds: u32,
    /// uniform-grid, compact-grid: cells for each primitive, at most 1000
    #[arg(long, value_name = "X", default_value_t = BuildOptions::default().density, value_parser = values::positive)]
    pub density: f64,
    /// compact-grid: how cells find their lists
    #[arg(long, value_name = "NAME", default_value = names::GRID_CELLS.default,
        value_parser = parser(names::GRID_CELLS))]
    pub grid_cells: String,
}

impl StructureArgs {
    /// The same for the library.
    pub fn options(&self) -> Result<BuildOptions> {
        Ok(BuildOptions {
            node_cost: self.node_cost,
            triangle_cost: self.triangle_cost,
            candidates: names::candidates(&self.candidates)?,
            candidate_count: self.candidate_count,
            clip: names::clip(&self.clip)?,
            oblique_cost: self.oblique_cost,
            oblique_prims: self.oblique_prims,
            leaf_size: self.leaf_size,
            tree_depth: self.tree_depth,
            bins: self.bins,
            split_alpha: self.split_alpha,
            reference_limit: self.reference_limit,
            reinsertion_rounds: self.reinsertion_rounds,
            density: self.density,
            grid_cells: names::grid_cells(&self.grid_cells)?,
            ..BuildOptions::default()
        })
    }
}
