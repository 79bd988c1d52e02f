//! Every member against `brute-force`, over photons and queries of every kind.

mod support;

use photinus_photons::{BuildOptions, Gathered, Kernel, Neighbor, SEARCHES, Search, build};
use photinus_profile::SearchCounters;
use support::{SEED, Set, queries, sets};

const KERNELS: [Kernel; 4] = [Kernel::Constant, Kernel::Cone { k: 1.1 }, Kernel::Epanechnikov, Kernel::Gaussian];

/// Calls `check` with every member, built with the hint that suits and without one, beside the oracle.
fn for_each_member(set: &Set, mut check: impl FnMut(&str, &dyn Search, &dyn Search)) {
    println!("seed {SEED}, set '{}'", set.name);
    let oracle = build("brute-force", set.photons.clone(), &BuildOptions::default()).unwrap();
    for member in SEARCHES {
        for radius_hint in [set.radius, 0.0, set.radius * 30.0] {
            let search = member.build(set.photons.clone(), &BuildOptions { radius_hint }).unwrap();
            check(&format!("{} on '{}' with hint {radius_hint:?}", member.name, set.name), &*search, &*oracle);
        }
    }
}

#[test]
fn gather_agrees_with_the_oracle() {
    for set in sets() {
        let queries = queries(&set, 96);
        for_each_member(&set, |context, search, oracle| {
            for kernel in KERNELS {
                let mut expected = vec![Gathered::default(); queries.len()];
                let mut found = vec![Gathered { count: 9, ..Default::default() }; queries.len()];
                oracle.gather(&queries, kernel, &mut expected);
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
    for set in sets() {
        let queries = queries(&set, 64);
        for_each_member(&set, |context, search, oracle| {
            for query in &queries {
                let list = |s: &dyn Search| {
                    let mut list = Vec::new();
                    s.visit(query, &mut |photon, d2| list.push((photon.to_words(), d2.to_bits())));
                    let first = list.clone();
                    list.clear();
                    s.visit(query, &mut |photon, d2| list.push((photon.to_words(), d2.to_bits())));
                    assert_eq!(list, first, "{context}: order");
                    list.sort_unstable();
                    list
                };
                assert_eq!(list(search), list(oracle), "{context}: {query:?}");
            }
        });
    }
}

#[test]
fn neighbors_agree_with_the_oracle_bit_for_bit() {
    for set in sets() {
        let queries = queries(&set, 64);
        for_each_member(&set, |context, search, oracle| {
            let (mut expected, mut found) = (Vec::new(), vec![Neighbor { distance_sq: 1.0, photon: 1 }]);
            for query in &queries {
                oracle.within_radius(query.position, query.radius, &mut expected);
                search.within_radius(query.position, query.radius, &mut found);
                assert_eq!(expected, found, "{context}: within, {query:?}");
                for n in found.iter().take(20) {
                    assert_eq!(search.photon(n.photon), set.photons[n.photon as usize], "{context}");
                }
                for k in [0, 1, 2, 7, 50, 999, set.photons.len(), usize::MAX] {
                    for radius in [query.radius, query.radius * 10.0, f32::INFINITY] {
                        oracle.nearest(query.position, k, radius, &mut expected);
                        search.nearest(query.position, k, radius, &mut found);
                        assert_eq!(expected, found, "{context}: {k} nearest within {radius}, {query:?}");
                    }
                }
            }
        });
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
    let error = build("octree", Vec::new(), &BuildOptions::default()).err().unwrap().to_string();
    assert!(error.contains("octree") && error.contains("grid, "), "{error}");
}
