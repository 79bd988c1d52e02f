//! Whether an engine gives the answers of ours, before it is timed.

use photinus_geometry::Hit;

/// Rays in a thousand that may differ: edges and near ties are found one way or another.
const ALLOWED: f64 = 2e-3;

/// What is said about hits that should be alike; an error where too many differ.
pub fn hits(ours: &[Hit], theirs: &[Hit]) -> Result<String, String> {
    let differs = |(a, b): &(&Hit, &Hit)| {
        a.is_hit() != b.is_hit() || (a.is_hit() && (a.t - b.t).abs() > 1e-3 * a.t.abs().max(1e-3))
    };
    said(ours.iter().zip(theirs).filter(differs).count(), ours.len())
}

/// The same of shadows.
pub fn shadows(ours: &[bool], theirs: &[bool]) -> Result<String, String> {
    said(ours.iter().zip(theirs).filter(|(a, b)| a != b).count(), ours.len())
}

fn said(different: usize, count: usize) -> Result<String, String> {
    let text = format!("{different} of {count} rays differ");
    if different as f64 <= ALLOWED * count as f64 { Ok(text) } else { Err(format!("does not agree: {text}")) }
}
