//! Error floors: where a knob has done what it can, the error stays while the run time grows.

use super::measure::{CLEAR, ErrorMeasures};
use serde::Serialize;

/// What falls by less than to this part of its square, while the knob goes from one setting to the last, stays.
const STAYS: f64 = 0.6;
/// Bias that is a smaller part of the squared error than this is none.
const LITTLE: f64 = 0.1;
/// Bias that is a greater part of it is most of the error.
const MOST: f64 = 0.5;

/// The floor that an error has from some setting on.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorFloor {
    /// Bias that this knob does not lower.
    ///
    /// From the setting up to the last, the squared bias is more than half of the squared error and more than three of
    /// its own standard errors, and the last is more than 0.6 of the first.
    Bias {
        /// The first such setting, by its number.
        from: usize,
        /// Other knobs that lower it, and by which part of its square; the first does most.
        causes: Vec<(String, f64)>,
    },
    /// Noise that this knob does not lower.
    ///
    /// From the setting up to the last, the squared bias is less than a tenth of the squared error or less than three
    /// of its standard errors, and the last squared error is more than 0.6 of the first.
    #[serde(rename = "chance")]
    Noise {
        /// The first such setting, by its number.
        from: usize,
    },
    /// The error is least at a setting before the last, and grows beyond.
    ///
    /// Its square there is less than 0.6 of the last.
    Least {
        /// That setting, by its number.
        at: usize,
    },
}

/// Finds the floor of the errors of settings, from the coarsest to the finest; two are no curve.
///
/// - `reference`: root mean squared error of the reference, which is in all of them.
pub(super) fn error_floor(measured: &[ErrorMeasures], reference: f64) -> Option<ErrorFloor> {
    let last = measured.last().filter(|_| measured.len() > 2)?;
    let excess = |m: &ErrorMeasures| (m.rmse * m.rmse - reference * reference).max(0.0);
    let is_bias = |m: &ErrorMeasures| m.is_clear() && m.bias_squared > MOST * excess(m);
    let is_chance = |m: &ErrorMeasures| {
        m.noise > 0.0 && m.bias_squared <= f64::max(CLEAR * m.bias_squared_error, LITTLE * excess(m))
    };
    let first = |holds: &dyn Fn(&ErrorMeasures) -> bool, stays: &dyn Fn(&ErrorMeasures) -> bool| {
        let from = measured.iter().rposition(|m| !(holds(m) && stays(m))).map_or(0, |index| index + 1);
        (from + 1 < measured.len()).then_some(from)
    };
    let least = (0..measured.len()).min_by(|one, two| measured[*one].rmse.total_cmp(&measured[*two].rmse))?;
    if measured[least].rmse.powi(2) < STAYS * last.rmse.powi(2) {
        return Some(ErrorFloor::Least { at: least });
    }
    let bias = first(&is_bias, &|m| last.bias_squared > STAYS * m.bias_squared);
    let chance = || first(&is_chance, &|m| excess(last) > STAYS * excess(m));
    bias.map(|from| ErrorFloor::Bias { from, causes: Vec::new() })
        .or_else(|| chance().map(|from| ErrorFloor::Noise { from }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measures(bias: f64, noise: f64) -> ErrorMeasures {
        let (bias_squared, bias_squared_error) = (bias * bias, noise * noise / 100.0);
        let rmse = bias.hypot(noise);
        ErrorMeasures { rmse, noise, bias_squared, bias_squared_error, relative_mse: 0.0, flip: 0.0 }
    }

    #[test]
    fn chance_that_falls_bends_where_it_meets_the_bias() {
        let samples: Vec<ErrorMeasures> = (0..8).map(|i| measures(0.01, 0.1 / 2f64.powi(i))).collect();
        // 0.1 / 16 is the first that is below 0.01.
        assert_eq!(error_floor(&samples, 0.0), Some(ErrorFloor::Bias { from: 4, causes: Vec::new() }));
    }

    #[test]
    fn a_bias_that_falls_bends_where_it_goes_down_in_chance() {
        let depth: Vec<ErrorMeasures> = [0.5, 0.1, 0.02, 0.001, 0.0].iter().map(|bias| measures(*bias, 0.01)).collect();
        assert_eq!(error_floor(&depth, 0.0), Some(ErrorFloor::Noise { from: 3 }));
    }

    #[test]
    fn what_falls_to_the_end_has_no_bend() {
        let samples: Vec<ErrorMeasures> = (0..6).map(|i| measures(0.0, 0.1 / 2f64.powi(i))).collect();
        assert_eq!(error_floor(&samples, 0.0), None);
        let tolerance: Vec<ErrorMeasures> = (0..6).map(|i| measures(0.1 / 3f64.powi(i), 0.0)).collect();
        assert_eq!(error_floor(&tolerance, 0.0), None);
        assert_eq!(error_floor(&[], 0.0), None);
    }

    #[test]
    fn what_falls_and_grows_again_is_least_in_between() {
        let filter: Vec<ErrorMeasures> = [0.3, 0.2, 0.1, 0.4].iter().map(|bias| measures(*bias, 0.0)).collect();
        assert_eq!(error_floor(&filter, 0.0), Some(ErrorFloor::Least { at: 2 }));
    }
}
