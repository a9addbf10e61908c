//! Makes materials ready, and keeps what several of them share.

use super::coat::{Coat, Ground};
use super::facets::{Metallic, Shape};
use super::interface::{Rough, Smooth};
use super::lobe::Lobe;
use super::shade::{Painted, Shade};
use super::{Interior, Interreflection, Optics};
use crate::color::{LANES, Wavelengths};
use crate::illumination::distribution::{Compensated, Distribution, FAMILY, Facets, Microfacet, Phong};
use crate::illumination::fresnel::{Conductor, Dielectric, IndexError};
use crate::illumination::material::{
    Body, Classic, Coated, Finish, Form, Index, Material, MaterialError, Metal, Shaped, Transparent,
};
use crate::illumination::texture::Paint;
use glam::DVec2;
use std::sync::Arc;

/// Makes materials ready for the wavelengths that rays carry. Tables that take long are made once for all materials.
#[derive(Debug)]
pub struct Library<'a> {
    wavelengths: &'a Wavelengths,
    /// Whether lobes that reflect nothing are kept.
    everything: bool,
    /// By name and roughness.
    forms: Vec<(String, f64, Shape)>,
    /// By refractive index and roughness.
    coats: Vec<([f64; 2], Arc<Coat>)>,
}

impl<'a> Library<'a> {
    /// - `everything`: keeps lobes that reflect nothing, which changes no picture.
    pub fn new(wavelengths: &'a Wavelengths, everything: bool) -> Library<'a> {
        Library { wavelengths, everything, forms: Vec::new(), coats: Vec::new() }
    }

    /// A material, ready.
    ///
    /// - `diffuse`: what becomes of light that diffuse surfaces send each other.
    ///
    /// # Errors
    /// [`MaterialError`].
    pub fn optics(&mut self, material: &Material, diffuse: Interreflection) -> Result<Optics, MaterialError> {
        material.check()?;
        let mut optics = Optics {
            lobes: Vec::new(),
            throws: false,
            takes: false,
            passes: false,
            spreads: false,
            ambient: Shade::Plain(self.wavelengths.constant(0.0)),
            patterns: Vec::new(),
            relief: material.relief.clone(),
            emission: (!material.emission.is_black()).then(|| self.wavelengths.light(&material.emission)),
            interior: None,
            along: None,
            passing: None,
        };
        match &material.body {
            Body::Classic(classic) => self.classic(classic, diffuse, &mut optics)?,
            Body::Shaped(Shaped { reflectance, form }) => {
                let shape = match form {
                    Form::Member { name, roughness } => self.shape(name, *roughness)?,
                    Form::Table(table) => Shape::Once(Arc::new(table.clone())),
                    Form::Facets(table) => Shape::Once(Arc::new(table.clone())),
                };
                let distribution: Arc<dyn Distribution> = match shape {
                    Shape::Once(distribution) => distribution,
                    Shape::All(compensated) => compensated,
                };
                let fraction = self.shade(reflectance, &mut optics);
                optics.ambient = fraction.clone();
                optics.add(Lobe::Shaped(fraction, distribution), Interreflection::Followed);
            }
            Body::Metal(metal) => self.metal(metal, &mut optics)?,
            Body::Transparent(transparent) => self.transparent(transparent, &mut optics),
            Body::Coated(coated) => self.coated(coated, diffuse, &mut optics)?,
        }
        Ok(optics)
    }

    fn classic(&self, classic: &Classic, carried: Interreflection, optics: &mut Optics) -> Result<(), MaterialError> {
        if let Some(shade) = self.needed(&classic.diffuse, optics) {
            optics.ambient = shade.clone();
            optics.add(Lobe::Diffuse(shade), carried);
        }
        if let Some(shade) = self.needed(&classic.specular, optics) {
            optics.add(Lobe::Phong(shade, Phong::new(classic.exponent)?), carried);
        }
        if let Some(shade) = self.needed(&classic.mirror, optics) {
            optics.add(Lobe::Mirror(shade), Interreflection::Followed);
        }
        if let Some(shade) = self.needed(&classic.transparency, optics) {
            optics.passing = Some(shade.clone());
            optics.add(Lobe::Straight(shade), Interreflection::Followed);
        }
        Ok(())
    }

    fn metal(&mut self, Metal { n, k, finish }: &Metal, optics: &mut Optics) -> Result<(), MaterialError> {
        let conductor = |wavelength: f64| {
            let wavelength = if wavelength > 0.0 { wavelength } else { 550.0 };
            Conductor::new(1.0, n.at(wavelength), k.at(wavelength))
        };
        let lanes = |comb: usize| -> Result<[Conductor; LANES], IndexError> {
            let mut lanes = [conductor(550.0)?; LANES];
            for (lane, wavelength) in lanes.iter_mut().zip(self.wavelengths.at(comb)) {
                *lane = conductor(wavelength)?;
            }
            Ok(lanes)
        };
        let conductors = Arc::new((0..self.wavelengths.combs()).map(lanes).collect::<Result<Vec<_>, _>>()?);
        let lobe = match finish {
            Finish::Polished => Lobe::Polished(conductors),
            Finish::Rough { name, roughness } => {
                Lobe::Metallic(Metallic::new(self.shape(name, *roughness)?, conductors))
            }
            Finish::Brushed { roughness, along } => {
                optics.along = Some(*along);
                let form = Arc::new(Microfacet::new(Facets::Beckmann, *roughness)?);
                Lobe::Metallic(Metallic::new(Shape::Once(form), conductors))
            }
        };
        optics.add(lobe, Interreflection::Followed);
        Ok(())
    }

    fn transparent(&self, Transparent { index, roughness, absorption }: &Transparent, optics: &mut Optics) {
        optics.interior = Some(Interior {
            index: self.wavelengths.quantity(|wavelength| index.at(wavelength)),
            absorption: self.wavelengths.filter(absorption),
            disperses: matches!(index, Index::Dispersive(_)),
        });
        let lobe = if *roughness > 0.0 {
            Lobe::Rough(Rough { facets: Facets::Ggx, roughness: DVec2::splat(*roughness) })
        } else {
            Lobe::Smooth(Smooth)
        };
        optics.add(lobe, Interreflection::Followed);
    }

    fn coated(&mut self, coated: &Coated, carried: Interreflection, optics: &mut Optics) -> Result<(), MaterialError> {
        let coat = self.coat(coated.index, coated.roughness)?;
        optics.add(Lobe::Coat(coat.clone()), Interreflection::Followed);
        if let Some(shade) = self.needed(&coated.diffuse, optics) {
            let ground = Ground::new(coat, coated.index, &shade, self.wavelengths.combs());
            optics.add(Lobe::Ground(ground), carried);
            optics.ambient = shade;
        }
        Ok(())
    }

    /// A coat of a refractive index and a roughness.
    fn coat(&mut self, index: f64, roughness: f64) -> Result<Arc<Coat>, MaterialError> {
        let key = [index, roughness];
        if let Some((_, coat)) = self.coats.iter().find(|(other, _)| *other == key) {
            return Ok(coat.clone());
        }
        let facets = match roughness {
            0.0 => None,
            roughness => Some(Microfacet::new(Facets::Ggx, DVec2::splat(roughness))?),
        };
        let coat = Arc::new(Coat::new(Dielectric::new(1.0, index)?, facets));
        self.coats.push((key, coat.clone()));
        Ok(coat)
    }

    /// A fraction of light; its pattern goes to the others of the material.
    fn shade(&self, paint: &Paint, optics: &mut Optics) -> Shade {
        match paint {
            Paint::Plain(color) => Shade::Plain(self.wavelengths.reflectance(color)),
            Paint::Pattern(pattern) => {
                optics.patterns.push(Painted::new(pattern, self.wavelengths));
                Shade::Painted(optics.patterns.len() - 1)
            }
        }
    }

    /// A fraction of light; none if it is 0 and may be left out.
    fn needed(&self, paint: &Paint, optics: &mut Optics) -> Option<Shade> {
        match paint {
            Paint::Plain(color) if !self.everything && self.wavelengths.reflectance(color).max() <= 0.0 => None,
            Paint::Pattern(_) if !self.everything && paint.is_black() => None,
            _ => Some(self.shade(paint, optics)),
        }
    }

    /// A member of the family.
    fn shape(&mut self, name: &str, roughness: f64) -> Result<Shape, MaterialError> {
        if let Some((.., shape)) = self.forms.iter().find(|(n, m, _)| n == name && *m == roughness) {
            return Ok(shape.clone());
        }
        let all = |facets: Facets| Ok::<_, MaterialError>(Shape::All(Arc::new(Compensated::new(facets, roughness)?)));
        let shape = match FAMILY.iter().find(|row| row.name == name) {
            Some(row) if row.name == "Beckmann, all" => all(Facets::Beckmann)?,
            Some(row) if row.name == "GGX, all" => all(Facets::Ggx)?,
            Some(row) => Shape::Once(Arc::from((row.make)(roughness)?)),
            None => return Err(MaterialError::Unknown { name: name.into(), known: String::new() }),
        };
        self.forms.push((name.into(), roughness, shape.clone()));
        Ok(shape)
    }
}
