//! Explains the path of a sample, and every term that it adds.

use crate::color::Channels;
use crate::render::world::SurfaceInteraction;
use crate::scene::Prepared;
use glam::DVec3;
use serde::Serialize;

/// Something that happened on the path of a sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathNote {
    /// How many path segments came before.
    pub depth: u32,
    /// The event, in words.
    pub what: String,
    /// The position, if at an element, scene units.
    pub at: Option<DVec3>,
    /// Radiance that it adds at the camera, at the wavelengths or in the bands of the sample.
    pub adds: Option<Vec<f64>>,
}

/// A log of notes; none for most samples.
pub(super) struct PathLog<'a>(Option<&'a mut Vec<PathNote>>);

impl<'a> PathLog<'a> {
    /// Notes nothing.
    pub(super) const SILENT: PathLog<'static> = PathLog(None);

    pub(super) fn to(notes: &'a mut Vec<PathNote>) -> PathLog<'a> {
        PathLog(Some(notes))
    }

    /// Notes something, if anyone listens.
    #[inline]
    pub(super) fn note(&mut self, note: impl FnOnce() -> PathNote) {
        if let Some(notes) = &mut self.0 {
            notes.push(note());
        }
    }
}

impl PathNote {
    fn new(depth: u32, what: String, adds: Option<Channels>) -> PathNote {
        PathNote { depth, what, at: None, adds: adds.map(|adds| adds.0.to_vec()) }
    }

    pub(super) fn light(depth: u32, number: usize, adds: Channels) -> PathNote {
        PathNote::new(depth, format!("hits light {}", number + 1), Some(adds))
    }

    pub(super) fn term(depth: u32, what: &str, adds: Channels) -> PathNote {
        PathNote::new(depth, what.into(), Some(adds))
    }

    pub(super) fn direct_light(depth: u32, number: usize, adds: Channels) -> PathNote {
        PathNote::new(depth, format!("lit by light {}", number + 1), Some(adds))
    }

    pub(super) fn element(depth: u32, prepared: &Prepared, interaction: &SurfaceInteraction<'_>) -> PathNote {
        let object = &prepared.objects[interaction.object as usize];
        let side = if interaction.element.outside { "" } else { " from inside" };
        let material = object.materials[interaction.material as usize].word();
        let normal = interaction.element.normal;
        let what = format!(
            "hits {}{side}, {material} material, after {:.6}; normal {:.4} {:.4} {:.4}",
            object.name, interaction.distance, normal.x, normal.y, normal.z
        );
        PathNote { at: Some(interaction.element.position), ..PathNote::new(depth, what, None) }
    }
}
