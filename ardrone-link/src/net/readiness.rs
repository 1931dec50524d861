//! Whether the drone is configured as requested. Pure: neither sockets nor clocks.

use std::time::Duration;

use tokio::sync::oneshot;

use super::error::{ConfigureError, ReadyError};
use super::limits::CONFIGURE_LIMIT;
use crate::at::Config;
use crate::configuration::Configuration;
use crate::session::Event;

pub(super) type ReadyReply = oneshot::Sender<Result<(), ReadyError>>;
pub(super) type ConfigureReply = oneshot::Sender<Result<(), ConfigureError>>;

/// A setting that was requested later.
#[derive(Debug)]
struct Change {
    key: String,
    deadline: Duration,
    reply: ConfigureReply,
}

#[derive(Debug)]
pub(super) struct Readiness {
    wanted: Vec<Config>,
    limit: Duration,
    not_acknowledged: Vec<String>,
    not_taken: Vec<String>,
    not_read: bool,
    waiting: Vec<(Duration, ReadyReply)>,
    changes: Vec<Change>,
}

impl Readiness {
    /// `wanted` are the settings of the session, to be applied within `limit`.
    pub(super) fn new(wanted: Vec<Config>, limit: Duration) -> Self {
        Self {
            wanted,
            limit,
            not_acknowledged: Vec::new(),
            not_taken: Vec::new(),
            not_read: false,
            waiting: Vec::new(),
            changes: Vec::new(),
        }
    }

    pub(super) fn wait(&mut self, now: Duration, reply: ReadyReply) {
        self.waiting.push((now.saturating_add(self.limit), reply));
    }

    /// Registers one more requested setting; returns whether it may be sent.
    pub(super) fn change(
        &mut self,
        now: Duration,
        ready: bool,
        config: &Config,
        reply: ConfigureReply,
    ) -> bool {
        if !ready {
            answer(reply, Err(ConfigureError::NotReady));
            return false;
        }
        self.wanted.push(config.clone());
        let deadline = now.saturating_add(CONFIGURE_LIMIT);
        self.changes.push(Change { key: config.key().to_owned(), deadline, reply });
        true
    }

    /// Handles an event of the session. If the drone is configured again, the last result counts.
    pub(super) fn event(&mut self, event: &Event) {
        if let Event::Configured { key } | Event::ConfigurationTimedOut { key } = event
            && let Some(place) = self.changes.iter().position(|change| change.key == *key)
        {
            let key = key.clone();
            let refused = Err(ConfigureError::NotAcknowledged { key });
            let made = matches!(event, Event::Configured { .. });
            answer(self.changes.remove(place).reply, if made { Ok(()) } else { refused });
        }
        match event {
            Event::Configured { key } => self.not_acknowledged.retain(|other| other != key),
            Event::ConfigurationTimedOut { key } if !self.not_acknowledged.contains(key) => {
                self.not_acknowledged.push(key.clone());
            }
            Event::ConfigurationRead(configuration) => {
                self.not_read = false;
                self.not_taken = not_taken(&self.wanted, configuration);
            }
            Event::ConfigurationNotRead => self.not_read = true,
            _ => {}
        }
    }

    /// Answers callers if the drone is ready or they have timed out.
    pub(super) fn observe(&mut self, now: Duration, ready: bool, heard: bool) {
        for change in self.changes.extract_if(.., |change| now >= change.deadline) {
            answer(change.reply, Err(ConfigureError::NotAcknowledged { key: change.key }));
        }
        for (deadline, reply) in std::mem::take(&mut self.waiting) {
            let result = if ready {
                self.judge()
            } else if now < deadline {
                self.waiting.push((deadline, reply));
                continue;
            } else if heard {
                Err(ReadyError::NotConfigured { limit: self.limit })
            } else {
                Err(ReadyError::NotHeard { limit: self.limit })
            };
            answer(reply, result);
        }
    }

    /// Drops all callers' channels.
    pub(super) fn end(&mut self) {
        self.waiting.clear();
        self.changes.clear();
    }

    fn judge(&self) -> Result<(), ReadyError> {
        if !self.not_acknowledged.is_empty() {
            Err(ReadyError::NotAcknowledged { keys: self.not_acknowledged.clone() })
        } else if self.not_read {
            Err(ReadyError::NotReadBack)
        } else if !self.not_taken.is_empty() {
            Err(ReadyError::NotTaken { keys: self.not_taken.clone() })
        } else {
            Ok(())
        }
    }
}

/// Answers a caller, which may have stopped waiting.
fn answer<T>(reply: oneshot::Sender<T>, result: T) {
    _ = reply.send(result);
}

/// Keys for which the drone reports another value, or none. If a key is set twice, the last value counts.
fn not_taken(wanted: &[Config], configuration: &Configuration) -> Vec<String> {
    let is_last = |place: usize, key: &str| !wanted[place + 1..].iter().any(|it| it.key() == key);
    let differing = wanted.iter().enumerate().filter(|(place, config)| {
        is_last(*place, config.key()) && !configuration.has(config.key(), config.value())
    });
    differing.map(|(_, config)| config.key().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: Duration = Duration::from_secs(30);

    fn readiness() -> Readiness {
        let config = |key, value| Config::new(key, value).unwrap();
        let wanted = vec![
            config("general:navdata_demo", "TRUE"),
            config("control:altitude_max", "3000"),
            config("control:altitude_max", "2000"),
        ];
        Readiness::new(wanted, LIMIT)
    }

    /// Result for a caller once the drone is ready.
    fn judged(readiness: &mut Readiness) -> Result<(), ReadyError> {
        let (reply, mut answer) = oneshot::channel();
        readiness.wait(Duration::ZERO, reply);
        readiness.observe(Duration::ZERO, true, true);
        answer.try_recv().unwrap()
    }

    #[test]
    fn a_wait_ends_at_its_limit_and_says_how_far_the_drone_was() {
        for (heard, error) in [
            (false, ReadyError::NotHeard { limit: LIMIT }),
            (true, ReadyError::NotConfigured { limit: LIMIT }),
        ] {
            let mut readiness = readiness();
            let (reply, mut answer) = oneshot::channel();
            readiness.wait(Duration::from_secs(1), reply);
            readiness.observe(LIMIT, false, heard);
            assert!(answer.try_recv().is_err(), "it has a second left");
            readiness.observe(LIMIT + Duration::from_secs(1), false, heard);
            assert_eq!(answer.try_recv(), Ok(Err(error)));
        }
    }

    #[test]
    fn a_key_counts_as_refused_until_it_is_acknowledged_after_all() {
        let mut readiness = readiness();
        let key = "control:altitude_max".to_owned();
        assert_eq!(judged(&mut readiness), Ok(()));
        for _ in 0..2 {
            readiness.event(&Event::ConfigurationTimedOut { key: key.clone() });
        }
        let refused = ReadyError::NotAcknowledged { keys: vec![key.clone()] };
        assert_eq!(judged(&mut readiness), Err(refused));
        readiness.event(&Event::Configured { key });
        assert_eq!(judged(&mut readiness), Ok(()));
    }

    #[test]
    fn what_is_read_back_must_be_what_was_set_last() {
        let mut readiness = readiness();
        let read = |altitude: &str| {
            let text = format!("general:navdata_demo = TRUE\ncontrol:altitude_max = {altitude}\n");
            Event::ConfigurationRead(Configuration::parse(&text))
        };
        readiness.event(&Event::ConfigurationNotRead);
        assert_eq!(judged(&mut readiness), Err(ReadyError::NotReadBack));
        readiness.event(&read("3000"));
        let keys = vec!["control:altitude_max".to_owned()];
        assert_eq!(judged(&mut readiness), Err(ReadyError::NotTaken { keys }));
        readiness.event(&read("2000"));
        assert_eq!(judged(&mut readiness), Ok(()));
    }

    #[test]
    fn a_change_ends_by_the_drones_word_or_at_the_limit() {
        let config = Config::new("control:outdoor", "TRUE").unwrap();
        let key = config.key().to_owned();
        let refused = Err(ConfigureError::NotAcknowledged { key: key.clone() });
        let ask = |readiness: &mut Readiness, ready| {
            let (reply, answer) = oneshot::channel();
            let taken = readiness.change(Duration::ZERO, ready, &config, reply);
            assert_eq!(taken, ready);
            answer
        };
        let mut readiness = readiness();
        assert_eq!(ask(&mut readiness, false).try_recv(), Ok(Err(ConfigureError::NotReady)));
        let mut answers = [(); 3].map(|()| ask(&mut readiness, true));
        readiness.event(&Event::Configured { key: "control:altitude_max".to_owned() });
        assert!(answers[0].try_recv().is_err(), "another key");
        readiness.event(&Event::Configured { key: key.clone() });
        assert_eq!(answers[0].try_recv(), Ok(Ok(())));
        readiness.event(&Event::ConfigurationTimedOut { key });
        assert_eq!(answers[1].try_recv(), Ok(refused.clone()));
        readiness.observe(CONFIGURE_LIMIT.saturating_sub(Duration::from_millis(1)), true, true);
        assert!(answers[2].try_recv().is_err());
        readiness.observe(CONFIGURE_LIMIT, true, true);
        assert_eq!(answers[2].try_recv(), Ok(refused));
    }
}
