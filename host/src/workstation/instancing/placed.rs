//! Objects that place others, with all that these are told by what they are part of.

use super::super::{WorkstationError, names::ROOT};
use super::outline::extremes;
use crate::illumination::Material;
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::mix;
use crate::scene::{GeometrySettings, Instances, Object, Places, Shape, ShapeError, largest_stretch};
use crate::surface::Tolerance;
use glam::{DAffine3, DVec3};
use std::borrow::Cow;

/// Instances that stand for all where only size and form count.
const SAMPLE: usize = 256;
/// Triangles that tell the form of an object lie within this part of its diagonal.
const FORM_TOLERANCE: f64 = 1.0 / 20.0;

/// An object of instances.
pub(super) struct PlacedObject<'a> {
    /// From its coordinates to those of what it is part of.
    pub(super) transform: DAffine3,
    /// Where its instances are.
    pub(super) places: Places<'a>,
    /// What they place.
    pub(super) prototypes: Vec<PlacedGroup<'a>>,
}

/// A group of objects that is placed many times.
pub(super) struct PlacedGroup<'a> {
    /// Of its display structure.
    pub(super) name: String,
    /// Its objects that are no instances.
    pub(super) objects: Vec<Cow<'a, Object>>,
    /// Its objects that place others.
    pub(super) nested: Vec<PlacedObject<'a>>,
    /// Points that tell its form.
    pub(super) form: Vec<DVec3>,
    /// The material of its largest part.
    pub(super) material: Material,
    center: DVec3,
    radius: f64,
}

/// What holds for all that an object places.
struct Whole<'s> {
    geometry: &'s GeometrySettings,
    material: Option<Material>,
    /// How much longer what it places becomes at the most.
    stretch: f64,
}

impl<'a> PlacedObject<'a> {
    /// An object of the scene, if it has instances.
    ///
    /// - `next`: the number of the next prototype; it is counted on.
    ///
    /// # Errors
    /// [`WorkstationError::Scene`], if something cannot be tessellated.
    pub(super) fn of(
        object: &'a Object,
        geometry: &GeometrySettings,
        next: &mut usize,
    ) -> Result<Option<PlacedObject<'a>>, WorkstationError> {
        let Shape::Instances(instances) = &object.shape else { return Ok(None) };
        let whole = Whole { geometry, material: None, stretch: 1.0 }.within(object);
        PlacedObject::new(object, instances, &whole, next).map(Some)
    }

    fn new(
        object: &'a Object,
        instances: &'a Instances,
        whole: &Whole<'_>,
        next: &mut usize,
    ) -> Result<PlacedObject<'a>, WorkstationError> {
        let tolerance = whole.geometry.tolerance.map(|tolerance| tolerance / whole.stretch);
        let places = instances.places(tolerance, whole.geometry.angle).map_err(|error| failed(object, &error))?;
        let stretch = whole.stretch * instances.largest_stretch();
        let within = Whole { geometry: whole.geometry, material: whole.material.clone(), stretch };
        let groups = instances.prototypes.iter();
        let prototypes = groups.map(|group| PlacedGroup::new(group, &within, next)).collect::<Result<_, _>>()?;
        Ok(PlacedObject { transform: DAffine3::from_mat4(object.transform), places, prototypes })
    }

    /// Some instances, spread over all by their numbers; the same whenever it is asked for as many.
    ///
    /// - `most`: how many at the most.
    pub(super) fn sample(&self, most: usize) -> impl Iterator<Item = usize> + '_ {
        let (count, taken) = (self.places.count(), self.places.count().min(most));
        // One of each of as many runs of numbers, by chance.
        let numbers = (0..taken).map(move |k| {
            let [first, end] = [k, k + 1].map(|k| (k as u128 * count as u128 / taken as u128) as usize);
            first + (mix(k as u64) % (end - first).max(1) as u64) as usize
        });
        numbers.filter(|number| self.places.has(*number))
    }

    /// What an instance places, and from its coordinates to those of what this object is part of.
    pub(super) fn instance(&self, number: usize) -> (&PlacedGroup<'a>, DAffine3) {
        let instance = self.places.instance(number);
        (&self.prototypes[usize::from(instance.prototype)], self.transform * instance.placement)
    }
}

impl<'a> PlacedGroup<'a> {
    fn new(group: &'a [Object], whole: &Whole<'_>, next: &mut usize) -> Result<PlacedGroup<'a>, WorkstationError> {
        let name = format!("{ROOT}_I{next}");
        *next += 1;
        let (mut objects, mut nested) = (Vec::new(), Vec::new());
        let (mut form, mut largest, mut material) = (Vec::new(), 0.0, Material::default());
        for object in group {
            let (points, made_of) = match &object.shape {
                Shape::Instances(instances) => {
                    let placed = PlacedObject::new(object, instances, &whole.within(object), next)?;
                    let points: Vec<DVec3> = placed.sample(SAMPLE).flat_map(|number| placed.form(number)).collect();
                    let made_of = placed.prototypes.first().map(|first| first.material.clone()).unwrap_or_default();
                    nested.push(placed);
                    (points, made_of)
                }
                _ => {
                    let object = object.within(&whole.material);
                    let points = form_of(&object).map_err(|error| failed(&object, &error))?;
                    let made_of = object.materials(&[]).0.into_iter().next().unwrap_or_default();
                    objects.push(object);
                    (points, made_of)
                }
            };
            let size = Bounds::of(points.iter().copied()).diagonal();
            if size > largest {
                (largest, material) = (size, made_of);
            }
            form.extend(extremes(&points));
        }
        let form = extremes(&form);
        let center = Bounds::of(form.iter().copied()).center();
        let radius = form.iter().map(|point| point.distance(center)).fold(0.0, f64::max);
        Ok(PlacedGroup { name, objects, nested, form, material, center, radius })
    }

    /// A ball around it.
    pub(super) fn ball(&self) -> (DVec3, f64) {
        (self.center, self.radius)
    }

    /// A ball around it where it is placed.
    pub(super) fn ball_at(&self, placement: &DAffine3) -> (DVec3, f64) {
        let stretch = largest_stretch(&glam::DMat4::from(*placement));
        (placement.transform_point3(self.center), self.radius * stretch)
    }
}

impl PlacedObject<'_> {
    /// Points that tell the form of an instance.
    fn form(&self, number: usize) -> Vec<DVec3> {
        let (prototype, placement) = self.instance(number);
        prototype.form.iter().map(|point| placement.transform_point3(*point)).collect()
    }
}

impl<'s> Whole<'s> {
    /// This, for what an object places.
    fn within(&self, object: &Object) -> Whole<'s> {
        let material = object.material.clone().or_else(|| self.material.clone());
        Whole { geometry: self.geometry, material, stretch: self.stretch * largest_stretch(&object.transform) }
    }
}

/// The corners of few triangles of an object, where it is placed.
fn form_of(object: &Object) -> Result<Vec<DVec3>, ShapeError> {
    let within = |part: f64, angle: f64| {
        let chord = object.shape.extent().map_or(f64::MAX, |extent| extent * part);
        object.shape.tessellate(Tolerance::new(chord, angle))
    };
    // Not everything can be made coarsely.
    let mesh = within(FORM_TOLERANCE, 180.0).or_else(|_| within(FORM_TOLERANCE / 20.0, 45.0))?.mesh;
    Ok(mesh.vertices.iter().map(|point| object.transform.transform_point3(*point)).collect())
}

fn failed(object: &Object, error: &ShapeError) -> WorkstationError {
    WorkstationError::Scene(format!("{}: {error}", object.name))
}
