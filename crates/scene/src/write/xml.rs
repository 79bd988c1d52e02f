//! XML text with indentation and escapes.

use std::fmt::Write;

/// A document under construction.
pub struct Xml {
    text: String,
    depth: usize,
}

impl Xml {
    /// An empty document.
    pub fn new() -> Self {
        Self { text: String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"), depth: 0 }
    }

    /// Opens an element; [`Xml::close`] with the same tag ends it.
    pub fn open(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.start(tag, attributes);
        self.text.push_str(">\n");
        self.depth += 1;
    }

    /// Ends an element.
    pub fn close(&mut self, tag: &str) {
        self.depth -= 1;
        let indent = "    ".repeat(self.depth);
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{indent}</{tag}>");
    }

    /// An element without children.
    pub fn leaf(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.start(tag, attributes);
        self.text.push_str("/>\n");
    }

    fn start(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        let indent = "    ".repeat(self.depth);
        let _ = write!(self.text, "{indent}<{tag}");
        for (name, value) in attributes {
            let _ = write!(self.text, " {name}=\"{}\"", escape(value));
        }
    }

    /// A named value.
    pub fn value(&mut self, tag: &str, name: &str, value: impl std::fmt::Display) {
        self.leaf(tag, &[("name", name), ("value", &value.to_string())]);
    }

    /// The text.
    pub fn finish(self) -> String {
        self.text
    }
}

/// Characters that XML and Mitsuba's parameters give a meaning; what XML cannot hold becomes a question mark.
fn escape(value: &str) -> String {
    let mut out = String::with_capacity(value.len());
    for c in value.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' => out.push_str("&#10;"),
            '\t' => out.push_str("&#9;"),
            '\r' => out.push_str("&#13;"),
            '$' => out.push_str("\\$"),
            c if (c as u32) < 32 || matches!(c as u32, 0xfffe | 0xffff) => out.push('?'),
            c => out.push(c),
        }
    }
    out
}

/// The shortest decimal numbers that read back as the same bits, between blanks.
pub fn numbers<T: std::fmt::Display>(values: impl IntoIterator<Item = T>) -> String {
    values.into_iter().map(|v| v.to_string()).collect::<Vec<_>>().join(" ")
}
