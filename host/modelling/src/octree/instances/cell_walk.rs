//! The instances in the cells along a ray.
//!
//! Without aggregates a ray walks the cells of the grid. With them, it walks those of each zone's level where the zone
//! is: the places of a zone lie between two circles about the foot of the eye, and the ray comes to what is placed
//! there while it is between circles as much wider and narrower as anything reaches. So from distance to distance it
//! walks the same number of cells each time that the distance doubles, until the last level.

use super::aggregates::{AggregateView, AggregateZone, Aggregates, CellSlot};
use super::cells::{CellGrid, CellPlace, CellRow, Cells, number_of, resized};
use super::placement::{Instance, PrototypeSphere};
use crate::numeric::ray::Ray;
use glam::DVec2;

/// What is computed of a sphere or a circle is off by less than this part of it.
const ROUNDING: f64 = 1e-9;
/// Zones: one about the eye, and one for each level; a ray may come to each of them twice.
const MOST_STRETCHES: usize = 2 * (super::aggregates::MOST_AGGREGATE_LEVELS as usize + 2);

/// Who is told what a ray may hit.
pub(super) trait CellVisitor {
    /// The lengths between which hits count.
    fn limits(&self) -> [f64; 2];

    /// Takes an instance, and says whether no more are needed.
    ///
    /// - `number`: its own. `ray`: in coordinates of the prototype.
    fn visit(&mut self, number: u64, instance: &Instance, ray: &Ray) -> bool;
}

/// A part of a ray along which it walks the cells of a zone.
#[derive(Clone, Copy)]
struct Stretch {
    zone: AggregateZone,
    chord: [f64; 2],
}

/// Gives what a ray may hit, about the nearer first, until no more is needed; says whether it is so.
///
/// - `spheres`: about the prototypes, by their numbers.
pub(super) fn visit_cells(
    cells: &Cells,
    seen: &Aggregates<'_>,
    spheres: &[PrototypeSphere],
    ray: &Ray,
    visitor: &mut impl CellVisitor,
) -> bool {
    let mut stretches: [Option<Stretch>; MOST_STRETCHES] = [None; MOST_STRETCHES];
    let found = seen.zones().flat_map(|zone| stretches_of(cells, seen, zone, ray, visitor.limits())).flatten();
    for (count, stretch) in found.enumerate() {
        let mut place = count;
        // Sorted by where they begin: there are few.
        while place > 0 && stretches[place - 1].is_some_and(|before| before.chord[0] > stretch.chord[0]) {
            stretches[place] = stretches[place - 1];
            place -= 1;
        }
        stretches[place] = Some(stretch);
    }
    for Stretch { zone, chord: [from, to] } in stretches.into_iter().flatten() {
        let to = to.min(visitor.limits()[1]);
        if from <= to && walk_stretch(cells, seen, spheres, ray, Stretch { zone, chord: [from, to] }, visitor) {
            return true;
        }
    }
    false
}

/// The parts of a ray along which it may hit what is placed in a zone: none, one, or one before and one behind the
/// zones within it.
fn stretches_of(
    cells: &Cells,
    seen: &Aggregates<'_>,
    zone: AggregateZone,
    ray: &Ray,
    limits: [f64; 2],
) -> [Option<Stretch>; 2] {
    let grid = cells.grid.of_level(zone.level(), zone.greatest());
    let whole = |chord| [Some(Stretch { zone, chord }), None];
    let Some([from, to]) = grid.chord(ray, limits) else { return [None; 2] };
    if seen.views.is_empty() {
        return whole([from, to]);
    }
    let (reach, [least, most]) = (grid.overhang + grid.rounding(ray), zone.enlargements());
    let outer = seen.views.iter().filter_map(|view| Circle::of(view, most, ROUNDING)?.widened(reach).chord(ray));
    let outer = outer.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]);
    let Some([from, to]) = outer.map(|outer| [from.max(outer[0]), to.min(outer[1])]) else { return [None; 2] };
    if from > to {
        return [None; 2];
    }
    // What several eyes see as nearer is walked through.
    let [view] = seen.views else { return whole([from, to]) };
    let inner = Circle::of(view, least, -ROUNDING).map(|circle| circle.widened(-reach));
    let Some([leaves, enters]) = inner.and_then(|circle| circle.chord(ray)) else { return whole([from, to]) };
    let before = [from, to.min(leaves)];
    let behind = [from.max(enters), to];
    match [before, behind].map(|[from, to]| from <= to) {
        [true, true] => {}
        [true, false] => return whole(before),
        [false, true] => return whole(behind),
        [false, false] => return [None; 2],
    }
    // No row of cells may be in both: nothing is to be met twice.
    match [before, behind].map(|chord| grid.rows_between(ray, chord)) {
        [Some(one), Some(other)] if one[1] < other[0] || other[1] < one[0] => {
            [before, behind].map(|chord| Some(Stretch { zone, chord }))
        }
        _ => whole([from, to]),
    }
}

/// The circle about the foot of an eye within which places are that are enlarged less than so many times.
#[derive(Clone, Copy)]
struct Circle {
    foot: DVec2,
    radius: f64,
}

impl Circle {
    /// None where there is no such place.
    ///
    /// - `margin`: it is larger by this part of its distance from the eye.
    fn of(view: &AggregateView, enlargement: f64, margin: f64) -> Option<Circle> {
        match *view {
            AggregateView::Eye { at, distance } => {
                let far = distance * enlargement * (1.0 + margin);
                let square = far * far - at.y * at.y;
                (square >= 0.0).then(|| Circle { foot: DVec2::new(at.x, at.z), radius: square.sqrt() })
            }
            AggregateView::Parallel { enlargement: all } => (all.max(1.0) <= enlargement * (1.0 + margin))
                .then_some(Circle { foot: DVec2::ZERO, radius: f64::INFINITY }),
        }
    }

    fn widened(self, by: f64) -> Circle {
        Circle { radius: self.radius + by, ..self }
    }

    /// The lengths of a ray between which it is above or below it.
    fn chord(&self, ray: &Ray) -> Option<[f64; 2]> {
        const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
        // Written so that what is not a number is not within.
        let is_circle = self.radius >= 0.0;
        if !is_circle {
            return None;
        }
        let (origin, direction) =
            (DVec2::new(ray.origin.x, ray.origin.z), DVec2::new(ray.direction.x, ray.direction.z));
        let (from, square) = (origin - self.foot, direction.length_squared());
        if self.radius == f64::INFINITY {
            return Some(ALL);
        }
        let nearest = -from.dot(direction) / square;
        // Along a ray that goes down it is above the same place everywhere.
        if !(square.is_normal() && nearest.is_finite()) {
            return (from.length() <= self.radius).then_some(ALL);
        }
        let beside = (from + direction * nearest).length_squared();
        let half = ((self.radius * self.radius - beside) / square).sqrt();
        (half >= 0.0).then_some([nearest - half, nearest + half])
    }
}

/// Walks the cells of a stretch.
fn walk_stretch(
    cells: &Cells,
    seen: &Aggregates<'_>,
    spheres: &[PrototypeSphere],
    ray: &Ray,
    Stretch { zone, chord }: Stretch,
    visitor: &mut impl CellVisitor,
) -> bool {
    let grid = cells.grid.of_level(zone.level(), zone.greatest());
    let walk = StretchWalk { cells, seen, spheres, ray, zone, grid, line: Line::new(ray, grid.rounding(ray)) };
    for row in grid.rows(ray, chord) {
        if row.enter >= visitor.limits()[1] {
            break;
        }
        if walk.visit_row(&row, visitor) {
            return true;
        }
    }
    false
}

/// A ray as things beside it are compared with it.
#[derive(Clone, Copy)]
struct Line {
    /// Square of the length of its direction.
    square: f64,
    /// Its direction seen from above, and how long that is, rounded up.
    level: DVec2,
    speed: f64,
    /// How far off, at the most, points of it are.
    margin: f64,
}

impl Line {
    fn new(ray: &Ray, margin: f64) -> Line {
        let level = DVec2::new(ray.direction.x, ray.direction.z);
        Line { square: ray.direction.length_squared(), level, speed: level.length() * (1.0 + ROUNDING), margin }
    }

    /// Whether it passes by a circle, seen from above.
    ///
    /// - `from`: a point of it.
    #[inline(always)]
    fn passes_by(&self, from: DVec2, at: DVec2, radius: f64) -> bool {
        self.level.perp_dot(at - from).abs() > (radius + self.margin) * self.speed
    }
}

struct StretchWalk<'s> {
    cells: &'s Cells,
    seen: &'s Aggregates<'s>,
    spheres: &'s [PrototypeSphere],
    ray: &'s Ray,
    zone: AggregateZone,
    /// Of the level of the zone.
    grid: CellGrid,
    line: Line,
}

impl StretchWalk<'_> {
    fn visit_row(&self, row: &CellRow, visitor: &mut impl CellVisitor) -> bool {
        let StretchWalk { cells, zone, line: Line { margin, .. }, .. } = self;
        let (near, far) = (self.ray.at(row.enter), self.ray.at(row.exit));
        let from = DVec2::new(near.x, near.z);
        let (lowest, highest) = (near.y.min(far.y) - margin, near.y.max(far.y) + margin);
        let (level, greatest, [low, high]) = (zone.level(), zone.greatest(), self.grid.heights);
        let count = cells.source.count();
        for cell in row.cells() {
            for number in 0..count {
                let own = CellSlot { cell, number }.instance(level);
                if level > 0 && (!cells.has(own.cell) || self.passes_by_cell(from, own.cell)) {
                    continue;
                }
                // Seen from above and from the side first: that needs no more than the place.
                let CellPlace { at, part } = cells.source.place(own.cell, own.number);
                if self.line.passes_by(from, at, self.grid.overhang * part)
                    || lowest > high * part + margin
                    || highest < low * part - margin
                {
                    continue;
                }
                let enlargement = self.seen.enlargement(at);
                if self.seen.zone(enlargement) != *zone {
                    continue;
                }
                let stays = || CellSlot { cell, number }.above(level + 1, count).is_some();
                let Some(size) = zone.size(enlargement, stays) else { continue };
                let part = part * size / greatest;
                if self.line.passes_by(from, at, self.grid.overhang * part)
                    || lowest > high * part + margin
                    || highest < low * part - margin
                {
                    continue;
                }
                let Some(instance) = cells.source.instance(own.cell, own.number) else { continue };
                let number = number_of(own.cell, own.number);
                if self.visit_instance(row, number, &resized(&instance, at, size), visitor) {
                    return true;
                }
            }
        }
        false
    }

    /// Whether the ray passes by all that is placed in a cell, however enlarged.
    #[inline(always)]
    fn passes_by_cell(&self, from: DVec2, [x, z]: [u32; 2]) -> bool {
        let CellGrid { corner, side, .. } = self.cells.grid;
        let middle = corner + (DVec2::new(f64::from(x), f64::from(z)) + 0.5) * side;
        self.line.passes_by(from, middle, self.grid.overhang + side * std::f64::consts::FRAC_1_SQRT_2)
    }

    /// Gives an instance to the visitor, if the ray meets the sphere about it where hits count.
    #[inline(always)]
    fn visit_instance(&self, row: &CellRow, number: u64, instance: &Instance, visitor: &mut impl CellVisitor) -> bool {
        let (ray, Line { square, margin, .. }, placement) = (self.ray, self.line, instance.placement);
        let Some(sphere) = self.spheres.get(usize::from(instance.prototype)) else { return false };
        let scale = placement.matrix3.x_axis.length_squared();
        let center = placement.transform_point3(sphere.center);
        let radius = f64::from(sphere.radius) * scale.sqrt() * (1.0 + ROUNDING) + margin;
        let to_center = center - ray.at(row.enter);
        let along = to_center.dot(ray.direction) / square;
        let beside = to_center - ray.direction * along;
        let half = radius / square.sqrt();
        let [from, to] = visitor.limits();
        let is_between = row.enter + along - half <= to && row.enter + along + half >= from;
        if !(is_between && beside.length_squared() <= radius * radius) {
            return false;
        }
        // Of a rotation with a scale.
        let inverse = placement.matrix3.transpose() * scale.recip();
        let own = Ray { origin: inverse * (ray.origin - placement.translation), direction: inverse * ray.direction };
        visitor.visit(number, instance, &own)
    }
}
