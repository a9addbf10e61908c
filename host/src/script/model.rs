//! Procedural models that a function of a script makes.

use super::fault::{MAX_OPERATIONS, ScriptFault};
use super::plain::PlainValue;
use super::source::{CallOutcome, FunctionCall, OpenDatabases, ScriptSource};
use crate::illumination::Material;
use crate::numeric::bounds::Bounds;
use crate::procedural::{Varied, channel};
use crate::scene::{Object, ProceduralModel, ScriptPosition};
use rhai::{Dynamic, INT, Map};
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A model whose objects a function of a script makes. It is plain data: each thread that asks for objects has an
/// interpreter of its own.
pub(super) struct ScriptModel {
    pub(super) source: Arc<ScriptSource>,
    /// Where the script makes it a model.
    pub(super) at: Option<ScriptPosition>,
    /// What the function gets when it asks for the time, seconds.
    pub(super) now: f64,
    pub(super) databases: OpenDatabases,
    /// The name of the function.
    pub(super) function: String,
    /// What it captured: its first arguments.
    pub(super) captured: Vec<PlainValue>,
    /// What its last argument has beside the seed and the detail.
    pub(super) parameters: Vec<ModelParameter>,
    pub(super) bounds: Bounds,
    pub(super) kinds: u32,
    /// Steps that its first call may take.
    pub(super) first_operations: u64,
    /// What the first call asked for, its objects taken away, or what was wrong with it.
    pub(super) first: OnceLock<Result<CallOutcome, ScriptFault>>,
}

/// A parameter of a model.
#[derive(Debug)]
pub(super) struct ModelParameter {
    pub(super) name: String,
    pub(super) value: ModelParameterValue,
}

/// What a parameter of a model is.
#[derive(Debug)]
pub(super) enum ModelParameterValue {
    /// Alike in all kinds.
    Constant(PlainValue),
    /// Drawn for each of the kinds.
    Drawn(Varied),
}

impl ProceduralModel for ScriptModel {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn kinds(&self) -> u32 {
        self.kinds
    }

    fn materials(&self) -> Vec<Material> {
        Vec::new()
    }

    fn make(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String> {
        let (objects, first) = match self.call(seed, detail) {
            Ok(mut made) => (Ok(std::mem::take(&mut made.objects)), Ok(made)),
            Err(fault) => (Err(fault.to_string()), Err(fault)),
        };
        // Of several calls at once one is the first.
        let _ = self.first.set(first);
        objects
    }

    fn definition(&self) -> String {
        let ScriptSource { text, folder, inputs, .. } = &*self.source;
        let definitions: Vec<String> =
            inputs.definitions.iter().map(|given| format!("{}={}", given.name, given.value)).collect();
        // What does not ask for the time is the same at all times.
        let time = match self.first.get() {
            Some(Ok(CallOutcome { asked_time: false, .. })) => None,
            _ => Some(self.now),
        };
        format!(
            "function {:?} of {:?} with {:?} from {:?} to {:?}, {} kinds, definitions {definitions:?}, time {time:?}, \
             folders {folder:?} {:?}, databases {:?}\n{text}",
            self.function,
            self.captured,
            self.parameters,
            self.bounds.min,
            self.bounds.max,
            self.kinds,
            inputs.allowed,
            self.databases.files,
        )
    }
}

impl ScriptModel {
    fn call(&self, seed: u32, detail: f64) -> Result<CallOutcome, ScriptFault> {
        let mut arguments: Vec<Dynamic> = self.captured.iter().map(PlainValue::to_value).collect();
        arguments.push(Dynamic::from_map(self.argument(seed, detail)));
        let call = FunctionCall {
            source: &self.source,
            now: self.now,
            databases: &self.databases,
            function: &self.function,
            arguments,
            most_operations: if self.first.get().is_none() { self.first_operations } else { MAX_OPERATIONS },
            may_ask_time: !matches!(self.first.get(), Some(Ok(CallOutcome { asked_time: false, .. }))),
        };
        (self.source.call)(&call).map_err(|fault| {
            let message = format!("in the model of seed {seed} at detail {}: {}", rounded(detail), fault.message);
            match fault.position() {
                Some(_) => ScriptFault { message, ..fault },
                None => ScriptFault::new(&self.source.name, &self.source.text, self.at, message),
            }
        })
    }

    /// What the function is given.
    fn argument(&self, seed: u32, detail: f64) -> Map {
        let mut argument = Map::new();
        argument.insert("seed".into(), Dynamic::from(INT::from(seed)));
        argument.insert("detail".into(), Dynamic::from(detail));
        for ModelParameter { name, value } in &self.parameters {
            let value = match value {
                ModelParameterValue::Constant(value) => value.to_value(),
                ModelParameterValue::Drawn(varied) => Dynamic::from(varied.draw(seed, channel(name))),
            };
            argument.insert(name.as_str().into(), value);
        }
        argument
    }
}

impl fmt::Debug for ScriptModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the model {} of {:?}", self.function, self.source)
    }
}

/// A number of three digits, as messages show it.
fn rounded(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}
