//! Traces the path of a sample from the camera (Kajiya 1986), in two parts where an interface splits it (Whitted 1980).

use super::direct::DirectLighting;
use super::explain::{PathLog, PathNote};
use super::sampler::{PathSampler, SampleDimension};
use super::segment::{LastScattering, PathHistory, PathSegment};
use super::vertex::{PathVertex, power_heuristic};
use crate::color::srgb::LUMINANCE;
use crate::color::{Channels, WavelengthSets};
use crate::illumination::light::LightSource;
use crate::illumination::optics::{BsdfSample, LobeSelection, ShadingContext};
use crate::numeric::ray::Ray;
use crate::render::indirect::{IndirectLight, IrradiancePart};
use crate::render::two_way::PhotonEstimator;
use crate::render::world::{BoundedRay, Media, RayCone, RayHit, SurfaceInteraction, World, diffuse_albedo};
use crate::render::{PathClass, RayCounts};
use crate::scene::Caustics;
use glam::DVec3;

/// Throughput below which Russian roulette decides what continues (Arvo and Kirk 1990).
const ENERGY_CUTOFF: f64 = 1.0 / 4096.0;
/// Greatest value, 1/sr, with which narrow lobes reflect a lamp on an element reached by broad scattering, unless
/// caustics count; Lambert's is at most 1/π. Ours, in the place of the path regularisation of Kaplanyan and Dachsbacher
/// 2013.
const HIGHEST: f64 = 1.0;

/// The result of a sample.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathResult {
    /// Radiance of each class.
    pub(super) radiance: [Channels; PathClass::ALL.len()],
    /// Radiance of each class at other wavelengths than those of the sample, linear sRGB.
    pub(super) other_wavelengths: [DVec3; PathClass::ALL.len()],
    /// Whether the first path segment hit an object or light.
    pub(super) covered: bool,
    /// The first hit: distance from the camera, normal, object and material.
    pub(super) first: Option<FirstHit>,
    /// Variance of its luminance by chance in the photon map that is seen, which other samples share.
    pub(super) shared_variance: f64,
    /// The albedo that is seen, straight or by mirrors and smooth interfaces; a light counts as 1.
    pub(super) albedo: Channels,
    /// The normals there, each times the throughput.
    pub(super) normal: DVec3,
}

impl PathResult {
    fn add(&mut self, class: PathClass, radiance: Channels) {
        self.radiance[class as usize] += radiance;
    }

    /// Takes a light that a path segment hits as an albedo of 1.
    fn record_light_albedo(&mut self, segment: &PathSegment) {
        if segment.records_features {
            self.albedo += segment.throughput;
        }
    }
}

/// The first element that a path hits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FirstHit {
    pub(super) distance: f64,
    pub(super) normal: DVec3,
    pub(super) object: u32,
    pub(super) material: u32,
}

/// Scratch of a thread, for one sample after the other.
#[derive(Default)]
pub(in crate::render) struct PathScratch {
    pub(in crate::render) counts: RayCounts,
    /// Path segments that wait to be traced; none between samples.
    waiting: Vec<PathSegment>,
}

/// Where rays are counted, terms are logged and light is summed up.
struct SampleRecord<'a, 'b> {
    counts: &'a mut RayCounts,
    log: &'a mut PathLog<'b>,
    result: &'a mut PathResult,
}

/// Traces paths through a scene as its plan tells.
pub(super) struct PathTracer<'a> {
    world: &'a World<'a>,
    direct: DirectLighting<'a>,
    /// Most path segments after the first.
    depth: u32,
    caustics: Caustics,
    /// The photon map of lamps, if they emit photons.
    photons: Option<&'a PhotonEstimator<'a>>,
    /// Light that diffuse surfaces send each other, if it is known already.
    indirect: Option<&'a dyn IndirectLight>,
    /// Whether there is light that is not in the photon map: lights that emit no photons, or ambient light.
    has_unmapped_lights: bool,
    camera_media: Media,
    records_features: bool,
}

/// What paths do, for all pixels of a picture.
#[derive(Clone, Copy)]
pub(super) struct PathRules {
    /// Most path segments after the first.
    pub(super) depth: u32,
    /// Whether anything can stand before a light.
    pub(super) shadows: bool,
    /// What becomes of light that mirrors and glass throw from lamps: mapped where lamps emit photons.
    pub(super) caustics: Caustics,
    /// Whether a denoiser needs features.
    pub(super) records_features: bool,
}

impl<'a> PathTracer<'a> {
    /// - `photons`: the photon map. `indirect`: known light of other diffuse elements.
    /// - `camera_media`: the media around the camera.
    pub(super) fn new(
        world: &'a World<'a>,
        rules: PathRules,
        photons: Option<&'a PhotonEstimator<'a>>,
        indirect: Option<&'a dyn IndirectLight>,
        camera_media: Media,
    ) -> PathTracer<'a> {
        let PathRules { depth, shadows, caustics, records_features } = rules;
        let settings = &world.appearance.prepared.settings;
        let appearance = &world.appearance;
        let has_unmapped_lights =
            appearance.ambient.is_some() || appearance.sources.iter().any(|(_, source)| !source.emits_photons());
        let direct = DirectLighting::new(world, shadows, settings.light.samples.max(1));
        PathTracer {
            world,
            direct,
            depth,
            caustics,
            photons,
            indirect,
            has_unmapped_lights,
            camera_media,
            records_features,
        }
    }

    /// The radiance that arrives along a camera ray.
    pub(super) fn radiance(
        &self,
        bounded: &BoundedRay,
        wavelength_set: usize,
        sampler: &PathSampler,
        scratch: &mut PathScratch,
        log: PathLog<'_>,
    ) -> PathResult {
        self.radiance_along(self.camera_segment(bounded), wavelength_set, sampler, scratch, log)
    }

    /// The radiance that arrives along a path segment, times its throughput; the first hit is that of the segment.
    pub(super) fn radiance_along(
        &self,
        first: PathSegment,
        wavelength_set: usize,
        sampler: &PathSampler,
        scratch: &mut PathScratch,
        mut log: PathLog<'_>,
    ) -> PathResult {
        let mut result = PathResult::default();
        let begin = first.depth;
        let PathScratch { counts, waiting } = scratch;
        waiting.push(first);
        while let Some(segment) = waiting.pop() {
            match segment.depth {
                0 => counts.primary += 1,
                _ => counts.reflected += 1,
            }
            match self.world.intersect(&segment.bounded, wavelength_set, sampler.time) {
                RayHit::Nothing => {
                    let radiance = self.escaped_radiance(&segment, wavelength_set);
                    result.add(segment.history.class(), segment.throughput * radiance);
                    result.record_light_albedo(&segment);
                    result.covered |= segment.depth > 0;
                    log.note(|| PathNote::term(segment.depth, "hits nothing", segment.throughput * radiance));
                }
                RayHit::Light(index, light_hit) => {
                    let distance = light_hit.t * segment.bounded.ray.direction.length() - segment.begin;
                    let absorbed = segment.media.transmittance(self.world, distance, wavelength_set);
                    let (number, source) = &self.world.appearance.sources[index];
                    let radiance = absorbed * light_hit.radiance * self.mis_weight(&segment, source, light_hit.pdf);
                    result.add(segment.history.class(), segment.throughput * radiance);
                    result.record_light_albedo(&segment);
                    result.covered = true;
                    log.note(|| PathNote::light(segment.depth, *number, segment.throughput * radiance));
                }
                RayHit::Surface(interaction) => {
                    if segment.depth == begin {
                        let SurfaceInteraction { depth, object, material, .. } = interaction;
                        result.first =
                            Some(FirstHit { distance: depth, normal: interaction.element.normal, object, material });
                    }
                    result.covered = true;
                    let counting = &mut SampleRecord { counts, log: &mut log, result: &mut result };
                    self.scatter(segment, &interaction, wavelength_set, sampler, counting, waiting);
                }
            }
        }
        result
    }

    /// The wavelengths.
    pub(super) fn wavelengths(&self) -> &WavelengthSets {
        &self.world.appearance.wavelengths
    }

    /// The first segment of a path.
    pub(super) fn camera_segment(&self, bounded: &BoundedRay) -> PathSegment {
        PathSegment {
            bounded: *bounded,
            throughput: Channels::ONE,
            lamp_weight: 1.0,
            begin: 0.0,
            depth: 0,
            number: 1,
            pdf: None,
            normal: None,
            media: self.camera_media,
            lane: None,
            for_lights: false,
            history: PathHistory::NoBroad,
            last_scattering: LastScattering::Other,
            is_in_photon_map: false,
            records_features: self.records_features,
        }
    }

    /// Radiance that arrives along a path segment that hits nothing.
    fn escaped_radiance(&self, segment: &PathSegment, wavelength_set: usize) -> Channels {
        if segment.for_lights && !self.direct.has_sky() {
            return Channels::ZERO;
        }
        let ray = Ray { direction: segment.bounded.ray.direction.normalize(), ..segment.bounded.ray };
        let part = |sky: &LightSource, pdf| self.mis_weight(segment, sky, pdf);
        self.world.appearance.escaped_radiance(&ray, segment.normal, wavelength_set, part)
    }

    /// Adds the radiance of an element along a path segment, and the path segments that continue from there.
    fn scatter(
        &self,
        mut segment: PathSegment,
        interaction: &SurfaceInteraction<'_>,
        wavelength_set: usize,
        sampler: &PathSampler,
        SampleRecord { counts, log, result }: &mut SampleRecord<'_, '_>,
        waiting: &mut Vec<PathSegment>,
    ) {
        let bsdf = interaction.bsdf;
        let towards = segment.bounded.ray.direction.normalize();
        segment.throughput *=
            segment.media.transmittance(self.world, interaction.distance - segment.begin, wavelength_set);
        let medium_interface = segment.media.crossing(self.world, interaction, &segment.bounded.ray);
        if !medium_interface.is_interface {
            let bounded = BoundedRay { t_min: medium_interface.last, ..segment.bounded };
            waiting.push(PathSegment {
                bounded,
                begin: interaction.distance,
                media: medium_interface.media,
                ..segment
            });
            return;
        }
        log.note(|| PathNote::element(segment.depth, self.world.appearance.prepared, interaction));
        self.add_emission(&segment, interaction, wavelength_set, &mut SampleRecord { counts, log, result });
        if segment.for_lights && !bsdf.is_passable() {
            return;
        }
        let frame = interaction.frame();
        let (lane, lane_throughput) = self.lane(&segment, interaction, wavelength_set, sampler);
        let side = medium_interface.indices(self.world, wavelength_set);
        let context = ShadingContext {
            view: frame.local(-towards),
            wavelength_set,
            indices: side,
            lane,
            texture_values: interaction.texture_values(),
        };
        if segment.for_lights {
            let sample = bsdf.straight_sample(&context);
            waiting.extend(sample.and_then(|sample| self.straight_segment(&segment, interaction, sample, 0, sampler)));
            return;
        }
        self.add_known_light(&segment, interaction, &context, &mut SampleRecord { counts, log, result });
        let is_split = segment.is_split(bsdf, &context, waiting.len());
        let selection = if is_split { LobeSelection::NonDelta } else { LobeSelection::All };
        let clamp_value = self.clamp_value(&segment);
        let vertex = PathVertex {
            interaction,
            media_behind: medium_interface.media,
            frame,
            context,
            sampler: *sampler,
            segment: segment.number,
            selection,
            clamp_value,
            is_in_photon_map: segment.is_in_photon_map,
            lane_throughput,
        };
        if bsdf.has_non_delta() {
            let add = |number, radiance| {
                log.note(|| PathNote::direct_light(segment.depth, number, segment.throughput * radiance))
            };
            let light = self.direct.radiance(&vertex, counts, add);
            for (is_broad, radiance) in [true, false].into_iter().zip(light) {
                result.add(segment.history.extended(is_broad).class(), segment.throughput * radiance);
            }
        }
        if let Some(photons) = self.photons.filter(|_| bsdf.stores_photons() && !segment.is_in_photon_map) {
            self.add_photons(photons, &segment, &vertex, &mut SampleRecord { counts, log, result });
        }
        if bsdf.continues_paths() {
            self.continue_path(&segment, &vertex, is_split, waiting);
        }
    }

    /// The lane with which a path continues, and the throughput in it.
    ///
    /// Where wavelengths separate, a lane is sampled together with the set, in proportion to how much of it is seen.
    fn lane(
        &self,
        segment: &PathSegment,
        interaction: &SurfaceInteraction<'_>,
        wavelength_set: usize,
        sampler: &PathSampler,
    ) -> (usize, Channels) {
        let sampled = match segment.lane {
            None if interaction.disperses() => {
                let visibility = self.world.appearance.wavelengths.visibility(wavelength_set);
                segment.throughput.sample_lane(visibility, sampler.point(SampleDimension::Wavelengths)[1])
            }
            _ => None,
        };
        sampled.unwrap_or((segment.lane.unwrap_or(0), segment.throughput))
    }

    /// Adds what an element emits along a path segment.
    fn add_emission(
        &self,
        segment: &PathSegment,
        interaction: &SurfaceInteraction<'_>,
        wavelength_set: usize,
        SampleRecord { log, result, .. }: &mut SampleRecord<'_, '_>,
    ) {
        let towards = segment.bounded.ray.direction.normalize();
        let weight = |source: &LightSource, pdf| self.mis_weight(segment, source, pdf);
        if let Some((emission, factor)) = self.world.emitted(interaction, towards, wavelength_set, weight) {
            let radiance = segment.throughput * emission * factor;
            result.add(segment.history.class(), radiance);
            result.record_light_albedo(segment);
            log.note(|| PathNote::term(segment.depth, "emits", radiance));
        }
    }

    /// Adds light of an element for which nothing is sampled: ambient light, and that of other diffuse elements as far as
    /// it is known; and features for a denoiser.
    fn add_known_light(
        &self,
        segment: &PathSegment,
        interaction: &SurfaceInteraction<'_>,
        context: &ShadingContext<'_>,
        SampleRecord { log, result, .. }: &mut SampleRecord<'_, '_>,
    ) {
        let (bsdf, appearance) = (interaction.bsdf, &self.world.appearance);
        if segment.records_features {
            let mean_throughput = appearance.wavelengths.broad_bands(segment.throughput).element_sum() / 3.0;
            result.albedo += segment.throughput * bsdf.non_delta_albedo(context);
            result.normal += interaction.element.normal * mean_throughput;
        }
        if let Some(ambient) = &appearance.ambient {
            let radiance = segment.throughput * bsdf.ambient(context) * ambient.of(context.wavelength_set);
            result.add(PathClass::Indirect, radiance);
            log.note(|| PathNote::term(segment.depth, "ambient light", radiance));
        }
        if let Some(radiance) = self.indirect(interaction, context.wavelength_set).filter(|_| !segment.is_in_photon_map)
        {
            result.add(PathClass::Indirect, segment.throughput * radiance);
            log.note(|| PathNote::term(segment.depth, "light of other surfaces", segment.throughput * radiance));
        }
    }

    /// Adds the radiance estimate of the photon map at a vertex.
    fn add_photons(
        &self,
        photons: &PhotonEstimator<'_>,
        segment: &PathSegment,
        vertex: &PathVertex<'_>,
        SampleRecord { log, result, .. }: &mut SampleRecord<'_, '_>,
    ) {
        let (light, error) = photons.radiance_estimate(
            vertex.interaction,
            &vertex.context,
            segment.throughput,
            segment.lane.is_some(),
            segment.history != PathHistory::NoBroad,
        );
        let first = segment.history.extended(true).extended(false).class();
        if segment.history == PathHistory::NoBroad {
            let wavelengths = &self.world.appearance.wavelengths;
            let to_srgb = |(radiance, other): (Channels, DVec3)| {
                wavelengths.to_srgb(vertex.context.wavelength_set, radiance) + other
            };
            let luminance = light.map(to_srgb).into_iter().sum::<DVec3>().dot(LUMINANCE);
            result.shared_variance += (luminance * error).powi(2);
        }
        for (class, (radiance, elsewhere)) in [first, PathClass::Indirect].into_iter().zip(light) {
            result.add(class, radiance);
            result.other_wavelengths[class as usize] += elsewhere;
            log.note(|| PathNote::term(segment.depth, "photon map", radiance));
        }
    }

    /// Lets a path continue from a vertex by BSDF samples: one for each specular lobe and one of all others if it is
    /// split, else one.
    fn continue_path(
        &self,
        segment: &PathSegment,
        vertex: &PathVertex<'_>,
        is_split: bool,
        waiting: &mut Vec<PathSegment>,
    ) {
        let PathVertex { context, sampler, selection, .. } = vertex;
        let bsdf = vertex.interaction.bsdf;
        let point = sampler.for_segment(segment.number, SampleDimension::Direction, 0);
        let [choice, _] = sampler.for_segment(segment.number, SampleDimension::Choice, 0);
        if is_split {
            let drawn = bsdf.continues_non_delta().then(|| bsdf.sample(context, choice, point, *selection)).flatten();
            let samples = bsdf.specular_samples(context).zip(0..).chain(drawn.map(|sample| (sample, 2)));
            waiting.extend(samples.filter_map(|(sample, branch)| self.next_segment(segment, vertex, sample, branch)));
        } else {
            let drawn = bsdf.sample(context, choice, point, *selection);
            waiting.extend(drawn.and_then(|sample| self.next_segment(segment, vertex, sample, 0)));
        }
    }

    /// Radiance of an element by light of other diffuse ones, as far as it is known already.
    fn indirect(&self, interaction: &SurfaceInteraction<'_>, wavelength_set: usize) -> Option<Channels> {
        let indirect = self.indirect.filter(|_| interaction.bsdf.is_diffuse())?;
        let corners = self.world.appearance.prepared.corners(interaction.triangle);
        let weights = crate::numeric::triangle::weights(corners, interaction.element.position);
        let irradiance =
            indirect.irradiance(interaction.triangle, interaction.element.outside, weights, IrradiancePart::Indirect);
        Some(
            diffuse_albedo(interaction.bsdf, wavelength_set, interaction.texture_values())
                * irradiance
                * std::f64::consts::FRAC_1_PI,
        )
    }

    /// MIS weight of a light that a path segment hits.
    ///
    /// - `pdf`: of the segment's direction by sampling the light, 1/sr.
    fn mis_weight(&self, segment: &PathSegment, source: &LightSource, pdf: f64) -> f64 {
        let is_caustic = segment.pdf.is_none() && segment.history != PathHistory::NoBroad;
        match self.caustics {
            // A light that emits no photons counts wherever it is hit.
            Caustics::PhotonMapped if !source.emits_photons() => power_heuristic(segment.pdf, pdf),
            Caustics::PhotonMapped if segment.is_in_photon_map => 0.0,
            // A shadow ray has gone through the polished interfaces.
            Caustics::LeftOut
                if segment.last_scattering == LastScattering::ClearInterface
                    && self.world.appearance.has_clear_shadows =>
            {
                0.0
            }
            Caustics::LeftOut if source.is_sky() => power_heuristic(segment.pdf, pdf),
            Caustics::PhotonMapped | Caustics::LeftOut if is_caustic => 0.0,
            _ => segment.lamp_weight * power_heuristic(segment.pdf, pdf),
        }
    }

    /// The greatest value with which narrow lobes may reflect a lamp where a path segment arrives, 1/sr.
    fn clamp_value(&self, segment: &PathSegment) -> f64 {
        match self.caustics {
            Caustics::PhotonMapped if segment.history != PathHistory::NoBroad => 0.0,
            Caustics::LeftOut if segment.history != PathHistory::NoBroad => HIGHEST,
            _ => f64::INFINITY,
        }
    }

    /// The path segment that continues by a BSDF sample; none if it is not worth tracing.
    fn next_segment(
        &self,
        segment: &PathSegment,
        vertex: &PathVertex<'_>,
        sample: BsdfSample,
        branch: u32,
    ) -> Option<PathSegment> {
        let PathVertex { interaction, frame, context, sampler, clamp_value, lane_throughput, .. } = *vertex;
        if sample.is_straight {
            return self.straight_segment(segment, interaction, sample, branch, &sampler);
        }
        let through = sample.light.z < 0.0;
        let parts_wavelengths = through && segment.lane.is_none() && interaction.disperses();
        // Beyond the last path segment, a direction that might have been sampled for a light still tests for it.
        let is_last = segment.depth >= self.depth;
        if is_last && (sample.pdf.is_none() || !self.direct.has_area_lights()) {
            return None;
        }
        let goes_back =
            self.caustics == Caustics::PhotonMapped && !sample.is_broad && segment.history != PathHistory::NoBroad;
        let is_in_photon_map = segment.is_in_photon_map || goes_back;
        if is_in_photon_map && !self.has_unmapped_lights {
            return None;
        }
        let throughput = if parts_wavelengths { lane_throughput } else { segment.throughput } * sample.weight;
        let number = segment.number.wrapping_mul(3).wrapping_add(branch);
        let throughput = russian_roulette(throughput, number, &sampler)?;
        let element = &interaction.element;
        let direction = frame.world(sample.light);
        // Of a lobe with a pdf, what falls on the wrong side of the triangle or its surface is lost.
        if sample.pdf.is_some() && (direction.dot(element.plane(!through)) < 0.0) != through {
            return None;
        }
        let direction = element.righted(direction, !through);
        let media = if through { vertex.media_behind } else { segment.media };
        let lamps = match sample.pdf {
            Some(pdf) if clamp_value.is_finite() && !sample.is_broad => {
                (clamp_value * sample.light.z.abs() / (sample.weight.max() * pdf)).clamp(0.0, 1.0)
            }
            _ => 1.0,
        };
        let origin = if through { element.through } else { element.leave };
        let turn = match (sample.pdf, segment.last_scattering) {
            (Some(_), _) => LastScattering::NonDelta,
            (None, LastScattering::NonDelta | LastScattering::ClearInterface) if through => {
                LastScattering::ClearInterface
            }
            _ => LastScattering::Other,
        };
        Some(PathSegment {
            bounded: BoundedRay {
                ray: Ray { origin, direction },
                t_min: 0.0,
                t_max: f64::INFINITY,
                // A curved mirror widens it more; its many samples make up for that.
                cone: RayCone { width: segment.bounded.cone.at(interaction.distance), ..segment.bounded.cone },
            },
            throughput,
            lamp_weight: lamps,
            begin: 0.0,
            depth: segment.depth + 1,
            number,
            pdf: sample.pdf,
            normal: Some(element.normal),
            media,
            lane: if parts_wavelengths { Some(context.lane) } else { segment.lane },
            for_lights: is_last,
            history: segment.history.extended(sample.is_broad),
            last_scattering: turn,
            is_in_photon_map,
            records_features: segment.records_features && sample.pdf.is_none(),
        })
    }

    /// The path segment behind what it goes straight through: the same ray, so that lights are hit as if nothing was
    /// there.
    fn straight_segment(
        &self,
        segment: &PathSegment,
        interaction: &SurfaceInteraction<'_>,
        sample: BsdfSample,
        branch: u32,
        sampler: &PathSampler,
    ) -> Option<PathSegment> {
        let is_last = segment.depth >= self.depth;
        if is_last && (segment.pdf.is_none() || !self.direct.has_area_lights()) {
            return None;
        }
        let number = segment.number.wrapping_mul(3).wrapping_add(branch);
        let throughput = russian_roulette(segment.throughput * sample.weight, number, sampler)?;
        let bounded = BoundedRay { t_min: interaction.t, ..segment.bounded };
        let for_lights = segment.for_lights || is_last;
        Some(PathSegment {
            bounded,
            throughput,
            begin: interaction.distance,
            depth: segment.depth + 1,
            number,
            for_lights,
            ..*segment
        })
    }
}

/// Russian roulette: the throughput as it is, or of a faint segment by chance more of it or nothing.
fn russian_roulette(throughput: Channels, number: u32, sampler: &PathSampler) -> Option<Channels> {
    let most = throughput.max();
    if most >= ENERGY_CUTOFF {
        return Some(throughput);
    }
    let survival = most / ENERGY_CUTOFF;
    (most > 0.0 && sampler.for_segment(number, SampleDimension::Survival, 0)[0] < survival)
        .then(|| throughput * survival.recip())
}
