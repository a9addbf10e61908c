//! Polygons for local rendering, and a plain z-buffer to compare with.

use glam::{DMat4, DVec3};
use host::mesh::Mesh;
use protocol::command::{Polygon, PolygonVertex};
use ps340::{
    matrices,
    port::ObjectId,
    rendering::Facets,
    structure::{Member, Node, Operation, Polygons, Structures},
    traversal,
};

/// The triangles of a mesh in the axes of the machine, clockwise from outside.
///
/// - `soft`: whether all edges are.
pub fn polygons(mesh: &Mesh, soft: bool) -> Vec<Polygon> {
    let vertex = |p: DVec3| {
        let position = DVec3::new(p.x, p.y, -p.z).as_vec3().to_array();
        PolygonVertex { soft, position, normal: None, color: None }
    };
    let triangle = |k: usize| {
        let [a, b, c] = mesh.corners(k);
        let vertices = [c, b, a].map(vertex).to_vec();
        Polygon { attributes: None, outline: None, coplanar: false, vertices }
    };
    (0..mesh.triangles.len()).map(triangle).collect()
}

/// A perspective view from a point to the origin, 45 degrees wide.
pub fn view(from: DVec3) -> Vec<Operation> {
    let view = matrices::field_of_view(45.0, [0.5, 10.0]).expect("the angle is good");
    let look = matrices::look(DVec3::ZERO, from, DVec3::Y).expect("the places are apart");
    vec![Operation::Projective(view), Operation::Affine(look)]
}

/// What a rendering node renders that has matrices above it and polygons below.
///
/// # Panics
/// If nothing can be rendered.
pub fn facets(polygons: Vec<Polygon>, solid: bool, above: &[Operation]) -> Facets {
    let mut structures = Structures::default();
    let [root, rendering] = [ObjectId::new(0), ObjectId::new(1)];
    let operate = |operation| Node::operate(operation, None);
    structures.define(rendering, operate(Operation::Rendering { solid }));
    let attributes = vec![None; polygons.len()];
    let mut members: Vec<Member> = above.iter().cloned().map(|o| Member::Unnamed(operate(o))).collect();
    members.push(Member::Named(rendering));
    members.push(Member::Unnamed(Node::Polygons(Box::new(Polygons { polygons, attributes }))));
    structures.define(root, Node::Group(members));
    structures.display(root);
    let gathered = traversal::gather(&structures, 0, rendering);
    Facets::new(&gathered, &structures, solid, u32::MAX).expect("the polygons can be rendered")
}

/// The matrix of operations from the outside in.
pub fn matrix(above: &[Operation]) -> DMat4 {
    above.iter().fold(DMat4::IDENTITY, |ctm, operation| match operation {
        Operation::Projective(m) | Operation::Affine(m) => ctm * *m,
        _ => ctm,
    })
}

/// A point on a square screen of so many pixels, and 1/w.
pub fn to_screen(matrix: &DMat4, point: DVec3, size: usize) -> DVec3 {
    let clip = *matrix * point.extend(1.0);
    let half = size as f64 / 2.0;
    DVec3::new((clip.x / clip.w + 1.0) * half, (clip.y / clip.w + 1.0) * half, 1.0 / clip.w)
}

/// The nearest 1/w at the middle of each pixel, 0 where there is nothing: the textbook loop over boxes with three
/// sides, no bands, no incremental spans.
pub fn z_buffer(triangles: &[[DVec3; 3]], size: usize) -> Vec<f64> {
    let mut buffer = vec![0.0; size * size];
    for [a, b, c] in triangles {
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        let low = a.min(*b).min(*c).max(DVec3::ZERO);
        let high = a.max(*b).max(*c);
        let end = |c: f64| (c.max(0.0) as usize + 1).min(size);
        for y in low.y as usize..end(high.y) {
            for x in low.x as usize..end(high.x) {
                let p = DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 0.0);
                let part = |p: DVec3, q: DVec3, r: DVec3| (q - p).truncate().perp_dot((r - p).truncate()) / area;
                let shares = [part(*b, *c, p), part(*c, *a, p), part(*a, *b, p)];
                let nearness = shares[0] * a.z + shares[1] * b.z + shares[2] * c.z;
                let there = &mut buffer[y * size + x];
                if shares.iter().all(|share| *share >= 0.0) && nearness > *there {
                    *there = nearness;
                }
            }
        }
    }
    buffer
}
