//! The values of a call, by parameter.

use super::handle::Handle;
use super::kinds::number;
use super::parameter::{Parameter, Takes};
use crate::database::Library;
use rhai::{Dynamic, Map};

/// The values of a call, one for each parameter in turn; none where none was given.
pub(super) struct BoundArguments {
    values: std::vec::IntoIter<Option<Dynamic>>,
}

impl BoundArguments {
    /// Assigns the values of a call to the parameters of a function.
    ///
    /// - `usage`: how the function is called, for messages.
    pub(super) fn new(
        parameters: &[Parameter],
        usage: impl Fn() -> String,
        values: &[Dynamic],
    ) -> Result<BoundArguments, String> {
        let mut slots: Vec<Option<Dynamic>> = vec![None; parameters.len()];
        let mut rest = values;
        let mut following = 0..parameters.len();
        while let Some(first) = rest.first() {
            if rest.len() == 1 && first.is_map() && !first.is::<Handle>() {
                take_map(parameters, first, &mut slots)?;
                break;
            }
            let Some(index) = following.next() else {
                return Err(format!("too many values; use {}", usage()));
            };
            let may_be_three = parameters[index].takes.takes_three() && rest.len() >= 3;
            let is_three = may_be_three && rest[..3].iter().all(|value| number(value).is_some());
            let (value, used) =
                if is_three { (Dynamic::from_array(rest[..3].to_vec()), 3) } else { (first.clone(), 1) };
            slots[index] = Some(value);
            rest = &rest[used..];
        }
        let is_missing = |(p, slot): &(&Parameter, &Option<Dynamic>)| slot.is_none() && p.takes.otherwise().is_none();
        match parameters.iter().zip(&slots).find(is_missing) {
            Some((parameter, _)) => Err(format!("{} is missing; use {}", parameter.name, usage())),
            None => Ok(BoundArguments { values: slots.into_iter() }),
        }
    }

    /// The value of the next parameter.
    ///
    /// - `library`: where names of reflectances are looked up.
    pub(super) fn next<P: Takes>(&mut self, name: &str, takes: &P, library: &Library) -> Result<P::Value, String> {
        takes.value(name, self.values.next().flatten().as_ref(), library)
    }
}

fn take_map(parameters: &[Parameter], map: &Dynamic, slots: &mut [Option<Dynamic>]) -> Result<(), String> {
    let map = map.read_lock::<Map>().ok_or("the map cannot be read")?;
    for (key, value) in map.iter() {
        let named = parameters.iter().position(|p| !p.takes.is_object() && p.name == key.as_str());
        let Some(index) = named else {
            let names = parameters.iter().filter(|p| !p.takes.is_object());
            let names: Vec<&str> = names.map(|p| p.name).collect();
            return Err(format!("unknown parameter {key}; it takes {}", names.join(", ")));
        };
        if slots[index].is_some() {
            return Err(format!("{key} is given twice"));
        }
        slots[index] = Some(value.clone());
    }
    Ok(())
}
