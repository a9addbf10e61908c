//! The surface of a principled material: its parts, their values, and how directions of light are sampled.

use super::super::context::{BsdfSample, ShadingContext};
use super::super::dielectric::{beta, interface, reflected};
use super::super::interface_losses::InterfaceLosses;
use super::super::prepared_textures::{PreparedNumber, PreparedPaint};
use super::albedo::{Albedo, AlbedoInterface, CoatAlbedo, InterfaceSide, pane};
use super::sheen::Sheen;
use crate::color::Channels;
use crate::illumination::distribution::{Distribution, Microfacet, RoughFacets, SlopeDistribution};
use crate::illumination::fresnel::Dielectric;
use crate::illumination::material::MaterialError;
use crate::numeric::sampling::cosine_hemisphere;
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// Neither reflection nor transmission is left to a smaller chance, if there is anything in it.
const LEAST_CHANCE: f64 = 0.05;

/// A principled material of one roughness under a coat of one roughness, prepared.
#[derive(Debug)]
pub(in crate::illumination::optics) struct PrincipledSurface {
    pub(super) base: PreparedPaint,
    pub(super) sheen: PreparedPaint,
    pub(super) sheen_roughness: PreparedNumber,
    pub(super) metallic: PreparedNumber,
    pub(super) specular: PreparedNumber,
    pub(super) transmission: PreparedNumber,
    pub(super) coat: PreparedNumber,
    /// From outside into the body.
    surface: Dielectric,
    pub(super) index: f64,
    /// Whether the body is a thin wall, which bends nothing.
    pub(super) thin: bool,
    /// The facets with their roughness; none where it is polished.
    facets: Option<(Microfacet, DVec2)>,
    coat_surface: Dielectric,
    coat_facets: Option<Microfacet>,
    pub(super) albedo: Albedo,
    /// What facets lose between other media than those for which the albedo was tabulated; none where light does not go
    /// through rough ones.
    pub(super) beside_others: Option<InterfaceLosses>,
}

/// A part of what it scatters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::illumination::optics) enum PrincipledPart {
    /// The rim of the cloth.
    Sheen,
    /// The reflection of the coat.
    Coat,
    /// The reflection and refraction of facets, once.
    Facets,
    /// Diffuse: the color of the ground, and the missing energy of the others.
    Spread,
}

/// The numbers of a principled surface at a footprint.
pub(super) struct PrincipledValues {
    pub(super) side: InterfaceSide,
    pub(super) metallic: f64,
    pub(super) specular: f64,
    pub(super) transmission: f64,
    pub(super) coat: f64,
    pub(super) base: Channels,
    /// The part of what is not transparent that is a cloth; 0 from inside.
    pub(super) cloth: Channels,
    pub(super) rim: Sheen,
}

/// The parts of light that a facet reflects and lets through.
pub(super) struct FacetFresnel {
    /// Reflected by what is metal and by what is opaque.
    ground: Channels,
    /// Reflected by what is transparent.
    clear: Channels,
    /// Let through.
    through: Channels,
}

/// The parameters of a principled surface that do not change from place to place.
pub(in crate::illumination::optics) struct PrincipledParameters {
    /// Refractive indices, of the body and of the coat.
    pub(in crate::illumination::optics) index: f64,
    pub(in crate::illumination::optics) coat_index: f64,
    /// m; none where it is polished.
    pub(in crate::illumination::optics) roughness: Option<f64>,
    pub(in crate::illumination::optics) coat_roughness: Option<f64>,
    pub(in crate::illumination::optics) thin: bool,
    /// Whether there may be a coat, and whether light may go through.
    pub(in crate::illumination::optics) has_coat: bool,
    pub(in crate::illumination::optics) transmits: bool,
}

impl PrincipledValues {
    /// The part of it that is transparent.
    pub(super) fn clear(&self) -> f64 {
        (1.0 - self.metallic) * self.transmission
    }

    /// The part of it that is opaque and no metal.
    pub(super) fn opaque(&self) -> f64 {
        (1.0 - self.metallic) * (1.0 - self.transmission)
    }

    /// The part that a metal reflects, after all further reflections, of light that one reflection did not send out.
    ///
    /// - `all`: the mean part that one reflection sends out.
    fn further(&self, all: f64) -> Channels {
        self.base.map(|base| {
            let mean = base + (1.0 - base) / 21.0;
            mean * mean * all / (1.0 - mean * (1.0 - all))
        })
    }
}

impl PrincipledSurface {
    /// # Errors
    /// [`MaterialError`] for an index or a roughness that is none.
    pub(in crate::illumination::optics) fn new(
        make: &PrincipledParameters,
        [base, sheen]: [PreparedPaint; 2],
        [metallic, specular, transmission, coat, sheen_roughness]: [PreparedNumber; 5],
    ) -> Result<PrincipledSurface, MaterialError> {
        let surface = Dielectric::new(1.0, make.index)?;
        let coat_surface = Dielectric::new(1.0, make.coat_index)?;
        let facets = |m: Option<f64>| m.map(|m| Microfacet::new(SlopeDistribution::Ggx, DVec2::splat(m))).transpose();
        let below = make
            .has_coat
            .then(|| CoatAlbedo::new(AlbedoInterface { roughness: make.coat_roughness, surface: coat_surface }));
        let transmits = make.transmits && !make.thin;
        let albedo = Albedo::new(AlbedoInterface { roughness: make.roughness, surface }, below, transmits);
        let slopes = make.roughness.filter(|_| transmits).map(DVec2::splat);
        let beside_others =
            slopes.map(|slopes| InterfaceLosses::new(RoughFacets::Slopes(SlopeDistribution::Ggx, slopes), true));
        Ok(PrincipledSurface {
            base,
            sheen,
            sheen_roughness,
            metallic,
            specular,
            transmission,
            coat,
            surface,
            index: make.index,
            thin: make.thin,
            facets: facets(make.roughness)?.zip(make.roughness.map(DVec2::splat)),
            coat_surface,
            coat_facets: facets(make.coat_roughness)?,
            albedo,
            beside_others,
        })
    }

    pub(super) fn at(&self, context: &ShadingContext) -> PrincipledValues {
        let is_inside = context.indices.inside && !self.thin;
        let part = |quantity: PreparedNumber| quantity.of(context).clamp(0.0, 1.0);
        PrincipledValues {
            side: if is_inside { InterfaceSide::Inside } else { InterfaceSide::Outside },
            metallic: part(self.metallic),
            specular: part(self.specular),
            transmission: part(self.transmission),
            coat: part(self.coat),
            base: self.base.of(context),
            cloth: if is_inside { Channels::ZERO } else { self.sheen.of(context) },
            rim: Sheen::new(part(self.sheen_roughness)),
        }
    }

    /// Whether a part is a delta lobe.
    pub(super) fn is_mirror(&self, part: PrincipledPart) -> bool {
        match part {
            PrincipledPart::Coat => self.coat_facets.is_none(),
            PrincipledPart::Facets => self.facets.is_none(),
            PrincipledPart::Sheen | PrincipledPart::Spread => false,
        }
    }

    /// Whether a part is broad.
    ///
    /// - `narrow`: the pdf straight above from which on it is narrow, 1/sr.
    pub(super) fn is_broad(&self, part: PrincipledPart, narrow: f64) -> bool {
        let pdf = |facets: &Option<Microfacet>| {
            facets.as_ref().map_or(f64::INFINITY, |facets| facets.pdf(DVec3::Z, DVec3::Z))
        };
        match part {
            PrincipledPart::Coat => pdf(&self.coat_facets) < narrow,
            PrincipledPart::Facets => pdf(&self.facets.map(|(facets, _)| facets)) < narrow,
            PrincipledPart::Sheen | PrincipledPart::Spread => true,
        }
    }

    /// Whether light may go through.
    pub(super) fn transmits(&self) -> bool {
        !matches!(self.transmission, PreparedNumber::Constant(0.0))
    }

    /// Whether light may go straight through.
    pub(in crate::illumination::optics) fn is_pane(&self) -> bool {
        self.thin && self.facets.is_none() && self.transmits()
    }

    /// The parts of light that a facet reflects and lets through at a cosine.
    pub(super) fn fresnel(&self, at: &PrincipledValues, context: &ShadingContext, cosine: f64) -> FacetFresnel {
        let grazing = (1.0 - cosine.clamp(0.0, 1.0)).powi(5);
        let own = self.surface.reflectance(cosine).mean();
        let dielectric = at.opaque() * at.specular * own;
        let ground = at.base.map(|base| at.metallic * (base + (1.0 - base) * grazing) + dielectric);
        let part = at.clear();
        if part == 0.0 {
            return FacetFresnel { ground, clear: Channels::ZERO, through: Channels::ZERO };
        }
        let (clear, tint) = match self.thin {
            true => (Channels::splat(pane(own)), at.base),
            // Light comes through twice, on its way in and out.
            false => (reflected(context, cosine), at.base.map(f64::sqrt)),
        };
        FacetFresnel { ground, clear: clear * part, through: clear.map(|clear| part * (1.0 - clear)) * tint }
    }

    /// The chance that a facet is taken to reflect.
    pub(super) fn chance(&self, fresnel: &FacetFresnel) -> f64 {
        let (reflects, through) = ((fresnel.ground + fresnel.clear).max(), fresnel.through.max());
        match (reflects > 0.0, through > 0.0) {
            (_, false) => 1.0,
            (false, true) => 0.0,
            _ => (reflects / (reflects + through)).clamp(LEAST_CHANCE, 1.0 - LEAST_CHANCE),
        }
    }

    /// Transmittance of the coat over what facets send.
    ///
    /// - `cosine`: of the viewer or the light, whichever is outside and nearer to the surface.
    fn under(&self, at: &PrincipledValues, cosine: f64) -> f64 {
        if at.coat > 0.0 { 1.0 - at.coat * self.albedo.coat(cosine) } else { 1.0 }
    }

    /// The normal that a facet must have to send light to the viewer, through or not.
    pub(super) fn facet(&self, context: &ShadingContext, light: DVec3) -> Option<DVec3> {
        let view = context.view;
        let facet = if light.z > 0.0 {
            light + view
        } else if self.thin {
            DVec3::new(light.x, light.y, -light.z) + view
        } else {
            let lane = context.lane;
            let facet = -(view * context.indices.before.0[lane] + light * context.indices.behind.0[lane]);
            if facet.z < 0.0 { -facet } else { facet }
        };
        let facet = facet.try_normalize()?;
        let sees = facet.dot(view) > 0.0 && (light.z > 0.0 || self.thin || facet.dot(light) < 0.0);
        (sees && facet.z > 0.0).then_some(facet)
    }

    /// How much of the directions around a facet goes to one solid angle of light.
    fn jacobian(&self, context: &ShadingContext, light: DVec3, facet: DVec3) -> f64 {
        let to_view = facet.dot(context.view);
        if light.z > 0.0 || self.thin {
            return 0.25 / to_view;
        }
        let lane = context.lane;
        let ratio = context.indices.before.0[lane] / context.indices.behind.0[lane];
        let to_light = facet.dot(light);
        let sum = to_light + ratio * to_view;
        to_light.abs() / (sum * sum)
    }

    /// Radiance towards the viewer for a unit of flux density, 1/sr.
    pub(super) fn value(&self, part: PrincipledPart, context: &ShadingContext, light: DVec3) -> Channels {
        let view = context.view;
        if view.z <= 0.0 || light.z == 0.0 {
            return Channels::ZERO;
        }
        let at = self.at(context);
        let value = match part {
            PrincipledPart::Facets => self.once(&at, context, light),
            PrincipledPart::Spread if light.z < 0.0 => self.spread_through(&at, context, light),
            PrincipledPart::Spread => self.spread(&at, context, light),
            _ if light.z < 0.0 || at.side == InterfaceSide::Inside => Channels::ZERO,
            PrincipledPart::Sheen => at.cloth * ((1.0 - at.clear()) * at.rim.value(view.z, light.z)),
            PrincipledPart::Coat => match self.coat_facets.as_ref().zip((light + view).try_normalize()) {
                Some((facets, half)) => {
                    let fresnel = self.coat_surface.reflectance(half.dot(view)).mean();
                    self.beside_cloth(&at) * (at.coat * fresnel * facets.density(light, view) / view.z)
                }
                None => Channels::ZERO,
            },
        };
        if value.is_finite() { value } else { Channels::ZERO }
    }

    /// The part that is no cloth.
    fn beside_cloth(&self, at: &PrincipledValues) -> Channels {
        Channels::ONE - at.cloth * (1.0 - at.clear())
    }

    /// The value of facets by one reflection or refraction.
    fn once(&self, at: &PrincipledValues, context: &ShadingContext, light: DVec3) -> Channels {
        let view = context.view;
        let Some(((facets, m), facet)) = self.facets.as_ref().zip(self.facet(context, light)) else {
            return Channels::ZERO;
        };
        let FacetFresnel { ground, clear, through } = self.fresnel(at, context, facet.dot(view));
        let above = DVec3::new(light.x, light.y, light.z.abs());
        if light.z > 0.0 || self.thin {
            let is_inside = at.side == InterfaceSide::Inside;
            let under = if is_inside { 1.0 } else { self.under(at, view.z.min(above.z)) };
            let sent = if light.z > 0.0 { ground * (Channels::ONE - at.cloth) + clear } else { through };
            return sent * (under * facets.density(above, view) / view.z);
        }
        let [l, v] = [above, view].map(|towards| SlopeDistribution::Ggx.projected(towards, *m) / towards.z);
        // Above and below, one hides what the other does not.
        let masking = beta(v, l) / (view.z * above.z);
        let under = self.under(at, if at.side == InterfaceSide::Outside { view.z } else { above.z });
        let pdf = SlopeDistribution::Ggx.area(facet, *m) * facet.dot(view) * self.jacobian(context, light, facet);
        through * (pdf * masking * radiance_scale(context) * under)
    }

    /// Diffuse value on the side of the viewer: colors, and missing energy.
    fn spread(&self, at: &PrincipledValues, context: &ShadingContext, light: DVec3) -> Channels {
        let [from, to] = [context.view.z, light.z].map(|cosine| self.missing(at, at.side, cosine));
        let mean = self.mean_missing(at, at.side);
        let mut value = at.base * (at.opaque() * over(from.opaque * to.opaque, mean.opaque));
        if at.metallic > 0.0 {
            let further = at.further(self.albedo.mean(InterfaceSide::Outside).all);
            value += further * (at.metallic * over(from.metal * to.metal, mean.metal));
        }
        let ground = at.rim.ground(context.view.z, light.z);
        value = value * (Channels::ONE - at.cloth) + at.cloth * at.base * ((1.0 - at.clear()) * ground);
        if at.clear() > 0.0 {
            value += Channels::splat(at.clear() * self.clear_spread(at, context, light));
        }
        value
    }

    /// Diffuse value of missing energy that comes from the other side.
    fn spread_through(&self, at: &PrincipledValues, context: &ShadingContext, light: DVec3) -> Channels {
        if at.clear() == 0.0 {
            return Channels::ZERO;
        }
        let part = at.clear() * self.clear_spread(at, context, light);
        if self.thin { at.base * part } else { at.base.map(f64::sqrt) * (part * radiance_scale(context)) }
    }

    /// The pdf of samples, 1/sr.
    pub(super) fn pdf(&self, part: PrincipledPart, context: &ShadingContext, light: DVec3) -> f64 {
        let view = context.view;
        if view.z <= 0.0 || light.z == 0.0 {
            return 0.0;
        }
        let pdf = match part {
            PrincipledPart::Facets => {
                let Some(((_, m), facet)) = self.facets.as_ref().zip(self.facet(context, light)) else { return 0.0 };
                let at = self.at(context);
                let chance = self.chance(&self.fresnel(&at, context, facet.dot(view)));
                let chance = if light.z > 0.0 { chance } else { 1.0 - chance };
                let seen = facet.dot(view) * SlopeDistribution::Ggx.area(facet, *m)
                    / SlopeDistribution::Ggx.projected(view, *m);
                chance * seen * self.jacobian(context, light, facet)
            }
            PrincipledPart::Spread => {
                let [above, below] = self.spread_shares(&self.at(context), context);
                let share = if light.z > 0.0 { above } else { below };
                if share > 0.0 { share / (above + below) * light.z.abs() * FRAC_1_PI } else { 0.0 }
            }
            _ if light.z < 0.0 => 0.0,
            PrincipledPart::Sheen => self.at(context).rim.pdf(light.z),
            PrincipledPart::Coat => self.coat_facets.as_ref().map_or(0.0, |facets| facets.pdf(view, light)),
        };
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// Samples a direction of light.
    pub(super) fn sample(
        &self,
        part: PrincipledPart,
        context: &ShadingContext,
        choice: f64,
        point: [f64; 2],
    ) -> Option<DVec3> {
        let view = context.view;
        match part {
            PrincipledPart::Facets => {
                let (_, m) = self.facets.as_ref()?;
                let facet = SlopeDistribution::Ggx.visible(view, *m, point)?;
                let cosine = facet.dot(view);
                if cosine <= 0.0 {
                    return None;
                }
                let at = self.at(context);
                let mirrored = (facet * (2.0 * cosine) - view).try_normalize().filter(|light| light.z > 0.0);
                if choice < self.chance(&self.fresnel(&at, context, cosine)) {
                    mirrored
                } else if self.thin {
                    mirrored.map(|light| DVec3::new(light.x, light.y, -light.z))
                } else {
                    interface(context, context.lane)?.refracted(view, facet).filter(|light| light.z < 0.0)
                }
            }
            PrincipledPart::Spread => {
                let [above, below] = self.spread_shares(&self.at(context), context);
                let light = cosine_hemisphere(point, DVec3::Z);
                let is_above = choice * (above + below) < above;
                Some(if is_above { light } else { -light }).filter(|light| light.z != 0.0)
            }
            PrincipledPart::Sheen => Some(self.at(context).rim.sample(point)).filter(|light| light.z > 0.0),
            PrincipledPart::Coat => self.coat_facets.as_ref()?.sample(view, point),
        }
    }

    /// Diffuse parts to the viewer from above, and from below.
    pub(super) fn spread_shares(&self, at: &PrincipledValues, context: &ShadingContext) -> [f64; 2] {
        let missing = self.missing(at, at.side, context.view.z);
        let further =
            if at.metallic > 0.0 { at.further(self.albedo.mean(InterfaceSide::Outside).all).max() } else { 0.0 };
        let color = at.base.max();
        let cloth = at.cloth.max() * (1.0 - at.clear()) * (1.0 - at.rim.albedo(context.view.z));
        let above = at.opaque() * color * missing.opaque + at.metallic * further * missing.metal + cloth * color;
        if at.clear() == 0.0 {
            return [above, 0.0];
        }
        let [stays, goes] = self.clear_shares(at, context);
        [above + at.clear() * stays, at.clear() * goes * color.sqrt()]
    }

    /// Specular samples of a part: what is reflected, and what comes through.
    pub(super) fn specular_samples(&self, part: PrincipledPart, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        if !self.is_mirror(part) {
            return [None, None];
        }
        let view = context.view;
        let at = self.at(context);
        let light = DVec3::new(-view.x, -view.y, view.z);
        if part == PrincipledPart::Coat {
            let part = if at.side == InterfaceSide::Inside { 0.0 } else { at.coat };
            let fresnel = self.coat_surface.reflectance(view.z).mean();
            return [Some(BsdfSample::specular(light, self.beside_cloth(&at) * (part * fresnel))), None];
        }
        let FacetFresnel { ground, clear, through } = self.fresnel(&at, context, view.z);
        let under = if at.side == InterfaceSide::Inside { 1.0 } else { self.under(&at, view.z) };
        let reflects = (ground * (Channels::ONE - at.cloth) + clear) * under;
        let reflection = Some(BsdfSample::specular(light, reflects)).filter(|sample| sample.weight.max() > 0.0);
        if self.thin {
            let straight = BsdfSample { is_straight: true, ..BsdfSample::specular(-view, through * under) };
            return [reflection, Some(straight).filter(|sample| sample.weight.max() > 0.0)];
        }
        let refracted = interface(context, context.lane).and_then(|surface| surface.refracted(view, DVec3::Z));
        let refraction = refracted.filter(|light| light.z < 0.0).map(|light| {
            let outside = if at.side == InterfaceSide::Outside { view.z } else { -light.z };
            BsdfSample::specular(light, through * (self.under(&at, outside) * radiance_scale(context)))
        });
        [reflection, refraction.filter(|sample| sample.weight.max() > 0.0)]
    }

    /// Transmittance of a polished surface, as if it did not bend light.
    pub(in crate::illumination::optics) fn straight_transmittance(&self, context: &ShadingContext) -> Channels {
        let at = self.at(context);
        self.fresnel(&at, context, context.view.z).through * self.under(&at, context.view.z)
    }

    /// One of the specular samples, by its part.
    pub(super) fn specular_sample(
        &self,
        part: PrincipledPart,
        context: &ShadingContext,
        choice: f64,
    ) -> Option<BsdfSample> {
        let [reflection, through] = self.specular_samples(part, context);
        let (Some(reflection), Some(through)) = (reflection, through) else { return reflection.or(through) };
        let chance = reflection.weight.max() / (reflection.weight.max() + through.weight.max());
        let chance = chance.clamp(LEAST_CHANCE, 1.0 - LEAST_CHANCE);
        let (sample, chance) = if choice < chance { (reflection, chance) } else { (through, 1.0 - chance) };
        Some(BsdfSample { weight: sample.weight * chance.recip(), ..sample })
    }

    /// About what a part sends to the viewer of all the light; more than 0 where it sends anything.
    pub(super) fn strength(&self, part: PrincipledPart, context: &ShadingContext) -> f64 {
        let at = self.at(context);
        let cosine = context.view.z.clamp(0.0, 1.0);
        let is_inside = at.side == InterfaceSide::Inside;
        match part {
            PrincipledPart::Sheen => at.cloth.max() * (1.0 - at.clear()) * at.rim.albedo(cosine),
            PrincipledPart::Coat if is_inside => 0.0,
            PrincipledPart::Coat => at.coat * self.albedo.coat(cosine),
            PrincipledPart::Spread => self.spread_shares(&at, context).into_iter().sum(),
            PrincipledPart::Facets => {
                let outside = self.albedo.at(InterfaceSide::Outside, cosine);
                let base = at.base.max();
                let grazing = (1.0 - cosine).powi(5);
                let metal = at.metallic * (base + (1.0 - base) * grazing) * outside.all;
                let opaque = at.opaque() * at.specular * outside.reflected;
                let under = if is_inside { 1.0 } else { self.under(&at, cosine) };
                // What is reflected and let through is nearly all; from inside, beside other media, too.
                (metal + opaque + at.clear()) * under
            }
        }
    }

    /// Glossy albedo: about what a part shows of what is around.
    pub(super) fn glossy_albedo(&self, part: PrincipledPart, context: &ShadingContext) -> Channels {
        let at = self.at(context);
        let cosine = context.view.z.clamp(0.0, 1.0);
        match part {
            PrincipledPart::Coat if at.side == InterfaceSide::Outside => {
                self.beside_cloth(&at) * (at.coat * self.albedo.coat(cosine))
            }
            PrincipledPart::Facets => {
                let FacetFresnel { ground, clear, .. } = self.fresnel(&at, context, cosine);
                (ground * (Channels::ONE - at.cloth) + clear) * self.under(&at, cosine)
            }
            _ => Channels::ZERO,
        }
    }

    /// Diffuse albedo: the part of light from all around that is reflected alike to everywhere.
    pub(super) fn diffuse_albedo(&self, part: PrincipledPart, context: &ShadingContext) -> Channels {
        if part != PrincipledPart::Spread {
            return Channels::ZERO;
        }
        let at = self.at(context);
        let mean = self.mean_missing(&at, at.side);
        let mut diffuse = at.base * (at.opaque() * mean.opaque);
        if at.metallic > 0.0 {
            diffuse += at.further(self.albedo.mean(InterfaceSide::Outside).all) * (at.metallic * mean.metal);
        }
        let ground = (1.0 - at.clear()) * (1.0 - at.rim.mean());
        diffuse * (Channels::ONE - at.cloth) + at.cloth * at.base * ground
    }
}

/// A value over π and a mean; 0 where there is nothing.
pub(super) fn over(value: f64, mean: f64) -> f64 {
    if mean > 1e-9 { value * FRAC_1_PI / mean } else { 0.0 }
}

/// By how much radiance falls as it leaves what is behind.
fn radiance_scale(context: &ShadingContext) -> f64 {
    (context.indices.before.0[context.lane] / context.indices.behind.0[context.lane]).powi(2)
}
