//! Where large data lies in memory.

mod huge_array;

pub use huge_array::HugeArray;
