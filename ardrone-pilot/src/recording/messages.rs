//! Messages of the flight log: JSON objects whose fields have the same names in the file and here.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::time::Duration;

use ardrone_link::at::Motion;
use ardrone_link::navdata::{GpsFix, Packet};
use ardrone_link::session::FlightOrder;
use autopilot::vehicle::{Decision, KnownTag, Quantity, RestsOn, TagStatus, Worth};
use kinematics::Pose;
use serde::{Deserialize, Deserializer, Serialize};

/// A tick: state, decision and output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tick {
    /// Phase of the flight.
    pub phase: String,
    /// Index of the plan step, from 0.
    pub step: Option<usize>,
    /// Estimated state; `None` while it was unknown.
    pub estimate: Option<Estimate>,
    /// Target of the position controller.
    pub target: Option<Place>,
    /// Command sent to the drone.
    pub command: Command,
    /// The agent's decision and its inputs.
    pub agent: Agent,
    /// Why the safety monitor replaced the agent's command.
    pub veto: Option<String>,
    /// What is not believed of navdata: quantity, and how that shows. `None` in logs of older versions.
    #[serde(default)]
    pub disbelieved: Option<BTreeMap<String, String>>,
    /// What lasts of the wind: how it accelerates the drone towards right and forward in the world. `None` in logs of older
    /// versions.
    #[serde(default)]
    pub wind_m_s2: Option<[f64; 2]>,
    /// Timing of the tick.
    pub timing: Timing,
    /// Text of the datagram.
    pub datagram: String,
}

/// What the vehicle's agent said to that of another one, or that one to it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AgentMessage<'a> {
    /// To whom: the name of its vehicle.
    pub to: Cow<'a, str>,
    /// Version of the messages, sender, and what was said.
    pub line: Cow<'a, str>,
}

impl AgentMessage<'_> {
    /// Who said it, and what; `None` if it is no such line.
    pub fn parts(&self) -> Option<(&str, &str)> {
        let (_, rest) = self.line.split_once(' ')?;
        rest.split_once(' ')
    }
}

/// The mission from a moment on.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Mission {
    /// Name of the loaded plan; empty without one.
    pub name: String,
    /// Its steps, as written.
    pub steps: Vec<String>,
}

/// How far the mission has come: when it changes, when a step is done, and at the end of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Progress {
    /// Its steps up to the last one that was carried out.
    pub steps_done: usize,
    /// All its steps.
    pub steps: usize,
}

/// A position and a heading in the world, which begins at the drone's start, or is the frame that a fleet's vehicles share.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Metres to the right of the origin.
    pub x_m: f64,
    /// Metres forward of it.
    pub y_m: f64,
    /// Metres above the floor.
    pub z_m: f64,
    /// Degrees clockwise.
    pub yaw_deg: f64,
}

/// The estimated state that the decision was based on, in the world as in a [`Place`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Metres to the right of the origin.
    pub x_m: f64,
    /// Metres forward of it.
    pub y_m: f64,
    /// Metres above the floor.
    pub z_m: f64,
    /// Degrees clockwise.
    pub yaw_deg: f64,
    /// To the right in the world.
    pub vx_m_s: f64,
    /// Forward in the world.
    pub vy_m_s: f64,
    /// Up.
    pub vz_m_s: f64,
    /// Standard deviation of the position on each horizontal axis.
    pub uncertainty_m: f64,
    /// Time since the tag was seen on which that rests; `None` if it rests on the drone's velocity alone.
    #[serde(default)]
    pub tag_seen_s: Option<f64>,
    /// Standard deviation of the height.
    pub height_uncertainty_m: f64,
}

/// REF and PCMD as fractions of the limits, with the drone's signs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// `land`, `take off` or `stay`.
    pub flight: String,
    /// Positive flies right.
    pub roll: f64,
    /// Positive flies backward.
    pub pitch: f64,
    /// Positive climbs.
    pub gaz: f64,
    /// Positive turns clockwise.
    pub yaw: f64,
    /// The drone holds its position by itself; the sticks are ignored.
    pub hover: bool,
}

/// One step of the agent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Agent {
    /// Plans chosen, the event's first.
    pub plans: Vec<ChosenPlan>,
    /// The agent's command.
    pub command: String,
    /// How its last order ended.
    pub report: Option<String>,
    /// Danger that it reported.
    pub danger: Option<String>,
    /// Remaining charge in percent.
    pub battery_percent: Option<u32>,
    /// Time since the newest plausible navdata.
    pub blind_for_ms: i64,
    /// Wind disturbance as a fraction of the acceleration at full tilt.
    pub wind: f64,
    /// The drone reported that it has landed.
    pub on_ground: bool,
}

/// A plan of the agent.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChosenPlan {
    /// Its triggering event.
    pub trigger: String,
    /// Its first line in the agent's source, which is attached to the log.
    pub line: u32,
}

/// Timing of a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Timing {
    /// Delay after its deadline.
    pub late_ms: f64,
    /// Time from its begin until the datagram was sent.
    pub work_ms: f64,
}

/// Decoded content of a navdata packet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DecodedNavdata {
    /// Sequence number.
    pub sequence: u32,
    /// State bits of the header.
    pub state: u32,
    /// The drone's control state.
    pub control_state: Option<String>,
    /// Remaining charge in percent.
    pub battery_percent: Option<u32>,
    /// Ultrasound altitude.
    pub altitude_m: Option<f64>,
    /// Forward, right, down of the drone. What is no number is null in the file, and NaN here.
    #[serde(deserialize_with = "numbers_or_null")]
    pub velocity_m_s: Option<[f64; 3]>,
    /// Roll, pitch and yaw as reported by the drone; likewise.
    #[serde(deserialize_with = "numbers_or_null")]
    pub attitude_deg: Option<[f64; 3]>,
    /// Position by the flight recorder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gps: Option<GpsPosition>,
}

/// JSON has no NaN, and a drone may send one.
fn numbers_or_null<'de, D: Deserializer<'de>>(from: D) -> Result<Option<[f64; 3]>, D::Error> {
    let numbers = Option::<[Option<f64>; 3]>::deserialize(from)?;
    Ok(numbers.map(|numbers| numbers.map(|number| number.unwrap_or(f64::NAN))))
}

/// A position by the drone's flight recorder.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GpsPosition {
    /// North positive.
    pub latitude_deg: f64,
    /// East positive.
    pub longitude_deg: f64,
    /// Above the sea.
    pub elevation_m: f64,
    /// Error expected by the receiver, horizontal.
    pub horizontal_error_m: f64,
    /// Satellites in use.
    pub satellites: u32,
}

impl From<GpsFix> for GpsPosition {
    fn from(fix: GpsFix) -> Self {
        let GpsFix { latitude_deg, longitude_deg, elevation_m, horizontal_error_m, satellites } =
            fix;
        Self { latitude_deg, longitude_deg, elevation_m, horizontal_error_m, satellites }
    }
}

/// All known tags.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tags {
    /// By increasing number.
    pub tags: Vec<Tag>,
}

/// A known tag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tag {
    /// Its number in this flight, from 1.
    pub id: u32,
    /// Metres to the right of the world's origin.
    pub x_m: f64,
    /// Metres forward of it.
    pub y_m: f64,
    /// Direction of its pattern, degrees clockwise, once it is known.
    pub heading_deg: Option<f64>,
    /// Standard deviation of its position on the worse axis.
    pub uncertainty_m: f64,
    /// Whether its position was given, and not found in flight.
    pub surveyed: bool,
    /// Time since it was last seen; `None` if it has not been seen yet.
    pub seen_s: Option<f64>,
}

impl From<&TagStatus> for Tags {
    fn from(status: &TagStatus) -> Self {
        Self { tags: status.known.iter().map(Tag::from).collect() }
    }
}

impl From<&KnownTag> for Tag {
    fn from(tag: &KnownTag) -> Self {
        Self {
            id: tag.id,
            x_m: short(tag.place_m.x),
            y_m: short(tag.place_m.y),
            heading_deg: tag.heading_deg.map(short),
            uncertainty_m: short(tag.uncertainty_m),
            surveyed: tag.surveyed,
            seen_s: tag.seen_ago.map(|ago| short(ago.as_secs_f64())),
        }
    }
}

/// Bytes of a packet or of the control port, in base 64.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bytes {
    /// The bytes.
    pub data: String,
}

impl Tick {
    /// Converts the decision of a tick to its log message.
    pub fn new(decision: &Decision, timing: Timing, datagram: &[u8]) -> Self {
        let Decision { state, percepts, .. } = decision;
        let estimate = |Pose { x_m, y_m, z_m, yaw_deg }| Estimate {
            x_m: short(x_m),
            y_m: short(y_m),
            z_m: short(z_m),
            yaw_deg: short(yaw_deg),
            vx_m_s: short(state.velocity_m_s.x),
            vy_m_s: short(state.velocity_m_s.y),
            vz_m_s: short(state.velocity_m_s.z),
            uncertainty_m: short(percepts.uncertainty_m),
            tag_seen_s: decision
                .tags
                .and_then(|tags| tags.seen_ago)
                .map(|ago| short(ago.as_secs_f64())),
            height_uncertainty_m: short(decision.height_uncertainty_m),
        };
        Self {
            phase: decision.phase.name().to_owned(),
            step: decision.step,
            estimate: percepts.pose.map(estimate),
            target: decision.target.map(|pose| Place::from(&pose)),
            command: Command::new(decision),
            agent: Agent::new(decision),
            veto: decision.veto.map(|veto| veto.name().to_owned()),
            disbelieved: Some(disbelieved(decision)),
            wind_m_s2: Some([decision.wind_m_s2.x, decision.wind_m_s2.y].map(short)),
            timing: Timing { late_ms: short(timing.late_ms), work_ms: short(timing.work_ms) },
            datagram: String::from_utf8_lossy(datagram).into_owned(),
        }
    }
}

/// Quantities that are not sound, and what they are.
fn disbelieved(decision: &Decision) -> BTreeMap<String, String> {
    let worth = Quantity::ALL.into_iter().zip(decision.worth);
    worth
        .filter(|(_, worth)| *worth != Worth::Sound)
        .map(|(quantity, worth)| (quantity.to_string(), worth.name().to_owned()))
        .collect()
}

impl Estimate {
    /// What its horizontal deviation rests on.
    pub fn rests_on(&self) -> RestsOn {
        // What no duration is comes from a forged log.
        let seen_ago = self.tag_seen_s.and_then(|ago| Duration::try_from_secs_f64(ago).ok());
        seen_ago.map_or(RestsOn::Velocity, |seen_ago| RestsOn::Tag { seen_ago })
    }
}

impl From<Estimate> for Place {
    fn from(estimate: Estimate) -> Self {
        let Estimate { x_m, y_m, z_m, yaw_deg, .. } = estimate;
        Self { x_m, y_m, z_m, yaw_deg }
    }
}

impl From<&Pose> for Place {
    fn from(pose: &Pose) -> Self {
        let Pose { x_m, y_m, z_m, yaw_deg } = *pose;
        Self { x_m: short(x_m), y_m: short(y_m), z_m: short(z_m), yaw_deg: short(yaw_deg) }
    }
}

impl Command {
    fn new(decision: &Decision) -> Self {
        let flight = match decision.order.flight {
            FlightOrder::Land => "land",
            FlightOrder::TakeOff => "take off",
            FlightOrder::StayAirborne => "stay",
        };
        let (sticks, hover) = match decision.order.motion {
            Motion::Hover => ([0.0; 4], true),
            Motion::Progressive { roll, pitch, gaz, yaw } => {
                ([roll, pitch, gaz, yaw].map(|stick| short(stick.get().into())), false)
            }
        };
        let [roll, pitch, gaz, yaw] = sticks;
        Self { flight: flight.to_owned(), roll, pitch, gaz, yaw, hover }
    }
}

impl Agent {
    fn new(decision: &Decision) -> Self {
        let Decision { percepts, .. } = decision;
        let plan = |(line, trigger): (u32, &str)| ChosenPlan { trigger: trigger.to_owned(), line };
        Self {
            plans: decision.plans.places().map(plan).collect(),
            command: decision.wanted.name().to_owned(),
            report: decision.report.map(|report| report.name().to_owned()),
            danger: decision.danger.map(|danger| danger.name().to_owned()),
            battery_percent: percepts.battery_percent,
            blind_for_ms: percepts.blind_for_ms,
            wind: short(percepts.wind),
            on_ground: percepts.on_ground,
        }
    }
}

impl From<&Packet<'_>> for DecodedNavdata {
    fn from(navdata: &Packet<'_>) -> Self {
        let demo = navdata.demo();
        let demo = demo.as_ref();
        Self {
            sequence: navdata.sequence,
            state: navdata.state.bits(),
            control_state: demo.map(|demo| demo.control_state.name().to_owned()),
            battery_percent: demo.map(|demo| demo.battery_percent),
            altitude_m: demo.map(|demo| short(demo.altitude_m)),
            velocity_m_s: demo.map(|demo| {
                [demo.velocity_forward_m_s, demo.velocity_right_m_s, demo.velocity_down_m_s]
                    .map(short)
            }),
            attitude_deg: demo.map(|demo| [demo.roll_deg, demo.pitch_deg, demo.yaw_deg].map(short)),
            gps: navdata.gps().and_then(|gps| gps.fix()).map(GpsPosition::from),
        }
    }
}

/// Rounds to four decimals, more than any of these values needs, to keep the file small.
fn short(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
