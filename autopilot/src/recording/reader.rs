//! Reads a flight log, also one that was cut off.

use std::collections::BTreeMap;
use std::time::Duration;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use mcap::records::Record as McapRecord;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};
use serde::de::DeserializeOwned;

use super::messages::{Bytes, DecodedNavdata, Hand, Tick};
use super::{AGENT_FILE, FLIGHT, OUTCOME, PLAN_FILE, SETTINGS_FILE, topic};
use crate::pilot::PilotOrder;
use crate::plan::ZOrigin;

/// A flight as it was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// The plan's file name.
    pub plan_name: String,
    /// The plan.
    pub plan: String,
    /// The settings that held, as TOML.
    pub settings: String,
    /// The agent that flew.
    pub agent: String,
    /// Where z = 0 of the plan is.
    pub z_origin: ZOrigin,
    /// What was flown.
    pub drone: String,
    /// The version that flew.
    pub version: String,
    /// When the flight's clock was zero, since the Unix epoch.
    pub start: Duration,
    /// What happened, in the order in which it was written, with the flight's clock.
    pub entries: Vec<(Duration, Entry)>,
    /// Whether the log has its end; one of a process that was killed has not.
    pub complete: bool,
}

/// Something in a log.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// A datagram from the navdata port.
    Navdata(Vec<u8>),
    /// What it said.
    Decoded(DecodedNavdata),
    /// Bytes from the control port.
    Control(Vec<u8>),
    /// The pilot's hand.
    Order(PilotOrder),
    /// Something to be read by people, and whether it is a warning.
    Event {
        /// Whether it is a warning.
        warns: bool,
        /// What happened.
        text: String,
    },
    /// How the flight ended, and whether that is a warning.
    Outcome {
        /// Whether it is a warning.
        warns: bool,
        /// How it ended.
        text: String,
    },
    /// A tick.
    Tick(Box<Tick>),
}

/// Why a log cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// It is no MCAP file, or a damaged one.
    #[error("not a flight log: {0}")]
    Mcap(#[from] McapError),
    /// Something that every flight log has is missing.
    #[error("not a flight log of ardrone-pilot: it has no {missing}")]
    Foreign {
        /// What is missing.
        missing: String,
    },
    /// A message is not what it should be.
    #[error("damaged message in {topic}: {problem}")]
    Message {
        /// Its topic.
        topic: String,
        /// What is wrong.
        problem: String,
    },
}

impl Log {
    /// Reads the content of a file.
    ///
    /// # Errors
    /// [`LogError`] if it is no flight log. One that was cut off is read as far as it goes.
    pub fn read(file: &[u8]) -> Result<Self, LogError> {
        let mut content = Content::read(file)?;
        let flight = content.flight;
        let mut text = |name: &str| {
            let text = content.texts.remove(name);
            text.ok_or_else(|| LogError::Foreign { missing: name.to_owned() })
        };
        let told = |key: &str| {
            flight.get(key).cloned().ok_or_else(|| LogError::Foreign { missing: key.to_owned() })
        };
        let start = told("start_ns")?
            .parse()
            .map_err(|_| LogError::Foreign { missing: "start_ns that is a number".to_owned() })?;
        let start = Duration::from_nanos(start);
        let mut entries = Vec::with_capacity(content.messages.len());
        for (topic, time_ns, data) in &content.messages {
            if let Some(entry) = entry(topic, data)? {
                entries.push((Duration::from_nanos(*time_ns).saturating_sub(start), entry));
            }
        }
        Ok(Self {
            plan_name: told("plan")?,
            plan: text(PLAN_FILE)?,
            settings: text(SETTINGS_FILE)?,
            agent: text(AGENT_FILE)?,
            z_origin: ZOrigin::from_name(&told("z_origin")?).unwrap_or_default(),
            drone: told("drone")?,
            version: told("version")?,
            start,
            entries,
            complete: content.complete,
        })
    }

    /// The ticks.
    pub fn ticks(&self) -> impl Iterator<Item = (Duration, &Tick)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Tick(tick) => Some((*at, tick.as_ref())),
            _ => None,
        })
    }

    /// How the flight ended, and whether that is a warning; nothing if the log does not say.
    pub fn outcome(&self) -> Option<(bool, &str)> {
        self.entries.iter().rev().find_map(|(_, entry)| match entry {
            Entry::Outcome { warns, text } => Some((*warns, text.as_str())),
            _ => None,
        })
    }

    /// What was told to people.
    pub fn events(&self) -> impl Iterator<Item = (Duration, bool, &str)> {
        self.entries.iter().filter_map(|(at, entry)| match entry {
            Entry::Event { warns, text } => Some((*at, *warns, text.as_str())),
            _ => None,
        })
    }
}

type Texts = BTreeMap<String, String>;

/// A length beyond this is a lie, before and after a chunk is unpacked.
const LONGEST_RECORD_BYTES: usize = 64 << 20;

/// What stands in the file.
#[derive(Default)]
struct Content {
    /// Attached texts by name.
    texts: Texts,
    /// What is said of the flight.
    flight: Texts,
    /// Topics by channel.
    topics: BTreeMap<u16, String>,
    /// Topic, time and content of each message.
    messages: Vec<(String, u64, Vec<u8>)>,
    complete: bool,
}

impl Content {
    fn read(file: &[u8]) -> Result<Self, McapError> {
        // The checksum of a chunk is checked before what is in it is looked at.
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(LONGEST_RECORD_BYTES);
        let mut reader = LinearReader::new_with_options(options);
        let mut content = Self::default();
        let mut rest = file;
        while let Some(event) = reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(wanted)) => {
                    let (part, behind) = rest.split_at(wanted.min(rest.len()));
                    reader.insert(part.len()).copy_from_slice(part);
                    reader.notify_read(part.len());
                    rest = behind;
                }
                Ok(LinearReadEvent::Record { data, opcode }) => {
                    content.record(parse_record(opcode, data)?);
                }
                Err(error @ McapError::BadMagic) => return Err(error),
                // It was cut off here, or it is damaged from here on.
                Err(_) => return Ok(content),
            }
        }
        Ok(content)
    }

    fn record(&mut self, record: McapRecord<'_>) {
        match record {
            McapRecord::Attachment { header, data, .. } => {
                self.texts.insert(header.name, String::from_utf8_lossy(&data).into_owned());
            }
            McapRecord::Metadata(metadata) if metadata.name == FLIGHT => {
                self.flight = metadata.metadata;
            }
            McapRecord::Channel(channel) => {
                self.topics.insert(channel.id, channel.topic);
            }
            McapRecord::Message { header, data } => {
                if let Some(topic) = self.topics.get(&header.channel_id) {
                    self.messages.push((topic.clone(), header.log_time, data.into_owned()));
                }
            }
            McapRecord::Footer(_) => self.complete = true,
            _ => {}
        }
    }
}

/// An entry; nothing for what is there for others to draw.
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
        _ if topic == topic::HAND.name => Entry::Order(parse::<Hand>(topic, data)?.into()),
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
    LogError::Message { topic: topic.to_owned(), problem: problem.to_string() }
}
