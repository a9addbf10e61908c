//! The light buffer: occluders between the voxels of the scene and its lights, for all views.
//!
//! For each voxel and each light that is small beside it, or far away, it is found once, as soon as enough rays have
//! asked, what rays from there to there may hit: a triangle that occludes all of the light, or a few triangles, which
//! are then intersected without the rest of the scene. The answer is that of the octree to the bit: no picture depends
//! on it.
//!
//! Large lights are left out: from most voxels they are partly hidden by more triangles than are soon intersected.
//!
//! # Source
//! Haines and Greenberg 1986, the light buffer: a shadow-testing accelerator, with voxels in the place of directions,
//! so that lights may have a size.

use crate::illumination::light::{LightOrigin, LightSource};
use crate::numeric::bounds::Bounds;
use crate::octree::{Octree, Shaft, ShaftContents};
use glam::DVec3;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

/// Voxels along the longest side of the scene, and along each side of a brick of them.
const VOXELS: usize = 128;
const BRICK: usize = 8;
/// Rays that ask before an answer is worth finding.
const ASKED: u8 = 24;
/// Triangles that are intersected one by one rather than in the octree.
const FEW: usize = 24;
/// Memory at the most, bytes.
const MOST_BYTES: usize = 256 << 20;

/// The occluders between a voxel and a light.
#[derive(Debug)]
pub(in crate::render) enum Occluders {
    /// Something opaque, before all of the light.
    Dark,
    /// These triangles, if any.
    Few(Box<Shaft>),
    /// More triangles than these.
    Many,
}

/// What is known of the lines between a voxel and a light, and how many rays have asked.
#[derive(Default)]
struct Entry {
    asked: AtomicU8,
    occluders: OnceLock<Occluders>,
}

/// A light, and which of a voxel's entries is its own.
struct BufferedLight {
    /// A box, or the direction to it.
    at: Result<Bounds, DVec3>,
    entry: usize,
}

/// The occluders of all voxels and lights.
pub(in crate::render) struct LightBuffer {
    /// Lowest corner, side of a voxel, and how many bricks along each axis.
    origin: DVec3,
    side: f64,
    along: [usize; 3],
    /// For each light, unless it is large.
    lights: Vec<Option<BufferedLight>>,
    /// Entries of each voxel.
    entries: usize,
    bricks: Vec<OnceLock<Box<[Entry]>>>,
    bytes: AtomicUsize,
    /// For each triangle of the octree, whether nothing passes; none if that is so everywhere.
    opaque: Option<Vec<bool>>,
}

impl LightBuffer {
    /// - `bounds`: of the scene. `opaque`: for each triangle of the octree, whether nothing passes; none if that is so
    ///   everywhere.
    pub(in crate::render) fn new(
        bounds: &Bounds,
        sources: &[(usize, LightSource)],
        opaque: Option<Vec<bool>>,
    ) -> LightBuffer {
        // A little beyond: rays begin beside triangles.
        let wider = DVec3::splat(bounds.size().max_element() / VOXELS as f64 * 1e-3);
        let (origin, size) = (bounds.min - wider, bounds.size() + 2.0 * wider);
        let side = size.max_element() / VOXELS as f64;
        let along = size.to_array().map(|size| ((size / side).ceil() as usize).clamp(1, VOXELS).div_ceil(BRICK));
        let mut entries = 0;
        let place = |(_, source): &(usize, LightSource)| {
            let at = match source.origin() {
                LightOrigin::Within(bounds) if bounds.size().max_element() > 2.0 * side => return None,
                LightOrigin::Within(bounds) => Ok(bounds),
                LightOrigin::Towards(towards) => Err(towards),
                LightOrigin::Everywhere => return None,
            };
            entries += 1;
            Some(BufferedLight { at, entry: entries - 1 })
        };
        let lights = sources.iter().map(place).collect();
        // A scene without extent has no voxels.
        let count = if side > 0.0 && side.is_finite() { along.iter().product() } else { 0 };
        let bricks = (0..count).map(|_| OnceLock::new()).collect();
        LightBuffer { origin, side, along, lights, entries, bricks, bytes: AtomicUsize::new(0), opaque }
    }

    /// The occluders between a point and a light, if they are known.
    pub(in crate::render) fn occluders(&self, octree: &Octree, from: DVec3, light: usize) -> Option<&Occluders> {
        let place = self.lights[light].as_ref()?;
        let at = (from - self.origin) / self.side;
        let end = DVec3::from_array(self.along.map(|bricks| (bricks * BRICK) as f64));
        if !(at.cmpge(DVec3::ZERO).all() && at.cmplt(end).all()) {
            return None;
        }
        let voxel = at.to_array().map(|x| x as usize);
        let index = |[x, y, z]: [usize; 3], along: [usize; 3]| (z * along[1] + y) * along[0] + x;
        let brick = self.bricks.get(index(voxel.map(|i| i / BRICK), self.along))?;
        let brick = match brick.get() {
            Some(entries) => entries,
            None => {
                let count = self.entries * BRICK.pow(3);
                let bytes = count * size_of::<Entry>();
                if self.bytes.load(Ordering::Relaxed) + bytes > MOST_BYTES {
                    return None;
                }
                brick.get_or_init(|| {
                    self.bytes.fetch_add(bytes, Ordering::Relaxed);
                    (0..count).map(|_| Entry::default()).collect()
                })
            }
        };
        let entry = &brick[index(voxel.map(|i| i % BRICK), [BRICK; 3]) * self.entries + place.entry];
        if let Some(occluders) = entry.occluders.get() {
            return Some(occluders);
        }
        if entry.asked.fetch_add(1, Ordering::Relaxed) < ASKED {
            return None;
        }
        Some(entry.occluders.get_or_init(|| self.find(octree, voxel, place)))
    }

    /// Finds the occluders between a voxel and a light.
    fn find(&self, octree: &Octree, voxel: [usize; 3], light: &BufferedLight) -> Occluders {
        let low = self.origin + DVec3::from_array(voxel.map(|i| i as f64)) * self.side;
        let from = Bounds { min: low, max: low + DVec3::splat(self.side) };
        let to = light.at.unwrap_or_else(|direction| {
            // Far enough to leave the scene from everywhere in it.
            let far = direction * (2.0 * self.side * VOXELS as f64);
            Bounds { min: from.min + far, max: from.max + far }
        });
        let covers = |triangle: u32| self.opaque.as_ref().is_none_or(|opaque| opaque[triangle as usize]);
        match octree.between(from, to, covers, FEW) {
            ShaftContents::Covered => Occluders::Dark,
            ShaftContents::Some(shaft) if self.bytes.load(Ordering::Relaxed) < MOST_BYTES => {
                self.bytes.fetch_add(shaft.bytes(), Ordering::Relaxed);
                Occluders::Few(Box::new(shaft))
            }
            _ => Occluders::Many,
        }
    }
}
