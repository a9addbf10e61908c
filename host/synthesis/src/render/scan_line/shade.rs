//! Radiance of what samples see, once for each pixel and surface.

use super::lamp::{LampPoint, LightPosition};
use super::shader::{LampContribution, PixelScratch, SampleSight, Shader};
use super::surfaces::{PixelInteraction, SampleFragment, StripPixel};
use super::visibility::{NONE, Strip};
use crate::color::Channels;
use crate::illumination::optics::{InterfaceIndices, InteriorMedium, ShadingContext};
use crate::illumination::texture::TextureFootprint;
use crate::numeric::ray::Ray;
use crate::numeric::triangle::weights;
use crate::render::indirect::IrradiancePart as Light;
use crate::render::ray_tracing::PathScratch;
use crate::render::tally::{PixelSample, Tally};
use crate::render::world::{AHEAD, BoundedRay, SurfaceElement, diffuse_albedo};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

impl<'a> Shader<'a> {
    /// Adds the samples of a pixel to what is known of it.
    ///
    /// - `counts`: for each lamp, as [`super::shadow::Shadow::count`] gives them; empty without shadows.
    pub(super) fn shade(
        &self,
        pixel: &StripPixel<'_>,
        strip: &Strip,
        counts: &[Vec<i32>],
        scratch: &mut PixelScratch<'a>,
        tally: &mut Tally,
    ) {
        if scratch.finishing.samples.is_empty()
            && let Some(sample) = self.single(pixel, strip, counts, &mut scratch.last, &mut scratch.finishing.path)
        {
            return tally.add_alike(&sample, pixel.count() as u32);
        }
        self.gather(pixel, strip, scratch);
        self.find_visible(pixel, strip, counts, scratch);
        for wavelength_set in 0..self.appearance.wavelengths.count() {
            let PixelScratch { surfaces, interactions, mixtures, contributions: lit, .. } = &mut *scratch;
            for surface in surfaces.iter_mut() {
                let Some(index) = surface.interaction else { continue };
                let interaction = &interactions[index];
                let texture_values = mixtures[index].as_ref().map(|mixture| mixture.at(wavelength_set));
                let context = self.context(
                    interaction,
                    wavelength_set,
                    texture_values.as_ref().map_or(&[], |painting| &painting[..]),
                );
                surface.unlit_radiance = self.unlit_radiance(interaction, surface.irradiance, &context);
                surface.transmittance = straight_transmittance(interaction, &context);
                for lit in &mut lit[surface.contributions.clone()] {
                    lit.radiance = self.lamp_radiance(lit, interaction, &context);
                }
            }
            for i in 0..scratch.samples.len() {
                if scratch.samples[i].like == i && !scratch.finishing.has(i) {
                    let light = self.sample(scratch, strip, counts, pixel, i, wavelength_set);
                    scratch.samples[i].light += self.appearance.wavelengths.to_srgb(wavelength_set, light);
                }
            }
        }
        self.add_samples(pixel, scratch, tally);
    }

    /// Finds what the samples of a pixel see, by the light of which lamps, and which of them get the same light.
    fn find_visible(&self, pixel: &StripPixel<'_>, strip: &Strip, counts: &[Vec<i32>], scratch: &mut PixelScratch<'a>) {
        let PixelScratch {
            surfaces,
            parts,
            interactions,
            mixtures,
            contributions: lit,
            samples,
            finishing,
            passed,
            last,
        } = scratch;
        interactions.clear();
        mixtures.clear();
        lit.clear();
        passed.clear();
        for (index, surface) in surfaces.iter_mut().enumerate() {
            let own = || parts.iter().filter(|part| part.surface == index);
            surface.interaction = self.find_interaction(surface, own(), pixel, interactions, last);
            if let Some(interaction) = surface.interaction.map(|interaction| &interactions[interaction]) {
                surface.irradiance = self.irradiance_by_others(interaction, pixel, &mut finishing.path);
            }
            let begin = lit.len();
            if let Some(interaction) = surface.interaction.map(|interaction| &interactions[interaction]) {
                mixtures.push(
                    interaction
                        .bsdf
                        .is_textured()
                        .then(|| interaction.bsdf.texture_mixture(&self.footprint(interaction))),
                );
                let is_dark = |lit: &LampContribution| {
                    own().all(|part| self.is_shaded(lit, counts, part.fragment, strip, interaction.triangle))
                };
                lit.extend(self.lights(interaction).filter(|lit| !is_dark(lit)));
                for lit in &mut lit[begin..] {
                    let dims =
                        |part: &SampleFragment| self.is_dimmed(lit, counts, part.fragment, strip, interaction.triangle);
                    if own().any(dims)
                        && let Some(transmittances) = self.straight_transmittances(lit, interaction)
                    {
                        lit.passed = Some(passed.len());
                        passed.extend(transmittances);
                    }
                }
            }
            surface.contributions = begin..lit.len();
        }
        for i in (0..samples.len()).filter(|i| !finishing.has(*i)) {
            let own = fragments_of(samples, parts, i);
            samples[i].before_light = if self.has_surfaces {
                let before = own.iter().map(|part| {
                    (part, surfaces[part.surface].interaction.map(|interaction| &interactions[interaction]))
                });
                self.fragments_before_light(pixel.place(i), before, strip)
            } else {
                None
            };
            let is_like = |j: &usize| {
                samples[*j].like == *j
                    && !finishing.has(*j)
                    && samples[*j].before_light.is_none()
                    && self.is_alike([fragments_of(samples, parts, *j), own], strip, counts)
            };
            if samples[i].before_light.is_none()
                && let Some(like) = (0..i).find(is_like)
            {
                samples[i].like = like;
            }
        }
    }

    /// Adds up what was found sample by sample.
    fn add_samples(&self, pixel: &StripPixel<'_>, scratch: &PixelScratch<'a>, tally: &mut Tally) {
        let PixelScratch { surfaces, parts, interactions, samples, finishing, .. } = scratch;
        let scale = (self.appearance.wavelengths.count() as f64).recip();
        let mut last: Option<(PixelSample, u32)> = None;
        for i in 0..pixel.count() {
            if i > 0
                && samples[i].like == samples[i - 1].like
                && let Some((_, count)) = &mut last
            {
                *count += 1;
                continue;
            }
            let first = fragments_of(samples, parts, i).first().map(|part| &surfaces[part.surface]);
            let interaction =
                first.and_then(|seen| seen.interaction.map(|interaction| (seen, &interactions[interaction])));
            let before_light = samples[i].before_light;
            let first = interaction.filter(|_| before_light != Some(0)).map(|(seen, found)| self.first(seen, found));
            let covered = first.is_some() || before_light.is_some();
            let light = samples[samples[i].like].light * scale;
            let radiance = if self.matte && !covered { DVec3::ZERO } else { light };
            let by_lamps = PixelSample { radiance, covered, first, ..PixelSample::default() };
            let sample = finishing.samples.get(i).copied().flatten().unwrap_or(by_lamps);
            if let Some((before, count)) = last.replace((sample, 1)) {
                tally.add_alike(&before, count);
            }
        }
        if let Some((sample, count)) = last {
            tally.add_alike(&sample, count);
        }
    }

    /// The light of all samples of a pixel, if they see one opaque triangle, or nothing, by the light of the same
    /// lamps.
    fn single(
        &self,
        pixel: &StripPixel<'_>,
        strip: &Strip,
        counts: &[Vec<i32>],
        last: &mut Option<PixelInteraction<'a>>,
        path: &mut PathScratch,
    ) -> Option<PixelSample> {
        let triangle = strip.triangles[pixel.first];
        let alike = |sample: usize| {
            strip.triangles[sample] == triangle && counts.iter().all(|counts| counts[sample] == counts[pixel.first])
        };
        if !self.is_plain || !strip.layers.is_empty() || !pixel.samples().all(alike) {
            return None;
        }
        if triangle == NONE {
            let radiance = if self.matte { DVec3::ZERO } else { self.background? };
            return Some(PixelSample { radiance, ..PixelSample::default() });
        }
        let bounded = self.eye.ray(pixel.middle(), [0.5; 2])?;
        if !last.as_mut().is_some_and(|interaction| interaction.move_to(triangle, &bounded.ray)) {
            *last = Some(self.element(triangle, &bounded, 0.0)?);
        }
        let interaction = last.as_ref()?;
        let texture_values =
            interaction.bsdf.is_textured().then(|| interaction.bsdf.texture_values(&self.footprint(interaction), 0));
        let context = self.context(interaction, 0, texture_values.as_ref().map_or(&[], |painting| &painting[..]));
        let irradiance = self.irradiance_by_others(interaction, pixel, path);
        let mut sum = self.unlit_radiance(interaction, irradiance, &context);
        for lit in self.lights(interaction).filter(|lit| !self.is_shaded(lit, counts, pixel.first, strip, triangle)) {
            sum += self.lamp_radiance(&lit, interaction, &context);
        }
        let radiance = self.appearance.wavelengths.to_srgb(0, sum);
        let mut nearness = [0.0; 2];
        for near in pixel.samples().map(|sample| strip.near[sample]) {
            nearness = [nearness[0] + near, nearness[1] + self.depth(near)];
        }
        let [mean, depth] = nearness.map(|sum| sum * pixel.part);
        let distance = self.distance(interaction.distance, self.depth(mean), depth);
        Some(PixelSample {
            radiance,
            covered: true,
            first: Some((distance, interaction.element.normal, interaction.ids)),
            ..PixelSample::default()
        })
    }

    /// Whether two samples of a pixel, of which none sees light that is emitted, surely get the same light: they see
    /// the same surfaces in as many shadow volumes.
    fn is_alike(&self, [a, b]: [&[SampleFragment]; 2], strip: &Strip, counts: &[Vec<i32>]) -> bool {
        let fragments = strip.fragments();
        let sees_sky = |parts: &[SampleFragment]| parts.last().is_none_or(|part| part.fragment >= strip.near.len());
        let volumes = |counts: &Vec<i32>, a: usize, b: usize| {
            (0..self.group_transmittance.len())
                .all(|group| counts[group * fragments + a] == counts[group * fragments + b])
        };
        a.len() == b.len()
            && !(self.has_sky && sees_sky(a))
            && a.iter().zip(b).all(|(a, b)| {
                a.surface == b.surface && counts.iter().all(|counts| volumes(counts, a.fragment, b.fragment))
            })
    }

    /// The radiance of the sample `i` of a pixel.
    fn sample(
        &self,
        scratch: &PixelScratch<'a>,
        strip: &Strip,
        counts: &[Vec<i32>],
        pixel: &StripPixel<'_>,
        i: usize,
        wavelength_set: usize,
    ) -> Channels {
        let PixelScratch { surfaces, interactions, contributions, samples, parts, passed, .. } = scratch;
        let mut sum = Channels::ZERO;
        let mut transmittance = Channels::ONE;
        // The medium of the line of sight, and where that begins.
        let mut inside: Option<(&InteriorMedium, f64)> = None;
        let SampleSight { before_light, .. } = samples[i];
        let at = pixel.place(i);
        let shines = || self.nearest_light(at, wavelength_set).map_or(Channels::ZERO, |(_, radiance)| radiance);
        let parts = fragments_of(samples, parts, i);
        for (order, part) in parts.iter().enumerate() {
            if before_light == Some(order) {
                return sum + transmittance * shines();
            }
            let surface = &surfaces[part.surface];
            let Some(interaction) = surface.interaction.map(|interaction| &interactions[interaction]) else { continue };
            if let Some((interior, from)) = &mut inside {
                let length = interaction.distance - std::mem::replace(from, interaction.distance);
                transmittance *=
                    interior.absorption.of(wavelength_set).map(|absorption| (-absorption * length.max(0.0)).exp());
            }
            let mut radiance = surface.unlit_radiance;
            for lit in &contributions[surface.contributions.clone()] {
                let at = [part.fragment, wavelength_set];
                radiance +=
                    lit.radiance * self.lamp_transmittance(lit, counts, at, strip, interaction.triangle, passed);
            }
            sum += transmittance * radiance;
            if part.fragment < strip.near.len() {
                return sum;
            }
            transmittance *= surface.transmittance;
            if let Some(interior) = &interaction.bsdf.interior {
                let absorbs = interaction.element.outside && interior.absorption.max() > 0.0;
                inside = absorbs.then_some((interior, interaction.distance));
            }
        }
        if before_light.is_some() {
            return sum + transmittance * shines();
        }
        let ray = self
            .eye
            .ray(at, [0.5; 2])
            .map_or(AHEAD, |BoundedRay { ray, .. }| Ray { direction: ray.direction.normalize(), ..ray });
        sum + transmittance * self.appearance.escaped_radiance(&ray, None, wavelength_set, |_, _| 1.0)
    }

    /// Number of shadow volumes of a group of casters in which a sample is.
    fn volumes(
        &self,
        lit: &LampContribution,
        counts: &[i32],
        fragment: usize,
        strip: &Strip,
        triangle: u32,
        group: usize,
    ) -> i32 {
        let is_own = group == usize::from(self.casters.group(triangle));
        counts[group * strip.fragments() + fragment] + if is_own { lit.turned } else { 0 }
    }

    /// Whether no light of a lamp comes to a sample.
    fn is_shaded(
        &self,
        lit: &LampContribution,
        counts: &[Vec<i32>],
        fragment: usize,
        strip: &Strip,
        triangle: u32,
    ) -> bool {
        let Some(counts) = counts.get(lit.lamp) else { return false };
        lit.known.unwrap_or_else(|| self.volumes(lit, counts, fragment, strip, triangle, 0) > 0)
    }

    /// Whether something passable stands between a lamp and a sample.
    fn is_dimmed(
        &self,
        lit: &LampContribution,
        counts: &[Vec<i32>],
        fragment: usize,
        strip: &Strip,
        triangle: u32,
    ) -> bool {
        let Some(counts) = counts.get(lit.lamp).filter(|_| self.world.is_some()) else { return false };
        let mut groups = 1..self.group_transmittance.len();
        groups.any(|group| self.volumes(lit, counts, fragment, strip, triangle, group) > 0)
    }

    /// Transmittance of what is passable between an element and a lamp, as a ray finds it, for each wavelength set; none
    /// without rays, or if the ray goes past.
    fn straight_transmittances(
        &self,
        lit: &LampContribution,
        interaction: &PixelInteraction<'_>,
    ) -> Option<Vec<Channels>> {
        let element = interaction.with_origins();
        let lamp = &self.lamps[lit.lamp];
        let above = lamp.position.from(element.position).dot(element.normal) > 0.0;
        let origin = if above { element.leave_curved } else { element.through };
        let t_max = if matches!(lamp.position, LightPosition::Point(_)) { 1.0 } else { f64::INFINITY };
        self.world?.straight_transmittances(&Ray { origin, direction: lamp.position.from(origin) }, t_max)
    }

    /// Transmittance from a lamp to a sample.
    ///
    /// - `passed`: transmittances by rays, of all lamps.
    fn lamp_transmittance(
        &self,
        lit: &LampContribution,
        counts: &[Vec<i32>],
        [fragment, wavelength_set]: [usize; 2],
        strip: &Strip,
        triangle: u32,
        passed: &[Channels],
    ) -> Channels {
        if self.is_shaded(lit, counts, fragment, strip, triangle) {
            return Channels::ZERO;
        }
        let mut part = Channels::ONE;
        if let Some(begin) = lit.passed
            && self.is_dimmed(lit, counts, fragment, strip, triangle)
        {
            return passed[begin + wavelength_set];
        }
        let Some(counts) = counts.get(lit.lamp) else { return part };
        for (group, passing) in self.group_transmittance.iter().enumerate().skip(1) {
            for _ in 0..self.volumes(lit, counts, fragment, strip, triangle, group).clamp(0, 64) {
                part *= passing[wavelength_set];
            }
        }
        part
    }

    /// The nearest light that is a surface and no object in a line of sight: where, in lengths of its direction, and
    /// its radiance.
    fn nearest_light(&self, at: [f64; 2], wavelength_set: usize) -> Option<(f64, Channels)> {
        let BoundedRay { ray, t_min, t_max, .. } = self.eye.ray(at, [0.5; 2])?;
        self.appearance
            .intersect_lights(&ray, t_min, t_max, wavelength_set)
            .map(|(_, light_hit)| (light_hit.t, light_hit.radiance))
    }

    /// How many of the parts of a line of sight are before the light that it hits; none if it hits none, or something
    /// opaque is before it.
    fn fragments_before_light<'p>(
        &self,
        at: [f64; 2],
        parts: impl Iterator<Item = (&'p SampleFragment, Option<&'p PixelInteraction<'a>>)>,
        strip: &Strip,
    ) -> Option<usize>
    where
        'a: 'p,
    {
        let (t, _) = self.nearest_light(at, 0)?;
        let ray = self.eye.ray(at, [0.5; 2])?.ray;
        let mut before = 0;
        for (part, interaction) in parts {
            // Each sample hits elsewhere what was found once for the pixel: a lamp may be close before it.
            let met = interaction.map_or(f64::INFINITY, |found| {
                let SurfaceElement { position, face, .. } = found.element;
                let met = (position - ray.origin).dot(face) / ray.direction.dot(face);
                if met > 0.0 { met } else { found.distance / ray.direction.length() }
            });
            if t < met {
                break;
            }
            if part.fragment < strip.near.len() {
                return None;
            }
            before += 1;
        }
        Some(before)
    }

    /// The footprint of an element in the textures of its material.
    fn footprint(&self, interaction: &PixelInteraction<'_>) -> TextureFootprint {
        self.appearance.prepared.texture_place(interaction.triangle, interaction.weights, interaction.sides)
    }

    /// The shading context of an element.
    ///
    /// - `texture_values`: of its material.
    fn context<'p>(
        &self,
        interaction: &PixelInteraction<'_>,
        wavelength_set: usize,
        texture_values: &'p [Channels],
    ) -> ShadingContext<'p> {
        let index =
            interaction.bsdf.interior.as_ref().map_or(Channels::ONE, |interior| interior.index.of(wavelength_set));
        let side = match interaction.element.outside {
            true => InterfaceIndices { before: Channels::ONE, behind: index, inside: false },
            false => {
                InterfaceIndices { before: index, behind: Channels::ONE, inside: interaction.bsdf.interior.is_some() }
            }
        };
        ShadingContext {
            view: interaction.frame.local(-interaction.towards),
            wavelength_set,
            indices: side,
            lane: 0,
            texture_values,
        }
    }

    /// Irradiance at an element by other surfaces, as far as it is gathered.
    fn irradiance_by_others(
        &self,
        interaction: &PixelInteraction<'_>,
        pixel: &StripPixel<'_>,
        path: &mut PathScratch,
    ) -> Channels {
        let Some(others) = self.others.as_ref().filter(|others| others.triangles[interaction.triangle as usize]) else {
            return Channels::ZERO;
        };
        let SurfaceElement { position, normal, .. } = interaction.element;
        others.cache.irradiance(position, normal).unwrap_or_else(|| {
            let number = (pixel.at[1] * others.width + pixel.at[0]) as u64;
            others.finisher.irradiance(&interaction.with_origins(), number, others.directions, path).irradiance
        })
    }

    /// Radiance of an element towards the camera without lamps.
    ///
    /// - `irradiance`: by other surfaces.
    fn unlit_radiance(
        &self,
        interaction: &PixelInteraction<'_>,
        irradiance: Channels,
        context: &ShadingContext<'_>,
    ) -> Channels {
        let PixelInteraction { element, bsdf, .. } = interaction;
        let prepared = self.appearance.prepared;
        let (object, material) =
            (prepared.object_of[interaction.triangle as usize], prepared.material_number(interaction.triangle));
        let emission = self.appearance.emission(object, material, element.outside, context.wavelength_set);
        let mut own = emission.map_or(Channels::ZERO, |(emission, _)| emission);
        if let Some(solution) = self.solution {
            // Elements of flat triangles are moved from pixel to pixel without their weights.
            let weights = weights(prepared.corners(interaction.triangle), element.position);
            let irradiance = solution.irradiance(interaction.triangle, element.outside, weights, Light::All);
            return own + diffuse_albedo(bsdf, context.wavelength_set, context.texture_values) * irradiance * FRAC_1_PI;
        }
        let is_gathered = self.others.as_ref().is_some_and(|others| others.triangles[interaction.triangle as usize]);
        if is_gathered {
            let albedo = bsdf.diffuse_albedo(context) + bsdf.glossy_albedo(&from_outside(interaction, context));
            own += albedo * irradiance * FRAC_1_PI;
        }
        if let Some(ambient) = &self.appearance.ambient {
            own += (bsdf.ambient(context) + bsdf.glossy_albedo(&from_outside(interaction, context)))
                * ambient.of(context.wavelength_set);
        }
        if let Some(sky) = self.sky_light.filter(|_| !is_gathered) {
            let normal = if element.normal.dot(interaction.towards) > 0.0 { -element.normal } else { element.normal };
            let mirrored = interaction.towards.reflect(normal);
            own += bsdf.diffuse_albedo(context) * sky.radiance(normal, context.wavelength_set);
            own += bsdf.diffuse_transmittance(context) * sky.radiance(-normal, context.wavelength_set);
            own += bsdf.glossy_albedo(&from_outside(interaction, context))
                * sky.radiance(mirrored, context.wavelength_set);
        }
        own
    }

    /// Contributions of the lamps that light an element, and how their shadows are counted; their radiance is not yet
    /// known.
    fn lights(&self, interaction: &PixelInteraction<'a>) -> impl Iterator<Item = LampContribution> {
        let answers = self.solution.is_none() && interaction.bsdf.has_non_delta();
        let lamps = if answers { self.lamps } else { &[] };
        let own = self.appearance.prepared.object(interaction.triangle).light;
        let is_other = move |lamp: &LampPoint| own.is_none() || lamp.light != own;
        lamps
            .iter()
            .enumerate()
            .filter(move |(_, lamp)| is_other(lamp))
            .map(|(number, lamp)| self.between(number, lamp, interaction))
    }

    /// The radiance that a lamp adds where nothing occludes it.
    fn lamp_radiance(
        &self,
        lit: &LampContribution,
        PixelInteraction { element, frame, bsdf, .. }: &PixelInteraction<'_>,
        context: &ShadingContext<'_>,
    ) -> Channels {
        let lamp = &self.lamps[lit.lamp];
        let source = &self.appearance.sources[lamp.source].1;
        let Some(light_sample) = source.incident_from(&lamp.point, element.position, context.wavelength_set) else {
            return Channels::ZERO;
        };
        let light = frame.local(light_sample.towards);
        let adds = bsdf.total_value(context, light) * light_sample.irradiance * light.z.abs();
        if adds.is_finite() { adds } else { Channels::ZERO }
    }

    /// How shadows are counted that fall on an element by the light of a lamp.
    fn between(
        &self,
        number: usize,
        lamp: &LampPoint,
        PixelInteraction { element, curved, .. }: &PixelInteraction<'a>,
    ) -> LampContribution {
        let towards = lamp.position.from(element.position);
        let is_before = towards.dot(element.face) > 0.0;
        let mut lit = LampContribution { lamp: number, radiance: Channels::ZERO, turned: 0, known: None, passed: None };
        if towards.dot(element.normal) < 0.0 {
            // The light arrives behind the triangle, which is one more in between, or one less.
            lit.turned = if is_before { 1 } else { -1 };
        } else if !is_before && *curved {
            // The triangle turns away where the curved surface that it stands for does not.
            let enclosed = self.enclosed.get(number).and_then(Option::as_ref);
            lit.known = enclosed.map(|enclosed| enclosed.counts(element.leave_curved)[0] > 0);
        }
        lit
    }
}

/// The part of light that goes straight through an element.
fn straight_transmittance(interaction: &PixelInteraction<'_>, context: &ShadingContext<'_>) -> Channels {
    match &interaction.bsdf.interior {
        Some(_) => Channels::ONE - interaction.bsdf.glossy_albedo(&from_outside(interaction, context)),
        None => interaction.bsdf.straight_sample(context).map_or(Channels::ZERO, |sample| sample.weight),
    }
}

/// The shading context of an element of a transparent body from outside: what is not bent is never reflected totally.
fn from_outside<'p>(interaction: &PixelInteraction<'_>, context: &ShadingContext<'p>) -> ShadingContext<'p> {
    match (interaction.element.outside, context.indices) {
        (true, _) => *context,
        (false, InterfaceIndices { before, behind, .. }) => {
            ShadingContext { indices: InterfaceIndices { before: behind, behind: before, inside: false }, ..*context }
        }
    }
}

/// The parts of a sample of a pixel, from the nearest.
fn fragments_of<'p>(samples: &[SampleSight], parts: &'p [SampleFragment], i: usize) -> &'p [SampleFragment] {
    &parts[samples[i].begin..samples.get(i + 1).map_or(parts.len(), |next| next.begin)]
}
