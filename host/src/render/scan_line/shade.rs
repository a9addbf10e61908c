//! Light that comes from what samples see, once for each pixel and surface.

use super::lamp::LampPoint;
use super::shader::{PixelScratch, SampleSight, LampContribution, Shader};
use super::surfaces::{PixelInteraction, SampleFragment, StripPixel, PixelSurface};
use super::visibility::{NONE, Strip};
use crate::color::Channels;
use crate::illumination::optics::{InteriorMedium, InterfaceIndices, ShadingContext};
use crate::illumination::texture::TextureFootprint;
use crate::numeric::ray::Ray;
use crate::numeric::triangle::weights;
use crate::render::indirect::IrradiancePart as Light;
use crate::render::tally::{PixelSample, Tally};
use crate::render::world::{AHEAD, SurfaceElement, BoundedRay, diffuse_albedo};
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
        desk: &mut PixelScratch<'a>,
        tally: &mut Tally,
    ) {
        if let Some(sample) = self.single(pixel, strip, counts, &mut desk.last) {
            return tally.add_alike(&sample, pixel.count() as u32);
        }
        self.gather(pixel, strip, desk);
        self.find_visible(pixel, (strip, counts), desk);
        let PixelScratch { surfaces, parts, founds, mixtures, lit, samples, .. } = desk;
        for comb in 0..self.appearance.wavelengths.count() {
            for surface in surfaces.iter_mut() {
                let Some(index) = surface.found else { continue };
                let found = &founds[index];
                let painting = mixtures[index].as_ref().map(|mixture| mixture.at(comb));
                let sighting = self.context(found, comb, painting.as_ref().map_or(&[], |painting| &painting[..]));
                surface.own = self.unlit_radiance(found, &sighting);
                surface.passed = straight_transmittance(found, &sighting);
                for lit in &mut lit[surface.lit.clone()] {
                    lit.adds = self.lamp_radiance(lit, found, &sighting);
                }
            }
            for i in 0..samples.len() {
                if samples[i].like == i {
                    let light =
                        self.sample((surfaces, founds, lit), (samples, parts), (strip, counts), (pixel, i), comb);
                    samples[i].light += self.appearance.wavelengths.to_srgb(comb, light);
                }
            }
        }
        self.add_samples(pixel, desk, tally);
    }

    /// Finds what the samples of a pixel see, by the light of which lamps, and which of them get the same light.
    fn find_visible(&self, pixel: &StripPixel<'_>, (strip, counts): (&Strip, &[Vec<i32>]), desk: &mut PixelScratch<'a>) {
        let PixelScratch { surfaces, parts, founds, mixtures, lit, samples, last } = desk;
        founds.clear();
        mixtures.clear();
        lit.clear();
        for (index, surface) in surfaces.iter_mut().enumerate() {
            let own = || parts.iter().filter(|part| part.surface == index);
            surface.found = self.find_interaction(surface, own(), pixel, (founds, last));
            let begin = lit.len();
            if let Some(found) = surface.found.map(|found| &founds[found]) {
                mixtures.push(found.optics.is_textured().then(|| found.optics.texture_mixture(&self.footprint(found))));
                let is_dark =
                    |lit: &LampContribution| own().all(|part| self.is_shaded(lit, counts, (part.fragment, strip), found.triangle));
                lit.extend(self.lights(found).filter(|lit| !is_dark(lit)));
            }
            surface.lit = begin..lit.len();
        }
        for i in 0..samples.len() {
            let own = fragments_of(samples, parts, i);
            samples[i].glow = if self.has_surfaces {
                let before = own.iter().map(|part| (part, surfaces[part.surface].found.map(|found| &founds[found])));
                self.fragments_before_light(pixel.place(i), before, strip)
            } else {
                None
            };
            let is_like = |j: &usize| {
                samples[*j].like == *j
                    && samples[*j].glow.is_none()
                    && self.is_alike([fragments_of(samples, parts, *j), own], strip, counts)
            };
            if samples[i].glow.is_none()
                && let Some(like) = (0..i).find(is_like)
            {
                samples[i].like = like;
            }
        }
    }

    /// Adds up what was found sample by sample.
    fn add_samples(&self, pixel: &StripPixel<'_>, desk: &PixelScratch<'a>, tally: &mut Tally) {
        let PixelScratch { surfaces, parts, founds, samples, .. } = desk;
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
            let found = first.and_then(|seen| seen.found.map(|found| (seen, &founds[found])));
            let glow = samples[i].glow;
            let first = found.filter(|_| glow != Some(0)).map(|(seen, found)| self.first(seen, found));
            let covered = first.is_some() || glow.is_some();
            let light = samples[samples[i].like].light * scale;
            let radiance = if self.matte && !covered { DVec3::ZERO } else { light };
            let sample = PixelSample { radiance, covered, first, ..PixelSample::default() };
            if let Some((before, count)) = last.replace((sample, 1)) {
                tally.add_alike(&before, count);
            }
        }
        if let Some((sample, count)) = last {
            tally.add_alike(&sample, count);
        }
    }

    /// What all samples of a pixel get, if they see one opaque triangle, or nothing, by the light of the same lamps.
    fn single(
        &self,
        pixel: &StripPixel<'_>,
        strip: &Strip,
        counts: &[Vec<i32>],
        last: &mut Option<PixelInteraction<'a>>,
    ) -> Option<PixelSample> {
        let triangle = strip.seen[pixel.first];
        let alike = |sample: usize| {
            strip.seen[sample] == triangle && counts.iter().all(|counts| counts[sample] == counts[pixel.first])
        };
        if !self.is_plain || !strip.layers.is_empty() || !pixel.samples().all(alike) {
            return None;
        }
        if triangle == NONE {
            let radiance = if self.matte { DVec3::ZERO } else { self.background? };
            return Some(PixelSample { radiance, ..PixelSample::default() });
        }
        let sight = self.eye.ray(pixel.middle(), [0.5; 2])?;
        if !last.as_mut().is_some_and(|found| found.move_to(triangle, &sight.ray)) {
            *last = Some(self.element(triangle, &sight, 0.0)?);
        }
        let found = last.as_ref()?;
        let painting = found.optics.is_textured().then(|| found.optics.texture_values(&self.footprint(found), 0));
        let sighting = self.context(found, 0, painting.as_ref().map_or(&[], |painting| &painting[..]));
        let mut sum = self.unlit_radiance(found, &sighting);
        for lit in self.lights(found).filter(|lit| !self.is_shaded(lit, counts, (pixel.first, strip), triangle)) {
            sum += self.lamp_radiance(&lit, found, &sighting);
        }
        let radiance = self.appearance.wavelengths.to_srgb(0, sum);
        let mut nearness = [0.0; 2];
        for near in pixel.samples().map(|sample| strip.near[sample]) {
            nearness = [nearness[0] + near, nearness[1] + self.depth(near)];
        }
        let [mean, depth] = nearness.map(|sum| sum * pixel.part);
        let distance = self.distance(found.distance, self.depth(mean), depth);
        Some(PixelSample {
            radiance,
            covered: true,
            first: Some((distance, found.element.normal, found.seen)),
            ..PixelSample::default()
        })
    }

    /// Whether two samples of a pixel, of which none glows, surely get the same light: they see the same surfaces in as many
    /// volumes of shadow.
    fn is_alike(&self, [a, b]: [&[SampleFragment]; 2], strip: &Strip, counts: &[Vec<i32>]) -> bool {
        let fragments = strip.fragments();
        let sees_sky = |parts: &[SampleFragment]| parts.last().is_none_or(|part| part.fragment >= strip.near.len());
        let volumes = |counts: &Vec<i32>, a: usize, b: usize| {
            (0..self.passing.len()).all(|group| counts[group * fragments + a] == counts[group * fragments + b])
        };
        a.len() == b.len()
            && !(self.has_sky && sees_sky(a))
            && a.iter().zip(b).all(|(a, b)| {
                a.surface == b.surface && counts.iter().all(|counts| volumes(counts, a.fragment, b.fragment))
            })
    }

    /// The light that comes to one sample.
    fn sample(
        &self,
        (surfaces, founds, lit): (&[PixelSurface], &[PixelInteraction<'a>], &[LampContribution]),
        (samples, parts): (&[SampleSight], &[SampleFragment]),
        (strip, counts): (&Strip, &[Vec<i32>]),
        (pixel, i): (&StripPixel<'_>, usize),
        comb: usize,
    ) -> Channels {
        let mut sum = Channels::ZERO;
        let mut passed = Channels::ONE;
        // What the line of sight is in, and from where on.
        let mut inside: Option<(&InteriorMedium, f64)> = None;
        let SampleSight { glow, .. } = samples[i];
        let at = pixel.place(i);
        let shines = || self.nearest_light(at, comb).map_or(Channels::ZERO, |(_, radiance)| radiance);
        let parts = fragments_of(samples, parts, i);
        for (order, part) in parts.iter().enumerate() {
            if glow == Some(order) {
                return sum + passed * shines();
            }
            let surface = &surfaces[part.surface];
            let Some(found) = surface.found.map(|found| &founds[found]) else { continue };
            if let Some((interior, from)) = &mut inside {
                let length = found.distance - std::mem::replace(from, found.distance);
                passed *= interior.absorption.of(comb).map(|absorption| (-absorption * length.max(0.0)).exp());
            }
            let mut radiance = surface.own;
            for lit in &lit[surface.lit.clone()] {
                radiance += lit.adds * self.lamp_transmittance(lit, counts, (part.fragment, strip), found.triangle, comb);
            }
            sum += passed * radiance;
            if part.fragment < strip.near.len() {
                return sum;
            }
            passed *= surface.passed;
            if let Some(interior) = &found.optics.interior {
                let absorbs = found.element.outside && interior.absorption.max() > 0.0;
                inside = absorbs.then_some((interior, found.distance));
            }
        }
        if glow.is_some() {
            return sum + passed * shines();
        }
        let ray = self
            .eye
            .ray(at, [0.5; 2])
            .map_or(AHEAD, |BoundedRay { ray, .. }| Ray { direction: ray.direction.normalize(), ..ray });
        sum + passed * self.appearance.escaped_radiance(&ray, None, comb, |_, _| 1.0)
    }

    /// In how many volumes of a group of casters a sample is.
    fn volumes(
        &self,
        lit: &LampContribution,
        counts: &[i32],
        (fragment, strip): (usize, &Strip),
        (triangle, group): (u32, usize),
    ) -> i32 {
        let is_own = group == usize::from(self.casters.group(triangle));
        counts[group * strip.fragments() + fragment] + if is_own { lit.turned } else { 0 }
    }

    /// Whether no light of a lamp comes to a sample.
    fn is_shaded(&self, lit: &LampContribution, counts: &[Vec<i32>], sample: (usize, &Strip), triangle: u32) -> bool {
        let Some(counts) = counts.get(lit.lamp) else { return false };
        lit.known.unwrap_or_else(|| self.volumes(lit, counts, sample, (triangle, 0)) > 0)
    }

    /// The part of a lamp's light that comes to a sample.
    fn lamp_transmittance(&self, lit: &LampContribution, counts: &[Vec<i32>], sample: (usize, &Strip), triangle: u32, comb: usize) -> Channels {
        if self.is_shaded(lit, counts, sample, triangle) {
            return Channels::ZERO;
        }
        let mut part = Channels::ONE;
        let Some(counts) = counts.get(lit.lamp) else { return part };
        for (group, passing) in self.passing.iter().enumerate().skip(1) {
            for _ in 0..self.volumes(lit, counts, sample, (triangle, group)).clamp(0, 64) {
                part *= passing[comb];
            }
        }
        part
    }

    /// The nearest light that is a surface and no object in a line of sight: where, in lengths of its direction, and its
    /// radiance.
    fn nearest_light(&self, at: [f64; 2], comb: usize) -> Option<(f64, Channels)> {
        let BoundedRay { ray, t_min, t_max, .. } = self.eye.ray(at, [0.5; 2])?;
        self.appearance.intersect_lights(&ray, t_min, t_max, comb).map(|(_, glow)| (glow.t, glow.radiance))
    }

    /// How many of the parts of a line of sight are before the light that is met there; none if there is none, or something
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
        for (part, found) in parts {
            // What was found once for the pixel is met elsewhere by each sample: a lamp may be close before it.
            let met = found.map_or(f64::INFINITY, |found| {
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

    /// Where an element is in the patterns of its material.
    fn footprint(&self, found: &PixelInteraction<'_>) -> TextureFootprint {
        self.appearance.prepared.texture_place(found.triangle, found.weights, found.sides)
    }

    /// How an element is looked at.
    ///
    /// - `painted`: what the patterns of its material give.
    fn context<'p>(&self, found: &PixelInteraction<'_>, comb: usize, painted: &'p [Channels]) -> ShadingContext<'p> {
        let index = found.optics.interior.as_ref().map_or(Channels::ONE, |interior| interior.index.of(comb));
        let side = match found.element.outside {
            true => InterfaceIndices { before: Channels::ONE, behind: index, inside: false },
            false => InterfaceIndices { before: index, behind: Channels::ONE, inside: found.optics.interior.is_some() },
        };
        ShadingContext { view: found.frame.local(-found.towards), comb, side, lane: 0, painted }
    }

    /// What an element sends to the eye without lamps.
    fn unlit_radiance(&self, found: &PixelInteraction<'_>, sighting: &ShadingContext<'_>) -> Channels {
        let PixelInteraction { element, optics, .. } = found;
        let mut own = optics.emission.as_ref().map_or(Channels::ZERO, |emission| emission.of(sighting.comb));
        if let Some(solution) = self.solution {
            // Elements of flat triangles are moved from pixel to pixel without their weights.
            let weights = weights(self.appearance.prepared.corners(found.triangle), element.position);
            let irradiance = solution.irradiance(found.triangle, element.outside, weights, Light::All);
            return own + diffuse_albedo(optics, sighting.comb, sighting.painted) * irradiance * FRAC_1_PI;
        }
        if let Some(ambient) = &self.appearance.ambient {
            own += (optics.ambient(sighting) + optics.glossy_albedo(&from_outside(found, sighting)))
                * ambient.of(sighting.comb);
        }
        if let Some(sky) = self.sky_light {
            let normal = if element.normal.dot(found.towards) > 0.0 { -element.normal } else { element.normal };
            let mirrored = found.towards.reflect(normal);
            own += optics.diffuse_albedo(sighting) * sky.radiance(normal, sighting.comb);
            own += optics.glossy_albedo(&from_outside(found, sighting)) * sky.radiance(mirrored, sighting.comb);
        }
        own
    }

    /// The lamps that an element answers, and how their shadows are counted; what they add is not yet known.
    fn lights(&self, found: &PixelInteraction<'a>) -> impl Iterator<Item = LampContribution> {
        let answers = self.solution.is_none() && found.optics.has_non_delta();
        let lamps = if answers { self.lamps } else { &[] };
        lamps.iter().enumerate().map(|(number, lamp)| self.between(number, lamp, found))
    }

    /// What a lamp adds where nothing stands between.
    fn lamp_radiance(&self, lit: &LampContribution, PixelInteraction { element, frame, optics, .. }: &PixelInteraction<'_>, sighting: &ShadingContext<'_>) -> Channels {
        let lamp = &self.lamps[lit.lamp];
        let source = &self.appearance.sources[lamp.source].1;
        let Some(beam) = source.incident_from(&lamp.point, element.position, sighting.comb) else { return Channels::ZERO };
        let light = frame.local(beam.towards);
        let adds = optics.total_value(sighting, light) * beam.irradiance * light.z.abs();
        if adds.is_finite() { adds } else { Channels::ZERO }
    }

    /// How shadows are counted that fall on an element by the light of a lamp.
    fn between(&self, number: usize, lamp: &LampPoint, PixelInteraction { element, curved, .. }: &PixelInteraction<'a>) -> LampContribution {
        let towards = lamp.position.from(element.position);
        let is_before = towards.dot(element.face) > 0.0;
        let mut lit = LampContribution { lamp: number, adds: Channels::ZERO, turned: 0, known: None };
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
fn straight_transmittance(found: &PixelInteraction<'_>, sighting: &ShadingContext<'_>) -> Channels {
    match &found.optics.interior {
        Some(_) => Channels::ONE - found.optics.glossy_albedo(&from_outside(found, sighting)),
        None => found.optics.straight_sample(sighting).map_or(Channels::ZERO, |onward| onward.weight),
    }
}

/// As an element of a transparent body is looked at from outside: what is not bent is never reflected totally.
fn from_outside<'p>(found: &PixelInteraction<'_>, sighting: &ShadingContext<'p>) -> ShadingContext<'p> {
    match (found.element.outside, sighting.side) {
        (true, _) => *sighting,
        (false, InterfaceIndices { before, behind, .. }) => {
            ShadingContext { side: InterfaceIndices { before: behind, behind: before, inside: false }, ..*sighting }
        }
    }
}

/// The parts of a sample of a pixel, from the nearest.
fn fragments_of<'p>(samples: &[SampleSight], parts: &'p [SampleFragment], i: usize) -> &'p [SampleFragment] {
    &parts[samples[i].begin..samples.get(i + 1).map_or(parts.len(), |next| next.begin)]
}
