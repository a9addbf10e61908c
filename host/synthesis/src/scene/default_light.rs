//! Light for scenes that have none of their own: a key light, a sky and a bounce.
//!
//! As in a photographer's studio, a large soft key light stands beside and above the viewer; a sky, lighter at the
//! horizon than above and below, fills the shadows and gives what is polished something to reflect; and a weaker,
//! warmer light from below takes the place of what the floor of a studio sends back.

use super::soft_box::soft_box;
use super::{Camera, Object, Prepared, Scene, SceneError, Studio};
use crate::color::Color;
use crate::illumination::RgbPower;
use crate::illumination::light::{Light, Panorama, SkyMap};
use crate::numeric::bounds::Bounds;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Irradiance by the key light of a surface in the middle of the scene that faces it, W/m².
const KEY: f64 = 2.9;
/// Irradiance by the bounce, W/m²; that of warm light, as from a wooden floor.
const BOUNCE: RgbPower = DVec3::new(0.55, 0.50, 0.44);
/// Radiance of the sky above, at the horizon and below, W/(m² sr).
const SKY: [RgbPower; 3] = [DVec3::new(0.18, 0.20, 0.23), DVec3::new(0.30, 0.31, 0.32), DVec3::new(0.06, 0.058, 0.055)];
/// Irradiance by a light at the eye of what the camera looks at, W/m², and ambient radiance, W/(m² sr), where lamps
/// around the scene may be behind walls.
const HEADLIGHT: f64 = 0.8;
const INDOOR_AMBIENT: RgbPower = DVec3::splat(0.3);
/// Rows of the picture of the sky: so many that steps from row to row are not seen.
const ROWS: u32 = 2048;

/// Where a lamp is placed, along the view, seen from the middle of the scene: to the right, up, and towards the viewer,
/// and its side; all in half diagonals of the scene.
struct LampPlacement {
    position: DVec3,
    side: f64,
}

const KEY_PLACEMENT: LampPlacement = LampPlacement { position: DVec3::new(-2.4, 2.8, 2.4), side: 2.0 };
const BOUNCE_PLACEMENT: LampPlacement = LampPlacement { position: DVec3::new(2.0, -2.2, 1.0), side: 2.4 };

impl Scene {
    /// The scene as it is looked at: in its studio, and lit.
    ///
    /// # Errors
    /// [`SceneError`] if its triangles cannot be made.
    pub fn lit(self) -> Result<Scene, SceneError> {
        if self.studio == Some(Studio::Lit) { self.in_studio() } else { self.in_default_light()?.in_studio() }
    }

    /// The scene, with lights if it is dark: if it has no light, no ambient light and no material that emits. A
    /// background that it has is its sky; what is seen from within its bounds, as a room, is lit from the eye. A scene
    /// without triangles stays as it is.
    ///
    /// # Errors
    /// [`SceneError`] if its triangles cannot be made.
    fn in_default_light(mut self) -> Result<Scene, SceneError> {
        let has_light = !self.lights.is_empty() || self.ambient != RgbPower::ZERO;
        if !has_light && !self.objects.is_empty() && !self.objects.iter().any(Object::emits) {
            let prepared = Prepared::new(&self)?;
            let (camera, bounds) = (prepared.camera, prepared.subject());
            if bounds.is_empty() {
                return Ok(self);
            }
            if bounds.touches(Bounds::of([camera.from])) {
                let intensity =
                    HEADLIGHT * camera.from.distance_squared(camera.at).max(bounds.diagonal().powi(2) / 100.0);
                self.lights = vec![Light::Point { at: camera.from, intensity: Color::grey(intensity) }];
                self.ambient = INDOOR_AMBIENT;
            } else {
                self.lights = default_lights(&camera, &bounds, self.background)?;
            }
        }
        Ok(self)
    }
}

fn default_lights(camera: &Camera, bounds: &Bounds, background: RgbPower) -> Result<Vec<Light>, SceneError> {
    let (center, half) = (bounds.center(), (bounds.diagonal() / 2.0).max(f64::MIN_POSITIVE.sqrt()));
    let sky = match background {
        RgbPower::ZERO => Light::Sky { map: Some(sky()?), radiance: Color::grey(1.0), turned: 0.0 },
        radiance => Light::Sky { map: None, radiance: radiance.into(), turned: 0.0 },
    };
    let Some([right, up, forward]) = camera.axes() else { return Ok(vec![sky]) };
    let lamp = |stand: &LampPlacement, irradiance: RgbPower| {
        let place = (right * stand.position.x + up * stand.position.y - forward * stand.position.z) * half;
        soft_box(center + place, center, stand.side * half, irradiance)
    };
    Ok(vec![lamp(&KEY_PLACEMENT, RgbPower::splat(KEY)), lamp(&BOUNCE_PLACEMENT, BOUNCE), sky])
}

/// A sky that goes from the horizon smoothly up and down.
fn sky() -> Result<SkyMap, SceneError> {
    let [above, level, below] = SKY;
    let radiance = |_, row: u32| {
        let elevation = FRAC_PI_2 - f64::from(row) / f64::from(ROWS - 1) * PI;
        level.lerp(if elevation > 0.0 { above } else { below }, elevation.sin().abs())
    };
    let panorama = Panorama::of(1, ROWS, radiance).map_err(|error| SceneError::Setting(error.to_string()))?;
    Ok(SkyMap { file: String::new(), panorama: Some(Arc::new(panorama)), ..SkyMap::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illumination::light::LightShape;
    use crate::scene::Shape;
    use crate::solid::Primitive;
    use glam::DMat4;

    fn scene(size: f64, at: DVec3) -> Scene {
        let shape = Shape::from(Primitive::Box { size: DVec3::splat(size) });
        let transform = DMat4::from_translation(at);
        let object = Object { name: "a".into(), shape, transform, material: None, tolerance: None };
        Scene { objects: vec![object], ..Scene::default() }
    }

    #[test]
    fn lamps_are_as_large_and_as_bright_as_the_scene_asks_for() {
        for (size, at) in [(1e-6, DVec3::ZERO), (1.0, DVec3::new(5.0, -3.0, 2.0)), (1e6, DVec3::X)] {
            let lit = scene(size, at).lit().expect("a box");
            let [Light::Area { patch, radiance }, ..] = &lit.lights[..] else { panic!("{:?}", lit.lights) };
            let &LightShape::Rectangle { corner, across, up } = patch else { panic!("{patch:?}") };
            assert!(across.cross(up).dot(at - corner) > 0.0, "it shines on what is there");
            let half = size * 3.0_f64.sqrt() / 2.0;
            let solid_angle = patch.area() / (KEY_PLACEMENT.position.length() * half).powi(2);
            let irradiance = solid_angle * radiance.bands_of_light().x;
            assert!((irradiance / KEY - 1.0).abs() < 1e-12, "{irradiance}");
        }
    }

    #[test]
    fn what_has_light_of_its_own_stays_as_it_is() {
        let bare = scene(1.0, DVec3::ZERO);
        let sun = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) };
        let mut lines = bare.clone();
        lines.objects[0].shape =
            Shape::Curve(Box::new([bare.objects[0].clone(), scene(1.0, DVec3::X * 9.0).objects[0].clone()]));
        let mut glowing = bare.clone();
        glowing.objects[0].material.get_or_insert_default().emission = Color::grey(1.0);
        for own in [
            Scene { lights: vec![sun], ..bare.clone() },
            Scene { ambient: RgbPower::splat(0.1), ..bare.clone() },
            glowing,
            lines,
            Scene::default(),
        ] {
            assert_eq!(own.clone().lit().expect("nothing to be made"), own);
        }
        let blue = RgbPower::new(0.2, 0.3, 0.5);
        let lit = Scene { background: blue, ..bare }.lit().expect("a box");
        assert_eq!(lit.lights[2], Light::Sky { map: None, radiance: blue.into(), turned: 0.0 });
    }
}
