//! Every set of vector kernels against the scalar one, bit for bit, and answers that must not depend on the batch.

use super::*;
use support::{SEED, crowds, queries, sets};

#[path = "../../../tests/support/mod.rs"]
mod support;

const KERNELS: [Kernel; 4] = [Kernel::Constant, Kernel::Cone { k: 1.1 }, Kernel::Epanechnikov, Kernel::Gaussian];

fn bits(gathered: &[Gathered]) -> Vec<[u32; 4]> {
    gathered.iter().map(|g| [g.flux.x.to_bits(), g.flux.y.to_bits(), g.flux.z.to_bits(), g.count]).collect()
}

#[test]
fn vector_kernels_equal_the_scalar_kernel_bit_for_bit() {
    let kernels = kernels::available();
    for set in sets() {
        let queries = queries(&set, 160);
        let grid =
            |kernels| Grid::with_kernels(set.photons.clone(), &BuildOptions { radius_hint: set.radius }, kernels);
        let scalar = grid(scalar::KERNELS);
        for &kernels in kernels {
            let vector = grid(kernels);
            let context = format!("seed {SEED}: {} on '{}'", kernels.name, set.name);
            for kernel in KERNELS {
                let gather = |grid: &Grid| {
                    let mut out = vec![Gathered::default(); queries.len()];
                    grid.gather(&queries, kernel, &mut out);
                    bits(&out)
                };
                assert_eq!(gather(&vector), gather(&scalar), "{context}, {kernel:?}");
            }
            let crowds = crowds(&set, 40);
            for (k, kernel) in [1, 7, 40, 1000].into_iter().zip(KERNELS) {
                let gather = |grid: &Grid| {
                    let mut out = vec![GatheredNearest::default(); crowds.len()];
                    grid.gather_nearest(&crowds, k, kernel, &mut out);
                    let sums = |g: &GatheredNearest| [g.flux.x, g.flux.y, g.flux.z, g.farthest_sq].map(f32::to_bits);
                    out.iter().map(|g| (g.count, sums(g))).collect::<Vec<_>>()
                };
                let (vector, scalar) = (gather(&vector), gather(&scalar));
                assert_eq!(vector, scalar, "{context}, {k} nearest");
            }
            let (mut expected, mut found) = (Vec::new(), Vec::new());
            for query in &queries {
                scalar.within_radius(query.position, query.radius, &mut expected);
                vector.within_radius(query.position, query.radius, &mut found);
                assert_eq!(found, expected, "{context}: within, {query:?}");
                let visited = |grid: &Grid| {
                    let mut visited = Vec::new();
                    grid.visit(query, &mut |photon, d2| visited.push((photon.to_words(), d2.to_bits())));
                    visited
                };
                assert_eq!(visited(&vector), visited(&scalar), "{context}: visits, {query:?}");
                for k in [1, 50, 300] {
                    scalar.nearest(query.position, k, query.radius * 2.0, &mut expected);
                    vector.nearest(query.position, k, query.radius * 2.0, &mut found);
                    assert_eq!(found, expected, "{context}: {k} nearest, {query:?}");
                }
            }
        }
    }
}

#[test]
fn results_depend_on_neither_batch_nor_threads() {
    for set in sets().iter().filter(|set| ["box", "sphere", "room on a plane"].contains(&set.name)) {
        let mut queries = queries(set, 3000);
        let gather = |threads: usize, queries: &[GatherQuery]| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                let grid = Grid::new(set.photons.clone(), &BuildOptions { radius_hint: set.radius });
                let mut out = vec![Gathered::default(); queries.len()];
                grid.gather(queries, Kernel::Epanechnikov, &mut out);
                bits(&out)
            })
        };
        let expected = gather(1, &queries);
        for threads in [2, 7] {
            assert_eq!(gather(threads, &queries), expected, "seed {SEED}: {threads} threads on '{}'", set.name);
        }
        let grid = Grid::new(set.photons.clone(), &BuildOptions { radius_hint: set.radius });
        for (query, expected) in queries.iter().zip(&expected).take(300) {
            let mut out = [Gathered::default()];
            grid.gather(std::slice::from_ref(query), Kernel::Epanechnikov, &mut out);
            assert_eq!(bits(&out), [*expected], "seed {SEED}: alone on '{}': {query:?}", set.name);
        }
        let crowds = crowds(set, 200);
        for kernel in [Kernel::Constant, Kernel::Epanechnikov] {
            let mut nearest = vec![GatheredNearest::default(); crowds.len()];
            grid.gather_nearest(&crowds, 30, kernel, &mut nearest);
            for (query, expected) in crowds.iter().zip(&nearest) {
                let mut out = [GatheredNearest::default()];
                grid.gather_nearest(std::slice::from_ref(query), 30, kernel, &mut out);
                assert_eq!(&out[0], expected, "seed {SEED}: 30 nearest, alone on '{}': {query:?}", set.name);
            }
        }
        queries.reverse();
        let mut reversed = gather(2, &queries);
        reversed.reverse();
        assert_eq!(reversed, expected, "seed {SEED}: reversed on '{}'", set.name);
    }
}

/// Enough photons for many tasks, with keys of both lengths.
#[test]
fn a_large_map_is_laid_out_alike_by_any_number_of_threads() {
    let photons = support::photons(12, 150_000, |s| support::on_box(s, Vec3::new(4.0, 3.0, 5.0)));
    for radius_hint in [0.05, 1e-4] {
        let layout = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let grid = pool.install(|| Grid::new(photons.clone(), &BuildOptions { radius_hint }));
            let slots = |slot: usize| (grid.ids.as_flattened()[slot], grid.blocks[slot / LANES].photon(slot % LANES));
            let bounds = grid.boxes.bounds.clone().map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>());
            ((0..photons.len()).map(slots).collect::<Vec<_>>(), bounds)
        };
        let (slots, bounds) = layout(1);
        for threads in [2, 5] {
            assert!(layout(threads) == (slots.clone(), bounds.clone()), "seed 12: {threads} threads, {radius_hint}");
        }
        let mut ids: Vec<u32> = slots.iter().map(|(id, _)| *id).collect();
        ids.sort_unstable();
        assert!(ids.into_iter().eq(0..photons.len() as u32), "seed 12: each photon once, {radius_hint}");
        for (slot, (id, photon)) in slots.iter().enumerate() {
            assert_eq!(photon, &photons[*id as usize], "seed 12: slot {slot}, {radius_hint}");
            for axis in 0..3 {
                let [least, most] = [axis, axis + 3].map(|side| f32::from_bits(bounds[side][slot / LANES]));
                assert!((least..=most).contains(&photon.position()[axis]), "seed 12: slot {slot}, {radius_hint}");
            }
        }
    }
}

/// Few queries over many photons, which are fetched ahead, and many, which are sorted; both with some that are none or far out.
#[test]
fn large_batches_over_a_large_map_find_what_single_queries_find() {
    let size = Vec3::new(4.0, 3.0, 5.0);
    let photons = support::photons(14, 150_000, |s| support::on_box(s, size));
    let radius = 0.05;
    let grid = Grid::new(photons, &BuildOptions { radius_hint: radius });
    for count in [600, 20_000] {
        let mut queries: Vec<GatherQuery> = (0..count)
            .map(|i| {
                let (position, normal) = support::on_box(&mut support::sampler(15, i), size);
                GatherQuery { position, radius, normal, max_depth: 100 }
            })
            .collect();
        queries[17].position = Vec3::splat(1e30);
        queries[18].position.x = f32::NAN;
        queries[19].position = Vec3::splat(-7.0);
        queries[20].radius = f32::NAN;
        queries[21].radius = 0.0;
        queries[22].radius = f32::INFINITY;
        let mut expected = vec![Gathered::default(); count];
        for (query, out) in queries.iter().zip(&mut expected) {
            grid.gather(std::slice::from_ref(query), Kernel::Constant, std::slice::from_mut(out));
        }
        for threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut out = vec![Gathered::default(); count];
            pool.install(|| grid.gather(&queries, Kernel::Constant, &mut out));
            assert_eq!(bits(&out), bits(&expected), "seeds 14 and 15: {count} queries, {threads} threads");
        }
    }
}

/// Queries as close to one another as numbers are, whose middle is none: radius 0 finds what lies at the very position, in
/// whatever company.
#[test]
fn neighbours_that_are_one_number_apart_find_what_is_theirs() {
    let x = 1000f32;
    let places = [x, x.next_up()].map(|x| Vec3::new(x, 0.0, 0.0));
    let photon = |p: Vec3| Photon::new(p, Vec3::ONE, Vec3::Z, Vec3::Z, 1, false).expect("a photon");
    let mut photons: Vec<Photon> = places.into_iter().flat_map(|p| [photon(p); 5]).collect();
    photons.push(photon(Vec3::new(x - 1.0, 0.0, 0.0)));
    let grid = Grid::new(photons, &BuildOptions { radius_hint: 1.0 });
    let at = |position: Vec3, radius: f32| GatherQuery { position, radius, normal: Vec3::Z, max_depth: 9 };
    // The first needs a wide ball, which lets the others be answered together.
    let mut queries = vec![at(Vec3::new(x, 0.01, 0.0), 0.5)];
    queries.extend((0..8).map(|i| at(places[i % 2], 0.0)));
    for queries in [queries.clone(), queries.into_iter().rev().collect()] {
        let mut together = vec![GatheredNearest::default(); queries.len()];
        grid.gather_nearest(&queries, 3, Kernel::Constant, &mut together);
        for (query, together) in queries.iter().zip(&together) {
            let mut alone = [GatheredNearest::default()];
            grid.gather_nearest(std::slice::from_ref(query), 3, Kernel::Constant, &mut alone);
            assert_eq!(*together, alone[0], "{query:?}");
        }
    }
}

/// Photons in heaps, more and fewer than are shared, of which a query is turned towards every other one, so that half of the
/// lanes stay empty.
#[test]
fn heaps_are_summed_as_one_by_one() {
    let heap = |x: f32, count: usize| {
        (0..count).map(move |i| {
            let normal = if i % 2 == 0 { Vec3::Z } else { Vec3::X };
            let flux = Vec3::new(1.0, 0.3, 7.0) * (1.0 + (i % 97) as f32);
            Photon::new(Vec3::new(x, 0.0, 0.0), flux, Vec3::Z, normal, 1, false).expect("a photon")
        })
    };
    let photons: Vec<Photon> = heap(0.0, 100_000).chain(heap(9.0, 30_000)).collect();
    for &kernels in kernels::available() {
        let grid = Grid::with_kernels(photons.clone(), &BuildOptions { radius_hint: 1.0 }, kernels);
        for k in [5, 14_000, u32::MAX] {
            let near = |i: usize| GatherQuery {
                position: Vec3::new([0.0, 9.0][i % 2], 0.01 * i as f32, 0.0),
                radius: 1.0,
                normal: if i < 20 { Vec3::Z } else { Vec3::new(0.1, 0.0, 1.0).normalize() },
                max_depth: 9,
            };
            let queries: Vec<GatherQuery> = (0..40).map(near).collect();
            for kernel in [Kernel::Constant, Kernel::Epanechnikov] {
                let mut together = vec![GatheredNearest::default(); queries.len()];
                grid.gather_nearest(&queries, k, kernel, &mut together);
                for (query, together) in queries.iter().zip(&together) {
                    let mut alone = [GatheredNearest::default()];
                    grid.gather_nearest(std::slice::from_ref(query), k, kernel, &mut alone);
                    assert_eq!(*together, alone[0], "{}, {k} nearest, {query:?}", kernels.name);
                    assert!(together.count >= 15_000, "{query:?}: {}", together.count);
                }
            }
        }
    }
}

/// Photons of the same weight whose fluxes span few octaves and many, black ones among them: sums are those in f64 of each
/// by itself, to the last bit where those are exact, in any company.
#[test]
fn photons_that_weigh_the_same_are_summed_exactly() {
    for (spread, black) in [(0, 1), (1, 3), (6, 7), (14, 5), (30, 4), (60, usize::MAX)] {
        let photons: Vec<Photon> = support::photons(40 + spread, 3000, |s| {
            let [u, v] = s.next_2d();
            (Vec3::new(u, v, 0.0), Vec3::Z)
        })
        .into_iter()
        .enumerate()
        .map(|(i, photon)| {
            let octave = (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
            let scale = libm::exp2f(-((octave % (spread + 1)) as f32));
            let flux = if i % black == 0 { Vec3::ZERO } else { Vec3::new(0.7, 1.0, 0.001) * scale };
            Photon::new(photon.position(), flux, Vec3::Z, Vec3::Z, 1, false).expect("a photon")
        })
        .collect();
        let at = |i: usize| GatherQuery {
            position: Vec3::new(0.45 + 0.0005 * (i % 30) as f32, 0.4 + 0.0005 * (i / 30) as f32, 0.0),
            radius: 0.2,
            // Now all alike, now not.
            normal: if i < 450 { Vec3::Z } else { Vec3::new(0.001 * i as f32, 0.0, 1.0).normalize() },
            max_depth: 9,
        };
        let queries: Vec<GatherQuery> = (0..900).map(at).collect();
        for &kernels in kernels::available() {
            let grid = Grid::with_kernels(photons.clone(), &BuildOptions { radius_hint: 0.1 }, kernels);
            let mut together = vec![GatheredNearest::default(); queries.len()];
            grid.gather_nearest(&queries, 60, Kernel::Constant, &mut together);
            for (query, together) in queries.iter().zip(&together) {
                let mut alone = [GatheredNearest::default()];
                grid.gather_nearest(std::slice::from_ref(query), 60, Kernel::Constant, &mut alone);
                assert_eq!(*together, alone[0], "{}, {spread} octaves, {query:?}", kernels.name);
                let mut sums = [0f64; 3];
                for photon in &photons {
                    let d2 = crate::inclusion::distance_sq(photon.position(), query.position);
                    let is_found = d2 <= together.farthest_sq && together.count > 0;
                    let flux = if is_found { photon.flux().to_array() } else { [0.0; 3] };
                    (0..3).for_each(|c| sums[c] += f64::from(flux[c]));
                }
                let sums = Vec3::from_array(sums.map(|sum| sum as f32));
                assert_eq!(together.count, 60, "{query:?}");
                if spread <= 30 {
                    assert_eq!(together.flux, sums, "{}, {spread} octaves, {query:?}", kernels.name);
                }
            }
        }
    }
}
