"use strict";
// What the agents of a fleet say to each other: a column for each vehicle, an arrow for each message, the newest below.

const talk = (() => {
  const MOST = 40; // messages that are kept
  const ROW = 30; // height of one, in pixels
  const WIDTH = 220;

  let names = [];
  let messages = [];

  const column = (name) => ((names.indexOf(name) + 0.5) * WIDTH) / names.length;

  function begin(fleet) {
    names = fleet;
    messages = [];
    draw();
  }

  // One that is said all the time is shown once.
  function add(message) {
    if (message.again) return;
    messages = [...messages, message].slice(-MOST);
    draw();
  }

  const words = (x, y, text, kind) => {
    const element = svg("text", { x, y, class: kind });
    element.textContent = text;
    return element;
  };

  function line(d, vehicle, kind = "") {
    const element = svg("path", { d, class: kind });
    element.style.stroke = fleet.colour(vehicle);
    return element;
  }

  function row({ vehicle, to, text, t_s }, index) {
    const [from, until] = [column(vehicle), column(to)];
    const y = (index + 2) * ROW;
    const towards = Math.sign(until - from);
    const tip = `M${until - towards * 7} ${y - 4}L${until} ${y}L${until - towards * 7} ${y + 4}`;
    return [line(`M${from} ${y}L${until} ${y}${tip}`, vehicle), words((from + until) / 2, y - 5, text.replace(/^achieve /, "!")), words(0, y + 4, `${t_s.toFixed(1)} s`, "when")];
  }

  function draw() {
    $("talk").hidden = !messages.length;
    const height = (messages.length + 2) * ROW - 10;
    const heads = names.flatMap((name) => [
      words(column(name), 14, name),
      line(`M${column(name)} 20V${height}`, name, "life"),
    ]);
    set($("sequence"), { viewBox: `-30 0 ${WIDTH + 30} ${height}` });
    $("sequence").replaceChildren(...heads, ...messages.flatMap(row));
    $("talk").parentElement.scrollTop = $("talk").parentElement.scrollHeight;
  }

  return { begin, add };
})();
