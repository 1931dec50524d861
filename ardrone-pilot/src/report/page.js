"use strict";
// Hovering over a plot marks the time in all plots and shows the decision of that time.
const { decisions, plans } = JSON.parse(document.getElementById("decided").textContent);
const { end, width, left, right } = document.getElementById("plots").dataset;
const plots = [...document.querySelectorAll(".plot")];
const rows = [...document.querySelectorAll("#timeline tbody tr")];
const why = document.getElementById("moment");

function element(name, text, parent) {
  const made = document.createElement(name);
  made.textContent = text;
  parent.append(made);
  return made;
}

function show(seconds) {
  for (const plot of plots) {
    const cursor = plot.querySelector(".cursor");
    const scale = plot.clientWidth / width;
    const inner = width - left - right;
    cursor.style.left = `${(Number(left) + (seconds / end) * inner) * scale}px`;
    cursor.style.display = "block";
  }
  const index = decisions.findIndex((decision) => seconds <= decision.to_s);
  const decision = decisions[index < 0 ? decisions.length - 1 : index];
  why.replaceChildren();
  element("p", `${seconds.toFixed(2)} s · ${decision.step}`, why);
  element("p", `ordered: ${decision.command}`, why);
  if (decision.said) element("p", decision.said, why);
  for (const warning of decision.warnings) element("p", warning, why).className = "warn";
  for (const [trigger, line] of decision.plans) {
    element("p", `because of line ${line}`, why).className = "faint";
    element("pre", plans[line] || trigger, why);
  }
  rows.forEach((row) => row.classList.toggle("now", Number(row.dataset.index) === index));
}

for (const plot of plots) {
  plot.addEventListener("mousemove", (event) => {
    const box = plot.getBoundingClientRect();
    const inner = width - left - right;
    const x = ((event.clientX - box.left) / box.width) * width;
    show(Math.min(Math.max(((x - left) / inner) * end, 0), Number(end)));
  });
}
for (const row of rows) {
  row.addEventListener("mouseenter", () => show(decisions[row.dataset.index].from_s + 0.001));
}
