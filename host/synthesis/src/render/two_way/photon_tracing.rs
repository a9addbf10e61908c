//! Traces photons from a lamp: through mirrors and glass to where they are stored.

use super::projection_map::BoundingSphere;
use super::smooth_surfaces::SmoothSurfaces;
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::{BsdfSample, LobeSelection, ShadingContext};
use crate::numeric::ray::Ray;
use crate::numeric::sequence::SobolSequence;
use crate::render::world::{BoundedRay, Media, MediumInterface, RayCone, RayHit, SurfaceInteraction, World};
use glam::DVec3;
use serde::Serialize;
use std::f64::consts::PI;

/// Scattering events after which a photon may be stopped, at the least; the scene may ask for more.
pub(super) const LEAST_BOUNCES: u32 = 128;
/// So many scattering events are traced whatever flux is left.
const CERTAIN_BOUNCES: u32 = 8;
/// Part of the flux of a photon below which Russian roulette decides (Arvo and Kirk 1990).
const FAINT: f64 = 1.0 / 64.0;
/// Part of the mean flux of stored photons below which Russian roulette decides about what was scattered broadly.
const FAINT_BROAD: f64 = 0.25;
/// Photons into which broad scattering splits one, and one more.
const MOST_PARTS: u32 = 17;
/// Width of the ray cone of a photon, as a part of the diagonal of the scene: hardly more than a point, but a relief is
/// tilted by heights side by side.
const WIDTH: f64 = 1e-6;

/// A photon that is stored on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Photon {
    pub(super) position: DVec3,
    /// Towards where it came from, unit length.
    pub(super) towards: DVec3,
    /// Flux, W.
    pub(super) flux: Channels,
    /// The side of a surface on which it arrived, as [`side_of`] numbers them.
    pub(super) side: u32,
    /// The wavelength set of the photon.
    pub(super) wavelength_set: u8,
    /// Whether it was scattered broadly before.
    pub(super) had_broad: bool,
}

/// One side of a smooth surface.
pub(super) fn side_of(surface: u32, outside: bool) -> u32 {
    surface << 1 | u32::from(outside)
}

/// The balance of the flux that was sent out, W: the mean over the wavelengths or bands.
///
/// `sent`, `rescattered` and `gained` together are all the others together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FluxBalance {
    /// Photon paths that were traced.
    #[serde(rename = "ways")]
    pub paths: u64,
    /// How many of them were taken from a database.
    #[serde(rename = "before")]
    pub stored_paths: u64,
    /// Sent out towards what mirrors or refracts.
    pub sent: f64,
    /// Sent again by broad scattering.
    #[serde(rename = "again")]
    pub rescattered: f64,
    /// Gained, or lost where negative, by chance: where one of several photons was traced instead of all.
    pub gained: f64,
    /// Came to a broad lobe without a mirror or glass before: light that goes straight.
    pub straight: f64,
    /// Stored on surfaces, behind mirrors and glass.
    #[serde(rename = "caught")]
    pub stored: f64,
    /// Absorbed by mirrors, in glass, and by lamps.
    pub absorbed: f64,
    /// Left the scene.
    pub escaped: f64,
    /// Was not traced further after very many scattering events.
    pub stopped: f64,
}

impl FluxBalance {
    /// The difference of both sides, as a part of all.
    pub fn residual(&self) -> f64 {
        let arrived = self.straight + self.stored + self.absorbed + self.escaped + self.stopped;
        (self.sent + self.rescattered + self.gained - arrived).abs() / self.sent.max(f64::MIN_POSITIVE)
    }

    /// The balance of paths with another flux.
    pub(super) fn scaled(&self, factor: f64) -> FluxBalance {
        FluxBalance {
            paths: self.paths,
            stored_paths: self.stored_paths,
            sent: self.sent * factor,
            rescattered: self.rescattered * factor,
            gained: self.gained * factor,
            straight: self.straight * factor,
            stored: self.stored * factor,
            absorbed: self.absorbed * factor,
            escaped: self.escaped * factor,
            stopped: self.stopped * factor,
        }
    }
}

impl std::fmt::Display for FluxBalance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let part = |watts: f64| 100.0 * watts / self.sent.max(f64::MIN_POSITIVE);
        write!(f, "{} photon paths traced", self.paths)?;
        if self.stored_paths > 0 {
            write!(f, ", {} of them in other runs", self.stored_paths)?;
        }
        write!(
            f,
            ": {:.5} W sent, {:.2} % again by broad scattering ({:+.2} % by chance); stored \
             {:.2} %, absorbed {:.2} %, escaped {:.2} %, straight {:.2} %, stopped {:.2} %; {:.1e} of it is missing",
            self.sent,
            part(self.rescattered),
            part(self.gained),
            part(self.stored),
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
            paths: self.paths + other.paths,
            stored_paths: self.stored_paths + other.stored_paths,
            sent: self.sent + other.sent,
            rescattered: self.rescattered + other.rescattered,
            gained: self.gained + other.gained,
            straight: self.straight + other.straight,
            stored: self.stored + other.stored,
            absorbed: self.absorbed + other.absorbed,
            escaped: self.escaped + other.escaped,
            stopped: self.stopped + other.stopped,
        }
    }
}

/// The random numbers of one photon path, by dimension.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhotonSampler {
    sequence: SobolSequence,
    index: u32,
}

/// A dimension of the sampler: what a random number is for.
#[derive(Clone, Copy, Debug)]
#[repr(u64)]
pub(super) enum PhotonDimension {
    /// The point where the photon leaves the lamp.
    Start,
    /// The direction of its emission.
    Aim,
    /// The wavelength set of the photon, and its time.
    Wavelengths,
    /// The lobe that scatters it, and the lane that is left where wavelengths separate.
    Choice,
    /// The direction of scattering by a narrow lobe or a broad one.
    Direction,
    Spread,
    /// The bounding sphere towards which a broad lobe sends it, if towards any.
    Aimed,
    /// Russian roulette.
    Survival,
}

impl PhotonSampler {
    pub(super) fn new(sequence: SobolSequence, index: u32) -> PhotonSampler {
        PhotonSampler { sequence, index }
    }

    pub(super) fn point(&self, purpose: PhotonDimension, number: u32) -> [f64; 2] {
        self.sequence.point(self.index, u64::from(number) << 8 | purpose as u64)
    }
}

/// A photon as it leaves a lamp.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmittedPhoton {
    pub(super) ray: Ray,
    pub(super) flux: Channels,
    pub(super) wavelength_set: usize,
    pub(super) time: f64,
}

/// Traces photons and keeps account of their flux.
pub(super) struct PhotonTracer<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) surfaces: &'a SmoothSurfaces,
    /// Around what mirrors or refracts.
    pub(super) spheres: &'a [BoundingSphere],
    /// Most scattering events.
    pub(super) most_bounces: u32,
    /// The mean flux of stored photons, W: broad scattering splits what has more, and Russian roulette thins out what
    /// has less. None if it is not known yet.
    pub(super) typical_flux: Option<f64>,
    /// Photon segments to be traced; none between paths.
    pub(super) waiting: Vec<PhotonSegment>,
    pub(super) photons: Vec<Photon>,
    pub(super) balance: FluxBalance,
}

/// A segment of a photon's path.
pub(super) struct PhotonSegment {
    ray: Ray,
    t_min: f64,
    flux: Channels,
    media: Media,
    lane: Option<usize>,
    /// Distinguishes its random numbers from those of others of the same path.
    number: u32,
    /// How many segments were before it, and how often a surface has scattered it, other than straight.
    segments: u32,
    bounces: u32,
    /// Whether the last scattering was narrow, and whether any was broad.
    was_narrow: bool,
    had_broad: bool,
}

impl PhotonTracer<'_> {
    fn watts(&self, flux: Channels) -> f64 {
        let lanes = self.world.appearance.wavelengths.lanes();
        flux.0[..lanes].iter().sum::<f64>() / lanes as f64
    }

    /// Traces a photon to its end.
    pub(super) fn trace(&mut self, start: &EmittedPhoton, sampler: &PhotonSampler) {
        let EmittedPhoton { ray, flux, wavelength_set, time } = *start;
        self.balance.paths += 1;
        self.balance.sent += self.watts(flux);
        let first = flux.max();
        let cone = RayCone { width: WIDTH * self.world.appearance.prepared.bounds.diagonal(), growth: 0.0 };
        let media = Media::default();
        let segment = PhotonSegment {
            ray,
            t_min: 0.0,
            flux,
            media,
            lane: None,
            number: 1,
            segments: 0,
            bounces: 0,
            was_narrow: false,
            had_broad: false,
        };
        self.waiting.push(segment);
        while let Some(mut segment) = self.waiting.pop() {
            self.russian_roulette(&mut segment, first, sampler);
            // Straight through panes it continues unscattered; a limit keeps even endless stacks of them from hanging.
            if segment.bounces > self.most_bounces || segment.segments > self.most_bounces.saturating_mul(2) {
                self.balance.stopped += self.watts(segment.flux);
                continue;
            }
            if segment.flux.max() <= 0.0 {
                continue;
            }
            let bounded = BoundedRay { ray: segment.ray, t_min: segment.t_min, t_max: f64::INFINITY, cone };
            match self.world.intersect(&bounded, wavelength_set, time) {
                RayHit::Nothing => self.balance.escaped += self.watts(segment.flux),
                RayHit::Light(..) => self.balance.absorbed += self.watts(segment.flux),
                RayHit::Surface(interaction) => {
                    let length = interaction.distance - segment.t_min * segment.ray.direction.length();
                    segment.media.notice(&interaction);
                    let left = segment.flux * segment.media.transmittance(self.world, length, wavelength_set);
                    self.balance.absorbed += self.watts(segment.flux) - self.watts(left);
                    segment.flux = left;
                    let medium_interface = segment.media.crossing(self.world, &interaction, &segment.ray);
                    if medium_interface.is_interface {
                        self.scatter(&segment, &interaction, wavelength_set, medium_interface, sampler);
                    } else {
                        self.waiting.push(PhotonSegment {
                            t_min: medium_interface.last,
                            media: medium_interface.media,
                            ..segment
                        });
                    }
                }
            }
        }
    }

    /// Russian roulette: ends a faint photon segment by chance, or gives it the flux that others have lost.
    fn russian_roulette(&mut self, segment: &mut PhotonSegment, first: f64, sampler: &PhotonSampler) {
        let faint = match segment.had_broad {
            true => (first * FAINT).max(FAINT_BROAD * self.typical_flux.unwrap_or(0.0)),
            false if segment.bounces > CERTAIN_BOUNCES => first * FAINT,
            false => return,
        };
        let part = segment.flux.max() / faint;
        if part < 1.0 {
            let before = self.watts(segment.flux);
            let survives = sampler.point(PhotonDimension::Survival, segment.number)[0] < part;
            segment.flux = if survives { segment.flux * part.recip() } else { Channels::ZERO };
            self.balance.gained += self.watts(segment.flux) - before;
        }
    }

    /// Stores a photon on an element, and scatters it.
    fn scatter(
        &mut self,
        segment: &PhotonSegment,
        interaction: &SurfaceInteraction<'_>,
        wavelength_set: usize,
        medium_interface: MediumInterface,
        sampler: &PhotonSampler,
    ) {
        let bsdf = interaction.bsdf;
        let incoming = self.watts(segment.flux);
        let towards = -segment.ray.direction.normalize();
        if segment.was_narrow && bsdf.stores_photons() {
            self.photons.push(Photon {
                position: self.world.hit_position(interaction, &segment.ray),
                towards,
                flux: segment.flux,
                side: side_of(self.surfaces.of(interaction.triangle), interaction.element.outside),
                wavelength_set: wavelength_set as u8,
                had_broad: segment.had_broad,
            });
        }
        let arrival = PhotonInteraction {
            segment,
            interaction,
            medium_interface,
            frame: interaction.frame(),
            wavelength_set,
            towards,
            sampler,
        };
        let narrow = (bsdf.casts_caustics() || bsdf.is_passable()).then(|| self.scatter_narrow(&arrival)).flatten();
        // What is not scattered is absorbed, or stored. What was scattered broadly was stored, too, and is sent again.
        let (expected, narrow) = narrow.unwrap_or((0.0, None));
        match (segment.was_narrow, bsdf.stores_photons()) {
            (false, true) => self.balance.straight += incoming - expected,
            (true, true) => self.balance.stored += incoming - expected,
            _ => self.balance.absorbed += incoming - expected,
        }
        self.balance.gained += narrow.as_ref().map_or(0.0, |segment| self.watts(segment.flux)) - expected;
        self.waiting.extend(narrow);
        if bsdf.is_broad() {
            self.scatter_broad(&arrival);
        }
    }

    /// Scattering by narrow lobes: the flux that is expected to continue, and one of the photon segments.
    fn scatter_narrow(&self, arrival: &PhotonInteraction<'_>) -> Option<(f64, Option<PhotonSegment>)> {
        let PhotonInteraction { segment, interaction, wavelength_set, sampler, .. } = arrival;
        let bsdf = interaction.bsdf;
        let [choice, parting] = sampler.point(PhotonDimension::Choice, segment.number);
        // Where wavelengths separate, the lane that is left is sampled in proportion to how much of it is seen.
        let alone = match segment.lane {
            None if interaction.disperses() => {
                segment.flux.sample_lane(self.world.appearance.wavelengths.visibility(*wavelength_set), parting)
            }
            _ => None,
        };
        let lane = segment.lane.or(alone.map(|(lane, _)| lane)).unwrap_or(0);
        let context = self.context(arrival, lane);
        let direction = sampler.point(PhotonDimension::Direction, segment.number);
        let drawn = bsdf.sample(&context, choice, direction, LobeSelection::Narrow);
        let Some(mut drawn) = drawn.filter(|drawn| drawn.pdf.is_none() || arrival.is_sound(drawn)) else {
            return Some((0.0, None));
        };
        arrival.make_adjoint(&context, LobeSelection::Narrow, &mut drawn);
        let flux = segment.flux * flux_factor(&context, &drawn);
        let expected = match drawn.pdf {
            // Of a lobe with a pdf, only the weight of the sample is known.
            Some(_) => self.watts(flux),
            None => bsdf
                .specular_samples(&context)
                .map(|sample| self.watts(segment.flux * flux_factor(&context, &sample)))
                .sum(),
        };
        let (flux, lane) = match alone.filter(|_| drawn.light.z < 0.0 && !drawn.is_straight) {
            Some((lane, alone)) => (alone * flux_factor(&context, &drawn), Some(lane)),
            None => (flux, segment.lane),
        };
        Some((expected, Some(arrival.next_segment(&drawn, flux, lane, segment.number.wrapping_mul(MOST_PARTS)))))
    }

    /// Scatters by broad lobes: half of it towards what mirrors or refracts, as far as it is known where that is.
    fn scatter_broad(&mut self, arrival: &PhotonInteraction<'_>) {
        let PhotonInteraction { segment, interaction, frame, sampler, .. } = arrival;
        let bsdf = interaction.bsdf;
        let context = self.context(arrival, segment.lane.unwrap_or(0));
        let from = interaction.element.position;
        let plane = interaction.element.plane(true);
        let spheres = self.spheres;
        let angles = || spheres.iter().map(|sphere| sphere.solid_angle(from, plane));
        // If the lobes scatter through the surface, too, only they know the directions.
        let all: f64 = if bsdf.interior.is_none() { angles().sum() } else { 0.0 };
        // A photon of much flux is split, each part about as much as other stored photons.
        let worth = 0.5 * self.watts(segment.flux) * (all / PI).min(1.0);
        let parts = match self.typical_flux {
            Some(typical) if !segment.had_broad => (worth / typical).clamp(1.0, f64::from(MOST_PARTS - 1)) as u32,
            _ => 1,
        };
        for part in 1..=parts {
            let number = segment.number.wrapping_mul(MOST_PARTS).wrapping_add(part);
            let [half, which] = sampler.point(PhotonDimension::Aimed, number);
            let point = sampler.point(PhotonDimension::Spread, number);
            let drawn = if all > 0.0 && half < 0.5 {
                let mut left = which * all;
                let is_chosen = |(_, angle): &(&BoundingSphere, f64)| {
                    left -= angle;
                    left < 0.0
                };
                let sphere = spheres.iter().zip(angles()).find(is_chosen);
                sphere.map(|(ball, _)| BsdfSample {
                    light: frame.local(ball.direction(from, point)),
                    weight: Channels::ZERO,
                    pdf: Some(0.0),
                    is_straight: false,
                    is_broad: true,
                })
            } else {
                let [choice, _] = sampler.point(PhotonDimension::Choice, number);
                bsdf.sample(&context, choice, point, LobeSelection::Broad)
            };
            let Some(mut drawn) = drawn.filter(|drawn| arrival.is_sound(drawn)) else { continue };
            if all > 0.0 {
                let direction = frame.world(drawn.light);
                let aimed = spheres.iter().zip(angles()).filter(|(b, angle)| *angle > 0.0 && b.is_hit(from, direction));
                let lobes = bsdf.pdf_among(LobeSelection::Broad, &context, drawn.light);
                drawn.pdf = Some(0.5 * (aimed.count() as f64 / all + lobes));
            }
            arrival.make_adjoint(&context, LobeSelection::Broad, &mut drawn);
            let flux = segment.flux * flux_factor(&context, &drawn) * f64::from(parts).recip();
            if flux.max() > 0.0 && flux.is_finite() {
                self.balance.rescattered += self.watts(flux);
                let segment = PhotonSegment {
                    was_narrow: false,
                    had_broad: true,
                    ..arrival.next_segment(&drawn, flux, segment.lane, number)
                };
                self.waiting.push(segment);
            }
        }
    }

    fn context<'b>(&self, arrival: &PhotonInteraction<'b>, lane: usize) -> ShadingContext<'b> {
        let PhotonInteraction { interaction, medium_interface, frame, wavelength_set, towards, .. } = arrival;
        let side = medium_interface.indices(self.world, *wavelength_set);
        ShadingContext {
            view: frame.local(*towards),
            wavelength_set: *wavelength_set,
            indices: side,
            lane,
            texture_values: interaction.texture_values(),
        }
    }
}

/// A photon that arrives at an element.
struct PhotonInteraction<'a> {
    segment: &'a PhotonSegment,
    interaction: &'a SurfaceInteraction<'a>,
    medium_interface: MediumInterface,
    frame: ShadingFrame,
    wavelength_set: usize,
    /// Towards where it came from, unit length.
    towards: DVec3,
    sampler: &'a PhotonSampler,
}

impl PhotonInteraction<'_> {
    /// Whether a direction of a lobe with a pdf is on the same side of the triangle and of its surface: what is not is
    /// lost.
    fn is_sound(&self, drawn: &BsdfSample) -> bool {
        let above = drawn.light.z > 0.0;
        let plane = self.interaction.element.plane(above);
        (self.frame.world(drawn.light).dot(plane) > 0.0) == above && drawn.weight.is_finite()
    }

    /// Gives a BSDF sample of a lobe with a pdf the weight of the adjoint, with which light goes from here to there,
    /// where that is not the same as from there to here (Veach 1997, chapter 5).
    fn make_adjoint(&self, context: &ShadingContext<'_>, selection: LobeSelection, drawn: &mut BsdfSample) {
        if let Some(pdf) = drawn.pdf.filter(|_| drawn.light.z > 0.0) {
            let back = ShadingContext { view: drawn.light, ..*context };
            drawn.weight = self.interaction.bsdf.value_among(selection, &back, context.view) * (drawn.light.z / pdf);
        }
    }

    /// The photon segment that continues by narrow scattering.
    fn next_segment(&self, drawn: &BsdfSample, flux: Channels, lane: Option<usize>, number: u32) -> PhotonSegment {
        let PhotonInteraction { segment, interaction, frame, .. } = self;
        let segments = segment.segments + 1;
        if drawn.is_straight {
            return PhotonSegment { t_min: interaction.t, flux, number, segments, ..**segment };
        }
        let through = drawn.light.z < 0.0;
        let media = if through { self.medium_interface.media } else { segment.media };
        let element = &interaction.element;
        let direction = element.righted(frame.world(drawn.light), !through);
        let origin = if through { element.through } else { element.leave };
        let (ray, bounces) = (Ray { origin, direction }, segment.bounces + 1);
        PhotonSegment {
            ray,
            t_min: 0.0,
            flux,
            media,
            lane,
            number,
            segments,
            bounces,
            was_narrow: true,
            had_broad: segment.had_broad,
        }
    }
}

/// The part of flux that continues: radiance grows as it enters what is denser; flux does not.
fn flux_factor(context: &ShadingContext<'_>, sample: &BsdfSample) -> Channels {
    if sample.light.z >= 0.0 || sample.is_straight {
        return sample.weight;
    }
    let [before, behind] = [context.indices.before.0, context.indices.behind.0];
    sample.weight * Channels(std::array::from_fn(|lane| (behind[lane] / before[lane]).powi(2)))
}
