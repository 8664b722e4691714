// Values of blocks and cracks that are pointed at or pinned, and of a field along a line.

class RunProbes extends RunSpecimen {
  pointer() {
    const canvas = $("body"),
      at = (e) => this.pixelOf(e);
    let from = null,
      before = null;
    canvas.addEventListener("pointerdown", (e) => {
      from = before = at(e);
      canvas.setPointerCapture(e.pointerId);
      if (this.specimen.across) e.preventDefault();
    });
    canvas.addEventListener("pointermove", (e) => {
      const here = at(e),
        s = this.specimen;
      if (from && s.across) {
        s.across = [from[0] / s.W, from[1] / s.H, here[0] / s.W, here[1] / s.H];
        this.redraw();
      } else if (from && this.body.axes) {
        const k = Math.PI / s.W;
        this.turn(k * (here[0] - before[0]), k * (here[1] - before[1]));
        before = here;
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

  // Of an event, in pixels of the picture.
  pixelOf(e) {
    const box = $("body").getBoundingClientRect(),
      k = this.specimen.W / box.width;
    return [(e.clientX - box.left) * k, (e.clientY - box.top) * k];
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
      width = tip.offsetWidth;
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
    const step = this.body.crackStep[c];
    if (step >= 0) facts.push(["passed a half at", this.toldStep(step)]);
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
    this.along.draw({x, label: "distance along the line, as the body was made [mm]", yLabel: label, series});
  }
}
