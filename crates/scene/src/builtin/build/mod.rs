//! Parts that built-in scenes are put together from.

pub mod bitmap;
mod book;
mod boxes;
mod curve;
mod dice;
mod drawing;
mod leaf;
mod paint;
mod part;
mod patch;
mod place;
mod revolve;
mod soft;
mod stage;
mod tube;

pub use book::book;
pub use boxes::{Faces, bevelled, cuboid, frame, standing};
pub use curve::{curve, profile};
pub use dice::{Dice, shares};
pub use drawing::Drawing;
pub use leaf::{LeafShape, blade, leaf, lily_pad, petal};
pub use paint::{Finish, linear};
pub use part::Part;
pub use patch::{Join, patch};
pub use place::{Place, sin_cos_degrees};
pub use revolve::{ball, hollow, revolve};
pub use soft::{cushion, soft_box};
pub use stage::{Stage, camera, film, quads, rgb};
pub use tube::{Ends, tube};

#[cfg(test)]
mod tests;
