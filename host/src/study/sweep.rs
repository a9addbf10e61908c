//! One knob through all its settings: run time, errors, table, CSV and plot.

use super::StudyError;
use super::plot::{Axis, Plot, PlotPoint, Series};
use crate::render::{Memo, Watch};
use crate::stages::stage;
use serde::{Deserialize, Serialize};
use std::sync::atomic::Ordering;

/// A setting is tried again, for its shortest time, while it took less than this many seconds in all.
const SHORT_SECONDS: f64 = 0.25;
/// Most times that one setting is tried.
const MOST_TRIALS: u32 = 5;

/// A quality setting that can be swept.
pub trait Knob {
    /// What one trial gives, to be compared with the reference.
    type Answer;

    /// What the knob sets, with its unit, for tables and axes.
    fn setting(&self) -> &'static str;

    /// The settings to try, from the coarsest to the finest, and the far finer one of the reference.
    fn settings(&self) -> (Vec<f64>, f64);

    /// Runs one setting.
    ///
    /// # Errors
    /// [`StudyError`].
    fn run(&self, setting: f64, watch: &Watch<'_>) -> Result<Trial<Self::Answer>, StudyError>;

    /// Names of what [`Knob::errors`] gives; the first is plotted first.
    fn error_names(&self) -> Vec<&'static str>;

    /// Errors of an answer against the reference.
    ///
    /// # Errors
    /// [`StudyError`] if they cannot be compared.
    fn errors(&self, trial: &Trial<Self::Answer>, reference: &Trial<Self::Answer>) -> Result<Vec<f64>, StudyError>;
}

/// One run at one setting.
#[derive(Clone, Debug)]
pub struct Trial<A> {
    /// The result.
    pub answer: A,
    /// Wall-clock time, seconds.
    pub seconds: f64,
    /// Whatever else was counted, with its name; the same names for every setting.
    pub counts: Vec<(&'static str, f64)>,
}

/// A finished study.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// What was set, with its unit.
    pub setting: String,
    /// The setting of the reference.
    pub reference: f64,
    /// Names of the errors.
    pub error_names: Vec<String>,
    /// Names of the counts.
    pub count_names: Vec<String>,
    /// One row for each setting.
    pub rows: Vec<StudyRow>,
}

/// One setting of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyRow {
    /// The setting.
    pub setting: f64,
    /// Its run time, seconds.
    pub seconds: f64,
    /// Its errors.
    pub errors: Vec<f64>,
    /// Its counts.
    pub counts: Vec<f64>,
}

/// A setting that was tried.
#[derive(Serialize, Deserialize)]
struct TriedSetting {
    row: StudyRow,
    count_names: Vec<String>,
}

/// Sweeps a knob.
///
/// # Errors
/// The first [`StudyError`], or [`StudyError::Interrupted`].
pub fn sweep<K: Knob>(knob: &K, watch: &Watch<'_>) -> Result<Study, StudyError> {
    let (settings, finest) = knob.settings();
    let stage = stage!("studying", settings.len() as f64 + 1.0, "measurements", opaque);
    let unkept = watch.without_memo();
    let run = |setting| {
        let trial = knob.run(setting, &unkept)?;
        if watch.cancelled.load(Ordering::Relaxed) { Err(StudyError::Interrupted) } else { Ok(trial) }
    };
    let mut rows = Vec::new();
    // The first run warms the machine; its time is not kept.
    let reference = run(finest)?;
    stage.progress(1.0);
    let tried = |setting| -> Result<TriedSetting, StudyError> {
        let mut trial = run(setting)?;
        let mut spent = trial.seconds;
        for _ in 1..MOST_TRIALS {
            if spent >= SHORT_SECONDS {
                break;
            }
            // The fastest trial counts, with all that was counted in it.
            let again = run(setting)?;
            spent += again.seconds;
            if again.seconds < trial.seconds {
                trial = again;
            }
        }
        let errors = knob.errors(&trial, &reference)?;
        let count_names = trial.counts.iter().map(|c| c.0.to_owned()).collect();
        let counts = trial.counts.iter().map(|c| c.1).collect();
        Ok(TriedSetting { row: StudyRow { setting, seconds: trial.seconds, errors, counts }, count_names })
    };
    let mut count_names = Vec::new();
    for (index, &setting) in settings.iter().enumerate() {
        let tried = Memo::next(watch.memo, || tried(setting))?;
        count_names = tried.count_names;
        rows.push(tried.row);
        stage.progress(index as f64 + 2.0);
    }
    Ok(Study {
        setting: knob.setting().to_owned(),
        reference: finest,
        error_names: knob.error_names().into_iter().map(str::to_owned).collect(),
        count_names,
        rows,
    })
}

impl Study {
    fn header(&self) -> Vec<String> {
        let mut names = vec![self.setting.clone(), "run time (s)".into()];
        names.extend(self.error_names.iter().cloned());
        names.push(format!("{} x time", self.error_names.last().map_or("error", |n| n)));
        names.extend(self.count_names.iter().cloned());
        names
    }

    fn cells(row: &StudyRow) -> Vec<f64> {
        let mut cells = vec![row.setting, row.seconds];
        cells.extend(&row.errors);
        cells.push(row.errors.last().copied().unwrap_or(0.0) * row.seconds);
        cells.extend(&row.counts);
        cells
    }

    /// The study as a table for people.
    pub fn table(&self) -> String {
        let header = self.header();
        let mut text = String::new();
        for name in &header {
            text.push_str(&format!("{name:>w$}  ", w = name.len().max(9)));
        }
        text.push('\n');
        for row in &self.rows {
            for (name, cell) in header.iter().zip(Study::cells(row)) {
                text.push_str(&format!("{:>w$}  ", short(cell), w = name.len().max(9)));
            }
            text.push('\n');
        }
        text.push_str(&format!("reference: {} {}\n", self.setting, short(self.reference)));
        text
    }

    /// The study as comma-separated values, with a header line.
    pub fn csv(&self) -> String {
        let line = |cells: Vec<String>| cells.join(",") + "\n";
        let mut text = line(self.header());
        for row in &self.rows {
            text.push_str(&line(Study::cells(row).iter().map(f64::to_string).collect()));
        }
        text
    }

    /// The study as a plot of the errors against the run time; or of what was counted against the setting, where no
    /// setting has an error.
    pub fn plot(&self, title: &str) -> Plot {
        if self.rows.iter().all(|row| row.errors.iter().all(|error| *error == 0.0)) {
            return self.plot_of_counts(title);
        }
        // All curves have their points at the same run times: one row of labels serves them all.
        let label =
            |i: usize, row: &StudyRow| if i + 1 == self.error_names.len() { short(row.setting) } else { String::new() };
        let series = self.error_names.iter().enumerate().map(|(i, name)| Series {
            name: name.clone(),
            points: self
                .rows
                .iter()
                .map(|row| PlotPoint { x: row.seconds, y: row.errors[i], label: label(i, row) })
                .collect(),
        });
        Plot {
            title: title.to_owned(),
            x_label: "run time (s)".into(),
            y_label: "error".into(),
            note: format!("numbers at the last curve, for the points above too: {}", self.setting),
            x_axis: Axis::Logarithmic,
            y_axis: Axis::Logarithmic,
            series: series.collect(),
        }
    }
}

impl Study {
    fn plot_of_counts(&self, title: &str) -> Plot {
        let series = self.count_names.iter().enumerate().map(|(i, name)| Series {
            name: name.clone(),
            points: self
                .rows
                .iter()
                .map(|row| PlotPoint { x: row.setting, y: row.counts[i], label: String::new() })
                .collect(),
        });
        Plot {
            title: title.to_owned(),
            x_label: self.setting.clone(),
            y_label: "cost, in the unit of each curve".into(),
            note: format!("no setting has an error: {} 0 at all of them", self.error_names.join(", ")),
            x_axis: Axis::Logarithmic,
            y_axis: Axis::Logarithmic,
            series: series.collect(),
        }
    }
}

/// A number in four digits.
pub(super) fn short(x: f64) -> String {
    let magnitude = x.abs();
    if x == 0.0 {
        "0".into()
    } else if x.fract() == 0.0 && magnitude < 1e9 {
        format!("{x}")
    } else if !(1e-3..1e5).contains(&magnitude) {
        format!("{x:.2e}")
    } else {
        let digits = (3 - magnitude.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{x:.digits$}")
    }
}
