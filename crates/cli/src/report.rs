//! What is said on standard output and standard error.

use serde::Serialize;
use std::io::{self, Write};

/// One line on standard error that says what is wrong.
pub fn error(message: &str) {
    note(&format!("photinus: {message}"));
}

/// One line on standard error. What came from a file stays on that line and cannot play tricks with the terminal.
pub fn note(message: &str) {
    let line: String = message.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    writeln!(io::stderr(), "{}", line.trim_end()).ok();
}

/// One line on standard error that says what was read otherwise than written.
pub fn warning(message: &str) {
    error(&format!("warning: {message}"));
}

/// One JSON document on standard output.
pub fn json(document: &impl Serialize) -> io::Result<()> {
    let mut out = io::stdout().lock();
    serde_json::to_writer_pretty(&mut out, document)?;
    writeln!(out)?;
    out.flush()
}

/// One line on standard output.
pub fn line(text: &str) -> io::Result<()> {
    writeln!(io::stdout(), "{text}")
}

/// Names with their values, the values aligned, on standard output.
pub fn table<N: AsRef<str>>(rows: &[(N, String)]) -> io::Result<()> {
    let width = rows.iter().map(|(name, _)| name.as_ref().chars().count()).max().unwrap_or(0);
    let mut out = io::stdout().lock();
    for (name, value) in rows {
        writeln!(out, "{:width$}  {value}", name.as_ref())?;
    }
    out.flush()
}

/// Bytes for people: 1.2 MB, with the units of the SI.
pub fn bytes(count: u64) -> String {
    const UNITS: [&str; 5] = ["kB", "MB", "GB", "TB", "PB"];
    if count < 1000 {
        return format!("{count} B");
    }
    let mut value = count as f64 / 1e3;
    let mut unit = 0;
    while value >= 999.5 && unit + 1 < UNITS.len() {
        value /= 1e3;
        unit += 1;
    }
    if value < 9.95 { format!("{value:.1} {}", UNITS[unit]) } else { format!("{value:.0} {}", UNITS[unit]) }
}

/// A count with spaces between groups of three digits.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// A number for people in three digits and a letter: 1.2 M.
pub fn short(number: f64) -> String {
    const UNITS: [&str; 5] = ["", " k", " M", " G", " T"];
    let mut value = number;
    let mut unit = 0;
    while value >= 999.5 && unit + 1 < UNITS.len() {
        value /= 1e3;
        unit += 1;
    }
    if value < 9.95 && unit > 0 { format!("{value:.1}{}", UNITS[unit]) } else { format!("{value:.0}{}", UNITS[unit]) }
}

/// A short time for people: 15 ns, 3.2 us, 41 ms.
pub fn nanoseconds(number: f64) -> String {
    let (value, unit) = match number {
        n if n < 999.5 => (n, "ns"),
        n if n < 999_500.0 => (n / 1e3, "us"),
        n if n < 999_500_000.0 => (n / 1e6, "ms"),
        n => (n / 1e9, "s"),
    };
    if value < 9.95 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}

/// Seconds for people: 0:07, 12:34, 3:00:00.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.max(0.0).ceil() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 { format!("{hours}:{minutes:02}:{seconds:02}") } else { format!("{minutes}:{seconds:02}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_readable() {
        assert_eq!([bytes(0), bytes(999), bytes(1000), bytes(9_949)], ["0 B", "999 B", "1.0 kB", "9.9 kB"]);
        assert_eq!([bytes(999_999), bytes(24_000_000), bytes(u64::MAX)], ["1.0 MB", "24 MB", "18447 PB"]);
        assert_eq!([short(0.0), short(7.0), short(1234.0), short(2.5e6)], ["0", "7", "1.2 k", "2.5 M"]);
        assert_eq!([duration(0.2), duration(61.0), duration(7200.5)], ["0:01", "1:01", "2:00:01"]);
        assert_eq!([nanoseconds(7.04), nanoseconds(38_000.0)], ["7.0 ns", "38 us"]);
        assert_eq!([nanoseconds(1.5e6), nanoseconds(2e10)], ["1.5 ms", "20 s"]);
        assert_eq!([count(0), count(999), count(1000), count(1_234_567)], ["0", "999", "1 000", "1 234 567"]);
    }
}
