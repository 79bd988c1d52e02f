//! Things with a use of their own: globe, crystal ball, glasses, clock, chess, piano.

use super::seats::corners;
use crate::MaterialId;
use crate::builtin::build::{
    Ends, Finish, Part, Place, Stage, ball, bevelled, bitmap, bitmap::hex, curve, hollow, profile, revolve,
    sin_cos_degrees, soft_box, standing, tube,
};
use photinus_geometry::Vec3;

/// A ball of solid glass on a brass ring.
pub fn crystal_ball(stage: &mut Stage, place: Place, radius: f32) {
    let brass = stage.brass();
    let ring = profile(&[[0.75, 0.0], [0.8, 0.12], [0.62, 0.26], [0.6, 0.3]].map(|p| p.map(|x| x * radius)), 3);
    let mut outline = vec![[0.0, 0.0]];
    outline.extend(ring);
    outline.extend([[0.45 * radius, 0.27 * radius], [0.42 * radius, 0.2 * radius], [0.0, 0.2 * radius]]);
    stage.mesh("ball-stand", brass, revolve(&outline, 28).placed(place));
    let glass = stage.clear_glass();
    stage.mesh("crystal-ball", glass, revolve(&ball(radius, 1.21 * radius, 20), 32).placed(place));
}

/// A wine glass of this height.
pub fn wine_glass(stage: &mut Stage, place: Place, height: f32) {
    let outer = profile(
        &[
            [0.24, 0.0],
            [0.2, 0.02],
            [0.035, 0.06],
            [0.03, 0.25],
            [0.035, 0.42],
            [0.17, 0.55],
            [0.21, 0.72],
            [0.16, 1.0],
        ]
        .map(|p| p.map(|x| x * height)),
        2,
    );
    let glass = stage.clear_glass();
    stage.mesh("wine-glass", glass, revolve(&hollow(&outer, 0.016 * height, 0.47 * height), 24).placed(place));
}

/// A tumbler of this height with a heavy bottom.
pub fn tumbler(stage: &mut Stage, place: Place, height: f32) {
    let outer = profile(&[[0.3, 0.0], [0.33, 0.04], [0.36, 0.5], [0.39, 1.0]].map(|p| p.map(|x| x * height)), 2);
    let glass = stage.clear_glass();
    stage.mesh("tumbler", glass, revolve(&hollow(&outer, 0.035 * height, 0.14 * height), 24).placed(place));
}

/// A globe on a stand with a brass meridian; `radius` is the ball's.
pub fn globe(stage: &mut Stage, place: Place, radius: f32) {
    let wood = stage.walnut();
    let foot = profile(
        &[[0.8, 0.0], [0.82, 0.08], [0.5, 0.2], [0.14, 0.32], [0.2, 0.5], [0.1, 0.62]].map(|p| p.map(|x| x * radius)),
        3,
    );
    let mut outline = vec![[0.0, 0.0]];
    outline.extend(foot);
    outline.push([0.0, 0.62 * radius]);
    stage.mesh("globe-foot", wood, revolve(&outline, 20).uv_scaled(20.0, 10.0).placed(place));
    let brass = stage.brass();
    let middle = place.shift(0.0, 1.74 * radius, 0.0).roll(-23.4);
    let arc: Vec<Vec3> = (0..=24)
        .map(|i| {
            let (s, c) = sin_cos_degrees(-90.0 - 180.0 * i as f32 / 24.0);
            Vec3::new(1.1 * radius * c, 1.1 * radius * s, 0.0)
        })
        .collect();
    let pin = |from: f32, to: f32| {
        tube(&[Vec3::Y * from, Vec3::Y * (0.5 * (from + to)), Vec3::Y * to], 8, Ends::Flat, |_| 0.025 * radius)
    };
    let mut metal = tube(&arc, 8, Ends::Flat, |_| 0.035 * radius);
    metal.add(pin(0.98 * radius, 1.14 * radius));
    metal.add(pin(-1.14 * radius, -0.98 * radius));
    stage.mesh("meridian", brass, metal.placed(middle));
    let map = stage.printed("world-map", [1.0, 1.0], Finish::Satin(0.2), || bitmap::world(41));
    stage.mesh("globe", map, revolve(&ball(radius, 0.0, 20), 32).placed(middle.yaw(200.0)));
}

/// A round clock on a wall, facing +z, at ten past ten.
pub fn wall_clock(stage: &mut Stage, place: Place, radius: f32, wood: MaterialId) {
    let rim =
        profile(&[[0.84, 0.04], [0.88, 0.16], [0.96, 0.17], [1.0, 0.08], [1.0, 0.0]].map(|p| p.map(|x| x * radius)), 2);
    let up: Vec<[f32; 2]> = rim.into_iter().rev().collect();
    let upright = place.pitch(90.0);
    stage.mesh("clock-rim", wood, revolve(&up, 40).uv_scaled(30.0, 6.0).placed(upright));
    let paper = stage.paint("clock-face", 0xEFE9DB, Finish::Matte);
    let dial = revolve(&[[0.88 * radius, 0.06 * radius], [0.4 * radius, 0.06 * radius], [0.0, 0.06 * radius]], 40);
    stage.mesh("clock-face", paper, dial.placed(upright));
    let black = stage.paint("ink", 0x22211F, Finish::Matte);
    let mut marks = Part::default();
    let mut bar = |degrees: f32, from: f32, to: f32, width: f32, z: f32| {
        let (a, b) = (from * radius, to * radius);
        let part = bevelled(
            [-0.5 * width * radius, a, z * radius],
            [0.5 * width * radius, b, (z + 0.012) * radius],
            0.003 * radius,
        );
        marks.add(part.placed(place.roll(-degrees)));
    };
    for k in 0..12 {
        let long = k % 3 == 0;
        bar(30.0 * k as f32, if long { 0.66 } else { 0.73 }, 0.8, if long { 0.05 } else { 0.03 }, 0.062);
    }
    bar(305.0, -0.08, 0.45, 0.05, 0.085);
    bar(60.0, -0.1, 0.68, 0.035, 0.1);
    stage.mesh("clock-marks", black, marks);
}

/// A chess board of this side with all its men, a few moves into a game.
pub fn chess(stage: &mut Stage, place: Place, side: f32) {
    let wood = stage.walnut();
    stage.mesh("chess-board", wood, standing([1.14 * side, 0.05 * side, 1.14 * side], 0.012 * side).placed(place));
    let squares = stage.printed("chess-squares", [side, side], Finish::Satin(0.2), || {
        bitmap::checker(42, 8, hex(0xD9BE8E), hex(0x4A2F1E))
    });
    let h = 0.5 * side;
    let y = 0.0505 * side;
    let mut top = Part::default();
    let corners = [[-h, h], [h, h], [h, -h], [-h, -h]];
    top.quad(corners.map(|[x, z]| Vec3::new(x, y, z)), corners.map(|[x, z]| [x + h, h - z]));
    stage.mesh("chess-squares", squares, top.placed(place));

    let unit = side / 8.0;
    let white = stage.paint("chess-white", 0xE6D3AC, Finish::Satin(0.15));
    let black = stage.paint("chess-black", 0x2A1B14, Finish::Satin(0.15));
    let back = [Man::Rook, Man::Knight, Man::Bishop, Man::Queen, Man::King, Man::Bishop, Man::Knight, Man::Rook];
    for (material, home, step) in [(white, 0, 1i32), (black, 7, -1)] {
        let mut men = Part::default();
        for (file, man) in back.into_iter().enumerate() {
            let mut rank = home;
            let mut column = file as i32;
            // Both kings' knights are out, and white's bishop.
            if file == 6 {
                (rank, column) = (home + 2 * step, 5);
            } else if file == 5 && step == 1 {
                (rank, column) = (3, 2);
            }
            let at =
                Place::at((column as f32 - 3.5) * unit, y, (3.5 - rank as f32) * unit).yaw(90.0 - 90.0 * step as f32);
            men.add(man.part(unit).placed(at));
            let pawn = if file == 4 { home + 3 * step } else { home + step };
            men.add(Man::Pawn.part(unit).placed(Place::at((file as f32 - 3.5) * unit, y, (3.5 - pawn as f32) * unit)));
        }
        stage.mesh("chess-men", material, men.placed(place));
    }
}

#[derive(Clone, Copy)]
enum Man {
    Pawn,
    Rook,
    Knight,
    Bishop,
    Queen,
    King,
}

impl Man {
    /// The man on its square's middle, for squares of this side.
    fn part(self, unit: f32) -> Part {
        let foot: &[[f32; 2]] = &[[0.36, 0.0], [0.36, 0.08], [0.26, 0.18], [0.2, 0.26]];
        let (body, segments): (&[[f32; 2]], usize) = match self {
            Self::Pawn => (&[[0.12, 0.62], [0.2, 0.68], [0.1, 0.72], [0.17, 0.82], [0.17, 0.92], [0.09, 1.0]], 12),
            Self::Rook => (&[[0.17, 0.7], [0.25, 0.8], [0.26, 1.04], [0.18, 1.04], [0.18, 0.95]], 14),
            Self::Knight => (&[[0.24, 0.34], [0.2, 0.4]], 14),
            Self::Bishop => (&[[0.12, 0.85], [0.22, 0.92], [0.12, 0.97], [0.18, 1.12], [0.13, 1.28], [0.05, 1.4]], 14),
            Self::Queen => (&[[0.13, 1.05], [0.23, 1.14], [0.14, 1.18], [0.24, 1.5], [0.16, 1.48], [0.1, 1.58]], 16),
            Self::King => (&[[0.14, 1.12], [0.24, 1.22], [0.15, 1.26], [0.25, 1.6], [0.22, 1.64], [0.08, 1.7]], 16),
        };
        let mut outline = vec![[0.0, 0.0]];
        outline.extend(foot.iter().chain(body));
        outline.push([0.0, outline[outline.len() - 1][1] + 0.02]);
        let outline: Vec<[f32; 2]> = outline.iter().map(|p| p.map(|x| x * unit)).collect();
        let mut part = revolve(&outline, segments);
        match self {
            Self::King => {
                part.add(bevelled(
                    [-0.035, 1.68, -0.035].map(|x| x * unit),
                    [0.035, 1.92, 0.035].map(|x| x * unit),
                    0.01 * unit,
                ));
                part.add(bevelled(
                    [-0.1, 1.77, -0.034].map(|x| x * unit),
                    [0.1, 1.84, 0.034].map(|x| x * unit),
                    0.01 * unit,
                ));
            }
            Self::Knight => {
                let neck = curve(
                    &[[0.0, 0.36, 0.06], [0.0, 0.66, 0.14], [0.0, 0.94, 0.08], [0.0, 1.02, -0.14], [0.0, 0.94, -0.38]]
                        .map(|p| p.map(|x| x * unit)),
                    3,
                );
                part.add(tube(&neck, 9, Ends::Flat, |s| unit * (0.18 - 0.09 * s)));
                for side in [-1.0, 1.0] {
                    let ear = [[0.05, 0.0], [0.04, 0.08], [0.0, 0.16]].map(|p| p.map(|x| x * unit));
                    part.add(revolve(&ear, 6).placed(Place::at(side * 0.07 * unit, 1.04 * unit, 0.0)));
                }
            }
            _ => {}
        }
        part
    }
}

/// An upright piano, 58 wide, 24 deep, 48 high, its keys towards +z.
pub fn piano(stage: &mut Stage, place: Place) {
    let lacquer = stage.paint("piano-lacquer", 0x1C1512, Finish::Gloss);
    let mut body = bevelled([-29.0, 1.5, -12.0], [29.0, 46.6, 0.0], 0.4);
    body.add(bevelled([-30.0, 46.6, -12.4], [30.0, 48.0, 1.6], 0.4));
    for side in [-1.0, 1.0] {
        let x = side * 28.0;
        body.add(bevelled([x - 1.0, 0.0, -12.0], [x + 1.0, 47.0, 1.0], 0.3));
        body.add(bevelled([x - 1.0, 22.6, 1.0], [x + 1.0, 30.0, 12.0], 0.4));
        let leg = profile(&[[1.0, 0.0], [0.9, 0.6], [1.3, 3.0], [1.0, 10.0], [1.5, 19.0], [1.6, 22.6]], 2);
        let mut outline = vec![[0.0, 0.0]];
        outline.extend(leg);
        outline.push([0.0, 22.6]);
        body.add(revolve(&outline, 14).placed(Place::at(x, 0.0, 10.4)));
    }
    body.add(bevelled([-27.0, 23.4, 0.0], [27.0, 25.6, 12.0], 0.3));
    body.add(bevelled([-27.0, 30.4, 0.0], [27.0, 36.0, 0.8], 0.2));
    body.add(bevelled([-15.0, 36.4, 0.0], [15.0, 44.4, 0.7], 0.25).placed(Place::at(0.0, 0.0, 0.3)));
    stage.mesh("piano", lacquer, body.placed(place));

    let (ivory, ebony) =
        (stage.paint("ivory", 0xEDE6D4, Finish::Gloss), stage.paint("ebony", 0x14110F, Finish::Satin(0.2)));
    let (mut whites, mut blacks) = (Part::default(), Part::default());
    let pitch = 54.0 / 52.0;
    for k in 0..52 {
        let x = -27.0 + pitch * (k as f32 + 0.5);
        whites.add(bevelled([x - 0.5, 25.6, 2.4], [x + 0.5, 27.0, 11.6], 0.06));
        // Naturals run A B C D E F G; no sharp follows B and E.
        if k < 51 && !matches!(k % 7, 1 | 4) {
            let s = x + 0.5 * pitch;
            blacks.add(bevelled([s - 0.28, 27.02, 2.4], [s + 0.28, 27.7, 8.2], 0.08));
        }
    }
    stage.mesh("white-keys", ivory, whites.placed(place));
    stage.mesh("black-keys", ebony, blacks.placed(place));
    let brass = stage.brass();
    let mut pedals = Part::default();
    for k in -1..=1 {
        pedals.add(soft_box([0.7, 0.25, 2.0], 3.0, [4, 2, 6]).placed(Place::at(2.4 * k as f32, 2.0, 1.6)));
    }
    stage.mesh("pedals", brass, pedals.placed(place));
    let paper = stage.paint("paper", 0xE9E0CB, Finish::Matte);
    let sheet = |x: f32, turn: f32| {
        bevelled([-5.0, 0.0, -0.05], [5.0, 12.0, 0.05], 0.02).placed(Place::at(x, 36.6, 1.6).pitch(-9.0).yaw(turn))
    };
    stage.mesh("sheet-music", paper, sheet(-5.1, 5.0).and(sheet(5.1, -5.0)).placed(place));
}

/// A tray with a jug and tumblers.
pub fn tray(stage: &mut Stage, place: Place, radius: f32) {
    let silver = stage.steel();
    let outline = profile(&[[0.9, 0.0], [0.94, 0.02], [1.0, 0.1], [1.02, 0.12]].map(|p| p.map(|x| x * radius)), 2);
    stage.mesh("tray", silver, revolve(&hollow(&outline, 0.02 * radius, 0.03 * radius), 40).placed(place));
    let glaze = stage.paint("jug", 0x2E5C66, Finish::Gloss);
    let jug = profile(
        &[[0.26, 0.0], [0.38, 0.2], [0.42, 0.45], [0.28, 0.8], [0.22, 1.0], [0.3, 1.15]].map(|p| p.map(|x| x * radius)),
        3,
    );
    let at = place.shift(-0.25 * radius, 0.035 * radius, -0.2 * radius);
    let handle = curve(
        &[[-0.24, 1.02, 0.0], [-0.5, 1.0, 0.0], [-0.58, 0.7, 0.0], [-0.38, 0.42, 0.0]].map(|p| p.map(|x| x * radius)),
        3,
    );
    let body =
        revolve(&hollow(&jug, 0.03 * radius, 0.5 * radius), 26).and(tube(&handle, 7, Ends::Open, |_| 0.045 * radius));
    stage.mesh("jug", glaze, body.placed(at.yaw(-140.0)));
    for (x, z) in [(0.42, -0.3), (0.5, 0.28), (0.02, 0.48)] {
        tumbler(stage, place.shift(x * radius, 0.04 * radius, z * radius), 0.6 * radius);
    }
}

/// A window seat with corner posts: `size` wide, high, deep, with a cushion on top.
pub fn window_seat(stage: &mut Stage, place: Place, size: [f32; 3], wood: MaterialId, cloth: MaterialId) {
    let [w, h, d] = size;
    let mut part = standing([w, h, d], 0.4);
    for (x, z) in corners(w, d) {
        part.add(standing([1.6, h + 0.4, 1.6], 0.2).placed(Place::at(x, 0.0, z)));
    }
    stage.mesh("window-seat", wood, part.placed(place));
    let pad = soft_box([0.49 * w, 1.7, 0.47 * d], 8.0, [18, 3, 8]);
    stage.mesh("window-cushion", cloth, pad.placed(place.shift(0.0, h + 1.6, 0.0)));
}
