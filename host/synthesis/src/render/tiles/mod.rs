//! A solution by radiosity as tiles: pieces of surfaces with a colour at each corner, to be looked at from anywhere by
//! whoever mixes colours between corners and knows no light.
//!
//! A tile is an element of the solution, or as many of them as make up one of its triangles, if mixing the colours of
//! that triangle's corners comes near enough. Where a neighbour has a corner on an edge of a tile, so has the tile:
//! there are no cracks.
//!
//! *Not modelled*: what depends on the direction of view. Mirrors are black, what light goes straight through is left
//! out, a sky is background. Patterns finer than elements are looked up at corners only.

mod points;
#[cfg(test)]
mod tests;
mod tile;
mod tree;

pub use tile::ColorTile;

use super::RenderError;
use super::radiosity::Radiosity;
use super::world::Appearance;
use crate::color::srgb;
use crate::illumination::Light;
use crate::plan::Plan;
use crate::scene::Prepared;
use glam::DVec3;
use points::PointTree;
use rayon::prelude::*;
use tile::TileCorner;
use tree::{TileNode, TileShading, TrianglePiece};

/// Colours of a tile may be so far from those of its elements: a step of eight bits.
const TOLERANCE: f64 = 1.0 / 255.0;
/// How much farther if there are too many tiles.
const COARSER: f64 = 1.5;
/// Corners of a tile at the most: those that a polygon of the workstation may have.
const MOST_IN_TILE: usize = 250;
/// Places nearer than this are one, as a part of the diagonal of the scene.
const NEAR: f64 = 1.0 / (1 << 30) as f64;
/// A corner is on an edge if it is no farther from it, in such lengths.
const ON_EDGE: f64 = 2.0;
/// Sides of a round lamp.
const LAMP_SIDES: usize = 32;

/// All surfaces of a scene as tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tiling {
    /// The tiles, in the order of the triangles; lamps last.
    pub tiles: Vec<ColorTile>,
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
        let shading = TileShading { solution, appearance: &appearance };
        let shown = |triangle: &u32| {
            let object = prepared.object_of[*triangle as usize];
            let bsdf = appearance.bsdf(object, prepared.material_number(*triangle));
            let [a, b, c] = prepared.corners(*triangle);
            plan.includes_object(object as usize) && !bsdf.is_passable() && (b - a).cross(c - a) != DVec3::ZERO
        };
        let triangles: Vec<u32> = (0..prepared.triangles.len() as u32).filter(shown).collect();
        let trees: Vec<TileNode> = triangles.par_iter().map(|triangle| shading.tree(*triangle)).collect();
        let lamps = lamps(prepared, plan, &appearance);
        let mut tiling = Tiling { elements: trees.iter().map(TileNode::leaves).sum(), ..Tiling::default() };
        let mut tolerance = TOLERANCE;
        let grid = Grid { step: (NEAR * prepared.bounds.diagonal()).max(f64::MIN_POSITIVE) };
        loop {
            let mut pieces: Vec<Vec<TrianglePiece>> = trees.iter().map(|tree| tree.pieces(tolerance)).collect();
            let outlines = outlines(&mut pieces, grid);
            let corners: usize = outlines.iter().flatten().map(Vec::len).sum();
            if corners > most && tolerance < 1.0 {
                tolerance *= COARSER;
                continue;
            }
            let tiles =
                triangles.par_iter().zip(pieces).zip(outlines).flat_map_iter(|((triangle, pieces), outlines)| {
                    let shading = &shading;
                    let tile = move |(piece, outline): (TrianglePiece, Vec<TileCorner>)| {
                        shading.tile(*triangle, &piece, &outline)
                    };
                    pieces.into_iter().zip(outlines).filter(|(_, outline)| outline.len() > 2).map(tile)
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

/// Places so near that they are one, by the lines of a grid.
#[derive(Clone, Copy, Debug)]
struct Grid {
    /// How far its lines are apart.
    step: f64,
}

impl Grid {
    /// The lines that are next to a point.
    fn key(&self, point: DVec3) -> [i64; 3] {
        point.to_array().map(|x| (x / self.step).round() as i64)
    }

    /// The point where lines cross.
    fn point(&self, key: [i64; 3]) -> DVec3 {
        DVec3::from(key.map(|line| line as f64 * self.step))
    }

    /// The crossing that is next to a point.
    fn snapped(&self, point: DVec3) -> DVec3 {
        self.point(self.key(point))
    }
}

/// The corners of all pieces with those that neighbours have on their edges. Divides pieces that would have too many.
/// Of a piece that is next to nothing, fewer than three are left.
fn outlines(pieces: &mut [Vec<TrianglePiece>], grid: Grid) -> Vec<Vec<Vec<TileCorner>>> {
    loop {
        let mut keys: Vec<[i64; 3]> =
            pieces.iter().flatten().flat_map(|piece| piece.corners.map(|corner| grid.key(corner))).collect();
        keys.sort_unstable();
        keys.dedup();
        let points = PointTree::new(keys.into_iter().map(|key| grid.point(key)).collect());
        let outlines: Vec<Vec<Vec<TileCorner>>> = pieces
            .par_iter()
            .map(|pieces| pieces.iter().map(|piece| outline(piece, &points, grid)).collect())
            .collect();
        let mut divided = false;
        for (pieces, outlines) in pieces.iter_mut().zip(&outlines) {
            if outlines.iter().all(|outline| outline.len() <= MOST_IN_TILE) {
                continue;
            }
            divided = true;
            let parts = std::mem::take(pieces).into_iter().zip(outlines);
            *pieces = parts
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

/// The corners of a piece and those that others have on its edges.
fn outline(piece: &TrianglePiece, points: &PointTree, grid: Grid) -> Vec<TileCorner> {
    let mut corners: Vec<TileCorner> = Vec::with_capacity(3);
    for i in 0..3 {
        let j = (i + 1) % 3;
        let ends = [i, j].map(|i| grid.snapped(piece.corners[i]));
        let [from, to] = [i, j].map(|i| piece.weights[i]);
        corners.push((ends[0], from));
        let mixed = |part: f64| std::array::from_fn(|k| from[k] + (to[k] - from[k]) * part);
        let others = points.between(ends, ON_EDGE * grid.step).into_iter();
        corners.extend(others.map(|(part, point)| (point, mixed(part))));
    }
    corners.dedup_by(|one, other| one.0 == other.0);
    if corners.len() > 1 && corners[0].0 == corners[corners.len() - 1].0 {
        corners.pop();
    }
    corners
}

/// The surfaces that emit and are no objects; they do not emit on their reverse.
fn lamps(prepared: &Prepared, plan: &Plan, appearance: &Appearance<'_>) -> Vec<ColorTile> {
    let wavelengths = &appearance.wavelengths;
    let lamp = |(number, light): (usize, &Light)| {
        let Some((patch, radiance)) = light.surface() else { return Vec::new() };
        if !plan.includes_light(number) {
            return Vec::new();
        }
        let strength = wavelengths.light(radiance);
        let sets = wavelengths.count();
        let seen: DVec3 =
            (0..sets).map(|wavelength_set| wavelengths.to_srgb(wavelength_set, strength.of(wavelength_set))).sum();
        let color = [srgb::encoded(seen / sets as f64), DVec3::ZERO];
        let tile = |corners: Vec<DVec3>| ColorTile { colors: vec![color; corners.len()], corners };
        patch.polygons(LAMP_SIDES).into_iter().map(tile).collect()
    };
    prepared.lights.iter().enumerate().flat_map(lamp).collect()
}
