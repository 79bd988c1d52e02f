//! What rays for which any hit will do learn from those before them in the batch: it only says where they look first, never
//! what they find.
//!
//! Two things. What is between a lamp and one place is often between it and the next (Haines and Greenberg, "The Light Buffer:
//! A Shadow-Testing Accelerator", 1986, remember it for each lamp): a ray begins at the leaf that ended another. And whether
//! shadows are sooner found from where a ray starts or from where it ends depends on what stands there, a lamp's shade or the
//! table's leg: a few rays of a batch look from the other end, and the end that took fewer nodes is taken.

use super::layout::Child;

/// Of so many rays one tries what the others do not.
const SCOUTS: usize = 8;
/// Trust in the last leaf that ended a ray, at most.
const MOST_TRUST: u32 = 16;
/// A hit saves about as much as so many tries cost.
const WORTH: u32 = 3;
/// Weight of a ray among those before it.
const WEIGHT: f32 = 1.0 / 16.0;

/// How a ray looks for a hit, and what that took.
#[derive(Clone, Copy)]
pub struct Way {
    /// Begins at the leaf that ended another ray.
    is_guess: bool,
    /// Goes from the end of the ray to its start.
    is_backward: bool,
    /// Nodes visited.
    pub nodes: u32,
}

/// What is known from rays before.
#[derive(Default)]
pub struct Lore {
    occluder: Option<Child>,
    trust: u32,
    /// Nodes that a ray takes that looks forward, and backward; 0 where none did.
    nodes: [f32; 2],
}

impl Way {
    /// Forward from the root.
    pub const PLAIN: Self = Self { is_guess: false, is_backward: false, nodes: 0 };

    /// What turns the octant of the ray into that whose order of children it follows.
    #[inline(always)]
    pub fn turn(self) -> usize {
        if self.is_backward { 7 } else { 0 }
    }
}

impl Lore {
    /// How the ray of this number in the batch looks.
    #[inline(always)]
    pub fn way(&self, ray: usize) -> Way {
        let is_guess = (self.trust > 0) | ray.is_multiple_of(SCOUTS);
        let is_scout = ray % SCOUTS == SCOUTS / 2;
        Way { is_guess: is_guess & !is_scout, is_backward: (self.nodes[1] < self.nodes[0]) ^ is_scout, nodes: 0 }
    }

    /// The leaf where such a ray begins, if not at the root.
    #[inline(always)]
    pub fn guess(&self, way: Way) -> Option<Child> {
        if way.is_guess { self.occluder } else { None }
    }

    /// Takes note of a leaf, a block of triangles where it is named.
    #[inline(always)]
    pub fn note_leaf(&mut self, way: &mut Way, block: Option<Child>, is_hit: bool) {
        if way.is_guess {
            self.trust = if is_hit { (self.trust + WORTH).min(MOST_TRUST) } else { self.trust.saturating_sub(1) };
            way.is_guess = false;
        }
        if is_hit && block.is_some() {
            self.occluder = block;
        }
    }

    /// Takes note of a ray that has ended. Those that a guess ended tell nothing of the ways.
    #[inline(always)]
    pub fn note_end(&mut self, way: Way) {
        let nodes = &mut self.nodes[usize::from(way.is_backward)];
        if way.nodes > 0 {
            let weight = if *nodes == 0.0 { 1.0 } else { WEIGHT };
            *nodes += (way.nodes as f32 - *nodes) * weight;
        }
    }
}
