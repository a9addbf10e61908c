//! The linear octree against other means, on the Stanford bunny and the Utah teapot.

use glam::DVec3;
use host::{
    mesh::{Mesh, bunny},
    numeric::sampling::{self, RandomStream},
    octree::{
        Octree, OctreeSettings, Ray,
        brute_force::{Agreement, agreement, closest_many},
    },
    surface::{Tolerance, teapot, tessellate},
};

const RAYS: usize = 1_000_000;

fn the_teapot() -> Mesh {
    tessellate(&teapot(), Tolerance::new(0.001, 180.0)).expect("the teapot can be tessellated")
}

/// Half of the rays go through a pinhole in front of the mesh, half are chords of a sphere around it.
fn rays(mesh: &Mesh, count: usize) -> Vec<Ray> {
    let bounds = mesh.bounds().expect("the mesh has vertices");
    let (center, radius) = ((bounds.min + bounds.max) / 2.0, (bounds.max - bounds.min).length() / 2.0);
    let side = ((count / 2) as f64).sqrt();
    (0..count)
        .map(|i| {
            if i < count / 2 {
                let (x, y) = ((i as f64 % side) / side - 0.5, (i as f64 / side) / side - 0.5);
                let eye = center + DVec3::new(0.3, 0.4, 1.0).normalize() * radius * 3.0;
                let at = center + DVec3::new(x, y, 0.0) * radius * 2.0;
                Ray { origin: eye, direction: at - eye }
            } else {
                let mut stream = RandomStream::new(7, i as u64);
                let [from, to] = [stream.point(), stream.point()].map(|p| center + sampling::sphere(p) * radius);
                Ray { origin: from, direction: to - from }
            }
        })
        .collect()
}

/// Every hit is the same, apart from ties, which are counted.
fn compare(name: &str, mesh: &Mesh) {
    let octree =
        Octree::build(&mesh.vertices, &mesh.triangles, &OctreeSettings::default()).expect("the octree is built");
    let rays = rays(mesh, RAYS);
    let expected = closest_many(&mesh.vertices, &mesh.triangles, &rays, 0.0, f64::INFINITY);
    let (mut hits, mut ties) = (0, 0);
    for (ray, expected) in rays.iter().zip(&expected) {
        let found = octree.closest(ray, 0.0, f64::INFINITY);
        hits += usize::from(found.is_some());
        match agreement(found, *expected) {
            Agreement::Same => {}
            Agreement::Tie => ties += 1,
            Agreement::Differ => panic!("{name}: {ray:?}: {found:?} is not {expected:?}"),
        }
    }
    println!("{name}: {} triangles, {RAYS} rays, {hits} hits, {ties} ties", mesh.triangles.len());
    assert!(hits > RAYS / 5, "{name}: only {hits} rays hit");
    assert!(ties < RAYS / 1000, "{name}: {ties} ties");
}

#[test]
fn a_million_rays_hit_the_bunny_where_all_its_triangles_say() {
    compare("bunny", &bunny().expect("it ships"));
}

#[test]
fn a_million_rays_hit_the_teapot_where_all_its_triangles_say() {
    compare("teapot", &the_teapot());
}

#[test]
fn no_ray_leaves_the_bunny_through_a_vertex_or_an_edge() {
    let mesh = bunny().expect("it ships");
    assert!(mesh.edge_report().is_closed());
    let octree =
        Octree::build(&mesh.vertices, &mesh.triangles, &OctreeSettings::default()).expect("the octree is built");
    let bounds = mesh.bounds().expect("the mesh has vertices");
    let inside = DVec3::new(-0.02, 0.09, 0.0);
    assert!(inside.cmpgt(bounds.min).all() && inside.cmplt(bounds.max).all(), "{bounds:?}");
    let mut crossings = 0;
    let mut from = 0.0;
    let probe = Ray { origin: inside, direction: DVec3::new(0.123, 0.456, 0.789) };
    while let Some(hit) = octree.closest(&probe, from, f64::INFINITY) {
        (crossings, from) = (crossings + 1, hit.t);
    }
    assert_eq!(crossings % 2, 1, "the point lies inside");
    let targets = mesh.triangles.iter().flat_map(|t| {
        let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
        [a, b, c, (a + b) / 2.0, (b + c) / 2.0, a + (c - a) * 0.3]
    });
    let (mut rays, mut escaped) = (0, 0);
    for target in targets {
        rays += 1;
        let ray = Ray { origin: inside, direction: target - inside };
        escaped += usize::from(octree.closest(&ray, 0.0, f64::INFINITY).is_none());
    }
    assert_eq!((escaped, rays), (0, 6 * mesh.triangles.len()));
}
