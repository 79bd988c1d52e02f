//! Rows of a benchmark: medians with spread, and how our engine stands against the best of the others.

use super::machine::Machine;
use serde::Serialize;

/// The name of our engine in every benchmark.
pub const OURS: &str = "photinus";

/// A whole report; printed as JSON it is what scripts read.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The benchmark's name.
    pub bench: &'static str,
    /// Version of Photinus, with the commit where there is one.
    pub version: String,
    /// The machine.
    pub machine: Machine,
    /// What else a reader must know: references, agreement, versions of the peers.
    pub notes: Vec<String>,
    /// The measurements.
    pub rows: Vec<Row>,
}

/// What one engine did in one setting, in one unit.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The setting.
    pub set: String,
    /// How large the task was.
    pub size: String,
    /// Who did it.
    pub engine: String,
    /// On how many threads.
    pub threads: u32,
    /// What is measured.
    pub unit: &'static str,
    /// Median over repeats; none where nothing was measured.
    pub median: Option<f64>,
    /// Least value.
    pub low: Option<f64>,
    /// Greatest value.
    pub high: Option<f64>,
    /// In our engine's rows the best other engine's median against ours, above 1 where ours is better.
    pub ratio_to_best_peer: Option<f64>,
    /// Processor seconds spent, median.
    pub cpu_seconds: Option<f64>,
    /// What was done in that time; in a row without a measurement, why there is none.
    pub note: String,
}

impl Row {
    /// A row without a measurement.
    pub fn empty(set: &str, size: String, engine: &str, threads: u32, unit: &'static str) -> Self {
        Self {
            set: set.to_owned(),
            size,
            engine: engine.to_owned(),
            threads,
            unit,
            median: None,
            low: None,
            high: None,
            ratio_to_best_peer: None,
            cpu_seconds: None,
            note: String::new(),
        }
    }

    /// Fills median, low and high.
    pub fn set_values(&mut self, values: &[f64]) {
        self.median = median(values);
        self.low = values.iter().copied().reduce(f64::min);
        self.high = values.iter().copied().reduce(f64::max);
    }
}

/// Whether a row belongs to ours: the engine itself, or one of its variants, which are no peers.
fn is_ours(engine: &str) -> bool {
    engine.strip_prefix(OURS).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
}

/// Whether a unit is a time, not a rate.
pub fn less_is_better(unit: &str) -> bool {
    unit.starts_with("ns_per_") || (unit.ends_with("_s") && !unit.contains("_per_"))
}

/// The middle value, or the mean of the middle two.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[half]),
        _ => Some(0.5 * (sorted[half - 1] + sorted[half])),
    }
}

/// Fills the ratios of our engine's rows, in units where less is better: best peer over ours, of the same set, size,
/// threads and unit.
pub fn fill_ratios_of_errors(rows: &mut [Row]) {
    fill_ratios(rows, f64::min, |best, ours| best / ours);
}

/// The same in units where more is better: ours over the best peer.
pub fn fill_ratios_of_rates(rows: &mut [Row]) {
    fill_ratios(rows, f64::max, |best, ours| ours / best);
}

fn fill_ratios(rows: &mut [Row], better: fn(f64, f64) -> f64, ratio: fn(f64, f64) -> f64) {
    for i in 0..rows.len() {
        let ours = &rows[i];
        if ours.engine != OURS {
            continue;
        }
        let kind = |row: &Row| (row.set.clone(), row.size.clone(), row.threads, row.unit);
        let alike = |row: &&Row| !is_ours(&row.engine) && kind(row) == kind(ours);
        let best = rows.iter().filter(alike).filter_map(|row| row.median).reduce(better);
        let ratio = best.zip(ours.median).map(|(best, ours)| ratio(best, ours));
        rows[i].ratio_to_best_peer = ratio.filter(|ratio| ratio.is_finite());
    }
}

impl Report {
    /// The document of `--json`.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain data")
    }

    /// Tables in Markdown, one for each set; a line for each engine, a column for each unit.
    pub fn tables(&self) -> String {
        let mut out = format!("{}\n{}\n", self.version, self.machine.line());
        for note in &self.notes {
            out += &format!("{note}\n");
        }
        let mut sets: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !sets.contains(&row.set.as_str()) {
                sets.push(&row.set);
            }
        }
        for set in sets {
            out += &self.table(set);
        }
        out
    }

    /// Tables in Markdown, one for each size and number of threads; a line for each set, a column for each engine with its
    /// median and, in brackets, how ours compares with it, above 1 where ours is better.
    pub fn wide_tables(&self) -> String {
        let mut out = format!("{}\n{}\n", self.version, self.machine.line());
        for note in &self.notes {
            out += &format!("{note}\n");
        }
        for (size, threads) in unique(self.rows.iter().map(|row| (row.size.as_str(), row.threads))) {
            let rows: Vec<&Row> = self.rows.iter().filter(|row| row.size == size && row.threads == threads).collect();
            let engines = unique(rows.iter().map(|row| row.engine.as_str()));
            out += &format!("\n{size}, threads: {threads}\n\n| set | unit | {} |\n", engines.join(" | "));
            out += &format!("|---|---|{}\n", "---|".repeat(engines.len()));
            for (set, unit) in unique(rows.iter().map(|row| (row.set.as_str(), row.unit))) {
                let of_set: Vec<&&Row> = rows.iter().filter(|row| row.set == set && row.unit == unit).collect();
                let find = |engine: &str| of_set.iter().find(|row| row.engine == engine).and_then(|row| row.median);
                let shown = |engine: &&str| {
                    let Some(value) = find(engine) else { return "-".to_owned() };
                    let ratio = find(OURS).map(|ours| if less_is_better(unit) { value / ours } else { ours / value });
                    let ratio = ratio.filter(|_| *engine != OURS);
                    short(value) + &ratio.map_or(String::new(), |ratio| format!(" ({ratio:.2})"))
                };
                let cells: Vec<String> = engines.iter().map(shown).collect();
                out += &format!("| {set} | {unit} | {} |\n", cells.join(" | "));
            }
            for row in rows.iter().filter(|row| row.median.is_none()) {
                out += &format!("{} {}: {}\n", row.set, row.engine, row.note);
            }
        }
        out
    }

    fn table(&self, set: &str) -> String {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.set == set).collect();
        let (mut units, mut engines): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
        for row in &rows {
            if !units.contains(&row.unit) {
                units.push(row.unit);
            }
            if !engines.contains(&row.engine.as_str()) {
                engines.push(&row.engine);
            }
        }
        let (size, threads) = rows.first().map_or(("", 0), |row| (row.size.as_str(), row.threads));
        let mut out = format!("\n{set}, {size}, threads: {threads}\n\n");
        out += &format!("| engine | {} | CPU s | what |\n", units.join(" | "));
        out += &format!("|---|{}---|---|\n", "---|".repeat(units.len()));
        for engine in engines {
            let of_engine: Vec<&&Row> = rows.iter().filter(|row| row.engine == engine).collect();
            let mut cells = vec![engine.to_owned()];
            for unit in &units {
                let row = of_engine.iter().find(|row| row.unit == *unit);
                cells.push(row.map_or("-".into(), |row| cell(row)));
            }
            let first = of_engine[0];
            cells.push(first.cpu_seconds.map_or("-".into(), |s| format!("{s:.1}")));
            cells.push(first.note.clone());
            out += &format!("| {} |\n", cells.join(" | "));
        }
        out
    }
}

/// Median, spread and ratio in a few characters.
fn cell(row: &Row) -> String {
    let (Some(median), Some(low), Some(high)) = (row.median, row.low, row.high) else { return "-".into() };
    let spread = if low == high { String::new() } else { format!(" ({} to {})", short(low), short(high)) };
    let ratio = row.ratio_to_best_peer.map_or(String::new(), |ratio| format!(", ratio {ratio:.2}"));
    format!("{}{spread}{ratio}", short(median))
}

/// Each value once, in the order of their first.
fn unique<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut out = Vec::new();
    values.for_each(|value| {
        if !out.contains(&value) {
            out.push(value);
        }
    });
    out
}

/// Three significant digits.
fn short(value: f64) -> String {
    let (mut digits, mut scaled) = (2, value);
    while scaled > 0.0 && scaled < 1.0 && digits < 8 {
        (digits, scaled) = (digits + 1, 10.0 * scaled);
    }
    while scaled >= 10.0 && digits > 0 {
        (digits, scaled) = (digits - 1, 0.1 * scaled);
    }
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(set: &str, engine: &str, unit: &'static str, values: &[f64]) -> Row {
        let cpu_seconds = Some(9.96);
        let mut row = Row { cpu_seconds, note: "4 samples".into(), ..Row::empty(set, "8x8".into(), engine, 1, unit) };
        row.set_values(values);
        row
    }

    #[test]
    fn medians_have_their_spread() {
        let row = row("a", "x", "u", &[3.0, 1.0, 2.0]);
        assert_eq!((row.median, row.low, row.high), (Some(2.0), Some(1.0), Some(3.0)));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn ratios_are_against_the_best_other_of_the_same_kind_and_above_one_where_ours_is_better() {
        let mut rows = vec![
            row("a", OURS, "u", &[0.01]),
            row("a", "good", "u", &[0.02]),
            row("a", "bad", "u", &[0.5]),
            row("a", "missing", "u", &[]),
            row("a", OURS, "v", &[0.4]),
            row("a", "good", "v", &[0.1]),
            row("b", OURS, "u", &[0.3]),
            row("c", OURS, "u", &[]),
            row("c", "good", "u", &[0.1]),
            row("d", OURS, "u", &[0.0]),
            row("d", "good", "u", &[0.1]),
        ];
        fill_ratios_of_errors(&mut rows);
        let ratios: Vec<Option<f64>> = rows.iter().map(|row| row.ratio_to_best_peer).collect();
        assert_eq!(ratios[0], Some(2.0));
        assert_eq!(ratios[4], Some(0.25));
        // No peer, no measurement of ours, a division by nothing: no ratio.
        assert_eq!([ratios[6], ratios[7], ratios[9]], [None; 3]);
        assert!(rows.iter().zip(&ratios).all(|(row, ratio)| row.engine == OURS || ratio.is_none()));
    }

    #[test]
    fn the_document_has_the_fields_that_scripts_read() {
        let mut rows = vec![row("a", OURS, "u", &[0.5, 0.25, 1.0]), row("a", "other", "u", &[])];
        fill_ratios_of_errors(&mut rows);
        let report =
            Report { bench: "pictures", version: "0".into(), machine: Machine::here(), notes: Vec::new(), rows };
        let document: serde_json::Value = serde_json::from_str(&report.json()).unwrap();
        let keys = |value: &serde_json::Value| -> Vec<String> { value.as_object().unwrap().keys().cloned().collect() };
        for key in ["bench", "version", "machine", "notes", "rows"] {
            assert!(keys(&document).contains(&key.to_owned()), "{key}");
        }
        for row in document["rows"].as_array().unwrap() {
            for key in
                ["set", "size", "engine", "threads", "unit", "median", "low", "high", "ratio_to_best_peer", "note"]
            {
                assert!(keys(row).contains(&key.to_owned()), "{key}");
            }
        }
        assert_eq!(document["rows"][0]["median"], 0.5);
        assert_eq!(document["rows"][0]["high"], 1.0);
        assert!(document["rows"][1]["median"].is_null() && document["rows"][0]["ratio_to_best_peer"].is_null());
    }

    #[test]
    fn rates_are_compared_the_other_way_and_threads_apart() {
        let mut rows = vec![row("a", OURS, "mrays_per_s", &[6.0]), row("a", "good", "mrays_per_s", &[4.0])];
        rows.push(row("a", "bad", "mrays_per_s", &[1.0]));
        // A variant of ours is no peer.
        rows.push(row("a", "photinus-quick", "mrays_per_s", &[8.0]));
        rows.push(Row { threads: 2, ..row("a", OURS, "mrays_per_s", &[9.0]) });
        fill_ratios_of_rates(&mut rows);
        assert_eq!((rows[0].ratio_to_best_peer, rows[4].ratio_to_best_peer), (Some(1.5), None));
        let report = Report { bench: "rays", version: "0".into(), machine: Machine::here(), notes: Vec::new(), rows };
        let text = report.wide_tables();
        assert!(text.contains("| set | unit | photinus | good | bad | photinus-quick |"), "{text}");
        assert!(text.contains("| a | mrays_per_s | 6.00 | 4.00 (1.50) | 1.00 (6.00) | 8.00 (0.75) |"), "{text}");
        assert!(text.contains("8x8, threads: 2"), "{text}");
    }

    #[test]
    fn tables_name_every_engine() {
        let mut rows = vec![row("a", OURS, "u", &[0.00123456]), row("a", "other", "u", &[0.0025, 0.0027])];
        rows.push(Row { note: "is not installed".into(), cpu_seconds: None, ..row("a", "gone", "u", &[]) });
        fill_ratios_of_errors(&mut rows);
        let report =
            Report { bench: "pictures", version: "0".into(), machine: Machine::here(), notes: Vec::new(), rows };
        let text = report.tables();
        assert!(text.contains("| photinus | 0.00123, ratio 2.11 | 10.0 | 4 samples |"), "{text}");
        assert!(text.contains("| other | 0.00260 (0.00250 to 0.00270) |"), "{text}");
        assert!(text.contains("| gone | - | - | is not installed |"), "{text}");
    }
}
