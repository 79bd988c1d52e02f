//! The header of a PLY file: its encoding and what its elements are made of.

use super::super::text::{Fault, name, parse_i64, quoted};

/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn named(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }
}

/// One property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    /// Type of the value, or of the list's values.
    pub(super) value: Type,
    /// Type of the length, for lists.
    pub(super) list: Option<Type>,
}

/// A kind of element: how many, and their properties in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Bytes of one in a binary file; a list counts with its length only.
    pub(super) fn least_size(&self) -> u64 {
        self.properties.iter().map(|p| p.list.unwrap_or(p.value).size() as u64).sum()
    }

    /// Whether all of them have the same size.
    pub(super) fn is_fixed(&self) -> bool {
        self.properties.iter().all(|p| p.list.is_none())
    }
}

/// A header, and where the data begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Offset of the data in bytes, and their first line.
    pub(super) data_at: usize,
    pub(super) data_line: u32,
}

/// Most bytes before `end_header`.
const MAX_HEADER: usize = 1 << 20;
/// Most properties of all elements.
const MAX_PROPERTIES: usize = 4096;

/// Reads the header.
pub(super) fn parse(bytes: &[u8]) -> Result<Header, Fault> {
    let mut lines = Lines { bytes: &bytes[..bytes.len().min(MAX_HEADER)], at: 0, line: 0 };
    if lines.next().map(<[u8]>::trim_ascii) != Some(b"ply") {
        return Err(Fault::new(1, "not a PLY file: the first line must be \"ply\""));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut properties = 0;
    loop {
        let Some(text) = lines.next() else {
            return Err(Fault::new(lines.line, "the header has no end_header: the file is cut off or damaged"));
        };
        let line = lines.line;
        let words: Vec<&[u8]> = text.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).collect();
        match words.as_slice() {
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"end_header", ..] => break,
            [b"format", word, ..] => {
                encoding = Some(match *word {
                    b"ascii" => Encoding::Text,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    other => return Err(Fault::new(line, format!("unknown format {}", quoted(other)))),
                });
            }
            [b"element", element, count] => {
                let count = parse_i64(count).and_then(|n| u64::try_from(n).ok());
                let Some(count) = count else {
                    return Err(Fault::new(line, format!("element {}: the count is not a number", quoted(element))));
                };
                let element = name(element);
                // Two lists of vertices could have different attributes, and indices would have two meanings.
                if elements.iter().any(|e| e.name == element) {
                    return Err(Fault::new(line, format!("element {} is declared twice", quoted(element.as_bytes()))));
                }
                elements.push(Element { name: element, count, properties: Vec::new() });
            }
            [b"property", rest @ ..] => {
                let Some(element) = elements.last_mut() else {
                    return Err(Fault::new(line, "a property before the first element"));
                };
                element.properties.push(property(rest, line)?);
                properties += 1;
            }
            [other, ..] => return Err(Fault::new(line, format!("unknown header statement {}", quoted(other)))),
        }
        if properties > MAX_PROPERTIES || elements.len() > MAX_PROPERTIES {
            return Err(Fault::new(line, format!("more than {MAX_PROPERTIES} properties")));
        }
    }
    let Some(encoding) = encoding else {
        return Err(Fault::new(lines.line, "the header has no format statement"));
    };
    Ok(Header { encoding, elements, data_at: lines.at, data_line: lines.line + 1 })
}

fn property(words: &[&[u8]], line: u32) -> Result<Property, Fault> {
    let named = |word: &[u8]| {
        Type::named(word).ok_or_else(|| Fault::new(line, format!("unknown property type {}", quoted(word))))
    };
    match *words {
        [b"list", length, value, property] => {
            let length_type = named(length)?;
            if matches!(length_type, Type::F32 | Type::F64) {
                return Err(Fault::new(line, "the length of a list must be of an integer type"));
            }
            Ok(Property { name: name(property), value: named(value)?, list: Some(length_type) })
        }
        [value, property] => Ok(Property { name: name(property), value: named(value)?, list: None }),
        _ => Err(Fault::new(line, "a property needs a type and a name")),
    }
}

/// Header lines, ended by LF, CR LF or CR.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        let left = &self.bytes[self.at..];
        let end = left.iter().position(|&b| b == b'\n' || b == b'\r')?;
        let length = 1 + usize::from(left[end] == b'\r' && left.get(end + 1) == Some(&b'\n'));
        self.at += end + length;
        self.line += 1;
        Some(&left[..end])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_end_and_type_is_read() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["ply", "format binary_big_endian 1.0", "comment a b", "element vertex 3", "property double x"]
                .into_iter()
                .chain(["element face 1", "property list uint8 int32 vertex_index", "obj_info", "end_header", ""])
                .collect::<Vec<_>>()
                .join(end);
            let header = parse((text.clone() + "data").as_bytes()).unwrap();
            assert_eq!((header.encoding, header.data_at), (Encoding::BigEndian, text.len()));
            assert_eq!(header.elements[0].least_size(), 8);
            let list = &header.elements[1].properties[0];
            assert_eq!((list.list, list.value, header.elements[1].count), (Some(Type::U8), Type::I32, 1));
        }
    }

    #[test]
    fn broken_headers_say_what_is_wrong() {
        for (text, message) in [
            ("", "first line"),
            ("plx\n", "first line"),
            ("ply\nend_header\n", "no format"),
            ("ply\nformat ascii 1.0\nelement vertex 3\n", "end_header"),
            ("ply\nformat utf8 1.0\n", "unknown format \"utf8\""),
            ("ply\nelement vertex -3\n", "count"),
            ("ply\nelement vertex 99999999999999999999\n", "count"),
            ("ply\nelement vertex 1\nproperty float x\nelement vertex 1\n", "element \"vertex\" is declared twice"),
            ("ply\nproperty float x\n", "before the first element"),
            ("ply\nelement v 1\nproperty real x\n", "unknown property type \"real\""),
            ("ply\nelement v 1\nproperty list float int x\n", "integer"),
            ("ply\nelement v 1\nproperty float\n", "type and a name"),
            ("ply\nfoo\n", "unknown header statement"),
        ] {
            let fault = parse(text.as_bytes()).unwrap_err();
            assert!(fault.message.contains(message), "{text:?}: {}", fault.message);
        }
    }
}
