"use strict";
// The map: the drone from above, its way, and what is planned.

const $ = (id) => document.getElementById(id);
const svg = (name, attributes = {}) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
};
const points = (places) => places.map(([x, y]) => `${x.toFixed(3)},${(-y).toFixed(3)}`).join(" ");

const map = (() => {
  // A tag that was not seen for this long is drawn faintly, in seconds.
  const STALE = 2;

  let zoom = 1;
  let view = null; // the part of the world on the map: { x, y, half }
  let tags = new Map(); // marks of the known tags by their number
  let marks = []; // of targets: { x, y, steps, mark }
  let shown = []; // the targets that the marks are for

  // Marks for targets [{ x, y, label }], where targets at one place share a mark.
  function setTargets(targets) {
    const key = JSON.stringify(targets);
    if (key === shown) return;
    shown = key;
    marks = [];
    $("targets").replaceChildren();
    for (const { x, y, label } of targets) {
      let place = marks.find((other) => Math.hypot(other.x - x, other.y - y) < 0.1);
      if (!place) {
        place = { x, y, labels: [], mark: svg("g") };
        place.mark.append(svg("circle", { r: 0.8 }), svg("text", { y: -1.7, "font-size": 1.3 }));
        $("targets").append(place.mark);
        marks.push(place);
      }
      place.labels.push(label);
      place.mark.lastChild.textContent = place.labels.join(", ");
    }
  }

  // What there is to see: places that must be on the map.
  function extent() {
    const planning = document.body.dataset.view === "plan";
    const places = [[0, 0]];
    if (planning) {
      places.push(...plan.places());
    } else {
      for (const { target } of flight.steps) if (target) places.push([target.x_m, target.y_m]);
      if (status && status.pose) places.push([status.pose.x_m, status.pose.y_m]);
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
    // The view follows smoothly and does not zoom in by itself. It stays while a target is dragged.
    view ??= { x: middle(xs), y: middle(ys), half };
    if (!plan.isDragging()) {
      view.half = Math.max(view.half, half);
      view.x += (middle(xs) - view.x) * 0.1;
      view.y += (middle(ys) - view.y) * 0.1;
    }
    const visible = view.half / zoom;
    const [wide, high] = [(visible * width) / least, (visible * height) / least];
    element.setAttribute("viewBox", `${view.x - wide} ${-view.y - high} ${2 * wide} ${2 * high}`);
    drawGrid(wide, high, visible);
    // Of a mark, in metres: large enough for its number on a small screen, in pixels.
    const SMALLEST = 14;
    const size = Math.max(visible * 0.05, (SMALLEST * 2 * visible) / least);
    $("fence").setAttribute("points", points(flight.fence.outline_m));
    const planning = document.body.dataset.view === "plan";
    plan.drawOn(size);
    if (planning) {
      setTargets([]);
      $("way").setAttribute("points", points([[0, 0], ...plan.targets().map(({ x, y }) => [x, y])]));
    } else {
      const numbered = flight.steps.map(({ target }, index) => ({ target, label: index + 1 })).filter(({ target }) => target);
      setTargets(numbered.map(({ target, label }) => ({ x: target.x_m, y: target.y_m, label })));
      $("way").setAttribute("points", points([[0, 0], ...numbered.map(({ target }) => [target.x_m, target.y_m])]));
    }
    for (const { x, y, labels, mark } of marks) {
      mark.setAttribute("transform", `translate(${x} ${-y}) scale(${size * 0.8})`);
      mark.setAttribute("class", status && labels.includes(status.step + 1) ? "now" : "");
    }
    drawDrone(size);
    drawTags(size);
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
    put("wanted", wanted);
    $("doubt").style.display = pose ? "" : "none";
    if (pose) {
      $("doubt").setAttribute("cx", pose.x_m);
      $("doubt").setAttribute("cy", -pose.y_m);
      $("doubt").setAttribute("r", 2 * status.horizontal_deviation_m);
    }
    $("trail").setAttribute("points", points(trail));
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
    const seen = status.tags.seen_s === null ? "none seen yet" : `seen ${status.tags.seen_s.toFixed(1)} s ago`;
    if (!known().length) return seen;
    const best = Math.min(...known().map((tag) => tag.deviation_m));
    return `${known().length}, to ${best.toFixed(2)} m, ${seen}`;
  }

  function drawGrid(wide, high, visible) {
    const step = [0.25, 0.5, 1, 2, 5, 10, 20, 50].find((step) => visible / step < 6) || 100;
    const [left, right, low, top] = [view.x - wide, view.x + wide, -view.y - high, -view.y + high];
    let lines = "";
    for (let x = Math.ceil(left / step) * step; x <= right; x += step) lines += `M${x} ${low}V${top}`;
    for (let y = Math.ceil(low / step) * step; y <= top; y += step) lines += `M${left} ${y}H${right}`;
    if (!$("grid").firstChild) $("grid").append(svg("path"), svg("path", { class: "axis" }));
    $("grid").firstChild.setAttribute("d", lines);
    $("grid").lastChild.setAttribute("d", `M0 ${low}V${top}M${left} 0H${right}`);
    const tagged = status && status.tags ? "; roundels: tags with one standard deviation, * surveyed" : "";
    const simulated = document.body.dataset.view === "plan" && plan.simulated() ? "; line: where the simulated drone flew" : "";
    $("scale").textContent = `squares of ${step} m; disc: position uncertainty; dashed: the fence, ${flight.fence.text}${tagged}${simulated}`;
  }

  // Where a mouse or a finger points to, in metres right and forward.
  function place(event) {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform($("map").getScreenCTM().inverse());
    return { x, y: -y };
  }

  $("nearer").onclick = () => (zoom = Math.min(8, zoom * 1.5));
  $("farther").onclick = () => (zoom = Math.max(0.1, zoom / 1.5));

  return { draw, place, tagsText, reset: () => (view = null) };
})();
