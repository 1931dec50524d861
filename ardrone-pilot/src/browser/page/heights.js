"use strict";
// Heights: plan and flight over the way, and in three dimensions.

const heights = (() => {
  const EVERY = 100; // milliseconds between two drawings
  const APART = 14; // numbers that are closer are written together, in pixels
  let drawnAt = 0;
  let [turn, tilt, zoom] = [0.6, 0.5, 1]; // radians, radians, factor
  let turning = null; // pointer that turns the picture: [x, y] in pixels
  let isSolid = false;

  // The planned way [[x, y, z]] and its numbers, from the ground at the start.
  function planned() {
    const steps = flight.steps.map(({ target }, index) => ({ target, label: index + 1 })).filter(({ target }) => target);
    const targets = view === "plan" ? plan.targets() : steps.map(({ target, label }) => ({ x: target.x_m, y: target.y_m, z: target.z_m, label }));
    const first = targets.length ? [[...flight.start_m, 0], [...flight.start_m, targets[0].z]] : [];
    return { way: [...first, ...targets.map(({ x, y, z }) => [x, y, z])], targets };
  }

  // What was flown, by the simulation or by the drone.
  function flownWay() {
    if (view !== "plan") return flights.playing()?.way ?? trail.slice(trailOfFlight);
    const flown = plan.simulated();
    return flown && flown.track ? flown.track.map(([, x, y, z]) => [x, y, z]) : [];
  }

  function prepared(canvas) {
    const { context, width, height } = emptied(canvas);
    context.lineWidth = 1.5;
    const style = getComputedStyle(document.documentElement);
    const probe = (name) => style.getPropertyValue(name).trim();
    // The colours of the map, in light and dark.
    const colour = Object.fromEntries(["faint", "line", "here", "tag", "danger", "ink"].map((name) => [name, resolved(probe(`--${name}`))]));
    return { context, width, height, colour };
  }

  // The colour of the scheme in use, of "light-dark(#111, #eee)".
  const isDark = matchMedia("(prefers-color-scheme: dark)");
  function resolved(text) {
    const pair = /light-dark\(([^,]+),\s*([^)]+)\)/.exec(text);
    return pair ? pair[isDark.matches ? 2 : 1] : text;
  }

  function line(context, places, colour, dash = []) {
    context.strokeStyle = colour;
    context.setLineDash(dash);
    context.beginPath();
    places.forEach(([x, y], index) => (index ? context.lineTo(x, y) : context.moveTo(x, y)));
    context.stroke();
    context.setLineDash([]);
  }

  // ---- Over the way.

  // Both ways from the ground, that the same place is at the same length: a track begins where the take-off has ended.
  const unrolledWays = () => {
    const flown = flownWay();
    const ground = flown.slice(0, 1).map(([x, y]) => [x, y, 0]);
    return [planned().way, [...ground, ...flown]].map(unrolled);
  };

  // [length so far, height] of each place of a way.
  function unrolled(way) {
    let length = 0;
    return way.map(([x, y, z], index) => {
      if (index) length += Math.hypot(x - way[index - 1][0], y - way[index - 1][1], z - way[index - 1][2]);
      return [length, z];
    });
  }

  function drawProfile() {
    const { context, width, height, colour } = prepared($("profile"));
    if (!width) return;
    const { targets } = planned();
    const [wanted, flown] = unrolledWays();
    const longest = Math.max(1, ...[wanted, flown].map((line) => line.at(-1)?.[0] ?? 0));
    const top = flight.ceiling_m;
    const x = (length) => 44 + (length / longest) * (width - 60);
    const y = (z) => 10 + (1 - z / top) * (height - 26);
    context.fillStyle = colour.faint;
    for (const z of [0, top / 2, top]) {
      line(context, [[44, y(z)], [width - 10, y(z)]], z === top ? colour.danger : colour.line, z === top ? [6, 5] : []);
      context.fillText(`${z.toFixed(1)} m`, 4, y(z) + 4);
    }
    context.fillText(`height over the way, ${longest.toFixed(1)} m`, 48, height - 4);
    line(context, wanted.map(([length, z]) => [x(length), y(z)]), colour.faint, [2, 4]);
    line(context, flown.map(([length, z]) => [x(length), y(z)]), view === "plan" ? colour.tag : colour.here);
    context.fillStyle = colour.ink;
    const marks = targets.map(({ label }, index) => ({ x: x(wanted[index + 2][0]), y: y(wanted[index + 2][1]), label }));
    for (const { x, y, all } of map.gathered(marks, APART)) context.fillText(map.numbers(all), x - 3, y - 4);
  }

  // ---- In three dimensions.

  function drawSolid() {
    const { context, width, height, colour } = prepared($("solidview"));
    if (!width) return;
    const { way, targets } = planned();
    const flown = flownWay();
    const outline = flight.fence.outline_m;
    const shown = [[...flight.start_m, 0], ...way, ...flown];
    const reach = Math.max(1, ...shown.map(([x, y]) => Math.max(Math.abs(x), Math.abs(y)))) * 1.3;
    const scale = (zoom * Math.min(width, height)) / (2 * reach) * 0.8;
    const [sin, cos, up, down] = [Math.sin(turn), Math.cos(turn), Math.cos(tilt), Math.sin(tilt)];
    const at = ([x, y, z]) => [width / 2 + (x * cos - y * sin) * scale, height * 0.6 - ((x * sin + y * cos) * down + z * up) * scale];
    const step = reach > 10 ? 5 : 1;
    for (let value = -Math.ceil(reach / step) * step; value <= reach; value += step) {
      line(context, [at([value, -reach, 0]), at([value, reach, 0])], colour.line);
      line(context, [at([-reach, value, 0]), at([reach, value, 0])], colour.line);
    }
    for (const z of [flight.floor_m, flight.ceiling_m]) {
      line(context, [...outline, outline[0]].map(([x, y]) => at([x, y, z])), colour.danger, [6, 5]);
    }
    line(context, way.map(at), colour.faint, [2, 4]);
    // Each target stands on the ground, which shows its height.
    const marks = targets.map(({ x, y, z, label }) => {
      line(context, [at([x, y, 0]), at([x, y, z])], colour.line);
      const [u, v] = at([x, y, z]);
      return { x: u, y: v, label };
    });
    context.fillStyle = colour.ink;
    for (const { x, y } of marks) context.fillRect(x - 2, y - 2, 4, 4);
    for (const { x, y, all } of map.gathered(marks, APART)) context.fillText(map.numbers(all), x + 5, y - 5);
    line(context, flown.map(at), view === "plan" ? colour.tag : colour.here);
    if (status && status.pose && view !== "plan") {
      const { x_m: x, y_m: y, z_m: z } = status.pose;
      line(context, [at([x, y, 0]), at([x, y, z])], colour.here);
      const [u, v] = at([x, y, z]);
      context.fillStyle = colour.here;
      context.beginPath();
      context.arc(u, v, 6, 0, 2 * Math.PI);
      context.fill();
    }
    context.fillStyle = colour.faint;
    context.fillText(`squares of ${step} m; dashed: the fence between ${flight.floor_m} and ${flight.ceiling_m} m; drag to turn`, 12, height - 8);
  }

  const solid = $("solidview");
  solid.onpointerdown = (event) => {
    turning = [event.clientX, event.clientY];
    solid.setPointerCapture(event.pointerId);
  };
  solid.onpointermove = (event) => {
    if (!turning) return;
    rotate(event.clientX - turning[0], event.clientY - turning[1]);
    turning = [event.clientX, event.clientY];
  };
  // By so many pixels of a drag.
  function rotate(right, down) {
    turn += right * 0.01;
    tilt = Math.max(0.1, Math.min(1.5, tilt + down * 0.01));
    drawnAt = 0;
  }
  solid.addEventListener("keydown", (event) => {
    // By hand the arrows fly the drone.
    const by = { ArrowLeft: [-15, 0], ArrowRight: [15, 0], ArrowUp: [0, -15], ArrowDown: [0, 15] }[event.key];
    if (!by || document.body.classList.contains("hand")) return;
    rotate(...by);
    event.preventDefault();
  });
  solid.onpointerup = solid.onpointercancel = () => (turning = null);
  solid.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom = Math.max(0.2, Math.min(5, zoom * Math.exp(-event.deltaY * 0.0015)));
    drawnAt = 0;
  }, { passive: false });
  $("solid").onclick = () => {
    isSolid = !isSolid;
    solid.hidden = !isSolid;
    // The map is behind it.
    $("map").tabIndex = isSolid ? -1 : 0;
    $("solid").ariaPressed = String(isSolid);
    drawnAt = 0;
  };

  function draw() {
    if (performance.now() - drawnAt < EVERY) return;
    drawnAt = performance.now();
    drawProfile();
    if (isSolid) drawSolid();
  }

  return { draw, unrolledWays };
})();
