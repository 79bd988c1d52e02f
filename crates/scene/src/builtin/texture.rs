//! Textured models of exactly 10, 1210 and 7590 triangles: they prove barycentric coordinates by eye.

use super::build::{
    Finish, Join, Part, Place, Stage, bitmap, bitmap::hex, camera, film, linear, patch, sin_cos_degrees, standing,
};
use super::furniture::{ceramics, ceramics::VaseShape, fruit, plants};
use crate::{EnvironmentLight, Light, Scene};
use photinus_geometry::Vec3;

/// Two textured pyramids on a chequered square: 4 + 4 + 2 triangles.
pub fn pyramids() -> Scene {
    let mut stage = Stage::default();
    let floor =
        stage.printed("chequers", [8.0, 8.0], Finish::Matte, || bitmap::checker(1, 8, hex(0xE8E2D4), hex(0x6E7F86)));
    stage.mesh("floor", floor, sheet(60.0, 11.5));
    let bricks = stage.printed("bricks", [3.0, 3.0], Finish::Matte, || bitmap::brick(2, hex(0xC06A45), hex(0xCFC6B6)));
    stage.mesh("brick-pyramid", bricks, pyramid(5.0, 4.6).placed(Place::at(-1.6, 0.0, -0.8).yaw(28.0)));
    let marble = stage.printed("marble", [3.0, 3.0], Finish::Matte, || bitmap::marble(3, hex(0xEDEBE6), hex(0x3F5A63)));
    stage.mesh("marble-pyramid", marble, pyramid(2.6, 2.4).placed(Place::at(2.9, 0.0, 2.0).yaw(-20.0)));
    daylight(&mut stage, [7.0, 11.0, 5.0], 1.6, 26.0);
    stage.finish(camera([2.5, 6.2, 12.0], [0.3, 1.2, 0.2], 41.0), film(512, 512), None)
}

/// Vases on a marble plinth, one with a sprig of leaves.
pub fn vases() -> Scene {
    let mut stage = Stage::default();
    let floor =
        stage.printed("chequers", [8.0, 8.0], Finish::Matte, || bitmap::checker(1, 4, hex(0xD9CDB8), hex(0x9C5B45)));
    stage.mesh("floor", floor, sheet(120.0, 7.6));
    let stone =
        stage.printed("marble", [12.0, 12.0], Finish::Satin(0.2), || bitmap::marble(4, hex(0xE9E6E0), hex(0x6A6F78)));
    stage.mesh("plinth", stone, standing([18.0, 3.0, 10.0], 0.4));

    let mut pot = |name: &str, shape, height: f32, place: Place, segments, picture: std::sync::Arc<crate::Bitmap>| {
        let glaze = stage.printed(name, [0.5, 0.5], Finish::Gloss, || picture);
        stage.mesh(name, glaze, ceramics::vase_part(shape, height, 1, segments).placed(place));
    };
    pot(
        "amphora",
        VaseShape::Amphora,
        9.5,
        Place::at(-0.5, 3.0, -1.2),
        14,
        bitmap::stripes(5, 4, hex(0xD8B98A), hex(0x7A3B22), hex(0x2E2A28)),
    );
    pot(
        "moon-vase",
        VaseShape::Moon,
        4.4,
        Place::at(-5.6, 3.0, 1.2),
        11,
        bitmap::marble(6, hex(0xDCE6EA), hex(0x1F4F86)),
    );
    pot("bottle", VaseShape::Bottle, 6.2, Place::at(5.4, 3.0, 0.9), 11, bitmap::circles(7));

    let sprig = Place::at(-0.5, 12.0, -1.2);
    let missing = stage.missing_to(1210);
    plants::sprig(&mut stage, sprig, 4, 5.0, missing);
    daylight(&mut stage, [16.0, 26.0, 18.0], 4.0, 26.0);
    stage.finish(camera([4.0, 13.0, 30.0], [0.0, 8.6, 0.0], 37.0), film(512, 512), None)
}

/// A tea table with a draped cloth, a pot, cups, fruit and a vase of leaves.
pub fn tea_table() -> Scene {
    let mut stage = Stage::default();
    let floor =
        stage.printed("boards", [48.0, 48.0], Finish::Satin(0.3), || bitmap::planks(8, hex(0xB88A5A), hex(0x80552F)));
    stage.mesh("floor", floor, sheet(1600.0, 13.5));
    let cloth =
        stage.printed("cloth", [0.125, 0.25], Finish::Matte, || bitmap::checker(9, 4, hex(0xF0ECE2), hex(0x5F86A3)));
    stage.mesh("cloth", cloth, table_cloth(15.0, 20.0, 7.5));

    let glaze =
        stage.printed("blue-marble", [0.5, 0.5], Finish::Gloss, || bitmap::marble(6, hex(0xE4ECEF), hex(0x2A5C93)));
    stage.mesh("teapot", glaze, ceramics::teapot_part(3.2, 2, 20, 7).placed(Place::at(-4.2, 20.0, -1.0).yaw(-18.0)));
    ceramics::cup(&mut stage, Place::at(-2.8, 20.0, 6.4).yaw(-50.0), glaze, 1.5);
    ceramics::cup(&mut stage, Place::at(6.2, 20.0, 6.0).yaw(20.0), glaze, 1.5);
    let plate = stage.printed("plate", [0.25, 1.0], Finish::Gloss, || {
        bitmap::stripes(10, 2, hex(0xEFEBE2), hex(0xC77B5A), hex(0x3F6B6B))
    });
    ceramics::plate(&mut stage, Place::at(2.2, 20.0, 8.6), plate, 2.4);
    fruit::orange(&mut stage, Place::at(1.6, 20.2, 8.4), 0.95);
    fruit::apple(&mut stage, Place::at(3.1, 20.2, 9.1), 0.85, true);
    let bottle = stage.printed("bottle", [0.5, 0.5], Finish::Gloss, || {
        bitmap::stripes(5, 3, hex(0xD8B98A), hex(0x7A3B22), hex(0x2E2A28))
    });
    stage.mesh("vase", bottle, ceramics::vase_part(VaseShape::Bottle, 9.0, 2, 20).placed(Place::at(4.6, 20.0, -3.4)));
    let mouth = Place::at(4.6, 28.3, -3.4);
    plants::daisies(&mut stage, mouth, 5, 7.5);
    let missing = stage.missing_to(7590);
    plants::sprig(&mut stage, mouth, 9, 6.5, missing);
    daylight(&mut stage, [34.0, 62.0, 40.0], 8.0, 30.0);
    stage.finish(camera([10.5, 38.0, 43.0], [0.2, 20.0, 0.0], 45.0), film(512, 512), None)
}

/// A square of this side on the ground, turned so that its far edge is a level horizon for a camera that looks in from
/// that many degrees to the right; texture coordinates are in scene units.
fn sheet(side: f32, turn: f32) -> Part {
    let h = 0.5 * side;
    let corners = [[-h, h], [h, h], [h, -h], [-h, -h]];
    let mut part = Part::default();
    part.quad(corners.map(|[x, z]| Vec3::new(x, 0.0, z)), corners.map(|[x, z]| [x, -z]));
    part.placed(Place::HERE.yaw(turn))
}

/// The four sides of a square pyramid on the ground, with texture coordinates in scene units on every side.
fn pyramid(base: f32, height: f32) -> Part {
    let h = 0.5 * base;
    let slant = (height * height + h * h).sqrt();
    let mut part = Part::default();
    for k in 0..4 {
        let place = Place::HERE.yaw(90.0 * k as f32);
        let corners =
            [Vec3::new(-h, 0.0, h), Vec3::new(h, 0.0, h), Vec3::new(0.0, height, 0.0)].map(|p| place.point(p));
        let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let uvs = [[0.0, 0.0], [base, 0.0], [h, slant]];
        let v = [0, 1, 2].map(|i| part.vertex(corners[i], n / n.length(), uvs[i]));
        part.triangle(v[0], v[1], v[2]);
    }
    part
}

/// A cloth over a round table of this radius and height that hangs down by `drop` in folds.
fn table_cloth(radius: f32, height: f32, drop: f32) -> Part {
    patch(54, 14, Join::U, |u, v| {
        let (sin, cos) = sin_cos_degrees(360.0 * u);
        let s = (1.0 - v) * 14.0;
        // Five rows lie on the table, the next bends over its edge, the others hang.
        let (reach, low) = if s <= 5.0 { (s / 5.0, 0.0) } else { (1.0 + 0.014 * (s - 5.0), (s - 5.0) / 9.0) };
        let (wave, _) = sin_cos_degrees(360.0 * 9.0 * u + 40.0 * low);
        let r = radius * (reach + 0.075 * wave * low * (2.0 - low));
        let soft = low * low / (low + 0.06);
        Vec3::new(r * cos, height - drop * soft, -r * sin)
    })
}

/// A spherical lamp and a pale sky.
fn daylight(stage: &mut Stage, lamp: [f32; 3], radius: f32, radiance: f32) {
    let black = stage.diffuse("lamp", [0.0; 3]);
    stage.sphere("lamp", black, lamp, radius);
    stage.light_last([radiance, 0.93 * radiance, 0.8 * radiance]);
    stage.light(Light::Environment(EnvironmentLight::Constant(Vec3::from(linear(0xB4C6D8)) * 0.8)));
}
