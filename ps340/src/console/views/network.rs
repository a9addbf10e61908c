//! The function network: each function with its queues, its latest values and how often it fires.

use super::View;
use crate::{
    console::{operator_commands::OperatorCommands, readable::rounded},
    shell::{FunctionShown, MirrorFrame, MirrorRequest},
};
use egui::{Color32, RichText, Ui};
use std::collections::HashMap;

/// Microseconds between two measurements of the firing rates.
const BETWEEN: u64 = 500_000;

/// The functions whose names hold a text.
#[derive(Default)]
pub struct NetworkView {
    filter: String,
    /// When the firings were counted last.
    measured: u64,
    /// Firings then, and firings a second until then, by name.
    rates: HashMap<String, (u64, f64)>,
}

impl NetworkView {
    fn measure(&mut self, shown: &MirrorFrame) {
        let passed = shown.micros.saturating_sub(self.measured);
        if passed < BETWEEN {
            return;
        }
        let rates = shown.network.iter().map(|function| {
            let firings = function.activity.firings;
            let before = self.rates.get(&function.name).map_or(firings, |(before, _)| *before);
            let rate = firings.saturating_sub(before) as f64 * 1e6 / passed as f64;
            (function.name.clone(), (firings, rate))
        });
        self.rates = rates.collect();
        self.measured = shown.micros;
    }
}

impl View for NetworkView {
    fn title(&self) -> &'static str {
        "Network"
    }

    fn summary(&self) -> &'static str {
        "functions with their queues, and how often they fire"
    }

    fn request(&self, asked: &mut MirrorRequest) {
        asked.network = Some(self.filter.to_ascii_uppercase());
    }

    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, orders: &mut OperatorCommands) {
        self.measure(shown);
        ui.horizontal(|ui| {
            let label = ui.label("Names with");
            ui.add(egui::TextEdit::singleline(&mut self.filter).desired_width(120.0)).labelled_by(label.id);
            if ui.button("step").on_hover_text("let one function fire, and stop the network").clicked() {
                orders.give("step");
            }
            if ui.button("continue").on_hover_text("let a stopped network go on").clicked() {
                orders.give("continue");
            }
        });
        if shown.network.is_empty() {
            ui.weak("No function has an arc, or a name with this text.");
        }
        egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            for function in shown.network.iter() {
                let rate = self.rates.get(&function.name).map_or(0.0, |(_, rate)| *rate);
                show_function(ui, function, rate);
            }
        });
    }
}

fn show_function(ui: &mut Ui, function: &FunctionShown, rate: f64) {
    ui.horizontal(|ui| {
        let color = match (function.is_ready, rate > 0.0) {
            (true, _) => Color32::from_rgb(255, 196, 64),
            (_, true) => Color32::from_rgb(120, 220, 120),
            _ => ui.visuals().text_color(),
        };
        ui.label(RichText::new(&function.name).strong().color(color));
        ui.weak(format!("F:{}", function.function));
        if rate > 0.0 {
            ui.monospace(format!("{rate:.0}/s"));
        }
        if function.activity.lost > 0 {
            ui.colored_label(Color32::from_rgb(255, 90, 70), format!("{} lost", function.activity.lost));
        }
    });
    ui.indent(&function.name, |ui| {
        for (number, input) in (1..).zip(&function.inputs) {
            if input.first.is_empty() && input.waiting == 0 {
                continue;
            }
            let waiting = match (input.is_active, input.waiting) {
                (false, _) => "constant".to_owned(),
                (true, 1) => "1 waits".to_owned(),
                (true, count) => format!("{count} wait"),
            };
            ui.label(RichText::new(format!("<{number}> {waiting}: {}", rounded(&input.first))).monospace());
        }
        for arc in &function.arcs {
            ui.label(RichText::new(format!("<{}> to {}", arc.output, arc.to)).monospace().weak());
        }
    });
}
