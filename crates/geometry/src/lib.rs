//! Geometry: rays, hits, boxes, frames, and the primitives that structures are built over.
//!
//! Vectors are [`glam`]'s; all lengths are in scene units.

mod aabb;
mod frame;
mod primitives;
mod ray;

pub use aabb::Aabb;
pub use frame::Frame;
pub use glam::{Affine3A, Mat3, Mat4, Quat, Vec2, Vec3, Vec4};
pub use primitives::{MAX_PRIMITIVES, Primitives, Sphere};
pub use ray::{Hit, NO_HIT, Ray};
