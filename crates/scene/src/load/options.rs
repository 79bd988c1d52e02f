//! What a caller may decide about loading.

/// Settings of [`load`](super::load).
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOptions {
    /// Let the scene read files outside the folder of its own file. Off: such a file is an error, whether the scene
    /// leads there by `..`, by an absolute path or by a link. The file given to [`load`](super::load) is read anyway.
    pub allow_outside: bool,
    /// Values for a Mitsuba file's `<default>` names, which win over the file's.
    pub defines: Vec<(String, String)>,
    /// Most triangles of the whole scene, instances expanded.
    pub max_triangles: u64,
    /// Most bytes of one XML file.
    pub max_xml_bytes: u64,
    /// Most bytes of one mesh or texture file.
    pub max_file_bytes: u64,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            allow_outside: false,
            defines: Vec::new(),
            max_triangles: 1 << 28,
            max_xml_bytes: 256 << 20,
            max_file_bytes: 8 << 30,
        }
    }
}
