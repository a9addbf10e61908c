//! Reading species from text: TOML, each fault with its place.

use super::colonisation::Colonisation;
use super::crown::CROWN_SHAPES;
use super::error::{SpeciesError, SpeciesProblem};
use super::organ::{BladeArrangement, ColourTrack, Organ, OrganPlace, OrganSeason};
use super::outline::{BladeOutline, OUTLINES};
use super::parameters::TreeNumbers;
use super::species::{BARK_PATTERNS, PublishedRange, Species, SpeciesPart, StemLook};
use super::tree_model::TreeModel;
use crate::procedural::Varied;
use crate::spelling;
use glam::DVec3;
use std::ops::Range;
use toml_edit::{Document, Item, TableLike};

/// What the literature may tell of a species.
const PUBLISHED: [&str; 3] = ["height", "crown_ratio", "branch_angle"];
/// Most blades of an organ.
const MOST_BLADES: f64 = 400.0;

/// A fault with the bytes at which it is, if that is known.
struct Fault {
    problem: SpeciesProblem,
    span: Option<Range<usize>>,
}

type Read<T> = Result<T, Fault>;

impl Species {
    /// Reads a species.
    ///
    /// # Errors
    /// The first fault, with its line and column.
    pub fn parse(text: &str) -> Result<Species, SpeciesError> {
        let placed = |problem: SpeciesProblem, span: Option<Range<usize>>| {
            let before = &text[..span.map_or(0, |span| span.start.min(text.len()))];
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
            SpeciesError { line, column, problem }
        };
        let document = Document::parse(text)
            .map_err(|error| placed(SpeciesProblem::Syntax(error.message().into()), error.span()))?;
        species(document.as_item()).map_err(|Fault { problem, span }| placed(problem, span))
    }
}

/// A table of which every key must be read.
struct Section<'a> {
    table: &'a dyn TableLike,
    span: Option<Range<usize>>,
    /// All keys that are asked for.
    known: Vec<&'static str>,
}

fn fault<T>(problem: SpeciesProblem, span: Option<Range<usize>>) -> Read<T> {
    Err(Fault { problem, span })
}

fn wrong_kind<T>(key: &str, expected: &'static str, item: &Item) -> Read<T> {
    fault(SpeciesProblem::Kind { key: key.into(), expected }, item.span())
}

impl<'a> Section<'a> {
    fn new(key: &str, item: &'a Item) -> Read<Section<'a>> {
        match item.as_table_like() {
            Some(table) => Ok(Section { table, span: item.span(), known: Vec::new() }),
            None => wrong_kind(key, "a table", item),
        }
    }

    fn get(&mut self, key: &'static str) -> Option<&'a Item> {
        self.known.push(key);
        self.table.get(key)
    }

    fn required(&mut self, key: &'static str) -> Read<&'a Item> {
        match self.get(key) {
            Some(item) => Ok(item),
            None => fault(SpeciesProblem::Missing(key), self.span.clone()),
        }
    }

    /// A number in a range, or what it is without a word.
    fn number(&mut self, key: &'static str, default: f64, range: [f64; 2], expected: &'static str) -> Read<f64> {
        let Some(item) = self.get(key) else { return Ok(default) };
        match number(item) {
            Some(value) if value >= range[0] && value <= range[1] => Ok(value),
            _ => wrong_kind(key, expected, item),
        }
    }

    /// A number that varies, or what it is without a word.
    fn varied(&mut self, key: &'static str, default: f64) -> Read<Varied> {
        match self.get(key) {
            Some(item) => varied(key, item),
            None => Ok(Varied { mean: default, deviation: 0.0 }),
        }
    }

    /// One of several words, or what it is without a word.
    fn word<T: Copy>(&mut self, key: &'static str, words: &[(&str, T)], default: T) -> Read<T> {
        let Some(item) = self.get(key) else { return Ok(default) };
        let Some(word) = item.as_str() else { return wrong_kind(key, "a word in quotes", item) };
        match words.iter().find(|(known, _)| *known == word) {
            Some((_, value)) => Ok(*value),
            None => {
                let known: Vec<&str> = words.iter().map(|(known, _)| *known).collect();
                unknown(key, word, &known, item.span())
            }
        }
    }

    /// Refuses keys that nobody asked for.
    fn end(&self) -> Read<()> {
        for (key, item) in self.table.iter() {
            if !self.known.contains(&key) {
                let span = self.table.key(key).and_then(|key| key.span()).or_else(|| item.span());
                return unknown("key", key, &self.known, span);
            }
        }
        Ok(())
    }
}

fn unknown<T>(what: &'static str, name: &str, known: &[&str], span: Option<Range<usize>>) -> Read<T> {
    let advice = spelling::advice(name, known);
    fault(SpeciesProblem::Unknown { what, name: name.into(), advice }, span)
}

fn number(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|whole| whole as f64)).filter(|value| value.is_finite())
}

/// The items of an array.
fn items(item: &Item) -> Option<Vec<Item>> {
    item.as_array().map(|array| array.iter().map(|value| Item::Value(value.clone())).collect())
}

/// A number, or a mean and a largest deviation.
fn varied(key: &str, item: &Item) -> Read<Varied> {
    let expected = "a number, or a mean with a deviation as [10, 2]";
    let value = match (number(item), items(item)) {
        (Some(mean), _) => Varied { mean, deviation: 0.0 },
        (None, Some(both)) if both.len() == 2 => match (number(&both[0]), number(&both[1])) {
            (Some(mean), Some(deviation)) => Varied { mean, deviation },
            _ => return wrong_kind(key, expected, item),
        },
        _ => return wrong_kind(key, expected, item),
    };
    match value.check() {
        Ok(()) => Ok(value),
        Err(problem) => fault(SpeciesProblem::Varied { key: key.into(), problem }, item.span()),
    }
}

/// Numbers that are as many as asked for.
fn numbers<const N: usize>(key: &str, expected: &'static str, item: &Item) -> Read<[f64; N]> {
    let all: Option<Vec<f64>> = items(item).and_then(|all| all.iter().map(number).collect());
    match all.map(<[f64; N]>::try_from) {
        Some(Ok(all)) => Ok(all),
        _ => wrong_kind(key, expected, item),
    }
}

/// A reflectance, linear sRGB.
fn colour(key: &str, item: &Item) -> Read<DVec3> {
    let expected = "a colour of three numbers from 0 to 1";
    let colour = DVec3::from_array(numbers(key, expected, item)?);
    if colour.cmpge(DVec3::ZERO).all() && colour.cmple(DVec3::ONE).all() {
        Ok(colour)
    } else {
        wrong_kind(key, expected, item)
    }
}

fn species(item: &Item) -> Read<Species> {
    let mut section = Section::new("species", item)?;
    let name = section.required("name")?;
    let Some(name) = name.as_str() else { return wrong_kind("name", "a text in quotes", name) };
    let published = section.get("published").map_or(Ok(Vec::new()), published)?;
    let trees = section.required("tree")?;
    let parts = match trees.as_array_of_tables() {
        Some(tables) => tables.iter().map(|table| part(&Item::Table(table.clone()))).collect::<Read<Vec<_>>>()?,
        None => vec![part(trees)?],
    };
    section.end()?;
    Ok(Species { name: name.into(), published, parts })
}

fn published(item: &Item) -> Read<Vec<PublishedRange>> {
    let mut section = Section::new("published", item)?;
    let mut ranges = Vec::new();
    for what in PUBLISHED {
        if let Some(item) = section.get(what) {
            let range = numbers(what, "the least and the most, as [20, 35]", item)?;
            ranges.push(PublishedRange { what: what.into(), range });
        }
    }
    section.get("source");
    section.end()?;
    Ok(ranges)
}

fn part(item: &Item) -> Read<SpeciesPart> {
    let mut section = Section::new("tree", item)?;
    let shape = section.word("shape", &CROWN_SHAPES, Default::default())?;
    let stem = stem_look(section.get("stem"))?;
    let colonisation = section.get("colonisation").map(colonisation).transpose()?;
    let mut organs: Vec<Organ> = Vec::new();
    if let Some(tables) = section.get("organ") {
        let Some(tables) = tables.as_array_of_tables() else {
            return wrong_kind("organ", "a list of tables, each after [[tree.organ]]", tables);
        };
        for table in tables {
            let organ = organ(&Item::Table(table.clone()), &organs)?;
            organs.push(organ);
        }
    }
    let mut numbers = TreeNumbers::default();
    for (key, item) in section.table.iter().filter(|(key, _)| !section.known.contains(key)) {
        let values = match items(item) {
            Some(levels) if is_row_of_levels(key) => {
                levels.iter().map(|value| varied(key, value)).collect::<Read<Vec<_>>>()?
            }
            _ => vec![varied(key, item)?],
        };
        let span = section.table.key(key).and_then(|key| key.span()).or_else(|| item.span());
        numbers.set(key, &values).map_err(|error| Fault { problem: error.into(), span })?;
    }
    Ok(SpeciesPart { tree: TreeModel { shape, numbers, organs, colonisation }, stem })
}

fn colonisation(item: &Item) -> Read<Colonisation> {
    let mut section = Section::new("colonisation", item)?;
    let colonisation = Colonisation {
        points: section.number("points", 2000.0, [1.0, 1e5], "a whole number from 1 to 100000")? as u32,
        width: section.number("width", 0.35, [1e-3, 100.0], "a number above 0 and up to 100")?,
        step: section.number("step", 0.015, [1e-3, 1.0], "a number from 0.001 to 1")?,
        reach: section.number("reach", 12.0, [1.0, 1000.0], "a number from 1 to 1000")?,
        kill: section.number("kill", 2.5, [1.0, 1000.0], "a number from 1 to 1000")?,
        exponent: section.number("exponent", 2.3, [1.0, 10.0], "a number from 1 to 10")?,
        tropism: section.number("tropism", 0.1, [-10.0, 10.0], "a number from -10 to 10")?,
    };
    section.end()?;
    Ok(colonisation)
}

/// Whether a key is a number that each level of stems has.
fn is_row_of_levels(key: &str) -> bool {
    super::parameters::STEM_PARAMETERS.iter().any(|row| row.name == key)
}

fn stem_look(item: Option<&Item>) -> Read<StemLook> {
    let grey = ColourTrack { keys: vec![(0.0, DVec3::new(0.16, 0.13, 0.1))], spread: 0.0, variation: 0.0 };
    let plain = StemLook {
        colours: grey,
        contrast: 1.0,
        pattern: BARK_PATTERNS[0].1,
        size: 0.1,
        depth: 0.0,
        transmission: 0.0,
    };
    let Some(item) = item else { return Ok(plain) };
    let mut section = Section::new("stem", item)?;
    let look = StemLook {
        colours: colours(&mut section)?.unwrap_or(plain.colours),
        contrast: section.number("contrast", 0.6, [0.0, 4.0], "a number from 0 to 4")?,
        pattern: section.word("pattern", &BARK_PATTERNS, plain.pattern)?,
        size: section.number("pattern_size", 0.1, [1e-9, 1e9], "a length above 0")?,
        depth: section.number("depth", 0.0, [0.0, 1e6], "a length, 0 or more")?,
        transmission: section.number("transmission", 0.0, [0.0, 1.0], "a number from 0 to 1")?,
    };
    section.end()?;
    Ok(look)
}

/// The colours of a section over the year, if it has any.
fn colours(section: &mut Section<'_>) -> Read<Option<ColourTrack>> {
    let spread = section.number("colour_spread", 0.03, [0.0, 0.5], "a part of the year from 0 to 0.5")?;
    let variation = section.number("variation", 0.15, [0.0, 1.0], "a number from 0 to 1")?;
    let one = section.get("colour").map(|item| colour("colour", item)).transpose()?;
    let track = |keys| Ok(Some(ColourTrack { keys, spread, variation }));
    let Some(item) = section.get("colours") else {
        return one.map_or(Ok(None), |colour| track(vec![(0.0, colour)]));
    };
    let expected = "a list of times of the year with colours, as [[0.4, [0.1, 0.2, 0.03]], [0.8, [0.5, 0.3, 0.02]]]";
    let Some(rows) = items(item).filter(|rows| !rows.is_empty()) else { return wrong_kind("colours", expected, item) };
    let mut keys: Vec<(f64, DVec3)> = Vec::new();
    for row in rows {
        let both = items(&row).filter(|both| both.len() == 2);
        let time = both.as_ref().and_then(|both| number(&both[0])).filter(|time| (0.0..1.0).contains(time));
        let (Some(both), Some(time)) = (both, time) else { return wrong_kind("colours", expected, item) };
        if keys.last().is_some_and(|(before, _)| *before >= time) {
            return wrong_kind("colours", "in the order of the year", item);
        }
        keys.push((time, colour("colours", &both[1])?));
    }
    track(keys)
}

fn organ(item: &Item, before: &[Organ]) -> Read<Organ> {
    let mut section = Section::new("organ", item)?;
    let name = section.required("name")?;
    let Some(name) = name.as_str().map(str::to_owned) else { return wrong_kind("name", "a text in quotes", name) };
    let outline = outline(&mut section)?;
    let arrangement = arrangement(&mut section)?;
    let colours = match colours(&mut section)? {
        Some(colours) => colours,
        None => return fault(SpeciesProblem::Missing("colours"), section.span.clone()),
    };
    let organ = Organ {
        name,
        arrangement,
        outline,
        width: section.number("width", 0.5, [1e-4, 20.0], "a number above 0 and up to 20")?,
        fold: section.varied("fold", 0.0)?,
        curl: section.varied("curl", 0.0)?,
        stalk: section.number("stalk", 0.0, [0.0, 0.9], "a number from 0 to 0.9")?,
        size: size(&mut section)?,
        count: section.varied("count", 1.0)?,
        place: place(&mut section, before)?,
        down_angle: section.varied("down_angle", 45.0)?,
        rotate: section.varied("rotate", 137.5)?,
        bend: section.number("bend", 0.0, [0.0, 1.0], "a number from 0 to 1")?,
        season: season(&mut section)?,
        colours,
        transmission: section.number("transmission", 0.0, [0.0, 1.0], "a number from 0 to 1")?,
        gloss: match section.get("gloss") {
            Some(item) => match number(item).filter(|gloss| (1e-3..=1.0).contains(gloss)) {
                Some(gloss) => Some(gloss),
                None => return wrong_kind("gloss", "a roughness from 0.001 to 1", item),
            },
            None => None,
        },
    };
    section.end()?;
    Ok(organ)
}

fn size(section: &mut Section<'_>) -> Read<Varied> {
    let item = section.required("size")?;
    let size = varied("size", item)?;
    if size.mean - size.deviation > 0.0 { Ok(size) } else { wrong_kind("size", "a length above 0", item) }
}

fn outline(section: &mut Section<'_>) -> Read<BladeOutline> {
    let Some(item) = section.get("outline") else {
        return BladeOutline::new(OUTLINES[0].1).map_err(|error| Fault { problem: error.into(), span: None });
    };
    if let Some(name) = item.as_str() {
        let known: Vec<&str> = OUTLINES.iter().map(|(name, _)| *name).collect();
        return match BladeOutline::named(name) {
            Some(outline) => Ok(outline),
            None => unknown("outline", name, &known, item.span()),
        };
    }
    let Some(corners) = items(item) else { return wrong_kind("outline", "a name or a list of corners [x, y]", item) };
    let corners = corners.iter().map(|corner| numbers("outline", "a list of corners [x, y]", corner));
    let corners: Vec<[f64; 2]> = corners.collect::<Read<_>>()?;
    BladeOutline::new(&corners).map_err(|error| Fault { problem: error.into(), span: item.span() })
}

fn arrangement(section: &mut Section<'_>) -> Read<BladeArrangement> {
    let words = ["simple", "pinnate", "palmate", "rosette", "brush", "ball"].map(|word| (word, word));
    let word = section.word("arrangement", &words, "simple")?;
    let default = if word == "brush" { 30.0 } else { 5.0 };
    let blades = section.number("blades", default, [1.0, MOST_BLADES], "a whole number from 1 to 400")? as u32;
    let usual = match word {
        "palmate" => 150.0,
        "rosette" => 70.0,
        "brush" => 40.0,
        _ => 60.0,
    };
    let angle = section.number("angle", usual, [0.0, 360.0], "an angle from 0 to 360 degrees")?;
    let length = section.number("blade_length", 0.5, [1e-3, 1.0], "a number above 0 and up to 1")?;
    Ok(match word {
        "pinnate" => BladeArrangement::Pinnate { blades, angle },
        "palmate" => BladeArrangement::Palmate { blades, angle },
        "rosette" => BladeArrangement::Rosette { blades, angle },
        "brush" => BladeArrangement::Brush { blades, angle, length },
        "ball" => BladeArrangement::Ball,
        _ => BladeArrangement::Simple,
    })
}

fn place(section: &mut Section<'_>, before: &[Organ]) -> Read<OrganPlace> {
    let from = section.number("from", 0.0, [0.0, 1.0], "a part of the stem from 0 to 1")?;
    let fan = section.number("fan", 120.0, [0.0, 360.0], "an angle from 0 to 360 degrees")?;
    if let Some(item) = section.get("with") {
        let Some(name) = item.as_str() else { return wrong_kind("with", "the name of another organ", item) };
        return match before.iter().position(|organ| organ.name == name) {
            Some(number) => Ok(OrganPlace::With(number)),
            None => {
                let known: Vec<&str> = before.iter().map(|organ| organ.name.as_str()).collect();
                unknown("organ before it", name, &known, item.span())
            }
        };
    }
    Ok(match section.word("place", &["along", "fan", "tip"].map(|word| (word, word)), "along")? {
        "fan" => OrganPlace::Fan { angle: fan },
        "tip" => OrganPlace::Tip,
        _ => OrganPlace::Along { from },
    })
}

fn season(section: &mut Section<'_>) -> Read<OrganSeason> {
    let unfolding = section.number("unfolding", 0.06, [0.0, 1.0], "a part of the year from 0 to 1")?;
    let both = [
        section.get("emerges").map(|item| varied("emerges", item)),
        section.get("falls").map(|item| varied("falls", item)),
    ];
    match both {
        [None, None] => Ok(OrganSeason { lasts: None, unfolding }),
        [Some(emerges), Some(falls)] => Ok(OrganSeason { lasts: Some([emerges?, falls?]), unfolding }),
        [None, _] => fault(SpeciesProblem::Missing("emerges"), section.span.clone()),
        [_, None] => fault(SpeciesProblem::Missing("falls"), section.span.clone()),
    }
}
