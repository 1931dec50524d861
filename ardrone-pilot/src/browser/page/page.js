"use strict";
// Shows the flight from ardrone-pilot's messages on /live, and sends the operator's orders.

const signed = (value, digits = 2) => {
  const text = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(text) !== 0 ? "−" : "+") + text;
};
const at = (seconds) => `${seconds.toFixed(1)} s`;

// Without a message for this long the page shows an alarm, in milliseconds.
const SILENCE = 1000;
// Time to confirm a cut or a click on the map, in milliseconds.
const CUT_AGAIN = 2500;
const GO_AGAIN = 8000;

let flight = null; // sent first
let status = null;
let readiness = null; // whether the vehicle could take off
let socket = null;
let heard = 0; // time of the last message
let clock = -Infinity; // the flight's clock less ours, as the fastest message had it, in milliseconds
let behind = 0; // how much later than that the last message was
let over = null; // how it ended
let trail = [];
let me = null; // our name among the operators
let view = ""; // the part of the page that is shown
let decided = ""; // the last decision
let decidedAt = 0;
let wanted = null; // where was clicked
let wantedUntil = 0;
let armedUntil = 0;

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
  socket.onclose = () => {
    if (!over) setTimeout(connect, 500);
  };
}

function order(request) {
  $("answer").textContent = "";
  if (!socket || socket.readyState !== WebSocket.OPEN) {
    $("answer").textContent = "not connected: the order was not given";
    return;
  }
  // Another order disarms the cut; sticks that are held do not.
  if (!["steer", "camera"].includes(request.order)) armedUntil = 0;
  // Not for another vehicle that is flown at the same address later.
  socket.send(JSON.stringify({ ...request, vehicle: flight?.vehicle }));
}

function take(message) {
  switch (message.type) {
    case "flight":
      begin(message);
      break;
    case "status":
      status = message;
      clock = Math.max(clock, message.t_s * 1000 - performance.now());
      behind = clock - (message.t_s * 1000 - performance.now());
      if (message.pose) extendTrail(message.pose);
      decide(message);
      plots.add(message);
      break;
    case "event":
      addEvent(message);
      break;
    case "landed":
      addEvent({ t_s: message.t_s, text: "landed" });
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
  $("plan").textContent = message.plan || "ardrone-pilot";
  document.title = [message.plan, message.vehicle, "ardrone-pilot"].filter(Boolean).join(" – ");
  $("vehicle").textContent = message.vehicle;
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
  message.events.forEach(addEvent);
  if (message.status) take(message.status);
  readiness = message.ready;
  if (message.end) finish(message.end);
  plan.begin(message);
  // Somebody without a mission makes one first.
  if (!view) show(message.steps.length ? "fly" : "plan");
}

// Shows a part of the page: fly, plan, plots or flights.
function show(name) {
  if (name === view) return;
  view = name;
  document.body.dataset.view = name;
  for (const button of document.querySelectorAll("nav button")) button.ariaPressed = String(button.dataset.show === name);
  wanted = null;
  map.reset();
  if (name === "flights") flights.list();
}

function finish(message) {
  over = message;
  const steps = `${message.steps_done} of ${message.steps} steps`;
  const log = message.log ? ` Log: ${message.log}` : "";
  $("alarm").textContent = `Over: ${message.outcome}; ${steps}.${log}`;
  $("alarm").className = "over";
  $("alarm").hidden = false;
}

function line(list, seconds, text, ill) {
  const item = document.createElement("li");
  const time = document.createElement("time");
  time.textContent = at(seconds);
  item.append(time, " ", text);
  if (ill) item.className = "ill";
  $(list).prepend(item);
  while ($(list).childElementCount > 100) $(list).lastElementChild.remove();
}

function addEvent(message) {
  const command = message.command ? `: ${message.command}` : "";
  line("events", message.t_s, message.text + command, message.warning);
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
  if (last && Math.hypot(last[0] - pose.x_m, last[1] - pose.y_m) < 0.02) return;
  trail.push([pose.x_m, pose.y_m]);
  if (trail.length > 2000) trail.shift();
}

// ---- Display. Drawn in animation frames, so that a page in the background costs nothing.

function draw() {
  requestAnimationFrame(draw);
  drawAlarm();
  drawButtons();
  if (!flight) return;
  if (view !== "flights") map.draw();
  if (!status) return;
  drawFacts();
  if (view === "plots") plots.draw();
  if (status.pose) drawGauges();
  drawSteps();
}

function drawAlarm() {
  // A drone that has not been heard for this long is looked for, in seconds.
  const PATIENCE = 3;
  const connecting = !over && status && status.phase === "connecting" && status.navdata_age_s === null;
  $("advice").hidden = !connecting || status.t_s < PATIENCE;
  if (over) return;
  const silence = performance.now() - heard;
  const seconds = (time) => `${(time / 1000).toFixed(0)} s`;
  let alarm = "";
  if (silence > SILENCE) {
    const since = heard ? ` for ${seconds(silence)}` : "";
    alarm = `No data from ardrone-pilot${since}. The flight goes on without this page; see the terminal.`;
  } else if (behind > SILENCE) {
    alarm = `This page is ${seconds(behind)} behind: the connection is slow.`;
  }
  $("alarm").hidden = !alarm;
  $("alarm").textContent = alarm;
}

// Whether another page has the controls: they must be taken before anything that needs them.
function isWatching() {
  return Boolean(status && me && status.controls !== me && /browser/.test(status.controls ?? ""));
}

function drawButtons() {
  const live = !over && socket && socket.readyState === WebSocket.OPEN;
  const flying = live && status && status.phase === "flying";
  $("hold").disabled = !flying;
  // A delayed order to fly to a place must not be sent.
  $("fly").disabled = !flying || !$("alarm").hidden;
  const watching = isWatching();
  $("take").hidden = !live || !status || !(watching || status.controls === me);
  $("take").textContent = watching ? "Take the controls" : "Release the controls";
  $("fly").disabled ||= watching;
  $("typed").disabled = !live || watching;
  $("resume").disabled = !flying || !status.mission_waits || watching;
  const standby = live && status && status.phase === "standby";
  $("start").hidden = !standby;
  $("start").disabled = !flight || !flight.steps.length || !readiness || !readiness.ready || watching;
  $("land").disabled = $("cut").disabled = !live;
  // It is the bright one only where there is something to land: not after the motors were cut.
  const grounded = !live || (status && ["connecting", "configuring", "standby"].includes(status.phase));
  $("land").classList.toggle("quiet", Boolean(grounded));
  const now = performance.now();
  const armed = now < armedUntil;
  $("cut").classList.toggle("armed", armed);
  $("cut").textContent = armed ? "Again: the drone FALLS" : "Cut motors";
  if (now > wantedUntil) wanted = null;
  $("go").hidden = !wanted || !flying;
  if (wanted) $("fly").textContent = `Fly to ${signed(wanted.x)}, ${signed(wanted.y)} m`;
}

function drawFacts() {
  $("phase").textContent = over ? "over" : status.emergency ? "EMERGENCY" : status.phase === "flying" && status.mission_waits ? "manual, mission paused" : status.phase;
  const grounded = !over && readiness && status.phase !== "flying" && status.phase !== "landing";
  $("ready").textContent = !grounded ? "–" : readiness.ready ? "yes" : `no: ${readiness.reasons.join("; ")}`;
  $("ready").classList.toggle("ill", grounded && !readiness.ready);
  $("time").textContent = at(status.t_s);
  $("step").textContent = status.step === null ? "–" : `${status.step + 1} of ${status.steps}`;
  const charge = status.battery_percent;
  $("battery").textContent = charge === null ? "–" : `${charge} %`;
  $("charge").value = charge || 0;
  const age = status.navdata_age_s;
  const stale = age === null || age > 0.3;
  $("link").textContent = age === null ? "none" : stale ? `NONE for ${age.toFixed(1)} s` : `${status.navdata_hz.toFixed(0)}/s, ${(age * 1000).toFixed(0)} ms old`;
  $("link").classList.toggle("ill", stale);
  $("who").textContent = !status.controls ? "nobody" : status.controls === me ? "you" : status.controls;
  $("who").title = status.controls ?? "";
  $("ticks").textContent = `${(status.tick_late_s * 1000).toFixed(1)} ms late, ${status.ticks_skipped} skipped`;
  $("ticks").classList.toggle("ill", status.tick_late_s > 0.01);
  $("since").textContent = decided ? `for ${Math.max(0, status.t_s - decidedAt).toFixed(1)} s` : "";
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
  const place = (pose) => `${signed(pose.x_m)} ${signed(pose.y_m)} ${signed(pose.z_m)} m`;
  $("at").textContent = `${place(status.pose)} ${signed(status.pose.yaw_deg, 0)}°`;
  $("target").textContent = status.target ? place(status.target) : "–";
  $("off").textContent = status.target ? `${status.distance_m.toFixed(2)} m` : "–";
  $("tagged").hidden = !status.tags;
  if (status.tags) $("tagsknown").textContent = map.tagsText();
  const known = status.contradicted_by ? `contradicted by ${status.contradicted_by}` : status.horizontal_deviation_holds;
  $("known").textContent = `${status.horizontal_deviation_m.toFixed(2)} m, ${known}`;
  $("known").classList.toggle("ill", Boolean(status.contradicted_by));
}

function drawSteps() {
  [...$("steps").children].forEach((item, index) => {
    const now = index === status.step;
    const done = index < (over ? over.steps_done : (status.step ?? 0));
    const name = done ? "done" : now ? "now" : "";
    if (item.className === name) return;
    item.className = name;
    if (now) item.scrollIntoView({ block: "nearest" });
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
$("map").addEventListener("click", (event) => {
  if (view !== "fly") return;
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
  $("typed").value = "";
};
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") wanted = null;
});

addEventListener("load", () => {
  connect();
  draw();
});
