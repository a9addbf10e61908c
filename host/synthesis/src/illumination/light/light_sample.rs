//! Light samples at a point, light hits of rays, and emission samples at a light.

use crate::color::Channels;
use crate::numeric::bounds::Bounds;
use crate::numeric::sequence::SobolSequence;
use glam::DVec3;

/// A light sample: light that arrives at a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// From the point towards the light, unit length.
    pub towards: DVec3,
    /// From the point to the light; infinite for light from infinitely far away.
    pub distance: f64,
    /// Irradiance of a surface that faces the light, W/m²: of a delta light all, else its radiance over the pdf of this
    /// direction.
    pub irradiance: Channels,
    /// The pdf of the direction, 1/sr; none of a delta light.
    pub pdf: Option<f64>,
}

/// A light hit: a light that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightHit {
    /// How far, in lengths of the ray's direction; infinite for the sky.
    pub t: f64,
    /// Its radiance there, W/(m² sr); 0 on the dark side.
    pub radiance: Channels,
    /// The pdf of this direction by [`LightSource::sample_incident`](super::LightSource::sample_incident), 1/sr.
    pub pdf: f64,
}

/// One of a few fixed points that stand for a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightPoint {
    /// Position of the point; none for light from infinitely far away.
    pub at: Option<DVec3>,
    /// Towards the light that is infinitely far away, unit length; 0 otherwise.
    pub towards: DVec3,
    /// The part of an emitting surface that it stands for, square units, and its normal; no normal where it is seen
    /// alike from everywhere. None for a light without size.
    pub(super) surface: Option<(f64, Option<DVec3>, EmittingSides)>,
}

/// On which sides a surface emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EmittingSides {
    Front,
    Both,
}

/// An emission sample: where light leaves a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmissionSample {
    /// From a place, in many directions.
    Point {
        /// Position of the place.
        at: DVec3,
        /// The normal of the surface there, if it is one.
        normal: Option<DVec3>,
        /// The area of all of the surface; 0 without one.
        area: f64,
    },
    /// From infinitely far away, in one direction.
    Parallel {
        /// The direction in which the light goes, unit length.
        direction: DVec3,
        /// Irradiance of a surface that faces it, W/m², over the pdf of the direction.
        irradiance: Channels,
    },
}

/// The origin of the light of a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightOrigin {
    /// From within a box, which is a point for a light without size.
    Within(Bounds),
    /// From infinitely far away: towards it, unit length.
    Towards(DVec3),
    /// From all around.
    Everywhere,
}

impl LightOrigin {
    /// A point.
    pub(super) fn point(at: DVec3) -> LightOrigin {
        LightOrigin::Within(Bounds::of([at]))
    }
}

impl LightPoint {
    /// A light without size at a place.
    pub(super) fn at(at: DVec3) -> LightPoint {
        LightPoint { at: Some(at), towards: DVec3::ZERO, surface: None }
    }

    /// One that is infinitely far away.
    pub(super) fn towards(towards: DVec3) -> LightPoint {
        LightPoint { at: None, towards, surface: None }
    }

    /// Points that are spread over a surface.
    ///
    /// - `point`: of the unit square: where it is, the area of all of the surface, its normal, on which sides it emits.
    pub(super) fn spread(
        count: u32,
        point: impl Fn([f64; 2]) -> (DVec3, f64, Option<DVec3>, EmittingSides),
    ) -> Vec<LightPoint> {
        let sequence = SobolSequence::new(0, 0);
        let squares = |i: u32| if count == 1 { [0.5; 2] } else { sequence.point(i, 0) };
        let part = f64::from(count).recip();
        let of = |i: u32| {
            let (at, area, normal, sides) = point(squares(i));
            LightPoint { at: Some(at), towards: DVec3::ZERO, surface: Some((area * part, normal, sides)) }
        };
        (0..count).map(of).collect()
    }

    /// The light that it sends to a point, of a surface of a radiance; none of a light without size.
    #[inline]
    pub(super) fn incident(&self, radiance: Channels, point: DVec3) -> Option<LightSample> {
        let (Some((area, normal, sides)), Some(at)) = (self.surface, self.at) else { return None };
        let light_sample = from_point(at - point, radiance * area)?;
        let facing = match (normal, sides) {
            (None, _) => 1.0,
            (Some(normal), EmittingSides::Front) => -normal.dot(light_sample.towards),
            (Some(normal), EmittingSides::Both) => normal.dot(light_sample.towards).abs(),
        };
        (facing > 0.0).then(|| LightSample { irradiance: light_sample.irradiance * facing, ..light_sample })
    }
}

/// Light of an intensity that comes from a place at an offset; none at the place itself.
#[inline]
pub(super) fn from_point(offset: DVec3, intensity: Channels) -> Option<LightSample> {
    let distance = offset.length();
    (distance > 0.0 && distance.is_finite()).then(|| LightSample {
        towards: offset / distance,
        distance,
        irradiance: intensity * distance.recip() * distance.recip(),
        pdf: None,
    })
}
