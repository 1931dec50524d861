"use strict";
// Draws the plots over one time axis, which can be zoomed and moved, and shows the moment under the cursor everywhere: its
// values, its place on the map, what the camera saw, and what the agent decided.
const { decisions, plans, tags, others, start, series, fence, bands, events, beliefs, states, late, begin, end } = JSON.parse(
  document.getElementById("decided").textContent,
);
const { times } = series;
const [LEFT, RIGHT, BOTTOM] = [46, 8, 16];
const SHORTEST = 0.5; // seconds that can be shown at least
const NEAR = 0.15; // events are "here" if they are as near to the cursor, in seconds
const why = document.getElementById("moment");
const rows = [...document.querySelectorAll("tr[data-at]")];
let shown = [begin, end]; // the part of the flight that is drawn
let marked = begin; // the time of the cursor

function element(name, text, parent, className) {
  const made = document.createElement(name);
  made.textContent = text;
  if (className) made.className = className;
  parent.append(made);
  return made;
}

function svg(name, attributes, parent, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
}

// The last index whose time is not later.
function indexAt(list, at) {
  let [low, high] = [0, list.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle] <= at) low = middle;
    else high = middle - 1;
  }
  return low;
}

// Round steps of an axis.
function steps(low, high, count) {
  const rough = (high - low) / count || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((wide) => wide >= rough) ?? rough;
  const all = [];
  for (let at = Math.ceil(low / step) * step; at <= high && all.length < 50; at += step) all.push(at);
  return { all, digits: Math.max(0, Math.ceil(-Math.log10(step))) };
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const inner = (box) => Math.max(box.clientWidth - LEFT - RIGHT, 10);
const x = (box, at, [from, to] = shown) => LEFT + ((at - from) / (to - from || 1)) * inner(box);
const timeAt = (box, px, [from, to] = shown) => clamp(from + ((px - LEFT) / inner(box)) * (to - from), begin, end);

// Background, time axis and events of a plot.
function ground(picture, box, height, labels) {
  for (const band of bands) {
    const [from, to] = [x(box, Math.max(band.from_s, shown[0])), x(box, Math.min(band.to_s, shown[1]))];
    if (to <= from) continue;
    const kind = typeof band.kind === "string" ? band.kind : band.kind.step % 2 ? "even" : "odd";
    svg("rect", { class: kind, x: from, y: 0, width: to - from, height: height - BOTTOM }, picture);
    if (labels && to - from > band.label.length * 6) svg("text", { x: from + 3, y: 11 }, picture, band.label);
  }
  const { all, digits } = steps(...shown, Math.max(2, inner(box) / 90));
  for (const at of all) {
    svg("path", { class: "grid", d: `M${x(box, at)} 0V${height - BOTTOM}` }, picture);
    svg("text", { x: x(box, at), y: height - 4, "text-anchor": "middle" }, picture, `${at.toFixed(digits)} s`);
  }
  for (const event of events) {
    if (event.at_s < shown[0] || event.at_s > shown[1]) continue;
    const grave = event.kind === "warning" || event.kind === "danger";
    const top = grave ? 0 : height - BOTTOM - 7;
    const line = svg("path", { class: `mark ${event.kind}`, d: `M${x(box, event.at_s)} ${top}V${height - BOTTOM}` }, picture);
    if (grave) line.setAttribute("stroke-dasharray", "2 3");
  }
}

// A line through the values that are shown; of several in one pixel the smallest and the largest.
function way(box, values, y) {
  const [from, to] = [indexAt(times, shown[0]), Math.min(indexAt(times, shown[1]) + 2, times.length)];
  const every = Math.max(1, Math.floor((to - from) / (2 * inner(box))));
  let [path, pen] = ["", "M"];
  const point = (index) => {
    path += `${pen}${x(box, times[index]).toFixed(1)} ${y(values[index]).toFixed(1)}`;
    pen = "L";
  };
  for (let index = from; index < to; index += every) {
    let [low, high] = [-1, -1];
    for (let at = index; at < Math.min(index + every, to); at += 1) {
      if (values[at] === null) continue;
      if (low < 0 || values[at] < values[low]) low = at;
      if (high < 0 || values[at] > values[high]) high = at;
    }
    if (low < 0) pen = "M";
    else for (const at of low === high ? [low] : [Math.min(low, high), Math.max(low, high)]) point(at);
  }
  return path;
}

function drawLines(picture, box, { lines, height }) {
  const [first, last] = [indexAt(times, shown[0]), indexAt(times, shown[1])];
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of lines) {
    for (let index = first; index <= last; index += 1) {
      if (values[index] === null) continue;
      low = Math.min(low, values[index]);
      high = Math.max(high, values[index]);
    }
  }
  ground(picture, box, height, box === boxes[0]);
  if (low > high) return;
  const room = Math.max((high - low) * 0.08, Math.abs(high) * 0.01, 0.02);
  [low, high] = [low - room, high + room];
  const y = (value) => 4 + (1 - (value - low) / (high - low)) * (height - BOTTOM - 8);
  const { all, digits } = steps(low, high, Math.max(2, height / 40));
  for (const at of all) {
    svg("path", { class: "grid", d: `M${LEFT} ${y(at)}H${LEFT + inner(box)}` }, picture);
    svg("text", { x: LEFT - 5, y: y(at) + 4, "text-anchor": "end" }, picture, figure(at, digits));
  }
  for (const { values, colour, dashed } of lines) {
    svg("path", { class: `line ${colour}${dashed ? " dashed" : ""}`, d: way(box, values, y) }, picture);
  }
}

const ROW = 18;
function drawStrips(picture, box, { strips, height }) {
  ground(picture, box, height, false);
  strips.forEach(({ name, spans }, row) => {
    for (const { from_s, to_s, level, text } of spans) {
      const [from, to] = [x(box, Math.max(from_s, shown[0])), x(box, Math.min(to_s, shown[1]))];
      if (to_s < shown[0] || from_s > shown[1]) continue;
      const place = { x: from, y: 2 + row * ROW, width: Math.max(to - from, 1.5), height: ROW - 3 };
      svg("rect", { class: `span ${level}`, ...place }, picture);
      const room = to - from > text.length * 6.2 + 6;
      if (room) svg("text", { class: level === "wrong" ? "inwrong" : "in", x: from + 4, y: 13 + row * ROW }, picture, text);
    }
    svg("text", { class: "in", x: 3, y: 13 + row * ROW }, picture, name.slice(0, 8));
  });
}

// All plots: containers, legends, and what draws them.
const [boxes, legends, drawings] = [[], [], []];
function add(title, height, keys, draw, note) {
  const place = document.getElementById("all");
  element("h3", title, place);
  const legend = element("div", "", place, "legend");
  const outs = keys.map(({ name, colour, dashed }) => {
    const key = element("span", "", legend);
    if (colour) element("i", "", key, `${colour}${dashed ? " dashed" : ""}`);
    key.append(`${name} `);
    return element("b", "–", key);
  });
  if (note) element("p", note, place, "faint");
  if (note && !draw) return;
  const box = element("div", "", place, "plot");
  box.tabIndex = 0;
  const picture = svg("svg", { role: "img", "aria-label": title, height }, box);
  element("div", "", box, "cursor");
  boxes.push(box);
  drawings.push(() => {
    picture.replaceChildren();
    draw(picture, box);
  });
  legends.push(outs);
  listen(box);
}

// Zero has no sign, also where it is rounded to.
const figure = (value, digits) => value.toFixed(digits).replace(/^-(?=[0.]*$)/, "");
const numbers = (value) => (value === null || value === undefined ? "–" : figure(value, Math.abs(value) >= 100 ? 1 : 2));
const readers = []; // for each plot, what is said at an index and a time

for (const { title, height, lines } of series.plots) {
  const known = lines.some(({ values }) => values.some((value) => value !== null));
  if (!known) {
    add(title, height, [], null, "Not recorded in this flight.");
    continue;
  }
  readers.push((index) => lines.map(({ values }) => numbers(values[index])));
  add(title, height, lines, (picture, box) => drawLines(picture, box, { lines, height }));
}
for (const [title, strips] of [
  ["What is believed of navdata", beliefs],
  ["What the drone says of itself", states],
]) {
  if (!strips.length) {
    add(title, 0, [], null, "Not recorded in this flight.");
    continue;
  }
  const height = strips.length * ROW + BOTTOM + 4;
  const said = (at) => ({ spans }) => spans.find(({ from_s, to_s }) => from_s <= at && at < to_s)?.text ?? "–";
  readers.push((_, at) => strips.map(said(at)));
  add(title, height, strips, (picture, box) => drawStrips(picture, box, { strips, height }));
}

// The whole flight, with the part that is shown.
const overview = document.getElementById("overview");
overview.tabIndex = 0;
const overviewPicture = svg("svg", { role: "img", "aria-label": "the whole flight, with its events and the part that is shown", height: 34 }, overview);
element("div", "", overview, "cursor");
boxes.push(overview);
function drawOverview() {
  const part = shown;
  shown = [begin, end];
  overviewPicture.replaceChildren();
  ground(overviewPicture, overview, 34, false);
  shown = part;
  const [from, to] = shown.map((at) => x(overview, at, [begin, end]));
  svg("rect", { class: "window", x: from, y: 0.5, width: to - from, height: 17 }, overviewPicture);
}

let due = false;
function draw() {
  if (due) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    drawings.forEach((drawOne) => drawOne());
    drawOverview();
    drawMap();
    mark();
  });
}

// Shows another part: of a length, with a moment at the same place as before.
function zoom(factor, at = marked) {
  const [from, to] = shown;
  const length = clamp((to - from) * factor, Math.min(SHORTEST, end - begin), end - begin);
  const share = to > from ? clamp((at - from) / (to - from), 0, 1) : 0.5;
  move(at - share * length, length);
}

function move(from, length = shown[1] - shown[0]) {
  const start = clamp(from, begin, Math.max(begin, end - length));
  shown = [start, Math.min(start + length, end)];
  document.getElementById("part").textContent = `${shown[0].toFixed(1)} to ${shown[1].toFixed(1)} s`;
  draw();
}

// Shows a moment, and moves to it if it is not in the part that is drawn.
function visit(at) {
  if (at < shown[0] || at > shown[1]) move(at - (shown[1] - shown[0]) / 2);
  show(at);
}

function mark() {
  for (const box of boxes) {
    const cursor = box.querySelector(".cursor");
    const at = box === overview ? x(box, marked, [begin, end]) : x(box, marked);
    cursor.style.left = `${at}px`;
    cursor.style.display = at >= LEFT - 1 && at <= box.clientWidth - RIGHT + 1 ? "block" : "none";
  }
}

function show(seconds) {
  marked = clamp(seconds, begin, end);
  mark();
  const index = indexAt(times, marked);
  readers.forEach((read, plot) => read(index, marked).forEach((text, line) => (legends[plot][line].textContent = text)));
  const found = decisions.findIndex((decision) => marked < decision.to_s);
  const decision = decisions[found < 0 ? decisions.length - 1 : found];
  why.replaceChildren();
  element("p", `${marked.toFixed(2)} s · ${decision.step}`, why).className = "now";
  const here = events.filter((event) => Math.abs(event.at_s - marked) <= NEAR).slice(0, 12);
  if (here.length) {
    const list = element("ul", "", why);
    for (const { at_s, kind, text } of here) {
      const grave = kind === "warning" || kind === "danger";
      element("li", `${at_s.toFixed(2)} s ${kind}: ${text}`, list, grave ? "warn" : "");
    }
  }
  element("p", `ordered: ${decision.command}`, why);
  if (decision.said) element("p", decision.said, why);
  for (const warning of decision.warnings) element("p", warning, why, "warn");
  for (const [trigger, line] of decision.plans) {
    element("p", `because of line ${line}`, why, "faint");
    element("pre", plans[line] || trigger, why);
  }
  drawPlace();
  camera?.show(marked);
  rows.forEach((row) => row.classList.toggle("now", Number(row.dataset.index) === found));
}

// A fence that is larger than the flight by this factor would leave no room for the flight.
const MUCH_LARGER = 4;
const CALM = 0.05; // less wind has no direction, in m/s²

// The map: the way, the part of it that is flown at the cursor, the drone, other vehicles, targets, tags, the fence, and the wind at the cursor.
const map = document.getElementById("map");
const [right, forward, heading] = series.track;
let scale = null;
function drawMap() {
  const width = map.parentElement.clientWidth;
  const height = Math.min(width, window.innerWidth <= 900 ? window.innerHeight * 0.26 : 380);
  map.setAttribute("height", height);
  map.replaceChildren();
  const seen = tags.flatMap((moment) => moment.tags);
  const heard = others.flatMap(({ places }) => places);
  const all = (values, other, key) => [0, ...values.filter((value) => value !== null), ...other, ...seen.map((tag) => tag[key]), ...heard.map((at) => at[key === "x_m" ? 1 : 2])];
  const extent = (list) => list.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [0, 0]);
  let [across, along] = [extent(all(right, series.targets.map(([at]) => at), "x_m")), extent(all(forward, series.targets.map(([, at]) => at), "y_m"))];
  const corners = fence ? fence.corners : [];
  const [wide, deep] = [0, 1].map((axis) => extent(corners.map((corner) => corner[axis])));
  const size = (...extents) => Math.max(...extents.map(([low, high]) => high - low));
  const seesFence = size(wide, deep) <= MUCH_LARGER * Math.max(size(across, along), 0.5);
  if (seesFence) [across, along] = [extent([...across, ...wide]), extent([...along, ...deep])];
  const metres = Math.max((across[1] - across[0]) / width, (along[1] - along[0]) / height, 1 / width) * 1.2;
  const middle = [(across[0] + across[1]) / 2, (along[0] + along[1]) / 2];
  const place = (px, py) => [width / 2 + (px - middle[0]) / metres, height / 2 - (py - middle[1]) / metres];
  scale = { place, metres, width, height };
  const grid = steps(0, metres * width, 6);
  const step = (grid.all[1] ?? 1) - (grid.all[0] ?? 0) || 1;
  const lines = (centre, half) => {
    const list = [];
    for (let at = Math.ceil((centre - half) / step) * step; at <= centre + half && list.length < 60; at += step) list.push(at);
    return list;
  };
  for (const at of lines(middle[0], (metres * width) / 2)) svg("path", { class: "grid", d: `M${place(at, 0)[0]} 0V${height}` }, map);
  for (const at of lines(middle[1], (metres * height) / 2)) svg("path", { class: "grid", d: `M0 ${place(0, at)[1]}H${width}` }, map);
  svg("text", { x: 6, y: height - 6 }, map, `a square is ${step.toFixed(grid.digits)} m; forward is up`);
  if (fence) {
    const border = corners.map(([px, py]) => place(px, py).map((at) => at.toFixed(1)).join(" "));
    svg("path", { class: "fence", d: `M${border.join("L")}Z` }, map);
    svg("text", { x: 6, y: height - 20, class: "fencetext" }, map, `dashed: the fence, ${fence.text}${seesFence ? "" : ", beyond this map"}`);
  }
  const [hx, hy] = place(...start);
  svg("path", { class: "home", d: `M${hx} ${hy - 6}L${hx + 6} ${hy + 5}H${hx - 6}Z` }, map);
  for (const { places } of others) {
    const way = places.map(([, px, py]) => place(px, py).map((at) => at.toFixed(1)).join(" "));
    svg("path", { class: "heard", d: `M${way.join("L")}` }, map);
  }
  svg("path", { class: "way", d: trail(times.length - 1) }, map);
  svg("path", { class: "flown", d: "" }, map);
  series.targets.forEach(([px, py]) => svg("circle", { class: "aim", cx: place(px, py)[0], cy: place(px, py)[1], r: 5 }, map));
  drawPlace();
}

function trail(last) {
  let [path, pen] = ["", "M"];
  for (let index = 0; index <= last; index += 1) {
    if (right[index] === null || forward[index] === null) {
      pen = "M";
      continue;
    }
    const [px, py] = scale.place(right[index], forward[index]);
    path += `${pen}${px.toFixed(1)} ${py.toFixed(1)}`;
    pen = "L";
  }
  return path;
}

function drawPlace() {
  if (!scale) return;
  const index = indexAt(times, marked);
  map.querySelector(".flown").setAttribute("d", trail(index));
  map.querySelectorAll(".tag, .drone, .wind, .vehicle").forEach((old) => old.remove());
  drawTags();
  drawOthers();
  drawWind(index);
  if (right[index] === null || forward[index] === null) return;
  const [px, py] = scale.place(right[index], forward[index]);
  const turn = `translate(${px} ${py}) rotate(${heading[index] ?? 0})`;
  svg("path", { class: "drone", d: "M0-11L8 8L0 4L-8 8Z", transform: turn }, map);
}

// Where the other vehicles were at the cursor, as this one had heard by then, with the numbers of their MAVLink systems.
function drawOthers() {
  for (const { system, places } of others) {
    const later = places.findIndex(([at]) => at > marked);
    const then = places[(later < 0 ? places.length : later) - 1];
    if (!then) continue;
    const [cx, cy] = scale.place(then[1], then[2]);
    const group = svg("g", { class: "vehicle" }, map);
    svg("circle", { cx, cy, r: 5 }, group);
    svg("text", { x: cx, y: cy - 9, "text-anchor": "middle" }, group, `vehicle ${system}`);
  }
}

// An arrow with the wind, and the side from which it comes, in the frame of the plan.
function drawWind(index) {
  const [towardsRight, forwards] = series.wind.map((values) => values[index]);
  if (towardsRight === null || forwards === null) return;
  const strength = Math.hypot(towardsRight, forwards);
  const group = svg("g", { class: "wind" }, map);
  const bearing = (Math.atan2(towardsRight, forwards) * 180) / Math.PI;
  const side = series.wind_from[(Math.round(bearing / 45) + 8) % 8];
  const text = strength < CALM ? "no wind felt" : `wind ${side}, ${strength.toFixed(1)} m/s²`;
  svg("text", { x: scale.width - 34, y: 20, "text-anchor": "end" }, group, text);
  if (strength >= CALM) svg("path", { d: "M0 11V-11M-5-5L0-11L5-5", transform: `translate(${scale.width - 17} 16) rotate(${bearing})` }, group);
}

// A tag that was not seen for this long is drawn faintly, in seconds.
const STALE = 2;

// The tags known at the cursor, with their direction, number, and a circle of one standard deviation.
function drawTags() {
  const text = document.getElementById("tagtext");
  if (!tags.length) return;
  const later = tags.findIndex(({ at_s }) => at_s > marked);
  const then = tags[(later < 0 ? tags.length : later) - 1];
  for (const tag of then ? then.tags : []) {
    const seen = tag.seen_s !== null && tag.seen_s < STALE;
    const group = svg("g", { class: seen ? "tag" : "tag stale" }, map);
    const [cx, cy] = scale.place(tag.x_m, tag.y_m);
    svg("circle", { class: "spread", cx, cy, r: tag.uncertainty_m / scale.metres }, group);
    if (tag.heading_deg !== null) svg("path", { class: "direction", d: "M0-7V-17", transform: `translate(${cx} ${cy}) rotate(${tag.heading_deg})` }, group);
    svg("circle", { class: "rim", cx, cy, r: 7 }, group);
    svg("circle", { cx, cy, r: 2.5 }, group);
    svg("text", { x: cx, y: cy + 26, "text-anchor": "middle" }, group, `${tag.id}${tag.surveyed ? "*" : ""}`);
  }
  const list = (then ? then.tags : []).map(({ id, x_m, y_m, heading_deg, uncertainty_m, surveyed, seen_s }) => {
    const turned = heading_deg === null ? "" : `, ${heading_deg.toFixed(0)}°`;
    const seen = seen_s === null ? "not seen" : `seen ${seen_s.toFixed(1)} s before`;
    return `${id}${surveyed ? "*" : ""} at ${x_m.toFixed(2)} ${y_m.toFixed(2)} m, uncertainty ${uncertainty_m.toFixed(2)} m${turned}, ${seen}`;
  });
  text.textContent = `Tags known at ${marked.toFixed(1)} s (* surveyed; circle: one standard deviation): ${list.join("; ") || "none"}.`;
}

// What the camera saw: the browser decodes the picture of a moment, from the last one before it with which it can begin.
const camera = (() => {
  const pictures = JSON.parse(document.getElementById("pictures").textContent);
  const canvas = document.getElementById("picture");
  if (!pictures.length) return null;
  const note = document.getElementById("nopicture");
  if (!("VideoDecoder" in window)) {
    note.textContent = "This browser cannot decode the pictures here (WebCodecs); Chromium can.";
    return null;
  }
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  // "avc1.42801e": profile, constraints and level from the sequence parameter set behind the start code.
  const codecOf = (data) => "avc1." + [5, 6, 7].map((index) => data[index].toString(16).padStart(2, "0")).join("");
  let wanted = null; // index of the picture to show
  let shown = null;
  let busy = false;

  async function decode(index) {
    let first = index;
    while (first > 0 && !pictures[first].entry) first -= 1;
    let last = null;
    const decoder = new VideoDecoder({
      output: (frame) => {
        last?.close();
        last = frame;
      },
      error: (error) => (note.textContent = `The picture cannot be decoded: ${error.message}`),
    });
    decoder.configure({ codec: codecOf(bytes(pictures[first].data)) });
    for (let at = first; at <= index; at += 1) {
      const { entry, at_s, data } = pictures[at];
      decoder.decode(new EncodedVideoChunk({ type: entry ? "key" : "delta", timestamp: at_s * 1e6, data: bytes(data) }));
    }
    await decoder.flush();
    decoder.close();
    if (!last) return;
    Object.assign(canvas, { width: last.displayWidth, height: last.displayHeight });
    canvas.getContext("2d").drawImage(last, 0, 0);
    last.close();
    note.textContent = `picture of ${pictures[index].at_s.toFixed(2)} s`;
    shown = index;
  }

  async function work() {
    if (busy) return;
    busy = true;
    while (wanted !== shown) {
      const index = wanted;
      try {
        await decode(index);
      } catch (error) {
        note.textContent = `The picture cannot be decoded: ${error.message}`;
      }
      shown = index;
    }
    busy = false;
  }

  return {
    show(seconds) {
      const later = pictures.findIndex(({ at_s }) => at_s > seconds);
      wanted = Math.max(0, (later < 0 ? pictures.length : later) - 1);
      work();
    },
    shown: () => shown,
  };
})();

// The mouse moves the cursor, and a drag the part that is shown; a finger moves the cursor, and two zoom.
function listen(box) {
  const whole = box.id === "overview" ? [begin, end] : undefined;
  const fingers = new Map();
  let drag = null;
  const at = (event) => timeAt(box, event.clientX - box.getBoundingClientRect().left, whole ?? shown);
  const apart = () => {
    const [one, other] = [...fingers.values()];
    return Math.max(Math.abs(one - other), 10);
  };
  box.addEventListener("pointerdown", (event) => {
    if (event.button) return;
    fingers.set(event.pointerId, event.clientX);
    box.setPointerCapture(event.pointerId);
    drag = { px: event.clientX, from: shown[0], apart: fingers.size > 1 ? apart() : 0 };
    if (whole) move(at(event) - (shown[1] - shown[0]) / 2);
    show(at(event));
  });
  box.addEventListener("pointermove", (event) => {
    if (fingers.has(event.pointerId)) fingers.set(event.pointerId, event.clientX);
    if (fingers.size > 1) {
      const now = apart();
      zoom(drag.apart / now, at(event));
      drag.apart = now;
      return;
    }
    if (drag && fingers.size && whole) move(at(event) - (shown[1] - shown[0]) / 2);
    else if (drag && fingers.size && event.pointerType === "mouse") {
      move(drag.from - ((event.clientX - drag.px) / inner(box)) * (shown[1] - shown[0]));
    }
    show(at(event));
  });
  for (const name of ["pointerup", "pointercancel"]) box.addEventListener(name, (event) => fingers.delete(event.pointerId));
  box.addEventListener("wheel", (event) => {
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (!whole && !sideways && !event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    if (sideways) move(shown[0] + (event.deltaX / inner(box)) * (shown[1] - shown[0]));
    else zoom(1.2 ** Math.sign(event.deltaY), at(event));
  }, { passive: false });
  box.addEventListener("dblclick", () => move(begin, end - begin));
  box.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -0.1, ArrowRight: 0.1, PageUp: -5, PageDown: 5, Home: -Infinity, End: Infinity }[event.key];
    const factor = { "+": 0.5, "=": 0.5, "-": 2, 0: Infinity }[event.key];
    if (by === undefined && factor === undefined) return;
    event.preventDefault();
    if (factor) zoom(factor);
    else visit(clamp(marked + by, begin, end));
  });
}
listen(overview);
document.getElementById("in").addEventListener("click", () => zoom(0.5));
document.getElementById("out").addEventListener("click", () => zoom(2));
document.getElementById("whole").addEventListener("click", () => move(begin, end - begin));

// A click on the map goes to the moment at which the drone was nearest to it.
map.parentElement.addEventListener("click", (event) => {
  const box = map.getBoundingClientRect();
  let [nearest, least] = [-1, Infinity];
  right.forEach((value, index) => {
    if (value === null || forward[index] === null) return;
    const [px, py] = scale.place(value, forward[index]);
    const off = Math.hypot(px - event.clientX + box.left, py - event.clientY + box.top);
    if (off < least) [nearest, least] = [index, off];
  });
  if (nearest >= 0) visit(times[nearest]);
});
for (const row of rows) row.addEventListener("click", () => visit(Number(row.dataset.at) + 0.001));
for (const button of document.querySelectorAll("#findings button")) {
  button.addEventListener("click", () => {
    const at = Number(button.dataset.at);
    move(at - 2, Math.min(6, end - begin));
    show(at);
  });
}

// How late ticks were: shares on a logarithmic scale.
const bars = document.getElementById("late");
const most = Math.log10(Math.max(...late, 1)) + 0.2;
late.forEach((count, index) => {
  if (!count) return;
  const height = ((Math.log10(count) + 0.2) / most) * 80;
  const bar = svg("rect", { class: "bar", x: 4 + index * 6, y: 84 - height, width: 5, height }, bars);
  svg("title", {}, bar, `${(index / 10).toFixed(1)} ms: ${count} ticks`);
});
for (let ms = 0; ms <= 5; ms += 1) svg("text", { x: 4 + ms * 60, y: 98 }, bars, `${ms} ms`);

window.addEventListener("resize", draw);
// In the page of a drone that flies, the keys by which it holds and lands must work here, too.
if (parent !== window) {
  window.addEventListener("keydown", ({ key, repeat, ctrlKey, metaKey, altKey }) => {
    if (repeat || ctrlKey || metaKey || altKey || ![" ", "l", "L"].includes(key)) return;
    // Any origin: a key's name is no secret.
    parent.postMessage({ key }, "*");
  });
}
drawMap();
move(begin, end - begin);
// Where something went wrong, if anything did.
show(Number(document.querySelector("#findings button")?.dataset.at ?? begin));
