//! The lobes of all materials, a row each. A new lobe is a file and a row.

use super::coat::{CoatReflection, CoatedDiffuse};
use super::context::{BsdfSample, ShadingContext};
use super::dielectric::SmoothDielectric;
use super::diffuse::DiffuseLobe;
use super::distributed::DistributedLobe;
use super::lobe::{Flags, Lobe};
use super::mirror::MirrorLobe;
use super::prepared_textures::PreparedNumber;
use super::principled::PrincipledLobe;
use super::rough_conductor::RoughConductor;
use super::rough_dielectric::RoughDielectric;
use super::smooth_conductor::SmoothConductor;
use super::straight::StraightLobe;
use super::translucent::TranslucentLobe;
use super::varied::VaryingLobe;
use crate::color::Channels;
use crate::illumination::distribution::{Distribution, NormalisedPhong};
use glam::DVec3;
use std::sync::Arc;

/// Makes an enumeration of lobes, each of which calls its own functions: lobes are called so often that a table of
/// functions would cost more than a choice.
///
/// What stands behind `tried` makes lobes of the kind for the contract of all lobes; materials of the contract make the
/// others.
macro_rules! lobes {
    ($($(#[$doc:meta])* $kind:ident($lobe:ty) $(tried $tried:path)?,)*) => {
        /// A lobe of any kind.
        #[derive(Clone, Debug)]
        pub(super) enum AnyLobe {
            $($(#[$doc])* $kind($lobe),)*
        }

        #[cfg(test)]
        impl AnyLobe {
            /// The words for all kinds.
            pub(super) const KINDS: &[&str] = &[$(stringify!($kind),)*];

            /// The lobes that rows bring for the contract.
            pub(super) fn tried() -> Vec<AnyLobe> {
                let all: &[Vec<AnyLobe>] = &[$($($tried().into_iter().map(AnyLobe::$kind).collect(),)?)*];
                all.concat()
            }

            /// The word for its kind.
            pub(super) fn kind(&self) -> &'static str {
                match self {
                    $(AnyLobe::$kind(_) => stringify!($kind),)*
                }
            }
        }

        impl Lobe for AnyLobe {
            fn flags(&self) -> Flags {
                match self { $(AnyLobe::$kind(lobe) => lobe.flags(),)* }
            }

            #[inline]
            fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.value(context, light),)* }
            }

            #[inline]
            fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
                match self { $(AnyLobe::$kind(lobe) => lobe.pdf(context, light),)* }
            }

            #[inline]
            fn sample(&self, context: &ShadingContext, choice: f64, point: [f64; 2]) -> Option<BsdfSample> {
                match self { $(AnyLobe::$kind(lobe) => lobe.sample(context, choice, point),)* }
            }

            #[inline]
            fn strength(&self, context: &ShadingContext) -> f64 {
                match self { $(AnyLobe::$kind(lobe) => lobe.strength(context),)* }
            }

            #[inline]
            fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
                match self { $(AnyLobe::$kind(lobe) => lobe.specular_samples(context),)* }
            }

            #[inline]
            fn diffuse_albedo(&self, context: &ShadingContext) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.diffuse_albedo(context),)* }
            }

            #[inline]
            fn diffuse_transmittance(&self, context: &ShadingContext) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.diffuse_transmittance(context),)* }
            }

            #[inline]
            fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.glossy_albedo(context),)* }
            }

            #[inline]
            fn clear_transmittance(&self, context: &ShadingContext) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.clear_transmittance(context),)* }
            }
        }
    };
}

lobes! {
    /// Equal radiance everywhere.
    Diffuse(DiffuseLobe),
    /// Phong's highlight.
    Phong(DistributedLobe<NormalisedPhong>),
    /// A mirror.
    Mirror(MirrorLobe) tried super::mirror::tried,
    /// Diffuse transmission.
    Translucent(TranslucentLobe),
    /// Transmission straight through.
    Straight(StraightLobe),
    /// A fraction, distributed by a D.
    Shaped(DistributedLobe<Arc<dyn Distribution>>),
    /// A polished metal.
    Polished(SmoothConductor),
    /// A metal of facets.
    Metallic(RoughConductor),
    /// The reflection of a transparent coat.
    Coat(Arc<CoatReflection>),
    /// A diffuse ground under a transparent coat.
    Ground(CoatedDiffuse),
    /// A smooth interface between transparent media.
    Smooth(SmoothDielectric),
    /// A rough one.
    Rough(RoughDielectric),
    /// A part of a principled material.
    Principled(PrincipledLobe),
    /// One whose roughness changes from place to place.
    Varied(Box<VaryingLobe<AnyLobe>>),
}

impl AnyLobe {
    /// A lobe for each of several values of a number, or the only one.
    ///
    /// - `nodes`: values, rising; one or more.
    pub(super) fn varied(quantity: PreparedNumber, mut nodes: Vec<(f64, AnyLobe)>) -> AnyLobe {
        match nodes.len() {
            1 => nodes.remove(0).1,
            _ => AnyLobe::Varied(Box::new(VaryingLobe::new(quantity, nodes))),
        }
    }
}
