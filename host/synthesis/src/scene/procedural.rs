//! Procedural models: objects that are made when they are first looked at, as finely as they are seen.

use super::instances::together;
use super::made_mesh::MadeMesh;
use super::object::{Object, Procedural, ProceduralModel, Shape};
use super::shape_mesh::ShapeMesh;
use super::{GeometrySettings, ShapeError};
use crate::illumination::Material;
use crate::numeric::bounds::Bounds;
use crate::surface::Tolerance;
use glam::DMat4;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;
use std::sync::Arc;

/// Most kinds of a model: as many as instances can tell apart.
pub const MOST_KINDS: u32 = 1 << 16;
/// A model is made no finer than this part of the diagonal of its box.
const FINEST: f64 = 1.0 / 4096.0;
/// Where no view tells how finely a model is seen, what is smaller than this part of the diagonal of its box is left out.
const UNSEEN: f64 = 1.0 / 512.0;
/// How far triangles may be from the surface for which they stand, as a part of what a pixel spans: a change of the level of
/// detail moves nothing by more than half a pixel.
const CHORD: f64 = 0.25;
/// The most that the normal of a surface turns along a triangle of what is made, degrees.
const COARSE_ANGLE: f64 = 60.0;
/// A pattern is made of triangles no finer than this part of the diagonal of its box.
const PATTERN_CHORD: f64 = 1.0 / 64.0;

impl Procedural {
    /// Checks a model, and makes the first of its kinds as finely as where no view tells how: its materials are those of all.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn new(model: Arc<dyn ProceduralModel>) -> Result<Procedural, String> {
        let (Bounds { min, max }, kinds) = (model.bounds(), model.kinds());
        let has_size = min.is_finite() && max.is_finite() && min.cmple(max).all() && min != max;
        if !has_size {
            return Err(format!("its box from {min} to {max} has no size"));
        }
        if !(1..=MOST_KINDS).contains(&kinds) {
            return Err(format!("{kinds} kinds are not between 1 and {MOST_KINDS}"));
        }
        let made = Procedural { model, pattern: Arc::default() };
        let mut pattern = made.objects(0, made.detail_within(None))?;
        if pattern.is_empty() {
            return Err("it makes nothing".into());
        }
        let known: Vec<Material> = pattern.iter().flat_map(Object::operand_materials).collect();
        for material in made.model.materials().into_iter().filter(|material| !known.contains(material)) {
            // What has a material that the first kind lacks has no triangles there.
            let shape = Shape::Made(MadeMesh(Arc::default()));
            let object =
                Object { name: "triangles".into(), shape, transform: DMat4::IDENTITY, material: None, tolerance: None };
            pattern.push(Object { material: Some(material), ..object });
        }
        Ok(Procedural { pattern: Arc::new(pattern), ..made })
    }

    /// The box that holds all that it makes.
    pub fn bounds(&self) -> Bounds {
        self.model.bounds()
    }

    /// The seed of the instance that has a variation.
    pub fn seed(&self, variation: u16) -> u32 {
        u32::from(variation) % self.model.kinds()
    }

    /// All that decides what it makes, as text.
    pub fn definition(&self) -> String {
        self.model.definition()
    }

    /// The level of detail for what a pixel spans, two to an octave; the detail of a level is no more than that.
    pub(super) fn level(&self, footprint: f64) -> i32 {
        // Written so that what is not a number is as fine as can be.
        let span = footprint.max(self.finest()).min(self.bounds().diagonal());
        (2.0 * span.log2()).floor() as i32
    }

    /// What a pixel spans at a level of detail.
    pub(super) fn detail_of(&self, level: i32) -> f64 {
        (0.5 * f64::from(level)).exp2()
    }

    /// The smallest detail that it is asked for.
    fn finest(&self) -> f64 {
        self.bounds().diagonal() * FINEST
    }

    /// The detail where no view tells it.
    ///
    /// - `chord`: how far triangles may be from the surface for which they stand, if that is told; its own units.
    pub(super) fn detail_within(&self, chord: Option<f64>) -> f64 {
        let diagonal = self.bounds().diagonal();
        chord.map_or(diagonal * UNSEEN, |chord| (chord / CHORD).clamp(self.finest(), diagonal))
    }

    /// Makes one of its kinds, and checks what it is.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn objects(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String> {
        let objects = self.model.make(seed, detail)?;
        for object in &objects {
            object.check(false).map_err(|error| error.to_string())?;
            check_made(object)?;
        }
        Ok(objects)
    }

    /// The materials of all that it makes, where those have none of the whole that they are part of.
    fn materials(&self) -> Vec<Material> {
        self.pattern.iter().flat_map(Object::operand_materials).collect()
    }

    /// The triangles of one of its kinds, as one mesh; its operands are its materials.
    ///
    /// # Errors
    /// [`ShapeError`], if it cannot be made.
    pub(super) fn tessellate(&self, seed: u32, detail: f64) -> Result<ShapeMesh, ShapeError> {
        let objects = self.objects(seed, detail).map_err(ShapeError::Model)?;
        let Tolerance { chord, angle } = tolerance_of(detail);
        let mut made = together(&objects, Some(chord), angle, 0)?;
        let materials: Vec<Material> = objects.iter().flat_map(Object::operand_materials).collect();
        let places = places_among(&self.materials(), &materials).map_err(ShapeError::Model)?;
        made.operand_of.iter_mut().for_each(|operand| *operand = places[*operand as usize]);
        made.mesh.surfaces.clone_from(&made.operand_of);
        Ok(made)
    }

    /// Triangles of everything that the first of its kinds is made of, each once and coarse, for what they tell of all: that
    /// they are curved, and what their materials need.
    ///
    /// # Errors
    /// [`ShapeError`], if they cannot be made.
    pub(super) fn pattern_mesh(&self) -> Result<ShapeMesh, ShapeError> {
        fn each(object: &Object, all: &mut Vec<Object>) {
            match &object.shape {
                Shape::Instances(instances) => instances.prototypes.iter().flatten().for_each(|part| each(part, all)),
                _ => all.push(object.clone()),
            }
        }
        let mut all = Vec::new();
        self.pattern.iter().for_each(|object| each(object, &mut all));
        together(&all, Some(self.bounds().diagonal() * PATTERN_CHORD), COARSE_ANGLE, 0)
    }
}

impl Object {
    /// A procedural model, where it is made.
    pub fn procedural(name: String, model: Procedural) -> Object {
        let shape = Shape::Procedural(model);
        Object { name, shape, transform: DMat4::IDENTITY, material: None, tolerance: None }
    }
}

/// For each material of what a model made, the place of the one that is equal among those of its first kind.
///
/// # Errors
/// What is wrong, in words, for a material that is not there.
pub(super) fn places_among(known: &[Material], made: &[Material]) -> Result<Vec<u32>, String> {
    let place = |material: &Material| known.iter().position(|other| other == material).map(|place| place as u32);
    made.iter()
        .map(place)
        .collect::<Option<Vec<u32>>>()
        .ok_or_else(|| "it has a material that the model of seed 0 has not; varied() tells colours that differ".into())
}

/// How closely triangles follow surfaces of what is made with a detail.
pub(super) fn tolerance_of(detail: f64) -> Tolerance {
    Tolerance::new(CHORD * detail, COARSE_ANGLE)
}

/// The geometry of what is made with a detail.
pub(super) fn geometry_of(detail: f64) -> GeometrySettings {
    let Tolerance { chord, angle } = tolerance_of(detail);
    // No more than a pixel is seen of what exact surfaces would add.
    let own = GeometrySettings { tolerance: Some(chord), angle, ..GeometrySettings::DEFAULT };
    GeometrySettings { exact_surfaces: false, shutter: 0.0, ..own }
}

/// Refuses what a model may not be made of.
fn check_made(object: &Object) -> Result<(), String> {
    match &object.shape {
        Shape::Curve(_) => Err(format!("{} is a curve; a model is made of surfaces", object.name)),
        Shape::HalfSpace { .. } => Err(format!("{} has no end", object.name)),
        Shape::Procedural(_) => Err(format!("{} is a procedural model; a model cannot be made of models", object.name)),
        Shape::Instances(instances) if instances.aggregate(None).is_some() => {
            Err(format!("{} has aggregates; what a model makes cannot", object.name))
        }
        Shape::Instances(instances) => instances.prototypes.iter().flatten().try_for_each(check_made),
        _ if object.emits() => Err(format!("{} emits light; what a model makes cannot", object.name)),
        _ => Ok(()),
    }
}

impl fmt::Debug for Procedural {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let definition = self.definition();
        write!(f, "procedural model, {} bytes, {:08x}", definition.len(), crc32fast::hash(definition.as_bytes()))
    }
}

impl PartialEq for Procedural {
    fn eq(&self, other: &Procedural) -> bool {
        Arc::ptr_eq(&self.model, &other.model) || self.definition() == other.definition()
    }
}

impl Serialize for Procedural {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.definition().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Procedural {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Procedural, D::Error> {
        Err(de::Error::custom("a procedural model cannot be read back: its script makes it"))
    }
}
