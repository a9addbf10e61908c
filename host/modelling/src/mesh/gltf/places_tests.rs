//! Meshes that nodes and the extension for instances place many times: where they are, and what cannot be.

use super::super::samples::{ball, tetrahedron};
use super::super::{
    Format, Mesh, MeshPlace, MeshPlaces, PlacedMeshes, RepeatedMesh, parse_grouped, parse_placed, print_placed,
};
use super::tests::{file, floats, triangle};
use super::written_nodes::MOST_NODES;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::{Value, json};

fn placed(bytes: &[u8]) -> PlacedMeshes {
    let placed = parse_placed(bytes, Format::Gltf).unwrap_or_else(|fault| panic!("{fault}"));
    let together = parse_grouped(bytes, Format::Gltf).unwrap_or_else(|fault| panic!("{fault}")).mesh;
    assert_same_triangles(&copied(&placed), &together);
    placed
}

fn refused(binary: &[u8], rest: Value) -> String {
    let bytes = file(binary, rest);
    let fault = parse_placed(&bytes, Format::Gltf).expect_err("wrong").to_string();
    assert_eq!(parse_grouped(&bytes, Format::Gltf).expect_err("wrong too").to_string(), fault);
    fault
}

/// All triangles where they are.
fn copied(placed: &PlacedMeshes) -> Mesh {
    let mut whole = Mesh { corner_normals: Vec::new(), ..placed.alone.mesh.clone() };
    for MeshPlace { mesh, placement } in placed.places.iter() {
        whole.append(&placed.repeated[mesh as usize].grouped.mesh.transformed(&placement), 0);
    }
    whole
}

/// Whether two meshes have the same triangles, in whatever order.
fn assert_same_triangles(one: &Mesh, other: &Mesh) {
    let sorted = |mesh: &Mesh| {
        let mut all: Vec<[[i64; 3]; 3]> = (0..mesh.triangles.len())
            .map(|triangle| mesh.corners(triangle).map(|p| (p * 1e6).round().as_i64vec3().to_array()))
            .collect();
        all.sort_unstable();
        all
    };
    assert_eq!(sorted(one), sorted(other));
}

/// Row after row of a translation, three numbers of a rotation and its fourth, as the accessors below name them.
fn rows(translations: &[[f32; 3]], rotations: &[[i16; 4]], scales: &[[f32; 3]]) -> (Vec<u8>, Value) {
    let mut binary = triangle();
    let mut views = vec![json!({ "buffer": 0, "byteLength": 36 })];
    let mut add = |bytes: Vec<u8>| {
        views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() }));
        binary.extend(bytes);
    };
    add(floats(translations.as_flattened()));
    add(rotations.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect());
    add(floats(scales.as_flattened()));
    let rest = json!({
        "bufferViews": views,
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5126, "count": translations.len(), "type": "VEC3" },
            { "bufferView": 2, "componentType": 5122, "normalized": true, "count": rotations.len(), "type": "VEC4" },
            { "bufferView": 3, "componentType": 5126, "count": scales.len(), "type": "VEC3" },
        ],
        "extensionsRequired": ["EXT_mesh_gpu_instancing"],
        "nodes": [instanced(json!({ "TRANSLATION": 1, "ROTATION": 2, "SCALE": 3, "_ID": 1 }), json!({}))],
    });
    (binary, rest)
}

/// A node that has its mesh by the extension.
fn instanced(attributes: Value, more: Value) -> Value {
    let mut node = json!({ "mesh": 0, "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } } });
    more.as_object().unwrap().iter().for_each(|(key, value)| node[key] = value.clone());
    node
}

#[test]
fn a_mesh_of_many_nodes_is_there_once_and_one_of_one_node_stands_where_it_is() {
    let file = file(
        &triangle(),
        json!({
            "meshes": [
                { "name": "leaf", "primitives": [{ "attributes": { "POSITION": 0 } }] },
                { "name": "trunk", "primitives": [{ "attributes": { "POSITION": 0 } }] },
            ],
            "scenes": [{ "nodes": [0, 4] }],
            "nodes": [
                { "children": [1, 2, 3], "scale": [2, 1, 1], "translation": [0, 0, 1] },
                // Skewed by the scale above it, mirrored, and far away.
                { "mesh": 0, "rotation": [0, 0, 0.5_f64.sqrt(), 0.5_f64.sqrt()], "translation": [1, 0, 0] },
                { "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1] },
                { "mesh": 0, "rotation": [0, 0, (22.5_f64).to_radians().sin(), (22.5_f64).to_radians().cos()] },
                { "mesh": 1, "translation": [0, 7, 0] },
            ],
        }),
    );
    let placed = placed(&file);
    assert_eq!((placed.repeated.len(), placed.repeated[0].name.as_str(), placed.places.count()), (1, "leaf", 3));
    assert_eq!((placed.alone.mesh.triangles.len(), placed.alone.names.as_slice()), (1, &["trunk".to_owned()][..]));
    assert_eq!(placed.alone.mesh.bounds().unwrap().min, DVec3::new(0.0, 7.0, 0.0));
    let outer = DAffine3::from_scale_rotation_translation(DVec3::new(2.0, 1.0, 1.0), DQuat::IDENTITY, DVec3::Z);
    let quarter = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let mirror = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), translation: DVec3::Z * 5.0 };
    let expected = [
        outer * DAffine3::from_rotation_translation(quarter, DVec3::X),
        outer * mirror,
        outer * DAffine3::from_quat(DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4)),
    ];
    for (found, expected) in placed.places.iter().zip(expected) {
        assert!(found.placement.abs_diff_eq(expected, 1e-14), "{found:?}");
    }
}

#[test]
fn the_extension_places_by_rows_below_its_node_and_fills_in_what_is_not_told() {
    let (binary, rest) =
        rows(&[[1.0, 2.0, 3.0], [0.0; 3]], &[[0, 0, 0, 32767], [0, 0, 23170, 23170]], &[[1.0; 3], [2.0, -3.0, 4.0]]);
    let two = placed(&file(&binary, rest.clone()));
    assert!(two.alone.mesh.triangles.is_empty() && two.repeated.len() == 1);
    let quarter = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let second = DAffine3::from_scale_rotation_translation(DVec3::new(2.0, -3.0, 4.0), quarter, DVec3::ZERO);
    let found: Vec<DAffine3> = two.places.iter().map(|place| place.placement).collect();
    assert_eq!(found[0], DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0)));
    assert!(found[1].abs_diff_eq(second, 1e-9), "{:?}", found[1]);
    // Below nodes, beside a node without the extension; then with scales alone, and with nothing but other tables.
    let with = |attributes: Value| {
        let mut rest = rest.clone();
        rest["nodes"] = json!([
            { "children": [1], "scale": [1, -1, 1] }, instanced(attributes, json!({ "translation": [0, 5, 0] })),
            { "mesh": 0 },
        ]);
        rest["scenes"] = json!([{ "nodes": [0, 2] }]);
        placed(&file(&binary, rest)).places
    };
    let at = |places: &MeshPlaces, number: usize| places.place(number).placement.transform_point3(DVec3::ONE);
    let all = with(json!({ "TRANSLATION": 1 }));
    assert_eq!([0, 1, 2].map(|n| at(&all, n)), [DVec3::ONE, DVec3::new(2.0, -8.0, 4.0), DVec3::new(1.0, -6.0, 1.0)]);
    assert_eq!(at(&with(json!({ "SCALE": 3 })), 2), DVec3::new(2.0, -2.0, 4.0));
    assert_eq!(with(json!({ "_ID": 1 })).count(), 3);
}

#[test]
fn flat_placements_are_copied_and_zero_scales_leave_nothing() {
    let (binary, rest) = rows(
        &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
        &[[0, 0, 0, 32767]; 4],
        &[[1.0; 3], [0.0; 3], [1.0, 1.0, 0.0], [2.0; 3]],
    );
    let found = placed(&file(&binary, rest));
    assert_eq!((found.places.count(), found.alone.mesh.triangles.len()), (2, 1));
    assert_eq!(found.alone.mesh.corners(0)[0], DVec3::X * 2.0);
    assert_eq!(found.places.place(1).placement.translation, DVec3::X * 3.0);
    let nodes = json!([{ "mesh": 0 }, { "mesh": 0, "scale": [0, 0, 0] }, { "mesh": 0, "scale": [1, 0, 1] }]);
    let once = placed(&file(&triangle(), json!({ "nodes": nodes, "scenes": [{ "nodes": [0, 1, 2] }] })));
    assert_eq!((once.places.count(), once.alone.mesh.triangles.len()), (0, 2), "one solid place is no repetition");
}

#[test]
fn faults_of_instances_name_the_node_and_the_row() {
    let attributes = "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes";
    let one = [[0.0; 3]; 2];
    let turned = [[0, 0, 0, 32767]; 2];
    let of = |translations: &[[f32; 3]], rotations: &[[i16; 4]], scales: &[[f32; 3]]| {
        let (binary, rest) = rows(translations, rotations, scales);
        refused(&binary, rest)
    };
    assert_eq!(of(&one, &turned[..1], &one), format!("{attributes}.ROTATION: 1 rows, where the other tables have 2"));
    assert_eq!(of(&one, &[[0; 4]; 2], &one), format!("{attributes}.ROTATION: row 0: expected a unit quaternion"));
    assert_eq!(
        of(&[[0.0; 3], [0.0, f32::NAN, 0.0]], &turned, &one),
        format!("{attributes}.TRANSLATION: row 1: a coordinate is not finite")
    );
    let (binary, rest) = rows(&one, &turned, &one);
    let with = |key: &str, value: Value| {
        let mut rest = rest.clone();
        rest[key] = value;
        refused(&binary, rest)
    };
    let named = |table: usize| json!([instanced(json!({ "TRANSLATION": table }), json!({}))]);
    assert_eq!(with("nodes", named(9)), format!("{attributes}.TRANSLATION: index 9 is outside the 4 accessors"));
    assert_eq!(with("nodes", named(2)), "accessors[2].type: expected VEC3, found `\"VEC4\"`");
    assert_eq!(
        with("nodes", json!([instanced(json!({ "SCALE": 3 }), json!({ "scale": [1e300, 1, 1], "mesh": 7 }))])),
        "nodes[0].mesh: index 7 is outside the 1 meshes"
    );
    assert_eq!(
        with("nodes", json!([instanced(json!({}), json!({}))])),
        format!("{attributes}: expected a table, found `{{}}`")
    );
    assert!(with("bufferViews", json!([{ "buffer": 0, "byteLength": 36 }])).contains("bufferViews"));
    let far = json!([{ "children": [1], "scale": [1e200, 1, 1] }, { "mesh": 0, "scale": [1e200, 1, 1] }]);
    assert_eq!(refused(&triangle(), json!({ "nodes": far })), "nodes[1]: a coordinate is not finite");
    assert_eq!(
        refused(&triangle(), json!({ "nodes": [{ "mesh": 0, "rotation": [0, 0, 0, 0] }] })),
        "nodes[0].rotation: expected a unit quaternion, found `[0,0,0,0]`"
    );
}

#[test]
fn chains_of_nodes_may_be_as_deep_as_they_like_but_no_circles() {
    const DEPTH: usize = 50_000;
    let mut nodes: Vec<Value> =
        (1..=DEPTH).map(|next| json!({ "children": [next], "translation": [1, 0, 0] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    let deep = placed(&file(&triangle(), json!({ "nodes": nodes })));
    assert_eq!(deep.alone.mesh.bounds().unwrap().min.x, DEPTH as f64);
    nodes[DEPTH]["children"] = json!([17]);
    let fault = refused(&triangle(), json!({ "nodes": nodes }));
    assert_eq!(fault, "nodes[50000].children[0]: expected a node that is reached only once, found `17`");
}

#[test]
fn a_mesh_that_small_files_place_often_is_read_once() {
    const TABLE: usize = 30_000;
    let mut binary = triangle();
    binary.extend((0..TABLE).map(|corner| (corner % 3) as u8));
    let nodes: Vec<Value> = (0..20_000).map(|k| json!({ "mesh": 0, "translation": [k, 0, 0] })).collect();
    let names: Vec<usize> = (0..nodes.len()).collect();
    let rest = json!({
        "nodes": nodes, "scenes": [{ "nodes": names }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": TABLE }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5121, "count": TABLE, "type": "SCALAR" },
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
    });
    let found = parse_placed(&file(&binary, rest), Format::Gltf).unwrap();
    assert_eq!((found.repeated[0].grouped.mesh.triangles.len(), found.places.count()), (TABLE / 3, 20_000));
    assert!(found.alone.mesh.triangles.is_empty());
}

/// Two meshes at some places, and one that stands alone.
fn some_places(count: usize, skewed: bool) -> PlacedMeshes {
    // Of numbers that single precision holds.
    let mesh = |name: &str, mut mesh: Mesh| {
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = vertex.as_vec3().as_dvec3());
        RepeatedMesh { name: name.into(), grouped: mesh.welded().into() }
    };
    let mut placed = PlacedMeshes {
        alone: tetrahedron().welded().into(),
        repeated: vec![mesh("ball", ball(8, 4)), mesh("", tetrahedron())],
        places: MeshPlaces::default(),
    };
    for number in 0..count {
        let x = number as f64;
        let rotation = DQuat::from_axis_angle(DVec3::new(1.0, x, -2.0).normalize(), 0.1 * x);
        let scale = DVec3::new(1.0, 1.5, if number % 3 == 0 { -2.0 } else { 0.25 });
        let mut placement = DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::new(x, -0.5 * x, 3.0));
        if skewed {
            placement.matrix3 = DMat3::from_diagonal(DVec3::new(1.0, 3.0, 1.0)) * placement.matrix3;
        }
        placed.places.push(MeshPlace { mesh: (number % 2) as u32, placement });
    }
    placed
}

#[test]
fn places_are_written_as_nodes_and_read_as_they_were() {
    for format in [Format::Gltf, Format::Glb] {
        let even = some_places(20, false);
        let back = parse_placed(&print_placed(&even, format).unwrap(), format).unwrap();
        let exact = |of: &PlacedMeshes| of.places.iter().collect::<Vec<MeshPlace>>();
        assert_eq!(exact(&back), exact(&even), "to the last bit");
        assert_eq!(back.repeated[0].name, "ball");
        assert_same_triangles(&copied(&back), &copied(&even));
        let skewed = some_places(20, true);
        let back = parse_placed(&print_placed(&skewed, format).unwrap(), format).unwrap();
        for (found, expected) in back.places.iter().zip(skewed.places.iter()) {
            assert!(found.placement.abs_diff_eq(expected.placement, 1e-12));
        }
        assert_eq!(back.places.count(), 20);
    }
}

#[test]
fn many_places_are_written_as_rows_but_skewed_ones_as_nodes() {
    let mut many = some_places(2 * MOST_NODES + 20, false);
    many.places.push(some_places(2, true).places.place(1));
    let bytes = print_placed(&many, Format::Glb).unwrap();
    assert!(bytes.len() < 2 << 20, "{} bytes", bytes.len());
    let back = parse_placed(&bytes, Format::Glb).unwrap();
    let of_mesh = |placed: &PlacedMeshes, mesh: u32| {
        placed.places.iter().filter(|place| place.mesh == mesh).map(|place| place.placement).collect::<Vec<_>>()
    };
    // The skewed one was the last, and comes first now; so does its mesh.
    assert_eq!(back.repeated[1].name, "ball");
    for (mesh, turned) in [(0, 0), (1, 1)] {
        let mut expected = of_mesh(&many, mesh);
        expected.rotate_right(turned);
        let found = of_mesh(&back, 1 - mesh);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert!(found.matrix3.abs_diff_eq(expected.matrix3, 2e-6));
            assert!(found.translation.distance(expected.translation) <= 2e-7 * expected.translation.length());
        }
    }
    assert!(String::from_utf8_lossy(&bytes[..200_000]).contains("extensionsRequired"));
}

#[test]
fn what_cannot_be_written_is_told() {
    let mut placed = some_places(2, false);
    assert_eq!(print_placed(&placed, Format::Ply).unwrap_err().to_string(), "mesh: only glTF files place meshes");
    placed.places.push(MeshPlace { mesh: 5, placement: DAffine3::IDENTITY });
    assert_eq!(print_placed(&placed, Format::Glb).unwrap_err().to_string(), "mesh: index 5 is outside the 2 meshes");
    let mut placed = some_places(1, false);
    placed.places.push(MeshPlace { mesh: 0, placement: DAffine3::from_translation(DVec3::NAN) });
    assert_eq!(print_placed(&placed, Format::Glb).unwrap_err().to_string(), "mesh: row 1: a place is not finite");
    assert_eq!(
        print_placed(&PlacedMeshes::default(), Format::Glb).unwrap_err().to_string(),
        "mesh: holds no triangles"
    );
}

#[test]
fn a_mesh_without_normals_has_flat_faces_and_others_keep_theirs() {
    let mut binary = triangle();
    binary.extend(floats(&[0.0, 0.6, 0.8].repeat(3)));
    let read = |second: Value| {
        let bytes = file(
            &binary,
            json!({
                "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 36 }],
                "accessors": [
                    { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
                    { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3" },
                ],
                "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }, { "attributes": second }] }],
            }),
        );
        parse_grouped(&bytes, Format::Gltf).unwrap().mesh.corner_normals
    };
    let normals = read(json!({ "POSITION": 0, "NORMAL": 1 }));
    assert_eq!(normals[0], [DVec3::Z; 3]);
    assert!(normals[1].iter().all(|normal| normal.distance(DVec3::new(0.0, 0.6, 0.8)) < 1e-7));
    assert!(read(json!({ "POSITION": 0 })).is_empty());
}
