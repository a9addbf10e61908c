//! The display structure as a tree.

use super::View;
use crate::{
    console::{operator_commands::OperatorCommands, readable::rounded},
    shell::{MirrorFrame, MirrorRequest},
};
use egui::Ui;

/// The tree, with a filter.
#[derive(Default)]
pub struct StructureView {
    filter: String,
}

impl View for StructureView {
    fn title(&self) -> &'static str {
        "Structure"
    }

    fn summary(&self) -> &'static str {
        "the display structure as a tree"
    }

    fn request(&self, asked: &mut MirrorRequest) {
        asked.structure = true;
    }

    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, _orders: &mut OperatorCommands) {
        ui.horizontal(|ui| {
            let label = ui.label("Lines with");
            ui.text_edit_singleline(&mut self.filter).labelled_by(label.id);
        });
        if shown.structure.is_empty() {
            ui.weak("Nothing is displayed.");
        }
        let filter = self.filter.to_ascii_uppercase();
        let lines: Vec<_> =
            shown.structure.iter().filter(|node| node.text.to_ascii_uppercase().contains(&filter)).collect();
        let height = ui.text_style_height(&egui::TextStyle::Monospace);
        egui::ScrollArea::both().auto_shrink(false).show_rows(ui, height, lines.len(), |ui, rows| {
            for node in &lines[rows] {
                let readable = rounded(&node.text);
                let line = ui.add(egui::Label::new(format!("{}{readable}", "  ".repeat(node.level))).extend());
                if readable != node.text {
                    line.on_hover_text(&node.text);
                }
            }
        });
    }
}
