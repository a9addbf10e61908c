//! The bar at the top: who is attached, and what the window shows and does. It is one row, however narrow the window
//! is.

use super::{
    choices::{Choices, MouseRole, RasterPlacement},
    operator_commands::OperatorCommands,
    views::View,
    welcome::AttachedHosts,
    widget_positions,
};
use crate::{machine::KeyboardMode, shell::MirrorFrame};
use egui::{Align, Layout, RichText, Sense, Ui, vec2};

/// From this width on, menus show what is chosen.
const WIDE: f32 = 940.0;

/// What a mode of the keyboard is called, the key that chooses it, and where characters go then.
const MODES: [(KeyboardMode, &str, &str); 3] = [
    (KeyboardMode::Terminal, "host", "characters go to the host, as from a terminal"),
    (KeyboardMode::Command, "command", "characters go to the command interpreter"),
    (KeyboardMode::Interactive, "local", "characters go to the function network"),
];

/// Keys that switch what is on the screen.
const SWITCHES: [(&str, &str); 3] = [
    ("graph", "the picture on and off"),
    ("term", "the text of the terminal on and off"),
    ("setup", "the set-up page"),
];

/// The bar.
pub struct Bar<'a> {
    /// What is to be seen of the machine.
    pub shown: &'a MirrorFrame,
    /// Who is attached.
    pub hosts: &'a AttachedHosts,
    /// What can be opened beside the screens.
    pub views: &'a [Box<dyn View>],
    /// What the mouse does over the vector screen.
    pub role: MouseRole,
    /// What draws window and screens, in words.
    pub drawn_by: &'a str,
}

impl Bar<'_> {
    /// Shows it; what is chosen becomes so, or an operator command.
    pub fn show(&self, ui: &mut Ui, choices: &mut Choices, orders: &mut OperatorCommands) {
        let is_wide = ui.available_width() >= WIDE;
        ui.horizontal(|ui| {
            ui.label(RichText::new("PS 340").strong()).on_hover_text(self.drawn_by);
            let (state, ink) = self.hosts.state(self.shown.micros);
            let (light, _) = ui.allocate_exact_size(vec2(9.0, 9.0), Sense::hover());
            ui.painter().circle_filled(light.center(), 4.0, ink);
            let state = ui.label(RichText::new(state).color(ink)).on_hover_text(self.hosts.names());
            widget_positions::note(ui, "hosts", state.rect.center());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                show_help(ui, choices, self.views);
                show_views(ui, choices, self.views, is_wide);
                ui.separator();
                let devices = ui.toggle_value(&mut choices.devices, "Devices").on_hover_text("dials, keys and buttons");
                widget_positions::note(ui, "devices", devices.rect.center());
                show_raster(ui, choices, is_wide);
                ui.separator();
                show_mouse(ui, choices, self.role, is_wide);
                show_keyboard(ui, self.shown.mode, orders, is_wide);
            });
        });
    }
}

/// The name of a menu, with what is chosen in it if there is space.
fn title(name: &str, chosen: &str, is_wide: bool) -> String {
    if is_wide { format!("{name}: {chosen}") } else { name.into() }
}

fn show_keyboard(ui: &mut Ui, now: KeyboardMode, orders: &mut OperatorCommands, is_wide: bool) {
    let chosen = MODES.iter().find(|row| row.0 == now).map_or("", |row| row.1);
    let menu = ui.menu_button(title("Keyboard", chosen, is_wide), |ui| {
        for (mode, key, hint) in MODES {
            if ui.selectable_label(now == mode, format!("{}  {hint}", key.to_uppercase())).clicked() {
                orders.give(format!("key {key}"));
                ui.close();
            }
        }
        ui.separator();
        for (key, hint) in SWITCHES {
            if ui.button(format!("{}  {hint}", key.to_uppercase())).clicked() {
                orders.give(format!("key {key}"));
                ui.close();
            }
        }
    });
    widget_positions::note(ui, "menu Keyboard", menu.response.rect.center());
}

fn show_mouse(ui: &mut Ui, choices: &mut Choices, role: MouseRole, is_wide: bool) {
    let menu = ui.menu_button(title("Mouse", role.word(), is_wide), |ui| {
        let rows = [
            (Some(MouseRole::Dials), "turns dials: drag turns, SHIFT or the right button moves, the wheel scales"),
            (Some(MouseRole::Puck), "is the puck of the tablet"),
            (None, "is the puck as long as a program reads the tablet, and turns dials else"),
        ];
        for (chosen, text) in rows {
            if ui.selectable_label(choices.role == chosen, text).clicked() {
                choices.role = chosen;
                ui.close();
            }
        }
    });
    widget_positions::note(ui, "menu Mouse", menu.response.rect.center());
}

fn show_raster(ui: &mut Ui, choices: &mut Choices, is_wide: bool) {
    let menu = ui.menu_button(title("Raster", choices.raster.word(), is_wide), |ui| {
        for place in [RasterPlacement::Hidden, RasterPlacement::Beside, RasterPlacement::Apart] {
            if ui.selectable_label(choices.raster == place, place.summary()).clicked() {
                choices.raster = place;
                ui.close();
            }
        }
    });
    widget_positions::note(ui, "menu Raster", menu.response.rect.center());
}

fn show_views(ui: &mut Ui, choices: &mut Choices, views: &[Box<dyn View>], is_wide: bool) {
    let open = choices.view.and_then(|index| views.get(index)).filter(|view| !view.is_help());
    let chosen = open.map_or("none", |view| view.title());
    let menu = ui.menu_button(title("Inspect", chosen, is_wide), |ui| {
        for (index, view) in views.iter().enumerate().filter(|(_, view)| !view.is_help()) {
            let is_open = choices.view == Some(index);
            let row = ui.selectable_label(is_open, view.title()).on_hover_text(view.summary());
            widget_positions::note(ui, &format!("view {}", view.title()), row.rect.center());
            if row.clicked() {
                choices.view = (!is_open).then_some(index);
                ui.close();
            }
        }
    });
    widget_positions::note(ui, "menu Inspect", menu.response.rect.center());
}

fn show_help(ui: &mut Ui, choices: &mut Choices, views: &[Box<dyn View>]) {
    let Some(index) = views.iter().position(|view| view.is_help()) else { return };
    let is_open = choices.view == Some(index);
    let help = ui.selectable_label(is_open, views[index].title());
    widget_positions::note(ui, "view Help", help.rect.center());
    if help.clicked() {
        choices.view = (!is_open).then_some(index);
    }
}
