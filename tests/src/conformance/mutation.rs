//! Mutation of the suite itself: commands are left out or changed between runner and machine, and a case that still
//! passes does not notice.

use super::{
    case::{Case, Step, with_number},
    person::Operator,
    report::Verdict,
    session::Target,
    suite,
};
use protocol::command::{
    Command, CommandReader, Object, reference,
    token::{Lexer, TokenKind},
};
use ps340::functions;
use serde_json::json;
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write,
    io,
    ops::Range,
    sync::LazyLock,
};

/// One command of a case, up to its semicolon.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Statement {
    /// Where it stands in the whole text of the case.
    range: Range<usize>,
    /// The row of the reference that it belongs to.
    command: &'static str,
    /// What it is about: its command, the function that it makes, the initial instances that it names.
    subjects: BTreeSet<String>,
    /// The numbers, texts and switches in it, and what stands there instead once it is changed.
    literals: Vec<(Range<usize>, String)>,
}

/// The row of the table for what is no command of the language, such as a command that is meant to be wrong.
const NO_COMMAND: &str = "(no command)";

/// A case with one thing changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Mutant {
    /// The case, with other commands.
    pub case: Case,
    /// What was changed.
    pub change: Change,
    /// The row of the reference of the command.
    pub command: &'static str,
    /// The command as it stands in the case, and what stands there now, if it is not left out.
    pub text: (String, Option<String>),
}

/// How a case is changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Change {
    /// One command is left out.
    LeftOut,
    /// One number, text or switch of a command is another.
    Changed,
    /// Every command is left out that is about what the case is named after.
    Subject(String),
}

/// The text of a case, and where each step of it is.
struct Text {
    text: String,
    /// The number of a step, and where its text is.
    pieces: Vec<(usize, Range<usize>)>,
}

impl Text {
    fn of(case: &Case) -> Text {
        let mut whole = Text { text: String::new(), pieces: Vec::new() };
        for (number, (_, step)) in case.steps.iter().enumerate() {
            if let Step::Send(text) | Step::Each { text, .. } = step {
                let start = whole.text.len();
                whole.text.push_str(text);
                whole.pieces.push((number, start..whole.text.len()));
            }
        }
        whole
    }

    /// The case with other text in these ranges, which follow one another.
    fn with(&self, case: &Case, edits: &[(Range<usize>, &str)]) -> Case {
        let mut case = case.clone();
        for (number, piece) in &self.pieces {
            let mut new = String::new();
            let mut at = piece.start;
            for (range, text) in edits {
                let (start, end) = (range.start.max(piece.start), range.end.min(piece.end));
                if start >= end {
                    continue;
                }
                new.push_str(&self.text[at..start]);
                // A range over two steps stands in the first.
                if range.start >= piece.start {
                    new.push_str(text);
                }
                at = end;
            }
            new.push_str(&self.text[at..piece.end]);
            if let Step::Send(text) | Step::Each { text, .. } = &mut case.steps[*number].1 {
                *text = new;
            }
        }
        case
    }

    /// The commands in it.
    fn statements(&self) -> Vec<Statement> {
        let mut lexer = Lexer::new(self.text.as_bytes(), 0);
        let (mut all, mut literals) = (Vec::new(), Vec::new());
        let mut start = None;
        loop {
            let token = lexer.token();
            let is_end = matches!(token.kind, TokenKind::Semicolon | TokenKind::End);
            let is_empty = start.is_none() && is_end;
            let first = *start.get_or_insert(token.start);
            literals.extend(other_literal(token.kind, &self.text[token.span()]).map(|new| (token.span(), new)));
            if is_end {
                if !is_empty {
                    let range = first..token.end;
                    let (command, subjects) = meaning(&self.text[range.clone()]);
                    all.push(Statement { range, command, subjects, literals: std::mem::take(&mut literals) });
                }
                start = None;
            }
            if token.kind == TokenKind::End {
                return all;
            }
        }
    }
}

/// What stands instead of a number, a text or a switch; none for other words.
fn other_literal(kind: TokenKind, text: &str) -> Option<String> {
    match kind {
        TokenKind::Number(_) => Some(match text.parse::<i64>() {
            Ok(n) => n.wrapping_add(1).to_string(),
            Err(_) => format!("{}", text.parse::<f64>().ok()? + 0.37),
        }),
        TokenKind::String => Some(match text.len() {
            2 => "'X'".into(),
            length => format!(
                "{}{}'",
                &text[..text.floor_char_boundary(length - 2)],
                if text.ends_with("X'") { "Y" } else { "X" }
            ),
        }),
        TokenKind::Name => match text.to_ascii_uppercase().as_str() {
            "TRUE" => Some("FALSE".into()),
            "FALSE" => Some("TRUE".into()),
            "ON" => Some("OFF".into()),
            "OFF" => Some("ON".into()),
            _ => None,
        },
        _ => None,
    }
}

/// The row of the reference that a command belongs to, and all that it is about.
fn meaning(text: &str) -> (&'static str, BTreeSet<String>) {
    static INITIAL: LazyLock<BTreeSet<String>> =
        LazyLock::new(|| functions::devices::initial().map(|initial| initial.name.to_string()).collect());
    let mut reader = CommandReader::default();
    reader.push(with_number(text, 1).as_bytes());
    reader.push(b"\n");
    let Some(Ok(read)) = reader.next() else { return (NO_COMMAND, BTreeSet::new()) };
    let name = reference::name_of(&read.command);
    let mut subjects = BTreeSet::from([name.to_string()]);
    if let Command::Define { object: Object::Function { function, .. }, .. } = &read.command {
        subjects.insert(function.to_string().to_ascii_uppercase());
    }
    let mut lexer = Lexer::new(text.as_bytes(), 0);
    loop {
        let token = lexer.token();
        match token.kind {
            TokenKind::End => return (name, subjects),
            TokenKind::Name => {
                let word = text[token.span()].to_ascii_uppercase();
                subjects.extend(INITIAL.contains(&word).then_some(word));
            }
            _ => {}
        }
    }
}

/// Whether a case is named after a command, function or instance: its title has it in capitals, or its name begins with
/// it.
fn is_named_after(case: &Case, subject: &str) -> bool {
    if subject.len() < 2 {
        return false;
    }
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '$';
    let stands_in_title = case.title.match_indices(subject).any(|(at, _)| {
        let (before, after) = (case.title[..at].chars().next_back(), case.title[at + subject.len()..].chars().next());
        !before.is_some_and(is_word) && !after.is_some_and(is_word)
    });
    let words = |text: &str| -> Vec<String> {
        let words = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        words.map(str::to_ascii_lowercase).collect()
    };
    stands_in_title || words(&case.id).starts_with(&words(subject))
}

/// Every mutant of a case: each command left out, each literal changed, and each subject left out.
pub fn mutants(case: &Case) -> Vec<Mutant> {
    let text = Text::of(case);
    let statements = text.statements();
    let mut all = Vec::new();
    for statement in &statements {
        let written = text.text[statement.range.clone()].to_string();
        all.push(Mutant {
            case: text.with(case, &[(statement.range.clone(), "")]),
            change: Change::LeftOut,
            command: statement.command,
            text: (written.clone(), None),
        });
        for (range, literal) in &statement.literals {
            let mut new = written.clone();
            let start = range.start - statement.range.start;
            new.replace_range(start..start + range.len(), literal);
            all.push(Mutant {
                case: text.with(case, &[(range.clone(), literal)]),
                change: Change::Changed,
                command: statement.command,
                text: (written.clone(), Some(new)),
            });
        }
    }
    all.extend(subject_mutants(case));
    all
}

/// The mutants of a case without all commands about one of the things that it is named after.
pub fn subject_mutants(case: &Case) -> Vec<Mutant> {
    let text = Text::of(case);
    let statements = text.statements();
    let subjects: BTreeSet<&String> = statements.iter().flat_map(|s| &s.subjects).collect();
    let named = subjects.into_iter().filter(|subject| is_named_after(case, subject));
    named
        .map(|subject| {
            let about: Vec<&Statement> = statements.iter().filter(|s| s.subjects.contains(subject)).collect();
            let edits: Vec<(Range<usize>, &str)> = about.iter().map(|s| (s.range.clone(), "")).collect();
            let written: Vec<&str> = edits.iter().map(|(range, _)| &text.text[range.clone()]).collect();
            Mutant {
                case: text.with(case, &edits),
                change: Change::Subject(subject.clone()),
                command: about[0].command,
                text: (written.join(" "), None),
            }
        })
        .collect()
}

/// How many mutants there were, and how many the case did not notice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// All.
    pub all: usize,
    /// The case passed all the same.
    pub unnoticed: usize,
}

/// What came of the mutants.
#[derive(Clone, Debug, Default)]
pub struct Mutations {
    /// For each row of the reference: commands left out, and literals changed.
    pub commands: BTreeMap<&'static str, [Count; 2]>,
    /// Cases with the loss of what they are named after.
    pub subjects: Count,
    /// The mutants that no case noticed.
    pub unnoticed: Vec<Mutant>,
    /// Cases that failed without a change, before or after their mutants.
    pub unsound: Vec<String>,
}

/// Plays the mutants of cases, each case itself before and after them.
///
/// - `choose`: the mutants of a case, [`mutants`] or [`subject_mutants`].
/// - `each`: receives each mutant, and whether it was noticed.
///
/// # Errors
/// If the machine cannot be reached.
pub fn run<'c>(
    target: &Target,
    operator: &mut Option<&mut dyn Operator>,
    cases: impl IntoIterator<Item = &'c Case>,
    choose: impl Fn(&Case) -> Vec<Mutant>,
    mut each: impl FnMut(&Mutant, bool),
) -> io::Result<Mutations> {
    let mut found = Mutations::default();
    let mut play = |case: &Case| -> io::Result<Verdict> {
        let operator: Option<&mut dyn Operator> = match operator {
            Some(operator) => Some(&mut **operator),
            None => None,
        };
        let mut report = suite::run(target, operator, [case], |_| {})?;
        Ok(report.outcomes.remove(0).verdict)
    };
    for case in cases {
        match play(case)? {
            Verdict::Passed => {}
            Verdict::Skipped(_) => continue,
            Verdict::Failed(_) => {
                found.unsound.push(case.id.clone());
                continue;
            }
        }
        for mutant in choose(case) {
            let is_noticed = play(&mutant.case)? != Verdict::Passed;
            each(&mutant, is_noticed);
            found.count(mutant, is_noticed);
        }
        if play(case)? != Verdict::Passed {
            found.unsound.push(case.id.clone());
        }
    }
    Ok(found)
}

impl Mutations {
    fn count(&mut self, mutant: Mutant, is_noticed: bool) {
        let row = self.commands.entry(mutant.command).or_default();
        let count = match mutant.change {
            Change::LeftOut => &mut row[0],
            Change::Changed => &mut row[1],
            Change::Subject(_) => &mut self.subjects,
        };
        count.all += 1;
        count.unnoticed += usize::from(!is_noticed);
        if !is_noticed {
            self.unnoticed.push(mutant);
        }
    }

    /// Adds what came of other mutants.
    pub fn join(&mut self, other: Mutations) {
        let add = |sum: &mut Count, count: Count| {
            sum.all += count.all;
            sum.unnoticed += count.unnoticed;
        };
        for (name, counts) in other.commands {
            let row = self.commands.entry(name).or_default();
            row.iter_mut().zip(counts).for_each(|(sum, count)| add(sum, count));
        }
        add(&mut self.subjects, other.subjects);
        self.unnoticed.extend(other.unnoticed);
        self.unsound.extend(other.unsound);
    }

    /// The cases that do not notice the loss of what they are named after, with that.
    pub fn insensitive(&self) -> impl Iterator<Item = (&Case, &str)> {
        self.unnoticed.iter().filter_map(|mutant| match &mutant.change {
            Change::Subject(subject) => Some((&mutant.case, subject.as_str())),
            _ => None,
        })
    }

    /// A table of the commands, in the form of Markdown.
    pub fn table(&self) -> String {
        let mut out = String::from("| command | left out | unnoticed | changed | unnoticed |\n|---|---|---|---|---|\n");
        let mut sums = [Count::default(); 2];
        let row = |out: &mut String, name: &str, [left_out, changed]: [Count; 2]| {
            let numbers = [left_out.all, left_out.unnoticed, changed.all, changed.unnoticed];
            // Writing to a string cannot fail.
            let _ = writeln!(out, "| {name} | {} |", numbers.map(|n| n.to_string()).join(" | "));
        };
        for (name, counts) in &self.commands {
            row(&mut out, &name.replace('*', "\\*"), *counts);
            for (sum, count) in sums.iter_mut().zip(counts) {
                sum.all += count.all;
                sum.unnoticed += count.unnoticed;
            }
        }
        row(&mut out, "all", sums);
        out
    }

    /// The table, the cases that do not notice the loss of what they are named after, and those that failed by
    /// themselves.
    pub fn text(&self) -> String {
        let mut out = self.table();
        let Count { all, unnoticed } = self.subjects;
        let _ = writeln!(out, "{all} losses of what a case is named after, {unnoticed} unnoticed");
        for (case, subject) in self.insensitive() {
            let _ = writeln!(
                out,
                "INSENSITIVE {} [{}] {}:{} to the loss of {subject}",
                case.id, case.section, case.file, case.line
            );
        }
        for id in &self.unsound {
            let _ = writeln!(out, "UNSOUND {id}: failed without a change");
        }
        out
    }

    /// The counts and every mutant that was not noticed, as JSON.
    pub fn json(&self) -> String {
        let count = |c: Count| json!({ "all": c.all, "unnoticed": c.unnoticed });
        let rows = self.commands.iter().map(|(name, [left_out, changed])| {
            (name.to_string(), json!({ "left_out": count(*left_out), "changed": count(*changed) }))
        });
        let unnoticed = self.unnoticed.iter().map(|mutant| {
            let (change, subject) = match &mutant.change {
                Change::LeftOut => ("left out", None),
                Change::Changed => ("changed", None),
                Change::Subject(subject) => ("subject left out", Some(subject)),
            };
            json!({
                "case": mutant.case.id, "command": mutant.command, "change": change, "subject": subject,
                "written": mutant.text.0, "sent": mutant.text.1,
            })
        });
        let all = json!({
            "commands": rows.collect::<serde_json::Map<_, _>>(), "subjects": count(self.subjects),
            "unsound": self.unsound, "unnoticed": unnoticed.collect::<Vec<_>>(),
        });
        serde_json::to_string_pretty(&all).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::parse;

    fn sent(case: &Case) -> Vec<String> {
        let text = |(_, step): &(usize, Step)| match step {
            Step::Send(text) | Step::Each { text, .. } => Some(text.trim_end().to_string()),
            _ => None,
        };
        case.steps.iter().filter_map(text).collect()
    }

    #[test]
    fn each_command_is_left_out_and_each_literal_changed() {
        let text = "section B\ncase delete-x M DELETE of one\n> A := SCALE 3 THEN B; DELETE\n> A; SEND 'b;' TO <1>HOST_MESSAGE;\n< b;\n";
        let case = parse("f", text).unwrap().remove(0);
        let all = mutants(&case);
        let left_out: Vec<_> = all.iter().filter(|m| m.change == Change::LeftOut).collect();
        let commands: Vec<&str> = left_out.iter().map(|m| m.command).collect();
        assert_eq!(commands, ["SCALE", "DELETE", "SEND"]);
        assert_eq!(sent(&left_out[0].case), [" DELETE", "A; SEND 'b;' TO <1>HOST_MESSAGE;"]);
        assert_eq!(sent(&left_out[1].case), ["A := SCALE 3 THEN B;", " SEND 'b;' TO <1>HOST_MESSAGE;"]);
        assert_eq!(sent(&left_out[2].case), ["A := SCALE 3 THEN B; DELETE", "A;"]);
        let changed: Vec<_> = all.iter().filter(|m| m.change == Change::Changed).map(|m| m.text.1.as_deref()).collect();
        let of_send = ["SEND 'bX' TO <1>HOST_MESSAGE;", "SEND 'b;' TO <2>HOST_MESSAGE;"];
        assert_eq!(changed, [Some("A := SCALE 4 THEN B;"), Some(of_send[0]), Some(of_send[1])]);
        let subjects: Vec<_> =
            all.iter().filter_map(|m| matches!(&m.change, Change::Subject(_)).then_some(&m.change)).collect();
        assert_eq!(subjects, [&Change::Subject("DELETE".into())]);
    }

    #[test]
    fn a_case_is_named_after_functions_and_instances_too() {
        let text = "section B\ncase x M PICKINFO tells TABLETIN\n> N := F:PICKINFO; CONNECT TABLETIN<6>:<1>N;\n\
                    > SEND 1 TO <1>N;\n< y\n";
        let case = parse("f", text).unwrap().remove(0);
        let subjects: Vec<_> = subject_mutants(&case).into_iter().map(|m| (m.change, m.text.0)).collect();
        let subject = |name: &str| Change::Subject(name.into());
        assert_eq!(subjects[0], (subject("PICKINFO"), "N := F:PICKINFO;".into()));
        assert_eq!(subjects[1], (subject("TABLETIN"), "CONNECT TABLETIN<6>:<1>N;".into()));
        assert_eq!(subjects.len(), 2);
    }
}
