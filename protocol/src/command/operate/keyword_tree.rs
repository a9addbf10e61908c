//! The keyword tree: the words that commands begin with, and which command they lead to.

use crate::command::{error::Fault, parse::cursor::Parser, words::Word};

/// Most words of all beginnings together.
const MAX_KEYWORDS: usize = 128;

/// The dead end: the node that nothing leads to, and which leads nowhere.
const DEAD_END: u8 = MAX_KEYWORDS as u8 - 1;

/// What is expected after SET, which too many words can follow to list them.
const SETTING: (Word, &[&str]) = (Word::Set, &["a setting (such as COLOR)"]);

/// A tree of words, made when the code is built: from the words that were read to those that can follow.
pub(super) struct KeywordTree {
    /// The words that can follow, those after one node together.
    words: [Word; MAX_KEYWORDS],
    /// Each of these words as an error says it.
    names: [&'static str; MAX_KEYWORDS],
    /// The node that each of these words leads to.
    targets: [u8; MAX_KEYWORDS],
    nodes: [Node; MAX_KEYWORDS],
    /// The node after each first word; an empty one after a word that begins no command.
    firsts: [u8; Word::ALL.len()],
}

/// Where some first words lead.
#[derive(Clone, Copy)]
struct Node {
    /// The words that can follow are from here...
    begin: u8,
    /// ...up to here.
    end: u8,
    /// The beginning that the words so far are, if they are a complete one.
    complete: Option<u8>,
}

impl KeywordTree {
    /// The tree of some beginnings.
    pub(super) const fn new(beginnings: &[&[Word]]) -> KeywordTree {
        let node = Node { begin: 0, end: 0, complete: None };
        let mut leads = KeywordTree {
            words: [Word::Set; MAX_KEYWORDS],
            names: [""; MAX_KEYWORDS],
            targets: [0; MAX_KEYWORDS],
            nodes: [node; MAX_KEYWORDS],
            firsts: [DEAD_END; Word::ALL.len()],
        };
        // A beginning of each node, and how many of its words lead there.
        let mut samples = [(0, 0); MAX_KEYWORDS];
        let (mut nodes, mut words) = (1, 0);
        let mut at = 0;
        while at < nodes {
            let (sample, depth) = samples[at];
            leads.nodes[at].begin = words as u8;
            let mut index = 0;
            while index < beginnings.len() {
                let beginning = beginnings[index];
                if begin_alike(beginning, beginnings[sample], depth) {
                    if beginning.len() == depth {
                        assert!(leads.nodes[at].complete.is_none(), "two commands begin with the same words");
                        leads.nodes[at].complete = Some(index as u8);
                    } else if !contains(&leads.words, leads.nodes[at].begin as usize, words, beginning[depth]) {
                        leads.words[words] = beginning[depth];
                        leads.names[words] = beginning[depth].capitals();
                        leads.targets[words] = nodes as u8;
                        samples[nodes] = (index, depth + 1);
                        (nodes, words) = (nodes + 1, words + 1);
                    }
                }
                index += 1;
            }
            leads.nodes[at].end = words as u8;
            at += 1;
        }
        assert!(nodes < MAX_KEYWORDS, "no room for more words");
        let mut first = 0;
        while first < leads.nodes[0].end as usize {
            leads.firsts[leads.words[first] as usize] = leads.targets[first];
            first += 1;
        }
        leads
    }

    /// The words that can follow a first word.
    pub(super) fn after(&self, first: Word) -> &[Word] {
        self.following(self.nodes[usize::from(self.firsts[first as usize])])
    }

    fn following(&self, node: Node) -> &[Word] {
        &self.words[usize::from(node.begin)..usize::from(node.end)]
    }

    /// Takes the words that belong to the beginning of a command, and gives the index of that beginning.
    ///
    /// - `first`: the first word, which was just taken.
    ///
    /// # Errors
    /// [`Fault`] if a word is there that none of the beginnings has.
    pub(super) fn follow(&'static self, first: Word, parser: &mut Parser<'_>) -> Result<usize, Fault> {
        let mut node = self.nodes[usize::from(self.firsts[first as usize])];
        while node.begin < node.end {
            let words = self.following(node);
            let found = parser.accept_one_of(words).and_then(|found| words.iter().position(|word| *word == found));
            match (found, node.complete) {
                (Some(index), _) => node = self.nodes[usize::from(self.targets[usize::from(node.begin) + index])],
                (None, Some(_)) => break,
                (None, None) if first == SETTING.0 => return Err(parser.fail(SETTING.1)),
                (None, None) => return Err(parser.fail(&self.names[usize::from(node.begin)..usize::from(node.end)])),
            }
        }
        node.complete.map(usize::from).ok_or_else(|| parser.fail(&[]))
    }
}

/// Whether the first `count` words are the same.
const fn begin_alike(one: &[Word], other: &[Word], count: usize) -> bool {
    let mut at = 0;
    while at < count {
        if at >= one.len() || one[at] as usize != other[at] as usize {
            return false;
        }
        at += 1;
    }
    true
}

/// Whether `words` from `begin` up to `end` have a word.
const fn contains(words: &[Word], begin: usize, end: usize, word: Word) -> bool {
    let mut at = begin;
    while at < end {
        if words[at] as usize == word as usize {
            return true;
        }
        at += 1;
    }
    false
}
