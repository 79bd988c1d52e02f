//! The list of supports: what the command line, the documentation and the tests loop over.

use super::{Support, ball, box_fixed, box_polygon, box_trimmed, disc, ellipsoid};
use crate::PhotonError;

/// All supports, the default first.
pub const SUPPORTS: &[Support] = &[
    Support { name: "ball", about: ball::ABOUT, is_ball: true, over: |search| search, section: ball::section },
    Support::of::<disc::Disc>("disc", disc::ABOUT),
    Support::of::<ellipsoid::Ellipsoid>("ellipsoid", ellipsoid::ABOUT),
    Support::of::<box_fixed::BoxFixed>("box-fixed", box_fixed::ABOUT),
    Support::of::<box_polygon::BoxPolygon>("box-polygon", box_polygon::ABOUT),
    Support { is_ball: true, ..Support::of::<box_trimmed::BoxTrimmed>("box-trimmed", box_trimmed::ABOUT) },
];

/// The support that is used where none is named.
pub const DEFAULT_SUPPORT: &str = "ball";

/// The support of a command-line name; underscores count as hyphens.
///
/// # Errors
/// No such support.
pub fn find_support(name: &str) -> Result<&'static Support, PhotonError> {
    let wanted = name.replace('_', "-");
    SUPPORTS.iter().find(|s| s.name == wanted).ok_or_else(|| PhotonError::UnknownSupport(name.to_owned()))
}
