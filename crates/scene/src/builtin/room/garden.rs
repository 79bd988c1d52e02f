//! Lanterns in the garden behind and beside the house, so that photons lie on the plane too, as those of the thesis's
//! room did.

use crate::builtin::build::{Finish, Place, Stage, ball, revolve, shares};
use crate::builtin::furniture::plants;

/// Where they stand: out of sight of the terrace door and the window, through which so strong lights would make a few
/// bright spots inside that take long to find.
const LANTERNS: [[f32; 2]; 6] =
    [[310.0, 40.0], [640.0, -30.0], [470.0, -210.0], [250.0, -330.0], [30.0, -390.0], [390.0, -520.0]];
/// Radius of a globe.
const GLOBE: f32 = 7.0;
/// The colour of its light, over its largest channel.
const COLOR: [f32; 3] = [1.0, 0.85, 0.62];

/// Adds the lanterns: a post, a globe that glows with this radiance and a hat that throws its light down.
pub fn light(stage: &mut Stage, radiance: f32) {
    let iron = stage.paint("lantern-iron", 0x2E3230, Finish::Satin(0.3));
    let grey = stage.paint("lantern-grey", 0xA8A298, Finish::Matte);
    let glass = stage.paint("lantern-glass", 0xF2EADC, Finish::Matte);
    for [x, z] in LANTERNS {
        let foot = Place::at(x, 0.0, z);
        let post = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.5], [1.2, 4.0], [1.0, 64.0], [3.0, 66.0], [0.0, 66.0]];
        stage.mesh("lantern-post", iron, revolve(&post, 10).placed(foot));
        stage.lamp("lantern", glass, revolve(&ball(GLOBE, 74.0, 6), 12).placed(foot), COLOR.map(|c| c * radiance));
        let hat = [[20.5, 77.6], [6.0, 86.0], [0.0, 87.0]];
        let under = [[0.0, 84.0], [5.0, 83.5], [20.0, 77.0]];
        let outline: Vec<[f32; 2]> = under.into_iter().chain(hat).collect();
        stage.mesh("lantern-hat", grey, revolve(&outline, 16).placed(foot));
    }
}

/// Adds low shrubs beside the two lanterns that stand nearest, of so many triangles in all.
pub fn shrubs(stage: &mut Stage, triangles: usize) {
    for (k, ([x, z], triangles)) in [LANTERNS[0], LANTERNS[4]].into_iter().zip(shares(triangles, 2)).enumerate() {
        plants::shrub(stage, Place::at(x + 24.0, 0.0, z - 9.0), [26.0, 28.0], 0x5F7F46, triangles, 20 + k as u32);
    }
}
