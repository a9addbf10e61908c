//! How many polygons a second local rendering shades, and how long hidden-line removal takes. Each picture is checked
//! against a plain z-buffer first, which runs beside it.

use glam::DVec3;
use host::mesh;
use protocol::command::{Polygon, PolygonVertex};
use ps340::{
    functions::devices::shading::ShadingEnvironment,
    port::Rendering,
    rendering::{Facets, Image, RenderingResult, Segment, render},
    structure::Operation,
};
use std::time::Instant;
use tests::facets::{facets, matrix, polygons, to_screen, view, z_buffer};

/// Lines and columns of the image.
const SIZE: usize = 480;

/// The shortest of several runs, seconds, and what the last one made.
fn best<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let mut run = || {
        let start = Instant::now();
        let made = work();
        (start.elapsed().as_secs_f64(), made)
    };
    let first = run();
    (0..4).map(|_| run()).fold(first, |best, next| (best.0.min(next.0), next.1))
}

fn image(kind: Rendering, facets: Facets, quality: u32) -> Image {
    let environment = ShadingEnvironment { quality, depth_cue: 0.0, ..ShadingEnvironment::default() };
    match render(kind, facets, &environment) {
        Ok(RenderingResult::Image(image)) => image,
        other => panic!("{other:?}"),
    }
}

fn hidden_line(facets: Facets) -> Vec<Segment> {
    match render(Rendering::HiddenLine, facets, &ShadingEnvironment::default()) {
        Ok(RenderingResult::Lines(lines)) => lines,
        other => panic!("{other:?}"),
    }
}

/// Layers of large triangles, half the screen each.
fn large(count: usize) -> Vec<Polygon> {
    let polygon = |k: usize| {
        let z = k as f32 / count as f32;
        let corners = [[-0.9, -0.9, z], [-0.9 + 0.2 * z, 0.9, z], [0.9, -0.9 + 0.3 * z, z]];
        let vertices = corners.map(|position| PolygonVertex { soft: false, position, normal: None, color: None });
        Polygon { attributes: None, outline: None, coplanar: false, vertices: vertices.to_vec() }
    };
    (0..count).rev().map(polygon).collect()
}

fn shaded(name: &str, polygons: &[Polygon], above: &[Operation]) {
    let matrix = matrix(above);
    let corner = |p: &PolygonVertex| {
        let place = to_screen(&matrix, DVec3::from(p.position.map(f64::from)), SIZE);
        // Without perspective the depth itself says what is near.
        if above.is_empty() { place.with_z(2.0 - f64::from(p.position[2])) } else { place }
    };
    let triangles: Vec<[DVec3; 3]> = polygons.iter().map(|p| [0, 1, 2].map(|k| corner(&p.vertices[k]))).collect();
    let (seconds, plain) = best(|| z_buffer(&triangles, SIZE));
    let rate = |seconds: f64| polygons.len() as f64 / seconds;
    println!("{name}: plain z-buffer, no light {:>10.0} polygons/s", rate(seconds));
    let (seconds, _) = best(|| facets(polygons.to_vec(), false, above));
    println!("{name}: gathering          {:>10.0} polygons/s", rate(seconds));
    for (kind, quality) in [
        (Rendering::Wash, 0),
        (Rendering::Flat, 0),
        (Rendering::Flat, 1),
        (Rendering::Gouraud, 1),
        (Rendering::Phong, 1),
        (Rendering::Phong, 3),
    ] {
        let mut ready: Vec<Facets> = (0..5).map(|_| facets(polygons.to_vec(), false, above)).collect();
        let (seconds, image) = best(|| image(kind, ready.pop().expect("one for each run"), quality));
        if quality == 0 {
            let covered = |(pixel, nearness): (&[u8; 3], &f64)| (*pixel != [0; 3]) != (*nearness > 0.0);
            let wrong = image.pixels.iter().zip(&plain).filter(|pair| covered(*pair)).count();
            assert!(wrong < 50, "{name}: {wrong} pixels are not those of the z-buffer");
        }
        println!("{name}: {kind:?}, quality {quality}  {:>10.0} polygons/s, {:6.1} ms", rate(seconds), seconds * 1e3);
    }
}

fn main() {
    let bunny = mesh::bunny().expect("it ships");
    let above = view(DVec3::new(0.8, 1.0, -3.2));
    shaded("bunny, 69,666 small", &polygons(&bunny, true), &above);
    shaded("200 large", &large(200), &[]);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    for mesh in [bunny.simplified(4_000), bunny.simplified(17_000), bunny] {
        for (solid, soft) in [(true, false), (false, false), (true, true)] {
            let polygons = polygons(&mesh, soft);
            let mut ready: Vec<Facets> = (0..6).map(|_| facets(polygons.clone(), solid, &above)).collect();
            check(&polygons, &hidden_line(ready.pop().expect("one to check")), &above);
            let (seconds, lines) = one.install(|| best(|| hidden_line(ready.pop().expect("one for each run"))));
            println!(
                "hidden lines, {} triangles, solid {solid}, soft {soft}: {:7.1} ms on one thread, {} lines",
                polygons.len(),
                seconds * 1e3,
                lines.len(),
            );
        }
    }
}

/// Whether lines are there, and none has only clearly nearer polygons around its middle.
fn check(polygons: &[Polygon], lines: &[Segment], above: &[Operation]) {
    let matrix = matrix(above);
    let on_screen = |point: DVec3| to_screen(&matrix, point, SIZE);
    let corner = |p: &Polygon, k: usize| on_screen(DVec3::from(p.vertices[k].position.map(f64::from)));
    let triangles: Vec<[DVec3; 3]> = polygons.iter().map(|p| [0, 1, 2].map(|k| corner(p, k))).collect();
    let nearest = z_buffer(&triangles, SIZE);
    let hidden = |segment: &&Segment| {
        let p = on_screen(segment.ends[0].lerp(segment.ends[1], 0.5));
        let (x, y) = (p.x as usize, p.y as usize);
        (y - 1..=y + 1).all(|y| (x - 1..=x + 1).all(|x| nearest[y * SIZE + x] > p.z + 0.01))
    };
    assert!(lines.len() > 100 && lines.iter().filter(hidden).count() == 0, "a line shows through");
}
