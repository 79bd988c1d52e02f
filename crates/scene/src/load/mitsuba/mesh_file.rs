//! Shapes from mesh files: what Mitsuba does to their normals and texture coordinates.

use super::Importer;
use super::props::Props;
use crate::Mesh;
use crate::load::normals::{creased_normals, smooth_normals};
use crate::load::obj::{ObjPart, read_obj};
use crate::load::ply::read_ply;
use crate::load::serialized::read_serialized;
use crate::load::stl::read_stl;
use crate::load::{LoadError, Place};
use crate::shapes::place_mesh;
use glam::DAffine3;
use std::path::PathBuf;

/// A mesh from a file, in the space of the scene or group.
pub struct FileMesh {
    /// Name in the file; empty where it has none.
    pub name: String,
    /// The OBJ material that all its faces have, if any.
    pub material: Option<String>,
    /// Geometry.
    pub mesh: Mesh,
}

impl<'t> Importer<'t, '_, '_> {
    /// Reads the mesh that the shape `props` names. An OBJ file is one mesh, or one for each of its materials where
    /// `by_material`.
    pub(super) fn mesh_file(
        &mut self,
        props: &Props<'t>,
        map: &DAffine3,
        by_material: bool,
    ) -> Result<Vec<FileMesh>, LoadError> {
        props.ignore(&["collapse", "load_materials", "load_textures", "silhouette_sampling_weight"]);
        let Some(name) = props.string("filename")? else { return Err(props.error("this shape needs a \"filename\"")) };
        let place = props.place_of("filename");
        let path: PathBuf = self.context.resolve(&place, name, &self.tree.folders_for(props.id()))?;
        let flip_normals = props.boolean("flip_normals")?.unwrap_or(false);
        let mut face_normals = props.boolean("face_normals")?.unwrap_or(false);
        let crease = props.float_in("max_smooth_angle", 0.0..=180.0)?;
        let flip_v = props.boolean("flip_tex_coords")?;
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let mut points = Vec::new();
        let mut meshes = Vec::new();
        let model_v = match props.kind() {
            "obj" => {
                let file = read_obj(&place, &path, self.context)?;
                let mut parts = file.parts;
                if !by_material {
                    parts = vec![join(&place, parts)?];
                }
                for part in parts {
                    points.push(part.points);
                    meshes.push(FileMesh { name: stem.clone(), material: part.material, mesh: part.mesh });
                }
                flip_v.unwrap_or(true)
            }
            "ply" => {
                let mesh = read_ply(&place, &path, self.context)?;
                meshes.push(FileMesh { name: stem, material: None, mesh });
                flip_v.unwrap_or(false)
            }
            "serialized" => {
                let index = props.integer("shape_index")?.unwrap_or(0);
                let index = usize::try_from(index).map_err(|_| props.error("shape_index is negative"))?;
                let file = read_serialized(&place, &path, index, self.context)?;
                face_normals |= file.face_normals;
                let name = if file.name.is_empty() { format!("{stem}-{index}") } else { file.name };
                meshes.push(FileMesh { name, material: None, mesh: file.mesh });
                false
            }
            _ => {
                let mesh = read_stl(&place, &path, self.context)?;
                face_normals = true;
                meshes.push(FileMesh { name: stem, material: None, mesh });
                true
            }
        };
        points.resize(meshes.len(), Vec::new());
        for (FileMesh { mesh, .. }, points) in meshes.iter_mut().zip(&points) {
            if !model_v {
                // Mitsuba's v runs down where the file's texture coordinates are taken as they are.
                mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
            }
            if face_normals || crease.is_some() {
                mesh.normals.clear();
            }
            place_mesh(mesh, map, flip_normals);
            match crease {
                Some(degrees) if !face_normals => creased_normals(mesh, degrees),
                _ if !face_normals && mesh.normals.is_empty() => smooth_normals(mesh, points),
                _ => {}
            }
            agree(mesh);
            if !mesh.positions.iter().all(|p| p.is_finite()) {
                let message = format!("{}: a vertex is moved beyond all bounds", path.display());
                return Err(LoadError::invalid(place, message));
            }
        }
        Ok(meshes)
    }
}

/// One mesh of all parts of an OBJ file.
fn join(place: &Place, parts: Vec<ObjPart>) -> Result<ObjPart, LoadError> {
    let mut parts = parts.into_iter();
    let Some(mut all) = parts.next() else {
        let (name, material) = (String::new(), None);
        return Ok(ObjPart { name, material, mesh: Mesh::default(), points: Vec::new() });
    };
    for part in parts {
        let first = all.mesh.positions.len();
        let count = first + part.mesh.positions.len();
        if u32::try_from(count).is_err() {
            return Err(LoadError::invalid(place.clone(), "the OBJ file has more than 2^32 vertices"));
        }
        // Where only some parts have an attribute, the others get a neutral one.
        extend(&mut all.mesh.normals, part.mesh.normals, first, count);
        extend(&mut all.mesh.uvs, part.mesh.uvs, first, count);
        extend(&mut all.mesh.colors, part.mesh.colors, first, count);
        all.mesh.positions.extend(part.mesh.positions);
        all.mesh.triangles.extend(part.mesh.triangles.into_iter().map(|t| t.map(|v| v + first as u32)));
        all.points.extend(part.points);
    }
    Ok(all)
}

/// Appends one attribute so that it is empty or `count` long.
fn extend<T: Clone + Default>(all: &mut Vec<T>, part: Vec<T>, first: usize, count: usize) {
    if all.is_empty() && part.is_empty() {
        return;
    }
    all.resize(first, T::default());
    all.extend(part);
    all.resize(count, T::default());
}

/// Makes vertex normals usable: unit length, the face's where a file has none, and faces turned to the side that all
/// their vertex normals are on (Mitsuba takes the normals' side for the outside).
fn agree(mesh: &mut Mesh) {
    if mesh.normals.is_empty() {
        return;
    }
    for n in &mut mesh.normals {
        let length_sq = n.length_squared();
        if !((length_sq - 1.0).abs() < 1e-5) {
            *n = n.try_normalize().unwrap_or_default();
        }
    }
    for t in &mut mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]);
        let dots = t.map(|v| face.dot(mesh.normals[v as usize]));
        if dots.iter().all(|&d| d < 0.0) {
            t.swap(1, 2);
        }
        for (&v, dot) in t.iter().zip(dots) {
            if dot == 0.0 && mesh.normals[v as usize] == Default::default() {
                mesh.normals[v as usize] = face.normalize_or_zero();
            }
        }
    }
    for n in mesh.normals.iter_mut().filter(|n| **n == Default::default()) {
        *n = photinus_geometry::Vec3::Z;
    }
}
