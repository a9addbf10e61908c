//! Back-face and hidden-line removal of a cube and of the bunny against an independent z-buffer.

use glam::DVec3;
use host::mesh::{self, Mesh};
use protocol::command::{Polygon, PolygonVertex};
use ps340::{
    functions::devices::shading::ShadingEnvironment,
    port::Rendering,
    rendering::{Outcome, Segment, render},
};
use std::collections::HashSet;
use tests::facets::{facets, matrix, place, polygons, view, z_buffer};

/// Pixels of the z-buffer along a side.
const SIZE: usize = 2048;

fn lines(polygons: &[Polygon], solid: bool, from: DVec3, kind: Rendering) -> Vec<Segment> {
    let facets = facets(polygons.to_vec(), solid, &view(from));
    match render(kind, facets, &ShadingEnvironment::default()) {
        Ok(Outcome::Lines(lines)) => lines,
        other => panic!("{other:?}"),
    }
}

fn corners(polygon: &Polygon) -> Vec<DVec3> {
    polygon.vertices.iter().map(|v| DVec3::from(v.position.map(f64::from))).collect()
}

/// What a z-buffer says of points.
struct Judge {
    depth: Vec<(f64, u32)>,
    /// The polygon of each triangle.
    owners: Vec<usize>,
    matrix: glam::DMat4,
    margin: f64,
}

impl Judge {
    fn new(polygons: &[Polygon], from: DVec3, margin: f64) -> Judge {
        let matrix = matrix(&view(from));
        let (mut triangles, mut owners) = (Vec::new(), Vec::new());
        for (number, polygon) in polygons.iter().enumerate() {
            let corners: Vec<DVec3> = corners(polygon).into_iter().map(|p| place(&matrix, p, SIZE)).collect();
            for k in 2..corners.len() {
                triangles.push([corners[0], corners[k - 1], corners[k]]);
                owners.push(number);
            }
        }
        Judge { depth: z_buffer(&triangles, SIZE), owners, matrix, margin }
    }

    /// The pixels around a point, and how near it is; none off the screen.
    fn around(&self, point: DVec3) -> Option<(impl Iterator<Item = (f64, u32)> + '_, f64)> {
        let p = place(&self.matrix, point, SIZE);
        let inside = |c: f64| (2.0..SIZE as f64 - 2.0).contains(&c);
        let (x, y) = (p.x as usize, p.y as usize);
        let pixels = move || (y - 1..=y + 1).flat_map(move |y| (x - 1..=x + 1).map(move |x| self.depth[y * SIZE + x]));
        (inside(p.x) && inside(p.y)).then(|| (pixels(), p.z))
    }

    /// Whether everything around a point is clearly nearer.
    fn hides(&self, point: DVec3) -> bool {
        self.around(point).is_some_and(|(mut pixels, z)| pixels.all(|(depth, _)| depth > z + self.margin))
    }

    /// Whether its polygon is seen at a point, and nothing around is clearly nearer.
    fn shows(&self, point: DVec3, polygon: usize) -> bool {
        let Some((pixels, z)) = self.around(point) else { return false };
        let (mut found, mut most) = (false, 0.0_f64);
        for (depth, triangle) in pixels {
            found |= self.owners.get(triangle as usize) == Some(&polygon);
            most = most.max(depth);
        }
        found && most < z + self.margin / 4.0
    }
}

/// Checks that nothing shows through and nothing is missing. Returns how many points were seen and hidden.
fn check(polygons: &[Polygon], lines: &[Segment], judge: &Judge) -> [usize; 2] {
    let bits = |p: DVec3| p.as_vec3().to_array().map(f32::to_bits);
    let key = |a: DVec3, b: DVec3| {
        let (a, b) = (bits(a), bits(b));
        [a.min(b), a.max(b)]
    };
    let mut whole = HashSet::new();
    let mut drawn = vec![false; SIZE * SIZE];
    for segment in lines {
        let [a, b] = segment.ends;
        whole.insert(key(a, b));
        let pixels = (place(&judge.matrix, a, SIZE) - place(&judge.matrix, b, SIZE)).truncate().length();
        let steps = (2.0 * pixels).ceil().max(2.0) as usize;
        for k in 0..=steps {
            let p = a.lerp(b, k as f64 / steps as f64);
            assert!(!judge.hides(p), "a line shows through at {p}");
            let p = place(&judge.matrix, p, SIZE);
            if (0.0..SIZE as f64).contains(&p.x) && (0.0..SIZE as f64).contains(&p.y) {
                drawn[p.y as usize * SIZE + p.x as usize] = true;
            }
        }
    }
    let mut counts = [0; 2];
    for (number, polygon) in polygons.iter().enumerate() {
        let corners = corners(polygon);
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let is_whole = whole.contains(&key(*a, b));
            for t in [0.125, 0.375, 0.5, 0.75] {
                let p = a.lerp(b, t);
                if judge.hides(p) {
                    counts[1] += 1;
                } else if judge.shows(p, number) {
                    let place = place(&judge.matrix, p, SIZE);
                    let (x, y) = (place.x as usize, place.y as usize);
                    let near = (y - 1..=y + 1).any(|y| (x - 1..=x + 1).any(|x| drawn[y * SIZE + x]));
                    assert!(is_whole || near, "a line is missing at {p}");
                    counts[0] += 1;
                }
            }
        }
    }
    counts
}

fn cube() -> Vec<Polygon> {
    let at = |corner: usize| [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.7 } else { -0.7 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4]];
    let vertices = |face: &[usize; 4]| face.map(|k| PolygonVertex { soft: false, position: at(k), normal: None });
    let polygon = |face: &[usize; 4]| vertices(face).to_vec();
    let polygons = faces.iter().map(polygon);
    polygons.map(|vertices| Polygon { attributes: None, outline: None, coplanar: false, vertices }).collect()
}

#[test]
fn a_cube_from_all_sides_shows_three_faces_two_or_one() {
    let cases = [
        (DVec3::new(2.0, 2.5, -3.0), 9),
        (DVec3::new(-2.0, -2.5, 3.0), 9),
        (DVec3::new(2.0, 0.0, -3.0), 7),
        (DVec3::new(0.0, 0.3, -3.5), 4),
    ];
    for (from, count) in cases {
        let judge = Judge::new(&cube(), from, 1e-3);
        for kind in [Rendering::BackFace, Rendering::HiddenLine] {
            let lines = lines(&cube(), true, from, kind);
            assert_eq!(lines.len(), count, "{kind:?} from {from}");
            check(&cube(), &lines, &judge);
        }
    }
}

fn of_bunny(mesh: &Mesh, from: DVec3) {
    let polygons = polygons(mesh, false);
    let judge = Judge::new(&polygons, from, 4e-3);
    for solid in [true, false] {
        let lines = lines(&polygons, solid, from, Rendering::HiddenLine);
        let [seen, hidden] = check(&polygons, &lines, &judge);
        assert!(seen > 150_000 && hidden > 150_000, "{seen} {hidden}");
    }
    // What faces away is hidden; what faces the eye may be.
    let facing = lines(&polygons, true, from, Rendering::BackFace);
    assert!(facing.len() > 45_000 && facing.len() < 62_000, "{}", facing.len());
}

#[test]
#[ignore = "an edge near the outline of the bunny is still missing"]
fn of_the_bunny_no_line_shows_through_and_none_is_missing() {
    let mesh = mesh::bunny();
    of_bunny(&mesh, DVec3::new(0.8, 1.0, -3.2));
    of_bunny(&mesh, DVec3::new(-2.9, -0.7, 1.9));
}
