//! Orders from standard input: one JSON object per line, or lines as typed at the prompt.

use std::io::{BufRead, BufReader, Read as _};

use autopilot::Demand;
use autopilot::plan::{Commands, FlightLimits, Plan};
use autopilot::vehicle::{Operator, OperatorOrder};
use serde::Deserialize;
use serde_json::{Value, json};

use super::{terminal, typed};
use crate::flight::Controls;
use crate::json;

/// Maximum length of a line, longer than any plan that can be flown.
const LONGEST_LINE: u64 = 1 << 20;

/// Format of the lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lines {
    /// JSON objects; each is answered by one.
    Json,
    /// As typed at the prompt; refusals are printed on standard error.
    Typed,
}

/// Meaning of the end of input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AtEnd {
    /// Nothing: orders may come from other stations.
    GoOn,
    /// No more orders can come: land and exit.
    Quit,
}

#[derive(Debug, PartialEq, Deserialize)]
#[serde(tag = "order", rename_all = "lowercase", deny_unknown_fields)]
enum Request {
    Load {
        plan: String,
        #[serde(default)]
        name: Option<String>,
    },
    Append {
        command: String,
    },
    Clear {},
    Start {
        #[serde(default)]
        when_ready: bool,
    },
    Hold {},
    Resume {},
    Steer {
        roll: f64,
        pitch: f64,
        gaz: f64,
        yaw: f64,
    },
    GoTo {
        x_m: f64,
        y_m: f64,
    },
    Land {},
    Cut {},
    Recover {},
    Release {},
    Quit {},
}

/// Starts a thread that reads orders. It ends with the process.
///
/// # Errors
/// If the thread cannot be started.
pub(super) fn read_orders(
    lines: Lines,
    at_end: AtEnd,
    limits: FlightLimits,
    controls: Controls,
) -> std::io::Result<()> {
    std::thread::Builder::new()
        .name("orders".to_owned())
        .spawn(move || {
            let mut input = BufReader::new(std::io::stdin());
            while let Some(line) = next_line(&mut input) {
                match lines {
                    Lines::Json => answer_json(line, &limits, &controls),
                    Lines::Typed => answer_typed(line, &limits, &controls),
                }
            }
            if at_end == AtEnd::Quit {
                controls.quit();
            }
        })
        .map(drop)
}

/// The next non-empty line, or an error if it is too long; `None` at the end of input.
fn next_line(input: &mut impl BufRead) -> Option<Result<String, TooLong>> {
    loop {
        let mut bytes = Vec::new();
        // A read error counts as the end of input.
        let length = input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes).ok()?;
        if length == 0 {
            return None;
        }
        let whole = bytes.last() == Some(&b'\n');
        if !whole && bytes.len() as u64 >= LONGEST_LINE {
            skip_line(input)?;
            return Some(Err(TooLong));
        }
        let line = String::from_utf8_lossy(&bytes).trim().to_owned();
        if !line.is_empty() {
            return Some(Ok(line));
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a line has more than {LONGEST_LINE} bytes")]
struct TooLong;

fn skip_line(input: &mut impl BufRead) -> Option<()> {
    loop {
        let buffer = input.fill_buf().ok()?;
        match buffer.iter().position(|byte| *byte == b'\n') {
            Some(end) => {
                input.consume(end + 1);
                return Some(());
            }
            None if buffer.is_empty() => return Some(()),
            None => {
                let length = buffer.len();
                input.consume(length);
            }
        }
    }
}

fn answer_typed(line: Result<String, TooLong>, limits: &FlightLimits, controls: &Controls) {
    let done = match line {
        Ok(line) => typed::obey(&line, limits, controls, Operator::PROGRAM)
            .map_err(|error| format!("{line}: {}", terminal::Causes(&error))),
        Err(error) => Err(error.to_string()),
    };
    if let Err(error) = done {
        terminal::print_message(format_args!("refused: {error}"));
    }
}

fn answer_json(line: Result<String, TooLong>, limits: &FlightLimits, controls: &Controls) {
    let (id, done) = match line {
        Ok(line) => obey_json(&line, limits, controls),
        Err(error) => (Value::Null, Err(error.to_string())),
    };
    let answer = match done {
        Ok(()) => json!({ "type": "answer", "id": id, "accepted": true }),
        Err(reason) => json!({ "type": "answer", "id": id, "accepted": false, "reason": reason }),
    };
    terminal::print(format_args!("{}\n", json::text(&answer)));
}

/// Carries out a request; returns its `id` and the refusal, if any.
fn obey_json(
    line: &str,
    limits: &FlightLimits,
    controls: &Controls,
) -> (Value, Result<(), String>) {
    let mut object = match serde_json::from_str::<Value>(line) {
        Ok(object) => object,
        Err(error) => return (Value::Null, Err(format!("not JSON: {error}"))),
    };
    let id = object.as_object_mut().and_then(|object| object.remove("id")).unwrap_or(Value::Null);
    let request = match serde_json::from_value::<Request>(object) {
        Ok(request) => request,
        Err(error) => return (id, Err(error.to_string())),
    };
    let order = match order(request, limits) {
        Ok(Some(order)) => order,
        Ok(None) => {
            let heard = controls.quit();
            return (id, if heard { Ok(()) } else { Err("the vehicle has been left".to_owned()) });
        }
        Err(error) => return (id, Err(error)),
    };
    (id, controls.ask(Operator::PROGRAM, order).map_err(|refused| refused.to_string()))
}

/// The order of a request; `None` for a request to quit.
fn order(request: Request, limits: &FlightLimits) -> Result<Option<OperatorOrder>, String> {
    Ok(Some(match request {
        Request::Load { plan, name } => {
            let name = name.as_deref().unwrap_or("plan");
            let plan = Plan::parse_within(name, &plan, limits);
            OperatorOrder::Load(plan.map_err(|error| error.to_string())?)
        }
        Request::Append { command } => {
            let commands = Commands::parse("command", &command);
            OperatorOrder::Append(commands.map_err(|error| error.to_string())?)
        }
        Request::Clear {} => OperatorOrder::Clear,
        Request::Start { when_ready } => OperatorOrder::Start { when_ready },
        Request::Hold {} => OperatorOrder::Hold,
        Request::Resume {} => OperatorOrder::Resume,
        Request::Steer { roll, pitch, gaz, yaw } => {
            OperatorOrder::Steer(Demand { roll, pitch, gaz, yaw })
        }
        Request::GoTo { x_m, y_m } => OperatorOrder::GoTo { x_m, y_m },
        Request::Land {} => OperatorOrder::Land,
        Request::Cut {} => OperatorOrder::Cut,
        Request::Recover {} => OperatorOrder::Recover,
        Request::Release {} => OperatorOrder::Release,
        Request::Quit {} => return Ok(None),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn requested(line: &str) -> Result<Option<OperatorOrder>, String> {
        let request = serde_json::from_str(line).map_err(|error| error.to_string())?;
        order(request, &FlightLimits::default())
    }

    #[test]
    fn objects_are_orders() {
        assert_eq!(requested(r#"{"order":"hold"}"#), Ok(Some(OperatorOrder::Hold)));
        assert_eq!(requested(r#"{"order":"quit"}"#), Ok(None));
        let start = Ok(Some(OperatorOrder::Start { when_ready: true }));
        assert_eq!(requested(r#"{"order":"start","when_ready":true}"#), start);
        let load = requested(r#"{"order":"load","plan":"takeoff\ngoto 0 1 0 0\nland\n"}"#);
        assert!(matches!(load, Ok(Some(OperatorOrder::Load(plan))) if plan.steps().len() == 3));
        let append = requested(r#"{"order":"append","command":"goto 1 0 0 0"}"#);
        assert!(matches!(append, Ok(Some(OperatorOrder::Append(_)))));
        assert!(requested(r#"{"order":"load","plan":"goto 0 1 0 0"}"#).is_err());
        assert!(requested(r#"{"order":"hold","more":1}"#).is_err());
        assert!(requested(r#"{"order":"fly"}"#).is_err());
    }

    #[test]
    fn lines_are_read_however_long_they_are() {
        let long = "x".repeat(3 << 20);
        let text = format!("\n  a \n{long}\nb");
        let mut input = BufReader::new(text.as_bytes());
        let mut lines = std::iter::from_fn(|| next_line(&mut input));
        assert_eq!(lines.next(), Some(Ok("a".to_owned())));
        assert_eq!(lines.next(), Some(Err(TooLong)));
        assert_eq!(lines.next(), Some(Ok("b".to_owned())));
        assert_eq!(lines.next(), None);
    }
}
