//! The interpreter: its limits, and its functions from the table.

use super::builder::Builder;
use super::error::{self, OutOfMemory, OutOfStack};
use super::fault::MAX_OPERATIONS;
use super::function::Function;
use super::functions::{functions, makes_shapes};
use super::given::BoundArguments;
use super::handle::Handle;
use super::spline::ControlMeaning;
use crate::curve::SplineCurve;
use crate::illumination::Paint;
use crate::illumination::distribution::{FacetError, FacetTable};
use crate::illumination::texture::NumberTexture;
use crate::memory;
use crate::scene::ScriptPosition;
use rhai::module_resolvers::DummyModuleResolver;
use rhai::{Dynamic, Engine, EvalAltResult, FnPtr, Map, NativeCallContext};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

/// Longest string in a script, bytes.
const MAX_STRING: usize = 1 << 20;
/// Most elements of an array or a map.
const MAX_ELEMENTS: usize = 1 << 14;
/// Deepest nesting of calls.
const MAX_CALLS: usize = 64;
/// Deepest nesting of expressions, outside and inside functions.
const MAX_NESTING: (usize, usize) = (64, 48);
/// How many of the operations look at the memory: one of so many.
const MEMORY_CHECK_INTERVAL: u64 = 64;
/// The most of the stack of a thread that calls within calls take where the stack is small, bytes: half of it.
const MOST_STACK: usize = 1 << 20;
/// Part of the memory that is kept for what is made of the scene, when a script is refused: one of so many.
const RESERVED_FRACTION: u64 = 16;
/// Seed of the names of functions without one; any numbers will do.
const HASHING_SEED: [u64; 4] = [1, 2, 3, 4];
/// Words that scripts may not use: they run text and load other files.
const FORBIDDEN: [&str; 2] = ["eval", "import"];

/// Operators between objects, and the functions that they stand for.
const OPERATORS: [(&str, &str); 4] =
    [("+", "union"), ("*", "intersection"), ("-", "difference"), ("^", "symmetric_difference")];

/// What the functions of the table build.
pub(super) type State = Rc<RefCell<Builder>>;

/// How far what runs has come.
#[derive(Default)]
pub(super) struct RunProgress {
    /// The steps that it took.
    pub(super) steps: Cell<u64>,
    /// Where the stack was when it began, if it may take no more than [`MOST_STACK`] of it.
    stack: Cell<Option<usize>>,
}

impl RunProgress {
    /// Begins anew, on a thread whose stack may be no larger than those of most threads.
    pub(super) fn begin(&self) {
        self.steps.set(0);
        self.stack.set(Some(stack_address()));
    }

    fn takes_much_stack(&self) -> bool {
        self.stack.get().is_some_and(|begin| begin.abs_diff(stack_address()) > MOST_STACK)
    }
}

/// About where the stack of this thread ends.
#[inline(never)]
fn stack_address() -> usize {
    let here = 0_u8;
    std::ptr::from_ref(std::hint::black_box(&here)).addr()
}

/// An interpreter whose functions build what is in `state`.
pub(super) fn engine(state: &State, progress: &Rc<RunProgress>) -> Engine {
    let mut engine = limited(progress);
    engine.on_debug(|_, _, _| {});
    engine.register_type_with_name::<Handle>("object");
    engine.register_type_with_name::<ControlMeaning>("spline");
    engine.register_type_with_name::<SplineCurve>("curve");
    engine.register_type_with_name::<Paint>("pattern");
    engine.register_type_with_name::<NumberTexture>("pattern of numbers");
    engine.register_type_with_name::<FacetTable>("distribution");
    for function in functions() {
        bind(&mut engine, function, state);
        if let Some((symbol, _)) = OPERATORS.iter().find(|(_, name)| *name == function.name) {
            let state = Rc::clone(state);
            engine.register_fn(*symbol, move |context: NativeCallContext<'_>, a: Handle, b: Handle| -> Answer {
                call(function, &state, &context, &[Dynamic::from(a), Dynamic::from(b)])
            });
        }
    }
    engine
}

fn limited(progress: &Rc<RunProgress>) -> Engine {
    // The names of functions without one are the same in every program: they are a part of what models are known by.
    let _ = rhai::config::hashing::set_hashing_seed(Some(HASHING_SEED));
    let progress = Rc::clone(progress);
    let mut engine = Engine::new();
    engine
        .set_max_operations(MAX_OPERATIONS)
        .set_max_string_size(MAX_STRING)
        .set_max_array_size(MAX_ELEMENTS)
        .set_max_map_size(MAX_ELEMENTS)
        .set_max_call_levels(MAX_CALLS)
        .set_max_expr_depths(MAX_NESTING.0, MAX_NESTING.1)
        .set_max_modules(0)
        .set_module_resolver(DummyModuleResolver::new());
    engine.on_progress(move |operations| {
        progress.steps.set(operations);
        if progress.takes_much_stack() {
            return Some(Dynamic::from(OutOfStack));
        }
        let is_short = || memory::limit().is_some_and(|limit| memory::left() < limit / RESERVED_FRACTION);
        let ends = operations.is_multiple_of(MEMORY_CHECK_INTERVAL) && is_short();
        ends.then(|| Dynamic::from(OutOfMemory))
    });
    for symbol in FORBIDDEN {
        engine.disable_symbol(symbol);
    }
    // A scene is a function of the time that it is given, whenever its script runs, and the script does not wait.
    let refuse = || -> Answer {
        Err("a scene script can neither wait nor read the clock; time() is the time of the picture".into())
    };
    engine.register_fn("sleep", move |_: rhai::INT| refuse());
    engine.register_fn("sleep", move |_: rhai::FLOAT| refuse());
    engine.register_fn("timestamp", refuse);
    engine
}

type Answer = Result<Dynamic, Box<EvalAltResult>>;

/// Registers a row for every number of arguments that it can be called with.
fn bind(engine: &mut Engine, function: &'static Function, state: &State) {
    let (least, most) = function.arity();
    for arity in least..=most {
        let state = Rc::clone(state);
        let call = move |context: NativeCallContext<'_>, values: &[Dynamic]| call(function, &state, &context, values);
        let name = function.name;
        match arity {
            0 => engine.register_fn(name, move |c: NativeCallContext<'_>| -> Answer { call(c, &[]) }),
            1 => engine.register_fn(name, move |c: NativeCallContext<'_>, a: Dynamic| -> Answer { call(c, &[a]) }),
            2 => engine.register_fn(name, move |c: NativeCallContext<'_>, a: Dynamic, b: Dynamic| -> Answer {
                call(c, &[a, b])
            }),
            3 => engine
                .register_fn(name, move |x: NativeCallContext<'_>, a: Dynamic, b: Dynamic, c: Dynamic| -> Answer {
                    call(x, &[a, b, c])
                }),
            4 => engine.register_fn(
                name,
                move |x: NativeCallContext<'_>, a: Dynamic, b: Dynamic, c: Dynamic, d: Dynamic| -> Answer {
                    call(x, &[a, b, c, d])
                },
            ),
            // Longer lists of values are unreadable: a map takes their place.
            _ => break,
        };
    }
}

fn call(function: &Function, state: &State, context: &NativeCallContext<'_>, values: &[Dynamic]) -> Answer {
    let failed = |problem: String| {
        let message = format!("{}: {problem}", function.name);
        let elsewhere = state.borrow_mut().failed_at.take().map(|ScriptPosition { line, column }| {
            rhai::Position::new(line.try_into().unwrap_or(u16::MAX), column.try_into().unwrap_or(u16::MAX))
        });
        Box::new(EvalAltResult::ErrorRuntime(message.into(), elsewhere.unwrap_or_else(|| context.call_position())))
    };
    // Functions of the script run before the scene is taken hold of: they may build, too.
    let takes_functions = function.parameters.iter().any(|parameter| parameter.takes.is_function());
    let sampled: Vec<Dynamic>;
    let values = if takes_functions {
        sampled = values.iter().map(|value| sample(function, context, value)).collect::<Result<_, _>>()?;
        &sampled
    } else {
        values
    };
    let mut given = BoundArguments::new(function.parameters, || function.usage(), values).map_err(failed)?;
    let called_at = error::position_of(context.call_position());
    state.borrow_mut().called_at = called_at;
    let outcome = (function.action)(&mut state.borrow_mut(), &mut given);
    let made = outcome.map_err(failed)?;
    let refused = state.borrow().check_model();
    refused.map_err(failed)?;
    if let (Some(handle), Some(position)) = (made.clone().try_cast::<Handle>(), called_at) {
        let mut builder = state.borrow_mut();
        if makes_shapes(function) || !builder.is_noted(handle) {
            builder.note(handle, position);
        }
    }
    Ok(made)
}

/// A function of a script as a table, also in a map of values; other values as they are.
fn sample(function: &Function, context: &NativeCallContext<'_>, value: &Dynamic) -> Answer {
    if let Some(map) = value.read_lock::<Map>() {
        let sampled = map.iter().map(|(name, value)| Ok((name.clone(), sample(function, context, value)?)));
        return Ok(Dynamic::from_map(sampled.collect::<Result<Map, Box<EvalAltResult>>>()?));
    }
    let Some(of_angle) = value.read_lock::<FnPtr>() else { return Ok(value.clone()) };
    let at = |angle: f64| -> Result<f64, Box<EvalAltResult>> {
        let found: Dynamic = of_angle.call_within_context(context, (angle,))?;
        let number = found.as_float().or_else(|_| found.as_int().map(|whole| whole as f64));
        number.map_err(|kind| format!("it is no number but a value of type {kind}").into())
    };
    FacetTable::new("user's", at).map(Dynamic::from).map_err(|problem| {
        let (message, inside) = match &problem {
            FacetError::Function { angle, source } => {
                let (message, position) = error::describe(source);
                (format!("at an angle of {angle}: {message}"), position)
            }
            other => (other.to_string(), rhai::Position::NONE),
        };
        let position = if inside.is_none() { context.call_position() } else { inside };
        Box::new(EvalAltResult::ErrorRuntime(format!("{}: {message}", function.name).into(), position))
    })
}
