//! Phosphors: what the screen makes of the beam, in which colours, and for how long.
//!
//! A phosphor has one or several components. Each takes its part of what the beam brings, and sends it out again as
//! light of its own colour that decays as exp(-t / decay). Of the energy s that a component holds it sends out
//! s (1 - exp(-t / decay)) in the time t: the closed form that the picture is made with. Decays that follow a power
//! of the time are rows of several exponentials.
//!
//! # Not modelled
//! Saturation and burn, decay that depends on how strongly the phosphor was excited, build-up, the spectrum beyond
//! its chromaticity, the grain.

use super::limits::FRAME_SECONDS;

/// A phosphor, or the three of a shadow-mask tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phosphor {
    /// Its registered name.
    pub name: &'static str,
    /// What it looks like.
    pub summary: &'static str,
    /// Where the numbers come from, and which are approximate.
    pub source: &'static str,
    /// Components; the parts of each gun add up to 1.
    pub components: &'static [Component],
}

/// One way in which a phosphor sends out light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// The gun that excites it: 0, or 0 red, 1 green, 2 blue in a tube with a shadow mask.
    pub gun: usize,
    /// Chromaticity of its light, CIE 1931 x and y.
    pub chromaticity: [f64; 2],
    /// Time in which its light falls to 1/e, seconds.
    pub decay: f64,
    /// Its part of the light that the phosphor sends out in all.
    pub part: f64,
}

impl Component {
    /// The remainder of its light after a frame.
    fn remaining(&self) -> f64 {
        (-FRAME_SECONDS / self.decay).exp()
    }
}

/// The least remainder after a frame of light that is still visible.
const VISIBLE_REMAINDER: f64 = 1e-3;

const fn component(gun: usize, chromaticity: [f64; 2], decay: f64, part: f64) -> Component {
    Component { gun, chromaticity, decay, part }
}

/// From the time in which light falls to a tenth to that in which it falls to 1/e.
const fn tenth(seconds: f64) -> f64 {
    seconds / std::f64::consts::LN_10
}

/// All phosphors. The first is that of the machine: a colour tube.
pub static PHOSPHORS: &[Phosphor] = &[
    Phosphor {
        name: "P22",
        summary: "colour: red, green and blue behind a shadow mask",
        source: "chromaticities: SMPTE C, a P22 set; decay: 10 % after 1 ms (red), 60 us (green), 22 us (blue), as \
                 remembered from JEDEC 16-C, their tails (Kuhn 2002, power laws) left out; that the PS 340 had P22 is ours",
        components: &[
            component(0, [0.630, 0.340], tenth(1e-3), 1.0),
            component(1, [0.310, 0.595], tenth(60e-6), 1.0),
            component(2, [0.155, 0.070], tenth(22e-6), 1.0),
        ],
    },
    Phosphor {
        name: "P1",
        summary: "green, medium persistence: oscilloscopes",
        source: "decay: Selomulya et al. 2003, zinc silicate with manganese: 2.88 and 15.1 ms, amplitudes 6.72 to 1; \
                 chromaticity: JEDEC 16-C, as remembered",
        components: &[component(0, [0.218, 0.712], 2.88e-3, 0.5618), component(0, [0.218, 0.712], 15.1e-3, 0.4382)],
    },
    Phosphor {
        name: "P3",
        summary: "amber, medium persistence",
        source: "JEDEC 16-C, as remembered: 10 % after 13 ms; taken as one exponential",
        components: &[component(0, [0.523, 0.469], tenth(13e-3), 1.0)],
    },
    Phosphor {
        name: "P4",
        summary: "white, short persistence: monochrome monitors",
        source: "JEDEC 16-C, as remembered, sulphide type: 10 % after 25 us (blue) and 60 us (yellow); the two colours \
                 are taken as their sum",
        components: &[component(0, [0.270, 0.300], tenth(60e-6), 1.0)],
    },
    Phosphor {
        name: "P7",
        summary: "blue flash, long yellow afterglow: radar, early displays",
        source: "JEDEC 16-C, as remembered: blue 10 % after 57 us, yellow 10 % after 0.4 s; Dyall 1948 measured that the \
                 tail goes on for a minute as a power of time: the third component and all parts are ours",
        components: &[
            component(0, [0.151, 0.032], tenth(57e-6), 0.35),
            component(0, [0.357, 0.537], tenth(0.4), 0.55),
            component(0, [0.357, 0.537], 3.0, 0.10),
        ],
    },
    Phosphor {
        name: "P31",
        summary: "green, short persistence: oscilloscopes, terminals",
        source: "chromaticity and 10 % after 38 us: JEDEC 16-C, as remembered; Wolf and Deubel 1997 measured 1.4 % of \
                 the contrast 50 ms after the end: the slow component, whose split into part and time is ours",
        components: &[component(0, [0.226, 0.528], tenth(38e-6), 0.95), component(0, [0.226, 0.528], 40e-3, 0.05)],
    },
    Phosphor {
        name: "P39",
        summary: "yellowish green, long persistence: displays with a low refresh rate",
        source: "JEDEC 16-C, as remembered: 10 % after 150 ms; taken as one exponential",
        components: &[component(0, [0.223, 0.698], tenth(0.15), 1.0)],
    },
];

/// The phosphor of a name, in either case of letters.
pub fn phosphor(name: &str) -> Option<&'static Phosphor> {
    PHOSPHORS.iter().find(|phosphor| phosphor.name.eq_ignore_ascii_case(name))
}

impl Phosphor {
    /// Guns of the tube: 3, or 1 that draws every colour alike.
    pub fn guns(&self) -> usize {
        self.components.iter().map(|component| component.gun + 1).max().unwrap_or(1)
    }

    /// Whether some of its light lasts longer than a frame.
    pub fn glows(&self) -> bool {
        self.components.iter().any(|component| component.remaining() > VISIBLE_REMAINDER)
    }

    /// What the components send out in frames, in the colours of the display.
    pub(super) fn emission(&self) -> Emission {
        let colors = self.colors();
        let mut emission = Emission { prompt: [[0.0; 3]; 3], slow: Vec::new() };
        for (component, color) in self.components.iter().zip(colors) {
            let color = color.map(|channel| (channel * component.part) as f32);
            let keep = component.remaining();
            if keep > VISIBLE_REMAINDER {
                emission.slow.push(Slow { gun: component.gun, color, remaining: keep as f32 });
            } else {
                let sum = &mut emission.prompt[component.gun];
                *sum = [0, 1, 2].map(|channel| sum[channel] + color[channel]);
            }
        }
        emission
    }

    /// Linear sRGB of each component at full drive.
    ///
    /// Three guns at full drive are white; the strongest channel of a component of one gun is 1. A colour that sRGB
    /// cannot show gets as much white as it needs, that of three guns is cut off by the exposure (0.5 % at most).
    fn colors(&self) -> Vec<[f64; 3]> {
        let primaries = self.components.iter().map(|component| linear_srgb(component.chromaticity));
        let primaries: Vec<[f64; 3]> = primaries.collect();
        if let [red, green, blue] = primaries[..]
            && self.guns() == 3
        {
            let balance = glam::DMat3::from_cols(red.into(), green.into(), blue.into()).inverse() * glam::DVec3::ONE;
            return [red, green, blue].iter().zip(balance.to_array()).map(|(c, k)| c.map(|x| x * k)).collect();
        }
        let shown = |color: [f64; 3]| {
            let white = -color.into_iter().fold(0.0, f64::min);
            let strongest = color.into_iter().fold(0.0, f64::max) + white;
            color.map(|channel| (channel + white) / strongest)
        };
        primaries.into_iter().map(shown).collect()
    }
}

/// What the components of a phosphor send out in a frame of what one refresh brings.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Emission {
    /// For each gun the linear sRGB of the components that are dark again within a frame.
    pub prompt: [[f32; 3]; 3],
    /// The others.
    pub slow: Vec<Slow>,
}

/// A component whose light lasts longer than a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slow {
    pub gun: usize,
    /// Linear sRGB of all its light, times its part.
    pub color: [f32; 3],
    /// The remainder after a frame.
    pub remaining: f32,
}

/// Linear sRGB of a chromaticity with luminance 1; may have negative channels.
///
/// # Source
/// IEC 61966-2-1.
fn linear_srgb([x, y]: [f64; 2]) -> [f64; 3] {
    let [x, z] = [x / y, (1.0 - x - y) / y];
    [
        3.240_625_5 * x - 1.537_208_0 - 0.498_628_6 * z,
        -0.968_930_7 * x + 1.875_756_1 + 0.041_517_5 * z,
        0.055_710_1 * x - 0.204_021_1 + 1.056_995_9 * z,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_its_own_name_a_source_and_parts_that_add_up() {
        for (index, row) in PHOSPHORS.iter().enumerate() {
            assert!(PHOSPHORS[..index].iter().all(|other| other.name != row.name), "{}", row.name);
            assert!(!row.source.is_empty() && std::ptr::eq(phosphor(&row.name.to_lowercase()).unwrap(), row));
            assert!(matches!(row.guns(), 1 | 3), "{}", row.name);
            for gun in 0..row.guns() {
                let parts: f64 = row.components.iter().filter(|c| c.gun == gun).map(|c| c.part).sum();
                assert!((parts - 1.0).abs() < 1e-12, "{} {parts}", row.name);
            }
        }
    }

    #[test]
    fn the_white_of_the_shadow_mask_is_that_of_the_display_and_its_primaries_are_those_of_the_table() {
        let emission = PHOSPHORS[0].emission();
        assert!(emission.slow.is_empty());
        let white: Vec<f32> = (0..3).map(|channel| emission.prompt.iter().map(|gun| gun[channel]).sum()).collect();
        assert!(white.iter().all(|channel| (channel - 1.0).abs() < 1e-6), "{white:?}");
        // Back to chromaticities with the published matrix from linear sRGB to XYZ.
        for (gun, component) in emission.prompt.iter().zip(PHOSPHORS[0].components) {
            let [r, g, b] = gun.map(f64::from);
            let x = 0.4124 * r + 0.3576 * g + 0.1805 * b;
            let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let z = 0.0193 * r + 0.1192 * g + 0.9505 * b;
            let sum = x + y + z;
            assert!((x / sum - component.chromaticity[0]).abs() < 1e-3, "{gun:?}");
            assert!((y / sum - component.chromaticity[1]).abs() < 1e-3, "{gun:?}");
            assert!(gun.iter().all(|channel| *channel > -0.005), "{gun:?}");
        }
    }

    #[test]
    fn the_primaries_of_srgb_are_its_own() {
        for (chromaticity, channel) in [([0.64, 0.33], 0), ([0.30, 0.60], 1), ([0.15, 0.06], 2)] {
            let color = linear_srgb(chromaticity);
            assert!((0..3).all(|other| other == channel || color[other].abs() < 2e-3 * color[channel]), "{color:?}");
        }
    }

    #[test]
    fn a_component_of_one_gun_can_be_shown() {
        for row in PHOSPHORS.iter().filter(|row| row.guns() == 1) {
            for color in row.colors() {
                assert!(
                    color.iter().all(|c| (0.0..=1.0).contains(c)) && color.contains(&1.0),
                    "{} {color:?}",
                    row.name
                );
            }
        }
    }
}
