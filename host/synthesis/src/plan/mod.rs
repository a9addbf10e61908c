//! What a scene needs, and why: the only place that decides to leave something out.
//!
//! A renderer asks the plan for every stage, object and light. What is left out would have contributed exactly
//! nothing, so that a forced plan ([`Plan::everything`]) gives the same picture, only later.

mod decision;
mod stage;
mod visibility;

pub use stage::Stage;

use crate::scene::{Prepared, View};
use crate::stages::StageTotal;
use decision::Decision;
use serde::Serialize;

/// What is done and what is left out for one scene and one view.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// Whether everything was forced.
    pub forced: bool,
    /// One line for each stage, object and light, in this order.
    pub entries: Vec<PlanEntry>,
    #[serde(skip)]
    stages: [bool; Stage::ALL.len()],
    #[serde(skip)]
    objects: Vec<bool>,
    #[serde(skip)]
    lights: Vec<bool>,
    #[serde(skip)]
    views: Vec<View>,
}

/// One line of a plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanEntry {
    /// What kind of thing it decides on.
    pub kind: EntryKind,
    /// Its name.
    pub name: String,
    /// Whether it is included.
    pub needed: bool,
    /// The reason, in words.
    pub reason: String,
    /// How long it took, seconds; none if that is not known, or cannot be told from other work.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

/// What an entry decides on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum EntryKind {
    /// A stage of rendering.
    Stage,
    /// An object of the scene.
    Object,
    /// A light of the scene.
    Light,
}

impl EntryKind {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            EntryKind::Stage => "stage",
            EntryKind::Object => "object",
            EntryKind::Light => "light",
        }
    }
}

impl Plan {
    /// The leanest plan that gives the full picture of `prepared` seen through `view`.
    pub fn new(prepared: &Prepared, view: &View) -> Plan {
        Plan::of_views(prepared, std::slice::from_ref(view), false)
    }

    /// The plan that leaves nothing out.
    pub fn everything(prepared: &Prepared, view: &View) -> Plan {
        Plan::of_views(prepared, std::slice::from_ref(view), true)
    }

    /// The plan for several views.
    ///
    /// - `forced`: whether nothing is left out.
    pub fn of_views(prepared: &Prepared, views: &[View], forced: bool) -> Plan {
        let mut plan = Plan {
            forced,
            entries: Vec::new(),
            stages: [true; Stage::ALL.len()],
            objects: Vec::new(),
            lights: Vec::new(),
            views: views.to_vec(),
        };
        let lights: Vec<Decision> = prepared.lights.iter().map(light).collect();
        let facts = stage::Facts::new(prepared, lights.iter().map(|d| d.needed).collect());
        let objects = visibility::objects(prepared, views, &facts);
        let facts = facts.within(objects.iter().map(|d| d.needed).collect());
        for stage in Stage::ALL {
            plan.stages[stage as usize] =
                plan.add(EntryKind::Stage, stage.word().to_owned(), stage.decide(&facts), stage.is_forcible());
        }
        for (object, decision) in prepared.objects.iter().zip(objects) {
            let kept = plan.add(EntryKind::Object, object.name.clone(), decision, true);
            plan.objects.push(kept);
        }
        for (index, decision) in lights.into_iter().enumerate() {
            let kept = plan.add(EntryKind::Light, format!("light {}", index + 1), decision, true);
            plan.lights.push(kept);
        }
        plan
    }

    fn add(&mut self, kind: EntryKind, name: String, decision: Decision, forcible: bool) -> bool {
        let Decision { needed, reason } = decision;
        let forced = self.forced && forcible && !needed;
        let reason = if forced { format!("forced; {reason}") } else { reason };
        let needed = needed || forced;
        self.entries.push(PlanEntry { kind, name, needed, reason, seconds: None });
        needed
    }

    /// Whether a stage is run.
    pub fn needs(&self, stage: Stage) -> bool {
        self.stages[stage as usize]
    }

    /// Whether an object, an index into [`objects`](crate::scene::Contents::objects), is included.
    pub fn includes_object(&self, index: usize) -> bool {
        self.objects.get(index).copied().unwrap_or(true)
    }

    /// Whether a light, an index into [`lights`](crate::scene::Contents::lights), is included.
    pub fn includes_light(&self, index: usize) -> bool {
        self.lights.get(index).copied().unwrap_or(true)
    }

    /// The views for which it is.
    pub fn views(&self) -> &[View] {
        &self.views
    }

    /// Takes note of how long stages took.
    ///
    /// - `totals`: those of the work of the plan.
    pub fn set_seconds(&mut self, totals: &[StageTotal]) {
        for (entry, stage) in self.entries.iter_mut().zip(Stage::ALL) {
            let work = totals.iter().filter(|total| stage.work().contains(&total.name));
            entry.seconds = work.map(|total| total.seconds).reduce(|sum, seconds| sum + seconds);
        }
    }

    /// The plan as a table for people; with a column of seconds, if those of any entry are known.
    pub fn table(&self) -> String {
        let width = self.entries.iter().map(|e| e.name.chars().count()).max().unwrap_or(0).max(4);
        let is_timed = self.entries.iter().any(|e| e.seconds.is_some());
        let time = |seconds: String| if is_timed { format!("{seconds:>8} ") } else { String::new() };
        let mut text = format!("{:<7} {:<width$} {:<8} {}why\n", "what", "name", "", time("seconds".into()));
        for e in &self.entries {
            let verdict = if e.needed { "needed" } else { "left out" };
            let seconds = time(e.seconds.map(|seconds| format!("{seconds:.3}")).unwrap_or_default());
            text.push_str(&format!("{:<7} {:<width$} {verdict:<8} {seconds}{}\n", e.kind.word(), e.name, e.reason));
        }
        text
    }
}

fn light(light: &crate::illumination::Light) -> Decision {
    let kind = light.words();
    if !light.strength().1.is_black() {
        Decision::new(true, format!("{kind} with power"))
    } else {
        Decision::new(false, format!("{kind} without power"))
    }
}

#[cfg(test)]
mod tests;
