//! A scene compiled for rendering: primitives under one numbering, their attributes, materials and the structure that
//! answers ray queries.

use crate::SurfacePoint;
use crate::bsdf::{Materials, Reads, SurfaceModel};
use crate::footprint::uv_scale;
use crate::runs::Runs;
use photinus_accel::Structure;
use photinus_geometry::{Aabb, Frame, Hit, Primitives, Ray, Vec2, Vec3};
use photinus_profile::queries::QuerySink;
use photinus_scene::{
    Camera, ColorInput, FilmSettings, Geometry, IntegratorHint, Light, MaterialId, NamedMaterial, Scene, Shape,
};
use std::convert::Infallible;
use std::sync::Arc;

/// Absence of an attribute array in a [`ShapeRecord`].
const NONE: u32 = u32::MAX;

/// A point on a triangle is off its plane by at most a few units in the last place of its largest coordinates (Ray
/// Tracing Gems, chapter 6), and so is the test of a ray that starts there: 2^-20 is sixteen such units.
const OFFSET: f32 = 1.0 / 1_048_576.0;
/// Keeps the offset above zero at the origin.
const TINY: f32 = 1e-20;

/// How far off a triangle with this corner and these edges rays must start.
pub(crate) fn offset_on(corner: Vec3, edges: [Vec3; 2]) -> f32 {
    OFFSET * (corner.abs() + edges[0].abs() + edges[1].abs()).max_element() + TINY
}

/// What a shape looks like to the renderer.
#[derive(Clone, Debug)]
pub(crate) struct ShapeRecord {
    pub material: MaterialId,
    pub emission: Option<ColorInput>,
    /// First primitive id and how many.
    pub first_prim: u32,
    pub prim_count: u32,
    /// Some material around or inside this one lets light straight through.
    pub passes_light: bool,
    /// What its material and its emission read of it.
    pub reads: Reads,
    /// Start of the shape's vertices, and of its attributes where it has them.
    first_vertex: u32,
    normals: u32,
    uvs: u32,
    colors: u32,
    /// Of a sphere: inward normals, and its axes.
    flip_normals: bool,
    axes: [Vec3; 3],
}

/// A scene ready to be rendered.
pub struct World {
    /// Name of the scene.
    pub name: String,
    /// View.
    pub camera: Camera,
    /// Picture.
    pub film: FilmSettings,
    /// What the file says of the integrator.
    pub integrator: IntegratorHint,
    /// Lights without geometry.
    pub(crate) lights: Vec<Light>,
    pub(crate) primitives: Arc<Primitives>,
    pub(crate) structure: Box<dyn Structure>,
    /// Takes the queries of renders, where they are recorded.
    pub(crate) recorder: Option<Arc<dyn QuerySink>>,
    pub(crate) materials: Materials,
    pub(crate) bounds: Aabb,
    pub(crate) passes_light: bool,
    pub(crate) shapes: Vec<ShapeRecord>,
    runs: Runs,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<Vec3>,
}

/// Geometry gathered from a scene, before a structure is built over it.
pub struct Compiled {
    scene: Scene,
    primitives: Arc<Primitives>,
    shapes: Vec<ShapeRecord>,
    runs: Runs,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<Vec3>,
}

impl Compiled {
    /// Moves the geometry of `scene` into arrays of primitives and attributes.
    pub fn new(mut scene: Scene) -> Self {
        let mut primitives = Primitives::default();
        let (mut shapes, mut runs) = (Vec::new(), Vec::new());
        let (mut normals, mut uvs, mut colors) = (Vec::new(), Vec::new(), Vec::new());
        let triangles = scene.triangle_count();
        primitives.triangles.reserve_exact(triangles);
        let mut spheres = 0;
        let descriptions: Vec<Shape> = std::mem::take(&mut scene.shapes);
        let meshes = || {
            descriptions.iter().filter_map(|shape| match &shape.geometry {
                Geometry::Mesh(mesh) => Some(mesh),
                Geometry::Sphere { .. } => None,
            })
        };
        primitives.positions.reserve_exact(meshes().map(|mesh| mesh.positions.len()).sum());
        normals.reserve_exact(meshes().map(|mesh| mesh.normals.len()).sum());
        uvs.reserve_exact(meshes().map(|mesh| mesh.uvs.len()).sum());
        colors.reserve_exact(meshes().map(|mesh| mesh.colors.len()).sum());
        for (index, shape) in descriptions.into_iter().enumerate() {
            let mut record = ShapeRecord {
                material: shape.material,
                emission: shape.emission,
                first_prim: 0,
                prim_count: 0,
                passes_light: passes_light(&scene.materials, shape.material),
                reads: Reads::ALL,
                first_vertex: primitives.positions.len() as u32,
                normals: NONE,
                uvs: NONE,
                colors: NONE,
                flip_normals: false,
                axes: [Vec3::X, Vec3::Y, Vec3::Z],
            };
            match shape.geometry {
                Geometry::Mesh(mesh) => {
                    record.first_prim = primitives.triangles.len() as u32;
                    record.prim_count = mesh.triangles.len() as u32;
                    let base = record.first_vertex;
                    primitives.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + base)));
                    primitives.positions.extend_from_slice(&mesh.positions);
                    record.normals = append(&mut normals, mesh.normals);
                    record.uvs = append(&mut uvs, mesh.uvs);
                    record.colors = append(&mut colors, mesh.colors);
                }
                Geometry::Sphere { sphere, flip_normals, axes } => {
                    record.first_prim = (triangles + spheres) as u32;
                    record.prim_count = 1;
                    spheres += 1;
                    primitives.spheres.push(sphere);
                    record.flip_normals = flip_normals;
                    record.axes = axes;
                }
            }
            if record.prim_count > 0 {
                runs.push((record.first_prim, index as u32));
            }
            shapes.push(record);
        }
        let runs = Runs::new(runs, primitives.len());
        Self { scene, primitives: Arc::new(primitives), shapes, runs, normals, uvs, colors }
    }

    /// What a structure is to be built over.
    pub fn primitives(&self) -> &Arc<Primitives> {
        &self.primitives
    }

    /// The finished world, with the structure that answers its rays.
    pub fn with_structure(self, structure: Box<dyn Structure>, model: SurfaceModel) -> World {
        let Ok(world) = self.build_structure(model, |_| Ok::<_, Infallible>(structure));
        world
    }

    /// The same with a structure that is built meanwhile: neither that nor the pictures of materials keep all threads busy.
    ///
    /// # Errors
    /// Those of `build`.
    pub fn build_structure<E: Send>(
        mut self,
        model: SurfaceModel,
        build: impl FnOnce(Arc<Primitives>) -> Result<Box<dyn Structure>, E> + Send,
    ) -> Result<World, E> {
        let primitives = Arc::clone(&self.primitives);
        let (structure, materials) = rayon::join(|| build(primitives), || Materials::new(&self.scene, model));
        let structure = structure?;
        for shape in &mut self.shapes {
            shape.reads = materials.reads(shape.material) | shape.emission.map_or(Reads::NONE, Reads::of_color);
        }
        let Scene { name, camera, film, integrator, lights, .. } = &self.scene;
        Ok(World {
            name: name.clone(),
            camera: *camera,
            film: *film,
            integrator: *integrator,
            lights: lights.clone(),
            bounds: self.primitives.bounds(),
            passes_light: self.shapes.iter().any(|s| s.passes_light),
            materials,
            primitives: self.primitives,
            structure,
            recorder: None,
            shapes: self.shapes,
            runs: self.runs,
            normals: self.normals,
            uvs: self.uvs,
            colors: self.colors,
        })
    }
}

fn append<T>(all: &mut Vec<T>, more: Vec<T>) -> u32 {
    if more.is_empty() {
        return NONE;
    }
    let start = all.len() as u32;
    all.extend(more);
    start
}

fn passes_light(materials: &[NamedMaterial], id: MaterialId) -> bool {
    use photinus_scene::Material;
    let material = &materials[id.0 as usize].material;
    matches!(material, Material::Mask { .. } | Material::Null)
        || material.nested().any(|nested| passes_light(materials, nested))
}

impl World {
    /// Hands every query of renders of this world to `recorder` from now on; those of the look at the scene before the
    /// first pass are left out.
    pub fn record_queries(&mut self, recorder: Arc<dyn QuerySink>) {
        self.recorder = Some(recorder);
    }

    /// Hash of the geometry in the order of its primitive ids: FNV-1a, 64 bits, over the numbers of triangles and spheres
    /// and the bits of their vertices, centres and radii. It tells scenes apart; it is no protection against forgery.
    pub fn geometry_hash(&self) -> u64 {
        let mut hash = 0xCBF2_9CE4_8422_2325u64;
        let mut add = |bytes: &[u8]| {
            for byte in bytes {
                hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01B3);
            }
        };
        let (triangles, spheres) = (self.primitives.triangle_count(), &self.primitives.spheres);
        add(&(triangles as u64).to_le_bytes());
        add(&(spheres.len() as u64).to_le_bytes());
        for i in 0..triangles {
            for vertex in self.primitives.triangle(i) {
                vertex.to_array().iter().for_each(|x| add(&x.to_le_bytes()));
            }
        }
        for sphere in spheres {
            sphere.center.to_array().iter().for_each(|x| add(&x.to_le_bytes()));
            add(&sphere.radius.to_le_bytes());
        }
        hash
    }

    /// What rays are tested against.
    pub fn primitives(&self) -> &Arc<Primitives> {
        &self.primitives
    }

    /// Index of the shape that primitive `prim` belongs to.
    #[inline]
    pub(crate) fn shape_of(&self, prim: u32) -> usize {
        self.runs.shape_of(prim)
    }

    /// Bytes of the geometry and its attributes, the structure left out.
    pub fn geometry_bytes(&self) -> usize {
        self.primitives.positions.len() * 12
            + self.primitives.triangles.len() * 12
            + self.primitives.spheres.len() * 16
            + self.normals.len() * 12
            + self.uvs.len() * 8
            + self.colors.len() * 12
            + self.shapes.len() * size_of::<ShapeRecord>()
            + self.runs.bytes()
    }

    /// Bytes of textures and material tables.
    pub fn texture_bytes(&self) -> usize {
        self.materials.bytes()
    }

    /// The structure that answers ray queries.
    pub fn structure(&self) -> &dyn Structure {
        &*self.structure
    }

    /// Bounds of everything; empty where there is nothing.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The geometric normal at a hit, towards the outside: that of [`Self::surface`], for less.
    pub(crate) fn outward_normal(&self, ray: &Ray, hit: &Hit) -> Vec3 {
        let record = &self.shapes[self.shape_of(hit.prim)];
        let triangles = self.primitives.triangle_count() as u32;
        if hit.prim >= triangles {
            let centre = self.primitives.spheres[(hit.prim - triangles) as usize].center;
            let outward = (ray.at(hit.t) - centre).try_normalize().unwrap_or(Vec3::Z);
            return if record.flip_normals { -outward } else { outward };
        }
        let [a, b, c] = self.primitives.triangle(hit.prim as usize);
        let face = (b - a).cross(c - a).try_normalize().unwrap_or(Vec3::Z);
        if record.normals == NONE {
            return face;
        }
        let weights = [1.0 - hit.alpha - hit.beta, hit.alpha, hit.beta];
        let vertices = self.vertices(record, hit.prim as usize);
        let normal = |i: usize| self.normals[(record.normals + vertices[i]) as usize] * weights[i];
        if face.dot(normal(0) + normal(1) + normal(2)) < 0.0 { -face } else { face }
    }

    /// Which side of a triangle's face, by the order of its vertices, is outside all over it: 1, -1, or none where its
    /// vertex normals do not agree.
    pub(crate) fn outer_side(&self, prim: u32) -> Option<f32> {
        let record = &self.shapes[self.shape_of(prim)];
        if record.normals == NONE {
            return Some(1.0);
        }
        let [a, b, c] = self.primitives.triangle(prim as usize);
        let face = (b - a).cross(c - a);
        let along = self.vertices(record, prim as usize).map(|v| face.dot(self.normals[(record.normals + v) as usize]));
        let sides = [along.iter().all(|&x| x > 0.0), along.iter().all(|&x| x < 0.0)];
        match sides {
            [true, _] => Some(1.0),
            [_, true] => Some(-1.0),
            _ => None,
        }
    }

    /// The surface at a hit. `width` is the width of the pixel's cone there, in scene units; 0 where unknown.
    pub(crate) fn surface(&self, ray: &Ray, hit: &Hit, width: f32) -> SurfacePoint {
        let shape = self.shape_of(hit.prim);
        let record = &self.shapes[shape];
        let triangles = self.primitives.triangle_count() as u32;
        let mut point = if hit.prim < triangles {
            self.triangle_surface(record, hit.prim as usize, [hit.alpha, hit.beta], width)
        } else {
            self.sphere_surface(record, (hit.prim - triangles) as usize, ray.at(hit.t), width)
        };
        point.shape = shape as u32;
        point.prim = hit.prim;
        point
    }

    /// The surface of triangle `prim` at barycentrics (alpha, beta); also where a light is sampled on it.
    pub(crate) fn triangle_point(&self, prim: u32, alpha: f32, beta: f32) -> SurfacePoint {
        let shape = self.shape_of(prim);
        let record = &self.shapes[shape];
        let mut point = self.triangle_surface(record, prim as usize, [alpha, beta], 0.0);
        (point.shape, point.prim) = (shape as u32, prim);
        point
    }

    #[inline]
    fn triangle_surface(&self, record: &ShapeRecord, prim: usize, [alpha, beta]: [f32; 2], width: f32) -> SurfacePoint {
        let [a, b, c] = self.primitives.triangle(prim);
        let weights = [1.0 - alpha - beta, alpha, beta];
        let (e1, e2) = (b - a, c - a);
        let cross = e1.cross(e2);
        let face = cross.try_normalize().unwrap_or(Vec3::Z);
        let normal = if record.normals == NONE {
            face
        } else {
            let n = self.vertices(record, prim).map(|v| self.normals[(record.normals + v) as usize]);
            (n[0] * weights[0] + n[1] * weights[1] + n[2] * weights[2]).try_normalize().unwrap_or(face)
        };
        let mut point = SurfacePoint {
            position: a + e1 * alpha + e2 * beta,
            // Vertex normals say which side is out; windings in real files often do not.
            geometric_normal: if face.dot(normal) < 0.0 { -face } else { face },
            normal,
            uv: Vec2::ZERO,
            dp_du: Vec3::ZERO,
            dp_dv: Vec3::ZERO,
            color: Vec3::ONE,
            uv_footprint: 0.0,
            offset: offset_on(a, [e1, e2]),
            shape: 0,
            prim: 0,
        };
        if record.reads != Reads::NONE {
            self.add_coordinates(record, prim, [alpha, beta], &mut point);
            if width > 0.0 {
                point.uv_footprint = width * self.uv_per_length(record, prim, cross.length());
            }
        }
        point
    }

    /// Vertices of a triangle, counted from the first of its shape.
    #[inline]
    fn vertices(&self, record: &ShapeRecord, prim: usize) -> [u32; 3] {
        self.primitives.triangles[prim].map(|v| v - record.first_vertex)
    }

    /// Texture coordinates of a point of a triangle, their directions, and its vertex colour.
    fn add_coordinates(&self, record: &ShapeRecord, prim: usize, [alpha, beta]: [f32; 2], point: &mut SurfacePoint) {
        let weights = [1.0 - alpha - beta, alpha, beta];
        let local = self.vertices(record, prim);
        let edges = || {
            let [a, b, c] = self.primitives.triangle(prim);
            (b - a, c - a)
        };
        if record.uvs == NONE {
            point.uv = Vec2::new(alpha, beta);
            (point.dp_du, point.dp_dv) = edges();
        } else {
            let t = local.map(|v| self.uvs[(record.uvs + v) as usize]);
            point.uv = t[0] * weights[0] + t[1] * weights[1] + t[2] * weights[2];
            if record.reads.tangents {
                let (e1, e2) = edges();
                let (d1, d2) = (t[1] - t[0], t[2] - t[0]);
                let determinant = d1.x * d2.y - d1.y * d2.x;
                (point.dp_du, point.dp_dv) = if determinant == 0.0 || !determinant.is_finite() {
                    let frame = Frame::from_normal(point.geometric_normal);
                    (frame.s, frame.t)
                } else {
                    let inv = 1.0 / determinant;
                    ((e1 * d2.y - e2 * d1.y) * inv, (e2 * d1.x - e1 * d2.x) * inv)
                };
            }
        }
        if record.colors != NONE {
            let c = local.map(|v| self.colors[(record.colors + v) as usize]);
            point.color = c[0] * weights[0] + c[1] * weights[1] + c[2] * weights[2];
        }
    }

    /// Side of the square in texture coordinates that a unit square of a triangle is there, the inverse of
    /// [`uv_scale`]; `area` is the triangle's, twice.
    fn uv_per_length(&self, record: &ShapeRecord, prim: usize, area: f32) -> f32 {
        let uv_area = if record.uvs == NONE {
            1.0
        } else {
            let t = self.vertices(record, prim).map(|v| self.uvs[(record.uvs + v) as usize]);
            (t[1] - t[0]).perp_dot(t[2] - t[0]).abs()
        };
        if uv_area == 0.0 || !uv_area.is_finite() {
            return 1.0;
        }
        let ratio = (uv_area / area).sqrt();
        if ratio.is_finite() { ratio } else { 0.0 }
    }

    /// The surface of sphere `index` (counted among spheres) nearest to `near`.
    fn sphere_surface(&self, record: &ShapeRecord, index: usize, near: Vec3, width: f32) -> SurfacePoint {
        let sphere = self.primitives.spheres[index];
        let outward = (near - sphere.center).try_normalize().unwrap_or(Vec3::Z);
        let normal = if record.flip_normals { -outward } else { outward };
        let mut point = SurfacePoint {
            position: sphere.center + outward * sphere.radius,
            geometric_normal: normal,
            normal,
            uv: Vec2::ZERO,
            dp_du: Vec3::ZERO,
            dp_dv: Vec3::ZERO,
            color: Vec3::ONE,
            uv_footprint: 0.0,
            offset: OFFSET * (sphere.center.abs().max_element() + sphere.radius) + TINY,
            shape: 0,
            prim: 0,
        };
        let [x, y, z] = record.axes;
        let local = Vec3::new(x.dot(outward), y.dot(outward), z.dot(outward));
        use std::f32::consts::{PI, TAU};
        let Reads { textures, tangents } = record.reads;
        if textures {
            let phi = libm::atan2f(local.y, local.x);
            let phi = if phi < 0.0 { phi + TAU } else { phi };
            let theta = libm::acosf(local.z.clamp(-1.0, 1.0));
            point.uv = Vec2::new(phi / TAU, 1.0 - theta / PI);
        }
        if tangents || (textures && width > 0.0) {
            let dp_du = (y * local.x - x * local.y) * (TAU * sphere.radius);
            let at_pole = !(dp_du.length_squared() > 1e-12 * sphere.radius * sphere.radius);
            point.dp_du = if at_pole { Frame::from_normal(normal).s * sphere.radius } else { dp_du };
            point.dp_dv = outward.cross(point.dp_du.normalize()) * (PI * sphere.radius);
            let scale = uv_scale(point.dp_du, point.dp_dv);
            point.uv_footprint = if scale > 0.0 { width / scale } else { 0.0 };
        }
        point
    }

    /// The surface of sphere primitive `prim` nearest to `near`.
    pub(crate) fn sphere_point(&self, prim: u32, near: Vec3) -> SurfacePoint {
        let shape = self.shape_of(prim);
        let index = prim as usize - self.primitives.triangle_count();
        let record = &self.shapes[shape];
        let mut point = self.sphere_surface(record, index, near, 0.0);
        (point.shape, point.prim) = (shape as u32, prim);
        point
    }

    /// Radiance that leaves the surface at `point` towards `wo` by its own emission.
    pub(crate) fn emitted(&self, point: &SurfacePoint, wo: Vec3) -> Vec3 {
        match self.shapes[point.shape as usize].emission {
            Some(input) if point.geometric_normal.dot(wo) > 0.0 => self.materials.color(input, &point.lookup()),
            _ => Vec3::ZERO,
        }
    }

    /// Whether no light at all passes straight through a primitive, wherever on it; most have no need of a look at theirs.
    pub(crate) fn stops_light(&self, prim: u32) -> bool {
        !self.shapes[self.shape_of(prim)].passes_light
    }

    /// Share of light that passes straight through the surface at `point`, 0 to 1.
    pub(crate) fn transparency(&self, point: &SurfacePoint) -> f32 {
        let record = &self.shapes[point.shape as usize];
        if record.passes_light { 1.0 - self.materials.opacity(record.material, &point.lookup()) } else { 0.0 }
    }
}
