//! Instances and the index above them.

use super::super::bvh::{DIGITS, radix_sorted};
use super::super::cube::Cube;
use super::super::items::Item;
use super::super::lanes::LANES;
use super::super::partition::ItemGroup;
use super::super::wide_bvh::{BvhNode, CellGroup, Child, divide_cells};
use super::super::{LocationalCode, MAX_DEPTH, Octree};
use super::blocks::Placements;
use super::error::{InstanceError, MOST_INSTANCES, MOST_LEVELS, MOST_PROTOTYPES};
use super::path::{InstancePath, PlacedSurface};
use super::placement::{Instance, PlacementForm, PrototypeSphere, longest, rounded};
use crate::memory;
use crate::numeric::bounds::Bounds;
use glam::{DAffine3, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::Arc;
use wide::f32x4;

/// So many instances or fewer are a leaf.
const LEAF: usize = LANES;
/// Fills leaves that are not full.
const NONE: u32 = u32::MAX;
/// Of neighbours in the order of their codes, at least so many are in a cell in the mean.
const CELL: usize = 16;
/// Groups of cells that are divided at once: more would take more memory.
const BATCH: usize = 64;
/// Bytes of nodes for each instance, at the most.
const NODE_BYTES: usize = 16;
/// A sphere is so much larger than it would be without rounding.
const SPHERE_ROUNDING: f64 = 1e-9;
/// The cube of positions reaches this part of the radius of an instance about each.
const POSITION_MARGIN: f64 = 1.0 / 65_536.0;
/// A placement flattens if the volume of a unit cube becomes this part of the cube of its longest edge.
const FLAT: f64 = 1e-12;
/// Edges of a cube that is rotated and scaled are as long and as upright to each other as this.
const SIMILAR: f64 = 1e-6;

/// What instances place.
#[derive(Clone, Debug)]
pub struct Prototype {
    pub(super) content: Content,
    bounds: Bounds,
    sphere: PrototypeSphere,
    /// How many times over it is made of instances.
    levels: usize,
}

#[derive(Clone, Debug)]
pub(super) enum Content {
    /// Hits name its triangles by their numbers from `first` on.
    Surface {
        octree: Arc<Octree>,
        first: u32,
    },
    Instances(Arc<InstanceOctree>),
}

impl Prototype {
    /// A surface.
    ///
    /// - `first`: the number by which hits name its first triangle, where triangles of several surfaces are told apart.
    pub fn surface(octree: Arc<Octree>, first: u32) -> Prototype {
        let bounds = Bounds::of(octree.triangles.iter().flatten().map(|vertex| octree.vertices[*vertex as usize]));
        let corners = octree.triangles.iter().flatten().map(|vertex| octree.vertices[*vertex as usize]);
        let radius = corners.map(|corner| corner.distance(bounds.center())).fold(0.0, f64::max);
        Prototype::new(Content::Surface { octree, first }, bounds, radius, 0)
    }

    /// Instances.
    pub fn instances(instances: Arc<InstanceOctree>) -> Prototype {
        let (bounds, levels) = (instances.bounds, instances.levels);
        Prototype::new(Content::Instances(instances), bounds, 0.5 * bounds.diagonal(), levels)
    }

    fn new(content: Content, bounds: Bounds, radius: f64, levels: usize) -> Prototype {
        let sphere = match bounds.is_empty() {
            true => PrototypeSphere { center: DVec3::ZERO, radius: 0.0 },
            false => PrototypeSphere {
                center: bounds.center(),
                radius: ((radius * (1.0 + SPHERE_ROUNDING)) as f32).next_up(),
            },
        };
        Prototype { content, bounds, sphere, levels }
    }

    /// Adds its placements to a checksum; a surface has none.
    pub fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        if let Content::Instances(instances) = &self.content {
            instances.add_to_checksum(sum);
        }
    }

    /// How many triangles it is made of, each as often as it is placed.
    fn triangles(&self) -> u64 {
        match &self.content {
            Content::Surface { octree, .. } => octree.triangle_count() as u64,
            Content::Instances(instances) => instances.triangles,
        }
    }

    /// The box around it, in its own coordinates; empty without triangles.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }
}

/// An octree over instances. Threads share it freely.
#[derive(Clone, Debug)]
pub struct InstanceOctree {
    pub(super) prototypes: Vec<Prototype>,
    /// Of the prototypes.
    pub(super) spheres: Vec<PrototypeSphere>,
    /// Around all positions.
    pub(super) positions: Cube,
    pub(super) placements: Placements,
    /// Around all instances.
    pub(super) cube: Cube,
    pub(super) nodes: Vec<BvhNode>,
    bounds: Bounds,
    count: usize,
    /// Triangles that are placed.
    triangles: u64,
    /// How many times over instances are placed by instances.
    levels: usize,
}

/// What an instance octree says of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct InstanceCosts {
    /// Instances that are kept, each of which may place many more.
    pub instances: usize,
    /// Bytes of their placements and of the index, without what is placed.
    pub bytes: usize,
    /// Triangles that are placed, each as often as it is; as many as can be counted.
    pub triangles: u64,
}

impl InstanceOctree {
    /// Places instances.
    ///
    /// Instances of empty prototypes are left out. The result is the same for any number of threads. Cost: as
    /// n log n; beside the result, 16 bytes each for a while.
    ///
    /// - `count`: of instances. `instance`: tells them by number; it is asked several times for the same, and may not
    ///   change its mind.
    ///
    /// # Errors
    /// [`InstanceError`]. Of several instances that cannot be placed it tells the first, but those that only rounding spoils
    /// come last.
    pub fn new(
        prototypes: Vec<Prototype>,
        form: PlacementForm,
        count: usize,
        instance: impl Fn(usize) -> Instance + Sync,
    ) -> Result<InstanceOctree, InstanceError> {
        if prototypes.len() > MOST_PROTOTYPES {
            return Err(InstanceError::TooManyPrototypes { prototypes: prototypes.len() });
        }
        if count > MOST_INSTANCES {
            return Err(InstanceError::TooManyInstances { instances: count });
        }
        let levels = 1 + prototypes.iter().map(|prototype| prototype.levels).max().unwrap_or(0);
        if levels > MOST_LEVELS {
            return Err(InstanceError::TooManyLevels { levels });
        }
        let bytes = count * (form.bytes() + NODE_BYTES + 2 * size_of::<u64>());
        memory::reserve(bytes as u64, || format!("placing {count} instances"))?;
        let spheres: Vec<PrototypeSphere> = prototypes.iter().map(|prototype| prototype.sphere).collect();
        let mut builder = Builder {
            prototypes: &prototypes,
            spheres: &spheres,
            form,
            positions: EMPTY,
            cube: EMPTY,
            instance: &instance,
            keys: Vec::new(),
        };
        let instances = 0..count;
        if let Some(error) = instances.clone().into_par_iter().find_map_first(|number| builder.check(number).err()) {
            return Err(error);
        }
        let position = |number| builder.around_center(&instance(number));
        builder.positions = cube_around(union(instances.clone().into_par_iter().map(position)));
        let spoilt = |number| builder.check_rounded(number).err();
        if let Some(error) = instances.clone().into_par_iter().find_map_first(spoilt) {
            return Err(error);
        }
        let bounds = union(instances.into_par_iter().map(|number| builder.bounds(number)));
        builder.cube = cube_around(bounds);
        builder.sort(count);
        let (nodes, placements) = builder.index();
        let (positions, cube, count) = (builder.positions, builder.cube, builder.keys.len());
        let triangles = placements.prototypes().map(|of| prototypes[usize::from(of)].triangles());
        let triangles = triangles.fold(0_u64, u64::saturating_add);
        Ok(InstanceOctree { prototypes, spheres, positions, placements, cube, nodes, bounds, count, triangles, levels })
    }

    /// The box around all instances; empty without any.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Number of instances, those of empty prototypes left out.
    pub fn count(&self) -> usize {
        self.count
    }

    /// An instance as it is kept; the number is that of an [`InstancePath`]. None if there is none of this number.
    pub fn instance(&self, number: u32) -> Option<Instance> {
        self.placements.get(&self.positions, &self.spheres, number as usize)
    }

    /// All instances as they are kept, with their numbers.
    pub fn instances(&self) -> impl Iterator<Item = (u32, Instance)> + '_ {
        (0..(self.placements.blocks() * LANES) as u32).filter_map(|number| Some((number, self.instance(number)?)))
    }

    /// How the surface at the end of a path of this octree is placed.
    pub fn placed(&self, path: &InstancePath) -> PlacedSurface {
        let mut octree = self;
        let mut placed = PlacedSurface { placement: DAffine3::IDENTITY, variation: 0, largest: 0.0 };
        for number in path.numbers() {
            let Some(Instance { prototype, variation, placement }) = octree.instance(*number) else { break };
            let outer = placed.placement;
            placed.largest += longest(&outer.matrix3) * placement.translation.length();
            placed.placement = outer * placement;
            if let Content::Instances(inner) = &octree.prototypes[usize::from(prototype)].content {
                octree = inner;
            }
            placed.variation = placed.variation.wrapping_add(variation);
        }
        placed
    }

    /// Adds all placements to a checksum, those within prototypes too, as they are kept.
    pub fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        for (_, Instance { prototype, variation, placement }) in self.instances() {
            [prototype, variation].iter().for_each(|number| sum.update(&number.to_le_bytes()));
            placement.to_cols_array().iter().for_each(|number| sum.update(&number.to_le_bytes()));
        }
        self.prototypes.iter().for_each(|prototype| prototype.add_to_checksum(sum));
    }

    /// What it costs, without the instances that its prototypes may be made of.
    pub fn costs(&self) -> InstanceCosts {
        let bytes = self.placements.bytes() + size_of_val(self.nodes.as_slice());
        InstanceCosts { instances: self.count, bytes, triangles: self.triangles }
    }
}

/// The cube around nothing.
const EMPTY: Cube = Cube { origin: DVec3::ZERO, side: 1.0 };

/// The cube around a box.
fn cube_around(bounds: Bounds) -> Cube {
    if bounds.is_empty() { EMPTY } else { Cube::around(bounds.min, bounds.max) }
}

/// The box around some boxes.
fn union(boxes: impl ParallelIterator<Item = Bounds>) -> Bounds {
    boxes.reduce(|| Bounds::EMPTY, Bounds::union)
}

struct Builder<'b, F> {
    prototypes: &'b [Prototype],
    spheres: &'b [PrototypeSphere],
    form: PlacementForm,
    positions: Cube,
    cube: Cube,
    instance: &'b F,
    /// In the upper halves the codes of the middles of instances, in the lower ones their numbers.
    keys: Vec<u64>,
}

impl<F: Fn(usize) -> Instance + Sync> Builder<'_, F> {
    fn check(&self, number: usize) -> Result<(), InstanceError> {
        let Instance { prototype, placement, .. } = (self.instance)(number);
        if usize::from(prototype) >= self.prototypes.len() {
            let prototypes = self.prototypes.len();
            return Err(InstanceError::UnknownPrototype { instance: number, prototype, prototypes });
        }
        if !placement.is_finite() {
            return Err(InstanceError::NotFinite { instance: number });
        }
        let [x, y, z] = [placement.matrix3.x_axis, placement.matrix3.y_axis, placement.matrix3.z_axis];
        let longest = x.length().max(y.length()).max(z.length());
        // Divided first, so that no product is too small or too large.
        let [x, y, z] = [x, y, z].map(|axis| axis / longest);
        let volume = x.dot(y.cross(z)).abs();
        // Written so that what is not a number is flat.
        let is_solid = volume > FLAT;
        if !is_solid {
            return Err(InstanceError::Flat { instance: number });
        }
        if self.form == PlacementForm::Similar {
            let is_even = [x, y, z].iter().all(|axis| axis.length() > 1.0 - SIMILAR);
            let is_upright = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|cosine| cosine.abs() < SIMILAR);
            let is_within = longest.log2().abs() <= super::placement::MOST_OCTAVES;
            if !(is_even && is_upright && is_within) {
                return Err(InstanceError::NotSimilar { instance: number });
            }
        }
        Ok(())
    }

    /// What rounding makes of an instance may be too large or too small.
    fn check_rounded(&self, number: usize) -> Result<(), InstanceError> {
        let (rounded, bounds) = (self.rounded(number).placement, self.bounds(number));
        if !(rounded.is_finite() && (bounds.is_empty() || bounds.min.is_finite() && bounds.max.is_finite())) {
            return Err(InstanceError::NotFinite { instance: number });
        }
        let determinant = rounded.matrix3.determinant();
        if determinant == 0.0 || !rounded.inverse().is_finite() {
            return Err(InstanceError::Flat { instance: number });
        }
        Ok(())
    }

    /// Where the centre of the sphere of an instance is.
    fn center(&self, instance: &Instance) -> DVec3 {
        instance.placement.transform_point3(self.spheres[usize::from(instance.prototype)].center)
    }

    /// A box around the centre of the sphere of an instance, so small a part of it that positions are rounded to less than
    /// the digits of the sphere, and so large that these are numbers of single precision, in sides of it.
    fn around_center(&self, instance: &Instance) -> Bounds {
        let radius = f64::from(self.spheres[usize::from(instance.prototype)].radius);
        let margin = DVec3::splat(radius * longest(&instance.placement.matrix3) * POSITION_MARGIN);
        let center = self.center(instance);
        Bounds { min: center - margin, max: center + margin }
    }

    fn rounded(&self, number: usize) -> Instance {
        let instance = (self.instance)(number);
        rounded(self.form, &self.positions, &instance, self.spheres[usize::from(instance.prototype)].center)
    }

    /// The box around an instance.
    fn bounds(&self, number: usize) -> Bounds {
        let Instance { prototype, placement, .. } = self.rounded(number);
        match self.prototypes[usize::from(prototype)].bounds {
            own if own.is_empty() => own,
            own => Bounds::of(own.corners().map(|corner| placement.transform_point3(corner))),
        }
    }

    /// Sorts the instances that have a box.
    fn sort(&mut self, count: usize) {
        let key = |number: usize| {
            let bounds = self.bounds(number);
            let voxel = self.cube.voxel(bounds.center()).unwrap_or([(1 << MAX_DEPTH) - 1; 3]);
            let code = LocationalCode::containing(voxel, DIGITS).bits() >> (64 - 3 * DIGITS);
            (!bounds.is_empty()).then_some(code << 32 | number as u64)
        };
        self.keys = radix_sorted((0..count).into_par_iter().filter_map(key).collect());
    }

    fn item(&self, key: u64) -> Item {
        let number = key as u32;
        let bounds = self.bounds(number as usize);
        let corner = |at: DVec3| {
            let [x, y, z] = self.cube.local(at).as_vec3().to_array();
            f32x4::new([x, y, z, 0.0])
        };
        Item { low: corner(bounds.min), high: corner(bounds.max) }.numbered(number, 1)
    }

    /// Runs of instances in one cell each, as large as there may be many of; each with its first place as its number.
    fn cells(&self) -> Vec<Item> {
        // At each level, in how many cells the instances lie.
        let mut cells = [0_usize; DIGITS as usize + 1];
        let digits = |pair: &[u64]| {
            let apart = (pair[0] ^ pair[1]) >> 32;
            (apart.leading_zeros() - (64 - 3 * DIGITS)) / 3
        };
        self.keys.windows(2).for_each(|pair| cells[digits(pair).min(DIGITS) as usize] += 1);
        let mut count = 1;
        let of_level = |level: usize| {
            count += cells[level];
            count
        };
        let counts: Vec<usize> = (0..DIGITS as usize).map(of_level).collect();
        let level = 1 + counts.iter().rposition(|count| *count <= self.keys.len() / CELL).unwrap_or(0) as u32;
        let cell = |key: &u64| key >> 32 >> (3 * (DIGITS - level));
        let mut runs: Vec<(usize, usize)> = Vec::with_capacity(counts[level as usize - 1]);
        let mut first = 0;
        for run in self.keys.chunk_by(|one, other| cell(one) == cell(other)) {
            runs.push((first, run.len()));
            first += run.len();
        }
        let around = |&(first, count): &(usize, usize)| {
            let keys = &self.keys[first..first + count];
            let around = keys.iter().fold(Item::EMPTY, |all, key| all.union(&self.item(*key)));
            around.numbered(first as u32, count as u32)
        };
        runs.par_iter().map(around).collect()
    }

    fn index(&self) -> (Vec<BvhNode>, Placements) {
        let mut nodes = Vec::new();
        let mut placements = Placements::with_capacity(self.form, self.keys.len());
        if self.keys.is_empty() {
            return (nodes, placements);
        }
        let mut cells = self.cells();
        let mut groups = Vec::new();
        let all = ItemGroup::of(&cells);
        divide_cells(&mut cells, &all, LEAF, &mut nodes, &mut groups);
        for batch in groups.chunks(BATCH) {
            let below = |CellGroup { cells, .. }: &CellGroup<'_>| {
                let numbers = cells.iter().flat_map(|cell| {
                    let first = cell.number() as usize;
                    &self.keys[first..first + cell.weight()]
                });
                let mut items: Vec<Item> = numbers.map(|key| self.item(*key)).collect();
                let mut index = GroupIndex::default();
                divide_items(&mut items, &mut index);
                index
            };
            let made: Vec<GroupIndex> = batch.par_iter().map(below).collect();
            for (made, CellGroup { place, .. }) in made.into_iter().zip(batch) {
                let (above, before) = (nodes.len(), placements.blocks());
                nodes.extend(made.nodes.into_iter().map(|mut node| {
                    node.children = node.children.map(|child| child.moved(above, before));
                    node
                }));
                for leaf in &made.leaves {
                    let numbers = leaf.iter().filter(|number| **number != NONE);
                    let instances = numbers.map(|number| (self.instance)(*number as usize));
                    placements.push(&self.positions, self.spheres, instances);
                }
                if let Some(place) = place {
                    place.attach(&mut nodes, Child(above as u32));
                }
            }
        }
        nodes.shrink_to_fit();
        (nodes, placements)
    }
}

/// The nodes of some instances, and the numbers of these, leaf by leaf.
#[derive(Default)]
struct GroupIndex {
    nodes: Vec<BvhNode>,
    leaves: Vec<[u32; LEAF]>,
}

/// Adds the nodes of some instances.
fn divide_items(items: &mut [Item], index: &mut GroupIndex) {
    let node = index.nodes.len();
    index.nodes.push(BvhNode::EMPTY);
    for (lane, share) in full_shares(items).into_iter().enumerate() {
        let around = share.iter().fold(Item::EMPTY, |all, item| all.union(item));
        let child = if share.len() > LEAF {
            let child = Child(index.nodes.len() as u32);
            divide_items(share, index);
            child
        } else {
            let place = index.leaves.len();
            let mut leaf = [NONE; LEAF];
            leaf.iter_mut().zip(share.iter()).for_each(|(number, item)| *number = item.number());
            index.leaves.push(leaf);
            Child::leaf(place..place + 1)
        };
        index.nodes[node].set(lane, &around, child);
    }
}

/// Divides items for the lanes of a node, so that nearly all leaves and nodes below are full.
///
/// A full tree of eight lanes a node holds [`LEAF`] times a power of eight. The largest part is divided again and again,
/// always behind a multiple of the largest such number that is less than all items.
fn full_shares(items: &mut [Item]) -> Vec<&mut [Item]> {
    let mut unit = LEAF;
    while unit * LANES < items.len() {
        unit *= LANES;
    }
    let mut parts = vec![items];
    while parts.len() < LANES {
        let area = |part: &&mut [Item]| part.iter().fold(Item::EMPTY, |all, item| all.union(item)).half_area();
        let large = parts.iter().enumerate().filter(|(_, part)| part.len() > unit);
        let Some((largest, _)) = large.max_by(|(_, one), (_, other)| area(one).total_cmp(&area(other))) else { break };
        let part = std::mem::take(&mut parts[largest]);
        let first = divided(part, unit);
        let (first, second) = part.split_at_mut(first);
        parts[largest] = first;
        parts.insert(largest + 1, second);
    }
    parts
}

/// Sorts items along an axis and tells where to divide them: behind a multiple of a number, where the sum of the areas
/// of both boxes, each times the items in it, is least.
fn divided(items: &mut [Item], unit: usize) -> usize {
    let along = |axis: usize| {
        move |one: &Item, other: &Item| {
            let [one_at, other_at] = [one, other].map(|item| item.centre().as_array()[axis]);
            one_at.total_cmp(&other_at).then(one.number().cmp(&other.number()))
        }
    };
    let mut best = (f32::INFINITY, 0, unit);
    for axis in 0..3 {
        items.sort_unstable_by(along(axis));
        let mut prices = vec![0.0; items.len()];
        let mut after = Item::EMPTY;
        for place in (1..items.len()).rev() {
            after = after.union(&items[place]);
            prices[place] = after.half_area() * (items.len() - place) as f32;
        }
        let mut before = Item::EMPTY;
        for place in 1..items.len() {
            before = before.union(&items[place - 1]);
            let price = before.half_area() * place as f32 + prices[place];
            if place % unit == 0 && price < best.0 {
                best = (price, axis, place);
            }
        }
    }
    items.sort_unstable_by(along(best.1));
    best.2
}
