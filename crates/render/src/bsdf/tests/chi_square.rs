//! Sampled directions against the density that is claimed for them, by Pearson's chi-square test.
//!
//! The construction is that of pbrt and Mitsuba: cells of equal solid angle over (z, azimuth); expected counts by
//! adaptive quadrature of the density; cells pooled, smallest first, until each expects 5 counts, which is where the
//! statistic's distribution is close enough to its limit; significance 0.01 over the whole suite, so 1 - 0.99^(1/n) for
//! each of the n tests (Sidak). One more cell holds the draws that fail: their share must be what the density lacks of 1.

use super::subjects::subjects;
use super::{direction, flat_point, sampler, tilted_point};
use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use photinus_geometry::Vec3;

const Z_CELLS: usize = 20;
const PHI_CELLS: usize = 40;
const SAMPLES: u64 = 20_000;
const SIGNIFICANCE: f64 = 0.01;

/// Integral of `f` over a rectangle of (z, phi): a grid of 4 x 4 midpoints, halved at least `least` times and until
/// halving changes little.
fn integrate(f: &dyn Fn(f64, f64) -> f64, z: [f64; 2], phi: [f64; 2], depth: u32, least: u32) -> f64 {
    let grid = |z: [f64; 2], phi: [f64; 2]| {
        let mut sum = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                let at = |r: [f64; 2], k: u32| r[0] + (r[1] - r[0]) * (f64::from(k) + 0.5) / 4.0;
                sum += f(at(z, i), at(phi, j));
            }
        }
        sum * (z[1] - z[0]) * (phi[1] - phi[0]) / 16.0
    };
    let (zm, pm) = (0.5 * (z[0] + z[1]), 0.5 * (phi[0] + phi[1]));
    let quarters = [
        ([z[0], zm], [phi[0], pm]),
        ([z[0], zm], [pm, phi[1]]),
        ([zm, z[1]], [phi[0], pm]),
        ([zm, z[1]], [pm, phi[1]]),
    ];
    let coarse = grid(z, phi);
    let fine: f64 = quarters.iter().map(|&(z, phi)| grid(z, phi)).sum();
    // A tenth of a count in a cell is far below its noise.
    if depth == 0 || (least == 0 && (fine - coarse).abs() * SAMPLES as f64 <= 0.1) {
        return fine;
    }
    quarters.iter().map(|&(z, phi)| integrate(f, z, phi, depth - 1, least.saturating_sub(1))).sum()
}

/// Upper tail of the chi-square distribution: the regularised incomplete gamma function Q(k / 2, x / 2) (Numerical
/// Recipes, section 6.2: series below, continued fraction above).
fn chi_square_tail(x: f64, degrees: f64) -> f64 {
    let (a, x) = (0.5 * degrees, 0.5 * x);
    let front = (a * x.ln() - x - libm::lgamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-15 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        1.0 - sum * front
    } else {
        let mut b = x + 1.0 - a;
        let mut c = 1e300;
        let mut d = 1.0 / b;
        let mut h = d;
        for i in 1..10_000 {
            let an = -f64::from(i) * (f64::from(i) - a);
            b += 2.0;
            d = 1.0 / (an * d + b);
            c = b + an / c;
            h *= d * c;
            if (d * c - 1.0).abs() < 1e-14 {
                break;
            }
        }
        h * front
    }
}

/// The p-value of `SAMPLES` draws against a density, or what is wrong with the density itself.
fn p_value(density: &dyn Fn(Vec3) -> f32, draw: &dyn Fn(u64) -> Option<Vec3>) -> Result<f64, String> {
    let density = |z: f64, phi: f64| f64::from(density(direction(z as f32, phi as f32)));
    let integrate_cell = |i: usize, j: usize, least: u32| {
        let z = |i: usize| -1.0 + 2.0 * i as f64 / Z_CELLS as f64;
        let phi = |j: usize| std::f64::consts::TAU * j as f64 / PHI_CELLS as f64;
        integrate(&density, [z(i), z(i + 1)], [phi(j), phi(j + 1)], 6, least)
    };
    let mut cells = Vec::with_capacity(Z_CELLS * PHI_CELLS + 1);
    for i in 0..Z_CELLS {
        for j in 0..PHI_CELLS {
            cells.push((integrate_cell(i, j, 0) * SAMPLES as f64, 0.0));
        }
    }
    let mut failed = 0.0;
    for k in 0..SAMPLES {
        let Some(wi) = draw(k) else {
            failed += 1.0;
            continue;
        };
        let i = (((wi.z + 1.0) * 0.5 * Z_CELLS as f32) as usize).min(Z_CELLS - 1);
        let phi = wi.y.atan2(wi.x).rem_euclid(std::f32::consts::TAU);
        let j = ((phi / std::f32::consts::TAU * PHI_CELLS as f32) as usize).min(PHI_CELLS - 1);
        cells[i * PHI_CELLS + j].1 += 1.0;
    }
    // A peak may hide between the points of the coarse grid: where counts differ, look closely.
    for (k, (expected, observed)) in cells.iter_mut().enumerate() {
        if (*observed - *expected).abs() > 3.0 * expected.max(1.0).sqrt() {
            *expected = integrate_cell(k / PHI_CELLS, k % PHI_CELLS, 3) * SAMPLES as f64;
        }
    }
    let total: f64 = cells.iter().map(|c| c.0).sum::<f64>() / SAMPLES as f64;
    if !(total < 1.003) {
        return Err(format!("density integrates to {total}"));
    }
    cells.push(((1.0 - total).max(0.0) * SAMPLES as f64, failed));
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut statistic, mut pooled, mut count) = (0.0, (0.0, 0.0), 0u32);
    for (expected, observed) in cells {
        pooled = (pooled.0 + expected, pooled.1 + observed);
        if pooled.0 >= 5.0 {
            statistic += (pooled.1 - pooled.0) * (pooled.1 - pooled.0) / pooled.0;
            pooled = (0.0, 0.0);
            count += 1;
        }
    }
    // What is left over expects less than 5; far more than that is a direction that the density denies.
    if pooled.1 > 25.0 {
        return Err(format!("{} draws where {} are expected", pooled.1, pooled.0));
    }
    if count < 2 {
        return Ok(1.0);
    }
    Ok(chi_square_tail(statistic, f64::from(count - 1)))
}

/// Draw number `k` of test number `test`.
fn draw(bsdf: &Bsdf, set: LobeSet, test: u32, k: u64) -> Option<Vec3> {
    let mut s = sampler(test, k);
    let u = s.next_2d();
    bsdf.sample(set, s.next_1d(), u, TransportMode::Importance).map(|sample| sample.wi)
}

#[test]
fn the_tail_has_known_values() {
    // Tables: 5 % at 18.307 for 10 degrees, 1 % at 135.807 for 100.
    assert!((chi_square_tail(18.307, 10.0) - 0.05).abs() < 1e-5);
    assert!((chi_square_tail(135.807, 100.0) - 0.01).abs() < 1e-5);
    assert!((chi_square_tail(2.0, 2.0) - (-1.0f64).exp()).abs() < 1e-12);
}

#[test]
fn samples_follow_their_density() {
    let mut tests = Vec::new();
    for subject in subjects() {
        let &(ref materials, id) = subject.prepare();
        for (z, phi) in [(0.95, 0.3), (0.5, 2.0), (0.1, 4.0), (-0.6, 1.0)] {
            for point in [flat_point(), tilted_point(Vec3::new(0.3, 0.2, 1.0).normalize())] {
                // The tilted point costs as much as the flat one and tests less: one direction is enough.
                if point.normal != Vec3::Z && z != 0.5 {
                    continue;
                }
                let bsdf = materials.resolve(id, &point, direction(z, phi));
                let sets = [LobeSet::NON_DELTA, LobeSet::GATHER, LobeSet::CONTINUE & LobeSet::NON_DELTA];
                for (i, set) in sets.into_iter().enumerate() {
                    let kinds = bsdf.kinds() & set;
                    // Part of the whole only where it is a true part.
                    if kinds.is_empty() || (i > 0 && (kinds == bsdf.kinds() & LobeSet::NON_DELTA || z == 0.95)) {
                        continue;
                    }
                    tests.push((format!("{} z {z} {set:?} {}", subject.name, point.normal), bsdf.clone(), set));
                }
            }
        }
    }
    assert!(tests.len() > 150, "only {} tests", tests.len());
    let level = 1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / tests.len() as f64);
    let mut failures = Vec::new();
    for (k, (name, bsdf, set)) in tests.iter().enumerate() {
        match p_value(&|wi| bsdf.pdf(*set, wi), &|i| draw(bsdf, *set, k as u32, i)) {
            Ok(p) if p >= level => {}
            Ok(p) => failures.push(format!("{name}: p = {p:.2e}, level {level:.2e}")),
            Err(message) => failures.push(format!("{name}: {message}")),
        }
    }
    assert!(
        failures.is_empty(),
        "{} of {} (seed {}):\n{}",
        failures.len(),
        tests.len(),
        super::SEED,
        failures.join("\n")
    );
}

/// The test must be able to fail: samples of one material against the density of another.
#[test]
fn a_wrong_density_is_found() {
    let all = subjects();
    let find = |name: &str| all.iter().find(|s| s.name.starts_with(name)).expect("a subject");
    let wo = direction(0.7, 0.5);
    let resolve = |name: &str| {
        let &(ref materials, id) = find(name).prepare();
        materials.resolve(id, &flat_point(), wo)
    };
    let (a, b) = (resolve("rough-conductor Ggx [0.3"), resolve("rough-conductor Beckmann [0.3"));
    let set = LobeSet::NON_DELTA;
    let right = p_value(&|wi| a.pdf(set, wi), &|i| draw(&a, set, 1, i)).expect("a density");
    let wrong = p_value(&|wi| b.pdf(set, wi), &|i| draw(&a, set, 1, i)).unwrap_or(0.0);
    assert!(right > 1e-4 && wrong < 1e-9, "{right} {wrong}");
}
