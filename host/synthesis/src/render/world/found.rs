//! What a ray found: a triangle of the scene, or of what was made on demand, and how it was brought to where it is.

use super::carrier::Carrier;
use super::ground_point::GroundPoint;
use crate::numeric::ray::Hit;
use crate::octree::{
    AggregateView, InstanceHit, InstanceOctree, InstancePath, InstanceWalk, PlacedSurface, PrototypeMaker, RayInterval,
};
use crate::scene::{Contents, Details, Displacement, GroundHit, MadeDetail, Prepared, SceneGround};
use std::cell::RefCell;
use std::sync::Arc;

/// A triangle that a ray found.
#[derive(Clone)]
pub(in crate::render) struct FoundTriangle {
    pub(super) hit: Hit,
    /// Its number in the scene, or in what was made.
    pub(super) triangle: u32,
    /// How it was brought to where it is, if it is not kept there.
    pub(super) carrier: Option<Carrier>,
    /// What was made on demand and has it, if the scene does not.
    made: Option<Arc<MadeDetail>>,
    /// Where the ground is for which it stands, the first of its terrain.
    pub(super) ground: Option<GroundPoint>,
}

impl FoundTriangle {
    /// One of the scene.
    pub(super) fn of_scene(hit: Hit, triangle: u32, carrier: Option<Carrier>) -> FoundTriangle {
        FoundTriangle { hit, triangle, carrier, made: None, ground: None }
    }

    /// One that instances place.
    pub(super) fn placed(
        InstanceHit { hit, path }: InstanceHit,
        octree: &InstanceOctree,
        details: Option<&Details>,
        moved: Option<&Displacement>,
    ) -> FoundTriangle {
        let (placed, made) = placed(octree, &path, details);
        FoundTriangle {
            hit,
            triangle: hit.triangle,
            carrier: Some(Carrier::placed(&placed, moved)),
            made,
            ground: None,
        }
    }

    /// One that stands for the ground.
    ///
    /// - `triangle`: one of its terrain.
    pub(super) fn of_ground(hit: GroundHit, ground: &SceneGround, triangle: u32) -> FoundTriangle {
        const MIDDLE: f64 = 1.0 / 3.0;
        let on = Hit { t: hit.t, triangle, u: MIDDLE, v: MIDDLE };
        FoundTriangle { hit: on, triangle, carrier: None, made: None, ground: Some(GroundPoint::new(&hit, ground)) }
    }

    /// The triangles among which it has its number.
    pub(super) fn contents<'c>(&'c self, scene: &'c Prepared) -> &'c Contents {
        self.made.as_deref().map_or(scene, MadeDetail::contents)
    }

    /// Its object of the scene, and which material of that it has.
    pub(super) fn object_and_material(&self, scene: &Prepared) -> [u32; 2] {
        match &self.made {
            Some(made) => made.object_and_material(self.triangle),
            None => [scene.object_of[self.triangle as usize], scene.material_number(self.triangle)],
        }
    }

    /// The body that it bounds: an object of the scene, and the one of what that makes or itself.
    pub(super) fn body(&self, scene: &Prepared) -> [u32; 2] {
        let [object, _] = self.object_and_material(scene);
        [object, self.contents(scene).object_of[self.triangle as usize]]
    }
}

/// An octree of instances with what is made of its models.
pub(super) fn walk<'w>(octree: &'w InstanceOctree, details: Option<&'w Details>) -> InstanceWalk<'w> {
    octree.made_by(details.map(|details| details as &dyn PrototypeMaker))
}

/// How the surface at the end of a path is placed, and what was made on demand and has it.
fn placed(
    octree: &InstanceOctree,
    path: &InstancePath,
    details: Option<&Details>,
) -> (PlacedSurface, Option<Arc<MadeDetail>>) {
    let Some(details) = details else { return (octree.placed(path), None) };
    let noting = Noting { details, last: RefCell::new(None) };
    let placed = octree.made_by(Some(&noting)).placed(path);
    (placed, noting.last.into_inner())
}

/// Gives what is made, and notes it.
struct Noting<'d> {
    details: &'d Details,
    last: RefCell<Option<Arc<MadeDetail>>>,
}

impl PrototypeMaker for Noting<'_> {
    fn give(
        &self,
        model: u32,
        placed: &PlacedSurface,
        along: Option<RayInterval<'_>>,
        to: &mut dyn FnMut(&InstanceOctree),
    ) {
        let made = self.details.made(model, placed, along);
        made.iter().flat_map(|made| made.octree()).for_each(to);
        *self.last.borrow_mut() = made;
    }

    fn aggregate_views(&self, number: u32) -> &[AggregateView] {
        self.details.aggregate_views(number)
    }
}
