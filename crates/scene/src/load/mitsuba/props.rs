//! The parameters of one plug-in: typed look-ups that remember what was asked for, so that the rest can be warned about.

use super::transform::{self, Transform};
use super::tree::{Node, NodeId, Tree};
use super::value::{parse_f32, parse_list_f32, snake_case};
use crate::load::{Context, LoadError, Place};
use photinus_geometry::Vec3;
use std::cell::Cell;

/// One child of a plug-in's element.
struct Entry {
    /// Name in today's spelling; empty where it has none.
    name: String,
    /// The child itself.
    id: NodeId,
    /// What it refers to (`<ref>`), or itself.
    target: NodeId,
    used: Cell<bool>,
}

/// The parameters and nested objects of a plug-in.
pub struct Props<'t> {
    tree: &'t Tree,
    id: NodeId,
    entries: Vec<Entry>,
}

/// Element names of values; all others are objects.
const VALUES: &[&str] =
    &["float", "integer", "boolean", "string", "vector", "point", "transform", "animation", "rgb", "srgb", "blackbody"];

impl<'t> Props<'t> {
    /// The parameters of the element `id`.
    ///
    /// # Errors
    /// References to ids that do not exist, values without a name, double names.
    pub fn new(tree: &'t Tree, id: NodeId) -> Result<Self, LoadError> {
        let mut entries: Vec<Entry> = Vec::new();
        for &child in &tree.node(id).children {
            let node = tree.node(child);
            let name = snake_case(node.attribute("name").unwrap_or_default());
            if name.is_empty() && VALUES.contains(&node.tag.as_str()) {
                return Err(LoadError::invalid(
                    tree.place(child),
                    format!("<{}> lacks the attribute \"name\"", node.tag),
                ));
            }
            if !name.is_empty() && VALUES.contains(&node.tag.as_str()) && entries.iter().any(|e| e.name == name) {
                return Err(LoadError::invalid(tree.place(child), format!("the parameter \"{name}\" is given twice")));
            }
            let target = match node.tag.as_str() {
                "ref" => {
                    let wanted = node.attribute("id").unwrap_or_default();
                    *tree.ids.get(wanted).ok_or_else(|| {
                        let message = format!("there is no object with the id \"{wanted}\"");
                        LoadError::invalid(tree.place(child), message)
                    })?
                }
                _ => child,
            };
            entries.push(Entry { name, id: child, target, used: Cell::new(false) });
        }
        Ok(Self { tree, id, entries })
    }

    /// The plug-in's name.
    pub fn kind(&self) -> &'t str {
        self.node().kind()
    }

    /// The element itself.
    pub fn node(&self) -> &'t Node {
        self.tree.node(self.id)
    }

    /// Number of the element itself.
    pub fn id(&self) -> NodeId {
        self.id
    }

    /// Where the element stands.
    pub fn place(&self) -> Place {
        self.tree.place(self.id)
    }

    /// An error at the element.
    pub fn error(&self, message: impl Into<String>) -> LoadError {
        LoadError::invalid(self.place(), message)
    }

    /// The child of that name, which counts as asked for; references are followed.
    pub fn get(&self, name: &str) -> Option<NodeId> {
        let entry = self.entries.iter().find(|e| e.name == name)?;
        entry.used.set(true);
        Some(entry.target)
    }

    /// Whether there is a child of that name.
    pub fn has(&self, name: &str) -> bool {
        self.entries.iter().any(|e| e.name == name)
    }

    /// Marks names that mean nothing to this renderer (storage formats, sampling hints): no warning.
    pub fn ignore(&self, names: &[&str]) {
        for e in self.entries.iter().filter(|e| names.contains(&e.name.as_str())) {
            e.used.set(true);
        }
    }

    /// Marks everything as known: the plug-in as a whole was warned about.
    pub fn ignore_all(&self) {
        for e in &self.entries {
            e.used.set(true);
        }
    }

    /// Nested objects whose element is called `tag`, in file order, references followed, with their names.
    pub fn objects(&self, tag: &str) -> Vec<(String, NodeId)> {
        let matching = self.entries.iter().filter(|e| self.tree.node(e.target).tag == tag);
        matching
            .map(|e| {
                e.used.set(true);
                (e.name.clone(), e.target)
            })
            .collect()
    }

    /// The value of a named element with one of these tags.
    fn value(&self, name: &str, tags: &[&str], what: &str) -> Result<Option<(NodeId, &'t str)>, LoadError> {
        let Some(id) = self.get(name) else { return Ok(None) };
        let node = self.tree.node(id);
        if !tags.contains(&node.tag.as_str()) {
            let message = format!("the parameter \"{name}\" is a <{}>, but has to be {what}", node.tag);
            return Err(LoadError::invalid(self.tree.place(id), message));
        }
        match node.attribute("value") {
            Some(text) => Ok(Some((id, text))),
            None => {
                let message = format!("the parameter \"{name}\" lacks the attribute \"value\"");
                Err(LoadError::invalid(self.tree.place(id), message))
            }
        }
    }

    fn malformed(&self, id: NodeId, name: &str, text: &str, what: &str) -> LoadError {
        let short: String = text.chars().take(40).collect();
        LoadError::invalid(
            self.tree.place(id),
            format!("the parameter \"{name}\" is \"{short}\", but has to be {what}"),
        )
    }

    /// A number.
    pub fn float(&self, name: &str) -> Result<Option<f32>, LoadError> {
        let what = "a finite number";
        let Some((id, text)) = self.value(name, &["float", "integer"], what)? else { return Ok(None) };
        parse_f32(text).map(Some).ok_or_else(|| self.malformed(id, name, text, what))
    }

    /// A number that has to lie in a range.
    pub fn float_in(&self, name: &str, range: std::ops::RangeInclusive<f32>) -> Result<Option<f32>, LoadError> {
        let Some(v) = self.float(name)? else { return Ok(None) };
        if range.contains(&v) {
            return Ok(Some(v));
        }
        let message =
            format!("the parameter \"{name}\" is {v}, but has to be from {} to {}", range.start(), range.end());
        Err(LoadError::invalid(self.place_of(name), message))
    }

    /// An angle from 0 to 180 degrees, in double precision.
    pub fn angle(&self, name: &str, default: f64) -> Result<f64, LoadError> {
        if self.float_in(name, 0.0..=180.0)?.is_none() {
            return Ok(default);
        }
        let text = self.value(name, &["float", "integer"], "a number")?.map_or("", |v| v.1);
        Ok(super::value::parse_f64(text).unwrap_or(default))
    }

    /// A whole number.
    pub fn integer(&self, name: &str) -> Result<Option<i64>, LoadError> {
        let what = "a whole number";
        let Some((id, text)) = self.value(name, &["integer", "float"], what)? else { return Ok(None) };
        let whole = text.trim().parse::<i64>().ok().or_else(|| {
            let v = super::value::parse_f64(text).filter(|v| v.fract() == 0.0 && v.abs() < 9e15)?;
            Some(v as i64)
        });
        whole.map(Some).ok_or_else(|| self.malformed(id, name, text, what))
    }

    /// A truth value.
    pub fn boolean(&self, name: &str) -> Result<Option<bool>, LoadError> {
        let what = "true or false";
        let Some((id, text)) = self.value(name, &["boolean"], what)? else { return Ok(None) };
        match text.trim().to_ascii_lowercase().as_str() {
            "true" => Ok(Some(true)),
            "false" => Ok(Some(false)),
            _ => Err(self.malformed(id, name, text, what)),
        }
    }

    /// A text.
    pub fn string(&self, name: &str) -> Result<Option<&'t str>, LoadError> {
        Ok(self.value(name, &["string"], "a <string>")?.map(|(_, text)| text))
    }

    /// A text that says which of several things is meant, in lower case.
    pub fn choice(&self, name: &str) -> Result<Option<String>, LoadError> {
        Ok(self.string(name)?.map(|s| s.trim().to_ascii_lowercase()))
    }

    /// Three numbers.
    pub fn vector(&self, name: &str) -> Result<Option<Vec3>, LoadError> {
        let Some(id) = self.get(name) else { return Ok(None) };
        let node = self.tree.node(id);
        let what = "three finite numbers";
        if !["point", "vector"].contains(&node.tag.as_str()) {
            return Err(self.malformed(id, name, &format!("<{}>", node.tag), what));
        }
        if let Some(text) = node.attribute("value") {
            return match parse_list_f32(text).as_deref() {
                Some(&[v]) => Ok(Some(Vec3::splat(v))),
                Some(&[x, y, z]) => Ok(Some(Vec3::new(x, y, z))),
                _ => Err(self.malformed(id, name, text, what)),
            };
        }
        let mut v = [0.0; 3];
        for (slot, axis) in v.iter_mut().zip(["x", "y", "z"]) {
            if let Some(text) = node.attribute(axis) {
                *slot = parse_f32(text).ok_or_else(|| self.malformed(id, name, text, what))?;
            }
        }
        Ok(Some(Vec3::from(v)))
    }

    /// A transform; of an animation the first key.
    pub fn transform(&self, name: &str, context: &mut Context<'_>) -> Result<Option<Transform>, LoadError> {
        let Some(mut id) = self.get(name) else { return Ok(None) };
        if self.tree.node(id).tag == "animation" {
            context.warn(&self.tree.place(id), "motion is not rendered: the first key of the animation is used");
            let Some(&first) = self.tree.node(id).children.first() else { return Ok(None) };
            id = first;
        }
        match self.tree.node(id).tag.as_str() {
            "transform" => transform::read(self.tree, id, context).map(Some),
            other => Err(self.malformed(id, name, &format!("<{other}>"), "a <transform>")),
        }
    }

    /// Where the parameter of that name stands, or the element.
    pub fn place_of(&self, name: &str) -> Place {
        self.entries.iter().find(|e| e.name == name).map_or_else(|| self.place(), |e| self.tree.place(e.id))
    }

    /// Warns about every child that nobody asked for.
    pub fn finish(&self, context: &mut Context<'_>) {
        for e in self.entries.iter().filter(|e| !e.used.get()) {
            let owner = self.node();
            let child = self.tree.node(e.id);
            let what = match e.name.as_str() {
                "" => format!("<{}> {}", child.tag, quoted(child.kind())),
                name => format!("parameter \"{name}\""),
            };
            let message = format!("unknown {} of {} {}: ignored", what.trim_end(), owner.tag, quoted(owner.kind()));
            context.warn(&self.tree.place(e.id), message);
        }
    }
}

fn quoted(kind: &str) -> String {
    if kind.is_empty() { String::new() } else { format!("\"{kind}\"") }
}
