//! Things to sit on.

use crate::MaterialId;
use crate::builtin::build::{Ends, Part, Place, Stage, bevelled, curve, cushion, revolve, soft_box, standing, tube};

/// An upholstered seat with arms: one seat is an armchair, three are a sofa. 16 + 24 `seats` wide, 37 deep.
pub fn sofa(stage: &mut Stage, place: Place, seats: usize, cloth: MaterialId) {
    let width = 16.0 + 24.0 * seats as f32;
    let wood = stage.walnut();
    let mut legs = Part::default();
    for (x, z) in corners(width - 8.0, 30.0) {
        let turned = revolve(&[[0.0, 0.0], [0.8, 0.0], [0.95, 0.5], [1.5, 4.6], [1.5, 5.0], [0.0, 5.0]], 10);
        legs.add(turned.placed(Place::at(x, 0.0, z)));
    }
    stage.mesh("sofa-legs", wood, legs.placed(place));

    let inner = 24.0 * seats as f32;
    let mut body = standing([width - 2.0, 5.5, 34.0], 0.8).placed(Place::at(0.0, 4.6, 0.0));
    for side in [-1.0, 1.0] {
        let arm = soft_box([4.0, 8.6, 17.8], 7.0, [4, 6, 9]);
        body.add(arm.placed(Place::at(side * (0.5 * width - 4.0), 14.6, 0.4)));
    }
    let back = soft_box([0.5 * inner + 1.0, 12.5, 3.6], 8.0, [6 + 3 * seats, 6, 3]);
    body.add(back.placed(Place::at(0.0, 20.5, -14.6).pitch(-6.0)));
    for k in 0..seats {
        let x = 24.0 * (k as f32 - 0.5 * (seats as f32 - 1.0));
        let seat = soft_box([11.9, 3.6, 14.6], 6.0, [8, 3, 9]).bent(|p| {
            let (u, w) = (p.x / 11.9, p.z / 14.6);
            // Filled in the middle, sunk where people sit.
            p + photinus_geometry::Vec3::Y * (0.7 * (1.0 - u * u) * (1.0 - w * w) * p.y.signum())
        });
        body.add(seat.placed(Place::at(x, 12.8, 3.2)));
        let pillow = soft_box([11.6, 9.4, 3.6], 4.5, [8, 7, 3]);
        body.add(pillow.placed(Place::at(x, 24.2, -8.6).pitch(-14.0)));
    }
    stage.mesh("sofa", cloth, body.placed(place));
}

/// A scatter cushion of this side that leans back on its lower edge.
pub fn scatter_cushion(stage: &mut Stage, place: Place, cloth: MaterialId, side: f32) {
    let part = cushion(side, side, 0.36 * side, 10).placed(Place::HERE.pitch(-22.0).shift(0.0, 0.5 * side, 0.0));
    stage.mesh("scatter-cushion", cloth, part.placed(place));
}

/// A dining chair: turned legs, a padded seat, a back of bent slats.
pub fn dining_chair(stage: &mut Stage, place: Place, wood: MaterialId, cloth: MaterialId) {
    let mut frame = Part::default();
    let leg = [[0.0, 0.0], [0.55, 0.0], [0.6, 0.6], [0.9, 5.0], [0.7, 6.0], [0.95, 7.0], [0.95, 16.0], [0.0, 16.0]];
    for (x, z) in corners(15.0, 14.0) {
        if z > 0.0 {
            frame.add(revolve(&leg, 10).placed(Place::at(x, 0.0, z)));
        } else {
            // The hind legs run on as the posts of the back.
            let post =
                curve(&[[x, 0.0, z - 1.6], [x, 9.0, z - 0.2], [x, 17.0, z], [x, 27.0, z - 1.4], [x, 36.0, z - 4.0]], 3);
            frame.add(tube(&post, 8, Ends::Flat, |s| 0.85 - 0.3 * (s - 0.45).abs()));
        }
    }
    for (from, to) in [([-7.5, 15.2, 7.0], [7.5, 15.2, 7.0]), ([-7.5, 15.2, -7.0], [7.5, 15.2, -7.0])] {
        frame.add(bevelled([from[0], from[1] - 1.2, from[2] - 0.5], [to[0], to[1] + 1.0, to[2] + 0.5], 0.15));
    }
    for x in [-7.5, 7.5] {
        frame.add(bevelled([x - 0.5, 14.0, -7.0], [x + 0.5, 16.2, 7.0], 0.15));
        frame.add(bevelled([x - 0.35, 6.0, -7.0], [x + 0.35, 7.0, 7.0], 0.12));
    }
    for (y, height) in [(22.0, 1.6), (27.0, 1.6), (32.8, 3.0)] {
        let back = |y: f32| -7.0 - 1.4 * ((y - 17.0) / 10.0) * ((y - 17.0) / 10.0);
        let slat = soft_box([7.6, height, 0.45], 8.0, [8, 3, 2]).bent(|p| {
            let u = p.x / 7.6;
            photinus_geometry::Vec3::new(p.x, p.y + y, p.z + back(y) - 1.3 * (1.0 - u * u))
        });
        frame.add(slat);
    }
    stage.mesh("chair", wood, frame.placed(place));
    let seat = soft_box([8.6, 1.5, 8.2], 6.0, [8, 3, 8]);
    stage.mesh("chair-seat", cloth, seat.placed(place.shift(0.0, 17.0, 0.0)));
}

/// A low stool with a round padded top, for feet or a piano.
pub fn stool(stage: &mut Stage, place: Place, wood: MaterialId, cloth: MaterialId, radius: f32, height: f32) {
    let mut legs = Part::default();
    for k in 0..4 {
        let at = Place::HERE.yaw(45.0 + 90.0 * k as f32).shift(0.0, 0.0, 0.66 * radius).pitch(-7.0);
        let leg = [[0.0, 0.0], [0.5, 0.0], [0.55, 0.4], [0.95, height - 3.0], [0.0, height - 3.0]];
        legs.add(revolve(&leg, 10).placed(at));
    }
    stage.mesh("stool", wood, legs.placed(place));
    let pad = soft_box([radius, 2.0, radius], 3.2, [10, 3, 10]);
    stage.mesh("stool-pad", cloth, pad.placed(place.shift(0.0, height - 1.6, 0.0)));
}

/// The four corners of a rectangle around the origin.
pub fn corners(width: f32, depth: f32) -> [(f32, f32); 4] {
    let (x, z) = (0.5 * width, 0.5 * depth);
    [(-x, -z), (x, -z), (x, z), (-x, z)]
}
