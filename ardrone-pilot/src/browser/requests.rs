//! Requests of a browser: JSON objects like `{"order":"hold"}`.

use std::time::Duration;

use autopilot::vehicle::OperatorOrder;
use serde::Deserialize;
use serde_json::Value;

use super::planning::Planning;
use crate::ordered::{self, ReadError};
use crate::typed;

/// A cut must be confirmed within this time.
const CUT_AGAIN: Duration = Duration::from_secs(3);
/// Orders per second, and at once; nobody clicks faster, and sticks are repeated ten times a second.
const PER_S: f64 = 50.0;
/// Malformed requests tolerated before disconnecting.
const FORGIVEN: u32 = 10;
/// Orders refused as too fast before disconnecting: nobody reads the answers.
const FLOOD: u32 = 500;

/// A request of the page: an order as any program sends it, or one of these.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "order", rename_all = "snake_case", deny_unknown_fields)]
enum Own {
    /// A line as in the terminal.
    Typed { line: String },
    /// Announces a cut, which must be confirmed.
    Arm,
    /// Lands all vehicles of the page.
    LandAll,
}

/// What is to be done.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Requested {
    /// An order to the vehicle that the page shows.
    Order(OperatorOrder),
    /// Nothing yet: a cut was announced.
    Armed,
    /// To land all vehicles.
    LandAll,
}

/// A request that is understood.
enum Request {
    Own(Own),
    Order(OperatorOrder),
}

/// Why a request is not carried out.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(super) enum RequestError {
    /// No order.
    #[error("not understood: {0}")]
    Meaningless(String),
    /// A plan that cannot be flown, or a line that is no order.
    #[error("{0}")]
    Wrong(String),
    /// Orders arrive faster than a person could click.
    #[error("too fast")]
    TooFast,
    /// A cut that was not announced, or too long ago.
    #[error("press twice to cut the motors: the drone will fall")]
    NotArmed,
}

/// State of one browser's requests.
#[derive(Debug, Default)]
pub(super) struct Requests {
    armed: Option<Duration>,
    last: Duration,
    /// Orders that were given in the last second, less with time.
    recent: f64,
    too_fast: u32,
    meaningless: u32,
}

impl Requests {
    /// What a request asks for that was received at `now`.
    ///
    /// # Errors
    /// [`RequestError`] if there is nothing to carry out.
    pub(super) fn order(
        &mut self,
        now: Duration,
        text: &str,
        planning: &Planning,
    ) -> Result<Requested, RequestError> {
        let request = request(text, planning).map_err(|error| match error {
            ReadError::Plan(error) => RequestError::Wrong(error.to_string()),
            error => {
                self.meaningless += 1;
                RequestError::Meaningless(error.to_string())
            }
        })?;
        let since = now.saturating_sub(std::mem::replace(&mut self.last, now));
        self.recent = (self.recent - PER_S * since.as_secs_f64()).max(0.0) + 1.0;
        // However fast orders come, those that stop the drone are taken.
        let stops = match &request {
            Request::Own(own) => matches!(own, Own::Arm | Own::LandAll),
            Request::Order(order) => order.is_for_anyone(),
        };
        if self.recent > PER_S && !stops {
            self.recent = PER_S;
            self.too_fast += 1;
            return Err(RequestError::TooFast);
        }
        // Sticks that are held repeat themselves while somebody presses twice.
        let armed = match request {
            Request::Order(OperatorOrder::Steer(_) | OperatorOrder::Camera { .. }) => self.armed,
            _ => self.armed.take(),
        };
        let is_armed = armed.is_some_and(|at| now.saturating_sub(at) < CUT_AGAIN);
        match request {
            Request::Order(OperatorOrder::Cut) if !is_armed => Err(RequestError::NotArmed),
            Request::Order(order) => Ok(Requested::Order(order)),
            Request::Own(Own::LandAll) => Ok(Requested::LandAll),
            Request::Own(Own::Arm) => {
                self.armed = Some(now);
                Ok(Requested::Armed)
            }
            Request::Own(Own::Typed { line }) => {
                let order = typed::parse_remote(&line, &planning.config.limits);
                match order.map_err(|error| RequestError::Wrong(error.to_string()))? {
                    // As the button, twice.
                    OperatorOrder::Cut if !is_armed => {
                        self.armed = Some(now);
                        Ok(Requested::Armed)
                    }
                    order => Ok(Requested::Order(order)),
                }
            }
        }
    }

    /// Whether they come faster than a person could click.
    pub(super) fn are_fast(&self) -> bool {
        self.recent >= PER_S
    }

    /// Whether so many requests were malformed, or refused as too fast, that the client is not this page.
    pub(super) fn is_garbage(&self) -> bool {
        self.meaningless > FORGIVEN || self.too_fast > FLOOD
    }
}

fn request(text: &str, planning: &Planning) -> Result<Request, ReadError> {
    let mut object: Value = serde_json::from_str(text)?;
    ordered::take_vehicle(&mut object, planning.config.name)?;
    match object.get("order").and_then(Value::as_str) {
        Some("typed" | "arm" | "land_all") => Ok(Request::Own(serde_json::from_value(object)?)),
        _ => ordered::read(&object, &planning.config.limits, planning.tags()).map(Request::Order),
    }
}

#[cfg(test)]
mod tests {
    use ardrone_link::settings::Camera;
    use autopilot::vehicle::{Place, VehicleConfig};
    use kinematics::Sticks;
    use proptest::prelude::*;

    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn planning() -> Planning {
        Planning { config: VehicleConfig::default(), surveyed: None }
    }

    #[test]
    fn requests_are_orders() {
        let order = |text| Requests::default().order(Duration::ZERO, text, &planning());
        assert_eq!(order(r#"{"order":"hold"}"#), Ok(Requested::Order(OperatorOrder::Hold)));
        assert_eq!(order(r#"{"order":"resume"}"#), Ok(Requested::Order(OperatorOrder::Resume)));
        assert_eq!(order(r#"{"order":"land"}"#), Ok(Requested::Order(OperatorOrder::Land)));
        let named = order(r#"{"order":"land","vehicle":"ardrone"}"#);
        assert_eq!(named, Ok(Requested::Order(OperatorOrder::Land)));
        let bottom = Ok(Requested::Order(OperatorOrder::Camera { camera: Camera::Bottom }));
        assert_eq!(order(r#"{"order":"camera","camera":"bottom"}"#), bottom);
        let steer = OperatorOrder::Steer(Sticks { pitch: -0.5, ..Sticks::default() });
        let text = r#"{"order":"steer","roll":0,"pitch":-0.5,"gaz":0,"yaw":0}"#;
        assert_eq!(order(text), Ok(Requested::Order(steer)));
        let go_to = OperatorOrder::GoTo(Place::at(1.5, -2.0));
        assert_eq!(order(r#"{"order":"goto","x_m":1.5,"y_m":-2}"#), Ok(Requested::Order(go_to)));
        for text in [
            "",
            "land",
            "{}",
            r#"{"order":"loop"}"#,
            r#"{"order":"goto","x_m":1.5,"y_m":null}"#,
            r#"{"order":"goto","x_m":1e999,"y_m":0}"#,
            r#"{"order":"goto","x_m":1,"y_m":0,"z_m":1}"#,
            r#"{"order":"hold","for":1}"#,
            r#"{"order":"land","vehicle":"other"}"#,
            r#"{"order":"arm","vehicle":"other"}"#,
        ] {
            assert!(matches!(order(text), Err(RequestError::Meaningless(_))), "{text}");
        }
    }

    #[test]
    fn plans_and_typed_lines_are_orders() {
        let order = |text| Requests::default().order(Duration::ZERO, text, &planning());
        let load = order(r#"{"order":"load","name":"p","plan":"takeoff\ngoto 0 1 0 0\nland\n"}"#);
        assert!(
            matches!(load, Ok(Requested::Order(OperatorOrder::Load(plan))) if plan.steps().len() == 3)
        );
        let append = order(r#"{"order":"typed","line":"goto 1 0 0 0"}"#);
        assert!(matches!(append, Ok(Requested::Order(OperatorOrder::Append(_)))));
        for text in [
            r#"{"order":"load","name":"p","plan":"takeoff\ngoto 99 0 0 0"}"#,
            r#"{"order":"typed","line":"gotoo 1 0 0 0"}"#,
            r#"{"order":"typed","line":"load /etc/passwd"}"#,
            r#"{"order":"typed","line":"quit"}"#,
        ] {
            assert!(matches!(order(text), Err(RequestError::Wrong(_))), "{text}");
        }
    }

    #[test]
    fn one_press_cuts_nothing() {
        const ARM: &str = r#"{"order":"arm"}"#;
        const CUT: &str = r#"{"order":"cut"}"#;
        const TYPED: &str = r#"{"order":"typed","line":"cut"}"#;
        let mut requests = Requests::default();
        let mut order = |tenths, text| requests.order(SECOND / 10 * tenths, text, &planning());
        assert_eq!(order(0, CUT), Err(RequestError::NotArmed));
        assert_eq!(order(10, ARM), Ok(Requested::Armed));
        assert_eq!(order(39, CUT), Ok(Requested::Order(OperatorOrder::Cut)));
        // Confirmed twice; too late; another order in between.
        assert_eq!(order(40, CUT), Err(RequestError::NotArmed));
        assert_eq!(order(50, ARM), Ok(Requested::Armed));
        assert_eq!(order(81, CUT), Err(RequestError::NotArmed));
        assert_eq!(order(90, ARM), Ok(Requested::Armed));
        assert_eq!(order(91, r#"{"order":"hold"}"#), Ok(Requested::Order(OperatorOrder::Hold)));
        assert_eq!(order(92, CUT), Err(RequestError::NotArmed));
        // Typed, it is no faster.
        assert_eq!(order(100, TYPED), Ok(Requested::Armed));
        assert_eq!(order(101, TYPED), Ok(Requested::Order(OperatorOrder::Cut)));
    }

    /// A page that flies by hand repeats its sticks at any moment between two presses.
    #[test]
    fn sticks_that_are_held_neither_delay_nor_prevent_a_cut() {
        const STEER: &str = r#"{"order":"steer","roll":0,"pitch":-0.5,"gaz":0,"yaw":0}"#;
        let (mut requests, planning) = (Requests::default(), planning());
        let mut order = |ms, text| requests.order(Duration::from_millis(ms), text, &planning);
        for ms in (0..1000).step_by(25) {
            assert!(order(ms, STEER).is_ok(), "{ms}");
        }
        assert_eq!(order(1000, r#"{"order":"arm"}"#), Ok(Requested::Armed));
        for ms in (1000..2000).step_by(100) {
            assert!(order(ms, STEER).is_ok());
        }
        assert_eq!(order(2000, r#"{"order":"cut"}"#), Ok(Requested::Order(OperatorOrder::Cut)));
    }

    #[test]
    fn floods_and_garbage_are_noticed() {
        let mut requests = Requests::default();
        let planning = planning();
        let soon = SECOND;
        for _ in 0..50 {
            assert!(requests.order(SECOND, r#"{"order":"resume"}"#, &planning).is_ok());
        }
        assert_eq!(
            requests.order(soon, r#"{"order":"resume"}"#, &planning),
            Err(RequestError::TooFast)
        );
        // However fast they come, a landing is taken, and a cut.
        assert_eq!(requests.order(soon, r#"{"order":"arm"}"#, &planning), Ok(Requested::Armed));
        assert_eq!(
            requests.order(soon, r#"{"order":"cut"}"#, &planning),
            Ok(Requested::Order(OperatorOrder::Cut))
        );
        assert_eq!(
            requests.order(soon, r#"{"order":"land"}"#, &planning),
            Ok(Requested::Order(OperatorOrder::Land))
        );
        assert!(!requests.is_garbage());
        for count in 0..=FORGIVEN {
            assert!(requests.order(SECOND * (count + 2), "?", &planning).is_err());
        }
        assert!(requests.is_garbage());
        let mut requests = Requests::default();
        for count in 0..=FLOOD {
            assert!(!requests.is_garbage(), "{count}");
            // Of 51 at once the last is refused.
            for _ in 0..51 {
                _ = requests.order(SECOND * (count + 1), r#"{"order":"resume"}"#, &planning);
            }
        }
        assert!(requests.is_garbage());
    }

    proptest! {
        #[test]
        fn nothing_panics(text in ".{0,200}") {
            prop_assert!(Requests::default().order(SECOND, &text, &planning()).is_err());
        }
    }
}
