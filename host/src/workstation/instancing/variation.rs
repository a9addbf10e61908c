//! What varies from instance to instance: the colour of one material of each thing that is placed.

use super::super::facets;
use super::super::parts::MaterialPart;
use super::super::structure_commands::StructureCommands;
use super::placed::PlacedGroup;
use crate::illumination::Material;
use protocol::command::{Command, Operate};

/// The material of a prototype whose colour its instances set, if there is any. What else varies has its mean colour.
pub(super) struct Variation(Option<Material>);

impl Variation {
    /// The variation of a prototype.
    pub(super) fn of(prototype: &PlacedGroup<'_>) -> Variation {
        let own = prototype.objects.iter().flat_map(|object| object.materials(&[]).0);
        Variation(own.chain([prototype.material.clone()]).find(varies))
    }

    /// Sets the color of an instance for what follows.
    pub(super) fn set(&self, variation: u16, out: &mut StructureCommands) {
        if let Some(material) = &self.0 {
            let [hue, saturation] = facets::hue_saturation(facets::main_color_of(material, Some(variation)));
            out.operate(None, Operate::SetColor { hue, saturation });
        }
    }

    /// Adds the parts of a prototype: first those that have the color of the instance.
    pub(super) fn first(&self, mut parts: Vec<MaterialPart>, out: &mut StructureCommands) {
        parts.sort_by_key(|part| self.0.as_ref() != Some(&part.material));
        for part in parts {
            if self.0.as_ref() != Some(&part.material) {
                let [hue, saturation] = facets::hue_saturation(facets::main_color(&part.material));
                out.operate(None, Operate::SetColor { hue, saturation });
            }
            out.commands.push(Command::Define { name: None, object: part.data });
        }
    }
}

/// Whether a material has not the same color in all instances.
fn varies(material: &Material) -> bool {
    let of = |variation: u16| facets::main_color_of(material, Some(variation));
    of(0) != of(u16::MAX) || of(0) != of(u16::MAX / 3)
}
