// Values of blocks and cracks that are pointed at or pinned, and of a field along a line.

import {ONE_SIDED, colourAt, css} from "./colours.js";
import {Chart} from "./curves.js";
import {$, made, number} from "./elements.js";

export class Probes {
  // The specimen tells which block and crack stands at a pixel, so it is drawn before.
  constructor(scene, specimen) {
    Object.assign(this, {scene, specimen, pins: []});
    scene.on("frame", () => {
      this.tellPins();
      if (specimen.across) this.tellAcross();
    });
    scene.on("probe", (place, isKept) => {
      if (!place) $("tip").hidden = true;
      else if (isKept) this.pin(...place);
      else this.point(...place);
    });
    $("line").onclick = () => this.toggleLine();
    $("unpin").onclick = () => {
      this.pins = [];
      this.tellPins();
    };
  }

  // Moves the probe of the keys by an arrow, from the middle of the picture.
  move(key) {
    const s = this.specimen,
      step = 4 * s.ratio,
      [x, y] = s.probe || [s.W / 2, s.H / 2];
    s.probe = [
      x + step * ({ArrowRight: 1, ArrowLeft: -1}[key] || 0),
      y + step * ({ArrowDown: 1, ArrowUp: -1}[key] || 0),
    ];
    this.scene.tell("frame");
    this.scene.tell("probe", s.probe, false);
  }
  keep() {
    if (this.specimen.probe) this.scene.tell("probe", this.specimen.probe, true);
  }
  drop() {
    this.specimen.probe = null;
    this.scene.tell("probe", null);
  }

  found(x, y) {
    const s = this.specimen;
    return s.body.at(x, y, s.W, s.H, s.frame, 9 * s.ratio);
  }

  // Says what stands at a pixel, beside it.
  point(x, y) {
    const s = this.specimen,
      tip = $("tip"),
      {block, crack} = this.found(x, y),
      lines = (pin) => [`${this.nameOf(pin)}, ${this.kindOf(pin)}`, ...this.factsOf(pin).map((two) => two.join(" "))];
    tip.hidden = block < 0 && crack < 0;
    if (tip.hidden) return;
    const said = [];
    if (crack >= 0) said.push(...lines({kind: "crack", id: crack}));
    if (block >= 0) said.push(...lines({kind: "block", id: block}));
    tip.textContent = said.join("\n");
    const left = x / s.ratio,
      top = y / s.ratio,
      width = tip.offsetWidth;
    tip.style.left = `${Math.max(0, Math.min(left + 14, s.W / s.ratio - width))}px`;
    tip.style.top = `${top + 16}px`;
  }

  pin(x, y) {
    const {block, crack} = this.found(x, y);
    const pin = crack >= 0 ? {kind: "crack", id: crack} : block >= 0 ? {kind: "block", id: block} : null;
    if (!pin || this.pins.some((p) => p.kind === pin.kind && p.id === pin.id)) return;
    this.pins.push(pin);
    this.tellPins();
  }

  nameOf({kind, id}) {
    return `${kind} ${kind === "crack" ? this.scene.body.contactNumber(id) : id}`;
  }
  // The interface of a crack, the material of a block.
  kindOf({kind, id}) {
    const {about, arrays} = this.scene.body;
    return kind === "crack"
      ? about.interfaces[arrays.interface.values[id]]
      : about.materials[arrays.material.values[id]].name;
  }

  // Values in a frame: [label, text].
  factsOf({kind, id}, frame = this.scene.frame) {
    const {body} = this.scene,
      a = body.arrays;
    if (kind === "block")
      return body.fields
        .filter(([field]) => field !== "material")
        .map(([field, label]) => [label, number(body.values(field, frame)[id])]);
    const facts = body.modes.map((m) => [`damage in ${m}`, number(a[`damage_${m}`].at(frame, id), 2)]),
      step = body.crackStep[id];
    facts.push(["opening [µm]", number(1e6 * a.opening.at(frame, id))]);
    if (step >= 0) facts.push(["passed a half at", this.scene.toldStep(step)]);
    return facts;
  }

  // Facts of all pins in all frames: [frame, step, probe, quantity, value].
  get rows() {
    return this.pins.flatMap((pin) =>
      this.scene.frames.flatMap((f, k) =>
        this.factsOf(pin, k).map(([what, v]) => [f.number, f.step, this.nameOf(pin), what, v.replace("−", "-")]),
      ),
    );
  }

  tellPins() {
    $("pinned").hidden = !this.pins.length;
    if (!this.pins.length) return;
    const {body} = this.scene,
      facts = this.pins.map((pin) => new Map(this.factsOf(pin))),
      names = [...new Set(facts.flatMap((known) => [...known.keys()]))],
      axes = body.about.solid ? ["x", "y", "z"] : ["x", "y"],
      head = made("tr");
    for (const name of ["probe", "of", ...axes.map((axis) => `${axis} [mm]`), ...names, ""]) made("th", name, head);
    $("pinned_head").replaceChildren(head);
    $("pinned_rows").replaceChildren(
      ...this.pins.map((pin, k) => {
        const row = made("tr"),
          place = pin.kind === "crack" ? body.whereContact(pin.id) : body.whereBlock(pin.id),
          values = [...place.map((v) => number(1e3 * v)), ...names.map((n) => facts[k].get(n) || "")];
        for (const text of [this.nameOf(pin), this.kindOf(pin), ...values]) made("td", text, row);
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
    const s = this.specimen,
      {fields} = s.body;
    s.across = s.across ? null : [0.02, 0.5, 0.98, 0.5];
    $("line").setAttribute("aria-pressed", String(Boolean(s.across)));
    if (s.across && s.colour === "material" && fields.length > 1) $("colour").value = s.colour = fields[1][0];
    $("along").hidden = !s.across;
    this.scene.tell("frame");
  }

  tellAcross() {
    const {scene, specimen: s} = this,
      host = $("along"),
      field = s.colour;
    if (!this.along) {
      made("h3", "Along the line", host);
      this.along = new Chart(made("div", null, host), {height: 260, name: "values along the line"});
    }
    const samples = s.samples(),
      label = s.body.fields.find((f) => f[0] === field)[1];
    if (field === "material" || samples.length < 2) return;
    const x = samples.map((p) => 1e3 * (p.at - samples[0].at)),
      last = scene.frames.length - 1,
      others = new Set([1, 2, 3, 4, 5].map((k) => Math.round((last * k) / 5)));
    others.delete(scene.frame);
    const series = [
      {name: `this frame`, y: s.valuesAt(samples, field, scene.frame), colour: "var(--lit)", width: 2.2},
      ...[...others].map((f) => ({
        name: scene.told(f).replace(/^.*?: /, ""),
        y: s.valuesAt(samples, field, f),
        width: 1.1,
        colour: css(colourAt(ONE_SIDED, 0.2 + (0.65 * f) / Math.max(1, last))),
      })),
    ];
    this.along.draw({x, label: "distance along the line, as the body was made [mm]", yLabel: label, series});
  }
}
