"use strict";
// Hovering over a plot marks the time in all plots and shows the decision of that time.
const { decisions, plans, tags, map } = JSON.parse(document.getElementById("decided").textContent);
const { end, width, left, right } = document.getElementById("plots").dataset;
const plots = [...document.querySelectorAll(".plot")];
const rows = [...document.querySelectorAll("#timeline tbody tr")];
const why = document.getElementById("moment");

function element(name, text, parent) {
  const made = document.createElement(name);
  made.textContent = text;
  parent.append(made);
  return made;
}

function show(seconds) {
  for (const plot of plots) {
    const cursor = plot.querySelector(".cursor");
    const scale = plot.clientWidth / width;
    const inner = width - left - right;
    cursor.style.left = `${(Number(left) + (seconds / end) * inner) * scale}px`;
    cursor.style.display = "block";
  }
  const index = decisions.findIndex((decision) => seconds <= decision.to_s);
  const decision = decisions[index < 0 ? decisions.length - 1 : index];
  why.replaceChildren();
  element("p", `${seconds.toFixed(2)} s · ${decision.step}`, why);
  element("p", `ordered: ${decision.command}`, why);
  if (decision.said) element("p", decision.said, why);
  for (const warning of decision.warnings) element("p", warning, why).className = "warn";
  for (const [trigger, line] of decision.plans) {
    element("p", `because of line ${line}`, why).className = "faint";
    element("pre", plans[line] || trigger, why);
  }
  drawTags(seconds);
  camera?.show(seconds);
  rows.forEach((row) => row.classList.toggle("now", Number(row.dataset.index) === index));
}

// A tag that was not seen for this long is drawn faintly, in seconds.
const STALE = 2;

// The tags known at a time, on the map: roundels with their direction, number, and a circle of one standard deviation.
function drawTags(seconds) {
  const picture = document.querySelector(".map svg");
  if (!picture || !map || !tags.length) return;
  const svg = (name, attributes, parent) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  };
  const between = ([from, to], [low, high], value) => low + ((value - from) / (to - from)) * (high - low);
  const across = Math.abs((map.x_px[1] - map.x_px[0]) / (map.x_m[1] - map.x_m[0]));
  const down = Math.abs((map.y_px[1] - map.y_px[0]) / (map.y_m[1] - map.y_m[0]));
  const later = tags.findIndex(({ at_s }) => at_s > seconds);
  const then = tags[(later < 0 ? tags.length : later) - 1];
  picture.querySelectorAll(".tag").forEach((old) => old.remove());
  for (const tag of then ? then.tags : []) {
    const seen = tag.seen_s !== null && tag.seen_s < STALE;
    const mark = svg("g", { class: seen ? "tag" : "tag stale" }, picture);
    const [cx, cy] = [between(map.x_m, map.x_px, tag.x_m), between(map.y_m, map.y_px, tag.y_m)];
    svg("ellipse", { class: "spread", cx, cy, rx: tag.deviation_m * across, ry: tag.deviation_m * down }, mark);
    if (tag.heading_deg !== null) svg("path", { class: "way", d: "M0-7V-17", transform: `translate(${cx} ${cy}) rotate(${tag.heading_deg})` }, mark);
    svg("circle", { class: "rim", cx, cy, r: 7 }, mark);
    svg("circle", { cx, cy, r: 2.5 }, mark);
    svg("text", { class: "id", x: cx, y: cy + 26 }, mark).textContent = `${tag.id}${tag.surveyed ? "*" : ""}`;
  }
  const list = (then ? then.tags : []).map(({ id, x_m, y_m, heading_deg, deviation_m, surveyed, seen_s }) => {
    const heading = heading_deg === null ? "" : `, ${heading_deg.toFixed(0)}°`;
    const seen = seen_s === null ? "not seen" : `seen ${seen_s.toFixed(1)} s before`;
    return `${id}${surveyed ? "*" : ""} at ${x_m.toFixed(2)} ${y_m.toFixed(2)} m, to ${deviation_m.toFixed(2)} m${heading}, ${seen}`;
  });
  const when = seconds < Number(end) ? `at ${seconds.toFixed(1)} s` : "at the end";
  document.getElementById("tagtext").textContent = `Tags known ${when} (* surveyed; circle: one standard deviation): ${list.join("; ") || "none"}.`;
}

drawTags(Number(end));

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

let marked = 0; // the time of the cursor
for (const plot of plots) {
  plot.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -0.1, ArrowRight: 0.1, PageUp: -5, PageDown: 5 }[event.key];
    if (!by) return;
    event.preventDefault();
    marked = Math.min(Math.max(marked + by, 0), Number(end));
    show(marked);
  });
  plot.addEventListener("mousemove", (event) => {
    const box = plot.getBoundingClientRect();
    const inner = width - left - right;
    const x = ((event.clientX - box.left) / box.width) * width;
    marked = Math.min(Math.max(((x - left) / inner) * end, 0), Number(end));
    show(marked);
  });
}
for (const row of rows) {
  row.addEventListener("mouseenter", () => show(decisions[row.dataset.index].from_s + 0.001));
}
