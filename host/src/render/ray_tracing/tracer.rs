//! Follows the legs of a sample's way from the eye: what each meets, and where it goes on.

use super::direct::DirectLighting;
use super::draws::{PathSampler, SampleDimension};
use super::encounter::{PathVertex, power_heuristic};
use super::explain::{PathLog, PathNote};
use crate::color::Channels;
use crate::color::srgb::LUMINANCE;
use crate::illumination::light::LightSource;
use crate::illumination::optics::{LobeSelection, BsdfSample, ShadingContext};
use crate::numeric::ray::Ray;
use crate::render::indirect::{IndirectLight, IrradiancePart};
use crate::render::two_way::PhotonEstimator;
use crate::render::world::{RayCone, SurfaceInteraction, Media, RayHit, BoundedRay, World, diffuse_albedo};
use crate::render::{PathClass, RayCounts};
use crate::scene::Caustics;
use glam::DVec3;

/// Legs that would pass on less than this fraction of the light are followed by chance only, and then count for more.
pub const ENERGY_CUTOFF: f64 = 1.0 / 4096.0;
/// Where a way parts, both parts are followed as long as each passes on so much of the light.
const LEAST_SPLIT: f64 = 1.0 / 64.0;
/// What a lamp reflects on an element that is seen by spread light is cut off at this value, 1/sr, unless caustics count:
/// a diffuse surface has at most 1/π.
///
/// # Source
/// Ours, in the place of the path regularisation of Kaplanyan and Dachsbacher 2013.
const HIGHEST: f64 = 1.0;
/// Most legs of a sample that wait to be followed.
const MOST_WAITING: usize = 8;

/// A part of a sample's way.
#[derive(Clone, Copy)]
struct PathSegment {
    sight: BoundedRay,
    /// How much of the radiance along it comes to the eye.
    passed: Channels,
    /// How much of the light of a lamp counts that it meets.
    lamps: f64,
    /// How far from the beginning of its ray it begins, scene units: more than 0 behind what it went straight through.
    begin: f64,
    /// How many legs came before it.
    depth: u32,
    /// Unlike that of all other legs of the sample.
    number: u32,
    /// The density with which its direction was drawn, 1/sr; none where there was no choice.
    density: Option<f64>,
    /// The normal of the element from which it goes on.
    normal: Option<DVec3>,
    /// What it goes through.
    media: Media,
    /// The only lane that is left, after wavelengths parted.
    lane: Option<usize>,
    /// Whether it only looks for lights: it is one too many for anything else.
    for_lights: bool,
    /// Which turns its light takes from here to the eye.
    course: PathHistory,
    /// What its last turn was.
    turn: LastScattering,
    /// Whether light that was followed from lamps counts nothing on it: it was caught where narrow turns bring it to a
    /// broad one.
    is_known: bool,
    /// Whether a denoiser is guided by what it meets: it comes from the eye, by mirrors and smooth interfaces alone.
    guides: bool,
}

/// Which turns light takes to the eye, by the lobes that it goes on from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PathHistory {
    /// No broad one.
    NoBroad,
    /// A broad one first, and none but narrow ones behind.
    OneBroad,
    /// Narrow ones first, then a broad one, and none but narrow ones behind: what is met there is a caustic.
    Caustic,
    /// Several broad ones.
    SeveralBroad,
}

impl PathHistory {
    /// With a turn before those that it has.
    fn extended(self, is_broad: bool) -> PathHistory {
        match (self, is_broad) {
            (PathHistory::NoBroad, true) => PathHistory::OneBroad,
            (_, true) => PathHistory::SeveralBroad,
            (PathHistory::OneBroad, false) => PathHistory::Caustic,
            (course, false) => course,
        }
    }

    /// The class of light that leaves a lamp on it.
    fn class(self) -> PathClass {
        match self {
            PathHistory::NoBroad => PathClass::Emitted,
            PathHistory::OneBroad => PathClass::Direct,
            PathHistory::Caustic => PathClass::Caustic,
            PathHistory::SeveralBroad => PathClass::Indirect,
        }
    }
}

/// What the turns of a leg were since light was spread last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LastScattering {
    /// None: it was spread.
    NonDelta,
    /// It went through polished interfaces only.
    ClearInterface,
    /// Others.
    Other,
}

/// What a sample found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathResult {
    /// Radiance of each class.
    pub(super) radiance: [Channels; PathClass::ALL.len()],
    /// Radiance of each class at other wavelengths than those of the sample, linear sRGB.
    pub(super) other: [DVec3; PathClass::ALL.len()],
    /// Whether the first leg met an object or light.
    pub(super) covered: bool,
    /// What it met: distance from the eye, normal, object and material.
    pub(super) first: Option<FirstHit>,
    /// Variance of its luminance by the chance in caught light that is seen, which other samples share.
    pub(super) shared: f64,
    /// The albedo that is seen, straight or by mirrors and smooth interfaces; a light counts as 1.
    pub(super) albedo: Channels,
    /// The normals there, each times the part of the light that comes to the eye.
    pub(super) normal: DVec3,
}

impl PathResult {
    fn add(&mut self, class: PathClass, radiance: Channels) {
        self.radiance[class as usize] += radiance;
    }

    /// A light that a leg meets.
    fn record_light_albedo(&mut self, leg: &PathSegment) {
        if leg.guides {
            self.albedo += leg.passed;
        }
    }
}

/// The first element in sight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FirstHit {
    pub(super) distance: f64,
    pub(super) normal: DVec3,
    pub(super) object: u32,
    pub(super) material: u32,
}

/// What one thread needs for its samples, one after the other.
#[derive(Default)]
pub(super) struct PathScratch {
    /// How many rays were traced.
    pub(super) counts: RayCounts,
    /// Legs that wait to be followed; none between samples.
    waiting: Vec<PathSegment>,
}

/// Who counts rays, and who listens.
struct SampleRecord<'a, 'b> {
    counts: &'a mut RayCounts,
    log: &'a mut PathLog<'b>,
    seen: &'a mut PathResult,
}

/// Follows rays through a scene as its plan tells.
pub(super) struct PathTracer<'a> {
    world: &'a World<'a>,
    direct: DirectLighting<'a>,
    /// Most legs after the first.
    depth: u32,
    caustics: Caustics,
    /// Light that was caught on its way from lamps.
    caught: Option<&'a PhotonEstimator<'a>>,
    /// Light that diffuse surfaces send each other, if it is known already.
    indirect: Option<&'a dyn IndirectLight>,
    /// Whether there is light that is not followed from where it comes from.
    has_others: bool,
    /// What the eye is in.
    around: Media,
    /// Whether a denoiser is to be guided.
    guides: bool,
}

impl<'a> PathTracer<'a> {
    /// - `depth`: most legs after the first. `shadows`: whether anything can stand before a light.
    /// - `catches`: whether light of lamps was followed; `caught` is what was caught. `around`: what the eye is in.
    /// - `indirect`: light that diffuse surfaces send each other, if it is known already.
    /// - `guides`: whether samples tell what guides a denoiser.
    pub(super) fn new(
        world: &'a World<'a>,
        depth: u32,
        shadows: bool,
        (catches, caught): (bool, Option<&'a PhotonEstimator<'a>>),
        indirect: Option<&'a dyn IndirectLight>,
        around: Media,
        guides: bool,
    ) -> PathTracer<'a> {
        let settings = &world.appearance.prepared.settings;
        let caustics = match settings.light.caustics {
            // Rays from the eye may not find again what was caught.
            _ if catches => Caustics::PhotonMapped,
            Caustics::PathTraced => Caustics::PathTraced,
            _ => Caustics::LeftOut,
        };
        let appearance = &world.appearance;
        let has_others =
            appearance.ambient.is_some() || appearance.sources.iter().any(|(_, source)| !source.emits_photons());
        let direct = DirectLighting::new(world, shadows, settings.light.samples.max(1));
        PathTracer { world, direct, depth, caustics, caught, indirect, has_others, around, guides }
    }

    /// The radiance that arrives along a line of sight.
    pub(super) fn radiance(
        &self,
        sight: &BoundedRay,
        comb: usize,
        draws: &PathSampler,
        work: &mut PathScratch,
        mut log: PathLog<'_>,
    ) -> PathResult {
        let mut seen = PathResult::default();
        let first = PathSegment {
            sight: *sight,
            passed: Channels::ONE,
            lamps: 1.0,
            begin: 0.0,
            depth: 0,
            number: 1,
            density: None,
            normal: None,
            media: self.around,
            lane: None,
            for_lights: false,
            course: PathHistory::NoBroad,
            turn: LastScattering::Other,
            is_known: false,
            guides: self.guides,
        };
        let PathScratch { counts, waiting } = work;
        waiting.push(first);
        while let Some(leg) = waiting.pop() {
            match leg.depth {
                0 => counts.primary += 1,
                _ => counts.reflected += 1,
            }
            let direction = leg.sight.ray.direction;
            match self.world.intersect(&leg.sight, comb, draws.time) {
                RayHit::Nothing => {
                    let radiance = match leg.for_lights && !self.direct.has_sky() {
                        true => Channels::ZERO,
                        false => {
                            let ray = Ray { direction: direction.normalize(), ..leg.sight.ray };
                            let part = |sky: &LightSource, density| self.mis_weight(&leg, sky, density);
                            self.world.appearance.escaped_radiance(&ray, leg.normal, comb, part)
                        }
                    };
                    seen.add(leg.course.class(), leg.passed * radiance);
                    seen.record_light_albedo(&leg);
                    seen.covered |= leg.depth > 0;
                    log.note(|| PathNote::term(leg.depth, "meets nothing", leg.passed * radiance));
                }
                RayHit::Light(index, glow) => {
                    let absorbed = leg.media.transmittance(self.world, glow.t * direction.length() - leg.begin, comb);
                    let (number, source) = &self.world.appearance.sources[index];
                    let radiance = absorbed * glow.radiance * self.mis_weight(&leg, source, glow.density);
                    seen.add(leg.course.class(), leg.passed * radiance);
                    seen.record_light_albedo(&leg);
                    seen.covered = true;
                    log.note(|| PathNote::light(leg.depth, *number, leg.passed * radiance));
                }
                RayHit::Surface(found) => {
                    if leg.depth == 0 {
                        let SurfaceInteraction { depth, object, material, .. } = found;
                        seen.first = Some(FirstHit { distance: depth, normal: found.element.normal, object, material });
                    }
                    seen.covered = true;
                    let counting = &mut SampleRecord { counts, log: &mut log, seen: &mut seen };
                    self.scatter(leg, &found, (comb, draws), counting, waiting);
                }
            }
        }
        seen
    }

    /// What an element sends back along a leg, and the legs that go on from there.
    fn scatter(
        &self,
        mut leg: PathSegment,
        found: &SurfaceInteraction<'_>,
        (comb, draws): (usize, &PathSampler),
        SampleRecord { counts, log, seen }: &mut SampleRecord<'_, '_>,
        waiting: &mut Vec<PathSegment>,
    ) {
        let optics = found.optics;
        let towards = leg.sight.ray.direction.normalize();
        leg.passed *= leg.media.transmittance(self.world, found.distance - leg.begin, comb);
        let crossing = leg.media.crossing(self.world, found, &leg.sight.ray);
        if !crossing.is_interface {
            let sight = BoundedRay { t_min: crossing.last, ..leg.sight };
            waiting.push(PathSegment { sight, begin: found.distance, media: crossing.media, ..leg });
            return;
        }
        log.note(|| PathNote::element(leg.depth, self.world.appearance.prepared, found));
        if let Some((emission, factor)) =
            self.world.emitted(found, towards, comb, |source, density| self.mis_weight(&leg, source, density))
        {
            let radiance = leg.passed * emission * factor;
            seen.add(leg.course.class(), radiance);
            seen.record_light_albedo(&leg);
            log.note(|| PathNote::term(leg.depth, "emits", radiance));
        }
        if leg.for_lights && !optics.is_passable() {
            return;
        }
        let frame = found.frame();
        // Where wavelengths part, the one that is left is drawn together with the comb, as often as it will be seen.
        let drawn = match leg.lane {
            None if found.disperses() => {
                let visibility = self.world.appearance.wavelengths.visibility(comb);
                leg.passed.sample_lane(visibility, draws.point(SampleDimension::Wavelengths)[1])
            }
            _ => None,
        };
        let (lane, alone) = drawn.unwrap_or((leg.lane.unwrap_or(0), leg.passed));
        let side = crossing.indices(self.world, comb);
        let sighting = ShadingContext { view: frame.local(-towards), comb, side, lane, painted: found.texture_values() };
        if leg.for_lights {
            let onward = optics.straight_sample(&sighting);
            waiting.extend(onward.and_then(|onward| self.straight_segment(&leg, found, (onward, 0), draws)));
            return;
        }
        if leg.guides {
            let passed = self.world.appearance.wavelengths.broad_bands(leg.passed).element_sum() / 3.0;
            seen.albedo += leg.passed * optics.non_delta_albedo(&sighting);
            seen.normal += found.element.normal * passed;
        }
        if let Some(ambient) = &self.world.appearance.ambient {
            let radiance = leg.passed * optics.ambient(&sighting) * ambient.of(comb);
            seen.add(PathClass::Indirect, radiance);
            log.note(|| PathNote::term(leg.depth, "ambient light", radiance));
        }
        if let Some(radiance) = self.indirect(found, comb).filter(|_| !leg.is_known) {
            seen.add(PathClass::Indirect, leg.passed * radiance);
            log.note(|| PathNote::term(leg.depth, "light of other surfaces", leg.passed * radiance));
        }
        let is_worth = |onward: BsdfSample| (leg.passed * onward.weight).max() > LEAST_SPLIT;
        let (count, all_worth) =
            optics.specular_samples(&sighting).fold((0, true), |(count, all), onward| (count + 1, all && is_worth(onward)));
        let directions = count + usize::from(optics.continues_non_delta());
        let parts = directions <= 1 || waiting.len() + directions <= MOST_WAITING && all_worth;
        let among = if parts { LobeSelection::NonDelta } else { LobeSelection::All };
        let highest = self.clamp_value(&leg);
        let encounter = PathVertex {
            found,
            behind: crossing.media,
            frame,
            sighting,
            draws: *draws,
            leg: leg.number,
            among,
            highest,
            is_known: leg.is_known,
            alone,
        };
        if optics.has_non_delta() {
            let add = |number, radiance| log.note(|| PathNote::direct_light(leg.depth, number, leg.passed * radiance));
            let light = self.direct.radiance(&encounter, counts, add);
            for (is_broad, radiance) in [true, false].into_iter().zip(light) {
                seen.add(leg.course.extended(is_broad).class(), leg.passed * radiance);
            }
        }
        if let Some(caught) = self.caught.filter(|_| optics.stores_photons() && !leg.is_known) {
            let (light, error) =
                caught.radiance_estimate(found, &encounter.sighting, (leg.passed, leg.lane.is_some()), leg.course != PathHistory::NoBroad);
            let first = leg.course.extended(true).extended(false).class();
            if leg.course == PathHistory::NoBroad {
                let seen_as = |(radiance, other): (Channels, DVec3)| {
                    self.world.appearance.wavelengths.to_srgb(comb, radiance) + other
                };
                let luminance = light.map(seen_as).into_iter().sum::<DVec3>().dot(LUMINANCE);
                seen.shared += (luminance * error).powi(2);
            }
            for (class, (radiance, elsewhere)) in [first, PathClass::Indirect].into_iter().zip(light) {
                seen.add(class, radiance);
                seen.other[class as usize] += elsewhere;
                log.note(|| PathNote::term(leg.depth, "caught light", radiance));
            }
        }
        if optics.continues_paths() {
            let point = draws.for_segment(leg.number, SampleDimension::Direction, 0);
            let [choice, _] = draws.for_segment(leg.number, SampleDimension::Choice, 0);
            if parts {
                let drawn = optics.continues_non_delta().then(|| optics.sample(&sighting, choice, point, among)).flatten();
                let legs = optics.specular_samples(&sighting).zip(0..).chain(drawn.map(|onward| (onward, 2)));
                waiting.extend(legs.filter_map(|(onward, branch)| self.next_segment(&leg, &encounter, onward, branch)));
            } else {
                let drawn = optics.sample(&sighting, choice, point, among);
                waiting.extend(drawn.and_then(|onward| self.next_segment(&leg, &encounter, onward, 0)));
            }
        }
    }

    /// Radiance of an element by light of other diffuse ones, as far as it is known already.
    fn indirect(&self, found: &SurfaceInteraction<'_>, comb: usize) -> Option<Channels> {
        let indirect = self.indirect.filter(|_| found.optics.is_diffuse())?;
        let corners = self.world.appearance.prepared.corners(found.triangle);
        let weights = crate::numeric::triangle::weights(corners, found.element.position);
        let irradiance = indirect.irradiance(found.triangle, found.element.outside, weights, IrradiancePart::Indirect);
        Some(diffuse_albedo(found.optics, comb, found.texture_values()) * irradiance * std::f64::consts::FRAC_1_PI)
    }

    /// How much a light counts that a leg meets.
    ///
    /// - `density`: with which the light would have drawn the leg's direction.
    fn mis_weight(&self, leg: &PathSegment, source: &LightSource, density: f64) -> f64 {
        let is_caustic = leg.density.is_none() && leg.course != PathHistory::NoBroad;
        match self.caustics {
            // What is not followed from lamps counts wherever it is met.
            Caustics::PhotonMapped if !source.emits_photons() => power_heuristic(leg.density, density),
            Caustics::PhotonMapped if leg.is_known => 0.0,
            // A shadow ray has gone through what is polished.
            Caustics::LeftOut if leg.turn == LastScattering::ClearInterface && self.world.appearance.clears => 0.0,
            Caustics::LeftOut if source.is_sky() => power_heuristic(leg.density, density),
            Caustics::PhotonMapped | Caustics::LeftOut if is_caustic => 0.0,
            _ => leg.lamps * power_heuristic(leg.density, density),
        }
    }

    /// The greatest value with which narrow lobes may reflect a lamp where a leg arrives, 1/sr.
    fn clamp_value(&self, leg: &PathSegment) -> f64 {
        match self.caustics {
            Caustics::PhotonMapped if leg.course != PathHistory::NoBroad => 0.0,
            Caustics::LeftOut if leg.course != PathHistory::NoBroad => HIGHEST,
            _ => f64::INFINITY,
        }
    }

    /// The leg that goes on in a direction; none if it is not worth following.
    fn next_segment(&self, leg: &PathSegment, encounter: &PathVertex<'_>, onward: BsdfSample, branch: u32) -> Option<PathSegment> {
        let PathVertex { found, frame, sighting, draws, highest, alone, .. } = *encounter;
        if onward.is_straight {
            return self.straight_segment(leg, found, (onward, branch), &draws);
        }
        let through = onward.light.z < 0.0;
        let parts_wavelengths = through && leg.lane.is_none() && found.disperses();
        // Beyond the last leg, a direction that might have been drawn for a light still looks for it.
        let is_last = leg.depth >= self.depth;
        if is_last && (onward.density.is_none() || !self.direct.has_area_lights()) {
            return None;
        }
        let goes_back = self.caustics == Caustics::PhotonMapped && !onward.is_broad && leg.course != PathHistory::NoBroad;
        let is_known = leg.is_known || goes_back;
        if is_known && !self.has_others {
            return None;
        }
        let passed = if parts_wavelengths { alone } else { leg.passed } * onward.weight;
        let number = leg.number.wrapping_mul(3).wrapping_add(branch);
        let passed = russian_roulette(passed, number, &draws)?;
        let element = &found.element;
        let direction = frame.world(onward.light);
        // Of a spread lobe, what falls on the wrong side of the triangle or its surface is lost.
        if onward.density.is_some() && (direction.dot(element.plane(!through)) < 0.0) != through {
            return None;
        }
        let direction = element.righted(direction, !through);
        let media = if through { encounter.behind } else { leg.media };
        let lamps = match onward.density {
            Some(density) if highest.is_finite() && !onward.is_broad => {
                (highest * onward.light.z.abs() / (onward.weight.max() * density)).clamp(0.0, 1.0)
            }
            _ => 1.0,
        };
        let origin = if through { element.through } else { element.leave };
        let turn = match (onward.density, leg.turn) {
            (Some(_), _) => LastScattering::NonDelta,
            (None, LastScattering::NonDelta | LastScattering::ClearInterface) if through => LastScattering::ClearInterface,
            _ => LastScattering::Other,
        };
        Some(PathSegment {
            sight: BoundedRay {
                ray: Ray { origin, direction },
                t_min: 0.0,
                t_max: f64::INFINITY,
                // A curved mirror widens it more; its many samples make up for that.
                cone: RayCone { width: leg.sight.cone.at(found.distance), ..leg.sight.cone },
            },
            passed,
            lamps,
            begin: 0.0,
            depth: leg.depth + 1,
            number,
            density: onward.density,
            normal: Some(element.normal),
            media,
            lane: if parts_wavelengths { Some(sighting.lane) } else { leg.lane },
            for_lights: is_last,
            course: leg.course.extended(onward.is_broad),
            turn,
            is_known,
            guides: leg.guides && onward.density.is_none(),
        })
    }

    /// The rest of a leg behind what it goes straight through: the same ray, so that lights are met as if nothing was there.
    fn straight_segment(&self, leg: &PathSegment, found: &SurfaceInteraction<'_>, (onward, branch): (BsdfSample, u32), draws: &PathSampler) -> Option<PathSegment> {
        let is_last = leg.depth >= self.depth;
        if is_last && (leg.density.is_none() || !self.direct.has_area_lights()) {
            return None;
        }
        let number = leg.number.wrapping_mul(3).wrapping_add(branch);
        let passed = russian_roulette(leg.passed * onward.weight, number, draws)?;
        let sight = BoundedRay { t_min: found.t, ..leg.sight };
        let for_lights = leg.for_lights || is_last;
        Some(PathSegment { sight, passed, begin: found.distance, depth: leg.depth + 1, number, for_lights, ..*leg })
    }
}

/// What of a leg is followed: all of it, or, of one that passes little on, by chance more or nothing.
fn russian_roulette(passed: Channels, number: u32, draws: &PathSampler) -> Option<Channels> {
    let most = passed.max();
    if most >= ENERGY_CUTOFF {
        return Some(passed);
    }
    let survival = most / ENERGY_CUTOFF;
    (most > 0.0 && draws.for_segment(number, SampleDimension::Survival, 0)[0] < survival).then(|| passed * survival.recip())
}
