//! The list of built-in scenes: it feeds the command line, the help, the documentation and the tests.

use super::{Builtin, cornell, furnace, room, spheres, study, texture, two_spheres, water_lily};

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
    Builtin {
        name: "spheres",
        description: "Eight coloured spheres inside a large pale one, all exact: a few thousand photons are enough.",
        triangles: 0,
        make: spheres::spheres,
    },
    Builtin {
        name: "texture-10",
        description: "Two textured pyramids on chequers, ten triangles in all.",
        triangles: 10,
        make: texture::pyramids,
    },
    Builtin {
        name: "texture-1210",
        description: "Three patterned vases on a marble plinth.",
        triangles: 1210,
        make: texture::vases,
    },
    Builtin {
        name: "texture-7590",
        description: "A tea table with a chequered cloth, a marbled pot, cups, fruit and flowers.",
        triangles: 7590,
        make: texture::tea_table,
    },
    Builtin {
        name: "study-22054",
        description: "A study in the evening: desk with lamp, books and globe, a reading chair and full shelves.",
        triangles: 22_054,
        make: study::study,
    },
    Builtin {
        name: "water-lily-1426",
        description: "A pond with two water lilies and carp over a bed of pebbles, with caustics through the waves, coarsely cut.",
        triangles: 1426,
        make: water_lily::coarse,
    },
    Builtin {
        name: "water-lily-6146",
        description: "The pond with water lilies, finely cut.",
        triangles: 6146,
        make: water_lily::fine,
    },
    Builtin {
        name: "room-1",
        description: "A living room on a large plane: sofa, armchair, glass table, bookshelf, mirror and three plants.",
        triangles: room::TRIANGLES[0],
        make: room::room_1,
    },
    Builtin {
        name: "room-2",
        description: "The room with a dining table laid for four, wall shelves and shrubs in the garden.",
        triangles: room::TRIANGLES[1],
        make: room::room_2,
    },
    Builtin {
        name: "room-3",
        description: "The room with a piano, a globe, hanging plants and more garden.",
        triangles: room::TRIANGLES[2],
        make: room::room_3,
    },
    Builtin {
        name: "room-4",
        description: "The room with a chess table, a second armchair, flowers and many more plants.",
        triangles: room::TRIANGLES[3],
        make: room::room_4,
    },
];

/// All built-in scenes, in the order in which they are shown.
pub fn list() -> &'static [Builtin] {
    SCENES
}
