//! Mitsuba XML, versions 0.4 to 3.0: the names of all versions, the meaning of version 3.
//!
//! One file per kind of plug-in; [`names`] lists what is known of each kind.

mod bsdf;
mod camera;
mod color;
mod conductors;
mod emitter;
mod film;
mod integrator;
mod ior;
mod material_kinds;
mod mesh_file;
pub mod names;
mod props;
mod shape;
mod texture;
mod transform;
mod tree;
mod value;

use super::{Context, Draft, LoadError};
use crate::{MaterialId, Shape, TextureId};
use props::Props;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;
use tree::{NodeId, Tree};

/// Whether `head`, a file's first bytes, look like Mitsuba XML.
pub fn looks_like(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    text.trim_start_matches('\u{feff}').trim_start().starts_with('<') && text.contains("<scene")
}

/// Reads the scene file at `path`.
///
/// # Errors
/// [`LoadError`] with file and line.
pub fn load(path: &Path, context: &mut Context<'_>) -> Result<Draft, LoadError> {
    let tree = Tree::read(path, context)?;
    let mut importer = Importer {
        tree: &tree,
        context,
        draft: Draft::default(),
        materials: HashMap::new(),
        textures: HashMap::new(),
        opacities: HashMap::new(),
        groups: HashMap::new(),
        default_materials: [None; 2],
        depth: 0,
    };
    importer.scene()?;
    Ok(importer.draft)
}

/// An object that may be asked for several times, or while it is being built (a circle).
#[derive(Clone)]
enum State<T> {
    Building,
    Done(T),
}

/// Objects that refer to objects, at most this deep.
const MAX_REFERENCE_DEPTH: u32 = 64;

/// The scene being built from a tree.
struct Importer<'t, 'c, 'o> {
    tree: &'t Tree,
    context: &'c mut Context<'o>,
    draft: Draft,
    materials: HashMap<NodeId, State<MaterialId>>,
    /// By element and whether it is read as linear data; none: unreadable, mid-grey.
    textures: HashMap<(NodeId, bool), State<Option<TextureId>>>,
    /// Alpha channels used as opacity, by texture element.
    opacities: HashMap<NodeId, TextureId>,
    /// Shapes of shape groups, in the group's own space.
    groups: HashMap<NodeId, State<Arc<Vec<Shape>>>>,
    /// What shapes and emitters without a BSDF are made of.
    default_materials: [Option<MaterialId>; 2],
    /// How deep objects refer to objects now.
    depth: u32,
}

impl<'t> Importer<'t, '_, '_> {
    /// Builds everything under `<scene>`: textures and materials first, in file order, then what uses them.
    fn scene(&mut self) -> Result<(), LoadError> {
        let root = self.props(0)?;
        for (_, id) in root.objects("texture") {
            self.texture(id, false)?;
        }
        for (_, id) in root.objects("bsdf") {
            self.material(id)?;
        }
        for (_, id) in root.objects("shape") {
            let shapes = self.shapes(id)?;
            self.draft.shapes.extend(shapes);
        }
        for (_, id) in root.objects("emitter") {
            self.emitter(id)?;
        }
        let sensors = root.objects("sensor");
        for (i, &(_, id)) in sensors.iter().enumerate() {
            if i == 0 {
                self.sensor(id)?;
            } else {
                self.context.warn(&self.tree.place(id), "one camera is rendered, the first: this one is ignored");
            }
        }
        let integrators = root.objects("integrator");
        for (i, &(_, id)) in integrators.iter().enumerate() {
            if i == 0 {
                self.draft.integrator = self.integrator(id)?;
            } else {
                self.context.warn(&self.tree.place(id), "one integrator is used, the first: this one is ignored");
            }
        }
        // Colours on their own are there to be referred to.
        root.objects("spectrum");
        root.finish(self.context);
        Ok(())
    }

    fn props(&self, id: NodeId) -> Result<Props<'t>, LoadError> {
        Props::new(self.tree, id)
    }

    /// Enters an object that `id` refers to; pair with [`Importer::leave`].
    fn enter(&mut self, id: NodeId) -> Result<(), LoadError> {
        self.depth += 1;
        if self.depth > MAX_REFERENCE_DEPTH {
            let message = format!("objects refer to objects more than {MAX_REFERENCE_DEPTH} deep");
            return Err(LoadError::invalid(self.tree.place(id), message));
        }
        Ok(())
    }

    fn leave(&mut self) {
        self.depth -= 1;
    }

    fn circle(&self, id: NodeId) -> LoadError {
        let node = self.tree.node(id);
        let name = node.attribute("id").map_or_else(|| node.kind().to_string(), |n| format!("\"{n}\""));
        LoadError::invalid(self.tree.place(id), format!("the {} {name} contains itself: remove the circle", node.tag))
    }

    /// Name of an object for messages and files: its id, or its kind and a number.
    fn name(&self, id: NodeId, number: usize) -> String {
        let node = self.tree.node(id);
        node.attribute("id").map_or_else(|| format!("{}-{number}", node.kind()), str::to_string)
    }
}
