//! Irradiance by skies for rendering without rays: from all around, and without shadows.

use crate::color::Channels;
use crate::illumination::light::LightSource;
use crate::numeric::sequence::SobolSequence;
use crate::render::world::Appearance;
use glam::DVec3;

/// Directions by which a sky is summed up, for each wavelength set.
const DIRECTIONS: u32 = 4096;
/// Factors of the cosine around the normal on spherical harmonics of degree 0, 1 and 2.
const COSINE_KERNEL: [f64; 9] = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];

/// The irradiance of all skies of a scene, discs aside, by the direction of the normal.
///
/// E(n)/π is held as the sum of nine spherical harmonics. For an even sky it is exact; a clear one is off by a few
/// percent.
///
/// *Not modelled*: what stands between the sky and a surface.
///
/// # Source
/// Ramamoorthi and Hanrahan 2001, "An efficient representation for irradiance environment maps".
pub(super) struct SkyLight {
    /// For each wavelength set, the coefficients of E(n)/π.
    coefficients: Vec<[Channels; 9]>,
}

impl SkyLight {
    /// The light of the skies that are prepared; none without a sky.
    pub(super) fn new(appearance: &Appearance<'_>) -> Option<SkyLight> {
        let skies: Vec<&LightSource> =
            appearance.sources.iter().map(|(_, source)| source).filter(|source| source.is_sky()).collect();
        let sequence = SobolSequence::new(0, 0);
        let of_set = |wavelength_set: usize| {
            let mut sums = [Channels::ZERO; 9];
            for sky in &skies {
                for index in 0..DIRECTIONS {
                    let Some(light_sample) =
                        sky.sample_incident(DVec3::ZERO, None, sequence.point(index, 0), wavelength_set)
                    else {
                        continue;
                    };
                    let harmonics = harmonics(light_sample.towards);
                    for ((sum, harmonic), kept) in sums.iter_mut().zip(harmonics).zip(COSINE_KERNEL) {
                        *sum += light_sample.irradiance * (harmonic * kept / f64::from(DIRECTIONS));
                    }
                }
            }
            sums
        };
        let sets = 0..appearance.wavelengths.count();
        (!skies.is_empty()).then(|| SkyLight { coefficients: sets.map(of_set).collect() })
    }

    /// The radiance of an even sky that lights a surface as much as the skies of the scene do: E(n)/π.
    ///
    /// - `normal`: unit length.
    pub(super) fn radiance(&self, normal: DVec3, wavelength_set: usize) -> Channels {
        let terms = self.coefficients[wavelength_set].iter().zip(harmonics(normal));
        let sum = terms.fold(Channels::ZERO, |sum, (coefficient, harmonic)| sum + *coefficient * harmonic);
        // Nine terms swing below 0 opposite to a small bright place.
        sum.map(|value| value.max(0.0))
    }
}

/// The real spherical harmonics of degree 0, 1 and 2 in a direction of unit length.
fn harmonics(DVec3 { x, y, z }: DVec3) -> [f64; 9] {
    const ZERO: f64 = 0.282_094_791_773_878_1;
    const ONE: f64 = 0.488_602_511_902_919_9;
    const TWO: f64 = 1.092_548_430_592_079_2;
    const TWO_ZERO: f64 = 0.315_391_565_252_520_05;
    const TWO_TWO: f64 = 0.546_274_215_296_039_6;
    [
        ZERO,
        ONE * y,
        ONE * z,
        ONE * x,
        TWO * x * y,
        TWO * y * z,
        TWO_ZERO * (3.0 * z * z - 1.0),
        TWO * x * z,
        TWO_TWO * (x * x - y * y),
    ]
}
