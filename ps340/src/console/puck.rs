//! The puck of the tablet, which the mouse is over the vector screen and over the picture of the tablet.

use super::{
    mapping::{Click, Mouse},
    operator_commands::OperatorCommands,
};
use egui::{Event, MouseWheelUnit, Pos2, Rect, Response, Ui};

/// Points of the wheel that count as a step.
const POINTS_PER_STEP: f32 = 50.0;
/// Most steps that one movement of the wheel makes.
const MOST_STEPS: f32 = 100.0;

/// The puck, which the mouse is while it is over a picture of the tablet.
#[derive(Debug, Default)]
pub struct Puck {
    /// What buttons and wheel of the mouse do.
    mouse: Mouse,
    /// Steps of the wheel that are not whole yet.
    wheel: f32,
    /// Where it is, if it is on the tablet.
    position: Option<[f32; 2]>,
    /// The codes of the buttons that are down.
    pressed: u8,
    /// Whether it lies where the mouse leaves it.
    stays: bool,
}

impl Puck {
    /// Gives the operator commands that the mouse means while it is over the area of `response`.
    pub fn follow(&mut self, ui: &Ui, response: &Response, orders: &mut OperatorCommands) {
        // Under another window, or a menu, the mouse is no puck.
        let is_covered = !response.contains_pointer() && self.pressed == 0 && ui.ui_contains_pointer();
        if !is_covered {
            let meant = ui.input(|input| self.commands(&input.events, response.rect));
            meant.into_iter().for_each(|order| orders.give(order));
        }
    }

    /// A puck that is off the tablet when the mouse is.
    pub fn new(mouse: &Mouse) -> Puck {
        Puck { mouse: mouse.clone(), ..Puck::default() }
    }

    /// A puck that lies where the mouse leaves it, until it is taken off.
    pub fn that_stays(mouse: &Mouse) -> Puck {
        Puck { stays: true, ..Puck::new(mouse) }
    }

    /// Takes it off the tablet.
    pub fn take_off(&mut self, orders: &mut OperatorCommands) {
        if self.position.take().is_some() {
            orders.give("puck away");
        }
    }

    /// Where it is, -1..=1, if it is on the tablet.
    pub fn position(&self) -> Option<[f32; 2]> {
        self.position
    }

    /// Sum of the codes of the buttons that are down.
    pub fn pressed(&self) -> u8 {
        self.pressed
    }

    /// The operator commands that events of the mouse mean, in their order, so that none is lost however slowly
    /// pictures come.
    ///
    /// A press counts where it began: on the screen. Until it ends, the puck stays on the tablet.
    fn commands(&mut self, events: &[Event], area: Rect) -> Vec<String> {
        let mut orders = Vec::new();
        for event in events {
            match event {
                Event::PointerMoved(at) => self.go(Some(*at), area, &mut orders),
                Event::PointerGone => self.go(None, area, &mut orders),
                Event::PointerButton { pos, button, pressed, .. } => {
                    self.go(Some(*pos), area, &mut orders);
                    let is_here = *pressed && area.contains(*pos);
                    match self.mouse.button(*button) {
                        Some(Click::Puck(code)) if is_here => self.press(self.pressed | code, &mut orders),
                        Some(Click::Puck(code)) if !pressed => self.press(self.pressed & !code, &mut orders),
                        Some(Click::OperatorCommand(order)) if is_here => orders.push(order.clone()),
                        _ => {}
                    }
                    if !pressed {
                        self.go(Some(*pos), area, &mut orders);
                    }
                }
                Event::MouseWheel { unit, delta, .. } if self.position.is_some() => {
                    let steps = if *unit == MouseWheelUnit::Point { delta.y / POINTS_PER_STEP } else { delta.y };
                    self.roll(steps, &mut orders);
                }
                _ => {}
            }
        }
        orders
    }

    fn go(&mut self, at: Option<Pos2>, area: Rect, orders: &mut Vec<String>) {
        let is_drawing = self.pressed != 0;
        let place = match at {
            Some(at) if is_drawing || area.contains(at) => Some(position_in(at, area)),
            _ if is_drawing || self.stays => self.position,
            _ => None,
        };
        if place != self.position {
            self.position = place;
            orders.push(match place {
                Some([x, y]) => format!("puck move {x} {y}"),
                None => "puck away".into(),
            });
        }
    }

    fn roll(&mut self, steps: f32, orders: &mut Vec<String>) {
        self.wheel += steps;
        let whole = self.wheel.trunc();
        self.wheel -= whole;
        if let Some(order) = self.mouse.wheel(whole > 0.0) {
            orders.extend((0..whole.abs().min(MOST_STEPS) as u32).map(|_| order.to_owned()));
        }
    }

    fn press(&mut self, pressed: u8, orders: &mut Vec<String>) {
        if pressed != self.pressed {
            self.pressed = pressed;
            orders.push(if pressed == 0 { "puck release".into() } else { format!("puck press {pressed}") });
        }
    }
}

/// The position on the tablet under a point of the screen, -1..=1.
fn position_in(at: Pos2, area: Rect) -> [f32; 2] {
    let from_center = (at - area.center()) / (area.size() / 2.0);
    [from_center.x, 0.0 - from_center.y].map(|c| c.clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::console::mapping::Mapping;
    use egui::{Modifiers, MouseWheelSource, PointerButton, TouchPhase, vec2};

    #[test]
    fn the_corners_of_the_screen_are_those_of_the_tablet() {
        let area = Rect::from_min_max(Pos2::new(100.0, 50.0), Pos2::new(300.0, 250.0));
        assert_eq!(position_in(Pos2::new(100.0, 50.0), area), [-1.0, 1.0]);
        assert_eq!(position_in(Pos2::new(300.0, 250.0), area), [1.0, -1.0]);
        assert_eq!(position_in(Pos2::new(200.0, 150.0), area), [0.0, 0.0]);
        assert_eq!(position_in(Pos2::new(900.0, 150.0), area), [1.0, 0.0]);
    }

    #[test]
    fn a_click_that_is_over_before_the_picture_is_a_press_and_a_release() {
        let area = Rect::from_min_max(Pos2::ZERO, Pos2::new(200.0, 200.0));
        let button = |pressed, x| Event::PointerButton {
            pos: Pos2::new(x, 100.0),
            button: PointerButton::Middle,
            pressed,
            modifiers: Default::default(),
        };
        let mapping = Mapping::default();
        let mut puck = Puck::new(mapping.mouse());
        let mut orders = |events: &[Event]| puck.commands(events, area).join("; ");
        let click = [Event::PointerMoved(Pos2::new(150.0, 100.0)), button(true, 150.0), button(false, 150.0)];
        assert_eq!(orders(&click), "puck move 0.5 0; puck press 2; puck release");
        // A press that began on the screen keeps the puck on the tablet; one that began elsewhere is none.
        let drawn = [button(true, 150.0), Event::PointerMoved(Pos2::new(300.0, 100.0)), button(false, 300.0)];
        assert_eq!(orders(&drawn), "puck press 2; puck move 1 0; puck release; puck away");
        assert_eq!(orders(&[button(true, 300.0), button(false, 300.0), Event::PointerGone]), "");
        // The wheel and a button that are mapped to operator commands.
        let mut mapping = Mapping::default();
        mapping.read("wheel up = dial 4 0.02\nmouse middle = key 5").expect("good lines");
        let mut puck = Puck::new(mapping.mouse());
        let roll = |y| Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, y),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Unknown,
            modifiers: Modifiers::NONE,
        };
        assert_eq!(puck.commands(&[roll(3.0)], area).join("; "), "");
        let events =
            [Event::PointerMoved(Pos2::new(150.0, 100.0)), roll(0.5), roll(1.5), roll(-1.0), button(true, 150.0)];
        assert_eq!(puck.commands(&events, area).join("; "), "puck move 0.5 0; dial 4 0.02; dial 4 0.02; key 5");
        // One that stays is left where it was when the mouse goes.
        let mut puck = Puck::that_stays(mapping.mouse());
        let left = puck.commands(&[Event::PointerMoved(Pos2::new(150.0, 100.0)), Event::PointerGone], area);
        assert_eq!((left.join("; ").as_str(), puck.position()), ("puck move 0.5 0", Some([0.5, 0.0])));
    }
}
