// What pages of runs and comparisons share: elements, tables, and the history of a run.

document.documentElement.classList.add("script");
const $ = (id) => document.getElementById(id);
const made = (name, text, parent, className) => {
  const one = document.createElement(name);
  if (text !== undefined && text !== null) one.textContent = text;
  if (className) one.className = className;
  if (parent) parent.append(one);
  return one;
};
const number = (v, digits = 3) => (isFinite(v) ? String(+v.toPrecision(digits)).replace("-", "−") : "–");
const ENERGY_COLOURS = {"#000000": "var(--ink)", "#10245e": "var(--shear)", "#d55e00": "var(--tension)"};
const COLOURS = [
  "var(--curve)",
  "var(--tension)",
  "var(--good)",
  "var(--mixed)",
  "var(--warn-line)",
  "var(--faint)",
];
const RUN_COLOURS = ["var(--one)", "var(--other)", "var(--warn-line)", "var(--faint)"]; // none is that of a mode
const DASHES = ["", "7 3", "2 2", "7 3 2 3"];

// The history: columns by name, quantities by id.
class Course {
  constructor(about, numbers, columns = about.columns) {
    Object.assign(this, {about, rows: numbers.shape[0]});
    this.columns = {};
    columns.forEach((name, k) => {
      this.columns[name] = Float64Array.from({length: this.rows}, (_, i) => numbers.at(i, k));
    });
  }
  has(name) {
    return name in this.columns;
  }
  column(name) {
    return this.columns[name] || new Float64Array(this.rows).fill(NaN);
  }
  quantity(id) {
    return this.about.quantities.find((q) => q.id === id);
  }
  of(id) {
    const q = this.quantity(id);
    const stage = this.column("stage");
    return this.column(q.column).map((v, i) => (stage[i] < q.stage ? NaN : v * q.factor - q.offset));
  }
  varies(id) {
    const values = this.of(id).filter(isFinite);
    let [low, high] = [Infinity, -Infinity];
    for (const v of values) [low, high] = [Math.min(low, v), Math.max(high, v)];
    return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high));
  }
  // Change of a column over a piece of rows; a cell that is empty counts as the nearest one that is not.
  change(name, [a, b]) {
    const values = this.column(name);
    let from = a,
      to = b;
    while (from < b && !isFinite(values[from])) from++;
    while (to > a && !isFinite(values[to])) to--;
    return isFinite(values[to] - values[from]) ? values[to] - values[from] : 0;
  }
}

// A table; a head is a text, or a text and what it means.
function table(host, head, rows) {
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

// A body of the plane, or a plane through a solid.
const bodyOf = (about, arrays, frames) => new (about.solid ? CutBody : Body)(about, arrays, frames);

// Into a key: the scale of a field that blocks are coloured by.
function tellScale(key, body, field) {
  const {low, high, isTwoSided} = body.range(field),
    stops = isTwoSided ? TWO_SIDED : ONE_SIDED,
    scale = made("span", null, key, "scale");
  scale.append(number(low));
  made("i", null, scale).style.background = `linear-gradient(90deg, ${stops.map(css).join(", ")})`;
  scale.append(`${number(high)} ${unitOf(body.fields.find((f) => f[0] === field)[1])}`);
  if (field.startsWith("stress")) key.append("tension positive");
}

// Into a key: cracks by their mode.
function tellModes(key, body) {
  for (const mode of body.modes)
    key.append(
      entry({name: `${mode}, broken`, colour: `var(--${mode})`}),
      entry({name: `${mode}, damaged by more than half`, colour: `var(--${mode}-tint)`}),
    );
}

// The unit in the brackets of a label.
const unitOf = (label) => (label.match(/\[(.*)\]/) || ["", ""])[1];
// A number with its unit; "10⁻³" is a factor.
const withUnit = (text, unit) => `${text}${unit.startsWith("10") ? "·" : " "}${unit}`;
const page = JSON.parse($("data").textContent);
