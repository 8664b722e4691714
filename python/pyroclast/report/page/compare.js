// The page of several runs: curves together, specimens where they have the same strain or temperature.

import {Course, axesMenus} from "./course.js";
import {Chart, DASHES} from "./curves.js";
import {$, entry, made, menu, nearest, number, onSight, pageData, player, unitOf, withUnit} from "./elements.js";
import {unpackedAll} from "./packing.js";
import {bodyOf} from "./solid.js";
import {MAGNIFICATIONS, Specimen, tellModes, tellScale} from "./specimen.js";

const page = pageData();
const SHARES = 200; // of the slider
const SIGNS = {good: "✓", doubt: "!", bad: "✗"};
const RUN_COLOURS = ["var(--one)", "var(--other)", "var(--warn-line)", "var(--faint)"]; // none is that of a mode

// The mean of curves over a common x and their least and greatest values, as far as all go that have two points; null
// where fewer than two have, or have no x in common.
function band(curves, count = 200) {
  const rising = curves
    .map(({x, y}) => {
      const points = [];
      for (let i = 0; i < x.length; i++)
        if (isFinite(x[i]) && isFinite(y[i]) && (!points.length || x[i] > points[points.length - 1][0]))
          points.push([x[i], y[i]]);
      return points;
    })
    .filter((points) => points.length > 1);
  if (rising.length < 2) return null;
  const from = Math.max(...rising.map((p) => p[0][0])),
    to = Math.min(...rising.map((p) => p[p.length - 1][0]));
  if (!(to > from)) return null;
  const x = Array.from({length: count}, (_, k) => from + ((to - from) * k) / (count - 1));
  const values = rising.map((points) => {
    let k = 0;
    return x.map((v) => {
      while (k < points.length - 2 && points[k + 1][0] < v) k++;
      const [[x0, y0], [x1, y1]] = [points[k], points[k + 1]];
      return y0 + ((y1 - y0) * (v - x0)) / (x1 - x0);
    });
  });
  const of = (f) => x.map((_, k) => f(values.map((v) => v[k])));
  return {
    count: rising.length,
    x,
    low: of((v) => Math.min(...v)),
    high: of((v) => Math.max(...v)),
    mean: of((v) => v.reduce((p, q) => p + q) / v.length),
  };
}

class ComparePage {
  constructor(arrays) {
    this.runs = page.runs.map((run, k) => {
      const body = run.body && bodyOf(run.body, arrays[k], run.frames);
      return {...run, course: new Course(run.course, arrays[k].history), body, frame: run.frames.length - 1};
    });
    this.axes = {over: page.over, of: page.of};
    this.curve = new Chart($("curve"), {height: 340, name: "curves", pick: (row) => this.go(this.places(0)[row])});
    const common = this.runs[0].course.about.quantities.filter((q) =>
      this.runs.every((r) => r.course.quantity(q.id)),
    );
    axesMenus(this.axes, common, () => {
      this.drawCurves();
      this.scrub();
    });
    this.shown = this.runs.filter((r) => r.body);
    if (this.shown.length) this.makeWall();
    this.drawCurves();
    if (this.shown.length) this.scrub();
  }

  places(k) {
    return this.runs[k].course.of(this.axes.over);
  }

  drawCurves() {
    const {over, of} = this.axes,
      first = this.runs[0].course;
    const curves = this.runs.map((r) => ({x: r.course.of(over), y: r.course.of(of)}));
    const series = curves.map((c, k) => ({
      name: page.seeds ? "" : `${SIGNS[this.runs[k].level]} ${this.runs[k].name}`,
      ...(k ? {x: c.x} : {}),
      y: c.y,
      colour: page.seeds ? "var(--faint)" : RUN_COLOURS[k % RUN_COLOURS.length],
      dash: DASHES[Math.floor(k / RUN_COLOURS.length) % 4],
      width: page.seeds ? 0.7 : 1.8,
    }));
    const b = page.seeds ? band(curves) : null;
    if (b)
      series.push(
        {
          name: `${b.count} seeds: least to greatest`,
          x: b.x,
          y: b.high,
          base: b.low,
          colour: "var(--curve)",
          opacity: 0.25,
        },
        {name: "their mean, as far as all go", x: b.x, y: b.mean, colour: "var(--curve)", width: 2.2},
      );
    this.curve.draw({
      ...first.over(over),
      yLabel: first.quantity(of).label,
      series,
      from0: true,
    });
  }

  // ---- specimens

  makeWall() {
    const wall = $("wall");
    for (const run of this.shown) this.addSpecimen(wall, run, run.name);
    const pair = page.same.find((p) => p.every((k) => this.runs[k].body && this.runs[k].body.modes.length));
    if (pair) this.both = {pair, specimen: this.addSpecimen(wall, this.runs[pair[0]], "cracks of both", true)};
    const fields = this.shown[0].body.fields.filter(([id]) =>
      this.shown.every((r) => r.body.fields.some((f) => f[0] === id)),
    );
    menu("colour", fields, fields[0][0], () => this.redraw());
    menu("magnification", MAGNIFICATIONS.map((m) => [m, m]), 1, () => this.redraw());
    player(2, () => this.scrub());
    addEventListener("keydown", (e) => {
      const step = {ArrowRight: 4, ArrowLeft: -4, Home: -SHARES, End: SHARES}[e.key];
      if (!step || e.target.matches("select, input")) return;
      e.preventDefault();
      $("at").value = +$("at").value + step;
      this.scrub();
    });
    onSight(this.specimens[0].canvas.parentElement, (width) => this.fit(width), () => this.redraw());
    this.fit(this.specimens[0].canvas.parentElement.clientWidth);
  }

  addSpecimen(wall, run, name, isOfBoth = false) {
    const host = made("div", null, wall);
    made("h3", name, host);
    const canvas = made("canvas", null, host),
      specimen = new Specimen(canvas, run.body);
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", name);
    if (isOfBoth) specimen.key = made("div", null, host, "key");
    const told = made("p", "", host, "note");
    if (isOfBoth) return Object.assign(specimen, {told});
    return (run.specimen = Object.assign(specimen, {told}));
  }

  get specimens() {
    return [...this.shown.map((r) => r.specimen), ...(this.both ? [this.both.specimen] : [])];
  }

  fit(width) {
    for (const s of this.specimens) s.size(width, Math.max(300, 0.7 * innerHeight));
    this.redraw();
  }

  // Ends of what the slider covers: as far as the runs that are shown go.
  get ends() {
    const all = this.shown.map((r) => r.frames.map((f) => r.course.of(this.axes.over)[f.row]).filter(isFinite));
    return [Math.min(...all.map((v) => Math.min(...v))), Math.max(...all.map((v) => Math.max(...v)))];
  }

  go(place) {
    if (!this.shown.length) return;
    const [low, high] = this.ends;
    $("at").value = Math.round((SHARES * (place - low)) / (high - low || 1));
    this.scrub();
  }

  scrub() {
    const [low, high] = this.ends,
      place = low + ((high - low) * $("at").value) / SHARES,
      q = this.runs[0].course.quantity(this.axes.over);
    for (const run of this.shown) {
      const x = run.course.of(this.axes.over),
        places = run.frames.map((f) => x[f.row]),
        best = nearest(places, place),
        cracks = run.body.modes.length ? `, ${run.body.cracks(best).length} cracks` : "",
        at = withUnit(number(places[best], 4), unitOf(q.label));
      run.frame = run.specimen.frame = best;
      run.specimen.told.textContent = `frame ${run.frames[best].number}: ${at}${cracks}`;
    }
    $("now").textContent = `${q.label}: ${number(place, 4)}`;
    this.redraw();
  }

  redraw() {
    for (const run of this.shown) {
      Object.assign(run.specimen, {colour: $("colour").value, magnification: +$("magnification").value});
      this.alike(run);
      run.specimen.draw();
    }
    if (this.both) this.drawBoth();
    this.tellKey();
  }

  // The same colours stand for the same values in all runs.
  alike(run) {
    const field = $("colour").value;
    if (field === "material") return;
    for (const r of this.shown) r.body.range(field);
    const ranges = this.shown.map((r) => r.body.ranges[field]);
    run.body.ranges[field] = {
      ...ranges[0],
      low: Math.min(...ranges.map((r) => r.low)),
      high: Math.max(...ranges.map((r) => r.high)),
    };
  }

  // Cracks that only the first run has, only the second, and both, on the specimen as it was made.
  drawBoth() {
    const {pair, specimen} = this.both,
      [a, b] = pair.map((k) => this.runs[k]),
      {ratio} = specimen;
    Object.assign(specimen, {frame: a.frame, colour: "material", cracks: "none", magnification: 0});
    specimen.draw();
    const ofA = new Set(a.body.cracks(a.frame)),
      ofB = new Set(b.body.cracks(b.frame)),
      theme = specimen.theme();
    const line = (c) => specimen.body.line(c),
      colours = this.bothColours.map((name) => theme.value(name.slice(4, -1)));
    const sets = [
      [...ofA].filter((c) => !ofB.has(c)),
      [...ofB].filter((c) => !ofA.has(c)),
      [...ofA].filter((c) => ofB.has(c)),
    ];
    sets.forEach((set, k) => specimen.stroke(colours[k], 2.2 * ratio, set.map(line)));
    const [ofFirst, ofSecond, ofBoth] = sets.map((set) => set.length);
    specimen.told.textContent = `only in ${a.name}: ${ofFirst}; only in ${b.name}: ${ofSecond}; in both: ${ofBoth}`;
    this.counts = sets.map((s) => s.length);
  }

  // As the curves of the two runs.
  get bothColours() {
    return [...this.both.pair.map((k) => RUN_COLOURS[k % RUN_COLOURS.length]), "var(--ink)"];
  }

  tellKey() {
    const key = $("key"),
      {body} = this.shown[0],
      field = $("colour").value;
    key.replaceChildren();
    if (field !== "material") tellScale(key, body, field);
    tellModes(key, body);
    if (!this.both) return;
    const [a, b] = this.both.pair.map((k) => this.runs[k].name),
      names = [`only in ${a}`, `only in ${b}`, "in both"];
    this.both.specimen.key.replaceChildren(...names.map((name, k) => entry({name, colour: this.bothColours[k]})));
  }
}

Promise.all(page.runs.map((run) => unpackedAll(run.arrays))).then((arrays) => {
  window.pyroclast = new ComparePage(arrays);
});
