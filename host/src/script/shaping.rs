//! Functions of the scene language that make new objects from the form of others, one row each.

use super::argument::Bound;
use super::builder::{Builder, check_bounding, check_nesting, nesting_of, value};
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, TOLERANCE, parameter};
use crate::scene::{Object, Rounded, Shape};
use glam::DMat4;
use rhai::Dynamic;

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "meeting",
        summary: "Adds the curves in which two objects meet, accurate on their exact surfaces, as lines; both objects stay.",
        parameters: &[OBJECT, parameter("other", Kind::Object, Required, "the other object"), TOLERANCE],
        example: "let edge = ball.meeting(pot);",
        action: add_curve,
    },
    Function {
        name: "round_edges",
        summary: "Rounds edges between flat faces of an object, by cutting and grinding: a parabola across each edge.",
        parameters: &[
            OBJECT,
            parameter(
                "radius",
                Kind::Length,
                Required,
                "of a ball that touches the faces where the rounding begins; four times that far must a face reach",
            ),
            parameter(
                "edges",
                Kind::Points,
                Is("all"),
                "points [x, y, z] in scene coordinates; for each the nearest edge is rounded",
            ),
            TOLERANCE,
        ],
        example: "let die = cube(2).round_edges(0.3);",
        action: round_edges,
    },
];

fn round_edges(builder: &mut Builder, bound: &Bound) -> Done {
    let handle = bound.object("object");
    let object = builder.object(handle)?;
    check_bounding(object)?;
    check_nesting(nesting_of(object) + 1)?;
    let (name, material) = (object.name.clone(), object.material.clone());
    let (edges, radius) = (bound.contours("edges").concat(), bound.number("radius").unwrap_or(1.0));
    let shape = Shape::Rounded(Box::new(Rounded { object: object.clone(), edges, radius }));
    *object = Object { name, shape, transform: DMat4::IDENTITY, material, tolerance: bound.number("tolerance") };
    Ok(value(handle))
}

fn add_curve(builder: &mut Builder, bound: &Bound) -> Done {
    let one = builder.object(bound.object("object"))?.clone();
    let two = builder.object(bound.object("other"))?.clone();
    check_bounding(&one).and(check_bounding(&two))?;
    check_nesting(nesting_of(&one).max(nesting_of(&two)) + 1)?;
    if let Some(endless) = [&one, &two].into_iter().find(|object| matches!(object.shape, Shape::HalfSpace { .. })) {
        return Err(format!("{} has no end", endless.name));
    }
    builder.add(Shape::Curve(Box::new([one, two])), bound.number("tolerance")).map(Dynamic::from)
}
