//! Surfaces into triangles, to a tolerance, without cracks.
//!
//! Every surface becomes a full grid. A side that two surfaces share is divided once and its vertices serve both, so
//! that nothing can open between them; for that the surfaces along a strip (sides that face each other) have the same
//! number of segments across. The numbers come from the sagitta of the parameter lines and from the turn of the
//! normals; then the distance between grid and surface is measured and the numbers are raised until it fits.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::shared_curves::{SharedCurves, along_side};
use super::{ParameterLine, Surface, between};
use crate::mesh::{Mesh, bits};

/// The most segments along a side.
const MAX_SEGMENTS: usize = 1 << 13;
/// The most triangles of a mesh.
const MAX_TRIANGLES: usize = 1 << 24;
/// Segments and lines of the estimate for a surface.
const ESTIMATE_SEGMENTS: usize = 16;
const ESTIMATE_LINES: usize = 9;
/// The points where a triangle is measured, as weights of its corners: an error that is quadratic over the triangle is
/// largest in one of them, or little larger elsewhere, for which the part of the tolerance leaves room.
const MEASURED_AT: [[f64; 3]; 4] =
    [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]];
const MEASURED_PART: f64 = 0.95;
/// Rounds of measuring and raising; each at least adds a segment, and usually two are enough.
const MAX_ROUNDS: usize = 24;

/// How closely a mesh follows its surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// The largest distance between mesh and surface, model units, positive.
    pub chord: f64,
    /// The largest angle between the surface normals at neighbouring vertices of a grid line, degrees, positive.
    pub angle: f64,
}

impl Tolerance {
    /// `chord` in model units, `angle` in degrees; 180 leaves the angle free.
    pub fn new(chord: f64, angle: f64) -> Tolerance {
        Tolerance { chord, angle }
    }
}

/// A fault that keeps surfaces from being tessellated or measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TessellationError {
    /// A tolerance that is not a positive number.
    #[error("chord {chord} and angle {angle} degrees must be positive")]
    Tolerance {
        /// The chord.
        chord: f64,
        /// The angle.
        angle: f64,
    },
    /// A surface with a point that is not finite.
    #[error("surface {surface} has points that are not finite")]
    NotFinite {
        /// Its index.
        surface: usize,
    },
    /// A tolerance that would take too many triangles.
    #[error(
        "the tolerance asks for {segments} segments along a side of surface {surface} or too many triangles; raise it"
    )]
    TooFine {
        /// The index of the surface that asks for most.
        surface: usize,
        /// Its segments along a side.
        segments: usize,
    },
    /// A surface so uneven that more segments did not bring the mesh near enough.
    #[error("the mesh stays {error} away from surface {surface}; raise the tolerance")]
    NotReached {
        /// The index of the surface.
        surface: usize,
        /// The distance that was reached, model units.
        error: f64,
    },
    /// A mesh that does not know its surfaces.
    #[error("the mesh has no corner parameters or no surface indices")]
    NoParameters,
    /// A mesh that names a surface that is not there.
    #[error("surface {index} is outside the {count} surfaces")]
    NoSurface {
        /// The index.
        index: u32,
        /// The number of surfaces.
        count: usize,
    },
}

/// Approximates `surfaces` by triangles.
///
/// The mesh has the exact normals and parameters at its corners, and for each triangle the index of its surface. Sides
/// that agree become one row of vertices; where everything is shared the mesh is closed. A side that is a point becomes
/// one vertex, and the triangles that collapse there are left out.
///
/// # Errors
/// [`TessellationError`] if the tolerance is not positive, is too fine, or a surface is not finite.
pub fn tessellate<S: Surface>(surfaces: &[S], tolerance: Tolerance) -> Result<Mesh, TessellationError> {
    let Tolerance { chord, angle } = tolerance;
    if !(chord > 0.0 && angle > 0.0) {
        return Err(TessellationError::Tolerance { chord, angle });
    }
    let borders = SharedCurves::of(surfaces);
    let grids = Grids::fitted(surfaces, &borders, tolerance)?;
    Ok(Builder::new(surfaces, &borders, &grids).into_mesh())
}

/// The numbers of segments.
struct Grids {
    /// The strip of each curve.
    strips: Vec<usize>,
    /// The segments of each strip.
    segments: Vec<usize>,
}

/// An estimate of the segments that a surface takes in one of its two directions.
#[derive(Clone, Copy)]
struct SegmentEstimate {
    /// Sagitta of a single segment over the whole domain, extrapolated; model units.
    sagitta: f64,
    /// Turn of the normal over the whole domain, extrapolated; degrees.
    turn: f64,
}

impl SegmentEstimate {
    /// The segments that the direction takes, not rounded.
    fn segments(&self, tolerance: Tolerance) -> f64 {
        // The sagittas of both directions add up, so each gets half of the chord.
        let by_chord = (self.sagitta / (0.5 * tolerance.chord)).sqrt();
        by_chord.max(self.turn / tolerance.angle)
    }
}

/// The segments that the directions u and v of a surface take by an estimate, not rounded; `None` if a point is not
/// finite.
pub(super) fn estimated_segments<S: Surface>(surface: &S, tolerance: Tolerance) -> Option<[f64; 2]> {
    estimate(surface).map(|estimates| estimates.map(|look| look.segments(tolerance)))
}

impl Grids {
    fn fitted<S: Surface>(
        surfaces: &[S],
        borders: &SharedCurves,
        tolerance: Tolerance,
    ) -> Result<Grids, TessellationError> {
        let estimates: Vec<Option<[SegmentEstimate; 2]>> = surfaces.par_iter().map(estimate).collect();
        if let Some(surface) = estimates.iter().position(Option::is_none) {
            return Err(TessellationError::NotFinite { surface });
        }
        let looks: Vec<[SegmentEstimate; 2]> = estimates.into_iter().flatten().collect();
        let mut grids = Grids { strips: borders.strips(), segments: vec![1; borders.first.len()] };
        for (surface, estimates) in looks.iter().enumerate() {
            for (axis, look) in estimates.iter().enumerate() {
                // Where the sides across are one curve, the direction goes around: less than a triangle would be flat.
                let [from, to] = [2 - 2 * axis, 3 - 2 * axis].map(|side| borders.sides[surface][side].curve);
                let least = if from == to { 3.0 } else { 1.0 };
                grids.raise(borders, surface, axis, look.segments(tolerance).ceil().max(least))?;
            }
        }
        grids.raise_until_measured(surfaces, borders, &looks, tolerance.chord)?;
        Ok(grids)
    }

    fn raise_until_measured<S: Surface>(
        &mut self,
        surfaces: &[S],
        borders: &SharedCurves,
        estimates: &[[SegmentEstimate; 2]],
        chord: f64,
    ) -> Result<(), TessellationError> {
        let mut known: Vec<([usize; 2], f64)> = vec![([0; 2], 0.0); surfaces.len()];
        for _ in 0..MAX_ROUNDS {
            known.par_iter_mut().enumerate().for_each(|(surface, known)| {
                let counts = self.of(borders, surface);
                if known.0 != counts {
                    *known = (counts, measured_error(&surfaces[surface], counts));
                }
            });
            let mut fits = true;
            let errors = known.iter().enumerate().filter(|(_, (_, error))| *error > MEASURED_PART * chord);
            for (surface, &(counts, error)) in errors {
                fits = false;
                let part = |axis: usize| estimates[surface][axis].sagitta / (counts[axis] * counts[axis]) as f64;
                for axis in [0, 1] {
                    // A direction that has no share in the error is left alone.
                    if part(axis) >= 0.05 * part(1 - axis) {
                        let wanted = counts[axis] as f64 * (error / (MEASURED_PART * chord)).sqrt();
                        self.raise(borders, surface, axis, wanted.ceil().max(counts[axis] as f64 + 1.0))?;
                    }
                }
            }
            if fits {
                return Ok(());
            }
        }
        let worst = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        let (surface, error) = known.iter().map(|known| known.1).enumerate().max_by(worst).unwrap_or_default();
        Err(TessellationError::NotReached { surface, error })
    }

    /// The segments of a surface along u and v.
    fn of(&self, borders: &SharedCurves, surface: usize) -> [usize; 2] {
        [0, 2].map(|side| self.segments[self.strips[borders.sides[surface][side].curve]])
    }

    fn raise(
        &mut self,
        borders: &SharedCurves,
        surface: usize,
        axis: usize,
        wanted: f64,
    ) -> Result<(), TessellationError> {
        let segments = wanted.min(usize::MAX as f64) as usize;
        let strip = self.strips[borders.sides[surface][2 * axis].curve];
        self.segments[strip] = self.segments[strip].max(segments.min(MAX_SEGMENTS + 1));
        let quads = |surface| self.of(borders, surface).iter().product::<usize>();
        let triangles: usize = 2 * (0..borders.sides.len()).map(quads).sum::<usize>();
        if segments > MAX_SEGMENTS || triangles > MAX_TRIANGLES {
            return Err(TessellationError::TooFine { surface, segments });
        }
        Ok(())
    }
}

/// The parameters at the fractions `i` / `count` of both directions.
fn grid_uv([low, high]: [DVec2; 2], counts: [usize; 2], i: usize, j: usize) -> DVec2 {
    let fraction = |k: usize, count: usize| k as f64 / count as f64;
    DVec2::new(between(low.x, high.x, fraction(i, counts[0])), between(low.y, high.y, fraction(j, counts[1])))
}

/// Estimates for both directions; `None` if a point is not finite.
fn estimate<S: Surface>(surface: &S) -> Option<[SegmentEstimate; 2]> {
    let domain = surface.domain();
    let mut estimates = [SegmentEstimate { sagitta: 0.0, turn: 0.0 }; 2];
    // Points at the ends and middles of the segments of a few parameter lines.
    let (along, across) = (2 * ESTIMATE_SEGMENTS, ESTIMATE_LINES - 1);
    for (axis, look) in estimates.iter_mut().enumerate() {
        let counts = if axis == 0 { [along, across] } else { [across, along] };
        let rows: Vec<Vec<[DVec3; 2]>> = (0..=counts[1])
            .map(|j| {
                let line = surface.line(grid_uv(domain, counts, 0, j).y);
                (0..=counts[0]).map(|i| line(grid_uv(domain, counts, i, j).x)).collect()
            })
            .collect();
        let sample = |line: usize, k: usize| if axis == 0 { rows[line][k] } else { rows[k][line] };
        for line in 0..ESTIMATE_LINES {
            let is_side = line == 0 || line == ESTIMATE_LINES - 1;
            for k in (0..along).step_by(2) {
                let [[a, from], [middle, normal], [b, to]] = [k, k + 1, k + 2].map(|k| sample(line, k));
                let offset = middle - (a + b) * 0.5;
                if !offset.is_finite() {
                    return None;
                }
                // Inside, what bends within the surface makes no error; a side must be followed in any direction.
                let along = (b - a).normalize_or_zero();
                let across = offset - along * offset.dot(along);
                let sagitta = if is_side { across.length() } else { offset.dot(normal).abs() };
                look.sagitta = look.sagitta.max(sagitta * (ESTIMATE_SEGMENTS * ESTIMATE_SEGMENTS) as f64);
                let turn = from.cross(to).length().atan2(from.dot(to)).to_degrees();
                look.turn = look.turn.max(turn * ESTIMATE_SEGMENTS as f64);
            }
        }
    }
    Some(estimates)
}

/// Whether a quad with the corners 00, 10, 11, 01 is cut from 10 to 01: if that is clearly nearer to the surface than
/// the cut from 00 to 11.
///
/// - `middle`: the point of the surface in its middle, and the normal there.
fn is_cut_backward([center, normal]: [DVec3; 2], corners: [DVec3; 4]) -> bool {
    let height = |a: DVec3, b: DVec3| ((a - center) * 0.5 + (b - center) * 0.5).dot(normal).abs();
    height(corners[1], corners[3]) < 0.9 * height(corners[0], corners[2])
}

/// The two triangles of a quad as corner numbers; corners are 00, 10, 11, 01.
fn cut(is_backward: bool) -> [[usize; 3]; 2] {
    if is_backward { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] }
}

/// The largest distance between a grid on `surface` and the surface, as measured.
///
/// The distance is the one to the tangent plane at the interpolated parameters: its own error is of the fourth order of
/// the size of a quad, where the distance is of the second.
fn measured_error<S: Surface>(surface: &S, counts: [usize; 2]) -> f64 {
    let domain = surface.domain();
    let row = |j: usize| -> Vec<(DVec2, DVec3)> {
        let at = |i| grid_uv(domain, counts, i, j);
        let line = surface.line(at(0).y);
        (0..=counts[0]).map(|i| (at(i), line(at(i).x)[0])).collect()
    };
    let mut error = 0.0f64;
    let mut below = row(0);
    for j in 1..=counts[1] {
        let above = row(j);
        let mut lines = ParameterLines { surface, known: Vec::new() };
        for (low, high) in below.windows(2).zip(above.windows(2)) {
            let quad = [low[0], low[1], high[1], high[0]];
            let points = quad.map(|(_, point)| point);
            for corners in cut(is_cut_backward(lines.at((quad[0].0 + quad[2].0) * 0.5), points)) {
                for weights in MEASURED_AT {
                    let blend = |k: usize| (quad[corners[k]].0 * weights[k], quad[corners[k]].1 * weights[k]);
                    let (uv, point) = (0..3).map(blend).fold((DVec2::ZERO, DVec3::ZERO), |a, b| (a.0 + b.0, a.1 + b.1));
                    let [on, normal] = lines.at(uv);
                    error = error.max((point - on).dot(normal).abs());
                }
            }
        }
        below = above;
    }
    error
}

/// A few lines of parameters v, for points that come to the same ones again and again.
struct ParameterLines<'s, S> {
    surface: &'s S,
    known: Vec<(f64, ParameterLine<'s>)>,
}

impl<S: Surface> ParameterLines<'_, S> {
    /// The point and the normal at `uv`.
    fn at(&mut self, uv: DVec2) -> [DVec3; 2] {
        let known = self.known.iter().position(|(v, _)| *v == uv.y);
        let place = known.unwrap_or_else(|| {
            self.known.push((uv.y, self.surface.line(uv.y)));
            self.known.len() - 1
        });
        (self.known[place].1)(uv.x)
    }
}

/// The mesh in the making.
struct Builder<'a, S> {
    surfaces: &'a [S],
    borders: &'a SharedCurves,
    grids: &'a Grids,
    mesh: Mesh,
    corner_at: HashMap<[u64; 3], u32>,
    /// The vertices along each curve, in the direction in which it was found first.
    curves: Vec<Vec<u32>>,
}

impl<'a, S: Surface> Builder<'a, S> {
    fn new(surfaces: &'a [S], borders: &'a SharedCurves, grids: &'a Grids) -> Self {
        Builder { surfaces, borders, grids, mesh: Mesh::default(), corner_at: HashMap::new(), curves: Vec::new() }
    }

    fn into_mesh(mut self) -> Mesh {
        for curve in 0..self.borders.first.len() {
            let vertices = self.curve_vertices(curve);
            self.curves.push(vertices);
        }
        for surface in 0..self.surfaces.len() {
            self.add_surface(surface);
        }
        self.mesh
    }

    fn curve_vertices(&mut self, curve: usize) -> Vec<u32> {
        let (index, side) = self.borders.first[curve];
        let (surface, segments) = (&self.surfaces[index], self.grids.segments[self.grids.strips[curve]]);
        let at = |k: usize| surface.point(along_side(surface.domain(), side, k as f64 / segments as f64));
        let first = self.corner(at(0));
        if self.borders.sides[index][side].is_point {
            return vec![first; segments + 1];
        }
        let last = self.corner(at(segments));
        let inner = (1..segments).map(|k| self.vertex(at(k))).collect::<Vec<_>>();
        [vec![first], inner, vec![last]].concat()
    }

    fn add_surface(&mut self, index: usize) {
        let surface = &self.surfaces[index];
        let domain = surface.domain();
        let counts = self.grids.of(self.borders, index);
        let grid = self.grid_vertices(index, counts);
        let at = |i: usize, j: usize| j * (counts[0] + 1) + i;
        let uvs: Vec<DVec2> =
            (0..grid.len()).map(|k| grid_uv(domain, counts, k % (counts[0] + 1), k / (counts[0] + 1))).collect();
        let row = |row: &[DVec2]| -> Vec<DVec3> {
            let line = surface.line(row[0].y);
            row.iter().map(|uv| line(uv.x)[1]).collect()
        };
        let normals: Vec<DVec3> = uvs.par_chunks(counts[0] + 1).flat_map_iter(row).collect();
        for j in 0..counts[1] {
            let mut lines = ParameterLines { surface, known: Vec::new() };
            for i in 0..counts[0] {
                let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let points = quad.map(|k| self.mesh.vertices[grid[k] as usize]);
                let middle = (uvs[quad[0]] + uvs[quad[2]]) * 0.5;
                for corners in cut(is_cut_backward(lines.at(middle), points)) {
                    let [a, b, c] = corners.map(|corner| grid[quad[corner]]);
                    if a == b || b == c || c == a {
                        continue;
                    }
                    self.mesh.triangles.push([a, b, c]);
                    self.mesh.corner_normals.push(corners.map(|corner| normals[quad[corner]]));
                    self.mesh.corner_parameters.push(corners.map(|corner| uvs[quad[corner]]));
                    self.mesh.surfaces.push(index as u32);
                }
            }
        }
    }

    /// The vertices of the grid of a surface, row by row; those on its sides belong to the curves.
    fn grid_vertices(&mut self, index: usize, counts: [usize; 2]) -> Vec<u32> {
        let surface = &self.surfaces[index];
        let [nu, nv] = counts;
        let mut grid = Vec::with_capacity((nu + 1) * (nv + 1));
        for j in 0..=nv {
            let line = surface.line(grid_uv(surface.domain(), counts, 0, j).y);
            for i in 0..=nu {
                let on_side = match (i, j) {
                    (i, 0) => Some((0, i)),
                    (i, j) if j == nv => Some((1, i)),
                    (0, j) => Some((2, j)),
                    (i, j) if i == nu => Some((3, j)),
                    _ => None,
                };
                grid.push(match on_side {
                    Some((side, k)) => self.side_vertex(index, side, k),
                    None => self.vertex(line(grid_uv(surface.domain(), counts, i, j).x)[0]),
                });
            }
        }
        grid
    }

    fn side_vertex(&self, surface: usize, side: usize, k: usize) -> u32 {
        let place = self.borders.sides[surface][side];
        let vertices = &self.curves[place.curve];
        vertices[if place.is_reversed { vertices.len() - 1 - k } else { k }]
    }

    fn corner(&mut self, position: DVec3) -> u32 {
        if let Some(&index) = self.corner_at.get(&bits(position)) {
            return index;
        }
        let index = self.vertex(position);
        self.corner_at.insert(bits(position), index);
        index
    }

    fn vertex(&mut self, position: DVec3) -> u32 {
        self.mesh.vertices.push(position);
        self.mesh.vertices.len() as u32 - 1
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::{Parallelogram, Sphere, chord_error, teapot};
    use super::*;

    fn ball(chord: f64) -> Mesh {
        tessellate(&[Sphere::new(DVec3::new(3.0, -1.0, 2.0), 2.0)], Tolerance::new(chord, 180.0)).unwrap()
    }

    #[test]
    fn spheres_are_closed_and_their_area_and_volume_converge_with_the_chord() {
        // Area and volume of an inscribed mesh fall short by a part of the order of h^2, as the chord does.
        let (area, volume) = (16.0 * PI, 32.0 * PI / 3.0);
        let mut ratios = Vec::new();
        for chord in [0.1, 0.01, 0.001, 0.0001] {
            let mesh = ball(chord);
            let report = mesh.edge_report();
            assert!(
                report.is_closed() && report.collapsed + report.degenerate == 0 && report.euler_characteristic() == 2
            );
            let (lost_area, lost_volume) = (1.0 - mesh.area() / area, 1.0 - mesh.signed_volume() / volume);
            // A shell as thick as the chord around the inscribed ball bounds the lost volume.
            assert!(lost_volume > 0.0 && lost_volume < 3.0 * chord / 2.0, "{lost_volume} for {chord}");
            assert!(lost_area > 0.0 && lost_area < lost_volume, "{lost_area} for {chord}");
            ratios.push((lost_area / chord, lost_volume / chord));
        }
        for pair in ratios.windows(2) {
            assert!(
                (pair[1].0 / pair[0].0 - 1.0).abs() < 0.35 && (pair[1].1 / pair[0].1 - 1.0).abs() < 0.35,
                "{ratios:?}"
            );
        }
    }

    #[test]
    fn the_error_of_spheres_and_teapots_stays_below_every_tolerance_and_near_it() {
        for chord in [0.3, 0.1, 0.03, 0.01, 0.004] {
            let surfaces = [Sphere::new(DVec3::ONE, 1.0)];
            let mesh = tessellate(&surfaces, Tolerance::new(chord, 180.0)).unwrap();
            let sphere = chord_error(&mesh, &surfaces, 12).unwrap();
            assert!(sphere.maximum <= chord && sphere.maximum > 0.4 * chord, "{} for {chord}", sphere.maximum);
            assert!(sphere.rms < sphere.maximum);
            let patches = teapot();
            let mesh = tessellate(&patches, Tolerance::new(chord, 180.0)).unwrap();
            let pot = chord_error(&mesh, &patches, 8).unwrap();
            assert!(pot.maximum <= chord && pot.maximum > 0.4 * chord, "{} for {chord}", pot.maximum);
        }
    }

    #[test]
    fn neighbouring_normals_stay_within_the_angle() {
        for angle in [40.0, 20.0, 5.0] {
            let mesh = tessellate(&[Sphere::new(DVec3::ZERO, 1.0)], Tolerance::new(10.0, angle)).unwrap();
            let turns = mesh.corner_normals.iter().zip(&mesh.corner_parameters).flat_map(|(normals, uvs)| {
                let sides = [(0, 1), (1, 2), (2, 0)].into_iter();
                let grid = sides.filter(|&(a, b)| uvs[a].x == uvs[b].x || uvs[a].y == uvs[b].y);
                grid.map(|(a, b)| normals[a].angle_between(normals[b]).to_degrees()).collect::<Vec<_>>()
            });
            let worst = turns.fold(0.0, f64::max);
            assert!(worst <= angle * 1.001 && worst > 0.6 * angle, "{worst} for {angle}");
        }
    }

    #[test]
    fn the_teapot_is_open_only_where_its_data_is() {
        for chord in [0.05, 0.01, 0.002] {
            let mesh = tessellate(&teapot(), Tolerance::new(chord, 30.0)).unwrap();
            let report = mesh.edge_report();
            assert_eq!((report.non_manifold, report.misoriented, report.collapsed, report.degenerate), (0, 0, 0, 0));
            // Two discs (body with rim, lid) and two tubes (handle, spout); the handle touches the body in one vertex.
            assert_eq!(report.euler_characteristic(), 2 - 1);
            assert_eq!(mesh.welded().vertices.len(), mesh.vertices.len());
            assert!(mesh.with_holes_filled().is_closed());
        }
    }

    #[test]
    fn corners_lie_on_their_surface_with_its_normal() {
        let patches = teapot();
        let mesh = tessellate(&patches, Tolerance::new(0.02, 30.0)).unwrap();
        for triangle in 0..mesh.triangles.len() {
            let patch = &patches[mesh.surfaces[triangle] as usize];
            for k in 0..3 {
                let uv = mesh.corner_parameters[triangle][k];
                assert!((patch.point(uv) - mesh.corners(triangle)[k]).length() < 1e-14);
                assert_eq!(patch.normal(uv), mesh.corner_normals[triangle][k]);
            }
        }
    }

    #[test]
    fn faces_and_corner_normals_point_to_the_same_side() {
        let mesh = tessellate(&teapot(), Tolerance::new(0.005, 10.0)).unwrap();
        for triangle in 0..mesh.triangles.len() {
            let face = mesh.face_normal(triangle).unwrap();
            assert!(mesh.corner_normals[triangle].iter().all(|normal| normal.dot(face) > 0.5), "{triangle}");
        }
    }

    #[test]
    fn even_the_coarsest_mesh_of_what_goes_around_bounds_a_solid() {
        let mesh = ball(1e9);
        assert!(mesh.is_closed() && mesh.signed_volume() > 0.0, "{} triangles", mesh.triangles.len());
    }

    #[test]
    fn a_mesh_scales_with_its_surface_and_tolerance() {
        let count = |scale: f64| {
            let sphere = Sphere::new(DVec3::ZERO, scale);
            tessellate(&[sphere], Tolerance::new(0.01 * scale, 180.0)).unwrap().triangles.len()
        };
        assert!([1e-9, 1e-6, 1e6, 1e12].iter().all(|&scale| count(scale) == count(1.0)));
    }

    #[test]
    fn bad_tolerances_and_surfaces_are_refused() {
        let sphere = || [Sphere::new(DVec3::ZERO, 1.0)];
        for (chord, angle) in [(0.0, 10.0), (-1.0, 10.0), (f64::NAN, 10.0), (0.1, 0.0)] {
            let result = tessellate(&sphere(), Tolerance::new(chord, angle));
            assert!(matches!(result, Err(TessellationError::Tolerance { .. })));
        }
        for (chord, angle) in [(1e-30, 10.0), (0.1, 1e-9)] {
            let result = tessellate(&sphere(), Tolerance::new(chord, angle));
            assert!(matches!(result, Err(TessellationError::TooFine { .. })));
        }
        let broken = [Parallelogram::new(DVec3::ZERO, DVec3::X, DVec3::splat(f64::NAN))];
        let result = tessellate(&broken, Tolerance::new(0.1, 10.0));
        assert_eq!(result, Err(TessellationError::NotFinite { surface: 0 }));
        assert_eq!(tessellate::<Sphere>(&[], Tolerance::new(0.1, 10.0)), Ok(Mesh::default()));
    }

    #[test]
    fn a_mesh_without_parameters_cannot_be_measured() {
        let mut mesh = ball(0.1);
        mesh.surfaces[0] = 7;
        let sphere = [Sphere::new(DVec3::ZERO, 1.0)];
        assert_eq!(chord_error(&mesh, &sphere, 2), Err(TessellationError::NoSurface { index: 7, count: 1 }));
        mesh.surfaces.clear();
        assert_eq!(chord_error(&mesh, &sphere, 2), Err(TessellationError::NoParameters));
    }
}
