//! The corpus of Boolean operations against its table, which may only improve.

use std::{collections::BTreeMap, time::Duration};
use tests::corpus::{CLASSES, Score, score};

/// Longest time for a case.
const LIMIT: Duration = Duration::from_secs(60);

const TABLE: &str = include_str!("../corpus/boolean.txt");

/// What the table says.
#[derive(Default)]
struct Table {
    /// Counts by class.
    counts: BTreeMap<&'static str, Vec<u32>>,
    /// Cases that do not pass, with how they end.
    listed: BTreeMap<(&'static str, u32), &'static str>,
}

fn table() -> Table {
    let Table { mut counts, mut listed } = Table::default();
    for line in TABLE.lines().filter(|line| !line.starts_with('#')) {
        let class = CLASSES.iter().find(|c| line.starts_with(c.name)).expect("the table names a class");
        let words: Vec<&str> = line[class.name.len()..].split_whitespace().collect();
        match words[..] {
            [number, word] => _ = listed.insert((class.name, number.parse().expect("a number")), word),
            _ => _ = counts.insert(class.name, words.iter().map(|w| w.parse().expect("a number")).collect()),
        }
    }
    Table { counts, listed }
}

#[test]
fn the_table_is_that_of_the_classes_and_nothing_in_it_is_wrong() {
    let Table { counts, listed } = table();
    let (mut all, mut passed) = (0, 0);
    for class in CLASSES {
        let row = &counts[class.name];
        let refused = listed.keys().filter(|(name, _)| *name == class.name).count() as u32;
        assert_eq!(row[..], [class.cases, class.cases - refused, refused, 0, 0, 0], "{}", class.name);
        (all, passed) = (all + row[0], passed + row[1]);
    }
    assert!(all >= 1000 && passed * 100 >= all * 99, "{passed} of {all}");
    assert!(listed.values().all(|word| *word == "refused"));
}

/// Every case with `PERIS_LONG=1`; one in sixteen without, and half a dozen of large classes.
#[test]
fn cases_end_as_the_table_says_or_better() {
    let is_long = std::env::var("PERIS_LONG").is_ok_and(|long| long == "1");
    let listed = table().listed;
    let mut worse = Vec::new();
    for class in CLASSES {
        let step = if is_long { 1 } else { (class.cases / 5).max(16) };
        for number in (0..class.cases).step_by(step as usize) {
            let found = score(class, number, LIMIT);
            let known = listed.get(&(class.name, number));
            if found != Score::Passed && known != Some(&found.word()) {
                worse.push(format!("{} {number}: {found:?}", class.name));
            } else if found == Score::Passed && known.is_some() {
                println!("{} {number} passes now: take it off the table", class.name);
            }
        }
    }
    assert!(worse.is_empty(), "{} worse:\n{}", worse.len(), worse.join("\n"));
}
