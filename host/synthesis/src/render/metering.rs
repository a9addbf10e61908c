//! The exposure meter: how many stops make a scene come out well.
//!
//! A pilot picture of few pixels and samples, always the same ones, is rendered of each view that is metered. The meter
//! sees the luminances of its pixels; lamps in sight do not count, and the sky only where there is nothing else. The
//! scene alone decides: the size of the picture, its seed and its samples do not, so that parts and previews of a
//! picture are exposed as the whole is.
//!
//! # Source
//! Reinhard 2003, *Parameter estimation for photographic tone reproduction*: the mean of the logarithms goes to a key
//! that tells light scenes from dark ones. *Ours*: the key differs by half as much, the middle of the picture counts
//! more than its corners, darkest and brightest are means over a tenth of the pixels, and the brightest pixels are not
//! led beyond the white of the tone curve as long as the rest does not become too dark.

use super::tally::Tally;
use super::{Film, RenderError, RenderOrder, Renderer, Watch};
use crate::color::srgb::LUMINANCE;
use crate::picture::display::{DisplayTransform, Exposure, MIDDLE_GREY, Tone};
use crate::picture::{Filter, Picture};
use crate::scene::{Prepared, PreparedObject, Settings, View};
use crate::stages::stage;
use glam::DVec3;
use std::num::NonZeroUsize;

/// Pixels along the shorter side of a pilot picture.
const SIDE: u32 = 64;
/// Samples in each of its pixels.
const SAMPLES: u32 = 8;
/// Seed of a pilot picture.
const SEED: u64 = 1;
/// Longer sides of pilot pictures are so many times the shorter one at most.
const MOST_ASPECT: u32 = 4;
/// The part of the pixels whose mean counts as dark, and as bright: means do not jump when something comes into sight.
const TAIL: f64 = 0.1;
/// Stops from dark to bright below which a scene is even, and neither light nor dark.
const LEAST_RANGE: f64 = 2.0;
/// Darker pixels than by so many stops below the brightest ones count as if they were as bright as that.
const MOST_RANGE: f64 = 9.0;
/// By how many stops the key of light and dark scenes differs from middle grey at most.
const KEY_RANGE: f64 = 1.0;
/// How much less than the middle the corners of a picture count in the mean.
const CORNER_LOSS: f64 = 0.75;
/// The part of the pixels that may come out brighter than white.
const CLIPPED: f64 = 0.005;
/// Stops by which the rest comes out darker at most, so that no more pixels do.
const HELD_BACK: f64 = 2.0;

/// Meters a scene from one view or several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meter {
    width: u32,
    height: u32,
    display: DisplayTransform,
    threads: Option<NonZeroUsize>,
}

impl Meter {
    /// - `settings`: of the scene, whose width and height tell the sides of its pictures, whatever size they are made
    ///   in.
    /// - `display`: how pictures are shown. `threads`: as in [`RenderOrder`].
    pub fn new(settings: &Settings, display: &DisplayTransform, threads: Option<NonZeroUsize>) -> Meter {
        let shorter = settings.image.width.min(settings.image.height).max(1);
        let side = |side: u32| {
            let scaled = f64::from(side) / f64::from(shorter) * f64::from(SIDE);
            (scaled.round() as u32).min(SIDE * MOST_ASPECT)
        };
        Meter { width: side(settings.image.width), height: side(settings.image.height), display: *display, threads }
    }

    /// The exposure of pictures, stops: that which the display transform sets, or what the meter finds. Where there is
    /// no light in sight, or the work is stopped, the meter finds 0.
    ///
    /// - `renderer`: that of the pictures. `prepared`: the scene that it renders.
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn stops(
        &self,
        renderer: &dyn Renderer,
        prepared: &Prepared,
        views: &[View],
        watch: &Watch<'_>,
    ) -> Result<f64, RenderError> {
        let compensation = match self.display.exposure {
            Exposure::Auto { compensation } => compensation,
            Exposure::Stops(stops) => return Ok(stops),
        };
        let _stage = stage!("metering the exposure", opaque);
        let order = RenderOrder {
            width: self.width,
            height: self.height,
            samples: SAMPLES,
            footprints: SAMPLES,
            filter: Filter::Box,
            seed: SEED,
            threads: self.threads,
            ..RenderOrder::of(&prepared.settings)
        };
        let mut seen = MeteredPixels::default();
        for view in views {
            let pilot = renderer.render(view, &order, &watch.without_memo())?;
            if !pilot.complete {
                return Ok(0.0);
            }
            seen.add_film(&pilot.film, prepared);
        }
        Ok(seen.stops(self.display.tone).unwrap_or_default() + compensation)
    }
}

/// The exposure, stops, of a picture of which no scene is known: lamps in sight count as surfaces do. 0 if it is black.
///
/// - `tone`: the curve with which it is shown.
pub fn stops_of_picture(picture: &Picture, tone: Tone) -> f64 {
    let mut seen = MeteredPixels::default();
    for (pixel, weight) in picture.pixels().iter().zip(weights(picture.width(), picture.height())) {
        let light = DVec3::from(pixel.radiance.map(f64::from));
        seen.add(light, weight, if pixel.coverage > 0.0 { PixelTarget::Surface } else { PixelTarget::Sky });
    }
    seen.stops(tone).unwrap_or_default()
}

/// The target of a pixel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PixelTarget {
    Surface,
    /// There is nothing.
    Sky,
}

/// The light of one pixel.
#[derive(Clone, Copy)]
struct Metered {
    luminance: f64,
    /// How much it counts in the mean.
    weight: f64,
}

/// How much each pixel of a picture counts, row by row.
fn weights(width: u32, height: u32) -> impl Iterator<Item = f64> {
    let from_middle = |at: u32, count: u32| (2.0 * f64::from(at) + 1.0) / f64::from(count) - 1.0;
    let weight = move |x, y| 1.0 - CORNER_LOSS * (from_middle(x, width).powi(2) + from_middle(y, height).powi(2)) / 2.0;
    (0..height).flat_map(move |y| (0..width).map(move |x| weight(x, y)))
}

/// Brightness of the pixels of pilot pictures, but for those that see lamps.
#[derive(Default)]
struct MeteredPixels {
    surfaces: Vec<Metered>,
    sky: Vec<Metered>,
    /// The brightest band of each.
    brightest: Vec<f64>,
}

impl MeteredPixels {
    fn add(&mut self, light: DVec3, weight: f64, sight: PixelTarget) {
        let place = if sight == PixelTarget::Sky { &mut self.sky } else { &mut self.surfaces };
        place.push(Metered { luminance: light.dot(LUMINANCE), weight });
        self.brightest.push(light.max_element());
    }

    fn add_film(&mut self, film: &Film, prepared: &Prepared) {
        let is_lamp = |tally: &Tally| {
            let [object, material] = tally.first_ids;
            let object = prepared.objects.get(object as usize);
            let emits = |object: &PreparedObject| {
                let material = object.materials.get(material as usize);
                prepared.is_lit_lamp(object) || material.is_some_and(|material| !material.emission.is_black())
            };
            // A lamp that is no object is covered, but is no element.
            (tally.elements as f32) < tally.covered || object.is_some_and(emits)
        };
        for (tally, weight) in film.tallies().iter().zip(weights(film.width(), film.height())) {
            if tally.covered == 0.0 {
                self.add(tally.mean(), weight, PixelTarget::Sky);
            } else if !is_lamp(tally) {
                self.add(tally.mean(), weight, PixelTarget::Surface);
            }
        }
    }

    /// The exposure, stops; none if there is no light in sight.
    fn stops(mut self, tone: Tone) -> Option<f64> {
        let is_lit = |metered: &Metered| metered.luminance > 0.0;
        let counted = [self.surfaces, self.sky].into_iter().find(|all| all.iter().any(is_lit))?;
        let counted: Vec<(f64, f64)> = counted
            .iter()
            .filter(|metered| is_lit(metered))
            .map(|metered| (metered.luminance.log2(), metered.weight))
            .collect();
        let mut sorted: Vec<f64> = counted.iter().map(|(stops, _)| *stops).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let tail = ((sorted.len() as f64 * TAIL) as usize).max(1);
        let mean_of = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let bright = mean_of(&sorted[sorted.len() - tail..]);
        let least = bright - MOST_RANGE;
        let dark = mean_of(&sorted[..tail]).max(least);
        let weighted = counted.iter().map(|(stops, weight)| stops.max(least) * weight).sum::<f64>();
        let mean = weighted / counted.iter().map(|(_, weight)| weight).sum::<f64>();
        let key = KEY_RANGE * (2.0 * mean - dark - bright) / (bright - dark).max(LEAST_RANGE);
        let well = MIDDLE_GREY.log2() + key - mean;
        let most = tone.white().log2() - at(&mut self.brightest, 1.0 - CLIPPED).log2();
        Some(well.min(most.max(well - HELD_BACK)))
    }
}

/// The number below which a part of the numbers lies.
fn at(numbers: &mut [f64], part: f64) -> f64 {
    let place = ((numbers.len() - 1) as f64 * part).round() as usize;
    *numbers.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stops(surfaces: &[f64], sky: &[f64], tone: Tone) -> Option<f64> {
        let mut seen = MeteredPixels::default();
        surfaces.iter().for_each(|light| seen.add(DVec3::splat(*light), 1.0, PixelTarget::Surface));
        sky.iter().for_each(|light| seen.add(DVec3::splat(*light), 1.0, PixelTarget::Sky));
        seen.stops(tone)
    }

    #[test]
    fn an_even_scene_comes_out_middle_grey() {
        for light in [1e-6, 0.18, 5e4] {
            let found = stops(&[light; 100], &[], Tone::Filmic).expect("light");
            assert!((light * found.exp2() / MIDDLE_GREY - 1.0).abs() < 1e-9, "{light}: {found}");
        }
    }

    #[test]
    fn the_sky_counts_where_there_is_nothing_else() {
        let dark = stops(&[0.02; 50], &[1.0; 50], Tone::Filmic);
        assert!(dark == stops(&[0.02; 50], &[], Tone::Filmic) && dark > stops(&[0.2; 50], &[1.0; 50], Tone::Filmic));
        assert_eq!(stops(&[], &[20.0; 50], Tone::Filmic), stops(&[20.0; 50], &[], Tone::Filmic));
        assert_eq!([stops(&[], &[], Tone::Filmic), stops(&[0.0; 9], &[0.0], Tone::Filmic)], [None, None]);
    }

    #[test]
    fn light_scenes_come_out_lighter_and_nothing_beyond_white() {
        let of = |low: usize| [vec![0.05; low], vec![0.8; 100 - low]].concat();
        let mean = |all: &[f64], stops: f64| all.iter().map(|light| light.log2() + stops).sum::<f64>() / 100.0;
        let [light, dark] = [of(20), of(80)].map(|all| mean(&all, stops(&all, &[], Tone::Filmic).expect("light")));
        assert!(light > MIDDLE_GREY.log2() && MIDDLE_GREY.log2() > dark, "{light} {dark}");
        let bright = [vec![0.1; 90], vec![4.0; 10]].concat();
        for tone in [Tone::Linear, Tone::Filmic, Tone::Reinhard] {
            let found = stops(&bright, &[], tone).expect("light");
            assert!(4.0 * found.exp2() <= tone.white() * (1.0 + 1e-9), "{tone:?}");
        }
        let window = |light: f64| stops(&[0.1; 90], &[light; 10], Tone::Filmic);
        assert_eq!(window(1e3), window(1e9), "the room does not become black");
    }
}
