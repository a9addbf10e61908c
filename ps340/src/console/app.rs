//! The window as a whole: screens in the middle, devices below, views at the side.

use super::{
    Appearance,
    bar::Bar,
    choices::{Choices, MouseRole, RasterPlacement},
    devices,
    dials::DialPanel,
    keys::Row,
    link::{Link, WINDOW},
    mapping::Mapping,
    operator_commands::OperatorCommands,
    pad::Pad,
    screens::{RasterScreen, VectorScreen},
    split::Split,
    views::{self, View},
    welcome::{self, AttachedHosts},
};
use crate::shell::{Mirror, MirrorFrame, MirrorRequest};
use egui::{CentralPanel, Color32, Panel, RichText, Ui, UiBuilder, ViewportBuilder, ViewportId, vec2};
use std::{
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

/// How all that is drawn grows with a window that is larger than at first: by the power of its sides.
const ENLARGEMENT: f32 = 0.7;
/// Width of a view beside the screens.
const VIEW_WIDTH: f32 = 460.0;

/// The window.
pub struct App {
    mirror: Arc<Mirror>,
    commands: OperatorCommands,
    mapping: Mapping,
    vector: VectorScreen,
    raster: RasterScreen,
    /// Whether something was ever on the raster screen: then it comes into view by itself.
    raster_visible: bool,
    split: Split,
    dials: DialPanel,
    pad: Pad,
    row: Row,
    views: Vec<Box<dyn View>>,
    choices: Choices,
    hosts: AttachedHosts,
    /// Where hosts attach.
    lines: Arc<Mutex<Vec<String>>>,
    /// What draws the window, in words.
    drawn_by: String,
    /// How much larger all is drawn, if the window decides that.
    enlargement: Option<f32>,
}

impl App {
    /// The window of a machine.
    pub(super) fn new(creation: &eframe::CreationContext<'_>, link: Link, appearance: Appearance) -> App {
        let Link { mirror, operator_commands: orders, lines } = link;
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
            commands: OperatorCommands::new(orders),
            vector: VectorScreen::new(context.clone(), mirror.screen().clone(), appearance.mapping.mouse()),
            mirror,
            raster: RasterScreen::default(),
            raster_visible: false,
            split: Split::default(),
            dials: DialPanel::default(),
            pad: Pad::new(context),
            row: Row::default(),
            views: views::all(appearance.mapping.mouse()),
            choices: Choices { raster: RasterPlacement::default(), devices: true, view: None, role: None },
            hosts: AttachedHosts::default(),
            lines,
            enlargement: appearance.scale.is_none().then_some(1.0),
            drawn_by,
            mapping: appearance.mapping,
        }
    }

    /// Draws all larger in a larger window than usual, until somebody sets the size himself.
    fn enlarge(&mut self, context: &egui::Context) {
        let Some(before) = self.enlargement else { return };
        if (context.zoom_factor() - before).abs() > 1e-3 {
            self.enlargement = None;
            return;
        }
        let size = context.content_rect().size() * before;
        let times = (size.x / WINDOW[0]).min(size.y / WINDOW[1]);
        // In steps, so that a window that is drawn wider is not drawn anew at each pixel.
        let wanted = (times.max(1.0).powf(ENLARGEMENT) * 10.0).round() / 10.0;
        if wanted != before {
            self.enlargement = Some(wanted);
            context.set_zoom_factor(wanted);
        }
    }

    /// What went wrong last, until somebody clicks it away.
    fn show_failure(&mut self, ui: &mut Ui) {
        let Some(failure) = self.commands.failure.clone() else { return };
        Panel::bottom("failure").show(ui, |ui| {
            ui.horizontal(|ui| {
                let is_read = ui.small_button("\u{d7}").on_hover_text("away with it").clicked();
                ui.add(egui::Label::new(RichText::new(failure).color(Color32::from_rgb(255, 120, 100))).truncate());
                if is_read {
                    self.commands.failure = None;
                }
            });
        });
    }

    /// The screens, in the space that is left.
    fn show_screens(&mut self, ui: &mut Ui, shown: &MirrorFrame, role: MouseRole) {
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let space = ui.available_rect_before_wrap();
        let (vector, raster) = match self.choices.raster {
            RasterPlacement::Beside => {
                let [vector, raster] = self.split.show(ui, space);
                (vector, Some(raster))
            }
            _ => (space, None),
        };
        let lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner).clone();
        ui.scope_builder(UiBuilder::new().max_rect(vector), |ui| {
            let App { vector, mapping, dials, commands: orders, hosts: guests, .. } = self;
            let screen = vector.show(ui, shown, mapping, orders, (role == MouseRole::Dials).then_some(dials));
            welcome::show(ui, screen, shown, guests, &lines, orders);
        });
        if let Some(raster) = raster {
            ui.scope_builder(UiBuilder::new().max_rect(raster), |ui| self.raster.show(ui, shown));
        }
    }

    /// Asks for what the open view shows, if any.
    fn request_views(&self) {
        let mut asked = MirrorRequest::default();
        if let Some(view) = self.choices.view.and_then(|index| self.views.get(index)) {
            view.request(&mut asked);
        }
        self.mirror.request(&asked);
    }

    fn show_raster_window(&mut self, ui: &Ui, shown: &MirrorFrame) {
        let builder = ViewportBuilder::default().with_title("PS 340 raster screen").with_inner_size([640.0, 480.0]);
        let raster = &mut self.raster;
        let closed = ui.ctx().show_viewport_immediate(ViewportId::from_hash_of("raster"), builder, |ui, _class| {
            CentralPanel::no_frame().show(ui, |ui| raster.show(ui, shown));
            ui.ctx().input(|input| input.viewport().close_requested())
        });
        if closed {
            self.choices.raster = RasterPlacement::Hidden;
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.commands.take_replies();
        self.enlarge(ui.ctx());
        let shown = self.mirror.shown();
        if !self.raster_visible && !shown.raster.is_blank() {
            self.raster_visible = true;
            if self.choices.raster == RasterPlacement::Hidden {
                self.choices.raster = RasterPlacement::Beside;
            }
        }
        self.hosts.note(&shown);
        if shown.hosts.is_empty() {
            // How long ago the last one left is shown.
            ui.ctx().request_repaint_after(Duration::from_secs(1));
        }
        let usual = if shown.tablet_is_read { MouseRole::Puck } else { MouseRole::Dials };
        let role = self.choices.role.unwrap_or(usual);
        let drawn_by =
            format!("the window is drawn by {}, the vector screen by {}", self.drawn_by, self.mirror.screen().drawer());
        Panel::top("bar").show(ui, |ui| {
            let App { hosts: guests, choices, views, commands: orders, .. } = self;
            Bar { shown: &shown, hosts: guests, views, role, drawn_by: &drawn_by }.show(ui, choices, orders);
        });
        if self.choices.devices {
            Panel::bottom("devices").show(ui, |ui| {
                devices::show(ui, &shown.panel, &mut self.dials, &mut self.row, &mut self.commands);
            });
        }
        self.show_failure(ui);
        let width = ui.available_width();
        if let Some(view) = self.choices.view.and_then(|index| self.views.get_mut(index)) {
            let (usual, most) = (VIEW_WIDTH.min(width * 0.45), width * 0.7);
            Panel::right("view").resizable(true).default_size(usual).max_size(most).show(ui, |ui| {
                view.show(ui, &shown, &mut self.commands);
            });
        }
        self.request_views();
        let black = egui::Frame::NONE.fill(Color32::from_gray(12)).inner_margin(1.0);
        CentralPanel::default().frame(black).show(ui, |ui| self.show_screens(ui, &shown, role));
        if self.choices.raster == RasterPlacement::Apart {
            self.show_raster_window(ui, &shown);
        }
        let seconds = f64::from(ui.input(|input| input.stable_dt));
        self.pad.act(seconds, &self.mapping, &mut self.dials, &mut self.commands, ui.ctx());
        self.dials.give(&mut self.commands);
    }
}
