//! Coloured spheres at the bottom of a large, pale sphere: no triangle at all, and light everywhere, so that a few
//! thousand photons make a calm picture.

use super::build::{Stage, camera, film, linear, sin_cos_degrees};
use crate::Scene;

/// Radius of the sphere that holds everything.
const ROOM: f32 = 30.0;

/// Seven spheres of the rainbow around a white one, under a lamp that is a sphere too.
pub fn spheres() -> Scene {
    let mut stage = Stage::default();
    let room = stage.diffuse("room", linear(0xE6E4DF));
    stage.hollow_sphere("room", room, [0.0; 3], ROOM);
    let lamp = stage.diffuse("lamp", [0.0; 3]);
    stage.sphere("lamp", lamp, [-7.0, 17.0, 9.0], 3.2);
    stage.light_last([20.0, 18.7, 16.6]);

    // A sphere that touches the room from inside has its middle at this distance from the room's.
    let resting = |degrees: f32, tilt: f32, radius: f32| {
        let reach = ROOM - radius;
        let ((sin, cos), (out, down)) = (sin_cos_degrees(degrees), sin_cos_degrees(tilt));
        [reach * out * cos, -reach * down, -reach * out * sin]
    };
    let white = stage.diffuse("white", linear(0xF2EEE6));
    stage.sphere("white", white, resting(0.0, 0.0, 3.1), 3.1);
    let colors = [
        ("red", 0xC8392B),
        ("orange", 0xE08A2C),
        ("yellow", 0xE6C93F),
        ("green", 0x4E9A4B),
        ("teal", 0x2F8F8C),
        ("blue", 0x3A62B0),
        ("violet", 0x7D4A9A),
    ];
    for (k, (name, color)) in colors.into_iter().enumerate() {
        let k = k as f32;
        let radius = 2.35 - 0.35 * (k % 2.0);
        let material = stage.diffuse(name, linear(color));
        stage.sphere(name, material, resting(90.0 + 360.0 / 7.0 * k, 12.0 + 1.6 * (k % 2.0), radius), radius);
    }
    stage.finish(camera([0.0, -13.5, 21.0], [0.0, -27.2, 0.0], 42.0), film(512, 512), None)
}
