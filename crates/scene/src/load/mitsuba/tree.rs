//! The XML of a Mitsuba scene as one tree: includes spliced in, `$` parameters replaced, ids collected.

use crate::load::{Context, LoadError, Place, context::read_limited};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Index of a [`Node`].
pub type NodeId = u32;

/// Elements nested deeper than this are refused: no scene is, and every later walk may recurse.
const MAX_DEPTH: u32 = 100;
/// Files included inside one another, as many as Mitsuba allows.
const MAX_INCLUDE_DEPTH: usize = 15;
/// Files of one scene.
const MAX_FILES: usize = 4096;
/// Elements of one scene.
const MAX_NODES: u32 = 1 << 24;
/// Bytes of one attribute after parameters are replaced: parameters made of parameters grow exponentially.
const MAX_ATTRIBUTE: usize = 16 << 20;

/// One element.
#[derive(Debug)]
pub struct Node {
    /// Element name; names of Mitsuba 0.3 are turned into today's.
    pub tag: String,
    /// Attributes in file order, parameters replaced.
    pub attributes: Vec<(String, String)>,
    /// Index into [`Tree::files`].
    pub file: u32,
    /// Line, from 1.
    pub line: u32,
    /// Children in file order.
    pub children: Vec<NodeId>,
}

impl Node {
    /// Value of an attribute.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    /// The plug-in's name: the attribute `type`.
    pub fn kind(&self) -> &str {
        self.attribute("type").unwrap_or_default()
    }
}

/// A file of the scene.
#[derive(Debug)]
pub struct SourceFile {
    /// Where it lies.
    pub path: PathBuf,
    /// Its `version`: major and minor number.
    pub version: (u32, u32),
}

/// A scene file with all it includes.
#[derive(Debug, Default)]
pub struct Tree {
    /// Elements; 0 is the root.
    pub nodes: Vec<Node>,
    /// Elements with an `id`, aliases included.
    pub ids: HashMap<String, NodeId>,
    /// The files, the scene itself first.
    pub files: Vec<SourceFile>,
    /// Folders in which files are looked for, first wins.
    pub folders: Vec<PathBuf>,
}

impl Tree {
    /// Reads the scene file at `path` and all that it includes.
    ///
    /// # Errors
    /// Malformed XML, missing includes, undefined parameters, double ids, anything beyond the limits above.
    pub fn read(path: &Path, context: &mut Context<'_>) -> Result<Self, LoadError> {
        let mut reader = Reader {
            tree: Self { folders: vec![folder_of(path)], ..Self::default() },
            parameters: Vec::new(),
            aliases: Vec::new(),
            open: Vec::new(),
            context,
        };
        for (name, value) in &reader.context.options.defines {
            insert_parameter(&mut reader.parameters, name, value);
        }
        reader.file(&Place::file(path), path, None)?;
        reader.resolve_aliases()?;
        Ok(reader.tree)
    }

    /// The element with this number.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id as usize]
    }

    /// Where an element stands.
    pub fn place(&self, id: NodeId) -> Place {
        let node = self.node(id);
        Place::new(&self.files[node.file as usize].path, node.line)
    }

    /// Whether an element's file is of Mitsuba 0.x.
    pub fn is_old(&self, id: NodeId) -> bool {
        self.files[self.node(id).file as usize].version.0 < 2
    }

    /// Folders in which a file that an element names is looked for.
    pub fn folders_for(&self, id: NodeId) -> Vec<PathBuf> {
        let mut folders = self.folders.clone();
        folders.push(folder_of(&self.files[self.node(id).file as usize].path));
        folders
    }
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().map(Path::to_path_buf).unwrap_or_default()
}

/// Attributes that an element may have; others are warned about.
fn known_attributes(tag: &str) -> &'static [&'static str] {
    match tag {
        "scene" => &["version", "type", "id", "name"],
        "float" | "integer" | "boolean" | "string" => &["name", "value"],
        "vector" | "point" => &["name", "value", "x", "y", "z"],
        "rgb" | "srgb" => &["name", "value", "intent"],
        "spectrum" => &["name", "value", "filename", "type", "id", "intent"],
        "blackbody" => &["name", "temperature", "scale"],
        "transform" => &["name"],
        "translate" | "scale" => &["x", "y", "z", "value"],
        "rotate" => &["x", "y", "z", "value", "angle"],
        "lookat" => &["origin", "target", "up"],
        "matrix" => &["value"],
        "ref" => &["id", "name"],
        "include" => &["filename", "name"],
        "alias" => &["id", "as"],
        "default" => &["name", "value"],
        "path" => &["value"],
        _ => &["type", "id", "name"],
    }
}

/// Elements that exist.
const TAGS: &[&str] = &[
    "scene",
    "bsdf",
    "emitter",
    "film",
    "integrator",
    "medium",
    "phase",
    "rfilter",
    "sampler",
    "sensor",
    "shape",
    "subsurface",
    "texture",
    "volume",
    "spectrum",
    "rgb",
    "srgb",
    "blackbody",
    "float",
    "integer",
    "boolean",
    "string",
    "vector",
    "point",
    "transform",
    "translate",
    "scale",
    "rotate",
    "lookat",
    "matrix",
    "ref",
    "animation",
];

struct Reader<'c, 'o> {
    tree: Tree,
    /// (`$name`, value), longest name first.
    parameters: Vec<(String, String)>,
    /// (new name, old name, place).
    aliases: Vec<(String, String, Place)>,
    /// Files being read, to find those that include themselves.
    open: Vec<PathBuf>,
    context: &'c mut Context<'o>,
}

impl Reader<'_, '_> {
    /// Reads one file; its content goes under `parent`, or becomes the root.
    fn file(&mut self, asked: &Place, path: &Path, parent: Option<NodeId>) -> Result<(), LoadError> {
        let real = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if self.open.contains(&real) {
            return Err(LoadError::invalid(
                asked.clone(),
                format!("{} includes itself: remove the circle", path.display()),
            ));
        }
        if self.open.len() >= MAX_INCLUDE_DEPTH || self.tree.files.len() >= MAX_FILES {
            return Err(LoadError::invalid(asked.clone(), "too many includes: put the scene into fewer files"));
        }
        self.open.push(real);
        let text = decode(asked, path, read_limited(asked, path, self.context.options.max_xml_bytes)?)?;
        let options = roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..Default::default() };
        let document = roxmltree::Document::parse_with_options(&text, options).map_err(|e| {
            let place = Place::new(path, e.pos().row);
            LoadError::invalid(place, format!("this is no well-formed XML: {}", describe(&e)))
        })?;
        let lines = Lines::new(&text);
        let root = document.root_element();
        let place = Place::new(path, lines.line(root.range().start));
        let version = root.attribute("version").unwrap_or("3.0.0");
        let version = parse_version(version)
            .ok_or_else(|| LoadError::invalid(place.clone(), format!("\"{version}\" is no version number")))?;
        let file = self.tree.files.len() as u32;
        self.tree.files.push(SourceFile { path: path.to_path_buf(), version });
        match (parent, root.tag_name().name()) {
            (None, "scene") | (Some(_), _) => {}
            (None, other) => {
                let message = format!("the outermost element is <{other}>, not <scene>: this is no Mitsuba scene");
                return Err(LoadError::invalid(place, message));
            }
        }
        if root.attribute("version").is_none() {
            self.context.warn(&place, "no version: read as Mitsuba 3.0");
        }
        if let (Some(parent), "scene") = (parent, root.tag_name().name()) {
            for child in root.children().filter(roxmltree::Node::is_element) {
                self.element(child, &lines, file, Some(parent), 1)?;
            }
        } else {
            self.element(root, &lines, file, parent, 0)?;
        }
        self.open.pop();
        Ok(())
    }

    fn element(
        &mut self,
        xml: roxmltree::Node<'_, '_>,
        lines: &Lines,
        file: u32,
        parent: Option<NodeId>,
        depth: u32,
    ) -> Result<(), LoadError> {
        let line = lines.line(xml.range().start);
        let place = Place::new(&self.tree.files[file as usize].path, line);
        if depth > MAX_DEPTH {
            return Err(LoadError::invalid(place, format!("elements are nested more than {MAX_DEPTH} deep")));
        }
        let tag = match xml.tag_name().name() {
            "luminaire" => "emitter",
            "camera" => "sensor",
            other => other,
        };
        let mut attributes = Vec::with_capacity(xml.attributes().len());
        for a in xml.attributes() {
            attributes.push((a.name().to_string(), self.substitute(&place, a.value())?));
        }
        let known = known_attributes(tag);
        let is_outermost = |n: &str| n == "version" && xml.parent().is_some_and(|p| p.is_root());
        for (name, _) in attributes.iter().filter(|(n, _)| !known.contains(&n.as_str()) && !is_outermost(n)) {
            self.context.warn(&place, format!("unknown attribute \"{name}\" of <{tag}>: ignored"));
        }
        let get = |name: &str| attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str());
        let need = |name: &str| {
            get(name)
                .ok_or_else(|| LoadError::invalid(place.clone(), format!("<{tag}> lacks the attribute \"{name}\"")))
        };
        match tag {
            "default" => insert_parameter(&mut self.parameters, need("name")?, need("value")?),
            "alias" => self.aliases.push((need("as")?.to_string(), need("id")?.to_string(), place)),
            "path" => {
                let folder = folder_of(&place.file).join(need("value")?);
                if folder.is_dir() {
                    self.tree.folders.insert(0, folder);
                } else {
                    let message = format!("<path>: there is no folder {}: ignored", folder.display());
                    self.context.warn(&place, message);
                }
            }
            "include" => {
                let mut folders = vec![folder_of(&place.file)];
                folders.extend(self.tree.folders.iter().cloned());
                let path = self.context.resolve(&place, need("filename")?, &folders)?;
                self.file(&place, &path, parent)?;
            }
            _ if !TAGS.contains(&tag) => {
                self.context.warn(&place, format!("unknown element <{tag}>: ignored"));
            }
            _ => {
                let id = self.tree.nodes.len() as NodeId;
                if id >= MAX_NODES {
                    return Err(LoadError::invalid(place, format!("the scene has more than {MAX_NODES} elements")));
                }
                if let (Some(name), true) = (get("id"), tag != "ref")
                    && let Some(first) = self.tree.ids.insert(name.to_string(), id)
                {
                    let message =
                        format!("the id \"{name}\" is taken by line {}: ids are unique", self.tree.node(first).line);
                    return Err(LoadError::invalid(place, message));
                }
                self.tree.nodes.push(Node { tag: tag.to_string(), attributes, file, line, children: Vec::new() });
                if let Some(parent) = parent {
                    self.tree.nodes[parent as usize].children.push(id);
                }
                for child in xml.children().filter(roxmltree::Node::is_element) {
                    self.element(child, lines, file, Some(id), depth + 1)?;
                }
            }
        }
        Ok(())
    }

    /// Replaces `$name` by the parameter's value; `\$` is a plain dollar sign.
    fn substitute(&self, place: &Place, value: &str) -> Result<String, LoadError> {
        if !value.contains('$') {
            return Ok(value.to_string());
        }
        let mut out = String::with_capacity(value.len());
        let mut rest = value;
        while let Some(at) = rest.find('$') {
            let (before, from) = rest.split_at(at);
            if let Some(escaped) = before.strip_suffix('\\') {
                out.push_str(escaped);
                out.push('$');
                rest = &from[1..];
                continue;
            }
            out.push_str(before);
            let Some((name, value)) = self.parameters.iter().find(|(name, _)| from.starts_with(name.as_str())) else {
                let end = from[1..].find(|c: char| !c.is_alphanumeric() && c != '_').map_or(from.len(), |e| e + 1);
                let name = &from[1..end];
                let message = format!("${name} is not defined: add <default name=\"{name}\" value=\"...\"/> above");
                return Err(LoadError::invalid(place.clone(), message));
            };
            out.push_str(value);
            rest = &from[name.len()..];
            if out.len() > MAX_ATTRIBUTE {
                return Err(LoadError::invalid(place.clone(), "the parameters make an attribute of more than 16 MiB"));
            }
        }
        out.push_str(rest);
        Ok(out)
    }

    fn resolve_aliases(&mut self) -> Result<(), LoadError> {
        for (new, old, place) in std::mem::take(&mut self.aliases) {
            let Some(&target) = self.tree.ids.get(&old) else {
                return Err(LoadError::invalid(place, format!("<alias>: there is no id \"{old}\" above")));
            };
            if self.tree.ids.insert(new.clone(), target).is_some() {
                return Err(LoadError::invalid(place, format!("<alias>: the id \"{new}\" is taken")));
            }
        }
        Ok(())
    }
}

/// Adds a parameter unless it is there; those with longer names come first, as one name may begin another.
fn insert_parameter(parameters: &mut Vec<(String, String)>, name: &str, value: &str) {
    let key = format!("${name}");
    if name.is_empty() || parameters.iter().any(|(k, _)| *k == key) {
        return;
    }
    let at = parameters.iter().position(|(k, _)| k.len() < key.len()).unwrap_or(parameters.len());
    parameters.insert(at, (key, value.to_string()));
}

/// "0.5.0" as (0, 5).
fn parse_version(text: &str) -> Option<(u32, u32)> {
    let mut parts = text.trim().split('.').map(|p| p.parse::<u32>().ok());
    let major = parts.next()??;
    let minor = parts.next().unwrap_or(Some(0))?;
    Some((major, minor))
}

/// roxmltree's message without its position, which the place says.
fn describe(error: &roxmltree::Error) -> String {
    let text = error.to_string();
    match text.rfind(" at ") {
        Some(at) if text[at + 4..].starts_with(|c: char| c.is_ascii_digit()) => text[..at].to_string(),
        _ => text,
    }
}

/// Text of an XML file in UTF-8, UTF-16 with its mark, or the older one-byte encoding that some exporters write.
fn decode(asked: &Place, path: &Path, bytes: Vec<u8>) -> Result<String, LoadError> {
    let utf16 = |from: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2).map(|c| from([c[0], c[1]]));
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>()
    };
    match bytes.as_slice() {
        [0xff, 0xfe, ..] => return Ok(utf16(u16::from_le_bytes)),
        [0xfe, 0xff, ..] => return Ok(utf16(u16::from_be_bytes)),
        _ => {}
    }
    let bytes = match String::from_utf8(bytes) {
        Ok(text) => return Ok(text),
        Err(e) => e.into_bytes(),
    };
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_lowercase();
    if ["iso-8859-1", "latin1", "windows-1252", "us-ascii"].iter().any(|e| head.contains(e)) {
        return Ok(bytes.iter().map(|&b| char::from(b)).collect());
    }
    let message = format!("{} is no UTF-8 text: save it as UTF-8", path.display());
    Err(LoadError::invalid(asked.clone(), message))
}

/// Line numbers of byte offsets.
struct Lines(Vec<usize>);

impl Lines {
    fn new(text: &str) -> Self {
        Self(std::iter::once(0).chain(text.bytes().enumerate().filter(|b| b.1 == b'\n').map(|b| b.0 + 1)).collect())
    }

    fn line(&self, offset: usize) -> u32 {
        self.0.partition_point(|&start| start <= offset) as u32
    }
}
