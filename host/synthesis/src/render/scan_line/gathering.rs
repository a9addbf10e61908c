//! Gathering: the surfaces that the samples of a pixel see, and the elements in the middle of what they see.

use super::shader::{PixelScratch, SampleSight, Shader};
use super::surfaces::{PixelInteraction, PixelSurface, SampleFragment, StripPixel};
use super::visibility::{NONE, Strip};
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::numeric::ray::{Hit, Ray};
use crate::render::world::{BoundedRay, SurfaceElement};
use crate::scene::footprint;
use glam::DVec3;

/// How far beyond a triangle its plane and its normals may stand for neighbours that are lit as one with it: the least
/// weight of a corner.
const BEYOND: f64 = -1.0;

impl<'a> Shader<'a> {
    /// Finds the surfaces of a pixel, and which samples see them.
    pub(super) fn gather(&self, pixel: &StripPixel, strip: &Strip, scratch: &mut PixelScratch<'a>) {
        let PixelScratch { surfaces, parts, samples, finishing, .. } = scratch;
        surfaces.clear();
        parts.clear();
        samples.clear();
        let opaque = strip.near.len();
        for (i, sample) in pixel.samples().enumerate() {
            samples.push(SampleSight { begin: parts.len(), like: i, before_light: None, light: DVec3::ZERO });
            if finishing.has(i) {
                continue;
            }
            let mut add = |triangle: u32, near: f64, fragment: usize| {
                let before = parts.iter().rfind(|part| part.triangle == triangle).map(|part| part.surface);
                let surface = before.unwrap_or_else(|| self.surface(surfaces, triangle, near));
                surfaces[surface].add(triangle, pixel.place(i), [near, self.depth(near)]);
                parts.push(SampleFragment { surface, fragment, triangle, sample: i });
            };
            for index in strip.layers_of(sample) {
                let layer = strip.layers[index];
                add(layer.triangle, layer.near, opaque + index);
            }
            if strip.triangles[sample] != NONE {
                add(strip.triangles[sample], strip.near[sample], sample);
            }
        }
    }

    /// The surface of a pixel to which a triangle belongs.
    fn surface(&self, surfaces: &mut Vec<PixelSurface>, triangle: u32, near: f64) -> usize {
        let surface = self.begun(triangle, near);
        surfaces.iter().position(|other| surface.goes_on_in(other)).unwrap_or_else(|| {
            surfaces.push(surface);
            surfaces.len() - 1
        })
    }

    /// A surface of which no sample is known yet.
    fn begun(&self, triangle: u32, near: f64) -> PixelSurface {
        let prepared = self.appearance.prepared;
        let [a, b, c] = prepared.corners(triangle);
        PixelSurface {
            triangle,
            face: (b - a).cross(c - a).normalize_or_zero(),
            near,
            curved: self.is_curved(triangle),
            ids: [prepared.object_of[triangle as usize], prepared.material_number(triangle)],
            count: 0,
            sum: [0.0; 2],
            alone: true,
            nearness: [0.0; 2],
            interaction: None,
            irradiance: Channels::ZERO,
            unlit_radiance: Channels::ZERO,
            transmittance: Channels::ZERO,
            contributions: 0..0,
        }
    }

    /// Whether a triangle stands for a curved surface.
    #[inline]
    pub(super) fn is_curved(&self, triangle: u32) -> bool {
        self.appearance.curved && self.appearance.prepared.corner_normals(triangle).is_some()
    }

    /// The depth of a nearness.
    #[inline]
    pub(super) fn depth(&self, near: f64) -> f64 {
        if self.is_parallel { -near } else { near.recip() }
    }

    /// The mean distance of what samples see of a surface, its normal, object and material.
    pub(super) fn first(&self, surface: &PixelSurface, interaction: &PixelInteraction<'_>) -> (f64, DVec3, [u32; 2]) {
        let [near, depth] = surface.nearness.map(|sum| sum / f64::from(surface.count));
        (self.distance(interaction.distance, self.depth(near), depth), interaction.element.normal, interaction.ids)
    }

    /// The mean distance of some samples.
    ///
    /// Nearness is linear over the picture, depth is not: far away, the mean is not that of the middle.
    ///
    /// - `distance`, `middle`: distance and depth of the middle; `depth`: the mean depth.
    #[inline]
    pub(super) fn distance(&self, distance: f64, middle: f64, depth: f64) -> f64 {
        if self.is_parallel { distance + (depth - middle) } else { distance * (depth / middle) }
    }

    /// Finds the element in the middle of what samples see of a surface, and tells its number.
    pub(super) fn find_interaction<'p>(
        &self,
        surface: &PixelSurface,
        parts: impl Iterator<Item = &'p SampleFragment>,
        pixel: &StripPixel,
        interactions: &mut Vec<PixelInteraction<'a>>,
        last: &mut Option<PixelInteraction<'a>>,
    ) -> Option<usize> {
        let part = f64::from(surface.count).recip();
        let middle = surface.sum.map(|sum| sum * part);
        let (triangle, least) = if surface.alone {
            (surface.triangle, 0.0)
        } else {
            // The middle may lie in no triangle that a sample sees: the nearest is then extended up to there.
            let away = |at: [f64; 2]| (at[0] - middle[0]).powi(2) + (at[1] - middle[1]).powi(2);
            let places = parts.map(|part| (pixel.place(part.sample), part.triangle));
            (places.min_by(|(a, _), (b, _)| away(*a).total_cmp(&away(*b)))?.1, BEYOND)
        };
        let bounded = self.eye.ray(middle, [0.5; 2])?;
        if let Some(interaction) = last
            && interaction.move_to(triangle, &bounded.ray)
        {
            interactions.push(*interaction);
        } else {
            let interaction = self.element(triangle, &bounded, least)?;
            interactions.push(interaction);
            if interaction.is_flat {
                *last = Some(interaction);
            }
        }
        Some(interactions.len() - 1)
    }

    /// The element that a line of sight hits in a triangle.
    ///
    /// - `least`: the least weight of a corner, 0 where the element must lie within the triangle.
    pub(super) fn element(&self, triangle: u32, bounded: &BoundedRay, least: f64) -> Option<PixelInteraction<'a>> {
        let prepared = self.appearance.prepared;
        let length = bounded.ray.direction.length();
        let towards = bounded.ray.direction * length.recip();
        let hit = plane_hit(&bounded.ray, prepared.corners(triangle), triangle, least)?;
        let mut element = SurfaceElement::new(prepared, triangle, &bounded.ray, &hit, self.appearance.curved)?;
        let (object, material) = (prepared.object_of[triangle as usize], prepared.material_number(triangle));
        let bsdf = self.appearance.bsdf(object, material);
        let distance = hit.t * length;
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let mut sides = Default::default();
        if bsdf.is_textured() {
            sides = footprint(element.face, towards, bounded.cone.at(distance));
            let place = prepared.texture_place(triangle, weights, sides);
            element.tilt(-towards, |normal| bsdf.tilted(&place, normal));
        }
        let normal = element.normal;
        let frame = bsdf
            .brushed_along
            .map_or_else(|| ShadingFrame::from_normal(normal), |along| ShadingFrame::brushed(normal, along));
        let curved = self.is_curved(triangle);
        let is_flat = !curved && !bsdf.is_textured();
        let seen = [object, material];
        Some(PixelInteraction {
            element,
            curved,
            is_flat,
            frame,
            bsdf,
            distance,
            ids: seen,
            towards,
            triangle,
            weights,
            sides,
        })
    }
}

/// The hit of a line of sight on the plane of a triangle, moved towards its centroid until no weight is below the
/// least.
fn plane_hit(ray: &Ray, [a, b, c]: [DVec3; 3], triangle: u32, least: f64) -> Option<Hit> {
    const THIRD: f64 = 1.0 / 3.0;
    let (across, up, from) = (b - a, c - a, ray.origin - a);
    let p = ray.direction.cross(up);
    let scale = across.dot(p).recip();
    let q = from.cross(across);
    let (t, u, v) = (up.dot(q) * scale, from.dot(p) * scale, ray.direction.dot(q) * scale);
    if !(t.is_finite() && u.is_finite() && v.is_finite()) {
        return None;
    }
    let lowest = u.min(v).min(1.0 - u - v);
    let part = if lowest < least { (THIRD - least) / (THIRD - lowest) } else { 1.0 };
    Some(Hit { t, triangle, u: THIRD + (u - THIRD) * part, v: THIRD + (v - THIRD) * part })
}
