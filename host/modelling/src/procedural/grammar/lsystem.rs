//! A grammar as a whole, and how its statements become one.

use super::alphabet::{Alphabet, ModuleWord};
use super::error::{GrammarError, GrammarProblem, TextPlace};
use super::formula::Formula;
use super::formula_parser::{Names, formula};
use super::predefined::surface;
use super::production::{GrammarProduction, ProductionSet};
use super::scanner::{Cursor, Statement, statements};
use super::system::{ContextSight, RewritingSystem, SETTINGS, Setting};
use super::word_parser::WordParser;
use crate::procedural::Varied;
use crate::procedural::drawing::PredefinedSurface;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Most constants and parameters of a grammar.
const MOST_GLOBALS: usize = 1000;
/// Most productions of a grammar for each purpose.
const MOST_PRODUCTIONS: usize = 4000;

/// A parameter that a grammar declares.
#[derive(Clone, Debug, PartialEq)]
pub struct GrammarParameter {
    /// Its name.
    pub name: String,
    /// What it is where nothing else is asked for.
    pub default: Varied,
    /// What it is for, in a line; empty if the grammar does not say.
    pub description: String,
}

/// What a constant or parameter of a grammar is.
#[derive(Clone, Debug)]
pub(super) enum GlobalValue {
    Constant(Formula),
    /// A parameter, by its number.
    Parameter(usize),
}

/// An L-system: an axiom, and productions that replace all modules of a string at once, again and again.
///
/// The notation is that of the module. Strings of one seed and one choice of parameters come from a
/// [`Specimen`](super::Specimen).
///
/// # Source
/// Lindenmayer 1968; the notation after Prusinkiewicz and Lindenmayer 1990, "The Algorithmic Beauty of Plants".
#[derive(Clone, Debug)]
pub struct LSystem {
    pub(super) alphabet: Arc<Alphabet>,
    pub(super) parameters: Vec<GrammarParameter>,
    /// Constants and parameters, each of which may use those before it.
    pub(super) globals: Vec<(GlobalValue, TextPlace)>,
    /// The grammar itself, and after it those within it.
    pub(super) systems: Vec<RewritingSystem>,
    pub(super) surfaces: Arc<[PredefinedSurface]>,
}

impl LSystem {
    /// Understands the text of a grammar; see the module for its notation.
    ///
    /// # Errors
    /// The first fault, with its line and column, what was expected and what was found.
    pub fn parse(text: &str) -> Result<LSystem, GrammarError> {
        let statements = statements(text)?;
        let last = statements.last().map(|statement| statement.cursor().place());
        let place = last.unwrap_or(TextPlace { line: 1, column: 1 });
        let mut reader =
            Reader { systems: vec![SystemReader { place, ..SystemReader::default() }], ..Reader::default() };
        let mut rest = Vec::new();
        for statement in &statements {
            if !reader.declaration(&mut statement.cursor())? {
                rest.push(statement);
            }
        }
        reader.names.sort_by_key(|name| std::cmp::Reverse(name.len()));
        for statement in rest {
            reader.statement(statement)?;
        }
        Ok(LSystem {
            alphabet: Arc::new(reader.alphabet.0),
            parameters: reader.parameters,
            globals: reader.globals,
            systems: reader.systems.into_iter().map(SystemReader::finished).collect::<Result<_, _>>()?,
            surfaces: reader.surfaces.into(),
        })
    }

    /// The parameters that the grammar declares, in their order.
    pub fn parameters(&self) -> &[GrammarParameter] {
        &self.parameters
    }

    /// The surfaces that the grammar defines, in their order.
    pub fn surfaces(&self) -> &[PredefinedSurface] {
        &self.surfaces
    }
}

/// The alphabet while a grammar is read.
struct GrowingAlphabet(Alphabet);

impl Default for GrowingAlphabet {
    fn default() -> GrowingAlphabet {
        GrowingAlphabet(Alphabet::new())
    }
}

/// What has been read of a grammar.
#[derive(Default)]
struct Reader {
    alphabet: GrowingAlphabet,
    names: Vec<String>,
    /// Of surfaces and of the grammars within this one.
    placed_names: Vec<String>,
    surfaces: Vec<PredefinedSurface>,
    global_names: Vec<String>,
    globals: Vec<(GlobalValue, TextPlace)>,
    parameters: Vec<GrammarParameter>,
    /// The last one is being read.
    systems: Vec<SystemReader>,
}

/// What has been read of an axiom and its productions.
#[derive(Default)]
struct SystemReader {
    name: String,
    /// Where a missing axiom is missed.
    place: TextPlace,
    settings: [Option<Formula>; SETTINGS.len()],
    axiom: Option<ModuleWord>,
    sight: Option<ContextSight>,
    /// Of derivation, decomposition and interpretation.
    sets: [ProductionSet; 3],
    /// The set that is being read.
    current: usize,
}

impl SystemReader {
    fn finished(self) -> Result<RewritingSystem, GrammarError> {
        let Some(axiom) = self.axiom else {
            return Err(GrammarError { place: self.place, problem: GrammarProblem::NoAxiom });
        };
        let [productions, decomposition, interpretation] = self.sets;
        Ok(RewritingSystem {
            name: self.name,
            settings: self.settings,
            axiom,
            sight: self.sight.unwrap_or_default(),
            productions,
            decomposition,
            interpretation,
        })
    }
}

impl Reader {
    /// Reads a statement that declares a name; says whether it was one.
    fn declaration(&mut self, cursor: &mut Cursor) -> Result<bool, GrammarError> {
        if cursor.take("#define") {
            let (name, place) = self.new_global(cursor)?;
            let value = formula(cursor, Names { formals: &[], globals: &self.global_names })?;
            check_constant(&value)?;
            cursor.require_end()?;
            self.global_names.push(name);
            self.globals.push((GlobalValue::Constant(value), place));
        } else if cursor.is_at("parameter ") {
            cursor.take("parameter");
            self.parameter(cursor)?;
        } else if cursor.take_heading("names") {
            while !cursor.is_at_end() {
                let name = cursor.take_name().ok_or_else(|| cursor.expected("a name of a module"))?;
                self.names.push(name);
            }
        } else if cursor.is_at("surface ") {
            cursor.take("surface");
            let name = self.new_placed(cursor, "a name of a surface")?;
            self.surfaces.push(surface(name, cursor)?);
        } else if cursor.is_at("grammar ") {
            // Its name may stand before it; what it says is read later.
            cursor.take("grammar");
            self.new_placed(cursor, "a name of a grammar")?;
            return Ok(false);
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// Reads `NAME:` of what modules `~NAME` place, which is not known yet.
    fn new_placed(&mut self, cursor: &mut Cursor, what: &str) -> Result<String, GrammarError> {
        let before = cursor.clone();
        let name = cursor.take_name().ok_or_else(|| cursor.expected(what))?;
        cursor.require(":")?;
        if self.placed_names.contains(&name) {
            return Err(before.fault(GrammarProblem::Twice(name)));
        }
        self.placed_names.push(name.clone());
        Ok(name)
    }

    /// The axiom with productions that is being read.
    fn system(&mut self) -> &mut SystemReader {
        let last = self.systems.len() - 1;
        &mut self.systems[last]
    }

    /// Reads `parameter NAME = MEAN +/- DEVIATION "DESCRIPTION"`, the last two where they are.
    fn parameter(&mut self, cursor: &mut Cursor) -> Result<(), GrammarError> {
        let (name, place) = self.new_global(cursor)?;
        cursor.require("=")?;
        cursor.skip_blanks();
        let before = cursor.clone();
        let mean = self.number(cursor)?;
        let deviation = if cursor.take("+/-") || cursor.take("±") { self.number(cursor)? } else { 0.0 };
        let default = Varied { mean, deviation };
        default.check().map_err(|error| before.fault(error.into()))?;
        let description = cursor.take_quoted()?.unwrap_or_default();
        cursor.require_end()?;
        self.globals.push((GlobalValue::Parameter(self.parameters.len()), place));
        self.global_names.push(name.clone());
        self.parameters.push(GrammarParameter { name, default, description });
        Ok(())
    }

    /// Reads the name of a constant or parameter that is not known yet.
    fn new_global(&self, cursor: &mut Cursor) -> Result<(String, TextPlace), GrammarError> {
        cursor.skip_blanks();
        let before = cursor.clone();
        let name = cursor.take_name().ok_or_else(|| cursor.expected("a name"))?;
        if self.global_names.contains(&name) {
            return Err(before.fault(GrammarProblem::Twice(name)));
        }
        if self.globals.len() == MOST_GLOBALS {
            return Err(before.fault(GrammarProblem::TooMany { what: "constants and parameters", most: MOST_GLOBALS }));
        }
        Ok((name, before.place()))
    }

    /// Reads a number that follows from constants alone.
    fn number(&self, cursor: &mut Cursor) -> Result<f64, GrammarError> {
        cursor.skip_blanks();
        let before = cursor.clone();
        let formula = formula(cursor, Names { formals: &[], globals: &self.global_names })?;
        check_constant(&formula)?;
        let values = self.constants();
        if formula.globals().any(|global| values[global].is_nan()) {
            return Err(before.expected("a number that no parameter is part of"));
        }
        formula.value(&values).map_err(|error| GrammarError { place: error.place, problem: error.problem.into() })
    }

    /// The values of constants; no number for parameters, and for constants of which parameters are part or that have
    /// no value.
    fn constants(&self) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.globals.len());
        for (value, _) in &self.globals {
            values.push(match value {
                GlobalValue::Constant(formula) if formula.globals().all(|global| !values[global].is_nan()) => {
                    formula.value(&values).unwrap_or(f64::NAN)
                }
                _ => f64::NAN,
            });
        }
        values
    }

    /// Reads a statement that declares no name.
    fn statement(&mut self, statement: &Statement) -> Result<(), GrammarError> {
        let cursor = &mut statement.cursor();
        if cursor.is_at("grammar ") {
            let place = cursor.place();
            cursor.take("grammar");
            let name = cursor.take_name().unwrap_or_default();
            cursor.require(":")?;
            self.systems.push(SystemReader { name, place, ..SystemReader::default() });
            return cursor.require_end();
        }
        for (heading, is_ignored) in [("#ignore", true), ("#consider", false), ("ignore", true), ("consider", false)] {
            let is_found = cursor.take_heading(heading) || heading.starts_with('#') && cursor.take(heading);
            if is_found {
                return self.contexts(cursor, is_ignored);
            }
        }
        if cursor.take_heading("axiom") {
            if self.system().axiom.is_some() {
                return Err(cursor.fault(GrammarProblem::Twice("axiom".into())));
            }
            self.system().axiom = Some(self.words().word(cursor, &[])?);
            return cursor.require_end();
        }
        for (number, headings) in
            [&["productions"][..], &["decomposition"], &["interpretation", "homomorphism"]].iter().enumerate()
        {
            if headings.iter().any(|heading| cursor.take_heading(heading)) {
                self.system().current = number;
                return cursor.require_end();
            }
        }
        if cursor.take_heading("maximum depth") {
            cursor.skip_blanks();
            let before = cursor.clone();
            let value = self.number(cursor)?;
            if !(1.0..=200.0).contains(&value) || value.fract() != 0.0 {
                let range = "a whole number of 1 to 200";
                return Err(before.fault(GrammarProblem::OutOfRange { what: "maximum depth", value, range }));
            }
            let system = self.system();
            system.sets[system.current].depth = Some(value as u32);
            return cursor.require_end();
        }
        if self.setting(cursor)? {
            return cursor.require_end();
        }
        if statement.has_arrow() {
            return self.production(cursor);
        }
        Err(cursor.expected("a production with `->`, or a heading such as `axiom:`"))
    }

    fn production(&mut self, cursor: &mut Cursor) -> Result<(), GrammarError> {
        let before = cursor.clone();
        let production: GrammarProduction = self.words().production(cursor)?;
        let is_context_free = production.left.is_empty() && production.right.is_empty();
        let system = self.system();
        let set = &mut system.sets[system.current].productions;
        if system.current > 0 && !is_context_free {
            return Err(before.expected("a production without contexts in decomposition and interpretation"));
        }
        if set.len() == MOST_PRODUCTIONS {
            return Err(before.fault(GrammarProblem::TooMany { what: "productions", most: MOST_PRODUCTIONS }));
        }
        set.push(production);
        Ok(())
    }

    fn words(&mut self) -> WordParser<'_> {
        WordParser {
            alphabet: &mut self.alphabet.0,
            names: &self.names,
            placed: &self.placed_names,
            globals: &self.global_names,
        }
    }

    /// Reads which modules contexts see, or do not.
    fn contexts(&mut self, cursor: &mut Cursor, is_ignored: bool) -> Result<(), GrammarError> {
        // ABOP has a colon after the blank.
        cursor.take(":");
        let before = cursor.clone();
        if self.system().sight.is_some() {
            return Err(before.fault(GrammarProblem::Twice("ignore or consider".into())));
        }
        let mut names = BTreeSet::new();
        while let Some(name) = self.words().module_name(cursor)? {
            if let "[" | "]" = name.as_str() {
                let bracket = if name == "[" { '[' } else { ']' };
                return Err(before.fault(GrammarProblem::Bracket { bracket, what: "what contexts see" }));
            }
            names.insert(name);
        }
        let sight = if is_ignored { ContextSight::Ignored(names) } else { ContextSight::Considered(names) };
        self.system().sight = Some(sight);
        cursor.require_end()
    }

    /// Reads a number that the grammar sets; says whether it was one.
    fn setting(&mut self, cursor: &mut Cursor) -> Result<bool, GrammarError> {
        let names = Names { formals: &[], globals: &self.global_names };
        let before = cursor.clone();
        let mut found: Vec<(usize, Formula)> = Vec::new();
        if cursor.take_heading("tropism") {
            for (axis, setting) in [Setting::TropismX, Setting::TropismY, Setting::TropismZ].into_iter().enumerate() {
                if axis > 0 {
                    cursor.require(",")?;
                }
                found.push((setting as usize, formula(cursor, names)?));
            }
        } else {
            let row = SETTINGS.iter().position(|row| cursor.take_heading(row.heading));
            let Some(row) = row else { return Ok(false) };
            found.push((row, formula(cursor, names)?));
        }
        for (row, value) in found {
            check_constant(&value)?;
            if self.system().settings[row].replace(value).is_some() {
                return Err(before.fault(GrammarProblem::Twice(SETTINGS[row].heading.into())));
            }
        }
        Ok(true)
    }
}

/// Checks that a formula says a number of the whole grammar.
fn check_constant(formula: &Formula) -> Result<(), GrammarError> {
    let Some(place) = formula.place_of_module() else { return Ok(()) };
    let expected = "a number without `ran` and `nran`, which only productions may draw".into();
    let problem = GrammarProblem::Expected { expected, found: "one of them".into() };
    Err(GrammarError { place, problem })
}
