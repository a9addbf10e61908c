//! A triangle with its elements and their colours, and which of its parts may be one tile.

use super::tile::{ColorTile, TileCorner};
use crate::color::{Channels, srgb};
use crate::numeric::triangle::weights;
use crate::render::indirect::{IndirectLight, IrradiancePart};
use crate::render::radiosity::{ElementTree, Radiosity};
use crate::render::world::{Appearance, diffuse_albedo};
use glam::{DVec3, Vec3};
use std::f64::consts::FRAC_1_PI;

/// Colours are looked up so far from a corner towards the middle of the piece, as a part of the way: what a neighbour
/// has there does not count.
const ASIDE: f64 = 1e-6;

/// A triangle, or one of the four into which the middles of its edges divide such a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TrianglePiece {
    /// Its corners, the same to the bit for all pieces that share them.
    pub(super) corners: [DVec3; 3],
    /// The weights of the corners of the triangle there.
    pub(super) weights: [[f64; 3]; 3],
}

/// The point in the middle between two.
fn middle((p, u): TileCorner, (q, v): TileCorner) -> TileCorner {
    (0.5 * (p + q), std::array::from_fn(|i| 0.5 * (u[i] + v[i])))
}

impl TrianglePiece {
    /// A whole triangle.
    fn whole(corners: [DVec3; 3]) -> TrianglePiece {
        TrianglePiece { corners, weights: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] }
    }

    /// The pieces at its corners, and the one in the middle.
    pub(super) fn quarters(&self) -> [TrianglePiece; 4] {
        let [a, b, c] = [0, 1, 2].map(|i| (self.corners[i], self.weights[i]));
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]]
            .map(|of| TrianglePiece { corners: of.map(|corner| corner.0), weights: of.map(|corner| corner.1) })
    }

    /// The weights in its middle.
    fn center(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.weights.iter().map(|weights| weights[i]).sum::<f64>() / 3.0)
    }
}

/// The colours of a point from outside and from inside.
type Colors = [Vec3; 2];

/// A piece with the pieces into which it is divided.
#[derive(Debug)]
pub(super) struct TileNode {
    piece: TrianglePiece,
    /// How far mixtures of the colours of its corners are from those of its elements, 0..=1.
    off: f32,
    children: Vec<TileNode>,
}

impl TileNode {
    /// How many elements there are in it.
    pub(super) fn leaves(&self) -> usize {
        if self.children.is_empty() { 1 } else { self.children.iter().map(TileNode::leaves).sum() }
    }

    /// The largest pieces of it whose colours are off by no more than a tolerance.
    pub(super) fn pieces(&self, tolerance: f64) -> Vec<TrianglePiece> {
        let mut pieces = Vec::new();
        self.add_pieces(tolerance, &mut pieces);
        pieces
    }

    fn add_pieces(&self, tolerance: f64, pieces: &mut Vec<TrianglePiece>) {
        if !self.children.is_empty() && f64::from(self.off) > tolerance {
            self.children.iter().for_each(|child| child.add_pieces(tolerance, pieces));
        } else {
            pieces.push(self.piece);
        }
    }
}

/// How the solution divides the outer and the inner side of a piece; the corners of the inner side run the other way.
type Sides<'d> = [Option<&'d ElementTree>; 2];

/// The parts of a piece. Where its two sides are not divided alike, they are those of the side that has more of them.
fn parts<'d>(triangle: [DVec3; 3], piece: &TrianglePiece, sides: Sides<'d>) -> Vec<(TrianglePiece, Sides<'d>)> {
    /// The quarter of the inner side that lies behind each quarter of the outer one.
    const BEHIND: [usize; 4] = [0, 2, 1, 3];
    let [outer, inner] = sides.map(|side| side.filter(|side| !side.parts.is_empty()));
    let quarters = |outer: Option<&'d ElementTree>, inner: Option<&'d ElementTree>| {
        let of = |k: usize| [outer.map(|side| &side.parts[k]), inner.map(|side| &side.parts[BEHIND[k]])];
        piece.quarters().into_iter().enumerate().map(|(k, quarter)| (quarter, of(k))).collect()
    };
    let is_cut = |side: Option<&ElementTree>| side.is_some_and(|side| side.is_cut);
    let leaves = |side: Option<&ElementTree>| side.map_or(0, ElementTree::leaves);
    let whole =
        |corners: [DVec3; 3]| TrianglePiece { corners, weights: corners.map(|corner| weights(triangle, corner)) };
    match (outer, inner) {
        (None, None) => Vec::new(),
        (outer, inner) if !is_cut(outer) && !is_cut(inner) => quarters(outer, inner),
        (Some(outer), inner) if leaves(Some(outer)) >= leaves(inner) => match outer.is_cut {
            true => outer.parts.iter().map(|part| (whole(part.corners), [Some(part), None])).collect(),
            false => quarters(Some(outer), None),
        },
        (_, Some(inner)) if inner.is_cut => {
            let turned = |[a, b, c]: [DVec3; 3]| [a, c, b];
            inner.parts.iter().map(|part| (whole(turned(part.corners)), [None, Some(part)])).collect()
        }
        (_, inner) => quarters(None, inner),
    }
}

/// Shading of tiles: the looks of surfaces in the light of a solution.
pub(super) struct TileShading<'a> {
    pub(super) solution: &'a Radiosity,
    pub(super) appearance: &'a Appearance<'a>,
}

impl TileShading<'_> {
    /// A triangle with all elements of both its sides.
    pub(super) fn tree(&self, triangle: u32) -> TileNode {
        let piece = TrianglePiece::whole(self.appearance.prepared.corners(triangle));
        let sides = [true, false].map(|outside| self.solution.element_tree(triangle, outside));
        self.node(triangle, piece, sides.each_ref().map(Option::as_ref), &mut Vec::new())
    }

    /// A piece with the elements in it, of which it adds the corners and their colours.
    fn node(
        &self,
        triangle: u32,
        piece: TrianglePiece,
        sides: Sides<'_>,
        samples: &mut Vec<(DVec3, Colors)>,
    ) -> TileNode {
        let center = piece.center();
        let colors = piece.weights.map(|weights| self.colors(triangle, aside(weights, center)));
        let parts = parts(self.appearance.prepared.corners(triangle), &piece, sides);
        if parts.is_empty() {
            samples.extend(piece.corners.into_iter().zip(colors));
            return TileNode { piece, off: 0.0, children: Vec::new() };
        }
        let first = samples.len();
        let children = parts.into_iter().map(|(part, sides)| self.node(triangle, part, sides, samples)).collect();
        let off = |(point, seen): &(DVec3, Colors)| {
            let shares = weights(piece.corners, *point).map(|share| share as f32);
            let mixed = |side: usize| (0..3).map(|i| colors[i][side] * shares[i]).sum::<Vec3>();
            [0, 1].map(|side| (mixed(side) - seen[side]).abs().max_element()).into_iter().fold(0.0, f32::max)
        };
        let off = samples[first..].iter().map(off).fold(0.0, f32::max);
        TileNode { piece, off, children }
    }

    /// The tile of a piece with more corners.
    pub(super) fn tile(&self, triangle: u32, piece: &TrianglePiece, outline: &[TileCorner]) -> ColorTile {
        let center = piece.center();
        let color = |(_, weights): &TileCorner| self.colors(triangle, aside(*weights, center)).map(Vec3::as_dvec3);
        ColorTile {
            corners: outline.iter().map(|corner| corner.0).collect(),
            colors: outline.iter().map(color).collect(),
        }
    }

    /// The colours of a place of a triangle, as a display gets them.
    fn colors(&self, triangle: u32, weights: [f64; 3]) -> Colors {
        let Appearance { prepared, wavelengths, .. } = self.appearance;
        let (object, material) = (prepared.object_of[triangle as usize], prepared.material_number(triangle));
        let bsdf = self.appearance.bsdf(object, material);
        let mixture = bsdf
            .is_textured()
            .then(|| bsdf.texture_mixture(&prepared.texture_place(triangle, weights, Default::default())));
        let irradiance =
            [true, false].map(|outside| self.solution.irradiance(triangle, outside, weights, IrradiancePart::All));
        let mut seen = [DVec3::ZERO; 2];
        let sets = wavelengths.count();
        for wavelength_set in 0..sets {
            let own = [true, false].map(|outside| {
                let emission = self.appearance.emission(object, material, outside, wavelength_set);
                emission.map_or(Channels::ZERO, |(emission, _)| emission)
            });
            let texture_values = mixture.as_ref().map(|mixture| mixture.at(wavelength_set));
            let reflectance = diffuse_albedo(
                bsdf,
                wavelength_set,
                texture_values.as_ref().map_or(&[], |painting| painting.as_slice()),
            );
            for ((seen, irradiance), own) in seen.iter_mut().zip(irradiance).zip(own) {
                *seen += wavelengths.to_srgb(wavelength_set, own + reflectance * irradiance * FRAC_1_PI);
            }
        }
        seen.map(|seen| srgb::encoded(seen / sets as f64).as_vec3())
    }
}

/// A place a hair nearer to the middle of a piece.
fn aside(weights: [f64; 3], center: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| weights[i] + (center[i] - weights[i]) * ASIDE)
}
