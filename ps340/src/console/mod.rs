//! The console: a window with both screens and every device of the machine.
//!
//! It is the only user of egui and eframe, and owns no state of the machine: it sees by a mirror
//! ([`crate::shell::Mirror`]) and acts by orders, as an operator on a line does.

mod orders;
mod places;
mod mapping;
mod libraries;
mod painter;
mod puck;
mod keyboard;
mod dials;
mod steering;
mod screens;
mod split;
mod pad;
mod keys;
mod devices;
mod readable;
mod views;
mod welcome;
mod choices;
mod bar;
mod app;

pub use mapping::{DEFAULT_MAPPING, Mapping, MappingError};

use crate::line::OperatorLine;
use crate::shell::{End, Mirror, Options, Window, run};
use app::App;
use std::{
    io,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, OnceLock, PoisonError, mpsc},
};

/// Width and height of the window at first, points.
const WINDOW: [f32; 2] = [1280.0, 860.0];

/// What window and machine share.
struct Link {
    /// What is to be seen of the machine.
    mirror: Arc<Mirror>,
    /// Where orders go.
    orders: mpsc::Sender<OperatorLine>,
    /// Where hosts attach, as soon as that is known.
    lines: Arc<Mutex<Vec<String>>>,
}

/// How the window begins.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// What keys do.
    pub mapping: Mapping,
    /// Points on the screen per unit of the window; none for what the display says.
    pub scale: Option<f32>,
}

/// Why there is no window, or no machine.
#[derive(Debug, thiserror::Error)]
pub enum ConsoleError {
    /// The machine cannot run.
    #[error(transparent)]
    Machine(#[from] io::Error),
    /// No display is there.
    #[error("no window: neither DISPLAY nor WAYLAND_DISPLAY is set; without '--window' the machine needs no display")]
    NoDisplay,
    /// The display that is named cannot be reached.
    #[error(
        "no window: the display {0} cannot be reached: nothing serves it, or not this user; without '--window' the machine needs no display"
    )]
    NoServer(String),
    /// A library of the window system is missing.
    #[error("no window: the library {library} is missing; on Debian and Ubuntu: apt install {package}")]
    NoLibrary {
        /// Its file.
        library: &'static str,
        /// The package that has it.
        package: &'static str,
    },
    /// Nothing can draw a window here.
    #[error(
        "no window: {0}; it needs Vulkan or OpenGL, on Debian and Ubuntu: apt install mesa-vulkan-drivers libvulkan1"
    )]
    Graphics(String),
}

/// Runs the machine with a window until its end; blocks. Must be called by the first thread of the process.
///
/// `ready` is told each address in use, as a line of text.
///
/// # Errors
/// Why there is no window; then the machine is not run either.
pub fn open(options: &Options, appearance: Appearance, ready: impl FnMut(&str) + Send) -> Result<End, ConsoleError> {
    libraries::check()?;
    let context = Arc::new(OnceLock::<egui::Context>::new());
    let woken = context.clone();
    let wake = move || {
        if let Some(context) = woken.get() {
            context.request_repaint();
        }
    };
    let mirror = Arc::new(Mirror::new(options.drawer.clone(), wake));
    let lines = Arc::new(Mutex::new(Vec::new()));
    let told = lines.clone();
    let mut tell = ready;
    let ready = move |text: &str| {
        if let Some(line) = text.strip_prefix("ready line ") {
            told.lock().unwrap_or_else(PoisonError::into_inner).push(line.to_owned());
        }
        tell(text);
    };
    let (sender, orders) = mpsc::channel();
    let window = Window { mirror: mirror.clone(), orders };
    let (opened, opening) = mpsc::channel();
    std::thread::scope(|scope| {
        let closing = context.clone();
        let machine = scope.spawn(move || {
            // It begins when there is a window.
            opening.recv().map_err(io::Error::other)?;
            let end = run(options, Some(window), ready);
            if let Some(context) = closing.get() {
                context.send_viewport_cmd(egui::ViewportCommand::Close);
                context.request_repaint();
            }
            end
        });
        let shown = show(context, Link { mirror, orders: sender, lines }, appearance, opened);
        // The other end of the orders is gone: the machine ends if it has not yet.
        let end = machine.join().unwrap_or_else(|_| Err(io::Error::other("the machine's thread failed")));
        shown?;
        Ok(end?)
    })
}

/// Shows the window until it is closed; tells `opened` when it is there.
fn show(
    context: Arc<OnceLock<egui::Context>>,
    link: Link,
    appearance: Appearance,
    opened: mpsc::Sender<()>,
) -> Result<(), ConsoleError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("PS 340")
        .with_app_id("ps340")
        .with_inner_size(WINDOW)
        .with_min_inner_size([1.0, 1.0]);
    // Keys such as CONTROL C belong to the machine.
    let mut native = eframe::NativeOptions { viewport, clipboard_shortcuts: false, ..Default::default() };
    if let eframe::egui_wgpu::WgpuSetup::CreateNew(setup) = &mut native.wgpu_options.wgpu_setup {
        // As large a window as the adapter can do, not 8192 pixels on each.
        let usual = setup.device_descriptor.clone();
        setup.device_descriptor = Arc::new(move |adapter| {
            let mut descriptor = usual(adapter);
            descriptor.required_limits.max_texture_dimension_2d = adapter.limits().max_texture_dimension_2d;
            descriptor
        });
    }
    let started = catch_unwind(AssertUnwindSafe(|| {
        eframe::run_native(
            "PS 340",
            native,
            Box::new(move |creation| {
                let _ = context.set(creation.egui_ctx.clone());
                let _ = opened.send(());
                Ok(Box::new(App::new(creation, link, appearance)))
            }),
        )
    }));
    match started {
        Ok(Ok(())) => Ok(()),
        Ok(Err(eframe::Error::WinitEventLoop(_))) => Err(ConsoleError::NoServer(libraries::display())),
        Ok(Err(error)) => Err(ConsoleError::Graphics(error.to_string())),
        // The window system's own code panics where a library or a display fails it; its message was printed.
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            Err(ConsoleError::Graphics(text.unwrap_or_else(|| "the window system failed".into())))
        }
    }
}
