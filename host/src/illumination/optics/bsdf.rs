//! A material made ready for rendering: a sum of lobes, and which of them carry rays on.

use super::lobe::{Flags, Lobe};
use super::lobes::AnyLobe;
use super::principled::PrincipledSurface;
use super::shade::{PreparedTexture, PreparedNumber, PreparedPaint};
use super::sighting::{BsdfSample, InterfaceIndices, ShadingContext};
use crate::color::{Channels, SpectralTable};
use crate::illumination::texture::{NumberTexture, TextureFootprint, Relief};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Most lobes of a material.
const MOST_LOBES: usize = 4;

/// What the patterns of a material give at a place, one after the other; a number is in all lanes.
pub type TextureValues = Vec<Channels>;

/// What patterns are mixed of at a place.
#[derive(Clone, Debug, Default)]
pub struct TextureMixture<'a> {
    /// How many patterns there are.
    count: usize,
    /// Which pattern it is, a color in it, and how much there is of it.
    parts: Vec<(usize, &'a SpectralTable, f64)>,
    /// Which pattern it is, and the number that it tells.
    numbers: Vec<(usize, f64)>,
}

impl TextureMixture<'_> {
    /// What the patterns give at the wavelengths of a comb.
    pub fn at(&self, comb: usize) -> TextureValues {
        let mut painting = vec![Channels::ZERO; self.count];
        for (pattern, curve, amount) in &self.parts {
            painting[*pattern] += curve.of(comb) * *amount;
        }
        for (pattern, number) in &self.numbers {
            painting[*pattern] = Channels::splat(*number);
        }
        painting
    }
}

/// One of the lobes of a surface.
///
/// The first two carry rays from the eye on. A way of light may be told by them: each of its turns is by a broad lobe or by a narrow one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LobeClass {
    /// Those that spread light so far that it is seen from about everywhere.
    Broad,
    /// Those that pass it on as a beam: mirrors, smooth interfaces, and rough ones of narrow highlights.
    Narrow,
    /// Those that spread light about everywhere, where a radiosity solution tells what comes from other surfaces: rays from
    /// the eye end at them, and light that is followed from lamps goes on.
    Radiosity,
    /// Those that answer lights only.
    LightsOnly,
}

/// What becomes of light that goes from one diffuse surface to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interreflection {
    /// It counts nothing.
    #[default]
    LeftOut,
    /// Rays from the eye follow it.
    Followed,
    /// A radiosity solution tells of it.
    Solved,
}

impl Interreflection {
    /// Lets it count, by rays from the eye unless it counts already.
    pub fn count(&mut self) {
        if *self == Interreflection::LeftOut {
            *self = Interreflection::Followed;
        }
    }
}

impl LobeClass {
    /// Those that carry rays from the eye on.
    pub const CONTINUING: [LobeClass; 2] = [LobeClass::Broad, LobeClass::Narrow];
}

/// Among which lobes a direction is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LobeSelection {
    /// All that carry rays from the eye on.
    All,
    /// Those whose directions are not all known: [`Optics::mirrored`] gives the others.
    NonDelta,
    /// The narrow ones.
    Narrow,
    /// The broad ones, solved or not.
    Broad,
}

impl LobeSelection {
    fn has(self, which: LobeClass, flags: Flags) -> bool {
        match self {
            LobeSelection::All => LobeClass::CONTINUING.contains(&which),
            LobeSelection::NonDelta => LobeClass::CONTINUING.contains(&which) && !flags.has(Flags::DELTA),
            LobeSelection::Narrow => which == LobeClass::Narrow,
            LobeSelection::Broad => matches!(which, LobeClass::Broad | LobeClass::Radiosity),
        }
    }
}

/// A lobe of a material.
#[derive(Clone, Debug)]
struct Member {
    which: LobeClass,
    /// What the lobe says of itself.
    flags: Flags,
    lobe: AnyLobe,
}

/// A material made ready for rendering.
#[derive(Clone, Debug)]
pub struct Bsdf {
    lobes: Vec<Member>,
    throws: bool,
    takes: bool,
    passes: bool,
    spreads: bool,
    /// What the ambient term reflects; none if it is what is reflected alike to everywhere.
    pub(super) ambient: Option<PreparedPaint>,
    /// What changes from place to place.
    pub(super) patterns: Vec<PreparedTexture>,
    pub(super) relief: Option<Relief>,
    /// The part of light that goes straight through; none if none does.
    pub(super) passing: Option<StraightTransmission>,
    /// Radiance that it emits; none if it does not.
    pub emission: Option<SpectralTable>,
    /// What is inside, where it is transparent.
    pub interior: Option<InteriorMedium>,
    /// The direction along which it is brushed.
    pub along: Option<DVec3>,
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
    fn of(&self, sighting: &ShadingContext) -> Channels {
        match self {
            StraightTransmission::Paint(shade) => shade.of(sighting),
            StraightTransmission::Pane(surface) => surface.straight_transmittance(sighting),
        }
    }
}

/// What is behind the surface of a transparent body.
#[derive(Clone, Debug)]
pub struct InteriorMedium {
    /// Its refractive index.
    pub index: SpectralTable,
    /// What it absorbs in a unit of length.
    pub absorption: SpectralTable,
    /// Whether the index differs with the wavelength.
    pub disperses: bool,
    /// Which of several bodies in one place is there: that of the greatest.
    pub priority: i32,
}

impl Bsdf {
    /// A material without lobes.
    ///
    /// - `ambient`: what the ambient term reflects. `emission`: radiance.
    pub(super) fn new(ambient: PreparedPaint, relief: Option<Relief>, emission: Option<SpectralTable>) -> Bsdf {
        Bsdf {
            lobes: Vec::new(),
            throws: false,
            takes: false,
            passes: false,
            spreads: false,
            ambient: Some(ambient),
            patterns: Vec::new(),
            relief,
            passing: None,
            emission,
            interior: None,
            along: None,
        }
    }

    /// Radiance towards the viewer for each unit of flux density that arrives from a light, 1/sr: D K / (N·V).
    ///
    /// Of directions that only a mirror or a smooth interface would reach nothing is known here.
    pub fn value(&self, which: LobeClass, sighting: &ShadingContext, light: DVec3) -> Channels {
        self.of_class(which).fold(Channels::ZERO, |sum, lobe| sum + lobe.value(sighting, light))
    }

    /// Radiance towards the viewer for each unit of flux density that arrives from a light, 1/sr, by the lobes that are
    /// `among`; nothing of what only a mirror or a smooth interface would reach.
    pub fn value_among(&self, among: LobeSelection, sighting: &ShadingContext, light: DVec3) -> Channels {
        let members = self.lobes.iter().filter(|member| among.has(member.which, member.flags));
        members.fold(Channels::ZERO, |sum, member| sum + member.lobe.value(sighting, light))
    }

    /// Radiance towards the viewer for each unit of flux density that arrives from a light, 1/sr, by all lobes; nothing of
    /// what only a mirror or a smooth interface would reach.
    #[inline]
    pub fn total_value(&self, sighting: &ShadingContext, light: DVec3) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.value(sighting, light))
    }

    /// The density with which [`Optics::onward`] draws a direction by broad or by narrow lobes, 1/sr.
    ///
    /// - `among`: as there.
    pub fn pdf(&self, which: LobeClass, sighting: &ShadingContext, light: DVec3, among: LobeSelection) -> f64 {
        let shares = self.shares(sighting, among);
        let members = self.lobes.iter().zip(&shares).filter(|(member, _)| member.which == which);
        members.map(|(member, share)| share * member.lobe.pdf(sighting, light)).sum()
    }

    /// The density with which [`Optics::onward`] draws a direction among lobes, 1/sr.
    pub fn pdf_among(&self, among: LobeSelection, sighting: &ShadingContext, light: DVec3) -> f64 {
        let members = self.lobes.iter().zip(self.shares(sighting, among)).filter(|(_, share)| *share > 0.0);
        members.map(|(member, share)| share * member.lobe.pdf(sighting, light)).sum()
    }

    /// The directions of mirrors and smooth interfaces, all of them.
    pub fn specular_samples(&self, sighting: &ShadingContext) -> impl Iterator<Item = BsdfSample> {
        let narrow = |member: &&Member| member.which == LobeClass::Narrow && member.flags.has(Flags::DELTA);
        let members = self.lobes.iter().filter(narrow);
        members.flat_map(|member| member.lobe.specular_samples(sighting)).flatten().filter(|onward| onward.weight.max() > 0.0)
    }

    /// What goes straight through, if anything does.
    pub fn straight_sample(&self, sighting: &ShadingContext) -> Option<BsdfSample> {
        let weight = self.passing.as_ref()?.of(sighting);
        Some(BsdfSample { light: -sighting.view, weight, density: None, is_straight: true, is_broad: false })
    }

    /// One direction, drawn about as what comes from there counts; none where what is drawn counts nothing.
    ///
    /// - `choice`: uniform in 0..1, chooses among lobes. `point`: uniform in the unit square.
    /// - `among`: which lobes it is drawn among.
    pub fn sample(&self, sighting: &ShadingContext, choice: f64, point: [f64; 2], among: LobeSelection) -> Option<BsdfSample> {
        let shares = self.shares(sighting, among);
        let (index, choice) = choose_share(&shares, choice)?;
        let Member { which, lobe, .. } = self.lobes.get(index)?;
        let drawn = lobe.sample(sighting, choice, point)?;
        if drawn.density.is_none() {
            return Some(BsdfSample { weight: drawn.weight * shares[index].recip(), ..drawn });
        }
        // What all lobes of the kind give there, over the density with which all of them draw it.
        let light = drawn.light;
        let (mut value, mut density) = (Channels::ZERO, 0.0);
        let is_broad = *which != LobeClass::Narrow;
        for (Member { which, lobe, .. }, share) in self.lobes.iter().zip(&shares).filter(|(_, share)| **share > 0.0) {
            if is_broad == (*which != LobeClass::Narrow) {
                value += lobe.value(sighting, light);
                density += share * lobe.pdf(sighting, light);
            }
        }
        let weight = value * (light.z.abs() / density);
        (density > 0.0 && weight.is_finite()).then_some(BsdfSample { weight, density: Some(density), is_broad, ..drawn })
    }

    /// What ambient light, the same radiance from everywhere, adds: its reflected fraction.
    pub fn ambient(&self, sighting: &ShadingContext) -> Channels {
        self.ambient.as_ref().map_or_else(|| self.diffuse_albedo(sighting), |ambient| ambient.of(sighting))
    }

    /// About what ambient light adds by what mirrors, metals, coats and glass reflect, where that is not followed.
    pub fn glossy_albedo(&self, sighting: &ShadingContext) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.glossy_albedo(sighting))
    }

    /// The part of light from all around that is reflected alike to everywhere: Lambert's term, and what a ground under a
    /// coat gives in the mean.
    pub fn diffuse_albedo(&self, sighting: &ShadingContext) -> Channels {
        self.lobes.iter().fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.diffuse_albedo(sighting))
    }

    /// About the part of light from all around that is reflected to the viewer, but for what a mirror or a smooth interface
    /// passes on.
    pub fn non_delta_albedo(&self, sighting: &ShadingContext) -> Channels {
        let spread = self.lobes.iter().filter(|member| !member.flags.has(Flags::DELTA));
        spread.fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.diffuse_albedo(sighting) + lobe.glossy_albedo(sighting))
    }

    /// Whether some light is reflected alike to everywhere.
    pub fn is_diffuse(&self) -> bool {
        self.lobes.iter().any(|member| member.flags.has(Flags::DIFFUSE))
    }

    /// Whether it changes from place to place.
    pub fn is_textured(&self) -> bool {
        !self.patterns.is_empty() || self.relief.is_some()
    }

    /// What its patterns are mixed of in the mean over a place, for any wavelengths.
    pub fn texture_mixture(&self, place: &TextureFootprint) -> TextureMixture<'_> {
        let mut mixture = TextureMixture { count: self.patterns.len(), ..TextureMixture::default() };
        for (index, pattern) in self.patterns.iter().enumerate() {
            match pattern {
                PreparedTexture::Paint(painted) => {
                    painted.each(place, 1.0, &mut |curve, amount| mixture.parts.push((index, curve, amount)));
                }
                PreparedTexture::Number(number) => mixture.numbers.push((index, number.at(place))),
            }
        }
        mixture
    }

    /// What its patterns give in the mean over a place.
    pub fn texture_values(&self, place: &TextureFootprint, comb: usize) -> TextureValues {
        self.patterns.iter().map(|pattern| pattern.at(place, comb)).collect()
    }

    /// The normal of an element, tilted by the relief.
    ///
    /// - `normal`: of the surface, unit length, outwards.
    pub fn tilted(&self, place: &TextureFootprint, normal: DVec3) -> DVec3 {
        self.relief.as_ref().map_or(normal, |relief| relief.normal(place, normal))
    }

    /// Whether light goes straight through.
    pub fn is_passable(&self) -> bool {
        self.passes
    }

    /// The part of light that goes straight through.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1. `place`: asked for only if a pattern has to be looked up.
    pub fn straight_transmittance(&self, comb: usize, cosine: f64, place: impl FnOnce() -> TextureFootprint) -> Channels {
        let Some(passing) = &self.passing else { return Channels::ZERO };
        let painted = if self.patterns.is_empty() { TextureValues::new() } else { self.texture_values(&place(), comb) };
        let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        passing.of(&ShadingContext { view, comb, side: InterfaceIndices::AIR, lane: 0, painted: &painted })
    }

    /// Whether it is a polished interface: what goes through has one direction.
    pub fn is_clear(&self) -> bool {
        let is_clear = |member: &Member| member.which == LobeClass::Narrow && member.flags.has(Flags::CLEAR);
        self.interior.is_some() && self.lobes.iter().any(is_clear)
    }

    /// The part of light that a polished interface lets through, as if it were not bent.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1. `place`: asked for only if a pattern has to be looked up.
    pub fn clear_transmittance(&self, comb: usize, cosine: f64, place: impl FnOnce() -> TextureFootprint) -> Channels {
        let Some(interior) = &self.interior else { return Channels::ZERO };
        let painted = if self.patterns.is_empty() { TextureValues::new() } else { self.texture_values(&place(), comb) };
        let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        let side = InterfaceIndices { behind: interior.index.of(comb), ..InterfaceIndices::AIR };
        let sighting = ShadingContext { view, comb, side, lane: 0, painted: &painted };
        self.of_class(LobeClass::Narrow).fold(Channels::ZERO, |sum, lobe| sum + lobe.clear_transmittance(&sighting))
    }

    /// Whether some lobe of a kind answers lights.
    pub fn has_non_delta(&self) -> bool {
        self.lobes.iter().any(|member| !member.flags.has(Flags::DELTA))
    }

    /// Whether rays are carried on.
    pub fn continues_paths(&self) -> bool {
        self.lobes.iter().any(|member| LobeClass::CONTINUING.contains(&member.which))
    }

    /// Whether some lobe passes light on as a beam, other than straight.
    pub fn casts_caustics(&self) -> bool {
        self.throws
    }

    /// Whether some lobe spreads the light that comes to it.
    pub fn stores_photons(&self) -> bool {
        self.takes
    }

    /// Radiance towards the viewer for each unit of flux density that arrives, 1/sr, of all lobes but the narrow ones.
    pub fn non_narrow_value(&self, sighting: &ShadingContext, light: DVec3) -> Channels {
        let spread = self.lobes.iter().filter(|member| member.which != LobeClass::Narrow);
        spread.fold(Channels::ZERO, |sum, Member { lobe, .. }| sum + lobe.value(sighting, light))
    }

    /// Radiance towards the viewer for each unit of flux density, 1/sr, of all lobes but the narrow ones, where it is one
    /// for all light from above; none where it is not.
    pub fn constant_value(&self, sighting: &ShadingContext) -> Option<Channels> {
        let mut spread = self.lobes.iter().filter(|member| member.which != LobeClass::Narrow);
        spread.try_fold(Channels::ZERO, |sum, Member { flags, lobe, .. }| {
            flags.has(Flags::EVEN).then(|| sum + lobe.value(sighting, DVec3::Z))
        })
    }

    /// Whether light that is followed from lamps goes on from it about everywhere.
    pub fn is_broad(&self) -> bool {
        let goes_on = |member: &Member| LobeSelection::Broad.has(member.which, member.flags) && !member.flags.has(Flags::BLACK);
        self.lobes.iter().any(goes_on)
    }

    /// Whether some lobe that carries rays on does so in more than single directions.
    pub fn continues_non_delta(&self) -> bool {
        self.spreads
    }

    /// Adds a lobe.
    ///
    /// - `carried`: how it carries on diffuse light, as far as it does.
    pub(super) fn add(&mut self, lobe: AnyLobe, carried: Interreflection) {
        let flags = lobe.flags();
        let which = match carried {
            Interreflection::LeftOut => LobeClass::LightsOnly,
            Interreflection::Solved if flags.has(Flags::DIFFUSE) => LobeClass::Radiosity,
            Interreflection::Solved => LobeClass::LightsOnly,
            Interreflection::Followed if flags.has(Flags::BROAD) => LobeClass::Broad,
            Interreflection::Followed => LobeClass::Narrow,
        };
        let is_black = flags.has(Flags::BLACK);
        let is_continued = LobeClass::CONTINUING.contains(&which);
        self.spreads |= is_continued && !flags.has(Flags::DELTA) && !is_black;
        match which {
            _ if is_black => {}
            LobeClass::Narrow if flags.has(Flags::STRAIGHT) => self.passes = true,
            LobeClass::Narrow if flags.has(Flags::PANE) => (self.passes, self.throws) = (true, true),
            LobeClass::Narrow => self.throws = true,
            LobeClass::Broad | LobeClass::Radiosity | LobeClass::LightsOnly => self.takes = true,
        }
        self.lobes.push(Member { which, flags, lobe });
    }

    /// Takes in a number that changes from place to place.
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

    fn of_class(&self, which: LobeClass) -> impl Iterator<Item = &AnyLobe> {
        self.lobes.iter().filter(move |member| member.which == which).map(|member| &member.lobe)
    }

    /// The chances of the lobes; they add up to 1, or are all 0.
    fn shares(&self, sighting: &ShadingContext, among: LobeSelection) -> [f64; MOST_LOBES] {
        let mut shares = [0.0; MOST_LOBES];
        for (share, Member { which, flags, lobe }) in shares.iter_mut().zip(&self.lobes) {
            *share = if among.has(*which, *flags) { lobe.strength(sighting) } else { 0.0 };
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
