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

  // The sticks of the first gamepad whose shoulder button is held: without it nothing is steered.
  function gamepad() {
    for (const pad of navigator.getGamepads?.() ?? []) {
      if (!pad || pad.mapping !== "standard" || !(pad.buttons[4].pressed || pad.buttons[5].pressed)) continue;
      return pad.axes.slice(0, 4).map((axis) => (Math.abs(axis) < DEAD ? 0 : curved(axis)));
    }
    return [0, 0, 0, 0];
  }

  function sticks() {
    const [leftX, leftY, rightX, rightY] = gamepad();
    const demand = {
      roll: rightX + curved(pads.right[0]),
      pitch: rightY + curved(pads.right[1]),
      gaz: -leftY - curved(pads.left[1]),
      yaw: leftX + curved(pads.left[0]),
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
