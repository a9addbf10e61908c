//! Renderings against closed forms and against tests of single points that share no code with them.

mod colors;
mod cuts;
mod degenerate;
mod extremes;
mod images;
mod lines;

use super::*;
use crate::{
    functions::devices::shading::ShadingEnvironment,
    port::{ObjectId, Rendering},
    structure::{Member, Node, Operation, Polygons, Structures},
    traversal,
};
use glam::{DMat3, DMat4, DVec3};
use protocol::command::{Polygon, PolygonVertex};

/// What is displayed: matrices from the outside in, then the rendering node, then what is below it.
#[derive(Default)]
struct Scene {
    above: Vec<Operation>,
    below: Vec<Node>,
    solid: bool,
}

const STORAGE: u32 = u32::MAX;

impl Scene {
    fn new(polygons: Vec<Polygon>) -> Scene {
        Scene { below: vec![block(polygons)], ..Scene::default() }
    }

    fn solid(polygons: Vec<Polygon>) -> Scene {
        Scene { solid: true, ..Scene::new(polygons) }
    }

    fn above(mut self, operation: Operation) -> Scene {
        self.above.push(operation);
        self
    }

    fn below(mut self, node: Node) -> Scene {
        self.below.insert(0, node);
        self
    }

    fn facets(&self, storage: u32) -> Result<Facets, RenderingFault> {
        let mut structures = Structures::default();
        let [root, rendering] = [ObjectId::new(0), ObjectId::new(1)];
        let operate = |operation: &Operation| Node::operate(operation.clone(), None);
        structures.define(rendering, operate(&Operation::Rendering { solid: self.solid }));
        let mut members: Vec<Member> = self.above.iter().map(|o| Member::Unnamed(operate(o))).collect();
        members.push(Member::Named(rendering));
        members.extend(self.below.iter().cloned().map(Member::Unnamed));
        structures.define(root, Node::Group(members));
        structures.display(root);
        Facets::new(&traversal::gather(&structures, 0, rendering), &structures, self.solid, storage)
    }

    fn render(&self, kind: Rendering, environment: &ShadingEnvironment) -> Result<RenderingResult, RenderingFault> {
        render(kind, self.facets(STORAGE)?, environment)
    }

    fn lines(&self, kind: Rendering) -> Vec<Segment> {
        match self.render(kind, &ShadingEnvironment::default()) {
            Ok(RenderingResult::Lines(lines)) => lines,
            other => panic!("{other:?}"),
        }
    }

    fn image(&self, kind: Rendering, environment: &ShadingEnvironment) -> Image {
        match self.render(kind, environment) {
            Ok(RenderingResult::Image(image)) => image,
            other => panic!("{other:?}"),
        }
    }
}

/// Hard samples and no depth cue.
fn plain() -> ShadingEnvironment {
    ShadingEnvironment { quality: 0, depth_cue: 0.0, ..ShadingEnvironment::default() }
}

fn block(polygons: Vec<Polygon>) -> Node {
    let attributes = vec![None; polygons.len()];
    Node::Polygons(Box::new(Polygons { polygons, attributes }))
}

fn polygon(corners: &[[f32; 3]]) -> Polygon {
    let vertex = |position: &[f32; 3]| PolygonVertex { soft: false, position: *position, normal: None, color: None };
    let vertices = corners.iter().map(vertex);
    Polygon { attributes: None, outline: None, coplanar: false, vertices: vertices.collect() }
}

fn soft(mut polygon: Polygon) -> Polygon {
    polygon.vertices.iter_mut().for_each(|vertex| vertex.soft = true);
    polygon
}

fn hole(corners: &[[f32; 3]]) -> Polygon {
    Polygon { coplanar: true, ..polygon(corners) }
}

const A: [f32; 3] = [0.5, 0.5, 0.5];
const B: [f32; 3] = [0.5, -0.5, -0.5];
const C: [f32; 3] = [-0.5, 0.5, -0.5];
const D: [f32; 3] = [-0.5, -0.5, 0.5];

/// A tetrahedron: ABC and BDC face the eye, AD is the only edge behind them; its outline is the square -0.5..=0.5.
fn tetrahedron() -> Vec<Polygon> {
    [[A, B, C], [A, C, D], [A, D, B], [B, D, C]].iter().map(|corners| polygon(corners)).collect()
}

/// The ends of segments, each with the smaller end first, sorted, rounded to 1e-6.
fn ends(segments: &[Segment]) -> Vec<[[i64; 3]; 2]> {
    let round = |p: DVec3| p.to_array().map(|c| (c * 1e6).round() as i64);
    let mut ends: Vec<[[i64; 3]; 2]> = segments
        .iter()
        .map(|segment| {
            let mut ends = segment.ends.map(round);
            ends.sort_unstable();
            ends
        })
        .collect();
    ends.sort_unstable();
    ends
}

fn edges(pairs: &[[[f32; 3]; 2]]) -> Vec<[[i64; 3]; 2]> {
    let segment = |pair: &[[f32; 3]; 2]| Segment { ends: pair.map(|p| DVec3::from(p.map(f64::from))), color: [0.0; 2] };
    ends(&pairs.iter().map(segment).collect::<Vec<_>>())
}

/// A torus of `n` by `n` squares, seen obliquely: 2 n^2 triangles or n^2 polygons with four corners.
fn torus(n: usize, turn: DMat3) -> Vec<Polygon> {
    let at = |i: usize, k: usize| {
        let [u, v] = [i, k].map(|i| std::f64::consts::TAU * (i % n) as f64 / n as f64);
        let ring = 0.55 + 0.3 * v.cos();
        (turn * DVec3::new(ring * u.cos(), ring * u.sin(), 0.3 * v.sin())).as_vec3().to_array()
    };
    let cell = |i: usize, k: usize| [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
    let cells = (0..n * n).map(|c| cell(c / n, c % n));
    cells.flat_map(|[a, b, c, d]| [polygon(&[a, c, b]), polygon(&[a, d, c])]).collect()
}

fn perspective() -> Operation {
    let view = crate::matrices::field_of_view(60.0, [0.1, 10.0]).unwrap_or(DMat4::IDENTITY);
    Operation::Projective(view)
}
