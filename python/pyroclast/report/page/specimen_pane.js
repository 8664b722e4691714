// The specimen of a run, frame by frame: how it is coloured, from where it is seen, and its key.

import {ONE_SIDED, colourAt, css} from "./colours.js";
import {shown} from "./curves.js";
import {$, entry, made, menu, number, onSight, player, unitOf, withUnit} from "./elements.js";
import {OutsideBody} from "./outside.js";
import {MAGNIFICATIONS, Specimen, tellModes, tellScale} from "./specimen.js";

const ZOOM_STEP = 1.25;
const TURN_STEP = Math.PI / 24; // radians

export class SpecimenPane {
  constructor(scene, specimen) {
    Object.assign(this, {scene, specimen});
    const {body} = scene,
      choices = body.moves ? MAGNIFICATIONS : [1];
    const menuOf = (id, what, entries) =>
      menu(id, entries, specimen[what], (value) => {
        specimen[what] = what === "magnification" ? +value : value;
        this.redraw();
      });
    specimen.colour = body.arrays.temperature ? "temperature" : "material";
    specimen.magnification = body.moves ? this.fitting(choices) : 1;
    menuOf("colour", "colour", body.fields);
    menuOf("magnification", "magnification", choices.map((m) => [m, m]));
    $("magnification").parentElement.hidden = !body.moves;
    if ($("covered")) {
      $("covered").parentElement.hidden = !body.bearing.includes(1);
      $("covered").onchange = () => {
        specimen.showsCovered = $("covered").checked;
        specimen.draw();
      };
    }
    if ($("cracks")) menuOf("cracks", "cracks", []);
    if (body.about.solid) this.makeViews();
    $("at").max = scene.frames.length - 1;
    player(1, () => scene.show(+$("at").value));
    this.pointer();
    this.size();
    scene.on("frame", () => this.follow());
    onSight($("body").parentElement, () => this.fit(), () => this.redraw());
    addEventListener("beforeprint", () => this.fourFrames());
  }

  size() {
    this.specimen.size($("body").parentElement.clientWidth || 400, Math.max(320, 0.78 * innerHeight));
  }
  fit() {
    this.size();
    this.redraw();
  }
  redraw() {
    this.scene.tell("frame");
  }

  // A solid is seen as a plane through it, or from outside, from one of its sides or turned.
  makeViews() {
    const {scene, specimen} = this,
      cut = scene.body,
      toldPlace = () => `${cut.axis} = ${number(1e3 * cut.offset)} mm`;
    let outside = null; // made when it is first asked for
    const look = () => {
      const [axis, side] = $("view").value.split(" "),
        isCut = side === "0";
      if (!isCut && !outside) {
        outside = new OutsideBody(cut.about, cut.arrays, cut.frames);
        outside.ranges = cut.ranges;
      }
      scene.body = specimen.body = isCut ? cut : outside;
      if (isCut) cut.look(axis, $("place").value / 100);
      else if (side) outside.lookFrom(axis, +side);
      $("across").hidden = !isCut;
      $("around").hidden = isCut;
      $("place_now").textContent = isCut ? toldPlace() : "";
      this.fit();
    };
    $("view").value = `${cut.axis} 0`;
    $("view").onchange = $("place").oninput = look;
    $("place_now").textContent = toldPlace();
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
        if (!scene.body.axes || document.activeElement !== $("body")) return; // else the wheel moves the page
        e.preventDefault();
        this.zoom(Math.exp(-0.0015 * e.deltaY), ...this.pixelOf(e));
      },
      {passive: false},
    );
  }

  // Turns a solid that is seen from outside, radians.
  turn(right, up) {
    if (!this.scene.body.axes) return;
    this.scene.body.turnBy(right, up);
    $("view").value = "turned";
    this.redraw();
  }

  zoom(factor, x = this.specimen.W / 2, y = this.specimen.H / 2) {
    const {body, W, H} = this.specimen;
    if (!body.axes) return;
    body.zoomBy(factor, ...body.fromPixels(x, y, W, H));
    this.redraw();
  }

  // What keys do to a solid that is seen from outside.
  get keys() {
    if (!this.scene.body.axes) return {};
    return {
      a: () => this.turn(-TURN_STEP, 0),
      d: () => this.turn(TURN_STEP, 0),
      w: () => this.turn(0, -TURN_STEP),
      s: () => this.turn(0, TURN_STEP),
      "+": () => this.zoom(ZOOM_STEP),
      "-": () => this.zoom(1 / ZOOM_STEP),
    };
  }

  // A drag moves the line across or turns a solid; a click keeps a probe.
  pointer() {
    const canvas = $("body"),
      {scene, specimen: s} = this;
    let from = null,
      before = null;
    canvas.addEventListener("pointerdown", (e) => {
      from = before = this.pixelOf(e);
      canvas.setPointerCapture(e.pointerId);
      if (s.across) e.preventDefault();
    });
    canvas.addEventListener("pointermove", (e) => {
      const here = this.pixelOf(e);
      if (from && s.across) {
        s.across = [from[0] / s.W, from[1] / s.H, here[0] / s.W, here[1] / s.H];
        this.redraw();
      } else if (from && scene.body.axes) {
        const k = Math.PI / s.W;
        this.turn(k * (here[0] - before[0]), k * (here[1] - before[1]));
        before = here;
      } else scene.tell("probe", here, false);
    });
    canvas.addEventListener("pointerup", (e) => {
      const here = this.pixelOf(e),
        moved = from && Math.hypot(here[0] - from[0], here[1] - from[1]) > 6 * s.ratio;
      from = null;
      if (!moved) scene.tell("probe", here, true);
    });
    canvas.addEventListener("pointerleave", () => scene.tell("probe", null));
  }

  // Place of an event, in pixels of the picture.
  pixelOf(e) {
    const box = $("body").getBoundingClientRect(),
      k = this.specimen.W / box.width;
    return [(e.clientX - box.left) * k, (e.clientY - box.top) * k];
  }

  // The largest magnification that moves blocks by at most a tenth of the body at the end.
  fitting(choices) {
    const {body, frames} = this.scene,
      values = Array.from(body.values("displacement", frames.length - 1)).sort((p, q) => p - q);
    const most = 1e-3 * values[Math.floor(0.97 * (values.length - 1))],
      size = body.box.x1 - body.box.x0;
    return choices.filter((m) => m * most < 0.06 * size && m <= 20).pop() || 1;
  }

  // Draws the frame of the scene, and says which it is.
  follow() {
    const {scene, specimen} = this,
      {frame, asked, cracked, lit} = scene,
      {first = [], isOfDamage = false} = asked || {},
      ringed = new Set(first.map(({c}) => c));
    Object.assign(specimen, {frame, lit, ringed, isOfDamage, caption: asked ? this.toldGap(asked) : ""});
    specimen.draw();
    this.tellKey();
    $("at").value = frame;
    const now = scene.told(frame);
    $("now").textContent = [
      now,
      ...(cracked && cracked.size ? [`${cracked.size} contacts passed a damage of one half (with a halo)`] : []),
      ...(first.length ? [this.toldFirst(first)] : []),
      ...(isOfDamage ? [this.toldDamage()] : []),
    ].join("; ");
    $("body").setAttribute("aria-label", `specimen, ${now}`);
    $("at").setAttribute("aria-valuetext", now);
  }

  // How far the frame that is shown lies from the place that was asked for; "" where it is that place.
  toldGap({row, name}) {
    const at = this.scene.frames[this.scene.frame],
      {label, values} = this.scene.at(at.row, row),
      gap = values[0] - values[1];
    if (at.row === row || !isFinite(gap)) return "";
    const [where, far] = [number(values[0]), number(Math.abs(gap), 2)].map((v) => withUnit(v, unitOf(label)));
    return `frame at ${where}, ${far} ${at.row > row ? "after" : "before"} ${name}`;
  }

  // Which contacts may have broken first, and where they were made.
  toldFirst(first) {
    const most = 3,
      places = first.slice(0, most).map(({c}) => {
        const at = this.scene.body.whereContact(c).map((v) => number(1e3 * v));
        return `(${at.join(", ")}) mm`;
      }),
      kinds = [...new Set(first.map(({mode, name}) => `${mode}, ${name}`))].join(" or "),
      more = first.length > most ? ` and ${first.length - most} more` : "";
    return first.length === 1
      ? `first to break: ${kinds}, at ${places[0]} (ring)`
      : `one of ${first.length} broke first: ${kinds}, at ${places.join(", ")}${more} (rings)`;
  }

  toldDamage() {
    const {body, frame} = this.scene;
    let damaged = 0;
    for (let c = 0; c < body.contacts; c++) if (body.worst(frame, c)[1] > 0) damaged++;
    const known = body.about.solid ? "of the contacts that become cracks " : "";
    return `${known}${damaged} are damaged (thin), ${body.cracks(frame).length} by more than one half`;
  }

  tellKey() {
    const {scene, specimen: s} = this,
      {body} = scene,
      key = $("key"),
      add = (name, colour, more) => key.append(entry({name, colour, ...more}));
    key.replaceChildren();
    if (s.colour === "material") {
      const shownMaterials = new Set(body.arrays.material.values);
      body.about.materials.forEach(({name}, k) => {
        if (shownMaterials.has(k)) add(name, css(s.theme().phases[k]), {base: true});
      });
    } else tellScale(key, body, s.colour);
    if (s.colour === "temperature" && body.hasIsotherms) this.tellDepths(key);
    if (!body.modes.length || s.cracks === "none") return;
    if (s.cracks === "mode") tellModes(key, body);
    if (s.cracks === "opening")
      [0, 15, 75].forEach((um, k) => add(`opening from ${um} µm`, css(colourAt(ONE_SIDED, (2 * k + 1.5) / 7))));
    if (s.cracks === "age" && body.ages) {
      const [oldest, youngest] = body.ages.map((step) => scene.toldStep(step));
      add(`oldest crack: ${oldest}`, css(colourAt(ONE_SIDED, 0.95)));
      add(`youngest: ${youngest}`, css(colourAt(ONE_SIDED, 0.15)));
    }
    if (s.isOfDamage)
      for (const mode of body.modes) add(`${mode}, damaged by less than half (thin)`, `var(--${mode}-tint)`);
    if (s.lit && s.lit.size)
      add(`halo: passed a damage of one half in ${scene.piece ? "the piece" : "this frame"}`, "var(--lit)");
  }

  // How deep temperatures lie below the heated side, and which lines the picture has.
  tellDepths(key) {
    const {side, depths} = this.scene.body.depths(this.scene.frame, [500, 300, 100]),
      {levels} = this.specimen;
    const told = depths.map(([t, d]) => `${t} °C at ${number(1e3 * d, 2)} mm`).join(", ");
    if (told) made("span", `mean depth from the ${side}: ${told}`, key).id = "depths";
    if (levels.length) made("span", `lines: ${levels.map(shown).join(", ")} °C`, key);
  }

  fourFrames() {
    const {scene, specimen} = this,
      host = $("four"),
      wanted = new Set(),
      last = scene.frames.length - 1,
      {colour, cracks, magnification} = specimen;
    for (const share of [1, 0.5, 0.75, 0.25, 0]) if (wanted.size < 4) wanted.add(Math.round(share * last));
    host.replaceChildren();
    for (const frame of [...wanted].sort((p, q) => p - q).slice(-4)) {
      const figure = made("figure", null, host),
        canvas = made("canvas", null, figure);
      made("figcaption", scene.told(frame), figure);
      const one = new Specimen(canvas, scene.body);
      Object.assign(one, {frame, colour, cracks, magnification});
      one.size(340, 600);
      canvas.style.height = "auto";
      one.draw();
    }
    specimen.draw();
  }
}
