//! Functions of the scene language for rocks and crystals, one row each.

use super::function::{Function, function};
use super::kinds::{Integer, Length, NumberKind, VariedKind, Word};
use super::parameter::{Defaulted, with_default};
use super::procedural::add_model;
use crate::procedural::rock::{CRYSTAL_HABITS, CrystalHabit, RockNumbers, crystal_planes};
use crate::scene::{Composite, MOST_KINDS, Object, Operation, RockModel, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use rhai::Dynamic;
use std::sync::Arc;

/// A width of a rock.
const WIDTH: Defaulted<VariedKind, [f64; 2]> = with_default(VariedKind, [1.0, 0.3], "its width along this axis");
/// A box about a crystal is larger by this factor than the farthest that its faces may meet.
const AROUND: f64 = 4.0;

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        rock(
            x: WIDTH,
            y: with_default(VariedKind, [0.7, 0.2], "its height"),
            z: WIDTH,
            planes: with_default(VariedKind, [16.0, 5.0], "how many planes cut it, 4 to 200"),
            wear: with_default(VariedKind, [0.25, 0.15], "how far its edges are worn: 0 sharp, 1 a pebble"),
            roughness: with_default(VariedKind, [0.06, 0.03], "height of its largest bumps in parts of its size, 0 to 0.5"),
            grain: with_default(VariedKind, [0.35, 0.1], "their size, in parts of its size"),
            kinds: with_default(Integer(1, MOST_KINDS), 16, "how many different ones there are, where instances place it"),
            seed: with_default(Integer(0u32, u32::MAX), 1, "which ones"),
        )
        "Adds a rock about the origin, as finely as it is seen: a cell that planes cut, its edges worn, with bumps of all sizes. Each parameter is a number or [mean, deviation], drawn for each kind."
        "scatter(rock(#{ wear: 0.8, y: 0.4 }), ground(20), #{ count: 900, upright: 1, scale: [0.05, 0.6] });"
        |builder| {
            let numbers = RockNumbers { size: [x, y, z], planes, wear, roughness, grain };
            let model = RockModel::new(numbers, seed, kinds).map_err(|error| error.to_string())?;
            add_model(builder, "rock", Arc::new(model))
        }
    },
    function! {
        crystal(
            habit: with_default(
                Word(&CRYSTAL_HABITS),
                CrystalHabit::Quartz,
                "\"quartz\", a prism with points; \"octahedron\", as of diamond and fluorite; \"cube\", of salt and pyrite; \"garnet\", of twelve faces; \"rhombohedron\", of calcite",
            ),
            width: with_default(Length, 1.0, "between opposite faces"),
            length: with_default(Length, 2.5, "of a prism from tip to tip"),
            irregularity: with_default(
                NumberKind(0.0, 0.5),
                0.15,
                "how far faces are from where they would be had all grown alike, in parts of that",
            ),
            seed: with_default(Integer(0, i64::MAX as u64), 1, "of that"),
        )
        "Adds a crystal about the origin, its axis y: a solid of flat faces at the angles of the mineral, which Booleans combine exactly."
        "crystal(\"quartz\", #{ width: 0.5, length: 2 }).rotate(\"z\", 20).glass(1.55);"
        |builder| {
            let planes = crystal_planes(habit, length / width, irregularity, seed);
            let object = |name: &str, shape| Object {
                name: name.into(),
                shape,
                transform: DMat4::IDENTITY,
                material: None,
                tolerance: None,
            };
            let side = AROUND * width.max(length);
            let body = Primitive::Box { size: DVec3::splat(side) };
            let faces = planes.into_iter().map(|(normal, distance)| {
                object("face", Shape::HalfSpace { normal, at: normal * (distance * width) })
            });
            let operands = std::iter::once(object("box", body.into())).chain(faces).collect();
            let composite = Composite { operation: Operation::Intersection, operands, nesting: 1 };
            builder.add_called("crystal", Shape::Composite(Box::new(composite)), None).map(Dynamic::from)
        }
    },
];
