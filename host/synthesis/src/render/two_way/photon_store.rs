//! Photon maps in a database: for every view of a scene, also in other runs, as long as what they depend on is the
//! same.
//!
//! A record holds the photons of one lamp and pass. Its name is a hash of all that they depend on: geometry, materials,
//! that lamp, and how photons are traced; another lamp, the camera, the size of the picture and its samples are not in
//! it. Paths are stored in whole blocks: where a lamp gets more paths or fewer than before, the blocks that are wanted
//! are taken, and the others are traced. The picture is the same to the bit as without.

use super::photon_source::PhotonSource;
use super::photon_tracing::{FluxBalance, Photon};
use super::{BatchResult, CHUNK, PathBatch};
use crate::color::{Channels, Color, LANES, Origin};
use crate::database::{DatabaseError, PhotonBlock, Record, RecordContent, RecordKind, Store, StoredPhotons};
use crate::illumination::Light;
use crate::illumination::optics::Interreflection;
use crate::render::content_hash::ContentHash;
use crate::render::world::World;
use crate::scene::{ImageSettings, LightSettings, PhotonSettings, Prepared, RadiositySettings, Scene, Settings};
use glam::DVec3;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Photons that a database holds, bytes: beyond that, what belongs to other scenes gives way, and nothing is added if
/// that is not enough.
const MOST_BYTES: u64 = 4 << 30;
/// Rises when photons are traced in another way, so that records of before are not taken.
const FORM: u32 = 1;
/// Marks photons that were scattered broadly; wavelength sets are fewer.
const HAD_BROAD: u8 = 0x80;

/// A store of the photons of a scene in a database.
#[derive(Clone, Debug)]
pub struct PhotonStore {
    path: PathBuf,
    /// A hash of the scene without lamps.
    scene: u128,
    /// Time after which photons of an unfinished pass are stored.
    pub(super) every: Duration,
    /// Whether photons of finished passes are stored, too.
    pub(super) keeps_finished: bool,
}

impl PhotonStore {
    /// A database for the photons of a scene; it is made if there is none.
    ///
    /// - `every`: photons of a pass that takes longer are stored after each such time. `lasts`: whether photons are
    ///   stored when their pass is finished; otherwise the database serves only to continue an interrupted pass.
    ///
    /// # Errors
    /// [`DatabaseError`] if the file is no database or cannot be written.
    pub fn new(
        path: &Path,
        scene: &Scene,
        prepared: &Prepared,
        every: Duration,
        lasts: bool,
    ) -> Result<PhotonStore, DatabaseError> {
        Store::open_to_write(path)?;
        let mut dark = scene.clone();
        dark.camera = None;
        // Of lamps, what they reflect stays.
        dark.lights.retain(|light| light.body().is_some());
        for light in &mut dark.lights {
            if let Light::Lamp { radiance, .. } = light {
                *radiance = Color::BLACK;
            }
        }
        for material in dark.objects.iter_mut().filter_map(|object| object.material.as_mut()) {
            material.emission = Color::grey(0.0);
        }
        // What only pictures depend on, radiosity, and where photons are gathered.
        let Settings { image, geometry, light, photons, .. } = scene.settings;
        let PhotonSettings { count, radius, .. } = PhotonSettings::default();
        let LightSettings { samples, buffer, .. } = LightSettings::default();
        let interreflection = match light.interreflection {
            Interreflection::Solved => Interreflection::LeftOut,
            other => other,
        };
        dark.settings = Settings {
            image: ImageSettings { filter: image.filter, seed: image.seed, ..ImageSettings::default() },
            geometry,
            light: LightSettings { samples, buffer, interreflection, ..light },
            photons: PhotonSettings { count, radius, ..photons },
            radiosity: RadiositySettings::default(),
        };
        let mut sum = ContentHash::new();
        sum.add(&(FORM, &dark));
        sum.add_bytes(bytemuck::cast_slice(&prepared.triangles));
        sum.add_bytes(bytemuck::cast_slice(&prepared.vertices));
        Ok(PhotonStore { path: path.into(), scene: sum.value(), every, keeps_finished: lasts })
    }

    /// The name of the photons of a lamp, less the pass.
    ///
    /// - `pilot`: how many paths were traced first to each of its photon targets.
    pub(super) fn name(
        &self,
        world: &World<'_>,
        lamp: &PhotonSource,
        keeps: impl Fn(usize) -> bool,
        pilot: u32,
    ) -> String {
        let appearance = &world.appearance;
        let prepared = appearance.prepared;
        let number = appearance.sources[lamp.source].0;
        let mut sum = ContentHash::new();
        let kept: Vec<bool> = (0..prepared.objects.len()).map(keeps).collect();
        let ways = (appearance.wavelengths.is_spectral(), appearance.curved, appearance.exact, appearance.has_passable);
        sum.add(&(self.scene, number as u64, pilot, kept, ways));
        match (prepared.lights.get(number), appearance.emitter(lamp.source)) {
            (Some(light), _) => sum.add(light),
            (None, Some((object, material))) => {
                let material = &prepared.objects[object as usize].materials[material as usize];
                sum.add(&(object, &material.emission));
            }
            (None, None) => {}
        }
        format!("{}-{:032x}", self.prefix(), sum.value())
    }

    /// The prefix of the names of all photons of the scene.
    fn prefix(&self) -> String {
        format!("{:08x}", self.scene as u32)
    }

    /// Photons of a lamp that are stored, block by block; of more, the first blocks.
    pub(super) fn load(&self, name: &str, lamp: usize, lanes: usize) -> HashMap<PathBatch, BatchResult> {
        let found = Store::open(&self.path).and_then(|store| store.find(RecordKind::Photons, name));
        let stored_photons = match found {
            Ok(Some(Record { content: RecordContent::Photons(stored_photons), .. })) => *stored_photons,
            Ok(_) => return HashMap::new(),
            Err(error) => {
                tracing::warn!("the photon map is not read: {error}");
                return HashMap::new();
            }
        };
        let blocks = stored_photons.blocks.into_iter().filter(|_| usize::from(stored_photons.lanes) == lanes);
        blocks
            .map(|block| (PathBatch { lamp, target: block.target as usize, number: block.number }, read(&block, lanes)))
            .collect()
    }

    /// Stores photons of a lamp instead of what was stored of it; what cannot be stored is reported and else not
    /// missed.
    ///
    /// - `what`: the lamp and the pass in words.
    pub(super) fn save(&self, name: &str, what: String, lanes: usize, blocks: &HashMap<PathBatch, &BatchResult>) {
        let mut sorted: Vec<_> = blocks.iter().collect();
        sorted.sort_by_key(|(chunk, _)| (chunk.number, chunk.target));
        let blocks: Vec<PhotonBlock> = sorted.into_iter().map(|(chunk, block)| written(chunk, block, lanes)).collect();
        let content = RecordContent::Photons(Box::new(StoredPhotons { lanes: lanes as u8, blocks }));
        let origin = Origin { what, source: "two-way ray tracing".into(), terms: String::new() };
        let record = Record { name: name.into(), origin, content };
        if let Err(error) = Store::open_to_write(&self.path).and_then(|store| self.add(&store, record)) {
            tracing::warn!("the photon map is not stored: {error}");
        }
    }

    fn add(&self, store: &Store, record: Record) -> Result<(), DatabaseError> {
        let entries = store.entries(Some(RecordKind::Photons))?;
        let mut bytes: u64 = entries.iter().map(|entry| entry.bytes).sum();
        if bytes > MOST_BYTES {
            let others = || entries.iter().filter(|entry| !entry.name.starts_with(&self.prefix()));
            bytes -= others().map(|entry| entry.bytes).sum::<u64>();
            store.remove(&others().map(|entry| (RecordKind::Photons, &*entry.name)).collect::<Vec<_>>())?;
        }
        if bytes > MOST_BYTES { Ok(()) } else { store.add(&[record], true) }
    }
}

fn written(chunk: &PathBatch, block: &BatchResult, lanes: usize) -> PhotonBlock {
    let FluxBalance {
        paths: _,
        stored_paths: _,
        sent,
        rescattered: again,
        gained,
        straight,
        stored,
        absorbed,
        escaped,
        stopped,
    } = block.balance;
    let all = || block.photons.iter();
    PhotonBlock {
        target: chunk.target as u32,
        number: chunk.number,
        paths: u64::from(CHUNK),
        balance: [sent, again, gained, straight, stored, absorbed, escaped, stopped],
        positions: all().map(|photon| photon.position.to_array()).collect(),
        towards: all().map(|photon| photon.towards.as_vec3().to_array()).collect(),
        flux: all().flat_map(|photon| photon.flux.0[..lanes].iter().map(|flux| *flux as f32)).collect(),
        sides: all().map(|photon| photon.side).collect(),
        wavelength_sets: all()
            .map(|photon| if photon.had_broad { photon.wavelength_set | HAD_BROAD } else { photon.wavelength_set })
            .collect(),
    }
}

fn read(block: &PhotonBlock, lanes: usize) -> BatchResult {
    let photon = |k: usize| {
        let mut flux = [0.0; LANES];
        flux.iter_mut().zip(&block.flux[k * lanes..(k + 1) * lanes]).for_each(|(lane, flux)| *lane = f64::from(*flux));
        Photon {
            position: DVec3::from_array(block.positions[k]),
            towards: DVec3::from_array(block.towards[k].map(f64::from)),
            flux: Channels(flux),
            side: block.sides[k],
            wavelength_set: block.wavelength_sets[k] & !HAD_BROAD,
            had_broad: block.wavelength_sets[k] & HAD_BROAD != 0,
        }
    };
    let [sent, again, gained, straight, all, absorbed, escaped, stopped] = block.balance;
    let (ways, before) = (block.paths, block.paths);
    let balance = FluxBalance {
        paths: ways,
        stored_paths: before,
        sent,
        rescattered: again,
        gained,
        straight,
        stored: all,
        absorbed,
        escaped,
        stopped,
    };
    BatchResult { photons: (0..block.positions.len()).map(photon).collect(), balance }
}
