//! What pictures show: places by whose light the errors of radiosity are measured.

use super::elements::Elements;
use super::node::NONE;
use super::side_elements::SideElements;
use super::visibility::{RayTarget, VisibilityTester};
use crate::plan::Plan;
use crate::render::world::CameraRays;
use crate::scene::RadiositySettings;

/// Rays into each picture along its longer side, and views at the most that count.
const ALONG: u32 = 32;
const MOST_VIEWS: usize = 8;

/// Places of surfaces that the views of a plan show.
pub(super) struct ShownPlaces(Vec<RayTarget>);

impl ShownPlaces {
    /// The first places that rays into the pictures hit, beyond panes; none where elements are to be the same for all
    /// views.
    pub(super) fn new(visibility: &VisibilityTester<'_>, plan: &Plan, settings: &RadiositySettings) -> ShownPlaces {
        let prepared = visibility.world.prepared();
        let image = &prepared.settings.image;
        let longer = image.width.max(image.height).max(1);
        let along = |side: u32| (u64::from(side) * u64::from(ALONG)).div_ceil(u64::from(longer)).max(1) as u32;
        let (width, height) = (along(image.width), along(image.height));
        let eyes: Vec<CameraRays> = match plan.views() {
            views if views.len() <= MOST_VIEWS && settings.pixels > 0.0 => {
                views.iter().filter_map(|view| CameraRays::new(view, width, height, &prepared.bounds)).collect()
            }
            _ => Vec::new(),
        };
        let of = |eye: &CameraRays| {
            let pixel = |i: u32| [f64::from(i % width) + 0.5, f64::from(i / width) + 0.5];
            let rays = (0..width * height).filter_map(|i| eye.ray(pixel(i), [0.5; 2]));
            rays.map(|bounded| visibility.trace(&bounded.ray)).collect::<Vec<RayTarget>>()
        };
        ShownPlaces(eyes.iter().flat_map(of).filter(|target| matches!(target, RayTarget::Side { .. })).collect())
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
        let found = self.0.iter().map(|target| elements_of_sides.find(*target)).filter(|node| *node != NONE);
        let logarithms: Vec<f64> = found.map(|node| elements.least[node as usize].max(least).ln()).collect();
        let count = logarithms.len() as f64;
        (count > 0.0).then(|| (logarithms.iter().sum::<f64>() / count).exp())
    }
}
