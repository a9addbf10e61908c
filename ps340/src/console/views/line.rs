//! The bytes on the host lines, decoded.

use super::View;
use crate::{
    console::operator_commands::OperatorCommands,
    line::LineId,
    shell::{MirrorFrame, MirrorRequest, TrafficEntry},
};
use egui::Ui;
use protocol::listing::{Listing, Sender};
use std::{collections::BTreeMap, fmt::Write, sync::Arc};

/// Lines of the listing that are shown; the latest.
const MAX_LINES: usize = 2_000;
/// Bytes in a row: few, so that their meaning fits beside them.
const ROW: usize = 8;

/// A listing of what passed lately.
#[derive(Default)]
pub struct LineView {
    /// What `text` lists.
    listed: Option<Arc<Vec<TrafficEntry>>>,
    lines: Vec<String>,
}

impl View for LineView {
    fn title(&self) -> &'static str {
        "Line"
    }

    fn summary(&self) -> &'static str {
        "the bytes on the host lines, decoded"
    }

    fn request(&self, asked: &mut MirrorRequest) {
        asked.traffic = true;
    }

    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, _orders: &mut OperatorCommands) {
        if self.listed.as_ref().is_none_or(|before| !Arc::ptr_eq(before, &shown.traffic)) {
            self.lines = list(&shown.traffic);
            self.listed = Some(shown.traffic.clone());
        }
        if self.lines.is_empty() {
            ui.weak("Nothing has passed on a host line since this was opened.");
        }
        let height = ui.text_style_height(&egui::TextStyle::Monospace);
        egui::ScrollArea::both().auto_shrink(false).stick_to_bottom(true).show_rows(
            ui,
            height,
            self.lines.len(),
            |ui, rows| {
                for line in &self.lines[rows] {
                    ui.add(egui::Label::new(egui::RichText::new(line).monospace()).extend());
                }
            },
        );
    }
}

/// The listing, line by line. Older bytes may be gone: each direction begins as if it was the start of its stream.
fn list(passed: &[TrafficEntry]) -> Vec<String> {
    let mut listings: BTreeMap<(LineId, bool), Listing> = BTreeMap::new();
    let mut text = String::new();
    for piece in passed {
        let sender = if piece.from_host { Sender::Host } else { Sender::Machine };
        let listing =
            listings.entry((piece.line, piece.from_host)).or_insert_with(|| Listing::of(sender).with_row(ROW));
        let seconds = piece.micros as f64 / 1e6;
        let direction = if piece.from_host { "from" } else { "to" };
        // Writing into a string does not fail.
        let _ = writeln!(text, "{seconds:.3} s, {direction} host {}", piece.line.0);
        let _ = listing.push(&piece.bytes, &mut text);
    }
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(MAX_LINES)..].iter().map(|line| (*line).to_owned()).collect()
}
