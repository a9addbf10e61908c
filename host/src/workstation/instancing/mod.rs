//! Instances on the workstation: what is placed is sent once, and for each place a node that leads to it.
//!
//! Each prototype becomes structures beside the root, in several steps of detail. An instance is a MATRIX_4X3 applied to
//! the structure that chooses among these by the level of detail, after a SET COLOR if its paint varies. Instances stand
//! in the structure of their object in the order of their size on the screen; between those of two steps of detail stands
//! INCREMENT LEVEL_OF_DETAIL, so that a node at the root changes the detail of everything.

mod seen;
mod outline;
mod placed;
mod ink;
mod choice;
mod variation;
mod detail;

#[cfg(test)]
mod tests;

use super::structure_commands::{DrawnInstances, StructureCommands, placing};
use super::{Drawing, InitialView, WorkstationError};
use crate::memory;
use crate::scene::Scene;
use choice::{Candidate, DrawingCost, largest, steps};
use detail::{DetailBuilder, DrawnGroup, FULL};
use placed::PlacedObject;
use protocol::command::{Command, Operate};
use seen::SeenFrom;

/// The level of detail at the root, with which all is drawn as it was chosen.
pub(super) const CHOSEN_LEVEL: u16 = FULL;
/// How long lines in all directions appear, as a part of their lengths.
const FORESHORTENED: f64 = std::f64::consts::FRAC_PI_4;
/// So many times more instances are looked at more closely than there are vectors: many stand where others are.
const CANDIDATES: usize = 4;
/// Bytes of the nodes of an instance until they are sent.
const NODE_BYTES: u64 = 1024;
/// Instances have this part of all vectors even where other objects take them all.
const LEAST_PART: usize = 4;

/// The instances of a scene as they are drawn.
pub(super) struct ShownInstances {
    /// For each object that has instances, by its number from 0, what is in its structure.
    pub(super) objects: Vec<(usize, Vec<Command>)>,
    /// What is drawn.
    pub(super) drawn: DrawnInstances,
}

/// Chooses what of the instances of a scene is drawn, and defines the structures of what they place; none if the scene
/// has no instances.
///
/// - `others`: vectors of other objects. `out`: gets the structures.
///
/// # Errors
/// [`WorkstationError::Scene`], if something cannot be tessellated, or for too little memory.
pub(super) fn instances(
    scene: &Scene,
    initial: &InitialView,
    drawing: &Drawing,
    others: usize,
    out: &mut StructureCommands,
) -> Result<Option<ShownInstances>, WorkstationError> {
    let geometry = &scene.settings.geometry;
    let (mut objects, mut numbers, mut next) = (Vec::new(), Vec::new(), 1);
    for (number, object) in scene.objects.iter().enumerate() {
        if let Some(placed) = PlacedObject::of(object, geometry, &mut next)? {
            objects.push(placed);
            numbers.push(number);
        }
    }
    if objects.is_empty() {
        return Ok(None);
    }
    let seen = SeenFrom::new(initial);
    let most = drawing.most().saturating_sub(others).max(drawing.most() / LEAST_PART);
    let candidates = largest(most.saturating_mul(CANDIDATES), &objects, &seen);
    memory::reserve(candidates.len().min(most) as u64 * NODE_BYTES, || {
        format!("showing {} instances", candidates.len())
    })
    .map_err(|error| WorkstationError::Scene(error.to_string()))?;
    let builder = DetailBuilder { drawing, geometry };
    let mut all: Vec<Vec<Option<DrawnGroup>>> =
        objects.iter().map(|placed| placed.prototypes.iter().map(|_| None).collect()).collect();
    // The first that places something is the largest.
    for Candidate { size, object, number, prototype, .. } in &candidates {
        let drawn = &mut all[*object as usize][usize::from(*prototype)];
        if drawn.is_none() {
            let (prototype, placement) = objects[*object as usize].instance(*number as usize);
            let eye = placement.inverse().transform_point3(seen.eye());
            *drawn = Some(builder.draw(prototype, (*size).into(), eye, out)?);
        }
    }
    let cost = |candidate: &Candidate| {
        let drawn = &all[candidate.object as usize][usize::from(candidate.prototype)];
        drawn.as_ref().map_or(DrawingCost::default(), |drawn| DrawingCost {
            lines: drawn.lines,
            length: drawn.length.map(|length| length * f64::from(candidate.size) * FORESHORTENED),
        })
    };
    let costs: Vec<DrawingCost> = candidates.iter().map(cost).collect();
    let steps = steps(&candidates, &costs, most);
    let mut order: Vec<(usize, &Candidate)> =
        candidates.iter().zip(&steps).filter_map(|(candidate, step)| Some(((*step)?, candidate))).collect();
    order.sort_by_key(|(step, _)| *step);
    let count = objects.iter().map(|placed| placed.places.count() as u64).sum();
    let mut sums = DrawnInstances { count, ..DrawnInstances::default() };
    let mut nodes: Vec<(StructureCommands, usize)> = objects.iter().map(|_| Default::default()).collect();
    for (step, candidate) in order {
        let placed = &objects[candidate.object as usize];
        let Some(drawn) = &all[candidate.object as usize][usize::from(candidate.prototype)] else { continue };
        let (out, at) = &mut nodes[candidate.object as usize];
        while *at < step {
            out.operate(None, Operate::IncrementLevelOfDetail);
            *at += 1;
        }
        let (group, placement) = placed.instance(candidate.number as usize);
        drawn.variation.set(placed.places.instance(candidate.number as usize).variation, out);
        out.operate_on(&group.name, placing(&placement));
        sums.drawn[step] += 1;
        sums.lines += drawn.lines[step];
    }
    let nodes = nodes.into_iter().map(|(nodes, _)| nodes.commands);
    Ok(Some(ShownInstances { objects: numbers.into_iter().zip(nodes).collect(), drawn: sums }))
}
