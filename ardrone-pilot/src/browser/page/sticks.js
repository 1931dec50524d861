"use strict";
// Flies by hand: keys, sticks on the screen, or a gamepad. Whatever is let go is centred, and then the drone holds.

(() => {
  // Time between two orders, in milliseconds. The vehicle centres sticks that are silent for 250 ms.
  const EVERY = 100;
  // Deflection of a key, as in the terminal.
  const KEY = 0.4;
  // Deflection of a gamepad's stick that counts as centred.
  const DEAD = 0.1;
  const KEYS = {
    KeyW: ["pitch", -1], KeyS: ["pitch", 1], KeyA: ["roll", -1], KeyD: ["roll", 1],
    ArrowUp: ["gaz", 1], ArrowDown: ["gaz", -1], ArrowLeft: ["yaw", -1], ArrowRight: ["yaw", 1],
  };
  const held = new Set();
  // Sticks on the screen, right and down from their centres.
  const pads = { left: [0, 0], right: [0, 0] };
  const button = document.getElementById("byhand");
  const panel = document.getElementById("sticks");
  let steering = false;
  let on = false;

  function let_go() {
    held.clear();
    for (const name of ["left", "right"]) move(name, [0, 0]);
  }

  function move(name, [x, y]) {
    pads[name] = [x, y];
    draw(name, [x, y]);
  }

  function draw(name, [x, y]) {
    const knob = document.querySelector(`#${name} i`);
    knob.style.transform = `translate(${x * 44}px, ${y * 44}px)`;
  }

  function set(pressed) {
    on = pressed;
    button.ariaPressed = String(on);
    panel.hidden = !on;
    document.body.classList.toggle("hand", on);
    if (!on) let_go();
  }

  // Fine near the centre.
  const curved = (value) => value * Math.abs(value);

  // ---- Gamepad.

  const KEPT = "ardrone-pilot gamepad";
  // What each movement is steered with: the axis of the gamepad, its sign, and its value at rest.
  const FIRST = {
    turn: { axis: 0, sign: 1, rest: 0 }, climb: { axis: 1, sign: -1, rest: 0 },
    right: { axis: 2, sign: 1, rest: 0 }, back: { axis: 3, sign: 1, rest: 0 },
  };
  let axes = structuredClone(FIRST);
  try {
    axes = { ...axes, ...JSON.parse(localStorage.getItem(KEPT)) };
  } catch {
    // What was kept is not ours.
  }

  function keep() {
    try {
      localStorage.setItem(KEPT, JSON.stringify(axes));
    } catch {
      // It is forgotten with the page.
    }
  }

  const connected = () => [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad && pad.connected !== false);
  // From −1 to 1, without the tremor of a stick that is let go.
  function deflection(pad, { axis, sign, rest }) {
    const value = sign * ((pad.axes[axis] ?? rest) - rest);
    return Math.abs(value) < DEAD ? 0 : Math.max(-1, Math.min(1, value));
  }

  // The first gamepad whose shoulder button is held: without it nothing is steered.
  function gamepad() {
    const pad = connected().find(({ buttons }) => buttons[4]?.pressed || buttons[5]?.pressed);
    if (!pad) return { turn: 0, climb: 0, right: 0, back: 0 };
    return Object.fromEntries(Object.entries(axes).map(([name, axis]) => [name, curved(deflection(pad, axis))]));
  }

  const rows = Object.keys(FIRST).map((name) => {
    const row = document.createElement("label");
    const [choice, turned, shown] = ["select", "input", "meter"].map((kind) => document.createElement(kind));
    Object.assign(turned, { type: "checkbox", title: "the other way round" });
    turned.ariaLabel = `${name}: the other way round`;
    Object.assign(shown, { min: -1, max: 1, value: 0 });
    shown.ariaLabel = name;
    choice.oninput = () => {
      axes[name].axis = Number(choice.value);
      keep();
    };
    turned.oninput = () => {
      axes[name].sign = turned.checked ? -FIRST[name].sign : FIRST[name].sign;
      keep();
    };
    row.append(name, choice, turned, shown);
    document.getElementById("padaxes").append(row);
    return { name, choice, turned, shown };
  });

  function drawPad() {
    const [pad] = connected();
    document.getElementById("padcentre").disabled = !pad;
    document.getElementById("padnote").textContent = pad
      ? `${pad.id}: which axis moves what, whether the other way round, and how it stands`
      : "No gamepad is connected, or nothing was pressed on it yet.";
    for (const { name, choice, turned, shown } of rows) {
      const count = Math.max(4, pad?.axes.length ?? 0);
      if (choice.childElementCount !== count) {
        choice.replaceChildren(...Array.from({ length: count }, (_, axis) => new Option(`axis ${axis + 1}`, axis)));
      }
      choice.value = axes[name].axis;
      turned.checked = axes[name].sign !== FIRST[name].sign;
      shown.value = pad ? deflection(pad, axes[name]) : 0;
    }
  }
  document.getElementById("padcentre").onclick = () => {
    const [pad] = connected();
    for (const axis of Object.values(axes)) axis.rest = pad?.axes[axis.axis] ?? 0;
    keep();
  };
  document.getElementById("padreset").onclick = () => {
    axes = structuredClone(FIRST);
    keep();
  };

  function sticks() {
    const { turn, climb, right, back } = gamepad();
    const demand = {
      roll: right + curved(pads.right[0]),
      pitch: back + curved(pads.right[1]),
      gaz: climb - curved(pads.left[1]),
      yaw: turn + curved(pads.left[0]),
    };
    for (const key of held) {
      const [axis, sign] = KEYS[key];
      demand[axis] += sign * KEY;
    }
    for (const axis of Object.keys(demand)) demand[axis] = Math.max(-1, Math.min(1, demand[axis]));
    return demand;
  }

  setInterval(() => {
    const flying = !over && status && status.phase === "flying" && !isWatching();
    button.disabled = !flying;
    if (!flying && on) set(false);
    if (view === "settings") drawPad();
    const demand = on ? sticks() : { roll: 0, pitch: 0, gaz: 0, yaw: 0 };
    // As they are pressed, by whatever presses them.
    if (on) {
      const shown = (value) => Math.sign(value) * Math.sqrt(Math.abs(value));
      draw("left", [shown(demand.yaw), shown(-demand.gaz)]);
      draw("right", [shown(demand.roll), shown(demand.pitch)]);
    }
    const active = Object.values(demand).some((value) => value !== 0);
    // Centred sticks are sent once.
    if (active || steering) order({ order: "steer", ...demand });
    steering = active;
  }, EVERY);

  button.onclick = () => set(!on);
  document.addEventListener("keydown", (event) => {
    // Letters that are typed are letters.
    const writes = /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName);
    if (!on || writes || !(event.code in KEYS) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    held.add(event.code);
  });
  document.addEventListener("keyup", (event) => held.delete(event.code));
  // Nobody sees, or nobody is here.
  addEventListener("blur", let_go);
  document.addEventListener("visibilitychange", let_go);

  for (const name of ["left", "right"]) {
    const pad = document.getElementById(name);
    const drag = (event) => {
      if (!pad.hasPointerCapture(event.pointerId)) return;
      const box = pad.getBoundingClientRect();
      const x = ((event.clientX - box.x) / box.width) * 2 - 1;
      const y = ((event.clientY - box.y) / box.height) * 2 - 1;
      const out = Math.max(1, Math.hypot(x, y));
      move(name, [x / out, y / out]);
    };
    pad.onpointerdown = (event) => {
      pad.setPointerCapture(event.pointerId);
      drag(event);
    };
    pad.onpointermove = drag;
    pad.onpointerup = pad.onpointercancel = pad.onlostpointercapture = () => move(name, [0, 0]);
  }
})();
