//! Stone: marble, brick, pebbles and chequers.

use super::{draw, fraction, hex, mix, noise::Noise, step_between};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// Veined marble, tiling.
pub fn marble(number: u32, ground: Vec3, vein: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(512, 512, |u, v| {
        let warp = noise.clouds(u, v, [3, 3], 5) - 0.5;
        let line = |phase: f32, sharp: f32| {
            let t = fraction(phase);
            let d = (2.0 * t - 1.0).abs();
            libm::powf(1.0 - d, sharp)
        };
        let strong = line(u + v + 2.6 * warp, 9.0);
        let weak = line(2.0 * u - v + 3.1 * warp + 0.3, 14.0);
        let cloud = noise.clouds(v, u, [4, 4], 4);
        mix(ground, vein, (0.75 * strong + 0.35 * weak + 0.22 * cloud).min(1.0))
    })
}

/// A wall of bricks in running bond: 4 across, 8 courses, tiling.
pub fn brick(number: u32, clay: Vec3, mortar: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(512, 512, |u, v| {
        let course = (v * 8.0).floor();
        let x = u * 4.0 + 0.5 * course.rem_euclid(2.0);
        let stone = x.floor().rem_euclid(4.0);
        let (bx, by) = (fraction(x), fraction(v * 8.0));
        let rough = noise.clouds(u, v, [32, 32], 3);
        let near = (bx.min(1.0 - bx) * 2.0).min(by.min(1.0 - by));
        let inside = step_between(0.05, 0.11, near + 0.05 * (rough - 0.5));
        let tint = noise.cell(stone as i64, course as i64 + 20);
        mix(mortar * (0.8 + 0.3 * rough), clay * (0.65 + 0.45 * tint) * (0.8 + 0.35 * rough), inside)
    })
}

/// Chequers of two colours, `cells` along each side (even, so that they tile), slightly worn.
pub fn checker(number: u32, cells: u32, a: Vec3, b: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    draw(512, 512, |u, v| {
        let n = cells as f32;
        let even = ((u * n).floor() + (v * n).floor()).rem_euclid(2.0) == 0.0;
        let worn = 0.85 + 0.25 * noise.clouds(u, v, [6, 6], 5);
        (if even { a } else { b }) * worn
    })
}

/// The bed of a pond: rounded pebbles of several greys and browns, tiling.
pub fn pebbles(number: u32) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    let cells = 24i64;
    let colors = [0xA39B8B, 0x8C7B66, 0xB8AE9C, 0x6F675C, 0x9A8A70, 0xC4B9A4].map(hex);
    draw(512, 512, |u, v| {
        let (x, y) = (u * cells as f32, v * cells as f32);
        // The two nearest of the stones' middles: their difference tells how far the gap between them is.
        let (mut first, mut second, mut stone) = (9.0f32, 9.0f32, 0.0);
        for dy in -1..=1 {
            for dx in -1..=1 {
                let (cx, cy) = (x.floor() as i64 + dx, y.floor() as i64 + dy);
                let (wx, wy) = (cx.rem_euclid(cells), cy.rem_euclid(cells));
                let px = cx as f32 + 0.15 + 0.7 * noise.cell(wx, wy);
                let py = cy as f32 + 0.15 + 0.7 * noise.cell(wx + 30, wy + 30);
                let d = ((x - px) * (x - px) + (y - py) * (y - py)).sqrt();
                if d < first {
                    (second, first) = (first, d);
                    stone = noise.cell(wx + 7, wy + 40);
                } else if d < second {
                    second = d;
                }
            }
        }
        let color = colors[((stone * 6.0) as usize).min(5)];
        let mottle = 0.8 + 0.4 * noise.clouds(u, v, [32, 32], 2);
        color * mottle * (0.3 + 0.7 * step_between(0.02, 0.28, second - first))
    })
}
