//! Orders from standard input: one JSON object per line, or lines as typed at the prompt.

use std::io::{BufRead, BufReader, Read as _};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use autopilot::plan::{FlightLimits, TagUse};
use autopilot::vehicle::{Operator, OperatorOrder, Refused};
use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use serde_json::{Value, json};

use super::recipients::Recipients;
use super::terminal;
use crate::ordered;
use crate::typed::{self, Typed};

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

/// Orders that may wait to be passed on. A line beyond them is refused at once, so that reading never stops:
/// a landing may stand behind them.
const WAITING: usize = 1024;
/// Interval at which an order is offered again to a tick loop that has no room for it, and the limit.
const OFFER_AGAIN: Duration = Duration::from_millis(5);
const OFFERED_FOR: Duration = Duration::from_secs(1);
/// Limit for the vehicle's answer: many ticks.
const ANSWER_TIME: Duration = Duration::from_secs(1);
/// Reason for which an order in front of a landing is refused.
const OVERTAKEN: &str = "a landing, a cut or the end was ordered behind it";

/// Starts the threads that read, pass on and answer orders. They end with the process.
///
/// # Errors
/// If a thread cannot be started.
pub(super) fn read_orders(
    lines: Lines,
    at_end: AtEnd,
    limits: &FlightLimits,
    recipients: Recipients,
) -> std::io::Result<()> {
    let limits = *limits;
    let desk = Desk::default();
    let (waiting, orders) = bounded(WAITING);
    let (answering, answers) = unbounded::<(Caller, Receiver<Result<(), Refused>>)>();
    let passing = desk.clone();
    let start = |name: &str| std::thread::Builder::new().name(name.to_owned());
    start("order answers").spawn(move || {
        for (caller, answer) in answers {
            let answer = answer.recv_timeout(ANSWER_TIME).unwrap_or(Err(Refused::Busy));
            caller.answer(answer.map_err(|refused| refused.to_string()));
        }
    })?;
    start("order passing").spawn(move || {
        for order in orders {
            passing.pass_on(order, &answering);
        }
    })?;
    start("orders").spawn(move || {
        let mut input = BufReader::new(std::io::stdin());
        while let Some(line) = next_line(&mut input) {
            let (caller, wanted) = match lines {
                Lines::Json => parse_json(line, &limits, &recipients),
                Lines::Typed => parse_typed(line, &limits, &recipients),
            };
            desk.take(caller, wanted, &waiting);
        }
        if at_end == AtEnd::Quit {
            desk.stop(|| recipients.quit());
        }
    })?;
    Ok(())
}

/// What a line asks for, and of whom.
#[derive(Debug, Clone)]
enum Wanted {
    Order(Recipients, OperatorOrder),
    Quit(Recipients),
}

/// Who gets the answer to a line.
#[derive(Debug, Clone, PartialEq)]
enum Caller {
    /// A program: its answer, with the `id` that it gave.
    Json(Value),
    /// A person, who sees refusals behind the line.
    Typed(String),
}

impl Caller {
    fn answer(&self, answer: Result<(), String>) {
        match (self, answer) {
            (Self::Json(object), answer) => {
                let mut object = object.clone();
                object["accepted"] = answer.is_ok().into();
                if let Err(reason) = answer {
                    object["reason"] = reason.into();
                }
                terminal::print_object(&object);
            }
            (Self::Typed(_), Ok(())) => {}
            (Self::Typed(line), Err(reason)) => {
                terminal::print_message(format_args!("refused: {line}: {reason}"));
            }
        }
    }
}

/// An order on its way, and how many landings had been ordered when it was read.
#[derive(Debug)]
struct Waiting {
    caller: Caller,
    whose: Recipients,
    order: OperatorOrder,
    landings: u64,
}

/// Passes orders on to the tick loops. A landing overtakes whatever waits in front of it, and what it has
/// overtaken is not carried out any more: it could lift the drone again.
#[derive(Debug, Clone, Default)]
struct Desk {
    /// Landings, cuts and ends so far. Held while an order is passed on, so that none is passed on behind a
    /// landing that was read behind it.
    landings: Arc<Mutex<u64>>,
}

impl Desk {
    fn landings(&self) -> MutexGuard<'_, u64> {
        self.landings.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Carries out what comes first; everything else waits its turn.
    fn take(&self, caller: Caller, wanted: Result<Wanted, String>, waiting: &Sender<Waiting>) {
        match wanted {
            Err(reason) => caller.answer(Err(reason)),
            Ok(Wanted::Quit(whose)) => {
                let heard = self.stop(|| whose.quit());
                caller.answer(if heard { Ok(()) } else { Err(Refused::Left.to_string()) });
            }
            Ok(Wanted::Order(whose, order @ (OperatorOrder::Land | OperatorOrder::Cut))) => {
                let taken = self.stop(|| whose.order(Operator::PROGRAM, &order));
                caller.answer(taken.map_err(|refused| refused.to_string()));
            }
            Ok(Wanted::Order(whose, order)) if whose.takes_as_one(&order) => {
                let taken = whose.order(Operator::PROGRAM, &order);
                caller.answer(taken.map_err(|refused| refused.to_string()));
            }
            Ok(Wanted::Order(whose, order)) => {
                let landings = *self.landings();
                if let Err(full) = waiting.try_send(Waiting { caller, whose, order, landings }) {
                    full.into_inner().caller.answer(Err(Refused::Busy.to_string()));
                }
            }
        }
    }

    fn stop<T>(&self, order: impl FnOnce() -> T) -> T {
        let mut landings = self.landings();
        *landings += 1;
        order()
    }

    fn pass_on(
        &self,
        waiting: Waiting,
        answering: &Sender<(Caller, Receiver<Result<(), Refused>>)>,
    ) {
        let Waiting { caller, whose, order, landings } = waiting;
        let controls = match whose.only() {
            Ok(controls) => controls,
            Err(error) => return caller.answer(Err(error.to_string())),
        };
        let attempts = OFFERED_FOR.as_millis() / OFFER_AGAIN.as_millis();
        for _ in 0..attempts {
            let (sender, answer) = bounded(1);
            let now = self.landings();
            if *now != landings {
                caller.answer(Err(OVERTAKEN.to_owned()));
                return;
            }
            // There is room for the answer, and the receiver may have given up.
            let reply = move |answer| _ = sender.try_send(answer);
            match controls.order_answered(Operator::PROGRAM, order.clone(), reply) {
                Ok(()) => {
                    // The thread that answers ends with the process.
                    _ = answering.send((caller, answer));
                    return;
                }
                Err(Refused::Busy) => {
                    drop(now);
                    std::thread::sleep(OFFER_AGAIN);
                }
                Err(refused) => {
                    caller.answer(Err(refused.to_string()));
                    return;
                }
            }
        }
        caller.answer(Err(Refused::Busy.to_string()));
    }
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

fn parse_typed(
    line: Result<String, TooLong>,
    limits: &FlightLimits,
    recipients: &Recipients,
) -> (Caller, Result<Wanted, String>) {
    let line = match line {
        Ok(line) => line,
        Err(error) => return (Caller::Typed(String::new()), Err(error.to_string())),
    };
    let (whose, order) = recipients.named_first(&line);
    let wanted = match typed::parse(order, limits) {
        Ok(Typed::Order(order)) => Ok(Wanted::Order(whose, order)),
        Ok(Typed::Quit) => Ok(Wanted::Quit(whose)),
        Err(error) => Err(terminal::Causes(&error).to_string()),
    };
    (Caller::Typed(line), wanted)
}

fn parse_json(
    line: Result<String, TooLong>,
    limits: &FlightLimits,
    recipients: &Recipients,
) -> (Caller, Result<Wanted, String>) {
    let answer = |id: Value, whose: &Recipients| {
        Caller::Json(json!({ "type": "answer", "id": id, "vehicle": whose.vehicle() }))
    };
    let unnamed = |reason: String| (answer(Value::Null, recipients), Err(reason));
    let line = match line {
        Ok(line) => line,
        Err(error) => return unnamed(error.to_string()),
    };
    let mut object = match serde_json::from_str::<Value>(&line) {
        Ok(object) => object,
        Err(error) => return unnamed(format!("not JSON: {error}")),
    };
    let mut take = |key| object.as_object_mut().and_then(|object| object.remove(key));
    let id = take("id").unwrap_or(Value::Null);
    let whose = match take("vehicle") {
        None => Ok(recipients.clone()),
        Some(name) => name.as_str().and_then(|name| recipients.named(name)).ok_or(name),
    };
    let whose = match whose {
        Ok(whose) => whose,
        Err(name) => return (answer(id, recipients), Err(format!("there is no vehicle {name}"))),
    };
    let wanted = match object.get("order").and_then(Value::as_str) {
        Some("quit") => Ok(Wanted::Quit(whose.clone())),
        _ => ordered::read(&object, limits, TagUse::Unknown)
            .map(|order| Wanted::Order(whose.clone(), order)),
    };
    (answer(id, &whose), wanted.map_err(|error| error.to_string()))
}

#[cfg(test)]
mod tests {
    use autopilot::vehicle::{Place, VehicleName};

    use super::super::recipients::NoneChosen;
    use super::*;
    use crate::flight::Controls;

    /// What is ordered of whom; no order is the end.
    type Read = Result<Option<(Recipients, OperatorOrder)>, String>;

    fn read(line: &str, recipients: &Recipients) -> (Caller, Read) {
        let (caller, wanted) =
            parse_json(Ok(line.to_owned()), &FlightLimits::default(), recipients);
        let wanted = wanted.map(|wanted| match wanted {
            Wanted::Order(whose, order) => Some((whose, order)),
            Wanted::Quit(_) => None,
        });
        (caller, wanted)
    }

    fn fleet() -> Recipients {
        let named = |name: &str| Controls::of_nobody(name.parse().unwrap());
        Recipients::new(["left", "right"].map(named).into())
    }

    #[test]
    fn an_order_names_its_vehicle_of_several() {
        let recipients = fleet();
        let whose = |line: &str| {
            let (caller, wanted) = read(line, &recipients);
            let Caller::Json(answer) = caller else { panic!() };
            (answer["vehicle"].clone(), wanted.map(|order| order.unwrap().0.to_string()))
        };
        let right = whose(r#"{"vehicle":"right","order":"start","when_ready":true}"#);
        assert_eq!(right, (json!("right"), Ok("right".to_owned())));
        assert_eq!(whose(r#"{"order":"land"}"#), (Value::Null, Ok("all vehicles".to_owned())));
        assert!(whose(r#"{"vehicle":"middle","order":"land"}"#).1.unwrap_err().contains("middle"));
        let typed = |line: &str| match parse_typed(
            Ok(line.to_owned()),
            &FlightLimits::default(),
            &recipients,
        )
        .1
        {
            Ok(Wanted::Order(whose, order)) => (whose.to_string(), order),
            other => panic!("{line}: {other:?}"),
        };
        assert_eq!(typed("left hold"), ("left".to_owned(), OperatorOrder::Hold));
        assert_eq!(typed("hold"), ("all vehicles".to_owned(), OperatorOrder::Hold));
    }

    #[test]
    fn a_vehicle_that_is_called_like_an_order_takes_none_away() {
        let named = |name: &str| Controls::of_nobody(name.parse().unwrap());
        let recipients = Recipients::new(["land", "goto", "cut"].map(named).into());
        for line in ["land", "cut", "goto 1 0 0 0"] {
            let (whose, order) = recipients.named_first(line);
            assert_eq!((whose.to_string().as_str(), order), ("all vehicles", line));
        }
    }

    #[test]
    fn several_take_only_what_each_can_do_where_it_is() {
        let (recipients, left) = (fleet(), fleet().named("left").unwrap());
        for order in [OperatorOrder::Hold, OperatorOrder::Land, OperatorOrder::Cut] {
            assert!(recipients.takes_as_one(&order) && !left.takes_as_one(&order), "{order:?}");
        }
        assert!(!recipients.takes_as_one(&OperatorOrder::Start { when_ready: true }));
        assert_eq!(recipients.only().err(), Some(NoneChosen));
        assert_eq!(left.only().unwrap().vehicle().as_str(), "left");
        let mut chosen = recipients;
        assert!(chosen.choose(2) && chosen.to_string() == "right");
        assert!(!chosen.choose(3) && chosen.to_string() == "right");
        assert!(chosen.choose(0) && chosen.only().is_err());
        let mut alone = Recipients::new(vec![Controls::of_nobody(VehicleName::default())]);
        assert!(!alone.choose(1) && alone.only().is_ok());
    }

    #[test]
    fn objects_are_orders() {
        let recipients = Recipients::new(vec![Controls::of_nobody(VehicleName::default())]);
        let requested = |line: &str| {
            let (caller, wanted) = read(line, &recipients);
            let answer = json!({ "type": "answer", "id": 7, "vehicle": "ardrone" });
            assert_eq!(caller, Caller::Json(answer));
            wanted.map(|order| order.map(|(_, order)| order))
        };
        let order = |order| Ok(Some(order));
        assert_eq!(requested(r#"{"id":7,"order":"hold"}"#), order(OperatorOrder::Hold));
        assert_eq!(requested(r#"{"id":7,"order":"quit"}"#), Ok(None));
        let named = requested(r#"{"id":7,"vehicle":"ardrone","order":"land"}"#);
        assert_eq!(named, order(OperatorOrder::Land));
        let start = requested(r#"{"id":7,"order":"start","when_ready":true}"#);
        assert_eq!(start, order(OperatorOrder::Start { when_ready: true }));
        let load = requested(r#"{"id":7,"order":"load","plan":"takeoff\ngoto 0 1 0 0\nland\n"}"#);
        assert!(matches!(load, Ok(Some(OperatorOrder::Load(plan))) if plan.steps().len() == 3));
        let append = requested(r#"{"id":7,"order":"append","commands":"goto 1 0 0 0"}"#);
        assert!(matches!(append, Ok(Some(OperatorOrder::Append(_)))));
        let high = Place { height_m: Some(1.5), ..Place::default() };
        let go_to = requested(r#"{"id":7,"order":"goto","height_m":1.5}"#);
        assert_eq!(go_to, order(OperatorOrder::GoTo(high)));
        for wrong in [
            r#"{"id":7,"order":"load","plan":"goto 0 1 0 0"}"#,
            r#"{"id":7,"order":"hold","more":1}"#,
            r#"{"id":7,"order":"land","vehicle":"other"}"#,
            r#"{"id":7,"order":"quit","vehicle":"other"}"#,
            r#"{"id":7,"order":"land","vehicle":null}"#,
            r#"{"id":7,"order":"fly"}"#,
            r#"{"id":7}"#,
        ] {
            assert!(requested(wrong).is_err(), "{wrong}");
        }
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
