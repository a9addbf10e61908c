//! Shafts: the triangles that rays from one box to another may hit, found once for all of these rays.

use super::Octree;
use super::descend::{each_in, is_any_in};
use super::packet::Packet;
use super::{Hit, Ray};
use crate::numeric::bounds::Bounds;
use glam::DVec3;

/// By how much boxes are widened, in sides of the modelling cube: single precision places corners to 2^-24 of it.
const WIDER: f64 = 1e-6;
/// Margin of a triangle that covers a shaft, as a fraction.
const SPARE: f64 = 1e-6;

/// All triangles that a ray from one box to another may hit.
#[derive(Clone, Debug)]
pub struct Shaft {
    packets: Vec<Packet>,
    triangles: usize,
}

impl Shaft {
    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.triangles
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.triangles == 0
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Shaft>() + size_of_val(&self.packets[..])
    }
}

/// The contents of a shaft between two boxes.
#[derive(Clone, Debug)]
pub enum ShaftContents {
    /// A triangle that stands before all of one box for all of the other.
    Covered,
    /// These triangles, none of which covers it.
    Some(Shaft),
    /// More triangles than were asked for.
    Many,
}

impl Octree {
    /// Finds the triangles that rays from points of one box to points of another may hit.
    ///
    /// - `covers`: whether a triangle counts as one that may stand before everything. `most`: triangles at the most.
    /// - Without an index there are always too many.
    pub fn between(&self, from: Bounds, to: Bounds, covers: impl Fn(u32) -> bool, most: usize) -> ShaftContents {
        if self.index.nodes.is_empty() && !self.triangles.is_empty() {
            return ShaftContents::Many;
        }
        let hull = Hull::new([from, to].map(|bounds| self.local_box(bounds)));
        let mut found = Vec::new();
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            let Some(node) = self.index.nodes.get(node) else { break };
            for (_, child) in node.boxes().filter(|(bounds, _)| hull.may_meet(bounds)) {
                match child.place() {
                    Err(node) => stack.push(node),
                    Ok(places) => {
                        for packet in &self.index.packets[places] {
                            for &triangle in packet.triangles.iter().filter(|triangle| **triangle != u32::MAX) {
                                let corners = self.local_corners(triangle);
                                if !hull.may_meet_triangle(&corners) {
                                    continue;
                                }
                                if covers(triangle) && hull.is_covered_by(&corners) {
                                    return ShaftContents::Covered;
                                }
                                found.push(triangle);
                            }
                        }
                    }
                }
            }
            if found.len() > 4 * most {
                return ShaftContents::Many;
            }
        }
        found.sort_unstable();
        found.dedup();
        if found.len() > most {
            return ShaftContents::Many;
        }
        let place = |vertex: u32| self.cube.local(self.vertices[vertex as usize]).as_vec3().to_array();
        let packet = |chunk: &[u32]| Packet::new(chunk.iter().copied(), &self.vertices, &self.triangles, place);
        let packets = found.chunks(super::lanes::LANES).map(packet);
        ShaftContents::Some(Shaft { packets: packets.collect(), triangles: found.len() })
    }

    /// Whether rays from points of one box to points of another hit no triangle that counts.
    ///
    /// True only where it is sure; never without an index.
    pub fn is_clear(&self, from: Bounds, to: Bounds, counts: impl Fn(u32) -> bool) -> bool {
        let hull = Hull::new([from, to].map(|bounds| self.local_box(bounds)));
        let is_in = |triangle| counts(triangle) && hull.may_meet_triangle(&self.local_corners(triangle));
        (!self.index.nodes.is_empty() || self.triangles.is_empty()) && !self.is_any_near(&hull, is_in)
    }

    /// Gives all triangles that may be in a box, some of them more than once; without an index, simply all.
    pub fn each_near(&self, bounds: Bounds, mut give: impl FnMut(u32)) {
        if self.index.nodes.is_empty() {
            return (0..self.triangles.len() as u32).for_each(give);
        }
        let hull = Hull::new([self.local_box(bounds); 2]);
        self.is_any_near(&hull, |triangle| {
            let near = Bounds::of(self.triangles[triangle as usize].map(|i| self.vertices[i as usize]));
            if near.touches(bounds) {
                give(triangle);
            }
            false
        });
    }

    /// Asks for triangles in a hull and some beside it, until one is enough; says whether one was.
    fn is_any_near(&self, hull: &Hull, mut enough: impl FnMut(u32) -> bool) -> bool {
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            let Some(node) = self.index.nodes.get(node) else { break };
            for (_, child) in node.boxes().filter(|(bounds, _)| hull.may_meet(bounds)) {
                match child.place() {
                    Err(node) => stack.push(node),
                    Ok(places) => {
                        let packets = self.index.packets[places].iter();
                        if packets.flat_map(|packet| packet.triangles).any(|t| t != u32::MAX && enough(t)) {
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    /// Whether lines from one box to another may lead through a third.
    pub fn may_stand_between(from: Bounds, to: Bounds, third: Bounds) -> bool {
        Hull::new([from, to]).may_meet(&third)
    }

    /// Gives all hits with `t_min < t < t_max` of a ray of which all that counts lies in a shaft, in no order, until one
    /// is enough; says whether one was.
    pub fn each_hit_in(
        &self,
        shaft: &Shaft,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        enough: impl FnMut(Hit) -> bool,
    ) -> bool {
        !shaft.is_empty() && each_in(self, &shaft.packets, ray, [t_min, t_max], enough)
    }

    /// Says whether a ray of which all that counts lies in a shaft hits anything with `t_min < t < t_max`.
    pub fn occluded_in(&self, shaft: &Shaft, ray: &Ray, t_min: f64, t_max: f64) -> bool {
        !shaft.is_empty() && is_any_in(self, &shaft.packets, ray, t_min, t_max)
    }

    fn local_box(&self, bounds: Bounds) -> Bounds {
        let wider = DVec3::splat(WIDER);
        Bounds { min: self.cube.local(bounds.min) - wider, max: self.cube.local(bounds.max) + wider }
    }

    fn local_corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|i| self.cube.local(self.vertices[i as usize]))
    }
}

/// The convex hull of two boxes.
///
/// # Source
/// Haines and Wallace 1991, shaft culling for efficient ray-cast radiosity.
struct Hull {
    ends: [Bounds; 2],
    around: Bounds,
    /// Sides that lean, each along one axis: the two other axes, the normal along them, and how far out it is.
    sides: Vec<([usize; 2], [f64; 2], f64)>,
}

impl Hull {
    fn new(ends: [Bounds; 2]) -> Hull {
        let mut sides = Vec::with_capacity(6);
        for axes in [[0, 1], [1, 2], [2, 0]] {
            for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                let [a, b] = ends.map(|bounds| {
                    [0, 1].map(|i| if signs[i] > 0.0 { bounds.max[axes[i]] } else { bounds.min[axes[i]] })
                });
                let along = [b[0] - a[0], b[1] - a[1]];
                let normal = [along[1], -along[0]];
                let turned = if normal[0] * signs[0] > 0.0 { normal } else { normal.map(|x| -x) };
                if turned[0] * signs[0] > 0.0 && turned[1] * signs[1] > 0.0 {
                    sides.push((axes, turned, turned[0] * a[0] + turned[1] * a[1]));
                }
            }
        }
        Hull { ends, around: ends[0].union(ends[1]), sides }
    }

    fn may_meet(&self, bounds: &Bounds) -> bool {
        self.around.touches(*bounds)
            && self.sides.iter().all(|(axes, normal, limit)| {
                let nearest = |i: usize| {
                    let axis = axes[i];
                    normal[i] * if normal[i] > 0.0 { bounds.min[axis] } else { bounds.max[axis] }
                };
                nearest(0) + nearest(1) <= *limit
            })
    }

    fn may_meet_triangle(&self, corners: &[DVec3; 3]) -> bool {
        let wider = DVec3::splat(WIDER);
        let Bounds { min, max } = Bounds::of(*corners);
        if !self.may_meet(&Bounds { min: min - wider, max: max + wider }) {
            return false;
        }
        // All of it on one side of the triangle's plane?
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        let spare = WIDER * normal.abs().element_sum();
        let heights = |end: &Bounds| {
            let middle = normal.dot(end.center() - a);
            let reach = normal.abs().dot(end.size()) * 0.5 + spare;
            [middle - reach, middle + reach]
        };
        let [one, two] = [&self.ends[0], &self.ends[1]].map(heights);
        one[0].min(two[0]) <= 0.0 && one[1].max(two[1]) >= 0.0
    }

    /// Whether all lines from one end to the other lead through a triangle, with something to spare.
    fn is_covered_by(&self, corners: &[DVec3; 3]) -> bool {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        let [from, to] = [&self.ends[0], &self.ends[1]].map(Bounds::corners);
        let height = |p: DVec3| normal.dot(p - a);
        let side = height(from[0]).signum();
        let spare = SPARE * normal.length();
        let apart = from.iter().all(|p| height(*p) * side > spare) && to.iter().all(|q| height(*q) * -side > spare);
        if !apart {
            return false;
        }
        // Normals inwards of the sides, in the plane.
        let inwards =
            [(a, b), (b, c), (c, a)].map(|(p, q)| (p, normal.cross(q - p), SPARE * (q - p).length() * normal.length()));
        from.iter().all(|p| {
            to.iter().all(|q| {
                let [h, k] = [height(*p), height(*q)];
                let t = h / (h - k);
                let at = *p + (*q - *p) * t;
                t > SPARE
                    && t < 1.0 - SPARE
                    && inwards.iter().all(|(on, inwards, spare)| (at - *on).dot(*inwards) > *spare)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::OctreeSettings;
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg32;

    fn soup(count: usize, size: f64, random: &mut Pcg32) -> Octree {
        let mut point = |scale: f64| DVec3::from_array(std::array::from_fn(|_| (random.random::<f64>() - 0.5) * scale));
        let vertices: Vec<DVec3> = (0..count)
            .flat_map(|_| {
                let at = point(2.0);
                [at + point(size), at + point(size), at + point(size)]
            })
            .collect();
        let triangles: Vec<[u32; 3]> = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Octree::build(&vertices, &triangles, &OctreeSettings::default()).expect("sound")
    }

    #[test]
    fn rays_in_a_shaft_hit_what_they_hit_anyway() {
        let mut random = Pcg32::seed_from_u64(5);
        let (mut some, mut covered, mut clear) = (0, 0, 0);
        for round in 0..400 {
            let octree = soup(60, [0.3, 1.0, 4.0][round % 3], &mut random);
            let mut within = |size: f64| {
                let mut number = || random.random::<f64>() - 0.5;
                let low = DVec3::new(number(), number(), number()) * 2.4;
                Bounds { min: low, max: low + DVec3::new(number().abs(), number().abs(), number().abs()) * size }
            };
            let [from, to] = [within(0.2), within(0.4)];
            let between = octree.between(from, to, |_| true, 40);
            let is_clear = octree.is_clear(from, to, |_| true);
            clear += usize::from(is_clear);
            for _ in 0..50 {
                let mut at = |bounds: Bounds| {
                    let part = DVec3::new(random.random(), random.random(), random.random());
                    bounds.min + bounds.size() * part
                };
                let (origin, end) = (at(from), at(to));
                let ray = Ray { origin, direction: end - origin };
                assert!(!(is_clear && octree.occluded(&ray, 0.0, 1.0)));
                match &between {
                    ShaftContents::Covered => {
                        covered += 1;
                        assert!(octree.occluded(&ray, 0.0, 1.0));
                    }
                    ShaftContents::Some(shaft) => {
                        some += 1;
                        let (mut inside, mut all) = (Vec::new(), Vec::new());
                        octree.each_hit_in(shaft, &ray, 0.0, 1.0, |hit| (inside.push(hit), false).1);
                        octree.each_hit(&ray, 0.0, 1.0, |hit| (all.push(hit), false).1);
                        inside.sort_by_key(|hit: &Hit| hit.triangle);
                        all.sort_by_key(|hit: &Hit| hit.triangle);
                        assert_eq!(inside, all);
                        let nearest =
                            all.into_iter().min_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
                        assert_eq!(nearest, octree.closest(&ray, 0.0, 1.0));
                        assert_eq!(octree.occluded_in(shaft, &ray, 0.0, 1.0), octree.occluded(&ray, 0.0, 1.0));
                    }
                    ShaftContents::Many => {}
                }
            }
        }
        assert!(some > 5000 && covered > 500 && clear > 20, "{some} {covered} {clear}");
    }

    #[test]
    fn near_a_box_are_all_triangles_of_which_the_boxes_touch_it() {
        let mut random = Pcg32::seed_from_u64(7);
        for count in [0, 1, 9, 500] {
            let octree = soup(count, 0.4, &mut random);
            let own =
                |triangle: u32| Bounds::of(octree.triangles[triangle as usize].map(|i| octree.vertices[i as usize]));
            for _ in 0..20 {
                let at = DVec3::from_array(std::array::from_fn(|_| random.random::<f64>() * 2.0 - 1.0));
                let bounds = Bounds { min: at, max: at + DVec3::splat(0.2) };
                let mut found = Vec::new();
                octree.each_near(bounds, |triangle| found.push(triangle));
                found.sort_unstable();
                found.dedup();
                let all: Vec<u32> = (0..count as u32).filter(|triangle| own(*triangle).touches(bounds)).collect();
                assert_eq!(found, all);
            }
        }
    }

    #[test]
    fn a_shaft_holds_little_more_than_what_its_rays_hit() {
        let mut random = Pcg32::seed_from_u64(6);
        let octree = soup(20_000, 0.02, &mut random);
        let small = |at: DVec3| Bounds { min: at, max: at + DVec3::splat(0.02) };
        let ShaftContents::Some(shaft) =
            octree.between(small(DVec3::splat(-0.9)), small(DVec3::splat(0.9)), |_| true, 1000)
        else {
            panic!("not many are between")
        };
        // The shaft has 0.02^2 of the 4 square units of the cross section, so to say, and triangles are as wide.
        assert!(shaft.len() < 60, "{}", shaft.len());
        let nothing = octree.between(small(DVec3::splat(-5.0)), small(DVec3::new(-5.0, -5.0, 5.0)), |_| true, 10);
        assert!(matches!(nothing, ShaftContents::Some(shaft) if shaft.is_empty()));
    }
}
