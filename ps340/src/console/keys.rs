//! The twelve function keys with their labels, and the thirty-two lighted buttons.

use super::{
    dials::{LIT, show_label},
    operator_commands::OperatorCommands,
    widget_positions,
};
use crate::{machine::Panel, port::Label};
use egui::{Align2, Color32, FontId, Rect, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

/// The row of the function keys that a click presses, if no key is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Row {
    /// 1 to 12.
    #[default]
    Plain,
    /// 13 to 24.
    Shift,
    /// 25 to 36.
    Control,
}

/// Height of a lighted button.
const BUTTON_HEIGHT: f32 = 22.0;
/// Width of the choice of the row.
const CHOICE: f32 = 58.0;

/// Shows the function keys in a row of a width, and gives the operator commands of those that are pressed.
pub fn show_keys(ui: &mut Ui, panel: &Panel, row: &mut Row, width: f32, orders: &mut OperatorCommands) {
    ui.horizontal(|ui| {
        let column = ((width - CHOICE - 12.0 * ui.spacing().item_spacing.x) / 12.0).max(1.0);
        for key in 1..=12_u8 {
            let label = String::from_utf8_lossy(panel.label(Label::Key(key))).into_owned();
            let (area, response) = ui.allocate_exact_size(vec2(column, 42.0), Sense::click());
            let name = format!("F{key} {label}");
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            show_label(ui, Rect::from_min_size(area.min, vec2(area.width(), 18.0)), &label);
            let cap = Rect::from_min_max(area.min + vec2(2.0, 20.0), area.max - vec2(2.0, 0.0));
            let fill = if response.is_pointer_button_down_on() { 30 } else { 62 };
            ui.painter().rect_filled(cap, 4.0, Color32::from_gray(fill));
            ui.painter().text(
                cap.center(),
                Align2::CENTER_CENTER,
                format!("F{key}"),
                FontId::proportional(12.0),
                Color32::from_gray(220),
            );
            widget_positions::note(ui, &format!("key {key}"), cap.center());
            let held = ui.input(|input| input.modifiers);
            if response.on_hover_text("with SHIFT 13 to 24, with CONTROL 25 to 36").clicked() {
                let other = match *row {
                    _ if held.shift => " shift",
                    _ if held.ctrl => " control",
                    Row::Plain => "",
                    Row::Shift => " shift",
                    Row::Control => " control",
                };
                orders.give(format!("key {key}{other}"));
            }
        }
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (value, text) in [(Row::Plain, "plain"), (Row::Shift, "SHIFT"), (Row::Control, "CTRL")] {
                ui.radio_value(row, value, egui::RichText::new(text).small());
            }
        });
    });
}

/// Shows the lighted buttons in rows, and gives the operator commands of those that are pressed.
///
/// - `grid`: rows, and buttons in each of them. `width`: of a row.
pub fn show_buttons(ui: &mut Ui, panel: &Panel, [rows, columns]: [u8; 2], width: f32, orders: &mut OperatorCommands) {
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        let column = ((width - 3.0 * f32::from(columns - 1)) / f32::from(columns)).max(1.0);
        for row in 0..rows {
            ui.horizontal(|ui| {
                for number in row * columns + 1..=(row + 1) * columns {
                    show_button(ui, panel, number, column, orders);
                }
            });
        }
    });
}

fn show_button(ui: &mut Ui, panel: &Panel, button: u8, width: f32, orders: &mut OperatorCommands) {
    let (area, response) = ui.allocate_exact_size(vec2(width, BUTTON_HEIGHT), Sense::click());
    let is_lit = panel.light(button);
    let name = format!("button {button}{}", if is_lit { ", lit" } else { "" });
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    let (fill, ink) = if is_lit { (LIT, Color32::BLACK) } else { (Color32::from_gray(52), Color32::from_gray(150)) };
    let edge = Stroke::new(1.0, Color32::from_gray(if response.is_pointer_button_down_on() { 200 } else { 90 }));
    ui.painter().rect(area, 3.0, fill, edge, egui::StrokeKind::Inside);
    ui.painter().text(area.center(), Align2::CENTER_CENTER, button, FontId::proportional(11.0), ink);
    widget_positions::note(ui, &format!("button {button}"), area.center());
    if response.clicked() {
        orders.give(format!("button {button}"));
    }
}
