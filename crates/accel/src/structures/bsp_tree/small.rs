//! Nodes of few primitives: of all planes along their triangles, their edges and the axes the one of least cost.
//!
//! Planes tried for each triangle are its own, on either side of it, and those that stand on its edges, so that the
//! triangle lies within (Ize, Wald, Parker, section 3.1); for each primitive the planes across the axes at its bounds.

use super::Plane;
use super::build::{Built, Cut, Rule};
use super::polytope::{Knife, Polytope, cross, dot, minus};
use crate::bounds::padded_bounds;
use crate::fragment::{Point, Polygon, margins};
use photinus_geometry::{Aabb, Primitives};

/// Levels below a large node at most.
pub const MAX_DEPTH: u32 = 48;
/// Leaves and references together stay below this many for each primitive of a large node.
const MAX_REFERENCES_PER_PRIM: usize = 32;

/// What lies of a primitive in a cell.
#[derive(Clone)]
enum Shape {
    Triangle(Box<Polygon>),
    /// Middle and half the edges of the box around a sphere.
    Sphere(Point, Point),
}

/// A primitive in a cell.
#[derive(Clone)]
struct Fragment {
    id: u32,
    shape: Shape,
    /// See [`margins`].
    margins: Point,
}

impl Fragment {
    /// The part of a primitive in a box.
    fn new(primitives: &Primitives, id: u32, cell: &Aabb) -> Option<Self> {
        let padded = padded_bounds(primitives, id as usize)?;
        let margins = margins(primitives, id as usize);
        let shape = match Polygon::of(primitives, id as usize) {
            None => {
                let (min, max) = (padded.min.to_array().map(f64::from), padded.max.to_array().map(f64::from));
                let half = std::array::from_fn(|k| 0.5 * (max[k] - min[k]));
                return Some(Self {
                    id,
                    shape: Shape::Sphere(std::array::from_fn(|k| min[k] + half[k]), half),
                    margins,
                });
            }
            Some(polygon) => (0..3).fold(polygon, |left, k| {
                left.between(k, f64::from(cell.min[k]) - margins[k], f64::from(cell.max[k]) + margins[k])
            }),
        };
        (!shape.is_empty()).then_some(Self { id, shape: Shape::Triangle(Box::new(shape)), margins })
    }

    /// How far hits may lie off along a direction.
    fn margin(&self, normal: &Point) -> f64 {
        (0..3).map(|k| normal[k].abs() * self.margins[k]).sum()
    }

    /// Least and greatest place along a direction, margins included.
    fn range(&self, normal: &Point) -> (f64, f64) {
        let margin = self.margin(normal);
        let (low, high) = match &self.shape {
            Shape::Triangle(polygon) => {
                polygon.corners().iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| {
                    let x = dot(normal, p);
                    (l.min(x), h.max(x))
                })
            }
            Shape::Sphere(middle, half) => {
                let (at, reach) = (dot(normal, middle), (0..3).map(|k| normal[k].abs() * half[k]).sum::<f64>());
                (at - reach, at + reach)
            }
        };
        (low - margin, high + margin)
    }

    /// What lies of it below and above a plane.
    fn cut(&self, knife: &Knife) -> [Option<Self>; 2] {
        let (low, high) = self.range(&knife.normal);
        let (below, above) = (low < knife.offset, high > knife.offset);
        let margin = self.margin(&knife.normal);
        let part = |sign: f64| match &self.shape {
            Shape::Triangle(polygon) if below && above => {
                let left = polygon.above(|p| sign * knife.height(p) + margin);
                // What rounds to nothing is near enough to stay.
                let shape = if left.is_empty() { self.shape.clone() } else { Shape::Triangle(Box::new(left)) };
                Self { shape, ..self.clone() }
            }
            _ => self.clone(),
        };
        [below.then(|| part(-1.0)), above.then(|| part(1.0))]
    }
}

/// A plane of which a node may be split, as the tree stores it.
struct Candidate {
    cut: Cut,
    knife: Knife,
}

/// Across an axis, at the nearest float that is not below `position`, or not above it.
fn across(axis: usize, position: f64, up: bool) -> Candidate {
    let nearest = position as f32;
    let position = match up {
        true if f64::from(nearest) < position => nearest.next_up(),
        false if f64::from(nearest) > position => nearest.next_down(),
        _ => nearest,
    };
    let mut normal = [0.0; 3];
    normal[axis] = 1.0;
    Candidate { cut: Cut::Across { axis, position }, knife: Knife { normal, offset: f64::from(position) } }
}

/// The unit vector along `v` in floats; `None` where it has no direction.
fn unit(v: &Point) -> Option<[f32; 3]> {
    let largest = v.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    let scaled = v.map(|x| x / largest);
    let inv_length = 1.0 / dot(&scaled, &scaled).sqrt();
    let unit = scaled.map(|x| (x * inv_length) as f32);
    unit.iter().all(|x| x.is_finite()).then_some(unit)
}

/// The split of a node, with twice the areas of its parts.
struct Split {
    candidate: Candidate,
    areas: [f64; 2],
}

struct Builder<'a> {
    primitives: &'a Primitives,
    rule: Rule,
}

/// The subtree over `ids` in `cell`.
pub fn build(primitives: &Primitives, rule: Rule, ids: Vec<u32>, cell: Aabb) -> Built {
    let fragments: Vec<Fragment> = ids.into_iter().filter_map(|id| Fragment::new(primitives, id, &cell)).collect();
    let budget = fragments.len() * MAX_REFERENCES_PER_PRIM;
    Builder { primitives, rule }.node(fragments, &Polytope::of(&cell), 0, budget)
}

impl Builder<'_> {
    fn node(&self, fragments: Vec<Fragment>, cell: &Polytope, depth: u32, budget: usize) -> Built {
        let area = cell.twice_area();
        let split = if depth < MAX_DEPTH && area > 0.0 { self.best_split(&fragments, cell, area) } else { None };
        let leaf = |fragments: Vec<Fragment>| Built::Leaf(fragments.into_iter().map(|f| f.id).collect());
        let Some(Split { candidate: Candidate { cut, knife }, areas, .. }) = split else { return leaf(fragments) };
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for fragment in &fragments {
            let [b, a] = fragment.cut(&knife);
            below.extend(b);
            above.extend(a);
        }
        let (b, a) = (below.len().max(1), above.len().max(1));
        if b + a > budget {
            return leaf(fragments);
        }
        let below_budget = b + (budget - b - a) * b / (b + a);
        let [below_cell, above_cell] = cell.cut(&knife);
        let below = self.node(below, &below_cell, depth + 1, below_budget);
        let above = self.node(above, &above_cell, depth + 1, budget - below_budget);
        let node_cost = match cut {
            Cut::Across { .. } => self.rule.across_cost,
            Cut::Oblique(_) => self.rule.oblique_cost,
        };
        let cost = node_cost + (areas[0] * below.cost() + areas[1] * above.cost()) / area;
        Built::Split { cut, cost, children: Box::new([below, above]) }
    }

    /// The cheapest split of a node, if it is cheaper than a leaf; of equals the first that is tried.
    fn best_split(&self, fragments: &[Fragment], cell: &Polytope, area: f64) -> Option<Split> {
        let count = fragments.len();
        let mut best: Option<Split> = None;
        let mut least = count as f64;
        let mut consider = |candidate: Candidate, node_cost: f64| {
            let (mut below, mut above) = (0usize, 0usize);
            for fragment in fragments {
                let (low, high) = fragment.range(&candidate.knife.normal);
                below += usize::from(low < candidate.knife.offset);
                above += usize::from(high > candidate.knife.offset);
            }
            // Both parts together have more area than the cell: no split costs less than this.
            if !(node_cost + (below.min(above) as f64) < least) || below + above == 2 * count {
                return;
            }
            let areas = cell.twice_areas(&candidate.knife);
            let cost = node_cost + (areas[0] * below as f64 + areas[1] * above as f64) / area;
            // A plane beside the cell divides nothing.
            if cost < least && areas[0] < area && areas[1] < area {
                (least, best) = (cost, Some(Split { candidate, areas }));
            }
        };
        for fragment in fragments {
            for axis in 0..3 {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                let (low, high) = fragment.range(&normal);
                consider(across(axis, low, false), self.rule.across_cost);
                consider(across(axis, high, true), self.rule.across_cost);
            }
        }
        for fragment in fragments {
            let Shape::Triangle(_) = fragment.shape else { continue };
            let corners: [Point; 3] =
                self.primitives.triangle(fragment.id as usize).map(|v| v.to_array().map(f64::from));
            let edges: [Point; 3] = std::array::from_fn(|i| minus(&corners[(i + 1) % 3], &corners[i]));
            let face = cross(&edges[0], &edges[1]);
            let Some(flat) = unit(&face) else { continue };
            let sides = edges.iter().filter_map(|edge| unit(&cross(edge, &flat.map(f64::from))));
            for (i, normal) in std::iter::once(flat).chain(sides).enumerate() {
                let in_doubles = normal.map(f64::from);
                let (low, high) = fragment.range(&in_doubles);
                // A triangle may lie on either side of its own plane, but only within its edges'.
                for offset in [Some(high), (i == 0).then_some(low)].into_iter().flatten() {
                    let (cut, knife) = (Cut::Oblique(Plane { normal, offset }), Knife { normal: in_doubles, offset });
                    consider(Candidate { cut, knife }, self.rule.oblique_cost);
                }
            }
        }
        best
    }
}
