//! Light that comes from what samples see, once for each pixel and surface.

use super::Lamp;
use super::casters::Casters;
use super::enclosed::Enclosed;
use super::visibility::{NONE, Strip};
use crate::color::Channels;
use crate::illumination::distribution::Frame;
use crate::illumination::optics::{Optics, Painting, Side, Sighting, Which};
use crate::numeric::ray::{Hit, Ray};
use crate::render::element::Element;
use crate::render::eye::{Eye, Sight};
use crate::render::film::{Sample, Tally};
use crate::render::ready::Appearance;
use crate::scene::footprint;
use glam::DVec3;
use std::ops::Range;

/// Triangles of one curved object that share a pixel are lit as one if their normals differ by less (cosine).
const SMOOTH: f64 = 0.94;
/// And flat ones if they lie in one plane.
const FLAT: f64 = 1.0 - 1e-12;
/// And if their depths differ by less than this part of them.
const BESIDE: f64 = 0.01;

/// What a sample sees: which surface of the pixel, and where its counts are.
#[derive(Clone, Copy, Debug)]
struct Part {
    surface: usize,
    fragment: usize,
    triangle: u32,
    near: f64,
    /// Which of the pixel's samples.
    sample: usize,
}

/// A surface in a pixel.
struct Surface<'a> {
    /// The triangle that was seen first, and how near.
    triangle: u32,
    near: f64,
    curved: bool,
    /// How many samples see it, the sum of their places in pixels, and whether all see the same triangle.
    count: u32,
    sum: [f64; 2],
    alone: bool,
    /// Sums of their nearness and depth.
    nearness: [f64; 2],
    found: Option<Found<'a>>,
    /// What it sends to the eye without lights.
    own: Channels,
    /// Which of the lights that were found are its own.
    lit: Range<usize>,
}

/// What a lamp adds.
#[derive(Clone, Copy, Debug)]
struct Lit {
    lamp: usize,
    adds: Channels,
    /// What to add to the count of the surface's own group: its light arrives on the other side.
    turned: i32,
    /// In how many opaque volumes it is, where that is not left to the samples.
    known: Option<bool>,
}

/// An element in a pixel.
#[derive(Clone, Copy)]
struct Found<'a> {
    element: Element,
    /// Of the sample from which it was found.
    near: f64,
    optics: &'a Optics,
    distance: f64,
    object: u32,
    material: u32,
    towards: DVec3,
    triangle: u32,
    weights: [f64; 3],
    /// Sides of what it stands for.
    sides: [DVec3; 2],
}

/// Lights the samples of a picture.
pub(super) struct Shader<'a> {
    pub(super) appearance: &'a Appearance<'a>,
    pub(super) casters: &'a Casters<'a>,
    pub(super) lamps: &'a [Lamp],
    /// For each lamp with shadows.
    pub(super) enclosed: &'a [Option<Enclosed<'a>>],
    /// What each group of casters lets through, comb by comb.
    pub(super) passing: &'a [Vec<Channels>],
    pub(super) eye: &'a Eye,
    pub(super) offsets: &'a [f64],
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
    surfaces: Vec<Surface<'a>>,
    parts: Vec<Part>,
    /// What lamps add, surface by surface.
    lit: Vec<Lit>,
    /// For each sample of the pixel, where its parts begin, and the light that comes to it.
    samples: Vec<(usize, DVec3)>,
    /// The last element of a flat triangle without texture: neighbours differ in their place only.
    flat: Option<Found<'a>>,
}

impl Desk<'_> {
    /// Forgets the last pixel, so that no picture depends on which thread made which part of it.
    pub(super) fn clear(&mut self) {
        self.flat = None;
    }
}

/// A pixel of a strip.
pub(super) struct Pixel {
    /// Column, row.
    pub(super) at: [usize; 2],
    /// Its first sample in the strip, and how far the next are apart.
    pub(super) first: usize,
    pub(super) stride: usize,
    /// Its samples, by line of the pixel.
    pub(super) lines: Range<usize>,
}

impl<'a> Shader<'a> {
    /// Adds the samples of a pixel to what is known of it.
    ///
    /// - `counts`: for each lamp, as [`super::shadow::Shadow::count`] gives them; empty without shadows.
    pub(super) fn shade(
        &self,
        pixel: &Pixel,
        strip: &Strip,
        counts: &[Vec<i32>],
        desk: &mut Desk<'a>,
        tally: &mut Tally,
    ) {
        self.gather(pixel, strip, desk);
        if let (true, Some(radiance)) = (desk.parts.is_empty(), self.background) {
            let radiance = if self.matte { DVec3::ZERO } else { radiance };
            tally.add_alike(&Sample { radiance, covered: false, first: None }, pixel.lines.len() as u32);
            return;
        }
        let Desk { surfaces, parts, lit, samples, flat } = desk;
        for (index, surface) in surfaces.iter_mut().enumerate() {
            surface.found = self.find(surface, parts.iter().filter(|part| part.surface == index), pixel, flat);
        }
        let combs = self.appearance.wavelengths.combs();
        for comb in 0..combs {
            lit.clear();
            surfaces.iter_mut().for_each(|surface| self.light(surface, lit, comb));
            if combs == 1
                && let Some(sample) = self.all_alike((surfaces, parts, lit), (strip, counts), pixel)
            {
                return tally.add_alike(&sample, pixel.lines.len() as u32);
            }
            let mut before: Option<(usize, DVec3)> = None;
            for i in 0..pixel.lines.len() {
                let own = seen_by(samples, parts, i);
                let seen = match before {
                    Some((j, seen)) if self.is_alike((surfaces, lit), [seen_by(samples, parts, j), own], counts) => {
                        seen
                    }
                    _ => {
                        let sum = self.sample((surfaces, lit), own, (strip, counts), (pixel, i), comb);
                        self.appearance.wavelengths.seen(comb, sum)
                    }
                };
                before = Some((i, seen));
                samples[i].1 += seen;
            }
        }
        let scale = (combs as f64).recip();
        let mut last: Option<(Sample, u32)> = None;
        for i in 0..pixel.lines.len() {
            let first = seen_by(samples, parts, i).first().map(|part| &surfaces[part.surface]);
            let first = first.and_then(|seen| seen.found.as_ref().map(|found| self.first(seen, found)));
            let glows = self.glows(pixel, i, first.map(|(distance, ..)| (distance, 0))).is_some();
            let first = first.filter(|_| !glows);
            let covered = first.is_some() || glows;
            let radiance = if self.matte && !covered { DVec3::ZERO } else { samples[i].1 * scale };
            let sample = Sample { radiance, covered, first };
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

    /// What all samples of a pixel get, if they see one surface by the light of the same lamps, as most do.
    fn all_alike(
        &self,
        (surfaces, parts, lit): (&[Surface<'a>], &[Part], &[Lit]),
        (strip, counts): (&Strip, &[Vec<i32>]),
        pixel: &Pixel,
    ) -> Option<Sample> {
        let [one, rest @ ..] = parts else { return None };
        let is_alike = |part: &Part| self.is_alike((surfaces, lit), [&[*one], &[*part]], counts);
        let is_single = parts.len() == pixel.lines.len() && strip.layers.is_empty() && !self.has_surfaces;
        if !is_single || !rest.iter().all(is_alike) {
            return None;
        }
        let seen = &surfaces[one.surface];
        let found = seen.found.as_ref()?;
        let sum = self.sample((surfaces, lit), &parts[..1], (strip, counts), (pixel, 0), 0);
        let radiance = self.appearance.wavelengths.seen(0, sum);
        Some(Sample { radiance, covered: true, first: Some(self.first(seen, found)) })
    }

    /// Finds the surfaces of a pixel, and which samples see them.
    fn gather(&self, pixel: &Pixel, strip: &Strip, desk: &mut Desk<'a>) {
        let Desk { surfaces, parts, samples, .. } = desk;
        surfaces.clear();
        parts.clear();
        samples.clear();
        let opaque = strip.near.len();
        for i in 0..pixel.lines.len() {
            samples.push((parts.len(), DVec3::ZERO));
            let sample = pixel.first + i * pixel.stride;
            let mut add = |triangle: u32, near: f64, fragment: usize| {
                let surface = self.surface(surfaces, triangle, near, self.place(pixel, i));
                parts.push(Part { surface, fragment, triangle, near, sample: i });
            };
            for index in strip.layers_of(sample) {
                let layer = strip.layers[index];
                add(layer.triangle, layer.near, opaque + index);
            }
            if strip.seen[sample] != NONE {
                add(strip.seen[sample], strip.near[sample], sample);
            }
        }
    }

    /// Whether two samples of a pixel surely get the same light.
    fn is_alike(&self, (surfaces, lit): (&[Surface<'_>], &[Lit]), parts: [&[Part]; 2], counts: &[Vec<i32>]) -> bool {
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
        (surfaces, lit): (&[Surface<'a>], &[Lit]),
        parts: &[Part],
        (strip, counts): (&Strip, &[Vec<i32>]),
        (pixel, i): (&Pixel, usize),
        comb: usize,
    ) -> Channels {
        let mut sum = Channels::ZERO;
        let mut passed = Channels::ONE;
        for (order, part) in parts.iter().enumerate() {
            let surface = &surfaces[part.surface];
            let Some(found) = &surface.found else { continue };
            if order == 0
                && let Some(glow) = self.glows(pixel, i, Some((found.distance, comb)))
            {
                return glow;
            }
            let mut radiance = surface.own;
            for lit in &lit[surface.lit.clone()] {
                radiance +=
                    lit.adds * self.arrived(lit, counts.get(lit.lamp), (part.fragment, strip), found.triangle, comb);
            }
            sum += passed * radiance;
            if part.fragment < strip.near.len() {
                return sum;
            }
            passed *= self.passed(found, comb);
        }
        if let Some(glow) = self.glows(pixel, i, Some((f64::INFINITY, comb))) {
            return sum + passed * glow;
        }
        let at = self.place(pixel, i);
        let direction = self.eye.ray(at, [0.5; 2]).map_or(DVec3::NEG_Z, |sight| sight.ray.direction.normalize());
        sum + passed * self.appearance.beyond(direction, None, comb, |_| 1.0)
    }

    /// The part of a lamp's light that comes to a sample.
    fn arrived(
        &self,
        lit: &Lit,
        counts: Option<&Vec<i32>>,
        (fragment, strip): (usize, &Strip),
        triangle: u32,
        comb: usize,
    ) -> Channels {
        let Some(counts) = counts.filter(|counts| !counts.is_empty()) else { return Channels::ONE };
        let fragments = strip.fragments();
        let own = usize::from(self.casters.group(triangle));
        let count = |group: usize| counts[group * fragments + fragment] + if group == own { lit.turned } else { 0 };
        if lit.known.unwrap_or_else(|| count(0) > 0) {
            return Channels::ZERO;
        }
        let mut part = Channels::ONE;
        for (group, passing) in self.passing.iter().enumerate().skip(1) {
            for _ in 0..count(group).clamp(0, 64) {
                part *= passing[comb];
            }
        }
        part
    }

    fn place(&self, pixel: &Pixel, i: usize) -> [f64; 2] {
        let line = pixel.lines.start + i;
        let [x, y] = pixel.at.map(|c| c as f64);
        [x + self.offsets[line], y + (line as f64 + 0.5) / self.offsets.len() as f64]
    }

    /// The light of a surface that emits and is no object, if a sample sees one before something.
    fn glows(&self, pixel: &Pixel, i: usize, before: Option<(f64, usize)>) -> Option<Channels> {
        if !self.has_surfaces {
            return None;
        }
        let (distance, comb) = before.unwrap_or((f64::INFINITY, 0));
        let Sight { ray, t_min, t_max, .. } = self.eye.ray(self.place(pixel, i), [0.5; 2])?;
        let t_max = t_max.min(distance / ray.direction.length());
        self.appearance.glow(&ray, t_min, t_max, comb).map(|(_, glow)| glow.radiance)
    }

    /// The surface of a pixel to which a sample belongs.
    fn surface(&self, surfaces: &mut Vec<Surface<'a>>, triangle: u32, near: f64, at: [f64; 2]) -> usize {
        let add = |index: usize, surface: &mut Surface<'_>| -> usize {
            surface.count += 1;
            surface.sum = [surface.sum[0] + at[0], surface.sum[1] + at[1]];
            surface.alone &= surface.triangle == triangle;
            surface.nearness = [surface.nearness[0] + near, surface.nearness[1] + self.depth(near)];
            index
        };
        if let Some(index) = surfaces.iter().position(|surface| surface.triangle == triangle) {
            return add(index, &mut surfaces[index]);
        }
        let prepared = self.appearance.prepared;
        let curved = self.appearance.curved && prepared.corner_normals(triangle).is_some();
        let object = prepared.object_of[triangle as usize];
        let face = |triangle: u32| {
            let [a, b, c] = prepared.corners(triangle);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let least = if curved { SMOOTH } else { FLAT };
        let same = |surface: &Surface<'_>| {
            surface.curved == curved
                && prepared.object_of[surface.triangle as usize] == object
                && (surface.near - near).abs() <= BESIDE * near.abs()
                && prepared.material_number(surface.triangle) == prepared.material_number(triangle)
                && face(surface.triangle).dot(face(triangle)) > least
        };
        if let Some(index) = surfaces.iter().position(same) {
            return add(index, &mut surfaces[index]);
        }
        let (own, lit) = (Channels::ZERO, 0..0);
        let nearness = [near, self.depth(near)];
        let surface =
            Surface { triangle, near, curved, count: 1, sum: at, alone: true, nearness, found: None, own, lit };
        surfaces.push(surface);
        surfaces.len() - 1
    }

    /// The depth of a nearness.
    fn depth(&self, near: f64) -> f64 {
        if self.is_parallel { -near } else { near.recip() }
    }

    /// The mean distance of what samples see of a surface, its normal, object and material.
    fn first(&self, surface: &Surface<'_>, found: &Found<'_>) -> (f64, DVec3, [u32; 2]) {
        let [near, depth] = surface.nearness.map(|sum| sum / f64::from(surface.count));
        // Nearness is linear over the picture, depth is not: far away, the mean is not that of the middle.
        let middle = self.depth(if surface.alone { near } else { found.near });
        let apart = if self.is_parallel { [1.0, depth - middle] } else { [depth / middle, 0.0] };
        (found.distance * apart[0] + apart[1], found.element.normal, [found.object, found.material])
    }

    /// The element in the middle of what samples see of a surface.
    fn find<'p>(
        &self,
        surface: &Surface<'_>,
        parts: impl Iterator<Item = &'p Part>,
        pixel: &Pixel,
        flat: &mut Option<Found<'a>>,
    ) -> Option<Found<'a>> {
        let part = f64::from(surface.count).recip();
        let middle = surface.sum.map(|sum| sum * part);
        let (at, triangle, near) = if surface.alone {
            (middle, surface.triangle, surface.near)
        } else {
            // The mean of samples in several triangles may lie in none of them.
            let away = |at: [f64; 2]| (at[0] - middle[0]).powi(2) + (at[1] - middle[1]).powi(2);
            let places = parts.map(|part| (self.place(pixel, part.sample), part.triangle, part.near));
            places.min_by(|(a, ..), (b, ..)| away(*a).total_cmp(&away(*b)))?
        };
        let sight = self.eye.ray(at, [0.5; 2])?;
        let length = sight.ray.direction.length();
        let towards = sight.ray.direction / length;
        if let Some(found) = flat.filter(|found| found.triangle == triangle) {
            let face = found.element.face;
            let t = (found.element.position - sight.ray.origin).dot(face) / sight.ray.direction.dot(face);
            if t.is_finite() {
                let element = Element { position: sight.ray.at(t), ..found.element };
                return Some(Found { element, near, distance: t * length, towards, ..found });
            }
        }
        let prepared = self.appearance.prepared;
        let hit = met(&sight.ray, prepared.corners(triangle), triangle)?;
        let element = Element::new(prepared, triangle, &sight.ray, &hit, self.appearance.curved)?;
        let (object, material) = (prepared.object_of[triangle as usize], prepared.material_number(triangle));
        let optics = self.appearance.optics(object, material);
        let distance = hit.t * length;
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let mut found = Found {
            near,
            element,
            optics,
            distance,
            object,
            material,
            towards,
            triangle,
            weights,
            sides: Default::default(),
        };
        if optics.is_textured() {
            let sides = footprint(element.face, towards, sight.cone.at(distance));
            found.sides = sides;
            let place = prepared.place(triangle, weights, sides);
            found.element.tilt(-towards, |normal| optics.tilted(&place, normal));
        } else if !surface.curved {
            *flat = Some(found);
        }
        Some(found)
    }

    /// The part of light that goes straight through a surface.
    fn passed(&self, found: &Found<'_>, comb: usize) -> Channels {
        found.optics.passing(comb, || self.appearance.prepared.place(found.triangle, found.weights, found.sides))
    }

    /// What a surface sends to the eye.
    fn light(&self, surface: &mut Surface<'a>, lit: &mut Vec<Lit>, comb: usize) {
        surface.own = Channels::ZERO;
        surface.lit = lit.len()..lit.len();
        let Some(found) = &surface.found else { return };
        let Found { element, optics, towards, .. } = found;
        if let Some((emission, _)) = self.appearance.emission(found.object, found.material, comb) {
            surface.own += emission;
        }
        let place = || self.appearance.prepared.place(found.triangle, found.weights, found.sides);
        let painting: Option<Painting> = optics.is_textured().then(|| optics.paint(&place(), comb));
        let painted = painting.as_ref().map_or(&[][..], |painting| painting.as_slice());
        let normal = element.normal;
        let frame = optics.along.map_or_else(|| Frame::about(normal), |along| Frame::brushed(normal, along));
        let index = optics.interior.as_ref().map_or(Channels::ONE, |interior| interior.index.of(comb));
        let side = match element.outside {
            true => Side { before: Channels::ONE, behind: index },
            false => Side { before: index, behind: Channels::ONE },
        };
        let sighting = Sighting { view: frame.local(-*towards), comb, side, lane: 0, painted };
        if let Some(ambient) = &self.appearance.ambient {
            surface.own += optics.ambient(&sighting) * ambient.of(comb);
        }
        if !optics.answers_lights() {
            return;
        }
        for (number, lamp) in self.lamps.iter().enumerate() {
            let source = &self.appearance.sources[lamp.source].1;
            let Some(beam) = source.beam_from(&lamp.point, element.position, comb) else { continue };
            let light = frame.local(beam.towards);
            let adds = (optics.value(Which::Continued, &sighting, light)
                + optics.value(Which::Ended, &sighting, light))
                * beam.irradiance
                * light.z.abs();
            if adds == Channels::ZERO || !adds.is_finite() {
                continue;
            }
            let is_before = beam.towards.dot(element.face) > 0.0;
            let (mut turned, mut known) = (0, None);
            if light.z < 0.0 {
                // The light arrives behind the triangle, which is one more in between, or one less.
                turned = if is_before { 1 } else { -1 };
            } else if !is_before && surface.curved {
                // The triangle turns away where the curved surface that it stands for does not.
                let enclosed = self.enclosed.get(number).and_then(Option::as_ref);
                known = enclosed.map(|enclosed| enclosed.counts(element.leave_curved)[0] > 0);
            }
            lit.push(Lit { lamp: number, adds, turned, known });
        }
        surface.lit.end = lit.len();
    }
}

/// The parts of a sample of a pixel, from the nearest.
fn seen_by<'p>(samples: &[(usize, DVec3)], parts: &'p [Part], i: usize) -> &'p [Part] {
    &parts[samples[i].0..samples.get(i + 1).map_or(parts.len(), |next| next.0)]
}

/// Where a line of sight meets the plane of a triangle, within the triangle.
fn met(ray: &Ray, [a, b, c]: [DVec3; 3], triangle: u32) -> Option<Hit> {
    let (across, up, from) = (b - a, c - a, ray.origin - a);
    let p = ray.direction.cross(up);
    let scale = across.dot(p).recip();
    let q = from.cross(across);
    let (t, u, v) = (up.dot(q) * scale, from.dot(p) * scale, ray.direction.dot(q) * scale);
    if !(t.is_finite() && u.is_finite() && v.is_finite()) {
        return None;
    }
    let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
    let over = (u + v).max(1.0);
    Some(Hit { t, triangle, u: u / over, v: v / over })
}
