//! Organs as triangles, in coordinates of their own: x to the right, y ahead, z up from the blade; of length 1.

use super::organ::{BladeArrangement, Organ};
use crate::mesh::Mesh;
use crate::numeric::sampling::{RandomStream, mix};
use crate::polygon::{TriangulationKind, triangulate_in_space};
use crate::procedural::Varied;
use crate::procedural::drawing::push;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// So many organs of a kind differ in how they are folded and curled.
pub const ORGAN_VARIANTS: usize = 3;
/// Golden angle, degrees: the turn between leaves of a shoot.
const GOLDEN: f64 = 137.507_764;
/// Least and greatest length of a leaflet, in parts of that of its leaf without the stalk.
const LEAFLET: [f64; 2] = [0.12, 0.42];
/// Width of a stalk in parts of the organ.
const STALK_WIDTH: f64 = 0.014;
/// How far an edge of an outline bulges, in parts of the length.
const ASIDE: f64 = 2e-3;
/// The least angle by which the parts of a midrib bend, degrees.
const BEND: f64 = 25.0;
/// Most parts of a midrib.
const MOST_PARTS: usize = 8;

/// A blade that is bent: folded along its midrib, and curled down along an arc.
struct BentBlade<'a> {
    corners: &'a [DVec2],
    width: f64,
    fold: f64,
    curl: f64,
    /// From its coordinates, of length 1, to those of the organ.
    axes: DMat3,
    at: DVec3,
}

/// The triangles of one of the variants of an organ of length 1.
///
/// - `variant`: below [`ORGAN_VARIANTS`].
/// - `detail`: what may be left out, in parts of the length.
pub(super) fn organ_mesh(organ: &Organ, variant: usize, detail: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let mut random = RandomStream::new(mix(variant as u64 + 1), 7);
    let mut draw = |varied: Varied| varied.at(random.uniform());
    if organ.arrangement == BladeArrangement::Ball {
        append_ball(&mut mesh, organ.width, detail);
        return mesh;
    }
    let stalk = organ.stalk.clamp(0.0, 0.95);
    let rest = 1.0 - stalk;
    let base = DVec3::Y * stalk;
    // Blades of length 1 lose what is smaller than the detail.
    let blade = |length: f64| organ.outline.simplified(0.25 * (detail / length.max(1e-6)).powi(2));
    let ahead = DMat3::IDENTITY;
    let mut place = |mesh: &mut Mesh, corners: &[DVec2], length: f64, axes: DMat3, at: DVec3| {
        let bent = BentBlade {
            corners,
            width: organ.width,
            fold: draw(organ.fold).to_radians(),
            curl: draw(organ.curl).to_radians(),
            axes: axes * length,
            at,
        };
        bent.append_to(mesh, detail / length);
    };
    match organ.arrangement {
        BladeArrangement::Simple => place(&mut mesh, &blade(rest), rest, ahead, base),
        BladeArrangement::Pinnate { blades, angle } => {
            let pairs = (blades / 2).max(1);
            // As long as lets neighbours touch each other.
            let [least, most] = LEAFLET;
            let length = rest * (organ.width * f64::from(pairs + 1)).recip().clamp(least, most);
            let corners = blade(length);
            for pair in 0..pairs {
                let part = (f64::from(pair) + 0.5) / f64::from(pairs);
                let at = base + DVec3::Y * (rest - length) * part;
                let size = length * (1.0 - 0.45 * (2.0 * part - 0.8).powi(2));
                for side in [-1.0, 1.0] {
                    let axes = DMat3::from_rotation_z(-side * angle.to_radians());
                    place(&mut mesh, &corners, size, axes, at);
                }
            }
            place(&mut mesh, &corners, length, ahead, base + DVec3::Y * (rest - length));
        }
        BladeArrangement::Palmate { blades, angle } => {
            let corners = blade(rest);
            for blade in 0..blades {
                let part = if blades > 1 { f64::from(blade) / f64::from(blades - 1) - 0.5 } else { 0.0 };
                let axes = DMat3::from_rotation_z(part * angle.to_radians());
                place(&mut mesh, &corners, rest * (1.0 - 0.8 * part * part), axes, base);
            }
        }
        BladeArrangement::Rosette { blades, angle } => {
            let corners = blade(rest);
            for blade in 0..blades {
                let turn = TAU * f64::from(blade) / f64::from(blades);
                // The upper side of a petal looks to the axis.
                let axes = DMat3::from_rotation_y(turn) * DMat3::from_rotation_x(angle.to_radians());
                let raised = base + DVec3::Y * (1e-3 * f64::from(blade % 2));
                place(&mut mesh, &corners, rest, axes * DMat3::from_rotation_y(PI), raised);
            }
        }
        BladeArrangement::Brush { blades, angle, length } => {
            let corners = blade(length);
            // Of needles that are thinner than what is seen there are fewer and wider ones.
            let kept = (f64::from(blades) * (organ.width * length / (0.7 * detail)).min(1.0)).ceil().max(4.0);
            let wider = f64::from(blades) / kept.min(f64::from(blades));
            for blade in 0..kept.min(f64::from(blades)) as u32 {
                let part = (f64::from(blade) + 0.5) / kept;
                let turn = (GOLDEN * f64::from(blade)).to_radians();
                let axes = DMat3::from_rotation_y(turn) * DMat3::from_rotation_x(angle.to_radians());
                let wide = DMat3::from_diagonal(DVec3::new(wider, 1.0, 1.0));
                place(&mut mesh, &corners, length, axes * wide, DVec3::Y * (1.0 - length) * part);
            }
        }
        BladeArrangement::Ball => {}
    }
    let shaft = match organ.arrangement {
        BladeArrangement::Pinnate { .. } => 0.9,
        BladeArrangement::Brush { length, .. } => 1.0 - 0.5 * length,
        _ => stalk,
    };
    if shaft > 0.0 && detail < 0.2 {
        append_shaft(&mut mesh, shaft);
    }
    mesh
}

impl BentBlade<'_> {
    /// Where a place of the blade is, and the normal there.
    fn place(&self, side: f64, at: DVec2) -> [DVec3; 2] {
        let x = at.x * self.width;
        // Along an arc of this angle, which begins ahead and bends down.
        let (sin, cos) = (self.curl * at.y).sin_cos();
        let along = if self.curl.abs() < 1e-6 {
            DVec3::new(0.0, at.y, 0.0)
        } else {
            DVec3::new(0.0, sin / self.curl, (cos - 1.0) / self.curl)
        };
        let up = DVec3::new(0.0, sin, cos);
        let (rise, across) = self.fold.sin_cos();
        let place = along + DVec3::X * (side * x * across) + up * (x * rise);
        let normal = up * across - DVec3::X * (side * rise);
        [self.at + self.axes * place, (self.axes * normal).normalize_or(DVec3::Z)]
    }

    fn append_to(&self, mesh: &mut Mesh, detail: f64) {
        // The midrib has as many parts as its curl asks for, where that is seen.
        let sagitta = self.curl.abs() / 8.0;
        let seen = (sagitta / (0.5 * detail)).sqrt().ceil();
        let parts = (self.curl.to_degrees().abs() / BEND).ceil().min(seen).clamp(1.0, MOST_PARTS as f64) as usize;
        let outline = cut_across(self.corners, parts);
        let flat: Vec<DVec3> = outline.iter().map(|corner| corner.extend(0.0)).collect();
        let filled = triangulate_in_space(&[&flat], TriangulationKind::Delaunay).map(|filled| filled.triangles);
        let fan = || (1..outline.len() as u32 - 1).map(|second| [0, second, second + 1]).collect();
        let triangles = filled.unwrap_or_else(|_| fan());
        for side in [1.0, -1.0] {
            let first = mesh.vertices.len() as u32;
            let places: Vec<[DVec3; 2]> = outline.iter().map(|corner| self.place(side, *corner)).collect();
            mesh.vertices.extend(places.iter().map(|[at, _]| *at));
            for triangle in &triangles {
                let corners = if side > 0.0 { *triangle } else { [triangle[0], triangle[2], triangle[1]] };
                let normals = corners.map(|corner| places[corner as usize][1]);
                let parameters = corners.map(|corner| {
                    let at = outline[corner as usize];
                    DVec2::new(0.5 + side * at.x, at.y)
                });
                push(mesh, corners.map(|corner| first + corner), normals, parameters, 0);
            }
        }
    }
}

/// Half an outline closed along its midrib, with corners at each of the heights at which the blade bends.
///
/// Edges bulge a little: a triangulation leaves out corners on a straight one.
fn cut_across(corners: &[DVec2], parts: usize) -> Vec<DVec2> {
    let heights = || (1..parts).map(|part| part as f64 / parts as f64);
    let bulge = |along: f64| 4.0 * ASIDE * along * (1.0 - along);
    let mut outline = Vec::new();
    for pair in corners.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        outline.push(from);
        let mut between: Vec<f64> = heights()
            .map(|height| (height - from.y) / (to.y - from.y))
            .filter(|along| (0.02..0.98).contains(along))
            .collect();
        between.sort_by(f64::total_cmp);
        outline.extend(between.into_iter().map(|along| from.lerp(to, along) + DVec2::X * bulge(along)));
    }
    outline.extend(corners.last());
    outline.extend(heights().rev().map(|height| DVec2::new(-bulge(height), height)));
    outline
}

/// Appends two crossed strips that stand for a stalk, a midrib or a twig.
fn append_shaft(mesh: &mut Mesh, length: f64) {
    for [across, normal] in [[DVec3::X, DVec3::Z], [DVec3::Z, -DVec3::X]] {
        let first = mesh.vertices.len() as u32;
        let side = across * (0.5 * STALK_WIDTH);
        let sink = DVec3::NEG_Z * 1e-3;
        mesh.vertices
            .extend([-side, side, side * 0.6 + DVec3::Y * length, side * -0.6 + DVec3::Y * length].map(|v| v + sink));
        for corners in [[0, 1, 2], [0, 2, 3]] {
            let parameters = corners.map(|corner| DVec2::new(0.5, if corner < 2 { 0.0 } else { length }));
            push(mesh, corners.map(|corner| first + corner), [normal; 3], parameters, 0);
        }
    }
}

/// Appends an egg around the y axis, from the origin to (0, 1, 0).
fn append_ball(mesh: &mut Mesh, width: f64, detail: f64) {
    let radius = 0.5 * width.max(1.0);
    let sides =
        if detail >= radius { 4 } else { ((PI / (1.0 - 0.5 * detail / radius).acos()).ceil() as usize).clamp(4, 48) };
    let bands = sides.div_ceil(2).max(2);
    let first = mesh.vertices.len() as u32;
    let direction = |band: usize, side: usize| {
        let (sin, cos) = (PI * band as f64 / bands as f64 - FRAC_PI_2).sin_cos();
        let (across, along) = (TAU * side as f64 / sides as f64).sin_cos();
        DVec3::new(cos * across, sin, cos * along)
    };
    for band in 0..=bands {
        for side in 0..sides {
            let of_ball = direction(band, side);
            mesh.vertices.push(DVec3::new(0.5 * width, 0.5, 0.5 * width) * of_ball + DVec3::Y * 0.5);
        }
    }
    let normal = |band: usize, side: usize| {
        (direction(band, side) / DVec3::new(width.max(1e-6), 1.0, width.max(1e-6))).normalize_or(DVec3::Y)
    };
    for band in 0..bands {
        for side in 0..sides {
            for corners in [[(0, 0), (1, 1), (0, 1)], [(0, 0), (1, 0), (1, 1)]] {
                // At a pole one of the two has two equal corners.
                let is_point = |row: usize| band + row == 0 || band + row == bands;
                let on_pole = corners.iter().filter(|(row, _)| is_point(*row)).count();
                if on_pole > 1 {
                    continue;
                }
                let places = corners.map(|(row, next)| first + ((band + row) * sides + (side + next) % sides) as u32);
                let normals = corners.map(|(row, next)| normal(band + row, side + next));
                let parameters = corners.map(|(row, next)| {
                    DVec2::new((side + next) as f64 / sides as f64, (band + row) as f64 / bands as f64)
                });
                push(mesh, places, normals, parameters, 0);
            }
        }
    }
}
