//! Stage 3: a piano with its stool, a globe, a lamp and books by the window, and plants that hang from the ceiling.

use super::shell::{CEILING, FLOOR, HALF_DEPTH, HALF_WIDTH, WINDOW_Y};
use crate::builtin::build::{Finish, Place, Stage, bitmap, bitmap::hex, shares};
use crate::builtin::furniture::ceramics::VaseShape;
use crate::builtin::furniture::{ceramics, fruit, lamps, objects, plants, seats, shelves, tables, walls};

/// Adds to the dining stage up to `target` triangles.
pub fn add(stage: &mut Stage, target: usize) {
    piano(stage);
    let brass = stage.brass();
    walls::mirror(stage, Place::at(-32.0, 46.0, HALF_DEPTH).yaw(180.0), [44.0, 72.0], brass);
    let globe = Place::at(12.0, FLOOR + 0.7, -10.0);
    let walnut = stage.walnut();
    tables::round_table(stage, globe, walnut, 8.0, 22.0);
    objects::globe(stage, globe.shift(0.0, 22.0, 0.0).yaw(40.0), 7.5);
    on_sill_and_seat(stage);

    let mut baskets = Vec::new();
    for (x, z, drop) in [(-50.0, -26.0, 30.0), (-62.0, -70.0, 24.0)] {
        baskets.push(plants::hanging_pot(stage, Place::at(x, CEILING, z), drop));
    }
    let terracotta = stage.paint("terracotta", 0xB0653F, Finish::Satin(0.3));
    let on_shelf = Place::at(66.0, FLOOR + 78.6, -84.0);
    plants::pot(stage, on_shelf, 5.0, 7.5, terracotta);
    let front = Place::at(-20.0, FLOOR, 76.0).yaw(180.0);
    plants::pot(stage, front, 6.0, 12.0, terracotta);
    let low = Place::at(-70.0, FLOOR, 44.0);
    plants::pot(stage, low, 6.6, 10.6, terracotta);
    let n = [11, 11, 4, 10, 10, 10, 1];
    let mut left = shares(stage.missing_to(target), n.iter().sum());
    let [ivy_a, ivy_b, ivy_c, lawn, hedge, bamboo, grass] = n.map(|n| left.by_ref().take(n).sum());
    plants::ivy(stage, baskets[0], 5.2, 26.0, 16, ivy_a, 6);
    plants::ivy(stage, baskets[1], 5.2, 30.0, 14, ivy_b, 7);
    plants::ivy(stage, on_shelf.shift(0.0, 6.2, 0.0), 5.0, 17.0, 13, ivy_c, 8);
    plants::bamboo(stage, front.shift(0.0, 10.2, 0.0), [30.0, 82.0, 150.0], bamboo, 11);
    plants::grass(stage, low.shift(0.0, 9.0, 0.0), [44.0, 360.0], grass, 12);
    plants::shrub(stage, Place::at(-106.0, 0.0, -6.0), [22.0, 30.0], 0x54703A, lawn, 9);
    plants::shrub(stage, Place::at(16.0, 0.0, 122.0), [30.0, 36.0], 0x6F8F4A, hedge, 10);
}

/// The piano at the right wall, with a lamp, roses, books and a stool.
fn piano(stage: &mut Stage) {
    let piano = Place::at(HALF_WIDTH - 12.6, FLOOR, 14.0).yaw(-90.0);
    objects::piano(stage, piano);
    let walnut = stage.walnut();
    let cloth = stage
        .printed("rust-leather", [6.0, 6.0], Finish::Satin(0.3), || bitmap::weave(63, hex(0xB4623E), hex(0xA2553A)));
    seats::stool(stage, piano.shift(0.0, 0.0, 26.0), walnut, cloth, 8.0, 19.0);
    lamps::table_lamp(stage, piano.shift(-20.0, 48.0, -5.0), 0x7A4B32, [12.0, 0.45]);
    let jade = stage.paint("jade-glaze", 0x5E8A76, Finish::Gloss);
    ceramics::vase(stage, piano.shift(19.0, 48.0, -5.0), jade, VaseShape::Amphora, 11.0);
    plants::roses(stage, piano.shift(19.0, 59.0, -5.0), 7, 8.0, 0xE3C46A);
    let mut books = shelves::Books::default();
    books.pile(piano.shift(6.0, 48.0, -5.0).shift(-5.0, 0.0, 0.0), 4, 31);
    books.finish(stage);
}

/// Small things on the window sill and on the window seat.
fn on_sill_and_seat(stage: &mut Stage) {
    let blue = stage.paint("blue-glaze", 0x35597F, Finish::Gloss);
    let x = -HALF_WIDTH + 2.7;
    let y = WINDOW_Y[0] - 0.55;
    ceramics::vase(stage, Place::at(x, y, -34.0), blue, VaseShape::Bottle, 8.0);
    ceramics::vase(stage, Place::at(x, y, -56.0), blue, VaseShape::Moon, 5.0);
    fruit::pear(stage, Place::at(x, y, -41.0), 1.2);
    fruit::apple(stage, Place::at(x + 0.3, y, -45.0), 1.3, true);
    let mut books = shelves::Books::default();
    books.pile(Place::at(-74.0, FLOOR + 17.4, -46.0).yaw(70.0).shift(-5.0, 0.0, 0.0), 4, 33);
    books.finish(stage);
    let white = stage.paint("white-glaze", 0xE9E5DB, Finish::Gloss);
    ceramics::cup(stage, Place::at(-70.0, FLOOR + 17.4, -36.0).yaw(120.0), white, 1.4);
}
