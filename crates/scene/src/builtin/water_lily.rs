//! A pond with water lilies: the water is a refracting sheet over a bed of pebbles, with caustics below.

use super::build::{
    Dice, Ends, Finish, Join, LeafShape, Part, Place, Stage, bitmap, bitmap::hex, blade, camera, curve, film, lily_pad,
    linear, patch, petal, revolve, shares, sin_cos_degrees, soft_box, tube,
};
use crate::{ColorInput, EnvironmentLight, Light, Material, Scene};
use photinus_geometry::Vec3;

/// Half the side of the pond.
const SHORE: f32 = 30.0;
/// The bed lies this far below the water.
const DEPTH: f32 = 11.0;

/// Triangles of the lamp, which comes last.
const SUN: usize = 2;

/// How finely everything is cut.
struct Detail {
    water: usize,
    pad: [usize; 2],
    petals: [[usize; 2]; 2],
    stamens: usize,
    fish: [usize; 2],
    stone: [usize; 3],
    fin: usize,
    reeds: usize,
    triangles: usize,
}

/// The pond in 1426 triangles.
pub fn coarse() -> Scene {
    pond(&Detail {
        water: 11,
        pad: [9, 2],
        petals: [[2, 3], [2, 2]],
        stamens: 3,
        fish: [4, 5],
        stone: [2, 2, 2],
        fin: 4,
        reeds: 16,
        triangles: 1426,
    })
}

/// The pond in 6146 triangles.
pub fn fine() -> Scene {
    pond(&Detail {
        water: 30,
        pad: [18, 3],
        petals: [[3, 5], [3, 5]],
        stamens: 14,
        fish: [8, 9],
        stone: [6, 4, 6],
        fin: 8,
        reeds: 44,
        triangles: 6146,
    })
}

fn pond(detail: &Detail) -> Scene {
    let mut stage = Stage::default();
    basin(&mut stage, detail);
    let pads = [
        (-9.5, -3.0, 5.6, 20.0),
        (8.8, -6.8, 5.0, 140.0),
        (-1.5, -13.5, 4.6, 250.0),
        (10.5, 6.5, 4.4, 60.0),
        (-12.0, 9.0, 4.0, 300.0),
        (-17.5, -11.5, 4.8, 190.0),
        (17.5, -15.5, 4.2, 15.0),
        (2.2, 13.5, 2.6, 100.0),
    ];
    let green = stage.printed("lily-pad", [1.0, 1.0], Finish::Satin(0.3), || {
        bitmap::pad(21, hex(0x3F7A3A), hex(0x9DB66A), hex(0x8A4A3A))
    });
    for (x, z, radius, turn) in pads {
        let tilt = 1.5 * sin_cos_degrees(turn * 3.0).0;
        stage.mesh(
            "lily-pad",
            green,
            lily_pad(radius, detail.pad[0], detail.pad[1]).placed(Place::at(x, 0.42, z).yaw(turn).pitch(tilt)),
        );
    }
    flower(&mut stage, detail, 0, Place::at(-0.6, 0.5, -1.6).yaw(10.0), 6.0);
    flower(&mut stage, detail, 1, Place::at(5.0, 0.5, -14.5).yaw(40.0), 4.6);
    koi(&mut stage, detail, Place::at(-5.0, -3.4, 6.5).yaw(60.0), 9.0, 0xD9562B);
    koi(&mut stage, detail, Place::at(5.5, -5.0, 8.0).yaw(115.0), 8.0, 0xC8402A);
    stones(&mut stage, detail);
    reeds(&mut stage, detail);

    let black = stage.diffuse("lamp", [0.0; 3]);
    let mut sun = Part::default();
    let corners = [[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]];
    let over = Place::at(-22.0, 44.0, -14.0).roll(-26.0).pitch(-16.0);
    sun.quad(corners.map(|[x, z]| over.point(Vec3::new(x, 0.0, z))), [[0.0; 2]; 4]);
    stage.lamp("sun", black, sun, [1400.0, 1290.0, 1080.0]);
    stage.light(Light::Environment(EnvironmentLight::Constant(Vec3::from(linear(0x9FBAD0)) * 0.9)));
    stage.finish(camera([1.0, 25.0, 23.0], [0.0, -0.5, -1.0], 39.0), film(640, 480), None)
}

/// Bed, walls and the water itself.
fn basin(stage: &mut Stage, detail: &Detail) {
    let pebbles = stage.printed("pebbles", [16.0, 16.0], Finish::Matte, || bitmap::pebbles(24));
    let mut bed = Part::default();
    let square = [[-SHORE, SHORE], [SHORE, SHORE], [SHORE, -SHORE], [-SHORE, -SHORE]];
    bed.quad(square.map(|[x, z]| Vec3::new(x, -DEPTH, z)), square);
    for k in 0..4 {
        let ([ax, az], [bx, bz]) = (square[k], square[(k + 1) % 4]);
        let wall =
            [Vec3::new(bx, -DEPTH, bz), Vec3::new(ax, -DEPTH, az), Vec3::new(ax, 1.0, az), Vec3::new(bx, 1.0, bz)];
        bed.quad(wall, [[60.0, 0.0], [0.0, 0.0], [0.0, DEPTH], [60.0, DEPTH]]);
    }
    stage.mesh("bed", pebbles, bed);
    let one = ColorInput::Constant(Vec3::ONE);
    let water = stage.material(
        "water",
        Material::Dielectric { int_ior: 1.33, ext_ior: 1.0, specular_reflectance: one, specular_transmittance: one },
    );
    let sheet = patch(detail.water, detail.water, Join::Open, |u, v| {
        let (x, z) = (SHORE * (2.0 * u - 1.0), SHORE * (1.0 - 2.0 * v));
        let wave = |kx: f32, kz: f32, phase: f32| sin_cos_degrees(kx * x + kz * z + phase).0;
        // Wavelengths of 9 to 15 units, so that every crest is drawn by several cells.
        let height = wave(24.0, 9.0, 0.0) + 0.8 * wave(-10.0, 27.0, 40.0) + 0.6 * wave(29.0, -21.0, 100.0);
        Vec3::new(x, 0.13 * height, z)
    });
    stage.mesh("water", water, sheet.uv_scaled(2.0 * SHORE, 2.0 * SHORE));
}

/// A flower of four rings of petals around a heart of stamens.
fn flower(stage: &mut Stage, detail: &Detail, which: usize, place: Place, size: f32) {
    let [nu, nv] = detail.petals[which];
    let (name, base, tip) = [("pink-petal", 0xF7E6E2, 0xD9628C), ("white-petal", 0xF2EFC8, 0xF7F4EC)][which];
    let material =
        stage.printed(name, [1.0, 1.0], Finish::Matte, move || bitmap::petal(22 + which as u32, hex(base), hex(tip)));
    let mut petals = Part::default();
    for (ring, (count, length, width, lean, rise)) in
        [(8, 1.0, 0.44, 4.0, 0.12), (8, 0.92, 0.42, 26.0, 0.2), (7, 0.8, 0.38, 48.0, 0.2), (5, 0.62, 0.32, 66.0, 0.12)]
            .into_iter()
            .enumerate()
    {
        for k in 0..count {
            let mut dice = Dice::new(81, (ring * 16 + k) as u32);
            let turn = 360.0 / count as f32 * (k as f32 + 0.5 * ring as f32) + dice.between(-4.0, 4.0);
            let at = place.yaw(turn).shift(0.0, 0.02 * size, 0.06 * size).pitch(-(lean + dice.between(-4.0, 4.0)));
            petals.add(petal(length * size, width * size, rise, 0.22, nu, nv).placed(at));
        }
    }
    stage.mesh("petals", material, petals);
    let yellow = stage.paint("stamens", 0xE7AE2A, Finish::Matte);
    let mut heart =
        revolve(&[[0.13 * size, 0.0], [0.15 * size, 0.16 * size], [0.08 * size, 0.24 * size], [0.0, 0.25 * size]], 8);
    for k in 0..detail.stamens {
        let at = Place::HERE.yaw(360.0 / detail.stamens as f32 * k as f32).pitch(24.0);
        let path = curve(
            &[[0.0, 0.1 * size, 0.1 * size], [0.0, 0.25 * size, 0.13 * size], [0.0, 0.36 * size, 0.06 * size]],
            1,
        );
        heart.add(tube(&path, 3, Ends::Open, |s| size * (0.014 + 0.012 * s)).placed(at));
    }
    stage.mesh("stamens", yellow, heart.placed(place));
}

/// A koi of this length that swims towards its place's +z.
fn koi(stage: &mut Stage, detail: &Detail, place: Place, length: f32, color: u32) {
    let name = format!("koi-{color:06x}");
    let skin = stage.printed(&name, [1.0, length], Finish::Satin(0.2), move || {
        bitmap::scales(color & 63, hex(0xF0E4D4), hex(color))
    });
    let path: Vec<Vec3> = (0..=detail.fish[1])
        .map(|i| {
            let s = i as f32 / detail.fish[1] as f32;
            Vec3::new(0.06 * length * sin_cos_degrees(300.0 * s).0, 0.0, length * (s - 0.5))
        })
        .collect();
    let body = tube(&path, detail.fish[0], Ends::Open, |s| {
        // From the root of the tail, over a full chest, to the blunt nose.
        length * if s >= 1.0 { 0.0 } else { 0.018 + 0.115 * sin_cos_degrees(180.0 * libm::powf(s, 1.35)).0 }
    });
    stage.mesh("koi", skin, body.placed(place.scale(0.8, 1.0, 1.0)));
    let fin = |turn: f32, pitch: f32, at: [f32; 3], size: f32| {
        let shape =
            LeafShape { length: size * length, width: 0.55 * size * length, widest: 0.65, droop: 18.0, fold: 8.0 };
        super::build::leaf(shape, detail.fin)
            .placed(place.shift(at[0] * length, at[1] * length, at[2] * length).yaw(turn).pitch(pitch))
    };
    let fins = fin(168.0, 4.0, [0.0, 0.0, -0.49], 0.27)
        .and(fin(196.0, 4.0, [0.0, 0.0, -0.49], 0.27))
        .and(fin(120.0, 12.0, [0.07, -0.03, 0.2], 0.17))
        .and(fin(-120.0, 12.0, [-0.07, -0.03, 0.2], 0.17));
    let tint = stage.paint("fins", 0xE8B79A, Finish::Matte);
    stage.mesh("fins", tint, fins);
}

/// Boulders at the shore, half in the water.
fn stones(stage: &mut Stage, detail: &Detail) {
    let grey = stage.printed("boulder", [9.0, 9.0], Finish::Matte, || bitmap::marble(25, hex(0x8D8A80), hex(0x5B5A50)));
    for (k, (x, y, z, size)) in
        [(-24.0, -2.0, -21.0, 7.0), (-13.5, -2.5, -25.0, 5.0), (23.0, -2.0, -24.5, 6.0)].into_iter().enumerate()
    {
        let mut dice = Dice::new(82, k as u32);
        let lump = dice.between(60.0, 90.0);
        let shape = soft_box([size, 0.7 * size, 0.85 * size], 2.6, detail.stone).bent(|p| {
            let (a, b) =
                (sin_cos_degrees(lump * p.x / size * 2.0 + 50.0).0, sin_cos_degrees(lump * p.z / size * 2.0).0);
            p * (1.0 + 0.09 * a * b)
        });
        stage.mesh(
            "boulder",
            grey,
            shape.placed(Place::at(x, y, z).yaw(dice.between(0.0, 360.0)).roll(dice.between(-12.0, 12.0))),
        );
    }
}

/// Reeds at the left shore; their blades bring the scene to its exact number of triangles.
fn reeds(stage: &mut Stage, detail: &Detail) {
    let green = stage.paint("reeds", 0x6E8F3F, Finish::Satin(0.4));
    let missing = stage.missing_to(detail.triangles - SUN);
    let mut clump = Part::default();
    for (k, triangles) in shares(missing, detail.reeds).enumerate() {
        let mut dice = Dice::new(83, k as u32);
        let shape = LeafShape {
            length: dice.between(13.0, 22.0),
            width: dice.between(0.7, 1.1),
            widest: 0.5,
            droop: dice.between(20.0, 75.0),
            fold: 0.0,
        };
        let around = Place::at(-24.0, -4.0, -9.0).yaw(dice.between(0.0, 360.0)).shift(0.0, 0.0, dice.between(0.3, 4.5));
        clump.add(blade(shape, triangles).placed(around.pitch(-dice.between(72.0, 88.0))));
    }
    stage.mesh("reeds", green, clump);
}
