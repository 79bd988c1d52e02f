//! Look-ups against slow ones, over points of every kind; estimates and gradients against what is known.

use super::tree::{NormalTree, nearest_by_brute_force};
use super::*;
use crate::{BuildOptions, Kernel, Photon, SEARCHES, build};
use photinus_geometry::{Aabb, Frame, Vec3};
use photinus_num::{Sampler, StreamKind};

const SEED: u64 = 20_113;

fn sampler(set: u64, index: usize) -> Sampler {
    Sampler::new(SEED, StreamKind::Test, set, index as u32)
}

fn direction(s: &mut Sampler) -> Vec3 {
    let [a, b] = s.next_2d();
    let z = 1.0 - 2.0 * a;
    let (sin, cos) = libm::sincosf(b * std::f32::consts::TAU);
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, z)
}

fn random(s: &mut Sampler) -> Vec3 {
    Vec3::new(s.next_1d(), s.next_1d(), s.next_1d())
}

/// A set's name, a length that suits it, and its points with their normals.
type Points = (&'static str, f32, Vec<(Vec3, Vec3)>);

/// Points with normals: in a volume, on two sides of a plane, on a lattice with ties, on a line, at one place, far and wide.
fn sets() -> Vec<Points> {
    let set = |number: u64, count: usize, place: &dyn Fn(&mut Sampler) -> (Vec3, Vec3)| -> Vec<(Vec3, Vec3)> {
        (0..count).map(|i| place(&mut sampler(number, i))).collect()
    };
    let side = |s: &mut Sampler| if s.next_1d() < 0.5 { Vec3::Z } else { -Vec3::Z };
    vec![
        ("none", 1.0, Vec::new()),
        ("one", 1.0, vec![(Vec3::ONE, Vec3::Y)]),
        ("volume", 0.2, set(1, 3000, &|s| (random(s), direction(s)))),
        ("plane", 0.05, set(2, 3000, &|s| (random(s) * Vec3::new(1.0, 1.0, 0.0), side(s)))),
        ("lattice", 1.0, set(3, 2000, &|s| ((random(s) * 8.0).floor(), side(s)))),
        ("line", 0.01, set(4, 999, &|s| (Vec3::X * s.next_1d(), direction(s)))),
        ("point", 0.1, set(5, 500, &|s| (Vec3::new(1e3, 2e3, 3e3), direction(s)))),
        ("far away", 0.3, set(6, 999, &|s| (random(s) + Vec3::splat(1e6), Vec3::X))),
        ("wide", 1e16, set(7, 999, &|s| ((random(s) - Vec3::splat(0.5)) * 2e18, direction(s)))),
        ("tiny", 1e-22, set(8, 999, &|s| (random(s) * 1e-21, direction(s)))),
    ]
}

#[test]
fn the_nearest_with_a_like_normal_is_that_of_brute_force() {
    let mut found = 0;
    for (name, scale, points) in sets() {
        let tree = NormalTree::build(points.iter().copied());
        for i in 0..600 {
            let mut s = sampler(50, i);
            let at = points.get((s.next_1d() * points.len() as f32) as usize).copied().unwrap_or((Vec3::ONE, Vec3::Z));
            let position = at.0 + direction(&mut s) * (scale * [0.0, 0.3, 3.0][i % 3] * s.next_1d());
            let normal = match i % 4 {
                0 => at.1,
                1 => (at.1 + 0.5 * direction(&mut s)).normalize_or(Vec3::Z),
                2 => direction(&mut s),
                _ => [Vec3::ZERO, Vec3::NAN, Vec3::Z][i / 4 % 3],
            };
            let least = [0.0, 0.5, 0.8, 1.0][i / 3 % 4];
            let limit = [0.0, scale * scale, f32::INFINITY, -1.0, f32::NAN][i / 5 % 5];
            let expected = nearest_by_brute_force(&points, position, normal, least, limit);
            found += usize::from(expected.is_some());
            let context = format!("seed {SEED}: '{name}', query {i} at {position} facing {normal}, {least}, {limit}");
            assert_eq!(tree.nearest(position, normal, least, limit), expected, "{context}");
        }
    }
    assert!(found > 1000, "most queries found nothing: {found}");
}

/// 40,000 photons of equal flux, evenly over a square of 10 x 10, some of them on its lower side.
fn even_photons() -> Vec<Photon> {
    (0..40_000)
        .map(|i| {
            let mut s = sampler(60, i);
            // Plain random numbers: photons that are better spread than that would hide what chance does.
            for _ in 0..32 {
                s.next_1d();
            }
            let position = Vec3::new(s.next_1d() * 10.0, s.next_1d() * 10.0, 0.0);
            let normal = if s.next_1d() < 0.1 { -Vec3::Z } else { Vec3::Z };
            Photon::new(position, Vec3::new(1.0, 0.5, 0.25) * 1e-3, normal, normal, 2, false).unwrap()
        })
        .collect()
}

/// Evenly lit, the mean of what is looked up is the light that falls, at any n and with few photons an estimate, too: what an
/// estimate counts too many (the photon at its middle) is what the nearest photon's disc lacks. 36,000 photons make the light
/// known to 0.5 %; 4,000 look-ups of estimates of 55 photons vary by 13 % / sqrt(650 discs) = 0.5 %.
#[test]
fn what_is_looked_up_is_right_in_the_mean() {
    let photons = even_photons();
    let lit = photons.iter().filter(|p| p.normal().z > 0.0).count() as f32 * 1e-3 / 100.0;
    for member in SEARCHES.iter().filter(|member| member.is_exact && !member.name.starts_with("brute")) {
        let search = member.build(photons.clone(), &BuildOptions { radius_hint: 0.11 }).unwrap();
        for (every, knn) in [(1, None), (4, None), (10, None), (4, Some(40))] {
            // A tenth of the photons, the disc around which lacks one of them, wants a wider estimate.
            let radius = if every == 10 { 0.35 } else { 0.22 };
            let options = IrradianceOptions { every, radius, knn, kernel: Kernel::Constant, max_depth: 127 };
            let known = irradiance_at_photons(&*search, &options);
            assert_eq!(known.len(), photons.len().div_ceil(every as usize));
            let map = IrradianceAtPhotons::new(&known, IrradianceAtPhotons::LEAST_COSINE, f32::INFINITY);
            let places: Vec<(Vec3, Vec3)> = (0..4000)
                .map(|i| {
                    let mut s = sampler(61, i);
                    (Vec3::new(1.0 + 8.0 * s.next_1d(), 1.0 + 8.0 * s.next_1d(), 0.0), Vec3::Z)
                })
                .collect();
            let mut out = vec![None; places.len()];
            map.look_up(&places, &mut out);
            let mean = out.iter().map(|found| found.unwrap()).sum::<Vec3>() / 4000.0;
            let context = format!("seed {SEED}: {}, every {every}, {knn:?}: {mean}", member.name);
            // With the nearest only, the area is that of the farthest: flux over it is too much by up to 2 / k.
            let limit = if knn.is_some() { 0.06 } else { 0.02 };
            assert!((mean.x / lit - 1.0).abs() < limit, "{context}, expected {lit}");
            assert!((mean.y / mean.x - 0.5).abs() < 0.01 && (mean.z / mean.x - 0.25).abs() < 0.01, "{context}");
        }
    }
}

#[test]
fn irradiance_at_photons_does_not_depend_on_threads() {
    let search = build("grid", even_photons(), &BuildOptions::default()).unwrap();
    let options = IrradianceOptions { every: 3, radius: 0.2, knn: None, kernel: Kernel::Epanechnikov, max_depth: 127 };
    let of_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| irradiance_at_photons(&*search, &options))
    };
    let one = of_threads(1);
    assert!(one.iter().all(|known| known.count > 0 && known.irradiance.x > 0.0));
    assert!(one == of_threads(2) && one == of_threads(7), "seed {SEED}");
}

#[test]
fn look_ups_keep_to_their_side_and_their_distance() {
    let known = |x: f32, normal: Vec3, light: f32| KnownIrradiance {
        position: Vec3::new(x, 0.0, 0.0),
        normal,
        irradiance: Vec3::splat(light),
        count: 1,
        radius: 1.0,
    };
    let map = IrradianceAtPhotons::new(&[known(0.0, Vec3::Z, 1.0), known(0.1, -Vec3::Z, 2.0)], 0.8, 0.5);
    assert_eq!(map.at(Vec3::new(0.1, 0.0, 0.0), Vec3::Z), Some(Vec3::ONE));
    assert_eq!(map.at(Vec3::ZERO, -Vec3::Z), Some(Vec3::splat(2.0)));
    assert_eq!(map.at(Vec3::ZERO, Vec3::X), None, "no like normal");
    assert_eq!(map.at(Vec3::new(0.5, 0.0, 0.0), Vec3::Z), Some(Vec3::ONE), "the distance is closed");
    assert_eq!(map.at(Vec3::new(0.51, 0.0, 0.0), Vec3::Z), None, "too far");
    assert_eq!(map.at(Vec3::NAN, Vec3::Z), None);
    assert_eq!(map.at(Vec3::splat(2e18), Vec3::Z), None);
    assert!((map.len(), map.is_empty()) == (2, false) && map.bytes() >= 2 * 32);
}

/// Records of every size around random points, some of them with normals all over.
fn records(set: u64, count: usize, scale: f32, away: f32) -> Vec<IrradianceRecord> {
    (0..count)
        .map(|i| {
            let mut s = sampler(set, i);
            let normal = if s.next_1d() < 0.5 { Vec3::Z } else { direction(&mut s) };
            IrradianceRecord {
                position: random(&mut s) * scale + Vec3::splat(away),
                normal,
                irradiance: random(&mut s),
                radius: scale * libm::powf(10.0, -3.0 * s.next_1d()),
                rotation: [0.1; 3].map(|x| direction(&mut s) * x),
                translation: [0.1 / scale; 3].map(|x| direction(&mut s) * x),
            }
        })
        .collect()
}

#[test]
fn the_octree_finds_the_records_of_brute_force() {
    let mut found = 0;
    for (set, scale, away) in [(70, 1.0, 0.0), (71, 1e-6, 0.0), (72, 1e12, 0.0), (73, 1.0, 1e5), (74, 1.0, -3.0)] {
        for accuracy in [0.05, 0.3, 1.5] {
            // Records outside of the bounds, and bounds of nothing, are found all the same.
            let around = Aabb::around([Vec3::splat(away), Vec3::splat(away + 0.8 * scale)]);
            for bounds in [around, Aabb::EMPTY, Aabb::around([Vec3::splat(away)])] {
                let mut cache = IrradianceCache::new(bounds, accuracy);
                records(set, 800, scale, away).into_iter().for_each(|record| cache.insert(record).unwrap());
                for i in 0..400 {
                    let mut s = sampler(80, i);
                    let record = cache.records()[i];
                    let position = match i % 3 {
                        0 => record.position,
                        // At the rim of the record's validity, where rounding decides.
                        1 => record.position + direction(&mut s) * (accuracy * record.radius),
                        _ => random(&mut s) * (1.2 * scale) + Vec3::splat(away),
                    };
                    let (at, slow) = (cache.at(position, Vec3::Z), cache.at_by_brute_force(position, Vec3::Z));
                    let context = format!("seed {SEED}: set {set}, a {accuracy}, query {i}: {at:?}, slow {slow:?}");
                    assert_eq!(at.is_some(), slow.is_some(), "{context}");
                    assert_eq!(cache.is_known(position, Vec3::Z, accuracy), slow.is_some(), "{context}");
                    if let (Some(at), Some(slow)) = (at, slow) {
                        found += 1;
                        assert!((at - slow).abs().max_element() <= 1e-4 * (1.0 + slow.max_element()), "{context}");
                    }
                }
            }
        }
    }
    assert!(found > 2000, "few places are known: {found}");
}

#[test]
fn records_hold_where_the_paper_says() {
    let record = IrradianceRecord {
        position: Vec3::ZERO,
        normal: Vec3::Z,
        irradiance: Vec3::splat(2.0),
        radius: 2.0,
        rotation: [Vec3::ZERO; 3],
        translation: [Vec3::X * 0.5, Vec3::ZERO, Vec3::NEG_X * 100.0],
    };
    let mut cache = IrradianceCache::new(Aabb::around([Vec3::splat(-9.0), Vec3::splat(9.0)]), 0.3);
    cache.insert(record).unwrap();
    assert_eq!(record.error(Vec3::X, Vec3::Z), Some(0.5), "a distance of half of R");
    assert_eq!(cache.at(Vec3::X * 0.59, Vec3::Z), Some(Vec3::new(2.295, 2.0, 0.0)), "gradients, and nothing negative");
    assert_eq!(cache.at(Vec3::X * 0.61, Vec3::Z), None);
    let tilted = |degrees: f32| Vec3::new(libm::sinf(degrees.to_radians()), 0.0, libm::cosf(degrees.to_radians()));
    // sqrt(1 - cos t) = 0.3 at 24.5 degrees.
    assert!(cache.at(Vec3::ZERO, tilted(24.0)).is_some() && cache.at(Vec3::ZERO, tilted(25.0)).is_none());
    assert!(cache.at(Vec3::new(0.0, 0.0, -0.1), Vec3::Z).is_none(), "behind the record");
    assert!(cache.at(Vec3::new(0.0, 0.0, 0.1), Vec3::Z).is_some(), "in front of it");
    assert_eq!(cache.at(Vec3::NAN, Vec3::Z), None);
    for bad in [
        IrradianceRecord { radius: 0.0, ..record },
        IrradianceRecord { radius: f32::NAN, ..record },
        IrradianceRecord { radius: f32::INFINITY, ..record },
        IrradianceRecord { position: Vec3::NAN, ..record },
        IrradianceRecord { rotation: [Vec3::INFINITY; 3], ..record },
    ] {
        assert!(cache.insert(bad).unwrap_err().to_string().contains("record"), "{bad:?}");
    }
    assert_eq!(cache.records().len(), 1);
}

/// What is seen from `position` of a ceiling at z = 3 that shines with 1 + x / 4 + y^2 / 9 times (1 - r^2 / 144)^2, nothing from
/// r = 12 on (RGB: that, half of it, and the second factor).
fn seen(position: Vec3, frame: &Frame, hemisphere: Hemisphere) -> Vec<HemisphereSample> {
    (0..hemisphere.len())
        .map(|i| {
            let d = frame.to_world(hemisphere.direction(i, [0.5, 0.5]));
            let t = (3.0 - position.z) / d.z;
            let at = position + d * t;
            let fade = 1.0 - (at.x * at.x + at.y * at.y) / 144.0;
            if !(t > 0.0) || fade <= 0.0 {
                return HemisphereSample { radiance: Vec3::ZERO, distance: f32::INFINITY };
            }
            let light = (1.0 + 0.25 * at.x + at.y * at.y / 9.0) * fade * fade;
            HemisphereSample { radiance: Vec3::new(light, 0.5 * light, fade * fade), distance: t }
        })
        .collect()
}

/// Gradients of 6,000 directions against half of the difference between both ways, by 0.05 units or 0.05 rad: within 5 % of what
/// such a move changes at most, 0.05 E / R or 0.05 E; that is what midpoints of cells leave.
#[test]
fn gradients_are_differences() {
    let hemisphere = Hemisphere::new(6000);
    assert!((5500..=6500).contains(&hemisphere.len()));
    let record = |position: Vec3, normal: Vec3| {
        let frame = Frame::from_normal(normal);
        hemisphere.record(position, &frame, &seen(position, &frame, hemisphere), [1e-3, 1e3]).unwrap()
    };
    let step = 0.05;
    let (mut moved_most, mut turned_most) = (0f32, 0f32);
    for (position, normal) in [
        (Vec3::ZERO, Vec3::Z),
        (Vec3::new(0.7, -0.6, 0.4), Vec3::Z),
        (Vec3::new(-1.0, 1.0, 0.0), Vec3::new(0.3, 0.2, 0.9).normalize()),
    ] {
        let here = record(position, normal);
        assert!(here.radius > 2.5 && here.radius < 12.0, "{}", here.radius);
        let tangents = Frame::from_normal(normal);
        let predicted = |position, normal| here.predicted(position, normal) - here.irradiance;
        for axis in [tangents.s, tangents.t] {
            let at = |step: f32| record(position + axis * step, normal).irradiance;
            let (change, scale) = ((at(step) - at(-step)) / 2.0, here.irradiance.x * step / here.radius);
            let found = predicted(position + axis * step, normal);
            moved_most = moved_most.max(change.abs().max_element() / scale);
            let context = format!("from {position} along {axis}: {change}, predicted {found}, scale {scale}");
            assert!((change - found).abs().max_element() < 0.05 * scale, "{context}");
            let turned = |step: f32| (normal + axis * step).normalize();
            let at = |step: f32| record(position, turned(step)).irradiance;
            let (change, scale) = ((at(step) - at(-step)) / 2.0, here.irradiance.x * step);
            let found = predicted(position, turned(step));
            turned_most = turned_most.max(change.abs().max_element() / scale);
            let context = format!("at {position} turned to {axis}: {change}, predicted {found}, scale {scale}");
            assert!((change - found).abs().max_element() < 0.05 * scale, "{context}");
        }
    }
    assert!(moved_most > 0.2 && turned_most > 0.2, "changes are seen: {moved_most}, {turned_most}");
}

/// Under light of 1 from everywhere irradiance is pi, the harmonic mean that of the distances, and nothing changes with place;
/// limits hold.
#[test]
fn records_of_even_light_are_known() {
    for rays in [1, 64, 500] {
        let hemisphere = Hemisphere::new(rays);
        let frame = Frame::from_normal(Vec3::Y);
        let sample = |i| HemisphereSample { radiance: Vec3::ONE, distance: if i % 2 == 0 { 2.0 } else { 6.0 } };
        let samples: Vec<_> = (0..hemisphere.len()).map(sample).collect();
        let record = hemisphere.record(Vec3::ZERO, &frame, &samples, [0.1, 10.0]).unwrap();
        assert!((record.irradiance - Vec3::splat(std::f32::consts::PI)).abs().max_element() < 1e-4);
        let even = samples.iter().filter(|s| s.distance == 2.0).count() as f32 / samples.len() as f32;
        assert!((record.radius - 1.0 / (even / 2.0 + (1.0 - even) / 6.0)).abs() < 1e-4);
        let changes = record.rotation.iter().chain(&record.translation);
        assert!(changes.clone().all(|change| change.length() < 1e-4), "{rays}: {record:?}");
        for (limits, expected) in [([5.0, 9.0], 5.0), ([0.1, 0.2], 0.2)] {
            assert_eq!(hemisphere.record(Vec3::ZERO, &frame, &samples, limits).unwrap().radius, expected);
        }
        assert!(hemisphere.record(Vec3::ZERO, &frame, &samples[1..], [0.1, 1.0]).is_none());
        let nothing = vec![HemisphereSample { radiance: Vec3::ZERO, distance: f32::INFINITY }; samples.len()];
        assert_eq!(hemisphere.record(Vec3::ZERO, &frame, &nothing, [0.1, 7.0]).unwrap().radius, 7.0);
    }
}
