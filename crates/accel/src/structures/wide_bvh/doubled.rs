//! Triangles of a block that lie on others: models draw both sides of a sheet as two triangles, or one twice.
//!
//! Where two triangles have the same vertices and the first of each is the same, either way round, all that
//! [`photinus_intersect::methods::woop::finish`] computes is the same but for signs: parameters are the same to the bit, and the
//! lower id is the hit. So the other need not be there.

use super::layout::{TriangleBlock, WIDTH};

/// Takes out the vertices of triangles that lie on one of a lower id; their ids stay, as what no ray hits.
pub fn hide_doubled(block: &mut TriangleBlock) {
    let same = |block: &TriangleBlock, [a, b]: [usize; 2], [i, j]: [usize; 2]| {
        (0..3).all(|axis| block.vertices[3 * i + axis][a] == block.vertices[3 * j + axis][b])
    };
    for lane in (1..WIDTH).rev() {
        let first = block.vertices[0];
        // One comparison of all lanes tells most apart.
        let alike = first.iter().enumerate().fold(0u32, |mask, (k, x)| mask | u32::from(*x == first[lane]) << k);
        let mut alike = alike & ((1 << lane) - 1);
        while alike != 0 {
            let lanes = [lane, alike.trailing_zeros() as usize];
            let vertices = |i, j| same(block, lanes, [1, i]) && same(block, lanes, [2, j]);
            if same(block, lanes, [0, 0]) && (vertices(1, 2) || vertices(2, 1)) {
                block.vertices.iter_mut().for_each(|row| row[lane] = f32::NAN);
                break;
            }
            alike &= alike - 1;
        }
    }
}
