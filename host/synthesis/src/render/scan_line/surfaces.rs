//! Surfaces in a pixel: which samples see them, and the element in the middle of what they see.

use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::optics::Bsdf;
use crate::numeric::ray::Ray;
use crate::render::world::SurfaceElement;
use glam::DVec3;
use std::ops::Range;

/// Triangles of one curved object that share a pixel are lit as one if their normals differ by less (cosine).
const SMOOTH: f64 = 0.94;
/// Cosine above which flat triangles lie in one plane, and are lit as one.
const FLAT: f64 = 1.0 - 1e-12;
/// Triangles are lit as one only if their depths differ by less than this part of them.
const BESIDE: f64 = 0.01;

/// A pixel of a strip.
pub(super) struct StripPixel<'p> {
    /// Column, row.
    pub(super) at: [usize; 2],
    /// Its first sample in the strip, and how far the next are apart.
    pub(super) first: usize,
    pub(super) stride: usize,
    /// How many samples of the pixel are in strips before.
    pub(super) begin: usize,
    /// Places of its samples in it.
    pub(super) places: &'p [[f64; 2]],
    /// The mean of these places, and the part of all that each of them is.
    pub(super) mean: [f64; 2],
    pub(super) part: f64,
}

impl StripPixel<'_> {
    /// How many samples it has.
    pub(super) fn count(&self) -> usize {
        self.places.len()
    }

    /// Its samples in the strip.
    pub(super) fn samples(&self) -> impl Iterator<Item = usize> {
        (0..self.places.len()).map(|i| self.first + i * self.stride)
    }

    /// The middle of its samples in the picture.
    pub(super) fn middle(&self) -> [f64; 2] {
        [self.at[0] as f64 + self.mean[0], self.at[1] as f64 + self.mean[1]]
    }

    /// The place of a sample in the picture.
    pub(super) fn place(&self, i: usize) -> [f64; 2] {
        [self.at[0] as f64 + self.places[i][0], self.at[1] as f64 + self.places[i][1]]
    }
}

/// A fragment of a sample: the surface of the pixel, and the place of its counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleFragment {
    pub(super) surface: usize,
    pub(super) fragment: usize,
    pub(super) triangle: u32,
    /// Index of the sample in the pixel.
    pub(super) sample: usize,
}

/// A surface in a pixel.
pub(super) struct PixelSurface {
    /// The triangle that was seen first, its normal, and how near it was.
    pub(super) triangle: u32,
    pub(super) face: DVec3,
    pub(super) near: f64,
    pub(super) curved: bool,
    /// Its object and material.
    pub(super) ids: [u32; 2],
    /// How many samples see it, the sum of their places in pixels, and whether all see the same triangle.
    pub(super) count: u32,
    pub(super) sum: [f64; 2],
    pub(super) alone: bool,
    /// Sums of their nearness and depth.
    pub(super) nearness: [f64; 2],
    /// Index of its own among the elements that were found.
    pub(super) interaction: Option<usize>,
    /// Irradiance by other surfaces, W/m².
    pub(super) irradiance: Channels,
    /// At the wavelengths of the shading context, its radiance towards the camera without lights, and the part of light
    /// that goes straight through.
    pub(super) unlit_radiance: Channels,
    pub(super) transmittance: Channels,
    /// Indices of its own among the contributions that were found.
    pub(super) contributions: Range<usize>,
}

impl PixelSurface {
    /// Whether two triangles are lit as one.
    pub(super) fn goes_on_in(&self, other: &PixelSurface) -> bool {
        self.curved == other.curved
            && self.ids == other.ids
            && (self.near - other.near).abs() <= BESIDE * self.near.abs()
            && self.face.dot(other.face) > if self.curved { SMOOTH } else { FLAT }
    }

    /// Adds a sample.
    ///
    /// - `at`: its place in the picture. `nearness`: and its depth.
    pub(super) fn add(&mut self, triangle: u32, at: [f64; 2], nearness: [f64; 2]) {
        self.count += 1;
        self.alone &= self.triangle == triangle;
        for i in 0..2 {
            self.sum[i] += at[i];
            self.nearness[i] += nearness[i];
        }
    }
}

/// An element in a pixel.
#[derive(Clone, Copy)]
pub(super) struct PixelInteraction<'a> {
    pub(super) element: SurfaceElement,
    /// Whether its triangle stands for a curved surface.
    pub(super) curved: bool,
    /// Whether neighbours in its triangle differ in their place only.
    pub(super) is_flat: bool,
    /// About its normal.
    pub(super) frame: ShadingFrame,
    pub(super) bsdf: &'a Bsdf,
    pub(super) distance: f64,
    /// Object and material.
    pub(super) ids: [u32; 2],
    pub(super) towards: DVec3,
    pub(super) triangle: u32,
    pub(super) weights: [f64; 3],
    /// Sides of what it stands for.
    pub(super) sides: [DVec3; 2],
}

impl PixelInteraction<'_> {
    /// The element with origins of rays in its place, which are not moved with it.
    pub(super) fn with_origins(&self) -> SurfaceElement {
        let element = &self.element;
        let clearance = element.face * element.clearance;
        let (leave, through) = (element.position + clearance, element.position - clearance);
        match self.is_flat {
            true => SurfaceElement { leave, leave_curved: leave, through, ..*element },
            false => *element,
        }
    }

    /// Moves to where another line of sight hits a triangle, if it is the same, flat and without a texture.
    #[inline]
    pub(super) fn move_to(&mut self, triangle: u32, ray: &Ray) -> bool {
        if !self.is_flat || triangle != self.triangle {
            return false;
        }
        let face = self.element.face;
        let t = (self.element.position - ray.origin).dot(face) / ray.direction.dot(face);
        let length = ray.direction.length();
        self.element.position = ray.at(t);
        (self.distance, self.towards) = (t * length, ray.direction * length.recip());
        self.distance.is_finite()
    }
}
