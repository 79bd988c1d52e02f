//! Where photons from infinity start: discs across their direction, wide ones around what is seen and, where useful light was
//! found to pass, small ones.

use super::anchors::Anchor;
use super::emission::LightChoice;
use super::lights::VisibleRegion;
use crate::camera::uniform_disk;
use crate::world::World;
use photinus_geometry::{Frame, Ray, Vec3};
use std::f32::consts::PI;

/// Share of the photons on wide discs where there are small ones: it bounds the strength of what the small ones miss.
const WIDE: f32 = 0.3;
/// Light of an item that is not seen from an anchor counts as if this share of it were.
const UNSEEN: f64 = 0.01;

/// Discs around each anchor: radius over its own, and share of its photons. The wider one catches what passes near it, whose
/// photons would be much stronger else.
const AROUND: [(f32, f64); 2] = [(1.0, 0.75), (2.0, 0.25)];

/// A small disc.
#[derive(Clone, Debug)]
struct Small {
    anchor: Anchor,
    share: f32,
    /// The choice among the lights at infinity.
    items: LightChoice,
}

/// The discs.
#[derive(Clone, Debug)]
pub(crate) struct Discs {
    region: VisibleRegion,
    /// Radii of the wide discs, with the share of each.
    rings: Vec<(f32, f32)>,
    small: Vec<Small>,
    choice: LightChoice,
}

/// Where on which disc a photon starts, its direction left open.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Disc {
    /// A number that chooses among the wide ones.
    Wide(f32),
    Small(usize),
}

impl Discs {
    pub fn new(world: &World, region: VisibleRegion) -> Self {
        Self { region, rings: rings(world, region), small: Vec::new(), choice: LightChoice::default() }
    }

    /// Adds small discs around `anchors`. Of each, `open` says for every light at infinity which share of its light
    /// arrives from outside; `powers` are those of the lights.
    pub fn add_small(&mut self, anchors: &[Anchor], open: &[Vec<f64>], powers: &[f64]) {
        self.small.clear();
        let mut weights = Vec::new();
        for (anchor, open) in anchors.iter().zip(open) {
            let shares: Vec<f64> = powers.iter().zip(open).map(|(p, open)| p * (open + UNSEEN)).collect();
            for (wider, share) in AROUND {
                let anchor = Anchor { radius: wider * anchor.radius, ..*anchor };
                weights.push(share * anchor.weight);
                self.small.push(Small { anchor, share: 0.0, items: LightChoice::new(&shares) });
            }
        }
        self.choice = LightChoice::new(&weights);
        for (i, small) in self.small.iter_mut().enumerate() {
            small.share = self.choice.share(i);
        }
    }

    pub fn region(&self) -> VisibleRegion {
        self.region
    }

    /// Whether the scene reaches beyond the visible region.
    pub fn nested(&self) -> bool {
        self.rings.len() > 1
    }

    pub fn bytes(&self) -> usize {
        self.small.iter().map(|s| s.items.bytes()).sum()
    }

    /// The disc that `u` chooses.
    pub fn choose(&self, u: f32) -> Disc {
        if self.small.is_empty() {
            return Disc::Wide(u);
        }
        if u < WIDE {
            return Disc::Wide(u / WIDE);
        }
        self.choice.at((u - WIDE) / (1.0 - WIDE)).map_or(Disc::Wide(0.0), |(i, ..)| Disc::Small(i))
    }

    /// The light at infinity that `u` chooses for a small disc, and what is left of `u`.
    pub fn item(&self, disc: usize, u: f32) -> Option<(usize, f32)> {
        self.small[disc].items.at(u).map(|(item, _, rest)| (item, rest))
    }

    /// A ray that travels along `dir` from beyond the scene, and the density of its place per area across it: that of all
    /// discs together, over the probability `by_power` with which wide discs choose its light, `item`. Small ones choose
    /// as they do, with probability `far` in all.
    ///
    /// Wide discs are nested around the visible region, each twice as wide as the one before: light that falls far outside
    /// still counts, at a density that falls like the square of the distance.
    pub fn start(&self, disc: Disc, dir: Vec3, u: [f32; 2], item: usize, by_power: f32, far: f32) -> (Ray, f32) {
        let [x, y] = uniform_disk(u);
        let frame = Frame::from_normal(dir);
        let reach = self.rings[self.rings.len() - 1].0;
        let across = |radius: f32| (frame.s * x + frame.t * y) * radius;
        let (place, off, own) = match disc {
            Disc::Wide(choice) => {
                let mut rest = choice;
                let mut radius = reach;
                for &(r, share) in &self.rings {
                    if rest < share {
                        radius = r;
                        break;
                    }
                    rest -= share;
                }
                (across(radius), radius * (x * x + y * y).sqrt(), usize::MAX)
            }
            Disc::Small(own) => {
                let Anchor { center, radius, .. } = self.small[own].anchor;
                let place = center - self.region.center + across(radius);
                let place = place - dir * place.dot(dir);
                (place, place.length(), own)
            }
        };
        let wide = self.rings.iter().filter(|(r, _)| *r >= off).map(|(r, share)| share / (PI * r * r)).sum::<f32>();
        let place = self.region.center + place;
        let ray = Ray::new(place - dir * (2.0 * reach), dir);
        if self.small.is_empty() {
            return (ray, wide);
        }
        // Rounding must not carry a place out of its own disc.
        let holds = |(i, s): &(usize, &Small)| *i == own || s.anchor.holds(place, dir);
        let density =
            |(_, s): (usize, &Small)| s.share * s.items.share(item) / (PI * s.anchor.radius * s.anchor.radius);
        let small: f32 = self.small.iter().enumerate().filter(holds).map(density).sum();
        (ray, WIDE * wide + (1.0 - WIDE) * small * (far / by_power))
    }
}

/// Half of the photons go to the visible region, the others to discs that double in radius until the scene ends.
fn rings(world: &World, region: VisibleRegion) -> Vec<(f32, f32)> {
    let bounds = world.bounds;
    let reach = if bounds.is_empty() {
        region.radius
    } else {
        (region.center - bounds.center()).length() + 0.5 * bounds.diagonal()
    };
    let mut radii = vec![region.radius];
    while radii[radii.len() - 1] < reach && radii.len() < 64 {
        radii.push((radii[radii.len() - 1] * 2.0).min(reach));
    }
    if radii.len() == 1 {
        return vec![(radii[0], 1.0)];
    }
    let others = 0.5 / (radii.len() - 1) as f32;
    radii.into_iter().enumerate().map(|(i, r)| (r, if i == 0 { 0.5 } else { others })).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    /// Two lights at infinity and two places, each of which sees one of them well. For each light and direction, the sum of
    /// 1 / (density of the place times probability of the light) over the starts that cross a window estimates the
    /// window's area, wherever it lies: near a place, beside all, and far outside of the inner ring.
    #[test]
    fn starts_have_the_density_that_is_stated() {
        let region = VisibleRegion { center: Vec3::new(1.0, 0.0, 0.5), radius: 2.0 };
        let anchor = |x: f32, radius: f32, weight: f64| Anchor { center: Vec3::new(x, 0.3, 0.0), radius, weight };
        let mut discs = Discs {
            region,
            rings: vec![(2.0, 0.5), (4.0, 0.25), (8.0, 0.25)],
            small: Vec::new(),
            choice: LightChoice::default(),
        };
        let powers = [0.25f64, 0.5];
        discs.add_small(&[anchor(0.0, 0.3, 1.0), anchor(1.5, 0.5, 3.0)], &[vec![1.0, 0.0], vec![0.2, 0.9]], &powers);
        // A near light has the remaining quarter.
        let far = 0.75f32;
        let dirs = [Vec3::new(0.2, -0.9, 0.3).normalize(), Vec3::new(-0.5, -0.5, 0.6).normalize()];
        let windows =
            [(Vec3::new(0.05, 0.3, 0.0), 0.2f32), (Vec3::new(2.2, 0.0, 0.5), 0.3), (Vec3::new(6.0, 0.0, 0.0), 1.5)];
        let n = 400_000u32;
        let mut areas = [[0.0f64; 3]; 2];
        for i in 0..n {
            let mut sampler = Sampler::new(11, StreamKind::Test, 4, i);
            let (u, choice, light) = (sampler.next_2d(), sampler.next_1d(), sampler.next_1d());
            // The choice among all lights led to those at infinity with probability `far`.
            let item = match discs.choose(choice) {
                Disc::Wide(_) => usize::from(light >= 1.0 / 3.0),
                Disc::Small(small) => discs.item(small, light).expect("both have power").0,
            };
            let by_power = powers[item] as f32;
            let (ray, density) = discs.start(discs.choose(choice), dirs[item], u, item, by_power, far);
            for (window, (center, radius)) in windows.iter().enumerate() {
                let to = *center - ray.origin;
                let across = to - ray.dir * to.dot(ray.dir);
                if across.length() < *radius {
                    areas[item][window] += f64::from(far / (density * by_power)) / f64::from(n);
                }
            }
        }
        for (item, areas) in areas.iter().enumerate() {
            for (area, (_, radius)) in areas.iter().zip(&windows) {
                let ratio = area / f64::from(PI * radius * radius);
                assert!((ratio - 1.0).abs() < 0.04, "light {item}, window of radius {radius}: {ratio}");
            }
        }
    }
}
