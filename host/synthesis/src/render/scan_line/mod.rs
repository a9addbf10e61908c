//! Scan line: triangles to spans of samples, with shadow volumes (Crow 1977).
//!
//! Each pixel has as many lines of samples as samples, one on each line and in each column of a grid (n rooks). A
//! triangle covers spans of the lines; the nearest is seen, sample by sample, and passable ones before it are kept in
//! their order. Light is found once for each pixel and surface, shadows for each sample.
//!
//! What shows what is around it, as mirrors, metals, coats and glass do, is finished by rays, sample by sample, where the
//! plan has reflected and refracted rays. Without them it shows lights, and for all else the ambient light, the same
//! radiance from everywhere, and a blurred sky; and glass bends nothing. Where diffuse light goes from surface to
//! surface, it is gathered by rays at few places and interpolated; and so is the light of skies in scenes with rays.
//!
//! *Not modelled*: on all else, only light that comes straight from lights is seen. Light goes straight through polished
//! glass, and through what is transparent without bending it; the shadow of these is as weak and as colored as what they
//! let through. Rough glass throws the shadow of an opaque body. A light with a size is represented by points of it, in
//! number the `light_samples` of the scene, and is itself no obstacle to others; without rays, a sky lights surfaces by
//! the direction of their normals, without shadows; a lens is a pinhole.
//!
//! Memory: 25 bytes for each vertex, about 30 for each triangle and 24 for each side, 310 for each silhouette and
//! light, and for each thread 16 bytes and 4 for each light in each sample of some rows of pixels.

mod sorted_groups;
mod casters;
mod enclosed;
mod lamp;
mod reach;
mod screen;
mod gathering;
mod finishing;
mod irradiance_cache;
mod shader;
mod shade;
mod shadow;
mod sky_light;
mod spans;
mod surfaces;
#[cfg(test)]
mod tests;
mod visibility;

use super::film::Film;
use super::indirect::IndirectLight;
use super::ray_tracing::RayFinisher;
use super::tally::Tally;
use super::world::{AHEAD, Appearance, CameraRays, World, check_copied};
use super::{FinishedCounts, RayCounts, RenderError, RenderOrder, Renderer, Rendering, SpanCounts, Watch};
use crate::color::Channels;
use crate::illumination::light::LightSource;
use crate::illumination::optics::Interreflection;
use crate::picture::{Filter, Picture};
use crate::plan::{Plan, Stage};
use crate::scene::{Caustics, Prepared, View};
use crate::stages::{StageSpan, Workers, part, stage};
use casters::Casters;
use enclosed::ShadowVolumes;
use finishing::{Finishing, triangles_for_rays, triangles_lit_by_others};
use glam::DVec3;
use irradiance_cache::{IrradianceCache, RecordPlaces, directions};
use lamp::{LampPoint, LightPosition};
use rayon::prelude::*;
use reach::Reach;
use screen::{Screen, Viewpoint};
use shader::{OtherSurfaces, PixelScratch, Shader};
use shadow::Shadow;
use sky_light::SkyLight;
use spans::{MOST_LINES, SampleLines, rooks};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use surfaces::StripPixel;
use visibility::{ScreenTriangles, Strip};

/// Most groups of casters that let different light through; what is beyond throws no shadow.
const MOST_GROUPS: usize = 200;

/// A scan-line renderer that holds a scene and which triangles are neighbours.
pub struct ScanLine<'a> {
    plan: &'a Plan,
    /// Materials and lights; with octrees, if samples are finished by rays.
    world: World<'a>,
    /// For each triangle of the scene, whether what sees it is finished by rays; empty if nothing is.
    for_rays: Vec<bool>,
    /// For each triangle of the scene, whether it needs the light of other diffuse surfaces; empty if none does.
    lit_by_others: Vec<bool>,
    casters: Casters<'a>,
    /// All triangles of the objects that the plan keeps.
    triangles: Vec<u32>,
    /// For each triangle of the scene, whether light goes straight through; empty if there is none such.
    passable: Vec<bool>,
    /// Transmittance of each group of casters, by wavelength set; the first is opaque.
    group_transmittance: Vec<Vec<Channels>>,
    lamps: Vec<LampPoint>,
    /// The light of skies; none without a sky, and where a solution is shown.
    sky_light: Option<SkyLight>,
    /// In the place of lamps and shadows.
    solution: Option<Arc<dyn IndirectLight>>,
}

/// The work that the threads share while a picture is made.
struct PictureWork<'a> {
    shader: Shader<'a>,
    finishing: Option<Finishing<'a>>,
    facets: &'a ScreenTriangles<'a>,
    shadows: &'a [Shadow],
    offsets: &'a [f64],
    /// Places of the samples of a pixel in it.
    places: Vec<[f64; 2]>,
    handed: i32,
    width: usize,
    /// Rows of pixels in a band.
    rows: usize,
}

/// Scratch of a thread, for one band after the other.
#[derive(Default)]
struct BandScratch<'a> {
    strip: Strip,
    counts: Vec<Vec<i32>>,
    /// For each pixel of the band, whether samples of it were finished by rays.
    finished: Vec<bool>,
    pixel: PixelScratch<'a>,
}

/// What bands took.
#[derive(Clone, Copy, Default)]
struct BandCounts {
    spans: SpanCounts,
    rays: RayCounts,
    finished: FinishedCounts,
}

impl std::ops::Add for BandCounts {
    type Output = BandCounts;

    fn add(self, other: BandCounts) -> BandCounts {
        BandCounts {
            spans: self.spans + other.spans,
            rays: self.rays + other.rays,
            finished: self.finished + other.finished,
        }
    }
}

impl<'a> ScanLine<'a> {
    /// Prepares materials and lights, and finds the neighbours of triangles that throw shadows.
    ///
    /// # Errors
    /// [`RenderError::Material`]; [`RenderError::Octree`], where samples are finished by rays.
    pub fn new(prepared: &'a Prepared, plan: &'a Plan) -> Result<ScanLine<'a>, RenderError> {
        check_copied(prepared)?;
        let appearance = Appearance::new(prepared, plan)?.without_caustics();
        let for_rays = triangles_for_rays(&appearance, plan);
        let lit_by_others = triangles_lit_by_others(&appearance, plan, !for_rays.is_empty());
        let world = match for_rays.is_empty() && lit_by_others.is_empty() {
            true => World::without_rays(appearance),
            false => World::standing_still(appearance, plan)?,
        };
        Ok(ScanLine { for_rays, lit_by_others, ..ScanLine::with_light(world, plan, None) })
    }

    /// A renderer of the light of a solution by radiosity: no highlights and no ambient light, and no shadows but those
    /// that are in it. It takes materials and lights over from the world that was solved.
    pub fn showing(solution: Arc<dyn IndirectLight>, world: World<'a>, plan: &'a Plan) -> ScanLine<'a> {
        ScanLine::with_light(World::without_rays(world.appearance), plan, Some(solution))
    }

    fn with_light(world: World<'a>, plan: &'a Plan, solution: Option<Arc<dyn IndirectLight>>) -> ScanLine<'a> {
        let (prepared, appearance) = (world.prepared(), &world.appearance);
        let keeps = |triangle: &u32| plan.includes_object(prepared.object_of[*triangle as usize] as usize);
        let triangles: Vec<u32> = (0..prepared.triangles.len() as u32).filter(keeps).collect();
        let (groups, passing) = groups(appearance);
        let passable = passable_triangles(appearance, &groups);
        let shadows = plan.needs(Stage::Shadows) && solution.is_none();
        let casters = Casters::new(prepared, if shadows { triangles.clone() } else { Vec::new() }, groups);
        let samples = prepared.settings.light.samples.max(1);
        let mut lamps = Vec::new();
        for (source, (number, light)) in appearance.sources.iter().enumerate().filter(|_| solution.is_none()) {
            for point in light.points(samples) {
                let position = point.at.map_or(LightPosition::Direction(point.towards), LightPosition::Point);
                let light = Some(*number as u32).filter(|_| *number < prepared.lights.len());
                lamps.push(LampPoint { source, light, point, position });
            }
        }
        let sky_light = if solution.is_none() { SkyLight::new(appearance) } else { None };
        ScanLine {
            plan,
            world,
            for_rays: Vec::new(),
            lit_by_others: Vec::new(),
            casters,
            triangles,
            passable,
            group_transmittance: passing,
            lamps,
            sky_light,
            solution,
        }
    }

    /// The shadow volumes of a lamp.
    ///
    /// - `bands`: scan lines in all, and how many bands they are divided into.
    fn shadows(
        &self,
        screen: &Screen,
        facets: &ScreenTriangles<'_>,
        reach: &Reach<'_>,
        bands: [usize; 2],
    ) -> Vec<Shadow> {
        if !self.plan.needs(Stage::Shadows) {
            return Vec::new();
        }
        let groups = self.group_transmittance.len();
        let shadow = |lamp: &LampPoint| Shadow::new(&self.casters, *lamp, screen, facets, reach, bands, groups);
        self.lamps.par_iter().map(shadow).collect()
    }

    /// For each lamp, whether points are in its shadow; none where no surface is curved.
    fn enclosed<'s>(&'s self, shadows: &'s [Shadow]) -> Vec<Option<ShadowVolumes<'s>>> {
        let groups = self.group_transmittance.len();
        let of = |Shadow { light, facing, silhouettes, .. }: &'s Shadow| {
            let new = || ShadowVolumes::new(&self.casters, *light, facing, silhouettes, groups).sorted();
            self.world.appearance.curved.then(new)
        };
        shadows.par_iter().map(of).collect()
    }

    fn shader<'s>(
        &'s self,
        eye: &'s CameraRays,
        enclosed: &'s [Option<ShadowVolumes<'s>>],
        others: Option<OtherSurfaces<'s>>,
        [is_parallel, matte]: [bool; 2],
    ) -> Shader<'s> {
        let sources = || self.world.appearance.sources.iter().map(|(_, source)| source);
        let (has_surfaces, has_sky) = (sources().any(LightSource::is_surface), sources().any(LightSource::is_infinite));
        let wavelengths = &self.world.appearance.wavelengths;
        let background = || {
            let seen = |wavelength_set| {
                wavelengths.to_srgb(
                    wavelength_set,
                    self.world.appearance.escaped_radiance(&AHEAD, None, wavelength_set, |_, _| 1.0),
                )
            };
            (0..wavelengths.count()).map(seen).sum::<DVec3>() / wavelengths.count() as f64
        };
        Shader {
            appearance: &self.world.appearance,
            world: Some(&self.world).filter(|_| self.has_rays()),
            casters: &self.casters,
            lamps: &self.lamps,
            sky_light: self.sky_light.as_ref(),
            solution: self.solution.as_deref(),
            others,
            enclosed,
            group_transmittance: &self.group_transmittance,
            eye,
            is_plain: wavelengths.count() == 1 && !has_surfaces && self.group_transmittance.len() == 1,
            matte,
            has_surfaces,
            has_sky,
            is_parallel,
            background: (!has_surfaces && !has_sky).then(background),
        }
    }

    /// Whether rays are traced at all.
    fn has_rays(&self) -> bool {
        !(self.for_rays.is_empty() && self.lit_by_others.is_empty())
    }

    /// Gathers the light that surfaces send each other; none if it was stopped.
    fn others<'s>(
        &'s self,
        finisher: &'s RayFinisher<'s>,
        eye: &CameraRays,
        order: &RenderOrder,
        stopped: &(dyn Fn() -> bool + Sync),
    ) -> Option<(OtherSurfaces<'s>, RayCounts)> {
        let _stage = stage!("gathering light of other surfaces");
        let triangles = self.lit_by_others.as_slice();
        let size = [order.width, order.height].map(|side| side as usize);
        let needs = |triangle: u32| triangles[triangle as usize];
        let places = RecordPlaces { world: &self.world, finisher, eye, size, needs: &needs, samples: order.samples };
        let (cache, rays) = IrradianceCache::new(&places, stopped)?;
        let directions = directions(order.samples, 1);
        Some((OtherSurfaces { cache, finisher, directions, triangles, width: size[0] }, rays))
    }

    fn draw(
        &self,
        film: &mut Film,
        picture: &mut Picture,
        view: &View,
        order: &RenderOrder,
        stopped: &(dyn Fn() -> bool + Sync),
        stage: &StageSpan,
    ) -> Result<(BandCounts, bool), RenderError> {
        let prepared = self.world.prepared();
        let samples = order.samples.max(1);
        let size = [order.width, order.height];
        let new_eye = || CameraRays::new(view, order.width, order.height, &prepared.bounds).ok_or(RenderError::View);
        let filter = prepared.settings.light.texture_filter.max(1e-3);
        // Where the samples of a pixel are too many to be drawn together, the groups of them share it.
        let groups = (samples as usize).div_ceil(MOST_LINES) as f64;
        let with_cones = |eye: CameraRays, parts: f64| match self.plan.needs(Stage::Textures) {
            true => eye.with_cones(filter / parts.sqrt()),
            false => eye,
        };
        let (eye, eye_of_samples) = (with_cones(new_eye()?, groups), with_cones(new_eye()?, f64::from(samples)));
        let finisher = self.has_rays().then(|| RayFinisher::new(&self.world, self.plan, &eye_of_samples, order));
        let of_samples = finisher.as_ref().filter(|_| !self.for_rays.is_empty());
        let finishing = of_samples.map(|finisher| Finishing { finisher, triangles: &self.for_rays, stopped });
        let mut cost = BandCounts::default();
        let others = match finisher.as_ref().filter(|_| !self.lit_by_others.is_empty()) {
            Some(finisher) => {
                let eye = new_eye()?.with_cones(1.0);
                let Some((others, rays)) = self.others(finisher, &eye, order, stopped) else {
                    return Ok((cost, false));
                };
                cost.rays = rays;
                Some(others)
            }
            None => None,
        };
        let screen = Screen::new(view, size, samples, &prepared.bounds).ok_or(RenderError::View)?;
        let offsets = rooks(samples);
        let rows = (MOST_LINES / samples as usize).max(1);
        let lines = rows * samples as usize;
        let bands = (order.height as usize).div_ceil(rows);
        let facets = ScreenTriangles::new(prepared, &self.triangles, &self.passable, &screen, lines, bands);
        let reach = Reach::new(&prepared.bounds, &screen);
        let shadows = self.shadows(&screen, &facets, &reach, [lines, bands]);
        let enclosed = self.enclosed(&shadows);
        let is_parallel = matches!(screen.viewpoint, Viewpoint::Towards(_));
        let work = PictureWork {
            shader: self.shader(&eye, &enclosed, others, [is_parallel, order.matte]),
            finishing,
            facets: &facets,
            shadows: &shadows,
            offsets: &offsets,
            places: offsets
                .iter()
                .zip(0..)
                .map(|(x, line)| [*x, (f64::from(line) + 0.5) / f64::from(samples)])
                .collect(),
            handed: screen.handed(),
            width: order.width as usize,
            rows,
        };
        let done = AtomicU64::new(0);
        let drawn: Vec<Option<BandCounts>> = film
            .tallies_mut()
            .par_chunks_mut(order.width as usize * rows)
            .zip(picture.pixels_mut().par_chunks_mut(order.width as usize * rows))
            .enumerate()
            .map_init(BandScratch::default, |tools, (band, (tallies, pixels))| {
                if stopped() {
                    return None;
                }
                let _band = part!(stage, "band", band);
                let counts = work.band(self, band, tallies, tools)?;
                pixels.iter_mut().zip(&*tallies).for_each(|(pixel, tally)| *pixel = tally.pixel());
                let rows = (tallies.len() / work.width) as u64;
                let done = done.fetch_add(rows, Ordering::Relaxed) + rows;
                stage.progress(done as f64);
                Some(counts)
            })
            .collect();
        let complete = drawn.iter().all(Option::is_some);
        Ok((drawn.into_iter().flatten().fold(cost, |a, b| a + b), complete))
    }
}

impl<'a> PictureWork<'a> {
    /// Draws a band of the picture; none, and no sample, if it was stopped before its end.
    fn band(
        &self,
        scan: &ScanLine<'_>,
        band: usize,
        tallies: &mut [Tally],
        tools: &mut BandScratch<'a>,
    ) -> Option<BandCounts> {
        let samples = self.offsets.len();
        let first = band * self.rows * samples;
        let last = first + tallies.len() / self.width * samples;
        let mut drawn = SpanCounts::default();
        let BandScratch { strip, counts, finished, pixel: scratch } = tools;
        scratch.clear();
        tallies.fill(Tally::default());
        finished.clear();
        finished.resize(if self.finishing.is_some() { tallies.len() } else { 0 }, false);
        counts.resize_with(self.shadows.len(), Vec::new);
        for begin in (first..last).step_by(MOST_LINES) {
            let range = begin..(begin + MOST_LINES).min(last);
            let lines = SampleLines::new(range.clone(), self.width, self.offsets);
            strip.spans = 0;
            self.facets.rasterize(band, &lines, strip);
            drawn.surfaces += strip.spans;
            for (shadow, counts) in self.shadows.iter().zip(counts.iter_mut()) {
                drawn.shadows += shadow.count(&scan.casters, self.handed, band, &lines, strip, counts);
            }
            for row in range.start / samples..range.end.div_ceil(samples) {
                let from = range.start.max(row * samples);
                let to = range.end.min((row + 1) * samples);
                let places = &self.places[from - row * samples..to - row * samples];
                let part = (places.len() as f64).recip();
                let mean = [0, 1].map(|i| places.iter().map(|place| place[i]).sum::<f64>() * part);
                let begin = from - row * samples;
                for column in 0..self.width {
                    let first = (from - range.start) * self.width + column;
                    let at = [column, row];
                    let pixel = StripPixel { at, first, stride: self.width, begin, places, mean, part };
                    let number = (row - band * self.rows) * self.width + column;
                    if let Some(finishing) = &self.finishing {
                        let Some(count) = finishing.finish(&pixel, strip, &mut scratch.finishing) else {
                            tallies.fill(Tally::default());
                            return None;
                        };
                        finished[number] |= count > 0;
                        if count == pixel.count() {
                            let samples = scratch.finishing.samples.iter().flatten();
                            samples.for_each(|sample| tallies[number].add_alike(sample, 1));
                            continue;
                        }
                    }
                    self.shader.shade(&pixel, strip, counts, scratch, &mut tallies[number]);
                }
            }
        }
        let (rays, by_rays) = scratch.finishing.take_counts();
        let pixels = finished.iter().filter(|finished| **finished).count() as u64;
        Some(BandCounts { spans: drawn, rays, finished: FinishedCounts { pixels, ..by_rays } })
    }
}

/// For each triangle, whether something is seen straight through it; nothing where that is so for none. Glass, which
/// bends light, is seen through; rough glass throws the shadow of an opaque body.
fn passable_triangles(appearance: &Appearance<'_>, groups: &[u8]) -> Vec<bool> {
    let prepared = appearance.prepared;
    let is_glass = |triangle: u32| {
        let object = prepared.object_of[triangle as usize];
        appearance.bsdf(object, prepared.material_number(triangle)).interior.is_some()
    };
    let is_passable =
        |triangle: u32| groups.get(triangle as usize).is_some_and(|group| *group > 0) || is_glass(triangle);
    let passable: Vec<bool> = (0..prepared.triangles.len() as u32).map(is_passable).collect();
    if passable.contains(&true) { passable } else { Vec::new() }
}

/// For each triangle, the group of casters that it is of, and the transmittance of each group; no groups where all are
/// opaque.
///
/// A surface of a polished body lets through what it does at right angles, less what is absorbed on half of the mean
/// chord: light goes through two of them.
fn groups(appearance: &Appearance<'_>) -> (Vec<u8>, Vec<Vec<Channels>>) {
    let prepared = appearance.prepared;
    let sets = 0..appearance.wavelengths.count();
    let mut passing: Vec<Vec<Channels>> = vec![sets.clone().map(|_| Channels::ZERO).collect()];
    if !(appearance.has_passable || appearance.has_clear_shadows) {
        return (Vec::new(), passing);
    }
    let mut groups = vec![0; prepared.triangles.len()];
    let mut known: Vec<((u32, u32), u8)> = Vec::new();
    for triangle in 0..prepared.triangles.len() as u32 {
        let key = (prepared.object_of[triangle as usize], prepared.material_number(triangle));
        let group = known.iter().rev().find(|(other, _)| *other == key).map(|(_, group)| *group);
        groups[triangle as usize] = group.unwrap_or_else(|| {
            let bsdf = appearance.bsdf(key.0, key.1);
            let place = || prepared.texture_place(triangle, [1.0 / 3.0; 3], Default::default());
            let body = bsdf.interior.as_ref().filter(|_| appearance.has_clear_shadows && bsdf.is_clear());
            let chord = body.map(|_| mean_chord(prepared, key.0));
            let passes = |wavelength_set: usize| match body.zip(chord) {
                Some((interior, chord)) => {
                    let surface = bsdf.clear_transmittance(wavelength_set, 1.0, place);
                    surface * interior.absorption.of(wavelength_set).map(|absorption| (-absorption * 0.5 * chord).exp())
                }
                None => bsdf.straight_transmittance(wavelength_set, 1.0, place),
            };
            let passes: Vec<Channels> = sets.clone().map(passes).collect();
            let is_opaque = passes.iter().all(|part| part.max() <= 0.0);
            let same = passing.iter().skip(1).position(|other| *other == passes);
            let group = match same {
                _ if is_opaque => 0,
                Some(place) => place + 1,
                None => {
                    passing.push(passes);
                    passing.len() - 1
                }
            };
            let group = group.min(MOST_GROUPS) as u8;
            known.push((key, group));
            group
        });
    }
    passing.truncate(MOST_GROUPS + 1);
    (groups, passing)
}

/// The mean length of straight lines through a closed object, four times its volume over its area.
///
/// # Source
/// Cauchy's formula for convex bodies.
fn mean_chord(prepared: &Prepared, object: u32) -> f64 {
    let object = &prepared.objects[object as usize];
    let middle = 0.5 * (object.bounds.min + object.bounds.max);
    let (mut volume, mut area) = (0.0, 0.0);
    for triangle in object.first..object.first + object.count {
        let [a, b, c] = prepared.corners(triangle).map(|corner| corner - middle);
        volume += a.dot(b.cross(c)) / 6.0;
        area += 0.5 * (b - a).cross(c - a).length();
    }
    if area > 0.0 { 4.0 * volume.abs() / area } else { 0.0 }
}

impl Renderer for ScanLine<'_> {
    /// Takes all samples at once: a target of the error is not looked at.
    fn left_out(&self, view: &View) -> Vec<&'static str> {
        let mut left_out = Vec::new();
        if self.solution.is_some() {
            left_out.push("only what surfaces reflect diffusely is seen: no mirrors, no glass, no highlights, no light through leaves");
        } else {
            let light = &self.world.prepared().settings.light;
            if self.plan.needs(Stage::Reflection) && light.interreflection == Interreflection::Solved {
                left_out.push("the light of radiosity is not seen");
            }
            if light.caustics != Caustics::LeftOut {
                left_out.push("mirrors and glass throw no light: there are no caustics");
            }
        }
        if self.solution.is_none()
            && self.lit_by_others.is_empty()
            && self.world.appearance.sources.iter().any(|(_, source)| source.is_sky())
        {
            left_out.push("the light of the sky throws no shadows");
        }
        if self.world.prepared().settings.image.filter != Filter::Box {
            left_out.push("pixels are means over their areas: the filter is a box");
        }
        if self.plan.needs(Stage::Motion) || view.moves() {
            left_out.push("what moves stands where it is in the middle of the time in which the shutter is open");
        }
        if let View::Camera(camera) = view
            && camera.lens.is_some()
        {
            left_out.push("the lens is a pinhole");
        }
        left_out
    }

    fn render(&self, view: &View, order: &RenderOrder, watch: &Watch<'_>) -> Result<Rendering, RenderError> {
        let stage = stage!("rendering", f64::from(order.height), "rows");
        let workers = Workers::new(order.threads)?;
        let late = || order.seconds.is_some_and(|seconds| stage.seconds() >= seconds);
        let stopped = || watch.is_cancelled() || late();
        let mut film = Film::untouched(order.width, order.height)?;
        let mut picture = Picture::new(order.width, order.height)?;
        let (BandCounts { spans, rays, finished }, complete) =
            workers.install(|| self.draw(&mut film, &mut picture, view, order, &stopped, &stage))?;
        let (seconds, threads) = (stage.seconds(), workers.count());
        Ok(Rendering { picture, film, complete, rays, spans, finished, flux_balance: None, seconds, threads })
    }
}
