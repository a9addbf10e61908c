//! An octree as bytes: what was put in and the terminal nodes. The index is made anew.
//!
//! Layout: eight bytes of name, version (u32), checksum (CRC-32 of the rest, u32), then the fields of [`Stored`].
//! Numbers are little-endian; integers of the fields have variable length.

use crate::encoding::{Integers, decode, encode};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::mesh::Mesh;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::build::{Leaves, Nodes, OctreeBuilder, TriangleReference, octants};
use super::code::{LocationalCode, MAX_DEPTH};
use super::cube::Cube;
use super::error::{OctreeError, check};
use super::settings::{OctreeSettings, Walk};
use super::tree::{ObjectCounts, Octree};

/// The first bytes of every file.
const NAME: &[u8; 8] = b"PERISOCT";
/// Changes whenever the meaning of the bytes does.
const VERSION: u32 = 1;
/// Bytes before the fields.
const HEAD: usize = 16;

/// How the name of an octree file ends.
pub const ENDING: &str = "octree";

/// The longest file that is read, bytes.
pub const MAX_BYTES: u64 = 16 << 30;

/// A reason for which bytes are not an octree.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// It begins with something else.
    #[error("this is not an octree: it does not begin with {}", NAME.escape_ascii())]
    Name,
    /// A version that is not known.
    #[error("octree files of version {found} are not known; this program reads version {VERSION}")]
    Version {
        /// The version that the file names.
        found: u32,
    },
    /// Some bytes have changed or are missing.
    #[error("the octree is damaged: its bytes do not have the checksum that it names")]
    Checksum,
    /// The fields cannot be read.
    #[error("the octree cannot be read: {0}")]
    Fields(String),
    /// The fields contradict each other.
    #[error("the octree contradicts itself: {0}")]
    Contradiction(&'static str),
    /// The triangles are wrong.
    #[error(transparent)]
    Triangles(#[from] OctreeError),
}

/// The fields of a file.
#[derive(Serialize, Deserialize)]
struct Stored {
    origin: [f64; 3],
    side: f64,
    depth: u32,
    leaf_triangles: u64,
    /// Number of vertices and triangles of each object.
    objects: Vec<[u64; 2]>,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    codes: Vec<u64>,
    /// Number of triangles of each terminal node.
    counts: Vec<u32>,
    references: Vec<u32>,
}

impl Octree {
    /// The octree as bytes; the same octree gives the same bytes.
    ///
    /// # Errors
    /// [`FileError::Fields`] if memory is short.
    pub fn to_bytes(&self) -> Result<Vec<u8>, FileError> {
        let leaves = self.leaves();
        let stored = Stored {
            origin: self.cube.origin.to_array(),
            side: self.cube.side,
            depth: self.depth,
            leaf_triangles: self.leaf_triangles as u64,
            objects: self.objects.iter().map(|o| [o.vertices as u64, o.triangles as u64]).collect(),
            vertices: self.vertices.iter().map(DVec3::to_array).collect(),
            triangles: self.triangles.to_vec(),
            codes: leaves.codes.iter().map(|code| code.bits()).collect(),
            counts: (0..leaves.codes.len()).map(|leaf| leaves.of(leaf).len() as u32).collect(),
            references: leaves.triangles.clone(),
        };
        let fields = encode(&stored, Integers::Compact).map_err(|error| FileError::Fields(error.to_string()))?;
        let mut bytes = NAME.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(crc32fast::hash(&fields).to_le_bytes());
        bytes.extend(fields);
        Ok(bytes)
    }

    /// Whether a name is that of an octree file.
    pub fn is_file(path: &Path) -> bool {
        path.extension().is_some_and(|ending| ending == ENDING)
    }

    /// The triangles, with the numbers of their objects as surfaces.
    pub fn mesh(&self) -> Mesh {
        let surfaces = (0..).zip(&self.objects).flat_map(|(number, object)| vec![number; object.triangles]);
        let (vertices, triangles) = (self.vertices.to_vec(), self.triangles.to_vec());
        Mesh { vertices, triangles, surfaces: surfaces.collect(), ..Mesh::default() }
    }

    /// Reads what [`Octree::to_bytes`] wrote. Rays go down the index.
    ///
    /// Bytes that are not an octree are refused, also where a node does not name just the triangles that touch it.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FileError> {
        let (head, fields) = bytes.split_at_checked(HEAD).ok_or(FileError::Name)?;
        let number = |at: usize| head[at..].iter().take(4).rev().fold(0, |n, &byte| n << 8 | u32::from(byte));
        if !head.starts_with(NAME) {
            return Err(FileError::Name);
        }
        if number(8) != VERSION {
            return Err(FileError::Version { found: number(8) });
        }
        if number(12) != crc32fast::hash(fields) {
            return Err(FileError::Checksum);
        }
        let (stored, used) = decode::<Stored, { MAX_BYTES as usize }>(fields, Integers::Compact)
            .map_err(|error| FileError::Fields(error.to_string()))?;
        if used != fields.len() {
            return Err(FileError::Fields("bytes are left over".into()));
        }
        stored.octree()
    }
}

/// An error unless something holds.
fn demand(holds: bool, otherwise: &'static str) -> Result<(), FileError> {
    if holds { Ok(()) } else { Err(FileError::Contradiction(otherwise)) }
}

/// Checks that the terminal nodes in a cell name the triangles that touch them, and no others.
///
/// - `nodes`: those in the cell.
/// - `references`: to the triangles that touch the cell.
fn check_nodes(
    division: &OctreeBuilder,
    leaves: &Leaves,
    cell: LocationalCode,
    nodes: Range<usize>,
    references: &[TriangleReference],
) -> Result<(), FileError> {
    if leaves.codes.get(nodes.start).filter(|_| !nodes.is_empty()) == Some(&cell) {
        let named = leaves.of(nodes.start).iter();
        let is_same = named.eq(references.iter().map(|reference| &reference.triangle));
        return demand(is_same, "a node does not name just the triangles that touch it");
    }
    if nodes.is_empty() {
        return demand(references.is_empty(), "a triangle lies where there is no node");
    }
    for (octant, part) in octants(cell).zip(division.distribute(cell, references)) {
        check_nodes(division, leaves, octant, leaves.within(octant, nodes.clone()), &part)?;
    }
    Ok(())
}

impl Stored {
    fn octree(self) -> Result<Octree, FileError> {
        let vertices: Vec<DVec3> = self.vertices.iter().map(|&p| DVec3::from_array(p)).collect();
        check(&vertices, &self.triangles)?;
        let cube = Cube { origin: DVec3::from_array(self.origin), side: self.side };
        demand(cube.is_sound(), "the modelling cube is none")?;
        let mut used = self.triangles.iter().flatten().map(|&i| vertices[i as usize]);
        demand(used.all(|p| cube.voxel(p).is_some()), "a triangle leaves the modelling cube")?;
        demand(self.depth <= MAX_DEPTH, "the resolution is too high")?;
        let leaf_triangles = usize::try_from(self.leaf_triangles).unwrap_or(usize::MAX);
        let objects = self.objects(&vertices)?;
        let leaves = self.leaves()?;
        let settings = OctreeSettings { depth: self.depth, leaf_triangles, ..OctreeSettings::default() };
        let mut octree = Octree { vertices: Arc::new(vertices), objects, ..Octree::of_cube(cube, &settings) };
        octree.triangles = Arc::new(self.triangles);
        let division = octree.division();
        let all = division.references(0..octree.triangles.len());
        check_nodes(&division, &leaves, LocationalCode::ROOT, 0..leaves.codes.len(), &all)?;
        let homes = division.homes(0..octree.triangles.len());
        octree.nodes = Nodes { homes, leaves }.into();
        Ok(octree.with_walk(Walk::Index))
    }

    /// The objects, which share out all vertices and triangles, each using its own vertices.
    fn objects(&self, vertices: &[DVec3]) -> Result<Vec<ObjectCounts>, FileError> {
        let mut objects = Vec::new();
        let (mut vertex, mut triangle) = (0, 0);
        for &[vertex_count, triangle_count] in &self.objects {
            let end = |start: usize, count: u64| usize::try_from(count).ok().and_then(|count| start.checked_add(count));
            let end_vertex = end(vertex, vertex_count).filter(|&end| end <= vertices.len());
            let end_triangle = end(triangle, triangle_count).filter(|&end| end <= self.triangles.len());
            let (Some(end_vertex), Some(end_triangle)) = (end_vertex, end_triangle) else {
                return Err(FileError::Contradiction("the objects have more than there is"));
            };
            let mut corners = self.triangles[triangle..end_triangle].iter().flatten();
            demand(
                corners.all(|&corner| (vertex..end_vertex).contains(&(corner as usize))),
                "an object uses the vertices of another",
            )?;
            objects.push(ObjectCounts { vertices: end_vertex - vertex, triangles: end_triangle - triangle });
            (vertex, triangle) = (end_vertex, end_triangle);
        }
        demand((vertex, triangle) == (vertices.len(), self.triangles.len()), "the objects have less than there is")?;
        Ok(objects)
    }

    /// The terminal nodes: sorted, apart, no smaller than voxels, each with some triangles in order.
    fn leaves(&self) -> Result<Leaves, FileError> {
        let mut codes = Vec::with_capacity(self.codes.len());
        for &bits in &self.codes {
            let code = LocationalCode::from_bits(bits).filter(|code| code.level() <= self.depth);
            codes.push(code.ok_or(FileError::Contradiction("a code is none"))?);
        }
        let are_apart = codes.windows(2).all(|pair| pair[0] < pair[1] && !pair[0].contains(pair[1]));
        demand(are_apart, "the codes are not sorted, or a node lies in another")?;
        demand(self.counts.len() == codes.len(), "there are not as many nodes as codes")?;
        let mut ends = Vec::with_capacity(codes.len());
        let mut end = 0_usize;
        for &count in &self.counts {
            let part = self.references.get(end..end.saturating_add(count as usize)).filter(|part| !part.is_empty());
            let part = part.ok_or(FileError::Contradiction("a node is empty, or has more than there is"))?;
            let is_in_range = part.iter().all(|&triangle| (triangle as usize) < self.triangles.len());
            demand(
                is_in_range && part.is_sorted_by(|a, b| a < b),
                "the triangles of a node are wrong or not in order",
            )?;
            end += part.len();
            ends.push(end);
        }
        demand(end == self.references.len(), "triangles belong to no node")?;
        Ok(Leaves { codes, ends, triangles: self.references.clone() })
    }
}
