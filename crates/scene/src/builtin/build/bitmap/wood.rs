//! Wood: grain along v, and boards of it.

use super::{draw, fraction, mix, noise::Noise, step_between};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// The colour of wood at a point whose v runs along the grain; `bend` shifts the figure of one board against another.
fn figure(noise: &Noise, u: f32, v: f32, bend: f32, light: Vec3, dark: Vec3) -> Vec3 {
    let wander = noise.clouds(u, v, [2, 2], 3) - 0.5;
    let rings = fraction(u * 9.0 + bend * 5.0 + wander * 3.4);
    let ring = step_between(0.0, 0.85, rings) * (1.0 - step_between(0.88, 1.0, rings));
    let fibre = noise.clouds(u, v, [64, 4], 2);
    mix(light, dark, 0.55 * ring + 0.45 * fibre)
}

/// A plain sheet of wood, tiling.
pub fn grain(number: u32, light: Vec3, dark: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(256, 512, |u, v| figure(&noise, u, v, 0.0, light, dark))
}

/// A floor of boards, eight across and two long, with shifted joints.
pub fn planks(number: u32, light: Vec3, dark: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    let across = 8.0;
    draw(1024, 1024, |u, v| {
        let row = (u * across).floor();
        let along = v * 2.0 + noise.cell(row as i64, 40);
        let board = along.floor();
        let (x, y) = (fraction(u * across), fraction(along));
        let tint = noise.cell(row as i64 + 11, board.rem_euclid(2.0) as i64 + 50);
        let wood = figure(&noise, 0.3 * x + 0.37 * row, 0.5 * y + 0.21 * board, tint * 3.0, light, dark);
        let edge = |t: f32, width: f32| step_between(0.0, width, t) * step_between(0.0, width, 1.0 - t);
        wood * (0.82 + 0.3 * tint) * (0.45 + 0.55 * edge(x, 0.035) * edge(y, 0.006))
    })
}
