// Curves as SVG: axes, lines, areas, marks, a cursor that other charts follow, and a piece that is brushed out.

import {entry} from "./elements.js";

const SVG = "http://www.w3.org/2000/svg";
export const DASHES = ["", "7 3", "2 2", "7 3 2 3"];

export function svg(name, attributes, parent, text) {
  const made = document.createElementNS(SVG, name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (text !== undefined) made.textContent = text;
  if (parent) parent.append(made);
  return made;
}

// Ticks at round numbers, about so many.
export function ticks(low, high, about) {
  const span = (high - low) / about;
  if (!(span > 0) || !isFinite(span)) return [low];
  const power = 10 ** Math.floor(Math.log10(span));
  const step = [1, 2, 5, 10].map((f) => f * power).find((f) => f >= span * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return found;
}

export const shown = (v) =>
  (v === 0
    ? "0"
    : Math.abs(v) >= 1e5 || Math.abs(v) < 1e-3
      ? v.toExponential(1).replace("e", "·10^")
      : String(+v.toPrecision(5))
  ).replace("-", "−");

const ONE_WAY = 0.02; // of the way on: so much may a curve go back that is brushed across

// A chart of series over rows. `drawing`: {x, label, yLabel, series: [{name, y, base, colour, width, dash, fill, of}],
// log, marks: [{id, label, rows}], stages: [{first, last, kind}], dots: [row], from0, legend}. `of` has own x values.
export class Chart {
  constructor(host, {height = 280, name = "", pick, hover, brush} = {}) {
    this.host = host;
    this.height = height;
    this.on = {pick, hover, brush};
    this.svg = svg("svg", {role: "img", "aria-label": name, class: "chart"}, host);
    this.legend = host.appendChild(document.createElement("div"));
    this.legend.className = "key";
    this.drawing = null;
    this.cursor = this.piece = null;
    new ResizeObserver(() => this.redraw()).observe(host);
    this.listen();
  }

  draw(drawing) {
    this.drawing = drawing;
    this.redraw();
  }

  redraw() {
    const d = this.drawing,
      width = this.host.clientWidth;
    if (!d || !width) return;
    const box = {left: 56, right: 12, top: 12, bottom: 40};
    Object.assign(this, {width, box});
    this.svg.replaceChildren();
    this.svg.setAttribute("viewBox", `0 0 ${width} ${this.height}`);
    this.svg.setAttribute("height", this.height);
    this.scale(d);
    this.axes(d);
    for (const s of [...d.series].sort((p, q) => Boolean(q.x) - Boolean(p.x))) this.series(s, d); // others behind
    this.overlay = svg("g", {}, this.svg);
    for (const mark of d.marks || []) this.mark(mark, d);
    this.moving = svg("g", {"pointer-events": "none"}, this.svg);
    this.legend.replaceChildren(...(d.legend === false ? [] : d.series.filter((s) => s.name).map((s) => entry(s))));
    this.move();
  }

  scale(d) {
    let x0 = Infinity,
      x1 = -Infinity,
      y0 = Infinity,
      y1 = -Infinity;
    for (const s of d.series) {
      const xs = s.x || d.x;
      for (let i = 0; i < xs.length; i++) {
        const y = s.y[i];
        if (!isFinite(xs[i]) || !isFinite(y) || (d.log && y <= 0)) continue;
        if (d.within && !s.x && !d.within(i)) continue;
        if (xs[i] < x0) x0 = xs[i];
        if (xs[i] > x1) x1 = xs[i];
        if (y < y0) y0 = y;
        if (y > y1) y1 = y;
        if (s.base && s.base[i] < y0) y0 = s.base[i];
      }
    }
    if (x0 > x1) [x0, x1, y0, y1] = [0, 1, 0, 1];
    if (x0 === x1) x1 = x0 + (Math.abs(x0) || 1);
    const level = d.log ? Math.log10 : (v) => v;
    if (d.from0 && !d.log) [y0, y1] = [Math.min(y0, 0), Math.max(y1, 0)];
    let [a, b] = [level(y0), level(y1)];
    if (a === b) [a, b] = [a - (Math.abs(a) || 1) * 0.1, b + (Math.abs(b) || 1) * 0.1];
    const air = 0.06 * (b - a);
    b += air;
    if (!(d.from0 && y0 === 0)) a -= air;
    const {left, right, top, bottom} = this.box;
    const [w, h] = [this.width - left - right, this.height - top - bottom];
    Object.assign(this, {
      range: {x0, x1, a, b},
      X: (v) => left + ((v - x0) / (x1 - x0)) * w,
      Y: (v) => top + h - ((level(v) - a) / (b - a)) * h,
    });
  }

  axes(d) {
    const {left, right, top, bottom} = this.box,
      {x0, x1, a, b} = this.range;
    const low = this.height - bottom;
    for (const stage of d.stages || []) {
      const [from, to] = [this.X(d.x[stage.first]), this.X(d.x[stage.last])].sort((p, q) => p - q);
      if (isFinite(to - from) && to - from > 2)
        svg("rect", {x: from, y: top, width: to - from, height: low - top, class: "band"}, this.svg).append(
          svg("title", {}, null, `stage ${stage.number + 1}: ${stage.kind}`),
        );
    }
    const powers = ticks(Math.ceil(a), Math.floor(b), 5).filter(Number.isInteger);
    for (const v of d.log ? powers.map((k) => 10 ** k) : ticks(a, b, 5)) {
      const y = this.Y(v);
      svg("line", {x1: left, x2: this.width - right, y1: y, y2: y, class: "grid"}, this.svg);
      svg(
        "text",
        {x: left - 6, y: y + 4, "text-anchor": "end"},
        this.svg,
        d.log ? `10^${Math.round(Math.log10(v))}` : shown(v),
      );
    }
    for (const v of ticks(x0, x1, this.width < 420 ? 4 : 7)) {
      svg("line", {x1: this.X(v), x2: this.X(v), y1: low, y2: low + 4, class: "axis"}, this.svg);
      svg("text", {x: this.X(v), y: low + 16, "text-anchor": "middle"}, this.svg, shown(v));
    }
    svg("line", {x1: left, x2: this.width - right, y1: low, y2: low, class: "axis"}, this.svg);
    svg("text", {x: (left + this.width - right) / 2, y: this.height - 5, "text-anchor": "middle"}, this.svg, d.label);
    if (!d.yLabel) return;
    const middle = (top + low) / 2;
    const label = svg(
      "text",
      {x: 13, y: middle, "text-anchor": "middle", transform: `rotate(-90 13 ${middle})`},
      this.svg,
      d.yLabel,
    );
    const long = label.getComputedTextLength ? label.getComputedTextLength() : 0;
    if (long > low - top + 30) {
      label.setAttribute("textLength", low - top + 20);
      label.setAttribute("lengthAdjust", "spacingAndGlyphs");
    }
  }

  series(s, d) {
    const xs = s.x || d.x;
    let path = "",
      isOn = false;
    const there = (i) =>
      isFinite(xs[i]) && isFinite(s.y[i]) && (!d.log || s.y[i] > 0) && (s.x || !d.within || d.within(i));
    const rows = [];
    for (let i = 0; i < xs.length; i++) {
      if (!there(i)) {
        isOn = false;
        continue;
      }
      rows.push(i);
      path += `${isOn ? "L" : "M"}${this.X(xs[i]).toFixed(1)} ${this.Y(s.y[i]).toFixed(1)}`;
      isOn = true;
    }
    if (s.base && rows.length) {
      for (const i of rows.slice().reverse()) path += `L${this.X(xs[i]).toFixed(1)} ${this.Y(s.base[i]).toFixed(1)}`;
      path += "Z";
    }
    const line = svg("path", {d: path || "M0 0", "stroke-dasharray": s.dash || "none"}, this.svg);
    line.style.fill = s.base ? s.colour : "none";
    line.style.stroke = s.base ? "none" : s.colour;
    line.style.strokeWidth = s.width || 1.6;
    line.style.opacity = s.opacity || (s.base ? 0.85 : 1);
  }

  mark(mark, d) {
    const row = mark.rows[mark.rows.length - 1],
      [x, y] = [d.x[row], d.series[0].y[row]];
    if (!isFinite(x) || !isFinite(y)) return;
    const group = svg("g", {class: "mark", "data-mark": mark.id}, this.overlay);
    svg("circle", {cx: this.X(x), cy: this.Y(y), r: 5}, group);
    svg("title", {}, group, mark.label);
  }

  // Whether rows follow one another along x, but for little steps back.
  get goesOneWay() {
    const d = this.drawing;
    let before = NaN,
      on = 0,
      back = 0;
    for (let i = 0; i < d.x.length; i++) {
      if (!isFinite(d.x[i]) || (d.within && !d.within(i))) continue;
      if (d.x[i] > before) on += d.x[i] - before;
      if (d.x[i] < before) back += before - d.x[i];
      before = d.x[i];
    }
    return Math.min(on, back) <= ONE_WAY * Math.max(on, back);
  }

  // First and last row from one place on the screen to another: what lies between them across; where a curve goes back
  // and forth across, between the points nearest to both.
  rowsBetween(from, to) {
    const d = this.drawing,
      ends = (isAcross) => {
        const rows = [this.nearest(...from, isAcross), this.nearest(...to, isAcross)];
        return [Math.min(...rows), Math.max(...rows)];
      };
    if (!this.goesOneWay) return ends(false);
    const [low, high] = [from[0], to[0]].sort((p, q) => p - q);
    let first = -1,
      last = -1;
    for (let i = 0; i < d.x.length; i++) {
      const x = this.X(d.x[i]);
      if (!(x >= low && x <= high) || (d.within && !d.within(i))) continue;
      if (first < 0) first = i;
      last = i;
    }
    return first < 0 ? ends(true) : [first, last];
  }

  // The row whose point of the first series is nearest to a place on the screen, or nearest across alone.
  nearest(px, py, isAcross = false) {
    const d = this.drawing,
      y = d.series[0].y;
    let best = -1,
      least = Infinity;
    for (let i = 0; i < d.x.length; i++) {
      if (!isFinite(d.x[i]) || (d.within && !d.within(i))) continue;
      const across = this.X(d.x[i]) - px,
        up = !isAcross && isFinite(y[i]) ? 0.4 * (this.Y(y[i]) - py) : 0;
      const distance = across * across + up * up;
      if (distance < least) [best, least] = [i, distance];
    }
    return best;
  }

  setCursor(row) {
    this.cursor = row;
    this.move();
  }
  setPiece(piece) {
    this.piece = piece;
    this.move();
  }

  move() {
    const d = this.drawing;
    if (!this.moving || !d) return;
    this.moving.replaceChildren();
    const {top, bottom} = this.box,
      low = this.height - bottom;
    if (this.piece && !d.series[0].x) {
      const [a, b] = this.piece;
      const line = {x: d.x, y: d.series[0].y};
      const cut = svg("path", {class: "piece"}, this.moving);
      let path = "";
      for (let i = a; i <= b; i++)
        if (isFinite(line.x[i]) && isFinite(line.y[i]))
          path += `${path ? "L" : "M"}${this.X(line.x[i])} ${this.Y(line.y[i])}`;
      cut.setAttribute("d", path || "M0 0");
      const [from, to] = [this.X(d.x[a]), this.X(d.x[b])].sort((p, q) => p - q);
      if (isFinite(to - from))
        svg(
          "rect",
          {x: from, y: top, width: Math.max(1, to - from), height: low - top, class: "brushed"},
          this.moving,
        );
    }
    if (this.cursor === null || !isFinite(d.x[this.cursor])) return;
    const x = this.X(d.x[this.cursor]);
    svg("line", {x1: x, x2: x, y1: top, y2: low, class: "cursor"}, this.moving);
    for (const s of d.series) {
      const y = s.y[this.cursor];
      if (!s.x && !s.base && isFinite(y) && (!d.log || y > 0))
        svg("circle", {cx: x, cy: this.Y(y), r: 4, class: "dot"}, this.moving);
    }
  }

  listen() {
    let start = null;
    const at = (e) => {
      const frame = this.svg.getBoundingClientRect();
      return [e.clientX - frame.left, e.clientY - frame.top];
    };
    this.svg.addEventListener("pointerdown", (e) => {
      if (!this.drawing || e.button) return;
      start = at(e);
      if (this.on.brush) this.svg.setPointerCapture(e.pointerId);
    });
    this.svg.addEventListener("pointermove", (e) => {
      if (!this.drawing) return;
      const here = at(e),
        row = this.nearest(...here);
      if (row < 0) return;
      if (start && this.on.brush && Math.abs(here[0] - start[0]) > 5) {
        this.on.brush(this.rowsBetween(start, here), false);
      } else if (this.on.hover && e.pointerType === "mouse") this.on.hover(row);
    });
    this.svg.addEventListener("pointerup", (e) => {
      if (!start) return;
      const here = at(e),
        from = start;
      start = null;
      const row = this.nearest(...here);
      if (row < 0) return;
      if (this.on.brush && Math.abs(here[0] - from[0]) > 5) {
        this.on.brush(this.rowsBetween(from, here), true);
      } else if (this.on.pick) this.on.pick(row);
    });
    this.svg.addEventListener("pointercancel", () => {
      start = null;
    });
    this.svg.addEventListener("pointerleave", () => {
      if (this.on.hover) this.on.hover(null);
    });
  }
}

// The charts of a run: their cursors and pieces follow the scene, and one another.
export class Charts {
  constructor(scene) {
    Object.assign(this, {scene, all: []});
    scene.on("frame", () => this.hover(null));
    scene.on("piece", () => this.all.forEach((chart) => chart.setPiece(scene.brushed)));
  }

  // Makes a chart. picks: its rows are those of the history, and a click shows a frame; brushes: a drag takes a piece.
  add(host, {picks = true, brushes = false, ...options}) {
    const {scene} = this,
      hover = (row) => this.hover(row),
      pick = (row) => (scene.body ? scene.showRow(row) : this.hover(row)),
      brush = brushes ? (piece, isOver) => scene.drag(piece, isOver) : undefined,
      chart = new Chart(host, {...options, ...(picks ? {hover, pick, brush} : {})});
    this.all.push(chart);
    chart.setCursor(scene.row);
    return chart;
  }

  // Puts all cursors at a row; null: where the curve is looked at.
  hover(row) {
    for (const chart of this.all) chart.setCursor(row === null ? this.scene.row : row);
  }
}
