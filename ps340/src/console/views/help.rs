//! Help, from the tables: operator commands, commands and functions of the machine.

use super::View;
use crate::{
    console::operator_commands::OperatorCommands,
    functions,
    functions::page,
    operator,
    shell::{MirrorFrame, MirrorRequest},
};
use egui::{RichText, Ui};
use protocol::command::reference;

/// A page of the reference.
struct Page {
    title: String,
    text: String,
    /// Whether it is a text to read, rather than a table.
    is_prose: bool,
}

/// The reference, with a search.
#[derive(Default)]
pub struct HelpView {
    search: String,
    pages: Vec<Page>,
    open: Option<usize>,
}

/// How to do what one wants to do at the window.
const TASKS: &str = "\
SHOW A SCENE
In a terminal: peris show teapot opens a window like this one. 'peris show teapot --to LINE' shows it here; LINE \
stands on the empty screen.

TURN, MOVE AND SCALE IT
Drag on the vector screen: it turns. With SHIFT, or by the right or middle button: it moves. Wheel: it scales. With \
CONTROL: it rolls, and comes nearer. Or turn a dial below: drag it, roll the wheel over it, or click it and use the \
arrow keys; SHIFT is fine, CONTROL coarse; a double click is a quarter turn.

RENDER THE VIEW
Key F1, RENDER. The picture grows on the raster screen, which comes into view; the label over the key and the line at \
the bottom of the vector screen tell how far it is. F4, CANCEL, stops it.

KEEP THE VIEW
Key F3, CAMERA: PERIS writes it as a line for the scene's script.

RUN A PROGRAM OF THE TIME
The empty screen offers some. To run your own: ps340 --window --listen file:PROGRAM or send it to the host line, as \
with 'nc'. Inspect shows its functions, its structure and what goes over the line.

TYPE COMMANDS
Keyboard, COMMAND; then click the vector screen and type, such as: DISPLAY A; Keyboard, LOCAL gives the keys back to \
the program that runs.

USE THE TABLET
While a program reads the tablet, the mouse is its puck: left button 1, middle 2, right 4. The menu Mouse chooses. The \
whole tablet stands under Inspect, Tablet.

KEYS
F1 to F12 are the function keys; SHIFT and CONTROL make them 13 to 24 and 25 to 36. Ctrl+Alt+H, L, C: keyboard to \
host, local, command. PageUp GRAPH, PageDown TERM, Home SETUP, Insert LINE FEED. 'ps340 mapping' prints what keys, \
mouse and game controllers do; 'ps340 --window --mapping FILE' changes it.

MAKE THE PICTURE BRIGHTER
Inspect, Display: brightness, contrast, focus, and the phosphor of the tube.
";

impl HelpView {
    fn pages() -> Vec<Page> {
        let orders = operator::rows().map(|row| format!("{} {}\n    {}\n", row.word, row.arguments, row.summary));
        let first = [
            Page { title: "What do you want to do?".into(), text: TASKS.into(), is_prose: true },
            Page { title: "Orders of the operator".into(), text: orders.collect(), is_prose: false },
        ];
        let commands =
            reference::rows().map(|row| Page { title: row.name.to_owned(), text: row.to_string(), is_prose: false });
        let functions = functions::all()
            .map(|row| (format!("F:{}", row.name), page::page(row.name).unwrap_or_default()))
            .map(|(title, text)| Page { title, text, is_prose: false });
        first.into_iter().chain(commands).chain(functions).collect()
    }
}

impl View for HelpView {
    fn title(&self) -> &'static str {
        "Help"
    }

    fn summary(&self) -> &'static str {
        "how to do what, and the reference"
    }

    fn is_help(&self) -> bool {
        true
    }

    fn request(&self, _asked: &mut MirrorRequest) {}

    fn show(&mut self, ui: &mut Ui, _shown: &MirrorFrame, _orders: &mut OperatorCommands) {
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
                let text = RichText::new(&page.text);
                ui.label(if page.is_prose { text } else { text.monospace() });
            }
        });
    }
}
