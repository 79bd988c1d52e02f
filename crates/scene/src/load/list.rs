//! The scene formats that can be read, and those that are known by name only.

use super::{Context, Draft, LoadError, mitsuba, obj, ply, stl};
use std::path::Path;

/// One importer.
pub struct Format {
    /// Name for people and messages.
    pub name: &'static str,
    /// File name endings, lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Whether the first bytes of a file look like this format, where the extension says nothing.
    pub sniff: fn(&[u8]) -> bool,
    /// Reads the file.
    pub load: fn(&Path, &mut Context<'_>) -> Result<Draft, LoadError>,
}

/// All importers, in the order in which content is tried.
pub const FORMATS: &[Format] = &[
    Format { name: "Mitsuba XML", extensions: &["xml"], sniff: mitsuba::looks_like, load: mitsuba::load },
    Format { name: "PLY", extensions: &["ply", "ply.gz"], sniff: ply::looks_like, load: ply::load },
    Format { name: "Wavefront OBJ", extensions: &["obj"], sniff: obj::looks_like, load: obj::load },
    Format { name: "STL", extensions: &["stl"], sniff: stl::looks_like, load: stl::load },
];

/// Formats that are refused by name, by extension.
pub const KNOWN_UNSUPPORTED: &[(&str, &str)] = &[
    ("pbrt", "the pbrt format"),
    ("gltf", "glTF"),
    ("glb", "binary glTF"),
    ("off", "OFF"),
    ("usd", "USD"),
    ("usda", "USD"),
    ("usdc", "USD"),
    ("usdz", "USD"),
    ("fbx", "FBX"),
    ("blend", "a Blender file"),
    ("dae", "COLLADA"),
    ("abc", "Alembic"),
    ("3ds", "3D Studio"),
    ("json", "Tungsten JSON"),
    ("serialized", "a Mitsuba serialized mesh by itself"),
    ("mtl", "a material library by itself"),
];

/// Names of all formats that can be read, for messages and help.
pub fn supported() -> String {
    let names: Vec<String> = FORMATS
        .iter()
        .map(|f| {
            format!("{} ({})", f.name, f.extensions.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(", "))
        })
        .collect();
    names.join(", ")
}
