//! Every kind of region for every set of results, by every member against `brute-force`; and what approximate members lose.

mod support;

use photinus_geometry::Vec3;
use photinus_photons::results::{Accumulation, Count, First, List, Nearest};
use photinus_photons::{BuildOptions, GatherQuery, Kernel, Neighbor, Region, SEARCHES, Search, build};
use support::{SEED, Set, queries, sets};

/// Regions around what queries ask for, and some that hold everything, a plane, a point, or are none.
fn regions(set: &Set) -> Vec<Region> {
    let mut regions = Vec::new();
    for query in queries(set, 24) {
        let (center, radius) = (query.position, query.radius);
        let half = Vec3::new(1.0, 0.5, 0.25) * radius;
        regions.push(Region::Sphere { center, radius });
        regions.push(Region::Cuboid { center, half });
        regions.push(Region::Bounds { min: center - half, max: center + half });
        // Flat along one axis, without an end along another.
        regions.push(Region::Cuboid { center, half: Vec3::new(0.0, radius, f32::INFINITY) });
        regions.push(Region::Bounds { min: Vec3::new(center.x, f32::NEG_INFINITY, center.z), max: center });
    }
    let everywhere = Region::Bounds { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    // Bounds of zero, for which the thesis's divisions have no answer (Hoggins 2010, Figure 37).
    let corner = Region::Bounds { min: Vec3::ZERO, max: Vec3::INFINITY };
    let edge = Region::Bounds { min: Vec3::new(0.0, f32::NEG_INFINITY, 0.0), max: Vec3::new(0.0, f32::INFINITY, 0.0) };
    let inverted = Region::Bounds { min: Vec3::ONE, max: Vec3::ZERO };
    let negative = Region::Cuboid { center: Vec3::ZERO, half: Vec3::new(1.0, -1.0, 1.0) };
    let nan = Region::Sphere { center: Vec3::ZERO, radius: f32::NAN };
    let nowhere = Region::Bounds { min: Vec3::splat(f32::NAN), max: Vec3::INFINITY };
    let huge = Region::Bounds { min: Vec3::splat(-1e18), max: Vec3::splat(1e38) };
    let beyond = Region::Bounds { min: Vec3::splat(1e30), max: Vec3::splat(3e38) };
    regions.extend([huge, beyond]);
    regions.extend([everywhere, corner, edge, inverted, negative, nan, nowhere]);
    regions
}

fn list(search: &dyn Search, region: &Region) -> Vec<Neighbor> {
    let mut list = List::default();
    search.search(region, &mut list);
    list.into_found()
}

#[test]
fn every_question_about_a_region_agrees_with_the_oracle() {
    for set in sets() {
        let regions = regions(&set);
        let oracle = build("brute-force", set.photons.clone(), &BuildOptions::default()).unwrap();
        let expected: Vec<_> = regions.iter().map(|region| list(&*oracle, region)).collect();
        for member in SEARCHES.iter().filter(|m| m.is_exact) {
            let search = member.build(set.photons.clone(), &BuildOptions { radius_hint: set.radius }).unwrap();
            for (region, expected) in regions.iter().zip(&expected) {
                let context = format!("seed {SEED}: {} on '{}', {region:?}", member.name, set.name);
                assert_eq!(&list(&*search, region), expected, "{context}");
                let mut count = Count::default();
                let tested = search.search(region, &mut count);
                assert_eq!(count.0, expected.len() as u64, "{context}");
                assert!(tested >= count.0, "{context}: {tested} tested");
                let by_distance = |found: &Neighbor| (found.distance_sq.to_bits(), found.photon);
                for k in [0, 1, 10, usize::MAX] {
                    let mut nearest = Nearest::new(k);
                    search.search(region, &mut nearest);
                    let mut expected = expected.clone();
                    expected.sort_unstable_by_key(by_distance);
                    expected.truncate(k);
                    assert_eq!(nearest.into_found(), expected, "{context}: {k} nearest");
                    let mut first = First::new(k);
                    search.search(region, &mut first);
                    let mut first = first.into_found();
                    assert_eq!(first.len(), k.min(count.0 as usize), "{context}: first {k}");
                    first.sort_unstable_by_key(|n| n.photon);
                    first.dedup();
                    assert_eq!(first.len(), k.min(count.0 as usize), "{context}: first {k}, some twice");
                }
            }
        }
    }
}

#[test]
fn flux_accumulates_as_it_is_gathered() {
    for set in sets() {
        for member in SEARCHES.iter().filter(|m| m.is_exact) {
            let search = member.build(set.photons.clone(), &BuildOptions { radius_hint: set.radius }).unwrap();
            for query in queries(&set, 24) {
                let mut sum = Accumulation::new(&query, Kernel::Epanechnikov);
                search.search(&Region::Sphere { center: query.position, radius: query.radius }, &mut sum);
                let (sum, mut gathered) = (sum.gathered(), [Default::default()]);
                search.gather(&[query], Kernel::Epanechnikov, &mut gathered);
                let context = format!("seed {SEED}: {} on '{}', {query:?}", member.name, set.name);
                assert_eq!(sum.count, gathered[0].count, "{context}");
                let close = (sum.flux - gathered[0].flux).abs().cmple(gathered[0].flux.abs() * 1e-5 + 1e-30).all();
                assert!(close, "{context}: {} for {}", sum.flux, gathered[0].flux);
            }
        }
    }
}

/// An approximate member finds no photon that is not there, and most of those that are: in balls of the radius that it was
/// built for, on surfaces.
#[test]
fn approximate_members_lose_little() {
    for member in SEARCHES.iter().filter(|m| !m.is_exact) {
        for set in sets() {
            let oracle = build("brute-force", set.photons.clone(), &BuildOptions::default()).unwrap();
            let search = member.build(set.photons.clone(), &BuildOptions { radius_hint: set.radius }).unwrap();
            let (mut found, mut missed) = (0, 0);
            for GatherQuery { position, radius, .. } in queries(&set, 400) {
                let region = Region::Sphere { center: position, radius };
                let (all, some) = (list(&*oracle, &region), list(&*search, &region));
                assert!(some.iter().all(|n| all.contains(n)), "{}: {region:?}", member.name);
                // A middle off all surfaces lies in buckets that list no block: such balls lose all.
                if radius == set.radius && set.photons.iter().any(|photon| photon.position() == position) {
                    found += some.len();
                    missed += all.len() - some.len();
                }
            }
            if set.name == "box" {
                let loss = missed as f64 / (found + missed) as f64;
                assert!(loss < 0.05, "{} loses {loss} of {}", member.name, found + missed);
            }
        }
    }
}
