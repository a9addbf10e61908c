//! The machine as a whole: owns the parts, wires them, and moves in steps. No thread, window or wall clock here.

mod time;
mod counters;
mod describe;
mod device_message;
mod key;
mod dials;
mod tablet;
mod devices;
mod keyboard;
mod panel;
mod host_line;
mod mailbox;
mod addresses;
mod parallel_line;
mod lines;
mod outgoing;
mod host_messages;
mod reports;
mod streams;
mod pending;
mod latest_update;
mod renderings;
mod vector_display;
mod tube;
mod monitor;
mod memory_release;
mod initial;
mod input;
mod whole;
mod reporting;
mod executing;
mod interpreting;
mod listening;
mod parallel;
mod typing;
mod updating;
mod overlay;
mod displaying;
mod rendering;
mod monitoring;
mod carry;
mod steps;
mod inspection;

pub use counters::Counters;
pub use devices::Event;
pub use host_line::PlainText;
pub use input::{Input, Settings};
pub use key::{Key, KeyboardMode};
pub use outgoing::HostOutput;
pub use panel::Panel;
pub use reports::REPORTS_PER_FRAME;
pub use tablet::TabletEvent;
pub use time::{FRAMES_PER_SECOND, Micros, WORK_PER_STEP, time_of_frame};
pub use whole::Machine;

#[cfg(test)]
mod answer_tests;
#[cfg(test)]
mod device_tests;
#[cfg(test)]
mod line_tests;
#[cfg(test)]
mod rendering_tests;
#[cfg(test)]
mod display_tests;
#[cfg(test)]
mod tests;
