//! Albedo tables: what facets reflect and let through of the light from all around, under a coat or without one, over
//! the cosine.
//!
//! With S what facets send to a viewer by one reflection or refraction, and E what the coat reflects, the tables hold
//! the integrals over all directions of light that a surface needs to know what is missing: that of S, and that of S
//! times the greater E of viewer and light.

use super::super::dielectric::beta;
use crate::illumination::distribution::{Microfacet, SlopeDistribution};
use crate::illumination::fresnel::Dielectric;
use crate::numeric::cubature::{GAUSS, unit_square};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::{Add, Mul};

/// Intervals of a table.
const STEPS: usize = 136;
/// Error of the cubature of an entry, and the most evaluations for it.
const TOLERANCE: f64 = 3e-5;
const MOST_EVALUATIONS: u32 = 12_000;
/// Parts of the range of cosines for a mean.
const MEAN_PARTS: usize = 96;
/// The least cosine of a table; below it nothing changes.
const LEAST_COSINE: f64 = 1e-7;

/// The parts of light from all around, 0..=1, that a viewer gets at a cosine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DirectionalAlbedos {
    /// By facets that reflect everything.
    pub(super) all: f64,
    /// By facets as Fresnel's equations have them, reflected.
    pub(super) reflected: f64,
    /// By facets as Fresnel's equations have them, reflected and refracted.
    pub(super) sent: f64,
    /// By a coat.
    pub(super) coat: f64,
    /// By facets that reflect everything, times the greater part that the coat reflects, of viewer and light.
    pub(super) all_coat: f64,
    /// Reflected by Fresnel's equations, times the greater part that the coat reflects, of viewer and light.
    pub(super) reflected_coat: f64,
    /// Reflected and refracted, times the part that the coat reflects, of whichever is outside; from inside, refracted
    /// alone.
    pub(super) sent_coat: f64,
}

impl Add for DirectionalAlbedos {
    type Output = DirectionalAlbedos;

    fn add(self, other: DirectionalAlbedos) -> DirectionalAlbedos {
        DirectionalAlbedos {
            all: self.all + other.all,
            reflected: self.reflected + other.reflected,
            sent: self.sent + other.sent,
            coat: self.coat + other.coat,
            all_coat: self.all_coat + other.all_coat,
            reflected_coat: self.reflected_coat + other.reflected_coat,
            sent_coat: self.sent_coat + other.sent_coat,
        }
    }
}

impl Mul<f64> for DirectionalAlbedos {
    type Output = DirectionalAlbedos;

    fn mul(self, factor: f64) -> DirectionalAlbedos {
        DirectionalAlbedos {
            all: self.all * factor,
            reflected: self.reflected * factor,
            sent: self.sent * factor,
            coat: self.coat * factor,
            all_coat: self.all_coat * factor,
            reflected_coat: self.reflected_coat * factor,
            sent_coat: self.sent_coat * factor,
        }
    }
}

/// A quantity over the cosine.
#[derive(Clone, Debug)]
struct Table<T> {
    /// The cosine below which a surface shows its roughness.
    scale: f64,
    values: Vec<T>,
}

impl<T: Copy + Send + Sync + Add<Output = T> + Mul<f64, Output = T>> Table<T> {
    fn new(roughness: f64, of: impl Fn(f64) -> T + Sync) -> Table<T> {
        let mut table = Table { scale: 5e-4 * roughness.clamp(1e-6, 1.0), values: Vec::new() };
        let entry = |step: usize| of(table.cosine(step as f64 / STEPS as f64).max(LEAST_COSINE));
        let values = (0..=STEPS).into_par_iter().map(entry).collect();
        table.values = values;
        table
    }

    /// The place of a cosine, 0..=1: half of the places are spread evenly, half of them by even ratios.
    fn place(&self, cosine: f64) -> f64 {
        0.5 * (cosine + (cosine / self.scale).asinh() / self.scale.recip().asinh())
    }

    /// The cosine at a place.
    fn cosine(&self, place: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.place(middle) < place { low = middle } else { high = middle }
        }
        if place >= 1.0 { 1.0 } else { low }
    }

    /// By Lagrange's cubic through four entries.
    fn at(&self, cosine: f64) -> T {
        let place = self.place(cosine.clamp(0.0, 1.0)) * STEPS as f64;
        let first = (place as usize).saturating_sub(1).min(STEPS - 3);
        let x = place - first as f64;
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.values[first + i]);
        a * ((1.0 - x) * (2.0 - x) * (3.0 - x) / 6.0)
            + b * (x * (2.0 - x) * (3.0 - x) / 2.0)
            + c * (x * (x - 1.0) * (3.0 - x) / 2.0)
            + d * (x * (x - 1.0) * (x - 2.0) / 6.0)
    }
}

/// 2 ∫ f μ dμ
fn mean<T: Add<Output = T> + Mul<f64, Output = T>>(of: impl Fn(f64) -> T) -> Option<T> {
    let term = |part: usize| {
        GAUSS.iter().map(move |(at, weight)| {
            // Points gather at grazing angles.
            let root = (part as f64 + at) / MEAN_PARTS as f64;
            (root * root, 4.0 * root.powi(3) * weight / MEAN_PARTS as f64)
        })
    };
    (0..MEAN_PARTS).flat_map(term).map(|(cosine, weight)| of(cosine) * weight).reduce(|a, b| a + b)
}

/// The integral over the unit square of a function that is the same on both halves along y.
fn half_square(of: impl Fn([f64; 2]) -> f64) -> f64 {
    unit_square(|[x, y]| of([x, 0.5 * y]), TOLERANCE, MOST_EVALUATIONS).value
}

/// A surface of facets, or a polished one: what it reflects and refracts once.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlbedoInterface {
    /// The roughness; none where it is polished.
    pub(super) roughness: Option<f64>,
    /// From outside.
    pub(super) surface: Dielectric,
}

impl AlbedoInterface {
    fn facets(&self) -> Option<(Microfacet, DVec2)> {
        let m = DVec2::splat(self.roughness?);
        Some((Microfacet::new(SlopeDistribution::Ggx, m).ok()?, m))
    }
}

fn slanted(cosine: f64) -> DVec3 {
    DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine)
}

/// Albedo of a coat, over the cosine.
#[derive(Clone, Debug)]
pub(super) struct CoatAlbedo {
    interface: AlbedoInterface,
    /// The table; none where it is polished.
    table: Option<Table<f64>>,
}

impl CoatAlbedo {
    pub(super) fn new(interface: AlbedoInterface) -> CoatAlbedo {
        let table = interface.facets().map(|(facets, m)| {
            Table::new(m.x, |cosine| {
                let view = slanted(cosine);
                half_square(|point| {
                    reflected(view, m, point).map_or(0.0, |(facet, light)| {
                        facets.weight(view, light) * interface.surface.reflectance(facet.dot(view)).mean()
                    })
                })
            })
        });
        CoatAlbedo { interface, table }
    }

    /// The part that is reflected of the light from all around, 0..=1.
    pub(super) fn at(&self, cosine: f64) -> f64 {
        match &self.table {
            Some(table) => table.at(cosine).clamp(0.0, 1.0),
            None => self.interface.surface.reflectance(cosine).mean(),
        }
    }
}

/// A facet as a viewer sees it, and the direction that it reflects.
fn reflected(view: DVec3, roughness: DVec2, point: [f64; 2]) -> Option<(DVec3, DVec3)> {
    let facet = SlopeDistribution::Ggx.visible(view, roughness, point)?;
    let cosine = facet.dot(view);
    let light = facet * (2.0 * cosine) - view;
    (cosine > 0.0 && light.z > 0.0).then_some((facet, light))
}

/// Albedo of facets of one roughness under a coat, on both sides.
#[derive(Clone, Debug)]
pub(super) struct Albedo {
    interface: AlbedoInterface,
    coat: Option<CoatAlbedo>,
    /// The tables of both sides; none where the facets are polished.
    tables: Option<[Table<DirectionalAlbedos>; 2]>,
    means: [DirectionalAlbedos; 2],
    /// The mean of Fresnel's term from outside, from inside, and of a pane of two interfaces.
    fresnel: [f64; 3],
}

/// From which side an interface is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InterfaceSide {
    Outside,
    Inside,
}

impl Albedo {
    /// - `transmits`: whether what comes through counts; if not, all of it is 0.
    pub(super) fn new(interface: AlbedoInterface, coat: Option<CoatAlbedo>, transmits: bool) -> Albedo {
        let mut albedo =
            Albedo { interface, coat, tables: None, means: [DirectionalAlbedos::default(); 2], fresnel: [0.0; 3] };
        if let Some(m) = interface.roughness {
            let table = |from: InterfaceSide| Table::new(m, |cosine| albedo.rough(from, cosine, transmits));
            let tables = [InterfaceSide::Outside, InterfaceSide::Inside].map(table);
            albedo.tables = Some(tables);
        }
        albedo.means = [InterfaceSide::Outside, InterfaceSide::Inside]
            .map(|from| mean(|c| albedo.at(from, c)).unwrap_or_default());
        let surface = interface.surface;
        let square = surface.index().powi(2);
        if transmits {
            // What comes through in the mean is the same to and fro but for the square of the index. The side from
            // which light is reflected totally has kinks; the mean of the other has none.
            let [outside, inside] = &mut albedo.means;
            let through = outside.sent_coat - outside.reflected_coat;
            inside.sent_coat = through / square;
        }
        let mean_of = |surface: Dielectric| mean(|cosine| surface.reflectance(cosine).mean()).unwrap_or_default();
        let [outside, inside] = match square >= 1.0 {
            true => {
                let outside = mean_of(surface);
                [outside, 1.0 - (1.0 - outside) / square]
            }
            false => {
                let inside = mean_of(surface.inverted());
                [1.0 - (1.0 - inside) * square, inside]
            }
        };
        let pane = mean(|cosine| pane(surface.reflectance(cosine).mean())).unwrap_or_default();
        albedo.fresnel = [outside, inside, pane];
        albedo
    }

    /// Albedo of the coat for light from all around.
    pub(super) fn coat(&self, cosine: f64) -> f64 {
        self.coat.as_ref().map_or(0.0, |coat| coat.at(cosine))
    }

    /// The shares at a cosine.
    pub(super) fn at(&self, from: InterfaceSide, cosine: f64) -> DirectionalAlbedos {
        match &self.tables {
            Some(tables) => tables[from as usize].at(cosine),
            None => self.polished(from, cosine),
        }
    }

    /// Their mean over all directions of the viewer, weighted with the cosine.
    pub(super) fn mean(&self, from: InterfaceSide) -> &DirectionalAlbedos {
        &self.means[from as usize]
    }

    /// The mean of Fresnel's term on a side, or that of a pane of two interfaces.
    pub(super) fn fresnel(&self, from: InterfaceSide, is_pane: bool) -> f64 {
        if is_pane { self.fresnel[2] } else { self.fresnel[from as usize] }
    }

    fn surface(&self, from: InterfaceSide) -> Dielectric {
        match from {
            InterfaceSide::Outside => self.interface.surface,
            InterfaceSide::Inside => self.interface.surface.inverted(),
        }
    }

    fn polished(&self, from: InterfaceSide, cosine: f64) -> DirectionalAlbedos {
        let surface = self.surface(from);
        let reflected = surface.reflectance(cosine).mean();
        match from {
            InterfaceSide::Outside => {
                let coat = self.coat(cosine);
                DirectionalAlbedos {
                    all: 1.0,
                    reflected,
                    sent: 1.0,
                    coat,
                    all_coat: coat,
                    reflected_coat: coat * reflected,
                    sent_coat: coat,
                }
            }
            InterfaceSide::Inside => {
                let beyond = surface.refracted(slanted(cosine), DVec3::Z).map_or(0.0, |light| -light.z);
                let through = surface.transmittance(cosine).mean();
                DirectionalAlbedos {
                    sent: 1.0,
                    sent_coat: self.coat(beyond) * through,
                    ..DirectionalAlbedos::default()
                }
            }
        }
    }

    fn rough(&self, from: InterfaceSide, cosine: f64, transmits: bool) -> DirectionalAlbedos {
        let Some((facets, m)) = self.interface.facets() else { return self.polished(from, cosine) };
        let surface = self.surface(from);
        let view = slanted(cosine);
        let shown = SlopeDistribution::Ggx.projected(view, m) / view.z;
        let has_coat = self.coat.is_some();
        let own = if from == InterfaceSide::Outside { self.coat(cosine) } else { 0.0 };
        // What is reflected, and times a function of facet and light.
        let mirrored = |point: [f64; 2], of: &dyn Fn(f64, DVec3) -> f64| {
            reflected(view, m, point)
                .map_or(0.0, |(facet, light)| facets.weight(view, light) * of(facet.dot(view), light))
        };
        let refracted = |point: [f64; 2], of: &dyn Fn(DVec3) -> f64| {
            let facet = SlopeDistribution::Ggx.visible(view, m, point).filter(|facet| facet.dot(view) > 0.0);
            let light = facet.and_then(|facet| Some((facet.dot(view), surface.refracted(view, facet)?)));
            light.filter(|(_, light)| light.z < 0.0).map_or(0.0, |(cosine, light)| {
                let beyond = SlopeDistribution::Ggx.projected(DVec3::new(light.x, light.y, -light.z), m) / -light.z;
                // Above and below, one hides what the other does not.
                beta(shown, beyond) * shown * surface.transmittance(cosine).mean() * of(light)
            })
        };
        let fresnel = |cosine: f64| surface.reflectance(cosine).mean();
        let greater = |light: DVec3| own.max(self.coat(light.z));
        let mut shares = DirectionalAlbedos { coat: own, ..DirectionalAlbedos::default() };
        match from {
            InterfaceSide::Outside => {
                shares.all = half_square(|point| mirrored(point, &|_, _| 1.0));
                shares.reflected = half_square(|point| mirrored(point, &|cosine, _| fresnel(cosine)));
                if has_coat {
                    shares.all_coat = half_square(|point| mirrored(point, &|_, light| greater(light)));
                    shares.reflected_coat =
                        half_square(|point| mirrored(point, &|cosine, light| fresnel(cosine) * greater(light)));
                }
                if transmits {
                    let through = half_square(|point| refracted(point, &|_| 1.0));
                    shares.sent = shares.reflected + through;
                    shares.sent_coat = shares.reflected_coat + own * through;
                }
            }
            InterfaceSide::Inside if transmits => {
                shares.sent =
                    half_square(|point| mirrored(point, &|cosine, _| fresnel(cosine)) + refracted(point, &|_| 1.0));
                if has_coat {
                    shares.sent_coat = half_square(|point| refracted(point, &|light| self.coat(-light.z)));
                }
            }
            InterfaceSide::Inside => {}
        }
        shares
    }
}

/// Reflectance of a pane of two interfaces, of which each reflects a part.
pub(super) fn pane(reflected: f64) -> f64 {
    2.0 * reflected / (1.0 + reflected)
}
