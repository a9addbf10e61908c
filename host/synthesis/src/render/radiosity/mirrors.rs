//! Light that elements send each other by mirrors and panes, and what of a sky comes by them.
//!
//! A ray from an element goes on where it hits a polished surface: it is reflected or goes straight through, by chance,
//! each as often as light does. What it hits in the end exchanges light with the element as what it sees straight does:
//! the part of light that goes that way is the same in both directions.
//!
//! *Not modelled*: rough and textured mirrors, the polish of diffuse surfaces, glass that bends light, and what mirrors
//! throw from lamps and the sun.
//!
//! # Source
//! Extended form factors: Sillion and Puech 1989.

use super::visibility::{RayTarget, SHORT, VisibilityTester};
use crate::color::Channels;
use crate::illumination::Light;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::{Bsdf, InterfaceIndices, ShadingContext};
use crate::numeric::ray::Ray;
use crate::render::world::World;
use glam::DVec3;

/// Polished surfaces that a ray meets, at the most.
const MOST_MET: u64 = 64;
/// The cosine at which it is asked whether a surface reflects at all.
const OBLIQUE: f64 = 0.5;

/// The parts of light that a polished surface reflects and lets straight through, 0..=1.
#[derive(Clone, Copy, Debug, Default)]
struct Polish {
    reflected: f64,
    straight: f64,
}

/// What a ray meets that goes on at polished surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct MirroredTarget {
    /// With all that is lost on the way in its transmittance.
    pub(super) target: RayTarget,
    /// Whether the ray was reflected.
    pub(super) is_mirrored: bool,
    /// Radiance of skies from where it came, for rays that were reflected and escaped; means over all wavelength sets,
    /// W/(m² sr).
    pub(super) sky: Channels,
}

/// Whether some surface that takes part reflects as a mirror or a pane does.
pub(super) fn has_mirrors(world: &World<'_>) -> bool {
    let appearance = &world.appearance;
    let objects = appearance.prepared.objects.iter().enumerate();
    objects.into_iter().any(|(object, of)| {
        (0..of.materials.len() as u32)
            .any(|material| polish(world, appearance.bsdf(object as u32, material), OBLIQUE).reflected > 0.0)
    })
}

/// How polished a surface is.
///
/// - `cosine`: of the angle between light and normal, 0..=1.
fn polish(world: &World<'_>, bsdf: &Bsdf, cosine: f64) -> Polish {
    let takes_part = bsdf.is_passable() || !bsdf.is_diffuse();
    if !takes_part || bsdf.interior.is_some() || bsdf.is_textured() {
        return Polish::default();
    }
    let wavelengths = &world.appearance.wavelengths;
    let (sets, lanes) = (wavelengths.count(), wavelengths.lanes());
    let mean = |weight: Channels| weight.0[..lanes].iter().sum::<f64>() / (lanes * sets) as f64;
    let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    (0..sets).fold(Polish::default(), |sum, wavelength_set| {
        let context =
            ShadingContext { view, wavelength_set, indices: InterfaceIndices::AIR, lane: 0, texture_values: &[] };
        let reflected = bsdf.specular_samples(&context).filter(|sample| !sample.is_straight && sample.light.z > 0.0);
        let straight = bsdf.straight_sample(&context).map_or(0.0, |sample| mean(sample.weight));
        Polish {
            reflected: sum.reflected + reflected.map(|sample| mean(sample.weight)).sum::<f64>(),
            straight: sum.straight + straight,
        }
    })
}

impl VisibilityTester<'_> {
    /// What a ray hits that goes on at polished surfaces.
    ///
    /// - `uniform`: numbers in 0..1, one for each polished surface on the way.
    pub(super) fn trace_by_mirrors(&self, ray: &Ray, uniform: impl Fn(u64) -> f64) -> MirroredTarget {
        let (world, prepared) = (self.world, self.world.appearance.prepared);
        let (mut ray, mut from, mut weight, mut is_mirrored) = (*ray, 0.0, 1.0, false);
        let nothing = |target, is_mirrored| MirroredTarget { target, is_mirrored, sky: Channels::ZERO };
        for met in 0..MOST_MET {
            let struck = world.first_triangle(&ray, from);
            let t_max = struck.map_or(f64::INFINITY, |(hit, _)| hit.t);
            if world.appearance.intersect_lights(&ray, from, t_max, 0).is_some() {
                return nothing(RayTarget::Lamp, is_mirrored);
            }
            let passed = |t: f64| if from > 0.0 { self.along(&ray, t) } else { 1.0 };
            let Some((hit, triangle)) = struck else {
                let sky = if is_mirrored { self.sky(&ray) * (weight * passed(f64::INFINITY)) } else { Channels::ZERO };
                return MirroredTarget { sky, ..nothing(RayTarget::Nothing, is_mirrored) };
            };
            let bsdf = world.appearance.bsdf(prepared.object_of[triangle as usize], prepared.material_number(triangle));
            let [a, b, c] = prepared.corners(triangle);
            let outwards = (b - a).cross(c - a).normalize_or_zero();
            let cosine = outwards.dot(ray.direction) / ray.direction.length();
            let Polish { reflected, straight } = polish(world, bsdf, cosine.abs());
            if reflected > 0.0 && uniform(met) * (reflected + straight) < reflected {
                weight *= (reflected + straight) * passed(hit.t * SHORT);
                let normal = outwards * -cosine.signum();
                let frame = ShadingFrame::from_normal(normal);
                let view = frame.local(-ray.direction);
                let direction = frame.world(DVec3::new(-view.x, -view.y, view.z));
                ray = Ray { origin: ray.origin + ray.direction * hit.t + normal * self.clearance, direction };
                (from, is_mirrored) = (0.0, true);
            } else if bsdf.is_passable() {
                // What goes straight through is lost on the way; here it is made up for how often rays do not.
                weight *= if reflected > 0.0 && straight > 0.0 { (reflected + straight) / straight } else { 1.0 };
                from = hit.t;
            } else {
                let transmittance = weight * passed(hit.t * SHORT);
                let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
                let through_opening = !is_mirrored && self.openings.are_crossed(&ray, hit.t);
                let outside = cosine < 0.0;
                let target = RayTarget::Side { triangle, outside, weights, t: hit.t, transmittance, through_opening };
                return nothing(target, is_mirrored);
            }
        }
        nothing(RayTarget::Nothing, is_mirrored)
    }

    /// Radiance of skies from where a ray came, but for discs in them.
    fn sky(&self, ray: &Ray) -> Channels {
        let appearance = &self.world.appearance;
        let lights = &appearance.prepared.lights;
        let has_disc = |number: &usize| matches!(lights.get(*number), Some(Light::Sky { map: Some(map), .. }) if map.disc.is_some());
        let sets = appearance.wavelengths.count();
        let skies = appearance.sources.iter().filter(|(number, source)| source.is_sky() && !has_disc(number));
        let radiance = skies
            .flat_map(|(_, sky)| (0..sets).filter_map(|wavelength_set| sky.sky_radiance(ray, None, wavelength_set)))
            .fold(Channels::ZERO, |sum, light| sum + light.radiance);
        radiance * (sets as f64).recip()
    }
}
