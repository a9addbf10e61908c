//! Crystals: the planes that bound one, by its habit.

use crate::numeric::sampling::{RandomStream, mix};
use glam::DVec3;
use std::f64::consts::TAU;

/// The habit of a crystal: which faces it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrystalHabit {
    /// A six-sided prism with a six-sided point at each end.
    Quartz,
    /// Eight faces.
    Octahedron,
    /// Six faces at right angles.
    Cube,
    /// Twelve faces.
    Garnet,
    /// A slanted box: of calcite.
    Rhombohedron,
}

/// The habits with their words.
pub const CRYSTAL_HABITS: [(&str, CrystalHabit); 5] = [
    ("quartz", CrystalHabit::Quartz),
    ("octahedron", CrystalHabit::Octahedron),
    ("cube", CrystalHabit::Cube),
    ("garnet", CrystalHabit::Garnet),
    ("rhombohedron", CrystalHabit::Rhombohedron),
];

/// Angle between the faces of the prism and of the point of quartz, degrees.
const QUARTZ_POINT: f64 = 38.2;
/// Angle between the normals of calcite's faces and the plane across its axis, degrees.
const CALCITE: f64 = 45.4;

impl CrystalHabit {
    /// The normals of its faces, with their distances from the middle where all is even: its axis is y.
    ///
    /// - `slenderness`: of a prism, its length in parts of its width.
    fn faces(self, slenderness: f64) -> Vec<(DVec3, f64)> {
        let around = |turn: f64, above: f64| {
            let (up, out) = above.to_radians().sin_cos();
            let (sin, cos) = (TAU * turn).sin_cos();
            DVec3::new(out * cos, up, out * sin)
        };
        let signs = || (0..8).map(|k| DVec3::new(sign(k & 1), sign(k & 2), sign(k & 4)));
        match self {
            CrystalHabit::Quartz => {
                let sides = (0..6).map(|k| (around(f64::from(k) / 6.0, 0.0), 0.5));
                // The point is above the middle of the end by half a width over the tangent of its angle.
                let end = 0.5 * slenderness;
                let (sin, _) = QUARTZ_POINT.to_radians().sin_cos();
                let points = (0..12).map(|k| {
                    let side = if k < 6 { 1.0 } else { -1.0 };
                    let normal = around(f64::from(k % 6) / 6.0, QUARTZ_POINT);
                    (DVec3::new(normal.x, side * normal.y, normal.z), end * sin)
                });
                sides.chain(points).collect()
            }
            CrystalHabit::Octahedron => signs().map(|normal| (normal.normalize(), 0.5)).collect(),
            CrystalHabit::Cube => {
                [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [(axis, 0.5), (-axis, 0.5)]).collect()
            }
            CrystalHabit::Garnet => {
                let pairs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
                let of = |[a, b]: [f64; 2]| [DVec3::new(a, b, 0.0), DVec3::new(0.0, a, b), DVec3::new(a, 0.0, b)];
                pairs.into_iter().flat_map(of).map(|normal| (normal.normalize(), 0.5)).collect()
            }
            CrystalHabit::Rhombohedron => (0..3)
                .flat_map(|k| {
                    let normal = around(f64::from(k) / 3.0, CALCITE);
                    [(normal, 0.5), (-normal, 0.5)]
                })
                .collect(),
        }
    }
}

fn sign(bit: u32) -> f64 {
    if bit == 0 { 1.0 } else { -1.0 }
}

/// The planes that bound a crystal of width 1 around the origin: unit normals outwards, and distances.
///
/// - `slenderness`: of a prism, its length in parts of its width, above 0.
/// - `irregularity`: how far faces are from where they would be if all had grown alike, in parts of that, 0 to 0.5.
pub fn crystal_planes(habit: CrystalHabit, slenderness: f64, irregularity: f64, seed: u64) -> Vec<(DVec3, f64)> {
    let mut random = RandomStream::new(mix(seed), 12);
    let moved = |(normal, distance): (DVec3, f64)| {
        (normal, distance * (1.0 + irregularity.clamp(0.0, 0.5) * (2.0 * random.uniform() - 1.0)))
    };
    habit.faces(slenderness).into_iter().map(moved).collect()
}
