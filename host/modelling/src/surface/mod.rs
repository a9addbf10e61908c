//! Surfaces that are known exactly, and the meshes that approximate them to a tolerance.
//!
//! A [`SurfaceOfRevolution`] is what a [`Profile`] makes around an axis: cylinder, cone, disc, torus, paraboloid,
//! hyperboloid. A [`Swept`] surface is what a straight edge makes that a curve carries along. A [`SplineSurface`] is a
//! mesh of control points over a [`crate::curve::Basis`] in each direction; its [`SplineSurface::patches`] are what is
//! tessellated. [`tessellate`] makes grids, the better choice for even surfaces; [`tessellate_adaptively`] makes
//! triangles that are small only where the surface bends, and [`tessellate_trimmed`] the same for surfaces of which
//! curves cut parts off. [`joined`] makes surfaces meet smoothly, [`continuity`] tells how smoothly they do. Holes of
//! any number of sides are filled by [`n_sided_patch`] or [`patches_around_vertex`].

mod accuracy;
mod bezier;
mod shared_curves;
mod car_body;
mod continuity;
mod curvature;
mod hole;
mod join;
mod nearest;
mod parallelogram;
mod patches;
mod pierced;
mod transformed;
mod profile;
mod rational_revolution;
mod sphere;
mod spline;
mod swept;
mod teapot;
mod tensor;
mod tessellation;
mod trim;
mod surface_of_revolution;

pub use accuracy::{ChordError, chord_error};
pub use bezier::BezierPatch;
pub use car_body::car_body;
pub use continuity::{Joint, SurfaceSide, continuity, joint};
pub use curvature::{Curved, normal_curvature};
pub use hole::{FourSidedPatch, HoleError, HoleSide, MAX_SIDES, NSidedPatch, n_sided_patch, patches_around_vertex};
pub use join::{JoinError, Smoothness, joined};
pub use nearest::nearest_from;
pub use parallelogram::{Parallelogram, box_faces, ground};
pub use patches::{PatchError, PatchProblem, PatchSet};
pub use pierced::{PiercingLine, PiercingPoint, pierced};
pub use profile::Profile;
pub use rational_revolution::{rational_sphere, rational_torus, revolved};
pub use sphere::Sphere;
pub use spline::{Direction, SplineSurface};
pub use surface_of_revolution::SurfaceOfRevolution;
pub use swept::{Spine, Swept, TwistAndTaper};
pub use teapot::{teapot, teapot_parts};
pub use tensor::TensorPatch;
pub use tessellation::{TessellationError, Tolerance, tessellate};
pub use transformed::TransformedSurface;
pub use trim::{TrimEdge, TrimError, TrimmedSurface, tessellate_adaptively, tessellate_trimmed};

use std::sync::Arc;

use glam::{DVec2, DVec3};

/// Gives the point and the outward unit normal of a surface at a parameter u, along a line where v stays.
pub type ParameterLine<'s> = Box<dyn Fn(f64) -> [DVec3; 2] + 's>;

/// A piece of a surface over a rectangle of parameters (u, v), with du x dv pointing outwards.
///
/// Pieces that meet must agree bit by bit on the points of the common side at 0, 1/4, 1/2, 3/4 and 1 of its length in
/// parameters: that is how [`tessellate`] knows that they meet.
pub trait Surface: Send + Sync {
    /// The lowest and the highest parameters, `[(u0, v0), (u1, v1)]`.
    fn domain(&self) -> [DVec2; 2];

    /// The point at `uv`, which is in the domain; model units.
    fn point(&self, uv: DVec2) -> DVec3;

    /// The derivatives of the point by u and by v; either may vanish.
    fn derivatives(&self, uv: DVec2) -> [DVec3; 2];

    /// The point and its derivatives by u and v at once, perhaps with other last digits.
    fn point_and_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let [du, dv] = self.derivatives(uv);
        [self.point(uv), du, dv]
    }

    /// The outward unit normal; where the derivatives do not determine it, its limit from the inside of the domain.
    fn normal(&self, uv: DVec2) -> DVec3;

    /// The line of a parameter v, which is in the domain. It gives what [`Surface::point`] and [`Surface::normal`] give, to
    /// the bit.
    fn line(&self, v: f64) -> ParameterLine<'_> {
        Box::new(move |u| {
            let uv = DVec2::new(u, v);
            [self.point(uv), self.normal(uv)]
        })
    }

    /// The parameters of a point of the surface that is nearest to `point`, near `guess` if there are several.
    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2;
}

/// Makes pointers to surfaces surfaces.
macro_rules! pointers {
    ($($pointer:ty),*) => {$(
        impl<S: Surface + ?Sized> Surface for $pointer {
            fn domain(&self) -> [DVec2; 2] {
                (**self).domain()
            }

            fn point(&self, uv: DVec2) -> DVec3 {
                (**self).point(uv)
            }

            fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
                (**self).derivatives(uv)
            }

            fn point_and_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
                (**self).point_and_derivatives(uv)
            }

            fn normal(&self, uv: DVec2) -> DVec3 {
                (**self).normal(uv)
            }

            fn line(&self, v: f64) -> ParameterLine<'_> {
                (**self).line(v)
            }

            fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
                (**self).nearest(point, guess)
            }
        }
    )*};
}

pointers!(&S, Box<S>, Arc<S>);

/// The parameter at `fraction` of the way from `low` to `high`; exact at both ends, and the same from either end.
fn between(low: f64, high: f64, fraction: f64) -> f64 {
    low * (1.0 - fraction) + high * fraction
}

#[cfg(test)]
mod contract;
#[cfg(test)]
mod spline_tests;
