//! The principled material: metal, opaque ground and transparent body in any mixture.

use super::{Classic, MaterialError, MaterialPreview, fraction, normal_reflectance, power, priority};
use crate::color::Color;
use crate::illumination::distribution::checked_roughness;
use crate::illumination::fresnel::Dielectric;
use crate::illumination::texture::{NumberTexture, Paint};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The principled material: a metal, an opaque ground under a clear surface, and a transparent body, in any mixture,
/// under a coat and with a sheen.
///
/// A white one reflects and lets through all of the light that it gets, whatever the other numbers are.
///
/// # Source
/// The parameters are those of Burley 2012 and 2015, as OpenPBR 2024 has them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Principled {
    /// Reflectance of a metal at right angles, diffuse reflectance of an opaque ground, and transmittance of a
    /// transparent body for light that comes in and goes out; 0..=1.
    pub base_color: Paint,
    /// The part that is a metal, 0..=1.
    pub metallic: NumberTexture,
    /// 0..=1: the slope m of its facets is the square of it; 0 is polished.
    pub roughness: NumberTexture,
    /// How much of its reflection the clear surface of an opaque ground has, 0..=1.
    pub specular: NumberTexture,
    /// Refractive index of the clear surface, and of the transparent body, 1e-6..=1e6.
    pub index: f64,
    /// The part of what is no metal that is transparent, 0..=1.
    pub transmission: NumberTexture,
    /// Whether the body is a thin wall: light goes through it and is not bent.
    pub thin: bool,
    /// Absorption inside of a transparent body, in one unit of length of the scene.
    pub absorption: Color,
    /// Priority among transparent bodies in one place: that of the greatest is there.
    pub priority: i32,
    /// The part that has a coat, 0..=1.
    pub coat: NumberTexture,
    /// Roughness of the coat, as that of the surface.
    pub coat_roughness: NumberTexture,
    /// Refractive index of the coat, 1e-6..=1e6.
    pub coat_index: f64,
    /// The part of what is not transparent that is a cloth, by the color of its rim, 0..=1.
    pub sheen: Paint,
    /// How wide the rim is, 0..=1.
    pub sheen_roughness: NumberTexture,
}

impl Default for Principled {
    fn default() -> Principled {
        let [metallic, transmission, coat] = [0.0; 3].map(NumberTexture::Constant);
        Principled {
            base_color: Paint::grey(0.8),
            metallic,
            roughness: 0.5.into(),
            specular: 1.0.into(),
            index: 1.5,
            transmission,
            thin: false,
            absorption: Color::BLACK,
            priority: 0,
            coat,
            coat_roughness: 0.0.into(),
            coat_index: 1.5,
            sheen: Paint::grey(0.0),
            sheen_roughness: 0.3.into(),
        }
    }
}

impl Principled {
    /// Whether light may go through it.
    pub fn transmits(&self) -> bool {
        self.transmission != NumberTexture::Constant(0.0)
    }

    /// Whether some of it is diffuse: no whole metal, and not all of it transparent.
    pub fn is_diffuse(&self) -> bool {
        let whole = NumberTexture::Constant(1.0);
        self.metallic != whole && self.transmission != whole && !self.base_color.is_black() || !self.sheen.is_black()
    }

    pub(super) fn check(&self) -> Result<(), MaterialError> {
        fraction("base color", &self.base_color)?;
        fraction("sheen", &self.sheen)?;
        for (what, number) in [
            ("metallic", &self.metallic),
            ("roughness", &self.roughness),
            ("specular", &self.specular),
            ("transmission", &self.transmission),
            ("coat", &self.coat),
            ("roughness of the coat", &self.coat_roughness),
            ("roughness of the sheen", &self.sheen_roughness),
        ] {
            number.check()?;
            let [least, most] = number.range();
            if !(least >= 0.0 && most <= 1.0) {
                return Err(MaterialError::Fraction { what, least, most });
            }
        }
        for roughness in [&self.roughness, &self.coat_roughness] {
            if let NumberTexture::Constant(roughness) = roughness
                && *roughness != 0.0
            {
                checked_roughness(roughness * roughness)?;
            }
        }
        power("absorption", &self.absorption)?;
        priority(self.priority)?;
        for index in [self.index, self.coat_index] {
            Dielectric::new(1.0, index)?;
        }
        Ok(())
    }

    pub(super) fn preview(&self, variation: Option<u16>) -> MaterialPreview {
        let base = self.base_color.mean_bands_of(variation).clamp(DVec3::ZERO, DVec3::ONE);
        let [metallic, transmission, specular] =
            [&self.metallic, &self.transmission, &self.specular].map(NumberTexture::mean);
        let opaque = (1.0 - metallic) * (1.0 - transmission);
        let clear = (1.0 - metallic) * (transmission + (1.0 - transmission) * specular);
        let reflected = base * metallic + DVec3::splat(clear * normal_reflectance(self.index));
        let coat = DVec3::splat(self.coat.mean() * normal_reflectance(self.coat_index));
        let diffuse = base * opaque;
        let shine = |roughness: f64| (2.0 / roughness.max(0.03).powi(4) - 2.0).clamp(1.0, Classic::MOST_EXPONENT);
        match self.roughness.mean() {
            0.0 => MaterialPreview {
                diffuse,
                specular: coat,
                exponent: shine(self.coat_roughness.mean()),
                mirror: reflected,
            },
            roughness => MaterialPreview { diffuse, specular: reflected, exponent: shine(roughness), mirror: coat },
        }
    }
}
