//! Follows one ray: direct light, shadows, mirrors.

use super::eye::Sight;
use super::surface::Element;
use crate::illumination::{self, Bands, Light, Material, Terms};
use crate::numeric::ray::Ray;
use crate::octree::Octree;
use crate::plan::{Plan, Stage};
use crate::render::RayCounts;
use crate::scene::Prepared;

/// A chain of mirrors ends where it would pass on less than this fraction of the light.
pub const ENERGY_CUTOFF: f64 = 1.0 / 4096.0;

/// Follows rays through a scene as its plan tells.
pub(super) struct Tracer<'a> {
    prepared: &'a Prepared,
    octree: Option<&'a Octree>,
    triangle_of: &'a [u32],
    lights: Vec<Light>,
    terms: Terms,
    curved: bool,
    ambient: bool,
    shadows: bool,
    reflections: u32,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(
        prepared: &'a Prepared,
        plan: &Plan,
        octree: Option<&'a Octree>,
        triangle_of: &'a [u32],
    ) -> Tracer<'a> {
        let lights = prepared.lights.iter().enumerate().filter(|(i, _)| plan.keeps_light(*i)).map(|(_, l)| *l);
        let depth = prepared.settings.reflection_depth;
        Tracer {
            prepared,
            octree,
            triangle_of,
            lights: lights.collect(),
            terms: Terms { diffuse: plan.needs(Stage::Diffuse), specular: plan.needs(Stage::Specular) },
            curved: plan.needs(Stage::Normals),
            ambient: plan.needs(Stage::Ambient),
            shadows: plan.needs(Stage::Shadows),
            reflections: if plan.needs(Stage::Reflection) { depth } else { 0 },
        }
    }

    /// Radiance where there is nothing.
    pub(super) fn background(&self) -> Bands {
        self.prepared.background
    }

    /// The radiance that arrives along a line of sight, and whether it meets an object.
    pub(super) fn radiance(&self, sight: &Sight, counts: &mut RayCounts) -> (Bands, bool) {
        let mut radiance = Bands::ZERO;
        let mut passed = Bands::ONE;
        let mut sight = *sight;
        counts.primary += 1;
        for depth in 0..=self.reflections {
            counts.reflected += u64::from(depth > 0);
            let Some((element, material)) = self.meet(&sight) else {
                return (radiance + passed * self.background(), depth > 0);
            };
            radiance += passed * self.emitted(&element, &material, &sight.ray, counts);
            passed *= material.mirror;
            if passed.max_element() < ENERGY_CUTOFF {
                break;
            }
            let direction = element.mirrored(sight.ray.direction);
            sight = Sight { ray: Ray { origin: element.leave, direction }, t_min: 0.0, t_max: f64::INFINITY };
        }
        (radiance, true)
    }

    /// The first surface element in sight.
    fn meet(&self, sight: &Sight) -> Option<(Element, Material)> {
        let hit = self.octree?.closest(&sight.ray, sight.t_min, sight.t_max)?;
        let triangle = self.triangle_of.get(hit.triangle as usize).copied().unwrap_or(hit.triangle);
        let element = Element::new(self.prepared, triangle, &sight.ray, &hit, self.curved)?;
        Some((element, *self.prepared.material(triangle)))
    }

    /// Radiance that an element sends back along a ray by the direct terms.
    fn emitted(&self, element: &Element, material: &Material, ray: &Ray, counts: &mut RayCounts) -> Bands {
        let view = -ray.direction.normalize();
        let mut sum = Bands::ZERO;
        if self.ambient {
            sum += illumination::ambient(material, self.prepared.ambient);
        }
        for light in &self.lights {
            let Some(beam) = light.beam(element.position) else { continue };
            let part = illumination::reflected(material, &beam, element.normal, view, self.terms);
            if part != Bands::ZERO && !(self.shadows && self.in_shadow(element, light, counts)) {
                sum += part;
            }
        }
        sum
    }

    fn in_shadow(&self, element: &Element, light: &Light, counts: &mut RayCounts) -> bool {
        counts.shadow += 1;
        let origin = element.leave_curved;
        let (direction, t_max) = match *light {
            Light::Point { at, .. } => (at - origin, 1.0),
            Light::Directional { direction, .. } => (-direction, f64::INFINITY),
        };
        let ray = Ray { origin, direction };
        self.octree.is_some_and(|octree| octree.occluded(&ray, 0.0, t_max))
    }
}
