//! A scene under construction: what importers fill before defaults complete it.

use crate::{
    Camera, FilmSettings, IntegratorHint, Light, Material, MaterialId, NamedMaterial, Shape, Texture, TextureId,
};

/// What an importer found. No camera, film or integrator means that the file says nothing of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draft {
    /// All objects.
    pub shapes: Vec<Shape>,
    /// All materials; nested ones come before those around them.
    pub materials: Vec<NamedMaterial>,
    /// All textures.
    pub textures: Vec<Texture>,
    /// Lights without geometry; of several environments the first counts.
    pub lights: Vec<Light>,
    /// The view.
    pub camera: Option<Camera>,
    /// The picture.
    pub film: Option<FilmSettings>,
    /// What the file says of the integrator.
    pub integrator: Option<IntegratorHint>,
}

impl Draft {
    /// Adds a material.
    pub fn add_material(&mut self, name: impl Into<String>, material: Material) -> MaterialId {
        self.materials.push(NamedMaterial { name: name.into(), material });
        MaterialId((self.materials.len() - 1) as u32)
    }

    /// Adds a texture.
    pub fn add_texture(&mut self, texture: Texture) -> TextureId {
        self.textures.push(texture);
        TextureId((self.textures.len() - 1) as u32)
    }
}
