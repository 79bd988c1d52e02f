//! All lights of a scene behind one choice.

use super::alias::AliasTable;
use super::anchors::Anchor;
use super::clusters::{Clusters, Member};
use super::emission::{EmissionPoint, LightChoice};
use super::emitter::{self, Emitter, mean};
use super::environment::Environment;
use super::far::{Disc, Discs};
use super::guide::{LightGuide, Place};
use super::sky_pool::SkyPool;
use super::sky_view::SkyView;
use crate::shadow_photons::NO_SOURCE;
use crate::{SurfacePoint, world::World};
use photinus_geometry::{Ray, Vec3};
use photinus_scene::Light;
use std::f32::consts::PI;

/// The part of the scene that matters to the picture: photons from infinity are aimed at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleRegion {
    /// Middle.
    pub center: Vec3,
    /// Radius, positive.
    pub radius: f32,
}

/// Light that may reach a point, before anything in between is asked for.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction from the point to the light.
    pub dir: Vec3,
    /// Where the shadow ray ends; none: at infinity.
    pub target: Option<Vec3>,
    /// Radiance from there, or intensity over squared distance for lights without area (then `delta`).
    pub radiance: Vec3,
    /// Density over solid angle, the choice of the light included; of the choice alone where `delta`.
    pub pdf: f32,
    /// The light cannot be hit by chance.
    pub delta: bool,
    /// Number of the item that was chosen.
    pub(crate) item: u32,
    /// Number of the shape that shines, or of the light without area; [`NO_SOURCE`] of light from infinity.
    pub(crate) source: u32,
}

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug)]
pub struct PhotonStart {
    /// Its way, of unit direction.
    pub ray: Ray,
    /// Flux in W if it were the only photon: divide by the number emitted.
    pub flux: Vec3,
}

/// Widest part of an emitter, over the radius of the visible region, where that does not make too many.
const PART: f32 = 0.1;

/// Light from one direction.
#[derive(Clone, Copy, Debug)]
struct Distant {
    direction: Vec3,
    irradiance: Vec3,
}

/// What one number chooses: a group of emitters, a distant light, or a bin of the sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
    Group(usize),
    Distant(usize),
    Sky(usize),
}

/// The lights of a scene.
pub struct Lights {
    emitters: Vec<Emitter>,
    /// Which shape or light without area each emitter is.
    sources: Vec<u32>,
    /// Parts of all emitters, in order: which emitter, which part.
    parts: Vec<(u32, u32)>,
    /// First part of each emitter.
    first_part: Vec<u32>,
    /// Groups of parts.
    clusters: Clusters,
    distant: Vec<Distant>,
    sky: Option<Environment>,
    /// Over the items, groups first, then distant lights, then bins of the sky: by power.
    table: AliasTable,
    /// The choice of where a photon starts: emitters first, then distant lights, then bins of the sky: by power.
    emission: LightChoice,
    /// The choice by place, where one was learned.
    guide: Option<LightGuide>,
    /// The pass's stock of directions to a sky that is a picture.
    pool: Option<SkyPool>,
    /// For each shape, the emitter of its first primitive; `u32::MAX`: it emits nothing.
    first_emitter: Vec<u32>,
    /// Where photons from infinity start.
    discs: Discs,
}

impl Lights {
    /// The lights of `world`, chosen in proportion to their power; light from infinity counts what falls on `region`, by
    /// the share of it that `view` finds open.
    pub(crate) fn new(world: &World, region: VisibleRegion, view: &SkyView) -> Self {
        let (mut emitters, mut sources, mut shining) = (Vec::new(), Vec::new(), 0);
        let mut first_emitter = vec![u32::MAX; world.shapes.len()];
        for (i, shape) in world.shapes.iter().enumerate() {
            if shape.emission.is_some() {
                first_emitter[i] = emitters.len() as u32;
                let prims = shape.first_prim..shape.first_prim + shape.prim_count;
                emitters.extend(prims.map(|prim| Emitter::of_primitive(world, prim)));
                sources.resize(emitters.len(), shining);
                shining += 1;
            }
        }
        emitter::cut(&mut emitters, PART * region.radius);
        let (mut distant, mut sky) = (Vec::new(), None);
        for light in &world.lights {
            match light {
                Light::Point { position, intensity } => {
                    emitters.push(Emitter::Point { position: *position, intensity: *intensity });
                }
                Light::Spot { position, direction, intensity, cutoff_angle, beam_width } => {
                    emitters.push(Emitter::spot(*position, *direction, *intensity, *cutoff_angle, *beam_width));
                }
                Light::Directional { direction, irradiance } => {
                    distant.push(Distant { direction: *direction, irradiance: *irradiance });
                }
                Light::Environment(light) => sky = Some(Environment::new(light)),
            }
        }
        sources.extend((shining..).take(emitters.len() - sources.len()));
        let (mut parts, mut first_part) = (Vec::new(), Vec::new());
        for (i, emitter) in emitters.iter().enumerate() {
            first_part.push(parts.len() as u32);
            parts.extend((0..emitter.parts()).map(|part| (i as u32, part)));
        }
        let members: Vec<Member> = parts
            .iter()
            .map(|&(i, part)| {
                let emitter = &emitters[i as usize];
                let (position, facing) = emitter.place(world, part);
                let power = emitter.power(world, part);
                let brightness = libm::logf((power as f32 / emitter.area(world)).clamp(1e-30, 1e30));
                Member { position, facing, power, brightness }
            })
            .collect();
        let clusters = Clusters::new(&members, 0.5 * region.radius);
        let disc = f64::from(PI) * f64::from(region.radius) * f64::from(region.radius);
        let mut powers: Vec<f64> = (0..clusters.len())
            .map(|group| clusters.members(group).iter().map(|&i| members[i as usize].power).sum())
            .collect();
        let mut starts: Vec<f64> = vec![0.0; emitters.len()];
        parts.iter().zip(&members).for_each(|(&(i, _), member)| starts[i as usize] += member.power);
        let near = powers.len();
        powers.extend(distant.iter().map(|d| disc * mean(d.irradiance)));
        starts.extend(&powers[near..]);
        if let Some(sky) = &sky {
            let bins = sky.bin_powers();
            let shares = |weights: Vec<f64>| {
                let sum: f64 = weights.iter().sum();
                weights.into_iter().map(move |w| if sum > 0.0 { w / sum } else { 0.0 })
            };
            let seen: Vec<f64> =
                shares(bins.iter().enumerate().map(|(b, p)| p * f64::from(view.factor(b))).collect()).collect();
            let power = 4.0 * f64::from(PI) * disc * mean(sky.mean()) * view.openness();
            powers.extend(seen.iter().map(|share| share * power));
            // What is not seen lights what stands before windows: half of the photons start as the sky shines.
            starts.extend(seen.iter().zip(shares(bins)).map(|(seen, plain)| 0.5 * (seen + plain) * power));
        }
        for powers in [&mut powers, &mut starts] {
            powers.iter_mut().filter(|p| !p.is_finite()).for_each(|p| *p = 0.0);
        }
        let emission = LightChoice::new(if starts.iter().any(|&p| p > 0.0) { &starts } else { &[] });
        let dark = powers.iter().all(|&p| p == 0.0);
        let table = if dark { AliasTable::default() } else { AliasTable::new(&powers) };
        Self {
            emitters,
            sources,
            parts,
            first_part,
            clusters,
            distant,
            sky,
            table,
            emission,
            guide: None,
            pool: None,
            first_emitter,
            discs: Discs::new(world, region),
        }
    }

    /// Starts most photons from infinity on small discs around `anchors` from now on. `open` has, for each anchor and each
    /// light at infinity, the share of its light that arrives there.
    pub(crate) fn anchored(mut self, anchors: &[Anchor], open: &[Vec<f64>]) -> Self {
        let powers: Vec<f64> = (0..self.far_items()).map(|i| f64::from(self.far_share(i))).collect();
        self.discs.add_small(anchors, open, &powers);
        self
    }

    /// Lights at infinity: distant ones, then bins of the sky.
    pub(crate) fn far_items(&self) -> usize {
        self.distant.len() + self.sky.as_ref().map_or(0, |_| SkyView::BINS)
    }

    /// Share of the photons that the light at infinity `item` sends, as it shines.
    pub(crate) fn far_share(&self, item: usize) -> f32 {
        self.emission.share(self.emitters.len() + item)
    }

    /// A direction to look in for the light at infinity `item`, the light that comes from there, and the density of the
    /// direction, 1 for distant lights; none where it sends nothing.
    pub(crate) fn look_far(&self, item: usize, choice: f32, u: [f32; 2]) -> Option<(Vec3, Vec3, f32)> {
        if let Some(Distant { direction, irradiance }) = self.distant.get(item) {
            return Some((-*direction, *irradiance, 1.0));
        }
        let sky = self.sky.as_ref()?;
        let (dir, pdf) = sky.sample(item - self.distant.len(), choice, u);
        Some((dir, sky.radiance(dir), pdf))
    }

    /// Chooses lights by place from now on.
    pub(crate) fn guided(self, guide: Option<LightGuide>) -> Self {
        Self { guide, ..self }
    }

    /// Makes the stock of directions to the sky that pass `pass` draws from.
    pub(crate) fn begin_pass(&mut self, seed: u64, pass: u32) {
        if let Some(sky @ Environment::Image(_)) = &self.sky {
            self.pool = Some(SkyPool::new(sky, seed, pass));
        }
    }

    /// Number of items to choose from; 0 where the scene is dark.
    pub(crate) fn items(&self) -> usize {
        self.table.len()
    }

    pub(crate) fn item(&self, index: usize) -> Item {
        let (groups, distant) = (self.clusters.len(), self.distant.len());
        if index < groups {
            Item::Group(index)
        } else if index < groups + distant {
            Item::Distant(index - groups)
        } else {
            Item::Sky(index - groups - distant)
        }
    }

    /// Probability of an item in the choice by power.
    pub(crate) fn item_probability(&self, index: usize) -> f32 {
        self.table.probability(index)
    }

    fn sky_item(&self, bin: usize) -> usize {
        self.clusters.len() + self.distant.len() + bin
    }

    /// Whether the scene is dark.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// Where photons from infinity are aimed.
    pub fn region(&self) -> VisibleRegion {
        self.discs.region()
    }

    /// Whether photons from infinity are aimed at a region smaller than the scene.
    pub(crate) fn aims(&self) -> bool {
        self.discs.nested() && self.any_far()
    }

    /// Whether a photon that starts at `point` comes from infinity.
    pub(crate) fn is_far(&self, point: &EmissionPoint) -> bool {
        self.emission.at(point.light()).is_some_and(|(index, ..)| index >= self.emitters.len())
    }

    /// Number of the light, as [`LightSample::source`], of a photon that starts at `point`.
    pub(crate) fn source_of_start(&self, point: &EmissionPoint) -> u32 {
        let emitter = self.emission.at(point.light()).and_then(|(index, ..)| self.sources.get(index));
        emitter.copied().unwrap_or(NO_SOURCE)
    }

    /// Whether any light comes from infinity.
    pub(crate) fn any_far(&self) -> bool {
        self.sky.is_some() || !self.distant.is_empty()
    }

    /// Whether light comes from all around.
    pub fn has_environment(&self) -> bool {
        self.sky.is_some()
    }

    /// Bytes of the tables.
    pub fn bytes(&self) -> usize {
        self.emitters.len() * (size_of::<Emitter>() + 16)
            + self.parts.len() * 32
            + self.sky.as_ref().map_or(0, |sky| sky.bytes() + SkyPool::bytes())
            + self.discs.bytes()
            + self.guide.as_ref().map_or(0, LightGuide::bytes)
    }

    /// Radiance from infinity, looking along `dir`.
    pub fn environment_radiance(&self, dir: Vec3) -> Vec3 {
        self.sky.as_ref().map_or(Vec3::ZERO, |sky| sky.radiance(dir))
    }

    /// Which choice of lights holds at a point with its normal on the side that is lit.
    pub(crate) fn place(&self, position: Vec3, normal: Vec3) -> Place {
        self.guide.as_ref().map_or(Place::ANY, |guide| guide.place(position, normal))
    }

    /// Where a shadow ray from a place to an item counts, for [`Self::saw`].
    pub(crate) fn slot(&self, place: Place, item: u32) -> Option<u32> {
        self.guide.as_ref().and_then(|guide| guide.slot(place, item as usize))
    }

    /// Counts a shadow ray that did or did not get through.
    pub(crate) fn saw(&self, slot: u32, reached: bool) {
        if let Some(guide) = &self.guide {
            guide.add(slot, reached);
        }
    }

    /// A pass is over: what its shadow rays found steers those of the next.
    pub(crate) fn keep_findings(&mut self) {
        if let Some(guide) = &mut self.guide {
            guide.keep();
        }
    }

    /// A pass was stopped: it begins again as if it had not been.
    pub(crate) fn forget_findings(&mut self) {
        if let Some(guide) = &mut self.guide {
            guide.forget();
        }
    }

    fn choose(&self, place: Place, u: f32) -> (usize, f32, f32) {
        match &self.guide {
            Some(guide) => guide.choose(&self.table, place, u),
            None => self.table.sample(u),
        }
    }

    fn probability(&self, place: Place, item: usize) -> f32 {
        let overall = self.table.probability(item);
        self.guide.as_ref().map_or(overall, |guide| guide.probability(overall, place, item))
    }

    /// Density with which `sample` at `place` chooses the direction `dir` to infinity.
    pub(crate) fn environment_pdf(&self, place: Place, dir: Vec3) -> f32 {
        self.sky.as_ref().map_or(0.0, |sky| {
            let (bin, pdf) = sky.find(dir);
            self.probability(place, self.sky_item(bin)) * pdf
        })
    }

    /// Density with which `sample` at `from`, in `place`, chooses the point `at` on an emitting shape, over solid angle.
    pub(crate) fn area_pdf(&self, world: &World, from: Vec3, place: Place, at: &SurfacePoint) -> f32 {
        let first = self.first_emitter[at.shape as usize];
        if first == u32::MAX {
            return 0.0;
        }
        let emitter = (first + at.prim - world.shapes[at.shape as usize].first_prim) as usize;
        let part = self.first_part[emitter] + self.emitters[emitter].part_of(at);
        let (group, share) = self.clusters.find(part as usize);
        self.probability(place, group) * share * self.emitters[emitter].pdf(world, from, at)
    }

    /// Chooses a light and a point on it as seen from `from`, in `place`; none where the choice sends nothing there.
    pub(crate) fn sample(
        &self,
        world: &World,
        from: Vec3,
        place: Place,
        choice: f32,
        u: [f32; 2],
    ) -> Option<LightSample> {
        if self.table.is_empty() {
            return None;
        }
        let (item, probability, rest) = self.choose(place, choice);
        if probability <= 0.0 {
            return None;
        }
        let sample = self.sample_item(world, from, item, rest, u)?;
        Some(LightSample { pdf: sample.pdf * probability, item: item as u32, ..sample })
    }

    /// A point on one item as seen from `from`; the density leaves out the choice of the item. The item must have
    /// power.
    pub(crate) fn sample_item(
        &self,
        world: &World,
        from: Vec3,
        item: usize,
        choice: f32,
        u: [f32; 2],
    ) -> Option<LightSample> {
        let sample = match self.item(item) {
            Item::Group(group) => {
                let (part, share, _) = self.clusters.sample(group, choice);
                let (emitter, part) = self.parts[part];
                let sample = self.emitters[emitter as usize].sample(world, part, from, u);
                LightSample { pdf: sample.pdf * share, source: self.sources[emitter as usize], ..sample }
            }
            Item::Distant(i) => {
                let Distant { direction, irradiance } = self.distant[i];
                LightSample {
                    dir: -direction,
                    target: None,
                    radiance: irradiance,
                    pdf: 1.0,
                    delta: true,
                    item: 0,
                    source: NO_SOURCE,
                }
            }
            Item::Sky(bin) => {
                let (dir, radiance, pdf) = match &self.pool {
                    Some(pool) => {
                        let stocked = pool.get(bin, choice);
                        (stocked.dir, stocked.radiance, stocked.pdf)
                    }
                    None => {
                        let sky = self.sky.as_ref()?;
                        let (dir, pdf) = sky.sample(bin, choice, u);
                        (dir, sky.radiance(dir), pdf)
                    }
                };
                LightSample { dir, target: None, radiance, pdf, delta: false, item: 0, source: NO_SOURCE }
            }
        };
        let useful = sample.dir.is_finite()
            && sample.radiance.max_element() > 0.0
            && sample.pdf > 0.0
            && (sample.pdf.is_finite() && sample.radiance.is_finite());
        useful.then_some(sample)
    }

    /// Starts a photon from numbers that are uniform over the cube; none where they choose what emits nothing.
    pub(crate) fn emit(&self, world: &World, point: &EmissionPoint) -> Option<PhotonStart> {
        let (place, way) = (point.place(), point.direction());
        let (index, probability, rest) = self.emission.at(point.light())?;
        let near = self.emitters.len();
        if index < near {
            let (ray, flux) = self.emitters[index].start(world, place, way);
            let flux = flux / probability;
            return (flux.is_finite() && flux.max_element() > 0.0).then_some(PhotonStart { ray, flux });
        }
        let disc = self.discs.choose(point.disc());
        let far = self.emission.share_from(near);
        let (item, rest) = match disc {
            Disc::Wide(_) => (index - near, rest),
            Disc::Small(small) => self.discs.item(small, self.emission.within(near, point.light()))?,
        };
        let (dir, light, pdf) = self.look_far(item, rest, way)?;
        let by_power = self.far_share(item);
        let (ray, density) = self.discs.start(disc, -dir, place, item, by_power, far);
        let flux = light / (pdf * density) / by_power;
        (flux.is_finite() && flux.max_element() > 0.0).then_some(PhotonStart { ray, flux })
    }
}
