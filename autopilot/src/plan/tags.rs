//! What is wrong or unwise about the tags of a plan.

use diagnostic::{Diagnostic, Span};
use estimator::{MAX_TAGS, SurveyedTag};
use kinematics::Pose;
use nalgebra::{Rotation2, Vector2};

use super::expectation::Expectations;
use super::parser::Line;
use super::{Command, FlightLimits};

/// Whether a flight uses tags.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TagUse<'a> {
    /// Not known here.
    Unknown,
    /// It does not.
    Off,
    /// It does; the places of these are known besides those that the plan declares.
    On(&'a [SurveyedTag]),
}

/// How far a search for a tag leads, in metres, right or left and forward or back of where it begins.
pub const LOOK_AROUND_M: f64 = 1.4;
/// A search stays this far inside the fence, in metres.
const INSIDE_M: f64 = 0.5;
/// Tags nearer to each other than this, in metres, cannot be told apart.
const APART_M: f64 = 1.5;
/// Distance at which a tag is whole in the picture of a level drone, as a share of the height, less half the
/// tag: right or left, forward, and back. The camera's centre is above the middle of its picture.
const SIGHT_ASIDE: f64 = 0.46;
const SIGHT_FORWARD: f64 = 0.31;
const SIGHT_BACK: f64 = 0.378;
const HALF_TAG_M: f64 = 0.1;
/// Step along a leg in metres at which it is asked whether a tag is seen.
const GLANCE_M: f64 = 0.1;

/// Consequence of a tag beyond the fence.
const NEVER_SEEN: &str = "the drone may never see it";

/// Warnings about tags that are given by the settings, one sentence each: those beyond the fence.
pub fn given_tag_warnings(given: &[SurveyedTag], limits: &FlightLimits) -> Vec<String> {
    let warning = |tag: &SurveyedTag| {
        let how = beyond_fence(tag, limits)?;
        let SurveyedTag { place_m, .. } = tag;
        Some(format!("the given tag {},{} is {how}: {NEVER_SEEN}", place_m.x, place_m.y))
    };
    given.iter().filter_map(warning).collect()
}

/// How far a tag is, if it is beyond the fence.
fn beyond_fence(tag: &SurveyedTag, limits: &FlightLimits) -> Option<String> {
    let border = &limits.border;
    (border.outside_m(tag.place_m) > 0.0).then(|| border.how_far(tag.place_m))
}

/// All errors and warnings about tags in these lines.
pub(super) fn findings(lines: &[Line], limits: &FlightLimits, tags: TagUse<'_>) -> Vec<Diagnostic> {
    let mut review = Review { limits, findings: Vec::new() };
    review.declarations(lines, tags);
    review.commands(lines, tags);
    review.findings
}

struct Review<'a> {
    limits: &'a FlightLimits,
    findings: Vec<Diagnostic>,
}

impl Review<'_> {
    fn warn(&mut self, message: String, span: &Span, help: &str) {
        self.findings.push(Diagnostic::warning(message, span.clone()).help(help));
    }

    fn error(&mut self, message: &str, span: &Span, help: &str) {
        self.findings.push(Diagnostic::error(message, span.clone()).help(help));
    }

    fn declarations(&mut self, lines: &[Line], tags: TagUse<'_>) {
        let mut known = given(tags);
        let mut has_taken_off = false;
        for line in lines {
            has_taken_off |= matches!(line.command, Some(Command::TakeOff { .. }));
            let Some(tag) = line.tag else { continue };
            if has_taken_off {
                let help = "where the drone is counts from the known tags: put it before `takeoff`";
                self.error("a tag that is declared in flight", &line.span, help);
            }
            if known.len() == MAX_TAGS {
                self.error("more tags than can be known", &line.span, "there may be eight");
            }
            let distance_m = |other: &SurveyedTag| (other.place_m - tag.place_m).norm();
            if let Some(near_m) = known.iter().map(distance_m).min_by(f64::total_cmp)
                && near_m < APART_M
            {
                let message = format!("the tag is {near_m:.2} m from another");
                let help = "they all look alike: leave 1.5 m between them";
                self.warn(message, &line.span, help);
            }
            if let Some(how) = beyond_fence(&tag, self.limits) {
                self.warn(format!("the tag is {how}"), &line.span, NEVER_SEEN);
            }
            known.push(tag);
        }
    }

    fn commands(&mut self, lines: &[Line], tags: TagUse<'_>) {
        let declared = lines.iter().filter_map(|line| line.tag);
        let known: Vec<SurveyedTag> = given(tags).into_iter().chain(declared).collect();
        let mut expectations = Expectations::new(self.limits).with_tags(&known);
        let (mut sees, mut last) = (false, None);
        for line in lines {
            let asks = matches!(line.command, Some(Command::FindTag | Command::LandOnTag));
            if (asks || line.tag.is_some()) && tags == TagUse::Off {
                let help = "add `--tags`, or set `detect` of `[tags]` in `pilot.toml`";
                self.warn("tags are not in use".to_owned(), &line.span, help);
            }
            let Some(command) = line.command else { continue };
            let before = expectations.place();
            if asks {
                let here_m = Vector2::new(before.x_m, before.y_m);
                self.search(expectations.nearest_tag_m().unwrap_or(here_m), &line.span);
            }
            let expected = expectations.step(command);
            let target = expected.target.unwrap_or(expected.place);
            sees |= asks || sees_one(&before, &target, &known);
            last = Some(line);
        }
        if let Some(last) = last.filter(|_| !sees && !known.is_empty()) {
            let help = "a tag is seen from above, up to 0.3 of the height ahead and 0.4 aside";
            self.warn("the drone never sees a tag on this way".to_owned(), &last.span, help);
        }
    }

    fn search(&mut self, from_m: Vector2<f64>, span: &Span) {
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
        let leads = |corner: [f64; 2]| from_m + Vector2::from(corner) * LOOK_AROUND_M;
        if corners.into_iter().any(|c| self.limits.border.outside_m(leads(c)) > -INSIDE_M) {
            let message = "a search for a tag here would lead over the fence".to_owned();
            self.warn(message, span, "it stays half a metre inside, and sees less");
        }
    }
}

fn given(tags: TagUse<'_>) -> Vec<SurveyedTag> {
    match tags {
        TagUse::On(given) => given.to_vec(),
        TagUse::Off | TagUse::Unknown => Vec::new(),
    }
}

/// Whether one of the tags is whole in the picture somewhere on a leg.
fn sees_one(from: &Pose, to: &Pose, tags: &[SurveyedTag]) -> bool {
    let leg_m = (to.x_m - from.x_m).hypot(to.y_m - from.y_m).hypot(to.z_m - from.z_m);
    let glances = (leg_m / GLANCE_M).ceil().max(1.0);
    let mut glance = 0.0;
    while glance <= glances {
        let share = glance / glances;
        let between = |from: f64, to: f64| from + share * (to - from);
        let place_m = Vector2::new(between(from.x_m, to.x_m), between(from.y_m, to.y_m));
        let height_m = between(from.z_m, to.z_m);
        let [aside_m, forward_m, back_m] =
            [SIGHT_ASIDE, SIGHT_FORWARD, SIGHT_BACK].map(|share| share * height_m - HALF_TAG_M);
        // Counter-clockwise by the heading: from the world to the body.
        let body_from_world = Rotation2::new(to.yaw_deg.to_radians());
        let sees = |tag: &SurveyedTag| {
            let off_m = body_from_world * (tag.place_m - place_m);
            off_m.x.abs() <= aside_m && (-back_m..=forward_m).contains(&off_m.y)
        };
        if tags.iter().any(sees) {
            return true;
        }
        glance += 1.0;
    }
    false
}

#[cfg(test)]
mod tests {
    use diagnostic::line_column;

    use super::*;
    use crate::plan::Plan;

    fn found(text: &str, tags: TagUse<'_>) -> Vec<(usize, usize, String)> {
        let (_, findings) = Plan::review_with_tags(text, &FlightLimits::default(), tags);
        let place = |finding: Diagnostic| {
            let (line, column) = line_column(text, finding.span.start);
            (line, column, finding.message)
        };
        findings.into_iter().map(place).collect()
    }

    #[test]
    fn a_plan_with_tags_is_read() {
        let text = "tag 0.1 -0.2\ntag 2 0 90\ntakeoff\nfindTag\nlandOnTag\n";
        let (plan, findings) = Plan::review(text, &FlightLimits::default());
        assert_eq!(findings, []);
        let plan = plan.unwrap();
        let steps: Vec<Command> = plan.steps().iter().map(|step| step.command).collect();
        let taken = Command::TakeOff { take_over: false };
        assert_eq!(steps, [taken, Command::FindTag, Command::LandOnTag], "no implied landing");
        assert_eq!(plan.tags()[1].heading_deg, Some(90.0));
        assert!(plan.uses_tags());
    }

    #[test]
    fn wrong_tag_commands_are_refused_at_their_place() {
        for (text, line, column, message) in [
            ("tag 1\ntakeoff\nland", 1, 1, "`tag` with 1 arguments"),
            ("tag 1 x\ntakeoff\nland", 1, 7, "`x` is not a number"),
            ("tag 1 2 400\ntakeoff\nland", 1, 9, "400 is out of range"),
            ("takeoff\n  tag 0 0\nland", 2, 3, "a tag that is declared in flight"),
            ("takeoff\nfindTag 3\nland", 2, 1, "`findTag` with 1 arguments"),
            ("takeoff\nland\nlandOnTag", 3, 1, "the drone is on the ground here"),
            ("takeoff\nlandOnTag\ngoto 0 1 0 0", 3, 1, "the drone is on the ground here"),
        ] {
            let (plan, _) = Plan::review(text, &FlightLimits::default());
            assert!(plan.is_none(), "{text}");
            let expected = (line, column, message.to_owned());
            assert!(found(text, TagUse::Unknown).contains(&expected), "{text}");
        }
        let seven: Vec<SurveyedTag> = (0..7)
            .map(|tag| SurveyedTag {
                place_m: Vector2::new(2.0 * f64::from(tag) - 7.0, 5.0),
                heading_deg: None,
            })
            .collect();
        let parse = |tags: &str| {
            let text = format!("{tags}takeoff\nfindTag\nland");
            let limits = FlightLimits::default();
            Plan::parse_with_tags("p", &text, &limits, TagUse::On(&seven))
        };
        assert!(parse("tag 0 0\n").is_ok());
        let error = parse("tag 0 0\ntag 2 0\n").unwrap_err().to_string();
        assert!(error.contains("more tags than can be known"), "{error}");
        let nine = (0..9).map(|tag| format!("tag {} 0", 2 * tag - 8)).collect::<Vec<_>>();
        let findings = found(&format!("{}\ntakeoff\nland", nine.join("\n")), TagUse::Unknown);
        assert_eq!(findings[0], (9, 1, "more tags than can be known".to_owned()));
    }

    #[test]
    fn unwise_tags_are_warned_of() {
        let given = [SurveyedTag { place_m: Vector2::new(0.0, 3.0), heading_deg: None }];
        for (text, tags, line, message) in [
            ("takeoff\nfindTag\nland", TagUse::Off, 2, "tags are not in use"),
            ("tag 0 0\ntakeoff\nland", TagUse::Off, 1, "tags are not in use"),
            (
                "tag 0 0\ntag 1 1\ntakeoff\nland",
                TagUse::Unknown,
                2,
                "the tag is 1.41 m from another",
            ),
            (
                "tag 0 2\ntakeoff\nlandOnTag",
                TagUse::On(&given),
                1,
                "the tag is 1.00 m from another",
            ),
            (
                "tag 11 0\ntakeoff\ngoto 0 1 0 0\nland",
                TagUse::Unknown,
                1,
                "the tag is 11.00 m from the start, beyond the fence of 10 m",
            ),
            (
                "takeoff\ngoto 0 1 0 0\nland",
                TagUse::On(&given),
                3,
                "the drone never sees a tag on this way",
            ),
            (
                "takeoff\ngoto 0 8 0 0\nfindTag\nland",
                TagUse::Unknown,
                3,
                "a search for a tag here would lead over the fence",
            ),
        ] {
            let findings = found(text, tags);
            let warned =
                findings.iter().any(|(at, _, found)| *at == line && found.starts_with(message));
            assert!(warned, "{text}: {findings:?}");
        }
        assert_eq!(found("takeoff\ngoto 0 3 0 0\nland", TagUse::On(&given)), []);
        // The hover is expected at 0.85 m: this is 1.5 m.
        for (forward_m, sees) in [(0.355, true), (0.38, false), (-0.45, true), (-0.48, false)] {
            let text = format!("tag 0 {forward_m}\ntakeoff\ngoto 0 0 0.65 0\nland");
            assert_eq!(found(&text, TagUse::Unknown).is_empty(), sees, "{forward_m}");
        }
        let far = SurveyedTag { place_m: Vector2::new(6.0, -8.5), heading_deg: None };
        let warnings = given_tag_warnings(&[given[0], far], &FlightLimits::default());
        let expected = "the given tag 6,-8.5 is 10.40 m from the start, beyond the fence of 10 m: \
                        the drone may never see it";
        assert_eq!(warnings, [expected]);
        assert_eq!(found("takeoff\nfindTag\nlandOnTag", TagUse::On(&[])), []);
    }
}
