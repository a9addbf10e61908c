//! The conformance suite on our own machine, in a seeded selection of the ways in which commands travel.
//!
//! With `PERIS_LONG=1` every way is walked.

use std::{cell::RefCell, collections::BTreeSet, time::Duration};
use tests::{
    Machine,
    conformance::{
        self, Case, Operator, Report, Target, Verdict, Way, line::Place, person, person::OrderFault,
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

/// A machine whose time stands while nobody waits.
fn machine() -> Machine {
    Machine::start(PS340, &["--clock", "virtual"])
}

fn play<'c>(machine: Machine, way: Way, cut: Option<u64>, cases: impl IntoIterator<Item = &'c Case>) -> Report {
    let place = Place::Socket(format!("tcp:{}", machine.line).parse().unwrap());
    let machine = RefCell::new(machine);
    let target = Target { place, way, cut, patience: Duration::from_secs(5), any_fault: false };
    conformance::run(&target, Some(&mut Here(&machine)), cases, |_| {}).unwrap()
}

/// The cases that the machine cannot pass yet, one a line. The list only becomes shorter.
fn waiting() -> BTreeSet<&'static str> {
    include_str!("../conformance/waiting.txt").lines().filter(|l| !l.is_empty() && !l.starts_with('#')).collect()
}

fn assert_passed(report: &Report, what: &str) {
    let waiting = waiting();
    let failed: Vec<String> = report
        .failures()
        .filter(|(case, _)| !waiting.contains(case.id.as_str()))
        .map(|(c, f)| failure_text(c, f))
        .collect();
    assert!(failed.is_empty(), "{what}: {} cases failed\n{}", failed.len(), failed.concat());
    assert_eq!(report.tally().skipped, 0, "{what}");
    let passed = report.outcomes.iter().filter(|o| o.verdict == Verdict::Passed).map(|o| o.case.id.as_str());
    let ready: Vec<&str> = passed.filter(|id| waiting.contains(id)).collect();
    if !ready.is_empty() {
        println!("{what}: take out of waiting.txt: {}", ready.join(" "));
    }
}

#[test]
fn every_case_passes_as_text() {
    let report = play(machine(), Way::default(), None, &all());
    assert_passed(&report, "text");
    assert!(report.tally().passed > 150);
}

#[test]
fn cases_pass_in_every_way_and_cut_at_random_places() {
    let long = std::env::var_os("PERIS_LONG").is_some();
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
    let missing: Vec<&str> = FACTS.iter().copied().filter(|fact| !proved.contains(*fact)).collect();
    assert!(missing.is_empty(), "no case proves: {}", missing.join(", "));
    let unknown: Vec<&String> = proved.iter().filter(|fact| !FACTS.contains(&fact.as_str())).collect();
    assert!(unknown.is_empty(), "there are no facts {unknown:?}");
}

/// The numbered facts about the machine; those about the library of a client are not among them.
const FACTS: &[&str] = &[];
