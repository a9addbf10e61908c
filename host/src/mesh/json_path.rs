//! Places in JSON documents.

use std::fmt;

/// The longest path that is looked at.
const MAX_STEPS: usize = 5;

/// A place in a JSON document, such as `meshes[0].primitives[1].indices`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JsonPath {
    steps: [(&'static str, Option<u32>); MAX_STEPS],
    length: u8,
}

impl JsonPath {
    /// The path of a member of what is here, or of an element of it.
    pub(super) fn with(mut self, key: &'static str, index: Option<usize>) -> JsonPath {
        if let Some(step) = self.steps.get_mut(usize::from(self.length)) {
            *step = (key, index.and_then(|index| u32::try_from(index).ok()));
            self.length += 1;
        }
        self
    }
}

impl fmt::Display for JsonPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.length == 0 {
            return write!(f, "the document");
        }
        for (k, (key, index)) in self.steps[..usize::from(self.length)].iter().enumerate() {
            let dot = if k > 0 { "." } else { "" };
            write!(f, "{dot}{key}")?;
            index.map_or(Ok(()), |index| write!(f, "[{index}]"))?;
        }
        Ok(())
    }
}
