//! A furnished living room on a large plane, in four stages that grow out of one another as the thesis's test models
//! do (sections 3.2 and 3.4.1): the room stays as it is, furniture and plants are added in and around it.
//!
//! Each stage is brought to its exact number of triangles by the leaves of its last plants.

mod dining;
mod garden;
mod living;
mod music;
mod shell;
mod winter;

use super::build::{Stage, camera, film};
use crate::Scene;

/// Triangles of the four stages (thesis, table 6).
pub const TRIANGLES: [usize; 4] = [54_841, 104_381, 151_976, 207_583];

/// Radiance of the garden's lanterns in each stage, W/m²/sr. It settles how many of all photons are left for the rooms:
/// the later ones have more dark corners, and need more of them to find as many around a point.
const LANTERNS: [f32; 4] = [68.0, 40.0, 30.0, 28.0];

/// The living room with sofa, armchair, bookshelf and three plants.
pub fn room_1() -> Scene {
    furnished(1)
}

/// With a dining table laid for four, a sideboard, shelves and shrubs outside.
pub fn room_2() -> Scene {
    furnished(2)
}

/// With a piano, a globe, more books and hanging plants.
pub fn room_3() -> Scene {
    furnished(3)
}

/// With a chess table, a second armchair, flowers and many more plants.
pub fn room_4() -> Scene {
    furnished(4)
}

fn furnished(stages: usize) -> Scene {
    let mut stage = Stage::waxed();
    shell::build(&mut stage);
    garden::light(&mut stage, LANTERNS[stages - 1]);
    let add = [living::add, dining::add, music::add, winter::add];
    for (add, target) in add.into_iter().zip(TRIANGLES).take(stages) {
        add(&mut stage, target);
    }
    stage.finish(camera([24.0, 52.0, 88.0], [-4.0, 34.0, -40.0], 56.0), film(800, 600), None)
}
