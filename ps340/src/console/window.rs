//! Opening the window, with the machine on a thread beside it.

use super::{
    Appearance, ConsoleError,
    app::App,
    libraries,
    link::{Link, WINDOW},
};
use crate::shell::{ExitReason, Mirror, Options, Window, run};
use std::{
    io,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, OnceLock, PoisonError, mpsc},
};

/// Runs the machine with a window until its end; blocks. Must be called by the first thread of the process.
///
/// `ready` receives each address in use, as a line of text.
///
/// # Errors
/// The reason why there is no window; then the machine is not run either.
pub fn open(
    options: &Options,
    appearance: Appearance,
    ready: impl FnMut(&str) + Send,
) -> Result<ExitReason, ConsoleError> {
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
    let window = Window { mirror: mirror.clone(), operator_lines: orders };
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
        let shown = show(context, Link { mirror, operator_commands: sender, lines }, appearance, opened);
        // The other end of the operator commands is gone: the machine ends if it has not yet.
        let end = machine.join().unwrap_or_else(|_| Err(io::Error::other("the machine's thread failed")));
        shown?;
        Ok(end?)
    })
}

/// Shows the window until it is closed; notifies `opened` when it is there.
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
        Ok(Err(eframe::Error::WinitEventLoop(error))) => {
            Err(ConsoleError::NoServer { display: libraries::display(), reason: error.to_string() })
        }
        Ok(Err(error)) => Err(ConsoleError::Graphics(error.to_string())),
        // The window system's own code panics where a library or a display fails it; its message was printed.
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            Err(ConsoleError::Graphics(text.unwrap_or_else(|| "the window system failed".into())))
        }
    }
}
