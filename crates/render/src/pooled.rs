//! Estimates of a tile that are made together with those of other tiles, in the order of the places that they ask about.

use crate::maps::Map;
use crate::sort::Sorter;
use photinus_geometry::Vec3;
use photinus_photons::GatherQuery;

/// Most estimates of a run: work is cut between runs.
pub(crate) const LONGEST_RUN: u32 = 1 << 12;
/// Bits of a neighbourhood by which no run ends: estimates of a tile that differ in these alone are close together,
/// and runs are fewer to sort than estimates.
const CLOSE_BITS: u32 = 6;

/// Estimates over the nearest photons, on surfaces that scatter alike from all directions, as a tile asks for them.
/// Tiles hand its memory on to one another, so that it stays in the caches.
#[derive(Default)]
pub(crate) struct Asking {
    queries: Vec<GatherQuery>,
    uses: Vec<Use>,
    keys: Vec<u64>,
    sorter: Sorter,
}

/// All that a tile asks for in a sample.
#[derive(Default)]
pub(crate) struct Pooled {
    /// In the order of their neighbourhoods.
    pub spots: Vec<Spot>,
    /// The same, cut where neighbourhoods end.
    pub runs: Vec<Run>,
    /// When each was asked for.
    pub turns: Vec<u32>,
    /// In the order in which they were asked for.
    pub uses: Vec<Use>,
}

/// What queries of one map do not have in common.
#[derive(Clone, Copy)]
pub(crate) struct Spot {
    pub position: Vec3,
    pub normal: Vec3,
}

/// Estimates that lie close together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// A number that is near for runs that are neighbours.
    pub key: u64,
    pub count: u32,
}

/// What an estimate is for.
#[derive(Clone, Copy)]
pub(crate) struct Use {
    /// Throughput times scattering, 1/sr.
    pub factor: Vec3,
    /// Pixel within the tile.
    pub pixel: u32,
}

impl Asking {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.queries.clear();
        self.uses.clear();
    }

    /// One more for a pixel of the tile, within the radius of the map and of any depth; `factor` is throughput times
    /// scattering, 1/sr.
    pub fn push(&mut self, query: GatherQuery, factor: Vec3, pixel: u32) {
        self.queries.push(query);
        self.uses.push(Use { factor, pixel });
    }

    /// Copies all into `pooled`, once they are there.
    pub fn file(&mut self, map: &Map, pooled: &mut Pooled) {
        let Self { queries, uses, keys, sorter } = self;
        map.search.neighbourhoods(queries, keys);
        sorter.sort(keys);
        let places = sorter.places();
        let spot = |GatherQuery { position, normal, .. }| Spot { position, normal };
        refill(&mut pooled.spots, places.clone().map(|place| spot(queries[place])));
        refill(&mut pooled.turns, places.clone().map(|place| place as u32));
        refill(&mut pooled.uses, uses.iter().copied());
        cut(places.map(|place| keys[place] >> CLOSE_BITS), &mut pooled.runs);
    }
}

/// Makes a list what `from` says. What it held is not copied where it grows, and what it has more than that is memory
/// that nobody has touched until a tile asks for more.
fn refill<T>(list: &mut Vec<T>, from: impl ExactSizeIterator<Item = T>) {
    list.clear();
    if list.capacity() < from.len() {
        *list = Vec::new();
        list.reserve_exact(from.len().next_power_of_two());
    }
    list.extend(from);
}

/// Makes `runs` those of equal keys.
fn cut(keys: impl Iterator<Item = u64>, runs: &mut Vec<Run>) {
    runs.clear();
    for key in keys {
        match runs.last_mut() {
            Some(run) if run.key == key && run.count < LONGEST_RUN => run.count += 1,
            _ => runs.push(Run { key, count: 1 }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_end_with_their_keys_and_where_they_are_long() {
        let mut runs = Vec::new();
        let long = std::iter::repeat_n(9, LONGEST_RUN as usize + 1);
        cut([4, 4, 4, 7].into_iter().chain(long).chain([11]), &mut runs);
        let expected = [(4, 3), (7, 1), (9, LONGEST_RUN), (9, 1), (11, 1)];
        assert_eq!(runs, expected.map(|(key, count)| Run { key, count }));
        cut(std::iter::empty(), &mut runs);
        assert_eq!(runs, []);
    }
}
