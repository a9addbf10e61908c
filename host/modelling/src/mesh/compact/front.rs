//! The border of a growing region of triangles: loops of directed edges with the region on their left.

/// How the triangle outside a gate joins the region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Its third vertex is new.
    Create(u32),
    /// Its third vertex is the end of the edge after the gate.
    Right,
    /// Its third vertex is the start of the edge before the gate.
    Left,
    /// Its third vertex is the start of another edge of the same loop, which is divided.
    Split(u32),
    /// It fills a loop of three edges.
    Close,
}

/// A border edge, from `vertex` to the vertex of the next.
struct Node {
    vertex: u32,
    /// The third vertex of the triangle on its left.
    apex: u32,
    next: u32,
    previous: u32,
    is_alive: bool,
}

/// The border, and the gates that wait.
#[derive(Default)]
pub(super) struct Front {
    nodes: Vec<Node>,
    waiting: Vec<u32>,
}

impl Front {
    /// Begins a region with one triangle: nodes n, n + 1 and n + 2 in the order of its sides.
    pub fn start(&mut self, [a, b, c]: [u32; 3]) {
        let first = self.nodes.len() as u32;
        for (vertex, behind, offset) in [(a, c, 0), (b, a, 1), (c, b, 2)] {
            let (next, previous) = (first + (offset + 1) % 3, first + (offset + 2) % 3);
            self.nodes.push(Node { vertex, apex: behind, next, previous, is_alive: true });
            self.waiting.push(first + offset);
        }
    }

    /// The next gate.
    pub fn pop(&mut self) -> Option<u32> {
        loop {
            let gate = self.waiting.pop()?;
            if self.nodes[gate as usize].is_alive {
                return Some(gate);
            }
        }
    }

    fn next(&self, node: u32) -> u32 {
        self.nodes[node as usize].next
    }

    fn previous(&self, node: u32) -> u32 {
        self.nodes[node as usize].previous
    }

    fn vertex(&self, node: u32) -> u32 {
        self.nodes[node as usize].vertex
    }

    /// The vertices where an edge begins and ends.
    pub fn ends(&self, node: u32) -> [u32; 2] {
        [self.vertex(node), self.vertex(self.next(node))]
    }

    /// The third vertex of the triangle on the left of an edge.
    pub fn apex(&self, node: u32) -> u32 {
        self.nodes[node as usize].apex
    }

    /// The vertex after the end of `gate`.
    pub fn right(&self, gate: u32) -> u32 {
        self.vertex(self.next(self.next(gate)))
    }

    /// The vertex before the start of `gate`.
    pub fn left(&self, gate: u32) -> u32 {
        self.vertex(self.previous(gate))
    }

    /// The step that joins `gate` to the vertex where `node` begins, in the same loop.
    pub fn step_to(&self, gate: u32, node: u32) -> Step {
        let is_right = node == self.next(self.next(gate));
        let is_left = node == self.previous(gate);
        match (is_right, is_left) {
            (true, true) => Step::Close,
            (true, false) => Step::Right,
            (false, true) => Step::Left,
            (false, false) => Step::Split(node),
        }
    }

    /// The edge `distance` steps after `gate`; `None` if the loop is shorter or `walk_left` is used up.
    pub fn ahead(&self, gate: u32, distance: u32, walk_left: &mut u64) -> Option<u32> {
        let mut node = gate;
        for _ in 0..distance {
            node = self.next(node);
            *walk_left = walk_left.checked_sub(1)?;
            if node == gate {
                return None;
            }
        }
        Some(node)
    }

    /// The steps from `gate` to `node`; `None` if it is in another loop or `walk_left` is used up.
    pub fn distance(&self, gate: u32, node: u32, walk_left: &mut u64) -> Option<u32> {
        let (mut here, mut distance) = (gate, 0);
        while here != node {
            here = self.next(here);
            distance += 1;
            *walk_left = walk_left.checked_sub(1)?;
            if here == gate {
                return None;
            }
        }
        Some(distance)
    }

    /// Attaches the triangle outside `gate`; the new edges become gates, the one from the start of the gate first.
    /// `None` if the loop does not allow the step.
    pub fn apply(&mut self, gate: u32, step: Step) -> Option<()> {
        let [a, b] = self.ends(gate);
        let (before, after) = (self.previous(gate), self.next(gate));
        let is_triangle = self.next(after) == before;
        if is_triangle != (step == Step::Close) && !matches!(step, Step::Create(_)) {
            return None;
        }
        self.nodes[gate as usize].is_alive = false;
        match step {
            Step::Create(apex) => {
                let from_a = self.insert(a, b, before);
                let from_apex = self.insert(apex, a, from_a);
                self.link(from_apex, after);
            }
            Step::Right => {
                self.nodes[after as usize].is_alive = false;
                let beyond = self.next(after);
                let from_a = self.insert(a, b, before);
                self.link(from_a, beyond);
            }
            Step::Left => {
                self.nodes[before as usize].is_alive = false;
                let apex = self.vertex(before);
                let from_apex = self.insert(apex, a, self.previous(before));
                self.link(from_apex, after);
            }
            Step::Split(node) => {
                if node == after || node == self.next(after) || node == before {
                    return None;
                }
                let apex = self.vertex(node);
                let last_of_second = self.previous(node);
                let from_a = self.insert(a, b, before);
                self.link(from_a, node);
                let from_apex = self.insert(apex, a, last_of_second);
                self.link(from_apex, after);
            }
            Step::Close => {
                self.nodes[after as usize].is_alive = false;
                self.nodes[before as usize].is_alive = false;
            }
        }
        Some(())
    }

    /// Adds an edge after `previous`, as a gate.
    fn insert(&mut self, vertex: u32, behind: u32, previous: u32) -> u32 {
        let node = self.nodes.len() as u32;
        self.nodes.push(Node { vertex, apex: behind, next: node, previous, is_alive: true });
        self.nodes[previous as usize].next = node;
        self.waiting.push(node);
        node
    }

    fn link(&mut self, node: u32, next: u32) {
        self.nodes[node as usize].next = next;
        self.nodes[next as usize].previous = node;
    }
}
