//! What every view has, and what several show.

use crate::{
    console::operator_commands::OperatorCommands,
    shell::{MirrorFrame, MirrorRequest},
};
use egui::Ui;

/// Something to look at beside the screens.
pub trait View {
    /// The title of its tab.
    fn title(&self) -> &'static str;
    /// What it shows, in a sentence.
    fn summary(&self) -> &'static str;
    /// Whether it explains, rather than shows the machine.
    fn is_help(&self) -> bool {
        false
    }
    /// Asks the mirror for what the view shows.
    fn request(&self, asked: &mut MirrorRequest);
    /// Shows it.
    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, orders: &mut OperatorCommands);
}

/// A row of a grid: how long the beam needs for the picture, and how often it draws it.
pub(super) fn refresh_row(ui: &mut Ui, shown: &MirrorFrame) {
    ui.label("refresh");
    ui.monospace(shown.refresh.map_or("...".into(), |refresh| refresh.describe(shown.scene.controls.steady)));
    ui.end_row();
}
