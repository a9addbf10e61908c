//! Missing energy: what is lost of all light when facets have reflected and refracted once, and on which side it comes
//! back.

use super::super::context::ShadingContext;
use super::super::interface_losses::{InterfaceLosses, LossesOfRatio};
use super::albedo::{DirectionalAlbedos, InterfaceSide};
use super::surface::{PrincipledSurface, PrincipledValues, over};
use glam::DVec3;

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

    /// Diffuse value of what a transparent one misses, from the side of the light; its colour, and how radiance changes
    /// on the way through, are left out.
    ///
    /// Beside other media than air a coat is taken for none.
    pub(super) fn clear_spread(&self, at: &PrincipledValues, context: &ShadingContext, light: DVec3) -> f64 {
        let (view, cosine) = (context.view.z, light.z.abs());
        if self.is_alone(context, at.side) {
            let own = self.mean_missing(at, at.side).clear;
            let [stays, goes] = self.division(at, own);
            let from = self.missing(at, at.side, view).clear;
            let (part, side) = if light.z > 0.0 { (stays, at.side) } else { (goes, self.beyond(at)) };
            let to = self.missing(at, side, cosine).clear;
            return part * over(from * to, self.mean_missing(at, side).clear);
        }
        let Some(losses) = &self.beside_others else { return 0.0 };
        let ([own, other], goes) = between(losses, context);
        let (part, side) = if light.z > 0.0 { (1.0 - goes, own) } else { (goes, other) };
        part * over(own.lost(view) * side.lost(cosine), side.mean())
    }

    /// The parts of what a transparent one misses that stay on the side of the viewer, and that go through.
    pub(super) fn clear_shares(&self, at: &PrincipledValues, context: &ShadingContext) -> [f64; 2] {
        if self.is_alone(context, at.side) {
            let missing = self.missing(at, at.side, context.view.z).clear;
            return self.division(at, self.mean_missing(at, at.side).clear).map(|part| part * missing);
        }
        let Some(losses) = &self.beside_others else { return [0.0; 2] };
        let ([own, _], goes) = between(losses, context);
        let lost = own.lost(context.view.z);
        [(1.0 - goes) * lost, goes * lost]
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

/// What facets lose on the side of the viewer and on the other, and the part of it that goes through.
fn between<'a>(losses: &'a InterfaceLosses, context: &ShadingContext) -> ([LossesOfRatio<'a>; 2], f64) {
    let [before, behind] = [context.indices.before.0[0], context.indices.behind.0[0]];
    let [own, other] = [losses.between(before, behind), losses.between(behind, before)];
    ([own, other], own.part_through(&other, behind / before))
}
