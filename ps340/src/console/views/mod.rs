//! Views of the machine's inside: one a part, beside the screens.

mod counters;
mod display;
mod help;
mod line;
mod messages;
mod network;
mod structure;
mod tablet;

use super::{mapping::Mouse, orders::Orders};
use crate::shell::{Asked, Shown};
use egui::Ui;

/// Something to look at beside the screens.
pub trait View {
    /// What its tab says.
    fn title(&self) -> &'static str;
    /// What it shows, in a sentence.
    fn summary(&self) -> &'static str;
    /// Whether it explains, rather than shows the machine.
    fn is_help(&self) -> bool {
        false
    }
    /// Asks the mirror for what the view shows.
    fn ask(&self, asked: &mut Asked);
    /// Shows it.
    fn show(&mut self, ui: &mut Ui, shown: &Shown, orders: &mut Orders);
}

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

/// A row of a grid: how long the beam needs for the picture, and how often it draws it.
fn refresh_row(ui: &mut Ui, shown: &Shown) {
    ui.label("refresh");
    ui.monospace(shown.refresh.map_or("...".into(), |refresh| refresh.describe(shown.scene.controls.steady)));
    ui.end_row();
}
