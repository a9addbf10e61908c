//! What the rows of the initial instances have in common: inputs, and asking the machine for an effect.

use crate::port::{Effect, Firing, KindSet, PortSpec, Problem};

/// The input of what shows or sends texts.
pub(super) const TEXT: &[PortSpec] = &[PortSpec::active(KindSet::STRING, "text")];

/// The input of what any message sets off.
pub(super) const TRIGGER: &[PortSpec] = &[PortSpec::active(KindSet::ANY, "trigger")];

/// Asks the machine for an effect.
pub(super) fn request(f: &mut Firing, effect: Effect) -> Result<(), Problem> {
    f.effect(effect);
    Ok(())
}
