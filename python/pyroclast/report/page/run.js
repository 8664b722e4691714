// The page of a run: specimen and curve, which move together, and the tabs below.

class RunPage {
  constructor(arrays) {
    this.course = new Course(page.course, arrays.history);
    this.parent = page.parent && new Course(page.course, arrays.parent, page.parent.columns);
    this.frames = page.frames;
    this.body = page.body && bodyOf(page.body, arrays, page.frames);
    this.frame = Math.max(0, this.frames.length - 1);
    this.piece = null;
    this.pins = [];
    this.charts = [];
    this.axes = {over: page.course.over, of: page.course.drawn[0] || "", stage: ""};
    this.curve = this.chart("curve", {
      height: 320,
      name: "curve",
      pick: (row) => this.showRow(row),
      brush: (piece, isOver) => this.brush(piece, isOver),
    });
    if (this.body) this.makeSpecimen();
    this.makeAxes();
    this.makeMarks();
    this.tabs();
    this.keys();
    this.downloads();
    if (this.body) this.show(this.frame);
  }

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

  // ---- the curve

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

  // ---- marks, and the frame of one with its new cracks

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
    const lit = new Set();
    if (this.body.modes.length)
      this.body.brokeIn.forEach((f, c) => {
        if (f === frame && f > 0) lit.add(c);
      });
    return lit;
  }

  // ---- a piece of the curve: what broke in it

  brush(piece, isOver) {
    this.piece = piece;
    for (const chart of this.charts) chart.setPiece(piece);
    if (!isOver) return;
    if (this.body) {
      const [from, to] = [this.frameBefore(piece[0]), this.frameAt(piece[1])];
      const lit = new Set();
      if (this.body.modes.length)
        this.body.brokeIn.forEach((f, c) => {
          if (f > from && f <= to) lit.add(c);
        });
      this.show(to, lit);
    }
    this.tellPiece();
  }

  frameBefore(row) {
    let found = 0;
    this.frames.forEach((f, k) => {
      if (f.row <= row) found = k;
    });
    return found;
  }

  clearPiece() {
    this.piece = null;
    for (const chart of this.charts) chart.setPiece(null);
    $("piece").hidden = true;
  }

  tellPiece() {
    const {course, piece} = this,
      host = $("piece"),
      {over, of} = this.axes;
    host.replaceChildren();
    host.hidden = false;
    const [x, y] = [course.of(over), course.of(of)],
      label = (id) => course.quantity(id).label;
    made("h3", "This piece of the curve", host);
    const ends = (values) => `${number(values[piece[0]], 4)} to ${number(values[piece[1]], 4)}`;
    const change = number(y[piece[1]] - y[piece[0]], 3);
    const text = `${label(over)}: ${ends(x)}. ${label(of)}: ${ends(y)}, a change of ${change}.`;
    made("p", text, host);
    this.tellBroken(host);
    this.tellEnergies(host);
    this.tellLosses(host);
    const close = made("button", "drop this piece (Esc)", host);
    close.type = "button";
    close.onclick = () => {
      this.clearPiece();
      if (this.body) this.show(this.frame);
    };
  }

  tellBroken(host) {
    const rows = [],
      {modes, extent} = page.course,
      unit = extent === "length_m" ? "mm" : "cm²",
      factor = unit === "mm" ? 1e3 : 1e4;
    for (const mode in modes)
      for (const name of modes[mode]) {
        const of = (what) => this.course.change(`${mode}_${name}_${what}`, this.piece);
        rows.push([mode, name.replaceAll("_", "–"), of("damaged"), of("broken"), number(factor * of(extent))]);
      }
    if (rows.length) table(host, ["mode", "interface", "first damaged", "broken", `cracks [${unit}]`], rows);
  }

  tellEnergies(host) {
    const there = page.course.energy_out.map((e) => [e.label, this.course.change(e.column, this.piece)]);
    const work = page.course.energy_in.reduce((sum, name) => sum + this.course.change(name, this.piece), 0);
    const rows = there.filter((e) => Math.abs(e[1]) > 1e-12).sort((p, q) => Math.abs(q[1]) - Math.abs(p[1]));
    if (!rows.length) return;
    made("p", `Put in: ${number(work)} J. It went to (negative: it came from):`, host);
    table(
      host,
      ["energy", "J"],
      rows.map(([label, value]) => [label, number(value)]),
    );
  }

  // Energy that contacts lost between the frames around the piece, by interface.
  tellLosses(host) {
    const losses = this.body ? Object.keys(this.body.arrays).filter((name) => name.startsWith("lost_")) : [];
    if (!losses.length) return;
    const [from, to] = [this.frameBefore(this.piece[0]), this.frameAt(this.piece[1])],
      {interfaces} = this.body.about;
    const lit = this.specimen.lit || new Set(),
      kinds = this.body.arrays.interface.values;
    const sums = [...interfaces, `of the ${lit.size} that stand out`].map(() => losses.map(() => 0));
    for (let c = 0; c < this.body.contacts; c++)
      losses.forEach((name, k) => {
        const lost = this.body.arrays[name].at(to, c) - this.body.arrays[name].at(from, c);
        sums[kinds[c]][k] += lost;
        if (lit.has(c)) sums[interfaces.length][k] += lost;
      });
    const rows = sums.map((values, k) => [
      interfaces[k] || `the ${lit.size} that stand out`,
      ...values.map((v) => number(v)),
    ]);
    made("p", `Contacts lost from frame ${from} to frame ${to}, in J:`, host);
    table(
      host,
      ["interface", ...losses.map((name) => name.replace("lost_", ""))],
      rows.filter((row, k) => k === interfaces.length || sums[k].some((v) => v > 0)),
    );
  }

  // ---- the specimen

  makeSpecimen() {
    const s = (this.specimen = new Specimen($("body"), this.body));
    for (const [id, label] of this.body.fields) $("colour").append(new Option(label, id));
    s.colour = this.body.arrays.temperature ? "temperature" : "material";
    $("colour").value = s.colour;
    $("colour").onchange = () => {
      s.colour = $("colour").value;
      this.redraw();
    };
    const least = this.body.moves ? [1, 2, 5, 10, 20, 50, 100] : [1];
    s.magnification = this.body.moves ? this.fitting(least) : 1;
    $("magnification").parentElement.hidden = !this.body.moves;
    for (const m of least) $("magnification").append(new Option(m, m, false, m === s.magnification));
    $("magnification").onchange = () => {
      s.magnification = +$("magnification").value;
      this.redraw();
    };
    if ($("cracks"))
      $("cracks").onchange = () => {
        s.cracks = $("cracks").value;
        this.redraw();
      };
    if (this.body.about.solid) this.makeViews();
    $("at").max = this.frames.length - 1;
    $("at").oninput = () => this.show(+$("at").value);
    $("play").onclick = () => this.play();
    $("line").onclick = () => this.toggleLine();
    this.pointer();
    $("unpin").onclick = () => {
      this.pins = [];
      this.tellPins();
    };
    this.fit = () => {
      const width = $("body").parentElement.clientWidth;
      if (width && width !== this.width) {
        this.width = width;
        s.size(width, Math.max(320, 0.78 * innerHeight));
        this.redraw();
      }
    };
    new ResizeObserver(this.fit).observe($("body").parentElement);
    s.size($("body").parentElement.clientWidth || 400, Math.max(320, 0.78 * innerHeight));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    addEventListener("beforeprint", () => this.fourFrames());
  }

  // A solid is seen as a plane through it, or from outside.
  makeViews() {
    const look = () => {
      const [axis, side] = $("view").value.split(" ");
      this.body.look(axis, $("place").value / 100, +side);
      $("place").disabled = side !== "0";
      this.width = null;
      this.fit();
      $("place_now").textContent = side === "0" ? `${axis} = ${number(1e3 * this.body.offset)} mm` : "";
    };
    $("view").onchange = $("place").oninput = look;
    $("place_now").textContent = `z = ${number(1e3 * this.body.offset)} mm`;
  }

  // The largest magnification that moves blocks by at most a tenth of the body at the end.
  fitting(choices) {
    const last = this.frames.length - 1,
      values = Array.from(this.body.values("displacement", last)).sort((p, q) => p - q);
    const most = 1e-3 * values[Math.floor(0.97 * (values.length - 1))],
      size = this.body.box.x1 - this.body.box.x0;
    return choices.filter((m) => m * most < 0.06 * size && m <= 20).pop() || 1;
  }

  show(frame, lit = null) {
    this.frame = Math.max(0, Math.min(this.frames.length - 1, frame));
    this.specimen.frame = this.frame;
    this.specimen.lit = lit || (this.piece ? this.specimen.lit : null);
    $("at").value = this.frame;
    const now = this.told(this.frame);
    $("now").textContent = lit && lit.size ? `${now}; ${lit.size} contacts stand out` : now;
    $("body").setAttribute("aria-label", `specimen, ${now}`);
    $("at").setAttribute("aria-valuetext", now);
    this.hover(null);
    this.redraw();
  }

  told(frame) {
    const f = this.frames[frame],
      said = [];
    if (isFinite(f.strain) && f.strain !== null) said.push(`strain ${number(1e3 * f.strain, 3)}·10⁻³`);
    if (f.stress_MPa !== null && isFinite(f.stress_MPa)) said.push(`stress ${number(f.stress_MPa, 3)} MPa`);
    const y = this.course.quantity(page.course.drawn[0]);
    if (f.strain === null && y)
      said.push(`${y.label.replace(/ \[.*/, "")} ${number(this.course.of(y.id)[f.row])} ${unitOf(y.label)}`);
    if (f.temperature > 25 && !(f.strain === null && page.course.drawn[0] === "temperature"))
      said.push(`${number(f.temperature, 3)} °C`);
    if (f.heating_time > 0) said.push(`${number(f.heating_time / 60, 3)} min`);
    return `frame ${frame} of ${this.frames.length - 1}: ${said.join(", ")}`;
  }

  redraw() {
    this.specimen.draw();
    this.tellKey();
    this.tellPins();
    if (this.specimen.across) this.tellAcross();
  }

  tellKey() {
    const s = this.specimen,
      key = $("key");
    key.replaceChildren();
    if (s.colour === "material") {
      const shownMaterials = new Set(this.body.arrays.material.values);
      this.body.about.materials.forEach(({name}, k) => {
        if (shownMaterials.has(k)) key.append(entry({name, colour: css(s.theme().phases[k]), base: true}));
      });
    } else {
      const {low, high, isTwoSided} = this.body.range(s.colour),
        stops = isTwoSided ? TWO_SIDED : ONE_SIDED;
      const scale = made("span", null, key, "scale");
      scale.append(number(low));
      made("i", null, scale).style.background = `linear-gradient(90deg, ${stops.map(css).join(", ")})`;
      scale.append(`${number(high)} ${unitOf(this.body.fields.find((f) => f[0] === s.colour)[1])}`);
      if (s.colour.startsWith("stress")) key.append("tension positive");
    }
    if (!this.body.modes.length || s.cracks === "none") return;
    if (s.cracks === "mode")
      for (const mode of this.body.modes) {
        key.append(entry({name: `${mode}, broken`, colour: `var(--${mode})`}));
        key.append(entry({name: `${mode}, damaged by more than half`, colour: `var(--${mode}-tint)`}));
      }
    if (s.cracks === "opening")
      [0, 15, 75].forEach((um, k) =>
        key.append(
          entry({name: `opening from ${um} µm`, colour: css(colourAt(ONE_SIDED, ([0, 2, 4][k] + 1.5) / 7))}),
        ),
      );
    if (s.cracks === "age")
      key.append(
        entry({name: "oldest cracks", colour: css(colourAt(ONE_SIDED, 0.95))}),
        entry({name: "youngest", colour: css(colourAt(ONE_SIDED, 0.15))}),
      );
    if (s.lit && s.lit.size)
      key.append(
        entry({
          name: this.piece ? "passed a damage of a half in the piece" : "new in this frame",
          colour: "var(--lit)",
        }),
      );
  }

  play() {
    const isOn = $("play").textContent === "pause";
    $("play").textContent = isOn ? "play" : "pause";
    clearInterval(this.timer);
    if (isOn) return;
    if (this.frame === this.frames.length - 1) this.show(0);
    this.timer = setInterval(() => {
      if (this.frame === this.frames.length - 1) this.play();
      else this.show(this.frame + 1);
    }, 80);
  }

  fourFrames() {
    const host = $("four"),
      wanted = new Set(page.course.marks.map((m) => this.frameAt(m.row)));
    const last = this.frames.length - 1;
    for (const share of [1, 0.5, 0.75, 0.25, 0]) if (wanted.size < 4) wanted.add(Math.round(share * last));
    host.replaceChildren();
    for (const frame of [...wanted].sort((p, q) => p - q).slice(-4)) {
      const figure = made("figure", null, host),
        canvas = made("canvas", null, figure);
      made("figcaption", this.told(frame), figure);
      const one = new Specimen(canvas, this.body);
      Object.assign(one, {
        frame,
        colour: this.specimen.colour,
        cracks: this.specimen.cracks,
        magnification: this.specimen.magnification,
      });
      one.size(340, 600);
      canvas.style.height = "auto";
      one.draw();
    }
    this.specimen.draw();
  }

  // ---- probes

  pointer() {
    const canvas = $("body");
    const at = (e) => {
      const box = canvas.getBoundingClientRect(),
        k = this.specimen.W / box.width;
      return [(e.clientX - box.left) * k, (e.clientY - box.top) * k];
    };
    let from = null;
    canvas.addEventListener("pointerdown", (e) => {
      from = at(e);
      canvas.setPointerCapture(e.pointerId);
      if (this.specimen.across) e.preventDefault();
    });
    canvas.addEventListener("pointermove", (e) => {
      const here = at(e),
        s = this.specimen;
      if (from && s.across) {
        s.across = [from[0] / s.W, from[1] / s.H, here[0] / s.W, here[1] / s.H];
        this.redraw();
      } else this.point(...here);
    });
    canvas.addEventListener("pointerup", (e) => {
      const here = at(e),
        s = this.specimen;
      const moved = from && Math.hypot(here[0] - from[0], here[1] - from[1]) > 6 * s.ratio;
      from = null;
      if (!moved) this.pin(...here);
    });
    canvas.addEventListener("pointerleave", () => {
      $("tip").hidden = true;
    });
  }

  found(x, y) {
    const s = this.specimen;
    return this.body.at(x, y, s.W, s.H, this.frame, 9 * s.ratio);
  }

  point(x, y) {
    const s = this.specimen,
      tip = $("tip"),
      {block, crack} = this.found(x, y);
    tip.hidden = block < 0 && crack < 0;
    if (tip.hidden) return;
    const said = [];
    if (crack >= 0)
      said.push(
        `crack ${this.body.contactNumber(crack)}, ${this.interfaceOf(crack)}`,
        ...this.crackFacts(crack).map(([n, v]) => `${n} ${v}`),
      );
    if (block >= 0)
      said.push(`block ${block}, ${this.materialOf(block)}`, ...this.blockFacts(block).map(([n, v]) => `${n} ${v}`));
    tip.textContent = said.join("\n");
    const left = x / s.ratio,
      top = y / s.ratio,
      width = canvasWidth(tip);
    tip.style.left = `${Math.max(0, Math.min(left + 14, s.W / s.ratio - width))}px`;
    tip.style.top = `${top + 16}px`;
  }

  interfaceOf(c) {
    return this.body.about.interfaces[this.body.arrays.interface.values[c]];
  }
  materialOf(b) {
    return this.body.about.materials[this.body.arrays.material.values[b]].name;
  }

  blockFacts(b, frame = this.frame) {
    return this.body.fields
      .filter(([id]) => id !== "material")
      .map(([id, label]) => [label, number(this.body.values(id, frame)[b])]);
  }

  crackFacts(c, frame = this.frame) {
    const a = this.body.arrays,
      facts = this.body.modes.map((m) => [`damage in ${m}`, number(a[`damage_${m}`].at(frame, c), 2)]);
    facts.push(["opening [µm]", number(1e6 * a.opening.at(frame, c))]);
    const first = this.body.brokeIn[c];
    if (first >= 0) facts.push(["passed a half by frame", String(first)]);
    return facts;
  }

  pin(x, y) {
    const {block, crack} = this.found(x, y);
    const pin = crack >= 0 ? {kind: "crack", id: crack} : block >= 0 ? {kind: "block", id: block} : null;
    if (!pin || this.pins.some((p) => p.kind === pin.kind && p.id === pin.id)) return;
    this.pins.push(pin);
    this.tellPins();
  }

  nameOf(pin) {
    return `${pin.kind} ${pin.kind === "crack" ? this.body.contactNumber(pin.id) : pin.id}`;
  }
  factsOf(pin, frame) {
    return pin.kind === "crack" ? this.crackFacts(pin.id, frame) : this.blockFacts(pin.id, frame);
  }

  tellPins() {
    $("pinned").hidden = !this.pins.length;
    if (!this.pins.length) return;
    const names = [...new Set(this.pins.flatMap((p) => this.factsOf(p, this.frame).map(([n]) => n)))];
    const head = made("tr", null, null);
    const axes = this.body.about.solid ? ["x", "y", "z"] : ["x", "y"];
    for (const name of ["probe", "of", ...axes.map((axis) => `${axis} [mm]`), ...names, ""]) made("th", name, head);
    $("pinned_head").replaceChildren(head);
    $("pinned_rows").replaceChildren(
      ...this.pins.map((pin, k) => {
        const row = document.createElement("tr"),
          facts = new Map(this.factsOf(pin, this.frame));
        const of = pin.kind === "crack" ? this.interfaceOf(pin.id) : this.materialOf(pin.id);
        const place = pin.kind === "crack" ? this.body.whereContact(pin.id) : this.body.whereBlock(pin.id);
        for (const text of [
          this.nameOf(pin),
          of,
          ...place.map((v) => number(1e3 * v)),
          ...names.map((n) => facts.get(n) || ""),
        ])
          made("td", text, row);
        const remove = made("button", "×", made("td", null, row));
        remove.type = "button";
        remove.setAttribute("aria-label", `remove ${this.nameOf(pin)}`);
        remove.onclick = () => {
          this.pins.splice(k, 1);
          this.tellPins();
        };
        return row;
      }),
    );
  }

  // ---- values along a line

  toggleLine() {
    const s = this.specimen;
    s.across = s.across ? null : [0.02, 0.5, 0.98, 0.5];
    $("line").setAttribute("aria-pressed", String(Boolean(s.across)));
    if (s.across && s.colour === "material" && this.body.fields.length > 1)
      $("colour").value = s.colour = this.body.fields[1][0];
    $("along").hidden = !s.across;
    this.redraw();
  }

  tellAcross() {
    const s = this.specimen,
      host = $("along"),
      field = s.colour;
    if (!this.along) {
      made("h3", "Along the line", host);
      this.along = new Chart(made("div", null, host), {height: 260, name: "values along the line"});
    }
    const samples = s.samples(),
      label = this.body.fields.find((f) => f[0] === field)[1];
    if (field === "material" || samples.length < 2) return;
    const x = samples.map((p) => 1e3 * (p.at - samples[0].at)),
      last = this.frames.length - 1;
    const others = [...new Set([1, 2, 3, 4, 5].map((k) => Math.round((last * k) / 5)))].filter(
      (f) => f !== this.frame,
    );
    const series = [
      {name: `this frame`, y: s.valuesAt(samples, field, this.frame), colour: "var(--lit)", width: 2.2},
      ...others.map((f) => ({
        name: this.told(f).replace(/^.*?: /, ""),
        y: s.valuesAt(samples, field, f),
        width: 1.1,
        colour: css(colourAt(ONE_SIDED, 0.2 + (0.65 * f) / Math.max(1, last))),
      })),
    ];
    this.along.draw({x, label: "distance from the first block on the line [mm]", yLabel: label, series});
  }

  // ---- tabs

  tabs() {
    const tabs = [...document.querySelectorAll(".tab")],
      bar = $("tabs");
    const isEmpty = {
      heat: !this.drawsHeat(),
      energies: !page.course.energy_out.length,
      convergence: !this.course.has("unbalanced_ratio"),
    };
    const draw = {
      energies: () => this.drawEnergies(),
      cracks: () => this.drawCracks(),
      heat: () => this.drawHeat(),
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

  base(series, more) {
    const over = page.course.over,
      x = this.course.quantity(over);
    return {x: this.course.of(over), label: x ? x.label : "", series, stages: page.course.stages, ...more};
  }

  drawEnergies() {
    const chart = this.chart("energies", {
      height: 320,
      name: "energies",
      pick: (row) => this.showRow(row),
      brush: (p, o) => this.brush(p, o),
    });
    let base = new Float64Array(this.course.rows);
    const series = [];
    const put = new Float64Array(this.course.rows);
    for (const name of page.course.energy_in)
      this.course.column(name).forEach((v, i) => {
        put[i] += v || 0;
      });
    for (const {column, label, colour} of page.course.energy_out) {
      const values = this.course.column(column),
        above = base.map((v, i) => v + (values[i] || 0));
      if (values.some((v) => Math.abs(v) > 5e-4 * Math.max(...put.map(Math.abs))))
        series.push({name: label, y: above, base, colour: ENERGY_COLOURS[colour] || colour});
      base = above;
    }
    series.push({name: "put in", y: put, colour: "var(--ink)", width: 1.4, dash: "5 3"});
    chart.draw(this.base(series.reverse(), {yLabel: "energy [J]", from0: true}));
    chart.setCursor(this.row);
  }

  drawCracks() {
    const {modes, extent} = page.course,
      label = extent === "length_m" ? "length of cracks [m]" : "area of cracks [m²]";
    const chart = this.chart("crack_lengths", {
      name: label,
      pick: (row) => this.showRow(row),
      brush: (p, o) => this.brush(p, o),
    });
    const series = [];
    for (const mode in modes)
      modes[mode].forEach((name, k) =>
        series.push({
          name: `${mode}, ${name.replaceAll("_", "–")}`,
          y: this.course.column(`${mode}_${name}_${extent}`),
          colour: `var(--${mode})`,
          dash: DASHES[k % 4],
          width: 1.6,
        }),
      );
    chart.draw(this.base(series, {yLabel: label, from0: true}));
    chart.setCursor(this.row);
    if (this.body && !this.body.about.solid) {
      this.drawRose();
      this.drawOpenings();
    }
  }

  // Length of broken contacts at the end by the steepness of their lines.
  drawRose() {
    const host = $("rose"),
      last = this.frames.length - 1,
      bins = new Float64Array(18),
      {arrays} = this.body;
    for (const c of this.body.cracks(last)) {
      const turn = this.body.steepness(c);
      bins[Math.floor(((turn / Math.PI + 1) % 1) * 18) % 18] += arrays.extent.at(c, 0);
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
      last = this.frames.length - 1,
      bins = new Float64Array(12),
      edges = Array.from({length: 13}, (_, k) => 2 ** k / 4);
    for (const c of this.body.cracks(last)) {
      const um = 1e6 * this.body.arrays.opening.at(last, c);
      if (um > 0) bins[Math.max(0, Math.min(11, Math.floor(Math.log2(4 * um))))] += this.body.arrays.extent.at(c, 0);
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

  drawHeat() {
    const chart = this.chart("heat", {name: "temperatures", pick: (row) => this.showRow(row)});
    const ids = [
      "temperature",
      "temperature_min",
      "temperature_max",
      ...page.course.quantities.map((q) => q.id).filter((id) => id.startsWith("probe_")),
    ];
    const colours = [
      "var(--ink)",
      "var(--curve)",
      "var(--tension)",
      "var(--good)",
      "var(--mixed)",
      "var(--warn-line)",
    ];
    const series = ids
      .filter((id) => this.course.quantity(id))
      .map((id, k) => ({
        name: this.course.quantity(id).label,
        y: this.course.of(id),
        colour: colours[k % 6],
        dash: DASHES[Math.floor(k / 6) % 4],
      }));
    chart.draw({
      x: this.course.of("minutes"),
      label: this.course.quantity("minutes").label,
      yLabel: "temperature [°C]",
      series,
      stages: page.course.stages,
    });
    chart.setCursor(this.row);
  }

  drawConvergence() {
    const chart = this.chart("convergence", {name: "unbalanced ratio", pick: (row) => this.showRow(row)});
    const series = [
      ["unbalanced", "var(--curve)"],
      ["kinetic", "var(--tension)"],
    ]
      .filter(([id]) => this.course.quantity(id))
      .map(([id, colour]) => ({name: this.course.quantity(id).label, y: this.course.of(id), colour, width: 1.2}));
    chart.draw({
      x: this.course.of("step"),
      label: "step",
      yLabel: "ratio [–]",
      series,
      log: true,
      stages: page.course.stages,
    });
    chart.setCursor(this.row);
  }

  // ---- keys and files

  keys() {
    addEventListener("keydown", (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey || e.target.matches("select, input, textarea, summary")) return;
      if (e.target.matches("button, [role=tab]") && [" ", "Enter"].includes(e.key)) return;
      if (!this.body) return;
      if (e.shiftKey && e.key.startsWith("Arrow")) {
        this.moveProbe(e.key);
        e.preventDefault();
        return;
      }
      const act = {
        ArrowRight: () => this.show(this.frame + 1),
        ArrowLeft: () => this.show(this.frame - 1),
        Home: () => this.show(0),
        End: () => this.show(this.frames.length - 1),
        " ": () => this.play(),
        "[": () => this.pieceEnd(0),
        "]": () => this.pieceEnd(1),
        Escape: () => {
          this.clearPiece();
          this.specimen.probe = null;
          $("tip").hidden = true;
          this.show(this.frame);
        },
        p: () => this.specimen.probe && this.pin(...this.specimen.probe),
        l: () => this.toggleLine(),
      }[e.key];
      if (!act) return;
      e.preventDefault();
      act();
    });
  }

  moveProbe(key) {
    const s = this.specimen,
      step = 4 * s.ratio,
      [x, y] = s.probe || [s.W / 2, s.H / 2];
    s.probe = [
      x + step * ({ArrowRight: 1, ArrowLeft: -1}[key] || 0),
      y + step * ({ArrowDown: 1, ArrowUp: -1}[key] || 0),
    ];
    this.redraw();
    this.point(...s.probe);
  }

  // One end of the piece is put where the frame is, the other stays.
  pieceEnd(which) {
    const ends = this.piece || [this.row, this.row];
    ends[which] = this.row;
    this.brush([Math.min(...ends), Math.max(...ends)], true);
  }

  downloads() {
    const course = this.course,
      name = page.name;
    const columns = page.course.columns;
    $("save_history").onclick = () =>
      saveText(
        `${name}_history.csv`,
        csv(
          columns,
          Array.from({length: course.rows}, (_, i) => columns.map((c) => +course.columns[c][i].toPrecision(7))),
        ),
      );
    $("save_deck").onclick = () => saveText(`${name}.toml`, $("deck").textContent, "application/toml");
    if (!this.body) return;
    const keys = Object.keys(this.frames[0]).filter((k) => k !== "row");
    $("save_frames").onclick = () =>
      saveText(
        `${name}_frames.csv`,
        csv(
          keys,
          this.frames.map((f) => keys.map((k) => f[k])),
        ),
      );
    const s = this.specimen,
      file = (ending) => `${name}_frame_${this.frames[this.frame].number}.${ending}`;
    $("save_png").onclick = () => $("body").toBlob((blob) => save(file("png"), blob));
    $("save_svg").onclick = () => {
      const theme = s.theme();
      saveText(
        file("svg"),
        frameAsSvg(
          this.body,
          s.W,
          s.H,
          s.painter(theme),
          s.strokes(theme),
          `${page.title}, ${this.told(this.frame)}`,
        ),
        "image/svg+xml",
      );
    };
    $("save_film").hidden = !(window.MediaRecorder && HTMLCanvasElement.prototype.captureStream);
    $("save_film").onclick = async () => {
      const before = this.frame;
      save(`${name}.webm`, await film($("body"), this.frames.length, (k) => this.show(k)));
      this.show(before);
    };
    $("save_probes").onclick = () =>
      saveText(
        `${name}_probes.csv`,
        csv(
          ["frame", "step", "probe", "quantity", "value"],
          this.pins.flatMap((pin) =>
            this.frames.flatMap((f, k) =>
              this.factsOf(pin, k).map(([what, v]) => [
                f.number,
                f.step,
                this.nameOf(pin),
                what,
                v.replace("−", "-"),
              ]),
            ),
          ),
        ),
      );
  }
}

const canvasWidth = (tip) => tip.offsetWidth || 180;

const born = performance.now();
unpackedAll(page.arrays).then((arrays) => {
  const decoded = performance.now() - born;
  window.pyroclast = new RunPage(arrays);
  window.pyroclast.arrays = arrays;
  window.pyroclast.times = {decoded, ready: performance.now() - born};
});
