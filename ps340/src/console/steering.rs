//! The mouse over the vector screen while it turns dials: drags turn and move what is shown, the wheel scales it.

use super::{dials::DialPanel, mapping::Mouse, widget_positions};
use egui::{Event, Modifiers, MouseWheelUnit, PointerButton, Pos2, Rect, Response, Ui};

/// Points of a wheel that count as a step.
const POINTS_PER_STEP: f32 = 50.0;
/// What two fingers scale by for a step of the wheel.
const ZOOM_PER_STEP: f64 = 1.1;

/// A mouse that turns dials.
#[derive(Debug, Default)]
pub struct Steering {
    /// The button that is down since it was pressed over the screen, what is held beside it, and where the mouse was
    /// last.
    drag: Option<(PointerButton, Modifiers, Pos2)>,
    /// Whether it was ever used.
    is_known: bool,
}

impl Steering {
    /// Turns the dials that events of the mouse mean over the area of `response`.
    pub fn follow(&mut self, ui: &Ui, response: &Response, mouse: &Mouse, dials: &mut DialPanel) {
        widget_positions::note(ui, "view", response.rect.center());
        let is_over = response.contains_pointer();
        let turned = ui.input(|input| self.turns(&input.events, response.rect, is_over, mouse));
        for (dial, turns) in turned {
            self.is_known = true;
            dials.turn(dial, turns);
        }
    }

    /// Whether somebody has turned a dial by it.
    pub fn is_known(&self) -> bool {
        self.is_known
    }

    /// The dials that events mean, and by how many turns. All of the way counts, however slowly pictures come.
    ///
    /// - `area`: the screen. `is_over`: whether the mouse is over it, and over nothing that covers it.
    fn turns(&mut self, events: &[Event], area: Rect, is_over: bool, mouse: &Mouse) -> Vec<(u8, f64)> {
        let mut turned = Vec::new();
        for event in events {
            match event {
                Event::PointerMoved(at) => self.go(*at, area, mouse, &mut turned),
                Event::PointerButton { pos, button, pressed: true, modifiers } => {
                    let is_here = is_over && area.contains(*pos) && self.drag.is_none();
                    self.drag = if is_here { Some((*button, *modifiers, *pos)) } else { self.drag };
                }
                Event::PointerButton { pos, button, pressed: false, .. } => {
                    self.go(*pos, area, mouse, &mut turned);
                    self.drag = self.drag.filter(|(held, ..)| held != button);
                }
                Event::MouseWheel { unit, delta, .. } if is_over => {
                    let steps = if *unit == MouseWheelUnit::Point { delta.y / POINTS_PER_STEP } else { delta.y };
                    turned.extend(mouse.rolled(f64::from(steps)));
                }
                Event::Zoom(factor) if is_over && *factor > 0.0 => {
                    turned.extend(mouse.rolled(f64::from(*factor).ln() / ZOOM_PER_STEP.ln()));
                }
                _ => {}
            }
        }
        turned
    }

    fn go(&mut self, at: Pos2, area: Rect, mouse: &Mouse, turned: &mut Vec<(u8, f64)>) {
        if let Some((button, held, from)) = &mut self.drag {
            let way = [at.x - from.x, from.y - at.y].map(|points| f64::from(points / area.width()));
            *from = at;
            turned.extend(mouse.dragged(*button, *held, way));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::console::mapping::Mapping;
    use egui::vec2;

    #[test]
    fn drags_turn_and_move_and_the_wheel_scales() {
        let area = Rect::from_min_size(Pos2::new(100.0, 0.0), vec2(200.0, 200.0));
        let mapping = Mapping::default();
        let mut steering = Steering::default();
        let mut turns = |events: &[Event]| steering.turns(events, area, true, mapping.mouse());
        let button = |button, pressed, x, modifiers| Event::PointerButton {
            pos: Pos2::new(x, 100.0),
            button,
            pressed,
            modifiers,
        };
        let (left, right, plain) = (PointerButton::Primary, PointerButton::Secondary, Modifiers::NONE);
        let drag = [button(left, true, 150.0, plain), Event::PointerMoved(Pos2::new(250.0, 100.0))];
        // What is in front follows the mouse: to the right, which is against the dial's sense.
        assert_eq!(turns(&drag), [(2, -0.45)]);
        assert_eq!(turns(&[Event::PointerMoved(Pos2::new(250.0, 50.0)), button(left, false, 250.0, plain)]).len(), 2);
        assert_eq!(turns(&[Event::PointerMoved(Pos2::new(150.0, 100.0))]), []);
        for (which, held) in [(right, plain), (left, Modifiers::SHIFT)] {
            let drag = [button(which, true, 150.0, held), button(which, false, 200.0, held)];
            assert_eq!(turns(&drag), [(5, 0.25)]);
        }
        assert_eq!(turns(&[button(left, true, 50.0, plain), Event::PointerMoved(Pos2::new(150.0, 100.0))]), []);
        let turned = turns(&[Event::Zoom(1.21)]);
        assert!(matches!(turned[..], [(4, turns)] if (turns - 0.2).abs() < 1e-6), "{turned:?}");
    }
}
