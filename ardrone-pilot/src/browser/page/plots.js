"use strict";
// The last minute of the flight as plots.

const plots = (() => {
  const SHOWN = 60; // seconds
  const EVERY = 200; // milliseconds between two drawings
  const LINES = 3; // at most, in one plot
  const [LEFT, BELOW] = [44, 16]; // room for the axes, in pixels
  // Name, unit, least range, names of the lines, what of a status is drawn, the least value if there is one, and whether
  // the highest value of each second is drawn, of what rises and falls many times in it.
  const PLOTS = [
    ["position", "m", 1, ["right", "forward", "up"], ({ pose }) => (pose ? [pose.x_m, pose.y_m, pose.z_m] : [])],
    ["speed", "m/s", 0.5, ["right", "forward", "up"], ({ velocity_m_s: speed }) => speed ?? []],
    ["distance to the target", "m", 0.5, ["distance"], ({ distance_m }) => [distance_m], 0],
    ["tilt", "°", 5, ["right", "forward"], ({ attitude_deg: tilt }) => (tilt ? [tilt[0], -tilt[1]] : [])],
    ["battery", "%", 10, ["charge"], ({ battery_percent }) => [battery_percent], 0],
    ["age of the navdata", "ms", 50, ["age"], ({ navdata_age_s: age }) => [age === null ? null : age * 1000], 0, true],
    ["lateness of the tick", "ms", 1, ["lateness"], ({ tick_late_s }) => [tick_late_s * 1000], 0, true],
  ];

  // Zero has no sign, also where it is rounded to.
  const figure = (value, digits) => value.toFixed(digits).replace(/^-(?=[0.]*$)/, "");

  let rows = []; // [time, a list of values for each plot]
  let drawn = 0;
  let paused = null; // the rows that are looked at meanwhile
  let pointed = null; // share of the width that is pointed at
  const figures = PLOTS.map(([name, unit, , lines, , , isHighest]) => {
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const now = document.createElement("span");
    caption.append(`${name} (${unit}${isHighest ? ", highest of each second" : ""}) `, now);
    const canvas = document.createElement("canvas");
    canvas.role = "img";
    canvas.ariaLabel = `${name} in the last minute: ${lines.join(", ")}`;
    canvas.onpointermove = (event) => (pointed = (event.offsetX - LEFT) / (canvas.clientWidth - LEFT));
    canvas.onpointerleave = () => (pointed = null);
    figure.append(caption, canvas);
    $("plots").append(figure);
    return { canvas, now };
  });
  // The style sheet's colours, which depend on light and dark.
  const samples = [...Array(LINES).keys()].map((line) => {
    const sample = Object.assign(document.createElement("i"), { className: `line${line}` });
    $("plots").append(sample);
    return sample;
  });

  function add(status) {
    // The flight's clock begins anew with the program.
    if (rows.length && rows.at(-1)[0] > status.t_s) rows = [];
    rows.push([status.t_s, PLOTS.map(([, , , , of]) => of(status))]);
    while (rows[0][0] < status.t_s - SHOWN) rows.shift();
  }

  function draw() {
    if (performance.now() - drawn < EVERY || !rows.length) return;
    drawn = performance.now();
    const colours = samples.map((sample) => getComputedStyle(sample).color);
    const shown = paused ?? rows;
    const end = shown.at(-1)[0];
    // The row that is pointed at, or the last one.
    const time = pointed === null ? end : end - SHOWN * (1 - Math.max(0, Math.min(1, pointed)));
    const row = shown.find(([at]) => at >= time) ?? shown.at(-1);
    $("plotsat").textContent = pointed === null ? "the last minute; point at a plot for its values" : `at ${row[0].toFixed(1)} s`;
    PLOTS.forEach((plot, index) => drawOne(plot, index, figures[index], colours, shown, row));
  }

  $("pauseplots").onclick = () => {
    paused = paused ? null : [...rows];
    $("pauseplots").ariaPressed = String(Boolean(paused));
    $("pauseplots").textContent = paused ? "Go on" : "Pause";
    drawn = 0;
  };

  // By keys as by the mouse: arrows move the cursor by a second.
  document.querySelector(".plots").addEventListener("keydown", ({ key }) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[key];
    if (by && !document.body.classList.contains("hand")) pointed = Math.max(0, Math.min(1, (pointed ?? 1) + by / SHOWN));
  });
  document.querySelector(".plots").addEventListener("focusout", () => (pointed = null));

  // Of the rows of each second one with their highest values; of what is no number in a second, none.
  function highest(rows, index) {
    const seconds = new Map();
    for (const row of rows) {
      const before = seconds.get(Math.floor(row[0]));
      if (!before || !(before[1][index][0] >= row[1][index][0])) seconds.set(Math.floor(row[0]), row);
    }
    return [...seconds.values()];
  }

  function drawOne([, , least, names, , floor, isHighest], index, { canvas, now }, colours, all, pointed) {
    const { context, width, height } = emptied(canvas);
    const rows = isHighest ? highest(all, index) : all;
    const row = isHighest ? rows.findLast(([at]) => Math.floor(at) === Math.floor(pointed[0])) : pointed;
    const values = rows.flatMap(([, all]) => all[index]).filter(Number.isFinite);
    if (!values.length) {
      now.textContent = "–";
      return;
    }
    let [low, high] = [Math.min(...values), Math.max(...values)];
    const room = Math.max(0, least - (high - low)) / 2 + (high - low) * 0.05;
    [low, high] = [Math.max(low - room, floor ?? -Infinity), high + room];
    const end = all.at(-1)[0];
    const x = (time) => width - ((end - time) / SHOWN) * (width - LEFT);
    const y = (value) => 6 + ((high - value) / (high - low)) * (height - 12 - BELOW);
    const style = getComputedStyle(canvas);
    context.fillStyle = style.color;
    context.strokeStyle = style.borderTopColor;
    context.lineWidth = 1;
    for (const value of [low, (low + high) / 2, high]) {
      context.beginPath();
      context.moveTo(LEFT, y(value));
      context.lineTo(width, y(value));
      context.stroke();
      context.fillText(figure(value, high - low < 10 ? 1 : 0), 0, Math.max(10, Math.min(height - 2, y(value) + 4)));
    }
    for (let time = Math.ceil((end - SHOWN) / 10) * 10; time <= end; time += 10) {
      if (time < 0 || x(time) > width - 20) continue;
      context.fillText(`${time} s`, x(time) - 8, height - 3);
    }
    if (pointed !== all.at(-1)) {
      context.beginPath();
      context.moveTo(x(pointed[0]), 6);
      context.lineTo(x(pointed[0]), height - BELOW);
      context.stroke();
    }
    const digits = least >= 10 ? 0 : least >= 5 ? 1 : 2;
    const last = row[1][index];
    now.replaceChildren(...names.map((name, line) => {
      const label = document.createElement("b");
      label.className = `line${line}`;
      label.textContent = `${names.length > 1 ? `${name} ` : ""}${Number.isFinite(last[line]) ? figure(last[line], digits) : "–"} `;
      return label;
    }));
    names.forEach((_, line) => {
      context.strokeStyle = colours[line];
      context.lineWidth = 1.5;
      context.beginPath();
      let open = false;
      for (const [time, values] of rows) {
        const value = values[index][line];
        if (!Number.isFinite(value)) {
          open = false;
          continue;
        }
        if (open) context.lineTo(x(time), y(value));
        else context.moveTo(x(time), y(value));
        open = true;
      }
      context.stroke();
    });
  }

  return { add, draw };
})();
