//! Tests of instances against asking each of them, and against one mesh of all.

use super::super::lanes::LANES;
use super::super::{Octree, OctreeSettings, Ray, Walk};
use super::descent::Descent;
use super::octree::{Content, KnownInstances};
use super::stored::StoredInstances;
use super::*;
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::{RandomStream, sphere};
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use rayon::prelude::*;
use std::sync::Arc;

/// A tetrahedron about the origin, as large as 1.
fn tetrahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let vertices = vec![
        DVec3::new(0.5, 0.5, 0.5),
        DVec3::new(0.5, -0.5, -0.5),
        DVec3::new(-0.5, 0.5, -0.5),
        DVec3::new(-0.5, -0.5, 0.5),
    ];
    (vertices, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

fn octree(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Arc<Octree> {
    let settings = OctreeSettings { walk: Walk::Index, ..OctreeSettings::default() };
    Arc::new(Octree::build(vertices, triangles, &settings).expect("a sound mesh"))
}

pub(super) fn surface() -> Prototype {
    let (vertices, triangles) = tetrahedron();
    Prototype::surface(octree(&vertices, &triangles), 0)
}

/// A placement by chance: about the origin within `reach`, with scales about `size`, half of them mirrored.
fn scattered(seed: u64, number: usize, reach: f64, size: f64) -> Instance {
    let mut random = RandomStream::new(seed, number as u64);
    let rotation = DQuat::from_axis_angle(sphere(random.point()), random.uniform() * 6.0);
    let scale = size * (0.5 + random.uniform()) * if random.uniform() < 0.5 { 1.0 } else { -1.0 };
    let translation = (DVec3::new(random.uniform(), random.uniform(), random.uniform()) * 2.0 - 1.0) * reach;
    let placement = DAffine3 { matrix3: DMat3::from_quat(rotation) * scale, translation };
    Instance { prototype: 0, variation: number as u16, placement }
}

fn of(prototypes: Vec<Prototype>, form: PlacementForm, count: usize, seed: u64) -> InstanceOctree {
    // As many as fill the same part of the space.
    let size = (count.max(1) as f64).cbrt().recip();
    InstanceOctree::new(prototypes, form, count, |number| scattered(seed, number, 1.0, size)).expect("sound placements")
}

pub(super) fn rays(seed: u64, count: usize, reach: f64) -> impl Iterator<Item = Ray> {
    let mut random = RandomStream::new(seed, 1 << 40);
    (0..count).map(move |_| {
        let (origin, towards) =
            (sphere(random.point()) * (3.0 * reach), sphere(random.point()) * reach * random.uniform());
        Ray { origin, direction: towards - origin }
    })
}

fn stored(octree: &InstanceOctree) -> &StoredInstances {
    let KnownInstances::Stored(stored) = &octree.known else { panic!("all are stored") };
    stored
}

/// The nearest hit by asking every instance, and how many there are.
fn asked(octree: &InstanceOctree, ray: &Ray, outer: Option<&Descent<'_>>) -> (Option<InstanceHit>, usize) {
    let (mut best, mut count): (Option<InstanceHit>, usize) = (None, 0);
    let StoredInstances { placements, positions, .. } = stored(octree);
    for (number, Instance { prototype, placement, .. }) in octree.stored_instances() {
        let (block, lane) = (number as usize / LANES, number as usize % LANES);
        let center = octree.extents.spheres[usize::from(prototype)].center;
        let inner = placements.own_ray(positions, block, lane, center, ray);
        let far = placement.transform_point3(inner.at(0.7)).distance(ray.at(0.7));
        assert!(far < 1e-9 * (ray.at(0.7).length() + placement.translation.length()), "{far}");
        let descent = Descent { octree, number, met: None, outer };
        let path = descent.path();
        let (found, hits) = match &octree.prototypes[usize::from(prototype)].content {
            Content::Surface { octree: surface, .. } => {
                let mut hits = 0;
                surface.each_hit(&inner, 0.0, f64::INFINITY, |_| {
                    hits += 1;
                    false
                });
                (surface.closest(&inner, 0.0, f64::INFINITY).map(|hit| InstanceHit { hit, path }), hits)
            }
            Content::Instances(below) => asked(below, &inner, Some(&descent)),
            Content::Made { .. } => unreachable!("all are stored"),
        };
        count += hits;
        best = match (best, found) {
            (Some(best), Some(found)) if found.hit.t >= best.hit.t => Some(best),
            (best, found) => found.or(best),
        };
    }
    (best, count)
}

fn check(octree: &InstanceOctree, seed: u64, count: usize, reach: f64) -> usize {
    let mut hits = 0;
    for ray in rays(seed, count, reach) {
        let (expected, count) = asked(octree, &ray, None);
        let found = octree.closest(&ray, 0.0, f64::INFINITY);
        assert_eq!(found.map(|found| found.hit), expected.map(|expected| expected.hit), "{ray:?}");
        assert_eq!(found.map(|found| found.path), expected.map(|expected| expected.path), "{ray:?}");
        assert_eq!(octree.occluded(&ray, 0.0, f64::INFINITY), expected.is_some());
        let mut given = 0;
        octree.each_hit(&ray, 0.0, f64::INFINITY, |_| {
            given += 1;
            false
        });
        assert_eq!(given, count, "{ray:?}");
        if let Some(found) = found {
            hits += 1;
            // What is nearer is free, up to the hit itself.
            assert!(!octree.occluded(&ray, 0.0, found.hit.t));
            assert_eq!(octree.closest(&ray, found.hit.t, f64::INFINITY).is_some(), count > 1);
        }
    }
    hits
}

#[test]
fn rays_hit_what_they_hit_when_every_instance_is_asked() {
    for (count, seed) in [(0, 1), (1, 2), (7, 3), (8, 4), (9, 5), (300, 6), (5000, 7)] {
        for form in [PlacementForm::Similar, PlacementForm::Affine, PlacementForm::Exact] {
            let hits = check(&of(vec![surface()], form, count, seed), seed, 300.min(60 + count), 1.2);
            assert!(hits > 0 || count < 7, "{count}");
        }
    }
}

#[test]
fn instances_are_where_one_mesh_of_all_is() {
    for form in [PlacementForm::Similar, PlacementForm::Affine, PlacementForm::Exact] {
        are_where_one_mesh_is(&of(vec![surface()], form, 400, 11));
    }
}

fn are_where_one_mesh_is(placed: &InstanceOctree) {
    let (vertices, triangles) = tetrahedron();
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    let mut firsts = std::collections::HashMap::new();
    for (number, Instance { placement, .. }) in placed.stored_instances() {
        let first = points.len() as u32;
        firsts.insert(number, corners.len() as u32);
        points.extend(vertices.iter().map(|vertex| placement.transform_point3(*vertex)));
        corners.extend(triangles.iter().map(|triangle| triangle.map(|vertex| vertex + first)));
    }
    let flat = octree(&points, &corners);
    let mut hits = 0;
    for ray in rays(12, 2000, 1.2) {
        let (found, expected) = (placed.closest(&ray, 0.0, f64::INFINITY), flat.closest(&ray, 0.0, f64::INFINITY));
        assert_eq!(found.is_some(), expected.is_some());
        if let (Some(found), Some(expected)) = (found, expected) {
            hits += 1;
            assert!((found.hit.t - expected.t).abs() < 1e-12);
            assert_eq!(firsts[&found.path.numbers()[0]] + found.hit.triangle, expected.triangle);
            let placement = placed.placed(&found.path).placement;
            let [a, b, c] = triangles[found.hit.triangle as usize].map(|vertex| vertices[vertex as usize]);
            let own = a * (1.0 - found.hit.u - found.hit.v) + b * found.hit.u + c * found.hit.v;
            assert!(placement.transform_point3(own).distance(ray.at(found.hit.t)) < 1e-12);
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn instances_of_instances_are_hit_at_every_level_in_any_size() {
    for size in [1.0_f64, 1e-6, 1e6] {
        let mut inner = surface();
        for level in 0..5 {
            // Sizes are taken back from level to level, so that the whole stays of this world.
            let (scale, mirror) =
                (if level % 2 == 0 { size } else { size.recip() }, if level == 1 { -1.0 } else { 1.0 });
            let extent = inner.bounds().size().max_element();
            let instance = |number: usize| {
                let Instance { variation, placement, .. } =
                    scattered(level, number, 0.4 * scale * extent, 0.8 * mirror * scale);
                Instance { prototype: 0, variation, placement }
            };
            let form = if level % 2 == 0 { PlacementForm::Similar } else { PlacementForm::Affine };
            inner = Prototype::instances(Arc::new(InstanceOctree::new(vec![inner], form, 5, instance).expect("sound")));
        }
        let Content::Instances(octree) = &inner.content else { unreachable!("made of instances") };
        let reach = inner.bounds().size().max_element();
        let hits = check(octree, 21, 40, reach / 2.0);
        assert!(hits > 5, "{hits} at {size}");
        let first = rays(21, 40, reach / 2.0).find_map(|ray| octree.closest(&ray, 0.0, f64::INFINITY));
        assert_eq!(first.map(|first| first.path.numbers().len()), Some(5));
    }
}

#[test]
fn a_hit_tells_which_surface_it_is_on_and_how_that_is_placed() {
    let (vertices, triangles) = tetrahedron();
    let surface = |first: u32| Prototype::surface(octree(&vertices, &triangles), first);
    let at = |prototype: u16, variation: u16, x: f64| Instance {
        prototype,
        variation,
        placement: DAffine3::from_translation(DVec3::X * x),
    };
    let row = |number: usize| [at(0, 7, 0.0), at(1, 9, 2.0)][number];
    let pair = InstanceOctree::new(vec![surface(0), surface(4)], PlacementForm::Exact, 2, row).expect("sound");
    let far = |number: usize| [at(0, 100, 50.0), at(0, 65_530, -50.0)][number];
    let pairs = vec![Prototype::instances(Arc::new(pair))];
    let octree = InstanceOctree::new(pairs, PlacementForm::Exact, 2, far).expect("sound");
    for (x, first, variation) in [(50.0, 0, 107), (52.0, 4, 109), (-50.0, 0, 1), (-48.0, 4, 3)] {
        let ray = Ray { origin: DVec3::new(x + 0.1, 0.1, 5.0), direction: DVec3::NEG_Z };
        let found = octree.closest(&ray, 0.0, f64::INFINITY).expect("a hit");
        assert_eq!(found.hit.triangle / 4 * 4, first);
        let placed = octree.placed(&found.path);
        assert_eq!((placed.placement, placed.variation), (at(0, 0, x).placement, variation));
        let way = 50.0 + if first == 0 { 0.0 } else { 2.0 };
        assert!((way..2.0 * way).contains(&placed.largest), "{}", placed.largest);
        let mut given = Vec::new();
        octree.each_hit(&ray, 0.0, f64::INFINITY, |hit| {
            given.push(hit.hit.triangle);
            false
        });
        assert!(given.len() == 2 && given.contains(&found.hit.triangle) && given.iter().all(|t| t / 4 * 4 == first));
    }
}

#[test]
fn rays_that_begin_far_away_hit_what_they_hit_when_every_instance_is_asked() {
    for form in [PlacementForm::Similar, PlacementForm::Affine, PlacementForm::Exact] {
        let octree = of(vec![surface()], form, 200, 13);
        let (mut hits, vertices) = (0, tetrahedron().0);
        for (number, ray) in rays(14, 1500, 1.0).enumerate() {
            // Just within the corners, along the spheres about instances, which go through these.
            let (_, placed) = octree.stored_instances().nth(number % 200).expect("an instance");
            let corner = placed.placement.transform_point3(vertices[number % 4] * (1.0 - 1e-7));
            let out = corner - placed.placement.translation;
            let direction = ray.direction - out * (ray.direction.dot(out) / out.length_squared());
            let far = 10_f64.powi(number as i32 % 14);
            let ray = Ray { origin: corner - direction * far, direction };
            let expected = asked(&octree, &ray, None).0;
            assert_eq!(octree.closest(&ray, 0.0, f64::INFINITY), expected, "{far} {ray:?}");
            hits += usize::from(expected.is_some());
        }
        assert!(hits > 100, "{form:?}: {hits}");
    }
}

#[test]
fn ten_thousand_instances_at_one_place_are_one_hit_after_another() {
    let there = |number: usize| Instance { variation: number as u16, ..scattered(1, 0, 1.0, 0.5) };
    let octree = InstanceOctree::new(vec![surface()], PlacementForm::Similar, 10_000, there).expect("sound placements");
    let at = octree.bounds().center();
    let ray = Ray { origin: at + DVec3::new(0.01, 5.0, 0.02), direction: DVec3::NEG_Y };
    let mut hits = 0;
    octree.each_hit(&ray, 0.0, f64::INFINITY, |_| {
        hits += 1;
        false
    });
    assert!(hits >= 20_000 && hits % 10_000 == 0, "{hits}");
    assert_eq!(octree.closest(&ray, 0.0, f64::INFINITY), octree.closest(&ray, 0.0, f64::INFINITY));
}

#[test]
fn an_instance_costs_less_than_32_bytes_and_with_an_affine_map_less_than_64() {
    for (form, most) in [(PlacementForm::Similar, 32), (PlacementForm::Affine, 64)] {
        for count in [1_000, 30_000, 100_000] {
            let InstanceCosts { instances, bytes, triangles, .. } = of(vec![surface()], form, count, 31).costs();
            assert!(instances == count && triangles == 4 * count as u64);
            assert!(bytes <= most * count, "{count}: {}", bytes as f64 / count as f64);
        }
    }
}

#[test]
fn placements_take_as_many_bytes_as_their_form_tells() {
    for form in [PlacementForm::Similar, PlacementForm::Affine, PlacementForm::Exact] {
        let octree = of(vec![surface()], form, 8, 3);
        assert_eq!(octree.costs().bytes - size_of_val(stored(&octree).nodes.as_slice()), 8 * form.bytes());
    }
}

#[test]
fn the_same_octree_comes_from_any_number_of_threads() {
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        format!("{:?}", pool.install(|| of(vec![surface()], PlacementForm::Similar, 5_000, 41)))
    };
    assert!(made(1) == made(3));
}

#[test]
fn empty_prototypes_place_nothing() {
    let octree = of(vec![Prototype::surface(octree(&[], &[]), 0)], PlacementForm::Similar, 50, 51);
    assert!(octree.count() == 0 && octree.bounds().is_empty());
    assert_eq!(octree.closest(&Ray { origin: DVec3::ZERO, direction: DVec3::X }, 0.0, f64::INFINITY), None);
}

#[test]
fn what_cannot_be_placed_is_told_by_its_number() {
    let sound = |number: usize| scattered(61, number, 1.0, 0.1);
    let refused = |form: PlacementForm, change: &(dyn Fn(&mut Instance) + Sync)| {
        let instance = |number: usize| {
            let mut instance = sound(number);
            if number >= 700 {
                change(&mut instance);
            }
            instance
        };
        InstanceOctree::new(vec![surface()], form, 1000, instance).expect_err("a problem")
    };
    use PlacementForm::{Affine, Similar};
    let flat = |instance: &mut Instance| instance.placement.matrix3.z_axis = instance.placement.matrix3.x_axis;
    let infinite = |instance: &mut Instance| instance.placement.translation.y = f64::INFINITY;
    let stretched = |instance: &mut Instance| instance.placement.matrix3.z_axis *= 2.0;
    let huge = |instance: &mut Instance| instance.placement.matrix3 *= 1e60;
    let instance = 700;
    assert_eq!(refused(Affine, &flat), InstanceError::Flat { instance });
    assert_eq!(refused(Affine, &infinite), InstanceError::NotFinite { instance });
    assert_eq!(refused(Affine, &huge), InstanceError::NotFinite { instance });
    assert_eq!(refused(Affine, &|of| of.placement.matrix3 *= 0.0), InstanceError::Flat { instance });
    assert_eq!(refused(Similar, &stretched), InstanceError::NotSimilar { instance });
    assert_eq!(refused(Similar, &huge), InstanceError::NotSimilar { instance });
    let unknown = InstanceError::UnknownPrototype { instance, prototype: 1, prototypes: 1 };
    assert_eq!(refused(Similar, &|of| of.prototype = 1), unknown);
    let mut deep = surface();
    let mut refusal = None;
    while refusal.is_none() {
        match InstanceOctree::new(vec![deep.clone()], Similar, 1, sound) {
            Ok(octree) => deep = Prototype::instances(Arc::new(octree)),
            Err(error) => refusal = Some(error),
        }
    }
    assert_eq!(refusal, Some(InstanceError::TooManyLevels { levels: MOST_LEVELS + 1 }));
}

/// Instances by chance in parts along x, boxes of which are larger than they need be.
#[derive(Debug)]
struct Rows {
    parts: usize,
    count: usize,
}

impl InstanceParts for Rows {
    fn parts(&self) -> usize {
        self.parts
    }

    fn count(&self, part: usize) -> usize {
        if part == 3 { 0 } else { self.count }
    }

    fn bounds(&self, part: usize) -> Bounds {
        let at = DVec3::X * (part as f64 * 2.0);
        Bounds { min: at - 1.3, max: at + 1.3 }
    }

    fn instance(&self, part: usize, number: usize) -> Instance {
        let mut instance = scattered(71 + part as u64, number, 1.0, 0.1);
        instance.placement.translation.x += part as f64 * 2.0;
        instance
    }

    fn shares(&self) -> &[f64] {
        &[1.0]
    }

    fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        sum.update(format!("{self:?}").as_bytes());
    }
}

#[test]
fn instances_in_parts_are_hit_as_if_all_were_stored_and_only_the_parts_that_rays_come_to_are() {
    let rows = Rows { parts: 40, count: 30 };
    let numbers: Vec<[usize; 2]> =
        (0..40).filter(|part| *part != 3).flat_map(|part| (0..30).map(move |own| [part, own])).collect();
    let instance = |number: usize| rows.instance(numbers[number][0], numbers[number][1]);
    let whole = InstanceOctree::new(vec![surface()], PlacementForm::Affine, numbers.len(), instance).expect("sound");
    let made = || {
        let parts = Arc::new(Rows { parts: 40, count: 30 });
        InstanceOctree::on_demand(vec![surface()], PlacementForm::Affine, parts).expect("sound parts")
    };
    let parts = made();
    assert_eq!((parts.count(), parts.costs().triangles), (whole.count(), whole.costs().triangles));
    let untouched = parts.costs().bytes;
    let down = Ray { origin: DVec3::new(20.0, 5.0, 0.0), direction: DVec3::NEG_Y };
    let hit = parts.closest(&down, 0.0, f64::INFINITY);
    let one_part = parts.costs().bytes;
    assert!(one_part > untouched && one_part < untouched + 2 * 32 * 72, "{one_part} {untouched}");
    let mut hits = 0;
    for ray in rays(72, 3000, 1.0) {
        let ray = Ray { origin: ray.origin * DVec3::new(20.0, 1.0, 1.0) + DVec3::X * 40.0, direction: ray.direction };
        let (found, expected) = (parts.closest(&ray, 0.0, f64::INFINITY), whole.closest(&ray, 0.0, f64::INFINITY));
        assert_eq!(found.map(|found| found.hit.triangle), expected.map(|expected| expected.hit.triangle), "{ray:?}");
        assert_eq!(parts.occluded(&ray, 0.0, f64::INFINITY), expected.is_some());
        let (Some(found), Some(expected)) = (found, expected) else { continue };
        hits += 1;
        // Positions are rounded in cubes of different sizes.
        assert!((found.hit.t - expected.hit.t).abs() < 1e-6);
        let (one, other) = (parts.placed(&found.path), whole.placed(&expected.path));
        assert_eq!(one.variation, other.variation);
        assert!(one.placement.abs_diff_eq(other.placement, 1e-6));
    }
    assert!(hits > 100, "{hits}");
    // Another order of the rays changes nothing, whatever their threads.
    let again = made();
    let all: Vec<Ray> = rays(72, 600, 40.0).chain([down]).collect();
    let ask = |ray: &Ray| again.closest(ray, 0.0, f64::INFINITY);
    let together: Vec<Option<InstanceHit>> = all.par_iter().rev().map(ask).collect();
    assert!(all.iter().zip(together.iter().rev()).all(|(ray, hit)| parts.closest(ray, 0.0, f64::INFINITY) == *hit));
    assert_eq!(together[0], hit);
}

/// Instances by chance in cells.
#[derive(Clone, Debug)]
pub(super) struct Tufts {
    pub(super) grid: CellGrid,
    count: u32,
}

impl CellInstances for Tufts {
    fn count(&self) -> u32 {
        self.count
    }

    fn place(&self, [x, z]: [u32; 2], number: u32) -> CellPlace {
        let mut random = RandomStream::new(u64::from(x) << 32 | u64::from(z), u64::from(number));
        let at = DVec2::from(random.point()) + DVec2::new(f64::from(x), f64::from(z));
        CellPlace { at: self.grid.corner + at * self.grid.side, part: [1.0, 0.4][number as usize % 2] }
    }

    fn instance(&self, cell: [u32; 2], number: u32) -> Option<Instance> {
        let seed = u64::from(cell[0]) * 7919 + u64::from(cell[1]);
        let mut instance = scattered(seed, number as usize, 0.0, 0.6);
        let CellPlace { at, part } = self.place(cell, number);
        instance.placement.matrix3 *= part;
        instance.placement.translation = DVec3::new(at.x, 0.1 * part, at.y);
        (RandomStream::new(seed, u64::from(number)).uniform() < 0.7).then_some(instance)
    }

    fn shares(&self) -> &[f64] {
        &[1.0]
    }

    fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        sum.update(format!("{self:?}").as_bytes());
    }
}

impl Tufts {
    pub(super) fn new(cells: [u32; 2], side: f64, count: u32) -> Tufts {
        let corner = DVec2::new(-3.0, 5.0);
        Tufts { grid: CellGrid { cells, corner, side, overhang: 0.8, heights: [-0.7, 0.9] }, count }
    }

    pub(super) fn octree(&self) -> InstanceOctree {
        InstanceOctree::in_cells(vec![surface()], self.grid, Arc::new(self.clone())).expect("sound cells")
    }

    fn stored(&self) -> InstanceOctree {
        let CellGrid { cells: [x, z], .. } = self.grid;
        let all = (0..x)
            .flat_map(|x| (0..z).map(move |z| [x, z]))
            .flat_map(|cell| (0..self.count).map(move |own| (cell, own)));
        let all: Vec<Instance> = all.filter_map(|(cell, own)| self.instance(cell, own)).collect();
        InstanceOctree::new(vec![surface()], PlacementForm::Exact, all.len(), |number| all[number]).expect("sound")
    }
}

#[test]
fn instances_in_cells_are_hit_as_if_all_were_stored() {
    for (cells, side, count) in [([7, 5], 1.0, 3), ([1, 1], 4.0, 30), ([40, 3], 0.25, 1), ([3, 40], 0.11, 1)] {
        let tufts = Tufts::new(cells, side, count);
        let (cells, whole) = (tufts.octree(), tufts.stored());
        assert_eq!(cells.costs().bytes, 0);
        let bounds = whole.bounds();
        assert_eq!(bounds.union(cells.bounds()), cells.bounds());
        let mut hits = 0;
        let level = |number: usize, along: DVec3| match number % 5 {
            0 => DVec3::new(along.x, 0.0, along.z),
            1 => DVec3::NEG_Y,
            2 => DVec3::X,
            3 => DVec3::new(0.0, along.y * 1e-3, 1.0),
            _ => along,
        };
        for (number, ray) in rays(81, 2000, 1.0).enumerate() {
            let middle = bounds.min + bounds.size() * (ray.at(1.0) * 0.5 + 0.5);
            let direction = level(number, ray.direction);
            let far = [3.0, 100.0, 0.0][number % 3];
            let ray = Ray { origin: middle - direction * far, direction };
            let (found, expected) = (cells.closest(&ray, 0.0, f64::INFINITY), whole.closest(&ray, 0.0, f64::INFINITY));
            let told = |hit: Option<InstanceHit>| hit.map(|InstanceHit { hit, .. }| hit.triangle);
            assert_eq!(told(found), told(expected), "{ray:?}");
            assert_eq!(cells.occluded(&ray, 0.0, f64::INFINITY), expected.is_some());
            let count = |octree: &InstanceOctree| {
                let mut count = 0;
                octree.each_hit(&ray, 0.0, f64::INFINITY, |_| {
                    count += 1;
                    false
                });
                count
            };
            assert_eq!(count(&cells), count(&whole), "{ray:?}");
            let (Some(found), Some(expected)) = (found, expected) else { continue };
            hits += 1;
            assert!((found.hit.t - expected.hit.t).abs() < 1e-12 * (1.0 + far));
            let (one, other) = (cells.placed(&found.path), whole.placed(&expected.path));
            assert_eq!(one.variation, other.variation);
            assert!(one.placement.abs_diff_eq(other.placement, 1e-12));
        }
        assert!(hits > 200, "{hits}");
    }
}

#[test]
fn a_grid_of_a_million_million_cells_is_asked_along_rays_only() {
    let most = MOST_CELLS;
    let grid =
        CellGrid { cells: [most, most], corner: DVec2::splat(-1e6), side: 1.0, overhang: 0.8, heights: [-0.7, 0.9] };
    let tufts = Tufts { grid, count: 4 };
    let octree = tufts.octree();
    let counted = u64::from(most) * u64::from(most) * 4;
    assert_eq!((octree.count() as u64, octree.costs().stored), (counted, 0));
    let mut hits = 0;
    for ray in rays(91, 500, 1.0) {
        let ray = Ray { origin: ray.origin * DVec3::new(1e5, 0.0, 1e5) + DVec3::Y * 30.0, direction: ray.direction };
        let Some(hit) = octree.closest(&ray, 0.0, f64::INFINITY) else { continue };
        hits += 1;
        let placed = octree.placed(&hit.path).placement;
        assert!(placed.translation.distance(ray.at(hit.hit.t)) < 0.8);
    }
    assert!(hits > 150, "{hits}");
}

#[test]
fn cells_out_of_range_are_told() {
    let refused = |grid: CellGrid, count: u32| {
        InstanceOctree::in_cells(vec![surface()], grid, Arc::new(Tufts { grid, count })).expect_err("a problem")
    };
    let sound = Tufts::new([3, 3], 1.0, 2).grid;
    let cells = [MOST_CELLS + 1, 2];
    assert_eq!(refused(CellGrid { cells, ..sound }, 1), InstanceError::TooManyCells { cells });
    assert_eq!(refused(sound, u32::MAX), InstanceError::TooManyInCell { instances: u32::MAX });
    let small = CellGrid { side: 0.01, ..sound };
    assert_eq!(refused(small, 1), InstanceError::SmallCells { overhang: 0.8, side: 0.01 });
    let infinite = CellGrid { heights: [0.0, f64::INFINITY], ..sound };
    assert_eq!(refused(infinite, 1), InstanceError::NotFinite { instance: 0 });
}
