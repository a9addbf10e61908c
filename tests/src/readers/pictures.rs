//! Readers of pictures: PNG, EXR, EXR with layers, and what surrounds a scene.

use super::place::with_file;
use glam::DVec3;
use host::color::{Color, WavelengthSets};
use host::illumination::light::{Panorama, Sky, SkyMap};
use host::picture::{Deep, Picture};
use std::sync::Arc;

pub fn png(bytes: &[u8]) {
    picture("a.png", bytes);
}

pub fn exr(bytes: &[u8]) {
    picture("a.exr", bytes);
}

/// What is read has all its pixels, and goes out as bytes.
fn picture(name: &str, bytes: &[u8]) {
    if let Ok(picture) = with_file(name, bytes, Picture::read) {
        let count = picture.width() as usize * picture.height() as usize;
        assert_eq!((picture.pixels().len(), picture.to_srgb8().len()), (count, 3 * count));
    }
}

pub fn layers(bytes: &[u8]) {
    if let Ok(deep) = with_file("a.exr", bytes, Deep::read) {
        assert!(deep.picture().is_finite() && deep.depth().iter().all(|z| !z.is_nan()));
        assert_eq!(deep.depth().len(), deep.picture().pixels().len());
    }
}

pub fn environment(bytes: &[u8]) {
    let Ok(panorama) = with_file("a.exr", bytes, Panorama::read) else { return };
    let map = SkyMap { file: "a.exr".into(), panorama: Some(Arc::new(panorama)), ..SkyMap::default() };
    let sky = Sky::new(Some(&map), &Color::Bands(DVec3::ONE), 30.0, &WavelengthSets::bands());
    for towards in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::new(0.6, 0.0, -0.8)] {
        let radiance = sky.radiance(towards, 0);
        assert!(radiance.max() >= 0.0, "{radiance:?}");
    }
}
