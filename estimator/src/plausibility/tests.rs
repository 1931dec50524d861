use super::*;

const FINE: Verdict = Verdict {
    rejected: None,
    noisy: None,
    unresponsive: None,
    step: None,
    near_ground: false,
    flow_rests: false,
    asked_rise_m: 0.0,
    asked_turn_deg: 0.0,
    lateness_s: 0.0,
};
const PERIOD_S: f64 = 0.066;

/// All quantities vary slightly.
fn flying(step: u32) -> Sample {
    let wobble = 0.001 * f64::from(step % 7);
    Sample {
        yaw_deg: 10.0 + wobble,
        roll_deg: wobble,
        pitch_deg: -wobble,
        velocity_forward_m_s: wobble,
        velocity_right_m_s: 0.2 - wobble,
        altitude_m: 1.0 + wobble,
        airborne: true,
        ..Sample::default()
    }
}

/// The trust after each of some packets, and when navdata were last plausible.
fn watch(
    packets: u32,
    sample: impl Fn(u32) -> Sample,
    verdict: impl Fn(u32) -> Verdict,
) -> Vec<(f64, Trust, f64)> {
    let mut plausibility = Plausibility::default();
    (0..packets)
        .map(|step| {
            let at_s = PERIOD_S * f64::from(step);
            plausibility.watch(at_s, &sample(step), &verdict(step));
            (at_s, plausibility.trust(), plausibility.sound_at_s().unwrap_or(-1.0))
        })
        .collect()
}

fn first_distrust(watched: &[(f64, Trust, f64)]) -> Option<(f64, Trust)> {
    watched.iter().find(|(_, trust, _)| *trust != Trust::Sound).map(|(s, trust, _)| (*s, *trust))
}

#[test]
fn one_quantity_that_repeats_its_value_is_frozen() {
    type Freeze = fn(&mut Sample);
    let still: [(Quantity, Freeze, f64); 6] = [
        (Quantity::Velocity, |s| s.velocity_forward_m_s = 0.0, FROZEN_TIME_S),
        (Quantity::Velocity, |s| s.velocity_right_m_s = 1.2, FROZEN_TIME_S),
        (Quantity::Altitude, |s| s.altitude_m = 1.0, QUIET_FROZEN_TIME_S),
        (Quantity::Heading, |s| s.yaw_deg = 3.0, QUIET_FROZEN_TIME_S),
        (Quantity::Attitude, |s| s.roll_deg = 3.0, QUIET_FROZEN_TIME_S),
        (Quantity::Attitude, |s| s.pitch_deg = 3.0, QUIET_FROZEN_TIME_S),
    ];
    for (quantity, freeze, patience_s) in still {
        let sample = |step| {
            let mut sample = flying(step);
            if step >= 100 {
                freeze(&mut sample);
            }
            sample
        };
        let watched = watch(150, sample, |_| FINE);
        let (at_s, trust) = first_distrust(&watched).unwrap();
        assert_eq!(trust, Trust::Frozen(quantity));
        let after_s = at_s - 100.0 * PERIOD_S;
        assert!((patience_s..patience_s + 2.0 * PERIOD_S).contains(&after_s), "{after_s}");
        let (_, _, sound_at_s) = watched[149];
        assert!((sound_at_s - 100.0 * PERIOD_S).abs() < 1e-9, "sound until it froze");
    }
    assert_eq!(first_distrust(&watch(150, flying, |_| FINE)), None);
}

#[test]
fn an_altitude_that_repeats_during_a_climb_is_noticed_sooner() {
    let still = |step| Sample { altitude_m: 1.0, ..flying(step) };
    let climbing = |step| Verdict { asked_rise_m: 0.03 * f64::from(step), ..FINE };
    let (at_s, trust) = first_distrust(&watch(40, still, climbing)).unwrap();
    assert_eq!(trust, Trust::Frozen(Quantity::Altitude));
    assert!(at_s < 0.5, "{at_s}");
}

#[test]
fn a_drone_on_the_ground_may_stand_still() {
    assert_eq!(first_distrust(&watch(100, |_| Sample::default(), |_| FINE)), None);
    let spinning_up = |_| Sample { airborne: true, ..Sample::default() };
    let near_ground = |_| Verdict { near_ground: true, ..FINE };
    assert_eq!(first_distrust(&watch(100, spinning_up, near_ground)), None);
}

#[test]
fn what_no_drone_does_is_impossible() {
    assert_eq!(impossible(&flying(0)), None);
    for bad in [f64::NAN, f64::INFINITY, 1e6, -500.0] {
        let with = |change: fn(&mut Sample, f64)| {
            let mut sample = flying(0);
            change(&mut sample, bad);
            impossible(&sample)
        };
        assert_eq!(with(|s, bad| s.altitude_m = bad), Some(Quantity::Altitude));
        assert_eq!(with(|s, bad| s.velocity_right_m_s = bad), Some(Quantity::Velocity));
        assert_eq!(with(|s, bad| s.velocity_forward_m_s = bad), Some(Quantity::Velocity));
        assert_eq!(with(|s, bad| s.roll_deg = bad), Some(Quantity::Attitude));
        assert_eq!(with(|s, bad| s.pitch_deg = bad), Some(Quantity::Attitude));
        assert_eq!(with(|s, bad| s.yaw_deg = bad), Some(Quantity::Heading));
    }
}

/// The model's velocity before and after a step.
fn model(before_m_s: Vector2<f64>, after_m_s: Vector2<f64>) -> Foreseen<'static> {
    Foreseen { before_m_s, after_m_s, unheard_m_s: &[], pull_m_s2: 0.0 }
}

#[test]
fn a_velocity_that_jumps_is_not_believed_and_one_that_a_gust_changes_is() {
    let still = Vector2::zeros();
    let along = |m_s: f64| Vector2::new(m_s, 0.0);
    let mut gate = VelocityGate::default();
    assert!(gate.admits(along(0.3), &model(still, still), 0.0), "the first one");
    let mut gate = VelocityGate { last_m_s: Some(still), ..VelocityGate::default() };
    for _ in 0..10 {
        assert!(!gate.admits(along(1.0), &model(still, still), PERIOD_S), "as long as it lasts");
    }
    assert!(!gate.admits(along(0.4), &model(still, still), PERIOD_S), "not half way back");
    assert!(gate.admits(along(0.1), &model(still, still), PERIOD_S), "and no longer");
    // A gust of 2.5 m/s² that the model does not predict, and follows by two thirds.
    let (mut gate, mut model_m_s) = (VelocityGate::default(), 0.0);
    for step in 0..12 {
        let measured_m_s = 2.5 * PERIOD_S * f64::from(step);
        let foreseen = model(along(model_m_s), along(model_m_s));
        assert!(gate.admits(along(measured_m_s), &foreseen, PERIOD_S), "{step}");
        model_m_s += 0.66 * (measured_m_s - model_m_s);
    }
    // A gap allows little more, because an error that begins in it would be believed.
    for (gap_s, allowed_m_s) in [(0.1, 0.6), (0.3, 0.63), (1.0, 0.735), (2.1, 0.9), (3.1, 1.55)] {
        let mut gate = VelocityGate { last_m_s: Some(still), ..VelocityGate::default() };
        assert!(!gate.clone().admits(along(allowed_m_s + 0.01), &model(still, still), gap_s));
        assert!(gate.admits(along(allowed_m_s - 0.01), &model(still, still), gap_s));
    }
}

#[test]
fn a_velocity_after_a_silence_is_one_that_the_orders_explain_received_or_not() {
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    // It was to brake from 2 m/s to 1 m/s in half a second; without that order it would have kept its speed.
    let unheard = [None, Some(along(1.5)), Some(along(2.0))];
    let ordered = model(along(2.0), along(1.0));
    let silent = Foreseen { unheard_m_s: &unheard, ..ordered };
    // Besides noise a new wind, and along its change a share of that.
    let allowed_m_s = 0.6 + 0.4 * 0.15;
    let share_m_s = 0.15 * 0.8;
    let limits_m_s = [(ordered, 1.0 - share_m_s, 1.0 + share_m_s), (silent, 1.0 - share_m_s, 2.0)];
    for (foreseen, least_m_s, most_m_s) in limits_m_s {
        for (limit_m_s, fits) in [(allowed_m_s - 0.01, true), (allowed_m_s + 0.01, false)] {
            let admits = |m_s| gate(2.0, false).admits(m_s, &foreseen, 0.5);
            assert_eq!(admits(along(most_m_s + limit_m_s)), fits);
            assert_eq!(admits(along(least_m_s - limit_m_s)), fits);
            // Beside any velocity in between too.
            for m_s in [least_m_s, f64::midpoint(least_m_s, most_m_s), most_m_s] {
                assert_eq!(admits(Vector2::new(limit_m_s, m_s)), fits, "{m_s}");
            }
        }
    }
}

#[test]
fn a_drone_that_leans_in_a_silence_may_have_another_thrust() {
    let still = Vector2::zeros();
    // 2 m/s² for half a second, of which 0.1 s count as a gust.
    let leans = Foreseen { pull_m_s2: 2.0, ..model(still, still) };
    let allowed_m_s = 0.6 + 0.4 * 0.15 + 0.2 * 2.0 * 0.4;
    for (off_m_s, fits) in [(-0.01, true), (0.01, false)] {
        let m_s = Vector2::new(0.0, allowed_m_s + off_m_s);
        assert_eq!(gate(0.0, false).admits(m_s, &leans, 0.5), fits);
    }
}

#[test]
fn one_rejected_packet_is_no_reason_to_worry_and_many_are() {
    let bad = Verdict { rejected: Some(Quantity::Velocity), ..FINE };
    let once = |step| if step == 10 { bad } else { FINE };
    assert_eq!(first_distrust(&watch(100, flying, once)), None);
    let long = |step| if step >= 10 { bad } else { FINE };
    let (at_s, trust) = first_distrust(&watch(100, flying, long)).unwrap();
    assert_eq!(trust, Trust::Implausible(Quantity::Velocity));
    assert!((at_s - 10.0 * PERIOD_S) < 0.5, "{at_s}");
    let ends = |step| if (10..20).contains(&step) { bad } else { FINE };
    let watched = watch(100, flying, ends);
    assert_eq!(watched[50].1, trust, "the start of the fault is unknown");
    assert_eq!(watched[99].1, Trust::Sound);
}

#[test]
fn what_the_drone_says_of_itself_counts() {
    let lost =
        |step| Sample { reported_lost: (step >= 10).then_some(Quantity::Velocity), ..flying(step) };
    let (at_s, trust) = first_distrust(&watch(30, lost, |_| FINE)).unwrap();
    assert_eq!(trust, Trust::Reported(Quantity::Velocity));
    assert!((at_s - 10.0 * PERIOD_S) < 0.5, "{at_s}");
    let unresponsive = Verdict { unresponsive: Some(Quantity::Heading), ..FINE };
    let once = |step| if step == 10 { unresponsive } else { FINE };
    let watched = watch(100, flying, once);
    assert_eq!(watched[40].1, Trust::Unresponsive(Quantity::Heading), "a hover shows nothing");
    assert_eq!(watched[99].1, Trust::Sound);
}

#[test]
fn one_step_is_forgiven_and_many_are_not() {
    let stepping = |every: u32| {
        move |step: u32| Verdict {
            step: step.is_multiple_of(every).then_some(Quantity::Altitude),
            ..FINE
        }
    };
    assert_eq!(first_distrust(&watch(200, flying, stepping(150))), None);
    let (_, trust) = first_distrust(&watch(200, flying, stepping(10))).unwrap();
    assert_eq!(trust, Trust::Implausible(Quantity::Altitude));
}

#[test]
fn old_news_does_not_make_navdata_fresh() {
    let late = |step| Verdict { lateness_s: if step >= 10 { 1.0 } else { 0.0 }, ..FINE };
    let watched = watch(20, flying, late);
    assert!((watched[19].2 - 9.0 * PERIOD_S).abs() < 1e-9, "{:?}", watched[19]);
}

#[test]
fn the_limits_of_an_ar_drone_are_still_possible() {
    let with = |change: &dyn Fn(&mut Sample)| {
        let mut sample = flying(0);
        change(&mut sample);
        impossible(&sample)
    };
    for sign in [-1.0, 1.0] {
        for (possible, share) in [(true, 0.999), (false, 1.001)] {
            let expected = |quantity| (!possible).then_some(quantity);
            // 3, 4, 5: both components count.
            let m_s = sign * share * MAX_SPEED_M_S / 5.0;
            let found = with(&|s| {
                (s.velocity_forward_m_s, s.velocity_right_m_s) = (3.0 * m_s, 4.0 * m_s);
            });
            assert_eq!(found, expected(Quantity::Velocity));
            let tilt_deg = sign * share * MAX_TILT_RAD.to_degrees();
            assert_eq!(with(&|s| s.roll_deg = tilt_deg), expected(Quantity::Attitude));
            assert_eq!(with(&|s| s.pitch_deg = tilt_deg), expected(Quantity::Attitude));
            assert_eq!(with(&|s| s.yaw_deg = sign * share * 360.0), expected(Quantity::Heading));
        }
    }
    for (altitude_m, possible) in [(-1.0, true), (-1.01, false), (120.0, true), (120.1, false)] {
        let found = with(&|s| s.altitude_m = altitude_m);
        assert_eq!(found.is_none(), possible, "{altitude_m}");
    }
}

/// A gate that has seen `last_m_s`.
fn gate(last_m_s: f64, jumped: bool) -> VelocityGate {
    let last_m_s = Some(Vector2::new(0.0, last_m_s));
    VelocityGate { last_m_s, jumped, ..VelocityGate::default() }
}

#[test]
fn a_jump_is_more_than_noise_and_a_gust_beyond_the_model() {
    const STEP_S: f64 = 0.05;
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    // 0.2 m/s, plus 4 m/s² for the step.
    for (m_s, fits) in [(0.39, true), (0.41, false), (-0.39, true), (-0.41, false)] {
        let mut gate = gate(0.0, false);
        assert_eq!(gate.admits(along(m_s), &model(along(0.0), along(0.0)), STEP_S), fits, "{m_s}");
        assert_eq!(gate.has_jumped(), !fits);
    }
    // A change that the model foresees is no jump, even if the model is off by half a metre per second...
    let mut foreseen = gate(0.8, false);
    assert!(foreseen.admits(along(1.1), &model(along(0.3), along(0.6)), STEP_S));
    // ...and a change that does not come is one.
    let mut missing = gate(0.0, false);
    assert!(!missing.admits(along(0.0), &model(along(0.0), along(0.5)), STEP_S));
    // The limits themselves are admitted: of the difference to the model, and of its change.
    let mut limit = gate(-1.0, false);
    assert!(limit.admits(along(0.4), &model(along(0.0), along(0.0)), STEP_S));
    let mut limit = gate(0.0, false);
    assert!(limit.admits(along(0.4), &model(along(-1.0), along(-1.0)), STEP_S));
    // A velocity that jumps to where the model is has come back.
    let mut back = gate(2.0, false);
    assert!(back.admits(along(0.1), &model(along(0.0), along(0.0)), STEP_S));
}

#[test]
fn after_a_jump_only_half_of_the_difference_is_allowed() {
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    for (m_s, fits) in [(0.19, true), (0.2, true), (0.21, false), (-0.19, true), (-0.21, false)] {
        let mut gate = gate(0.4, true);
        assert_eq!(gate.admits(along(m_s), &model(along(0.0), along(0.0)), 0.05), fits, "{m_s}");
    }
}

#[test]
fn a_velocity_that_crept_away_from_the_model_is_rejected_in_the_end() {
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    // 1.5 m/s, plus 4 m/s² for the step.
    for (m_s, fits) in [(1.69, true), (1.71, false)] {
        let mut gate = gate(m_s, false);
        assert_eq!(gate.admits(along(m_s), &model(along(0.0), along(0.0)), 0.05), fits, "{m_s}");
        assert!(!gate.has_jumped(), "it crept");
    }
}

/// The trust at each time, in twentieths of a second.
fn watch_at(
    ticks: impl IntoIterator<Item = u32>,
    sample: impl Fn(u32) -> Sample,
    verdict: impl Fn(u32) -> Verdict,
) -> Vec<(u32, Trust, Option<f64>)> {
    let mut plausibility = Plausibility::default();
    ticks
        .into_iter()
        .map(|tick| {
            plausibility.watch(f64::from(tick) / 20.0, &sample(tick), &verdict(tick));
            (tick, plausibility.trust(), plausibility.sound_at_s())
        })
        .collect()
}

fn first_wrong(watched: &[(u32, Trust, Option<f64>)]) -> Option<u32> {
    watched.iter().find(|(_, trust, _)| *trust != Trust::Sound).map(|(tick, ..)| *tick)
}

#[test]
fn the_patience_with_a_repeated_value_ends_on_time() {
    // 0.4 s, or a second where a quiet hover may repeat the value.
    let flow = |tick| Sample { velocity_right_m_s: 0.3, ..flying(tick) };
    assert_eq!(first_wrong(&watch_at(0..40, flow, |_| FINE)), Some(8));
    let height = |tick| Sample { altitude_m: 1.0, ..flying(tick) };
    assert_eq!(first_wrong(&watch_at(0..40, height, |_| FINE)), Some(20));
    let heading = |tick| Sample { yaw_deg: 20.0, ..flying(tick) };
    assert_eq!(first_wrong(&watch_at(0..40, heading, |_| FINE)), Some(20));
    // Loss makes the time between packets long: it takes five repetitions too.
    let slow = (0..100).step_by(4);
    assert_eq!(first_wrong(&watch_at(slow, flow, |_| FINE)), Some(20));
}

#[test]
fn a_value_must_change_once_the_sticks_ask_for_enough() {
    let still = |tick| Sample { altitude_m: 1.0, yaw_deg: 20.0, ..flying(tick) };
    let asked = |rise_m: f64, turn_deg: f64| {
        let verdict = move |tick: u32| {
            // Everything before counts for nothing.
            let (before_m, before_deg) = (7.0, 300.0);
            let moves = f64::from(u8::from(tick > 0));
            Verdict {
                asked_rise_m: before_m + rise_m * moves,
                asked_turn_deg: before_deg + turn_deg * moves,
                ..FINE
            }
        };
        let watched = watch_at(0..40, still, verdict);
        (
            first_wrong(&watched),
            watched.iter().find(|(.., trust, _)| *trust != Trust::Sound).map(|w| w.1),
        )
    };
    let (altitude, heading) =
        (Some(Trust::Frozen(Quantity::Altitude)), Some(Trust::Frozen(Quantity::Heading)));
    for sign in [-1.0, 1.0] {
        assert_eq!(asked(sign * 0.049, sign * 4.9).0, Some(20));
        assert_eq!(asked(sign * 0.051, 0.0), (Some(8), altitude));
        assert_eq!(asked(0.0, sign * 5.1), (Some(8), heading));
    }
    // Exactly this much is enough.
    assert_eq!(asked(0.0, ASKED_TURN_DEG), (Some(8), heading));
    let rising =
        |tick| Verdict { asked_rise_m: if tick == 0 { 0.0 } else { ASKED_RISE_M }, ..FINE };
    assert_eq!(first_wrong(&watch_at(0..40, still, rising)), Some(8));
}

#[test]
fn a_rejected_quantity_is_distrusted_from_its_first_packet_for_four_seconds() {
    let bad = Verdict { rejected: Some(Quantity::Velocity), ..FINE };
    // Wrong from the start to 0.4 s.
    let ends = |tick: u32| if tick <= 8 { bad } else { FINE };
    let watched = watch_at(0..120, flying, ends);
    let distrusted: Vec<u32> =
        watched.iter().filter(|(_, trust, _)| *trust != Trust::Sound).map(|w| w.0).collect();
    assert_eq!(distrusted, (8..8 + 80).collect::<Vec<_>>());
    assert_eq!(watched[7].2, Some(0.35));
    assert_eq!(watched[8].2, Some(0.0), "dated from the first wrong packet");
    // A good packet in between begins the time again.
    let interrupted = |tick: u32| if tick == 4 { FINE } else { bad };
    assert_eq!(first_wrong(&watch_at(0..60, flying, interrupted)), Some(5 + 8));
}

#[test]
fn what_does_not_follow_is_distrusted_from_before_it_was_noticed() {
    let bad = Verdict { unresponsive: Some(Quantity::Altitude), ..FINE };
    let once = |tick: u32| if tick == 8 { bad } else { FINE };
    let watched = watch_at(0..140, flying, once);
    let distrusted: Vec<u32> =
        watched.iter().filter(|(_, trust, _)| *trust != Trust::Sound).map(|w| w.0).collect();
    // Noticed after 0.4 s, and distrusted for 4 s from then.
    assert_eq!((distrusted[0], distrusted.len()), (8, 72));
    let later = |tick: u32| if tick == 48 { bad } else { FINE };
    let later = watch_at(0..140, flying, later);
    assert_eq!(
        [later[119].1, later[121].1],
        [Trust::Unresponsive(Quantity::Altitude), Trust::Sound]
    );
    assert_eq!(watched[8].2, Some(0.0));
}

#[test]
fn the_drone_must_report_a_loss_for_a_while_and_only_in_flight() {
    let lost = |airborne: bool| {
        move |tick: u32| Sample {
            reported_lost: (tick < 40).then_some(Quantity::Altitude),
            airborne,
            ..flying(tick)
        }
    };
    let watched = watch_at(0..60, lost(true), |_| FINE);
    assert_eq!(first_wrong(&watched), Some(8));
    assert_eq!(watched[8].1, Trust::Reported(Quantity::Altitude));
    assert_eq!(watched[40].1, Trust::Sound, "it has it again");
    assert_eq!(first_wrong(&watch_at(0..60, lost(false), |_| FINE)), None);
    let later =
        |tick| Sample { reported_lost: (tick >= 20).then_some(Quantity::Altitude), ..flying(tick) };
    assert_eq!(first_wrong(&watch_at(0..60, later, |_| FINE)), Some(29), "1.0 to 1.4 s");
}

#[test]
fn three_steps_within_seconds_are_too_many_and_are_forgotten() {
    let stepping = |every: u32| {
        move |tick: u32| Verdict {
            step: (tick.is_multiple_of(every) && tick <= 2 * every).then_some(Quantity::Heading),
            ..FINE
        }
    };
    // Every step counts one, and a quarter is forgotten in a second.
    let watched = watch_at(0..200, flying, stepping(18));
    assert_eq!(first_wrong(&watched), Some(36));
    assert_eq!(watched[36].1, Trust::Implausible(Quantity::Heading));
    // 3 - 0.25 * 1.8 = 2.55 is below 2.5 after 0.2 s and a little.
    assert_eq!((watched[39].1, watched[41].1), (watched[36].1, Trust::Sound));
    assert_eq!(first_wrong(&watch_at(0..200, flying, stepping(22))), None);
    let each_second = (0..60).step_by(20);
    assert_eq!(first_wrong(&watch_at(each_second, flying, stepping(20))), None, "just 2.5");
}

/// The trust after each packet of a flow that hangs for a second each time, with a fifth of a second between.
fn hanging_now_and_then(times: u32) -> Vec<(f64, Trust, f64)> {
    let sample = |step: u32| {
        let mut sample = flying(step);
        if step % 18 < 15 && step < 18 * times {
            sample.velocity_forward_m_s = 0.3;
        }
        sample
    };
    watch(18 * times + 90, sample, |_| FINE)
}

#[test]
fn a_flow_that_hangs_again_and_again_is_not_believed_in_between() {
    let sound_between = |times| {
        let watched = hanging_now_and_then(times);
        (0..times)
            .map(|time| watched[(18 * time + 17) as usize].1 == Trust::Sound)
            .collect::<Vec<_>>()
    };
    assert_eq!(sound_between(1), [true]);
    assert_eq!(sound_between(6), [true, false, false, false, false, false]);
    let watched = hanging_now_and_then(6);
    let until_s = watched.iter().rev().find(|(_, trust, _)| *trust != Trust::Sound).unwrap().0;
    let last_s = 18.0 * 5.0 * PERIOD_S + 14.0 * PERIOD_S;
    assert!((-PERIOD_S..0.0).contains(&(until_s - last_s - DISPROVED_TIME_S)), "{until_s}");
}

#[test]
fn a_flow_that_hangs_now_and_then_is_forgiven() {
    // Once in ten seconds.
    let sample = |step: u32| {
        let mut sample = flying(step);
        if step % 152 < 15 {
            sample.velocity_forward_m_s = 0.3;
        }
        sample
    };
    let watched = watch(152 * 20, sample, |_| FINE);
    assert!((1..20).all(|time| watched[152 * time - 1].1 == Trust::Sound));
    assert!(first_distrust(&watched).is_some());
}

#[test]
fn navdata_are_fresh_up_to_the_usual_jitter() {
    for (lateness_s, fresh) in [(0.299, true), (MAX_LATENESS_S, true), (0.301, false)] {
        let late = |tick| Verdict { lateness_s: if tick == 5 { lateness_s } else { 0.0 }, ..FINE };
        let sound_at_s = watch_at(0..6, flying, late)[5].2;
        assert_eq!(sound_at_s == Some(0.25), fresh, "{lateness_s}");
    }
}

/// Whatever the time since the drone stood: the flow may measure nothing new while it lifts off.
#[test]
fn the_first_velocity_of_a_flight_is_compared_with_rest() {
    let admits = |speed_m_s: f64, step_s: f64| {
        let mut gate = VelocityGate::default();
        gate.rest();
        let still = Vector2::zeros();
        gate.admits(Vector2::new(0.0, speed_m_s), &model(still, still), step_s)
    };
    let allowed_m_s = JUMP_M_S + JUMP_M_S2 * LIFT_OFF_S;
    for step_s in [LIFT_OFF_S, 2.0] {
        assert!(admits(allowed_m_s - 0.01, step_s) && !admits(allowed_m_s + 0.01, step_s));
    }
    // One that is taken over in the air may have any.
    let moving = Vector2::new(0.0, 1.4);
    assert!(VelocityGate::default().admits(
        moving,
        &model(Vector2::zeros(), Vector2::zeros()),
        0.03
    ));
    // After the first velocity a gap counts.
    let mut gate = VelocityGate::default();
    gate.rest();
    let still = Vector2::zeros();
    assert!(gate.admits(still, &model(still, still), 0.03));
    assert!(gate.admits(Vector2::new(0.0, 0.65), &model(still, still), 0.5));
}
