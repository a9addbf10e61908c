//! Casters of shadows: triangles that are turned towards a light, and the silhouettes where they end.
//!
//! Every triangle counts, whichever side is lit: the volumes of all triangles, each turned towards the light, lie
//! within one another, and how many of them a point is in is how many triangles stand between it and the light. Sides
//! that turned neighbours share cancel out; of a closed body only its silhouette is left, counted twice. So open, badly
//! oriented and branching meshes need no care of their own.

use super::lamp::LightPosition;
use super::screen::Viewpoint;
use super::sorted_groups::SortedGroups;
use crate::scene::Prepared;
use glam::DVec3;
use rayon::prelude::*;

/// No triangle.
const NONE: u32 = u32::MAX;

/// A side of one or two triangles, from its lower to its higher vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct CasterEdge {
    pub(super) ends: [u32; 2],
    /// The triangle that goes along it, and one that goes against it.
    triangles: [u32; 2],
}

/// A side at which shadows end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Silhouette {
    pub(super) ends: [u32; 2],
    /// How often turned triangles go along it, less those that go against it.
    pub(super) weight: i32,
    /// The group of its triangles: see [`Casters::group`].
    pub(super) group: u8,
}

/// All triangles that throw shadows.
pub(super) struct Casters<'a> {
    pub(super) prepared: &'a Prepared,
    /// Numbers of the triangles: those of the objects that the plan keeps.
    pub(super) triangles: Vec<u32>,
    edges: Vec<CasterEdge>,
    /// For all triangles of the scene, the group; empty if all are opaque.
    groups: Vec<u8>,
}

impl<'a> Casters<'a> {
    /// Finds what the triangles share.
    ///
    /// - `groups`: for each triangle of the scene, 0 if it is opaque, or the number of what it lets through; empty if
    ///   all are opaque.
    pub(super) fn new(prepared: &'a Prepared, triangles: Vec<u32>, groups: Vec<u8>) -> Casters<'a> {
        let mut casters = Casters { prepared, triangles, edges: Vec::new(), groups };
        casters.edges = casters.shared();
        casters
    }

    /// The group of a triangle, by what it lets through: 0 for nothing.
    pub(super) fn group(&self, triangle: u32) -> u8 {
        self.groups.get(triangle as usize).copied().unwrap_or(0)
    }

    /// The edges, sorted by their lower vertex.
    fn shared(&self) -> Vec<CasterEdge> {
        let sides = |triangle: u32| {
            let [a, b, c] = self.prepared.triangles[triangle as usize];
            [[a, b], [b, c], [c, a]].into_iter().filter(|[a, b]| a != b)
        };
        // By the lower vertex: the higher vertex, and the triangle; whether it goes against the edge.
        let all = self
            .triangles
            .iter()
            .flat_map(|&triangle| sides(triangle).map(move |[a, b]| (a.min(b) as usize, (a.max(b), triangle, a > b))));
        let vertices = self.prepared.vertices.len();
        let half = SortedGroups::new(vertices, all);
        let mut edges: Vec<CasterEdge> = Vec::with_capacity(3 * self.triangles.len() / 2 + 16);
        for low in 0..vertices {
            let first = edges.len();
            for &(high, triangle, against) in half.of(low) {
                let side = usize::from(against);
                let open = edges[first..].iter_mut().find(|edge| {
                    edge.ends[1] == high
                        && edge.triangles[side] == NONE
                        && self.group(edge.triangles[1 - side]) == self.group(triangle)
                });
                match open {
                    Some(edge) => edge.triangles[side] = triangle,
                    None => {
                        let mut triangles = [NONE; 2];
                        triangles[side] = triangle;
                        edges.push(CasterEdge { ends: [low as u32, high], triangles });
                    }
                }
            }
        }
        edges
    }

    /// For each triangle of the scene, on which side of it a light is: 1 outside, -1 inside, 0 for one that is lit edge
    /// on or throws no shadow. The body of a lamp throws none in the lamp's own light.
    ///
    /// - `own`: the light of the scene whose point it is, if it is one.
    pub(super) fn facing(&self, light: &LightPosition, own: Option<u32>) -> Vec<i8> {
        let mut facing = vec![0i8; self.prepared.triangles.len()];
        let side = |triangle: usize| {
            let [a, b, c] = self.prepared.corners(triangle as u32);
            let height = (b - a).cross(c - a).dot(light.from(a));
            i8::from(height > 0.0) - i8::from(height < 0.0)
        };
        if self.triangles.len() == facing.len() {
            facing.par_iter_mut().with_min_len(1 << 12).enumerate().for_each(|(i, facing)| *facing = side(i));
        } else {
            self.triangles.iter().for_each(|&triangle| facing[triangle as usize] = side(triangle as usize));
        }
        if let Some(body) = own.and_then(|own| self.prepared.objects.iter().find(|object| object.light == Some(own))) {
            facing[body.first as usize..(body.first + body.count) as usize].fill(0);
        }
        facing
    }

    /// The silhouettes for a light.
    ///
    /// - `facing`: as [`Casters::facing`] gives it.
    pub(super) fn silhouettes(&self, facing: &[i8]) -> Vec<Silhouette> {
        let of = |triangle: u32| facing.get(triangle as usize).map_or(0, |facing| i32::from(*facing));
        let silhouette = |edge: &CasterEdge| {
            let weight = of(edge.triangles[0]) - of(edge.triangles[1]);
            let triangle = edge.triangles[usize::from(edge.triangles[0] == NONE)];
            (weight != 0).then(|| Silhouette { ends: edge.ends, weight, group: self.group(triangle) })
        };
        self.edges.par_iter().with_min_len(1 << 12).filter_map(silhouette).collect()
    }

    /// The point from which samples are counted, if there is one: the viewpoint itself, or far beyond everything.
    pub(super) fn start(&self, light: &LightPosition, viewpoint: Viewpoint) -> Option<DVec3> {
        match (viewpoint, light) {
            (Viewpoint::At(eye), _) => Some(eye),
            // Seen from infinitely far away, light from infinitely far away comes from elsewhere.
            (Viewpoint::Towards(_), LightPosition::Direction(_)) => None,
            (Viewpoint::Towards(direction), LightPosition::Point(at)) => {
                let far = self.prepared.bounds.diagonal() + (*at - self.prepared.bounds.center()).length();
                Some(*at + direction * (4.0 * far))
            }
        }
    }
}
