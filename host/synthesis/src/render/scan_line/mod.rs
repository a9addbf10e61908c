//! Scan line: triangles to spans of samples, with shadow volumes (Crow 1977).
//!
//! Each pixel has as many lines of samples as samples, one on each line and in each column of a grid (n rooks). A
//! triangle covers spans of the lines; the nearest is seen, sample by sample, and passable ones before it are kept in
//! their order. Light is found once for each pixel and surface, shadows for each sample.
//!
//! *Not modelled*: only light that comes straight from lights is seen. Mirrors, metals and glass show lights, and for
//! all else around them the ambient light, the same radiance from everywhere, and a blurred sky. Light goes straight
//! through glass, which throws the shadow of an opaque body, and through what is transparent without bending it; the
//! shadow of that is as weak as it lets light through (where a pattern says how much, as in the middle of its first
//! triangle). A light with a size is represented by points of it, in number the `light_samples` of the scene, and is
//! itself no obstacle to others; a sky lights surfaces by the direction of their normals, without shadows; a lens is a
//! pinhole.
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
use super::tally::Tally;
use super::world::{AHEAD, Appearance, CameraRays, World};
use super::{RayCounts, RenderError, RenderOrder, Renderer, Rendering, SpanCounts, Watch};
use crate::color::Channels;
use crate::illumination::light::LightSource;
use crate::picture::{Filter, Picture};
use crate::plan::{Plan, Stage};
use crate::scene::{Prepared, View};
use crate::stages::{StageSpan, Workers, part, stage};
use casters::Casters;
use enclosed::ShadowVolumes;
use glam::DVec3;
use lamp::{LampPoint, LightPosition};
use rayon::prelude::*;
use reach::Reach;
use screen::{Screen, Viewpoint};
use shader::{PixelScratch, Shader};
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
    appearance: Appearance<'a>,
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
    pixel: PixelScratch<'a>,
}

impl<'a> ScanLine<'a> {
    /// Prepares materials and lights, and finds the neighbours of triangles that throw shadows.
    ///
    /// # Errors
    /// [`RenderError::Material`].
    pub fn new(prepared: &'a Prepared, plan: &'a Plan) -> Result<ScanLine<'a>, RenderError> {
        Ok(ScanLine::with_light(Appearance::new(prepared, plan)?, plan, None))
    }

    /// A renderer of the light of a solution by radiosity: no highlights and no ambient light, and no shadows but those
    /// that are in it. It takes materials and lights over from the world that was solved.
    pub fn showing(solution: Arc<dyn IndirectLight>, world: World<'a>, plan: &'a Plan) -> ScanLine<'a> {
        ScanLine::with_light(world.appearance, plan, Some(solution))
    }

    fn with_light(
        appearance: Appearance<'a>,
        plan: &'a Plan,
        solution: Option<Arc<dyn IndirectLight>>,
    ) -> ScanLine<'a> {
        let prepared = appearance.prepared;
        let keeps = |triangle: &u32| plan.includes_object(prepared.object_of[*triangle as usize] as usize);
        let triangles: Vec<u32> = (0..prepared.triangles.len() as u32).filter(keeps).collect();
        let (groups, passing) = groups(&appearance);
        let passable = passable_triangles(&appearance, &groups);
        let shadows = plan.needs(Stage::Shadows) && solution.is_none();
        let casters = Casters::new(prepared, if shadows { triangles.clone() } else { Vec::new() }, groups);
        let samples = prepared.settings.light.samples.max(1);
        let mut lamps = Vec::new();
        for (source, (_, light)) in appearance.sources.iter().enumerate().filter(|_| solution.is_none()) {
            for point in light.points(samples) {
                let position = point.at.map_or(LightPosition::Direction(point.towards), LightPosition::Point);
                lamps.push(LampPoint { source, point, position });
            }
        }
        let sky_light = if solution.is_none() { SkyLight::new(&appearance) } else { None };
        ScanLine {
            plan,
            appearance,
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
        let shadow = |lamp: &LampPoint| Shadow::new(&self.casters, lamp.position, screen, facets, reach, bands, groups);
        self.lamps.par_iter().map(shadow).collect()
    }

    /// For each lamp, whether points are in its shadow; none where no surface is curved.
    fn enclosed<'s>(&'s self, shadows: &'s [Shadow]) -> Vec<Option<ShadowVolumes<'s>>> {
        let groups = self.group_transmittance.len();
        let of = |Shadow { light, facing, silhouettes, .. }: &'s Shadow| {
            let new = || ShadowVolumes::new(&self.casters, *light, facing, silhouettes, groups).sorted();
            self.appearance.curved.then(new)
        };
        shadows.par_iter().map(of).collect()
    }

    fn shader<'s>(
        &'s self,
        eye: &'s CameraRays,
        enclosed: &'s [Option<ShadowVolumes<'s>>],
        is_parallel: bool,
        matte: bool,
    ) -> Shader<'s> {
        let sources = || self.appearance.sources.iter().map(|(_, source)| source);
        let (has_surfaces, has_sky) = (sources().any(LightSource::is_surface), sources().any(LightSource::is_infinite));
        let wavelengths = &self.appearance.wavelengths;
        let background = || {
            let seen = |wavelength_set| {
                wavelengths
                    .to_srgb(wavelength_set, self.appearance.escaped_radiance(&AHEAD, None, wavelength_set, |_, _| 1.0))
            };
            (0..wavelengths.count()).map(seen).sum::<DVec3>() / wavelengths.count() as f64
        };
        Shader {
            appearance: &self.appearance,
            casters: &self.casters,
            lamps: &self.lamps,
            sky_light: self.sky_light.as_ref(),
            solution: self.solution.as_deref(),
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

    fn draw(
        &self,
        film: &mut Film,
        picture: &mut Picture,
        view: &View,
        order: &RenderOrder,
        stopped: &(dyn Fn() -> bool + Sync),
        stage: &StageSpan,
    ) -> Result<(SpanCounts, bool), RenderError> {
        let prepared = self.appearance.prepared;
        let samples = order.samples.max(1);
        let size = [order.width, order.height];
        let eye = CameraRays::new(view, order.width, order.height, &prepared.bounds).ok_or(RenderError::View)?;
        let filter = prepared.settings.light.texture_filter.max(1e-3);
        // Where the samples of a pixel are too many to be drawn together, the groups of them share it.
        let groups = (samples as usize).div_ceil(MOST_LINES) as f64;
        let eye = if self.plan.needs(Stage::Textures) { eye.with_cones(filter / groups.sqrt()) } else { eye };
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
            shader: self.shader(&eye, &enclosed, is_parallel, order.matte),
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
        let drawn: Vec<Option<SpanCounts>> = film
            .tallies_mut()
            .par_chunks_mut(order.width as usize * rows)
            .zip(picture.pixels_mut().par_chunks_mut(order.width as usize * rows))
            .enumerate()
            .map_init(BandScratch::default, |tools, (band, (tallies, pixels))| {
                if stopped() {
                    return None;
                }
                let _band = part!(stage, "band", band);
                let counts = work.band(self, band, tallies, tools);
                pixels.iter_mut().zip(&*tallies).for_each(|(pixel, tally)| *pixel = tally.pixel());
                let rows = (tallies.len() / work.width) as u64;
                let done = done.fetch_add(rows, Ordering::Relaxed) + rows;
                stage.progress(done as f64);
                Some(counts)
            })
            .collect();
        let complete = drawn.iter().all(Option::is_some);
        Ok((drawn.into_iter().flatten().fold(SpanCounts::default(), |a, b| a + b), complete))
    }
}

impl<'a> PictureWork<'a> {
    /// Draws a band of the picture.
    fn band(&self, scan: &ScanLine<'_>, band: usize, tallies: &mut [Tally], tools: &mut BandScratch<'a>) -> SpanCounts {
        let samples = self.offsets.len();
        let first = band * self.rows * samples;
        let last = first + tallies.len() / self.width * samples;
        let mut drawn = SpanCounts::default();
        let BandScratch { strip, counts, pixel: scratch } = tools;
        scratch.clear();
        tallies.fill(Tally::default());
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
                let tallies = &mut tallies[(row - band * self.rows) * self.width..][..self.width];
                for (column, tally) in tallies.iter_mut().enumerate() {
                    let first = (from - range.start) * self.width + column;
                    let pixel = StripPixel { at: [column, row], first, stride: self.width, places, mean, part };
                    self.shader.shade(&pixel, strip, counts, scratch, tally);
                }
            }
        }
        drawn
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
/// A polished body lets through what its two surfaces do at right angles, less what is absorbed on its mean chord.
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
                    surface
                        * surface
                        * interior.absorption.of(wavelength_set).map(|absorption| (-absorption * chord).exp())
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
            left_out.push("only what surfaces reflect diffusely is seen: no mirrors, no glass, no highlights");
        } else if self.plan.needs(Stage::Reflection) {
            left_out.push(
                "mirrors, metals and coats show lights, ambient light and a blurred sky only, and glass bends nothing",
            );
        }
        if self.solution.is_none() && self.appearance.sources.iter().any(|(_, source)| source.is_sky()) {
            left_out.push("the light of the sky throws no shadows");
        }
        if self.appearance.prepared.settings.image.filter != Filter::Box {
            left_out.push("pixels are means over their areas: the filter is a box");
        }
        if self.plan.needs(Stage::Motion) {
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
        let (spans, complete) =
            workers.install(|| self.draw(&mut film, &mut picture, view, order, &stopped, &stage))?;
        let (seconds, threads) = (stage.seconds(), workers.count());
        Ok(Rendering {
            picture,
            film,
            complete,
            rays: RayCounts::default(),
            spans,
            flux_balance: None,
            seconds,
            threads,
        })
    }
}
