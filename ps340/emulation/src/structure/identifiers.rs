//! The pick identifiers on the way to a point of the structure.

use protocol::Name;

/// The pick identifiers at a point of the structure: the nearest one of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identifiers(u32);

impl Identifiers {
    /// No identifier.
    pub const NONE: Identifiers = Identifiers(u32::MAX);
}

/// Every identifier that a walk met, with the one above it.
#[derive(Debug, Default)]
pub struct IdentifierChains<'a> {
    links: Vec<(&'a Name, Identifiers)>,
}

impl<'a> IdentifierChains<'a> {
    /// The chain with `name` below `above`.
    pub fn below(&mut self, above: Identifiers, name: &'a Name) -> Identifiers {
        self.links.push((name, above));
        Identifiers(self.links.len() as u32 - 1)
    }

    /// The names of a chain, nearest first.
    pub fn names(&self, mut at: Identifiers) -> Vec<Name> {
        let mut names = Vec::new();
        while let Some((name, above)) = self.links.get(at.0 as usize) {
            names.push((*name).clone());
            at = *above;
        }
        names
    }
}
