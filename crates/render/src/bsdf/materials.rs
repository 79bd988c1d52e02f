//! All materials of a scene, prepared once.

use super::builder::Builder;
use super::microfacet::{InterfaceTable, SplitSumTable};
use super::recipe::{Recipe, recipes};
use super::{Bsdf, Reads, SurfaceModel, fresnel_diffuse_reflectance};
use crate::SurfacePoint;
use crate::texture::{TextureLookup, Textures};
use photinus_geometry::Vec3;
use photinus_scene::{ColorInput, Material, MaterialId, MicrofacetModel, NamedMaterial, Scene, Texture};

/// All materials and textures of a scene, ready to be resolved at surface points.
#[derive(Clone, Debug)]
pub struct Materials {
    materials: Vec<Prepared>,
    textures: Textures,
    model: SurfaceModel,
    interfaces: Vec<InterfaceTable>,
    split_sums: Vec<(MicrofacetModel, SplitSumTable)>,
    /// Relative index and mean reflectance under diffuse light from the side that it is relative to.
    diffuse_reflectances: Vec<(f32, f32)>,
}

#[derive(Clone, Debug)]
struct Prepared {
    material: Material,
    has_opacity: bool,
    is_diffuse: bool,
    reads: Reads,
    /// Outside and inside.
    recipes: Option<[Recipe; 2]>,
}

/// A table that the lobes of a material look up; indices are inside over outside.
#[derive(Clone, Copy, Debug)]
pub(super) enum Table {
    /// Reflectance by Schlick's formula.
    SplitSum(MicrofacetModel),
    /// Reflectance and transmittance of an interface.
    Interface(MicrofacetModel, f32),
}

/// Different indices of refraction that get a table of their own (some 20 ms each); a scene of many more shares them.
const MAX_INTERFACE_TABLES: usize = 64;

/// What a material id stands for that is on no list.
const MISSING: Material = Material::Diffuse { reflectance: ColorInput::Constant(Vec3::splat(0.5)) };

impl Materials {
    /// Prepares textures and the tables that the materials need. Indices out of range and materials that nest themselves
    /// become mid-grey.
    pub fn new(scene: &Scene, model: SurfaceModel) -> Self {
        Self::from_lists(&scene.materials, &scene.textures, model)
    }

    /// The same for materials and textures without a scene around them.
    pub fn from_lists(materials: &[NamedMaterial], textures: &[Texture], model: SurfaceModel) -> Self {
        let mut result = Self {
            materials: Vec::with_capacity(materials.len()),
            textures: Textures::new(textures),
            model,
            interfaces: Vec::new(),
            split_sums: Vec::new(),
            diffuse_reflectances: Vec::new(),
        };
        for (i, named) in materials.iter().enumerate() {
            let sound = named.material.nested().all(|id| (id.0 as usize) < i);
            let material = if sound { named.material.clone() } else { MISSING };
            let has_opacity = matches!(material, Material::Mask { .. } | Material::Null)
                || material.nested().any(|id| result.materials[id.0 as usize].has_opacity);
            let is_diffuse = match &material {
                Material::Diffuse { .. } => true,
                Material::TwoSided { .. } | Material::BumpMap { .. } | Material::NormalMap { .. } => {
                    material.nested().all(|id| result.materials[id.0 as usize].is_diffuse)
                }
                _ => false,
            };
            if model == SurfaceModel::Physical {
                for table in super::members::tables(&material) {
                    result.add_table(table);
                }
                for eta in super::members::indices(&material) {
                    if result.diffuse_reflectances.iter().all(|(known, _)| *known != eta) {
                        result.diffuse_reflectances.push((eta, fresnel_diffuse_reflectance(eta)));
                    }
                }
            }
            let reads = material
                .nested()
                .map(|id| result.materials[id.0 as usize].reads)
                .fold(super::members::reads(&material), |all, nested| all | nested);
            result.materials.push(Prepared { material, has_opacity, is_diffuse, reads, recipes: None });
            result.materials[i].recipes = recipes(&result, MaterialId(i as u32), model);
        }
        result
    }

    fn add_table(&mut self, table: Table) {
        match table {
            Table::SplitSum(model) if self.split_sum(model).is_none() => {
                self.split_sums.push((model, SplitSumTable::new(model)));
            }
            Table::Interface(model, eta) => {
                let known = self.interface_table(model, eta).is_some_and(|table| table.eta == eta);
                if !known && self.interfaces.len() < MAX_INTERFACE_TABLES {
                    self.interfaces.push(InterfaceTable::new(model, eta));
                }
            }
            _ => {}
        }
    }

    /// Bytes held beyond the scene itself.
    pub fn bytes(&self) -> usize {
        let interfaces: usize = self.interfaces.iter().map(InterfaceTable::bytes).sum();
        let sums: usize = self.split_sums.iter().map(|(_, table)| table.bytes()).sum();
        self.materials.len() * size_of::<Prepared>() + self.textures.bytes() + interfaces + sums
    }

    /// How faithfully surfaces are modelled.
    pub fn model(&self) -> SurfaceModel {
        self.model
    }

    /// The textures.
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    pub(super) fn material(&self, id: MaterialId) -> &Material {
        self.materials.get(id.0 as usize).map_or(&MISSING, |prepared| &prepared.material)
    }

    /// The lobes of one side of a material where they are always the same.
    #[inline]
    pub(super) fn recipe(&self, id: MaterialId, front: bool) -> Option<&Recipe> {
        let prepared = self.materials.get(id.0 as usize)?;
        prepared.recipes.as_ref().map(|[outside, inside]| if front { outside } else { inside })
    }

    #[cfg(test)]
    pub(super) fn without_recipes(mut self) -> Self {
        self.materials.iter_mut().for_each(|prepared| prepared.recipes = None);
        self
    }

    /// The table whose index, inside over outside, is nearest to `eta`.
    pub(super) fn interface_table(&self, model: MicrofacetModel, eta: f32) -> Option<&InterfaceTable> {
        let of_model = self.interfaces.iter().filter(|table| table.model == model);
        of_model.min_by(|a, b| (a.eta - eta).abs().total_cmp(&(b.eta - eta).abs()))
    }

    pub(super) fn split_sum(&self, model: MicrofacetModel) -> Option<&SplitSumTable> {
        self.split_sums.iter().find(|(m, _)| *m == model).map(|(_, table)| table)
    }

    /// Mean reflectance of a smooth interface of relative index `eta` under diffuse light.
    pub(super) fn diffuse_reflectance(&self, eta: f32) -> f32 {
        let known = self.diffuse_reflectances.iter().find(|(known, _)| (known - eta).abs() <= 1e-5 * eta);
        known.map_or_else(|| fresnel_diffuse_reflectance(eta), |(_, mean)| *mean)
    }

    /// Scattering at `point` towards `wo`, a unit vector in world space that points away from the surface: resolves
    /// textures, two-sidedness, bump and normal maps and blends.
    ///
    /// Holes are not part of it: it describes the surface that is met with probability
    /// [`opacity`](Self::opacity). Where nothing is there at all, light passes straight through.
    pub fn resolve(&self, material: MaterialId, point: &SurfacePoint, wo: Vec3) -> Bsdf {
        let mut bsdf = Bsdf::default();
        self.resolve_into(material, point, wo, &mut bsdf);
        bsdf
    }

    /// As [`resolve`](Self::resolve), in place of what `bsdf` was: it is large, and made anew at every hit.
    pub fn resolve_into(&self, material: MaterialId, point: &SurfacePoint, wo: Vec3, bsdf: &mut Bsdf) {
        Builder::resolve(self, material, point, wo, bsdf);
    }

    /// Whether [`opacity`](Self::opacity) can be below 1 anywhere.
    #[inline]
    pub fn has_opacity(&self, material: MaterialId) -> bool {
        self.materials.get(material.0 as usize).is_some_and(|prepared| prepared.has_opacity)
    }

    /// Whether nothing here scatters as a mirror does, wholly or in part: all light goes into
    /// [`LobeSet::GATHER`](super::LobeSet::GATHER).
    #[inline]
    pub fn is_diffuse(&self, material: MaterialId) -> bool {
        self.materials.get(material.0 as usize).is_none_or(|prepared| prepared.is_diffuse)
    }

    /// What of a surface is read where it is asked for its scattering or opacity.
    pub fn reads(&self, material: MaterialId) -> Reads {
        self.materials.get(material.0 as usize).map_or(Reads::NONE, |prepared| prepared.reads)
    }

    /// Probability, 0 to 1, that a ray meets the surface instead of passing straight through: masks, 0 for the null
    /// material. For rays of any kind, shadow rays included.
    pub fn opacity(&self, material: MaterialId, at: &TextureLookup) -> f32 {
        if self.has_opacity(material) { super::members::opacity(self, material, at, 0) } else { 1.0 }
    }

    /// The colour of an input, as for the emission of a shape.
    #[inline]
    pub fn color(&self, input: ColorInput, at: &TextureLookup) -> Vec3 {
        self.textures.color(input, at)
    }
}
