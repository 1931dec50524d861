//! Topics of a flight log and their schemas.

/// A topic and its schema.
#[derive(Debug, Clone, Copy)]
pub(super) struct Topic {
    pub(super) name: &'static str,
    pub(super) schema: &'static str,
    /// The JSON schema.
    pub(super) text: &'static str,
}

pub(super) const TICK: Topic =
    Topic { name: "/tick", schema: "ardrone_pilot.Tick", text: include_str!("schemas/tick.json") };
pub(super) const NAVDATA: Topic = Topic {
    name: "/navdata",
    schema: "ardrone_pilot.Navdata",
    text: include_str!("schemas/navdata.json"),
};
pub(super) const RAW_NAVDATA: Topic = Topic {
    name: "/navdata/raw",
    schema: "ardrone_pilot.Bytes",
    text: include_str!("schemas/bytes.json"),
};
pub(super) const CONTROL: Topic = Topic { name: "/control/raw", ..RAW_NAVDATA };
pub(super) const ORDERS: Topic = Topic {
    name: "/orders",
    schema: "ardrone_pilot.Order",
    text: include_str!("schemas/order.json"),
};
pub(super) const NEIGHBOURS: Topic = Topic {
    name: "/neighbours",
    schema: "ardrone_pilot.Neighbour",
    text: include_str!("schemas/neighbour.json"),
};
pub(super) const MESSAGES: Topic = Topic {
    name: "/messages",
    schema: "ardrone_pilot.AgentMessage",
    text: include_str!("schemas/agent_message.json"),
};
pub(super) const MISSION: Topic = Topic {
    name: "/mission",
    schema: "ardrone_pilot.Mission",
    text: include_str!("schemas/mission.json"),
};
pub(super) const PROGRESS: Topic = Topic {
    name: "/progress",
    schema: "ardrone_pilot.Progress",
    text: include_str!("schemas/progress.json"),
};
/// Foxglove's log schema, displayed as log lines.
pub(super) const LOG: Topic =
    Topic { name: "/log", schema: "foxglove.Log", text: include_str!("schemas/log.json") };
/// Foxglove's pose schema, displayed in 3D.
pub(super) const POSE: Topic = Topic {
    name: "/pose",
    schema: "foxglove.PoseInFrame",
    text: include_str!("schemas/pose.json"),
};
pub(super) const TARGET: Topic = Topic { name: "/target", ..POSE };

pub(super) const TAGS: Topic =
    Topic { name: "/tags", schema: "ardrone_pilot.Tags", text: include_str!("schemas/tags.json") };

/// Pictures of the drone's camera: protobuf, unlike the others.
pub(super) const VIDEO: &str = "/video";

pub(super) const ALL: [Topic; 13] = [
    TICK,
    NAVDATA,
    RAW_NAVDATA,
    CONTROL,
    ORDERS,
    NEIGHBOURS,
    MESSAGES,
    MISSION,
    PROGRESS,
    LOG,
    POSE,
    TARGET,
    TAGS,
];
