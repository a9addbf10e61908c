//! The strip of surface inside a side of a hole: its curve, and the derivative across it that is wanted there.

use glam::{DVec2, DVec3};

use super::jet::Polynomial;
use super::{HoleError, HoleSide, parts_of};

/// A curve with a derivative across it.
#[derive(Clone, Copy, Debug)]
pub struct Ribbon {
    /// The curve.
    pub curve: Polynomial,
    /// The derivative across it.
    pub across: Polynomial,
}

impl Ribbon {
    /// The ribbon inside a side of a hole, with some derivatives across at both ends.
    ///
    /// The derivative across is a combination of the surrounding patch's and of the curve's own, with factors that are
    /// linear: it lies in the tangent plane of the patch all along.
    pub fn inside(side: &HoleSide, place: usize, ends: [DVec3; 2]) -> Result<Ribbon, HoleError> {
        let (curve, outer) = (Polynomial::cubic(side.curve), Polynomial::cubic(side.across));
        let tangent = curve.derivative();
        let factors = |t: f64, wanted: DVec3, at: usize| -> Result<DVec2, HoleError> {
            let parts = parts_of(wanted, [outer.at(t), tangent.at(t)]).ok_or(HoleError::Corner { side: at })?;
            // Above 0: into the hole.
            if parts.x > 0.0 { Ok(parts) } else { Err(HoleError::Folded { side: at }) }
        };
        let [from, to] = [factors(0.0, ends[0], place)?, factors(1.0, ends[1], place + 1)?];
        let across = outer.times([from.x, to.x]).plus(&tangent.times([from.y, to.y]));
        Ok(Ribbon { curve, across })
    }

    /// This ribbon from its other end.
    pub fn reversed(&self) -> Ribbon {
        Ribbon { curve: self.curve.reversed(), across: self.across.reversed() }
    }
}
