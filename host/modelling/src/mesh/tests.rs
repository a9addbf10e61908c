//! Files through every format and back, against other readers, and broken in every way.

use glam::DVec3;
use proptest::prelude::*;

use super::samples::torus;
use super::*;

const FORMATS: [(Format, &str); 6] = [
    (Format::Obj, "obj"),
    (Format::Stl, "stl"),
    (Format::Ply, "ply"),
    (Format::Gltf, "gltf"),
    (Format::Glb, "glb"),
    (Format::Compact, "cmesh"),
];

fn ball() -> Mesh {
    samples::ball(40, 20)
}

/// Positions of all corners of all triangles, in an order that does not depend on theirs.
fn sorted_triangles(mesh: &Mesh) -> Vec<[[u64; 3]; 3]> {
    let mut triangles: Vec<[[u64; 3]; 3]> = (0..mesh.triangles.len())
        .map(|triangle| {
            let mut corners = mesh.corners(triangle).map(bits);
            let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
            corners.rotate_left(least);
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn files_come_back_as_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = ball();
    for (format, extension) in FORMATS {
        let path = folder.path().join(format!("ball.{extension}"));
        write(&mesh, &destination(&path).unwrap()).unwrap();
        let back = read(&path).unwrap();
        assert!(back.is_closed(), "{extension}");
        assert_eq!((back.vertices.len(), back.triangles.len()), (mesh.vertices.len(), mesh.triangles.len()));
        match format {
            Format::Obj => assert!(Mesh { surfaces: mesh.surfaces.clone(), ..back } == mesh),
            Format::Ply => assert!(back.vertices == mesh.vertices && back.triangles == mesh.triangles),
            Format::Stl | Format::Gltf | Format::Glb => {
                let single = |p: &DVec3| p.as_vec3().as_dvec3();
                let rounded = Mesh { vertices: mesh.vertices.iter().map(single).collect(), ..mesh.clone() };
                assert!(sorted_triangles(&back) == sorted_triangles(&rounded));
            }
            Format::Compact => {
                assert!((back.signed_volume() - mesh.signed_volume()).abs() < 1e-4);
                // Every triangle comes back, each corner moved by half a step in each direction at most.
                let step = 2.0 / 65535.0;
                let whole = |p: DVec3| ((p - mesh.bounds().unwrap().min) / step).round().as_i64vec3().to_array();
                let corners = |mesh: &Mesh| {
                    let one = |t: usize| {
                        let mut corners = mesh.corners(t).map(whole);
                        let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                        corners.rotate_left(least);
                        corners
                    };
                    let mut all: Vec<_> = (0..mesh.triangles.len()).map(one).collect();
                    all.sort_unstable();
                    all
                };
                assert!(corners(&back) == corners(&mesh));
            }
        }
    }
}

#[test]
fn other_readers_understand_what_is_written() {
    let mesh = ball();
    let obj = print(&mesh, Format::Obj).unwrap();
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let (models, _) =
        tobj::load_obj_buf(&mut obj.as_slice(), &options, |_| Err(tobj::LoadError::GenericFailure)).unwrap();
    let peer = &models[0].mesh;
    assert_eq!(peer.indices.len(), mesh.triangles.len() * 3);
    for (&peer_index, &index) in peer.indices.iter().zip(mesh.triangles.as_flattened()) {
        let position = mesh.vertices[index as usize].as_vec3().to_array();
        let start = 3 * peer_index as usize;
        assert_eq!(peer.positions[start..start + 3], position);
    }

    let stl = print(&mesh, Format::Stl).unwrap();
    let peer = stl_io::read_stl(&mut std::io::Cursor::new(&stl)).unwrap();
    assert_eq!((peer.vertices.len(), peer.faces.len()), (mesh.vertices.len(), mesh.triangles.len()));

    let ply = print(&mesh, Format::Ply).unwrap();
    let parser = ply_rs_bw::parser::Parser::<ply_rs_bw::ply::DefaultElement>::new();
    let peer = parser.read_ply(&mut ply.as_slice()).unwrap();
    assert_eq!(peer.payload["vertex"].len(), mesh.vertices.len());
    assert_eq!(peer.payload["face"].len(), mesh.triangles.len());
}

#[test]
fn unknown_extensions_missing_files_and_faults_are_told_with_the_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(matches!(read(path("a.dxf")), Err(MeshError::Format { .. })));
    assert!(matches!(read(path("a.obj")), Err(MeshError::File { .. })));
    std::fs::write(path("a.OBJ"), "v 0 0 0\nf 1 2 3\n").unwrap();
    let message = read(path("a.OBJ")).unwrap_err().to_string();
    assert!(message.ends_with("a.OBJ: line 2: index 2 is outside the 1 vertices"), "{message}");
    let broken = Mesh { vertices: vec![DVec3::NAN], ..Mesh::default() };
    assert!(matches!(write(&broken, &destination(path("b.obj")).unwrap()), Err(MeshError::Content { .. })));
}

#[test]
fn the_compact_form_refuses_what_it_cannot_hold() {
    let mut open = ball();
    open.triangles.pop();
    open.corner_normals.clear();
    open.corner_parameters.clear();
    open.surfaces.clear();
    assert!(matches!(print(&open, Format::Compact).unwrap_err().problem, MeshProblem::Unsuited(_)));
    let torus = torus(12, 8);
    assert!(torus.is_closed() && torus.edge_report().euler_characteristic() == 0);
    assert!(matches!(print(&torus, Format::Compact).unwrap_err().problem, MeshProblem::Unsuited(_)));
    // Two pieces are no hindrance.
    let mut two = ball();
    two.append(&ball().transformed(&glam::DAffine3::from_translation(DVec3::X * 5.0)), 1);
    let back = parse(&print(&two, Format::Compact).unwrap(), Format::Compact).unwrap();
    assert_eq!(back.edge_report().euler_characteristic(), 4);
}

#[test]
fn the_compact_form_of_the_smallest_meshes_can_be_read() {
    for size in [5e-324, 1e-323, 3.1e-319, 1e-310] {
        let mut small = super::samples::tetrahedron();
        small.vertices.iter_mut().for_each(|vertex| *vertex *= size);
        let back = parse(&print(&small, Format::Compact).unwrap(), Format::Compact);
        assert_eq!(back.map(|mesh| mesh.triangles.len()), Ok(4), "{size}");
    }
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn the_bunny_is_closed_and_faces_outwards() {
    let mesh = bunny().expect("it ships");
    let report = mesh.edge_report();
    assert_eq!((report.vertices, report.triangles, report.edges), (34_835, 69_666, 104_499));
    assert!(report.is_closed() && report.collapsed + report.degenerate == 0);
    assert_eq!(report.euler_characteristic(), 2);
    assert!((mesh.signed_volume() - 1.5998).abs() < 1e-4);
    let bounds = mesh.bounds().unwrap();
    assert!((bounds.size() - DVec3::new(2.0, 1.982_466, 1.550_094)).abs().max_element() < 1e-4);
}

/// A small file of each format, by name.
fn small_files() -> Vec<(Format, Vec<u8>)> {
    let mesh = samples::ball(6, 4);
    let mut files: Vec<_> = FORMATS.iter().map(|&(format, _)| (format, print(&mesh, format).unwrap())).collect();
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    files.push((Format::Ply, text.into()));
    let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    files.push((Format::Stl, text.into()));
    files
}

#[test]
fn truncated_files_are_refused_or_understood_but_never_panic() {
    for (format, bytes) in small_files() {
        for length in 0..bytes.len() {
            match parse(&bytes[..length], format) {
                Ok(mesh) => assert!(mesh.validate().is_ok()),
                Err(fault) => assert!(!fault.to_string().is_empty()),
            }
        }
        assert!(parse(&bytes, format).is_ok());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_files_never_panic_and_what_is_read_is_valid(
        which in 0usize..6,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..3), 1..8),
    ) {
        let (format, mut bytes) = small_files().swap_remove(which);
        for (place, value, kind) in edits {
            let place = place.index(bytes.len());
            match kind {
                0 => bytes[place] = value,
                1 => bytes.insert(place, value),
                _ => { bytes.remove(place); }
            }
        }
        if let Ok(mesh) = parse(&bytes, format) {
            prop_assert!(mesh.validate().is_ok());
            // Nothing is made out of nothing: a triangle takes at least a bit, a vertex too.
            prop_assert!(mesh.triangles.len() <= bytes.len() * 8 && mesh.vertices.capacity() <= bytes.len() * 16);
            mesh.edge_report();
        }
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..300), which in 0usize..4) {
        let head: &[u8] = [b"".as_slice(), b"solid x\n", b"ply\nformat binary_big_endian 1.0\nelement vertex 9\n", b"PERIScm1"][which];
        let noisy = [head, &bytes].concat();
        for (format, _) in FORMATS {
            let _ = parse(&noisy, format);
        }
    }
}

#[test]
#[cfg(not(feature = "bunny"))]
fn a_program_without_the_bunny_says_which_feature_it_lacks() {
    assert!(bunny().expect_err("it was left out").to_string().contains("feature `bunny`"));
}
