//! Productions as they stand in a grammar.

use super::alphabet::ModuleWord;
use super::error::TextPlace;
use super::formula::Formula;

/// Most parameters of all modules to which a production looks.
pub(super) const MOST_FORMALS: usize = 32;
/// Most modules of a context, brackets included.
pub(super) const MOST_CONTEXT: usize = 64;

/// A production: what a module turns into, where, when and how probably.
#[derive(Clone, Debug)]
pub(super) struct GrammarProduction {
    pub place: TextPlace,
    /// The kind of the strict predecessor.
    pub predecessor: u8,
    /// Kinds on the way from the predecessor to the root, the nearest first.
    pub left: Vec<u8>,
    /// Kinds on the way from the predecessor to the tips, with brackets around those of side branches.
    pub right: Vec<u8>,
    /// Whether it holds; always without one. Formal parameters are counted over the predecessor, then over the left
    /// context and then over the right one, both as they stand in the text.
    pub condition: Option<Formula>,
    pub probability: Option<Formula>,
    pub successor: ModuleWord,
}

/// Productions of one purpose, in the order of the text.
#[derive(Clone, Debug, Default)]
pub(super) struct ProductionSet {
    pub productions: Vec<GrammarProduction>,
    /// How often they apply to what they made themselves; none where the grammar does not say.
    pub depth: Option<u32>,
}
