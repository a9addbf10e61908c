//! Light on its way from a lamp: through mirrors and glass to where it is caught.

use super::aim::BoundingSphere;
use super::surfaces::SmoothSurfaces;
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::{LobeSelection, BsdfSample, ShadingContext};
use crate::numeric::ray::Ray;
use crate::numeric::sequence::SobolSequence;
use crate::render::world::{RayCone, MediumInterface, SurfaceInteraction, Media, RayHit, BoundedRay, World};
use glam::DVec3;
use serde::Serialize;
use std::f64::consts::PI;

/// Turns after which light is followed at least; the scene may ask for more.
pub(super) const LEAST_BOUNCES: u32 = 128;
/// So many turns are followed whatever is left.
const CERTAIN_BOUNCES: u32 = 8;
/// Of what has less left than this part, only some is followed, and then counts for more.
const FAINT: f64 = 1.0 / 64.0;
/// Of what was spread and has less left than this part of what is caught in the mean, only some is followed.
const FAINT_BROAD: f64 = 0.25;
/// Parts in which light is spread, and one more.
const MOST_PARTS: u32 = 17;
/// How wide light is on its way, as a part of the diagonal of the scene: hardly more than a point, but a relief is tilted by
/// heights side by side.
const WIDTH: f64 = 1e-6;

/// Light that was caught on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Photon {
    pub(super) position: DVec3,
    /// Towards where it came from, unit length.
    pub(super) towards: DVec3,
    /// Flux, W.
    pub(super) flux: Channels,
    /// The side of a surface on which it arrived, as [`side_of`] numbers them.
    pub(super) side: u32,
    /// Which wavelengths it carries.
    pub(super) comb: u8,
    /// Whether a broad turn was among those that it took.
    pub(super) is_again: bool,
}

/// One side of a smooth surface.
pub(super) fn side_of(surface: u32, outside: bool) -> u32 {
    surface << 1 | u32::from(outside)
}

/// What became of the flux that was sent out, W: the mean over the wavelengths or bands.
///
/// `sent`, `again` and `gained` together are all the others together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FluxBalance {
    /// Ways that were followed.
    pub ways: u64,
    /// How many of them were taken from a database.
    pub before: u64,
    /// Sent out towards what mirrors or refracts.
    pub sent: f64,
    /// Sent again by what spreads light.
    pub again: f64,
    /// Gained, or lost where negative, by chance: where one of several ways was followed instead of all.
    pub gained: f64,
    /// Came to what spreads it without a mirror or glass on the way: light that goes straight.
    pub straight: f64,
    /// Caught on surfaces, behind mirrors and glass.
    pub caught: f64,
    /// Absorbed by mirrors, in glass, and by lamps.
    pub absorbed: f64,
    /// Left the scene.
    pub escaped: f64,
    /// Was not followed further after very many turns.
    pub stopped: f64,
}

impl FluxBalance {
    /// What is missing on one side, as a part of all.
    pub fn residual(&self) -> f64 {
        let arrived = self.straight + self.caught + self.absorbed + self.escaped + self.stopped;
        (self.sent + self.again + self.gained - arrived).abs() / self.sent.max(f64::MIN_POSITIVE)
    }

    /// The balance of ways with another flux.
    pub(super) fn scaled(&self, factor: f64) -> FluxBalance {
        FluxBalance {
            ways: self.ways,
            before: self.before,
            sent: self.sent * factor,
            again: self.again * factor,
            gained: self.gained * factor,
            straight: self.straight * factor,
            caught: self.caught * factor,
            absorbed: self.absorbed * factor,
            escaped: self.escaped * factor,
            stopped: self.stopped * factor,
        }
    }
}

impl std::fmt::Display for FluxBalance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let part = |watts: f64| 100.0 * watts / self.sent.max(f64::MIN_POSITIVE);
        write!(f, "{} ways of light followed", self.ways)?;
        if self.before > 0 {
            write!(f, ", {} of them before", self.before)?;
        }
        write!(
            f,
            ": {:.5} W sent, {:.2} % again by what spreads it ({:+.2} % by chance); caught \
             {:.2} %, absorbed {:.2} %, escaped {:.2} %, straight {:.2} %, stopped {:.2} %; {:.1e} of it is missing",
            self.sent,
            part(self.again),
            part(self.gained),
            part(self.caught),
            part(self.absorbed),
            part(self.escaped),
            part(self.straight),
            part(self.stopped),
            self.residual()
        )
    }
}

impl std::ops::Add for FluxBalance {
    type Output = FluxBalance;

    fn add(self, other: FluxBalance) -> FluxBalance {
        FluxBalance {
            ways: self.ways + other.ways,
            before: self.before + other.before,
            sent: self.sent + other.sent,
            again: self.again + other.again,
            gained: self.gained + other.gained,
            straight: self.straight + other.straight,
            caught: self.caught + other.caught,
            absorbed: self.absorbed + other.absorbed,
            escaped: self.escaped + other.escaped,
            stopped: self.stopped + other.stopped,
        }
    }
}

/// Choices on one way: each has its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhotonSampler {
    sequence: SobolSequence,
    index: u32,
}

/// What a choice is for.
#[derive(Clone, Copy, Debug)]
#[repr(u64)]
pub(super) enum PhotonDimension {
    /// Where light leaves the lamp.
    Start,
    /// Where it goes.
    Aim,
    /// Which wavelengths it carries, and when.
    Wavelengths,
    /// Which lobe passes it on, and which lane is left where wavelengths part.
    Choice,
    /// In which direction, by a narrow lobe or a broad one.
    Direction,
    Spread,
    /// Towards which ball a broad lobe sends it, if towards any.
    Aimed,
    /// Whether it is followed further.
    Survival,
}

impl PhotonSampler {
    pub(super) fn new(sequence: SobolSequence, index: u32) -> PhotonSampler {
        PhotonSampler { sequence, index }
    }

    pub(super) fn point(&self, purpose: PhotonDimension, turn: u32) -> [f64; 2] {
        self.sequence.point(self.index, u64::from(turn) << 8 | purpose as u64)
    }
}

/// Light that goes out.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmittedPhoton {
    pub(super) ray: Ray,
    pub(super) flux: Channels,
    pub(super) comb: usize,
    pub(super) time: f64,
}

/// Follows light and keeps account of it.
pub(super) struct PhotonTracer<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) surfaces: &'a SmoothSurfaces,
    /// Around what mirrors or refracts.
    pub(super) balls: &'a [BoundingSphere],
    /// Most turns.
    pub(super) turns: u32,
    /// The flux of light as it is caught, in the mean, W: more than this is sent on in parts, and of less only some. None if
    /// it is not known yet.
    pub(super) typical: Option<f64>,
    /// Legs to be followed; none between ways.
    pub(super) waiting: Vec<PhotonSegment>,
    pub(super) caught: Vec<Photon>,
    pub(super) balance: FluxBalance,
}

/// What is known of light on its way.
pub(super) struct PhotonSegment {
    ray: Ray,
    t_min: f64,
    flux: Channels,
    media: Media,
    lane: Option<usize>,
    /// Tells its choices from those of others of the same way.
    number: u32,
    /// How many were before it, and how often a surface has sent it on other than straight.
    legs: u32,
    turns: u32,
    /// Whether the last of them was narrow, and whether any was broad.
    is_beam: bool,
    is_again: bool,
}

impl PhotonTracer<'_> {
    fn watts(&self, flux: Channels) -> f64 {
        let lanes = self.world.appearance.wavelengths.lanes();
        flux.0[..lanes].iter().sum::<f64>() / lanes as f64
    }

    /// Follows light to its end.
    pub(super) fn trace(&mut self, start: &EmittedPhoton, choices: &PhotonSampler) {
        let EmittedPhoton { ray, flux, comb, time } = *start;
        self.balance.ways += 1;
        self.balance.sent += self.watts(flux);
        let first = flux.max();
        let cone = RayCone { width: WIDTH * self.world.appearance.prepared.bounds.diagonal(), growth: 0.0 };
        let media = Media::default();
        let leg = PhotonSegment {
            ray,
            t_min: 0.0,
            flux,
            media,
            lane: None,
            number: 1,
            legs: 0,
            turns: 0,
            is_beam: false,
            is_again: false,
        };
        self.waiting.push(leg);
        while let Some(mut leg) = self.waiting.pop() {
            self.russian_roulette(&mut leg, first, choices);
            // Straight through panes it goes on as it was; a limit keeps even endless stacks of them from hanging.
            if leg.turns > self.turns || leg.legs > self.turns.saturating_mul(2) {
                self.balance.stopped += self.watts(leg.flux);
                continue;
            }
            if leg.flux.max() <= 0.0 {
                continue;
            }
            let sight = BoundedRay { ray: leg.ray, t_min: leg.t_min, t_max: f64::INFINITY, cone };
            match self.world.intersect(&sight, comb, time) {
                RayHit::Nothing => self.balance.escaped += self.watts(leg.flux),
                RayHit::Light(..) => self.balance.absorbed += self.watts(leg.flux),
                RayHit::Surface(found) => {
                    let length = found.distance - leg.t_min * leg.ray.direction.length();
                    leg.media.notice(&found);
                    let left = leg.flux * leg.media.transmittance(self.world, length, comb);
                    self.balance.absorbed += self.watts(leg.flux) - self.watts(left);
                    leg.flux = left;
                    let crossing = leg.media.crossing(self.world, &found, &leg.ray);
                    if crossing.is_interface {
                        self.scatter(&leg, &found, (comb, crossing), choices);
                    } else {
                        self.waiting.push(PhotonSegment { t_min: crossing.last, media: crossing.media, ..leg });
                    }
                }
            }
        }
    }

    /// Ends a leg by chance where it is faint, or gives it what others have lost.
    fn russian_roulette(&mut self, leg: &mut PhotonSegment, first: f64, choices: &PhotonSampler) {
        let faint = match leg.is_again {
            true => (first * FAINT).max(FAINT_BROAD * self.typical.unwrap_or(0.0)),
            false if leg.turns > CERTAIN_BOUNCES => first * FAINT,
            false => return,
        };
        let part = leg.flux.max() / faint;
        if part < 1.0 {
            let before = self.watts(leg.flux);
            let survives = choices.point(PhotonDimension::Survival, leg.number)[0] < part;
            leg.flux = if survives { leg.flux * part.recip() } else { Channels::ZERO };
            self.balance.gained += self.watts(leg.flux) - before;
        }
    }

    /// Catches light on an element, and sends it on.
    fn scatter(&mut self, leg: &PhotonSegment, found: &SurfaceInteraction<'_>, (comb, crossing): (usize, MediumInterface), choices: &PhotonSampler) {
        let optics = found.optics;
        let incoming = self.watts(leg.flux);
        let towards = -leg.ray.direction.normalize();
        if leg.is_beam && optics.stores_photons() {
            self.caught.push(Photon {
                position: self.world.hit_position(found, &leg.ray),
                towards,
                flux: leg.flux,
                side: side_of(self.surfaces.of(found.triangle), found.element.outside),
                comb: comb as u8,
                is_again: leg.is_again,
            });
        }
        let arrival = PhotonInteraction { leg, found, crossing, frame: found.frame(), comb, towards, choices };
        let beam = (optics.casts_caustics() || optics.is_passable()).then(|| self.scatter_narrow(&arrival)).flatten();
        // What does not go on is absorbed, or caught. What is spread was caught, too, and is sent again.
        let (expected, beam) = beam.unwrap_or((0.0, None));
        match (leg.is_beam, optics.stores_photons()) {
            (false, true) => self.balance.straight += incoming - expected,
            (true, true) => self.balance.caught += incoming - expected,
            _ => self.balance.absorbed += incoming - expected,
        }
        self.balance.gained += beam.as_ref().map_or(0.0, |leg| self.watts(leg.flux)) - expected;
        self.waiting.extend(beam);
        if optics.is_broad() {
            self.scatter_broad(&arrival);
        }
    }

    /// Where narrow lobes send light: the flux that is expected to go on, and one of the ways.
    fn scatter_narrow(&self, arrival: &PhotonInteraction<'_>) -> Option<(f64, Option<PhotonSegment>)> {
        let PhotonInteraction { leg, found, comb, choices, .. } = arrival;
        let optics = found.optics;
        let [choice, parting] = choices.point(PhotonDimension::Choice, leg.number);
        // Where wavelengths part, the one that is left is drawn as it is seen.
        let alone = match leg.lane {
            None if found.disperses() => leg.flux.sample_lane(self.world.appearance.wavelengths.visibility(*comb), parting),
            _ => None,
        };
        let lane = leg.lane.or(alone.map(|(lane, _)| lane)).unwrap_or(0);
        let sighting = self.context(arrival, lane);
        let direction = choices.point(PhotonDimension::Direction, leg.number);
        let drawn = optics.sample(&sighting, choice, direction, LobeSelection::Narrow);
        let Some(mut drawn) = drawn.filter(|drawn| drawn.density.is_none() || arrival.is_sound(drawn)) else {
            return Some((0.0, None));
        };
        arrival.make_adjoint(&sighting, LobeSelection::Narrow, &mut drawn);
        let flux = leg.flux * flux_factor(&sighting, &drawn);
        let expected = match drawn.density {
            // Its own weight is all that is known of a spread one.
            Some(_) => self.watts(flux),
            None => optics.specular_samples(&sighting).map(|onward| self.watts(leg.flux * flux_factor(&sighting, &onward))).sum(),
        };
        let (flux, lane) = match alone.filter(|_| drawn.light.z < 0.0 && !drawn.is_straight) {
            Some((lane, alone)) => (alone * flux_factor(&sighting, &drawn), Some(lane)),
            None => (flux, leg.lane),
        };
        Some((expected, Some(arrival.next_segment(&drawn, (flux, lane), leg.number.wrapping_mul(MOST_PARTS)))))
    }

    /// Sends on what broad lobes spread: half of it to what mirrors or refracts, as far as it is known where that is.
    fn scatter_broad(&mut self, arrival: &PhotonInteraction<'_>) {
        let PhotonInteraction { leg, found, frame, choices, .. } = arrival;
        let optics = found.optics;
        let sighting = self.context(arrival, leg.lane.unwrap_or(0));
        let from = found.element.position;
        let plane = found.element.plane(true);
        let balls = self.balls;
        let angles = || balls.iter().map(|ball| ball.solid_angle(from, plane));
        // Through what spreads it behind itself, only the lobes know the way.
        let all: f64 = if optics.interior.is_none() { angles().sum() } else { 0.0 };
        // Much light is sent in many parts, each of them about as much as others that are caught.
        let worth = 0.5 * self.watts(leg.flux) * (all / PI).min(1.0);
        let parts = match self.typical {
            Some(typical) if !leg.is_again => (worth / typical).clamp(1.0, f64::from(MOST_PARTS - 1)) as u32,
            _ => 1,
        };
        for part in 1..=parts {
            let number = leg.number.wrapping_mul(MOST_PARTS).wrapping_add(part);
            let [half, which] = choices.point(PhotonDimension::Aimed, number);
            let point = choices.point(PhotonDimension::Spread, number);
            let drawn = if all > 0.0 && half < 0.5 {
                let mut left = which * all;
                let is_chosen = |(_, angle): &(&BoundingSphere, f64)| {
                    left -= angle;
                    left < 0.0
                };
                let ball = balls.iter().zip(angles()).find(is_chosen);
                ball.map(|(ball, _)| BsdfSample {
                    light: frame.local(ball.direction(from, point)),
                    weight: Channels::ZERO,
                    density: Some(0.0),
                    is_straight: false,
                    is_broad: true,
                })
            } else {
                let [choice, _] = choices.point(PhotonDimension::Choice, number);
                optics.sample(&sighting, choice, point, LobeSelection::Broad)
            };
            let Some(mut drawn) = drawn.filter(|drawn| arrival.is_sound(drawn)) else { continue };
            if all > 0.0 {
                let direction = frame.world(drawn.light);
                let aimed = balls.iter().zip(angles()).filter(|(b, angle)| *angle > 0.0 && b.is_hit(from, direction));
                let lobes = optics.pdf_among(LobeSelection::Broad, &sighting, drawn.light);
                drawn.density = Some(0.5 * (aimed.count() as f64 / all + lobes));
            }
            arrival.make_adjoint(&sighting, LobeSelection::Broad, &mut drawn);
            let flux = leg.flux * flux_factor(&sighting, &drawn) * f64::from(parts).recip();
            if flux.max() > 0.0 && flux.is_finite() {
                self.balance.again += self.watts(flux);
                let leg = PhotonSegment { is_beam: false, is_again: true, ..arrival.next_segment(&drawn, (flux, leg.lane), number) };
                self.waiting.push(leg);
            }
        }
    }

    fn context<'b>(&self, arrival: &PhotonInteraction<'b>, lane: usize) -> ShadingContext<'b> {
        let PhotonInteraction { found, crossing, frame, comb, towards, .. } = arrival;
        let side = crossing.indices(self.world, *comb);
        ShadingContext { view: frame.local(*towards), comb: *comb, side, lane, painted: found.texture_values() }
    }
}

/// Light that came to an element.
struct PhotonInteraction<'a> {
    leg: &'a PhotonSegment,
    found: &'a SurfaceInteraction<'a>,
    crossing: MediumInterface,
    frame: ShadingFrame,
    comb: usize,
    /// Towards where it came from, unit length.
    towards: DVec3,
    choices: &'a PhotonSampler,
}

impl PhotonInteraction<'_> {
    /// Whether a direction of a spread lobe is on the same side of the triangle and of its surface: what is not is lost.
    fn is_sound(&self, drawn: &BsdfSample) -> bool {
        let above = drawn.light.z > 0.0;
        let plane = self.found.element.plane(above);
        (self.frame.world(drawn.light).dot(plane) > 0.0) == above && drawn.weight.is_finite()
    }

    /// Gives a direction of a spread lobe the weight with which light goes from here to there, where that is not the same as
    /// from there to here.
    fn make_adjoint(&self, sighting: &ShadingContext<'_>, among: LobeSelection, drawn: &mut BsdfSample) {
        if let Some(density) = drawn.density.filter(|_| drawn.light.z > 0.0) {
            let back = ShadingContext { view: drawn.light, ..*sighting };
            drawn.weight = self.found.optics.value_among(among, &back, sighting.view) * (drawn.light.z / density);
        }
    }

    /// The leg that goes on by a narrow turn.
    fn next_segment(&self, drawn: &BsdfSample, (flux, lane): (Channels, Option<usize>), number: u32) -> PhotonSegment {
        let PhotonInteraction { leg, found, frame, .. } = self;
        let legs = leg.legs + 1;
        if drawn.is_straight {
            return PhotonSegment { t_min: found.t, flux, number, legs, ..**leg };
        }
        let through = drawn.light.z < 0.0;
        let media = if through { self.crossing.media } else { leg.media };
        let element = &found.element;
        let direction = element.righted(frame.world(drawn.light), !through);
        let origin = if through { element.through } else { element.leave };
        let (ray, turns) = (Ray { origin, direction }, leg.turns + 1);
        PhotonSegment { ray, t_min: 0.0, flux, media, lane, number, legs, turns, is_beam: true, is_again: leg.is_again }
    }
}

/// The part of flux that goes on: radiance grows as it enters what is denser; flux does not.
fn flux_factor(sighting: &ShadingContext<'_>, onward: &BsdfSample) -> Channels {
    if onward.light.z >= 0.0 || onward.is_straight {
        return onward.weight;
    }
    let [before, behind] = [sighting.side.before.0, sighting.side.behind.0];
    onward.weight * Channels(std::array::from_fn(|lane| (behind[lane] / before[lane]).powi(2)))
}
