//! glTF files by hand, through both forms and back, and broken in every way.

use super::super::samples::{ball, tetrahedron};
use super::super::{
    Format, Grouped, Mesh, MeshProblem, MetallicRoughness, parse_grouped, print, print_grouped, read_grouped,
};
use super::*;
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

/// A file with one buffer in itself and the rest as given.
pub(super) fn file(binary: &[u8], rest: Value) -> Vec<u8> {
    let uri = format!("data:application/octet-stream;base64,{}", base64::encode(binary));
    let mut document = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "buffers": [{ "byteLength": binary.len(), "uri": uri }],
        "bufferViews": [{ "buffer": 0, "byteLength": binary.len() }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
    });
    for (key, value) in rest.as_object().expect("members") {
        document[key] = value.clone();
    }
    document.to_string().into_bytes()
}

pub(super) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Three corners of a triangle.
pub(super) fn triangle() -> Vec<u8> {
    floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
}

fn parsed(bytes: &[u8]) -> Mesh {
    parse_grouped(bytes, Format::Gltf).unwrap_or_else(|fault| panic!("{fault}")).mesh
}

fn refused(binary: &[u8], rest: Value) -> String {
    parse_grouped(&file(binary, rest), Format::Gltf).expect_err("wrong").to_string()
}

#[test]
fn both_forms_keep_triangles_normals_parameters_and_groups() {
    let mut mesh = ball(12, 8);
    mesh.surfaces = (0..mesh.triangles.len() as u32).map(|k| k % 3).collect();
    let names = vec!["front".to_owned(), "back side".to_owned()];
    let looks =
        vec![None, Some(MetallicRoughness { base: DVec3::new(0.5, 0.25, 1.0), metallic: 0.125, roughness: 0.75 })];
    let grouped = Grouped { mesh: mesh.clone(), names, materials: looks };
    for format in [Format::Gltf, Format::Glb] {
        let back = parse_grouped(&print_grouped(&grouped, format).unwrap(), format).unwrap();
        assert_eq!(back.names, ["front", "back side", "surface 2"]);
        assert_eq!(back.materials, [None, grouped.materials[1], None]);
        assert!(back.mesh.is_closed());
        let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
        order.sort_by_key(|k| mesh.surfaces[*k]);
        for (new, old) in order.into_iter().enumerate() {
            assert_eq!(back.mesh.surfaces[new], mesh.surfaces[old]);
            let gaps = (0..3).map(|k| {
                back.mesh.corners(new)[k].distance(mesh.corners(old)[k])
                    + back.mesh.corner_normals[new][k].distance(mesh.corner_normals[old][k])
                    + back.mesh.corner_parameters[new][k].distance(mesh.corner_parameters[old][k])
            });
            assert!(gaps.fold(0.0, f64::max) < 1e-6);
        }
    }
}

#[test]
fn strips_fans_and_all_components_are_read() {
    // Positions as normalized shorts, interleaved with bytes that are normals; indices as bytes.
    let mut binary: Vec<u8> = Vec::new();
    for [x, y] in [[0_i16, 0], [32767, 0], [0, 32767], [32767, 32767]] {
        [x, y, 0].iter().for_each(|c| binary.extend_from_slice(&c.to_le_bytes()));
        binary.extend_from_slice(&[0, 0, 0, 0, 127, 0]);
    }
    binary.extend_from_slice(&[0, 1, 2, 3]);
    let rest = |mode: u32, order: [u8; 4]| {
        let mut binary = binary.clone();
        binary[48..].copy_from_slice(&order);
        let document = json!({
            "extensionsRequired": ["KHR_mesh_quantization"],
            "bufferViews": [{ "buffer": 0, "byteLength": 48, "byteStride": 12 }, { "buffer": 0, "byteOffset": 48, "byteLength": 4 }],
            "accessors": [
                { "bufferView": 0, "componentType": 5122, "normalized": true, "count": 4, "type": "VEC3" },
                { "bufferView": 0, "byteOffset": 8, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3" },
                { "bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR" },
            ],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2, "mode": mode }] }],
        });
        parsed(&file(&binary, document))
    };
    for mesh in [rest(5, [0, 1, 2, 3]), rest(6, [0, 1, 3, 2])] {
        assert_eq!(mesh.triangles.len(), 2);
        assert!((0..2).all(|t| mesh.area_vector(t) == DVec3::Z * 0.5), "{:?}", mesh.triangles);
        assert!(mesh.corner_normals.iter().flatten().all(|n| *n == DVec3::Z));
    }
}

#[test]
fn sparse_tables_and_placed_nodes_are_read() {
    let mut binary = triangle();
    binary.extend_from_slice(&1_u16.to_le_bytes());
    binary.extend_from_slice(&[0; 2]);
    binary.extend(floats(&[3.0, 0.0, 0.0]));
    let quarter = 0.5_f64.sqrt();
    let mesh = parsed(&file(
        &binary,
        json!({
            "bufferViews": [
                { "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 2 },
                { "buffer": 0, "byteOffset": 40, "byteLength": 12 },
            ],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
                "count": 1, "indices": { "bufferView": 1, "componentType": 5123 }, "values": { "bufferView": 2 } } }],
            "nodes": [
                { "children": [1, 2], "scale": [2, 2, 2] },
                { "mesh": 0, "name": "one", "rotation": [0, 0, quarter, quarter], "translation": [1, 0, 0] },
                { "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1] },
            ],
        }),
    ));
    let near = |found: [DVec3; 3], expected: [[f64; 3]; 3]| {
        found.iter().zip(expected).all(|(a, b)| a.distance(DVec3::from_array(b)) < 1e-14)
    };
    assert!(near(mesh.corners(0), [[2.0, 0.0, 0.0], [2.0, 6.0, 0.0], [0.0, 0.0, 0.0]]), "{:?}", mesh.corners(0));
    // Mirrored: reversed, so that the outside stays outside.
    assert!(near(mesh.corners(1), [[0.0, 0.0, 10.0], [0.0, 2.0, 10.0], [-6.0, 0.0, 10.0]]), "{:?}", mesh.corners(1));
    assert_eq!(mesh.surfaces, [0, 1]);
}

#[test]
fn buffers_may_lie_beside_the_file_but_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::write(folder.path().join("b c.bin"), triangle()).unwrap();
    let write = |uri: &str| {
        std::fs::write(
            &path,
            file(
                &[],
                json!({ "buffers": [{ "byteLength": 36, "uri": uri }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }] }),
            ),
        )
        .unwrap();
        read_grouped(&path)
    };
    assert_eq!(write("b%20c.bin").unwrap().mesh.triangles.len(), 1);
    let message = write("c.bin").unwrap_err().to_string();
    assert!(message.contains("a.gltf: buffers[0].uri: cannot read c.bin"), "{message}");
    for elsewhere in ["../b%20c.bin", "%2e%2e/x", "/etc/passwd", "http://x/y", "C:\\x"] {
        let message = write(elsewhere).unwrap_err().to_string();
        assert!(message.contains("buffers[0].uri: expected a file beside this one"), "{message}");
    }
}

#[test]
fn faults_name_the_place_in_the_document() {
    assert_eq!(
        refused(&triangle(), json!({ "asset": { "version": "1.0" } })),
        "asset.version: expected version 2, found `\"1.0\"`"
    );
    assert_eq!(refused(&triangle(), json!({ "scene": 1 })), "scene: index 1 is outside the 1 scenes");
    assert_eq!(refused(&triangle()[..20], json!({})), "accessors[0]: reaches beyond the 20 bytes there are");
    assert_eq!(
        refused(&triangle(), json!({ "bufferViews": [{ "buffer": 0, "byteOffset": 4, "byteLength": 36 }] })),
        "bufferViews[0]: reaches beyond the 36 bytes there are"
    );
    assert_eq!(
        refused(&triangle(), json!({ "bufferViews": [{ "buffer": 2, "byteLength": 36 }] })),
        "bufferViews[0].buffer: index 2 is outside the 1 buffers"
    );
    let accessor = |change: Value| {
        let mut accessor = json!({ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" });
        change.as_object().unwrap().iter().for_each(|(key, value)| accessor[key] = value.clone());
        refused(&triangle(), json!({ "accessors": [accessor] }))
    };
    assert!(accessor(json!({ "count": u64::MAX })).starts_with("accessors[0].count: 18446744073709551615 rows"));
    assert!(
        accessor(json!({ "count": 1e9 as u64, "bufferView": null })).starts_with("accessors[0].count: 1000000000 rows")
    );
    assert!(accessor(json!({ "componentType": 5124 })).starts_with("accessors[0].componentType: expected a component"));
    assert_eq!(accessor(json!({ "type": "VEC2" })), "accessors[0].type: expected VEC3, found `\"VEC2\"`");
    assert!(accessor(json!({ "byteOffset": u64::MAX })).starts_with("accessors[0]: reaches beyond"));
    assert_eq!(
        refused(&triangle(), json!({ "nodes": [{ "children": [1] }, { "children": [0] }] })),
        "nodes[1].children[0]: expected a node that is reached only once, found `0`"
    );
    assert_eq!(
        refused(&triangle(), json!({ "nodes": [{ "mesh": 0, "scale": [1, 2] }] })),
        "nodes[0].scale: expected 3 finite numbers"
    );
    assert!(
        refused(&triangle(), json!({ "extensionsRequired": ["KHR_draco_mesh_compression"] }))
            .starts_with("extensionsRequired[0]: expected no extension that changes meshes")
    );
    let nan = floats(&[0.0, 0.0, f32::NAN, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    assert_eq!(refused(&nan, json!({})), "meshes[0].primitives[0].attributes.POSITION: a coordinate is not finite");
    assert!(parse_grouped(b"{\n \"asset\": }", Format::Gltf).unwrap_err().to_string().starts_with("line 2: "));
}

#[test]
fn small_files_do_not_become_huge_meshes() {
    let nodes: Vec<Value> = (0..200_000).map(|_| json!({ "mesh": 0 })).collect();
    let names: Vec<usize> = (0..200_000).collect();
    let mut binary = triangle();
    binary.extend((0..30_000).map(|_| 0));
    let rest = json!({
        "nodes": nodes, "scenes": [{ "nodes": names }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 30_000 }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5121, "count": 30_000, "type": "SCALAR" },
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
    });
    assert!(refused(&binary, rest).starts_with("meshes[0]: "));
}

#[test]
fn broken_binary_files_are_refused() {
    let whole = print(&tetrahedron(), Format::Glb).unwrap();
    assert_eq!(parse_grouped(&whole, Format::Glb).unwrap().mesh, tetrahedron().welded());
    for length in 0..whole.len() {
        assert!(parse_grouped(&whole[..length], Format::Glb).is_err(), "{length}");
    }
    for at in 0..whole.len() {
        for flip in [1, 0x80, 0xFF] {
            let mut broken = whole.clone();
            broken[at] ^= flip;
            // Whatever comes of it, it is a mesh or a fault.
            if let Ok(grouped) = parse_grouped(&broken, Format::Glb) {
                grouped.mesh.validate().unwrap();
            }
        }
    }
}

#[test]
fn corners_without_a_normal_are_written_with_that_of_their_triangle() {
    let mut mesh = tetrahedron();
    mesh.corner_normals = vec![[DVec3::ZERO; 3]; mesh.triangles.len()];
    mesh.corner_parameters = vec![[DVec2::ZERO; 3]; mesh.triangles.len()];
    let back = parse_grouped(&print(&mesh, Format::Gltf).unwrap(), Format::Gltf).unwrap().mesh;
    assert!((0..4).all(|t| back.corner_normals[t][0].dot(mesh.face_normal(t).unwrap()) > 0.999));
    let far = tetrahedron().transformed(&glam::DAffine3::from_scale(DVec3::splat(1e300)));
    assert!(matches!(print(&far, Format::Glb).unwrap_err().problem, MeshProblem::Range { .. }));
}
