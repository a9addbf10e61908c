//! What rays meet: triangles of materials, surfaces that emit, and the sky.

use super::draws::Draws;
use super::eye::Sight;
use super::surface::Element;
use super::tracer::counted;
use crate::color::{Channels, Curve, Wavelengths};
use crate::illumination::distribution::Frame;
use crate::illumination::light::{Glow, Source};
use crate::illumination::optics::{Library, Optics, Painting, Sighting};
use crate::numeric::ray::{Hit, Ray};
use crate::octree::{Octree, OctreeError, Settings as OctreeSettings};
use crate::plan::{Plan, Stage};
use crate::render::RenderError;
use crate::scene::{Prepared, footprint};
use glam::DVec3;

/// A scene as rays meet it.
pub(super) struct World<'a> {
    pub(super) prepared: &'a Prepared,
    pub(super) wavelengths: Wavelengths,
    /// None if the plan needs no octree.
    pub(super) octree: Option<Octree>,
    /// The triangle of the scene behind each triangle of the octree; empty if they are the same.
    triangle_of: Vec<u32>,
    /// All materials, each once.
    optics: Vec<Optics>,
    /// For each object, which of them its materials are.
    optics_of: Vec<Vec<u32>>,
    /// All lights, objects that emit among them, with their numbers: those of the scene come first.
    pub(super) sources: Vec<(usize, Source)>,
    /// For each object and material of it that emits, which of the lights it is.
    emitters: Vec<((u32, u32), usize)>,
    /// Radiance where there is nothing.
    background: Curve,
    /// Ambient radiance.
    pub(super) ambient: Option<Curve>,
    curved: bool,
    /// Whether something lets light straight through.
    passing: bool,
}

/// What a ray meets first.
#[expect(clippy::large_enum_variant, reason = "it is looked at once, at once; putting it aside takes longer")]
pub(super) enum Met<'a> {
    /// An element of an object.
    Element(Found<'a>),
    /// A surface that emits, and which of the lights it is.
    Glow(usize, Glow),
    /// Nothing.
    Nothing,
}

/// An element that a ray met, with the frame in which its optics has directions.
pub(super) struct Encounter<'a> {
    pub(super) found: &'a Found<'a>,
    pub(super) frame: Frame,
    pub(super) sighting: Sighting<'a>,
    /// The choices of the sample.
    pub(super) draws: Draws,
    /// The number of the leg that met it.
    pub(super) leg: u32,
    /// Whether mirrored directions are followed beside a drawn one, so that none of them is drawn.
    pub(super) parts: bool,
}

/// An element of an object.
pub(super) struct Found<'a> {
    pub(super) element: Element,
    pub(super) optics: &'a Optics,
    pub(super) triangle: u32,
    pub(super) object: u32,
    /// Which of the object's materials.
    pub(super) material: u32,
    /// From where the ray began.
    pub(super) distance: f64,
    /// What the patterns of the material give; none for a material that has none.
    painting: Option<Box<Painting>>,
}

impl Found<'_> {
    /// What the patterns of the material give.
    pub(super) fn painted(&self) -> &[Channels] {
        self.painting.as_ref().map_or(&[], |painting| painting.as_slice())
    }
}

impl<'a> World<'a> {
    /// Builds the octree over the objects that the plan keeps, and makes materials and lights ready.
    ///
    /// # Errors
    /// [`RenderError`].
    pub(super) fn new(prepared: &'a Prepared, plan: &Plan) -> Result<World<'a>, RenderError> {
        let wavelengths = if plan.needs(Stage::Spectra) { Wavelengths::spectral() } else { Wavelengths::bands() };
        let (octree, triangle_of) = octree(prepared, plan)?;
        let mut world = World {
            prepared,
            octree,
            triangle_of,
            optics: Vec::new(),
            optics_of: Vec::new(),
            sources: Vec::new(),
            emitters: Vec::new(),
            background: wavelengths.light(&prepared.background.into()),
            ambient: plan.needs(Stage::Ambient).then(|| wavelengths.light(&prepared.ambient.into())),
            curved: plan.needs(Stage::Normals),
            passing: false,
            wavelengths,
        };
        world.add_materials(plan)?;
        for (number, light) in prepared.lights.iter().enumerate().filter(|(number, _)| plan.keeps_light(*number)) {
            world.sources.push((number, Source::new(light, &world.wavelengths)));
        }
        world.add_emitters(plan);
        world.passing = world.optics.iter().any(Optics::is_passable);
        Ok(world)
    }

    fn add_materials(&mut self, plan: &Plan) -> Result<(), RenderError> {
        let wavelengths = self.wavelengths.clone();
        let mut library = Library::new(&wavelengths, plan.forced);
        let mut known = Vec::new();
        for object in &self.prepared.objects {
            let mut numbers = Vec::with_capacity(object.materials.len());
            for material in &object.materials {
                let found = known.iter().position(|other| *other == material);
                let number = match found {
                    Some(number) => number,
                    None => {
                        let failed = |source| RenderError::Material { object: object.name.clone(), source };
                        let spreads = self.prepared.settings.interreflection;
                        self.optics.push(library.optics(material, spreads).map_err(failed)?);
                        known.push(material);
                        known.len() - 1
                    }
                };
                numbers.push(number as u32);
            }
            self.optics_of.push(numbers);
        }
        Ok(())
    }

    /// Objects that emit are lights, too.
    fn add_emitters(&mut self, plan: &Plan) {
        let prepared = self.prepared;
        for (index, object) in prepared.objects.iter().enumerate().filter(|(index, _)| plan.keeps_object(*index)) {
            for (number, optics) in self.optics_of[index].iter().enumerate() {
                let Some(emission) = &self.optics[*optics as usize].emission else { continue };
                let of = |triangle: &u32| prepared.material_number(*triangle) == number as u32;
                let triangles = (object.first..object.first + object.count).filter(of);
                let corners = triangles.map(|triangle| prepared.corners(triangle)).collect();
                if let Some(source) = Source::of_triangles(corners, emission.clone()) {
                    self.emitters.push(((index as u32, number as u32), self.sources.len()));
                    self.sources.push((prepared.lights.len() + self.emitters.len() - 1, source));
                }
            }
        }
    }

    /// What is first in sight.
    pub(super) fn meet(&self, sight: &Sight, comb: usize) -> Met<'_> {
        let hit = self.octree.as_ref().and_then(|octree| octree.closest(&sight.ray, sight.t_min, sight.t_max));
        let t_max = hit.map_or(sight.t_max, |hit| hit.t);
        if let Some((index, glow)) = self.glow(&sight.ray, sight.t_min, t_max, comb) {
            return Met::Glow(index, glow);
        }
        let Some(hit) = hit else { return Met::Nothing };
        let triangle = self.triangle_of.get(hit.triangle as usize).copied().unwrap_or(hit.triangle);
        let Some(mut element) = Element::new(self.prepared, triangle, &sight.ray, &hit, self.curved) else {
            return Met::Nothing;
        };
        let object = self.prepared.object_of[triangle as usize];
        let material = self.prepared.material_number(triangle);
        let optics = self.optics(object, material);
        let length = sight.ray.direction.length();
        let distance = hit.t * length;
        let painting = optics.is_textured().then(|| {
            let towards = sight.ray.direction / length;
            let sides = footprint(element.face, towards, sight.cone.at(distance));
            let place = self.prepared.place(triangle, weights(&hit), sides);
            element.tilt(-towards, |normal| optics.tilted(&place, normal));
            Box::new(optics.paint(&place, comb))
        });
        Met::Element(Found { element, optics, triangle, object, material, distance, painting })
    }

    /// The nearest surface that emits and is no object.
    fn glow(&self, ray: &Ray, t_min: f64, t_max: f64, comb: usize) -> Option<(usize, Glow)> {
        let mut nearest: Option<(usize, Glow)> = None;
        for (index, (_, source)) in self.sources.iter().enumerate().filter(|(_, (_, source))| source.is_surface()) {
            let limit = nearest.map_or(t_max, |(_, glow)| glow.t);
            nearest = source.glow(ray, t_min, limit, comb).map(|glow| (index, glow)).or(nearest);
        }
        nearest
    }

    /// The light that an element emits, and the density with which its light would have drawn it.
    pub(super) fn emitted(&self, found: &Found<'_>, towards: DVec3, comb: usize) -> Option<(Channels, f64)> {
        let emission = found.optics.emission.as_ref()?.of(comb);
        let key = (found.object, found.material);
        let index = self.emitters.iter().find(|(emitter, _)| *emitter == key).map(|(_, index)| *index);
        let cosine = towards.dot(found.element.face);
        Some((emission, index.map_or(0.0, |index| self.sources[index].1.density_on_triangle(found.distance, cosine))))
    }

    /// The material of a number of an object.
    pub(super) fn optics(&self, object: u32, material: u32) -> &Optics {
        &self.optics[self.optics_of[object as usize][material as usize] as usize]
    }

    /// Radiance where there is nothing: of the skies, or the background without any.
    ///
    /// - `leg`: the density with which the direction was drawn, if it was. `normal`: of the element from which it goes on.
    pub(super) fn beyond(&self, direction: DVec3, leg: Option<f64>, normal: Option<DVec3>, comb: usize) -> Channels {
        let skies = self.sources.iter().filter_map(|(_, source)| source.sky(direction, normal, comb));
        let sum = skies.map(|glow| glow.radiance * counted(leg, glow.density)).reduce(|a, b| a + b);
        sum.unwrap_or_else(|| self.background.of(comb))
    }

    /// The part of light that comes along a way: nothing, if something opaque is in between.
    ///
    /// - `index`: of the light that the way leads to, which is not in the way of itself.
    pub(super) fn passed(&self, ray: &Ray, t_max: f64, index: usize, comb: usize) -> Channels {
        let blocks = |(other, (_, source)): (usize, &(usize, Source))| {
            other != index && source.is_surface() && source.glow(ray, 0.0, t_max, comb).is_some()
        };
        if self.sources.iter().enumerate().any(blocks) {
            return Channels::ZERO;
        }
        let Some(octree) = &self.octree else { return Channels::ONE };
        if !self.passing {
            return if octree.occluded(ray, 0.0, t_max) { Channels::ZERO } else { Channels::ONE };
        }
        let mut part = Channels::ONE;
        let mut from = 0.0;
        while let Some(hit) = octree.closest(ray, from, t_max) {
            let triangle = self.triangle_of.get(hit.triangle as usize).copied().unwrap_or(hit.triangle);
            let object = self.prepared.object_of[triangle as usize];
            let optics = self.optics(object, self.prepared.material_number(triangle));
            let place = || self.prepared.place(triangle, weights(&hit), Default::default());
            part *= optics.passing(comb, place);
            if part.max() == 0.0 {
                return Channels::ZERO;
            }
            from = hit.t;
        }
        part
    }
}

/// How much of each corner is in a hit.
fn weights(hit: &Hit) -> [f64; 3] {
    [1.0 - hit.u - hit.v, hit.u, hit.v]
}

/// The octree over the objects that a plan keeps, and which triangles of the scene it holds, if not all.
fn octree(prepared: &Prepared, plan: &Plan) -> Result<(Option<Octree>, Vec<u32>), OctreeError> {
    let keeps = |triangle: &u32| plan.keeps_object(prepared.object_of[*triangle as usize] as usize);
    let all = (0..prepared.objects.len()).all(|index| plan.keeps_object(index));
    let settings = OctreeSettings::default();
    if !plan.needs(Stage::Octree) || prepared.triangles.is_empty() {
        Ok((None, Vec::new()))
    } else if all {
        Ok((Some(Octree::build(&prepared.vertices, &prepared.triangles, &settings)?), Vec::new()))
    } else {
        let kept: Vec<u32> = (0..prepared.triangles.len() as u32).filter(keeps).collect();
        let triangles: Vec<[u32; 3]> = kept.iter().map(|&t| prepared.triangles[t as usize]).collect();
        Ok((Some(Octree::build(&prepared.vertices, &triangles, &settings)?), kept))
    }
}
