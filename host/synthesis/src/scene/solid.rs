//! A solid of a few measures in a scene, with its exact body.

use crate::solid::{Body, Primitive, PrimitiveError};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// A primitive with its body between exact surfaces, which is made when it is first asked for. Copies share it.
#[derive(Clone, Serialize, Deserialize)]
#[serde(from = "Primitive", into = "Primitive")]
pub struct PrimitiveSolid {
    primitive: Primitive,
    body: Arc<OnceLock<Body>>,
}

impl PrimitiveSolid {
    /// Its measures.
    pub fn primitive(&self) -> &Primitive {
        &self.primitive
    }

    /// Its body.
    ///
    /// # Errors
    /// [`PrimitiveError`] if there is no solid of these measures.
    pub fn body(&self) -> Result<&Body, PrimitiveError> {
        if let Some(body) = self.body.get() {
            return Ok(body);
        }
        let body = self.primitive.body()?;
        Ok(self.body.get_or_init(|| body))
    }
}

impl From<Primitive> for PrimitiveSolid {
    fn from(primitive: Primitive) -> PrimitiveSolid {
        PrimitiveSolid { primitive, body: Arc::default() }
    }
}

impl From<PrimitiveSolid> for Primitive {
    fn from(solid: PrimitiveSolid) -> Primitive {
        solid.primitive
    }
}

impl PartialEq for PrimitiveSolid {
    fn eq(&self, other: &PrimitiveSolid) -> bool {
        self.primitive == other.primitive
    }
}

impl std::fmt::Debug for PrimitiveSolid {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.primitive.fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_of_a_solid_share_one_body_and_a_solid_that_is_none_says_so() {
        let one = PrimitiveSolid::from(Primitive::Sphere { radius: 2.0 });
        let other = one.clone();
        assert!(std::ptr::eq(one.body().expect("a sphere"), other.body().expect("a sphere")));
        assert!(PrimitiveSolid::from(Primitive::Sphere { radius: -1.0 }).body().is_err());
    }
}
