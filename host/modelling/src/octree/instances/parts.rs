//! Instances in parts, each of which is stored when a ray first comes to its box.

use super::error::{InstanceError, MOST_INSTANCES, MOST_PARTS};
use super::placement::{Instance, PlacementForm, PrototypeSphere};
use super::stored::{Extents, StoredInstances};
use crate::memory;
use crate::numeric::bounds::Bounds;
use glam::DAffine3;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Placements are rounded by less than this part of how far what they place reaches.
const ROUNDING: f64 = 1.0 / 1024.0;

/// Instances that are known part by part.
///
/// All answers are the same whenever they are asked for: what a ray sees may not depend on which ray came first.
pub trait InstanceParts: fmt::Debug + Send + Sync {
    /// How many parts there are, at most [`MOST_PARTS`].
    fn parts(&self) -> usize;

    /// How many instances a part has.
    fn count(&self, part: usize) -> usize;

    /// A box around all that the instances of a part place; it may be larger than that.
    fn bounds(&self, part: usize) -> Bounds;

    /// An instance of a part, by its number in this. Those that cannot be placed are left out.
    fn instance(&self, part: usize, number: usize) -> Instance;

    /// How often each prototype is placed on the whole, in any unit.
    fn shares(&self) -> &[f64];

    /// Adds all that tells where instances are to a checksum.
    fn add_to_checksum(&self, sum: &mut crc32fast::Hasher);
}

/// Parts, and an index over their boxes.
#[derive(Clone, Debug)]
pub(super) struct PartsOnDemand {
    pub(super) source: Arc<dyn InstanceParts>,
    form: PlacementForm,
    /// The boxes of the parts, as instances that stand where they are.
    pub(super) above: StoredInstances,
    pub(super) extents: Extents,
    made: Arc<[OnceLock<StoredInstances>]>,
}

impl PartsOnDemand {
    /// Knows the boxes of the parts, and nothing else yet.
    ///
    /// # Errors
    /// [`InstanceError`], for more than there may be, for a box that is not finite, and for less memory than all of them
    /// may take.
    pub(super) fn new(form: PlacementForm, source: Arc<dyn InstanceParts>) -> Result<PartsOnDemand, InstanceError> {
        let parts = source.parts();
        if parts > MOST_PARTS {
            return Err(InstanceError::TooManyParts { parts });
        }
        let count = (0..parts).map(|part| source.count(part)).fold(0, usize::saturating_add);
        if count > MOST_INSTANCES {
            return Err(InstanceError::TooManyInstances { instances: count });
        }
        let bytes = count * StoredInstances::most_bytes(form) + parts * size_of::<StoredInstances>();
        memory::reserve(bytes as u64, || format!("placing {count} instances"))?;
        let boxed = |part| {
            let Bounds { min, max } = if source.count(part) == 0 { Bounds::EMPTY } else { source.bounds(part) };
            let margin = Bounds { min, max }.diagonal() * ROUNDING;
            Bounds { min: min - margin, max: max + margin }
        };
        let boxes: Vec<Bounds> = (0..parts).map(boxed).collect();
        let is_spoilt = |bounds: &Bounds| !(bounds.is_empty() || bounds.min.is_finite() && bounds.max.is_finite());
        if let Some(part) = boxes.iter().position(is_spoilt) {
            return Err(InstanceError::NotFinite { instance: (0..part).map(|part| source.count(part)).sum() });
        }
        let spheres = boxes.iter().map(|bounds| PrototypeSphere::new(bounds, 0.5 * bounds.diagonal())).collect();
        let extents = Extents { boxes, spheres };
        let part = |number: usize| Instance { prototype: number as u16, variation: 0, placement: DAffine3::IDENTITY };
        let above = StoredInstances::new(&extents, PlacementForm::Exact, parts, &part)?;
        Ok(PartsOnDemand { source, form, above, extents, made: (0..parts).map(|_| OnceLock::new()).collect() })
    }

    /// The instances of a part; they are stored now, if they were not before.
    ///
    /// - `extents`: of what is placed.
    pub(super) fn part(&self, extents: &Extents, number: usize) -> &StoredInstances {
        self.made[number].get_or_init(|| {
            let count = self.source.count(number);
            let all: Vec<Instance> = (0..count).map(|own| self.source.instance(number, own)).collect();
            StoredInstances::of_part(extents, self.form, &all)
        })
    }

    /// How many instances there are.
    pub(super) fn count(&self) -> usize {
        (0..self.made.len()).map(|part| self.source.count(part)).sum()
    }

    /// How many of them are stored by now.
    pub(super) fn stored(&self) -> usize {
        self.made.iter().filter_map(OnceLock::get).map(|part| part.count).sum()
    }

    /// Bytes of all parts that have been stored, and of what is above them.
    pub(super) fn bytes(&self) -> usize {
        let of = |part: &OnceLock<StoredInstances>| part.get().map_or(0, StoredInstances::bytes);
        let made = size_of::<OnceLock<StoredInstances>>() + size_of::<Bounds>() + size_of::<PrototypeSphere>();
        self.made.iter().map(|part| of(part) + made).sum::<usize>() + self.above.bytes()
    }

    /// How often each prototype is placed, in any unit.
    pub(super) fn shares(&self) -> &[f64] {
        self.source.shares()
    }

    /// An instance as it is kept, by the place of its part above 2^32 and its own below; none if there is none.
    pub(super) fn instance(&self, extents: &Extents, number: u64) -> Option<Instance> {
        let part = self.above.instance(&self.extents, (number >> 32) as u32)?;
        self.part(extents, usize::from(part.prototype)).instance(extents, number as u32)
    }
}
