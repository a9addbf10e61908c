//! Places in the cells of a ground, which are a function of the cell and the seed.

use super::super::ShapeError;
use super::super::object::{Object, Scatter, Shape};
use super::standing::Standing;
use super::surface::ScatterSurface;
use crate::illumination::texture::{NumberTexture, TextureFootprint};
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::{RandomStream, mix};
use crate::octree::{CellGrid, CellInstances, CellPlace, Instance, Prototype};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use std::ops::Range;

/// Sides of a ground that are as upright to each other as this make square cells.
const UPRIGHT: f64 = 1e-9;

/// Where a ground is: its normal is y, its middle the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundFrame {
    /// From its coordinates to those of the instances; a rotation and a translation.
    to_instances: DAffine3,
    /// Its sides, units of the instances.
    pub(super) size: DVec2,
}

impl GroundFrame {
    /// None for an object that is no ground, or a skewed one.
    pub(super) fn of(on: &Object) -> Option<GroundFrame> {
        let Shape::Ground { size } = on.shape else { return None };
        let placed = DAffine3::from_mat4(on.transform);
        let (x, z) = (placed.matrix3.x_axis, placed.matrix3.z_axis);
        // A mirrored ground is turned inside out in place: instances stand on the side that y comes to.
        let (across, turned) = (x.normalize(), z.normalize());
        let normal = turned.cross(across) * placed.matrix3.determinant().signum();
        let is_upright = across.dot(turned).abs() < UPRIGHT && normal.is_finite();
        let matrix3 = DMat3::from_cols(across, normal, across.cross(normal));
        let to_instances = DAffine3 { matrix3, translation: placed.translation };
        is_upright.then_some(GroundFrame { to_instances, size: DVec2::new(x.length(), z.length()) * size })
    }
}

/// Where cells are, and how large what is placed in them is.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct PlacedGrid {
    /// From coordinates of the cells to those of the object that has the instances.
    pub(in crate::scene) placement: DAffine3,
    /// Diagonal of the largest thing, in coordinates of the cells.
    pub(in crate::scene) size: f64,
    /// A box around all instances as they are, in coordinates of the object.
    pub(in crate::scene) exact: Bounds,
}

/// Instances by the cells of a ground.
#[derive(Clone, Debug)]
pub(in crate::scene) struct ScatterCells {
    standing: Standing,
    frame: GroundFrame,
    /// From coordinates of the ground to those in which a pattern lies on it.
    to_own: DAffine3,
    /// With what is needed where density varies.
    surface: ScatterSurface,
    density: NumberTexture,
    height: [f64; 2],
    /// Up, in coordinates of the ground.
    vertical: DVec3,
    side: f64,
    cells: [u32; 2],
    /// In each cell, before density rules some out.
    count: u32,
}

impl ScatterCells {
    /// Knows the cells, whose measures were checked.
    ///
    /// # Errors
    /// [`ShapeError`], if there is no ground or a skewed one.
    pub(in crate::scene) fn new(scatter: &Scatter, side: f64, angle: f64) -> Result<ScatterCells, ShapeError> {
        let Scatter { on, count, density, slope: [flattest, steepest], height, .. } = scatter;
        let frame = GroundFrame::of(on).ok_or_else(|| ShapeError::NoCells { object: on.name.clone() })?;
        let GroundFrame { to_instances, size } = frame;
        let standing = Standing::new(scatter).on_ground(to_instances);
        let surface = ScatterSurface::new(on, density, None, angle)?;
        let vertical = to_instances.matrix3.transpose() * DVec3::Y;
        let slope = vertical.y.clamp(-1.0, 1.0).acos().to_degrees();
        let has_any = (*flattest..=*steepest).contains(&slope) && !standing.places_nothing();
        let cells = (size / side).ceil().max(DVec2::ONE);
        Ok(ScatterCells {
            standing,
            frame,
            to_own: DAffine3::from_mat4(on.transform).inverse() * to_instances,
            surface,
            density: density.clone(),
            height: *height,
            vertical,
            side,
            cells: [cells.x as u32, cells.y as u32],
            count: if has_any { *count as u32 } else { 0 },
        })
    }

    /// From coordinates of the cells to those of the object that has the instances.
    pub(in crate::scene) fn to_instances(&self) -> DAffine3 {
        self.frame.to_instances
    }

    /// The cells, with what is placed in them.
    pub(in crate::scene) fn grid(&self, prototypes: &[Prototype]) -> CellGrid {
        let (overhang, heights) = self.standing.level_reach(prototypes, self.vertical);
        // The cells at the ends may be cut off.
        CellGrid { cells: self.cells, corner: -0.5 * self.frame.size, side: self.side, overhang, heights }
    }

    /// Where the cells are, and how large what is placed in them is.
    pub(in crate::scene) fn placed(&self, prototypes: &[Prototype]) -> PlacedGrid {
        let CellGrid { overhang, heights: [low, high], .. } = self.grid(prototypes);
        let (from, to) = (-0.5 * self.frame.size - overhang, 0.5 * self.frame.size + overhang);
        let exact = Bounds { min: DVec3::new(from.x, low, from.y), max: DVec3::new(to.x, high, to.y) };
        let placement = self.frame.to_instances;
        let exact = Bounds::of(exact.corners().map(|corner| placement.transform_point3(corner)));
        PlacedGrid { placement, size: self.standing.largest(prototypes), exact }
    }

    /// How many there are at the most.
    pub(in crate::scene) fn count_of_all(&self) -> usize {
        let [x, z] = self.cells.map(|cells| cells as usize);
        (x * z).saturating_mul(self.count as usize)
    }

    /// Whether there is an instance of a number among all: density may rule it out, or the ground end before.
    pub(in crate::scene) fn has(&self, number: usize) -> bool {
        let (cell, own) = self.cell_of(number);
        let (at, mut random) = self.drawn(cell, own);
        self.counts(at, random.uniform())
    }

    /// An instance by its number among all.
    pub(in crate::scene) fn instance_of_all(&self, number: usize) -> Instance {
        let (cell, own) = self.cell_of(number);
        let (at, mut random) = self.drawn(cell, own);
        random.uniform();
        let instance = self.standing_at(at, random);
        Instance { placement: self.frame.to_instances * instance.placement, ..instance }
    }

    /// The numbers of about so many instances about a point.
    pub(in crate::scene) fn near(&self, at: DVec3, most: usize) -> Vec<Range<usize>> {
        let count = self.count as usize;
        let own = self.frame.to_instances.inverse().transform_point3(at);
        let reach = (most as f64 / count.max(1) as f64).sqrt() / 2.0;
        let at = (DVec2::new(own.x, own.z) + 0.5 * self.frame.size) / self.side;
        let [across, along] = [(at.x, self.cells[0]), (at.y, self.cells[1])]
            .map(|(at, cells)| [at - reach, at + reach].map(|x| x.round().clamp(0.0, f64::from(cells)) as usize));
        let row = |x: usize| {
            let first = x * self.cells[1] as usize;
            (first + along[0]) * count..(first + along[1]) * count
        };
        (across[0]..across[1]).map(row).filter(|numbers| !numbers.is_empty()).collect()
    }

    /// The cell of an instance, and its number there.
    fn cell_of(&self, number: usize) -> ([u32; 2], u32) {
        let (cell, own) = (number / self.count as usize, (number % self.count as usize) as u32);
        ([cell / self.cells[1] as usize, cell % self.cells[1] as usize].map(|number| number as u32), own)
    }

    /// A place, whether it counts or not, and what more is drawn for it.
    #[inline]
    fn drawn(&self, [x, z]: [u32; 2], number: u32) -> (DVec2, RandomStream) {
        let cell = mix(u64::from(x) << 32 | u64::from(z));
        let mut random = RandomStream::new(self.standing.seed, cell.wrapping_add(u64::from(number)));
        let within = DVec2::from(random.point());
        let at = (DVec2::new(f64::from(x), f64::from(z)) + within) * self.side - 0.5 * self.frame.size;
        (at, random)
    }
}

impl ScatterCells {
    /// Whether there is something at a place: height and density may rule it out, or the ground end before.
    ///
    /// - `chance`: 0..1, below the density where it counts.
    fn counts(&self, at: DVec2, chance: f64) -> bool {
        if at.cmpgt(0.5 * self.frame.size).any() {
            return false;
        }
        let on = DVec3::new(at.x, 0.0, at.y);
        let y = self.frame.to_instances.transform_point3(on).y;
        if y < self.height[0] || y > self.height[1] {
            return false;
        }
        let density = match &self.density {
            NumberTexture::Constant(density) => *density,
            varying => {
                let own = self.to_own.transform_point3(on);
                varying.at(&TextureFootprint::point(self.surface.parameters_at(own), own))
            }
        };
        density >= 1.0 || chance < density
    }

    /// What stands at a place.
    ///
    /// - `random`: what more is drawn for it.
    fn standing_at(&self, at: DVec2, random: RandomStream) -> Instance {
        self.standing.instance(DVec3::new(at.x, 0.0, at.y), DVec3::Y, self.vertical, random)
    }
}

impl CellInstances for ScatterCells {
    fn count(&self) -> u32 {
        self.count
    }

    fn place(&self, cell: [u32; 2], number: u32) -> CellPlace {
        let (at, mut random) = self.drawn(cell, number);
        // The chance of density.
        random.uniform();
        CellPlace { at, part: self.standing.part_of_largest(random) }
    }

    fn instance(&self, cell: [u32; 2], number: u32) -> Option<Instance> {
        let (at, mut random) = self.drawn(cell, number);
        // It is drawn whether density varies or not, so that instances stay as they are when it changes.
        let chance = random.uniform();
        self.counts(at, chance).then(|| self.standing_at(at, random))
    }

    fn shares(&self) -> &[f64] {
        &self.standing.shares
    }

    fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        sum.update(format!("{self:?}").as_bytes());
    }
}
