//! Light that comes to an element from lights, without a way in between.

use super::draws::SampleDimension;
use super::encounter::{PathVertex, power_heuristic};
use crate::color::Channels;
use crate::illumination::light::LightSample;
use crate::illumination::optics::LobeClass;
use crate::numeric::ray::Ray;
use crate::render::RayCounts;
use crate::render::world::{Occluders, World};

/// How much shorter a ray to a triangle that emits is, so that it does not meet it.
const SHORT: f64 = 1.0 - 1e-7;

/// Asks lights.
pub(super) struct DirectLighting<'a> {
    world: &'a World<'a>,
    shadows: bool,
    /// Points of each light that has a size.
    samples: u32,
    /// Whether some light has a size.
    spread: bool,
}

impl<'a> DirectLighting<'a> {
    pub(super) fn new(world: &'a World<'a>, shadows: bool, samples: u32) -> DirectLighting<'a> {
        let spread = world.appearance.sources.iter().any(|(_, source)| !source.is_delta());
        DirectLighting { world, shadows, samples, spread }
    }

    /// Whether some light has a size, so that other rays may meet it.
    pub(super) fn has_area_lights(&self) -> bool {
        self.spread
    }

    /// Whether something is seen where rays meet nothing.
    pub(super) fn has_sky(&self) -> bool {
        self.world.appearance.sources.iter().any(|(_, source)| source.is_infinite())
    }

    /// Radiance towards the viewer by the light of all lights, of broad lobes and of narrow ones.
    ///
    /// - `add`: is told what each light brings, by its number.
    pub(super) fn radiance(
        &self,
        encounter: &PathVertex<'_>,
        counts: &mut RayCounts,
        mut add: impl FnMut(usize, Channels),
    ) -> [Channels; 2] {
        let PathVertex { found, sighting, draws, leg, .. } = encounter;
        let mut sum = [Channels::ZERO; 2];
        for (index, (number, source)) in self.world.appearance.sources.iter().enumerate() {
            let samples = if source.is_delta() { 1 } else { self.samples };
            if encounter.is_known && source.emits_photons() {
                continue;
            }
            if self.is_dark(encounter, index) {
                counts.spared += u64::from(samples);
                continue;
            }
            let mut part = [Channels::ZERO; 2];
            for sample in 0..samples {
                let uniform = draws.for_one_of_several(*leg, SampleDimension::Lights, *number as u32, [sample, samples]);
                if let Some(beam) =
                    source.sample_incident(found.element.position, Some(found.element.normal), uniform, sighting.comb)
                {
                    let arriving = self.reflected(encounter, index, &beam, counts);
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

    /// What a beam adds by broad lobes and by narrow ones.
    fn reflected(&self, encounter: &PathVertex<'_>, index: usize, beam: &LightSample, counts: &mut RayCounts) -> [Channels; 2] {
        let PathVertex { found, frame, sighting, among, highest, .. } = encounter;
        let optics = found.optics;
        let light = frame.local(beam.towards);
        let source = &self.world.appearance.sources[index].1;
        let ended = [LobeClass::Radiosity, LobeClass::LightsOnly].map(|which| optics.value(which, sighting, light));
        let mut values = [ended[0] + ended[1], Channels::ZERO];
        // Without what a further leg brings.
        let mut whole = values;
        for (which, value) in LobeClass::CONTINUING.into_iter().zip(&mut values) {
            let mut continued = optics.value(which, sighting, light);
            let most = continued.max();
            let is_cut = if *highest > 0.0 { !source.is_sky() } else { source.emits_photons() };
            if which == LobeClass::Narrow && most > *highest && is_cut {
                continued *= highest / most;
            }
            whole[usize::from(which == LobeClass::Narrow)] += continued;
            if let Some(density) = beam.density
                && continued != Channels::ZERO
            {
                // The rest is what a further leg brings that meets the light.
                continued *= power_heuristic(Some(density), optics.pdf(which, sighting, light, *among));
            }
            *value += continued;
        }
        let radiance = values.map(|value| value * beam.irradiance * light.z.abs());
        let is_finite = radiance.iter().all(|radiance| radiance.is_finite());
        if radiance == [Channels::ZERO; 2] || !is_finite || !self.shadows {
            return if is_finite { radiance } else { [Channels::ZERO; 2] };
        }
        counts.shadow += 1;
        let (ray, t_max) = self.ray(encounter, index, beam, light.z > 0.0);
        let way = self.world.occluders(ray.origin, index);
        let (passed, is_cleared) = self.world.transmittance(&ray, t_max, (index, way), (sighting.comb, encounter.draws.time));
        match is_cleared {
            // A further leg would be bent, and brings nothing.
            true => whole.map(|value| value * beam.irradiance * light.z.abs() * passed),
            false => radiance.map(|radiance| radiance * passed),
        }
    }

    /// Whether nothing comes from a light to an element, as far as the light buffer knows.
    fn is_dark(&self, encounter: &PathVertex<'_>, index: usize) -> bool {
        let dark = |from| matches!(self.world.occluders(from, index), Some(Occluders::Dark));
        let element = &encounter.found.element;
        self.shadows && dark(element.leave_curved) && dark(element.through)
    }

    /// The ray to where a beam comes from, and how much of it counts.
    fn ray(&self, encounter: &PathVertex<'_>, index: usize, beam: &LightSample, above: bool) -> (Ray, f64) {
        let element = &encounter.found.element;
        let origin = if above { element.leave_curved } else { element.through };
        if !beam.distance.is_finite() {
            return (Ray { origin, direction: beam.towards }, f64::INFINITY);
        }
        let source = &self.world.appearance.sources[index].1;
        let at = element.position + beam.towards * beam.distance;
        let t_max = if source.is_delta() || source.is_surface() { 1.0 } else { SHORT };
        (Ray { origin, direction: at - origin }, t_max)
    }
}
