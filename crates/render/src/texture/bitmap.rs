//! Pictures with a pyramid of smaller copies, read by nearest pixel, bilinear or trilinear interpolation.

use super::{linear_to_srgb8, srgb8_to_linear, unit8_to_linear};
use arrayvec::ArrayVec;
use photinus_geometry::{Vec2, Vec4};
use photinus_scene::{Bitmap, BitmapPixels, TextureFilter, WrapMode};
use rayon::prelude::*;
use std::sync::Arc;

/// Rows of a level that one task makes.
const ROWS_A_TASK: usize = 16;

/// A picture and its pyramid: level 0 is the picture, each further level about half as wide and high, down to 1 x 1.
#[derive(Clone, Debug)]
pub struct MipMap {
    levels: Vec<Arc<Bitmap>>,
    /// The root of the picture's pixels.
    side: f32,
}

/// RGBA of the pixels (x, y), which must lie inside.
#[inline]
fn texels<const N: usize>(bitmap: &Bitmap, pixels: [(u32, u32); N]) -> [Vec4; N] {
    let indices = pixels.map(|(x, y)| y as usize * bitmap.width as usize + x as usize);
    match &bitmap.pixels {
        BitmapPixels::Rgba8 { data, srgb: true } => indices.map(|i| data[i]).map(from_srgb),
        BitmapPixels::Rgba8 { data, srgb: false } => indices.map(|i| data[i]).map(from_bytes),
        BitmapPixels::RgbaF32(data) => indices.map(|i| Vec4::from_array(data[i])),
    }
}

#[inline]
fn from_srgb([r, g, b, a]: [u8; 4]) -> Vec4 {
    Vec4::new(srgb8_to_linear(r), srgb8_to_linear(g), srgb8_to_linear(b), unit8_to_linear(a))
}

#[inline]
fn from_bytes([r, g, b, a]: [u8; 4]) -> Vec4 {
    Vec4::new(f32::from(r), f32::from(g), f32::from(b), f32::from(a)) / 255.0
}

/// Whether the pixel array has the length that width and height promise.
fn is_sound(bitmap: &Bitmap) -> bool {
    let pixels = match &bitmap.pixels {
        BitmapPixels::Rgba8 { data, .. } => data.len(),
        BitmapPixels::RgbaF32(data) => data.len(),
    };
    bitmap.width >= 1 && bitmap.height >= 1 && pixels == bitmap.width as usize * bitmap.height as usize
}

/// The source pixels of a pixel of the next level, and the share of each: at most four, as no level is less than a
/// third of the one above.
type Taps = ArrayVec<(u32, f32), 4>;

/// The taps of each of `to` pixels, where `from` pixels shrink to them.
fn box_taps(from: u32, to: u32) -> Vec<Taps> {
    let ratio = f64::from(from) / f64::from(to);
    let taps = |i: u32| {
        let (start, end) = (f64::from(i) * ratio, f64::from(i + 1) * ratio);
        let last = (end.ceil() as u32).min(from);
        let share = |x: u32| {
            let overlap = end.min(f64::from(x) + 1.0) - start.max(f64::from(x));
            (overlap > 1e-9).then_some((x, (overlap / ratio) as f32))
        };
        (start as u32..last).filter_map(share).collect()
    };
    (0..to).map(taps).collect()
}

/// The next smaller level: every pixel is the mean of the area that it covers.
fn halve(from: &Bitmap) -> Bitmap {
    let (width, height) = ((from.width / 2).max(1), (from.height / 2).max(1));
    let from_size = [from.width, from.height];
    let size = [width, height];
    let mean = |[a, b, c, d]: [Vec4; 4]| a * 0.25 + b * 0.25 + c * 0.25 + d * 0.25;
    let pixels = match &from.pixels {
        BitmapPixels::Rgba8 { data, srgb: true } => {
            let encoded = |p: Vec4| [linear_to_srgb8(p.x), linear_to_srgb8(p.y), linear_to_srgb8(p.z), byte(p.w)];
            BitmapPixels::Rgba8 { data: means(data, from_size, size, from_srgb, encoded, srgb_of_four), srgb: true }
        }
        BitmapPixels::Rgba8 { data, srgb: false } => {
            let bytes = |p: Vec4| p.to_array().map(byte);
            let of_four = |four: [_; 4]| bytes(mean(four.map(from_bytes)));
            BitmapPixels::Rgba8 { data: means(data, from_size, size, from_bytes, bytes, of_four), srgb: false }
        }
        BitmapPixels::RgbaF32(data) => {
            let of_four = |four: [_; 4]| mean(four.map(Vec4::from_array)).to_array();
            BitmapPixels::RgbaF32(means(data, from_size, size, Vec4::from_array, |p| p.to_array(), of_four))
        }
    };
    Bitmap { width, height, pixels }
}

/// The mean of four sRGB pixels: that of [`means`], for less by channels than by vectors of them.
fn srgb_of_four(pixels: [[u8; 4]; 4]) -> [u8; 4] {
    let mean = |channel: usize, read: fn(u8) -> f32| {
        let [a, b, c, d] = pixels.map(|pixel| read(pixel[channel]));
        0.25 * (a + b + c + d)
    };
    let [r, g, b] = [0, 1, 2].map(|channel| linear_to_srgb8(mean(channel, srgb8_to_linear)));
    [r, g, b, byte(mean(3, unit8_to_linear))]
}

fn byte(v: f32) -> u8 {
    (v * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

/// The means of the areas of a picture that the pixels of one of another size cover; `read` and `write` know how pixels are
/// stored, and `of_four` what the mean of four of them is.
fn means<T: Copy + Default + Send + Sync>(
    from: &[T],
    from_size: [u32; 2],
    size: [u32; 2],
    read: impl Fn(T) -> Vec4 + Sync,
    write: impl Fn(Vec4) -> T + Sync,
    of_four: impl Fn([T; 4]) -> T + Sync,
) -> Vec<T> {
    let (columns, rows) = (box_taps(from_size[0], size[0]), box_taps(from_size[1], size[1]));
    let (from_width, width) = (from_size[0] as usize, size[0] as usize);
    let is_even = from_size == size.map(|pixels| 2 * pixels);
    let mut data = vec![T::default(); width * size[1] as usize];
    data.par_chunks_exact_mut(width).zip(&rows).with_min_len(ROWS_A_TASK).for_each(|(line, row)| {
        let above = |y: u32| &from[y as usize * from_width..][..from_width];
        // Most pictures halve evenly.
        if let (&[(y0, _), (y1, _)], true) = (row.as_slice(), is_even) {
            let pairs = above(y0).as_chunks::<2>().0.iter().zip(above(y1).as_chunks::<2>().0);
            line.iter_mut().zip(pairs).for_each(|(out, (&[a, b], &[c, d]))| *out = of_four([a, b, c, d]));
            return;
        }
        for (out, column) in line.iter_mut().zip(&columns) {
            let mut sum = Vec4::ZERO;
            for &(y, wy) in row {
                for &(x, wx) in column {
                    sum += read(above(y)[x as usize]) * (wx * wy);
                }
            }
            *out = write(sum);
        }
    });
    data
}

/// The largest whole number that is not above `x`, for finite `x`: the processor that the build is for has no instruction for
/// it, but one that cuts off.
#[inline]
fn floor(x: f32) -> f32 {
    // From here on every number is whole.
    const WHOLE: f32 = 8_388_608.0;
    if x.abs() >= WHOLE {
        return x;
    }
    let cut = x as i32 as f32;
    if cut > x { cut - 1.0 } else { cut }
}

/// A coordinate folded into 0..=1 by the wrap mode; 0 where it is not finite.
#[inline]
fn wrap_unit(x: f32, wrap: WrapMode) -> f32 {
    if !x.is_finite() {
        return 0.0;
    }
    match wrap {
        WrapMode::Repeat => x - floor(x),
        WrapMode::Mirror => {
            let t = x - 2.0 * floor(0.5 * x);
            if t > 1.0 { 2.0 - t } else { t }
        }
        WrapMode::Clamp => x.clamp(0.0, 1.0),
    }
}

/// A pixel index at most one outside `0..count` brought back by the wrap mode.
#[inline]
fn wrap_index(i: i32, count: u32, wrap: WrapMode) -> u32 {
    match wrap {
        WrapMode::Repeat if i < 0 => count - 1,
        WrapMode::Repeat if i >= count as i32 => 0,
        WrapMode::Repeat => i as u32,
        WrapMode::Mirror | WrapMode::Clamp => i.clamp(0, count as i32 - 1) as u32,
    }
}

impl MipMap {
    /// Builds the pyramid; a bitmap whose arrays do not fit its size reads as mid-grey.
    pub fn new(bitmap: &Arc<Bitmap>) -> Self {
        if !is_sound(bitmap) {
            return Self::of(vec![grey()]);
        }
        let mut levels = vec![Arc::clone(bitmap)];
        while let Some(last) = levels.last()
            && (last.width > 1 || last.height > 1)
        {
            let next = halve(last);
            levels.push(Arc::new(next));
        }
        Self::of(levels)
    }

    /// Only the picture itself, for textures that are read by the nearest pixel.
    pub fn without_pyramid(bitmap: &Arc<Bitmap>) -> Self {
        Self::of(vec![if is_sound(bitmap) { Arc::clone(bitmap) } else { grey() }])
    }

    fn of(levels: Vec<Arc<Bitmap>>) -> Self {
        let side = (levels[0].width as f32 * levels[0].height as f32).sqrt();
        Self { levels, side }
    }

    /// Columns and rows of the picture.
    pub fn size(&self) -> [u32; 2] {
        [self.levels[0].width, self.levels[0].height]
    }

    /// Bytes of the pyramid without the picture itself, which is shared with the scene.
    pub fn bytes(&self) -> usize {
        self.levels.iter().skip(1).map(|level| level.bytes()).sum()
    }

    /// RGBA at `uv` (v = 0: the bottom row), averaged over about `footprint`, the width of the pixel's footprint in
    /// texture coordinates; 0: the full picture.
    pub fn lookup(&self, uv: Vec2, footprint: f32, filter: TextureFilter, wrap: WrapMode) -> Vec4 {
        let (u, v) = (wrap_unit(uv.x, wrap), 1.0 - wrap_unit(uv.y, wrap));
        if filter == TextureFilter::Nearest {
            return nearest(&self.levels[0], u, v, wrap);
        }
        // The root of the pixels that the footprint covers: pictures of long planks are stretched as their pixels are.
        let texels = footprint * self.side;
        // The comparison is false for NaN: the base level then.
        if !(texels > 1.0) {
            return bilinear(&self.levels[0], u, v, wrap);
        }
        let last = self.levels.len() - 1;
        let level = libm::log2f(texels).min(last as f32);
        let below = level as usize;
        let fraction = level - below as f32;
        let fine = bilinear(&self.levels[below], u, v, wrap);
        if fraction == 0.0 {
            return fine;
        }
        let coarse = bilinear(&self.levels[(below + 1).min(last)], u, v, wrap);
        fine + (coarse - fine) * fraction
    }
}

/// What pictures show whose arrays do not fit their size.
fn grey() -> Arc<Bitmap> {
    let pixels = BitmapPixels::RgbaF32(vec![[0.5, 0.5, 0.5, 1.0]]);
    Arc::new(Bitmap { width: 1, height: 1, pixels })
}

/// At (u, v) in 0..=1, v = 0: the top row.
fn nearest(bitmap: &Bitmap, u: f32, v: f32, wrap: WrapMode) -> Vec4 {
    let (x, y) = (u * bitmap.width as f32, v * bitmap.height as f32);
    // v on a row's lower edge belongs to that row: rows are counted from the top, so round down from above.
    let row = y.ceil() as i32 - 1;
    let column = x as i32;
    let [pixel] = texels(bitmap, [(wrap_index(column, bitmap.width, wrap), wrap_index(row, bitmap.height, wrap))]);
    pixel
}

/// At (u, v) in 0..=1, v = 0: the top row.
#[inline]
fn bilinear(bitmap: &Bitmap, u: f32, v: f32, wrap: WrapMode) -> Vec4 {
    let (x, y) = (u * bitmap.width as f32 - 0.5, v * bitmap.height as f32 - 0.5);
    let (x0, y0) = (floor(x), floor(y));
    let (fx, fy) = (x - x0, y - y0);
    let [left, right] = [x0 as i32, x0 as i32 + 1].map(|i| wrap_index(i, bitmap.width, wrap));
    let [upper, lower] = [y0 as i32, y0 as i32 + 1].map(|i| wrap_index(i, bitmap.height, wrap));
    let [a, b, c, d] = texels(bitmap, [(left, upper), (right, upper), (left, lower), (right, lower)]);
    let top = a * (1.0 - fx) + b * fx;
    let bottom = c * (1.0 - fx) + d * fx;
    top * (1.0 - fy) + bottom * fy
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32) -> Arc<Bitmap> {
        let data = (0..width * height).map(|i| [i as f32, (i % width) as f32, (i / width) as f32, 1.0]).collect();
        Arc::new(Bitmap { width, height, pixels: BitmapPixels::RgbaF32(data) })
    }

    #[test]
    fn the_bottom_row_is_at_v_zero() {
        let map = MipMap::new(&ramp(4, 4));
        let at = |u, v| map.lookup(Vec2::new(u, v), 0.0, TextureFilter::Nearest, WrapMode::Repeat);
        assert_eq!(at(0.01, 0.01).x, 12.0);
        assert_eq!(at(0.99, 0.99).x, 3.0);
        assert_eq!(at(0.25, 0.25).x, 9.0, "a pixel owns its left and lower edge");
        let middle = map.lookup(Vec2::new(0.125, 0.125), 0.0, TextureFilter::Bilinear, WrapMode::Repeat);
        assert_eq!(middle.x, 12.0, "bilinear is exact in the middle of a pixel");
    }

    #[test]
    fn bilinear_is_linear_between_centres() {
        let map = MipMap::new(&ramp(8, 8));
        for i in 0..40 {
            let u = 0.0625 + 0.875 * i as f32 / 39.0;
            let c = map.lookup(Vec2::new(u, 0.5), 0.0, TextureFilter::Bilinear, WrapMode::Clamp);
            assert!((c.y - (u * 8.0 - 0.5)).abs() < 1e-4, "{u}: {c}");
        }
    }

    #[test]
    fn wrap_modes() {
        let map = MipMap::new(&ramp(4, 1));
        let at = |u: f32, wrap| map.lookup(Vec2::new(u, 0.5), 0.0, TextureFilter::Nearest, wrap).x;
        for (u, repeat, mirror, clamp) in [
            (0.1, 0.0, 0.0, 0.0),
            (1.1, 0.0, 3.0, 3.0),
            (-0.1, 3.0, 0.0, 0.0),
            (2.3, 1.0, 1.0, 3.0),
            (1.3, 1.0, 2.0, 3.0),
        ] {
            assert_eq!(at(u, WrapMode::Repeat), repeat, "{u}");
            assert_eq!(at(u, WrapMode::Mirror), mirror, "{u}");
            assert_eq!(at(u, WrapMode::Clamp), clamp, "{u}");
        }
    }

    #[test]
    fn every_level_keeps_the_mean() {
        for (w, h) in [(7, 5), (8, 8), (1, 13), (300, 2), (1, 1)] {
            let bitmap = ramp(w, h);
            let map = MipMap::new(&bitmap);
            let mean = (0..w * h).map(|i| i as f32).sum::<f32>() / (w * h) as f32;
            let top = map.lookup(Vec2::new(0.3, 0.3), 1e9, TextureFilter::Bilinear, WrapMode::Repeat);
            assert!((top.x - mean).abs() < 1e-3 * mean.max(1.0), "{w} x {h}: {top} against {mean}");
        }
    }

    #[test]
    fn srgb_bytes_are_averaged_as_light() {
        let data = vec![[0, 0, 0, 0], [255, 255, 255, 255]];
        let bitmap = Arc::new(Bitmap { width: 2, height: 1, pixels: BitmapPixels::Rgba8 { data, srgb: true } });
        let c = MipMap::new(&bitmap).lookup(Vec2::ZERO, 1.0, TextureFilter::Bilinear, WrapMode::Repeat);
        assert!((c.x - 0.5).abs() < 0.005 && (c.w - 0.5).abs() < 0.005, "{c}");
    }

    /// Rows and columns of two each have a path of their own: the same sums.
    #[test]
    fn even_pictures_halve_as_others_do() {
        for (width, height) in [(8, 6), (8, 1), (64, 40)] {
            let data: Vec<[u8; 4]> =
                (0..width * height).map(|i| [i, 7 * i, 31 * i, 255 - i].map(|x| x as u8)).collect();
            let from = Bitmap { width, height, pixels: BitmapPixels::Rgba8 { data, srgb: true } };
            let half = halve(&from);
            let (columns, rows) = (box_taps(width, half.width), box_taps(height, half.height));
            for (y, row) in rows.iter().enumerate() {
                for (x, column) in columns.iter().enumerate() {
                    let mut sum = Vec4::ZERO;
                    for (y, wy) in row {
                        column.iter().for_each(|(x, wx)| sum += texels(&from, [(*x, *y)])[0] * (wx * wy));
                    }
                    let byte = (sum.w * 255.0 + 0.5) as u8;
                    let expected =
                        from_srgb([linear_to_srgb8(sum.x), linear_to_srgb8(sum.y), linear_to_srgb8(sum.z), byte]);
                    assert_eq!(texels(&half, [(x as u32, y as u32)]), [expected], "{width} x {height}, {x} {y}");
                }
            }
        }
    }

    #[test]
    fn odd_coordinates_are_safe() {
        let map = MipMap::new(&ramp(5, 3));
        let odd =
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, 1e9, -0.0, 1.0, 16_777_217.0, f32::MIN_POSITIVE];
        for u in odd {
            for v in odd {
                for footprint in odd {
                    for wrap in [WrapMode::Repeat, WrapMode::Mirror, WrapMode::Clamp] {
                        for filter in [TextureFilter::Nearest, TextureFilter::Bilinear] {
                            assert!(map.lookup(Vec2::new(u, v), footprint, filter, wrap).is_finite());
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_bitmap_of_the_wrong_length_is_grey() {
        let bitmap = Arc::new(Bitmap { width: 9, height: 9, pixels: BitmapPixels::RgbaF32(vec![]) });
        let c = MipMap::new(&bitmap).lookup(Vec2::ZERO, 0.0, TextureFilter::Bilinear, WrapMode::Repeat);
        assert_eq!(c.x, 0.5);
    }
}
