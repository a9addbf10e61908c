//! Colours that a display cannot show, mixed with grey until it can.

use crate::color::srgb::LUMINANCE;
use glam::DVec3;

/// The colour mixed with grey of the same luminance, as little as brings each part into 0..=1.
///
/// Hue stays as mixing with white leaves it, and luminance as long as it is within 0..=1.
pub(super) fn fitted(rgb: DVec3) -> DVec3 {
    if rgb.min_element() >= 0.0 && rgb.max_element() <= 1.0 {
        return rgb;
    }
    let grey = rgb.dot(LUMINANCE).clamp(0.0, 1.0);
    let most = |part: f64| match part {
        part if part > 1.0 => (1.0 - grey) / (part - grey),
        part if part < 0.0 => grey / (grey - part),
        _ => 1.0,
    };
    let kept = rgb.to_array().map(most).into_iter().fold(1.0, f64::min);
    (DVec3::splat(grey) + (rgb - grey) * kept).clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_stays_where_a_display_can_show_it() {
        for rgb in [DVec3::new(1.5, 0.2, 0.1), DVec3::new(0.4, -0.1, 0.3), DVec3::new(-0.2, 0.9, 1.8)] {
            let shown = fitted(rgb);
            assert!(shown.min_element() >= 0.0 && shown.max_element() <= 1.0, "{shown}");
            assert!((shown.dot(LUMINANCE) - rgb.dot(LUMINANCE)).abs() < 1e-12, "{shown}");
        }
        assert_eq!(fitted(DVec3::splat(9.0)), DVec3::ONE);
        assert_eq!(fitted(DVec3::new(0.0, -1.0, 0.0)), DVec3::ZERO);
    }
}
