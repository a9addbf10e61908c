//! Small meshes of known shape, for tests.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::Mesh;

/// The corner of the unit cube: volume 1/6, facing outwards.
pub(super) fn tetrahedron() -> Mesh {
    Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..Mesh::default()
    }
}

/// The unit cube: 8 vertices, 12 triangles.
pub(super) fn cube() -> Mesh {
    let corner = |k: u8| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { vertices: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

/// The unit sphere in `m` slices and `n` stacks, with all tables: 2 m (n - 1) triangles.
pub(super) fn ball(m: u32, n: u32) -> Mesh {
    let mut mesh = Mesh { vertices: vec![DVec3::NEG_Y, DVec3::Y], ..Mesh::default() };
    for j in 1..n {
        let (across, up) = (PI * f64::from(j) / f64::from(n)).sin_cos();
        for i in 0..m {
            let (x, z) = (TAU * f64::from(i) / f64::from(m)).sin_cos();
            mesh.vertices.push(DVec3::new(x * across, -up, z * across).normalize());
        }
    }
    let vertex = |i: u32, j: u32| match j {
        0 => 0,
        j if j == n => 1,
        j => 2 + (j - 1) * m + i % m,
    };
    for j in 0..n {
        for i in 0..m {
            let quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            for corners in [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]] {
                let triangle = corners.map(|(i, j)| vertex(i, j));
                if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
                    mesh.triangles.push(triangle);
                    mesh.corner_normals.push(triangle.map(|k| mesh.vertices[k as usize]));
                    mesh.corner_parameters.push(corners.map(|(i, j)| DVec2::new(i.into(), j.into())));
                    mesh.surfaces.push(0);
                }
            }
        }
    }
    mesh
}

/// A torus of `m` by `n` quads.
pub(super) fn torus(m: u32, n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..m {
        for j in 0..n {
            let turn = |k: u32, count: u32| DVec2::from_angle(f64::from(k) / f64::from(count) * TAU);
            let (a, b) = (turn(i, m), turn(j, n));
            mesh.vertices.push(DVec3::new(a.x * (3.0 + b.x), a.y * (3.0 + b.x), b.y));
            let at = |i: u32, j: u32| i % m * n + j % n;
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
    mesh
}
