//! The reason why an operation on the mass memory was refused.

use crate::structure::CopyFault;
use protocol::Name;

/// The reason why an operation on the mass memory was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The mass memory is full.
    #[error("Insufficient memory")]
    Full,
    /// A name of the system may not be redefined or deleted.
    #[error("{0} belongs to the system")]
    System(Name),
    /// A function type that does not exist.
    #[error("Name not found: F:{0}")]
    NoFunction(Name),
    /// A function type cannot be made in this size.
    #[error("{1}")]
    FunctionSize(Name, String),
    /// A name that has to exist does not.
    #[error("Name not found: {0}")]
    NotFound(Name),
    /// A variable without a value.
    #[error("Name not found: a value in {0}")]
    NoValue(Name),
    /// Elements that cannot be copied.
    #[error("Value out of range in {0}: {1}")]
    Copy(Name, CopyFault),
    /// What a name denotes is of another kind than the command needs.
    #[error("{0} is {1}")]
    Misfit(Name, &'static str),
}

impl Refusal {
    /// The number of the message.
    pub fn number(&self) -> u16 {
        match self {
            Refusal::NoFunction(_) | Refusal::NotFound(_) | Refusal::NoValue(_) => 2,
            Refusal::Misfit(..) => 4,
            Refusal::Copy(..) => 6,
            Refusal::Full => 8,
            Refusal::System(_) | Refusal::FunctionSize(..) => 9,
        }
    }
}
