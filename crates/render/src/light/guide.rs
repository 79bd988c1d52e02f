//! Which lights matter where: a choice of lights by place, learned from shadow rays before the first pass and in all passes.
//!
//! Visible points are grouped by position and normal; for each group and each item of the lights a few shadow rays say
//! how much light would arrive and how often it does, and those of each pass add to the latter. Items are then chosen in
//! proportion to the root of the mean square of what arrives, which is least noisy where an item is partly hidden (Rath et
//! al. 2020, "Variance-aware path guiding", section 3). A share of the choice by power alone is mixed in, so that nothing
//! that shines is ever missed.

use super::alias::AliasTable;
use super::clusters::widest;
use super::emitter::mean;
use super::lights::{Item, Lights};
use super::sky_view::SkyView;
use super::tally::{Count, Tally};
use crate::control::{Cancelled, Observer};
use crate::counters::Counters;
use crate::pilot::VisiblePoint;
use crate::trace::Tracer;
use crate::twin::Twin;
use crate::world::World;
use photinus_geometry::{Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use rayon::prelude::*;

/// Points of a group, where the budget of rays does not ask for more.
const LEAF: usize = 4;
/// Shadow rays to learn from, for each pixel, and bounds of their number.
const RAYS_PER_PIXEL: usize = 4;
const BUDGET: [usize; 2] = [100_000, 2_000_000];
/// Shadow rays for each group and item, and how many look at what would arrive: most of them without asking what is in between.
const RAYS: u32 = 1;
const LOOKS: u32 = 4;
/// Looks at parts of the sky that nothing was seen to reach.
const LOOKS_UNSEEN: u32 = 1;
/// Share of the choice by power alone.
const BY_POWER: f32 = 0.1;
/// As many rays does what is known of the groups around count as much as, in what is known of a group.
const AROUND: f32 = 16.0;
/// Rays that got through, and rays, as if they had been seen before any was sent.
const BEFORE: [f32; 2] = [0.05, 1.0];
/// Findings are worth a new choice when so many times as many rays have been sent.
const NEWS: f64 = 1.15;
/// Items that send less than this share of the light that may reach a group are not asked for.
const FAINT: f32 = 1e-3;
/// Cosine that is added to every surface's: rough and two-sided ones see light from aslant and behind.
const ASLANT: f32 = 0.05;

/// The group that a point belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place(u32);

impl Place {
    /// None: lights are chosen by power.
    pub const ANY: Self = Self(u32::MAX);
}

#[derive(Clone, Copy, Debug)]
enum Node {
    Split { axis: usize, at: f32, children: [u32; 2] },
    Leaf(u32),
}

/// Box of a group's points.
#[derive(Clone, Copy, Debug)]
struct Extent {
    low: Vec3,
    high: Vec3,
}

/// The learned choice.
#[derive(Debug)]
pub(crate) struct LightGuide {
    nodes: Vec<Node>,
    extents: Vec<Extent>,
    /// Over the items, for each group; empty where nothing arrives.
    tables: Vec<AliasTable>,
    /// Distance that counts as much as a difference in normals of 1.
    scale: f32,
    items: usize,
    /// Root of the mean square of what would arrive if nothing were in between, by group and item.
    clear: Vec<f32>,
    tally: Tally,
    /// Rays that the tables are made of.
    rays: u64,
}

/// What is asked before the first pass, for one group, by item.
struct Look {
    clear: Vec<f32>,
    counts: Vec<Count>,
}

impl LightGuide {
    /// Learns from `points`, at a cost that suits a picture of so many pixels; none where there is no choice, or nothing
    /// to learn from.
    pub fn learn(
        world: &World,
        lights: &Lights,
        points: &[VisiblePoint],
        view: &SkyView,
        pixels: usize,
        seed: u64,
        observer: &dyn Observer,
    ) -> Result<Option<Self>, Cancelled> {
        if lights.items() < 2 || points.is_empty() {
            return Ok(None);
        }
        let scale = 0.5 * lights.region().radius;
        let mut guide = Self::new(scale, lights.items());
        let mut groups: Vec<Vec<VisiblePoint>> = Vec::new();
        let budget = (RAYS_PER_PIXEL * pixels).clamp(BUDGET[0], BUDGET[1]);
        let most_groups = (budget / (lights.items() * RAYS as usize)).max(1);
        // Cuts in the middle of space leave groups half full.
        let leaf = LEAF.max(2 * points.len() / most_groups);
        guide.split(points.to_vec(), leaf, &mut groups);
        let looks: Option<Vec<Look>> = groups
            .par_iter()
            .enumerate()
            .map(|(g, group)| (!observer.cancelled()).then(|| look(world, lights, group, view, seed, g as u64)))
            .collect();
        let looks = looks.ok_or(Cancelled)?;
        guide.clear = looks.iter().flat_map(|look| look.clear.iter().copied()).collect();
        guide.tally = Tally::new(looks.into_iter().flat_map(|look| look.counts).collect());
        guide.choose_anew();
        Ok(Some(guide))
    }

    /// Without groups yet.
    fn new(scale: f32, items: usize) -> Self {
        Self {
            nodes: Vec::new(),
            extents: Vec::new(),
            tables: Vec::new(),
            scale,
            items,
            clear: Vec::new(),
            tally: Tally::default(),
            rays: 0,
        }
    }

    /// Cuts `points` in the middle of their widest axis until groups have at most `leaf`; returns the node.
    fn split(&mut self, points: Vec<VisiblePoint>, leaf: usize, groups: &mut Vec<Vec<VisiblePoint>>) -> u32 {
        let index = self.nodes.len() as u32;
        let scale = self.scale;
        let (axis, width) = widest(points.iter().map(|p| key(p.position, p.normal, scale)));
        if points.len() <= leaf || !(width > 1e-4 * scale) {
            return self.leaf(points, groups);
        }
        let value = |p: &VisiblePoint| key(p.position, p.normal, scale)[axis];
        let (low, high) =
            points.iter().map(value).fold((f32::INFINITY, f32::NEG_INFINITY), |m, v| (m.0.min(v), m.1.max(v)));
        let at = 0.5 * (low + high);
        let (rest, points): (Vec<_>, Vec<_>) = points.into_iter().partition(|p| value(p) > at);
        if rest.is_empty() || points.is_empty() {
            return self.leaf([rest, points].concat(), groups);
        }
        self.nodes.push(Node::Leaf(0));
        let children = [self.split(points, leaf, groups), self.split(rest, leaf, groups)];
        self.nodes[index as usize] = Node::Split { axis, at, children };
        index
    }

    fn leaf(&mut self, points: Vec<VisiblePoint>, groups: &mut Vec<Vec<VisiblePoint>>) -> u32 {
        let low = points.iter().fold(Vec3::INFINITY, |m, p| m.min(p.position));
        let high = points.iter().fold(Vec3::NEG_INFINITY, |m, p| m.max(p.position));
        // Between the points that were looked at lie others.
        let margin = Vec3::splat(0.5 * (high - low).length());
        self.extents.push(Extent { low: low - margin, high: high + margin });
        self.nodes.push(Node::Leaf(groups.len() as u32));
        groups.push(points);
        self.nodes.len() as u32 - 1
    }

    /// Adds the findings of the pass that is over.
    pub fn keep(&mut self) {
        self.tally.keep();
        let rays: u64 = self.tally.known().iter().map(|count| u64::from(count.asked)).sum();
        if rays as f64 > NEWS * self.rays as f64 {
            self.choose_anew();
        }
    }

    /// Drops the findings of the pass that was stopped.
    pub fn forget(&mut self) {
        self.tally.forget();
    }

    /// Where [`Self::add`] counts a ray from a place to an item; none away from all groups.
    #[inline]
    pub fn slot(&self, place: Place, item: usize) -> Option<u32> {
        (place != Place::ANY).then(|| place.0 * self.items as u32 + item as u32)
    }

    /// Counts a shadow ray that did or did not get through.
    #[inline]
    pub fn add(&self, slot: u32, reached: bool) {
        self.tally.add(slot as usize, reached);
    }

    /// Makes the tables of all that is known.
    fn choose_anew(&mut self) {
        let (known, items) = (self.tally.known(), self.items);
        self.rays = known.iter().map(|count| u64::from(count.asked)).sum();
        // Children stand behind their parents.
        let mut counts: Vec<Vec<Count>> = vec![Vec::new(); self.nodes.len()];
        for node in (0..self.nodes.len()).rev() {
            counts[node] = match self.nodes[node] {
                Node::Leaf(group) => known[group as usize * items..][..items].to_vec(),
                Node::Split { children: [low, high], .. } => {
                    let mut sum = counts[low as usize].clone();
                    sum.iter_mut().zip(&counts[high as usize]).for_each(|(sum, count)| *sum += *count);
                    sum
                }
            };
        }
        let part =
            |[reached, asked]: [f32; 2], count: &Count| (count.reached as f32 + reached) / (count.asked as f32 + asked);
        let mut tables = vec![AliasTable::default(); self.extents.len()];
        let mut open = vec![(0u32, counts[0].iter().map(|count| part(BEFORE, count)).collect::<Vec<f32>>())];
        while let Some((node, around)) = open.pop() {
            let visible = counts[node as usize].iter().zip(&around);
            let visible: Vec<f32> = visible.map(|(count, v)| part([AROUND * v, AROUND], count)).collect();
            match self.nodes[node as usize] {
                Node::Split { children, .. } => open.extend(children.map(|child| (child, visible.clone()))),
                Node::Leaf(group) => {
                    let clear = &self.clear[group as usize * items..][..items];
                    let weights: Vec<f64> =
                        clear.iter().zip(&visible).map(|(clear, v)| f64::from(clear * v.sqrt())).collect();
                    if weights.iter().any(|&w| w > 0.0) {
                        tables[group as usize] = AliasTable::new(&weights);
                    }
                }
            }
        }
        self.tables = tables;
    }

    /// The group of a point with its normal; [`Place::ANY`] away from all that was looked at.
    pub fn place(&self, position: Vec3, normal: Vec3) -> Place {
        let key = key(position, normal, self.scale);
        let mut node = 0u32;
        loop {
            match self.nodes[node as usize] {
                Node::Split { axis, at, children } => node = children[usize::from(key[axis] > at)],
                Node::Leaf(group) => {
                    let Extent { low, high } = self.extents[group as usize];
                    let inside = position.cmpge(low).all() && position.cmple(high).all();
                    let known = inside && !self.tables[group as usize].is_empty();
                    return if known { Place(group) } else { Place::ANY };
                }
            }
        }
    }

    /// An item, its probability, and what is left of `u`.
    pub fn choose(&self, by_power: &AliasTable, place: Place, u: f32) -> (usize, f32, f32) {
        if place == Place::ANY {
            return by_power.sample(u);
        }
        let (item, _, rest) = if u < BY_POWER {
            by_power.sample(u / BY_POWER)
        } else {
            self.tables[place.0 as usize].sample((u - BY_POWER) / (1.0 - BY_POWER))
        };
        (item, self.probability(by_power.probability(item), place, item), rest)
    }

    /// Probability of an item, given that in the choice by power alone.
    pub fn probability(&self, by_power: f32, place: Place, item: usize) -> f32 {
        if place == Place::ANY {
            return by_power;
        }
        BY_POWER * by_power + (1.0 - BY_POWER) * self.tables[place.0 as usize].probability(item)
    }

    /// Bytes of the tables.
    pub fn bytes(&self) -> usize {
        let items: usize = self.tables.iter().map(AliasTable::len).sum();
        items * 12
            + self.clear.len() * size_of::<f32>()
            + self.tally.bytes()
            + self.nodes.len() * (size_of::<Node>() + size_of::<Extent>() + size_of::<AliasTable>())
    }
}

fn key(position: Vec3, normal: Vec3, scale: f32) -> [f32; 6] {
    let n = normal * scale;
    [position.x, position.y, position.z, n.x, n.y, n.z]
}

/// How much of each item would arrive at the points of a group, and how often a few rays do.
fn look(world: &World, lights: &Lights, group: &[VisiblePoint], view: &SkyView, seed: u64, index: u64) -> Look {
    let items = lights.items();
    let (mut rays, mut asked) = (Vec::new(), Vec::new());
    let mut squares = vec![0.0f32; items];
    for item in (0..items).filter(|&item| lights.item_probability(item) > 0.0) {
        let count = match lights.item(item) {
            Item::Sky(bin) if !view.reaches(bin) => LOOKS_UNSEEN,
            _ => LOOKS,
        };
        let stream = 3 << 40 | index << 20 | item as u64;
        for i in 0..count {
            let mut sampler = Sampler::new(seed, StreamKind::Pilot, stream, i);
            let (u, choice, pick) = (sampler.next_2d(), sampler.next_1d(), sampler.next_1d());
            let point = &group[((pick * group.len() as f32) as usize).min(group.len() - 1)];
            let origin = point.position + point.normal * point.lift;
            let Some(light) = lights.sample_item(world, origin, item, choice, u) else { continue };
            let cos = point.normal.dot(light.dir).max(0.0) + ASLANT;
            let value = mean(light.radiance) as f32 * cos / light.pdf;
            squares[item] += value * value / count as f32;
            if i < RAYS {
                asked.push(item);
                rays.push(match light.target {
                    Some(target) => Ray { origin, t_min: 0.0, dir: target - origin, t_max: 1.0 },
                    None => Ray::new(origin, light.dir),
                });
            }
        }
    }
    let clear: Vec<f32> = squares.into_iter().map(|s| if s.is_finite() { s.sqrt() } else { 0.0 }).collect();
    let least = FAINT * clear.iter().sum::<f32>();
    let clear: Vec<f32> = clear.into_iter().map(|c| if c >= least { c } else { 0.0 }).collect();
    let (rays, asked): (Vec<Ray>, Vec<usize>) =
        rays.into_iter().zip(asked).filter(|(_, item)| clear[*item] > 0.0).unzip();
    let mut visible = Vec::new();
    Tracer::new(world, Twin::OFF).visibility(&rays, &mut visible, &mut Counters::default());
    let mut counts = vec![Count::default(); items];
    for (item, share) in asked.into_iter().zip(visible) {
        counts[item] += Count { asked: 1, reached: u32::from(share > 0.0) };
    }
    Look { clear, counts }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a floor and on a wall above its edge, and a guide over three items that differ from group to group.
    fn guide() -> (LightGuide, Vec<VisiblePoint>) {
        let points: Vec<VisiblePoint> = (0..800)
            .map(|i| {
                let (x, y) = ((i % 20) as f32 * 0.1, (i / 20 % 20) as f32 * 0.1);
                let (position, normal) =
                    if i < 400 { (Vec3::new(x, 0.0, y), Vec3::Y) } else { (Vec3::new(x, y, 0.0), Vec3::Z) };
                VisiblePoint { position, normal, width: 0.01, lift: 1e-4 }
            })
            .collect();
        let mut guide = LightGuide::new(1.0, 3);
        let mut groups = Vec::new();
        guide.split(points.clone(), 16, &mut groups);
        guide.clear = (0..groups.len()).flat_map(|g| [g as f32, 1.0, 0.0]).collect();
        guide.tally = Tally::new(vec![Count { asked: 4, reached: 2 }; 3 * groups.len()]);
        guide.choose_anew();
        (guide, points)
    }

    /// Rays that get through or not move the choice as the root of their share; those of a stopped pass do not.
    #[test]
    fn findings_steer_the_choice() {
        let (mut guide, points) = guide();
        let place = guide.place(points[300].position, points[300].normal);
        let places = || points.iter().map(|p| guide.place(p.position, p.normal));
        let others: Vec<Place> = places().filter(|other| *other != place && place_index(*other) > 0).collect();
        let by_power = 0.2;
        let share = |guide: &LightGuide, place| {
            let [a, b] = [0, 1].map(|item| guide.tables[place_index(place)].probability(item));
            f64::from(b / a)
        };
        let before = share(&guide, place);
        let add = |guide: &LightGuide| {
            for i in 0..20_000 {
                guide.add(guide.slot(place, 0).unwrap(), i % 100 < 1);
                guide.add(guide.slot(place, 1).unwrap(), i % 100 < 64);
            }
        };
        add(&guide);
        guide.forget();
        guide.keep();
        assert_eq!(share(&guide, place), before);
        add(&guide);
        guide.keep();
        let after = share(&guide, place);
        assert!((after / before - 8.0).abs() < 0.1, "{}", after / before);
        // Groups around, with few rays of their own, follow.
        let moved = others.iter().map(|other| share(&guide, *other) * place_index(*other) as f64);
        assert!(moved.fold(0.0, f64::max) > 2.0);
        assert!(guide.probability(by_power, place, 2) > 0.0);
        assert_eq!(guide.slot(Place::ANY, 1), None);
    }

    fn place_index(place: Place) -> usize {
        place.0 as usize
    }

    /// Many points share coordinates with others: none may be looked for on the wrong side of a cut.
    #[test]
    fn points_are_found_among_their_like() {
        let (guide, points) = guide();
        let mut normals = vec![None; guide.extents.len()];
        for point in &points {
            let place = guide.place(point.position, point.normal);
            assert_ne!(place, Place::ANY, "{point:?}");
            let normal = normals[place.0 as usize].get_or_insert(point.normal);
            assert_eq!(*normal, point.normal);
        }
        assert!(normals.iter().all(Option::is_some));
        assert_eq!(guide.place(Vec3::splat(-50.0), Vec3::Y), Place::ANY);
    }

    #[test]
    fn items_are_chosen_as_often_as_stated() {
        let (guide, points) = guide();
        let by_power = AliasTable::new(&[1.0, 1.0, 2.0]);
        for place in [guide.place(points[300].position, points[300].normal), Place::ANY] {
            let n = 100_000;
            let mut counts = [0u32; 3];
            for i in 0..n {
                let (item, probability, rest) = guide.choose(&by_power, place, (i as f32 + 0.5) / n as f32);
                assert_eq!(probability, guide.probability(by_power.probability(item), place, item));
                assert!((0.0..1.0).contains(&rest));
                counts[item] += 1;
            }
            for (item, &count) in counts.iter().enumerate() {
                let stated = guide.probability(by_power.probability(item), place, item);
                assert!((count as f32 / n as f32 - stated).abs() < 1e-3, "{item}: {count} {stated}");
                assert!(stated > 0.0);
            }
        }
    }
}
