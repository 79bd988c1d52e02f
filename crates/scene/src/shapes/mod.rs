//! Analytic shapes as triangles, and meshes moved in space.
//!
//! Each shape is in its own space as Mitsuba 3 defines it, with texture coordinates whose v runs up (v = 0 is a
//! picture's bottom row).

mod cube;
mod cylinder;
mod disk;
mod place;
mod rectangle;
mod sphere;

pub use cube::cube;
pub use cylinder::cylinder;
pub use disk::disk;
pub use place::place_mesh;
pub use rectangle::rectangle;
pub use sphere::{sphere_mesh, sphere_segments, tessellate_spheres};

/// Triangles around a disk or cylinder: the area is off by 1e-4.
pub const ROUND_SEGMENTS: u32 = 256;
