//! Shapes of sculptured surfaces: spline surfaces, whole or trimmed, and filled holes; open, or closed around a solid.

use crate::curve::SplineCurve;
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::solid::primitive::sculptured;
use crate::solid::{PrimitiveError, Solid};
use crate::surface::{
    Curved, HoleError, HoleSide, Joint, SplineSurface, Surface, Tolerance, TrimEdge, TrimError, TrimmedSurface,
    continuity, n_sided_patch, patches_around_vertex, tessellate, tessellate_trimmed,
};
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Some sheets of surface, outside out. Where sides agree to the bit, they are one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sculpture {
    /// The sheets.
    pub sheets: Vec<SurfaceSheet>,
}

/// A piece of surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceSheet {
    /// A surface of a net of control points.
    Spline {
        /// The surface.
        surface: Box<SplineSurface>,
        /// Closed loops of curves in its parameters; what an odd number of them surrounds is there. Without any, all
        /// is.
        loops: Vec<Vec<SplineCurve>>,
    },
    /// A hole that is filled smoothly.
    Filled {
        /// Its sides in order, with the hole on the left.
        sides: Vec<HoleSide>,
        /// Whether four-sided patches around a vertex fill it, rather than one patch.
        around_vertex: bool,
    },
}

/// A fault that keeps a sculpture from being made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SculptureError {
    /// A hole that cannot be filled.
    #[error(transparent)]
    Hole(#[from] HoleError),
    /// A surface that cannot be trimmed or approximated.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// Sheets that bound no solid.
    #[error(transparent)]
    Solid(#[from] PrimitiveError),
}

/// A patch that has curvatures.
type Patch = Arc<dyn Curved>;

/// Tolerance with which trimmed sheets are looked at, as a part of their extent.
const COARSE: f64 = 1.0 / 100.0;

impl SurfaceSheet {
    /// The sheet moved by `placement`; a reflection keeps outside out.
    pub fn transformed(&self, placement: &DAffine3) -> SurfaceSheet {
        match self {
            SurfaceSheet::Spline { surface, loops } => {
                let ([low, high], is_mirrored) = (surface.domain(), placement.matrix3.determinant() < 0.0);
                // A reflection reverses u.
                let (factor, shift) = if is_mirrored { (-1.0, low.x + high.x) } else { (1.0, 0.0) };
                let map =
                    DAffine3::from_translation(DVec3::X * shift) * DAffine3::from_scale(DVec3::new(factor, 1.0, 1.0));
                let moved = |ring: &Vec<SplineCurve>| ring.iter().map(|curve| curve.transformed(&map)).collect();
                SurfaceSheet::Spline {
                    surface: Box::new(surface.transformed(placement)),
                    loops: loops.iter().map(moved).collect(),
                }
            }
            SurfaceSheet::Filled { sides, around_vertex } => {
                SurfaceSheet::Filled { sides: HoleSide::transformed(sides, placement), around_vertex: *around_vertex }
            }
        }
    }

    /// The sheet with another trimming.
    ///
    /// - `cut`: closed loops of curves, parameters 0 to 1 in both directions.
    /// - `holes`: whether what they surround is taken away, rather than kept.
    ///
    /// # Errors
    /// The problem in words.
    pub fn trimmed(&self, cut: &[Vec<SplineCurve>], holes: bool) -> Result<SurfaceSheet, String> {
        let SurfaceSheet::Spline { surface, loops } = self else {
            return Err("a filled hole cannot be trimmed".into());
        };
        if !holes && !loops.is_empty() {
            return Err("the surface is trimmed already; only holes can be added".into());
        }
        let [low, high] = surface.domain();
        let to_domain = DAffine3::from_translation(low.extend(0.0)) * DAffine3::from_scale((high - low).extend(1.0));
        let placed = |ring: &Vec<SplineCurve>| ring.iter().map(|curve| curve.transformed(&to_domain)).collect();
        let mut all: Vec<Vec<SplineCurve>> = loops.clone();
        if holes && all.is_empty() {
            let whole = TrimmedSurface::with_holes(surface.as_ref(), Vec::new()).map_err(|error| error.to_string())?;
            all = whole.loops().iter().map(|ring| ring.iter().map(|edge| edge.curve.clone()).collect()).collect();
        }
        all.extend(cut.iter().map(placed));
        TrimmedSurface::new(surface.as_ref(), edges(&all)).map_err(|error| error.to_string())?;
        Ok(SurfaceSheet::Spline { surface: surface.clone(), loops: all })
    }

    fn is_trimmed(&self) -> bool {
        matches!(self, SurfaceSheet::Spline { loops, .. } if !loops.is_empty())
    }

    /// Points that hold it, or nearly: control points.
    fn hull(&self) -> Vec<DVec3> {
        match self {
            SurfaceSheet::Spline { surface, .. } => surface.control().iter().map(|control| control.point).collect(),
            SurfaceSheet::Filled { sides, .. } => sides.iter().flat_map(|side| *side.curve()).collect(),
        }
    }

    /// Its patches; of a spline surface those of all spans, trimmed or not.
    fn patches(&self) -> Result<Vec<Patch>, SculptureError> {
        fn shared<S: Curved + 'static>(patches: impl IntoIterator<Item = S>) -> Vec<Patch> {
            patches.into_iter().map(|patch| Arc::new(patch) as Patch).collect()
        }
        Ok(match self {
            SurfaceSheet::Spline { surface, .. } => shared(surface.patches().iter().cloned()),
            SurfaceSheet::Filled { sides, around_vertex: false } => shared(n_sided_patch(sides)?),
            SurfaceSheet::Filled { sides, around_vertex: true } => shared(patches_around_vertex(sides)?),
        })
    }

    /// What is there of each surface that is tessellated: a trimmed one is one surface with all its spans.
    fn faces(&self) -> Result<Vec<TrimmedSurface<Patch>>, SculptureError> {
        if let SurfaceSheet::Spline { surface, loops } = self
            && !loops.is_empty()
        {
            return Ok(vec![TrimmedSurface::new(Arc::new(SplineSurface::clone(surface)) as Patch, edges(loops))?]);
        }
        let whole = |patch| Ok(TrimmedSurface::with_holes(patch, Vec::new())?);
        self.patches()?.into_iter().map(whole).collect()
    }
}

fn edges(loops: &[Vec<SplineCurve>]) -> Vec<Vec<TrimEdge>> {
    let edge = |curve: &SplineCurve| TrimEdge { curve: curve.clone(), shared: None };
    loops.iter().map(|ring| ring.iter().map(edge).collect()).collect()
}

impl Sculpture {
    /// The sculpture of one sheet.
    pub fn of(sheet: SurfaceSheet) -> Sculpture {
        Sculpture { sheets: vec![sheet] }
    }

    /// The sculpture moved by `placement`.
    pub fn transformed(&self, placement: &DAffine3) -> Sculpture {
        Sculpture { sheets: self.sheets.iter().map(|sheet| sheet.transformed(placement)).collect() }
    }

    /// Whether curves cut parts of a sheet off.
    pub fn is_trimmed(&self) -> bool {
        self.sheets.iter().any(SurfaceSheet::is_trimmed)
    }

    /// Triangles of all sheets, and the exact surfaces that they name.
    ///
    /// # Errors
    /// [`SculptureError`] if a hole cannot be filled, loops cross, or the tolerance is too fine.
    pub fn tessellated(&self, tolerance: Tolerance) -> Result<(Mesh, Vec<Arc<dyn Surface>>), SculptureError> {
        if self.is_trimmed() {
            let faces = self.sheets.iter().map(SurfaceSheet::faces).collect::<Result<Vec<_>, _>>()?.concat();
            let mesh = tessellate_trimmed(&faces, tolerance)?;
            return Ok((mesh, faces.iter().map(|face| Arc::clone(face.surface()) as Arc<dyn Surface>).collect()));
        }
        let patches = self.sheets.iter().map(SurfaceSheet::patches).collect::<Result<Vec<_>, _>>()?.concat();
        let mesh = tessellate(&patches, tolerance).map_err(TrimError::from)?;
        Ok((mesh, patches.into_iter().map(|patch| patch as Arc<dyn Surface>).collect()))
    }

    /// Checks that the sheets close around a solid.
    ///
    /// # Errors
    /// [`SculptureError`] with the open edges if they do not.
    pub fn check_closed(&self) -> Result<(), SculptureError> {
        let patches = self.sheets.iter().map(SurfaceSheet::patches).collect::<Result<Vec<_>, _>>()?.concat();
        if !self.is_trimmed() {
            sculptured(patches)?;
            return Ok(());
        }
        let (mesh, _) = self.tessellated(Tolerance::new(self.extent() * COARSE, 60.0))?;
        Solid::new(mesh).map_err(PrimitiveError::from)?;
        Ok(())
    }

    /// The length of the diagonal of a box around the control points.
    pub fn extent(&self) -> f64 {
        Bounds::of(self.sheets.iter().flat_map(SurfaceSheet::hull)).diagonal()
    }

    /// The continuity along every side that two of all patches share, measured at `samples` points; the numbers of
    /// surfaces in a joint are those of the sheets.
    ///
    /// # Errors
    /// [`SculptureError`] if a hole cannot be filled.
    pub fn joints(&self, samples: usize) -> Result<Vec<Joint>, SculptureError> {
        let (mut all, mut sheet_of) = (Vec::new(), Vec::new());
        for (number, sheet) in self.sheets.iter().enumerate() {
            all.extend(sheet.patches()?);
            sheet_of.resize(all.len(), number);
        }
        let named = |joint: Joint| Joint { sides: joint.sides.map(|(patch, side)| (sheet_of[patch], side)), ..joint };
        Ok(continuity(&all, samples).into_iter().map(named).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Basis;
    use crate::surface::{Direction, car_body, rational_sphere};

    fn spline(surface: SplineSurface) -> SurfaceSheet {
        SurfaceSheet::Spline { surface: Box::new(surface), loops: Vec::new() }
    }

    fn square(low: f64, high: f64) -> Vec<SplineCurve> {
        let corners = [[low, low], [high, low], [high, high], [low, high], [low, low]];
        let corners = corners.map(|[u, v]| DVec3::new(u, v, 0.0));
        vec![SplineCurve::new(Basis::clamped(1, 5).unwrap(), &corners, &[]).unwrap()]
    }

    fn triangles(sheet: SurfaceSheet) -> Mesh {
        Sculpture::of(sheet).tessellated(Tolerance::new(1e-3, 30.0)).unwrap().0
    }

    #[test]
    fn what_is_cut_out_and_what_is_kept_make_the_whole() {
        let ball = spline(rational_sphere(1.0).unwrap());
        let (window, rest) = (ball.trimmed(&[square(0.3, 0.7)], false), ball.trimmed(&[square(0.3, 0.7)], true));
        let (window, rest) = (triangles(window.unwrap()), triangles(rest.unwrap()));
        assert!((window.area() + rest.area() - triangles(ball.clone()).area()).abs() < 2e-2);
        // Four tenths of the turn, and of the parameter from pole to pole a band around the equator.
        assert!(window.area() > 0.2 * 4.0 * std::f64::consts::PI && window.area() < rest.area());
        let again = ball.trimmed(&[square(0.3, 0.7)], true).unwrap().trimmed(&[square(0.4, 0.6)], false);
        assert!(again.unwrap_err().contains("trimmed already"));
        assert!(ball.trimmed(&[square(0.3, 1.7)], true).unwrap_err().contains("leaves the domain"));
    }

    #[test]
    fn mirrored_sheets_stay_outside_out_with_their_holes() {
        let holed = spline(rational_sphere(1.0).unwrap()).trimmed(&[square(0.05, 0.3)], true).unwrap();
        let mirrored = holed.transformed(&DAffine3::from_scale(DVec3::new(1.0, 1.0, -2.0)));
        let (one, two) = (triangles(holed), triangles(mirrored));
        let mean = |mesh: &Mesh| mesh.vertices.iter().sum::<DVec3>() / mesh.vertices.len() as f64;
        assert!(mean(&one).z * mean(&two).z < 0.0, "{} {}", mean(&one), mean(&two));
        let outwards =
            |mesh: &Mesh| (0..mesh.triangles.len()).all(|t| mesh.area_vector(t).dot(mesh.corners(t)[0]) > 0.0);
        assert!(outwards(&one) && outwards(&two));
    }

    #[test]
    fn sheets_that_close_are_a_solid_and_others_are_not() {
        let ball = rational_sphere(1.0).unwrap();
        let halves = ball.subdivided(Direction::V, 1.0).unwrap();
        let all = |parts: &[SplineSurface]| Sculpture { sheets: parts.iter().cloned().map(spline).collect() };
        assert!(all(&halves).check_closed().is_ok() && all(&halves[..1]).check_closed().is_err());
        let joints = all(&halves).joints(5).unwrap();
        assert!(joints.iter().any(|joint| joint.sides[0].0 != joint.sides[1].0));
        assert!(joints.iter().all(|joint| joint.gap == 0.0 && joint.angle < 1e-6));
        // The same with a hole that is covered by what was cut out of it.
        let (lid, rest) =
            (spline(ball.clone()).trimmed(&[square(0.3, 0.6)], false), spline(ball).trimmed(&[square(0.3, 0.6)], true));
        let (lid, rest) = (lid.unwrap(), rest.unwrap());
        assert!(Sculpture { sheets: vec![lid, rest.clone()] }.check_closed().is_ok());
        assert!(Sculpture::of(rest).check_closed().is_err());
    }

    #[test]
    fn sculptures_survive_their_serialisation() {
        let [front, ..] = car_body().unwrap();
        let sheet = spline(front).trimmed(&[square(0.3, 0.6)], true).unwrap();
        let text = serde_json::to_string(&sheet).unwrap();
        assert_eq!(serde_json::from_str::<SurfaceSheet>(&text).unwrap(), sheet);
        let broken = text.replacen("\"degree\":3", "\"degree\":2", 1);
        assert!(serde_json::from_str::<SurfaceSheet>(&broken).is_err(), "control points no longer fit");
    }
}
