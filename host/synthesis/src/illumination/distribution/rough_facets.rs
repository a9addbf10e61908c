//! The facets of a rough surface, of either kind: slopes with a formula, or a table of the user's.

use super::{FacetTable, SlopeDistribution};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// The facets of a rough surface, and how a surface samples them.
#[derive(Clone, Debug)]
pub(in crate::illumination) enum RoughFacets {
    /// Slopes with a formula, and their roughness m along x and y.
    Slopes(SlopeDistribution, DVec2),
    /// A function of the angle that the user defined.
    Table(Arc<FacetTable>),
}

impl RoughFacets {
    /// Area of the facets with a normal per unit surface area and solid angle, 1/sr.
    ///
    /// - `half`: along the normal, any length; z above 0, else the area is 0.
    pub(in crate::illumination) fn area(&self, half: DVec3) -> f64 {
        match self {
            RoughFacets::Slopes(slopes, roughness) => slopes.area(half, *roughness),
            RoughFacets::Table(table) => table.area(half),
        }
    }

    /// Area that the visible facets show to a direction, per unit surface area: at least its cosine.
    ///
    /// - `towards`: unit length, z 0 and more.
    pub(in crate::illumination) fn projected(&self, towards: DVec3) -> f64 {
        match self {
            RoughFacets::Slopes(slopes, roughness) => slopes.projected(towards, *roughness),
            RoughFacets::Table(table) => table.projected(towards.z),
        }
    }

    /// The normal of a facet: of those that a direction sees if they have a formula, of all if they are a table.
    ///
    /// - `towards`: unit length, z above 0. `point`: of the unit square.
    pub(in crate::illumination) fn normal(&self, towards: DVec3, point: [f64; 2]) -> Option<DVec3> {
        match self {
            RoughFacets::Slopes(slopes, roughness) => slopes.visible(towards, *roughness, point),
            RoughFacets::Table(table) => Some(table.normal(point)),
        }
    }

    /// The pdf of [`RoughFacets::normal`], 1/sr.
    ///
    /// - `normal`: unit length, towards `towards`.
    pub(in crate::illumination) fn normal_pdf(&self, towards: DVec3, normal: DVec3) -> f64 {
        match self {
            RoughFacets::Slopes(..) => towards.dot(normal) * self.area(normal) / self.projected(towards),
            RoughFacets::Table(table) => table.normal_pdf(normal),
        }
    }

    /// By how much more a direction sees of a facet than samples of it tell: its visible area over the pdf.
    pub(in crate::illumination) fn shown_over_pdf(&self, towards: DVec3, normal: DVec3) -> f64 {
        match self {
            RoughFacets::Slopes(..) => self.projected(towards),
            RoughFacets::Table(table) => {
                let pdf = table.normal_pdf(normal);
                if pdf > 0.0 { towards.dot(normal) * table.area(normal) / pdf } else { 0.0 }
            }
        }
    }

    /// About the roughness m: that of the formula, or of GGX's facets that show as much to the horizon.
    pub(in crate::illumination) fn roughness(&self) -> f64 {
        match self {
            RoughFacets::Slopes(_, roughness) => roughness.max_element(),
            RoughFacets::Table(table) => table.roughness(),
        }
    }
}
