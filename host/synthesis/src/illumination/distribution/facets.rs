//! A surface of many small mirrors: how their normals are distributed, and which of them a direction sees.

use super::special::{gaussian, inverse_of_gaussian, inverse_of_visible};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// How the slopes of microfacets are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlopeDistribution {
    /// Slopes of a Gaussian surface.
    Beckmann,
    /// Slopes of an ellipsoid: longer tails (Trowbridge and Reitz).
    Ggx,
}

impl SlopeDistribution {
    /// Area of the facets with a normal per unit surface area and solid angle, 1/sr.
    ///
    /// Beckmann: exp(−t²) / (π mₓ m_y cos⁴); GGX: 1 / (π mₓ m_y cos⁴ (1 + t²)²); t² = (x/mₓ)² + (y/m_y)² with the
    /// slopes x, y of the facet. In both the area times the cosine integrates to 1.
    ///
    /// - `half`: along the normal, any length; z above 0, else the area is 0.
    /// - `roughness`: m along x and y.
    ///
    /// # Source
    /// Cook and Torrance 1982, with 1/pi; Walter et al. 2007, equations 25 and 33.
    pub(in crate::illumination) fn area(self, half: DVec3, roughness: DVec2) -> f64 {
        let square = half.length_squared();
        if !(half.z > 0.0 && square > 0.0) {
            return 0.0;
        }
        let scale = PI * roughness.x * roughness.y;
        let cosine = half.z * half.z / square;
        let tilt = (half.truncate() / roughness).length_squared();
        match self {
            SlopeDistribution::Beckmann => {
                let exponent = tilt / (half.z * half.z);
                // Beyond 700 the exponential is smaller than any power of the cosine can make up for.
                if exponent > 700.0 { 0.0 } else { (-exponent).exp() / (scale * cosine * cosine) }
            }
            SlopeDistribution::Ggx => 1.0 / (scale * (cosine + tilt / square).powi(2)),
        }
    }

    /// Area that the visible facets show to a direction, per unit surface area: at least its cosine.
    ///
    /// It is the cosine times 1 + Λ of Smith's masking, in a form that holds at grazing angles.
    ///
    /// - `towards`: unit length, z 0 and more.
    ///
    /// # Source
    /// Heitz 2014, equations 13 and 72.
    pub(in crate::illumination) fn projected(self, towards: DVec3, roughness: DVec2) -> f64 {
        let spread = (towards.truncate() * roughness).length();
        match self {
            SlopeDistribution::Beckmann if spread == 0.0 => towards.z,
            SlopeDistribution::Beckmann => {
                let [below, bell] = gaussian(towards.z / spread);
                towards.z * below + 0.5 * spread * bell
            }
            SlopeDistribution::Ggx => 0.5 * (towards.z + towards.z.hypot(spread)),
        }
    }

    /// The normal of a facet as `towards` sees it: its pdf is (L·H) times its area over the area that is seen of all.
    ///
    /// - `towards`: unit length, z above 0. `point`: of the unit square.
    ///
    /// # Source
    /// Heitz and d'Eon 2014 for Beckmann, Dupuy and Benyoub 2023 for GGX; the inversion is ours.
    pub fn visible(self, towards: DVec3, roughness: DVec2, point: [f64; 2]) -> Option<DVec3> {
        // In stretched space the roughness is 1.
        let across = towards.truncate() * roughness;
        let slope = match self {
            SlopeDistribution::Beckmann => {
                let sine = across.length();
                let around = if sine > 0.0 { across * sine.recip() } else { DVec2::X };
                let along = inverse_of_visible(towards.z, sine, point[0]);
                // A facet that rises towards x turns its normal away from x.
                -(around * along + around.perp() * inverse_of_gaussian(point[1]))
            }
            SlopeDistribution::Ggx => {
                let stretched = across.extend(towards.z).try_normalize()?;
                let sine = stretched.truncate().length();
                let around = if sine > 0.0 { stretched.truncate() / sine } else { DVec2::X };
                let z = (1.0 - point[0]) * (1.0 + stretched.z) - stretched.z;
                let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
                let (sin, cos) = (TAU * point[1]).sin_cos();
                // Counted from the azimuth opposite to the direction.
                let across = (around * cos + around.perp() * sin) * -radius;
                let normal = across.extend(z) + stretched;
                if normal.z <= 0.0 {
                    return None;
                }
                normal.truncate() / normal.z
            }
        };
        (slope * roughness).extend(1.0).try_normalize()
    }
}
