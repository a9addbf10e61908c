//! The JSON of a file, with the path of what is looked at.

use serde_json::Value;

use super::super::error::shortened;
use super::super::{Fault, FaultLocation, JsonPath, MeshProblem};

/// A value and where it stands.
#[derive(Clone, Copy)]
pub struct LocatedValue<'a> {
    value: &'a Value,
    path: JsonPath,
}

impl<'a> LocatedValue<'a> {
    /// The whole document.
    pub fn root(value: &'a Value) -> LocatedValue<'a> {
        LocatedValue { value, path: JsonPath::default() }
    }

    /// A problem here.
    pub fn fault(&self, problem: MeshProblem) -> Fault {
        FaultLocation::Json(self.path).fault(problem)
    }

    /// Something else stands here.
    pub fn expected(&self, expected: &'static str) -> Fault {
        self.fault(MeshProblem::Expected { expected, found: shortened(&self.value.to_string()) })
    }

    /// A member.
    pub fn get(&self, key: &'static str) -> Option<LocatedValue<'a>> {
        let value = self.value.get(key)?;
        Some(LocatedValue { value, path: self.path.with(key, None) })
    }

    /// Some member, whose place is told as here.
    pub fn any_member(&self) -> Option<LocatedValue<'a>> {
        let value = self.value.as_object()?.values().next()?;
        Some(LocatedValue { value, path: self.path })
    }

    /// A member that must be there.
    pub fn need(&self, key: &'static str) -> Result<LocatedValue<'a>, Fault> {
        let missing = || FaultLocation::Json(self.path.with(key, None)).fault(MeshProblem::Missing);
        self.get(key).ok_or_else(missing)
    }

    /// The elements of a list that is a member; none if there is no such member.
    pub fn list(&self, key: &'static str) -> Result<Vec<LocatedValue<'a>>, Fault> {
        let Some(list) = self.get(key) else { return Ok(Vec::new()) };
        let values = list.value.as_array().ok_or_else(|| list.expected("a list"))?;
        let element = |(index, value)| LocatedValue { value, path: self.path.with(key, Some(index)) };
        Ok(values.iter().enumerate().map(element).collect())
    }

    /// Element `index` of a list that is a member.
    pub fn element(&self, key: &'static str, index: usize) -> Option<LocatedValue<'a>> {
        let value = self.value.get(key)?.get(index)?;
        Some(LocatedValue { value, path: self.path.with(key, Some(index)) })
    }

    /// A whole number, 0 or more.
    pub fn count(&self) -> Result<usize, Fault> {
        let count = self.value.as_u64().and_then(|count| usize::try_from(count).ok());
        count.ok_or_else(|| self.expected("a whole number"))
    }

    /// A member that is a whole number; `default` without it.
    pub fn count_or(&self, key: &'static str, default: usize) -> Result<usize, Fault> {
        self.get(key).map_or(Ok(default), |at| at.count())
    }

    /// A member that is true or false; false without it.
    pub fn flag(&self, key: &'static str) -> Result<bool, Fault> {
        let read = |at: LocatedValue| at.value.as_bool().ok_or_else(|| at.expected("true or false"));
        self.get(key).map_or(Ok(false), read)
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, Fault> {
        self.value.as_str().ok_or_else(|| self.expected("a text"))
    }

    /// A member that is a text.
    pub fn text_of(&self, key: &'static str) -> Result<Option<&'a str>, Fault> {
        self.get(key).map(|at| at.text()).transpose()
    }

    /// A member that is a finite number.
    pub fn number(&self, key: &'static str) -> Result<Option<f64>, Fault> {
        let read =
            |at: LocatedValue| at.value.as_f64().filter(|x| x.is_finite()).ok_or_else(|| at.expected("a number"));
        self.get(key).map(read).transpose()
    }

    /// A member that is a list of N finite numbers.
    pub fn numbers<const N: usize>(&self, key: &'static str) -> Result<Option<[f64; N]>, Fault> {
        let Some(at) = self.get(key) else { return Ok(None) };
        let values = at.value.as_array().filter(|values| values.len() == N);
        let values = values.ok_or_else(|| at.fault(MeshProblem::Numbers(N)))?;
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(values) {
            *number = value.as_f64().filter(|x| x.is_finite()).ok_or_else(|| at.fault(MeshProblem::Numbers(N)))?;
        }
        Ok(Some(numbers))
    }

    /// The element of a list of `root` that the number here names.
    pub fn named(&self, root: &LocatedValue<'a>, key: &'static str) -> Result<LocatedValue<'a>, Fault> {
        let index = self.count()?;
        let length = root.value.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        let outside = || self.fault(MeshProblem::Index { index: index as i64, count: length, table: key });
        root.element(key, index).ok_or_else(outside)
    }
}
