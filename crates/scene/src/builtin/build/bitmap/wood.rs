//! Wood: grain along v, and boards of it.

use super::{
    draw_rows, floor, fraction, middles, mix,
    noise::{Columns, Noise, Row},
    step_between,
};
use crate::Bitmap;
use photinus_geometry::Vec3;
use std::sync::Arc;

/// Where the columns of a picture lie in the noises of wood.
struct Sheet {
    wander: Columns,
    fibre: Columns,
}

impl Sheet {
    /// Of columns at these u of the sheet.
    fn new(us: impl Iterator<Item = f32> + Clone) -> Self {
        Self { wander: Columns::new(us.clone(), 2, 3), fibre: Columns::new(us, 64, 2) }
    }
}

/// Wood along one height of a sheet whose v runs along the grain.
struct Figure<'a> {
    wander: Row<'a>,
    fibre: Row<'a>,
    colors: [Vec3; 2],
}

impl<'a> Figure<'a> {
    fn new(noise: &'a Noise, v: f32, colors: [Vec3; 2]) -> Self {
        Self { wander: noise.clouds_at(v, [2, 2], 3), fibre: noise.clouds_at(v, [64, 4], 2), colors }
    }

    /// The colour in a column, which lies at `u`; `bend` shifts the figure of one board against another.
    fn at(&self, sheet: &Sheet, column: usize, u: f32, bend: f32) -> Vec3 {
        let wander = self.wander.at_column(&sheet.wander, column) - 0.5;
        let rings = fraction(u * 9.0 + bend * 5.0 + wander * 3.4);
        let ring = step_between(0.0, 0.85, rings) * (1.0 - step_between(0.88, 1.0, rings));
        let [light, dark] = self.colors;
        mix(light, dark, 0.55 * ring + 0.45 * self.fibre.at_column(&sheet.fibre, column))
    }
}

/// A plain sheet of wood, tiling; stretched along the grain, where it has little detail.
pub fn grain(number: u32, light: Vec3, dark: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    let sheet = Sheet::new(middles(256));
    draw_rows(256, 256, |v| {
        let (figure, sheet) = (Figure::new(&noise, v, [light, dark]), &sheet);
        move |column, u| figure.at(sheet, column, u, 0.0)
    })
}

/// A floor of boards, eight across and two long, with shifted joints.
pub fn planks(number: u32, light: Vec3, dark: Vec3) -> Arc<Bitmap> {
    let noise = Noise::new(number);
    const ACROSS: usize = 8;
    let edge = |t: f32, width: f32| step_between(0.0, width, t) * step_between(0.0, width, 1.0 - t);
    // The grain has much less detail along the boards than across.
    const WIDTH: u32 = 1024;
    let place = |u: f32| {
        let (row, x) = (floor(u * ACROSS as f32), fraction(u * ACROSS as f32));
        (row, x, 0.3 * x + 0.37 * row)
    };
    let sheet = Sheet::new(middles(WIDTH).map(|u| place(u).2));
    draw_rows(WIDTH, 512, |v| {
        let boards: [_; ACROSS] = std::array::from_fn(|row| {
            let along = v * 2.0 + noise.cell(row as i64, 40);
            let board = floor(along);
            let y = fraction(along);
            let tint = noise.cell(row as i64 + 11, board.rem_euclid(2.0) as i64 + 50);
            (Figure::new(&noise, 0.5 * y + 0.21 * board, [light, dark]), tint, edge(y, 0.006))
        });
        let sheet = &sheet;
        move |column, u| {
            let (row, x, u) = place(u);
            let (figure, tint, end) = &boards[row as usize];
            let wood = figure.at(sheet, column, u, tint * 3.0);
            wood * (0.82 + 0.3 * tint) * (0.45 + 0.55 * edge(x, 0.035) * end)
        }
    })
}
