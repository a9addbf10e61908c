//! The numbered messages of the machine.

use super::View;
use crate::{
    console::operator_commands::OperatorCommands,
    shell::{MirrorFrame, MirrorRequest},
};
use egui::Ui;

/// The latest messages.
pub struct MessagesView;

impl View for MessagesView {
    fn title(&self) -> &'static str {
        "Messages"
    }

    fn summary(&self) -> &'static str {
        "what the machine reports"
    }

    fn request(&self, asked: &mut MirrorRequest) {
        asked.log = true;
    }

    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, _orders: &mut OperatorCommands) {
        if shown.log.is_empty() {
            ui.weak("The machine has had nothing to say.");
        }
        egui::ScrollArea::both().auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
            for message in shown.log.iter() {
                ui.monospace(message);
            }
        });
    }
}
