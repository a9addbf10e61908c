//! The instant at which a plant is seen: its age, and the season.

/// The instant at which a plant is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantInstant {
    /// The part of its growth that is over, 0 to 1.
    pub age: f64,
    /// The time of the year in parts of it: 0 is midwinter, 0.25 the beginning of spring, 0.5 midsummer. Whole numbers do
    /// not count.
    pub season: f64,
}

impl Default for PlantInstant {
    /// Grown up, in summer.
    fn default() -> PlantInstant {
        PlantInstant { age: 1.0, season: 0.5 }
    }
}

impl PlantInstant {
    /// The part of the year that is over, 0..1.
    pub fn part_of_year(&self) -> f64 {
        self.season.rem_euclid(1.0)
    }
}

/// A curve from 0 to 1 with level ends: 3 t² - 2 t³, its ends beyond 0 and 1.
pub(super) fn eased(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// How far a part that is born at a time of a plant's growth has grown, 0 to 1.
pub(super) fn grown(age: f64, birth: f64) -> f64 {
    if birth >= 1.0 { 0.0 } else { eased((age - birth) / (1.0 - birth)) }
}
