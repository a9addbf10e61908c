//! The function of the scene language that makes a procedural model of a function of the script.

use super::builder::Builder;
use super::fault::MAX_OPERATIONS;
use super::function::{Function, function};
use super::handle::CallResult;
use super::kinds::{BoundsKind, Integer, ModelFunction, VariedKind, VariedMap};
use super::model::{ModelParameter, ModelParameterValue, ScriptModel};
use super::parameter::{checked, optional, required, with_default};
use super::plain::PlainValue;
use crate::database::Library;
use crate::octree::Instance;
use crate::scene::{Instances, MOST_KINDS, Object, PlacementList, Placing, Procedural, ProceduralModel, Shape};
use glam::DAffine3;
use rhai::{Dynamic, FnPtr};
use std::sync::{Arc, OnceLock};

/// What the argument of a model's function has in any case.
const GIVEN: [&str; 2] = ["seed", "detail"];

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[function! {
    procedural(
        function: required(
            ModelFunction,
            "what makes the objects of one kind: its parameter p is a map of p.seed, a whole number from 0 that tells which kind, p.detail, what a pixel spans where it is seen, units of the model, and all of vary; what is smaller than p.detail may be left out",
        ),
        bounds: required(BoundsKind, "the box that holds all that it makes, units of the model"),
        kinds: with_default(Integer(1, MOST_KINDS), MOST_KINDS, "how many different ones there are"),
        vary: optional(
            VariedMap,
            "none",
            "further parameters of p: a number stays, of [mean, deviation] each kind has a number of its own between mean - deviation and mean + deviation",
        ),
    )
    "Makes an object that is modelled by a function, when a ray comes to it, as finely as it is seen there: where instances place it, each is one of its kinds. The function makes objects only, and always those same of the same p. What it captures must be numbers, strings, true or false, and arrays and maps of these; what it prints is not shown."
    "let stone = procedural(|p| { sphere(p.size).scale(1, 0.7, 1); }, #{ bounds: [[-1, -1, -1], [1, 1, 1]], vary: #{ size: [0.7, 0.2] } }); scatter(stone, ground(20), 100);"
    |builder| {
        if builder.makes_model() {
            return Err("a model cannot be made within the function of another".into());
        }
        let captured = captured(&function)?;
        let parameters = parameters(vary.unwrap_or_default(), &builder.databases.library)?;
        let model = Arc::new(ScriptModel {
            source: Arc::clone(&builder.source),
            at: builder.called_at,
            now: builder.now,
            databases: builder.databases.clone(),
            function: function.fn_name().to_owned(),
            captured,
            parameters,
            bounds,
            kinds,
            first_operations: MAX_OPERATIONS.saturating_sub(builder.model_operations),
            first: OnceLock::new(),
        });
        add(builder, model)
    }
}];

/// Adds an object that is a model of a script.
fn add(builder: &mut Builder, model: Arc<ScriptModel>) -> CallResult {
    let made = Procedural::new(Arc::clone(&model) as Arc<dyn ProceduralModel>);
    match model.first.get() {
        Some(Ok(first)) => builder.note_call(first)?,
        Some(Err(fault)) => {
            builder.failed_at = fault.position();
            return Err(fault.message.clone());
        }
        None => {}
    }
    add_made(builder, "procedural", made?)
}

/// Adds an object that is a model.
///
/// - `called`: the function of the language that makes it.
pub(super) fn add_model(builder: &mut Builder, called: &'static str, model: Arc<dyn ProceduralModel>) -> CallResult {
    add_made(builder, called, Procedural::new(model)?)
}

fn add_made(builder: &mut Builder, called: &'static str, model: Procedural) -> CallResult {
    let object = Object::procedural(called.into(), model);
    let here = Instance { prototype: 0, variation: 0, placement: DAffine3::IDENTITY };
    let placing = Placing::Listed(PlacementList(vec![here]));
    let shape = Shape::Instances(Box::new(Instances { prototypes: vec![vec![object]], placing }));
    builder.add_called(called, shape, None).map(Dynamic::from)
}

/// What a function captured.
fn captured(function: &FnPtr) -> Result<Vec<PlainValue>, String> {
    let plain = |value: &Dynamic| {
        PlainValue::of(value).map_err(|other| {
            format!(
                "the function captures {other}; it can capture numbers, strings, true and false, and arrays and maps \
                 of these"
            )
        })
    };
    function.curry().iter().map(plain).collect()
}

/// What the argument of a model's function has by name.
fn parameters(vary: Vec<(String, Dynamic)>, library: &Library) -> Result<Vec<ModelParameter>, String> {
    let parameter = |(name, value): (String, Dynamic)| {
        if GIVEN.contains(&name.as_str()) {
            return Err(format!("{name} of vary is what each model has already; it needs another name"));
        }
        let varied = checked(&VariedKind, &format!("{name} of vary"), &value, library)?;
        let value = match PlainValue::of(&value) {
            Ok(number @ (PlainValue::Whole(_) | PlainValue::Number(_))) => ModelParameterValue::Constant(number),
            _ => ModelParameterValue::Drawn(varied),
        };
        Ok(ModelParameter { name, value })
    };
    vary.into_iter().map(parameter).collect()
}
