//! `agx`: Sobotka's AgX picture formation, base look, with the polynomial of Wrensch 2023, "Minimal AgX Implementation".

/// Inset: mixes the primaries before the curve (rows give R, G, B).
const INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_655, 0.078_433_6, 0.879_143],
];
/// Outset: the inverse of the inset.
const OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_85, 1.151_903_1, -0.098_961_18],
    [-0.052_971_635, -0.098_043_45, 1.151_073_7],
];
/// Range of the log encoding, in stops around 1.
const MIN_EV: f32 = -12.473_93;
const MAX_EV: f32 = 4.026_069;

fn apply(matrix: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|row| matrix[row][0] * v[0] + matrix[row][1] * v[1] + matrix[row][2] * v[2])
}

/// The sigmoid contrast curve on log-encoded light, a polynomial of degree 6.
fn contrast(x: f32) -> f32 {
    let x2 = x * x;
    let x4 = x2 * x2;
    15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.002_32
}

/// Inset, log2 between the two stops, contrast, outset; the result is display-encoded with exponent 2.2 and decoded here.
pub(super) fn map(rgb: [f32; 3]) -> [f32; 3] {
    let encoded = apply(&INSET, rgb).map(|light| {
        let ev = libm::log2f(light).clamp(MIN_EV, MAX_EV);
        contrast((ev - MIN_EV) / (MAX_EV - MIN_EV))
    });
    apply(&OUTSET, encoded).map(|c| libm::powf(c.max(0.0), 2.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outset_undoes_inset() {
        for v in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.3, 0.7, 0.1]] {
            let back = apply(&OUTSET, apply(&INSET, v));
            assert!((0..3).all(|c| (back[c] - v[c]).abs() < 1e-5), "{v:?} became {back:?}");
        }
    }
}
