//! The conformance suite on our own machine, in a seeded selection of the transports of commands.
//!
//! With `PERIS_LONG=1` every transport is used.

use protocol::command::{
    Command, CommandReader, Object,
    binary::{self, Opcode},
    reference,
    token::{Lexer, TokenKind},
    words::Word,
};
use ps340::functions;
use std::{cell::RefCell, collections::BTreeSet, fs, path::Path, time::Duration};
use tests::{
    Machine,
    conformance::{
        self, Case, Operator, Report, Target, Transport,
        case::Step,
        line::Endpoint,
        mutation::{self, Change, Mutant, Mutations},
        person,
        person::OperatorFault,
        report::failure_text,
        walk,
    },
};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

/// The operator of a machine on standard streams.
struct Here<'m>(&'m RefCell<Machine>);

impl Operator for Here<'_> {
    fn give(&mut self, order: &str) -> Result<String, OperatorFault> {
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

/// Every case that there is.
fn known() -> Vec<Case> {
    let mut cases = written();
    cases.extend(walk::cases());
    cases
}

/// The cases to be played: those that take seconds only when everything is to be walked.
fn all() -> Vec<Case> {
    let mut cases = known();
    cases.retain(|case| is_long() || !case.is_long);
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

fn play<'c>(machine: Machine, way: Transport, cut: Option<u64>, cases: impl IntoIterator<Item = &'c Case>) -> Report {
    play_at(format!("tcp:{}", machine.line).parse().unwrap(), machine, way, cut, cases)
}

fn play_at<'c>(
    place: Endpoint,
    machine: Machine,
    way: Transport,
    cut: Option<u64>,
    cases: impl IntoIterator<Item = &'c Case>,
) -> Report {
    let machine = RefCell::new(machine);
    conformance::run(&target(place, way, cut), Some(&mut Here(&machine)), cases, |_| {}).unwrap()
}

fn target(place: Endpoint, way: Transport, cut: Option<u64>) -> Target {
    Target { endpoint: place, transport: way, cut, timeout: Duration::from_secs(5), any_fault: false, reboots: false }
}

fn assert_passed(report: &Report, what: &str) {
    let failed: Vec<String> = report.failures().map(|(case, failure)| failure_text(case, failure)).collect();
    assert!(failed.is_empty(), "{what}: {} cases failed\n{}", failed.len(), failed.concat());
    let tally = report.tally();
    assert!(tally.skipped == 0 && tally.passed > 0, "{what}: {} passed, {} skipped", tally.passed, tally.skipped);
}

#[test]
fn every_case_passes_as_text() {
    let report = play(machine(), Transport::default(), None, &all());
    assert_passed(&report, "text");
    assert!(report.tally().passed > 700);
}

#[test]
fn cases_pass_in_every_way_and_cut_at_random_places() {
    let long = is_long();
    let cases = all();
    let ways: Vec<(Transport, Option<u64>)> =
        Transport::all().into_iter().flat_map(|way| [(way, None), (way, Some(340))]).collect();
    let machines = ways.iter().enumerate().map(|(seed, (way, cut))| {
        // Each transport has its own share of the cases; together they have all of them.
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
    let report = play_at(address.parse().unwrap(), machine, Transport::default(), Some(7), some);
    assert_passed(&report, "Unix socket");
}

#[test]
fn a_pseudo_terminal_carries_the_cases_too() {
    let machine = Machine::start(PS340, &["--clock", "virtual", "--listen", "pty:"]);
    let terminal = machine.more_lines.first().expect("the path is printed").parse().unwrap();
    let cases = all();
    let some = cases.iter().skip(3).step_by(if is_long() { 1 } else { 9 });
    let report = play_at(terminal, machine, Transport::default(), Some(11), some);
    assert_passed(&report, "pseudo-terminal");
}

#[test]
fn strokes_come_over_the_host_line_where_nobody_is_at_the_machine() {
    let machine = Machine::start(PS340, &[]);
    let place = format!("tcp:{}", machine.line).parse().unwrap();
    let cases = all();
    let draws = |case: &&Case| case.steps.iter().any(|(_, step)| matches!(step, Step::Strokes { .. }));
    let some = cases.iter().filter(draws).step_by(if is_long() { 1 } else { 11 });
    let report = conformance::run(&target(place, Transport::default(), None), None, some, |_| {}).unwrap();
    let failed: Vec<String> = report.failures().map(|(case, failure)| failure_text(case, failure)).collect();
    assert!(failed.is_empty(), "{}", failed.concat());
    // What needs a person, frames one after the other, or more strokes than the line brings.
    let tally = report.tally();
    assert!(tally.passed > 5 * tally.skipped, "{}", report.text());
}

#[test]
fn a_machine_that_answers_nothing_ends_the_run_at_once() {
    let silent = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let place = format!("tcp:{}", silent.local_addr().unwrap()).parse().unwrap();
    let target = Target { timeout: Duration::from_millis(300), ..target(place, Transport::default(), None) };
    let error = conformance::run(&target, None, &all(), |_| {}).unwrap_err();
    assert_eq!(error.to_string(), "expected an answer of the machine, found nothing for 300ms, after: nothing");
}

#[test]
fn a_wrong_expectation_fails_at_its_line() {
    let text = "section B.4\ncase a M x\n> SEND 'B' TO <1>HOST_MESSAGE;\n< A\ncase b M y\n> SEND 'B' TO <1>HOST_MESSAGE;\nquiet\n< B\n\
                case c M z\n> DISPLAY 3;\nquiet\n<! 1\ncase d M z\nstrokes 1\n";
    let cases = conformance::parse("f", text).unwrap();
    let report = play(machine(), Transport::default(), None, &cases);
    let failures: Vec<(&str, usize)> = report.failures().map(|(case, f)| (case.id.as_str(), f.line)).collect();
    assert_eq!(failures, [("a", 4), ("b", 7), ("c", 11), ("d", 14)]);
}

/// Plays mutants of cases on two machines side by side, each with half of the cases.
fn mutate(cases: &[Case], choose: fn(&Case) -> Vec<Mutant>) -> Mutations {
    let half = |of: usize| {
        let machine = machine();
        let place = format!("tcp:{}", machine.line).parse().unwrap();
        let target = Target { reboots: true, ..target(place, Transport::default(), None) };
        let machine = RefCell::new(machine);
        let mut here = Here(&machine);
        let share = cases.iter().skip(of).step_by(2);
        mutation::run(&target, &mut Some(&mut here), share, choose, |_, _| {}).unwrap()
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(|| half(1));
        let mut found = half(0);
        found.join(other.join().unwrap());
        found
    })
}

#[test]
fn no_case_passes_without_what_it_is_named_after() {
    let cases = all();
    let found = mutate(&cases, mutation::subject_mutants);
    assert!(found.unsound.is_empty(), "failed without a change: {:?}", found.unsound);
    let insensitive: Vec<String> =
        found.insensitive().map(|(case, subject)| format!("{} to the loss of {subject}", case.id)).collect();
    assert!(insensitive.is_empty(), "insensitive: {}", insensitive.join(", "));
    assert!(found.subjects.all > 600, "{}", found.subjects.all);
}

#[test]
fn the_table_of_mutations_is_that_of_the_cases() {
    let table = include_str!("../conformance/mutations.md");
    let mut cases = known();
    cases.retain(|case| !case.is_long);
    if is_long() {
        let found = mutate(&cases, mutation::mutants);
        assert!(table.ends_with(&found.table()), "the table of today:\n{}", found.table());
        return;
    }
    // How many mutants there are is known without playing them.
    let mutants: Vec<Mutant> = cases.iter().flat_map(mutation::mutants).collect();
    let count = |change: Change| mutants.iter().filter(|mutant| mutant.change == change).count().to_string();
    let sums = table.lines().find_map(|line| line.strip_prefix("| all | ")).expect("the table has sums");
    let sums: Vec<&str> = sums.trim_end_matches(" |").split(" | ").collect();
    assert_eq!([sums[0], sums[2]], [count(Change::LeftOut), count(Change::Changed)], "make the table anew");
}

/// The facts that the table of broken machines has.
fn broken() -> BTreeSet<&'static str> {
    let rows = include_str!("../conformance/broken.md").lines().filter_map(|line| line.strip_prefix("| "));
    rows.skip(1).filter_map(|row| Some(row.split_once(" | ")?.0)).collect()
}

#[test]
fn every_fact_was_broken_once_and_its_cases_noticed() {
    let ids: BTreeSet<String> = known().into_iter().map(|case| case.id).collect();
    for row in include_str!("../conformance/broken.md").lines().filter_map(|line| line.strip_prefix("| ")).skip(1) {
        let [fact, how, cases] = row.trim_end_matches(" |").split(" | ").collect::<Vec<_>>()[..] else {
            panic!("a row has three cells: {row}");
        };
        assert!(!how.is_empty() && cases.split(", ").all(|case| ids.contains(case)), "{fact}: {cases}");
    }
    let facts =
        include_str!("../conformance/facts.txt").lines().filter(|line| line.starts_with(|c| ('1'..='5').contains(&c)));
    let broken = broken();
    let missing: Vec<&str> =
        facts.filter_map(|line| Some(line.split_once(" | ")?.0)).filter(|fact| !broken.contains(fact)).collect();
    assert!(missing.is_empty(), "never broken: {missing:?}");
}

#[test]
fn every_fact_of_the_client_has_a_case() {
    let proved: BTreeSet<String> = written().into_iter().flat_map(|case| case.facts).collect();
    let lines = include_str!("../conformance/facts.txt").lines().filter(|l| !l.is_empty() && !l.starts_with('#'));
    let named: Vec<(&str, &str)> = lines.map(|line| line.split_once(" | ").expect("a name and what it says")).collect();
    let facts: BTreeSet<&str> = named.iter().map(|fact| fact.0).filter(|name| !name.starts_with('-')).collect();
    assert_eq!(facts.len() + named.iter().filter(|fact| fact.0.starts_with("- ")).count(), named.len());
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

/// The fields of a command that may be given or not, or hold or not, with what they are in it: from its listing for
/// debugging, so that no field is forgotten.
fn choices(command: &Command) -> Vec<(String, &'static str)> {
    let text = format!("{command:?}");
    // Of screens there are ALL or some.
    let states = [("None", "left out"), ("All", "left out"), ("Some(", "given"), ("true", "on"), ("false", "off")];
    let fields = text.match_indices(": ").filter_map(|(at, _)| {
        let field = text[..at].rsplit(|c: char| !c.is_alphanumeric() && c != '_').next()?;
        let state = states.iter().find(|(start, _)| text[at + 2..].starts_with(start))?;
        Some((field.to_string(), state.1))
    });
    fields.collect()
}

#[test]
fn what_may_be_left_out_of_a_command_is_left_out_in_a_case_and_given_in_another() {
    let mut seen = BTreeSet::new();
    for command in commands() {
        let name = reference::name_of(&command);
        seen.extend(choices(&command).into_iter().map(|(field, state)| (name, field, state)));
    }
    let other = |state| match state {
        "left out" => "given",
        "given" => "left out",
        "on" => "off",
        _ => "on",
    };
    // What is only another name for an object always has one.
    let missing: Vec<String> = seen
        .iter()
        .filter(|(name, ..)| *name != "ALIAS")
        .filter(|(name, field, state)| !seen.contains(&(*name, field.clone(), other(state))))
        .map(|(name, field, state)| format!("{name}: {field} is always {state}"))
        .collect();
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// The rows of the tables of COMPATIBILITY.md, each as its cells.
fn decisions() -> Vec<Vec<&'static str>> {
    let lines = include_str!("../../ps340/COMPATIBILITY.md").lines().filter(|line| line.starts_with("| "));
    let rows = lines.map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect::<Vec<_>>());
    rows.filter(|row| row[0] != "Point").collect()
}

/// Whether `PATH::NAME` is a test of this source tree.
fn is_test(path_and_name: &str) -> bool {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let Some((path, name)) = path_and_name.split_once("::") else { return false };
    let text = fs::read_to_string(root.join(path)).unwrap_or_default();
    let Some(at) = text.find(&format!("fn {name}(")) else { return false };
    // The attribute stands on one of the lines before.
    text[..at].lines().rev().take(4).any(|line| line.contains("#[test]") || line.contains("#[tokio::test"))
}

#[test]
fn every_decision_names_a_case_or_a_test_that_exists() {
    let ids: BTreeSet<String> = known().into_iter().map(|case| case.id).collect();
    let decisions = decisions();
    let mut wrong = Vec::new();
    for row in &decisions {
        let [point, _, _, _, proofs] = row[..] else { panic!("a row has five cells: {row:?}") };
        let proofs: Vec<&str> = proofs.split('`').skip(1).step_by(2).collect();
        let unknown = proofs.iter().filter(|proof| !ids.contains(**proof) && !is_test(proof));
        wrong.extend(unknown.map(|proof| format!("{point}: there is no {proof}")));
        if proofs.is_empty() {
            wrong.push(format!("{point}: names neither case nor test"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(decisions.len() > 200, "{} decisions", decisions.len());
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
    for case in known() {
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
