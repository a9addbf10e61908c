//! The views by their tabs.

use super::{View, counters, display, help, line, messages, network, structure, tablet};
use crate::console::mapping::Mouse;

/// Every view, in the order of their tabs.
///
/// - `mouse`: what the mouse does over the tablet.
pub fn all(mouse: &Mouse) -> Vec<Box<dyn View>> {
    vec![
        Box::new(network::NetworkView::default()),
        Box::new(structure::StructureView::default()),
        Box::new(line::LineView::default()),
        Box::new(counters::CountersView::default()),
        Box::new(display::DisplayView),
        Box::new(tablet::TabletView::new(mouse)),
        Box::new(messages::MessagesView),
        Box::new(help::HelpView::default()),
    ]
}
