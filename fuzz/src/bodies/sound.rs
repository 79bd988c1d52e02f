//! What the model promises of every scene and image that a reader returns.

use photinus::image::{DecodedImage, Image, Texels};
use photinus_scene::{Bitmap, BitmapPixels, Geometry, Mesh, Scene, TextureKind};

/// Panics where a scene breaks a promise of the model.
pub fn check_scene(scene: &Scene) {
    for shape in &scene.shapes {
        assert!((shape.material.0 as usize) < scene.materials.len(), "a material that does not exist");
        match &shape.geometry {
            Geometry::Mesh(mesh) => check_mesh(mesh),
            Geometry::Sphere { sphere, .. } => {
                assert!(sphere.center.is_finite() && sphere.radius.is_finite() && sphere.radius > 0.0, "{sphere:?}");
            }
        }
    }
    for (i, m) in scene.materials.iter().enumerate() {
        assert!(m.material.nested().all(|n| (n.0 as usize) < i), "material {i} nests a later one");
    }
    for texture in &scene.textures {
        if let TextureKind::Bitmap { bitmap, .. } = &texture.kind {
            check_bitmap(bitmap);
        }
    }
    let film = &scene.film;
    assert!(film.width > 0 && film.height > 0, "an empty film");
}

fn check_mesh(mesh: &Mesh) {
    let n = mesh.positions.len();
    assert!(mesh.positions.iter().all(|p| p.is_finite()), "positions");
    assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < n), "indices");
    assert!([mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()].iter().all(|&l| l == 0 || l == n), "lengths");
    assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "normals");
    assert!(mesh.uvs.iter().all(|x| x.is_finite()) && mesh.colors.iter().all(|x| x.is_finite()), "attributes");
}

fn check_bitmap(bitmap: &Bitmap) {
    let pixels = match &bitmap.pixels {
        BitmapPixels::Rgba8 { data, .. } => data.len(),
        BitmapPixels::RgbaF32(data) => {
            assert!(data.iter().flatten().all(|x| x.is_finite()), "a texture that is not finite");
            data.len()
        }
    };
    assert_eq!(pixels as u64, u64::from(bitmap.width) * u64::from(bitmap.height));
    assert!(pixels > 0, "an empty texture");
}

/// Panics where an image is not as large as it says.
pub fn check_image(image: &Image) {
    assert!(image.width > 0 && image.height > 0);
    assert_eq!(image.pixels.len(), image.width * image.height);
}

/// Panics where a texture is not as large as it says.
pub fn check_decoded(image: &DecodedImage) {
    let texels = match &image.texels {
        Texels::Rgba8(t) => t.len(),
        Texels::Rgba16(t) => t.len(),
        Texels::RgbaF32(t) => t.len(),
    };
    assert!(image.width > 0 && image.height > 0);
    assert_eq!(texels, image.width * image.height);
}
