//! `<transform>`: a chain of steps, the first one applied first.

use super::tree::{NodeId, Tree};
use super::value::{parse_f64, parse_list};
use crate::load::{Context, LoadError};
use glam::{DAffine3, DMat3, DVec3};
use photinus_geometry::Vec3;

/// A view as a file says it, kept apart so that cameras read it without rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookAt {
    /// Where the eye is.
    pub origin: Vec3,
    /// What it looks at.
    pub target: Vec3,
    /// What is up.
    pub up: Vec3,
    /// Scale that comes before it in the same transform.
    pub scale: Vec3,
}

/// An affine map in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// The map.
    pub matrix: DAffine3,
    /// Set where the chain is one `lookat`, alone or after one `scale`.
    pub lookat: Option<LookAt>,
}

impl Transform {
    /// No change.
    pub const IDENTITY: Self = Self { matrix: DAffine3::IDENTITY, lookat: None };
}

/// Reads the `<transform>` element `id`.
pub fn read(tree: &Tree, id: NodeId, context: &mut Context<'_>) -> Result<Transform, LoadError> {
    let mut matrix = DAffine3::IDENTITY;
    let mut lookat = None;
    let steps = &tree.node(id).children;
    for (i, &step) in steps.iter().enumerate() {
        let node = tree.node(step);
        let place = tree.place(step);
        let components = |default: f64| components(tree, step, default);
        let next = match node.tag.as_str() {
            "translate" => DAffine3::from_translation(components(0.0)?),
            "scale" => DAffine3::from_scale(components(1.0)?),
            "rotate" => {
                let angle = node.attribute("angle").unwrap_or_default();
                let degrees = parse_f64(angle)
                    .ok_or_else(|| LoadError::invalid(place.clone(), format!("the angle \"{angle}\" is no number")))?;
                let Some(axis) = components(0.0)?.try_normalize() else {
                    return Err(LoadError::invalid(place, "the axis of a rotation must not be zero"));
                };
                DAffine3::from_mat3(rotation(axis, degrees.to_radians()))
            }
            "matrix" => read_matrix(tree, step, context)?,
            "lookat" => {
                let (map, mut view) = read_lookat(tree, step)?;
                let scaled = i == 1 && tree.node(steps[0]).tag == "scale";
                if scaled {
                    view.scale = self::components(tree, steps[0], 1.0)?.as_vec3();
                }
                lookat = ((i == 0 || scaled) && i + 1 == steps.len()).then_some(view);
                map
            }
            other => {
                context.warn(&place, format!("unknown step <{other}> of a transform: ignored"));
                continue;
            }
        };
        matrix = next * matrix;
    }
    if !matrix.is_finite() {
        return Err(LoadError::invalid(tree.place(id), "the transform has numbers beyond all bounds"));
    }
    Ok(Transform { matrix, lookat })
}

/// Rotation by `angle` radians around a unit axis (Rodrigues).
fn rotation(axis: DVec3, angle: f64) -> DMat3 {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let k = axis * (1.0 - c);
    DMat3::from_cols(
        DVec3::new(axis.x * k.x + c, axis.y * k.x + axis.z * s, axis.z * k.x - axis.y * s),
        DVec3::new(axis.x * k.y - axis.z * s, axis.y * k.y + c, axis.z * k.y + axis.x * s),
        DVec3::new(axis.x * k.z + axis.y * s, axis.y * k.z - axis.x * s, axis.z * k.z + c),
    )
}

/// `x`, `y`, `z`, or `value` with one or three numbers.
fn components(tree: &Tree, id: NodeId, default: f64) -> Result<DVec3, LoadError> {
    let node = tree.node(id);
    let bad = |text: &str| {
        LoadError::invalid(tree.place(id), format!("\"{text}\" is no number (or three) in <{}>", node.tag))
    };
    if let Some(text) = node.attribute("value") {
        return match parse_list(text).as_deref() {
            Some(&[v]) => Ok(DVec3::splat(v)),
            Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
            _ => Err(bad(text)),
        };
    }
    let mut v = [default; 3];
    for (slot, name) in v.iter_mut().zip(["x", "y", "z"]) {
        if let Some(text) = node.attribute(name) {
            *slot = parse_f64(text).ok_or_else(|| bad(text))?;
        }
    }
    Ok(DVec3::from(v))
}

fn read_matrix(tree: &Tree, id: NodeId, context: &mut Context<'_>) -> Result<DAffine3, LoadError> {
    let place = tree.place(id);
    let text = tree.node(id).attribute("value").unwrap_or_default();
    let m = parse_list(text).unwrap_or_default();
    let row = |r: usize, n: usize| DVec3::new(m[r * n], m[r * n + 1], m[r * n + 2]);
    match m.len() {
        9 => Ok(DAffine3::from_mat3(DMat3::from_cols(row(0, 3), row(1, 3), row(2, 3)).transpose())),
        16 => {
            if m[12..] != [0.0, 0.0, 0.0, 1.0] {
                context.warn(&place, "the last row of a matrix is not 0 0 0 1: ignored, maps are affine");
            }
            let linear = DMat3::from_cols(row(0, 4), row(1, 4), row(2, 4)).transpose();
            Ok(DAffine3::from_mat3_translation(linear, DVec3::new(m[3], m[7], m[11])))
        }
        _ => Err(LoadError::invalid(place, "a matrix has 16 numbers (or 9), row by row")),
    }
}

fn read_lookat(tree: &Tree, id: NodeId) -> Result<(DAffine3, LookAt), LoadError> {
    let node = tree.node(id);
    let vector = |name: &str| -> Result<Option<DVec3>, LoadError> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        match parse_list(text).as_deref() {
            Some(&[x, y, z]) => Ok(Some(DVec3::new(x, y, z))),
            _ => {
                let message = format!("lookat: {name} \"{text}\" is not three numbers");
                Err(LoadError::invalid(tree.place(id), message))
            }
        }
    };
    let missing = |name: &str| LoadError::invalid(tree.place(id), format!("lookat lacks \"{name}\""));
    let origin = vector("origin")?.ok_or_else(|| missing("origin"))?;
    let target = vector("target")?.ok_or_else(|| missing("target"))?;
    let Some(forward) = (target - origin).try_normalize() else {
        return Err(LoadError::invalid(tree.place(id), "lookat: origin and target are the same point"));
    };
    let up = match vector("up")? {
        Some(up) if up != DVec3::ZERO => up,
        _ => any_perpendicular(forward),
    };
    let Some(left) = up.cross(forward).try_normalize() else {
        return Err(LoadError::invalid(tree.place(id), "lookat: up points along the view"));
    };
    let linear = DMat3::from_cols(left, forward.cross(left), forward);
    let view = LookAt { origin: origin.as_vec3(), target: target.as_vec3(), up: up.as_vec3(), scale: Vec3::ONE };
    Ok((DAffine3::from_mat3_translation(linear, origin), view))
}

/// A unit vector perpendicular to the unit vector `n`.
pub fn any_perpendicular(n: DVec3) -> DVec3 {
    let other = if n.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    n.cross(other).normalize()
}
