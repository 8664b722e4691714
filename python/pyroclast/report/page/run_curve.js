// The curve of a run with its marks, and charts that follow its cursor.

class RunCurve {
  chart(id, options) {
    const chart = new Chart($(id), {...options, hover: (row) => this.hover(row)});
    this.charts.push(chart);
    return chart;
  }

  // Rows of the present stage, or all.
  within(i) {
    if (this.axes.stage === "") return true;
    const {first, last} = page.course.stages[this.axes.stage];
    return i >= first && i <= last;
  }

  makeAxes() {
    // what stays the same all through, such as the temperature of a cold test, makes no curve
    const there = page.course.quantities.filter(
      (q) => Object.values(this.axes).includes(q.id) || this.course.varies(q.id),
    );
    for (const [id, now] of [
      ["over", this.axes.over],
      ["of", this.axes.of],
    ]) {
      for (const q of there) $(id).append(new Option(q.label, q.id, false, q.id === now));
      $(id).onchange = () => {
        this.axes[id] = $(id).value;
        this.drawCurve();
      };
    }
    $("stage").append(new Option("all", ""));
    page.course.stages.forEach((s, k) => $("stage").append(new Option(`${s.number + 1}: ${s.kind}`, k)));
    $("stage").onchange = () => {
      this.axes.stage = $("stage").value;
      this.drawCurve();
    };
    this.drawCurve();
  }

  drawCurve() {
    const {over, of} = this.axes,
      x = this.course.quantity(over),
      y = this.course.quantity(of);
    if (!x || !y) return;
    const together = of === page.course.drawn[0] ? page.course.drawn : [of];
    const series = together.map((id, k) => ({
      name: together.length > 1 ? this.course.quantity(id).label : "",
      y: this.course.of(id),
      colour: k ? ["var(--tension)", "var(--good)", "var(--mixed)", "var(--faint)"][(k - 1) % 4] : "var(--curve)",
      width: k ? 1.2 : 2,
    }));
    if (this.parent && this.parent.has(x.column) && this.parent.has(y.column))
      series.push({
        name: `${page.parent.name}, of which this run is a fork`,
        x: this.parent.of(over),
        y: this.parent.of(of),
        colour: "var(--faint)",
        width: 1.2,
      });
    for (const table of page.course.references) {
      const upon = page.course.quantities.find((q) => q.reference === table.of && together.includes(q.id));
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
    this.curve.draw({
      x: this.course.of(over),
      label: x.label,
      yLabel: together.length > 1 ? y.label.replace(/^mean /, "") : y.label,
      series,
      marks: page.course.marks,
      stages: page.course.stages,
      from0: true,
      within: (i) => this.within(i),
    });
    this.curve.setCursor(this.row);
    this.curve.setPiece(this.piece);
  }

  // Where the curve is looked at: the place that was asked for, else that of the frame.
  get row() {
    if (this.asked) return this.asked.row;
    return this.frames.length ? this.frames[this.frame].row : null;
  }

  hover(row) {
    for (const chart of this.charts) chart.setCursor(row === null ? this.row : row);
  }

  // The first frame that was saved at a row or after it.
  frameAt(row) {
    const found = this.frames.findIndex((f) => f.row >= row);
    return found < 0 ? this.frames.length - 1 : found;
  }

  // The frame nearest to a row.
  showRow(row) {
    if (!this.body) return this.hover(row);
    let best = 0;
    this.frames.forEach((f, k) => {
      if (Math.abs(f.row - row) < Math.abs(this.frames[best].row - row)) best = k;
    });
    this.show(best);
  }

  makeMarks() {
    for (const mark of page.course.marks) {
      const x = this.course.quantity(page.course.over),
        values = mark.rows.map((row) => this.course.of(page.course.over)[row]);
      const button = made(
        "button",
        `${mark.label}${values.every(isFinite) ? ` (${withUnit(this.toldSpan(values), unitOf(x.label))})` : ""}`,
        $("marks"),
      );
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
    const mark = page.course.marks.find((m) => m.id === id);
    if (!mark) return;
    const row = mark.rows[mark.rows.length - 1],
      frame = this.body ? this.frameAt(row) : 0;
    if (!this.begun) this.clearPiece();
    if (mark.rows.length > 1 && !this.begun) this.brush(mark.rows, true);
    else if (!this.body) this.hover(row);
    else this.show(frame, this.newIn(frame), {row, name: "the mark", ...this.pointedAt(mark.id, row, frame)});
  }

  // What a mark points at in the specimen: the contact that broke first, or all damaged ones.
  pointedAt(id, row, frame) {
    if (id === "extent") return {isOfDamage: true};
    if (id !== "first") return {};
    const kinds = [];
    for (const mode in page.course.modes)
      for (const name of page.course.modes[mode])
        if (this.course.column(`${mode}_${name}_broken`)[row] > 0) kinds.push([mode, name.replaceAll("_", "–")]);
    const {about, arrays} = this.body,
      broken = (f, c, mode) => arrays[`damage_${mode}`].at(f, c) >= 1;
    const step = this.course.column("step")[row],
      first = [];
    for (let c = 0; c < this.body.contacts; c++)
      for (const [mode, name] of kinds)
        if (this.body.crackStep[c] <= step && about.interfaces[arrays.interface.values[c]] === name)
          if (broken(frame, c, mode) && !(frame && broken(frame - 1, c, mode))) first.push({c, mode, name});
    return {first};
  }

  // One value or two ends, in three digits, or four where three do not tell the ends apart.
  toldSpan(values) {
    const ends = [3, 4, 5].map((digits) => values.map((v) => number(v, digits)));
    const [from, to] = ends.find(([p, q]) => p !== q) || ends[0];
    return to === undefined ? from : `${from} to ${to}`;
  }

  // Contacts whose damage passed a half since the frame before.
  newIn(frame) {
    return frame ? this.body.crackedBetween(this.frames[frame - 1].step, this.frames[frame].step) : new Set();
  }
}
