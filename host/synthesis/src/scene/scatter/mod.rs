//! Instances by chance: where the surface of an object has them, how they stand, and how large they are.
//!
//! There are three ways to know them. Where all places of a surface count, each part of it has as many as its area tells,
//! and a part is known without the others ([`ScatterParts`]). Where distance, slope, height or density rules some out,
//! places are tried in turn ([`FoundPlaces`]). On a level ground they may be a function of a cell ([`ScatterCells`]).

mod air;
mod standing;
mod surface;
mod places;
mod parts;
mod cells;

#[cfg(test)]
mod tests;

pub(super) use cells::{PlacedGrid, ScatterCells};
pub(super) use parts::ScatterParts;
pub(super) use places::FoundPlaces;

use super::object::{Scatter, Shape, Sway};
use super::settings::check_aggregate;
use crate::octree::{MOST_CELLS, MOST_IN_CELL, MOST_INSTANCES};

impl Scatter {
    /// Whether every place counts.
    pub(super) fn takes_all(&self) -> bool {
        let everywhere = self.slope[0] <= 0.0 && self.slope[1] >= 180.0;
        let all_heights = self.height == [f64::NEG_INFINITY, f64::INFINITY];
        let is_full = !self.density.is_varying() && self.density.mean() >= 1.0;
        everywhere && all_heights && is_full && self.distance <= 0.0
    }

    /// Checks every number; the problem in words.
    ///
    /// - `prototypes`: how many there are.
    pub(super) fn check(&self, prototypes: usize) -> Result<(), String> {
        self.on.check(false).map_err(|error| error.to_string())?;
        if let Shape::Curve(_) | Shape::HalfSpace { .. } | Shape::Instances(_) = self.on.shape {
            return Err(format!("{} has no surface of its own to scatter on", self.on.name));
        }
        self.density.check().map_err(|error| error.to_string())?;
        let Scatter { distance, cell, slope, height, scale, turn, lean, upright, sink, shares, .. } = self;
        let is_range = |[least, most]: &[f64; 2]| least <= most;
        let is_share = |share: &f64| *share >= 0.0 && share.is_finite();
        let rows = [
            ("distance", *distance >= 0.0 && distance.is_finite()),
            ("cell", cell.is_none_or(|side| side > 0.0 && side.is_finite())),
            ("slope", is_range(slope)),
            ("height", is_range(height)),
            ("scale", is_range(scale) && scale[0] > 0.0 && scale[1].is_finite()),
            ("turn", turn.is_finite()),
            ("lean", (0.0..90.0).contains(lean)),
            ("sink", sink.is_finite()),
            ("upright", (0.0..=1.0).contains(upright)),
            ("shares", shares.len() == prototypes && shares.iter().all(is_share)),
        ];
        if let Some(Sway { wind, time, lean }) = &self.sway {
            wind.check().map_err(|error| error.to_string())?;
            if !time.is_finite() || !(0.0..90.0).contains(lean) {
                return Err("sway is out of range".into());
            }
        }
        match rows.into_iter().find(|(_, is_sound)| !is_sound) {
            Some((what, _)) => Err(format!("{what} is out of range")),
            None => self.check_counts(),
        }
    }

    /// Checks how many there are, and where they are if they are in cells.
    fn check_counts(&self) -> Result<(), String> {
        let Scatter { on, count, distance, cell, aggregate, .. } = self;
        aggregate.map_or(Ok(()), check_aggregate)?;
        let Some(side) = *cell else {
            if aggregate.is_some() {
                return Err("aggregates stand in for what is in cells; tell the side of a cell".into());
            }
            let most = format!("more than {MOST_INSTANCES} instances; place groups of them");
            return if *count > MOST_INSTANCES { Err(most) } else { Ok(()) };
        };
        if *distance > 0.0 {
            return Err("a distance is not kept in cells, which know nothing of each other".into());
        }
        if *count > MOST_IN_CELL as usize {
            return Err(format!("more than {MOST_IN_CELL} instances in a cell; divide the cells"));
        }
        let Some(frame) = cells::GroundFrame::of(on) else {
            return Err(format!("cells lie on a ground that is not skewed, which {} is not", on.name));
        };
        let along = frame.size.max_element() / side;
        match along > f64::from(MOST_CELLS) {
            true => Err(format!("{along:.3e} cells along a side are more than {MOST_CELLS}; enlarge the cells")),
            false => Ok(()),
        }
    }
}
