//! Observers of messages on their way. There is none, as a rule: then observing costs nothing.

use super::Destination;
use crate::port::ObjectId;
use protocol::Value;

/// Where an arc begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArcSource {
    /// The object.
    pub object: ObjectId,
    /// The output.
    pub output: u16,
}

/// The delivery of a message: what became of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delivery {
    /// It arrived at an input of a function, where so many wait now.
    Arrived {
        /// Messages that wait, itself included; 1 for a constant.
        waiting: usize,
    },
    /// The queue was full, or strings had no more memory: it was lost.
    Lost,
    /// The function has no such input, or does not accept such a message there.
    Refused,
    /// The object is no function: the machine takes it over.
    Left,
}

/// An observer of the network. The methods of [`NoObserver`] are empty, so that the compiler leaves them out.
pub(super) trait Observer {
    /// Whether the observer is active at all.
    const IS_ACTIVE: bool;

    /// Whether the network stands still before this function fires.
    fn stops_before(&mut self, object: ObjectId) -> bool;

    /// A function fires.
    fn fires(&mut self, object: ObjectId);

    /// A clock or a device emits, which no message made fire.
    fn emits(&mut self, object: ObjectId);

    /// A function has a fault.
    fn fails(&mut self, object: ObjectId);

    /// A copy of a message that is going to be delivered, if the observer needs it.
    fn copy(&self, from: Option<ArcSource>, to: Destination, message: &Value) -> Option<Value>;

    /// A message was delivered.
    fn delivered(&mut self, from: Option<ArcSource>, to: Destination, message: Option<Value>, outcome: Delivery);
}

/// The absence of an observer.
pub(super) struct NoObserver;

impl Observer for NoObserver {
    const IS_ACTIVE: bool = false;

    fn stops_before(&mut self, _: ObjectId) -> bool {
        false
    }

    fn fires(&mut self, _: ObjectId) {}

    fn emits(&mut self, _: ObjectId) {}

    fn fails(&mut self, _: ObjectId) {}

    fn copy(&self, _: Option<ArcSource>, _: Destination, _: &Value) -> Option<Value> {
        None
    }

    fn delivered(&mut self, _: Option<ArcSource>, _: Destination, _: Option<Value>, _: Delivery) {}
}
