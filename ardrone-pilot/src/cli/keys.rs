//! Manual control from a terminal, and the prompt for typed orders.
//!
//! Keys are read one by one without echo. Ctrl-C remains a signal, so it works even if no keys are read any
//! more. Ctrl-Z is disabled, because a suspended process cannot control the drone.

use std::io::{IsTerminal as _, stdin};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use autopilot::plan::FlightLimits;
use autopilot::vehicle::{Operator, OperatorOrder, Refused};
use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, poll, read};
use kinematics::Sticks;
use rustix::event::{PollFd, PollFlags, Timespec};
use rustix::termios::{
    InputModes, LocalModes, OptionalActions, SpecialCodeIndex, Termios, tcgetattr, tcsetattr,
};

use super::prompt::{Edited, Prompt, PromptLine};
use super::recipients::Recipients;
use super::terminal;
use crate::typed::{self, Typed, TypedError};

/// Summary of the keys.
pub(super) const HELP: &str = "keys: space hold, r resume, l land, q land and quit, \
    wasd and arrows fly by hand, e and then Enter cuts the motors, : types an order (`:help`)";
/// What they are for besides, in a fleet.
pub(super) const HELP_OF_FLEET: &str = "1 to 9 choose a vehicle, 0 all: space, r, l and e are for those; q lands all, whoever is chosen";

/// Stick fraction of one key. Terminals repeat a held key, but do not report its release.
const STICK: f64 = 0.4;
/// Enter must follow `e` within this time. Another `e` would not do: a terminal repeats a held key like a pressed one.
const CUT_WITHIN: Duration = Duration::from_secs(2);
/// A held `e` is asked about once in this time.
const ASKED_EVERY: Duration = Duration::from_secs(1);
/// Interval at which the reader checks whether to end.
const LOOK: Duration = Duration::from_millis(100);

/// The meaning of a key.
#[derive(Debug, Clone, PartialEq)]
enum Action {
    Order(OperatorOrder),
    /// Same as Ctrl-C.
    Stop,
    /// `e`: the operator must confirm.
    Confirm,
    /// Opens the prompt.
    Type,
    /// Chooses a vehicle.
    Choose(usize),
}

/// Maps keys to actions.
#[derive(Debug, Default)]
struct Keymap {
    /// Time of the `e` that Enter would confirm.
    armed: Option<Duration>,
    /// When the operator was last asked to.
    asked: Option<Duration>,
}

impl Keymap {
    /// The action of a key pressed at `now`.
    fn action(&mut self, now: Duration, key: KeyCode) -> Option<Action> {
        let (armed, asked) = (self.armed.take(), self.asked.take());
        let steer = |demand| Some(Action::Order(OperatorOrder::Steer(demand)));
        let rest = Sticks::default();
        match key {
            KeyCode::Char(' ') => Some(Action::Order(OperatorOrder::Hold)),
            KeyCode::Char('r') => Some(Action::Order(OperatorOrder::Resume)),
            KeyCode::Char('l') => Some(Action::Order(OperatorOrder::Land)),
            KeyCode::Char('q') => Some(Action::Stop),
            KeyCode::Char(':') => Some(Action::Type),
            KeyCode::Char(digit @ '0'..='9') => {
                digit.to_digit(10).map(|place| Action::Choose(place as usize))
            }
            KeyCode::Char('w') => steer(Sticks { pitch: -STICK, ..rest }),
            KeyCode::Char('s') => steer(Sticks { pitch: STICK, ..rest }),
            KeyCode::Char('a') => steer(Sticks { roll: -STICK, ..rest }),
            KeyCode::Char('d') => steer(Sticks { roll: STICK, ..rest }),
            KeyCode::Up => steer(Sticks { gaz: STICK, ..rest }),
            KeyCode::Down => steer(Sticks { gaz: -STICK, ..rest }),
            KeyCode::Left => steer(Sticks { yaw: -STICK, ..rest }),
            KeyCode::Right => steer(Sticks { yaw: STICK, ..rest }),
            KeyCode::Char('e') => {
                self.armed = Some(now);
                self.asked = asked.filter(|asked| now.saturating_sub(*asked) < ASKED_EVERY);
                if self.asked.is_some() {
                    return None;
                }
                self.asked = Some(now);
                Some(Action::Confirm)
            }
            KeyCode::Enter => armed
                .filter(|armed| now.saturating_sub(*armed) < CUT_WITHIN)
                .map(|_| Action::Order(OperatorOrder::Cut)),
            _ => None,
        }
    }

    /// A key that has no action was pressed.
    fn other_key(&mut self) {
        *self = Self::default();
    }
}

/// Reads keys until it is dropped, and then restores the terminal.
#[derive(Debug)]
pub(super) struct Keys {
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    before: Termios,
}

impl Keys {
    /// Starts reading keys, if standard input is a terminal.
    pub(super) fn start(
        recipients: Recipients,
        limits: &FlightLimits,
        line: PromptLine,
    ) -> Option<Self> {
        if !stdin().is_terminal() {
            return None;
        }
        let before = tcgetattr(stdin()).ok()?;
        let mut one_by_one = before.clone();
        one_by_one.local_modes -= LocalModes::ICANON | LocalModes::ECHO;
        // A suspended process, or one blocked on its own output, would lose control of the drone.
        one_by_one.special_codes[SpecialCodeIndex::VSUSP] = 0;
        one_by_one.input_modes -= InputModes::IXON;
        tcsetattr(stdin(), OptionalActions::Now, &one_by_one).ok()?;
        let ended = Arc::new(AtomicBool::new(false));
        let thread = {
            let (ended, limits) = (Arc::clone(&ended), *limits);
            std::thread::Builder::new()
                .name("keys".to_owned())
                .spawn(move || read_keys(recipients, &limits, line, &ended))
        };
        let keys = Self { ended, thread: thread.ok(), before };
        keys.thread.is_some().then_some(keys)
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A thread blocked in a terminal read must not delay the exit; it ends with the process.
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
        // A terminal that is gone need not be restored.
        _ = tcsetattr(stdin(), OptionalActions::Now, &self.before);
    }
}

fn read_keys(
    mut recipients: Recipients,
    limits: &FlightLimits,
    line: PromptLine,
    ended: &AtomicBool,
) {
    let start = Instant::now();
    let answers = line.clone();
    let mut prompt = Prompt::new(line);
    let mut keymap = Keymap::default();
    while !ended.load(Ordering::Relaxed) {
        match waiting() {
            Waiting::Keys => {}
            Waiting::Nothing => continue,
            // The system signals the flight when the terminal is gone.
            Waiting::Gone => return,
        }
        // One wake-up can bring several keys.
        while let Ok(true) = poll(Duration::ZERO) {
            let Ok(event) = read() else { return };
            let Some(key) = pressed(&event) else {
                if event.is_key_press() {
                    keymap.other_key();
                }
                continue;
            };
            // Any key closes the answer that is shown, and does what it does besides.
            _ = answers.take_answer();
            if prompt.is_open() {
                if let Edited::Entered(line) = prompt.key(key, typed::completions)
                    && let Err(said) = obey(&line, limits, &recipients)
                {
                    answers.show_answer(said);
                }
                continue;
            }
            match keymap.action(start.elapsed(), unshifted(key)) {
                Some(Action::Type) => prompt.open(),
                Some(Action::Choose(place)) => {
                    let is_there = recipients.choose(place);
                    if is_there {
                        answers.show_answer(format!("orders are for {recipients}"));
                    }
                }
                Some(action) => act(&recipients, action),
                None => {}
            }
        }
    }
}

/// Carries out a typed line, or returns what is said to it.
fn obey(line: &str, limits: &FlightLimits, recipients: &Recipients) -> Result<(), String> {
    let told = |error: &dyn std::error::Error| format!(":{line}\n{}", terminal::Causes(error));
    let (named, order) = recipients.named_first(line);
    match typed::parse(order, limits) {
        Ok(Typed::Order(order)) if named.takes_as_one(&order) => {
            return named.ask(Operator::TERMINAL, &order).map_err(|error| told(&error));
        }
        Ok(Typed::Quit) => {
            named.quit();
            return Ok(());
        }
        Err(error @ TypedError::Help(_)) => return Err(error.to_string()),
        _ => {}
    }
    let controls = named.only().map_err(|error| told(&error))?;
    typed::obey(order, limits, controls, Operator::TERMINAL).map_err(|error| match error {
        TypedError::Help(_) => error.to_string(),
        _ => told(&error),
    })
}

fn act(recipients: &Recipients, action: Action) {
    let taken = match action {
        // Held keys repeat, so their answers are not awaited.
        Action::Order(order @ OperatorOrder::Steer(_)) => match recipients.only() {
            Ok(controls) => controls.order(Operator::TERMINAL, order),
            // Nobody steers several at once.
            Err(error) => {
                tracing::warn!("{error}, with its number");
                Ok(())
            }
        },
        Action::Order(order) => recipients.ask(Operator::TERMINAL, &order),
        Action::Stop if recipients.everyone().quit() => Ok(()),
        Action::Stop => Err(Refused::Left),
        Action::Confirm => {
            tracing::warn!(
                "press Enter within 2 s to cut the motors: the drone will fall; any other key calls it off"
            );
            Ok(())
        }
        Action::Type | Action::Choose(_) => Ok(()),
    };
    if let Err(refused) = taken {
        tracing::warn!("{refused}");
    }
}

/// Result of waiting for input.
enum Waiting {
    Keys,
    Nothing,
    /// The terminal was closed.
    Gone,
}

/// Waits for keys for a moment. crossterm would read a closed terminal for ever, so this is checked first.
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

/// The pressed key, if Ctrl and Alt are not held.
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

/// Ignores the case of letters.
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
        let forward = Sticks { pitch: -STICK, ..Sticks::default() };
        assert_eq!(action(key('w')), Some(Action::Order(OperatorOrder::Steer(forward))));
        assert_eq!(action(key('x')), None);
    }

    const CUT: Option<Action> = Some(Action::Order(OperatorOrder::Cut));

    /// A terminal repeats a key that is held: after a moment, and then about thirty times a second.
    #[test]
    fn a_held_e_cuts_nothing() {
        let mut keymap = Keymap::default();
        assert_eq!(keymap.action(Duration::ZERO, key('e')), Some(Action::Confirm));
        let held = (400..5000).step_by(30).map(|ms| keymap.action(ms * MS, key('e')));
        let held: Vec<Action> = held.flatten().collect();
        // It is asked about again, but not thirty times a second.
        assert_eq!(held, [const { Action::Confirm }; 4]);
        assert_eq!(keymap.action(5100 * MS, KeyCode::Enter), CUT);
    }

    #[test]
    fn e_and_enter_cut_within_two_seconds_without_another_key_in_between() {
        let mut keymap = Keymap::default();
        let mut action = |ms: u32, code| keymap.action(ms * MS, code);
        assert_eq!(action(0, KeyCode::Enter), None);
        assert_eq!(action(0, key('e')), Some(Action::Confirm));
        assert_eq!(action(1900, KeyCode::Enter), CUT);
        assert_eq!(action(1950, KeyCode::Enter), None, "once");
        assert_eq!(action(2000, key('e')), Some(Action::Confirm));
        assert_eq!(action(4100, KeyCode::Enter), None, "too late");
        for other in [key('w'), key('x'), KeyCode::Esc] {
            assert_eq!(action(5000, key('e')), Some(Action::Confirm));
            _ = action(5100, other);
            assert_eq!(action(5200, KeyCode::Enter), None, "{other:?}");
        }
        assert_eq!(keymap.action(6000 * MS, key('e')), Some(Action::Confirm));
        keymap.other_key();
        assert_eq!(keymap.action(6100 * MS, KeyCode::Enter), None, "with Ctrl or Alt");
    }

    #[test]
    fn letters_are_keys_in_either_case_but_not_with_control() {
        let event = |code, modifiers| Event::Key(KeyEvent::new(code, modifiers));
        assert_eq!(pressed(&event(key('L'), KeyModifiers::SHIFT)).map(unshifted), Some(key('l')));
        assert_eq!(pressed(&event(key('l'), KeyModifiers::CONTROL)), None);
        assert_eq!(pressed(&Event::Resize(80, 24)), None);
    }
}
