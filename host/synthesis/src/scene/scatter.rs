//! Instances by chance: where the surface of an object has them, how they stand, and how large they are.

use super::ShapeError;
use super::object::{Scatter, Shape};
use super::parameters::parameters;
use super::shape_mesh::{ShapeMesh, flat_normals};
use crate::illumination::texture::TextureFootprint;
use crate::memory;
use crate::numeric::sampling::{RandomStream, disk_across, part_of, triangle};
use crate::octree::Instance;
use glam::{DAffine3, DMat3, DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::f64::consts::TAU;

/// So many places are tried for each instance that is asked for, before those that were found are all.
const MOST_TRIES: usize = 200;
/// So many places are tried at once, at the least.
const BATCH: usize = 1 << 14;
/// Bytes of the number of a place that was found.
const NUMBER_BYTES: u64 = 8;
/// Bytes of a place that others keep away from.
const NEIGHBOUR_BYTES: u64 = 64;

/// The places of instances by chance.
pub struct ScatteredPlaces<'a> {
    scatter: &'a Scatter,
    /// The surface, in coordinates of the instances.
    corners: Vec<[DVec3; 3]>,
    normals: Vec<[DVec3; 3]>,
    /// Where density is told by parameters, and by own coordinates.
    parameters: Vec<[DVec2; 3]>,
    own: Vec<[DVec3; 3]>,
    /// Of the area, the part of the triangles up to each.
    areas: Vec<f64>,
    /// Of the shares of the prototypes, the part up to each.
    shares: Vec<f64>,
    /// The numbers of the places that count; empty where all do.
    found: Vec<u64>,
    count: usize,
}

/// A place of the surface.
struct SurfacePlace {
    at: DVec3,
    /// Unit length.
    normal: DVec3,
    footprint: TextureFootprint,
    random: RandomStream,
}

impl<'a> ScatteredPlaces<'a> {
    /// Finds places; fewer than are asked for where there is no room for more.
    ///
    /// They do not depend on the number of threads. Cost: as the number of instances, by what of the surface counts.
    ///
    /// # Errors
    /// [`ShapeError`], if the surface cannot be tessellated, or for too little memory.
    pub(super) fn new(
        scatter: &'a Scatter,
        scene_tolerance: Option<f64>,
        angle: f64,
    ) -> Result<ScatteredPlaces<'a>, ShapeError> {
        let on = &scatter.on;
        let made = on.shape.tessellate(on.own_tolerance(scene_tolerance, angle))?;
        // A mirrored object is turned inside out in place: its second and third corners change places.
        let is_mirrored = on.transform.determinant() < 0.0;
        let parameters = match scatter.density.needs_parameters() {
            true => parameters(&made.mesh, &made.surfaces, is_mirrored),
            false => Vec::new(),
        };
        let turned = |[a, b, c]: [DVec3; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let triangles = 0..made.mesh.triangles.len();
        let own = match scatter.density.is_varying() {
            true => triangles.clone().map(|triangle| turned(made.mesh.corners(triangle))).collect(),
            false => Vec::new(),
        };
        let ShapeMesh { mut mesh, .. } = on.in_place(ShapeMesh { surfaces: Vec::new(), ..made });
        if mesh.corner_normals.is_empty() {
            mesh.corner_normals = flat_normals(&mesh);
        }
        let corners: Vec<[DVec3; 3]> = triangles.map(|triangle| mesh.corners(triangle)).collect();
        let normals = mesh.corner_normals;
        let area = |[a, b, c]: &[DVec3; 3]| 0.5 * (*b - *a).cross(*c - *a).length();
        let areas = parts_below(corners.iter().map(area));
        let shares = parts_below(scatter.shares.iter().copied());
        let count = if areas.is_empty() || shares.is_empty() { 0 } else { scatter.count };
        let mut places =
            ScatteredPlaces { scatter, corners, normals, parameters, own, areas, shares, found: Vec::new(), count };
        if places.count > 0 && !scatter.takes_all() {
            places.find()?;
        }
        Ok(places)
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// An instance by its number.
    pub(super) fn instance(&self, number: usize) -> Instance {
        let number = if self.found.is_empty() { number as u64 } else { self.found[number] };
        let SurfacePlace { at, normal, mut random, .. } = self.place(number);
        let Scatter { turn, lean, upright, sink, scale: [least, most], .. } = *self.scatter;
        let up = normal.lerp(DVec3::Y, upright).try_normalize().unwrap_or(normal);
        let offset = disk_across(up, random.point());
        let up = (up + offset * lean.to_radians().tan()).try_normalize().unwrap_or(up);
        let turned = (turn.to_radians() * (random.uniform() - 0.5)).rem_euclid(TAU);
        // Where nothing is turned, x stays as much along x as it can.
        let across = [DVec3::X, DVec3::Z].map(|axis| axis - up * up.dot(axis));
        let across =
            if across[0].length() > 1e-3 { across[0] } else { across[1] }.normalize_or(up.any_orthonormal_vector());
        let x = across * turned.cos() - up.cross(across) * turned.sin();
        let scale = least + (most - least) * random.uniform();
        let matrix3 = DMat3::from_cols(x, up, x.cross(up)) * scale;
        let (prototype, _) = part_of(&self.shares, random.uniform());
        let variation = (random.uniform() * 65_536.0) as u16;
        Instance {
            prototype: prototype as u16,
            variation,
            placement: DAffine3 { matrix3, translation: at - up * (sink * scale) },
        }
    }

    /// The place of a number, whether it counts or not.
    fn place(&self, number: u64) -> SurfacePlace {
        let mut random = RandomStream::new(self.scatter.seed, number);
        let (index, _) = part_of(&self.areas, random.uniform());
        let [u, v] = triangle(random.point());
        let weigh = |of: &[DVec3; 3]| of[0] * (1.0 - u - v) + of[1] * u + of[2] * v;
        let corners = &self.corners[index];
        let face = || (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(DVec3::Y);
        let normal = weigh(&self.normals[index]).try_normalize().unwrap_or_else(face);
        let uv = self.parameters.get(index).map_or(DVec2::ZERO, |[a, b, c]| *a * (1.0 - u - v) + *b * u + *c * v);
        let own = self.own.get(index).map_or(DVec3::ZERO, weigh);
        SurfacePlace { at: weigh(corners), normal, footprint: TextureFootprint::point(uv, own), random }
    }

    /// The point of a place, if slope, height and density let something be there.
    fn allowed(&self, number: u64) -> Option<DVec3> {
        let Scatter { density, slope: [flattest, steepest], height: [lowest, highest], seed, .. } = self.scatter;
        let SurfacePlace { at, normal, footprint, .. } = self.place(number);
        let slope = normal.y.clamp(-1.0, 1.0).acos().to_degrees();
        let is_within = (*flattest..=*steepest).contains(&slope) && (*lowest..=*highest).contains(&at.y);
        // Numbers of its own, so that a place stays where it is when the density changes.
        let chance = || RandomStream::new(!seed, number).uniform();
        (is_within && chance() < density.at(&footprint)).then_some(at)
    }

    /// Finds the places that count, in the order of their numbers.
    fn find(&mut self) -> Result<(), ShapeError> {
        let Scatter { count, distance, .. } = *self.scatter;
        let bytes = NUMBER_BYTES + if distance > 0.0 { NEIGHBOUR_BYTES } else { 0 };
        memory::reserve(count as u64 * bytes, || format!("finding {count} places"))?;
        let most = count.saturating_mul(MOST_TRIES).saturating_add(BATCH);
        let (mut tried, mut found) = (0, Vec::with_capacity(count));
        let mut neighbours = Neighbours { distance, by_cell: FxHashMap::default() };
        while found.len() < count && tried < most {
            let next = tried + (count - found.len()).clamp(BATCH, 64 * BATCH);
            let allowed = |number: usize| Some((number as u64, self.allowed(number as u64)?));
            let batch: Vec<(u64, DVec3)> = (tried..next).into_par_iter().filter_map(allowed).collect();
            tried = next;
            found.extend(batch.into_iter().filter(|(_, at)| neighbours.take(*at)).map(|(number, _)| number));
        }
        found.truncate(count);
        (self.count, self.found) = (found.len(), found);
        Ok(())
    }
}

/// The places so far, by the cells of a grid.
struct Neighbours {
    distance: f64,
    by_cell: FxHashMap<[i64; 3], Vec<DVec3>>,
}

impl Neighbours {
    /// Takes a place, if none that was taken is nearer than the distance; says whether it did.
    fn take(&mut self, at: DVec3) -> bool {
        if self.distance <= 0.0 {
            return true;
        }
        let cell = (at / self.distance).floor().as_i64vec3().to_array();
        for offset in 0..27 {
            let near = [offset % 3, offset / 3 % 3, offset / 9];
            let near: [i64; 3] = std::array::from_fn(|axis| cell[axis].saturating_add(near[axis] - 1));
            let is_near = |other: &DVec3| other.distance_squared(at) < self.distance * self.distance;
            if self.by_cell.get(&near).is_some_and(|all| all.iter().any(is_near)) {
                return false;
            }
        }
        self.by_cell.entry(cell).or_default().push(at);
        true
    }
}

/// For each of some amounts, what part of their sum those up to it are; nothing if the sum is 0.
fn parts_below(amounts: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut below: Vec<f64> = amounts
        .scan(0.0, |sum, amount| {
            *sum += amount;
            Some(*sum)
        })
        .collect();
    match below.last().copied() {
        Some(sum) if sum > 0.0 => below.iter_mut().for_each(|part| *part /= sum),
        _ => below.clear(),
    }
    below
}

impl Scatter {
    /// Whether every place counts that is tried.
    fn takes_all(&self) -> bool {
        let everywhere = self.slope[0] <= 0.0 && self.slope[1] >= 180.0;
        let all_heights = self.height == [f64::NEG_INFINITY, f64::INFINITY];
        let is_full = !self.density.is_varying() && self.density.mean() >= 1.0;
        everywhere && all_heights && is_full && self.distance <= 0.0
    }

    /// Checks every number; the problem in words.
    ///
    /// - `prototypes`: how many there are.
    pub(super) fn check(&self, prototypes: usize) -> Result<(), String> {
        self.on.check(false).map_err(|error| error.to_string())?;
        if let Shape::Curve(_) | Shape::HalfSpace { .. } | Shape::Instances(_) = self.on.shape {
            return Err(format!("{} has no surface of its own to scatter on", self.on.name));
        }
        self.density.check().map_err(|error| error.to_string())?;
        let Scatter { distance, slope, height, scale, turn, lean, upright, sink, shares, .. } = self;
        let is_range = |[least, most]: &[f64; 2]| least <= most;
        let is_share = |share: &f64| *share >= 0.0 && share.is_finite();
        let rows = [
            ("distance", *distance >= 0.0 && distance.is_finite()),
            ("slope", is_range(slope)),
            ("height", is_range(height)),
            ("scale", is_range(scale) && scale[0] > 0.0 && scale[1].is_finite()),
            ("turn", turn.is_finite()),
            ("lean", (0.0..90.0).contains(lean)),
            ("sink", sink.is_finite()),
            ("upright", (0.0..=1.0).contains(upright)),
            ("shares", shares.len() == prototypes && shares.iter().all(is_share)),
        ];
        match rows.into_iter().find(|(_, is_sound)| !is_sound) {
            Some((what, _)) => Err(format!("{what} is out of range")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::object::{Object, Shape};
    use super::*;
    use crate::illumination::Paint;
    use crate::illumination::texture::{Band, Motif, NumberTexture, Pattern, TextureMapping, Varying};
    use crate::solid::Primitive;
    use glam::DMat4;

    /// Everything about the origin, on a level square of 10 or on something else.
    fn scatter(count: usize) -> Scatter {
        Scatter {
            on: on(Shape::Ground { size: 10.0 }, DMat4::IDENTITY),
            count,
            distance: 0.0,
            density: NumberTexture::Constant(1.0),
            slope: [0.0, 180.0],
            height: [f64::NEG_INFINITY, f64::INFINITY],
            scale: [1.0, 1.0],
            turn: 360.0,
            lean: 0.0,
            upright: 0.0,
            sink: 0.0,
            shares: vec![1.0],
            seed: 7,
        }
    }

    fn on(shape: Shape, transform: DMat4) -> Object {
        Object { name: "ground".into(), shape, transform, material: None, tolerance: Some(1e-3) }
    }

    fn all(scatter: &Scatter) -> Vec<Instance> {
        scatter.check(scatter.shares.len()).expect("in range");
        let places = ScatteredPlaces::new(scatter, None, 45.0).expect("a surface");
        (0..places.count()).map(|number| places.instance(number)).collect()
    }

    #[test]
    fn every_part_of_an_area_gets_as_many() {
        let mut counts = [0; 16];
        for Instance { placement, .. } in all(&scatter(16_000)) {
            let at = placement.translation;
            assert!(at.y == 0.0 && at.x.abs() <= 5.0 && at.z.abs() <= 5.0);
            let cell = |x: f64| ((x + 5.0) / 2.5) as usize;
            counts[cell(at.x).min(3) * 4 + cell(at.z).min(3)] += 1;
        }
        // Five standard deviations.
        assert!(counts.iter().all(|count| (840..1160).contains(count)), "{counts:?}");
    }

    #[test]
    fn instances_stand_square_to_the_surface_or_upright_and_turn_and_lean_as_far_as_told() {
        let ball = || on(Shape::from(Primitive::Sphere { radius: 2.0 }), DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
        for Instance { placement, .. } in all(&Scatter { on: ball(), scale: [0.5, 2.0], ..scatter(500) }) {
            let [x, y, z] = [placement.matrix3.x_axis, placement.matrix3.y_axis, placement.matrix3.z_axis];
            let scale = y.length();
            assert!((0.5..=2.0).contains(&scale) && (x.length() / scale - 1.0).abs() < 1e-12);
            assert!((x.cross(y).dot(z) / scale.powi(3) - 1.0).abs() < 1e-12, "right-handed");
            assert!(y.dot(placement.translation) / (2.0 * scale) > 0.999);
        }
        let straight = Scatter { on: ball(), upright: 1.0, turn: 0.0, sink: 0.25, ..scatter(50) };
        for Instance { placement, .. } in all(&straight) {
            assert!((placement.matrix3 - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-12));
            assert!(((placement.translation + DVec3::Y * 0.25).length() - 2.0).abs() < 1e-3);
        }
        let leaning = all(&Scatter { lean: 20.0, turn: 10.0, ..scatter(2000) });
        let angles: Vec<f64> = leaning.iter().map(|i| i.placement.matrix3.y_axis.y.acos().to_degrees()).collect();
        let most = angles.iter().copied().fold(0.0, f64::max);
        assert!(most <= 20.0 + 1e-9 && most > 19.0, "{most}");
    }

    #[test]
    fn distance_slope_height_and_density_are_kept() {
        let apart = all(&Scatter { distance: 0.4, ..scatter(300) });
        assert_eq!(apart.len(), 300);
        for (number, one) in apart.iter().enumerate() {
            let far = |other: &Instance| one.placement.translation.distance(other.placement.translation) >= 0.4;
            assert!(apart[..number].iter().all(far));
        }
        let full = all(&Scatter { distance: 1.0, ..scatter(1_000) }).len();
        assert!((60..120).contains(&full), "no room for more: {full}");
        let ball = || on(Shape::from(Primitive::Sphere { radius: 2.0 }), DMat4::IDENTITY);
        for Instance { placement, .. } in all(&Scatter { on: ball(), slope: [30.0, 60.0], ..scatter(500) }) {
            let slope = (placement.translation.y / 2.0).acos().to_degrees();
            assert!((29.0..61.0).contains(&slope), "{slope}");
        }
        let band = all(&Scatter { on: ball(), height: [-0.5, 0.25], ..scatter(500) });
        assert!(band.len() == 500 && band.iter().all(|i| (-0.5..=0.25).contains(&i.placement.translation.y)));
        assert!(all(&Scatter { height: [5.0, 6.0], ..scatter(500) }).is_empty());
    }

    #[test]
    fn a_pattern_of_density_lies_as_a_paint_does() {
        let checker = Pattern {
            motif: Motif::Checker,
            laying: TextureMapping::default(),
            paints: vec![Paint::grey(0.0), Paint::grey(1.0)],
        };
        let density = Varying { pattern: checker, band: Band::Mean, from: 0.0, to: 1.0 };
        let density = NumberTexture::Varying(Box::new(density));
        let mut sides = Vec::new();
        for mirror in [1.0, -1.0] {
            let on = on(Shape::Ground { size: 10.0 }, DMat4::from_scale(DVec3::new(mirror, 1.0, 1.0)));
            let all = all(&Scatter { density: density.clone(), on, ..scatter(2000) });
            let is_first =
                |instance: &&Instance| instance.placement.translation.x * instance.placement.translation.z > 0.0;
            let first = all.iter().filter(is_first).count();
            assert!(all.len() == 2000 && (first == 0 || first == 2000), "{first}: two of four squares");
            assert!(all.iter().all(|instance| instance.placement.matrix3.y_axis.y > 0.999), "they stand on top");
            sides.push(first);
        }
        assert_eq!(sides[0] + sides[1], 2000, "a mirrored square has a mirrored pattern");
    }

    #[test]
    fn prototypes_come_as_often_as_their_shares_tell_and_all_is_drawn_from_the_seed() {
        let shares = || Scatter { shares: vec![1.0, 0.0, 3.0], ..scatter(4000) };
        let first = all(&shares());
        let count = |which: u16| first.iter().filter(|instance| instance.prototype == which).count();
        assert!(count(1) == 0 && (850..1150).contains(&count(0)), "{}", count(0));
        assert_eq!(first, all(&shares()));
        assert_ne!(first, all(&Scatter { seed: 8, ..shares() }));
        let of = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| all(&Scatter { distance: 0.05, slope: [0.0, 10.0], ..scatter(3000) }))
        };
        assert_eq!(of(1), of(3));
    }
}
