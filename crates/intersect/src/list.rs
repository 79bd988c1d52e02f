//! The list of ray-triangle methods: command line, help, documentation and tests are made from it.

use crate::leaf_tester::{self, LeafTester};
use crate::method::RtiMethod;
use crate::methods::{
    angle_summation::AngleSummation, arenberg::Arenberg, badouel::Badouel, badouel_hardware::BadouelHardware,
    badouel_pivot::BadouelPivot, badouel_thesis::BadouelThesis, edge_crossings::EdgeCrossings, half_plane::HalfPlane,
    moller_trumbore::MollerTrumbore, pluecker::Pluecker, snyder_barr::SnyderBarr, woop::Woop,
};
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
    /// Whether all points of edges and vertices are hits, up to rounding.
    pub closed: bool,
    /// Whether a test is done in the scalar's own additions, subtractions, multiplications, divisions and square roots,
    /// as a number system in hardware has them.
    pub hardware: bool,
    /// Prepares the primitives for the method.
    pub leaf_tester: fn(&Primitives) -> Box<dyn LeafTester>,
}

/// What most members are: closed, with operations that hardware has, and not watertight.
const fn member<M>(summary: &'static str, source: &'static str) -> MethodInfo
where
    M: RtiMethod<f32> + 'static,
    M::Prepared: Send + Sync + 'static,
{
    let leaf_tester = leaf_tester::make::<M>;
    MethodInfo { name: M::NAME, summary, source, watertight: false, closed: true, hardware: true, leaf_tester }
}

/// Every ray-triangle method.
pub const METHODS: &[MethodInfo] = &[
    MethodInfo {
        watertight: true,
        hardware: false,
        ..member::<Woop>("shear the triangle onto the ray's axis; watertight", "Woop, Benthin, Wald, JCGT 2(1), 2013")
    },
    member::<MollerTrumbore>("Cramer's rule without the plane", "Moller, Trumbore, JGT 2(1), 1997"),
    member::<Badouel>(
        "plane first, then weights in the dominant projection; as published",
        "Badouel, Graphics Gems, 1990",
    ),
    member::<BadouelThesis>("Badouel's test in ten prepared words, axes as the thesis prints", "thesis, Figure 30"),
    member::<BadouelPivot>("Badouel's test in ten prepared words, pivoting", "thesis, Figure 30, with pivoting"),
    MethodInfo {
        closed: false,
        ..member::<BadouelHardware>(
            "as badouel-pivot, with the half-open test of two bits",
            "thesis, section 6.1.3.3.2",
        )
    },
    member::<SnyderBarr>("plane first, then three cross products in the projection", "Snyder, Barr, SIGGRAPH 1987"),
    member::<Arenberg>("to the space where the triangle is a unit one", "Arenberg, Ray Tracing News 1(11), 1988"),
    member::<Pluecker>("on which side the ray passes each edge", "Jones, Ray Tracing News 13(1), 2000"),
    member::<HalfPlane>(
        "plane first, then cross products with the edges against the normal",
        "Green, Ray Tracing News 6(1), 1993",
    ),
    member::<EdgeCrossings>("plane first, then the edges that a line to infinity crosses", "Shimrat, CACM 5(8), 1962"),
    MethodInfo {
        hardware: false,
        ..member::<AngleSummation>(
            "plane first, then the angles of the edges summed",
            "Walden, Ray Tracing News 5(3), 1992",
        )
    },
];

/// The method used where none is named.
pub const DEFAULT_METHOD: &str = "woop";

/// The member called `name`, underscores standing for hyphens.
pub fn find_method(name: &str) -> Option<&'static MethodInfo> {
    let name = name.replace('_', "-");
    METHODS.iter().find(|m| m.name == name)
}
