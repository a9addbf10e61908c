//! The compact form of a closed mesh: how each triangle joins the ones before it, and where its new vertex is not
//! where a parallelogram would put it.
//!
//! The triangles are taken in the order of a growing region. Its border is a set of loops; each step attaches the
//! triangle outside one border edge, the *gate* a-b, whose third vertex is new (`0`), the next border vertex after b
//! (`10`), the last before a (`110`), another vertex of the same loop (`1110` and the number of steps to it), or closes
//! the loop (`1111`). A new vertex is predicted at a + b - c, with c the apex, the vertex behind the gate; the three
//! differences are written as Golomb-Rice numbers whose parameter follows their mean. All positions are integers of 16
//! bits.
//!
//! Not modelled: boundaries, handles (tori), normals and parameters; the order of vertices and triangles is not kept.
//!
//! # Source
//! Cut-border machine: Gumhold and Strasser 1998. Parallelogram rule: Touma and Gotsman 1998. The codes are ours.

mod bits;
mod front;

use glam::{DVec3, I64Vec3};

use self::bits::{BitReader, BitWriter, Rice};
use self::front::{Front, Step};
use super::edges::EdgeTable;
use super::triangles::MAX_COUNT;
use super::{Fault, FaultLocation, Mesh, MeshProblem};

/// The first bytes of a file.
const MAGIC: &[u8; 8] = b"PERIScm1";
/// Magic, two counts, origin and step.
const HEADER_BYTES: usize = 8 + 2 * 4 + 4 * 8;
/// The longest side of the box in steps.
const STEPS: f64 = 65535.0;
/// Border edges walked in search of a vertex, for each triangle of the mesh: a limit on the work of a hostile file.
const WALK_PER_TRIANGLE: u64 = 256;

/// Understands a compact mesh.
pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    let ends = || FaultLocation::Byte(bytes.len()).fault(MeshProblem::Ends("the header"));
    let (header, body) = bytes.split_at_checked(HEADER_BYTES).ok_or_else(ends)?;
    if !header.starts_with(MAGIC) {
        let found = String::from_utf8_lossy(&header[..8]).into_owned();
        return Err(FaultLocation::Byte(0).fault(MeshProblem::Expected { expected: "PERIScm1", found }));
    }
    let count = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|k| header[at + k]));
    let real = |at: usize| f64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7].map(|k| header[at + k]));
    let (vertices, triangles) = (count(8), count(12));
    let (origin, step) = (DVec3::new(real(16), real(24), real(32)), real(40));
    // The smallest triangle takes one bit, the smallest vertex three.
    let limit = (body.len() as u64 * 8).min(MAX_COUNT as u64);
    if u64::from(vertices.max(triangles)) > limit {
        let count = u64::from(vertices.max(triangles));
        return Err(FaultLocation::Byte(8).fault(MeshProblem::TooMany {
            what: "vertices or triangles announced",
            count,
            limit,
        }));
    }
    if !(origin.is_finite() && step.is_finite()) {
        return Err(FaultLocation::Byte(16).fault(MeshProblem::NotFinite));
    }
    let mut decoder = Decoder::new(body, vertices, triangles);
    decoder.run().map_err(|problem| FaultLocation::Byte(HEADER_BYTES + decoder.bits.byte()).fault(problem))?;
    let vertices = decoder.positions.iter().map(|position| origin + position.as_dvec3() * step).collect();
    Ok(Mesh { vertices, triangles: decoder.triangles, ..Mesh::default() })
}

struct Decoder<'a> {
    bits: BitReader<'a>,
    rice: Rice,
    front: Front,
    vertex_count: u32,
    triangle_count: u32,
    walk_left: u64,
    last: I64Vec3,
    positions: Vec<I64Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> Decoder<'a> {
    fn new(body: &'a [u8], vertex_count: u32, triangle_count: u32) -> Self {
        Decoder {
            bits: BitReader::new(body),
            rice: Rice::default(),
            front: Front::default(),
            vertex_count,
            triangle_count,
            walk_left: WALK_PER_TRIANGLE * u64::from(triangle_count),
            last: I64Vec3::ZERO,
            positions: Vec::new(),
            triangles: Vec::new(),
        }
    }

    fn run(&mut self) -> Result<(), MeshProblem> {
        while (self.triangles.len() as u32) < self.triangle_count {
            let Some(gate) = self.front.pop() else {
                let mut corner = || self.vertex(self.last);
                let corners = [corner()?, corner()?, corner()?];
                self.front.start(corners);
                self.triangles.push(corners);
                continue;
            };
            let [a, b] = self.front.ends(gate);
            let (step, apex) = match self.bits.ones(4)? {
                0 => {
                    let position = |vertex: u32| self.positions[vertex as usize];
                    let predicted = position(a) + position(b) - position(self.front.apex(gate));
                    let apex = self.vertex(predicted)?;
                    (Step::Create(apex), apex)
                }
                1 => (Step::Right, self.front.right(gate)),
                2 => (Step::Left, self.front.left(gate)),
                3 => {
                    let distance = self.bits.gamma()?;
                    let node = self.front.ahead(gate, distance, &mut self.walk_left).ok_or(MISFIT)?;
                    (Step::Split(node), self.front.ends(node)[0])
                }
                _ => (Step::Close, self.front.right(gate)),
            };
            self.front.apply(gate, step).ok_or(MISFIT)?;
            self.triangles.push([b, a, apex]);
        }
        if self.front.pop().is_some() || self.positions.len() != self.vertex_count as usize {
            return Err(MISFIT);
        }
        Ok(())
    }

    fn vertex(&mut self, predicted: I64Vec3) -> Result<u32, MeshProblem> {
        if self.positions.len() == self.vertex_count as usize {
            let limit = u64::from(self.vertex_count);
            return Err(MeshProblem::TooMany { what: "vertices", count: limit + 1, limit });
        }
        let mut next = || self.rice.read(&mut self.bits);
        let position = predicted + I64Vec3::new(next()?, next()?, next()?);
        if position.cmplt(I64Vec3::ZERO).any() || position.cmpgt(I64Vec3::splat(STEPS as i64)).any() {
            return Err(MeshProblem::Expected { expected: "a coordinate of 0..=65535", found: position.to_string() });
        }
        self.positions.push(position);
        self.last = position;
        Ok(self.positions.len() as u32 - 1)
    }
}

/// A step that the border does not allow.
const MISFIT: MeshProblem = MeshProblem::Unsuited("the triangles do not fit together");

/// The compact form of `mesh`.
///
/// # Errors
/// If the mesh is not closed, or has a handle or a vertex where two of its parts only touch.
pub(super) fn print(mesh: &Mesh) -> Result<Vec<u8>, Fault> {
    let unsuited = |reason| FaultLocation::Mesh.fault(MeshProblem::Unsuited(reason));
    let report = mesh.edge_report();
    if !report.is_closed() || report.collapsed > 0 {
        return Err(unsuited("the compact form holds closed meshes without collapsed triangles only"));
    }
    let bounds = mesh.bounds().ok_or_else(|| unsuited("the mesh is empty"))?;
    let step = bounds.size().max_element() / STEPS;
    // The step of a mesh that is smaller than the least normal number is rounded so much that the far side lies beyond
    // it.
    let far = I64Vec3::splat(STEPS as i64);
    let quantised = |p: &DVec3| ((*p - bounds.min) / step).round().as_i64vec3().clamp(I64Vec3::ZERO, far);
    let positions = mesh.vertices.iter().map(quantised).collect();
    let mut encoder = Encoder::new(mesh, positions);
    encoder
        .run()
        .ok_or_else(|| unsuited("the compact form holds meshes without handles and touching vertices only"))?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(&(report.vertices as u32).to_le_bytes());
    bytes.extend_from_slice(&(report.triangles as u32).to_le_bytes());
    for value in bounds.min.to_array().into_iter().chain([step]) {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    bytes.extend(encoder.bits.into_bytes());
    Ok(bytes)
}

/// Half edge h is side h % 3 of triangle h / 3.
struct Encoder {
    bits: BitWriter,
    rice: Rice,
    front: Front,
    walk_left: u64,
    positions: Vec<I64Vec3>,
    /// The vertex that each half edge leaves.
    origin: Vec<u32>,
    opposite: Vec<u32>,
    is_done: Vec<bool>,
    is_known: Vec<bool>,
    last: I64Vec3,
    /// Border node of each half edge of the region, and the half edge of each node.
    node_at: Vec<u32>,
    half_of: Vec<u32>,
}

impl Encoder {
    fn new(mesh: &Mesh, positions: Vec<I64Vec3>) -> Encoder {
        let table = EdgeTable::of(mesh);
        let mut opposite = vec![0; mesh.triangles.len() * 3];
        for edge in &table.edges {
            if let [a, b] = table.uses(edge) {
                let [a, b] = [a, b].map(|place| 3 * place.triangle + u32::from(place.side));
                opposite[a as usize] = b;
                opposite[b as usize] = a;
            }
        }
        Encoder {
            bits: BitWriter::default(),
            rice: Rice::default(),
            front: Front::default(),
            walk_left: WALK_PER_TRIANGLE * mesh.triangles.len() as u64,
            origin: mesh.triangles.iter().flatten().map(|&vertex| table.same[vertex as usize]).collect(),
            is_done: vec![false; mesh.triangles.len()],
            is_known: vec![false; positions.len()],
            last: I64Vec3::ZERO,
            node_at: vec![0; opposite.len()],
            half_of: Vec::new(),
            positions,
            opposite,
        }
    }

    fn run(&mut self) -> Option<()> {
        for seed in 0..self.is_done.len() as u32 {
            if self.is_done[seed as usize] {
                continue;
            }
            let halves = [3 * seed, 3 * seed + 1, 3 * seed + 2];
            let corners = halves.map(|half| self.origin[half as usize]);
            for corner in corners {
                let predicted = self.last;
                self.vertex(corner, predicted)?;
            }
            self.front.start(corners);
            self.is_done[seed as usize] = true;
            self.register(&halves);
            while let Some(gate) = self.front.pop() {
                self.attach(gate)?;
            }
        }
        Some(())
    }

    /// Writes the triangle outside `gate`.
    fn attach(&mut self, gate: u32) -> Option<()> {
        let entry = self.opposite[self.half_of[gate as usize] as usize];
        let (from_a, from_apex) = (next_half(entry), next_half(next_half(entry)));
        let apex = self.origin[from_apex as usize];
        self.is_done[entry as usize / 3] = true;
        let step = match self.border_node(from_a) {
            None => {
                self.bits.ones(0, 4);
                let [a, b] = self.front.ends(gate);
                let position = |vertex: u32| self.positions[vertex as usize];
                self.vertex(apex, position(a) + position(b) - position(self.front.apex(gate)))?;
                Step::Create(apex)
            }
            Some(node) => {
                let step = self.front.step_to(gate, node);
                match step {
                    Step::Right => self.bits.ones(1, 4),
                    Step::Left => self.bits.ones(2, 4),
                    Step::Close => self.bits.ones(4, 4),
                    Step::Split(_) | Step::Create(_) => {
                        self.bits.ones(3, 4);
                        self.bits.gamma(self.front.distance(gate, node, &mut self.walk_left)?);
                    }
                }
                step
            }
        };
        self.front.apply(gate, step)?;
        match step {
            Step::Create(_) | Step::Split(_) => self.register(&[from_a, from_apex]),
            Step::Right => self.register(&[from_a]),
            Step::Left => self.register(&[from_apex]),
            Step::Close => {}
        }
        Some(())
    }

    /// Remembers which half edges the newest border nodes stand for.
    fn register(&mut self, halves: &[u32]) {
        for &half in halves {
            self.node_at[half as usize] = self.half_of.len() as u32;
            self.half_of.push(half);
        }
    }

    /// The border node that leaves the vertex that `incoming` reaches, on the side of its triangle; `None` if no
    /// triangle around that vertex, on this side, is done.
    fn border_node(&self, incoming: u32) -> Option<u32> {
        let mut half = incoming;
        loop {
            let outgoing = self.opposite[half as usize];
            if outgoing / 3 != incoming / 3 && self.is_done[outgoing as usize / 3] {
                return Some(self.node_at[outgoing as usize]);
            }
            half = next_half(next_half(outgoing));
            if half == incoming {
                return None;
            }
        }
    }

    /// Writes a vertex; `None` if it was written before.
    fn vertex(&mut self, vertex: u32, predicted: I64Vec3) -> Option<()> {
        if std::mem::replace(&mut self.is_known[vertex as usize], true) {
            return None;
        }
        self.last = self.positions[vertex as usize];
        for difference in (self.last - predicted).to_array() {
            self.rice.write(difference, &mut self.bits);
        }
        Some(())
    }
}

fn next_half(half: u32) -> u32 {
    if half % 3 == 2 { half - 2 } else { half + 1 }
}
