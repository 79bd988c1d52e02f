//! Pictures drawn by code: functions from the unit square to colour, sampled once.
//!
//! Colours in here are sRGB-encoded, 0 to 1, as one picks them from a chart; v runs upwards.

mod cloth;
mod noise;
mod paintings;
mod plants;
mod stone;
mod wood;
mod world;

pub use cloth::{rug, stripes, weave};
pub use paintings::{blocks, circles, hills};
pub use plants::{pad, petal, scales};
pub use stone::{brick, checker, marble, pebbles};
pub use wood::{grain, planks};
pub use world::world;

use crate::{Bitmap, BitmapPixels};
use photinus_geometry::Vec3;
use rayon::prelude::*;
use std::sync::Arc;

/// The u of the middle of each column.
fn middles(width: u32) -> impl Iterator<Item = f32> + Clone {
    (0..width).map(move |column| middle(column, width))
}

fn middle(column: u32, width: u32) -> f32 {
    (column as f32 + 0.5) / width as f32
}

/// Samples a picture at the middles of its pixels.
fn draw(width: u32, height: u32, color: impl Fn(f32, f32) -> Vec3 + Sync) -> Arc<Bitmap> {
    draw_rows(width, height, |v| {
        let color = &color;
        move |_, u| color(u, v)
    })
}

/// Samples a picture at the middles of its pixels; `row` prepares what a height's colours share, and is then asked for
/// that of each column and its u.
fn draw_rows<C: Fn(usize, f32) -> Vec3>(width: u32, height: u32, row: impl Fn(f32) -> C + Sync) -> Arc<Bitmap> {
    let mut data = vec![[0; 4]; (width * height) as usize];
    data.par_chunks_exact_mut(width as usize).enumerate().for_each(|(line, pixels)| {
        let color = row(1.0 - (line as f32 + 0.5) / height as f32);
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let c = color(column, middle(column as u32, width));
            let byte = |x: f32| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
            *pixel = [byte(c.x), byte(c.y), byte(c.z), 255];
        }
    });
    Arc::new(Bitmap { width, height, pixels: BitmapPixels::Rgba8 { data, srgb: true } })
}

/// A colour by its chart number, 0xRRGGBB.
pub fn hex(number: u32) -> Vec3 {
    let channel = |shift: u32| (number >> shift & 255) as f32 / 255.0;
    Vec3::new(channel(16), channel(8), channel(0))
}

/// From `a` to `b` as `t` goes from 0 to 1.
fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a * (1.0 - t) + b * t
}

/// 0 below `low`, 1 above `high`, smooth between.
fn step_between(low: f32, high: f32, x: f32) -> f32 {
    // Most points lie outside: no division for them.
    if x <= low {
        return 0.0;
    }
    if x >= high {
        return 1.0;
    }
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The whole number at or below `x`, which is far from the ends of `i32`. By conversion: the library's function is a
/// slow call on machines without the instruction.
fn floor(x: f32) -> f32 {
    let cut = x as i32;
    (cut - i32::from(x < cut as f32)) as f32
}

/// The part of `x` after its whole number.
fn fraction(x: f32) -> f32 {
    x - floor(x)
}
