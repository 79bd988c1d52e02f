//! Aims photons at what makes caustics that are seen: a density over the starts of photons, learned from photons that
//! arrived.
//!
//! Jensen's projection maps ("Realistic Image Synthesis Using Photon Mapping", 2001, section 5.1.4) mark the directions
//! in which a light sees mirrors and glass. This guide is such a map over all numbers that start a photon, as a tree of
//! boxes, and is learned: it knows no geometry, and serves lamps of any size, spots, and light from infinity alike.

use super::emission::EmissionPoint;
use std::collections::BinaryHeap;

const AXES: usize = EmissionPoint::AXES;
/// Places along an axis where a box may be split.
const BINS: usize = 8;
/// Photons that a box must hold to be split, and boxes at most.
const MIN_PHOTONS: usize = 16;
const MAX_BOXES: usize = 1024;
/// Splits end where one lowers the square root of the variance by less than this share.
const MIN_GAIN: f64 = 5e-5;
/// Photons by which a box is drawn towards an even spread before it is split: boxes that were missed by chance stay
/// possible, and those at the edge of what is worth it are not underrated.
const SMOOTHING: f64 = 4.0;

/// A start that led to a caustic photon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub start: EmissionPoint,
    /// Square of what the photon is worth, over the density of its start.
    pub weight: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Node {
    /// Numbers below `share` go to the next node, which holds the part below `split`; the others to node `above`.
    Split {
        axis: u8,
        split: f32,
        share: f32,
        above: u32,
    },
    Box {
        density: f32,
    },
}

/// A piecewise constant density over the unit cube.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EmissionGuide {
    nodes: Vec<Node>,
}

/// A box while the tree grows.
struct Growing {
    low: [f32; AXES],
    high: [f32; AXES],
    arrivals: Vec<Arrival>,
    /// Estimate of the integral of the squared worth, and the box's volume.
    worth: f64,
    volume: f64,
    children: Option<(u8, f32, usize, usize)>,
}

/// A split that would pay: gain, box, axis, place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Offer {
    gain: f64,
    index: usize,
    axis: usize,
    bin: usize,
}

impl Eq for Offer {}

impl Ord for Offer {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.gain.total_cmp(&other.gain).then(other.index.cmp(&self.index))
    }
}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Growing {
    /// The best split of the box, if any may be.
    fn offer(&self, index: usize) -> Option<Offer> {
        if self.arrivals.len() < MIN_PHOTONS {
            return None;
        }
        let mut sums = [[0.0f64; BINS]; AXES];
        for arrival in &self.arrivals {
            for axis in 0..AXES {
                sums[axis][self.bin(arrival, axis)] += arrival.weight;
            }
        }
        let mut best: Option<Offer> = None;
        for (axis, sums) in sums.iter().enumerate() {
            let mut below = 0.0;
            for bin in 1..BINS {
                below += sums[bin - 1];
                let [low, high] = self.split_worth(below, bin);
                let part = bin as f64 / BINS as f64;
                let after = (low * self.volume * part).sqrt() + (high * self.volume * (1.0 - part)).sqrt();
                let gain = (self.worth * self.volume).sqrt() - after;
                if best.is_none_or(|b| gain > b.gain) && self.at(axis, bin) > self.low[axis] {
                    best = Some(Offer { gain, index, axis, bin });
                }
            }
        }
        best
    }

    /// Worth of the two parts of a split: what lies there, drawn towards an even spread.
    fn split_worth(&self, below: f64, bin: usize) -> [f64; 2] {
        let part = bin as f64 / BINS as f64;
        let total: f64 = self.arrivals.iter().map(|a| a.weight).sum();
        let even = SMOOTHING * total / self.arrivals.len() as f64;
        let scale = self.worth / (total + even);
        [(below + even * part) * scale, (total - below + even * (1.0 - part)) * scale]
    }

    fn bin(&self, arrival: &Arrival, axis: usize) -> usize {
        let (low, high) = (self.low[axis], self.high[axis]);
        (((arrival.start.0[axis] - low) / (high - low) * BINS as f32) as usize).min(BINS - 1)
    }

    fn at(&self, axis: usize, bin: usize) -> f32 {
        self.low[axis] + (self.high[axis] - self.low[axis]) * (bin as f32 / BINS as f32)
    }
}

impl EmissionGuide {
    /// Learns from `arrivals`; none where there are too few to tell.
    ///
    /// The density of a box is in proportion to the root of the mean squared worth in it, which gives the least variance
    /// (Rath et al., "Variance-Aware Path Guiding", ACM TOG 39(4), 2020, section 4); boxes are split where that lowers
    /// the variance most.
    pub fn learn(arrivals: Vec<Arrival>) -> Option<Self> {
        let worth: f64 = arrivals.iter().map(|a| a.weight).sum();
        if arrivals.len() < MIN_PHOTONS || !(worth > 0.0) || !worth.is_finite() {
            return None;
        }
        let root = Growing { low: [0.0; AXES], high: [1.0; AXES], arrivals, worth, volume: 1.0, children: None };
        let mut boxes = vec![root];
        let mut offers: BinaryHeap<Offer> = boxes[0].offer(0).into_iter().collect();
        let mut cost = worth.sqrt();
        let mut leaves = 1;
        while leaves < MAX_BOXES {
            let Some(offer) = offers.pop() else { break };
            if offer.gain < MIN_GAIN * cost {
                break;
            }
            cost -= offer.gain;
            leaves += 1;
            for child in split(&mut boxes, offer) {
                offers.extend(boxes[child].offer(child));
            }
        }
        let mut nodes = Vec::with_capacity(boxes.len());
        flatten(&boxes, 0, cost, &mut nodes);
        Some(Self { nodes })
    }

    /// Moves a point that is uniform over the cube to where photons are worth starting, and the density there. Points that
    /// are well spread stay so.
    pub fn aim(&self, point: EmissionPoint) -> (EmissionPoint, f32) {
        let mut u = point.0;
        let (mut low, mut high) = ([0.0f32; AXES], [1.0f32; AXES]);
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Split { axis, split, share, above } => {
                    let axis = usize::from(axis);
                    if u[axis] < share {
                        u[axis] /= share;
                        high[axis] = split;
                        node += 1;
                    } else {
                        u[axis] = (u[axis] - share) / (1.0 - share);
                        low[axis] = split;
                        node = above as usize;
                    }
                }
                Node::Box { density } => {
                    let at = std::array::from_fn(|i| {
                        let x = low[i] + (high[i] - low[i]) * u[i];
                        // Rounding must not carry a point over the upper edge of its box.
                        if x < high[i] { x } else { high[i].next_down().max(low[i]) }
                    });
                    return (EmissionPoint(at), density);
                }
            }
        }
    }

    /// Density of the points that [`EmissionGuide::aim`] makes; 1 in the mean over the cube.
    pub fn density(&self, point: &EmissionPoint) -> f32 {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Split { axis, split, above, .. } => {
                    node = if point.0[usize::from(axis)] < split { node + 1 } else { above as usize };
                }
                Node::Box { density } => return density,
            }
        }
    }

    /// Memory.
    pub fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>()
    }
}

/// Splits a box as offered; the indices of its parts.
fn split(boxes: &mut Vec<Growing>, offer: Offer) -> [usize; 2] {
    let Offer { index, axis, bin, .. } = offer;
    let parent = &mut boxes[index];
    let place = parent.at(axis, bin);
    let arrivals = std::mem::take(&mut parent.arrivals);
    let below_sum: f64 = arrivals.iter().filter(|a| a.start.0[axis] < place).map(|a| a.weight).sum();
    parent.arrivals = arrivals;
    let worth = parent.split_worth(below_sum, bin);
    let (below, above): (Vec<_>, Vec<_>) =
        std::mem::take(&mut parent.arrivals).into_iter().partition(|a| a.start.0[axis] < place);
    let part = bin as f64 / BINS as f64;
    let (mut high, mut low) = (parent.high, parent.low);
    (high[axis], low[axis]) = (place, place);
    let lower = Growing {
        low: parent.low,
        high,
        arrivals: below,
        worth: worth[0],
        volume: parent.volume * part,
        children: None,
    };
    let upper = Growing {
        low,
        high: parent.high,
        arrivals: above,
        worth: worth[1],
        volume: parent.volume * (1.0 - part),
        children: None,
    };
    let first = boxes.len();
    boxes[index].children = Some((axis as u8, place, first, first + 1));
    boxes.extend([lower, upper]);
    [first, first + 1]
}

/// Lays the tree out depth first and returns the probability of the box; `cost` is the sum over leaves of
/// sqrt(worth volume).
fn flatten(boxes: &[Growing], index: usize, cost: f64, nodes: &mut Vec<Node>) -> f64 {
    let at = nodes.len();
    let node = &boxes[index];
    let Some((axis, place, below, above)) = node.children else {
        let learned = (node.worth * node.volume).sqrt() / cost;
        nodes.push(Node::Box { density: (learned / node.volume) as f32 });
        return learned;
    };
    nodes.push(Node::Box { density: 0.0 });
    let below = flatten(boxes, below, cost, nodes);
    let above_at = nodes.len() as u32;
    let above = flatten(boxes, above, cost, nodes);
    let share = (below / (below + above)) as f32;
    nodes[at] = Node::Split { axis, split: place, share, above: above_at };
    below + above
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    /// Starts in two blobs of four axes, as two spheres over a lamp make them.
    fn arrivals(count: u32) -> Vec<Arrival> {
        (0..count)
            .map(|i| {
                let mut sampler = Sampler::new(7, StreamKind::Test, 1, i);
                let mut start = EmissionPoint::draw(&mut sampler);
                let far = start.light() < 0.3;
                for axis in 2..4 {
                    let middle = if far { 0.7 } else { 0.2 + 0.2 * start.0[axis - 2] };
                    start.0[axis] = middle + 0.1 * (start.0[axis] - 0.5);
                }
                Arrival { start, weight: 1.0 }
            })
            .collect()
    }

    /// Aimed points fall into each of 4^4 cells as often as the density says: its integral there is estimated from
    /// uniform points. Both estimates come from 400,000 points; a cell of probability p has a standard error below
    /// sqrt(p / 40,000) each while the density is below 10, so that six of them and a little more never fail by chance.
    #[test]
    fn aimed_points_have_the_density_that_is_stated() {
        let guide = EmissionGuide::learn(arrivals(5_000)).expect("there are enough");
        let cell = |p: &EmissionPoint| (0..4).fold(0, |cell, axis| cell * 4 + (p.0[axis] * 4.0) as usize);
        let n = 400_000u32;
        let (mut aimed, mut stated) = ([0.0f64; 256], [0.0f64; 256]);
        let mut total = 0.0f64;
        for i in 0..n {
            let point = EmissionPoint::draw(&mut Sampler::new(3, StreamKind::Test, 2, i));
            let density = f64::from(guide.density(&point));
            assert!(density > 0.0);
            stated[cell(&point)] += density / f64::from(n);
            total += density / f64::from(n);
            let (to, density) = guide.aim(point);
            assert!(to.0.iter().all(|x| (0.0..1.0).contains(x)), "{to:?}");
            assert_eq!(density, guide.density(&to), "{to:?}");
            aimed[cell(&to)] += 1.0 / f64::from(n);
        }
        assert!((total - 1.0).abs() < 0.02, "{total}");
        for (i, (a, s)) in aimed.iter().zip(&stated).enumerate() {
            assert!((a - s).abs() < 6.0 * (s.max(1e-4) / 40_000.0).sqrt() * 4.0, "cell {i}: {a}, stated {s}");
        }
    }

    /// Nearly all points land where photons arrived, and the whole cube stays possible.
    #[test]
    fn points_go_where_photons_arrived() {
        let guide = EmissionGuide::learn(arrivals(20_000)).expect("there are enough");
        let n = 100_000;
        let hits = (0..n)
            .filter(|&i| {
                let (to, _) = guide.aim(EmissionPoint::draw(&mut Sampler::new(5, StreamKind::Test, 3, i)));
                let far = to.light() < 0.3;
                (2..4).all(|axis| {
                    let middle = if far { 0.7 } else { 0.2 + 0.2 * to.0[axis - 2] };
                    (to.0[axis] - middle).abs() < 0.05
                })
            })
            .count();
        // One in a hundred would by chance.
        assert!(hits > n as usize / 3, "{hits}");
    }

    #[test]
    fn too_little_teaches_nothing() {
        assert_eq!(EmissionGuide::learn(arrivals(MIN_PHOTONS as u32 - 1)), None);
        let dark = arrivals(100).into_iter().map(|a| Arrival { weight: 0.0, ..a });
        assert_eq!(EmissionGuide::learn(dark.collect()), None);
        // One place a hundred times: boxes around it shrink until they cannot.
        let point = arrivals(1)[0];
        let guide = EmissionGuide::learn(vec![point; 100]).expect("there are enough");
        assert!(guide.density(&point.start) > 100.0);
    }
}
