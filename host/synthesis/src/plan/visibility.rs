//! Visibility: the objects that can be seen, mirrored, or throw a shadow on what can be seen.

use super::decision::Decision;
use super::stage::Facts;
use crate::illumination::light::LightOrigin;
use crate::numeric::bounds::Bounds;
use crate::octree::AggregateView;
use crate::scene::{Prepared, PreparedObject, View};
use glam::DVec3;

/// Decides for each object whether it can influence one of the pictures.
pub(super) fn objects(prepared: &Prepared, views: &[View], facts: &Facts<'_>) -> Vec<Decision> {
    let Some(projections) = views.iter().map(View::projection).collect::<Option<Vec<_>>>() else {
        return prepared.objects.iter().map(|_| Decision::new(true, "the view is not known")).collect();
    };
    let camera_moves = prepared.settings.geometry.shutter > 0.0 && views.iter().any(View::moves);
    let window = View::window(prepared.settings.image.width, prepared.settings.image.height);
    let is_seen = |bounds: &Bounds| projections.iter().any(|seen| !bounds.is_outside(&seen.to_clip, window));
    let stands = |o: &PreparedObject| !o.is_empty() && o.placed_by.is_none();
    let visible: Vec<bool> = prepared.objects.iter().map(|o| stands(o) && is_seen(&o.bounds)).collect();
    let seen = prepared.objects.iter().zip(&visible).filter(|(_, v)| **v);
    let seen = seen.fold(Bounds::EMPTY, |b, (o, _)| b.union(o.bounds));
    let mirrors = facts.reflection().needed;
    let shadows = facts.shadows().needed;
    let decide = |(number, (object, visible)): (usize, (&PreparedObject, &bool))| {
        if object.copies > 0 {
            Decision::new(false, format!("the copies of what it places stand for it, {} objects", object.copies))
        } else if object.is_empty() {
            Decision::new(false, "it has no triangles")
        } else if *visible {
            Decision::new(true, format!("in view, {}{}", extent(object), aggregates(prepared, views, number)))
        } else if camera_moves {
            Decision::new(true, "out of view in the middle, but the camera moves")
        } else if seen.is_empty() {
            Decision::new(false, "nothing at all is in view")
        } else if mirrors {
            Decision::new(true, "out of view, but a mirror may show it")
        } else if facts.emits(object) {
            Decision::new(true, "out of view, but it emits light")
        } else if shadows && throws_shadow(prepared, facts, &object.bounds, &seen) {
            Decision::new(true, "out of view, but its shadow may be seen")
        } else {
            Decision::new(false, "out of view, and neither its mirror image nor its shadow can be seen")
        }
    };
    let standing: Vec<Decision> = prepared.objects.iter().zip(&visible).enumerate().map(decide).collect();
    let decided = |(object, own): (&PreparedObject, &Decision)| match object.placed_by {
        Some(placing) if standing[placing as usize].needed => {
            let (name, triangles) = (&prepared.objects[placing as usize].name, object.count);
            Decision::new(true, format!("placed by {name}, {triangles} triangles"))
        }
        Some(placing) => Decision::new(false, format!("placed by {}", prepared.objects[placing as usize].name)),
        None => own.clone(),
    };
    prepared.objects.iter().zip(&standing).map(decided).collect()
}

/// How much there is of an object.
fn extent(object: &PreparedObject) -> String {
    match (object.count, object.instances) {
        (count, 0) => format!("{count} triangles"),
        (0, instances) => format!("{instances} instances"),
        (count, instances) => format!("{count} triangles and {instances} instances"),
    }
}

/// From where on aggregates stand in for the instances of an object; nothing if they do not.
fn aggregates(prepared: &Prepared, views: &[View], object: usize) -> String {
    let (mut nearest, mut enlarged) = (f64::INFINITY, f64::INFINITY);
    for view in prepared.aggregate_views(object, views, &prepared.settings) {
        match view {
            AggregateView::Eye { distance, .. } => nearest = nearest.min(distance),
            AggregateView::Parallel { enlargement } => enlarged = enlarged.min(enlargement),
        }
    }
    match (nearest.is_finite(), enlarged.is_finite() && enlarged > 1.0) {
        (true, _) => format!("; aggregates stand in beyond {nearest:.4} from the eye"),
        (false, true) => format!("; aggregates stand in for all, up to {enlarged:.2} times as large"),
        (false, false) => String::new(),
    }
}

/// Whether a box may stand between any bright light and a point of `seen`; errs towards yes.
fn throws_shadow(prepared: &Prepared, facts: &Facts<'_>, object: &Bounds, seen: &Bounds) -> bool {
    prepared.lights.iter().enumerate().filter(|(i, _)| facts.is_bright(*i)).any(|(_, light)| match light.origin() {
        LightOrigin::Within(bounds) => is_between(bounds, object, seen),
        LightOrigin::Everywhere => true,
        LightOrigin::Towards(towards) => {
            let along = -towards;
            let (u, v) = along.any_orthonormal_pair();
            let overlaps = |axis: DVec3| {
                let ((a, b), (c, d)) = (range(object, axis), range(seen, axis));
                a <= d && c <= b
            };
            overlaps(u) && overlaps(v) && range(object, along).0 <= range(seen, along).1
        }
    })
}

/// Whether a box may stand between a light and what is seen.
fn is_between(light: Bounds, object: &Bounds, seen: &Bounds) -> bool {
    let between = seen.union(light);
    between.min.cmple(object.max).all() && object.min.cmple(between.max).all()
}

/// The least and the greatest coordinate of a box along an axis.
fn range(bounds: &Bounds, axis: DVec3) -> (f64, f64) {
    let along = bounds.corners().map(|c| c.dot(axis));
    (along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max))
}
