"use strict";
// Shows the flight from ardrone-pilot's messages on /live, and sends the operator's orders.

const $ = (id) => document.getElementById(id);
const svg = (name, attributes = {}) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
};
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
let tags = new Map(); // marks of the known tags by their number
let targets = []; // of the plan: { x, y, steps, mark }
let decided = ""; // the last decision
let decidedAt = 0;
let zoom = 1;
let view = null; // the part of the world on the map: { x, y, half }
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
  socket.send(JSON.stringify(request));
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
    case "end":
      finish(message);
      break;
    case "armed":
      armedUntil = performance.now() + CUT_AGAIN;
      break;
    case "refused":
      $("answer").textContent = message.reason;
      break;
  }
}

function begin(message) {
  flight = message;
  trail = message.trail;
  decided = "";
  $("plan").textContent = message.plan;
  document.title = `${message.plan} – ardrone-pilot`;
  for (const id of ["steps", "events", "decisions", "targets"]) $(id).replaceChildren();
  message.steps.forEach((step, index) => {
    const item = document.createElement("li");
    item.textContent = `${index + 1}  ${step.text}`;
    $("steps").append(item);
  });
  targets = [];
  message.steps.forEach(({ target }, index) => {
    if (!target) return;
    // Targets at one place share a mark.
    const near = (other) => Math.hypot(other.x - target.x_m, other.y - target.y_m) < 0.1;
    let place = targets.find(near);
    if (!place) {
      place = { x: target.x_m, y: target.y_m, steps: [], mark: svg("g") };
      place.mark.append(svg("circle", { r: 0.8 }), svg("text", { y: -1.7, "font-size": 1.3 }));
      $("targets").append(place.mark);
      targets.push(place);
    }
    place.steps.push(index);
    place.mark.lastChild.textContent = place.steps.map((step) => step + 1).join(", ");
  });
  const way = [[0, 0], ...message.steps.filter((step) => step.target).map((step) => [step.target.x_m, step.target.y_m])];
  $("way").setAttribute("points", points(way));
  $("fence").setAttribute("r", message.radius_m);
  message.notes.forEach((note) => addEvent({ t_s: 0, text: `note: ${note}` }));
  message.events.forEach(addEvent);
  if (message.status) take(message.status);
  readiness = message.ready;
  if (message.end) finish(message.end);
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

const points = (places) => places.map(([x, y]) => `${x.toFixed(3)},${(-y).toFixed(3)}`).join(" ");

function draw() {
  requestAnimationFrame(draw);
  drawAlarm();
  drawButtons();
  if (!flight || !status) return;
  drawFacts();
  if (!status.pose) return;
  drawMap();
  drawGauges();
  drawSteps();
}

function drawAlarm() {
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

function drawButtons() {
  const live = !over && socket && socket.readyState === WebSocket.OPEN;
  const flying = live && status && status.phase === "flying";
  $("hold").disabled = !flying;
  // A delayed order to fly to a place must not be sent.
  $("fly").disabled = !flying || !$("alarm").hidden;
  $("resume").disabled = !flying || !status.mission_waits;
  const standby = live && status && status.phase === "standby";
  $("start").hidden = !standby;
  $("start").disabled = !flight || !flight.steps.length || !readiness || !readiness.ready;
  $("land").disabled = $("cut").disabled = !live;
  const now = performance.now();
  const armed = now < armedUntil;
  $("cut").classList.toggle("armed", armed);
  $("cut").textContent = armed ? "Again: the drone FALLS" : "Cut motors";
  if (now > wantedUntil) wanted = null;
  $("go").hidden = !wanted || !flying;
  if (wanted) $("fly").textContent = `Fly to ${signed(wanted.x)}, ${signed(wanted.y)} m`;
}

function drawFacts() {
  $("phase").textContent = over ? "over" : status.mission_waits ? "manual, mission paused" : status.phase;
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
  $("who").textContent = status.controls ?? "nobody";
  $("ticks").textContent = `${(status.tick_late_s * 1000).toFixed(1)} ms late, ${status.ticks_skipped} skipped`;
  $("ticks").classList.toggle("ill", status.tick_late_s > 0.01);
  $("since").textContent = decided ? `for ${Math.max(0, status.t_s - decidedAt).toFixed(1)} s` : "";
}

function drawMap() {
  const map = $("map");
  const { width, height } = map.getBoundingClientRect();
  if (!width || !height) return;
  const places = flight.steps.filter((step) => step.target).map((step) => [step.target.x_m, step.target.y_m]);
  places.push([0, 0], [status.pose.x_m, status.pose.y_m]);
  for (const tag of known()) places.push([tag.x_m, tag.y_m]);
  if (status.target) places.push([status.target.x_m, status.target.y_m]);
  const [xs, ys] = [0, 1].map((axis) => places.map((place) => place[axis]));
  const middle = (values) => (Math.min(...values) + Math.max(...values)) / 2;
  const reach = (values) => (Math.max(...values) - Math.min(...values)) / 2;
  const least = Math.min(width, height);
  const half = Math.max((reach(xs) * least) / width, (reach(ys) * least) / height, 0.8) * 1.25 + 0.3;
  // The view follows smoothly and does not zoom in by itself.
  view ??= { x: middle(xs), y: middle(ys), half };
  view.half = Math.max(view.half, half);
  view.x += (middle(xs) - view.x) * 0.1;
  view.y += (middle(ys) - view.y) * 0.1;
  const shown = view.half / zoom;
  const [wide, high] = [(shown * width) / least, (shown * height) / least];
  map.setAttribute("viewBox", `${view.x - wide} ${-view.y - high} ${2 * wide} ${2 * high}`);
  drawGrid(wide, high, shown);
  const size = shown * 0.05; // of a mark, in metres
  const put = (id, x, y, more = "") => $(id).setAttribute("transform", `translate(${x} ${-y}) scale(${size}) ${more}`);
  const pose = status.pose;
  put("drone", pose.x_m, pose.y_m, `rotate(${pose.yaw_deg})`);
  $("doubt").setAttribute("cx", pose.x_m);
  $("doubt").setAttribute("cy", -pose.y_m);
  $("doubt").setAttribute("r", 2 * status.horizontal_deviation_m);
  $("trail").setAttribute("points", points(trail));
  $("aim").style.display = status.target ? "" : "none";
  if (status.target) put("aim", status.target.x_m, status.target.y_m);
  $("wanted").style.display = wanted ? "" : "none";
  if (wanted) put("wanted", wanted.x, wanted.y);
  drawTags(size);
  for (const { x, y, steps, mark } of targets) {
    mark.setAttribute("transform", `translate(${x} ${-y}) scale(${size * 0.8})`);
    mark.setAttribute("class", steps.includes(status.step) ? "now" : "");
  }
}

const known = () => (status.tags ? status.tags.map : []);

// A tag that was not seen for this long is drawn faintly, in seconds.
const STALE = 2;

// Each tag as a roundel with a mark in its direction, its number, and a circle of one standard deviation.
function drawTags(size) {
  const map = known();
  for (const [id, mark] of tags) {
    if (map.some((tag) => tag.id === id)) continue;
    mark.remove();
    tags.delete(id);
  }
  for (const tag of map) {
    if (!tags.has(tag.id)) {
      const mark = svg("g");
      const roundel = svg("g");
      roundel.append(svg("path", { d: "M0-.8V-1.7" }), svg("circle", { class: "rim", r: 0.8 }), svg("circle", { class: "dot", r: 0.3 }));
      mark.append(svg("circle", { class: "spread" }), roundel, svg("text", { "font-size": 1.2, y: 2.2 }));
      $("tags").append(mark);
      tags.set(tag.id, mark);
    }
    const mark = tags.get(tag.id);
    const [spread, roundel, number] = mark.children;
    spread.setAttribute("r", tag.deviation_m);
    mark.setAttribute("transform", `translate(${tag.x_m} ${-tag.y_m})`);
    roundel.setAttribute("transform", `scale(${size * 0.8}) rotate(${tag.heading_deg ?? 0})`);
    roundel.firstChild.style.display = tag.heading_deg === null ? "none" : "";
    number.setAttribute("transform", `scale(${size * 0.8})`);
    number.textContent = `${tag.id}${tag.surveyed ? "*" : ""}`;
    mark.setAttribute("class", tag.seen_s !== null && tag.seen_s < STALE ? "" : "stale");
  }
}

// "2, to 0.04 m, seen 0.1 s ago": the best of them.
function tagsText() {
  const map = known();
  const seen = status.tags.seen_s === null ? "none seen yet" : `seen ${status.tags.seen_s.toFixed(1)} s ago`;
  if (!map.length) return seen;
  const best = Math.min(...map.map((tag) => tag.deviation_m));
  return `${map.length}, to ${best.toFixed(2)} m, ${seen}`;
}

function drawGrid(wide, high, shown) {
  const step = [0.25, 0.5, 1, 2, 5, 10, 20, 50].find((step) => shown / step < 6) || 100;
  const [left, right, low, top] = [view.x - wide, view.x + wide, -view.y - high, -view.y + high];
  let lines = "";
  for (let x = Math.ceil(left / step) * step; x <= right; x += step) lines += `M${x} ${low}V${top}`;
  for (let y = Math.ceil(low / step) * step; y <= top; y += step) lines += `M${left} ${y}H${right}`;
  if (!$("grid").firstChild) $("grid").append(svg("path"), svg("path", { class: "axis" }));
  $("grid").firstChild.setAttribute("d", lines);
  $("grid").lastChild.setAttribute("d", `M0 ${low}V${top}M${left} 0H${right}`);
  $("scale").textContent = `squares of ${step} m; disc: position uncertainty; dashed: the fence, ${flight.radius_m} m from the start${status.tags ? "; roundels: tags with one standard deviation, * surveyed" : ""}`;
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
  if (status.tags) $("tagsknown").textContent = tagsText();
  $("known").textContent = `${status.horizontal_deviation_m.toFixed(2)} m`;
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
$("map").onclick = (event) => {
  const place = new DOMPoint(event.clientX, event.clientY).matrixTransform($("map").getScreenCTM().inverse());
  wanted = { x: place.x, y: -place.y };
  wantedUntil = performance.now() + GO_AGAIN;
};
$("fly").onclick = () => {
  if (wanted) order({ order: "goto", x_m: wanted.x, y_m: wanted.y });
  wanted = null;
};
$("stay").onclick = () => (wanted = null);
document.onkeydown = (event) => {
  if (event.key === "Escape") wanted = null;
};
$("nearer").onclick = () => (zoom = Math.min(8, zoom * 1.5));
$("farther").onclick = () => (zoom = Math.max(0.1, zoom / 1.5));

connect();
draw();
