//! The numbers of a tree, one row each.

use crate::procedural::Varied;

/// Most levels of stems: a trunk, boughs, branches and twigs.
pub const MOST_STEM_LEVELS: usize = 4;

/// A number of a tree, as files and scripts name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeParameter {
    /// Its name.
    pub name: &'static str,
    /// What it may be at the least and at the most.
    pub range: [f64; 2],
    /// What it is where nobody says so: one number for a tree as a whole, one for each level of stems.
    pub defaults: &'static [f64],
    /// What it is, in a line.
    pub summary: &'static str,
}

/// Makes an enumeration of numbers and the table of their rows.
macro_rules! tree_numbers {
    ($(#[doc = $doc:literal])* $kind:ident $(#[doc = $table_doc:literal])* $table:ident:
        $($number:ident $name:literal $defaults:expr, $range:expr, $summary:literal;)*) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum $kind {
            $($number,)*
        }

        $(#[doc = $table_doc])*
        pub const $table: &[TreeParameter] = &[
            $(TreeParameter { name: $name, range: $range, defaults: &$defaults, summary: $summary },)*
        ];
    };
}

tree_numbers! {
    /// A number of a tree as a whole.
    TreeNumber
    /// The numbers of a tree as a whole: drawn once for each tree.
    TREE_PARAMETERS:
    Height "height" [10.0], [1e-6, 1e6], "length of the trunk from the ground to its tip, units of length, or metres in species";
    Levels "levels" [3.0], [1.0, 4.0], "levels of stems: 1 is a trunk, 2 has boughs, 3 branches, 4 twigs";
    Base "base" [0.25], [0.0, 0.99], "part of the trunk that has no boughs";
    Ratio "ratio" [0.02], [1e-6, 1.0], "radius of the trunk, in parts of its length";
    RatioPower "ratio_power" [1.2], [0.0, 10.0], "radius of a stem in that of the one that bears it: the power of their lengths";
    Flare "flare" [0.5], [0.0, 10.0], "how much wider the trunk is at the ground, in parts of its radius";
    Lobes "lobes" [0.0], [0.0, 30.0], "waves around the trunk";
    LobeDepth "lobe_depth" [0.0], [0.0, 0.9], "their depth, in parts of its radius";
    BaseSplits "base_splits" [0.0], [0.0, 20.0], "how often the trunk forks at the end of its first segment";
    Attraction "attraction" [0.0], [-20.0, 20.0], "how branches and twigs bend up, or down below 0";
    PruneRatio "prune_ratio" [0.0], [0.0, 1.0], "how far what is outside of the envelope is cut back: 0 not at all, 1 wholly";
    PruneWidth "prune_width" [0.5], [1e-3, 10.0], "radius of the envelope, in parts of the height";
    PrunePeak "prune_peak" [0.5], [0.0, 1.0], "where the envelope is widest, in parts of the crown from below";
    PruneLow "prune_low" [0.5], [0.0, 10.0], "power of the curve of the envelope below that";
    PruneHigh "prune_high" [0.5], [0.0, 10.0], "power of the curve of the envelope above that";
    Trunks "trunks" [1.0], [1.0, 1000.0], "trunks, or stalks, side by side";
    Spread "spread" [0.0], [0.0, 1000.0], "radius of the circle on which they stand, in parts of the height";
    Lean "lean" [0.0], [0.0, 90.0], "how far those at the edge of the circle lean outwards, degrees";
    Flat "flat" [0.0], [0.0, 1.0], "1: stems are blades without thickness, as of grass, and the ratio is half their width";
}

tree_numbers! {
    /// A number of a level of stems.
    StemNumber
    /// The numbers of each level of stems, from the trunk on: what varies differs from stem to stem.
    STEM_PARAMETERS:
    Length "length" [1.0, 0.4, 0.5, 0.4], [0.0, 10.0], "of the trunk in parts of the height; of others in parts of the stem that bears them";
    Taper "taper" [1.1, 1.0, 1.0, 1.0], [0.0, 3.0], "0 a cylinder, 1 a cone, 2 a cylinder with a round end, 3 a row of balls; between them mixtures";
    Segments "segments" [8.0, 6.0, 4.0, 3.0], [1.0, 64.0], "pieces of the stem, between which it bends";
    Curve "curve" [0.0, 0.0, 0.0, 0.0], [-2000.0, 2000.0], "how far the stem bends in all, degrees; what varies is drawn for each segment";
    CurveBack "curve_back" [0.0, 0.0, 0.0, 0.0], [-2000.0, 2000.0], "if not 0, how far its second half bends, and `curve` is of the first";
    Helix "helix" [0.0, 0.0, 0.0, 0.0], [-89.0, 89.0], "angle of a screw along which it winds, degrees; 0 for none";
    Splits "splits" [0.0, 0.0, 0.0, 0.0], [0.0, 4.0], "forks at each segment";
    SplitAngle "split_angle" [0.0, 0.0, 0.0, 0.0], [-180.0, 180.0], "of forks, degrees";
    DownAngle "down_angle" [0.0, 60.0, 45.0, 45.0], [-180.0, 180.0], "between the stem and the one that bears it, degrees";
    DownSlope "down_slope" [0.0, 0.0, 0.0, 0.0], [-180.0, 180.0], "by how much that is more where the bearing stem ends than where it begins, degrees";
    Rotate "rotate" [0.0, 137.5, 137.5, 137.5], [-360.0, 360.0], "turn from one stem to the next around the one that bears them, degrees; below 0 they stand on both sides in turn";
    Branches "branches" [0.0, 40.0, 15.0, 8.0], [0.0, 10000.0], "stems of this level on each of the level before";
}

/// How many numbers a tree has as a whole, and each level of its stems.
const COUNTS: [usize; 2] = [TREE_PARAMETERS.len(), STEM_PARAMETERS.len()];

/// The numbers of a tree: means with largest deviations.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeNumbers {
    tree: [Varied; COUNTS[0]],
    stems: [[Varied; COUNTS[1]]; MOST_STEM_LEVELS],
}

/// A reason for which a number of a tree is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TreeNumberError {
    /// No such number.
    #[error("a tree has no number \"{name}\"; {advice}")]
    Unknown {
        /// The name that was looked for.
        name: String,
        /// Names that it may have meant.
        advice: String,
    },
    /// Some of what may be drawn is out of range.
    #[error("{name} {least} to {most} is not within {low} to {high}")]
    Range {
        /// The name.
        name: &'static str,
        /// The least that may be drawn.
        least: f64,
        /// The most that may be drawn.
        most: f64,
        /// The least that it may be.
        low: f64,
        /// The most that it may be.
        high: f64,
    },
    /// More levels than there are.
    #[error("{name} has {count} numbers; there are {MOST_STEM_LEVELS} levels of stems")]
    Levels {
        /// The name.
        name: &'static str,
        /// How many.
        count: usize,
    },
    /// A deviation or mean that is none.
    #[error("{name}: {problem}")]
    Varied {
        /// The name.
        name: &'static str,
        /// What is wrong.
        problem: crate::procedural::VariedError,
    },
}

impl Default for TreeNumbers {
    fn default() -> TreeNumbers {
        let varied = |mean: f64| Varied { mean, deviation: 0.0 };
        TreeNumbers {
            tree: std::array::from_fn(|k| varied(TREE_PARAMETERS[k].defaults[0])),
            stems: std::array::from_fn(|level| std::array::from_fn(|k| varied(STEM_PARAMETERS[k].defaults[level]))),
        }
    }
}

impl TreeNumbers {
    /// Sets a number by its name: one of a tree as a whole, one of all levels of stems, or, with the number of the level
    /// behind it as in `length_1`, of one level.
    ///
    /// - `values`: one, or one for each level of stems from the trunk on; further levels keep what they have.
    ///
    /// # Errors
    /// [`TreeNumberError`].
    pub fn set(&mut self, name: &str, values: &[Varied]) -> Result<(), TreeNumberError> {
        if let Some(k) = TREE_PARAMETERS.iter().position(|row| row.name == name) {
            let row = &TREE_PARAMETERS[k];
            let [value] = values else {
                return Err(TreeNumberError::Levels { name: row.name, count: values.len() });
            };
            self.tree[k] = checked(row, *value)?;
            return Ok(());
        }
        let digit = |last: &str| last.parse::<usize>().ok().filter(|_| last.len() == 1);
        let (stem, level) = match name.rsplit_once('_').map(|(stem, last)| (stem, digit(last))) {
            Some((stem, Some(level))) => (stem, Some(level)),
            _ => (name, None),
        };
        let place = STEM_PARAMETERS.iter().position(|row| row.name == stem);
        let Some(k) = place.filter(|_| level.is_none_or(|level| level < MOST_STEM_LEVELS)) else {
            let known: Vec<&str> = TREE_PARAMETERS.iter().chain(STEM_PARAMETERS).map(|row| row.name).collect();
            return Err(TreeNumberError::Unknown { name: name.into(), advice: crate::spelling::advice(name, &known) });
        };
        let row = &STEM_PARAMETERS[k];
        let most = if level.is_some() { 1 } else { MOST_STEM_LEVELS };
        if values.is_empty() || values.len() > most {
            return Err(TreeNumberError::Levels { name: row.name, count: values.len() });
        }
        for (place, value) in values.iter().enumerate() {
            self.stems[level.unwrap_or(place)][k] = checked(row, *value)?;
        }
        Ok(())
    }

    /// A number of a tree as a whole by the place of its row.
    pub(super) fn tree_by_place(&self, place: usize) -> Varied {
        self.tree[place]
    }

    /// A number of a level of stems.
    pub(super) fn stem(&self, level: usize, number: StemNumber) -> Varied {
        self.stems[level][number as usize]
    }
}

/// A number of a row, all of which is in range.
fn checked(row: &TreeParameter, value: Varied) -> Result<Varied, TreeNumberError> {
    value.check().map_err(|problem| TreeNumberError::Varied { name: row.name, problem })?;
    let [least, most] = [value.mean - value.deviation, value.mean + value.deviation];
    let [low, high] = row.range;
    if least < low || most > high {
        return Err(TreeNumberError::Range { name: row.name, least, most, low, high });
    }
    Ok(value)
}
