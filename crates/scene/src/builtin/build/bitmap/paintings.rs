//! Paintings for walls, each in a manner of its own.

use super::noise::Noise;
use super::{draw, draw_rows, hex, middles, mix, paint, step_between};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// Ranges of hills under an evening sky, a low sun between them.
pub fn hills(number: u32) -> Arc<Bitmap> {
    const WIDTH: u32 = 512;
    let noise = Noise::new(number);
    let ranges = [0x8C8FB0, 0x6F7FA3, 0x50708A, 0x3C5F66, 0x2E4B40, 0x22352C].map(hex);
    let crest = |k: usize, u: f32| {
        let k = k as f32;
        0.60 - 0.105 * k + 0.22 * (noise.clouds(u + 0.13 * k, 0.17 * k, [3 + k as i32, 3], 5) - 0.5)
    };
    let crests: Vec<[f32; 6]> =
        (0..WIDTH).map(|x| std::array::from_fn(|k| crest(k, x as f32 / WIDTH as f32))).collect();
    let (cloudy, weave) = (noise.sheet(middles(WIDTH), [3, 12], 4), noise.sheet(middles(WIDTH), [64, 64], 1));
    draw_rows(WIDTH, 384, |v, row| {
        let (clouds, canvas) = (cloudy.along(v), weave.along(v));
        let color = |(((u, &clouds), &canvas), crests): (((f32, &f32), &f32), &[f32; 6])| {
            let c = match crests.iter().rposition(|&crest| v < crest) {
                Some(k) => mix(ranges[k] * 1.12, ranges[k] * 0.85, step_between(0.0, 0.16, crests[k] - v)),
                None => {
                    let bands = v + 0.08 * clouds;
                    let sky = mix(hex(0xF6C27A), hex(0x7FA3C4), step_between(0.45, 1.0, bands));
                    let (dx, dy) = ((u - 0.64) * 1.33, v - 0.6);
                    let sun = (dx * dx + dy * dy).sqrt();
                    let c = mix(hex(0xFFF1C9), sky, step_between(0.055, 0.065, sun));
                    mix(hex(0xFFD898), c, step_between(0.0, 0.4, sun).max(0.35))
                }
            };
            c * (0.94 + 0.12 * canvas)
        };
        paint(row, middles(WIDTH).zip(&clouds).zip(&canvas).zip(&crests).map(color));
    })
}

/// Black bars, white and primary fields.
pub fn blocks(number: u32) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    let (columns, rows) = ([0.0, 0.22, 0.3, 0.72, 0.86, 1.0], [0.0, 0.16, 0.44, 0.52, 0.82, 1.0]);
    let colors = [
        [0x1F4E8C, 0xEDE8DA, 0xEDE8DA, 0xE8C23A, 0xEDE8DA],
        [0xEDE8DA, 0xEDE8DA, 0xEDE8DA, 0xEDE8DA, 0xB5322B],
        [0xEDE8DA, 0xE8C23A, 0xEDE8DA, 0xEDE8DA, 0xEDE8DA],
        [0xEDE8DA, 0xEDE8DA, 0xB5322B, 0xEDE8DA, 0x1F4E8C],
        [0xE8C23A, 0xEDE8DA, 0xEDE8DA, 0x22221F, 0xEDE8DA],
    ];
    draw(512, 384, |u, v| {
        let find = |edges: &[f32; 6], t: f32| edges.windows(2).position(|w| t < w[1]).unwrap_or(4);
        let (i, j) = (find(&columns, u), find(&rows, v));
        let near = |edges: &[f32; 6], t: f32| edges[1..5].iter().map(|e| (e - t).abs()).fold(1.0, f32::min);
        let line = (near(&columns, u) * 1.33).min(near(&rows, v));
        let c = mix(hex(0x1B1B1B), hex(colors[j][i]), step_between(0.009, 0.013, line));
        c * (0.96 + 0.07 * noise.clouds(u, v, [48, 48], 2))
    })
}

/// Rings and discs in warm and cool colours on cream.
pub fn circles(number: u32) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    let inks = [0xC8452F, 0x2F5D7C, 0xE3A63B, 0x4F7F64, 0x6D3F5B, 0xD97F56].map(hex);
    let discs: [_; 14] = std::array::from_fn(|k| {
        let random = |salt: i64| noise.cell(k as i64 + 3, salt);
        let middle = [0.1 + 0.8 * random(5), 0.08 + 0.84 * random(9)];
        (middle, 0.04 + 0.19 * random(13) * random(14), inks[k % inks.len()], inks[(k + 2) % inks.len()])
    });
    const WIDTH: u32 = 384;
    let us: Vec<f32> = middles(WIDTH).collect();
    let (plain, weave) = (noise.sheet(middles(WIDTH), [3, 3], 4), noise.sheet(middles(WIDTH), [64, 64], 1));
    draw_rows(WIDTH, 512, |v, row| {
        let (ground, canvas) = (plain.along(v), weave.along(v));
        let mut colors: Vec<Vec3> = ground.iter().map(|&t| mix(hex(0xEFE3CB), hex(0xE3CFAE), t)).collect();
        for (k, &([x, y], radius, ink, heart)) in discs.iter().enumerate() {
            let (dy, reach) = ((v - y) * 1.33, radius + 0.004);
            if dy.abs() > reach {
                continue;
            }
            let columns = [x - reach, x + reach].map(|u| us.partition_point(|&middle| middle < u));
            for (c, u) in colors.iter_mut().zip(&us).take(columns[1]).skip(columns[0]) {
                let dx = u - x;
                let d = (dx * dx + dy * dy).sqrt();
                let disc = 1.0 - step_between(radius - 0.003, radius + 0.003, d);
                let ring = disc * step_between(0.72 * radius - 0.003, 0.72 * radius + 0.003, d);
                let cover = if k % 3 == 0 { ring } else { disc };
                *c = mix(*c, *c * 0.25 + ink * 0.75, cover);
                let core = 1.0 - step_between(0.3 * radius - 0.003, 0.3 * radius + 0.003, d);
                *c = mix(*c, heart, core);
            }
        }
        paint(row, colors.iter().zip(&canvas).map(|(&color, &canvas)| color * (0.95 + 0.1 * canvas)));
    })
}
