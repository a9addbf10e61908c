//! The kinds of modules of a grammar, and strings of modules.

use super::error::{GrammarProblem, TextPlace};
use super::formula::Formula;
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// Most kinds of modules of a grammar.
const MOST_KINDS: usize = 256;
/// Most parameters of a module.
pub(super) const MOST_PARAMETERS: usize = 16;
/// The kind of `[`.
pub(super) const OPEN: u8 = 0;
/// The kind of `]`.
pub(super) const CLOSE: u8 = 1;

/// A letter or name with a number of parameters: modules that differ in either are of different kinds.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct ModuleKind {
    pub name: String,
    pub arity: u8,
}

/// All kinds of modules of a grammar, by their numbers.
#[derive(Clone, Debug)]
pub(super) struct Alphabet {
    kinds: Vec<ModuleKind>,
    numbers: HashMap<ModuleKind, u8>,
}

impl Alphabet {
    /// The brackets alone.
    pub fn new() -> Alphabet {
        let mut alphabet = Alphabet { kinds: Vec::new(), numbers: HashMap::new() };
        for bracket in ["[", "]"] {
            // There is room for two.
            let _ = alphabet.number(bracket, 0);
        }
        alphabet
    }

    /// The number of a kind, a new one if it is not known.
    ///
    /// # Errors
    /// More kinds than numbers.
    pub fn number(&mut self, name: &str, arity: usize) -> Result<u8, GrammarProblem> {
        let kind = ModuleKind { name: name.to_owned(), arity: arity as u8 };
        if let Some(number) = self.numbers.get(&kind) {
            return Ok(*number);
        }
        if self.kinds.len() == MOST_KINDS {
            return Err(GrammarProblem::TooMany { what: "kinds of modules", most: MOST_KINDS });
        }
        let number = self.kinds.len() as u8;
        self.kinds.push(kind.clone());
        self.numbers.insert(kind, number);
        Ok(number)
    }

    /// The kinds by their numbers.
    pub fn kinds(&self) -> &[ModuleKind] {
        &self.kinds
    }

    /// A number for each kind, and one more for each number without a kind.
    pub fn table<T: Copy>(&self, otherwise: T, of: impl Fn(&ModuleKind) -> T) -> Box<[T; MOST_KINDS]> {
        let mut table = Box::new([otherwise; MOST_KINDS]);
        for (kind, entry) in self.kinds.iter().zip(table.iter_mut()) {
            *entry = of(kind);
        }
        table
    }
}

/// Modules with formulas for their parameters: a successor or an axiom.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ModuleWord {
    pub modules: Vec<u8>,
    /// The parameters of all modules, one after the other.
    pub arguments: Vec<Formula>,
    pub place: TextPlace,
}

impl ModuleWord {
    /// The word with numbers for constants and parameters of the grammar.
    pub fn bound(&self, globals: &[f64]) -> ModuleWord {
        let arguments = self.arguments.iter().map(|formula| formula.bound(globals)).collect();
        ModuleWord { modules: self.modules.clone(), arguments, place: self.place }
    }
}

/// A string of modules as a derivation makes it: a byte for each module, and beside them their parameters.
///
/// It is written as grammars write it: `F(1)[+A(2)]`.
#[derive(Clone)]
pub struct ModuleString {
    pub(super) alphabet: Arc<Alphabet>,
    pub(super) modules: Vec<u8>,
    /// The parameters of all modules, one after the other.
    pub(super) parameters: Vec<f64>,
}

impl ModuleString {
    /// How many modules there are; brackets count as modules.
    pub fn len(&self) -> usize {
        self.modules.len()
    }

    /// Whether there is no module.
    pub fn is_empty(&self) -> bool {
        self.modules.is_empty()
    }

    /// The parameters of all modules, one after the other.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// How many modules bear a name, with any number of parameters.
    pub fn count(&self, name: &str) -> usize {
        let bears = self.alphabet.table(false, |kind| kind.name == name);
        self.modules.iter().filter(|kind| bears[usize::from(**kind)]).count()
    }

    /// The modules in their order: the name of each and its parameters.
    pub fn modules(&self) -> impl Iterator<Item = (&str, &[f64])> {
        let mut rest = &self.parameters[..];
        self.modules.iter().map(move |kind| {
            let ModuleKind { name, arity } = &self.alphabet.kinds[usize::from(*kind)];
            let (own, others) = rest.split_at(usize::from(*arity));
            rest = others;
            (name.as_str(), own)
        })
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (self.modules.len() + size_of::<f64>() * self.parameters.len()) as u64
    }
}

impl PartialEq for ModuleString {
    fn eq(&self, other: &ModuleString) -> bool {
        self.alphabet.kinds == other.alphabet.kinds
            && self.modules == other.modules
            && self.parameters == other.parameters
    }
}

impl fmt::Display for ModuleString {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, parameters) in self.modules() {
            formatter.write_str(name)?;
            for (index, parameter) in parameters.iter().enumerate() {
                write!(formatter, "{}{parameter}", if index == 0 { '(' } else { ',' })?;
            }
            if !parameters.is_empty() {
                formatter.write_str(")")?;
            }
        }
        Ok(())
    }
}

impl fmt::Debug for ModuleString {
    /// Says how long it is: strings may have millions of modules.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} modules", self.modules.len())
    }
}
