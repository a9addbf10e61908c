//! Materials as records of version 2 hold them: glass has the facets of GGX, and brushed metals those of Beckmann.

use crate::color::{Color, Spectrum};
use crate::illumination::material::{self, Classic, Coated, Distributed, Principled, RefractiveIndex};
use crate::illumination::texture::{NumberTexture, Relief};
use glam::DVec3;
use serde::Deserialize;

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) struct MaterialV2 {
    pub(super) body: BodyV2,
    pub(super) emission: Color,
    pub(super) relief: Option<Relief>,
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum BodyV2 {
    Classic(Classic),
    Shaped(Distributed),
    Metal { n: Spectrum, k: Spectrum, finish: FinishV2 },
    Transparent { index: RefractiveIndex, roughness: NumberTexture, absorption: Color, priority: i32 },
    Coated(Coated),
    Principled(Box<Principled>),
}

#[derive(Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub(super) enum FinishV2 {
    Polished,
    Rough { name: String, roughness: NumberTexture },
    Brushed { roughness: [NumberTexture; 2], along: DVec3 },
}

impl From<MaterialV2> for material::Material {
    fn from(MaterialV2 { body, emission, relief }: MaterialV2) -> material::Material {
        material::Material { body: body.into(), emission, relief }
    }
}

impl From<BodyV2> for material::MaterialKind {
    fn from(body: BodyV2) -> material::MaterialKind {
        match body {
            BodyV2::Classic(classic) => material::MaterialKind::Classic(classic),
            BodyV2::Shaped(shaped) => material::MaterialKind::Shaped(shaped),
            BodyV2::Metal { n, k, finish } => {
                let finish = match finish {
                    FinishV2::Polished => material::Finish::Polished,
                    FinishV2::Rough { name, roughness } => material::Finish::Rough { name, roughness },
                    FinishV2::Brushed { roughness, along } => {
                        material::Finish::Brushed { name: "Beckmann".into(), roughness, along }
                    }
                };
                material::MaterialKind::Metal(material::Metal { n, k, finish })
            }
            BodyV2::Transparent { index, roughness, absorption, priority } => {
                material::MaterialKind::Transparent(material::Transparent {
                    roughness,
                    absorption,
                    priority,
                    ..material::Transparent::clear(index)
                })
            }
            BodyV2::Coated(coated) => material::MaterialKind::Coated(coated),
            BodyV2::Principled(principled) => material::MaterialKind::Principled(principled),
        }
    }
}
