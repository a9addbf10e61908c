//! Help, from the tables: orders of the operator, commands and functions of the machine.

use super::{Asked, Orders, Shown, Ui, View};
use crate::{functions, functions::page, operator};
use egui::RichText;
use protocol::command::reference;

/// A page of the reference.
struct Page {
    title: String,
    text: String,
}

/// The reference, with a search.
#[derive(Default)]
pub struct HelpView {
    search: String,
    pages: Vec<Page>,
    open: Option<usize>,
}

/// What one can do at the window.
const WINDOW: &str = "\
Click the vector screen: what you type goes to the machine, and the mouse is the puck of the tablet; its buttons are \
left 1, middle 2, right 4, and a fourth 8.
Dials: drag, wheel or arrow keys; SHIFT is fine, CONTROL coarse; a double click is a quarter turn.
F1 to F12 are the function keys; with SHIFT the second row, with CONTROL the third.
Ctrl+Alt+H, L and C are the keys HOST, LOCAL and COMMAND, which choose where typed characters go.
PageUp is GRAPH, PageDown TERM, Home SETUP, Insert LINE FEED. 'ps340 --mapping FILE' changes what keys do.
";

impl HelpView {
    fn pages() -> Vec<Page> {
        let orders = operator::rows().map(|row| format!("{} {}\n    {}\n", row.word, row.arguments, row.summary));
        let first = [
            Page { title: "This window".into(), text: WINDOW.into() },
            Page { title: "Orders of the operator".into(), text: orders.collect() },
        ];
        let commands = reference::rows().map(|row| Page { title: row.name.to_owned(), text: row.to_string() });
        let functions = functions::all()
            .map(|row| Page { title: format!("F:{}", row.name), text: page::page(row.name).unwrap_or_default() });
        first.into_iter().chain(commands).chain(functions).collect()
    }
}

impl View for HelpView {
    fn title(&self) -> &'static str {
        "Help"
    }

    fn ask(&self, _asked: &mut Asked) {}

    fn show(&mut self, ui: &mut Ui, _shown: &Shown, _orders: &mut Orders) {
        if self.pages.is_empty() {
            self.pages = HelpView::pages();
            self.open = Some(0);
        }
        ui.horizontal(|ui| {
            let label = ui.label("Search");
            ui.text_edit_singleline(&mut self.search).labelled_by(label.id);
        });
        let search = self.search.to_ascii_lowercase();
        let found = |page: &Page| {
            page.title.to_ascii_lowercase().contains(&search)
                || (search.len() > 3 && page.text.to_ascii_lowercase().contains(&search))
        };
        egui::Panel::top("help pages").resizable(true).default_size(180.0).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                for (index, page) in self.pages.iter().enumerate().filter(|(_, page)| found(page)) {
                    if ui.selectable_label(self.open == Some(index), &page.title).clicked() {
                        self.open = Some(index);
                    }
                }
            });
        });
        egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            if let Some(page) = self.open.and_then(|index| self.pages.get(index)) {
                ui.label(RichText::new(&page.text).monospace());
            }
        });
    }
}
