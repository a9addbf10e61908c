//! The window as a whole: screens in the middle, devices below, views at the side.

use super::{
    Appearance,
    dials::Dials,
    keys::{Row, show_buttons, show_keys},
    mapping::Mapping,
    orders::Orders,
    pad::Pad,
    places,
    screens::{RasterScreen, VectorScreen},
    views::{self, View},
};
use crate::{
    line::OperatorLine,
    machine::KeyboardMode,
    shell::{Asked, Mirror, Shown},
};
use egui::{CentralPanel, Color32, Panel, RichText, Ui, ViewportBuilder, ViewportId, vec2};
use std::sync::{Arc, mpsc};

/// Where the raster screen is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum RasterPlace {
    /// Nowhere.
    #[default]
    Hidden,
    /// Beside the vector screen.
    Beside,
    /// In a window of its own.
    Apart,
}

/// The window.
pub struct App {
    mirror: Arc<Mirror>,
    orders: Orders,
    mapping: Mapping,
    vector: VectorScreen,
    raster: RasterScreen,
    raster_place: RasterPlace,
    /// Whether something was ever on the raster screen: then it comes into view by itself.
    raster_seen: bool,
    dials: Dials,
    pad: Pad,
    row: Row,
    devices: bool,
    views: Vec<Box<dyn View>>,
    view: Option<usize>,
    /// What draws the window, in words.
    drawn_by: String,
}

impl App {
    /// The window of a machine.
    ///
    /// - `mirror`: what is to be seen of it.
    /// - `orders`: where orders go.
    pub fn new(
        creation: &eframe::CreationContext<'_>,
        mirror: Arc<Mirror>,
        orders: mpsc::Sender<OperatorLine>,
        appearance: Appearance,
    ) -> App {
        let context = &creation.egui_ctx;
        context.set_visuals(egui::Visuals::dark());
        if let Some(scale) = appearance.scale {
            context.set_pixels_per_point(scale);
        }
        let drawn_by = match &creation.wgpu_render_state {
            Some(state) => {
                let adapter = state.adapter.get_info();
                format!("{} ({:?})", adapter.name, adapter.backend)
            }
            None => "no graphics adapter".into(),
        };
        tracing::info!("the window is drawn by {drawn_by}");
        App {
            orders: Orders::new(orders),
            vector: VectorScreen::new(context.clone(), mirror.screen().clone(), appearance.mapping.mouse()),
            mirror,
            raster: RasterScreen::default(),
            raster_place: RasterPlace::default(),
            raster_seen: false,
            dials: Dials::default(),
            pad: Pad::new(context),
            row: Row::default(),
            devices: true,
            views: views::all(appearance.mapping.mouse()),
            view: None,
            drawn_by,
            mapping: appearance.mapping,
        }
    }

    fn show_bar(&mut self, ui: &mut Ui, shown: &Shown) {
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new("PS 340").strong()).on_hover_text(format!(
                "the window is drawn by {}, the vector screen by {}",
                self.drawn_by,
                self.mirror.screen().drawer()
            ));
            for (mode, key) in [
                (KeyboardMode::Terminal, "host"),
                (KeyboardMode::Command, "command"),
                (KeyboardMode::Interactive, "local"),
            ] {
                let hint = format!("typed characters go to {}", target(mode));
                if ui.selectable_label(shown.mode == mode, key.to_uppercase()).on_hover_text(hint).clicked() {
                    self.orders.give(format!("key {key}"));
                }
            }
            ui.separator();
            for (key, hint) in [("graph", "graphics off and on"), ("term", "text off and on"), ("setup", "set-up page")]
            {
                if ui.button(key.to_uppercase()).on_hover_text(hint).clicked() {
                    self.orders.give(format!("key {key}"));
                }
            }
            ui.separator();
            ui.label("raster");
            for (place, word) in
                [(RasterPlace::Hidden, "off"), (RasterPlace::Beside, "beside"), (RasterPlace::Apart, "window")]
            {
                ui.selectable_value(&mut self.raster_place, place, word);
            }
            ui.toggle_value(&mut self.devices, "devices");
            ui.separator();
            for (index, view) in self.views.iter().enumerate() {
                let is_open = self.view == Some(index);
                let tab = ui.selectable_label(is_open, view.title());
                places::note(ui, &format!("view {}", view.title()), tab.rect.center());
                if tab.clicked() {
                    self.view = (!is_open).then_some(index);
                }
            }
            if let Some(failure) = &self.orders.failure
                && ui.link(RichText::new(failure).color(Color32::from_rgb(255, 120, 100))).clicked()
            {
                self.orders.failure = None;
            }
        });
    }

    fn show_devices(&mut self, ui: &mut Ui, shown: &Shown) {
        egui::ScrollArea::horizontal().show(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            ui.horizontal(|ui| {
                ui.vertical(|ui| {
                    self.dials.show(ui, &shown.panel, 52.0);
                    show_keys(ui, &shown.panel, &mut self.row, &mut self.orders);
                });
                ui.separator();
                show_buttons(ui, &shown.panel, &mut self.orders);
            });
        });
    }

    /// Asks for what the open view shows, if any.
    fn ask(&self) {
        let mut asked = Asked::default();
        if let Some(view) = self.view.and_then(|index| self.views.get(index)) {
            view.ask(&mut asked);
        }
        self.mirror.ask(&asked);
    }

    fn show_raster_window(&mut self, ui: &Ui, shown: &Shown) {
        let builder = ViewportBuilder::default().with_title("PS 340 raster screen").with_inner_size([640.0, 480.0]);
        let raster = &mut self.raster;
        let closed = ui.ctx().show_viewport_immediate(ViewportId::from_hash_of("raster"), builder, |ui, _class| {
            CentralPanel::no_frame().show(ui, |ui| raster.show(ui, shown));
            ui.ctx().input(|input| input.viewport().close_requested())
        });
        if closed {
            self.raster_place = RasterPlace::Hidden;
        }
    }
}

/// Where characters go in a mode of the keyboard.
fn target(mode: KeyboardMode) -> &'static str {
    match mode {
        KeyboardMode::Terminal => "the host, as from a terminal",
        KeyboardMode::Command => "the command interpreter",
        KeyboardMode::Interactive => "the function network",
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.orders.take_replies();
        let shown = self.mirror.shown();
        if !self.raster_seen && !shown.raster.is_blank() {
            self.raster_seen = true;
            if self.raster_place == RasterPlace::Hidden {
                self.raster_place = RasterPlace::Beside;
            }
        }
        Panel::top("bar").show(ui, |ui| self.show_bar(ui, &shown));
        if self.devices {
            Panel::bottom("devices").show(ui, |ui| self.show_devices(ui, &shown));
        }
        if let Some(view) = self.view.and_then(|index| self.views.get_mut(index)) {
            Panel::right("view").resizable(true).default_size(440.0).show(ui, |ui| {
                view.show(ui, &shown, &mut self.orders);
            });
        }
        self.ask();
        let width = ui.available_width();
        if self.raster_place == RasterPlace::Beside {
            Panel::right("raster").resizable(true).default_size(width * 0.45).frame(egui::Frame::NONE).show(ui, |ui| {
                self.raster.show(ui, &shown);
            });
        }
        let black = egui::Frame::NONE.fill(Color32::from_gray(12)).inner_margin(1.0);
        CentralPanel::default().frame(black).show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
            self.vector.show(ui, &shown, &self.mapping, &mut self.orders);
        });
        if self.raster_place == RasterPlace::Apart {
            self.show_raster_window(ui, &shown);
        }
        let seconds = f64::from(ui.input(|input| input.stable_dt));
        self.pad.act(seconds, &self.mapping, &mut self.dials, &mut self.orders, ui.ctx());
        self.dials.give(&mut self.orders);
    }
}
