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
    const there = page.course.quantities.filter((q) => this.course.of(q.id).some(isFinite));
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

  get row() {
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
        value = this.course.of(page.course.over)[mark.row];
      const button = made(
        "button",
        `${mark.label}${isFinite(value) ? ` (${number(value)} ${unitOf(x.label)})` : ""}`,
        $("marks"),
      );
      button.type = "button";
      button.dataset.mark = mark.id;
    }
    document.addEventListener("click", (e) => {
      const place = e.target.closest && e.target.closest("[data-mark]");
      if (place) this.showMark(place.dataset.mark);
    });
  }

  showMark(id) {
    const mark = page.course.marks.find((m) => m.id === id);
    if (!mark) return;
    if (!this.body) return this.hover(mark.row);
    const frame = this.frameAt(mark.row);
    this.clearPiece();
    this.show(frame, this.newIn(frame));
  }

  // Contacts whose damage passed a half since the frame before.
  newIn(frame) {
    return frame ? this.body.crackedBetween(this.frames[frame - 1].step, this.frames[frame].step) : new Set();
  }
}
