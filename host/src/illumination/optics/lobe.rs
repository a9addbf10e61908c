//! One lobe of what a surface scatters.

use super::coat::{Coat, Ground};
use super::facets::{Metallic, Shape};
use super::interface::{Rough, Smooth, reflected};
use super::principled::{Part, Surface};
use super::shade::{Quantity, Shade};
use super::varied::Varied;
use super::{Onward, Sighting};
use crate::color::Channels;
use crate::illumination::distribution::{Distribution, Phong};
use crate::illumination::fresnel::Conductor;
use crate::numeric::sampling::cosine_hemisphere;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// The refractive indices on both sides of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// On the side of the viewer, for each lane.
    pub before: Channels,
    /// Behind.
    pub behind: Channels,
    /// Whether the viewer is inside the body of the element.
    pub inside: bool,
}

impl Side {
    /// Air on both sides.
    pub const AIR: Side = Side { before: Channels::ONE, behind: Channels::ONE, inside: false };
}

/// A part of what a surface scatters.
#[derive(Clone, Debug)]
pub(super) enum Lobe {
    /// Equal luminance everywhere.
    Diffuse(Shade),
    /// Phong's highlight.
    Phong(Shade, Phong),
    /// A mirror.
    Mirror(Shade),
    /// What goes straight through.
    Straight(Shade),
    /// A fraction, distributed by a D.
    Shaped(Shade, Arc<dyn Distribution>),
    /// A polished metal.
    Polished(Arc<Vec<[Conductor; crate::color::LANES]>>),
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
    Principled(Part, Arc<Surface>),
    /// One whose roughness changes from place to place.
    Varied(Box<Varied>),
}

/// A lobe that is drawn with a greater density from straight above, 1/sr, is narrow: a diffuse one has 1/π.
const NARROW: f64 = 1.5;

impl Lobe {
    /// A lobe for each of several values of a number, or the only one.
    ///
    /// - `nodes`: values, rising; one or more.
    pub(super) fn varied(quantity: Quantity, mut nodes: Vec<(f64, Lobe)>) -> Lobe {
        match nodes.len() {
            1 => nodes.remove(0).1,
            _ => Lobe::Varied(Box::new(Varied::new(quantity, nodes))),
        }
    }

    /// Whether it spreads light about everywhere, and does not pass it on as a beam.
    pub(super) fn is_broad(&self) -> bool {
        let density = match self {
            Lobe::Diffuse(_) | Lobe::Ground(_) => return true,
            Lobe::Mirror(_) | Lobe::Straight(_) | Lobe::Polished(_) | Lobe::Smooth(_) => return false,
            Lobe::Phong(_, phong) => phong.sample_density(DVec3::Z, DVec3::Z),
            Lobe::Shaped(_, form) => form.sample_density(DVec3::Z, DVec3::Z),
            Lobe::Metallic(metal) => metal.shape.sample_density(DVec3::Z, DVec3::Z),
            Lobe::Coat(coat) if coat.is_polished() => return false,
            Lobe::Coat(coat) => coat.density(DVec3::Z, DVec3::Z),
            // Of facets that all are seen, a quarter of the density of their normals.
            Lobe::Rough(rough) => 0.25 * rough.facets.area(DVec3::Z, rough.roughness),
            Lobe::Principled(part, surface) => return surface.is_broad(*part, NARROW),
            Lobe::Varied(varied) => return varied.typical().is_broad(),
        };
        density < NARROW
    }

    /// Whether it reflects light alike to everywhere.
    pub(super) fn is_diffuse(&self) -> bool {
        match self {
            Lobe::Principled(part, surface) => *part == Part::Spread && !surface.transmits(),
            Lobe::Varied(varied) => varied.typical().is_diffuse(),
            _ => matches!(self, Lobe::Diffuse(_) | Lobe::Ground(_)),
        }
    }

    /// Whether it reflects nothing, wherever.
    pub(super) fn is_black(&self) -> bool {
        match self {
            Lobe::Diffuse(fraction)
            | Lobe::Phong(fraction, _)
            | Lobe::Mirror(fraction)
            | Lobe::Straight(fraction)
            | Lobe::Shaped(fraction, _) => fraction.is_black(),
            Lobe::Ground(ground) => ground.is_black(),
            Lobe::Varied(varied) => varied.typical().is_black(),
            _ => false,
        }
    }

    /// Whether it knows single directions only.
    pub(super) fn is_mirror(&self) -> bool {
        match self {
            Lobe::Mirror(_) | Lobe::Straight(_) | Lobe::Polished(_) | Lobe::Smooth(_) => true,
            Lobe::Coat(coat) => coat.is_polished(),
            Lobe::Principled(part, surface) => surface.is_mirror(*part),
            Lobe::Varied(varied) => varied.typical().is_mirror(),
            _ => false,
        }
    }

    /// Whether it is a polished interface, through which light goes in one direction.
    pub(super) fn refracts_once(&self) -> bool {
        match self {
            Lobe::Smooth(_) => true,
            Lobe::Principled(part, surface) => *part == Part::Facets && surface.is_mirror(*part) && surface.transmits(),
            Lobe::Varied(varied) => varied.typical().refracts_once(),
            _ => false,
        }
    }

    /// Whether it reflects, and lets light straight through, as a polished pane does.
    pub(super) fn is_pane(&self) -> bool {
        match self {
            Lobe::Principled(part, surface) => *part == Part::Facets && surface.is_pane(),
            Lobe::Varied(varied) => varied.typical().is_pane(),
            _ => false,
        }
    }

    /// The part of light that goes through a polished interface.
    pub(super) fn cleared(&self, sighting: &Sighting) -> Channels {
        match self {
            Lobe::Smooth(_) => Channels::ONE - reflected(sighting, sighting.view.z),
            Lobe::Principled(_, surface) if self.refracts_once() => surface.straight(sighting),
            Lobe::Varied(varied) => varied.mixed(sighting, |lobe| lobe.cleared(sighting)),
            _ => Channels::ZERO,
        }
    }

    /// Radiance towards the viewer for a unit of flux density, 1/sr; 0 for what only knows single directions.
    pub(super) fn value(&self, sighting: &Sighting, light: DVec3) -> Channels {
        let view = sighting.view;
        match self {
            Lobe::Rough(rough) => return rough.value(sighting, light),
            Lobe::Principled(part, surface) => return surface.value(*part, sighting, light),
            Lobe::Varied(varied) => return varied.mixed(sighting, |lobe| lobe.value(sighting, light)),
            _ => {}
        }
        if light.z <= 0.0 || view.z <= 0.0 {
            return Channels::ZERO;
        }
        match self {
            Lobe::Diffuse(fraction) => fraction.of(sighting) * FRAC_1_PI,
            Lobe::Phong(fraction, phong) => fraction.of(sighting) * (phong.density(light, view) / view.z),
            Lobe::Shaped(fraction, form) => fraction.of(sighting) * (form.density(light, view) / view.z),
            Lobe::Metallic(metal) => metal.value(sighting, light),
            Lobe::Coat(coat) => coat.value(sighting, light),
            Lobe::Ground(ground) => ground.value(sighting, light),
            _ => Channels::ZERO,
        }
    }

    /// The part of light from all around that it reflects alike to everywhere.
    pub(super) fn diffuse(&self, sighting: &Sighting) -> Channels {
        match self {
            Lobe::Diffuse(fraction) => fraction.of(sighting),
            Lobe::Ground(ground) => ground.mean(sighting),
            Lobe::Principled(part, surface) => surface.diffuse(*part, sighting),
            Lobe::Varied(varied) => varied.mixed(sighting, |lobe| lobe.diffuse(sighting)),
            _ => Channels::ZERO,
        }
    }

    /// About the part of light from all around that it reflects to the viewer, where it is one that shows what is around;
    /// nothing of others.
    pub(super) fn shown(&self, sighting: &Sighting) -> Channels {
        let Sighting { view, comb, .. } = *sighting;
        match self {
            Lobe::Mirror(fraction) => fraction.of(sighting),
            Lobe::Polished(metal) => reflectance(&metal[comb.min(metal.len() - 1)], view.z),
            Lobe::Metallic(metal) => metal.reflected(view.z, comb),
            Lobe::Coat(coat) => Channels::splat(coat.reflected(view.z)),
            Lobe::Smooth(_) | Lobe::Rough(_) => reflected(sighting, view.z),
            Lobe::Principled(part, surface) => surface.shown(*part, sighting),
            Lobe::Varied(varied) => varied.mixed(sighting, |lobe| lobe.shown(sighting)),
            _ => Channels::ZERO,
        }
    }

    /// The density of its samples, 1/sr.
    pub(super) fn density(&self, sighting: &Sighting, light: DVec3) -> f64 {
        let view = sighting.view;
        match self {
            Lobe::Rough(rough) => return rough.density(sighting, light),
            Lobe::Principled(part, surface) => return surface.density(*part, sighting, light),
            Lobe::Varied(varied) => return varied.mixed_number(sighting, |lobe| lobe.density(sighting, light)),
            _ => {}
        }
        if light.z <= 0.0 || view.z <= 0.0 {
            return 0.0;
        }
        match self {
            Lobe::Diffuse(_) | Lobe::Ground(_) => light.z * FRAC_1_PI,
            Lobe::Phong(_, phong) => phong.sample_density(view, light),
            Lobe::Shaped(_, form) => form.sample_density(view, light),
            Lobe::Metallic(metal) => metal.shape.sample_density(view, light),
            Lobe::Coat(coat) => coat.density(view, light),
            _ => 0.0,
        }
    }

    /// Draws a direction to light; its weight is right for single directions only, the others have a density.
    pub(super) fn sample(&self, sighting: &Sighting, choice: f64, point: [f64; 2]) -> Option<Onward> {
        let view = sighting.view;
        let spread = |light: DVec3| Onward {
            light,
            weight: Channels::ZERO,
            density: Some(0.0),
            is_straight: false,
            is_broad: true,
        };
        match self {
            Lobe::Diffuse(_) | Lobe::Ground(_) => {
                Some(cosine_hemisphere(point, DVec3::Z)).filter(|light| light.z > 0.0).map(spread)
            }
            Lobe::Phong(_, phong) => phong.sample(view, point).map(spread),
            Lobe::Shaped(_, form) => form.sample(view, point).map(spread),
            Lobe::Metallic(metal) => metal.shape.sample(view, point).map(spread),
            Lobe::Coat(coat) if !coat.is_polished() => coat.sample(view, point).map(spread),
            Lobe::Rough(rough) => rough.sample(sighting, choice, point).map(spread),
            Lobe::Smooth(smooth) => smooth.sample(sighting, choice),
            Lobe::Principled(part, surface) if surface.is_mirror(*part) => {
                surface.mirrored_sample(*part, sighting, choice)
            }
            Lobe::Principled(part, surface) => surface.sample(*part, sighting, choice, point).map(spread),
            Lobe::Varied(varied) => varied.sample(sighting, choice, point),
            _ => self.mirrored(sighting).into_iter().flatten().next(),
        }
    }

    /// Its single directions.
    pub(super) fn mirrored(&self, sighting: &Sighting) -> [Option<Onward>; 2] {
        let Sighting { view, comb, .. } = *sighting;
        let reflected = DVec3::new(-view.x, -view.y, view.z);
        match self {
            Lobe::Mirror(fraction) => [Some(Onward::single(reflected, fraction.of(sighting))), None],
            Lobe::Polished(metal) => {
                [Some(Onward::single(reflected, reflectance(&metal[comb.min(metal.len() - 1)], view.z))), None]
            }
            Lobe::Straight(fraction) => {
                [Some(Onward { is_straight: true, ..Onward::single(-view, fraction.of(sighting)) }), None]
            }
            Lobe::Coat(coat) if coat.is_polished() => {
                [Some(Onward::single(reflected, Channels::splat(coat.reflected(view.z)))), None]
            }
            Lobe::Smooth(smooth) => smooth.mirrored(sighting),
            Lobe::Principled(part, surface) => surface.mirrored(*part, sighting),
            Lobe::Varied(varied) => varied.mirrored(sighting),
            _ => [None, None],
        }
    }

    /// About what it reflects to the viewer of all the light; more than 0 where it reflects anything.
    pub(super) fn strength(&self, sighting: &Sighting) -> f64 {
        let view = sighting.view;
        match self {
            Lobe::Diffuse(fraction)
            | Lobe::Phong(fraction, _)
            | Lobe::Mirror(fraction)
            | Lobe::Straight(fraction)
            | Lobe::Shaped(fraction, _) => fraction.of(sighting).max(),
            Lobe::Polished(_) | Lobe::Metallic(_) | Lobe::Smooth(_) | Lobe::Rough(_) => 1.0,
            // Where Fresnel's term vanishes, so does what is reflected; a rough coat may still show tilted facets.
            Lobe::Coat(coat) => coat.reflected(view.z).max(if coat.is_polished() { 0.0 } else { 0.02 }),
            Lobe::Ground(ground) => ground.strength(sighting),
            Lobe::Principled(part, surface) => surface.strength(*part, sighting),
            Lobe::Varied(varied) => varied.mixed_number(sighting, |lobe| lobe.strength(sighting)),
        }
    }
}

impl Shape {
    /// The density of samples, where the viewer is given and the light is drawn.
    pub(super) fn sample_density(&self, view: DVec3, light: DVec3) -> f64 {
        self.as_distribution().sample_density(view, light)
    }

    pub(super) fn sample(&self, view: DVec3, point: [f64; 2]) -> Option<DVec3> {
        self.as_distribution().sample(view, point)
    }
}

/// Fresnel's term of a metal, lane by lane.
pub(super) fn reflectance(metal: &[Conductor; crate::color::LANES], cosine: f64) -> Channels {
    Channels(metal.map(|conductor| conductor.reflectance(cosine).mean()))
}
