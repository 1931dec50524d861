"use strict";
// Recorded flights: their list, their reports, and two of them side by side.

const flights = (() => {
  const LATER = 1000; // until what has happened is recorded, in milliseconds
  const AGAIN = 3000; // time to confirm a deletion, in milliseconds
  const SIMULATION = "simulation";

  const query = location.search;
  const body = document.querySelector("#recordings tbody");
  const summaries = new Map(); // by name
  let chosen = []; // keys of the flights to compare
  let round = 0; // a list that is made anew ends the one before

  const note = (words) => ($("flightsnote").textContent = words);
  const seconds = (time) => (time < 60 ? `${time.toFixed(1)} s` : `${Math.floor(time / 60)} min ${Math.round(time % 60)} s`);

  async function get(path) {
    const response = await fetch(path + query);
    if (!response.ok) throw new Error((await response.text()).trim());
    return response.json();
  }

  async function list() {
    const mine = ++round;
    const flew = isAirborne();
    let files;
    try {
      files = await get("flights");
    } catch (error) {
      note(`The flights cannot be listed: ${error.message}`);
      return;
    }
    // Rows come one by one at first. Later they are exchanged at once: somebody may be about to press a button of one.
    const isFirst = !body.childElementCount;
    const made = plan.simulated() && plan.simulated().track ? [simulationRow()] : [];
    if (isFirst) body.append(...made);
    note(files.length ? "" : "There is no recorded flight yet.");
    for (const [index, file] of files.entries()) {
      const last = summaries.get(file.name);
      if (!last || last.bytes !== file.bytes) {
        note(`reading ${index + 1} of ${files.length}`);
        try {
          summaries.set(file.name, await get(`flights/${encodeURIComponent(file.name)}/summary`));
        } catch (error) {
          summaries.set(file.name, { name: file.name, bytes: file.bytes, current: file.current, problem: error.message, flights: [] });
        }
        if (mine !== round) return;
      }
      const found = rows(summaries.get(file.name));
      made.push(...found);
      if (isFirst) body.append(...found);
    }
    if (!isFirst) exchange(made);
    filter();
    note(files.length ? "" : "There is no recorded flight yet.");
    const isOurs = ({ current, vehicle }) => current && vehicle === flight.vehicle;
    const goesOn = [...summaries.values()].some((file) => isOurs(file) && file.flights.some(({ outcome }) => outcome === null));
    if (files.some(({ current }) => current)) listAtChange(mine, flew, goesOn);
    chosen = chosen.filter((key) => body.querySelector(`input[value="${CSS.escape(key)}"]`));
    compare();
  }

  // Lists again when a flight has begun or ended, and until its end is recorded, if the list is still what is looked at.
  function listAtChange(mine, flew, goesOn) {
    setTimeout(() => {
      if (view !== "flights" || mine !== round) return;
      const flies = isAirborne();
      // What has just begun is recorded soon.
      if (flies && !flew) setTimeout(() => mine === round && list(), LATER);
      else if (!flies && (flew || goesOn)) list();
      else listAtChange(mine, flew, goesOn);
    }, LATER);
  }

  // Puts rows in the place of those before; the focus stays on the button of the same name.
  function exchange(made) {
    const focused = body.contains(document.activeElement) ? document.activeElement.ariaLabel : null;
    body.replaceChildren(...made);
    if (focused) body.querySelector(`[aria-label="${CSS.escape(focused)}"]`)?.focus();
  }

  const cell = (text, className = "") => Object.assign(document.createElement("td"), { textContent: text, className });

  function choice(key, name) {
    const box = Object.assign(document.createElement("input"), { type: "checkbox", value: key, checked: chosen.includes(key) });
    box.ariaLabel = `compare ${name}`;
    box.onchange = () => {
      chosen = chosen.filter((other) => other !== key);
      if (box.checked) chosen.push(key);
      // Two at a time: the older choice goes.
      while (chosen.length > 2) body.querySelector(`input[value="${CSS.escape(chosen.shift())}"]`).checked = false;
      compare();
    };
    const place = document.createElement("td");
    place.append(box);
    return place;
  }

  function simulationRow() {
    const flown = plan.simulated();
    const row = document.createElement("tr");
    row.append(choice(SIMULATION, "the simulation"), cell("simulated"), cell(plan.name()), cell(flown.outcome), cell(seconds(flown.length_s)), cell(`${flown.battery_percent.toFixed(1)} %`), cell(""), cell(""));
    return row;
  }

  // A row for each flight of a recording; those of one that never flew have one row together.
  function rows(recording) {
    const when = new Date((recording.start_s ?? 0) * 1000);
    const file = encodeURIComponent(recording.name);
    const made = recording.flights.map((flight, index) => {
      const row = document.createElement("tr");
      const date = new Date(when.getTime() + flight.from_s * 1000);
      const time = date.toLocaleString();
      const ended = flight.outcome ?? (recording.current ? "goes on" : "cut off");
      const charge = flight.battery_percent ? `${flight.battery_percent[0]} to ${flight.battery_percent[1]} %` : "–";
      const name = flight.plan.split(/[\\/]/).at(-1) || "by orders";
      row.append(
        choice(`${recording.name}/${index}`, `the flight of ${time}`), cell(time), cell(name),
        cell(ended, flight.warning && flight.outcome ? "ill" : ""), cell(seconds(flight.length_s)), cell(charge), cell(`${flight.furthest_m.toFixed(2)} m`),
        actions(recording, file, time, index),
      );
      Object.assign(row.dataset, { plan: name.toLowerCase(), ill: String(flight.warning && flight.outcome !== null), at: String(date.getTime()) });
      return row;
    });
    // The newest first.
    if (made.length) return made.reverse();
    const row = document.createElement("tr");
    const time = recording.problem ? recording.name : when.toLocaleString();
    const said = cell(recording.problem ?? "no flight", recording.problem ? "ill" : "faint");
    said.colSpan = 5;
    row.append(cell(""), cell(time), said, actions(recording, file, time));
    return [row];
  }

  // Shows what is asked for by plan, end and date.
  function filter() {
    const wanted = $("ofplan").value.trim().toLowerCase();
    const since = $("ofdate").valueAsNumber;
    for (const row of body.children) {
      const { plan: name = "", ill = "false", at = "Infinity" } = row.dataset;
      const fits = { "": true, well: ill === "false", ill: ill === "true" }[$("ofend").value];
      row.hidden = !(name.includes(wanted) && fits && !(Number(at) < since));
    }
  }
  for (const id of ["ofplan", "ofend", "ofdate"]) $(id).oninput = filter;

  // `index` is the flight of the recording, if it has any.
  function actions(recording, file, time, index) {
    const place = document.createElement("td");
    place.className = "actions";
    const button = (text, action, off) => {
      const element = Object.assign(document.createElement("button"), { textContent: text, disabled: Boolean(off) });
      element.ariaLabel = `${text} ${time}`;
      element.onclick = () => action(element);
      place.append(element);
    };
    if (!recording.problem) button("Report", () => report(file, index));
    if (index !== undefined) button("Play", () => play(recording.name, index, time));
    if (index > 0) return place;
    button("Download", () => {
      const link = document.createElement("a");
      link.href = `flights/${file}${query}`;
      link.download = recording.name;
      link.click();
    });
    let until = 0;
    button("Delete", async (element) => {
      if (performance.now() > until) {
        until = performance.now() + AGAIN;
        element.textContent = "Again: delete";
        setTimeout(() => (element.textContent = "Delete"), AGAIN);
        return;
      }
      const response = await fetch(`flights/${file}${query}`, { method: "DELETE" }).catch((error) => ({ text: () => error.message }));
      if (!response.ok) note(`It was not deleted: ${await response.text()}`);
      else list();
    }, recording.current);
    return place;
  }

  // Of one flight, or of a recording in which nothing flew.
  function report(file, index) {
    $("comparison").hidden = true;
    // Until it tells the page of the keys that hold and land, nobody can be in it.
    $("report").hidden = true;
    note("making the report");
    $("report").src = `flights/${file}/report${index === undefined ? "" : `/${index}`}${query}`;
  }

  $("report").addEventListener("load", () => {
    if (!$("report").src || !$("comparison").hidden) return;
    note("");
    $("report").hidden = false;
    $("report").scrollIntoView({ block: "nearest" });
  });

  // ---- A flight played back in the Fly view.

  // { track, name, at (seconds since the take-off), pace, since } of what is played.
  let played = null;

  async function play(name, index, time) {
    let track;
    try {
      track = (await get(`flights/${encodeURIComponent(name)}/track/${index}`)).track;
    } catch (error) {
      note(`It cannot be played: ${error.message}`);
      return;
    }
    if (!track || track.length < 2) {
      note("It never left the ground.");
      return;
    }
    played = { track, name: `the flight of ${time}`, at: 0, runs: true };
    $("playat").max = track.at(-1)[0];
    $("playback").hidden = false;
    show("fly");
  }

  // The pose at the moment that is played, and the way to it; null if nothing is.
  function playing() {
    if (!played) return null;
    const { track, at } = played;
    const [, x_m, y_m, z_m, yaw_deg] = sample(track, at);
    const way = track.filter(([time]) => time <= at).map(([, x, y, z]) => [x, y, z]);
    return { pose: { x_m, y_m, z_m, yaw_deg: yaw_deg ?? 0 }, way };
  }

  // `flies`: a drone does, and is what must be looked at.
  function advance(seconds, flies) {
    if (!played) return;
    if (flies) {
      $("endplay").onclick();
      return;
    }
    const end = played.track.at(-1)[0];
    if (played.runs) played.at = Math.min(end, played.at + seconds * Number($("pace").value));
    if (played.at >= end) played.runs = false;
    $("play").textContent = played.runs ? "Pause" : "Play";
    if (document.activeElement !== $("playat") || played.runs) $("playat").value = played.at;
    $("playtime").textContent = `Played back, ${played.name}: ${played.at.toFixed(1)} of ${end.toFixed(1)} s`;
  }

  $("play").onclick = () => {
    if (played.at >= played.track.at(-1)[0]) played.at = 0;
    played.runs = !played.runs;
  };
  $("playat").oninput = () => Object.assign(played, { at: Number($("playat").value), runs: false });
  $("endplay").onclick = () => {
    played = null;
    $("playback").hidden = true;
  };

  // ---- Two flights side by side.

  async function track(key) {
    if (key === SIMULATION) return plan.simulated().track;
    const [name, index] = key.split("/");
    return (await get(`flights/${encodeURIComponent(name)}/track/${index}`)).track;
  }

  const nameOf = (key) => body.querySelector(`input[value="${CSS.escape(key)}"]`).closest("tr").children[1].textContent;

  // The row of a track at a time, in a line between two.
  function sample(track, time) {
    let low = 0;
    let high = track.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (track[middle][0] > time) high = middle;
      else low = middle;
    }
    const [from, to] = [track[low], track[high]];
    const share = to[0] > from[0] ? Math.max(0, Math.min(1, (time - from[0]) / (to[0] - from[0]))) : 0;
    return from.map((value, axis) => value + share * (to[axis] - value));
  }

  async function compare() {
    const place = $("comparison");
    if (chosen.length < 2) {
      place.hidden = true;
      return;
    }
    const keys = [...chosen];
    let tracks;
    try {
      tracks = await Promise.all(keys.map(track));
    } catch (error) {
      note(`They cannot be compared: ${error.message}`);
      return;
    }
    if (keys.some((key, index) => key !== chosen[index])) return;
    if (tracks.some((track) => !track || track.length < 2)) {
      note("One of them never left the ground.");
      return;
    }
    note("");
    $("report").hidden = true;
    place.hidden = false;
    const ends = tracks.map((track) => track.at(-1)[0]);
    const apart = [];
    for (let time = 0; time <= Math.min(...ends); time += 0.1) {
      const [one, other] = tracks.map((track) => sample(track, time));
      apart.push(Math.hypot(one[1] - other[1], one[2] - other[2], one[3] - other[3]));
    }
    const names = keys.map(nameOf);
    const legend = document.createElement("p");
    names.forEach((name, index) => {
      const label = Object.assign(document.createElement("b"), { textContent: `${name}: ${seconds(ends[index])} in the air`, className: `line${index}` });
      legend.append(label, index ? "" : " and ");
    });
    const mean = apart.reduce((sum, value) => sum + value, 0) / Math.max(1, apart.length);
    const said = document.createElement("p");
    said.id = "apart";
    said.textContent = `At the same time after the take-off they are ${mean.toFixed(2)} m apart on average, ${Math.max(0, ...apart).toFixed(2)} m at most. A recorded track is the pilot's estimate, a simulated one is true.`;
    const plots = [["right (m)", 1], ["forward (m)", 2], ["height (m)", 3]].map(([title, axis]) =>
      plot(title, tracks.map((track) => track.map((row) => [row[0], row[axis]]))));
    place.replaceChildren(legend, said, above(tracks), ...plots);
  }

  // Lines [[x, y]] in a drawing of this size, with the range of both axes.
  function drawing(title, lines, same) {
    const [width, height, left, bottom] = [same ? 420 : 640, same ? 420 : 130, 46, 20];
    const all = lines.flat();
    const range = (axis) => {
      const values = all.map((point) => point[axis]);
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = Math.max(0.2, (high - low) * 0.06);
      return [low - room, high + room];
    };
    let [[x0, x1], [y0, y1]] = [range(0), range(1)];
    if (same) {
      const half = Math.max(x1 - x0, y1 - y0) / 2;
      const [x, y] = [(x0 + x1) / 2, (y0 + y1) / 2];
      [x0, x1, y0, y1] = [x - half, x + half, y - half, y + half];
    }
    const x = (value) => left + ((value - x0) / (x1 - x0)) * (width - left - 6);
    const y = (value) => 6 + ((y1 - value) / (y1 - y0)) * (height - bottom - 6);
    const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", class: same ? "above" : "over" });
    picture.ariaLabel = title;
    for (const value of ticks(x0, x1)) {
      picture.append(svg("path", { d: `M${x(value)} 6V${height - bottom}`, class: "rule" }), label(x(value), height - 5, value, "middle"));
    }
    for (const value of ticks(y0, y1)) {
      picture.append(svg("path", { d: `M${left} ${y(value)}H${width - 6}`, class: "rule" }), label(left - 5, y(value) + 4, value, "end"));
    }
    lines.forEach((line, index) => {
      const way = line.map(([a, b]) => `${x(a).toFixed(1)},${y(b).toFixed(1)}`).join(" ");
      picture.append(svg("polyline", { points: way, fill: "none", stroke: "currentColor", class: `line${index}`, "stroke-width": 2, "stroke-dasharray": index ? "5 3" : "none" }));
    });
    const figure = document.createElement("figure");
    figure.append(Object.assign(document.createElement("figcaption"), { textContent: title }), picture);
    return figure;
  }

  function label(x, y, value, anchor) {
    const text = svg("text", { x, y, "text-anchor": anchor });
    text.textContent = String(Number(value.toFixed(2))).replace("-", "−");
    return text;
  }

  // Round values in a range, about five.
  function ticks(low, high) {
    const raw = (high - low) / 5;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= raw);
    const values = [];
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) values.push(value);
    return values;
  }

  const above = (tracks) => drawing("from above: right, forward (m)", tracks.map((track) => track.map((row) => [row[1], row[2]])), true);
  const plot = (title, lines) => drawing(`${title} over the time since the take-off (s)`, lines, false);

  return { list, playing, advance };
})();
