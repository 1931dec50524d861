//! Full-screen terminal display: position, activity and decisions.

mod tags;
mod texts;
mod view;

use std::collections::VecDeque;
use std::io::{self, Stderr, stderr};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, PoisonError};

use autopilot::plan::FlightLimits;
use autopilot::vehicle::{Telemetry, VehicleName};
use crossterm::cursor::Show;
use crossterm::execute;
use crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen, size};
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::{Terminal, TerminalOptions, Viewport};
use tracing_subscriber::fmt::MakeWriter;

use self::view::{View, Views};
use super::prompt::PromptLine;
use super::recipients::Recipients;
use super::terminal;
use crate::flight::{Content, Message};
use crate::network::Seen;

/// Minimum size in columns and rows; smaller terminals get lines.
const LEAST: (u16, u16) = (70, 20);
/// Of a larger terminal only this much is drawn on: one may say that it has 65535 columns and rows, whose cells need more
/// memory than there is.
const MOST: (u16, u16) = (500, 200);

/// Colour of what is wrong.
const WARNING: Color = Color::LightRed;

/// Draws the flight, and restores the terminal at the end.
pub(super) struct Screen {
    /// Not dropped: it would panic if the terminal is gone, to say that the cursor could not be shown.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<Stderr>>>,
    area: Rect,
    views: Views,
    recipients: Recipients,
    warnings: Warnings,
    prompt: PromptLine,
}

impl Screen {
    /// Takes over the terminal for these vehicles, with the limits of each; `None` if it is too small or does not
    /// support it.
    pub(super) fn start(
        limits: impl IntoIterator<Item = FlightLimits>,
        recipients: Recipients,
        warnings: &Warnings,
        prompt: PromptLine,
    ) -> Option<Self> {
        let area = area().ok()?;
        if area.width < LEAST.0 || area.height < LEAST.1 {
            return None;
        }
        let options = TerminalOptions { viewport: Viewport::Fixed(area) };
        let terminal = Terminal::with_options(CrosstermBackend::new(stderr()), options);
        let terminal = ManuallyDrop::new(terminal.ok()?);
        execute!(stderr(), EnterAlternateScreen).ok()?;
        warnings.keep(true);
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            leave();
            before(panic);
        }));
        let views = limits.into_iter().map(|limits| View::new(&limits));
        let views =
            Views { all: recipients.names().zip(views).collect(), elsewhere: Vec::new(), shown: 0 };
        let mut screen =
            Self { terminal, area, views, recipients, warnings: warnings.clone(), prompt };
        screen.draw();
        Some(screen)
    }

    /// Adds a line to the list of events.
    pub(super) fn print_line(&mut self, line: &str) {
        for (_, view) in &mut self.views.all {
            view.print_line(line);
        }
        self.draw();
    }

    /// Adds a warning.
    pub(super) fn warn(&mut self, line: &str) {
        self.warn_all(&format!("warning: {line}"));
        self.draw();
    }

    /// Displays a message of the flight.
    pub(super) fn show(&mut self, message: &Message) {
        for warning in self.warnings.take() {
            self.warn_all(&warning);
        }
        let own = |(name, _): &&mut (VehicleName, View)| *name == message.vehicle;
        let warned =
            self.views.all.iter_mut().find(own).and_then(|(_, view)| view.take_in(message));
        // Whatever is shown, warnings of the others are.
        if let Some(warning) = warned {
            let line = format!("{}: {warning}", message.vehicle);
            let others = self.views.all.iter_mut().filter(|(name, _)| *name != message.vehicle);
            others.for_each(|(_, view)| view.warn(&line));
        }
        // Changes between two status messages need no redraw of their own.
        if matches!(message.content, Content::Telemetry(_, Telemetry::Status(_), _)) {
            self.draw();
        }
    }

    /// Takes in what is seen of a vehicle that is flown elsewhere; it is drawn with the next status.
    pub(super) fn show_elsewhere(&mut self, seen: &Seen) {
        let is_it = |known: &&mut Seen| known.vehicle == seen.vehicle;
        match self.views.elsewhere.iter_mut().find(is_it) {
            Some(known) => *known = *seen,
            None => self.views.elsewhere.push(*seen),
        }
    }

    /// Restores the terminal; returns the warnings, so that they can be printed again.
    pub(super) fn end(self) -> Vec<String> {
        self.views.shown().warnings()
    }

    fn warn_all(&mut self, line: &str) {
        self.views.all.iter_mut().for_each(|(_, view)| view.warn(line));
    }

    fn draw(&mut self) {
        self.views.shown = self.recipients.watched();
        let shown = self.views.shown;
        if let Some((_, view)) = self.views.all.get_mut(shown) {
            view.prompt = self.prompt.shown();
            view.answer = self.prompt.answer();
        }
        // The system signals the flight when the terminal is gone.
        if let Ok(area) = area()
            && area != self.area
        {
            self.area = area;
            _ = self.terminal.resize(area);
        }
        _ = self.terminal.draw(|frame| view::draw(frame, &self.views));
    }
}

/// What is drawn on.
fn area() -> io::Result<Rect> {
    let (columns, rows) = size()?;
    Ok(Rect::new(0, 0, columns.min(MOST.0), rows.min(MOST.1)))
}

impl Drop for Screen {
    fn drop(&mut self) {
        leave();
        self.warnings.keep(false);
    }
}

fn leave() {
    // A terminal that is gone need not be restored.
    _ = execute!(stderr(), LeaveAlternateScreen, Show);
}

/// Destination of warnings: standard error, or the screen while there is one.
#[derive(Debug, Clone, Default)]
pub(super) struct Warnings {
    kept: Arc<Mutex<Option<VecDeque<String>>>>,
}

impl Warnings {
    fn keep(&self, keep: bool) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let left = std::mem::replace(&mut *kept, keep.then(VecDeque::new));
        for warning in left.into_iter().flatten() {
            terminal::print_message(warning);
        }
    }

    fn take(&self) -> Vec<String> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.as_mut().map(|kept| kept.drain(..).collect()).unwrap_or_default()
    }
}

impl io::Write for Warnings {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        match kept.as_mut() {
            Some(kept) => {
                kept.push_back(without_colours(String::from_utf8_lossy(bytes).trim()));
                Ok(bytes.len())
            }
            None => stderr().write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        stderr().flush()
    }
}

/// Removes colour sequences: the screen uses its own colours.
fn without_colours(line: &str) -> String {
    let mut parts = line.split('\x1b');
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        plain += part.split_once('m').map_or("", |(_, rest)| rest);
    }
    plain.trim().to_owned()
}

impl MakeWriter<'_> for Warnings {
    type Writer = Self;

    fn make_writer(&self) -> Self {
        self.clone()
    }
}

#[cfg(test)]
mod tests {
    use ratatui::backend::TestBackend;

    use super::view::draw;
    use super::*;
    use crate::typed;

    #[test]
    fn what_is_said_of_a_typed_line_can_be_read_to_its_end() {
        let mut view = View::new(&FlightLimits::default());
        let error = typed::parse("gotto 1 1", &FlightLimits::default()).unwrap_err();
        view.answer = Some(format!(":gotto 1 1\n{error}"));
        view.warn("press Enter within 2 s to cut the motors: the drone will fall");
        let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
        terminal.draw(|frame| draw(frame, &Views::alone(&view))).unwrap();
        insta::assert_snapshot!(terminal.backend());
        view.answer = Some(typed::parse("help", &FlightLimits::default()).unwrap_err().to_string());
        terminal.draw(|frame| draw(frame, &Views::alone(&view))).unwrap();
        let shown = terminal.backend().to_string();
        for word in ["load FILE", "(after an emergency)", "setMaxControl", "landOnTag"] {
            assert!(shown.contains(word), "{word}\n{shown}");
        }
        assert!(!shown.contains("\\u{a}"), "{shown}");
        for (columns, rows) in [(1, 1), (20, 5)] {
            let mut terminal = Terminal::new(TestBackend::new(columns, rows)).unwrap();
            terminal.draw(|frame| draw(frame, &Views::alone(&view))).unwrap();
        }
    }

    #[test]
    fn colours_are_taken_away() {
        let line = "\x1b[33m WARN\x1b[0m press \x1b[1mEnter\x1b[0m now";
        assert_eq!(without_colours(line), "WARN press Enter now");
        assert_eq!(without_colours("plain"), "plain");
        assert_eq!(without_colours("\x1b"), "");
    }
}
