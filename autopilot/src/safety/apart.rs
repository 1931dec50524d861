//! How a drone is kept apart from other vehicles: instead of a motion of its own it follows a course that can stop before each
//! line between it and another, and that leads past whoever is in the way.

use std::time::Duration;

use kinematics::{Pose, Sticks, world_from_body};
use nalgebra::Vector2;
use pid::{Course, MotionLimits};

use super::stopping::{Stopping, stopping_inside_m_s, straight_on_m_s};
use super::{INSIDE_M, Situation, stopping_place};
use crate::agent::AgentCommand;
use crate::fence::{Border, Wall, across};
use crate::separation::{Claim, Other, Others, Progress, Rank, makes_way, waits, way_past};

/// The reference is never further from the drone than this.
const LEASH_M: f64 = 0.6;
/// Who is beyond a line goes back with this speed for each metre, and at most with this one.
const BACK_1_S: f64 = 1.0;
const BACK_M_S: f64 = 0.6;
/// Who is beyond a line by this, for so long, lands: the other does not make room, or may be anywhere.
const CROWDED_M: f64 = 0.35;
const CROWDED: Duration = Duration::from_millis(1500);
/// A velocity that is changed by this is told of, and for so long after the last time.
const TOLD_M_S: f64 = 0.3;
const TOLD: Duration = Duration::from_secs(1);

/// Keeps one drone apart from others.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Apart {
    course: Option<Course>,
    progress: Option<Progress>,
    claim: Option<Claim>,
    crowded_since: Option<Duration>,
    told_until: Duration,
    /// Where manual control was stopped, until it leads elsewhere.
    stop: Option<Pose>,
}

impl Apart {
    /// The drone does not fly by orders, or is alone.
    pub(super) fn rest(&mut self) {
        *self = Self { told_until: self.told_until, ..Self::default() };
    }

    pub(super) fn course(&self) -> Option<&Course> {
        self.course.as_ref()
    }

    /// The way that the drone claims from others.
    pub(super) fn claim(&self) -> Option<Claim> {
        self.claim
    }

    /// Whether others have been too near for too long.
    pub(super) fn is_crowded(&mut self, now: &Situation, others: &Others) -> bool {
        let is_beyond = least_room_m(across(&now.pose), others) < -CROWDED_M;
        self.crowded_since = is_beyond.then(|| self.crowded_since.unwrap_or(now.now));
        self.crowded_since.is_some_and(|since| now.now >= since + CROWDED)
    }

    /// The command that is left of this one, and whether another vehicle has changed it.
    pub(super) fn keep(
        &mut self,
        command: AgentCommand,
        now: &Situation,
        others: &Others,
        border: &Border,
        limits: &MotionLimits,
        system: u8,
    ) -> (AgentCommand, bool) {
        let target = match command {
            AgentCommand::GoTo(target) => {
                self.stop = None;
                target
            }
            AgentCommand::Sticks if leads_on(now, others) => {
                *self.stop.get_or_insert_with(|| stopping_place(&now.stops_from()))
            }
            _ => {
                (self.stop, self.course, self.progress, self.claim) = (None, None, None, None);
                return (command, false);
            }
        };
        let is_stopped = command == AgentCommand::Sticks;
        let here_m = across(&now.pose);
        let [right_m_s, forward_m_s, _] = now.velocity_m_s;
        let begun = Course::new(here_m, Vector2::new(right_m_s, forward_m_s));
        let course = self.course.get_or_insert(begun);
        let target_m = across(&target);
        let aside = makes_way(here_m, others, border);
        let waits = aside.is_none() && waits(here_m, target_m, others);
        let rests = is_stopped || waits || aside.is_some();
        let progress = self.progress.get_or_insert(Progress::new(now.now, target_m));
        let is_held_up = progress.is_held_up(now.now, here_m, target_m, rests);
        let own = Claim { to_m: target_m, rank: Rank { system, behind: 0 } };
        self.claim = aside.or(Some(own).filter(|_| is_held_up && !waits));
        let goal_m = aside.map_or(if waits { here_m } else { target_m }, |aside| aside.to_m);
        let past_m = way_past(here_m, goal_m, others, border);
        // Every way may lead to one that contradicts itself: it stays, and lands if that lasts.
        let stays = others.iter().any(|other| other.is_anywhere(here_m));
        let wanted_m_s = if stays {
            Vector2::zeros()
        } else {
            course.velocity_to(&past_m, limits).cap_magnitude(limits.speed_m_s)
        };
        let foremost_m = course.position_m;
        let nearer = |other: &Other| {
            let [here, there] = [other.wall(here_m), other.wall(foremost_m)];
            if here.distance_m < there.distance_m { here } else { there }
        };
        let lines = others.iter().map(nearer);
        let is_behind = border.outside_m(here_m) > border.outside_m(foremost_m);
        let walls = border.walls(if is_behind { here_m } else { foremost_m });
        let all = lines.clone().chain(walls.clone());
        let kept_m_s = stopping_inside_m_s(wanted_m_s, course.velocity_m_s, &all);
        // Between two lines that meet ahead it is slow, but does not stay: others need not leave it more.
        let is_trapped = kept_m_s == Vector2::zeros();
        let kept_m_s = if is_trapped { straight_on_m_s(wanted_m_s, all) } else { kept_m_s };
        let back = |wall: Wall| wall.outward * (wall.distance_m * BACK_1_S).clamp(-BACK_M_S, 0.0);
        let known = others.iter().filter(|other| !other.is_anywhere(here_m)).map(nearer);
        let back_m_s = known.map(back).sum::<Vector2<f64>>().cap_magnitude(BACK_M_S);
        let led_m_s = if back_m_s == Vector2::zeros() {
            kept_m_s
        } else {
            stopping_inside_m_s(kept_m_s + back_m_s, course.velocity_m_s, &walls)
        };
        course.advance(led_m_s, limits, now.tick_s);
        course.position_m = here_m + (course.position_m - here_m).cap_magnitude(LEASH_M);
        if is_stopped || stays || past_m != target_m || (led_m_s - wanted_m_s).norm() > TOLD_M_S {
            self.told_until = now.now + TOLD;
        }
        (AgentCommand::GoTo(target), now.now < self.told_until)
    }
}

fn least_room_m(place_m: Vector2<f64>, others: &Others) -> f64 {
    let rooms = others.iter().map(|other| other.wall(place_m).distance_m);
    rooms.fold(f64::INFINITY, f64::min)
}

/// Whether the sticks, or the motion, lead to the line between the drone and another.
fn leads_on(now: &Situation, others: &Others) -> bool {
    let Sticks { roll, pitch, .. } = now.sticks;
    let ahead = world_from_body(Vector2::new(roll, -pitch), now.pose.yaw_deg);
    let [right_m_s, forward_m_s, _] = now.velocity_m_s;
    let velocity_m_s = Vector2::new(right_m_s, forward_m_s);
    others.iter().map(|other| other.wall(across(&now.pose))).any(|wall| {
        let speed_m_s = velocity_m_s.dot(&wall.outward).max(0.0);
        let room_m = wall.distance_m - Stopping::CAUTIOUS.way_m(speed_m_s);
        room_m < INSIDE_M && ahead.dot(&wall.outward) > 0.0 || room_m < 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::tests::FINE;
    use crate::separation::{Neighbour, Neighbours, Oneself, Presence};

    /// Where a course leads within a second, of a vehicle that hovers and wants to fly forward. Each other one tells that it is at
    /// a place, and told before that it was so far to the right of there.
    fn led_m_s(told: &[([f64; 2], f64)]) -> Vector2<f64> {
        let mut neighbours = Neighbours::default();
        for (system, ([x_m, y_m], jump_m)) in (2..).zip(told) {
            for off_m in [*jump_m, 0.0] {
                // That it cannot have got there is said.
                _ = neighbours.hear(Neighbour {
                    system,
                    at: FINE.now,
                    place_m: Vector2::new(x_m + off_m, *y_m),
                    velocity_m_s: Vector2::zeros(),
                    uncertainty_m: 0.0,
                    separation_m: 1.5,
                    presence: Presence::Flies,
                    claim: None,
                });
            }
        }
        let oneself = Oneself {
            system: 1,
            rank: None,
            place_m: across(&FINE.pose),
            velocity_m_s: Vector2::zeros(),
            uncertainty_m: 0.0,
            separation_m: 1.5,
        };
        let others = neighbours.others(FINE.now, &oneself);
        let command = AgentCommand::GoTo(Pose { y_m: 3.0, ..FINE.pose });
        let limits = MotionLimits { speed_m_s: 2.0, acceleration_m_s2: 1.5, jerk_m_s3: 14.0 };
        let mut apart = Apart::default();
        for _ in 0..10 {
            _ = apart.keep(command, &FINE, &others, &Border::circle(9.0), &limits, 1);
        }
        apart.course().unwrap().velocity_m_s
    }

    #[test]
    fn nobody_goes_anywhere_because_of_one_that_may_be_anywhere_but_back_from_others() {
        assert!(led_m_s(&[]).y > 0.5, "it flies to its target");
        assert!(led_m_s(&[([1.0, 0.0], 0.0)]).x < -0.1, "it goes back");
        assert!(led_m_s(&[([4.0, 0.0], 1.5)]).x < -0.1, "it is somewhere to the right");
        assert!(led_m_s(&[([4.0, 0.0], 6.0)]).norm() < 1e-9, "it may be to the left");
        let both_m_s = led_m_s(&[([4.0, 0.0], 6.0), ([0.0, 1.0], 0.0)]);
        assert!(both_m_s.x.abs() < 1e-9 && both_m_s.y < -0.1, "{both_m_s}");
    }
}
