//! Values of options that are more than a word: numbers in a range, sizes, cameras, windows.

use std::path::PathBuf;

/// Pixels across and down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

/// A view: origin, target, up and the opening in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraValue {
    /// Position.
    pub origin: [f32; 3],
    /// A point in the middle of the picture.
    pub target: [f32; 3],
    /// Up in the picture.
    pub up: [f32; 3],
    /// Full opening in degrees.
    pub fov_degrees: f32,
}

/// Most pixels of a picture's edge.
const MAX_EDGE: u32 = 65_536;
/// Most pixels of a picture.
const MAX_PIXELS: u64 = 1 << 28;

/// `WxH`.
pub fn size(text: &str) -> Result<Size, String> {
    let (width, height) = text.split_once(['x', 'X']).ok_or("write it as WIDTHxHEIGHT, as in 800x600")?;
    let edge = |text: &str| match text.trim().parse::<u32>() {
        Ok(edge @ 1..=MAX_EDGE) => Ok(edge),
        _ => Err(format!("{text} is no number of pixels from 1 to {MAX_EDGE}")),
    };
    let size = Size { width: edge(width)?, height: edge(height)? };
    if u64::from(size.width) * u64::from(size.height) > MAX_PIXELS {
        return Err(format!("a picture has at most {MAX_PIXELS} pixels"));
    }
    Ok(size)
}

/// A number from 0 to 1.
pub fn part(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if (0.0..=1.0).contains(&x) => Ok(x),
        _ => Err("it must be a number from 0 to 1".into()),
    }
}

/// `X,Y,W,H` in pixels.
pub fn crop(text: &str) -> Result<[u32; 4], String> {
    let window: [u32; 4] = numbers(text).ok_or("write it as X,Y,WIDTH,HEIGHT in pixels, as in 100,50,320,240")?;
    if window[2] == 0 || window[3] == 0 { Err("the window is empty".into()) } else { Ok(window) }
}

/// Three numbers that are not all zero.
pub fn direction(text: &str) -> Result<[f32; 3], String> {
    let direction: [f32; 3] = numbers(text).ok_or("write three numbers, as in 0,-1,0.5")?;
    let good = direction.iter().all(|x| x.is_finite()) && direction != [0.0; 3];
    if good { Ok(direction) } else { Err("the numbers must be finite, and one of them other than zero".into()) }
}

/// Six numbers: the lower and the upper corner of a box with a volume.
pub fn corners(text: &str) -> Result<[f32; 6], String> {
    let corners: [f32; 6] = numbers(text).ok_or("write six numbers: the lower corner x,y,z and the upper one")?;
    let good = corners.iter().all(|x| x.is_finite()) && (0..3).all(|k| corners[k] < corners[3 + k]);
    if good { Ok(corners) } else { Err("every number of the lower corner must be less than that of the upper".into()) }
}

/// Ten numbers: origin, target, up, opening in degrees.
pub fn camera(text: &str) -> Result<CameraValue, String> {
    const FORM: &str = "write ten numbers: origin x,y,z, target x,y,z, up x,y,z and the opening in degrees";
    let [ox, oy, oz, tx, ty, tz, ux, uy, uz, fov_degrees]: [f32; 10] = numbers(text).ok_or(FORM)?;
    let camera = CameraValue { origin: [ox, oy, oz], target: [tx, ty, tz], up: [ux, uy, uz], fov_degrees };
    let all = [ox, oy, oz, tx, ty, tz, ux, uy, uz, fov_degrees];
    if !all.iter().all(|x| x.is_finite()) {
        Err("every number must be finite".into())
    } else if !(fov_degrees > 0.0 && fov_degrees < 180.0) {
        Err(format!("the opening, {fov_degrees}, must lie between 0 and 180 degrees"))
    } else if camera.origin == camera.target {
        Err("origin and target are the same point".into())
    } else if parallel(&camera) {
        Err("up is parallel to the view, or zero".into())
    } else {
        Ok(camera)
    }
}

/// Whether up says nothing about what is up.
fn parallel(camera: &CameraValue) -> bool {
    let view: [f64; 3] = std::array::from_fn(|i| f64::from(camera.target[i]) - f64::from(camera.origin[i]));
    let up = camera.up.map(f64::from);
    let cross =
        [view[1] * up[2] - view[2] * up[1], view[2] * up[0] - view[0] * up[2], view[0] * up[1] - view[1] * up[0]];
    let length_sq = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    // The sine of the angle between them is at most 1e-6.
    !(length_sq(cross) > 1e-12 * length_sq(view) * length_sq(up))
}

fn numbers<T: std::str::FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let numbers: Option<Vec<T>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// The file of a drawing, of a kind that its name tells.
pub fn drawing(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("png" | "svg") => Ok(path),
        _ => Err("its name must end in .png or .svg".into()),
    }
}

/// A finite number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("it must be a number above 0".into()),
    }
}

/// A finite number above zero that f32 can hold.
pub fn positive_f32(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("it must be a number above 0".into()),
    }
}

/// A finite number.
pub fn finite_f32(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err("it must be a finite number".into()),
    }
}

/// A whole number from 1 to 2^31 - 1.
pub fn count(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(n) if (1..=i32::MAX as u32).contains(&n) => Ok(n),
        _ => Err(format!("it must be a whole number from 1 to {}", i32::MAX)),
    }
}

/// A number of threads.
pub fn threads(text: &str) -> Result<usize, String> {
    const MOST: usize = 1024;
    match text.parse::<usize>() {
        Ok(n) if (1..=MOST).contains(&n) => Ok(n),
        _ => Err(format!("it must be a whole number from 1 to {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_absurd_ones_refused() {
        assert_eq!(size("800x600"), Ok(Size { width: 800, height: 600 }));
        for bad in ["800", "0x600", "800x", "-1x5", "1e9x2", "65536x65536", "999999x1"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn cameras_take_ten_numbers_that_make_a_view() {
        let good = camera("0, 1,-3, 0,0,0, 0,1,0, 39.3").unwrap();
        assert_eq!((good.origin, good.fov_degrees), ([0.0, 1.0, -3.0], 39.3));
        for bad in [
            "0,1,-3,0,0,0,0,1,0",
            "0,0,0,0,0,0,0,1,0,40",
            "0,0,0,0,1,0,0,1,0,40",
            "0,0,0,0,1,0,0,0,0,40",
            "0,0,0,0,0,1,0,1,0,0",
            "0,0,0,0,0,1,0,1,0,180",
            "0,0,0,0,0,inf,0,1,0,40",
            "0,0,0,0,0,NaN,0,1,0,40",
        ] {
            assert!(camera(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_outside_their_range_are_refused() {
        assert_eq!(crop("1,2,3,4"), Ok([1, 2, 3, 4]));
        assert!(crop("1,2,0,4").is_err() && crop("1,2,3").is_err() && crop("-1,2,3,4").is_err());
        assert!(positive("1.5").is_ok() && positive("0").is_err() && positive("inf").is_err());
        assert!(positive("nan").is_err() && positive_f32("1e39").is_err() && finite_f32("-2.5").is_ok());
        assert!(count("1").is_ok() && count("0").is_err() && count("2147483648").is_err() && count("x").is_err());
        assert!(threads("7").is_ok() && threads("0").is_err() && threads("100000").is_err());
    }
}
