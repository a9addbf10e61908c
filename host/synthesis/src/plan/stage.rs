//! The stages of rendering, one row each: name and the rule that decides whether a scene needs it.

use super::decision::Decision;
use crate::illumination::Material;
use crate::illumination::distribution::{FacetForm, TableError};
use crate::illumination::light::LightOrigin;
use crate::illumination::material::{
    Classic, Coated, Distributed, DistributionForm, Finish, MaterialKind, Metal, Transparent,
};
use crate::illumination::optics::Interreflection;
use crate::scene::{Caustics, Prepared, PreparedObject};

/// A stage of rendering that can be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// The octree and all rays.
    Octree,
    /// Normals interpolated between the corners.
    Normals,
    /// Positions and normals of the exact surfaces behind triangles, where rays meet them.
    ExactSurfaces,
    /// Spectra in place of three bands.
    Spectra,
    /// Patterns and reliefs.
    Textures,
    /// Lambert's term.
    Diffuse,
    /// Highlights: Phong's term, and what facets reflect.
    Specular,
    /// The ambient term.
    Ambient,
    /// Rays towards the lights, or shadow volumes.
    Shadows,
    /// What stands between the voxels of the scene and its lights, kept for rays towards them.
    LightBuffer,
    /// Photons that are traced from lamps through mirrors and glass, and stored.
    PhotonMap,
    /// Points of surfaces, one for each voxel, that rays meet instead of surfaces.
    SurfacePoints,
    /// Rays from mirrors, through glass, and from rough surfaces.
    Reflection,
    /// Light that diffuse surfaces send each other, found before for all views.
    Radiosity,
    /// A time for each sample, at which it sees what moves.
    Motion,
    /// More than one sample in a pixel.
    AntiAliasing,
}

/// From so many triangles on rays to lights are spared.
const MANY_TRIANGLES: u64 = 1000;

/// What the rules look at.
pub(super) struct Facts<'a> {
    prepared: &'a Prepared,
    bright: Vec<bool>,
    included: Vec<bool>,
}

impl<'a> Facts<'a> {
    pub(super) fn new(prepared: &'a Prepared, bright: Vec<bool>) -> Facts<'a> {
        let kept = vec![true; prepared.objects.len()];
        Facts { prepared, bright, included: kept }
    }

    pub(super) fn within(self, included: Vec<bool>) -> Facts<'a> {
        Facts { included, ..self }
    }

    fn count(&self, test: impl Fn(&Material) -> bool) -> usize {
        self.included().filter(|o| o.materials.iter().any(&test)).count()
    }

    fn included(&self) -> impl Iterator<Item = &crate::scene::PreparedObject> {
        self.prepared.objects.iter().zip(&self.included).filter(|(o, kept)| **kept && !o.is_empty()).map(|(o, _)| o)
    }

    pub(super) fn is_bright(&self, light: usize) -> bool {
        self.bright[light]
    }

    /// Lights, and objects that emit.
    fn lights(&self) -> usize {
        let glowing = self.included().filter(|object| object.light.is_none() && self.emits(object));
        self.bright.iter().filter(|b| **b).count() + glowing.count()
    }

    /// Whether an object emits light.
    pub(super) fn emits(&self, object: &PreparedObject) -> bool {
        self.prepared.is_lit_lamp(object) || object.materials.iter().any(|material| !material.emission.is_black())
    }

    pub(super) fn shadows(&self) -> Decision {
        let receivers = self.count(|m| has_diffuse(m) || has_highlight(m));
        if self.lights() == 0 {
            Decision::new(false, "no light has power")
        } else if receivers == 0 {
            Decision::new(false, "no material reflects light diffusely or in a highlight")
        } else {
            Decision::new(true, format!("{} and {}", counted(self.lights(), "light"), counted(receivers, "receiver")))
        }
    }

    pub(super) fn reflection(&self) -> Decision {
        let mirrors = self.count(continues_paths);
        let settings = &self.prepared.settings;
        let spread = settings.light.interreflection != Interreflection::LeftOut && self.count(has_diffuse) > 0;
        if mirrors == 0 && !spread {
            Decision::new(false, "no material is a mirror, transparent, or rough and shiny")
        } else if self.prepared.settings.light.reflection_depth == 0 {
            Decision::new(false, "reflection depth is 0")
        } else if mirrors == 0 {
            Decision::new(true, "diffuse light goes from surface to surface")
        } else {
            Decision::new(true, format!("{} with reflection or transmission", counted(mirrors, "object")))
        }
    }
}

/// Whether a material reflects light diffusely.
fn has_diffuse(material: &Material) -> bool {
    match &material.body {
        MaterialKind::Classic(Classic { diffuse, .. }) | MaterialKind::Coated(Coated { diffuse, .. }) => {
            !diffuse.is_black()
        }
        MaterialKind::Shaped(Distributed { reflectance, .. }) => !reflectance.is_black(),
        MaterialKind::Principled(principled) => principled.is_diffuse(),
        MaterialKind::Translucent(_) => true,
        MaterialKind::Metal(_) | MaterialKind::Transparent(_) => false,
    }
}

/// Whether lights have highlights on it.
fn has_highlight(material: &Material) -> bool {
    match &material.body {
        MaterialKind::Classic(Classic { specular, .. }) => !specular.is_black(),
        MaterialKind::Translucent(sheet) => sheet.coat.is_some(),
        _ => true,
    }
}

/// Whether rays go on from it.
fn continues_paths(material: &Material) -> bool {
    match &material.body {
        MaterialKind::Classic(Classic { mirror, transparency, .. }) => !mirror.is_black() || !transparency.is_black(),
        // Light that comes through is diffuse, and a coat reflects.
        MaterialKind::Translucent(sheet) => sheet.coat.is_some(),
        _ => true,
    }
}

fn counted(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

impl Stage {
    /// Every stage, in the order of the enumeration.
    pub const ALL: [Stage; 16] = [
        Stage::Octree,
        Stage::Normals,
        Stage::ExactSurfaces,
        Stage::Spectra,
        Stage::Textures,
        Stage::Diffuse,
        Stage::Specular,
        Stage::Ambient,
        Stage::Shadows,
        Stage::LightBuffer,
        Stage::PhotonMap,
        Stage::SurfacePoints,
        Stage::Reflection,
        Stage::Radiosity,
        Stage::Motion,
        Stage::AntiAliasing,
    ];

    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Stage::Octree => "octree",
            Stage::Normals => "interpolated normals",
            Stage::ExactSurfaces => "exact surfaces",
            Stage::Spectra => "spectra",
            Stage::Textures => "textures",
            Stage::Diffuse => "Lambert's term",
            Stage::Specular => "highlights",
            Stage::Ambient => "ambient term",
            Stage::Shadows => "shadows",
            Stage::LightBuffer => "light buffer",
            Stage::PhotonMap => "photon map",
            Stage::SurfacePoints => "points for surfaces",
            Stage::Reflection => "reflected and refracted rays",
            Stage::Radiosity => "radiosity",
            Stage::Motion => "motion",
            Stage::AntiAliasing => "anti-aliasing",
        }
    }

    /// The names of the [stages of work](crate::stages) that do nothing else.
    pub(super) fn work(self) -> &'static [&'static str] {
        match self {
            Stage::Octree => &["building the octree"],
            Stage::LightBuffer => &["building the light buffer"],
            Stage::PhotonMap => &["allocating photon paths", "tracing photons"],
            Stage::SurfacePoints => &["choosing points of surfaces"],
            Stage::Radiosity => &["solving for radiosity"],
            _ => &[],
        }
    }

    /// Whether running it without need changes nothing.
    pub(super) fn is_forcible(self) -> bool {
        !matches!(self, Stage::Spectra | Stage::PhotonMap | Stage::SurfacePoints | Stage::Radiosity)
    }

    pub(super) fn decide(self, facts: &Facts<'_>) -> Decision {
        match self {
            Stage::Octree => octree(facts),
            Stage::Normals => normals(facts),
            Stage::ExactSurfaces => exact_surfaces(facts),
            Stage::Spectra => spectra(facts),
            Stage::Textures => textures(facts),
            Stage::Diffuse => direct(facts, "diffuse part", has_diffuse),
            Stage::Specular => highlights(facts),
            Stage::Ambient => ambient(facts),
            Stage::Shadows => facts.shadows(),
            Stage::LightBuffer => light_buffer(facts),
            Stage::PhotonMap => photon_map(facts),
            Stage::SurfacePoints => surface_points(facts),
            Stage::Reflection => facts.reflection(),
            Stage::Radiosity => radiosity(facts),
            Stage::Motion => motion(facts),
            Stage::AntiAliasing => match facts.prepared.settings.image.samples {
                1 => Decision::new(false, "one sample: the centre of each pixel"),
                n => Decision::new(true, format!("{n} samples in each pixel")),
            },
        }
    }
}

fn light_buffer(facts: &Facts<'_>) -> Decision {
    let shadows = facts.shadows();
    if !shadows.needed {
        return Decision::new(false, "without shadows nothing is looked for between surfaces and lights");
    }
    if !facts.prepared.settings.light.buffer {
        return Decision::new(false, "the scene asks for all rays to lights");
    }
    let bright = facts.prepared.lights.iter().enumerate().filter(|(i, _)| facts.is_bright(*i));
    let skies = bright.filter(|(_, light)| light.origin() == LightOrigin::Everywhere).count();
    if skies == facts.lights() {
        return Decision::new(false, "a sky is in all directions");
    }
    let triangles = facts.included().map(|o| u64::from(o.count)).sum::<u64>();
    if triangles < MANY_TRIANGLES {
        return Decision::new(false, "the octree finds its way as fast among so few triangles");
    }
    Decision::new(true, "what stands between voxels and lights is kept, for all views")
}

/// Caustics are more of the picture, not a better way to the same: forcing everything does not bring them.
fn photon_map(facts: &Facts<'_>) -> Decision {
    let (throwers, takers) =
        (facts.count(Material::may_cast_caustics), facts.count(|m| has_diffuse(m) || !m.may_cast_caustics()));
    let lamps = facts.prepared.lights.iter().enumerate().filter(|(i, _)| facts.is_bright(*i));
    let even = lamps.filter(|(_, light)| light.is_even_sky()).count();
    let lamps = facts.lights() - even;
    if facts.prepared.settings.light.caustics != Caustics::PhotonMapped {
        Decision::new(false, "the scene does not ask for two-way ray tracing")
    } else if throwers == 0 {
        Decision::new(false, "no material is a mirror, transparent or shiny: light goes straight")
    } else if lamps == 0 {
        Decision::new(false, "no lamp has power; a sky of one radiance is found by rays from everywhere")
    } else if takers == 0 {
        Decision::new(false, "no material spreads light that comes to it")
    } else {
        let from = format!("{} through {}", counted(lamps, "lamp"), counted(throwers, "object"));
        Decision::new(true, format!("light of {from} to {}", counted(takers, "receiver")))
    }
}

/// An approximation, which is never forced.
fn surface_points(facts: &Facts<'_>) -> Decision {
    match facts.prepared.settings.photons.point_depth {
        None => Decision::new(false, "rays meet surfaces themselves, as the scene does not ask for points"),
        Some(_) if !photon_map(facts).needed => Decision::new(false, "no photons are traced from lamps"),
        Some(depth) => Decision::new(true, format!("the scene asks for {} voxels a side", 1_u64 << depth)),
    }
}

fn radiosity(facts: &Facts<'_>) -> Decision {
    let diffuse = facts.included().filter(|object| object.materials.iter().any(has_diffuse));
    let (objects, triangles) = diffuse.fold((0, 0), |(objects, all), object| (objects + 1, all + object.count));
    if facts.prepared.settings.light.interreflection != Interreflection::Solved {
        Decision::new(false, "the scene does not ask for it")
    } else if facts.lights() == 0 {
        Decision::new(false, "no light has power")
    } else if triangles < 2 {
        Decision::new(false, "nothing diffuse sees anything diffuse")
    } else {
        Decision::new(true, format!("{} may send each other light", counted(objects, "diffuse object")))
    }
}

fn motion(facts: &Facts<'_>) -> Decision {
    match facts.included().filter(|o| o.motion.is_some()).count() {
        0 => Decision::new(false, "no object moves while the shutter is open"),
        n => Decision::new(true, format!("{} in motion", counted(n, "object"))),
    }
}

fn octree(facts: &Facts<'_>) -> Decision {
    let triangles = facts.included().map(|o| u64::from(o.count)).sum::<u64>();
    let instances = facts.included().map(|o| o.instances).sum::<usize>();
    match (triangles, instances) {
        (0, _) => Decision::new(false, "no triangle can be seen: the picture is the background"),
        (n, 0) => Decision::new(true, counted(n as usize, "triangle")),
        (n, more) => {
            let stored = counted(n as usize, "triangle");
            Decision::new(true, format!("{stored}, and {}", counted(more, "instance")))
        }
    }
}

fn normals(facts: &Facts<'_>) -> Decision {
    match facts.included().filter(|o| o.is_curved()).count() {
        0 => Decision::new(false, "every object has flat faces"),
        n => Decision::new(true, format!("{} with curved surfaces", counted(n, "object"))),
    }
}

fn exact_surfaces(facts: &Facts<'_>) -> Decision {
    match facts.included().filter(|o| o.is_exact()).count() {
        0 if !facts.prepared.settings.geometry.exact_surfaces => Decision::new(false, "the scene asks for triangles"),
        0 => Decision::new(false, "no curved surface is known but by its triangles"),
        n => Decision::new(true, format!("{}, where rays meet them", counted(n, "object"))),
    }
}

fn textures(facts: &Facts<'_>) -> Decision {
    match facts.count(Material::is_textured) {
        0 => Decision::new(false, "no material changes from place to place"),
        n => Decision::new(true, format!("{} with a pattern or relief", counted(n, "object"))),
    }
}

/// Spectra are another picture, not a better way to the same: forcing everything does not bring them.
fn spectra(facts: &Facts<'_>) -> Decision {
    let lights = facts.prepared.lights.iter().zip(&facts.bright);
    let lights = lights.filter(|(light, bright)| **bright && light.is_spectral()).count();
    match (facts.prepared.settings.light.spectral, facts.count(Material::is_spectral), lights) {
        (Some(true), ..) => Decision::new(true, "the scene asks for them"),
        (Some(false), ..) => Decision::new(false, "the scene asks for three bands"),
        (None, 0, 0) => Decision::new(false, "no material and no light has a spectrum: three bands tell all"),
        (None, 0, lights) => Decision::new(true, format!("{} with a spectrum", counted(lights, "light"))),
        (None, objects, _) => {
            Decision::new(true, format!("{} of a material with a spectrum", counted(objects, "object")))
        }
    }
}

fn direct(facts: &Facts<'_>, what: &str, has: impl Fn(&Material) -> bool) -> Decision {
    let count = facts.count(has);
    if count == 0 {
        Decision::new(false, format!("no material has a {what}"))
    } else if facts.lights() == 0 {
        Decision::new(false, "no light has power")
    } else {
        Decision::new(true, format!("{} with a {what}", counted(count, "object")))
    }
}

fn highlights(facts: &Facts<'_>) -> Decision {
    let mut decision = direct(facts, "highlight", has_highlight);
    let mut told = Vec::new();
    for material in facts.included().flat_map(|object| &object.materials) {
        let table = match &material.body {
            MaterialKind::Shaped(Distributed { form: DistributionForm::Facets(table), .. })
            | MaterialKind::Metal(Metal { finish: Finish::Facets(table), .. })
            | MaterialKind::Transparent(Transparent { facets: FacetForm::Table(table), .. }) => table,
            _ => continue,
        };
        let TableError { greatest, mean, values } = table.error();
        let words = format!(
            "; a user's distribution in {values} values: error {greatest:.1e} of a value at most, {mean:.1e} of the area"
        );
        if !told.contains(&words) {
            decision.reason.push_str(&words);
            told.push(words);
        }
    }
    decision
}

fn ambient(facts: &Facts<'_>) -> Decision {
    let count = facts.count(|material| has_diffuse(material) || continues_paths(material));
    if facts.prepared.ambient.max_element() <= 0.0 {
        Decision::new(false, "there is no ambient light")
    } else if count == 0 {
        Decision::new(false, "no material has a diffuse part, or is a mirror or transparent")
    } else {
        Decision::new(
            true,
            format!("{} with a diffuse part, or that may show what is around", counted(count, "object")),
        )
    }
}
