//! An OBJ file as a scene of its own: parts with the materials of its libraries.

use super::super::mtl::{self, Converted, Library};
use super::super::orient::{face_along_normals, face_outwards};
use super::super::{Context, Draft, LoadError, Place};
use super::{MissingNormals, ObjPart};
use crate::{ColorInput, Geometry, Material, Shape, Texture, TextureKind};
use photinus_geometry::{Affine3A, Vec3};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Files that never speak of smoothing are smooth across edges up to this angle (cosine of 40 degrees), so that a
/// teapot is round and a box is not.
const CREASE_COSINE: f32 = 0.766_044_4;

/// Reads an OBJ file as a scene of its own, with its materials.
///
/// # Errors
/// As [`read_obj`](super::read_obj); and where the file has no faces.
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    let place = Place::file(path);
    let missing = MissingNormals::AsFileSays { crease_cosine: CREASE_COSINE };
    let file = super::read(&place, path, missing, context)?;
    if file.parts.iter().all(|p| p.mesh.triangles.is_empty()) {
        return Err(LoadError::invalid(place, "no faces: there is nothing to render; is this an OBJ file?"));
    }
    let libraries = read_libraries(path, &file.libraries, context)?;
    let mut materials = Materials { path, libraries, used: HashMap::new(), missing: HashSet::new(), plain: [None; 2] };
    let mut draft = Draft::default();
    for mut part in file.parts {
        context.add_triangles(&place, part.mesh.triangles.len() as u64)?;
        let Converted { material, emission, is_glass } = materials.of_part(&part, &mut draft, context)?;
        let turned = face_along_normals(&mut part.mesh);
        if turned > 0 {
            context
                .warn(&place, format!("part \"{}\": {turned} face(s) turned to the side of their normals", part.name));
        }
        if is_glass && face_outwards(&mut part.mesh) {
            context.warn(&place, format!("part \"{}\" is glass inside out: turned over", part.name));
        }
        draft.shapes.push(Shape { name: part.name, geometry: Geometry::Mesh(part.mesh), material, emission });
    }
    Ok(draft)
}

/// The libraries that can be read; one that cannot is a warning, one that may not an error.
fn read_libraries(path: &Path, named: &[(u32, PathBuf)], context: &mut Context<'_>) -> Result<Vec<Library>, LoadError> {
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let mut libraries: Vec<Library> = Vec::new();
    for (line, names) in named {
        let place = Place::new(path, *line);
        for found in find_libraries(&place, &names.to_string_lossy(), &folder, context) {
            let read = found.and_then(|p| Ok((context.read(&place, &p)?, p)));
            let (bytes, library_path) = match read {
                Ok(read) => read,
                Err(error @ LoadError::Outside { .. }) => return Err(error),
                Err(error) => {
                    let reason = match error {
                        LoadError::Io { path, source, .. } => format!("{}: {source}", path.display()),
                        other => other.to_string(),
                    };
                    context.warn(&place, format!("material library not read: {reason}"));
                    continue;
                }
            };
            if libraries.iter().any(|l| l.path == library_path) {
                continue;
            }
            let raw = mtl::parse(&bytes);
            for note in &raw.notes {
                context.warn(&Place::new(&library_path, note.line), note.message.clone());
            }
            let own_folder = library_path.parent().map(Path::to_path_buf).unwrap_or_default();
            libraries.push(Library { path: library_path, folders: vec![own_folder, folder.clone()], raw });
        }
    }
    Ok(libraries)
}

/// The files of one `mtllib` statement. Names may hold blanks, with or without a backslash before them, and several
/// may follow each other: the whole is tried first, then what ends in ".mtl".
fn find_libraries(place: &Place, names: &str, folder: &Path, context: &Context<'_>) -> Vec<Result<PathBuf, LoadError>> {
    let folders = [folder.to_path_buf()];
    let whole = context.resolve(place, names, &folders);
    if matches!(whole, Ok(_) | Err(LoadError::Outside { .. })) {
        return vec![whole];
    }
    let mut found = Vec::new();
    let mut current = String::new();
    // A blank after a backslash belongs to the name.
    let unescaped = names.replace("\\ ", "\u{0}");
    for word in unescaped.split_whitespace() {
        if !current.is_empty() {
            current.push(' ');
        }
        current.push_str(&word.replace('\u{0}', " "));
        if current.to_lowercase().ends_with(".mtl") {
            found.push(context.resolve(place, &std::mem::take(&mut current), &folders));
        }
    }
    if !current.is_empty() {
        found.push(context.resolve(place, &current, &folders));
    }
    found
}

/// Materials of the draft, made when a part first uses them.
struct Materials<'a> {
    path: &'a Path,
    libraries: Vec<Library>,
    used: HashMap<String, Converted>,
    missing: HashSet<String>,
    /// Materials for parts without one: grey, and by vertex colours.
    plain: [Option<Converted>; 2],
}

impl Materials<'_> {
    fn of_part(
        &mut self,
        part: &ObjPart,
        draft: &mut Draft,
        context: &mut Context<'_>,
    ) -> Result<Converted, LoadError> {
        if let Some(name) = &part.material {
            if let Some(&known) = self.used.get(name) {
                return Ok(known);
            }
            let found = self.libraries.iter().find_map(|library| {
                let raw = library.raw.materials.iter().find(|m| m.name == *name)?;
                Some((raw, library))
            });
            if let Some((raw, library)) = found {
                mtl::check_permitted(raw, library, context)?;
                let converted = mtl::convert(raw, library, draft, context);
                self.used.insert(name.clone(), converted);
                return Ok(converted);
            }
            if self.missing.insert(name.clone()) {
                context.warn(&Place::file(self.path), format!("material \"{name}\" is in no library: read as grey"));
            }
        }
        let colored = !part.mesh.colors.is_empty();
        Ok(*self.plain[usize::from(colored)].get_or_insert_with(|| plain_material(draft, colored)))
    }
}

/// Mid-grey, or the vertex colours, seen from both sides.
pub(in crate::load) fn plain_material(draft: &mut Draft, colored: bool) -> Converted {
    let (name, reflectance) = if colored {
        let kind = TextureKind::VertexColor;
        let texture = Texture { name: "vertex colours".into(), kind, to_uv: Affine3A::IDENTITY };
        ("vertex-colours", ColorInput::Texture(draft.add_texture(texture)))
    } else {
        ("default", ColorInput::Constant(Vec3::splat(0.5)))
    };
    let inner = draft.add_material(format!("{name}.side"), Material::Diffuse { reflectance });
    let material = draft.add_material(name, Material::TwoSided { front: inner, back: inner });
    Converted { material, emission: None, is_glass: false }
}
