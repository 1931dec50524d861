"use strict";
// Shows the flight from ardrone-pilot's messages on /live, and sends the operator's orders.

const signed = (value, digits = 2) => {
  const text = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(text) !== 0 ? "−" : "+") + text;
};
const at = (seconds) => `${seconds.toFixed(1)} s`;

// Time to confirm a cut, the end of an emergency, or a click on the map, in milliseconds.
const CUT_AGAIN = 2500;
const GO_AGAIN = 8000;
// A scroll that begins this long after a wheel, a finger or a key is theirs, in milliseconds.
const SCROLLS = 500;

// What it does while an operator and no plan says so.
const BY_HAND = { hold: "holding", sticks: "flown by hand", target: "flying to the place that was chosen", setpoints: "following a program" };

let flight = null; // sent first
let status = null;
let readiness = null; // whether the vehicle could take off
let socket = null;
let heard = 0; // time of the last message
let clock = -Infinity; // the flight's clock less ours, as the fastest message had it, in milliseconds
let behind = 0; // how much later than that the last message was
let over = null; // how it ended, in words
let trail = []; // [right, forward, up] in metres
let trailOfFlight = 0; // where in it the last flight begins
let me = null; // our name among the operators
let view = ""; // the part of the page that is shown
let decided = ""; // the last decision
let decidedAt = 0;
let wanted = null; // where was clicked
let wantedUntil = 0;
let armedUntil = 0;
let recoverUntil = 0;

// ---- Connection.

function connect() {
  const address = new URL("live" + location.search, location.href);
  address.protocol = "ws:";
  socket = new WebSocket(address);
  // After reconnecting, the server may have another time base.
  socket.onopen = () => (clock = -Infinity);
  socket.onmessage = (event) => {
    heard = performance.now();
    take(JSON.parse(event.data));
  };
  // The program may be started again at this address.
  socket.onclose = () => setTimeout(connect, over ? 2000 : 500);
}

function order(request) {
  $("answer").textContent = "";
  if (!socket || socket.readyState !== WebSocket.OPEN) {
    $("answer").textContent = "not connected: the order was not given";
    return;
  }
  // Another order disarms the cut; sticks that are held do not.
  if (!["steer", "camera"].includes(request.order)) armedUntil = recoverUntil = 0;
  // Not for another vehicle that is flown at the same address later.
  socket.send(JSON.stringify({ ...request, vehicle: flight?.vehicle }));
}

function take(message) {
  switch (message.type) {
    case "flight":
      begin(message);
      break;
    case "status":
      // It has taken off, maybe again.
      if (message.flight_time_s !== null && message.flight_time_s < (status?.flight_time_s ?? Infinity)) trailOfFlight = trail.length;
      status = message;
      clock = Math.max(clock, message.t_s * 1000 - performance.now());
      behind = clock - (message.t_s * 1000 - performance.now());
      if (message.pose) extendTrail(message.pose);
      decide(message);
      plots.add(message);
      break;
    case "event":
      if (message.warning) dangers.warn(message.text);
      addEvent(message);
      break;
    case "landed":
      addEvent(message);
      break;
    case "message":
      talk.add(message);
      break;
    case "other":
      fleet.take(message);
      break;
    case "ready":
      readiness = message;
      break;
    case "you":
      me = message.name;
      break;
    case "accepted":
      if (message.order === "load") plan.loaded();
      break;
    case "end":
      finish(message);
      break;
    case "armed":
      armedUntil = performance.now() + CUT_AGAIN;
      break;
    case "refused":
      $("answer").textContent = message.reason;
      if (message.order === "load" || view === "plan") plan.refused(message.reason);
      break;
  }
}

function begin(message) {
  flight = message;
  trail = message.trail;
  decided = "";
  // Another run of the program has begun, or this one goes on.
  over = status = null;
  // The end of a path says more than its beginning.
  $("plan").textContent = message.plan.split(/[\\/]/).at(-1) || "ardrone-pilot";
  $("plan").title = message.plan;
  document.title = [message.plan, message.vehicle, "ardrone-pilot"].filter(Boolean).join(" – ");
  $("vehicle").textContent = message.vehicle;
  $("charge").low = message.battery_warns_percent;
  $("nodrone").textContent = message.drone;
  $("nomission").hidden = message.steps.length > 0;
  $("edit").hidden = !message.steps.length;
  if (!$("words").childElementCount) {
    $("words").append(...message.words.map((word) => Object.assign(document.createElement("option"), { value: word })));
  }
  for (const id of ["steps", "events", "decisions"]) $(id).replaceChildren();
  message.steps.forEach((step, index) => {
    const item = document.createElement("li");
    item.textContent = `${index + 1}  ${step.text}`;
    $("steps").append(item);
  });
  message.notes.forEach((note) => addEvent({ t_s: 0, text: `note: ${note}` }));
  if (message.status) take(message.status);
  trailOfFlight = 0;
  readiness = message.ready;
  if (message.end) finish(message.end);
  fleet.begin(message);
  talk.begin(message.fleet);
  // What was told before is shown, and not warned of again.
  for (const event of message.events) event.type === "message" ? talk.add(event) : addEvent(event);
  plan.begin(message);
  // Somebody without a mission makes one first.
  if (!view) show(message.steps.length ? "fly" : "plan");
}

// Shows a part of the page: fly, plan, plots, flights or settings.
function show(name) {
  if (name === view) return;
  view = name;
  document.body.dataset.view = name;
  for (const button of document.querySelectorAll("nav button")) button.ariaPressed = String(button.dataset.show === name);
  wanted = null;
  map.reset();
  if (name === "flights") flights.list();
  if (name === "settings") settings.list();
}

function finish(message) {
  const steps = `${message.steps_done} of ${message.steps} steps`;
  const log = message.log ? ` Log: ${message.log}` : "";
  over = `Over: ${message.outcome}; ${steps}.${log}`;
  // No other status follows where the program ends. Of a mission for the next flight nothing is done.
  if (status && status.steps_done !== null) Object.assign(status, { step: null, steps_done: message.steps_done });
}

// Adds a line below the others, which stay where they are: nothing moves under the eye.
function line(list, seconds, text, ill) {
  const item = document.createElement("li");
  const time = document.createElement("time");
  time.textContent = at(seconds);
  item.append(time, " ", text);
  if (ill) item.className = "ill";
  const lines = $(list);
  lines.append(item);
  while (lines.childElementCount > 100) lines.firstElementChild.remove();
  follow(lines);
}

// Shows the last line, but to somebody who has scrolled up and reads.
const follow = (lines) => lines.dataset.reads || (lines.scrollTop = lines.scrollHeight);
for (const lines of [$("events"), $("decisions")]) {
  let touched = -Infinity; // what else scrolls is no wish to read
  for (const kind of ["wheel", "touchmove", "pointerdown", "keydown"]) {
    lines.addEventListener(kind, () => (touched = performance.now()), { passive: true });
  }
  lines.addEventListener("scroll", () => {
    const isUp = lines.scrollHeight - lines.scrollTop - lines.clientHeight > 30;
    if (!isUp) lines.dataset.reads = "";
    else if (performance.now() - touched < SCROLLS) lines.dataset.reads = "yes";
  });
  // When its view is shown again, or has another width.
  new ResizeObserver(() => follow(lines)).observe(lines);
}

function addEvent(message) {
  const command = message.command ? `: ${message.command}` : "";
  const text = (message.text ?? message.type).replace(`${me} has taken`, "this page has taken");
  line("events", message.t_s, text + command, message.warning);
}

function decide(message) {
  if (!message.order) return;
  const decision = `${message.order}: ${message.plans.join(" ")}`;
  if (decision === decided) return;
  decided = decision;
  decidedAt = message.t_s;
  $("order").textContent = message.order;
  const plans = message.plans.map((number) => {
    const text = document.createElement("pre");
    text.textContent = `${number}: ${flight.plans[number]}`;
    return text;
  });
  $("because").replaceChildren(...plans);
  const triggers = message.plans.map((number) => trigger(flight.plans[number]));
  line("decisions", message.t_s, `${message.order}: ${triggers.join(", ")}`);
}

// "+!stay(_, Arrival)" of "+!stay(_, Arrival) : target(..) <- ..".
function trigger(plan) {
  const start = plan.split("\n").find((text) => /^[+-]/.test(text)) || "";
  return start.split(/ :| <-|\.$/)[0].trim();
}

function extendTrail(pose) {
  const last = trail[trail.length - 1];
  if (last && Math.hypot(last[0] - pose.x_m, last[1] - pose.y_m, last[2] - pose.z_m) < 0.02) return;
  trail.push([pose.x_m, pose.y_m, pose.z_m]);
  if (trail.length <= 2000) return;
  trail.shift();
  trailOfFlight = Math.max(0, trailOfFlight - 1);
}

// ---- Display. Drawn in animation frames, so that a page in the background costs nothing.

// Frames without anything new are left out, but for some: time passes.
const AT_LEAST_EVERY = 200; // milliseconds
const MOVES_ON_FOR = 1000; // milliseconds after someone did something: views come to rest
let drawnAt = performance.now();
let drawnStatus = null;
let touchedAt = 0;
for (const kind of ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "input", "resize"]) {
  addEventListener(kind, () => (touchedAt = performance.now()), { capture: true, passive: true });
}

function draw() {
  requestAnimationFrame(draw);
  const now = performance.now();
  const isNew = status !== drawnStatus || now - touchedAt < MOVES_ON_FOR || flights.playing();
  if (!isNew && now - drawnAt < AT_LEAST_EVERY) return;
  drawnStatus = status;
  // What is played is no longer looked at once something flies.
  flights.advance((now - drawnAt) / 1000, isAirborne());
  drawnAt = now;
  drawAdvice();
  drawButtons();
  if (!flight) return;
  fleet.drawList();
  if (!["flights", "settings"].includes(view)) {
    map.draw();
    heights.draw();
  }
  if (!status) return;
  drawFacts();
  drawDoing();
  if (view === "plots") plots.draw();
  if (status.pose) drawGauges();
  drawSteps();
}

function drawAdvice() {
  // A drone that has not been heard for this long is looked for, in seconds.
  const PATIENCE = 3;
  const connecting = !over && status && status.phase === "connecting" && status.navdata_age_s === null;
  $("advice").hidden = !connecting || status.t_s < PATIENCE || view !== "fly";
}

// Whether another page has the controls: they must be taken before anything that needs them.
function isWatching() {
  return Boolean(status && me && status.controls !== me && /browser/.test(status.controls ?? ""));
}

// Every button keeps its place: what cannot be used is grey.
function drawButtons() {
  const live = !over && socket && socket.readyState === WebSocket.OPEN;
  const flying = live && status && status.phase === "flying";
  const watching = isWatching();
  $("hold").disabled = !flying;
  // A delayed order to fly to a place must not be sent.
  $("fly").disabled = !flying || watching || !dangers.isCalm();
  $("take").disabled = !live || !status || !(watching || [me, "the agent"].includes(status.controls));
  $("take").textContent = status && status.controls === me ? "Release the controls" : "Take the controls";
  $("typed").disabled = !live || watching;
  $("resume").disabled = !flying || !status.mission_waits || watching;
  const standby = live && status && status.phase === "standby";
  $("start").disabled = !standby || !flight || !flight.steps.length || !readiness || !readiness.ready || watching;
  $("land").disabled = $("cut").disabled = !live;
  const emergency = live && status && status.emergency;
  // Before it lies on the ground the vehicle would refuse.
  const fallen = Boolean(emergency && !status.airborne);
  $("recover").disabled = !fallen;
  // The bright one is the one that helps.
  $("land").classList.toggle("prime", live && isAirborne() && !emergency);
  $("start").classList.toggle("prime", !$("start").disabled && !emergency);
  $("recover").classList.toggle("prime", fallen);
  const now = performance.now();
  const armed = now < armedUntil;
  $("cut").classList.toggle("armed", armed);
  $("cut").textContent = armed ? "Again: the drone FALLS" : "Cut motors";
  $("recover").textContent = now < recoverUntil ? "Again: it may start" : "Recover";
  if (now > wantedUntil) wanted = null;
  $("go").hidden = !wanted || !flying;
  if (wanted) $("fly").textContent = `Fly to ${signed(wanted.x)}, ${signed(wanted.y)} m`;
}

// "1:05", of seconds.
const minutes = (time) => `${Math.floor(time / 60)}:${String(Math.floor(time % 60)).padStart(2, "0")}`;

function drawFacts() {
  const put = (id, text, ill = false) => {
    if ($(id).textContent !== text) $(id).textContent = text;
    $(id).classList.toggle("ill", ill);
  };
  const { pose, velocity_m_s: velocity, battery_percent: charge } = status;
  put("phase", over ? "over" : status.emergency ? "EMERGENCY" : status.phase === "flying" && status.mission_waits ? (status.manual && status.manual !== "hold" ? (status.controls === "the agent" ? "by its agent" : "by hand") : "holding") : status.phase);
  $("phase").classList.toggle("alarm", Boolean(status.emergency));
  put("time", status.flight_time_s === null ? "–" : minutes(status.flight_time_s));
  put("step", status.step === null ? "–" : `${status.step + 1} of ${status.steps}`);
  const volts = status.battery_v ? `, ${status.battery_v.toFixed(1)} V` : "";
  put("battery", charge === null ? "–" : `${charge} %${volts}`, charge !== null && charge <= flight.battery_warns_percent);
  $("charge").value = charge || 0;
  // Until it is landed for its charge, by the use of a hover with a new battery.
  const left = charge === null ? null : Math.max(0, charge - flight.battery_lands_percent) / flight.battery_percent_s;
  put("timeleft", left === null ? "–" : `≈ ${minutes(left)}`, left !== null && left < 60);
  put("speed", velocity ? `${Math.hypot(...velocity).toFixed(1)} m/s` : "–");
  put("high", pose ? `${pose.z_m.toFixed(1)} m` : "–");
  put("home", pose ? `${Math.hypot(pose.x_m - flight.start_m[0], pose.y_m - flight.start_m[1]).toFixed(1)} m` : "–");
  const age = status.navdata_age_s;
  const stale = age === null || age > 0.3;
  // Of the usual 15 packets a second.
  const quality = age === null ? "none" : stale ? `none for ${age.toFixed(1)} s` : status.navdata_hz > 12 ? "good" : status.navdata_hz > 6 ? "weak" : "bad";
  put("link", quality, stale || quality === "bad");
  put("rate", age === null ? "none" : `${status.navdata_hz.toFixed(0)} a second, ${(age * 1000).toFixed(0)} ms old`);
  put("who", !status.controls ? "nobody" : status.controls === me ? "you" : status.controls);
  $("who").title = status.controls ?? "";
  put("timing", `${(status.tick_late_s * 1000).toFixed(1)} ms late, ticks skipped: ${status.ticks_skipped}`, status.tick_late_s > 0.01);
  put("since", decided ? `for ${Math.max(0, status.t_s - decidedAt).toFixed(1)} s` : "");
}

// What it is doing and what comes next.
function drawDoing() {
  const step = status.step === null ? null : flight.steps[status.step];
  const following = status.step === null ? null : flight.steps[status.step + 1];
  let [now, next] = [status.phase, ""];
  if (status.phase === "flying" && status.manual) [now, next] = [BY_HAND[status.manual], "the mission is paused: Resume goes on with it"];
  else if (status.phase === "flying" && status.mission_waits) [now, next] = ["holding", "the mission is paused: Resume goes on with it"];
  else if (step && status.phase === "flying") {
    const far = status.distance_m === null ? "" : `, ${status.distance_m.toFixed(1)} m to go`;
    now = `step ${status.step + 1}: ${step.text}${far}`;
    next = following ? `then ${following.text}` : "";
  } else if (status.phase === "standby" && readiness) {
    now = readiness.ready ? (flight.steps.length ? "ready to start" : "ready; there is no mission yet") : `not ready: ${readiness.reasons.join("; ")}`;
  }
  if ($("now").textContent !== now) $("now").textContent = now;
  if ($("next").textContent !== next) $("next").textContent = next;
}

function drawGauges() {
  const [roll, pitch] = status.attitude_deg || [0, 0];
  // Two units a degree; nose up moves the horizon down.
  $("horizon").setAttribute("transform", `rotate(${-roll}) translate(0 ${Math.max(-45, Math.min(45, 2 * pitch))})`);
  $("leans").textContent = status.attitude_deg ? `${signed(roll, 1)}° right, ${signed(-pitch, 1)}° forward` : "–";
  const y = (height) => 113 - 106 * Math.max(0, Math.min(1, height / flight.ceiling_m));
  const above = y(status.pose.z_m);
  $("above").setAttribute("y", above);
  $("above").setAttribute("height", 113 - above);
  $("floor").setAttribute("d", `M20 ${y(flight.floor_m)}H40`);
  $("aloft").style.display = status.target ? "" : "none";
  if (status.target) $("aloft").setAttribute("transform", `translate(0 ${y(status.target.z_m)})`);
  $("ceiling").textContent = `${flight.ceiling_m} m`;
  const metres = (value) => `${signed(value)} m`;
  const { pose, target } = status;
  [$("x").textContent, $("y").textContent, $("z").textContent] = [pose.x_m, pose.y_m, pose.z_m].map(metres);
  $("heading").textContent = `${signed(pose.yaw_deg, 0)}°`;
  $("target").textContent = target ? `${signed(target.x_m)} ${signed(target.y_m)} ${signed(target.z_m)} m` : "–";
  $("off").textContent = target ? `${status.distance_m.toFixed(2)} m` : "–";
  $("tagsknown").textContent = status.tags ? map.tagsText() : "not in use";
  const holds = status.contradicted_by ? `contradicted by ${status.contradicted_by}` : status.uncertainty_holds;
  $("uncertainty").textContent = `${status.uncertainty_m.toFixed(2)} m, ${holds}`;
  $("uncertainty").classList.toggle("ill", Boolean(status.contradicted_by));
}

function drawSteps() {
  // Settings before the step that is flown are done with it.
  const stepsDone = status.step ?? status.steps_done ?? 0;
  [...$("steps").children].forEach((item, index) => {
    const now = index === status.step;
    const done = index < stepsDone;
    const name = done ? "done" : now ? "now" : "";
    if (item.className === name) return;
    item.className = name;
    if (!now) return;
    // Only the list is moved, not the page.
    const list = item.closest("section");
    const [outer, inner] = [list.getBoundingClientRect(), item.getBoundingClientRect()];
    list.scrollTop += Math.max(0, inner.bottom - outer.bottom) + Math.min(0, inner.top - outer.top);
  });
}

// ---- Orders.

$("start").onclick = () => order({ order: "start" });
$("hold").onclick = () => order({ order: "hold" });
$("resume").onclick = () => order({ order: "resume" });
$("land").onclick = () => order({ order: "land" });
$("cut").onclick = () => {
  const armed = performance.now() < armedUntil;
  armedUntil = 0;
  order({ order: armed ? "cut" : "arm" });
};
$("recover").onclick = () => {
  const again = performance.now() < recoverUntil;
  if (again) order({ order: "recover" });
  recoverUntil = again ? 0 : performance.now() + CUT_AGAIN;
};
$("map").addEventListener("click", (event) => {
  if (view !== "fly" || map.wasMoved()) return;
  map.keep();
  wanted = map.place(event);
  wantedUntil = performance.now() + GO_AGAIN;
});
$("fly").onclick = () => {
  if (wanted) order({ order: "goto", x_m: wanted.x, y_m: wanted.y });
  wanted = null;
};
$("stay").onclick = () => (wanted = null);
$("take").onclick = () => order({ order: status && status.controls === me ? "release" : "take" });
$("edit").onclick = () => plan.edit(flight);
for (const button of document.querySelectorAll("nav button")) button.onclick = () => show(button.dataset.show);
$("typing").onsubmit = (event) => {
  event.preventDefault();
  const line = $("typed").value.trim();
  if (!line) return;
  order({ order: "typed", line });
  // What was asked for is no error.
  $("answer").classList.toggle("asked", line === "help");
  $("typed").value = "";
};
$("help").onclick = () => $("keys").showModal();

let answered = null; // what waits for the answer to a question

// Asks before something is lost. It resolves to whether to go on.
function confirmed(question, does) {
  // Only one question at a time.
  answered?.(false);
  const dialog = $("ask");
  $("asked").textContent = question;
  $("askyes").textContent = does;
  dialog.returnValue = "no";
  dialog.showModal();
  return new Promise((resolve) => {
    answered = resolve;
    dialog.onclose = () => {
      // The end of the question before may be told late.
      if (!dialog.open) resolve(dialog.returnValue === "yes");
    };
  });
}

// Keys as in the terminal. One that is held is one order, and letters that are typed are letters.
const isTyped = ({ target }) => /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName) && target.type !== "checkbox";
const isText = ({ target }) => ["textarea", "text"].includes(target.type);
const isAirborne = () => Boolean(status && ["flying", "landing"].includes(status.phase));
// What stops a drone in the air, wherever the focus is but in a text; on the ground the space bar presses a button, as everywhere.
const stops = (key) => isAirborne() && { " ": "hold", l: "land" }[key.toLowerCase()];
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") wanted = null;
  const stop = stops(event.key);
  if ((stop ? isText : isTyped)(event) || event.ctrlKey || event.metaKey || event.altKey) return;
  const dialog = document.querySelector("dialog[open]");
  // Nothing that is open stands between somebody and a drone that must hold or land.
  if (dialog && !stop) return;
  dialog?.close("no");
  const does = stop || {
    l: "land",
    r: status && status.mission_waits && "resume",
  }[event.key.toLowerCase()];
  if (event.key === "?") $("keys").showModal();
  else if (!does) return;
  else if (!event.repeat) order({ order: does });
  event.preventDefault();
});
// A report is a frame of another origin, which tells of these keys. Nothing else is taken from it.
addEventListener("message", ({ source, data }) => {
  if (source !== $("report").contentWindow || typeof data?.key !== "string") return;
  const stop = stops(data.key);
  if (stop) order({ order: stop });
});
// A held Enter would press a button again and again, and so confirm what it has just announced.
document.addEventListener("keydown", (event) => {
  if (event.repeat && event.key === "Enter" && !isTyped(event)) event.preventDefault();
}, true);
// What has the focus is pressed by the release of the space bar.
document.addEventListener("keyup", (event) => {
  if (event.key === " " && isAirborne() && !isText(event)) event.preventDefault();
});

// A page in the background is not drawn, and must be heard all the same.
setInterval(dangers.draw, 100);
addEventListener("load", () => {
  connect();
  draw();
});
