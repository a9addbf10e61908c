//! Two screens that share a space, with a bar between them that somebody may drag.

use egui::{Color32, CursorIcon, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};

/// Width of the bar.
const BAR: f32 = 7.0;
/// Each has at least this part of the space.
const LEAST: f32 = 0.1;

/// How the space is shared.
#[derive(Default)]
pub struct Split {
    /// The part of the first screen, if somebody has set it.
    part: Option<f32>,
}

/// The axis along which the two lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    /// Beside one another.
    Across,
    /// Below one another.
    Down,
}

impl Split {
    /// Parts a space between a square screen and one of 4 by 3: as large as they go, and equally high beside one
    /// another or equally wide below, unless somebody has dragged the bar.
    pub fn show(&mut self, ui: &mut Ui, space: Rect) -> [Rect; 2] {
        let way = way(space);
        let length = if way == Axis::Across { space.width() } else { space.height() } - BAR;
        let part = self.part.unwrap_or_else(|| usual(way));
        let [first, bar, second] = parts(space, way, part);
        let response = ui.interact(bar, ui.scope_id().with("split"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, "between the screens"));
        if response.double_clicked() {
            self.part = None;
        } else if response.dragged() {
            let moved = if way == Axis::Across { response.drag_delta().x } else { response.drag_delta().y };
            self.part = Some((part + moved / length.max(1.0)).clamp(LEAST, 1.0 - LEAST));
        }
        super::widget_positions::note(ui, "splitter", bar.center());
        let is_held = response.hovered() || response.dragged();
        let ink = Color32::from_gray(if is_held { 130 } else { 62 });
        let grip = if way == Axis::Across { vec2(2.0, 36.0) } else { vec2(36.0, 2.0) };
        ui.painter().rect_filled(Rect::from_center_size(bar.center(), grip), 1.0, ink);
        let cursor = if way == Axis::Across { CursorIcon::ResizeHorizontal } else { CursorIcon::ResizeVertical };
        response.on_hover_cursor(cursor).on_hover_text("drag; double click: as at first");
        [first, second]
    }
}

/// Beside one another in a wide space, below in a high one: as both are larger.
fn way(space: Rect) -> Axis {
    let (width, height) = (space.width(), space.height());
    // The sides of the square, of both screens together.
    let beside = (width * 3.0 / 7.0).min(height);
    let below = (height * 4.0 / 7.0).min(width);
    if beside >= below { Axis::Across } else { Axis::Down }
}

/// The part of the square screen: beside one of 4 by 3 that is as high, or above one that is as wide.
fn usual(way: Axis) -> f32 {
    match way {
        Axis::Across => 3.0 / 7.0,
        Axis::Down => 4.0 / 7.0,
    }
}

fn parts(space: Rect, way: Axis, part: f32) -> [Rect; 3] {
    let [least, most] = [space.min, space.max];
    match way {
        Axis::Across => {
            let x = least.x + (space.width() - BAR) * part;
            [
                Rect::from_min_max(least, pos2(x, most.y)),
                Rect::from_min_max(pos2(x, least.y), pos2(x + BAR, most.y)),
                Rect::from_min_max(pos2(x + BAR, least.y), most),
            ]
        }
        Axis::Down => {
            let y = least.y + (space.height() - BAR) * part;
            [
                Rect::from_min_max(least, pos2(most.x, y)),
                Rect::from_min_max(pos2(least.x, y), pos2(most.x, y + BAR)),
                Rect::from_min_max(pos2(least.x, y + BAR), most),
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_screens_are_as_large_as_they_go() {
        for (size, way_expected) in
            [([1280.0, 600.0], Axis::Across), ([800.0, 390.0], Axis::Across), ([500.0, 900.0], Axis::Down)]
        {
            let space = Rect::from_min_size(pos2(10.0, 20.0), size.into());
            assert_eq!(way(space), way_expected, "{size:?}");
            let [first, bar, second] = parts(space, way_expected, usual(way_expected));
            assert_eq!(first.union(bar).union(second), space);
            let square = first.width().min(first.height());
            let raster = second.width().min(second.height() * 4.0 / 3.0);
            let alike = if way_expected == Axis::Across { raster * 0.75 / square } else { raster / square };
            assert!((alike - 1.0).abs() < 0.01, "{size:?}: {square} and {raster}");
        }
    }
}
