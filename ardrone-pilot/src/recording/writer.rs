//! Writes a flight log as MCAP (<https://mcap.dev>), with schemas that Foxglove and Lichtblick know.
//!
//! Messages are JSON with schemas, but for the pictures of the video, which are protocol buffers. Chunks are compressed with
//! LZ4, and each flush ends one, so that everything flushed before a crash can be read.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Seek, Write};
use std::time::Duration;

use ardrone_link::navdata::Packet;
use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, TagStatus, Telemetry};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, Compression, McapError, WriteOptions, Writer};
use serde::Serialize;
use serde_json::json;

use super::messages::{AgentMessage, Bytes, DecodedNavdata, Mission, Place, Progress, Tags, Tick};
use super::neighbour::Neighbour;
use super::order::Order;
use super::{
    AGENT_FILE, EVENT, FLIGHT, FORMAT, Header, OUTCOME, PLAN_FILE, Record, SETTINGS_FILE,
    compressed_video, topic,
};

/// Ticks between pose messages, which exist only for display.
const POSE_TICKS: u64 = 3;
/// Minimum interval of decoded navdata messages; the bytes of every packet are recorded.
const DECODED_APART: Duration = Duration::from_millis(25);
/// Interval of the messages about tags while the same ones are known.
const TAGS_APART: Duration = Duration::from_secs(1);
/// Compresses an eighth better than the default level.
const COMPRESSION_LEVEL: u32 = 6;
/// Name of the metadata that say whose something is.
const VEHICLE: &str = "vehicle";
/// Frame of the poses: right, forward and up from the take-off.
const FRAME: &str = "take_off";
/// Frame of the pictures. Which camera it is changes in flight.
const CAMERA: &str = "camera";

/// Writes a log.
pub struct LogWriter<W: Write + Seek> {
    writer: Writer<W>,
    channels: BTreeMap<&'static str, u16>,
    /// Metadata of each channel: whose it is.
    vehicle: BTreeMap<String, String>,
    start_ns: u64,
    sequence: u32,
    ticks: u64,
    /// Steps of the mission.
    steps: usize,
    /// Time of the last decoded navdata message.
    decoded: Option<Duration>,
    /// Time of the last message about tags, and their numbers.
    tags: Option<(Duration, Vec<u32>)>,
    /// Channel of the video, once there is a picture.
    video: Option<u16>,
}

impl<W: Write + Seek> LogWriter<W> {
    /// Creates a log and writes its header.
    ///
    /// # Errors
    /// [`McapError`] if writing fails.
    pub fn new(writer: W, header: &Header) -> Result<Self, McapError> {
        let options = WriteOptions::new()
            .compression(Some(Compression::Lz4))
            .compression_level(COMPRESSION_LEVEL)
            .profile("")
            .library("ardrone-pilot");
        let mut writer = options.create(writer)?;
        let vehicle = BTreeMap::from([(VEHICLE.to_owned(), header.vehicle.to_string())]);
        let mut channels = BTreeMap::new();
        for topic in topic::ALL {
            let schema = writer.add_schema(topic.schema, "jsonschema", topic.text.as_bytes())?;
            let channel = writer.add_channel(schema, topic.name, "json", &vehicle)?;
            channels.insert(topic.name, channel);
        }
        let start_ns = u64::try_from(header.start.as_nanos()).unwrap_or(u64::MAX);
        let metadata = [
            ("format", FORMAT.to_string()),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("start_ns", start_ns.to_string()),
            (VEHICLE, header.vehicle.to_string()),
            ("plan", header.plan_name.clone()),
            ("mission_agent", header.mission_agent.clone()),
            ("z_origin", header.z_origin.name().to_owned()),
            ("drone", header.drone.clone()),
        ];
        let metadata = metadata.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        writer.write_metadata(&Metadata { name: FLIGHT.to_owned(), metadata })?;
        for (name, text) in [
            (PLAN_FILE, header.plan.as_str()),
            (SETTINGS_FILE, header.settings.as_str()),
            (AGENT_FILE, autopilot::agent::SOURCE),
        ] {
            writer.attach(&Attachment {
                log_time: start_ns,
                create_time: start_ns,
                name: name.to_owned(),
                media_type: "text/plain".to_owned(),
                data: Cow::Borrowed(text.as_bytes()),
            })?;
        }
        Ok(Self {
            writer,
            channels,
            vehicle,
            start_ns,
            sequence: 0,
            ticks: 0,
            steps: 0,
            decoded: None,
            tags: None,
            video: None,
        })
    }

    /// Writes a record.
    ///
    /// # Errors
    /// [`McapError`] if writing fails.
    pub fn write(&mut self, record: &Record) -> Result<(), McapError> {
        match record {
            Record::Navdata { at, packet } => {
                self.message(topic::RAW_NAVDATA, *at, &bytes(packet))?;
                let last = self.decoded.filter(|last| at.saturating_sub(*last) < DECODED_APART);
                // A packet that cannot be decoded is recorded as bytes only.
                if last.is_none()
                    && let Ok(packet) = Packet::decode(packet)
                {
                    self.decoded = Some(*at);
                    self.message(topic::NAVDATA, *at, &DecodedNavdata::from(&packet))?;
                }
                Ok(())
            }
            Record::Control { at, bytes: block } => {
                self.message(topic::CONTROL, *at, &bytes(block))
            }
            Record::Order { at, by, order } => {
                self.message(topic::ORDERS, *at, &Order::new(*by, order.clone()))
            }
            Record::Neighbour { at, neighbour } => {
                self.message(topic::NEIGHBOURS, *at, &Neighbour::from(neighbour))
            }
            Record::Telemetry { at, telemetry } => self.telemetry(*at, telemetry),
            Record::Said { at, said } => {
                let said = AgentMessage { to: said.to.into(), line: said.line.as_str().into() };
                self.message(topic::MESSAGES, *at, &said)
            }
            Record::Heard { at, line } => {
                let own = self.vehicle.get(VEHICLE).map_or("", String::as_str);
                let heard = AgentMessage { to: own.to_owned().into(), line: line.as_str().into() };
                self.message(topic::MESSAGES, *at, &heard)
            }
            Record::Note { at, text } => self.log(*at, Level::Info, EVENT, text),
            Record::Picture { at, picture } => self.picture(*at, picture),
            Record::Tick { decision, timing, datagram } => {
                let tick = Tick::new(decision, *timing, datagram);
                if self.ticks.is_multiple_of(POSE_TICKS) {
                    if let Some(place) = tick.estimate.map(Place::from) {
                        self.message(topic::POSE, decision.at, &self.pose(decision.at, &place))?;
                    }
                    if let Some(target) = &tick.target {
                        self.message(topic::TARGET, decision.at, &self.pose(decision.at, target))?;
                    }
                }
                self.ticks += 1;
                if let Some(status) = &decision.tags {
                    self.tags(decision.at, status)?;
                }
                self.message(topic::TICK, decision.at, &tick)
            }
        }
    }

    fn telemetry(&mut self, at: Duration, telemetry: &Telemetry) -> Result<(), McapError> {
        let level = |is_good| if is_good { Level::Info } else { Level::Warning };
        match telemetry {
            Telemetry::Mission { name, steps, steps_done, .. } => {
                let count = steps.len();
                let steps = steps.iter().map(|step| step.text.clone()).collect();
                self.message(topic::MISSION, at, &Mission { name: name.clone(), steps })?;
                let Some(steps_done) = *steps_done else { return Ok(()) };
                self.steps = count;
                self.progress(at, steps_done)
            }
            Telemetry::Event(event) => {
                if let FlightEvent::StepDone { step } = event {
                    self.progress(at, step + 1)?;
                }
                self.log(at, level(!event.warns()), EVENT, &event.to_string())
            }
            Telemetry::Ended(outcome, report) => {
                self.steps = report.steps;
                self.progress(at, report.steps_done)?;
                let is_good = *outcome == Outcome::Completed;
                self.log(at, level(is_good), OUTCOME, &outcome.to_string())
            }
            Telemetry::Waypoint(_) | Telemetry::Readiness(_) | Telemetry::Status(_) => Ok(()),
        }
    }

    fn progress(&mut self, at: Duration, steps_done: usize) -> Result<(), McapError> {
        self.message(topic::PROGRESS, at, &Progress { steps_done, steps: self.steps })
    }

    /// Writes the known tags once a second, and at once when a tag becomes known or is no longer.
    fn tags(&mut self, at: Duration, status: &TagStatus) -> Result<(), McapError> {
        let is_same = |(last, ids): &(Duration, Vec<u32>)| {
            at.saturating_sub(*last) < TAGS_APART
                && status.known.iter().map(|tag| tag.id).eq(ids.iter().copied())
        };
        if self.tags.as_ref().is_some_and(is_same) {
            return Ok(());
        }
        self.tags = Some((at, status.known.iter().map(|tag| tag.id).collect()));
        self.message(topic::TAGS, at, &Tags::from(status))
    }

    /// Writes a picture; its channel is only in logs that have one.
    fn picture(&mut self, at: Duration, picture: &[u8]) -> Result<(), McapError> {
        let channel = if let Some(channel) = self.video {
            channel
        } else {
            let encoding = compressed_video::ENCODING;
            let schema = compressed_video::schema();
            let schema =
                self.writer.add_schema(compressed_video::SCHEMA_NAME, encoding, &schema)?;
            let channel = self.writer.add_channel(schema, topic::VIDEO, encoding, &self.vehicle)?;
            *self.video.insert(channel)
        };
        let time = Duration::from_nanos(self.start_ns).saturating_add(at);
        self.bytes(channel, at, &compressed_video::message(time, CAMERA, picture))
    }

    /// Ensures that everything written so far survives a crash of the process: it ends the chunk.
    ///
    /// # Errors
    /// [`McapError`] if writing fails.
    pub fn flush(&mut self) -> Result<(), McapError> {
        self.writer.flush()
    }

    /// Finishes the log with its index.
    ///
    /// # Errors
    /// [`McapError`] if writing fails.
    pub fn finish(mut self) -> Result<W, McapError> {
        self.writer.finish()?;
        Ok(self.writer.into_inner())
    }

    fn message(
        &mut self,
        topic: topic::Topic,
        at: Duration,
        content: &impl Serialize,
    ) -> Result<(), McapError> {
        let Some(channel) = self.channels.get(topic.name).copied() else { return Ok(()) };
        let data = serde_json::to_vec(content).map_err(std::io::Error::from)?;
        self.bytes(channel, at, &data)
    }

    fn bytes(&mut self, channel_id: u16, at: Duration, data: &[u8]) -> Result<(), McapError> {
        let time = self.start_ns.saturating_add(u64::try_from(at.as_nanos()).unwrap_or(u64::MAX));
        self.sequence = self.sequence.wrapping_add(1);
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: time,
            publish_time: time,
        };
        self.writer.write_to_known_channel(&header, data)
    }

    fn log(&mut self, at: Duration, level: Level, name: &str, text: &str) -> Result<(), McapError> {
        let log = json!({
            "timestamp": self.timestamp(at),
            "level": level as u8,
            "message": text,
            "name": name,
            "file": "",
            "line": 0,
        });
        self.message(topic::LOG, at, &log)
    }

    fn timestamp(&self, at: Duration) -> serde_json::Value {
        let time = Duration::from_nanos(self.start_ns).saturating_add(at);
        json!({ "sec": time.as_secs(), "nsec": time.subsec_nanos() })
    }

    /// Foxglove's rotation is anticlockwise about the upward axis.
    fn pose(&self, at: Duration, place: &Place) -> serde_json::Value {
        let half_rad = -place.yaw_deg.to_radians() / 2.0;
        json!({
            "timestamp": self.timestamp(at),
            "frame_id": FRAME,
            "pose": {
                "position": { "x": place.x_m, "y": place.y_m, "z": place.z_m },
                "orientation": { "x": 0, "y": 0, "z": half_rad.sin(), "w": half_rad.cos() },
            },
        })
    }
}

/// Severity levels of `foxglove.Log`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Level {
    Info = 2,
    Warning = 3,
}

fn bytes(bytes: &[u8]) -> Bytes {
    Bytes { data: BASE64_STANDARD.encode(bytes) }
}
