use proptest::prelude::*;

use super::*;

const MS: fn(u64) -> Duration = Duration::from_millis;
const LIMITS: Limits = Limits {
    ready: Duration::from_secs(30),
    take_off: Duration::from_secs(15),
    landing: Duration::from_secs(30),
};

type Answer = oneshot::Receiver<Result<(), FlightError>>;

/// The orders, and a drone whose state is set by the test.
struct Bench {
    orders: Orders,
    seen: Seen,
    now: Duration,
}

impl Bench {
    /// A drone on the ground, ready.
    fn new() -> Self {
        let mut bench =
            Self { orders: Orders::new(LIMITS), seen: Seen::default(), now: Duration::ZERO };
        bench.seen.alive = true;
        bench.seen.ready = true;
        bench.says(DroneState::empty(), ControlState::Landed);
        bench
    }

    /// A drone that hovers.
    fn airborne() -> Self {
        let mut bench = Self::new();
        let mut answer = bench.take_off();
        bench.tick();
        bench.says(DroneState::FLYING, ControlState::TakingOff);
        bench.tick();
        assert!(answer.try_recv().is_err(), "it climbs");
        bench.says(DroneState::FLYING, ControlState::Hovering);
        bench.tick();
        assert_eq!(answer.try_recv(), Ok(Ok(())));
        bench
    }

    fn says(&mut self, state: DroneState, control_state: ControlState) {
        self.seen.state = state;
        self.seen.control_state = Some(control_state);
    }

    /// Order of one tick after a packet.
    fn tick(&mut self) -> Order {
        self.now += MS(30);
        self.seen.heard_at = Some(self.now);
        self.silent_tick()
    }

    /// Order of one tick without a packet.
    fn silent_tick(&mut self) -> Order {
        self.now += MS(30);
        let order = self.orders.order(self.now, &self.seen);
        self.orders.observe(self.now, &self.seen);
        order
    }

    fn hears(&mut self, event: &Event) {
        self.orders.event(event, &self.seen);
    }

    fn take_off(&mut self) -> Answer {
        let (reply, answer) = oneshot::channel();
        self.orders.take_off(self.now, &self.seen, reply);
        answer
    }

    fn land(&mut self) -> Answer {
        let (reply, answer) = oneshot::channel();
        self.orders.land(self.now, reply);
        answer
    }
}

fn order(flight: FlightOrder) -> Order {
    Order { flight, motion: Motion::Hover }
}

#[test]
fn a_take_off_is_ordered_behind_a_landing_and_only_until_the_drone_flies() {
    let mut bench = Bench::new();
    assert_eq!(bench.tick(), Order::LAND);
    let mut answer = bench.take_off();
    // The session accepts a take-off as new only after a landing order.
    assert_eq!(bench.tick(), Order::LAND);
    assert_eq!(bench.tick(), order(FlightOrder::TakeOff));
    bench.says(DroneState::FLYING, ControlState::TakingOff);
    assert_eq!(bench.tick(), order(FlightOrder::StayAirborne));
    assert!(answer.try_recv().is_err() && !bench.orders.is_airborne());
    bench.says(DroneState::FLYING, ControlState::Hovering);
    bench.tick();
    assert_eq!(answer.try_recv(), Ok(Ok(())));
    assert!(bench.orders.is_airborne());
    assert_eq!(bench.take_off().try_recv(), Ok(Ok(())), "it hovers already");
}

#[test]
fn a_drone_that_must_not_take_off_is_not_ordered_to() {
    let empty = DroneState::empty();
    for (ready, state, control_state, refusal) in [
        (false, empty, ControlState::Landed, Refusal::NotReady),
        (true, DroneState::EMERGENCY, ControlState::Landed, Refusal::Emergency),
        (true, DroneState::FLYING, ControlState::Flying, Refusal::Landing),
        (true, empty, ControlState::Landing, Refusal::Landing),
        (true, DroneState::BATTERY_LOW, ControlState::Landed, Refusal::BatteryLow),
    ] {
        let mut bench = Bench::new();
        bench.seen.ready = ready;
        bench.says(state, control_state);
        assert_eq!(bench.take_off().try_recv(), Ok(Err(FlightError::Refused(refusal))));
        assert!((0..3).all(|_| bench.tick() == Order::LAND), "{refusal}");
    }
}

#[test]
fn whatever_ends_a_take_off_orders_the_landing_and_is_reported() {
    let timed_out =
        FlightError::TakeOffTimedOut { limit: LIMITS.take_off, battery_percent: Some(15) };
    for (event, error) in [
        (Event::LinkLost, FlightError::LinkLost),
        (Event::DroneRestarted, FlightError::DroneRestarted),
        (Event::Emergency, FlightError::Emergency),
        (Event::Landed, FlightError::Landing),
        (Event::TakeOffTimedOut, timed_out.clone()),
    ] {
        let mut bench = Bench::new();
        bench.seen.battery_percent = Some(15);
        let mut answers = [bench.take_off(), bench.take_off()];
        bench.tick();
        assert_eq!(bench.tick(), order(FlightOrder::TakeOff));
        bench.hears(&event);
        for answer in &mut answers {
            assert_eq!(answer.try_recv(), Ok(Err(error.clone())));
        }
        assert_eq!(bench.tick(), Order::LAND, "{event:?}");
    }
    // The client's own limit applies even without an event of the session.
    let mut bench = Bench::new();
    bench.seen.battery_percent = Some(15);
    let mut answer = bench.take_off();
    let begun = bench.now;
    while bench.tick() == Order::LAND || bench.now < begun + LIMITS.take_off {
        assert!(answer.try_recv().is_err());
    }
    assert_eq!(answer.try_recv(), Ok(Err(timed_out)));
    assert_eq!(bench.tick(), Order::LAND);
    // A drone that waits to be configured again has lost the connection.
    let mut bench = Bench::new();
    let mut answer = bench.take_off();
    bench.seen.ready = false;
    bench.tick();
    assert_eq!(answer.try_recv(), Ok(Err(FlightError::LinkLost)));
}

#[test]
fn a_take_off_for_which_nobody_waits_any_more_is_given_up() {
    let mut bench = Bench::new();
    let (first, mut second) = (bench.take_off(), bench.take_off());
    bench.tick();
    drop(first);
    assert_eq!(bench.tick(), order(FlightOrder::TakeOff), "one waits");
    second.close();
    bench.tick();
    assert_eq!(bench.tick(), Order::LAND);
    // A caller that stops waiting before the task has seen the order does not want it.
    let (reply, answer) = oneshot::channel();
    drop(answer);
    bench.orders.take_off(bench.now, &bench.seen, reply);
    assert!((0..3).all(|_| bench.tick() == Order::LAND));
}

#[test]
fn a_landing_overrules_a_take_off_and_ends_when_the_drone_is_down_for_sure() {
    let mut bench = Bench::new();
    let mut taking_off = bench.take_off();
    bench.tick();
    bench.tick();
    let mut landing = bench.land();
    assert_eq!(taking_off.try_recv(), Ok(Err(FlightError::Landing)));
    // It is on the ground, but may be about to take off.
    for _ in 0..10 {
        assert_eq!(bench.tick(), Order::LAND);
    }
    assert!(landing.try_recv().is_err());
    bench.says(DroneState::FLYING, ControlState::TakingOff);
    bench.now += SETTLE;
    bench.tick();
    assert!(landing.try_recv().is_err());
    bench.says(DroneState::empty(), ControlState::Landing);
    bench.tick();
    assert!(landing.try_recv().is_err(), "nearly");
    bench.says(DroneState::empty(), ControlState::Landed);
    bench.silent_tick();
    bench.tick();
    assert_eq!(landing.try_recv(), Ok(Ok(())));
}

#[test]
fn a_landing_is_judged_by_what_was_heard_after_it() {
    let mut bench = Bench::new();
    bench.tick();
    bench.now += SETTLE;
    let mut landing = bench.land();
    bench.silent_tick();
    assert!(landing.try_recv().is_err(), "the newest packet is older");
    bench.tick();
    assert_eq!(landing.try_recv(), Ok(Ok(())));
}

#[test]
fn a_landing_that_fails_stays_ordered() {
    let timed_out = FlightError::LandingTimedOut { limit: LIMITS.landing };
    for (event, error) in [
        (Some(Event::LinkLost), FlightError::LinkLost),
        (Some(Event::DroneRestarted), FlightError::DroneRestarted),
        (Some(Event::Emergency), FlightError::Emergency),
        (None, timed_out),
    ] {
        let mut bench = Bench::airborne();
        let mut landing = bench.land();
        match event {
            Some(event) => bench.hears(&event),
            None => bench.now += LIMITS.landing,
        }
        bench.tick();
        assert_eq!(landing.try_recv(), Ok(Err(error.clone())));
        assert_eq!(bench.tick(), Order::LAND, "{error}");
    }
    // A drone that has cut its motors, or is silent, does not land.
    let mut bench = Bench::new();
    bench.says(DroneState::EMERGENCY, ControlState::Default);
    let mut landing = bench.land();
    bench.tick();
    assert_eq!(landing.try_recv(), Ok(Err(FlightError::Emergency)));
    bench.seen.alive = false;
    let mut landing = bench.land();
    bench.tick();
    assert_eq!(landing.try_recv(), Ok(Err(FlightError::LinkLost)));
}

#[test]
fn steering_ends_by_itself_and_with_the_flight() {
    let motion = super::super::Steering::forward(0.5).motion();
    let steered = Order { flight: FlightOrder::StayAirborne, motion };
    let mut bench = Bench::new();
    bench.orders.steer(bench.now, MS(10_000), motion);
    assert_eq!(bench.tick(), Order::LAND, "it stands");
    let mut bench = Bench::airborne();
    bench.orders.steer(bench.now, MS(150), motion);
    let ticks = std::iter::from_fn(|| (bench.tick() == steered).then_some(())).count();
    assert_eq!(ticks, 2, "60 ms each on this bench, and the limit is exclusive");
    assert_eq!(bench.tick(), order(FlightOrder::StayAirborne));
    bench.orders.steer(bench.now, MS(10_000), motion);
    bench.orders.steer(bench.now, Duration::ZERO, Motion::Hover);
    assert_eq!(bench.tick(), order(FlightOrder::StayAirborne), "hover ends it");
    bench.orders.steer(bench.now, Duration::MAX, motion);
    bench.hears(&Event::Landed);
    assert_eq!(bench.tick(), Order::LAND);
    bench.says(DroneState::empty(), ControlState::Landed);
    let _answer = bench.take_off();
    bench.tick();
    bench.says(DroneState::FLYING, ControlState::Hovering);
    bench.tick();
    assert_eq!(bench.tick(), order(FlightOrder::StayAirborne), "an old wish is forgotten");
}

#[test]
fn a_cut_and_its_reset_end_by_the_drones_word_or_at_the_limit() {
    type Ask = fn(&mut Orders, Duration, Reply);
    let cases: [(Ask, DroneState); 2] =
        [(Orders::stop, DroneState::EMERGENCY), (Orders::reset, DroneState::empty())];
    for (ask, reached) in cases {
        let mut bench = Bench::airborne();
        let asked = |bench: &mut Bench| {
            let (reply, answer) = oneshot::channel();
            ask(&mut bench.orders, bench.now, reply);
            answer
        };
        bench.says(reached ^ DroneState::EMERGENCY, ControlState::Default);
        let mut answer = asked(&mut bench);
        bench.tick();
        assert!(answer.try_recv().is_err());
        bench.says(reached, ControlState::Default);
        bench.tick();
        assert_eq!(answer.try_recv(), Ok(Ok(())));
        bench.says(reached ^ DroneState::EMERGENCY, ControlState::Default);
        let mut answer = asked(&mut bench);
        bench.now += EMERGENCY_LIMIT;
        bench.tick();
        let limit = EMERGENCY_LIMIT;
        assert_eq!(answer.try_recv(), Ok(Err(FlightError::EmergencyTimedOut { limit })));
        let mut answer = asked(&mut bench);
        bench.hears(&Event::LinkLost);
        assert_eq!(answer.try_recv(), Ok(Err(FlightError::LinkLost)));
    }
    let mut bench = Bench::new();
    let mut taking_off = bench.take_off();
    let (reply, _answer) = oneshot::channel();
    bench.orders.stop(bench.now, reply);
    assert_eq!(taking_off.try_recv(), Ok(Err(FlightError::Emergency)));
    assert_eq!(bench.tick(), Order::LAND);
}

#[derive(Debug, Clone, Copy)]
enum Step {
    TakeOff,
    Land,
    Stop,
    Reset,
    Say(DroneState, ControlState, bool),
    Hear(usize),
    Silence,
}

fn step() -> impl Strategy<Value = Step> {
    let state = prop_oneof![
        Just(DroneState::empty()),
        Just(DroneState::FLYING),
        Just(DroneState::EMERGENCY),
        Just(DroneState::BATTERY_LOW)
    ];
    let says = (state, 0_u16..10, any::<bool>()).prop_map(|(state, control, ready)| {
        Step::Say(state, ControlState::from_number(control), ready)
    });
    prop_oneof![
        1 => Just(Step::TakeOff),
        1 => Just(Step::Land),
        1 => Just(Step::Stop),
        1 => Just(Step::Reset),
        4 => says,
        1 => (0..5_usize).prop_map(Step::Hear),
        1 => Just(Step::Silence),
    ]
}

proptest! {
    /// Random orders and events.
    #[test]
    fn everybody_is_answered_in_time_and_nothing_flies_unasked(
        steps in proptest::collection::vec(step(), 1..60)
    ) {
        let events = [
            Event::LinkLost,
            Event::DroneRestarted,
            Event::Emergency,
            Event::Landed,
            Event::TakeOffTimedOut,
        ];
        let mut bench = Bench::new();
        let mut answers = Vec::new();
        let mut asked_to_fly = false;
        for step in steps {
            let (reply, answer) = oneshot::channel();
            match step {
                Step::TakeOff => {
                    asked_to_fly = true;
                    answers.push(bench.take_off());
                }
                Step::Land => {
                    asked_to_fly = false;
                    answers.push(bench.land());
                }
                Step::Stop => {
                    asked_to_fly = false;
                    bench.orders.stop(bench.now, reply);
                    answers.push(answer);
                }
                Step::Reset => {
                    bench.orders.reset(bench.now, reply);
                    answers.push(answer);
                }
                Step::Say(state, control_state, ready) => {
                    bench.seen.ready = ready;
                    bench.says(state, control_state);
                }
                Step::Hear(event) => {
                    asked_to_fly = false;
                    bench.hears(&events[event]);
                }
                Step::Silence => bench.now += MS(500),
            }
            prop_assert!(asked_to_fly || bench.tick() == Order::LAND);
        }
        bench.now += LIMITS.landing;
        bench.silent_tick();
        for mut answer in answers {
            prop_assert!(answer.try_recv().is_ok());
        }
    }
}
