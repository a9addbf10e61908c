//! The thread that draws the vector screen, so that neither the machine nor the window waits for it.

use crate::calligraphic::{Scene, SharedDisplay};
use egui::ColorImage;
use std::sync::{Arc, Condvar, Mutex};

/// A request to draw.
#[derive(Clone)]
pub struct DrawRequest {
    /// What to show.
    pub scene: Scene,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl DrawRequest {
    fn is(&self, other: &DrawRequest) -> bool {
        let numbers = |wanted: &DrawRequest| (wanted.scene.version, wanted.scene.settings, wanted.size);
        numbers(self) == numbers(other)
    }
}

/// The state that the two threads share.
#[derive(Default)]
struct PainterState {
    request: Option<DrawRequest>,
    painted: Option<Arc<ColorImage>>,
    /// Whether what is seen depends on what was seen before.
    remembers: bool,
    closed: bool,
}

/// Draws what was requested last, as often as it can.
pub struct Painter {
    state: Arc<(Mutex<PainterState>, Condvar)>,
    last_request: Option<DrawRequest>,
}

impl Painter {
    /// Starts the thread, which draws on `screen`; it asks `context` for a repaint after each picture.
    pub fn new(context: egui::Context, screen: Arc<SharedDisplay>) -> Painter {
        let painter_state = Arc::new((Mutex::new(PainterState::default()), Condvar::new()));
        let shared = painter_state.clone();
        std::thread::spawn(move || paint(&shared, &context, &screen));
        Painter { state: painter_state, last_request: None }
    }

    /// Requests a picture. One that is drawn already, or being drawn, is not drawn again.
    pub fn want(&mut self, wanted: DrawRequest) {
        let same = self.last_request.as_ref().is_some_and(|asked| asked.is(&wanted));
        // A display that remembers goes along with every frame.
        let goes_on = lock(&self.state.0).remembers
            && self.last_request.as_ref().is_none_or(|asked| asked.scene.frame != wanted.scene.frame);
        if same && !goes_on {
            return;
        }
        self.last_request = Some(wanted.clone());
        let (painter_state, changed) = &*self.state;
        lock(painter_state).request = Some(wanted);
        changed.notify_one();
    }

    /// The latest picture, if it was not taken before.
    pub fn take(&self) -> Option<Arc<ColorImage>> {
        lock(&self.state.0).painted.take()
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        let (painter_state, changed) = &*self.state;
        lock(painter_state).closed = true;
        changed.notify_one();
    }
}

/// The thread.
fn paint((painter_state, changed): &(Mutex<PainterState>, Condvar), context: &egui::Context, screen: &SharedDisplay) {
    let mut latest = None;
    loop {
        let mut guard = lock(painter_state);
        let wanted = loop {
            if guard.closed {
                return;
            }
            if let Some(wanted) = guard.request.take() {
                break wanted;
            }
            guard = changed.wait(guard).unwrap_or_else(|poisoned| poisoned.into_inner());
        };
        drop(guard);
        let (image, remembers) = screen.with_display(&wanted.scene, Some(wanted.size), |seen| {
            let is_new = latest.replace(seen.shown) != Some(seen.shown);
            let size = seen.display.size().map(|pixels| pixels as usize);
            let image = || Arc::new(ColorImage::from_rgba_unmultiplied(size, seen.display.frame()));
            (is_new.then(image), seen.is_animated)
        });
        let again = remembers || image.is_some();
        let mut guard = lock(painter_state);
        guard.remembers = remembers;
        if image.is_some() {
            guard.painted = image;
        }
        drop(guard);
        if again {
            context.request_repaint();
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        calligraphic::{Controls, phosphor},
        line::LineId,
        machine::{Input, Machine, Settings},
    };
    use std::time::{Duration, Instant};

    /// What the window shows of the scene, once it is drawn.
    fn painted(painter: &mut Painter, machine: &mut Machine, size: [u32; 2]) -> Arc<ColorImage> {
        painter.want(DrawRequest { scene: machine.scene().clone(), size });
        let begin = Instant::now();
        loop {
            if let Some(image) = painter.take() {
                return image;
            }
            assert!(begin.elapsed() < Duration::from_secs(60), "nothing was painted");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn rgb(image: &ColorImage) -> Vec<u8> {
        image.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect()
    }

    #[test]
    fn a_picture_that_is_ordered_holds_the_bytes_of_the_window_at_every_frame() {
        let size = [90, 70];
        for (name, steady) in [("P22", true), ("P22", false), ("P39", true), ("P7", false), ("P31", true)] {
            let mut machine = Machine::new(Settings::default());
            let screen = Arc::new(SharedDisplay::default());
            machine.share_screen(screen.clone(), true);
            let mut painter = Painter::new(egui::Context::default(), screen);
            let controls = Controls { phosphor: phosphor(name).unwrap(), steady, ..Controls::default() };
            machine.set_controls(controls);
            machine.step([Input::Attach(LineId(1))], 0);
            let mut glow = 0;
            for turn in 0..8 {
                let text = format!("V := VECTOR_LIST N = 2 -0.5,0.{turn} 0.5,-0.{turn}; DISPLAY V;");
                machine.step([Input::Bytes(LineId(1), text.into_bytes())], 0);
                machine.next_frame();
                if turn == 5 {
                    machine.set_controls(Controls { brightness: 0.7, ..controls });
                }
                if turn == 6 {
                    // A frame that the window leaves out.
                    machine.next_frame();
                }
                let window = rgb(&painted(&mut painter, &mut machine, size));
                assert!(window.iter().any(|byte| *byte > 50), "{name} {turn}");
                assert_eq!(machine.vector_picture(None).to_srgb(), window, "{name} {turn}");
                assert_eq!(machine.vector_picture(Some(size)).to_srgb(), window, "{name} {turn}");
                glow += usize::from(window != alone(&mut machine, size));
            }
            assert_eq!(glow > 4, name != "P22", "{name}: {glow} pictures have afterglow");
        }
    }

    /// The picture of now without a past.
    fn alone(machine: &mut Machine, size: [u32; 2]) -> Vec<u8> {
        let screen = SharedDisplay::default();
        screen.with_display(machine.scene(), Some(size), |seen| seen.display.picture().to_srgb())
    }

    #[test]
    fn a_picture_that_was_ordered_first_is_what_the_window_shows_then() {
        let mut machine = Machine::new(Settings::default());
        let screen = Arc::new(SharedDisplay::default());
        machine.share_screen(screen.clone(), true);
        let mut painter = Painter::new(egui::Context::default(), screen);
        let text = "V := VECTOR_LIST N = 2 -0.5,0 0.5,0.2; DISPLAY V;";
        machine.step([Input::Attach(LineId(1)), Input::Bytes(LineId(1), text.into())], 0);
        machine.next_frame();
        let ordered = machine.vector_picture(Some([64, 64])).to_srgb();
        assert_eq!(rgb(&painted(&mut painter, &mut machine, [64, 64])), ordered);
    }
}
