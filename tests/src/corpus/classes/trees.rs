//! Expressions over several solids, and results that are operands again.

use super::super::CorpusCase;
use super::shapes::{ball, cube, direction, moved, power, shifted, turned, unit, vector};
use glam::{DAffine3, DVec3};
use host::mesh::{Mesh, bunny};
use host::solid::Expression;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Cubes around each other's corners, turned by little or by much.
pub(super) fn chain(random: &mut Pcg64Mcg) -> CorpusCase {
    let angle = power(random, -15.5, 0.0);
    let mut next = || {
        let at = (vector(random)).round() * 0.5;
        let by = random.random_range(-1.0..1.0) * angle;
        shifted(&turned(&unit(), random, by), at)
    };
    CorpusCase::Chain((0..5).map(|_| next()).collect())
}

/// Up to ten boxes of one lattice, all turned at once: faces that coincide but for a rounding, each in its own way.
pub(super) fn lattice(random: &mut Pcg64Mcg) -> CorpusCase {
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
    CorpusCase::Tree { solids, expression, volume }
}

/// Trees over boxes and spheres that are anywhere, or nearly where another is.
pub(super) fn nested(random: &mut Pcg64Mcg) -> CorpusCase {
    let count = random.random_range(3..=8);
    let mut solids: Vec<Mesh> = Vec::new();
    for _ in 0..count {
        let angle = random.random_range(0.0..3.0);
        solids.push(match random.random_range(0..4) {
            0 => ball(vector(random) * 0.5, random.random_range(0.3..0.8)),
            1 | 2 => {
                let by = vector(random) * 0.5;
                shifted(&turned(&unit(), random, angle), by)
            }
            _ => {
                let other = solids.get(random.random_range(0..count)).cloned().unwrap_or_else(unit);
                let little = power(random, -16.0, -3.0);
                turned(&other, random, little)
            }
        });
    }
    CorpusCase::Tree { expression: expression(random, count), solids, volume: None }
}

/// Plates as thin as 1e-3 to 1e-12, crosswise, nearly in each other, or turned alike.
pub(super) fn plates(random: &mut Pcg64Mcg) -> CorpusCase {
    let count = random.random_range(2..=6);
    let thin = power(random, -12.0, -3.0);
    let angle = if random.random_range(0..2) == 0 { random.random_range(0.0..3.0) } else { power(random, -15.0, -2.0) };
    let mut plate = || {
        let low = DVec3::new(random.random_range(-1.0..0.0), random.random_range(-2.0..2.0) * thin, -1.0);
        let high = DVec3::new(random.random_range(0.0..1.0), 0.0, random.random_range(0.0..1.0));
        let flat = cube(low, high.with_y(low.y + thin * random.random_range(0.5..2.0)));
        let flat = turned(&flat, random, angle);
        let quarters = f64::from(random.random_range(0..4)) * std::f64::consts::FRAC_PI_2;
        if random.random_range(0..2) == 0 { moved(&flat, DAffine3::from_rotation_x(quarters)) } else { flat }
    };
    let solids = (0..count).map(|_| plate()).collect();
    CorpusCase::Tree { expression: expression(random, count), solids, volume: None }
}

/// Scanned surfaces across each other and across a box or a sphere.
pub(super) fn scanned(random: &mut Pcg64Mcg) -> CorpusCase {
    let mut solids: Vec<Mesh> = Vec::new();
    for _ in 0..random.random_range(1..=2) {
        let bunny = bunny().expect("it ships").simplified([300, 1000, 3000][random.random_range(0..3)]);
        let angle =
            if random.random_range(0..2) == 0 { random.random_range(0.0..3.0) } else { power(random, -15.0, -2.0) };
        let by = vector(random) * power(random, -16.0, -1.0);
        solids.push(shifted(&turned(&bunny, random, angle), by));
    }
    let center = solids[0].vertices.iter().sum::<DVec3>() / solids[0].vertices.len() as f64;
    let size = solids[0].vertices.iter().map(|v| v.distance(center)).fold(0.0, f64::max);
    let by = center + vector(random) * size * 0.5;
    let turn = random.random_range(0.0..3.0);
    solids.push(match random.random_range(0..2) {
        0 => ball(by, size * 0.5),
        _ => {
            let large = moved(&unit(), DAffine3::from_scale(DVec3::splat(size)));
            shifted(&turned(&large, random, turn), by)
        }
    });
    CorpusCase::Tree { expression: expression(random, solids.len()), solids, volume: None }
}

/// Ten operations, each on the result before.
pub(super) fn deep(random: &mut Pcg64Mcg) -> CorpusCase {
    let angle = power(random, -15.5, 0.0);
    let is_round = random.random_range(0..3) == 0;
    let mut next = || {
        let at = if random.random_range(0..2) == 0 { vector(random) } else { vector(random).round() * 0.5 };
        let by = random.random_range(-1.0..1.0) * angle;
        let solid = if is_round { ball(DVec3::ZERO, 0.6) } else { unit() };
        shifted(&turned(&solid, random, by), at)
    };
    CorpusCase::Chain((0..11).map(|_| next()).collect())
}

/// Boxes and spheres across each other, by much or by little.
pub(super) fn single(random: &mut Pcg64Mcg) -> CorpusCase {
    let angle = if random.random_range(0..2) == 0 { random.random_range(0.0..3.0) } else { power(random, -9.0, -1.0) };
    let mut next = || {
        let solid = if random.random_range(0..2) == 0 { ball(DVec3::ZERO, 0.6) } else { unit() };
        let by = if random.random_range(0..2) == 0 { vector(random) * 0.5 } else { vector(random).round() * 0.5 };
        shifted(&turned(&solid, random, angle), by)
    };
    CorpusCase::Single([next(), next(), next()])
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
