//! Instances that are stored, and the index above them.

use super::super::bvh::{DIGITS, radix_sorted};
use super::super::cube::Cube;
use super::super::items::Item;
use super::super::lanes::LANES;
use super::super::partition::ItemGroup;
use super::super::wide_bvh::{BvhNode, CellGroup, Child, divide_cells};
use super::super::{LocationalCode, MAX_DEPTH};
use super::blocks::Placements;
use super::error::InstanceError;
use super::placement::{Instance, PlacementForm, PrototypeSphere, longest, rounded};
use crate::memory;
use crate::numeric::bounds::Bounds;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
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
/// The cube of positions reaches this part of the radius of an instance about each.
const POSITION_MARGIN: f64 = 1.0 / 65_536.0;
/// A placement flattens if the volume of a unit cube becomes this part of the cube of its longest edge.
const FLAT: f64 = 1e-12;
/// Edges of a cube that is rotated and scaled are as long and as upright to each other as this.
const SIMILAR: f64 = 1e-6;
/// A box is so much larger than it would be without rounding, parts of its largest coordinates.
const ROUNDING: f64 = 1e-14;
/// Of so many instances or fewer, each is told once and kept until all are placed: 29 MB.
const FEW: usize = 1 << 18;
/// Of so many instances or fewer, the boxes are kept until all are placed: 200 MB.
const BOXED: usize = 1 << 22;

/// How large prototypes are, by their numbers.
#[derive(Clone, Debug)]
pub(super) struct Extents {
    /// The boxes around them, in their own coordinates; an empty one places nothing.
    pub(super) boxes: Vec<Bounds>,
    pub(super) spheres: Vec<PrototypeSphere>,
}

/// Placements in blocks of eight, and a wide BVH over their boxes.
#[derive(Clone, Debug)]
pub(super) struct StoredInstances {
    /// Around all positions.
    pub(super) positions: Cube,
    pub(super) placements: Placements,
    /// Around all instances.
    pub(super) cube: Cube,
    pub(super) nodes: Vec<BvhNode>,
    pub(super) bounds: Bounds,
    pub(super) count: usize,
}

impl StoredInstances {
    /// Stores instances by as many threads as there are.
    ///
    /// Instances of empty prototypes are left out. The result is the same for any number of threads. Cost: as
    /// n log n; beside the result, 16 to 176 bytes each for a while, the fewer
    /// the more.
    ///
    /// # Errors
    /// [`InstanceError`], see [`super::InstanceOctree::new`].
    pub(super) fn new(
        extents: &Extents,
        form: PlacementForm,
        count: usize,
        instance: &(impl Fn(usize) -> Instance + Sync),
    ) -> Result<StoredInstances, InstanceError> {
        let bytes = count * (form.bytes() + NODE_BYTES + 2 * size_of::<u64>());
        memory::reserve(bytes as u64, || format!("placing {count} instances"))?;
        if count > FEW {
            return StoredInstances::built(extents, form, count, instance);
        }
        let all: Vec<Instance> = (0..count).into_par_iter().map(instance).collect();
        StoredInstances::built(extents, form, count, &|number: usize| all[number])
    }

    fn built(
        extents: &Extents,
        form: PlacementForm,
        count: usize,
        instance: &(impl Fn(usize) -> Instance + Sync),
    ) -> Result<StoredInstances, InstanceError> {
        let mut builder = Builder::new(extents, form, instance);
        let instances = 0..count;
        if let Some(error) = instances.clone().into_par_iter().find_map_first(|number| builder.check(number).err()) {
            return Err(error);
        }
        let position = |number| builder.around_center(&instance(number));
        builder.positions = cube_around(union(instances.clone().into_par_iter().map(position)));
        if count <= BOXED {
            let boxes = instances.clone().into_par_iter().map(|number| builder.check_rounded(number));
            builder.boxes = boxes.collect::<Vec<_>>().into_iter().collect::<Result<Vec<Bounds>, InstanceError>>()?;
        } else {
            let spoilt = |number| builder.check_rounded(number).err();
            if let Some(error) = instances.clone().into_par_iter().find_map_first(spoilt) {
                return Err(error);
            }
        }
        let bounds = union(instances.into_par_iter().map(|number| builder.bounds(number)));
        builder.cube = cube_around(bounds);
        builder.sort(count);
        let (nodes, placements) = builder.index();
        let (positions, cube, count) = (builder.positions, builder.cube, builder.keys.len());
        Ok(StoredInstances { positions, placements, cube, nodes, bounds, count })
    }

    /// Stores instances by this thread alone, those left out that cannot be placed: while a ray waits for them, no other
    /// work may come between.
    pub(super) fn of_part(extents: &Extents, form: PlacementForm, instances: &[Instance]) -> StoredInstances {
        let instance = |number: usize| instances[number];
        let mut builder = Builder::new(extents, form, &instance);
        let mut numbers: Vec<usize> = (0..instances.len()).filter(|number| builder.check(*number).is_ok()).collect();
        let around = numbers.iter().map(|number| builder.around_center(&instances[*number]));
        builder.positions = cube_around(around.fold(Bounds::EMPTY, Bounds::union));
        let mut boxes = vec![Bounds::EMPTY; instances.len()];
        numbers.retain(|number| {
            boxes[*number] = builder.check_rounded(*number).unwrap_or(Bounds::EMPTY);
            !boxes[*number].is_empty()
        });
        let bounds = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        (builder.cube, builder.boxes) = (cube_around(bounds), boxes);
        let mut placements = Placements::with_capacity(form, numbers.len());
        let mut index = GroupIndex::default();
        if !numbers.is_empty() {
            let mut items: Vec<Item> = numbers.iter().map(|number| builder.item(*number as u64)).collect();
            divide_items(&mut items, &mut index);
        }
        for leaf in &index.leaves {
            let numbers = leaf.iter().filter(|number| **number != NONE);
            placements.push(&builder.positions, &extents.spheres, numbers.map(|number| instances[*number as usize]));
        }
        index.nodes.shrink_to_fit();
        let (positions, cube, count) = (builder.positions, builder.cube, numbers.len());
        StoredInstances { positions, placements, cube, nodes: index.nodes, bounds, count }
    }

    /// How many bytes a placement and the index take at the most, beside what is stored for a while.
    pub(super) fn most_bytes(form: PlacementForm) -> usize {
        form.bytes() + NODE_BYTES
    }

    /// Bytes of the placements and of the index.
    pub(super) fn bytes(&self) -> usize {
        self.placements.bytes() + size_of_val(self.nodes.as_slice())
    }

    /// How often each prototype is placed.
    pub(super) fn prototypes(&self) -> impl Iterator<Item = u16> + '_ {
        self.placements.prototypes()
    }

    /// How many places there are, some of which are empty.
    pub(super) fn places(&self) -> u32 {
        (self.placements.blocks() * LANES) as u32
    }

    /// An instance as it is kept, by its place; none if there is none.
    pub(super) fn instance(&self, extents: &Extents, place: u32) -> Option<Instance> {
        self.placements.get(&self.positions, &extents.spheres, place as usize)
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
    extents: &'b Extents,
    form: PlacementForm,
    positions: Cube,
    cube: Cube,
    instance: &'b F,
    /// Around each instance; none if there are too many.
    boxes: Vec<Bounds>,
    /// In the upper halves the codes of the middles of instances, in the lower ones their numbers.
    keys: Vec<u64>,
}

impl<'b, F: Fn(usize) -> Instance + Sync> Builder<'b, F> {
    fn new(extents: &'b Extents, form: PlacementForm, instance: &'b F) -> Builder<'b, F> {
        let (boxes, keys) = (Vec::new(), Vec::new());
        Builder { extents, form, positions: EMPTY, cube: EMPTY, instance, boxes, keys }
    }

    fn check(&self, number: usize) -> Result<(), InstanceError> {
        let Instance { prototype, placement, .. } = (self.instance)(number);
        if usize::from(prototype) >= self.extents.boxes.len() {
            let prototypes = self.extents.boxes.len();
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

    /// The box around an instance, if rounding does not make it too large or too small.
    fn check_rounded(&self, number: usize) -> Result<Bounds, InstanceError> {
        let rounded = self.rounded(number);
        let (bounds, placement) = (self.around(&rounded), rounded.placement);
        if !(placement.is_finite() && (bounds.is_empty() || bounds.min.is_finite() && bounds.max.is_finite())) {
            return Err(InstanceError::NotFinite { instance: number });
        }
        let determinant = placement.matrix3.determinant();
        if determinant == 0.0 || !placement.inverse().is_finite() {
            return Err(InstanceError::Flat { instance: number });
        }
        Ok(bounds)
    }

    /// Where the centre of the sphere of an instance is.
    fn center(&self, instance: &Instance) -> DVec3 {
        instance.placement.transform_point3(self.extents.spheres[usize::from(instance.prototype)].center)
    }

    /// A box around the centre of the sphere of an instance, so small a part of it that positions are rounded to less than
    /// the digits of the sphere, and so large that these are numbers of single precision, in sides of it.
    fn around_center(&self, instance: &Instance) -> Bounds {
        let radius = f64::from(self.extents.spheres[usize::from(instance.prototype)].radius);
        let margin = DVec3::splat(radius * longest(&instance.placement.matrix3) * POSITION_MARGIN);
        let center = self.center(instance);
        Bounds { min: center - margin, max: center + margin }
    }

    fn rounded(&self, number: usize) -> Instance {
        let instance = (self.instance)(number);
        rounded(self.form, &self.positions, &instance, self.extents.spheres[usize::from(instance.prototype)].center)
    }

    /// The box around an instance.
    fn bounds(&self, number: usize) -> Bounds {
        self.boxes.get(number).copied().unwrap_or_else(|| self.around(&self.rounded(number)))
    }

    /// The box around an instance that is rounded.
    fn around(&self, &Instance { prototype, placement, .. }: &Instance) -> Bounds {
        let own = self.extents.boxes[usize::from(prototype)];
        if own.is_empty() {
            return own;
        }
        let (center, half) = (placement.transform_point3(own.center()), own.size() * 0.5);
        let DMat3 { x_axis, y_axis, z_axis } = placement.matrix3;
        let reach = x_axis.abs() * half.x + y_axis.abs() * half.y + z_axis.abs() * half.z;
        // The corners, if they were computed, might be rounded away from it.
        let rounding = (center.abs() + reach) * ROUNDING;
        Bounds { min: center - reach - rounding, max: center + reach + rounding }
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
                    placements.push(&self.positions, &self.extents.spheres, instances);
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
