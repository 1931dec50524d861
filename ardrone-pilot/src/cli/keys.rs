//! Manual control at a terminal, and the line on which orders are typed.
//!
//! Keys are read one by one and not shown. Ctrl-C stays with the system: it works even if nobody reads
//! keys any more. Ctrl-Z does nothing: a suspended pilot flies nothing.

use std::io::{IsTerminal as _, stdin};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use autopilot::Demand;
use autopilot::plan::FlightLimits;
use autopilot::vehicle::{Operator, OperatorOrder, Refused};
use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, poll, read};
use rustix::event::{PollFd, PollFlags, Timespec};
use rustix::termios::{
    InputModes, LocalModes, OptionalActions, SpecialCodeIndex, Termios, tcgetattr, tcsetattr,
};

use super::prompt::{Edited, Prompt, PromptLine};
use super::{terminal, typed};
use crate::flight::Controls;

/// What the keys do, for people.
pub(super) const HELP: &str = "keys: space hold, r resume, l land, q land and quit, \
    wasd and arrows fly by hand, e twice cuts the motors, : types an order (`:help`)";

/// How far a key moves a stick. Terminals repeat a key that is held; they never tell of its release.
const STICK: f64 = 0.4;
/// The second `e` must follow within this time.
const CUT_AGAIN: Duration = Duration::from_secs(2);
/// So often the reader looks whether it is to end.
const LOOK: Duration = Duration::from_millis(100);

/// What a key means.
#[derive(Debug, Clone, PartialEq)]
enum Action {
    Order(OperatorOrder),
    /// As Ctrl-C.
    Stop,
    /// The first `e`.
    AskAgain,
    /// Begin to type an order.
    Type,
}

/// Makes actions of keys.
#[derive(Debug, Default)]
struct Keymap {
    cut_asked: Option<Duration>,
}

impl Keymap {
    /// What a key pressed at `now` means.
    fn action(&mut self, now: Duration, key: KeyCode) -> Option<Action> {
        let asked = self.cut_asked.take();
        let steer = |demand| Some(Action::Order(OperatorOrder::Steer(demand)));
        let rest = Demand::default();
        match key {
            KeyCode::Char(' ') => Some(Action::Order(OperatorOrder::Hold)),
            KeyCode::Char('r') => Some(Action::Order(OperatorOrder::Resume)),
            KeyCode::Char('l') => Some(Action::Order(OperatorOrder::Land)),
            KeyCode::Char('q') => Some(Action::Stop),
            KeyCode::Char(':') => Some(Action::Type),
            KeyCode::Char('w') => steer(Demand { pitch: -STICK, ..rest }),
            KeyCode::Char('s') => steer(Demand { pitch: STICK, ..rest }),
            KeyCode::Char('a') => steer(Demand { roll: -STICK, ..rest }),
            KeyCode::Char('d') => steer(Demand { roll: STICK, ..rest }),
            KeyCode::Up => steer(Demand { gaz: STICK, ..rest }),
            KeyCode::Down => steer(Demand { gaz: -STICK, ..rest }),
            KeyCode::Left => steer(Demand { yaw: -STICK, ..rest }),
            KeyCode::Right => steer(Demand { yaw: STICK, ..rest }),
            KeyCode::Char('e') => {
                if asked.is_some_and(|asked| now.saturating_sub(asked) < CUT_AGAIN) {
                    return Some(Action::Order(OperatorOrder::Cut));
                }
                self.cut_asked = Some(now);
                Some(Action::AskAgain)
            }
            _ => None,
        }
    }
}

/// Reads keys as long as it lives; gives the terminal back as it was.
#[derive(Debug)]
pub(super) struct Keys {
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    before: Termios,
}

impl Keys {
    /// Reads keys for a flight, if there is a terminal to read them from.
    pub(super) fn start(
        controls: Controls,
        limits: FlightLimits,
        line: PromptLine,
    ) -> Option<Self> {
        if !stdin().is_terminal() {
            return None;
        }
        let before = tcgetattr(stdin()).ok()?;
        let mut one_by_one = before.clone();
        one_by_one.local_modes -= LocalModes::ICANON | LocalModes::ECHO;
        // A drone whose pilot is suspended, or waits for its own output, falls out of control.
        one_by_one.special_codes[SpecialCodeIndex::VSUSP] = 0;
        one_by_one.input_modes -= InputModes::IXON;
        tcsetattr(stdin(), OptionalActions::Now, &one_by_one).ok()?;
        let ended = Arc::new(AtomicBool::new(false));
        let thread = {
            let ended = Arc::clone(&ended);
            std::thread::Builder::new()
                .name("keys".to_owned())
                .spawn(move || read_keys(&controls, &limits, line, &ended))
        };
        let keys = Self { ended, thread: thread.ok(), before };
        keys.thread.is_some().then_some(keys)
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A thread that hangs in the terminal must not keep the process: it ends with it.
            for _ in 0..10 {
                if thread.is_finished() {
                    break;
                }
                std::thread::sleep(LOOK / 2);
            }
            if thread.is_finished() && thread.join().is_err() {
                tracing::error!("the thread that reads keys panicked");
            }
        }
        // A terminal that is gone needs nothing back.
        _ = tcsetattr(stdin(), OptionalActions::Now, &self.before);
    }
}

fn read_keys(controls: &Controls, limits: &FlightLimits, line: PromptLine, ended: &AtomicBool) {
    let start = Instant::now();
    let mut prompt = Prompt::new(line);
    let mut keymap = Keymap::default();
    while !ended.load(Ordering::Relaxed) {
        match waiting() {
            Waiting::Keys => {}
            Waiting::Nothing => continue,
            // The flight is told by the system.
            Waiting::Gone => return,
        }
        // One look at the terminal can bring several keys.
        while let Ok(true) = poll(Duration::ZERO) {
            let Ok(event) = read() else { return };
            let Some(key) = pressed(&event) else { continue };
            if prompt.is_open() {
                if let Edited::Entered(line) = prompt.key(key, typed::completions)
                    && let Err(error) = typed::obey(&line, limits, controls, Operator::TERMINAL)
                {
                    tracing::warn!("{line}: {}", terminal::Causes(&error));
                }
                continue;
            }
            match keymap.action(start.elapsed(), unshifted(key)) {
                Some(Action::Type) => prompt.open(),
                Some(action) => act(controls, action),
                None => {}
            }
        }
    }
}

fn act(controls: &Controls, action: Action) {
    let taken = match action {
        // Keys that are held repeat: nobody waits for an answer to each.
        Action::Order(order @ OperatorOrder::Steer(_)) => controls.order(Operator::TERMINAL, order),
        Action::Order(order) => controls.ask(Operator::TERMINAL, order),
        Action::Stop if controls.quit() => Ok(()),
        Action::Stop => Err(Refused::Left),
        Action::AskAgain => {
            tracing::warn!("press e again within 2 s to cut the motors: the drone will fall");
            Ok(())
        }
        Action::Type => Ok(()),
    };
    if let Err(refused) = taken {
        tracing::warn!("{refused}");
    }
}

/// What the terminal has.
enum Waiting {
    Keys,
    Nothing,
    /// It was closed.
    Gone,
}

/// Looks for keys, for a moment. crossterm reads a closed terminal for ever, so it is not asked to.
fn waiting() -> Waiting {
    let moment = Timespec { tv_sec: 0, tv_nsec: i64::from(LOOK.subsec_nanos()) };
    let stdin = stdin();
    let mut terminal = [PollFd::new(&stdin, PollFlags::IN)];
    match rustix::event::poll(&mut terminal, Some(&moment)) {
        Ok(0) | Err(rustix::io::Errno::INTR) => Waiting::Nothing,
        Ok(_) if terminal[0].revents() == PollFlags::IN => Waiting::Keys,
        Ok(_) | Err(_) => Waiting::Gone,
    }
}

/// The key that was pressed, without Ctrl or Alt.
fn pressed(event: &Event) -> Option<KeyCode> {
    match event {
        Event::Key(KeyEvent {
            code,
            modifiers,
            kind: KeyEventKind::Press | KeyEventKind::Repeat,
            ..
        }) if (*modifiers - KeyModifiers::SHIFT).is_empty() => Some(*code),
        _ => None,
    }
}

/// Letters are keys in either case.
fn unshifted(key: KeyCode) -> KeyCode {
    match key {
        KeyCode::Char(letter) => KeyCode::Char(letter.to_ascii_lowercase()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn key(letter: char) -> KeyCode {
        KeyCode::Char(letter)
    }

    #[test]
    fn keys_are_orders() {
        let mut keymap = Keymap::default();
        let mut action = |code| keymap.action(Duration::ZERO, code);
        assert_eq!(action(key(' ')), Some(Action::Order(OperatorOrder::Hold)));
        assert_eq!(action(key('r')), Some(Action::Order(OperatorOrder::Resume)));
        assert_eq!(action(key('l')), Some(Action::Order(OperatorOrder::Land)));
        assert_eq!(action(key('q')), Some(Action::Stop));
        assert_eq!(action(key(':')), Some(Action::Type));
        let forward = Demand { pitch: -STICK, ..Demand::default() };
        assert_eq!(action(key('w')), Some(Action::Order(OperatorOrder::Steer(forward))));
        assert_eq!(action(key('x')), None);
    }

    #[test]
    fn one_e_cuts_nothing() {
        let cut = Some(Action::Order(OperatorOrder::Cut));
        let mut keymap = Keymap::default();
        assert_eq!(keymap.action(Duration::ZERO, key('e')), Some(Action::AskAgain));
        assert_eq!(keymap.action(1900 * MS, key('e')), cut);
        // Too late, or with another key between.
        assert_eq!(keymap.action(2000 * MS, key('e')), Some(Action::AskAgain));
        assert_eq!(keymap.action(4100 * MS, key('e')), Some(Action::AskAgain));
        keymap.action(4200 * MS, key('w'));
        assert_eq!(keymap.action(4300 * MS, key('e')), Some(Action::AskAgain));
    }

    #[test]
    fn letters_are_keys_in_either_case_but_not_with_control() {
        let event = |code, modifiers| Event::Key(KeyEvent::new(code, modifiers));
        assert_eq!(pressed(&event(key('L'), KeyModifiers::SHIFT)).map(unshifted), Some(key('l')));
        assert_eq!(pressed(&event(key('l'), KeyModifiers::CONTROL)), None);
        assert_eq!(pressed(&Event::Resize(80, 24)), None);
    }
}
