//! External light of elements: straight from lights, and by exitance from elsewhere.

use super::node::{HierarchyNode, RadiosityPatch};
use super::visibility::VisibilityTester;
use crate::color::Channels;
use crate::illumination::light::LightSource;
use crate::numeric::ray::Ray;
use crate::numeric::sequence::SobolSequence;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Exitance from elsewhere at a point of a side of a triangle, W/m², in lanes that are means over all wavelength sets:
/// light that surfaces send beside what they reflect of lights and of each other, such as the photons that two-way ray
/// tracing stores, times their reflectance.
///
/// Told the triangle, whether it is its outer side, and the point. It is asked at points next to the corners of
/// elements and to the middles of their edges, from many threads, and elements are divided where it is not linear
/// between them, down to the finest: what is smaller than
/// [`RadiositySettings::finest`](crate::scene::RadiositySettings) is to be spread over that much before. Light of it
/// that other surfaces send back is in the irradiance of the solution; it itself is not.
pub type Exitance<'a> = &'a (dyn Fn(u32, bool, DVec3) -> Channels + Sync);

/// Length of a shadow ray to a triangle that emits, over the distance, so that it does not hit the triangle.
const SHORT: f64 = 1.0 - 1e-7;
/// Light samples of a light with a size, and directions to a sky, at the least.
const LEAST_SAMPLES: u32 = 16;
const LEAST_OF_SKY: u32 = 64;
/// Light samples of a light, and directions to a sky, for elements that are not divided: neighbours make up for chance
/// in one.
const FEW_SAMPLES: u32 = 4;
const FEW_OF_SKY: u32 = 16;

/// Times as many where some are hidden and some are not.
const MORE: u32 = 4;
/// How far points are from the corners and edges of an element, as a part of the way to its middle: on an edge may lie
/// another surface.
const INWARDS: f64 = 1e-3;

/// External light at a point of an element: what comes from elsewhere than other elements, W/m². In spectra, lanes are
/// means over all wavelength sets.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct ExternalLight {
    /// Irradiance straight from lights.
    pub(super) direct: Channels,
    /// Exitance from elsewhere.
    pub(super) extra: Channels,
}

/// What one light sample brings to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightAtPoint {
    /// W/m², the mean over all wavelength sets.
    pub(super) irradiance: Channels,
    /// Towards the light, unit length, and how far it is; infinite for light from infinitely far away.
    pub(super) towards: DVec3,
    pub(super) distance: f64,
}

/// External light at the three corners of an element; of one that may be divided also at the middles of the edges from
/// each to the next. Nothing for clusters.
pub(super) type CornerLight = Box<[ExternalLight]>;

/// The corners of each quarter among them.
const OF_QUARTERS: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [4, 5, 3]];

/// External light at the corners of the parts into which a node is divided.
///
/// - `sliver`: as [`HierarchyNode::sliver`] has it.
pub(super) fn of_parts(around: &CornerLight, sliver: Option<usize>) -> Vec<Option<[ExternalLight; 3]>> {
    let of = |places: [usize; 3]| (around.len() == 6).then(|| places.map(|place| around[place]));
    match sliver {
        Some(edge) => {
            let [a, b, c] = [0, 1, 2].map(|i| (edge + i) % 3);
            vec![of([a, 3 + edge, c]), of([3 + edge, b, c])]
        }
        None => OF_QUARTERS.map(of).to_vec(),
    }
}

/// A weighted sum of the external light at some places.
fn sum(of: &[ExternalLight], weight: f64) -> ExternalLight {
    let sum =
        |part: fn(&ExternalLight) -> Channels| of.iter().fold(Channels::ZERO, |sum, lit| sum + part(lit)) * weight;
    ExternalLight { direct: sum(|lit| lit.direct), extra: sum(|lit| lit.extra) }
}

/// Error in the middle of an edge if external light is taken for linear, W/m² at the most.
pub(super) fn bend(around: &CornerLight) -> f64 {
    let Some((corners, middles)) = around.split_at_checked(3) else { return 0.0 };
    let off = |(i, middle): (usize, &ExternalLight)| {
        let of = |part: fn(&ExternalLight) -> Channels| {
            let linear = (part(&corners[i]) + part(&corners[(i + 1) % 3])) * 0.5;
            (part(middle) - linear).map(f64::abs).max()
        };
        of(|lit| lit.direct).max(of(|lit| lit.extra))
    };
    middles.iter().enumerate().map(off).fold(0.0, f64::max)
}

/// The greatest difference of external light between corners, W/m².
pub(super) fn spread(around: &CornerLight) -> f64 {
    let of = |part: fn(&ExternalLight) -> Channels| {
        let corners = || around.iter().take(3).map(|lit| part(lit).max());
        corners().fold(0.0, f64::max) - corners().reduce(f64::min).unwrap_or(0.0)
    };
    of(|lit| lit.direct).max(of(|lit| lit.extra))
}

impl VisibilityTester<'_> {
    /// External light of an element, and its mean, which is exact for what is quadratic over an element that may be
    /// divided, and for what is linear over a part of one. A small patch is sampled in its middle only.
    ///
    /// - `corners`: what is known already. `may_be_divided`: whether it is longer than the finest.
    pub(super) fn external_light(
        &self,
        patch: &RadiosityPatch,
        node: &HierarchyNode,
        corners: Option<[ExternalLight; 3]>,
        exitance: Option<Exitance<'_>>,
        shadows: bool,
        may_be_divided: bool,
    ) -> (CornerLight, ExternalLight) {
        if node.is_dark {
            let places = if may_be_divided { 6 } else { 3 };
            return (vec![ExternalLight::default(); places].into(), ExternalLight::default());
        }
        let at = |point: DVec3| {
            let point = point + (node.middle - point) * INWARDS;
            let extra = self.exitance(patch, point, exitance);
            let direct = match may_be_divided {
                true => self.light_at([point, node.normal], shadows),
                false => self.light_roughly([point, node.normal], shadows, 0),
            };
            ExternalLight { direct, extra }
        };
        if may_be_divided {
            let [a, b, c] = corners.unwrap_or_else(|| node.corners.map(at));
            let [p, q, r] = node.corners;
            let middles = [0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)].map(at);
            let [ab, bc, ca] = middles;
            return (Box::new([a, b, c, ab, bc, ca]), sum(&middles, 1.0 / 3.0));
        }
        let middle = at(node.middle);
        match corners {
            Some(corners) => {
                let [a, b, c] = corners;
                (Box::new(corners), sum(&[a, b, c, middle], 0.25))
            }
            None => (Box::new([middle; 3]), middle),
        }
    }

    /// Exitance from elsewhere at a point of a patch, in the lanes that there are.
    pub(super) fn exitance(&self, patch: &RadiosityPatch, point: DVec3, exitance: Option<Exitance<'_>>) -> Channels {
        let lanes = self.world.appearance.wavelengths.lanes();
        let extra = exitance.map_or(Channels::ZERO, |of| of(patch.triangle, patch.outside, point));
        Channels(std::array::from_fn(|lane| if lane < lanes { extra.0[lane] } else { 0.0 }))
    }

    /// The irradiance at a point of an element.
    pub(super) fn light_at(&self, place: [DVec3; 2], shadows: bool) -> Channels {
        self.light_by(place, shadows, ([LEAST_SAMPLES, LEAST_OF_SKY], 0))
    }

    /// Whether there is any irradiance at a point of an element.
    pub(super) fn is_lit_at(&self, place: [DVec3; 2], shadows: bool) -> bool {
        let sources = &self.world.appearance.sources;
        let is_lit_by = |index: usize| {
            let (number, source) = &sources[index];
            let sequence = SobolSequence::new(0, *number as u64);
            (0..self.samples_of(source, [LEAST_SAMPLES, LEAST_OF_SKY])).any(|sample| {
                let light = self.sample_light(place, index, sequence.point(sample, 0), shadows);
                light.is_some_and(|light| light.irradiance.max() > 0.0)
            })
        };
        (0..sources.len()).any(is_lit_by)
    }

    /// How many light samples a source is asked for.
    ///
    /// - `least`: of a light with a size, and of a sky.
    fn samples_of(&self, source: &LightSource, [of_light, of_sky]: [u32; 2]) -> u32 {
        let least = self.world.appearance.prepared.settings.light.samples;
        match source.is_delta() {
            true => 1,
            false if source.is_sky() => least.max(of_sky),
            false => least.max(of_light),
        }
    }

    /// The irradiance at a point of an element, by few light samples.
    ///
    /// - `turn`: which of several sets of samples.
    pub(super) fn light_roughly(&self, place: [DVec3; 2], shadows: bool, turn: u32) -> Channels {
        self.light_by(place, shadows, ([FEW_SAMPLES, FEW_OF_SKY], turn))
    }

    fn light_by(&self, [point, normal]: [DVec3; 2], shadows: bool, (least, turn): ([u32; 2], u32)) -> Channels {
        let appearance = &self.world.appearance;
        let mut sum = Channels::ZERO;
        for (index, (number, source)) in appearance.sources.iter().enumerate() {
            let mut samples = self.samples_of(source, least);
            let most = if source.is_delta() || source.is_sky() { samples } else { MORE * samples };
            let (mut asked, mut seen) = (0, 0);
            // The same points of a light for all elements: their light differs as smoothly as they do.
            let sequence = SobolSequence::new(0, *number as u64);
            let mut part = Channels::ZERO;
            let mut sample = 0;
            let first = turn * most;
            while sample < samples {
                let uniform = sequence.point(first + sample, 0);
                sample += 1;
                if sample == samples && seen > 0 && seen < asked {
                    samples = most;
                }
                let Some(light) = self.sample_light([point, normal], index, uniform, shadows) else { continue };
                asked += 1;
                seen += u32::from(light.irradiance != Channels::ZERO);
                part += light.irradiance;
            }
            sum += part * f64::from(samples).recip();
        }
        sum
    }

    /// The light of one light sample at a point of an element; none where it asks for no light.
    ///
    /// - `index`: of the light among the sources. `uniform`: a point of the unit square.
    pub(super) fn sample_light(
        &self,
        [point, normal]: [DVec3; 2],
        index: usize,
        uniform: [f64; 2],
        shadows: bool,
    ) -> Option<LightAtPoint> {
        let appearance = &self.world.appearance;
        let sets = appearance.wavelengths.count();
        let source = &appearance.sources[index].1;
        let light_sample = source.sample_incident(point, Some(normal), uniform, 0)?;
        let cosine = light_sample.towards.dot(normal);
        if cosine <= 0.0 {
            return None;
        }
        let origin = point + normal * self.clearance;
        let (ray, t_max) = match light_sample.distance.is_finite() {
            false => (Ray { origin, direction: light_sample.towards }, f64::INFINITY),
            true => {
                let end = if source.is_delta() || source.is_surface() { 1.0 } else { SHORT };
                (Ray { origin, direction: point + light_sample.towards * light_sample.distance - origin }, end)
            }
        };
        let (towards, distance) = (light_sample.towards, light_sample.distance);
        let mut sum = Channels::ZERO;
        for wavelength_set in 0..sets {
            let transmittance = match (shadows, wavelength_set) {
                (false, _) => Channels::ONE,
                (true, 0) => self.world.transmittance(&ray, t_max, index, None, 0, 0.0).0,
                (true, _) if !appearance.has_passable => Channels::ONE,
                (true, wavelength_set) => self.world.transmittance(&ray, t_max, index, None, wavelength_set, 0.0).0,
            };
            if transmittance == Channels::ZERO {
                break;
            }
            let light_sample = if wavelength_set == 0 {
                Some(light_sample)
            } else {
                source.sample_incident(point, Some(normal), uniform, wavelength_set)
            };
            let arriving = light_sample.map_or(Channels::ZERO, |beam| beam.irradiance * transmittance * cosine);
            sum += if arriving.is_finite() { arriving } else { Channels::ZERO };
        }
        Some(LightAtPoint { irradiance: sum * (sets as f64).recip(), towards, distance })
    }
}
