//! Materials as records of version 1 hold them: every number is the same everywhere, and no body has a priority.

use crate::color::{Color, Spectrum};
use crate::illumination::distribution::{FacetTable, Tabulated};
use crate::illumination::material::{self, Index};
use crate::illumination::texture::{Paint, Relief};
use glam::{DVec2, DVec3};
use serde::Deserialize;

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) struct Material {
    pub(super) body: Body,
    pub(super) emission: Color,
    pub(super) relief: Option<Relief>,
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum Body {
    Classic { diffuse: Paint, specular: Paint, exponent: f64, mirror: Paint, transparency: Paint },
    Shaped { reflectance: Paint, form: Form },
    Metal { n: Spectrum, k: Spectrum, finish: Finish },
    Transparent { index: Index, roughness: f64, absorption: Color },
    Coated { diffuse: Paint, index: f64, roughness: f64 },
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum Form {
    Member { name: String, roughness: f64 },
    Table(Tabulated),
    Facets(FacetTable),
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum Finish {
    Polished,
    Rough { name: String, roughness: f64 },
    Brushed { roughness: DVec2, along: DVec3 },
}

impl From<Material> for material::Material {
    fn from(Material { body, emission, relief }: Material) -> material::Material {
        material::Material { body: body.into(), emission, relief }
    }
}

impl From<Body> for material::Body {
    fn from(body: Body) -> material::Body {
        match body {
            Body::Classic { diffuse, specular, exponent, mirror, transparency } => {
                let exponent = exponent.into();
                material::Body::Classic(material::Classic { diffuse, specular, exponent, mirror, transparency })
            }
            Body::Shaped { reflectance, form } => {
                let form = match form {
                    Form::Member { name, roughness } => material::Form::Member { name, roughness: roughness.into() },
                    Form::Table(table) => material::Form::Table(table),
                    Form::Facets(table) => material::Form::Facets(table),
                };
                material::Body::Shaped(material::Shaped { reflectance, form })
            }
            Body::Metal { n, k, finish } => {
                let finish = match finish {
                    Finish::Polished => material::Finish::Polished,
                    Finish::Rough { name, roughness } => material::Finish::Rough { name, roughness: roughness.into() },
                    Finish::Brushed { roughness, along } => {
                        material::Finish::Brushed { roughness: roughness.to_array().map(Into::into), along }
                    }
                };
                material::Body::Metal(material::Metal { n, k, finish })
            }
            Body::Transparent { index, roughness, absorption } => material::Body::Transparent(material::Transparent {
                roughness: roughness.into(),
                absorption,
                ..material::Transparent::clear(index)
            }),
            Body::Coated { diffuse, index, roughness } => {
                material::Body::Coated(material::Coated { diffuse, index, roughness: roughness.into() })
            }
        }
    }
}
