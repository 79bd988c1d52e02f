//! The Mitsuba importer and exporter: every plug-in, every value, every way to be wrong, and the real scenes.

mod bsdfs;
mod cameras;
mod common;
mod emitters;
mod meshes;
mod nasty;
mod plugins;
mod roundtrip;
mod scenes;
mod shapes;
mod textures;
mod values;
