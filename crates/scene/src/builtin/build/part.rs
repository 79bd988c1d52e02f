//! A piece of a surface with normals and texture coordinates at every vertex.

use super::Place;
use crate::Mesh;
use photinus_geometry::{Vec2, Vec3};
use std::collections::BTreeMap;

/// A mesh under construction; normals and texture coordinates are always complete.
#[derive(Clone, Debug, Default)]
pub struct Part {
    mesh: Mesh,
}

impl Part {
    /// Adds a vertex and gives its index.
    pub fn vertex(&mut self, position: Vec3, normal: Vec3, uv: [f32; 2]) -> u32 {
        self.mesh.positions.push(position);
        self.mesh.normals.push(normal);
        self.mesh.uvs.push(Vec2::from(uv));
        self.mesh.positions.len() as u32 - 1
    }

    /// Adds a triangle, counter-clockwise seen from outside.
    pub fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.mesh.triangles.push([a, b, c]);
    }

    /// Adds a flat quadrilateral, counter-clockwise seen from outside, with these texture coordinates.
    pub fn quad(&mut self, corners: [Vec3; 4], uvs: [[f32; 2]; 4]) {
        let [a, b, c, d] = corners;
        let n = (c - a).cross(d - b);
        let n = n / n.length();
        let v = [0, 1, 2, 3].map(|i| self.vertex(corners[i], n, uvs[i]));
        self.triangle(v[0], v[1], v[2]);
        self.triangle(v[0], v[2], v[3]);
    }

    /// Triangles so far.
    pub fn triangle_count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Position of a vertex.
    pub fn position(&self, vertex: u32) -> Vec3 {
        self.mesh.positions[vertex as usize]
    }

    /// Adds all of another part.
    pub fn add(&mut self, other: Part) {
        let base = self.mesh.positions.len() as u32;
        self.mesh.positions.extend(other.mesh.positions);
        self.mesh.normals.extend(other.mesh.normals);
        self.mesh.uvs.extend(other.mesh.uvs);
        self.mesh.triangles.extend(other.mesh.triangles.iter().map(|t| t.map(|v| v + base)));
    }

    /// The same with another part.
    pub fn and(mut self, other: Part) -> Self {
        self.add(other);
        self
    }

    /// The part at its place.
    pub fn placed(mut self, place: Place) -> Self {
        for p in &mut self.mesh.positions {
            *p = place.point(*p);
        }
        for n in &mut self.mesh.normals {
            *n = place.normal(*n);
        }
        if place.mirrors() {
            self.mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        self
    }

    /// The part with its texture coordinates multiplied.
    pub fn uv_scaled(mut self, u: f32, v: f32) -> Self {
        for uv in &mut self.mesh.uvs {
            *uv = Vec2::new(uv.x * u, uv.y * v);
        }
        self
    }

    /// The part bent by a function of its points, with fresh smooth normals.
    pub fn bent(mut self, f: impl Fn(Vec3) -> Vec3) -> Self {
        for p in &mut self.mesh.positions {
            *p = f(*p);
        }
        self.smoothed()
    }

    /// The part with the mean normal of the faces around each point, weighted by area; vertices at exactly the same
    /// place share it.
    pub fn smoothed(mut self) -> Self {
        let key = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
        let mut sums: BTreeMap<[u32; 3], Vec3> = BTreeMap::new();
        for t in &self.mesh.triangles {
            let [a, b, c] = t.map(|v| self.mesh.positions[v as usize]);
            let cross = (b - a).cross(c - a);
            for p in [a, b, c] {
                *sums.entry(key(p)).or_insert(Vec3::ZERO) += cross;
            }
        }
        for (p, n) in self.mesh.positions.iter().zip(&mut self.mesh.normals) {
            if let Some(&sum) = sums.get(&key(*p))
                && sum.length() > 0.0
            {
                *n = sum / sum.length();
            }
        }
        self
    }
}

impl From<Part> for Mesh {
    fn from(part: Part) -> Self {
        part.mesh
    }
}
