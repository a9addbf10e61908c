//! What instances place, and the octree over them.

use super::super::Octree;
use super::cells::{CellGrid, CellInstances, Cells};
use super::error::{InstanceError, MOST_INSTANCES, MOST_LEVELS, MOST_MADE_LEVELS, MOST_PROTOTYPES};
use super::parts::{InstanceParts, PartsOnDemand};
use super::placement::{Instance, PlacementForm, PrototypeSphere};
use super::stored::{Extents, StoredInstances};
use crate::numeric::bounds::Bounds;
use serde::Serialize;
use std::sync::Arc;

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
    /// It is made when a ray comes to it.
    Made {
        model: u32,
    },
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

    /// What is made when a ray comes to it, of instances that are nested at most [`MOST_MADE_LEVELS`] times.
    ///
    /// - `model`: the number by which [`PrototypeMaker`](super::PrototypeMaker) knows it. `bounds`: what holds it, in its
    ///   coordinates.
    pub fn made(model: u32, bounds: Bounds) -> Prototype {
        Prototype::new(Content::Made { model }, bounds, 0.5 * bounds.diagonal(), MOST_MADE_LEVELS)
    }

    fn new(content: Content, bounds: Bounds, radius: f64, levels: usize) -> Prototype {
        let sphere = PrototypeSphere::new(&bounds, radius);
        Prototype { content, bounds, sphere, levels }
    }

    /// Adds its placements to a checksum, and the number of what is made; a surface has none.
    pub fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        match &self.content {
            Content::Surface { .. } => {}
            Content::Instances(instances) => instances.add_to_checksum(sum),
            Content::Made { model } => sum.update(&model.to_le_bytes()),
        }
    }

    /// How many triangles are stored for it, each as often as it is placed.
    fn triangles(&self) -> u64 {
        match &self.content {
            Content::Surface { octree, .. } => octree.triangle_count() as u64,
            Content::Instances(instances) => instances.triangles,
            Content::Made { .. } => 0,
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
    pub(super) extents: Extents,
    pub(super) known: KnownInstances,
    bounds: Bounds,
    count: usize,
    /// Triangles that are placed.
    triangles: u64,
    /// How many times over instances are placed by instances.
    levels: usize,
}

/// How instances are known.
#[derive(Clone, Debug)]
pub(super) enum KnownInstances {
    /// All are stored.
    Stored(StoredInstances),
    /// Parts are stored when a ray first comes to them.
    Parts(PartsOnDemand),
    /// None is stored.
    Cells(Cells),
}

/// What an instance octree says of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct InstanceCosts {
    /// Instances, each of which may place many more.
    pub instances: usize,
    /// Those of them that are stored by now.
    pub stored: usize,
    /// Bytes of the placements that are stored by now and of the index, without what is placed.
    pub bytes: usize,
    /// Triangles that are placed, each as often as it is; as many as can be counted, and by the shares of prototypes where
    /// instances have not been told one by one.
    pub triangles: u64,
}

impl InstanceOctree {
    /// Places instances, and stores them all.
    ///
    /// Instances of empty prototypes are left out. The result is the same for any number of threads. Cost: as
    /// n log n; beside the result, 16 to 176 bytes each for a while, the fewer
    /// the more.
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
        let (extents, levels) = checked(&prototypes)?;
        if count > MOST_INSTANCES {
            return Err(InstanceError::TooManyInstances { instances: count });
        }
        let stored = StoredInstances::new(&extents, form, count, &instance)?;
        let triangles = stored.prototypes().map(|of| prototypes[usize::from(of)].triangles());
        let triangles = triangles.fold(0_u64, u64::saturating_add);
        let (bounds, count) = (stored.bounds, stored.count);
        let known = KnownInstances::Stored(stored);
        Ok(InstanceOctree { prototypes, extents, known, bounds, count, triangles, levels })
    }

    /// Places instances part by part, and stores those of a part when a ray first comes to its box.
    ///
    /// A ray that waits for a part waits as long as placing its instances takes, on one thread; some ten thousand take
    /// some hundredths of a second. Cost before the first ray: as the number of parts.
    ///
    /// # Errors
    /// [`InstanceError`], also if all of them together would take more memory than there is.
    pub fn on_demand(
        prototypes: Vec<Prototype>,
        form: PlacementForm,
        source: Arc<dyn InstanceParts>,
    ) -> Result<InstanceOctree, InstanceError> {
        let (extents, levels) = checked(&prototypes)?;
        let parts = PartsOnDemand::new(form, source)?;
        let (bounds, count) = (parts.above.bounds, parts.count());
        let triangles = placed_by_shares(&prototypes, parts.shares(), count);
        let known = KnownInstances::Parts(parts);
        Ok(InstanceOctree { prototypes, extents, known, bounds, count, triangles, levels })
    }

    /// Places instances in the cells of a grid, and stores none: a ray asks for those of the cells that it comes to.
    ///
    /// Cost of a ray: as the number of cells along its way, until it hits something.
    ///
    /// # Errors
    /// [`InstanceError`], for measures out of range.
    pub fn in_cells(
        prototypes: Vec<Prototype>,
        grid: CellGrid,
        source: Arc<dyn CellInstances>,
    ) -> Result<InstanceOctree, InstanceError> {
        let (extents, levels) = checked(&prototypes)?;
        let cells = Cells::new(grid, source)?;
        let count = cells.count();
        let places_nothing = count == 0 || prototypes.iter().all(|prototype| prototype.bounds.is_empty());
        let (bounds, count) = if places_nothing { (Bounds::EMPTY, 0) } else { (cells.bounds(), count) };
        let triangles = placed_by_shares(&prototypes, cells.source.shares(), count);
        let known = KnownInstances::Cells(cells);
        Ok(InstanceOctree { prototypes, extents, known, bounds, count, triangles, levels })
    }

    /// This, with aggregates that may stand in for instances in cells which are far from the eye: fewer and larger
    /// ones, up to 2^[`MOST_AGGREGATE_LEVELS`](super::MOST_AGGREGATE_LEVELS) times. Without cells it stays as it is.
    /// Without anybody who knows the views, rays meet all instances as they are.
    ///
    /// - `number`: by which [`PrototypeMaker`](super::PrototypeMaker) knows the views.
    pub fn aggregated(mut self, number: u32) -> InstanceOctree {
        if let KnownInstances::Cells(cells) = &mut self.known {
            cells.aggregates = Some(number);
            self.bounds = if self.count == 0 { Bounds::EMPTY } else { cells.bounds() };
        }
        self
    }

    /// The box around all instances, and around the aggregates that may stand in for them; empty without any. It may be
    /// larger where they are not all stored.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Number of instances, those of empty prototypes left out if all are stored.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How many times over instances are placed by instances, itself one of them.
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// Memory of it and of all that it places, bytes, what is placed twice counted twice.
    pub fn all_bytes(&self) -> usize {
        let of = |prototype: &Prototype| match &prototype.content {
            Content::Surface { octree, .. } => octree.bytes(),
            Content::Instances(instances) => instances.all_bytes(),
            Content::Made { .. } => 0,
        };
        self.costs().bytes + self.prototypes.iter().map(of).sum::<usize>()
    }

    /// An instance as it is kept; the number is that of an [`InstancePath`](super::InstancePath). None if there is none of this number.
    pub fn instance(&self, number: u64) -> Option<Instance> {
        match &self.known {
            KnownInstances::Stored(stored) => stored.instance(&self.extents, u32::try_from(number).ok()?),
            KnownInstances::Parts(parts) => parts.instance(&self.extents, number),
            KnownInstances::Cells(cells) => cells.instance(number),
        }
    }

    /// All instances that are stored from the beginning, with their numbers.
    pub fn stored_instances(&self) -> impl Iterator<Item = (u64, Instance)> + '_ {
        let places = match &self.known {
            KnownInstances::Stored(stored) => stored.places(),
            KnownInstances::Parts(_) | KnownInstances::Cells(_) => 0,
        };
        (0..u64::from(places)).filter_map(|number| Some((number, self.instance(number)?)))
    }

    /// Adds all placements to a checksum, those within prototypes too: as they are kept, or how they come to be.
    pub fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        for (_, Instance { prototype, variation, placement }) in self.stored_instances() {
            [prototype, variation].iter().for_each(|number| sum.update(&number.to_le_bytes()));
            placement.to_cols_array().iter().for_each(|number| sum.update(&number.to_le_bytes()));
        }
        match &self.known {
            KnownInstances::Stored(_) => {}
            KnownInstances::Parts(parts) => parts.source.add_to_checksum(sum),
            KnownInstances::Cells(cells) => cells.source.add_to_checksum(sum),
        }
        self.prototypes.iter().for_each(|prototype| prototype.add_to_checksum(sum));
    }

    /// What it costs by now, without the instances that its prototypes may be made of.
    pub fn costs(&self) -> InstanceCosts {
        let InstanceOctree { count: instances, triangles, .. } = *self;
        let (stored, bytes) = match &self.known {
            KnownInstances::Stored(stored) => (instances, stored.bytes()),
            KnownInstances::Parts(parts) => (parts.stored(), parts.bytes()),
            KnownInstances::Cells(_) => (0, 0),
        };
        InstanceCosts { instances, stored, bytes, triangles }
    }
}

/// How large prototypes are, and how many times over instances are placed with those that place them.
fn checked(prototypes: &[Prototype]) -> Result<(Extents, usize), InstanceError> {
    if prototypes.len() > MOST_PROTOTYPES {
        return Err(InstanceError::TooManyPrototypes { prototypes: prototypes.len() });
    }
    let levels = 1 + prototypes.iter().map(|prototype| prototype.levels).max().unwrap_or(0);
    if levels > MOST_LEVELS {
        return Err(InstanceError::TooManyLevels { levels });
    }
    let boxes = prototypes.iter().map(|prototype| prototype.bounds).collect();
    let spheres = prototypes.iter().map(|prototype| prototype.sphere).collect();
    Ok((Extents { boxes, spheres }, levels))
}

/// How many triangles so many instances place, by how often there is each prototype.
fn placed_by_shares(prototypes: &[Prototype], shares: &[f64], count: usize) -> u64 {
    let triangles = prototypes.iter().zip(shares).map(|(of, share)| of.triangles() as f64 * share);
    let mean = triangles.sum::<f64>() / shares.iter().sum::<f64>();
    (mean * count as f64) as u64
}
