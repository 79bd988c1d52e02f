//! The list of ray-triangle methods: command line, help, documentation and tests are made from it.

use crate::leaf_tester::{self, LeafTester};
use crate::method::RtiMethod;
use crate::methods::{badouel::Badouel, moller_trumbore::MollerTrumbore, woop::Woop};
use photinus_geometry::Primitives;

/// A member of the family.
pub struct MethodInfo {
    /// The name on the command line.
    pub name: &'static str,
    /// One line for the help.
    pub summary: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// Whether no ray slips between triangles that share an edge.
    pub watertight: bool,
    /// Prepares the primitives for the method.
    pub leaf_tester: fn(&Primitives) -> Box<dyn LeafTester>,
}

/// Every ray-triangle method.
pub const METHODS: &[MethodInfo] = &[
    MethodInfo {
        name: <Woop as RtiMethod<f32>>::NAME,
        summary: "shear the triangle onto the ray's axis; watertight",
        source: "Woop, Benthin, Wald, JCGT 2(1), 2013",
        watertight: true,
        leaf_tester: leaf_tester::make::<Woop>,
    },
    MethodInfo {
        name: <MollerTrumbore as RtiMethod<f32>>::NAME,
        summary: "Cramer's rule without the plane",
        source: "Moller, Trumbore, JGT 2(1), 1997",
        watertight: false,
        leaf_tester: leaf_tester::make::<MollerTrumbore>,
    },
    MethodInfo {
        name: <Badouel as RtiMethod<f32>>::NAME,
        summary: "plane first, then barycentrics in the dominant projection",
        source: "Badouel, Graphics Gems, 1990",
        watertight: false,
        leaf_tester: leaf_tester::make::<Badouel>,
    },
];

/// The method used where none is named.
pub const DEFAULT_METHOD: &str = "woop";

/// The member called `name`, underscores standing for hyphens.
pub fn find_method(name: &str) -> Option<&'static MethodInfo> {
    let name = name.replace('_', "-");
    METHODS.iter().find(|m| m.name == name)
}
