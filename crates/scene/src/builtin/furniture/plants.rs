//! Plants, each of exactly as many triangles as asked for: what pots and stems leave over goes into the leaves.

use crate::MaterialId;
use crate::builtin::build::{
    Dice, Ends, Finish, LeafShape, Part, Place, Stage, bitmap, bitmap::hex, blade, curve, hollow, leaf, petal, profile,
    revolve, shares, tube,
};
use photinus_geometry::Vec3;

/// Degrees between consecutive leaves of a spiral: the golden angle.
const GOLDEN_ANGLE: f32 = 137.508;

/// Direction of item `k` within `arc` degrees around a plant's front: plants that stand at walls grow away from them.
fn around(k: usize, arc: f32) -> f32 {
    let turn = GOLDEN_ANGLE * k as f32 / 360.0 + 0.5;
    arc * (turn - turn.floor() - 0.5)
}

/// A pot of earth on the place's origin.
pub fn pot(stage: &mut Stage, place: Place, radius: f32, height: f32, glaze: MaterialId) {
    let outer = profile(
        &[[0.7, 0.0], [0.78, 0.1], [0.92, 0.6], [1.0, 0.9], [1.04, 1.0]]
            .map(|p: [f32; 2]| [p[0] * radius, p[1] * height]),
        2,
    );
    stage.mesh("pot", glaze, revolve(&hollow(&outer, 0.07 * radius, 0.55 * height), 24).placed(place));
    let earth = stage.paint("earth", 0x3A2B20, Finish::Matte);
    let heap = [[0.94 * radius, 0.8 * height], [0.5 * radius, 0.85 * height], [0.0, 0.86 * height]];
    stage.mesh("earth", earth, revolve(&heap, 20).placed(place));
}

/// A pot on three cords from a hook in the ceiling; gives the place of its earth.
pub fn hanging_pot(stage: &mut Stage, hook: Place, drop: f32) -> Place {
    let grey = stage.paint("grey-glaze", 0x7E8583, Finish::Gloss);
    let bottom = hook.shift(0.0, -drop, 0.0);
    pot(stage, bottom, 5.2, 8.0, grey);
    let cord = stage.paint("cord", 0x2B2826, Finish::Matte);
    let mut cords = Part::default();
    for k in 0..3 {
        let rim = Place::HERE.yaw(120.0 * k as f32).point(Vec3::new(0.0, 8.0 - drop, 5.1));
        let top = Vec3::Y * -0.2;
        cords.add(tube(&[rim, (rim + top) * 0.5, top], 4, Ends::Open, |_| 0.12));
    }
    stage.mesh("cord", cord, cords.placed(hook));
    bottom.shift(0.0, 6.6, 0.0)
}

/// Spreads `triangles` over leaves at these places, or over evenly chosen ones where there are too many places for
/// leaves of four triangles.
fn leaves(spots: &[Place], shapes: impl Fn(usize) -> LeafShape, triangles: usize) -> Part {
    let used = spots.len().min(triangles / 4);
    let mut part = Part::default();
    for (i, count) in shares(triangles, used).enumerate() {
        let spot = i * spots.len() / used;
        part.add(leaf(shapes(spot), count).placed(spots[spot]));
    }
    part
}

/// A rubber plant: upright stems with large glossy leaves in spirals.
pub fn rubber_plant(stage: &mut Stage, place: Place, height: f32, triangles: usize, seed: u32) {
    let stems = 3;
    let mut wood = Part::default();
    let mut spots = Vec::new();
    let count = triangles / 16;
    for k in 0..stems {
        let mut dice = Dice::new(101 + u64::from(seed), k);
        let at = place.yaw(120.0 * k as f32 + 30.0).pitch(dice.between(5.0, 11.0));
        let reach = height * dice.between(0.8, 1.0);
        let path = curve(&[[0.0, 0.0, 0.0], [0.5, 0.35 * reach, 0.4], [-0.3, 0.7 * reach, 0.0], [0.2, reach, 0.6]], 3);
        wood.add(tube(&path, 7, Ends::Flat, |s| height * (0.014 - 0.009 * s)).placed(at));
        for (j, _) in shares(count, stems as usize).nth(k as usize).map_or(0..0, |n| 0..n).enumerate() {
            let s = 0.22 + 0.78 * (j as f32 + 0.5) * stems as f32 / count as f32;
            let lift = dice.between(12.0, 32.0) + 34.0 * s;
            spots.push(at.shift(0.0, reach * s.min(1.0), 0.0).yaw(GOLDEN_ANGLE * j as f32).pitch(-lift).shift(
                0.0,
                0.0,
                0.02 * height,
            ));
        }
    }
    let bark = stage.paint("bark", 0x5A4028, Finish::Matte);
    let green = stage.paint("rubber-leaf", 0x38602F, Finish::Satin(0.28));
    let left = triangles.saturating_sub(wood.triangle_count());
    stage.mesh("stems", bark, wood.placed(Place::HERE));
    let foliage = leaves(
        &spots,
        |i| {
            let mut dice = Dice::new(111 + u64::from(seed), i as u32);
            let length = height * dice.between(0.17, 0.24);
            LeafShape { length, width: 0.46 * length, widest: 0.48, droop: dice.between(35.0, 75.0), fold: 13.0 }
        },
        left,
    );
    stage.mesh("rubber-leaves", green, foliage);
}

/// How fronds stand and what they carry.
#[derive(Clone, Copy, Debug)]
pub struct Fronds {
    /// How many.
    pub count: usize,
    /// Length of the longest.
    pub length: f32,
    /// Rise at the base over the horizontal, degrees.
    pub rise: f32,
    /// How far the tip bends down from there, degrees.
    pub droop: f32,
    /// Length of a leaflet over that of its frond.
    pub leaflet: f32,
    /// Width of a leaflet over its length.
    pub slender: f32,
    /// Degrees around the place's front that they grow in; 360: all around.
    pub arc: f32,
    /// Chart colour.
    pub color: u32,
}

/// A kentia palm: long fronds with long narrow leaflets that arch from the ground.
pub const KENTIA: Fronds = Fronds {
    count: 13,
    length: 92.0,
    rise: 84.0,
    droop: 95.0,
    leaflet: 0.5,
    slender: 0.035,
    arc: 200.0,
    color: 0x4C7A38,
};

/// A plant of fronds around the place's origin, where the earth is.
pub fn fronds(stage: &mut Stage, place: Place, kind: Fronds, triangles: usize, seed: u32) {
    let rib_triangles = kind.count * 60;
    let pairs = (triangles.saturating_sub(rib_triangles) / (kind.count * 2 * 7)).max(4);
    let mut ribs = Part::default();
    let (mut spots, mut lengths) = (Vec::new(), Vec::new());
    for k in 0..kind.count {
        let mut dice = Dice::new(121 + u64::from(seed), k as u32);
        let inner = k as f32 / kind.count as f32;
        let length = kind.length * (0.72 + 0.28 * inner) * dice.between(0.9, 1.0);
        let rise = kind.rise - 32.0 * (1.0 - inner) + dice.between(-6.0, 6.0);
        let at = place.yaw(around(k, kind.arc)).shift(0.0, 0.0, 0.015 * kind.length);
        // An arc in the yz plane, by its turning direction.
        let pieces = 10;
        let mut path = vec![Vec3::ZERO];
        let mut directions = Vec::new();
        for i in 0..pieces {
            let s = (i as f32 + 0.5) / pieces as f32;
            let (sin, cos) = crate::builtin::build::sin_cos_degrees(rise - kind.droop * s * s);
            directions.push(Vec3::new(0.0, sin, cos));
            path.push(path[i] + directions[i] * (length / pieces as f32));
        }
        ribs.add(tube(&path, 3, Ends::Open, |s| kind.length * (0.009 - 0.0065 * s)).placed(at));
        for j in 0..pairs {
            let s = 0.2 + 0.79 * (j as f32 + 0.5) / pairs as f32;
            let (i, t) = (((s * pieces as f32) as usize).min(pieces - 1), s * pieces as f32);
            let p = path[i] + (path[i + 1] - path[i]) * (t - i as f32);
            for side in [-1.0f32, 1.0] {
                let forward =
                    directions[i] * (0.35 + 0.75 * s * s) + Vec3::X * side + Vec3::Y * dice.between(-0.22, 0.04);
                spots.push(Place::facing(p, forward, Vec3::X.cross(directions[i]) * -1.0).within(at));
                lengths.push(length * kind.leaflet * (1.0 - 0.72 * (s - 0.35).abs()));
            }
        }
    }
    let name = format!("frond-{:06x}", kind.color);
    let green = stage.paint(&name, kind.color, Finish::Satin(0.35));
    let left = triangles.saturating_sub(ribs.triangle_count());
    let leaflet = |i: usize| LeafShape {
        length: lengths[i],
        width: kind.slender * lengths[i],
        widest: 0.35,
        droop: 30.0,
        fold: 10.0,
    };
    ribs.add(leaves(&spots, leaflet, left));
    stage.mesh("fronds", green, ribs);
}

/// A tuft of grass-like blades that hang over (spider plant).
pub fn tuft(stage: &mut Stage, place: Place, length: f32, count: usize, triangles: usize, seed: u32) {
    let green = stage.paint("tuft", 0x86AC5A, Finish::Satin(0.4));
    let mut part = Part::default();
    for (k, share) in shares(triangles, count).enumerate() {
        let mut dice = Dice::new(141 + u64::from(seed), k as u32);
        let shape = LeafShape {
            length: length * dice.between(0.6, 1.0),
            width: 0.055 * length,
            widest: 0.4,
            droop: dice.between(70.0, 140.0),
            fold: 0.0,
        };
        let at = place.yaw(GOLDEN_ANGLE * k as f32).shift(0.0, 0.0, 0.02 * length).pitch(-dice.between(35.0, 80.0));
        part.add(blade(shape, share).placed(at));
    }
    stage.mesh("tuft", green, part);
}

/// Fountain grass: a clump of long narrow blades within `arc` degrees around the place's front, upright at the sides and
/// arching over in front.
pub fn grass(stage: &mut Stage, place: Place, [length, arc]: [f32; 2], triangles: usize, seed: u32) {
    let green = stage.paint("grass", 0x86A05A, Finish::Satin(0.4));
    let mut part = Part::default();
    for (k, share) in shares(triangles, triangles / 2).enumerate() {
        let mut dice = Dice::new(191 + u64::from(seed), k as u32);
        let shape = LeafShape {
            length: length * dice.between(0.55, 1.0),
            width: 0.009 * length,
            widest: 0.4,
            droop: dice.between(40.0, 120.0),
            fold: 0.0,
        };
        let at = place.yaw(around(k, arc)).shift(0.0, 0.0, dice.between(0.0, 0.1) * length);
        part.add(blade(shape, share).placed(at.pitch(-dice.between(45.0, 86.0)).roll(dice.between(-20.0, 20.0))));
    }
    stage.mesh("grass", green, part);
}

/// A trailing plant: vines that run over the pot's rim at `radius` and hang down by up to `drop`.
pub fn ivy(stage: &mut Stage, place: Place, radius: f32, drop: f32, vines: usize, triangles: usize, seed: u32) {
    let mut stems = Part::default();
    let mut spots = Vec::new();
    let per_vine = (triangles / (vines * 12)).max(4);
    for k in 0..vines {
        let mut dice = Dice::new(151 + u64::from(seed), k as u32);
        let at = place.yaw(360.0 / vines as f32 * k as f32 + dice.between(-12.0, 12.0));
        let fall = drop * dice.between(0.45, 1.0);
        let (a, b) = (dice.between(-1.6, 1.6), dice.between(-1.6, 1.6));
        let path = curve(
            &[
                [0.0, 0.0, 0.2 * radius],
                [0.0, 1.6, 0.75 * radius],
                [0.0, 0.6, 1.2 * radius],
                [a, -0.5 * fall, 1.35 * radius],
                [b, -fall, 1.25 * radius],
            ],
            4,
        );
        stems.add(tube(&path, 3, Ends::Open, |s| 0.16 - 0.1 * s).placed(at));
        for j in 0..per_vine {
            let t = (j as f32 + 0.5) / per_vine as f32 * (path.len() - 1) as f32;
            let i = (t as usize).min(path.len() - 2);
            let p = path[i] + (path[i + 1] - path[i]) * (t - i as f32);
            let side = if j % 2 == 0 { 1.0 } else { -1.0 };
            let forward = Vec3::new(side * dice.between(0.5, 1.1), dice.between(-0.9, -0.1), dice.between(0.3, 1.0));
            spots.push(Place::facing(p, forward, Vec3::new(0.0, 0.8, 0.9)).within(at));
        }
    }
    let green = stage.paint("ivy", 0x4F7F3C, Finish::Satin(0.3));
    let left = triangles.saturating_sub(stems.triangle_count());
    let foliage = leaves(
        &spots,
        |i| {
            let length = Dice::new(152, i as u32).between(1.9, 3.0);
            LeafShape { length, width: 0.85 * length, widest: 0.34, droop: 30.0, fold: 14.0 }
        },
        left,
    );
    stage.mesh("ivy", green, stems.and(foliage));
}

/// Bamboo in a pot: upright canes that arch out at the top, with sprays of narrow leaves that hang from thin twigs.
/// They lean out by up to `spread` at the top, within `arc` degrees around the place's front.
pub fn bamboo(stage: &mut Stage, place: Place, [spread, height, arc]: [f32; 3], triangles: usize, seed: u32) {
    let canes = 7;
    let mut wood = Part::default();
    let mut spots = Vec::new();
    let sprays = (triangles.saturating_sub(canes * 72) / (canes * 15)).max(2);
    for k in 0..canes {
        let mut dice = Dice::new(181 + u64::from(seed), k as u32);
        let at = place.yaw(around(k, arc)).shift(0.0, 0.0, dice.between(0.01, 0.05) * height);
        let (reach, lean) = (height * dice.between(0.72, 1.0), spread * dice.between(0.4, 1.0));
        let path = curve(
            &[[0.0, 0.0, 0.0], [0.0, 0.45 * reach, 0.12 * lean], [0.0, 0.8 * reach, 0.45 * lean], [0.0, reach, lean]],
            3,
        );
        wood.add(tube(&path, 4, Ends::Open, |s| height * (0.009 - 0.006 * s)).placed(at));
        for j in 0..sprays {
            let up = 0.22 + 0.78 * (j as f32 + 0.5) / sprays as f32;
            let t = up * (path.len() - 1) as f32;
            let i = (t as usize).min(path.len() - 2);
            let p = path[i] + (path[i + 1] - path[i]) * (t - i as f32);
            let length = height * dice.between(0.1, 0.17);
            let twig = Place::at(p.x, p.y, p.z)
                .within(at)
                .yaw(GOLDEN_ANGLE * j as f32)
                .pitch(-dice.between(15.0, 50.0) * (1.0 - up));
            spots.push((twig, length, 0.021));
            for leaf in 0..4 {
                let out = length * (0.4 + 0.2 * leaf as f32);
                let turn = if leaf % 2 == 0 { 1.0 } else { -1.0 } * dice.between(12.0, 55.0);
                let at = twig.shift(0.0, 0.0, out).yaw(turn).pitch(dice.between(35.0, 95.0));
                spots.push((at, height * dice.between(0.07, 0.12), 0.077));
            }
        }
    }
    let cane = stage.paint("bamboo-cane", 0x8C9A4E, Finish::Satin(0.2));
    let left = triangles.saturating_sub(wood.triangle_count());
    stage.mesh("bamboo-canes", cane, wood);
    let green = stage.paint("bamboo-leaf", 0x6C9A45, Finish::Satin(0.2));
    let mut foliage = Part::default();
    for (&(at, length, slender), count) in spots.iter().zip(shares(left, spots.len())) {
        let droop = if slender < 0.05 { 20.0 } else { 25.0 };
        let shape = LeafShape { length, width: slender * length, widest: 0.4, droop, fold: 0.0 };
        foliage.add(blade(shape, count).placed(at));
    }
    stage.mesh("bamboo-leaves", green, foliage);
}

/// A garden shrub: a cloud of leaves on branches, `size` wide and high.
pub fn shrub(stage: &mut Stage, place: Place, size: [f32; 2], color: u32, triangles: usize, seed: u32) {
    let [radius, height] = [0.5 * size[0], size[1]];
    let mut wood = Part::default();
    for k in 0..9 {
        let mut dice = Dice::new(161 + u64::from(seed), k);
        let at = place.yaw(40.0 * k as f32).pitch(dice.between(8.0, 34.0));
        let path = curve(&[[0.0, 0.03 * height, 0.0], [0.6, 0.4 * height, 0.0], [0.0, 0.82 * height, 1.0]], 2);
        wood.add(tube(&path, 5, Ends::Open, |s| 0.028 * height * (1.0 - 0.8 * s)).placed(at));
    }
    let left = triangles.saturating_sub(wood.triangle_count());
    let count = left / 8;
    let spots: Vec<Place> = (0..count)
        .map(|i| {
            let mut dice = Dice::new(171 + u64::from(seed), i as u32);
            // Even over the surface of an ellipsoid, thick near it.
            let z = 1.0 - 1.85 * (i as f32 + 0.5) / count as f32;
            let reach = dice.between(0.72, 1.0);
            let (sin, cos) = crate::builtin::build::sin_cos_degrees(GOLDEN_ANGLE * i as f32);
            let flat = (1.0 - z * z).max(0.0).sqrt();
            let out = Vec3::new(flat * cos, z, flat * sin);
            let p = Vec3::new(out.x * radius, 0.58 * height + out.y * 0.42 * height, out.z * radius) * reach;
            let jitter = Vec3::new(dice.between(-0.7, 0.7), dice.between(-0.3, 0.9), dice.between(-0.7, 0.7));
            Place::facing(p, out + jitter, Vec3::Y + out * 0.4).within(place)
        })
        .collect();
    let bark = stage.paint("bark", 0x5A4028, Finish::Matte);
    stage.mesh("branches", bark, wood);
    let green = stage.paint(&format!("shrub-{color:06x}"), color, Finish::Satin(0.4));
    let foliage = leaves(
        &spots,
        |i| {
            let length = Dice::new(162, i as u32).between(0.09, 0.13) * height;
            LeafShape { length, width: 0.5 * length, widest: 0.45, droop: 30.0, fold: 15.0 }
        },
        left,
    );
    stage.mesh("shrub-leaves", green, foliage);
}

/// Daisies on stems that lean out of a vase whose mouth is the place's origin.
pub fn daisies(stage: &mut Stage, place: Place, count: usize, height: f32) {
    let white = stage.paint("petals", 0xF0E8DC, Finish::Matte);
    let yellow = stage.paint("flower-heart", 0xE0A92E, Finish::Matte);
    let green = stage.paint("stem", 0x5E6B3A, Finish::Matte);
    let (mut stems, mut petals, mut hearts) = (Part::default(), Part::default(), Part::default());
    for k in 0..count {
        let mut dice = Dice::new(72, k as u32);
        let at = place.yaw(360.0 / count as f32 * k as f32 + 20.0).pitch(dice.between(10.0, 32.0));
        let reach = height * dice.between(0.67, 1.0);
        let path = curve(&[[0.0, -0.27 * height, 0.0], [0.0, 0.5 * reach, 0.0], [0.0, reach, 0.0]], 2);
        stems.add(tube(&path, 4, Ends::Open, |_| 0.012 * height).placed(at));
        let head = at.shift(0.0, reach, 0.0);
        let size = 0.2 * height;
        for j in 0..9 {
            let turn = head.yaw(40.0 * j as f32).shift(0.0, 0.0, 0.17 * size);
            petals.add(petal(size, 0.47 * size, 0.12, 0.1, 2, 3).placed(turn));
        }
        let heart = [[0.3, -0.03], [0.27, 0.12], [0.15, 0.2], [0.0, 0.23]].map(|p| p.map(|x| x * size));
        hearts.add(revolve(&heart, 8).placed(head));
    }
    stage.mesh("flower-stem", green, stems);
    stage.mesh("petals", white, petals);
    stage.mesh("flower-heart", yellow, hearts);
}

/// Roses: balls of spiralling petals on stems that lean out of a vase; each rose has 26 petals.
pub fn roses(stage: &mut Stage, place: Place, count: usize, height: f32, color: u32) {
    let name = format!("rose-{color:06x}");
    let paint = stage
        .printed(&name, [1.0, 1.0], Finish::Matte, move || bitmap::petal(color & 63, hex(color) * 0.7, hex(color)));
    let green = stage.paint("stem", 0x5E6B3A, Finish::Matte);
    let (mut stems, mut heads) = (Part::default(), Part::default());
    for k in 0..count {
        let mut dice = Dice::new(73 + u64::from(color), k as u32);
        let at = place.yaw(GOLDEN_ANGLE * k as f32).pitch(dice.between(4.0, 40.0));
        let reach = height * dice.between(0.75, 1.0);
        let path = curve(&[[0.0, -0.3 * height, 0.0], [0.0, 0.5 * reach, 0.0], [0.0, reach, 0.0]], 2);
        stems.add(tube(&path, 4, Ends::Open, |_| 0.014 * height).placed(at));
        let size = 0.15 * height;
        for j in 0..26 {
            let s = j as f32 / 25.0;
            // From the tight heart outwards petals open and grow.
            let lean = 86.0 - 70.0 * s * s;
            let spot = at
                .shift(0.0, reach - 0.1 * size, 0.0)
                .yaw(GOLDEN_ANGLE * j as f32)
                .shift(0.0, 0.0, (0.05 + 0.16 * s) * size)
                .pitch(-lean);
            let length = size * (0.6 + 0.42 * s);
            heads.add(petal(length, length * 1.05, 0.32, 0.28, 2, 3).placed(spot));
        }
    }
    stage.mesh("flower-stem", green, stems);
    stage.mesh("roses", paint, heads);
}

/// A sprig of twigs with leaves that lean out of a vase, of exactly `triangles` triangles.
pub fn sprig(stage: &mut Stage, place: Place, stems: usize, length: f32, triangles: usize) {
    let bark = stage.paint("stem", 0x5E6B3A, Finish::Matte);
    let green = stage.paint("leaf", 0x5F8A3E, Finish::Satin(0.35));
    let per_stem = (triangles / (stems * 12)).clamp(5, 14);
    let mut twigs = Part::default();
    let mut spots = Vec::new();
    for k in 0..stems {
        let mut dice = Dice::new(71, k as u32);
        let at = place.yaw(GOLDEN_ANGLE * k as f32).pitch(dice.between(8.0, 38.0));
        let reach = length * dice.between(0.75, 1.1);
        let bend = dice.between(0.05, 0.2) * length;
        let path = curve(&[[0.0, -0.25 * length, 0.0], [0.0, 0.4 * reach, 0.0], [0.0, reach, bend]], 2);
        for j in 0..per_stem {
            let s = 0.3 + 0.7 * j as f32 / (per_stem - 1) as f32;
            let turn = GOLDEN_ANGLE * j as f32 + 60.0 * k as f32;
            spots.push(at.shift(0.0, reach * s, bend * s * s).yaw(turn).pitch(-dice.between(10.0, 40.0)));
        }
        twigs.add(tube(&path, 3, Ends::Open, |s| length * (0.016 - 0.009 * s)).placed(at));
    }
    let left = triangles.saturating_sub(twigs.triangle_count());
    stage.mesh("stems", bark, twigs);
    let shape = LeafShape { length: 0.36 * length, width: 0.17 * length, widest: 0.45, droop: 35.0, fold: 14.0 };
    stage.mesh("leaves", green, leaves(&spots, |_| shape, left));
}
