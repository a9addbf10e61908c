//! What stands on the vector screen while nobody shows anything there: where hosts attach, and what one can do.

use super::{operator_commands::OperatorCommands, widget_positions};
use crate::{example::EXAMPLES, shell::MirrorFrame};
use egui::{Align2, Color32, FontId, Layout, Rect, RichText, Ui, UiBuilder, vec2};

/// Width that the text takes at most.
const WIDTH: f32 = 460.0;
/// Height that it takes about.
const TEXT_HEIGHT: f32 = 250.0;
const INK: Color32 = Color32::from_gray(205);
const WEAK: Color32 = Color32::from_gray(135);
const GOOD: Color32 = Color32::from_rgb(120, 200, 130);

/// Hosts as they attached and left.
#[derive(Debug, Default)]
pub struct AttachedHosts {
    /// Who is attached.
    present: Vec<String>,
    /// Who left last, and when, in microseconds of the machine.
    left: Option<(String, u64)>,
}

impl AttachedHosts {
    /// Notes who is attached now.
    pub fn note(&mut self, shown: &MirrorFrame) {
        if self.present != shown.hosts {
            let gone = self.present.iter().find(|host| !shown.hosts.contains(host));
            self.left = gone.map(|host| (host.clone(), shown.micros)).or(self.left.take());
            self.present.clone_from(&shown.hosts);
        }
    }

    /// How many are attached, or when the last one left: for the bar.
    pub fn state(&self, micros: u64) -> (String, Color32) {
        match (&self.present[..], &self.left) {
            ([], None) => ("no host yet".into(), WEAK),
            ([], Some((_, left))) => {
                let seconds = micros.saturating_sub(*left) / 1_000_000;
                let ago = match seconds {
                    0..60 => format!("{seconds} s"),
                    60..3600 => format!("{} min", seconds / 60),
                    _ => format!("{} h", seconds / 3600),
                };
                (format!("host left {ago} ago"), Color32::from_rgb(235, 170, 80))
            }
            ([_], _) => ("1 host".into(), GOOD),
            (several, _) => (format!("{} hosts", several.len()), GOOD),
        }
    }

    /// Who is attached, or who was, a line each.
    pub fn names(&self) -> String {
        match (&self.present[..], &self.left) {
            ([], None) => "no host has attached yet".into(),
            ([], Some((host, _))) => format!("{host} has left"),
            (several, _) => several.join("\n"),
        }
    }

    /// Whether the last host has left.
    fn have_left(&self) -> bool {
        self.present.is_empty() && self.left.is_some()
    }
}

/// Shows what one can do, if nothing is on the screen, or that the host has left.
///
/// - `lines`: where hosts attach.
pub fn show(
    ui: &mut Ui,
    screen: Rect,
    shown: &MirrorFrame,
    guests: &AttachedHosts,
    lines: &[String],
    orders: &mut OperatorCommands,
) {
    let is_empty = shown.scene.strokes.is_empty();
    match (is_empty, guests.present.is_empty(), guests.have_left()) {
        (true, true, has_left) => show_welcome(ui, screen, has_left, lines, orders),
        (true, false, _) => note(ui, screen, "a host is attached, and shows nothing yet"),
        (false, _, true) => note(ui, screen, "the host has left; its picture stays"),
        (false, ..) => {}
    }
}

/// A line at the upper edge of the screen.
fn note(ui: &Ui, screen: Rect, text: &str) {
    let at = screen.center_top() + vec2(0.0, 14.0);
    let text = ui.painter().layout_no_wrap(text.into(), FontId::proportional(13.0), WEAK);
    let behind = Align2::CENTER_CENTER.anchor_size(at, text.size()).expand2(vec2(10.0, 4.0));
    ui.painter().rect_filled(behind, 4.0, Color32::from_black_alpha(200));
    ui.painter().galley(Align2::CENTER_CENTER.anchor_size(at, text.size()).min, text, WEAK);
}

fn show_welcome(ui: &mut Ui, screen: Rect, has_left: bool, lines: &[String], orders: &mut OperatorCommands) {
    let width = WIDTH.min(screen.width() - 24.0).max(1.0);
    let size = vec2(width, (screen.height() - 24.0).max(1.0));
    let area = Rect::from_center_size(screen.center(), size);
    let builder = UiBuilder::new().max_rect(area).layout(Layout::top_down(egui::Align::Min));
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(screen);
        ui.spacing_mut().item_spacing = vec2(6.0, 5.0);
        ui.add_space(((size.y - TEXT_HEIGHT) / 2.0).max(0.0));
        let title = if has_left { "The host has left" } else { "PS 340" };
        ui.label(RichText::new(title).size(22.0).color(INK));
        let line = lines.first();
        match line {
            Some(line) => {
                ui.label(RichText::new("It waits for a host on").color(WEAK));
                for line in lines {
                    show_copied(ui, line);
                }
                if !line.contains(' ') && (line.starts_with("tcp:") || line.starts_with("unix:")) {
                    ui.add_space(8.0);
                    ui.label(RichText::new("Show a scene of PERIS on it, from a terminal:").color(WEAK));
                    show_copied(ui, &format!("peris show teapot --to {line}"));
                }
            }
            None => drop(ui.label(RichText::new("It listens nowhere.").color(WEAK))),
        }
        ui.add_space(8.0);
        ui.label(RichText::new("Or run a program of its own:").color(WEAK));
        ui.horizontal_wrapped(|ui| {
            for example in EXAMPLES {
                let button = ui.button(example.name).on_hover_text(example.summary());
                widget_positions::note(ui, &format!("example {}", example.name), button.rect.center());
                if button.clicked() {
                    orders.give(format!("example {}", example.name));
                }
            }
        });
        ui.add_space(8.0);
        ui.label(RichText::new("Help, in the bar above, says how to do what.").color(WEAK));
    });
}

/// A line of text with a button that copies it.
fn show_copied(ui: &mut Ui, text: &str) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(text).monospace().color(INK));
        if ui.small_button("copy").clicked() {
            ui.ctx().copy_text(text.to_owned());
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_come_and_leave() {
        let mut guests = AttachedHosts::default();
        let shown = |hosts: &[&str], seconds: u64| MirrorFrame {
            hosts: hosts.iter().map(|host| (*host).to_owned()).collect(),
            micros: seconds * 1_000_000,
            ..MirrorFrame::default()
        };
        let mut state = |hosts: &[&str], seconds: u64| {
            let shown = shown(hosts, seconds);
            guests.note(&shown);
            guests.state(shown.micros).0
        };
        assert_eq!(state(&[], 0), "no host yet");
        assert_eq!(state(&["a"], 1), "1 host");
        assert_eq!(state(&["a", "b"], 2), "2 hosts");
        assert_eq!(state(&["b"], 3), "1 host");
        assert_eq!(state(&[], 10), "host left 0 s ago");
        assert_eq!(state(&[], 75), "host left 1 min ago");
        assert_eq!(state(&["c"], 80), "1 host");
    }
}
