//! Every kind of file that is read, as a function of bytes that must return: the fuzz targets, their seeds and words.
//!
//! The fuzzer and an ordinary test (`crates/photinus/tests/fuzz.rs`) share this folder. A body panics where a reader breaks
//! a promise: no panic, no endless work, a sound result or an error.

mod files;
mod images;
mod queries;
mod render;
mod scenes;
mod sound;
mod words;

/// A kind of file.
pub struct Target {
    /// Its name; the fuzz target is called so.
    pub name: &'static str,
    /// Reads one input.
    pub run: fn(&[u8]),
    /// Good inputs, made here.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Words that the format knows.
    pub words: &'static [&'static str],
}

/// All targets.
pub const TARGETS: &[Target] = &[
    Target { name: "mitsuba", run: scenes::mitsuba, seeds: scenes::mitsuba_seeds, words: words::MITSUBA },
    Target { name: "spectrum", run: scenes::spectrum, seeds: scenes::spectrum_seeds, words: words::NUMBERS },
    Target { name: "obj", run: scenes::obj, seeds: scenes::obj_seeds, words: words::OBJ },
    Target { name: "mtl", run: scenes::mtl, seeds: scenes::mtl_seeds, words: words::MTL },
    Target { name: "ply", run: scenes::ply, seeds: scenes::ply_seeds, words: words::PLY },
    Target { name: "stl", run: scenes::stl, seeds: scenes::stl_seeds, words: words::STL },
    Target { name: "serialized", run: scenes::serialized, seeds: scenes::serialized_seeds, words: &[] },
    Target { name: "exr", run: images::exr, seeds: images::exr_seeds, words: words::EXR },
    Target { name: "png", run: images::png, seeds: images::png_seeds, words: words::PNG },
    Target { name: "jpeg", run: images::jpeg, seeds: images::jpeg_seeds, words: &[] },
    Target { name: "hdr", run: images::hdr, seeds: images::hdr_seeds, words: words::HDR },
    Target { name: "bmp", run: images::bmp, seeds: images::bmp_seeds, words: &[] },
    Target { name: "tga", run: images::tga, seeds: images::tga_seeds, words: &[] },
    Target { name: "queries", run: queries::run, seeds: queries::seeds, words: &["PHQUERY1"] },
    Target { name: "render", run: render::run, seeds: render::seeds, words: words::MITSUBA },
];
