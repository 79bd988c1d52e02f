//! A kd-tree as a picture, after Figure 11 of the thesis: split planes across x red, across y green, across z blue,
//! leaves white, seen from any direction.

use photinus_accel::LeafRange;
use photinus_accel::structures::kd_tree::{KdCell, KdCellKind, KdTree};
use photinus_geometry::{Aabb, Vec3};
use std::collections::HashSet;
use std::fmt::Write;

/// From where, how large and how much of a tree is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeView {
    /// Where the viewer looks, in scene coordinates; of any length. Parallel lines stay parallel.
    pub direction: Vec3,
    /// What points up in the picture; replaced where it is parallel to the direction.
    pub up: Vec3,
    /// The part of the scene that fills the picture; none: all of it. What does not reach into it is left out.
    pub frame: Option<Aabb>,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Splits and leaves more levels below the root than this are left out.
    pub max_depth: u32,
    /// At most so many lines are drawn, of splits and of leaves those of the upper levels.
    pub max_lines: usize,
}

impl Default for TreeView {
    fn default() -> Self {
        Self {
            direction: Vec3::new(-0.55, -0.45, -0.7),
            up: Vec3::Y,
            frame: None,
            width: 1280,
            height: 960,
            max_depth: u32::MAX,
            max_lines: 200_000,
        }
    }
}

/// What a line belongs to: the axis of a split, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ink {
    /// A leaf with primitives: white.
    Leaf,
    /// A plane across x: red.
    SplitX,
    /// A plane across y: green.
    SplitY,
    /// A plane across z: blue.
    SplitZ,
}

impl Ink {
    const SPLITS: [Self; 3] = [Self::SplitX, Self::SplitY, Self::SplitZ];

    /// The colour, sRGB.
    pub fn rgb(self) -> [u8; 3] {
        match self {
            Self::Leaf => [255, 255, 255],
            Self::SplitX => [255, 64, 64],
            Self::SplitY => [64, 220, 80],
            Self::SplitZ => [80, 120, 255],
        }
    }
}

/// A line in pixels from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// One end.
    pub from: [f32; 2],
    /// The other.
    pub to: [f32; 2],
    /// What it belongs to.
    pub ink: Ink,
    /// Levels of that below the root.
    pub depth: u32,
}

/// A drawn tree.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeDrawing {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The lines, in the order in which they are painted: deep splits, leaves, splits of the upper levels; each
    /// from the deepest up.
    pub lines: Vec<Line>,
    /// Whether lines were left out because there were too many.
    pub cut: bool,
}

/// Margin around the tree, as a part of the picture's smaller side.
const MARGIN: f32 = 0.04;

/// Splits of so many levels are painted over the leaves; those below would hide every leaf, whose edges they share.
const UPPER_LEVELS: u32 = 6;

/// Draws a tree: the outline of every split plane within its cell, and the edges of every leaf that holds primitives.
/// Lines that fall together in the picture are drawn once. A tree without primitives gives no line.
pub fn draw_kd_tree(tree: &KdTree, view: &TreeView) -> TreeDrawing {
    let mut drawing = TreeDrawing { width: view.width, height: view.height, lines: Vec::new(), cut: false };
    let frame = view.frame.unwrap_or(tree.bounds());
    let Some(projection) = Projection::new(&frame, view) else { return drawing };
    let mut lines = Vec::new();
    tree.visit_cells(|cell| {
        let within = cell.bounds.min.cmple(frame.max).all() && cell.bounds.max.cmpge(frame.min).all();
        if cell.depth <= view.max_depth && within {
            cell_lines(cell, |ink, a, b| {
                lines.push(Line { from: projection.point(a), to: projection.point(b), ink, depth: cell.depth });
            });
        }
    });
    // Of lines that fall together the uppermost is kept; so is the order of the tree, which nothing else depends on.
    lines.sort_by_key(|line| line.depth);
    let mut seen = HashSet::new();
    lines.retain(|line| {
        let [a, b] = [line.from, line.to].map(|p| p.map(|x| (x * 4.0).round() as i32));
        a != b && seen.insert((a.min(b), a.max(b), line.ink))
    });
    let (mut leaves, mut splits): (Vec<_>, Vec<_>) = lines.into_iter().partition(|line| line.ink == Ink::Leaf);
    // Leaves lie deep: they keep at least half of the lines.
    let half = view.max_lines / 2;
    let split_count = splits.len().min((view.max_lines - half).max(view.max_lines.saturating_sub(leaves.len())));
    let leaf_count = leaves.len().min(view.max_lines - split_count);
    drawing.cut = split_count < splits.len() || leaf_count < leaves.len();
    splits.truncate(split_count);
    leaves.truncate(leaf_count);
    let upper = splits.partition_point(|line| line.depth < UPPER_LEVELS);
    let lower = splits.split_off(upper);
    drawing.lines = [lower, leaves, splits].into_iter().flat_map(|part| part.into_iter().rev()).collect();
    drawing
}

/// Hands out the lines of one cell.
fn cell_lines(cell: &KdCell, mut line: impl FnMut(Ink, Vec3, Vec3)) {
    let Aabb { min, max } = cell.bounds;
    match cell.kind {
        KdCellKind::Leaf(LeafRange { count: 0, .. }) => {}
        KdCellKind::Leaf(_) => {
            for axis in 0..3 {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                for (pu, pv) in [(min[u], min[v]), (max[u], min[v]), (min[u], max[v]), (max[u], max[v])] {
                    let (mut a, mut b) = (min, max);
                    (a[u], a[v], b[u], b[v]) = (pu, pv, pu, pv);
                    line(Ink::Leaf, a, b);
                }
            }
        }
        KdCellKind::Interior { axis, position } => {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |pu: f32, pv: f32| {
                let mut p = min;
                (p[axis], p[u], p[v]) = (position, pu, pv);
                p
            };
            let corners =
                [corner(min[u], min[v]), corner(max[u], min[v]), corner(max[u], max[v]), corner(min[u], max[v])];
            for i in 0..4 {
                line(Ink::SPLITS[axis], corners[i], corners[(i + 1) % 4]);
            }
        }
    }
}

/// From the scene to the picture, along parallels.
struct Projection {
    right: Vec3,
    down: Vec3,
    center: Vec3,
    scale: f32,
    middle: [f32; 2],
}

impl Projection {
    /// Fits the bounds into the picture; `None` where there are no bounds, or none that are finite.
    fn new(bounds: &Aabb, view: &TreeView) -> Option<Self> {
        if bounds.is_empty() || !bounds.size().is_finite() || view.width == 0 || view.height == 0 {
            return None;
        }
        let forward = view.direction.try_normalize().unwrap_or(-Vec3::Z);
        let right = [view.up, Vec3::Z, Vec3::X]
            .into_iter()
            .map(|up| forward.cross(up.normalize_or_zero()))
            .find(|side| side.length_squared() > 1e-6)?
            .normalize();
        let down = forward.cross(right);
        let size = bounds.size();
        // What the box spans along a direction of the picture.
        let span = |d: Vec3| d.abs().dot(size).max(f32::MIN_POSITIVE);
        let (width, height) = (view.width as f32, view.height as f32);
        let inner = 1.0 - 2.0 * MARGIN;
        let scale = (inner * width / span(right)).min(inner * height / span(down));
        let center = bounds.min * 0.5 + bounds.max * 0.5;
        Some(Self { right, down, center, scale, middle: [width * 0.5, height * 0.5] })
    }

    fn point(&self, p: Vec3) -> [f32; 2] {
        let p = p - self.center;
        [self.middle[0] + p.dot(self.right) * self.scale, self.middle[1] + p.dot(self.down) * self.scale]
    }
}

impl Line {
    /// How much of the ground a line covers: leaves are faint, and so are deep splits, of which there are many.
    fn opacity(&self) -> f32 {
        match self.ink {
            Ink::Leaf => 0.28,
            _ => (1.0 - 0.04 * self.depth as f32).clamp(0.4, 1.0),
        }
    }

    /// Width in pixels.
    fn width(&self) -> f32 {
        if self.ink == Ink::Leaf { 0.7 } else { (2.2 - 0.15 * self.depth as f32).max(1.0) }
    }
}

impl TreeDrawing {
    /// The picture as the text of an SVG file.
    pub fn to_svg(&self) -> String {
        let (w, h) = (self.width, self.height);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"black\"/>\n<g fill=\"none\">\n"
        );
        let style = |line: &Line| (line.ink, line.opacity(), line.width());
        for group in self.lines.chunk_by(|a, b| style(a) == style(b)) {
            let (ink, opacity, width) = style(&group[0]);
            let [r, g, b] = ink.rgb();
            // Writing to a string cannot fail.
            let _ = write!(
                out,
                "<path stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-opacity=\"{opacity:.2}\" stroke-width=\"{width:.2}\" d=\""
            );
            for Line { from: [x0, y0], to: [x1, y1], .. } in group {
                let _ = write!(out, "M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}");
            }
            out.push_str("\"/>\n");
        }
        out.push_str("</g>\n</svg>\n");
        out
    }

    /// The picture as sRGB pixels, row by row from the top.
    pub fn to_pixels(&self) -> Vec<[u8; 3]> {
        let mut pixels = vec![[0.0; 3]; self.width as usize * self.height as usize];
        for line in &self.lines {
            self.paint(line, &mut pixels);
        }
        pixels.into_iter().map(|p| p.map(|x: f32| (x + 0.5) as u8)).collect()
    }

    /// Blends a line over the pixels, each by how near its middle is.
    fn paint(&self, line: &Line, pixels: &mut [[f32; 3]]) {
        let (width, height) = (self.width as i32, self.height as i32);
        let [dx, dy] = [line.to[0] - line.from[0], line.to[1] - line.from[1]];
        // One column, or one row, after the other along the longer side; `a` runs along it, `b` across.
        let steep = dy.abs() > dx.abs();
        let swap = |[x, y]: [f32; 2]| if steep { [y, x] } else { [x, y] };
        let (mut from, mut to) = (swap(line.from), swap(line.to));
        if from[0] > to[0] {
            std::mem::swap(&mut from, &mut to);
        }
        let slope = if to[0] > from[0] { (to[1] - from[1]) / (to[0] - from[0]) } else { 0.0 };
        let reach = 0.5 * line.width() * (1.0 + slope * slope).sqrt();
        let (a_end, b_end) = if steep { (height, width) } else { (width, height) };
        let ink = line.ink.rgb().map(f32::from);
        for a in (from[0].floor() as i32).max(0)..=(to[0].floor() as i32).min(a_end - 1) {
            // The part of this column that the line spans, and where it is there.
            let part = ((a + 1) as f32).min(to[0]) - (a as f32).max(from[0]);
            let middle = from[1] + slope * (a as f32 + 0.5 - from[0]);
            for b in ((middle - reach).floor() as i32).max(0)..=((middle + reach).floor() as i32).min(b_end - 1) {
                let covered = ((b + 1) as f32).min(middle + reach) - (b as f32).max(middle - reach);
                let alpha = covered.clamp(0.0, 1.0) * part.clamp(0.0, 1.0) * line.opacity();
                let (x, y) = if steep { (b, a) } else { (a, b) };
                let pixel = &mut pixels[(y * width + x) as usize];
                for (value, ink) in pixel.iter_mut().zip(ink) {
                    *value += (ink - *value) * alpha;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_accel::BuildOptions;
    use photinus_geometry::Primitives;

    /// Two small triangles at the ends of each axis: the tree cuts them apart.
    fn tree() -> KdTree {
        let mut primitives = Primitives::default();
        for axis in Vec3::AXES {
            for sign in [-1.0, 1.0] {
                let base = primitives.positions.len() as u32;
                let p = axis * sign;
                primitives.positions.extend([p, p + Vec3::splat(0.05), p + Vec3::new(0.05, -0.05, 0.0)]);
                primitives.triangles.push([base, base + 1, base + 2]);
            }
        }
        KdTree::new(&primitives, &BuildOptions { node_cost: 0.05, ..BuildOptions::default() }).unwrap()
    }

    #[test]
    fn splits_and_leaves_are_drawn_in_their_colours() {
        let drawing = draw_kd_tree(&tree(), &TreeView::default());
        assert!(!drawing.cut);
        for ink in [Ink::Leaf, Ink::SplitX, Ink::SplitY, Ink::SplitZ] {
            assert!(drawing.lines.iter().any(|l| l.ink == ink), "{ink:?}");
        }
        // Deep splits, leaves, upper splits; each part from the deepest up.
        let part = |l: &Line| if l.ink == Ink::Leaf { 1 } else { 2 * u32::from(l.depth < UPPER_LEVELS) };
        assert!(drawing.lines.is_sorted_by_key(|l| (part(l), u32::MAX - l.depth)));
        for end in drawing.lines.iter().flat_map(|l| [l.from, l.to]) {
            assert!(end[0] >= 0.0 && end[0] <= 1280.0 && end[1] >= 0.0 && end[1] <= 960.0, "{end:?}");
        }
        let pixels = drawing.to_pixels();
        assert_eq!(pixels.len(), 1280 * 960);
        let reddest = pixels.iter().max_by_key(|[r, g, b]| i32::from(*r) - i32::from(*g) - i32::from(*b)).unwrap();
        assert!(reddest[0] > 200 && reddest[1] < 80, "{reddest:?}");
    }

    #[test]
    fn seen_along_z_x_runs_to_the_right_and_y_up() {
        let view = TreeView { direction: -Vec3::Z, width: 400, height: 400, ..TreeView::default() };
        let tree = tree();
        let projection = Projection::new(&tree.bounds(), &view).unwrap();
        let [origin, x, y] = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| projection.point(p));
        assert!(x[0] > origin[0] + 100.0 && (x[1] - origin[1]).abs() < 1e-3);
        assert!(y[1] < origin[1] - 100.0 && (y[0] - origin[0]).abs() < 1e-3);
        // Planes across z are rectangles, planes across x stand upright.
        for line in &draw_kd_tree(&tree, &view).lines {
            assert!(line.ink != Ink::SplitX || (line.from[0] - line.to[0]).abs() < 1e-3, "{line:?}");
        }
    }

    #[test]
    fn any_view_and_any_tree_can_be_drawn() {
        let tree = tree();
        for direction in [Vec3::Y, -Vec3::Y, Vec3::ZERO, Vec3::NAN, Vec3::X * 1e-30] {
            let view = TreeView { direction, width: 64, height: 48, ..TreeView::default() };
            let drawing = draw_kd_tree(&tree, &view);
            assert!(!drawing.lines.is_empty(), "{direction}");
            assert!(drawing.to_pixels().iter().any(|p| *p != [0; 3]));
        }
        let empty = KdTree::new(&Primitives::default(), &BuildOptions::default()).unwrap();
        assert!(draw_kd_tree(&empty, &TreeView::default()).lines.is_empty());
        let nothing = draw_kd_tree(&tree, &TreeView { width: 0, ..TreeView::default() });
        assert!(nothing.lines.is_empty() && nothing.to_pixels().is_empty());
    }

    #[test]
    fn upper_levels_are_kept_where_lines_are_limited() {
        let tree = tree();
        let all = draw_kd_tree(&tree, &TreeView::default());
        let few = draw_kd_tree(&tree, &TreeView { max_lines: 10, ..TreeView::default() });
        assert!(few.cut && few.lines.len() == 10 && few.lines[5..].iter().all(|l| l.ink != Ink::Leaf && l.depth <= 1));
        let root = draw_kd_tree(&tree, &TreeView { max_depth: 0, ..TreeView::default() });
        assert!(root.lines.len() == 4 && all.lines.len() > 30);
    }

    #[test]
    fn the_svg_holds_every_line() {
        let drawing = draw_kd_tree(&tree(), &TreeView::default());
        let svg = drawing.to_svg();
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches('M').count(), drawing.lines.len());
        for color in ["#ffffff", "#ff4040", "#40dc50", "#5078ff"] {
            assert!(svg.contains(color), "{color}");
        }
    }
}
