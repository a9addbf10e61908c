//! Materials and lights of a scene prepared for rendering, as the plan keeps them.

use crate::color::{Channels, SpectralTable, WavelengthSets};
use crate::illumination::Material;
use crate::illumination::light::{LightHit, LightSource};
use crate::illumination::optics::{Bsdf, BsdfBuilder, InteriorMedium, Interreflection};
use crate::numeric::debug_hash;
use crate::numeric::ray::Ray;
use crate::plan::{Plan, Stage};
use crate::render::RenderError;
use crate::scene::{Caustics, Prepared};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A prepared scene with its materials and lights prepared.
pub(in crate::render) struct Appearance<'a> {
    pub(in crate::render) prepared: &'a Prepared,
    pub(in crate::render) wavelengths: WavelengthSets,
    /// All materials, each once.
    bsdfs: Vec<Bsdf>,
    /// For each object, which of them its materials are.
    bsdf_of: Vec<Vec<u32>>,
    /// All lights, objects that emit among them, with their numbers: those of the scene come first.
    pub(in crate::render) sources: Vec<(usize, LightSource)>,
    /// For each object and material of it that emits, which of the lights it is.
    emitters: Vec<((u32, u32), usize)>,
    /// Radiance where there is nothing and no sky.
    background: SpectralTable,
    /// Ambient radiance.
    pub(in crate::render) ambient: Option<SpectralTable>,
    /// Whether normals are interpolated.
    pub(in crate::render) curved: bool,
    /// Whether rays are led on to exact surfaces.
    pub(in crate::render) exact: bool,
    /// Whether something lets light straight through.
    pub(in crate::render) has_passable: bool,
    /// Whether shadow rays go straight through polished bodies, as if these did not bend light: where caustics are left
    /// out.
    pub(in crate::render) has_clear_shadows: bool,
    /// The place of each object among all of them, the largest first; empty where less than two are transparent.
    by_size: Vec<u32>,
    /// Whether two or more objects are transparent: one may be in another.
    pub(in crate::render) has_nested: bool,
}

impl<'a> Appearance<'a> {
    /// Prepares the materials and lights that the plan keeps.
    ///
    /// # Errors
    /// [`RenderError::Material`].
    pub(in crate::render) fn new(prepared: &'a Prepared, plan: &Plan) -> Result<Appearance<'a>, RenderError> {
        let wavelengths = if plan.needs(Stage::Spectra) { WavelengthSets::spectral() } else { WavelengthSets::bands() };
        let mut appearance = Appearance {
            prepared,
            bsdfs: Vec::new(),
            bsdf_of: Vec::new(),
            sources: Vec::new(),
            emitters: Vec::new(),
            background: wavelengths.light(&prepared.background.into()),
            ambient: plan.needs(Stage::Ambient).then(|| wavelengths.light(&prepared.ambient.into())),
            curved: plan.needs(Stage::Normals),
            exact: plan.needs(Stage::ExactSurfaces),
            has_passable: false,
            has_clear_shadows: false,
            by_size: Vec::new(),
            has_nested: false,
            wavelengths,
        };
        appearance.add_materials(plan)?;
        for (number, light) in prepared.lights.iter().enumerate().filter(|(number, _)| plan.includes_light(*number)) {
            appearance
                .sources
                .push((number, LightSource::new(light, &appearance.wavelengths).with_portals(&prepared.portals)));
        }
        appearance.add_emitters(plan);
        appearance.has_passable = appearance.bsdfs.iter().any(Bsdf::is_passable);
        let is_followed = plan.needs(Stage::PhotonMap) || prepared.settings.light.caustics == Caustics::PathTraced;
        appearance.has_clear_shadows = !is_followed && appearance.bsdfs.iter().any(Bsdf::is_clear);
        let is_transparent =
            |numbers: &&Vec<u32>| numbers.iter().any(|number| appearance.bsdfs[*number as usize].interior.is_some());
        appearance.has_nested = appearance.bsdf_of.iter().filter(is_transparent).nth(1).is_some();
        if appearance.has_nested {
            appearance.by_size = places_by_size(prepared);
        }
        Ok(appearance)
    }

    /// The appearance where caustics are left out, whatever the scene asks for: light goes straight through polished
    /// bodies.
    pub(in crate::render) fn without_caustics(self) -> Appearance<'a> {
        Appearance { has_clear_shadows: self.bsdfs.iter().any(Bsdf::is_clear), ..self }
    }

    fn add_materials(&mut self, plan: &Plan) -> Result<(), RenderError> {
        let wavelengths = self.wavelengths.clone();
        let mut library = BsdfBuilder::new(&wavelengths, plan.forced);
        let mut known: FxHashMap<u64, Vec<(&Material, u32)>> = FxHashMap::default();
        for object in &self.prepared.objects {
            let mut numbers = Vec::with_capacity(object.materials.len());
            for material in &object.materials {
                let alike = known.entry(debug_hash(material)).or_default();
                if let Some((_, number)) = alike.iter().find(|(other, _)| *other == material) {
                    numbers.push(*number);
                    continue;
                }
                let failed = |source| RenderError::Material { object: object.name.clone(), source };
                let diffuse = match self.prepared.settings.light.interreflection {
                    // What radiosity solves is not estimated again.
                    _ if plan.needs(Stage::Radiosity) => Interreflection::Solved,
                    Interreflection::Followed => Interreflection::Followed,
                    _ => Interreflection::LeftOut,
                };
                let number = self.bsdfs.len() as u32;
                self.bsdfs.push(library.bsdf(material, diffuse).map_err(failed)?);
                alike.push((material, number));
                numbers.push(number);
            }
            self.bsdf_of.push(numbers);
        }
        Ok(())
    }

    /// The object, and which material of it, that a source is the light of; none of other lights.
    pub(in crate::render) fn emitter(&self, source: usize) -> Option<(u32, u32)> {
        self.emitters.iter().find(|(_, emitted)| *emitted == source).map(|(emitter, _)| *emitter)
    }

    /// Objects that emit are lights, too; the bodies of lamps emit what these do.
    fn add_emitters(&mut self, plan: &Plan) {
        let prepared = self.prepared;
        for (index, object) in prepared.objects.iter().enumerate().filter(|(index, _)| plan.includes_object(*index)) {
            for (number, bsdf) in self.bsdf_of[index].iter().enumerate() {
                let Some(emission) = &self.bsdfs[*bsdf as usize].emission else { continue };
                let of = |triangle: &u32| prepared.material_number(*triangle) == number as u32;
                let triangles = (object.first..object.first + object.count).filter(of);
                let corners = triangles.map(|triangle| prepared.corners(triangle)).collect();
                if let Some(source) = LightSource::of_triangles(corners, emission.clone()) {
                    self.emitters.push(((index as u32, number as u32), self.sources.len()));
                    self.sources.push((prepared.lights.len() + self.emitters.len() - 1, source));
                }
            }
        }
        for (index, object) in prepared.objects.iter().enumerate() {
            let Some(light) = object.light else { continue };
            if let Some(source) = self.sources.iter().position(|(number, _)| *number == light as usize) {
                self.emitters.push(((index as u32, 0), source));
            }
        }
    }

    /// The material of a number of an object.
    pub(in crate::render) fn bsdf(&self, object: u32, material: u32) -> &Bsdf {
        &self.bsdfs[self.bsdf_of[object as usize][material as usize] as usize]
    }

    /// The medium inside a material of an object, if it is transparent.
    pub(in crate::render) fn interior(&self, object: u32, material: u32) -> Option<&InteriorMedium> {
        self.bsdf(object, material).interior.as_ref()
    }

    /// Of transparent bodies in one place, that of the greatest is there: of the greatest priority; of several with the
    /// same the smallest, and of equally large ones the last of the scene.
    pub(in crate::render) fn rank(&self, object: u32, material: u32) -> (i32, u32) {
        let priority = self.interior(object, material).map_or(0, |interior| interior.priority);
        (priority, self.by_size.get(object as usize).copied().unwrap_or(object))
    }

    /// Radiance where there is nothing: of the skies, or the background without any.
    ///
    /// - `ray`: from where it is seen, of unit length.
    /// - `normal`: of the element from which it is seen, if there is one.
    /// - `part`: MIS weight of a sky that would have sampled the direction with a pdf.
    pub(in crate::render) fn escaped_radiance(
        &self,
        ray: &Ray,
        normal: Option<DVec3>,
        wavelength_set: usize,
        part: impl Fn(&LightSource, f64) -> f64,
    ) -> Channels {
        let skies =
            self.sources.iter().filter_map(|(_, sky)| Some((sky, sky.sky_radiance(ray, normal, wavelength_set)?)));
        let sum = skies.map(|(sky, light_hit)| light_hit.radiance * part(sky, light_hit.pdf)).reduce(|a, b| a + b);
        sum.unwrap_or_else(|| self.background.of(wavelength_set))
    }

    /// The nearest surface that emits and is no object, and which of the lights it is.
    pub(in crate::render) fn intersect_lights(
        &self,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        wavelength_set: usize,
    ) -> Option<(usize, LightHit)> {
        let mut nearest: Option<(usize, LightHit)> = None;
        for (index, (_, source)) in self.sources.iter().enumerate().filter(|(_, (_, source))| source.is_surface()) {
            let limit = nearest.map_or(t_max, |(_, light_hit)| light_hit.t);
            nearest =
                source.intersect(ray, t_min, limit, wavelength_set).map(|light_hit| (index, light_hit)).or(nearest);
        }
        nearest
    }

    /// The radiance that a side of an object emits; which of the lights it is, if any.
    pub(in crate::render) fn emission(
        &self,
        object: u32,
        material: u32,
        is_outside: bool,
        wavelength_set: usize,
    ) -> Option<(Channels, Option<usize>)> {
        let own = self.bsdf(object, material).emission.as_ref();
        if own.is_none() && self.prepared.objects[object as usize].light.is_none() {
            return None;
        }
        let key = (object, material);
        match self.emitters.iter().find(|(emitter, _)| *emitter == key) {
            Some(&(_, index)) => {
                Some((self.sources[index].1.emission_on_object(is_outside, wavelength_set), Some(index)))
            }
            None => own.map(|emission| (emission.of(wavelength_set), None)),
        }
    }
}

/// The place of each object among all of them, the largest first.
fn places_by_size(prepared: &Prepared) -> Vec<u32> {
    let mut order: Vec<u32> = (0..prepared.objects.len() as u32).collect();
    let size = |object: &u32| prepared.objects[*object as usize].bounds.diagonal();
    order.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
    let mut places = vec![0; order.len()];
    for (place, object) in order.into_iter().enumerate() {
        places[object as usize] = place as u32;
    }
    places
}
