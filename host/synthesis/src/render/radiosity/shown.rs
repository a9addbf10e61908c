//! What pictures show: places by whose light the errors of radiosity are measured.

use super::elements::Elements;
use super::node::NONE;
use super::shortest_edges::MOST_VIEWS;
use super::side_elements::SideElements;
use super::visibility::{RayTarget, VisibilityTester};
use crate::plan::{Plan, Stage};
use crate::render::world::{CameraRays, World};
use crate::scene::{RadiositySettings, View};
use glam::{DMat4, DVec3};

/// Rays into each picture along its longer side.
const ALONG: u32 = 32;

/// Places of surfaces that the views of a plan show.
pub(super) struct ShownPlaces {
    /// The first places that rays into the pictures hit, beyond panes; none where elements are to be the same for all
    /// views.
    places: Vec<RayTarget>,
    views: Vec<ShownView>,
    /// Whether views show no more than what is straight before them.
    are_all: bool,
}

/// A view with its rays.
struct ShownView {
    to_clip: DMat4,
    rays: CameraRays,
    /// Pixels along its sides.
    sides: [u32; 2],
}

impl ShownView {
    fn new(view: &View, sides: [u32; 2], visibility: &VisibilityTester<'_>) -> Option<ShownView> {
        let rays = CameraRays::new(view, sides[0], sides[1], &visibility.world.prepared().bounds)?;
        Some(ShownView { to_clip: view.projection()?.to_clip, rays, sides })
    }

    /// What the ray through the middle of each pixel hits.
    fn places(&self, visibility: &VisibilityTester<'_>) -> impl Iterator<Item = RayTarget> {
        let [width, height] = self.sides;
        let pixel = move |i: u32| [f64::from(i % width) + 0.5, f64::from(i / width) + 0.5];
        let hit = move |i: u32| Some(visibility.trace(&self.rays.ray(pixel(i), [0.5; 2])?.ray));
        (0..width * height).filter_map(hit).filter(|target| matches!(target, RayTarget::Side { .. }))
    }

    /// What the ray hits that goes to a place; none where that is out of the picture, or its back is seen.
    fn target(&self, visibility: &VisibilityTester<'_>, [at, normal]: [DVec3; 2]) -> Option<RayTarget> {
        let clip = self.to_clip * at.extend(1.0);
        let pixel = self.rays.pixel([clip.x / clip.w, clip.y / clip.w]);
        let is_within = |i: usize| (-1.0..=f64::from(self.sides[i]) + 1.0).contains(&pixel[i]);
        if !(clip.w > 0.0 && is_within(0) && is_within(1)) {
            return None;
        }
        let ray = self.rays.ray(pixel, [0.5; 2])?.ray;
        (ray.direction.dot(normal) < 0.0).then(|| visibility.trace(&ray))
    }
}

impl ShownPlaces {
    pub(super) fn new(visibility: &VisibilityTester<'_>, plan: &Plan, settings: &RadiositySettings) -> ShownPlaces {
        let image = &visibility.world.prepared().settings.image;
        let longer = image.width.max(image.height).max(1);
        let along = |side: u32| (u64::from(side) * u64::from(ALONG)).div_ceil(u64::from(longer)).max(1) as u32;
        let sides = [along(image.width), along(image.height)];
        let views: Vec<ShownView> = match plan.views() {
            views if views.len() <= MOST_VIEWS && settings.pixels > 0.0 => {
                views.iter().filter_map(|view| ShownView::new(view, sides, visibility)).collect()
            }
            _ => Vec::new(),
        };
        let places = views.iter().flat_map(|view| view.places(visibility)).collect();
        // Mirrors may show anything, and what moves uncovers what is behind it.
        let are_all = !views.is_empty() && !plan.needs(Stage::Motion) && !continues_rays(visibility.world, plan);
        ShownPlaces { places, views, are_all }
    }

    /// The first places that rays into the pictures hit.
    pub(super) fn places(&self) -> &[RayTarget] {
        &self.places
    }

    /// Whether all that pictures show is known.
    pub(super) fn are_all(&self) -> bool {
        self.are_all
    }

    /// What rays of the pictures hit that go to a place, of which a picture shows the front.
    ///
    /// - `place`: with its unit normal.
    pub(super) fn targets(
        &self,
        visibility: &VisibilityTester<'_>,
        place: [DVec3; 2],
    ) -> impl Iterator<Item = RayTarget> {
        self.views.iter().filter_map(move |view| view.target(visibility, place))
    }

    /// The geometric mean of the irradiance that is shown: of bright and dim places, neither hides the other. None where
    /// nothing of elements is shown.
    ///
    /// - `least`: places count as no dimmer, W/m².
    pub(super) fn irradiance(
        &self,
        visibility: &VisibilityTester<'_>,
        elements: &Elements<'_>,
        least: f64,
    ) -> Option<f64> {
        let elements_of_sides = SideElements::new(visibility, &elements.hierarchy);
        let found = self.places.iter().map(|target| elements_of_sides.find(*target)).filter(|node| *node != NONE);
        let logarithms: Vec<f64> = found.map(|node| elements.least[node as usize].max(least).ln()).collect();
        let count = logarithms.len() as f64;
        (count > 0.0).then(|| (logarithms.iter().sum::<f64>() / count).exp())
    }
}

/// Whether rays go on from some surface of a plan, by reflection or refraction.
fn continues_rays(world: &World<'_>, plan: &Plan) -> bool {
    let objects = world.prepared().objects.iter().enumerate();
    objects.filter(|(object, _)| plan.includes_object(*object)).any(|(object, of)| {
        (0..of.materials.len() as u32).any(|material| world.appearance.bsdf(object as u32, material).continues_paths())
    })
}
