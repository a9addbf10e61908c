//! Names that nothing defines, functions that do not exist, and names that are defined twice.

use super::{
    Level, Note,
    program::{Program, Use},
};
use crate::{functions, machine::Machine};
use protocol::{Name, command::spelling::nearest};
use std::collections::HashSet;

/// Looks at the names of a program.
///
/// - `machine`: which has carried the program out; it knows the names of the system.
pub(super) fn check(
    program: &Program,
    machine: &Machine,
    line_of: impl Fn(super::source_file::Location) -> String,
) -> Vec<Note> {
    let mut notes = Vec::new();
    for (function, place) in &program.no_functions {
        let meant = nearest(function.as_str(), functions::all().map(|row| row.name));
        let hint = meant.map_or("'ps340 functions' lists them".into(), |meant| format!("did you mean F:{meant}?"));
        notes.push(Note {
            location: *place,
            level: Level::Error,
            text: format!("there is no function F:{function}; {hint}"),
        });
    }
    for (name, place, before) in &program.again {
        let text = format!("{name} is defined again, it was defined {}", line_of(*before));
        notes.push(Note { location: *place, level: Level::Warning, text });
    }
    let objects = &machine.memory().objects;
    let is_system = |name: &Name| objects.find(name.as_str()).is_some_and(|id| objects.is_system(id));
    let mut told = HashSet::new();
    for used in &program.uses {
        if is_defined(program, used) || is_system(&used.name) || !told.insert(&used.name) {
            continue;
        }
        let hint =
            meant(program, machine, &used.name).map_or(String::new(), |meant| format!("; did you mean {meant}?"));
        let text = format!("{} is used by {} and never defined{hint}", used.name, used.by);
        notes.push(Note { location: used.location, level: Level::Error, text });
    }
    notes
}

/// Whether the files define a name that is used, in a structure around the location or outside.
fn is_defined(program: &Program, used: &Use) -> bool {
    let known = |name: &Name| program.definitions.contains_key(name);
    let mut scope = used.scope.as_ref().map(Name::as_str);
    while let Some(path) = scope {
        if Name::new(path).and_then(|outer| outer.join(&used.name)).is_ok_and(|name| known(&name)) {
            return true;
        }
        scope = path.rsplit_once('.').map(|(outer, _)| outer);
    }
    known(&used.name)
}

/// The known name that is nearest to one that is not known, or the same name inside a structure.
fn meant(program: &Program, machine: &Machine, name: &Name) -> Option<String> {
    let inner = format!(".{name}");
    if let Some(inside) = program.definitions.keys().find(|known| known.as_str().ends_with(&inner)) {
        return Some(inside.to_string());
    }
    let objects = &machine.memory().objects;
    let system = machine.memory().network.objects().filter(|id| objects.is_system(*id));
    let known = program.definitions.keys().map(Name::as_str).chain(system.map(|id| objects.name(id)));
    nearest(name.as_str(), known).map(str::to_owned)
}
