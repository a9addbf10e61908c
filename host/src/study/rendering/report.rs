//! A study of renderers as text, comma-separated values and plots.

use super::error_floor::ErrorFloor;
use super::results::{KnobStudy, RenderRow, RenderStudy};
use crate::study::plot::{Axis, Plot, PlotPoint, Series};
use crate::study::sweep::short;

/// What is less than this part of the RMSE is not drawn: rounding would fill most of the plot.
const NEGLIGIBLE: f64 = 1e-3;

/// What a row tells: heading and value.
type Column = (&'static str, fn(&RenderRow) -> f64);

const COLUMNS: [Column; 10] = [
    ("setting", |row| row.setting),
    ("time (s)", |row| row.seconds),
    ("build (s)", |row| row.build),
    ("RMSE", |row| row.measures.rmse),
    ("chance", |row| row.measures.noise),
    ("bias", |row| row.measures.bias()),
    ("bias below", |row| row.measures.most_bias()),
    ("rel. MSE", |row| row.measures.relative_mse),
    ("FLIP", |row| row.measures.flip),
    ("MSE x time", RenderRow::cost),
];

/// What the rows of a study tell.
///
/// - `apart`: how far a reference of scan line is from one of ray tracing, and what it leaves out.
pub(super) fn verdict(study: &KnobStudy, changes: bool, apart: Option<(f64, Vec<&'static str>)>) -> String {
    let at = |from: usize| format!("{} {}", study.name, short(study.rows[from].setting));
    let mut text = match &study.error_floor {
        _ if !changes => "changes nothing: all settings give the same picture".to_owned(),
        None if study.rows.len() < 3 => String::new(),
        None => "the error still falls at the finest setting".to_owned(),
        Some(ErrorFloor::Least { at: least }) => format!("the error is least at {}, and grows beyond", at(*least)),
        Some(ErrorFloor::Noise { from }) => {
            format!("from {} on the error is chance: more samples lower it, not {}", at(*from), study.name)
        }
        Some(ErrorFloor::Bias { from, causes }) => {
            let cause = |(name, part): &(String, f64)| format!("{name} ({:.0} %)", 100.0 * part.min(1.0));
            let causes: Vec<String> = causes.iter().map(cause).collect();
            let causes = match (causes.is_empty(), study.technique.row().adds_samples) {
                (false, _) => causes.join(", "),
                (true, false) => "none of its other knobs: the renderer itself".to_owned(),
                (true, true) => "no other knob alone".to_owned(),
            };
            let bias = study.rows[*from].measures.bias();
            format!("from {} on the error is bias, {}: of {causes}", at(*from), short(bias))
        }
    };
    if let Some((distance, left_out)) = apart {
        let own = format!("the reference is {} from ray tracing, as {}", short(distance), left_out.join("; "));
        text = if text.is_empty() { own } else { format!("{text}; {own}") };
    }
    text
}

impl RenderStudy {
    /// The study as tables for people.
    pub fn table(&self) -> String {
        self.knobs.iter().map(KnobStudy::table).collect::<Vec<_>>().join("\n")
    }

    /// The study as comma-separated values, with a header line.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
        let mut text = format!("renderer,knob,{},reference RMSE\n", names.join(","));
        for study in &self.knobs {
            for row in &study.rows {
                let cells: Vec<String> = COLUMNS.iter().map(|(_, of)| of(row).to_string()).collect();
                let (by, name) = (study.technique.row().word, study.name);
                text.push_str(&format!("{by},{name},{},{}\n", cells.join(","), study.reference_error));
            }
        }
        text
    }

    /// Plots: RMSE over run time of all knobs, if there are several, and of each knob with what of it is noise and
    /// bias; each with its name. Knobs with fewer than three settings have no curve.
    pub fn plots(&self, title: &str) -> Vec<(String, Plot)> {
        let curves: Vec<&KnobStudy> = self.knobs.iter().filter(|study| study.rows.len() > 2).collect();
        let rmse = |study: &&KnobStudy| Series {
            name: format!("{}: {}", study.technique.row().word, study.name),
            points: study.points(|row| row.measures.rmse, false),
        };
        let mut plots = Vec::new();
        if curves.len() > 1 {
            let series = curves.iter().map(rmse).collect();
            plots.push((
                String::new(),
                plot(title.to_owned(), "each curve is one knob, from its coarsest setting to its finest", series),
            ));
        }
        let mut names: Vec<&str> = curves.iter().map(|study| study.name).collect();
        names.sort_unstable();
        names.dedup();
        for name in names {
            let of_knob: Vec<&KnobStudy> = curves.iter().filter(|study| study.name == name).copied().collect();
            let series = of_knob.iter().flat_map(|study| study.series()).collect();
            let note = of_knob[0].sets;
            plots.push((format!("-{name}"), plot(format!("{title}: {name}"), note, series)));
        }
        plots
    }
}

impl KnobStudy {
    /// The knob as a table for people.
    pub fn table(&self) -> String {
        let KnobStudy { technique, name, sets, .. } = self;
        let mut text = format!("{}, {name}: {sets}; the scene has {}\n", technique.row().word, short(self.scene));
        if !self.rows.is_empty() {
            for (name, _) in COLUMNS {
                text.push_str(&format!("{name:>10}  "));
            }
            text.push('\n');
            for row in &self.rows {
                for (_, of) in COLUMNS {
                    text.push_str(&format!("{:>10}  ", short(of(row))));
                }
                text.push('\n');
            }
            let [error, seconds] = [self.reference_error, self.reference_seconds].map(short);
            text.push_str(&format!("reference: {}; its RMSE is {error}, it took {seconds} s\n", self.reference));
        }
        if !self.verdict.is_empty() {
            text.push_str(&format!("{}\n", self.verdict));
        }
        text
    }

    /// RMSE, noise and bias.
    fn series(&self) -> Vec<Series> {
        let word = self.technique.row().word;
        type Curve = (&'static str, fn(&RenderRow) -> f64);
        let curves: [Curve; 3] = [
            ("RMSE", |row| row.measures.rmse),
            ("chance", |row| row.measures.noise),
            ("bias", |row| row.measures.bias()),
        ];
        let curve =
            |(name, of): Curve| Series { name: format!("{word}: {name}"), points: self.points(of, name == "RMSE") };
        curves.into_iter().map(curve).filter(|series| series.points.iter().any(|point| point.y > 0.0)).collect()
    }

    fn points(&self, of: fn(&RenderRow) -> f64, labels: bool) -> Vec<PlotPoint> {
        let label = |row: &RenderRow| if labels { short(row.setting) } else { String::new() };
        // What was not seen at a setting has no place there, and no line leads past it.
        let seen = |row: &RenderRow| Some(of(row)).filter(|error| *error > NEGLIGIBLE * row.measures.rmse);
        let point = |row: &RenderRow| PlotPoint { x: row.seconds, y: seen(row).unwrap_or(f64::NAN), label: label(row) };
        self.rows.iter().map(point).collect()
    }
}

fn plot(title: String, note: &str, series: Vec<Series>) -> Plot {
    Plot {
        title,
        x_label: "run time (s)".into(),
        y_label: "error of radiance".into(),
        note: note.to_owned(),
        x_axis: Axis::Logarithmic,
        y_axis: Axis::Logarithmic,
        series,
    }
}
