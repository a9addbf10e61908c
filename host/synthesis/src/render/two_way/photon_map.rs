//! The photon map: radiance estimates from the density of photons around a place (Jensen 1996).
//!
//! The flux that arrived within a small disc, over its area, is the irradiance. A small disc has few photons in it, so
//! that it is noisy; a large one blurs. Which is right is different from place to place: discs are tried from small to
//! large as long as their estimates are the same within their standard errors.

use super::occluders::{OccluderSegment, PlanarDisc, VisibleParts};
use super::photon_tracing::Photon;
use super::smooth_surfaces::SmoothSurfaces;
use crate::color::{Channels, LANES};
use crate::numeric::ray::Ray;
use crate::octree::{SortedPoints, TriangleBvh};
use crate::render::world::World;
use glam::{DVec3, Vec2};
use rayon::prelude::*;
use std::f64::consts::FRAC_2_PI;

/// Photons of a fine estimate, at the least, if there are so many.
const FEW: usize = 256;
/// Photons of a coarse estimate.
const COARSE: usize = 96;
/// Times as many photons as of a fine estimate where little noise is to be left.
const SMOOTH: usize = 8;
/// Of many photons, a fine estimate takes this times the power 2/3 of all: the discs then become as small, and their
/// noise as little, as makes the error fall fastest.
const SHARE: f64 = 0.3;
/// Photons in a disc, at the least, if there are so many around the place.
const LEAST: u32 = 10;
/// Rings of equal area around a place.
const RINGS: usize = 32;
/// Discs that are tried: so many rings each.
const DISCS: [usize; 10] = [1, 2, 3, 4, 6, 8, 11, 16, 22, 32];
/// Two estimates are the same if they differ by no more than so many standard errors. With few of them, a disc is often
/// taken because chance made its estimate low, and pictures get too dark; with many, edges blur.
const SAME: f64 = 3.0;
/// So many walls around a place are tested for each photon; of more, the octree finds the occluders.
const MANY_WALLS: usize = 64;
/// How far above or below the plane at a place a photon may have arrived to count there, over the radius.
const HEIGHT: f64 = 0.25;

/// Photons that are stored on surfaces, by their places.
pub(super) struct PhotonMap {
    points: SortedPoints,
    towards: Vec<[f32; 3]>,
    sides: Vec<u32>,
    /// Flux of each lane, those of one after those of the other.
    flux: Vec<f32>,
    lanes: usize,
    /// Mean flux over the lanes.
    strength: Vec<f32>,
    /// How many photons a fine estimate takes, at the most.
    most: usize,
    /// The wavelength set of each, and whether it was scattered broadly.
    wavelength_sets: Vec<u8>,
}

/// Marks what was scattered broadly; wavelength sets are fewer.
const HAD_BROAD: u8 = 0x80;

/// A place of which the irradiance is estimated.
#[derive(Clone, Copy, Debug)]
pub(super) struct GatherPoint {
    pub(super) position: DVec3,
    /// Outer normal of the surface.
    pub(super) outside: DVec3,
    /// Origin of rays from there to other places of the surface.
    pub(super) leave: DVec3,
    pub(super) surface: u32,
    /// The side, as [`super::photon_tracing::side_of`] numbers them.
    pub(super) side: u32,
}

/// How many photons an estimate takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GatherDetail {
    /// For a place that is seen.
    Fine,
    /// Few photons will do, as for one of the many places that light what is seen.
    Coarse,
    /// So many photons that little noise is left.
    Smooth,
}

/// The surroundings of gather points, and what their estimates need.
pub(super) struct GatherContext<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) surfaces: &'a SmoothSurfaces,
    /// Triangles that occlude light.
    pub(super) opaque: &'a TriangleBvh,
    /// The largest disc, scene units.
    pub(super) reach: f64,
    pub(super) detail: GatherDetail,
    /// Factor of the areas of discs.
    pub(super) shrink: f64,
}

/// A photon's part of the irradiance at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhotonContribution {
    /// Towards where it comes from.
    pub(super) towards: DVec3,
    /// Irradiance, W/m².
    pub(super) irradiance: Channels,
    pub(super) wavelength_set: usize,
    /// Whether it was scattered broadly before.
    pub(super) had_broad: bool,
}

/// Sums over the photons within a ring, or a disc: of their mean flux and of its square, each times powers of d².
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: u32,
    first: [f64; 2],
    second: [f64; 3],
}

impl Sums {
    fn add(&mut self, strength: f64, square: f64) {
        let product = strength * strength;
        self.count += 1;
        self.first[0] += strength;
        self.first[1] += strength * square;
        self.second[0] += product;
        self.second[1] += product * square;
        self.second[2] += product * square * square;
    }

    fn and(&self, other: &Sums) -> Sums {
        Sums {
            count: self.count + other.count,
            first: [0, 1].map(|i| self.first[i] + other.first[i]),
            second: [0, 1, 2].map(|i| self.second[i] + other.second[i]),
        }
    }

    /// Irradiance and its standard error of a disc, weighted by 1 − d²/r², times π/2.
    fn irradiance(&self, square: f64) -> (f64, f64) {
        let value = (self.first[0] - self.first[1] / square) / square;
        let variance = self.second[0] - 2.0 * self.second[1] / square + self.second[2] / (square * square);
        (value, variance.max(0.0).sqrt() / square)
    }
}

/// The photons of an estimate.
struct Gathered {
    /// Numbers of the photons, and the squares of their distances, sides of the cube.
    near: Vec<(u32, f32)>,
    /// The square of the radius of the disc in which they are, sides of the cube.
    square: f64,
    /// Irradiance over flux, but for the weight 1 − d²/r².
    factor: f64,
    /// Standard error of the irradiance over the irradiance.
    error: f64,
}

/// A disc over which photons are gathered.
#[derive(Clone, Copy, Debug)]
struct Disc {
    /// The square of its radius, in sides of the cube.
    square: f64,
    /// How much of it is on the surface and in sight.
    part: f64,
    /// Standard error of the irradiance over the irradiance.
    error: f64,
}

impl PhotonMap {
    /// Sorts photons by their places.
    pub(super) fn new(photons: &[Photon], lanes: usize) -> PhotonMap {
        let positions: Vec<DVec3> = photons.iter().map(|c| c.position).collect();
        let (points, order) = SortedPoints::new(&positions);
        let sorted = || order.par_iter().map(|number| &photons[*number as usize]);
        PhotonMap {
            towards: sorted().map(|c| c.towards.as_vec3().to_array()).collect(),
            sides: sorted().map(|c| c.side).collect(),
            flux: sorted().flat_map_iter(|c| c.flux.0[..lanes].iter().map(|flux| *flux as f32)).collect(),
            strength: sorted().map(|c| (c.flux.0[..lanes].iter().sum::<f64>() / lanes as f64) as f32).collect(),
            wavelength_sets: sorted()
                .map(|c| if c.had_broad { c.wavelength_set | HAD_BROAD } else { c.wavelength_set })
                .collect(),
            lanes,
            most: FEW.max((SHARE * (photons.len() as f64).powf(2.0 / 3.0)) as usize),
            points,
        }
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        self.points.bytes()
            + size_of_val(&self.towards[..])
            + size_of_val(&self.sides[..])
            + size_of_val(&self.flux[..])
            + size_of_val(&self.strength[..])
            + size_of_val(&self.wavelength_sets[..])
    }

    /// Visits the photons around a place, as if they arrived at it.
    ///
    /// - Returns the standard error of the irradiance by all of them, over the irradiance: as if photons arrived
    ///   independently; 0 without photons.
    pub(super) fn each(
        &self,
        gather_point: &GatherPoint,
        gather_context: &GatherContext<'_>,
        mut visit: impl FnMut(&PhotonContribution),
    ) -> f64 {
        let Some(Gathered { near, square, factor, error }) = self.gathered(gather_point, gather_context) else {
            return 0.0;
        };
        for (number, distance) in near {
            let number = number as usize;
            let weight = factor * (1.0 - f64::from(distance) / square);
            let mut irradiance = [0.0; LANES];
            irradiance.iter_mut().zip(self.flux_of(number)).for_each(|(lane, flux)| *lane = f64::from(*flux));
            visit(&PhotonContribution {
                towards: DVec3::from_array(self.towards[number].map(f64::from)),
                irradiance: Channels(irradiance) * weight,
                wavelength_set: usize::from(self.wavelength_sets[number] & !HAD_BROAD),
                had_broad: self.wavelength_sets[number] & HAD_BROAD != 0,
            });
        }
        error
    }

    /// The irradiance around a place, W/m²: by photons that were scattered narrowly only, and by photons that were
    /// scattered broadly, too; and the standard error, as [`PhotonMap::each`] has it. Photons of all directions and
    /// wavelength sets count.
    pub(super) fn irradiance(
        &self,
        gather_point: &GatherPoint,
        gather_context: &GatherContext<'_>,
    ) -> ([Channels; 2], f64) {
        let mut sums = [[0.0; LANES]; 2];
        let Some(Gathered { near, square, factor, error }) = self.gathered(gather_point, gather_context) else {
            return (sums.map(Channels), 0.0);
        };
        for (number, distance) in near {
            let number = number as usize;
            let weight = 1.0 - f64::from(distance) / square;
            let sum = &mut sums[usize::from(self.wavelength_sets[number] & HAD_BROAD != 0)];
            sum.iter_mut().zip(self.flux_of(number)).for_each(|(lane, flux)| *lane += weight * f64::from(*flux));
        }
        (sums.map(|sum| Channels(sum) * factor), error)
    }

    /// Flux of each lane.
    #[inline]
    fn flux_of(&self, number: usize) -> &[f32] {
        &self.flux[number * self.lanes..(number + 1) * self.lanes]
    }

    /// The photons that count around a place.
    fn gathered(&self, gather_point: &GatherPoint, gather_context: &GatherContext<'_>) -> Option<Gathered> {
        let most = match gather_context.detail {
            GatherDetail::Fine => self.most,
            GatherDetail::Coarse => COARSE,
            GatherDetail::Smooth => SMOOTH * self.most,
        };
        let around = self.points.nearby(gather_point.position, gather_context.reach, most);
        if around.count == 0 {
            return None;
        }
        let side = self.points.side();
        let reach = (around.reach / side) as f32;
        let squares = [reach * reach, (HEIGHT as f32 * reach).powi(2)];
        let mut near: Vec<(u32, f32)> = Vec::with_capacity(around.count);
        self.points.within(&around, gather_point.position, gather_point.outside, squares, |number, square| {
            if self.sides[number as usize] == gather_point.side {
                near.push((number, square));
            }
        });
        if near.is_empty() {
            return None;
        }
        let (x, y) = gather_point.outside.any_orthonormal_pair();
        let axes = [x, y];
        let walls = self.keep_visible(&mut near, gather_point, around.reach, axes, gather_context);
        let Disc { square, part, error } =
            self.disc(&near, &walls, gather_point, around.reach, axes, gather_context)?;
        near.retain(|(_, distance)| f64::from(*distance) < square);
        // In scene units.
        let area = square * side * side;
        Some(Gathered { near, square, factor: FRAC_2_PI / (area * part), error })
    }

    /// Leaves out photons that arrived behind something that stands on the surface, as seen from the place; returns
    /// what stands there.
    ///
    /// All lines along the surface lie in one plane: walls are cut with it, and then occlude as segments.
    fn keep_visible(
        &self,
        near: &mut Vec<(u32, f32)>,
        gather_point: &GatherPoint,
        reach: f64,
        axes: [DVec3; 2],
        gather_context: &GatherContext<'_>,
    ) -> Vec<OccluderSegment> {
        let above = (gather_point.leave - gather_point.position).normalize_or(gather_point.outside);
        let GatherContext { world, surfaces, opaque, .. } = gather_context;
        let flat = PlanarDisc::new(gather_point.leave, above, axes, reach);
        let mut walls: Vec<OccluderSegment> = Vec::new();
        opaque.touching(flat.bounds(), |triangle| {
            if walls.len() <= MANY_WALLS && surfaces.of(triangle) != gather_point.surface {
                walls.extend(flat.cut(world.appearance.prepared.corners(triangle)));
            }
        });
        if walls.is_empty() {
            return walls;
        }
        let side = self.points.side();
        let local = self.points.local(gather_point.position);
        if walls.len() > MANY_WALLS {
            near.retain(|(number, _)| {
                let way = DVec3::from_array(self.points.local_offset(local, *number as usize).map(f64::from)) * side;
                // Along the plane: positions are rounded.
                let ray = Ray { origin: gather_point.leave, direction: way - above * way.dot(above) };
                !world.any_between(&ray, |triangle| {
                    surfaces.of(triangle) != gather_point.surface && world.is_opaque(triangle)
                })
            });
            return Vec::new();
        }
        let [x, y] = axes.map(|axis| (axis * (side / reach)).as_vec3());
        near.retain(|(number, _)| {
            let offset = glam::Vec3::from_array(self.points.local_offset(local, *number as usize));
            let at = Vec2::new(offset.dot(x), offset.dot(y));
            !walls.iter().any(|wall| wall.hides(at))
        });
        walls
    }

    /// The best disc: the largest whose estimate agrees with those of all smaller ones.
    ///
    /// # Source
    /// Goldenshluger and Nemirovski 1997, intersection of confidence intervals; the weight is that of Epanechnikov
    /// 1969.
    fn disc(
        &self,
        near: &[(u32, f32)],
        walls: &[OccluderSegment],
        gather_point: &GatherPoint,
        reach: f64,
        axes: [DVec3; 2],
        of: &GatherContext<'_>,
    ) -> Option<Disc> {
        let side = self.points.side();
        let whole = (reach / side) * (reach / side);
        let mut rings = [Sums::default(); RINGS];
        for (number, square) in near {
            let ring = (f64::from(*square) / whole * RINGS as f64) as usize;
            rings[ring.min(RINGS - 1)].add(f64::from(self.strength[*number as usize]), f64::from(*square));
        }
        let borders = of.surfaces.around(gather_point.surface, gather_point.position, axes, reach);
        let visible_parts = (!(borders.is_empty() && walls.is_empty())).then(|| VisibleParts::new(walls, &borders));
        let part = |square: f64| visible_parts.as_ref().map_or(1.0, |seen| seen.part((square / whole).sqrt()));
        let (mut sums, mut next) = (Sums::default(), 0);
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut best = None;
        for disc in DISCS {
            sums = rings[next..disc].iter().fold(sums, |sums, ring| sums.and(ring));
            next = disc;
            let square = whole * disc as f64 / RINGS as f64;
            if sums.count < LEAST && disc < RINGS {
                continue;
            }
            let part = part(square);
            let (value, error) = sums.irradiance(square);
            let relative = if value > 0.0 { error / value } else { 0.0 };
            let (value, error) = (value / part, SAME * error / part);
            (low, high) = (low.max(value - error), high.min(value + error));
            if low > high {
                break;
            }
            best = Some(Disc { square, part, error: relative });
        }
        let best = best?;
        if of.shrink == 1.0 {
            return Some(best);
        }
        let square = best.square * of.shrink;
        Some(Disc { square, part: part(square), error: best.error / of.shrink.sqrt() })
    }
}
