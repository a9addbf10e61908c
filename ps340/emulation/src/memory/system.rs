//! What the machine keeps beside names, structures and functions: password, working storage, interfaces.

use protocol::Name;
use std::collections::BTreeMap;

/// Most ports, and most options of a port, that SETUP INTERFACE keeps. Ours.
pub const MAX_INTERFACE_ENTRIES: usize = 64;

/// Bytes of working storage that are put aside from the start: enough to render 1,000 vertices. Ours.
pub const INITIAL_WORKING_STORAGE: u32 = 50_000;

/// Settings that commands make for the whole machine.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// The password of CONFIGURE and REBOOT; without one, every password is right.
    pub password: Option<Name>,
    /// Bytes that are put aside for renderings; RESERVE_WORKING_STORAGE asks for more.
    pub working_storage: u32,
    /// Options of each port, as SETUP INTERFACE gave them. Kept and shown; the lines of this machine need none.
    interfaces: BTreeMap<Name, BTreeMap<Name, String>>,
}

impl Default for System {
    fn default() -> System {
        System { password: None, working_storage: INITIAL_WORKING_STORAGE, interfaces: BTreeMap::new() }
    }
}

impl System {
    /// Whether a password opens what the password protects.
    pub fn admits(&self, password: &Name) -> bool {
        self.password.as_ref().is_none_or(|right| right == password)
    }

    /// SETUP INTERFACE. Returns false if there are [`MAX_INTERFACE_ENTRIES`] already.
    pub fn set_interface(&mut self, port: Name, options: Vec<(Name, String)>) -> bool {
        if self.interfaces.len() >= MAX_INTERFACE_ENTRIES && !self.interfaces.contains_key(&port) {
            return false;
        }
        let kept = self.interfaces.entry(port).or_default();
        for (option, value) in options {
            if kept.len() >= MAX_INTERFACE_ENTRIES && !kept.contains_key(&option) {
                return false;
            }
            kept.insert(option, value);
        }
        true
    }

    /// The options of a port as `OPTION=value` with blanks between; none if nothing was set.
    pub fn interface(&self, port: &Name) -> Option<String> {
        let options = self.interfaces.get(port)?;
        Some(options.iter().map(|(option, value)| format!("{option}={value}")).collect::<Vec<_>>().join(" "))
    }
}
