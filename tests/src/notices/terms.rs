//! Under which licences a crate is passed on: of those that it offers, the first that `.cargo/deny.toml` allows.

use super::{NoticesError, read_toml};
use spdx::{Expression, Licensee, ParseMode};
use std::collections::BTreeMap;
use std::path::Path;
use toml_edit::{Array, DocumentMut, Item};

/// The licences that are allowed, in the order in which they are preferred.
#[derive(Debug)]
pub struct Allowed {
    of_all: Vec<Licensee>,
    of_one: BTreeMap<String, Vec<Licensee>>,
}

impl Allowed {
    /// Reads what is allowed.
    ///
    /// - `root`: the folder of the workspace.
    ///
    /// # Errors
    /// [`NoticesError`] if `.cargo/deny.toml` is not as expected.
    pub fn read(root: &Path) -> Result<Allowed, NoticesError> {
        let path = root.join(".cargo/deny.toml");
        let form = |problem: &str| NoticesError::Form { what: path.display().to_string(), problem: problem.into() };
        let deny: DocumentMut = read_toml(&path)?;
        let licences = deny.get("licenses").ok_or_else(|| form("it says nothing of licences"))?;
        let list = |item: Option<&Array>| item.map(licensees).ok_or_else(|| form("a list is missing"))?;
        let of_all = list(licences.get("allow").and_then(Item::as_array))?;
        let mut of_one = BTreeMap::new();
        for exception in licences.get("exceptions").and_then(Item::as_array).into_iter().flatten() {
            let exception = exception.as_inline_table().ok_or_else(|| form("an exception is no table"))?;
            let name =
                exception.get("crate").and_then(|name| name.as_str()).ok_or_else(|| form("a crate is missing"))?;
            of_one.insert(name.to_owned(), list(exception.get("allow").and_then(|allow| allow.as_array()))?);
        }
        Ok(Allowed { of_all, of_one })
    }

    /// The identifiers of the licences that are taken of what a crate offers.
    ///
    /// # Errors
    /// [`NoticesError::Terms`] if they are not enough.
    pub fn chosen(&self, name: &str, licence: &str) -> Result<Vec<String>, NoticesError> {
        let failed = || NoticesError::Terms { name: name.into(), licence: licence.into() };
        let expression = Expression::parse_mode(licence, ParseMode::LAX).map_err(|_| failed())?;
        let accepted = self.of_all.iter().chain(self.of_one.get(name).into_iter().flatten());
        let chosen = expression.minimized_requirements(accepted).map_err(|_| failed())?;
        Ok(chosen.iter().map(ToString::to_string).collect())
    }
}

fn licensees(list: &Array) -> Result<Vec<Licensee>, NoticesError> {
    let parsed = |text: &str| {
        let form =
            |error| NoticesError::Form { what: text.into(), problem: format!("no licence is called so: {error}") };
        Licensee::parse(text).map_err(form)
    };
    list.iter().filter_map(|item| item.as_str()).map(parsed).collect()
}
