//! Visible triangles of the samples of a strip of the picture.

use super::screen::{ClipCorner, ClippedPolygon, Screen, ScreenPoint};
use super::sorted_groups::SortedGroups;
use super::spans::{Nearness, PictureRegion, SampleLines, Span};
use crate::scene::Prepared;
use rayon::prelude::*;
use std::ops::Range;

/// No triangle, and no outline.
pub(super) const NONE: u32 = u32::MAX;

/// Something to be drawn: a triangle, whole or clipped.
#[derive(Clone, Copy, Debug)]
struct ScreenTriangle {
    triangle: u32,
    /// Index of its outline, if it was clipped.
    outline: u32,
}

/// Numbers of what is drawn, in order, for each band of the picture that it is in.
///
/// - `ranges`: the first and the last line of each. `lines`: of a band; `bands`: how many there are.
pub(super) fn by_band(ranges: &[[f64; 2]], lines: usize, bands: usize) -> SortedGroups<u32> {
    let of = |range: &[f64; 2]| {
        let [from, to] = range.map(|y| (y / lines as f64).floor().clamp(0.0, bands as f64 - 1.0) as usize);
        if range[1] < 0.0 || range[0] >= (lines * bands) as f64 { 0..0 } else { from..to + 1 }
    };
    let all = ranges.iter().zip(0..).flat_map(|(range, number)| of(range).map(move |band| (band, number)));
    SortedGroups::new(bands, all)
}

/// The first and the last line of a polygon.
pub(super) fn lines_of(corners: &[ScreenPoint]) -> [f64; 2] {
    corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p.y), high.max(p.y)])
}

/// All triangles in the picture.
pub(super) struct ScreenTriangles<'a> {
    prepared: &'a Prepared,
    points: Vec<ScreenPoint>,
    triangles: Vec<ScreenTriangle>,
    outlines: Vec<ClippedPolygon>,
    bands: SortedGroups<u32>,
    /// For each triangle of the scene, whether light goes straight through it; empty if none is so.
    passable: &'a [bool],
}

/// A passable surface before the opaque one of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassableLayer {
    pub(super) sample: u32,
    pub(super) near: f64,
    pub(super) triangle: u32,
    /// The sense of rotation, as [`Span::turns`].
    pub(super) turns: i32,
}

/// Columns of a tile of a strip.
const TILE: usize = 32;

/// A strip of the picture: what its samples see.
#[derive(Default)]
pub(super) struct Strip {
    /// For each sample, line by line, the nearness of its opaque surface, minus infinity if there is none.
    pub(super) near: Vec<f64>,
    /// The triangle of each.
    pub(super) triangles: Vec<u32>,
    /// For each tile of columns, the least nearness of what its samples see, infinite where there is nothing.
    farthest: Vec<f64>,
    /// Passable surfaces, sample by sample from the nearest.
    pub(super) layers: Vec<PassableLayer>,
    /// The begin of the layers of each sample, if there are any at all.
    pub(super) begins: Vec<u32>,
    /// Spans that were drawn.
    pub(super) spans: u64,
}

impl<'a> ScreenTriangles<'a> {
    /// Places the triangles in the picture.
    ///
    /// - `lines`: of a band; `bands`: how many there are.
    pub(super) fn new(
        prepared: &'a Prepared,
        triangles: &[u32],
        passable: &'a [bool],
        screen: &Screen,
        lines: usize,
        bands: usize,
    ) -> ScreenTriangles<'a> {
        let place = |vertex: &glam::DVec3| {
            let corner = screen.corner(*vertex);
            (Screen::point(&corner), screen.outside(&corner))
        };
        let (points, outside): (Vec<ScreenPoint>, Vec<u8>) =
            prepared.vertices.par_iter().with_min_len(1 << 12).map(place).unzip();
        let placed = |&triangle: &u32| -> Option<([f64; 2], u32, Option<Box<ClippedPolygon>>)> {
            let [a, b, c] = prepared.triangles[triangle as usize].map(|i| i as usize);
            let beside = [outside[a], outside[b], outside[c]];
            if beside[0] & beside[1] & beside[2] != 0 {
                return None;
            }
            if beside == [0; 3] {
                let range = lines_of(&[points[a], points[b], points[c]]);
                // Between two lines of samples there is nothing to draw.
                return (range[0].ceil() < range[1].ceil()).then_some((range, triangle, None));
            }
            let corners: [ClipCorner; 3] = prepared.corners(triangle).map(|corner| screen.corner(corner));
            let outline = screen.clip(&corners, 1)?;
            Some((lines_of(outline.corners()), triangle, Some(Box::new(outline))))
        };
        let placed: Vec<_> = triangles.par_iter().with_min_len(1 << 12).filter_map(placed).collect();
        let (mut ranges, mut facets) = (Vec::with_capacity(placed.len()), Vec::with_capacity(placed.len()));
        let mut outlines = Vec::new();
        for (range, triangle, clipped) in placed {
            let outline = if clipped.is_some() { outlines.len() as u32 } else { NONE };
            outlines.extend(clipped.map(|outline| *outline));
            ranges.push(range);
            facets.push(ScreenTriangle { triangle, outline });
        }
        let bands = by_band(&ranges, lines, bands);
        ScreenTriangles { prepared, points, triangles: facets, outlines, bands, passable }
    }

    /// The point of a vertex in the picture; worth nothing for one that is cut off.
    pub(super) fn point(&self, vertex: u32) -> ScreenPoint {
        self.points[vertex as usize]
    }

    /// Gives the facets of a band that are passable or not.
    fn each(&self, band: usize, passable: bool, mut give: impl FnMut(u32, &[ScreenPoint])) {
        for &number in self.bands.of(band) {
            let ScreenTriangle { triangle, outline } = self.triangles[number as usize];
            if self.passable.get(triangle as usize).copied().unwrap_or(false) != passable {
                continue;
            }
            match self.outlines.get(outline as usize) {
                Some(outline) => give(triangle, outline.corners()),
                None => give(triangle, &self.prepared.triangles[triangle as usize].map(|i| self.points[i as usize])),
            }
        }
    }

    /// Finds what the samples of some lines of a band see.
    pub(super) fn rasterize(&self, band: usize, lines: &SampleLines, strip: &mut Strip) {
        let samples = lines.range.len() * lines.width;
        let Strip { near, triangles: seen, farthest, layers, begins, spans } = strip;
        near.clear();
        near.resize(samples, f64::NEG_INFINITY);
        seen.clear();
        seen.resize(samples, NONE);
        layers.clear();
        begins.clear();
        let first = |span: &Span| (span.line - lines.range.start) * lines.width;
        self.each(band, false, |triangle, corners| {
            let Some(nearness) = Nearness::new(corners) else { return };
            lines.spans(corners, &PictureRegion::ALL, |span| {
                *spans += 1;
                let (start, step, bounded) = nearness.along(&span, lines.offset(span.line));
                let range = first(&span) + span.from..first(&span) + span.to;
                let samples = near[range.clone()].iter_mut().zip(&mut seen[range]);
                for (i, (near, seen)) in samples.enumerate() {
                    let value = start + step * i as f64;
                    let value = if bounded { nearness.bound(value) } else { value };
                    if value > *near {
                        (*near, *seen) = (value, triangle);
                    }
                }
            });
        });
        let mut least = vec![f64::INFINITY; lines.width];
        for line in near.chunks(lines.width) {
            for (least, near) in least.iter_mut().zip(line) {
                let seen = if *near == f64::NEG_INFINITY { f64::INFINITY } else { *near };
                *least = if seen < *least { seen } else { *least };
            }
        }
        farthest.clear();
        farthest.extend(least.chunks(TILE).map(|tile| tile.iter().copied().fold(f64::INFINITY, f64::min)));
        if self.passable.is_empty() {
            return;
        }
        self.each(band, true, |triangle, corners| {
            let Some(nearness) = Nearness::new(corners) else { return };
            lines.spans(corners, &PictureRegion::ALL, |span| {
                *spans += 1;
                let (start, step, _) = nearness.along(&span, lines.offset(span.line));
                for i in 0..span.to - span.from {
                    let sample = first(&span) + span.from + i;
                    let value = nearness.bound(start + step * i as f64);
                    if value > near[sample] {
                        layers.push(PassableLayer { sample: sample as u32, near: value, triangle, turns: span.turns });
                    }
                }
            });
        });
        if !layers.is_empty() {
            layers.sort_by(|a, b| {
                a.sample.cmp(&b.sample).then(b.near.total_cmp(&a.near)).then(a.triangle.cmp(&b.triangle))
            });
            begins.resize(samples + 1, 0);
            layers.iter().for_each(|layer| begins[layer.sample as usize + 1] += 1);
            (0..samples).for_each(|sample| begins[sample + 1] += begins[sample]);
        }
    }
}

impl Strip {
    /// The columns among some in which a polygon may stand before something; layers only come nearer.
    ///
    /// - `most`: its greatest nearness between two columns.
    pub(super) fn before(&self, columns: Range<usize>, most: impl Fn(f64, f64) -> f64) -> Range<usize> {
        let stands = |tile: &usize| most((tile * TILE) as f64, ((tile + 1) * TILE) as f64) > self.farthest[*tile];
        let mut tiles = columns.start / TILE..columns.end.div_ceil(TILE).min(self.farthest.len());
        let Some(first) = tiles.find(stands) else { return 0..0 };
        let last = tiles.rev().find(stands).unwrap_or(first);
        columns.start.max(first * TILE)..columns.end.min((last + 1) * TILE)
    }

    /// The layers of a sample, as a range of all of them.
    pub(super) fn layers_of(&self, sample: usize) -> Range<usize> {
        match self.begins.get(sample..sample + 2) {
            Some(range) => range[0] as usize..range[1] as usize,
            None => 0..0,
        }
    }

    /// Opaque surfaces and layers together.
    pub(super) fn fragments(&self) -> usize {
        self.near.len() + self.layers.len()
    }
}
