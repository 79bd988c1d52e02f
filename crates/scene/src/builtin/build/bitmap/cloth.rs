//! Cloth: weave, stripes and a rug.

use super::{draw_rows, floor, fraction, middles, mix, noise::Noise, paint, step_between};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// Plain weave: threads of one colour over and under threads of another, tiling.
pub fn weave(number: u32, warp: Vec3, weft: Vec3) -> Arc<Bitmap> {
    const SIDE: u32 = 256;
    const THREADS: f32 = 32.0;
    let noise = Noise::new(number);
    let shade = |across: f32| 0.72 + 0.28 * (1.0 - (2.0 * across - 1.0) * (2.0 * across - 1.0));
    let tint = |x: i64, y: i64| 0.9 + 0.2 * noise.cell(x, y);
    // Every column is on a thread of the warp; where it lies below, the weft is seen.
    let threads = middles(SIDE).map(|u| (floor(u * THREADS), fraction(u * THREADS)));
    let columns: Vec<(i32, Vec3)> =
        threads.map(|(id, across)| (id as i32, warp * shade(across) * tint(id as i64, 1))).collect();
    draw_rows(SIDE, SIDE, |v, row| {
        let (id, across) = (floor(v * THREADS), fraction(v * THREADS));
        let weft = weft * shade(across) * tint(id as i64 + 7, 0);
        paint(row, columns.iter().map(|&(thread, warp)| if (thread + id as i32) % 2 == 0 { warp } else { weft }));
    })
}

/// Vertical stripes: a wide and a narrow one on a ground, `repeats` times, tiling.
pub fn stripes(number: u32, repeats: u32, ground: Vec3, wide: Vec3, narrow: Vec3) -> Arc<Bitmap> {
    const WIDTH: u32 = 512;
    let wools = Noise::new(number).sheet(middles(WIDTH), [64, 64], 1);
    let color = |u: f32| {
        let t = fraction(u * repeats as f32);
        let soft = |low: f32, high: f32| {
            step_between(low - 0.01, low + 0.01, t) * (1.0 - step_between(high - 0.01, high + 0.01, t))
        };
        mix(mix(ground, wide, soft(0.1, 0.45)), narrow, soft(0.68, 0.76))
    };
    let columns: Vec<Vec3> = middles(WIDTH).map(color).collect();
    draw_rows(WIDTH, 128, |v, row| {
        let wool = wools.along(v);
        paint(row, columns.iter().zip(&wool).map(|(&color, &wool)| color * (0.95 + 0.1 * wool)));
    })
}

/// A rug with a border, corner pieces and a medallion, the same in all four quarters.
pub fn rug(number: u32, field: Vec3, border: Vec3, accent: Vec3, light: Vec3) -> Arc<Bitmap> {
    const WIDTH: u32 = 768;
    const SIZE: usize = WIDTH as usize;
    let noise = Noise::new(number);
    let wools = noise.sheet(middles(WIDTH), [2, 16], 2);
    let across = |u: f32| 1.5 * (2.0 * u - 1.0).abs();
    let band = |low: f32, high: f32, d: f32| {
        step_between(low - 0.008, low + 0.008, d) * (1.0 - step_between(high - 0.008, high + 0.008, d))
    };
    let in_border = |[x, y]: [f32; 2]| {
        let rim = (1.5 - x).min(1.0 - y);
        let along = if 1.5 - x < 1.0 - y { y } else { x };
        let (t, s) = (fraction(along * 5.0 + 0.5) - 0.5, (rim - 0.17) / 0.2);
        let c = mix(border, light, 1.0 - step_between(0.36, 0.42, t.abs() + s.abs()));
        let c = mix(c, accent, 1.0 - step_between(0.2, 0.26, t.abs() + s.abs()));
        mix(c, light, band(0.285, 0.3, rim) + band(0.035, 0.05, rim))
    };
    let in_field = |[x, y]: [f32; 2]| {
        let lozenge = |cx: f32, cy: f32, w: f32, h: f32| (x - cx).abs() / w + (y - cy).abs() / h;
        // Small flowers on a diagonal grid.
        let (gx, gy) = (fraction((x + y) * 4.0) - 0.5, fraction((x - y) * 4.0) - 0.5);
        let mut c = mix(field, accent, 0.7 * (1.0 - step_between(0.10, 0.16, (gx * gx + gy * gy).sqrt())));
        for (size, color) in
            [(1.0, border), (0.92, light), (0.86, accent), (0.62, border), (0.56, light), (0.3, accent), (0.16, light)]
        {
            c = mix(c, color, 1.0 - step_between(size - 0.02, size + 0.02, lozenge(0.0, 0.0, 0.85, 0.7)));
        }
        for (size, color) in [(0.62, border), (0.54, light), (0.48, accent)] {
            c = mix(c, color, 1.0 - step_between(size - 0.02, size + 0.02, lozenge(1.5, 1.0, 1.0, 1.0)));
        }
        c
    };
    let places: Vec<f32> = middles(WIDTH).map(across).collect();
    let is_border = |[x, y]: [f32; 2]| (1.5 - x).min(1.0 - y) < 0.3;
    draw_rows(WIDTH, 512, |v, row| {
        let knots = middles(WIDTH).map(|u| 0.9 + 0.16 * noise.cell((u * 384.0) as i64, (v * 256.0) as i64));
        let shades: Vec<[f32; 2]> = knots.zip(wools.along(v)).map(|(knot, wool)| [knot, 0.94 + 0.12 * wool]).collect();
        // One quarter is drawn; units: the half height is 1, the half width 1.5.
        let y = (2.0 * v - 1.0).abs();
        let edge = places[..SIZE / 2].partition_point(|&x| is_border([x, y]));
        for columns in [0..edge, SIZE - edge..SIZE] {
            let places = places[columns.clone()].iter().map(|&x| [x, y]);
            paint(&mut row[columns.clone()], shaded(places.map(in_border), &shades[columns]));
        }
        let columns = edge..SIZE - edge;
        let places = places[columns.clone()].iter().map(|&x| [x, y]);
        paint(&mut row[columns.clone()], shaded(places.map(in_field), &shades[columns]));
    })
}

/// Colours of wool of these shades: of its knots, and of the bands that were dyed on different days.
#[inline(always)]
fn shaded(colors: impl Iterator<Item = Vec3>, shades: &[[f32; 2]]) -> impl Iterator<Item = Vec3> {
    colors.zip(shades).map(|(color, [knot, band])| color * *knot * *band)
}
