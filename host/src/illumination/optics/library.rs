//! Makes materials ready, and keeps what several of them share.

use super::bsdf::{Interior, Interreflection, Optics, Passing};
use super::coat::{Coat, Ground};
use super::diffuse::Diffuse;
use super::facets::{Metallic, Shape};
use super::interface::{Rough, Smooth};
use super::lobes::AnyLobe;
use super::mirror::Mirror;
use super::polished::Polished;
use super::principled::{Make, Part, PrincipledLobe, Surface};
use super::shade::{Changing, Painted, Quantity, Shade};
use super::shaped::Shaped as ShapedLobe;
use super::straight::Straight;
use super::varied::nodes;
use crate::color::{LANES, Wavelengths};
use crate::illumination::distribution::{Compensated, Distribution, FAMILY, Facets, Microfacet, Phong};
use crate::illumination::fresnel::{Conductor, Dielectric, IndexError};
use crate::illumination::material::{
    Body, Classic, Coated, Finish, Form, Index, LEAST_VARYING_ROUGHNESS, Material, MaterialError, Metal, Principled,
    Shaped, Transparent,
};
use crate::illumination::texture::{Number, Paint};
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
        let emission = (!material.emission.is_black()).then(|| self.wavelengths.light(&material.emission));
        let black = Shade::Plain(self.wavelengths.constant(0.0));
        let mut optics = Optics::new(black, material.relief.clone(), emission);
        match &material.body {
            Body::Classic(classic) => self.classic(classic, diffuse, &mut optics)?,
            Body::Shaped(Shaped { reflectance, form }) => {
                let fraction = self.shade(reflectance, &mut optics);
                optics.ambient = Some(fraction.clone());
                let lobe = match form {
                    Form::Member { name, roughness } => self.rough(roughness, &mut optics, |library, m| {
                        let distribution: Arc<dyn Distribution> = match library.shape(name, m)? {
                            Shape::Once(distribution) => distribution,
                            Shape::All(compensated) => compensated,
                        };
                        Ok(AnyLobe::Shaped(ShapedLobe { fraction: fraction.clone(), form: distribution }))
                    })?,
                    Form::Table(table) => AnyLobe::Shaped(ShapedLobe { fraction, form: Arc::new(table.clone()) }),
                    Form::Facets(table) => AnyLobe::Shaped(ShapedLobe { fraction, form: Arc::new(table.clone()) }),
                };
                optics.add(lobe, Interreflection::Followed);
            }
            Body::Metal(metal) => self.metal(metal, &mut optics)?,
            Body::Transparent(transparent) => self.transparent(transparent, &mut optics)?,
            Body::Coated(coated) => self.coated(coated, diffuse, &mut optics)?,
            Body::Principled(principled) => self.principled(principled, diffuse, &mut optics)?,
        }
        Ok(optics)
    }

    fn classic(
        &mut self,
        classic: &Classic,
        carried: Interreflection,
        optics: &mut Optics,
    ) -> Result<(), MaterialError> {
        if let Some(shade) = self.needed(&classic.diffuse, optics) {
            optics.ambient = Some(shade.clone());
            optics.add(AnyLobe::Diffuse(Diffuse(shade)), carried);
        }
        if let Some(shade) = self.needed(&classic.specular, optics) {
            let made = |_: &mut Library<'a>, n| {
                Ok(AnyLobe::Phong(ShapedLobe { fraction: shade.clone(), form: Phong::new(n)? }))
            };
            let lobe = self.varied(&classic.exponent, 1.0, optics, made)?;
            optics.add(lobe, carried);
        }
        if let Some(shade) = self.needed(&classic.mirror, optics) {
            optics.add(AnyLobe::Mirror(Mirror(shade)), Interreflection::Followed);
        }
        if let Some(shade) = self.needed(&classic.transparency, optics) {
            optics.passing = Some(Passing::Shade(shade.clone()));
            optics.add(AnyLobe::Straight(Straight(shade)), Interreflection::Followed);
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
            Finish::Polished => AnyLobe::Polished(Polished { conductors }),
            Finish::Rough { name, roughness } => self.rough(roughness, optics, |library, m| {
                Ok(AnyLobe::Metallic(Metallic::new(library.shape(name, m)?, conductors.clone())))
            })?,
            Finish::Brushed { roughness: [along, across], along: direction } => {
                optics.along = Some(*direction);
                // Where both vary, each node of the one is a lobe that varies by the other.
                let across_at = across.is_varying().then(|| optics.varying(across));
                let across_nodes = nodes(across, LEAST_VARYING_ROUGHNESS);
                self.rough(along, optics, |_, along| {
                    let brushed = |across: f64| -> Result<AnyLobe, MaterialError> {
                        let form = Arc::new(Microfacet::new(Facets::Beckmann, DVec2::new(along, across))?);
                        Ok(AnyLobe::Metallic(Metallic::new(Shape::Once(form), conductors.clone())))
                    };
                    match (across_at, across) {
                        (None, across) => brushed(across.mean()),
                        (Some(quantity), _) => {
                            let lobes = across_nodes.iter().map(|m| Ok((*m, brushed(*m)?)));
                            Ok(AnyLobe::varied(quantity, lobes.collect::<Result<_, MaterialError>>()?))
                        }
                    }
                })?
            }
        };
        optics.add(lobe, Interreflection::Followed);
        Ok(())
    }

    fn transparent(&mut self, transparent: &Transparent, optics: &mut Optics) -> Result<(), MaterialError> {
        let Transparent { index, roughness, absorption, priority } = transparent;
        optics.interior = Some(Interior {
            index: self.wavelengths.quantity(|wavelength| index.at(wavelength)),
            absorption: self.wavelengths.filter(absorption),
            disperses: matches!(index, Index::Dispersive(_)),
            priority: *priority,
        });
        let lobe = self.rough(roughness, optics, |_, m| match m {
            0.0 => Ok(AnyLobe::Smooth(Smooth)),
            m => Ok(AnyLobe::Rough(Rough { facets: Facets::Ggx, roughness: DVec2::splat(m) })),
        })?;
        optics.add(lobe, Interreflection::Followed);
        Ok(())
    }

    fn coated(&mut self, coated: &Coated, carried: Interreflection, optics: &mut Optics) -> Result<(), MaterialError> {
        let Coated { diffuse, index, roughness } = coated;
        let coat = self.rough(roughness, optics, |library, m| Ok(AnyLobe::Coat(library.coat(*index, m)?)))?;
        optics.add(coat, Interreflection::Followed);
        if let Some(shade) = self.needed(diffuse, optics) {
            let combs = self.wavelengths.combs();
            let ground = self.rough(roughness, optics, |library, m| {
                Ok(AnyLobe::Ground(Ground::new(library.coat(*index, m)?, *index, &shade, combs)))
            })?;
            optics.add(ground, carried);
            optics.ambient = Some(shade);
        }
        Ok(())
    }

    fn principled(
        &mut self,
        principled: &Principled,
        carried: Interreflection,
        optics: &mut Optics,
    ) -> Result<(), MaterialError> {
        let Principled { index, coat_index, thin, .. } = *principled;
        let none = Number::Constant(0.0);
        let (has_coat, transmits) = (principled.coat != none, principled.transmission != none);
        if transmits && !thin {
            optics.interior = Some(Interior {
                index: self.wavelengths.constant(index),
                absorption: self.wavelengths.filter(&principled.absorption),
                disperses: false,
                priority: principled.priority,
            });
        }
        let colors = [&principled.base_color, &principled.sheen].map(|paint| self.shade(paint, optics));
        let Principled { metallic, specular, transmission, coat, sheen_roughness, .. } = principled;
        let numbers = [metallic, specular, transmission, coat, sheen_roughness].map(|number| optics.quantity(number));
        // Facets of the slope m, the square of the roughness; what varies has a row of them.
        let slopes = |roughness: &Number| match roughness {
            Number::Constant(0.0) => vec![(0.0, None)],
            Number::Constant(roughness) => vec![(*roughness, Some(roughness * roughness))],
            varying => nodes(varying, LEAST_VARYING_ROUGHNESS.sqrt()).into_iter().map(|r| (r, Some(r * r))).collect(),
        };
        let coats = if has_coat { slopes(&principled.coat_roughness) } else { vec![(0.0, None)] };
        let along = optics.quantity(&principled.roughness);
        let across = if has_coat { optics.quantity(&principled.coat_roughness) } else { Quantity::Constant(0.0) };
        let surface = |roughness: Option<f64>, coat_roughness: Option<f64>| {
            let make = Make { index, coat_index, roughness, coat_roughness, thin, has_coat, transmits };
            Surface::new(&make, colors.clone(), numbers).map(Arc::new)
        };
        let row = |slope| -> Result<Vec<(f64, Arc<Surface>)>, MaterialError> {
            coats.iter().map(|(roughness, coat)| Ok((*roughness, surface(slope, *coat)?))).collect()
        };
        let rows = slopes(&principled.roughness).into_iter().map(|(roughness, slope)| Ok((roughness, row(slope)?)));
        let rows = rows.collect::<Result<Vec<_>, MaterialError>>()?;
        let lobe = |part: Part| {
            let of_row = |(r, row): &(f64, Vec<(f64, Arc<Surface>)>)| {
                let lobes = row
                    .iter()
                    .map(|(r, surface)| (*r, AnyLobe::Principled(PrincipledLobe { part, surface: surface.clone() })));
                (*r, AnyLobe::varied(across, lobes.collect()))
            };
            AnyLobe::varied(along, rows.iter().map(of_row).collect())
        };
        if thin && let Some(surface) = rows.first().and_then(|(_, row)| row.first()).filter(|(_, s)| s.is_pane()) {
            optics.passing = Some(Passing::Pane(surface.1.clone()));
        }
        if !principled.sheen.is_black() {
            optics.add(lobe(Part::Sheen), Interreflection::Followed);
        }
        if has_coat {
            optics.add(lobe(Part::Coat), Interreflection::Followed);
        }
        if *metallic != none || *specular != none || transmits {
            optics.add(lobe(Part::Facets), Interreflection::Followed);
        }
        optics.add(lobe(Part::Spread), if transmits { Interreflection::Followed } else { carried });
        optics.ambient = None;
        Ok(())
    }

    /// A lobe of a roughness, which may change from place to place.
    fn rough(
        &mut self,
        roughness: &Number,
        optics: &mut Optics,
        made: impl FnMut(&mut Library<'a>, f64) -> Result<AnyLobe, MaterialError>,
    ) -> Result<AnyLobe, MaterialError> {
        self.varied(roughness, LEAST_VARYING_ROUGHNESS, optics, made)
    }

    /// A lobe of a number, which may change from place to place.
    ///
    /// - `least`: the least that is told apart where it changes. `made`: the lobe of a value.
    fn varied(
        &mut self,
        number: &Number,
        least: f64,
        optics: &mut Optics,
        mut made: impl FnMut(&mut Library<'a>, f64) -> Result<AnyLobe, MaterialError>,
    ) -> Result<AnyLobe, MaterialError> {
        if let Number::Constant(value) = number {
            return made(self, *value);
        }
        let lobes = nodes(number, least).into_iter().map(|value| Ok((value, made(self, value)?)));
        let lobes = lobes.collect::<Result<_, MaterialError>>()?;
        Ok(AnyLobe::varied(optics.varying(number), lobes))
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
                optics.patterns.push(Changing::Paint(Painted::new(pattern, self.wavelengths)));
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
            None => return Err(MaterialError::Unknown { name: name.into(), advice: String::new() }),
        };
        self.forms.push((name.into(), roughness, shape.clone()));
        Ok(shape)
    }
}
