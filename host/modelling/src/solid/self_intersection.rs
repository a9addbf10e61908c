//! Surfaces that cross themselves so often that to repair them would take no one knows how long.

use super::SolidError;
use super::boolean::overlapping_up_to;
use crate::mesh::Mesh;
use crate::octree::TriangleBvh;

/// Most places where three triangles cross each other. Repairing a surface takes about 50 us for each, and 1 kB.
const MOST_TRIPLES: usize = 1_000_000;
/// Most pairs of triangles that cross. Repairing a surface takes about 100 us for each, and 2 kB.
const MOST_PAIRS: usize = 500_000;

/// Pairs of triangles of a mesh, the lower first, that have more in common than corners and the edges between.
///
/// # Errors
/// [`SolidError::TooManyIntersections`] where there are too many, or three of them cross each other too often.
pub(super) fn overlaps(mesh: &Mesh, sorted: &TriangleBvh) -> Result<Vec<[u32; 2]>, SolidError> {
    let pairs = overlapping_up_to(mesh, sorted, MOST_PAIRS);
    let too_many =
        |what, count, most| if count > most { Err(SolidError::TooManyIntersections { what, most }) } else { Ok(()) };
    too_many("pairs of triangles cross", pairs.len(), MOST_PAIRS)?;
    too_many("places are where three triangles cross", triples(&pairs, MOST_TRIPLES), MOST_TRIPLES)?;
    Ok(pairs)
}

/// How many threes there are of which each two are a pair; one more than `most` where there are more.
fn triples(pairs: &[[u32; 2]], most: usize) -> usize {
    // Who comes later in a pair with each.
    let mut later: Vec<[u32; 2]> = pairs.to_vec();
    later.sort_unstable();
    let of = |one: u32| {
        let begin = later.partition_point(|pair| pair[0] < one);
        later[begin..].iter().take_while(move |pair| pair[0] == one).map(|pair| pair[1])
    };
    let mut count = 0;
    for [one, two] in pairs {
        let mut seconds = of(*two).peekable();
        for first in of(*one) {
            while seconds.next_if(|second| *second < first).is_some() {}
            count += usize::from(seconds.peek() == Some(&first));
        }
        if count > most {
            return most + 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Solid;
    use glam::DVec3;
    use rand::{RngExt, SeedableRng};

    /// Triangles of corners anywhere in a cube, each with its back.
    fn soup(count: u32) -> Mesh {
        let mut random = rand_pcg::Pcg32::seed_from_u64(5);
        let vertices = (0..3 * count).map(|_| DVec3::from_array(std::array::from_fn(|_| random.random::<f64>())));
        let both = (0..count).flat_map(|t| [[3 * t, 3 * t + 1, 3 * t + 2], [3 * t, 3 * t + 2, 3 * t + 1]]);
        Mesh { vertices: vertices.collect(), triangles: both.collect(), ..Mesh::default() }
    }

    #[test]
    fn threes_are_counted_once() {
        assert_eq!(triples(&[[0, 1], [1, 2], [0, 2]], 9), 1);
        assert_eq!(triples(&[[0, 1], [1, 2], [2, 3], [0, 3]], 9), 0);
        let all = |count: u32| (0..count).flat_map(|b| (0..b).map(move |a| [a, b])).collect::<Vec<_>>();
        assert_eq!(triples(&all(7), 99), 35);
        assert_eq!(triples(&all(7), 34), 35);
    }

    #[test]
    fn soups_are_refused_by_count() {
        for (count, what) in [
            (4, "nothing"),
            (200, "nothing"),
            (700, "three triangles"),
            (1000, "pairs of triangles"),
            (20_000, "pairs of triangles"),
        ] {
            let refused = Solid::resolved(soup(count)).map(|_| ()).unwrap_err().to_string();
            assert!(refused.contains(what), "{count}: {refused}");
        }
    }
}
