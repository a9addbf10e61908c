//! The stages of rendering, one row each: name and the rule that decides whether a scene needs it.

use super::Decision;
use crate::illumination::{Bands, Material};
use crate::scene::Prepared;

/// A stage of rendering that can be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// The octree and all rays.
    Octree,
    /// Normals interpolated between the corners.
    Normals,
    /// Lambert's term.
    Diffuse,
    /// Phong's term.
    Specular,
    /// The ambient term.
    Ambient,
    /// Rays towards the lights.
    Shadows,
    /// Rays from mirrors.
    Reflection,
    /// More than one sample in a pixel.
    AntiAliasing,
}

/// What the rules look at.
pub(super) struct Facts<'a> {
    prepared: &'a Prepared,
    bright: Vec<bool>,
    kept: Vec<bool>,
}

impl<'a> Facts<'a> {
    pub(super) fn new(prepared: &'a Prepared, bright: Vec<bool>) -> Facts<'a> {
        let kept = vec![true; prepared.objects.len()];
        Facts { prepared, bright, kept }
    }

    pub(super) fn within(self, kept: Vec<bool>) -> Facts<'a> {
        Facts { kept, ..self }
    }

    fn count(&self, test: impl Fn(&Material) -> bool) -> usize {
        self.kept().filter(|o| o.materials.iter().any(&test)).count()
    }

    fn kept(&self) -> impl Iterator<Item = &crate::scene::PreparedObject> {
        self.prepared.objects.iter().zip(&self.kept).filter(|(o, kept)| **kept && o.count > 0).map(|(o, _)| o)
    }

    pub(super) fn is_bright(&self, light: usize) -> bool {
        self.bright[light]
    }

    fn lights(&self) -> usize {
        self.bright.iter().filter(|b| **b).count()
    }

    pub(super) fn shadows(&self) -> Decision {
        let receivers = self.count(|m| some(m.diffuse) || some(m.specular));
        if self.lights() == 0 {
            Decision::new(false, "no light has power")
        } else if receivers == 0 {
            Decision::new(false, "no material reflects light diffusely or in a highlight")
        } else {
            Decision::new(true, format!("{} and {}", counted(self.lights(), "light"), counted(receivers, "receiver")))
        }
    }

    pub(super) fn reflection(&self) -> Decision {
        let mirrors = self.count(|m| some(m.mirror));
        if mirrors == 0 {
            Decision::new(false, "no material is a mirror")
        } else if self.prepared.settings.reflection_depth == 0 {
            Decision::new(false, "reflection depth is 0")
        } else {
            Decision::new(true, format!("{} of a mirroring material", counted(mirrors, "object")))
        }
    }
}

fn some(k: Bands) -> bool {
    k.max_element() > 0.0
}

fn counted(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

impl Stage {
    /// Every stage, in the order of the enumeration.
    pub const ALL: [Stage; 8] = [
        Stage::Octree,
        Stage::Normals,
        Stage::Diffuse,
        Stage::Specular,
        Stage::Ambient,
        Stage::Shadows,
        Stage::Reflection,
        Stage::AntiAliasing,
    ];

    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Stage::Octree => "octree",
            Stage::Normals => "interpolated normals",
            Stage::Diffuse => "Lambert's term",
            Stage::Specular => "Phong's term",
            Stage::Ambient => "ambient term",
            Stage::Shadows => "shadow rays",
            Stage::Reflection => "reflected rays",
            Stage::AntiAliasing => "anti-aliasing",
        }
    }

    pub(super) fn decide(self, facts: &Facts<'_>) -> Decision {
        match self {
            Stage::Octree => octree(facts),
            Stage::Normals => normals(facts),
            Stage::Diffuse => direct(facts, "diffuse", |m| m.diffuse),
            Stage::Specular => direct(facts, "specular", |m| m.specular),
            Stage::Ambient => ambient(facts),
            Stage::Shadows => facts.shadows(),
            Stage::Reflection => facts.reflection(),
            Stage::AntiAliasing => match facts.prepared.settings.samples {
                1 => Decision::new(false, "one sample: the centre of each pixel"),
                n => Decision::new(true, format!("{n} samples in each pixel")),
            },
        }
    }
}

fn octree(facts: &Facts<'_>) -> Decision {
    match facts.kept().map(|o| u64::from(o.count)).sum::<u64>() {
        0 => Decision::new(false, "no triangle can be seen: the picture is the background"),
        n => Decision::new(true, counted(n as usize, "triangle")),
    }
}

fn normals(facts: &Facts<'_>) -> Decision {
    match facts.kept().filter(|o| o.is_curved()).count() {
        0 => Decision::new(false, "every object has flat faces"),
        n => Decision::new(true, format!("{} with curved surfaces", counted(n, "object"))),
    }
}

fn direct(facts: &Facts<'_>, what: &str, k: impl Fn(&Material) -> Bands) -> Decision {
    let count = facts.count(|m| some(k(m)));
    if count == 0 {
        Decision::new(false, format!("no material has a {what} part"))
    } else if facts.lights() == 0 {
        Decision::new(false, "no light has power")
    } else {
        Decision::new(true, format!("{} with a {what} part", counted(count, "object")))
    }
}

fn ambient(facts: &Facts<'_>) -> Decision {
    let count = facts.count(|m| some(m.diffuse));
    if !some(facts.prepared.ambient) {
        Decision::new(false, "there is no ambient light")
    } else if count == 0 {
        Decision::new(false, "no material has a diffuse part")
    } else {
        Decision::new(true, format!("{} with a diffuse part", counted(count, "object")))
    }
}
