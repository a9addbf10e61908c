//! Prepares materials for rendering as BSDFs, and keeps what several of them share.

use super::bsdf::{Bsdf, InteriorMedium, Interreflection, StraightTransmission};
use super::coat::{CoatReflection, CoatedDiffuse};
use super::dielectric::SmoothDielectric;
use super::diffuse::DiffuseLobe;
use super::distributed::DistributedLobe as ShapedLobe;
use super::lobes::AnyLobe;
use super::mirror::MirrorLobe;
use super::prepared_textures::{PreparedNumber, PreparedPaint, PreparedPattern, PreparedTexture};
use super::principled::{PrincipledLobe, PrincipledParameters, PrincipledPart, PrincipledSurface};
use super::rough_conductor::{FacetDistribution, RoughConductor};
use super::rough_dielectric::RoughDielectric;
use super::smooth_conductor::SmoothConductor;
use super::straight::StraightLobe;
use super::translucent::TranslucentLobe;
use super::varied::nodes;
use crate::color::{LANES, WavelengthSets};
use crate::illumination::distribution::{
    Compensated, Distribution, FAMILY, FacetForm, FacetModel, Microfacet, NormalisedPhong, RoughFacets,
    SlopeDistribution,
};
use crate::illumination::fresnel::{Conductor, Dielectric, IndexError};
use crate::illumination::material::{
    Classic, Coated, Distributed, DistributionForm, Finish, LEAST_VARYING_ROUGHNESS, Material, MaterialError,
    MaterialKind, Metal, Principled, RefractiveIndex, Translucent, Transparent,
};
use crate::illumination::texture::{NumberTexture, Paint};
use glam::DVec2;
use std::sync::Arc;

/// Prepares materials for the wavelengths that rays carry. Tables that take long are made once for all materials.
#[derive(Debug)]
pub struct BsdfBuilder<'a> {
    wavelengths: &'a WavelengthSets,
    /// Whether lobes that reflect nothing are kept.
    everything: bool,
    /// By name and roughness.
    forms: Vec<(String, f64, FacetDistribution)>,
    /// By refractive index and roughness.
    coats: Vec<([f64; 2], Arc<CoatReflection>)>,
}

impl<'a> BsdfBuilder<'a> {
    /// - `everything`: keeps lobes that reflect nothing, which changes no picture.
    pub fn new(wavelengths: &'a WavelengthSets, everything: bool) -> BsdfBuilder<'a> {
        BsdfBuilder { wavelengths, everything, forms: Vec::new(), coats: Vec::new() }
    }

    /// A material, prepared.
    ///
    /// - `diffuse`: how diffuse interreflection is found.
    ///
    /// # Errors
    /// [`MaterialError`].
    pub fn bsdf(&mut self, material: &Material, diffuse: Interreflection) -> Result<Bsdf, MaterialError> {
        material.check()?;
        let emission = (!material.emission.is_black()).then(|| self.wavelengths.light(&material.emission));
        let black = PreparedPaint::Plain(self.wavelengths.constant(0.0));
        let mut bsdf = Bsdf::new(black, material.relief.clone(), emission);
        match &material.body {
            MaterialKind::Classic(classic) => self.classic(classic, diffuse, &mut bsdf)?,
            MaterialKind::Shaped(Distributed { reflectance, form }) => {
                let fraction = self.prepared_paint(reflectance, &mut bsdf);
                bsdf.ambient = Some(fraction.clone());
                let lobe = match form {
                    DistributionForm::Member { name, roughness } => {
                        self.rough(roughness, &mut bsdf, |library, m| {
                            let distribution: Arc<dyn Distribution> = match library.facet_distribution(name, m)? {
                                FacetDistribution::SingleScattering(distribution) => distribution,
                                FacetDistribution::MultipleScattering(compensated) => compensated,
                            };
                            Ok(AnyLobe::Shaped(ShapedLobe { fraction: fraction.clone(), distribution }))
                        })?
                    }
                    DistributionForm::Table(table) => {
                        AnyLobe::Shaped(ShapedLobe { fraction, distribution: Arc::new(table.clone()) })
                    }
                    DistributionForm::Facets(table) => {
                        AnyLobe::Shaped(ShapedLobe { fraction, distribution: Arc::new(table.clone()) })
                    }
                };
                bsdf.add(lobe, Interreflection::Followed);
            }
            MaterialKind::Metal(metal) => self.metal(metal, &mut bsdf)?,
            MaterialKind::Transparent(transparent) => self.transparent(transparent, &mut bsdf)?,
            MaterialKind::Coated(coated) => self.coated(coated, diffuse, &mut bsdf)?,
            MaterialKind::Principled(principled) => self.principled(principled, diffuse, &mut bsdf)?,
            MaterialKind::Translucent(translucent) => self.translucent(translucent, diffuse, &mut bsdf)?,
        }
        Ok(bsdf)
    }

    fn classic(
        &mut self,
        classic: &Classic,
        interreflection: Interreflection,
        bsdf: &mut Bsdf,
    ) -> Result<(), MaterialError> {
        if let Some(shade) = self.needed_paint(&classic.diffuse, bsdf) {
            bsdf.ambient = Some(shade.clone());
            bsdf.add(AnyLobe::Diffuse(DiffuseLobe(shade)), interreflection);
        }
        if let Some(shade) = self.needed_paint(&classic.specular, bsdf) {
            let made = |_: &mut BsdfBuilder<'a>, n| {
                Ok(AnyLobe::Phong(ShapedLobe { fraction: shade.clone(), distribution: NormalisedPhong::new(n)? }))
            };
            let lobe = self.varied(&classic.exponent, 1.0, bsdf, made)?;
            bsdf.add(lobe, interreflection);
        }
        if let Some(shade) = self.needed_paint(&classic.mirror, bsdf) {
            bsdf.add(AnyLobe::Mirror(MirrorLobe(shade)), Interreflection::Followed);
        }
        if let Some(shade) = self.needed_paint(&classic.transparency, bsdf) {
            bsdf.straight_transmission = Some(StraightTransmission::Paint(shade.clone()));
            bsdf.add(AnyLobe::Straight(StraightLobe(shade)), Interreflection::Followed);
        }
        Ok(())
    }

    fn metal(&mut self, Metal { n, k, finish }: &Metal, bsdf: &mut Bsdf) -> Result<(), MaterialError> {
        let conductor = |wavelength: f64| {
            let wavelength = if wavelength > 0.0 { wavelength } else { 550.0 };
            Conductor::new(1.0, n.at(wavelength), k.at(wavelength))
        };
        let lanes = |wavelength_set: usize| -> Result<[Conductor; LANES], IndexError> {
            let mut lanes = [conductor(550.0)?; LANES];
            for (lane, wavelength) in lanes.iter_mut().zip(self.wavelengths.at(wavelength_set)) {
                *lane = conductor(wavelength)?;
            }
            Ok(lanes)
        };
        let conductors = Arc::new((0..self.wavelengths.count()).map(lanes).collect::<Result<Vec<_>, _>>()?);
        let lobe = match finish {
            Finish::Polished => AnyLobe::Polished(SmoothConductor { conductors }),
            Finish::Rough { name, roughness } => self.rough(roughness, bsdf, |library, m| {
                Ok(AnyLobe::Metallic(RoughConductor::new(library.facet_distribution(name, m)?, conductors.clone())))
            })?,
            Finish::Facets(table) => {
                let facets = FacetDistribution::MultipleScattering(Arc::new(Compensated::of_table(table.clone())));
                AnyLobe::Metallic(RoughConductor::new(facets, conductors))
            }
            Finish::Brushed { name, roughness: [along, across], along: direction } => {
                bsdf.brushed_along = Some(*direction);
                let slopes = FacetModel::named(name).map_or(SlopeDistribution::Ggx, |model| model.slopes);
                // Where both vary, each node of the one is a lobe that varies by the other.
                let across_at = across.is_varying().then(|| bsdf.varying(across));
                let across_nodes = nodes(across, LEAST_VARYING_ROUGHNESS);
                self.rough(along, bsdf, |_, along| {
                    let brushed = |across: f64| -> Result<AnyLobe, MaterialError> {
                        let form = Arc::new(Microfacet::new(slopes, DVec2::new(along, across))?);
                        Ok(AnyLobe::Metallic(RoughConductor::new(
                            FacetDistribution::SingleScattering(form),
                            conductors.clone(),
                        )))
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
        bsdf.add(lobe, Interreflection::Followed);
        Ok(())
    }

    fn transparent(&mut self, transparent: &Transparent, bsdf: &mut Bsdf) -> Result<(), MaterialError> {
        let Transparent { index, roughness, facets, absorption, priority } = transparent;
        bsdf.interior = Some(InteriorMedium {
            index: self.wavelengths.quantity(|wavelength| index.at(wavelength)),
            absorption: self.wavelengths.filter(absorption),
            disperses: matches!(index, RefractiveIndex::Dispersive(_)),
            priority: *priority,
        });
        let wavelengths = self.wavelengths;
        let indices =
            (0..wavelengths.count()).flat_map(|set| wavelengths.at(set)).map(|wavelength| index.at(wavelength));
        let lobe = match facets {
            FacetForm::Table(table) => {
                let facets = RoughFacets::Table(Arc::new(table.clone()));
                AnyLobe::Rough(RoughDielectric::new(facets, true, true).prepared(indices))
            }
            FacetForm::Model(name) => self.rough(roughness, bsdf, |_, m| {
                let model = FacetModel::named(name).filter(|_| m > 0.0);
                let Some(model) = model else { return Ok(AnyLobe::Smooth(SmoothDielectric)) };
                let facets = RoughFacets::Slopes(model.slopes, DVec2::splat(m));
                let lobe = RoughDielectric::new(facets, model.is_correlated, model.is_multiple);
                Ok(AnyLobe::Rough(if roughness.is_varying() { lobe } else { lobe.prepared(indices.clone()) }))
            })?,
        };
        bsdf.add(lobe, Interreflection::Followed);
        Ok(())
    }

    fn coated(
        &mut self,
        coated: &Coated,
        interreflection: Interreflection,
        bsdf: &mut Bsdf,
    ) -> Result<(), MaterialError> {
        let Coated { diffuse, index, roughness } = coated;
        let coat = self.rough(roughness, bsdf, |library, m| Ok(AnyLobe::Coat(library.coat(*index, m)?)))?;
        bsdf.add(coat, Interreflection::Followed);
        if let Some(shade) = self.needed_paint(diffuse, bsdf) {
            let sets = self.wavelengths.count();
            let ground = self.rough(roughness, bsdf, |library, m| {
                Ok(AnyLobe::Ground(CoatedDiffuse::new(library.coat(*index, m)?, *index, &shade, sets)))
            })?;
            bsdf.add(ground, interreflection);
            bsdf.ambient = Some(shade);
        }
        Ok(())
    }

    fn translucent(
        &mut self,
        translucent: &Translucent,
        interreflection: Interreflection,
        bsdf: &mut Bsdf,
    ) -> Result<(), MaterialError> {
        let Translucent { diffuse, transmittance, coat } = translucent;
        match coat {
            Some(roughness) => {
                let (index, roughness) = (Translucent::COAT_INDEX, roughness.clone());
                self.coated(&Coated { diffuse: diffuse.clone(), index, roughness }, interreflection, bsdf)?;
            }
            None => {
                if let Some(shade) = self.needed_paint(diffuse, bsdf) {
                    bsdf.ambient = Some(shade.clone());
                    bsdf.add(AnyLobe::Diffuse(DiffuseLobe(shade)), interreflection);
                }
            }
        }
        if let Some(shade) = self.needed_paint(transmittance, bsdf) {
            // A radiosity solution knows the light on the side of the viewer only.
            let followed = match interreflection {
                Interreflection::Solved => Interreflection::Followed,
                other => other,
            };
            bsdf.add(AnyLobe::Translucent(TranslucentLobe(shade)), followed);
        }
        Ok(())
    }

    fn principled(
        &mut self,
        principled: &Principled,
        interreflection: Interreflection,
        bsdf: &mut Bsdf,
    ) -> Result<(), MaterialError> {
        let Principled { index, coat_index, thin, .. } = *principled;
        let none = NumberTexture::Constant(0.0);
        let (has_coat, transmits) = (principled.coat != none, principled.transmission != none);
        if transmits && !thin {
            bsdf.interior = Some(InteriorMedium {
                index: self.wavelengths.constant(index),
                absorption: self.wavelengths.filter(&principled.absorption),
                disperses: false,
                priority: principled.priority,
            });
        }
        let colors = [&principled.base_color, &principled.sheen].map(|paint| self.prepared_paint(paint, bsdf));
        let Principled { metallic, specular, transmission, coat, sheen_roughness, .. } = principled;
        let numbers = [metallic, specular, transmission, coat, sheen_roughness].map(|number| bsdf.quantity(number));
        // Facets of the slope m, the square of the roughness; what varies has a row of them.
        let slopes = |roughness: &NumberTexture| match roughness {
            NumberTexture::Constant(0.0) => vec![(0.0, None)],
            NumberTexture::Constant(roughness) => vec![(*roughness, Some(roughness * roughness))],
            varying => nodes(varying, LEAST_VARYING_ROUGHNESS.sqrt()).into_iter().map(|r| (r, Some(r * r))).collect(),
        };
        let coats = if has_coat { slopes(&principled.coat_roughness) } else { vec![(0.0, None)] };
        let along = bsdf.quantity(&principled.roughness);
        let across = if has_coat { bsdf.quantity(&principled.coat_roughness) } else { PreparedNumber::Constant(0.0) };
        let surface = |roughness: Option<f64>, coat_roughness: Option<f64>| {
            let make = PrincipledParameters { index, coat_index, roughness, coat_roughness, thin, has_coat, transmits };
            PrincipledSurface::new(&make, colors.clone(), numbers).map(Arc::new)
        };
        let row = |slope| -> Result<Vec<(f64, Arc<PrincipledSurface>)>, MaterialError> {
            coats.iter().map(|(roughness, coat)| Ok((*roughness, surface(slope, *coat)?))).collect()
        };
        let rows = slopes(&principled.roughness).into_iter().map(|(roughness, slope)| Ok((roughness, row(slope)?)));
        let rows = rows.collect::<Result<Vec<_>, MaterialError>>()?;
        let lobe = |part: PrincipledPart| {
            let of_row = |(r, row): &(f64, Vec<(f64, Arc<PrincipledSurface>)>)| {
                let lobes = row
                    .iter()
                    .map(|(r, surface)| (*r, AnyLobe::Principled(PrincipledLobe { part, surface: surface.clone() })));
                (*r, AnyLobe::varied(across, lobes.collect()))
            };
            AnyLobe::varied(along, rows.iter().map(of_row).collect())
        };
        if thin && let Some(surface) = rows.first().and_then(|(_, row)| row.first()).filter(|(_, s)| s.is_pane()) {
            bsdf.straight_transmission = Some(StraightTransmission::Pane(surface.1.clone()));
        }
        if !principled.sheen.is_black() {
            bsdf.add(lobe(PrincipledPart::Sheen), Interreflection::Followed);
        }
        if has_coat {
            bsdf.add(lobe(PrincipledPart::Coat), Interreflection::Followed);
        }
        if *metallic != none || *specular != none || transmits {
            bsdf.add(lobe(PrincipledPart::Facets), Interreflection::Followed);
        }
        bsdf.add(lobe(PrincipledPart::Spread), if transmits { Interreflection::Followed } else { interreflection });
        bsdf.ambient = None;
        Ok(())
    }

    /// A lobe of a roughness, which may change from place to place.
    fn rough(
        &mut self,
        roughness: &NumberTexture,
        bsdf: &mut Bsdf,
        made: impl FnMut(&mut BsdfBuilder<'a>, f64) -> Result<AnyLobe, MaterialError>,
    ) -> Result<AnyLobe, MaterialError> {
        self.varied(roughness, LEAST_VARYING_ROUGHNESS, bsdf, made)
    }

    /// A lobe of a number, which may change from place to place.
    ///
    /// - `least`: the least that is told apart where it changes. `made`: the lobe of a value.
    fn varied(
        &mut self,
        number: &NumberTexture,
        least: f64,
        bsdf: &mut Bsdf,
        mut made: impl FnMut(&mut BsdfBuilder<'a>, f64) -> Result<AnyLobe, MaterialError>,
    ) -> Result<AnyLobe, MaterialError> {
        if let NumberTexture::Constant(value) = number {
            return made(self, *value);
        }
        let lobes = nodes(number, least).into_iter().map(|value| Ok((value, made(self, value)?)));
        let lobes = lobes.collect::<Result<_, MaterialError>>()?;
        Ok(AnyLobe::varied(bsdf.varying(number), lobes))
    }

    /// A coat of a refractive index and a roughness.
    fn coat(&mut self, index: f64, roughness: f64) -> Result<Arc<CoatReflection>, MaterialError> {
        let key = [index, roughness];
        if let Some((_, coat)) = self.coats.iter().find(|(other, _)| *other == key) {
            return Ok(coat.clone());
        }
        let facets = match roughness {
            0.0 => None,
            roughness => Some(Microfacet::new(SlopeDistribution::Ggx, DVec2::splat(roughness))?),
        };
        let coat = Arc::new(CoatReflection::new(Dielectric::new(1.0, index)?, facets));
        self.coats.push((key, coat.clone()));
        Ok(coat)
    }

    /// A fraction of light, prepared; its texture is added to those of the material.
    fn prepared_paint(&self, paint: &Paint, bsdf: &mut Bsdf) -> PreparedPaint {
        match paint {
            Paint::Plain(color) => PreparedPaint::Plain(self.wavelengths.reflectance(color)),
            Paint::Pattern(pattern) => {
                bsdf.patterns.push(PreparedTexture::Paint(PreparedPattern::new(pattern, self.wavelengths)));
                PreparedPaint::Textured(bsdf.patterns.len() - 1)
            }
        }
    }

    /// A fraction of light, prepared; none if it is 0 and may be left out.
    fn needed_paint(&self, paint: &Paint, bsdf: &mut Bsdf) -> Option<PreparedPaint> {
        match paint {
            Paint::Plain(color) if !self.everything && self.wavelengths.reflectance(color).max() <= 0.0 => None,
            Paint::Pattern(_) if !self.everything && paint.is_black() => None,
            _ => Some(self.prepared_paint(paint, bsdf)),
        }
    }

    /// A member of the family.
    fn facet_distribution(&mut self, name: &str, roughness: f64) -> Result<FacetDistribution, MaterialError> {
        if let Some((.., shape)) = self.forms.iter().find(|(n, m, _)| n == name && *m == roughness) {
            return Ok(shape.clone());
        }
        let shape = match FAMILY.iter().find(|row| row.name == name) {
            Some(_) if let Some(model) = FacetModel::named(name).filter(|model| model.is_multiple) => {
                FacetDistribution::MultipleScattering(Arc::new(Compensated::new(model.slopes, roughness)?))
            }
            Some(row) => FacetDistribution::SingleScattering(Arc::from((row.make)(roughness)?)),
            None => return Err(MaterialError::Unknown { name: name.into(), advice: String::new() }),
        };
        self.forms.push((name.into(), roughness, shape.clone()));
        Ok(shape)
    }
}
