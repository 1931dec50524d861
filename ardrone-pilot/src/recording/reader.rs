//! Reads a flight log, complete or truncated.

use std::collections::BTreeMap;
use std::time::Duration;

use autopilot::plan::ZOrigin;
use autopilot::separation;
use autopilot::vehicle::VehicleName;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use diagnostic::printable;
use mcap::records::Record as McapRecord;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError, parse_record};
use serde::de::DeserializeOwned;

use super::messages::{AgentMessage, Bytes, DecodedNavdata, Mission, Progress, Tags, Tick};
use super::neighbour::Neighbour;
use super::order::Order;
use super::{AGENT_FILE, FLIGHT, FORMAT, OUTCOME, PLAN_FILE, SETTINGS_FILE, topic};

/// A recorded flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// The vehicle's name.
    pub vehicle: VehicleName,
    /// The plan's file name.
    pub plan_name: String,
    /// The mission agent that has the place of a plan; empty without one.
    pub mission_agent: String,
    /// The plan.
    pub plan: String,
    /// The settings that were in effect, as TOML.
    pub settings: String,
    /// Source of the agent that flew.
    pub agent: String,
    /// Origin of the plan's heights.
    pub z_origin: ZOrigin,
    /// The drone: an address, or the mock drone.
    pub drone: String,
    /// Version of the program that flew.
    pub version: String,
    /// Origin of the flight's time, since the Unix epoch.
    pub start: Duration,
    /// Entries in the order in which they were written, with the flight's time.
    pub entries: Vec<(Duration, Entry)>,
    /// Whether the log was finished; false if the process was killed.
    pub complete: bool,
}

/// An entry of a log.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// A datagram from the navdata port.
    Navdata(Vec<u8>),
    /// Decoded content of a navdata packet.
    Decoded(DecodedNavdata),
    /// Bytes from the control port.
    Control(Vec<u8>),
    /// An operator's order.
    Order(Box<Order>),
    /// What another vehicle told of itself.
    Neighbour(Neighbour),
    /// What its agent said to that of another vehicle, or that one to it.
    Message(AgentMessage<'static>),
    /// The mission, which has changed.
    Mission(Mission),
    /// How far the mission has come.
    Progress(Progress),
    /// An event as text.
    Event {
        /// Whether it is a warning.
        warns: bool,
        /// Its text.
        text: String,
    },
    /// Outcome of the flight.
    Outcome {
        /// Whether it is a warning.
        warns: bool,
        /// Its text.
        text: String,
    },
    /// The known tags.
    Tags(Tags),
    /// A tick.
    Tick(Box<Tick>),
}

/// Why a log cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// Not an MCAP file.
    #[error("not a flight log: {}", printable(&.0.to_string()))]
    Mcap(#[from] McapError),
    /// A part of a log that was finished cannot be read.
    #[error("it is damaged before byte {at}: {}", printable(&.problem.to_string()))]
    Damaged {
        /// How much of the file was read.
        at: usize,
        /// What is wrong there.
        problem: McapError,
    },
    /// The file is larger than any flight's log.
    #[error("it is larger than {} MB: no flight is that long", LARGEST_FILE_BYTES / 1_000_000)]
    TooLarge,
    /// Its compression ratio is implausible: probably a file made to exhaust memory.
    #[error(
        "not a flight log: its content is more than {LARGEST_RATIO} times as large as the file"
    )]
    Bomb,
    /// A part that every flight log has is missing.
    #[error("not a flight log of ardrone-pilot: it has no {missing}")]
    Foreign {
        /// The missing part.
        missing: String,
    },
    /// Written by a version with another message format.
    #[error("its format is {format}, and this version reads {FORMAT}: take the version that wrote it, {}", printable(.version))]
    OtherFormat {
        /// Its format version.
        format: String,
        /// The version of the program that wrote it.
        version: String,
    },
    /// A message is invalid.
    #[error("damaged message in {topic}: {problem}")]
    Message {
        /// Its topic.
        topic: String,
        /// The problem.
        problem: String,
    },
}

impl Log {
    /// Reads the content of a file. A truncated log is read as far as it goes.
    ///
    /// # Errors
    /// [`LogError`] if it is not a flight log, has another format or is damaged, or is larger than
    /// [`LARGEST_FILE_BYTES`].
    pub fn read(file: &[u8]) -> Result<Self, LogError> {
        Self::read_topics(file, &topic::ALL)
    }

    /// As [`read`](Self::read), but only the ticks, the missions, and the messages for people: a fraction of the memory and of
    /// the time.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_decisions(file: &[u8]) -> Result<Self, LogError> {
        Self::read_topics(file, &[topic::TICK, topic::MISSION, topic::LOG])
    }

    fn read_topics(file: &[u8], wanted: &'static [topic::Topic]) -> Result<Self, LogError> {
        let mut content = Content::read(file, wanted)?;
        let flight = content.flight;
        let mut text = |name: &str| {
            let text = content.texts.remove(name);
            text.ok_or_else(|| LogError::Foreign { missing: name.to_owned() })
        };
        let metadata = |key: &str| {
            flight.get(key).cloned().ok_or_else(|| LogError::Foreign { missing: key.to_owned() })
        };
        let format = metadata("format")?;
        if format.parse() != Ok(FORMAT) {
            return Err(LogError::OtherFormat { format, version: metadata("version")? });
        }
        let start = metadata("start_ns")?
            .parse()
            .map_err(|_| LogError::Foreign { missing: "start_ns that is a number".to_owned() })?;
        let start = Duration::from_nanos(start);
        let vehicle = metadata("vehicle")?
            .parse()
            .map_err(|_| LogError::Foreign { missing: "vehicle that is a name".to_owned() })?;
        let mut entries = content.entries;
        for (at, _) in &mut entries {
            *at = at.saturating_sub(start);
        }
        Ok(Self {
            vehicle,
            plan_name: metadata("plan")?,
            // Logs of before have none.
            mission_agent: metadata("mission_agent").unwrap_or_default(),
            plan: text(PLAN_FILE)?,
            settings: text(SETTINGS_FILE)?,
            agent: text(AGENT_FILE)?,
            z_origin: ZOrigin::from_name(&metadata("z_origin")?).unwrap_or_default(),
            drone: metadata("drone")?,
            version: metadata("version")?,
            start,
            entries,
            complete: content.complete,
        })
    }

    /// All ticks.
    pub fn ticks(&self) -> impl Iterator<Item = (Duration, &Tick)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Tick(tick) => Some((*at, tick.as_ref())),
            _ => None,
        })
    }

    /// The known tags at each time at which they were recorded.
    pub fn tags(&self) -> impl Iterator<Item = (Duration, &Tags)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Tags(tags) => Some((*at, tags)),
            _ => None,
        })
    }

    /// What other vehicles told of themselves, with the time at which it was heard.
    pub fn neighbours(&self) -> impl Iterator<Item = (Duration, separation::Neighbour)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Neighbour(neighbour) => Some((*at, neighbour.heard())),
            _ => None,
        })
    }

    /// Outcome of the flight, and whether it is a warning; `None` if the log does not contain it.
    pub fn outcome(&self) -> Option<(bool, &str)> {
        self.entries.iter().rev().find_map(|(_, entry)| match entry {
            Entry::Outcome { warns, text } => Some((*warns, text.as_str())),
            _ => None,
        })
    }

    /// The mission from each time on at which it changed; none in logs of older versions.
    pub fn missions(&self) -> impl Iterator<Item = (Duration, &Mission)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Mission(mission) => Some((*at, mission)),
            _ => None,
        })
    }

    /// All events, and the outcome: time, whether it is a warning, and text.
    pub fn events(&self) -> impl Iterator<Item = (Duration, bool, &str)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Event { warns, text } => Some((*at, *warns, text.as_str())),
            _ => None,
        })
    }
}

type Texts = BTreeMap<String, String>;

/// Maximum size of a log file: three hours of everything that a drone can send.
pub const LARGEST_FILE_BYTES: usize = 512 << 20;
/// Maximum length of a record or chunk; ours are below 1 MiB.
const LONGEST_RECORD_BYTES: usize = 16 << 20;
/// Maximum compression ratio. Flight logs reach about 4; LZ4 can reach 255.
const LARGEST_RATIO: usize = 32;
/// Unpacked size that is always accepted, because repetitive short logs compress well.
const ALWAYS_UNPACKED_BYTES: usize = 16 << 20;

/// Content of the file.
#[derive(Default)]
struct Content {
    /// The topics that are read.
    wanted: &'static [topic::Topic],
    /// Attached texts by name.
    texts: Texts,
    /// Metadata of the flight.
    flight: Texts,
    /// Known topics by channel.
    topics: BTreeMap<u16, &'static str>,
    /// Messages, with their time since the Unix epoch.
    entries: Vec<(Duration, Entry)>,
    complete: bool,
}

impl Content {
    fn read(file: &[u8], wanted: &'static [topic::Topic]) -> Result<Self, LogError> {
        let mut content = Self { wanted, ..Self::default() };
        read_records(file, |record| content.record(record))?;
        Ok(content)
    }

    fn record(&mut self, record: McapRecord<'_>) -> Result<(), LogError> {
        match record {
            McapRecord::Attachment { header, data, .. } => {
                let name = [PLAN_FILE, SETTINGS_FILE, AGENT_FILE]
                    .into_iter()
                    .find(|name| *name == header.name);
                if let Some(name) = name {
                    let text = String::from_utf8_lossy(&data).into_owned();
                    self.texts.insert(name.to_owned(), text);
                }
            }
            McapRecord::Metadata(metadata) if metadata.name == FLIGHT => {
                self.flight = metadata.metadata;
            }
            McapRecord::Channel(channel) => {
                // Only known names are kept: a file may have a long one for each of its channels.
                let known = self.wanted.iter().find(|topic| topic.name == channel.topic);
                if let Some(topic) = known {
                    self.topics.insert(channel.id, topic.name);
                }
            }
            McapRecord::Message { header, data } => {
                if let Some(topic) = self.topics.get(&header.channel_id)
                    && let Some(entry) = entry(topic, &data)?
                {
                    self.entries.push((Duration::from_nanos(header.log_time), entry));
                }
            }
            McapRecord::Footer(_) => self.complete = true,
            _ => {}
        }
        Ok(())
    }
}

/// Visits all records of a file, up to where it was truncated.
///
/// Each record is parsed as soon as it is unpacked and then dropped, so the memory in use is proportional to the unpacked
/// size, which is bounded by the size of the file.
pub(super) fn read_records(
    file: &[u8],
    mut visit: impl FnMut(McapRecord<'_>) -> Result<(), LogError>,
) -> Result<(), LogError> {
    if file.len() > LARGEST_FILE_BYTES {
        return Err(LogError::TooLarge);
    }
    // The checksum of a chunk is verified before its content is parsed.
    let options = LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(LONGEST_RECORD_BYTES);
    let mut reader = LinearReader::new_with_options(options);
    let was_finished = file.ends_with(MAGIC);
    let mut rest = file;
    let mut room = file.len().saturating_mul(LARGEST_RATIO).saturating_add(ALWAYS_UNPACKED_BYTES);
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let (part, behind) = rest.split_at(wanted.min(rest.len()));
                reader.insert(part.len()).copy_from_slice(part);
                reader.notify_read(part.len());
                rest = behind;
            }
            Ok(LinearReadEvent::Record { data, opcode }) => {
                // An entry takes more memory than the shortest message that it is parsed from.
                let needed = data.len().max(size_of::<(Duration, Entry)>());
                room = room.checked_sub(needed).ok_or(LogError::Bomb)?;
                visit(parse_record(opcode, data)?)?;
            }
            Err(error @ McapError::BadMagic) => return Err(error.into()),
            Err(problem) if was_finished => {
                return Err(LogError::Damaged { at: file.len() - rest.len(), problem });
            }
            // The file was truncated here, perhaps in a chunk whose length had not been written yet.
            Err(_) => return Ok(()),
        }
    }
    Ok(())
}

/// Parses an entry; `None` for messages that exist only for other viewers.
fn entry(topic: &str, data: &[u8]) -> Result<Option<Entry>, LogError> {
    let bytes = |data| -> Result<Vec<u8>, LogError> {
        let Bytes { data } = parse(topic, data)?;
        BASE64_STANDARD.decode(data).map_err(|error| damaged(topic, &error))
    };
    Ok(Some(match topic {
        _ if topic == topic::TICK.name => Entry::Tick(Box::new(parse(topic, data)?)),
        _ if topic == topic::RAW_NAVDATA.name => Entry::Navdata(bytes(data)?),
        _ if topic == topic::NAVDATA.name => Entry::Decoded(parse(topic, data)?),
        _ if topic == topic::CONTROL.name => Entry::Control(bytes(data)?),
        _ if topic == topic::ORDERS.name => Entry::Order(Box::new(parse(topic, data)?)),
        _ if topic == topic::NEIGHBOURS.name => Entry::Neighbour(parse(topic, data)?),
        _ if topic == topic::MESSAGES.name => Entry::Message(parse(topic, data)?),
        _ if topic == topic::MISSION.name => Entry::Mission(parse(topic, data)?),
        _ if topic == topic::PROGRESS.name => Entry::Progress(parse(topic, data)?),
        _ if topic == topic::TAGS.name => Entry::Tags(parse(topic, data)?),
        _ if topic == topic::LOG.name => {
            #[derive(serde::Deserialize)]
            struct Line {
                level: u8,
                name: String,
                message: String,
            }
            let Line { level, name, message } = parse(topic, data)?;
            let warns = level > 2;
            if name == OUTCOME {
                Entry::Outcome { warns, text: message }
            } else {
                Entry::Event { warns, text: message }
            }
        }
        _ => return Ok(None),
    }))
}

fn parse<T: DeserializeOwned>(topic: &str, data: &[u8]) -> Result<T, LogError> {
    serde_json::from_slice(data).map_err(|error| damaged(topic, &error))
}

fn damaged(topic: &str, problem: &impl ToString) -> LogError {
    // The message quotes the file.
    let problem = printable(&problem.to_string()).into_owned();
    LogError::Message { topic: topic.to_owned(), problem }
}
