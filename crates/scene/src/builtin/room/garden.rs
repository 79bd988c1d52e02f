//! Lanterns in the garden all around, so that photons lie on the plane too, as those of the thesis's room did.

use crate::builtin::build::{Finish, Place, Stage, ball, revolve};

/// Where they stand.
const LANTERNS: [[f32; 2]; 6] =
    [[-170.0, 330.0], [190.0, 380.0], [420.0, -60.0], [230.0, -400.0], [-260.0, -420.0], [-460.0, -30.0]];
/// Radius of a globe.
const GLOBE: f32 = 7.0;
/// Its radiance, W/m²/sr.
const RADIANCE: [f32; 3] = [5.0, 4.25, 3.1];

/// Adds the lanterns: a post, a glowing globe and a hat that throws its light down.
pub fn light(stage: &mut Stage) {
    let iron = stage.paint("lantern-iron", 0x2E3230, Finish::Satin(0.3));
    let white = stage.paint("lantern-white", 0xE4E0D6, Finish::Matte);
    let glass = stage.paint("lantern-glass", 0xF2EADC, Finish::Matte);
    for [x, z] in LANTERNS {
        let foot = Place::at(x, 0.0, z);
        let post = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.5], [1.2, 4.0], [1.0, 64.0], [3.0, 66.0], [0.0, 66.0]];
        stage.mesh("lantern-post", iron, revolve(&post, 10).placed(foot));
        stage.lamp("lantern", glass, revolve(&ball(GLOBE, 74.0, 6), 12).placed(foot), RADIANCE);
        let hat = [[20.5, 77.6], [6.0, 86.0], [0.0, 87.0]];
        let under = [[0.0, 84.0], [5.0, 83.5], [20.0, 77.0]];
        let outline: Vec<[f32; 2]> = under.into_iter().chain(hat).collect();
        stage.mesh("lantern-hat", white, revolve(&outline, 16).placed(foot));
    }
}
