//! What functions take: names, kinds of values, defaults, help.

use super::handle::Handle;
use super::spline::ControlMeaning;
use crate::curve::SplineCurve;
use crate::database::Library;
use crate::illumination::Paint;
use crate::illumination::distribution::FacetTable;
use crate::illumination::texture::NumberTexture;
use rhai::{Dynamic, FnPtr, ImmutableString};

/// What a function takes: a row of its help.
#[derive(Clone, Copy)]
pub struct Parameter {
    /// Its name, as in the map.
    pub name: &'static str,
    /// What it takes.
    pub(super) takes: &'static dyn Described,
}

/// A kind of value, and what the value of a script becomes.
pub(super) trait ParameterKind {
    /// What a value becomes.
    type Value;
    /// Whether three bare numbers may stand for one value.
    const TAKES_THREE: bool = false;
    /// Whether it is an object: such a value stands before a dot or in a list of values, never in a map.
    const IS_OBJECT: bool = false;
    /// Whether it is a function, which is sampled before the call.
    const IS_FUNCTION: bool = false;

    /// The kind in words, as in "must be ...".
    fn words(&self) -> String;

    /// A value; none if it is not of this kind.
    fn read(&self, value: &Dynamic) -> Option<Self::Value>;

    /// What a string stands for in the library; none where strings name nothing there.
    fn look_up(&self, _name: &str, _library: &Library) -> Option<Result<Self::Value, String>> {
        None
    }
}

/// A kind whose default can be written as a constant.
pub(super) trait HasDefault: ParameterKind {
    /// How the default is written.
    type Default: Copy;

    /// What the default becomes.
    fn of_default(&self, default: Self::Default) -> Self::Value;

    /// The default as help shows it: as a script would write it.
    fn shown(&self, default: Self::Default) -> String;
}

/// What help and the binding of values ask of a parameter, whatever its type.
pub(super) trait Described {
    /// What it means, with its unit.
    fn help(&self) -> &'static str;
    /// Its kind in words.
    fn words(&self) -> String;
    /// What holds where it is not given; none if it must be given.
    fn otherwise(&self) -> Option<String>;
    /// Whether three bare numbers may stand for one value.
    fn takes_three(&self) -> bool;
    /// Whether it is an object.
    fn is_object(&self) -> bool;
    /// Whether it is a function.
    fn is_function(&self) -> bool;
}

/// A parameter with its type.
pub(super) trait Takes: Described {
    /// What the action of a function gets.
    type Value;

    /// The value of a call, checked.
    fn value(&self, name: &str, given: Option<&Dynamic>, library: &Library) -> Result<Self::Value, String>;
}

/// A parameter that must be given.
#[derive(Clone, Copy)]
pub(super) struct Required<K> {
    kind: K,
    help: &'static str,
}

/// A parameter with a default.
#[derive(Clone, Copy)]
pub(super) struct Defaulted<K, D> {
    kind: K,
    default: D,
    note: &'static str,
    help: &'static str,
}

/// A parameter that may be left out.
#[derive(Clone, Copy)]
pub(super) struct Optional<K> {
    kind: K,
    otherwise: &'static str,
    help: &'static str,
}

/// A parameter that changes a setting, which stays where it is not given.
#[derive(Clone, Copy)]
pub(super) struct ChangedSetting<K, D> {
    kind: K,
    default: D,
    help: &'static str,
}

/// A parameter that must be given.
pub(super) const fn required<K: ParameterKind + Copy>(kind: K, help: &'static str) -> Required<K> {
    Required { kind, help }
}

/// A parameter with a default.
pub(super) const fn with_default<K>(kind: K, default: K::Default, help: &'static str) -> Defaulted<K, K::Default>
where
    K: HasDefault + Copy,
{
    Defaulted { kind, default, note: "", help }
}

/// A parameter that may be left out.
///
/// - `otherwise`: what holds then, in words.
pub(super) const fn optional<K: ParameterKind + Copy>(
    kind: K,
    otherwise: &'static str,
    help: &'static str,
) -> Optional<K> {
    Optional { kind, otherwise, help }
}

/// A parameter that changes a setting.
///
/// - `default`: that of a scene where the setting was never changed.
pub(super) const fn setting<K>(kind: K, default: K::Default, help: &'static str) -> ChangedSetting<K, K::Default>
where
    K: HasDefault + Copy,
{
    ChangedSetting { kind, default, help }
}

impl<K: Copy, D: Copy> Defaulted<K, D> {
    /// With a word about the default, as "0: polished".
    pub(super) const fn note(self, note: &'static str) -> Defaulted<K, D> {
        Defaulted { note, ..self }
    }
}

/// Passes on what a parameter tells of its kind; `otherwise` differs.
macro_rules! described {
    (|$parameter:ident| $otherwise:expr) => {
        fn help(&self) -> &'static str {
            self.help
        }

        fn words(&self) -> String {
            self.kind.words()
        }

        fn otherwise(&self) -> Option<String> {
            let $parameter = self;
            $otherwise
        }

        fn takes_three(&self) -> bool {
            K::TAKES_THREE
        }

        fn is_object(&self) -> bool {
            K::IS_OBJECT
        }

        fn is_function(&self) -> bool {
            K::IS_FUNCTION
        }
    };
}

impl<K: ParameterKind> Described for Required<K> {
    described!(|_parameter| None);
}

impl<K: HasDefault> Described for Defaulted<K, K::Default> {
    described!(|parameter| {
        let colon = if parameter.note.is_empty() { "" } else { ": " };
        Some(format!("{}{colon}{}", parameter.kind.shown(parameter.default), parameter.note))
    });
}

impl<K: ParameterKind> Described for Optional<K> {
    described!(|parameter| Some(parameter.otherwise.to_owned()));
}

impl<K: HasDefault> Described for ChangedSetting<K, K::Default> {
    described!(|parameter| Some(parameter.kind.shown(parameter.default)));
}

impl<K: ParameterKind> Takes for Required<K> {
    type Value = K::Value;

    fn value(&self, name: &str, given: Option<&Dynamic>, library: &Library) -> Result<K::Value, String> {
        checked(&self.kind, name, given.ok_or_else(|| format!("{name} is missing"))?, library)
    }
}

impl<K: HasDefault> Takes for Defaulted<K, K::Default> {
    type Value = K::Value;

    fn value(&self, name: &str, given: Option<&Dynamic>, library: &Library) -> Result<K::Value, String> {
        given.map_or_else(|| Ok(self.kind.of_default(self.default)), |value| checked(&self.kind, name, value, library))
    }
}

impl<K: ParameterKind> Takes for Optional<K> {
    type Value = Option<K::Value>;

    fn value(&self, name: &str, given: Option<&Dynamic>, library: &Library) -> Result<Option<K::Value>, String> {
        given.map(|value| checked(&self.kind, name, value, library)).transpose()
    }
}

impl<K: HasDefault> Takes for ChangedSetting<K, K::Default> {
    type Value = Option<K::Value>;

    fn value(&self, name: &str, given: Option<&Dynamic>, library: &Library) -> Result<Option<K::Value>, String> {
        given.map(|value| checked(&self.kind, name, value, library)).transpose()
    }
}

/// A value of this kind.
pub(super) fn checked<K: ParameterKind>(
    kind: &K,
    name: &str,
    value: &Dynamic,
    library: &Library,
) -> Result<K::Value, String> {
    let text = value.read_lock::<ImmutableString>();
    if let Some(found) = text.and_then(|text| kind.look_up(&text, library)) {
        return found.map_err(|error| format!("{name}: {error}"));
    }
    kind.read(value).ok_or_else(|| format!("{name} must be {}, not {}", kind.words(), in_short(value)))
}

/// The value as messages show it: short.
pub(super) fn in_short(value: &Dynamic) -> String {
    const LONGEST: usize = 60;
    for (is_one, words) in [
        (value.is::<Handle>(), "an object"),
        (value.is::<SplineCurve>(), "a curve"),
        (value.is::<ControlMeaning>(), "a kind of spline"),
        (value.is::<Paint>(), "a pattern"),
        (value.is::<NumberTexture>(), "a pattern of numbers"),
        (value.is::<FacetTable>(), "a distribution"),
        (value.is::<FnPtr>(), "a function"),
    ] {
        if is_one {
            return words.into();
        }
    }
    let text = format!("{value:?}");
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text,
    }
}
