//! The questions: where photons are looked for, how far, and in which order.

use crate::data::Data;
use photinus_geometry::Vec3;
use photinus_num::{Sampler, StreamKind};
use photinus_photons::{GatherQuery, Gathered, Kernel, Search};

/// Photons that a search is to find, on the mean.
pub const FOUND: f64 = 86.0;
/// The nearest that are looked for.
pub const K: u32 = 50;
/// How far they are looked for, in radii that hold [`FOUND`] photons.
const CAP: f32 = 2.0;
/// Seed of the order.
const SEED: u64 = 4;

/// What is asked about photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// The sum of their flux, within the radius.
    Flux,
    /// The [`K`] nearest within the radius: their summed flux, or a list of them.
    Nearest,
}

/// Queries of one kind.
pub struct Set {
    /// Its name.
    pub name: &'static str,
    /// The question.
    pub question: Question,
    /// Places and radii, in their order.
    pub queries: Vec<GatherQuery>,
}

/// All sets over the places of a scene, for photons of which a ball of `radius` holds as many as are to be found.
pub fn all(data: &Data, radius: f32) -> Vec<Set> {
    let queries = |radius: f32| -> Vec<GatherQuery> {
        data.places.iter().map(|(position, normal)| query(*position, *normal, radius)).collect()
    };
    let shuffled = |queries: &[GatherQuery]| {
        let mut queries = queries.to_vec();
        shuffle(&mut queries);
        queries
    };
    let (flux, nearest) = (queries(radius), queries(radius * CAP));
    let (flux_shuffled, nearest_shuffled) = (shuffled(&flux), shuffled(&nearest));
    vec![
        Set { name: "flux", question: Question::Flux, queries: flux },
        Set { name: "flux-shuffled", question: Question::Flux, queries: flux_shuffled },
        Set { name: "nearest", question: Question::Nearest, queries: nearest },
        Set { name: "nearest-shuffled", question: Question::Nearest, queries: nearest_shuffled },
    ]
}

fn query(position: Vec3, normal: Vec3, radius: f32) -> GatherQuery {
    GatherQuery { position, radius, normal, max_depth: 127 }
}

/// The radius within which searches at the places find [`FOUND`] photons on the mean, to a thousandth: the area of a
/// disc grows as its photons do, so that a few steps suffice.
pub fn radius(search: &dyn Search, data: &Data) -> Result<f32, String> {
    let middle = data.places[data.places.len() / 2].0;
    let mut nearest = Vec::new();
    search.nearest(middle, FOUND as usize, f32::INFINITY, &mut nearest);
    let mut radius = nearest.last().map_or(0.0, |last| last.distance_sq.sqrt());
    let mut out = vec![Gathered::default(); data.places.len()];
    for _ in 0..20 {
        if !(radius > 0.0 && radius.is_finite()) {
            break;
        }
        let queries: Vec<GatherQuery> = data.places.iter().map(|(p, n)| query(*p, *n, radius)).collect();
        search.gather(&queries, Kernel::Constant, &mut out);
        let found = out.iter().map(|out| f64::from(out.count)).sum::<f64>() / out.len() as f64;
        if (found - FOUND).abs() <= 1e-3 * FOUND {
            return Ok(radius);
        }
        radius *= (FOUND / found.max(1.0)).sqrt() as f32;
    }
    Err(format!("{}: no radius holds {FOUND} photons on the mean", data.name))
}

fn shuffle(queries: &mut [GatherQuery]) {
    for i in (1..queries.len()).rev() {
        let random = Sampler::new(SEED, StreamKind::Test, 0, i as u32).next_1d();
        let j = (f64::from(random) * (i + 1) as f64) as usize;
        queries.swap(i, j.min(i));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_photons::{BuildOptions, DEFAULT_SEARCH};

    #[test]
    fn radii_hold_as_many_photons_as_are_to_be_found_and_orders_hold_the_same_queries() {
        let data = crate::data::load("room-1", 20_000, 2000).unwrap();
        let search = photinus_photons::build(DEFAULT_SEARCH, data.photons.clone(), &BuildOptions::default()).unwrap();
        let sets = all(&data, radius(&*search, &data).unwrap());
        let mut out = vec![Gathered::default(); data.places.len()];
        search.gather(&sets[0].queries, Kernel::Constant, &mut out);
        let mean = out.iter().map(|out| f64::from(out.count)).sum::<f64>() / out.len() as f64;
        assert!((mean - FOUND).abs() < 0.1, "{mean}");
        let key = |query: &GatherQuery| query.position.to_array().map(f32::to_bits);
        for pair in sets.chunks(2) {
            let sorted = |set: &Set| {
                let mut keys: Vec<_> = set.queries.iter().map(key).collect();
                keys.sort_unstable();
                keys
            };
            assert_eq!(sorted(&pair[0]), sorted(&pair[1]));
            assert_ne!(key(&pair[0].queries[0]), key(&pair[1].queries[0]));
        }
    }
}
