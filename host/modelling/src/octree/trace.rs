//! Ray hits, by the walk of the octree.

use super::prepared_ray::PreparedRay;
use super::settings::Walk;
use super::tree::{Octree, WalkCount};
use super::walk::Search;
use super::{Hit, Ray, descend};

impl Octree {
    /// Finds the nearest hit with `t_min < t < t_max`, both exclusive.
    ///
    /// Either side of a triangle is hit. Edges and corners belong to their triangles, so a closed mesh lets no ray
    /// through; of several hits with the same `t` the triangle with the lowest index counts. A triangle seen exactly
    /// edge-on is not hit. A ray whose direction is zero, or that is not finite, or that begins farther away than
    /// [`MAX_DISTANCE`](super::MAX_DISTANCE) sides of the modelling cube, hits nothing.
    #[inline]
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<Hit> {
        match self.walk {
            Walk::Index => descend::nearest(self, ray, t_min, t_max, &mut WalkCount::default()),
            Walk::LeadingDirection => self.walked(ray, t_min, t_max, false).0,
        }
    }

    /// [`Octree::closest`], with the work that it took.
    pub fn closest_counted(&self, ray: &Ray, t_min: f64, t_max: f64) -> (Option<Hit>, WalkCount) {
        match self.walk {
            Walk::Index => {
                let mut count = WalkCount::default();
                (descend::nearest(self, ray, t_min, t_max, &mut count), count)
            }
            Walk::LeadingDirection => self.walked(ray, t_min, t_max, false),
        }
    }

    /// Gives all hits with `t_min < t < t_max`, in no order, until one is enough; says whether one was.
    ///
    /// A triangle may come more than once where rays go from cell to cell.
    pub fn each_hit(&self, ray: &Ray, t_min: f64, t_max: f64, mut enough: impl FnMut(Hit) -> bool) -> bool {
        match self.walk {
            Walk::Index => descend::each(self, ray, t_min, t_max, enough),
            Walk::LeadingDirection => {
                let mut from = t_min;
                while let Some(hit) = self.closest(ray, from, t_max) {
                    if enough(hit) {
                        return true;
                    }
                    from = hit.t;
                }
                false
            }
        }
    }

    /// Says whether anything is hit with `t_min < t < t_max`.
    #[inline]
    pub fn occluded(&self, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        match self.walk {
            Walk::Index => descend::is_any(self, ray, t_min, t_max),
            Walk::LeadingDirection => self.walked(ray, t_min, t_max, true).0.is_some(),
        }
    }

    fn walked(&self, ray: &Ray, t_min: f64, t_max: f64, any: bool) -> (Option<Hit>, WalkCount) {
        let Some(line) = PreparedRay::new(ray, &self.cube, t_min, t_max) else { return Default::default() };
        let mut search = Search::new(self, &line, t_min, t_max, any);
        search.walk();
        search.found()
    }
}
