//! Bookshelves and books.

use crate::MaterialId;
use crate::builtin::build::{Dice, Finish, Part, Place, Stage, bevelled, book};

const BINDINGS: [u32; 9] = [0x7A2E2A, 0x2F4A63, 0x3F5B45, 0xB58A4A, 0x5A4368, 0xC7B79A, 0x8C5634, 0x2C3338, 0x9C4A36];

/// Books gathered by the colour of their binding, so that a shelf is a few meshes and not hundreds.
#[derive(Default)]
pub struct Books {
    bindings: [Part; BINDINGS.len()],
    pages: Part,
}

impl Books {
    /// Adds one book of this thickness, height and depth in its own place: it stands, back towards +z.
    pub fn one(&mut self, place: Place, color: usize, size: [f32; 3]) {
        let book = book(size[0], size[1], size[2]);
        self.bindings[color % BINDINGS.len()].add(book.binding.placed(place));
        self.pages.add(book.pages.placed(place));
    }

    /// Fills a board from the place's origin along +x up to `length`, backs at z = 0; some books lean at the end.
    pub fn row(&mut self, place: Place, length: f32, tallest: f32, seed: u32) {
        let mut dice = Dice::new(91, seed);
        let mut x = 0.0;
        loop {
            let size = [dice.between(1.0, 2.4), tallest * dice.between(0.68, 1.0), dice.between(6.2, 8.2)];
            let color = dice.pick(&[0, 1, 2, 3, 4, 5, 6, 7, 8]);
            if x + size[0] > length {
                break;
            }
            self.one(place.shift(x + 0.5 * size[0], 0.0, -0.5 * size[2]), color, size);
            x += size[0] + 0.04;
        }
    }

    /// A pile of lying books, largest below, backs towards +z and each turned a little.
    pub fn pile(&mut self, place: Place, count: usize, seed: u32) -> f32 {
        let mut dice = Dice::new(92, seed);
        let mut y = 0.0;
        for k in 0..count {
            let shrink = 1.0 - 0.09 * k as f32;
            let size = [dice.between(1.0, 1.9), dice.between(10.5, 12.0) * shrink, 8.0 * shrink];
            let turn = dice.between(-16.0, 16.0);
            let lying = place.shift(0.0, y + 0.5 * size[0], 0.0).yaw(turn).shift(0.5 * size[1], 0.0, 0.0).roll(90.0);
            self.one(lying, dice.pick(&[0, 1, 2, 3, 5, 6, 8]), size);
            y += size[0] + 0.02;
        }
        y
    }

    /// Adds all of them to the scene.
    pub fn finish(self, stage: &mut Stage) {
        for (color, part) in BINDINGS.into_iter().zip(self.bindings) {
            if part.triangle_count() > 0 {
                let binding = stage.paint(&format!("binding-{color:06x}"), color, Finish::Satin(0.35));
                stage.mesh("bindings", binding, part);
            }
        }
        if self.pages.triangle_count() > 0 {
            let paper = stage.paint("paper", 0xE9E0CB, Finish::Matte);
            stage.mesh("pages", paper, self.pages);
        }
    }
}

/// A tall bookshelf: `width` x 11 deep with this many boards 15 units apart; gives the height of each board.
pub fn bookshelf(stage: &mut Stage, place: Place, wood: MaterialId, width: f32, boards: usize) -> Vec<f32> {
    let pitch = 15.0;
    let height = 2.0 + pitch * boards as f32;
    let half = 0.5 * width;
    let mut part = Part::default();
    for side in [-1.0, 1.0] {
        let x = side * (half - 0.6);
        part.add(bevelled([x - 0.6, 0.0, -5.5], [x + 0.6, height, 5.5], 0.2));
    }
    part.add(bevelled([-half + 1.2, 1.6, -5.4], [half - 1.2, height, -4.9], 0.1));
    part.add(bevelled([-half - 0.8, height, -5.8], [half + 0.8, height + 1.6, 6.2], 0.35));
    let mut tops = Vec::new();
    for k in 0..boards {
        let y = 2.0 + pitch * k as f32;
        part.add(bevelled([-half + 1.2, y - 1.1, -4.9], [half - 1.2, y, 5.2], 0.15));
        tops.push(y);
    }
    part.add(bevelled([-half + 1.2, 0.0, 3.9], [half - 1.2, 0.9, 4.7], 0.1));
    stage.mesh("bookshelf", wood, part.placed(place));
    tops
}

/// A board on a wall, its back at z = 0, on two brackets; gives its top's height above the origin: 0.
pub fn wall_shelf(stage: &mut Stage, place: Place, wood: MaterialId, width: f32) {
    let half = 0.5 * width;
    let mut part = bevelled([-half, -1.2, 0.0], [half, 0.0, 9.0], 0.2);
    for x in [-0.7 * half, 0.7 * half] {
        part.add(bevelled([x - 0.4, -6.0, 0.0], [x + 0.4, -1.2, 0.8], 0.12));
        part.add(bevelled([x - 0.4, -1.9, 0.8], [x + 0.4, -1.2, 7.0], 0.12));
    }
    stage.mesh("wall-shelf", wood, part.placed(place));
}
