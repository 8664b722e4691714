// The tabs below specimen and curve.

import {DASHES, svg} from "./curves.js";
import {$, made, number} from "./elements.js";

const ENERGY_COLOURS = {"#000000": "var(--ink)", "#10245e": "var(--shear)", "#d55e00": "var(--tension)"};
const COLOURS = ["curve", "tension", "good", "mixed", "warn-line", "faint"].map((name) => `var(--${name})`);

export class Tabs {
  // properties: panels of lines over the temperature.
  constructor(scene, charts, properties) {
    Object.assign(this, {scene, charts, properties, course: scene.course});
    const tabs = [...document.querySelectorAll(".tab")],
      bar = $("tabs");
    const isEmpty = {
      heat: !this.drawsHeat(),
      water: !this.course.quantity("water_held"),
      spalling: !this.course.quantity("spalled_pieces"),
      energies: !this.course.about.energy_out.length,
      convergence: !this.course.has("unbalanced_ratio"),
    };
    const draw = {
      energies: () => this.drawEnergies(),
      cracks: () => this.drawCracks(),
      heat: () => this.drawHeat(),
      water: () => this.drawWater(),
      spalling: () => this.drawSpalling(),
      properties: () => this.drawProperties(),
      convergence: () => this.drawConvergence(),
    };
    const drawn = new Set();
    const shownTabs = tabs.filter((t) => !isEmpty[t.dataset.tab] || t.remove());
    const ensure = (name) => {
      if (draw[name] && !drawn.has(name)) {
        drawn.add(name);
        draw[name]();
      }
    };
    const open = (name) => {
      for (const t of shownTabs) t.classList.toggle("open", t.dataset.tab === name);
      for (const b of bar.children) {
        b.setAttribute("aria-selected", String(b.dataset.tab === name));
        b.tabIndex = b.dataset.tab === name ? 0 : -1;
      }
      ensure(name);
    };
    for (const t of shownTabs) {
      const button = made("button", t.dataset.tab === "made" ? "how it was made" : t.dataset.tab, bar);
      Object.assign(button, {type: "button", onclick: () => open(t.dataset.tab)});
      button.dataset.tab = t.dataset.tab;
      button.setAttribute("role", "tab");
      button.setAttribute("aria-controls", t.id);
      t.setAttribute("role", "tabpanel");
    }
    bar.addEventListener("keydown", (e) => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[e.key];
      if (!step) return;
      const all = [...bar.children],
        next = all[(all.indexOf(document.activeElement) + step + all.length) % all.length];
      e.stopPropagation();
      next.focus();
      next.click();
    });
    addEventListener("beforeprint", () => shownTabs.forEach((t) => ensure(t.dataset.tab)));
    if (shownTabs.length) open(shownTabs[0].dataset.tab);
  }

  // Draws series over rows; drawing: what the chart has beside them.
  draw(id, name, options, drawing) {
    const {over, stages} = this.course.about;
    this.charts.add($(id), {name, ...options}).draw({...this.course.over(over), stages, ...drawing});
  }

  drawEnergies() {
    let base = new Float64Array(this.course.rows);
    const series = [];
    const put = new Float64Array(this.course.rows);
    for (const name of this.course.about.energy_in)
      this.course.column(name).forEach((v, i) => {
        put[i] += v || 0;
      });
    for (const {column, label, colour} of this.course.about.energy_out) {
      const values = this.course.column(column),
        above = base.map((v, i) => v + (values[i] || 0));
      if (values.some((v) => Math.abs(v) > 5e-4 * Math.max(...put.map(Math.abs))))
        series.push({name: label, y: above, base, colour: ENERGY_COLOURS[colour] || colour});
      base = above;
    }
    series.push({name: "put in", y: put, colour: "var(--ink)", width: 1.4, dash: "5 3"});
    series.reverse();
    this.draw("energies", "energies", {height: 320, brushes: true}, {series, yLabel: "energy [J]", from0: true});
  }

  drawCracks() {
    const {cracks, extent_unit: unit} = this.course.about,
      yLabel = unit === "m" ? "length of damaged contacts [m]" : "area of damaged contacts [m²]";
    const series = [];
    for (const {mode, interface: name, extent} of cracks)
      series.push({
        name: `${mode}, ${name.replaceAll("_", "–")}`,
        y: this.course.column(extent),
        colour: `var(--${mode})`,
        dash: DASHES[cracks.filter((c) => c.mode === mode).findIndex((c) => c.interface === name) % 4],
        width: 1.6,
      });
    this.draw("crack_lengths", yLabel, {brushes: true}, {series, yLabel, from0: true});
    if (this.scene.body && !this.scene.body.about.solid) {
      this.drawRose();
      this.drawOpenings();
    }
  }

  // Length of cracks, damaged by more than a half, at the end by the steepness of their lines.
  drawRose() {
    const host = $("rose"),
      {body, frames} = this.scene,
      bins = new Float64Array(18);
    for (const c of body.cracks(frames.length - 1)) {
      const turn = body.steepness(c);
      bins[Math.floor(((turn / Math.PI + 1) % 1) * 18) % 18] += body.arrays.extent.at(c, 0);
    }
    made("h3", "Steepness of cracks, by length, at the end", host);
    const size = 220,
      middle = size / 2,
      most = Math.max(...bins, 1e-12);
    const drawing = svg(
      "svg",
      {viewBox: `0 0 ${size} ${size}`, height: size, class: "chart", role: "img", "aria-label": "rose of cracks"},
      host,
    );
    for (const share of [0.5, 1])
      svg("circle", {cx: middle, cy: middle, r: share * 95, fill: "none", class: "grid"}, drawing);
    for (let k = 0; k < 36; k++) {
      const r = 95 * Math.sqrt(bins[k % 18] / most),
        from = (Math.PI * k) / 18,
        to = (Math.PI * (k + 1)) / 18;
      const at = (t) => `${(middle + r * Math.cos(t)).toFixed(1)} ${(middle - r * Math.sin(t)).toFixed(1)}`;
      svg("path", {d: `M${middle} ${middle}L${at(from)}L${at(to)}Z`}, drawing).style.fill = "var(--curve)";
    }
  }

  drawOpenings() {
    const host = $("openings"),
      {body, frames} = this.scene,
      last = frames.length - 1,
      bins = new Float64Array(12),
      edges = Array.from({length: 13}, (_, k) => 2 ** k / 4);
    for (const c of body.cracks(last)) {
      const um = 1e6 * body.arrays.opening.at(last, c);
      if (um > 0) bins[Math.max(0, Math.min(11, Math.floor(Math.log2(4 * um))))] += body.arrays.extent.at(c, 0);
    }
    made("h3", "Openings of cracks at the end, by length", host);
    const rows = Array.from(bins, (length, k) => [
      `${k ? number(edges[k], 2) : 0} to ${k < 11 ? number(edges[k + 1], 2) : "more"}`,
      number(1e3 * length),
    ]);
    const most = Math.max(...bins, 1e-12),
      drawing = svg(
        "svg",
        {viewBox: "0 0 360 220", height: 220, class: "chart", role: "img", "aria-label": "histogram of openings"},
        host,
      );
    rows.forEach(([label, length], k) => {
      svg("text", {x: 92, y: 15 + 16.5 * k, "text-anchor": "end"}, drawing, `${label} µm`);
      svg(
        "rect",
        {x: 98, y: 5 + 16.5 * k, width: Math.max(0.5, (200 * bins[k]) / most), height: 12},
        drawing,
      ).style.fill = "var(--curve)";
      svg("text", {x: 104 + (200 * bins[k]) / most, y: 15 + 16.5 * k}, drawing, `${length} mm`);
    });
  }

  drawsHeat() {
    const t = this.course.column("temperature_max_degC");
    return this.course.has("heating_time_s") && Math.max(...t.filter(isFinite)) - Math.min(...t.filter(isFinite)) > 1;
  }

  // Draws quantities over the time of heating, those that the run has, and those of probes by the start of their ids.
  drawOverMinutes(place, title, yLabel, ids, ofProbes) {
    const {course} = this,
      colours = ["var(--ink)", ...COLOURS],
      probes = course.about.quantities.map((q) => q.id).filter((id) => ofProbes && id.startsWith(ofProbes));
    const series = [...ids, ...probes]
      .filter((id) => course.quantity(id))
      .map((id, k) => ({
        name: course.quantity(id).label,
        y: course.of(id),
        colour: id === "gas" ? "var(--faint)" : colours[k % 6],
        dash: id === "gas" ? DASHES[1] : DASHES[Math.floor(k / 6) % 4],
      }));
    this.draw(place, title, {}, {...course.over("minutes"), yLabel, series});
  }

  drawHeat() {
    const ids = ["temperature", "temperature_min", "temperature_max", "gas"];
    this.drawOverMinutes("heat", "temperatures", "temperature [°C]", ids, "probe ");
  }

  drawWater() {
    this.drawOverMinutes("pore_pressures", "pore pressures", "pore pressure [MPa]", ["water_largest_pressure"], "pore ");
    this.drawOverMinutes("water", "water", "water [kg]", ["water_held", "water_left", "water_released"]);
  }

  drawSpalling() {
    const depths = ["spalled_largest_depth", "spalled_mean_depth"];
    this.drawOverMinutes("spalled_depths", "depths", "depth lost [mm]", depths);
    this.drawOverMinutes("spalled_mass", "mass", "mass that left [kg]", ["spalled_mass"]);
    this.drawOverMinutes("bars", "bars", "temperature at the depth of a bar [°C]", [], "bar ");
  }

  // Panels whose cursor is the greatest temperature of the row.
  drawProperties() {
    for (const {title, label, from0, lines} of this.properties) {
      const host = made("div", null, $("properties"));
      made("h3", title, host);
      this.charts.add(host, {height: 240, name: title, picks: false}).draw({
        x: this.course.column("temperature_max_degC"),
        label: "temperature [°C]",
        yLabel: label,
        from0,
        series: lines.map((line, k) => ({...line, colour: COLOURS[k % COLOURS.length], dash: DASHES[k % 4]})),
      });
    }
  }

  drawConvergence() {
    const {course} = this;
    const series = [
      ["unbalanced", "var(--curve)"],
      ["kinetic", "var(--tension)"],
    ]
      .filter(([id]) => course.quantity(id))
      .map(([id, colour]) => ({name: course.quantity(id).label, y: course.of(id), colour, width: 1.2}));
    const drawing = {...course.over("step"), yLabel: "ratio [–]", series, log: true};
    this.draw("convergence", "unbalanced ratio", {}, drawing);
  }
}
