//! A studio for objects that come without light and view: a sweep, a window, a soft box.

use super::default_light::soft_box;
use super::sculpture::{Sculpture, Sheet};
use super::{Camera, Object, Prepared, Scene, SceneError, Shape};
use crate::color::Color;
use crate::curve::Basis;
use crate::illumination::Bands;
use crate::illumination::light::{Light, Patch};
use crate::illumination::material::{Body, Classic};
use crate::surface::SplineSurface;
use glam::{DMat4, DVec3};
use std::path::Path;

/// Diagonal of what stands in the studio, in its own units.
const DIAGONAL: f64 = 2.4;
/// How far the sweep goes to each side, in the same units.
const ASIDE: f64 = 16.0;
/// Control points of its profile from the front to the top, towards the viewer and up: a floor that bends into a wall.
const PROFILE: [[f64; 2]; 8] =
    [[12.0, 0.0], [4.0, 0.0], [-2.0, 0.0], [-5.0, 0.0], [-7.5, 0.4], [-8.6, 3.0], [-9.0, 8.0], [-9.0, 14.0]];

impl Scene {
    /// The mesh of a file as the only object: of a mesh file, or of an octree that was kept.
    pub fn of_mesh(path: &Path) -> Scene {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let shape = Shape::Mesh { path: path.to_owned() };
        let object = Object { name, shape, transform: DMat4::IDENTITY, material: None, tolerance: None };
        Scene { objects: vec![object], ..Scene::default() }
    }

    /// The objects of the scene where they are, on a grey floor that bends up into a wall behind them, under a pale sky, with
    /// a window of daylight and a soft box, seen from the front and a little from above. What the studio has stands around
    /// them, as large as they ask for.
    ///
    /// # Errors
    /// [`SceneError`] if their triangles cannot be made.
    pub fn in_studio(mut self) -> Result<Scene, SceneError> {
        let bounds = Prepared::new(&self)?.bounds;
        let unit = (bounds.diagonal() / DIAGONAL).max(f64::MIN_POSITIVE);
        let center = bounds.center();
        let lowest = DVec3::new(center.x, bounds.min.y, center.z);
        let middle = DVec3::Y * (center.y - lowest.y) / unit;
        let place = |x: f64, y: f64, z: f64| lowest + DVec3::new(x, y, z) * unit;
        let along = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * unit;
        let grey = Body::Classic(Classic { diffuse: Color::grey(0.5).into(), ..Classic::default() });
        self.objects.push(Object {
            name: "sweep".into(),
            shape: sweep()?,
            transform: DMat4::from_translation(lowest) * DMat4::from_scale(DVec3::splat(unit)),
            material: Some(grey.into()),
            tolerance: None,
        });
        let window =
            Patch::Rectangle { corner: place(-5.0, 1.5, 2.0), across: along(1.0, 4.5, 0.0), up: along(0.0, 0.0, 4.0) };
        let window = Light::Area { patch: window, radiance: Color::grey(3.0) };
        let lamp = soft_box(place(3.5, 4.0, 4.0), place(0.0, middle.y, 0.0), 1.4 * unit, Bands::splat(1.6));
        let sky = Light::Sky { map: None, radiance: Color::grey(0.35), turned: 0.0 };
        self.lights.extend([window, lamp, sky]);
        self.camera = Some(Camera {
            from: place(0.0, middle.y + 1.45, 7.0),
            at: place(0.0, middle.y, 0.0),
            up: DVec3::Y,
            field_of_view: 26.0,
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
        });
        Ok(self)
    }
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
        sheets: vec![Sheet::Spline { surface: Box::new(surface), loops: Vec::new() }],
    })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Primitive;

    #[test]
    fn the_studio_is_as_large_as_what_stands_in_it_and_leaves_it_where_it_is() {
        for (size, shift) in [(1e-3, DVec3::ZERO), (1.0, DVec3::new(10.0, -3.0, 2.0)), (1e4, DVec3::Y)] {
            let shape = Shape::Solid(Primitive::Box { size: DVec3::splat(size) });
            let transform = DMat4::from_translation(shift);
            let object = Object { name: "a".into(), shape, transform, material: None, tolerance: None };
            let bare = Scene { objects: vec![object.clone()], ..Scene::default() };
            let bounds = Prepared::new(&bare).expect("a box").bounds;
            let scene = bare.in_studio().expect("a studio");
            assert_eq!(scene.objects[0], object);
            let camera = scene.camera.expect("it is seen");
            let distance = camera.from.distance(bounds.center()) / bounds.diagonal();
            assert!((2.5..3.5).contains(&distance), "{distance}");
            assert!(scene.lights.len() == 3 && Prepared::new(&scene).is_ok());
        }
    }
}
