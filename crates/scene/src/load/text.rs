//! A cursor over the words and lines of a text file: OBJ, MTL, STL and the text form of PLY.

use super::{LoadError, Place};
use std::borrow::Cow;
use std::path::Path;

/// What is wrong in a file, and in which line (0: nowhere in particular).
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// Line, from 1.
    pub(super) line: u32,
    /// What is wrong and what to do.
    pub(super) message: String,
}

impl Fault {
    /// A fault in `line`.
    pub(super) fn new(line: u32, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }

    /// The fault as the error of the file `path`.
    pub(super) fn in_file(self, path: &Path) -> LoadError {
        LoadError::invalid(Place::new(path, self.line), self.message)
    }
}

/// A position in a text, with its line number. Lines end with LF, CR LF or CR; a backslash before a line's end joins
/// it with the next; a word that begins with `#` starts a comment.
#[derive(Clone)]
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
}

impl<'a> Text<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1 }
    }

    /// A text that begins in `line` of its file.
    pub(super) fn at_line(bytes: &'a [u8], line: u32) -> Self {
        Self { bytes, at: 0, line }
    }

    /// Line of the position, from 1.
    pub(super) fn line(&self) -> u32 {
        self.line
    }

    /// Bytes behind the position.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Whether this line has another word.
    pub(super) fn has_word(&self) -> bool {
        self.clone().word().is_some()
    }

    /// Whether nothing is left.
    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Goes to the beginning of the next line.
    #[inline]
    pub(super) fn next_line(&mut self) {
        let mut comment = false;
        while self.at < self.bytes.len() {
            let b = self.bytes[self.at];
            // Comments often end with a folder's backslash: they are not joined with the next line.
            comment |= b == b'#';
            if b == b'\\' && !comment && self.joins_lines() {
                continue;
            }
            self.at += 1;
            if b == b'\n' || b == b'\r' {
                self.end_line(b);
                return;
            }
        }
    }

    /// The next word of this line, if any.
    #[inline]
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let start = self.at;
        while let Some(&b) = self.bytes.get(self.at) {
            if b <= b' ' && is_space(b) || b == b'\\' && self.line_break_after(self.at + 1) > 0 {
                break;
            }
            self.at += 1;
        }
        let word = &self.bytes[start..self.at];
        if word.is_empty() || word[0] == b'#' {
            self.at = start;
            return None;
        }
        Some(word)
    }

    /// The next word of this or any later line.
    pub(super) fn word_anywhere(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.word() {
                return Some(word);
            }
            if self.is_at_end() {
                return None;
            }
            self.next_line();
        }
    }

    /// All that is left of this line, without blanks around it; comments belong to it.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let left = &self.bytes[self.at..];
        let end = left.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(left.len());
        self.at += end;
        left[..end].trim_ascii()
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            if b == b' ' || b == b'\t' || b == 0x0b || b == 0x0c {
                self.at += 1;
            } else if b != b'\\' || !self.joins_lines() {
                return;
            }
        }
    }

    /// Passes over a backslash at the position that joins two lines.
    fn joins_lines(&mut self) -> bool {
        let length = self.line_break_after(self.at + 1);
        if length > 0 {
            self.at += 1 + length;
            self.line = self.line.saturating_add(1);
        }
        length > 0
    }

    fn line_break_after(&self, at: usize) -> usize {
        match self.bytes.get(at) {
            Some(b'\n') => 1,
            Some(b'\r') => 1 + usize::from(self.bytes.get(at + 1) == Some(&b'\n')),
            _ => 0,
        }
    }

    fn end_line(&mut self, ended_by: u8) {
        if ended_by == b'\r' && self.bytes.get(self.at) == Some(&b'\n') {
            self.at += 1;
        }
        self.line = self.line.saturating_add(1);
    }
}

fn is_space(b: u8) -> bool {
    matches!(b, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c)
}

/// Whether `word` is a keyword, in any case.
pub(super) fn is(word: &[u8], keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword.as_bytes())
}

/// The number that all of `word` spells, correctly rounded; `nan` and `inf` count as numbers.
#[inline]
pub(super) fn parse_f32(word: &[u8]) -> Option<f32> {
    match parse_short_decimal(word) {
        Some(x) => Some(x),
        None => std::str::from_utf8(word).ok()?.parse().ok(),
    }
}

/// The integer that all of `word` spells.
#[inline]
pub(super) fn parse_i64(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0i64;
    for &d in digits {
        if !d.is_ascii_digit() {
            return None;
        }
        value = value.checked_mul(10)?.checked_add(i64::from(d - b'0'))?;
    }
    Some(if negative { -value } else { value })
}

/// Decimals of at most 15 digits without an exponent, most of what mesh files hold. Digits and power of ten are exact
/// in f64 and their quotient is correctly rounded (Clinger, "How to read floating point numbers accurately", PLDI
/// 1990); rounding that to f32 is right too unless it lies just between two f32, which is left to the slow way.
#[inline]
fn parse_short_decimal(word: &[u8]) -> Option<f32> {
    const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, word),
    };
    if digits.len() > 16 {
        return None;
    }
    let (mut mantissa, mut count, mut point) = (0u64, 0usize, None);
    for (i, &d) in digits.iter().enumerate() {
        let digit = d.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa * 10 + u64::from(digit);
            count += 1;
        } else if d == b'.' && point.is_none() {
            point = Some(i);
        } else {
            return None;
        }
    }
    if count == 0 || count > 15 {
        return None;
    }
    let decimals = point.map_or(0, |p| digits.len() - 1 - p);
    let value = mantissa as f64 / POWERS[decimals];
    let halfway = value.to_bits() & 0x1fff_ffff == 0x1000_0000;
    // Subnormal f32 keep fewer bits, so that "just between" is elsewhere.
    if halfway || (mantissa != 0 && value < f64::from(f32::MIN_POSITIVE)) {
        return None;
    }
    Some(if negative { -(value as f32) } else { value as f32 })
}

/// A text file's bytes as UTF-8 without a byte order mark; UTF-16 is translated. Bytes that are not UTF-8 stay.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, [u8]> {
    let units = |rest: &[u8], join: fn([u8; 2]) -> u16| {
        let units = rest.chunks_exact(2).map(|c| join([c[0], c[1]]));
        let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        Cow::Owned(text.into_bytes())
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => Cow::Borrowed(rest),
        [0xfe, 0xff, rest @ ..] => units(rest, u16::from_be_bytes),
        [0xff, 0xfe, rest @ ..] => units(rest, u16::from_le_bytes),
        _ => Cow::Borrowed(bytes),
    }
}

/// A name as text. Bytes that are not UTF-8 are read as Latin-1, so that different names stay different.
pub(super) fn name(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// A word for a message: short, and printable.
pub(super) fn quoted(word: &[u8]) -> String {
    let text: String = name(word).chars().filter(|c| !c.is_control()).take(40).collect();
    format!("\"{text}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lines_and_continuations() {
        let mut t = Text::new(b" v 1\t2 \\\r\n 3\\\n4 # C:\\\n5\r\rlast\\");
        let words = |t: &mut Text<'_>| std::iter::from_fn(|| t.word()).map(name).collect::<Vec<_>>();
        assert_eq!(words(&mut t), ["v", "1", "2", "3", "4"]);
        assert_eq!(t.line(), 3);
        t.next_line();
        assert_eq!((t.line(), words(&mut t)), (4, vec!["5".to_string()]), "comments are not joined");
        t.next_line();
        assert_eq!((t.line(), words(&mut t).len()), (5, 0));
        t.next_line();
        assert_eq!(words(&mut t), ["last\\"]);
        assert!(t.is_at_end());
    }

    #[test]
    fn the_rest_of_a_line_keeps_blanks_inside() {
        let mut t = Text::new("usemtl  Материал #1 \r\nnext".as_bytes());
        assert_eq!(t.word(), Some(&b"usemtl"[..]));
        assert_eq!(name(t.rest_of_line()), "Материал #1");
        t.next_line();
        assert_eq!((t.word(), t.line()), (Some(&b"next"[..]), 2));
    }

    #[test]
    fn numbers_are_rounded_as_by_the_standard_library() {
        let sampler = numbers();
        for (i, x) in sampler.enumerate() {
            let float = f32::from_bits(x as u32);
            let words = [
                format!("{float}"),
                format!("{float:e}"),
                format!("{}", x as i32 as f64 / 1e6),
                format!("{:.*}", i % 9, (x >> 20) as f64 / 4096.0),
                format!("{}.5", x as u32 & 0x1ff_ffff),
            ];
            for w in words {
                let expected: f32 = w.parse().unwrap();
                let got = parse_f32(w.as_bytes()).unwrap_or_else(|| panic!("{w}"));
                assert!(got.to_bits() == expected.to_bits() || got.is_nan() && expected.is_nan(), "{w}: {got}");
            }
        }
        for bad in ["", "-", ".", "1.2.3", "3.1+e2", "1,5", "1.#IND", "0x10", "- 1", "e5"] {
            assert_eq!(parse_f32(bad.as_bytes()), None, "{bad}");
        }
        for (good, value) in [("2.", 2.0), ("+.5", 0.5), ("2.e1", 20.0), ("1E2", 100.0), ("-0", 0.0)] {
            assert_eq!(parse_f32(good.as_bytes()), Some(value), "{good}");
        }
    }

    /// 20,000 reproducible 64-bit numbers (a Weyl sequence through one multiplication; no quality needed).
    fn numbers() -> impl Iterator<Item = u64> {
        (1u64..=20_000).map(|i| {
            let x = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (x ^ (x >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9)
        })
    }

    #[test]
    fn integers() {
        for (word, value) in [("1", Some(1)), ("-12", Some(-12)), ("+7", Some(7)), ("", None), ("1/2", None)] {
            assert_eq!(parse_i64(word.as_bytes()), value);
        }
        assert_eq!(parse_i64(b"9999999999999999999"), None);
    }

    #[test]
    fn byte_order_marks() {
        assert_eq!(&*decode(b"\xef\xbb\xbfv 1"), b"v 1");
        assert_eq!(&*decode(b"\xfe\xff\0v\0\n"), b"v\n");
        assert_eq!(&*decode(b"\xff\xfev\0\n\0"), b"v\n");
        assert_eq!(name(b"caf\xe9"), "café");
    }
}
