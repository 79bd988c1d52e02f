//! What belongs to walls and floors: windows, curtains, pictures, mirrors, rugs.

use crate::builtin::build::{
    Dice, Ends, Finish, Join, LeafShape, Part, Place, Stage, bevelled, blade, frame, patch, revolve, shares,
    sin_cos_degrees, tube,
};
use crate::{Bitmap, MaterialId};
use photinus_geometry::Vec3;
use std::sync::Arc;

/// A moulding for frames: (outward, forward) points, as wide as `width`.
fn moulding(width: f32) -> Vec<[f32; 2]> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 0.35], [0.8, 0.62], [0.55, 0.55], [0.3, 0.72], [0.12, 0.5], [0.0, 0.42]]
        .map(|p| p.map(|x| x * width))
        .to_vec()
}

/// A flat panel in the xy plane around the origin that faces +z, its texture coordinates running over the unit square.
fn panel(width: f32, height: f32) -> Part {
    let (x, y) = (0.5 * width, 0.5 * height);
    let mut part = Part::default();
    let corners = [Vec3::new(-x, -y, 0.0), Vec3::new(x, -y, 0.0), Vec3::new(x, y, 0.0), Vec3::new(-x, y, 0.0)];
    part.quad(corners, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    part
}

/// A picture in a frame on a wall; the place is the picture's middle on the wall, facing +z.
pub fn painting(
    stage: &mut Stage,
    place: Place,
    size: [f32; 2],
    wood: MaterialId,
    name: &str,
    picture: impl FnOnce() -> Arc<Bitmap> + Send + 'static,
) {
    let canvas = stage.printed(name, [1.0, 1.0], Finish::Matte, picture);
    stage.mesh(name, canvas, panel(size[0], size[1]).placed(place.shift(0.0, 0.0, 0.5)));
    stage.mesh("picture-frame", wood, frame(size[0], size[1], &moulding(2.0)).placed(place.shift(0.0, 0.0, 0.05)));
}

/// A mirror in a frame on a wall; the place is its middle on the wall, facing +z.
pub fn mirror(stage: &mut Stage, place: Place, size: [f32; 2], wood: MaterialId) {
    let silver = stage.looking_glass();
    stage.mesh("mirror", silver, panel(size[0], size[1]).placed(place.shift(0.0, 0.0, 0.6)));
    stage.mesh("mirror-frame", wood, frame(size[0], size[1], &moulding(2.6)).placed(place.shift(0.0, 0.0, 0.05)));
}

/// The woodwork of a window of this size in a wall of this thickness: casing, sill and glazing bars, without panes.
///
/// The place is the middle of the opening on the wall's inner face, facing into the room.
pub fn window(stage: &mut Stage, place: Place, size: [f32; 2], thickness: f32) {
    let white = stage.paint("window-white", 0xE8E4DA, Finish::Satin(0.25));
    let [w, h] = size;
    let casing =
        [[-0.9, -thickness], [0.0, -thickness], [0.0, 0.02], [2.6, 0.02], [2.6, 0.8], [-0.3, 0.9], [-0.9, 0.5]];
    let mut part = frame(w, h, &casing);
    part.add(bevelled([-0.5 * w - 4.0, -0.5 * h - 1.9, 0.9], [0.5 * w + 4.0, -0.5 * h - 0.6, 5.0], 0.3));
    let z = -0.6 * thickness;
    for k in 1..3 {
        let x = w * (k as f32 / 3.0 - 0.5);
        part.add(bevelled([x - 0.6, -0.5 * h + 0.9, z - 0.6], [x + 0.6, 0.5 * h - 0.9, z + 0.6], 0.2));
    }
    let y = 0.16 * h;
    part.add(bevelled([-0.5 * w + 0.9, y - 0.6, z - 0.55], [0.5 * w - 0.9, y + 0.6, z + 0.55], 0.2));
    stage.mesh("window", white, part.placed(place));
}

/// A pair of drawn curtains on a rod over an opening of this width, `length` long; the place is the middle of the rod.
pub fn curtains(stage: &mut Stage, place: Place, width: f32, length: f32, cloth: MaterialId) {
    let brass = stage.brass();
    let reach = 0.5 * width + 13.0;
    let rod = tube(&[Vec3::new(-reach, 0.0, 0.0), Vec3::ZERO, Vec3::new(reach, 0.0, 0.0)], 10, Ends::Flat, |_| 0.5);
    let knob = [[0.0, -1.4], [0.9, -1.0], [1.3, 0.0], [0.9, 1.0], [0.0, 1.4]];
    let mut metal = rod;
    for side in [-1.0, 1.0] {
        metal.add(revolve(&knob, 14).placed(Place::at(side * reach, 0.0, 0.0).roll(90.0)));
    }
    let ring: Vec<Vec3> = (0..8)
        .map(|i| {
            let (s, c) = sin_cos_degrees(45.0 * i as f32);
            Vec3::new(0.0, 0.9 * c - 0.3, 0.9 * s)
        })
        .collect();
    for side in [-1.0, 1.0] {
        for k in 0..7 {
            let x = side * (0.5 * width - 6.0 + 2.9 * k as f32);
            metal.add(tube(&ring, 3, Ends::Ring, |_| 0.15).placed(Place::at(x, 0.0, 0.0)));
        }
    }
    stage.mesh("curtain-rod", brass, metal.placed(place));
    for side in [-1.0f32, 1.0] {
        let drape = patch(72, 12, Join::Open, |u, v| {
            // Folds are even above and wander below; the cloth is gathered a little at half height.
            let down = 1.0 - v;
            let phase = 360.0 * 6.0 * u + 35.0 * down * sin_cos_degrees(360.0 * u + 70.0).0;
            let gather = 1.0 - 0.10 * sin_cos_degrees(180.0 * down).0;
            let depth = 0.85 + 0.35 * down;
            let x = (u - 0.5) * 19.0 * gather - 0.25 * sin_cos_degrees(2.0 * phase).0;
            Vec3::new(x, -1.4 - (length - 1.4) * down, depth * sin_cos_degrees(phase).0)
        });
        let at = place.shift(side * (0.5 * width + 2.7), 0.0, 0.0);
        stage.mesh("curtain", cloth, drape.uv_scaled(40.0, length).placed(at));
    }
}

/// A rug on the floor with a tasselled fringe at its ends: `tassels` triangles of fringe in all.
pub fn rug(
    stage: &mut Stage,
    place: Place,
    size: [f32; 2],
    name: &str,
    picture: impl FnOnce() -> Arc<Bitmap> + Send + 'static,
    tassels: usize,
) {
    let wool = stage.printed(name, [1.0, 1.0], Finish::Matte, picture);
    let [w, d] = size;
    let top = patch(20, 14, Join::Open, |u, v| {
        let edge = (u.min(1.0 - u) * w).min(v.min(1.0 - v) * d);
        let lift = 0.12 * sin_cos_degrees(900.0 * u).0 * sin_cos_degrees(700.0 * v + 40.0).0;
        Vec3::new((u - 0.5) * w, 0.12 + (0.45 + lift) * (edge / 2.0).min(1.0), (0.5 - v) * d)
    });
    stage.mesh(name, wool, top.placed(place));
    let yarn = stage.paint("fringe", 0xD8CBB0, Finish::Matte);
    let mut fringe = Part::default();
    let count = 2 * (d / 1.1) as usize;
    for (k, triangles) in shares(tassels, count).enumerate() {
        let mut dice = Dice::new(95, k as u32);
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let z = d * ((k / 2) as f32 + 0.5) / (count / 2) as f32 - 0.5 * d;
        let shape = LeafShape {
            length: dice.between(2.4, 3.1),
            width: 0.5,
            widest: 0.5,
            droop: -dice.between(0.0, 10.0),
            fold: 0.0,
        };
        let at = place.shift(side * 0.5 * w, 0.16, z).yaw(side * 90.0 + dice.between(-14.0, 14.0));
        fringe.add(blade(shape, triangles).placed(at));
    }
    stage.mesh("fringe", yarn, fringe);
}
