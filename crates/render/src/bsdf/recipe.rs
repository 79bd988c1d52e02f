//! Materials whose lobes are the same at every point and for every direction: made once, copied at every hit.

use super::lobe::Lobe;
use super::materials::Materials;
use super::members::Reads;
use super::{LobeSet, SurfaceModel};
use crate::SurfacePoint;
use arrayvec::ArrayVec;
use photinus_geometry::{Vec2, Vec3};
use photinus_scene::{Material, MaterialId};

/// Lobes that a recipe may have: a mirror and a diffuse base.
const MAX_LOBES: usize = 2;

/// The lobes of one side of such a material. Single directions have their frame made where they are used.
#[derive(Clone, Debug)]
pub(super) struct Recipe {
    pub lobes: ArrayVec<Lobe, MAX_LOBES>,
    pub kinds: LobeSet,
}

/// The recipes of the outside and of the inside of a material that is on the list already; none where its lobes differ from
/// point to point or by direction.
pub(super) fn recipes(materials: &Materials, id: MaterialId, model: SurfaceModel) -> Option<[Recipe; 2]> {
    let alike = materials.reads(id) == Reads::NONE
        && match materials.material(id) {
            Material::Diffuse { .. } => true,
            Material::Plastic { .. }
            | Material::RoughPlastic { .. }
            | Material::Conductor { .. }
            | Material::RoughConductor { .. } => model == SurfaceModel::Fixed,
            Material::TwoSided { front, back } => {
                [*front, *back].iter().all(|side| materials.recipe(*side, true).is_some())
            }
            _ => false,
        };
    if !alike {
        return None;
    }
    let [outside, inside] = [Vec3::Z, Vec3::NEG_Z].map(|wo| {
        let bsdf = materials.resolve(id, &flat(), wo);
        let lobes = bsdf.lobes();
        (lobes.len() <= MAX_LOBES).then(|| Recipe { lobes: lobes.iter().copied().collect(), kinds: bsdf.kinds() })
    });
    Some([outside?, inside?])
}

/// Some point of a plane.
fn flat() -> SurfacePoint {
    SurfacePoint {
        position: Vec3::ZERO,
        geometric_normal: Vec3::Z,
        normal: Vec3::Z,
        uv: Vec2::ZERO,
        dp_du: Vec3::ZERO,
        dp_dv: Vec3::ZERO,
        color: Vec3::ONE,
        uv_footprint: 0.0,
        offset: 0.0,
        shape: 0,
        prim: 0,
    }
}
