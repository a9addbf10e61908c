//! The tablet as a pane of its own: the mouse over it is the puck, which stays where it is left.

use super::View;
use crate::{
    console::{mapping::Mouse, operator_commands::OperatorCommands, puck::Puck, widget_positions},
    shell::{MirrorFrame, MirrorRequest},
};
use egui::{Color32, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, vec2};

/// Lines of the grid on the tablet, across.
const GRID: usize = 11;
/// The codes of the puck's buttons.
const BUTTONS: [u8; 4] = [1, 2, 4, 8];

/// The tablet with the puck on it.
pub struct TabletView {
    puck: Puck,
}

impl TabletView {
    /// A tablet whose puck does what `mouse` prescribes.
    pub fn new(mouse: &Mouse) -> TabletView {
        TabletView { puck: Puck::that_stays(mouse) }
    }
}

impl View for TabletView {
    fn title(&self) -> &'static str {
        "Tablet"
    }

    fn summary(&self) -> &'static str {
        "the tablet with its puck"
    }

    fn request(&self, _asked: &mut MirrorRequest) {}

    fn show(&mut self, ui: &mut Ui, _shown: &MirrorFrame, orders: &mut OperatorCommands) {
        ui.weak("The mouse is the puck. It stays where you leave it; its buttons are those of the mouse, or these:");
        ui.horizontal(|ui| {
            for code in BUTTONS {
                let response = ui.button(format!("  {code}  "));
                if response.clicked() && self.puck.position().is_some() {
                    orders.give(format!("puck press {code}"));
                    orders.give("puck release");
                }
            }
            if ui.button("take off").clicked() {
                self.puck.take_off(orders);
            }
            let text = self.puck.position().map_or("off the tablet".into(), |[x, y]| format!("{x:+.3} {y:+.3}"));
            ui.monospace(text);
        });
        let side = ui.available_size().min_elem().max(1.0);
        let (area, response) = ui.allocate_exact_size(Vec2::splat(side), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "tablet"));
        widget_positions::note(ui, "tablet", area.center());
        self.puck.follow(ui, &response, orders);
        paint(ui, area, &self.puck);
    }
}

fn paint(ui: &Ui, area: Rect, puck: &Puck) {
    let painter = ui.painter().with_clip_rect(area);
    painter.rect_filled(area, 4.0, Color32::from_gray(30));
    for line in 0..=GRID {
        let t = line as f32 / GRID as f32;
        let stroke = Stroke::new(1.0, Color32::from_gray(44));
        painter.hline(area.x_range(), area.top() + t * area.height(), stroke);
        painter.vline(area.left() + t * area.width(), area.y_range(), stroke);
    }
    painter.rect_stroke(area, 4.0, Stroke::new(1.0, Color32::from_gray(90)), StrokeKind::Inside);
    let Some([x, y]) = puck.position() else { return };
    let at = area.center() + vec2(x, -y) * area.size() / 2.0;
    let ink = Color32::from_gray(200);
    // The cross-hair in its ring is what counts; the body lies below it.
    painter.circle_stroke(at, 9.0, Stroke::new(1.5, ink));
    for arm in [vec2(14.0, 0.0), vec2(0.0, 14.0)] {
        painter.line_segment([at - arm, at + arm], Stroke::new(1.0, ink));
    }
    let body = Rect::from_center_size(at + vec2(0.0, 40.0), vec2(34.0, 46.0));
    painter.rect(body, 6.0, Color32::from_gray(60), Stroke::new(1.0, ink), StrokeKind::Inside);
    for (place, code) in BUTTONS.into_iter().enumerate() {
        let offset = vec2((place % 2) as f32 * 14.0 - 7.0, (place / 2) as f32 * 14.0 - 9.0);
        let lit = puck.pressed() & code != 0;
        let colour = if lit { Color32::WHITE } else { Color32::from_gray(110) };
        painter.circle_filled(Pos2::new(body.center().x, body.center().y) + offset, 4.5, colour);
    }
}
