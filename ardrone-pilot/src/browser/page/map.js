"use strict";
// The map: the drone from above, its way, and what is planned.

const $ = (id) => document.getElementById(id);
const svg = (name, attributes = {}) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
};
// Sets attributes that have changed: the others would be laid out and painted anew all the same.
const set = (element, attributes) => {
  for (const [key, value] of Object.entries(attributes)) {
    if (element.getAttribute(key) !== String(value)) element.setAttribute(key, value);
  }
};
// An empty canvas as large as it is shown, in pixels of the screen.
function emptied(canvas) {
  const { width, height } = canvas.getBoundingClientRect();
  const scale = devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
  if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "11px system-ui, sans-serif";
  return { context, width, height };
}
const points = (places) => places.map(([x, y]) => `${x.toFixed(3)},${(-y).toFixed(3)}`).join(" ");

const map = (() => {
  // A tag that was not seen for this long is drawn faintly, in seconds.
  const STALE = 2;

  const [NEAREST, FARTHEST] = [0.3, 100]; // half of the smaller side of the map, in metres
  const JUMP = 1; // between two places of the flown way, in metres
  const FOLLOWS = 150; // the view follows with this time constant, in milliseconds
  const TREMBLES = 4; // a hand that clicks moves this far, in pixels

  let view = null; // the part of the world on the map: { x, y, half }
  let mode = "all"; // what the view shows: "all", "drone", or what was "chosen" by hand
  const fingers = new Map(); // pointers on the map: [x, y] in pixels
  let moved = false; // the last press has moved the map
  let onTarget = false; // it began on a target that can be dragged
  let approachedAt = 0; // when the view last followed
  let trailDrawn = null; // what is drawn of the flown way
  let tags = new Map(); // marks of the known tags by their number
  let marks = []; // of targets: { labels, mark, x, y }
  let shown = ""; // the targets that the marks are for

  // Marks for targets [{ x, y, label }], where targets at one place share a mark.
  function setTargets(targets) {
    const key = JSON.stringify(targets);
    if (key === shown) return;
    shown = key;
    marks = gathered(targets, 0.1).map(({ x, y, all }) => {
      const mark = svg("g");
      mark.append(svg("circle", { r: 0.8 }), svg("text", { y: -1.7, "font-size": 1.3 }));
      mark.lastChild.textContent = numbers(all);
      return { x, y, labels: all.map(({ label }) => label), mark };
    });
    $("targets").replaceChildren(...marks.map(({ mark }) => mark));
  }

  // Targets by their places, where those within `apart` metres share one: [{ x, y, all }].
  function gathered(targets, apart) {
    const cells = new Map(); // places by the square of the ground that they are in
    const places = [];
    for (const target of targets) {
      const [column, row] = [Math.floor(target.x / apart), Math.floor(target.y / apart)];
      const near = [-1, 0, 1].flatMap((right) => [-1, 0, 1].flatMap((up) => cells.get(`${column + right} ${row + up}`) ?? []));
      const place = near.find(({ x, y }) => Math.hypot(x - target.x, y - target.y) < apart);
      if (place) {
        place.all.push(target);
        continue;
      }
      places.push({ x: target.x, y: target.y, all: [target] });
      const cell = `${column} ${row}`;
      cells.set(cell, [...(cells.get(cell) ?? []), places.at(-1)]);
    }
    return places;
  }

  // "2, 5" or "2 … 40" of targets that share a mark.
  function numbers(targets) {
    const labels = targets.map(({ label }) => label);
    return labels.length > 3 ? `${labels[0]} … ${labels.at(-1)}` : labels.join(", ");
  }

  // What there is to see: places that must be on the map.
  function extent() {
    const planning = document.body.dataset.view === "plan";
    const places = [flight.start_m];
    if (planning) {
      places.push(...plan.places());
    } else {
      for (const { target } of flight.steps) if (target) places.push([target.x_m, target.y_m]);
      if (status && status.pose) places.push([status.pose.x_m, status.pose.y_m]);
      places.push(...fleet.places());
      const played = flights.playing();
      if (played) places.push([played.pose.x_m, played.pose.y_m]);
      if (status && status.target) places.push([status.target.x_m, status.target.y_m]);
    }
    for (const tag of known()) places.push([tag.x_m, tag.y_m]);
    return places;
  }

  function draw() {
    const element = $("map");
    const { width, height } = element.getBoundingClientRect();
    if (!width || !height) return;
    const places = extent();
    const [xs, ys] = [0, 1].map((axis) => places.map((place) => place[axis]));
    const middle = (values) => (Math.min(...values) + Math.max(...values)) / 2;
    const reach = (values) => (Math.max(...values) - Math.min(...values)) / 2;
    const least = Math.min(width, height);
    const half = Math.max((reach(xs) * least) / width, (reach(ys) * least) / height, 0.8) * 1.25 + 0.3;
    // The view follows smoothly and does not zoom in by itself. It stays where a hand has put it.
    view ??= { x: middle(xs), y: middle(ys), half };
    if (mode === "all" && !plan.isDragging()) {
      view.half = Math.max(view.half, half);
      approach(middle(xs), middle(ys));
    }
    if (mode === "drone" && status && status.pose) approach(status.pose.x_m, status.pose.y_m);
    const visible = view.half;
    const [wide, high] = [(visible * width) / least, (visible * height) / least];
    set(element, { viewBox: `${view.x - wide} ${-view.y - high} ${2 * wide} ${2 * high}` });
    drawGrid(wide, high, visible);
    // Of a mark, in metres: large enough for its number on a small screen, in pixels.
    const SMALLEST = 14;
    const size = Math.max(visible * 0.05, (SMALLEST * 2 * visible) / least);
    set($("fence"), { points: points(flight.fence.outline_m) });
    drawFenceArrow(wide, high, width, height);
    $("all").ariaPressed = String(mode === "all");
    $("follow").ariaPressed = String(mode === "drone");
    const planning = document.body.dataset.view === "plan";
    plan.drawOn(size);
    if (planning) {
      setTargets([]);
      set($("way"), { points: points([flight.start_m, ...plan.targets().map(({ x, y }) => [x, y])]) });
    } else {
      const numbered = flight.steps.map(({ target }, index) => ({ target, label: index + 1 })).filter(({ target }) => target);
      setTargets(numbered.map(({ target, label }) => ({ x: target.x_m, y: target.y_m, label })));
      set($("way"), { points: points([flight.start_m, ...numbered.map(({ target }) => [target.x_m, target.y_m])]) });
    }
    for (const { x, y, labels, mark } of marks) {
      const isNow = status && labels.includes(status.step + 1);
      set(mark, { transform: `translate(${x} ${-y}) scale(${size * 0.8})`, class: isNow ? "now" : "" });
    }
    fleet.drawOn(size);
    drawDrone(size);
    drawTags(size);
  }

  // Moves the view a part of the way to a middle. It arrives: a view that trembles would be painted for ever.
  function approach(x, y) {
    const now = performance.now();
    const near = Math.hypot(x - view.x, y - view.y) < view.half * 0.002;
    const share = near ? 1 : 1 - Math.exp((approachedAt - now) / FOLLOWS);
    approachedAt = now;
    view.x += (x - view.x) * share;
    view.y += (y - view.y) * share;
  }

  // The flown way. Where it jumps, another flight has begun with a frame of its own.
  function flownWay() {
    const jumps = ([x, y], before) => !before || Math.hypot(x - before[0], y - before[1]) > JUMP;
    return trail.map((place, index) => `${jumps(place, trail[index - 1]) ? "M" : "L"}${points([place])}`).join("");
  }

  function drawDrone(size) {
    const pose = status && status.pose;
    const target = status && status.target;
    const put = (id, place, more = "") => {
      $(id).style.display = place ? "" : "none";
      if (place) $(id).setAttribute("transform", `translate(${place.x} ${-place.y}) scale(${size}) ${more}`);
    };
    const at = (place) => place && { x: place.x_m, y: place.y_m };
    put("drone", at(pose), pose ? `rotate(${pose.yaw_deg})` : "");
    put("aim", at(target));
    const played = document.body.dataset.view === "fly" ? flights.playing() : null;
    put("ghost", played && at(played.pose), played ? `rotate(${played.pose.yaw_deg})` : "");
    set($("ghostway"), { points: played ? points(played.way) : "" });
    put("wanted", wanted);
    $("doubt").style.display = pose ? "" : "none";
    if (pose) {
      set($("doubt"), { cx: pose.x_m, cy: -pose.y_m, r: 2 * status.uncertainty_m });
    }
    const end = trail.at(-1);
    if (end !== trailDrawn) set($("trail"), { d: flownWay() });
    trailDrawn = end;
  }

  // Where the fence is, if nothing of it is on the map.
  function drawFenceArrow(wide, high, width, height) {
    const outline = flight.fence.outline_m;
    const inside = ([x, y]) => Math.abs(x - view.x) < wide && Math.abs(y - view.y) < high;
    const nearest = ([x, y], [u, v]) => {
      const along = Math.max(0, Math.min(1, ((view.x - x) * (u - x) + (view.y - y) * (v - y)) / Math.max(1e-9, (u - x) ** 2 + (v - y) ** 2)));
      return [x + along * (u - x), y + along * (v - y)];
    };
    const sides = outline.map((corner, index) => nearest(corner, outline[(index + 1) % outline.length]));
    const away = ([x, y]) => Math.hypot(x - view.x, y - view.y);
    const place = sides.reduce((best, side) => (away(side) < away(best) ? side : best));
    $("fencearrow").hidden = sides.some(inside) || outline.some(inside);
    if ($("fencearrow").hidden) return;
    const turn = Math.atan2(place[0] - view.x, place[1] - view.y);
    $("fencearrow").firstElementChild.style.transform = `rotate(${turn}rad)`;
    $("fencearrow").lastElementChild.textContent = `fence, ${away(place).toFixed(1)} m`;
    // Beside the buttons at the right.
    const [x, y] = [Math.min(Math.sin(turn) * (width / 2 - 60), width / 2 - 130), -Math.cos(turn) * (height / 2 - 40)];
    $("fencearrow").style.transform = `translate(${width / 2 + x - 45}px, ${height / 2 + y - 12}px)`;
  }

  const known = () => (status && status.tags ? status.tags.map : []);

  // Each tag as a roundel with a mark in its direction, its number, and a circle of one standard deviation.
  function drawTags(size) {
    const seen = known();
    for (const [id, mark] of tags) {
      if (seen.some((tag) => tag.id === id)) continue;
      mark.remove();
      tags.delete(id);
    }
    for (const tag of seen) {
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
      set(spread, { r: tag.uncertainty_m });
      set(roundel, { transform: `scale(${size * 0.8}) rotate(${tag.heading_deg ?? 0})` });
      roundel.firstChild.style.display = tag.heading_deg === null ? "none" : "";
      set(number, { transform: `scale(${size * 0.8})` });
      number.textContent = `${tag.id}${tag.surveyed ? "*" : ""}`;
      const isFresh = tag.seen_s !== null && tag.seen_s < STALE;
      set(mark, { transform: `translate(${tag.x_m} ${-tag.y_m})`, class: isFresh ? "" : "stale" });
    }
  }

  // "2, the best with an uncertainty of 0.04 m, seen 0.1 s ago".
  function tagsText() {
    const seen = status.tags.seen_s === null ? "none seen yet" : `seen ${status.tags.seen_s.toFixed(1)} s ago`;
    if (!known().length) return seen;
    const best = Math.min(...known().map((tag) => tag.uncertainty_m));
    return `${known().length}, the best with an uncertainty of ${best.toFixed(2)} m, ${seen}`;
  }

  function drawGrid(wide, high, visible) {
    const step = [0.25, 0.5, 1, 2, 5, 10, 20, 50].find((step) => visible / step < 6) || 100;
    const [left, right, low, top] = [view.x - wide, view.x + wide, -view.y - high, -view.y + high];
    let lines = "";
    for (let x = Math.ceil(left / step) * step; x <= right; x += step) lines += `M${x} ${low}V${top}`;
    for (let y = Math.ceil(low / step) * step; y <= top; y += step) lines += `M${left} ${y}H${right}`;
    if (!$("grid").firstChild) $("grid").append(svg("path"), svg("path", { class: "axis" }));
    set($("grid").firstChild, { d: lines });
    set($("grid").lastChild, { d: `M0 ${low}V${top}M${left} 0H${right}` });
    const tagged = status && status.tags ? "; tags with one standard deviation, * surveyed" : "";
    const simulated = document.body.dataset.view === "plan" && plan.simulated() ? "; line: where the simulated drone flew" : "";
    const { width } = $("map").getBoundingClientRect();
    const pixels = (step * width) / (2 * wide);
    // As wide as its text.
    const bar = [1, 2, 4].find((bar) => bar * pixels > 56) ?? 8;
    $("scalebar").style.width = `${bar * pixels}px`;
    $("scalebar").textContent = `${bar * step} m`;
    $("scale").textContent = `disc: position uncertainty; dashed: the fence, ${flight.fence.text}${tagged}${simulated}`;
  }

  // Where a mouse or a finger points to, in metres right and forward.
  function place(event) {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform($("map").getScreenCTM().inverse());
    return { x, y: -y };
  }

  // Zooms by a factor about a place that stays where it is.
  function zoom(factor, about) {
    if (!view) return;
    const half = Math.max(NEAREST, Math.min(FARTHEST, view.half * factor));
    const ratio = half / view.half;
    view = { x: about.x + (view.x - about.x) * ratio, y: about.y + (view.y - about.y) * ratio, half };
    // A drone that is followed stays in the middle.
    if (mode === "all") mode = "chosen";
  }

  function shift(from, to) {
    view = { ...view, x: view.x + from.x - to.x, y: view.y + from.y - to.y };
    mode = "chosen";
  }

  // Where a finger is after all moves so far, also those that are not drawn yet.
  function spot([x, y]) {
    const box = $("map").getBoundingClientRect();
    const metres = (2 * view.half) / Math.min(box.width, box.height);
    return { x: view.x + (x - box.x - box.width / 2) * metres, y: view.y - (y - box.y - box.height / 2) * metres };
  }
  // Middle and span of two fingers.
  function pinched() {
    const [[x, y], [u, v]] = [...fingers.values()];
    return { middle: [(x + u) / 2, (y + v) / 2], span: Math.max(10, Math.hypot(x - u, y - v)) };
  }

  $("map").addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.0015), place(event));
  }, { passive: false });
  $("map").addEventListener("pointerdown", (event) => {
    // The first finger begins anew: the end of a press may have been elsewhere.
    if (event.isPrimary) {
      fingers.clear();
      moved = false;
    }
    // A target is dragged by itself, but two fingers zoom wherever they are.
    if (event.isPrimary) onTarget = Boolean(event.target.closest("#drafts .free"));
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  $("map").addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before || !view) return;
    const now = [event.clientX, event.clientY];
    if (onTarget && fingers.size === 1) {
      fingers.set(event.pointerId, now);
      return;
    }
    if (!moved && Math.hypot(now[0] - before[0], now[1] - before[1]) < TREMBLES) return;
    if (!moved) $("map").setPointerCapture(event.pointerId);
    moved = true;
    if (fingers.size === 2) {
      const was = pinched();
      fingers.set(event.pointerId, now);
      const is = pinched();
      shift(spot(was.middle), spot(is.middle));
      zoom(was.span / is.span, spot(is.middle));
    } else {
      fingers.set(event.pointerId, now);
      shift(spot(before), spot(now));
    }
  });
  for (const end of ["pointerup", "pointercancel"]) $("map").addEventListener(end, (event) => fingers.delete(event.pointerId));

  const middle = () => ({ x: view.x, y: view.y });
  // By keys as by hand: arrows move what is seen by a fifth of the map, + and − zoom. By hand the arrows fly the drone.
  $("map").addEventListener("keydown", (event) => {
    const flies = document.body.classList.contains("hand");
    if (!view || flies || event.ctrlKey || event.metaKey || event.altKey) return;
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
    const factor = { "+": 1 / 1.5, "=": 1 / 1.5, "-": 1.5 }[event.key];
    if (by) shift({ x: 0.4 * view.half * by[0], y: 0.4 * view.half * by[1] }, { x: 0, y: 0 });
    else if (factor) zoom(factor, middle());
    else return;
    event.preventDefault();
  });
  $("nearer").onclick = () => view && zoom(1 / 1.5, middle());
  $("farther").onclick = () => view && zoom(1.5, middle());
  $("all").onclick = () => {
    mode = "all";
    view = null;
  };
  $("follow").onclick = () => (mode = mode === "drone" ? "chosen" : "drone");
  $("clear").onclick = () => {
    trail = [];
    trailOfFlight = 0;
  };

  return {
    draw,
    place,
    gathered,
    numbers,
    tagsText,
    // What is pointed to stays under the pointer.
    keep: () => (mode = mode === "all" ? "chosen" : mode),
    wasMoved: () => moved,
    reset: () => {
      view = null;
      mode = "all";
    },
  };
})();
