//! Colour of the tube: the hue circle of the PS 300, which starts at blue, and saturation, to red, green, blue.

/// Linear light of the tube's red, green and blue primaries for a hue and a saturation, at full value.
///
/// The circle is that of HSV turned by 120 degrees: 0 blue, 60 magenta, 120 red, 180 yellow, 240 green,
/// 300 cyan. The largest of the three is always 1: brightness comes from the intensity of a vector, not
/// from its colour.
///
/// - `hue`: degrees; wraps, so that 0..=720 (a blend that goes round either way) and negative angles are fine.
/// - `saturation`: 0 white, 1 pure; clamped to 0..=1.
/// - A value that is not finite counts as 0.
///
/// # Source
/// Hue circle and value 1: published colour tables of programs for the PS 300 (Kraulis 1990 and others).
/// Hexcone: A. R. Smith 1978. Taking its output as *linear* amounts of the primaries is ours: a calligraphic
/// tube adds light, and no measurement of its guns is at hand. *Not modelled*: the steps of hue and
/// saturation that the tube could resolve.
pub fn rgb(hue: f32, saturation: f32) -> [f32; 3] {
    let hue = if hue.is_finite() { hue } else { 0.0 };
    let saturation = if saturation.is_finite() { saturation.clamp(0.0, 1.0) } else { 0.0 };
    // HSV puts red at 0; rem_euclid can round up to 360 itself for a tiny negative angle.
    let sixth = (f64::from(hue) - 120.0).rem_euclid(360.0) / 60.0;
    let fraction = sixth.fract() as f32;
    let low = 1.0 - saturation;
    let falling = 1.0 - saturation * fraction;
    let rising = 1.0 - saturation * (1.0 - fraction);
    match sixth as u32 {
        0 | 6 => [1.0, rising, low],
        1 => [falling, 1.0, low],
        2 => [low, 1.0, rising],
        3 => [low, falling, 1.0],
        4 => [rising, low, 1.0],
        _ => [1.0, low, falling],
    }
}

/// Hue and saturation of a colour that [`rgb`] made.
///
/// - Returns degrees 0..360 (0 for white) and 0..=1.
pub fn hue_saturation([red, green, blue]: [f32; 3]) -> [f32; 2] {
    let saturation = 1.0 - red.min(green).min(blue);
    if saturation <= 0.0 {
        return [0.0, 0.0];
    }
    let part = |c: f32| (c - (1.0 - saturation)) / saturation;
    let sixths = if red >= 1.0 {
        if green > blue { part(green) } else { -part(blue) }
    } else if green >= 1.0 {
        if blue > red { 2.0 + part(blue) } else { 2.0 - part(red) }
    } else if red > green {
        4.0 + part(red)
    } else {
        4.0 - part(green)
    };
    [(sixths * 60.0 + 120.0).rem_euclid(360.0), saturation]
}

#[cfg(test)]
mod tests {
    use super::{hue_saturation, rgb};

    #[test]
    fn hue_and_saturation_come_back() {
        for hue in 0..360 {
            for saturation in [0.25, 0.5, 1.0] {
                let [h, s] = hue_saturation(rgb(hue as f32, saturation));
                let off = (h - hue as f32).abs();
                assert!(off.min(360.0 - off) < 1e-3 && (s - saturation).abs() < 1e-6, "{hue} {saturation}: {h} {s}");
            }
        }
        assert_eq!(hue_saturation([1.0; 3]), [0.0, 0.0]);
    }

    #[test]
    fn the_six_corners_of_the_circle_are_pure_primaries_and_their_sums() {
        let table = [
            (0.0, [0.0, 0.0, 1.0]),
            (60.0, [1.0, 0.0, 1.0]),
            (120.0, [1.0, 0.0, 0.0]),
            (180.0, [1.0, 1.0, 0.0]),
            (240.0, [0.0, 1.0, 0.0]),
            (300.0, [0.0, 1.0, 1.0]),
            (360.0, [0.0, 0.0, 1.0]),
        ];
        for (hue, expected) in table {
            assert_eq!(rgb(hue, 1.0), expected, "hue {hue}");
        }
    }

    #[test]
    fn saturation_zero_is_white_for_every_hue() {
        for hue in 0..720 {
            assert_eq!(rgb(hue as f32, 0.0), [1.0; 3]);
        }
    }

    #[test]
    fn orange_lies_halfway_between_red_and_yellow() {
        assert_eq!(rgb(150.0, 1.0), [1.0, 0.5, 0.0]);
        assert_eq!(rgb(150.0, 0.5), [1.0, 0.75, 0.5]);
    }

    #[test]
    fn the_circle_repeats_every_turn_and_is_continuous() {
        for step in 0..3600 {
            let hue = step as f32 * 0.1;
            let (here, turned, next) = (rgb(hue, 0.8), rgb(hue + 360.0, 0.8), rgb(hue + 0.1, 0.8));
            for channel in 0..3 {
                assert!((here[channel] - turned[channel]).abs() < 1e-5);
                assert!((here[channel] - next[channel]).abs() < 0.0014 + 1e-5, "jump at {hue}");
            }
            assert_eq!(here.into_iter().fold(0.0, f32::max), 1.0);
        }
    }

    #[test]
    fn values_out_of_range_are_wrapped_clamped_or_zero() {
        assert_eq!(rgb(-60.0, 1.0), rgb(300.0, 1.0));
        assert_eq!(rgb(120.0, 7.0), [1.0, 0.0, 0.0]);
        assert_eq!(rgb(120.0, -7.0), [1.0; 3]);
        assert_eq!(rgb(f32::NAN, 1.0), rgb(0.0, 1.0));
        assert_eq!(rgb(120.0, f32::INFINITY), [1.0; 3]);
        assert_eq!(rgb(119.99999, 1.0).into_iter().fold(0.0, f32::max), 1.0);
    }
}
