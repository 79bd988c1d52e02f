//! The facade: scene, names and settings in; image, statistics and queries out.
//!
//! This is the library that other programs use, and the only place that turns names into members of families. Types of
//! the crates below are re-exported where they appear here.

mod built_in;
mod compare;
mod error;
mod info;
pub mod machine;
pub mod names;
mod output;
pub mod render;
mod source;
mod tree;
mod tree_drawing;

pub use built_in::{BuiltInScene, built_in_scenes, write_built_in};
pub use compare::{Comparison, compare};
pub use error::{Error, Result};
pub use info::{BoundsInfo, CameraInfo, LightKinds, SceneInfo};
pub use output::{check_writable, remove_abandoned, write_drawing, write_json};
pub use photinus_accel::{BuildOptions, Clip, GridCells, SplitCandidates};
pub use photinus_geometry as geometry;
pub use photinus_image as image;
pub use photinus_image::tonemap::Tonemap;
pub use photinus_photons as photons;
pub use photinus_profile as profile;
pub use photinus_scene::{LoadOptions, Scene};
pub use source::open;
pub use tree::{Tree, TreeOptions, TreeRays, TreeReport, build_tree};
pub use tree_drawing::{Ink, Line, TreeDrawing, TreeView, draw_kd_tree};

/// The README's examples are compiled as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
