//! Makes materials ready, and keeps what several of them share.

use super::coat::{Coat, Ground};
use super::facets::{Metallic, Shape};
use super::interface::{Rough, Smooth};
use super::lobe::Lobe;
use super::{Interior, Optics, Which};
use crate::color::{Color, LANES, Wavelengths};
use crate::illumination::distribution::{Compensated, Distribution, FAMILY, Facets, Microfacet, Phong};
use crate::illumination::fresnel::{Conductor, Dielectric, IndexError};
use crate::illumination::material::{
    Body, Classic, Coated, Finish, Form, Index, Material, MaterialError, Metal, Shaped, Transparent,
};
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
}

impl<'a> Library<'a> {
    /// - `everything`: keeps lobes that reflect nothing, which changes no picture.
    pub fn new(wavelengths: &'a Wavelengths, everything: bool) -> Library<'a> {
        Library { wavelengths, everything, forms: Vec::new() }
    }

    /// A material, ready.
    ///
    /// - `spreads`: whether diffuse light is carried on, and not only light from lights.
    ///
    /// # Errors
    /// [`MaterialError`].
    pub fn optics(&mut self, material: &Material, spreads: bool) -> Result<Optics, MaterialError> {
        material.check()?;
        let diffuse = if spreads { Which::Continued } else { Which::Ended };
        let mut optics = Optics {
            lobes: Vec::new(),
            ambient: self.wavelengths.constant(0.0),
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
                };
                let distribution: Arc<dyn Distribution> = match shape {
                    Shape::Once(distribution) => distribution,
                    Shape::All(compensated) => compensated,
                };
                let fraction = self.wavelengths.reflectance(reflectance);
                optics.ambient = fraction.clone();
                optics.lobes.push((Which::Continued, Lobe::Shaped(fraction, distribution)));
            }
            Body::Metal(metal) => self.metal(metal, &mut optics)?,
            Body::Transparent(transparent) => self.transparent(transparent, &mut optics),
            Body::Coated(coated) => self.coated(coated, diffuse, &mut optics)?,
        }
        Ok(optics)
    }

    fn classic(&self, classic: &Classic, diffuse: Which, optics: &mut Optics) -> Result<(), MaterialError> {
        let fraction = |color: &Color| {
            let curve = self.wavelengths.reflectance(color);
            (self.everything || curve.max() > 0.0).then_some(curve)
        };
        if let Some(curve) = fraction(&classic.diffuse) {
            optics.ambient = curve.clone();
            optics.lobes.push((diffuse, Lobe::Diffuse(curve)));
        }
        if let Some(curve) = fraction(&classic.specular) {
            optics.lobes.push((diffuse, Lobe::Phong(curve, Phong::new(classic.exponent)?)));
        }
        if let Some(curve) = fraction(&classic.mirror) {
            optics.lobes.push((Which::Continued, Lobe::Mirror(curve)));
        }
        if let Some(curve) = fraction(&classic.transparency) {
            optics.passing = Some(curve.clone());
            optics.lobes.push((Which::Continued, Lobe::Straight(curve)));
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
        optics.lobes.push((Which::Continued, lobe));
        Ok(())
    }

    fn transparent(&self, Transparent { index, roughness, absorption }: &Transparent, optics: &mut Optics) {
        optics.interior = Some(Interior {
            index: self.wavelengths.quantity(|wavelength| index.at(wavelength)),
            absorption: self.wavelengths.reflectance(absorption),
            disperses: matches!(index, Index::Dispersive(_)),
        });
        let lobe = if *roughness > 0.0 {
            Lobe::Rough(Rough { facets: Facets::Ggx, roughness: DVec2::splat(*roughness) })
        } else {
            Lobe::Smooth(Smooth)
        };
        optics.lobes.push((Which::Continued, lobe));
    }

    fn coated(&self, coated: &Coated, diffuse: Which, optics: &mut Optics) -> Result<(), MaterialError> {
        let surface = Dielectric::new(1.0, coated.index)?;
        let facets = match coated.roughness {
            0.0 => None,
            roughness => Some(Microfacet::new(Facets::Ggx, DVec2::splat(roughness))?),
        };
        let coat = Arc::new(Coat::new(surface, facets));
        optics.lobes.push((Which::Continued, Lobe::Coat(coat.clone())));
        let fraction = self.wavelengths.reflectance(&coated.diffuse);
        if self.everything || fraction.max() > 0.0 {
            let ground = Ground::new(coat, coated.index, |comb| fraction.of(comb), self.wavelengths.combs());
            optics.lobes.push((diffuse, Lobe::Ground(ground)));
            optics.ambient = fraction;
        }
        Ok(())
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
