//! Spline surfaces of every kind over rectangular control meshes.

use glam::{DAffine3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::curvature::Curved;
use super::{Surface, TensorPatch, nearest_from};
use crate::curve::{Basis, ControlPoint, Refinement, SplineError, apply, check_control, control_net};

/// One of the two directions of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along u: across the rows of the control mesh.
    U,
    /// Along v: within the rows of the control mesh.
    V,
}

impl Direction {
    /// The direction across this one.
    pub fn other(self) -> Direction {
        match self {
            Direction::U => Direction::V,
            Direction::V => Direction::U,
        }
    }
}

/// A surface of a rectangular mesh of control points over a [`Basis`] in u and one in v: Bezier, B-spline, Beta-spline,
/// BBB-spline or a mixture of them, polynomial or rational. It is evaluated through its Bezier patches.
///
/// A parameter of one direction holds along the whole joint, from side to side; it changes the surface in the strip of
/// patches beside that joint and nowhere else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SplineSurfaceData", into = "SplineSurfaceData")]
pub struct SplineSurface {
    bases: [Basis; 2],
    /// Row by row; v changes within a row.
    control: Vec<ControlPoint>,
    /// Row by row, as control points are; v changes within a row.
    patches: Vec<TensorPatch>,
}

/// What a surface is made of.
#[derive(Serialize, Deserialize)]
struct SplineSurfaceData {
    bases: [Basis; 2],
    control: Vec<ControlPoint>,
}

impl TryFrom<SplineSurfaceData> for SplineSurface {
    type Error = SplineError;

    fn try_from(SplineSurfaceData { bases, control }: SplineSurfaceData) -> Result<SplineSurface, SplineError> {
        let needed = bases.iter().map(Basis::control_count).product();
        if control.len() != needed {
            return Err(SplineError::Count { what: "control points", found: control.len(), needed });
        }
        check_control(&control)?;
        Ok(SplineSurface::of(bases, control))
    }
}

impl From<SplineSurface> for SplineSurfaceData {
    fn from(surface: SplineSurface) -> SplineSurfaceData {
        SplineSurfaceData { bases: surface.bases, control: surface.control }
    }
}

impl SplineSurface {
    /// The surface with the control points `points[i][j]`, i along u and j along v: as many rows as `u` has control points
    /// and each as long as `v` has; no `weights` at all stand for weights of 1.
    ///
    /// # Errors
    /// [`SplineError`] with the row and the place in it.
    pub fn new(u: Basis, v: Basis, points: &[Vec<DVec3>], weights: &[Vec<f64>]) -> Result<SplineSurface, SplineError> {
        let control = control_net(points, weights)?;
        let counts = [
            ("rows of control points", points.len(), u.control_count()),
            ("control points in a row", points[0].len(), v.control_count()),
        ];
        for (what, found, needed) in counts {
            if found != needed {
                return Err(SplineError::Count { what, found, needed });
            }
        }
        Ok(SplineSurface::of([u, v], control))
    }

    /// The surface of control points that were checked.
    pub(super) fn of(bases: [Basis; 2], control: Vec<ControlPoint>) -> SplineSurface {
        let [u, v] = [bases[0].form(), bases[1].form()];
        let across = mapped(&control, [u.control_count, v.control_count], Direction::U, |line| apply(&u.rows, line));
        let grid = mapped(&across, [u.rows.len(), v.control_count], Direction::V, |line| apply(&v.rows, line));
        let mut patches = Vec::with_capacity(u.spans() * v.spans());
        for i in 0..u.spans() {
            for j in 0..v.spans() {
                let row = |k: usize| (0..=v.degree).map(move |l| grid_at(u.index(i, k), v.index(j, l), v.rows.len()));
                let control = (0..=u.degree).flat_map(row).map(|index| grid[index]).collect();
                patches.push(TensorPatch::of([u.degree, v.degree], control));
            }
        }
        SplineSurface { bases, control, patches }
    }

    /// What the surface is built over in a direction.
    pub fn basis(&self, direction: Direction) -> &Basis {
        &self.bases[direction as usize]
    }

    /// The numbers of control points along u and along v.
    pub fn counts(&self) -> [usize; 2] {
        [self.bases[0].control_count(), self.bases[1].control_count()]
    }

    /// The control points row by row; v changes within a row.
    pub fn control(&self) -> &[ControlPoint] {
        &self.control
    }

    /// The Bezier patches, each with parameters 0..=1; v changes first. Neighbours share control points: tessellated
    /// together they have no cracks.
    pub fn patches(&self) -> &[TensorPatch] {
        &self.patches
    }

    /// The numbers of patches along u and along v.
    pub fn patch_counts(&self) -> [usize; 2] {
        [self.bases[0].form().spans(), self.bases[1].form().spans()]
    }

    /// The lowest and the highest parameters of a patch.
    ///
    /// # Panics
    /// If there is no patch of the number `patch`.
    fn patch_domain(&self, patch: usize) -> [DVec2; 2] {
        let [u, v] = [self.bases[0].breaks(), self.bases[1].breaks()];
        let (i, j) = (patch / (v.len() - 1), patch % (v.len() - 1));
        [DVec2::new(u[i], v[j]), DVec2::new(u[i + 1], v[j + 1])]
    }

    fn refined(&self, direction: Direction, refinement: Refinement) -> SplineSurface {
        let control = mapped(&self.control, self.counts(), direction, |line| refinement.control(line));
        let mut bases = self.bases.clone();
        bases[direction as usize] = refinement.basis;
        SplineSurface::of(bases, control)
    }

    /// This surface with another joint at the parameter `t` of a direction, and a row or column more.
    ///
    /// # Errors
    /// [`SplineError`] if `t` is outside the domain or there is no room for another joint.
    pub fn with_joint(&self, direction: Direction, t: f64) -> Result<SplineSurface, SplineError> {
        Ok(self.refined(direction, self.basis(direction).inserted(t)?))
    }

    /// The surfaces before and after the parameter `t` of a direction, parameters unchanged; a closed one becomes one that
    /// begins and ends there.
    ///
    /// # Errors
    /// [`SplineError::Outside`] if `t` is not inside the domain.
    pub fn subdivided(&self, direction: Direction, t: f64) -> Result<Vec<SplineSurface>, SplineError> {
        let parts = self.basis(direction).subdivided(t)?;
        Ok(parts.into_iter().map(|part| self.refined(direction, part)).collect())
    }

    /// This surface with a degree higher by one. A BBB-spline becomes the B-spline of its Bezier points first.
    ///
    /// # Errors
    /// [`SplineError::Degree`] if it is too high.
    pub fn elevated(&self, direction: Direction) -> Result<SplineSurface, SplineError> {
        Ok(self.refined(direction, self.basis(direction).elevated()?))
    }

    /// This surface, open in a direction, with its sides there passing through the first and last row or column.
    ///
    /// # Errors
    /// [`SplineError`] if the ends of the domain cannot take the joints.
    pub fn with_passing_sides(&self, direction: Direction) -> Result<SplineSurface, SplineError> {
        Ok(self.refined(direction, self.basis(direction).clamped_at_ends()?))
    }

    /// These points with one direction reversed, and so with the other side outside.
    pub fn reversed(&self, direction: Direction) -> SplineSurface {
        self.refined(direction, self.basis(direction).reversed())
    }

    /// These points with u and v exchanged, and so with the other side outside.
    pub fn transposed(&self) -> SplineSurface {
        let [rows, columns] = self.counts();
        let control = (0..rows * columns).map(|k| self.control[(k % rows) * columns + k / rows]).collect();
        SplineSurface::of([self.bases[1].clone(), self.bases[0].clone()], control)
    }

    /// The surface moved by `placement`. A reflection reverses u, so that outside stays outside.
    pub fn transformed(&self, placement: &DAffine3) -> SplineSurface {
        let control = self.control.iter().map(|point| point.transformed(placement)).collect();
        let moved = SplineSurface::of(self.bases.clone(), control);
        if placement.matrix3.determinant() < 0.0 { moved.reversed(Direction::U) } else { moved }
    }

    /// The patch of parameters, the parameters in it, and how fast these change.
    fn locate(&self, uv: DVec2) -> (&TensorPatch, DVec2, DVec2) {
        let (i, u) = self.bases[0].form().locate(uv.x);
        let (j, v) = self.bases[1].form().locate(uv.y);
        let patch = i * self.bases[1].form().spans() + j;
        let [low, high] = self.patch_domain(patch);
        (&self.patches[patch], DVec2::new(u, v), (high - low).recip())
    }
}

fn grid_at(i: usize, j: usize, columns: usize) -> usize {
    i * columns + j
}

/// A mesh of points, `counts` rows and columns, with every line of one direction replaced by what `map` makes of it.
fn mapped(
    points: &[ControlPoint],
    counts: [usize; 2],
    direction: Direction,
    map: impl Fn(&[ControlPoint]) -> Vec<ControlPoint>,
) -> Vec<ControlPoint> {
    let [rows, columns] = counts;
    match direction {
        Direction::V => points.chunks(columns).flat_map(map).collect(),
        Direction::U => {
            let line = |j: usize| map(&(0..rows).map(|i| points[grid_at(i, j, columns)]).collect::<Vec<_>>());
            let lines: Vec<Vec<ControlPoint>> = (0..columns).map(line).collect();
            let length = lines.first().map_or(0, Vec::len);
            (0..length).flat_map(|i| lines.iter().map(move |line| line[i])).collect()
        }
    }
}

impl Surface for SplineSurface {
    fn domain(&self) -> [DVec2; 2] {
        let ([u0, u1], [v0, v1]) = (self.bases[0].domain(), self.bases[1].domain());
        [DVec2::new(u0, v0), DVec2::new(u1, v1)]
    }

    fn point(&self, uv: DVec2) -> DVec3 {
        let (patch, uv, _) = self.locate(uv);
        patch.point(uv)
    }

    /// At a joint those of the patch after it.
    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let (patch, uv, rate) = self.locate(uv);
        let [u, v] = patch.derivatives(uv);
        [u * rate.x, v * rate.y]
    }

    fn normal(&self, uv: DVec2) -> DVec3 {
        let (patch, uv, _) = self.locate(uv);
        patch.normal(uv)
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}

impl Curved for SplineSurface {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let (patch, uv, rate) = self.locate(uv);
        let [uu, both, vv] = patch.second_derivatives(uv);
        [uu * rate.x * rate.x, both * rate.x * rate.y, vv * rate.y * rate.y]
    }
}
