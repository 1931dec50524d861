//! Property test: several operators at once, with full queues and a stalled disk, can neither delay a landing
//! nor override the controls.

use ardrone_link::WAKE_UP;
use ardrone_link::session::FlightOrder;
use ardrone_link::settings::Camera;
use autopilot::agent::AgentCommand;
use autopilot::plan::{Commands, Plan};
use autopilot::vehicle::{
    Input, Operator, OperatorOrder, Output, Phase, Place, Refused, Station, TICK, Transmit,
    Vehicle, VehicleConfig, VehicleName,
};
use kinematics::{Pose, Sticks};
use mock_drone::{World, WorldConfig};
use proptest::prelude::*;

use super::orders::{Orders, Request};
use crate::drive::{handle, input};
use crate::recording::Recorder;
use crate::runtime::Ending;

const LOCAL: Operator = Operator::TERMINAL;
const PAGE: Operator = Operator { station: Station::Browser, number: 1, local: false };
const STATION: Operator = Operator { station: Station::Mavlink, number: 1, local: false };

fn plan(text: &str) -> Plan {
    Plan::parse("plan", text).unwrap()
}

/// Any order.
fn order() -> impl Strategy<Value = OperatorOrder> {
    let stick = -1.0..1.0_f64;
    prop_oneof![
        Just(OperatorOrder::Load(plan("takeoff\ngoto 0 2 0 0\ngoto 1 0 0.5 90\nland\n"))),
        Just(OperatorOrder::Append(Commands::parse("command", "moveBy 0 0.5 0 0").unwrap())),
        Just(OperatorOrder::Clear),
        any::<bool>().prop_map(|when_ready| OperatorOrder::Start { when_ready }),
        Just(OperatorOrder::Hold),
        Just(OperatorOrder::Resume),
        (stick.clone(), stick).prop_map(|(roll, gaz)| OperatorOrder::Steer(Sticks {
            roll,
            gaz,
            ..Sticks::default()
        })),
        (-2.0..2.0, -2.0..2.0).prop_map(|(x_m, y_m)| OperatorOrder::GoTo(Place::at(x_m, y_m))),
        Just(OperatorOrder::Land),
        Just(OperatorOrder::Recover),
        Just(OperatorOrder::Camera { camera: Camera::Bottom }),
        Just(OperatorOrder::Take),
        Just(OperatorOrder::Release),
    ]
}

/// Time, operator and order; and whether the queue is full of other orders then.
fn orders() -> impl Strategy<Value = Vec<(u64, Operator, OperatorOrder, bool)>> {
    let operator = prop_oneof![Just(LOCAL), Just(PAGE), Just(STATION)];
    proptest::collection::vec((0..600_u64, operator, order(), any::<bool>()), 1..40).prop_map(
        |mut orders| {
            orders.sort_by_key(|(tick, ..)| *tick);
            orders
        },
    )
}

/// Model of the rules for the controls.
#[derive(Default)]
struct Rules {
    holder: Option<Operator>,
}

impl Rules {
    /// The holder of the controls, if the order must be refused because of who gave it.
    fn refuses(&mut self, by: Operator, order: &OperatorOrder) -> Option<Operator> {
        match (self.holder, order) {
            (_, OperatorOrder::Release) => {
                self.holder = self.holder.filter(|holder| *holder != by);
                None
            }
            // It takes no controls.
            (holder, OperatorOrder::Camera { .. }) => {
                holder.filter(|holder| *holder != by && !by.local)
            }
            (Some(holder), OperatorOrder::Hold | OperatorOrder::Land | OperatorOrder::Cut) => {
                self.holder = Some(if by.local && !holder.local { by } else { holder });
                None
            }
            (Some(holder), _) if holder != by && !by.local => Some(holder),
            _ => {
                self.holder = Some(by);
                None
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn nothing_delays_a_landing_and_no_remote_operator_overrules_a_local_one(
        script in orders(), landing in 60..600_u64, lander in prop_oneof![Just(LOCAL), Just(STATION)],
    ) {
        let (orders, controls) = Orders::new(VehicleName::default(), Ending::default().begin_flight());
        let mut recorder = Recorder::stalled();
        let mut vehicle = Vehicle::flying(
            plan("takeoff\nsetStayTime 60\ngoto 0 1 0 0\nland\n"), &VehicleConfig::default(),
        ).unwrap();
        let mut world = World::new(&WorldConfig::default());
        let mut rules = Rules { holder: Some(LOCAL) };
        let mut script = script.into_iter().peekable();
        for tick in 0..900_u64 {
            let now = TICK * u32::try_from(tick).unwrap();
            let (mut landed_by_order, mut is_full) = (tick == landing, false);
            while let Some((_, by, order, full)) = script.next_if(|(at, ..)| *at <= tick) {
                landed_by_order |= order == OperatorOrder::Land;
                is_full |= full;
                if full {
                    // A page that floods the queue.
                    while controls.order(PAGE, OperatorOrder::Hold).is_ok() {}
                }
                let sent = controls.order(by, order.clone());
                prop_assert!(sent.is_ok() || is_full && order != OperatorOrder::Land, "{sent:?}");
            }
            if tick == landing {
                prop_assert_eq!(controls.order(lander, OperatorOrder::Land), Ok(()));
            }
            for Request { by, order, .. } in orders.poll() {
                let refuses = rules.refuses(by, &order);
                let order = Input::Order(by, order);
                let answer =
                    handle(&mut vehicle, now, order, |at, passed| recorder.pass(at, &passed));
                let held = match &answer {
                    Err(Refused::ControlsHeld(holder)) => Some(*holder),
                    _ => None,
                };
                prop_assert_eq!(held, refuses);
            }
            world.advance(now);
            while let Some(message) = world.receive(now) {
                _ = vehicle.handle(now, input(&message));
            }
            prop_assert_eq!(vehicle.handle(now, Input::Tick), Ok(()));
            while let Some(output) = vehicle.poll() {
                match output {
                    Output::Transmit(Transmit::Command { datagram, decision }) => {
                        world.send_at(now, datagram);
                        // The landing must be in effect in the tick that handled the order: the drone's own
                        // landing, or in wind the agent's descent.
                        if let Some(decision) = decision.filter(|_| landed_by_order) {
                            let descends = decision.phase == Phase::Landing
                                && matches!(decision.wanted, AgentCommand::GoTo(low) if low.z_m < 0.4);
                            let lands = decision.order.flight == FlightOrder::Land;
                            prop_assert!(lands || descends, "{:?}", decision);
                        }
                    }
                    Output::Transmit(Transmit::WakeUp) => world.send_wake_up(now, &WAKE_UP),
                    Output::Telemetry(_) => {}
                }
            }
            let Pose { z_m, .. } = vehicle.status(now).pose.unwrap_or_default();
            prop_assert!(z_m < 3.4, "{z_m}");
        }
    }
}
