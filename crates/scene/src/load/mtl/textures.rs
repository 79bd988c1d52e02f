//! Pictures of a material library as textures of the scene.

use super::super::bitmap::{BitmapEncoding, grey_pixel, load_bitmap, tinted};
use super::super::{Context, Draft, LoadError, Place};
use super::parse::{MapKind, MapRef};
use super::{Library, RawMaterial};
use crate::{Bitmap, ColorInput, FloatInput, Texture, TextureFilter, TextureId, TextureKind, WrapMode};
use photinus_geometry::{Affine3A, Vec3};
use std::path::PathBuf;
use std::sync::Arc;

/// Most bytes of pictures beyond which none is copied for its tint.
const MAX_TINTED_BYTES: usize = 1 << 30;

/// Where pictures are looked for, and where textures go.
pub(super) struct Textures<'a, 'c> {
    pub(super) library: &'a Library,
    pub(super) draft: &'a mut Draft,
    pub(super) context: &'a mut Context<'c>,
}

impl Textures<'_, '_> {
    /// A colour times `tint`. A missing picture is a warning and either mid-grey (`show_missing`) or none.
    ///
    /// A coloured tint makes a copy of the picture; a library with very many of them gets grey ones instead.
    pub(super) fn color(&mut self, map: &MapRef, tint: Vec3, show_missing: bool) -> Option<ColorInput> {
        let tint = tint * map.gain;
        if map.base != 0.0 {
            self.warn(map, "the base value of -mm is not supported: ignored");
        }
        let Some(bitmap) = self.bitmap(map, BitmapEncoding::Auto) else {
            return show_missing.then(|| ColorInput::Texture(self.add(map, grey_pixel(), false)));
        };
        let grey = tint.x == tint.y && tint.y == tint.z;
        if grey || self.held_bytes() + bitmap.bytes() > MAX_TINTED_BYTES {
            let plain = ColorInput::Texture(self.add(map, bitmap, map.alpha));
            let factor = (tint.x + tint.y + tint.z) / 3.0;
            return Some(if factor == 1.0 { plain } else { self.scaled(map, plain, factor) });
        }
        Some(ColorInput::Texture(self.add(map, tinted(&bitmap, tint), map.alpha)))
    }

    fn scaled(&mut self, map: &MapRef, input: ColorInput, factor: f32) -> ColorInput {
        let kind = TextureKind::Scale { input, factor };
        ColorInput::Texture(self.draft.add_texture(Texture { name: map.file.clone(), kind, to_uv: Affine3A::IDENTITY }))
    }

    /// Bytes of the pictures of all textures, shared ones once for each.
    fn held_bytes(&self) -> usize {
        let bytes = |t: &Texture| if let TextureKind::Bitmap { bitmap, .. } = &t.kind { bitmap.bytes() } else { 0 };
        self.draft.textures.iter().map(bytes).sum()
    }

    /// A number: the luminance of a picture of linear values.
    pub(super) fn number(&mut self, map: &MapRef) -> Option<FloatInput> {
        self.data(map).map(FloatInput::Texture)
    }

    /// Linear values: heights, normals, roughness.
    pub(super) fn data(&mut self, map: &MapRef) -> Option<TextureId> {
        let bitmap = self.bitmap(map, BitmapEncoding::Raw)?;
        Some(self.add(map, bitmap, map.alpha))
    }

    /// Opacity: the alpha channel of a picture that has one, else its luminance.
    pub(super) fn opacity(&mut self, map: &MapRef) -> Option<FloatInput> {
        let bitmap = self.bitmap(map, BitmapEncoding::Raw)?;
        let alpha = map.alpha || has_holes(&bitmap);
        Some(FloatInput::Texture(self.add(map, bitmap, alpha)))
    }

    fn add(&mut self, map: &MapRef, bitmap: Arc<Bitmap>, alpha: bool) -> TextureId {
        let wrap = if map.clamp { WrapMode::Clamp } else { WrapMode::Repeat };
        let ([su, sv], [ou, ov]) = (map.scale, map.offset);
        let to_uv = Affine3A::from_translation(Vec3::new(ou, ov, 0.0)) * Affine3A::from_scale(Vec3::new(su, sv, 1.0));
        let kind = TextureKind::Bitmap { bitmap, filter: TextureFilter::Bilinear, wrap, alpha };
        self.draft.add_texture(Texture { name: map.file.clone(), kind, to_uv })
    }

    fn warn(&mut self, map: &MapRef, message: &str) {
        let place = Place::new(&self.library.path, map.line);
        self.context.warn(&place, format!("{}: {message}", map.statement));
    }

    /// The picture, or none and a warning.
    fn bitmap(&mut self, map: &MapRef, encoding: BitmapEncoding) -> Option<Arc<Bitmap>> {
        let place = Place::new(&self.library.path, map.line);
        let found = find(&place, &map.file, self.library, self.context);
        match found.and_then(|path| load_bitmap(&place, &path, encoding, self.context)) {
            Ok(bitmap) => Some(bitmap),
            Err(error) => {
                self.context.warn(&place, missing_message(&map.statement, &error));
                None
            }
        }
    }
}

/// Whether all pictures that the material `raw` names may be read; those that cannot be read are no matter here.
///
/// # Errors
/// [`LoadError::Outside`] for the first that lies outside the scene's folder.
pub(in crate::load) fn check_permitted(
    raw: &RawMaterial,
    library: &Library,
    context: &Context<'_>,
) -> Result<(), LoadError> {
    for (_, map) in raw.maps.iter().filter(|(kind, _)| *kind != MapKind::Unused) {
        let place = Place::new(&library.path, map.line);
        if let Err(error @ LoadError::Outside { .. }) = find(&place, &map.file, library, context) {
            return Err(error);
        }
    }
    Ok(())
}

/// The file as named; else without what follows ` #`; else under its bare name, as many files name a folder of the
/// machine that wrote them.
fn find(place: &Place, file: &str, library: &Library, context: &Context<'_>) -> Result<PathBuf, LoadError> {
    let first = context.resolve(place, file, &library.folders);
    if matches!(first, Ok(_) | Err(LoadError::Outside { .. })) {
        return first;
    }
    let uncommented = file.split(" #").next().unwrap_or(file).trim_end();
    let bare = uncommented.rsplit(['/', '\\']).next().unwrap_or(uncommented);
    for name in [uncommented, bare] {
        if name != file && !name.is_empty() {
            let found = context.resolve(place, name, &library.folders);
            if matches!(found, Ok(_) | Err(LoadError::Outside { .. })) {
                return found;
            }
        }
    }
    first
}

/// The error without its place, which the warning has already.
fn missing_message(statement: &str, error: &LoadError) -> String {
    match error {
        LoadError::Io { path, source, .. } => format!("{statement}: cannot read {}: {source}", path.display()),
        LoadError::Invalid { message, .. } => format!("{statement}: {message}"),
        other => format!("{statement}: {other}"),
    }
}

/// Whether some pixel is not opaque.
fn has_holes(bitmap: &Bitmap) -> bool {
    match &bitmap.pixels {
        crate::BitmapPixels::Rgba8 { data, .. } => data.iter().any(|p| p[3] != 255),
        crate::BitmapPixels::RgbaF32(data) => data.iter().any(|p| p[3] != 1.0),
    }
}
