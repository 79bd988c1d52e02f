//! A scene compiled for rendering: primitives under one numbering, their attributes, materials and the structure that
//! answers ray queries.

use crate::SurfacePoint;
use crate::bsdf::{Materials, Reads, SurfaceModel};
use crate::facet::{Facet, OFFSET, TINY, mixed};
use crate::footprint::uv_scale;
use crate::runs::Runs;
use arrayvec::ArrayVec;
use photinus_accel::Structure;
use photinus_geometry::{Aabb, Frame, Hit, Primitives, Ray, Vec2, Vec3};
use photinus_profile::queries::QuerySink;
use photinus_scene::{
    Camera, ColorInput, FilmSettings, Geometry, IntegratorHint, Light, MaterialId, NamedMaterial, Scene, Shape,
};
use rayon::prelude::*;
use std::convert::Infallible;
use std::sync::Arc;

/// Absence of an attribute array in a [`ShapeRecord`].
const NONE: u32 = u32::MAX;

/// Facets that are worth a task of their own.
const FACETS_A_TASK: usize = 1 << 12;

/// Hits whose facets are asked for together: few enough for the nearest of caches.
pub(crate) const AHEAD: usize = 32;

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

impl ShapeRecord {
    /// Vertices of one of its triangles, counted from the first of the shape.
    #[inline]
    fn vertices(&self, primitives: &Primitives, prim: u32) -> [u32; 3] {
        primitives.triangles[prim as usize].map(|v| v - self.first_vertex)
    }
}

/// What is read first at a hit: the shape, and whether its vertices have normals.
#[derive(Clone, Copy, Default)]
pub(crate) struct Met {
    shape: u32,
    is_smooth: bool,
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
    /// Of all triangles.
    facets: Vec<Facet>,
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

    /// What hits of the triangles read.
    fn facets(&self) -> Vec<Facet> {
        let facet = |prim: u32| {
            let shape = self.runs.shape_of(prim);
            let record = &self.shapes[shape];
            let vertices = record.vertices(&self.primitives, prim);
            let normals = attributes(&self.normals, record.normals, vertices);
            let uvs = attributes(&self.uvs, record.uvs, vertices);
            Facet::new(shape as u32, self.primitives.triangle(prim as usize), normals, uvs)
        };
        (0..self.primitives.triangle_count() as u32).into_par_iter().with_min_len(FACETS_A_TASK).map(facet).collect()
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
        let (structure, (materials, facets)) =
            rayon::join(|| build(primitives), || rayon::join(|| Materials::new(&self.scene, model), || self.facets()));
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
            facets,
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

/// Attributes of the vertices of a triangle, of a shape whose attributes begin at `start`.
fn attributes<T: Copy>(all: &[T], start: u32, vertices: [u32; 3]) -> Option<[T; 3]> {
    (start != NONE).then(|| vertices.map(|v| all[(start + v) as usize]))
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
            + self.facets.len() * size_of::<Facet>()
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
        let triangles = self.primitives.triangle_count() as u32;
        if hit.prim < triangles {
            return self.facets[hit.prim as usize].outward_normal(hit.alpha, hit.beta);
        }
        let centre = self.primitives.spheres[(hit.prim - triangles) as usize].center;
        let outward = (ray.at(hit.t) - centre).try_normalize().unwrap_or(Vec3::Z);
        if self.shapes[self.shape_of(hit.prim)].flip_normals { -outward } else { outward }
    }

    /// Which side of a triangle's face, by the order of its vertices, is outside all over it: 1, -1, or none where its
    /// vertex normals do not agree.
    pub(crate) fn outer_side(&self, prim: u32) -> Option<f32> {
        self.facets[prim as usize].outer_side()
    }

    /// What at most [`AHEAD`] hits met, for [`Self::surface_of`]; anything where nothing was hit. The facets lie anywhere in
    /// memory: asked for together they come together, where hit after hit waits for its own.
    pub(crate) fn meet(&self, hits: &[Hit]) -> ArrayVec<Met, AHEAD> {
        let met = |hit: &Hit| match self.facets.get(hit.prim as usize) {
            Some(facet) => Met { shape: facet.shape, is_smooth: facet.is_smooth },
            None if hit.is_hit() => Met { shape: self.shape_of(hit.prim) as u32, is_smooth: false },
            None => Met::default(),
        };
        hits.iter().map(met).collect()
    }

    fn met(&self, prim: u32) -> Met {
        let is_smooth = self.facets.get(prim as usize).is_some_and(|facet| facet.is_smooth);
        Met { shape: self.shape_of(prim) as u32, is_smooth }
    }

    /// The surface at a hit. `width` is the width of the pixel's cone there, in scene units; 0 where unknown.
    pub(crate) fn surface(&self, ray: &Ray, hit: &Hit, width: f32) -> SurfacePoint {
        self.surface_of(self.met(hit.prim), ray, hit, width)
    }

    /// The same where the shape is known.
    #[inline]
    pub(crate) fn surface_of(&self, met: Met, ray: &Ray, hit: &Hit, width: f32) -> SurfacePoint {
        if (hit.prim as usize) < self.facets.len() {
            self.triangle_surface(met, hit.prim, [hit.alpha, hit.beta], width)
        } else {
            self.sphere_surface(met.shape, hit.prim, ray.at(hit.t), width)
        }
    }

    /// The surface of triangle `prim` at barycentrics (alpha, beta); also where a light is sampled on it.
    pub(crate) fn triangle_point(&self, prim: u32, alpha: f32, beta: f32) -> SurfacePoint {
        self.triangle_surface(self.met(prim), prim, [alpha, beta], 0.0)
    }

    #[inline]
    fn triangle_surface(
        &self,
        Met { shape, is_smooth }: Met,
        prim: u32,
        [alpha, beta]: [f32; 2],
        width: f32,
    ) -> SurfacePoint {
        let record = &self.shapes[shape as usize];
        let mut point = self.facets[prim as usize].surface(is_smooth, prim, [alpha, beta], record.reads, width);
        if record.colors != NONE && record.reads != Reads::NONE {
            let colors = record.vertices(&self.primitives, prim).map(|v| self.colors[(record.colors + v) as usize]);
            point.color = mixed(colors, alpha, beta);
        }
        point
    }

    /// The surface of sphere primitive `prim` nearest to `near`; `width` as for [`Self::surface`].
    fn sphere_surface(&self, shape: u32, prim: u32, near: Vec3, width: f32) -> SurfacePoint {
        let record = &self.shapes[shape as usize];
        let sphere = self.primitives.spheres[prim as usize - self.primitives.triangle_count()];
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
            shape,
            prim,
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
        self.sphere_surface(self.shape_of(prim) as u32, prim, near, 0.0)
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
