//! Mutants of agent and C, each of which breaks a property: a proof that accepts one of them is worthless.

use crate::edit::{self, edit};

/// The agent with one mistake, and the property that it breaks; [`RUN_TIME`] stands for a run-time error.
pub(super) type Mutant = edit::Mutant<&'static str>;

/// Sources that are changed.
pub(super) const AGENT: &str = "autopilot/agent/autopilot.asl";
pub(super) const CONFIGURATION: &str = "autopilot/agent/autopilot.conf";
/// The generated C.
pub(super) const C: &str = "autopilot.c";

/// What a mutant breaks that has a run-time error.
pub(super) const RUN_TIME: &str = "run time";

impl Mutant {
    /// The changed text of a source; `None` if the mutant changes another.
    pub(super) fn change(&self, file: &str, text: &str) -> Option<String> {
        self.first.apply(text).ok().filter(|_| file == self.first.file)
    }

    /// Goals whose events probably show the mistake: that of the changed plan, and one to which the property applies.
    pub(super) fn goals(&self, agent: &'static str) -> Vec<&'static str> {
        let end = agent.find(self.first.from).map_or(0, |start| start + self.first.from.len());
        let mut plans = agent[..end].lines().rev();
        let changed = plans.find_map(|line| line.strip_prefix("+!").or(line.strip_prefix("-!")));
        let changed = changed.and_then(|plan| plan.split(|c: char| !c.is_alphanumeric()).next());
        let meant = match self.expected {
            "landing_is_honoured" => "land",
            "take_off_is_not_blind" => "takeOff",
            "a_search_ends" | "a_search_keeps_a_reserve" | "a_search_stays_inside" => "search",
            "settling_above_a_tag_ends" => "overTag",
            "old_setpoints_are_not_flown" => "follow",
            // It watches over the flight.
            _ => "wait",
        };
        let mut goals = vec![changed.unwrap_or(meant), meant];
        goals.dedup();
        goals
    }
}

const fn mutant(
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
    breaks: &'static str,
) -> Mutant {
    Mutant { name, first: edit(file, from, to), more: &[], expected: breaks }
}

const fn agent(
    name: &'static str,
    from: &'static str,
    to: &'static str,
    breaks: &'static str,
) -> Mutant {
    mutant(name, AGENT, from, to, breaks)
}

/// All mutants.
pub(super) const MUTANTS: [Mutant; 76] = [
    agent(
        "a failure plan sends no command",
        "-!wait <- !goDown; !comeDown.",
        "-!wait <- !comeDown.",
        "one_command",
    ),
    agent(
        "a plan sends two commands",
        "+!hold : onGround\n  <- -comingDown;\n     sendStandby;",
        "+!hold : onGround\n  <- sendStandby;\n     sendHover;",
        "one_command",
    ),
    agent(
        "landing waits for the next order",
        "+!goDown\n  <- +comingDown;\n     -target(_, _, _, _);\n     sendLand.",
        "+!goDown\n  <- +comingDown;\n     -target(_, _, _, _);\n     sendHover.",
        "landing_is_honoured",
    ),
    mutant(
        "landing does not pre-empt",
        CONFIGURATION,
        "preemptive {\n  +!land;",
        "preemptive {",
        "landing_is_honoured",
    ),
    agent(
        "landing stops in the air",
        "+!comeDown\n  <- -target(_, _, _, _);\n     sendLand;",
        "+!comeDown\n  <- -target(_, _, _, _);\n     sendHover;",
        "landing_goes_on",
    ),
    agent(
        "the descent ends in holding",
        "+!comeDown : descendingFor(Time) & comingDownTime(Limit) & Time > Limit\n  <- -target(_, _, _, _);\n     sendLand;\n     !comeDown.",
        "+!comeDown : descendingFor(Time) & comingDownTime(Limit) & Time > Limit\n  <- sendStay(0, 0, 1, 0);\n     !!wait.",
        "descending_goes_on",
    ),
    agent(
        "a pause ends the descent",
        "sendPause;\n     !comeDown.",
        "sendPause;\n     !!wait.",
        "descending_goes_on",
    ),
    agent(
        "a hold cancels a landing",
        "+!hold : comingDown\n",
        "+!hold : comingDown & onGround\n",
        "landing_goes_on",
    ),
    agent(
        "steering cancels a landing",
        "+!steer : comingDown\n",
        "+!steer : comingDown & onGround\n",
        "landing_goes_on",
    ),
    agent(
        "a new mission cancels a descent",
        "+!newMission : comingDown\n",
        "+!newMission : comingDown & onGround\n",
        "descending_goes_on",
    ),
    agent(
        "a landing is not remembered",
        "+!goDown\n  <- +comingDown;\n     -target",
        "+!goDown\n  <- -target",
        "landing_goes_on",
    ),
    agent(
        "a new mission is flown at once",
        "+!newMission\n  <- !watch;\n     -target(_, _, _, _);\n     sendHover;",
        "+!newMission\n  <- !watch;\n     -target(_, _, _, _);\n     sendGoto(0, 0, 1, 0);",
        "a_new_mission_waits",
    ),
    agent(
        "a new mission in danger has no failure plan",
        "@danger_between_missions[req(\"SAF-4\"), req(\"SAF-5\")]\n-!newMission <- !goDown; !comeDown.",
        "",
        "nothing_is_lost",
    ),
    agent(
        "holding sends stick commands",
        "+!hold\n  <- !watch;\n     -target(_, _, _, _);\n     sendHover;",
        "+!hold\n  <- !watch;\n     -target(_, _, _, _);\n     sendSticks;",
        "holding_is_honoured",
    ),
    agent(
        "waiting on the ground takes off",
        "+!wait : onGround\n  <- sendStandby;",
        "+!wait : onGround\n  <- sendTakeOff;",
        "take_off_is_ordered",
    ),
    agent(
        "a target on the ground takes off",
        "+!goTo(_, _, _, _) : onGround\n  <- reportRefused;\n     sendStandby;",
        "+!goTo(_, _, _, _) : onGround\n  <- reportRefused;\n     sendTakeOff;",
        "take_off_is_ordered",
    ),
    agent(
        "a take-off with implausible navdata",
        "+!takeOff : onGround & position(_, _, _, _) & blindFor(Time) & holdWhenBlind(Limit) & Time <= Limit",
        "+!takeOff : onGround",
        "take_off_is_not_blind",
    ),
    agent(
        "a take-off after any blindness",
        "holdWhenBlind(300).",
        "holdWhenBlind(2000000000).",
        "take_off_is_not_blind",
    ),
    agent(
        "an empty battery is reported, but the flight continues",
        "tellBatteryEmpty;\n     ?airworthy.",
        "tellBatteryEmpty.",
        "empty_battery_lands",
    ),
    agent(
        "blindness is reported, but the flight continues",
        "tellBlind;\n     ?airworthy.",
        "tellBlind.",
        "blindness_lands",
    ),
    agent(
        "a lost position is reported, but the flight continues",
        "tellLost;\n     ?airworthy.",
        "tellLost.",
        "a_lost_place_lands",
    ),
    agent(
        "strong wind is reported, but the flight continues",
        "tellWind;\n     ?airworthy.",
        "tellWind.",
        "saturation_lands",
    ),
    agent(
        "a failed take-off is reported, but the flight continues",
        "takeOffTime(Limit) & Time > Limit\n  <- tellNoProgress;\n     ?airworthy.",
        "takeOffTime(Limit) & Time > Limit\n  <- tellNoProgress.",
        "a_take_off_ends",
    ),
    agent(
        "an unreachable target is reported, but the flight continues",
        "approachTime(Limit) & Time > Limit\n  <- tellNoProgress;\n     ?airworthy.",
        "approachTime(Limit) & Time > Limit\n  <- tellNoProgress.",
        "an_approach_ends",
    ),
    agent(
        "no plan for an empty battery",
        "@empty_battery[req(\"SAF-4\")]\n+!watch : battery(Percent) & landingBattery(Limit) & Percent <= Limit\n  <- tellBatteryEmpty;\n     ?airworthy.\n",
        "",
        "empty_battery_lands",
    ),
    agent(
        "no plan for blindness",
        "@blind[req(\"SAF-5\")]\n+!watch : blindFor(Time) & landWhenBlind(Limit) & Time > Limit\n  <- tellBlind;\n     ?airworthy.\n",
        "",
        "blindness_lands",
    ),
    agent(
        "no plan for a lost position",
        "@lost[req(\"SAF-5\")]\n+!watch : doubt(Metres) & largestDoubt(Limit) & not Metres <= Limit\n  <- tellLost;\n     ?airworthy.\n",
        "",
        "a_lost_place_lands",
    ),
    agent(
        "no plan for saturated sticks",
        "@too_weak[req(\"SAF-5\")]\n+!watch : saturatedFor(Time) & landWhenSaturated(Limit) & Time > Limit\n  <- tellWind;\n     ?airworthy.\n",
        "",
        "saturation_lands",
    ),
    agent(
        "blindness is accepted for weeks",
        "landWhenBlind(2000).",
        "landWhenBlind(2000000000).",
        "blindness_lands",
    ),
    agent(
        "a position uncertainty of a kilometre is accepted",
        "largestDoubt(3.0).",
        "largestDoubt(1000.0).",
        "a_lost_place_lands",
    ),
    agent(
        "saturation is accepted for weeks",
        "landWhenSaturated(2000).",
        "landWhenSaturated(2000000000).",
        "saturation_lands",
    ),
    agent(
        "the battery is used until it is empty",
        "landingBattery(12).",
        "landingBattery(0).",
        "empty_battery_lands",
    ),
    agent(
        "a take-off may take weeks",
        "takeOffTime(10000).",
        "takeOffTime(2000000000).",
        "a_take_off_ends",
    ),
    agent(
        "an approach may take weeks",
        "approachTime(60000).",
        "approachTime(2000000000).",
        "an_approach_ends",
    ),
    agent(
        "a descent may take weeks",
        "comingDownTime(8000).",
        "comingDownTime(2000000000).",
        "a_descent_ends",
    ),
    agent(
        "each order to land begins a new descent",
        "\n    & descendingFor(Time) & comingDownTime(Limit) & Time <= Limit\n    & position",
        "\n    & position",
        "a_descent_ends",
    ),
    agent(
        "a comparison with a limit is reversed",
        "Time > Limit\n  <- tellBlind",
        "Time < Limit\n  <- tellBlind",
        "blindness_lands",
    ),
    agent(
        "the last percent counts as charge",
        "Percent <= Limit\n  <- tellBatteryEmpty",
        "Percent < Limit\n  <- tellBatteryEmpty",
        "empty_battery_lands",
    ),
    agent(
        "in danger an approach waits",
        "-!approach <- !goDown; !comeDown.",
        "-!approach <- sendHover; !!wait.",
        "blindness_lands",
    ),
    agent(
        "holding ignores dangers",
        "+!hold : position(X, Y, Z, Yaw)\n  <- !watch;",
        "+!hold : position(X, Y, Z, Yaw)\n  <-",
        "blindness_lands",
    ),
    agent(
        "repeated holding prevents the descent",
        "-!hold <- !goDown; !comeDown.",
        "-!hold <- sendHover; !land.",
        "a_lost_place_lands",
    ),
    agent(
        "repeated steering prevents the descent",
        "-!steer <- !goDown; !comeDown.",
        "-!steer <- sendHover; !land.",
        "saturation_lands",
    ),
    agent(
        "a completed take-off ignores dangers",
        "hovering & position(X, Y, Z, Yaw)\n  <- !watch;",
        "hovering & position(X, Y, Z, Yaw)\n  <-",
        "empty_battery_lands",
    ),
    agent(
        "taking over ignores dangers",
        "+!takeOff : position(X, Y, Z, Yaw)\n  <- !watch;",
        "+!takeOff : position(X, Y, Z, Yaw)\n  <-",
        "empty_battery_lands",
    ),
    agent(
        "a blind descent waits with an empty battery",
        "<- !watch;\n     sendPause;\n     !comeDown.",
        "<- sendPause;\n     !comeDown.",
        "empty_battery_lands",
    ),
    agent(
        "a plan adds the belief airworthy",
        "<- +batteryWarned;",
        "<- +airworthy;\n     +batteryWarned;",
        "empty_battery_lands",
    ),
    agent(
        "an end is reported twice",
        "+!comeDown : onGround\n  <- -comingDown;\n     sendStandby;\n     reportDone;",
        "+!comeDown : onGround\n  <- -comingDown;\n     sendStandby;\n     reportDone;\n     reportFailed;",
        "one_report",
    ),
    agent(
        "steering in danger has no failure plan",
        "@danger_steering[req(\"SAF-4\"), req(\"SAF-5\")]\n-!steer <- !goDown; !comeDown.",
        "",
        "nothing_is_lost",
    ),
    agent(
        "taking over in danger has no failure plan",
        "@danger_taking_over[req(\"SAF-4\"), req(\"SAF-5\")]\n-!takeOff <- !goDown; !comeDown.",
        "",
        "nothing_is_lost",
    ),
    agent(
        "a search may take weeks",
        "searchTime(30000).",
        "searchTime(2000000000).",
        "a_search_ends",
    ),
    agent(
        "a search does not look at the time",
        "+!search(Then) : searchingFor(Time) & searchTime(Limit) & Time > Limit\n    | battery",
        "+!search(Then) : battery",
        "a_search_ends",
    ),
    agent(
        "a search takes the reserve of charge",
        "searchBattery(20).",
        "searchBattery(13).",
        "a_search_keeps_a_reserve",
    ),
    agent(
        "a search begins with any charge",
        "    | battery(Percent) & searchBattery(Least) & Percent <= Least\n    | fenceRoom(Room) & not Room >= 0.0\n  <- sendHover.",
        "    | fenceRoom(Room) & not Room >= 0.0\n  <- sendHover.",
        "a_search_keeps_a_reserve",
    ),
    agent(
        "a search goes on outside the fence",
        "    | fenceRoom(Room) & not Room >= 0.0\n  <- !watch;",
        "  <- !watch;",
        "a_search_stays_inside",
    ),
    agent(
        "a search begins outside the fence",
        "    | fenceRoom(Room) & not Room >= 0.0\n  <- sendHover.",
        "  <- sendHover.",
        "a_search_stays_inside",
    ),
    agent(
        "a tag that is lost is waited for",
        "  <- tellTagLost;\n     reportFailed;\n     !goDown;\n     !comeDown.",
        "  <- tellTagLost;\n     reportFailed;\n     sendHover;\n     !!wait.",
        "a_landing_on_a_tag_goes_on",
    ),
    agent(
        "above a tag in danger it hovers",
        "-!overTag <- !goDown; !comeDown.",
        "-!overTag <- sendHover; !!wait.",
        "a_landing_on_a_tag_goes_on",
    ),
    agent(
        "settling above a tag may take weeks",
        "overTagTime(20000).",
        "overTagTime(2000000000).",
        "settling_above_a_tag_ends",
    ),
    agent(
        "a descent onto a tag climbs again when the tag is lost",
        "+!ontoTag : not tagKnown\n  <- -target(_, _, _, _);\n     tellTagLost;\n     reportFailed;\n     sendLand;\n     !comeDown.",
        "+!ontoTag : not tagKnown\n  <- -target(_, _, _, _);\n     tellTagLost;\n     reportFailed;\n     sendHover;\n     !!wait.",
        "descending_goes_on",
    ),
    agent(
        "a descent onto a tag is not remembered",
        "  <- +comingDown;\n     +target(X, Y, Z, Yaw);\n     sendDescent(X, Y, Z, Yaw);",
        "  <- +target(X, Y, Z, Yaw);\n     sendDescent(X, Y, Z, Yaw);",
        "descending_goes_on",
    ),
    agent(
        "a descent onto a tag may take weeks",
        "@too_long_onto_tag[req(\"SAF-2\"), req(\"SAF-7\")]\n+!ontoTag : descendingFor(Time) & comingDownTime(Limit) & Time > Limit\n  <- -target(_, _, _, _);\n     sendLand;\n     !comeDown.\n",
        "",
        "a_descent_ends",
    ),
    agent(
        "each landing on a tag begins a new descent",
        "\n    & descendingFor(Time) & comingDownTime(Limit) & Time <= Limit & X = landingX",
        "\n    & X = landingX",
        "a_descent_ends",
    ),
    agent(
        "setpoints may be a week old",
        "holdWithoutSetpoints(500).",
        "holdWithoutSetpoints(600000000).",
        "old_setpoints_are_not_flown",
    ),
    agent(
        "new setpoints are followed without an order",
        "| stationSilentFor(Silent) & holdWithoutStation(Longest) & Silent > Longest\n  <- !watch;\n     !holdHere;\n     reportPaused;\n     !!wait.",
        "| stationSilentFor(Silent) & holdWithoutStation(Longest) & Silent > Longest\n  <- !watch;\n     !holdHere;\n     reportPaused;\n     !follow.",
        "following_is_ordered",
    ),
    agent(
        "without setpoints the drone holds for weeks",
        "landWithoutSetpoints(10500).",
        "landWithoutSetpoints(2000000000).",
        "gone_setpoints_land",
    ),
    agent(
        "gone setpoints are reported, but the flight continues",
        "tellSetpointsGone;\n     ?airworthy.",
        "tellSetpointsGone.",
        "gone_setpoints_land",
    ),
    agent(
        "setpoints cancel a landing",
        "+!follow : comingDown\n",
        "+!follow : comingDown & onGround\n",
        "landing_goes_on",
    ),
    agent(
        "following in danger has no failure plan",
        "@danger_following[req(\"SAF-4\"), req(\"SAF-5\"), req(\"SAF-9\")]\n-!follow <- !goDown; !comeDown.",
        "",
        "nothing_is_lost",
    ),
    agent(
        "a mission is flown on for a silent station",
        "+!approach : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit\n",
        "+!approach : stationSilentFor(Time) & landWithoutStation(Limit) & Time > Limit\n",
        "a_silent_station_stops",
    ),
    agent(
        "setpoints are followed for a silent station",
        "    | stationSilentFor(Silent) & holdWithoutStation(Longest) & Silent > Longest\n",
        "",
        "a_silent_station_stops",
    ),
    agent(
        "a silent station's sticks count",
        "+!steer : stationSilentFor(Time) & holdWithoutStation(Limit) & Time > Limit\n",
        "+!steer : stationSilentFor(Time) & holdWithoutStation(Limit) & Time < Limit\n",
        "a_silent_station_stops",
    ),
    agent(
        "a lost station is reported, but the flight continues",
        "tellStationGone;\n     ?airworthy.",
        "tellStationGone.",
        "a_lost_station_lands",
    ),
    agent(
        "a mission goes on after a search for a silent station",
        "\n    & stationSilentFor(Time) & holdWithoutStation(Limit) & Time <= Limit\n",
        "\n",
        "a_silent_station_stops",
    ),
    mutant(
        "the C forgets a landing order",
        C,
        "self->preemptive_achieve_land_pending = true;",
        "self->preemptive_achieve_land_pending = false;",
        "landing_is_honoured",
    ),
    mutant(
        "the C writes outside the inbox",
        C,
        "const uint32_t slot = 0U;\n        self->inbox_queue[slot] = AUTOPILOT_EVENT_INBOX_achieve_takeOff",
        "const uint32_t slot = 1U;\n        self->inbox_queue[slot] = AUTOPILOT_EVENT_INBOX_achieve_takeOff",
        RUN_TIME,
    ),
    mutant(
        "the C keeps an old event",
        C,
        "event = self->posted;\n        self->posted = AUTOPILOT_EVENT_NONE;",
        "event = AUTOPILOT_EVENT_NONE;",
        "one_command",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::AUTOPILOT;

    #[test]
    fn a_mistake_is_looked_for_where_it_is() {
        let goals = |name: &str| {
            let mutant = MUTANTS.iter().find(|mutant| mutant.name == name).unwrap();
            mutant.goals(AUTOPILOT.text)
        };
        assert_eq!(goals("a hold cancels a landing"), ["hold", "wait"]);
        assert_eq!(goals("above a tag in danger it hovers"), ["overTag", "wait"]);
        assert_eq!(goals("blindness is accepted for weeks"), ["wait"]);
        assert_eq!(goals("a search may take weeks"), ["search"]);
        assert_eq!(goals("the C forgets a landing order"), ["land"]);
    }

    /// The proof would go on with the agent as it is, and say that the mutant is not caught.
    #[test]
    fn each_mutant_can_be_made() {
        let parsed = translator::parse_configuration(AUTOPILOT.name, AUTOPILOT.configuration);
        let c = translator::obligations(&parsed.unwrap(), AUTOPILOT.text).unwrap();
        for mutant in &MUTANTS {
            let text = match mutant.first.file {
                AGENT => AUTOPILOT.text,
                CONFIGURATION => AUTOPILOT.configuration,
                _ => &c.files[0].text,
            };
            assert!(mutant.first.apply(text).is_ok_and(|changed| changed != text), "{mutant:?}");
        }
    }
}
