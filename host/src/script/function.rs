//! A row of the function table: name, parameters, help, example, action.

use super::builder::Builder;
use super::given::BoundArguments;
use super::handle::CallResult;
use super::parameter::Parameter;

/// A function that scripts may call; `function!` writes one.
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub summary: &'static str,
    /// What it takes, in order; the last argument may be a map `#{name: value}` instead.
    pub parameters: &'static [Parameter],
    /// A line of script that uses it.
    pub example: &'static str,
    /// What it does to the scene; returns the value of the call: the object that it made or changed, if there is one.
    pub(super) action: fn(&mut Builder, &mut BoundArguments) -> CallResult,
}

/// A row: `name(parameter: what it takes, ...) "summary" "example" |builder| action`. In the action every parameter is a
/// value of its kind.
macro_rules! function {
    (
        $name:ident($($parameter:ident: $takes:expr),* $(,)?)
        $summary:literal
        $example:literal
        |$builder:pat_param| $action:expr
    ) => {
        $crate::script::function::Function {
            name: stringify!($name),
            summary: $summary,
            parameters: &[$($crate::script::parameter::Parameter { name: stringify!($parameter), takes: &$takes }),*],
            example: $example,
            action: |builder, _given| {
                $(let $parameter = _given.next(stringify!($parameter), &$takes, &builder.databases.library)?;)*
                let $builder = builder;
                $action
            },
        }
    };
}

pub(super) use function;

impl Function {
    /// Whether it is called on an object: `object.function(...)`.
    pub fn is_method(&self) -> bool {
        self.parameters.first().is_some_and(|p| p.takes.is_object())
    }

    /// How it is called, in one line.
    pub fn usage(&self) -> String {
        let own = if self.is_method() { &self.parameters[1..] } else { self.parameters };
        let names: Vec<&str> = own.iter().map(|p| p.name).collect();
        let prefix = if self.is_method() { "object." } else { "" };
        format!("{prefix}{}({})", self.name, names.join(", "))
    }

    /// The help text: usage, summary, parameters, example.
    pub fn help(&self) -> String {
        let mut text = format!("{}\n    {}\n", self.usage(), self.summary);
        let own = self.parameters.iter().filter(|p| !p.takes.is_object());
        let width = own.clone().map(|p| p.name.len()).max().unwrap_or(0);
        for Parameter { name, takes } in own {
            let default = takes.otherwise().map_or("required".to_owned(), |text| format!("default: {text}"));
            text.push_str(&format!("    {name:<width$}  {}: {} ({default})\n", takes.help(), takes.words()));
        }
        text.push_str(&format!("    example: {}", self.example));
        text
    }

    /// Fewest and most arguments that a call may have.
    pub(super) fn arity(&self) -> (usize, usize) {
        let receiver = usize::from(self.is_method());
        // Everything after the receiver may stand in one map; a vector may be spelled as three numbers.
        let most = self.parameters.iter().map(|p| if p.takes.takes_three() { 3 } else { 1 }).sum();
        (receiver, most)
    }
}
