//! Edges chained into long runs, so that a display draws them with few moves.

use glam::DVec3;

use super::edges::{EdgeTable, EdgeUse};
use super::{EdgeSelection, Mesh};

/// Runs of points joined by lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polylines {
    /// The points of all runs, one run after the other.
    pub points: Vec<DVec3>,
    /// Where each run begins in `points`, rising; every run has at least two points.
    pub starts: Vec<usize>,
}

impl Polylines {
    /// The runs: each begins with a move, and every further point is a line.
    pub fn runs(&self) -> impl Iterator<Item = &[DVec3]> {
        let ends = self.starts.iter().skip(1).copied().chain([self.points.len()]);
        self.starts.iter().zip(ends).map(|(&start, end)| &self.points[start..end])
    }

    /// Adds further runs.
    pub fn extend(&mut self, other: Polylines) {
        let count = self.points.len();
        self.starts.extend(other.starts.iter().map(|start| start + count));
        self.points.extend(other.points);
    }

    /// Number of lines.
    pub fn lines(&self) -> usize {
        self.points.len() - self.starts.len()
    }
}

/// The selected lines of `mesh`, each once, in as few runs as can be.
///
/// A connected set of edges with 2k > 0 odd vertices (where an odd number of edges meets) cannot be drawn in fewer
/// than k runs, and one without in fewer than 1: this is what comes out. At each vertex a run goes straight ahead if
/// it can.
///
/// # Source
/// Hierholzer 1873: odd vertices are joined in pairs by edges that are not drawn, the closed trail is cut there.
pub fn polylines(mesh: &Mesh, selection: &EdgeSelection) -> Polylines {
    polylines_of_groups(mesh, selection, &[], 1).pop().unwrap_or_default()
}

/// The lines of each group of triangles, as few as can be. An edge between two groups is of the later one.
///
/// - `group_of`: the group of each triangle, below `count`; empty if all are of the first.
pub fn polylines_of_groups(mesh: &Mesh, selection: &EdgeSelection, group_of: &[u32], count: usize) -> Vec<Polylines> {
    let table = EdgeTable::of(mesh);
    let mut edges: Vec<Vec<[u32; 2]>> = vec![Vec::new(); count];
    for edge in table.select(mesh, selection) {
        let group = |place: &EdgeUse| group_of.get(place.triangle as usize).map_or(0, |group| *group as usize);
        let last = table.uses(edge).iter().map(group).max().unwrap_or(0);
        edges[last].push(edge.ends);
    }
    let contour = table.smooth_outline(mesh, selection);
    let points: Vec<DVec3> = mesh.vertices.iter().copied().chain(contour.points).collect();
    for (ends, triangle) in contour.lines {
        let group = group_of.get(triangle as usize).map_or(0, |group| *group as usize);
        edges[group].push(ends.map(|point| point + mesh.vertices.len() as u32));
    }
    edges.into_iter().map(|edges| Trails::new(&points, edges).into_polylines()).collect()
}

/// A graph on its way into trails.
struct Trails<'a> {
    points: &'a [DVec3],
    /// The drawn edges, then one for each pair of odd vertices.
    edges: Vec<[u32; 2]>,
    drawn: usize,
    used: Vec<bool>,
    /// Edges at vertex v: `incident[first[v]..first[v + 1]]`, of which those before `next[v]` are used.
    first: Vec<usize>,
    next: Vec<usize>,
    incident: Vec<u32>,
}

impl<'a> Trails<'a> {
    fn new(points: &'a [DVec3], mut edges: Vec<[u32; 2]>) -> Trails<'a> {
        let drawn = edges.len();
        pair_odd_vertices(points.len(), &mut edges);
        let mut first = vec![0; points.len() + 1];
        edges.iter().flatten().for_each(|&end| first[end as usize + 1] += 1);
        for vertex in 0..points.len() {
            first[vertex + 1] += first[vertex];
        }
        let mut next = first.clone();
        let mut incident = vec![0; edges.len() * 2];
        for (edge, ends) in edges.iter().enumerate() {
            for &end in ends {
                incident[next[end as usize]] = edge as u32;
                next[end as usize] += 1;
            }
        }
        next.copy_from_slice(&first);
        Trails { points, used: vec![false; edges.len()], edges, drawn, first, next, incident }
    }

    fn into_polylines(mut self) -> Polylines {
        let mut polylines = Polylines::default();
        for edge in 0..self.drawn {
            if !self.used[edge] {
                let trail = self.closed_trail(self.edges[edge][0]);
                self.cut(&trail, &mut polylines);
            }
        }
        polylines
    }

    /// All edges that are connected with `start`, as a closed trail: vertices, each with the edge that led to it.
    fn closed_trail(&mut self, start: u32) -> Vec<(u32, Option<u32>)> {
        let mut stack = vec![(start, None)];
        let mut trail = Vec::new();
        while let Some(&(vertex, arrival)) = stack.last() {
            let before = stack.len().checked_sub(2).map(|index| stack[index].0);
            match self.take_edge(vertex, before) {
                Some(edge) => {
                    let [a, b] = self.edges[edge as usize];
                    stack.push((if a == vertex { b } else { a }, Some(edge)));
                }
                None => {
                    stack.pop();
                    trail.push((vertex, arrival));
                }
            }
        }
        trail
    }

    /// Takes an unused edge at `vertex`, the straightest continuation of the way from `before`.
    fn take_edge(&mut self, vertex: u32, before: Option<u32>) -> Option<u32> {
        let v = vertex as usize;
        while self.next[v] < self.first[v + 1] && self.used[self.incident[self.next[v]] as usize] {
            self.next[v] += 1;
        }
        let open = &self.incident[self.next[v]..self.first[v + 1]];
        let position = |vertex: u32| self.points[vertex as usize];
        let heading = before.map_or(DVec3::ZERO, |before| position(vertex) - position(before)).normalize_or_zero();
        let mut best: Option<(f64, u32)> = None;
        for &edge in open.iter().take(STRAIGHTEST_OF).filter(|&&edge| !self.used[edge as usize]) {
            let [a, b] = self.edges[edge as usize];
            let direction = (position(if a == vertex { b } else { a }) - position(vertex)).normalize_or_zero();
            let straightness = if (edge as usize) < self.drawn { heading.dot(direction) } else { UNDRAWN };
            if best.is_none_or(|(champion, _)| straightness > champion) {
                best = Some((straightness, edge));
            }
        }
        let (_, edge) = best?;
        self.used[edge as usize] = true;
        Some(edge)
    }

    /// Appends the runs of a closed trail between its edges that are not drawn.
    fn cut(&self, trail: &[(u32, Option<u32>)], polylines: &mut Polylines) {
        let is_drawn = |edge: Option<u32>| edge.is_some_and(|edge| (edge as usize) < self.drawn);
        // The edge stored with vertex i joins it to vertex i + 1; the last vertex is the first again.
        let count = trail.len() - 1;
        let begin = (0..count).find(|&i| !is_drawn(trail[i].1)).map_or(0, |i| i + 1);
        let mut in_run = false;
        for i in begin..begin + count {
            let (vertex, edge) = trail[i % count];
            if !is_drawn(edge) {
                in_run = false;
                continue;
            }
            if !in_run {
                polylines.starts.push(polylines.points.len());
                polylines.points.push(self.points[vertex as usize]);
                in_run = true;
            }
            let (direction, _) = trail[(i + 1) % count];
            polylines.points.push(self.points[direction as usize]);
        }
    }
}

/// Continuations compared at a vertex: bounds the work at the tip of a fan.
const STRAIGHTEST_OF: usize = 16;
/// Straightness of an edge that is not drawn: below the -1 of turning back.
const UNDRAWN: f64 = -2.0;

/// Adds edges between odd vertices, two by two within each connected part.
fn pair_odd_vertices(vertex_count: usize, edges: &mut Vec<[u32; 2]>) {
    let mut parent: Vec<u32> = (0..vertex_count as u32).collect();
    let mut odd = vec![false; vertex_count];
    for [a, b] in edges.iter() {
        let (a_root, b_root) = (root(&mut parent, *a), root(&mut parent, *b));
        parent[a_root.max(b_root) as usize] = a_root.min(b_root);
        odd[*a as usize] ^= true;
        odd[*b as usize] ^= true;
    }
    let mut waiting: Vec<Option<u32>> = vec![None; vertex_count];
    for vertex in (0..vertex_count as u32).filter(|&vertex| odd[vertex as usize]) {
        let part = root(&mut parent, vertex) as usize;
        match waiting[part].take() {
            Some(partner) => edges.push([partner, vertex]),
            None => waiting[part] = Some(vertex),
        }
    }
}

/// The representative of a vertex in a union-find forest, halving the path to it.
fn root(parent: &mut [u32], mut vertex: u32) -> u32 {
    while parent[vertex as usize] != vertex {
        let grandparent = parent[parent[vertex as usize] as usize];
        parent[vertex as usize] = grandparent;
        vertex = grandparent;
    }
    vertex
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::super::measure::bits;
    use super::super::samples::{ball, cube};
    use super::super::{Viewer, wire};
    use super::*;

    type Key = ([u64; 3], [u64; 3]);

    fn key([a, b]: [DVec3; 2]) -> Key {
        (bits(a).min(bits(b)), bits(a).max(bits(b)))
    }

    /// Checks that runs and wires hold the same edges, each once, and that there are as few runs as can be.
    fn check(mesh: &Mesh, selection: &EdgeSelection) -> Polylines {
        let runs = polylines(mesh, selection);
        let wires = wire(mesh, selection);
        let mut drawn: Vec<Key> =
            runs.runs().flat_map(|run| run.windows(2).map(|pair| key([pair[0], pair[1]]))).collect();
        let mut wanted: Vec<Key> = wires.iter().copied().map(key).collect();
        drawn.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(drawn, wanted);
        assert_eq!(runs.lines(), wires.len());
        assert_eq!(runs.starts.len(), fewest_runs(&wires));
        runs
    }

    fn fewest_runs(wires: &[[DVec3; 2]]) -> usize {
        // An independent count: flood each part, count its odd vertices.
        let mut neighbours: HashMap<[u64; 3], Vec<[u64; 3]>> = HashMap::new();
        for [a, b] in wires {
            neighbours.entry(bits(*a)).or_default().push(bits(*b));
            neighbours.entry(bits(*b)).or_default().push(bits(*a));
        }
        let mut total = 0;
        while let Some(&seed) = neighbours.keys().next() {
            let (mut odd, mut front) = (0, vec![seed]);
            while let Some(vertex) = front.pop() {
                let Some(next) = neighbours.remove(&vertex) else { continue };
                odd += next.len() % 2;
                front.extend(next);
            }
            total += (odd / 2).max(1);
        }
        total
    }

    #[test]
    fn the_twelve_edges_of_a_cube_take_four_runs() {
        let runs = check(&cube(), &EdgeSelection::creases(20.0));
        assert_eq!((runs.starts.len(), runs.points.len()), (4, 16));
    }

    #[test]
    #[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
    fn all_edges_of_bunny_and_sphere_come_once_in_the_fewest_runs() {
        for mesh in [super::super::bunny().expect("it ships"), ball(31, 17)] {
            check(&mesh, &EdgeSelection::ALL);
            check(&mesh, &EdgeSelection::grid(30.0));
            check(&mesh, &EdgeSelection::drawing(30.0, Viewer::Direction(DVec3::new(1.0, 2.0, 3.0))));
        }
    }

    #[test]
    fn the_outline_of_a_sphere_is_one_run() {
        let ball = ball(64, 32);
        let selection = EdgeSelection::drawing(180.0, Viewer::Point(DVec3::new(3.0, 2.0, 4.0)));
        let runs = check(&ball, &selection);
        assert_eq!(runs.starts.len(), 1);
        assert_eq!(runs.points.first(), runs.points.last());
    }

    #[test]
    fn nothing_selected_gives_no_runs() {
        assert_eq!(polylines(&Mesh::default(), &EdgeSelection::ALL), Polylines::default());
    }
}
