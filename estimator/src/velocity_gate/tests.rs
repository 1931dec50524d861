use super::*;

const PERIOD_S: f64 = 0.066;

/// The model's velocity before and after a step.
fn model(before_m_s: Vector2<f64>, after_m_s: Vector2<f64>) -> Foreseen<'static> {
    Foreseen { before_m_s, after_m_s, unheard_m_s: &[] }
}

/// A gate that has seen `last_m_s`.
fn gate(last_m_s: f64, jumped: bool) -> VelocityGate {
    let last_m_s = Some(Vector2::new(0.0, last_m_s));
    VelocityGate { last_m_s, jumped, ..VelocityGate::default() }
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
    for (gap_s, allowed_m_s) in [(0.1, 0.542), (0.3, 0.712), (1.0, 0.740), (3.1, 0.740)] {
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
    // Besides noise and gusts, and along its change a share of that.
    let allowed_m_s = 0.736;
    let share_m_s = 0.2 * 0.8;
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
fn a_jump_is_more_than_noise_and_a_gust_beyond_the_model() {
    const STEP_S: f64 = 0.05;
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    // Five deviations of two measurements and a gust.
    for (m_s, fits) in [(0.43, true), (0.44, false), (-0.43, true), (-0.44, false)] {
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
    assert!(limit.admits(along(0.43), &model(along(0.0), along(0.0)), STEP_S));
    let mut limit = gate(0.0, false);
    assert!(limit.admits(along(0.43), &model(along(-1.0), along(-1.0)), STEP_S));
    // A velocity that jumps to where the model is has come back.
    let mut back = gate(2.0, false);
    assert!(back.admits(along(0.1), &model(along(0.0), along(0.0)), STEP_S));
}

#[test]
fn what_goes_on_from_one_velocity_to_the_next_pushes_the_drone() {
    let along = |m_s: f64| Vector2::new(0.6 * m_s, -0.8 * m_s);
    let still = Vector2::zeros();
    let judged = |velocities_m_s: [f64; 6]| {
        let mut gate = VelocityGate { last_m_s: Some(still), ..VelocityGate::default() };
        velocities_m_s.map(|m_s| gate.judge(along(m_s), &model(still, still), PERIOD_S))
    };
    let storm = judged([0.53, 1.06, 1.59, 2.12, 0.0, 0.0]);
    assert_eq!(storm[..3], [Judged::Rejected; 3]);
    let Judged::Pushed { by_m_s2, for_s } = storm[3] else { panic!("{storm:?}") };
    assert!((by_m_s2 - along(0.53 / PERIOD_S)).norm() < 1e-9, "{by_m_s2}");
    assert!((for_s - 4.0 * PERIOD_S).abs() < 1e-9);
    // A jump, pulses, noise.
    assert_eq!(judged([0.7; 6]), [Judged::Rejected; 6]);
    assert_eq!(judged([0.7, 0.0, 0.7, 0.0, 0.7, 0.0])[4], Judged::Rejected);
    assert_eq!(judged([0.6, -0.5, 0.7, 1.6, -0.9, 0.8]), [Judged::Rejected; 6]);
    // One that has come back meanwhile begins again.
    assert_eq!(judged([0.53, 0.0, 0.53, 1.06, 1.59, 0.0])[4], Judged::Rejected);
}

#[test]
fn after_a_jump_only_half_of_the_difference_is_allowed() {
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    for (m_s, fits) in [(0.21, true), (0.22, false), (-0.21, true), (-0.22, false)] {
        let mut gate = gate(0.4, true);
        assert_eq!(gate.admits(along(m_s), &model(along(0.0), along(0.0)), 0.05), fits, "{m_s}");
    }
}

#[test]
fn a_velocity_that_crept_away_from_the_model_is_rejected_in_the_end() {
    let along = |m_s: f64| Vector2::new(0.0, m_s);
    // 1.3 m/s beyond a jump.
    for (m_s, fits) in [(1.73, true), (1.74, false)] {
        let mut gate = gate(m_s, false);
        assert_eq!(gate.admits(along(m_s), &model(along(0.0), along(0.0)), 0.05), fits, "{m_s}");
        assert!(!gate.has_jumped(), "it crept");
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
    let allowed_m_s = 0.542;
    for step_s in [0.1, 2.0] {
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
