//! The two screens: their pictures, and the mouse on the vector screen as puck.

use super::{
    dials::DialPanel,
    keyboard,
    mapping::{Mapping, Mouse},
    operator_commands::OperatorCommands,
    painter::{DrawRequest, Painter},
    puck::Puck,
    steering::Steering,
    widget_positions,
};
use crate::{calligraphic::SharedDisplay, raster::FrameBuffer, shell::MirrorFrame};
use egui::{
    Align2, Color32, ColorImage, FontId, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, TextureHandle,
    TextureOptions, Ui, Vec2, WidgetInfo, vec2,
};
use std::sync::Arc;

/// Widest picture that is drawn, in pixels; a larger window shows it larger.
const MAX_PIXELS: f32 = 4096.0;

/// The vector screen.
pub struct VectorScreen {
    painter: Painter,
    texture: Option<TextureHandle>,
    puck: Puck,
    steering: Steering,
}

impl VectorScreen {
    /// A window on a screen.
    pub fn new(context: egui::Context, screen: Arc<SharedDisplay>, mouse: &Mouse) -> VectorScreen {
        VectorScreen {
            painter: Painter::new(context, screen),
            texture: None,
            puck: Puck::new(mouse),
            steering: Steering::default(),
        }
    }

    /// Shows the screen as the largest square of the space that is left, and gives the operator commands of mouse and
    /// keyboard. Returns the square.
    ///
    /// - `dials`: what the mouse turns; without them, it is the puck.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        shown: &MirrorFrame,
        mapping: &Mapping,
        commands: &mut OperatorCommands,
        dials: Option<&mut DialPanel>,
    ) -> Rect {
        let side = ui.available_size().min_elem().max(1.0);
        let (space, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let area = Rect::from_center_size(space.center(), Vec2::splat(side));
        let pixels = (side * ui.pixels_per_point()).round().clamp(1.0, MAX_PIXELS);
        self.painter.want(DrawRequest { scene: shown.scene.clone(), size: [pixels as u32; 2] });
        if let Some(image) = self.painter.take() {
            put(&mut self.texture, ui, "vector screen", image, TextureOptions::LINEAR);
        }
        paint_texture(ui, self.texture.as_ref(), area);
        let response = ui.interact(area, ui.scope_id().with("vector screen"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "vector screen"));
        widget_positions::note(ui, "vector screen", area.center());
        widget_positions::note(ui, "vector screen's corner", area.right_top());
        self.keyboard(ui, &response, mapping, commands);
        match dials {
            Some(dials) => {
                self.puck.take_off(commands);
                self.steering.follow(ui, &response, mapping.mouse(), dials);
                if !self.steering.is_known() && response.hovered() && !shown.scene.strokes.is_empty() {
                    hint(ui, area);
                }
            }
            None => self.puck.follow(ui, &response, commands),
        }
        area
    }

    /// Gives what is typed to the machine while the screen has the focus, which it takes at the start and by a press.
    fn keyboard(&mut self, ui: &Ui, response: &Response, mapping: &Mapping, orders: &mut OperatorCommands) {
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

/// Shows what the mouse does, at the upper edge of the screen.
fn hint(ui: &Ui, screen: Rect) {
    let text = "drag turns   \u{b7}   SHIFT or right button moves   \u{b7}   wheel scales";
    let at = screen.center_top() + vec2(0.0, 12.0);
    ui.painter().text(at, Align2::CENTER_CENTER, text, FontId::proportional(12.0), Color32::from_gray(120));
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
    pub fn show(&mut self, ui: &mut Ui, shown: &MirrorFrame) {
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
