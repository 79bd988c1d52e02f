//! The scene description that every importer fills and the renderer reads.

mod camera;
mod light;
mod material;
mod mesh;
mod scene;
mod texture;

pub use camera::{Camera, FilmSettings, Filter, FovAxis, IntegratorHint, IntegratorKind, Projection};
pub use light::{EnvironmentLight, Light};
pub use material::{Material, MaterialId, MicrofacetModel, NamedMaterial};
pub use mesh::{Geometry, Mesh, Shape};
pub use scene::{Scene, Warning};
pub use texture::{
    Bitmap, BitmapPixels, ColorInput, FloatInput, Texture, TextureFilter, TextureId, TextureKind, WrapMode,
};
