//! Built-in scenes: made by code when they are asked for, with no file and the same bits on every machine.

mod build;
mod cornell;
mod furnace;
mod furniture;
mod list;
mod room;
mod spectra;
mod spheres;
mod study;
mod texture;
mod two_spheres;
mod water_lily;

use crate::Scene;
pub use list::list;

/// A built-in scene: what it is called, what it shows, and how many triangles it has.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Name on the command line.
    pub name: &'static str,
    /// One sentence for people who choose a scene.
    pub description: &'static str,
    /// Triangles of all meshes; exact spheres have none.
    pub triangles: usize,
    pub(crate) make: fn() -> Scene,
}

impl Builtin {
    /// Makes the scene.
    pub fn build(&self) -> Scene {
        Scene { name: self.name.to_owned(), ..(self.make)() }
    }
}

/// The scene that is rendered when none is named.
pub const DEFAULT: &str = "two-spheres";

/// The entry of that name; underscores count as hyphens.
pub fn find(name: &str) -> Option<&'static Builtin> {
    let name = name.replace('_', "-");
    list().iter().find(|b| b.name == name)
}

/// Makes the built-in scene of that name; none where [`list`] has no such name.
///
/// Equal names give equal scenes, bit for bit, on every machine.
pub fn build(name: &str) -> Option<Scene> {
    find(name).map(Builtin::build)
}

#[cfg(test)]
mod tests;
