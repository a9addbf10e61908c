//! Shells of a closed surface, and those of them that face inwards beside others.

use super::boolean::passes;
use super::union_find::UnionFind;
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::numeric::exact::{ExactNumber, cross, dot};
use crate::numeric::implicit::{ImplicitPoint, PointDefinition};
use crate::numeric::triangle::nearest;
use crate::octree::TriangleBvh;
use glam::DVec3;

/// Part of the size of a mesh within which a point counts as one on a surface, when it is asked what is around it.
const NEAR: f64 = 1e-9;
/// Triangles at an edge lie on each other if their angles differ by less, radians.
const SAME_ANGLE: f64 = 1e-9;

/// The shells of a closed surface: triangles that are connected by edges. Where more than two share an edge, those
/// belong together that have the inside of one shell between them.
pub(super) struct Shells {
    /// The shell of each triangle.
    of: Vec<u32>,
    /// The triangles of each shell.
    triangles: Vec<Vec<u32>>,
    /// Volume of each, cubic units; its sign is that of the true one.
    volumes: Vec<f64>,
}

impl Shells {
    /// The shells of a mesh in which all edges are traversed both ways alike, so that each shell has a volume.
    ///
    /// Cost: n log n.
    pub(super) fn of(mesh: &Mesh) -> Shells {
        let mut joined = UnionFind::new(mesh.triangles.len());
        // An edge as one number, from its lower vertex to its higher, and the triangle and corner that are opposite to
        // it.
        let mut sides: Vec<(u64, u32, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
        for (t, triangle) in mesh.triangles.iter().zip(0..) {
            for k in 0..3 {
                let (a, b) = (u64::from(t[k]), u64::from(t[(k + 1) % 3]));
                sides.push((a.min(b) << 32 | a.max(b), triangle, t[(k + 2) % 3]));
            }
        }
        sides.sort_unstable();
        for around in sides.chunk_by(|one, two| one.0 == two.0) {
            match around {
                [one, two] => joined.join(one.1, two.1),
                _ => join_around(mesh, around, &mut joined),
            }
        }
        let mut number = vec![u32::MAX; mesh.triangles.len()];
        let mut triangles: Vec<Vec<u32>> = Vec::new();
        let of = (0..mesh.triangles.len() as u32)
            .map(|triangle| {
                let body = &mut number[joined.find(triangle) as usize];
                if *body == u32::MAX {
                    *body = triangles.len() as u32;
                    triangles.push(Vec::new());
                }
                triangles[*body as usize].push(triangle);
                *body
            })
            .collect();
        let volume = |own: &Vec<u32>| certain_volume(mesh, own.iter().map(|&triangle| triangle as usize));
        let volumes = triangles.iter().map(volume).collect();
        Shells { of, triangles, volumes }
    }

    /// Number of shells.
    pub(super) fn count(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles of a shell.
    pub(super) fn triangles(&self, body: usize) -> &[u32] {
        &self.triangles[body]
    }

    /// The volume of a shell, cubic units, negative if it faces inwards.
    pub(super) fn volume(&self, body: usize) -> f64 {
        self.volumes[body]
    }

    /// The shells that face inwards and lie in no other: all but the walls of cavities. Shells are tested from the
    /// outer to the inner, each as if those around it had been reversed already.
    ///
    /// A shell is the wall of a cavity if others wind around a corner or middle of one of its triangles that is not
    /// near their surface.
    ///
    /// Cost: a ray for each triangle of the shells that face inwards.
    pub(super) fn inside_out(&self, mesh: &Mesh, sorted: &TriangleBvh) -> Vec<usize> {
        if !self.volumes.iter().any(|volume| *volume < 0.0) {
            return Vec::new();
        }
        let near = NEAR * sorted.bounds().diagonal();
        let extent = |body: usize| {
            let corners = self.triangles[body].iter().flat_map(|&t| mesh.corners(t as usize));
            Bounds::of(corners).diagonal()
        };
        let mut order: Vec<(f64, usize)> = (0..self.count()).map(|body| (extent(body), body)).collect();
        order.sort_by(|one, two| two.0.total_cmp(&one.0).then(one.1.cmp(&two.1)));
        // How each shell counts: as it is, reversed, or not yet.
        let mut signs = vec![0; self.count()];
        let mut inside_out = Vec::new();
        for (_, body) in order {
            signs[body] = 1;
            if self.volumes[body] >= 0.0 {
                continue;
            }
            let winding = |point: DVec3| self.winding_of_others(mesh, sorted, body, &signs, point, near);
            let is_wound_around = |&triangle: &u32| {
                let [a, b, c] = mesh.corners(triangle as usize);
                winding((a + b + c) / 3.0) > Some(0) || winding(a) > Some(0)
            };
            if !self.triangles[body].iter().any(is_wound_around) {
                signs[body] = -1;
                inside_out.push(body);
            }
        }
        inside_out.sort_unstable();
        inside_out
    }

    /// The winding number at a point of the other shells that count; `None` near one of them.
    fn winding_of_others(
        &self,
        mesh: &Mesh,
        sorted: &TriangleBvh,
        body: usize,
        signs: &[i32],
        point: DVec3,
        near: f64,
    ) -> Option<i32> {
        let at = ImplicitPoint::new(PointDefinition::Given(point));
        let (mut winding, mut is_near) = (0, false);
        let beside = Bounds { min: point - near, max: (point + near).with_x(f64::INFINITY) };
        sorted.touching(beside, |triangle| {
            let other = self.of[triangle as usize] as usize;
            if other == body || signs[other] == 0 {
                return;
            }
            let corners = mesh.corners(triangle as usize);
            is_near |= nearest(point, corners).distance(point) <= near;
            winding += signs[other] * passes(&at, corners);
        });
        (!is_near).then_some(winding)
    }
}

/// Joins triangles at an edge in pairs that bound the same shell there.
///
/// Counter-clockwise around an edge, the inside of a shell begins at a triangle that runs back along the edge, and ends
/// at one that runs forth: they are matched as brackets are. Of those that lie on each other, the one is taken that is
/// joined already.
fn join_around(mesh: &Mesh, around: &[(u64, u32, u32)], joined: &mut UnionFind) {
    let Some(&(edge, first, opposite)) = around.first() else { return };
    let ends = [(edge >> 32) as u32, edge as u32];
    let [from, to] = ends.map(|end| mesh.vertices[end as usize]);
    let (along, right) = (to - from, mesh.vertices[opposite as usize] - from);
    let (up, out) = (along.cross(right), along.cross(right).cross(along));
    let fan = |&(_, triangle, opposite): &(u64, u32, u32)| {
        let (to, corners) = (mesh.vertices[opposite as usize] - from, mesh.triangles[triangle as usize]);
        let angle = if triangle == first { 0.0 } else { (to.dot(up) * along.length()).atan2(to.dot(out)) };
        let angle = if angle < -SAME_ANGLE { angle + std::f64::consts::TAU } else { angle };
        let is_forth = (0..3).any(|k| [corners[k], corners[(k + 1) % 3]] == ends);
        RadialTriangle { angle, is_forth, triangle }
    };
    let mut blades: Vec<RadialTriangle> = around.iter().map(fan).collect();
    blades.sort_by(|one, two| one.angle.total_cmp(&two.angle).then(one.triangle.cmp(&two.triangle)));
    let lies_on = |one: &RadialTriangle, two: &RadialTriangle| {
        one.is_forth == two.is_forth && (one.angle - two.angle).abs() < SAME_ANGLE
    };
    // The second time around, what was left open the first time is closed by what had nothing to close then.
    let (mut open, mut left): (Vec<RadialTriangle>, Vec<RadialTriangle>) = (Vec::new(), blades);
    for _ in 0..2 {
        let mut unmatched: Vec<RadialTriangle> = Vec::new();
        let mut next = 0;
        while let Some(&blade) = left.get(next) {
            let Some(&last) = open.last().filter(|_| blade.is_forth) else {
                next += 1;
                if blade.is_forth { &mut unmatched } else { &mut open }.push(blade);
                continue;
            };
            let ends = (next..left.len()).take_while(|&k| lies_on(&left[k], &blade));
            let begins = || (0..open.len()).rev().take_while(|&k| lies_on(&open[k], &last));
            let mut pairs = ends.flat_map(|end| begins().map(move |begin| [begin, end]));
            let is_joined =
                |&[begin, end]: &[usize; 2]| joined.root(open[begin].triangle) == joined.root(left[end].triangle);
            let [begin, end] = pairs.find(is_joined).unwrap_or([open.len() - 1, next]);
            joined.join(open.remove(begin).triangle, left.remove(end).triangle);
        }
        left = unmatched;
    }
}

/// A triangle at an edge, to be sorted radially around it.
#[derive(Clone, Copy)]
struct RadialTriangle {
    /// Around the edge from the first triangle, radians.
    angle: f64,
    /// Whether it runs along the edge from its lower vertex to its higher.
    is_forth: bool,
    triangle: u32,
}

/// The volume inside some triangles of a mesh that make a closed surface, cubic units. Its sign is that of the true
/// one, however thin that is.
pub fn certain_volume(mesh: &Mesh, triangles: impl Iterator<Item = usize> + Clone) -> f64 {
    let bounds = Bounds::of(triangles.clone().flat_map(|triangle| mesh.corners(triangle)));
    let (center, mut count) = (bounds.center(), 0);
    let near = triangles.clone().map(|triangle| {
        count += 1;
        let [a, b, c] = mesh.corners(triangle).map(|corner| corner - center);
        a.dot(b.cross(c))
    });
    let sixfold: f64 = near.sum();
    // The rounding of each product and that of their sum, all of them as large as can be.
    let reach = 0.5 * bounds.size().max_element();
    if sixfold.abs() > 600.0 * f64::EPSILON * reach.powi(3) * f64::from(count) {
        return sixfold / 6.0;
    }
    let sixfold = triangles.fold(ExactNumber::default(), |sum, triangle| {
        let [a, b, c] = mesh.corners(triangle).map(|p| p.to_array().map(ExactNumber::from));
        sum + dot(&a, &cross(&b, &c))
    });
    sixfold.over(&ExactNumber::from(6.0))
}
