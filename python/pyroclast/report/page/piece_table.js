// A piece of the curve: what broke in it, and where the energy went.

import {$, made, number, table} from "./elements.js";


export class PieceTable {
  constructor(scene) {
    Object.assign(this, {scene, course: scene.course});
    const tell = {
      begun: (row) => this.tellBegun(row),
      empty: (row) => this.tellEmpty(row),
      whole: () => this.tellPiece(),
      dropped: () => ($("piece").hidden = true),
      dragged: () => {},
    };
    scene.on("piece", (how, row) => tell[how](row));
  }

  // Says something in the place of what is told of a piece.
  say(...texts) {
    const host = $("piece");
    host.replaceChildren();
    host.hidden = false;
    for (const text of texts) made("p", text, host, "note");
    return host;
  }

  tellBegun(row) {
    const {which} = this.scene.begun;
    this.say(
      `A piece of the curve ${which ? "ends" : "begins"} at ${this.scene.placeOf(row)}. ` +
        `Go to its other end, by a mark too, and press ${which ? "[" : "]"}. Esc drops it.`,
    );
  }

  tellEmpty(row) {
    const {begun} = this.scene;
    this.say(
      `This piece is empty: it begins and ends at ${this.scene.placeOf(row)}.`,
      begun
        ? `Go to another place and press ${begun.which ? "[" : "]"} there. Esc drops it.`
        : "Drag farther across the curve.",
    );
  }

  tellPiece() {
    const {scene, course} = this,
      [first, last] = scene.piece,
      {of} = scene.axes,
      host = this.say(),
      y = course.of(of),
      [from, to, change] = [number(y[first], 4), number(y[last], 4), number(y[last] - y[first])];
    made("h3", `This piece of the curve: ${scene.placeOf(first, last)}`, host);
    if (scene.moves) made("p", this.why(), host, "why");
    made("p", `${course.quantity(of).label}: ${from} to ${to}, a change of ${change}.`, host);
    this.tellBroken(host);
    this.tellEnergies(host);
    this.tellLosses(host);
    const close = made("button", "drop this piece (Esc)", host);
    close.type = "button";
    close.onclick = () => {
      scene.dropPiece();
      if (scene.body) scene.show(scene.frame);
    };
  }

  // How many contacts were damaged and broke in the piece, by mode and interface.
  get counts() {
    const change = (column) => this.course.change(column, this.scene.piece);
    return this.course.about.cracks.map(({mode, interface: name, damaged, broken, extent}) => ({
      mode,
      name: name.replaceAll("_", "–"),
      damaged: change(damaged),
      broken: change(broken),
      extent: change(extent),
    }));
  }

  // Changes of energies in the piece, J, the largest first.
  get energies() {
    return this.course.about.energy_out
      .map((e) => ({...e, value: this.course.change(e.column, this.scene.piece)}))
      .filter((e) => Math.abs(e.value) > 1e-12)
      .sort((p, q) => Math.abs(q.value) - Math.abs(p.value));
  }
  get work() {
    return this.course.about.energy_in.reduce((sum, name) => sum + this.course.change(name, this.scene.piece), 0);
  }

  // In a few words what broke and what took the energy.
  why() {
    const rows = this.counts,
      leading = (what) => rows.reduce((p, q) => (q[what] > p[what] ? q : p), rows[0]),
      all = (what) => rows.reduce((sum, row) => sum + row[what], 0),
      most = (what) => {
        const {mode, name, [what]: count} = leading(what);
        return `${count > all(what) / 2 ? "mostly" : "most often"} in ${mode} at ${name} (${count} of ${all(what)})`;
      };
    const said = [
      all("broken") > 0
        ? `Contacts broke ${most("broken")}`
        : all("damaged") > 0
          ? `No contact broke; contacts were first damaged ${most("damaged")}`
          : "No contact broke or was first damaged",
    ];
    const lost = this.energies.filter((e) => !e.is_held && e.value > 0),
      whole = lost.reduce((sum, e) => sum + e.value, 0),
      told = ({label, value}) => `${label} (${number(value)} J)`;
    if (lost.length) {
      const largest = lost.slice(0, lost[0].value < 0.8 * whole ? 2 : 1),
        part = largest.reduce((sum, e) => sum + e.value, 0) > whole / 2 ? "most of" : "the largest part of",
        rest = lost.slice(largest.length).filter((e) => e.value > 0.005 * whole);
      said.push(
        `${largest.map(told).join(" and ")} took ${part} the energy that was lost` +
          (rest.length ? `, then ${rest.map((e) => `${e.label} ${number(e.value)} J`).join(", ")}` : ""),
      );
    }
    const stored = this.energies.filter((e) => e.is_held).reduce((sum, e) => sum + e.value, 0);
    const balance = `${number(this.work)} J was put in, ${number(Math.abs(stored))} J `;
    return `${said.join("; ")}. ${balance}${stored < 0 ? "came out of what was stored" : "was stored"}.`;
  }

  tellBroken(host) {
    const rows = this.counts,
      unit = this.course.about.extent_unit === "m" ? "mm" : "cm²",
      factor = unit === "mm" ? 1e3 : 1e4;
    if (!rows.length) return;
    made("h4", `Contacts, ${this.scene.placeOf(...this.scene.piece)}`, host);
    table(
      host,
      [
        "mode",
        "interface",
        ["first damaged", "contacts whose damage in this mode rose above 0 in the piece: they begin to soften"],
        ["broken", "contacts whose damage in this mode reached 1 in the piece: they bear nothing more in it"],
        [`damaged [${unit}]`, `${unit === "mm" ? "length" : "area"} of the contacts that were first damaged`],
      ],
      rows.map((row) => [row.mode, row.name, row.damaged, row.broken, number(factor * row.extent)]),
    );
  }

  tellEnergies(host) {
    const rows = this.energies;
    if (!rows.length) return;
    made("h4", `Energy, ${this.scene.placeOf(...this.scene.piece)}`, host);
    made("p", `Put in: ${number(this.work)} J. It went to (negative: it came from):`, host);
    table(
      host,
      ["energy", "J"],
      rows.map(({label, value}) => [label, number(value)]),
    );
  }

  // Energy that contacts lost between the frames around the piece, by interface.
  tellLosses(host) {
    const {scene} = this,
      {body, frames, piece} = scene,
      losses = body ? Object.keys(body.arrays).filter((name) => name.startsWith("lost_")) : [];
    if (!losses.length) return;
    const [from, to] = [scene.frameBefore(piece[0]), scene.frameAt(piece[1])],
      {interfaces} = body.about,
      lit = scene.lit || new Set(),
      kinds = body.arrays.interface.values,
      sums = [...interfaces, "of the lit ones"].map(() => losses.map(() => 0));
    for (let c = 0; c < body.contacts; c++)
      losses.forEach((name, k) => {
        const lost = body.arrays[name].at(to, c) - body.arrays[name].at(from, c);
        sums[kinds[c]][k] += lost;
        if (lit.has(c)) sums[interfaces.length][k] += lost;
      });
    const [one, other] = [frames[from], frames[to]],
      span = `frames ${one.number} to ${other.number}: ${scene.placeOf(one.row, other.row)}`;
    made("h4", `Energy that contacts lost [J], rounded to ${span}`, host);
    table(
      host,
      ["interface", ...losses.map((name) => this.nameOfLoss(name))],
      sums
        .map((values, k) => [interfaces[k] || `the ${lit.size} with a halo`, ...values.map((v) => number(v))])
        .filter((row, k) => k === interfaces.length || sums[k].some((v) => v > 0)),
    );
    const halo = "A halo marks contacts whose damage passed one half in the piece itself.";
    if (lit.size) made("p", halo, host, "note");
  }

  // A loss of contacts as the energies of the history are called.
  nameOfLoss(name) {
    const loss = name.replace("lost_", ""),
      found = this.course.about.energy_out.find((e) => !e.is_held && e.of === loss);
    return found ? found.label : loss;
  }
}
