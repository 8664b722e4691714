// The curve of a run with its marks.

import {axesMenus} from "./course.js";
import {$, made, menu} from "./elements.js";

export class CurvePane {
  constructor(scene, charts) {
    Object.assign(this, {scene, charts, stage: ""});
    this.chart = charts.add($("curve"), {height: 320, name: "curve", brushes: true});
    const {course, axes} = scene,
      {quantities, stages} = course.about,
      redraw = () => this.draw();
    // what stays the same all through, such as the temperature of a cold test, makes no curve
    axesMenus(axes, quantities.filter((q) => Object.values(axes).includes(q.id) || course.varies(q.id)), redraw);
    const numbered = stages.map((s, k) => [k, `${s.number + 1}: ${s.kind}`]);
    menu("stage", [["", "all"], ...numbered], "", (stage) => {
      this.stage = stage;
      this.draw();
    });
    this.draw();
    this.makeMarks();
  }

  // Whether a row belongs to the present stage; all rows do where none was chosen.
  isWithin(i) {
    const {first, last} = this.scene.course.about.stages[this.stage] || {first: 0, last: Infinity};
    return i >= first && i <= last;
  }

  draw() {
    const {course, parent, axes} = this.scene,
      {about} = course,
      x = course.quantity(axes.over),
      y = course.quantity(axes.of);
    if (!x || !y) return;
    const together = axes.of === about.drawn[0] ? about.drawn : [axes.of];
    const series = together.map((id, k) => ({
      name: together.length > 1 ? course.quantity(id).label : "",
      y: course.of(id),
      colour: k ? ["var(--tension)", "var(--good)", "var(--mixed)", "var(--faint)"][(k - 1) % 4] : "var(--curve)",
      width: k ? 1.2 : 2,
    }));
    if (parent && parent.has(x.column) && parent.has(y.column))
      series.push({
        name: `${this.scene.parentName}, of which this run is a fork`,
        x: parent.of(axes.over),
        y: parent.of(axes.of),
        colour: "var(--faint)",
        width: 1.2,
      });
    for (const table of about.references) {
      const upon = about.quantities.find((q) => q.reference === table.of && together.includes(q.id));
      if (table.over !== x.reference || !upon) continue;
      const scaled = (values, q) => values.map((v) => v * Math.abs(q.factor));
      const isRange = table.low.some((v, i) => v !== table.high[i]);
      series.push({
        name: table.name,
        x: scaled(table.x, x),
        y: scaled(table.high, upon),
        colour: "var(--warn-line)",
        dash: isRange ? "" : "6 3",
        ...(isRange ? {base: scaled(table.low, upon), opacity: 0.3} : {}),
      });
    }
    this.chart.draw({
      ...course.over(axes.over),
      yLabel: together.length > 1 ? y.label.replace(/^mean /, "") : y.label,
      series,
      marks: about.marks,
      stages: about.stages,
      from0: true,
      within: (i) => this.isWithin(i),
    });
  }

  makeMarks() {
    const {scene} = this;
    for (const mark of scene.course.about.marks) {
      const {label, values} = scene.at(...mark.rows),
        place = values.every(isFinite) ? ` (${scene.toldSpan(values, label)})` : "",
        button = made("button", mark.label + place, $("marks"));
      if (mark.rows.length > 1) button.title = "what broke in this piece of the curve";
      button.type = "button";
      button.dataset.mark = mark.id;
    }
    document.addEventListener("click", (e) => {
      const place = e.target.closest && e.target.closest("[data-mark]");
      if (place) this.showMark(place.dataset.mark);
    });
  }

  // Shows the frame of a mark; a fall becomes the piece that is looked at, unless another piece has begun.
  showMark(id) {
    const {scene} = this,
      mark = scene.course.about.marks.find((m) => m.id === id);
    if (!mark) return;
    const row = mark.rows[mark.rows.length - 1],
      frame = scene.frameAt(row);
    if (!scene.begun) scene.dropPiece();
    if (mark.rows.length > 1 && !scene.begun) scene.brush(mark.rows, true);
    else if (!scene.body) this.charts.hover(row);
    else scene.show(frame, this.newIn(frame), {row, name: "the mark", ...this.pointedAt(mark.id, row, frame)});
  }

  // What a mark points at in the specimen: the contact that broke first, or all damaged ones.
  pointedAt(id, row, frame) {
    if (id === "extent") return {isOfDamage: true};
    if (id !== "first") return {};
    const {course, body} = this.scene,
      {about, arrays} = body,
      kinds = [];
    for (const {mode, interface: name, broken: count} of course.about.cracks)
      if (course.column(count)[row] > 0) kinds.push([mode, name.replaceAll("_", "–")]);
    const broken = (f, c, mode) => arrays[`damage_${mode}`].at(f, c) >= 1,
      step = course.column("step")[row],
      first = [];
    for (let c = 0; c < body.contacts; c++)
      for (const [mode, name] of kinds)
        if (body.crackStep[c] <= step && about.interfaces[arrays.interface.values[c]] === name)
          if (broken(frame, c, mode) && !(frame && broken(frame - 1, c, mode))) first.push({c, mode, name});
    return {first};
  }

  // Contacts whose damage passed a half since the frame before.
  newIn(frame) {
    const {body, frames} = this.scene;
    return frame ? body.crackedBetween(frames[frame - 1].step, frames[frame].step) : new Set();
  }
}
