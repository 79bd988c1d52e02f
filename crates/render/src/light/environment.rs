//! Light from infinity: look-up, and directions in proportion to radiance.

use super::alias::AliasTable;
use super::sky_view::SkyView;
use photinus_geometry::{Mat3, Vec3};
use photinus_scene::{Bitmap, BitmapPixels, EnvironmentLight};
use std::f32::consts::{FRAC_1_PI, PI, TAU};
use std::sync::Arc;

/// Density over the solid angle of one bin of a [`SkyView`].
const BIN_DENSITY: f32 = SkyView::BINS as f32 * 0.25 * FRAC_1_PI;

/// An environment ready to be looked up, and sampled within the bins of a [`SkyView`].
pub(crate) enum Environment {
    /// Radiance.
    Constant(Vec3),
    Image(Box<ImageEnvironment>),
}

/// An equirectangular picture, bilinear between pixels. As in Mitsuba 3 the first and the last row lie on the poles, and
/// columns have their pixels' middles.
pub(crate) struct ImageEnvironment {
    bitmap: Arc<Bitmap>,
    scale: f32,
    to_world: Mat3,
    to_local: Mat3,
    /// For each bin, the cells between four pixels that have their middle in it, and the choice among them by
    /// brightest channel of the corners times the cell's solid angle.
    bins: Vec<(Vec<u32>, AliasTable)>,
    /// Probability of each cell within its bin.
    chances: Vec<f32>,
    /// Light of each bin: mean channel times solid angle.
    powers: Vec<f64>,
    width: usize,
    /// Rows of cells: one fewer than of pixels.
    rows: usize,
    mean: Vec3,
}

impl Environment {
    /// Prepares `light`.
    pub fn new(light: &EnvironmentLight) -> Self {
        match light {
            EnvironmentLight::Constant(radiance) => Self::Constant(*radiance),
            EnvironmentLight::Image { bitmap, scale, to_world } => {
                Self::Image(Box::new(ImageEnvironment::new(bitmap.clone(), *scale, Mat3::from(to_world.matrix3))))
            }
        }
    }

    /// Radiance that arrives along `dir`, seen looking in direction `dir` (unit, world).
    pub fn radiance(&self, dir: Vec3) -> Vec3 {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Image(image) => image.radiance(dir),
        }
    }

    /// Mean radiance over all directions.
    pub fn mean(&self) -> Vec3 {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Image(image) => image.mean,
        }
    }

    /// Light that each bin sends out: brightest channel of the radiance times solid angle.
    pub fn bin_powers(&self) -> Vec<f64> {
        match self {
            Self::Constant(radiance) => {
                vec![f64::from(radiance.max_element()) / f64::from(BIN_DENSITY); SkyView::BINS]
            }
            Self::Image(image) => image.powers.clone(),
        }
    }

    /// A direction to look in within a bin that has light, and its density over solid angle.
    pub fn sample(&self, bin: usize, choice: f32, u: [f32; 2]) -> (Vec3, f32) {
        match self {
            Self::Constant(_) => (SkyView::direction(bin, u), BIN_DENSITY),
            Self::Image(image) => image.sample(bin, choice, u),
        }
    }

    /// The bin that finds the direction `dir`, and the density with which it does.
    pub fn find(&self, dir: Vec3) -> (usize, f32) {
        match self {
            Self::Constant(_) => (SkyView::bin(dir), BIN_DENSITY),
            Self::Image(image) => image.find(dir),
        }
    }

    /// Bytes of the sampling tables.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Image(image) => image.width * image.rows * (12 + 4 + 4),
        }
    }
}

impl ImageEnvironment {
    fn new(bitmap: Arc<Bitmap>, scale: f32, matrix: Mat3) -> Self {
        // Only the rotation matters: the columns are made orthonormal.
        let x = matrix.x_axis.try_normalize().unwrap_or(Vec3::X);
        let y = (matrix.y_axis - x * x.dot(matrix.y_axis)).try_normalize().unwrap_or(Vec3::Y);
        let z = x.cross(y);
        let z = if z.dot(matrix.z_axis) < 0.0 { -z } else { z };
        let to_world = Mat3::from_cols(x, y, z);
        let (width, rows) = (bitmap.width as usize, (bitmap.height as usize).max(2) - 1);
        let mut image = Self {
            bitmap,
            scale,
            to_world,
            to_local: to_world.transpose(),
            bins: Vec::new(),
            chances: vec![0.0; width * rows],
            powers: vec![0.0; SkyView::BINS],
            width,
            rows,
            mean: Vec3::ZERO,
        };
        let mut cells: Vec<Vec<u32>> = vec![Vec::new(); SkyView::BINS];
        let mut mean = [0.0f64; 3];
        for row in 0..rows {
            let solid_angle = f64::from(image.row_solid_angle(row));
            for column in 0..width {
                let color = image.cell_color(row, column);
                for c in 0..3 {
                    mean[c] += f64::from(color[c]) * solid_angle;
                }
                let bin = SkyView::bin(image.direction(row, column, [0.5, 0.5]));
                cells[bin].push((row * width + column) as u32);
                image.powers[bin] += f64::from(color.max_element().max(0.0)) * solid_angle;
            }
        }
        image.mean = Vec3::from(mean.map(|m| (m / (4.0 * std::f64::consts::PI)) as f32));
        for cells in cells {
            let weight = |&cell: &u32| {
                let (row, column) = (cell as usize / width, cell as usize % width);
                let bright = image.cell_color(row, column).max_element().max(0.0);
                f64::from(bright) * f64::from(image.row_solid_angle(row))
            };
            let weights: Vec<f64> = cells.iter().map(weight).collect();
            let table = AliasTable::new(&weights);
            for (slot, &cell) in cells.iter().enumerate() {
                image.chances[cell as usize] = table.probability(slot);
            }
            image.bins.push((cells, table));
        }
        image
    }

    /// Mean of the corners of a cell.
    fn cell_color(&self, row: usize, column: usize) -> Vec3 {
        let corners = self.corners(row, column);
        (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25
    }

    fn pixel(&self, row: usize, column: usize) -> Vec3 {
        let i = row * self.width + column;
        let color = match &self.bitmap.pixels {
            BitmapPixels::RgbaF32(data) => Vec3::new(data[i][0], data[i][1], data[i][2]),
            BitmapPixels::Rgba8 { data, srgb } => {
                let decode = |v: u8| {
                    if *srgb { crate::texture::srgb8_to_linear(v) } else { f32::from(v) / 255.0 }
                };
                Vec3::new(decode(data[i][0]), decode(data[i][1]), decode(data[i][2]))
            }
        };
        let color = color.max(Vec3::ZERO).min(Vec3::splat(1e9)) * self.scale;
        if color.is_finite() { color } else { Vec3::ZERO }
    }

    /// Corners of cell (`row`, `column`): it lies between pixel rows `row` and `row + 1` (the same where there is but one)
    /// and between pixel columns `column` and `column + 1` (wrapped).
    fn corners(&self, row: usize, column: usize) -> [Vec3; 4] {
        let (top, bottom) = (row, (row + 1).min(self.bitmap.height as usize - 1));
        let right = (column + 1) % self.width;
        [self.pixel(top, column), self.pixel(top, right), self.pixel(bottom, column), self.pixel(bottom, right)]
    }

    /// Latitudes (0 at the upper pole) that bound a row of cells.
    fn row_bounds(&self, row: usize) -> [f32; 2] {
        let rows = self.rows as f32;
        [row as f32 / rows * PI, (row as f32 + 1.0) / rows * PI]
    }

    /// Solid angle of one cell of a row.
    fn row_solid_angle(&self, row: usize) -> f32 {
        let [top, bottom] = self.row_bounds(row);
        (TAU / self.width as f32) * (libm::cosf(top) - libm::cosf(bottom))
    }

    /// Cell and position inside it, for texture coordinates (u, v) with v down from the pole.
    fn cell(&self, u: f32, v: f32) -> (usize, usize, f32, f32) {
        let x = u * self.width as f32 - 0.5;
        let x = if x < 0.0 { x + self.width as f32 } else { x };
        let y = v * self.rows as f32;
        let (column, row) = ((x as usize).min(self.width - 1), (y as usize).min(self.rows - 1));
        (row, column, (x - column as f32).clamp(0.0, 1.0), (y - row as f32).clamp(0.0, 1.0))
    }

    fn coordinates(&self, dir: Vec3) -> (f32, f32) {
        let d = self.to_local * dir;
        let u = libm::atan2f(d.x, -d.z) / TAU;
        let u = if u < 0.0 { u + 1.0 } else { u };
        (u, libm::acosf(d.y.clamp(-1.0, 1.0)) * FRAC_1_PI)
    }

    fn radiance(&self, dir: Vec3) -> Vec3 {
        let (u, v) = self.coordinates(dir);
        let (row, column, fx, fy) = self.cell(u, v);
        let [a, b, c, d] = self.corners(row, column);
        (a * (1.0 - fx) + b * fx) * (1.0 - fy) + (c * (1.0 - fx) + d * fx) * fy
    }

    fn sample(&self, bin: usize, choice: f32, u: [f32; 2]) -> (Vec3, f32) {
        let (cells, table) = &self.bins[bin];
        let (slot, probability, _) = table.sample(choice);
        let (row, column) = (cells[slot] as usize / self.width, cells[slot] as usize % self.width);
        (self.direction(row, column, u), probability / self.row_solid_angle(row))
    }

    /// A direction uniform over a cell.
    fn direction(&self, row: usize, column: usize, u: [f32; 2]) -> Vec3 {
        let [top, bottom] = self.row_bounds(row);
        let (cos_top, cos_bottom) = (libm::cosf(top), libm::cosf(bottom));
        let y = cos_top + (cos_bottom - cos_top) * u[1];
        let r = (1.0 - y * y).max(0.0).sqrt();
        let phi = (column as f32 + 0.5 + u[0]) / self.width as f32 * TAU;
        self.to_world * Vec3::new(r * libm::sinf(phi), y, -r * libm::cosf(phi))
    }

    fn find(&self, dir: Vec3) -> (usize, f32) {
        let (u, v) = self.coordinates(dir);
        let (row, column, ..) = self.cell(u, v);
        let bin = SkyView::bin(self.direction(row, column, [0.5, 0.5]));
        (bin, self.chances[row * self.width + column] / self.row_solid_angle(row))
    }
}

#[cfg(test)]
mod tests {
    use super::super::area::uniform_sphere;
    use super::*;
    use photinus_geometry::Affine3A;

    fn picture() -> Environment {
        let (width, height) = (16u32, 8u32);
        let data = (0..width * height)
            .map(|i| {
                let bright = if i == 37 { 50.0 } else { 0.1 + (i % 5) as f32 };
                [bright, 0.5 * bright, 0.2, 1.0]
            })
            .collect();
        let bitmap = Arc::new(Bitmap { width, height, pixels: BitmapPixels::RgbaF32(data) });
        let to_world = Affine3A::from_rotation_y(0.7) * Affine3A::from_rotation_x(-0.4);
        Environment::new(&EnvironmentLight::Image { bitmap, scale: 2.0, to_world })
    }

    /// Rows have their latitudes from pole to pole, columns the middles of their pixels, as in Mitsuba 3.
    #[test]
    fn pixels_lie_where_mitsuba_puts_them() {
        let grey = |v: f32| [v, v, v, 1.0];
        let data = (0..3).flat_map(|row| (0..4).map(move |column| grey((10 * row + column) as f32))).collect();
        let bitmap = Arc::new(Bitmap { width: 4, height: 3, pixels: BitmapPixels::RgbaF32(data) });
        let to_world = Affine3A::IDENTITY;
        let sky = Environment::new(&EnvironmentLight::Image { bitmap, scale: 1.0, to_world });
        let looking = |u: f32, v: f32| {
            let (phi, theta) = (u * TAU, v * PI);
            let r = libm::sinf(theta);
            sky.radiance(Vec3::new(r * libm::sinf(phi), libm::cosf(theta), -r * libm::cosf(phi))).x
        };
        for (u, v, expected) in [
            (0.125, 0.5, 10.0),
            (0.375, 0.5, 11.0),
            (0.25, 0.5, 10.5),
            (0.0, 0.5, 11.5),
            (0.625, 0.001, 2.0),
            (0.625, 0.25, 7.0),
            (0.625, 0.75, 17.0),
            (0.625, 0.999, 22.0),
        ] {
            let found = looking(u, v);
            assert!((found - expected).abs() < 0.03, "{u} {v}: {found}, not {expected}");
        }
        let single = Arc::new(Bitmap { width: 1, height: 1, pixels: BitmapPixels::RgbaF32(vec![grey(3.0)]) });
        let sky = Environment::new(&EnvironmentLight::Image { bitmap: single, scale: 1.0, to_world });
        assert_eq!(sky.radiance(Vec3::Y).x, 3.0);
    }

    /// The estimator radiance / pdf has the mean radiance times 4 pi as its expectation, whatever the picture.
    #[test]
    fn samples_have_the_density_that_pdf_states() {
        for environment in [picture(), Environment::new(&EnvironmentLight::Constant(Vec3::new(1.0, 2.0, 3.0)))] {
            let bins = AliasTable::new(&environment.bin_powers());
            let n = 1 << 17;
            let mut strays = 0;
            let (mut sum, mut uniform) = (Vec3::ZERO, Vec3::ZERO);
            for i in 0..n {
                let mut s = photinus_num::Sampler::new(3, photinus_num::StreamKind::Test, 0, i);
                let (bin, chance, rest) = bins.sample(s.next_1d());
                let (dir, pdf) = environment.sample(bin, rest, s.next_2d());
                assert!((dir.length() - 1.0).abs() < 1e-5);
                let (found, again) = environment.find(dir);
                // On the border of two cells rounding may name the other one.
                strays += u32::from(found != bin || (again - pdf).abs() > 1e-2 * pdf);
                sum += environment.radiance(dir) / (pdf * chance);
                uniform += environment.radiance(uniform_sphere(s.next_2d()));
            }
            assert!(strays < n / 10_000, "{strays}");
            let expected = environment.mean() * 4.0 * PI;
            let (sum, uniform) = (sum / n as f32, uniform * (4.0 * PI / n as f32));
            assert!((sum / expected - 1.0).abs().max_element() < 0.02, "{sum} {expected}");
            assert!((uniform / expected - 1.0).abs().max_element() < 0.05, "{uniform} {expected}");
        }
    }
}
