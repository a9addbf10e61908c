//! Edge collapses within a few units in the last place.
//!
//! A point of a result that bounds nothing but for roundings is moved onto a neighbour, which takes two triangles away:
//! one on the line that divides a flat side of which the corners are rounded, or one a rounding beside another. All
//! faces that meet in it pass through the neighbour too, but for a few units in the last place; and no triangle that is
//! changed has more in common with others than before, nor is there anything between the old surface and the new one.
//! That is looked at exactly. Corners of triangles that stayed whole stay.
//!
//! # Source
//! Hoppe 1996 for the collapse of edges.
//!
//! # Cost
//! n log n in the new triangles, of which most only show that they are needed; and what the
//! search for pairs of triangles near each other costs for those that are changed, in each of a few rounds.

use super::fan::{Collapse, CollapseCriteria};
use super::operand::Operands;
use super::overlap::{NamedTriangle, PlaneTriangle, nearly_overlap};
use super::result::Outcome;
use super::rounding::NewTriangles;
use crate::numeric::bounds::Bounds;
use crate::numeric::implicit::side;
use crate::octree::TriangleBvh;
use crate::solid::cleaning::retain;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::OnceLock;

/// Rounds at most.
const ROUNDS: usize = 64;
/// Triangles that are changed in a round, up to which a look at all is faster than sorting them.
const FEW: usize = 32;

/// What was made of a result of which no more is known than of which triangles its triangles are part.
pub fn all_new(operands: &Operands, outcome: &Outcome) -> NewTriangles {
    let mesh = &outcome.mesh;
    let mut is_free = vec![true; mesh.vertices.len()];
    for (triangle, [operand, source]) in outcome.sources.iter().enumerate() {
        let given = operands.meshes()[*operand as usize].corners(*source as usize);
        if mesh.corners(triangle).iter().all(|corner| given.contains(corner)) {
            mesh.triangles[triangle].into_iter().for_each(|vertex| is_free[vertex as usize] = false);
        }
    }
    NewTriangles { first: 0, first_vertex: 0, is_free, whole: None }
}

/// Leaves out points of new triangles that no face needs.
pub fn collapse(operands: &Operands, outcome: &mut Outcome, new_triangles: &NewTriangles) {
    let mut work = Collapsing::new(operands, outcome, new_triangles);
    let mut open: Vec<u32> = work.candidates();
    for _ in 0..ROUNDS {
        let proposed = work.proposed(&open);
        if proposed.is_empty() {
            break;
        }
        let (chosen, mut next) = work.independent(proposed);
        let verdicts = work.verdicts(&chosen);
        for (collapse, verdict) in chosen.into_iter().zip(verdicts) {
            next.push(collapse.vertex);
            match verdict {
                Verdict::Fine => {
                    next.extend(collapse.stay.iter().flat_map(|(_, corners)| corners));
                    work.apply(&collapse);
                }
                Verdict::Waits => {}
                Verdict::Refused => work.refused.entry(collapse.vertex).or_default().push(collapse.onto),
            }
        }
        next.sort_unstable();
        next.dedup();
        next.retain(|vertex| new_triangles.number(*vertex).is_some());
        open = next;
    }
    work.finish();
}

/// What became of a new triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// It is as it was.
    Still,
    /// It has another corner.
    Changed,
    /// It was left out.
    Gone,
}

/// A result while edges are collapsed.
struct Collapsing<'a> {
    operands: &'a Operands<'a>,
    outcome: &'a mut Outcome,
    new: &'a NewTriangles,
    /// The largest coordinate of the operands.
    largest: f64,
    /// Triangles from the first new one on; those that were changed before are not where it says.
    sorted: OnceLock<TriangleBvh>,
    /// What became of each of them.
    states: Vec<State>,
    /// Those that were changed, in turn.
    change_order: Vec<u32>,
    /// By vertex from the first that may go on: the first of its triangles in the list.
    firsts: Vec<u32>,
    /// Triangles by vertex that may go.
    triangles: Vec<u32>,
    /// Other triangles than in that list, by vertex.
    changed: FxHashMap<u32, Vec<u32>>,
    /// Neighbours by vertex onto which it cannot be moved as long as all stays as it is.
    refused: FxHashMap<u32, Vec<u32>>,
}

impl<'a> Collapsing<'a> {
    fn new(operands: &'a Operands<'a>, outcome: &'a mut Outcome, made: &'a NewTriangles) -> Collapsing<'a> {
        let new = &outcome.mesh.triangles[made.first..];
        let mut firsts = vec![0_u32; made.is_free.len() + 2];
        let numbered = |(vertex, corner): (&u32, u32)| Some((made.number(*vertex)?, corner));
        let corners = || new.as_flattened().iter().zip(0..).filter_map(numbered);
        corners().for_each(|(number, _)| firsts[number + 2] += 1);
        (2..firsts.len()).for_each(|k| firsts[k] += firsts[k - 1]);
        let mut triangles = vec![0; firsts.last().map_or(0, |n| *n as usize)];
        for (number, corner) in corners() {
            let place = &mut firsts[number + 1];
            triangles[*place as usize] = made.first as u32 + corner / 3;
            *place += 1;
        }
        let states = vec![State::Still; new.len()];
        let (changed, refused) = (FxHashMap::default(), FxHashMap::default());
        Collapsing {
            operands,
            outcome,
            new: made,
            largest: operands.largest(),
            sorted: OnceLock::new(),
            states,
            change_order: Vec::new(),
            firsts,
            triangles,
            changed,
            refused,
        }
    }

    fn candidates(&self) -> Vec<u32> {
        let vertices = self.new.first_vertex..self.outcome.mesh.vertices.len() as u32;
        vertices.filter(|vertex| self.new.number(*vertex).is_some()).collect()
    }

    /// The triangles at a vertex that may go.
    fn around(&self, vertex: u32) -> &[u32] {
        let listed = || {
            let Some(number) = self.new.number(vertex) else { return &[][..] };
            &self.triangles[self.firsts[number] as usize..self.firsts[number + 1] as usize]
        };
        self.changed.get(&vertex).map_or_else(listed, Vec::as_slice)
    }

    /// What may be done with some vertices, as far as the places of their neighbours tell.
    fn proposed(&self, vertices: &[u32]) -> Vec<Collapse> {
        let criteria = CollapseCriteria { operands: self.operands, outcome: self.outcome, largest: self.largest };
        let propose = |&vertex: &u32| {
            let around = self.around(vertex);
            let fan = criteria.may_collapse(vertex, around).then(|| criteria.fan(vertex, around))??;
            let refused = self.refused.get(&vertex).map_or(&[][..], Vec::as_slice);
            criteria.collapse(fan, |onto| refused.contains(&onto))
        };
        vertices.par_iter().with_min_len(256).filter_map(propose).collect()
    }

    /// Those that have no triangle in common, and the vertices of the others.
    fn independent(&self, proposed: Vec<Collapse>) -> (Vec<Collapse>, Vec<u32>) {
        let mut taken: FxHashSet<u32> = FxHashSet::default();
        let (mut chosen, mut left) = (Vec::new(), Vec::new());
        for collapse in proposed {
            let all = || collapse.gone.iter().chain(collapse.stay.iter().map(|(triangle, _)| triangle));
            if all().any(|triangle| taken.contains(triangle)) {
                left.push(collapse.vertex);
            } else {
                taken.extend(all().copied());
                chosen.push(collapse);
            }
        }
        (chosen, left)
    }

    fn named_triangle(&self, names: [u32; 3]) -> NamedTriangle {
        NamedTriangle { names, corners: names.map(|vertex| self.outcome.mesh.vertices[vertex as usize]) }
    }

    /// Whether each collapse leaves the surface simple, others of them done or not.
    fn verdicts(&self, chosen: &[Collapse]) -> Vec<Verdict> {
        let mesh = &self.outcome.mesh;
        let first = self.new.first;
        let mut new: Vec<New> = Vec::new();
        let mut of_triangle: FxHashMap<u32, u32> = FxHashMap::default();
        for (collapse, number) in chosen.iter().zip(0..) {
            of_triangle.extend(collapse.gone.iter().map(|triangle| (*triangle, number)));
            for &(triangle, corners) in &collapse.stay {
                of_triangle.insert(triangle, number);
                let tile = self.named_triangle(corners).with_plane();
                let from = mesh.vertices[collapse.vertex as usize];
                new.push(New { tile, from, vertex: collapse.vertex, collapse: number });
            }
        }
        let sorted = sorted_boxes(new.iter().map(New::bounds));
        let mut verdicts = vec![Verdict::Fine; chosen.len()];
        let own = sorted.pairs_within(|a, b| {
            let (one, two) = (&new[a as usize], &new[b as usize]);
            one.meets(two.tile.triangle()) || two.meets(one.tile.triangle())
        });
        // The later one waits.
        for [a, b] in own {
            let [a, b] = [a, b].map(|k| new[k as usize].collapse as usize);
            let verdict = &mut verdicts[a.max(b)];
            *verdict = if a == b { Verdict::Refused } else { Verdict::Waits.max(*verdict) };
        }
        let mut refuse = |pairs: Vec<[u32; 2]>| {
            pairs.into_iter().for_each(|[a, _]| verdicts[new[a as usize].collapse as usize] = Verdict::Refused);
        };
        let is_met = |a: u32, triangle: u32| {
            let one = &new[a as usize];
            of_triangle.get(&triangle) != Some(&one.collapse)
                && one.meets(&self.named_triangle(mesh.triangles[triangle as usize]))
        };
        refuse(self.near_still(&sorted, is_met));
        let is_left = |triangle: &u32| self.states[*triangle as usize - first] == State::Changed;
        let changed: Vec<u32> = self.change_order.iter().copied().filter(is_left).collect();
        let of_changed = sorted_boxes(changed.iter().map(|triangle| mesh.corners(*triangle as usize)));
        refuse(sorted.pairs_if(&of_changed.all(), |a, b| is_met(a, changed[b as usize])));
        let Some(kept) = &self.new.whole else { return verdicts };
        for operand in 0..self.operands.meshes().len() as u32 {
            let mesh = self.operands.meshes()[operand as usize];
            let [first_vertex, first] = [self.operands.first_vertex(operand), self.operands.first_triangle(operand)];
            let all = self.operands.sorted(operand).all();
            refuse(sorted.pairs_if(&all, |a, b| {
                let name = |vertex: u32| kept.of_vertex[(first_vertex + vertex) as usize];
                let corners = mesh.corners(b as usize);
                kept.contains(first + b)
                    && new[a as usize].meets(&NamedTriangle { names: mesh.triangles[b as usize].map(name), corners })
            }));
        }
        verdicts
    }

    /// Pairs of some boxes and new triangles that are still as they were, near each other, that `keep` accepts.
    fn near_still(&self, boxes: &TriangleBvh, keep: impl Fn(u32, u32) -> bool + Sync) -> Vec<[u32; 2]> {
        let first = self.new.first as u32;
        let mesh = &self.outcome.mesh;
        let is_still = |number: u32| self.states[number as usize] == State::Still;
        if boxes.count() > FEW {
            let all = || sorted_boxes((self.new.first..mesh.triangles.len()).map(|triangle| mesh.corners(triangle)));
            let sorted = self.sorted.get_or_init(all);
            return boxes.pairs_if(&sorted.all(), |a, b| is_still(b) && keep(a, first + b));
        }
        let mut pairs = Vec::new();
        for number in (0..self.states.len() as u32).filter(|number| is_still(*number)) {
            let triangle = first + number;
            boxes.touching(Bounds::of(mesh.corners(triangle as usize)), |a| {
                if keep(a, triangle) {
                    pairs.push([a, number]);
                }
            });
        }
        pairs
    }

    fn apply(&mut self, collapse: &Collapse) {
        let mesh = &mut self.outcome.mesh;
        for (&(triangle, corners), like) in collapse.stay.iter().zip(&collapse.like) {
            let place = |t: u32, vertex: u32| mesh.triangles[t as usize].iter().position(|v| *v == vertex).unwrap_or(0);
            let k = place(triangle, collapse.vertex);
            let from = like.map(|like| (like as usize, place(like, collapse.onto)));
            let slot = triangle as usize;
            if let Some((like, at)) = from {
                if !mesh.corner_normals.is_empty() {
                    mesh.corner_normals[slot][k] = mesh.corner_normals[like][at];
                }
                if !mesh.corner_parameters.is_empty() {
                    mesh.corner_parameters[slot][k] = mesh.corner_parameters[like][at];
                }
            }
            mesh.triangles[slot][k] = corners[0];
            if let state @ State::Still = &mut self.states[slot - self.new.first] {
                *state = State::Changed;
                self.change_order.push(triangle);
            }
        }
        collapse.gone.iter().for_each(|gone| self.states[*gone as usize - self.new.first] = State::Gone);
        let is_left = |triangle: &u32| !collapse.gone.contains(triangle);
        let mut ring: Vec<u32> = collapse.stay.iter().flat_map(|(_, corners)| *corners).collect();
        ring.sort_unstable();
        ring.dedup();
        for vertex in ring.into_iter().filter(|vertex| self.new.number(*vertex).is_some()) {
            let mut around: Vec<u32> = self.around(vertex).iter().copied().filter(is_left).collect();
            if vertex == collapse.onto {
                around.extend(collapse.stay.iter().map(|(triangle, _)| *triangle));
            }
            self.changed.insert(vertex, around);
            self.refused.remove(&vertex);
        }
        self.changed.insert(collapse.vertex, Vec::new());
    }

    /// Leaves out what is gone.
    fn finish(self) {
        if !self.states.contains(&State::Gone) {
            return;
        }
        let whole = std::iter::repeat_n(true, self.new.first);
        let keep: Vec<bool> = whole.chain(self.states.iter().map(|state| *state != State::Gone)).collect();
        retain(&mut self.outcome.mesh, &keep);
        let mut kept = keep.iter();
        self.outcome.sources.retain(|_| *kept.next().unwrap_or(&true));
        without_unused(&mut self.outcome.mesh.vertices, &mut self.outcome.mesh.triangles);
    }
}

/// Triangles sorted, by their corners, or boxes by two.
fn sorted_boxes<const N: usize>(corners: impl Iterator<Item = [DVec3; N]>) -> TriangleBvh {
    let vertices: Vec<DVec3> = corners.flatten().collect();
    let names = |first: u32| [first, first + 1, first + N as u32 - 1];
    let triangles: Vec<[u32; 3]> = (0..vertices.len() as u32).step_by(N).map(names).collect();
    TriangleBvh::new(&vertices, &triangles)
}

/// Leaves out vertices that no triangle has; the others stay in order.
fn without_unused(vertices: &mut Vec<DVec3>, triangles: &mut [[u32; 3]]) {
    let mut is_used = vec![false; vertices.len()];
    triangles.as_flattened().iter().for_each(|vertex| is_used[*vertex as usize] = true);
    let mut count = 0;
    let numbers: Vec<u32> = is_used
        .iter()
        .map(|used| {
            count += u32::from(*used);
            count.wrapping_sub(1)
        })
        .collect();
    triangles.as_flattened_mut().iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);
    let mut used = is_used.iter();
    vertices.retain(|_| *used.next().unwrap_or(&true));
}

/// What becomes of a collapse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    /// It is done.
    Fine,
    /// It may be done when others are.
    Waits,
    /// It cannot be done as all is.
    Refused,
}

/// A triangle as it is after a collapse.
struct New {
    tile: PlaneTriangle,
    /// The vertex that is moved to its first corner, and where that is before.
    vertex: u32,
    from: DVec3,
    collapse: u32,
}

impl New {
    /// The box of all that it sweeps over, as two corners.
    fn bounds(&self) -> [DVec3; 2] {
        let [a, b, c] = self.tile.triangle().corners;
        [a.min(b).min(c).min(self.from), a.max(b).max(c).max(self.from)]
    }

    /// Whether it has more in common with another triangle than corners and edges, is folded onto it, or has swept over
    /// a corner of it.
    fn meets(&self, other: &NamedTriangle) -> bool {
        nearly_overlap(&self.tile, other, || other.with_plane())
            || (0..3).any(|k| self.sweeps_over(other.names[k], other.corners[k]))
    }

    /// Whether a point is in the tetrahedron between the triangle and its former first corner.
    fn sweeps_over(&self, name: u32, p: DVec3) -> bool {
        let NamedTriangle { names, corners: [a, b, c] } = *self.tile.triangle();
        let v = self.from;
        if name == self.vertex || names.contains(&name) || [a, b, c, v].contains(&p) {
            return false;
        }
        let [low, high] = self.bounds();
        if p.cmplt(low).any() || p.cmpgt(high).any() {
            return false;
        }
        // Each face with its corners in an even order, so that a point within is on one side of all.
        let within = side(a, b, c, v);
        let faces = [[a, b, c], [a, c, v], [a, v, b], [b, v, c]];
        within != 0.0 && faces.into_iter().all(|[a, b, c]| side(a, b, c, p) * within >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::operand::{Operand, Operands};
    use super::super::single_evaluation::{Evaluation, evaluate_once};
    use super::super::{Expression, Outcome, quad_partners};
    use super::*;
    use crate::mesh::Mesh;
    use crate::solid::Solid;
    use crate::surface::{Sphere, Surface, Tolerance, box_faces, tessellate};
    use glam::DAffine3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Mesh {
        tessellate(&box_faces(low.into(), high.into()), Tolerance::new(1.0, 90.0)).unwrap()
    }

    fn vector(random: &mut Pcg64Mcg) -> DVec3 {
        DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0)))
    }

    fn some_turn(random: &mut Pcg64Mcg) -> DAffine3 {
        let axis = vector(random).normalize();
        DAffine3::from_axis_angle(axis, random.random_range(0.0..3.0))
    }

    /// All, the first less the others, what all have in common, and what is in an odd number.
    fn expressions(count: usize) -> [Expression; 4] {
        let all: Vec<Expression> = (0..count).map(Expression::Operand).collect();
        let less = Expression::difference(Expression::Operand(0), Expression::Union(all[1..].to_vec()));
        [
            Expression::Union(all.clone()),
            less,
            Expression::Intersection(all.clone()),
            Expression::SymmetricDifference(all),
        ]
    }

    fn counts(meshes: &[Mesh], by: DAffine3) -> [usize; 4] {
        let solids: Vec<Solid> = meshes.iter().map(|mesh| Solid::new(mesh.transformed(&by)).unwrap()).collect();
        let operands: Vec<&Solid> = solids.iter().collect();
        expressions(meshes.len()).map(|e| Solid::evaluate(&operands, &e).unwrap().0.mesh().triangles.len())
    }

    #[test]
    fn turned_boxes_have_the_triangles_that_their_corners_need() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        for _ in 0..20 {
            let by = some_turn(&mut random);
            // A corner in a corner: 7 corners of each, 1 and 1 inside the other, and 6 points where edges pierce faces.
            // A surface like a sphere has twice as many triangles as points, less four.
            let corners = [cuboid([0.0; 3], [1.0; 3]), cuboid([0.4, 0.5, 0.6], [1.5, 1.6, 1.7])];
            assert_eq!(counts(&corners, by), [36, 24, 12, 48], "{by}");
            // A plate and a bar through it: 16 points of what is like a torus, and 24 of the union.
            let plate = [cuboid([-1.0, -1.0, -0.01], [1.0, 1.0, 0.01]), cuboid([-0.3, -0.1, -1.0], [0.2, 0.5, 1.0])];
            let [union, less, common, _] = counts(&plate, by);
            assert_eq!([union, less, common], [44, 32, 12], "{by}");
        }
    }

    /// A solid of the kinds whose sides are flat but for roundings, with its surfaces.
    fn some_solid(random: &mut Pcg64Mcg) -> (Mesh, Vec<Box<dyn Surface>>) {
        let at = vector(random) * 0.5;
        if random.random_range(0..3) == 0 {
            let radius = random.random_range(0.3..0.8);
            let mesh = tessellate(&[Sphere::new(at, radius)], Tolerance::new(0.01, 90.0)).unwrap();
            return (mesh, vec![Box::new(Sphere::new(at, radius))]);
        }
        let size = DVec3::from([0; 3].map(|_| random.random_range(0.1..0.8)));
        let faces = box_faces(at - size, at + size);
        let surfaces = faces.into_iter().map(|face| Box::new(face) as Box<dyn Surface>).collect();
        (cuboid((at - size).into(), (at + size).into()), surfaces)
    }

    #[test]
    fn results_stay_simple_and_keep_volumes_surfaces_and_parameters() {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        let (mut before, mut after) = (0, 0);
        for round in 0..60 {
            let count = random.random_range(2..=4);
            let (meshes, turns): (Vec<_>, Vec<_>) =
                (0..count).map(|_| (some_solid(&mut random), some_turn(&mut random))).unzip();
            let (meshes, surfaces): (Vec<Mesh>, Vec<_>) = meshes.into_iter().unzip();
            let solids: Vec<Solid> =
                meshes.iter().zip(&turns).map(|(mesh, by)| Solid::new(mesh.transformed(by)).unwrap()).collect();
            let quad_partners: Vec<Vec<u32>> = solids.iter().map(|solid| quad_partners(solid.mesh())).collect();
            let operand = |k: usize| Operand {
                mesh: solids[k].mesh(),
                sorted: solids[k].sorted(),
                quad_partners: &quad_partners[k],
                overlaps: &[],
            };
            let operands = Operands::new((0..count).map(operand).collect(), true);
            for expression in expressions(count) {
                let Evaluation { outcome: old, new: made, self_intersects: must_settle, .. } =
                    evaluate_once(&operands, &expression);
                if must_settle {
                    continue;
                }
                let collapsed = |threads: usize| {
                    let mut outcome = old.clone();
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                    pool.install(|| collapse(&operands, &mut outcome, &made));
                    outcome
                };
                let new = collapsed(1);
                let other = collapsed(3);
                let Outcome { mesh, sources, .. } = &new;
                assert!(other.mesh == *mesh && other.sources == *sources, "{round}");
                before += old.mesh.triangles.len();
                after += mesh.triangles.len();
                let bound = 16.0 * f64::EPSILON * old.mesh.area();
                assert!((mesh.signed_volume() - old.mesh.signed_volume()).abs() <= bound, "{round} {expression:?}");
                assert_eq!(Solid::new(mesh.clone()).map(|s| s.mesh().triangles.len()), Ok(sources.len()), "{round}");
                // How far parameters are from where they say, at most.
                let gap = |outcome: &Outcome| {
                    let mut gap = [0.0_f64; 2];
                    for (triangle, [operand, source]) in outcome.sources.iter().enumerate() {
                        let operand = *operand as usize;
                        let surface = solids[operand].mesh().surfaces[*source as usize];
                        let first: u32 = surfaces[..operand].iter().map(|own| own.len() as u32).sum();
                        assert_eq!(outcome.mesh.surfaces[triangle], first + surface);
                        let own = &surfaces[operand][surface as usize];
                        let parameters = outcome.mesh.corner_parameters[triangle];
                        let gap = &mut gap[usize::from(surfaces[operand].len() == 1)];
                        for (place, uv) in outcome.mesh.corners(triangle).into_iter().zip(parameters) {
                            *gap = gap.max(turns[operand].transform_point3(own.point(uv)).distance(place));
                        }
                    }
                    gap
                };
                let ([flat, round_gap], [_, most]) = (gap(&new), gap(&old));
                assert!(
                    flat <= 1e-14 && round_gap <= most + 1e-14,
                    "{round} {expression:?}: {flat} {round_gap} {most}"
                );
            }
        }
        assert!(after * 100 < before * 97, "{before} {after}");
    }
}
