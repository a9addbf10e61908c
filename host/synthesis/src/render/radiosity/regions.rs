//! Regions: parts of a scene whose light rays know better than elements do.

use super::enclosures::EnclosureTree;

/// The standard error of the light of a region, as a part of it, at the most.
const MOST_ERROR: f64 = 0.03;
/// A part of a region is one of its own if its light is wrong by another factor, by so many standard errors and by no
/// less than this.
const SIGNIFICANT: f64 = 3.0;
/// Where the standard error is no more than this, a difference by one is enough: elements seldom know better.
const CERTAIN: f64 = 0.003;
const LEAST_DIFFERENCE: f64 = 0.002;
/// The standard error of the light of a part that is corrected by itself, as a part of it, at the most.
const MOST_PART_ERROR: f64 = 0.1;
/// The variance of a larger part counts as much as so many rays of a smaller one.
const RAYS_OF_LARGER: f64 = 64.0;

/// The flux that a leaf receives, in all lanes together: W.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FluxEstimate {
    /// What elements have.
    pub(super) by_elements: f64,
    /// What random rays tell, and the variance of that.
    pub(super) by_rays: f64,
    pub(super) variance: f64,
    /// How many rays.
    pub(super) rays: u64,
}

impl FluxEstimate {
    /// What rays tell, over what elements have.
    fn factor(&self) -> f64 {
        self.by_rays / self.by_elements
    }

    /// The standard error of what rays tell, as a part of it.
    pub(super) fn relative_error(&self) -> f64 {
        if self.by_rays > 0.0 { self.variance.sqrt() / self.by_rays } else { 0.0 }
    }

    /// Takes the variance as no less than the mean of its own and of that of as much light of a larger part, each as
    /// certain as so many rays: where few rays bring light, their variance is too small just where the light is.
    fn pool_variance(&mut self, larger: &FluxEstimate) {
        let each = if larger.by_rays > 0.0 { larger.variance / larger.by_rays } else { 0.0 };
        let rays = self.rays as f64;
        let own = rays / (rays + RAYS_OF_LARGER);
        self.variance = self.variance.max(own * self.variance + (1.0 - own) * each * self.by_elements);
    }

    /// The standard error of the factor.
    fn error(&self) -> f64 {
        self.variance.sqrt() / self.by_elements
    }
}

/// Parts of a scene over each of which light is wrong by the same factor.
pub(super) struct Regions {
    /// For each leaf its region, numbered from 0: the first are leaves that rays do not tell to be wrong.
    pub(super) of_leaves: Vec<usize>,
    pub(super) count: usize,
    /// All leaves together.
    pub(super) all: FluxEstimate,
}

/// Sums of estimates over all places of a tree, with pooled variances.
fn sums(tree: &EnclosureTree<'_>, leaves: &[u32], estimates: &[FluxEstimate]) -> Vec<FluxEstimate> {
    let mut of = vec![FluxEstimate::default(); tree.len()];
    for (leaf, estimate) in leaves.iter().zip(estimates) {
        of[tree.place_of(*leaf)] = *estimate;
    }
    for place in (0..tree.len()).rev() {
        for child in tree.children(place) {
            let (child, sum) = (of[child], &mut of[place]);
            sum.by_elements += child.by_elements;
            sum.by_rays += child.by_rays;
            sum.variance += child.variance;
            sum.rays += child.rays;
        }
    }
    for place in 0..tree.len() {
        let larger = of[place];
        tree.children(place).for_each(|child| of[child].pool_variance(&larger));
    }
    of
}

/// For each leaf, by what its light is multiplied so that all places of a tree receive what rays tell, as far as that is
/// certain.
///
/// From each enclosure down, the factors of the children of a place differ as rays tell, times a part that is the nearer to 1
/// the less chance explains the difference, and together the children receive what the place does.
///
/// - `leaves`: their nodes. `estimates`: what each receives.
/// - `caution`: so many times what chance explains of a difference is taken from it; the more, the better elements know.
///
/// # Source
/// The part: James and Stein 1961.
pub(super) fn factors(tree: &EnclosureTree<'_>, leaves: &[u32], estimates: &[FluxEstimate], caution: f64) -> Vec<f64> {
    let of = sums(tree, leaves, estimates);
    let mut factor = vec![1.0; tree.len()];
    let certain = |parts: f64, surprise: f64| (1.0 - caution * parts / surprise).max(0.0);
    for place in tree.roots().filter(|place| of[*place].by_elements > 0.0) {
        let off = of[place].factor() - 1.0;
        factor[place] = 1.0 + off * certain(1.0, (off / of[place].error()).powi(2));
    }
    for place in tree.roots().next().unwrap_or(0)..tree.len() {
        let lit = || tree.children(place).filter(|child| of[*child].by_elements > 0.0);
        // Off the place as rays tell it: what children receive together is then what the place does.
        let off = |child: usize| of[child].factor() - of[place].factor();
        let surprise: f64 = lit().map(|child| (off(child) / of[child].error()).powi(2)).sum();
        let is_known = lit().all(|child| of[child].relative_error() <= MOST_PART_ERROR);
        let part = if is_known { certain(lit().count() as f64 - 1.0, surprise) } else { 0.0 };
        lit().for_each(|child| factor[child] = (factor[place] + off(child) * part).max(0.0));
    }
    leaves.iter().map(|leaf| factor[tree.place_of(*leaf)]).collect()
}

impl Regions {
    /// Divides the scene, from all of it down, into enclosures, and wherever rays tell with certainty that parts differ.
    ///
    /// - `leaves`: their nodes. `estimates`: what each receives.
    pub(super) fn new(tree: &EnclosureTree<'_>, leaves: &[u32], estimates: &[FluxEstimate]) -> Regions {
        let of = sums(tree, leaves, estimates);
        // The region of a place, or that of its parent, whose light is wrong by another factor; of all, by none.
        let region_of = |place: usize, within: Option<usize>| {
            let known = within.map_or(1.0, |region| of[region].factor());
            let error = of[place].error();
            let difference = (of[place].factor() - known).abs();
            let significant = if error <= CERTAIN { 1.0 } else { SIGNIFICANT };
            let differs = || difference > (significant * error).max(LEAST_DIFFERENCE);
            let is_apart = error <= MOST_ERROR && (tree.is_enclosure(place) || differs());
            if is_apart { Some(place) } else { within }
        };
        let mut region = vec![None; tree.len()];
        if !region.is_empty() {
            region[0] = region_of(0, None);
        }
        for place in 0..tree.len() {
            for child in tree.children(place) {
                region[child] = region_of(child, region[place]);
            }
        }
        let (mut number, mut count) = (vec![usize::MAX; tree.len()], 1);
        let mut of_leaf = |leaf: &u32| {
            let Some(region) = region[tree.place_of(*leaf)] else { return 0 };
            if number[region] == usize::MAX {
                (number[region], count) = (count, count + 1);
            }
            number[region]
        };
        let of_leaves = leaves.iter().map(&mut of_leaf).collect();
        Regions { of_leaves, count, all: of.first().copied().unwrap_or_default() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::hierarchy::Hierarchy;
    use super::super::node::RadiosityPatch;
    use super::super::shortest_edges::ShortestEdges;
    use super::*;
    use glam::DVec3;

    /// Triangles side by side, and the nodes that are leaves.
    fn row(count: u32) -> (Hierarchy, Vec<u32>) {
        let patch = |triangle: u32| {
            let at = DVec3::X * f64::from(triangle);
            RadiosityPatch { corners: [at, at + DVec3::X, at + DVec3::Y], triangle, outside: true }
        };
        let hierarchy = Hierarchy::new((0..count).map(patch).collect(), &ShortestEdges::everywhere(1e-9), |_| false);
        let leaves = hierarchy.leaves();
        (hierarchy, leaves)
    }

    #[test]
    fn light_is_corrected_where_rays_are_certain_and_only_there() {
        let (hierarchy, leaves) = row(64);
        let tree = EnclosureTree::new(&hierarchy, &leaves, &vec![0; leaves.len()]);
        let estimate =
            |by_rays: f64, error: f64| FluxEstimate { by_elements: 1.0, by_rays, variance: error * error, rays: 100 };
        let near = |leaf: u32| hierarchy.nodes[leaf as usize].middle.x < 32.0;
        // Half of it has 20 % too little light.
        let half = |error: f64| -> Vec<FluxEstimate> {
            leaves.iter().map(|leaf| estimate(if near(*leaf) { 1.2 } else { 1.0 }, error)).collect()
        };
        let certain = factors(&tree, &leaves, &half(0.01), 2.0);
        let off = |(leaf, factor): (&u32, &f64)| (factor - if near(*leaf) { 1.2 } else { 1.0 }).abs();
        assert!(leaves.iter().zip(&certain).map(off).fold(0.0, f64::max) < 0.01, "{certain:?}");
        let regions = Regions::new(&tree, &leaves, &half(0.01));
        let [one, other] = [true, false].map(|side| {
            let of: Vec<usize> = leaves
                .iter()
                .zip(&regions.of_leaves)
                .filter(|(leaf, _)| near(**leaf) == side)
                .map(|(_, r)| *r)
                .collect();
            assert!(of.iter().all(|region| *region == of[0]));
            of[0]
        });
        assert!(one != other);
        assert!(factors(&tree, &leaves, &half(3.0), 2.0).iter().all(|factor| *factor == 1.0));
    }

    #[test]
    fn a_leaf_that_few_rays_found_bright_stays_as_it_is() {
        let (hierarchy, leaves) = row(64);
        let tree = EnclosureTree::new(&hierarchy, &leaves, &vec![0; leaves.len()]);
        // Three rays of a bright place hit one leaf instead of the one in three that are expected.
        let of = |i: usize| match i {
            17 => FluxEstimate { by_elements: 1.0, by_rays: 9.0, variance: 27.0, rays: 100 },
            _ => FluxEstimate { by_elements: 1.0, by_rays: 1.0, variance: 1e-4, rays: 100 },
        };
        let estimates: Vec<FluxEstimate> = (0..leaves.len()).map(of).collect();
        let factors = factors(&tree, &leaves, &estimates, 2.0);
        assert!(factors.iter().all(|factor| (factor - 1.0).abs() < 0.05), "{factors:?}");
    }

    #[test]
    fn corrected_leaves_receive_together_what_rays_tell() {
        let (hierarchy, leaves) = row(100);
        let tree = EnclosureTree::new(&hierarchy, &leaves, &vec![0; leaves.len()]);
        let light = |i: usize| 1.0 + 0.9 * (i as f64 * 0.7).sin();
        let estimates: Vec<FluxEstimate> = (0..leaves.len())
            .map(|i| FluxEstimate {
                by_elements: light(i),
                by_rays: 1.1 * light(3 * i),
                variance: 1e-4 * light(i),
                rays: 100,
            })
            .collect();
        let factors = factors(&tree, &leaves, &estimates, 2.0);
        let sum: f64 = factors.iter().zip(&estimates).map(|(factor, estimate)| factor * estimate.by_elements).sum();
        let rays: f64 = estimates.iter().map(|estimate| estimate.by_rays).sum();
        assert!((sum / rays - 1.0).abs() < 1e-3, "{sum} {rays}");
        let none = vec![FluxEstimate::default(); leaves.len()];
        assert!(super::factors(&tree, &leaves, &none, 2.0).iter().all(|factor| *factor == 1.0));
    }
}
