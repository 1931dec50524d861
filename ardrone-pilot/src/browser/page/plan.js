"use strict";
// Makes a plan: as text, as a list of steps, and on the map. The text is the plan; the list and the map edit it.

const plan = (() => {
  const EXAMPLE = `# A square of 1 m at the height of the hover after take-off.
takeoff
goto 0 1 0 0
goto 1 1 0 0
goto 1 0 0 0
goto 0 0 0 0
land
`;
  // Where the text is kept when the page is loaded again.
  const KEPT = "ardrone-pilot plan";
  // Time to confirm what cannot be taken back, in milliseconds.
  const AGAIN = 3000;
  // Of the plan language: { name, help, example, numbers: [[name, unit]], isTarget }.
  let commands = [];
  const declared = (name) => commands.find((command) => command.name === name);

  const text = $("plantext");
  let checked = null; // the checker's answer for the text
  let flown = null; // the simulated flight of the text
  let checking = false; // a check is on its way
  let stale = false; // the text has changed meanwhile
  let rows = []; // of the list: { key, item, inputs }
  let drag = null; // the target that is dragged: { line, last }
  let pressed = false; // a target was pressed: the click that follows adds none
  let dragged = false; // .. and was moved
  let begun = false;
  let waits = false; // for the vehicle's answer to a loaded plan
  let asked = { what: "", until: 0 };

  const query = location.search;
  const ask = (path, options) => fetch(path + query, options);
  const answer = (words) => ($("plananswer").textContent = words);

  // ---- The text.

  // The words of a line's command, with their places: [{ word, at }].
  function words(line) {
    const code = line.split("#")[0].split("//")[0];
    return [...code.matchAll(/\S+/g)].map((match) => ({ word: match[0], at: match.index }));
  }

  const lines = () => text.value.split("\n");

  // Sets numbers of a line: { 1: "0.5" } is the first.
  function setNumbers(index, numbers) {
    const all = lines();
    for (const place of Object.keys(numbers).map(Number).sort((one, other) => other - one)) {
      const found = words(all[index])[place];
      if (found) all[index] = all[index].slice(0, found.at) + numbers[place] + all[index].slice(found.at + found.word.length);
    }
    write(all.join("\n"));
  }

  function write(value) {
    text.value = value;
    changed();
  }

  function changed() {
    flown = null;
    // What was confirmed once was another plan.
    asked = { what: "", until: 0 };
    $("simulation").textContent = "";
    try {
      sessionStorage.setItem(KEPT, JSON.stringify([$("planname").value, text.value]));
    } catch {
      // Without storage a reload forgets it.
    }
    drawList();
    check();
  }

  // Checks the text, and again if it has changed meanwhile.
  async function check() {
    stale = true;
    if (checking) return;
    checking = true;
    try {
      while (stale) {
        stale = false;
        const response = await ask("plan/check", { method: "POST", body: text.value });
        if (!response.ok) throw new Error(await response.text());
        const found = await response.json();
        if (!stale) checked = found;
      }
      answer("");
    } catch (error) {
      checked = null;
      answer(`The plan cannot be checked: ${error.message}`);
    }
    checking = false;
    drawChecked();
  }

  const isGood = () => Boolean(checked && checked.steps && !stale);

  // ---- The list.

  function drawList() {
    const commands = lines().map((line, index) => ({ index, found: words(line) })).filter(({ found }) => found.length);
    const key = ({ index, found }) => `${index} ${found[0].word} ${found.length}`;
    if (rows.length !== commands.length || rows.some((row, at) => row.key !== key(commands[at]))) {
      rows = commands.map((command) => ({ key: key(command), ...row(command) }));
      $("draftsteps").replaceChildren(...rows.map(({ item }) => item));
    }
    // What is being typed into stays as it is.
    rows.forEach(({ inputs }, at) =>
      inputs.forEach((input, place) => {
        // A number as its field writes it: not "+1" or "1.".
        if (input !== document.activeElement) input.value = String(Number(commands[at].found[place + 1]?.word));
      }));
  }

  function row({ index, found }) {
    const item = document.createElement("li");
    const name = document.createElement("b");
    name.textContent = found[0].word;
    const what = `line ${index + 1}, ${found[0].word}`;
    item.append(name);
    const numbers = found.slice(1).every(({ word }) => Number.isFinite(Number(word)));
    const fields = numbers ? (declared(found[0].word)?.numbers ?? []).slice(0, found.length - 1) : [];
    const inputs = fields.map(([field, unit], place) => {
      const input = document.createElement("input");
      Object.assign(input, { type: "number", step: unit.includes("°") ? 15 : 0.1, title: `${field}, ${unit}` });
      input.ariaLabel = `${what}: ${field}, ${unit}`;
      input.oninput = () => input.value && setNumbers(index, { [place + 1]: input.value });
      // What was cleared and left is as it was.
      input.onblur = drawList;
      item.append(input);
      return input;
    });
    if (!inputs.length) item.append(" ", found.slice(1).map(({ word }) => word).join(" "));
    const note = document.createElement("span");
    note.className = "faint";
    item.append(note);
    const button = (sign, does, action) => {
      const element = document.createElement("button");
      element.textContent = sign;
      element.ariaLabel = `${does} ${what}`;
      element.title = does;
      element.onclick = action;
      item.append(element);
    };
    button("↑", "move up", () => move(index, -1));
    button("↓", "move down", () => move(index, 1));
    button("✕", "remove", () => write(lines().filter((_, line) => line !== index).join("\n")));
    return { item, inputs, note, line: index + 1 };
  }

  // Exchanges a command with the one before or behind it.
  function move(index, by) {
    const all = lines();
    const commands = all.map((line, at) => ({ at, is: words(line).length > 0 })).filter(({ is }) => is).map(({ at }) => at);
    const other = commands[commands.indexOf(index) + by];
    if (other === undefined) return;
    [all[index], all[other]] = [all[other], all[index]];
    write(all.join("\n"));
  }

  // Adds a command behind the others, but before a final landing.
  function add(command) {
    const all = lines();
    while (all.length && !all.at(-1).trim()) all.pop();
    const [{ word }] = words(command);
    const ends = (name) => ["land", "landOnTag"].includes(name);
    const lands = all.length && ends(words(all.at(-1))[0]?.word) && !ends(word) && word !== "takeoff";
    // Nothing is flown to from the ground.
    const starts = all.some((line) => ["takeoff", "autoTakeover", "autoInit"].includes(words(line)[0]?.word));
    if (declared(word)?.isTarget && !starts) all.unshift("takeoff");
    all.splice(all.length - (lands ? 1 : 0), 0, command);
    write(all.join("\n") + "\n");
  }

  // A target at a place, at the height and heading of the last one.
  function target({ x, y }) {
    const last = targets().at(-1);
    const found = last && words(lines()[last.line - 1] ?? "");
    const numbers = found && found[0]?.word === "goto" ? found.slice(1, 5).map(({ word }) => Number(word)) : null;
    // The reference may have been moved, which moves all targets alike.
    const [dx, dy, z, yaw] = numbers && numbers.every(Number.isFinite) ? [numbers[0] - last.x, numbers[1] - last.y, numbers[2], numbers[3]] : [0, 0, 0, 0];
    return `goto ${(x + dx).toFixed(2)} ${(y + dy).toFixed(2)} ${z} ${yaw}`;
  }

  // ---- What the checker found.

  function drawChecked() {
    const problems = checked ? checked.problems : [];
    $("problems").replaceChildren(...problems.map((problem) => {
      const item = document.createElement("li");
      item.className = problem.severity === "error" ? "error" : "warning";
      const words = `${problem.severity}${problem.line ? `, line ${problem.line}` : ""}: ${problem.message}${problem.help ? ` (${problem.help})` : ""}`;
      if (!problem.line) item.textContent = words;
      else {
        const button = document.createElement("button");
        button.textContent = words;
        button.onclick = () => select(problem.line);
        item.append(button);
      }
      return item;
    }));
    text.ariaInvalid = String(problems.some(({ severity }) => severity === "error"));
    const steps = checked && checked.steps ? checked.steps : [];
    for (const { note, line, item } of rows) {
      const step = steps.find((step) => step.line === line);
      note.textContent = step && step.time_s ? ` ${step.time_s.toFixed(1)} s` : "";
      item.className = problems.some((problem) => problem.line === line) ? "ill" : "";
    }
    const sum = (of) => steps.reduce((total, step) => total + of(step), 0);
    $("expected").textContent = steps.length
      ? `Expected: ${sum((step) => step.leg_m).toFixed(1)} m, ${sum((step) => step.time_s).toFixed(0)} s in the air, ${sum((step) => step.battery_percent).toFixed(1)} % of a new battery; highest target ${Math.max(0, ...steps.map((step) => step.target?.z_m ?? 0)).toFixed(2)} m above the floor.`
      : "";
    drawButtons();
  }

  function select(line) {
    const before = lines().slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
    text.focus();
    text.setSelectionRange(before, before + lines()[line - 1].length);
  }

  function drawButtons() {
    $("simulate").disabled = !isGood();
    const live = !over && socket && socket.readyState === WebSocket.OPEN;
    $("load").disabled = !isGood() || !live || waits || isWatching();
    const armed = (what) => asked.what === what && performance.now() < asked.until;
    $("load").textContent = armed("load") ? "Again: it is flown at once" : "Use this plan";
    $("saveplan").textContent = armed("save") ? "Again: replace the file" : "Save";
  }

  // Whether something that cannot be taken back was asked for twice.
  function twice(what) {
    const again = asked.what === what && performance.now() < asked.until;
    asked = { what, until: again ? 0 : performance.now() + AGAIN };
    return again;
  }

  // ---- The map.

  // Of the checked plan: { x, y, line, label }.
  function targets() {
    const steps = checked && checked.steps ? checked.steps : [];
    return steps.filter((step) => step.target && step.line).map(({ target, line }, index) => ({ x: target.x_m, y: target.y_m, line, label: index + 1 }));
  }

  function canBeDragged({ line }) {
    const found = words(lines()[line - 1] ?? "");
    return declared(found[0]?.word)?.isTarget && found.slice(1, 3).length === 2 && found.slice(1, 3).every(({ word }) => Number.isFinite(Number(word)));
  }

  // Draws the targets and the simulated flight; `size` is that of a mark in metres.
  function drawOn(size) {
    drawButtons();
    const shown = view === "plan";
    $("simulated").setAttribute("points", shown && flown && flown.track ? points(flown.track.map(([, x, y]) => [x, y])) : "");
    const wanted = shown ? targets() : [];
    const marks = $("drafts").children;
    while (marks.length > wanted.length) marks[marks.length - 1].remove();
    while (marks.length < wanted.length) {
      const mark = svg("g");
      mark.append(svg("circle", { r: 1.1 }), svg("text", { "font-size": 1.2 }));
      $("drafts").append(mark);
    }
    wanted.forEach((target, index) => {
      const mark = marks[index];
      mark.dataset.line = target.line;
      mark.setAttribute("class", canBeDragged(target) ? "free" : "");
      mark.setAttribute("transform", `translate(${target.x} ${-target.y}) scale(${size * 0.8})`);
      mark.lastChild.textContent = target.label;
    });
  }

  $("map").addEventListener("pointerdown", (event) => {
    const mark = event.target.closest("#drafts g");
    dragged = false;
    pressed = Boolean(mark);
    if (!mark || !mark.classList.contains("free")) return;
    drag = { line: Number(mark.dataset.line), last: map.place(event), begun: [event.clientX, event.clientY] };
    $("map").setPointerCapture(event.pointerId);
  });
  $("map").addEventListener("pointermove", (event) => {
    if (!drag) return;
    // A hand that clicks trembles.
    if (!dragged && Math.hypot(event.clientX - drag.begun[0], event.clientY - drag.begun[1]) < 4) return;
    dragged = true;
    const now = map.place(event);
    const found = words(lines()[drag.line - 1] ?? "");
    const moved = (place, by) => (Number(found[place].word) + by).toFixed(2);
    setNumbers(drag.line - 1, { 1: moved(1, now.x - drag.last.x), 2: moved(2, now.y - drag.last.y) });
    drag.last = now;
  });
  const dropped = () => (drag = null);
  $("map").addEventListener("pointerup", dropped);
  $("map").addEventListener("pointercancel", dropped);
  $("map").addEventListener("click", (event) => {
    if (view !== "plan" || pressed) return;
    add(target(map.place(event)));
  });

  // ---- Files.

  async function list() {
    const none = Object.assign(document.createElement("option"), { value: "", textContent: "a plan…" });
    let names = [];
    try {
      const response = await ask("plans");
      if (!response.ok) throw new Error(await response.text());
      names = await response.json();
    } catch (error) {
      answer(`The plans cannot be listed: ${error.message}`);
    }
    const options = names.map((name) => Object.assign(document.createElement("option"), { value: name, textContent: name }));
    const ours = [["*", "the example"], ["-", "an empty plan"]];
    options.push(...ours.map(([value, textContent]) => Object.assign(document.createElement("option"), { value, textContent })));
    $("plans").replaceChildren(none, ...options);
  }

  function open(name, content) {
    $("planname").value = name;
    write(content);
  }

  $("plans").onchange = async () => {
    const name = $("plans").value;
    $("plans").value = "";
    if (!name) return;
    if (name === "*" || name === "-") {
      open(name === "*" ? "example.txt" : "my plan.txt", name === "*" ? EXAMPLE : "takeoff\nland\n");
      return;
    }
    try {
      const response = await ask(`plans/${encodeURIComponent(name)}`);
      if (!response.ok) throw new Error(await response.text());
      open(name, await response.text());
    } catch (error) {
      answer(`${name} cannot be opened: ${error.message}`);
    }
  };
  $("upload").onchange = async () => {
    const [file] = $("upload").files;
    if (file) open(file.name, await file.text());
    $("upload").value = "";
  };
  $("saveplan").onclick = async () => {
    const name = fileName();
    // A file of that name is replaced only on a second click.
    const replaces = twice("save");
    const headers = replaces ? {} : { "If-None-Match": "*" };
    try {
      const response = await ask(`plans/${encodeURIComponent(name)}`, { method: "PUT", headers, body: text.value });
      if (response.status === 412) {
        answer(`${name} exists: press again to replace it.`);
        return;
      }
      if (!response.ok) throw new Error(await response.text());
      asked = { what: "", until: 0 };
      answer(`Saved as ${name}.`);
      list();
    } catch (error) {
      asked = { what: "", until: 0 };
      answer(`${name} was not saved: ${error.message}`);
    }
  };
  $("downloadplan").onclick = () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text.value], { type: "text/plain" }));
    link.download = fileName();
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  };

  function fileName() {
    const name = $("planname").value.trim() || "plan";
    return name.endsWith(".txt") ? name : `${name}.txt`;
  }

  // ---- Simulation and flight.

  $("simulate").onclick = async () => {
    const plan = text.value;
    $("simulation").textContent = "simulating";
    try {
      const response = await ask("plan/simulate", { method: "POST", body: plan });
      if (!response.ok) throw new Error(await response.text());
      const found = await response.json();
      if (plan !== text.value) return;
      flown = found;
    } catch (error) {
      $("simulation").textContent = `It cannot be simulated: ${error.message}`;
      return;
    }
    if (!flown) {
      $("simulation").textContent = "A plan with errors is not simulated.";
      return;
    }
    const warnings = (flown.warnings ?? []).map(({ t_s, text }) => `; after ${t_s.toFixed(0)} s: ${text}`).join("");
    const cost = flown.track ? `; ${flown.length_s.toFixed(1)} s in the air, ${flown.battery_percent.toFixed(1)} % of the battery` : "";
    $("simulation").textContent = `Simulated: ${flown.outcome}${cost}${warnings}.`;
    $("simulation").className = flown.completed ? "" : "ill";
  };

  $("load").onclick = () => {
    // In the air a plan is flown as soon as it is loaded.
    if (status && status.phase === "flying" && !twice("load")) return;
    waits = true;
    setTimeout(() => (waits = false), 2000);
    order({ order: "load", name: fileName(), plan: text.value });
  };

  $("addstep").onclick = () => {
    const command = $("newstep").value;
    const last = targets().at(-1) ?? { x: 0, y: 0 };
    add(command.startsWith("goto ") ? target({ x: last.x, y: last.y + 1 }) : command);
  };
  text.oninput = changed;

  return {
    // The first message has come: there is a text to begin with.
    begin(message) {
      if (begun) return;
      begun = true;
      commands = message.commands;
      const options = commands.filter(({ example }) => example);
      $("newstep").replaceChildren(...options.map(({ help, example }) => Object.assign(document.createElement("option"), { value: example, textContent: help })));
      $("newstep").value = declared("goto").example;
      list();
      let kept = null;
      try {
        kept = JSON.parse(sessionStorage.getItem(KEPT));
      } catch {
        // What was kept is not ours.
      }
      if (kept) open(kept[0], kept[1]);
      else if (message.steps.length) this.edit(message);
      else open("example.txt", EXAMPLE);
    },
    // Edits the mission of the vehicle.
    edit(message) {
      const name = message.plan.split(/[\\/]/).at(-1) || "mission.txt";
      open(name, message.steps.map((step) => step.text).join("\n") + "\n");
      if (view) show("plan");
    },
    loaded() {
      if (!waits) return;
      waits = false;
      answer("");
      show("fly");
    },
    refused(reason) {
      waits = false;
      answer(reason);
    },
    isDragging: () => Boolean(drag),
    simulated: () => flown,
    text: () => text.value,
    name: fileName,
    // Places that the map must show.
    places: () => [...targets().map(({ x, y }) => [x, y]), ...(flown && flown.track ? flown.track.map(([, x, y]) => [x, y]) : [])],
    targets,
    drawOn,
  };
})();
