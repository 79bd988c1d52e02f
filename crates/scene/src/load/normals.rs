//! Shading normals made from faces: angle-weighted means, over all faces at a vertex or up to creases.

use super::weld::weld;
use crate::Mesh;
use photinus_geometry::Vec3;

/// Gives every vertex the mean of its faces' normals, weighted by the angle at the vertex (Thürmer and Wüthrich,
/// "Computing vertex normals from polygonal facets", JGT 3(1), 1998).
///
/// `points` names the surface point of each vertex: vertices with the same number get the same normal. Empty: each
/// vertex is its own point. Points of degenerate faces only get +z.
pub fn smooth_normals(mesh: &mut Mesh, points: &[u32]) {
    let vertices = 0..mesh.positions.len() as u32;
    let point_of = |v: u32| if points.is_empty() { v as usize } else { points[v as usize] as usize };
    let count = vertices.clone().map(|v| point_of(v) + 1).max().unwrap_or(0);
    let mut sums = vec![[0.0; 3]; count];
    for t in &mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize]);
        if let Some(n) = face_normal(p) {
            for k in 0..3 {
                add_weighted(&mut sums[point_of(t[k])], n, corner_angle(p, k));
            }
        }
    }
    mesh.normals = vertices.map(|v| unit(sums[point_of(v)]).unwrap_or(Vec3::Z)).collect();
}

/// Replaces the normals by smooth ones that stop at creases: edges whose faces' normals differ by more than
/// `max_angle_degrees`. Vertices on creases are split; vertices at equal positions count as one.
pub fn creased_normals(mesh: &mut Mesh, max_angle_degrees: f32) {
    let cosine = libm::cosf(max_angle_degrees.clamp(0.0, 180.0).to_radians());
    let points = weld(&mesh.positions);
    let welded: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|v| points.ids[v as usize])).collect();
    let corners = corner_normals(&points.positions, &welded, |_, _, cos_between| cos_between >= cosine);
    split_by_corner(mesh, &corners);
}

/// Scales the normals to unit length (those that have it keep their bits), gives those without a direction the mean of
/// their faces' and returns how many those were.
pub(super) fn repair_normals(mesh: &mut Mesh) -> usize {
    let mut bad = 0;
    for n in &mut mesh.normals {
        if (n.length_squared() - 1.0).abs() < 1e-6 {
            continue;
        }
        let given = n.to_array().map(f64::from);
        *n = if n.is_finite() { unit(given).unwrap_or(Vec3::ZERO) } else { Vec3::ZERO };
        bad += usize::from(*n == Vec3::ZERO);
    }
    if bad > 0 {
        let given = std::mem::take(&mut mesh.normals);
        smooth_normals(mesh, &[]);
        for (made, given) in mesh.normals.iter_mut().zip(given) {
            if given != Vec3::ZERO {
                *made = given;
            }
        }
    }
    bad
}

/// Normals of the three corners of every triangle, some of them shared.
pub(super) struct CornerNormals {
    /// For every corner (triangle after triangle) the number of its normal.
    pub(super) ids: Vec<u32>,
    /// The normals.
    pub(super) normals: Vec<Vec3>,
}

/// Averages the normals of faces that `smooth(face, face, cosine between their normals)` joins across a common edge.
///
/// Faces that meet in one vertex but are not joined, directly or through faces between them, keep normals of their
/// own. Degenerate faces join nothing; their corners get +z.
pub(super) fn corner_normals(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    smooth: impl Fn(usize, usize, f32) -> bool,
) -> CornerNormals {
    let faces: Vec<Option<Vec3>> = triangles.iter().map(|t| face_normal(t.map(|v| positions[v as usize]))).collect();

    // Sorted by end points, then by face: faces at one edge are neighbours, in an order that is always the same.
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(triangles.len() * 3);
    for (f, t) in triangles.iter().enumerate() {
        if faces[f].is_some() {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                edges.push((a.min(b), a.max(b), (f * 3 + k) as u32));
            }
        }
    }
    edges.sort_unstable();

    let mut groups = Groups((0..triangles.len() as u32 * 3).collect());
    for pair in edges.windows(2) {
        let ((a, b, c0), (a1, b1, c1)) = (pair[0], pair[1]);
        let (f0, f1) = (c0 as usize / 3, c1 as usize / 3);
        if (a, b) != (a1, b1) || f0 == f1 {
            continue;
        }
        if let (Some(n0), Some(n1)) = (faces[f0], faces[f1])
            && smooth(f0, f1, n0.dot(n1))
        {
            for v in [a, b] {
                groups.join(corner_at(triangles, c0, v), corner_at(triangles, c1, v));
            }
        }
    }

    let mut sums = vec![[0.0; 3]; triangles.len() * 3];
    for (f, t) in triangles.iter().enumerate() {
        if let Some(n) = faces[f] {
            let p = t.map(|v| positions[v as usize]);
            for k in 0..3 {
                add_weighted(&mut sums[groups.find((f * 3 + k) as u32) as usize], n, corner_angle(p, k));
            }
        }
    }

    let mut number = vec![u32::MAX; triangles.len() * 3];
    let mut normals = Vec::new();
    let ids = (0..triangles.len() as u32 * 3)
        .map(|c| {
            let root = groups.find(c) as usize;
            if number[root] == u32::MAX {
                number[root] = normals.len() as u32;
                // Opposite faces may cancel: then the face's own normal is as good as any.
                normals.push(unit(sums[root]).or(faces[c as usize / 3]).unwrap_or(Vec3::Z));
            }
            number[root]
        })
        .collect();
    CornerNormals { ids, normals }
}

/// Gives the mesh a vertex for every pair of old vertex and normal.
fn split_by_corner(mesh: &mut Mesh, corners: &CornerNormals) {
    let old = std::mem::take(mesh);
    let mut order: Vec<(u32, u32, u32)> = Vec::with_capacity(corners.ids.len());
    for (c, v) in old.triangles.iter().flatten().enumerate() {
        order.push((*v, corners.ids[c], c as u32));
    }
    order.sort_unstable();
    mesh.triangles = vec![[0; 3]; old.triangles.len()];
    let mut before = None;
    for (v, n, c) in order {
        if before != Some((v, n)) {
            before = Some((v, n));
            let v = v as usize;
            mesh.positions.push(old.positions[v]);
            mesh.normals.push(corners.normals[n as usize]);
            mesh.uvs.extend(old.uvs.get(v));
            mesh.colors.extend(old.colors.get(v));
        }
        mesh.triangles[c as usize / 3][c as usize % 3] = (mesh.positions.len() - 1) as u32;
    }
}

/// The corner of the same face as `corner` that is at `vertex`, or `corner` itself.
fn corner_at(triangles: &[[u32; 3]], corner: u32, vertex: u32) -> u32 {
    let face = corner as usize / 3;
    triangles[face].iter().position(|&v| v == vertex).map_or(corner, |k| (face * 3 + k) as u32)
}

/// Disjoint sets of corners; the root is the lowest member.
struct Groups(Vec<u32>);

impl Groups {
    fn find(&mut self, mut c: u32) -> u32 {
        while self.0[c as usize] != c {
            let parent = self.0[c as usize];
            self.0[c as usize] = self.0[parent as usize];
            c = parent;
        }
        c
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// Unit normal of a triangle; none where it has no area. In f64, where squares of f32 lengths neither overflow nor
/// vanish.
pub fn face_normal(p: [Vec3; 3]) -> Option<Vec3> {
    let (a, b) = (minus(p[1], p[0]), minus(p[2], p[0]));
    unit([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

/// Angle of triangle `p` at corner `k`, radians; 0 where an edge has no length.
fn corner_angle(p: [Vec3; 3], k: usize) -> f32 {
    let (a, b) = (minus(p[(k + 1) % 3], p[k]), minus(p[(k + 2) % 3], p[k]));
    let scale = (dot(a, a) * dot(b, b)).sqrt();
    if scale > 0.0 { libm::acosf((dot(a, b) / scale).clamp(-1.0, 1.0) as f32) } else { 0.0 }
}

fn add_weighted(sum: &mut [f64; 3], n: Vec3, weight: f32) {
    for k in 0..3 {
        sum[k] += f64::from(n[k]) * f64::from(weight);
    }
}

fn unit(v: [f64; 3]) -> Option<Vec3> {
    let length = dot(v, v).sqrt();
    (length > 1e-150).then(|| Vec3::from_array(v.map(|x| (x / length) as f32)))
}

fn minus(a: Vec3, b: Vec3) -> [f64; 3] {
    [0, 1, 2].map(|k| f64::from(a[k]) - f64::from(b[k]))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec2;

    /// A box of 8 vertices, wound outwards.
    fn cube() -> Mesh {
        let positions = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }

    #[test]
    fn corners_of_a_cube_point_along_its_diagonals() {
        // Weighting by angle makes the split of its faces into triangles invisible.
        let mut mesh = cube();
        smooth_normals(&mut mesh, &[]);
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let diagonal = (*p - 0.5).normalize();
            assert!((*n - diagonal).length() < 1e-6, "{p}: {n}");
        }
    }

    #[test]
    fn creases_keep_the_faces_of_a_cube_flat() {
        let mut mesh = cube();
        mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(p.x, p.y)).collect();
        let before = mesh.clone();
        creased_normals(&mut mesh, 30.0);
        assert_eq!((mesh.positions.len(), mesh.normals.len(), mesh.uvs.len()), (24, 24, 24));
        for (t, old) in mesh.triangles.iter().zip(&before.triangles) {
            let face = face_normal(t.map(|v| mesh.positions[v as usize])).unwrap();
            for k in 0..3 {
                assert_eq!(mesh.positions[t[k] as usize], before.positions[old[k] as usize]);
                assert_eq!(mesh.uvs[t[k] as usize], before.uvs[old[k] as usize]);
                assert!((mesh.normals[t[k] as usize] - face).length() < 1e-6);
            }
        }
        let mut smooth = cube();
        creased_normals(&mut smooth, 100.0);
        smooth_normals(&mut mesh, &[]);
        assert_eq!(smooth.positions.len(), 8);
        assert!((smooth.normals[0] + Vec3::ONE.normalize()).length() < 1e-6);
    }

    #[test]
    fn a_seam_of_equal_positions_is_smoothed_over() {
        let fold = |y: f32| [Vec3::new(0., 0., 0.), Vec3::new(0., 0., 1.), Vec3::new(1., y, 0.)];
        let mut mesh = Mesh::default();
        for p in [fold(0.2), [fold(0.2)[0], Vec3::new(-1., 0.2, 0.), fold(0.2)[1]]] {
            let base = mesh.positions.len() as u32;
            mesh.positions.extend(p);
            mesh.triangles.push([base, base + 1, base + 2]);
        }
        creased_normals(&mut mesh, 45.0);
        let at_seam: Vec<_> =
            mesh.positions.iter().zip(&mesh.normals).filter(|(p, _)| **p == Vec3::ZERO).map(|(_, n)| *n).collect();
        assert_eq!(at_seam.len(), 2);
        assert!(at_seam.iter().all(|n| (*n - Vec3::Y).length() < 1e-6), "{at_seam:?}");
    }

    #[test]
    fn degenerate_faces_and_extreme_sizes_give_unit_normals() {
        for size in [1e-30f32, 1.0, 1e30] {
            let mut mesh = cube();
            mesh.positions.iter_mut().for_each(|p| *p *= size);
            mesh.triangles.extend([[0, 0, 1], [3, 3, 3], [0, 1, 1]]);
            mesh.positions.push(Vec3::ONE);
            let mut creased = mesh.clone();
            smooth_normals(&mut mesh, &[]);
            creased_normals(&mut creased, 20.0);
            for n in mesh.normals.iter().chain(&creased.normals) {
                assert!((n.length() - 1.0).abs() < 1e-5, "{size}: {n}");
            }
            assert_eq!(creased.triangles.len(), mesh.triangles.len());
        }
    }
}
