//! Phase one of two-way ray tracing: light is followed from lamps through mirrors and glass, and caught where it arrives.
//!
//! It does not depend on the view. Phase two, the rays from the eye, adds what was caught around each place that they meet,
//! as light that comes from where it came from.
//!
//! **Which ways of light are found by whom.** Each turn of light at a surface is by a *narrow* lobe, a mirror, an
//! interface or a highlight, or by a *broad* one, such as Lambert's. How light came to its last broad turn decides:
//!
//! - without any turn since the lamp it is direct: rays to lights bring it;
//! - by a narrow turn it is caught there, whatever was before: light that is followed from lamps takes broad turns, too;
//! - by another broad turn it is found by the rays from the eye, which go on to where that was and ask there again;
//! - light that comes to the eye by narrow turns alone is found by the rays from the eye.
//!
//! A ray from the eye that goes on from a broad turn by a narrow one is on a way of the second kind, and ends there. A sky
//! without a picture is left to the rays from the eye: it is as bright everywhere, and they find it. For it, and for ambient
//! light, these rays do not end.

mod aim;
mod flight;
mod gather;
mod surfaces;
mod walls;

pub use flight::Balance;

use super::world::{Found, World};
use crate::color::{Channels, LANES};
use crate::illumination::light::Start;
use crate::illumination::optics::Sighting;
use crate::numeric::ray::Ray;
use crate::numeric::sequence::Sequence;
use crate::octree::Sorted;
use crate::render::Watch;
use crate::render::radiosity::diffuse;
use crate::scene::Prepared;
use aim::{Aimed, Ball, Guide};
use flight::{Caught, Choices, Flight, LEAST_TURNS, Purpose, Ray0};
use gather::{Captured, Detail, Place, Surroundings};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};
use surfaces::Surfaces;

/// Ways that are followed first, to see where light goes: an eighth of those of a pass, within limits.
const PILOT: std::ops::RangeInclusive<u32> = 1 << 12..=1 << 14;
/// What stands for a pass when they are followed.
const PILOT_PASS: u64 = u64::MAX;
/// The least of them for each lamp and ball.
const LEAST_PILOT: u32 = 32;
/// Of the ways of a lamp and ball, the least part of the mean of all, however little came of them.
const LEAST_PART: f64 = 0.05;
/// Ways that one thread follows before it takes others.
const CHUNK: u32 = 1024;
/// The largest disc over which caught light is spread, as a part of the diagonal of the scene.
const REACH: f64 = 0.05;

/// How far above a surface ways along it lead, as a part of the size of the scene.
const LIFT: f64 = 1e-9;
/// A spot of which the cosine of the half angle is above this is aimed at as a whole, too.
const NARROW: f64 = 0.9;

/// Memory that caught light takes while it is kept for further views, bytes at the most.
const MOST_BYTES: usize = 1 << 30;

/// Follows light from lamps.
pub(super) struct TwoWay {
    surfaces: Surfaces,
    /// Triangles that stand in the way of light.
    opaque: Sorted,
    /// Those around what mirrors or refracts, and then others at which lamps are aimed.
    balls: Vec<Ball>,
    bodies: usize,
    /// How many ways go from each lamp to each ball.
    quotas: Vec<Quota>,
    turns: u32,
    /// The flux of light as it is caught, in the mean, W; none before some of it was.
    typical: Option<f64>,
    reach: f64,
    seed: u64,
    /// What was caught, pass by pass, as far as it is kept.
    kept: Mutex<Vec<Arc<Capture>>>,
}

/// Ways from a lamp to a ball.
#[derive(Clone, Debug)]
struct Quota {
    /// An index into the sources.
    lamp: usize,
    ball: usize,
    count: u32,
    /// Where it is best aimed at.
    guide: Guide,
}

/// What a few ways from a lamp to a ball brought.
struct Explored {
    /// Flux, W.
    caught: f64,
    /// The root mean square of the flux of a way, were it the only one. With ways in proportion to this, chance shows least in
    /// all together.
    ///
    /// # Source
    /// Neyman 1934, optimal allocation.
    deviation: f64,
    /// Where they have to be sent.
    guide: Guide,
}

/// What a pass caught.
struct Capture {
    pass: u32,
    light: Captured,
    balance: Balance,
}

/// Light that was caught, with what is needed to show it.
pub(super) struct CaughtLight<'a> {
    world: &'a World<'a>,
    two_way: &'a TwoWay,
    capture: Arc<Capture>,
    shrink: f64,
}

impl TwoWay {
    /// Looks where light of lamps goes; none if nothing of it goes through mirrors or glass to where it can be caught.
    pub(super) fn new(world: &World<'_>, keeps: impl Fn(usize) -> bool) -> Option<TwoWay> {
        let appearance = &world.appearance;
        let prepared = appearance.prepared;
        let settings = &prepared.settings;
        let of = |triangle: u32| {
            let object = prepared.object_of[triangle as usize];
            (keeps(object as usize), appearance.optics(object, prepared.material_number(triangle)))
        };
        let throws = |triangle: u32| matches!(of(triangle), (true, optics) if optics.throws());
        let balls = aim::balls(prepared, throws);
        let lamps: Vec<usize> =
            (0..appearance.sources.len()).filter(|i| appearance.sources[*i].1.is_caught()).collect();
        if balls.is_empty() || lamps.is_empty() {
            return None;
        }
        let takes = |object: usize| {
            let materials = 0..prepared.objects[object].materials.len() as u32;
            keeps(object) && materials.into_iter().any(|m| appearance.optics(object as u32, m).takes())
        };
        let opaque = |triangle: u32| of(triangle).0 && stands(world, triangle);
        let mut two_way = TwoWay {
            surfaces: Surfaces::new(prepared, takes),
            opaque: Sorted::new(&prepared.vertices, &prepared.triangles).only(opaque),
            quotas: Vec::new(),
            turns: settings.reflection_depth.max(LEAST_TURNS),
            reach: settings.photon_radius.unwrap_or_else(|| widest_disc(prepared)),
            typical: None,
            seed: settings.seed,
            kept: Mutex::new(Vec::new()),
            bodies: balls.len(),
            balls,
        };
        let spreads = |triangle: u32| matches!(of(triangle), (true, optics) if optics.is_broad());
        two_way.divide(world, &lamps, aim::everything(prepared, spreads));
        (!two_way.quotas.is_empty()).then_some(two_way)
    }

    /// Divides the ways among lamps and balls, as a few of them are of use.
    ///
    /// - `everything`: the ball around what sends light on by broad turns; none if nothing does.
    fn divide(&mut self, world: &World<'_>, lamps: &[usize], everything: Option<Ball>) {
        let wide = everything.map(|ball| {
            self.balls.push(ball);
            self.balls.len() - 1
        });
        let all = |lamp: &usize| (0..self.balls.len()).map(|ball| (*lamp, ball)).collect::<Vec<_>>();
        let mut pairs: Vec<(usize, usize)> = lamps.iter().flat_map(all).collect();
        for lamp in lamps {
            // In the cone of a spot, however thin it is.
            let cone = world.appearance.sources[*lamp].1.cone().filter(|(.., cosine)| *cosine > NARROW);
            if let Some((at, axis, cosine)) = cone {
                let far = world.appearance.prepared.bounds.diagonal();
                pairs.push((*lamp, self.balls.len()));
                self.balls.push(Ball::in_cone(at, axis * far, cosine));
            }
        }
        let photons = world.appearance.prepared.settings.photons;
        let pilot = (photons / 8).clamp(*PILOT.start(), *PILOT.end());
        let count = (pilot / pairs.len() as u32).max(LEAST_PILOT);
        self.quotas = pairs.into_iter().map(|(lamp, ball)| Quota { lamp, ball, count, guide: Guide::even() }).collect();
        let found: Vec<Explored> =
            (0..self.quotas.len()).into_par_iter().map(|quota| self.explore(world, quota, wide)).collect();
        let all: f64 = found.iter().map(|explored| explored.deviation).sum();
        let photons = f64::from(photons);
        if all <= 0.0 {
            self.quotas.clear();
            return;
        }
        self.typical = Some(found.iter().map(|explored| explored.caught).sum::<f64>() / photons);
        let least = LEAST_PART / found.len() as f64;
        let part = |explored: &Explored| (explored.deviation / all).max(least);
        let sum: f64 = found.iter().map(part).sum();
        for (quota, explored) in self.quotas.iter_mut().zip(found) {
            quota.count = (part(&explored) / sum * photons).ceil() as u32;
            quota.guide = explored.guide;
        }
    }

    /// Follows a few ways from a lamp to a ball: what they bring, and where they have to be sent.
    fn explore(&self, world: &World<'_>, quota: usize, wide: Option<usize>) -> Explored {
        let Quota { ball, count, .. } = self.quotas[quota];
        let mut used = Vec::new();
        let (mut caught, mut squares) = (0.0, 0.0);
        for index in 0..count {
            let (_, balance) = self.follow(world, PILOT_PASS, quota, index..index + 1);
            // What goes everywhere is of use everywhere: what little of it is found tells too little.
            let is_of_use = if Some(ball) == wide { balance.sent > 0.0 } else { balance.caught > 0.0 };
            if is_of_use {
                let choices = Choices::new(self.sequence(PILOT_PASS, quota), index);
                used.push(choices.point(Purpose::Aim, 0));
            }
            caught += balance.caught;
            squares += balance.caught * balance.caught;
        }
        Explored { caught, deviation: (squares * f64::from(count)).sqrt(), guide: Guide::around(&used) }
    }

    /// The choices of a pass for the ways from a lamp to a ball.
    fn sequence(&self, pass: u64, quota: usize) -> Sequence {
        let Quota { lamp, ball, .. } = self.quotas[quota];
        let number = (lamp * self.balls.len() + ball) as u64;
        Sequence::new(self.seed ^ pass.wrapping_mul(0x9e37_79b9_7f4a_7c15), number)
    }

    /// Follows all ways of a pass; none if it was cancelled.
    ///
    /// - `pass`: counts from 0. The more of them, the smaller the discs over which light is spread.
    pub(super) fn caught<'a>(&'a self, world: &'a World<'a>, pass: u32, watch: &Watch<'_>) -> Option<CaughtLight<'a>> {
        let shown = |capture: Arc<Capture>| {
            let shrink = f64::from(pass + 1).powf(-1.0 / 3.0);
            CaughtLight { world, two_way: self, capture, shrink }
        };
        let kept = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(capture) = kept().iter().find(|capture| capture.pass == pass) {
            return Some(shown(capture.clone()));
        }
        let capture = Arc::new(self.capture(world, pass, watch)?);
        let mut kept = kept();
        let bytes: usize = kept.iter().map(|capture| capture.light.bytes()).sum();
        if bytes + capture.light.bytes() <= MOST_BYTES {
            kept.push(capture.clone());
        }
        Some(shown(capture))
    }

    fn capture(&self, world: &World<'_>, pass: u32, watch: &Watch<'_>) -> Option<Capture> {
        let chunks = (0..self.quotas.len()).flat_map(|quota| {
            let count = self.quotas[quota].count;
            (0..count.div_ceil(CHUNK)).map(move |k| (quota, k * CHUNK..((k + 1) * CHUNK).min(count)))
        });
        let chunks: Vec<(usize, Range<u32>)> = chunks.collect();
        let follow = |(quota, range): (usize, Range<u32>)| {
            (!watch.is_cancelled()).then(|| self.follow(world, u64::from(pass), quota, range))
        };
        let parts: Option<Vec<(Vec<Caught>, Balance)>> = chunks.into_par_iter().map(follow).collect();
        let parts = parts?;
        let balance = parts.iter().fold(Balance::default(), |sum, (_, balance)| sum + *balance);
        let caught: Vec<Caught> = parts.into_iter().flat_map(|(caught, _)| caught).collect();
        Some(Capture { pass, light: Captured::new(&caught, world.appearance.wavelengths.lanes()), balance })
    }

    /// Follows some ways from a lamp to a ball.
    fn follow(&self, world: &World<'_>, pass: u64, quota: usize, range: Range<u32>) -> (Vec<Caught>, Balance) {
        let mut flight = Flight {
            world,
            surfaces: &self.surfaces,
            balls: &self.balls[..self.bodies],
            turns: self.turns,
            typical: self.typical,
            waiting: Vec::new(),
            caught: Vec::new(),
            balance: Balance::default(),
        };
        let sequence = self.sequence(pass, quota);
        for index in range {
            let choices = Choices::new(sequence, index);
            match self.start(world, &self.quotas[quota], &choices) {
                Some(start) if start.flux.max() > 0.0 && start.flux.is_finite() => flight.follow(&start, &choices),
                _ => flight.balance.ways += 1,
            }
        }
        (flight.caught, flight.balance)
    }

    /// Light as it leaves a lamp towards a ball.
    fn start(&self, world: &World<'_>, quota: &Quota, choices: &Choices) -> Option<Ray0> {
        let appearance = &world.appearance;
        let source = &appearance.sources[quota.lamp].1;
        let [comb, time] = choices.point(Purpose::Wavelengths, 0);
        let comb = appearance.wavelengths.comb(comb);
        let time = if world.moves() { (time - 0.5) * appearance.prepared.settings.shutter } else { 0.0 };
        let aim = quota.guide.draw(choices.point(Purpose::Aim, 0));
        let ball = &self.balls[quota.ball];
        // However a way might have been drawn.
        let others = || self.quotas.iter().filter(|other| other.lamp == quota.lamp);
        let all = |density: &dyn Fn(&Ball) -> Option<Aimed>| -> f64 {
            let of = |other: &Quota| {
                let (density, place) = density(&self.balls[other.ball])?;
                Some(f64::from(other.count) * density * other.guide.density(place))
            };
            others().filter_map(of).sum()
        };
        match source.start(choices.point(Purpose::Start, 0), comb)? {
            Start::Place { at, normal, area } => {
                let direction = ball.direction(at, aim);
                let density = all(&|ball| ball.density(at, direction));
                let flux = source.intensity(normal, direction, comb) * density.recip();
                // Clear of the lamp itself.
                let largest = at.abs().max_element() + area.sqrt();
                let clear = normal.map_or(DVec3::ZERO, |n| n * (1e-12 * largest * n.dot(direction).signum()));
                Some(Ray0 { ray: Ray { origin: at + clear, direction }, flux, comb, time })
            }
            Start::Parallel { direction, irradiance } => {
                let on = ball.line(direction, aim);
                let density = all(&|ball| ball.line_density(direction, on));
                let bounds = &appearance.prepared.bounds;
                let far = 2.0 * bounds.diagonal() + on.distance(bounds.center());
                let ray = Ray { origin: on - direction * far, direction };
                Some(Ray0 { ray, flux: irradiance * density.recip(), comb, time })
            }
        }
    }
}

/// The radius of the largest disc over which caught light is spread, unless the scene has one, scene units.
pub fn widest_disc(prepared: &Prepared) -> f64 {
    REACH * prepared.bounds.diagonal()
}

/// Whether light does not come through a triangle.
fn stands(world: &World<'_>, triangle: u32) -> bool {
    let prepared = world.appearance.prepared;
    let object = prepared.object_of[triangle as usize];
    let optics = world.appearance.optics(object, prepared.material_number(triangle));
    !optics.is_passable() && optics.interior.is_none()
}

impl CaughtLight<'_> {
    /// What became of all that was sent.
    pub(super) fn balance(&self) -> Balance {
        self.capture.balance
    }

    /// What a side of a triangle reflects diffusely of the light that was caught around a point, W/m², in lanes that are
    /// means over all combs.
    pub(super) fn exitance(&self, triangle: u32, outside: bool, at: DVec3) -> Channels {
        let appearance = &self.world.appearance;
        let prepared = appearance.prepared;
        let optics = appearance.optics(prepared.object_of[triangle as usize], prepared.material_number(triangle));
        let corners = prepared.corners(triangle);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize();
        let Some(normal) = normal.filter(|_| optics.takes()) else { return Channels::ZERO };
        let surface = self.two_way.surfaces.of(triangle);
        let lift = LIFT * (at.abs().max_element() + prepared.bounds.diagonal());
        let place = Place {
            position: at,
            outside: normal,
            leave: at + normal * if outside { lift } else { -lift },
            surface,
            side: flight::side_of(surface, outside),
        };
        let mut irradiance = Channels::ZERO;
        self.capture.light.each(&place, &self.surroundings(Detail::Smooth), |light| irradiance += light.irradiance);
        if irradiance == Channels::ZERO {
            return irradiance;
        }
        let weights = crate::numeric::triangle::weights(corners, at);
        let size = normal.any_orthonormal_pair();
        let place = optics.is_textured().then(|| prepared.place(triangle, weights, [size.0 * lift, size.1 * lift]));
        let combs = appearance.wavelengths.combs();
        let reflectance = (0..combs).fold(Channels::ZERO, |sum, comb| {
            let painting = place.as_ref().map(|place| optics.paint(place, comb));
            sum + diffuse(optics, comb, painting.as_ref().map_or(&[], |painting| painting.as_slice()))
        });
        reflectance * (combs as f64).recip() * irradiance
    }

    fn surroundings(&self, detail: Detail) -> Surroundings<'_> {
        Surroundings {
            world: self.world,
            surfaces: &self.two_way.surfaces,
            opaque: &self.two_way.opaque,
            reach: self.two_way.reach,
            detail,
            shrink: self.shrink,
        }
    }

    /// Radiance towards the viewer of an element by the light that was caught around it.
    ///
    /// - `passed`: how much of the radiance comes to the eye. `is_parted`: whether a single wavelength is left of it.
    /// - `coarse`: whether the element is one of many that send light to what is seen.
    /// - Returns what comes to the eye in the lanes of the ray; and what comes at other wavelengths, linear sRGB: of light
    ///   that took narrow turns only, and of light that took broad ones among them. And the standard error of all of it,
    ///   over it.
    pub(super) fn seen(
        &self,
        found: &Found<'_>,
        sighting: &Sighting<'_>,
        (passed, is_parted): (Channels, bool),
        coarse: bool,
    ) -> ([(Channels, DVec3); 2], f64) {
        let two_way = self.two_way;
        let element = &found.element;
        let surface = two_way.surfaces.of(found.triangle);
        let sign = if element.outside { 1.0 } else { -1.0 };
        let place = Place {
            position: element.position,
            outside: element.face * sign,
            leave: element.leave,
            surface,
            side: flight::side_of(surface, element.outside),
        };
        let appearance = &self.world.appearance;
        let surroundings = self.surroundings(if coarse { Detail::Coarse } else { Detail::Fine });
        let frame = found.frame();
        let wavelengths = &appearance.wavelengths;
        let even = found.optics.even_value(sighting);
        let mut found_light = [(Channels::ZERO, DVec3::ZERO); 2];
        let error = self.capture.light.each(&place, &surroundings, |arriving| {
            let light = frame.local(arriving.towards);
            let (sum, elsewhere) = &mut found_light[usize::from(arriving.is_again)];
            if !wavelengths.is_spectral() || is_parted {
                let value = even.unwrap_or_else(|| found.optics.spread_value(sighting, light));
                *sum += value * arriving.irradiance;
            } else {
                // The light has other wavelengths than the ray.
                let at = Sighting { comb: arriving.comb, ..*sighting };
                let passed = between(passed, sighting.comb, arriving.comb, wavelengths.combs());
                let radiance = found.optics.spread_value(&at, light) * arriving.irradiance * passed;
                *elsewhere += wavelengths.seen(arriving.comb, radiance);
            }
        });
        (found_light.map(|(sum, elsewhere)| (passed * sum, elsewhere)), error)
    }
}

/// A quantity that is known at the wavelengths of a comb, at those of another, by straight lines.
fn between(quantity: Channels, known: usize, wanted: usize, combs: usize) -> Channels {
    let apart = (wanted as f64 - known as f64) / combs as f64;
    let (other, part) = (if apart < 0.0 { -1 } else { 1 }, apart.abs());
    Channels(std::array::from_fn(|lane| {
        let beside = (lane as isize + other).clamp(0, LANES as isize - 1) as usize;
        quantity.0[lane] * (1.0 - part) + quantity.0[beside] * part
    }))
}
