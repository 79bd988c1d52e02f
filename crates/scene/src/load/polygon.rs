//! Polygons into triangles: a fan where the polygon is strictly convex, ear clipping in its dominant plane elsewhere.

use photinus_geometry::Vec3;

/// What became of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Simple: its triangles cover it once.
    Covered,
    /// Its outline crosses itself: the triangles cover it, but some overlap.
    Crossing,
    /// No area: no triangles.
    Degenerate,
}

/// Cuts polygons, with scratch memory kept between calls.
///
/// Ear clipping takes up to n² steps for n corners, which a hostile file could turn into hours: all calls share a
/// budget, after which what is left of a polygon becomes a fan.
pub(super) struct Triangulator {
    points: Vec<[f64; 2]>,
    next: Vec<u32>,
    prev: Vec<u32>,
    budget: u64,
}

/// Steps (a few nanoseconds each) that one file may spend beyond [`STEPS_PER_CORNER`].
const SHARED_STEPS: u64 = 1 << 27;
/// Steps that every corner of a polygon adds to the budget.
const STEPS_PER_CORNER: u64 = 256;

/// How strictly ears are chosen; raised when a whole round finds none.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd)]
enum Rule {
    /// No other corner inside or on the border.
    Clear,
    /// No other corner inside.
    Touching,
    /// Any convex corner.
    Convex,
    /// Any corner.
    Any,
}

impl Triangulator {
    pub(super) fn new() -> Self {
        Self { points: Vec::new(), next: Vec::new(), prev: Vec::new(), budget: SHARED_STEPS }
    }

    /// Appends the triangles of the polygon `corners` (at least 3, finite) to `out` as indices into `corners`, wound
    /// as the polygon is. A simple polygon of n corners gives n - 2 triangles that use its corners and no others.
    pub(super) fn cut(&mut self, corners: &[Vec3], out: &mut Vec<[u32; 3]>) -> Verdict {
        let n = loop_period(corners);
        let corners = &corners[..n];
        if n < 3 || !self.project(corners) {
            return Verdict::Degenerate;
        }
        if is_strictly_convex(&self.points) {
            out.extend((1..n as u32 - 1).map(|i| [0, i, i + 1]));
            return Verdict::Covered;
        }
        self.budget += STEPS_PER_CORNER * n as u64;
        if self.clip_ears(out) { Verdict::Covered } else { Verdict::Crossing }
    }

    /// Fills `points` with the polygon as seen along the dominant axis of its normal, counter-clockwise; false where
    /// all corners lie on a line.
    fn project(&mut self, corners: &[Vec3]) -> bool {
        let Some(normal) = plane_normal(corners) else { return false };
        let size = normal.map(f64::abs);
        let axis = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if normal[axis] > 0.0 { (u, v) } else { (v, u) };
        self.points.clear();
        self.points.extend(corners.iter().map(|p| [f64::from(p[u]), f64::from(p[v])]));
        true
    }

    /// Clips ears off `points`; false where some had to be forced.
    fn clip_ears(&mut self, out: &mut Vec<[u32; 3]>) -> bool {
        let n = self.points.len() as u32;
        self.next.clear();
        self.next.extend((1..n).chain([0]));
        self.prev.clear();
        self.prev.extend([n - 1].into_iter().chain(0..n - 1));

        let (mut rest, mut b, mut rule, mut misses, mut simple) = (n, 0u32, Rule::Clear, 0, true);
        while rest >= 3 {
            if self.budget == 0 {
                self.fan_of_rest(b, out);
                return false;
            }
            let (a, c) = (self.prev[b as usize], self.next[b as usize]);
            if self.is_ear(a, b, c, rule) {
                // One that is flat as seen along the axis may still have area where the polygon is not planar.
                out.push([a, b, c]);
                simple &= rule <= Rule::Touching || self.side(a, b, c) == 0.0;
                self.next[a as usize] = c;
                self.prev[c as usize] = a;
                rest -= 1;
                (rule, misses) = (Rule::Clear, 0);
                // Passing over one corner leaves fewer slivers than clipping round one.
                b = self.next[c as usize];
            } else {
                b = c;
                misses += 1;
                if misses == rest {
                    misses = 0;
                    rule = match rule {
                        Rule::Clear => Rule::Touching,
                        Rule::Touching => Rule::Convex,
                        Rule::Convex | Rule::Any => Rule::Any,
                    };
                }
            }
        }
        simple
    }

    fn fan_of_rest(&self, apex: u32, out: &mut Vec<[u32; 3]>) {
        let mut b = self.next[apex as usize];
        loop {
            let c = self.next[b as usize];
            if c == apex {
                return;
            }
            out.push([apex, b, c]);
            b = c;
        }
    }

    /// Whether the triangle at corner `b` can be cut off under `rule`.
    fn is_ear(&mut self, a: u32, b: u32, c: u32, rule: Rule) -> bool {
        self.budget = self.budget.saturating_sub(1);
        if rule == Rule::Any {
            return true;
        }
        if !(self.side(a, b, c) > 0.0) {
            return false;
        }
        if rule == Rule::Convex {
            return true;
        }
        let [pa, pb, pc] = [a, b, c].map(|i| self.points[i as usize]);
        let low = [pa[0].min(pb[0]).min(pc[0]), pa[1].min(pb[1]).min(pc[1])];
        let high = [pa[0].max(pb[0]).max(pc[0]), pa[1].max(pb[1]).max(pc[1])];
        let mut steps = 0;
        let mut q = self.next[c as usize];
        let mut clear = true;
        while q != a {
            steps += 1;
            let p = self.points[q as usize];
            let inside_box = p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1];
            if inside_box && self.blocks(q, [a, b, c], rule) {
                clear = false;
                break;
            }
            q = self.next[q as usize];
        }
        self.budget = self.budget.saturating_sub(steps);
        clear
    }

    /// Whether corner `q` keeps the triangle `t` (counter-clockwise) from being an ear.
    fn blocks(&self, q: u32, t: [u32; 3], rule: Rule) -> bool {
        let p = self.points[q as usize];
        if let Some(i) = (0..3).find(|&i| self.points[t[i] as usize] == p) {
            // The outline passes through this corner once more (a hole joined by a bridge): what matters is whether
            // it goes on into the triangle there.
            let (from, to) = (t[(i + 2) % 3], t[(i + 1) % 3]);
            return [self.prev[q as usize], self.next[q as usize]]
                .into_iter()
                .any(|r| self.side(q, to, r) > 0.0 && self.side(from, q, r) > 0.0);
        }
        let sides = [self.side(t[0], t[1], q), self.side(t[1], t[2], q), self.side(t[2], t[0], q)];
        if rule == Rule::Clear { sides.iter().all(|&s| s >= 0.0) } else { sides.iter().all(|&s| s > 0.0) }
    }

    /// Twice the signed area of corners a, b, c; differences and products of f32 coordinates are exact in f64, so the
    /// sign is right but for coordinates of very different size.
    fn side(&self, a: u32, b: u32, c: u32) -> f64 {
        side(self.points[a as usize], self.points[b as usize], self.points[c as usize])
    }
}

fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
}

/// Corners after which the outline only repeats itself (a loop listed several times counts once).
fn loop_period(corners: &[Vec3]) -> usize {
    let n = corners.len();
    let Some(p) = (1..n).find(|&i| corners[i] == corners[0]) else { return n };
    let repeats = n.is_multiple_of(p) && (p..n).all(|i| corners[i] == corners[i - p]);
    if repeats { p } else { n }
}

/// All left turns, and once round: the polygon is convex and no three neighbours lie on a line.
fn is_strictly_convex(points: &[[f64; 2]]) -> bool {
    let n = points.len();
    let mut reversals = 0;
    let mut before = points[0][0] - points[n - 1][0];
    for i in 0..n {
        let (a, b, c) = (points[i], points[(i + 1) % n], points[(i + 2) % n]);
        if !(side(a, b, c) > 0.0) {
            return false;
        }
        let dx = b[0] - a[0];
        if dx != 0.0 {
            reversals += u32::from((dx > 0.0) != (before > 0.0) && before != 0.0);
            before = dx;
        }
    }
    reversals <= 2
}

/// Normal of the polygon by Newell's method, or of the plane through three far corners where the signed areas cancel
/// (a bow tie); none where all corners lie on a line.
fn plane_normal(corners: &[Vec3]) -> Option<[f64; 3]> {
    let origin = corners[0];
    let at = |i: usize| -> [f64; 3] {
        let p = corners[i];
        [0, 1, 2].map(|k| f64::from(p[k]) - f64::from(origin[k]))
    };
    let length_sq = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let mut normal = [0.0; 3];
    let mut largest = 0.0f64;
    for i in 1..corners.len() - 1 {
        let n = cross(at(i), at(i + 1));
        largest = largest.max(length_sq(n));
        for k in 0..3 {
            normal[k] += n[k];
        }
    }
    // Rounding of the sum stays far below this share of its largest term.
    if length_sq(normal) > largest * 1e-20 {
        return Some(normal);
    }
    let farthest = |score: &dyn Fn(usize) -> f64| {
        (1..corners.len()).map(|i| (score(i), i)).fold((0.0, 0), |best, s| if s.0 > best.0 { s } else { best })
    };
    let (_, far) = farthest(&|i| length_sq(at(i)));
    let (area_sq, wide) = farthest(&|i| length_sq(cross(at(far), at(i))));
    (area_sq > 0.0).then(|| cross(at(far), at(wide)))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
#[path = "polygon_tests.rs"]
mod tests;
