// What the pages of the book do besides search. Debian's mdBook comes without its own script of this name, which every page loads.
"use strict";

for (const code of document.querySelectorAll("pre code[class*='language-']")) {
  const language = /language-(\w+)/.exec(code.className)[1];
  if (hljs.getLanguage(language)) hljs.highlightElement ? hljs.highlightElement(code) : hljs.highlightBlock(code);
}

const themes = document.querySelector("#theme-list");
document.addEventListener("click", (event) => {
  const opens = event.target.closest("#theme-toggle") && themes.style.display !== "block";
  themes.style.display = opens ? "block" : "none";
});
for (const choice of themes.querySelectorAll("button")) {
  choice.addEventListener("click", () => {
    const chosen = choice.id === "default_theme" ? null : choice.id;
    const names = [...themes.querySelectorAll("button")].map((button) => button.id);
    document.documentElement.classList.remove(...names);
    document.documentElement.classList.add(chosen ?? default_theme);
    try {
      chosen ? localStorage.setItem("mdbook-theme", chosen) : localStorage.removeItem("mdbook-theme");
    } catch {
      // A page that may keep nothing forgets the choice.
    }
  });
}

const sidebarToggle = document.querySelector("#sidebar-toggle-anchor");
sidebarToggle.addEventListener("change", () => {
  const is = sidebarToggle.checked ? "visible" : "hidden";
  document.documentElement.classList.remove("sidebar-visible", "sidebar-hidden");
  document.documentElement.classList.add(`sidebar-${is}`);
  document.querySelector("#sidebar").setAttribute("aria-hidden", is === "hidden");
  document.querySelector("#sidebar-toggle").setAttribute("aria-expanded", is === "visible");
});
