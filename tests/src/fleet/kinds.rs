//! The faults of a fleet by their kinds, and as lines of text.

use std::collections::BTreeSet;
use std::time::Duration;

use autopilot::vehicle::OperatorOrder;
use mock_drone::scenario::{Action, Direction, When};
use mock_drone::{LinkFaults, SensorFault};

use super::{Air, Falsehood, Fleet, Injected};

/// What kind of fault this is.
fn kind(action: &Action) -> &'static str {
    match action {
        Action::Outage(Direction::Down, _) => "navdata lost",
        Action::Outage(Direction::Up, _) => "orders lost",
        Action::Outage(Direction::Both, _) => "link lost",
        Action::Hold(..) | Action::Burst(_) => "datagrams late or twice",
        Action::Loss(..)
        | Action::Delay(..)
        | Action::Duplication(_)
        | Action::Reordering(_)
        | Action::Corruption(_) => "a bad link",
        Action::Restart => "restart",
        Action::Propeller => "motors cut: propeller blocked",
        Action::Motor(..) => "weak motor",
        Action::Freeze(_) => "sensor: all frozen",
        Action::Sensor(_, fault, _) => match fault {
            SensorFault::Stuck | SensorFault::StuckAt(_) => "sensor: stuck",
            SensorFault::DeadAt(_) => "sensor: dead",
            SensorFault::Offset(_) => "sensor: off",
            SensorFault::Ramp(_) => "sensor: drifts",
            SensorFault::NotANumber => "sensor: NaN",
            SensorFault::Noise(_) => "sensor: noise",
            SensorFault::Gain(_) => "sensor: wrong gain",
            SensorFault::Late(_) => "sensor: late",
        },
        Action::State(..) => "drone reports a fault",
        Action::Minor(..) => "drone sees no floor",
        Action::Wind(..) => "wind or storm",
        Action::Battery(_) | Action::BatterySag(_) => "low battery",
        Action::SecondPilot(..) => "another client flies",
        Action::LayTag(_) | Action::MoveTag(..) => "tags",
        Action::Video(..) => "video",
    }
}

impl Air {
    /// What of it had begun by then.
    fn kinds(&self, now: Duration) -> impl Iterator<Item = &'static str> {
        let begun = move |[at, _]: [Duration; 2]| at < now;
        let is_cut = move |of, by| {
            self.partitions.iter().any(|cut| (cut.of, cut.by) == (of, by) && begun(cut.at))
        };
        let cuts = self.partitions.iter().filter(move |cut| begun(cut.at));
        let cuts = cuts.map(move |cut| {
            if is_cut(cut.by, cut.of) {
                "messages: two do not hear each other"
            } else {
                "messages: one does not hear another"
            }
        });
        let lie = self.lie.filter(|lie| lie.since < now).map(|lie| match lie.what {
            Falsehood::Place(_) => "tells a false place",
            Falsehood::Jumps(_) => "tells a place that jumps",
            Falsehood::Creeps(_) => "tells a place that creeps away",
            Falsehood::Velocity(_) => "tells a false velocity",
            Falsehood::Stale => "tells an old place as new",
            Falsehood::Repeats => "tells the same again and again",
        });
        let has = |is_so: bool, kind| is_so.then_some(kind);
        cuts.chain(lie)
            .chain(has(self.loss > 0.0, "messages lost"))
            .chain(has(!self.delay.is_zero(), "messages delayed"))
            .chain(has(!self.jitter.is_zero(), "messages with jitter"))
            .chain(has(self.silent.is_some_and(begun), "messages: nobody hears anybody"))
            .chain(has(self.is_shared, "one shared air"))
    }
}

impl Fleet {
    /// The kinds of faults that had begun by then.
    pub(super) fn kinds<'a>(
        &self,
        now: Duration,
        injected: impl Iterator<Item = &'a Injected>,
    ) -> BTreeSet<&'static str> {
        let mut kinds: BTreeSet<_> = self.air.kinds(now).collect();
        for injected in injected {
            kinds.extend(injected.begun(now).map(|(_, action)| kind(action)));
            if injected.stalls.iter().any(|(at, _)| *at < now) {
                kinds.insert("program suspended");
            }
        }
        for member in &self.members {
            let is_cut =
                |(at, order): &(Duration, OperatorOrder)| *order == OperatorOrder::Cut && *at < now;
            if member.orders.iter().any(is_cut) {
                kinds.insert("motors cut: by an operator");
            }
            if member.world.link != LinkFaults::default() {
                kinds.insert("a bad link");
            }
        }
        kinds
    }

    /// Description of the fleet and its faults, one line each.
    pub fn circumstances(&self) -> Vec<String> {
        let mut lines = vec![format!("{:?}", self.air)];
        for (member, number) in self.members.iter().zip(1..) {
            let drone = &member.world.drone;
            let [x_m, y_m] = member.start.place_m.into();
            lines.push(format!(
                "vehicle {number} at {x_m:.2} {y_m:.2}, {:.0}°, wind {:.2} {:.2} gusts {:.2} m/s, link {:?}: {}",
                member.start.heading_deg,
                drone.wind_m_s.x,
                drone.wind_m_s.y,
                drone.gusts_m_s,
                member.world.link,
                member.plan.trim().replace('\n', "; "),
            ));
            for (when, action) in &member.injected.accidents {
                lines.push(match when {
                    When::SinceStart(at) => format!("  {:.2} s: {action:?}", at.as_secs_f64()),
                    When::SinceTakeOff(at) => format!("  +{:.2} s: {action:?}", at.as_secs_f64()),
                });
            }
            for (at, time) in &member.injected.stalls {
                lines.push(format!("  {:.2} s: suspended for {time:?}", at.as_secs_f64()));
            }
            for (at, order) in &member.orders {
                lines.push(format!("  {:.2} s: {order:?}", at.as_secs_f64()));
            }
        }
        lines
    }
}
