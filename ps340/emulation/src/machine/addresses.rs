//! The addresses of objects that a host on the parallel interface looked up.

use protocol::{Name, parallel::ParallelError};
use std::collections::BTreeMap;

/// Where the memory of objects begins, and the step between their addresses. Ours.
pub(super) const FIRST_ADDRESS: u32 = 0x0001_0000;
const ADDRESS_STEP: u32 = 0x100;
/// Objects that a host may look up before it resets the interface. Ours.
const MAX_ADDRESSES: usize = 65_536;

/// The addresses that were given out: handles that stand for names, not places in any memory.
#[derive(Debug)]
pub(super) struct Addresses {
    /// By first address: whose, and how many words long.
    ranges: BTreeMap<u32, (Name, u32)>,
    /// The latest address of each name.
    latest: BTreeMap<Name, u32>,
    next: u32,
}

impl Default for Addresses {
    fn default() -> Addresses {
        Addresses { ranges: BTreeMap::new(), latest: BTreeMap::new(), next: FIRST_ADDRESS }
    }
}

impl Addresses {
    /// The address of a named object with so many words.
    pub(super) fn give(&mut self, name: &Name, words: u32) -> Result<u32, ParallelError> {
        let latest = self.latest.get(name).copied();
        if let Some(address) = latest.filter(|address| self.ranges.get(address).is_some_and(|range| range.1 == words)) {
            return Ok(address);
        }
        let bytes = words.checked_mul(2).and_then(|bytes| bytes.checked_next_multiple_of(ADDRESS_STEP));
        let next =
            bytes.and_then(|bytes| self.next.checked_add(bytes.max(ADDRESS_STEP))).ok_or(ParallelError::Address)?;
        if self.ranges.len() >= MAX_ADDRESSES {
            return Err(ParallelError::Address);
        }
        let address = std::mem::replace(&mut self.next, next);
        self.ranges.insert(address, (name.clone(), words));
        self.latest.insert(name.clone(), address);
        Ok(address)
    }

    /// Whose memory an address is, and which word of it.
    pub(super) fn find(&self, address: u32) -> Result<(&Name, usize), ParallelError> {
        let (begin, (name, words)) = self.ranges.range(..=address).next_back().ok_or(ParallelError::Address)?;
        let offset = address - begin;
        if !offset.is_multiple_of(2) || offset / 2 > *words {
            return Err(ParallelError::Address);
        }
        Ok((name, (offset / 2) as usize))
    }
}
