//! What a pixel spans where a model stands.

use super::{ImageSettings, Settings, View};
use crate::numeric::bounds::Bounds;
use crate::octree::AggregateView;
use crate::procedural::terrain::GroundView;
use glam::{DAffine3, DMat3, DMat4, DVec3};

/// Maps that lengthen all directions alike, but for rounding: the product of their norm and that of the inverse is 1.
const SIMILAR: f64 = 0.999;
/// Width of the cells of a terrain, pixels: its finest waves are a few of them long.
const CELL: f64 = 1.5;

/// From where models are seen, and what a pixel spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetailView {
    /// The eye; none of parallel lines of sight.
    eye: Option<DVec3>,
    /// What a pixel spans: at a distance of 1 from the eye, in the middle of the picture; anywhere where there is no
    /// eye.
    pixel: f64,
    /// How many pixels the detail has.
    detail: f64,
}

impl DetailView {
    /// That of a view in the pictures that settings ask for.
    pub fn new(view: &View, settings: &Settings) -> DetailView {
        let ImageSettings { width, height, .. } = settings.image;
        let to_clip = view.projection().map_or(DMat4::IDENTITY, |projection| projection.to_clip);
        let rows = to_clip.transpose();
        let (x, y, w) = (rows.x_axis, rows.y_axis, rows.w_axis);
        let across = x.truncate().length() * 0.5 * f64::from(width.min(height).max(1));
        let detail = settings.geometry.detail;
        // The eye is where all lines of sight meet.
        let eye = DMat3::from_cols(x.truncate(), y.truncate(), w.truncate()).transpose().inverse()
            * -DVec3::new(x.w, y.w, w.w);
        if eye.is_finite() && w.truncate() != DVec3::ZERO {
            return DetailView { eye: Some(eye), pixel: w.truncate().length() / across, detail };
        }
        DetailView { eye: None, pixel: w.w.abs() / across, detail }
    }

    /// What a pixel spans where a model is placed nearest to the eye, or as many as the detail has, in coordinates of
    /// the model.
    ///
    /// - `bounds`: of the model, in its coordinates.
    pub(super) fn footprint(&self, placement: &DAffine3, bounds: &Bounds) -> f64 {
        let own = self.within(placement);
        let away = own.eye.map_or(1.0, |eye| eye.distance(eye.clamp(bounds.min, bounds.max)));
        away * own.pixel * self.detail
    }

    /// From where what is placed in cells is seen, in coordinates of the cells.
    ///
    /// - `size`: of the largest thing, above 0. `pixels`: how many it spans where aggregates begin to stand in.
    pub(super) fn aggregates(&self, placement: &DAffine3, size: f64, pixels: f64) -> AggregateView {
        let own = self.within(placement);
        match own.eye {
            Some(at) => AggregateView::Eye { at, distance: size / (pixels * own.pixel) },
            None => AggregateView::Parallel { enlargement: pixels * own.pixel / size },
        }
    }

    /// How wide the cells of a terrain are to be, in its coordinates.
    pub(super) fn ground(&self, placement: &DAffine3) -> GroundView {
        let own = self.within(placement);
        let spacing = (CELL * own.pixel * own.detail).max(f64::MIN_POSITIVE);
        match own.eye {
            Some(at) => GroundView::Eye { at, spacing },
            None => GroundView::Everywhere { spacing },
        }
    }

    /// This, in coordinates of what is placed.
    fn within(&self, placement: &DAffine3) -> DetailView {
        let to_own = placement.inverse();
        let norm = |map: &DMat3| map.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        let [there, back] = [norm(&placement.matrix3), norm(&to_own.matrix3)];
        // Along the direction that is lengthened the most, a pixel spans less.
        let alike = 3.0 / (there * back);
        let least = if alike > SIMILAR { 1.0 } else { alike * alike };
        match self.eye {
            Some(eye) => DetailView { eye: Some(to_own.transform_point3(eye)), pixel: self.pixel * least, ..*self },
            None => DetailView { pixel: self.pixel * back / 3f64.sqrt() * least, ..*self },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Parallel};
    use glam::DQuat;

    fn camera() -> Camera {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::ONE };
        let (from, at) = (DVec3::new(3.0, 4.0, 5.0), DVec3::new(3.0, 4.0, -5.0));
        Camera { from, at, field_of_view: 90.0, ..Camera::framing(&bounds) }
    }

    #[test]
    fn a_pixel_spans_as_much_as_the_model_is_far_whatever_its_own_units_are() {
        let view = DetailView::new(&View::Camera(camera()), &Settings::of_size(640, 480, 1));
        let bounds = Bounds { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) };
        for scale in [1e-6, 1.0, -2.0, 1e6] {
            let size = f64::abs(scale);
            let at = DVec3::new(3.0, 4.0, 5.0 - 10.0 * size);
            let turn = DMat3::from_quat(DQuat::from_rotation_z(0.7));
            let placement = DAffine3 { matrix3: turn * scale, translation: at };
            // 9.5 sizes of the model away, where 480 pixels span twice as much.
            let found = view.footprint(&placement, &bounds);
            assert!((found / (9.5 * 2.0 / 480.0) - 1.0).abs() < 1e-6, "{scale}: {found}");
        }
        let within = DAffine3::from_translation(DVec3::new(3.0, 4.0, 5.0));
        assert!(view.footprint(&within, &bounds) < 1e-9, "the eye is in its box");
    }

    #[test]
    fn a_stretched_model_is_made_for_its_most_stretched_direction() {
        let view = DetailView::new(&View::Camera(camera()), &Settings::of_size(640, 480, 1));
        let bounds = Bounds { min: DVec3::splat(-1e-6), max: DVec3::splat(1e-6) };
        let placement = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::new(1.0, 1.0, 8.0)),
            translation: DVec3::new(3.0, 4.0, -5.0),
        };
        let pixel = 10.0 * 2.0 / 480.0;
        let found = view.footprint(&placement, &bounds);
        assert!(found <= pixel / 8.0 * 1.5 && found > 0.0, "{found} for {pixel}");
    }

    #[test]
    fn a_parallel_view_spans_the_same_everywhere() {
        let parallel = Some(Parallel { height: 12.0, oblique: glam::DVec2::ZERO });
        let view = DetailView::new(&View::Camera(Camera { parallel, ..camera() }), &Settings::of_size(640, 480, 1));
        let bounds = Bounds { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) };
        for at in [DVec3::ZERO, DVec3::new(1.0, 2.0, -300.0)] {
            let placement = DAffine3 { matrix3: DMat3::IDENTITY * 2.0, translation: at };
            let found = view.footprint(&placement, &bounds);
            assert!((found - 12.0 / 480.0 / 2.0).abs() < 1e-9, "{found}");
        }
    }
}
