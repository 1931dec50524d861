//! Agents and C that break a promise: a proof that accepts one of them proves nothing.

/// Where something is changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// In the AgentSpeak.
    Agent,
    /// In its configuration.
    Configuration,
    /// In the generated C.
    C,
}

/// A change, and the property that it breaks; `run time` stands for an error at run time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mutant {
    /// What is wrong with it.
    pub(super) name: &'static str,
    /// Where it is changed.
    pub(super) place: Place,
    from: &'static str,
    to: &'static str,
    /// What must be found.
    pub(super) breaks: &'static str,
}

/// What a mutant breaks that has an error at run time.
pub(super) const RUN_TIME: &str = "run time";

impl Mutant {
    /// Changes the first such text; nothing if there is none, or the mutant is about another place.
    pub(super) fn apply(&self, place: Place, text: &str) -> Option<String> {
        (place == self.place && text.contains(self.from))
            .then(|| text.replacen(self.from, self.to, 1))
    }
}

const fn agent(
    name: &'static str,
    from: &'static str,
    to: &'static str,
    breaks: &'static str,
) -> Mutant {
    Mutant { name, place: Place::Agent, from, to, breaks }
}

const fn c(
    name: &'static str,
    from: &'static str,
    to: &'static str,
    breaks: &'static str,
) -> Mutant {
    Mutant { name, place: Place::C, from, to, breaks }
}

/// All of them.
pub(super) const MUTANTS: [Mutant; 25] = [
    agent(
        "a failure plan says nothing",
        "-!wait <- sendHover; !land.",
        "-!wait <- !land.",
        "one_command",
    ),
    agent(
        "a plan says two things",
        "+!hold : onGround\n  <- sendStandby;",
        "+!hold : onGround\n  <- sendStandby;\n     sendHover;",
        "one_command",
    ),
    agent(
        "landing waits for the next order",
        "+!land\n  <- -target(_, _, _, _);\n     sendLand;",
        "+!land\n  <- -target(_, _, _, _);\n     sendHover;",
        "landing_is_honoured",
    ),
    Mutant {
        name: "landing does not pre-empt",
        place: Place::Configuration,
        from: "preemptive {\n  +!land;",
        to: "preemptive {",
        breaks: "landing_is_honoured",
    },
    agent(
        "landing stops in the air",
        "+!completeLand\n  <- sendLand;",
        "+!completeLand\n  <- sendHover;",
        "landing_goes_on",
    ),
    agent(
        "the descent ends in holding",
        "+!descend(Start) : comingDownTime(Limit) & longEnough(Start, Limit)\n  <- -target(_, _, _, _);\n     sendLand;\n     !completeLand.",
        "+!descend(Start) : comingDownTime(Limit) & longEnough(Start, Limit)\n  <- sendGoto(0, 0, 1, 0);\n     !!wait.",
        "descending_goes_on",
    ),
    agent(
        "holding is done by hand",
        "+!hold\n  <- -target(_, _, _, _);\n     sendHover;",
        "+!hold\n  <- -target(_, _, _, _);\n     sendSticks;",
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
        "an empty battery is told and flown on",
        "tellBatteryEmpty;\n     ?airworthy.",
        "tellBatteryEmpty.",
        "empty_battery_lands",
    ),
    agent(
        "blindness is told and flown on",
        "tellBlind;\n     ?airworthy.",
        "tellBlind.",
        "blindness_lands",
    ),
    agent(
        "a lost place is told and flown on",
        "tellLost;\n     ?airworthy.",
        "tellLost.",
        "a_lost_place_lands",
    ),
    agent(
        "strong wind is told and flown on",
        "tellWind;\n     ?airworthy.",
        "tellWind.",
        "strong_wind_lands",
    ),
    agent(
        "in danger an approach waits",
        "-!approach(_) <- sendHover; !land.",
        "-!approach(_) <- sendHover; !!wait.",
        "blindness_lands",
    ),
    agent(
        "somebody believes in airworthiness",
        "<- +batteryWarned;",
        "<- +airworthy;\n     +batteryWarned;",
        "empty_battery_lands",
    ),
    agent(
        "an end is told twice",
        "+!completeLand : onGround\n  <- sendStandby;\n     reportDone;",
        "+!completeLand : onGround\n  <- sendStandby;\n     reportDone;\n     reportFailed;",
        "one_report",
    ),
    agent(
        "steering in danger has no way out",
        "@danger_steering[req(\"SAF-4\"), req(\"SAF-5\")]\n-!steer <- sendHover; !land.",
        "",
        "nothing_is_lost",
    ),
    agent(
        "taking over in danger has no way out",
        "@danger_taking_over[req(\"SAF-4\"), req(\"SAF-5\")]\n-!takeOff <- sendHover; !land.",
        "",
        "nothing_is_lost",
    ),
    agent(
        "the last percent counts as charge",
        "Percent <= Limit\n  <- tellBatteryEmpty",
        "Percent < Limit\n  <- tellBatteryEmpty",
        "low_battery_lands",
    ),
    agent(
        "a take-off that is complete looks at nothing",
        "hovering & position(X, Y, Z, Yaw)\n  <- !watch;",
        "hovering & position(X, Y, Z, Yaw)\n  <-",
        "low_battery_lands",
    ),
    agent(
        "taking over looks at nothing",
        "+!takeOff : position(X, Y, Z, Yaw)\n  <- !watch;",
        "+!takeOff : position(X, Y, Z, Yaw)\n  <-",
        "low_battery_lands",
    ),
    agent(
        "a blind descent waits with an empty battery",
        "\n    & not (battery(Percent) & landingBattery(Least) & Percent <= Least)",
        "",
        "low_battery_lands",
    ),
    c(
        "the C forgets a landing order",
        "self->preemptive_achieve_land_pending = true;",
        "self->preemptive_achieve_land_pending = false;",
        "landing_is_honoured",
    ),
    c(
        "the C writes beside the inbox",
        "const uint32_t slot = 0U;\n        self->inbox_queue[slot]",
        "const uint32_t slot = 1U;\n        self->inbox_queue[slot]",
        RUN_TIME,
    ),
    c(
        "the C keeps an old event",
        "event = self->posted;\n        self->posted = AUTOPILOT_EVENT_NONE;",
        "event = AUTOPILOT_EVENT_NONE;",
        "one_command",
    ),
];
