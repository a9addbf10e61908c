//! Memory: how much of it the process holds, how much it may hold, and large pages.

mod budget;
mod counted;
mod file;
mod pages;

pub use budget::{MemoryExceeded, left, limit, limit_to, machine, peak, readable, reserve};
pub use counted::{Counted, held};
pub use file::{read, read_text};
pub use pages::prefer_large_pages;
