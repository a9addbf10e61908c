//! Calls of functions of a script on any thread, each with what it makes.

use super::bindings::{self, RunProgress, State};
use super::builder::Builder;
use super::error;
use super::fault::ScriptFault;
use super::source::{CallOutcome, FunctionCall, ScriptSource};
use crate::scene::{Object, Scene, SceneError, ScriptPosition, Shape};
use rhai::{AST, CallFnOptions, Dynamic, Engine, EvalAltResult, Scope};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;

/// Of how many scripts a thread keeps the functions.
const KEPT_SCRIPTS: usize = 4;

/// What is said of a constant of the script that is not known.
const GLOBAL: &str = "unknown name global::";

thread_local! {
    /// The interpreter of a thread while it does not run.
    static IDLE: Cell<Option<Caller>> = const { Cell::new(None) };
}

/// An interpreter that calls functions of scripts.
struct Caller {
    engine: Engine,
    state: State,
    /// How far what runs has come.
    progress: Rc<RunProgress>,
    /// The functions of scripts, the last one that was asked for at the end.
    compiled: Vec<(Arc<ScriptSource>, Rc<AST>)>,
}

/// Calls a function of a script, without running the script itself.
///
/// # Errors
/// [`ScriptFault`], if it fails, or makes what a model is not made of.
pub(super) fn call(call: &FunctionCall<'_>) -> Result<CallOutcome, ScriptFault> {
    let idle = IDLE.with(Cell::take);
    let mut caller = idle.unwrap_or_else(|| Caller::new(call));
    let outcome = caller.call(call);
    IDLE.with(|idle| idle.set(Some(caller)));
    outcome
}

impl Caller {
    fn new(call: &FunctionCall<'_>) -> Caller {
        let state: State = Rc::new(RefCell::new(Builder::of_call(call)));
        let progress = Rc::default();
        let mut engine = bindings::engine(&state, &progress);
        engine.on_print(|_| {});
        Caller { engine, state, progress, compiled: Vec::new() }
    }

    fn call(&mut self, call: &FunctionCall<'_>) -> Result<CallOutcome, ScriptFault> {
        let ScriptSource { name, text, .. } = &**call.source;
        let failed = |at: Option<ScriptPosition>, problem: String| ScriptFault::new(name, text, at, problem);
        let fault = |error: &EvalAltResult| {
            let (mut problem, position) = error::describe(error);
            if problem.contains(GLOBAL) {
                problem.push_str("; the function of a model knows its parameter and what it captured alone");
            }
            failed(error::position_of(position), problem)
        };
        let functions = self.functions_of(call.source).map_err(|error| fault(&error))?;
        check_function(&functions, call).map_err(|problem| failed(None, problem))?;
        self.state.replace(Builder::of_call(call));
        self.progress.begin();
        // 0 would be without a limit.
        self.engine.set_max_operations(call.most_operations.max(1));
        let options = CallFnOptions::new().eval_ast(false);
        let arguments = call.arguments.clone();
        let outcome: Result<Dynamic, Box<EvalAltResult>> =
            self.engine.call_fn_with_options(options, &mut Scope::new(), &functions, call.function, arguments);
        let mut made = self.state.borrow_mut();
        let (objects, positions): (Vec<Object>, Vec<_>) = made.take_objects().into_iter().unzip();
        let _ignored = outcome.map_err(|error| fault(&error))?;
        let objects = checked(objects, &positions).map_err(|(at, problem)| failed(at, problem))?;
        Ok(CallOutcome {
            objects,
            operations: self.progress.steps.get(),
            asked_time: made.asked_time,
            parameters: made.definitions.asked(),
            files: made.folders.named(),
        })
    }

    /// The functions of a script.
    fn functions_of(&mut self, source: &Arc<ScriptSource>) -> Result<Rc<AST>, Box<EvalAltResult>> {
        let is_of = |known: &ScriptSource| std::ptr::eq(known, &**source) || known.text == source.text;
        let known = self.compiled.iter().position(|(known, _)| is_of(known));
        let (source, functions) = match known {
            Some(place) => self.compiled.remove(place),
            None => (Arc::clone(source), Rc::new(self.engine.compile(&source.text)?)),
        };
        if self.compiled.len() == KEPT_SCRIPTS {
            self.compiled.remove(0);
        }
        self.compiled.push((source, Rc::clone(&functions)));
        Ok(functions)
    }
}

/// Refuses to call a function that is not there, or takes something else.
fn check_function(functions: &AST, call: &FunctionCall<'_>) -> Result<(), String> {
    let count = call.arguments.len();
    let mut least = None;
    for function in functions.iter_functions().filter(|function| function.name == call.function) {
        if function.params.len() == count {
            return Ok(());
        }
        least = Some(function.params.len());
    }
    let captured = count - 1;
    Err(match least {
        None => format!("the script has no function {}", call.function),
        Some(other) => format!("the function takes {} parameters, not one", other.saturating_sub(captured)),
    })
}

/// Refuses what a model is not made of, with its place.
fn checked(
    objects: Vec<Object>,
    positions: &[Option<ScriptPosition>],
) -> Result<Vec<Object>, (Option<ScriptPosition>, String)> {
    for (object, at) in objects.iter().zip(positions) {
        let problem = match object.shape {
            Shape::Curve(_) => "is a curve; a model is made of surfaces",
            Shape::HalfSpace { .. } => "has no end",
            _ if object.emits() => "emits light; a model makes objects that do not",
            _ => continue,
        };
        return Err((*at, format!("{} {problem}", object.name)));
    }
    let scene = Scene { objects, ..Scene::default() };
    match scene.check() {
        Ok(()) => Ok(scene.objects),
        Err(error) => {
            let place = match &error {
                SceneError::Object { object, .. } => scene.objects.iter().position(|known| known.name == *object),
                _ => None,
            };
            Err((place.and_then(|place| positions[place]), error.to_string()))
        }
    }
}
