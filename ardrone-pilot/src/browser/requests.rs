//! Requests of a browser: JSON objects like `{"order":"hold"}`.

use std::time::Duration;

use autopilot::vehicle::OperatorOrder;
use kinematics::Sticks;
use serde::Deserialize;

use crate::camera::NamedCamera;

/// A cut must be confirmed within this time.
const CUT_AGAIN: Duration = Duration::from_secs(3);
/// Minimum interval between orders; nobody clicks faster.
const LEAST_APART: Duration = Duration::from_millis(20);
/// Malformed requests tolerated before disconnecting.
const FORGIVEN: u32 = 10;

/// A request of the page.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(tag = "order", rename_all = "lowercase", deny_unknown_fields)]
enum Request {
    Start,
    Hold,
    Resume,
    Land,
    GoTo {
        x_m: f64,
        y_m: f64,
    },
    Camera {
        camera: NamedCamera,
    },
    /// Sticks of the page, repeated as long as one is not centred.
    Steer {
        roll: f64,
        pitch: f64,
        gaz: f64,
        yaw: f64,
    },
    /// Announces a cut, which must be confirmed.
    Arm,
    Cut,
}

/// Why a request is not carried out.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(super) enum RequestError {
    /// Not a valid [`Request`].
    #[error("not understood: {0}")]
    Meaningless(String),
    /// A stick that is further out than it can be.
    #[error("sticks are from -1 to 1")]
    NoSticks,
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
    last: Option<Duration>,
    meaningless: u32,
}

impl Requests {
    /// The order of a request received at `now`; `None` if it only announces a cut.
    ///
    /// # Errors
    /// [`RequestError`] if there is nothing to carry out.
    pub(super) fn order(
        &mut self,
        now: Duration,
        text: &str,
    ) -> Result<Option<OperatorOrder>, RequestError> {
        let request = serde_json::from_str(text).map_err(|error| {
            self.meaningless += 1;
            RequestError::Meaningless(error.to_string())
        })?;
        let last = self.last.replace(now);
        let too_fast = last.is_some_and(|last| now.saturating_sub(last) < LEAST_APART);
        // However fast orders come, a hold and a landing are among those that count.
        if too_fast && !matches!(request, Request::Hold | Request::Land) {
            self.meaningless += 1;
            return Err(RequestError::TooFast);
        }
        let armed = self.armed.take();
        Ok(Some(match request {
            Request::Start => OperatorOrder::Start { when_ready: false },
            Request::Hold => OperatorOrder::Hold,
            Request::Resume => OperatorOrder::Resume,
            Request::Land => OperatorOrder::Land,
            Request::GoTo { x_m, y_m } => OperatorOrder::GoTo { x_m, y_m },
            Request::Camera { camera } => OperatorOrder::Camera(camera.into()),
            Request::Steer { roll, pitch, gaz, yaw } => {
                let sticks = [roll, pitch, gaz, yaw];
                if !sticks.iter().all(|stick| (-1.0..=1.0).contains(stick)) {
                    self.meaningless += 1;
                    return Err(RequestError::NoSticks);
                }
                OperatorOrder::Steer(Sticks { roll, pitch, gaz, yaw })
            }
            Request::Arm => {
                self.armed = Some(now);
                return Ok(None);
            }
            Request::Cut if armed.is_some_and(|at| now.saturating_sub(at) < CUT_AGAIN) => {
                OperatorOrder::Cut
            }
            Request::Cut => return Err(RequestError::NotArmed),
        }))
    }

    /// Whether so many requests were malformed that the client is not this page.
    pub(super) fn is_garbage(&self) -> bool {
        self.meaningless > FORGIVEN
    }
}

#[cfg(test)]
mod tests {
    use ardrone_link::settings::Camera;
    use proptest::prelude::*;

    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn requests_are_orders() {
        let order = |text| Requests::default().order(Duration::ZERO, text);
        assert_eq!(order(r#"{"order":"hold"}"#), Ok(Some(OperatorOrder::Hold)));
        assert_eq!(order(r#"{"order":"resume"}"#), Ok(Some(OperatorOrder::Resume)));
        assert_eq!(order(r#"{"order":"land"}"#), Ok(Some(OperatorOrder::Land)));
        let bottom = Ok(Some(OperatorOrder::Camera(Camera::Bottom)));
        assert_eq!(order(r#"{"order":"camera","camera":"bottom"}"#), bottom);
        let steer = OperatorOrder::Steer(Sticks { pitch: -0.5, ..Sticks::default() });
        let text = r#"{"order":"steer","roll":0,"pitch":-0.5,"gaz":0,"yaw":0}"#;
        assert_eq!(order(text), Ok(Some(steer)));
        let too_far = r#"{"order":"steer","roll":0,"pitch":-1.5,"gaz":0,"yaw":0}"#;
        assert_eq!(order(too_far), Err(RequestError::NoSticks));
        let go_to = OperatorOrder::GoTo { x_m: 1.5, y_m: -2.0 };
        assert_eq!(order(r#"{"order":"goto","x_m":1.5,"y_m":-2}"#), Ok(Some(go_to)));
        for text in [
            "",
            "land",
            "{}",
            r#"{"order":"loop"}"#,
            r#"{"order":"goto"}"#,
            r#"{"order":"goto","x_m":1.5,"y_m":null}"#,
            r#"{"order":"goto","x_m":1e999,"y_m":0}"#,
            r#"{"order":"goto","x_m":1,"y_m":0,"z_m":1}"#,
        ] {
            assert!(matches!(order(text), Err(RequestError::Meaningless(_))), "{text}");
        }
    }

    #[test]
    fn one_press_cuts_nothing() {
        const ARM: &str = r#"{"order":"arm"}"#;
        const CUT: &str = r#"{"order":"cut"}"#;
        let mut requests = Requests::default();
        let mut order = |tenths, text| requests.order(SECOND / 10 * tenths, text);
        assert_eq!(order(0, CUT), Err(RequestError::NotArmed));
        assert_eq!(order(10, ARM), Ok(None));
        assert_eq!(order(39, CUT), Ok(Some(OperatorOrder::Cut)));
        // Confirmed twice; too late; another order in between.
        assert_eq!(order(40, CUT), Err(RequestError::NotArmed));
        assert_eq!(order(50, ARM), Ok(None));
        assert_eq!(order(81, CUT), Err(RequestError::NotArmed));
        assert_eq!(order(90, ARM), Ok(None));
        assert_eq!(order(91, r#"{"order":"hold"}"#), Ok(Some(OperatorOrder::Hold)));
        assert_eq!(order(92, CUT), Err(RequestError::NotArmed));
    }

    #[test]
    fn floods_and_garbage_are_noticed() {
        let mut requests = Requests::default();
        let soon = SECOND + SECOND / 100;
        assert!(requests.order(SECOND, r#"{"order":"resume"}"#).is_ok());
        assert_eq!(requests.order(soon, r#"{"order":"resume"}"#), Err(RequestError::TooFast));
        // However fast they come, a landing is taken.
        assert_eq!(requests.order(soon, r#"{"order":"land"}"#), Ok(Some(OperatorOrder::Land)));
        assert!(!requests.is_garbage());
        for count in 0..FORGIVEN {
            assert!(requests.order(SECOND * (count + 2), "?").is_err());
        }
        assert!(requests.is_garbage());
    }

    proptest! {
        #[test]
        fn nothing_panics(text in ".{0,200}") {
            prop_assert!(Requests::default().order(SECOND, &text).is_err());
        }
    }
}
