//! The principled material: a metal, an opaque ground under a clear surface, and a transparent body, in any mixture,
//! under a coat and with a sheen. All of the light that a white one gets leaves it again.
//!
//! With M, T, C and S the parts that are metal, transparent, coated and sheen, seen from outside it is
//!
//! ```text
//! M metal + (1 − M) ((1 − T) opaque + T transparent)      and of what is not transparent (1 − S) of it + S cloth
//! ```
//!
//! Facets of one roughness reflect and refract once, as GGX has them; with a coat, that is times one minus the greater
//! part that the coat reflects, of viewer and light. What of all light is then missing, a(V), comes back as
//! K a(V) a(L) / (π ā), ā the mean of a: it is reciprocal, and what is missing is made up for exactly. K is 1 of a
//! transparent body, of an opaque one its color, and of a metal what is left after further reflections between facets.
//! On both sides of a transparent surface, what is missing on one is divided among both so that it is reciprocal, too.
//!
//! # Source
//! The parameters: Burley 2012 and 2015, and OpenPBR 2024. The compensation: Kelemen and Szirmay-Kalos 2001, Kulla and
//! Conty 2017, Turquin 2019; its use under a coat, the tables and the cloth are ours.

mod albedo;
mod sheen;
mod surface;
mod missing;
mod lobe;
#[cfg(test)]
mod tests;

pub(super) use lobe::PrincipledLobe;
pub(super) use surface::{PrincipledParameters, PrincipledPart, PrincipledSurface};
