//! Splits Rust source into code and comments, line by line, so that rules about code do not trip over words.

/// One line of source.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Line {
    /// Code, the insides of strings and characters left out.
    pub code: String,
    /// Text of comments.
    pub comment: String,
}

enum State {
    Code,
    LineComment,
    /// Nested block comments.
    BlockComment(u32),
    /// A string, closed by a quote and this many hashes; raw strings have no escapes.
    Text {
        hashes: usize,
        raw: bool,
    },
}

/// Splits `source` into its lines.
pub fn split(source: &str) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut state = State::Code;
    for text in source.lines() {
        let mut line = Line::default();
        let chars: Vec<char> = text.chars().collect();
        let mut i = 0;
        while i < chars.len() {
            let next = chars.get(i + 1).copied();
            match state {
                State::Code => match (chars[i], next) {
                    ('/', Some('/')) => {
                        state = State::LineComment;
                        i += 2;
                    }
                    ('/', Some('*')) => {
                        state = State::BlockComment(1);
                        i += 2;
                    }
                    ('"', _) => {
                        let (hashes, raw) = opening(&chars[..i]);
                        state = State::Text { hashes, raw };
                        line.code.push('"');
                        i += 1;
                    }
                    ('\'', _) => {
                        let length = character(&chars[i..]);
                        line.code.push('\'');
                        i += length;
                    }
                    (c, _) => {
                        line.code.push(c);
                        i += 1;
                    }
                },
                State::LineComment => {
                    line.comment.push(chars[i]);
                    i += 1;
                }
                State::BlockComment(depth) => match (chars[i], next) {
                    ('*', Some('/')) => {
                        state = if depth == 1 { State::Code } else { State::BlockComment(depth - 1) };
                        i += 2;
                    }
                    ('/', Some('*')) => {
                        state = State::BlockComment(depth + 1);
                        i += 2;
                    }
                    (c, _) => {
                        line.comment.push(c);
                        i += 1;
                    }
                },
                State::Text { hashes, raw } => {
                    if !raw && chars[i] == '\\' {
                        i += 2;
                    } else if chars[i] == '"' && chars[i + 1..].iter().take_while(|&&c| c == '#').count() >= hashes {
                        state = State::Code;
                        line.code.push('"');
                        i += 1 + hashes;
                    } else {
                        i += 1;
                    }
                }
            }
        }
        if matches!(state, State::LineComment) {
            state = State::Code;
        }
        lines.push(line);
    }
    lines
}

/// What stands before a quote: how many hashes, and whether an `r` makes the string raw.
fn opening(before: &[char]) -> (usize, bool) {
    let hashes = before.iter().rev().take_while(|&&c| c == '#').count();
    let raw = before.iter().rev().nth(hashes) == Some(&'r');
    if raw { (hashes, true) } else { (0, false) }
}

/// Length of a character literal that begins at a quote, 1 for the quote of a lifetime.
fn character(rest: &[char]) -> usize {
    match rest {
        ['\'', '\\', _, tail @ ..] => 3 + tail.iter().position(|&c| c == '\'').map_or(0, |p| p + 1),
        ['\'', _, '\'', ..] => 3,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn code_comments_and_strings_are_told_apart() {
        let source = r##"let a = "unsafe // no"; // why "unsafe"
/* one /* two */ still */ let b = r#"a "quote" unsafe"#;
fn f<'a>(c: char) -> bool { c == '"' || c == '\'' || c == '\u{1F}' } // end
let s = "begins
unsafe ends"; g();"##;
        let lines = split(source);
        let code: Vec<&str> = lines.iter().map(|l| l.code.as_str()).collect();
        assert_eq!(code[0], r#"let a = ""; "#);
        assert_eq!(lines[0].comment, r#" why "unsafe""#);
        assert_eq!(code[1], r##" let b = r#"";"##);
        assert_eq!(lines[1].comment, " one  two  still ");
        assert_eq!(code[2], "fn f<'a>(c: char) -> bool { c == ' || c == ' || c == ' } ");
        assert_eq!(code[3], "let s = \"");
        assert_eq!(code[4], "\"; g();");
    }
}
