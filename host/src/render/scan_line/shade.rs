//! Light that comes from what samples see, once for each pixel and surface.

use super::Lamp;
use super::casters::Casters;
use super::enclosed::Enclosed;
use super::surfaces::{Found, Part, Pixel, Surface};
use super::visibility::{NONE, Strip};
use crate::color::Channels;
use crate::illumination::optics::{Painting, Side, Sighting};
use crate::numeric::triangle::weights;
use crate::render::element::Element;
use crate::render::eye::{Eye, Sight};
use crate::render::film::{Sample, Tally};
use crate::render::radiosity::diffuse;
use crate::render::radiosity::{Part as Light, Radiosity};
use crate::render::ready::Appearance;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// What a lamp adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit {
    lamp: usize,
    adds: Channels,
    /// What to add to the count of the surface's own group: its light arrives on the other side.
    turned: i32,
    /// In how many opaque volumes it is, where that is not left to the samples.
    known: Option<bool>,
}

/// Lights the samples of a picture.
pub(super) struct Shader<'a> {
    pub(super) appearance: &'a Appearance<'a>,
    pub(super) casters: &'a Casters<'a>,
    pub(super) lamps: &'a [Lamp],
    /// The light of all surfaces, if lamps are not asked.
    pub(super) solution: Option<&'a Radiosity>,
    /// For each lamp with shadows.
    pub(super) enclosed: &'a [Option<Enclosed<'a>>],
    /// What each group of casters lets through, comb by comb.
    pub(super) passing: &'a [Vec<Channels>],
    pub(super) eye: &'a Eye,
    /// Whether every sample sees bands of light through nothing passable, and no light that is a surface.
    pub(super) is_plain: bool,
    pub(super) matte: bool,
    /// Whether some light is a surface that is seen and no object, and whether one is a sky.
    pub(super) has_surfaces: bool,
    pub(super) has_sky: bool,
    /// Whether lines of sight are parallel.
    pub(super) is_parallel: bool,
    /// What is seen where there is nothing, if it is the same everywhere.
    pub(super) background: Option<DVec3>,
}

/// What a thread keeps from pixel to pixel.
#[derive(Default)]
pub(super) struct Desk<'a> {
    pub(super) surfaces: Vec<Surface>,
    pub(super) parts: Vec<Part>,
    /// Elements of the surfaces.
    founds: Vec<Found<'a>>,
    /// What lamps add, surface by surface.
    pub(super) lit: Vec<Lit>,
    /// For each sample of the pixel, where its parts begin, and the light that comes to it.
    pub(super) samples: Vec<(usize, DVec3)>,
    /// The last element: its neighbours may differ in their place only.
    pub(super) last: Option<Found<'a>>,
}

impl Desk<'_> {
    /// Forgets the last pixel, so that no picture depends on which thread made which part of it.
    pub(super) fn clear(&mut self) {
        self.last = None;
    }
}

impl<'a> Shader<'a> {
    /// Adds the samples of a pixel to what is known of it.
    ///
    /// - `counts`: for each lamp, as [`super::shadow::Shadow::count`] gives them; empty without shadows.
    pub(super) fn shade(
        &self,
        pixel: &Pixel<'_>,
        strip: &Strip,
        counts: &[Vec<i32>],
        desk: &mut Desk<'a>,
        tally: &mut Tally,
    ) {
        if let Some(sample) = self.single(pixel, strip, counts, &mut desk.last) {
            return tally.add_alike(&sample, pixel.count() as u32);
        }
        self.gather(pixel, strip, desk);
        let Desk { surfaces, parts, founds, lit, samples, last } = desk;
        founds.clear();
        for (index, surface) in surfaces.iter_mut().enumerate() {
            let own = parts.iter().filter(|part| part.surface == index);
            surface.found = self.find(surface, own, pixel, (founds, last));
        }
        let combs = self.appearance.wavelengths.combs();
        for comb in 0..combs {
            lit.clear();
            for (index, surface) in surfaces.iter_mut().enumerate() {
                let Some(found) = surface.found.map(|found| &founds[found]) else { continue };
                let begin = lit.len();
                let is_dark = |lit: &Lit| {
                    let mut own = parts.iter().filter(|part| part.surface == index);
                    own.all(|part| self.is_shaded(lit, counts, (part.fragment, strip), found.triangle))
                };
                surface.own = self.light(found, comb, is_dark, |own| lit.push(own));
                surface.lit = begin..lit.len();
            }
            if combs == 1
                && let Some(sample) = self.all_alike((surfaces, founds, lit), parts, (strip, counts), pixel)
            {
                return tally.add_alike(&sample, pixel.count() as u32);
            }
            let mut before: Option<(usize, DVec3)> = None;
            for i in 0..pixel.count() {
                let own = seen_by(samples, parts, i);
                let seen = match before {
                    Some((j, seen)) if self.is_alike((surfaces, lit), [seen_by(samples, parts, j), own], counts) => {
                        seen
                    }
                    _ => {
                        let sum = self.sample((surfaces, founds, lit), own, (strip, counts), (pixel, i), comb);
                        self.appearance.wavelengths.seen(comb, sum)
                    }
                };
                before = Some((i, seen));
                samples[i].1 += seen;
            }
        }
        self.add_samples(pixel, desk, tally);
    }

    /// Adds up what was found sample by sample.
    fn add_samples(&self, pixel: &Pixel<'_>, desk: &Desk<'a>, tally: &mut Tally) {
        let Desk { surfaces, parts, founds, samples, .. } = desk;
        let scale = (self.appearance.wavelengths.combs() as f64).recip();
        let mut last: Option<(Sample, u32)> = None;
        for i in 0..pixel.count() {
            let first = seen_by(samples, parts, i).first().map(|part| &surfaces[part.surface]);
            let found = first.and_then(|seen| seen.found.map(|found| (seen, &founds[found])));
            let glows = self.glows((pixel, i), found.map(|(_, found)| found), 0).is_some();
            let first = found.map(|(seen, found)| self.first(seen, found));
            let first = first.filter(|_| !glows);
            let covered = first.is_some() || glows;
            let radiance = if self.matte && !covered { DVec3::ZERO } else { samples[i].1 * scale };
            let sample = Sample { radiance, covered, first, shared: 0.0 };
            match &mut last {
                Some((before, count)) if *before == sample => *count += 1,
                _ => {
                    if let Some((before, count)) = last.replace((sample, 1)) {
                        tally.add_alike(&before, count);
                    }
                }
            }
        }
        if let Some((sample, count)) = last {
            tally.add_alike(&sample, count);
        }
    }

    /// What all samples of a pixel get, if they see one opaque triangle, or nothing, by the light of the same lamps.
    fn single(
        &self,
        pixel: &Pixel<'_>,
        strip: &Strip,
        counts: &[Vec<i32>],
        last: &mut Option<Found<'a>>,
    ) -> Option<Sample> {
        let triangle = strip.seen[pixel.first];
        let alike = |sample: usize| {
            strip.seen[sample] == triangle && counts.iter().all(|counts| counts[sample] == counts[pixel.first])
        };
        if !self.is_plain || !strip.layers.is_empty() || !pixel.samples().all(alike) {
            return None;
        }
        if triangle == NONE {
            let radiance = if self.matte { DVec3::ZERO } else { self.background? };
            return Some(Sample { radiance, ..Sample::default() });
        }
        let near = strip.near[pixel.first];
        let sight = self.eye.ray(pixel.middle(), [0.5; 2])?;
        if !last.as_mut().is_some_and(|found| found.meet(triangle, &sight.ray, near)) {
            *last = Some(self.element(triangle, near, &sight)?);
        }
        let found = last.as_ref()?;
        let mut sum = Channels::ZERO;
        let is_dark = |lit: &Lit| self.is_shaded(lit, counts, (pixel.first, strip), triangle);
        let own = self.light(found, 0, is_dark, |lit| sum += lit.adds);
        let radiance = self.appearance.wavelengths.seen(0, own + sum);
        let mut nearness = [0.0; 2];
        for near in pixel.samples().map(|sample| strip.near[sample]) {
            nearness = [nearness[0] + near, nearness[1] + self.depth(near)];
        }
        let [mean, depth] = nearness.map(|sum| sum * pixel.part);
        let distance = self.distance(found.distance, self.depth(mean), depth);
        Some(Sample { radiance, covered: true, first: Some((distance, found.element.normal, found.seen)), shared: 0.0 })
    }

    /// What all samples of a pixel get, if they see one surface by the light of the same lamps.
    fn all_alike(
        &self,
        (surfaces, founds, lit): (&[Surface], &[Found<'a>], &[Lit]),
        parts: &[Part],
        (strip, counts): (&Strip, &[Vec<i32>]),
        pixel: &Pixel<'_>,
    ) -> Option<Sample> {
        let [one, rest @ ..] = parts else { return None };
        let is_alike = |part: &Part| self.is_alike((surfaces, lit), [&[*one], &[*part]], counts);
        let is_single = parts.len() == pixel.count() && strip.layers.is_empty() && !self.has_surfaces;
        if !is_single || !rest.iter().all(is_alike) {
            return None;
        }
        let seen = &surfaces[one.surface];
        let found = &founds[seen.found?];
        let sum = self.sample((surfaces, founds, lit), &parts[..1], (strip, counts), (pixel, 0), 0);
        let radiance = self.appearance.wavelengths.seen(0, sum);
        Some(Sample { radiance, covered: true, first: Some(self.first(seen, found)), shared: 0.0 })
    }

    /// Whether two samples of a pixel surely get the same light.
    fn is_alike(&self, (surfaces, lit): (&[Surface], &[Lit]), parts: [&[Part]; 2], counts: &[Vec<i32>]) -> bool {
        if self.has_surfaces || self.passing.len() > 1 {
            return false;
        }
        match parts {
            [[], []] => !self.has_sky,
            [[a], [b]] => {
                a.surface == b.surface
                    && lit[surfaces[a.surface].lit.clone()].iter().all(|lit| {
                        lit.known.is_some()
                            || counts.get(lit.lamp).is_none_or(|counts| {
                                (counts[a.fragment] + lit.turned > 0) == (counts[b.fragment] + lit.turned > 0)
                            })
                    })
            }
            _ => false,
        }
    }

    /// The light that comes to one sample.
    fn sample(
        &self,
        (surfaces, founds, lit): (&[Surface], &[Found<'a>], &[Lit]),
        parts: &[Part],
        (strip, counts): (&Strip, &[Vec<i32>]),
        (pixel, i): (&Pixel<'_>, usize),
        comb: usize,
    ) -> Channels {
        let mut sum = Channels::ZERO;
        let mut passed = Channels::ONE;
        for (order, part) in parts.iter().enumerate() {
            let surface = &surfaces[part.surface];
            let Some(found) = surface.found.map(|found| &founds[found]) else { continue };
            if order == 0
                && let Some(glow) = self.glows((pixel, i), Some(found), comb)
            {
                return glow;
            }
            let mut radiance = surface.own;
            for lit in &lit[surface.lit.clone()] {
                radiance += lit.adds * self.arrived(lit, counts, (part.fragment, strip), found.triangle, comb);
            }
            sum += passed * radiance;
            if part.fragment < strip.near.len() {
                return sum;
            }
            passed *= self.passed(found, comb);
        }
        if let Some(glow) = self.glows((pixel, i), None, comb) {
            return sum + passed * glow;
        }
        let at = pixel.place(i);
        let direction = self.eye.ray(at, [0.5; 2]).map_or(DVec3::NEG_Z, |sight| sight.ray.direction.normalize());
        sum + passed * self.appearance.beyond(direction, None, comb, |_, _| 1.0)
    }

    /// In how many volumes of a group of casters a sample is.
    fn volumes(
        &self,
        lit: &Lit,
        counts: &[i32],
        (fragment, strip): (usize, &Strip),
        (triangle, group): (u32, usize),
    ) -> i32 {
        let is_own = group == usize::from(self.casters.group(triangle));
        counts[group * strip.fragments() + fragment] + if is_own { lit.turned } else { 0 }
    }

    /// Whether no light of a lamp comes to a sample.
    fn is_shaded(&self, lit: &Lit, counts: &[Vec<i32>], sample: (usize, &Strip), triangle: u32) -> bool {
        let Some(counts) = counts.get(lit.lamp) else { return false };
        lit.known.unwrap_or_else(|| self.volumes(lit, counts, sample, (triangle, 0)) > 0)
    }

    /// The part of a lamp's light that comes to a sample.
    fn arrived(&self, lit: &Lit, counts: &[Vec<i32>], sample: (usize, &Strip), triangle: u32, comb: usize) -> Channels {
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

    /// The light of a surface that emits and is no object, if a sample sees one before what is found there.
    fn glows(&self, (pixel, i): (&Pixel<'_>, usize), found: Option<&Found<'_>>, comb: usize) -> Option<Channels> {
        if !self.has_surfaces {
            return None;
        }
        let Sight { ray, t_min, t_max, .. } = self.eye.ray(pixel.place(i), [0.5; 2])?;
        // What was found once for the pixel is met elsewhere by each sample: a lamp may be close before it.
        let met = found.map_or(f64::INFINITY, |found| {
            let Element { position, face, .. } = found.element;
            let t = (position - ray.origin).dot(face) / ray.direction.dot(face);
            if t > 0.0 { t } else { found.distance / ray.direction.length() }
        });
        self.appearance.glow(&ray, t_min, t_max.min(met), comb).map(|(_, glow)| glow.radiance)
    }

    /// The part of light that goes straight through a surface.
    fn passed(&self, found: &Found<'_>, comb: usize) -> Channels {
        found.optics.passing(comb, || self.appearance.prepared.place(found.triangle, found.weights, found.sides))
    }

    /// What an element sends to the eye without lamps; gives what each lamp adds.
    ///
    /// - `is_dark`: whether no sample gets light of a lamp; what it adds is not yet known.
    fn light(
        &self,
        found: &Found<'a>,
        comb: usize,
        is_dark: impl Fn(&Lit) -> bool,
        mut give: impl FnMut(Lit),
    ) -> Channels {
        let Found { element, frame, optics, towards, .. } = found;
        let mut own = optics.emission.as_ref().map_or(Channels::ZERO, |emission| emission.of(comb));
        let place = || self.appearance.prepared.place(found.triangle, found.weights, found.sides);
        let painting: Option<Painting> = optics.is_textured().then(|| optics.paint(&place(), comb));
        let painted = painting.as_ref().map_or(&[][..], |painting| painting.as_slice());
        if let Some(solution) = self.solution {
            // Elements of flat triangles are moved from pixel to pixel without their weights.
            let weights = weights(self.appearance.prepared.corners(found.triangle), element.position);
            let irradiance = solution.irradiance(found.triangle, element.outside, weights, Light::All);
            return own + diffuse(optics, comb, painted) * irradiance * FRAC_1_PI;
        }
        let index = optics.interior.as_ref().map_or(Channels::ONE, |interior| interior.index.of(comb));
        let side = match element.outside {
            true => Side { before: Channels::ONE, behind: index },
            false => Side { before: index, behind: Channels::ONE },
        };
        let sighting = Sighting { view: frame.local(-*towards), comb, side, lane: 0, painted };
        if let Some(ambient) = &self.appearance.ambient {
            own += optics.ambient(&sighting) * ambient.of(comb);
        }
        if !optics.answers_lights() {
            return own;
        }
        for (number, lamp) in self.lamps.iter().enumerate() {
            let mut lit = self.between(number, lamp, found);
            if is_dark(&lit) {
                continue;
            }
            let source = &self.appearance.sources[lamp.source].1;
            let Some(beam) = source.beam_from(&lamp.point, element.position, comb) else { continue };
            let light = frame.local(beam.towards);
            lit.adds = optics.response(&sighting, light) * beam.irradiance * light.z.abs();
            if lit.adds != Channels::ZERO && lit.adds.is_finite() {
                give(lit);
            }
        }
        own
    }

    /// How shadows are counted that fall on an element by the light of a lamp.
    fn between(&self, number: usize, lamp: &Lamp, Found { element, curved, .. }: &Found<'a>) -> Lit {
        let towards = lamp.light.from(element.position);
        let is_before = towards.dot(element.face) > 0.0;
        let mut lit = Lit { lamp: number, adds: Channels::ZERO, turned: 0, known: None };
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

/// The parts of a sample of a pixel, from the nearest.
fn seen_by<'p>(samples: &[(usize, DVec3)], parts: &'p [Part], i: usize) -> &'p [Part] {
    &parts[samples[i].0..samples.get(i + 1).map_or(parts.len(), |next| next.0)]
}
