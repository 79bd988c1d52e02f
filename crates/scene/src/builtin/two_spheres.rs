//! Two spheres in a Cornell box in metres / 10: one of glass, one a mirror, a tall block behind, a lamp above.

use super::build::{Stage, camera, film, quads};
use crate::Scene;

/// Radiance of the large lamp, W/m²/sr.
const LAMP: [f32; 3] = [18.387, 13.9873, 6.75357];

/// The lamp of 1.30 x 1.05 units.
pub fn large_lamp() -> Scene {
    two_spheres([2.13, 3.43], [2.27, 3.32], LAMP)
}

/// The lamp with its sides divided by 10 and its radiance times 100: the same power.
pub fn small_lamp() -> Scene {
    two_spheres([2.715, 2.845], [2.7425, 2.8475], [1838.7, 1398.73, 675.357])
}

fn two_spheres(lamp_x: [f32; 2], lamp_z: [f32; 2], radiance: [f32; 3]) -> Scene {
    let mut stage = Stage::default();
    let white = stage.diffuse("white", [0.725, 0.71, 0.68]);
    let green = stage.diffuse("green", [0.14, 0.45, 0.091]);
    let red = stage.diffuse("red", [0.63, 0.065, 0.05]);
    let black = stage.diffuse("black", [0.0; 3]);
    let glass = stage.glass("glass");
    let mirror = stage.mirror("mirror", [0.95; 3]);

    // The box is the measured one: its left wall leans by 0.6 degrees.
    stage.mesh("floor", white, quads(&[[[5.528, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 5.592], [5.496, 0.0, 5.592]]]));
    stage.mesh(
        "ceiling",
        white,
        quads(&[[[5.56, 5.488, 0.0], [5.56, 5.488, 5.592], [0.0, 5.488, 5.592], [0.0, 5.488, 0.0]]]),
    );
    stage.mesh(
        "back",
        white,
        quads(&[[[5.496, 0.0, 5.592], [0.0, 0.0, 5.592], [0.0, 5.488, 5.592], [5.56, 5.488, 5.592]]]),
    );
    stage.mesh("right", green, quads(&[[[0.0, 0.0, 5.592], [0.0, 0.0, 0.0], [0.0, 5.488, 0.0], [0.0, 5.488, 5.592]]]));
    stage.mesh(
        "left",
        red,
        quads(&[[[5.528, 0.0, 0.0], [5.496, 0.0, 5.592], [5.56, 5.488, 5.592], [5.56, 5.488, 0.0]]]),
    );
    #[allow(clippy::approx_constant)] // A corner of the block, not pi.
    let (a, b, c, d) = ([4.23, 2.47], [2.65, 2.96], [3.14, 4.56], [4.72, 4.06]);
    let at = |p: [f32; 2], y: f32| [p[0], y, p[1]];
    let side = |p, q| [at(p, 0.0), at(p, 3.3), at(q, 3.3), at(q, 0.0)];
    stage.mesh(
        "block",
        white,
        quads(&[[at(a, 3.3), at(b, 3.3), at(c, 3.3), at(d, 3.3)], side(a, d), side(d, c), side(c, b), side(b, a)]),
    );
    let lamp = |x: usize, z: usize| [lamp_x[x], 5.487, lamp_z[z]];
    stage.lamp("lamp", black, quads(&[[lamp(1, 0), lamp(1, 1), lamp(0, 1), lamp(0, 0)]]), radiance);
    stage.sphere("glass-sphere", glass, [1.75, 0.9, 1.9], 0.8999);
    stage.sphere("mirror-sphere", mirror, [4.1, 0.7, 1.35], 0.6999);

    stage.finish(camera([2.78, 2.73, -8.0], [2.78, 2.73, -7.0], 39.307_648), film(512, 512), Some(32))
}
