//! Outlines of leaves and petals.

use glam::DVec2;

/// An outline by the right one of its two equal halves: corners from the base at the origin to the tip at (0, 1), y along
/// the midrib. The largest x is 1/2.
#[derive(Clone, Debug, PartialEq)]
pub struct BladeOutline(pub(super) Vec<DVec2>);

/// A reason for which an outline is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OutlineError {
    /// Too few or too many corners.
    #[error("an outline has {0} corners; there are 1 to {MOST_CORNERS} between its base and its tip")]
    Corners(usize),
    /// A corner beyond the midrib, or none that is off it.
    #[error("the corners of an outline are right of its midrib: x is above 0, and finite")]
    Side,
}

/// Most corners of an outline between its base and its tip.
const MOST_CORNERS: usize = 64;

/// Outlines by their names: corners between base and tip, x in the same unit as y, of a blade of length 1.
pub const OUTLINES: &[(&str, &[[f64; 2]])] = &[
    ("linear", &[[0.6, 0.04], [0.95, 0.2], [1.0, 0.45], [0.85, 0.72], [0.45, 0.92]]),
    ("needle", &[[1.0, 0.1], [1.0, 0.85]]),
    ("elliptic", &[[0.35, 0.06], [0.76, 0.2], [0.97, 0.38], [1.0, 0.52], [0.88, 0.7], [0.55, 0.87], [0.22, 0.96]]),
    ("lanceolate", &[[0.45, 0.04], [0.86, 0.15], [1.0, 0.3], [0.88, 0.5], [0.58, 0.72], [0.26, 0.89]]),
    ("ovate", &[[0.5, 0.02], [0.85, 0.12], [1.0, 0.28], [0.93, 0.46], [0.7, 0.66], [0.36, 0.84], [0.12, 0.94]]),
    ("obovate", &[[0.12, 0.06], [0.36, 0.24], [0.7, 0.46], [0.96, 0.68], [1.0, 0.8], [0.76, 0.93], [0.34, 0.99]]),
    ("cordate", &[[0.22, -0.1], [0.55, -0.11], [0.86, 0.02], [1.0, 0.22], [0.9, 0.44], [0.6, 0.68], [0.24, 0.88]]),
    ("deltoid", &[[0.45, 0.0], [0.9, 0.1], [1.0, 0.2], [0.8, 0.42], [0.5, 0.66], [0.18, 0.9]]),
    ("orbicular", &[[0.4, 0.03], [0.8, 0.18], [1.0, 0.45], [0.92, 0.7], [0.62, 0.9], [0.25, 0.98]]),
    (
        "oak",
        &[
            [0.2, 0.1],
            [0.42, 0.2],
            [0.5, 0.26],
            [0.32, 0.32],
            [0.66, 0.42],
            [0.76, 0.48],
            [0.46, 0.54],
            [0.9, 0.64],
            [1.0, 0.71],
            [0.64, 0.75],
            [0.86, 0.84],
            [0.8, 0.91],
            [0.46, 0.9],
            [0.36, 0.98],
        ],
    ),
    (
        "maple",
        &[
            [0.36, -0.02],
            [0.3, 0.1],
            [0.82, 0.05],
            [0.66, 0.17],
            [0.6, 0.25],
            [1.0, 0.36],
            [0.86, 0.42],
            [0.92, 0.53],
            [0.62, 0.53],
            [0.34, 0.5],
            [0.44, 0.66],
            [0.3, 0.72],
            [0.26, 0.82],
        ],
    ),
    (
        "toothed",
        &[
            [0.42, 0.06],
            [0.56, 0.1],
            [0.6, 0.14],
            [0.82, 0.2],
            [0.8, 0.25],
            [1.0, 0.34],
            [0.92, 0.39],
            [0.98, 0.5],
            [0.84, 0.53],
            [0.78, 0.66],
            [0.6, 0.68],
            [0.48, 0.8],
            [0.32, 0.82],
            [0.14, 0.93],
        ],
    ),
    ("petal", &[[0.3, 0.1], [0.7, 0.34], [1.0, 0.62], [0.95, 0.82], [0.66, 0.97], [0.3, 0.99]]),
    ("ray", &[[0.6, 0.1], [0.9, 0.35], [1.0, 0.6], [0.85, 0.85], [0.4, 0.97]]),
];

impl BladeOutline {
    /// An outline by its corners between base and tip.
    ///
    /// # Errors
    /// [`OutlineError`].
    pub fn new(corners: &[[f64; 2]]) -> Result<BladeOutline, OutlineError> {
        if !(1..=MOST_CORNERS).contains(&corners.len()) {
            return Err(OutlineError::Corners(corners.len()));
        }
        if !corners.iter().all(|[x, y]| *x > 0.0 && x.is_finite() && y.is_finite()) {
            return Err(OutlineError::Side);
        }
        let widest = corners.iter().map(|[x, _]| *x).fold(0.0, f64::max);
        let half = corners.iter().map(|[x, y]| DVec2::new(0.5 * x / widest, *y));
        Ok(BladeOutline(std::iter::once(DVec2::ZERO).chain(half).chain([DVec2::Y]).collect()))
    }

    /// An outline of [`OUTLINES`] by its name.
    pub fn named(name: &str) -> Option<BladeOutline> {
        OUTLINES.iter().find(|(known, _)| *known == name).and_then(|(_, corners)| BladeOutline::new(corners).ok())
    }

    /// The outline with fewer corners, as long as each takes less than an area away.
    ///
    /// - `area`: in squares of the length of the midrib.
    ///
    /// # Source
    /// Visvalingam and Whyatt 1993.
    pub(super) fn simplified(&self, area: f64) -> Vec<DVec2> {
        let mut corners = self.0.clone();
        while corners.len() > 3 {
            let lost =
                |at: usize| 0.5 * (corners[at] - corners[at - 1]).perp_dot(corners[at + 1] - corners[at - 1]).abs();
            let least = (1..corners.len() - 1).map(|at| (at, lost(at))).min_by(|a, b| a.1.total_cmp(&b.1));
            match least {
                Some((at, lost)) if lost < area => corners.remove(at),
                _ => break,
            };
        }
        // A blade of one corner a side keeps its width only if that is where the blade is widest.
        let widest = self.0.iter().copied().max_by(|a, b| a.x.total_cmp(&b.x));
        if let ([_, middle, _], Some(widest)) = (&mut corners[..], widest) {
            *middle = widest;
        }
        corners
    }
}
