"use strict";
// Shows the scenes that have all chosen tags and all words that are sought.
const [search, count] = [document.getElementById("search"), document.getElementById("count")];
const buttons = [...document.querySelectorAll("button.tag")];
const scenes = [...document.querySelectorAll(".scenes li")];
function filter() {
  const tags = buttons.filter((button) => button.getAttribute("aria-pressed") === "true").map((button) => button.dataset.tag);
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const scene of scenes) {
    const own = scene.dataset.tags.split("|");
    scene.hidden = !(tags.every((tag) => own.includes(tag)) && words.every((word) => scene.textContent.toLowerCase().includes(word)));
    shown += scene.hidden ? 0 : 1;
  }
  for (const section of document.querySelectorAll("section")) section.hidden = !section.querySelector("li:not([hidden])");
  count.textContent = shown === scenes.length ? `${shown} scenes` : `${shown} of ${scenes.length} scenes`;
}
for (const button of buttons) {
  button.addEventListener("click", () => {
    button.setAttribute("aria-pressed", button.getAttribute("aria-pressed") === "true" ? "false" : "true");
    filter();
  });
}
search.addEventListener("input", filter);
filter();
