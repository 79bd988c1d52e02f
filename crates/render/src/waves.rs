//! The order of a direct render: tiles are followed in waves, and the estimates of a wave are made together, while
//! the next one is followed.

use crate::control::{Cancelled, Observer};
use crate::counters::Counters;
use crate::direct::{Buffers, Followed};
use crate::eye_pass::EyePass;
use crate::maps::Maps;
use crate::pool::Pool;
use crate::pooled::{Pooled, Use};
use crate::tile::{Spare, Tile, Tiles, Together};
use crate::trace::Tracer;
use crate::twin::{Queries, Twin};
use photinus_profile::queries::MapKind;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Edge of a tile in pixels: where a wave ends threads wait for the last one.
const TILE: u32 = 32;
/// Least tiles of a wave, so that many threads have some; each has as many more at most as all before it.
const LEAST_WAVE: u32 = 64;
/// Estimates of a wave, about, where tiles do not ask for many more: many enough that most lie close to others, few
/// enough for the memory that they take.
pub(crate) const WAVE_ESTIMATES: u64 = 1 << 19;
/// Estimates of a pixel, roughly, where mirrors are about.
pub(crate) const ESTIMATES_A_PIXEL: u64 = 4;

/// Cuts the tiles into waves, as long as those before say: they do not depend on the machine.
struct Waves {
    tiles: u32,
    next: u32,
    /// Tiles of the wave before.
    latest: u32,
    /// Most estimates of a tile of any wave before, in the mean of the wave.
    most: u64,
}

impl Waves {
    fn new(tiles: u32) -> Self {
        Self { tiles, next: 0, latest: 0, most: 0 }
    }

    fn next(&mut self) -> Option<Range<u32>> {
        let left = self.tiles - self.next;
        if left == 0 {
            return None;
        }
        let fit = ((WAVE_ESTIMATES / self.most.max(u64::from(TILE * TILE))) as u32).min(self.next).max(LEAST_WAVE);
        // Those left in waves of one length.
        let count = left.div_ceil(left.div_ceil(fit));
        let wave = self.next..self.next + count;
        (self.latest, self.next) = (count, wave.end);
        Some(wave)
    }

    /// Says how many estimates the latest wave asked for in a sample.
    fn asked_for(&mut self, estimates: u64) {
        self.most = self.most.max(estimates / u64::from(self.latest));
    }
}

/// A tile under way.
pub(crate) struct Started<'a> {
    pub tile: Tile<'a>,
    pub tracer: Tracer<'a>,
    /// Of the estimates that are not pooled.
    pub twin: Twin,
    pub counters: Counters,
    /// The estimates of the present sample that are made together with those of other tiles.
    pub pooled: Pooled,
    /// The pixels before the present sample.
    before: Vec<f32>,
}

/// Tiles whose estimates are made together.
struct Wave<'a> {
    tiles: Vec<Started<'a>>,
    /// Samples that are whole.
    samples: u32,
    next: Next,
}

/// How far the next sample of a wave is.
#[derive(Default)]
enum Next {
    #[default]
    NotBegun,
    /// Stopped in some tile.
    Cut,
    /// All of it is there but its estimates.
    Followed,
}

/// What all waves share.
struct Shared<'a> {
    maps: &'a Maps,
    k: u32,
    observer: &'a dyn Observer,
    spare: Spare<Buffers>,
    /// Samples of tiles that were followed, and those that are to be.
    followed: AtomicU64,
    samples: u64,
}

/// What makes estimates, and what it took.
#[derive(Default)]
struct Maker {
    pool: Pool,
    tasks: u32,
    counters: Counters,
}

impl EyePass<'_> {
    /// As [`EyePass::run`], by the thesis's recursion; the `k` nearest photons of estimates that lie close together
    /// are looked for together. Where it is stopped, whole waves are there.
    pub fn run_waves(
        &self,
        maps: &Maps,
        k: u32,
        film: &mut [f32],
        observer: &dyn Observer,
    ) -> Result<Counters, Cancelled> {
        let tiles = self.tiles(TILE);
        let samples = u64::from(tiles.count()) * u64::from(self.spp);
        let shared = Shared { maps, k, observer, spare: Spare::default(), followed: AtomicU64::new(0), samples };
        let mut waves = Waves::new(tiles.count());
        let (mut together, mut maker) = (Together::default(), Maker::default());
        // Lists that waves hand on to one another.
        let mut lists = Vec::new();
        // The wave that has been followed, but for its last estimates.
        let mut behind: Option<Wave> = None;
        while let Some(range) = waves.next()
            && !observer.cancelled()
        {
            let mut wave = self.start(range, &tiles, &mut lists);
            let estimates = || {
                if let Some(mut wave) = behind.take() {
                    self.make(&mut wave, &shared, &mut maker);
                    wave.finish(&tiles, film, &mut together, &mut lists);
                }
            };
            rayon::join(estimates, || self.follow_wave(&mut wave, &shared));
            waves.asked_for(wave.tiles.iter().map(|tile| tile.pooled.spots.len() as u64).sum());
            while wave.samples + 1 < self.spp && self.make(&mut wave, &shared, &mut maker) {
                self.follow_wave(&mut wave, &shared);
            }
            behind = Some(wave);
        }
        if let Some(mut wave) = behind {
            self.make(&mut wave, &shared, &mut maker);
            wave.finish(&tiles, film, &mut together, &mut lists);
        }
        let counters = tiles.finish(together, film)?;
        maker.counters += counters;
        Ok(maker.counters)
    }

    fn start<'t>(&'t self, range: Range<u32>, tiles: &Tiles<'t>, lists: &mut Vec<Pooled>) -> Wave<'t> {
        let start = |index| Started {
            tile: tiles.tile(index),
            tracer: self.tracer(index),
            twin: self.twin(Queries::Estimates, index),
            counters: Counters::default(),
            pooled: lists.pop().unwrap_or_default(),
            before: Vec::new(),
        };
        Wave { tiles: range.map(start).collect(), samples: 0, next: Next::NotBegun }
    }

    /// Follows the next sample of all tiles of a wave.
    fn follow_wave(&self, wave: &mut Wave, Shared { maps, observer, spare, followed, samples, .. }: &Shared) {
        let sample = wave.samples;
        // One by one: of a run of tiles that a thread has begun no other can take any when it has none left.
        wave.tiles.par_iter_mut().with_max_len(1).for_each(|started| {
            if sample > 0 {
                started.before.clone_from(&started.tile.out);
            }
            if observer.cancelled() {
                return;
            }
            let Started { tile, tracer, twin, counters, pooled, .. } = started;
            let started = Followed { tile, tracer, twin, counters, pooled: Some(pooled) };
            spare.with(|buffers| self.direct_sample(maps, buffers, sample, started));
            observer.progress(followed.fetch_add(1, Ordering::Relaxed) + 1, *samples);
        });
        wave.next = if observer.cancelled() { Next::Cut } else { Next::Followed };
    }

    /// Makes the estimates of a wave's next sample; false where that has not been followed or is stopped: it is then
    /// forgotten.
    fn make(&self, wave: &mut Wave, shared: &Shared, maker: &mut Maker) -> bool {
        let whole = match std::mem::take(&mut wave.next) {
            Next::NotBegun => return false,
            Next::Cut => false,
            Next::Followed => self.make_pooled(wave, shared, maker),
        };
        if whole {
            wave.samples += 1;
        } else {
            wave.tiles.iter_mut().for_each(|s| std::mem::swap(&mut s.tile.out, &mut s.before));
        }
        whole
    }

    fn make_pooled(&self, wave: &mut Wave, Shared { maps, k, observer, .. }: &Shared, maker: &mut Maker) -> bool {
        let Maker { pool, tasks, counters } = maker;
        let lists: Vec<&Pooled> = wave.tiles.iter().map(|started| &started.pooled).collect();
        let twin = |task: u32| self.twin(Queries::Pooled, *tasks + task);
        let Some(done) = pool.answer(&maps.global, *k, &lists, twin, counters, *observer) else { return false };
        *tasks += done;
        wave.tiles.par_iter_mut().enumerate().for_each(|(number, Started { tile, pooled, .. })| {
            pool.found(number, pooled, |Use { factor, pixel }, found| {
                tile.estimated(MapKind::Global, *pixel, *factor * found.irradiance, found.density);
            });
        });
        true
    }
}

impl Wave<'_> {
    /// Ends its tiles, the next of the film, and hands on their lists.
    fn finish(self, tiles: &Tiles, film: &mut [f32], together: &mut Together, lists: &mut Vec<Pooled>) {
        for Started { tile, counters, pooled, .. } in self.tiles {
            lists.push(pooled);
            tiles.put(tile.made(counters, self.samples), film, together);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_cover_all_tiles_and_stay_small() {
        for tiles in [1, 15, 16, 17, 117, 5000] {
            for asked_a_tile in [0, 4096, 20_000, 1 << 18, 1 << 20] {
                let mut waves = Waves::new(tiles);
                let mut end = 0;
                while let Some(wave) = waves.next() {
                    let count = wave.len() as u32;
                    assert_eq!(wave.start, end, "{tiles} tiles of {asked_a_tile}");
                    assert!(count <= end.max(LEAST_WAVE));
                    assert!(count <= LEAST_WAVE || u64::from(count) * asked_a_tile <= WAVE_ESTIMATES);
                    end = wave.end;
                    waves.asked_for(u64::from(count) * asked_a_tile);
                }
                assert_eq!(end, tiles);
            }
        }
    }
}
