"use strict";
// The other vehicles of a fleet: a list of all, and where they are on the map.

const fleet = (() => {
  // Told apart by people who see colours differently, too (Okabe and Ito).
  const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f5539", "#5c5c5c"];
  const STALE = 0.3; // seconds without navdata

  let names = []; // of all vehicles, in the order of the fleet
  const others = new Map(); // what was last told of each other one
  const marks = new Map(); // on the map
  const items = new Map(); // in the list

  const colour = (name) => COLOURS[names.indexOf(name) % COLOURS.length];

  // Shows another vehicle: everything on the page is about it then.
  function choose(name) {
    if (name === flight.vehicle) return;
    const query = new URLSearchParams(location.search);
    query.set("vehicle", name);
    location.search = query;
  }

  function begin(message) {
    others.clear();
    for (const other of message.others) others.set(other.vehicle, other);
    const isFleet = message.fleet.length > 1;
    $("fleet").hidden = !isFleet;
    if (String(names) === String(message.fleet)) return;
    names = message.fleet;
    items.clear();
    marks.clear();
    if (!isFleet) return;
    // The shown one has its colour on the map, too.
    $("drone").style.setProperty("--here", colour(message.vehicle));
    for (const name of names) {
      const button = document.createElement("button");
      button.style.setProperty("--colour", colour(name));
      button.append(Object.assign(document.createElement("b"), { textContent: name }), " ", document.createElement("span"));
      button.onclick = () => choose(name);
      // Flown by another program, which has a page of its own.
      button.disabled = !message.here.includes(name);
      button.ariaPressed = String(name === message.vehicle);
      items.set(name, button);
      if (name === message.vehicle) continue;
      const mark = svg("g", { class: "other" });
      mark.style.setProperty("--colour", colour(name));
      const drone = svg("g");
      drone.append(svg("path", { d: "M0-1 .7.8 0 .4-.7.8Z" }));
      const label = svg("g");
      label.append(svg("text", { y: -1.6, "font-size": 1.3 }));
      label.firstChild.textContent = name;
      mark.append(svg("circle", { class: "doubt" }), drone, label);
      marks.set(name, mark);
    }
    $("vehicles").replaceChildren(...items.values());
    $("others").replaceChildren(...marks.values());
  }

  const take = (message) => others.set(message.vehicle, message);

  // "flying 2/5, 87 %", and whether somebody should look.
  function summary({ phase, emergency, step, steps, battery_percent: charge, navdata_age_s: age, outcome }) {
    if (outcome) return [outcome, false];
    const parts = [emergency ? "EMERGENCY" : phase ?? "–"];
    if (step !== null && step !== undefined) parts[0] += ` ${step + 1}/${steps}`;
    if (charge !== null && charge !== undefined) parts.push(`${charge} %`);
    const isLost = phase && (age === null || age > STALE);
    if (isLost) parts.push("not heard");
    return [parts.join(", "), Boolean(emergency || isLost || charge <= flight.battery_warns_percent)];
  }

  // The list. The shown vehicle's own status says more than what others see of it.
  function drawList() {
    for (const [name, button] of items) {
      const own = name === flight.vehicle;
      const seen = own ? status && { ...status, outcome: over } : others.get(name);
      const [text, ill] = seen ? summary(seen) : ["–", false];
      const shown = button.lastChild;
      if (shown.textContent !== text) shown.textContent = shown.title = text;
      shown.classList.toggle("ill", ill);
    }
    if (!items.size) return;
    $("landall").disabled = !socket || socket.readyState !== WebSocket.OPEN;
  }

  function drawOn(size) {
    for (const [name, mark] of marks) {
      const pose = others.get(name)?.pose;
      mark.style.display = pose ? "" : "none";
      if (!pose) continue;
      const [doubt, drone, label] = mark.children;
      const place = `translate(${pose.x_m} ${-pose.y_m}) scale(${size})`;
      set(doubt, { cx: pose.x_m, cy: -pose.y_m, r: 2 * others.get(name).uncertainty_m });
      set(drone, { transform: `${place} rotate(${pose.yaw_deg})` });
      set(label, { transform: place });
    }
  }

  // Places that must be on the map.
  const places = () => [...others.values()].filter(({ pose }) => pose).map(({ pose }) => [pose.x_m, pose.y_m]);

  $("landall").onclick = () => order({ order: "land_all" });

  return { begin, take, colour, drawList, drawOn, places };
})();
