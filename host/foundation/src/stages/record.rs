//! The record of stages: how long each took, and a profile that browsers show.

use super::layer::StageEvent;
use serde::Serialize;
use std::io::{self, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Most stages and parts of a profile; what comes later is counted, but not kept.
const MOST_PROFILED: usize = 1 << 20;

/// What is known of the stages of a process, up to now.
#[derive(Debug)]
pub struct StageRecord {
    origin: Instant,
    open: Vec<OpenStage>,
    /// Totals, each with the index of the one within which it is.
    totals: Vec<(StageTotal, Option<usize>)>,
    /// What ended, in the order in which it did; none if no profile is wanted.
    profile: Option<Vec<ProfiledStage>>,
    /// How many stages and parts are not in the profile, which is full.
    missing: u64,
}

/// All stages of a name within the same stages.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageTotal {
    /// What was done, such as `rendering`.
    pub name: &'static str,
    /// Within how many stages.
    pub depth: usize,
    /// Wall-clock time of those that have ended, seconds, the stages within them included.
    pub seconds: f64,
    /// How many have ended.
    pub times: u64,
}

#[derive(Debug)]
struct OpenStage {
    id: u64,
    name: &'static str,
    begin: Instant,
    thread: u64,
    part: Option<u64>,
    /// Its total; none for a part.
    total: Option<usize>,
}

/// A stage or a part of one that has ended.
#[derive(Debug)]
struct ProfiledStage {
    name: &'static str,
    /// From the origin.
    begin: Duration,
    length: Duration,
    thread: u64,
    part: Option<u64>,
}

/// The number of this thread, from 1 on in the order in which threads were first seen.
fn thread_number() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    thread_local!(static NUMBER: u64 = NEXT.fetch_add(1, Ordering::Relaxed));
    NUMBER.with(|number| *number)
}

impl StageRecord {
    /// An empty record that begins now.
    ///
    /// - `profiles`: whether each stage is kept for [`StageRecord::write_profile`].
    pub fn new(profiles: bool) -> StageRecord {
        let profile = profiles.then(Vec::new);
        StageRecord { origin: Instant::now(), open: Vec::new(), totals: Vec::new(), profile, missing: 0 }
    }

    /// Takes note of an event, in the thread in which it happens.
    pub fn add(&mut self, event: &StageEvent) {
        match event {
            StageEvent::Begin { id, parent, name, part, .. } => {
                let outer = self.open.iter().find(|stage| Some(stage.id) == *parent).and_then(|stage| stage.total);
                let total = part.is_none().then(|| self.total(name, outer));
                let (id, name, part, thread) = (*id, *name, *part, thread_number());
                self.open.push(OpenStage { id, name, begin: Instant::now(), thread, part, total });
            }
            StageEvent::Progress { .. } => {}
            StageEvent::End { id } => self.end(*id),
        }
    }

    fn end(&mut self, id: u64) {
        let Some(at) = self.open.iter().rposition(|stage| stage.id == id) else { return };
        let OpenStage { name, begin, thread, part, total, .. } = self.open.remove(at);
        let length = begin.elapsed();
        if let Some(total) = total {
            let (total, _) = &mut self.totals[total];
            total.seconds += length.as_secs_f64();
            total.times += 1;
        }
        if let Some(profile) = &mut self.profile {
            if profile.len() < MOST_PROFILED {
                profile.push(ProfiledStage { name, begin: begin - self.origin, length, thread, part });
            } else {
                self.missing += 1;
            }
        }
    }

    /// The total of a name within another one.
    fn total(&mut self, name: &'static str, parent: Option<usize>) -> usize {
        let found = self.totals.iter().position(|(total, within)| total.name == name && *within == parent);
        found.unwrap_or_else(|| {
            let depth = parent.map_or(0, |parent| self.totals[parent].0.depth + 1);
            self.totals.push((StageTotal { name, depth, seconds: 0.0, times: 0 }, parent));
            self.totals.len() - 1
        })
    }

    /// The totals of stages that have ended at least once: each one is followed by those within it, else in the order
    /// in which they first began.
    pub fn totals(&self) -> Vec<StageTotal> {
        let mut ordered = Vec::new();
        self.add_within(None, &mut ordered);
        ordered
    }

    fn add_within(&self, parent: Option<usize>, ordered: &mut Vec<StageTotal>) {
        for (index, (total, _)) in self.totals.iter().enumerate().filter(|(_, (_, within))| *within == parent) {
            if total.times > 0 {
                ordered.push(total.clone());
            }
            self.add_within(Some(index), ordered);
        }
    }

    /// Writes what has ended in the trace-event format, which Perfetto and browsers (`chrome://tracing`) show: complete
    /// events with their begin and length in microseconds, one row for each thread.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_profile(&self, to: &mut dyn Write) -> io::Result<()> {
        let stages = self.profile.as_deref().unwrap_or_default();
        let mut threads: Vec<u64> = stages.iter().map(|stage| stage.thread).collect();
        threads.sort_unstable();
        threads.dedup();
        write!(to, "{{\"displayTimeUnit\":\"ms\",\"otherData\":{{\"missing\":{}}},\"traceEvents\":[", self.missing)?;
        let mut separator = "\n";
        for thread in threads {
            let event = serde_json::json!({
                "name": "thread_name", "ph": "M", "pid": 1, "tid": thread,
                "args": { "name": if thread == 1 { "main".to_owned() } else { format!("worker {thread}") } },
            });
            write!(to, "{separator}{event}")?;
            separator = ",\n";
        }
        let microseconds = |time: Duration| time.as_nanos() as f64 / 1e3;
        for ProfiledStage { name, begin, length, thread, part } in stages {
            let mut event = serde_json::json!({
                "name": name, "ph": "X", "pid": 1, "tid": thread,
                "ts": microseconds(*begin), "dur": microseconds(*length),
            });
            if let Some(part) = part {
                event["args"] = serde_json::json!({ "number": part });
            }
            write!(to, "{separator}{event}")?;
            separator = ",\n";
        }
        to.write_all(b"\n]}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn begin(id: u64, parent: Option<u64>, name: &'static str, part: Option<u64>) -> StageEvent {
        StageEvent::Begin { id, parent, name, all: 0.0, unit: String::new(), is_opaque: false, part }
    }

    #[test]
    fn stages_of_a_name_are_added_up_within_the_same_stages_only() {
        let mut record = StageRecord::new(true);
        for event in [
            begin(1, None, "rendering", None),
            begin(2, Some(1), "tracing photons", None),
            StageEvent::End { id: 2 },
            begin(2, Some(1), "tracing photons", None),
            begin(3, Some(2), "row", Some(7)),
            StageEvent::End { id: 3 },
            StageEvent::End { id: 2 },
            begin(4, None, "tracing photons", None),
            StageEvent::End { id: 4 },
            StageEvent::End { id: 1 },
            begin(5, None, "writing", None),
        ] {
            record.add(&event);
        }
        let totals: Vec<_> = record.totals().iter().map(|total| (total.name, total.depth, total.times)).collect();
        assert_eq!(totals, [("rendering", 0, 1), ("tracing photons", 1, 2), ("tracing photons", 0, 1)]);
        let mut text = Vec::new();
        record.write_profile(&mut text).expect("memory");
        let profile: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
        let events = profile["traceEvents"].as_array().expect("a list");
        let complete: Vec<_> = events.iter().filter(|event| event["ph"] == "X").collect();
        assert_eq!(complete.len(), 5);
        assert_eq!((&complete[1]["name"], &complete[1]["args"]["number"]), (&"row".into(), &7.into()));
        let end =
            |event: &serde_json::Value| event["ts"].as_f64().expect("a time") + event["dur"].as_f64().expect("a time");
        assert!(end(complete[0]) <= end(complete[4]), "{profile}");
    }
}
