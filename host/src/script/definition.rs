//! Parameters of scripts: what the command line gives, and what a script asks for.

use super::plain::PlainValue;
use rhai::{Dynamic, ImmutableString};
use std::fmt::Write;
use std::str::FromStr;

/// Most parameters of a script.
const MOST_PARAMETERS: usize = 1000;
/// Longest name, meaning or default of a parameter, bytes.
const MOST_BYTES: usize = 4096;

/// A value for a parameter of a script, as text: `name=value`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterAssignment {
    /// The parameter.
    pub name: String,
    /// Its value; its kind is that of the default in the script.
    pub value: String,
}

impl FromStr for ParameterAssignment {
    type Err = String;

    fn from_str(text: &str) -> Result<ParameterAssignment, String> {
        let failed = || format!("'{text}' is not NAME=VALUE, such as teeth=12");
        let (name, value) = text.split_once('=').ok_or_else(failed)?;
        if is_name(name) { Ok(ParameterAssignment { name: name.into(), value: value.into() }) } else { Err(failed()) }
    }
}

/// Whether a text can be the name of a parameter: letters, digits and underscores, no digit first.
fn is_name(text: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.chars().all(is_part) && text.starts_with(|c: char| !c.is_ascii_digit())
}

/// A parameter that a script asked for.
struct DeclaredParameter {
    name: String,
    default: Dynamic,
    meaning: String,
}

/// A parameter that a function of a script asked for on another thread.
#[derive(Debug)]
pub(super) struct AskedParameter {
    pub(super) name: String,
    pub(super) default: PlainValue,
    pub(super) meaning: String,
}

/// What was given, and what was asked for so far.
#[derive(Default)]
pub(super) struct ScriptParameters {
    assigned: Vec<ParameterAssignment>,
    declared: Vec<DeclaredParameter>,
}

impl ScriptParameters {
    /// Nothing asked for yet. Of several definitions of a name the last holds.
    pub(super) fn new(given: &[ParameterAssignment]) -> ScriptParameters {
        ScriptParameters { assigned: given.to_vec(), declared: Vec::new() }
    }

    /// The value that was given for `name`, of the kind of `default`; without one, `default`.
    pub(super) fn value(&mut self, name: &str, default: Dynamic, meaning: &str) -> Result<Dynamic, String> {
        if !is_name(name) {
            return Err(format!("name must be letters, digits and underscores, not {name:?}"));
        }
        if !self.declared.iter().any(|asked| asked.name == name) {
            if self.declared.len() == MOST_PARAMETERS {
                return Err(format!("a script has at most {MOST_PARAMETERS} parameters"));
            }
            let text = default.read_lock::<ImmutableString>().map_or(0, |text| text.len());
            if let Some((what, _)) = [("name", name.len()), ("meaning", meaning.len()), ("default", text)]
                .into_iter()
                .find(|(_, bytes)| *bytes > MOST_BYTES)
            {
                return Err(format!("the {what} of a parameter has at most {MOST_BYTES} bytes"));
            }
            let (name, meaning) = (name.to_owned(), meaning.to_owned());
            self.declared.push(DeclaredParameter { name, default: default.clone(), meaning });
        }
        let Some(ParameterAssignment { value, .. }) = self.assigned.iter().rev().find(|d| d.name == name) else {
            return Ok(default);
        };
        let read = if default.is_bool() {
            value.parse::<bool>().ok().map(Dynamic::from)
        } else if default.is_int() {
            value.parse::<rhai::INT>().ok().map(Dynamic::from)
        } else if default.is_float() {
            value.parse::<rhai::FLOAT>().ok().filter(|x| x.is_finite()).map(Dynamic::from)
        } else {
            Some(Dynamic::from(value.clone()))
        };
        read.ok_or_else(|| format!("{name} must be {}, not {value}; {}", kind(&default), self.list()))
    }

    /// All that was asked for, as data.
    pub(super) fn asked(&self) -> Vec<AskedParameter> {
        let asked = self.declared.iter().filter_map(|DeclaredParameter { name, default, meaning }| {
            let default = PlainValue::of(default).ok()?;
            Some(AskedParameter { name: name.clone(), default, meaning: meaning.clone() })
        });
        asked.collect()
    }

    /// The first definition that the script did not ask for.
    pub(super) fn unknown(&self) -> Option<&ParameterAssignment> {
        self.assigned.iter().find(|given| !self.declared.iter().any(|asked| asked.name == given.name))
    }

    /// What the script asked for, in words.
    pub(super) fn list(&self) -> String {
        if self.declared.is_empty() {
            return "the script asks for no parameters".into();
        }
        let mut text = String::from("the script asks for");
        for DeclaredParameter { name, default, meaning } in &self.declared {
            let colon = if meaning.is_empty() { "" } else { ": " };
            // Writing to a string cannot fail.
            let _ = write!(text, "\n  {name}={default}  {}{colon}{meaning}", kind(default));
        }
        text
    }
}

fn kind(default: &Dynamic) -> &'static str {
    if default.is_bool() {
        "true or false"
    } else if default.is_int() {
        "a whole number"
    } else if default.is_float() {
        "a number"
    } else {
        "a text"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_a_name_and_all_behind_the_first_sign() {
        let read = |text: &str| text.parse::<ParameterAssignment>();
        assert_eq!(read("a_1=b=c"), Ok(ParameterAssignment { name: "a_1".into(), value: "b=c".into() }));
        for wrong in ["", "a", "=1", "1a=2", "a b=2", "ä=2"] {
            assert!(read(wrong).unwrap_err().contains("is not NAME=VALUE"), "{wrong}");
        }
    }
}
