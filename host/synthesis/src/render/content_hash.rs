//! A hash of contents, by which it is known that two of them are the same.

use crate::encoding::{Integers, encode_into};
use crate::illumination::Light;
use crate::scene::Scene;
use serde::Serialize;
use siphasher::sip128::{Hasher128, SipHasher13};
use std::hash::Hasher;
use std::io;

/// A hash of values and bytes that are added to it, of 128 bits: it stays the same from run to run, and is no secret.
///
/// # Source
/// Aumasson and Bernstein 2012, SipHash, with one round a block and three in the end.
pub struct ContentHash(SipHasher13);

impl io::Write for ContentHash {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Default for ContentHash {
    fn default() -> ContentHash {
        ContentHash::new()
    }
}

impl ContentHash {
    /// The hash of nothing.
    pub fn new() -> ContentHash {
        ContentHash(SipHasher13::new())
    }

    /// Adds bytes as they are.
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    /// Adds a value.
    pub fn add(&mut self, value: &impl Serialize) {
        // Neither scenes nor settings have anything that cannot be written, and what is written to does not fail.
        let written = encode_into(value, Integers::Compact, self);
        debug_assert!(written.is_ok());
    }

    /// Adds all that pictures of a scene depend on, but for the content of files of meshes and databases that it names.
    pub fn add_scene(&mut self, scene: &Scene) {
        self.add(scene);
        // The pictures of skies are no part of a scene that is written.
        let skies = scene.lights.iter().filter_map(Light::panorama);
        skies.for_each(|panorama| self.add(panorama));
    }

    /// The hash of all that was added.
    pub fn value(&self) -> u128 {
        self.0.finish128().as_u128()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;
    use crate::illumination::light::{Panorama, SkyMap};
    use glam::DVec3;
    use std::sync::Arc;

    fn lit_by(light: f64, file: &str) -> u128 {
        let panorama = Panorama::of(4, 2, |x, y| DVec3::splat(light * f64::from(x + y))).expect("a panorama");
        let map = SkyMap { file: file.into(), panorama: Some(Arc::new(panorama)), disc: None };
        let sky = Light::Sky { map: Some(map), radiance: Color::grey(1.0), turned: 0.0 };
        let mut hash = ContentHash::new();
        hash.add_scene(&Scene { lights: vec![sky], ..Scene::default() });
        hash.value()
    }

    #[test]
    fn scenes_have_one_hash_if_they_are_the_same_to_the_pixels_of_their_skies() {
        assert_eq!(lit_by(1.0, "a"), lit_by(1.0, "a"));
        assert_ne!(lit_by(1.0, "a"), lit_by(1.0 + 1e-6, "a"));
        assert_ne!(lit_by(1.0, "a"), lit_by(1.0, "b"));
    }
}
