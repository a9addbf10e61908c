//! The message of a device.

use protocol::Value;

/// Instance, output and value of a message from a device.
pub(super) type DeviceMessage = (&'static str, u16, Value);
