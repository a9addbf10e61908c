//! All cases of a folder, and running them.

use super::{
    case::Case,
    parse::{CaseError, Problem, parse},
    person::Operator,
    report::{Outcome, Report, Verdict},
    session::{Failure, Session, Stop, Target},
};
use std::{
    fs, io,
    path::{Path, PathBuf},
    time::Instant,
};

/// The extension of files of cases.
const EXTENSION: &str = "cases";

/// The reason why the cases cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// A file or folder cannot be read.
    #[error("{}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// A file is wrong.
    #[error(transparent)]
    Case(#[from] CaseError),
}

/// Reads all `.cases` files of a folder, in the order of their names.
///
/// # Errors
/// [`SuiteError`], with the location.
pub fn read_folder(folder: &Path) -> Result<Vec<Case>, SuiteError> {
    let read = |path: &Path, error| SuiteError::Read { path: path.into(), error };
    let entries = fs::read_dir(folder).map_err(|e| read(folder, e))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == EXTENSION));
    paths.sort();
    let mut cases: Vec<Case> = Vec::new();
    for path in paths {
        let text = fs::read_to_string(&path).map_err(|e| read(&path, e))?;
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        for case in parse(&file, &text)? {
            if cases.iter().any(|other| other.id == case.id) {
                let problem = Problem::Twice(case.id.clone());
                return Err(CaseError { file: case.file, line: case.line, problem }.into());
            }
            cases.push(case);
        }
    }
    Ok(cases)
}

/// Runs cases one after the other, each on a line of its own.
///
/// - `each`: receives what came of each case.
///
/// # Errors
/// If the machine cannot be reached, or answers nothing at all.
pub fn run<'c>(
    target: &Target,
    mut operator: Option<&mut dyn Operator>,
    cases: impl IntoIterator<Item = &'c Case>,
    mut each: impl FnMut(&Outcome),
) -> io::Result<Report> {
    let mut report = Report::default();
    for case in cases {
        let begin = Instant::now();
        let operator: Option<&mut dyn Operator> = match &mut operator {
            Some(operator) => Some(&mut **operator),
            None => None,
        };
        let is_first = report.outcomes.iter().all(|outcome| matches!(outcome.verdict, Verdict::Skipped(_)));
        let verdict = play(target, operator, case, is_first)?;
        let outcome = Outcome { case: case.clone(), verdict, time: begin.elapsed() };
        each(&outcome);
        report.outcomes.push(outcome);
    }
    Ok(report)
}

fn play<'a>(
    target: &'a Target,
    operator: Option<&'a mut dyn Operator>,
    case: &'a Case,
    is_first: bool,
) -> io::Result<Verdict> {
    if case.needs_operator() && operator.is_none() {
        return Ok(Verdict::Skipped("nobody is at the machine".into()));
    }
    let verdict = |line, stop, transcript| {
        Ok(match stop {
            Stop::Skipped(why) => Verdict::Skipped(why),
            Stop::Unreachable(error) => return Err(error),
            Stop::Failed { expected, found } => {
                Verdict::Failed(Box::new(Failure { line, expected, found, transcript }))
            }
        })
    };
    let mut session = match Session::begin(target, operator, case) {
        Ok(session) => session,
        Err(Stop::Failed { expected, found }) if is_first => {
            // Nobody there: the other cases would only find the same, one after the other.
            return Err(io::Error::other(format!("expected {expected}, found {found}")));
        }
        Err(stop) => return verdict(case.line, stop, Vec::new()),
    };
    let played = session.play();
    let transcript = session.end();
    match played {
        Ok(()) => Ok(Verdict::Passed),
        Err((line, stop)) => verdict(line, stop, transcript),
    }
}
