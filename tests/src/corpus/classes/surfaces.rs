//! Surfaces that are not simple.

use super::super::CorpusCase;
use super::shapes::{cube, joined, power, shifted, turned, unit, vector};
use glam::DVec3;
use host::mesh::Mesh;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

pub(super) fn self_crossing(random: &mut Pcg64Mcg) -> CorpusCase {
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
    CorpusCase::NotSimple { mesh: turned(&mesh, random, angle), volume }
}

/// A cube and tetrahedra beside it, 1e-16 to 1e-3 thick, of which each may face inwards; the cube too.
pub(super) fn slivers(random: &mut Pcg64Mcg) -> CorpusCase {
    let turn_some = |mesh: Mesh, random: &mut Pcg64Mcg| if random.random() { mesh.reversed() } else { mesh };
    let (mut parts, mut volume) = (vec![turn_some(unit(), random)], 1.0);
    for place in 0..random.random_range(1..6) {
        let thickness = power(random, -16.0, -3.0);
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, thickness)];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let sliver = Mesh { vertices: corners.to_vec(), triangles, ..Mesh::default() };
        let sliver = shifted(&sliver, DVec3::X * f64::from(2 + 2 * place));
        volume += thickness / 6.0;
        parts.push(turn_some(sliver, random));
    }
    // One of them faces inwards for certain.
    let last = parts.len() - 1;
    if parts.iter().all(|part| part.signed_volume() >= 0.0) {
        parts[last] = parts[last].clone().reversed();
    }
    CorpusCase::NotSimple { mesh: joined(&parts), volume }
}
