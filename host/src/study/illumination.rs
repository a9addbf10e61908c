//! The study of the D family: how far each member is normalised and reciprocal, and what it costs.
//!
//! It needs no scene. It walks the table of the family and knows no member by name.

use super::StudyError;
use super::plot::{Axis, Plot, PlotPoint, Series};
use super::sweep::short;
use crate::illumination::distribution::measure::{emitted_share, light_at, received_share, reciprocity_residual};
use crate::illumination::distribution::{Distribution, FAMILY};
use crate::numeric::sampling::{RandomStream, r2_point};
use crate::render::{Memo, Watch};
use crate::stages::stage;
use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Angles of incidence in degrees, to just above the surface.
const INCIDENCES: [f64; 12] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0, 89.0, 89.9999];
/// Error to which the integrals are found, and the most evaluations for each.
const TOLERANCE: f64 = 1e-5;
const MOST_EVALUATIONS: u32 = 60_000;
/// Random pairs of directions for the residual of reciprocity, and their seed.
const PAIRS: u64 = 20_000;
const SEED: u64 = 7;
/// Less than this, and the residual is that of rounding.
const RECIPROCAL: f64 = 1e-6;
/// What follows the name of a member for what a viewer sees of it.
const VIEWED: &str = ", seen";
/// Width of the names in a table.
const NAMES: usize = 22;
/// Calls that are timed.
const TIMED: u32 = 40_000;

/// What was found out about the family.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IlluminationStudy {
    /// The angles of incidence, degrees.
    pub incidences: Vec<f64>,
    /// One row for each member and roughness.
    pub rows: Vec<IlluminationRow>,
}

/// One member of the family at one roughness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IlluminationRow {
    /// The member.
    pub name: String,
    /// Its roughness m.
    pub roughness: f64,
    /// The integral of D over the outgoing hemisphere at each incidence; 1 if it is normalised.
    pub shares: Vec<f64>,
    /// The share of an even sky's light that a viewer sees who looks at each of these angles, where that differs: for a
    /// member that is not reciprocal. More than 1 makes light in pictures.
    #[serde(rename = "seen")]
    pub viewed: Option<Vec<f64>>,
    /// The greatest error that the cubature states for them.
    pub error: f64,
    /// Greatest |f − f'| / (f + f') with light and viewer exchanged; 0 if it is reciprocal.
    pub reciprocity: f64,
    /// Time for one evaluation of D, nanoseconds.
    pub evaluation: f64,
    /// Time for one sampled direction, nanoseconds.
    pub sample: f64,
}

/// Measures every member of the family.
///
/// - `roughness`: the values of m to try, 1e-8..=1000.
///
/// # Errors
/// [`StudyError::Distribution`] for a roughness that is not provided for, or [`StudyError::Interrupted`].
pub fn illumination(roughness: &[f64], watch: &Watch<'_>) -> Result<IlluminationStudy, StudyError> {
    let stage = stage!("studying", (roughness.len() * FAMILY.len()) as f64, "distributions", opaque);
    let mut rows = Vec::new();
    for &m in roughness {
        for member in FAMILY {
            if watch.cancelled.load(Ordering::Relaxed) {
                return Err(StudyError::Interrupted);
            }
            let make = || Ok::<_, StudyError>(row(member.name, m, (member.make)(m)?.as_ref()));
            rows.push(Memo::next(watch.memo, make)?);
            stage.progress(rows.len() as f64);
        }
    }
    Ok(IlluminationStudy { incidences: INCIDENCES.to_vec(), rows })
}

fn row(name: &str, roughness: f64, distribution: &dyn Distribution) -> IlluminationRow {
    let integrals =
        INCIDENCES.map(|d| emitted_share(distribution, light_at(d.to_radians()), TOLERANCE, MOST_EVALUATIONS));
    let reciprocity = reciprocity_residual(distribution, PAIRS, SEED);
    let seen = (reciprocity > RECIPROCAL).then(|| {
        INCIDENCES.map(|d| received_share(distribution, light_at(d.to_radians()), TOLERANCE, MOST_EVALUATIONS))
    });
    let light = light_at(0.5);
    let views: Vec<_> =
        (0..TIMED).filter_map(|index| distribution.sample(light, r2_point(index, [0.3, 0.7]))).collect();
    let start = Instant::now();
    let sum: f64 = views.iter().map(|view| distribution.density(black_box(light), *view)).sum();
    black_box(sum);
    let evaluation = start.elapsed().as_secs_f64() * 1e9 / views.len().max(1) as f64;
    let mut stream = RandomStream::new(SEED, 0);
    let points: Vec<[f64; 2]> = (0..TIMED).map(|_| stream.point()).collect();
    let start = Instant::now();
    let found = points.iter().filter_map(|point| distribution.sample(black_box(light), *point)).count();
    black_box(found);
    let sample = start.elapsed().as_secs_f64() * 1e9 / f64::from(TIMED);
    IlluminationRow {
        name: name.to_owned(),
        roughness,
        shares: integrals.iter().map(|integral| integral.value).collect(),
        viewed: seen.map(|seen| seen.iter().map(|integral| integral.value).collect()),
        error: integrals.iter().chain(seen.iter().flatten()).map(|integral| integral.error).fold(0.0, f64::max),
        reciprocity,
        evaluation,
        sample,
    }
}

impl IlluminationStudy {
    fn header(&self) -> Vec<String> {
        let angles = self.incidences.iter().map(|degrees| format!("{degrees}"));
        let rest = ["cubature error", "reciprocity", "evaluation (ns)", "sample (ns)"];
        ["D", "m"].into_iter().map(str::to_owned).chain(angles).chain(rest.map(str::to_owned)).collect()
    }

    /// Names and numbers of the lines of a row: of the emitted shares, and of the seen ones where these differ.
    fn lines(row: &IlluminationRow) -> Vec<(String, Vec<f64>)> {
        let sides = [(row.name.clone(), Some(&row.shares)), (format!("{}{VIEWED}", row.name), row.viewed.as_ref())];
        let rest = [row.error, row.reciprocity, row.evaluation, row.sample];
        let cells = |shares: &Vec<f64>| [row.roughness].into_iter().chain(shares.iter().copied()).chain(rest).collect();
        sides.into_iter().filter_map(|(name, shares)| Some((name, cells(shares?)))).collect()
    }

    /// The study as a table for people: the integral of D at each incidence in degrees, and the rest. A member that is not
    /// reciprocal has a second line, of what a viewer sees.
    pub fn table(&self) -> String {
        let header = self.header();
        let width = |name: &str| name.len().max(9);
        let mut text = format!("{:<NAMES$}", header[0]);
        header[1..].iter().for_each(|name| text.push_str(&format!("{name:>w$}  ", w = width(name))));
        text.push('\n');
        for row in &self.rows {
            for (name, cells) in IlluminationStudy::lines(row) {
                text.push_str(&format!("{name:<NAMES$}"));
                for (name, cell) in header[1..].iter().zip(cells) {
                    text.push_str(&format!("{:>w$}  ", short(cell), w = width(name)));
                }
                text.push('\n');
            }
        }
        text
    }

    /// The study as comma-separated values, with a header line.
    pub fn csv(&self) -> String {
        let mut text = self.header().join(",") + "\n";
        for row in &self.rows {
            for (name, cells) in IlluminationStudy::lines(row) {
                // A name may hold a comma.
                text.push_str(&format!("\"{name}\""));
                cells.iter().for_each(|cell| text.push_str(&format!(",{cell}")));
                text.push('\n');
            }
        }
        text
    }

    /// The integrals over the incidence, one plot for each roughness, with that roughness.
    pub fn plots(&self) -> Vec<(f64, Plot)> {
        let mut all: Vec<f64> = self.rows.iter().map(|row| row.roughness).collect();
        all.dedup();
        let plot = |m: f64| {
            let of_shares = |name: String, shares: &[f64]| Series {
                name,
                points: self
                    .incidences
                    .iter()
                    .zip(shares)
                    // A member that leaves the picture would make the others flat.
                    .map(|(x, y)| (x, if (LOWEST..HIGHEST).contains(y) { *y } else { f64::NAN }))
                    .map(|(x, y)| PlotPoint { x: *x, y, label: String::new() })
                    .collect(),
            };
            let of_row = |row: &IlluminationRow| {
                let seen = row.viewed.as_ref().map(|seen| of_shares(format!("{}{VIEWED}", row.name), seen));
                std::iter::once(of_shares(row.name.clone(), &row.shares)).chain(seen).collect::<Vec<_>>()
            };
            Plot {
                title: format!("emitted share of the flux, and seen share of an even sky, roughness {m}"),
                x_label: "angle of light or viewer (degrees)".into(),
                y_label: "share".into(),
                note: format!(
                    "1 is normalised; more creates light; one curve where both are the same; {LOWEST} to {HIGHEST}"
                ),
                x_axis: Axis::Linear,
                y_axis: Axis::Logarithmic,
                series: self.rows.iter().filter(|row| row.roughness == m).flat_map(of_row).collect(),
            }
        };
        all.into_iter().map(|m| (m, plot(m))).collect()
    }
}

/// The range of the plots.
const LOWEST: f64 = 0.05;
const HIGHEST: f64 = 20.0;
