//! The scene that all engines render, as plain data: read back from what `photinus scenes write` wrote, so that every
//! peer's description comes from the built-in scene's own numbers.

use crate::Failure;
use roxmltree::{Document, Node};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Red, green and blue, or a point in space.
pub type Triple = [f32; 3];

/// A scene of the kinds of things that the bench can put into every engine's words.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Scene {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// Surfaces by name.
    pub materials: BTreeMap<String, Material>,
    /// Meshes with flat faces.
    pub meshes: Vec<Mesh>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
}

/// A pinhole camera; the opening is that of the shorter side, in degrees.
#[derive(Clone, Debug, Default, Serialize, PartialEq)]
pub struct Camera {
    pub origin: Triple,
    pub target: Triple,
    pub up: Triple,
    pub fov_degrees: f32,
    pub width: u32,
    pub height: u32,
}

/// A surface.
#[derive(Clone, Debug, Serialize, PartialEq)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Material {
    /// Diffuse on both sides.
    Diffuse { reflectance: Triple },
    /// Clear glass in air, smooth.
    Glass { ior: f32 },
    /// A smooth mirror.
    Mirror { reflectance: Triple },
}

/// Triangles with a material; where there is a radiance, their front sides emit it.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Mesh {
    pub name: String,
    pub material: String,
    pub radiance: Option<Triple>,
    pub vertices: Vec<Triple>,
    pub triangles: Vec<[u32; 3]>,
}

/// A sphere with a material.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Sphere {
    pub name: String,
    pub material: String,
    pub center: Triple,
    pub radius: f32,
}

impl Scene {
    /// Reads a scene that `photinus scenes write` wrote. What the bench cannot say in every engine's words is an error.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let folder = path.parent().unwrap_or(Path::new("."));
        Self::parse(&text, folder).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn parse(text: &str, folder: &Path) -> Result<Self, Failure> {
        let document = Document::parse(text).map_err(|e| e.to_string())?;
        let mut scene =
            Self { camera: Camera::default(), materials: BTreeMap::new(), meshes: Vec::new(), spheres: Vec::new() };
        let mut sides = BTreeMap::new();
        for node in document.root_element().children().filter(Node::is_element) {
            match (node.tag_name().name(), node.attribute("type").unwrap_or_default()) {
                ("integrator", _) => {}
                ("sensor", "perspective") => scene.camera = camera(node)?,
                ("bsdf", "twosided") => {
                    let inner = reference(node)?;
                    let side = sides.get(&inner).cloned().ok_or_else(|| format!("no material `{inner}`"))?;
                    scene.materials.insert(id(node)?, side);
                }
                ("bsdf", kind) => {
                    let material = material(node, kind)?;
                    if matches!(material, Material::Glass { .. }) {
                        scene.materials.insert(id(node)?, material);
                    } else {
                        sides.insert(id(node)?, material);
                    }
                }
                ("shape", "ply") => scene.meshes.push(mesh(node, folder)?),
                ("shape", "sphere") => scene.spheres.push(sphere(node)?),
                (tag, kind) => return Err(format!("the bench has no words for <{tag} type=\"{kind}\">")),
            }
        }
        Ok(scene)
    }

    /// The only mesh that shines.
    pub fn lamp(&self) -> Result<&Mesh, Failure> {
        let mut lamps = self.meshes.iter().filter(|mesh| mesh.radiance.is_some());
        lamps.next().filter(|_| lamps.next().is_none()).ok_or_else(|| "the scene has not one lamp".into())
    }
}

impl Mesh {
    /// Its faces as polygons: two triangles that were one flat quadrilateral are one again. Engines that sample a lamp face
    /// by face would pay twice for halves.
    pub fn polygons(&self) -> Vec<Vec<Triple>> {
        let corner = |i: u32| self.vertices[i as usize];
        let mut polygons = Vec::new();
        let mut i = 0;
        while i < self.triangles.len() {
            let [a, b, c] = self.triangles[i];
            let mut polygon = vec![corner(a), corner(b), corner(c)];
            if let Some(&[d, e, f]) = self.triangles.get(i + 1)
                && d == a
                && e == c
                && is_flat(corner(a), corner(b), corner(c), corner(f))
            {
                polygon.push(corner(f));
                i += 1;
            }
            polygons.push(polygon);
            i += 1;
        }
        polygons
    }
}

/// Whether four points lie in a plane, to rounding.
fn is_flat(a: Triple, b: Triple, c: Triple, d: Triple) -> bool {
    let minus = |p: Triple, q: Triple| [0, 1, 2].map(|i| f64::from(p[i]) - f64::from(q[i]));
    let (u, v, w) = (minus(b, a), minus(c, a), minus(d, a));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    dot(cross, w).abs() <= 1e-6 * dot(cross, cross).sqrt() * dot(w, w).sqrt()
}

fn camera(node: Node) -> Result<Camera, Failure> {
    let look = node.descendants().find(|n| n.has_tag_name("lookat")).ok_or("a camera without <lookat>")?;
    let film = named_child(node, "film")?;
    Ok(Camera {
        origin: triple(look.attribute("origin"))?,
        target: triple(look.attribute("target"))?,
        up: triple(look.attribute("up"))?,
        fov_degrees: number(property(node, "fov")?)?,
        width: number(property(film, "width")?)? as u32,
        height: number(property(film, "height")?)? as u32,
    })
}

fn material(node: Node, kind: &str) -> Result<Material, Failure> {
    match kind {
        "diffuse" => Ok(Material::Diffuse { reflectance: triple(Some(property(node, "reflectance")?))? }),
        "conductor" => Ok(Material::Mirror { reflectance: triple(Some(property(node, "specular_reflectance")?))? }),
        "dielectric" if number(property(node, "ext_ior")?)? == 1.0 => {
            Ok(Material::Glass { ior: number(property(node, "int_ior")?)? })
        }
        _ => Err(format!("the bench has no words for a material of kind {kind}")),
    }
}

fn mesh(node: Node, folder: &Path) -> Result<Mesh, Failure> {
    let file = folder.join(property(node, "filename")?);
    let bytes = std::fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let (vertices, triangles) = super::ply::read(&bytes).map_err(|e| format!("{}: {e}", file.display()))?;
    let emitter = node.children().find(|n| n.has_tag_name("emitter"));
    let radiance = emitter.map(|e| triple(Some(property(e, "radiance")?))).transpose()?;
    Ok(Mesh { name: id(node)?, material: reference(node)?, radiance, vertices, triangles })
}

/// A sphere of the written form: its radius, and a matrix that only moves it.
fn sphere(node: Node) -> Result<Sphere, Failure> {
    let matrix = node.descendants().find(|n| n.has_tag_name("matrix")).and_then(|n| n.attribute("value"));
    let m = numbers(matrix.ok_or("a sphere without a matrix")?)?;
    let moves = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    if m.len() != 16 || [0, 1, 2, 4, 5, 6, 8, 9, 10].map(|i| m[i]) != moves {
        return Err("a sphere's matrix does more than to move it".into());
    }
    Ok(Sphere {
        name: id(node)?,
        material: reference(node)?,
        center: [m[3], m[7], m[11]],
        radius: number(property(node, "radius")?)?,
    })
}

fn id(node: Node) -> Result<String, Failure> {
    Ok(node.attribute("id").ok_or("a thing without a name")?.to_owned())
}

fn reference(node: Node) -> Result<String, Failure> {
    Ok(named_child(node, "ref")?.attribute("id").unwrap_or_default().to_owned())
}

fn named_child<'a>(node: Node<'a, 'a>, tag: &str) -> Result<Node<'a, 'a>, Failure> {
    node.children().find(|n| n.has_tag_name(tag)).ok_or_else(|| format!("no <{tag}> where one must be"))
}

/// The value of the child called `name`.
fn property<'a>(node: Node<'a, 'a>, name: &str) -> Result<&'a str, Failure> {
    let child = node.children().find(|n| n.attribute("name") == Some(name));
    child.and_then(|n| n.attribute("value")).ok_or_else(|| format!("no `{name}` where one must be"))
}

fn number(text: &str) -> Result<f32, Failure> {
    text.trim().parse().map_err(|_| format!("`{text}` is no number"))
}

fn numbers(text: &str) -> Result<Vec<f32>, Failure> {
    text.split([' ', ',']).filter(|word| !word.is_empty()).map(number).collect()
}

fn triple(text: Option<&str>) -> Result<Triple, Failure> {
    let values = numbers(text.unwrap_or_default())?;
    values.try_into().map_err(|_| format!("`{}` is not three numbers", text.unwrap_or_default()))
}
