//! What the drone sends of itself.

use std::collections::BTreeSet;
use std::time::Duration;

use super::contact::{Arrived, Contact, Examiner, Meanwhile, Window};
use super::report::{Assumption, Findings, Outcome};
use crate::at::Config;
use crate::configuration::Configuration;
use crate::navdata::{ControlState, Demo, NavdataOption, Packet, PhysicalMeasures};

/// How long packets are counted.
const COUNTED: Duration = Duration::from_secs(2);
const DEMO_HZ: std::ops::RangeInclusive<f64> = 12.0..=18.0;
const FULL_HZ: std::ops::RangeInclusive<f64> = 120.0..=240.0;
/// Tag 27 is the flight recorder's, and later ones come with newer firmware.
const ALL_TAGS: std::ops::RangeInclusive<u16> = 0..=26;
const GRAVITY_M_S2: f64 = 9.81;
/// A full battery has 12.5 V, one that ends the flight 9 V; between them a battery has this charge within 30 %.
const VOLTS: std::ops::RangeInclusive<f64> = 9.0..=13.0;
const CHARGE_APART_PERCENT: f64 = 30.0;
/// After a change of mode, before packets are counted.
const SETTLING: Duration = Duration::from_millis(300);

/// Whether the packets are whole, and counted upwards.
fn form(window: &Window, report: &mut Findings<'_>) {
    let damaged = window.damaged.first().map(|error| {
        format!(
            "{} of {} packets: {error}",
            window.damaged.len(),
            window.damaged.len() + window.packets.len()
        )
    });
    let wrong = damaged.into_iter().collect();
    report.judge_all(Assumption::Intact, wrong, format!("{} packets", window.packets.len()));
    let numbers: Vec<u32> =
        window.packets.iter().filter_map(Arrived::packet).map(|packet| packet.sequence).collect();
    let back = numbers.windows(2).find(|pair| matches!(pair, [first, second] if second <= first));
    let wrong = back.map(|pair| format!("{pair:?} follow each other"));
    report.judge_all(
        Assumption::Counted,
        wrong.into_iter().collect(),
        format!("{} numbers", numbers.len()),
    );
}

fn rate(
    window: &Window,
    assumption: Assumption,
    expected: &std::ops::RangeInclusive<f64>,
    report: &mut Findings<'_>,
) {
    let rate_hz = window.rate_hz();
    report.judge(assumption, expected.contains(&rate_hz), format!("{rate_hz:.1} packets a second"));
}

pub(super) fn demo(drone: &mut Examiner<'_, impl Contact>, report: &mut Findings<'_>) {
    drone.listen(SETTLING, Meanwhile::Present);
    let window = drone.listen(COUNTED, Meanwhile::Present);
    form(&window, report);
    rate(&window, Assumption::DemoRate, &DEMO_HZ, report);
    let packets: Vec<Packet<'_>> = window.packets.iter().filter_map(Arrived::packet).collect();
    let without = packets.iter().filter(|packet| packet.demo().is_none()).count();
    let seen = format!("{} of {} packets have it", packets.len() - without, packets.len());
    report.judge(Assumption::DemoOption, without == 0 && !packets.is_empty(), seen);
}

/// Options of these tags that are absent, or have an unknown size, in the last packet with options.
fn wrong_options(window: &Window, tags: impl Iterator<Item = u16>) -> Vec<String> {
    let packet = window
        .packets
        .iter()
        .rev()
        .filter_map(Arrived::packet)
        .find(|packet| packet.demo().is_some());
    let Some(packet) = packet else { return vec!["no packet has options".to_owned()] };
    let (mut known, mut unknown) = (BTreeSet::new(), Vec::new());
    for option in packet.options() {
        match option {
            NavdataOption::Unknown { tag, payload } => unknown.push((tag, payload.len() + 4)),
            _ => _ = known.insert(option.tag()),
        }
    }
    tags.filter(|tag| !known.contains(tag))
        .map(|tag| match unknown.iter().find(|(found, _)| *found == tag) {
            Some((_, bytes)) => {
                format!("option {tag} has {bytes} bytes, which is no size that we know")
            }
            None => format!("option {tag} is not sent"),
        })
        .collect()
}

/// Whether the options come that a flight asks for.
pub(super) fn requested(
    drone: &mut Examiner<'_, impl Contact>,
    settings: &[Config],
    before: Option<&Configuration>,
    report: &mut Findings<'_>,
) {
    let setting = settings.iter().find(|setting| setting.key() == "general:navdata_options");
    let mask = setting.and_then(|setting| setting.value().parse::<u32>().ok());
    // Without a configuration they could not be set back.
    let (Some(setting), Some(mask), Some(_)) = (setting, mask, before) else {
        let why = "no options are asked for, or they could not be set back".to_owned();
        return report.add(Assumption::RequestedOptions, Outcome::NotAsked(why));
    };
    // With the other settings already, unless these were not asked.
    drone.set(setting);
    let window = drone.listen(SETTLING + SETTLING, Meanwhile::Present);
    // Without a flight recorder there is nothing in its option.
    let tags: Vec<u16> = ALL_TAGS.filter(|tag| mask >> tag & 1 == 1).collect();
    let wrong = wrong_options(&window, tags.iter().copied());
    report.judge_all(Assumption::RequestedOptions, wrong, format!("options {tags:?}"));
}

pub(super) fn full(drone: &mut Examiner<'_, impl Contact>, report: &mut Findings<'_>) {
    drone.set_text("general:navdata_demo", "FALSE");
    drone.listen(SETTLING, Meanwhile::Present);
    let window = drone.listen(COUNTED, Meanwhile::Present);
    rate(&window, Assumption::FullRate, &FULL_HZ, report);
    let wrong = wrong_options(&window, ALL_TAGS);
    report.judge_all(Assumption::AllOptions, wrong, "27 options".to_owned());
    clock(&window, report);
    match window
        .packets
        .iter()
        .rev()
        .filter_map(Arrived::packet)
        .find_map(|packet| Some((packet.demo()?, packet)))
    {
        Some((demo, packet)) => {
            at_rest(&demo, report);
            charge(&demo, &packet, report);
            inertial(&demo, &packet, report);
        }
        None => {
            for assumption in
                [Assumption::AtRest, Assumption::Charge, Assumption::Gravity, Assumption::Attitude]
            {
                report.add(
                    assumption,
                    Outcome::NotAsked("no packet has attitude and charge".to_owned()),
                );
            }
        }
    }
    drone.set_text("general:navdata_demo", "TRUE");
}

fn clock(window: &Window, report: &mut Findings<'_>) {
    let timed = |came: &Arrived| Some((came.at, came.packet()?.time()?.since_start));
    let times: Vec<_> = window.packets.iter().filter_map(timed).collect();
    let (Some((here, there)), Some((here_later, there_later))) = (times.first(), times.last())
    else {
        let why = "no packet has the drone's time".to_owned();
        return report.add(Assumption::Clock, Outcome::NotAsked(why));
    };
    let ours = here_later.saturating_sub(*here).as_secs_f64();
    // It wraps after 2048 s.
    let theirs = (there_later.as_secs_f64() - there.as_secs_f64()).rem_euclid(2048.0);
    let ratio = if ours > 0.0 { theirs / ours } else { f64::NAN };
    let seen = format!("{theirs:.3} s there, {ours:.3} s here");
    report.judge(Assumption::Clock, (ratio - 1.0).abs() <= 0.02, seen);
}

fn at_rest(demo: &Demo, report: &mut Findings<'_>) {
    let Demo { velocity_forward_m_s, velocity_right_m_s, altitude_m, control_state, .. } = *demo;
    let speed_m_s = velocity_forward_m_s.hypot(velocity_right_m_s);
    let seen = format!("{}, {speed_m_s:.2} m/s, {altitude_m:.2} m", control_state.name());
    // What is no number is not below anything.
    let is_at_rest =
        control_state == ControlState::Landed && speed_m_s < 0.2 && altitude_m.abs() < 0.5;
    report.judge(Assumption::AtRest, is_at_rest, seen);
}

fn charge(demo: &Demo, packet: &Packet<'_>, report: &mut Findings<'_>) {
    let percent = demo.battery_percent;
    let Some(millivolts) = packet.battery_mv() else {
        let why = "no packet has the battery's voltage".to_owned();
        return report.add(Assumption::Charge, Outcome::NotAsked(why));
    };
    let volts = f64::from(millivolts) / 1e3;
    let by_voltage = (volts - VOLTS.start()) / (12.5 - VOLTS.start()) * 100.0;
    let fits = percent <= 100
        && VOLTS.contains(&volts)
        && (f64::from(percent) - by_voltage).abs() <= CHARGE_APART_PERCENT;
    report.judge(Assumption::Charge, fits, format!("{percent} %, {volts:.2} V"));
}

fn inertial(demo: &Demo, packet: &Packet<'_>, report: &mut Findings<'_>) {
    let measured = packet.options().find_map(|option| match option {
        NavdataOption::PhysicalMeasures(PhysicalMeasures { acceleration_m_s2, .. }) => {
            Some(acceleration_m_s2)
        }
        _ => None,
    });
    let Some([forward, right, down]) = measured else {
        for assumption in [Assumption::Gravity, Assumption::Attitude] {
            report
                .add(assumption, Outcome::NotAsked("no packet has the accelerometers".to_owned()));
        }
        return;
    };
    let strength = (forward * forward + right * right + down * down).sqrt();
    let seen = format!("{forward:.2} forward, {right:.2} right, {down:.2} m/s² down");
    report.judge(Assumption::Gravity, (strength - GRAVITY_M_S2).abs() <= 1.0 && down < 0.0, seen);
    // At rest the reaction to gravity points up: with the nose up it has a part forward, with the right side down one to the left.
    let pitch_deg = forward.atan2(-down).to_degrees();
    let roll_deg = (-right).atan2(-down).to_degrees();
    let agrees =
        (demo.pitch_deg - pitch_deg).abs() <= 5.0 && (demo.roll_deg - roll_deg).abs() <= 5.0;
    let seen = format!(
        "pitch {:.1}° and roll {:.1}° told, {pitch_deg:.1}° and {roll_deg:.1}° by the accelerometers",
        demo.pitch_deg, demo.roll_deg
    );
    report.judge(Assumption::Attitude, agrees, seen);
}
