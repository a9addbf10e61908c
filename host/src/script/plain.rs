//! Values of a script that are plain data, which go from thread to thread.

use super::parameter::in_short;
use rhai::{Array, Dynamic, FLOAT, INT, ImmutableString, Map};

/// Deepest nesting of arrays and maps.
const MOST_NESTING: u32 = 16;

/// A number, a string, true or false, or an array or a map of these.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PlainValue {
    Flag(bool),
    Whole(INT),
    Number(FLOAT),
    Text(String),
    List(Vec<PlainValue>),
    /// By name, in the order of the names.
    Table(Vec<(String, PlainValue)>),
}

impl PlainValue {
    /// The value of a script as data.
    ///
    /// # Errors
    /// What in it is none, as messages show it.
    pub(super) fn of(value: &Dynamic) -> Result<PlainValue, String> {
        PlainValue::within(value, MOST_NESTING)
    }

    fn within(value: &Dynamic, nesting: u32) -> Result<PlainValue, String> {
        if value.is_shared() {
            return PlainValue::within(&value.clone().flatten(), nesting);
        }
        let deeper = || nesting.checked_sub(1).ok_or_else(|| format!("lists more than {MOST_NESTING} deep"));
        if let Some(array) = value.read_lock::<Array>() {
            let nesting = deeper()?;
            let each = array.iter().map(|value| PlainValue::within(value, nesting));
            return each.collect::<Result<Vec<_>, _>>().map(PlainValue::List);
        }
        if let Some(map) = value.read_lock::<Map>() {
            let nesting = deeper()?;
            let each = map.iter().map(|(name, value)| Ok((name.to_string(), PlainValue::within(value, nesting)?)));
            return each.collect::<Result<Vec<_>, String>>().map(PlainValue::Table);
        }
        if let Some(text) = value.read_lock::<ImmutableString>() {
            return Ok(PlainValue::Text(text.to_string()));
        }
        let flag = value.as_bool().map(PlainValue::Flag);
        let number = flag.or_else(|_| value.as_int().map(PlainValue::Whole));
        number.or_else(|_| value.as_float().map(PlainValue::Number)).map_err(|_| in_short(value))
    }

    /// The value as a script has it.
    pub(super) fn to_value(&self) -> Dynamic {
        match self {
            PlainValue::Flag(flag) => Dynamic::from(*flag),
            PlainValue::Whole(whole) => Dynamic::from(*whole),
            PlainValue::Number(number) => Dynamic::from(*number),
            PlainValue::Text(text) => Dynamic::from(text.clone()),
            PlainValue::List(list) => Dynamic::from_array(list.iter().map(PlainValue::to_value).collect()),
            PlainValue::Table(table) => {
                let named = table.iter().map(|(name, value)| (name.as_str().into(), value.to_value()));
                Dynamic::from_map(named.collect())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_values_come_back_as_they_were_and_others_do_not_go() {
        let engine = rhai::Engine::new();
        let script = "[1, 2.5, \"a\", true, [], #{ b: [1], a: #{ c: -0.0 } }]";
        let value: Dynamic = engine.eval(script).expect("a value");
        let plain = PlainValue::of(&value).expect("plain");
        assert_eq!(format!("{:?}", plain.to_value()), format!("{value:?}"));
        for (script, expected) in [("[1, [||3]]", "a function"), ("#{ a: () }", "()"), ("'a'", "'a'"), ("1..3", "1..3")]
        {
            let refused = PlainValue::of(&engine.eval::<Dynamic>(script).expect("a value")).expect_err(script);
            assert!(refused.contains(expected), "{refused}");
        }
        let mut deep = Dynamic::from(1_i64);
        for _ in 0..=MOST_NESTING {
            deep = Dynamic::from_array(vec![deep]);
        }
        assert!(PlainValue::of(&deep).expect_err("deep").contains("more than 16 deep"));
    }
}
