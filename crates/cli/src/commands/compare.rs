//! `photinus compare`: how far a picture is from its reference.

use crate::args::CompareArgs;
use crate::failure::{Outcome, Result};
use crate::report;

/// Compares.
pub fn run(args: &CompareArgs) -> Result {
    let found = photinus::compare(&args.a, &args.b, args.mask.as_deref())?;
    if args.json {
        report::json(&found)?;
    } else {
        report::table(&[
            ("relMSE", format!("{:.6}", found.relmse)),
            ("relMSE, trimmed", format!("{:.6}", found.relmse_trimmed)),
            ("PSNR", format!("{:.3} dB", found.psnr)),
            ("FLIP", format!("{:.6}", found.flip)),
            ("mean of A", format!("{:.6}", found.mean_a)),
            ("mean of B", format!("{:.6}", found.mean_b)),
        ])?;
    }
    if found.nonfinite > 0 {
        report::warning(&format!("{} pixels hold values that are not finite; they were clamped", found.nonfinite));
    }
    Ok(Outcome::Done)
}
