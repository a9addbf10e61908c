//! A lobe whose roughness, or another number, changes from place to place.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedNumber;
use crate::color::Channels;
use crate::illumination::texture::NumberTexture;
use glam::DVec3;

/// The greatest ratio of one node to the one before it, as far as [`MOST_NODES`] allow.
const RATIO: f64 = 1.2;
/// Most nodes: some take tenths of a second to be made.
const MOST_NODES: usize = 24;

/// Lobes for some values of a number, of which the two about the value at a footprint are mixed.
///
/// A mixture of two lobes keeps their energy, is reciprocal if they are, and is sampled as exactly as they are. Of
/// lobes whose roughness is in a ratio of 1.2 it differs from that of the roughness between them by at most 2 % of its
/// peak.
#[derive(Clone, Debug)]
pub(super) struct VaryingLobe<L> {
    quantity: PreparedNumber,
    /// The values of the number, at even ratios, and the lobe of each.
    nodes: Vec<(f64, L)>,
}

/// The values for which lobes are made, at even ratios over the range of a number.
///
/// - `least`: the least that is told apart, above 0.
pub(super) fn nodes(number: &NumberTexture, least: f64) -> Vec<f64> {
    let [from, to] = number.range().map(|value| value.max(least));
    let steps = ((to / from).ln() / RATIO.ln()).ceil().min((MOST_NODES - 1) as f64);
    match steps as usize {
        0 => vec![from],
        steps => (0..=steps).map(|step| from * (to / from).powf(step as f64 / steps as f64)).collect(),
    }
}

impl<L: Lobe> VaryingLobe<L> {
    /// - `nodes`: values, rising, and the lobe of each; one or more.
    pub(super) fn new(quantity: PreparedNumber, nodes: Vec<(f64, L)>) -> VaryingLobe<L> {
        VaryingLobe { quantity, nodes }
    }

    /// The two lobes about the value at a footprint, and how much there is of each; they are the same at the ends.
    fn parts(&self, context: &ShadingContext<'_>) -> [(&L, f64); 2] {
        let value = self.quantity.of(context);
        let above = self.nodes.partition_point(|(node, _)| *node <= value).min(self.nodes.len() - 1);
        let below = above.saturating_sub(1);
        let [from, to] = [below, above].map(|node| self.nodes[node].0);
        let part = if to > from { ((value.max(from) / from).ln() / (to / from).ln()).clamp(0.0, 1.0) } else { 1.0 };
        [(&self.nodes[below].1, 1.0 - part), (&self.nodes[above].1, part)]
    }

    /// The lobe that stands for all of them where no footprint is known: that in the middle.
    fn typical(&self) -> &L {
        &self.nodes[self.nodes.len() / 2].1
    }

    /// The mixture of quantities of lobes.
    fn mixed(&self, context: &ShadingContext<'_>, of: impl Fn(&L) -> Channels) -> Channels {
        let [(a, less), (b, more)] = self.parts(context);
        if less == 0.0 { of(b) } else { of(a) * less + of(b) * more }
    }

    /// The mixture of numbers of lobes.
    fn mixed_number(&self, context: &ShadingContext<'_>, of: impl Fn(&L) -> f64) -> f64 {
        let [(a, less), (b, more)] = self.parts(context);
        if less == 0.0 { of(b) } else { of(a) * less + of(b) * more }
    }
}

impl<L: Lobe> Lobe for VaryingLobe<L> {
    fn flags(&self) -> Flags {
        self.typical().flags()
    }

    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        self.mixed(context, |lobe| lobe.value(context, light))
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        self.mixed_number(context, |lobe| lobe.pdf(context, light))
    }

    /// Samples a direction from one of the two lobes.
    fn sample(&self, context: &ShadingContext<'_>, choice: f64, point: [f64; 2]) -> Option<BsdfSample> {
        let [(a, less), (b, more)] = self.parts(context);
        let rest = |below: f64, part: f64| ((choice - below) / part).clamp(0.0, 1.0_f64.next_down());
        if choice < less {
            a.sample(context, rest(0.0, less), point)
        } else {
            b.sample(context, rest(less, more), point)
        }
    }

    fn strength(&self, context: &ShadingContext) -> f64 {
        self.mixed_number(context, |lobe| lobe.strength(context))
    }

    /// The specular samples of lobes that are polished alike, and differ in what lies on them.
    fn specular_samples(&self, context: &ShadingContext<'_>) -> [Option<BsdfSample>; 2] {
        let [(a, less), (b, more)] = self.parts(context);
        let [one, other] = [a, b].map(|lobe| lobe.specular_samples(context));
        let mixed = |(a, b): (Option<BsdfSample>, Option<BsdfSample>)| match (a, b) {
            (Some(a), Some(b)) => Some(BsdfSample { weight: a.weight * less + b.weight * more, ..b }),
            (a, b) => a
                .map(|a| BsdfSample { weight: a.weight * less, ..a })
                .or(b.map(|b| BsdfSample { weight: b.weight * more, ..b })),
        };
        let [[a, c], [b, d]] = [one, other];
        [mixed((a, b)), mixed((c, d))]
    }

    fn diffuse_albedo(&self, context: &ShadingContext) -> Channels {
        self.mixed(context, |lobe| lobe.diffuse_albedo(context))
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        self.mixed(context, |lobe| lobe.glossy_albedo(context))
    }

    fn clear_transmittance(&self, context: &ShadingContext) -> Channels {
        self.mixed(context, |lobe| lobe.clear_transmittance(context))
    }
}
