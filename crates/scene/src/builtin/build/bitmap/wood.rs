//! Wood: grain along v, and boards of it.

use super::{draw_rows, fraction, middles, mix, noise::Noise, paint, step_between};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// Wood of these two colours at `u` of a sheet whose v runs along the grain; `wander` and `fibre` are noises there, and
/// `bend` shifts the figure of one board against another.
#[inline(always)]
fn figure([light, dark]: [Vec3; 2], u: f32, wander: f32, fibre: f32, bend: f32) -> Vec3 {
    let rings = fraction(u * 9.0 + bend * 5.0 + (wander - 0.5) * 3.4);
    let ring = step_between(0.0, 0.85, rings) * (1.0 - step_between(0.88, 1.0, rings));
    mix(light, dark, 0.55 * ring + 0.45 * fibre)
}

/// A plain sheet of wood, tiling; stretched along the grain, where it has little detail.
pub fn grain(number: u32, light: Vec3, dark: Vec3) -> Arc<Bitmap> {
    const WIDTH: u32 = 256;
    let noise = Noise::new(number);
    let (wanders, fibres) = (noise.sheet(middles(WIDTH), [2, 2], 3), noise.sheet(middles(WIDTH), [64, 4], 2));
    draw_rows(WIDTH, 256, |v, row| {
        let (wander, fibre) = (wanders.along(v), fibres.along(v));
        let columns = middles(WIDTH).zip(&wander).zip(&fibre);
        paint(row, columns.map(|((u, &wander), &fibre)| figure([light, dark], u, wander, fibre, 0.0)));
    })
}

/// A floor of boards, eight across and two long, with shifted joints.
pub fn planks(number: u32, light: Vec3, dark: Vec3) -> Arc<Bitmap> {
    const ACROSS: u32 = 8;
    // The grain has much less detail along the boards than across.
    const WIDTH: u32 = 1024;
    const BOARD: usize = (WIDTH / ACROSS) as usize;
    let noise = Noise::new(number);
    let edge = |t: f32, width: f32| step_between(0.0, width, t) * step_between(0.0, width, 1.0 - t);
    let sides: Vec<f32> = middles(WIDTH / ACROSS).map(|x| 0.55 * edge(x, 0.035)).collect();
    // Where the columns of each board lie in the sheet of wood that all are cut from.
    let places = (0..ACROSS).flat_map(|board| middles(WIDTH / ACROSS).map(move |x| 0.3 * x + 0.37 * board as f32));
    let (wanders, fibres) = (noise.sheet(places.clone(), [2, 2], 3), noise.sheet(places.clone(), [64, 4], 2));
    let places: Vec<f32> = places.collect();
    draw_rows(WIDTH, 512, |v, row| {
        for (across, pixels) in row.chunks_exact_mut(BOARD).enumerate() {
            let along = v * 2.0 + noise.cell(across as i64, 40);
            let (board, y) = (along.floor(), fraction(along));
            let tint = noise.cell(across as i64 + 11, board.rem_euclid(2.0) as i64 + 50);
            let (shade, end) = (0.82 + 0.3 * tint, edge(y, 0.006));
            let (height, columns) = (0.5 * y + 0.21 * board, across * BOARD..(across + 1) * BOARD);
            let wander = wanders.part_along(height, columns.clone());
            let fibre = fibres.part_along(height, columns.clone());
            let columns = places[columns].iter().zip(&wander).zip(&fibre).zip(&sides);
            let color = |(((&u, &wander), &fibre), &side)| {
                figure([light, dark], u, wander, fibre, tint * 3.0) * shade * (0.45 + side * end)
            };
            paint(pixels, columns.map(color));
        }
    })
}
