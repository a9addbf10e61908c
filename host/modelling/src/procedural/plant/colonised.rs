//! The skeleton of space colonisation as stems: paths of branches with their radii.

use super::axis::StemAxis;
use super::colonisation::{Colonisation, SkeletonNode, skeleton};
use super::error::PlantError;
use super::frame::StemFrame;
use super::grower::Grower;
use super::instant::grown;
use super::parameters::TreeNumber;
use super::stem::Stem;
use super::taper::flared;
use crate::numeric::sampling::mix;
use crate::procedural::drawing::CrossSection;
use glam::{DMat3, DVec3};

/// Radius of the thinnest twig, in parts of the radius of the trunk.
const TWIG: f64 = 0.02;
/// Pieces of branches that bear no more tips than this bear organs.
const LEAFY_TIPS: f64 = 4.0;
/// So many of these pieces bear as many organs as a stem of the last level.
const LEAFY_PIECES: f64 = 6.0;
/// The last branch is born when this part of the growth is over.
const LAST_BIRTH: f64 = 0.75;

impl Grower<'_> {
    /// Lets a tree grow whose crown is filled by space colonisation.
    pub fn colonised(&mut self, colonisation: &Colonisation, seed: u32) -> Result<(), PlantError> {
        let height = self.number(TreeNumber::Height);
        let nodes = skeleton(colonisation, self.model.shape, height, self.number(TreeNumber::Base), seed);
        let paths = Paths::new(&nodes, colonisation.exponent);
        let positions = self.grown_positions(&nodes);
        let trunk = self.number(TreeNumber::Ratio) * height * grown(self.instant.age, 0.0);
        let largest = paths.radii[0].max(1e-300);
        for (number, path) in paths.all.iter().enumerate() {
            self.count()?;
            let places: Vec<DVec3> = path.iter().map(|node| positions[*node as usize]).collect();
            let length: f64 = places.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            if places.len() < 2 || length <= 0.0 {
                continue;
            }
            let key = mix(mix(u64::from(seed)) ^ number as u64);
            let radius = |place: usize| {
                // A branch begins as thick as it goes on.
                let node = path[if number > 0 { place.max(1) } else { place }];
                let of_height = positions[node as usize].y / height;
                let flare = if number == 0 { flared(self.number(TreeNumber::Flare), of_height) } else { 1.0 };
                trunk * flare * (paths.radii[node as usize] / largest).max(TWIG)
            };
            let axis = axis(&places);
            let radii: Vec<f64> = (0..places.len()).map(radius).collect();
            self.draw_path(&axis, &radii, key, number > 0)?;
            let leafy = path.iter().filter(|node| paths.tips[**node as usize] <= LEAFY_TIPS).count();
            let twig = &places[places.len() - (leafy + 1).min(places.len())..];
            let stem = Stem {
                level: 0,
                key,
                length,
                growth: 1.0,
                birth: 0.0,
                radius: radii[radii.len() - 1],
                abundance: 1.0,
                foliage: leafy as f64 / LEAFY_PIECES,
            };
            self.organs_on(&stem, &self::axis(twig))?;
        }
        Ok(())
    }

    /// Where nodes are at the age of the tree: pieces of branches grow one after another.
    fn grown_positions(&self, nodes: &[SkeletonNode]) -> Vec<DVec3> {
        let mut depths = vec![0_u32; nodes.len()];
        for number in 1..nodes.len() {
            depths[number] = depths[nodes[number].parent as usize] + 1;
        }
        let deepest = f64::from(depths.iter().copied().max().unwrap_or(1).max(1));
        let mut positions: Vec<DVec3> = Vec::with_capacity(nodes.len());
        for (node, depth) in nodes.iter().zip(&depths) {
            let birth = LAST_BIRTH * f64::from(*depth) / deepest;
            let from = positions.get(node.parent as usize).copied().unwrap_or(node.position);
            let step = node.position - nodes[node.parent as usize].position;
            positions.push(from + step * grown(self.instant.age, birth));
        }
        positions
    }

    /// Draws a path of branches, thin ones fewer and wider.
    fn draw_path(&mut self, axis: &StemAxis, radii: &[f64], key: u64, may_miss: bool) -> Result<(), PlantError> {
        let wider = match self.thinned(2.0 * radii[0], key) {
            None if may_miss => return Ok(()),
            kept => kept.unwrap_or(1.0),
        };
        let nodes: Vec<(DVec3, f64)> =
            axis.frames.iter().zip(radii).map(|(frame, radius)| (frame.at, radius * wider)).collect();
        self.stroke(&nodes, CrossSection::Round)
    }
}

/// An axis through places.
fn axis(places: &[DVec3]) -> StemAxis {
    let ahead = |place: usize| {
        let [from, to] = [place.min(places.len() - 2), (place + 1).min(places.len() - 1)];
        (places[to] - places[from]).normalize_or(DVec3::Y)
    };
    let upright = StemFrame { at: places[0], axes: DMat3::IDENTITY };
    let frames: Vec<StemFrame> =
        places.iter().enumerate().map(|(place, at)| StemFrame { at: *at, ..upright.heading(ahead(place)) }).collect();
    let segments = frames.len() - 1;
    StemAxis::new(ahead(0), frames, 0, segments)
}

/// A skeleton as paths: each node goes on with the thickest of its branches; others begin paths of their own.
struct Paths {
    all: Vec<Vec<u32>>,
    /// Of each node, as the pipe model tells: that of a tip is 1.
    radii: Vec<f64>,
    /// How many tips each node bears.
    tips: Vec<f64>,
}

impl Paths {
    fn new(nodes: &[SkeletonNode], exponent: f64) -> Paths {
        let mut sums = vec![0.0_f64; nodes.len()];
        let mut radii = vec![0.0; nodes.len()];
        let mut thickest = vec![(0.0, 0_u32); nodes.len()];
        for number in (0..nodes.len()).rev() {
            let own = if sums[number] > 0.0 { sums[number] } else { 1.0 };
            sums[number] = own;
            radii[number] = own.powf(exponent.recip());
            let parent = nodes[number].parent as usize;
            if parent != number {
                sums[parent] += own;
                if own >= thickest[parent].0 {
                    thickest[parent] = (own, number as u32);
                }
            }
        }
        let mut all: Vec<Vec<u32>> = Vec::new();
        let mut path_of = vec![0; nodes.len()];
        for number in 0..nodes.len() as u32 {
            let parent = nodes[number as usize].parent;
            let goes_on = number > 0 && thickest[parent as usize].1 == number;
            if goes_on {
                path_of[number as usize] = path_of[parent as usize];
            } else {
                path_of[number as usize] = all.len();
                all.push(if number == 0 { Vec::new() } else { vec![parent] });
            }
            all[path_of[number as usize]].push(number);
        }
        Paths { all, radii, tips: sums }
    }
}
