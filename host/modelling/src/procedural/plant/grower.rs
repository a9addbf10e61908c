//! A tree while it grows: its numbers, and what has been drawn of it.

use super::crown::PruningEnvelope;
use super::error::PlantError;
use super::instant::{PlantInstant, grown};
use super::parameters::{StemNumber, TREE_PARAMETERS, TreeNumber};
use super::tree_model::TreeModel;
use crate::numeric::sampling::RandomStream;
use crate::procedural::drawing::{CrossSection, PlantDrawing, Stroke, StrokeNode, append};
use crate::procedural::{Varied, channel};
use glam::DVec3;

/// Most stems of a tree.
const MOST_STEMS: usize = 1 << 22;
/// A node is left out if the stroke without it is off by less than this part of the detail.
const STRAIGHT: f64 = 0.25;
/// A stem is thin if its diameter is below this part of the detail.
const THIN: f64 = 0.5;
/// The coarsest detail of a tree, in parts of its height.
const COARSEST: f64 = 1.0 / 24.0;

/// A tree while it grows.
pub(super) struct Grower<'a> {
    pub model: &'a TreeModel,
    tree: [f64; TREE_PARAMETERS.len()],
    pub instant: PlantInstant,
    pub detail: f64,
    pub envelope: Option<PruningEnvelope>,
    pub drawing: PlantDrawing,
    stems: usize,
}

impl<'a> Grower<'a> {
    pub fn new(model: &'a TreeModel, seed: u32, instant: PlantInstant, detail: f64) -> Grower<'a> {
        let number = |k: usize| {
            let row = &TREE_PARAMETERS[k];
            model.numbers.tree_by_place(k).draw(seed, channel(row.name))
        };
        let tree: [f64; TREE_PARAMETERS.len()] = std::array::from_fn(number);
        let mut grower =
            Grower { model, tree, instant, detail, envelope: None, drawing: PlantDrawing::default(), stems: 0 };
        grower.detail = detail.min(grower.coarsest());
        if grower.number(TreeNumber::PruneRatio) > 0.0 {
            let height = grower.number(TreeNumber::Height);
            grower.envelope = Some(PruningEnvelope {
                height,
                base: grower.number(TreeNumber::Base) * height,
                width: grower.number(TreeNumber::PruneWidth),
                peak: grower.number(TreeNumber::PrunePeak),
                low: grower.number(TreeNumber::PruneLow),
                high: grower.number(TreeNumber::PruneHigh),
            });
        }
        grower
    }

    /// The coarsest detail at its age.
    pub fn coarsest(&self) -> f64 {
        self.number(TreeNumber::Height) * grown(self.instant.age, 0.0) * COARSEST
    }

    /// A number of this tree.
    pub fn number(&self, number: TreeNumber) -> f64 {
        self.tree[number as usize]
    }

    /// How many levels of stems it has.
    pub fn levels(&self) -> usize {
        self.number(TreeNumber::Levels).round() as usize
    }

    /// A number of a stem.
    pub fn draw(&self, level: usize, number: StemNumber, random: &mut RandomStream) -> f64 {
        drawn(self.model.numbers.stem(level, number), random)
    }

    /// How much wider a thin stem is drawn if it stays; none if it does not. Those that stay show in the mean as much as
    /// all.
    ///
    /// - `width`: its diameter. `key`: of the stem.
    pub fn thinned(&self, width: f64, key: u64) -> Option<f64> {
        let kept = (width / (THIN * self.detail)).min(1.0);
        (kept >= 1.0 || RandomStream::new(key, 4).uniform() < kept).then(|| kept.recip())
    }

    /// Counts a stem.
    pub fn count(&mut self) -> Result<(), PlantError> {
        self.stems += 1;
        if self.stems > MOST_STEMS { Err(PlantError::TooManyStems { most: MOST_STEMS }) } else { Ok(()) }
    }

    /// Appends a stroke through nodes.
    pub fn stroke(&mut self, nodes: &[(DVec3, f64)], section: CrossSection) -> Result<(), PlantError> {
        let first = self.drawing.nodes.len();
        for (position, radius) in simplified(nodes, STRAIGHT * self.detail) {
            append(&mut self.drawing.nodes, StrokeNode { position, radius, colour: 0 }, "stems")?;
        }
        append(&mut self.drawing.strokes, Stroke { first, section }, "stems")?;
        Ok(())
    }
}

/// A number that varies, drawn from a stream.
pub(super) fn drawn(varied: Varied, random: &mut RandomStream) -> f64 {
    varied.at(random.uniform())
}

/// A stroke with fewer nodes that is off by no more than a distance, in its axis and in its radius.
///
/// # Source
/// Ramer 1972; Douglas and Peucker 1973.
fn simplified(nodes: &[(DVec3, f64)], tolerance: f64) -> Vec<(DVec3, f64)> {
    let off = |[from, to]: [(DVec3, f64); 2], node: (DVec3, f64)| {
        let along = to.0 - from.0;
        let part = ((node.0 - from.0).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let part = if part.is_finite() { part } else { 0.0 };
        node.0.distance(from.0 + along * part) + (node.1 - from.1 - (to.1 - from.1) * part).abs()
    };
    let mut kept = vec![nodes[0]];
    // Pieces that are not yet looked at, the first of them last.
    let mut pieces = vec![(0, nodes.len() - 1)];
    while let Some((from, to)) = pieces.pop() {
        let worst = (from + 1..to).map(|node| (node, off([nodes[from], nodes[to]], nodes[node])));
        match worst.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((node, distance)) if distance > tolerance => pieces.extend([(node, to), (from, node)]),
            _ => kept.push(nodes[to]),
        }
    }
    kept
}
