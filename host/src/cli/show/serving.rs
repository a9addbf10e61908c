//! Keys of the workstation, operator commands from standard input, edits of the script and the rendering that goes on
//! meanwhile.

use super::{arguments::ShowArguments, edits::Edit, view_reporter::ViewReporter};
use crate::{
    cli::{CommandFailure, exit::story, output, progress, progress::Progress},
    picture::display::DisplayTransform,
    production::{Production, ProductionError, Progressive, RenderedView, RenderingEvent, VIEW_STAGE},
    render::RenderOrder,
    scene::Scene,
    workstation::{
        Emulator, WorkstationError,
        motion::MOTION_KEY,
        network::{FunctionKey, KEY_PREFIX, KEYS},
    },
};
use std::{
    io::BufRead,
    sync::mpsc,
    time::{Duration, Instant},
};

/// How long to wait for a message before looking for whatever else there may be.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// The key over which the label tells how far a rendering is.
const RENDER_KEY: i32 = 1;
/// Letters of a text in the message line.
const MESSAGE: usize = 80;

/// Serves the person at a workstation that shows a scene.
pub(super) struct Server<'a> {
    production: &'a mut Production,
    emulator: &'a mut Option<Emulator>,
    arguments: &'a ShowArguments,
    view_reporter: &'a mut ViewReporter,
    options: RenderOrder,
    display: DisplayTransform,
    rendering: Option<Progressive>,
    /// What the rendering does now, in words.
    stage: String,
    /// What the key to render says now.
    label: String,
    operator_commands: OperatorCommands,
}

/// Operator commands from standard input for a workstation of our own.
struct OperatorCommands {
    /// None if there are none any more.
    input: Option<mpsc::Receiver<String>>,
    /// Operator commands whose replies are still to come.
    unanswered: u64,
    /// When the machine was last seen at work on one.
    at_work: Instant,
}

impl<'a> Server<'a> {
    /// - `scene`: as it is shown.
    pub(super) fn new(
        production: &'a mut Production,
        emulator: &'a mut Option<Emulator>,
        arguments: &'a ShowArguments,
        told: &'a mut ViewReporter,
        scene: &Scene,
    ) -> Server<'a> {
        let given = emulator.as_ref().map(|_| read_commands());
        let orders = OperatorCommands { input: given, unanswered: 0, at_work: Instant::now() };
        let order = render_options(scene, arguments);
        Server {
            production,
            emulator,
            arguments,
            view_reporter: told,
            options: order,
            display: scene.display,
            rendering: None,
            stage: String::new(),
            label: String::new(),
            operator_commands: orders,
        }
    }

    /// Serves until the end.
    ///
    /// - `edits`: scenes that take the place of this one.
    pub(super) fn serve(
        &mut self,
        edits: Option<&mpsc::Receiver<Result<Edit, CommandFailure>>>,
    ) -> Result<(), CommandFailure> {
        loop {
            if self.perform_commands()? {
                return Ok(());
            }
            if let Some(edit) = edits.and_then(|edits| edits.try_recv().ok()) {
                self.replace(edit)?;
            }
            self.report_rendering()?;
            let message = match self.production.session().message(POLL_INTERVAL, "a key") {
                Ok(message) => message,
                Err(WorkstationError::Timeout { .. }) => continue,
                Err(error) => return Err(error.into()),
            };
            let number = message.strip_prefix(KEY_PREFIX.as_bytes()).and_then(|n| std::str::from_utf8(n).ok());
            let number = number.and_then(|n| n.trim().parse::<i32>().ok());
            match KEYS.iter().find(|row| Some(row.0) == number).map(|row| row.2) {
                Some(FunctionKey::Render) => self.render()?,
                Some(FunctionKey::Cancel) => self.rendering.iter().for_each(Progressive::cancel),
                Some(FunctionKey::Reset) => self.production.reset()?,
                Some(FunctionKey::Camera) => self.view_reporter.report(self.production)?,
                Some(FunctionKey::End) => return Ok(()),
                // The workstation has done what it asks for.
                None if number == Some(MOTION_KEY.0) => {}
                None => say!("message: {}", String::from_utf8_lossy(&message)),
            }
        }
    }

    /// Sends operator commands that were read, and prints the replies; whether that is the end.
    fn perform_commands(&mut self) -> Result<bool, CommandFailure> {
        let Some(emulator) = self.emulator.as_mut() else { return Ok(false) };
        let orders = &mut self.operator_commands;
        match orders.input.as_ref().map(mpsc::Receiver::try_recv) {
            Some(Ok(order)) if order == "quit" => return Ok(true),
            Some(Ok(order)) => {
                emulator.send_operator_command(&order)?;
                orders.at_work = if orders.unanswered == 0 { Instant::now() } else { orders.at_work };
                orders.unanswered += 1;
            }
            // With a window, somebody else gives commands. Without one, the end of the commands is the end, once all
            // are answered and what they began has ended.
            Some(Err(mpsc::TryRecvError::Disconnected)) if emulator.has_window() => orders.input = None,
            Some(Err(mpsc::TryRecvError::Disconnected)) if orders.unanswered == 0 && self.rendering.is_none() => {
                return Ok(true);
            }
            Some(Err(_)) | None => {}
        }
        if let Some(reply) = emulator.reply()? {
            orders.unanswered -= 1;
            orders.at_work = Instant::now();
            say!("{}", reply.replace("\\n", "\n"));
        }
        let session = self.production.session();
        if orders.unanswered > 0 && orders.at_work.elapsed() > session.timeouts().operator_command {
            // Operator commands such as 'frames 10000' take their time; a machine that lives answers its hosts
            // meanwhile.
            session.synchronize()?;
            orders.at_work = Instant::now();
        }
        Ok(false)
    }

    /// Shows a scene in place of the one before, or says why there is none.
    fn replace(&mut self, edit: Result<Edit, CommandFailure>) -> Result<(), CommandFailure> {
        progress::clear();
        let Edit { scene, model, same_view: keeps_view } = match edit {
            Ok(edit) => edit,
            Err(failure) => {
                let text = story(&failure.error);
                output::write_error(&text);
                return Ok(self.production.show_message(&brief(&text))?);
            }
        };
        if self.rendering.take().is_some() {
            self.write_label(KEYS[0].1)?;
        }
        (self.options, self.display) = (render_options(&scene, self.arguments), scene.display);
        self.production.replace(model, keeps_view)?;
        self.production.show_message(" ")?;
        let sent = self.production.sent();
        if !self.arguments.json {
            say!("{} vectors shown anew after {:.3} s", sent.lines, sent.seconds);
            sent.instances.iter().for_each(|instances| say!("{}", instances.describe()));
            sent.motion.iter().for_each(|motion| say!("{}", motion.describe()));
        }
        Ok(())
    }

    /// Begins to render the view that is set.
    fn render(&mut self) -> Result<(), CommandFailure> {
        let matrix = self.production.view()?;
        let seconds = self.production.motion_seconds()?;
        self.rendering = Some(self.production.begin_rendering(&matrix, seconds, &self.options, &self.display)?);
        self.write_label("0 %")
    }

    /// Shows what there is of the image, and tells how far it is.
    fn report_rendering(&mut self) -> Result<(), CommandFailure> {
        let Some(rendering) = &self.rendering else { return Ok(()) };
        for news in rendering.events() {
            match news {
                RenderingEvent::Part { shown, rows, samples, seconds_left } => {
                    self.production.show_rows(&shown, |row| rows[row as usize])?;
                    let all = self.options.samples;
                    let amount = Progress { done: samples, all: all.into(), unit: "samples".into() };
                    let left = progress::clock(seconds_left);
                    self.production.show_message(&format!("{}, {left} left", progress::describe(&amount)))?;
                    self.write_label(&format!("{:.0} %", 100.0 * samples / f64::from(all)))?;
                }
                RenderingEvent::End(ended) => {
                    self.rendering = None;
                    self.end_rendering(ended)?;
                    return self.write_label(KEYS[0].1);
                }
            }
        }
        self.report_stage()
    }

    /// Tells the stage of the rendering and how much of it is done; of samples, parts of the image tell.
    fn report_stage(&mut self) -> Result<(), CommandFailure> {
        let stage = match progress::within(VIEW_STAGE) {
            Some((stage, Some(amount))) if amount.unit != "samples" => {
                format!("{stage}: {}", progress::describe(&amount))
            }
            Some((stage, None)) => stage.to_owned(),
            _ => return Ok(()),
        };
        if stage != self.stage {
            self.production.show_message(&stage)?;
            self.stage = stage;
        }
        Ok(())
    }

    fn end_rendering(&mut self, ended: Result<Box<RenderedView>, ProductionError>) -> Result<(), CommandFailure> {
        let text = match ended {
            Ok(shot) => {
                let (rows, rendering) = (shot.rows(), &shot.rendering);
                self.production.show_rows(&shot.shown, |row| rows[row as usize])?;
                let [least, most] = rendering.film.samples();
                let seconds = rendering.seconds;
                match rendering.complete {
                    true => format!("rendered in {seconds:.3} s, exposed by {:+.2} stops", shot.stops),
                    false if least == most => format!("stopped after {seconds:.3} s at {least} samples"),
                    false => format!("stopped after {seconds:.3} s at {least} to {most} samples"),
                }
            }
            // The person at the dials may have set a view that shows nothing, and something may have moved too far away;
            // that ends nothing.
            Err(error @ (ProductionError::Render(_) | ProductionError::Scene(_) | ProductionError::Thread(_))) => {
                format!("not rendered: {error}")
            }
            Err(error) => return Err(error.into()),
        };
        say!("{text}");
        Ok(self.production.show_message(&brief(&text))?)
    }

    /// Writes the label over the key that renders, unless it is there already.
    fn write_label(&mut self, text: &str) -> Result<(), CommandFailure> {
        if self.label != text {
            self.label = text.into();
            self.production.label(RENDER_KEY, text)?;
        }
        Ok(())
    }
}

/// How a scene is rendered as the arguments say.
fn render_options(scene: &Scene, arguments: &ShowArguments) -> RenderOrder {
    let own = RenderOrder::of(&scene.settings);
    let samples = arguments.samples.unwrap_or(own.samples);
    // A denoiser tells noise from what is there by two samples at least.
    let samples = if arguments.denoise { samples.max(2) } else { samples };
    RenderOrder { samples, footprints: samples, denoise: arguments.denoise, threads: arguments.threads, ..own }
}

/// What a message line has room for, of the first line of a text.
fn brief(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    line.chars().filter(|letter| letter.is_ascii() && !letter.is_control()).take(MESSAGE).collect()
}

/// The lines of standard input, read by a thread of their own.
fn read_commands() -> mpsc::Receiver<String> {
    let (sender, orders) = mpsc::channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            let order = line.trim().to_string();
            if !order.is_empty() && sender.send(order).is_err() {
                return;
            }
        }
    });
    orders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_has_one_short_line_of_plain_letters() {
        assert_eq!(brief("a: b\nc"), "a: b");
        assert_eq!(brief(&"ä\tx".repeat(100)), "x".repeat(MESSAGE));
    }
}
