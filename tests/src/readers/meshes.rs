//! Readers of meshes in each format, and of octrees.

use super::sums;
use host::mesh::{Format, MeshPlace, PlacedMeshes, parse_grouped, parse_placed, print_grouped, print_placed};
use host::octree::Octree;

pub fn obj(bytes: &[u8]) {
    mesh(bytes, Format::Obj);
}

pub fn stl(bytes: &[u8]) {
    mesh(bytes, Format::Stl);
}

pub fn ply(bytes: &[u8]) {
    mesh(bytes, Format::Ply);
}

pub fn gltf(bytes: &[u8]) {
    mesh(bytes, Format::Gltf);
    places(bytes, Format::Gltf);
}

pub fn glb(bytes: &[u8]) {
    mesh(bytes, Format::Glb);
    places(bytes, Format::Glb);
}

pub fn compact(bytes: &[u8]) {
    mesh(bytes, Format::Compact);
}

/// What is read is sound; what can be written of it is read again with as many triangles.
fn mesh(bytes: &[u8], format: Format) {
    let Ok(read) = parse_grouped(bytes, format) else { return };
    read.mesh.validate().expect("what is read is sound");
    let Ok(written) = print_grouped(&read, format) else { return };
    let again = parse_grouped(&written, format).unwrap_or_else(|fault| panic!("what was written is refused: {fault}"));
    assert_eq!(again.mesh.triangles.len(), read.mesh.triangles.len());
}

/// Meshes that are placed many times are sound; what is written of them is read again with as many triangles.
fn places(bytes: &[u8], format: Format) {
    let Ok(read) = parse_placed(bytes, format) else { return };
    let meshes = read.repeated.iter().map(|repeated| &repeated.grouped.mesh);
    std::iter::once(&read.alone.mesh).chain(meshes).for_each(|mesh| mesh.validate().expect("what is read is sound"));
    let Ok(written) = print_placed(&read, format) else { return };
    let again = parse_placed(&written, format).unwrap_or_else(|fault| panic!("what was written is refused: {fault}"));
    let triangles = |placed: &PlacedMeshes| {
        let of = |place: MeshPlace| placed.repeated[place.mesh as usize].grouped.mesh.triangles.len();
        placed.alone.mesh.triangles.len() + placed.places.iter().map(of).sum::<usize>()
    };
    assert_eq!(triangles(&again), triangles(&read));
}

/// What is read is written as it is read.
pub fn octree(bytes: &[u8]) {
    let Ok(octree) = Octree::from_bytes(&sums::octree(bytes)) else { return };
    let written = octree.to_bytes().expect("what is read is sound");
    let again = Octree::from_bytes(&written).expect("what was written is read");
    assert_eq!(again.to_bytes().as_ref(), Ok(&written));
}
