//! The memory of a wide tree: nodes of eight boxes, blocks of eight triangles, words that refer to children.

use photinus_geometry::Aabb;

/// Children of a node and triangles of a block.
pub const WIDTH: usize = 8;

/// What a child is: an interior node, a leaf of triangle blocks, or a leaf of primitive ids.
///
/// Bit 31 marks leaves, bit 30 those of ids; a leaf holds its length less one in bits 28 and 29. The other bits are an
/// index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Child(pub u32);

/// Longest leaf, in blocks or in ids.
pub const MAX_LEAF: usize = 4;

/// Indices of children are below this.
pub const MAX_INDEX: usize = 1 << 28;

impl Child {
    const LEAF: u32 = 1 << 31;
    const IDS: u32 = 1 << 30;
    const LENGTH_SHIFT: u32 = 28;

    /// The node of index `index`.
    pub fn node(index: usize) -> Self {
        debug_assert!(index < MAX_INDEX);
        Self(index as u32)
    }

    /// The `length` triangle blocks from `first`.
    pub fn blocks(first: usize, length: usize) -> Self {
        debug_assert!(first + length <= MAX_INDEX && (1..=MAX_LEAF).contains(&length));
        Self(Self::LEAF | ((length - 1) as u32) << Self::LENGTH_SHIFT | first as u32)
    }

    /// The `length` primitive ids from `first`.
    pub fn ids(first: usize, length: usize) -> Self {
        Self(Self::blocks(first, length).0 | Self::IDS)
    }

    /// Whether the child is a leaf of either kind.
    #[inline]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// Whether a leaf is one of ids.
    #[inline]
    pub fn is_ids(self) -> bool {
        self.0 & Self::IDS != 0
    }

    /// Index of the node, or of the first block or id.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize & (MAX_INDEX - 1)
    }

    /// Blocks or ids of a leaf.
    #[inline]
    pub fn range(self) -> std::ops::Range<usize> {
        let first = self.index();
        first..first + 1 + (self.0 >> Self::LENGTH_SHIFT & 3) as usize
    }
}

/// A node: the boxes of up to eight children, by axis, and what they are. Four cache lines.
///
/// Slots without a child hold the empty box, which no ray hits, and refer to block 0, which no ray hits either.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Node {
    /// Lower x, upper x, lower y, upper y, lower z, upper z.
    pub bounds: [[f32; WIDTH]; 6],
    /// What the boxes hold.
    pub children: [Child; WIDTH],
    /// How many of the slots are used: the first ones.
    pub len: u32,
    padding: [u32; 7],
}

impl Node {
    /// A node without children.
    pub fn empty() -> Self {
        let (low, high) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Self {
            bounds: [low, high, low, high, low, high],
            children: [Child::blocks(0, 1); WIDTH],
            len: 0,
            padding: [0; 7],
        }
    }

    /// Fills the next slot.
    pub fn push(&mut self, b: &Aabb, child: Child) {
        let slot = self.len as usize;
        for axis in 0..3 {
            self.bounds[2 * axis][slot] = b.min[axis];
            self.bounds[2 * axis + 1][slot] = b.max[axis];
        }
        self.children[slot] = child;
        self.len += 1;
    }

    /// The box of a slot.
    pub fn child_bounds(&self, slot: usize) -> Aabb {
        let corner = |o: usize| std::array::from_fn(|axis| self.bounds[2 * axis + o][slot]);
        Aabb { min: <[f32; 3]>::into(corner(0)), max: <[f32; 3]>::into(corner(1)) }
    }
}

/// Eight triangles by vertex and axis, with their ids. Five cache lines.
///
/// Lanes without a triangle hold NaN, which no ray hits.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct TriangleBlock {
    /// `vertices[3 * vertex + axis][lane]`.
    pub vertices: [[f32; WIDTH]; 9],
    /// Primitive ids, ascending; [`photinus_geometry::NO_HIT`] in unused lanes, which are the last.
    pub ids: [u32; WIDTH],
}

impl TriangleBlock {
    /// A block without triangles.
    pub fn empty() -> Self {
        Self { vertices: [[f32::NAN; WIDTH]; 9], ids: [photinus_geometry::NO_HIT; WIDTH] }
    }

    /// Triangles in the block.
    pub fn len(&self) -> usize {
        self.ids.iter().filter(|id| **id != photinus_geometry::NO_HIT).count()
    }

    /// The vertices of one lane.
    #[inline]
    pub fn triangle(&self, lane: usize) -> [[f32; 3]; 3] {
        std::array::from_fn(|v| std::array::from_fn(|axis| self.vertices[3 * v + axis][lane]))
    }
}

const _: () = assert!(size_of::<Node>() == 256 && size_of::<TriangleBlock>() == 320);
