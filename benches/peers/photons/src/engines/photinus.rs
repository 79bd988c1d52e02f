//! Our default search, asked as a program asks a library: all queries in one call, or one by one for lists.

use super::{Answer, Cloud, Engine, Reach};
use crate::Arguments;
use crate::clock::timed;
use crate::sets::{K, Question, Set};
use photinus_geometry::Vec3;
use photinus_photons::{BuildOptions, DEFAULT_SEARCH, Gathered, GatheredNearest, Kernel, Photon, Search};
use photinus_profile::SearchCounters;
use rayon::prelude::*;

/// Queries that a thread takes at a time where they are asked one by one.
const SHARE: usize = 4096;

/// The search of that name over some photons, with the radius that it will be asked for.
fn build(name: &str, photons: Vec<Photon>, radius: f32) -> Result<Box<dyn Search>, String> {
    photinus_photons::build(name, photons, &BuildOptions { radius_hint: radius }).map_err(|error| error.to_string())
}

/// The search that tests all photons for all queries.
pub fn build_blocked(cloud: &Cloud) -> Result<Box<dyn Search>, String> {
    build("brute-force-blocked", cloud.photons.to_vec(), cloud.radius)
}

#[derive(Default)]
struct Ours {
    search: Option<Box<dyn Search>>,
    /// Lists of the nearest instead of sums.
    lists: bool,
}

/// Sums of flux.
pub fn open(_: &Arguments) -> Result<Box<dyn Engine>, String> {
    Ok(Box::new(Ours::default()))
}

/// Lists of the nearest, which others give.
pub fn open_list(_: &Arguments) -> Result<Box<dyn Engine>, String> {
    Ok(Box::new(Ours { search: None, lists: true }))
}

impl Engine for Ours {
    fn build(&mut self, cloud: &Cloud, threads: usize) -> Result<f64, String> {
        self.search = None;
        let photons = cloud.photons.to_vec();
        let (seconds, search) = timed(threads, || build(DEFAULT_SEARCH, photons, cloud.radius));
        self.search = Some(search?);
        Ok(seconds)
    }

    fn builds_in_parallel(&self) -> bool {
        true
    }

    fn is_for(&self, question: Question) -> bool {
        !self.lists || question == Question::Nearest
    }

    fn ask(&mut self, set: &Set, threads: usize) -> Result<(f64, Vec<Answer>), String> {
        let search = self.search.as_deref().ok_or("nothing was built")?;
        match (self.lists, set.question) {
            (false, Question::Flux) => {
                let mut out = vec![Gathered::default(); set.queries.len()];
                let (seconds, ()) = timed(threads, || search.gather(&set.queries, Kernel::Constant, &mut out));
                let answer = |sums: &Gathered| answer(sums.count, sums.flux, 0.0);
                Ok((seconds, out.iter().map(answer).collect()))
            }
            (false, Question::Nearest) => {
                let mut out = vec![GatheredNearest::default(); set.queries.len()];
                let (seconds, ()) =
                    timed(threads, || search.gather_nearest(&set.queries, K, Kernel::Constant, &mut out));
                let answer = |sums: &GatheredNearest| answer(sums.count, sums.flux, sums.farthest_sq);
                Ok((seconds, out.iter().map(answer).collect()))
            }
            (true, Question::Nearest) => {
                let mut out = vec![Answer::default(); set.queries.len()];
                let parts = set.queries.par_chunks(SHARE).zip(out.par_chunks_mut(SHARE));
                let (seconds, ()) = timed(threads, || {
                    parts.for_each(|(queries, out)| {
                        let mut found = Vec::new();
                        for (query, out) in queries.iter().zip(out) {
                            search.nearest(query.position, K as usize, query.radius, &mut found);
                            let farthest_sq = found.last().map_or(0.0, |last| last.distance_sq);
                            *out = Answer { count: found.len() as u32, flux: None, farthest_sq };
                        }
                    });
                });
                Ok((seconds, out))
            }
            (true, Question::Flux) => Err("is for lists of the nearest".into()),
        }
    }

    fn reach(&self, _: &Set) -> Reach {
        if self.lists { Reach::All } else { Reach::Facing }
    }

    fn about(&self, _: &Set) -> &'static str {
        if self.lists { "list, all normals" } else { "flux, facing normals" }
    }

    fn work(&self, set: &Set) -> Option<String> {
        let search = self.search.as_deref().filter(|_| !self.lists && set.question == Question::Flux)?;
        let mut counters = SearchCounters::default();
        let mut out = vec![Gathered::default(); set.queries.len()];
        search.gather_counted(&set.queries, Kernel::Constant, &mut out, &mut counters);
        let most = out.iter().map(|sums| sums.count).max().unwrap_or(0);
        let [tested, found] =
            [counters.photons_tested, counters.photons_found].map(|count| count as f64 / set.queries.len() as f64);
        Some(format!("{tested:.0} photons tested and {found:.0} found a search, {most} at most"))
    }
}

fn answer(count: u32, flux: Vec3, farthest_sq: f32) -> Answer {
    Answer { count, flux: Some(flux.to_array()), farthest_sq }
}
