//! Modules, words and productions out of the text of a grammar.

use super::alphabet::{Alphabet, CLOSE, MOST_PARAMETERS, ModuleWord, OPEN};
use super::error::{GrammarError, GrammarProblem};
use super::formula::Formula;
use super::formula_parser::{Names, formula, unknown};
use super::production::{GrammarProduction, MOST_CONTEXT, MOST_FORMALS};
use super::scanner::Cursor;

/// Letters that part the parts of a production, or that parameters need.
const RESERVED: [char; 8] = ['(', ')', ',', ':', '<', '>', '*', '"'];
/// Most modules of a word.
const MOST_MODULES: usize = 1 << 16;

/// The names of a grammar, and its kinds of modules as they come up.
pub(super) struct WordParser<'a> {
    pub alphabet: &'a mut Alphabet,
    /// Names of modules of several letters, the longest first.
    pub names: &'a [String],
    /// Names of surfaces and of grammars within this one.
    pub placed: &'a [String],
    /// Names of constants and parameters.
    pub globals: &'a [String],
}

/// Modules of a predecessor or context: kinds and the names of their parameters.
#[derive(Default)]
struct Context {
    modules: Vec<u8>,
    formals: Vec<String>,
}

impl WordParser<'_> {
    /// The name of the module that comes next; none where no module does.
    pub fn module_name(&self, cursor: &mut Cursor) -> Result<Option<String>, GrammarError> {
        cursor.skip_blanks();
        let Some(letter) = cursor.peek().filter(|letter| !RESERVED.contains(letter)) else { return Ok(None) };
        if cursor.is_at_arrow() {
            return Ok(None);
        }
        if let Some(name) = self.names.iter().find(|name| cursor.is_at(name)) {
            cursor.take(name);
            return Ok(Some(name.clone()));
        }
        cursor.advance();
        match letter {
            '~' => {
                let before = cursor.clone();
                let surface = cursor.take_name().unwrap_or_default();
                if self.placed.contains(&surface) {
                    return Ok(Some(format!("~{surface}")));
                }
                let known: Vec<&str> = self.placed.iter().map(String::as_str).collect();
                Err(before.fault(unknown("surface or grammar", surface, &known)))
            }
            '?' | '@' => {
                let second = cursor.peek().filter(|second| second.is_alphabetic());
                second
                    .map(|second| cursor.advance_over(format!("{letter}{second}")))
                    .map_or_else(|| Err(cursor.expected(&format!("a letter after `{letter}`"))), |name| Ok(Some(name)))
            }
            letter => Ok(Some(letter.to_string())),
        }
    }

    /// Reads a production.
    pub fn production(&mut self, cursor: &mut Cursor) -> Result<GrammarProduction, GrammarError> {
        cursor.skip_blanks();
        let place = cursor.place();
        let mut left = None;
        let before = cursor.clone();
        let mut strict = self.context(cursor)?;
        if cursor.take("<") {
            left = Some((strict, before));
            cursor.skip_blanks();
            strict = self.context(cursor)?;
        }
        let [predecessor] = strict.modules[..] else {
            return Err(cursor.expected("one module as the strict predecessor"));
        };
        if predecessor == OPEN || predecessor == CLOSE {
            let bracket = if predecessor == OPEN { '[' } else { ']' };
            return Err(GrammarError {
                place,
                problem: GrammarProblem::Bracket { bracket, what: "a strict predecessor" },
            });
        }
        let mut formals = strict.formals;
        let mut left_kinds = Vec::new();
        if let Some((context, before)) = left {
            left_kinds = context.modules;
            if let Some(kind) = left_kinds.iter().find(|kind| matches!(**kind, OPEN | CLOSE)) {
                let bracket = if *kind == OPEN { '[' } else { ']' };
                return Err(before.fault(GrammarProblem::Bracket { bracket, what: "a left context" }));
            }
            left_kinds.reverse();
            formals.extend(context.formals);
        }
        let mut right = Context::default();
        if cursor.take(">") {
            let before = cursor.clone();
            right = self.context(cursor)?;
            check_balance(&right.modules, &before)?;
        }
        formals.extend(right.formals);
        check_formals(&formals, cursor)?;
        let globals = self.globals;
        let names = Names { formals: &formals, globals };
        let mut condition = None;
        if cursor.take(":") && !cursor.take("*") {
            condition = Some(formula(cursor, names)?);
        }
        if !cursor.take_arrow() {
            return Err(cursor.expected("`->`"));
        }
        let successor = self.word(cursor, &formals)?;
        let probability = if cursor.take(":") { Some(formula(cursor, names)?) } else { None };
        cursor.require_end()?;
        Ok(GrammarProduction {
            place,
            predecessor,
            left: left_kinds,
            right: right.modules,
            condition,
            probability,
            successor,
        })
    }

    /// Reads modules with names for their parameters, or `*` for none.
    fn context(&mut self, cursor: &mut Cursor) -> Result<Context, GrammarError> {
        let mut context = Context::default();
        if cursor.take("*") {
            return Ok(context);
        }
        loop {
            let before = cursor.clone();
            let Some(name) = self.module_name(cursor)? else { break };
            let mut arity = 0;
            if cursor.peek() == Some('(') {
                cursor.advance();
                loop {
                    let Some(formal) = cursor.take_name() else {
                        return Err(cursor.expected("the name of a parameter"));
                    };
                    context.formals.push(formal);
                    arity += 1;
                    if !cursor.take(",") {
                        break;
                    }
                }
                cursor.require(")")?;
            }
            context.modules.push(self.number(&name, arity, &before)?);
            if context.modules.len() > MOST_CONTEXT {
                return Err(before.fault(GrammarProblem::TooMany { what: "modules of a context", most: MOST_CONTEXT }));
            }
        }
        Ok(context)
    }

    /// Reads modules with expressions for their parameters, up to a `:` or the end; `*` for none.
    pub fn word(&mut self, cursor: &mut Cursor, formals: &[String]) -> Result<ModuleWord, GrammarError> {
        cursor.skip_blanks();
        let start = cursor.clone();
        let mut word = ModuleWord { place: cursor.place(), ..ModuleWord::default() };
        if cursor.take("*") || cursor.take("ε") {
            return Ok(word);
        }
        loop {
            let before = cursor.clone();
            let Some(name) = self.module_name(cursor)? else { break };
            let mut arguments: Vec<Formula> = Vec::new();
            if cursor.peek() == Some('(') {
                cursor.advance();
                loop {
                    arguments.push(formula(cursor, Names { formals, globals: self.globals })?);
                    if !cursor.take(",") {
                        break;
                    }
                }
                cursor.require(")")?;
            }
            word.modules.push(self.number(&name, arguments.len(), &before)?);
            word.arguments.extend(arguments);
            if word.modules.len() > MOST_MODULES {
                return Err(before.fault(GrammarProblem::TooMany { what: "modules of a word", most: MOST_MODULES }));
            }
        }
        check_balance(&word.modules, &start)?;
        Ok(word)
    }

    /// The kind of a module with so many parameters.
    fn number(&mut self, name: &str, arity: usize, at: &Cursor) -> Result<u8, GrammarError> {
        if arity > MOST_PARAMETERS {
            return Err(at.fault(GrammarProblem::TooMany { what: "parameters of a module", most: MOST_PARAMETERS }));
        }
        if arity > 0 && matches!(name, "[" | "]") {
            return Err(at.fault(GrammarProblem::TooMany { what: "parameters of a bracket", most: 0 }));
        }
        self.alphabet.number(name, arity).map_err(|problem| at.fault(problem))
    }
}

/// Checks that brackets stand in pairs.
fn check_balance(modules: &[u8], at: &Cursor) -> Result<(), GrammarError> {
    let mut depth = 0;
    for kind in modules {
        match *kind {
            OPEN => depth += 1,
            CLOSE => depth -= 1,
            _ => {}
        }
        if depth < 0 {
            break;
        }
    }
    if depth == 0 { Ok(()) } else { Err(at.fault(GrammarProblem::Unbalanced(if depth > 0 { '[' } else { ']' }))) }
}

/// Checks that parameters have names of their own, and are not too many.
fn check_formals(formals: &[String], at: &Cursor) -> Result<(), GrammarError> {
    if formals.len() > MOST_FORMALS {
        return Err(at.fault(GrammarProblem::TooMany { what: "parameters of a production", most: MOST_FORMALS }));
    }
    let twice = formals.iter().enumerate().find(|(index, name)| formals[..*index].contains(name));
    twice.map_or(Ok(()), |(_, name)| Err(at.fault(GrammarProblem::Twice(name.clone()))))
}
