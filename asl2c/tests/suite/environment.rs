//! `asl2c validate --c` believes nothing of the environment that the guide does not property: any setter may be called at
//! any time, any number of times; memory holds anything before `init()`; queries come in any order.

use std::time::Duration;

use asl2c::{Cbmc, Validated, validate};
use judged_c::judge;
use translator::{comparison, parse_configuration};

use crate::harness::{cbmc, skip};

const AGENT: &str = include_str!("../../../translator/agents/infusion.asl");
const CONFIGURATION: &str = include_str!("../../../translator/agents/infusion.conf");
const TIME: Duration = Duration::from_mins(5);

/// C that somebody made: what for, and pairs of old and new text.
type Edit = (&'static str, &'static [(&'static str, &'static str)]);

const STATE: &str = "static agent_t agent;\n";
const UPDATE: &str = "    updateBeliefs();\n";
const SET_AIR: &str = "void set_air(int32_t argument1)\n{\n";
const SET_PRESSURE: &str = "void set_pressure(int32_t argument1)\n{\n";
const CAN_ADD: &str = "bool can_add_event(void)\n{\n";
const UNHANDLED: &str = "    return agent.unhandled;\n";
const REFUSED: &str = "    return agent.refused;\n";

/// Each does something else in an environment that may be, and what differs.
#[rustfmt::skip]
const WRONG: &[(Edit, &str)] = &[
    (("a setter is called twice in a step", &[
        (STATE, "static agent_t agent;\nstatic uint32_t sets = 0U;\n"),
        (SET_AIR, "void set_air(int32_t argument1)\n{\n    if (sets < 5U)\n    {\n        sets = sets + 1U;\n    }\n"),
        (UPDATE, "    sets = 0U;\n    updateBeliefs();\n    if (sets >= 2U)\n    {\n        runMotor();\n    }\n"),
    ]), "another call, or none"),
    (("setters are called in another order", &[
        (STATE, "static agent_t agent;\nstatic bool first = false;\nstatic bool bad = false;\n"),
        (SET_PRESSURE, "void set_pressure(int32_t argument1)\n{\n    first = true;\n"),
        (SET_AIR, "void set_air(int32_t argument1)\n{\n    bad = first;\n"),
        (UPDATE, "    first = false;\n    bad = false;\n    updateBeliefs();\n    if (bad)\n    {\n        runMotor();\n    }\n"),
    ]), "another call, or none"),
    (("the order is kept where no value of the state is", &[
        (SET_PRESSURE, "void set_pressure(int32_t argument1)\n{\n    if (agent.posted != EVENT_POSTED_achieve_muted)\n    {\n        agent.posted_achieve_muted_1 = 77U;\n    }\n"),
    ]), "set_pressure changes more than its belief"),
    (("the order is kept in a slot that is empty", &[
        (SET_PRESSURE, "void set_pressure(int32_t argument1)\n{\n    if (agent.inbox_count == 0U)\n    {\n        agent.inbox_queue[0U] = EVENT_INBOX_achieve_silence;\n    }\n"),
    ]), "set_pressure changes more than its belief"),
    (("a value is that of long ago", &[
        (UPDATE, "    if (agent.belief_air_held && (agent.belief_air_1 == 77))\n    {\n        runMotor();\n    }\n    updateBeliefs();\n"),
    ]), "another call, or none"),
    (("a value is another one after the beliefs are set", &[
        (UPDATE, "    const int32_t was = agent.belief_air_1;\n    updateBeliefs();\n    if (was != agent.belief_air_1)\n    {\n        runMotor();\n    }\n"),
    ]), "another call, or none"),
    (("a belief is held after the beliefs are set", &[
        (UPDATE, "    const bool was = agent.belief_air_held;\n    updateBeliefs();\n    if (agent.belief_air_held && (!was))\n    {\n        runMotor();\n    }\n"),
    ]), "another call, or none"),
    (("what was pending stays", &[
        ("void clear(void)\n{\n    forget_events();\n", "void clear(void)\n{\n    if (agent.unhandled != 3U)\n    {\n        forget_events();\n    }\n"),
    ]), "another state: the posted event"),
    (("an event seems to be taken", &[
        ("        /* The counter saturates. */\n    }\n    return accepted;\n", "        /* The counter saturates. */\n    }\n    return accepted || (agent.refused == 9U);\n"),
    ]), "another result of achieve_start"),
    (("a setter is called before the C is ready for it", &[
        (UPDATE, "    const uint32_t was = agent.aborted;\n    agent.aborted = 7U;\n    updateBeliefs();\n    agent.aborted = was;\n"),
    ]), "another state before updateBeliefs"),
    (("a query must come before another one", &[
        (STATE, "static agent_t agent;\nstatic bool peeked = false;\n"),
        (CAN_ADD, "bool can_add_event(void)\n{\n    peeked = true;\n"),
        (UNHANDLED, "    uint32_t result = agent.unhandled;\n\n    if (!peeked)\n    {\n        result = 0U;\n    }\n    return result;\n"),
    ]), "another result of unhandled_events"),
    (("queries must come in turn", &[
        (STATE, "static agent_t agent;\nstatic uint32_t turn = 0U;\n"),
        (UNHANDLED, "    turn = 1U;\n    return agent.unhandled;\n"),
        (REFUSED, "    uint32_t result = agent.refused;\n\n    if (turn != 1U)\n    {\n        result = 7U;\n    }\n    return result;\n"),
    ]), "another result of refused_events"),
];

/// The same for an agent whose state is passed in: there may be several.
#[rustfmt::skip]
const WRONG_IN_CONTEXT: &[(Edit, &str)] = &[
    (("memory that is not zero, an index", &[
        ("    self->environment = environment;\n", "    const bool garbage = self->inbox_first >= 1U;\n    self->environment = environment;\n"),
        ("    forget_events(self);\n}\n\nvoid infusion_clear", "    forget_events(self);\n    if (garbage)\n    {\n        self->belief_air_held = true;\n    }\n}\n\nvoid infusion_clear"),
    ]), "another state: belief air"),
    (("memory that is not zero, a number", &[
        ("    self->environment = environment;\n", "    const bool garbage = self->inbox_count >= 2U;\n    self->environment = environment;\n"),
        ("    forget_events(self);\n}\n\nvoid infusion_clear", "    forget_events(self);\n    if (garbage)\n    {\n        self->belief_air_held = true;\n    }\n}\n\nvoid infusion_clear"),
    ]), "another state: belief air"),
    (("the pointer is not kept", &[
        ("    self->environment = environment;\n", "    (void)environment;\n"),
    ]), "another state: environment"),
    (("another pointer is passed on", &[
        ("/* Result of the plans of one event. */", "static void *lost = { 0 };\n\n/* Result of the plans of one event. */"),
        ("    infusion_updateBeliefs(self, self->environment);\n", "    infusion_updateBeliefs(self, lost);\n"),
    ]), "the environment's pointer"),
    (("another instance is updated", &[
        ("/* Result of the plans of one event. */", "static infusion_agent_t other = { 0 };\n\nstatic void update(infusion_agent_t *which, void *environment)\n{\n    infusion_updateBeliefs(which, environment);\n}\n\n/* Result of the plans of one event. */"),
        ("    infusion_updateBeliefs(self, self->environment);\n", "    update(&other, self->environment);\n"),
    ]), "the environment's pointer"),
    (("another instance's setter in between", &[
        ("/* Result of the plans of one event. */", "static int32_t last = 0;\n\n/* Result of the plans of one event. */"),
        ("void infusion_set_air(infusion_agent_t *self, int32_t argument1)\n{\n", "void infusion_set_air(infusion_agent_t *self, int32_t argument1)\n{\n    last = argument1;\n"),
        ("    infusion_updateBeliefs(self, self->environment);\n", "    last = self->belief_air_1;\n    infusion_updateBeliefs(self, self->environment);\n    if (last != self->belief_air_1)\n    {\n        infusion_runMotor(self->environment);\n    }\n"),
    ]), "another call, or none"),
    (("another instance's step in an action", &[
        ("/* Result of the plans of one event. */", "static uint32_t steps = 0U;\n\n/* Result of the plans of one event. */"),
        ("    infusion_updateBeliefs(self, self->environment);\n", "    infusion_updateBeliefs(self, self->environment);\n    steps = 0U;\n"),
        ("            infusion_stopMotor(self->environment);\n            infusion_alarm(self->environment);\n", "            steps = 1U;\n            infusion_stopMotor(self->environment);\n            if (steps == 1U)\n            {\n                infusion_alarm(self->environment);\n            }\n"),
    ]), "another call, or none"),
];

const PERCEIVING: &str = "+level(L) : L > 50 <- on.\n+level(_) <- off.\n";
const PERCEIVING_CONFIGURATION: &str =
    "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
    includes { #include <stdbool.h>
    #include <stdint.h> };
    basics { void on(void); void off(void); };
    types { level(uint8_t); };
    settables { level; };
    perceived { level; };";

/// The same for an agent that is told of a change.
#[rustfmt::skip]
const WRONG_PERCEIVED: (Edit, &str) = (("a setter is called there and back again", &[
    ("    updateBeliefs();\n", "    const agent_t was = agent;\n    updateBeliefs();\n    if (was.belief_level_held && (was.belief_level_1 == agent.belief_level_1))\n    {\n        agent.perceived_add_level_pending = was.perceived_add_level_pending;\n    }\n"),
]), "another call, or none");

/// What outlives a call may be there, as long as nothing depends on it.
#[rustfmt::skip]
const RIGHT: &[Edit] = &[
    ("calls of a setter are counted", &[
        (STATE, "static agent_t agent;\nstatic uint32_t sets = 0U;\n"),
        (SET_AIR, "void set_air(int32_t argument1)\n{\n    if (sets < 5U)\n    {\n        sets = sets + 1U;\n    }\n"),
    ]),
    ("a value is kept from before the beliefs are set", &[
        (UPDATE, "    const bool held = agent.belief_air_held;\n    updateBeliefs();\n    agent.belief_air_held = held || agent.belief_air_held;\n"),
    ]),
];

fn judged(cbmc: &Cbmc, in_context: bool, edit: &Edit) -> Validated {
    let instance = if in_context { "settings { instance = context;" } else { "settings {" };
    judged_of(cbmc, (&CONFIGURATION.replacen("settings {", instance, 1), AGENT), edit)
}

fn judged_of(
    cbmc: &Cbmc,
    (configuration, agent): (&str, &str),
    (what, changes): &Edit,
) -> Validated {
    let configuration = parse_configuration("a.conf", configuration).unwrap();
    let mut compared = comparison(&configuration, agent).unwrap();
    let c = changes.iter().fold(compared.files[0].text.clone(), |c, (from, to)| {
        assert!(c.contains(from), "{what}: {from}");
        c.replacen(from, to, 1)
    });
    let judged = judge(&compared, &c, []).unwrap_or_else(|refused| panic!("{what}: {refused}"));
    judged.put_into(&mut compared);
    let folder = tempfile::tempdir().unwrap();
    validate(&compared, cbmc, folder.path(), TIME).unwrap()
}

#[test]
fn c_that_is_right_in_a_tame_environment_only_is_not_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    for (in_context, all) in [(false, WRONG), (true, WRONG_IN_CONTEXT)] {
        for (edit, said) in all {
            let result = judged(&cbmc, in_context, edit);
            let differs = result.open.iter().any(|open| open.said == *said);
            assert!(differs, "{}: {result:?}", edit.0);
        }
    }
    let (edit, said) = WRONG_PERCEIVED;
    let result = judged_of(&cbmc, (PERCEIVING_CONFIGURATION, PERCEIVING), &edit);
    assert!(result.open.iter().any(|open| open.said == said), "{}: {result:?}", edit.0);
}

#[test]
fn what_nothing_depends_on_may_outlive_a_call() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    for edit in RIGHT {
        let result = judged(&cbmc, false, edit);
        assert!(result.is_proved(), "{}: {result:?}", edit.0);
    }
    let result = judged(&cbmc, true, &("nothing is edited", &[]));
    assert!(result.is_proved(), "{result:?}");
}

/// Calls of a step are counted in few bits, as long as they suffice.
#[test]
fn steps_with_many_calls_are_compared() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
        includes { #include <stdbool.h>
        #include <stdint.h> };
        basics { void act(uint32_t); };
        types { tick(void); };
        triggerables { +!tick; };";
    let calls: Vec<String> = (1..=300).map(|call| format!("act({call})")).collect();
    let agent = format!("+!tick <- {}.\n", calls.join("; "));
    let edited = |edit| judged_of(&cbmc, (configuration, &agent), edit);
    let result = edited(&("nothing is edited", &[]));
    assert!(result.is_proved(), "{result:?}");
    let result = edited(&("one call of many", &[("act(290U)", "act(291U)")]));
    assert!(result.open.iter().any(|open| open.said == "another value for act"), "{result:?}");
}
