//! Materials as records of version 1 hold them: every number is the same everywhere, and no body has a priority.

use crate::color::{Color, Spectrum};
use crate::illumination::distribution::{FacetTable, Tabulated};
use crate::illumination::material::{self, RefractiveIndex};
use crate::illumination::texture::{Paint, Relief};
use glam::{DVec2, DVec3};
use serde::Deserialize;

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) struct MaterialV1 {
    pub(super) body: BodyV1,
    pub(super) emission: Color,
    pub(super) relief: Option<Relief>,
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum BodyV1 {
    Classic { diffuse: Paint, specular: Paint, exponent: f64, mirror: Paint, transparency: Paint },
    Shaped { reflectance: Paint, form: FormV1 },
    Metal { n: Spectrum, k: Spectrum, finish: FinishV1 },
    Transparent { index: RefractiveIndex, roughness: f64, absorption: Color },
    Coated { diffuse: Paint, index: f64, roughness: f64 },
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum FormV1 {
    Member { name: String, roughness: f64 },
    Table(Tabulated),
    Facets(FacetTable),
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum FinishV1 {
    Polished,
    Rough { name: String, roughness: f64 },
    Brushed { roughness: DVec2, along: DVec3 },
}

impl From<MaterialV1> for material::Material {
    fn from(MaterialV1 { body, emission, relief }: MaterialV1) -> material::Material {
        material::Material { body: body.into(), emission, relief }
    }
}

impl From<BodyV1> for material::MaterialKind {
    fn from(body: BodyV1) -> material::MaterialKind {
        match body {
            BodyV1::Classic { diffuse, specular, exponent, mirror, transparency } => {
                let exponent = exponent.into();
                material::MaterialKind::Classic(material::Classic { diffuse, specular, exponent, mirror, transparency })
            }
            BodyV1::Shaped { reflectance, form } => {
                let form = match form {
                    FormV1::Member { name, roughness } => {
                        material::DistributionForm::Member { name, roughness: roughness.into() }
                    }
                    FormV1::Table(table) => material::DistributionForm::Table(table),
                    FormV1::Facets(table) => material::DistributionForm::Facets(table),
                };
                material::MaterialKind::Shaped(material::Distributed { reflectance, form })
            }
            BodyV1::Metal { n, k, finish } => {
                let finish = match finish {
                    FinishV1::Polished => material::Finish::Polished,
                    FinishV1::Rough { name, roughness } => {
                        material::Finish::Rough { name, roughness: roughness.into() }
                    }
                    FinishV1::Brushed { roughness, along } => material::Finish::Brushed {
                        name: "Beckmann".into(),
                        roughness: roughness.to_array().map(Into::into),
                        along,
                    },
                };
                material::MaterialKind::Metal(material::Metal { n, k, finish })
            }
            BodyV1::Transparent { index, roughness, absorption } => {
                material::MaterialKind::Transparent(material::Transparent {
                    roughness: roughness.into(),
                    absorption,
                    ..material::Transparent::clear(index)
                })
            }
            BodyV1::Coated { diffuse, index, roughness } => {
                material::MaterialKind::Coated(material::Coated { diffuse, index, roughness: roughness.into() })
            }
        }
    }
}
