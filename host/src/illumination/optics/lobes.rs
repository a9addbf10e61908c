//! The lobes of all materials, a row each. A new lobe is a file and a row.

use super::coat::{Coat, Ground};
use super::diffuse::Diffuse;
use super::facets::Metallic;
use super::interface::{Rough, Smooth};
use super::lobe::{Flags, Lobe};
use super::mirror::Mirror;
use super::polished::Polished;
use super::principled::PrincipledLobe;
use super::shade::Quantity;
use super::shaped::Shaped;
use super::sighting::{Onward, Sighting};
use super::straight::Straight;
use super::varied::Varied;
use crate::color::Channels;
use crate::illumination::distribution::{Distribution, Phong};
use glam::DVec3;
use std::sync::Arc;

/// Makes an enumeration of lobes, each of which answers for itself: rays ask for lobes so often that a table of functions
/// would cost more than a choice.
macro_rules! lobes {
    ($($(#[$doc:meta])* $kind:ident($lobe:ty),)*) => {
        /// A lobe of any kind.
        #[derive(Clone, Debug)]
        pub(super) enum AnyLobe {
            $($(#[$doc])* $kind($lobe),)*
        }

        #[cfg(test)]
        impl AnyLobe {
            /// The words for all kinds.
            pub(super) const KINDS: &[&str] = &[$(stringify!($kind),)*];

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
            fn value(&self, sighting: &Sighting, light: DVec3) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.value(sighting, light),)* }
            }

            #[inline]
            fn density(&self, sighting: &Sighting, light: DVec3) -> f64 {
                match self { $(AnyLobe::$kind(lobe) => lobe.density(sighting, light),)* }
            }

            #[inline]
            fn sample(&self, sighting: &Sighting, choice: f64, point: [f64; 2]) -> Option<Onward> {
                match self { $(AnyLobe::$kind(lobe) => lobe.sample(sighting, choice, point),)* }
            }

            #[inline]
            fn strength(&self, sighting: &Sighting) -> f64 {
                match self { $(AnyLobe::$kind(lobe) => lobe.strength(sighting),)* }
            }

            #[inline]
            fn mirrored(&self, sighting: &Sighting) -> [Option<Onward>; 2] {
                match self { $(AnyLobe::$kind(lobe) => lobe.mirrored(sighting),)* }
            }

            #[inline]
            fn diffuse(&self, sighting: &Sighting) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.diffuse(sighting),)* }
            }

            #[inline]
            fn shown(&self, sighting: &Sighting) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.shown(sighting),)* }
            }

            #[inline]
            fn cleared(&self, sighting: &Sighting) -> Channels {
                match self { $(AnyLobe::$kind(lobe) => lobe.cleared(sighting),)* }
            }
        }
    };
}

lobes! {
    /// Equal radiance everywhere.
    Diffuse(Diffuse),
    /// Phong's highlight.
    Phong(Shaped<Phong>),
    /// A mirror.
    Mirror(Mirror),
    /// What goes straight through.
    Straight(Straight),
    /// A fraction, distributed by a D.
    Shaped(Shaped<Arc<dyn Distribution>>),
    /// A polished metal.
    Polished(Polished),
    /// A metal of facets.
    Metallic(Metallic),
    /// What a transparent coat reflects.
    Coat(Arc<Coat>),
    /// What a diffuse ground under a coat reflects.
    Ground(Ground),
    /// A smooth interface between transparent media.
    Smooth(Smooth),
    /// A rough one.
    Rough(Rough),
    /// A part of a principled material.
    Principled(PrincipledLobe),
    /// One whose roughness changes from place to place.
    Varied(Box<Varied<AnyLobe>>),
}

impl AnyLobe {
    /// A lobe for each of several values of a number, or the only one.
    ///
    /// - `nodes`: values, rising; one or more.
    pub(super) fn varied(quantity: Quantity, mut nodes: Vec<(f64, AnyLobe)>) -> AnyLobe {
        match nodes.len() {
            1 => nodes.remove(0).1,
            _ => AnyLobe::Varied(Box::new(Varied::new(quantity, nodes))),
        }
    }
}
