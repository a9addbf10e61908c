//! The state of a rendering in a file, so that an interrupted one continues where it stopped.
//!
//! Layout: eight bytes of name and version; a [`Head`]; the [`Tally`] of each pixel; in version 5, which is that of a
//! film to be denoised, the [`PixelFeatures`] of each pixel; where adaptive sampling is in the middle of a pass, the
//! goal of each pixel (u32); and a checksum of all before it (CRC-32, u32). Numbers are little-endian.

use super::RenderOrder;
use super::content_hash::ContentHash;
use super::features::PixelFeatures;
use super::film::{AdaptiveSampling, Film};
use super::tally::Tally;
use crate::encoding::{EncodingError, Integers, decode_from, encode_into};
use crate::picture::PictureError;
use crate::picture::display::DisplayTransform;
use crate::scene::{Prepared, Scene};
use crc32fast::Hasher;
use files::{Destination, WriteError};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between checkpoints at least, in times that writing one took.
const LEAST_WORK: u32 = 10;

/// When the next checkpoint is due after one that began at a time and is written now: where writing takes long, later,
/// so that most of the time goes into the work.
pub(super) fn after(every: Duration, begin: Instant) -> Instant {
    let now = Instant::now();
    now + every.max((now - begin) * LEAST_WORK)
}

/// The first bytes of such a file; the version follows.
const MAGIC: [u8; 7] = *b"PERISF\x00";
/// The versions of films without and with features for a denoiser.
const WITHOUT_FEATURES: u8 = 4;
const WITH_FEATURES: u8 = 5;

/// Bytes that are written at a time.
const PIECE: usize = 1 << 20;

/// A scene and an order, as far as samples depend on them: where it is the same, samples can be added to others.
///
/// It is the checksum of everything that was tessellated, of the scene and the pixels of its skies; the number of samples, the
/// target and the time are not in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    scene: u32,
    geometry: u32,
    order: u32,
}

/// A reason for which a state cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The file is no state, or is damaged.
    #[error("{path}: {problem}")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The fault of the file.
        problem: String,
    },
    /// The state is of another scene or order.
    #[error("{path} is the state of other work: {what}; remove the file to begin anew")]
    Other {
        /// The file.
        path: PathBuf,
        /// The part that differs.
        what: &'static str,
    },
    /// The state cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// There is no film of that size.
    #[error(transparent)]
    Size(#[from] PictureError),
}

/// The head of the file, before the pixels.
#[derive(Serialize, Deserialize)]
struct Head {
    fingerprint: Fingerprint,
    /// Views of a sequence that are finished; the pixels are those of the next one.
    views: u32,
    width: u32,
    height: u32,
    /// Target of adaptive sampling, samples of its last pass, and whether the goals of another are there.
    adaptive: Option<(f64, u32, bool)>,
}

/// A rendering that was stopped.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderState {
    /// Views of a sequence that were finished.
    pub views: u32,
    /// The next one, as far as it came.
    pub film: Film,
}

impl Fingerprint {
    /// The fingerprint of a scene and how it is to be rendered.
    pub fn of(scene: &Scene, prepared: &Prepared, order: &RenderOrder) -> Fingerprint {
        let mut scene = scene.clone();
        scene.settings.image.samples = 0;
        // A film holds radiance, however it is shown.
        scene.display = DisplayTransform::default();
        let mut content = ContentHash::new();
        content.add_scene(&scene);
        let mut geometry = Hasher::new();
        geometry.update(bytemuck::cast_slice(&prepared.triangles));
        geometry.update(bytemuck::cast_slice(&prepared.vertices));
        prepared.add_placements_to_checksum(&mut geometry);
        let RenderOrder { width, height, samples, matte, seed, .. } = order;
        // A single sample lies in the middle of its pixel, where none of many need be.
        let order = format!("{width} {height} {matte} {seed} {}", samples.min(&2));
        Fingerprint {
            scene: content.value() as u32,
            geometry: geometry.finalize(),
            order: crc32fast::hash(order.as_bytes()),
        }
    }

    /// The fingerprint of this rendering made as a variant, such as one of several views.
    ///
    /// - `way`: the variant in words; fingerprints of others differ.
    pub fn with(self, way: &str) -> Fingerprint {
        Fingerprint { order: crc32fast::hash(format!("{} {way}", self.order).as_bytes()), ..self }
    }

    /// Of the scene alone, and what else is told: the size of the picture, its seed and background are not in it.
    pub fn of_scene(&self, more: &str) -> u32 {
        crc32fast::hash(format!("{} {} {more}", self.scene, self.geometry).as_bytes())
    }

    /// The first part that differs from another fingerprint.
    fn difference(&self, other: &Fingerprint) -> Option<&'static str> {
        let parts = [
            (self.order != other.order, "its size, seed or background differs"),
            (self.geometry != other.geometry, "its geometry differs"),
            (self.scene != other.scene, "its scene differs"),
        ];
        parts.into_iter().find(|(differs, _)| *differs).map(|(_, what)| what)
    }
}

/// Passes bytes on, and adds them to a checksum.
struct Summed<T> {
    inner: T,
    sum: Hasher,
}

impl<T> Summed<T> {
    fn new(inner: T) -> Summed<T> {
        Summed { inner, sum: Hasher::new() }
    }
}

impl<T: Write> Write for Summed<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.sum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<T: Read> Read for Summed<T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(bytes)?;
        self.sum.update(&bytes[..read]);
        Ok(read)
    }
}

impl Film {
    /// Writes what is known of all pixels; a file of that name is only replaced when all is written.
    ///
    /// - `views`: of a sequence, that were finished before this one.
    ///
    /// # Errors
    /// [`StateError::Write`]; the state may be kept elsewhere then.
    pub fn write_state(
        &self,
        destination: &Destination,
        fingerprint: Fingerprint,
        views: u32,
    ) -> Result<(), StateError> {
        let adaptive = self.progress();
        let goals = adaptive.map_or(&[][..], |adaptive| &adaptive.goals);
        let head = Head {
            fingerprint,
            views,
            width: self.width(),
            height: self.height(),
            adaptive: adaptive.map(|adaptive| (adaptive.target, adaptive.finished, !goals.is_empty())),
        };
        Ok(destination.write_or_save_elsewhere(|file| {
            // Checksums of large pieces are found many times faster than those of small ones.
            let mut pieces = BufWriter::with_capacity(PIECE, Summed::new(file));
            pieces.write_all(&MAGIC)?;
            pieces.write_all(&[if self.features().is_empty() { WITHOUT_FEATURES } else { WITH_FEATURES }])?;
            encode(&head, &mut pieces)?;
            self.tallies().iter().try_for_each(|tally| encode(tally, &mut pieces))?;
            self.features().iter().try_for_each(|features| encode(features, &mut pieces))?;
            goals.iter().try_for_each(|goal| encode(goal, &mut pieces))?;
            let Summed { inner, sum } = pieces.into_inner().map_err(io::IntoInnerError::into_error)?;
            inner.write_all(&sum.finalize().to_le_bytes())
        })?)
    }
}

impl RenderState {
    /// Reads what was written by [`Film::write_state`] for the same fingerprint.
    ///
    /// # Errors
    /// [`StateError`].
    pub fn read(path: &Path, order: &RenderOrder, fingerprint: Fingerprint) -> Result<RenderState, StateError> {
        let failed = |source| StateError::File { path: path.into(), source };
        let damaged = |problem: &str| StateError::Damaged { path: path.into(), problem: problem.into() };
        let file = files::open(path).map_err(failed)?;
        let mut file = Summed::new(BufReader::new(file));
        let mut magic = [0; 8];
        file.read_exact(&mut magic).map_err(|_| damaged("it is no state of a rendering"))?;
        let is_guided = match magic.strip_prefix(&MAGIC) {
            Some([WITHOUT_FEATURES]) => false,
            Some([WITH_FEATURES]) => true,
            Some([version]) => {
                return Err(damaged(&format!(
                    "version {version} is not known; {WITHOUT_FEATURES} and {WITH_FEATURES} are"
                )));
            }
            _ => return Err(damaged("it is no state of a rendering")),
        };
        if order.denoise && !is_guided {
            return Err(StateError::Other { path: path.into(), what: "it was begun without --denoise" });
        }
        let head: Head = decode(&mut file).map_err(|problem| damaged(&problem))?;
        if let Some(what) = head.fingerprint.difference(&fingerprint) {
            return Err(StateError::Other { path: path.into(), what });
        }
        if (head.width, head.height) != (order.width, order.height) {
            return Err(damaged("it has another size than it says"));
        }
        let pixels = head.width as usize * head.height as usize;
        let mut all = || -> Result<Film, String> {
            let tallies = (0..pixels).map(|_| decode(&mut file)).collect::<Result<Vec<Tally>, _>>()?;
            let features = (0..if is_guided { pixels } else { 0 }).map(|_| decode(&mut file));
            let features = features.collect::<Result<Vec<PixelFeatures>, _>>()?;
            let mut film = Film::of_tallies(head.width, head.height, tallies, features).ok_or("its size is wrong")?;
            if let Some((target, finished, has_goals)) = head.adaptive {
                let goals = (0..if has_goals { pixels } else { 0 }).map(|_| decode(&mut file));
                let goals = goals.collect::<Result<Vec<u32>, _>>()?;
                film.set_adaptive(Some(AdaptiveSampling { target, finished, goals }));
            }
            let sum = file.sum.clone().finalize();
            let mut rest = Vec::new();
            file.inner.by_ref().take(5).read_to_end(&mut rest).map_err(|error| error.to_string())?;
            if rest == sum.to_le_bytes() { Ok(film) } else { Err("its checksum is wrong".into()) }
        };
        Ok(RenderState { views: head.views, film: all().map_err(|problem| damaged(&problem))? })
    }
}

fn encode(value: &impl Serialize, file: &mut impl Write) -> io::Result<()> {
    encode_into(value, Integers::Fixed, file).map_err(|error| match error {
        EncodingError::File(error) => error,
        other => io::Error::other(other),
    })
}

fn decode<T: DeserializeOwned>(file: &mut impl Read) -> Result<T, String> {
    decode_from(file, Integers::Fixed).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;
    use crate::illumination::Light;
    use crate::illumination::light::{Panorama, SkyMap};
    use crate::render::PixelSample;
    use glam::DVec3;
    use std::fs;
    use std::sync::Arc;

    fn order() -> RenderOrder {
        RenderOrder::of(&crate::scene::Settings::of_size(3, 2, 16))
    }

    fn fingerprint(samples: u32, seed: u64, red: f64) -> Fingerprint {
        let mut scene = Scene { background: DVec3::X * red, ..Scene::default() };
        scene.settings.image.samples = samples;
        let prepared = Prepared::new(&scene).expect("a scene");
        Fingerprint::of(&scene, &prepared, &RenderOrder { seed, samples, ..order() })
    }

    fn film() -> Film {
        let tally = |k: u32| Tally { sum: DVec3::new(0.1, 1.0 / 3.0, f64::from(k)), count: k, ..Tally::default() };
        let mut film = Film::of_tallies(3, 2, (0..6).map(tally).collect(), Vec::new()).expect("six pixels");
        film.set_adaptive(Some(AdaptiveSampling { target: 0.01, finished: 8, goals: (8..14).collect() }));
        film
    }

    #[test]
    fn a_state_comes_back_bit_for_bit_for_the_same_rendering_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.state");
        let own = fingerprint(16, 1, 0.5);
        film().write_state(&Destination::of(&path).expect("a destination"), own, 3).expect("written");
        assert_eq!(RenderState::read(&path, &order(), own).expect("read"), RenderState { views: 3, film: film() });
        assert_eq!(own, fingerprint(64, 1, 0.5), "more samples may be added");
        for (other, what) in [(fingerprint(16, 2, 0.5), "seed"), (fingerprint(16, 1, 0.6), "scene")] {
            let error = RenderState::read(&path, &order(), other).expect_err("another rendering").to_string();
            assert!(error.contains(what), "{error}");
        }
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left beside it");
    }

    #[test]
    fn skies_of_other_pixels_are_other_scenes() {
        let under = |light: f64| {
            let panorama = Panorama::of(4, 2, |x, y| DVec3::splat(light * f64::from(x + y))).expect("a panorama");
            let map = SkyMap { file: "sky.exr".into(), panorama: Some(Arc::new(panorama)), disc: None };
            let sky = Light::Sky { map: Some(map), radiance: Color::grey(1.0), turned: 0.0 };
            let scene = Scene { lights: vec![sky], ..Scene::default() };
            Fingerprint::of(&scene, &Prepared::new(&scene).expect("a scene"), &order())
        };
        assert_eq!((under(1.0), under(1.0) == under(1.5)), (under(1.0), false));
    }

    #[test]
    fn features_of_a_denoiser_come_back_and_are_asked_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let destination = Destination::of(folder.path().join("a.state")).expect("a destination");
        let own = fingerprint(16, 1, 0.5);
        let mut guided = Film::new(3, 2).expect("small").with_features();
        let sample = PixelSample { radiance: DVec3::ONE, albedo: DVec3::X, normal: DVec3::Y, ..PixelSample::default() };
        guided.rows_mut()[1].add(2, &sample, &Default::default());
        guided.write_state(&destination, own, 0).expect("written");
        for denoise in [false, true] {
            let state = RenderState::read(destination.path(), &RenderOrder { denoise, ..order() }, own).expect("read");
            assert_eq!((state.film.features(), state.film.features()[5].albedo[0]), (guided.features(), 1.0));
        }
        film().write_state(&destination, own, 0).expect("written");
        let error = RenderState::read(destination.path(), &RenderOrder { denoise: true, ..order() }, own)
            .expect_err("no features");
        assert!(error.to_string().contains("--denoise"), "{error}");
    }

    #[test]
    fn damage_is_found_wherever_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.state");
        let own = fingerprint(16, 1, 0.5);
        film().write_state(&Destination::of(&path).expect("a destination"), own, 3).expect("written");
        let whole = fs::read(&path).expect("read");
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x40;
            fs::write(&path, &bytes).expect("written");
            assert!(RenderState::read(&path, &order(), own).is_err(), "byte {at}");
            fs::write(&path, &whole[..at]).expect("written");
            assert!(RenderState::read(&path, &order(), own).is_err(), "{at} bytes");
        }
        fs::write(&path, [whole, vec![0]].concat()).expect("written");
        assert!(RenderState::read(&path, &order(), own).is_err(), "one byte too many");
    }
}
