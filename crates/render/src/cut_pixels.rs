//! What passes know of the discs of their estimates: where something cuts them, how much of them there is, and how many photons
//! were found.
//!
//! Looking costs rays, so the first pass looks at one pixel in four, and at its neighbours where a disc is cut; later passes look
//! around pixels where a disc was cut: radii do not grow. What the camera sees directly, it sees again in the next pass: points
//! that were looked at then still count, less the more the radius has shrunk since, and few new ones go on with their sequence.
//!
//! Where a disc is cut, light changes within it, too: a window's reveal is bright on one side of the frame. Where passes before
//! found many photons there, later ones ask for fewer over less ([`CutPixels::scale`]).

use crate::maps::Estimate;
use crate::support::Look;
use photinus_geometry::Vec3;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Edge of the squares of pixels of which the first pass looks at one first; a tile's edge is a multiple.
pub(crate) const COARSE: u32 = 2;
/// How fast points count less as the radius shrinks: power of the ratio of radii.
const FADING: i32 = 6;
/// Points on the same surface of a pixel are no farther apart than this, in radii ...
const SAME_SURFACE: f32 = 0.5;
/// ... and no farther off its plane.
const SAME_PLANE: f32 = 0.05;
/// Weight of a pass's count of photons against those before it.
const NEWEST: f32 = 0.5;

/// What passes before saw of the disc around what the camera sees directly in a pixel.
#[derive(Clone, Copy, Default)]
pub(crate) struct Seen {
    position: Vec3,
    radius: f32,
    /// Photons per area.
    density: f32,
    /// Points looked at, as much as they count by now; 0 where none were.
    pub points: f32,
    /// What of them is lost.
    pub lost: f32,
    /// Points of the pixel's sequence that have been used.
    pub used: u32,
    /// A point was missing at some time.
    pub is_cut: bool,
}

impl Seen {
    /// What of it holds for an estimate; nothing but the place in the sequence where that lies on another surface.
    pub fn turned_to(self, e: &Estimate, Look { radius, density, .. }: Look) -> Self {
        let now = Self { position: e.query.position, radius, density, used: self.used, ..Self::default() };
        if !self.is_of(e, radius) {
            return now;
        }
        let fade = (radius / self.radius).min(1.0).powi(FADING);
        Self {
            density: self.density + NEWEST * (density - self.density),
            points: self.points * fade,
            lost: self.lost * fade,
            is_cut: self.is_cut,
            ..now
        }
    }

    /// Whether an estimate over `radius` lies on the same surface.
    fn is_of(&self, e: &Estimate, radius: f32) -> bool {
        let away = e.query.position - self.position;
        self.points > 0.0
            && away.length() <= SAME_SURFACE * radius
            && away.dot(e.query.normal).abs() <= SAME_PLANE * radius + e.offset
    }
}

/// Photons that are enough for an estimate whose disc is cut: this many over the root of the number of passes, at least so many.
/// Noise falls as one over the passes and over the photons of each, what light from next door adds falls as the disc does: the
/// sum of both is least so.
const ENOUGH: f32 = 40.0;
const LEAST_ENOUGH: f32 = 4.0;
/// Least part of the map's radius that is asked for.
const LEAST_SCALE: f32 = 0.25;

/// Pixels whose estimates are near something that cuts their discs.
pub(crate) struct CutPixels {
    width: usize,
    /// Passes that have looked.
    passes: u32,
    /// By the passes before, row by row.
    before: Vec<bool>,
    now: Vec<AtomicBool>,
    /// Pixels that a caustic's rim crosses, by the passes before and by this one.
    rims_before: Vec<bool>,
    rims_now: Vec<AtomicBool>,
    seen: Vec<Seen>,
    /// What this pass adds, by pixel, tile by tile; those of a pixel stand in its order.
    new: Mutex<Vec<Vec<(u32, Seen)>>>,
}

impl CutPixels {
    /// Nothing is known of a window of this size.
    pub fn new(width: u32, height: u32) -> Self {
        let count = width as usize * height as usize;
        let none = || (0..count).map(|_| AtomicBool::new(false)).collect();
        Self {
            width: width as usize,
            passes: 0,
            before: vec![false; count],
            now: none(),
            rims_before: vec![false; count],
            rims_now: none(),
            seen: vec![Seen::default(); count],
            new: Mutex::default(),
        }
    }

    /// Bytes between passes, and what a pass adds where it looks at a quarter of the pixels.
    pub fn bytes(&self) -> [usize; 2] {
        let pixel = size_of::<Seen>() + size_of::<[bool; 4]>();
        [self.seen.len() * pixel, self.seen.len() * size_of::<(u32, Seen)>() / 4]
    }

    /// Ends a pass: what it saw steers the next.
    pub fn advance(&mut self) {
        for (pixel, seen) in self.take_new().into_iter().flatten() {
            self.seen[pixel as usize] = seen;
        }
        let marks = self.before.iter_mut().zip(&mut self.now);
        for (before, now) in marks.chain(self.rims_before.iter_mut().zip(&mut self.rims_now)) {
            *before |= std::mem::take(now.get_mut());
        }
        self.passes += 1;
    }

    /// Forgets what an unfinished pass saw: the next one begins as that did.
    pub fn forget(&mut self) {
        self.take_new();
        self.now.iter_mut().chain(&mut self.rims_now).for_each(|now| *now.get_mut() = false);
    }

    fn take_new(&mut self) -> Vec<Vec<(u32, Seen)>> {
        std::mem::take(self.new.get_mut().unwrap_or_else(PoisonError::into_inner))
    }

    /// A caustic's rim crosses a pixel.
    pub fn saw_rim(&self, place: [u32; 2]) {
        self.rims_now[self.index(place)].store(true, Ordering::Relaxed);
    }

    /// Whether a pass before saw one.
    pub fn has_rim(&self, place: [u32; 2]) -> bool {
        self.rims_before[self.index(place)]
    }

    /// What a tile saw, for the next pass.
    pub fn add_new(&self, new: Vec<(u32, Seen)>) {
        self.new.lock().unwrap_or_else(PoisonError::into_inner).push(new);
    }

    /// Part of a map's `radius`, `LEAST_SCALE` to 1, that an estimate should be made over: less where its disc is cut and
    /// passes before found more photons than are needed.
    pub fn scale(&self, place: [u32; 2], e: &Estimate, radius: f32) -> f32 {
        let seen = &self.seen[self.index(place)];
        if !(seen.is_cut && seen.is_of(e, radius)) {
            return 1.0;
        }
        let found = std::f32::consts::PI * radius * radius * seen.density;
        let enough = (ENOUGH / (self.passes as f32 + 1.0).sqrt()).max(LEAST_ENOUGH);
        (enough / found.max(enough)).sqrt().max(LEAST_SCALE)
    }

    /// Whether a pass has looked.
    pub fn is_known(&self) -> bool {
        self.passes > 0
    }

    /// Whether a pass before saw a disc cut here or next to here, as samples of a pixel fall anywhere in it.
    pub fn were_cut(&self, place: [u32; 2]) -> bool {
        self.around(place).any(|i| self.before[i])
    }

    /// The same of this pass. Only what the caller's own tile has seen is sure to be there: a tile ends where a square of
    /// [`COARSE`] pixels ends, and nothing is asked beyond it.
    pub fn are_cut(&self, [x, y]: [u32; 2]) -> bool {
        let seen = [x, y].map(|c| c - c % COARSE);
        self.now[self.index(seen)].load(Ordering::Relaxed)
    }

    /// A point was missing.
    pub fn saw_cut(&self, place: [u32; 2]) {
        self.now[self.index(place)].store(true, Ordering::Relaxed);
    }

    /// What passes before saw of the disc around what the camera sees directly there.
    pub fn seen(&self, place: [u32; 2]) -> Seen {
        self.seen[self.index(place)]
    }

    /// Number of a pixel.
    pub fn index(&self, [x, y]: [u32; 2]) -> usize {
        y as usize * self.width + x as usize
    }

    /// A pixel and its neighbours.
    fn around(&self, [x, y]: [u32; 2]) -> impl Iterator<Item = usize> {
        let [x, y] = [x as usize, y as usize];
        let (width, height) = (self.width, self.before.len() / self.width);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        (y.saturating_sub(1)..=(y + 1).min(height - 1)).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }
}
