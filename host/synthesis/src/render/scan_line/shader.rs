//! Shading of the samples of a picture, and the scratch that a thread keeps from pixel to pixel.

use super::casters::Casters;
use super::enclosed::ShadowVolumes;
use super::finishing::FinishingScratch;
use super::irradiance_cache::IrradianceCache;
use super::lamp::LampPoint;
use super::sky_light::SkyLight;
use super::surfaces::{PixelInteraction, PixelSurface, SampleFragment};
use crate::color::Channels;
use crate::illumination::optics::TextureMixture;
use crate::render::indirect::IndirectLight;
use crate::render::ray_tracing::RayFinisher;
use crate::render::world::{Appearance, CameraRays, World};
use glam::DVec3;

/// The contribution of a lamp.
#[derive(Clone, Copy, Debug)]
pub(super) struct LampContribution {
    pub(super) lamp: usize,
    /// At the wavelengths of the shading context.
    pub(super) radiance: Channels,
    /// Summand of the count of the surface's own group: its light arrives on the other side.
    pub(super) turned: i32,
    /// In how many opaque volumes it is, where that is not left to the samples.
    pub(super) known: Option<bool>,
    /// The begin of its own among the transmittances by rays of what stands before it, if something passable does.
    pub(super) passed: Option<usize>,
}

/// The line of sight of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleSight {
    /// The begin of its parts.
    pub(super) begin: usize,
    /// The first sample of the pixel that gets the same light.
    pub(super) like: usize,
    /// How many of its parts are before a light that is no object, if it sees one.
    pub(super) before_light: Option<usize>,
    /// The light of the sample, summed over the wavelength sets, if it is not like another.
    pub(super) light: DVec3,
}

/// Shades the samples of a picture.
pub(super) struct Shader<'a> {
    pub(super) appearance: &'a Appearance<'a>,
    /// What rays go through, if there are some.
    pub(super) world: Option<&'a World<'a>>,
    pub(super) casters: &'a Casters<'a>,
    pub(super) lamps: &'a [LampPoint],
    /// The light of skies, if there are some.
    pub(super) sky_light: Option<&'a SkyLight>,
    /// The light of all surfaces, if lamps are not sampled.
    pub(super) solution: Option<&'a dyn IndirectLight>,
    /// The light that surfaces send each other, if it is gathered.
    pub(super) others: Option<OtherSurfaces<'a>>,
    /// For each lamp with shadows.
    pub(super) enclosed: &'a [Option<ShadowVolumes<'a>>],
    /// Transmittance of each group of casters, by wavelength set.
    pub(super) group_transmittance: &'a [Vec<Channels>],
    pub(super) eye: &'a CameraRays,
    /// Whether every sample sees bands of light through nothing passable, and no light that is a surface.
    pub(super) is_plain: bool,
    pub(super) matte: bool,
    /// Whether some light is a surface that is seen and no object, and whether one is a sky.
    pub(super) has_surfaces: bool,
    pub(super) has_sky: bool,
    /// Whether lines of sight are parallel.
    pub(super) is_parallel: bool,
    /// The light where there is nothing, if it is the same everywhere.
    pub(super) background: Option<DVec3>,
}

/// Light that diffuse surfaces send each other.
pub(super) struct OtherSurfaces<'a> {
    pub(super) cache: IrradianceCache,
    /// Gathers it where the cache has none, from so many directions.
    pub(super) finisher: &'a RayFinisher<'a>,
    pub(super) directions: u32,
    /// For each triangle of the scene, whether it needs it.
    pub(super) triangles: &'a [bool],
    /// Columns of the picture.
    pub(super) width: usize,
}

/// Scratch that a thread keeps from pixel to pixel.
#[derive(Default)]
pub(super) struct PixelScratch<'a> {
    pub(super) surfaces: Vec<PixelSurface>,
    pub(super) parts: Vec<SampleFragment>,
    /// Elements of the surfaces, and their texture values.
    pub(super) interactions: Vec<PixelInteraction<'a>>,
    pub(super) mixtures: Vec<Option<TextureMixture<'a>>>,
    /// Contributions of lamps, surface by surface.
    pub(super) contributions: Vec<LampContribution>,
    /// Transmittances by rays of what is passable before lamps, for each wavelength set.
    pub(super) passed: Vec<Channels>,
    /// For each sample of the pixel.
    pub(super) samples: Vec<SampleSight>,
    /// The samples that were finished by rays.
    pub(super) finishing: FinishingScratch,
    /// The last element: its neighbours may differ in their place only.
    pub(super) last: Option<PixelInteraction<'a>>,
}

impl PixelScratch<'_> {
    /// Forgets the last pixel, so that no picture depends on which thread made which part of it.
    pub(super) fn clear(&mut self) {
        self.last = None;
    }
}
