//! `ps340 lint`: what is wrong in command files.

use super::error::{ToolError, print, read};
use crate::lint::{Finding, Level, lint};
use std::{path::PathBuf, process::ExitCode};

/// Arguments of `lint`.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Each finding is a line FILE:LINE:COLUMN: LEVEL: TEXT. Errors are what the machine would refuse or what surely does not
work; warnings are what is probably not meant, or is missing unless a host sends it later.
Lines that begin with '@' are directives for 'ps340 play': those that write files or end the machine are listed, the others
passed over. Of a capture such orders are listed, and nothing else.
Exit codes: 0 no errors, 1 errors (with --strict: or warnings), 2 usage.")]
pub struct LintArguments {
    /// Command files, read one after the other as if one host sent them; '-' is the standard input.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Prints the findings as a JSON array.
    #[arg(long)]
    json: bool,
    /// Lets warnings fail too.
    #[arg(long)]
    strict: bool,
}

/// Reads the files and prints the findings.
pub(super) fn run(arguments: &LintArguments) -> Result<ExitCode, ToolError> {
    let mut files = Vec::new();
    for file in &arguments.files {
        files.push((file.display().to_string(), read(file)?));
    }
    let findings = lint(&files);
    let count = |level: Level| findings.iter().filter(|finding| finding.level == level).count();
    let (errors, warnings) = (count(Level::Error), count(Level::Warning));
    if arguments.json {
        let all: Vec<serde_json::Value> = findings.iter().map(json).collect();
        print(&format!("{:#}\n", serde_json::Value::from(all)))?;
    } else {
        print(&findings.iter().map(|finding| format!("{finding}\n")).collect::<String>())?;
        if errors + warnings > 0 {
            let plural = |n: usize| if n == 1 { "" } else { "s" };
            eprintln!("{errors} error{}, {warnings} warning{}", plural(errors), plural(warnings));
        }
    }
    let fails = errors > 0 || (arguments.strict && warnings > 0);
    Ok(if fails { ExitCode::from(1) } else { ExitCode::SUCCESS })
}

fn json(finding: &Finding) -> serde_json::Value {
    serde_json::json!({
        "file": finding.file,
        "line": finding.line,
        "column": finding.column,
        "level": finding.level.word(),
        "text": finding.text,
    })
}
