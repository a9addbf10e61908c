//! Divides the faces that several creases hold apart, so that a crease that comes to its end has narrow strips at its sides.
//!
//! The two sides of such a face never come nearer to each other by steps, since they lie still. Between them it gets a
//! point in the middle of each of its sides that is stretched so, and pieces around its own middle. What is flat stays so:
//! the limit surface is the same, as long as the creases last.

use super::creases::Creases;
use super::error::SubdivisionError;
use super::limit::{SharpRim, Target};
use super::polyhedron::{NONE, Polyhedron};

/// How a face is divided.
struct Cut {
    /// The corners at which pieces meet.
    at_corners: Vec<u32>,
    /// The sides in whose middle pieces meet.
    at_sides: Vec<u32>,
}

/// The polyhedron, each face divided that creases of finite sharpness hold apart.
///
/// # Errors
/// Edges of more than two faces, or two faces that run the same way along an edge.
pub(super) fn divided(mesh: Polyhedron) -> Result<Polyhedron, SubdivisionError> {
    let creases = Creases::of(&mesh);
    let cuts: Vec<Option<Cut>> = (0..mesh.face_count()).map(|face| Cut::of(&creases, face)).collect();
    if cuts.iter().all(Option::is_none) {
        return Ok(mesh);
    }
    let mut pieces = Pieces::between(&mesh, &cuts);
    for (face, cut) in cuts.iter().enumerate() {
        let outline = pieces.outline(&mesh, face);
        match cut {
            Some(cut) => pieces.push_cut(&mesh, face, &outline, cut),
            None => pieces.push(&outline),
        }
    }
    let Pieces { points, corners, sharpness, starts, .. } = pieces;
    let mut vertex_sharpness = mesh.vertex_sharpness;
    if !vertex_sharpness.is_empty() {
        vertex_sharpness.resize(points.len(), 0.0);
    }
    let divided = Polyhedron::linked(points, corners, starts)?;
    Ok(Polyhedron { edge_sharpness: sharpness, vertex_sharpness, ..divided })
}

impl Cut {
    fn of(creases: &Creases<'_>, face: usize) -> Option<Cut> {
        let mesh = creases.mesh;
        let sides = mesh.starts[face]..mesh.starts[face + 1];
        let is_used_up = |sharpness: f64| sharpness >= 1.0 && sharpness.is_finite();
        let of_vertex = |h: u32| mesh.vertex_sharpness.get(mesh.corners[h as usize] as usize).copied().unwrap_or(0.0);
        if !sides.clone().any(|h| is_used_up(mesh.sharpness(h)) || is_used_up(of_vertex(h))) {
            return None;
        }
        let attractors = SharpRim::of(creases, face).attractors();
        if attractors.is_one {
            return None;
        }
        let target = |h: u32| attractors.targets[(h - sides.start) as usize];
        // At a corner of a face that is cut there, the crease goes by.
        let is_middle = |h: u32| creases.cut[h as usize] || target(h) == Target::Free;
        let is_stretched = |h: u32| {
            let next = mesh.next[h as usize];
            !is_middle(h) && !is_middle(next) && target(h) != target(next)
        };
        let at_corners: Vec<u32> = sides.clone().filter(|&h| is_middle(h)).collect();
        let at_sides: Vec<u32> = sides.clone().filter(|&h| is_stretched(h)).collect();
        (at_corners.len() + at_sides.len() > 1).then_some(Cut { at_corners, at_sides })
    }
}

/// A corner of a new face: its vertex, the corner of the old face or the side in the middle of which it lies, and the
/// sharpness of the side behind it.
#[derive(Clone, Copy)]
struct Corner {
    vertex: u32,
    of: u32,
    is_halfway: bool,
    sharpness: f64,
}

/// The new faces.
struct Pieces {
    points: Vec<glam::DVec3>,
    corners: Vec<u32>,
    /// Of the side behind each corner.
    sharpness: Vec<f64>,
    starts: Vec<u32>,
    /// For each old side the vertex in its middle.
    halfway: Vec<u32>,
}

impl Pieces {
    /// No faces yet, but the points in the middle of sides.
    fn between(mesh: &Polyhedron, cuts: &[Option<Cut>]) -> Pieces {
        let mut points = mesh.points.clone();
        let mut halfway = vec![NONE; mesh.corners.len()];
        for &side in cuts.iter().flatten().flat_map(|cut| &cut.at_sides) {
            if halfway[side as usize] != NONE {
                continue;
            }
            let ends = [side, mesh.next[side as usize]].map(|h| mesh.points[mesh.corners[h as usize] as usize]);
            halfway[side as usize] = points.len() as u32;
            if let Some(other) = halfway.get_mut(mesh.twins[side as usize] as usize) {
                *other = points.len() as u32;
            }
            points.push(ends[0].midpoint(ends[1]));
        }
        Pieces { points, corners: Vec::new(), sharpness: Vec::new(), starts: vec![0], halfway }
    }

    /// The corners of a face with the points in the middle of its sides.
    fn outline(&self, mesh: &Polyhedron, face: usize) -> Vec<Corner> {
        let mut outline = Vec::new();
        for side in mesh.starts[face]..mesh.starts[face + 1] {
            let sharpness = mesh.edge_sharpness.get(side as usize).copied().unwrap_or(0.0);
            outline.push(Corner { vertex: mesh.corners[side as usize], of: side, is_halfway: false, sharpness });
            let vertex = self.halfway[side as usize];
            if vertex != NONE {
                outline.push(Corner { vertex, of: side, is_halfway: true, sharpness });
            }
        }
        outline
    }

    fn push(&mut self, face: &[Corner]) {
        self.corners.extend(face.iter().map(|corner| corner.vertex));
        self.sharpness.extend(face.iter().map(|corner| corner.sharpness));
        self.starts.push(self.corners.len() as u32);
    }

    /// Pieces from each cut to the next.
    fn push_cut(&mut self, mesh: &Polyhedron, face: usize, outline: &[Corner], cut: &Cut) {
        let is_cut = |corner: &Corner| {
            let cuts = if corner.is_halfway { &cut.at_sides } else { &cut.at_corners };
            cuts.contains(&corner.of)
        };
        let at: Vec<usize> = (0..outline.len()).filter(|&k| is_cut(&outline[k])).collect();
        // Two points are joined by a line, unless there may be one already.
        let center = (at.len() > 2 || cut.at_sides.is_empty()).then(|| {
            let corners: Vec<glam::DVec3> = mesh.face_points(face).collect();
            self.points.push(corners.iter().sum::<glam::DVec3>() / corners.len() as f64);
            Corner { vertex: self.points.len() as u32 - 1, of: NONE, is_halfway: false, sharpness: 0.0 }
        });
        for (k, &first) in at.iter().enumerate() {
            let end = if k + 1 < at.len() { at[k + 1] } else { at[0] + outline.len() };
            let mut piece: Vec<Corner> = (first..=end).map(|k| outline[k % outline.len()]).collect();
            let last = piece.len() - 1;
            piece[last].sharpness = 0.0;
            piece.extend(center);
            self.push(&piece);
        }
    }
}
