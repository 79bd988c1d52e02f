//! Lamps: each a body, a shade that glows and a bulb that shines.

use crate::builtin::build::{Ends, Finish, Part, Place, Stage, ball, curve, linear, profile, revolve, tube};
use photinus_geometry::Vec3;

/// The colour of lamp light, over its largest channel.
const WARM: [f32; 3] = [1.0, 0.78, 0.5];

fn warm(radiance: f32) -> [f32; 3] {
    WARM.map(|c| c * radiance)
}

/// A conical shade around a bulb: radii below and above, height; the bulb is inside. Both are lamps, of these radiances:
/// cloth lets about a hundredth of a bulb's light through, thin paper around a weak bulb more.
fn shade_and_bulb(stage: &mut Stage, place: Place, radii: [f32; 2], height: f32, [bulb, glow]: [f32; 2]) {
    let cloth = stage.paint("lampshade", 0xE9DCC0, Finish::Matte);
    let [low, high] = radii;
    let wall = 0.25;
    let outline = [
        [low, 0.0],
        [0.5 * (low + high), 0.5 * height],
        [high, height],
        [high - wall, height],
        [0.5 * (low + high) - wall, 0.5 * height],
        [low - wall, 0.0],
        [low, 0.0],
    ];
    stage.lamp("lampshade", cloth, revolve(&outline, 32).placed(place), warm(glow));
    let black = stage.paint("bulb", 0x000000, Finish::Matte);
    let size = 0.16 * (low + high);
    let glass = revolve(&ball(size, 0.45 * height, 8), 12);
    stage.lamp("bulb", black, glass.placed(place), warm(bulb));
}

/// A standing lamp, 64 units high; radiances of its bulb and its shade.
pub fn floor_lamp(stage: &mut Stage, place: Place, radiance: [f32; 2]) {
    let brass = stage.brass();
    let base = profile(&[[7.0, 0.0], [7.0, 0.6], [4.0, 1.2], [1.1, 2.0], [0.55, 3.6]], 3);
    let mut outline = vec![[0.0, 0.0]];
    outline.extend(base);
    outline.extend([
        [0.5, 20.0],
        [0.9, 20.6],
        [0.9, 21.6],
        [0.5, 22.2],
        [0.45, 48.0],
        [0.9, 48.6],
        [0.7, 50.4],
        [0.0, 50.4],
    ]);
    stage.mesh("floor-lamp", brass, revolve(&outline, 24).placed(place));
    shade_and_bulb(stage, place.shift(0.0, 48.0, 0.0), [9.0, 6.0], 14.0, radiance);
}

/// A table lamp on a glazed foot, 22 units high; radiances of its bulb and its shade.
pub fn table_lamp(stage: &mut Stage, place: Place, color: u32, radiance: [f32; 2]) {
    let glaze = stage.paint(&format!("glaze-{color:06x}"), color, Finish::Gloss);
    let mut outline = vec![[0.0, 0.0], [2.6, 0.0]];
    outline.extend(profile(&[[2.6, 0.5], [2.1, 1.0], [3.3, 3.6], [3.6, 5.8], [2.4, 8.6], [0.8, 10.4], [0.7, 11.6]], 3));
    outline.push([0.0, 11.6]);
    stage.mesh("table-lamp", glaze, revolve(&outline, 24).placed(place));
    let brass = stage.brass();
    let stem = revolve(&[[0.0, 11.4], [0.35, 11.4], [0.35, 14.6], [0.0, 14.6]], 10);
    stage.mesh("table-lamp-stem", brass, stem.placed(place));
    shade_and_bulb(stage, place.shift(0.0, 11.8, 0.0), [6.6, 4.4], 9.6, radiance);
}

/// A flat drum under the ceiling at the place's origin: a ring of brass around glowing glass.
pub fn ceiling_lamp(stage: &mut Stage, place: Place, radius: f32, radiance: f32) {
    let brass = stage.brass();
    let rim = [[radius, -2.2], [radius + 0.5, -2.2], [radius + 0.5, 0.0], [radius, 0.0], [radius, -2.2]];
    stage.mesh("ceiling-lamp", brass, revolve(&rim, 40).placed(place));
    let glass = stage.diffuse("opal-glass", linear(0xF2EADC));
    let dome = profile(&[[0.0, -3.6], [0.6 * radius, -3.2], [radius - 0.02, -1.8]], 4);
    stage.lamp("opal-glass", glass, revolve(&dome, 40).placed(place), warm(radiance));
}

/// A globe of opal glass on a brass rod: the place's origin is where the rod leaves the ceiling, the globe's middle
/// `drop` below it. It lights walls and ceiling as much as the floor.
pub fn globe_lamp(stage: &mut Stage, place: Place, drop: f32, radius: f32, radiance: f32) {
    let brass = stage.brass();
    let top = radius - drop;
    let outline = [
        [0.0, top - 0.4],
        [0.34 * radius, top - 0.4],
        [0.34 * radius, top + 0.2],
        [0.4, top + 1.0],
        [0.35, -1.4],
        [2.6, -0.7],
        [3.0, 0.0],
        [0.0, 0.0],
    ];
    stage.mesh("globe-rod", brass, revolve(&outline, 20).placed(place));
    let glass = stage.paint("opal-glass", 0xF2EADC, Finish::Matte);
    stage.lamp("opal-glass", glass, revolve(&ball(radius, -drop, 14), 28).placed(place), warm(radiance));
}

/// A pendant over a table: cord, metal shade and bulb; the place's origin is where the cord leaves the ceiling.
pub fn pendant(stage: &mut Stage, place: Place, drop: f32, color: u32, radiance: f32) {
    let cord = stage.paint("cord", 0x2B2826, Finish::Matte);
    let path = [Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.0, -0.5 * drop, 0.0), Vec3::new(0.0, 6.4 - drop, 0.0)];
    let rose = revolve(&[[0.0, -1.4], [0.5, -1.4], [2.2, -0.5], [2.4, 0.0], [0.0, 0.0]], 16);
    stage.mesh("cord", cord, rose.and(tube(&path, 6, Ends::Open, |_| 0.12)).placed(place));
    let enamel = stage.paint(&format!("enamel-{color:06x}"), color, Finish::Gloss);
    let outer = profile(&[[9.0, 0.0], [8.6, 1.6], [6.6, 4.4], [2.6, 6.4], [0.9, 7.2], [0.7, 8.6]], 3);
    let mut outline = outer.clone();
    outline.push([0.0, 8.6]);
    // Open below: the inside is the outside moved in.
    let mut inside: Vec<[f32; 2]> = vec![[0.0, 6.4]];
    inside.extend(outer.iter().rev().filter(|p| p[1] < 6.2).map(|p| [p[0] - 0.3, p[1]]));
    inside.extend(outline);
    stage.mesh("pendant", enamel, revolve(&inside, 32).placed(place.shift(0.0, -drop, 0.0)));
    let black = stage.paint("bulb", 0x000000, Finish::Matte);
    stage.lamp("bulb", black, revolve(&ball(1.6, 3.6, 8), 12).placed(place.shift(0.0, -drop, 0.0)), warm(radiance));
}

/// A desk lamp: heavy foot, two arms, a conical metal head that looks down along +x.
pub fn desk_lamp(stage: &mut Stage, place: Place, color: u32, radiance: f32) {
    let enamel = stage.paint(&format!("enamel-{color:06x}"), color, Finish::Gloss);
    let steel = stage.steel();
    let foot = profile(&[[4.2, 0.0], [4.2, 0.6], [3.4, 1.2], [0.8, 1.8], [0.6, 2.6]], 2);
    let mut outline = vec![[0.0, 0.0]];
    outline.extend(foot);
    outline.push([0.0, 2.6]);
    stage.mesh("desk-lamp", enamel, revolve(&outline, 24).placed(place));
    let arm = curve(&[[0.0, 2.4, 0.0], [-4.4, 12.0, 0.0], [-1.0, 20.5, 0.0], [6.5, 22.0, 0.0]], 3);
    stage.mesh("desk-lamp-arm", steel, tube(&arm, 8, Ends::Flat, |_| 0.36).placed(place));
    let head = place.shift(8.4, 20.8, 0.0).roll(32.0);
    let mut cone: Vec<[f32; 2]> = vec![[0.0, 3.2], [1.1, 3.1]];
    cone.extend([[4.3, -2.6], [4.55, -2.6], [1.4, 3.5], [0.8, 5.0], [0.0, 5.2]]);
    stage.mesh("desk-lamp-head", enamel, revolve(&cone, 28).placed(head));
    let black = stage.paint("bulb", 0x000000, Finish::Matte);
    stage.lamp("bulb", black, revolve(&ball(1.15, 1.1, 8), 12).placed(head), warm(radiance));
}

/// A candlestick with a burning candle.
pub fn candle(stage: &mut Stage, place: Place, height: f32, radiance: f32) {
    let brass = stage.brass();
    let stick = profile(
        &[
            [2.4, 0.0],
            [2.2, 0.5],
            [0.7, 1.3],
            [0.55, 0.45 * height],
            [0.9, 0.52 * height],
            [0.6, 0.6 * height],
            [1.5, 0.66 * height],
        ],
        2,
    );
    let mut outline = vec![[0.0, 0.0]];
    outline.extend(stick);
    outline.push([0.0, 0.66 * height]);
    stage.mesh("candlestick", brass, revolve(&outline, 18).placed(place));
    let wax = stage.paint("wax", 0xEFE6CF, Finish::Satin(0.3));
    let body = [[0.6, 0.66 * height], [0.6, 0.985 * height], [0.5, height], [0.0, 0.992 * height]];
    stage.mesh("candle", wax, revolve(&body, 14).placed(place));
    let black = stage.paint("bulb", 0x000000, Finish::Matte);
    let flame: Part = revolve(&[[0.0, 0.0], [0.2, 0.3], [0.24, 0.7], [0.12, 1.3], [0.0, 1.9]], 8);
    stage.lamp("flame", black, flame.placed(place.shift(0.0, height + 0.2, 0.0)), warm(radiance));
}
