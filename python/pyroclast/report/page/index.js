// An index of runs: finds by words, shows by verdict, sorts by name or by a result.

import {$, menu} from "./elements.js";

const runs = [...document.querySelectorAll(".run")];
const results = [
  ...new Set(runs.flatMap((run) => [...run.querySelectorAll("[data-result]")].map((cell) => cell.dataset.result))),
];

function valueOf(run, name) {
  const cell = [...run.querySelectorAll("[data-result]")].find((c) => c.dataset.result === name);
  const value = cell ? parseFloat(cell.textContent) : NaN;
  return isFinite(value) ? value : -Infinity;
}

function show() {
  const words = $("find").value.toLowerCase().split(/\s+/).filter(Boolean),
    level = $("level").value,
    sort = $("sort").value;
  const shown = runs.filter((run) => {
    const text = run.textContent.toLowerCase();
    run.hidden = Boolean(level && run.dataset.level !== level) || !words.every((word) => text.includes(word));
    return !run.hidden;
  });
  $("count").textContent = shown.length;
  const byName = (p, q) => p.dataset.name.localeCompare(q.dataset.name, undefined, {numeric: true});
  const order = sort === "name" ? byName : (p, q) => valueOf(q, sort) - valueOf(p, sort) || byName(p, q);
  $("runs").append(...[...runs].sort(order));
}

menu("sort", results.map((name) => [name, name]), "name", show);
$("find").oninput = $("level").onchange = show;
