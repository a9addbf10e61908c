//! Surfaces that are not simple.

use super::super::Case;
use super::{cube, joined, shifted, turned, unit, vector};
use glam::DVec3;
use host::mesh::Mesh;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

pub(super) fn self_crossing(random: &mut Pcg64Mcg) -> Case {
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
