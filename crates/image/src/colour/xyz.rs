//! Linear sRGB to CIE XYZ and back, in double precision.

/// Rows of the matrix from linear sRGB to XYZ: IEC 61966-2-1 primaries and D65 white (0.3127, 0.3290), white at Y = 1.
const TO_XYZ: [[f64; 3]; 3] = [
    [0.412_390_799_265_959_5, 0.357_584_339_383_877_96, 0.180_480_788_401_834_3],
    [0.212_639_005_871_510_36, 0.715_168_678_767_755_9, 0.072_192_315_360_733_71],
    [0.019_330_818_715_591_85, 0.119_194_779_794_625_99, 0.950_532_152_249_660_6],
];

/// Rows of the inverse matrix.
const TO_RGB: [[f64; 3]; 3] = [
    [3.240_969_941_904_521_3, -1.537_383_177_570_093_5, -0.498_610_760_293_003_3],
    [-0.969_243_636_280_879_8, 1.875_967_501_507_720_6, 0.041_555_057_407_175_61],
    [0.055_630_079_696_993_61, -0.203_976_958_888_976_57, 1.056_971_514_242_878_6],
];

fn apply(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// CIE XYZ of a linear sRGB colour; white (1, 1, 1) has Y = 1.
pub fn rgb_to_xyz(rgb: [f64; 3]) -> [f64; 3] {
    apply(&TO_XYZ, rgb)
}

/// Linear sRGB of a CIE XYZ colour; outside the gamut some channels are negative.
pub fn xyz_to_rgb(xyz: [f64; 3]) -> [f64; 3] {
    apply(&TO_RGB, xyz)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chromaticity of a colour.
    fn xy(xyz: [f64; 3]) -> [f64; 2] {
        let sum: f64 = xyz.iter().sum();
        [xyz[0] / sum, xyz[1] / sum]
    }

    #[test]
    fn primaries_and_white_are_those_of_the_standard() {
        let published = [
            ([1.0, 0.0, 0.0], [0.64, 0.33]),
            ([0.0, 1.0, 0.0], [0.30, 0.60]),
            ([0.0, 0.0, 1.0], [0.15, 0.06]),
            ([1.0, 1.0, 1.0], [0.3127, 0.3290]),
        ];
        for (rgb, expected) in published {
            let found = xy(rgb_to_xyz(rgb));
            assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-12), "{rgb:?}: {found:?}");
        }
        assert!((rgb_to_xyz([1.0; 3])[1] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_two_matrices_are_inverse() {
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, -3.0, 500.0]] {
            let back = xyz_to_rgb(rgb_to_xyz(rgb));
            assert!((0..3).all(|i| (back[i] - rgb[i]).abs() < 1e-12 * (1.0 + rgb[2])), "{rgb:?}: {back:?}");
        }
    }
}
