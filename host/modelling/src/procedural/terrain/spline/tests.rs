//! Facts about the surface of a terrain and the rays that meet it.

use super::super::{FRACTALS, FractalKind, FractalParameters, HeightField, HeightFunction};
use super::ground::{Control, Ground, refined};
use super::patch::Patch;
use super::{GroundView, TerrainSurface};
use crate::numeric::ray::Ray;
use crate::numeric::sampling::RandomStream;
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

const REGION: [DVec2; 2] = [DVec2::new(-6.0, -4.0), DVec2::new(6.0, 4.0)];
const NO_LIMIT: u64 = u64::MAX;
const EYE: DVec3 = DVec3::new(0.3, 2.0, 1.1);

fn field(kind: FractalKind, octaves: f64) -> HeightField {
    let parameters = FractalParameters { octaves, scale: 4.0, height: 1.0, seed: 3.0, ..FractalParameters::default() };
    HeightField::new(&HeightFunction::fractal(kind, parameters), REGION).expect("sound")
}

fn seen(spacing: f64) -> Vec<GroundView> {
    vec![GroundView::Eye { at: EYE, spacing }]
}

fn surface(field: &HeightField, views: Vec<GroundView>) -> TerrainSurface {
    TerrainSurface::new(field.clone(), views, NO_LIMIT).expect("sound")
}

fn place(stream: &mut RandomStream) -> DVec2 {
    let [from, to] = REGION;
    from + (to - from) * DVec2::from(stream.point())
}

/// The surface by its definition, control height by control height.
struct Definition {
    ground: Ground,
    controls: HashMap<(u32, [i64; 2]), Control>,
}

impl Definition {
    fn new(field: &HeightField, views: Vec<GroundView>) -> Definition {
        Definition { ground: Ground::new(field.clone(), views).expect("sound"), controls: HashMap::new() }
    }

    fn control(&mut self, level: u32, cell: [i64; 2]) -> Control {
        if let Some(control) = self.controls.get(&(level, cell)) {
            return *control;
        }
        let control = if level == 0 {
            self.ground.coarsest(cell)
        } else {
            let near = cell.map(|axis| axis.div_euclid(2));
            let coarse: Vec<Control> =
                (0..9).map(|k| self.control(level - 1, [near[0] + k % 3 - 1, near[1] + k / 3 - 1])).collect();
            let of = |x: i64, z: i64| coarse[(3 * (z + 1) + x + 1) as usize];
            let towards = cell.map(|axis| 2 * axis.rem_euclid(2) - 1);
            self.ground.finer(level, cell, refined(of, towards), &mut 0)
        };
        self.controls.insert((level, cell), control);
        control
    }

    /// The cell of the finest lattice that has a place.
    fn cell(&self, at: DVec2) -> [i64; 2] {
        let ground = &self.ground;
        let within = (at - ground.corner_of(0, [0, 0])) / ground.spacing(ground.finest);
        [within.x.floor() as i64, within.y.floor() as i64]
    }

    fn patch(&mut self, [x, z]: [i64; 2]) -> Patch {
        let finest = self.ground.finest;
        Patch::new([-1, 0, 1].map(|dz| [-1, 0, 1].map(|dx| self.control(finest, [x + dx, z + dz]).height)))
    }

    fn height_and_slope(&mut self, at: DVec2) -> (f64, DVec2) {
        let cell = self.cell(at);
        let (corner, spacing) =
            (self.ground.corner_of(self.ground.finest, cell), self.ground.spacing(self.ground.finest));
        let (height, slope) = self.patch(cell).height_and_slope((at - corner) / spacing);
        (height, slope / spacing)
    }

    /// The first change of side of a ray by halving: parts whose bounds exclude one are dropped.
    ///
    /// - Returns a t within `tolerance` of it; none where there is none, or rounding leaves it open.
    fn crossing(&mut self, ray: &Ray, tolerance: f64) -> Option<f64> {
        let mut parts = vec![ray.within(&self.ground.field().bounds(), [0.0, f64::INFINITY])?];
        let mut side = 0;
        while let Some([from, to]) = parts.pop() {
            let [low, high] = self.above(ray, [from, to]);
            let sign = i32::from(low > 0.0) - i32::from(high < 0.0);
            if sign != 0 {
                if side * sign < 0 {
                    return Some(from);
                }
                side = sign;
            } else if to - from > 0.25 * tolerance {
                let middle = 0.5 * (from + to);
                parts.extend([[middle, to], [from, middle]]);
            }
        }
        None
    }

    /// Bounds of the surface over some cells of the finest lattice: over the cells of a coarser one that hold them, by
    /// their control heights and by what the function may add to these.
    fn bounds(&mut self, from: [i64; 2], to: [i64; 2]) -> [f64; 2] {
        let finest = self.ground.finest;
        let (mut level, mut ends) = (finest, [from, to]);
        while level > 0 && (ends[1][0] - ends[0][0] > 1 || ends[1][1] - ends[0][1] > 1) {
            level -= 1;
            ends = ends.map(|end| end.map(|axis| axis.div_euclid(2)));
        }
        let mut all = Vec::new();
        for z in ends[0][1]..=ends[1][1] {
            for x in ends[0][0]..=ends[1][0] {
                all.extend((0..9).map(|k| self.control(level, [x + k % 3 - 1, z + k / 3 - 1]).height));
                if level < finest {
                    let spacing = self.ground.spacing(level);
                    all.extend(self.ground.bounds(self.ground.corner_of(level, [x, z]) + 0.5 * spacing, spacing));
                }
            }
        }
        [least(&all), most(&all)]
    }

    /// Bounds of how far a part of a ray is above the surface.
    fn above(&mut self, ray: &Ray, part: [f64; 2]) -> [f64; 2] {
        let [a, b] = part.map(|t| ray.at(t));
        let (low, high) = (a.min(b), a.max(b));
        let finest = self.ground.finest;
        let [from, to] = [low, high].map(|at| self.cell(DVec2::new(at.x, at.z)));
        let ground = if from == to {
            let (corner, spacing) = (self.ground.corner_of(finest, from), self.ground.spacing(finest));
            let place = |at: DVec3| (DVec2::new(at.x, at.z) - corner) / spacing;
            let [low, high] = self.patch(from).range_over(place(low), place(high));
            let rounding = 1e-14;
            [low - rounding, high + rounding]
        } else {
            self.bounds(from, to)
        };
        [low.y - ground[1], high.y - ground[0]]
    }
}

fn least(all: &[f64]) -> f64 {
    all.iter().copied().fold(f64::INFINITY, f64::min)
}

fn most(all: &[f64]) -> f64 {
    all.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn cells_are_those_of_the_definition() {
    let mut stream = RandomStream::new(1, 0);
    for row in FRACTALS {
        for views in [vec![], seen(0.02), vec![GroundView::Everywhere { spacing: 0.1 }]] {
            let field = field(row.kind, 5.0);
            let (surface, mut definition) = (surface(&field, views.clone()), Definition::new(&field, views));
            for _ in 0..100 {
                let at = place(&mut stream);
                let (height, slope) = surface.height_and_slope(at);
                let (expected, expected_slope) = definition.height_and_slope(at);
                assert!((height - expected).abs() < 1e-12 && (slope - expected_slope).length() < 1e-9, "{at}");
                let bounds = surface.bounds();
                assert!((bounds.min.y..=bounds.max.y).contains(&height));
            }
        }
    }
}

#[test]
fn the_surface_has_no_cracks_and_no_edges_where_cells_of_several_sizes_meet() {
    let surface = surface(&field(FractalKind::Ridged, 9.0), seen(0.02));
    let mut stream = RandomStream::new(2, 0);
    const STEP: f64 = 1e-6;
    for _ in 0..20_000 {
        let at = place(&mut stream);
        let turn = TAU * stream.uniform();
        let to = at + DVec2::new(turn.cos(), turn.sin()) * STEP;
        let ((a, slope_a), (b, slope_b)) = (surface.height_and_slope(at), surface.height_and_slope(to));
        let off = b - a - 0.5 * (slope_a + slope_b).dot(to - at);
        assert!(off.abs() < 1e-10 && slope_a.distance(slope_b) < 1e-2, "{at}: {off} {slope_a} {slope_b}");
    }
}

#[test]
fn all_detail_is_the_height_function_and_less_is_off_by_about_what_is_left_out() {
    let mut stream = RandomStream::new(3, 0);
    for row in FRACTALS {
        let field = field(row.kind, 6.0);
        let [whole, coarse] =
            [vec![], vec![GroundView::Everywhere { spacing: 0.25 }]].map(|views| surface(&field, views));
        let (mut near, mut far) = (0.0_f64, 0.0_f64);
        for _ in 0..2000 {
            let at = place(&mut stream);
            let height = field.height(at, 0.0);
            near = near.max((whole.height_and_slope(at).0 - height).abs());
            far = far.max((coarse.height_and_slope(at).0 - height).abs());
        }
        // The finest octave is 1/32 high; a lattice of its fifth flattens it by about a tenth of that.
        assert!(near < 0.01 && far > 0.02 && far < 0.6, "{}: {near} {far}", row.name);
    }
}

/// Rays from anywhere, and rays that graze the surface.
fn rays(surface: &TerrainSurface, count: usize) -> Vec<Ray> {
    let mut stream = RandomStream::new(4, 0);
    let direction = |stream: &mut RandomStream| {
        let (turn, height) = (TAU * stream.uniform(), stream.uniform() - 0.6);
        DVec3::new(turn.cos(), height, turn.sin())
    };
    let of = |k: usize| {
        let at = place(&mut stream);
        let (height, slope) = surface.height_and_slope(at);
        let along = direction(&mut stream);
        if k.is_multiple_of(2) {
            let origin = DVec3::new(at.x, height + 3.0 * (stream.uniform() - 0.3), at.y);
            return Ray { origin, direction: along };
        }
        // A tangent, shifted by little.
        let rise = slope.dot(DVec2::new(along.x, along.z));
        let direction = DVec3::new(along.x, rise, along.z);
        let off = 10f64.powf(-8.0 * stream.uniform()) * (stream.uniform() - 0.5);
        Ray { origin: DVec3::new(at.x, height + off, at.y) - direction * (2.0 * stream.uniform()), direction }
    };
    (0..count).map(of).collect()
}

/// Compares rays with subdivision; returns how many hit.
fn compare(octaves: f64, views: Vec<GroundView>, count: usize) -> usize {
    let field = field(FractalKind::Fbm, octaves);
    let (surface, mut definition) = (surface(&field, views.clone()), Definition::new(&field, views));
    let (mut hits, mut open) = (0, 0);
    for ray in rays(&surface, count) {
        let found = surface.intersect(&ray, [0.0, f64::INFINITY]);
        let expected = definition.crossing(&ray, 1e-9);
        match (found, expected) {
            (Some(hit), Some(t)) => {
                // Where a ray grazes, halving knows its height above the ground better than the place.
                let at = ray.at(t);
                let above = at.y - surface.height_and_slope(DVec2::new(at.x, at.z)).0;
                assert!((hit.t - t).abs() < 1e-7 || above.abs() < 1e-8, "{ray:?}: {} {t} {above}", hit.t);
                let (height, slope) = surface.height_and_slope(DVec2::new(hit.point.x, hit.point.z));
                assert!((hit.point.y - height).abs() < 1e-12, "{ray:?}");
                assert!(hit.normal.dot(DVec3::new(1.0, slope.x, 0.0)).abs() < 1e-9 * (1.0 + slope.length()));
                hits += 1;
            }
            (None, None) => {}
            // Halving leaves those open that go through the surface by less than it tells apart.
            (found, expected) => {
                let t = found.map_or(expected, |hit| Some(hit.t)).expect("one of them");
                let above = |k: u32| {
                    let at = ray.at(t + 1e-5 * f64::from(k));
                    at.y - surface.height_and_slope(DVec2::new(at.x, at.z)).0
                };
                let all: Vec<f64> = (1..1000).map(above).collect();
                let through = least(&all).abs().min(most(&all).abs());
                assert!(through < 1e-7, "{ray:?}: {found:?} {expected:?}, {through}");
                open += 1;
            }
        }
    }
    assert!(open <= count / 500, "{open}");
    hits
}

#[test]
fn rays_meet_the_surface_where_subdivision_finds_it() {
    // With PERIS_LONG a hundred thousand rays, half of which graze, and twelve octaves: minutes.
    let (octaves, count) = if std::env::var_os("PERIS_LONG").is_some() { (12.0, 50_000) } else { (7.0, 1500) };
    let hits = compare(5.0, Vec::new(), count) + compare(octaves, seen(0.01), count);
    assert!(hits > count, "{hits}");
}

#[test]
fn whatever_is_kept_and_whoever_asks_the_hits_are_the_same_to_the_bit() {
    let field = field(FractalKind::Hybrid, 10.0);
    let (all, few) =
        (surface(&field, seen(0.005)), TerrainSurface::new(field.clone(), seen(0.005), 200_000).expect("sound"));
    let rays = rays(&all, 600);
    let found = |surface: &TerrainSurface, rays: &[Ray]| -> Vec<_> {
        rays.iter().map(|ray| surface.intersect(ray, [0.0, f64::INFINITY])).collect()
    };
    let expected = found(&all, &rays);
    let backwards: Vec<Ray> = rays.iter().rev().copied().collect();
    let fresh = surface(&field, seen(0.005));
    std::thread::scope(|scope| {
        let other = scope.spawn(|| found(&fresh, &backwards));
        assert_eq!(found(&fresh, &rays), expected);
        assert_eq!(other.join().expect("no panic").into_iter().rev().collect::<Vec<_>>(), expected);
    });
    assert_eq!(found(&few, &rays), expected);
    assert!(few.costs().made > all.costs().made && few.costs().bytes < 400_000, "{:?}", few.costs());
}

#[test]
fn rays_along_edges_of_cells_and_straight_down_are_met() {
    let surface = surface(&field(FractalKind::Fbm, 6.0), Vec::new());
    for k in 1..64 {
        // Places on edges of cells of many sizes.
        let at = DVec2::new(-6.0 + 12.0 * f64::from(k) / 64.0, -4.0 + 8.0 * f64::from(k * 7 % 64) / 64.0);
        let height = surface.height_and_slope(at).0;
        let down = Ray { origin: DVec3::new(at.x, 9.0, at.y), direction: DVec3::NEG_Y };
        let hit = surface.intersect(&down, [0.0, f64::INFINITY]).expect("ground");
        assert!((hit.point.y - height).abs() < 1e-12);
        for direction in [DVec3::new(1.0, -0.2, 0.0), DVec3::new(0.0, -0.2, -1.0), DVec3::new(1.0, -0.3, 1.0)] {
            let origin = DVec3::new(at.x, height, at.y) - direction * 0.01;
            let hit = surface.intersect(&Ray { origin, direction }, [0.0, f64::INFINITY]);
            let found = hit.map_or(f64::INFINITY, |hit| hit.t);
            let slope = surface.height_and_slope(at).1.dot(DVec2::new(direction.x, direction.z));
            assert!(slope < direction.y || found <= 0.01 + 1e-9, "{at} {direction}: {found}");
        }
    }
}

#[test]
fn a_ray_leaves_the_surface_on_which_it_begins() {
    let surface = surface(&field(FractalKind::Fbm, 8.0), seen(0.01));
    let mut stream = RandomStream::new(6, 0);
    for _ in 0..2000 {
        let at = place(&mut stream);
        let (height, slope) = surface.height_and_slope(at);
        let normal = DVec3::new(-slope.x, 1.0, -slope.y).normalize();
        let ray = Ray { origin: DVec3::new(at.x, height, at.y), direction: normal };
        assert_eq!(surface.intersect(&ray, [0.0, 1e-3]), None, "{at}");
    }
}

#[test]
fn from_a_pebble_to_the_horizon_what_is_kept_stays_small() {
    // A hundred kilometres of ground, 28 octaves, an eye a millimetre above it.
    let region = [DVec2::splat(-5e4), DVec2::splat(5e4)];
    let parameters =
        FractalParameters { octaves: 28.0, scale: 2e4, height: 4e3, seed: 9.0, ..FractalParameters::default() };
    let field = HeightField::new(&HeightFunction::fractal(FractalKind::Fbm, parameters), region).expect("sound");
    let at = DVec2::new(123.4, -567.8);
    let eye = DVec3::new(at.x, field.height(at, 0.0) + 1e-3, at.y);
    let surface = surface(&field, vec![GroundView::Eye { at: eye, spacing: 0.01 }]);
    let mut nearest = f64::INFINITY;
    for k in 0..100 {
        for l in 0..20 {
            let (turn, height) = (TAU * f64::from(k) / 100.0, 0.4 - f64::from(l) / 10.0);
            let ray = Ray { origin: eye, direction: DVec3::new(turn.cos(), height, turn.sin()) };
            let hit = surface.intersect(&ray, [0.0, f64::INFINITY]);
            nearest = hit.map_or(nearest, |hit| nearest.min(hit.t));
        }
    }
    let costs = surface.costs();
    assert!(nearest > 1e-5 && nearest < 0.02 && costs.bytes < 30_000_000, "{nearest} {costs:?}");
}
