//! Meshes that the benchmark makes itself, and one that it is given as a file.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::DVec3;

/// Vertices and triangles under a name.
pub struct Shape {
    /// What it is called in the tables.
    pub name: String,
    /// Positions; each is exact in single precision, so that all rivals see the same mesh.
    pub vertices: Vec<DVec3>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// A named mesh; positions are rounded to single precision.
    pub fn new(name: &str, vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Self {
        let vertices = vertices.into_iter().map(|p| p.as_vec3().as_dvec3()).collect();
        Self { name: format!("{name} {}k", triangles.len().div_ceil(1000)), vertices, triangles }
    }

    /// Centre and radius of a sphere around the shape.
    pub fn bounds(&self) -> (DVec3, f64) {
        let low = self.vertices.iter().fold(DVec3::INFINITY, |a, &p| a.min(p));
        let high = self.vertices.iter().fold(DVec3::NEG_INFINITY, |a, &p| a.max(p));
        ((low + high) * 0.5, (high - low).length() * 0.5)
    }
}

/// A grid of `around` by `along` cells, closed in both directions, as two triangles a cell.
fn grid(around: u32, along: u32, point: impl Fn(f64, f64) -> DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let at = |i: u32, j: u32| (i % around) * along + j % along;
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..around {
        for j in 0..along {
            vertices.push(point(f64::from(i) / f64::from(around) * TAU, f64::from(j) / f64::from(along) * TAU));
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, triangles)
}

/// A torus with about a number of triangles.
pub fn torus(triangles: f64) -> Shape {
    let along = (triangles / 6.0).sqrt() as u32;
    let (vertices, triangles) = grid(3 * along, along, |u, v| {
        let ring = 1.0 + 0.4 * v.cos();
        DVec3::new(ring * u.cos(), 0.4 * v.sin(), ring * u.sin())
    });
    Shape::new("torus", vertices, triangles)
}

/// A sphere by repeated division of an icosahedron: 20 * 4^`divisions` triangles.
pub fn sphere(divisions: u32) -> Shape {
    let (vertices, triangles) = icosphere(divisions);
    Shape::new("sphere", vertices, triangles)
}

/// A sphere with bumps of many sizes, somewhat like a scanned figure.
pub fn bumpy(divisions: u32) -> Shape {
    let (vertices, triangles) = icosphere(divisions);
    let height = |p: DVec3| {
        let mut sum = 1.0;
        let (mut amplitude, mut frequency) = (0.25, 3.0);
        for octave in 0..6 {
            let q = p * frequency + DVec3::splat(f64::from(octave) * 1.7);
            sum += amplitude * q.x.sin() * (q.y * 1.1).sin() * (q.z * 0.9).cos();
            amplitude *= 0.5;
            frequency *= 2.1;
        }
        sum
    };
    Shape::new("bumpy", vertices.into_iter().map(|p| p * height(p)).collect(), triangles)
}

fn icosphere(divisions: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices = Vec::new();
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        vertices.push(DVec3::new(a, b, 0.0).normalize());
    }
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        vertices.push(DVec3::new(0.0, a, b).normalize());
    }
    for (a, b) in [(golden, -1.0), (golden, 1.0), (-golden, -1.0), (-golden, 1.0)] {
        vertices.push(DVec3::new(a, 0.0, b).normalize());
    }
    // Three vertices make a face where all are neighbours: at the least distance from each other.
    let near = |i: usize, j: usize, v: &[DVec3]| v[i].distance_squared(v[j]) < 1.2;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j, &vertices) && near(j, k, &vertices) && near(i, k, &vertices) {
                    let outward = (vertices[j] - vertices[i]).cross(vertices[k] - vertices[i]).dot(vertices[i]) > 0.0;
                    let [j, k] = if outward { [j, k] } else { [k, j] };
                    triangles.push([i as u32, j as u32, k as u32]);
                }
            }
        }
    }
    for _ in 0..divisions {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    (vertices, triangles)
}

/// A mesh from an OBJ file: `v` and `f` lines, polygons as fans, the rest ignored.
///
/// # Errors
/// What is wrong, with the line.
pub fn obj(path: &str) -> Result<Shape, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for (line, content) in text.lines().enumerate() {
        let mut words = content.split_whitespace();
        let wrong = || format!("line {}: {content}", line + 1);
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
                let [x, y, z, ..] = numbers[..] else { return Err(wrong()) };
                vertices.push(DVec3::new(x, y, z));
            }
            Some("f") => {
                let index = |word: &str| match word.split('/').next()?.parse::<i64>().ok()? {
                    i if i > 0 => u32::try_from(i - 1).ok(),
                    i => u32::try_from(vertices.len() as i64 + i).ok(),
                };
                let corners: Option<Vec<u32>> = words.map(index).collect();
                let corners = corners.filter(|corners| corners.len() >= 3).ok_or_else(wrong)?;
                triangles.extend(corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    let name = std::path::Path::new(path).file_stem().and_then(|stem| stem.to_str()).unwrap_or(path);
    if triangles.iter().flatten().any(|&i| i as usize >= vertices.len()) {
        return Err("a face names a vertex that does not exist".to_owned());
    }
    Ok(Shape::new(name, vertices, triangles))
}
