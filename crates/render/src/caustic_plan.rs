//! How caustics get photons of their own: a look, before the first pass, at where those start that land where it is seen.

use crate::control::{Cancelled, Observer};
use crate::light::{Arrival, EmissionGuide, EmissionPoint, Lights};
use crate::photon_pass::{Keep, PhotonPass, StoredPhotons};
use crate::pilot::{self, VisiblePoint};
use crate::world::World;
use photinus_geometry::Vec3;
use photinus_photons::{BuildOptions, Photon, Search};

/// Photons of a round of learning, and rounds after the one that the pilot's own photons make.
const ROUND: u32 = 20_000;
const ROUNDS: u32 = 3;
/// Caustic photons that the pilot must have seen.
const LEAST_SEEN: usize = 16;
/// Photons that an estimate of the first pass should find in a caustic.
const TARGET: f32 = 300.0;
/// Narrowest useful radius, over the width of a pixel.
const LEAST_WIDTH: f32 = 0.7;
/// Photons for caustics over plain ones, at least and at most.
const LEAST_FACTOR: f32 = 0.1;
const MOST_FACTOR: f32 = 2.0;
/// Photons at which the density of caustics is measured.
const PROBES: usize = 1024;
/// Share of its worth that a photon keeps where nothing is seen.
const UNSEEN: f32 = 0.1;

/// Photons for caustics alone.
pub(crate) struct CausticPlan {
    pub guide: EmissionGuide,
    /// Photons of a pass.
    pub count: u32,
    /// First radius of the caustic map.
    pub radius: f32,
    /// Photons stored for each one sent out.
    pub stored: f32,
}

/// What is seen, to be asked about places.
pub(crate) struct Visibility<'p> {
    points: &'p [VisiblePoint],
    /// How far around each point places count as seen.
    reach: Vec<f32>,
    search: Box<dyn Search>,
}

impl<'p> Visibility<'p> {
    /// None where nothing is visible.
    pub fn new(points: &'p [VisiblePoint]) -> Option<Self> {
        let photons: Result<Vec<Photon>, _> =
            points.iter().map(|p| Photon::new(p.position, Vec3::ONE, p.normal, p.normal, 1, false)).collect();
        let search =
            photinus_photons::build(photinus_photons::DEFAULT_SEARCH, photons.ok()?, &BuildOptions::default()).ok()?;
        let mut found = Vec::new();
        // Points lie on a grid over the picture: the third neighbour is about a step of it away, whatever the slant.
        let reach = points
            .iter()
            .map(|p| {
                search.nearest(p.position, 4, f32::INFINITY, &mut found);
                1.5 * found.last().map_or(0.0, |n| n.distance_sq.sqrt())
            })
            .collect();
        (!points.is_empty()).then_some(Self { points, reach, search })
    }

    /// Width of a pixel at `position`; none where it is not seen.
    pub fn width(&self, position: Vec3) -> Option<f32> {
        let mut found = Vec::new();
        self.search.nearest(position, 1, f32::INFINITY, &mut found);
        let nearest = found.first()?;
        let point = nearest.photon as usize;
        (nearest.distance_sq.sqrt() <= self.reach[point]).then(|| self.points[point].width)
    }
}

/// Starts of caustic photons, and how much each was worth.
#[derive(Default)]
struct Starts {
    points: Vec<(EmissionPoint, f64)>,
    /// Photons sent out in each round, and the guide that aimed them.
    rounds: Vec<(u32, Option<EmissionGuide>)>,
}

impl Starts {
    /// Takes note of the photons of a round; returns where they landed in sight.
    fn add(&mut self, pass: &PhotonPass, stored: &StoredPhotons, visibility: &Visibility) -> Vec<(Vec3, f32)> {
        let mut seen = Vec::new();
        for (photon, &index) in stored.caustic.iter().zip(&stored.caustic_origins) {
            let (start, density, _) = pass.start(index);
            let width = visibility.width(photon.position());
            let worth = photon.flux().element_sum() * density * pass.count as f32;
            self.points.push((start, f64::from(worth * if width.is_some() { 1.0 } else { UNSEEN })));
            seen.extend(width.map(|width| (photon.position(), width)));
        }
        self.rounds.push((pass.count, pass.guide.cloned()));
        seen
    }

    /// The guide that all rounds together suggest: each start counts over the density that all of them had there, the
    /// balance heuristic of Veach 1997, section 9.2.2.
    fn learn(&self) -> Option<EmissionGuide> {
        let arrivals = self.points.iter().map(|&(start, worth)| {
            let density: f64 = self
                .rounds
                .iter()
                .map(|(count, guide)| f64::from(*count) * guide.as_ref().map_or(1.0, |g| f64::from(g.density(&start))))
                .sum();
            Arrival { start, weight: worth * worth / density }
        });
        EmissionGuide::learn(arrivals.collect())
    }
}

/// Plans photons for caustics from what the pilot's own `pass` stored; none where hardly any caustic was seen. `global`
/// holds the pilot's photons after a diffuse bounce.
pub(crate) fn plan(
    world: &World,
    lights: &Lights,
    points: &[VisiblePoint],
    pass: PhotonPass,
    stored: &StoredPhotons,
    global: Option<&dyn Search>,
    photons: u32,
    observer: &dyn Observer,
) -> Result<Option<CausticPlan>, Cancelled> {
    let Some(visibility) = Visibility::new(points) else { return Ok(None) };
    let mut starts = Starts::default();
    if starts.add(&pass, stored, &visibility).len() < LEAST_SEEN {
        return Ok(None);
    }
    for round in 1..=ROUNDS {
        let Some(guide) = starts.learn() else { return Ok(None) };
        let aimed =
            PhotonPass { pass: round, count: ROUND, keep: Keep::Caustic, guide: Some(&guide), window: None, ..pass };
        let (stored, _) = aimed.run(world, lights, observer)?;
        let seen = starts.add(&aimed, &stored, &visibility);
        if round == ROUNDS {
            return Ok(measure(&aimed, stored.caustic, global, &seen, photons));
        }
    }
    Ok(None)
}

/// What a probe photon of a caustic says.
struct Probe {
    /// Photons that as many aimed photons as plain ones would bring into the narrowest useful radius around it.
    found: f32,
    /// Share of the caustic in the light of all photons there.
    contrast: f32,
    pixel: f32,
}

/// Decides how many photons and which radius caustics need, from the last round of learning: so many that half of the
/// caustic photons in sight find [`TARGET`] of their like within about a pixel, fewer where other light outshines them,
/// and where that were too many, a wider radius.
fn measure(
    pass: &PhotonPass,
    caustic: Vec<Photon>,
    global: Option<&dyn Search>,
    seen: &[(Vec3, f32)],
    photons: u32,
) -> Option<CausticPlan> {
    let stored = caustic.len() as f32 / pass.count as f32;
    let scale = photons as f32 / pass.count as f32;
    let caustic = photinus_photons::build(photinus_photons::DEFAULT_SEARCH, caustic, &BuildOptions::default()).ok()?;
    let probes: Vec<Probe> = seen
        .iter()
        .step_by((seen.len() / PROBES).max(1))
        .map(|&(at, width)| {
            let pixel = LEAST_WIDTH * width;
            let (density, light) = around(&*caustic, at);
            let other = global.map_or(0.0, |global| around(global, at).1);
            Probe { pixel, found: density * pixel * pixel * scale, contrast: light / (light + other).max(1e-30) }
        })
        .filter(|probe| probe.found > 0.0 && probe.found.is_finite())
        .collect();
    // Noise counts relative to all light, variance as its square.
    let needed = |p: &Probe| TARGET * p.contrast * p.contrast / p.found;
    // A caustic that even the most photons leave blurred gets fewer of them the farther it is out of reach: it is wide, so
    // that a wider radius does it less harm, and other light makes more noise.
    let wanted = pilot::median(probes.iter().map(needed))?;
    let factor = if wanted > MOST_FACTOR { MOST_FACTOR * MOST_FACTOR / wanted } else { wanted }.max(LEAST_FACTOR);
    let radius = pilot::median(probes.iter().map(|p| p.pixel * (needed(p) / factor).max(1.0).sqrt()))?;
    let count = ((photons as f32 * factor) as u32).max(1);
    Some(CausticPlan { guide: pass.guide?.clone(), count, radius, stored })
}

/// Photons and flux per squared radius around `at`.
fn around(search: &dyn Search, at: Vec3) -> (f32, f32) {
    let mut found = Vec::new();
    search.nearest(at, pilot::NEIGHBORS, f32::INFINITY, &mut found);
    let flux: f32 = found.iter().map(|n| search.photon(n.photon).flux().element_sum()).sum();
    let distance_sq = found.last().map_or(0.0, |n| n.distance_sq).max(1e-30);
    (found.len() as f32 / distance_sq, flux / distance_sq)
}
