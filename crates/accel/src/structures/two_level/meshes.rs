//! Which primitives hang together: triangles that share vertices, directly or by others.

use crate::hierarchy::refs::BuildRef;
use photinus_geometry::Primitives;

/// Sets of vertices, each a tree of indices that ends in one that is its own.
struct Sets(Vec<u32>);

impl Sets {
    fn root(&mut self, mut v: u32) -> u32 {
        while self.0[v as usize] != v {
            // Every step halves the way that the next search takes.
            let up = self.0[self.0[v as usize] as usize];
            self.0[v as usize] = up;
            v = up;
        }
        v
    }

    /// Joins two sets under the lower root, so that the result does not depend on the order.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// The references by mesh: meshes in the order of their first primitives, primitives in the order of their ids.
pub(super) fn group(primitives: &Primitives, refs: Vec<BuildRef>) -> Vec<Vec<BuildRef>> {
    let mut sets = Sets((0..primitives.positions.len() as u32).collect());
    for [a, b, c] in &primitives.triangles {
        sets.join(*a, *b);
        sets.join(*a, *c);
    }
    const NONE: u32 = u32::MAX;
    let mut mesh_of_root = vec![NONE; primitives.positions.len()];
    let mut out: Vec<Vec<BuildRef>> = Vec::new();
    for r in refs {
        let Some(triangle) = primitives.triangles.get(r.id as usize) else {
            out.push(vec![r]);
            continue;
        };
        let mesh = &mut mesh_of_root[sets.root(triangle[0]) as usize];
        if *mesh == NONE {
            *mesh = out.len() as u32;
            out.push(Vec::new());
        }
        out[*mesh as usize].push(r);
    }
    out
}
