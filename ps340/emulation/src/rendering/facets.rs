//! The polygons below a rendering node as one mesh: welded points, faces with their contours, edges, triangles.
//!
//! # Model
//! Polygons meet where their corners are equal in eye coordinates, to the bit. A COPLANAR polygon is a further contour
//! of the face before it. The front of a face is the side from which it runs clockwise, whatever mirrors stand above
//! it. Corners at the point of the corner before them do not count, as at the poles of a sphere of quadrangles; faces
//! with fewer than three others, and those with coordinates that are not finite, are left out.
//!
//! # Cost
//! Time and memory grow with the number of corners: about 300 bytes each, and as much again while a rendering is made.

use super::{
    RenderingFault,
    surface::{self, DirectionalLight, Surface},
    triangulate::triangulate,
};
use crate::{
    port::ObjectId,
    structure::{MatrixFactors, Node, Polygons, State, Structures},
    traversal::{Gathered, Plane, newell},
};
use glam::{DMat3, DMat4, DVec3, DVec4};
use protocol::command::Polygon;
use std::{
    collections::{HashMap, hash_map::Entry},
    ops::Range,
};

/// Bytes of working storage that a rendering takes for a vertex: what a client reserves.
pub const BYTES_PER_VERTEX: u64 = 50;
/// Most vertices that are rendered together, so that a rendering begins within half a second and takes less than a
/// gigabyte. Ours.
pub const MAX_VERTICES: usize = 1_000_000;
/// What is thinner than this part of the coordinates may be due to their single precision.
const RESOLUTION: f64 = 1.0 / (1 << 21) as f64;

/// A point where corners of polygons meet.
#[derive(Clone, Copy, Debug)]
pub struct MeshPoint {
    /// In eye coordinates.
    pub eye: DVec3,
    /// In the coordinates of the rendering node, homogeneous.
    pub local: DVec4,
    /// In clip space.
    pub clip: DVec4,
    /// The number of the view that shows it.
    pub view: u32,
}

/// A corner of a face.
#[derive(Clone, Copy, Debug)]
pub struct FaceCorner {
    /// Its point.
    pub point: u32,
    /// The normal given with it, in eye coordinates, towards the front of the face.
    pub normal: Option<DVec3>,
    /// Whether the edge that ends here is soft.
    pub soft: bool,
    /// Red, green and blue, 0..=1, that were given with it for the front and the reverse of the face.
    pub colors: Option<[[f32; 3]; 2]>,
}

/// A polygon with the contours that belong to it.
#[derive(Clone, Debug)]
pub struct Face {
    /// Its corners, all contours one after the other.
    pub corners: Range<usize>,
    /// Where in the list of contours its own are.
    pub contours: Range<usize>,
    /// Towards its front, of length 1, in eye coordinates; 0 if it has no area.
    pub normal: DVec3,
    /// The middle of its corners, in eye coordinates.
    pub center: DVec3,
    /// Whether its front is seen.
    pub toward: bool,
    /// The surfaces of the front and the reverse, as numbers in the list of surfaces.
    pub surfaces: [u32; 2],
    /// The number of the view that shows it.
    pub view: u32,
    /// Hue and saturation in which its first contour is drawn.
    pub color: [f64; 2],
}

/// A triangle of a face.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Its corners, clockwise seen from the front.
    pub corners: [u32; 3],
    /// The face.
    pub face: u32,
    /// Whether its own front is seen; triangles of a face that is not plane may differ.
    pub toward: bool,
}

/// An edge between two points.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// The points, the smaller number first.
    pub ends: [u32; 2],
    /// The first two faces at it; the same face may be both.
    pub faces: [Option<u32>; 2],
    /// The corners of these faces at its ends.
    pub corners: [[u32; 2]; 2],
    /// How many contours run along it from the first end to the second, and back.
    pub uses: [u32; 2],
    /// Whether it is soft in all polygons at it.
    pub soft: bool,
    /// Hue and saturation of the first polygon at it.
    pub color: [f64; 2],
}

/// How a block of polygons is seen.
#[derive(Clone, Debug)]
pub struct BlockView {
    /// From eye coordinates to clip space.
    pub matrix: DMat4,
    /// Where the eye is, in eye coordinates; a direction towards it if the last component is 0.
    pub eye: DVec4,
    /// Left and right of the viewport on the vector screen.
    pub horizontal: [f64; 2],
    /// Bottom and top.
    pub vertical: [f64; 2],
    /// Whether front and back boundary cut.
    pub depth_clipping: bool,
}

/// All that a rendering node renders.
#[derive(Clone, Debug, Default)]
pub struct Facets {
    /// Whether the node takes them as the boundary of a solid.
    pub solid: bool,
    /// Points.
    pub points: Vec<MeshPoint>,
    /// Corners of all faces.
    pub corners: Vec<FaceCorner>,
    /// The contours of all faces, as ranges of corners.
    pub contours: Vec<Range<usize>>,
    /// Faces.
    pub faces: Vec<Face>,
    /// Triangles, in the order of the faces.
    pub triangles: Vec<Triangle>,
    /// Edges, in the order in which polygons bring them.
    pub edges: Vec<Edge>,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// Whether corners have colours of their own.
    pub is_colored: bool,
    /// The views in which they are seen.
    pub views: Vec<BlockView>,
    /// Lights, at least one.
    pub lights: Vec<DirectionalLight>,
    /// The sectioning plane.
    pub plane: Option<Plane>,
    /// Hue and saturation that are in force at the rendering node.
    pub color: [f64; 2],
}

impl Facets {
    /// The mesh of what was gathered below a node.
    ///
    /// - `working_storage`: bytes that are reserved.
    ///
    /// # Errors
    /// The node is not displayed, has no polygons, or too little storage is reserved for them.
    pub fn new(
        gathered: &Gathered,
        structures: &Structures,
        solid: bool,
        working_storage: u32,
    ) -> Result<Facets, RenderingFault> {
        let node = gathered.node.as_ref().ok_or(RenderingFault::NotDisplayed)?;
        let polygons = gathered.blocks.iter().flat_map(|block| &block.polygons.polygons);
        let vertices: usize = polygons.map(|polygon| polygon.vertices.len()).sum();
        let needed = vertices as u64 * BYTES_PER_VERTEX;
        if vertices == 0 {
            return Err(RenderingFault::NoPolygons);
        }
        if vertices > MAX_VERTICES || needed > u64::from(working_storage) {
            return Err(RenderingFault::Storage { needed });
        }
        let lights = gathered
            .lights
            .iter()
            .filter_map(|(light, matrix)| DirectionalLight::new(light, &DMat3::from_mat4(*matrix)));
        let mut lights: Vec<DirectionalLight> = lights.collect();
        if gathered.lights.is_empty() {
            lights.push(DirectionalLight::default());
        }
        let facets = Facets { solid, plane: gathered.plane, color: node.hue_saturation, lights, ..Facets::default() };
        let mut builder = Builder { facets, ..Builder::default() };
        for block in &gathered.blocks {
            builder.block(block.polygons, &block.state, &block.factors, structures);
        }
        Ok(builder.facets)
    }

    /// The points of the corners of a contour.
    pub fn contour(&self, contour: usize) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.corners[self.contours[contour].clone()].iter().map(|corner| corner.point)
    }

    /// Hue and saturation of an edge: those of the first polygon at it, or of the second if only that shows its front.
    pub fn color_of(&self, edge: &Edge) -> [f64; 2] {
        match edge.faces.map(|face| face.map(|face| &self.faces[face as usize])) {
            [Some(first), Some(second)] if second.toward && !first.toward => second.color,
            _ => edge.color,
        }
    }

    /// The first two faces at an edge.
    pub fn faces_of<'a>(&'a self, edge: &Edge) -> impl Iterator<Item = &'a Face> + use<'a> {
        edge.faces.into_iter().flatten().map(|face| &self.faces[face as usize])
    }
}

/// Fills the tables.
#[derive(Default)]
struct Builder {
    facets: Facets,
    points: HashMap<[u64; 4], u32>,
    edges: HashMap<[u32; 2], u32>,
    surface_numbers: HashMap<(Option<ObjectId>, [u64; 2]), [u32; 2]>,
}

impl Builder {
    fn block(&mut self, polygons: &Polygons, state: &State, factors: &MatrixFactors, structures: &Structures) {
        let Some(local) = factors.local else { return };
        let view = self.view(state, factors);
        let frame = Frame::new(factors.eye, local, state.ctm);
        let mut color = state.hue_saturation;
        let mut open = false;
        for (polygon, attributes) in polygons.polygons.iter().zip(&polygons.attributes) {
            if let Some(hue) = polygon.outline {
                color = [hue, 1.0];
            }
            let continues = polygon.coplanar && open;
            if open && !continues {
                self.finish_face(frame.mirror);
                open = false;
            }
            let begin = self.facets.corners.len();
            if !self.contour(&frame, view, polygon) {
                self.facets.corners.truncate(begin);
                continue;
            }
            if !continues {
                let surfaces = self.surfaces_of(*attributes, state.hue_saturation, structures);
                self.open_face(begin, surfaces, view, color);
                open = true;
            }
            let number = self.facets.faces.len() - 1;
            let face = &mut self.facets.faces[number];
            face.corners.end = self.facets.corners.len();
            face.contours.end += 1;
            self.facets.contours.push(begin..face.corners.end);
            self.contour_edges(begin, number as u32, color);
        }
        if open {
            self.finish_face(frame.mirror);
        }
    }

    /// Appends the corners of a contour; false if one is not finite, or fewer than three differ from the one before.
    fn contour(&mut self, frame: &Frame, view: u32, polygon: &Polygon) -> bool {
        let begin = self.facets.corners.len();
        for vertex in &polygon.vertices {
            let normal = vertex.normal.and_then(|n| (frame.normals * DVec3::from(n.map(f64::from))).try_normalize());
            let Some(point) = self.point(frame, view, vertex.position.map(f64::from)) else { return false };
            let rgb = |color: [f32; 3]| surface::rgb(color.map(f64::from)).map(|part| part as f32);
            let colors = vertex.color.map(|color| [color.front, color.back.unwrap_or(color.front)].map(rgb));
            self.facets.is_colored |= colors.is_some();
            self.facets.corners.push(FaceCorner { point, normal, soft: vertex.soft, colors });
        }
        let corners = &mut self.facets.corners;
        let (mut end, mut before) = (begin, corners.last().map(|corner| corner.point));
        for k in begin..corners.len() {
            let corner = corners[k];
            if before.replace(corner.point) != Some(corner.point) {
                corners[end] = corner;
                end += 1;
            }
        }
        corners.truncate(end);
        end >= begin + 3
    }

    fn open_face(&mut self, begin: usize, surfaces: [u32; 2], view: u32, color: [f64; 2]) {
        let contours = self.facets.contours.len();
        self.facets.faces.push(Face {
            corners: begin..begin,
            contours: contours..contours,
            normal: DVec3::ZERO,
            center: DVec3::ZERO,
            toward: false,
            surfaces,
            view,
            color,
        });
    }

    fn view(&mut self, state: &State, factors: &MatrixFactors) -> u32 {
        let view = BlockView {
            matrix: factors.view,
            eye: eye_point(&factors.view),
            horizontal: state.horizontal,
            vertical: state.vertical,
            depth_clipping: state.depth_clipping,
        };
        let same = |other: &BlockView| {
            other.matrix == view.matrix
                && (other.horizontal, other.vertical) == (view.horizontal, view.vertical)
                && other.depth_clipping == view.depth_clipping
        };
        // Blocks with the same view come one after the other.
        if !self.facets.views.last().is_some_and(same) {
            self.facets.views.push(view);
        }
        self.facets.views.len() as u32 - 1
    }

    /// The point at a position; none if that is not finite.
    fn point(&mut self, frame: &Frame, view: u32, place: [f64; 3]) -> Option<u32> {
        let place = DVec3::from(place);
        // Adding 0 makes -0 the same point as 0.
        let eye = frame.eye.transform_point3(place) + DVec3::ZERO;
        let [x, y, z] = eye.to_array().map(f64::to_bits);
        match self.points.entry([x, y, z, view.into()]) {
            Entry::Occupied(known) => Some(*known.get()),
            Entry::Vacant(new) => {
                let local = frame.local * place.extend(1.0);
                let clip = frame.ctm * place.extend(1.0);
                if !(eye.is_finite() && local.is_finite() && clip.is_finite()) {
                    return None;
                }
                self.facets.points.push(MeshPoint { eye, local, clip, view });
                Some(*new.insert(self.facets.points.len() as u32 - 1))
            }
        }
    }

    fn surfaces_of(&mut self, attributes: Option<ObjectId>, color: [f64; 2], structures: &Structures) -> [u32; 2] {
        let surfaces = &mut self.facets.surfaces;
        *self.surface_numbers.entry((attributes, color.map(f64::to_bits))).or_insert_with(|| {
            let node = attributes.and_then(|id| structures.node(structures.follow(id)));
            let [front, back] = match node {
                Some(Node::Attributes(attributes)) => [attributes.front, attributes.back.unwrap_or(attributes.front)],
                _ => [Surface::plain(color); 2],
            };
            surfaces.extend([front, back].map(|side| Surface::new(&side)));
            let end = surfaces.len() as u32;
            [end - 2, end - 1]
        })
    }

    fn contour_edges(&mut self, begin: usize, face: u32, color: [f64; 2]) {
        let end = self.facets.corners.len();
        let mut before = end - 1;
        for corner in begin..end {
            let [from, to] = [before, corner].map(|corner| self.facets.corners[corner].point);
            let mut corners = [before as u32, corner as u32];
            let ends = [from.min(to), from.max(to)];
            let direction = usize::from(from > to);
            if from > to {
                corners.reverse();
            }
            before = corner;
            let edges = &mut self.facets.edges;
            let number = *self.edges.entry(ends).or_insert_with(|| {
                edges.push(Edge { ends, faces: [None; 2], corners: [[0; 2]; 2], uses: [0; 2], soft: true, color });
                edges.len() as u32 - 1
            });
            let edge = &mut edges[number as usize];
            edge.uses[direction] += 1;
            edge.soft &= self.facets.corners[corner].soft;
            if let Some(place) = edge.faces.iter().position(Option::is_none) {
                (edge.faces[place], edge.corners[place]) = (Some(face), corners);
            }
        }
    }

    /// Gives the last face its normal, and cuts it into triangles.
    ///
    /// - `mirror`: -1 if what is seen is mirrored.
    fn finish_face(&mut self, mirror: f64) {
        let facets = &mut self.facets;
        let number = facets.faces.len() as u32 - 1;
        let Some(face) = facets.faces.last_mut() else { return };
        let begin = face.corners.start;
        let corners: Vec<DVec3> =
            facets.corners[face.corners.clone()].iter().map(|c| facets.points[c.point as usize].eye).collect();
        let contours: Vec<Range<usize>> =
            facets.contours[face.contours.clone()].iter().map(|c| c.start - begin..c.end - begin).collect();
        let area = newell(&corners[contours[0].clone()]);
        face.center = corners.iter().sum::<DVec3>() / corners.len() as f64;
        face.normal = area.normalize_or_zero() * mirror;
        face.toward = face.normal.dot(toward_eye(facets.views[face.view as usize].eye, face.center)) > 0.0;
        let mut triangles = Vec::with_capacity(corners.len());
        triangulate(&corners, &contours, area, &mut triangles);
        let eye = facets.views[face.view as usize].eye;
        facets.triangles.extend(triangles.into_iter().map(|triangle| {
            let place = triangle.map(|corner| corners[corner as usize]);
            let given = triangle.map(|corner| facets.corners[begin + corner as usize].normal);
            let toward = front(&place, given, mirror).dot(toward_eye(eye, place[0])) > 0.0;
            Triangle { corners: triangle.map(|corner| begin as u32 + corner), face: number, toward }
        }));
    }
}

/// Towards the front of a triangle, any length.
///
/// Where it is so thin that coordinates of single precision do not decide, its normals do, if it has some: what is in
/// the plane of its neighbours is seen as they are.
fn front(place: &[DVec3; 3], given: [Option<DVec3>; 3], mirror: f64) -> DVec3 {
    let area = newell(place) * mirror;
    let reach = place.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let longest = (0..3).map(|k| place[k].distance(place[(k + 1) % 3])).fold(0.0, f64::max);
    let [Some(a), Some(b), Some(c)] = given else { return area };
    if area.length() < longest * reach * RESOLUTION { a + b + c } else { area }
}

/// The matrices of a block.
struct Frame {
    /// To eye coordinates, to those of the rendering node, to clip space.
    eye: DMat4,
    local: DMat4,
    ctm: DMat4,
    /// For normals, to eye coordinates; lengths change.
    normals: DMat3,
    /// -1 if the first mirrors, else 1.
    mirror: f64,
}

impl Frame {
    fn new(eye: DMat4, local: DMat4, ctm: DMat4) -> Frame {
        let DMat3 { x_axis, y_axis, z_axis } = DMat3::from_mat4(eye);
        let mirror = DMat3::from_mat4(eye).determinant().signum();
        // Planes move by the cofactors, which exist for every matrix.
        let cofactors = DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
        Frame { eye, local, ctm, normals: cofactors * mirror, mirror }
    }
}

/// Where the eye of a view is: the point, or the direction, that every line of sight goes through.
fn eye_point(view: &DMat4) -> DVec4 {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| view.row(row));
    // Perpendicular, in four dimensions, to the rows that give the position on the screen.
    let minor = |skip: [usize; 3]| {
        DMat3::from_cols(
            DVec3::from(skip.map(|k| x[k])),
            DVec3::from(skip.map(|k| y[k])),
            DVec3::from(skip.map(|k| w[k])),
        )
        .determinant()
    };
    let eye = DVec4::new(minor([1, 2, 3]), -minor([0, 2, 3]), minor([0, 1, 3]), -minor([0, 1, 2]));
    if eye.w != 0.0 {
        return eye / eye.w;
    }
    // Towards where depth decreases.
    let sign = if eye.truncate().dot(z.truncate()) > 0.0 { -1.0 } else { 1.0 };
    (eye.truncate().normalize_or(DVec3::NEG_Z) * sign).extend(0.0)
}

/// From a point towards the eye; not of length 1.
pub fn toward_eye(eye: DVec4, point: DVec3) -> DVec3 {
    eye.truncate() - point * eye.w
}
