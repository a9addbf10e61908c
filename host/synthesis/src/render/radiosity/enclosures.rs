//! Enclosures: parts of a scene that see each other without an opening between them, such as the inside of a room.
//!
//! A room that light comes into by a small window is dim beside what is around it. What rays tell of the room as a whole
//! is certain, though of each of its walls it is not.

use super::disjoint_sets::DisjointSets;
use super::hierarchy::Hierarchy;
use super::node::NONE;

/// Fewer leaves than these, such as those that see nothing but the sky, are no enclosure of their own.
const LEAST_LEAVES: usize = 64;

/// The enclosure of each leaf, numbered from 0. What is in none has a number of its own; a dark leaf has [`NONE`].
///
/// - `joined`: the numbers of leaves that see each other.
pub(super) fn enclosures(mut joined: DisjointSets, is_dark: &[bool]) -> Vec<u32> {
    let roots: Vec<u32> = (0..is_dark.len() as u32).map(|leaf| joined.root(leaf)).collect();
    let mut leaves = vec![0; is_dark.len()];
    let lit = || roots.iter().zip(is_dark).filter(|(_, is_dark)| !**is_dark).map(|(root, _)| *root as usize);
    lit().for_each(|root| leaves[root] += 1);
    let mut number = vec![NONE; is_dark.len()];
    let (mut count, mut of_others) = (0, NONE);
    let mut next = || {
        count += 1;
        count - 1
    };
    for root in lit() {
        if number[root] == NONE && leaves[root] >= LEAST_LEAVES {
            number[root] = next();
        } else if number[root] == NONE {
            of_others = if of_others == NONE { next() } else { of_others };
            number[root] = of_others;
        }
    }
    roots.iter().zip(is_dark).map(|(root, is_dark)| if *is_dark { NONE } else { number[*root as usize] }).collect()
}

/// A scene as a tree: all of it; its enclosures; the largest nodes that lie in one of them; the parts of these. Where
/// there are not several enclosures, it is the hierarchy.
pub(super) struct EnclosureTree<'a> {
    hierarchy: &'a Hierarchy,
    /// The children of what is above nodes: of all, then of each enclosure. Nodes come after these.
    above: Vec<Vec<usize>>,
    is_mixed: Vec<bool>,
}

impl EnclosureTree<'_> {
    /// - `leaves`: their nodes. `enclosures`: of each, its number, or [`NONE`].
    pub(super) fn new<'a>(hierarchy: &'a Hierarchy, leaves: &[u32], enclosures: &[u32]) -> EnclosureTree<'a> {
        let nodes = &hierarchy.nodes;
        let count = enclosures.iter().filter(|number| **number != NONE).max().map_or(0, |most| *most as usize + 1);
        if count < 2 {
            return EnclosureTree { hierarchy, above: Vec::new(), is_mixed: vec![false; nodes.len()] };
        }
        let mut of = vec![NONE; nodes.len()];
        leaves.iter().zip(enclosures).for_each(|(leaf, number)| of[*leaf as usize] = *number);
        let mut is_mixed = vec![false; nodes.len()];
        for place in (0..nodes.len()).rev() {
            for child in nodes[place].children() {
                let is_other = of[place] != NONE && of[child] != NONE && of[child] != of[place];
                is_mixed[place] |= is_mixed[child] || is_other;
                of[place] = if of[place] == NONE { of[child] } else { of[place] };
            }
        }
        let mut above = vec![Vec::new(); count + 1];
        above[0] = (1..=count).collect();
        for place in (0..nodes.len()).filter(|place| is_mixed[*place]) {
            for child in nodes[place].children().filter(|child| !is_mixed[*child] && of[*child] != NONE) {
                above[1 + of[child] as usize].push(count + 1 + child);
            }
        }
        EnclosureTree { hierarchy, above, is_mixed }
    }

    /// How many places it has; all of it is the first, and each is before its children.
    pub(super) fn len(&self) -> usize {
        self.above.len() + self.hierarchy.nodes.len()
    }

    /// The places of what knows nothing of each other: the enclosures, or all where there are not several.
    pub(super) fn roots(&self) -> impl Iterator<Item = usize> {
        if self.above.is_empty() { 0..self.len().min(1) } else { 1..self.above.len() }
    }

    /// The place of a node.
    pub(super) fn place_of(&self, node: u32) -> usize {
        self.above.len() + node as usize
    }

    /// Whether a place is an enclosure.
    pub(super) fn is_enclosure(&self, place: usize) -> bool {
        (1..self.above.len()).contains(&place)
    }

    /// The places of the parts of a place; none of a leaf, and of a node that several enclosures share.
    pub(super) fn children(&self, place: usize) -> impl Iterator<Item = usize> {
        let above: &[usize] = self.above.get(place).map_or(&[], |children| children);
        let first = self.above.len();
        let node = place.checked_sub(first).filter(|node| !self.is_mixed[*node]);
        let parts = node.into_iter().flat_map(|node| self.hierarchy.nodes[node].children());
        above.iter().copied().chain(parts.map(move |part| first + part))
    }
}

#[cfg(test)]
mod tests {
    use super::super::node::RadiosityPatch;
    use super::super::shortest_edges::ShortestEdges;
    use super::*;
    use glam::DVec3;

    #[test]
    fn few_leaves_by_themselves_are_one_enclosure_and_dark_ones_are_in_none() {
        let count = 2 * LEAST_LEAVES + 10;
        let mut joined = DisjointSets::new(count);
        (1..LEAST_LEAVES as u32).for_each(|leaf| joined.join(0, leaf));
        (1..LEAST_LEAVES as u32).for_each(|leaf| joined.join(100, 100 + leaf % 30));
        let mut is_dark = vec![false; count];
        is_dark[7] = true;
        let one_less = enclosures(DisjointSets::new(count), &is_dark);
        assert!(one_less.iter().enumerate().all(|(leaf, number)| *number == if leaf == 7 { NONE } else { 0 }));
        is_dark[7] = false;
        let of = enclosures(joined, &is_dark);
        assert!(of[..LEAST_LEAVES].iter().all(|number| *number == 0));
        assert!(of[LEAST_LEAVES..].iter().all(|number| *number == 1), "{of:?}");
    }

    #[test]
    fn each_lit_leaf_is_in_the_tree_once_below_its_enclosure() {
        let patch = |triangle: u32| {
            let at = DVec3::X * f64::from(triangle);
            RadiosityPatch { corners: [at, at + DVec3::X, at + DVec3::Y], triangle, outside: true }
        };
        let hierarchy = Hierarchy::new((0..100).map(patch).collect(), &ShortestEdges::everywhere(1e-9), |_| false);
        let leaves = hierarchy.leaves();
        // Every third place of the row is another enclosure, so that most nodes are mixed; one is dark.
        let number = |leaf: &u32| match hierarchy.nodes[*leaf as usize].middle.x as u32 {
            50 => NONE,
            x => u32::from(x % 3 == 0),
        };
        let enclosures: Vec<u32> = leaves.iter().map(number).collect();
        for enclosures in [enclosures, vec![0; leaves.len()]] {
            let tree = EnclosureTree::new(&hierarchy, &leaves, &enclosures);
            let mut found: Vec<Option<u32>> = vec![None; tree.len()];
            let mut pending = vec![(0, None)];
            while let Some((place, enclosure)) = pending.pop() {
                let enclosure = if tree.is_enclosure(place) { Some(place as u32 - 1) } else { enclosure };
                assert!(tree.children(place).all(|child| child > place));
                assert!(found[place].is_none());
                found[place] = Some(enclosure.unwrap_or(0));
                pending.extend(tree.children(place).map(|child| (child, enclosure)));
            }
            for (leaf, enclosure) in leaves.iter().zip(&enclosures) {
                let expected = if *enclosure == NONE { None } else { Some(*enclosure) };
                assert_eq!(found[tree.place_of(*leaf)], expected);
            }
        }
    }
}
