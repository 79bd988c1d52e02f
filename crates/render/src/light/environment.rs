//! Light from infinity: look-up, and directions in proportion to radiance.

use super::alias::AliasTable;
use super::sky_view::SkyView;
use photinus_geometry::{Mat3, Vec3};
use photinus_scene::{Bitmap, BitmapPixels, EnvironmentLight};
use std::f32::consts::{FRAC_1_PI, PI, TAU};
use std::sync::Arc;

/// Density over the solid angle of one bin of a [`SkyView`].
const BIN_DENSITY: f32 = SkyView::BINS as f32 * 0.25 * FRAC_1_PI;

/// An environment ready to be looked up and sampled.
pub(crate) enum Environment {
    /// Radiance, and the choice among the bins of a [`SkyView`].
    Constant(Vec3, AliasTable),
    Image(Box<ImageEnvironment>),
}

/// An equirectangular picture, bilinear between pixel middles.
pub(crate) struct ImageEnvironment {
    bitmap: Arc<Bitmap>,
    scale: f32,
    to_world: Mat3,
    to_local: Mat3,
    /// Over the cells between pixel middles, by mean luminance of the corners times the cell's solid angle.
    cells: AliasTable,
    width: usize,
    height: usize,
    mean: Vec3,
}

impl Environment {
    /// Prepares `light`; directions that `view` finds blocked are chosen rarely.
    pub fn new(light: &EnvironmentLight, view: &SkyView) -> Self {
        match light {
            EnvironmentLight::Constant(radiance) => {
                let weights: Vec<f64> = (0..SkyView::BINS).map(|bin| f64::from(view.factor_of(bin))).collect();
                Self::Constant(*radiance, AliasTable::new(&weights))
            }
            EnvironmentLight::Image { bitmap, scale, to_world } => {
                Self::Image(Box::new(ImageEnvironment::new(bitmap.clone(), *scale, Mat3::from(to_world.matrix3), view)))
            }
        }
    }

    /// Radiance that arrives along `dir`, seen looking in direction `dir` (unit, world).
    pub fn radiance(&self, dir: Vec3) -> Vec3 {
        match self {
            Self::Constant(radiance, _) => *radiance,
            Self::Image(image) => image.radiance(dir),
        }
    }

    /// Mean radiance over all directions.
    pub fn mean(&self) -> Vec3 {
        match self {
            Self::Constant(radiance, _) => *radiance,
            Self::Image(image) => image.mean,
        }
    }

    /// A direction to look in and its density over solid angle.
    pub fn sample(&self, choice: f32, u: [f32; 2]) -> (Vec3, f32) {
        match self {
            Self::Constant(_, bins) => {
                let (bin, probability, _) = bins.sample(choice);
                (SkyView::direction(bin, u), probability * BIN_DENSITY)
            }
            Self::Image(image) => image.sample(choice, u),
        }
    }

    /// Density of [`Environment::sample`] over solid angle.
    pub fn pdf(&self, dir: Vec3) -> f32 {
        match self {
            Self::Constant(_, bins) => bins.probability(SkyView::bin(dir)) * BIN_DENSITY,
            Self::Image(image) => image.pdf(dir),
        }
    }

    /// Bytes of the sampling tables.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Constant(..) => SkyView::BINS * 12,
            Self::Image(image) => image.width * (image.height + 1) * 12,
        }
    }
}

impl ImageEnvironment {
    fn new(bitmap: Arc<Bitmap>, scale: f32, matrix: Mat3, view: &SkyView) -> Self {
        // Only the rotation matters: the columns are made orthonormal.
        let x = matrix.x_axis.try_normalize().unwrap_or(Vec3::X);
        let y = (matrix.y_axis - x * x.dot(matrix.y_axis)).try_normalize().unwrap_or(Vec3::Y);
        let z = x.cross(y);
        let z = if z.dot(matrix.z_axis) < 0.0 { -z } else { z };
        let to_world = Mat3::from_cols(x, y, z);
        let (width, height) = (bitmap.width as usize, bitmap.height as usize);
        let mut image = Self {
            bitmap,
            scale,
            to_world,
            to_local: to_world.transpose(),
            cells: AliasTable::default(),
            width,
            height,
            mean: Vec3::ZERO,
        };
        let mut weights = Vec::with_capacity(width * (height + 1));
        let mut mean = [0.0f64; 3];
        for row in 0..=height {
            let solid_angle = f64::from(image.row_solid_angle(row));
            for column in 0..width {
                let corners = image.corners(row, column);
                let color = (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25;
                for c in 0..3 {
                    mean[c] += f64::from(color[c]) * solid_angle;
                }
                let middle = image.direction(row, column, [0.5, 0.5]);
                let chance = color.max_element().max(0.0) * view.factor(middle);
                weights.push(f64::from(chance) * solid_angle);
            }
        }
        image.mean = Vec3::from(mean.map(|m| (m / (4.0 * std::f64::consts::PI)) as f32));
        image.cells = AliasTable::new(&weights);
        image
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

    /// Corners of cell (`row`, `column`): it lies between pixel rows `row - 1` and `row` (clamped) and between pixel
    /// columns `column` and `column + 1` (wrapped).
    fn corners(&self, row: usize, column: usize) -> [Vec3; 4] {
        let (top, bottom) = (row.max(1) - 1, row.min(self.height - 1));
        let right = (column + 1) % self.width;
        [self.pixel(top, column), self.pixel(top, right), self.pixel(bottom, column), self.pixel(bottom, right)]
    }

    /// Latitudes (0 at the pole) that bound a row of cells; the first and the last are half as high.
    fn row_bounds(&self, row: usize) -> [f32; 2] {
        let h = self.height as f32;
        [((row as f32 - 0.5) / h).max(0.0) * PI, ((row as f32 + 0.5) / h).min(1.0) * PI]
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
        let y = v * self.height as f32 + 0.5;
        let (column, row) = ((x as usize).min(self.width - 1), (y as usize).min(self.height));
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

    fn sample(&self, choice: f32, u: [f32; 2]) -> (Vec3, f32) {
        let (cell, probability, _) = self.cells.sample(choice);
        let (row, column) = (cell / self.width, cell % self.width);
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

    fn pdf(&self, dir: Vec3) -> f32 {
        let (u, v) = self.coordinates(dir);
        let (row, column, ..) = self.cell(u, v);
        self.cells.probability(row * self.width + column) / self.row_solid_angle(row)
    }
}

#[cfg(test)]
mod tests {
    use super::super::area::uniform_sphere;
    use super::*;
    use photinus_geometry::Affine3A;

    /// A window in one direction.
    fn view() -> SkyView {
        let mut view = SkyView::new();
        (0..500).for_each(|i| view.add(SkyView::direction(i % 60 + 100, [0.5, 0.5]), true));
        view
    }

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
        Environment::new(&EnvironmentLight::Image { bitmap, scale: 2.0, to_world }, &view())
    }

    /// The estimator radiance / pdf has the mean radiance times 4 pi as its expectation, whatever the picture.
    #[test]
    fn samples_have_the_density_that_pdf_states() {
        for environment in [picture(), Environment::new(&EnvironmentLight::Constant(Vec3::new(1.0, 2.0, 3.0)), &view())]
        {
            let n = 1 << 17;
            let (mut sum, mut uniform) = (Vec3::ZERO, Vec3::ZERO);
            for i in 0..n {
                let mut s = photinus_num::Sampler::new(3, photinus_num::StreamKind::Test, 0, i);
                let (dir, pdf) = environment.sample(s.next_1d(), s.next_2d());
                assert!((dir.length() - 1.0).abs() < 1e-5);
                let again = environment.pdf(dir);
                assert!((again - pdf).abs() <= 1e-2 * pdf, "{pdf} {again}");
                sum += environment.radiance(dir) / pdf;
                uniform += environment.radiance(uniform_sphere(s.next_2d()));
            }
            let expected = environment.mean() * 4.0 * PI;
            let (sum, uniform) = (sum / n as f32, uniform * (4.0 * PI / n as f32));
            assert!((sum / expected - 1.0).abs().max_element() < 0.02, "{sum} {expected}");
            assert!((uniform / expected - 1.0).abs().max_element() < 0.05, "{uniform} {expected}");
        }
    }
}
