//! Shapes: exact spheres as such, everything else as PLY.

use super::names::file_name;
use super::xml::numbers;
use super::{WriteError, Writer, make_folder, ply};
use crate::Geometry;

impl Writer<'_> {
    /// Writes a shape and its mesh file.
    pub(super) fn shape(&mut self, index: usize) -> Result<(), WriteError> {
        let scene = self.scene;
        let shape = &scene.shapes[index];
        let name = self.shapes.get(index).to_string();
        match &shape.geometry {
            Geometry::Mesh(mesh) => {
                let relative = format!("meshes/{index}-{}.ply", file_name(&name));
                make_folder(&self.folder.join("meshes"))?;
                photinus_image::write_atomic(self.folder.join(&relative), &ply::encode(mesh))?;
                self.xml.open("shape", &[("type", "ply"), ("id", &name)]);
                self.xml.value("string", "filename", relative);
                // The file's v runs up, Mitsuba's down.
                self.xml.value("boolean", "flip_tex_coords", true);
                if mesh.normals.is_empty() {
                    self.xml.value("boolean", "face_normals", true);
                }
            }
            Geometry::Sphere { sphere, flip_normals, axes } => {
                self.xml.open("shape", &[("type", "sphere"), ("id", &name)]);
                let c = sphere.center;
                let [x, y, z] = *axes;
                let rows = [[x.x, y.x, z.x, c.x], [x.y, y.y, z.y, c.y], [x.z, y.z, z.z, c.z], [0.0, 0.0, 0.0, 1.0]];
                self.xml.value("float", "radius", sphere.radius);
                // A mirroring transform turns a sphere's normals in Mitsuba.
                let mirrors = x.cross(y).dot(z) < 0.0;
                if *flip_normals != mirrors {
                    self.xml.value("boolean", "flip_normals", true);
                }
                self.xml.open("transform", &[("name", "to_world")]);
                self.xml.leaf("matrix", &[("value", &numbers(rows.iter().flatten()))]);
                self.xml.close("transform");
            }
        }
        let material = self.materials.get(shape.material.0 as usize).to_string();
        self.xml.leaf("ref", &[("id", &material)]);
        if let Some(emission) = &shape.emission {
            self.xml.open("emitter", &[("type", "area")]);
            self.color("radiance", emission);
            self.xml.close("emitter");
        }
        self.xml.close("shape");
        Ok(())
    }
}
