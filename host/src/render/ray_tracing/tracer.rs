//! Follows the legs of a sample's way from the eye: what each meets, and where it goes on.

use super::direct::Direct;
use super::draws::{Draws, Purpose};
use super::encounter::{Encounter, counted};
use super::explain::{Log, Note};
use crate::color::Channels;
use crate::color::srgb::LUMINANCE;
use crate::illumination::light::Source;
use crate::illumination::optics::{Among, Onward, Sighting};
use crate::numeric::ray::Ray;
use crate::render::indirect::{IndirectLight, Part};
use crate::render::two_way::CaughtLight;
use crate::render::world::{Cone, Found, Media, Met, Sight, World, diffuse};
use crate::render::{Class, RayCounts};
use crate::scene::Caustics;
use glam::DVec3;

/// Legs that would pass on less than this fraction of the light are followed by chance only, and then count for more.
pub const ENERGY_CUTOFF: f64 = 1.0 / 4096.0;
/// Where a way parts, both parts are followed as long as each passes on so much of the light.
const WORTH_PARTING: f64 = 1.0 / 64.0;
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
struct Leg {
    sight: Sight,
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
    course: Course,
    /// What its last turn was.
    turn: Turn,
    /// Whether light that was followed from lamps counts nothing on it: it was caught where narrow turns bring it to a
    /// broad one.
    is_known: bool,
    /// Whether a denoiser is guided by what it meets: it comes from the eye, by mirrors and smooth interfaces alone.
    guides: bool,
}

/// Which turns light takes to the eye, by the lobes that it goes on from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    /// No broad one.
    Seen,
    /// A broad one first, and none but narrow ones behind.
    Spread,
    /// Narrow ones first, then a broad one, and none but narrow ones behind: what is met there is a caustic.
    Thrown,
    /// Several broad ones.
    Carried,
}

impl Course {
    /// With a turn before those that it has.
    fn after(self, is_broad: bool) -> Course {
        match (self, is_broad) {
            (Course::Seen, true) => Course::Spread,
            (_, true) => Course::Carried,
            (Course::Spread, false) => Course::Thrown,
            (course, false) => course,
        }
    }

    /// The class of light that leaves a lamp on it.
    fn of_lamps(self) -> Class {
        match self {
            Course::Seen => Class::Emitted,
            Course::Spread => Class::Direct,
            Course::Thrown => Class::Caustic,
            Course::Carried => Class::Indirect,
        }
    }
}

/// What the turns of a leg were since light was spread last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    /// None: it was spread.
    Spread,
    /// It went through polished interfaces only.
    Through,
    /// Others.
    Other,
}

/// What a sample found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seen {
    /// Radiance of each class.
    pub(super) radiance: [Channels; Class::ALL.len()],
    /// Radiance of each class at other wavelengths than those of the sample, linear sRGB.
    pub(super) other: [DVec3; Class::ALL.len()],
    /// Whether the first leg met an object or light.
    pub(super) covered: bool,
    /// What it met: distance from the eye, normal, object and material.
    pub(super) first: Option<First>,
    /// Variance of its luminance by the chance in caught light that is seen, which other samples share.
    pub(super) shared: f64,
    /// The albedo that is seen, straight or by mirrors and smooth interfaces; a light counts as 1.
    pub(super) albedo: Channels,
    /// The normals there, each times the part of the light that comes to the eye.
    pub(super) normal: DVec3,
}

impl Seen {
    fn add(&mut self, class: Class, radiance: Channels) {
        self.radiance[class as usize] += radiance;
    }

    /// A light that a leg meets.
    fn guide_by_light(&mut self, leg: &Leg) {
        if leg.guides {
            self.albedo += leg.passed;
        }
    }
}

/// The first element in sight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct First {
    pub(super) distance: f64,
    pub(super) normal: DVec3,
    pub(super) object: u32,
    pub(super) material: u32,
}

/// What one thread needs for its samples, one after the other.
#[derive(Default)]
pub(super) struct Work {
    /// How many rays were traced.
    pub(super) counts: RayCounts,
    /// Legs that wait to be followed; none between samples.
    waiting: Vec<Leg>,
}

/// Who counts rays, and who listens.
struct Counting<'a, 'b> {
    counts: &'a mut RayCounts,
    log: &'a mut Log<'b>,
    seen: &'a mut Seen,
}

/// Follows rays through a scene as its plan tells.
pub(super) struct Tracer<'a> {
    world: &'a World<'a>,
    direct: Direct<'a>,
    /// Most legs after the first.
    depth: u32,
    caustics: Caustics,
    /// Light that was caught on its way from lamps.
    caught: Option<&'a CaughtLight<'a>>,
    /// Light that diffuse surfaces send each other, if it is known already.
    indirect: Option<&'a dyn IndirectLight>,
    /// Whether there is light that is not followed from where it comes from.
    has_others: bool,
    /// What the eye is in.
    around: Media,
    /// Whether a denoiser is to be guided.
    guides: bool,
}

impl<'a> Tracer<'a> {
    /// - `depth`: most legs after the first. `shadows`: whether anything can stand before a light.
    /// - `catches`: whether light of lamps was followed; `caught` is what was caught. `around`: what the eye is in.
    /// - `indirect`: light that diffuse surfaces send each other, if it is known already.
    /// - `guides`: whether samples tell what guides a denoiser.
    pub(super) fn new(
        world: &'a World<'a>,
        depth: u32,
        shadows: bool,
        (catches, caught): (bool, Option<&'a CaughtLight<'a>>),
        indirect: Option<&'a dyn IndirectLight>,
        around: Media,
        guides: bool,
    ) -> Tracer<'a> {
        let settings = &world.appearance.prepared.settings;
        let caustics = match settings.light.caustics {
            // Rays from the eye may not find again what was caught.
            _ if catches => Caustics::PhotonMapped,
            Caustics::PathTraced => Caustics::PathTraced,
            _ => Caustics::LeftOut,
        };
        let appearance = &world.appearance;
        let has_others =
            appearance.ambient.is_some() || appearance.sources.iter().any(|(_, source)| !source.is_caught());
        let direct = Direct::new(world, shadows, settings.light.samples.max(1));
        Tracer { world, direct, depth, caustics, caught, indirect, has_others, around, guides }
    }

    /// The radiance that arrives along a line of sight.
    pub(super) fn radiance(
        &self,
        sight: &Sight,
        comb: usize,
        draws: &Draws,
        work: &mut Work,
        mut log: Log<'_>,
    ) -> Seen {
        let mut seen = Seen::default();
        let first = Leg {
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
            course: Course::Seen,
            turn: Turn::Other,
            is_known: false,
            guides: self.guides,
        };
        let Work { counts, waiting } = work;
        waiting.push(first);
        while let Some(leg) = waiting.pop() {
            match leg.depth {
                0 => counts.primary += 1,
                _ => counts.reflected += 1,
            }
            let direction = leg.sight.ray.direction;
            match self.world.meet(&leg.sight, comb, draws.time) {
                Met::Nothing => {
                    let radiance = match leg.for_lights && !self.direct.has_sky() {
                        true => Channels::ZERO,
                        false => {
                            let ray = Ray { direction: direction.normalize(), ..leg.sight.ray };
                            let part = |sky: &Source, density| self.part(&leg, sky, density);
                            self.world.appearance.beyond(&ray, leg.normal, comb, part)
                        }
                    };
                    seen.add(leg.course.of_lamps(), leg.passed * radiance);
                    seen.guide_by_light(&leg);
                    seen.covered |= leg.depth > 0;
                    log.note(|| Note::term(leg.depth, "meets nothing", leg.passed * radiance));
                }
                Met::Glow(index, glow) => {
                    let absorbed = leg.media.absorbed(self.world, glow.t * direction.length() - leg.begin, comb);
                    let (number, source) = &self.world.appearance.sources[index];
                    let radiance = absorbed * glow.radiance * self.part(&leg, source, glow.density);
                    seen.add(leg.course.of_lamps(), leg.passed * radiance);
                    seen.guide_by_light(&leg);
                    seen.covered = true;
                    log.note(|| Note::light(leg.depth, *number, leg.passed * radiance));
                }
                Met::Element(found) => {
                    if leg.depth == 0 {
                        let Found { depth, object, material, .. } = found;
                        seen.first = Some(First { distance: depth, normal: found.element.normal, object, material });
                    }
                    seen.covered = true;
                    let counting = &mut Counting { counts, log: &mut log, seen: &mut seen };
                    self.arrive(leg, &found, (comb, draws), counting, waiting);
                }
            }
        }
        seen
    }

    /// What an element sends back along a leg, and the legs that go on from there.
    fn arrive(
        &self,
        mut leg: Leg,
        found: &Found<'_>,
        (comb, draws): (usize, &Draws),
        Counting { counts, log, seen }: &mut Counting<'_, '_>,
        waiting: &mut Vec<Leg>,
    ) {
        let optics = found.optics;
        let towards = leg.sight.ray.direction.normalize();
        leg.passed *= leg.media.absorbed(self.world, found.distance - leg.begin, comb);
        let crossing = leg.media.crossing(self.world, found, &leg.sight.ray);
        if !crossing.is_interface {
            let sight = Sight { t_min: crossing.last, ..leg.sight };
            waiting.push(Leg { sight, begin: found.distance, media: crossing.media, ..leg });
            return;
        }
        log.note(|| Note::element(leg.depth, self.world.appearance.prepared, found));
        if let Some((emission, factor)) =
            self.world.emitted(found, towards, comb, |source, density| self.part(&leg, source, density))
        {
            let radiance = leg.passed * emission * factor;
            seen.add(leg.course.of_lamps(), radiance);
            seen.guide_by_light(&leg);
            log.note(|| Note::term(leg.depth, "emits", radiance));
        }
        if leg.for_lights && !optics.is_passable() {
            return;
        }
        let frame = found.frame();
        // Where wavelengths part, the one that is left is drawn together with the comb, as often as it will be seen.
        let drawn = match leg.lane {
            None if found.disperses() => {
                let visibility = self.world.appearance.wavelengths.visibility(comb);
                leg.passed.drawn(visibility, draws.point(Purpose::Wavelengths)[1])
            }
            _ => None,
        };
        let (lane, alone) = drawn.unwrap_or((leg.lane.unwrap_or(0), leg.passed));
        let side = crossing.side(self.world, comb);
        let sighting = Sighting { view: frame.local(-towards), comb, side, lane, painted: found.painted() };
        if leg.for_lights {
            let onward = optics.straight(&sighting);
            waiting.extend(onward.and_then(|onward| self.straight(&leg, found, (onward, 0), draws)));
            return;
        }
        if leg.guides {
            let passed = self.world.appearance.wavelengths.broad(leg.passed).element_sum() / 3.0;
            seen.albedo += leg.passed * optics.spread_albedo(&sighting);
            seen.normal += found.element.normal * passed;
        }
        if let Some(ambient) = &self.world.appearance.ambient {
            let radiance = leg.passed * optics.ambient(&sighting) * ambient.of(comb);
            seen.add(Class::Indirect, radiance);
            log.note(|| Note::term(leg.depth, "ambient light", radiance));
        }
        if let Some(radiance) = self.indirect(found, comb).filter(|_| !leg.is_known) {
            seen.add(Class::Indirect, leg.passed * radiance);
            log.note(|| Note::term(leg.depth, "light of other surfaces", leg.passed * radiance));
        }
        let is_worth = |onward: Onward| (leg.passed * onward.weight).max() > WORTH_PARTING;
        let (count, all_worth) =
            optics.mirrored(&sighting).fold((0, true), |(count, all), onward| (count + 1, all && is_worth(onward)));
        let directions = count + usize::from(optics.spreads());
        let parts = directions <= 1 || waiting.len() + directions <= MOST_WAITING && all_worth;
        let among = if parts { Among::Spread } else { Among::All };
        let highest = self.highest(&leg);
        let encounter = Encounter {
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
        if optics.answers_lights() {
            let add = |number, radiance| log.note(|| Note::lit(leg.depth, number, leg.passed * radiance));
            let light = self.direct.light(&encounter, counts, add);
            for (is_broad, radiance) in [true, false].into_iter().zip(light) {
                seen.add(leg.course.after(is_broad).of_lamps(), leg.passed * radiance);
            }
        }
        if let Some(caught) = self.caught.filter(|_| optics.takes() && !leg.is_known) {
            let (light, error) =
                caught.seen(found, &encounter.sighting, (leg.passed, leg.lane.is_some()), leg.course != Course::Seen);
            let first = leg.course.after(true).after(false).of_lamps();
            if leg.course == Course::Seen {
                let seen_as = |(radiance, other): (Channels, DVec3)| {
                    self.world.appearance.wavelengths.seen(comb, radiance) + other
                };
                let luminance = light.map(seen_as).into_iter().sum::<DVec3>().dot(LUMINANCE);
                seen.shared += (luminance * error).powi(2);
            }
            for (class, (radiance, elsewhere)) in [first, Class::Indirect].into_iter().zip(light) {
                seen.add(class, radiance);
                seen.other[class as usize] += elsewhere;
                log.note(|| Note::term(leg.depth, "caught light", radiance));
            }
        }
        if optics.carries_on() {
            let point = draws.leg(leg.number, Purpose::Direction, 0);
            let [choice, _] = draws.leg(leg.number, Purpose::Choice, 0);
            if parts {
                let drawn = optics.spreads().then(|| optics.onward(&sighting, choice, point, among)).flatten();
                let legs = optics.mirrored(&sighting).zip(0..).chain(drawn.map(|onward| (onward, 2)));
                waiting.extend(legs.filter_map(|(onward, branch)| self.onward(&leg, &encounter, onward, branch)));
            } else {
                let drawn = optics.onward(&sighting, choice, point, among);
                waiting.extend(drawn.and_then(|onward| self.onward(&leg, &encounter, onward, 0)));
            }
        }
    }

    /// Radiance of an element by light of other diffuse ones, as far as it is known already.
    fn indirect(&self, found: &Found<'_>, comb: usize) -> Option<Channels> {
        let indirect = self.indirect.filter(|_| found.optics.is_diffuse())?;
        let corners = self.world.appearance.prepared.corners(found.triangle);
        let weights = crate::numeric::triangle::weights(corners, found.element.position);
        let irradiance = indirect.irradiance(found.triangle, found.element.outside, weights, Part::Indirect);
        Some(diffuse(found.optics, comb, found.painted()) * irradiance * std::f64::consts::FRAC_1_PI)
    }

    /// How much a light counts that a leg meets.
    ///
    /// - `density`: with which the light would have drawn the leg's direction.
    fn part(&self, leg: &Leg, source: &Source, density: f64) -> f64 {
        let is_caustic = leg.density.is_none() && leg.course != Course::Seen;
        match self.caustics {
            // What is not followed from lamps counts wherever it is met.
            Caustics::PhotonMapped if !source.is_caught() => counted(leg.density, density),
            Caustics::PhotonMapped if leg.is_known => 0.0,
            // A shadow ray has gone through what is polished.
            Caustics::LeftOut if leg.turn == Turn::Through && self.world.appearance.clears => 0.0,
            Caustics::LeftOut if source.is_sky() => counted(leg.density, density),
            Caustics::PhotonMapped | Caustics::LeftOut if is_caustic => 0.0,
            _ => leg.lamps * counted(leg.density, density),
        }
    }

    /// The greatest value with which narrow lobes may reflect a lamp where a leg arrives, 1/sr.
    fn highest(&self, leg: &Leg) -> f64 {
        match self.caustics {
            Caustics::PhotonMapped if leg.course != Course::Seen => 0.0,
            Caustics::LeftOut if leg.course != Course::Seen => HIGHEST,
            _ => f64::INFINITY,
        }
    }

    /// The leg that goes on in a direction; none if it is not worth following.
    fn onward(&self, leg: &Leg, encounter: &Encounter<'_>, onward: Onward, branch: u32) -> Option<Leg> {
        let Encounter { found, frame, sighting, draws, highest, alone, .. } = *encounter;
        if onward.is_straight {
            return self.straight(leg, found, (onward, branch), &draws);
        }
        let through = onward.light.z < 0.0;
        let parts_wavelengths = through && leg.lane.is_none() && found.disperses();
        // Beyond the last leg, a direction that might have been drawn for a light still looks for it.
        let is_last = leg.depth >= self.depth;
        if is_last && (onward.density.is_none() || !self.direct.is_spread()) {
            return None;
        }
        let goes_back = self.caustics == Caustics::PhotonMapped && !onward.is_broad && leg.course != Course::Seen;
        let is_known = leg.is_known || goes_back;
        if is_known && !self.has_others {
            return None;
        }
        let passed = if parts_wavelengths { alone } else { leg.passed } * onward.weight;
        let number = leg.number.wrapping_mul(3).wrapping_add(branch);
        let passed = survived(passed, number, &draws)?;
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
            (Some(_), _) => Turn::Spread,
            (None, Turn::Spread | Turn::Through) if through => Turn::Through,
            _ => Turn::Other,
        };
        Some(Leg {
            sight: Sight {
                ray: Ray { origin, direction },
                t_min: 0.0,
                t_max: f64::INFINITY,
                // A curved mirror widens it more; its many samples make up for that.
                cone: Cone { width: leg.sight.cone.at(found.distance), ..leg.sight.cone },
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
            course: leg.course.after(onward.is_broad),
            turn,
            is_known,
            guides: leg.guides && onward.density.is_none(),
        })
    }

    /// The rest of a leg behind what it goes straight through: the same ray, so that lights are met as if nothing was there.
    fn straight(&self, leg: &Leg, found: &Found<'_>, (onward, branch): (Onward, u32), draws: &Draws) -> Option<Leg> {
        let is_last = leg.depth >= self.depth;
        if is_last && (leg.density.is_none() || !self.direct.is_spread()) {
            return None;
        }
        let number = leg.number.wrapping_mul(3).wrapping_add(branch);
        let passed = survived(leg.passed * onward.weight, number, draws)?;
        let sight = Sight { t_min: found.t, ..leg.sight };
        let for_lights = leg.for_lights || is_last;
        Some(Leg { sight, passed, begin: found.distance, depth: leg.depth + 1, number, for_lights, ..*leg })
    }
}

/// What of a leg is followed: all of it, or, of one that passes little on, by chance more or nothing.
fn survived(passed: Channels, number: u32, draws: &Draws) -> Option<Channels> {
    let most = passed.max();
    if most >= ENERGY_CUTOFF {
        return Some(passed);
    }
    let survival = most / ENERGY_CUTOFF;
    (most > 0.0 && draws.leg(number, Purpose::Survival, 0)[0] < survival).then(|| passed * survival.recip())
}
