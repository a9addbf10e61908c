//! Transmittance of shadow rays: what stops light, and what it passes straight.

use super::found::{FoundTriangle, walk};
use super::geometry::{World, outer_normal};
use super::light_buffer::Occluders;
use crate::color::Channels;
use crate::illumination::light::LightSource;
use crate::illumination::optics::{Bsdf, InteriorMedium};
use crate::numeric::ray::{Hit, Ray};
use crate::octree::{InstanceOctree, Shaft};
use crate::scene::SceneOctree;

impl World<'_> {
    /// Transmittance of a shadow ray: 0 if something opaque is in between; and whether it went through polished bodies
    /// that would have bent it.
    ///
    /// - `index`: of the light to which the ray leads, which does not occlude itself; with the occluders that stand
    ///   still, if they are known. `time`: when.
    pub(in crate::render) fn transmittance(
        &self,
        ray: &Ray,
        t_max: f64,
        index: usize,
        occluders: Option<&Occluders>,
        wavelength_set: usize,
        time: f64,
    ) -> (Channels, bool) {
        let blocks = |(other, (_, source)): (usize, &(usize, LightSource))| {
            other != index && source.is_surface() && source.intersect(ray, 0.0, t_max, wavelength_set).is_some()
        };
        if self.appearance.sources.iter().enumerate().any(blocks) {
            return (Channels::ZERO, false);
        }
        if self.grounds().any(|ground| ground.intersect(ray, [0.0, t_max]).is_some()) {
            return (Channels::ZERO, false);
        }
        let shaft = match occluders {
            Some(Occluders::Dark) => return (Channels::ZERO, false),
            Some(Occluders::Few(shaft)) => Some(&**shaft),
            _ => None,
        };
        let still = self.still();
        let (mut part, mut is_cleared) = still.map_or((Channels::ONE, false), |still| {
            self.octree_transmittance(still, shaft, ray, t_max, wavelength_set)
        });
        for (motion, carried) in &self.acceleration.moving {
            if part != Channels::ZERO {
                let (transmittance, cleared) =
                    self.octree_transmittance(carried, None, &motion.at(time).still(ray), t_max, wavelength_set);
                part *= transmittance;
                is_cleared |= cleared;
            }
        }
        let moving =
            self.acceleration.placed_moving.iter().map(|(motion, placed)| (placed, motion.at(time).still(ray)));
        for (placed, ray) in self.acceleration.placed.iter().map(|placed| (placed, *ray)).chain(moving) {
            if part != Channels::ZERO {
                let (transmittance, cleared) = self.instance_transmittance(placed, &ray, t_max, wavelength_set);
                part *= transmittance;
                is_cleared |= cleared;
            }
        }
        (part, is_cleared)
    }

    /// Transmittance of instances.
    fn instance_transmittance(
        &self,
        over: &InstanceOctree,
        ray: &Ray,
        t_max: f64,
        wavelength_set: usize,
    ) -> (Channels, bool) {
        let details = self.details.as_deref();
        if !(self.appearance.has_passable || self.appearance.has_clear_shadows) {
            let occluded = walk(over, details).occluded(ray, 0.0, t_max);
            return (if occluded { Channels::ZERO } else { Channels::ONE }, false);
        }
        let mut hits = Vec::new();
        let stopped = walk(over, details).each_hit(ray, 0.0, t_max, |hit| {
            // What stores all that it places tells a material without the place.
            let is_known = details.is_none();
            if is_known && !self.is_passed(self.bsdf_of(hit.hit.triangle)) {
                return true;
            }
            let found = FoundTriangle::placed(hit, over, details, None);
            let is_passed = is_known || self.is_passed(self.bsdf_of_found(&found));
            if is_passed {
                hits.push(found);
            }
            !is_passed
        });
        if stopped { (Channels::ZERO, false) } else { self.transmittance_of(hits, ray, t_max, wavelength_set) }
    }

    /// The BSDF of a triangle that was found.
    fn bsdf_of_found(&self, found: &FoundTriangle) -> &Bsdf {
        let [object, material] = found.object_and_material(self.appearance.prepared);
        self.appearance.bsdf(object, material)
    }

    /// Whether shadow rays pass a surface.
    fn is_passed(&self, bsdf: &Bsdf) -> bool {
        bsdf.is_passable() || self.appearance.has_clear_shadows && bsdf.is_clear()
    }

    /// Transmittance of the triangles of an octree, or of those of a shaft.
    fn octree_transmittance(
        &self,
        over: &SceneOctree,
        shaft: Option<&Shaft>,
        ray: &Ray,
        t_max: f64,
        wavelength_set: usize,
    ) -> (Channels, bool) {
        if !(self.appearance.has_passable || self.appearance.has_clear_shadows) {
            let occluded = match shaft {
                Some(shaft) => over.octree.occluded_in(shaft, ray, 0.0, t_max),
                None => over.octree.occluded(ray, 0.0, t_max),
            };
            return (if occluded { Channels::ZERO } else { Channels::ONE }, false);
        }
        match self.passable_hits(over, shaft, ray, t_max, true) {
            Some(hits) => self.transmittance_of(hits, ray, t_max, wavelength_set),
            None => (Channels::ZERO, false),
        }
    }

    /// Transmittance of all that stands still and that light passes straight, by wavelength set, as if nothing opaque
    /// stood between it; none if there is nothing of that kind on the way.
    pub(in crate::render) fn straight_transmittances(&self, ray: &Ray, t_max: f64) -> Option<Vec<Channels>> {
        let hits = self.passable_hits(self.still()?, None, ray, t_max, false).filter(|hits| !hits.is_empty())?;
        let sets = 0..self.appearance.wavelengths.count();
        Some(sets.map(|wavelength_set| self.transmittance_of(hits.clone(), ray, t_max, wavelength_set).0).collect())
    }

    /// Where a ray hits surfaces that light passes straight; none if it hits one that stops it.
    ///
    /// A hit has the number of its triangle in the scene.
    ///
    /// - `is_stopped`: whether what lets no light pass counts.
    fn passable_hits(
        &self,
        over: &SceneOctree,
        shaft: Option<&Shaft>,
        ray: &Ray,
        t_max: f64,
        is_stopped: bool,
    ) -> Option<Vec<FoundTriangle>> {
        let mut hits = Vec::new();
        let enough = |hit: Hit| {
            let hit = Hit { triangle: over.triangle(hit.triangle), ..hit };
            let is_passed = self.is_passed(self.bsdf_of(hit.triangle));
            if is_passed {
                hits.push(FoundTriangle::of_scene(hit, hit.triangle, None));
            }
            is_stopped && !is_passed
        };
        let stopped = match shaft {
            Some(shaft) => over.octree.each_hit_in(shaft, ray, 0.0, t_max, enough),
            None => over.octree.each_hit(ray, 0.0, t_max, enough),
        };
        if stopped { None } else { Some(hits) }
    }

    /// Transmittance of surfaces that light passes straight, and of the bodies within them.
    ///
    /// - `hits`: of the ray, in any order.
    fn transmittance_of(
        &self,
        mut hits: Vec<FoundTriangle>,
        ray: &Ray,
        t_max: f64,
        wavelength_set: usize,
    ) -> (Channels, bool) {
        let prepared = self.appearance.prepared;
        // Where triangles of an object share a side, what they stand for is passed once.
        hits.sort_by(|a, b| a.hit.t.total_cmp(&b.hit.t).then(a.triangle.cmp(&b.triangle)));
        hits.dedup_by_key(|passed| (passed.hit.t, passed.body(prepared)));
        // Where the ray is in which body, since when.
        let mut inside: Vec<([u32; 2], f64, &InteriorMedium)> = Vec::new();
        let left = |interior: &InteriorMedium, way: f64| {
            interior.absorption.of(wavelength_set).map(|absorption| (-absorption * way).exp())
        };
        let length = ray.direction.length();
        let mut is_cleared = false;
        let part = hits.iter().fold(Channels::ONE, |part, found| {
            let FoundTriangle { hit, triangle, carrier, .. } = found;
            let bsdf = self.bsdf_of_found(found);
            let normal = outer_normal(found.contents(prepared).corners(*triangle));
            let normal = carrier.as_ref().map_or(normal, |carrier| carrier.normal(normal));
            let slope = normal.dot(ray.direction) / length;
            let place = || self.texture_place(found, Default::default());
            let Some(interior) = bsdf.interior.as_ref().filter(|_| !bsdf.is_passable()) else {
                return part * bsdf.straight_transmittance(wavelength_set, slope.abs(), place);
            };
            is_cleared = true;
            let object = found.body(prepared);
            let mut part = part * bsdf.clear_transmittance(wavelength_set, slope.abs(), place);
            match (slope > 0.0, inside.iter().rposition(|(other, ..)| *other == object)) {
                // It began within the body, if it did not come into it.
                (true, entered) => {
                    let since = entered.map_or(0.0, |place| inside.swap_remove(place).1);
                    part *= left(interior, (hit.t - since) * length);
                }
                (false, _) => inside.push((object, hit.t, interior)),
            }
            part
        });
        // The light may be within a body.
        let inside = inside.into_iter().filter(|_| t_max.is_finite());
        let part = inside.fold(part, |part, (_, since, interior)| part * left(interior, (t_max - since) * length));
        (part, is_cleared)
    }
}
