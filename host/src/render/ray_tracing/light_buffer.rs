//! The light buffer: what stands between the voxels of the scene and its lights, for all views.
//!
//! For each voxel and each part of a light it is found once, as soon as enough rays have asked, what a ray from there to
//! there may meet: nothing, a triangle that stands before all of it, or a few triangles, which are then looked at without
//! the rest of the scene. The answer is that of the octree to the bit, so that pictures do not depend on it.
//!
//! # Source
//! Haines and Greenberg 1986, the light buffer: a shadow-testing accelerator, with voxels in the place of directions, so that
//! lights may have a size.

use crate::illumination::light::Source;
use crate::numeric::bounds::Bounds;
use crate::octree::{Between, Octree, Shaft};
use glam::DVec3;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

/// Voxels along the longest side of the scene.
const VOXELS: f64 = 128.0;
/// Parts along each side of a light's box, at the most, and how many voxels wide a part is at least.
const PARTS: f64 = 4.0;
const PART_VOXELS: f64 = 1.0;
/// Rays that ask before an answer is worth finding.
const ASKED: u8 = 24;
/// Triangles that are looked at one by one rather than in the octree.
const FEW: usize = 40;
/// Memory at the most, bytes.
const MOST_BYTES: usize = 256 << 20;

/// What stands between a voxel and a part of a light.
#[derive(Debug)]
pub(super) enum Way {
    /// Something opaque, before everything.
    Dark,
    /// These triangles, if any.
    Few(Shaft),
    /// Who knows.
    Any,
}

/// What is known of a way, and how many rays have asked.
#[derive(Default)]
struct Entry {
    asked: AtomicU8,
    way: OnceLock<Way>,
}

/// The parts of a light.
struct Parts {
    /// A box, or the direction to it.
    place: Result<Bounds, DVec3>,
    /// How many along each axis.
    along: [usize; 3],
    /// Of the entries of a voxel, which is the first.
    first: usize,
}

/// The ways between voxels and lights.
pub(super) struct LightBuffer {
    /// Lowest corner, side of a voxel, and how many along each axis.
    origin: DVec3,
    side: f64,
    along: [usize; 3],
    /// For each light, unless it is a sky.
    lights: Vec<Option<Parts>>,
    /// Entries of each voxel.
    entries: usize,
    voxels: Vec<OnceLock<Box<[Entry]>>>,
    bytes: AtomicUsize,
    /// For each triangle of the octree, whether nothing passes; none if that is so everywhere.
    opaque: Option<Vec<bool>>,
}

impl LightBuffer {
    /// - `bounds`: of the scene. `opaque`: for each triangle of the octree, whether nothing passes; none if that is so
    ///   everywhere.
    pub(super) fn new(bounds: &Bounds, sources: &[(usize, Source)], opaque: Option<Vec<bool>>) -> LightBuffer {
        // A little beyond: rays begin beside triangles.
        let wider = DVec3::splat(bounds.size().max_element() / VOXELS * 1e-3);
        let (origin, size) = (bounds.min - wider, bounds.size() + 2.0 * wider);
        let side = size.max_element() / VOXELS;
        let along = size.to_array().map(|size| ((size / side).ceil() as usize).clamp(1, VOXELS as usize));
        let mut entries = 0;
        let parts = |source: &Source| {
            let place = source.place()?;
            let count = |size: f64| ((size / (PART_VOXELS * side)).ceil().clamp(1.0, PARTS)) as usize;
            let along = place.map_or([1; 3], |bounds| bounds.size().to_array().map(count));
            let first = entries;
            entries += along.iter().product::<usize>();
            Some(Parts { place, along, first })
        };
        let lights = sources.iter().map(|(_, source)| source).map(parts).collect();
        // A scene without extent has no voxels.
        let count = if side > 0.0 && side.is_finite() { along.iter().product() } else { 0 };
        let mut voxels = Vec::new();
        voxels.resize_with(count, OnceLock::new);
        LightBuffer { origin, side, along, lights, entries, voxels, bytes: AtomicUsize::new(0), opaque }
    }

    /// What stands between a point and all points of a light, or one of them, if that is known.
    ///
    /// - `from`: where a ray begins. `to`: where it ends; none for all of a light that is not divided.
    pub(super) fn way(&self, octree: &Octree, from: DVec3, light: usize, to: Option<DVec3>) -> Option<&Way> {
        let parts = self.lights[light].as_ref()?;
        let at = (from - self.origin) / self.side;
        let voxel = at.to_array().map(|x| x.floor());
        let is_inside = (0..3).all(|axis| voxel[axis] >= 0.0 && voxel[axis] < self.along[axis] as f64);
        let voxel = voxel.map(|x| x as usize);
        let index = (voxel[2] * self.along[1] + voxel[1]) * self.along[0] + voxel[0];
        let part = parts.part(to)?;
        let entries = is_inside.then(|| self.voxels.get(index)).flatten()?;
        let entries = match entries.get() {
            Some(entries) => entries,
            None => {
                let bytes = self.entries * size_of::<Entry>();
                if self.bytes.load(Ordering::Relaxed) + bytes > MOST_BYTES {
                    return None;
                }
                entries.get_or_init(|| {
                    self.bytes.fetch_add(bytes, Ordering::Relaxed);
                    (0..self.entries).map(|_| Entry::default()).collect()
                })
            }
        };
        let entry = &entries[parts.first + part];
        if let Some(way) = entry.way.get() {
            return Some(way);
        }
        if entry.asked.fetch_add(1, Ordering::Relaxed) < ASKED {
            return None;
        }
        Some(entry.way.get_or_init(|| self.find(octree, voxel, (parts, part))))
    }

    /// Finds what stands between a voxel and a part of a light.
    fn find(&self, octree: &Octree, voxel: [usize; 3], (parts, part): (&Parts, usize)) -> Way {
        if self.bytes.load(Ordering::Relaxed) > MOST_BYTES {
            return Way::Any;
        }
        let low = self.origin + DVec3::from_array(voxel.map(|x| x as f64)) * self.side;
        let from = Bounds { min: low, max: low + DVec3::splat(self.side) };
        let to = parts.bounds(part).unwrap_or_else(|direction| {
            // Far enough to leave the scene from everywhere in it.
            let far = direction * (2.0 * self.side * VOXELS);
            Bounds { min: from.min + far, max: from.max + far }
        });
        let covers = |triangle: u32| self.opaque.as_ref().is_none_or(|opaque| opaque[triangle as usize]);
        match octree.between(from, to, covers, FEW) {
            Between::Covered => Way::Dark,
            Between::Many => Way::Any,
            Between::Some(shaft) => {
                self.bytes.fetch_add(shaft.bytes(), Ordering::Relaxed);
                Way::Few(shaft)
            }
        }
    }
}

impl Parts {
    /// The part in which a point lies, or the only one.
    fn part(&self, at: Option<DVec3>) -> Option<usize> {
        let Ok(bounds) = self.place else { return Some(0) };
        if self.along == [1; 3] {
            return Some(0);
        }
        let (size, from) = (bounds.size(), at? - bounds.min);
        let index = |axis: usize| {
            let count = self.along[axis];
            let place = if count > 1 { from[axis] / size[axis] * count as f64 } else { 0.0 };
            (place.max(0.0) as usize).min(count - 1)
        };
        Some((index(2) * self.along[1] + index(1)) * self.along[0] + index(0))
    }

    /// The box around a part, with something to spare for rounded points; the direction to one that is not near.
    fn bounds(&self, part: usize) -> Result<Bounds, DVec3> {
        let bounds = self.place?;
        let [x, y, _] = self.along;
        let index = DVec3::from_array([part % x, part / x % y, part / x / y].map(|i| i as f64));
        let step = bounds.size() / DVec3::from_array(self.along.map(|n| n as f64));
        let (min, spare) = (bounds.min + index * step, step * 1e-6);
        Ok(Bounds { min: min - spare, max: min + step + spare })
    }
}
