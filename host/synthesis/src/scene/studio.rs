//! A studio for objects that come without light and view: a sweep, a window, a soft box.

use super::sculpture::{Sculpture, SurfaceSheet};
use super::soft_box::soft_box;
use super::{Camera, Object, Prepared, Scene, SceneError, Shape};
use crate::color::Color;
use crate::curve::Basis;
use crate::illumination::RgbPower;
use crate::illumination::light::{Light, LightShape};
use crate::illumination::material::{Classic, MaterialKind};
use crate::surface::SplineSurface;
use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Diagonal of what stands in the studio, in its own units.
const DIAGONAL: f64 = 2.4;
/// How far the sweep goes to each side, in the same units.
const ASIDE: f64 = 16.0;
/// Control points of its profile from the front to the top, towards the viewer and up: a floor that bends into a wall.
const PROFILE: [[f64; 2]; 8] =
    [[12.0, 0.0], [4.0, 0.0], [-2.0, 0.0], [-5.0, 0.0], [-7.5, 0.4], [-8.6, 3.0], [-9.0, 8.0], [-9.0, 14.0]];

/// What stands around objects that are looked at, besides what their scene has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Studio {
    /// A sweep.
    Bare,
    /// A sweep, a window of daylight, a soft box and a pale sky.
    Lit,
}

impl Scene {
    /// The mesh of a file as the only object: of a mesh file, or of an octree that was kept.
    pub fn of_mesh(path: &Path) -> Scene {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let shape = Shape::Mesh { path: path.to_owned() };
        let object = Object { name, shape, transform: DMat4::IDENTITY, material: None, tolerance: None };
        Scene { objects: vec![object], studio: Some(Studio::Lit), ..Scene::default() }
    }

    /// The objects of the scene where they are, in its studio, which is as large as they ask for: on a grey floor that bends
    /// up into a wall behind them, in the light of the studio, and seen from the front and a little from above if there is no
    /// camera. A scene without a studio or without triangles stays as it is.
    ///
    /// # Errors
    /// [`SceneError`] if their triangles cannot be made.
    pub(super) fn in_studio(mut self) -> Result<Scene, SceneError> {
        let Some(studio) = self.studio.take() else { return Ok(self) };
        let bounds = Prepared::new(&self)?.subject();
        if bounds.is_empty() {
            return Ok(self);
        }
        let unit = (bounds.diagonal() / DIAGONAL).max(f64::MIN_POSITIVE);
        let center = bounds.center();
        let lowest = DVec3::new(center.x, bounds.min.y, center.z);
        let middle = center.y - lowest.y;
        let grey = MaterialKind::Classic(Classic { diffuse: Color::grey(0.5).into(), ..Classic::default() });
        self.objects.push(Object {
            name: "sweep".into(),
            shape: sweep()?,
            transform: DMat4::from_translation(lowest) * DMat4::from_scale(DVec3::splat(unit)),
            material: Some(grey.into()),
            tolerance: None,
        });
        if studio == Studio::Lit {
            self.lights.extend(lights(lowest, middle, unit));
        }
        self.camera.get_or_insert(Camera {
            from: center + DVec3::new(0.0, 1.45, 7.0) * unit,
            at: center,
            up: DVec3::Y,
            field_of_view: 26.0,
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        });
        Ok(self)
    }
}

/// A window of daylight, a soft box and a pale sky.
///
/// - `lowest`: the middle of the floor under the objects.
/// - `middle`: how far over it their middle is.
/// - `unit`: of the studio.
fn lights(lowest: DVec3, middle: f64, unit: f64) -> [Light; 3] {
    let place = |x: f64, y: f64, z: f64| lowest + DVec3::new(x, y, z) * unit;
    let along = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * unit;
    let window =
        LightShape::Rectangle { corner: place(-5.0, 1.5, 2.0), across: along(1.0, 4.5, 0.0), up: along(0.0, 0.0, 4.0) };
    let window = Light::Area { patch: window, radiance: Color::grey(3.0) };
    let lamp = soft_box(place(3.5, 4.0, 4.0), lowest + DVec3::Y * middle, 1.4 * unit, RgbPower::splat(1.6));
    let sky = Light::Sky { map: None, radiance: Color::grey(0.35), turned: 0.0 };
    [window, lamp, sky]
}

/// The sweep in the units of the studio, its floor under the origin.
fn sweep() -> Result<Shape, SceneError> {
    let row = |x: f64| PROFILE.map(|[z, y]| DVec3::new(x, y, z)).to_vec();
    let surface = || {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 5.0, 5.0];
        SplineSurface::new(Basis::bezier(1)?, Basis::b_spline(3, &knots)?, &[row(-ASIDE), row(ASIDE)], &[])
    };
    let surface = surface().map_err(|error| SceneError::Setting(error.to_string()))?;
    Ok(Shape::Sculpture(Box::new(Sculpture {
        sheets: vec![SurfaceSheet::Spline { surface: Box::new(surface), loops: Vec::new() }],
    })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Primitive;

    #[test]
    fn the_studio_is_as_large_as_what_stands_in_it_and_leaves_it_where_it_is() {
        for (size, shift) in [(1e-3, DVec3::ZERO), (1.0, DVec3::new(10.0, -3.0, 2.0)), (1e4, DVec3::Y)] {
            let shape = Shape::from(Primitive::Box { size: DVec3::splat(size) });
            let transform = DMat4::from_translation(shift);
            let object = Object { name: "a".into(), shape, transform, material: None, tolerance: None };
            let bare = Scene { objects: vec![object.clone()], studio: Some(Studio::Bare), ..Scene::default() };
            let lit = Scene { studio: Some(Studio::Lit), ..bare.clone() };
            let bounds = Prepared::new(&bare).expect("a box").bounds;
            let scene = lit.lit().expect("a studio");
            assert_eq!(scene.objects[0], object);
            let camera = scene.camera.expect("it is seen");
            let distance = camera.from.distance(bounds.center()) / bounds.diagonal();
            assert!((2.5..3.5).contains(&distance), "{distance}");
            assert!(scene.lights.len() == 3 && Prepared::new(&scene).is_ok());
            // Lights of its own, or the default ones, which stand beside the objects rather than beside the sweep.
            let by_default = bare.clone().lit().expect("a box");
            let alone = Scene { studio: None, ..bare.clone() }.lit().expect("a box");
            assert_eq!((by_default.objects.len(), &by_default.lights), (2, &alone.lights));
            let own = vec![Light::Point { at: DVec3::Y, intensity: Color::grey(1.0) }];
            assert_eq!(Scene { lights: own.clone(), ..bare }.lit().expect("a box").lights, own);
        }
    }
}
