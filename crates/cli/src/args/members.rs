//! A value parser for the members of a family: hyphens or underscores, each name with its summary in the help.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Command, Error};
use photinus::names::Family;
use std::ffi::OsStr;

/// Takes a member's name.
#[derive(Clone)]
pub struct MemberParser(PossibleValuesParser);

/// The parser for names of `family`.
pub fn parser(family: Family) -> MemberParser {
    let values = family.members().into_iter().map(|member| PossibleValue::new(member.name).help(member.summary));
    MemberParser(PossibleValuesParser::new(values))
}

impl TypedValueParser for MemberParser {
    type Value = String;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<String, Error> {
        let hyphened = value.to_str().map(|name| name.replace('_', "-"));
        self.0.parse_ref(command, arg, hyphened.as_deref().map_or(value, OsStr::new))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        self.0.possible_values()
    }
}
