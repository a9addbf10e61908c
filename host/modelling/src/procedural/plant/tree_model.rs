//! Trees by the model of Weber and Penn, as plain data.

use super::colonisation::Colonisation;
use super::crown::CrownShape;
use super::organ::Organ;
use super::organ_mesh::{ORGAN_VARIANTS, organ_mesh};
use super::parameters::TreeNumbers;
use crate::procedural::drawing::{PredefinedPart, PredefinedSurface};
use std::sync::Arc;

/// A tree or another plant of stems that branch, with organs on the stems of the last level.
///
/// - A stem bends and forks segment by segment, and is drawn through these as a smooth curve, where Weber and Penn have
///   pieces that are straight.
/// - Stems are born where those that bear them have grown past their place; a plant of an age is a function of the age
///   without jumps.
/// - Of stems and organs that are smaller than the detail some are left out, and those that stay are larger: the area
///   that is seen is the same in the mean.
///
/// *Not modelled:* competition of stems for room and light.
///
/// # Source
/// Weber and Penn 1995, "Creation and Rendering of Realistic Trees". Space colonisation: Runions, Lane and
/// Prusinkiewicz 2007. Growth, several trunks, and organs of several kinds are ours.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeModel {
    /// The shape of its crown.
    pub shape: CrownShape,
    /// Its numbers.
    pub numbers: TreeNumbers,
    /// What stands on its stems of the last level.
    pub organs: Vec<Organ>,
    /// By what its crown is filled in place of levels of stems: of the numbers only those of the trunk count then.
    pub colonisation: Option<Colonisation>,
}

impl TreeModel {
    /// The variants of all organs as surfaces.
    pub(super) fn surfaces(&self, detail: f64) -> Vec<PredefinedSurface> {
        let surface = |number: usize| {
            let organ = &self.organs[number / ORGAN_VARIANTS];
            let mesh = organ_mesh(organ, number % ORGAN_VARIANTS, detail / organ.size.mean.max(1e-12));
            PredefinedSurface { name: organ.name.clone(), parts: vec![PredefinedPart::Triangles(Arc::new(mesh))] }
        };
        (0..self.organs.len() * ORGAN_VARIANTS).map(surface).collect()
    }
}
