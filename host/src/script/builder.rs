//! The scene while a script builds it.

use super::definition::ScriptParameters;
use super::folders::Folders;
use super::handle::{CallResult, Handle};
use super::source::{CallOutcome, FunctionCall, OpenDatabases, ScriptSource};
use crate::procedural::Wind;
use crate::scene::{Composite, MAX_NESTING, MAX_OBJECTS, Motion, Object, Operation, Scene, ScriptPosition, Shape};
use glam::{DMat4, DVec3};
use rhai::Dynamic;
use std::collections::HashMap;
use std::sync::Arc;

/// Longest name of an object.
const MOST_LETTERS: usize = 200;

/// The scene so far.
pub(super) struct Builder {
    pub(super) scene: Scene,
    /// Objects by handle; none where one became part of another.
    objects: Vec<Option<Object>>,
    /// The calls that gave objects their shapes, by handle.
    positions: Vec<Option<ScriptPosition>>,
    /// How objects move, by handle.
    motions: Vec<Option<Motion>>,
    /// How many objects of each kind there have been.
    of_kind: HashMap<&'static str, u32>,
    /// When the shutter opens and closes, seconds from the time of the picture, if it was said.
    pub(super) shutter: Option<[f64; 2]>,
    /// The time of the picture, seconds.
    time: f64,
    /// The time that the script gets, seconds.
    pub(super) now: f64,
    /// Whether the script asked for the time.
    pub(super) asked_time: bool,
    /// The wind that blows.
    pub(super) wind: Option<Wind>,
    /// Below which it reads.
    pub(super) folders: Folders,
    /// Values of parameters.
    pub(super) definitions: ScriptParameters,
    /// Where names of reflectances, spectra, materials, lights and geometry are looked up.
    pub(super) databases: OpenDatabases,
    /// The script.
    pub(super) source: Arc<ScriptSource>,
    /// Steps that models took when the script made them.
    pub(super) model_operations: u64,
    /// Where the call stands that runs.
    pub(super) called_at: Option<ScriptPosition>,
    /// Where a call failed, if that is elsewhere than where it stands.
    pub(super) failed_at: Option<ScriptPosition>,
    /// What a function may ask for that makes a model; none where a script builds a scene.
    model: Option<ModelLimits>,
}

/// What the function of a model may ask for.
struct ModelLimits {
    may_ask_time: bool,
    /// How many databases there are.
    databases: usize,
}

impl Builder {
    /// An empty scene.
    ///
    /// - `now`: the time that the script gets, seconds.
    pub(super) fn new(source: Arc<ScriptSource>, now: f64) -> Builder {
        let inputs = &source.inputs;
        Builder {
            scene: Scene::default(),
            objects: Vec::new(),
            positions: Vec::new(),
            motions: Vec::new(),
            of_kind: HashMap::new(),
            shutter: inputs.shutter,
            time: inputs.time,
            now,
            asked_time: false,
            wind: None,
            folders: Folders::new(&source.folder, &inputs.allowed),
            definitions: ScriptParameters::new(&inputs.definitions),
            databases: OpenDatabases::default(),
            model_operations: 0,
            called_at: None,
            failed_at: None,
            model: None,
            source,
        }
    }

    /// Nothing yet of what a function makes that is called.
    pub(super) fn of_call(call: &FunctionCall<'_>) -> Builder {
        let FunctionCall { source, now, databases, may_ask_time, .. } = *call;
        let model = Some(ModelLimits { may_ask_time, databases: databases.files.len() });
        Builder { databases: databases.clone(), shutter: None, model, ..Builder::new(Arc::clone(source), now) }
    }

    /// Whether it holds what the function of a model makes, rather than a scene.
    pub(super) fn makes_model(&self) -> bool {
        self.model.is_some()
    }

    /// Refuses what a model cannot have, after a call.
    pub(super) fn check_model(&self) -> Result<(), String> {
        let Some(ModelLimits { may_ask_time, databases }) = self.model else { return Ok(()) };
        if self.asked_time && !may_ask_time {
            return Err("a model asks for the time in all of its kinds or in none; that of seed 0 did not".into());
        }
        let is_more = self.shutter.is_some() || self.wind.is_some() || self.databases.files.len() > databases;
        if is_more || self.scene != Scene::default() {
            return Err("a model makes objects only; the rest is said outside".into());
        }
        Ok(())
    }

    /// Takes the objects, each with the call that gave it its shape.
    pub(super) fn take_objects(&mut self) -> Vec<(Object, Option<ScriptPosition>)> {
        let positions = std::mem::take(&mut self.positions).into_iter().chain(std::iter::repeat(None));
        let objects = std::mem::take(&mut self.objects).into_iter().zip(positions);
        objects.filter_map(|(object, position)| Some((object?, position))).collect()
    }

    /// Notes what the function of a model asked for when it was first called: the script did.
    pub(super) fn note_call(&mut self, call: &CallOutcome) -> Result<(), String> {
        self.model_operations = self.model_operations.saturating_add(call.operations);
        self.asked_time |= call.asked_time;
        self.folders.note(&call.files);
        for asked in &call.parameters {
            let _value = self.definitions.value(&asked.name, asked.default.to_value(), &asked.meaning)?;
        }
        Ok(())
    }

    /// The time, for the script.
    pub(super) fn ask_time(&mut self) -> f64 {
        self.asked_time = true;
        self.now
    }

    /// The scene as it stands, and when its shutter opens and closes, seconds from the time of the picture.
    pub(super) fn finish(&self) -> (Scene, [f64; 2]) {
        // A script that moves things itself shows an instant, unless it says otherwise.
        let unsaid = if self.asked_time { [0.0; 2] } else { [0.0, 1.0] };
        let [open, close] = self.shutter.unwrap_or(unsaid);
        let middle = self.time + 0.5 * (open + close);
        let mut scene = self.scene.clone();
        scene.settings.geometry.shutter = close - open;
        for (object, motion) in self.objects.iter().zip(&self.motions) {
            let Some(mut object) = object.clone() else { continue };
            if let Some(motion) = motion {
                object.transform = motion.at(middle).matrix() * object.transform;
                scene.motions.push((scene.objects.len() as u32, motion.since(middle)));
            }
            scene.objects.push(object);
        }
        for (object, position) in self.objects.iter().zip(&self.positions) {
            if let (Some(object), Some(position)) = (object, position) {
                scene.origins.of.insert(object.name.clone(), *position);
            }
        }
        (scene, [open, close])
    }

    /// Notes that a call gave an object its shape.
    pub(super) fn note(&mut self, handle: Handle, position: ScriptPosition) {
        if self.positions.len() < self.objects.len() {
            self.positions.resize(self.objects.len(), None);
        }
        if let Some(noted) = self.positions.get_mut(handle.0) {
            *noted = Some(position);
        }
    }

    /// Whether a call is known that gave an object its shape.
    pub(super) fn is_noted(&self, handle: Handle) -> bool {
        self.positions.get(handle.0).is_some_and(Option::is_some)
    }

    /// Lets an object move.
    pub(super) fn let_move(&mut self, handle: Handle, motion: Motion) -> CallResult {
        self.object(handle)?;
        if self.makes_model() {
            return Err("what a model makes stands still; let the model move".into());
        }
        if let Some(slot) = self.motions.get_mut(handle.0) {
            *slot = Some(motion);
        }
        Ok(Dynamic::from(handle))
    }

    /// Refuses an object that moves where only what is still can be used.
    pub(super) fn check_still(&mut self, handle: Handle) -> Result<(), String> {
        let moves = self.motions.get(handle.0).is_some_and(Option::is_some);
        let name = self.object(handle)?.name.clone();
        if moves { Err(format!("{name} moves; let the whole move that it becomes part of")) } else { Ok(()) }
    }

    /// Adds an object of default material, named after its kind and number.
    pub(super) fn add(&mut self, shape: Shape, tolerance: Option<f64>) -> Result<Handle, String> {
        self.add_called(shape.word(), shape, tolerance)
    }

    /// Adds an object of default material, named after a word and the number of such objects.
    pub(super) fn add_called(
        &mut self,
        word: &'static str,
        shape: Shape,
        tolerance: Option<f64>,
    ) -> Result<Handle, String> {
        let index = self.objects.len();
        if index >= MAX_OBJECTS {
            return Err(format!("more than {MAX_OBJECTS} objects"));
        }
        let number = self.of_kind.entry(word).or_default();
        *number += 1;
        let name = match number {
            1 => word.to_owned(),
            number => format!("{word} {number}"),
        };
        self.objects.push(Some(Object { name, shape, transform: DMat4::IDENTITY, material: None, tolerance }));
        self.motions.push(None);
        Ok(Handle(index))
    }

    /// The object behind a handle.
    pub(super) fn object(&mut self, handle: Handle) -> Result<&mut Object, String> {
        let object = self.objects.get_mut(handle.0).ok_or("there is no such object")?;
        object.as_mut().ok_or_else(|| "the object became part of another; copy() it before".into())
    }

    /// Names an object.
    pub(super) fn name(&mut self, handle: Handle, name: &str) -> CallResult {
        let object = self.object(handle)?;
        if name.chars().count() > MOST_LETTERS {
            return Err(format!("a name has at most {MOST_LETTERS} characters"));
        }
        if name.chars().any(char::is_control) {
            return Err("a name has no control characters".into());
        }
        object.name = name.to_owned();
        Ok(Dynamic::from(handle))
    }

    /// Adds a copy of an object.
    pub(super) fn copy(&mut self, handle: Handle) -> Result<Handle, String> {
        let Object { shape, transform, material, tolerance, .. } = self.object(handle)?.clone();
        let motion = self.motions.get(handle.0).copied().flatten();
        let copy = self.add(shape, tolerance)?;
        self.motions[copy.0] = motion;
        let object = self.object(copy)?;
        (object.transform, object.material) = (transform, material);
        Ok(copy)
    }

    /// Makes one solid of two objects, which are no objects of their own any more.
    pub(super) fn combine(&mut self, operation: Operation, one: Handle, two: Handle) -> CallResult {
        if one == two {
            return Err("an object cannot be combined with itself; copy() it before".into());
        }
        self.check_still(one).and(self.check_still(two))?;
        let first = self.object(one)?.clone();
        let second = self.object(two)?.clone();
        check_bounding(&first).and(check_bounding(&second))?;
        let material = first.material.clone();
        let composite = match first {
            // A chain of the same operation is one.
            Object { shape: Shape::Composite(mut chain), transform, .. }
                if chain.operation == operation && transform == DMat4::IDENTITY =>
            {
                chain.nesting = chain.nesting.max(nesting_of(&second) + 1);
                chain.operands.push(second);
                chain
            }
            first => {
                let nesting = nesting_of(&first).max(nesting_of(&second)) + 1;
                Box::new(Composite { operation, operands: vec![first, second], nesting })
            }
        };
        check_nesting(composite.nesting)?;
        [one, two].into_iter().for_each(|handle| self.use_up(handle));
        let whole = self.add(Shape::Composite(composite), None)?;
        self.object(whole)?.material = material;
        Ok(Dynamic::from(whole))
    }

    /// Notes that an object became part of another.
    pub(super) fn use_up(&mut self, handle: Handle) {
        if let Some(object) = self.objects.get_mut(handle.0) {
            *object = None;
        }
    }

    /// Divides a solid by the plane through `at`: what is behind stays, what is in front, where `normal` points, becomes
    /// another object.
    pub(super) fn split(&mut self, handle: Handle, normal: DVec3, at: DVec3) -> CallResult {
        self.check_still(handle)?;
        let whole = self.object(handle)?.clone();
        check_bounding(&whole)?;
        let half = Object {
            name: "plane".into(),
            shape: Shape::HalfSpace { normal, at },
            transform: DMat4::IDENTITY,
            material: None,
            tolerance: None,
        };
        let nesting = nesting_of(&whole) + 1;
        check_nesting(nesting)?;
        let part = |operation: Operation| {
            Shape::Composite(Box::new(Composite { operation, operands: vec![whole.clone(), half.clone()], nesting }))
        };
        let front = self.add(part(Operation::Difference), None)?;
        let behind = part(Operation::Intersection);
        *self.object(handle)? = Object {
            name: whole.name.clone(),
            shape: behind,
            transform: DMat4::IDENTITY,
            material: None,
            tolerance: None,
        };
        Ok(Dynamic::from(front))
    }

    /// Moves an object by a further transformation, after those before.
    pub(super) fn transform(&mut self, handle: Handle, by: DMat4) -> CallResult {
        let object = self.object(handle)?;
        let placed = by * object.transform;
        if !placed.is_finite() {
            return Err(format!("{} would be moved out of all bounds", object.name));
        }
        object.transform = placed;
        Ok(Dynamic::from(handle))
    }
}

/// How deep objects are nested in an object.
pub(super) fn nesting_of(object: &Object) -> u32 {
    match &object.shape {
        Shape::Composite(composite) => composite.nesting,
        Shape::Rounded(rounded) => nesting_of(&rounded.object) + 1,
        Shape::Curve(objects) => objects.iter().map(nesting_of).max().unwrap_or(0) + 1,
        _ => 0,
    }
}

/// Refuses lines, which bound nothing, and instances, which are many.
pub(super) fn check_bounding(object: &Object) -> Result<(), String> {
    match object.shape {
        Shape::Curve(_) => Err(format!("{} is a curve and bounds nothing", object.name)),
        Shape::Instances(_) => {
            Err(format!("{} is made of instances; combine solids before they are placed", object.name))
        }
        _ => Ok(()),
    }
}

pub(super) fn check_nesting(nesting: u32) -> Result<(), String> {
    if nesting > MAX_NESTING { Err(format!("solids are nested more than {MAX_NESTING} deep")) } else { Ok(()) }
}
