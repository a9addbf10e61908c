//! A solution by radiosity as tiles: pieces of surfaces with a colour at each corner, to be looked at from anywhere by
//! whoever mixes colours between corners and knows no light.
//!
//! A tile is an element of the solution, or as many of them as make up one of its triangles, if mixing the colours of that
//! triangle's corners comes near enough. Where a neighbour has a corner on an edge of a tile, so has the tile: there are no
//! cracks.
//!
//! *Not modelled*: what depends on the direction of view. Mirrors are black, what light goes straight through is left out, a
//! sky is background. Patterns finer than elements are looked up at corners only.

mod tree;
#[cfg(test)]
mod tests;

use super::RenderError;
use super::radiosity::Radiosity;
use super::ready::Appearance;
use crate::color::srgb;
use crate::illumination::Light;
use crate::plan::Plan;
use crate::scene::Prepared;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use tree::{Looks, Node, Piece};

/// Colours of a tile may be so far from those of its elements: a step of eight bits.
const TOLERANCE: f64 = 1.0 / 255.0;
/// How much farther if there are too many tiles.
const COARSER: f64 = 1.5;
/// Corners of a tile at the most: those that a polygon of the workstation may have.
const MOST_IN_TILE: usize = 250;
/// Sides of a round lamp.
const LAMP_SIDES: usize = 32;

/// A piece of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Its corners, counter-clockwise seen from outside, in scene coordinates; 3 and more.
    pub corners: Vec<DVec3>,
    /// The colours seen at each of them from outside and from inside: red, green and blue of sRGB as displays get them,
    /// 0..=1.
    pub colors: Vec<[DVec3; 2]>,
}

/// All surfaces of a scene as tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tiling {
    /// The tiles, in the order of the triangles; lamps last.
    pub tiles: Vec<Tile>,
    /// The elements for which they stand, where those of two sides lie upon each other counted once.
    pub elements: usize,
    /// How far a colour may be from that of an element, 0..=1.
    pub tolerance: f64,
}

impl Tiling {
    /// Tiles for a solution, on the threads of the pool in which it is called. The same for any number of threads.
    ///
    /// - `most`: corners. If there are more, colours may be farther off, but each triangle stays a tile at least.
    ///
    /// # Errors
    /// [`RenderError::Material`].
    ///
    /// # Source
    /// Ours; that colours at corners are mixed between them: Gouraud 1971, Cohen and Greenberg 1985.
    pub fn new(solution: &Radiosity, prepared: &Prepared, plan: &Plan, most: usize) -> Result<Tiling, RenderError> {
        let appearance = Appearance::new(prepared, plan)?;
        let looks = Looks { solution, appearance: &appearance };
        let shown = |triangle: &u32| {
            let object = prepared.object_of[*triangle as usize];
            let optics = appearance.optics(object, prepared.material_number(*triangle));
            let [a, b, c] = prepared.corners(*triangle);
            plan.keeps_object(object as usize) && !optics.is_passable() && (b - a).cross(c - a) != DVec3::ZERO
        };
        let triangles: Vec<u32> = (0..prepared.triangles.len() as u32).filter(shown).collect();
        let trees: Vec<Node> = triangles.par_iter().map(|triangle| looks.tree(*triangle)).collect();
        let lamps = lamps(prepared, plan, &appearance);
        let mut tiling = Tiling { elements: trees.iter().map(Node::leaves).sum(), ..Tiling::default() };
        let mut tolerance = TOLERANCE;
        loop {
            let mut pieces: Vec<Vec<Piece>> = trees.iter().map(|tree| tree.pieces(tolerance)).collect();
            let outlines = outlines(&mut pieces);
            let corners: usize = outlines.iter().flatten().map(Vec::len).sum();
            if corners > most && tolerance < 1.0 {
                tolerance *= COARSER;
                continue;
            }
            let tiles =
                triangles.par_iter().zip(pieces).zip(outlines).flat_map_iter(|((triangle, pieces), outlines)| {
                    let looks = &looks;
                    let tile = move |(piece, outline): (Piece, Vec<Corner>)| looks.tile(*triangle, &piece, &outline);
                    pieces.into_iter().zip(outlines).map(tile)
                });
            tiling.tiles = tiles.collect();
            tiling.tiles.extend(lamps);
            tiling.tolerance = tolerance;
            return Ok(tiling);
        }
    }

    /// Corners of all tiles together.
    pub fn corners(&self) -> usize {
        self.tiles.iter().map(|tile| tile.corners.len()).sum()
    }
}

/// A corner of a tile, and the weights of the corners of its triangle there.
type Corner = (DVec3, [f64; 3]);

/// A point by its bits.
fn key(point: DVec3) -> [u64; 3] {
    // Adding 0 turns -0 into 0.
    point.to_array().map(|x| (x + 0.0).to_bits())
}

/// The corners of all pieces with those that neighbours have on their edges. Divides pieces that would have too many.
fn outlines(pieces: &mut [Vec<Piece>]) -> Vec<Vec<Vec<Corner>>> {
    loop {
        let known: FxHashSet<[u64; 3]> = pieces.iter().flatten().flat_map(|piece| piece.corners.map(key)).collect();
        let outlines: Vec<Vec<Vec<Corner>>> =
            pieces.par_iter().map(|pieces| pieces.iter().map(|piece| outline(piece, &known)).collect()).collect();
        let mut divided = false;
        for (pieces, outlines) in pieces.iter_mut().zip(&outlines) {
            if outlines.iter().all(|outline| outline.len() <= MOST_IN_TILE) {
                continue;
            }
            divided = true;
            let halved = std::mem::take(pieces).into_iter().zip(outlines);
            *pieces = halved
                .flat_map(|(piece, outline)| match outline.len() {
                    0..=MOST_IN_TILE => vec![piece],
                    _ => piece.quarters().to_vec(),
                })
                .collect();
        }
        if !divided {
            return outlines;
        }
    }
}

/// The corners of a piece and those that others have in the middle of its edges, in the middle of their halves, and so on.
fn outline(piece: &Piece, known: &FxHashSet<[u64; 3]>) -> Vec<Corner> {
    let mut corners = Vec::with_capacity(3);
    for i in 0..3 {
        let of = |i: usize| (piece.corners[i], piece.weights[i]);
        corners.push(of(i));
        between(of(i), of((i + 1) % 3), known, &mut corners);
    }
    corners
}

fn between(from: Corner, to: Corner, known: &FxHashSet<[u64; 3]>, corners: &mut Vec<Corner>) {
    let middle = tree::middle(from, to);
    if middle.0 == from.0 || middle.0 == to.0 || !known.contains(&key(middle.0)) {
        return;
    }
    between(from, middle, known, corners);
    corners.push(middle);
    between(middle, to, known, corners);
}

/// The surfaces that emit and are no objects; they do not emit on their reverse.
fn lamps(prepared: &Prepared, plan: &Plan, appearance: &Appearance<'_>) -> Vec<Tile> {
    let wavelengths = &appearance.wavelengths;
    let lamp = |(number, light): (usize, &Light)| {
        let Light::Area { patch, radiance } = light else { return Vec::new() };
        if !plan.keeps_light(number) {
            return Vec::new();
        }
        let strength = wavelengths.light(radiance);
        let combs = wavelengths.combs();
        let seen: DVec3 = (0..combs).map(|comb| wavelengths.seen(comb, strength.of(comb))).sum();
        let color = [srgb::encoded(seen / combs as f64), DVec3::ZERO];
        let tile = |corners: Vec<DVec3>| Tile { colors: vec![color; corners.len()], corners };
        patch.polygons(LAMP_SIDES).into_iter().map(tile).collect()
    };
    prepared.lights.iter().enumerate().flat_map(lamp).collect()
}
