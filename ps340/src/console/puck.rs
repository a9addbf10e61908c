//! The puck of the tablet, which the mouse is over the vector screen and over the picture of the tablet.

use super::orders::Orders;
use egui::{Event, PointerButton, Pos2, Rect, Response, Ui};

/// The mouse buttons with the codes of the puck's buttons.
pub const PUCK_BUTTONS: [(PointerButton, u8); 5] = [
    (PointerButton::Primary, 1),
    (PointerButton::Middle, 2),
    (PointerButton::Secondary, 4),
    (PointerButton::Extra1, 8),
    (PointerButton::Extra2, 8),
];

/// The puck, which the mouse is while it is over a picture of the tablet.
#[derive(Debug, Default)]
pub struct Puck {
    /// Where it is, if it is on the tablet.
    place: Option<[f32; 2]>,
    /// The codes of the buttons that are down.
    pressed: u8,
    /// Whether it lies where the mouse leaves it.
    stays: bool,
}

impl Puck {
    /// Gives the orders that the mouse means while it is over the area of `response`.
    pub fn follow(&mut self, ui: &Ui, response: &Response, orders: &mut Orders) {
        // Under another window, or a menu, the mouse is no puck.
        let is_covered = !response.contains_pointer() && self.pressed == 0 && ui.ui_contains_pointer();
        if !is_covered {
            let meant = ui.input(|input| self.orders(&input.events, response.rect));
            meant.into_iter().for_each(|order| orders.give(order));
        }
    }

    /// A puck that lies where the mouse leaves it, until it is taken off.
    pub fn that_stays() -> Puck {
        Puck { stays: true, ..Puck::default() }
    }

    /// Takes it off the tablet.
    pub fn take_off(&mut self, orders: &mut Orders) {
        if self.place.take().is_some() {
            orders.give("puck away");
        }
    }

    /// Where it is, -1..=1, if it is on the tablet.
    pub fn place(&self) -> Option<[f32; 2]> {
        self.place
    }

    /// Sum of the codes of the buttons that are down.
    pub fn pressed(&self) -> u8 {
        self.pressed
    }

    /// The orders that events of the mouse mean, in their order, so that none is lost however slowly pictures come.
    ///
    /// A press counts where it began: on the screen. Until it ends, the puck stays on the tablet.
    fn orders(&mut self, events: &[Event], area: Rect) -> Vec<String> {
        let mut orders = Vec::new();
        for event in events {
            match event {
                Event::PointerMoved(at) => self.go(Some(*at), area, &mut orders),
                Event::PointerGone => self.go(None, area, &mut orders),
                Event::PointerButton { pos, button, pressed, .. } => {
                    let code = PUCK_BUTTONS.iter().find(|(name, _)| name == button).map_or(0, |(_, code)| *code);
                    self.go(Some(*pos), area, &mut orders);
                    match pressed {
                        true if area.contains(*pos) => self.press(self.pressed | code, &mut orders),
                        true => {}
                        false => {
                            self.press(self.pressed & !code, &mut orders);
                            self.go(Some(*pos), area, &mut orders);
                        }
                    }
                }
                _ => {}
            }
        }
        orders
    }

    fn go(&mut self, at: Option<Pos2>, area: Rect, orders: &mut Vec<String>) {
        let is_drawing = self.pressed != 0;
        let place = match at {
            Some(at) if is_drawing || area.contains(at) => Some(place(at, area)),
            _ if is_drawing || self.stays => self.place,
            _ => None,
        };
        if place != self.place {
            self.place = place;
            orders.push(match place {
                Some([x, y]) => format!("puck move {x} {y}"),
                None => "puck away".into(),
            });
        }
    }

    fn press(&mut self, pressed: u8, orders: &mut Vec<String>) {
        if pressed != self.pressed {
            self.pressed = pressed;
            orders.push(if pressed == 0 { "puck release".into() } else { format!("puck press {pressed}") });
        }
    }
}

/// The place of the tablet under a point of the screen, -1..=1.
fn place(at: Pos2, area: Rect) -> [f32; 2] {
    let from_center = (at - area.center()) / (area.size() / 2.0);
    [from_center.x, 0.0 - from_center.y].map(|c| c.clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_the_screen_are_those_of_the_tablet() {
        let area = Rect::from_min_max(Pos2::new(100.0, 50.0), Pos2::new(300.0, 250.0));
        assert_eq!(place(Pos2::new(100.0, 50.0), area), [-1.0, 1.0]);
        assert_eq!(place(Pos2::new(300.0, 250.0), area), [1.0, -1.0]);
        assert_eq!(place(Pos2::new(200.0, 150.0), area), [0.0, 0.0]);
        assert_eq!(place(Pos2::new(900.0, 150.0), area), [1.0, 0.0]);
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
        let mut puck = Puck::default();
        let mut orders = |events: &[Event]| puck.orders(events, area).join("; ");
        let click = [Event::PointerMoved(Pos2::new(150.0, 100.0)), button(true, 150.0), button(false, 150.0)];
        assert_eq!(orders(&click), "puck move 0.5 0; puck press 2; puck release");
        // A press that began on the screen keeps the puck on the tablet; one that began elsewhere is none.
        let drawn = [button(true, 150.0), Event::PointerMoved(Pos2::new(300.0, 100.0)), button(false, 300.0)];
        assert_eq!(orders(&drawn), "puck press 2; puck move 1 0; puck release; puck away");
        assert_eq!(orders(&[button(true, 300.0), button(false, 300.0), Event::PointerGone]), "");
        // One that stays is left where it was when the mouse goes.
        let mut puck = Puck::that_stays();
        let left = puck.orders(&[Event::PointerMoved(Pos2::new(150.0, 100.0)), Event::PointerGone], area);
        assert_eq!((left.join("; ").as_str(), puck.place()), ("puck move 0.5 0", Some([0.5, 0.0])));
    }
}
