//! Tests of the whole system: the pilot, its agent, and a simulated drone.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::disallowed_methods, reason = "these tests run real processes in real time")]

mod allocation;
mod animation;
mod architecture;
mod browser;
mod chromium;
mod circles;
mod client;
mod command_line;
mod conversation;
mod cross_checks;
mod dependencies;
mod documentation;
mod estimate;
mod faults;
mod fleet;
mod fleet_air;
mod fleet_faults;
mod fleet_program;
mod ground_station;
mod keyboard;
mod mavlink;
mod mission_agents;
mod operator;
mod parting;
mod pictures;
mod planner;
mod plans;
mod polygon;
mod ports;
mod processes;
mod recording;
mod relay;
mod reports;

mod safety;
mod selftest;
mod sensors;
mod sequence;
mod setpoints;
mod side_by_side;
mod simulated;
mod starts_by_tags;
mod station;
mod streams;
mod tag_log;
mod tag_plans;
mod tags;
mod udp;
mod vehicle;
mod video;
mod video_faults;
mod video_rate;
