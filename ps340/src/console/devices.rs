//! Dials, function keys and lighted buttons, in rows that fit the width of the window.

use super::{
    dials::DialPanel,
    keys::{Row, show_buttons, show_keys},
    operator_commands::OperatorCommands,
};
use crate::machine::Panel;
use egui::{Ui, vec2};

/// From this width on, the buttons stand beside dials and keys; else below them, in two rows.
const WIDE: f32 = 1120.0;
/// Width of the buttons beside them.
const BUTTONS: f32 = 264.0;
/// Dials and keys grow up to this width.
const MOST: f32 = 1400.0;

/// Shows them, and gives the operator commands of what is turned and pressed.
pub fn show(ui: &mut Ui, panel: &Panel, dials: &mut DialPanel, row: &mut Row, orders: &mut OperatorCommands) {
    ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
    let width = ui.available_width();
    if width >= WIDE {
        let block = (width - BUTTONS - 24.0).min(MOST);
        ui.horizontal(|ui| {
            // In the middle of a very wide window.
            ui.add_space(((width - block - BUTTONS - 24.0) / 2.0).max(0.0));
            ui.vertical(|ui| {
                dials.show(ui, panel, block);
                show_keys(ui, panel, row, block, orders);
            });
            ui.separator();
            show_buttons(ui, panel, [4, 8], BUTTONS, orders);
        });
    } else {
        dials.show(ui, panel, width);
        show_keys(ui, panel, row, width, orders);
        show_buttons(ui, panel, [2, 16], width, orders);
    }
}
