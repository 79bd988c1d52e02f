//! Stage 2: a dining table laid for four with chairs, a shelf on the wall, and shrubs in the garden.

use super::shell::{CEILING, FLOOR, HALF_DEPTH, HALF_WIDTH};
use crate::builtin::build::{Finish, Place, Stage, bitmap, bitmap::hex, shares};
use crate::builtin::furniture::ceramics::VaseShape;
use crate::builtin::furniture::{ceramics, lamps, objects, plants, seats, shelves, tables, walls};

/// Adds to the living room up to `target` triangles.
pub fn add(stage: &mut Stage, target: usize) {
    let table = Place::at(-46.0, FLOOR, 12.0);
    dining_group(stage, table);
    lamps::pendant(stage, table.shift(0.0, CEILING - FLOOR, 0.0), 38.0, 0x2F4F4A, 20.0);
    back_wall(stage);

    let grey = stage.paint("grey-glaze", 0x7E8583, Finish::Gloss);
    let side = Place::at(70.0, FLOOR, -27.0).yaw(-90.0);
    plants::pot(stage, side, 5.4, 12.0, grey);
    let front = Place::at(-64.0, FLOOR, 68.0).yaw(135.0);
    plants::pot(stage, front, 7.6, 13.0, grey);
    let basket = plants::hanging_pot(stage, Place::at(50.0, CEILING, -8.0), 40.0);
    let n = [7, 1, 8, 8, 9, 10, 10];
    let mut left = shares(stage.missing_to(target), n.iter().sum());
    let [kentia, grass, bamboo, bouquet, near, far, door] = n.map(|n| left.by_ref().take(n).sum());
    let short = plants::Fronds { length: 56.0, ..plants::KENTIA };
    plants::fronds(stage, front.shift(0.0, 11.1, 0.0), short, kentia, 5);
    plants::grass(stage, basket, [30.0, 360.0], grass, 6);
    plants::bamboo(stage, side.shift(0.0, 10.2, 0.0), [44.0, 80.0, 180.0], bamboo, 4);
    plants::sprig(stage, table.shift(0.0, tables::DINING_TABLE_TOP + 9.6, 0.0), 13, 16.0, bouquet);
    // In the garden, before the window and the terrace door.
    plants::shrub(stage, Place::at(-104.0, 0.0, -72.0), [24.0, 44.0], 0x5F7F46, near, 3);
    plants::shrub(stage, Place::at(-103.0, 0.0, -34.0), [26.0, 36.0], 0x6F8F4A, far, 4);
    plants::shrub(stage, Place::at(48.0, 0.0, 118.0), [34.0, 46.0], 0x5F7F46, door, 5);
}

/// Table, chairs, plates, glasses, candles and a vase.
fn dining_group(stage: &mut Stage, table: Place) {
    let (walnut, oak) = (stage.walnut(), stage.oak());
    tables::dining_table(stage, table, oak, 48.0, 30.0);
    let cloth = stage
        .printed("rust-leather", [6.0, 6.0], Finish::Satin(0.3), || bitmap::weave(63, hex(0xB4623E), hex(0xA2553A)));
    let white = stage.paint("white-glaze", 0xE9E5DB, Finish::Gloss);
    let top = table.shift(0.0, tables::DINING_TABLE_TOP, 0.0);
    for (x, side) in [(-12.5, 1.0f32), (12.5, 1.0), (-12.5, -1.0), (12.5, -1.0)] {
        let facing = if side > 0.0 { 180.0 } else { 0.0 };
        let pulled = if x > 0.0 && side > 0.0 { 24.0 } else { 18.5 };
        let turn = if x > 0.0 && side > 0.0 { -14.0 } else { 0.0 };
        seats::dining_chair(stage, table.shift(x, 0.0, side * pulled).yaw(facing + turn), walnut, cloth);
        ceramics::plate(stage, top.shift(x, 0.02, side * 9.5), white, 4.6);
        objects::wine_glass(stage, top.shift(x + 6.4, 0.02, side * 5.6), 7.6);
    }
    lamps::candle(stage, top.shift(-8.0, 0.0, 0.0), 11.0, 45.0);
    lamps::candle(stage, top.shift(8.0, 0.0, 0.0), 9.0, 45.0);
    let jade = stage.paint("jade-glaze", 0x5E8A76, Finish::Gloss);
    ceramics::vase(stage, top, jade, VaseShape::Bottle, 9.5);
    plants::roses(stage, top.shift(0.0, 9.5, 0.0), 9, 8.5, 0xC24A4A);
}

/// A board with books and small pots over the armchair's side of the room, and a clock.
fn back_wall(stage: &mut Stage) {
    let walnut = stage.walnut();
    let wall = Place::at(HALF_WIDTH, 0.0, -34.0).yaw(-90.0);
    for (k, y) in [82.0, 36.0].into_iter().enumerate() {
        let board = wall.shift(0.0, y, 0.0);
        shelves::wall_shelf(stage, board, walnut, 40.0);
        let mut books = shelves::Books::default();
        books.row(board.shift(-18.0, 0.0, 8.6), 20.0, 11.0, 20 + k as u32);
        books.finish(stage);
        let blue = stage.paint("blue-glaze", 0x35597F, Finish::Gloss);
        ceramics::vase(stage, board.shift(8.0, 0.0, 4.5), blue, VaseShape::Moon, 6.0);
        ceramics::vase(stage, board.shift(14.5, 0.0, 4.5), blue, VaseShape::Trumpet, 9.0);
    }
    objects::wall_clock(stage, Place::at(36.0, 72.0, -HALF_DEPTH), 7.0, walnut);
    walls::painting(
        stage,
        Place::at(-HALF_WIDTH, 62.0, 22.0).yaw(90.0),
        [38.0, 28.0],
        walnut,
        "painting-blocks",
        || bitmap::blocks(73),
    );
}
