//! The kernels against the plain one, which [`crate::searches::brute_force`] is the oracle of.

use super::*;
use crate::results::List;
use crate::{Neighbor, Search};
use photinus_geometry::Vec3;
use photinus_num::{Sampler, StreamKind};

#[test]
fn all_kernels_find_the_same() {
    let point = |s: &mut Sampler| Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
    let photons: Vec<Photon> = (0..5003)
        .map(|i| {
            let position = point(&mut Sampler::new(21, StreamKind::Test, 0, i));
            Photon::new(position, Vec3::ONE, Vec3::Z, Vec3::Z, 1, false).unwrap()
        })
        .collect();
    let regions: Vec<Region> = (0..300)
        .map(|i| {
            let s = &mut Sampler::new(21, StreamKind::Test, 1, i);
            // Some have photons at their rims.
            let center = photons[(s.next_1d() * 5000.0) as usize].position();
            let corner = photons[(s.next_1d() * 5000.0) as usize].position();
            match i % 3 {
                0 => Region::Sphere { center, radius: (corner - center).length() * 0.3 },
                1 => Region::Cuboid { center, half: (corner - center).abs() },
                _ => Region::Bounds { min: center.min(corner), max: center.max(corner) },
            }
        })
        .collect();
    let find = |kernel: &SieveKernel| {
        let search = BruteBlocked::with_kernel(&photons, *kernel);
        let one = |region: &Region| -> Vec<Neighbor> {
            let mut list = List::default();
            assert_eq!(search.search(region, &mut list), photons.len() as u64);
            list.into_found()
        };
        let mut runs = Vec::new();
        search.index().search_all(&regions, &mut |query, places| runs.push((query, places)));
        (regions.iter().map(one).collect::<Vec<_>>(), runs)
    };
    let (plain, runs) = find(kernels::available().last().unwrap());
    assert!(plain.iter().map(Vec::len).sum::<usize>() > 10_000);
    for kernel in kernels::available() {
        let found = find(kernel);
        assert_eq!((&found.0, &found.1), (&plain, &runs), "{}", kernel.name);
    }
}
