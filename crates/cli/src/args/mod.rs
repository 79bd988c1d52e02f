//! The command line as clap sees it. Names of members and their descriptions come from the families' lists.

mod members;
mod render;
mod structure;
mod values;

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use structure::StructureArgs;

pub use render::{Output, RenderArgs};

/// Renders scenes by photon mapping.
#[derive(Debug, Parser)]
#[command(name = "photinus", version, max_term_width = 100, disable_help_subcommand = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene into a PNG or EXR picture
    Render(Box<RenderArgs>),
    /// Describe a scene: triangles, materials, lights, camera, bounds, warnings
    Info(InfoArgs),
    /// List the built-in scenes, or write one as Mitsuba XML and PLY
    Scenes(ScenesArgs),
    /// Build an acceleration structure over a scene and describe it
    Tree(TreeArgs),
    /// Compare a picture with a reference
    Compare(CompareArgs),
}

/// Where a scene comes from.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// Let the scene read files outside the folder of its own file
    #[arg(long)]
    pub allow_outside: bool,
}

/// `photinus info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A scene file or the name of a built-in scene
    pub scene: String,
    #[command(flatten)]
    pub source: SceneArgs,
    /// Print one JSON document
    #[arg(long)]
    pub json: bool,
}

/// `photinus scenes`.
#[derive(Debug, Args)]
pub struct ScenesArgs {
    #[command(subcommand)]
    pub command: Option<ScenesCommand>,
    /// Print one JSON document
    #[arg(long, global = true)]
    pub json: bool,
}

/// What to do with the built-in scenes.
#[derive(Debug, Subcommand)]
pub enum ScenesCommand {
    /// List the built-in scenes (what happens where nothing is said)
    List,
    /// Write a built-in scene as Mitsuba XML with PLY meshes and pictures
    Write {
        /// The scene
        #[arg(value_parser = members::parser(photinus::names::SCENES))]
        name: String,
        /// The folder; it is made where it does not exist
        dir: PathBuf,
    },
}

/// `photinus tree`.
#[derive(Debug, Args)]
pub struct TreeArgs {
    /// A scene file or the name of a built-in scene
    pub scene: String,
    #[command(flatten)]
    pub source: SceneArgs,
    /// The acceleration structure
    #[arg(long, value_name = "NAME", default_value = photinus::names::ACCEL.default,
        value_parser = members::parser(photinus::names::ACCEL))]
    pub accel: String,
    #[command(flatten)]
    pub structure: StructureArgs,
    /// Draw the tree into a picture; kd-trees only
    #[arg(long, value_name = "OUT.{png,svg}", value_parser = values::drawing)]
    pub draw: Option<PathBuf>,
    /// Where the viewer of the drawing looks, in scene coordinates [default: from above, at an angle]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true, requires = "draw")]
    pub view: Option<[f32; 3]>,
    /// The part of the scene that fills the drawing: the lower and the upper corner of a box [default: all]
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = values::corners, allow_hyphen_values = true,
        requires = "draw")]
    pub draw_box: Option<[f32; 6]>,
    /// Print one JSON document
    #[arg(long)]
    pub json: bool,
}

/// `photinus compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// The picture
    pub a: PathBuf,
    /// The reference
    pub b: PathBuf,
    /// Count only the pixels that are white in this picture
    #[arg(long, value_name = "M.png")]
    pub mask: Option<PathBuf>,
    /// Print one JSON document
    #[arg(long)]
    pub json: bool,
}
