//! Portals: openings through which skies are sampled, so that fewer samples are lost on walls.

use super::LightShape;
use super::light_shape::ShapeSample;
use crate::numeric::ray::Ray;
use glam::DVec3;

/// The part of the directions to a sky that are sampled through portals, where a point is on their inner side. The
/// others are sampled over the whole sky: what comes in elsewhere, or is seen by a mirror, stays right, and no
/// direction counts more than 1 / (1 - this part) times what it did.
const PART: f64 = 0.8;

/// Rectangles through which points on their inner sides are lit by a sky: directions are sampled towards them, whatever
/// else of the sky is bright.
///
/// # Source
/// After Bitterli, Novák and Jarosz 2015, "Portal-masked environment map sampling", with rectangles sampled evenly by
/// solid angle in the place of the map that is rectified for each portal.
#[derive(Clone, Debug, Default)]
pub(super) struct Portals(Vec<LightShape>);

impl Portals {
    /// - `rectangles`: each one's normal, across x up, points inwards.
    pub(super) fn new(rectangles: &[LightShape]) -> Portals {
        Portals(rectangles.to_vec())
    }

    /// A direction, and whether it goes through a portal: then sampled as evenly as the rectangle fills the view of the
    /// point; otherwise the two numbers are to choose another direction.
    ///
    /// - `uniform`: a point of the unit square.
    pub(super) fn sample(&self, point: DVec3, [x, y]: [f64; 2]) -> PortalChoice {
        let count = self.before(point).count();
        match x / PART {
            _ if count == 0 => PortalChoice::Anywhere([x, y]),
            part if part < 1.0 => {
                let number = (part * count as f64) as usize;
                let uniform = [part * count as f64 - number as f64, y];
                let drawn = self.before(point).nth(number).and_then(|portal| portal.sample(point, uniform));
                drawn.map_or(PortalChoice::None, |ShapeSample { towards, .. }| PortalChoice::Through(towards))
            }
            _ => PortalChoice::Anywhere([(x - PART) / (1.0 - PART), y]),
        }
    }

    /// The pdf of a direction, 1/sr.
    ///
    /// - `anywhere`: its pdf over the whole sky, 1/sr.
    pub(super) fn pdf(&self, point: DVec3, towards: DVec3, anywhere: f64) -> f64 {
        let ray = Ray { origin: point, direction: towards };
        let (mut count, mut sum) = (0, 0.0);
        for portal in self.before(point) {
            count += 1;
            let met = portal.intersect(&ray, 0.0, f64::INFINITY);
            sum += met.map_or(0.0, |(distance, _)| portal.pdf(point, towards, distance));
        }
        if count == 0 { anywhere } else { PART * sum / f64::from(count) + (1.0 - PART) * anywhere }
    }

    /// The portals on whose inner side a point is.
    fn before(&self, point: DVec3) -> impl Iterator<Item = &LightShape> {
        self.0.iter().filter(move |portal| portal.is_before(point))
    }
}

/// The choice of portals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PortalChoice {
    /// A direction through one of them, unit length.
    Through(DVec3),
    /// The whole sky, by these two numbers.
    Anywhere([f64; 2]),
    /// Nothing: the rectangle is too small to be seen.
    None,
}
