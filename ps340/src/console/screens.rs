//! The two screens: their pictures, and the tablet that the mouse is on the vector screen.

use super::{
    keyboard,
    mapping::Mapping,
    orders::Orders,
    painter::{Painter, Wanted},
    places,
};
use crate::{calligraphic::Screen, raster::FrameBuffer, shell::Shown};
use egui::{
    Align2, Color32, ColorImage, Event, FontId, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind,
    TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, vec2,
};
use std::sync::Arc;

/// Widest picture that is drawn, in pixels; a larger window shows it larger.
const MAX_PIXELS: f32 = 4096.0;

/// The mouse buttons with the codes of the puck's buttons.
const PUCK: [(PointerButton, u8); 5] = [
    (PointerButton::Primary, 1),
    (PointerButton::Middle, 2),
    (PointerButton::Secondary, 4),
    (PointerButton::Extra1, 8),
    (PointerButton::Extra2, 8),
];

/// The vector screen.
pub struct VectorScreen {
    painter: Painter,
    texture: Option<TextureHandle>,
    puck: Puck,
}

impl VectorScreen {
    /// A window on a screen.
    pub fn new(context: egui::Context, screen: Arc<Screen>) -> VectorScreen {
        VectorScreen { painter: Painter::new(context, screen), texture: None, puck: Puck::default() }
    }

    /// Shows the screen as the largest square of the space that is left, and orders what puck and keyboard do.
    pub fn show(&mut self, ui: &mut Ui, shown: &Shown, mapping: &Mapping, orders: &mut Orders) {
        let side = ui.available_size().min_elem().max(1.0);
        let (space, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let area = Rect::from_center_size(space.center(), Vec2::splat(side));
        let pixels = (side * ui.pixels_per_point()).round().clamp(1.0, MAX_PIXELS);
        self.painter.want(Wanted { scene: shown.scene.clone(), size: [pixels as u32; 2] });
        if let Some(image) = self.painter.take() {
            put(&mut self.texture, ui, "vector screen", image, TextureOptions::LINEAR);
        }
        paint_texture(ui, self.texture.as_ref(), area);
        let response = ui.interact(area, ui.scope_id().with("vector screen"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "vector screen"));
        places::note(ui, "vector screen", area.center());
        places::note(ui, "vector screen's corner", area.right_top());
        self.keyboard(ui, &response, mapping, orders);
        // Under another window, or a menu, the mouse is no puck.
        let is_covered = !response.contains_pointer() && self.puck.pressed == 0 && ui.ui_contains_pointer();
        if !is_covered {
            ui.input(|input| self.puck.orders(&input.events, area)).into_iter().for_each(|order| orders.give(order));
        }
    }

    /// Gives what is typed to the machine while the screen has the focus, which it takes at the start and by a press.
    fn keyboard(&mut self, ui: &Ui, response: &Response, mapping: &Mapping, orders: &mut Orders) {
        let nobody = ui.memory(|memory| memory.focused().is_none());
        if nobody || response.is_pointer_button_down_on() || response.clicked() {
            response.request_focus();
        }
        let edge = if response.has_focus() { Color32::from_rgb(70, 110, 160) } else { Color32::from_gray(45) };
        ui.painter().rect_stroke(response.rect, 0.0, Stroke::new(1.0, edge), StrokeKind::Outside);
        if response.has_focus() {
            let all = egui::EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: true };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, all));
            ui.input(|input| keyboard::type_events(&input.events, mapping, orders));
        }
    }
}

/// The puck, which the mouse is while it is on the vector screen.
#[derive(Debug, Default)]
struct Puck {
    /// Where it is, if it is on the tablet.
    place: Option<[f32; 2]>,
    /// The codes of the buttons that are down.
    pressed: u8,
}

impl Puck {
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
                    let code = PUCK.iter().find(|(name, _)| name == button).map_or(0, |(_, code)| *code);
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
            None if is_drawing => self.place,
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

/// The raster screen.
#[derive(Default)]
pub struct RasterScreen {
    texture: Option<TextureHandle>,
    /// What the texture shows.
    shown: Option<Arc<FrameBuffer>>,
}

impl RasterScreen {
    /// Shows the screen as the largest 4 by 3 of the space that is left.
    pub fn show(&mut self, ui: &mut Ui, shown: &Shown) {
        let (space, response) = ui.allocate_exact_size(ui.available_size().max(vec2(1.0, 1.0)), Sense::hover());
        let width = space.width().min(space.height() * 4.0 / 3.0);
        let area = Rect::from_center_size(space.center(), vec2(width, width * 0.75));
        if self.shown.as_ref().is_none_or(|before| !Arc::ptr_eq(before, &shown.raster)) {
            let image = ColorImage::from_rgb([640, 480], shown.raster.output().as_flattened());
            put(&mut self.texture, ui, "raster screen", Arc::new(image), TextureOptions::LINEAR);
            self.shown = Some(shown.raster.clone());
        }
        paint_texture(ui, self.texture.as_ref(), area);
        let edge = Stroke::new(1.0, Color32::from_gray(45));
        ui.painter().rect_stroke(area, 0.0, edge, StrokeKind::Outside);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "raster screen"));
    }
}

/// Replaces the picture of a texture.
fn put(texture: &mut Option<TextureHandle>, ui: &Ui, name: &str, image: Arc<ColorImage>, options: TextureOptions) {
    match texture {
        Some(texture) => texture.set(image, options),
        None => *texture = Some(ui.ctx().load_texture(name, image, options)),
    }
}

fn paint_texture(ui: &Ui, texture: Option<&TextureHandle>, area: Rect) {
    let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
    match texture {
        Some(texture) => drop(ui.painter().image(texture.id(), area, whole, Color32::WHITE)),
        None => {
            ui.painter().rect_filled(area, 0.0, Color32::BLACK);
            let ink = Color32::from_gray(60);
            ui.painter().text(area.center(), Align2::CENTER_CENTER, "starting", FontId::proportional(14.0), ink);
        }
    }
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
    }
}
