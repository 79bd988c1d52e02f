//! A sphere as triangles, for engines without exact spheres: an icosahedron, each triangle cut in four again and again.

use super::ply::Triangles;
use super::scene::Triple;
use std::collections::BTreeMap;

/// The unit sphere in 20 * 4^levels triangles that face outwards; the vertices are the normals too.
pub fn unit(levels: u32) -> Triangles {
    let phi = 0.5 * (1.0 + 5f64.sqrt());
    let corners = [
        [-1.0, phi, 0.0],
        [1.0, phi, 0.0],
        [-1.0, -phi, 0.0],
        [1.0, -phi, 0.0],
        [0.0, -1.0, phi],
        [0.0, 1.0, phi],
        [0.0, -1.0, -phi],
        [0.0, 1.0, -phi],
        [phi, 0.0, -1.0],
        [phi, 0.0, 1.0],
        [-phi, 0.0, -1.0],
        [-phi, 0.0, 1.0],
    ];
    let mut points: Vec<[f64; 3]> = corners.map(normalised).to_vec();
    // Around corner 0, their neighbours, around corner 3, and the belt between.
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(i, j)| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    let (p, q) = (points[i as usize], points[j as usize]);
                    points.push(normalised([p[0] + q[0], p[1] + q[1], p[2] + q[2]]));
                    points.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let vertices: Vec<Triple> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    (vertices, triangles)
}

fn normalised(p: [f64; 3]) -> [f64; 3] {
    let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
    p.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::unit;

    #[test]
    fn the_sphere_is_closed_round_and_faces_outwards() {
        let (points, triangles) = unit(3);
        assert_eq!((points.len(), triangles.len()), (642, 1280));
        let mut volume = 0.0;
        for triangle in &triangles {
            let [a, b, c] = triangle.map(|i| points[i as usize].map(f64::from));
            let part = a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            assert!(part > 0.0, "a face turned inwards");
            volume += part / 6.0;
        }
        // Inscribed: below 4/3 pi = 4.18879, by a share that falls fourfold with each level.
        assert!((4.15..4.18879).contains(&volume), "{volume}");
    }
}
