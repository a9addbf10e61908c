//! The eight dials with their labels.

use super::{operator_commands::OperatorCommands, widget_positions};
use crate::{machine::Panel, port::Label};
use egui::{
    Align2, Color32, Event, FontId, Key, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke, Ui, Vec2,
    WidgetInfo, vec2,
};
use std::f32::consts::TAU;

/// Points of dragging that are a turn.
const POINTS_PER_TURN: f64 = 240.0;
/// Points of the wheel that are a turn.
const WHEEL_PER_TURN: f64 = 1600.0;
/// Turns of one stroke of an arrow key.
const KEY_TURNS: f64 = 1.0 / 64.0;
/// Diameter of a dial in a wide window.
const MOST_SIZE: f32 = 64.0;
/// What SHIFT makes of a movement, and what CONTROL does.
const FINE: f64 = 0.1;
const COARSE: f64 = 10.0;
/// The colour of the light-emitting diodes of labels and lights.
pub const LIT: Color32 = Color32::from_rgb(255, 84, 56);

/// The dials.
#[derive(Default)]
pub struct DialPanel {
    /// Where each mark points, in turns.
    turned: [f64; 8],
    /// Turns for which no operator command was given yet.
    pending: [f64; 8],
    /// Where the mouse was when the dial that it holds was turned last.
    drag: Option<(u8, Pos2)>,
}

impl DialPanel {
    /// Turns a dial (1..=8) by something else than its picture.
    pub fn turn(&mut self, dial: u8, turns: f64) {
        if let Some(index) = usize::from(dial).checked_sub(1).filter(|index| *index < 8) {
            self.turned[index] += turns;
            self.pending[index] += turns;
        }
    }

    /// Shows the dials in a row of a width, and gives the operator commands of what is turned.
    pub fn show(&mut self, ui: &mut Ui, panel: &Panel, width: f32) {
        ui.horizontal(|ui| {
            let column = ((width - 7.0 * ui.spacing().item_spacing.x) / 8.0).max(1.0);
            let mut knobs = Vec::new();
            for dial in 1..=8 {
                let label = String::from_utf8_lossy(panel.label(Label::Dial(dial))).into_owned();
                let (knob, turns) = self.show_dial(ui, dial, &label, column);
                knobs.push(knob);
                self.turn(dial, turns);
            }
            let rate = rate(ui);
            for (dial, turns) in ui.input(|input| self.drag(&input.events, &knobs)) {
                self.turn(dial, turns * rate);
            }
        });
    }

    /// Gives the operator commands of what was turned.
    pub fn give(&mut self, orders: &mut OperatorCommands) {
        for (dial, pending) in (1..).zip(&mut self.pending) {
            if *pending != 0.0 {
                orders.give(format!("dial {dial} {pending}"));
                *pending = 0.0;
            }
        }
    }

    /// Shows one dial; returns where it is, and by how many turns wheel and keys turn it.
    fn show_dial(&self, ui: &mut Ui, dial: u8, label: &str, width: f32) -> (Rect, f64) {
        let size = (width * 0.6).clamp(40.0, MOST_SIZE).min(width);
        let (area, _) = ui.allocate_exact_size(vec2(width, size + 22.0), Sense::hover());
        let strip = Rect::from_min_size(area.min, vec2(width, 18.0));
        show_label(ui, strip, label);
        let center = Rect::from_min_max(strip.left_bottom(), area.max).center() + vec2(0.0, 2.0);
        let knob = Rect::from_center_size(center, Vec2::splat(size));
        let response = ui.interact(knob, ui.scope_id().with(("dial", dial)), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, format!("dial {dial} {label}")));
        widget_positions::note(ui, &format!("dial {dial}"), knob.center());
        let response = response.on_hover_text(
            "drag right or up, use the wheel, or the arrow keys; SHIFT fine, CONTROL coarse; double click: a quarter turn",
        );
        if response.clicked() || response.is_pointer_button_down_on() {
            response.request_focus();
        }
        self.paint(ui, knob, dial, &response);
        (knob, movement(ui, &response))
    }

    /// The dials that events of the mouse turn, and by how many turns. All of the way counts, from where the button
    /// went down to where it came up, however slowly pictures come.
    ///
    /// - `knobs`: where the dials are, from dial 1.
    fn drag(&mut self, events: &[Event], knobs: &[Rect]) -> Vec<(u8, f64)> {
        let mut turned = Vec::new();
        for event in events {
            let (at, is_down) = match event {
                Event::PointerMoved(at) => (*at, true),
                Event::PointerButton { pos, button: PointerButton::Primary, pressed, .. } => (*pos, *pressed),
                _ => continue,
            };
            if let Some((dial, from)) = self.drag {
                turned.push((dial, f64::from((at.x - from.x) - (at.y - from.y)) / POINTS_PER_TURN));
                self.drag = is_down.then_some((dial, at));
            } else if is_down && matches!(event, Event::PointerButton { .. }) {
                self.drag = (1..).zip(knobs).find(|(_, knob)| knob.contains(at)).map(|(dial, _)| (dial, at));
            }
        }
        turned
    }

    fn paint(&self, ui: &Ui, knob: Rect, dial: u8, response: &Response) {
        let painter = ui.painter();
        let (center, radius) = (knob.center(), knob.width() / 2.0 - 1.0);
        let rim = if response.has_focus() || response.dragged() { LIT } else { Color32::from_gray(95) };
        painter.circle(center, radius, Color32::from_gray(34), Stroke::new(1.5, rim));
        painter.circle(center, radius * 0.78, Color32::from_gray(58), Stroke::new(1.0, Color32::from_gray(80)));
        let angle = (self.turned[usize::from(dial) - 1].rem_euclid(1.0)) as f32 * TAU;
        let direction = vec2(angle.sin(), -angle.cos());
        let mark = Stroke::new(2.5, Color32::from_gray(225));
        painter.line_segment([center + direction * radius * 0.35, center + direction * radius * 0.74], mark);
        painter.text(center, Align2::CENTER_CENTER, dial, FontId::proportional(11.0), Color32::from_gray(140));
    }
}

/// What the keys that are held make of a movement.
fn rate(ui: &Ui) -> f64 {
    let held = ui.input(|input| input.modifiers);
    match (held.shift, held.ctrl) {
        (true, _) => FINE,
        (_, true) => COARSE,
        _ => 1.0,
    }
}

/// By how many turns somebody turns the dial by wheel and keys.
fn movement(ui: &Ui, response: &Response) -> f64 {
    let mut turns = 0.0;
    if response.hovered() {
        // With SHIFT, systems turn the wheel sideways.
        turns +=
            ui.input(|input| f64::from(input.smooth_scroll_delta.x + input.smooth_scroll_delta.y)) / WHEEL_PER_TURN;
    }
    if response.double_clicked() {
        turns += 0.25;
    }
    if response.has_focus() {
        let lock = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, lock));
        let strokes = ui.input(|input| {
            let count = |key| input.num_presses(key) as f64;
            count(Key::ArrowUp) + count(Key::ArrowRight) - count(Key::ArrowDown) - count(Key::ArrowLeft)
        });
        turns += strokes * KEY_TURNS;
    }
    turns * rate(ui)
}

/// Shows a text as the diodes of a label do.
pub fn show_label(ui: &Ui, area: Rect, text: &str) {
    let painter = ui.painter();
    painter.rect_filled(area.shrink(1.0), 2.0, Color32::from_rgb(20, 6, 4));
    painter.text(area.center(), Align2::CENTER_CENTER, text, FontId::monospace(12.0), LIT);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_the_way_of_the_mouse_turns_the_dial_where_it_began() {
        let knobs = [0.0, 100.0].map(|x| Rect::from_min_size(Pos2::new(x, 0.0), Vec2::splat(50.0)));
        let button = |pressed, x| Event::PointerButton {
            pos: Pos2::new(x, 25.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Default::default(),
        };
        let mut dials = DialPanel::default();
        let events = [button(true, 25.0), Event::PointerMoved(Pos2::new(85.0, 25.0)), button(false, 145.0)];
        assert_eq!(dials.drag(&events, &knobs), [(1, 0.25), (1, 0.25)]);
        assert_eq!(dials.drag(&[Event::PointerMoved(Pos2::new(125.0, 25.0))], &knobs), []);
        assert_eq!(dials.drag(&[button(true, 75.0), Event::PointerMoved(Pos2::ZERO)], &knobs), []);
        assert_eq!(dials.drag(&[button(true, 125.0)], &knobs), []);
        assert_eq!(dials.drag(&[Event::PointerMoved(Pos2::new(125.0, 49.0))], &knobs), [(2, -0.1)]);
    }
}
