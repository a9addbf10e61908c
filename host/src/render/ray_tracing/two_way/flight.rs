//! Light on its way from a lamp: through mirrors and glass to where it is caught.

use super::super::media::Media;
use super::super::world::{Found, Met, World};
use super::surfaces::Surfaces;
use crate::color::Channels;
use crate::illumination::optics::{Among, Onward, Optics, Sighting, Which};
use crate::numeric::ray::Ray;
use crate::numeric::sequence::Sequence;
use crate::render::eye::{Cone, Sight};
use glam::DVec3;
use serde::Serialize;

/// Turns after which light is followed at least; the scene may ask for more.
pub(super) const LEAST_TURNS: u32 = 128;
/// So many turns are followed whatever is left.
const CERTAIN_TURNS: u32 = 8;
/// Of what has less left than this part, only some is followed, and then counts for more.
const FAINT: f64 = 1.0 / 64.0;

/// Light that was caught on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Caught {
    pub(super) position: DVec3,
    /// Towards where it came from, unit length.
    pub(super) towards: DVec3,
    /// Flux, W.
    pub(super) flux: Channels,
    /// The side of a surface on which it arrived, as [`side_of`] numbers them.
    pub(super) side: u32,
    /// Which wavelengths it carries.
    pub(super) comb: u8,
}

/// One side of a smooth surface.
pub(super) fn side_of(surface: u32, outside: bool) -> u32 {
    surface << 1 | u32::from(outside)
}

/// What became of the flux that was sent out, W: the mean over the wavelengths or bands.
///
/// `sent` and `gained` together are all the others together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Balance {
    /// Ways that were followed.
    pub ways: u64,
    /// Sent out towards what mirrors or refracts.
    pub sent: f64,
    /// Gained, or lost where negative, by chance: where one of several ways was followed instead of all.
    pub gained: f64,
    /// Met first what neither mirrors nor refracts: light that goes straight.
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

impl Balance {
    /// What is missing on one side, as a part of all.
    pub fn residual(&self) -> f64 {
        let arrived = self.straight + self.caught + self.absorbed + self.escaped + self.stopped;
        (self.sent + self.gained - arrived).abs() / self.sent.max(f64::MIN_POSITIVE)
    }
}

impl std::fmt::Display for Balance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let part = |watts: f64| 100.0 * watts / self.sent.max(f64::MIN_POSITIVE);
        write!(
            f,
            "{} ways of light followed: {:.5} W sent to what mirrors or refracts ({:+.2} % by chance); caught {:.2} %, \
             absorbed {:.2} %, escaped {:.2} %, straight {:.2} %, stopped {:.2} %; {:.1e} of it is missing",
            self.ways,
            self.sent,
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

impl std::ops::Add for Balance {
    type Output = Balance;

    fn add(self, other: Balance) -> Balance {
        Balance {
            ways: self.ways + other.ways,
            sent: self.sent + other.sent,
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
pub(super) struct Choices {
    sequence: Sequence,
    index: u32,
}

/// What a choice is for.
#[derive(Clone, Copy, Debug)]
#[repr(u64)]
pub(super) enum Purpose {
    /// Where light leaves the lamp.
    Start,
    /// Where it goes.
    Aim,
    /// Which wavelengths it carries, and when.
    Wavelengths,
    /// Which lobe passes it on, and which lane is left where wavelengths part.
    Choice,
    /// In which direction.
    Direction,
    /// Whether it is followed further.
    Survival,
}

impl Choices {
    pub(super) fn new(sequence: Sequence, index: u32) -> Choices {
        Choices { sequence, index }
    }

    pub(super) fn point(&self, purpose: Purpose, turn: u32) -> [f64; 2] {
        self.sequence.point(self.index, u64::from(turn) << 8 | purpose as u64)
    }
}

/// Light that goes out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray0 {
    pub(super) ray: Ray,
    pub(super) flux: Channels,
    pub(super) comb: usize,
    pub(super) time: f64,
}

/// Follows light and keeps account of it.
pub(super) struct Flight<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) surfaces: &'a Surfaces,
    /// Most turns.
    pub(super) turns: u32,
    pub(super) caught: Vec<Caught>,
    pub(super) balance: Balance,
}

/// What is known of light on its way.
struct Leg {
    ray: Ray,
    t_min: f64,
    flux: Channels,
    media: Media,
    lane: Option<usize>,
    /// How often a mirror or an interface has sent it on.
    turns: u32,
}

impl Flight<'_> {
    fn watts(&self, flux: Channels) -> f64 {
        let lanes = self.world.appearance.wavelengths.lanes();
        flux.0[..lanes].iter().sum::<f64>() / lanes as f64
    }

    /// Follows light to its end.
    pub(super) fn follow(&mut self, start: &Ray0, choices: &Choices) {
        let Ray0 { ray, flux, comb, time } = *start;
        self.balance.ways += 1;
        self.balance.sent += self.watts(flux);
        let first = flux.max();
        let mut leg = Leg { ray, t_min: 0.0, flux, media: Media::default(), lane: None, turns: 0 };
        // Straight through panes it goes on as it was; a limit keeps even endless stacks of them from hanging.
        for number in 0..self.turns.saturating_mul(2) {
            let sight = Sight { ray: leg.ray, t_min: leg.t_min, t_max: f64::INFINITY, cone: Cone::default() };
            let found = match self.world.meet(&sight, comb, time) {
                Met::Nothing => {
                    self.balance.escaped += self.watts(leg.flux);
                    return;
                }
                Met::Glow(..) => {
                    self.balance.absorbed += self.watts(leg.flux);
                    return;
                }
                Met::Element(found) => found,
            };
            let length = found.distance - leg.t_min * leg.ray.direction.length();
            leg.media.notice(&found);
            let left = leg.flux * leg.media.absorbed(self.world, length, comb);
            self.balance.absorbed += self.watts(leg.flux) - self.watts(left);
            leg.flux = left;
            if leg.turns > self.turns {
                break;
            }
            if !self.arrive(&mut leg, &found, comb, &(choices, number)) {
                return;
            }
            let part = leg.flux.max() / (first * FAINT);
            if leg.turns > CERTAIN_TURNS && part < 1.0 {
                let before = self.watts(leg.flux);
                let survives = choices.point(Purpose::Survival, number)[0] < part;
                leg.flux = if survives { leg.flux * part.recip() } else { Channels::ZERO };
                self.balance.gained += self.watts(leg.flux) - before;
            }
            if leg.flux.max() <= 0.0 {
                return;
            }
        }
        self.balance.stopped += self.watts(leg.flux);
    }

    /// Catches light on an element, or sends it on; whether it goes on.
    fn arrive(&mut self, leg: &mut Leg, found: &Found<'_>, comb: usize, (choices, number): &(&Choices, u32)) -> bool {
        let optics = found.optics;
        let incoming = self.watts(leg.flux);
        let throws = optics.throws() || optics.is_passable();
        if leg.turns == 0 && !throws {
            self.balance.straight += incoming;
            return false;
        }
        let towards = -leg.ray.direction.normalize();
        if leg.turns > 0 && optics.takes() {
            self.caught.push(Caught {
                position: found.element.position,
                towards,
                flux: leg.flux,
                side: side_of(self.surfaces.of(found.triangle), found.element.outside),
                comb: comb as u8,
            });
        }
        let onward = if throws { self.onward(leg, found, comb, (towards, choices, *number)) } else { None };
        // What does not go on is absorbed, or caught; one of several ways that was chosen stands for all of them.
        let (expected, onward) = onward.unwrap_or((0.0, None));
        let kept = incoming - expected;
        match (leg.turns, optics.takes()) {
            (0, true) => self.balance.straight += kept,
            (_, true) => self.balance.caught += kept,
            _ => self.balance.absorbed += kept,
        }
        self.balance.gained += onward.map_or(0.0, |(flux, _)| self.watts(flux)) - expected;
        let Some((flux, onward)) = onward else { return false };
        leg.flux = flux;
        if onward.is_straight {
            leg.t_min = found.t;
            return true;
        }
        let element = &found.element;
        let through = onward.light.z < 0.0;
        let frame = found.frame();
        let direction = element.righted(frame.world(onward.light), !through);
        if through {
            leg.media.cross(found);
        }
        leg.turns += 1;
        leg.t_min = 0.0;
        leg.ray = Ray { origin: if through { element.through } else { element.leave }, direction };
        true
    }

    /// Where light goes on from an element: the flux that is expected to, and one of the ways with its flux.
    fn onward(
        &self,
        leg: &mut Leg,
        found: &Found<'_>,
        comb: usize,
        (towards, choices, number): (DVec3, &Choices, u32),
    ) -> Option<(f64, Option<(Channels, Onward)>)> {
        let optics: &Optics = found.optics;
        let [choice, parting] = choices.point(Purpose::Choice, number);
        // Where wavelengths part, the one that is left is drawn as it is seen.
        let alone = match leg.lane {
            None if found.disperses() => leg.flux.drawn(self.world.appearance.wavelengths.visibility(comb), parting),
            _ => None,
        };
        let lane = leg.lane.or(alone.map(|(lane, _)| lane)).unwrap_or(0);
        let side = leg.media.side(self.world, found, comb);
        let frame = found.frame();
        let sighting = Sighting { view: frame.local(towards), comb, side, lane, painted: found.painted() };
        // Radiance grows as it enters what is denser; flux does not.
        let flux_of = |onward: &Onward| match onward.light.z < 0.0 && !onward.is_straight {
            true => {
                let [before, behind] = [side.before.0, side.behind.0];
                onward.weight * Channels(std::array::from_fn(|lane| (behind[lane] / before[lane]).powi(2)))
            }
            false => onward.weight,
        };
        let drawn = optics.onward(&sighting, choice, choices.point(Purpose::Direction, number), Among::Narrow);
        let Some(mut drawn) = drawn else { return Some((0.0, None)) };
        if let Some(density) = drawn.density {
            let above = drawn.light.z > 0.0;
            if above {
                // What goes from here to there, where that is not the same as from there to here.
                let back = Sighting { view: drawn.light, ..sighting };
                drawn.weight = optics.value(Which::Narrow, &back, sighting.view) * (drawn.light.z / density);
            }
            // Of a spread lobe, what falls on the wrong side of the triangle or its surface is lost.
            let plane = found.element.plane(above);
            if (frame.world(drawn.light).dot(plane) > 0.0) != above || !drawn.weight.is_finite() {
                return Some((0.0, None));
            }
        }
        let mut flux = leg.flux * flux_of(&drawn);
        let expected = match drawn.density {
            // Its own weight is all that is known of a spread one.
            Some(_) => self.watts(flux),
            None => optics.mirrored(&sighting).map(|onward| self.watts(leg.flux * flux_of(&onward))).sum(),
        };
        if let Some((lane, alone)) = alone.filter(|_| drawn.light.z < 0.0 && !drawn.is_straight) {
            flux = alone * flux_of(&drawn);
            leg.lane = Some(lane);
        }
        Some((expected, Some((flux, drawn))))
    }
}
