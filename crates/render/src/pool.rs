//! Estimates of many tiles, made together: those that lie close to one another look the photons around them up once,
//! whichever tiles ask for them.

use crate::control::Observer;
use crate::counters::Counters;
use crate::maps::{Found, Map};
use crate::pooled::{Pooled, Run, Spot, Use};
use crate::sort::Sorter;
use crate::tile::Spare;
use crate::twin::Twin;
use photinus_photons::{GatherQuery, GatheredNearest};
use rayon::prelude::*;

/// Estimates that are worth a task of their own.
const TASK: usize = 1 << 13;

/// What was found for the estimates of several tiles. It keeps its memory from one set of tiles to the next.
#[derive(Default)]
pub(crate) struct Pool {
    order: Order,
    /// One list after the other, in the order of their spots.
    found: Vec<Found>,
    /// Where the answers of each list begin.
    begins: Vec<usize>,
    spare: Spare<Scratch>,
    /// Of a list in the order in which its estimates were asked for: what is in a thread's caches may be written here and
    /// there.
    in_turn: Spare<Vec<Found>>,
}

/// What a task works on.
#[derive(Default)]
struct Scratch {
    queries: Vec<GatherQuery>,
    nearest: Vec<GatheredNearest>,
}

/// Estimates that are made at a time.
struct Task<'t> {
    pieces: &'t [Piece],
    /// Of each list those that the pieces are about.
    spots: Vec<&'t [Spot]>,
    found: Vec<&'t mut [Found]>,
}

impl Pool {
    /// Makes the estimates of lists, and counts them; nothing where it is stopped. Task `i` is counted as its twin
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
        self.order.sort(lists.iter().map(|list| &list.runs[..]));
        self.begins.clear();
        self.begins.extend(lists.iter().scan(0, |end, list| Some(std::mem::replace(end, *end + list.spots.len()))));
        self.found.resize(lists.iter().map(|list| list.spots.len()).sum(), Found::default());
        let spare = &self.spare;
        let answer = |(number, task): (usize, Task)| {
            if observer.cancelled() {
                return None;
            }
            let mut counters = Counters::default();
            spare.with(|scratch| task.answer(map, k, scratch, &mut twin(number as u32), &mut counters));
            Some(counters)
        };
        let tasks = tasks(&self.order.sorted, lists, &mut self.found);
        let counted: Option<Vec<Counters>> = tasks.into_par_iter().enumerate().with_max_len(1).map(answer).collect();
        let counted = counted?;
        let tasks = counted.len() as u32;
        counted.into_iter().for_each(|c| *counters += c);
        Some(tasks)
    }

    /// Calls `visit(use, found)` for each estimate of list `number` in the order in which they were asked for.
    pub fn found(&self, number: usize, list: &Pooled, mut visit: impl FnMut(&Use, &Found)) {
        let found = &self.found[self.begins[number]..][..list.spots.len()];
        self.in_turn.with(|in_turn| {
            in_turn.resize(found.len(), Found::default());
            list.turns.iter().zip(found).for_each(|(turn, found)| in_turn[*turn as usize] = *found);
            list.uses.iter().zip(&*in_turn).for_each(|(u, found)| visit(u, found));
        });
    }
}

/// Cuts the work into tasks.
fn tasks<'t>(mut pieces: &'t [Piece], lists: &[&'t Pooled], mut found: &'t mut [Found]) -> Vec<Task<'t>> {
    let mut left = Vec::new();
    for list in lists {
        left.push((&list.spots[..], found.split_off_mut(..list.spots.len()).unwrap_or_default()));
    }
    let mut tasks = Vec::new();
    while !pieces.is_empty() {
        let (mut number, mut count, mut counts) = (0, 0, vec![0; lists.len()]);
        while count < TASK
            && let Some(piece) = pieces.get(number)
        {
            counts[piece.list as usize] += piece.count as usize;
            count += piece.count as usize;
            number += 1;
        }
        let mut task =
            Task { pieces: pieces.split_off(..number).unwrap_or_default(), spots: Vec::new(), found: Vec::new() };
        for ((spots, found), count) in left.iter_mut().zip(counts) {
            task.spots.push(spots.split_off(..count).unwrap_or_default());
            task.found.push(found.split_off_mut(..count).unwrap_or_default());
        }
        tasks.push(task);
    }
    tasks
}

impl Task<'_> {
    fn answer(
        mut self,
        map: &Map,
        k: u32,
        Scratch { queries, nearest }: &mut Scratch,
        twin: &mut Twin,
        counters: &mut Counters,
    ) {
        queries.clear();
        for piece in self.pieces {
            let spots = self.spots[piece.list as usize].split_off(..piece.count as usize).unwrap_or_default();
            queries.extend(spots.iter().map(|&Spot { position, normal }| map.query(position, normal)));
        }
        nearest.clear();
        nearest.resize(queries.len(), GatheredNearest::default());
        map.nearest(queries, k, twin, nearest, counters);
        let mut answers = queries.iter().zip(&*nearest);
        for piece in self.pieces {
            let found = self.found[piece.list as usize].split_off_mut(..piece.count as usize).unwrap_or_default();
            for (found, (query, nearest)) in found.iter_mut().zip(&mut answers) {
                *found = map.found(query, nearest.flux, nearest.count, nearest.radius(query, k));
            }
        }
    }
}

/// Runs of lists, sorted by their neighbourhoods.
#[derive(Default)]
struct Order {
    sorted: Vec<Piece>,
    keys: Vec<u64>,
    unsorted: Vec<Piece>,
    sorter: Sorter,
}

/// A run: the next so many estimates of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    list: u32,
    count: u32,
}

impl Order {
    fn sort<'l>(&mut self, lists: impl Iterator<Item = &'l [Run]>) {
        let Self { sorted, keys, unsorted, sorter } = self;
        keys.clear();
        unsorted.clear();
        for (list, runs) in (0..).zip(lists) {
            keys.extend(runs.iter().map(|run| run.key));
            unsorted.extend(runs.iter().map(|run| Piece { list, count: run.count }));
        }
        sorter.sort(keys);
        sorted.clear();
        sorted.extend(sorter.places().map(|place| unsorted[place]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;
    use photinus_num::{Sampler, StreamKind};

    /// Lists of very different lengths, against a stable sort of them one after the other.
    #[test]
    fn runs_of_lists_are_sorted_by_their_keys() {
        let mut order = Order::default();
        for (case, mask) in [0, 1, 0xFFF, 0xFFFF_F000, u64::MAX].into_iter().enumerate() {
            for lengths in [&[][..], &[0], &[3], &[1, 0, 5000, 2], &[1 << 14, 700, 1 << 10]] {
                let list = |(list, length): (u64, &u64)| -> Vec<Run> {
                    let run = |i| {
                        let mut s = Sampler::new(case as u64, StreamKind::Test, list << 32 | i, 0);
                        let [high, low] = s.next_2d().map(|u| u64::from(u.to_bits().wrapping_mul(0x9E37_79B9)));
                        Run { key: (high << 32 | low) & mask, count: i as u32 + 1 }
                    };
                    (0..*length).map(run).collect()
                };
                let lists: Vec<Vec<Run>> = (0..).zip(lengths).map(list).collect();
                order.sort(lists.iter().map(|runs| &runs[..]));
                let all = (0..).zip(&lists).flat_map(|(list, runs)| runs.iter().map(move |run| (list, *run)));
                let mut expected: Vec<(u32, Run)> = all.collect();
                expected.sort_by_key(|(_, run)| run.key);
                let expected: Vec<Piece> =
                    expected.into_iter().map(|(list, run)| Piece { list, count: run.count }).collect();
                assert_eq!(order.sorted, expected, "{lengths:?}, mask {mask:x}");
            }
        }
    }

    /// Tasks take what is next of each list, and all of it.
    #[test]
    fn tasks_cover_all_lists() {
        let run = |key| Run { key, count: 1000 };
        let lists: Vec<Pooled> = [30, 0, 1, 17]
            .map(|runs| Pooled {
                spots: vec![Spot { position: Vec3::ZERO, normal: Vec3::ZERO }; runs * 1000],
                runs: (0..runs as u64).map(|i| run(i * 7 % 5 + i / 5 * 5)).collect(),
                ..Pooled::default()
            })
            .into();
        let mut order = Order::default();
        order.sort(lists.iter().map(|list| &list.runs[..]));
        let lists: Vec<&Pooled> = lists.iter().collect();
        let mut found = vec![Found::default(); 48_000];
        let tasks = tasks(&order.sorted, &lists, &mut found);
        assert_eq!(tasks.len(), 6);
        let mut taken = [0; 4];
        for task in &tasks {
            for list in 0..4 {
                let count: u32 = task.pieces.iter().filter(|p| p.list == list).map(|p| p.count).sum();
                let list = list as usize;
                assert_eq!((task.spots[list].len(), task.found[list].len()), (count as usize, count as usize));
                let expected = lists[list].spots[taken[list]..].as_ptr();
                assert!(count == 0 || std::ptr::eq(task.spots[list].as_ptr(), expected));
                taken[list] += count as usize;
            }
        }
        assert_eq!(taken, [30_000, 0, 1000, 17_000]);
    }
}
