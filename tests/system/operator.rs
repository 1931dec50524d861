//! What an operator relies on in the page while something flies: a real Chromium, the program, the mock drone.

use serde_json::json;

use crate::chromium::{Chromium, LANDS, Tab};
use crate::processes::signal;
use crate::station::Station;

/// Their third step lasts: a browser on a busy machine sees no single moment.
const NEXT: &str = "takeoff\nsetStayTime 150\ngoto 0 0 1 0\nland\n";
const HOVER: &str = "takeoff\nsetStayTime 150\ngoto 0 1 0 0\ngoto 0 0 0 0\nland\n";

/// At rest, with the page at this address.
fn at_rest(address: &str) -> Station {
    Station::start(&["--mock", "--ui", address], &[])
}

/// Flies the mission at once.
fn flying() -> Station {
    Station::start(&["--mock", "--ui", "0", "--plan", "hover.txt"], &[("hover.txt", HOVER)])
}

fn text(chromium: &mut Chromium, tab: &Tab, selector: &str) -> String {
    let text = format!("document.querySelector('{selector}').textContent");
    chromium.evaluate(tab, &text).as_str().unwrap().to_owned()
}

/// After a cut in the air the page says what happened and what to do, is heard, and leads back to a drone that can start.
#[test]
fn an_emergency_cannot_be_missed_and_ends_with_two_clicks() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = at_rest("0");
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    let load = format!("order({})", json!({ "order": "load", "name": "hover", "plan": HOVER }));
    chromium.evaluate(&tab, &load);
    chromium.wait(&tab, "flight.plan === 'hover'");
    chromium.click(&tab, "[data-show=fly]", [0.0; 2]);
    chromium.wait(&tab, "document.querySelector('#start').classList.contains('prime')");
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#recover').disabled"), true);
    chromium.click(&tab, "#start", [0.0; 2]);
    chromium.wait(&tab, "status.phase === 'flying' && status.pose.z_m > 0.5");
    chromium.wait(&tab, "document.querySelector('#land').classList.contains('prime')");
    let emergency = "document.querySelector('#alarm').innerText.startsWith('EMERGENCY')";
    chromium.confirm(&tab, "#cut", emergency);
    chromium.wait(&tab, "document.querySelector('#phase').textContent === 'EMERGENCY'");
    chromium.wait(&tab, "document.querySelector('#alarm').textContent.includes('Recover')");
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#bar').className"), "alarm");
    let heard = chromium.evaluate(&tab, "dangers.heard().includes('alarm')");
    assert_eq!(heard, true);
    for button in ["land", "start"] {
        let bright = format!("document.querySelector('#{button}').classList.contains('prime')");
        chromium.wait(&tab, &format!("!{bright}"));
    }
    chromium.wait(&tab, "document.querySelector('#recover').classList.contains('prime')");
    // All of it is seen at once, on a telephone too.
    for size in [[390, 844], [1400, 860]] {
        chromium.look(&tab, size, "light");
        let alarm = "{ const alarm = document.querySelector('#alarm'); [alarm.scrollHeight, alarm.clientHeight].join() }";
        let heights = chromium.evaluate(&tab, alarm);
        let (needed, had) = heights.as_str().unwrap().split_once(',').unwrap();
        assert!(needed.parse::<u32>().unwrap() <= had.parse().unwrap(), "{heights} at {size:?}");
    }
    chromium.picture(&tab, "emergency");
    // One click asks, and two do.
    chromium.watch(&tab, "#recover");
    chromium.click(&tab, "#recover", [0.0; 2]);
    chromium.wait(&tab, "shown.length === 2 && shown[0].startsWith('Again')");
    assert_eq!(chromium.evaluate(&tab, "status.emergency"), true);
    chromium.confirm(&tab, "#recover", "!status.emergency");
    // What was warned of is over with it.
    let warned = "dangers.draw(); document.querySelector('#alarm').textContent";
    let hidden = "document.querySelector('#alarm').hidden";
    let warned = chromium.evaluate(&tab, warned);
    assert_eq!(chromium.evaluate(&tab, hidden), true, "{warned}");
    chromium.wait(&tab, "!document.querySelector('#start').disabled");
    // The next flight has heights of its own, and no line from the one before.
    let places = chromium.evaluate(&tab, "trail.length").as_u64().unwrap();
    assert!(places > 5, "{places}");
    chromium.click(&tab, "#start", [0.0; 2]);
    chromium.wait(&tab, &format!("trailOfFlight >= {places} && status.flight_time_s > 0"));
    let drawn = "trail = [[0, 0, 0], [0.1, 0, 0], [3, 0, 0], [3.1, 0, 0]]; map.draw(); \
        document.querySelector('#trail').getAttribute('d').replace(/[^ML]/g, '')";
    assert_eq!(chromium.evaluate(&tab, drawn), "MLML");
    // Of each second the highest age of the navdata is drawn and told.
    let age = "[...document.querySelectorAll('#plots figcaption')].find((it) => it.textContent.startsWith('age')).textContent";
    let ages = format!(
        "show('plots'); for (const [at, age] of [[9000.1, 0.01], [9000.2, 0.09], [9000.3, 0.02]]) \
         plots.add({{ ...status, t_s: at, navdata_age_s: age }}); \
         document.querySelector('#pauseplots').click(); plots.draw(); {age}"
    );
    let ages = chromium.evaluate(&tab, &ages);
    assert!(ages.as_str().unwrap().contains(" 90 "), "{ages}");
    // Help that was asked for is no error.
    chromium.evaluate(&tab, "show('fly'); document.querySelector('#typed').value = 'help'; document.querySelector('#typing').requestSubmit(); true");
    chromium.wait(&tab, "document.querySelector('#answer').textContent.includes('resume')");
    let colour = |chromium: &mut Chromium, of: &str| {
        chromium.evaluate(&tab, &format!("getComputedStyle(document.querySelector('{of}')).color"))
    };
    assert_eq!(colour(&mut chromium, "#answer"), colour(&mut chromium, "body"));
}

/// The largest sum of layout shifts within five seconds, as Chromium's own figure, and what moved.
const SHIFTS: &str = "window.shifts = []; new PerformanceObserver((list) => { \
    for (const entry of list.getEntries()) if (!entry.hadRecentInput) shifts.push([entry.startTime, entry.value, \
    ...entry.sources.map(({ node }) => node?.id || node?.parentElement?.id || node?.nodeName)]); \
    }).observe({ type: 'layout-shift' }); window.cls = () => Math.max(0, ...shifts.map(([from]) => \
    shifts.filter(([at]) => at >= from && at < from + 5000).reduce((sum, [, value]) => sum + value, 0))); true";

/// A plan that is loaded while the drone lands is for the next flight: nothing of it is shown as done, whatever was flown.
#[test]
fn a_plan_that_comes_while_the_drone_lands_is_shown_as_not_begun() {
    let Some(mut chromium) = Chromium::start() else { return };
    let shown = "drawSteps(); [...document.querySelectorAll('#steps > *')].map((item) => item.className).join()";
    let load = |name: &str, plan: &str| {
        format!("order({})", json!({ "order": "load", "name": name, "plan": plan }))
    };
    let replaced = |chromium: &mut Chromium, tab: &Tab| {
        let climbs = "status?.phase === 'flying' && status.step === 2 && status.pose.z_m > 0.7";
        chromium.wait(tab, climbs);
        assert_eq!(chromium.evaluate(tab, shown), "done,done,now,,");
        let lands = "take({ ...status, phase: 'landing', step: null })";
        assert_eq!(
            chromium.evaluate(tab, &format!("{lands}; {shown}")),
            "done,,,,",
            "it is given up"
        );
        // By the page itself: a landing is over soon.
        let late = format!(
            "order({{ order: 'land' }}); window.late = setInterval(() => {{ \
             if (!status.landing) return; clearInterval(late); {}; }}, 10); true",
            load("next", NEXT)
        );
        chromium.evaluate(tab, &late);
        chromium.wait(tab, "flight.plan === 'next' && !!status");
        assert_eq!(chromium.evaluate(tab, shown), ",,,");
    };
    // The program's only flight.
    {
        let station = flying();
        let tab = chromium.open(&station.url);
        replaced(&mut chromium, &tab);
        chromium.wait(&tab, "!!over");
        assert_eq!(chromium.evaluate(&tab, "over.includes('1 of 5 steps')"), true);
        assert_eq!(chromium.evaluate(&tab, shown), ",,,");
    }
    // One of several.
    let station = at_rest("0");
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    chromium.evaluate(&tab, &load("hover", HOVER));
    chromium.wait(&tab, "flight.plan === 'hover' && !!status");
    chromium.evaluate(&tab, "order({ order: 'start' })");
    replaced(&mut chromium, &tab);
    chromium.wait(&tab, "status.phase === 'standby'");
    chromium.evaluate(&tab, "order({ order: 'start' })");
    chromium.wait(&tab, "status.phase === 'flying' && status.step === 2");
    assert_eq!(chromium.evaluate(&tab, shown), "done,done,now,");
    // From its start on it counts.
    signal(&station.child, "-INT");
    chromium.wait(&tab, "!!over");
    assert_eq!(chromium.evaluate(&tab, "over.includes('1 of 4 steps')"), true);
    assert_eq!(chromium.evaluate(&tab, shown), "done,,,");
}

/// Whatever is said in a flight, nothing moves: neither the buttons nor anything else, on large and on small screens.
#[test]
fn nothing_moves_under_the_cursor() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = at_rest("0");
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    for size in [[1400, 860], [390, 844]] {
        chromium.look(&tab, size, "light");
        let load = format!("order({})", json!({ "order": "load", "name": "hover", "plan": HOVER }));
        chromium.evaluate(&tab, &load);
        chromium.wait(&tab, "flight.plan === 'hover' && status.phase === 'standby'");
        chromium.evaluate(&tab, "show('fly')");
        std::thread::sleep(std::time::Duration::from_secs(1));
        chromium.evaluate(&tab, SHIFTS);
        let places = "JSON.stringify([...document.querySelectorAll('footer button, #recover, nav button')] \
            .map((button) => { const box = button.getBoundingClientRect(); return [button.id, box.x, box.y, box.width]; }))";
        let before = chromium.evaluate(&tab, places);
        let order = |chromium: &mut Chromium, what: &str, until: &str| {
            chromium.evaluate(&tab, &format!("order({{ order: '{what}' }})"));
            chromium.wait(&tab, until);
            assert_eq!(chromium.evaluate(&tab, places), before, "{what} at {size:?}");
        };
        order(&mut chromium, "start", "status.phase === 'flying' && status.pose.z_m > 0.7");
        order(&mut chromium, "hold", "status.mission_waits");
        order(&mut chromium, "resume", "!status.mission_waits");
        // Messages of every kind, however long.
        let long = "what nobody has said so far and what takes more than a line to say, ".repeat(3);
        let say = format!(
            "take({{ type: 'event', t_s: 1, warning: true, text: '{long}' }}); \
             take({{ type: 'refused', order: 'hold', reason: '{long}' }}); \
             take({{ type: 'status', ...status, emergency: true, landing: '{long}', contradicted_by: 'a tag', \
             battery_percent: 5, controls: '{long}', navdata_age_s: 3 }})"
        );
        for _ in 0..20 {
            chromium.evaluate(&tab, &say);
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
        assert_eq!(chromium.evaluate(&tab, places), before, "{size:?}");
        order(&mut chromium, "land", "status.phase === 'standby'");
        let shift = chromium.evaluate(&tab, "cls()").as_f64().unwrap();
        assert!(shift < 0.02, "{shift}: {}", chromium.evaluate(&tab, "JSON.stringify(shifts)"));
    }
    let twice = "{ const all = [...document.querySelectorAll('[id]')].map(({ id }) => id); \
        all.filter((id, at) => all.indexOf(id) !== at).join() }";
    assert_eq!(chromium.evaluate(&tab, twice), "", "a name that two parts have");
    // The newest event is seen by somebody who comes back from another view, and not by somebody who reads older ones.
    let far = "[document.querySelector('#events')].map((list) => list.scrollHeight - list.scrollTop - list.clientHeight)[0]";
    let more = "for (let count = 0; count < 30; count += 1) take({ type: 'event', t_s: 1, warning: false, text: 'more' })";
    chromium.evaluate(&tab, "show('plots')");
    std::thread::sleep(std::time::Duration::from_millis(300));
    chromium.evaluate(&tab, &format!("{more}; show('fly')"));
    chromium.wait(&tab, &format!("{far} < 5"));
    std::thread::sleep(std::time::Duration::from_millis(300));
    chromium.evaluate(&tab, more);
    assert!(chromium.evaluate(&tab, far).as_f64().unwrap() < 5.0);
    let up = "{ const list = document.querySelector('#events'); list.dispatchEvent(new WheelEvent('wheel')); list.scrollTop = 0; }";
    chromium.evaluate(&tab, up);
    std::thread::sleep(std::time::Duration::from_millis(300));
    chromium.evaluate(&tab, more);
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#events').scrollTop"), 0);
    let end =
        "{ const list = document.querySelector('#events'); list.scrollTop = list.scrollHeight; }";
    chromium.evaluate(&tab, end);
    // The footer of a short view is where that of a long one is.
    let bottom =
        "document.querySelector('footer').getBoundingClientRect().bottom > innerHeight - 12";
    chromium.evaluate(&tab, "show('flights'); document.querySelector('#ofplan').value = 'none'; document.querySelector('#ofplan').oninput()");
    chromium.wait(&tab, bottom);
    chromium.evaluate(&tab, "show('fly')");
    // On a telephone the camera is seen while it is flown by hand, and the buttons leave room for it.
    chromium.evaluate(&tab, "order({ order: 'start' })");
    chromium.wait(&tab, "status.phase === 'flying' && status.pose.z_m > 0.7");
    chromium.click(&tab, "#byhand", [0.0; 2]);
    chromium.picture(&tab, "by-hand-phone");
    let box_of = |chromium: &mut Chromium, selector: &str| {
        let edges = format!(
            "{{ const box = document.querySelector('{selector}').getBoundingClientRect(); [box.top, box.bottom] }}"
        );
        let edges = chromium.evaluate(&tab, &edges);
        [0, 1].map(|edge| edges[edge].as_f64().unwrap())
    };
    let [top, bottom] = box_of(&mut chromium, "footer");
    assert!(bottom - top <= 120.0, "{}", bottom - top);
    let camera = box_of(&mut chromium, ".camera");
    assert!(camera[0] >= 0.0 && camera[1] <= top, "{camera:?}, {top}");
    chromium.look(&tab, [1400, 860], "dark");
    chromium.picture(&tab, "by-hand");
}

/// Keys as in the terminal. A key that is held is one order, and the space bar holds whatever was clicked last.
#[test]
fn keys_hold_land_and_explain_themselves() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = flying();
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "status?.phase === 'flying' && status.step === 2");
    chromium.evaluate(
        &tab,
        "window.sent = []; const send = order; order = (it) => { sent.push(it.order); send(it); }; true",
    );
    chromium.strike(&tab, "?", "Slash", 0);
    chromium.wait(&tab, "document.querySelector('#keys').open");
    // Behind a dialog nothing is ordered, but to hold and to land.
    chromium.strike(&tab, "r", "KeyR", 0);
    chromium.strike(&tab, "Escape", "Escape", 0);
    chromium.wait(&tab, "!document.querySelector('#keys').open");
    assert_eq!(chromium.evaluate(&tab, "sent.length"), 0);
    chromium.strike(&tab, "?", "Slash", 0);
    chromium.wait(&tab, "document.querySelector('#keys').open");
    chromium.strike(&tab, " ", "Space", 0);
    chromium.wait(&tab, "status.mission_waits && !document.querySelector('#keys').open");
    chromium.strike(&tab, "r", "KeyR", 0);
    chromium.wait(&tab, "!status.mission_waits");
    chromium.evaluate(&tab, "sent.length = 0");
    // The sound's button has the focus, and is not pressed.
    chromium.click(&tab, "#mute", [0.0; 2]);
    for _ in 0..5 {
        chromium.hold_key(&tab, " ", "Space");
    }
    chromium.wait(&tab, "status.mission_waits");
    assert_eq!(chromium.evaluate(&tab, "JSON.stringify(sent)"), r#"["hold"]"#);
    assert_eq!(text(&mut chromium, &tab, "#mute"), "Sound off");
    chromium.strike(&tab, "r", "KeyR", 0);
    chromium.wait(&tab, "!status.mission_waits");
    // Nor does a held Enter confirm what its first press has announced.
    chromium.evaluate(&tab, "document.querySelector('#cut').focus(); sent.length = 0");
    for _ in 0..5 {
        chromium.hold_key(&tab, "Enter", "Enter");
    }
    std::thread::sleep(std::time::Duration::from_millis(300));
    let cuts = chromium.evaluate(&tab, "sent.includes('cut')");
    assert_eq!((cuts, chromium.evaluate(&tab, "sent.length <= 1")), (json!(false), json!(true)));
    chromium.evaluate(
        &tab,
        "document.querySelector('#cut').blur(); sent.splice(0, 9, 'hold', 'resume')",
    );
    // Letters that are typed are letters.
    chromium.evaluate(&tab, "document.querySelector('#typed').focus()");
    chromium.strike(&tab, "l", "KeyL", 0);
    assert_eq!(chromium.evaluate(&tab, "JSON.stringify(sent)"), r#"["hold","resume"]"#);
    chromium.evaluate(&tab, "document.querySelector('#typed').blur()");
    chromium.strike(&tab, "l", "KeyL", 0);
    chromium.wait(&tab, LANDS);
    // What was ordered is no alarm.
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(
        chromium.evaluate(&tab, "document.querySelector('#bar').className === 'alarm'"),
        false
    );
    chromium.wait(&tab, "!!over");
}

/// A program that is stopped and started again at its address is found again, and meanwhile nothing looks as if it was live.
#[test]
fn a_page_comes_back_after_the_program_was_started_again() {
    let Some(mut chromium) = Chromium::start() else { return };
    let mut station = at_rest("0");
    let address = station.url.trim_start_matches("http://").trim_end_matches('/').to_owned();
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    chromium.evaluate(&tab, "window.stays = true");
    signal(&station.child, "-TERM");
    station.child.wait().unwrap();
    chromium.wait(&tab, "document.querySelector('#alarm').innerText.startsWith('Over')");
    assert_eq!(chromium.evaluate(&tab, "document.body.classList.contains('stale')"), true);
    let _again = at_rest(&address);
    chromium.wait(&tab, "!over && !!status && !!readiness && readiness.ready");
    chromium.wait(&tab, "document.querySelector('#alarm').hidden");
    assert_eq!(chromium.evaluate(&tab, "document.body.classList.contains('stale')"), false);
    assert_eq!(chromium.evaluate(&tab, "window.stays"), true, "it was not loaded again");
}

/// After a reload the page knows which camera was chosen, and says nothing that is undefined.
#[test]
fn a_reload_knows_the_camera_and_the_landing() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = at_rest("0");
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    let plan = "takeoff\nland\n";
    let load = format!("order({})", json!({ "order": "load", "name": "short", "plan": plan }));
    chromium.evaluate(&tab, &load);
    chromium.wait(&tab, "flight.plan === 'short'");
    chromium.evaluate(&tab, "show('fly'); order({ order: 'start' })");
    chromium.click(&tab, "#bottom", [0.0; 2]);
    chromium.wait(&tab, "status.flight_time_s > 0");
    chromium.wait(&tab, "status.phase === 'standby'");
    chromium.reload(&tab);
    chromium
        .wait(&tab, "!!status && document.querySelector('#events').textContent.includes('landed')");
    chromium.wait(&tab, "document.querySelector('#bottom').ariaPressed === 'true'");
    let said = chromium.evaluate(&tab, "document.body.textContent.includes('undefined')");
    assert_eq!(said, false);
    assert!(text(&mut chromium, &tab, "#time").starts_with("0:0"));
}

/// The voltage that the drone measures is beside its charge.
#[test]
fn the_battery_has_volts() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = at_rest("0");
    let tab = chromium.open(&station.url);
    chromium.wait(
        &tab,
        "/^\\d+ %, \\d+\\.\\d V$/.test(document.querySelector('#battery').textContent)",
    );
    let shown = text(&mut chromium, &tab, "#battery");
    let volts: f64 = shown.split(", ").nth(1).unwrap().trim_end_matches(" V").parse().unwrap();
    // Three cells of lithium polymer.
    assert!((9.0..=12.6).contains(&volts), "{shown}");
    let told = chromium.evaluate(&tab, "status.battery_v").as_f64().unwrap();
    assert!((told - volts).abs() < 0.3, "{told}, {shown}");
}

/// A gamepad moves what its axes were chosen for while a shoulder button is held; centred or unplugged it moves nothing.
#[test]
fn a_gamepad_steers_by_its_chosen_axes_and_holds_when_it_is_gone() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = flying();
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "status?.phase === 'flying' && status.step >= 1");
    let pad = "window.pad = { id: 'pad', connected: true, axes: [0, 0, 0, 0, 0, 0], \
        buttons: [...Array(8)].map(() => ({ pressed: false })) }; \
        navigator.getGamepads = () => [null, window.pad]; window.sent = []; \
        const send = order; order = (it) => { sent.push(it); send(it); }; true";
    chromium.evaluate(&tab, pad);
    // Forward and back by the sixth axis.
    chromium.click(&tab, "[data-show=settings]", [0.0; 2]);
    chromium
        .wait(&tab, "document.querySelectorAll('#padaxes label:nth-child(4) option').length === 6");
    // At once, as by hand: the page shows what is chosen ten times a second.
    let chosen = "{ const choice = document.querySelector('#padaxes label:nth-child(4) select'); choice.value = 5; choice.oninput(); }";
    chromium.evaluate(&tab, chosen);
    chromium.click(&tab, "[data-show=fly]", [0.0; 2]);
    chromium.click(&tab, "#byhand", [0.0; 2]);
    let pause = || std::thread::sleep(std::time::Duration::from_millis(500));
    // Without a shoulder button, and centred but for a tremor, it steers nothing: the mission goes on.
    chromium.evaluate(&tab, "pad.axes[5] = -0.8; true");
    pause();
    chromium
        .evaluate(&tab, "pad.axes = [0.05, -0.05, 0, 1, 0, 0.05]; pad.buttons[5].pressed = true");
    pause();
    let steered = "sent.some((it) => it.order === 'steer')";
    // The fourth axis was the one of forward and back, and moves nothing now.
    assert_eq!(chromium.evaluate(&tab, steered), false);
    assert_eq!(chromium.evaluate(&tab, "status.mission_waits"), false);
    chromium.evaluate(&tab, "pad.axes = [0, 0, 0, 0, 0, -0.8]; true");
    chromium.wait(&tab, "status.velocity_m_s[1] > 0.3 && status.mission_waits");
    let last = "JSON.stringify(sent.filter((it) => it.order === 'steer').at(-1))";
    let forward = chromium.evaluate(&tab, last);
    let forward: serde_json::Value = serde_json::from_str(forward.as_str().unwrap()).unwrap();
    assert!((forward["pitch"].as_f64().unwrap() + 0.64).abs() < 1e-9, "{forward}");
    for axis in ["roll", "gaz", "yaw"] {
        assert_eq!(forward[axis].as_f64(), Some(0.0), "{forward}");
    }
    // Unplugged while it is pushed: the sticks are centred once, and the drone holds.
    chromium.evaluate(&tab, "window.pad = null; sent.length = 0");
    chromium.wait(&tab, "Math.abs(status.velocity_m_s[1]) < 0.1");
    let steers = "JSON.stringify(sent.map(({ order, ...sticks }) => sticks))";
    let centred = r#"[{"roll":0,"pitch":0,"gaz":0,"yaw":0}]"#;
    assert_eq!(chromium.evaluate(&tab, steers), centred);
    assert_eq!(chromium.evaluate(&tab, "status.phase === 'flying' && status.mission_waits"), true);
}
