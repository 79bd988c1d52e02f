//! Furniture and things that stand on it, each a function that adds itself to a scene at a place.
//!
//! One unit is an inch (2.5 cm). A thing stands on its place's origin, its front towards +z.

pub mod ceramics;
pub mod fruit;
pub mod lamps;
pub mod objects;
pub mod plants;
pub mod seats;
pub mod shelves;
pub mod tables;
pub mod walls;
