//! Every member against `brute-force`, over photons and queries of every kind; and `brute-force` against answers known
//! by hand.

mod support;

use photinus_geometry::Vec3;
use photinus_photons::{
    BuildOptions, GatherQuery, Gathered, GatheredNearest, Kernel, Neighbor, Photon, SEARCHES, Search, build,
    kd_balanced,
};
use photinus_profile::SearchCounters;
use support::{SEED, Set, crowds, queries, sets};

const KERNELS: [Kernel; 4] = [Kernel::Constant, Kernel::Cone { k: 1.1 }, Kernel::Epanechnikov, Kernel::Gaussian];

fn oracle(set: &Set) -> Box<dyn Search> {
    build("brute-force", set.photons.clone(), &BuildOptions::default()).unwrap()
}

/// Calls `check` with every member but the oracle, built with the hint that suits, without one and with a poor one.
fn for_each_member(set: &Set, mut check: impl FnMut(&str, &dyn Search)) {
    for member in SEARCHES.iter().filter(|m| m.is_exact && m.name != "brute-force") {
        for radius_hint in [set.radius, 0.0, set.radius * 30.0] {
            let search = member.build(set.photons.clone(), &BuildOptions { radius_hint }).unwrap();
            let context = format!("seed {SEED}: {} on '{}' with hint {radius_hint:e}", member.name, set.name);
            check(&context, &*search);
        }
    }
}

#[test]
fn gather_agrees_with_the_oracle() {
    for set in sets() {
        let (queries, oracle) = (queries(&set, 80), oracle(&set));
        let expected = KERNELS.map(|kernel| {
            let mut expected = vec![Gathered::default(); queries.len()];
            oracle.gather(&queries, kernel, &mut expected);
            expected
        });
        for_each_member(&set, |context, search| {
            for (kernel, expected) in KERNELS.into_iter().zip(&expected) {
                let mut found = vec![Gathered { count: 9, ..Default::default() }; queries.len()];
                search.gather(&queries, kernel, &mut found);
                for (i, (e, f)) in expected.iter().zip(&found).enumerate() {
                    assert_eq!(e.count, f.count, "{context}: query {i} {:?}", queries[i]);
                    let close = (e.flux - f.flux).abs().cmple(e.flux.abs() * 1e-5 + 1e-30).all();
                    assert!(close, "{context}: {kernel:?}, query {i}: {} for {}", f.flux, e.flux);
                }
                let mut counters = SearchCounters::default();
                let mut counted = vec![Gathered::default(); queries.len()];
                search.gather_counted(&queries, kernel, &mut counted, &mut counters);
                assert_eq!(counted, found, "{context}");
                assert_eq!(counters.searches, queries.len() as u64, "{context}");
                assert_eq!(counters.photons_found, found.iter().map(|f| u64::from(f.count)).sum::<u64>());
                assert!(counters.photons_tested >= counters.photons_found, "{context}");
                assert!(counters.photons_tested <= (queries.len() * set.photons.len()) as u64, "{context}");
            }
        });
    }
}

#[test]
fn visit_hands_out_what_gather_sums() {
    let list = |search: &dyn Search, query: &GatherQuery| {
        let mut list = Vec::new();
        search.visit(query, &mut |photon, d2| list.push((photon.to_words(), d2.to_bits())));
        list
    };
    for set in sets() {
        let (queries, oracle) = (queries(&set, 40), oracle(&set));
        let expected: Vec<_> = queries.iter().map(|query| list(&*oracle, query)).collect();
        for_each_member(&set, |context, search| {
            for (query, expected) in queries.iter().zip(&expected) {
                let mut found = list(search, query);
                assert_eq!(found, list(search, query), "{context}: the order changed, {query:?}");
                let mut expected = expected.clone();
                found.sort_unstable();
                expected.sort_unstable();
                assert_eq!(found, expected, "{context}: {query:?}");
                let (mut counted, mut counters) = (Vec::new(), SearchCounters::default());
                search.visit_counted(
                    query,
                    &mut |photon, d2| counted.push((photon.to_words(), d2.to_bits())),
                    &mut counters,
                );
                counted.sort_unstable();
                assert_eq!(counted, expected, "{context}: counted, {query:?}");
                assert_counts(&counters, expected.len(), set.photons.len(), context);
            }
        });
    }
}

/// One search that found so many of so many photons.
#[track_caller]
fn assert_counts(counters: &SearchCounters, found: usize, photons: usize, context: &str) {
    assert_eq!((counters.searches, counters.photons_found), (1, found as u64), "{context}");
    // A search for the nearest may look at some photons in more than one ball.
    let most = 40 * photons as u64;
    assert!((counters.photons_found..=most).contains(&counters.photons_tested), "{context}: {counters:?}");
}

#[test]
fn neighbors_agree_with_the_oracle_bit_for_bit() {
    for set in sets() {
        let (queries, oracle) = (queries(&set, 24), oracle(&set));
        let radii = |query: &GatherQuery| [query.radius, query.radius * 7.0, f32::INFINITY];
        let of_query = |query: &GatherQuery| {
            let mut within = Vec::new();
            oracle.within_radius(query.position, query.radius, &mut within);
            let by_distance = radii(query).map(|radius| {
                let mut found = Vec::new();
                oracle.nearest(query.position, usize::MAX, radius, &mut found);
                found
            });
            (within, by_distance)
        };
        let expected: Vec<_> = queries.iter().map(of_query).collect();
        for_each_member(&set, |context, search| {
            let mut found = vec![Neighbor { distance_sq: 1.0, photon: 1 }];
            for (query, (within, by_distance)) in queries.iter().zip(&expected) {
                search.within_radius(query.position, query.radius, &mut found);
                assert_eq!(&found, within, "{context}: within, {query:?}");
                for n in found.iter().take(20) {
                    assert_eq!(search.photon(n.photon), set.photons[n.photon as usize], "{context}");
                }
                for (radius, by_distance) in radii(query).into_iter().zip(by_distance) {
                    for k in [0, 1, 2, 50, 999, usize::MAX] {
                        search.nearest(query.position, k, radius, &mut found);
                        let expected = &by_distance[..k.min(by_distance.len())];
                        assert_eq!(found, expected, "{context}: {k} nearest within {radius}, {query:?}");
                    }
                }
            }
        });
    }
}

#[test]
fn the_nearest_of_what_gather_finds_agree_with_the_oracle() {
    const COUNTS: [u32; 5] = [0, 1, 7, 60, u32::MAX];
    for set in sets() {
        let oracle = oracle(&set);
        let mut queries = queries(&set, 40);
        // Small and large balls, so that the limit bites in some and not in others; then everything.
        for (i, query) in queries.iter_mut().enumerate() {
            query.radius *= [1.0, 4.0, f32::INFINITY][i % 3];
        }
        queries.extend(crowds(&set, 9));
        let words = |found: &[(Photon, f32)]| {
            let mut words: Vec<_> = found.iter().map(|(photon, d2)| (d2.to_bits(), photon.to_words())).collect();
            words.sort_unstable();
            words
        };
        let expected = COUNTS.map(|k| {
            let mut sums = vec![GatheredNearest::default(); queries.len()];
            oracle.gather_nearest(&queries, k, Kernel::Epanechnikov, &mut sums);
            let collected = queries.iter().map(|query| {
                let mut found = Vec::new();
                oracle.collect_nearest(query, k, &mut found);
                words(&found)
            });
            (sums, collected.collect::<Vec<_>>())
        });
        for_each_member(&set, |context, search| {
            for (k, (sums, collected)) in COUNTS.into_iter().zip(&expected) {
                let mut found = vec![GatheredNearest { count: 9, ..Default::default() }; queries.len()];
                search.gather_nearest(&queries, k, Kernel::Epanechnikov, &mut found);
                for ((e, f), query) in sums.iter().zip(&found).zip(&queries) {
                    let context = format!("{context}: {k} nearest, {query:?}");
                    assert_eq!((e.count, e.farthest_sq), (f.count, f.farthest_sq), "{context}");
                    let close = (e.flux - f.flux).abs().cmple(e.flux.abs() * 1e-5 + 1e-30).all();
                    assert!(close, "{context}: {} for {}", f.flux, e.flux);
                }
                let (mut counters, mut counted) = (SearchCounters::default(), found.clone());
                search.gather_nearest_counted(&queries, k, Kernel::Epanechnikov, &mut counted, &mut counters);
                assert_eq!(counted, found, "{context}");
                assert_eq!(counters.searches, queries.len() as u64, "{context}");
                assert_eq!(counters.photons_found, found.iter().map(|f| u64::from(f.count)).sum::<u64>());
                for (query, expected) in queries.iter().zip(collected) {
                    let (mut collected, mut counters) = (Vec::new(), SearchCounters::default());
                    search.collect_nearest(query, k, &mut collected);
                    assert_eq!(&words(&collected), expected, "{context}: {k} nearest, {query:?}");
                    let before = collected.clone();
                    // What was there goes.
                    collected.extend(before.clone());
                    search.collect_nearest_counted(query, k, &mut collected, &mut counters);
                    assert_eq!(collected, before, "{context}: counted");
                    assert_counts(&counters, collected.len(), set.photons.len(), context);
                }
            }
        });
    }
}

/// Three photons on a line, one of them on a wall, whose answers need no program.
#[test]
fn every_member_knows_the_answers_of_three_photons() {
    let photon = |x: f32, normal: Vec3, depth: u32| {
        Photon::new(Vec3::new(x, 0.0, 0.0), Vec3::new(1.0, 0.5, 0.0), Vec3::Z, normal, depth, false).unwrap()
    };
    let photons = vec![photon(2.0, Vec3::Z, 1), photon(0.0, Vec3::Z, 3), photon(1.0, Vec3::X, 1)];
    let neighbor = |distance_sq: f32, photon: u32| Neighbor { distance_sq, photon };
    for member in SEARCHES.iter().filter(|m| m.is_exact) {
        let search = member.build(photons.clone(), &BuildOptions::default()).unwrap();
        let gather = |radius: f32, normal: Vec3, max_depth: u32, kernel: Kernel| {
            let query = GatherQuery { position: Vec3::ZERO, radius, normal, max_depth };
            let mut out = [Gathered::default()];
            search.gather(&[query], kernel, &mut out);
            (out[0].count, out[0].flux)
        };
        let name = member.name;
        let [far, near, wall] = [0, 1, 2].map(|i: usize| photons[i].flux());
        assert_eq!(gather(2.0, Vec3::Z, 9, Kernel::Constant), (2, far + near), "{name}: the rim belongs to it");
        assert_eq!(gather(1.999, Vec3::Z, 9, Kernel::Constant), (1, near), "{name}: beyond the rim");
        assert_eq!(gather(2.0, Vec3::X, 9, Kernel::Constant), (1, wall), "{name}: normals");
        assert_eq!(gather(2.0, Vec3::Z, 2, Kernel::Constant), (1, far), "{name}: depth");
        assert_eq!(gather(2.0, -Vec3::Z, 9, Kernel::Constant), (0, Vec3::ZERO), "{name}: from behind");
        assert_eq!(gather(0.0, Vec3::Z, 9, Kernel::Constant), (1, near), "{name}: radius 0");
        let (count, sum) = gather(4.0, Vec3::Z, 9, Kernel::Epanechnikov);
        assert_eq!(count, 2, "{name}");
        assert!((sum - near - far * 0.75).length() < 1e-5, "{name}: {sum}");
        let slanted = |degrees: f32| Vec3::new(libm::sinf(degrees.to_radians()), 0.0, libm::cosf(degrees.to_radians()));
        assert_eq!(gather(0.5, slanted(59.9), 9, Kernel::Constant).0, 1, "{name}: 59.9 degrees");
        assert_eq!(gather(0.5, slanted(60.1), 9, Kernel::Constant).0, 0, "{name}: 60.1 degrees");
        let mut found = Vec::new();
        search.nearest(Vec3::new(0.9, 0.0, 0.0), 2, 5.0, &mut found);
        assert_eq!(found.iter().map(|n| n.photon).collect::<Vec<_>>(), [2, 1], "{name}");
        search.nearest(Vec3::new(1.0, 0.0, 0.0), 3, 1.0, &mut found);
        assert_eq!(found, [neighbor(0.0, 2), neighbor(1.0, 0), neighbor(1.0, 1)], "{name}: ties go by id");
        search.within_radius(Vec3::ZERO, 1.0, &mut found);
        assert_eq!(found, [neighbor(0.0, 1), neighbor(1.0, 2)], "{name}");
        let nearest = |k: u32, radius: f32, normal: Vec3, max_depth: u32| {
            let query = GatherQuery { position: Vec3::new(1.0, 0.0, 0.0), radius, normal, max_depth };
            let mut out = [GatheredNearest::default()];
            search.gather_nearest(&[query], k, Kernel::Constant, &mut out);
            (out[0].count, out[0].farthest_sq, out[0].flux)
        };
        assert_eq!(nearest(1, 3.0, Vec3::X, 9), (1, 0.0, wall), "{name}: the wall's photon");
        assert_eq!(nearest(1, 3.0, Vec3::Z, 9), (2, 1.0, far + near), "{name}: both at the distance of the first");
        assert_eq!(nearest(1, 3.0, Vec3::Z, 2), (1, 1.0, far), "{name}: depth");
        assert_eq!(nearest(0, 3.0, Vec3::Z, 9), (0, 0.0, Vec3::ZERO), "{name}: none wanted");
        assert_eq!(nearest(5, 0.9, Vec3::Z, 9), (0, 0.0, Vec3::ZERO), "{name}: none near");
        assert_eq!(search.photon(2), photons[2], "{name}");
        assert_eq!(search.summary().photons, 3, "{name}");
    }
}

#[test]
fn names_are_unique_and_found() {
    for member in SEARCHES {
        assert_eq!(SEARCHES.iter().filter(|m| m.name == member.name).count(), 1);
        for name in [member.name.to_owned(), member.name.replace('-', "_")] {
            let search = build(&name, Vec::new(), &BuildOptions::default()).unwrap();
            assert_eq!(search.summary().name, member.name);
        }
    }
    assert_eq!(kd_balanced(Vec::new()).unwrap().summary().name, "kd-balanced");
    let error = build("voxels", Vec::new(), &BuildOptions::default()).err().unwrap().to_string();
    assert!(error.contains("voxels") && error.contains("grid, "), "{error}");
}
