//! A BSDF: a material prepared for rendering, a sum of lobes, some of which continue paths.

use super::context::{BsdfSample, InterfaceIndices, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::lobes::AnyLobe;
use super::prepared_textures::{PreparedNumber, PreparedPaint, PreparedTexture};
use super::principled::PrincipledSurface;
use crate::color::{Channels, SpectralTable};
use crate::illumination::texture::{NumberTexture, Relief, TextureFootprint};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Most lobes of a BSDF.
const MOST_LOBES: usize = 4;

/// The texture values of a material at a footprint, one after the other; a number is in all lanes.
pub type TextureValues = Vec<Channels>;

/// The texture values of a material at a footprint, for any wavelengths.
#[derive(Clone, Debug, Default)]
pub struct TextureMixture<'a> {
    /// How many patterns there are.
    count: usize,
    /// The texture that it belongs to, a color in it, and how much there is of it.
    parts: Vec<(usize, &'a SpectralTable, f64)>,
    /// The texture that it belongs to, and its number.
    numbers: Vec<(usize, f64)>,
}

impl TextureMixture<'_> {
    /// The texture values at the wavelengths of a wavelength set.
    pub fn at(&self, wavelength_set: usize) -> TextureValues {
        let mut texture_values = vec![Channels::ZERO; self.count];
        for (pattern, curve, amount) in &self.parts {
            texture_values[*pattern] += curve.of(wavelength_set) * *amount;
        }
        for (pattern, number) in &self.numbers {
            texture_values[*pattern] = Channels::splat(*number);
        }
        texture_values
    }
}

/// The class of a lobe of a surface.
///
/// The first two continue paths from the camera. Light path expressions (Heckbert 1990) tell light paths apart by them:
/// each scattering event is by a broad lobe or by a narrow one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LobeClass {
    /// Broad lobes scatter light about everywhere: class D (diffuse) of light path expressions, and glossy lobes whose
    /// pdf stays below 1.5/sr.
    Broad,
    /// Narrow lobes concentrate light: classes S (specular) and G (glossy) of light path expressions, as mirrors,
    /// smooth interfaces, and rough ones with narrow highlights.
    Narrow,
    /// Broad lobes where a radiosity solution has the light of other surfaces: paths from the camera end at them, and
    /// photons are scattered on.
    Radiosity,
    /// Lobes that reflect light of lights only, and continue no path.
    LightsOnly,
}

/// How diffuse interreflection is found: light that goes from one diffuse surface to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interreflection {
    /// It is left out.
    #[default]
    LeftOut,
    /// By paths from the camera.
    Followed,
    /// By a radiosity solution.
    Solved,
}

impl Interreflection {
    /// Lets it count, by paths from the camera unless it counts already.
    pub fn count(&mut self) {
        if *self == Interreflection::LeftOut {
            *self = Interreflection::Followed;
        }
    }
}

impl LobeClass {
    /// The classes that continue paths from the camera.
    pub const CONTINUING: [LobeClass; 2] = [LobeClass::Broad, LobeClass::Narrow];
}

/// A selection of lobes among which a direction is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LobeSelection {
    /// All that continue paths from the camera.
    All,
    /// Those that are not delta: [`Bsdf::specular_samples`] gives the others.
    NonDelta,
    /// The narrow ones.
    Narrow,
    /// The broad ones, solved by radiosity or not.
    Broad,
}

impl LobeSelection {
    fn has(self, class: LobeClass, flags: Flags) -> bool {
        match self {
            LobeSelection::All => LobeClass::CONTINUING.contains(&class),
            LobeSelection::NonDelta => LobeClass::CONTINUING.contains(&class) && !flags.has(Flags::DELTA),
            LobeSelection::Narrow => class == LobeClass::Narrow,
            LobeSelection::Broad => matches!(class, LobeClass::Broad | LobeClass::Radiosity),
        }
    }
}

/// A lobe of a BSDF.
#[derive(Clone, Debug)]
struct Member {
    class: LobeClass,
    /// The flags of the lobe.
    flags: Flags,
    lobe: AnyLobe,
}

/// A BSDF: a material prepared for rendering.
#[derive(Clone, Debug)]
pub struct Bsdf {
    lobes: Vec<Member>,
    casts_caustics: bool,
    stores_photons: bool,
    transmits_straight: bool,
    continues_non_delta: bool,
    /// Reflectance of the ambient term; none if it is the diffuse albedo.
    pub(super) ambient: Option<PreparedPaint>,
    /// Textures: what changes from place to place.
    pub(super) patterns: Vec<PreparedTexture>,
    pub(super) relief: Option<Relief>,
    /// The part of light that goes straight through; none if none does.
    pub(super) straight_transmission: Option<StraightTransmission>,
    /// Radiance that it emits; none if it does not.
    pub emission: Option<SpectralTable>,
    /// The medium inside, where it is transparent.
    pub interior: Option<InteriorMedium>,
    /// The direction along which it is brushed.
    pub brushed_along: Option<DVec3>,
}

/// The part of light that goes straight through.
#[derive(Clone, Debug)]
pub(super) enum StraightTransmission {
    /// One fraction for light from everywhere.
    Paint(PreparedPaint),
    /// Through a polished pane.
    Pane(Arc<PrincipledSurface>),
}

impl StraightTransmission {
    fn of(&self, context: &ShadingContext) -> Channels {
        match self {
            StraightTransmission::Paint(shade) => shade.of(context),
            StraightTransmission::Pane(surface) => surface.straight_transmittance(context),
        }
    }
}

/// The medium behind the surface of a transparent body.
#[derive(Clone, Debug)]
pub struct InteriorMedium {
    /// Its refractive index.
    pub index: SpectralTable,
    /// Absorption in a unit of length.
    pub absorption: SpectralTable,
    /// Whether the index differs with the wavelength.
    pub disperses: bool,
    /// Priority among several bodies in one place: that of the greatest is there.
    pub priority: i32,
}

impl Bsdf {
    /// A material without lobes.
    ///
    /// - `ambient`: reflectance of the ambient term. `emission`: radiance.
    pub(super) fn new(ambient: PreparedPaint, relief: Option<Relief>, emission: Option<SpectralTable>) -> Bsdf {
        Bsdf {
            lobes: Vec::new(),
            casts_caustics: false,
            stores_photons: false,
            transmits_straight: false,
            continues_non_delta: false,
            ambient: Some(ambient),
            patterns: Vec::new(),
            relief,
            straight_transmission: None,
            emission,
            interior: None,
            brushed_along: None,
        }
    }

    /// Radiance towards the viewer for each unit of flux density that arrives from a light, 1/sr: D K / (N·V).
    ///
    /// Delta lobes count nothing here.
    pub fn value(&self, class: LobeClass, context: &ShadingContext, light: DVec3) -> Channels {
        self.of_class(class).fold(Channels::ZERO, |sum, lobe| sum + lobe.value(context, light))
    }

    /// Radiance towards the viewer for each unit of flux density that arrives from a light, 1/sr, by the lobes of a
    /// `selection`; delta lobes count nothing.
    pub fn value_among(&self, selection: LobeSelection, context: &ShadingContext, light: DVec3) -> Channels {
        let members = self.lobes.iter().filter(|member| selection.has(member.class, member.flags));
        members.fold(Channels::ZERO, |sum, member| sum + member.lobe.value(context, light))
    }

    /// Radiance towards the viewer for each unit of flux density that arrives from a light, 1/sr, by all lobes; delta
    /// lobes count nothing.
    #[inline]
    pub fn total_value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.value(context, light))
    }

    /// The pdf of a direction by [`Bsdf::sample`], by broad or by narrow lobes, 1/sr.
    ///
    /// - `selection`: as there.
    pub fn pdf(&self, class: LobeClass, context: &ShadingContext, light: DVec3, selection: LobeSelection) -> f64 {
        let shares = self.shares(context, selection);
        let members = self.lobes.iter().zip(&shares).filter(|(member, _)| member.class == class);
        members.map(|(member, share)| share * member.lobe.pdf(context, light)).sum()
    }

    /// The pdf of a direction by [`Bsdf::sample`] among lobes, 1/sr.
    pub fn pdf_among(&self, selection: LobeSelection, context: &ShadingContext, light: DVec3) -> f64 {
        let members = self.lobes.iter().zip(self.shares(context, selection)).filter(|(_, share)| *share > 0.0);
        members.map(|(member, share)| share * member.lobe.pdf(context, light)).sum()
    }

    /// Specular samples: the directions of mirrors and smooth interfaces, all of them.
    pub fn specular_samples(&self, context: &ShadingContext) -> impl Iterator<Item = BsdfSample> {
        let narrow = |member: &&Member| member.class == LobeClass::Narrow && member.flags.has(Flags::DELTA);
        let members = self.lobes.iter().filter(narrow);
        members
            .flat_map(|member| member.lobe.specular_samples(context))
            .flatten()
            .filter(|sample| sample.weight.max() > 0.0)
    }

    /// The BSDF sample that goes straight through, if anything does.
    pub fn straight_sample(&self, context: &ShadingContext) -> Option<BsdfSample> {
        let weight = self.straight_transmission.as_ref()?.of(context);
        Some(BsdfSample { light: -context.view, weight, pdf: None, is_straight: true, is_broad: false })
    }

    /// A BSDF sample: one direction, sampled about in proportion to what comes from there; none where that counts
    /// nothing.
    ///
    /// - `choice`: uniform in 0..1, chooses among lobes. `point`: uniform in the unit square.
    /// - `selection`: the lobes among which it is sampled.
    pub fn sample(
        &self,
        context: &ShadingContext,
        choice: f64,
        point: [f64; 2],
        selection: LobeSelection,
    ) -> Option<BsdfSample> {
        let shares = self.shares(context, selection);
        let (index, choice) = choose_share(&shares, choice)?;
        let Member { class, lobe, .. } = self.lobes.get(index)?;
        let drawn = lobe.sample(context, choice, point)?;
        if drawn.pdf.is_none() {
            return Some(BsdfSample { weight: drawn.weight * shares[index].recip(), ..drawn });
        }
        // The value of all lobes of the class there, over the pdf by all of them.
        let light = drawn.light;
        let (mut value, mut pdf) = (Channels::ZERO, 0.0);
        let is_broad = *class != LobeClass::Narrow;
        for (Member { class, lobe, .. }, share) in self.lobes.iter().zip(&shares).filter(|(_, share)| **share > 0.0) {
            if is_broad == (*class != LobeClass::Narrow) {
                value += lobe.value(context, light);
                pdf += share * lobe.pdf(context, light);
            }
        }
        let weight = value * (light.z.abs() / pdf);
        (pdf > 0.0 && weight.is_finite()).then_some(BsdfSample { weight, pdf: Some(pdf), is_broad, ..drawn })
    }

    /// The fraction of ambient light, the same radiance from everywhere, that is reflected or comes through.
    pub fn ambient(&self, context: &ShadingContext) -> Channels {
        let reflected =
            self.ambient.as_ref().map_or_else(|| self.diffuse_albedo(context), |ambient| ambient.of(context));
        reflected + self.diffuse_transmittance(context)
    }

    /// Glossy albedo: about what ambient light adds by what mirrors, metals, coats and glass reflect, where paths do
    /// not continue.
    pub fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.glossy_albedo(context))
    }

    /// Diffuse albedo: the part of light from all around that is reflected alike to everywhere, Lambert's term, and the
    /// mean of a ground under a coat.
    pub fn diffuse_albedo(&self, context: &ShadingContext) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.diffuse_albedo(context))
    }

    /// Diffuse transmittance: the part of light from all around the other side that comes through alike to everywhere.
    pub fn diffuse_transmittance(&self, context: &ShadingContext) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.diffuse_transmittance(context))
    }

    /// Albedo of the lobes that are not delta: about the part of light from all around that they reflect to the viewer.
    pub fn non_delta_albedo(&self, context: &ShadingContext) -> Channels {
        let spread = self.lobes.iter().filter(|member| !member.flags.has(Flags::DELTA));
        spread.fold(Channels::ZERO, |sum, Member { lobe, .. }| {
            sum + lobe.diffuse_albedo(context) + lobe.glossy_albedo(context)
        })
    }

    /// Whether some light is reflected alike to everywhere.
    pub fn is_diffuse(&self) -> bool {
        self.lobes.iter().any(|member| member.flags.has(Flags::DIFFUSE))
    }

    /// Whether it changes from place to place.
    pub fn is_textured(&self) -> bool {
        !self.patterns.is_empty() || self.relief.is_some()
    }

    /// Its texture values in the mean over a footprint, for any wavelengths.
    pub fn texture_mixture(&self, footprint: &TextureFootprint) -> TextureMixture<'_> {
        let mut mixture = TextureMixture { count: self.patterns.len(), ..TextureMixture::default() };
        for (index, pattern) in self.patterns.iter().enumerate() {
            match pattern {
                PreparedTexture::Paint(paint) => {
                    paint.each(footprint, 1.0, &mut |curve, amount| mixture.parts.push((index, curve, amount)));
                }
                PreparedTexture::Number(number) => mixture.numbers.push((index, number.at(footprint))),
            }
        }
        mixture
    }

    /// Its texture values in the mean over a footprint.
    pub fn texture_values(&self, footprint: &TextureFootprint, wavelength_set: usize) -> TextureValues {
        self.patterns.iter().map(|pattern| pattern.at(footprint, wavelength_set)).collect()
    }

    /// The normal of an element, tilted by the relief.
    ///
    /// - `normal`: of the surface, unit length, outwards.
    pub fn tilted(&self, footprint: &TextureFootprint, normal: DVec3) -> DVec3 {
        self.relief.as_ref().map_or(normal, |relief| relief.normal(footprint, normal))
    }

    /// Whether light goes straight through.
    pub fn is_passable(&self) -> bool {
        self.transmits_straight
    }

    /// Transmittance of light that goes straight through.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1. `footprint`: asked for only if there are textures.
    pub fn straight_transmittance(
        &self,
        wavelength_set: usize,
        cosine: f64,
        footprint: impl FnOnce() -> TextureFootprint,
    ) -> Channels {
        let Some(passing) = &self.straight_transmission else { return Channels::ZERO };
        let texture_values = if self.patterns.is_empty() {
            TextureValues::new()
        } else {
            self.texture_values(&footprint(), wavelength_set)
        };
        let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        passing.of(&ShadingContext {
            view,
            wavelength_set,
            indices: InterfaceIndices::AIR,
            lane: 0,
            texture_values: &texture_values,
        })
    }

    /// Whether it is a polished interface: what goes through has one direction.
    pub fn is_clear(&self) -> bool {
        let is_clear = |member: &Member| member.class == LobeClass::Narrow && member.flags.has(Flags::CLEAR);
        self.interior.is_some() && self.lobes.iter().any(is_clear)
    }

    /// Transmittance of a polished interface, as if it did not bend light.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1. `footprint`: asked for only if there are textures.
    pub fn clear_transmittance(
        &self,
        wavelength_set: usize,
        cosine: f64,
        footprint: impl FnOnce() -> TextureFootprint,
    ) -> Channels {
        let Some(interior) = &self.interior else { return Channels::ZERO };
        let texture_values = if self.patterns.is_empty() {
            TextureValues::new()
        } else {
            self.texture_values(&footprint(), wavelength_set)
        };
        let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        let side = InterfaceIndices { behind: interior.index.of(wavelength_set), ..InterfaceIndices::AIR };
        let context = ShadingContext { view, wavelength_set, indices: side, lane: 0, texture_values: &texture_values };
        self.of_class(LobeClass::Narrow).fold(Channels::ZERO, |sum, lobe| sum + lobe.clear_transmittance(&context))
    }

    /// Whether some lobe is not delta, so that lights are sampled.
    pub fn has_non_delta(&self) -> bool {
        self.lobes.iter().any(|member| !member.flags.has(Flags::DELTA))
    }

    /// Whether some lobe continues paths.
    pub fn continues_paths(&self) -> bool {
        self.lobes.iter().any(|member| LobeClass::CONTINUING.contains(&member.class))
    }

    /// Whether it shows what is around: sharply, by a narrow lobe that is not straight, or in place of all else, where no
    /// lobe is diffuse; or what is behind it, by a translucent one.
    pub fn shows_surroundings(&self) -> bool {
        let is_diffuse = |member: &Member| member.flags.has(Flags::DIFFUSE) && !member.flags.has(Flags::BLACK);
        let shows_else = self.lobes.iter().any(is_diffuse);
        self.lobes.iter().any(|Member { class, flags, .. }| {
            let hides = [Flags::BLACK, Flags::STRAIGHT, Flags::DIFFUSE].iter().any(|flag| flags.has(*flag));
            let is_beyond = flags.has(Flags::TRANSLUCENT);
            let is_meant = *class == LobeClass::Narrow || *class == LobeClass::Broad && (!shows_else || is_beyond);
            is_meant && !hides
        })
    }

    /// Whether some narrow lobe casts caustics: other than straight through.
    pub fn casts_caustics(&self) -> bool {
        self.casts_caustics
    }

    /// Whether some lobe that is not narrow takes light: photons are stored there.
    pub fn stores_photons(&self) -> bool {
        self.stores_photons
    }

    /// Radiance towards the viewer for each unit of flux density that arrives, 1/sr, of all lobes but the narrow ones.
    pub fn non_narrow_value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        let spread = self.lobes.iter().filter(|member| member.class != LobeClass::Narrow);
        spread.fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.value(context, light))
    }

    /// Radiance towards the viewer for each unit of flux density, 1/sr, of all lobes but the narrow ones, where it is
    /// one for all light from above; none where it is not.
    pub fn constant_value(&self, context: &ShadingContext) -> Option<Channels> {
        let mut spread = self.lobes.iter().filter(|member| member.class != LobeClass::Narrow);
        spread.try_fold(Channels::ZERO, |sum, Member { flags, lobe, .. }| {
            flags.has(Flags::EVEN).then(|| sum + lobe.value(context, DVec3::Z))
        })
    }

    /// Whether photons are scattered broadly by some lobe.
    pub fn is_broad(&self) -> bool {
        let goes_on =
            |member: &Member| LobeSelection::Broad.has(member.class, member.flags) && !member.flags.has(Flags::BLACK);
        self.lobes.iter().any(goes_on)
    }

    /// Whether some lobe that is not delta continues paths.
    pub fn continues_non_delta(&self) -> bool {
        self.continues_non_delta
    }

    /// Adds a lobe.
    ///
    /// - `interreflection`: how the lobe gets diffuse light of other surfaces, if it does.
    pub(super) fn add(&mut self, lobe: AnyLobe, interreflection: Interreflection) {
        let flags = lobe.flags();
        let class = match interreflection {
            Interreflection::LeftOut => LobeClass::LightsOnly,
            Interreflection::Solved if flags.has(Flags::DIFFUSE) => LobeClass::Radiosity,
            Interreflection::Solved => LobeClass::LightsOnly,
            Interreflection::Followed if flags.has(Flags::BROAD) => LobeClass::Broad,
            Interreflection::Followed => LobeClass::Narrow,
        };
        let is_black = flags.has(Flags::BLACK);
        let is_continued = LobeClass::CONTINUING.contains(&class);
        self.continues_non_delta |= is_continued && !flags.has(Flags::DELTA) && !is_black;
        match class {
            _ if is_black => {}
            LobeClass::Narrow if flags.has(Flags::STRAIGHT) => self.transmits_straight = true,
            LobeClass::Narrow if flags.has(Flags::PANE) => {
                (self.transmits_straight, self.casts_caustics) = (true, true)
            }
            LobeClass::Narrow => self.casts_caustics = true,
            LobeClass::Broad | LobeClass::Radiosity | LobeClass::LightsOnly => self.stores_photons = true,
        }
        self.lobes.push(Member { class, flags, lobe });
    }

    /// Adds a texture of a number that changes from place to place.
    pub(super) fn varying(&mut self, number: &NumberTexture) -> PreparedNumber {
        self.patterns.push(PreparedTexture::Number(number.clone()));
        PreparedNumber::Varying(self.patterns.len() - 1)
    }

    /// A number, which may change from place to place.
    pub(super) fn quantity(&mut self, number: &NumberTexture) -> PreparedNumber {
        match number {
            NumberTexture::Constant(value) => PreparedNumber::Constant(*value),
            varying => self.varying(varying),
        }
    }

    /// All lobes.
    #[cfg(test)]
    pub(super) fn lobes(&self) -> impl Iterator<Item = &AnyLobe> {
        self.lobes.iter().map(|member| &member.lobe)
    }

    fn of_class(&self, class: LobeClass) -> impl Iterator<Item = &AnyLobe> {
        self.lobes.iter().filter(move |member| member.class == class).map(|member| &member.lobe)
    }

    /// The chances of the lobes; they add up to 1, or are all 0.
    fn shares(&self, context: &ShadingContext, selection: LobeSelection) -> [f64; MOST_LOBES] {
        let mut shares = [0.0; MOST_LOBES];
        for (share, Member { class, flags, lobe }) in shares.iter_mut().zip(&self.lobes) {
            *share = if selection.has(*class, *flags) { lobe.strength(context) } else { 0.0 };
        }
        let all: f64 = shares.iter().sum();
        if all > 0.0 {
            shares.iter_mut().for_each(|share| *share /= all);
        }
        shares
    }
}

/// The share in which a number falls, and where in it, 0..1.
fn choose_share(shares: &[f64], choice: f64) -> Option<(usize, f64)> {
    let mut below = 0.0;
    let mut last = None;
    for (index, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        if choice < below + share {
            return Some((index, ((choice - below) / share).clamp(0.0, 1.0_f64.next_down())));
        }
        below += share;
        last = Some((index, 1.0_f64.next_down()));
    }
    last
}
