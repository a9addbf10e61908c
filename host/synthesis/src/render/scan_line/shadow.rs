//! Crow's shadow volumes in the picture: how many of them each surface that is seen is in.
//!
//! From the eye to the surface, every shadow polygon in front of it leads into a volume or out of one. The sides behind
//! silhouettes are enough: nothing that throws a shadow stands between the eye and what it sees, but for passable
//! surfaces and what is nearer than the near plane, which are counted, too. A surface is never compared with its own
//! triangle, so that none shadows itself by rounding.
//!
//! # Source
//! Crow 1977, shadow algorithms for computer graphics; the multiplicity of edges after Bergeron 1986.

use super::casters::{Casters, Silhouette};
use super::enclosed::ShadowVolumes;
use super::lamp::{LampPoint, LightPosition};
use super::reach::Reach;
use super::screen::{ClipCorner, ClippedPolygon, MOST_CORNERS, Screen, ScreenPoint};
use super::sorted_groups::SortedGroups;
use super::spans::{Nearness, PictureRegion, SampleLines};
use super::visibility::{ScreenTriangles, Strip, by_band, lines_of};
use glam::DVec3;
use rayon::prelude::*;

/// A shadow polygon.
struct ShadowPolygon {
    outline: ClippedPolygon,
    /// The part of the picture in which it may stand before something.
    within: PictureRegion,
    /// How many volumes are entered where it is seen to turn clockwise.
    weight: i32,
    group: u8,
}

impl ShadowPolygon {
    /// The first and last line of the polygon.
    fn lines(&self) -> [f64; 2] {
        let [first, last] = lines_of(self.outline.corners());
        [first.max(self.within.lines.start as f64), last.min(self.within.lines.end as f64)]
    }
}

/// The shadow volumes of one light in the picture.
pub(super) struct Shadow {
    polygons: Vec<ShadowPolygon>,
    bands: SortedGroups<u32>,
    /// In how many volumes of each group the eye is.
    start: Vec<i32>,
    pub(super) facing: Vec<i8>,
    pub(super) silhouettes: Vec<Silhouette>,
    pub(super) light: LightPosition,
}

impl Shadow {
    /// - `own`: the light of the scene that it is, if it is one. `lines`: of a band; `bands`: how many there are. `groups`:
    ///   of casters.
    pub(super) fn new(
        casters: &Casters<'_>,
        LampPoint { position: light, light: own, .. }: LampPoint,
        screen: &Screen,
        facets: &ScreenTriangles<'_>,
        reach: &Reach<'_>,
        [lines, bands]: [usize; 2],
        groups: usize,
    ) -> Shadow {
        let facing = casters.facing(&light, own);
        let silhouettes = casters.silhouettes(&facing);
        let start = casters.start(&light, screen.viewpoint);
        let start = start.map_or(vec![0; groups], |start| {
            ShadowVolumes::new(casters, light, &facing, &silhouettes, groups).counts(start)
        });
        let behind = |silhouette: &Silhouette| side(casters, &light, screen, facets, reach, silhouette);
        let mut polygons: Vec<ShadowPolygon> = silhouettes.par_iter().with_min_len(1 << 8).filter_map(behind).collect();
        if screen.clips_near() {
            for &triangle in casters.triangles.iter().filter(|triangle| facing[**triangle as usize] != 0) {
                let corners = casters.prepared.corners(triangle).map(|corner| screen.corner(corner));
                if corners.iter().any(|corner| corner[4] < 0.0)
                    && let Some(outline) = screen.clip(&corners, -1)
                {
                    let weight = -i32::from(facing[triangle as usize]) * screen.handed();
                    // Nearer than everything.
                    let outline = outline.brought_near();
                    polygons.push(ShadowPolygon {
                        outline,
                        within: PictureRegion::ALL,
                        weight,
                        group: casters.group(triangle),
                    });
                }
            }
        }
        let ranges: Vec<[f64; 2]> = polygons.iter().map(ShadowPolygon::lines).collect();
        let bands = by_band(&ranges, lines, bands);
        Shadow { polygons, bands, start, facing, silhouettes, light }
    }

    /// Counts for each surface of a strip in how many volumes it is: group by group, opaque surfaces and then layers.
    ///
    /// - Returns how many spans were drawn.
    pub(super) fn count(
        &self,
        casters: &Casters<'_>,
        handed: i32,
        band: usize,
        lines: &SampleLines,
        strip: &Strip,
        counts: &mut Vec<i32>,
    ) -> u64 {
        let fragments = strip.fragments();
        counts.clear();
        for &start in &self.start {
            counts.resize(counts.len() + fragments, start);
        }
        let samples = strip.near.len();
        let mut spans = 0;
        for &number in self.bands.of(band) {
            let ShadowPolygon { outline, within, weight, group } = &self.polygons[number as usize];
            let Some(nearness) = Nearness::new(outline.corners()) else { continue };
            let [low, high] = columns_of(outline.corners());
            let columns = within.columns.start.max(low)..within.columns.end.min(high).min(lines.width);
            let rows =
                [lines.range.start.max(within.lines.start), lines.range.end.min(within.lines.end)].map(|y| y as f64);
            let columns = strip.before(columns, |from, to| nearness.most([from, to], rows));
            let within = PictureRegion { columns, lines: within.lines.clone() };
            let counts = &mut counts[usize::from(*group) * fragments..][..fragments];
            lines.spans(outline.corners(), &within, |span| {
                spans += 1;
                let (start, step, bounded) = nearness.along(&span, lines.offset(span.line));
                let first = (span.line - lines.range.start) * lines.width + span.from;
                let range = first..first + span.to - span.from;
                let weight = weight * span.turns;
                for (i, (near, count)) in strip.near[range.clone()].iter().zip(&mut counts[range.clone()]).enumerate() {
                    let value = start + step * i as f64;
                    let value = if bounded { nearness.bound(value) } else { value };
                    *count += if value > *near { weight } else { 0 };
                }
                if strip.layers.is_empty() {
                    return;
                }
                for (i, sample) in range.enumerate() {
                    let value = nearness.bound(start + step * i as f64);
                    for layer in strip.layers_of(sample) {
                        counts[samples + layer] += if value > strip.layers[layer].near { weight } else { 0 };
                    }
                }
            });
        }
        if !strip.layers.is_empty() {
            self.count_layers(casters, handed, strip, counts);
        }
        spans
    }

    /// Counts the passable surfaces through which each surface is seen.
    fn count_layers(&self, casters: &Casters<'_>, handed: i32, strip: &Strip, counts: &mut [i32]) {
        let (samples, fragments) = (strip.near.len(), strip.fragments());
        let groups = self.start.len();
        let mut passed = vec![0; groups];
        for sample in 0..samples {
            let layers = strip.layers_of(sample);
            if layers.is_empty() {
                continue;
            }
            passed.fill(0);
            for index in layers {
                for group in 0..groups {
                    counts[group * fragments + samples + index] += passed[group];
                }
                let layer = strip.layers[index];
                let entered = -i32::from(self.facing[layer.triangle as usize]) * handed * layer.turns;
                passed[usize::from(casters.group(layer.triangle))] += entered;
            }
            for group in 0..groups {
                counts[group * fragments + sample] += passed[group];
            }
        }
    }
}

/// The columns of a polygon, the last one excluded.
fn columns_of(corners: &[ScreenPoint]) -> [usize; 2] {
    let range = |[low, high]: [f64; 2], p: &ScreenPoint| [low.min(p.x), high.max(p.x)];
    let [low, high] = corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], range);
    [low.max(0.0) as usize, (high.max(0.0) + 1.0) as usize]
}

/// The shadow polygon behind a silhouette, as far as it is in the picture.
fn side(
    casters: &Casters<'_>,
    light: &LightPosition,
    screen: &Screen,
    facets: &ScreenTriangles<'_>,
    reach: &Reach<'_>,
    silhouette: &Silhouette,
) -> Option<ShadowPolygon> {
    let ends = silhouette.ends.map(|i| casters.prepared.vertices[i as usize]);
    let away = |end: DVec3| screen.direction(-light.from(end));
    let [a, b] = ends.map(|end| screen.corner(end));
    let mut corners: [ClipCorner; 4] = [a, b, away(ends[1]), away(ends[0])];
    let count = if matches!(light, LightPosition::Direction(_)) { 3 } else { 4 };
    corners[3] = if count == 3 { corners[2] } else { corners[3] };
    let corners = &corners[..count];
    let beside = corners.iter().map(|corner| screen.outside(corner) & WINDOW);
    let (any, all) = beside.fold((0, u8::MAX), |(any, all), bits| (any | bits, all & bits));
    if all != 0 {
        return None;
    }
    let outline = if any == 0 {
        // The places of the vertices are those of the triangles, bit by bit.
        let mut points = [ScreenPoint::default(); MOST_CORNERS];
        points[0] = facets.point(silhouette.ends[0]);
        points[1] = facets.point(silhouette.ends[1]);
        points[2] = Screen::point(&corners[2]);
        points[count - 1] = Screen::point(&corners[count - 1]);
        ClippedPolygon::new(&points[..count])
    } else {
        screen.clip(corners, 0)?
    };
    let within = reach.region(ends, ends.map(|end| -light.from(end)))?;
    Some(ShadowPolygon { outline, within, weight: silhouette.weight * screen.handed(), group: silhouette.group })
}

/// The planes that clip shadow polygons: the window and the eye.
const WINDOW: u8 = 0b1_1111;
