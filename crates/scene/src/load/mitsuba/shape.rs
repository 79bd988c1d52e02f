//! `<shape>`: analytic shapes, mesh files, groups and instances, all into world space.

use super::color::Role;
use super::props::Props;
use super::tree::NodeId;
use super::{Importer, State, names};
use crate::load::LoadError;
use crate::shapes::{ROUND_SEGMENTS, cube, cylinder, disk, place_mesh, rectangle, sphere_mesh};
use crate::{ColorInput, Geometry, MaterialId, Mesh, Shape};
use glam::{DAffine3, DVec3};
use photinus_geometry::{Sphere, Vec3};
use std::sync::Arc;

/// Shapes of one scene, instances expanded: exact spheres have no triangles to count.
const MAX_SHAPES: usize = 1 << 24;
/// Segments around a sphere that a transform makes an ellipsoid.
const ELLIPSOID_SEGMENTS: u32 = 128;

impl<'t> Importer<'t, '_, '_> {
    /// The shapes that the element `id` stands for: one, or many for instances, none where it is left out.
    pub(super) fn shapes(&mut self, id: NodeId) -> Result<Vec<Shape>, LoadError> {
        let props = self.props(id)?;
        let shapes = match props.kind() {
            "shapegroup" => Vec::new(),
            "instance" => self.instance(&props)?,
            "merge" => self.children(&props)?,
            kind if names::is_supported("shape", kind) => self.plain_shape(&props)?,
            kind => {
                self.context.warn(&props.place(), names::refusal("shape", kind));
                return Ok(Vec::new());
            }
        };
        if props.kind() != "shapegroup" {
            props.finish(self.context);
        }
        if self.draft.shapes.len() + shapes.len() > MAX_SHAPES {
            return Err(props.error(format!("the scene has more than {MAX_SHAPES} shapes")));
        }
        Ok(shapes)
    }

    /// The shapes inside a group, each in the group's space.
    fn children(&mut self, props: &Props<'t>) -> Result<Vec<Shape>, LoadError> {
        self.enter(props.id())?;
        let mut shapes = Vec::new();
        for (_, child) in props.objects("shape") {
            if matches!(self.tree.node(child).kind(), "instance" | "shapegroup") {
                let message = "groups inside groups are not supported: put the shapes into one group";
                return Err(LoadError::invalid(self.tree.place(child), message));
            }
            shapes.extend(self.shapes(child)?);
        }
        self.leave();
        Ok(shapes)
    }

    fn instance(&mut self, props: &Props<'t>) -> Result<Vec<Shape>, LoadError> {
        props.ignore(&["silhouette_sampling_weight"]);
        let groups = props.objects("shape");
        let [(_, group)] = groups.as_slice() else {
            return Err(props.error("an instance needs one shapegroup"));
        };
        if self.tree.node(*group).kind() != "shapegroup" {
            return Err(props.error("an instance needs a shapegroup, not another shape"));
        }
        let map = props.transform("to_world", self.context)?.map_or(DAffine3::IDENTITY, |t| t.matrix);
        let shapes = match self.groups.get(group) {
            Some(State::Done(shapes)) => shapes.clone(),
            Some(State::Building) => return Err(self.circle(*group)),
            None => {
                self.groups.insert(*group, State::Building);
                let group_props = self.props(*group)?;
                let shapes = Arc::new(self.children(&group_props)?);
                group_props.finish(self.context);
                self.groups.insert(*group, State::Done(shapes.clone()));
                shapes
            }
        };
        let place = props.place();
        let prefix = props.node().attribute("id").map(|n| format!("{n}/")).unwrap_or_default();
        let mut placed = Vec::with_capacity(shapes.len());
        for shape in shapes.iter() {
            self.context.add_triangles(&place, shape.triangle_count() as u64)?;
            let mut shape = shape.clone();
            shape.name = format!("{prefix}{}", shape.name);
            shape.geometry = match shape.geometry {
                Geometry::Mesh(mut mesh) => {
                    place_mesh(&mut mesh, &map, false);
                    Geometry::Mesh(mesh)
                }
                Geometry::Sphere { sphere, flip_normals, axes } => {
                    let [x, y, z] = axes.map(|a| a.as_dvec3());
                    let matrix3 = glam::DMat3::from_cols(x, y, z);
                    let map = map * DAffine3 { matrix3, translation: sphere.center.as_dvec3() };
                    // Unlike the sphere's own transform, one that mirrors the instance leaves its outside outside.
                    let flip = flip_normals != (map.matrix3.determinant() < 0.0);
                    self.sphere(props, map, sphere.radius, flip)?
                }
            };
            self.check_finite(props, &shape.geometry)?;
            placed.push(shape);
        }
        Ok(placed)
    }

    /// A shape that is no group: geometry, material and light.
    fn plain_shape(&mut self, props: &Props<'t>) -> Result<Vec<Shape>, LoadError> {
        let place = props.place();
        let map = props.transform("to_world", self.context)?.map_or(DAffine3::IDENTITY, |t| t.matrix);
        let emission = self.emission(props)?;
        let bsdfs = props.objects("bsdf");
        let mut materials = Vec::with_capacity(bsdfs.len());
        for (name, id) in &bsdfs {
            materials.push((name.clone(), self.material(*id)?));
        }
        for (_, id) in props.objects("medium") {
            self.context.warn(&self.tree.place(id), "media are not rendered: ignored");
        }
        let is_file = matches!(props.kind(), "obj" | "ply" | "serialized" | "stl");
        // In Mitsuba 0.x the name of a nested BSDF could say which material of the OBJ file it is for.
        let by_material = props.kind() == "obj" && materials.len() > 1;
        if materials.len() > 1 && !by_material {
            return Err(props.error("a shape has one bsdf"));
        }
        let number = self.draft.shapes.len();
        let id_name = props.node().attribute("id");
        let mut shapes = Vec::new();
        if is_file {
            for file in self.mesh_file(props, &map, by_material)? {
                let of_part = materials.iter().find(|m| file.material.as_deref() == Some(m.0.as_str()));
                let material = of_part.or(materials.first()).map(|m| m.1);
                let name = id_name.map_or(file.name, str::to_string);
                shapes.push(self.shape(name, Geometry::Mesh(file.mesh), material, emission));
            }
        } else {
            let geometry = self.analytic(props, &map)?;
            let material = materials.first().map(|m| m.1);
            let name = self.name(props.id(), number);
            shapes.push(self.shape(name, geometry, material, emission));
        }
        shapes.retain(|shape| match &shape.geometry {
            Geometry::Mesh(mesh) if mesh.triangles.is_empty() => {
                self.context.warn(&place, format!("the shape \"{}\" has no triangles: left out", shape.name));
                false
            }
            _ => true,
        });
        for shape in &shapes {
            self.context.add_triangles(&place, shape.triangle_count() as u64)?;
            self.check_finite(props, &shape.geometry)?;
        }
        Ok(shapes)
    }

    fn shape(
        &mut self,
        name: String,
        geometry: Geometry,
        material: Option<MaterialId>,
        emission: Option<ColorInput>,
    ) -> Shape {
        let material = material.unwrap_or_else(|| self.default_material(emission.is_some()));
        Shape { name, geometry, material, emission }
    }

    /// The radiance of a nested area light.
    fn emission(&mut self, props: &Props<'t>) -> Result<Option<ColorInput>, LoadError> {
        let mut emission = None;
        for (_, id) in props.objects("emitter") {
            let light = self.props(id)?;
            if light.kind() != "area" {
                self.context.warn(
                    &light.place(),
                    format!("a shape cannot be a light of the kind \"{}\": ignored", light.kind()),
                );
                continue;
            }
            light.ignore(&["sampling_weight"]);
            if emission.is_some() {
                return Err(light.error("a shape has one emitter"));
            }
            emission = Some(self.color_or(&light, "radiance", Role::Emission, 1.0)?);
            light.finish(self.context);
        }
        Ok(emission)
    }

    /// Shapes that need no file.
    fn analytic(&mut self, props: &Props<'t>, map: &DAffine3) -> Result<Geometry, LoadError> {
        props.ignore(&["silhouette_sampling_weight"]);
        let flip = props.boolean("flip_normals")?.unwrap_or(false);
        let mut mesh = match props.kind() {
            "rectangle" => rectangle(),
            "cube" => cube(),
            "disk" => disk(ROUND_SEGMENTS),
            "cylinder" => {
                let radius = self.radius(props)?;
                let p0 = props.vector("p0")?.unwrap_or(Vec3::ZERO);
                let p1 = props.vector("p1")?.unwrap_or(Vec3::Z);
                if p0 == p1 {
                    return Err(props.error("the two ends of a cylinder are the same point"));
                }
                cylinder(p0, p1, radius, ROUND_SEGMENTS / 2)
            }
            _ => {
                let center = props.vector("center")?.unwrap_or(Vec3::ZERO);
                let moved = *map * DAffine3::from_translation(center.as_dvec3());
                return self.sphere(props, moved, self.radius(props)?, flip);
            }
        };
        place_mesh(&mut mesh, map, flip);
        Ok(Geometry::Mesh(mesh))
    }

    fn radius(&self, props: &Props<'t>) -> Result<f32, LoadError> {
        match props.float("radius")?.unwrap_or(1.0) {
            r if r > 0.0 => Ok(r),
            r => Err(props.error(format!("the radius {r} has to be above 0"))),
        }
    }

    /// The image of the sphere of this radius around the origin: a sphere where the map keeps shapes, triangles
    /// otherwise. As in Mitsuba, a map that mirrors turns the normals of a sphere.
    fn sphere(&mut self, props: &Props<'t>, map: DAffine3, radius: f32, flip: bool) -> Result<Geometry, LoadError> {
        let m = &map.matrix3;
        let axes = [m.x_axis, m.y_axis, m.z_axis];
        let lengths = axes.map(DVec3::length);
        let factor = lengths[0];
        let moved = (f64::from(radius) * factor) as f32;
        if !(moved > 0.0 && moved.is_finite() && map.translation.as_vec3().is_finite()) {
            return Err(props.error("the transform leaves a sphere without a size or a place"));
        }
        let flip_normals = flip != (m.determinant() < 0.0);
        let skew = [m.x_axis.dot(m.y_axis), m.y_axis.dot(m.z_axis), m.z_axis.dot(m.x_axis)];
        let even = lengths.iter().all(|l| (l / factor - 1.0).abs() < 1e-4)
            && skew.iter().all(|s| s.abs() < 1e-4 * factor * factor);
        if even {
            // What only turns keeps its bits.
            let turns = lengths.iter().all(|l| (l - 1.0).abs() < 1e-6);
            let (radius, axes) = if turns { (radius, axes) } else { (moved, axes.map(DVec3::normalize)) };
            let sphere = Sphere { center: map.translation.as_vec3(), radius };
            return Ok(Geometry::Sphere { sphere, flip_normals, axes: axes.map(|a| a.as_vec3()) });
        }
        self.context.warn(&props.place(), "the transform makes a sphere an ellipsoid: it becomes triangles");
        let local = Sphere { center: Vec3::ZERO, radius };
        let mut mesh: Mesh = sphere_mesh(local, [Vec3::X, Vec3::Y, Vec3::Z], false, ELLIPSOID_SEGMENTS);
        place_mesh(&mut mesh, &map, flip_normals);
        Ok(Geometry::Mesh(mesh))
    }

    fn check_finite(&self, props: &Props<'t>, geometry: &Geometry) -> Result<(), LoadError> {
        let finite = match geometry {
            Geometry::Mesh(mesh) => mesh.positions.iter().all(|p| p.is_finite()),
            Geometry::Sphere { sphere, .. } => sphere.center.is_finite() && sphere.radius.is_finite(),
        };
        if finite { Ok(()) } else { Err(props.error("the transform moves this shape beyond all bounds")) }
    }
}
