//! Display structures of what is placed many times: for each step of detail one, and one that chooses among them.
//!
//! The level of detail of the machine is [`FULL`] where something is drawn in full, and one more for each step down to a
//! stroke: beyond that nothing is drawn.

use super::super::parts::{Fineness, MaterialPart, attributes, parts, vectors};
use super::super::structure_commands::{DETAILS, StructureCommands, placing};
use super::super::{Drawing, WorkstationError, facets, names::ROOT};
use super::choice::STEP;
use super::outline::{closed, outlines, stroke};
use super::placed::{PlacedGroup, PlacedObject};
use super::variation::Variation;
use crate::mesh::Polylines;
use crate::scene::{GeometrySettings, Object};
use crate::surface::Tolerance;
use glam::DVec3;
use protocol::command::{Comparison, Object as Node, Operate};

/// The level of detail at which something is drawn in full.
pub(super) const FULL: u16 = 4;
/// The part of all vectors that instances inside of something may have where it is drawn in full; in each step of detail
/// a tenth of that before.
const NESTED_PART: usize = 20;
const NESTED_STEP: usize = 10;
/// Instances inside of something are drawn rather than its outline, if they are at least this part of its size.
const LARGE: f64 = 0.125;
/// Coarse triangles lie within this part of the diagonal at the least.
const COARSE: f64 = 1.0 / 25.0;
/// Triangles of a coarse mesh.
const COARSE_TRIANGLES: usize = 60;
/// The coarsest tolerance, as a part of the diagonal.
const COARSEST: f64 = 1.0 / 8.0;
/// Instances that stand for all where only their vectors count.
const SAMPLE: usize = 256;

/// What is drawn of a prototype, and what that costs.
pub(super) struct DrawnGroup {
    /// Vectors, or corners of polygons, in each step of detail; no more in any than in the one before.
    pub(super) lines: [usize; DETAILS],
    /// Length of all vectors in each step of detail, as a part of the radius; 0 for polygons.
    pub(super) length: [f64; DETAILS],
    /// What varies from instance to instance.
    pub(super) variation: Variation,
    /// What is drawn of the instances in it: for each object that places some, for each prototype.
    nested: Vec<Vec<DrawnGroup>>,
}

/// How prototypes are drawn.
pub(super) struct DetailBuilder<'d> {
    pub(super) drawing: &'d Drawing,
    pub(super) geometry: &'d GeometrySettings,
}

/// Instances inside of something, in one step of detail of that.
struct Thinned {
    /// The step of detail in which they are drawn.
    step: usize,
    numbers: Vec<usize>,
    lines: usize,
}

impl DetailBuilder<'_> {
    /// Defines the structures of a prototype and of all that is placed in it.
    ///
    /// - `size`: of its largest instance on the screen, in halves of its side. `eye`: as that instance is seen, in
    ///   coordinates of the prototype.
    ///
    /// # Errors
    /// [`WorkstationError::Scene`], if an object cannot be tessellated.
    pub(super) fn draw(
        &self,
        prototype: &PlacedGroup<'_>,
        size: f64,
        eye: DVec3,
        out: &mut StructureCommands,
    ) -> Result<DrawnGroup, WorkstationError> {
        let (_, radius) = prototype.ball();
        let mut nested = Vec::with_capacity(prototype.nested.len());
        for placed in &prototype.nested {
            let mut all = Vec::with_capacity(placed.prototypes.len());
            for (number, inner) in placed.prototypes.iter().enumerate() {
                let like = |place: &usize| usize::from(placed.places.instance(*place).prototype) == number;
                let place = placed.sample(SAMPLE).find(like);
                let placement = place.map_or(placed.transform, |place| placed.instance(place).1);
                let (_, inner_radius) = inner.ball_at(&placement);
                let inner_size = size * inner_radius / radius.max(f64::MIN_POSITIVE);
                all.push(self.draw(inner, inner_size, placement.inverse().transform_point3(eye), out)?);
            }
            nested.push(all);
        }
        let variation = Variation::of(prototype);
        let mut drawn = DrawnGroup { lines: [0; DETAILS], length: [0.0; DETAILS], variation, nested };
        let mut structures: [String; DETAILS] = std::array::from_fn(|step| format!("{}_{step}", prototype.name));
        for step in 0..DETAILS {
            let before = out.commands.len();
            let points = out.points;
            let (lines, length) = match self.step(prototype, &drawn, step, size, eye, &structures[step], out) {
                Ok(made) => made,
                // What is too coarse to be made is not drawn so.
                Err(_) if step > 0 => (usize::MAX, 0.0),
                Err(error) => return Err(error),
            };
            if step > 0 && lines >= drawn.lines[step - 1] {
                // It would be no simpler.
                out.commands.truncate(before);
                out.points = points;
                (drawn.lines[step], drawn.length[step]) = (drawn.lines[step - 1], drawn.length[step - 1]);
                structures[step] = structures[step - 1].clone();
            } else {
                drawn.lines[step] = lines;
                drawn.length[step] = length / radius.max(f64::MIN_POSITIVE);
            }
        }
        out.begin(&prototype.name);
        for (level, structure) in (FULL..).zip(&structures) {
            let comparison = if level == FULL { Comparison::LessEqual } else { Comparison::Equal };
            out.operate_on(structure, Operate::IfLevelOfDetail { comparison, level });
        }
        out.end();
        Ok(drawn)
    }

    /// Defines the structure of one step of detail; its vectors, and their length.
    #[expect(clippy::too_many_arguments, reason = "what is drawn, how, and where to")]
    fn step(
        &self,
        prototype: &PlacedGroup<'_>,
        drawn: &DrawnGroup,
        step: usize,
        size: f64,
        eye: DVec3,
        structure: &str,
        out: &mut StructureCommands,
    ) -> Result<(usize, f64), WorkstationError> {
        let shows_nested = step < 2 || is_bundle(prototype);
        let made = match (step < 2, shows_nested) {
            (true, _) => self.objects(prototype, step, size, eye, out)?,
            (false, true) => Vec::new(),
            (false, false) => self.simplest(prototype, step, out)?,
        };
        let mut lines: usize = made.iter().map(|part| lines(&part.data)).sum();
        let mut length: f64 = made.iter().map(|part| self::length(&part.data)).sum();
        out.begin(structure);
        drawn.variation.first(made, out);
        if shows_nested {
            let most = self.drawing.most() / NESTED_PART / NESTED_STEP.pow(step as u32);
            let most = most / prototype.nested.len().max(1);
            for (placed, all) in prototype.nested.iter().zip(&drawn.nested) {
                let thinned = self.thinned(prototype, placed, all, step, most);
                lines += thinned.lines;
                out.operate(None, Operate::SetLevelOfDetail(FULL + thinned.step as u16));
                for number in thinned.numbers {
                    let instance = placed.places.instance(number);
                    let (inner, placement) = placed.instance(number);
                    all[usize::from(instance.prototype)].variation.set(instance.variation, out);
                    out.operate_on(&inner.name, placing(&placement));
                    let drawn = &all[usize::from(instance.prototype)];
                    length += drawn.length[thinned.step] * inner.ball_at(&placement).1;
                }
            }
        }
        out.end();
        Ok((lines, length))
    }

    /// Its own objects, in full or coarse.
    fn objects(
        &self,
        prototype: &PlacedGroup<'_>,
        step: usize,
        size: f64,
        eye: DVec3,
        out: &mut StructureCommands,
    ) -> Result<Vec<MaterialPart>, WorkstationError> {
        // As far off on the screen as that of an object which fills it.
        let full = self.drawing.tolerance / size.clamp(1e-6, 1.0);
        let part = if step == 0 { full } else { (full * STEP).max(COARSE) }.min(COARSEST);
        let angle = if step == 0 { self.geometry.angle } else { 180.0 };
        let mut made = Vec::new();
        for (k, object) in prototype.objects.iter().enumerate() {
            let fineness = Fineness {
                tolerance: tolerance(object, part, angle),
                eye,
                most_triangles: (step > 0).then_some(COARSE_TRIANGLES),
            };
            let surfaces = format!("{ROOT}_A_{}_{step}_{}", &prototype.name[ROOT.len() + 1..], k + 1);
            let mut sent = StructureCommands::default();
            made.append(&mut parts(object, &surfaces, &fineness, self.drawing, &mut sent)?);
            out.commands.append(&mut sent.commands);
            out.points += sent.points;
        }
        Ok(made)
    }

    /// Its outlines, or a stroke.
    fn simplest(
        &self,
        prototype: &PlacedGroup<'_>,
        step: usize,
        out: &mut StructureCommands,
    ) -> Result<Vec<MaterialPart>, WorkstationError> {
        let failed = |e: String| WorkstationError::Scene(format!("{}: {e}", prototype.name));
        let [first, second] = outlines(&prototype.form);
        let data = if self.drawing.facets {
            let surface = format!("{ROOT}_A_{}_{step}", &prototype.name[ROOT.len() + 1..]);
            out.commands.push(attributes(&surface, &prototype.material));
            let shown = if step == 2 { vec![first, second] } else { vec![first] };
            let polygons = facets::flat_polygons(&shown, &surface).map_err(failed)?;
            out.points += polygons.iter().map(|polygon| polygon.vertices.len()).sum::<usize>();
            Node::Polygons(polygons)
        } else {
            let runs: Polylines = if step == 2 { closed(&[first, second]) } else { stroke(&prototype.form) };
            let mut sent = StructureCommands::default();
            let list = vectors(&runs, &mut sent).map_err(failed)?;
            out.points += sent.points;
            Node::VectorList(list)
        };
        Ok(vec![MaterialPart { material: prototype.material.clone(), data }])
    }

    /// The instances inside of something that are drawn in one step of detail of that: all in the finest step that their
    /// size on the screen deserves and `most` admits, or some of them as strokes.
    fn thinned(
        &self,
        prototype: &PlacedGroup<'_>,
        placed: &PlacedObject<'_>,
        all: &[DrawnGroup],
        step: usize,
        most: usize,
    ) -> Thinned {
        let count = placed.places.count();
        let last = DETAILS - 1;
        let sample: Vec<usize> = placed.sample(SAMPLE).collect();
        if sample.is_empty() {
            return Thinned { step: last, numbers: Vec::new(), lines: 0 };
        }
        let drawn = |number: &usize| &all[usize::from(placed.places.instance(*number).prototype)];
        let mean = |step: usize| {
            let sum: usize = sample.iter().map(|number| drawn(number).lines[step]).sum();
            sum as f64 / sample.len() as f64
        };
        let deserved = (step + steps_smaller(prototype, placed)).min(last);
        let fitting = (deserved..=last).find(|step| count as f64 * mean(*step) <= most as f64);
        let chosen = fitting.unwrap_or(last);
        let room = (most as f64 / mean(chosen).max(f64::MIN_POSITIVE)) as usize;
        let numbers: Vec<usize> = placed.sample(if fitting.is_some() { count } else { room.max(1) }).collect();
        let lines = numbers.iter().map(|number| drawn(number).lines[chosen]).sum();
        Thinned { step: chosen, numbers, lines }
    }
}

/// How many steps of detail smaller than something the instances in it are.
fn steps_smaller(prototype: &PlacedGroup<'_>, placed: &PlacedObject<'_>) -> usize {
    let ratio = inner_size(prototype, placed);
    if ratio > 0.0 { (-ratio.log2() / STEP.log2()).max(0.0).min(DETAILS as f64) as usize } else { DETAILS }
}

/// The size of instances inside of something as a part of its own, in the mean over some.
fn inner_size(prototype: &PlacedGroup<'_>, placed: &PlacedObject<'_>) -> f64 {
    let (_, radius) = prototype.ball();
    let inner = |number: usize| {
        let (inner, placement) = placed.instance(number);
        inner.ball_at(&placement).1
    };
    let (count, sum) = placed.sample(SAMPLE).map(inner).fold((0, 0.0), |(count, sum), size| (count + 1, sum + size));
    if count == 0 || radius <= 0.0 { 0.0 } else { sum / f64::from(count) / radius }
}

/// Whether it is nothing but instances that are large in it, such as blades of grass in a tuft: some of these tell its form
/// better than an outline.
fn is_bundle(prototype: &PlacedGroup<'_>) -> bool {
    prototype.objects.is_empty() && prototype.nested.iter().all(|placed| inner_size(prototype, placed) >= LARGE)
}

/// Vectors of a list, or corners of polygons.
fn lines(data: &Node) -> usize {
    match data {
        Node::VectorList(list) => list.lines.iter().filter(|line| **line).count(),
        Node::Polygons(polygons) => polygons.iter().map(|polygon| polygon.vertices.len()).sum(),
        _ => 0,
    }
}

/// Length of the vectors of a list.
fn length(data: &Node) -> f64 {
    let Node::VectorList(list) = data else { return 0.0 };
    let point = |k: usize| DVec3::from_array([0, 1, 2].map(|axis| f64::from(list.points[k][axis])));
    let drawn = (1..list.points.len()).filter(|k| list.lines[*k]);
    drawn.map(|k| point(k).distance(point(k - 1))).sum()
}

/// A tolerance that is a part of an object's diagonal.
fn tolerance(object: &Object, part: f64, angle: f64) -> Tolerance {
    Tolerance::new(part * object.shape.extent().unwrap_or(1.0), angle)
}
