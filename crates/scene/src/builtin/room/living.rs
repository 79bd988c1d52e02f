//! Stage 1: a seating group on a rug, a bookshelf, pictures, a mirror, lamps and the first plants.

use super::garden;
use super::shell::{CEILING, FLOOR, HALF_DEPTH, HALF_WIDTH, WINDOW_Y, WINDOW_Z};
use crate::builtin::build::{Finish, Part, Place, Stage, bitmap, bitmap::hex, shares};
use crate::builtin::furniture::ceramics::VaseShape;
use crate::builtin::furniture::{ceramics, fruit, lamps, objects, plants, seats, shelves, tables, walls};
use photinus_geometry::Vec3;

/// Furnishes the empty room up to `target` triangles.
pub fn add(stage: &mut Stage, target: usize) {
    seating(stage);
    coffee_table(stage);
    bookshelf(stage);
    walls_and_window(stage);
    daylight(stage);
    for [x, z] in [[5.0, -20.0], [14.0, 44.0]] {
        lamps::globe_lamp(stage, Place::at(x, CEILING, z), 18.0, 6.5, 60.0);
    }
    lamps::floor_lamp(stage, Place::at(36.0, FLOOR, -77.0), [5.0, 0.45]);

    let terracotta = stage.paint("terracotta", 0xB0653F, Finish::Satin(0.3));
    let cream = stage.paint("cream-glaze", 0xE3D9C2, Finish::Gloss);
    let corner = Place::at(-72.0, FLOOR, -79.0).yaw(45.0);
    plants::pot(stage, corner, 8.0, 14.0, cream);
    let right = Place::at(72.0, FLOOR, -58.0).yaw(-90.0);
    plants::pot(stage, right, 7.6, 13.0, terracotta);
    let window = Place::at(-72.0, FLOOR, -8.0).yaw(90.0);
    plants::pot(stage, window, 5.8, 12.0, terracotta);
    let sill = Place::at(-HALF_WIDTH + 2.6, WINDOW_Y[0] - 0.6, -24.0);
    plants::pot(stage, sill, 2.4, 4.4, terracotta);
    let n = [1, 6, 7, 1, 2];
    let mut left = shares(stage.missing_to(target), n.iter().sum());
    let [grass, palm, bamboo, tuft, shrubs] = n.map(|n| left.by_ref().take(n).sum());
    plants::grass(stage, corner.shift(0.0, 11.9, 0.0), [58.0, 110.0], grass, 1);
    plants::fronds(stage, right.shift(0.0, 11.1, 0.0), plants::KENTIA, palm, 2);
    plants::bamboo(stage, window.shift(0.0, 10.2, 0.0), [52.0, 84.0, 200.0], bamboo, 3);
    plants::tuft(stage, sill.shift(0.0, 3.7, 0.0), 11.0, 90, tuft, 1);
    garden::shrubs(stage, shrubs);
}

/// Sofa, armchair, window seat, rug.
fn seating(stage: &mut Stage) {
    let linen = stage.printed("linen", [6.0, 6.0], Finish::Matte, || bitmap::weave(61, hex(0xC4B79F), hex(0xB3A58C)));
    seats::sofa(stage, Place::at(-18.0, FLOOR, -68.5), 3, linen);
    let teal =
        stage.printed("teal-cloth", [6.0, 6.0], Finish::Satin(0.3), || bitmap::weave(62, hex(0x3F7378), hex(0x356468)));
    seats::sofa(stage, Place::at(37.0, FLOOR, -31.0).yaw(-62.0), 1, teal);
    let rust =
        stage.printed("rust-cloth", [6.0, 6.0], Finish::Matte, || bitmap::weave(63, hex(0xB4623E), hex(0xA2553A)));
    let bands = stage.printed("striped-cloth", [1.0, 1.0], Finish::Matte, || {
        bitmap::stripes(64, 4, hex(0xE2D8C3), hex(0x3F6A73), hex(0xC9973F))
    });
    let on_sofa = FLOOR + 16.2;
    for (x, z, turn, cloth, side) in [
        (-51.0, -66.0, 24.0, rust, 17.0),
        (-40.0, -64.5, 8.0, bands, 15.0),
        (13.0, -66.0, -22.0, teal, 17.0),
        (2.0, -64.0, -6.0, rust, 14.0),
    ] {
        seats::scatter_cushion(stage, Place::at(x, on_sofa, z).yaw(turn), cloth, side);
    }
    seats::scatter_cushion(stage, Place::at(41.5, on_sofa, -33.5).yaw(-62.0), bands, 14.0);

    let oak = stage.oak();
    let seat = Place::at(-HALF_WIDTH + 9.5, FLOOR, 0.5 * (WINDOW_Z[0] + WINDOW_Z[1])).yaw(90.0);
    objects::window_seat(stage, seat, [54.0, 14.0, 16.0], oak, linen);
    seats::scatter_cushion(stage, seat.shift(-17.0, 17.2, -1.5).yaw(12.0), teal, 15.0);
    seats::scatter_cushion(stage, seat.shift(18.0, 17.2, -2.0).yaw(-10.0), bands, 14.0);

    walls::rug(
        stage,
        Place::at(-16.0, FLOOR, -34.0),
        [96.0, 60.0],
        "rug",
        || bitmap::rug(65, hex(0x8A3B2E), hex(0x2F4558), hex(0xC79A55), hex(0xE6D9BE)),
        756,
    );
}

/// The glass table and what lies on it and on the side table.
fn coffee_table(stage: &mut Stage) {
    let walnut = stage.walnut();
    let table = Place::at(-18.0, FLOOR + 0.7, -35.0);
    tables::coffee_table(stage, table, walnut);
    let top = table.shift(0.0, tables::COFFEE_TABLE_TOP + 0.05, 0.0);
    let blue = stage.paint("blue-glaze", 0x35597F, Finish::Gloss);
    let white = stage.paint("white-glaze", 0xE9E5DB, Finish::Gloss);
    ceramics::bowl(stage, top.shift(-11.0, 0.0, 1.0), blue, 6.4);
    fruit::heap(stage, top.shift(-11.0, 1.4, 1.0), 5.0);
    objects::crystal_ball(stage, top.shift(13.0, 0.0, -5.0), 3.2);
    ceramics::cup(stage, top.shift(3.0, 0.0, 7.0).yaw(-30.0), white, 1.5);
    ceramics::cup(stage, top.shift(16.5, 0.0, 6.5).yaw(40.0), white, 1.5);
    let mut books = shelves::Books::default();
    books.pile(table.shift(-6.0, 5.7, 0.0).yaw(14.0).shift(-4.0, 0.0, 0.0), 3, 7);
    books.pile(table.shift(10.0, 5.7, 2.0).yaw(-8.0).shift(-4.0, 0.0, 0.0), 2, 9);

    let oak = stage.oak();
    let side = Place::at(29.0, FLOOR + 0.4, -59.0);
    tables::round_table(stage, side, oak, 9.0, 19.0);
    ceramics::teapot(stage, side.shift(-2.0, 19.05, -1.0).yaw(-140.0), blue, 2.9);
    ceramics::cup(stage, side.shift(4.4, 19.05, 3.2).yaw(60.0), blue, 1.4);
    books.finish(stage);
}

/// The shelf at the back wall, with books and vases.
fn bookshelf(stage: &mut Stage) {
    let oak = stage.oak();
    let shelf = Place::at(62.0, FLOOR, -HALF_DEPTH + 5.9);
    let tops = shelves::bookshelf(stage, shelf, oak, 36.0, 5);
    let mut books = shelves::Books::default();
    let spans = [(-16.4, 32.4), (-16.4, 20.0), (-9.0, 25.4), (-16.4, 23.0), (-16.4, 14.0)];
    for (k, (&y, (x, length))) in tops.iter().zip(spans).enumerate() {
        books.row(shelf.shift(x, y, 4.6), length, 12.6, k as u32);
    }
    books.finish(stage);
    let (jade, rust) =
        (stage.paint("jade-glaze", 0x5E8A76, Finish::Gloss), stage.paint("rust-glaze", 0x9C4B2E, Finish::Gloss));
    ceramics::vase(stage, shelf.shift(10.0, tops[1], 0.0), jade, VaseShape::Moon, 7.5);
    ceramics::vase(stage, shelf.shift(-13.0, tops[2], 0.0), rust, VaseShape::Amphora, 10.5);
    ceramics::vase(stage, shelf.shift(11.5, tops[3], 0.0), rust, VaseShape::Bottle, 11.0);
    ceramics::vase(stage, shelf.shift(3.5, tops[4], 0.0), jade, VaseShape::Trumpet, 11.5);
    ceramics::vase(stage, shelf.shift(11.0, tops[4], 0.0), rust, VaseShape::Moon, 8.0);
}

/// Pictures, mirror, curtains, clock.
fn walls_and_window(stage: &mut Stage) {
    let (walnut, brass) = (stage.walnut(), stage.brass());
    let back = -HALF_DEPTH;
    walls::painting(stage, Place::at(-40.0, 63.0, back), [38.0, 27.0], walnut, "painting-hills", || bitmap::hills(71));
    walls::mirror(stage, Place::at(6.0, 64.0, back), [25.0, 33.0], brass);
    walls::painting(
        stage,
        Place::at(HALF_WIDTH, 60.0, -34.0).yaw(-90.0),
        [24.0, 32.0],
        walnut,
        "painting-circles",
        || bitmap::circles(72),
    );
    let drape = stage.printed("drape", [20.0, 20.0], Finish::Matte, || {
        bitmap::stripes(66, 4, hex(0xD9CDB4), hex(0xCDBE9F), hex(0xA98C5B))
    });
    let middle = 0.5 * (WINDOW_Z[0] + WINDOW_Z[1]);
    let rod = Place::at(-HALF_WIDTH + 4.6, WINDOW_Y[1] + 4.5, middle).yaw(90.0);
    walls::curtains(stage, rod, WINDOW_Z[1] - WINDOW_Z[0], WINDOW_Y[1] - 21.0, drape);
}

/// The evening sky outside the window, as a panel that faces the room.
fn daylight(stage: &mut Stage) {
    let black = stage.paint("bulb", 0x000000, Finish::Matte);
    let x = -HALF_WIDTH - 30.0;
    let (z, y) = ([WINDOW_Z[0] - 48.0, WINDOW_Z[1] + 6.0], [16.0, 98.0]);
    let mut sky = Part::default();
    let corners = [[z[1], y[0]], [z[0], y[0]], [z[0], y[1]], [z[1], y[1]]].map(|[z, y]| Vec3::new(x, y, z));
    sky.quad(corners, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    stage.lamp("sky", black, sky, [0.4, 0.45, 0.52]);
}
