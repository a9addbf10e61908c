//! Direct light: light samples of lights at a path vertex, with their shadow rays.

use super::sampler::SampleDimension;
use super::vertex::{PathVertex, power_heuristic};
use crate::color::Channels;
use crate::illumination::light::LightSample;
use crate::illumination::optics::LobeClass;
use crate::numeric::ray::Ray;
use crate::render::RayCounts;
use crate::render::world::{Occluders, World};

/// Length of a shadow ray to a triangle that emits, over the distance, so that it does not hit the triangle.
const SHORT: f64 = 1.0 - 1e-7;

/// Samples lights.
pub(super) struct DirectLighting<'a> {
    world: &'a World<'a>,
    shadows: bool,
    /// Light samples of each light that has a size.
    samples: u32,
    /// Whether some light has a size.
    has_area_lights: bool,
}

impl<'a> DirectLighting<'a> {
    pub(super) fn new(world: &'a World<'a>, shadows: bool, samples: u32) -> DirectLighting<'a> {
        let spread = world.appearance.sources.iter().any(|(_, source)| !source.is_delta());
        DirectLighting { world, shadows, samples, has_area_lights: spread }
    }

    /// Whether some light has a size, so that other rays may hit it.
    pub(super) fn has_area_lights(&self) -> bool {
        self.has_area_lights
    }

    /// Whether there is a light where rays hit nothing.
    pub(super) fn has_sky(&self) -> bool {
        self.world.appearance.sources.iter().any(|(_, source)| source.is_infinite())
    }

    /// Radiance towards the viewer by all lights: of broad lobes, and of narrow ones.
    ///
    /// - `add`: is told what each light adds, by its number.
    pub(super) fn radiance(
        &self,
        vertex: &PathVertex<'_>,
        counts: &mut RayCounts,
        mut add: impl FnMut(usize, Channels),
    ) -> [Channels; 2] {
        let PathVertex { interaction, context, sampler, segment, .. } = vertex;
        let own_light = self.world.prepared().objects[interaction.object as usize].light;
        let mut sum = [Channels::ZERO; 2];
        for (index, (number, source)) in self.world.appearance.sources.iter().enumerate() {
            let samples = if source.is_delta() { 1 } else { self.samples };
            if vertex.is_in_photon_map && source.emits_photons() {
                continue;
            }
            // Lamps are convex and emit outwards: their own bodies get none of their light straight.
            if own_light == Some(*number as u32) {
                continue;
            }
            if self.is_dark(vertex, index) {
                counts.spared += u64::from(samples);
                continue;
            }
            let mut part = [Channels::ZERO; 2];
            for sample in 0..samples {
                let uniform =
                    sampler.for_one_of_several(*segment, SampleDimension::Lights, *number as u32, [sample, samples]);
                if let Some(light_sample) = source.sample_incident(
                    interaction.element.position,
                    Some(interaction.element.normal),
                    uniform,
                    context.wavelength_set,
                ) {
                    let arriving = self.reflected(vertex, index, &light_sample, counts);
                    part.iter_mut().zip(arriving).for_each(|(part, light)| *part += light);
                }
            }
            if part != [Channels::ZERO; 2] {
                part.iter_mut().for_each(|part| *part *= f64::from(samples).recip());
                add(*number, part[0] + part[1]);
                sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            }
        }
        sum
    }

    /// Radiance towards the viewer by a light sample, of broad lobes and of narrow ones.
    fn reflected(
        &self,
        vertex: &PathVertex<'_>,
        index: usize,
        light_sample: &LightSample,
        counts: &mut RayCounts,
    ) -> [Channels; 2] {
        let PathVertex { interaction, frame, context, selection, clamp_value, .. } = vertex;
        let bsdf = interaction.bsdf;
        let light = frame.local(light_sample.towards);
        let source = &self.world.appearance.sources[index].1;
        let ended = [LobeClass::Radiosity, LobeClass::LightsOnly].map(|class| bsdf.value(class, context, light));
        let mut values = [ended[0] + ended[1], Channels::ZERO];
        // Without what a further path segment brings.
        let mut whole = values;
        for (class, value) in LobeClass::CONTINUING.into_iter().zip(&mut values) {
            let mut continued = bsdf.value(class, context, light);
            let most = continued.max();
            let is_cut = if *clamp_value > 0.0 { !source.is_sky() } else { source.emits_photons() };
            if class == LobeClass::Narrow && most > *clamp_value && is_cut {
                continued *= clamp_value / most;
            }
            whole[usize::from(class == LobeClass::Narrow)] += continued;
            if let Some(pdf) = light_sample.pdf
                && continued != Channels::ZERO
            {
                // The rest is brought by BSDF sampling, where a path segment hits the light.
                continued *= power_heuristic(Some(pdf), bsdf.pdf(class, context, light, *selection));
            }
            *value += continued;
        }
        let radiance = values.map(|value| value * light_sample.irradiance * light.z.abs());
        let is_finite = radiance.iter().all(|radiance| radiance.is_finite());
        if radiance == [Channels::ZERO; 2] || !is_finite || !self.shadows {
            return if is_finite { radiance } else { [Channels::ZERO; 2] };
        }
        counts.shadow += 1;
        let (ray, t_max) = self.ray(vertex, index, light_sample, light.z > 0.0);
        let occluders = self.world.occluders(ray.origin, index);
        let (transmittance, is_cleared) =
            self.world.transmittance(&ray, t_max, index, occluders, context.wavelength_set, vertex.sampler.time);
        match is_cleared {
            // A further path segment would be refracted, and bring nothing.
            true => whole.map(|value| value * light_sample.irradiance * light.z.abs() * transmittance),
            false => radiance.map(|radiance| radiance * transmittance),
        }
    }

    /// Whether no light of a source arrives at an element, as far as the light buffer knows.
    fn is_dark(&self, vertex: &PathVertex<'_>, index: usize) -> bool {
        let dark = |from| matches!(self.world.occluders(from, index), Some(Occluders::Dark));
        let element = &vertex.interaction.element;
        self.shadows && dark(element.leave_curved) && dark(element.through)
    }

    /// The shadow ray of a light sample, and the parameter at which it ends.
    fn ray(&self, vertex: &PathVertex<'_>, index: usize, light_sample: &LightSample, above: bool) -> (Ray, f64) {
        let element = &vertex.interaction.element;
        let origin = if above { element.leave_curved } else { element.through };
        if !light_sample.distance.is_finite() {
            return (Ray { origin, direction: light_sample.towards }, f64::INFINITY);
        }
        let source = &self.world.appearance.sources[index].1;
        let at = element.position + light_sample.towards * light_sample.distance;
        let t_max = if source.is_delta() || source.is_surface() { 1.0 } else { SHORT };
        (Ray { origin, direction: at - origin }, t_max)
    }
}
