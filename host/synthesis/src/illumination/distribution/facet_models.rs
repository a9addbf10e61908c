//! Models of facets, by the names that members of the family have: for surfaces that also let light through.

use super::{FacetTable, SlopeDistribution};
use serde::{Deserialize, Serialize};

/// A model of the facets of a rough surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacetModel {
    /// The name of the member of the family.
    pub name: &'static str,
    /// How slopes are distributed.
    pub slopes: SlopeDistribution,
    /// Whether heights of light and viewer are correlated.
    pub is_correlated: bool,
    /// Whether facets send light on to each other; if not, what they mask is lost.
    pub is_multiple: bool,
}

/// The models.
pub const FACET_MODELS: &[FacetModel] = &[
    model("GGX, all", SlopeDistribution::Ggx, true, true),
    model("Beckmann, all", SlopeDistribution::Beckmann, true, true),
    model("GGX", SlopeDistribution::Ggx, true, false),
    model("Beckmann", SlopeDistribution::Beckmann, true, false),
    model("GGX, separable", SlopeDistribution::Ggx, false, false),
    model("Beckmann, separable", SlopeDistribution::Beckmann, false, false),
];

const fn model(name: &'static str, slopes: SlopeDistribution, is_correlated: bool, is_multiple: bool) -> FacetModel {
    FacetModel { name, slopes, is_correlated, is_multiple }
}

impl FacetModel {
    /// The model of a name.
    pub fn named(name: &str) -> Option<&'static FacetModel> {
        FACET_MODELS.iter().find(|model| model.name == name)
    }
}

/// The facets of a rough surface: a model and a roughness of its own, or a table, which has its roughness in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FacetForm {
    /// The name of a model, as in [`FACET_MODELS`].
    Model(String),
    /// Facets that the user defined, by their angle; they send light on to each other.
    Table(FacetTable),
}

impl Default for FacetForm {
    fn default() -> FacetForm {
        FacetForm::Model(FACET_MODELS[0].name.into())
    }
}
