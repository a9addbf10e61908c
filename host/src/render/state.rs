//! The state of a rendering in a file, so that an interrupted one goes on where it stopped.

use super::Order;
use super::film::{Film, Tally};
use crate::scene::{Prepared, Scene};
use bincode::config::{Configuration, Fixint, LittleEndian, standard};
use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// What such a file begins with; the last byte is the version.
const MAGIC: [u8; 8] = *b"PERISF\x00\x02";
const ENCODING: Configuration<LittleEndian, Fixint> = standard().with_fixed_int_encoding();
/// Bytes beside those of the pixels, at most.
const MOST_HEAD: u64 = 256;
/// Bytes of a pixel.
const PIXEL: u64 = 96;

/// A scene and an order, as far as samples depend on them: where it is the same, samples can be added to others.
///
/// It is the checksum of everything that was tessellated and of the scene's own words; the number of samples, the target
/// and the time are not in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    scene: u32,
    geometry: u32,
    order: u32,
}

/// Why a state cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is none, or is damaged.
    #[error("{path}: {problem}")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// It is of another scene or order.
    #[error("{path} is the state of another rendering: {what} differs; remove the file to begin anew")]
    Other {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: &'static str,
    },
}

#[derive(Serialize, Deserialize)]
struct Stored {
    fingerprint: Fingerprint,
    width: u32,
    height: u32,
    tallies: Vec<Tally>,
}

impl Fingerprint {
    /// Of a scene and how it is to be rendered.
    pub fn of(scene: &Scene, prepared: &Prepared, order: &Order) -> Fingerprint {
        let checksum = |bytes: &[u8]| crc32fast::hash(bytes);
        let mut scene = scene.clone();
        scene.settings.samples = 0;
        let words = serde_json::to_vec(&scene).unwrap_or_default();
        let mut geometry = Hasher::new();
        geometry.update(bytemuck::cast_slice(&prepared.triangles));
        geometry.update(bytemuck::cast_slice(&prepared.vertices));
        let Order { width, height, samples, matte, seed, .. } = order;
        // A single sample lies in the middle of its pixel, where none of many need be.
        let order = format!("{width} {height} {matte} {seed} {}", samples.min(&2));
        Fingerprint { scene: checksum(&words), geometry: geometry.finalize(), order: checksum(order.as_bytes()) }
    }

    /// What of it differs from another.
    fn difference(&self, other: &Fingerprint) -> Option<&'static str> {
        let parts = [
            (self.order != other.order, "its size, seed or background"),
            (self.geometry != other.geometry, "its geometry"),
            (self.scene != other.scene, "its scene"),
        ];
        parts.into_iter().find(|(differs, _)| *differs).map(|(_, what)| what)
    }
}

impl Film {
    /// Writes what is known of all pixels; a file of that name is only replaced when all is written.
    ///
    /// # Errors
    /// [`StateError::File`].
    pub fn write_state(&self, path: &Path, fingerprint: Fingerprint) -> Result<(), StateError> {
        let failed = |source| StateError::File { path: path.into(), source };
        let (width, height) = (self.width(), self.height());
        let stored = Stored { fingerprint, width, height, tallies: self.tallies().to_vec() };
        let payload = bincode::serde::encode_to_vec(&stored, ENCODING)
            .map_err(|error| failed(std::io::Error::other(error.to_string())))?;
        let mut name = path.as_os_str().to_owned();
        name.push(".new");
        let beside = PathBuf::from(name);
        let write = || {
            let mut file = fs::File::create(&beside)?;
            file.write_all(&MAGIC)?;
            file.write_all(&crc32fast::hash(&payload).to_le_bytes())?;
            file.write_all(&payload)?;
            file.sync_all()?;
            fs::rename(&beside, path)
        };
        write().map_err(|error| {
            // What was written of it is of no use; that the writing failed is what counts.
            let _ = fs::remove_file(&beside);
            failed(error)
        })
    }

    /// Reads what was written by [`Film::write_state`] for the same fingerprint.
    ///
    /// # Errors
    /// [`StateError`].
    pub fn read_state(path: &Path, order: &Order, fingerprint: Fingerprint) -> Result<Film, StateError> {
        let damaged = |problem: &str| StateError::Damaged { path: path.into(), problem: problem.into() };
        let failed = |source| StateError::File { path: path.into(), source };
        let largest = MOST_HEAD + PIXEL * u64::from(order.width) * u64::from(order.height);
        let mut bytes = Vec::new();
        fs::File::open(path).map_err(failed)?.take(largest + 1).read_to_end(&mut bytes).map_err(failed)?;
        let rest = bytes.strip_prefix(&MAGIC).ok_or_else(|| match bytes.strip_prefix(&MAGIC[..7]) {
            Some([version, ..]) => damaged(&format!("version {version} is not known; {} is", MAGIC[7])),
            _ => damaged("it is no state of a rendering"),
        })?;
        let (sum, payload) = rest.split_first_chunk::<4>().ok_or_else(|| damaged("it is cut off"))?;
        let stored = bincode::serde::decode_from_slice::<Stored, _>(payload, ENCODING);
        // A picture of another size may be longer than what was read of it: its head tells.
        let head = bincode::serde::decode_from_slice::<Fingerprint, _>(payload, ENCODING);
        if let Some(what) = head.ok().and_then(|(found, _)| found.difference(&fingerprint)) {
            return Err(StateError::Other { path: path.into(), what });
        }
        let (stored, used) = stored.map_err(|error| damaged(&error.to_string()))?;
        if used != payload.len() || crc32fast::hash(payload) != u32::from_le_bytes(*sum) {
            return Err(damaged("its checksum is wrong"));
        }
        let Stored { width, height, tallies, .. } = stored;
        Film::of_tallies(width, height, tallies)
            .filter(|film| (film.width(), film.height()) == (order.width, order.height))
            .ok_or_else(|| damaged("it has another number of pixels than it says"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn order() -> Order {
        Order::of(&crate::scene::Settings { width: 3, height: 2, ..Default::default() })
    }

    fn fingerprint(samples: u32, seed: u64, red: f64) -> Fingerprint {
        let mut scene = Scene { background: DVec3::X * red, ..Scene::default() };
        scene.settings.samples = samples;
        let prepared = Prepared::new(&scene).expect("a scene");
        Fingerprint::of(&scene, &prepared, &Order { seed, samples, ..order() })
    }

    fn film() -> Film {
        let tally = |k: u32| Tally { sum: DVec3::new(0.1, 1.0 / 3.0, f64::from(k)), count: k, ..Tally::default() };
        Film::of_tallies(3, 2, (0..6).map(tally).collect()).expect("six pixels")
    }

    #[test]
    fn a_state_comes_back_bit_for_bit_for_the_same_rendering_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.state");
        let own = fingerprint(16, 1, 0.5);
        film().write_state(&path, own).expect("written");
        assert_eq!(Film::read_state(&path, &order(), own).expect("read"), film());
        assert_eq!(own, fingerprint(64, 1, 0.5), "more samples may be added");
        for (other, what) in [(fingerprint(16, 2, 0.5), "seed"), (fingerprint(16, 1, 0.6), "scene")] {
            let error = Film::read_state(&path, &order(), other).expect_err("another rendering").to_string();
            assert!(error.contains(what), "{error}");
        }
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left beside it");
    }

    #[test]
    fn damage_is_found_wherever_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.state");
        let own = fingerprint(16, 1, 0.5);
        film().write_state(&path, own).expect("written");
        let whole = fs::read(&path).expect("read");
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x40;
            fs::write(&path, &bytes).expect("written");
            assert!(Film::read_state(&path, &order(), own).is_err(), "byte {at}");
            fs::write(&path, &whole[..at]).expect("written");
            assert!(Film::read_state(&path, &order(), own).is_err(), "{at} bytes");
        }
        fs::write(&path, [whole, vec![0]].concat()).expect("written");
        assert!(Film::read_state(&path, &order(), own).is_err(), "one byte too many");
    }
}
