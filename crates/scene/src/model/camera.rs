//! Cameras, films and what a file says of the integrator.

use photinus_geometry::Vec3;

/// Which way a field of view is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// Horizontally.
    X,
    /// Vertically.
    Y,
    /// Along the diagonal.
    Diagonal,
    /// Along the shorter edge.
    Smaller,
    /// Along the longer edge.
    Larger,
}

/// How a camera maps the world to its picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A pinhole.
    Perspective {
        /// Full opening angle in degrees, 0 to 180 exclusive.
        fov_degrees: f32,
        /// Along which axis.
        axis: FovAxis,
    },
    /// A lens with depth of field.
    ThinLens {
        /// Full opening angle in degrees, 0 to 180 exclusive.
        fov_degrees: f32,
        /// Along which axis.
        axis: FovAxis,
        /// Radius of the lens in scene units.
        aperture_radius: f32,
        /// Distance along the view direction at which things are sharp.
        focus_distance: f32,
    },
    /// Parallel rays.
    Orthographic {
        /// Half the width of the picture in scene units.
        half_width: f32,
    },
}

/// A camera: where it stands and how it projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position.
    pub origin: Vec3,
    /// A point in the middle of the picture.
    pub target: Vec3,
    /// Up in the picture; need not be perpendicular to the view.
    pub up: Vec3,
    /// The picture is mirrored left to right (a file's transform flips it). Unflipped, the picture's right is
    /// view x up.
    pub mirrored: bool,
    /// The projection.
    pub projection: Projection,
    /// Shift of the picture's middle, as a fraction of its width and height: what is seen at (x, y), from 0 to 1 and y
    /// down, is what an unshifted camera sees at (x + shift, y + shift).
    pub principal_point: [f32; 2],
    /// Nothing nearer is seen, in scene units along the view direction.
    pub near_clip: f32,
    /// Nothing farther is seen.
    pub far_clip: f32,
}

/// Reconstruction filter of the film, as Mitsuba names and parametrises them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// The pixel's square.
    Box,
    /// A triangle of this radius in pixels.
    Tent {
        /// Half width, pixels.
        radius: f32,
    },
    /// A Gaussian cut at four deviations.
    Gaussian {
        /// Standard deviation, pixels.
        stddev: f32,
    },
    /// Mitchell and Netravali's cubic, radius 2.
    Mitchell {
        /// Blur.
        b: f32,
        /// Ringing.
        c: f32,
    },
    /// Catmull-Rom's cubic, radius 2.
    CatmullRom,
    /// A windowed sinc.
    Lanczos {
        /// Lobes, the radius in pixels.
        lobes: u32,
    },
}

/// The picture to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmSettings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Window of it to be rendered: x, y, width, height in pixels; none: all.
    pub crop: Option<[u32; 4]>,
    /// Reconstruction filter.
    pub filter: Filter,
}

/// Which integrator a file asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Nothing said.
    Unspecified,
    /// Emission and one bounce.
    Direct,
    /// All of light transport (path and its kin).
    Full,
}

/// What a file says of the integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratorHint {
    /// Its kind.
    pub kind: IntegratorKind,
    /// Longest path as Mitsuba counts it: 1 sees emission only, 2 adds direct light; none: no limit.
    pub max_depth: Option<u32>,
    /// Emitters seen directly by the camera are left out.
    pub hide_emitters: bool,
}
