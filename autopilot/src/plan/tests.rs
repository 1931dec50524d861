use proptest::prelude::*;

use super::*;

fn error(text: &str) -> String {
    Plan::parse("plan.txt", text).unwrap_err().to_string()
}

fn commands(text: &str) -> Vec<Command> {
    Plan::parse("plan.txt", text).unwrap().steps().iter().map(|step| step.command).collect()
}

const TAKE_OFF: Command = Command::TakeOff { take_over: false };

#[test]
fn all_commands_and_comments_are_read() {
    let plan = "# a plan\ntakeoff // up\n\n  goto 1 -2.5 .5 90 # there\r\nmoveBy 0 0 0.1 0\n\
                moveByRel 0 0 -.2 -10\nsetReference $POSE$\nsetReference 1 1 0 0\n\
                setInitialReachDist 0.2\nsetStayWithinDist 0.5\nsetStayTime 2\nsetMaxControl 0.8\n\
                lockScaleFP\nland";
    let parsed = commands(plan);
    assert_eq!(parsed.len(), 11);
    let pose = Pose { x_m: 1.0, y_m: -2.5, z_m: 0.5, yaw_deg: 90.0 };
    assert_eq!(parsed[1], Command::GoTo(pose));
    assert_eq!(parsed[4], Command::SetReferenceHere);
}

#[test]
fn a_plan_may_name_its_version_before_all_commands() {
    let plan = "takeoff\nland\n";
    assert_eq!(commands(&format!("# today\nversion 1 // of plans\n{plan}")), commands(plan));
    let text = |version: &str| format!("{version}\nflyTo the moon\n{plan}");
    for (version, named) in [("version 2", "2"), ("version 0", "0"), ("version 1.5", "1.5")] {
        let error = error(&text(version));
        assert!(
            error.contains(&format!("error: this plan has version {named} of its language")),
            "{error}"
        );
        assert!(error.contains("plan.txt:1:1"), "{error}");
        assert!(error.contains("this program reads version 1"), "{error}");
        assert!(!error.contains("flyTo"), "nothing else of it is judged: {error}");
    }
    for late in ["takeoff\nversion 1\nland", "version 1\nversion 1\ntakeoff\nland"] {
        let error = error(late);
        assert!(error.contains("plan.txt:2:1") && error.contains("before all commands"), "{error}");
    }
    assert!(error("version one\ntakeoff").contains("`one` is not a number"));
}

/// In 309 digits nobody finds the reason.
#[test]
fn a_huge_number_is_refused_in_a_few_digits() {
    let error = error("takeoff\ngoto 1e308 0 0 0\nland");
    assert!(error.contains("error: 1e308 is out of range"), "{error}");
    let border = FlightLimits::default().border;
    let far = border.how_far([2.5e7, 0.0].into());
    assert_eq!(far, "2.5e7 m from the start, beyond the fence of 10 m");
    assert!(border.how_far([10.4, 0.0].into()).starts_with("10.40 m from"));
}

#[test]
fn each_command_is_declared_with_a_line_that_has_it() {
    for declared in LANGUAGE.iter().filter(|declared| !declared.example.is_empty()) {
        assert_eq!(declared.example.split(' ').next(), Some(declared.name));
        let (lines, problems) = parser::parse(declared.example);
        assert!(problems.is_empty() && lines.len() == 1, "{problems:?}");
        assert!(declared.optional <= declared.numbers.len());
    }
    let names: Vec<&str> = LANGUAGE.iter().map(|declared| declared.name).collect();
    assert!(names.iter().all(|name| names.iter().filter(|other| *other == name).count() == 1));
}

#[test]
fn every_bad_line_is_reported_with_line_column_and_advice() {
    insta::assert_snapshot!(
        error("takeof\ngoto 1 2 3\ngoto 1 2 x 4\n  setStayTime -1\nland now\nsetMaxControl 2\nfly"),
        @r"
    error: unknown command `takeof`
     --> plan.txt:1:1
      |
    1 | takeof
      | ^^^^^^
      |
      = help: did you mean `takeoff`?

    error: `goto` with 3 arguments
     --> plan.txt:2:1
      |
    2 | goto 1 2 3
      | ^^^^^^^^^^
      |
      = help: write `goto x y z yaw`

    error: `x` is not a number
     --> plan.txt:3:10
      |
    3 | goto 1 2 x 4
      |          ^
      |
      = help: write `goto x y z yaw`

    error: -1 is out of range
     --> plan.txt:4:15
      |
    4 |   setStayTime -1
      |               ^^
      |
      = help: expected a number from 0 to 600

    error: `land` with 1 arguments
     --> plan.txt:5:1
      |
    5 | land now
      | ^^^^^^^^
      |
      = help: write `land` alone

    error: 2 is out of range
     --> plan.txt:6:15
      |
    6 | setMaxControl 2
      |               ^
      |
      = help: expected a number from 0.05 to 1

    error: unknown command `fly`
     --> plan.txt:7:1
      |
    7 | fly
      | ^^^
      |
      = help: commands are: takeoff, land, goto, moveBy, moveByRel, hold, setReference, setInitialReachDist, setStayWithinDist, setStayTime, setSpeed, setMaxControl, tag, findTag, landOnTag, clearCommands, autoInit, autoTakeover, lockScaleFP, version
    "
    );
}

#[test]
fn targets_outside_the_heights_are_refused() {
    insta::assert_snapshot!(
        error("takeoff\ngoto 0 0 -0.6 0\ngoto 0 0 2.5 0\nmoveBy 0 0 -0.1 0\nsetReference $POSE$\ngoto 0 0 0.2 0\nland"),
        @r"
    error: target 0.25 m above the floor, below the lowest of 0.3 m
     --> plan.txt:2:1
      |
    2 | goto 0 0 -0.6 0
      | ^^^^^^^^^^^^^^^
      |
      = help: z = 0 is where the drone hovers after take-off, about 0.85 m above the floor

    error: target 3.35 m above the floor, above the ceiling of 3 m
     --> plan.txt:3:1
      |
    3 | goto 0 0 2.5 0
      | ^^^^^^^^^^^^^^
      |
      = help: z = 0 is where the drone hovers after take-off, about 0.85 m above the floor

    error: target 3.10 m above the floor, above the ceiling of 3 m
     --> plan.txt:6:1
      |
    6 | goto 0 0 0.2 0
      | ^^^^^^^^^^^^^^
      |
      = help: z = 0 is where the drone hovers after take-off, about 0.85 m above the floor
    "
    );
}

#[test]
fn heights_can_be_counted_from_the_floor() {
    let limits = FlightLimits { z_origin: ZOrigin::Floor, ..FlightLimits::default() };
    assert!(Plan::parse_within("p", "takeoff\ngoto 0 0 2.9 0\nland", &limits).is_ok());
    let error = Plan::parse_within("p", "takeoff\ngoto 0 0 0 0\nland", &limits).unwrap_err();
    assert!(error.to_string().contains("z = 0 is the floor"));
}

#[test]
fn a_plan_must_take_off_before_it_goes_anywhere() {
    assert!(error("goto 0 0 0 0\ntakeoff\nland").contains("put `takeoff` before it"));
    assert!(error("takeoff\nland\ngoto 0 0 0 0").contains("plan.txt:3:1"));
    for text in ["", "\n\n# nothing\n", "land", "setStayTime 1"] {
        assert!(error(text).contains("never takes off"), "{text:?}");
    }
}

#[test]
fn visual_mapping_commands_fly_without_it_and_say_so() {
    let plan = Plan::parse("p", "autoTakeover 500 800 4000 0.5\nlockScaleFP\nland").unwrap();
    assert!(plan.takes_over());
    assert_eq!(plan.steps().len(), 2);
    assert_eq!(plan.notes().len(), 2);
    assert_eq!(commands("autoInit 500 800\nland"), [TAKE_OFF, Command::Land]);
}

#[test]
fn clear_commands_drops_what_stands_before_it() {
    let kept = commands("takeoff\ngoto 9 9 1 0\nclearCommands\ntakeoff\nland");
    assert_eq!(kept, [TAKE_OFF, Command::Land]);
}

#[test]
fn a_plan_without_a_landing_lands() {
    let plan = Plan::parse("p", "takeoff\ngoto 0 0 0 0").unwrap();
    assert_eq!(plan.steps().last().map(|step| step.command), Some(Command::Land));
    assert_eq!(plan.notes().len(), 1);
}

#[test]
fn the_known_plans_are_accepted() {
    for plan in [
        include_str!("../../../plans/square.txt"),
        include_str!("../../../plans/square1x1.txt"),
        include_str!("../../../plans/xyz.txt"),
        include_str!("../../../plans/NikolausVertical.txt"),
    ] {
        assert!(Plan::parse("plan.txt", plan).is_ok());
    }
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "\\PC*") {
        let _ = Plan::parse("plan.txt", &text);
    }

    #[test]
    fn any_line_of_plan_words_is_read_or_refused(
        words in proptest::collection::vec(
            prop_oneof![
                Just("goto"), Just("takeoff"), Just("setReference"), Just("$POSE$"), Just("1e400"),
                Just("nan"), Just("-3"), Just("0.5"), Just("\n"), Just("#"), Just("setStayTime"),
            ],
            0..40,
        )
    ) {
        let _ = Plan::parse("plan.txt", &words.join(" "));
    }
}
