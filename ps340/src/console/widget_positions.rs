//! Where the devices are in the window, for scripts that work it by the events of the window system.
//!
//! With `PS340_LOG=debug` each device is logged when it comes to another position: `dial 1 at 52 741`, in pixels from
//! the window's upper left corner.

use egui::{Id, Pos2, Ui};

/// Notes that a device is in the middle of `at`; logs it if it was elsewhere before.
pub fn note(ui: &Ui, device: &str, at: Pos2) {
    if !tracing::enabled!(tracing::Level::DEBUG) {
        return;
    }
    let pixels = at * ui.pixels_per_point();
    let [x, y] = [pixels.x.round() as i32, pixels.y.round() as i32];
    let id = Id::unique(("place", device));
    if ui.data(|data| data.get_temp::<[i32; 2]>(id)) != Some([x, y]) {
        ui.data_mut(|data| data.insert_temp(id, [x, y]));
        tracing::debug!("{device} at {x} {y}");
    }
}
