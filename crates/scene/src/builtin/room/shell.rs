//! The room itself: floor, walls with a window and an open terrace door, ceiling, mouldings, and the plane it stands
//! on.

use crate::builtin::build::{Faces, Finish, Part, Place, Stage, bevelled, bitmap, bitmap::hex, cuboid, linear};
use crate::builtin::furniture::walls;
use photinus_geometry::Vec3;

/// Half the inner width (x) and depth (z).
pub const HALF_WIDTH: f32 = 84.0;
/// See [`HALF_WIDTH`].
pub const HALF_DEPTH: f32 = 90.0;
/// Top of the floor boards.
pub const FLOOR: f32 = 1.2;
/// Underside of the ceiling.
pub const CEILING: f32 = 98.4;
/// Top of the roof: the height of all, by table 2 of the thesis.
const ROOF: f32 = 102.812;
/// Half the side of the plane, by the same table.
const HALF_PLANE: f32 = 2500.0;
const WALL: f32 = 5.0;

/// The window in the left wall: its range along z and its range of heights.
pub const WINDOW_Z: [f32; 2] = [-74.0, -18.0];
/// See [`WINDOW_Z`].
pub const WINDOW_Y: [f32; 2] = [27.0, 84.0];
/// The terrace door in the front wall: its range along x and its top.
const DOOR_X: [f32; 2] = [24.0, 72.0];
const DOOR_TOP: f32 = 72.0;

/// Builds plane, floor, walls, ceiling, window and mouldings.
pub fn build(stage: &mut Stage) {
    let lawn = stage.diffuse("lawn", linear(0x7F8F5C));
    let p = HALF_PLANE;
    let mut plane = Part::default();
    let corners = [[-p, p], [p, p], [p, -p], [-p, -p]];
    plane.quad(corners.map(|[x, z]| Vec3::new(x, 0.0, z)), corners);
    stage.mesh("plane", lawn, plane);

    let (w, d) = (HALF_WIDTH, HALF_DEPTH);
    let boards = stage
        .printed("floor-boards", [72.0, 72.0], Finish::Satin(0.3), || bitmap::planks(51, hex(0xB58755), hex(0x7D5532)));
    stage.mesh("floor", boards, cuboid([-w, 0.0, -d], [w, FLOOR, d], Faces::NoBottom));

    let plaster = stage.paint("plaster", 0xD9CFBD, Finish::Satin(0.3));
    let sage = stage.paint("sage", 0x97A892, Finish::Satin(0.3));
    let white = stage.paint("ceiling-white", 0xE4E0D6, Finish::Satin(0.3));
    let slab = |min: [f32; 3], max: [f32; 3]| cuboid(min, max, Faces::NoBottom);
    stage.mesh("back-wall", sage, slab([-w, 0.0, -d - WALL], [w, CEILING, -d]));
    stage.mesh("right-wall", plaster, slab([w, 0.0, -d - WALL], [w + WALL, CEILING, d + WALL]));
    let (z, y) = (WINDOW_Z, WINDOW_Y);
    let left = slab([-w - WALL, 0.0, -d - WALL], [-w, CEILING, z[0]])
        .and(slab([-w - WALL, 0.0, z[1]], [-w, CEILING, d + WALL]))
        .and(slab([-w - WALL, 0.0, z[0]], [-w, y[0], z[1]]))
        .and(cuboid([-w - WALL, y[1], z[0]], [-w, CEILING, z[1]], Faces::All));
    stage.mesh("left-wall", plaster, left);
    let front = slab([-w, 0.0, d], [DOOR_X[0], CEILING, d + WALL])
        .and(slab([DOOR_X[1], 0.0, d], [w, CEILING, d + WALL]))
        .and(cuboid([DOOR_X[0], DOOR_TOP, d], [DOOR_X[1], CEILING, d + WALL], Faces::All));
    stage.mesh("front-wall", plaster, front);
    let roof = cuboid([-w - WALL, CEILING, -d - WALL], [w + WALL, ROOF, d + WALL], Faces::All);
    stage.mesh("ceiling", white, roof);

    let trim = stage.paint("window-white", 0xE8E4DA, Finish::Satin(0.25));
    let mut mouldings = Part::default();
    for (y0, y1, depth) in [(FLOOR, FLOOR + 4.6, 0.9), (CEILING - 3.0, CEILING, 1.6)] {
        mouldings.add(bevelled([-w, y0, -d], [w, y1, -d + depth], 0.3));
        mouldings.add(bevelled([w - depth, y0, -d + depth], [w, y1, d], 0.3));
        mouldings.add(bevelled([-w, y0, -d + depth], [-w + depth, y1, d], 0.3));
    }
    stage.mesh("mouldings", trim, mouldings);
    let middle = Place::at(-w, 0.5 * (y[0] + y[1]), 0.5 * (z[0] + z[1])).yaw(90.0);
    walls::window(stage, middle, [z[1] - z[0], y[1] - y[0]], WALL);
}
