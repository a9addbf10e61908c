//! Rough interfaces between transparent media: ground glass, and what facets send on to each other.

use super::context::{BsdfSample, ShadingContext};
use super::dielectric::{by_lane, chance_of, interface, radiance_scale, reflected};
use super::interface_losses::{InterfaceLosses, LossesOfRatio, masking};
use super::lobe::{Flags, Lobe};
use crate::color::Channels;
use crate::illumination::distribution::RoughFacets;
use crate::numeric::sampling::around_z;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// The largest chance to sample what facets send on to each other: one reflection or refraction keeps some.
const MOST_CHANCE: f64 = 0.95;
/// Less than this is not sampled.
const LEAST_LOSS: f64 = 1e-9;

/// A rough interface, of facets that each reflect and refract.
///
/// What one reflection or refraction loses of light from everywhere, a(V) on the side of the viewer and b on the other,
/// leaves after further ones: a(V) a(L) (1 − t) / (π ā) above and a(V) b(L) t / (π b̄) below, with the means ā and b̄ and
/// the part t that goes through. Seen from both sides it is the same but for the square of the index, and reflected and
/// refracted light add up to all that comes.
///
/// # Source
/// Walter and others 2007; the compensation after Kelemen and Szirmay-Kalos 2001 and Kulla and Conty 2017, its division
/// between the two sides is ours.
#[derive(Clone, Debug)]
pub(super) struct RoughDielectric {
    facets: RoughFacets,
    is_correlated: bool,
    /// None where light is reflected or refracted once.
    losses: Option<Arc<InterfaceLosses>>,
}

/// What is missing at a direction of the viewer, in one lane.
struct Missing<'a> {
    /// a(V)
    own: f64,
    /// The parts that leave above and below.
    parts: [f64; 2],
    /// The losses on both sides; none where nothing is missing.
    sides: Option<[LossesOfRatio<'a>; 2]>,
}

impl RoughDielectric {
    /// - `is_correlated`: whether heights of light and viewer are. `multiple`: whether facets send light on to others.
    pub(super) fn new(facets: RoughFacets, is_correlated: bool, multiple: bool) -> RoughDielectric {
        let losses = multiple.then(|| Arc::new(InterfaceLosses::new(facets.clone(), is_correlated)));
        RoughDielectric { facets, is_correlated, losses }
    }

    /// This interface, with tables that are ready where it meets air.
    ///
    /// - `indices`: those of the medium behind.
    pub(super) fn prepared(self, indices: impl IntoIterator<Item = f64>) -> RoughDielectric {
        if let Some(losses) = &self.losses {
            losses.prepare(indices);
        }
        self
    }

    /// The chance that a facet is taken to reflect.
    fn chance(&self, context: &ShadingContext, cosine: f64) -> f64 {
        let fraction = interface(context, context.lane).map_or(1.0, |surface| surface.reflectance(cosine).mean());
        chance_of(fraction, 1.0 - fraction)
    }

    /// The facet that would send light to the viewer, through or not, on the side of the viewer.
    fn facet(&self, context: &ShadingContext, light: DVec3, lane: usize) -> Option<DVec3> {
        let view = context.view;
        let facet = if light.z > 0.0 {
            light + view
        } else {
            // Along −(n_before V + n_behind L); towards the viewer, whichever index is greater.
            let (before, behind) = (context.indices.before.0[lane], context.indices.behind.0[lane]);
            let facet = -(view * before + light * behind);
            if facet.z < 0.0 { -facet } else { facet }
        };
        let facet = facet.try_normalize()?;
        let sees = facet.dot(view) > 0.0 && (light.z > 0.0 || facet.dot(light) < 0.0);
        (sees && facet.z > 0.0).then_some(facet)
    }

    /// How much of the directions around a facet goes to one solid angle of light.
    fn jacobian(&self, context: &ShadingContext, light: DVec3, facet: DVec3, lane: usize) -> f64 {
        let (to_view, to_light) = (facet.dot(context.view), facet.dot(light));
        if light.z > 0.0 {
            return 0.25 / to_light;
        }
        let ratio = context.indices.before.0[lane] / context.indices.behind.0[lane];
        let sum = to_light + ratio * to_view;
        to_light.abs() / (sum * sum)
    }

    /// The value by one reflection or refraction.
    ///
    /// # Source
    /// Walter et al. 2007, equations 20 and 21; heights of light and viewer correlated.
    fn once(&self, context: &ShadingContext, light: DVec3) -> Channels {
        let view = context.view;
        let is_through = light.z < 0.0;
        let above = DVec3::new(light.x, light.y, light.z.abs());
        let shown = [view, above].map(|towards| self.facets.projected(towards));
        let masked = masking([view.z, above.z], shown, is_through, self.is_correlated);
        by_lane(context, |lane| {
            let Some((facet, surface)) = self.facet(context, light, lane).zip(interface(context, lane)) else {
                return 0.0;
            };
            let cosine = facet.dot(view);
            let shared = self.facets.area(facet) * cosine * self.jacobian(context, light, facet, lane) * masked;
            let value = if is_through {
                let ratio = context.indices.before.0[lane] / context.indices.behind.0[lane];
                surface.transmittance(cosine).mean() * shared * ratio * ratio
            } else {
                surface.reflectance(cosine).mean() * shared
            };
            if value.is_finite() { value } else { 0.0 }
        })
    }

    /// The value of what facets sent on to each other.
    fn further(&self, losses: &InterfaceLosses, context: &ShadingContext, light: DVec3) -> Channels {
        let value = by_lane(context, |lane| {
            let [before, behind] = [context.indices.before.0[lane], context.indices.behind.0[lane]];
            let [own, other] = [losses.between(before, behind), losses.between(behind, before)];
            let through = own.part_through(&other, behind / before);
            let (part, side) = if light.z > 0.0 { (1.0 - through, own) } else { (through, other) };
            let mean = side.mean();
            if mean > 0.0 { part * own.lost(context.view.z) * side.lost(light.z.abs()) * FRAC_1_PI / mean } else { 0.0 }
        });
        if light.z > 0.0 { value } else { value * radiance_scale(context) }
    }

    /// What is missing for the lane of the context.
    fn missing(&self, context: &ShadingContext) -> Missing<'_> {
        let nothing = Missing { own: 0.0, parts: [1.0, 0.0], sides: None };
        let Some(losses) = &self.losses else { return nothing };
        let [before, behind] = [context.indices.before, context.indices.behind].map(|index| index.0[context.lane]);
        let [own, other] = [losses.between(before, behind), losses.between(behind, before)];
        let lost = own.lost(context.view.z);
        if lost < LEAST_LOSS {
            return nothing;
        }
        let through = if other.mean() > 0.0 { own.part_through(&other, behind / before) } else { 0.0 };
        Missing { own: lost.min(MOST_CHANCE), parts: [1.0 - through, through], sides: Some([own, other]) }
    }
}

impl Lobe for RoughDielectric {
    fn flags(&self) -> Flags {
        // If all facets are seen, the pdf is a quarter of the density of their normals.
        Flags::of_pdf(0.25 * self.facets.area(DVec3::Z))
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        let view = context.view;
        if view.z <= 0.0 || light.z == 0.0 {
            return 0.0;
        }
        let Missing { own, parts: [stays, goes], sides } = self.missing(context);
        let further = sides.map_or(0.0, |[above, below]| {
            let (part, side) = if light.z > 0.0 { (stays, above) } else { (goes, below) };
            own * part * side.pdf(light.z.abs())
        });
        let Some(facet) = self.facet(context, light, context.lane) else { return further };
        let cosine = facet.dot(view);
        let chance = self.chance(context, cosine);
        let chance = if light.z > 0.0 { chance } else { 1.0 - chance };
        let once = chance * self.facets.normal_pdf(view, facet) * self.jacobian(context, light, facet, context.lane);
        further + if once.is_finite() { (1.0 - own) * once } else { 0.0 }
    }

    /// Radiance towards the viewer for a unit of flux density, 1/sr.
    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        if context.view.z <= 0.0 || light.z == 0.0 {
            return Channels::ZERO;
        }
        let once = self.once(context, light);
        match &self.losses {
            Some(losses) => once + self.further(losses, context, light),
            None => once,
        }
    }

    /// Samples a facet as the viewer sees it, and reflects or refracts there; or a direction of what facets sent on.
    fn sample(&self, context: &ShadingContext, choice: f64, point: [f64; 2]) -> Option<BsdfSample> {
        let view = context.view;
        let Missing { own, parts: [stays, _], sides } = self.missing(context);
        if let Some([above, below]) = sides.filter(|_| choice < own) {
            let is_above = choice < own * stays;
            let light = around_z(if is_above { above } else { below }.sample(point[0]), point[1]);
            return (light.z != 0.0).then(|| BsdfSample::unweighted(if is_above { light } else { -light }));
        }
        let choice = (choice - own) / (1.0 - own);
        let facet = self.facets.normal(view, point)?;
        let cosine = facet.dot(view);
        if cosine <= 0.0 {
            return None;
        }
        let light = if choice < self.chance(context, cosine) {
            (facet * (2.0 * cosine) - view).try_normalize().filter(|light| light.z > 0.0)
        } else {
            interface(context, context.lane)?.refracted(view, facet).filter(|light| light.z < 0.0)
        };
        light.map(BsdfSample::unweighted)
    }

    fn strength(&self, _: &ShadingContext) -> f64 {
        1.0
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        reflected(context, context.view.z)
    }
}

#[cfg(test)]
mod tests {
    use super::super::InterfaceIndices;
    use super::*;
    use crate::illumination::distribution::SlopeDistribution;
    use crate::numeric::cubature::{GAUSS, unit_square};
    use crate::numeric::sampling::RandomStream;
    use glam::DVec2;
    use rayon::prelude::*;
    use std::f64::consts::TAU;

    fn context(degrees: f64, before: f64, behind: f64) -> ShadingContext<'static> {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let indices = InterfaceIndices {
            before: Channels::splat(before),
            behind: Channels::splat(behind),
            inside: before > behind,
        };
        ShadingContext { view: DVec3::new(sin, 0.0, cos), wavelength_set: 0, indices, lane: 0, texture_values: &[] }
    }

    /// The light of an even sky on both sides that comes to a viewer, over the square of the index: of one reflection or
    /// refraction by cubature over the facets that the viewer sees, however narrow the lobe is, and of further ones by
    /// cubature over cosines that gather at the horizon.
    fn furnace(surface: &RoughDielectric, context: &ShadingContext) -> f64 {
        let (view, facets) = (context.view, &surface.facets);
        let gained = (context.indices.behind.0[0] / context.indices.before.0[0]).powi(2);
        let sent = |light: DVec3, facet: DVec3| {
            let density = facets.normal_pdf(view, facet) * surface.jacobian(context, light, facet, 0);
            let sent = surface.once(context, light).0[0] * light.z.abs() / density;
            if light.z < 0.0 { sent * gained } else { sent }
        };
        let once = |[x, y]: [f64; 2]| {
            // One half of the directions is the mirror image of the other.
            let Some(facet) = facets.normal(view, [x, 0.5 * y]) else { return 0.0 };
            let cosine = facet.dot(view);
            let mirrored = Some(facet * (2.0 * cosine) - view).filter(|light| light.z > 0.0);
            let refracted = interface(context, 0).and_then(|surface| surface.refracted(view, facet));
            let refracted = refracted.filter(|light| light.z < 0.0);
            [mirrored, refracted].into_iter().flatten().map(|light| sent(light.normalize(), facet)).sum()
        };
        let losses = surface.losses.as_deref().expect("facets that send light on");
        let parts = 400;
        let further: f64 = (0..parts)
            .flat_map(|part| GAUSS.map(|(at, weight)| ((f64::from(part) + at) / f64::from(parts), weight)))
            .map(|(root, weight)| {
                let cosine = root.powi(4);
                let light = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
                let above = surface.further(losses, context, light).0[0];
                let below = surface.further(losses, context, -light).0[0] * gained;
                (above + below) * cosine * TAU * 4.0 * root.powi(3) * weight / f64::from(parts)
            })
            .sum();
        unit_square(once, 1e-5, 30_000).value + further
    }

    fn ggx(roughness: f64) -> RoughDielectric {
        RoughDielectric::new(RoughFacets::Slopes(SlopeDistribution::Ggx, DVec2::splat(roughness)), true, true)
    }

    /// Contexts from both sides.
    fn contexts(index: f64, degrees: &[f64]) -> impl Iterator<Item = ShadingContext<'static>> {
        let sides = [[1.0, index], [index, 1.0]];
        sides.into_iter().flat_map(move |[before, behind]| degrees.iter().map(move |d| context(*d, before, behind)))
    }

    #[test]
    fn glass_of_little_roughness_loses_no_light_from_either_side() {
        let everywhere = [1.1, 1.5, 3.0].into_iter().flat_map(|index| [(index, 1e-3), (index, 0.01), (index, 0.05)]);
        let cases: Vec<(f64, f64)> = everywhere.chain([(1.5, 1e-6), (1.5, 0.03), (1.5, 0.1)]).collect();
        cases.par_iter().for_each(|(index, roughness)| {
            let surface = ggx(*roughness);
            for context in contexts(*index, &[0.0, 45.0, 80.0, 89.0]) {
                let all = furnace(&surface, &context);
                assert!((all - 1.0).abs() < 1e-3, "{index} {roughness}: {} {:?}: {all}", context.view, context.indices);
            }
        });
    }

    #[test]
    fn light_goes_to_and_fro_alike_within_narrow_lobes() {
        let mut stream = RandomStream::new(2, 9);
        for roughness in [1e-4, 1e-3, 0.01, 0.1] {
            let surface = ggx(roughness);
            for context in contexts(1.5, &[10.0, 40.0, 70.0, 85.0]) {
                for _ in 0..50 {
                    // Where it is sampled, a lobe is not nothing.
                    let Some(BsdfSample { light, .. }) = surface.sample(&context, stream.uniform(), stream.point())
                    else {
                        continue;
                    };
                    let InterfaceIndices { before, behind, inside } = context.indices;
                    let view = DVec3::new(light.x, light.y, light.z.abs());
                    let (back, other, squares) = if light.z > 0.0 {
                        (ShadingContext { view, ..context }, context.view, [1.0; 2])
                    } else {
                        let indices = InterfaceIndices { before: behind, behind: before, inside: !inside };
                        let other = DVec3::new(context.view.x, context.view.y, -context.view.z);
                        (ShadingContext { view, indices, ..context }, other, [behind.0[0], before.0[0]])
                    };
                    let there = surface.value(&context, light).0[0] * squares[0] * squares[0];
                    let back = surface.value(&back, other).0[0] * squares[1] * squares[1];
                    assert!((there / back - 1.0).abs() < 1e-6, "{roughness} {} {light}: {there} {back}", context.view);
                }
            }
        }
    }

    /// Bins along each side of the square of slopes.
    const BINS: usize = 10;
    /// The side of a bin.
    const SIDE: f64 = 2.0 / BINS as f64;

    /// The place in a square of a slope over the roughness, one coordinate of it, and the slope at such a place.
    fn squeezed(slope: f64) -> f64 {
        slope / (1.0 + slope * slope).sqrt()
    }

    fn stretched(place: f64) -> f64 {
        place / (1.0 - place * place).max(1e-30).sqrt()
    }

    #[test]
    fn samples_of_narrow_lobes_follow_their_pdf() {
        let count = 20_000;
        for roughness in [1e-4, 0.03] {
            let surface = ggx(roughness);
            for context in contexts(1.5, &[10.0, 70.0]) {
                let mut stream = RandomStream::new(4, 1);
                // Samples by the slopes of their facets, over the roughness: of reflected light and of refracted.
                let mut found = vec![0.0; 2 * BINS * BINS];
                for _ in 0..count {
                    let Some(BsdfSample { light, .. }) = surface.sample(&context, stream.uniform(), stream.point())
                    else {
                        continue;
                    };
                    let Some(facet) = surface.facet(&context, light, 0) else { continue };
                    let bin = |slope: f64| (((squeezed(slope / roughness) + 1.0) / SIDE) as usize).min(BINS - 1);
                    let [x, y] = [bin(facet.x / facet.z), bin(facet.y / facet.z)];
                    found[(usize::from(light.z < 0.0) * BINS + y) * BINS + x] += 1.0;
                }
                let density = |is_through: bool, [x, y]: [f64; 2]| {
                    let facet = DVec3::new(stretched(x) * roughness, stretched(y) * roughness, 1.0).normalize();
                    let cosine = facet.dot(context.view);
                    let light = match is_through {
                        false => Some(facet * (2.0 * cosine) - context.view).filter(|light| light.z > 0.0),
                        true => interface(&context, 0).and_then(|surface| surface.refracted(context.view, facet)),
                    };
                    let light = light.filter(|light| cosine > 0.0 && (light.z < 0.0) == is_through)?;
                    // From solid angles of light to those of facets, to slopes, to the square.
                    let of_facets = surface.pdf(&context, light) / surface.jacobian(&context, light, facet, 0);
                    let stretch = [x, y].map(|place| roughness * (1.0 - place * place).powf(-1.5));
                    Some(of_facets * facet.z.powi(3) * stretch[0] * stretch[1])
                };
                let (mut square, mut freedom, mut rest) = (0.0, 0.0, [f64::from(count); 2]);
                for (bin, found) in found.iter().enumerate() {
                    let [x, y] = [bin % BINS, bin / BINS % BINS].map(|place| place as f64 * SIDE - 1.0);
                    let at = |[u, v]: [f64; 2]| [x + u * SIDE, y + v * SIDE];
                    let term = |uv: [f64; 2]| density(bin >= BINS * BINS, at(uv)).unwrap_or(0.0);
                    let expected = unit_square(term, 1e-4, 2_000).value * SIDE * SIDE * f64::from(count);
                    if expected >= 8.0 {
                        square += (found - expected).powi(2) / expected;
                        freedom += 1.0;
                        rest = [rest[0] - found, rest[1] - expected];
                    }
                }
                square += (rest[0] - rest[1]).powi(2) / rest[1].max(8.0);
                // By Wilson and Hilferty the third root is about normal.
                let variance: f64 = 2.0 / (9.0 * freedom);
                let deviations = ((square / freedom).cbrt() - (1.0 - variance)) / variance.sqrt();
                assert!(
                    freedom > 10.0 && deviations < 5.0 && rest[1] > -8.0,
                    "{roughness} {}: {deviations}, {freedom} bins, left {rest:?}",
                    context.view
                );
            }
        }
    }
}
