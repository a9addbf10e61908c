//! The kinds of message that reach each input, and what follows: functions that never fire, arcs that always fault.
//!
//! From what is sent, from the devices and from the clocks, kinds spread along the arcs until nothing new comes: the
//! least set of what can happen. What is not in it cannot.

use super::{
    Level, Note, devices, ports,
    program::{Arc, Function, Program},
    trial::{self, Trials},
};
use crate::{
    functions::{self, Rule},
    machine::Machine,
    port::{Cause, KindSet, QueueRole},
};
use protocol::{Kind, Name, Value, command::Input};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Values of an input that are stored as they were sent; of more, only the kinds matter.
const STORED_VALUES: usize = 8;
/// Trials that are made; in a larger program, functions whose trials are left may send anything.
const TRIALS: usize = 50_000;

/// What the flow shows.
#[derive(Debug, Default)]
pub(super) struct Findings {
    pub(super) notes: Vec<Note>,
    /// Inputs, as `<1>NAME`, at which a clash was found.
    pub(super) clashes: BTreeSet<String>,
}

/// An input of a function: what can arrive there.
#[derive(Clone, Debug, Default)]
struct Arriving {
    /// Numbers of the arcs that end here.
    arcs: Vec<usize>,
    /// What commands send.
    values: Vec<Value>,
    /// Kinds of what commands send that are not stored as values.
    kinds: BTreeSet<Kind>,
    /// Messages that commands send.
    sends: usize,
    /// Whether SETUP CNESS has made it another kind of input.
    set_up: bool,
    /// Whether something arrives of which nothing is known.
    unknown: bool,
}

/// A function of the program.
#[derive(Debug)]
struct Instance<'p> {
    function: &'p Function,
    inputs: Vec<Arriving>,
    /// Kinds that leave each output; none while it is not known to fire.
    outputs: Option<Vec<KindSet>>,
    trials: Option<Trials>,
}

struct Flow<'p> {
    program: &'p Program,
    machine: &'p Machine,
    instances: BTreeMap<&'p Name, Instance<'p>>,
    tried: HashMap<String, Trials>,
}

/// Looks at what flows in a program.
pub(super) fn check(program: &Program, machine: &Machine) -> Findings {
    let mut flow = Flow { program, machine, instances: BTreeMap::new(), tried: HashMap::new() };
    flow.collect();
    flow.collect_set_up();
    flow.spread();
    let mut findings = Findings::default();
    flow.clashes(&mut findings);
    flow.functions(&mut findings);
    flow.fed_once(&mut findings);
    findings
}

impl<'p> Flow<'p> {
    /// Lists the functions with what is connected and sent to them.
    fn collect(&mut self) {
        let program = self.program;
        for name in program.definitions.keys() {
            if let Some(function) = program.function(name) {
                let inputs = vec![Arriving::default(); usize::from(function.shape.inputs)];
                self.instances.insert(name, Instance { function, inputs, outputs: None, trials: None });
            }
        }
        for (number, arc) in program.arcs.iter().enumerate() {
            if let Some(input) = self.input_mut(&arc.to, arc.input) {
                input.arcs.push(number);
            }
        }
        for sent in &program.sends {
            let Some(input) = self.input_mut(&sent.to, sent.input) else { continue };
            input.sends += 1;
            match &sent.value {
                None => input.unknown = true,
                Some(value) if input.values.contains(value) => {}
                Some(value) if input.values.len() < STORED_VALUES => input.values.push(value.clone()),
                Some(value) => drop(input.kinds.insert(value.kind())),
            }
        }
    }

    /// Marks the inputs that SETUP CNESS has changed.
    fn collect_set_up(&mut self) {
        for (name, input) in &self.program.set_up {
            if let Some(input) = self.input_mut(name, *input) {
                input.set_up = true;
            }
        }
    }

    fn input_mut(&mut self, name: &'p Name, input: Input) -> Option<&mut Arriving> {
        let Input::Number(number) = input else { return None };
        let instance = self.instances.get_mut(self.program.target(name))?;
        instance.inputs.get_mut((number as usize).checked_sub(1)?)
    }

    /// Lets kinds spread until nothing new comes.
    fn spread(&mut self) {
        let followers = self.followers();
        let mut waiting: BTreeSet<&Name> = self.instances.keys().copied().collect();
        while let Some(name) = waiting.pop_first() {
            let Some(trials) = self.evaluate(name) else { continue };
            let Some(instance) = self.instances.get_mut(name) else { continue };
            if instance.outputs.as_ref() != Some(&trials.outputs) {
                waiting.extend(
                    followers.get(name).into_iter().flatten().filter(|n| **n != name || !trials.outputs.is_empty()),
                );
            }
            instance.outputs = Some(trials.outputs.clone());
            instance.trials = Some(trials);
        }
    }

    /// What a function sends for what can arrive now; none if it cannot fire.
    fn evaluate(&mut self, name: &Name) -> Option<Trials> {
        let instance = self.instances.get(name)?;
        let function = instance.function;
        let mut samples: Vec<Vec<Value>> = Vec::new();
        for (number, input) in (1..).zip(&instance.inputs) {
            let (kinds, exact) = self.arriving(function, number, input);
            let mut all: Vec<Value> = Vec::new();
            for kind in kinds.iter() {
                all.extend(if exact.contains(kind) { Vec::new() } else { trial::samples(kind) });
            }
            let spec = function.row.input(function.shape, number)?;
            all.extend(input.values.iter().filter(|value| spec.kinds.contains(value.kind())).cloned());
            samples.push(all);
        }
        let missing = |number: u16| {
            let empty = samples[usize::from(number) - 1].is_empty();
            empty && trial::is_required(function.row, function, number)
        };
        let inputs = 1..=function.shape.inputs;
        let silent = match function.row.rule {
            Rule::All => inputs.clone().any(missing),
            _ => {
                let spec =
                    |n: &u16| function.row.input(function.shape, *n).is_some_and(|s| s.role == QueueRole::Active);
                inputs.clone().filter(spec).all(missing) && inputs.clone().any(|n| spec(&n))
            }
        };
        if silent {
            return None;
        }
        // Outputs only grow: what came before stays possible.
        let before = instance.outputs.clone();
        let mut trials = if self.tried.len() < TRIALS {
            let key = format!("{} {:?} {samples:?}", function.row.name, function.size);
            self.tried.entry(key).or_insert_with(|| trial::function(function, &samples)).clone()
        } else {
            Trials { outputs: vec![KindSet::ANY; usize::from(function.shape.outputs)], always: None }
        };
        for (now, before) in trials.outputs.iter_mut().zip(before.into_iter().flatten()) {
            *now = now.or(before);
        }
        Some(trials)
    }

    /// The kinds that can arrive at an input and are accepted, and those of them that come only as known values.
    fn arriving(&self, function: &Function, number: u16, input: &Arriving) -> (KindSet, KindSet) {
        let Some(spec) = function.row.input(function.shape, number) else { return (KindSet::NONE, KindSet::NONE) };
        let mut spread = KindSet::of(&input.kinds.iter().copied().collect::<Vec<_>>());
        if input.unknown {
            spread = spec.kinds;
        }
        for arc in &input.arcs {
            spread = spread.or(self.sent(&self.program.arcs[*arc]));
        }
        let values: Vec<Kind> = input.values.iter().map(Value::kind).collect();
        let exact: Vec<Kind> = values.iter().copied().filter(|kind| !spread.contains(*kind)).collect();
        let all: Vec<Kind> = spread.or(KindSet::of(&values)).iter().filter(|kind| spec.kinds.contains(*kind)).collect();
        (KindSet::of(&all), KindSet::of(&exact))
    }

    /// The kinds that leave the beginning of an arc, as far as is known now.
    fn sent(&self, arc: &Arc) -> KindSet {
        let name = self.program.target(&arc.source);
        if let Some(instance) = self.instances.get(name) {
            let output = usize::from(arc.output).wrapping_sub(1);
            return instance.outputs.as_ref().and_then(|o| o.get(output)).copied().unwrap_or(KindSet::NONE);
        }
        match ports::system(name, self.machine) {
            Some(row) if usize::from(arc.output) > row.outputs.len() => KindSet::NONE,
            Some(_) => devices::kinds(name.as_str(), arc.output).unwrap_or(KindSet::ANY),
            None => KindSet::ANY,
        }
    }

    /// Arcs along which every message is refused.
    fn clashes(&self, findings: &mut Findings) {
        for arc in &self.program.arcs {
            let sent = self.sent(arc);
            let Some(accepted) = ports::accepted(arc, self.program, self.machine) else { continue };
            let fits = sent.iter().any(|kind| accepted.contains(kind));
            if sent == KindSet::NONE || accepted == KindSet::NONE || fits {
                continue;
            }
            let text =
                format!("{}<{}> sends {sent}, but {}{} takes {accepted}", arc.source, arc.output, arc.input, arc.to);
            findings.clashes.insert(format!("{}{}", arc.input, arc.to));
            findings.notes.push(Note { location: arc.location, level: Level::Error, text });
        }
    }

    /// Functions that never fire, and functions that always fault.
    fn functions(&self, findings: &mut Findings) {
        for (name, instance) in &self.instances {
            let Some(definition) = self.program.definitions.get(*name) else { continue };
            let mut note = |level, text| findings.notes.push(Note { location: definition.location, level, text });
            match &instance.trials {
                None => {
                    if let Some(text) = self.why_silent(name, instance) {
                        note(Level::Warning, text);
                    }
                }
                Some(trials) => {
                    if let Some(fault) = trials.always.filter(|fault| is_certain(fault.cause, instance)) {
                        let text = fault.text(name);
                        let text = text.split_once(" *** ").map_or(text.as_str(), |(_, what)| what);
                        note(Level::Error, format!("whatever arrives: {text}"));
                    }
                }
            }
        }
    }

    /// Functions that stop when the messages of SEND are used up, although another input is fed again and again.
    fn fed_once(&self, findings: &mut Findings) {
        let lasting = self.lasting();
        for (name, instance) in &self.instances {
            let Some(definition) = self.program.definitions.get(*name) else { continue };
            if instance.trials.is_none() || instance.function.row.rule != Rule::All {
                continue;
            }
            let active = || active(instance);
            let Some((fed, _)) = active().find(|(_, input)| self.lasts(input, &lasting)) else { continue };
            let once = |(_, input): &(u16, &Arriving)| input.arcs.is_empty() && input.sends > 0 && !input.unknown;
            let Some((number, input)) = active().find(once) else { continue };
            let row = instance.function.row;
            let keeping = functions::find(&format!("{}C", row.name)).filter(|other| {
                let spec = row.shape(None).ok().and_then(|_| other.inputs.get(usize::from(number) - 1));
                spec.is_some_and(|spec| spec.role == QueueRole::Constant)
            });
            let hint = match keeping {
                Some(other) => format!("F:{} keeps it", other.name),
                None => format!("SETUP CNESS TRUE <{number}>{name} keeps it"),
            };
            let times = if input.sends == 1 { "once".into() } else { format!("{} times", input.sends) };
            let text = format!(
                "{name} (F:{}) fires {times} only: <{fed}> is fed again and again, but <{number}> gets no more than what \
                 SEND gives it; {hint}",
                row.name
            );
            findings.notes.push(Note { location: definition.location, level: Level::Warning, text });
        }
    }

    /// The functions that fire again and again: clocks, and those that such functions and devices feed.
    fn lasting(&self) -> BTreeSet<&'p Name> {
        let followers = self.followers();
        let mut lasting: BTreeSet<&Name> = BTreeSet::new();
        let mut waiting: BTreeSet<&Name> = self.instances.keys().copied().collect();
        while let Some(name) = waiting.pop_first() {
            let Some(instance) = self.instances.get(name).filter(|_| !lasting.contains(name)) else { continue };
            let row = instance.function.row;
            let mut inputs = active(instance).map(|(_, input)| self.lasts(input, &lasting)).peekable();
            let fires = match row.rule {
                Rule::All => inputs.peek().is_some() && inputs.all(|lasts| lasts),
                Rule::Any => inputs.any(|lasts| lasts),
            };
            if fires || row.clock.is_some() {
                lasting.insert(name);
                waiting.extend(followers.get(name).into_iter().flatten());
            }
        }
        lasting
    }

    /// The ends of the arcs that leave each name.
    fn followers(&self) -> BTreeMap<&'p Name, BTreeSet<&'p Name>> {
        let mut followers: BTreeMap<&Name, BTreeSet<&Name>> = BTreeMap::new();
        for arc in &self.program.arcs {
            followers.entry(self.program.target(&arc.source)).or_default().insert(self.program.target(&arc.to));
        }
        followers
    }

    /// Whether an input is fed again and again.
    fn lasts(&self, input: &Arriving, lasting: &BTreeSet<&'p Name>) -> bool {
        input.arcs.iter().any(|arc| {
            let source = self.program.target(&self.program.arcs[*arc].source);
            lasting.contains(source)
                || (!self.instances.contains_key(source) && ports::system(source, self.machine).is_some())
        })
    }

    /// The reason why a function never fires; none if that is reported at another location.
    fn why_silent(&self, name: &Name, instance: &Instance<'_>) -> Option<String> {
        let function = instance.function;
        let (mut unfed, mut waits) = (Vec::new(), Vec::new());
        for (number, input) in (1..).zip(&instance.inputs) {
            let spec = function.row.input(function.shape, number)?;
            let (arriving, _) = self.arriving(function, number, input);
            if arriving != KindSet::NONE || !trial::is_required(function.row, function, number) {
                continue;
            }
            let silent = |arc: &&usize| self.sent(&self.program.arcs[**arc]) == KindSet::NONE;
            if input.arcs.is_empty() && input.values.is_empty() {
                unfed.push(format!("<{number}> ({})", spec.summary));
            } else if input.arcs.iter().all(|arc| silent(&arc)) && input.values.is_empty() {
                let sources = input.arcs.iter().map(|arc| self.program.arcs[*arc].source.to_string());
                waits.push(format!("<{number}> waits for {}", sources.collect::<Vec<_>>().join(", ")));
            }
        }
        let name = format!("{name} (F:{})", function.row.name);
        if !unfed.is_empty() {
            let verb = if unfed.len() == 1 { "input" } else { "inputs" };
            return Some(format!("{name} never fires: nothing feeds its {verb} {}", unfed.join(", ")));
        }
        let why = if waits.is_empty() { return None } else { waits.join(", ") };
        Some(format!("{name} never fires: {why}, which never sends"))
    }
}

/// The inputs of a function that take a message for each firing, with their numbers.
fn active<'i>(instance: &'i Instance<'_>) -> impl Iterator<Item = (u16, &'i Arriving)> {
    let function = instance.function;
    let is_active = move |(number, input): &(u16, &Arriving)| {
        let spec = function.row.input(function.shape, *number);
        !input.set_up && spec.is_some_and(|spec| spec.role == QueueRole::Active)
    };
    (1..).zip(&instance.inputs).filter(is_active)
}

/// Whether a fault of all trials holds for all messages: a range, only if the value is known.
fn is_certain(cause: Cause, instance: &Instance<'_>) -> bool {
    match cause {
        Cause::Kind { .. } => true,
        Cause::Range { input } => {
            let arriving = instance.inputs.get(usize::from(input).wrapping_sub(1));
            arriving.is_some_and(|a| a.arcs.is_empty() && a.kinds.is_empty() && !a.unknown && !a.values.is_empty())
        }
        _ => false,
    }
}
