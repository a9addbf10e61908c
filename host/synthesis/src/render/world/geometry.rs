//! The geometry of a scene as rays intersect it: triangles, in octrees of what stands still and of what moves.

use super::appearance::Appearance;
use super::camera_rays::BoundedRay;
use super::carrier::Carrier;
use super::element::{SurfaceElement, clearance};
use super::found::{FoundTriangle, walk};
use super::interaction::{RayHit, SurfaceInteraction};
use super::light_buffer::{LightBuffer, Occluders};
use crate::color::Channels;
use crate::illumination::light::{LightOrigin, LightSource};
use crate::illumination::optics::{Bsdf, TextureValues};
use crate::illumination::texture::TextureFootprint;
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::{Hit, Ray};
use crate::octree::{Octree, SurfacePoints};
use crate::plan::{Plan, Stage};
use crate::render::RenderError;
use crate::scene::{Acceleration, AccelerationKey, Details, Footprint, Prepared, SceneGround, SceneOctree, footprint};
use crate::stages::stage;
use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;

/// Most surfaces of transparent bodies in one place.
const MOST_COINCIDENT: usize = 8;

/// A scene as rays intersect it: geometry with its index, lights and materials. It knows no renderer.
pub struct World<'a> {
    pub(in crate::render) appearance: Appearance<'a>,
    /// The octrees of what the plan keeps; empty if it needs none.
    pub(super) acceleration: Arc<Acceleration>,
    light_buffer: Option<LightBuffer>,
    /// Points that stand for what stands still, if rays are to hit these.
    points: Option<SurfacePoints>,
    /// What is made of procedural models and terrain, if there are any.
    pub(super) details: Option<Arc<Details>>,
    /// Those terrains that rays meet exactly, by their numbers in the details; not their triangles.
    grounds: Vec<usize>,
}

impl<'a> World<'a> {
    /// Builds the octree over the objects that the plan keeps, and prepares materials and lights.
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn new(prepared: &'a Prepared, plan: &Plan) -> Result<World<'a>, RenderError> {
        if plan.needs(Stage::Radiosity) || plan.needs(Stage::PhotonMap) {
            check_copied(prepared)?;
        }
        let appearance = {
            let _stage = stage!("preparing lights and materials");
            Appearance::new(prepared, plan)?
        };
        let keeps = |object: usize| plan.needs(Stage::Octree) && plan.includes_object(object);
        let mut objects: Vec<bool> = (0..prepared.objects.len()).map(keeps).collect();
        let details = prepared.details(plan.views(), &prepared.settings);
        let grounds = exact_grounds(details.as_deref(), &appearance, plan);
        for ground in grounds.iter().filter_map(|number| details.as_ref()?.grounds().get(*number)) {
            objects[ground.object as usize] = false;
        }
        let acceleration = prepared.acceleration(AccelerationKey { objects, motions: plan.needs(Stage::Motion) })?;
        let world = World { grounds, ..World::over(acceleration, appearance, plan) };
        let points = world.surface_points(plan);
        Ok(World { points, ..world })
    }

    /// Points that stand for what stands still, if the plan needs them.
    fn surface_points(&self, plan: &Plan) -> Option<SurfacePoints> {
        let still = self.still().filter(|_| plan.needs(Stage::SurfacePoints))?;
        let (prepared, settings) = (self.prepared(), &self.prepared().settings);
        let surface = |triangle: u32| {
            let triangle = still.triangle(triangle);
            let (object, material) = (prepared.object_of[triangle as usize], prepared.material_number(triangle));
            // Rays continue straight through panes, and would hit them again.
            (!self.appearance.bsdf(object, material).is_passable()).then_some((object, material))
        };
        let _stage = stage!("choosing points of surfaces");
        let depth = settings.photons.point_depth.unwrap_or(0);
        Some(SurfacePoints::new(&still.octree, depth, surface, settings.image.seed))
    }

    /// Builds the octree over the objects that the plan keeps, for materials and lights that are prepared; all stand
    /// where they are in the middle of the time in which the shutter is open.
    ///
    /// # Errors
    /// [`RenderError`].
    pub(in crate::render) fn standing_still(appearance: Appearance<'a>, plan: &Plan) -> Result<World<'a>, RenderError> {
        let objects = (0..appearance.prepared.objects.len()).map(|object| plan.includes_object(object)).collect();
        let acceleration = appearance.prepared.acceleration(AccelerationKey { objects, motions: false })?;
        Ok(World::over(acceleration, appearance, plan))
    }

    /// Materials and lights alone, for whom traces no rays.
    pub(in crate::render) fn without_rays(appearance: Appearance<'a>) -> World<'a> {
        World {
            appearance,
            acceleration: Arc::default(),
            light_buffer: None,
            points: None,
            details: None,
            grounds: Vec::new(),
        }
    }

    fn over(acceleration: Arc<Acceleration>, appearance: Appearance<'a>, plan: &Plan) -> World<'a> {
        let prepared = appearance.prepared;
        let light_buffer = acceleration.still.as_ref().filter(|_| plan.needs(Stage::LightBuffer)).map(|still| {
            let is_opaque = |t: u32| {
                let bsdf = appearance.bsdf(prepared.object_of[t as usize], prepared.material_number(t));
                !(bsdf.is_passable() || appearance.has_clear_shadows && bsdf.is_clear())
            };
            let _stage = stage!("building the light buffer");
            let has_open = appearance.has_passable || appearance.has_clear_shadows;
            let opaque = has_open.then(|| still.triangles().map(is_opaque).collect());
            LightBuffer::new(&prepared.bounds, &appearance.sources, opaque)
        });
        let details = prepared.details(plan.views(), &prepared.settings);
        World { appearance, acceleration, light_buffer, points: None, details, grounds: Vec::new() }
    }

    /// The scene.
    pub fn prepared(&self) -> &'a Prepared {
        self.appearance.prepared
    }

    /// The octree, if the plan needs one.
    pub fn octree(&self) -> Option<&Octree> {
        self.still().map(|still| &still.octree)
    }

    /// The octree of what stands still, if anything does.
    pub(super) fn still(&self) -> Option<&SceneOctree> {
        self.acceleration.still.as_ref()
    }

    /// Whether it has procedural models, which are made while rays come to them.
    pub(in crate::render) fn makes_detail(&self) -> bool {
        self.details.as_ref().is_some_and(|details| details.has_models())
    }

    /// Whether a procedural model could not be made: the picture is not what was asked for.
    pub(in crate::render) fn lacks_detail(&self) -> bool {
        self.details.as_ref().is_some_and(|details| details.has_failed())
    }

    /// Tells what procedural model could not be made.
    ///
    /// # Errors
    /// [`RenderError::Model`].
    pub(in crate::render) fn check_details(&self) -> Result<(), RenderError> {
        self.details.as_ref().map_or(Ok(()), |details| details.check().map_err(RenderError::Model))
    }

    /// How long it took to build its octrees, whether for it or for an earlier one.
    pub fn octree_time(&self) -> Duration {
        self.acceleration.build
    }

    /// Whether no light comes through a triangle.
    pub(in crate::render) fn is_opaque(&self, triangle: u32) -> bool {
        let prepared = self.appearance.prepared;
        let object = prepared.object_of[triangle as usize];
        let bsdf = self.appearance.bsdf(object, prepared.material_number(triangle));
        !bsdf.is_passable() && bsdf.interior.is_none()
    }

    /// The occluders that stand still between a point and a light, if the light buffer knows them.
    pub(in crate::render) fn occluders(&self, from: DVec3, light: usize) -> Option<&Occluders> {
        self.light_buffer.as_ref()?.occluders(self.octree()?, from, light)
    }

    /// Whether something moves, so that samples need a time.
    pub(in crate::render) fn moves(&self) -> bool {
        !(self.acceleration.moving.is_empty() && self.acceleration.placed_moving.is_empty())
    }

    /// The first triangle in sight at a time.
    fn first(&self, ray: &Ray, [t_min, t_max]: [f64; 2], time: f64) -> Option<FoundTriangle> {
        let hit = match &self.points {
            Some(points) => points.closest(ray, t_min, t_max),
            None => self.octree().and_then(|octree| octree.closest(ray, t_min, t_max)),
        };
        let still = |own: u32| self.still().map_or(own, |still| still.triangle(own));
        let mut first = hit.map(|hit| FoundTriangle::of_scene(hit, still(hit.triangle), None));
        let limit = |first: &Option<FoundTriangle>| first.as_ref().map_or(t_max, |first| first.hit.t);
        for (motion, carried) in &self.acceleration.moving {
            let moved = motion.at(time);
            if let Some(hit) = carried.octree.closest(&moved.still(ray), t_min, limit(&first)) {
                let carrier = Some(Carrier::moved(&moved));
                first = Some(FoundTriangle::of_scene(hit, carried.triangle(hit.triangle), carrier));
            }
        }
        let details = self.details.as_deref();
        if let Some(placed) = &self.acceleration.placed
            && let Some(hit) = walk(placed, details).closest(ray, t_min, limit(&first))
        {
            first = Some(FoundTriangle::placed(hit, placed, details, None));
        }
        for (motion, placed) in &self.acceleration.placed_moving {
            let moved = motion.at(time);
            if let Some(hit) = walk(placed, details).closest(&moved.still(ray), t_min, limit(&first)) {
                first = Some(FoundTriangle::placed(hit, placed, details, Some(&moved)));
            }
        }
        for ground in self.grounds() {
            if let Some(hit) = ground.intersect(ray, [t_min, limit(&first)]) {
                let stands_for = self.appearance.prepared.objects[ground.object as usize].first;
                first = Some(FoundTriangle::of_ground(hit, ground, stands_for));
            }
        }
        first
    }

    /// The terrains that rays meet exactly.
    pub(super) fn grounds(&self) -> impl Iterator<Item = &SceneGround> {
        let all = self.details.as_ref().map_or(&[][..], |details| details.grounds());
        self.grounds.iter().filter_map(|number| all.get(*number))
    }

    /// The first triangle that a ray hits in the middle of the time in which the shutter is open.
    pub(in crate::render) fn first_triangle(&self, ray: &Ray, t_min: f64) -> Option<(Hit, u32)> {
        self.first(ray, [t_min, f64::INFINITY], 0.0).map(|first| (first.hit, first.triangle))
    }

    /// The first hit of a ray at a time.
    pub(in crate::render) fn intersect(&self, bounded: &BoundedRay, wavelength_set: usize, time: f64) -> RayHit<'_> {
        let first = self.first(&bounded.ray, [bounded.t_min, bounded.t_max], time);
        let t_max = first.as_ref().map_or(bounded.t_max, |first| first.hit.t);
        if let Some((index, light_hit)) =
            self.appearance.intersect_lights(&bounded.ray, bounded.t_min, t_max, wavelength_set)
        {
            return RayHit::Light(index, light_hit);
        }
        let Some(mut first) = first else { return RayHit::Nothing };
        let scene = self.appearance.prepared;
        if first.carrier.is_none()
            && first.ground.is_none()
            && self.points.is_none()
            && let Some((hit, triangle)) = self.contact(&bounded.ray, first.triangle, &first.hit)
        {
            first = FoundTriangle::of_scene(hit, triangle, None);
        }
        let (hit, triangle, carrier) = (first.hit, first.triangle, first.carrier.as_ref());
        let contents = first.contents(scene);
        // What moves or is placed is intersected where it is kept, up to the element.
        let ray = match (carrier, &self.points) {
            (Some(carrier), _) => carrier.own_ray(&bounded.ray),
            (None, Some(_)) => through(&bounded.ray, &hit, contents.corners(triangle)),
            (None, None) => bounded.ray,
        };
        let element = match &first.ground {
            Some(ground) => Some(ground.element(&ray)),
            None => SurfaceElement::new(contents, triangle, &ray, &hit, self.appearance.curved),
        };
        let Some(mut element) = element else { return RayHit::Nothing };
        let [object, material] = first.object_and_material(scene);
        let bsdf = self.appearance.bsdf(object, material);
        let length = bounded.ray.direction.length();
        let distance = hit.t * length;
        let exact = if self.appearance.exact && first.ground.is_none() {
            let on = contents.on_surface(triangle, &ray, weights(&hit), element.position, element.outside);
            on.filter(|on| element.settle(ray.direction, hit.t - bounded.t_min, on))
        } else {
            None
        };
        let depth = distance + exact.map_or(0.0, |on| on.beyond * length);
        let mut along = bsdf.brushed_along;
        if let Some(carrier) = carrier {
            element.carry(carrier);
            along = along.map(|along| carrier.vector(along));
        }
        let texture_values = if bsdf.is_textured() {
            let towards = bounded.ray.direction / length;
            let sides = footprint(element.face, towards, bounded.cone.at(distance));
            let mut place = self.texture_place(&first, sides);
            if let Some(on) = exact {
                (place.uv, place.own) = (on.uv, on.own);
            }
            element.tilt(-towards, |normal| bsdf.tilted(&place, normal));
            bsdf.texture_values(&place, wavelength_set)
        } else {
            TextureValues::new()
        };
        RayHit::Surface(SurfaceInteraction {
            element,
            bsdf,
            triangle,
            object,
            material,
            distance,
            depth,
            t: hit.t,
            texture_values,
            brushed_along: along,
        })
    }

    /// Where a hit is, and what of the surface is looked at: as [`Contents::texture_place`](crate::scene::Contents::texture_place)
    /// tells, also of what is carried from where it is kept.
    pub(super) fn texture_place(&self, found: &FoundTriangle, sides: Footprint) -> TextureFootprint {
        let contents = found.contents(self.appearance.prepared);
        if let Some(ground) = &found.ground {
            return ground.texture_place(sides, contents.object(found.triangle).variation);
        }
        let weights = weights(&found.hit);
        let Some(carrier) = &found.carrier else { return contents.texture_place(found.triangle, weights, sides) };
        let own = sides.map(|side| carrier.own_vector(side));
        let mut place = contents.texture_place(found.triangle, weights, own);
        place.sides.iter_mut().zip(sides).for_each(|(side, scene)| side.scene = scene);
        place.along = place.along.map(|along| carrier.vector(along));
        place.variation = place.variation.wrapping_add(carrier.variation);
        place
    }

    /// The position where a ray hit an element: where a point stands for the surface, not all rays come to one place.
    pub(in crate::render) fn hit_position(&self, interaction: &SurfaceInteraction<'_>, ray: &Ray) -> DVec3 {
        self.points.as_ref().map_or(interaction.element.position, |_| ray.at(interaction.t))
    }

    /// The light that an element emits, and its MIS weight.
    ///
    /// - `part`: MIS weight of a source that would have sampled the direction with a pdf.
    pub(in crate::render) fn emitted(
        &self,
        interaction: &SurfaceInteraction<'_>,
        towards: DVec3,
        wavelength_set: usize,
        part: impl Fn(&LightSource, f64) -> f64,
    ) -> Option<(Channels, f64)> {
        let SurfaceInteraction { object, material, element, depth, .. } = interaction;
        let (emission, index) = self.appearance.emission(*object, *material, element.outside, wavelength_set)?;
        let cosine = towards.dot(element.face);
        let counted = |index: usize| {
            let source = &self.appearance.sources[index].1;
            let from = element.position - towards * *depth;
            part(source, source.pdf_on_object(from, towards, interaction.distance, cosine))
        };
        Some((emission, index.map_or(1.0, counted)))
    }

    /// What a transparent body stands on, where a ray hits its surface: something opaque in the same place, within the
    /// rounding of its coordinates. There is no air between the two.
    fn contact(&self, ray: &Ray, triangle: u32, hit: &Hit) -> Option<(Hit, u32)> {
        let prepared = self.appearance.prepared;
        let bsdf = |triangle: u32| {
            self.appearance.bsdf(prepared.object_of[triangle as usize], prepared.material_number(triangle))
        };
        let still = self.still().filter(|_| bsdf(triangle).interior.is_some())?;
        let width = clearance(prepared.corners(triangle)) / slope(prepared.corners(triangle), ray.direction).abs();
        if !width.is_finite() {
            return None;
        }
        let mut contact = None;
        still.octree.each_hit(ray, hit.t - width, hit.t + width, |other| {
            let triangle = still.triangle(other.triangle);
            let bsdf = bsdf(triangle);
            let is_opaque = bsdf.interior.is_none() && !bsdf.is_passable();
            if is_opaque {
                contact = Some((other, triangle));
            }
            is_opaque
        });
        contact
    }

    /// Gives the other surfaces of transparent bodies that stand still and lie in the place of an element, within the
    /// rounding of its coordinates: how far they are in lengths of the ray's direction, object, material, and whether
    /// the ray comes from outside.
    pub(in crate::render) fn coincident(
        &self,
        ray: &Ray,
        interaction: &SurfaceInteraction<'_>,
        mut give: impl FnMut(f64, u32, u32, bool),
    ) {
        let Some(still) = self.still().filter(|_| self.appearance.has_nested) else { return };
        let prepared = self.appearance.prepared;
        let height = ray.direction.dot(interaction.element.face).abs();
        let width = interaction.element.clearance / height;
        if !width.is_finite() {
            return;
        }
        let mut seen = [(interaction.object, interaction.element.outside); MOST_COINCIDENT];
        let mut count = 1;
        still.octree.each_hit(ray, interaction.t - width, interaction.t + width, |hit| {
            let triangle = still.triangle(hit.triangle);
            let object = prepared.object_of[triangle as usize];
            let material = prepared.material_number(triangle);
            let is_outside = slope(prepared.corners(triangle), ray.direction) < 0.0;
            // Of triangles that share a side, one counts.
            let is_known = seen[..count].contains(&(object, is_outside));
            if !is_known && count < MOST_COINCIDENT && self.appearance.interior(object, material).is_some() {
                seen[count] = (object, is_outside);
                count += 1;
                give(hit.t, object, material, is_outside);
            }
            false
        });
    }

    /// Whether a ray hits any triangle that counts and stands still on the first length of its direction.
    pub(in crate::render) fn any_between(&self, ray: &Ray, counts: impl Fn(u32) -> bool) -> bool {
        self.still()
            .is_some_and(|still| still.octree.each_hit(ray, 0.0, 1.0, |hit| counts(still.triangle(hit.triangle))))
    }

    /// Gives the triangles that stand still and may be in a box, some of them more than once.
    pub(in crate::render) fn each_near(&self, bounds: Bounds, mut give: impl FnMut(u32)) {
        if let Some(still) = self.still() {
            still.octree.each_near(bounds, |triangle| give(still.triangle(triangle)));
        }
    }

    /// Whether nothing that counts may occlude lines from one box to another; false where that is not known.
    pub(in crate::render) fn is_clear(&self, [from, to]: [Bounds; 2], counts: impl Fn(u32) -> bool) -> bool {
        let is_clear =
            |still: &SceneOctree| still.octree.is_clear(from, to, |triangle| counts(still.triangle(triangle)));
        let lamps = self.appearance.sources.iter().filter(|(_, source)| source.is_surface());
        let mut lamps = lamps.filter_map(|(_, source)| match source.origin() {
            LightOrigin::Within(bounds) => Some(bounds),
            LightOrigin::Towards(_) | LightOrigin::Everywhere => None,
        });
        !self.moves()
            && !lamps.any(|lamp| Octree::may_stand_between(from, to, lamp))
            && self
                .acceleration
                .placed
                .as_ref()
                .is_none_or(|placed| !Octree::may_stand_between(from, to, placed.bounds()))
            && self.grounds().all(|ground| !Octree::may_stand_between(from, to, ground.bounds()))
            && self.still().is_none_or(is_clear)
    }

    /// The BSDF of a triangle.
    pub(super) fn bsdf_of(&self, triangle: u32) -> &Bsdf {
        let prepared = self.appearance.prepared;
        self.appearance.bsdf(prepared.object_of[triangle as usize], prepared.material_number(triangle))
    }
}

/// Which terrains rays meet exactly, by their numbers in the details: those that no light passes and that emit none, where
/// nothing is kept for triangles.
fn exact_grounds(details: Option<&Details>, appearance: &Appearance<'_>, plan: &Plan) -> Vec<usize> {
    let by_triangle = [Stage::Radiosity, Stage::PhotonMap, Stage::SurfacePoints];
    if by_triangle.into_iter().any(|stage| plan.needs(stage)) {
        return Vec::new();
    }
    let is_exact = |ground: &SceneGround| {
        let object = ground.object as usize;
        let bsdf = appearance.bsdf(ground.object, 0);
        let emits = appearance.prepared.objects[object].materials.iter().any(|material| !material.emission.is_black());
        plan.includes_object(object) && !bsdf.is_passable() && bsdf.interior.is_none() && !emits
    };
    let all = details.map_or(&[][..], Details::grounds);
    (0..all.len()).filter(|number| is_exact(&all[*number])).collect()
}

/// Refuses instances that are placed, for what goes through triangles one by one.
///
/// # Errors
/// [`RenderError::PlacedInstances`].
pub(in crate::render) fn check_copied(prepared: &Prepared) -> Result<(), RenderError> {
    match prepared.placed() {
        Some(object) => Err(RenderError::PlacedInstances { object: object.name.clone() }),
        None => Ok(()),
    }
}

/// The outer unit normal of a triangle; 0 for one without area.
pub(super) fn outer_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// How far a direction goes along the outer normal of a triangle; 0 for one without area.
fn slope(corners: [DVec3; 3], direction: DVec3) -> f64 {
    outer_normal(corners).dot(direction)
}

/// How much of each corner is in a hit.
pub(super) fn weights(hit: &Hit) -> [f64; 3] {
    [1.0 - hit.u - hit.v, hit.u, hit.v]
}

/// A ray, moved aside so that it goes through the point of a hit.
fn through(ray: &Ray, hit: &Hit, corners: [DVec3; 3]) -> Ray {
    let [a, b, c] = weights(hit);
    Ray { origin: corners[0] * a + corners[1] * b + corners[2] * c - ray.direction * hit.t, ..*ray }
}
