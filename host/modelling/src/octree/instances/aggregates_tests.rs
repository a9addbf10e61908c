//! Rays through instances in cells with aggregates, against asking each instance as large as it is seen.

use super::super::Ray;
use super::aggregates::Aggregates;
use super::cells::{number_of, resized};
use super::octree::KnownInstances;
use super::tests::{Tufts, rays, surface};
use super::*;
use crate::numeric::bounds::Bounds;
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Knows views, and notes how what is made is placed.
struct AggregateViewer {
    views: Vec<AggregateView>,
    made: Option<InstanceOctree>,
    asked: RefCell<Vec<PlacedSurface>>,
}

impl AggregateViewer {
    fn new(views: &[AggregateView]) -> AggregateViewer {
        AggregateViewer { views: views.to_vec(), made: None, asked: RefCell::default() }
    }
}

impl PrototypeMaker for AggregateViewer {
    fn give(&self, _: u32, placed: &PlacedSurface, _: Option<RayInterval<'_>>, to: &mut dyn FnMut(&InstanceOctree)) {
        self.asked.borrow_mut().push(*placed);
        self.made.iter().for_each(to);
    }

    fn aggregate_views(&self, number: u32) -> &[AggregateView] {
        assert_eq!(number, 4);
        &self.views
    }
}

fn eye(x: f64, y: f64, z: f64, distance: f64) -> AggregateView {
    AggregateView::Eye { at: DVec3::new(x, y, z), distance }
}

/// All as they are seen, with their numbers.
fn all_seen(octree: &InstanceOctree, views: &[AggregateView]) -> Vec<(u64, Instance)> {
    let KnownInstances::Cells(cells) = &octree.known else { panic!("in cells") };
    let seen = cells.seen_by(views);
    let ([x, z], count) = (cells.grid.cells, cells.source.count());
    let all = (0..x).flat_map(|x| (0..z).map(move |z| [x, z])).flat_map(|cell| (0..count).map(move |own| (cell, own)));
    let of = |(cell, own)| Some((number_of(cell, own), cells.instance_seen(number_of(cell, own), &seen)?));
    all.filter_map(of).collect()
}

/// Rays from everywhere and along everything, through a box.
fn through(bounds: &Bounds, seed: u64, count: usize) -> impl Iterator<Item = Ray> + use<> {
    let (least, size) = (bounds.min, bounds.size());
    rays(seed, count, 1.0).enumerate().map(move |(number, ray)| {
        let low = [1.0, 0.2, 0.05][number % 3];
        let middle = least + size * DVec3::new(1.0, low, 1.0) * (ray.at(1.0) * 0.5 + 0.5);
        let along = ray.direction;
        let direction = match number % 6 {
            0 => DVec3::new(along.x, 0.0, along.z),
            1 => DVec3::NEG_Y,
            2 => DVec3::X,
            3 => DVec3::new(0.0, along.y * 1e-3, 1.0),
            4 => DVec3::new(along.x, along.y * 0.02, along.z),
            _ => along,
        };
        Ray { origin: middle - direction * [3.0, 100.0, 0.0][number / 6 % 3], direction }
    })
}

/// Compares rays with asking all, placed by a map.
fn check(tufts: &Tufts, views: &[AggregateView], placement: DAffine3, seed: u64) -> usize {
    let cells = tufts.octree().aggregated(4);
    let seen = all_seen(&cells, views);
    let brute = InstanceOctree::new(vec![surface()], PlacementForm::Exact, seen.len(), |n| seen[n].1).expect("sound");
    let held = brute.bounds().union(cells.bounds());
    assert!((held.size() - cells.bounds().size()).abs().max_element() < 1e-9, "the box holds all");
    let there = |_| Instance { prototype: 0, variation: 5, placement };
    let [cells, whole] = [cells, brute].map(|octree| {
        let inner = vec![Prototype::instances(Arc::new(octree))];
        InstanceOctree::new(inner, PlacementForm::Exact, 1, there).expect("one")
    });
    let viewer = AggregateViewer::new(views);
    let walk = cells.made_by(Some(&viewer));
    let mut hits = 0;
    for ray in through(&whole.bounds(), seed, 1_200) {
        let (found, expected) = (walk.closest(&ray, 0.0, f64::INFINITY), whole.closest(&ray, 0.0, f64::INFINITY));
        let told = |hit: Option<InstanceHit>| hit.map(|InstanceHit { hit, .. }| hit.triangle);
        assert_eq!(told(found), told(expected), "{views:?} {ray:?}");
        assert_eq!(walk.occluded(&ray, 0.0, f64::INFINITY), expected.is_some());
        let mut counts = [0, 0];
        let mut counted = |which: usize| {
            counts[which] += 1;
            false
        };
        walk.each_hit(&ray, 0.0, f64::INFINITY, |_| counted(0));
        whole.each_hit(&ray, 0.0, f64::INFINITY, |_| counted(1));
        assert_eq!(counts[0], counts[1], "{views:?} {ray:?}");
        let (Some(found), Some(expected)) = (found, expected) else { continue };
        hits += 1;
        assert!((found.hit.t - expected.hit.t).abs() < 1e-9 * (1.0 + expected.hit.t));
        let (one, other) = (walk.placed(&found.path), whole.placed(&expected.path));
        assert_eq!(one.variation, other.variation);
        assert!(one.placement.abs_diff_eq(other.placement, 1e-9));
        assert!(!walk.occluded(&ray, 0.0, found.hit.t));
    }
    hits
}

#[test]
fn aggregates_are_hit_as_if_each_instance_were_asked_as_it_is_seen() {
    let tufts = Tufts::new([38, 33], 0.5, 2);
    let turn = DQuat::from_rotation_x(0.3) * DQuat::from_rotation_y(1.0);
    let placed = DAffine3::from_scale_rotation_translation(DVec3::splat(3.0), turn, DVec3::new(7.0, -2.0, 1.0));
    let mirrored = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(-2.0, 2.0, 2.0)), ..DAffine3::IDENTITY };
    for (number, (views, placement)) in [
        (vec![eye(-2.0, 0.3, 6.0, 1.0)], DAffine3::IDENTITY),
        (vec![eye(5.0, 2.0, 12.0, 0.5)], placed),
        (vec![eye(5.0, -3.0, 12.0, 1.2)], mirrored),
        (vec![eye(4.0, 30.0, 9.0, 7.0)], DAffine3::IDENTITY),
        (vec![eye(-900.0, 200.0, 40.0, 100.0)], placed),
        (vec![eye(2.0, 0.0, 9.0, 1e-3)], DAffine3::IDENTITY),
        (vec![eye(2.0, 0.0, 9.0, 1e9)], DAffine3::IDENTITY),
        (vec![eye(2.0, 1.0, 9.0, 1.0), eye(12.0, 0.5, 20.0, 0.7)], DAffine3::IDENTITY),
        (vec![AggregateView::Parallel { enlargement: 3.0 }], placed),
        (vec![AggregateView::Parallel { enlargement: 0.2 }, eye(2.0, 1.0, 9.0, 1.0)], DAffine3::IDENTITY),
        (vec![], mirrored),
    ]
    .into_iter()
    .enumerate()
    {
        let hits = check(&tufts, &views, placement, 300 + number as u64);
        assert!(hits > 100, "{hits} of {views:?}");
    }
    // A narrow grid, and one of a single cell.
    for (cells, side, count) in [([70, 1], 0.3, 1), ([1, 1], 4.0, 30)] {
        let hits = check(&Tufts::new(cells, side, count), &[eye(0.0, 0.2, 5.0, 0.6)], placed, 400);
        assert!(hits > 60, "{hits}");
    }
}

#[test]
fn nearer_than_the_distance_nothing_changes_and_the_area_stays_in_every_zone() {
    let tufts = Tufts::new([120, 110], 0.5, 3);
    let octree = tufts.octree().aggregated(4);
    let views = [eye(10.0, 1.0, 30.0, 2.0)];
    let KnownInstances::Cells(cells) = &octree.known else { panic!("in cells") };
    let seen: Aggregates<'_> = cells.seen_by(&views);
    let mut areas: HashMap<u32, [f64; 3]> = HashMap::new();
    for cell in (0..120).flat_map(|x| (0..110).map(move |z| [x, z])) {
        for own in 0..3 {
            let at = tufts.place(cell, own).at;
            let far = DVec3::new(at.x, 0.0, at.y).distance(DVec3::new(10.0, 1.0, 30.0));
            let size = seen.size(at, cell, own, 3);
            assert!(far > 2.0 || size == Some(1.0));
            assert!(
                size.is_none_or(|size| size <= (far / 2.0).max(1.0) + 1e-12),
                "it spans no more than at the distance"
            );
            let zone = if far <= 2.0 { 0 } else { 1 + (far / 2.0).log2() as u32 };
            let area = areas.entry(zone).or_default();
            area[0] += 1.0;
            area[1] += size.map_or(0.0, |size| size * size);
            area[2] += f64::from(u8::from(size.is_some()));
        }
    }
    for zone in 0..5 {
        let [count, area, met] = areas[&zone];
        assert!(count > 30.0 && (area / count - 1.0).abs() < 0.05, "{zone}: {area} of {count}");
        let most = 4_f64.powi(1 - zone.max(1) as i32);
        assert!(met <= count * most * 1.1 + 20.0, "{zone}: {met} of {count}");
    }
}

#[test]
fn what_is_made_in_an_aggregate_is_told_how_large_it_is() {
    let tufts = Tufts::new([30, 30], 0.5, 2);
    let views = [eye(-3.0, 0.2, 5.0, 0.8)];
    let (plain, made) = (tufts.octree(), Prototype::made(0, surface().bounds()));
    let cells = InstanceOctree::in_cells(vec![made], tufts.grid, Arc::new(tufts.clone())).expect("sound").aggregated(4);
    let seen = all_seen(&cells, &views);
    let still = |_| Instance { prototype: 0, variation: 0, placement: DAffine3::IDENTITY };
    let inner = InstanceOctree::new(vec![surface()], PlacementForm::Exact, 1, still).expect("one");
    let viewer = AggregateViewer { made: Some(inner), ..AggregateViewer::new(&views) };
    for ray in through(&plain.bounds(), 77, 300) {
        let found = cells.made_by(Some(&viewer)).closest(&ray, 0.0, f64::INFINITY);
        assert!(found.is_none_or(|found| found.path.numbers().len() == 2));
    }
    let asked = viewer.asked.into_inner();
    assert!(asked.len() > 300);
    for placed in &asked {
        let is_there = |(_, instance): &(u64, Instance)| instance.placement.abs_diff_eq(placed.placement, 1e-12);
        assert!(seen.iter().any(is_there), "{placed:?}");
    }
    assert!(asked.iter().any(|placed| placed.placement.matrix3.y_axis.length() > 3.0));
}

#[test]
fn what_is_resized_stays_over_its_place() {
    let (at, lean) = (DVec2::new(3.0, -4.0), DQuat::from_rotation_z(0.4));
    let placement = DAffine3 { matrix3: DMat3::from_quat(lean), translation: DVec3::new(3.0, 0.5, -4.0) };
    let twice = resized(&Instance { prototype: 1, variation: 2, placement }, at, 2.0);
    let expected = DAffine3 { matrix3: placement.matrix3 * 2.0, translation: DVec3::new(3.0, 1.0, -4.0) };
    assert_eq!(twice, Instance { prototype: 1, variation: 2, placement: expected });
}

/// Tufts that are counted when a ray asks for their places; nothing stands there.
#[derive(Debug)]
struct Counted {
    grid: CellGrid,
    places: AtomicU64,
}

impl CellInstances for Counted {
    fn count(&self) -> u32 {
        4
    }

    fn place(&self, [x, z]: [u32; 2], number: u32) -> CellPlace {
        self.places.fetch_add(1, Ordering::Relaxed);
        let within = DVec2::new(f64::from(number) * 0.25, 0.5);
        CellPlace { at: self.grid.corner + DVec2::new(f64::from(x), f64::from(z)) + within, part: 1.0 }
    }

    fn instance(&self, _: [u32; 2], _: u32) -> Option<Instance> {
        None
    }

    fn shares(&self) -> &[f64] {
        &[1.0]
    }

    fn add_to_checksum(&self, _: &mut crc32fast::Hasher) {}
}

#[test]
fn a_ray_to_the_horizon_asks_a_bounded_number_of_cells_each_time_that_the_distance_doubles() {
    let grid = CellGrid {
        cells: [1 << 20; 2],
        corner: DVec2::splat(-0.5 * f64::from(1 << 20)),
        side: 1.0,
        overhang: 0.5,
        heights: [0.0, 1.0],
    };
    let source = Arc::new(Counted { grid, places: AtomicU64::new(0) });
    let octree = InstanceOctree::in_cells(vec![surface()], grid, source.clone()).expect("sound").aggregated(4);
    let at = DVec3::new(0.3, 0.9, 0.6);
    let asked = |views: &[AggregateView], far: f64, direction: DVec3| {
        source.places.store(0, Ordering::Relaxed);
        let viewer = AggregateViewer::new(views);
        let ray = Ray { origin: at, direction: direction.normalize() };
        assert!(!octree.made_by(Some(&viewer)).occluded(&ray, 0.0, far));
        source.places.load(Ordering::Relaxed)
    };
    for direction in [DVec3::X, DVec3::new(0.6, 0.0, -0.8), DVec3::new(1.0, 0.0, 1.0)] {
        let views = [AggregateView::Eye { at, distance: 10.0 }];
        let [near, whole, exact] =
            [asked(&views, 10.0, direction), asked(&views, 160.0, direction), asked(&[], 16_000.0, direction)];
        assert!(near > 20 && whole < 8 * near, "{near} up to the distance, {whole} up to 16 times it");
        let far = asked(&views, 16_000.0, direction);
        assert!(far * 12 < exact && exact > 100_000, "{far} in place of {exact}");
    }
}
