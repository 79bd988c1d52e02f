//! Fruit.

use crate::builtin::build::{
    Dice, Ends, Finish, LeafShape, Part, Place, Stage, ball, curve, leaf, profile, revolve, tube,
};

/// An apple of this radius with its stalk.
pub fn apple(stage: &mut Stage, place: Place, radius: f32, red: bool) {
    let outline = profile(
        &[[0.0, 0.12], [0.4, 0.0], [0.85, 0.45], [1.0, 1.0], [0.8, 1.5], [0.4, 1.66], [0.0, 1.4]]
            .map(|p| p.map(|x| x * radius)),
        2,
    );
    let skin = if red {
        stage.paint("apple-red", 0xA8231C, Finish::Gloss)
    } else {
        stage.paint("apple-green", 0x93A83A, Finish::Gloss)
    };
    stage.mesh("apple", skin, revolve(&outline, 16).placed(place));
    stalk(stage, place.shift(0.0, 1.38 * radius, 0.0), 0.5 * radius);
}

/// A pear of this radius.
pub fn pear(stage: &mut Stage, place: Place, radius: f32) {
    let outline = profile(
        &[[0.0, 0.08], [0.45, 0.0], [0.95, 0.55], [0.92, 1.1], [0.55, 1.75], [0.38, 2.3], [0.0, 2.55]]
            .map(|p| p.map(|x| x * radius)),
        2,
    );
    let skin = stage.paint("pear", 0xC2B23F, Finish::Satin(0.3));
    stage.mesh("pear", skin, revolve(&outline, 16).placed(place));
    stalk(stage, place.shift(0.0, 2.5 * radius, 0.0), 0.6 * radius);
}

/// An orange of this radius.
pub fn orange(stage: &mut Stage, place: Place, radius: f32) {
    let skin = stage.paint("orange", 0xD9761A, Finish::Satin(0.35));
    stage.mesh("orange", skin, revolve(&ball(radius, radius, 10), 18).placed(place));
}

/// Bananas in a hand of three, lying.
pub fn bananas(stage: &mut Stage, place: Place, length: f32) {
    let skin = stage.paint("banana", 0xDDBB3C, Finish::Satin(0.35));
    let path = curve(
        &[[-0.5, 0.12, 0.0], [-0.28, 0.08, 0.12], [0.0, 0.08, 0.18], [0.28, 0.08, 0.12], [0.5, 0.16, -0.06]]
            .map(|p| p.map(|x| x * length)),
        3,
    );
    let one = tube(&path, 8, Ends::Flat, |s| {
        let end = (2.0 * s - 1.0).abs();
        length * (0.085 - 0.06 * end * end * end * end)
    });
    let mut hand = Part::default();
    for k in 0..3 {
        let k = k as f32;
        hand.add(one.clone().placed(place.yaw(9.0 * k).shift(0.0, 0.02 * length * k, 0.13 * length * k)));
    }
    stage.mesh("bananas", skin, hand);
}

/// A bunch of grapes that fills a lying pear shape of this length along x.
pub fn grapes(stage: &mut Stage, place: Place, length: f32) {
    let skin = stage.paint("grape", 0x4B2748, Finish::Gloss);
    let radius = 0.11 * length;
    let berry = revolve(&ball(radius, 0.0, 5), 7);
    let mut bunch = Part::default();
    let mut dice = Dice::new(31, 0);
    for (ring, (x, count, spread)) in
        [(-0.4, 3, 0.6), (-0.22, 6, 1.5), (0.0, 8, 2.0), (0.2, 6, 1.7), (0.38, 3, 0.8)].into_iter().enumerate()
    {
        for k in 0..count {
            let turn = 360.0 * (k as f32 + 0.5 * ring as f32) / count as f32 + dice.between(-9.0, 9.0);
            let at = place.shift(x * length, 1.6 * radius, 0.0).pitch(turn).shift(
                dice.between(-0.04, 0.04) * length,
                0.5 * spread * radius,
                0.0,
            );
            bunch.add(berry.clone().placed(at));
        }
    }
    stage.mesh("grapes", skin, bunch);
}

fn stalk(stage: &mut Stage, place: Place, length: f32) {
    let bark = stage.paint("bark", 0x5A4028, Finish::Matte);
    let path = curve(&[[0.0, -0.2 * length, 0.0], [0.05 * length, 0.4 * length, 0.0], [0.25 * length, length, 0.0]], 2);
    stage.mesh("stalk", bark, tube(&path, 5, Ends::Flat, |s| length * (0.07 + 0.05 * s)).placed(place));
    let green = stage.paint("fruit-leaf", 0x4E6B2A, Finish::Satin(0.4));
    let shape = LeafShape { length: 1.3 * length, width: 0.6 * length, widest: 0.45, droop: 40.0, fold: 15.0 };
    stage.mesh(
        "fruit-leaf",
        green,
        leaf(shape, 12).placed(place.shift(0.03 * length, 0.3 * length, 0.0).yaw(60.0).pitch(-20.0)),
    );
}

/// A bowl's worth of mixed fruit around the place's origin, inside a circle of this radius.
pub fn heap(stage: &mut Stage, place: Place, radius: f32) {
    let r = 0.27 * radius;
    apple(stage, place.shift(-0.42 * radius, 0.0, 0.2 * radius).roll(12.0), r, true);
    apple(stage, place.shift(0.08 * radius, 0.0, 0.5 * radius).pitch(14.0), r, false);
    orange(stage, place.shift(0.5 * radius, 0.02 * radius, 0.12 * radius), 1.05 * r);
    orange(stage, place.shift(0.02 * radius, -0.05 * radius, -0.08 * radius), 1.05 * r);
    pear(stage, place.shift(-0.25 * radius, 0.1 * radius, -0.5 * radius).roll(24.0), 0.9 * r);
    apple(stage, place.shift(0.34 * radius, 0.0, -0.45 * radius).roll(-10.0), r, true);
    bananas(stage, place.shift(-0.05 * radius, 0.47 * radius, 0.1 * radius).yaw(25.0), 1.35 * radius);
    grapes(stage, place.shift(0.28 * radius, 0.4 * radius, 0.3 * radius).yaw(-35.0).roll(-12.0), 0.8 * radius);
}
