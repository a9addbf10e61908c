//! Irradiance by light that surfaces send each other, as paths find it from a point.

use super::explain::PathLog;
use super::sampler::{PathSampler, SampleDimension};
use super::segment::{LastScattering, PathHistory, PathSegment};
use super::tracer::{PathScratch, PathTracer};
use crate::color::Channels;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::cosine_hemisphere;
use crate::render::world::{BoundedRay, RayCone, SurfaceElement};
use std::f64::consts::PI;

/// Irradiance at an element by other surfaces.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct GatheredIrradiance {
    /// Irradiance, W/m²: in bands, or in spectra the means over eight parts of the wavelengths.
    pub(in crate::render) irradiance: Channels,
    /// Harmonic mean of the distances of what is around, scene units; infinite if there is nothing.
    pub(in crate::render) distance: f64,
}

impl PathTracer<'_> {
    /// The irradiance at an element by skies and surfaces around it, on the side of the viewer; not by lamps, which
    /// count as caustics do on a segment without a pdf.
    ///
    /// - `seed`: and `number`: of the random numbers. `count`: of directions, evenly spread by their cosine.
    /// - `is_followed`: whether surfaces send light, or only stop that of skies.
    pub(super) fn irradiance(
        &self,
        element: &SurfaceElement,
        [seed, number]: [u64; 2],
        (count, is_followed): (u32, bool),
        scratch: &mut PathScratch,
    ) -> GatheredIrradiance {
        let wavelengths = self.wavelengths();
        let (mut sum, mut nearness) = (Channels::ZERO, 0.0);
        for index in 0..count {
            let sampler = PathSampler::new(seed, number, index, count);
            let direction = cosine_hemisphere(sampler.point(SampleDimension::Pixel), element.normal);
            if direction.dot(element.horizon) <= 0.0 {
                continue;
            }
            let wavelength_set = wavelengths.set_at(sampler.point(SampleDimension::Wavelengths)[0]);
            let bounded = BoundedRay {
                ray: Ray { origin: element.leave, direction },
                t_min: 0.0,
                t_max: f64::INFINITY,
                cone: RayCone::default(),
            };
            let segment = PathSegment {
                depth: 1,
                for_lights: !is_followed,
                normal: Some(element.normal),
                history: PathHistory::OneBroad,
                last_scattering: LastScattering::NonDelta,
                ..self.camera_segment(&bounded)
            };
            let result = self.radiance_along(segment, wavelength_set, &sampler, scratch, PathLog::SILENT);
            let radiance = result.radiance.into_iter().fold(Channels::ZERO, |sum, part| sum + part);
            if radiance.is_finite() {
                sum += radiance;
            }
            nearness += result.first.map_or(0.0, |first| first.distance.recip());
        }
        let part = f64::from(count).recip();
        GatheredIrradiance { irradiance: sum * (PI * part), distance: (nearness * part).recip() }
    }
}
