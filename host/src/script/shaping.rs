//! Functions of the scene language that make new objects from the form of others, one row each.

use super::builder::{Builder, check_bounding, check_nesting, nesting_of};
use super::function::{Function, function};
use super::handle::{CallResult, Handle};
use super::kinds::{Length, ObjectKind, PointsKind};
use super::parameter::{optional, required};
use super::shared::{OBJECT, TOLERANCE};
use crate::scene::{Object, RoundedSolid, Shape};
use glam::DMat4;
use rhai::Dynamic;

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        meeting(object: OBJECT, other: required(ObjectKind, "the other object"), tolerance: TOLERANCE)
        "Adds the curves in which two objects meet, accurate on their exact surfaces, as lines; both objects stay."
        "let edge = ball.meeting(pot);"
        |builder| add_curve(builder, [object, other], tolerance)
    },
    function! {
        round_edges(
            object: OBJECT,
            radius: required(
                Length,
                "of a ball that touches the faces where the rounding begins; four times that far must a face reach",
            ),
            edges: optional(
                PointsKind,
                "all",
                "points [x, y, z] in scene coordinates; for each the nearest edge is rounded",
            ),
            tolerance: TOLERANCE,
        )
        "Rounds edges between flat faces of an object, by corner cutting: a parabola across each edge."
        "let die = cube(2).round_edges(0.3);"
        |builder| {
            let rounded = builder.object(object)?;
            check_bounding(rounded)?;
            check_nesting(nesting_of(rounded) + 1)?;
            let (name, material) = (rounded.name.clone(), rounded.material.clone());
            let edges = edges.unwrap_or_default();
            let shape = Shape::Rounded(Box::new(RoundedSolid { object: rounded.clone(), edges, radius }));
            *rounded = Object { name, shape, transform: DMat4::IDENTITY, material, tolerance };
            Ok(Dynamic::from(object))
        }
    },
];

fn add_curve(builder: &mut Builder, objects: [Handle; 2], tolerance: Option<f64>) -> CallResult {
    let one = builder.object(objects[0])?.clone();
    let two = builder.object(objects[1])?.clone();
    check_bounding(&one).and(check_bounding(&two))?;
    check_nesting(nesting_of(&one).max(nesting_of(&two)) + 1)?;
    if let Some(endless) = [&one, &two].into_iter().find(|object| matches!(object.shape, Shape::HalfSpace { .. })) {
        return Err(format!("{} has no end", endless.name));
    }
    builder.add(Shape::Curve(Box::new([one, two])), tolerance).map(Dynamic::from)
}
