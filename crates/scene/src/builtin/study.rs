//! A study in the evening: a desk with lamp, books and globe, a reading chair, full shelves; 22,054 triangles.

use super::build::{
    Faces, Finish, Part, Place, Stage, bevelled, bitmap, bitmap::hex, camera, cuboid, film, linear, standing,
};
use super::furniture::ceramics::VaseShape;
use super::furniture::{ceramics, lamps, objects, plants, seats, shelves, tables, walls};
use crate::Scene;

/// Triangles of the thesis's model (figure 47).
const TRIANGLES: usize = 22_054;
/// Half the inner width, the back, the front and the ceiling of the room.
const HALF_WIDTH: f32 = 66.0;
const BACK: f32 = -50.0;
const FRONT: f32 = 78.0;
const CEILING: f32 = 96.0;

/// The furnished room.
pub fn study() -> Scene {
    let mut stage = Stage::default();
    room(&mut stage);
    desk(&mut stage);
    reading_corner(&mut stage);
    book_wall(&mut stage);
    lamps::ceiling_lamp(&mut stage, Place::at(0.0, CEILING, 10.0), 9.0, 190.0);

    let pot = Place::at(57.0, 0.0, -41.0);
    let clay = stage.paint("terracotta", 0xB0653F, Finish::Matte);
    plants::pot(&mut stage, pot, 6.0, 11.0, clay);
    let missing = stage.missing_to(TRIANGLES);
    plants::rubber_plant(&mut stage, pot.shift(0.0, 9.4, 0.0), 40.0, missing, 3);
    stage.finish(camera([27.0, 56.0, 76.0], [-2.0, 34.0, -22.0], 52.0), film(800, 600), None)
}

/// Floor, walls, ceiling, skirting and a rug.
fn room(stage: &mut Stage) {
    let (w, t) = (HALF_WIDTH, 4.0);
    let boards = stage.printed("floor-boards", [72.0, 72.0], Finish::Satin(0.25), || {
        bitmap::planks(52, hex(0x9A6C42), hex(0x5F3D22))
    });
    stage.mesh("floor", boards, cuboid([-w, -t, BACK], [w, 0.0, FRONT], Faces::All));
    let paint = stage.diffuse("wall-paint", linear(0x8FA096));
    let wall = |min: [f32; 3], max: [f32; 3]| cuboid(min, max, Faces::All);
    let sides = wall([-w - t, -t, BACK - t], [w + t, CEILING + t, BACK])
        .and(wall([-w - t, -t, BACK], [-w, CEILING + t, FRONT]))
        .and(wall([w, -t, BACK], [w + t, CEILING + t, FRONT]))
        .and(wall([-w - t, -t, FRONT], [w + t, CEILING + t, FRONT + t]));
    stage.mesh("walls", paint, sides);
    let white = stage.diffuse("ceiling-white", linear(0xE4DFD2));
    stage.mesh("ceiling", white, wall([-w, CEILING, BACK], [w, CEILING + t, FRONT]));
    let wood = stage.walnut();
    let mut skirting = bevelled([-w, 0.0, BACK], [w, 6.0, BACK + 1.0], 0.3);
    skirting.add(bevelled([-w, 0.0, BACK + 1.0], [-w + 1.0, 6.0, FRONT], 0.3));
    skirting.add(bevelled([w - 1.0, 0.0, BACK + 1.0], [w, 6.0, FRONT], 0.3));
    stage.mesh("skirting", wood, skirting);
    walls::rug(
        stage,
        Place::at(0.0, 0.05, 12.0),
        [88.0, 54.0],
        "rug",
        || bitmap::rug(67, hex(0x2F4A56), hex(0x6E2F2A), hex(0xC3A062), hex(0xDDD2B8)),
        384,
    );
}

/// The desk at the back wall, what lies on it, its chair, and a picture over it.
fn desk(stage: &mut Stage) {
    let walnut = stage.walnut();
    let desk = Place::at(14.0, 0.0, BACK + 16.5);
    tables::desk(stage, desk, walnut);
    let top = desk.shift(0.0, tables::DESK_TOP, 0.0);
    lamps::desk_lamp(stage, top.shift(-19.0, 0.0, -5.0).yaw(-24.0), 0x2E5B4C, 420.0);
    objects::globe(stage, top.shift(20.5, 0.0, -3.5).yaw(-20.0), 6.2);
    let paper = stage.paint("paper", 0xE9E0CB, Finish::Matte);
    let mut sheets = Part::default();
    for (k, turn) in [0.0, 7.0, -5.0].into_iter().enumerate() {
        sheets.add(standing([8.5, 0.08, 11.0], 0.02).placed(Place::at(0.0, 0.09 * k as f32, 5.0).yaw(turn)));
    }
    stage.mesh("sheets", paper, sheets.placed(top.shift(-2.0, 0.01, 0.0)));
    let mut books = shelves::Books::default();
    books.pile(top.shift(5.0, 0.0, -7.0), 4, 61);
    books.one(top.shift(10.5, 0.6, 6.0).yaw(20.0).roll(90.0), 0, [1.2, 9.0, 6.5]);
    books.finish(stage);
    let white = stage.paint("white-glaze", 0xE9E5DB, Finish::Gloss);
    ceramics::cup(stage, top.shift(-11.5, 0.0, 7.0).yaw(40.0), white, 1.4);

    let leather = stage.paint("leather", 0x6B3526, Finish::Satin(0.3));
    seats::dining_chair(stage, Place::at(9.0, 0.0, -4.0).yaw(156.0), walnut, leather);
    let brass = stage.brass();
    walls::painting(stage, Place::at(16.0, 67.0, BACK), [38.0, 27.0], brass, "painting-hills", || bitmap::hills(74));
}

/// An armchair on the rug under a standing lamp.
fn reading_corner(stage: &mut Stage) {
    let leather = stage.paint("leather", 0x6B3526, Finish::Satin(0.3));
    let chair = Place::at(-40.0, 0.0, 0.0).yaw(62.0);
    seats::sofa(stage, chair, 1, leather);
    let cloth = stage.printed("striped-cloth", [1.0, 1.0], Finish::Matte, || {
        bitmap::stripes(64, 4, hex(0xE2D8C3), hex(0x3F6A73), hex(0xC9973F))
    });
    seats::scatter_cushion(stage, chair.shift(3.0, 16.0, 1.5).yaw(-8.0), cloth, 14.0);
    lamps::floor_lamp(stage, Place::at(-54.0, 0.0, -22.0), [260.0, 0.011 * 260.0]);
}

/// A full bookshelf, with a vase on top.
fn book_wall(stage: &mut Stage) {
    let walnut = stage.walnut();
    let shelf = Place::at(-38.0, 0.0, BACK + 5.9);
    let tops = shelves::bookshelf(stage, shelf, walnut, 40.0, 5);
    let mut books = shelves::Books::default();
    for (k, &y) in tops.iter().enumerate() {
        let length = [36.0, 30.0, 36.0, 22.0, 36.0][k];
        books.row(shelf.shift(-18.4, y, 4.6), length, 12.6, 60 + k as u32);
    }
    books.finish(stage);
    let rust = stage.paint("rust-glaze", 0x9C4B2E, Finish::Gloss);
    ceramics::vase(stage, shelf.shift(11.5, tops[3], 0.0), rust, VaseShape::Moon, 8.5);
}
