//! Ray-triangle methods, one file each, over any scalar; the exact ray-sphere test; and the leaf testers that
//! acceleration structures call.
//!
//! A method is a pair of a prepared triangle and a started ray ([`RtiMethod`]). Structures know none of them: they
//! hold a [`LeafTester`], made from the list ([`METHODS`]) by name, and call it once a leaf.

pub mod doubles;
pub mod leaf_tester;
pub mod list;
pub mod method;
pub mod methods {
    //! The members: one ray-triangle method a file.

    pub mod angle_summation;
    pub mod arenberg;
    pub mod badouel;
    pub mod badouel_hardware;
    pub mod badouel_pivot;
    pub mod badouel_thesis;
    pub mod edge_crossings;
    pub mod half_plane;
    pub mod moller_trumbore;
    pub mod pluecker;
    pub mod snyder_barr;
    pub mod woop;
}
pub mod plane;
pub mod restructured;
pub mod sphere;

pub use leaf_tester::{LeafTester, LeafWork, sphere_tester};
pub use list::{DEFAULT_METHOD, METHODS, MethodInfo, find_method};
pub use method::{GivenRay, RtiMethod, TriangleHit, is_degenerate};
