// Elements of pages: texts, tables, menus, and what moves a slider.

export const $ = (id) => document.getElementById(id);
export const made = (name, text, parent, className) => {
  const one = document.createElement(name);
  if (text !== undefined && text !== null) one.textContent = text;
  if (className) one.className = className;
  if (parent) parent.append(one);
  return one;
};
// What the page says to its script.
export function pageData() {
  document.documentElement.classList.add("script");
  return JSON.parse($("data").textContent);
}
export const number = (v, digits = 3) => (isFinite(v) ? String(+v.toPrecision(digits)).replace("-", "−") : "–");

// The unit in the brackets of a label.
export const unitOf = (label) => (label.match(/\[(.*)\]/) || ["", ""])[1];
// A number with its unit; "10⁻³" is a factor.
export const withUnit = (text, unit) => `${text}${unit.startsWith("10") ? "·" : " "}${unit}`;

// A table; a head is a text, or a text and what it means.
export function table(host, head, rows) {
  const scroll = made("div", null, host, "scroll"),
    one = made("table", null, scroll),
    line = made("tr", null, made("thead", null, one));
  for (const one of head) {
    const [text, meaning] = [one].flat();
    if (meaning) made("abbr", text, made("th", null, line)).title = meaning;
    else made("th", text, line);
  }
  const below = made("tbody", null, one);
  for (const cells of rows) {
    const row = made("tr", null, below);
    for (const text of cells) made("td", text, row, typeof text === "number" ? "number" : "");
  }
}

// A line of a legend.
export function entry(s) {
  const one = document.createElement("span"),
    sign = document.createElement("i");
  sign.style.background = s.colour;
  if (s.dash) sign.style.background = `repeating-linear-gradient(90deg, ${s.colour} 0 .4em, transparent .4em .6em)`;
  if (s.base) sign.style.height = ".7em";
  one.append(sign, s.name);
  return one;
}

// Fills a menu with entries [value, text]; `act` takes the value that is chosen.
export function menu(id, entries, now, act) {
  for (const [value, text] of entries) $(id).append(new Option(text, value, false, value === now));
  $(id).onchange = () => act($(id).value);
}

// The button "play" moves the slider "at" to its end, so far at a time; `act` follows each move of the slider.
export function player(step, act) {
  const [at, play] = [$("at"), $("play")],
    go = (place) => act((at.value = place));
  let timer;
  at.oninput = () => act();
  play.onclick = () => {
    const isOn = play.textContent === "pause";
    play.textContent = isOn ? "play" : "pause";
    clearInterval(timer);
    if (isOn) return;
    if (+at.value >= +at.max) go(0);
    timer = setInterval(() => (+at.value >= +at.max ? play.onclick() : go(+at.value + step)), 80);
  };
}

// Calls `fit` with the width of an element whenever it has another, and `redraw` when the theme changes.
export function onSight(element, fit, redraw) {
  let before = 0;
  new ResizeObserver(() => {
    const width = element.clientWidth;
    if (width && width !== before) fit((before = width));
  }).observe(element);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

// Which of the values lies nearest to a number.
export const nearest = (values, to) =>
  values.reduce((p, v, k) => (!isFinite(values[p]) || Math.abs(v - to) < Math.abs(values[p] - to) ? k : p), 0);
