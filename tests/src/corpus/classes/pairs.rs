//! Pairs of solids.

use super::super::CorpusCase;
use super::shapes::{ball, cube, direction, joined, moved, pair, power, shifted, turned, unit, vector};
use glam::{DAffine3, DVec3};
use host::mesh::{Mesh, bunny};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Boxes whose corners are on a grid of sevenths, which have no exact numbers.
pub(super) fn coincident(random: &mut Pcg64Mcg) -> CorpusCase {
    let mut corners = || {
        let low = [0; 3].map(|_| random.random_range(0..3));
        [low, low.map(|x| random.random_range(x + 1..4))].map(|corner| DVec3::from(corner.map(f64::from)))
    };
    let ([a, b], [p, q]) = (corners(), corners());
    let common = (b.min(q) - a.max(p)).max(DVec3::ZERO).element_product() / 343.0;
    CorpusCase::Pair { solids: [cube(a / 7.0, b / 7.0), cube(p / 7.0, q / 7.0)], common: Some(common) }
}

pub(super) fn nearly_coincident(random: &mut Pcg64Mcg) -> CorpusCase {
    let by = vector(random) * power(random, -15.0, -3.0);
    let other = shifted(&unit(), by);
    let at = |mesh: &Mesh, high: bool| {
        let start = DVec3::splat(if high { f64::NEG_INFINITY } else { f64::INFINITY });
        mesh.vertices.iter().fold(start, |m, v| if high { m.max(*v) } else { m.min(*v) })
    };
    let sides = at(&unit(), true).min(at(&other, true)) - at(&unit(), false).max(at(&other, false));
    CorpusCase::Pair { solids: [unit(), other], common: Some(sides.element_product()) }
}

pub(super) fn tiny_turn(random: &mut Pcg64Mcg) -> CorpusCase {
    let angle = power(random, -15.0, -3.0);
    let axis = if random.random_range(0..3) == 0 { DVec3::Z } else { direction(random) };
    pair(unit(), moved(&unit(), DAffine3::from_axis_angle(axis, angle)))
}

pub(super) fn spheres_turned(random: &mut Pcg64Mcg) -> CorpusCase {
    let angle = power(random, -15.0, -3.0);
    let sphere = ball(DVec3::ZERO, 1.0);
    pair(sphere.clone(), turned(&sphere, random, angle))
}

pub(super) fn bunnies_turned(random: &mut Pcg64Mcg) -> CorpusCase {
    let bunny = bunny().expect("it ships").simplified(500);
    let angle = power(random, -15.0, -1.0);
    pair(bunny.clone(), turned(&bunny, random, angle))
}

pub(super) fn slivers(random: &mut Pcg64Mcg) -> CorpusCase {
    let thin = power(random, -12.0, -3.0);
    let plate = cube(DVec3::new(-1.0, -thin, -1.0), DVec3::new(1.0, thin, 1.0));
    let turn = DAffine3::from_rotation_z(random.random_range(0.0..4.0) * thin);
    pair(plate.clone(), moved(&plate, turn))
}

pub(super) fn needles(random: &mut Pcg64Mcg) -> CorpusCase {
    let thin = power(random, -9.0, -3.0);
    let needle = cube(DVec3::new(-1.0, -thin, -thin), DVec3::new(1.0, thin, thin));
    let angle = random.random_range(0.0..3.0);
    pair(needle.clone(), turned(&needle, random, angle))
}

/// From outside or from inside, a little apart or a little into each other.
pub(super) fn tangent_spheres(random: &mut Pcg64Mcg) -> CorpusCase {
    let gap = power(random, -16.0, -6.0) * if random.random_range(0..2) == 0 { 1.0 } else { -1.0 };
    let (radius, distance) = if random.random_range(0..2) == 0 { (1.0, 2.0 - gap) } else { (0.5, 0.5 - gap) };
    pair(ball(DVec3::ZERO, 1.0), ball(direction(random) * distance, radius))
}

pub(super) fn sizes(random: &mut Pcg64Mcg) -> CorpusCase {
    let size = power(random, -6.0, 0.0);
    let at = DVec3::new(0.5, random.random_range(-0.4..0.4), random.random_range(-0.4..0.4));
    pair(moved(&unit(), DAffine3::from_scale(DVec3::splat(1e6))), ball(at * 1e6, size))
}

pub(super) fn far(random: &mut Pcg64Mcg) -> CorpusCase {
    let far = DVec3::new(1e7, -2e7, 3e7);
    let angle = random.random_range(0.0..3.0);
    let two = turned(&unit(), random, angle);
    pair(shifted(&unit(), far), shifted(&two, far))
}

pub(super) fn nested(random: &mut Pcg64Mcg) -> CorpusCase {
    let outer = ball(DVec3::ZERO, 1.0);
    let scale = 1.0 - power(random, -15.0, -3.0);
    pair(outer.clone(), moved(&outer, DAffine3::from_scale(DVec3::splat(scale))))
}

/// Cubes that share a corner or an edge, and something across that place.
pub(super) fn self_touching(random: &mut Pcg64Mcg) -> CorpusCase {
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

/// Solids less themselves, and solids that are apart or touch.
pub(super) fn empty(random: &mut Pcg64Mcg) -> CorpusCase {
    let angle = random.random_range(0.0..3.0);
    let one = turned(&[unit(), ball(DVec3::ZERO, 0.7)][random.random_range(0..2)], random, angle);
    match random.random_range(0..3) {
        0 => CorpusCase::Pair { common: Some(one.signed_volume()), solids: [one.clone(), one] },
        1 => CorpusCase::Pair { solids: [unit(), shifted(&unit(), DVec3::X)], common: Some(0.0) },
        _ => {
            let by = direction(random) * random.random_range(2.0..3.0);
            CorpusCase::Pair { solids: [one.clone(), shifted(&one, by)], common: Some(0.0) }
        }
    }
}
