//! The classes of the corpus, and how their cases are made.

use super::Case;
use glam::{DAffine3, DVec3};
use host::mesh::{Mesh, bunny};
use host::solid::Expression;
use host::surface::{Sphere, Tolerance, box_faces, tessellate};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A kind of difficulty.
pub struct Class {
    /// What it is called.
    pub name: &'static str,
    /// Number of its cases.
    pub cases: u32,
    make: fn(&mut Pcg64Mcg) -> Case,
}

impl Class {
    /// A case; always the same for a number.
    pub fn case(&self, number: u32) -> Case {
        (self.make)(&mut Pcg64Mcg::seed_from_u64(u64::from(number)))
    }
}

/// All classes.
pub const CLASSES: &[Class] = &[
    Class { name: "coincident faces", cases: 100, make: coincident },
    Class { name: "nearly coincident, 1e-3 to 1e-15", cases: 80, make: nearly_coincident },
    Class { name: "cubes turned by 1e-3 to 1e-15", cases: 100, make: tiny_turn },
    Class { name: "spheres turned by 1e-3 to 1e-15", cases: 60, make: spheres_turned },
    Class { name: "bunnies turned by 1e-1 to 1e-15", cases: 40, make: bunnies_turned },
    Class { name: "slivers", cases: 80, make: slivers },
    Class { name: "needles", cases: 80, make: needles },
    Class { name: "tangent spheres", cases: 80, make: tangent_spheres },
    Class { name: "sizes 1e-6 to 1e6 in one model", cases: 80, make: sizes },
    Class { name: "1e7 from the origin", cases: 80, make: far },
    Class { name: "nested shells", cases: 60, make: nested },
    Class { name: "touching themselves", cases: 60, make: self_touching },
    Class { name: "crossing themselves", cases: 80, make: self_crossing },
    Class { name: "empty results", cases: 60, make: empty },
    Class { name: "results as operands", cases: 80, make: chain },
    Class { name: "boxes of one lattice, turned", cases: 160, make: lattice },
];

fn cube(low: DVec3, high: DVec3) -> Mesh {
    tessellate(&box_faces(low, high), Tolerance::new(1.0, 90.0)).expect("boxes are within all limits")
}

fn unit() -> Mesh {
    cube(DVec3::splat(-0.5), DVec3::splat(0.5))
}

fn ball(center: DVec3, radius: f64) -> Mesh {
    tessellate(&[Sphere::new(center, radius)], Tolerance::new(0.04 * radius, 90.0))
        .expect("spheres are within all limits")
}

fn moved(mesh: &Mesh, by: DAffine3) -> Mesh {
    mesh.transformed(&by)
}

fn shifted(mesh: &Mesh, by: DVec3) -> Mesh {
    moved(mesh, DAffine3::from_translation(by))
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh, 0));
    all
}

fn pair(one: Mesh, two: Mesh) -> Case {
    Case::Pair { solids: [one, two], common: None }
}

fn vector(random: &mut Pcg64Mcg) -> DVec3 {
    DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0)))
}

fn direction(random: &mut Pcg64Mcg) -> DVec3 {
    vector(random).normalize_or(DVec3::Z)
}

fn power(random: &mut Pcg64Mcg, low: f64, high: f64) -> f64 {
    10f64.powf(random.random_range(low..high))
}

fn turned(mesh: &Mesh, random: &mut Pcg64Mcg, angle: f64) -> Mesh {
    moved(mesh, DAffine3::from_axis_angle(direction(random), angle))
}

/// Boxes whose corners are on a grid of sevenths, which have no exact numbers.
fn coincident(random: &mut Pcg64Mcg) -> Case {
    let mut corners = || {
        let low = [0; 3].map(|_| random.random_range(0..3));
        [low, low.map(|x| random.random_range(x + 1..4))].map(|corner| DVec3::from(corner.map(f64::from)))
    };
    let ([a, b], [p, q]) = (corners(), corners());
    let common = (b.min(q) - a.max(p)).max(DVec3::ZERO).element_product() / 343.0;
    Case::Pair { solids: [cube(a / 7.0, b / 7.0), cube(p / 7.0, q / 7.0)], common: Some(common) }
}

fn nearly_coincident(random: &mut Pcg64Mcg) -> Case {
    let by = vector(random) * power(random, -15.0, -3.0);
    let other = shifted(&unit(), by);
    let at = |mesh: &Mesh, high: bool| {
        let start = DVec3::splat(if high { f64::NEG_INFINITY } else { f64::INFINITY });
        mesh.vertices.iter().fold(start, |m, v| if high { m.max(*v) } else { m.min(*v) })
    };
    let sides = at(&unit(), true).min(at(&other, true)) - at(&unit(), false).max(at(&other, false));
    Case::Pair { solids: [unit(), other], common: Some(sides.element_product()) }
}

fn tiny_turn(random: &mut Pcg64Mcg) -> Case {
    let angle = power(random, -15.0, -3.0);
    let axis = if random.random_range(0..3) == 0 { DVec3::Z } else { direction(random) };
    pair(unit(), moved(&unit(), DAffine3::from_axis_angle(axis, angle)))
}

fn spheres_turned(random: &mut Pcg64Mcg) -> Case {
    let angle = power(random, -15.0, -3.0);
    let sphere = ball(DVec3::ZERO, 1.0);
    pair(sphere.clone(), turned(&sphere, random, angle))
}

fn bunnies_turned(random: &mut Pcg64Mcg) -> Case {
    let bunny = bunny().expect("it ships").simplified(500);
    let angle = power(random, -15.0, -1.0);
    pair(bunny.clone(), turned(&bunny, random, angle))
}

fn slivers(random: &mut Pcg64Mcg) -> Case {
    let thin = power(random, -12.0, -3.0);
    let plate = cube(DVec3::new(-1.0, -thin, -1.0), DVec3::new(1.0, thin, 1.0));
    let turn = DAffine3::from_rotation_z(random.random_range(0.0..4.0) * thin);
    pair(plate.clone(), moved(&plate, turn))
}

fn needles(random: &mut Pcg64Mcg) -> Case {
    let thin = power(random, -9.0, -3.0);
    let needle = cube(DVec3::new(-1.0, -thin, -thin), DVec3::new(1.0, thin, thin));
    let angle = random.random_range(0.0..3.0);
    pair(needle.clone(), turned(&needle, random, angle))
}

/// From outside or from inside, a little apart or a little into each other.
fn tangent_spheres(random: &mut Pcg64Mcg) -> Case {
    let gap = power(random, -16.0, -6.0) * if random.random_range(0..2) == 0 { 1.0 } else { -1.0 };
    let (radius, distance) = if random.random_range(0..2) == 0 { (1.0, 2.0 - gap) } else { (0.5, 0.5 - gap) };
    pair(ball(DVec3::ZERO, 1.0), ball(direction(random) * distance, radius))
}

fn sizes(random: &mut Pcg64Mcg) -> Case {
    let size = power(random, -6.0, 0.0);
    let at = DVec3::new(0.5, random.random_range(-0.4..0.4), random.random_range(-0.4..0.4));
    pair(moved(&unit(), DAffine3::from_scale(DVec3::splat(1e6))), ball(at * 1e6, size))
}

fn far(random: &mut Pcg64Mcg) -> Case {
    let far = DVec3::new(1e7, -2e7, 3e7);
    let angle = random.random_range(0.0..3.0);
    let two = turned(&unit(), random, angle);
    pair(shifted(&unit(), far), shifted(&two, far))
}

fn nested(random: &mut Pcg64Mcg) -> Case {
    let outer = ball(DVec3::ZERO, 1.0);
    let scale = 1.0 - power(random, -15.0, -3.0);
    pair(outer.clone(), moved(&outer, DAffine3::from_scale(DVec3::splat(scale))))
}

/// Cubes that share a corner or an edge, and something across that place.
fn self_touching(random: &mut Pcg64Mcg) -> Case {
    let by = match random.random_range(0..3) {
        0 => DVec3::new(1.0, 1.0, 0.0),
        1 => DVec3::ONE,
        _ => DVec3::new(1.0, 1.0, random.random_range(-0.9..0.9)),
    };
    let touching = joined(&[unit(), shifted(&unit(), by)]);
    let angle = random.random_range(0.0..3.0);
    let across = turned(&unit(), random, angle);
    pair(touching, shifted(&across, by * 0.5))
}

fn self_crossing(random: &mut Pcg64Mcg) -> Case {
    let low = vector(random) * 0.4;
    let size = DVec3::from([0; 3].map(|_| random.random_range(0.1..0.5)));
    let (one, two) = (unit(), cube(low, low + size));
    let (mesh, volume) = match random.random_range(0..3) {
        // A box that crosses a cube or lies in it.
        0 => {
            let common = (DVec3::splat(0.5).min(low + size) - DVec3::splat(-0.5).max(low)).element_product();
            (joined(&[one, two]), 1.0 + size.element_product() - common)
        }
        // A cube that covers itself twice or three times.
        1 => (joined(&[one.clone(), one.clone(), one]), 1.0),
        // A bar of cubes, each half in the next.
        _ => {
            let cubes: Vec<Mesh> = (0..4).map(|k| shifted(&one, DVec3::X * 0.5 * f64::from(k))).collect();
            (joined(&cubes), 2.5)
        }
    };
    let angle = random.random_range(0.0..3.0);
    Case::NotSimple { mesh: turned(&mesh, random, angle), volume }
}

/// Solids less themselves, and solids that are apart or touch.
fn empty(random: &mut Pcg64Mcg) -> Case {
    let angle = random.random_range(0.0..3.0);
    let one = turned(&[unit(), ball(DVec3::ZERO, 0.7)][random.random_range(0..2)], random, angle);
    match random.random_range(0..3) {
        0 => Case::Pair { common: Some(one.signed_volume()), solids: [one.clone(), one] },
        1 => Case::Pair { solids: [unit(), shifted(&unit(), DVec3::X)], common: Some(0.0) },
        _ => {
            let by = direction(random) * random.random_range(2.0..3.0);
            Case::Pair { solids: [one.clone(), shifted(&one, by)], common: Some(0.0) }
        }
    }
}

/// Cubes around each other's corners, turned by little or by much.
fn chain(random: &mut Pcg64Mcg) -> Case {
    let angle = power(random, -15.5, 0.0);
    let mut next = || {
        let at = (vector(random)).round() * 0.5;
        let by = random.random_range(-1.0..1.0) * angle;
        shifted(&turned(&unit(), random, by), at)
    };
    Case::Chain((0..5).map(|_| next()).collect())
}

/// Up to ten boxes of one lattice, all turned at once: faces that coincide but for a rounding, each in its own way.
fn lattice(random: &mut Pcg64Mcg) -> Case {
    const CELLS: usize = 4;
    let count = random.random_range(2..=10);
    let corners: Vec<[[usize; 3]; 2]> = (0..count)
        .map(|_| {
            let low = [0; 3].map(|_| random.random_range(0..CELLS));
            [low, low.map(|x| random.random_range(x + 1..=CELLS))]
        })
        .collect();
    let expression = expression(random, count);
    let step = [1.0, 0.1, 1.0 / 3.0][random.random_range(0..3)];
    let by = DAffine3::from_axis_angle(direction(random), random.random_range(0.0..3.0));
    let place = |corner: [usize; 3]| DVec3::from(corner.map(|x| x as f64 * step));
    let solids = corners.iter().map(|[low, high]| moved(&cube(place(*low), place(*high)), by)).collect();
    let is_inside = |cell: [usize; 3]| {
        let inside: Vec<bool> =
            corners.iter().map(|[low, high]| (0..3).all(|k| (low[k]..high[k]).contains(&cell[k]))).collect();
        expression.contains(&inside)
    };
    let cells = (0..CELLS.pow(3)).filter(|n| is_inside([n % CELLS, n / CELLS % CELLS, n / CELLS / CELLS])).count();
    let volume = Some(cells as f64 * step.powi(3));
    Case::Tree { solids, expression, volume }
}

/// One operation on all, or a tree of operations.
fn expression(random: &mut Pcg64Mcg, count: usize) -> Expression {
    let all = || (0..count).map(Expression::Operand).collect::<Vec<_>>();
    match random.random_range(0..5) {
        0 => Expression::Union(all()),
        1 => Expression::Intersection(all()),
        2 => Expression::difference(Expression::Operand(0), Expression::Union(all().split_off(1))),
        3 => Expression::SymmetricDifference(all()),
        _ => {
            let mut trees = all();
            while trees.len() > 1 {
                let one = trees.swap_remove(random.random_range(0..trees.len()));
                let two = trees.swap_remove(random.random_range(0..trees.len()));
                trees.push(match random.random_range(0..4) {
                    0 => Expression::Union(vec![one, two]),
                    1 => Expression::Intersection(vec![one, two]),
                    2 => Expression::difference(one, two),
                    _ => Expression::SymmetricDifference(vec![one, two]),
                });
            }
            trees.remove(0)
        }
    }
}
