//! The conformance suite on our own machine, in a seeded selection of the ways in which commands travel.
//!
//! With `PERIS_LONG=1` every way is walked.

use protocol::command::{
    Command, CommandReader, Object,
    binary::{self, Opcode},
    reference,
    token::{Lexer, TokenKind},
    words::Word,
};
use ps340::functions;
use std::{cell::RefCell, collections::BTreeSet, time::Duration};
use tests::{
    Machine,
    conformance::{
        self, Case, Operator, Report, Target, Way, case::Step, line::Place, person, person::OrderFault,
        report::failure_text, walk,
    },
};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

/// The operator of a machine on standard streams.
struct Here<'m>(&'m RefCell<Machine>);

impl Operator for Here<'_> {
    fn give(&mut self, order: &str) -> Result<String, OrderFault> {
        person::understood(&self.0.borrow_mut().reply(order))
    }

    fn confirm(&mut self, reply: &str, glob: &str) -> bool {
        conformance::compare::glob_matches(glob, reply)
    }

    fn drives_time(&self) -> bool {
        true
    }
}

fn written() -> Vec<Case> {
    conformance::read_folder(&conformance::cases_folder()).unwrap_or_else(|e| panic!("{e}"))
}

fn all() -> Vec<Case> {
    let mut cases = written();
    cases.extend(walk::cases());
    cases
}

/// Whether everything is to be walked.
fn is_long() -> bool {
    std::env::var_os("PERIS_LONG").is_some()
}

/// A machine whose time stands while nobody waits.
fn machine() -> Machine {
    Machine::start(PS340, &["--clock", "virtual"])
}

fn play<'c>(machine: Machine, way: Way, cut: Option<u64>, cases: impl IntoIterator<Item = &'c Case>) -> Report {
    play_at(format!("tcp:{}", machine.line).parse().unwrap(), machine, way, cut, cases)
}

fn play_at<'c>(
    place: Place,
    machine: Machine,
    way: Way,
    cut: Option<u64>,
    cases: impl IntoIterator<Item = &'c Case>,
) -> Report {
    let machine = RefCell::new(machine);
    let target = Target { place, way, cut, patience: Duration::from_secs(5), any_fault: false };
    conformance::run(&target, Some(&mut Here(&machine)), cases, |_| {}).unwrap()
}

fn assert_passed(report: &Report, what: &str) {
    let failed: Vec<String> = report.failures().map(|(case, failure)| failure_text(case, failure)).collect();
    assert!(failed.is_empty(), "{what}: {} cases failed\n{}", failed.len(), failed.concat());
    let tally = report.tally();
    assert!(tally.skipped == 0 && tally.passed > 0, "{what}: {} passed, {} skipped", tally.passed, tally.skipped);
}

#[test]
fn every_case_passes_as_text() {
    let report = play(machine(), Way::default(), None, &all());
    assert_passed(&report, "text");
    assert!(report.tally().passed > 700);
}

#[test]
fn cases_pass_in_every_way_and_cut_at_random_places() {
    let long = is_long();
    let cases = all();
    let ways: Vec<(Way, Option<u64>)> =
        Way::all().into_iter().flat_map(|way| [(way, None), (way, Some(340))]).collect();
    let machines = ways.iter().enumerate().map(|(seed, (way, cut))| {
        // Each way has its own share of the cases; together they have all of them.
        let share = cases.iter().enumerate().filter(|(n, _)| long || n % ways.len() == seed).map(|(_, case)| case);
        (play(machine(), *way, *cut, share), *way, *cut)
    });
    for (report, way, cut) in machines {
        assert_passed(&report, &format!("{way}, cut with {cut:?}"));
    }
}

#[test]
fn a_unix_socket_carries_the_cases_too() {
    let folder = tempfile::tempdir().unwrap();
    let address = format!("unix:{}", folder.path().join("line").display());
    let machine = Machine::start(PS340, &["--clock", "virtual", "--listen", &address]);
    let cases = all();
    let some = cases.iter().step_by(if is_long() { 1 } else { 7 });
    let report = play_at(address.parse().unwrap(), machine, Way::default(), Some(7), some);
    assert_passed(&report, "Unix socket");
}

#[test]
fn a_pseudo_terminal_carries_the_cases_too() {
    let machine = Machine::start(PS340, &["--clock", "virtual", "--listen", "pty:"]);
    let terminal = machine.more_lines.first().expect("the path is printed").parse().unwrap();
    let cases = all();
    let some = cases.iter().skip(3).step_by(if is_long() { 1 } else { 9 });
    let report = play_at(terminal, machine, Way::default(), Some(11), some);
    assert_passed(&report, "pseudo-terminal");
}

#[test]
fn a_wrong_expectation_fails_at_its_line() {
    let text = "section B.4\ncase a M x\n> SEND 'B' TO <1>HOST_MESSAGE;\n< A\ncase b M y\n> SEND 'B' TO <1>HOST_MESSAGE;\nquiet\n\
                case c M z\n> DISPLAY 3;\nquiet\ncase d M z\nstrokes 1\n";
    let cases = conformance::parse("f", text).unwrap();
    let report = play(machine(), Way::default(), None, &cases);
    let failures: Vec<(&str, usize)> = report.failures().map(|(case, f)| (case.id.as_str(), f.line)).collect();
    assert_eq!(failures, [("a", 4), ("b", 7), ("c", 10), ("d", 12)]);
}

#[test]
fn every_fact_of_the_client_has_a_case() {
    let proved: BTreeSet<String> = written().into_iter().flat_map(|case| case.facts).collect();
    let facts: BTreeSet<&str> =
        include_str!("../conformance/facts.txt").lines().filter(|l| !l.is_empty() && !l.starts_with('#')).collect();
    let missing: Vec<&&str> = facts.iter().filter(|fact| !proved.contains(**fact)).collect();
    assert!(missing.is_empty(), "no case proves: {missing:?}");
    let unknown: Vec<&String> = proved.iter().filter(|fact| !facts.contains(fact.as_str())).collect();
    assert!(unknown.is_empty(), "facts.txt has no {unknown:?}");
}

/// The commands of all cases, as the parser understands them; those that are meant to be wrong are left out.
fn commands() -> Vec<Command> {
    let mut all = Vec::new();
    for case in written() {
        let mut reader = CommandReader::default();
        reader.push(case.text().as_bytes());
        all.extend(reader.by_ref().filter_map(|read| Some(read.ok()?.command)));
    }
    all
}

#[test]
fn every_record_of_the_commands_has_a_case() {
    let mut seen = BTreeSet::new();
    for command in commands() {
        let mut first = |record: &[u8]| seen.extend(record.first().copied());
        binary::records(&command, &mut Vec::new(), &mut first).unwrap();
    }
    let missing: Vec<&str> = Opcode::ALL.iter().filter(|o| !seen.contains(&o.code())).map(|o| o.word()).collect();
    assert!(missing.is_empty(), "no case has {missing:?}");
}

#[test]
fn every_command_of_the_reference_has_a_case() {
    let seen: BTreeSet<&str> = commands().iter().map(reference::name_of).collect();
    let missing: Vec<&str> = reference::rows().map(|row| row.name).filter(|name| !seen.contains(name)).collect();
    assert!(missing.is_empty(), "no case has {missing:?}");
}

/// The column `Case` of a row of COMPATIBILITY.md: `names` of cases, or none.
fn named_cases(row: &str) -> impl Iterator<Item = &str> {
    let column = row.split('|').nth(5).unwrap_or_default();
    column.split('`').skip(1).step_by(2)
}

#[test]
fn the_cases_that_decisions_name_exist() {
    let decisions = include_str!("../../ps340/COMPATIBILITY.md");
    let ids: BTreeSet<String> = all().into_iter().map(|case| case.id).collect();
    let named: BTreeSet<&str> = decisions.lines().filter(|l| l.starts_with("| ")).flat_map(named_cases).collect();
    let unknown: Vec<&&str> = named.iter().filter(|id| !ids.contains(**id)).collect();
    assert!(unknown.is_empty(), "no such cases: {unknown:?}");
    assert!(named.len() > 100, "{} cases are named", named.len());
}

#[test]
fn every_word_of_the_commands_has_a_case() {
    let mut seen = BTreeSet::new();
    for case in written() {
        let text = case.text();
        let mut lexer = Lexer::new(text.as_bytes(), 0);
        loop {
            let token = lexer.token();
            match token.kind {
                TokenKind::End => break,
                TokenKind::Name => {
                    let name = &text.as_bytes()[token.span()];
                    seen.extend(Word::ALL.iter().filter(|word| word.accepts(name)).map(|word| word.form()));
                }
                _ => {}
            }
        }
    }
    let missing: Vec<&str> = Word::ALL.iter().map(|word| word.form()).filter(|form| !seen.contains(form)).collect();
    assert!(missing.is_empty(), "no case has the words {missing:?}");
}

#[test]
fn every_function_and_every_initial_instance_has_a_case() {
    let (mut functions, mut names) = (BTreeSet::new(), BTreeSet::new());
    for case in all() {
        let mut reader = CommandReader::default();
        reader.push(case.text().as_bytes());
        for command in reader.by_ref().filter_map(|read| Some(read.ok()?.command)) {
            match command {
                Command::Define { object: Object::Function { function, .. }, .. } => {
                    functions.insert(function.to_string());
                }
                Command::Connect(arc) => names.extend([arc.source.to_string(), arc.destination.name.to_string()]),
                Command::Send { destination, .. } => {
                    names.insert(destination.name.to_string());
                }
                _ => {}
            }
        }
        names.extend(case.steps.iter().filter_map(|(_, step)| match step {
            Step::Watch { name, .. } => Some(name.clone()),
            _ => None,
        }));
    }
    let missing: Vec<&str> = functions::all().map(|row| row.name).filter(|name| !functions.contains(*name)).collect();
    assert!(missing.is_empty(), "no case has the functions {missing:?}");
    // One of several equal instances is enough.
    let bare = |name: &str| name.trim_end_matches(|c: char| c.is_ascii_digit()).to_string();
    let named: BTreeSet<String> = names.iter().map(|name| bare(name)).collect();
    let initial: BTreeSet<String> = functions::devices::initial().map(|initial| bare(&initial.name)).collect();
    let missing: Vec<&String> = initial.difference(&named).collect();
    assert!(missing.is_empty(), "no case has the instances {missing:?}");
}
