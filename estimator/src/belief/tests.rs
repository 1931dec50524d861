use super::*;

/// Packets arrive every twentieth of a second.
const PACKET_S: f64 = 0.05;

/// What is believed after each packet, and when navdata were last sound.
fn weighed(
    packets: u32,
    evidence: impl Fn(u32) -> Option<(Quantity, Cause)>,
) -> Vec<(Trust, Option<f64>)> {
    let mut beliefs = Beliefs::new();
    (0..packets)
        .map(|packet| {
            let at_s = PACKET_S * f64::from(packet);
            let shown = evidence(packet).map(|(quantity, cause)| Evidence {
                quantity,
                cause,
                since_s: at_s,
            });
            beliefs.weigh(at_s, &[shown], true);
            (beliefs.trust(), beliefs.sound_at_s())
        })
        .collect()
}

/// The packets after which navdata are not believed.
fn distrusted(
    packets: u32,
    quantity: Quantity,
    cause: Cause,
    shows: impl Fn(u32) -> bool,
) -> Vec<u32> {
    let watched = weighed(packets, |packet| shows(packet).then_some((quantity, cause)));
    (0..packets).filter(|packet| watched[*packet as usize].0 != Trust::Sound).collect()
}

#[test]
fn one_wrong_packet_is_no_reason_to_worry_and_many_are() {
    let wrong =
        |shows: &dyn Fn(u32) -> bool| distrusted(200, Quantity::Velocity, Cause::Value, shows);
    assert_eq!(wrong(&|packet| packet == 10), []);
    // 0.4 s of wrong packets, and a moment more.
    let lasting = wrong(&|packet| packet >= 10);
    assert_eq!(lasting, (18..200).collect::<Vec<_>>());
    // Four seconds after the last one it is believed again.
    let ends = wrong(&|packet| (10..20).contains(&packet));
    assert_eq!((ends[0], ends.last()), (18, Some(&(19 + 80))));
    // Pulses, each too short to be noticed, add up.
    let pulses = wrong(&|packet| packet >= 10 && packet % 10 < 5);
    assert_eq!(pulses.first(), Some(&24));
    // Rare ones are forgotten.
    assert_eq!(wrong(&|packet| packet % 40 < 3), []);
}

#[test]
fn a_fault_is_dated_from_its_first_packet() {
    let watched =
        weighed(60, |packet| (packet >= 20).then_some((Quantity::Altitude, Cause::Value)));
    assert_eq!(watched[27], (Trust::Sound, Some(27.0 * PACKET_S)));
    assert_eq!(watched[28].0, Trust::Implausible(Quantity::Altitude));
    assert!((watched[28].1.unwrap() - 20.0 * PACKET_S).abs() < 1e-9);
    assert_eq!(watched[59].1, watched[28].1);
}

#[test]
fn a_long_gap_makes_no_fault_of_one_packet() {
    let mut beliefs = Beliefs::new();
    for at_s in [0.0, 3.0, 6.0] {
        let quantity = Quantity::Velocity;
        let evidence = Evidence { quantity, cause: Cause::Value, since_s: at_s };
        beliefs.weigh(at_s, &[Some(evidence)], true);
        assert_eq!(beliefs.trust(), Trust::Sound, "{at_s}");
    }
}

#[test]
fn a_repetition_is_wrong_while_it_lasts_and_a_second_one_for_longer() {
    let frozen =
        |shows: &dyn Fn(u32) -> bool| distrusted(200, Quantity::Attitude, Cause::Repetition, shows);
    assert_eq!(frozen(&|packet| (10..20).contains(&packet)), (10..20).collect::<Vec<_>>());
    // The second time within four seconds.
    let twice = frozen(&|packet| (10..20).contains(&packet) || (60..70).contains(&packet));
    assert_eq!(twice, (10..20).chain(60..=69 + 80).collect::<Vec<_>>());
    let rarely = frozen(&|packet| (10..20).contains(&packet) || (105..115).contains(&packet));
    assert_eq!(rarely, (10..20).chain(105..115).collect::<Vec<_>>());
}

#[test]
fn the_ends_of_two_boxes_are_forgiven_and_four_steps_within_a_second_are_not() {
    for quantity in [Quantity::Heading, Quantity::Altitude] {
        let stepping = |every: u32, times: u32| {
            distrusted(200, quantity, Cause::Step, |packet| {
                packet % every == 0 && packet < times * every
            })
        };
        assert_eq!(stepping(6, 3), []);
        assert_eq!(stepping(6, 4).first(), Some(&18));
        assert_eq!(stepping(15, 4), [], "three quarters of a second apart");
    }
}

#[test]
fn what_has_summed_up_elsewhere_is_enough_at_once() {
    for (cause, trust) in [
        (Cause::Noise, Trust::Noisy(Quantity::Heading)),
        (Cause::Response, Trust::Unresponsive(Quantity::Heading)),
    ] {
        let watched = weighed(140, |packet| (packet == 10).then_some((Quantity::Heading, cause)));
        assert_eq!((watched[9].0, watched[10].0), (Trust::Sound, trust));
        assert_eq!([watched[90].0, watched[91].0], [trust, Trust::Sound], "{cause:?}");
    }
}

#[test]
fn the_drone_must_report_a_loss_for_a_while() {
    let lost = distrusted(60, Quantity::Altitude, Cause::Report, |packet| packet >= 20);
    assert_eq!(lost.first(), Some(&28));
}

#[test]
fn of_several_causes_the_first_is_told_and_quantities_are_judged_apart() {
    let mut beliefs = Beliefs::new();
    let evidence = |quantity, cause| Some(Evidence { quantity, cause, since_s: 0.0 });
    beliefs.weigh(0.0, &[evidence(Quantity::Altitude, Cause::Response)], true);
    assert_eq!(beliefs.trust(), Trust::Unresponsive(Quantity::Altitude));
    beliefs.weigh(0.05, &[evidence(Quantity::Velocity, Cause::Noise)], true);
    assert_eq!(beliefs.trust(), Trust::Noisy(Quantity::Velocity));
    // Two that are suspect together are not one that is disproved.
    let mut beliefs = Beliefs::new();
    for packet in 0..12_u32 {
        let quantity = [Quantity::Velocity, Quantity::Altitude][packet as usize % 2];
        beliefs.weigh(PACKET_S * f64::from(packet), &[evidence(quantity, Cause::Value)], true);
        assert_eq!(beliefs.trust(), Trust::Sound, "{packet}");
    }
}

#[test]
fn old_news_does_not_make_navdata_fresh() {
    let mut beliefs = Beliefs::new();
    beliefs.weigh(0.0, &[], true);
    beliefs.weigh(0.05, &[], false);
    assert_eq!((beliefs.trust(), beliefs.sound_at_s()), (Trust::Sound, Some(0.0)));
}

#[test]
fn each_quantity_has_its_worth() {
    let mut beliefs = Beliefs::new();
    let mut worth = Vec::new();
    for packet in 0..20 {
        let at_s = PACKET_S * f64::from(packet);
        let evidence =
            Evidence { quantity: Quantity::Altitude, cause: Cause::Value, since_s: at_s };
        beliefs.weigh(at_s, &[(packet > 2).then_some(evidence)], true);
        worth.push(beliefs.worth().map(Worth::name));
    }
    assert_eq!(worth[2], ["sound"; 4]);
    assert_eq!(worth[4], ["sound", "suspect", "sound", "sound"]);
    assert_eq!(worth[19], ["sound", "implausible", "sound", "sound"]);
}
