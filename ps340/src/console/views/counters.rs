//! Counters and rates.

use super::{View, view::refresh_row};
use crate::{
    console::operator_commands::OperatorCommands,
    machine::Counters,
    shell::{MirrorFrame, MirrorRequest},
};
use egui::Ui;

/// Microseconds between two measurements of a rate.
const BETWEEN: u64 = 500_000;

/// The counters, with rates.
#[derive(Default)]
pub struct CountersView {
    /// When and what was counted last, and the rates until then.
    before: Option<(u64, Counters)>,
    /// Updates, firings and bytes a second.
    rates: [f64; 3],
}

impl CountersView {
    fn measure(&mut self, shown: &MirrorFrame) {
        let now = &shown.counters;
        let (then, before) = *self.before.get_or_insert((shown.micros, *now));
        let passed = shown.micros.saturating_sub(then);
        if passed < BETWEEN {
            return;
        }
        let counts = [(now.updates, before.updates), (now.firings, before.firings), (now.bytes_in, before.bytes_in)];
        self.rates = counts.map(|(now, before)| now.saturating_sub(before) as f64 * 1e6 / passed as f64);
        self.before = Some((shown.micros, *now));
    }
}

impl View for CountersView {
    fn title(&self) -> &'static str {
        "Counters"
    }

    fn summary(&self) -> &'static str {
        "counters, rates, and who is attached"
    }

    fn request(&self, asked: &mut MirrorRequest) {
        asked.refresh = true;
    }

    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, _orders: &mut OperatorCommands) {
        self.measure(shown);
        let now = &shown.counters;
        let [updates, firings, bytes] = self.rates;
        let rows = [
            ("frame", now.frame.to_string()),
            ("updates of the picture", format!("{} ({updates:.1} a second)", now.updates)),
            ("vectors of the latest update", now.vectors.to_string()),
            ("strokes on the screen", shown.scene.strokes.len().to_string()),
            ("their light is drawn by", shown.drawer.to_string()),
            ("firings", format!("{} ({firings:.0} a second)", now.firings)),
            ("commands", now.commands.to_string()),
            ("bytes from hosts", format!("{} ({bytes:.0} a second)", now.bytes_in)),
            ("messages to hosts", now.messages_out.to_string()),
            ("messages of the machine", now.messages.to_string()),
            ("bytes that were nothing", now.noise.to_string()),
            ("objects", now.objects.to_string()),
            ("bytes of mass memory", now.bytes.to_string()),
        ];
        egui::Grid::new("counters").striped(true).num_columns(2).show(ui, |ui| {
            for (name, value) in rows {
                ui.label(name);
                ui.monospace(value);
                ui.end_row();
            }
            refresh_row(ui, shown);
        });
        ui.separator();
        ui.label("Hosts");
        if shown.hosts.is_empty() {
            ui.weak("none is attached");
        }
        for host in &shown.hosts {
            ui.monospace(host);
        }
    }
}
