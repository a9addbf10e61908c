//! The functions of the network as a window shows them.

use crate::{
    machine::Machine,
    network::{Activity, FunctionView, InputView},
    operator::{brief, title},
};
use std::collections::BTreeSet;

/// Functions that are shown; of more, the first.
const MAX_FUNCTIONS: usize = 400;

/// A function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionShown {
    /// Its name.
    pub name: String,
    /// What it does, such as `ADDC`.
    pub function: &'static str,
    /// Whether it is going to fire.
    pub is_ready: bool,
    /// Its inputs, from input 1.
    pub inputs: Vec<InputShown>,
    /// Where its messages go.
    pub arcs: Vec<ArcShown>,
    /// What it did since it was counted.
    pub activity: Activity,
}

/// An input.
#[derive(Clone, Debug, PartialEq)]
pub struct InputShown {
    /// Whether it is a queue; else it is a constant.
    pub is_active: bool,
    /// How many messages wait.
    pub waiting: usize,
    /// The message that leaves next, or the constant; empty for none.
    pub first: String,
}

/// An arc from an output.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcShown {
    /// The output, from 1.
    pub output: u16,
    /// The input with its name, such as `<2>B`.
    pub to: String,
}

/// The functions whose names hold a text: those of the user, and those of the system that have arcs.
pub(super) fn functions(machine: &Machine, pattern: &str) -> Vec<FunctionShown> {
    let memory = machine.memory();
    let reached: BTreeSet<_> = memory.network.snapshot().flat_map(|f| f.arcs().map(|(_, to)| to.object)).collect();
    let is_used = |view: &FunctionView<'_>| {
        !memory.objects.is_system(view.object()) || view.arcs().next().is_some() || reached.contains(&view.object())
    };
    let shown = memory.network.snapshot().filter(is_used).filter_map(|view| {
        let name = title(memory, view.object());
        name.contains(pattern).then(|| FunctionShown {
            name,
            function: view.row().name,
            is_ready: view.is_ready(),
            inputs: view.inputs().map(input).collect(),
            arcs: view
                .arcs()
                .map(|(output, to)| ArcShown { output, to: format!("{}{}", to.input, title(memory, to.object)) })
                .collect(),
            activity: view.activity().unwrap_or_default(),
        })
    });
    shown.take(MAX_FUNCTIONS).collect()
}

fn input(view: InputView<'_>) -> InputShown {
    let first = view.first().map(brief).unwrap_or_default();
    InputShown { is_active: view.is_active(), waiting: if view.is_active() { view.len() } else { 0 }, first }
}
