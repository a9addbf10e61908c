//! The inputs worth changing: those that showed something new.

use crate::chance::Chance;
use std::{
    collections::HashSet,
    hash::{DefaultHasher, Hash, Hasher},
};

/// Most inputs that are kept; then a new one takes the place of one drawn by lot.
const MOST_INPUTS: usize = 8_192;
/// Most things seen that are remembered.
const MOST_SEEN: usize = 1 << 20;

/// What could be observed while an input ran, as hashes: kinds of commands, messages, frames.
#[derive(Debug, Default)]
pub struct Features(HashSet<u64>);

impl Features {
    pub fn saw(&mut self, thing: impl Hash) {
        let mut hasher = DefaultHasher::new();
        thing.hash(&mut hasher);
        self.0.insert(hasher.finish());
    }

    /// A message without the names, numbers and quotations in it, which are without end.
    pub fn saw_message(&mut self, message: &str) {
        let mut plain = String::with_capacity(message.len());
        for word in message.split_ascii_whitespace().take(12) {
            let word = word.trim_end_matches([',', ';', ':', '.']);
            let ordinary = word.bytes().all(|byte| byte.is_ascii_lowercase());
            plain.push_str(if ordinary { word } else { "*" });
        }
        self.saw(("message", message.get(..4), plain));
    }

    /// An amount, by its order of magnitude.
    pub fn saw_amount(&mut self, of: &str, amount: u64) {
        self.saw((of, amount.checked_ilog2()));
    }
}

/// Inputs and what they showed.
#[derive(Debug, Default)]
pub struct InputPool {
    inputs: Vec<Vec<u8>>,
    seen: HashSet<u64>,
}

impl InputPool {
    /// Puts a seed in.
    pub fn plant(&mut self, input: Vec<u8>) {
        self.inputs.push(input);
    }

    /// Keeps an input that showed something new.
    pub fn learn(&mut self, input: &[u8], features: Features, chance: &mut Chance) {
        let before = self.seen.len();
        if before < MOST_SEEN {
            self.seen.extend(features.0);
        }
        if self.seen.len() == before {
            return;
        }
        if self.inputs.len() < MOST_INPUTS {
            self.inputs.push(input.to_vec());
        } else {
            let place = chance.below(MOST_INPUTS);
            self.inputs[place] = input.to_vec();
        }
    }

    /// One to change: half of the time one of the latest hundred.
    pub fn draw(&self, chance: &mut Chance) -> Vec<u8> {
        let latest = self.inputs.len().saturating_sub(100);
        let from = if chance.one_in(2) { latest } else { 0 };
        let place = from + chance.below(self.inputs.len() - from);
        self.inputs.get(place).cloned().unwrap_or_default()
    }

    pub fn len(&self) -> usize {
        self.inputs.len()
    }

    pub fn seen(&self) -> usize {
        self.seen.len()
    }
}
