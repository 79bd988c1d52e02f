//! The numbers of a PLY file's data, text or binary.

use super::super::text::{Fault, Text, parse_f32, parse_i64, quoted};
use super::header::{Element, Encoding, Header, Type};

/// A position in the data.
pub(super) enum Source<'a> {
    Text(Text<'a>),
    Binary { bytes: &'a [u8], at: usize, big: bool },
}

impl<'a> Source<'a> {
    /// The data behind `header` in `bytes`.
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Self {
        let big = match header.encoding {
            Encoding::Text => return Self::Text(Text::at_line(&bytes[header.data_at..], header.data_line)),
            Encoding::LittleEndian => false,
            Encoding::BigEndian => true,
        };
        Self::Binary { bytes, at: header.data_at, big }
    }

    /// Line of the position, 0 in binary data.
    pub(super) fn line(&self) -> u32 {
        match self {
            Self::Text(text) => text.line(),
            Self::Binary { .. } => 0,
        }
    }

    /// Bytes behind the position.
    fn left(&self) -> u64 {
        match self {
            Self::Text(text) => text.left() as u64,
            Self::Binary { bytes, at, .. } => (bytes.len() - at) as u64,
        }
    }

    /// Refuses an element whose declared count cannot fit into what is left of the file.
    pub(super) fn check_count(&self, element: &Element) -> Result<(), Fault> {
        let (least, available) = match self {
            // A digit and a blank at least for every number, but for the last of all; lists may be missing.
            Self::Text(_) => (
                2 * element.properties.iter().filter(|p| p.list.is_none()).count() as u64,
                self.left().saturating_add(1),
            ),
            Self::Binary { .. } => (element.least_size(), self.left()),
        };
        let needed = least.saturating_mul(element.count);
        if needed > available {
            return Err(Fault::new(
                self.line(),
                format!(
                    "the header declares {} of element \"{}\", but only {} bytes are left: the file is cut off or damaged",
                    element.count,
                    element.name,
                    self.left()
                ),
            ));
        }
        Ok(())
    }

    /// Passes over all of `element`.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), Fault> {
        if element.properties.is_empty() {
            return Ok(());
        }
        if let Self::Binary { at, .. } = self
            && element.is_fixed()
        {
            // In range: the count was checked.
            *at += (element.least_size() * element.count) as usize;
            return Ok(());
        }
        for _ in 0..element.count {
            for p in &element.properties {
                match p.list {
                    None => {
                        self.number(p.value)?;
                    }
                    Some(length) => {
                        for _ in 0..self.length(length, p.value, element)? {
                            self.number(p.value)?;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The next number of type `kind`. In f64 every type fits exactly.
    #[inline]
    pub(super) fn number(&mut self, kind: Type) -> Result<f64, Fault> {
        match self {
            Self::Text(text) => {
                let Some(word) = text.word_anywhere() else { return Err(cut_off(text.line())) };
                text_number(word, kind).ok_or_else(|| {
                    Fault::new(text.line(), format!("{} is not a number of the declared type", quoted(word)))
                })
            }
            Self::Binary { bytes, at, big } => {
                let size = kind.size();
                let Some(raw) = bytes.get(*at..*at + size) else { return Err(cut_off(0)) };
                *at += size;
                Ok(binary_number(raw, kind, *big))
            }
        }
    }

    /// The length of a list whose values are of type `value`. In text a list that its line lacks is empty.
    pub(super) fn length(&mut self, kind: Type, value: Type, element: &Element) -> Result<u64, Fault> {
        if let Self::Text(text) = self
            && element.properties[0].list.is_none()
            && !text.has_word()
        {
            return Ok(0);
        }
        let n = self.number(kind)?;
        let wrong = |what: String| Fault::new(self.line(), what);
        if !(n >= 0.0) {
            return Err(wrong(format!("a list of element \"{}\" has {n} values", element.name)));
        }
        let n = n as u64;
        let least = match self {
            Self::Text(_) => n.saturating_mul(2),
            Self::Binary { .. } => n.saturating_mul(value.size() as u64),
        };
        if least > self.left() + 1 {
            return Err(wrong(format!(
                "a list of element \"{}\" declares {n} values, but only {} bytes are left: the file is cut off or damaged",
                element.name,
                self.left()
            )));
        }
        Ok(n)
    }
}

fn cut_off(line: u32) -> Fault {
    Fault::new(line, "the file ends before all declared elements: it is cut off or damaged")
}

fn text_number(word: &[u8], kind: Type) -> Option<f64> {
    match kind {
        Type::F32 => parse_f32(word).map(f64::from),
        Type::F64 => std::str::from_utf8(word).ok()?.parse().ok(),
        // Some writers put a decimal point into integers.
        _ => parse_i64(word).map(|n| n as f64).or_else(|| parse_f32(word).map(f64::from).filter(|x| x.fract() == 0.0)),
    }
}

#[inline]
fn binary_number(raw: &[u8], kind: Type, big: bool) -> f64 {
    let mut bytes = [0; 8];
    let size = raw.len();
    bytes[..size].copy_from_slice(raw);
    if big {
        bytes[..size].reverse();
    }
    let word = u64::from_le_bytes(bytes);
    match kind {
        Type::I8 => f64::from(word as i8),
        Type::U8 => f64::from(word as u8),
        Type::I16 => f64::from(word as i16),
        Type::U16 => f64::from(word as u16),
        Type::I32 => f64::from(word as i32),
        Type::U32 => f64::from(word as u32),
        Type::F32 => f64::from(f32::from_bits(word as u32)),
        Type::F64 => f64::from_bits(word),
    }
}
