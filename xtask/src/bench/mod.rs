//! Measurements against what a user would pick instead: one program, so that anyone can repeat them.

mod commands;
mod machine;
mod photons;
mod pictures;
mod program;
mod rays;
mod report;
mod timed;

use crate::Failure;
use std::path::Path;

/// How a benchmark is run.
pub struct Options {
    /// One repeat of the shortest settings.
    pub quick: bool,
    /// One JSON document on standard output in the place of tables.
    pub json: bool,
    /// Repeats of every measurement; the benchmark's own number where it is not given.
    pub repeats: Option<usize>,
    /// Engines that run beside ours; empty for all.
    pub only: Vec<String>,
}

/// A benchmark: its name and its program.
type Bench = (&'static str, fn(&Path, &Options) -> Result<(), Failure>);

/// All of them.
const BENCHES: &[Bench] = &[("pictures", pictures::run), ("rays", rays::run), ("photons", photons::run)];

/// Runs `bench NAME [--quick] [--json] [--repeats N] [--only ENGINE,...]`; none where the words are not of this form.
pub fn run(root: &Path, words: &[&str]) -> Option<Result<(), Failure>> {
    let (name, words) = words.split_first()?;
    let (_, program) = BENCHES.iter().find(|(known, _)| known == name)?;
    let options = parse(words)?;
    Some(program(root, &options))
}

fn parse(words: &[&str]) -> Option<Options> {
    let mut options = Options { quick: false, json: false, repeats: None, only: Vec::new() };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match *word {
            "--quick" => options.quick = true,
            "--json" => options.json = true,
            "--repeats" => options.repeats = Some(words.next()?.parse().ok().filter(|&n| n > 0)?),
            "--only" => options.only = words.next()?.split(',').map(str::to_owned).collect(),
            _ => return None,
        }
    }
    Some(options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_and_others_refused() {
        let options = parse(&["--quick", "--repeats", "3", "--only", "a,b", "--json"]).unwrap();
        assert!(options.quick && options.json);
        assert_eq!((options.repeats, options.only), (Some(3), vec!["a".to_owned(), "b".to_owned()]));
        for wrong in [&["--fast"][..], &["--repeats"], &["--repeats", "0"], &["--repeats", "x"], &["--only"]] {
            assert!(parse(wrong).is_none(), "{wrong:?}");
        }
        assert!(run(Path::new("."), &["paintings"]).is_none());
    }
}
