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
  // Targets that are closer than this share a mark, in sizes of a mark.
  const SHARES = 0.5;
  // Problems that are listed; nobody reads more.
  const MOST_PROBLEMS = 100;
  // Of the plan language: { name, help, example, numbers: [[name, unit]], isTarget }.
  let commands = [];
  const declared = (name) => commands.find((command) => command.name === name);

  const text = $("plantext");
  let checked = null; // the checker's answer for the text
  let flown = null; // the simulated flight of the text
  let checking = false; // a check is on its way
  let stale = false; // the text has changed meanwhile
  let rows = []; // of the list: { key, index, item, inputs, note }
  let located = { of: null, targets: [] }; // the targets of the checked plan
  let drawn = {}; // what the marks on the map were drawn of
  let numbered = 0; // rows that were ever made
  let saved = ""; // the text as it was opened or saved
  const history = new History();
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
  function setNumbers(index, numbers, kind) {
    const all = lines();
    for (const place of Object.keys(numbers).map(Number).sort((one, other) => other - one)) {
      const found = words(all[index])[place];
      if (found) all[index] = all[index].slice(0, found.at) + numbers[place] + all[index].slice(found.at + found.word.length);
    }
    write(all.join("\n"), kind);
  }

  // Changes of one kind in a row are undone together.
  function write(value, kind = "") {
    text.value = value;
    record(kind);
    changed();
  }

  const record = (kind) => history.record({ name: $("planname").value, text: text.value, saved }, kind);

  // Undoes (−1) or does again (1).
  function travel(by) {
    if (!history.canMove(by)) return;
    const state = history.move(by);
    $("planname").value = state.name;
    text.value = state.text;
    saved = state.saved;
    changed();
  }

  const isLarge = () => new Blob([text.value]).size > flight.plan_bytes;
  const isUnsaved = () => text.value !== saved;

  function changed() {
    flown = null;
    // What was confirmed once was another plan.
    asked = { what: "", until: 0 };
    $("simulation").textContent = "";
    try {
      sessionStorage.setItem(KEPT, JSON.stringify([$("planname").value, text.value, saved]));
    } catch {
      // Without storage a reload forgets it.
    }
    drawList();
    drawButtons();
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
        if (isLarge()) throw new Error(tooLarge("it", new Blob([text.value]).size));
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

  const tooLarge = (what, bytes) => `${what} has ${(bytes / 1024).toFixed(0)} kB; a plan is text of at most ${flight.plan_bytes >> 10} kB`;

  // Not by the answer for another text, while that for this one is on its way.
  const isGood = () => Boolean(checked && checked.steps && !stale && !checking);

  // ---- The list.

  // Makes anew only the rows that have another form than before: between those at the beginning and at the end that are the same.
  function drawList() {
    const commands = isLarge() ? [] : lines().map((line, index) => ({ index, found: words(line) })).filter(({ found }) => found.length);
    const key = ({ found }) => `${found[0].word} ${found.length} ${found.slice(1).every(({ word }) => Number.isFinite(Number(word)))}`;
    const keys = commands.map(key);
    const shared = (one, other) => {
      let count = 0;
      while (count < Math.min(rows.length, keys.length) && one(count) === other(count)) count += 1;
      return count;
    };
    const before = shared((at) => rows[at].key, (at) => keys[at]);
    const most = Math.min(rows.length, keys.length) - before;
    const after = Math.min(most, shared((at) => rows.at(-1 - at).key, (at) => keys.at(-1 - at)));
    const made = commands.slice(before, commands.length - after).map((command, at) => row(command, keys[before + at]));
    const gone = rows.splice(before, rows.length - before - after, ...made);
    const next = rows[before + made.length]?.item ?? null;
    for (const { item } of gone) item.remove();
    for (const { item } of made) $("draftsteps").insertBefore(item, next);
    rows.forEach((row, at) => {
      const { index, found } = commands[at];
      row.index = index;
      row.inputs.forEach((input, place) => {
        // A number as its field writes it: not "+1" or "1.".
        const value = String(Number(found[place + 1].word));
        // What is being typed into stays as it is.
        if (input !== document.activeElement && input.value !== value) input.value = value;
      });
      if (!row.inputs.length) row.rest.textContent = ` ${found.slice(1).map(({ word }) => word).join(" ")}`;
    });
  }

  function row({ found }, key) {
    const item = document.createElement("li");
    const name = document.createElement("b");
    const rest = document.createElement("span");
    const number = document.createElement("i");
    name.textContent = found[0].word;
    item.append(number, name);
    const numbers = found.slice(1).every(({ word }) => Number.isFinite(Number(word)));
    const fields = numbers ? (declared(found[0].word)?.numbers ?? []).slice(0, found.length - 1) : [];
    const made = { key, index: -1, item, number, rest, inputs: [] };
    // Each is named by the step's number and command, and by itself: "3 goto right, m". A row that only moves keeps its names.
    const place = `step${(numbered += 1)}`;
    [number.id, name.id] = [`${place}number`, `${place}name`];
    const label = (element, what) => {
      Object.assign(element, { id: `${place}${what}`.replace(/\W/g, ""), ariaLabel: what });
      element.setAttribute("aria-labelledby", `${number.id} ${name.id} ${element.id}`);
    };
    made.inputs = fields.map(([field, unit], at) => {
      const input = document.createElement("input");
      Object.assign(input, { type: "number", step: unit.includes("°") ? 15 : 0.1, title: `${field}, ${unit}` });
      label(input, `${field}, ${unit}`);
      input.oninput = () => input.value && setNumbers(made.index, { [at + 1]: input.value }, `number ${made.index} ${at}`);
      // What was cleared and left is as it was.
      input.onblur = () => {
        history.pause();
        drawList();
      };
      item.append(input);
      return input;
    });
    if (!fields.length) item.append(rest);
    made.note = Object.assign(document.createElement("span"), { className: "faint" });
    item.append(made.note);
    const button = (sign, does, action) => {
      const element = Object.assign(document.createElement("button"), { textContent: sign, title: does, onclick: action });
      label(element, does);
      item.append(element);
    };
    button("↑", "move up", () => move(made.index, -1));
    button("↓", "move down", () => move(made.index, 1));
    button("✕", "remove", () => write(lines().filter((_, line) => line !== made.index).join("\n")));
    return made;
  }

  // The version of the language, which stays before all commands.
  const isVersion = (line) => words(line)[0]?.word === "version";

  // Exchanges a command with the one before or behind it.
  function move(index, by) {
    const all = lines();
    const commands = all.map((line, at) => ({ at, is: words(line).length > 0 && !isVersion(line) })).filter(({ is }) => is).map(({ at }) => at);
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
    if (declared(word)?.isTarget && !starts) all.splice(all.findIndex(isVersion) + 1, 0, "takeoff");
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
    $("problems").replaceChildren(...problems.slice(0, MOST_PROBLEMS).map((problem) => {
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
    const byLine = new Map(steps.map((step, index) => [step.line, { step, number: index + 1 }]));
    const ill = new Set(problems.map(({ line }) => line));
    for (const { note, number, index, item } of rows) {
      const found = byLine.get(index + 1);
      const counted = found ? String(found.number) : "";
      if (number.textContent !== counted) number.textContent = counted;
      const said = found?.step.time_s ? ` ${found.step.time_s.toFixed(1)} s` : "";
      if (note.textContent !== said) note.textContent = said;
      item.classList.toggle("ill", ill.has(index + 1));
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
    $("undo").disabled = !history.canMove(-1);
    $("redo").disabled = !history.canMove(1);
    $("unsaved").hidden = !isUnsaved();
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
    if (located.of === checked) return located.targets;
    const numbered = (checked?.steps ?? []).map(({ target, line }, index) => ({ target, line, label: index + 1 }));
    const found = numbered.filter(({ target, line }) => target && line).map(({ target, line, label }) => ({ x: target.x_m, y: target.y_m, z: target.z_m, line, label }));
    located = { of: checked, targets: found };
    return found;
  }

  function canBeDragged({ line }, all) {
    const found = words(all[line - 1] ?? "");
    return declared(found[0]?.word)?.isTarget && found.slice(1, 3).length === 2 && found.slice(1, 3).every(({ word }) => Number.isFinite(Number(word)));
  }

  // Draws the targets and the simulated flight; `size` is that of a mark in metres.
  function drawOn(size) {
    drawButtons();
    const shown = view === "plan";
    $("simulated").setAttribute("points", shown && flown && flown.track ? points(flown.track.map(([, x, y]) => [x, y])) : "");
    if (drawn.size === size && drawn.shown === shown && drawn.checked === checked && drawn.text === text.value) return;
    drawn = { size, shown, checked, text: text.value };
    // A finger that drags one takes it out of those that share its mark.
    const wanted = shown ? map.gathered(targets(), size * SHARES) : [];
    const marks = $("drafts").children;
    while (marks.length > wanted.length) marks[marks.length - 1].remove();
    while (marks.length < wanted.length) {
      const mark = svg("g");
      mark.append(svg("circle", { r: 1.1 }), svg("text", { "font-size": 1.2 }));
      $("drafts").append(mark);
    }
    const all = lines();
    wanted.forEach(({ x, y, all: together }, index) => {
      const mark = marks[index];
      // The last of them is on top.
      const target = together.at(-1);
      set(mark, { "data-line": target.line, class: canBeDragged(target, all) ? "free" : "", transform: `translate(${x} ${-y}) scale(${size * 0.8})` });
      const numbers = map.numbers(together);
      if (mark.lastChild.textContent !== numbers) mark.lastChild.textContent = numbers;
      // Several are smaller, to be inside the mark.
      set(mark.lastChild, { "font-size": 1.2 * Math.min(1, 3 / numbers.length) });
    });
  }

  $("map").addEventListener("pointerdown", (event) => {
    // Two fingers zoom.
    if (!event.isPrimary) {
      dropped();
      return;
    }
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
    setNumbers(drag.line - 1, { 1: moved(1, now.x - drag.last.x), 2: moved(2, now.y - drag.last.y) }, `drag ${drag.line}`);
    drag.last = now;
  });
  const dropped = () => {
    drag = null;
    history.pause();
  };
  $("map").addEventListener("pointerup", dropped);
  $("map").addEventListener("pointercancel", dropped);
  $("map").addEventListener("click", (event) => {
    if (view !== "plan" || pressed || map.wasMoved()) return;
    map.keep();
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

  function open(name, content, kept = content) {
    $("planname").value = name;
    saved = kept;
    write(content);
  }

  // Whether another plan may take the place of this one.
  const mayOpen = async (name) => !isUnsaved() || (await confirmed(`Changes of ${fileName()} are not saved. Open ${name} in its place?`, "Open it"));

  // By arrows and letters the list goes from name to name, and Enter opens the one that is shown.
  let walks = false;
  $("plans").onkeydown = (event) => {
    const opens = walks && event.key === "Enter";
    walks = !event.altKey && (/^(Arrow|Home|End|Page)/.test(event.key) || /^\S$/.test(event.key));
    if (!opens) return;
    event.preventDefault();
    $("plans").onchange();
  };
  $("plans").onpointerdown = () => (walks = false);
  $("plans").onblur = () => {
    if (walks) answer("");
    walks = false;
    $("plans").value = "";
  };

  $("plans").onchange = async () => {
    const name = $("plans").value;
    if (walks) {
      answer(name ? `Enter opens ${$("plans").selectedOptions[0].textContent}.` : "");
      return;
    }
    $("plans").value = "";
    if (!name) return;
    const ours = { "*": ["example.txt", EXAMPLE, "the example"], "-": ["my plan.txt", "takeoff\nland\n", "an empty plan"] }[name];
    if (!(await mayOpen(ours ? ours[2] : name))) return;
    if (ours) {
      open(ours[0], ours[1]);
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
    $("upload").value = "";
    if (!file) return;
    // Looked at before it is read: a large one would be slow to show.
    if (file.size > flight.plan_bytes) answer(`${tooLarge(file.name, file.size)}.`);
    else if (await mayOpen(file.name)) open(file.name, await file.text());
  };
  $("saveplan").onclick = async () => {
    const name = fileName();
    // A file of that name is replaced only on a second click.
    const replaces = twice("save");
    const headers = replaces ? {} : { "If-None-Match": "*" };
    const body = text.value;
    try {
      const response = await ask(`plans/${encodeURIComponent(name)}`, { method: "PUT", headers, body });
      if (response.status === 412) {
        answer(`${name} exists: press again to replace it.`);
        return;
      }
      if (!response.ok) throw new Error(await response.text());
      asked = { what: "", until: 0 };
      answer(`Saved as ${name}.`);
      saved = body;
      record("");
      drawButtons();
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
  text.oninput = () => {
    record("typing");
    changed();
  };
  // The browser's own history knows only what was typed, and mixes it with what was written by other means.
  text.addEventListener("beforeinput", (event) => {
    // What is pasted is looked at before the browser shows it, which takes minutes for a large text.
    const added = new Blob([event.data ?? event.dataTransfer?.getData("text/plain") ?? ""]).size;
    if (added > flight.plan_bytes) {
      event.preventDefault();
      answer(`${tooLarge("what was pasted", added)}.`);
      return;
    }
    const by = { historyUndo: -1, historyRedo: 1 }[event.inputType];
    if (!by) return;
    event.preventDefault();
    travel(by);
  });
  $("undo").onclick = () => travel(-1);
  $("redo").onclick = () => travel(1);
  document.addEventListener("keydown", (event) => {
    // Other fields have a history of their own.
    const inEditor = view === "plan" && !["planname", "typed"].includes(event.target.id);
    if (!inEditor || !(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const by = key === "z" ? (event.shiftKey ? 1 : -1) : key === "y" ? 1 : 0;
    if (!by) return;
    event.preventDefault();
    travel(by);
  });

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
      if (kept) open(kept[0], kept[1], kept[2]);
      else if (message.steps.length) this.edit(message);
      else open("example.txt", EXAMPLE);
    },
    // Edits the mission of the vehicle.
    async edit(message) {
      const name = message.plan.split(/[\\/]/).at(-1) || "mission.txt";
      if (view && !(await mayOpen(`the mission ${name}`))) return;
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
