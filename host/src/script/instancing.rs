//! Functions of the scene language that place objects many times, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::{CallResult, Handle};
use super::kinds::{
    ANY_NUMBER, AmountKind, Flag, Integer, NumberKind, Numbers, ObjectGroups, ObjectKind, PlaceValue, PlacesKind,
    RangeKind,
};
use super::parameter::{Required, optional, required, with_default};
use super::wind;
use crate::numeric::sampling::mix;
use crate::octree::{Instance, MOST_INSTANCES};
use crate::scene::{Instances, MOST_DETAIL, Object, PlacementList, Placing, Scatter, Shape};
use rhai::Dynamic;

const OBJECTS: Required<ObjectGroups> = required(
    ObjectGroups,
    "what is placed, as it stands about the origin; it is stored once, and is no object of its own any more",
);
/// Heights that no scene has.
const HIGHEST: f64 = 1e30;

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        instances(objects: OBJECTS, places: required(PlacesKind, "where, and how"))
        "Places objects many times, as one object: each instance takes 57 bytes. Instances may be placed again."
        "let row = instances(cube(1), [[0, 0, 0], [2, 0, 0], #{ at: [4, 0, 0], turn: 45 }]);"
        |builder| {
            let last = objects.len() - 1;
            let instance = |(number, PlaceValue { placement, which, variation }): (usize, PlaceValue)| {
                if usize::from(which) > last {
                    return Err(format!("which {which} of place {} is not within 0 to {last}", number + 1));
                }
                let drawn = || mix(number as u64) as u16;
                let variation = variation.map_or_else(drawn, |part| (part * f64::from(u16::MAX)).round() as u16);
                Ok(Instance { prototype: which, variation, placement })
            };
            let all = places.into_iter().enumerate().map(instance).collect::<Result<Vec<Instance>, String>>()?;
            add(builder, objects, Placing::Listed(PlacementList(all)))
        }
    },
    function! {
        scatter(
            objects: OBJECTS,
            on: required(ObjectKind, "the object on whose surface they stand, as it is now"),
            count: required(
                Integer(0, MOST_INSTANCES),
                "how many, or with cells how many in each; fewer where they find no room",
            ),
            cell: optional(
                NumberKind(1e-9, 1e12),
                "none",
                "side of square cells on a ground: what is in a cell is drawn when a ray comes to it, and nothing is stored",
            ),
            distance: with_default(NumberKind(0.0, f64::INFINITY), 0.0, "of each two the least distance"),
            density: with_default(
                AmountKind(0.0, 1.0),
                1.0,
                "the part of places that count, by place: a pattern lies on the surface as a paint of it would",
            ),
            slope: with_default(
                RangeKind(0.0, 180.0),
                [0.0, 180.0],
                "the angle between a level surface and one that has any, degrees",
            ),
            height: optional(RangeKind(-HIGHEST, HIGHEST), "any", "the y of places that have any"),
            scale: with_default(RangeKind(1e-9, 1e9), [1.0, 1.0], "factor; drawn between two"),
            turn: with_default(
                NumberKind(0.0, 360.0),
                360.0,
                "within which angle they are turned about their y axis, degrees; 0 does not turn",
            ),
            lean: with_default(NumberKind(0.0, 89.0), 0.0, "how far their y axis leans at the most, degrees"),
            upright: with_default(
                NumberKind(0.0, 1.0),
                0.0,
                "where their y axis points: 0 along the normal of the surface, 1 up",
            ),
            shares: optional(Numbers, "the same of each", "how often there is each group of objects"),
            seed: with_default(Integer(0, i64::MAX as u64), 1, "of all that is drawn"),
            stays: with_default(Flag, true, "whether that object stays; if not, it is used up"),
            sway: with_default(
                NumberKind(0.0, 89.0),
                0.0,
                "how far they lean in a wind() of 10 units a second, degrees; as the square of its speed in others",
            ),
            sink: with_default(ANY_NUMBER, 0.0, "how deep their origin is below the surface, along their y axis"),
            aggregate: optional(
                NumberKind(1.0 / MOST_DETAIL, MOST_DETAIL),
                "none",
                "in cells: beyond the distance from the eye at which the largest of them spans so many pixels, fewer and larger ones stand in for all",
            ),
        )
        "Scatters objects over the surface of another by chance, as one object: as many on each part of its area. Each instance takes 29 bytes, and some millions are found in a second."
        "scatter(cone(0.1, 0.4), pot, #{ count: 400, distance: 0.1, scale: [0.7, 1.3], slope: [0, 60] });"
        |builder| {
            builder.check_still(on)?;
            if objects.iter().flatten().any(|object| *object == on) {
                return Err("an object cannot be scattered on itself; copy() it before".into());
            }
            let surface = on;
            let on = builder.object(on)?.clone();
            let shares = shares.unwrap_or_else(|| vec![1.0; objects.len()]);
            let height = height.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            let sway = if sway > 0.0 { Some(wind::sway(builder, sway)?) } else { None };
            let scatter = Scatter {
                on,
                count,
                cell,
                aggregate,
                distance,
                density,
                slope,
                height,
                scale,
                turn,
                lean,
                upright,
                sink,
                shares,
                sway,
                seed,
            };
            let all = add(builder, objects, Placing::Scattered(Box::new(scatter)))?;
            if !stays {
                builder.use_up(surface);
            }
            Ok(all)
        }
    },
];

/// Adds an object of instances, which take up the objects that they place.
fn add(builder: &mut Builder, groups: Vec<Vec<Handle>>, placing: Placing) -> CallResult {
    let mut all: Vec<Handle> = groups.concat();
    all.sort_by_key(|handle| handle.0);
    if all.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err("an object is told twice; copy() it before".into());
    }
    for handle in &all {
        builder.check_still(*handle)?;
    }
    let taken = |group: &Vec<Handle>| group.iter().map(|handle| Ok(builder.object(*handle)?.clone())).collect();
    let prototypes = groups.iter().map(taken).collect::<Result<Vec<Vec<Object>>, String>>()?;
    let shape = Shape::Instances(Box::new(Instances { prototypes, placing }));
    shape.check()?;
    all.into_iter().for_each(|handle| builder.use_up(handle));
    builder.add(shape, None).map(Dynamic::from)
}
