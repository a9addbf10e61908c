//! Operator commands that look into the machine: traces, breaks, single firings, counters of functions, graphs.

use super::{
    Inspection, Language, OperatorCommand, OperatorCommandError, OperatorCommandRow, Subject,
    fault::REFUSED,
    graph::{graph, title},
    word_reader::WordReader,
};
use crate::{
    functions::printing::print,
    machine::Machine,
    network::{Activity, Delivery, Trace, Traced},
    port::ObjectId,
};
use files::Sandbox;
use protocol::{Kind, Value};
use std::collections::BTreeSet;
use std::io::Write;

/// Functions that `top` lists by default.
const TOP: usize = 10;
/// Characters of a message that a trace shows.
const SHOWN: usize = 60;

/// The rows of these commands.
pub(super) const INSPECTION_ROWS: &[OperatorCommandRow] = &[
    OperatorCommandRow {
        word: "trace",
        arguments: "[NAME|all [on|off]]",
        summary: "watch messages to and from a function or node; alone: what has passed since",
        read: trace,
    },
    OperatorCommandRow {
        word: "break",
        arguments: "[NAME [on|off]]",
        summary: "stop the network before a function fires; alone: list the breaks",
        read: break_at,
    },
    OperatorCommandRow {
        word: "step",
        arguments: "",
        summary: "let one function fire, then stop the network",
        read: |_| Ok(OperatorCommand::Inspect(Inspection::Step)),
    },
    OperatorCommandRow {
        word: "continue",
        arguments: "",
        summary: "let a stopped network go on",
        read: |_| Ok(OperatorCommand::Inspect(Inspection::Continue)),
    },
    OperatorCommandRow {
        word: "count",
        arguments: "[on|off]",
        summary: "count what each function does, from 0; see counters NAME, top",
        read: |words| Ok(OperatorCommand::Inspect(Inspection::Count(words.on_or_off()?))),
    },
    OperatorCommandRow {
        word: "top",
        arguments: "[N]",
        summary: "the functions that fired most since 'count on'",
        read: |words| {
            Ok(OperatorCommand::Inspect(Inspection::Top(words.optional("a number of functions")?.unwrap_or(TOP))))
        },
    },
    OperatorCommandRow {
        word: "graph",
        arguments: "network|structure [dot|json] [FILE]",
        summary: "functions and arcs, or nodes, as a graph",
        read: read_graph,
    },
];

fn trace(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let Some(name) = words.next() else { return Ok(OperatorCommand::Inspect(Inspection::Trace)) };
    let name = Some(name).filter(|name| !name.eq_ignore_ascii_case("all")).map(str::to_ascii_uppercase);
    Ok(OperatorCommand::Inspect(Inspection::TraceOf(name, words.on_or_off()?)))
}

fn break_at(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let Some(name) = words.next().map(str::to_ascii_uppercase) else {
        return Ok(OperatorCommand::Inspect(Inspection::Breaks));
    };
    Ok(OperatorCommand::Inspect(Inspection::Break(name, words.on_or_off()?)))
}

fn read_graph(words: &mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError> {
    let subject = match words.required("'network' or 'structure'")? {
        "network" => Subject::Network,
        "structure" => Subject::Structure,
        other => return Err(OperatorCommandError::Bad { found: other.into(), expected: "'network' or 'structure'" }),
    };
    let expected = "'dot', 'json' or the name of a file, with a point in it";
    let rest = std::mem::take(&mut words.rest);
    let (language, file) = match rest.split_once(char::is_whitespace).unwrap_or((rest, "")) {
        ("dot", file) => (Language::Dot, file),
        ("json", file) => (Language::Json, file),
        _ if rest.ends_with(".json") => (Language::Json, rest),
        // A word that is nearly a language must not become a file.
        _ if !rest.is_empty() && !rest.contains(['.', '/']) => {
            return Err(OperatorCommandError::Bad { found: rest.into(), expected });
        }
        _ => (Language::Dot, rest),
    };
    let file = Some(file.trim()).filter(|file| !file.is_empty()).map(str::to_owned);
    Ok(OperatorCommand::Inspect(Inspection::Graph { subject, language, file }))
}

/// Carries out one of these commands.
///
/// # Errors
/// A sentence for the person.
pub(super) fn inspect(what: &Inspection, machine: &mut Machine, files: Option<&Sandbox>) -> Result<String, String> {
    match what {
        Inspection::Trace => Ok(take_trace(machine)),
        Inspection::TraceOf(name, on) => trace_of(name.as_deref(), *on, machine),
        Inspection::Breaks => {
            let memory = machine.memory();
            let names: Vec<String> = memory.network.breaks().map(|id| title(memory, id)).collect();
            Ok(format!(
                "breaks: {}; {}",
                if names.is_empty() { "none".into() } else { names.join(" ") },
                break_state(machine)
            ))
        }
        Inspection::Break(name, on) => {
            let id = function(name, machine)?;
            machine.instruments().set_break(id, *on);
            Ok(break_state(machine))
        }
        Inspection::Step => Ok(match machine.fire_one() {
            Some(id) => format!("{} fired; {}", title(machine.memory(), id), break_state(machine)),
            None => "nothing is ready to fire; the network stands still until 'continue'".into(),
        }),
        Inspection::Continue => {
            machine.resume();
            Ok(break_state(machine))
        }
        Inspection::Count(on) => {
            machine.instruments().count_activity(*on);
            Ok(String::new())
        }
        Inspection::Activity(name) => {
            let id = function(name, machine)?;
            machine.memory().network.activity(id).map(|a| describe(&a)).ok_or_else(counters_off)
        }
        Inspection::Top(most) => top(*most, machine),
        Inspection::Graph { subject, language, file } => {
            let text = graph(machine, *subject, *language);
            match file {
                None => Ok(text),
                Some(file) => {
                    let files = files.ok_or(REFUSED)?;
                    let destination = files.destination(file).map_err(|error| error.to_string())?;
                    destination.write(|file| file.write_all(text.as_bytes())).map_err(|error| error.to_string())?;
                    Ok(file.clone())
                }
            }
        }
    }
}

fn counters_off() -> String {
    "nothing is counted; 'count on' begins".into()
}

/// Whether the network runs or stands, and before which function.
fn break_state(machine: &Machine) -> String {
    let memory = machine.memory();
    match (memory.network.is_held(), memory.network.next()) {
        (false, _) => "the network runs".into(),
        (true, Some(next)) => format!("the network stands before {}", title(memory, next)),
        (true, None) => "the network stands, nothing is ready".into(),
    }
}

fn object(name: &str, machine: &Machine) -> Result<ObjectId, String> {
    let memory = machine.memory();
    let known = memory.objects.find(name).map(|id| memory.structures.follow(id));
    known.ok_or_else(|| format!("there is no {name}"))
}

fn function(name: &str, machine: &Machine) -> Result<ObjectId, String> {
    let id = object(name, machine)?;
    machine.memory().network.function(id).map(|_| id).ok_or_else(|| format!("{name} is no function"))
}

fn trace_of(name: Option<&str>, on: bool, machine: &mut Machine) -> Result<String, String> {
    let id = name.map(|name| object(name, machine)).transpose()?;
    let traced = match (id, on, machine.memory().network.traced().clone()) {
        (None, true, _) => Traced::Everything,
        (None, false, _) => Traced::Nothing,
        (Some(_), true, Traced::Everything) => Traced::Everything,
        (Some(_), false, Traced::Everything) => return Err("all is traced; 'trace all off' ends that".into()),
        (Some(id), true, Traced::Objects(mut ids)) => {
            ids.insert(id);
            Traced::Objects(ids)
        }
        (Some(id), true, Traced::Nothing) => Traced::Objects(BTreeSet::from([id])),
        (Some(id), false, Traced::Objects(mut ids)) => {
            ids.remove(&id);
            if ids.is_empty() { Traced::Nothing } else { Traced::Objects(ids) }
        }
        (Some(_), false, Traced::Nothing) => Traced::Nothing,
    };
    machine.instruments().trace(traced);
    Ok(String::new())
}

fn take_trace(machine: &mut Machine) -> String {
    if *machine.memory().network.traced() == Traced::Nothing {
        let (lines, cut) = machine.instruments().take_trace();
        if lines.is_empty() {
            return "nothing is traced; 'trace NAME' or 'trace all' begins".into();
        }
        return trace_text(machine, &lines, cut);
    }
    let (lines, cut) = machine.instruments().take_trace();
    trace_text(machine, &lines, cut)
}

fn trace_text(machine: &Machine, lines: &[Trace], cut: u64) -> String {
    let mut text: Vec<String> = Vec::new();
    if cut > 0 {
        text.push(format!("{cut} messages before these are not kept"));
    }
    text.extend(lines.iter().map(|line| trace_line(machine, line)));
    if text.is_empty() { "no message has passed".into() } else { text.join("\n") }
}

/// `A<1> to <2>B: 0.5, 3 waiting`.
fn trace_line(machine: &Machine, line: &Trace) -> String {
    let memory = machine.memory();
    let from =
        line.from.map_or_else(|| "SEND".into(), |from| format!("{}<{}>", title(memory, from.object), from.output));
    let value = brief(&line.value);
    let outcome = match line.outcome {
        Delivery::Arrived { waiting: 1 } => String::new(),
        Delivery::Arrived { waiting } => format!(", {waiting} waiting"),
        Delivery::Lost => ", lost: the queue is full".into(),
        Delivery::Refused => ", refused".into(),
        Delivery::Left => String::new(),
    };
    format!("{from} to {}{}: {value}{outcome}", line.to.input, title(memory, line.to.object))
}

/// A message as SEND has it, or as F:PRINT prints it if it has many numbers; the beginning of a long one.
pub fn brief(value: &Value) -> String {
    let text = match value.kind() {
        Kind::Boolean | Kind::Integer | Kind::Real | Kind::String => value.to_string(),
        _ => String::from_utf8_lossy(&print(value, false)).into_owned(),
    };
    let short: String = text.chars().take(SHOWN).collect();
    if short.len() < text.len() { short + "..." } else { short }
}

fn describe(a: &Activity) -> String {
    format!(
        "firings={} faults={} received={} sent={} lost={} refused={} longest_queue={}",
        a.firings, a.faults, a.received, a.sent, a.lost, a.refused, a.longest_queue
    )
}

fn top(most: usize, machine: &Machine) -> Result<String, String> {
    let memory = machine.memory();
    let mut all: Vec<(Activity, ObjectId)> = Vec::new();
    for view in memory.network.snapshot() {
        all.push((view.activity().ok_or_else(counters_off)?, view.object()));
    }
    all.retain(|(activity, _)| *activity != Activity::default());
    all.sort_by_key(|(activity, id)| (std::cmp::Reverse(activity.firings), *id));
    let lines = all.iter().take(most).map(|(activity, id)| format!("{}: {}", title(memory, *id), describe(activity)));
    let text = lines.collect::<Vec<_>>().join("\n");
    Ok(if text.is_empty() { "no function has done anything".into() } else { text })
}
