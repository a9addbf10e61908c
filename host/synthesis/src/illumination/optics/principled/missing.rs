//! Missing energy: what is lost of all light when facets have reflected and refracted once, and on which side it comes
//! back.

use super::super::context::ShadingContext;
use super::albedo::{DirectionalAlbedos, InterfaceSide};
use super::surface::{PrincipledSurface, PrincipledValues};

/// The part of all light that is lost when facets have reflected and refracted once.
#[derive(Clone, Copy)]
pub(super) struct MissingEnergy {
    pub(super) opaque: f64,
    pub(super) metal: f64,
    /// The missing energy of a transparent one, on the side that is meant.
    pub(super) clear: f64,
}

impl PrincipledSurface {
    /// The missing energy at a cosine on a side.
    pub(super) fn missing(&self, at: &PrincipledValues, seen: InterfaceSide, cosine: f64) -> MissingEnergy {
        let [outside, side] = match seen {
            InterfaceSide::Outside => [self.albedo.at(seen, cosine); 2],
            InterfaceSide::Inside => [InterfaceSide::Outside, seen].map(|seen| self.albedo.at(seen, cosine)),
        };
        self.missing_of(at, seen, &outside, &side)
    }

    /// The mean of [`PrincipledSurface::missing`] over all directions, weighted with the cosine.
    pub(super) fn mean_missing(&self, at: &PrincipledValues, seen: InterfaceSide) -> MissingEnergy {
        self.missing_of(at, seen, self.albedo.mean(InterfaceSide::Outside), self.albedo.mean(seen))
    }

    /// - `outside`: shares from outside. `side`: those on the side that is meant.
    pub(super) fn missing_of(
        &self,
        at: &PrincipledValues,
        seen: InterfaceSide,
        outside: &DirectionalAlbedos,
        side: &DirectionalAlbedos,
    ) -> MissingEnergy {
        let s = at.specular;
        // From inside, what is no transparent body has no coat.
        let c = if seen == InterfaceSide::Outside { at.coat } else { 0.0 };
        let metal = 1.0 - outside.all - c * (outside.coat - outside.all_coat);
        let opaque = 1.0 - s * outside.reflected - c * (outside.coat - s * outside.reflected_coat);
        let under_coat = match seen {
            InterfaceSide::Outside => side.coat - side.sent_coat,
            InterfaceSide::Inside => -side.sent_coat,
        };
        let clear = if self.thin { metal } else { 1.0 - side.sent - at.coat * under_coat };
        MissingEnergy { opaque: opaque.max(0.0), metal: metal.max(0.0), clear: clear.max(0.0) }
    }

    /// Whether the media on both sides are those for which the tables were made.
    pub(super) fn is_alone(&self, context: &ShadingContext, seen: InterfaceSide) -> bool {
        let [before, behind] = [context.indices.before.0[0], context.indices.behind.0[0]];
        match seen {
            _ if self.thin => true,
            InterfaceSide::Outside => before == 1.0 && behind == self.index,
            InterfaceSide::Inside => before == self.index && behind == 1.0,
        }
    }

    /// The side of the interface on which transmitted light goes on.
    pub(super) fn beyond(&self, at: &PrincipledValues) -> InterfaceSide {
        match at.side {
            InterfaceSide::Outside if !self.thin => InterfaceSide::Inside,
            _ => InterfaceSide::Outside,
        }
    }

    /// How what a transparent surface misses is divided: what stays on the side of the viewer, and what goes through.
    ///
    /// Of the mean parts a and b that are missing on the two sides, (1 − F) min(a, b) / a goes through from the one
    /// with the mean F of Fresnel's term: with it, light that goes to and fro is the same but for the square of the
    /// index.
    ///
    /// - `own`: the mean of what is missing on the side of the viewer.
    pub(super) fn division(&self, at: &PrincipledValues, own: f64) -> [f64; 2] {
        let fresnel = self.albedo.fresnel(at.side, self.thin);
        let other = self.mean_missing(at, self.beyond(at)).clear;
        let goes = if own > 0.0 { (1.0 - fresnel) * (other / own).min(1.0) } else { 0.0 };
        [1.0 - goes, goes]
    }
}
