//! Stage 4: a chess table with stools, drinks, candles, a floor vase, and the garden's last plants.

use super::shell::{CEILING, FLOOR, HALF_DEPTH, HALF_WIDTH};
use crate::builtin::build::{Finish, Place, Stage, bitmap, bitmap::hex, shares};
use crate::builtin::furniture::ceramics::VaseShape;
use crate::builtin::furniture::{ceramics, lamps, objects, plants, seats, shelves, tables};

/// Adds to the music stage up to `target` triangles.
pub fn add(stage: &mut Stage, target: usize) {
    chess_corner(stage);
    let piano_top = Place::at(HALF_WIDTH - 12.6, FLOOR + 48.05, 14.0).yaw(-90.0);
    objects::tray(stage, piano_top.shift(-6.0, 0.0, -5.4), 5.0);
    lamps::candle(stage, piano_top.shift(12.5, 0.0, -5.0), 9.0, 45.0);
    let mut books = shelves::Books::default();
    books.row(Place::at(46.0, FLOOR + 78.6, -HALF_DEPTH + 10.5), 13.0, 11.0, 41);
    books.finish(stage);

    let (cream, jade) =
        (stage.paint("cream-glaze", 0xE3D9C2, Finish::Gloss), stage.paint("jade-glaze", 0x5E8A76, Finish::Gloss));
    let floor_vase = Place::at(-67.0, FLOOR, -60.0);
    ceramics::vase(stage, floor_vase, jade, VaseShape::Amphora, 24.0);
    let tuft_pot = Place::at(-76.0, FLOOR + 17.5, -58.0);
    plants::pot(stage, tuft_pot, 4.0, 6.0, cream);
    let sill_pot = Place::at(-HALF_WIDTH + 2.6, 26.4, -68.0);
    plants::pot(stage, sill_pot, 2.4, 4.4, cream);

    let right = Place::at(74.0, FLOOR, 66.0).yaw(-135.0);
    plants::pot(stage, right, 7.6, 13.0, cream);
    let hook = plants::hanging_pot(stage, Place::at(-6.0, CEILING, -2.0), 16.0);
    let n = [4, 4, 3, 7, 9, 13, 5, 6, 6];
    let mut left = shares(stage.missing_to(target), n.iter().sum());
    let [sprig, tuft, sill, bamboo, ivy, near, far, tall, hedge] = n.map(|n| left.by_ref().take(n).sum());
    plants::sprig(stage, floor_vase.shift(0.0, 24.0, 0.0), 15, 24.0, sprig);
    plants::tuft(stage, tuft_pot.shift(0.0, 5.1, 0.0), 14.0, 160, tuft, 13);
    plants::tuft(stage, sill_pot.shift(0.0, 3.7, 0.0), 9.0, 120, sill, 14);
    plants::bamboo(stage, right.shift(0.0, 11.1, 0.0), [30.0, 84.0, 150.0], bamboo, 15);
    plants::ivy(stage, hook, 5.2, 24.0, 14, ivy, 16);
    plants::shrub(stage, Place::at(-107.0, 0.0, -104.0), [30.0, 62.0], 0x5F7F46, near, 15);
    plants::shrub(stage, Place::at(-107.0, 0.0, -52.0), [20.0, 26.0], 0x7B9A55, far, 16);
    plants::shrub(stage, Place::at(-20.0, 0.0, 124.0), [30.0, 70.0], 0x54703A, tall, 17);
    plants::shrub(stage, Place::at(84.0, 0.0, 122.0), [36.0, 44.0], 0x6F8F4A, hedge, 18);
}

/// A small round table with a game of chess, and two stools.
fn chess_corner(stage: &mut Stage) {
    let walnut = stage.walnut();
    let table = Place::at(16.0, FLOOR, 18.0).yaw(78.0);
    tables::round_table(stage, table, walnut, 10.0, 21.0);
    objects::chess(stage, table.shift(0.0, 21.0, 0.0), 12.0);
    let teal =
        stage.printed("teal-cloth", [6.0, 6.0], Finish::Satin(0.3), || bitmap::weave(62, hex(0x3F7378), hex(0x356468)));
    for side in [-1.0, 1.0] {
        seats::stool(stage, table.shift(0.0, 0.0, side * 19.0), walnut, teal, 7.0, 15.0);
    }
}
