//! Space colonisation: branches grow towards points of a crown until these are reached.

use super::crown::CrownShape;
use crate::numeric::sampling::{RandomStream, mix};
use glam::{DVec3, IVec3};
use rustc_hash::FxHashMap;

/// Most nodes of a skeleton.
const MOST_NODES: usize = 1 << 18;
/// Part of the direction of a node that its next one keeps.
const INERTIA: f64 = 0.35;
/// Two nodes that grow from one are apart by the sine of this angle at the least: else the second stays away.
const LEAST_TURN: f64 = 0.1;

/// How a crown is filled by space colonisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colonisation {
    /// Points in the crown that attract branches, 1 to 100,000.
    pub points: u32,
    /// Largest radius of the crown, in parts of the height.
    pub width: f64,
    /// Length of a piece of a branch, in parts of the height.
    pub step: f64,
    /// How far points attract, in steps.
    pub reach: f64,
    /// How near a branch is when a point is reached, in steps.
    pub kill: f64,
    /// Exponent of the pipe model: the radius to this power is the sum of those of the branches it bears.
    pub exponent: f64,
    /// How strongly branches bend up, or down below 0.
    pub tropism: f64,
}

/// A node of a skeleton.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkeletonNode {
    pub position: DVec3,
    /// The node from which it grew, before it in the list; itself, if it is the first.
    pub parent: u32,
}

/// Points or nodes by the cells of a grid.
struct CellGrid {
    side: f64,
    cells: FxHashMap<IVec3, Vec<u32>>,
}

impl CellGrid {
    fn cell(&self, at: DVec3) -> IVec3 {
        (at / self.side).floor().as_ivec3()
    }

    fn insert(&mut self, at: DVec3, number: u32) {
        self.cells.entry(self.cell(at)).or_default().push(number);
    }

    /// What is in the cell of a place and in those around it.
    fn around(&self, at: DVec3) -> impl Iterator<Item = u32> + '_ {
        let middle = self.cell(at);
        let offsets = (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| IVec3::new(x, y, z))));
        offsets.filter_map(move |offset| self.cells.get(&(middle + offset))).flatten().copied()
    }
}

/// The skeleton of a tree.
///
/// - `height`: of the tree, units of length. `base`: the part of it below the crown.
///
/// # Source
/// Runions, Lane and Prusinkiewicz 2007, "Modeling Trees with a Space Colonization Algorithm".
pub(super) fn skeleton(
    colonisation: &Colonisation,
    shape: CrownShape,
    height: f64,
    base: f64,
    seed: u32,
) -> Vec<SkeletonNode> {
    let step = colonisation.step * height;
    let (reach, kill) = (colonisation.reach * step, colonisation.kill * step);
    let points = crown_points(colonisation, shape, height, base, seed);
    let mut attracting = CellGrid { side: reach, cells: FxHashMap::default() };
    points.iter().enumerate().for_each(|(number, point)| attracting.insert(*point, number as u32));
    // For each point the nearest node within reach, and how far that is; none once it is reached.
    let mut nearest: Vec<Option<(f64, u32)>> = vec![Some((reach, u32::MAX)); points.len()];
    let mut nodes: Vec<SkeletonNode> = Vec::new();
    let add = |nodes: &mut Vec<SkeletonNode>, nearest: &mut [Option<(f64, u32)>], position: DVec3, parent: u32| {
        let number = nodes.len() as u32;
        nodes.push(SkeletonNode { position, parent });
        for point in attracting.around(position) {
            let distance = points[point as usize].distance(position);
            let Some((least, node)) = &mut nearest[point as usize] else { continue };
            if distance < kill {
                nearest[point as usize] = None;
            } else if distance < *least {
                (*least, *node) = (distance, number);
            }
        }
    };
    add(&mut nodes, &mut nearest, DVec3::ZERO, 0);
    // The trunk, up to where the crown begins.
    let mut random = RandomStream::new(mix(u64::from(seed)), 11);
    while nodes[nodes.len() - 1].position.y < base * height && nodes.len() < MOST_NODES {
        let parent = nodes.len() as u32 - 1;
        let aside = DVec3::new(random.uniform() - 0.5, 0.0, random.uniform() - 0.5) * 0.15;
        let above = nodes[parent as usize].position + (DVec3::Y + aside).normalize() * step;
        add(&mut nodes, &mut nearest, above, parent);
    }
    let mut children: Vec<Vec<DVec3>> = vec![Vec::new(); nodes.len()];
    while nodes.len() < MOST_NODES {
        // The sum of the directions to the points that a node attracts most.
        let mut pulls: FxHashMap<u32, DVec3> = FxHashMap::default();
        for (point, state) in points.iter().zip(&nearest) {
            if let Some((_, node)) = state
                && *node != u32::MAX
            {
                let towards = (*point - nodes[*node as usize].position).normalize_or_zero();
                *pulls.entry(*node).or_insert(DVec3::ZERO) += towards;
            }
        }
        let mut pulled: Vec<(u32, DVec3)> = pulls.into_iter().collect();
        pulled.sort_unstable_by_key(|(node, _)| *node);
        let before = nodes.len();
        for (node, pull) in pulled {
            let SkeletonNode { position, parent } = nodes[node as usize];
            let own = (position - nodes[parent as usize].position).normalize_or(DVec3::Y);
            let bent = pull.normalize_or(own) + own * INERTIA + DVec3::Y * colonisation.tropism;
            let ahead = bent.normalize_or(own);
            if children[node as usize]
                .iter()
                .any(|other| other.cross(ahead).length() < LEAST_TURN && other.dot(ahead) > 0.0)
            {
                continue;
            }
            children[node as usize].push(ahead);
            add(&mut nodes, &mut nearest, position + ahead * step, node);
            children.push(Vec::new());
        }
        if nodes.len() == before {
            break;
        }
    }
    nodes
}

/// Points spread evenly over the crown.
fn crown_points(colonisation: &Colonisation, shape: CrownShape, height: f64, base: f64, seed: u32) -> Vec<DVec3> {
    let mut random = RandomStream::new(mix(u64::from(seed)), 10);
    let radius = colonisation.width * height;
    let mut points = Vec::with_capacity(colonisation.points as usize);
    // The crown takes a good part of the cylinder around it.
    for _ in 0..64 * u64::from(colonisation.points) {
        if points.len() == colonisation.points as usize {
            break;
        }
        let [x, y, z] = [(); 3].map(|()| random.uniform());
        let at = DVec3::new(2.0 * x - 1.0, y, 2.0 * z - 1.0);
        if at.x.hypot(at.z) <= shape.ratio(1.0 - y) {
            points.push(DVec3::new(at.x * radius, (base + (1.0 - base) * y) * height, at.z * radius));
        }
    }
    points
}
