//! Lights made ready for rendering: what arrives at a point, and what is seen of them.

use super::{Goniometry, Light, Patch, Sky};
use crate::color::observer::LUMENS_PER_WATT;
use crate::color::{Channels, Curve, Wavelengths};
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// Light that arrives at a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// From the point towards the light, unit length.
    pub towards: DVec3,
    /// From the point to the light; infinite for light from infinitely far away.
    pub distance: f64,
    /// Irradiance of a surface that faces the light, W/m²: of all the light where it comes from one direction only, else
    /// its radiance over the density with which this direction was drawn.
    pub irradiance: Channels,
    /// That density, 1/sr; none where light comes from one direction only.
    pub density: Option<f64>,
}

/// What a ray sees of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// How far, in lengths of the ray's direction; infinite for the sky.
    pub t: f64,
    /// Its radiance there, W/(m² sr); 0 on the dark side.
    pub radiance: Channels,
    /// The density with which [`Source::beam`] would have drawn this direction, 1/sr.
    pub density: f64,
}

/// One of a few fixed points that stand for a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightPoint {
    /// Where it is; none for light from infinitely far away.
    pub at: Option<DVec3>,
    /// Towards the light that is infinitely far away, unit length; 0 otherwise.
    pub towards: DVec3,
    /// The part of an emitting surface that it stands for, square units, and its normal; no normal where it is seen alike from
    /// everywhere. None for a light without size.
    surface: Option<(f64, Option<DVec3>, Sides)>,
}

/// On which sides a surface emits.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sides {
    Front,
    Both,
}

/// A light ready for rendering.
#[derive(Clone, Debug)]
pub struct Source {
    pub(super) strength: Curve,
    pub(super) kind: Kind,
}

#[derive(Clone, Debug)]
pub(super) enum Kind {
    Point { at: DVec3 },
    Directional { towards: DVec3 },
    Spot { at: DVec3, axis: DVec3, inner: f64, outer: f64 },
    Luminaire { at: DVec3, axes: DMat3, table: Arc<Goniometry> },
    Area(Patch),
    Mesh(Triangles),
    Sky(Box<Sky>),
}

/// Triangles that emit on both sides, drawn evenly by area.
#[derive(Clone, Debug)]
pub(super) struct Triangles {
    corners: Vec<[DVec3; 3]>,
    /// The part of the area up to each.
    below: Vec<f64>,
    pub(super) area: f64,
}

impl Source {
    /// A light, ready. It should have been checked before.
    pub fn new(light: &Light, wavelengths: &Wavelengths) -> Source {
        let strength = wavelengths.light(light.strength().1);
        let kind = match light {
            Light::Point { at, .. } => Kind::Point { at: *at },
            Light::Directional { direction, .. } => {
                Kind::Directional { towards: -direction.normalize_or(DVec3::NEG_Y) }
            }
            Light::Spot { at, direction, inner, outer, .. } => Kind::Spot {
                at: *at,
                axis: direction.normalize_or(DVec3::NEG_Y),
                inner: inner.to_radians().cos(),
                outer: outer.to_radians().cos(),
            },
            Light::Luminaire { at, down, front, goniometry, .. } => {
                let up = -down.normalize_or(DVec3::NEG_Y);
                let y = up.cross(*front).normalize_or(up.any_orthonormal_vector());
                let axes = DMat3::from_cols(y.cross(up), y, up);
                Kind::Luminaire { at: *at, axes, table: Arc::new(goniometry.clone()) }
            }
            Light::Area { patch, .. } => Kind::Area(*patch),
            Light::Sky { map, radiance, turned } => {
                Kind::Sky(Box::new(Sky::new(map.as_ref(), radiance, *turned, wavelengths)))
            }
        };
        Source { strength, kind }
    }

    /// The light; of one that is a sky, directions are then drawn through portals from where these are.
    ///
    /// - `portals`: rectangles whose normals, across x up, point inwards.
    pub fn with_portals(self, portals: &[Patch]) -> Source {
        match self.kind {
            Kind::Sky(sky) if !portals.is_empty() => {
                Source { kind: Kind::Sky(Box::new(sky.with_portals(portals))), ..self }
            }
            _ => self,
        }
    }

    /// Triangles that emit the same radiance on both sides; none without area.
    pub fn of_triangles(corners: Vec<[DVec3; 3]>, radiance: Curve) -> Option<Source> {
        let mut area = 0.0;
        let mut below: Vec<f64> = Vec::with_capacity(corners.len());
        for [a, b, c] in &corners {
            area += 0.5 * (*b - *a).cross(*c - *a).length();
            below.push(area);
        }
        if !(area > 0.0 && area.is_finite()) {
            return None;
        }
        below.iter_mut().for_each(|part| *part /= area);
        Some(Source { strength: radiance, kind: Kind::Mesh(Triangles { corners, below, area }) })
    }

    /// Light that arrives at a point if nothing stands between; none where there is none, and at the light itself.
    ///
    /// - `normal`: of the element at the point, unit length, if there is one: directions above it are drawn more often.
    /// - `uniform`: a point of the unit square, which chooses the point of a light that has a size.
    pub fn beam(&self, point: DVec3, normal: Option<DVec3>, uniform: [f64; 2], comb: usize) -> Option<Beam> {
        let strength = || self.strength.of(comb);
        match &self.kind {
            Kind::Point { at } => from_point(*at - point, strength()),
            Kind::Directional { towards } => {
                Some(Beam { towards: *towards, distance: f64::INFINITY, irradiance: strength(), density: None })
            }
            Kind::Spot { at, axis, inner, outer } => {
                let beam = from_point(*at - point, strength())?;
                let part = ((-beam.towards.dot(*axis) - outer) / (inner - outer)).clamp(0.0, 1.0);
                let part = part * part * (3.0 - 2.0 * part);
                (part > 0.0).then(|| Beam { irradiance: beam.irradiance * part, ..beam })
            }
            Kind::Luminaire { at, axes, table } => {
                let beam = from_point(*at - point, strength())?;
                let watts = table.candelas(axes.transpose() * -beam.towards) / LUMENS_PER_WATT;
                (watts > 0.0).then(|| Beam { irradiance: beam.irradiance * watts, ..beam })
            }
            Kind::Area(patch) => {
                let drawn = patch.draw(point, uniform)?;
                let irradiance = strength() * drawn.density.recip();
                Some(Beam {
                    towards: drawn.towards,
                    distance: drawn.distance,
                    irradiance,
                    density: Some(drawn.density),
                })
            }
            Kind::Mesh(triangles) => {
                let (towards, distance, density) = triangles.draw(point, uniform)?;
                Some(Beam { towards, distance, irradiance: strength() * density.recip(), density: Some(density) })
            }
            Kind::Sky(sky) => {
                let (towards, density) = sky.draw(point, normal, uniform)?;
                let irradiance = sky.radiance(towards, comb) * density.recip();
                Some(Beam { towards, distance: f64::INFINITY, irradiance, density: Some(density) })
            }
        }
    }

    /// Points that stand for it: itself if it has no size, the middle of a disc in the sky, none for another sky.
    ///
    /// A sphere's points lie on a smaller one, so that they are spread as its disc is, as seen from anywhere.
    ///
    /// - `count`: of them where it has a size, 1 and more; a single one is in its middle.
    pub fn points(&self, count: u32) -> Vec<LightPoint> {
        let count = count.max(1);
        let sharp = |at: Option<DVec3>, towards: DVec3| vec![LightPoint { at, towards, surface: None }];
        let sequence = crate::numeric::sequence::Sequence::new(0, 0);
        let squares = |i: u32| if count == 1 { [0.5; 2] } else { sequence.point(i, 0) };
        let part = f64::from(count).recip();
        let spread = |point: &dyn Fn([f64; 2]) -> (DVec3, f64, Option<DVec3>, Sides)| {
            let of = |i: u32| {
                let (at, area, normal, sides) = point(squares(i));
                LightPoint { at: Some(at), towards: DVec3::ZERO, surface: Some((area * part, normal, sides)) }
            };
            (0..count).map(of).collect()
        };
        match &self.kind {
            Kind::Point { at } | Kind::Spot { at, .. } | Kind::Luminaire { at, .. } => sharp(Some(*at), DVec3::ZERO),
            Kind::Directional { towards } => sharp(None, *towards),
            Kind::Sky(sky) => sky.disc().map_or_else(Vec::new, |towards| sharp(None, towards)),
            Kind::Area(patch) => spread(&|uniform| {
                let (at, normal) = patch.point(uniform, count == 1);
                (at, patch.seen_area(), normal, Sides::Front)
            }),
            Kind::Mesh(triangles) => spread(&|uniform| {
                let (at, normal) = triangles.point(uniform);
                (at, triangles.area, Some(normal), Sides::Both)
            }),
        }
    }

    /// Light that arrives from one of [`Source::points`] if nothing stands between.
    #[inline]
    pub fn beam_from(&self, from: &LightPoint, point: DVec3, comb: usize) -> Option<Beam> {
        let (Some((area, normal, sides)), Some(at)) = (from.surface, from.at) else {
            // The middle of a disc in the sky stands for it.
            return self.beam(point, None, [0.0; 2], comb);
        };
        let beam = from_point(at - point, self.strength.of(comb) * area)?;
        let facing = match (normal, sides) {
            (None, _) => 1.0,
            (Some(normal), Sides::Front) => -normal.dot(beam.towards),
            (Some(normal), Sides::Both) => normal.dot(beam.towards).abs(),
        };
        (facing > 0.0).then(|| Beam { irradiance: beam.irradiance * facing, ..beam })
    }

    /// Where its light comes from: a direction, unit length, or a box; none for a sky.
    pub fn place(&self) -> Option<Result<Bounds, DVec3>> {
        let point = |at: DVec3| Ok(Bounds::of([at]));
        match &self.kind {
            Kind::Point { at } | Kind::Spot { at, .. } | Kind::Luminaire { at, .. } => Some(point(*at)),
            Kind::Directional { towards } => Some(Err(*towards)),
            Kind::Area(patch) => Some(Ok(Bounds::of(patch.bounds()))),
            Kind::Mesh(triangles) => Some(Ok(Bounds::of(triangles.corners.iter().flatten().copied()))),
            Kind::Sky(_) => None,
        }
    }

    /// What a ray sees of a light that is a surface of its own.
    pub fn glow(&self, ray: &Ray, t_min: f64, t_max: f64, comb: usize) -> Option<Glow> {
        let Kind::Area(patch) = &self.kind else { return None };
        let (t, front) = patch.met(ray, t_min, t_max)?;
        let length = ray.direction.length();
        let radiance = if front { self.strength.of(comb) } else { Channels::ZERO };
        Some(Glow { t, radiance, density: patch.density(ray.origin, ray.direction / length, t * length) })
    }

    /// What is seen of a sky; none of another light, and beside a disc.
    ///
    /// - `ray`: of unit length, from the point from which it is seen.
    /// - `normal`: of the element from which it is seen, as in [`Source::beam`].
    pub fn sky(&self, ray: &Ray, normal: Option<DVec3>, comb: usize) -> Option<Glow> {
        let Ray { origin, direction: towards } = *ray;
        let Kind::Sky(sky) = &self.kind else { return None };
        if sky.is_beside(towards) {
            return None;
        }
        Some(Glow {
            t: f64::INFINITY,
            radiance: sky.radiance(towards, comb),
            density: sky.density(origin, towards, normal),
        })
    }

    /// The density with which [`Source::beam`] draws a direction in which emitting triangles are met, 1/sr.
    ///
    /// - `cosine`: between the direction and the normal of the triangle, any sign.
    pub fn density_on_triangle(&self, distance: f64, cosine: f64) -> f64 {
        match &self.kind {
            Kind::Mesh(triangles) if cosine != 0.0 => distance * distance / (cosine.abs() * triangles.area),
            _ => 0.0,
        }
    }

    /// Whether its light comes from one direction only at every point.
    pub fn is_sharp(&self) -> bool {
        !matches!(self.kind, Kind::Area(_) | Kind::Mesh(_) | Kind::Sky(_))
    }

    /// Whether it is a surface of its own, which rays meet.
    pub fn is_surface(&self) -> bool {
        matches!(self.kind, Kind::Area(_))
    }

    /// Whether its light is worth being followed: a sky of one radiance is found from everywhere.
    pub fn is_caught(&self) -> bool {
        !matches!(&self.kind, Kind::Sky(sky) if sky.is_even())
    }

    /// The cone out of which nothing is sent: its tip, its axis, unit length, and the cosine of its half angle; none if
    /// light goes everywhere.
    pub fn cone(&self) -> Option<(DVec3, DVec3, f64)> {
        match &self.kind {
            Kind::Spot { at, axis, outer, .. } => Some((*at, *axis, *outer)),
            _ => None,
        }
    }

    /// Whether it is seen where rays meet nothing: a sky, or a disc in it.
    pub fn is_beyond(&self) -> bool {
        matches!(self.kind, Kind::Sky(_))
    }

    /// Whether it surrounds everything: no disc in the sky does.
    pub fn is_sky(&self) -> bool {
        matches!(&self.kind, Kind::Sky(sky) if sky.disc().is_none())
    }
}

#[inline]
fn from_point(offset: DVec3, intensity: Channels) -> Option<Beam> {
    let distance = offset.length();
    (distance > 0.0 && distance.is_finite()).then(|| Beam {
        towards: offset / distance,
        distance,
        irradiance: intensity * distance.recip() * distance.recip(),
        density: None,
    })
}

impl Triangles {
    /// A point, drawn evenly by area, and the normal there.
    pub(super) fn point(&self, [x, y]: [f64; 2]) -> (DVec3, DVec3) {
        let index = self.below.partition_point(|part| *part <= x).min(self.below.len() - 1);
        let from = if index == 0 { 0.0 } else { self.below[index - 1] };
        let x = ((x - from) / (self.below[index] - from)).clamp(0.0, 1.0);
        let [a, b, c] = self.corners[index];
        let root = x.sqrt();
        let at = a * (1.0 - root) + b * (root * (1.0 - y)) + c * (root * y);
        (at, (b - a).cross(c - a).normalize_or_zero())
    }

    fn draw(&self, point: DVec3, uniform: [f64; 2]) -> Option<(DVec3, f64, f64)> {
        let (at, normal) = self.point(uniform);
        let offset = at - point;
        let distance = offset.length();
        let towards = offset / distance;
        let density = distance * distance / (normal.dot(towards).abs() * self.area);
        (distance > 0.0 && density.is_finite() && density > 0.0).then_some((towards, distance, density))
    }
}
