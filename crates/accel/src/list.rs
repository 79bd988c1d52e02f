//! The list of acceleration structures: command line, help, documentation and tests are made from it.

use crate::laboratory::{Laboratory, Leaves};
use crate::options::{BuildError, BuildOptions};
use crate::structure::Structure;
use crate::structures::{
    bih, binned_bvh, bkd_tree, box_bvh, brute_force, bsp_tree, compact_grid, ellipsoid_bvh, kd_tree, octree,
    spatial_split_bvh, sphere_bvh, two_level, uniform_grid, wide_bvh,
};
use photinus_geometry::{MAX_PRIMITIVES, Primitives};
use photinus_intersect::{LeafTester, METHODS, MethodInfo, find_method};
use std::sync::Arc;

type Build = fn(Arc<Primitives>, &BuildOptions) -> Result<Box<dyn Structure>, BuildError>;

/// A member of the family.
pub struct StructureInfo {
    /// The name on the command line.
    pub name: &'static str,
    /// One line for the help.
    pub summary: &'static str,
    /// Where it was published.
    pub source: &'static str,
    build: Build,
}

/// Every acceleration structure.
pub const STRUCTURES: &[StructureInfo] = &[
    StructureInfo {
        name: wide_bvh::NAME,
        summary: wide_bvh::SUMMARY,
        source: wide_bvh::SOURCE,
        build: wide_bvh::build,
    },
    StructureInfo { name: kd_tree::NAME, summary: kd_tree::SUMMARY, source: kd_tree::SOURCE, build: kd_tree::build },
    StructureInfo {
        name: bsp_tree::NAME,
        summary: bsp_tree::SUMMARY,
        source: bsp_tree::SOURCE,
        build: bsp_tree::build,
    },
    StructureInfo { name: octree::NAME, summary: octree::SUMMARY, source: octree::SOURCE, build: octree::build },
    StructureInfo {
        name: uniform_grid::NAME,
        summary: uniform_grid::SUMMARY,
        source: uniform_grid::SOURCE,
        build: uniform_grid::build,
    },
    StructureInfo {
        name: compact_grid::NAME,
        summary: compact_grid::SUMMARY,
        source: compact_grid::SOURCE,
        build: compact_grid::build,
    },
    StructureInfo {
        name: binned_bvh::NAME,
        summary: binned_bvh::SUMMARY,
        source: binned_bvh::SOURCE,
        build: binned_bvh::build,
    },
    StructureInfo {
        name: spatial_split_bvh::NAME,
        summary: spatial_split_bvh::SUMMARY,
        source: spatial_split_bvh::SOURCE,
        build: spatial_split_bvh::build,
    },
    StructureInfo {
        name: bkd_tree::NAME,
        summary: bkd_tree::SUMMARY,
        source: bkd_tree::SOURCE,
        build: bkd_tree::build,
    },
    StructureInfo { name: bih::NAME, summary: bih::SUMMARY, source: bih::SOURCE, build: bih::build },
    StructureInfo {
        name: ellipsoid_bvh::NAME,
        summary: ellipsoid_bvh::SUMMARY,
        source: ellipsoid_bvh::SOURCE,
        build: ellipsoid_bvh::build,
    },
    StructureInfo {
        name: sphere_bvh::NAME,
        summary: sphere_bvh::SUMMARY,
        source: sphere_bvh::SOURCE,
        build: sphere_bvh::build,
    },
    StructureInfo { name: box_bvh::NAME, summary: box_bvh::SUMMARY, source: box_bvh::SOURCE, build: box_bvh::build },
    StructureInfo {
        name: two_level::NAME,
        summary: two_level::SUMMARY,
        source: two_level::SOURCE,
        build: two_level::build,
    },
    StructureInfo {
        name: brute_force::NAME,
        summary: brute_force::SUMMARY,
        source: brute_force::SOURCE,
        build: brute_force::build,
    },
];

/// The structure used where none is named.
pub const DEFAULT_STRUCTURE: &str = wide_bvh::NAME;

/// The member called `name`, underscores standing for hyphens.
pub fn find_structure(name: &str) -> Option<&'static StructureInfo> {
    let name = name.replace('_', "-");
    STRUCTURES.iter().find(|s| s.name == name)
}

/// Builds the structure called `name` over `primitives`.
///
/// # Errors
/// An unknown name, an option out of its range, too many primitives, or a vertex index out of range. Primitives that
/// no ray can hit (not finite, no area, no radius) are left out without an error.
pub fn build(
    name: &str,
    primitives: Arc<Primitives>,
    options: &BuildOptions,
) -> Result<Box<dyn Structure>, BuildError> {
    let info = find_structure(name).ok_or_else(|| BuildError::UnknownStructure {
        name: name.into(),
        known: STRUCTURES.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
    })?;
    if primitives.len() > MAX_PRIMITIVES {
        return Err(BuildError::TooManyPrimitives { count: primitives.len() });
    }
    let vertices = primitives.positions.len();
    for (triangle, indices) in primitives.triangles.iter().enumerate() {
        if let Some(&vertex) = indices.iter().find(|v| **v as usize >= vertices) {
            return Err(BuildError::VertexOutOfRange { triangle, vertex, vertices });
        }
    }
    (info.build)(primitives, options)
}

/// The method that `options` name.
pub(crate) fn method(options: &BuildOptions) -> Result<&'static MethodInfo, BuildError> {
    find_method(&options.method).ok_or_else(|| BuildError::UnknownMethod {
        name: options.method.clone(),
        known: METHODS.iter().map(|m| m.name).collect::<Vec<_>>().join(", "),
    })
}

/// The leaf tester of the method that `options` name.
pub(crate) fn leaf_tester(primitives: &Primitives, options: &BuildOptions) -> Result<Box<dyn LeafTester>, BuildError> {
    Ok((method(options)?.leaf_tester)(primitives))
}

/// A member of the laboratory with the tests of the method that `options` name.
pub(crate) fn laboratory<L: Leaves>(
    leaves: L,
    primitives: &Primitives,
    options: &BuildOptions,
) -> Result<Box<dyn Structure>, BuildError> {
    let retest = method(options)?.leaf_tester;
    Ok(Box::new(Laboratory { leaves, tester: retest(primitives), retest }))
}
