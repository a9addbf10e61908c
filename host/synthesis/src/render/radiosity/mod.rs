//! Radiosity: light that goes from diffuse surface to diffuse surface, any number of times, for all views at once.
//!
//! Each side of a triangle that reflects diffusely is a patch. Elements of patches end where surfaces touch, so that
//! none is partly inside of something. They are divided where external light is not linear, next to creases, and where
//! the refinement oracle finds the error bound of their links too large (Hanrahan, Salzman and Aupperle 1991); above
//! them, clusters exchange light that goes far. Form factors are those of unoccluded polygons, times what rays find to
//! be visible; where no triangle is between two elements, no ray is traced. Rows of form factors are then balanced:
//! where nothing escapes, they add up to 1, and stay symmetric. With the light that is then solved for, what comes to
//! the corners of elements is gathered once more, each by its own view, a few times.
//!
//! Many small errors of one sign may add up, where elements see little of each other or of lights. So rays tell what
//! parts of the scene receive, and what elements have is multiplied to agree with that. Through openings that the scene
//! tells of, lights and surfaces are looked for from points of the opening.
//!
//! What pictures do not show is left out: elements are no finer than a part of a pixel, errors of links are bounded by
//! the mean light of the scene and of what pictures show, and may be the greater the less of an element's light comes to
//! pictures.
//!
//! What light cannot come to is left out first: rays join patches that see each other, and only what is joined to a lit
//! one takes part. A closed dark room stays dark to the last bit.
//!
//! *Not modelled*: light that rough mirrors, glass that bends it and gloss pass on; what such surfaces take counts as
//! escaped. Light through coloured surfaces loses as much in all bands as in the mean. What moves stands where it is
//! in the middle of the time. Of spectra, eight bands are known, each 59 nm wide: within a band, light of other
//! surfaces has the same strength everywhere.

mod bound;
mod contact;
mod disjoint_sets;
mod openings;
mod visibility;
mod mirrors;
mod direct;
mod sample_guide;
mod through_openings;
mod side_elements;
mod enclosures;
mod regions;
mod random_light;
mod elements;
mod corners;
mod exchange;
mod correction;
mod refinement;
mod curvature;
mod opening_views;
mod gather;
mod faces;
mod form_factor;
mod node;
mod shortest_edges;
mod face_clusters;
mod hierarchy;
mod shown;
mod importance;
mod report;
mod solver;
mod surface;
mod lit_patches;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod opening_tests;

pub use direct::Exitance;
pub use report::RadiosityReport;
pub use surface::ElementTree;

use super::indirect::{IndirectLight, IrradiancePart};
use super::world::World;
use super::{RenderError, Watch};
use crate::color::Channels;
use crate::plan::{Plan, Stage};
use crate::scene::{Prepared, RadiositySettings};
use crate::stages::stage;
use bound::RefinementBound;
use contact::Contacts;
use corners::ElementCorners;
use correction::{LeafLight, RegionCorrection, mirrored_irradiance};
use curvature::divide_where_light_curves;
use elements::Elements;
use exchange::{Exchange, ExchangeLink, LeafVisibility, OpeningExchange};
use gather::{CornerViews, Gatherer};
use importance::importance;
use node::{RadiosityPatch, normal_and_area};
use refinement::{AssessedLink, refine};
use shortest_edges::ShortestEdges;
use shown::ShownPlaces;
use solver::solve;
use surface::SurfaceLight;
use visibility::VisibilityTester;

/// How often links are assessed with the light that was found.
const ROUNDS: u64 = 3;
/// How often light is gathered once more as each element sees it.
const PASSES: usize = 4;
/// The light of lights may be so many errors from linear over an element.
const BENT: f64 = 4.0;
/// The light of other elements may be so many errors from linear over one.
const CURVED: f64 = 1.0;
/// What receives light counts as no dimmer than this part of the mean irradiance, where errors are bounded by it.
const DIM: f64 = 1e-4;
/// Errors are bounded by no more than so many times the mean irradiance of what pictures show, where the scene is brighter.
const MOST_ABOVE_SHOWN: f64 = 16.0;

/// The light of a scene, for all views.
#[derive(Clone, Debug)]
pub struct Radiosity {
    light: SurfaceLight,
    /// The report of its solution.
    pub report: RadiosityReport,
}

impl Radiosity {
    /// Solves for the light of all surfaces, on the threads of the pool in which it is called. The same bytes for any
    /// number of threads.
    ///
    /// When it is stopped, nothing is divided any more and the light is that of the elements as they are.
    ///
    /// - `world`: of which the plan is.
    ///
    /// # Errors
    /// [`RenderError`], when light grows without end.
    pub fn new(
        world: &World<'_>,
        plan: &Plan,
        settings: &RadiositySettings,
        exitance: Option<Exitance<'_>>,
        watch: &Watch<'_>,
    ) -> Result<Radiosity, RenderError> {
        let stage = stage!("solving for radiosity", (2 * ROUNDS) as f64, "rounds");
        let stopped = || watch.is_cancelled();
        let prepared = world.prepared();
        let mut visibility = VisibilityTester::new(world, watch.memo);
        // Photons are traced from surfaces through mirrors, too.
        visibility.by_mirrors = !plan.needs(Stage::PhotonMap) && mirrors::has_mirrors(world);
        let shadows = plan.needs(Stage::Shadows);
        let diagonal = prepared.bounds.diagonal();
        let edges = ShortestEdges::new(prepared, plan, settings);
        let contacts = Contacts::new(&visibility, diagonal, edges.everywhere, |t| {
            plan.includes_object(prepared.object_of[t as usize] as usize)
        });
        let patches = patches(prepared, plan, &visibility);
        let through = visibility.light_through_openings(shadows);
        let hierarchy =
            lit_patches::lit_hierarchy(&visibility, patches, &contacts, exitance, &through, shadows, &edges);
        if hierarchy.nodes.is_empty() {
            return Ok(Radiosity { light: SurfaceLight::dark(prepared), report: RadiosityReport::default() });
        }
        let mut elements = Elements::new(hierarchy, &visibility, exitance, &through, shadows, &edges);
        let shown = ShownPlaces::new(&visibility, plan, settings);
        let bound =
            |mean: f64, dimmest: f64, shown: f64| RefinementBound { error: settings.error, mean, dimmest, shown };
        elements.divide_where_light_varies(&visibility, bound(elements.mean_irradiance(), 1.0, 0.0), BENT);
        let mut links: Vec<AssessedLink> = Vec::new();
        let mut report = RadiosityReport { patches: elements.hierarchy.patches.len(), ..RadiosityReport::default() };
        let mut leaves = Vec::new();
        let mut at_corners = None;
        for round in 0..ROUNDS {
            // What comes from other elements is not known at first: nothing is too dark then.
            let mean = elements.mean_irradiance();
            let bound = match round {
                0 => bound(mean, 1.0, 0.0),
                // A dim room beside a bright garden is as much to what it shows as to the scene.
                _ => {
                    let shown = shown.irradiance(&visibility, &elements, DIM * mean).unwrap_or(mean);
                    bound((mean * shown).sqrt().min(MOST_ABOVE_SHOWN * shown), DIM, shown)
                }
            };
            if round == 1 {
                // In the first round only lights send light: it is not known yet what brings how much to what is shown.
                elements.find_importance(&visibility, &shown);
            }
            if round > 0 {
                elements.divide_where_light_varies(&visibility, bound, BENT);
            }
            refine(&visibility, &mut elements, &mut links, bound, &stopped);
            stage.progress((2 * round + 1) as f64);
            let is_last = round + 1 == ROUNDS || stopped();
            let curved =
                is_last.then(|| divide_where_light_curves(&visibility, &mut elements, &links, bound, CURVED, &stopped));
            leaves = elements.hierarchy.leaves();
            let sampled = is_last.then(|| elements.sample_direct(&visibility, &leaves));
            let gatherer = Gatherer { visibility: &visibility, elements: &elements, bound };
            let corners = curved.map(|curved| ElementCorners::new(prepared, &elements.hierarchy, &leaves, &curved));
            let views = corners.as_ref().map(|corners| gatherer.views(&links, corners, &leaves));
            let of_views = |views: &CornerViews<'_>| {
                let rows = views.rows();
                lit_patches::leaf_visibility(&visibility, &elements, &leaves, &rows, settings.directions, &stopped)
            };
            let leaf_visibility = views.as_ref().map(of_views).transpose()?;
            if let (Some(sampled), Some(leaf_visibility)) = (sampled, &leaf_visibility) {
                elements.correct_direct(&leaves, &sampled, &leaf_visibility.enclosures);
            }
            let tolerance = if is_last { settings.tolerance } else { 1e-2 };
            let last = leaf_visibility.as_ref().zip(views.as_ref());
            let (irradiance, light) = light(&elements, &links, last, tolerance, &stopped, &mut report)?;
            elements.take(&leaves, &irradiance);
            stage.progress((2 * round + 2) as f64);
            if let (Some(corners), Some(leaf_visibility)) = (corners, leaf_visibility) {
                at_corners = Some((corners, light, leaf_visibility.is_dark));
                break;
            }
        }
        report.elements = leaves.len();
        report.links = links.len();
        let light = match at_corners {
            Some((corners, light, is_dark)) => {
                SurfaceLight::new(prepared, elements, &leaves, &is_dark, &corners, &light)
            }
            None => SurfaceLight::dark(prepared),
        };
        report.seconds = stage.seconds();
        Ok(Radiosity { light, report })
    }

    /// How a side of a triangle is divided into elements; none where no light comes.
    ///
    /// - `outside`: whether it is the outer side.
    pub fn element_tree(&self, triangle: u32, outside: bool) -> Option<ElementTree> {
        self.light.element_tree(triangle, outside)
    }
}

impl IndirectLight for Radiosity {
    fn irradiance(&self, triangle: u32, outside: bool, weights: [f64; 3], part: IrradiancePart) -> Channels {
        self.light.at(triangle, outside, weights, part)
    }
}

/// All sides of triangles that reflect diffusely or send light from elsewhere.
fn patches(prepared: &Prepared, plan: &Plan, visibility: &VisibilityTester<'_>) -> Vec<RadiosityPatch> {
    let appearance = &visibility.world.appearance;
    let sides = |triangle: u32| {
        let object = prepared.object_of[triangle as usize];
        let is_diffuse = || appearance.bsdf(object, prepared.material_number(triangle)).is_diffuse();
        let [a, b, c] = prepared.corners(triangle);
        let takes_part = plan.includes_object(object as usize) && is_diffuse() && normal_and_area([a, b, c]).1 > 0.0;
        let side = |corners, outside| RadiosityPatch { corners, triangle, outside };
        let sides = takes_part.then(|| [side([a, b, c], true), side([a, c, b], false)]);
        sides.into_iter().flatten()
    };
    (0..prepared.triangles.len() as u32).flat_map(sides).collect()
}

/// Solves for the light of the elements as they are, and keeps the books. Tells the irradiance of leaves by other
/// elements, and the last time that at their corners.
fn light(
    elements: &Elements<'_>,
    assessed: &[AssessedLink],
    last: Option<(&LeafVisibility, &CornerViews<'_>)>,
    tolerance: f64,
    stopped: &dyn Fn() -> bool,
    report: &mut RadiosityReport,
) -> Result<(Vec<Channels>, Vec<Channels>), RenderError> {
    let links: Vec<ExchangeLink> = assessed.iter().map(|one| one.link).filter(|link| link.exchange > 0.0).collect();
    let mut exchange = Exchange::new(&elements.hierarchy, &links);
    let leaves = exchange.leaves.clone();
    let of = |values: &[Channels]| -> Vec<Channels> { leaves.iter().map(|leaf| values[*leaf as usize]).collect() };
    let (reflectance, direct, extra) = (of(&elements.reflectance), of(&elements.direct), of(&elements.extra));
    let own = exchange.balance(last.map(|(leaf_visibility, _)| leaf_visibility));
    let first: Vec<Channels> = (0..leaves.len()).map(|i| extra[i] + reflectance[i] * direct[i]).collect();
    let solved = solve(&exchange, &reflectance, &first, tolerance, stopped)?;
    report.steps = solved.steps;
    report.solver_error = solved.error;
    let areas = exchange.areas();
    let rows = exchange.apply(&vec![1.0; areas.len()]);
    let total = |part: &dyn Fn(usize) -> Channels| -> f64 {
        (0..areas.len()).map(|i| part(i).0.iter().sum::<f64>() * areas[i]).sum()
    };
    let all = |i: usize| direct[i] + solved.irradiance[i];
    let sent = |i: usize| extra[i] + reflectance[i] * all(i);
    let exchanged = total(&|i| sent(i) * (rows[i] / areas[i])).max(f64::MIN_POSITIVE);
    report.unbalanced = total(&|i| sent(i) * own[i]) / exchanged;
    report.arrived = total(&|i| direct[i] + extra[i]);
    report.absorbed = total(&|i| (Channels::ONE - reflectance[i]) * all(i));
    report.escaped = total(&|i| sent(i) * (1.0 - rows[i] / areas[i]));
    report.left = report.arrived - report.absorbed - report.escaped;
    let (mut irradiance, mut at_corners) = (solved.irradiance, Vec::new());
    if let Some((leaf_visibility, views)) = last {
        for _ in 0..PASSES {
            let sent = |(i, light): (usize, &Channels)| extra[i] + reflectance[i] * (direct[i] + *light);
            let sent: Vec<Channels> = irradiance.iter().enumerate().map(sent).collect();
            at_corners = views.irradiance(&elements.hierarchy, &leaves, &sent, &exchange.is_closed);
            irradiance = views.means(&at_corners);
            irradiance
                .iter_mut()
                .zip(&leaf_visibility.is_dark)
                .filter(|(_, dark)| **dark)
                .for_each(|(light, _)| *light = Channels::ZERO);
        }
        let mirrored = {
            let light =
                LeafLight { first: &first, reflectance: &reflectance, irradiance: &irradiance, brightness: &[] };
            mirrored_irradiance(&elements.hierarchy, &leaves, leaf_visibility, &light)
        };
        if let Some(mirrored) = mirrored {
            irradiance.iter_mut().zip(&mirrored).for_each(|(light, more)| *light += *more);
            let more = views.at_corners(&mirrored);
            at_corners.iter_mut().zip(&more).for_each(|(light, more)| *light += *more);
        }
        let brightness = elements.brightness_through_openings(&leaves, leaf_visibility, views, &at_corners);
        let light =
            LeafLight { first: &first, reflectance: &reflectance, irradiance: &irradiance, brightness: &brightness };
        let correction = RegionCorrection::new(&elements.hierarchy, &leaves, leaf_visibility, &light);
        (report.correction, report.standard_error) = (correction.change, correction.standard_error);
        let factors = views.at_corners(&correction.factor);
        at_corners.iter_mut().zip(&factors).for_each(|(light, factor)| *light *= *factor);
        irradiance = views.means(&at_corners);
    }
    Ok((irradiance, at_corners))
}

impl Elements<'_> {
    /// The mean irradiance of all elements, or what they send if that is more: W/m².
    fn mean_irradiance(&self) -> f64 {
        (self.direct[0] + self.indirect[0]).max().max(self.extra[0].max())
    }

    /// Finds how important all elements are to what is shown.
    fn find_importance(&mut self, visibility: &VisibilityTester<'_>, shown: &ShownPlaces) {
        let leaves = self.hierarchy.leaves();
        let importance = importance(visibility, self, shown, &leaves);
        self.take_importance(&leaves, &importance);
    }

    /// Of what leaves exchange through openings, how much more than in the mean each of the two sends where the ray ends.
    ///
    /// - `at_corners`: irradiance of each corner by light of others, W/m².
    fn brightness_through_openings(
        &self,
        leaves: &[u32],
        leaf_visibility: &LeafVisibility,
        views: &CornerViews<'_>,
        at_corners: &[Channels],
    ) -> Vec<[f64; 2]> {
        let of = |leaf: u32, at: [f64; 3]| {
            let (number, node) = (leaf as usize, leaves[leaf as usize] as usize);
            if self.hierarchy.nodes[node].is_cluster() {
                return 1.0;
            }
            let corner_light = &self.corner_light[node];
            views.brightness(number, at, |corners| {
                std::array::from_fn(|i| {
                    let irradiance = corner_light[i].direct + at_corners[corners[i] as usize];
                    (corner_light[i].extra + self.reflectance[node] * irradiance).0.iter().sum()
                })
            })
        };
        let through = leaf_visibility.through_openings.iter();
        through.map(|OpeningExchange { link, at }| [of(link.a, at[0]), of(link.b, at[1])]).collect()
    }

    /// Takes up a solution.
    fn take(&mut self, leaves: &[u32], irradiance: &[Channels]) {
        for (leaf, irradiance) in leaves.iter().zip(irradiance) {
            self.indirect[*leaf as usize] = *irradiance;
        }
        self.pull();
    }
}
