"use strict";
// The settings of later flights: what each is for, and its value in the file.

const settings = (() => {
  let rows = []; // { setting, input, item }
  const note = (words, ill) => {
    $("settingsnote").textContent = words;
    $("settingsnote").classList.toggle("ill", Boolean(ill));
  };

  async function list(said = "") {
    let found;
    try {
      const response = await fetch(`settings${location.search}`);
      if (!response.ok) throw new Error((await response.text()).trim());
      found = await response.json();
    } catch (error) {
      note(`The settings cannot be read: ${error.message}`, true);
      return;
    }
    $("settingsfile").textContent = found.file;
    const waiting = found.settings.filter(({ value, in_effect }) => JSON.stringify(value) !== JSON.stringify(in_effect)).length;
    const name = found.file.split("/").pop();
    const how = found.is_shared ? `Write config = "${name}" into [fleet] of the fleet's file` : `Start with --config ${found.file}`;
    const start = found.is_used ? "" : ` ${how} to use it.`;
    note(`${said} ${waiting ? `${waiting} of them are not in effect: start ardrone-pilot again.` : "All of them are in effect."}${start}`.trim());
    rows = found.settings.map(row);
    const sections = new Set();
    $("settings").replaceChildren(...rows.flatMap(({ setting, item }) => {
      if (sections.has(setting.section)) return [item];
      sections.add(setting.section);
      return [Object.assign(document.createElement("h3"), { textContent: setting.section }), item];
    }));
    drawChanges();
    filter();
  }

  // A value as it is typed, and back.
  const shown = (value) => (typeof value === "string" ? value : JSON.stringify(value));
  function typed({ input, setting: { name, value } }) {
    if (typeof value === "boolean") return input.value === "true";
    if (typeof value === "number") {
      if (!Number.isFinite(input.valueAsNumber)) throw new Error(`${name} is no number`);
      return input.valueAsNumber;
    }
    return typeof value === "string" ? input.value : JSON.parse(input.value);
  }

  function row(setting) {
    const { name, help, range, value, in_effect: inEffect } = setting;
    const item = document.createElement("label");
    const input = document.createElement(typeof value === "boolean" ? "select" : "input");
    if (typeof value === "boolean") input.append(new Option("true"), new Option("false"));
    if (typeof value === "number") Object.assign(input, { type: "number", step: "any", ...(range ? { min: range[0], max: range[1] } : {}) });
    input.value = shown(value);
    input.oninput = drawChanges;
    const said = [help, range ? `${range[0]} to ${range[1]}.` : "", setting.default === null ? "" : `Default ${shown(setting.default)}.`];
    if (shown(value) !== shown(inEffect)) said.push(`In effect: ${inEffect === null ? "none" : shown(inEffect)}.`);
    item.append(
      Object.assign(document.createElement("b"), { textContent: name }), input,
      Object.assign(document.createElement("small"), { textContent: said.filter(Boolean).join(" ") }),
    );
    return { setting, input, item };
  }

  const changed = () => rows.filter(({ setting, input }) => input.value !== shown(setting.value));

  function drawChanges() {
    for (const { setting, input, item } of rows) item.classList.toggle("changed", input.value !== shown(setting.value));
    $("savesettings").disabled = $("forgetsettings").disabled = !changed().length;
  }

  function filter() {
    const wanted = $("ofsettings").value.trim().toLowerCase();
    for (const { setting: { section, name, help }, item } of rows) {
      item.hidden = !`${section} ${name} ${help}`.toLowerCase().includes(wanted);
    }
  }

  $("ofsettings").oninput = filter;
  $("forgetsettings").onclick = () => list();
  $("savesettings").onclick = async () => {
    if (isAirborne()) {
      note("Settings are changed on the ground.", true);
      return;
    }
    const sections = {};
    try {
      for (const row of changed()) (sections[row.setting.section] ??= {})[row.setting.name] = typed(row);
    } catch (error) {
      note(`Nothing was saved: ${error.message}. A list is written as [1, 2].`, true);
      return;
    }
    try {
      const response = await fetch(`settings${location.search}`, { method: "PUT", body: JSON.stringify(sections) });
      if (!response.ok) throw new Error((await response.text()).trim());
    } catch (error) {
      note(`Nothing was saved: ${error.message}`, true);
      return;
    }
    list("Saved.");
  };

  return { list };
})();
