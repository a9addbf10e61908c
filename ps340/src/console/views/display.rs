//! The knobs of the display, its phosphor, and how the beam keeps up.

use super::{View, view::refresh_row};
use crate::{
    calligraphic::{KNOBS, PHOSPHORS, SCREENS},
    console::{operator_commands::OperatorCommands, widget_positions},
    shell::{MirrorFrame, MirrorRequest},
};
use egui::{ComboBox, Slider, Ui, vec2};

/// What a person sets at the display.
pub struct DisplayView;

impl View for DisplayView {
    fn title(&self) -> &'static str {
        "Display"
    }

    fn summary(&self) -> &'static str {
        "brightness, contrast, focus and phosphor"
    }

    fn request(&self, asked: &mut MirrorRequest) {
        asked.refresh = true;
    }

    fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame, orders: &mut OperatorCommands) {
        let controls = &shown.scene.controls;
        egui::Grid::new("display").num_columns(2).show(ui, |ui| {
            for knob in KNOBS {
                ui.label(knob.name);
                let mut at = knob.get(controls);
                let slider = ui.add(Slider::new(&mut at, 0.0..=1.0).fixed_decimals(2));
                widget_positions::note(ui, &format!("knob {}", knob.name), slider.rect.left_center() + vec2(2.0, 0.0));
                if slider.changed() {
                    orders.give(format!("knob {} {at}", knob.name));
                }
                ui.end_row();
            }
            ui.label("phosphor");
            ComboBox::from_id_salt("phosphor").selected_text(controls.phosphor.name).show_ui(ui, |ui| {
                for row in PHOSPHORS {
                    let text = format!("{}: {}", row.name, row.summary);
                    let is_chosen = row == controls.phosphor;
                    if ui.selectable_label(is_chosen, text).on_hover_text(row.source).clicked() {
                        orders.give(format!("phosphor {}", row.name));
                    }
                }
            });
            ui.end_row();
            ui.label("screen").on_hover_text("which of the screens of SET DISPLAYS");
            ui.horizontal(|ui| {
                for screen in 0..SCREENS {
                    if ui.selectable_label(controls.screen == screen, screen.to_string()).clicked() {
                        orders.give(format!("screen {screen}"));
                    }
                }
            });
            ui.end_row();
            ui.label("steady");
            let mut steady = controls.steady;
            let warning =
                "Off, a picture that takes long flickers as it did, 3 to 30 times a second: this can harm people.";
            if ui.checkbox(&mut steady, "hold a long picture still").on_hover_text(warning).changed() {
                orders.give(format!("steady {}", if steady { "on" } else { "off" }));
            }
            ui.end_row();
            refresh_row(ui, shown);
        });
    }
}
