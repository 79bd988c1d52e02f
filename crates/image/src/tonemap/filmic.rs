//! `filmic`: Hable 2010, "Uncharted 2: HDR Lighting" (GDC), the curve with his published constants.

/// Shoulder strength.
const A: f32 = 0.15;
/// Linear strength.
const B: f32 = 0.50;
/// Linear angle.
const C: f32 = 0.10;
/// Toe strength.
const D: f32 = 0.20;
/// Toe numerator.
const E: f32 = 0.02;
/// Toe denominator.
const F: f32 = 0.30;
/// Linear white point.
const WHITE: f32 = 11.2;
/// Hable's exposure bias before the curve.
const EXPOSURE_BIAS: f32 = 2.0;

fn curve(x: f32) -> f32 {
    // The published (x (A x + C B) + D E) / (x (A x + B) + D F) - E / F, with x taken out of both products so that a
    // huge x stays finite.
    (A * x + C * B + D * E / x) / (A * x + B + D * F / x) - E / F
}

/// curve(2 x) / curve(white), channel by channel.
pub(super) fn map(rgb: [f32; 3]) -> [f32; 3] {
    let white = curve(WHITE);
    rgb.map(|c| if c > 0.0 { curve(EXPOSURE_BIAS * c) / white } else { 0.0 })
}
