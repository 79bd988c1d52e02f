//! The list of built-in scenes: it feeds the command line, the help, the documentation and the tests.

use super::{Builtin, cornell, furnace, two_spheres};

const SCENES: &[Builtin] = &[
    Builtin {
        name: "two-spheres",
        description: "A glass and a mirror sphere in a Cornell box under the classic lamp, with a caustic under the glass one.",
        triangles: 22,
        make: two_spheres::large_lamp,
    },
    Builtin {
        name: "small-lamp",
        description: "The two spheres under a lamp with a tenth of the sides and the same power: hard shadows, a sharp caustic.",
        triangles: 22,
        make: two_spheres::small_lamp,
    },
    Builtin {
        name: "cornell",
        description: "The measured Cornell box: geometry in millimetres, colours from the measured spectra.",
        triangles: 38,
        make: cornell::cornell,
    },
    Builtin {
        name: "furnace",
        description: "A closed cube that emits Le = 0.25 and reflects rho = 0.5 everywhere: the radiance is Le / (1 - rho) = 0.5 in every direction.",
        triangles: 12,
        make: furnace::furnace,
    },
];

/// All built-in scenes, in the order in which they are shown.
pub fn list() -> &'static [Builtin] {
    SCENES
}
