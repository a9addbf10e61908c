//! An interface between two transparent media.

use super::{IndexError, Polarised, checked, cosine_of};
use glam::DVec3;

/// An interface between two transparent media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    outside: f64,
    inside: f64,
}

impl Dielectric {
    /// The interface from a medium of index `outside` to one of index `inside`, each 1e-6..=1e6.
    ///
    /// # Errors
    /// [`IndexError`].
    pub fn new(outside: f64, inside: f64) -> Result<Dielectric, IndexError> {
        Ok(Dielectric { outside: checked(outside, 0.0)?.0, inside: checked(inside, 0.0)?.0 })
    }

    /// The index inside over that outside.
    pub fn index(self) -> f64 {
        self.inside / self.outside
    }

    /// This interface, seen from behind.
    pub fn inverted(self) -> Dielectric {
        Dielectric { outside: self.inside, inside: self.outside }
    }

    /// η² − 1, exact to the last digits also where η is almost 1.
    fn excess(self) -> f64 {
        (self.inside - self.outside) / self.outside * ((self.inside + self.outside) / self.outside)
    }

    /// η times the cosine of refraction; none for total reflection.
    fn beyond(self, cosine: f64) -> Option<f64> {
        let square = self.excess() + cosine * cosine;
        (square >= 0.0).then(|| square.sqrt())
    }

    /// The reflected part of light that comes from outside.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1.
    /// - Returns 1 for both polarisations where light is reflected totally.
    pub fn reflectance(self, cosine: f64) -> Polarised {
        let (c, excess) = (cosine_of(cosine), self.excess());
        if excess == 0.0 {
            return Polarised { perpendicular: 0.0, parallel: 0.0 };
        }
        let Some(q) = self.beyond(c) else {
            return Polarised { perpendicular: 1.0, parallel: 1.0 };
        };
        let perpendicular = excess / (c + q).powi(2);
        let parallel = excess * ((excess + 2.0) * c * c - 1.0) / ((excess + 1.0) * c + q).powi(2);
        Polarised { perpendicular: perpendicular * perpendicular, parallel: parallel * parallel }
    }

    /// The part of light from outside that goes through; small parts have all their digits.
    ///
    /// - `cosine`: of the angle between light and normal, 0..=1.
    pub fn transmittance(self, cosine: f64) -> Polarised {
        let (c, excess) = (cosine_of(cosine), self.excess());
        if excess == 0.0 {
            return Polarised { perpendicular: 1.0, parallel: 1.0 };
        }
        let Some(q) = self.beyond(c) else {
            return Polarised { perpendicular: 0.0, parallel: 0.0 };
        };
        let dense = (excess + 1.0) * c;
        Polarised { perpendicular: 4.0 * c * q / (c + q).powi(2), parallel: 4.0 * dense * q / (dense + q).powi(2) }
    }

    /// The direction in which refracted light continues behind the interface, unit length; none for total reflection.
    ///
    /// - `towards`: from the interface to where the light comes from, unit length, on the side of the normal.
    /// - `normal`: unit length, towards the medium outside.
    ///
    /// The radiance of what goes through grows by the square of the ratio of the indices, inside over outside.
    pub fn refracted(self, towards: DVec3, normal: DVec3) -> Option<DVec3> {
        let c = cosine_of(towards.dot(normal));
        let sine = towards.cross(normal).length_squared();
        // Near the normal the sine has more digits than the cosine.
        let q = if sine < 0.5 {
            let square = (self.inside / self.outside).powi(2) - sine;
            (square >= 0.0).then(|| square.sqrt())?
        } else {
            self.beyond(c)?
        };
        // c − q, without cancellation.
        let bend = if c + q > 0.0 { -self.excess() / (c + q) } else { 0.0 };
        (normal * bend - towards).try_normalize()
    }
}
