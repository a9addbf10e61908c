//! What productions see of a string: the neighbours of a module, past brackets and past modules that contexts ignore.

use super::alphabet::{CLOSE, OPEN};
use super::production::MOST_CONTEXT;
use crate::memory::{self, MemoryExceeded};

/// No module.
const NONE: u32 = u32::MAX;

/// The neighbours of all modules of a string, so that a context is matched in a time that does not depend on how long
/// the branches are between its modules.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    /// The seen module before each one on the way to the root.
    left: Vec<u32>,
    /// The seen module after each one in its own branch; for `[` the first one in the branch that it begins.
    right: Vec<u32>,
    /// For `[` its `]`; empty where no context looks into branches.
    close: Vec<u32>,
    /// The first parameter of each module; empty where there are none.
    offsets: Vec<u32>,
}

/// A string while productions look at it.
#[derive(Clone, Copy)]
pub(super) struct StringView<'a> {
    pub modules: &'a [u8],
    pub parameters: &'a [f64],
    /// Parameters of a module by its kind.
    pub arities: &'a [u8; 256],
    /// Whether contexts see modules of a kind.
    pub is_seen: &'a [bool; 256],
    /// None where no context looks at neighbours.
    pub neighbours: Option<&'a Neighbours>,
}

/// Places of the modules that match contexts.
pub(super) struct ContextMatch {
    pub places: [u32; 2 * MOST_CONTEXT],
    pub count: usize,
}

impl ContextMatch {
    fn push(&mut self, place: u32) {
        self.places[self.count] = place;
        self.count += 1;
    }
}

impl Neighbours {
    /// Finds the neighbours in two passes.
    ///
    /// - `sees_branches`: whether a context looks into side branches.
    ///
    /// # Errors
    /// Less memory than they take.
    pub fn of(view: &StringView, sees_branches: bool) -> Result<Neighbours, MemoryExceeded> {
        let count = view.modules.len();
        let tables = 2 + u64::from(sees_branches) + u64::from(!view.parameters.is_empty());
        // One more for the brackets that are open.
        let bytes = (tables + 1) * (count * size_of::<u32>()) as u64;
        memory::reserve(bytes, || format!("finding the neighbours of {count} modules"))?;
        let mut found = Neighbours { left: vec![NONE; count], right: vec![NONE; count], ..Neighbours::default() };
        let mut open: Vec<u32> = Vec::new();
        let mut last = NONE;
        for (at, kind) in view.modules.iter().enumerate() {
            found.left[at] = last;
            match *kind {
                OPEN => open.push(last),
                CLOSE => last = open.pop().unwrap_or(last),
                kind if view.is_seen[usize::from(kind)] => last = at as u32,
                _ => {}
            }
        }
        open.clear();
        if sees_branches {
            found.close = vec![NONE; count];
        }
        let mut closing: Vec<u32> = Vec::new();
        let mut next = NONE;
        for (at, kind) in view.modules.iter().enumerate().rev() {
            found.right[at] = next;
            match *kind {
                CLOSE => {
                    open.push(next);
                    next = NONE;
                    if sees_branches {
                        closing.push(at as u32);
                    }
                }
                OPEN => {
                    next = open.pop().unwrap_or(NONE);
                    if sees_branches {
                        found.close[at] = closing.pop().unwrap_or(NONE);
                    }
                }
                kind if view.is_seen[usize::from(kind)] => next = at as u32,
                _ => {}
            }
        }
        if !view.parameters.is_empty() {
            found.offsets.reserve_exact(count);
            let mut offset = 0;
            for kind in view.modules {
                found.offsets.push(offset);
                offset += u32::from(view.arities[usize::from(*kind)]);
            }
        }
        Ok(found)
    }
}

impl<'a> StringView<'a> {
    /// Whether any module has parameters.
    pub fn has_parameters(&self) -> bool {
        !self.parameters.is_empty()
    }

    /// The parameters of a module that matches a context.
    pub fn parameters_of(&self, at: usize) -> &'a [f64] {
        let Some(neighbours) = self.neighbours else { return &[] };
        let offset = neighbours.offsets[at] as usize;
        &self.parameters[offset..offset + usize::from(self.arities[usize::from(self.modules[at])])]
    }

    /// Whether these kinds, the nearest first, lie on the way from a module to the root; their places are noted in the
    /// order of the text, from the root.
    pub fn matches_left(&self, at: usize, context: &[u8], found: &mut ContextMatch) -> bool {
        let Some(neighbours) = self.neighbours else { return context.is_empty() };
        let mut place = at;
        for kind in context {
            let next = neighbours.left[place];
            if next == NONE || self.modules[next as usize] != *kind {
                return false;
            }
            found.push(next);
            place = next as usize;
        }
        found.places[..found.count].reverse();
        true
    }

    /// Whether a context lies after a module or, if the module is `[`, in the branch that it begins. What is in
    /// brackets is looked for in side branches, in their order; side branches that it does not name are passed over.
    pub fn matches_right(&self, at: usize, context: &[u8], found: &mut ContextMatch) -> bool {
        let Some(neighbours) = self.neighbours else { return context.is_empty() };
        // Where the next module follows, and from where side branches are looked for.
        let (mut place, mut from) = (at, at + 1);
        let mut rest = context;
        while let Some((kind, others)) = rest.split_first() {
            if *kind == OPEN {
                let end = partner(others);
                let Some(after) = self.matching_branch(neighbours, from, &others[..end], found) else { return false };
                from = after;
                rest = others.get(end + 1..).unwrap_or(&[]);
                continue;
            }
            let next = neighbours.right[place];
            if next == NONE || self.modules[next as usize] != *kind {
                return false;
            }
            found.push(next);
            (place, from) = (next as usize, next as usize + 1);
            rest = others;
        }
        true
    }

    /// Where the first side branch from a place on ends that begins with a context.
    fn matching_branch(
        &self,
        neighbours: &Neighbours,
        from: usize,
        context: &[u8],
        found: &mut ContextMatch,
    ) -> Option<usize> {
        let mut from = from;
        loop {
            match *self.modules.get(from)? {
                OPEN => {
                    let before = found.count;
                    if self.matches_right(from, context, found) {
                        return Some(neighbours.close[from] as usize + 1);
                    }
                    found.count = before;
                    from = neighbours.close[from] as usize + 1;
                }
                CLOSE => return None,
                kind if self.is_seen[usize::from(kind)] => return None,
                _ => from += 1,
            }
        }
    }
}

/// Where the bracket closes that was opened before a context.
fn partner(context: &[u8]) -> usize {
    let mut depth = 0_usize;
    for (at, kind) in context.iter().enumerate() {
        match *kind {
            OPEN => depth += 1,
            CLOSE if depth == 0 => return at,
            CLOSE => depth -= 1,
            _ => {}
        }
    }
    context.len()
}
