// The specimen of a run, frame by frame.

const ZOOM_STEP = 1.25;
const TURN_STEP = Math.PI / 24; // radians

class RunSpecimen extends RunPiece {
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
    if ($("covered")) {
      $("covered").parentElement.hidden = !this.body.bearing.includes(1);
      $("covered").onchange = () => {
        s.showsCovered = $("covered").checked;
        s.draw();
      };
    }
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

  // A solid is seen as a plane through it, or from outside, from one of its sides or turned.
  makeViews() {
    const cut = this.body;
    let outside = null; // made when it is first asked for
    const look = () => {
      const [axis, side] = $("view").value.split(" "),
        isCut = side === "0";
      if (!isCut && !outside) {
        outside = new OutsideBody(cut.about, cut.arrays, cut.frames);
        outside.ranges = cut.ranges;
      }
      this.body = this.specimen.body = isCut ? cut : outside;
      if (isCut) cut.look(axis, $("place").value / 100);
      else if (side) outside.lookFrom(axis, +side);
      $("across").hidden = !isCut;
      $("around").hidden = isCut;
      this.width = null;
      this.fit();
      $("place_now").textContent = isCut ? `${axis} = ${number(1e3 * cut.offset)} mm` : "";
    };
    $("view").onchange = $("place").oninput = look;
    $("place_now").textContent = `z = ${number(1e3 * cut.offset)} mm`;
    $("alone").parentElement.hidden = !cut.modes.length;
    $("alone").onchange = () => {
      outside.alone = $("alone").checked;
      this.redraw();
    };
    $("nearer").onclick = () => this.zoom(ZOOM_STEP);
    $("farther").onclick = () => this.zoom(1 / ZOOM_STEP);
    $("body").addEventListener(
      "wheel",
      (e) => {
        if (!this.body.axes || document.activeElement !== $("body")) return; // else the wheel moves the page
        e.preventDefault();
        this.zoom(Math.exp(-0.0015 * e.deltaY), ...this.pixelOf(e));
      },
      {passive: false},
    );
  }

  // Turns a solid that is seen from outside, radians.
  turn(right, up) {
    if (!this.body.axes) return;
    this.body.turnBy(right, up);
    $("view").value = "turned";
    this.redraw();
  }

  zoom(factor, x = this.specimen.W / 2, y = this.specimen.H / 2) {
    const {body, specimen: s} = this;
    if (!body.axes) return;
    body.zoomBy(factor, ...body.fromPixels(x, y, s.W, s.H));
    this.redraw();
  }

  // The largest magnification that moves blocks by at most a tenth of the body at the end.
  fitting(choices) {
    const last = this.frames.length - 1,
      values = Array.from(this.body.values("displacement", last)).sort((p, q) => p - q);
    const most = 1e-3 * values[Math.floor(0.97 * (values.length - 1))],
      size = this.body.box.x1 - this.body.box.x0;
    return choices.filter((m) => m * most < 0.06 * size && m <= 20).pop() || 1;
  }

  // Shows a frame. lit: contacts with a halo; asked: {row, name} of the place on the curve that it is shown for, with
  // what that points at.
  show(frame, lit = null, asked = null) {
    this.frame = Math.max(0, Math.min(this.frames.length - 1, frame));
    this.asked = asked;
    const first = (asked && asked.first) || [];
    Object.assign(this.specimen, {
      frame: this.frame,
      lit: lit || (this.piece ? this.specimen.lit : null),
      ringed: new Set(first.map(({c}) => c)),
      isOfDamage: Boolean(asked && asked.isOfDamage),
      caption: asked ? this.toldGap(asked) : "",
    });
    $("at").value = this.frame;
    const now = this.told(this.frame);
    $("now").textContent = [
      now,
      ...(lit && lit.size ? [`${lit.size} contacts passed a damage of one half (with a halo)`] : []),
      ...(first.length ? [this.toldFirst(first)] : []),
      ...(this.specimen.isOfDamage ? [this.toldDamage()] : []),
    ].join("; ");
    $("body").setAttribute("aria-label", `specimen, ${now}`);
    $("at").setAttribute("aria-valuetext", now);
    this.hover(null);
    this.redraw();
  }

  // How far the frame that is shown lies from the place that was asked for; "" where it is that place.
  toldGap({row, name}) {
    const at = this.frames[this.frame],
      {label} = this.course.quantity(page.course.over),
      values = this.course.of(page.course.over),
      gap = values[at.row] - values[row];
    if (at.row === row || !isFinite(gap)) return "";
    const [where, far] = [number(values[at.row]), number(Math.abs(gap), 2)].map((v) => withUnit(v, unitOf(label)));
    return `frame at ${where}, ${far} ${at.row > row ? "after" : "before"} ${name}`;
  }

  // Which contacts may have broken first, and where they were made.
  toldFirst(first) {
    const most = 3,
      places = first.slice(0, most).map(({c}) => {
        const at = this.body.whereContact(c).map((v) => number(1e3 * v));
        return `(${at.join(", ")}) mm`;
      }),
      kinds = [...new Set(first.map(({mode, name}) => `${mode}, ${name}`))].join(" or "),
      more = first.length > most ? ` and ${first.length - most} more` : "";
    return first.length === 1
      ? `first to break: ${kinds}, at ${places[0]} (ring)`
      : `one of ${first.length} broke first: ${kinds}, at ${places.join(", ")}${more} (rings)`;
  }

  toldDamage() {
    let damaged = 0;
    for (let c = 0; c < this.body.contacts; c++) if (this.body.worst(this.frame, c)[1] > 0) damaged++;
    const known = this.body.about.solid ? "of the contacts that become cracks " : "";
    return `${known}${damaged} are damaged (thin), ${this.body.cracks(this.frame).length} by more than one half`;
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
    return `frame ${f.number} of ${this.frames[this.frames.length - 1].number}: ${said.join(", ")}`;
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
    } else tellScale(key, this.body, s.colour);
    if (s.colour === "temperature" && this.body.hasIsotherms) this.tellDepths(key);
    if (!this.body.modes.length || s.cracks === "none") return;
    if (s.cracks === "mode") tellModes(key, this.body);
    if (s.cracks === "opening")
      [0, 15, 75].forEach((um, k) =>
        key.append(
          entry({name: `opening from ${um} µm`, colour: css(colourAt(ONE_SIDED, ([0, 2, 4][k] + 1.5) / 7))}),
        ),
      );
    if (s.cracks === "age" && this.body.ages) {
      const [first, last] = this.body.ages;
      key.append(
        entry({name: `oldest crack: ${this.toldStep(first)}`, colour: css(colourAt(ONE_SIDED, 0.95))}),
        entry({name: `youngest: ${this.toldStep(last)}`, colour: css(colourAt(ONE_SIDED, 0.15))}),
      );
    }
    if (s.isOfDamage)
      for (const mode of this.body.modes)
        key.append(entry({name: `${mode}, damaged by less than half (thin)`, colour: `var(--${mode}-tint)`}));
    if (s.lit && s.lit.size)
      key.append(
        entry({
          name: `halo: passed a damage of one half in ${this.piece ? "the piece" : "this frame"}`,
          colour: "var(--lit)",
        }),
      );
  }

  // How deep temperatures lie below the heated side, and which lines the picture has.
  tellDepths(key) {
    const {side, depths} = this.body.depths(this.frame, [500, 300, 100]),
      {levels} = this.specimen;
    const told = depths.map(([t, d]) => `${t} °C at ${number(1e3 * d, 2)} mm`).join(", ");
    if (told) made("span", `mean depth from the ${side}: ${told}`, key).id = "depths";
    if (levels.length) made("span", `lines: ${levels.map(shown).join(", ")} °C`, key);
  }

  // A step, and where the curve was at it.
  toldStep(step) {
    const row = this.course.column("step").findIndex((s) => s >= step),
      over = this.course.quantity(page.course.over);
    const at = row < 0 || !over ? NaN : this.course.of(over.id)[row];
    return `step ${step}${isFinite(at) ? ` (${withUnit(number(at), unitOf(over.label))})` : ""}`;
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
}
