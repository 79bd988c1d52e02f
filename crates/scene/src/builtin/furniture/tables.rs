//! Tables and a desk.

use super::seats::corners;
use crate::MaterialId;
use crate::builtin::build::{Part, Place, Stage, bevelled, profile, revolve, soft_box, standing};

/// A coffee table with a glass top on a wooden frame, 44 x 26, 17 high; a shelf below.
pub fn coffee_table(stage: &mut Stage, place: Place, wood: MaterialId) {
    let mut frame = Part::default();
    for (x, z) in corners(38.0, 20.0) {
        frame.add(standing([2.2, 15.4, 2.2], 0.3).placed(Place::at(x, 0.0, z)));
    }
    for z in [-10.0, 10.0] {
        frame.add(bevelled([-18.0, 13.0, z - 0.6], [18.0, 15.0, z + 0.6], 0.2));
    }
    for x in [-19.0, 19.0] {
        frame.add(bevelled([x - 0.6, 13.0, -9.0], [x + 0.6, 15.0, 9.0], 0.2));
    }
    frame.add(bevelled([-18.2, 4.6, -9.2], [18.2, 5.6, 9.2], 0.25));
    stage.mesh("coffee-table", wood, frame.placed(place));
    let glass = stage.clear_glass();
    // A hair above the legs: touching glass would share their surface.
    let top = bevelled([-22.0, 15.45, -13.0], [22.0, 16.5, 13.0], 0.25);
    stage.mesh("glass-top", glass, top.placed(place));
}

/// Height of the coffee table's top.
pub const COFFEE_TABLE_TOP: f32 = 16.5;

/// A round table on one turned foot.
pub fn round_table(stage: &mut Stage, place: Place, wood: MaterialId, radius: f32, height: f32) {
    let mut outline = vec![[0.0, 0.0], [0.62 * radius, 0.0], [0.64 * radius, 0.5], [0.58 * radius, 1.1]];
    let foot = [[0.16, 0.1], [0.1, 0.22], [0.13, 0.42], [0.2, 0.55], [0.1, 0.66], [0.1, 0.82], [0.24, 0.93]];
    outline.extend(profile(&foot.map(|p| [p[0] * radius, p[1] * height]), 3));
    outline.extend([
        [0.3 * radius, height - 1.4],
        [0.97 * radius, height - 1.4],
        [radius, height - 1.1],
        [radius, height - 0.3],
        [0.97 * radius, height],
        [0.0, height],
    ]);
    stage.mesh("round-table", wood, revolve(&outline, 28).uv_scaled(60.0, 40.0).placed(place));
}

/// A dining table with turned legs.
pub fn dining_table(stage: &mut Stage, place: Place, wood: MaterialId, width: f32, depth: f32) {
    let mut part = bevelled([-0.5 * width, 27.4, -0.5 * depth], [0.5 * width, 29.0, 0.5 * depth], 0.35);
    let turned = profile(&[[1.1, 0.0], [0.9, 1.2], [1.5, 5.0], [1.7, 12.0], [1.2, 19.0], [1.9, 20.6], [1.5, 22.0]], 3);
    let mut leg = vec![[0.0, 0.0]];
    leg.extend(turned);
    leg.push([0.0, 22.0]);
    for (x, z) in corners(width - 7.0, depth - 7.0) {
        part.add(revolve(&leg, 14).placed(Place::at(x, 0.0, z)));
        part.add(bevelled([x - 1.8, 22.0, z - 1.8], [x + 1.8, 27.4, z + 1.8], 0.2));
    }
    let (x, z) = (0.5 * width - 3.5, 0.5 * depth - 3.5);
    for side in [-1.0, 1.0] {
        part.add(bevelled([-x, 23.2, side * z - 0.5], [x, 27.4, side * z + 0.5], 0.1));
        part.add(bevelled([side * x - 0.5, 23.2, -z], [side * x + 0.5, 27.4, z], 0.1));
    }
    stage.mesh("dining-table", wood, part.placed(place));
}

/// Height of the dining table's top.
pub const DINING_TABLE_TOP: f32 = 29.0;

/// A writing desk with two pedestals of drawers, 58 x 28, 30 high; its front is where one sits.
pub fn desk(stage: &mut Stage, place: Place, wood: MaterialId) {
    let mut part = bevelled([-29.0, 28.4, -14.0], [29.0, 30.0, 14.0], 0.4);
    let mut handles = Part::default();
    for side in [-1.0f32, 1.0] {
        let (low, high) = if side < 0.0 { (-27.5, -11.0) } else { (11.0, 27.5) };
        part.add(bevelled([low, 2.0, -12.5], [high, 28.4, 12.0], 0.25));
        part.add(bevelled([low - 0.4, 0.0, -12.9], [high + 0.4, 2.4, 12.6], 0.3));
        for k in 0..3 {
            let y = 3.6 + 8.2 * k as f32;
            part.add(bevelled([low + 0.8, y, 12.0], [high - 0.8, y + 7.6, 12.9], 0.3));
            let pull = soft_box([2.6, 0.4, 0.5], 3.0, [4, 2, 2]);
            handles.add(pull.placed(Place::at(0.5 * (low + high), y + 3.8, 13.3)));
        }
    }
    part.add(bevelled([-11.0, 24.6, -12.0], [11.0, 28.4, 11.0], 0.2));
    part.add(bevelled([-10.4, 25.0, 11.0], [10.4, 28.2, 11.9], 0.3));
    part.add(bevelled([-11.0, 8.0, -12.4], [11.0, 24.6, -11.4], 0.2));
    handles.add(soft_box([2.6, 0.4, 0.5], 3.0, [4, 2, 2]).placed(Place::at(0.0, 26.6, 12.3)));
    stage.mesh("desk", wood, part.placed(place));
    let brass = stage.brass();
    stage.mesh("handles", brass, handles.placed(place));
}

/// Height of the desk's top.
pub const DESK_TOP: f32 = 30.0;
