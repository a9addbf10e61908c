//! What scripts do with sculptured surfaces: evaluating, trimming, joining, filling, closing.

use super::builder::Builder;
use super::handle::{CallResult, Handle};
use crate::curve::{Curve, SplineCurve};
use crate::scene::{Sculpture, Shape, SurfaceSheet};
use crate::surface::{
    BezierPatch, Direction, HoleSide, Joint, Smoothness, SplineSurface, Surface, SurfaceSide, TensorPatch, joined,
    joint, n_sided_patch, patches_around_vertex,
};
use glam::{DAffine3, DMat4, DVec2, DVec3};
use rhai::{Array, Dynamic, Map};

/// Points along a joint at which continuity is measured.
const SAMPLES: usize = 33;

/// A point or vector as scripts see it.
pub(super) fn array(vector: DVec3) -> Dynamic {
    Dynamic::from_array(vector.to_array().map(Dynamic::from).to_vec())
}

fn map<const N: usize>(entries: [(&str, Dynamic); N]) -> Dynamic {
    Dynamic::from_map(entries.into_iter().map(|(name, value)| (name.into(), value)).collect::<Map>())
}

/// Point and direction of a curve at a part of its parameters.
pub(super) fn on_curve(curve: &SplineCurve, part: f64) -> Dynamic {
    let [low, high] = curve.domain();
    let at = low * (1.0 - part) + high * part;
    let direction = curve.derivatives(at)[0].normalize_or_zero();
    map([("point", array(curve.point(at))), ("direction", array(direction))])
}

/// What a joint says, as scripts see it.
fn report(joint: &Joint) -> Dynamic {
    let surfaces = joint.sides.map(|(surface, _)| Dynamic::from(surface as rhai::INT));
    map([
        ("surfaces", Dynamic::from_array(surfaces.to_vec())),
        ("gap", Dynamic::from(joint.gap)),
        ("angle", Dynamic::from(joint.angle)),
        ("curvature_difference", Dynamic::from(joint.curvature_difference)),
        ("curvature", Dynamic::from(joint.curvature)),
    ])
}

impl Builder {
    /// The sheets of an object, placed as it is.
    fn transformed_sheets(&mut self, handle: Handle) -> Result<Vec<SurfaceSheet>, String> {
        let object = self.object(handle)?;
        let Shape::Sculpture(sculpture) = &object.shape else {
            return Err(format!("{} is no surface", object.name));
        };
        if object.transform == DMat4::IDENTITY {
            return Ok(sculpture.sheets.clone());
        }
        Ok(sculpture.transformed(&DAffine3::from_mat4(object.transform)).sheets)
    }

    /// The only spline surface of an object, placed as it is.
    pub(super) fn spline_surface(&mut self, handle: Handle) -> Result<SplineSurface, String> {
        match self.transformed_sheets(handle)?.pop() {
            Some(SurfaceSheet::Spline { surface, .. }) if self.sheet_count(handle)? == 1 => Ok(*surface),
            _ => Err(format!("{} is not one surface over a mesh of control points", self.object(handle)?.name)),
        }
    }

    fn sheet_count(&mut self, handle: Handle) -> Result<usize, String> {
        Ok(match &self.object(handle)?.shape {
            Shape::Sculpture(sculpture) => sculpture.sheets.len(),
            _ => 0,
        })
    }

    /// Gives an object another sheet, which is placed already.
    fn set_sheet(&mut self, handle: Handle, sheet: SurfaceSheet) -> Result<(), String> {
        let object = self.object(handle)?;
        object.shape = Shape::Sculpture(Box::new(Sculpture::of(sheet)));
        object.transform = DMat4::IDENTITY;
        Ok(())
    }

    /// Point and normal of a surface at parts of its parameters.
    pub(super) fn surface_at(&mut self, handle: Handle, part: DVec2) -> CallResult {
        let surface = self.spline_surface(handle)?;
        let [low, high] = surface.domain();
        let uv = low * (DVec2::ONE - part) + high * part;
        Ok(map([("point", array(surface.point(uv))), ("normal", array(surface.normal(uv)))]))
    }

    /// Trims a surface by loops in parts of its parameters.
    pub(super) fn trim(&mut self, handle: Handle, loops: &[Vec<SplineCurve>], holes: bool) -> CallResult {
        if self.sheet_count(handle)? > 1 {
            return Err("an object of several surfaces cannot be trimmed; trim them before".into());
        }
        let sheet = self.transformed_sheets(handle)?.pop().ok_or("there is no surface")?;
        self.set_sheet(handle, sheet.trimmed(loops, holes)?)?;
        Ok(Dynamic::from(handle))
    }

    /// Changes the second surface so that it continues the first; returns what holds then.
    pub(super) fn join(&mut self, handles: [Handle; 2], sides: [SurfaceSide; 2], smoothness: Smoothness) -> CallResult {
        if handles[0] == handles[1] {
            return Err("a surface cannot be joined to itself".into());
        }
        for handle in handles {
            if self
                .transformed_sheets(handle)?
                .iter()
                .any(|s| matches!(s, SurfaceSheet::Spline { loops, .. } if !loops.is_empty()))
            {
                return Err(format!("{} is trimmed; join surfaces before", self.object(handle)?.name));
            }
        }
        let [first, second] = [self.spline_surface(handles[0])?, self.spline_surface(handles[1])?];
        let [first, second] = joined(&first, &second, sides, smoothness).map_err(|error| error.to_string())?;
        // The second may have been reversed.
        let at = |side| joint(&first, &second, [sides[0], side], SAMPLES);
        let found = [at(sides[1]), at(sides[1].opposite())];
        let found = if found[0].gap <= found[1].gap { found[0] } else { found[1] };
        for (handle, surface) in handles.into_iter().zip([first, second]) {
            self.set_sheet(handle, SurfaceSheet::Spline { surface: Box::new(surface), loops: Vec::new() })?;
        }
        Ok(report(&Joint { sides: [(0, sides[0]), (1, sides[1])], ..found }))
    }

    /// What holds along all sides that patches of some surfaces share.
    pub(super) fn continuity(&mut self, handles: impl IntoIterator<Item = Handle>) -> CallResult {
        let mut sheets = Vec::new();
        for handle in handles {
            sheets.extend(self.transformed_sheets(handle)?);
        }
        let joints = Sculpture { sheets }.joints(SAMPLES).map_err(|error| error.to_string())?;
        Ok(Dynamic::from_array(joints.iter().map(report).collect::<Array>()))
    }

    /// Fills a hole between surfaces.
    pub(super) fn fill(
        &mut self,
        around: &[(Handle, SurfaceSide)],
        around_vertex: bool,
        tolerance: Option<f64>,
    ) -> CallResult {
        let mut sides = Vec::new();
        for (handle, side) in around {
            let surface = self.spline_surface(*handle)?;
            let name = &self.object(*handle)?.name;
            sides.extend(hole_sides(&surface, *side).map_err(|problem| format!("{name}: {problem}"))?);
        }
        let sides = chained(sides);
        let filled =
            if around_vertex { patches_around_vertex(&sides).map(|_| ()) } else { n_sided_patch(&sides).map(|_| ()) };
        filled.map_err(|error| error.to_string())?;
        let sculpture = Sculpture::of(SurfaceSheet::Filled { sides, around_vertex });
        self.add(Shape::Sculpture(Box::new(sculpture)), tolerance).map(Dynamic::from)
    }

    /// Makes one object of surfaces, which are no objects of their own any more.
    pub(super) fn sculptured(&mut self, handles: &[Handle], closed: bool) -> Result<Handle, String> {
        let mut sheets = Vec::new();
        for (k, handle) in handles.iter().enumerate() {
            if handles[..k].contains(handle) {
                return Err("a surface is named twice".into());
            }
            sheets.extend(self.transformed_sheets(*handle)?);
        }
        let Some(first) = handles.first() else { return Err("there are no surfaces".into()) };
        let (material, tolerance) = {
            let first = self.object(*first)?;
            (first.material.clone(), first.tolerance)
        };
        let sculpture = Sculpture { sheets };
        if closed {
            sculpture.check_closed().map_err(|error| error.to_string())?;
        }
        handles.iter().try_for_each(|handle| self.check_still(*handle))?;
        handles.iter().for_each(|handle| self.use_up(*handle));
        let whole = self.add(Shape::Sculpture(Box::new(sculpture)), tolerance)?;
        self.object(whole)?.material = material;
        Ok(whole)
    }
}

/// The sides of a hole that a side of a surface is, one for each span, in order.
fn hole_sides(surface: &SplineSurface, side: SurfaceSide) -> Result<Vec<HoleSide>, String> {
    let mut surface = surface.clone();
    for direction in [Direction::U, Direction::V] {
        while surface.basis(direction).degree() < 3 {
            surface = surface.elevated(direction).map_err(|error| error.to_string())?;
        }
    }
    let [rows, columns] = surface.patch_counts();
    let patch = |i: usize, j: usize| bicubic(&surface.patches()[i * columns + j]);
    match side {
        SurfaceSide::LowV => (0..rows).rev().map(|i| Ok(HoleSide::of(&patch(i, 0)?, side))).collect(),
        SurfaceSide::HighV => (0..rows).map(|i| Ok(HoleSide::of(&patch(i, columns - 1)?, side))).collect(),
        SurfaceSide::LowU => (0..columns).map(|j| Ok(HoleSide::of(&patch(0, j)?, side))).collect(),
        SurfaceSide::HighU => (0..columns).rev().map(|j| Ok(HoleSide::of(&patch(rows - 1, j)?, side))).collect(),
    }
}

fn bicubic(patch: &TensorPatch) -> Result<BezierPatch, String> {
    let is_plain = (0..16).all(|k| patch.degrees() == [3, 3] && patch.control(k / 4, k % 4).weight == 1.0);
    if !is_plain {
        return Err("a hole can only be filled between surfaces of degree 3 at most that are not rational".into());
    }
    Ok(BezierPatch::new([0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| patch.control(i, j).point))))
}

/// Sides of a hole in the order in which they follow one another; what does not follow stays where it is.
fn chained(mut sides: Vec<HoleSide>) -> Vec<HoleSide> {
    for k in 1..sides.len() {
        let end = sides[k - 1].curve()[3];
        if let Some(next) = (k..sides.len()).find(|next| sides[*next].curve()[0] == end) {
            sides[k..=next].rotate_right(1);
        }
    }
    sides
}
