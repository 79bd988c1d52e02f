//! Estimates of many tiles, made together: those that lie close to one another look the photons around them up once,
//! whichever tiles ask for them.

use crate::control::Observer;
use crate::counters::Counters;
use crate::maps::{Estimated, Map};
use crate::sort::sorted_places;
use crate::tile::Spare;
use crate::twin::Twin;
use photinus_geometry::Vec3;
use photinus_photons::{GatherQuery, GatheredNearest};
use rayon::prelude::*;

/// Estimates that are worth a task of their own.
const TASK: usize = 1 << 13;

/// Estimates of a tile over the nearest photons, on surfaces that scatter alike from all directions.
#[derive(Default)]
pub(crate) struct Pooled {
    pub queries: Vec<GatherQuery>,
    /// What each is worth, and the neighbourhoods.
    uses: Vec<Use>,
    keys: Vec<u64>,
}

#[derive(Clone, Copy)]
struct Use {
    /// Throughput times scattering, 1/sr.
    factor: Vec3,
    /// Pixel within the tile.
    pixel: u32,
}

impl Pooled {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.queries.clear();
        self.uses.clear();
    }

    /// One more for a pixel of the tile; `factor` is throughput times scattering, 1/sr.
    pub fn push(&mut self, query: GatherQuery, factor: Vec3, pixel: u32) {
        self.queries.push(query);
        self.uses.push(Use { factor, pixel });
    }

    /// Says where they lie, once all are there.
    pub fn locate(&mut self, map: &Map) {
        map.search.neighbourhoods(&self.queries, &mut self.keys);
    }
}

/// What was found for the estimates of several tiles. It keeps its memory from one set of tiles to the next.
#[derive(Default)]
pub(crate) struct Pool {
    order: Order,
    /// In the order of the queries' neighbourhoods.
    answers: Vec<GatheredNearest>,
    /// Of the estimates of all lists, one list after the other: where among the answers.
    places: Vec<u32>,
    /// Where the places of each list begin.
    begins: Vec<usize>,
    spare: Spare<Vec<GatherQuery>>,
}

impl Pool {
    /// Answers the estimates of lists that are located, and counts them; nothing where it is stopped. Task `i` is
    /// counted as its twin
    /// `twin(i)` says; how many there were.
    pub fn answer(
        &mut self,
        map: &Map,
        k: u32,
        lists: &[&Pooled],
        twin: impl Fn(u32) -> Twin + Sync,
        counters: &mut Counters,
        observer: &dyn Observer,
    ) -> Option<u32> {
        self.order.sort(lists);
        let order = &self.order;
        let count = order.places.len();
        self.answers.clear();
        self.answers.resize(count, GatheredNearest::default());
        let spare = &self.spare;
        let answer = |(task, (places, answers)): (usize, (&[u64], &mut [GatheredNearest]))| {
            if observer.cancelled() {
                return None;
            }
            let query = |place: &u64| {
                let (list, index) = order.element(*place);
                lists[list].queries[index]
            };
            let mut counters = Counters::default();
            spare.with(|queries| {
                queries.clear();
                queries.extend(places.iter().map(query));
                map.nearest(queries, k, &mut twin(task as u32), answers, &mut counters);
            });
            Some(counters)
        };
        let tasks = order.places.par_chunks(TASK).zip(self.answers.par_chunks_mut(TASK)).enumerate();
        let counted: Option<Vec<Counters>> = tasks.with_max_len(1).map(answer).collect();
        self.begins.clear();
        self.begins.extend(lists.iter().scan(0, |end, list| Some(std::mem::replace(end, *end + list.queries.len()))));
        self.places.resize(count, 0);
        for (number, place) in (0..).zip(&order.places) {
            let (list, index) = order.element(*place);
            self.places[self.begins[list] + index] = number;
        }
        let counted = counted?;
        let tasks = counted.len() as u32;
        counted.into_iter().for_each(|c| *counters += c);
        Some(tasks)
    }

    /// What was found for the estimates of list `number`, and their pixels.
    pub fn found<'p>(
        &'p self,
        map: &'p Map,
        k: u32,
        number: usize,
        list: &'p Pooled,
    ) -> impl Iterator<Item = (u32, Estimated)> + 'p {
        let places = &self.places[self.begins[number]..];
        list.uses.iter().zip(&list.queries).zip(places).map(move |((Use { factor, pixel }, query), &place)| {
            let found = &self.answers[place as usize];
            (*pixel, map.constant(*factor, found.flux, found.count, found.radius(query, k)))
        })
    }
}

/// Elements of lists, sorted by their neighbourhoods.
#[derive(Default)]
struct Order {
    /// The list above the index in it, which has `index_bits` bits.
    places: Vec<u64>,
    index_bits: u32,
    scratch: Vec<u64>,
}

impl Order {
    fn sort(&mut self, lists: &[&Pooled]) {
        let bits = |count: usize| usize::BITS - count.leading_zeros();
        let index_bits = bits(lists.iter().map(|list| list.keys.len()).max().unwrap_or(0));
        let pairs = || {
            (0u64..).zip(lists).flat_map(move |(list, pooled)| {
                pooled.keys.iter().zip(0..).map(move |(key, index)| (*key, list << index_bits | index))
            })
        };
        self.index_bits = index_bits;
        if !sorted_places(pairs(), index_bits + bits(lists.len()), &mut self.places, &mut self.scratch) {
            let mut pairs: Vec<(u64, u64)> = pairs().collect();
            pairs.sort_by_key(|pair| pair.0);
            self.places.clear();
            self.places.extend(pairs.into_iter().map(|pair| pair.1));
        }
    }

    /// The list and the index of an element.
    fn element(&self, place: u64) -> (usize, usize) {
        ((place >> self.index_bits) as usize, (place & ((1 << self.index_bits) - 1)) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    /// Lists of very different lengths, keys of few and of all bits, against a stable sort of them one after the other.
    #[test]
    fn elements_of_lists_are_sorted_by_their_keys() {
        let mut order = Order::default();
        for (case, mask) in [0, 1, 0xFFF, 0xFFFF_F000, u64::MAX].into_iter().enumerate() {
            for lengths in [&[][..], &[0], &[3], &[1, 0, 5000, 2], &[1 << 14, 700, 1 << 10]] {
                let lists: Vec<Pooled> = (0u64..)
                    .zip(lengths)
                    .map(|(list, length)| {
                        let key = |i| {
                            let mut s = Sampler::new(case as u64, StreamKind::Test, list << 32 | i, 0);
                            let [high, low] = s.next_2d().map(|u| u64::from(u.to_bits().wrapping_mul(0x9E37_79B9)));
                            (high << 32 | low) & mask
                        };
                        Pooled { keys: (0..*length).map(key).collect(), ..Pooled::default() }
                    })
                    .collect();
                order.sort(&lists.iter().collect::<Vec<_>>());
                let mut expected: Vec<(u64, (usize, usize))> = Vec::new();
                for (number, list) in lists.iter().enumerate() {
                    expected.extend(list.keys.iter().enumerate().map(|(index, key)| (*key, (number, index))));
                }
                expected.sort_by_key(|e| e.0);
                let found: Vec<_> = order.places.iter().map(|place| order.element(*place)).collect();
                assert_eq!(found, expected.iter().map(|e| e.1).collect::<Vec<_>>(), "{lengths:?}, mask {mask:x}");
            }
        }
    }
}
