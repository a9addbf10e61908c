//! Any distribution of facets: a function of the angle between facet and surface, sampled to a table with a stated
//! error.

use super::{Distribution, DistributionError, LEAST_ROUGHNESS, MOST_ROUGHNESS};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Intervals that a function is sampled in before any is halved: what is narrower and away from the normal may be
/// missed.
const FIRST: usize = 256;
/// Most intervals.
const MOST: usize = 8192;
/// Most halvings of one of the first intervals.
const HALVINGS: u32 = 24;
/// Error at the middle of an interval, as a part of the value there, at which it is halved.
const TOLERANCE: f64 = 2e-4;
/// Values below this part of the greatest count as if they were so great.
const FLOOR: f64 = 1e-6;
/// The limits of the table of the area that the facets show to a direction: first intervals, most of them, and the
/// tolerance.
const SHOWN: (usize, usize, f64) = (16, 1024, 2e-6);
/// Places between the ends of an interval at which errors are measured: not at the middles, which were sampled.
const MEASURED: [f64; 2] = [0.276_393_202_250_021, 0.723_606_797_749_979];
/// Places and weights of Gauss and Legendre's formula of three points, in 0..1.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// How well a table stands for its function, at points between those that it holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TableError {
    /// Greatest error there, as a part of the value of the function there, or of a millionth of its greatest value
    /// where it is less than that.
    pub greatest: f64,
    /// The area of all facets that are misplaced, as a part of the area of all.
    pub mean: f64,
    /// How many values the table holds.
    pub values: usize,
}

/// A reason for which a function of the angle gives no distribution of facets.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FacetError<E> {
    /// The function itself failed.
    #[error("at an angle of {angle}: {source}")]
    Function {
        /// The angle, radians.
        angle: f64,
        /// The error of the function.
        source: E,
    },
    /// A value that is negative or not finite.
    #[error("it is {value} at an angle of {angle}: it must be finite and not negative")]
    Value {
        /// The angle, radians.
        angle: f64,
        /// The value.
        value: f64,
    },
    /// All values are 0.
    #[error("it is 0 at all angles: there are no facets")]
    Nothing,
}

/// D = area(α) G₂ / (4 (N·L)) of facets whose normals have any distribution over the angle α from the surface's normal.
///
/// Between the angles of the table the area is linear. It is scaled so that the area times cos α integrates to 1 over
/// the hemisphere, as it must for any surface. Masking is Smith's, with correlated heights, found of the table by
/// integration: D is reciprocal, and integrates to 1 but for what strikes a second facet.
///
/// # Source
/// Those of [`super::Microfacet`]; Smith's masking for any isotropic distribution after Ashikhmin, Premože and Shirley
/// 2000, with the area that facets show to a direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Plain", into = "Plain")]
pub struct FacetTable {
    name: String,
    /// Angles, radians, and areas, 1/sr.
    area: Table,
    /// Part of the area times cosine up to each angle.
    below: Vec<f64>,
    /// By the cosine of a direction, the area that facets show to it.
    shown: Table,
    error: TableError,
}

/// The stored fields of a table.
#[derive(Clone, Serialize, Deserialize)]
struct Plain {
    name: String,
    angles: Vec<f64>,
    areas: Vec<f64>,
    error: TableError,
}

/// A function that is linear between places, which rise.
#[derive(Clone, Debug, Default, PartialEq)]
struct Table {
    places: Vec<f64>,
    values: Vec<f64>,
}

impl Table {
    /// Samples a function from `low` to `high`, closer where it bends.
    fn sampled<E>(
        [low, high]: [f64; 2],
        (first, most, tolerance): (usize, usize, f64),
        mut function: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Table, E> {
        let at = |k: usize| low + (high - low) * (k as f64 / first as f64);
        let ends = (0..=first).map(|k| Ok([at(k), function(at(k))?])).collect::<Result<Vec<[f64; 2]>, E>>()?;
        let mut greatest = ends.iter().fold(0.0f64, |most, end| most.max(end[1]));
        let mut intervals: Vec<[[f64; 2]; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        // All intervals are halved once in each round, so that a limit on their number strikes all parts alike.
        let mut settled = Vec::new();
        for round in 0..=HALVINGS {
            let mut next = Vec::new();
            for [from, to] in intervals {
                let x = 0.5 * (from[0] + to[0]);
                let middle = [x, function(x)?];
                greatest = greatest.max(middle[1]);
                let off = (middle[1] - 0.5 * (from[1] + to[1])).abs();
                let room = settled.len() + next.len() < most;
                if off > tolerance * middle[1].max(FLOOR * greatest) && room && round < HALVINGS {
                    next.extend([[from, middle], [middle, to]]);
                } else {
                    // The middle is known by now.
                    settled.extend([from, middle]);
                }
            }
            intervals = next;
        }
        settled.extend(ends.last());
        settled.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Ok(Table { places: settled.iter().map(|p| p[0]).collect(), values: settled.iter().map(|p| p[1]).collect() })
    }

    /// The interval of a place, and how far into it.
    fn find(&self, place: f64) -> (usize, f64) {
        let last = self.places.len() - 2;
        let k = self.places.partition_point(|p| *p <= place).saturating_sub(1).min(last);
        let [from, to] = [self.places[k], self.places[k + 1]];
        (k, ((place - from) / (to - from)).clamp(0.0, 1.0))
    }

    fn at(&self, place: f64) -> f64 {
        let (k, part) = self.find(place);
        self.values[k] * (1.0 - part) + self.values[k + 1] * part
    }

    /// Places, values and weights for integrals over the interval `k`.
    fn gauss(&self, k: usize) -> impl Iterator<Item = [f64; 3]> {
        let ([from, to], [a, b]) = ([self.places[k], self.places[k + 1]], [self.values[k], self.values[k + 1]]);
        GAUSS
            .into_iter()
            .map(move |(part, weight)| [from + (to - from) * part, a * (1.0 - part) + b * part, weight * (to - from)])
    }
}

impl FacetTable {
    /// Samples a function of the angle between facet and surface.
    ///
    /// - `name`: for tables and messages.
    /// - `function`: area of facets per solid angle of their normals, of any unit, at an angle of 0..=π/2 radians.
    ///
    /// # Errors
    /// [`FacetError`], with the angle.
    pub fn new<E>(
        name: impl Into<String>,
        mut function: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<FacetTable, FacetError<E>> {
        let mut checked = |angle: f64| match function(angle) {
            Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
            Ok(value) => Err(FacetError::Value { angle, value }),
            Err(source) => Err(FacetError::Function { angle, source }),
        };
        let mut area = Table::sampled([0.0, FRAC_PI_2], (FIRST, MOST, TOLERANCE), &mut checked)?;
        // Of values that no sum could hold, parts of the greatest are enough.
        let most = area.values.iter().fold(0.0f64, |most, value| most.max(*value));
        let whole = area.values.iter().map(|value| value / most);
        if most == 0.0 {
            return Err(FacetError::Nothing);
        }
        area.values = whole.collect();
        let (mut greatest, mut misplaced) = (0.0f64, 0.0);
        for k in 0..area.places.len() - 1 {
            let [from, to] = [area.places[k], area.places[k + 1]];
            for part in MEASURED {
                let angle = from + (to - from) * part;
                let exact = checked(angle)? / most;
                let off = (area.at(angle) - exact).abs();
                greatest = greatest.max(off / exact.max(FLOOR));
                misplaced += off * PI * (2.0 * angle).sin() * 0.5 * (to - from);
            }
        }
        let all = total(&area);
        if !(all > 0.0 && all.is_finite()) {
            return Err(FacetError::Nothing);
        }
        let error = TableError { greatest, mean: misplaced / all, values: area.places.len() };
        area.values.iter_mut().for_each(|value| *value /= all);
        Ok(FacetTable::of(name.into(), area, error))
    }

    /// A table with an area that is scaled.
    fn of(name: String, area: Table, error: TableError) -> FacetTable {
        let mut sum = 0.0;
        let flux = |k: usize| area.gauss(k).map(|[angle, value, weight]| value * weight * PI * (2.0 * angle).sin());
        let parts = (0..area.places.len() - 1).map(|k| {
            sum += flux(k).sum::<f64>();
            sum
        });
        let mut below: Vec<f64> = std::iter::once(0.0).chain(parts).collect();
        below.iter_mut().for_each(|part| *part /= sum);
        let points: Vec<[f64; 3]> = (0..area.places.len() - 1)
            .flat_map(|k| area.gauss(k))
            .filter(|point| point[1] > 0.0)
            .map(|[angle, value, weight]| [angle.cos(), angle.sin(), value * weight * angle.sin() / sum])
            .collect();
        let seen = |cosine: f64| Ok::<_, std::convert::Infallible>(shown(&points, cosine));
        let shown = match Table::sampled([0.0, 1.0], SHOWN, seen) {
            Ok(table) => table,
            Err(never) => match never {},
        };
        FacetTable { name, area, below, shown, error }
    }

    /// How well the table stands for its function.
    pub fn error(&self) -> TableError {
        self.error
    }

    /// The area that the facets show to a direction of a cosine: at least that.
    pub(super) fn projected(&self, cosine: f64) -> f64 {
        self.shown.at(cosine).max(cosine)
    }

    /// Area of the facets with a normal along a direction of any length, 1/sr; 0 below the horizon.
    pub(super) fn area(&self, half: DVec3) -> f64 {
        if half.z > 0.0 { self.area.at(angle(half)) } else { 0.0 }
    }

    /// The normal of a facet; about as many of each angle as their area times cosine tells.
    pub(super) fn normal(&self, point: [f64; 2]) -> DVec3 {
        let k = self.below.partition_point(|below| *below <= point[0]).saturating_sub(1).min(self.below.len() - 2);
        let inside = ((point[0] - self.below[k]) / (self.below[k + 1] - self.below[k])).clamp(0.0, 1.0);
        // Even in the square of the sine is a pdf with the cosine.
        let [from, to] = [k, k + 1].map(|k| self.area.places[k].sin().powi(2));
        let square = (from + (to - from) * inside).clamp(0.0, 1.0);
        let (sin, cos) = (TAU * point[1]).sin_cos();
        let sine = square.sqrt();
        DVec3::new(sine * cos, sine * sin, (1.0 - square).sqrt())
    }

    /// The pdf of [`FacetTable::normal`], 1/sr.
    ///
    /// - `normal`: unit length.
    pub(super) fn normal_pdf(&self, normal: DVec3) -> f64 {
        let (k, _) = self.area.find(angle(normal));
        let [from, to] = [k, k + 1].map(|k| self.area.places[k].sin().powi(2));
        (self.below[k + 1] - self.below[k]) / (PI * (to - from)) * normal.z.max(0.0)
    }

    /// The roughness m of GGX's facets that show as much to the horizon: half of m.
    pub(in crate::illumination) fn roughness(&self) -> f64 {
        (2.0 * self.projected(0.0)).clamp(LEAST_ROUGHNESS, MOST_ROUGHNESS)
    }
}

/// Integral of a table of areas times the cosine over the hemisphere.
fn total(area: &Table) -> f64 {
    let intervals = (0..area.places.len() - 1).flat_map(|k| area.gauss(k));
    intervals.map(|[angle, value, weight]| value * weight * PI * (2.0 * angle).sin()).sum()
}

/// The area that facets show to a direction: of each angle the integral of the positive cosine over the azimuth.
///
/// - `points`: cosine and sine of the angle, and the area for each radian of azimuth.
fn shown(points: &[[f64; 3]], cosine: f64) -> f64 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let of = |&[upright, aside, area]: &[f64; 3]| {
        let (level, swing) = (cosine * upright, sine * aside);
        if level >= swing {
            return area * TAU * level;
        }
        let limit = (-level / swing).acos();
        area * 2.0 * (level * limit + swing * limit.sin())
    };
    points.iter().map(of).sum()
}

impl Distribution for FacetTable {
    fn name(&self) -> &str {
        &self.name
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        let [l, v] = [light, view].map(|towards| self.projected(towards.z));
        // Both sides divided by the area that is shown to the light: as Microfacet has it.
        let weight = view.z / (view.z * l + light.z * (v - view.z));
        weight * self.area.at(angle(light + view)) / 4.0
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        let normal = self.normal(point);
        (normal * (2.0 * normal.dot(light)) - light).try_normalize().filter(|view| view.z > 0.0)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        let half = light + view;
        // The solid angle of the viewer is 4 (L·H) times that of the normal, and L·H half the length of L + V.
        let length = half.length();
        self.normal_pdf(half / length) / (2.0 * length)
    }
}

/// The angle of a direction from the normal.
fn angle(half: DVec3) -> f64 {
    half.truncate().length().atan2(half.z)
}

impl From<FacetTable> for Plain {
    fn from(FacetTable { name, area, error, .. }: FacetTable) -> Plain {
        Plain { name, angles: area.places, areas: area.values, error }
    }
}

impl TryFrom<Plain> for FacetTable {
    type Error = DistributionError;

    fn try_from(Plain { name, angles, areas, error }: Plain) -> Result<FacetTable, DistributionError> {
        let rises = angles.windows(2).all(|pair| pair[0] < pair[1]);
        let area = Table { places: angles, values: areas };
        let problem = if area.places.len() != area.values.len() || area.places.len() < 2 {
            "it has not one number for each angle"
        } else if !rises || area.places[0] != 0.0 || area.places.last() != Some(&FRAC_PI_2) {
            "its angles do not rise from 0 to a right angle"
        } else if area.values.iter().any(|value| !(*value >= 0.0 && value.is_finite())) {
            "a value is negative or not finite"
        } else if (total(&area) - 1.0).abs() > 1e-9 {
            "its area does not add up"
        } else {
            return Ok(FacetTable::of(name, area, error));
        };
        Err(DistributionError::Table { name, problem })
    }
}

#[cfg(test)]
mod tests {
    use super::super::measure::{check, emitted_share, light_at, reciprocity_residual};
    use super::super::{Microfacet, SlopeDistribution};
    use super::*;
    use crate::numeric::sampling::{RandomStream, cosine_hemisphere};
    use glam::DVec2;
    use std::convert::Infallible;

    fn table(function: impl Fn(f64) -> f64) -> FacetTable {
        FacetTable::new("typed", |angle| Ok::<_, Infallible>(function(angle))).expect("a table")
    }

    fn beckmann(m: f64) -> impl Fn(f64) -> f64 {
        move |angle: f64| 5.0 * (-(angle.tan() / m).powi(2)).exp() / angle.cos().powi(4).max(1e-60)
    }

    #[test]
    fn beckmanns_formula_agrees_with_the_shipped_one_to_the_stated_error() {
        for m in [0.01, 0.1, 0.3, 0.6] {
            let typed = table(beckmann(m));
            let shipped = Microfacet::new(SlopeDistribution::Beckmann, DVec2::splat(m)).expect("a roughness");
            let TableError { greatest, mean, values } = typed.error();
            assert!(greatest < 5e-4 && mean < 2e-4 && values < MOST, "{m}: {:?}", typed.error());
            for index in 0..2000 {
                let mut stream = RandomStream::new(3, index);
                let light = cosine_hemisphere(stream.point(), DVec3::Z);
                let Some(view) = shipped.sample(light, stream.point()) else { continue };
                let [a, b] = [typed.density(light, view), shipped.density(light, view)];
                let highest = SlopeDistribution::Beckmann.area(DVec3::Z, DVec2::splat(m)) / (4.0 * light.z.max(m));
                assert!((a - b).abs() <= (greatest + 1e-4) * b.max(1e-5 * highest), "{m}: {a} {b} {light} {view}");
            }
        }
    }

    #[test]
    fn no_furnace_is_brighter_than_white_whatever_the_facets() {
        type Function = Box<dyn Fn(f64) -> f64>;
        let functions: [(&str, Function); 5] = [
            ("Beckmann", Box::new(beckmann(0.3))),
            ("GGX", Box::new(|angle: f64| (angle.cos().powi(2) + (angle.sin() / 0.4).powi(2)).powi(-2))),
            ("even", Box::new(|_| 1.0)),
            ("a ring", Box::new(|angle: f64| (-((angle - 0.5) / 0.02).powi(2)).exp())),
            ("a step", Box::new(|angle: f64| if angle < 0.2 { 1e300 } else { 0.0 })),
        ];
        for (name, function) in functions {
            let table = table(function);
            check(&table, 2000, 1).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(reciprocity_residual(&table, 2000, 2) < 1e-9, "{name}");
            for degrees in [0.0f64, 30.0, 60.0, 80.0, 89.0] {
                let share = emitted_share(&table, light_at(degrees.to_radians()), 1e-4, 200_000);
                assert!(share.value < 1.0 + 1e-3 && share.value > 0.2, "{name} {degrees}: {share:?}");
            }
        }
        // Smooth facets lose nothing when they are looked at straight.
        let share = emitted_share(&table(beckmann(0.05)), light_at(0.0), 1e-5, 200_000);
        assert!((share.value - 1.0).abs() < 1e-3, "{share:?}");
    }

    #[test]
    fn functions_that_are_no_distributions_are_refused_with_the_angle() {
        let refused = |function: fn(f64) -> Result<f64, String>| {
            FacetTable::new("typed", function).expect_err("it is none").to_string()
        };
        let below = FRAC_PI_2 * (163.0 / 256.0);
        let expected = format!("it is {} at an angle of {below}: it must be finite and not negative", 1.0 - below);
        assert_eq!(refused(|angle| Ok(1.0 - angle)), expected);
        assert!(refused(|angle| Ok(1.0 / angle)).starts_with("it is inf at an angle of 0"));
        assert!(refused(|_| Ok(f64::NAN)).starts_with("it is NaN at an angle of 0"));
        assert!(refused(|_| Ok(0.0)).contains("0 at all angles"));
        assert!(refused(|angle| if angle > 1.0 { Err("broken".into()) } else { Ok(1.0) }).ends_with(": broken"));
    }

    #[test]
    fn a_table_comes_back_as_it_was_written_and_a_damaged_one_does_not() {
        let whole = table(beckmann(0.2));
        let mut json = serde_json::to_value(&whole).expect("plain data");
        assert_eq!(serde_json::from_value::<FacetTable>(json.clone()).expect("the same"), whole);
        json["areas"][3] = (-1.0).into();
        assert!(serde_json::from_value::<FacetTable>(json).is_err());
    }
}
