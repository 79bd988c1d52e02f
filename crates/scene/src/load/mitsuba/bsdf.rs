//! `<bsdf>`: the wrappers (two-sided, masks, mixtures, bumps); the surfaces themselves are in `material_kinds`.

use super::props::Props;
use super::tree::NodeId;
use super::value::{parse_f32, tokens};
use super::{Importer, State, names};
use crate::load::LoadError;
use crate::{ColorInput, FloatInput, Material, MaterialId};
use photinus_geometry::Vec3;

impl<'t> Importer<'t, '_, '_> {
    /// The material of the element `id`, built once.
    pub(super) fn material(&mut self, id: NodeId) -> Result<MaterialId, LoadError> {
        match self.materials.get(&id) {
            Some(State::Done(material)) => return Ok(*material),
            Some(State::Building) => return Err(self.circle(id)),
            None => {}
        }
        self.enter(id)?;
        self.materials.insert(id, State::Building);
        let built = self.build_material(id)?;
        let material = match built {
            Built::New(material) => {
                let name = self.name(id, self.draft.materials.len());
                self.draft.add_material(name, material)
            }
            Built::Same(material) => material,
        };
        self.materials.insert(id, State::Done(material));
        self.leave();
        Ok(material)
    }

    /// What a shape without a BSDF is made of: grey, or black if it is a light (as in Mitsuba).
    pub(super) fn default_material(&mut self, emits: bool) -> MaterialId {
        if let Some(material) = self.default_materials[usize::from(emits)] {
            return material;
        }
        let (name, reflectance) = if emits { ("default-black", 0.0) } else { ("default", 0.5) };
        let reflectance = ColorInput::Constant(Vec3::splat(reflectance));
        let material = self.draft.add_material(name, Material::Diffuse { reflectance });
        self.default_materials[usize::from(emits)] = Some(material);
        material
    }

    fn build_material(&mut self, id: NodeId) -> Result<Built, LoadError> {
        let props = self.props(id)?;
        if let Some(material) = self.surface(&props)? {
            props.finish(self.context);
            return Ok(Built::New(material));
        }
        let mut nested = Vec::new();
        for (_, child) in props.objects("bsdf") {
            nested.push(self.material(child)?);
        }
        let one = |what: &str| match nested.as_slice() {
            &[nested] => Ok(nested),
            _ => Err(props.error(format!("{what} needs exactly one nested bsdf"))),
        };
        let built = match props.kind() {
            "twosided" => {
                props.ignore(&["allow_transmission"]);
                let (front, back) = match nested.as_slice() {
                    [both] => (*both, *both),
                    [front, back] => (*front, *back),
                    _ => return Err(props.error("twosided needs one or two nested bsdfs")),
                };
                self.two_sided(&props, front, back)
            }
            "mask" => {
                let opacity = self.float_or(&props, "opacity", 0.5)?;
                let opacity = self.opacity(&props, opacity);
                Built::New(Material::Mask { opacity, nested: one("mask")? })
            }
            "blendbsdf" => {
                let Some(weight) = self.float_input(&props, "weight")? else {
                    return Err(props.error("blendbsdf needs a \"weight\""));
                };
                match nested.as_slice() {
                    &[a, b] => Built::New(Material::Blend { weight, a, b }),
                    _ => return Err(props.error("blendbsdf needs exactly two nested bsdfs")),
                }
            }
            "mixturebsdf" => self.mixture(&props, &nested)?,
            "bumpmap" | "bump" => {
                props.ignore(&["flip_invalid_normals", "use_shadowing_function"]);
                let nested = one("bumpmap")?;
                let scale = props.float("scale")?.unwrap_or(1.0);
                match self.nested_texture(&props, "bumpmap", true)? {
                    Some(height) => Built::New(Material::BumpMap { height, scale, nested }),
                    None => Built::Same(nested),
                }
            }
            "normalmap" => {
                props.ignore(&["flip_invalid_normals", "use_shadowing_function"]);
                let nested = one("normalmap")?;
                match self.nested_texture(&props, "normalmap", true)? {
                    Some(normals) => Built::New(Material::NormalMap { normals, nested }),
                    None => Built::Same(nested),
                }
            }
            other => self.replaced(&props, other, &nested),
        };
        props.finish(self.context);
        Ok(built)
    }

    /// Materials that are known but not rendered, and those that are not known at all.
    fn replaced(&mut self, props: &Props<'t>, kind: &str, nested: &[MaterialId]) -> Built {
        self.context.warn(&props.place(), names::refusal("bsdf", kind));
        props.ignore_all();
        match (kind, nested) {
            ("coating" | "roughcoating", &[nested]) => Built::Same(nested),
            ("polarizer" | "retarder" | "circular", _) => Built::New(Material::Null),
            _ => Built::New(Material::default_diffuse()),
        }
    }

    /// `front` outside and `back` inside. Transparent materials have both sides already: they stay as they are, and a
    /// mask is made two-sided where it is solid.
    fn two_sided(&mut self, props: &Props<'t>, front: MaterialId, back: MaterialId) -> Built {
        let transparent = self.is_transparent(front) || self.is_transparent(back);
        if !transparent {
            return Built::New(Material::TwoSided { front, back });
        }
        if let (true, Material::Mask { opacity, nested }) =
            (front == back, self.draft.materials[front.0 as usize].material.clone())
            && !self.is_transparent(nested)
        {
            let name = format!("{}-solid", self.draft.materials[front.0 as usize].name);
            let nested = self.draft.add_material(name, Material::TwoSided { front: nested, back: nested });
            return Built::New(Material::Mask { opacity, nested });
        }
        self.context.warn(&props.place(), "twosided around a transparent material has no effect: ignored");
        Built::Same(front)
    }

    /// Whether some light passes through.
    fn is_transparent(&self, id: MaterialId) -> bool {
        let material = &self.draft.materials[id.0 as usize].material;
        let own = match material {
            Material::Dielectric { .. }
            | Material::ThinDielectric { .. }
            | Material::RoughDielectric { .. }
            | Material::Mask { .. }
            | Material::Null => true,
            Material::Principled { spec_trans, .. } => *spec_trans != FloatInput::Constant(0.0),
            Material::Thesis { transmittance, .. } => *transmittance != ColorInput::Constant(Vec3::ZERO),
            _ => false,
        };
        own || material.nested().any(|nested| self.is_transparent(nested))
    }

    /// A weighted sum of materials as blends of blends; what the weights leave is black.
    fn mixture(&mut self, props: &Props<'t>, nested: &[MaterialId]) -> Result<Built, LoadError> {
        let text = props.string("weights")?.unwrap_or_default();
        let weights: Option<Vec<f32>> = tokens(text).map(parse_f32).collect();
        let weights = weights.filter(|w| w.len() == nested.len() && !w.is_empty() && w.iter().all(|&w| w >= 0.0));
        let Some(weights) = weights else {
            return Err(props.error("mixturebsdf needs \"weights\", one for each nested bsdf, none negative"));
        };
        let (mut sum, mut mixed) = (weights[0], nested[0]);
        let mut parts: Vec<(f32, MaterialId)> = weights.into_iter().zip(nested.iter().copied()).skip(1).collect();
        let total: f32 = sum + parts.iter().map(|p| p.0).sum::<f32>();
        if total < 1.0 - 1e-4 {
            let black = self.default_material(true);
            parts.push((1.0 - total, black));
        }
        for (weight, b) in parts {
            sum += weight;
            let weight = FloatInput::Constant(if sum > 0.0 { weight / sum } else { 0.0 });
            let name = format!("mixture-{}", self.draft.materials.len());
            mixed = self.draft.add_material(name, Material::Blend { weight, a: mixed, b });
        }
        Ok(Built::Same(mixed))
    }

    /// The texture inside a bump or normal map, by name or as the only one.
    fn nested_texture(
        &mut self,
        props: &Props<'t>,
        name: &str,
        raw: bool,
    ) -> Result<Option<crate::TextureId>, LoadError> {
        let textures = props.objects("texture");
        let named = textures.iter().find(|t| t.0 == name).or(match textures.as_slice() {
            [only] => Some(only),
            _ => None,
        });
        match named {
            Some(&(_, id)) => self.texture(id, raw),
            None => Err(props.error(format!("{} needs one nested texture", props.kind()))),
        }
    }
}

/// A material of its own, or one that is there.
enum Built {
    New(Material),
    Same(MaterialId),
}
