//! What came of the cases: as a table, as JSON and as JUnit.

use super::{case::Case, session::Failure};
use serde_json::json;
use std::{collections::BTreeMap, fmt::Write, time::Duration};

/// What came of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// As expected.
    Passed,
    /// Not as expected.
    Failed(Box<Failure>),
    /// Not played, and why.
    Skipped(String),
}

/// A case and what came of it.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The case.
    pub case: Case,
    /// What came of it.
    pub verdict: Verdict,
    /// How long it took.
    pub time: Duration,
}

/// What came of all cases.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// In the order in which they were played.
    pub outcomes: Vec<Outcome>,
}

/// Passed, failed and skipped cases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// As expected.
    pub passed: usize,
    /// Not as expected.
    pub failed: usize,
    /// Not played.
    pub skipped: usize,
}

impl Tally {
    fn count(&mut self, verdict: &Verdict) {
        match verdict {
            Verdict::Passed => self.passed += 1,
            Verdict::Failed(_) => self.failed += 1,
            Verdict::Skipped(_) => self.skipped += 1,
        }
    }
}

impl Report {
    /// All cases together.
    pub fn tally(&self) -> Tally {
        let mut tally = Tally::default();
        self.outcomes.iter().for_each(|outcome| tally.count(&outcome.verdict));
        tally
    }

    /// The cases of each section, in the order of the reference.
    pub fn sections(&self) -> Vec<(String, Tally)> {
        let mut sections: BTreeMap<(String, u32, String), Tally> = BTreeMap::new();
        for Outcome { case, verdict, .. } in &self.outcomes {
            // B.10 comes after B.9.
            let (chapter, number) = case.section.split_once('.').unwrap_or((&case.section, ""));
            let digits: String = number.chars().take_while(char::is_ascii_digit).collect();
            let key = (chapter.into(), digits.parse().unwrap_or(0), case.section.clone());
            sections.entry(key).or_default().count(verdict);
        }
        sections.into_iter().map(|((_, _, section), tally)| (section, tally)).collect()
    }

    /// The names of the cases that failed.
    pub fn failures(&self) -> impl Iterator<Item = (&Case, &Failure)> {
        self.outcomes.iter().filter_map(|outcome| match &outcome.verdict {
            Verdict::Failed(failure) => Some((&outcome.case, &**failure)),
            _ => None,
        })
    }

    /// The reasons why cases were skipped, and how many for each.
    fn reasons(&self) -> BTreeMap<&str, usize> {
        let mut reasons = BTreeMap::new();
        for outcome in &self.outcomes {
            if let Verdict::Skipped(why) = &outcome.verdict {
                *reasons.entry(why.as_str()).or_default() += 1;
            }
        }
        reasons
    }

    /// The failures, a table of the sections, and why cases were skipped.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for (case, failure) in self.failures() {
            let _ = write!(out, "{}", failure_text(case, failure));
        }
        let row = |out: &mut String, name: &str, t: Tally| {
            let _ = writeln!(out, "{name:<10} {:>7} {:>7} {:>7}", t.passed, t.failed, t.skipped);
        };
        let _ = writeln!(out, "{:<10} {:>7} {:>7} {:>7}", "section", "passed", "failed", "skipped");
        for (section, tally) in self.sections() {
            row(&mut out, &section, tally);
        }
        row(&mut out, "all", self.tally());
        for (why, count) in self.reasons() {
            let _ = writeln!(out, "skipped {count}: {why}");
        }
        out
    }

    /// Everything as JSON.
    pub fn json(&self) -> String {
        let counts = |t: Tally| json!({ "passed": t.passed, "failed": t.failed, "skipped": t.skipped });
        let cases: Vec<_> = self.outcomes.iter().map(outcome_json).collect();
        let sections: serde_json::Map<_, _> = self.sections().into_iter().map(|(s, t)| (s, counts(t))).collect();
        let all = json!({ "all": counts(self.tally()), "sections": sections, "cases": cases });
        serde_json::to_string_pretty(&all).unwrap_or_default()
    }

    /// Everything in the form of JUnit: a suite for each section.
    pub fn junit(&self) -> String {
        let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"conformance\">\n");
        for (section, tally) in self.sections() {
            let Tally { passed, failed, skipped } = tally;
            let tests = passed + failed + skipped;
            let _ = writeln!(
                out,
                "  <testsuite name=\"{}\" tests=\"{tests}\" failures=\"{failed}\" skipped=\"{skipped}\">",
                escaped(&section)
            );
            for outcome in self.outcomes.iter().filter(|o| o.case.section == section) {
                junit_case(outcome, &mut out);
            }
            out.push_str("  </testsuite>\n");
        }
        out.push_str("</testsuites>\n");
        out
    }
}

/// A failure for people.
pub fn failure_text(case: &Case, failure: &Failure) -> String {
    let mut out = format!(
        "FAILED {} [{} {}] {}:{}\n  {}\n  expected: {}\n  found:    {}\n",
        case.id,
        case.section,
        case.tag.letter(),
        case.file,
        failure.line,
        case.title,
        failure.expected,
        failure.found
    );
    for line in &failure.transcript {
        let _ = writeln!(out, "  | {}", line.replace('\n', "\n  |   "));
    }
    out
}

fn outcome_json(outcome: &Outcome) -> serde_json::Value {
    let Outcome { case, verdict, time } = outcome;
    let mut value = json!({
        "id": case.id, "title": case.title, "section": case.section, "tag": case.tag.letter(),
        "facts": case.facts, "file": case.file, "line": case.line, "seconds": time.as_secs_f64(),
    });
    let more = match verdict {
        Verdict::Passed => json!({ "verdict": "passed" }),
        Verdict::Skipped(why) => json!({ "verdict": "skipped", "reason": why }),
        Verdict::Failed(failure) => json!({
            "verdict": "failed", "at": failure.line, "expected": failure.expected, "found": failure.found,
            "transcript": failure.transcript,
        }),
    };
    if let (Some(object), serde_json::Value::Object(more)) = (value.as_object_mut(), more) {
        object.extend(more);
    }
    value
}

fn junit_case(outcome: &Outcome, out: &mut String) {
    let Outcome { case, verdict, time } = outcome;
    let seconds = time.as_secs_f64();
    let class = format!("{}.{}", case.section, case.tag.letter());
    let name = format!("{}: {}", case.id, case.title);
    let (class, name) = (escaped(&class), escaped(&name));
    let _ = write!(out, "    <testcase classname=\"{class}\" name=\"{name}\" time=\"{seconds:.6}\"");
    match verdict {
        Verdict::Passed => out.push_str("/>\n"),
        Verdict::Skipped(why) => {
            let _ = writeln!(out, "><skipped message=\"{}\"/></testcase>", escaped(why));
        }
        Verdict::Failed(failure) => {
            let message = format!("expected {}, found {}", failure.expected, failure.found);
            let text = escaped(&failure.transcript.join("\n"));
            let _ = writeln!(out, "><failure message=\"{}\">{text}</failure></testcase>", escaped(&message));
        }
    }
}

/// A text for XML; characters that XML forbids become `?`.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() => out.push('?'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::case::Tag;

    fn report() -> Report {
        let outcome = |id: &str, section: &str, verdict| Outcome {
            case: Case::new(id, "a \"title\" & more", section, Tag::M),
            verdict,
            time: Duration::from_millis(2),
        };
        let transcript = vec!["> A < B\u{1}".to_string()];
        let failure = Failure { line: 7, expected: "x".into(), found: "y".into(), transcript };
        Report {
            outcomes: vec![
                outcome("a", "B.10", Verdict::Passed),
                outcome("b", "B.9", Verdict::Failed(Box::new(failure))),
                outcome("c", "B.9", Verdict::Skipped("nobody".into())),
            ],
        }
    }

    #[test]
    fn sections_stand_in_the_order_of_the_reference() {
        let names: Vec<String> = report().sections().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["B.9", "B.10"]);
        assert_eq!(report().tally(), Tally { passed: 1, failed: 1, skipped: 1 });
        let text = report().text();
        assert!(text.contains("FAILED b [B.9 M]") && text.contains("all              1       1       1"), "{text}");
        assert!(text.ends_with("skipped 1: nobody\n"), "{text}");
    }

    #[test]
    fn json_and_junit_hold_every_case() {
        let json: serde_json::Value = serde_json::from_str(&report().json()).unwrap();
        assert_eq!(json["cases"].as_array().unwrap().len(), 3);
        assert_eq!(json["sections"]["B.9"]["failed"], 1);
        assert_eq!(json["cases"][1]["found"], "y");
        let junit = report().junit();
        assert_eq!(junit.matches("<testcase ").count(), 3);
        assert!(junit.contains("&quot;title&quot; &amp; more") && junit.contains("&gt; A &lt; B?"), "{junit}");
    }
}
