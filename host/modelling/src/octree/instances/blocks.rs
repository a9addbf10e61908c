//! Placements in blocks of eight: what a leaf has, so that a ray looks at its spheres all at once.

use super::super::cube::Cube;
use super::super::lanes::{Eight, LANES, Lanes, PART, prefetch};
use super::placement::{
    AffinePlacement, Instance, OwnFrame, PlacementForm, PrototypeSphere, SimilarPlacement, longest,
};
use crate::numeric::ray::Ray;
use glam::{DAffine3, DVec3};

/// Stands for the prototype of a place that is empty: there are fewer.
const NONE: u16 = u16::MAX;
/// Rounding of what is compared in single precision, sides of the cube of positions: positions are cut to 2^-24, and
/// what is added to them is off by less than ten times that.
const ROUNDING: f32 = 1.0 / (1_u32 << 20) as f32;
/// Rounding of a point of a ray in double precision, as a part of how far away the ray begins.
const DOUBLE_ROUNDING: f32 = 1.0 / (1_u64 << 48) as f32;
/// Rounding of radii and lengths in single precision, parts of them.
const RELATIVE: f32 = 1.0 / (1_u32 << 20) as f32;

/// Eight placements by position, rotation and scale.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct SimilarBlock {
    position: [[u32; LANES]; 3],
    rotation: [[u16; LANES]; 3],
    scale: [i16; LANES],
    prototype: [u16; LANES],
    variation: [u16; LANES],
}

/// Eight placements by affine maps.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct AffineBlock {
    position: [[u32; LANES]; 3],
    inverse: [Eight; 9],
    prototype: [u16; LANES],
    variation: [u16; LANES],
}

/// Placements in blocks of eight, some places of which may be empty.
#[derive(Clone, Debug)]
pub(super) enum Placements {
    Similar(Vec<SimilarBlock>),
    Affine(Vec<AffineBlock>),
    Exact(Vec<[Instance; LANES]>),
}

/// A line as the spheres about instances are compared with it: in local coordinates of the cube of positions.
pub(super) struct SphereTest {
    /// The point of the line that is nearest to the middle of the cube.
    origin: [f32; 3],
    /// Unit length.
    direction: [f32; 3],
    /// One over the side of the cube.
    unit: f32,
    rounding: f32,
    /// Factor from a parameter of the ray to a length.
    rate: f64,
    /// The parameter at the origin.
    first: f64,
}

impl SphereTest {
    /// None for a ray that cannot be compared: every sphere may then be hit.
    pub(super) fn new(ray: &Ray, cube: &Cube) -> Option<SphereTest> {
        let square = ray.direction.length_squared();
        let middle = cube.origin + cube.side * 0.5;
        let first = (middle - ray.origin).dot(ray.direction) / square;
        let origin = cube.local(ray.at(first)).as_vec3();
        let direction = (ray.direction / square.sqrt()).as_vec3();
        let rate = square.sqrt() * cube.unit();
        let far = cube.local(ray.origin).abs().max_element() as f32;
        let rounding = ROUNDING * (1.0 + origin.abs().max_element()) + DOUBLE_ROUNDING * far;
        let is_sound = square.is_normal() && rate.is_normal() && rounding.is_finite() && first.is_finite();
        let (origin, direction) = (origin.to_array(), direction.to_array());
        is_sound.then_some(SphereTest { origin, direction, unit: cube.unit() as f32, rounding, rate, first })
    }

    /// The length at a parameter of the ray, and a little less.
    pub(super) fn from(&self, t: f64) -> f32 {
        let length = ((t - self.first) * self.rate) as f32;
        length - length.abs() * RELATIVE - self.rounding
    }

    /// The length at a parameter of the ray, and a little more.
    pub(super) fn to(&self, t: f64) -> f32 {
        let length = ((t - self.first) * self.rate) as f32;
        length + length.abs() * RELATIVE + self.rounding
    }

    /// The spheres that the line may hit between two lengths, one bit each, and about where it does.
    #[inline(always)]
    fn meets<L: Lanes>(&self, proof: L::Proof, center: [L; 3], radius: L, [from, to]: [f32; 2]) -> (u32, L) {
        // Written out: closures over arrays are called, and lose the instructions of the lanes.
        let [ux, uy, uz] = [
            L::splat(proof, self.direction[0]),
            L::splat(proof, self.direction[1]),
            L::splat(proof, self.direction[2]),
        ];
        let x = center[0].minus(L::splat(proof, self.origin[0]));
        let y = center[1].minus(L::splat(proof, self.origin[1]));
        let z = center[2].minus(L::splat(proof, self.origin[2]));
        let along = z.times_plus(uz, y.times_plus(uy, x.times(ux)));
        let (x, y, z) = (along.times_from(ux, x), along.times_from(uy, y), along.times_from(uz, z));
        let square = z.times_plus(z, y.times_plus(y, x.times(x)));
        let radius = radius.times_plus(L::splat(proof, 1.0 + RELATIVE), L::splat(proof, self.rounding));
        let (enter, exit) = (along.minus(radius), along.plus(radius));
        // What is not a number is no miss.
        let beside = radius.times(radius).is_at_most(square);
        let before = exit.is_at_most(L::splat(proof, from));
        let behind = L::splat(proof, to).is_at_most(enter);
        (!(beside | before | behind) & 0xff, enter)
    }

    /// What [`SphereTest::meets`] tells, found in the coordinates of each prototype, where its sphere is one.
    ///
    /// These are scaled, so that the inverse map has the norm 1, for placements and cubes of any size.
    #[inline(always)]
    fn meets_affine(&self, block: &AffineBlock, radii: &Eight, [from, to]: [f32; 2]) -> (u32, Eight) {
        let (mut lanes, mut near) = (0, Eight([0.0; LANES]));
        for lane in 0..LANES {
            let entry = |entry: usize| block.inverse[entry].0[lane];
            let scale = (0..9).map(|k| entry(k) * entry(k)).sum::<f32>().sqrt().recip();
            let own = |[x, y, z]: [f32; 3]| {
                let row = |row: usize| (entry(row) * x + entry(3 + row) * y + entry(6 + row) * z) * scale;
                [row(0), row(1), row(2)]
            };
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let from_center = |axis: usize| self.origin[axis] - (block.position[axis][lane] >> 8) as f32 * PART;
            let (origin, direction) = (own([from_center(0), from_center(1), from_center(2)]), own(self.direction));
            let square = dot(direction, direction);
            let along = -dot(origin, direction) / square;
            let beside = [0, 1, 2].map(|axis| origin[axis] + direction[axis] * along);
            let radius = radii.0[lane] * self.unit * scale * (1.0 + RELATIVE) + self.rounding;
            let half = radius / square.sqrt();
            let misses = dot(beside, beside) > radius * radius || along + half <= from || along - half >= to;
            lanes |= u32::from(!misses) << lane;
            near.0[lane] = along - half;
        }
        (lanes, near)
    }

    /// The sphere about an instance: its centre, and its radius.
    fn sphere(&self, instance: &Instance, spheres: &[PrototypeSphere], cube: &Cube) -> ([f32; 3], f32) {
        let sphere = &spheres[usize::from(instance.prototype)];
        let center = cube.local(instance.placement.transform_point3(sphere.center)).as_vec3();
        let radius = f64::from(sphere.radius) * longest(&instance.placement.matrix3);
        (center.to_array(), radius as f32 * self.unit)
    }
}

impl SimilarBlock {
    const EMPTY: SimilarBlock = SimilarBlock {
        position: [[0; LANES]; 3],
        rotation: [[0; LANES]; 3],
        scale: [0; LANES],
        prototype: [NONE; LANES],
        variation: [0; LANES],
    };

    fn set(&mut self, lane: usize, placement: &SimilarPlacement) {
        for axis in 0..3 {
            self.position[axis][lane] = placement.position[axis];
            self.rotation[axis][lane] = placement.rotation[axis];
        }
        self.scale[lane] = placement.scale;
        self.prototype[lane] = placement.prototype;
        self.variation[lane] = placement.variation;
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> SimilarPlacement {
        SimilarPlacement {
            position: self.position.map(|axis| axis[lane]),
            rotation: self.rotation.map(|part| part[lane]),
            scale: self.scale[lane],
            prototype: self.prototype[lane],
            variation: self.variation[lane],
        }
    }
}

impl AffineBlock {
    const EMPTY: AffineBlock = AffineBlock {
        position: [[0; LANES]; 3],
        inverse: [Eight([1.0; LANES]); 9],
        prototype: [NONE; LANES],
        variation: [0; LANES],
    };

    fn set(&mut self, lane: usize, placement: &AffinePlacement) {
        (0..3).for_each(|axis| self.position[axis][lane] = placement.position[axis]);
        (0..9).for_each(|entry| self.inverse[entry].0[lane] = placement.inverse[entry]);
        self.prototype[lane] = placement.prototype;
        self.variation[lane] = placement.variation;
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> AffinePlacement {
        AffinePlacement {
            position: self.position.map(|axis| axis[lane]),
            inverse: std::array::from_fn(|entry| self.inverse[entry].0[lane]),
            prototype: self.prototype[lane],
            variation: self.variation[lane],
        }
    }
}

impl Placements {
    /// None yet, with memory for so many.
    pub(super) fn with_capacity(form: PlacementForm, count: usize) -> Placements {
        let blocks = count.div_ceil(LANES);
        match form {
            PlacementForm::Similar => Placements::Similar(Vec::with_capacity(blocks)),
            PlacementForm::Affine => Placements::Affine(Vec::with_capacity(blocks)),
            PlacementForm::Exact => Placements::Exact(Vec::with_capacity(blocks)),
        }
    }

    /// Adds a block of at most eight instances.
    pub(super) fn push(&mut self, cube: &Cube, spheres: &[PrototypeSphere], instances: impl Iterator<Item = Instance>) {
        let center = |instance: &Instance| spheres[usize::from(instance.prototype)].center;
        let instances = instances.take(LANES).enumerate();
        match self {
            Placements::Similar(blocks) => {
                let mut block = SimilarBlock::EMPTY;
                instances.for_each(|(lane, one)| block.set(lane, &SimilarPlacement::new(cube, &one, center(&one))));
                blocks.push(block);
            }
            Placements::Affine(blocks) => {
                let mut block = AffineBlock::EMPTY;
                instances.for_each(|(lane, one)| block.set(lane, &AffinePlacement::new(cube, &one, center(&one))));
                blocks.push(block);
            }
            Placements::Exact(blocks) => {
                let mut block = [Instance { prototype: NONE, variation: 0, placement: DAffine3::IDENTITY }; LANES];
                instances.for_each(|(lane, one)| block[lane] = one);
                blocks.push(block);
            }
        }
    }

    /// How many blocks there are.
    pub(super) fn blocks(&self) -> usize {
        match self {
            Placements::Similar(blocks) => blocks.len(),
            Placements::Affine(blocks) => blocks.len(),
            Placements::Exact(blocks) => blocks.len(),
        }
    }

    /// Brings a block near the processor.
    #[inline(always)]
    pub(super) fn prefetch(&self, block: usize) {
        match self {
            Placements::Similar(blocks) => blocks.get(block).into_iter().for_each(prefetch),
            Placements::Affine(blocks) => blocks.get(block).into_iter().for_each(prefetch),
            Placements::Exact(blocks) => blocks.get(block).into_iter().for_each(prefetch),
        }
    }

    /// How much memory they take, bytes.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Placements::Similar(blocks) => size_of_val(blocks.as_slice()),
            Placements::Affine(blocks) => size_of_val(blocks.as_slice()),
            Placements::Exact(blocks) => size_of_val(blocks.as_slice()),
        }
    }

    /// An instance as it is kept, by its place; none where that is empty.
    pub(super) fn get(&self, cube: &Cube, spheres: &[PrototypeSphere], place: usize) -> Option<Instance> {
        let (block, lane) = (place / LANES, place % LANES);
        let prototype = self.prototype(block, lane)?;
        let center = spheres[usize::from(prototype)].center;
        match self {
            Placements::Similar(blocks) => Some(blocks[block].get(lane).instance(cube, center)),
            Placements::Affine(blocks) => Some(blocks[block].get(lane).instance(cube, center)),
            Placements::Exact(blocks) => Some(blocks[block][lane]),
        }
    }

    /// What is placed at all places that are not empty.
    pub(super) fn prototypes(&self) -> impl Iterator<Item = u16> + '_ {
        let places = (0..self.blocks()).flat_map(|block| (0..LANES).map(move |lane| (block, lane)));
        places.filter_map(|(block, lane)| self.prototype(block, lane))
    }

    /// What is placed at a place; none where that is empty.
    #[inline(always)]
    pub(super) fn prototype(&self, block: usize, lane: usize) -> Option<u16> {
        match self {
            Placements::Similar(blocks) => Some(blocks[block].prototype[lane]).filter(|of| *of != NONE),
            Placements::Affine(blocks) => Some(blocks[block].prototype[lane]).filter(|of| *of != NONE),
            Placements::Exact(blocks) => Some(blocks[block][lane].prototype).filter(|of| *of != NONE),
        }
    }

    /// A ray in the coordinates of what is placed at a place; its lengths stay.
    #[inline(always)]
    pub(super) fn own_ray(&self, cube: &Cube, block: usize, lane: usize, center: DVec3, ray: &Ray) -> Ray {
        let OwnFrame { center: at, inverse } = match self {
            Placements::Similar(blocks) => blocks[block].get(lane).frame(cube),
            Placements::Affine(blocks) => blocks[block].get(lane).frame(cube),
            Placements::Exact(blocks) => {
                let inverse = blocks[block][lane].placement.inverse();
                let origin = inverse.transform_point3(ray.origin);
                return Ray { origin, direction: inverse.transform_vector3(ray.direction) };
            }
        };
        Ray { origin: inverse * (ray.origin - at) + center, direction: inverse * ray.direction }
    }

    /// The instances of a block whose spheres a line may hit between two lengths, one bit each, and about where it does.
    ///
    /// - `test`: none where all may be hit.
    #[inline(always)]
    pub(super) fn meets<L: Lanes>(
        &self,
        proof: L::Proof,
        cube: &Cube,
        block: usize,
        spheres: &[PrototypeSphere],
        test: Option<&SphereTest>,
        limits: [f32; 2],
    ) -> (u32, Eight) {
        // Nothing is within the sphere of a place that is empty.
        let radius = |of: u16| spheres.get(usize::from(of)).map_or(f32::NEG_INFINITY, |sphere| sphere.radius);
        let radii = |of: &[u16; LANES]| {
            let mut radii = [0.0; LANES];
            (0..LANES).for_each(|lane| radii[lane] = radius(of[lane]));
            Eight(radii)
        };
        let Some(test) = test else {
            let present = |lane: &usize| self.prototype(block, *lane).is_some();
            let lanes = (0..LANES).filter(present).fold(0, |bits, lane| bits | 1 << lane);
            return (lanes, Eight([0.0; LANES]));
        };
        let (lanes, enter) = match self {
            Placements::Similar(blocks) => {
                let SimilarBlock { position: [x, y, z], scale, prototype, .. } = &blocks[block];
                let center = [L::parts(proof, x), L::parts(proof, y), L::parts(proof, z)];
                let radius = L::load(proof, &radii(prototype)).times(L::splat(proof, test.unit));
                test.meets(proof, center, L::powers(proof, scale).times(radius), limits)
            }
            Placements::Affine(blocks) => {
                return test.meets_affine(&blocks[block], &radii(&blocks[block].prototype), limits);
            }
            Placements::Exact(blocks) => {
                let (mut center, mut radius) = ([Eight([0.0; LANES]); 3], Eight([f32::NEG_INFINITY; LANES]));
                for lane in (0..LANES).filter(|lane| blocks[block][*lane].prototype != NONE) {
                    let (at, of) = test.sphere(&blocks[block][lane], spheres, cube);
                    (0..3).for_each(|axis| center[axis].0[lane] = at[axis]);
                    radius.0[lane] = of;
                }
                let [x, y, z] = &center;
                let center = [L::load(proof, x), L::load(proof, y), L::load(proof, z)];
                test.meets(proof, center, L::load(proof, &radius), limits)
            }
        };
        (lanes, enter.store())
    }
}
