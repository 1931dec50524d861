//! The session with the drone: what arrives goes in, its events change the phase.

use std::time::Duration;

use ardrone_link::configuration::Configuration;
use ardrone_link::navdata::{GpsFix, Navdata, Packet};
use ardrone_link::session;

use super::life::{Life, Preparation};
use super::{FlightEvent, LandingReason, Outcome, Phase, Refused, Vehicle, sample, sights};

/// Time constant of the navdata rate's average, in seconds.
const RATE_TIME_S: f64 = 1.0;
/// The flight recorder measures once per second.
pub(super) const GPS_MAX_AGE: Duration = Duration::from_secs(2);
/// Requests the drone's clock in demo mode. Some firmware lets only a custom configuration change this key,
/// so flying does not depend on it.
pub(super) const NAVDATA_OPTIONS_KEY: &str = "general:navdata_options";
/// What makes the drone look for tags. A firmware may not know it, or not let the default configuration
/// change it: the flight does not depend on it.
pub(super) const DETECTION_SECTION: &str = "detect:";
/// The video, on which no flight depends.
pub(super) const VIDEO_SECTION: &str = "video:";

impl Vehicle {
    pub(super) fn handle_navdata(&mut self, now: Duration, datagram: &[u8]) -> Result<(), Refused> {
        let navdata = self.pass_on(now, session::Input::Navdata(datagram));
        let navdata = navdata.ok_or(Refused::Datagram)?;
        if let Some(demo) = &navdata.demo {
            self.flight.estimator.update(&sample(now, &navdata, demo));
        }
        self.navdata = Some(navdata);
        if !self.says_on_ground() {
            self.off_ground_at = Some(now);
        }
        if (self.config.gps || self.config.estimator.tags.is_some())
            && let Ok(packet) = Packet::decode(datagram)
        {
            self.handle_further_options(now, &packet);
        }
        Ok(())
    }

    /// What the session does not need: tags, and the flight recorder's position, which is not in every packet.
    fn handle_further_options(&mut self, now: Duration, packet: &Packet<'_>) {
        if self.config.estimator.tags.is_some() && packet.demo().is_some() {
            self.flight.estimator.see(&sights(packet));
        }
        if self.config.gps
            && let Some(gps) = packet.gps()
        {
            self.gps = gps.fix().map(|fix| (now, fix));
        }
    }

    /// The position by the flight recorder, if it is not older than [`GPS_MAX_AGE`].
    pub(super) fn gps(&self, now: Duration) -> Option<GpsFix> {
        let (at, fix) = self.gps?;
        (now.saturating_sub(at) <= GPS_MAX_AGE).then_some(fix)
    }

    /// The battery's voltage in the newest packet. No battery that lets a drone send has 0 V: then it is not measured.
    pub(super) fn battery_v(&self) -> Option<f64> {
        let millivolts = self.navdata.as_ref()?.battery_mv.filter(|millivolts| *millivolts > 0)?;
        Some(f64::from(millivolts) / 1000.0)
    }

    /// Passes an input to the session and handles its outputs; returns new navdata. A datagram for the drone
    /// waits until it is polled.
    pub(super) fn pass_on(&mut self, now: Duration, input: session::Input<'_>) -> Option<Navdata> {
        self.session.handle(now, input);
        self.take_in(now)
    }

    /// Handles the session's outputs.
    pub(super) fn take_in(&mut self, now: Duration) -> Option<Navdata> {
        let mut received = None;
        while let Some(output) = self.session.poll() {
            match output {
                session::Output::Transmit(session::Transmit::Command(_)) => {
                    self.pending.command = true;
                }
                session::Output::Transmit(session::Transmit::WakeUp) => self.pending.wake_up = true,
                session::Output::Navdata(navdata) => {
                    self.count_packet(now);
                    received = Some(navdata);
                }
                session::Output::Event(event) => self.session_event(now, event),
                // The session counts damaged packets.
                _ => {}
            }
        }
        received
    }

    /// A request to the session. It has no outputs before the next tick.
    pub(super) fn request(&mut self, now: Duration, request: session::Request) {
        self.session.handle(now, session::Input::Request(request));
    }

    pub(super) fn count_packet(&mut self, now: Duration) {
        if let Some(last) = self.packet_at.replace(now) {
            let period_s = now.saturating_sub(last).as_secs_f64().max(1e-3);
            let share = (period_s / RATE_TIME_S).min(1.0);
            self.navdata_hz += (1.0 / period_s - self.navdata_hz) * share;
        }
    }

    pub(super) fn handle_control(&mut self, now: Duration, bytes: &[u8]) {
        self.pass_on(now, session::Input::Control(bytes));
    }

    fn session_event(&mut self, now: Duration, event: session::Event) {
        match event {
            session::Event::Connected => {
                if self.life.phase() == Phase::Connecting {
                    self.found(now);
                    self.events.push_back(FlightEvent::Connected);
                }
            }
            session::Event::ConfigurationTimedOut { key } => self.setting_unconfirmed(&key),
            session::Event::ConfigurationRead(configuration) => {
                self.compare_configuration(&configuration);
            }
            session::Event::ConfigurationNotRead => {
                self.configured.not_read = true;
                self.events.push_back(FlightEvent::ConfigurationNotRead);
            }
            session::Event::Ready => {
                self.expect_link_delay();
                if self.life.phase() == Phase::Configuring {
                    // In the air the drone is not level, so flat trim would set a wrong reference.
                    if self.on_ground() {
                        self.request(now, session::Request::FlatTrim);
                    }
                    self.life.prepare(Preparation::Trimming(self.watched_from(now)));
                    self.events.push_back(FlightEvent::Configured);
                }
            }
            session::Event::LinkLost => self.link_lost(now),
            session::Event::DroneRestarted => {
                self.flight.estimator.handle_restart(now);
                self.navdata = None;
                self.gps = None;
                self.camera = None;
                match self.life.phase() {
                    Phase::Flying => self.land(now, LandingReason::DroneRestarted),
                    Phase::Trimming | Phase::Standby => self.begin_to_configure(now),
                    _ => {}
                }
            }
            session::Event::Emergency => {
                self.events.push_back(FlightEvent::Emergency);
            }
            session::Event::EmergencyCleared => {
                self.events.push_back(FlightEvent::EmergencyCleared);
            }
            session::Event::Landed => self.events.push_back(FlightEvent::Landed),
            // The agent has its own take-off timeout.
            session::Event::Configured { .. }
            | session::Event::Airborne
            | session::Event::TakeOffTimedOut => {}
        }
    }

    /// Handles the first answer of the drone.
    fn found(&mut self, now: Duration) {
        if self.on_ground() {
            self.begin_to_configure(now);
        } else {
            self.life.prepare(Preparation::Observing(self.watched_from(now)));
        }
    }

    fn link_lost(&mut self, now: Duration) {
        self.events.push_back(FlightEvent::LinkLost);
        // In flight the agent lands once navdata have been missing for too long.
        if self.life.is_in_flight() {
            return;
        }
        self.navdata = None;
        self.gps = None;
        if self.life.departure().is_some() {
            self.end(now, Outcome::NoDrone);
        }
        self.life.enter(Life::BEGINNING);
    }

    pub(super) fn compare_configuration(&mut self, configuration: &Configuration) {
        let version = configuration.get("general:num_version_soft").map(str::to_owned);
        self.events.push_back(FlightEvent::ConfigurationRead { version });
        let differing: Vec<String> = self
            .settings
            .iter()
            .filter(|setting| !configuration.has(setting.key(), setting.value()))
            .map(|setting| setting.key().to_owned())
            .collect();
        for key in differing {
            self.setting_unconfirmed(&key);
        }
    }

    /// A limit that the drone has not applied forbids the flight. Without the additional navdata options the
    /// estimator falls back to arrival times.
    pub(super) fn setting_unconfirmed(&mut self, key: &str) {
        if key == NAVDATA_OPTIONS_KEY {
            self.events.push_back(FlightEvent::NoDroneClock);
        } else if key.starts_with(DETECTION_SECTION) {
            if !std::mem::replace(&mut self.configured.no_detection, true) {
                self.events.push_back(FlightEvent::NoTagDetection);
            }
        } else if key.starts_with(VIDEO_SECTION) {
            if !std::mem::replace(&mut self.configured.no_video_rate, true) {
                self.events.push_back(FlightEvent::NoVideoRate);
            }
        } else if !self.configured.unconfirmed.iter().any(|other| other == key) {
            self.configured.unconfirmed.push(key.to_owned());
        }
    }
}
