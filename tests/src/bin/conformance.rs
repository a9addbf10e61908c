//! The conformance suite as a program: proves a machine over its host line.

use clap::Parser;
use std::{path::PathBuf, process::ExitCode, time::Duration};
use tests::conformance::{
    self, Case, Form, Operator, OperatorLine, Packets, Person, Target, Transport, Verdict, line::Endpoint, mutation,
    walk,
};

/// Runs the conformance suite of the PS 340 against a machine; see protocol/CONFORMANCE.md.
///
/// Works over the host line alone. Cases that need someone at the machine are skipped without --operator.
#[derive(Parser, Debug)]
#[command(
    version,
    after_help = "Exit codes: 0 all cases passed or were skipped, 1 a case failed (with --mutate: did not notice the loss of what it is\n\
                  named after), 2 usage or a wrong file of cases,\n\
                  3 the machine or its operator line cannot be reached."
)]
struct Arguments {
    /// The machine's host line: tcp:HOST:PORT, unix:PATH, pty:PATH or serial:PATH.
    endpoint: Endpoint,
    /// Who is at the machine: the address of an emulator's operator line, or 'ask' to be asked on this terminal.
    #[arg(long, value_name = "ADDRESS|ask")]
    operator: Option<String>,
    /// How commands travel.
    #[arg(long, value_enum, default_value = "text")]
    form: Form,
    /// What carries them. By default none for text, and long for binary.
    #[arg(long, value_enum)]
    packets: Option<Packets>,
    /// Cut the stream at random places.
    #[arg(long, value_name = "SEED")]
    cut: Option<u64>,
    /// Only cases of this section and below, such as B or B.4; may be given several times.
    #[arg(long)]
    section: Vec<String>,
    /// Only this case; may be given several times.
    #[arg(long, value_name = "ID")]
    case: Vec<String>,
    /// Only cases with these tags, such as SM.
    #[arg(long, value_name = "LETTERS")]
    tags: Option<String>,
    /// The cases that take seconds each, too.
    #[arg(long)]
    long: bool,
    /// Play mutants of the cases instead: each command left out, each number, text and switch changed.
    #[arg(long, conflicts_with = "junit")]
    mutate: bool,
    /// Where the files of cases are.
    #[arg(long, value_name = "FOLDER")]
    cases: Option<PathBuf>,
    /// Write the report as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the report in the form of JUnit.
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Seconds that the machine may take to answer.
    #[arg(long, value_name = "SECONDS", default_value = "5", value_parser = clap::value_parser!(u64).range(1..=3600))]
    patience: u64,
    /// Numbers and texts of the machine's own messages do not matter, only that one comes.
    #[arg(long)]
    any_fault: bool,
    /// Say each case as it passes.
    #[arg(long, short)]
    verbose: bool,
    /// List the cases and do nothing.
    #[arg(long)]
    list: bool,
}

impl Arguments {
    fn wants(&self, case: &Case) -> bool {
        let below = |section: &String| {
            case.section.strip_prefix(section.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        (self.section.is_empty() || self.section.iter().any(below))
            && (self.case.is_empty() || self.case.contains(&case.id))
            && (self.long || !case.is_long || self.case.contains(&case.id))
            && self.tags.as_ref().is_none_or(|tags| tags.to_uppercase().contains(case.tag.letter()))
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err((code, text)) => {
            eprintln!("conformance: {text}");
            ExitCode::from(code)
        }
    }
}

/// Whether nothing failed; else an exit code and the reason.
fn run(arguments: &Arguments) -> Result<bool, (u8, String)> {
    let usage = |text: String| (2, text);
    let folder = arguments.cases.clone().unwrap_or_else(conformance::cases_folder);
    let mut cases = conformance::read_folder(&folder).map_err(|e| usage(e.to_string()))?;
    cases.extend(walk::cases());
    cases.retain(|case| arguments.wants(case));
    if cases.is_empty() {
        return Err(usage("no case is left".into()));
    }
    if arguments.list {
        for case in &cases {
            println!("{:<6} {} {:<30} {}", case.section, case.tag.letter(), case.id, case.title);
        }
        return Ok(true);
    }
    let default = if arguments.form == Form::Text { Packets::None } else { Packets::Long };
    let way = Transport { form: arguments.form, packets: arguments.packets.unwrap_or(default) };
    way.check().map_err(|e| usage(e.to_string()))?;
    let target = Target {
        endpoint: arguments.endpoint.clone(),
        transport: way,
        cut: arguments.cut,
        timeout: Duration::from_secs(arguments.patience),
        any_fault: arguments.any_fault,
        reboots: arguments.mutate,
    };
    let mut operator: Option<Box<dyn Operator>> = match arguments.operator.as_deref() {
        None => None,
        Some("ask") => Some(Box::new(Person)),
        Some(address) => {
            let address = address.parse().map_err(|e: protocol::address::AddressError| usage(e.to_string()))?;
            Some(Box::new(OperatorLine::connect(&address).map_err(|e| (3, format!("{address}: {e}")))?))
        }
    };
    let mut operator = operator.as_mut().map(|operator| &mut **operator as &mut dyn Operator);
    let unreachable = |e: std::io::Error| (3, format!("no machine at {}: {e}", arguments.endpoint));
    let write = |file: &PathBuf, text: String| {
        std::fs::write(file, text).map_err(|e| usage(format!("{}: {e}", file.display())))
    };
    if arguments.mutate {
        let found = mutation::run(&target, &mut operator, &cases, mutation::mutants, |mutant, is_noticed| {
            if arguments.verbose && !is_noticed {
                let (written, sent) = &mutant.text;
                println!("unnoticed in {}: {written} -> {}", mutant.case.id, sent.as_deref().unwrap_or("nothing"));
            }
        });
        let found = found.map_err(unreachable)?;
        print!("{}", found.text());
        arguments.json.iter().try_for_each(|file| write(file, found.json()))?;
        return Ok(found.unsound.is_empty() && found.insensitive().next().is_none());
    }
    let report = conformance::run(&target, operator, &cases, |outcome| {
        if arguments.verbose && outcome.verdict == Verdict::Passed {
            println!("passed {}: {}", outcome.case.id, outcome.case.title);
        }
    });
    let report = report.map_err(unreachable)?;
    print!("{}", report.text());
    for (file, text) in [(&arguments.json, report.json()), (&arguments.junit, report.junit())] {
        if let Some(file) = file {
            write(file, text)?;
        }
    }
    Ok(report.tally().failed == 0)
}
