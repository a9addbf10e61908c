//! How short edges of elements may be: a part of the scene, but no less than a part of a pixel that shows them.

use super::node::HierarchyNode;
use crate::plan::Plan;
use crate::scene::{Prepared, RadiositySettings, View};
use glam::{DVec3, DVec4};

/// Of more views, none tells how short edges are.
pub(super) const MOST_VIEWS: usize = 8;

/// The shortest edges of elements: an edge is divided if it is twice as long or longer.
#[derive(Clone, Debug)]
pub(super) struct ShortestEdges {
    /// The shortest of all.
    pub(super) everywhere: f64,
    /// What the pictures show, and from where.
    views: Vec<PixelSize>,
}

/// How large pixels of a view are, by places in the scene.
#[derive(Clone, Copy, Debug)]
struct PixelSize {
    /// The depth of a place: the product of this and its homogeneous coordinates. 1 everywhere in a parallel view.
    depth: DVec4,
    /// The shortest edge at depth 1.
    at_depth: f64,
}

impl PixelSize {
    /// - `pixels`: how many an edge is long, at the least. `shorter_side`: of the picture, in pixels.
    fn of(view: &View, pixels: f64, shorter_side: f64) -> Option<PixelSize> {
        let rows = view.projection()?.to_clip.transpose();
        // The shorter side spans -1..1.
        let at_depth = pixels * 2.0 / (shorter_side * rows.x_axis.truncate().length());
        (at_depth.is_finite() && rows.w_axis.is_finite()).then_some(PixelSize { depth: rows.w_axis, at_depth })
    }

    fn shortest(&self, middle: DVec3, radius: f64) -> f64 {
        let depth = self.depth.dot(middle.extend(1.0)).abs() - radius * self.depth.truncate().length();
        self.at_depth * depth.max(0.0)
    }
}

impl ShortestEdges {
    /// The shortest edges for the views of a plan.
    pub(super) fn new(prepared: &Prepared, plan: &Plan, settings: &RadiositySettings) -> ShortestEdges {
        let everywhere = (settings.finest * prepared.bounds.diagonal()).max(f64::MIN_POSITIVE);
        let image = &prepared.settings.image;
        let shorter_side = f64::from(image.width.min(image.height).max(1));
        let of = |view: &View| PixelSize::of(view, settings.pixels, shorter_side);
        let views = match plan.views() {
            views if views.len() <= MOST_VIEWS && settings.pixels > 0.0 => views.iter().map(of).collect(),
            _ => None,
        };
        ShortestEdges { everywhere, views: views.unwrap_or_default() }
    }

    /// Shortest edges that no picture makes longer.
    #[cfg(test)]
    pub(super) fn everywhere(everywhere: f64) -> ShortestEdges {
        ShortestEdges { everywhere, views: Vec::new() }
    }

    /// The shortest edges of a node.
    pub(super) fn of(&self, node: &HierarchyNode) -> f64 {
        self.at(node.middle, node.radius)
    }

    /// The shortest edges within a radius of a place.
    pub(super) fn at(&self, middle: DVec3, radius: f64) -> f64 {
        let of_views = self.views.iter().map(|view| view.shortest(middle, radius));
        of_views.reduce(f64::min).map_or(self.everywhere, |edge| edge.max(self.everywhere))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::bounds::Bounds;
    use crate::scene::{Camera, Parallel, Scene};

    /// A triangle with the circumradius 1e-3 at a depth before the eye.
    fn at_depth(depth: f64) -> HierarchyNode {
        let corner = |angle: f64| DVec3::new(1e-3 * angle.cos(), 1e-3 * angle.sin(), -depth);
        let corners = [0.0, 2.0, 4.0].map(corner);
        HierarchyNode::triangle(corners, 0)
    }

    #[test]
    fn edges_are_as_long_as_the_pixels_that_show_them_or_as_a_part_of_the_scene() {
        let mut scene = Scene::default();
        let framing = Camera::framing(&Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE });
        let camera = Camera { from: DVec3::ZERO, at: DVec3::NEG_Z, field_of_view: 90.0, ..framing };
        scene.camera = Some(camera);
        (scene.settings.image.width, scene.settings.image.height) = (20, 10);
        let prepared = Prepared::new(&scene).expect("a scene");
        let settings = RadiositySettings { pixels: 0.5, ..RadiositySettings::DEFAULT };
        let edges = |view: View, settings: &RadiositySettings| {
            let edges = ShortestEdges::new(&prepared, &Plan::new(&prepared, &view), settings);
            ShortestEdges { everywhere: 0.05, ..edges }
        };
        // A picture of 10 pixels shows 8 units at a depth of 4.
        let seen = edges(View::Camera(camera), &settings);
        assert!((seen.of(&at_depth(4.0)) - 0.4).abs() < 1e-3);
        assert_eq!(seen.of(&at_depth(0.3)), 0.05);
        let parallel = Parallel { height: 3.0, oblique: glam::DVec2::ZERO };
        let parallel = edges(View::Camera(Camera { parallel: Some(parallel), ..camera }), &settings);
        assert!((parallel.of(&at_depth(7.0)) - 0.15).abs() < 1e-3);
        let whatever = edges(View::Camera(camera), &RadiositySettings { pixels: 0.0, ..settings });
        assert_eq!(whatever.of(&at_depth(4.0)), 0.05);
    }
}
