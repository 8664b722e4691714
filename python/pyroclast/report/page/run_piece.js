// A piece of the curve: what broke in it, and where the energy went.

const STORED = ["energy_zones_J", "energy_contacts_J", "energy_kinetic_J"]; // and not lost

class RunPiece extends RunCurve {
  // A piece that is dragged out takes the place of one that had begun.
  drag(piece, isOver) {
    this.begun = null;
    this.brush(piece, isOver);
  }

  brush(piece, isOver) {
    this.piece = piece;
    for (const chart of this.charts) chart.setPiece(piece);
    if (!isOver) return;
    const [from, to] = piece;
    if (from === to) return this.tellEmpty(from);
    if (this.body) {
      const steps = piece.map((row) => this.course.column("step")[row]);
      this.show(this.frameAt(to), this.body.crackedBetween(...steps), {row: to, name: "the end of the piece"});
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
    this.piece = this.begun = null;
    for (const chart of this.charts) chart.setPiece(null);
    $("piece").hidden = true;
  }

  // Where rows lie on the curve, such as "axial strain 2.77 to 2.86·10⁻³".
  placeOf(...rows) {
    const {label} = this.course.quantity(page.course.over),
      values = rows.map((row) => this.course.of(page.course.over)[row]);
    return `${label.split(/,| \[/)[0]} ${withUnit(this.toldSpan(values), unitOf(label))}`;
  }

  // Says something in the place of what is told of a piece.
  sayOfPiece(...texts) {
    const host = $("piece");
    host.replaceChildren();
    host.hidden = false;
    for (const text of texts) made("p", text, host, "note");
  }

  tellBegun() {
    const {row, which} = this.begun;
    for (const chart of this.charts) chart.setPiece([row, row]);
    this.sayOfPiece(
      `A piece of the curve ${which ? "ends" : "begins"} at ${this.placeOf(row)}. ` +
        `Go to its other end, by a mark too, and press ${which ? "[" : "]"}. Esc drops it.`,
    );
  }

  tellEmpty(row) {
    this.piece = null;
    for (const chart of this.charts) chart.setPiece(this.begun ? [row, row] : null);
    this.sayOfPiece(
      `This piece is empty: it begins and ends at ${this.placeOf(row)}.`,
      this.begun
        ? `Go to another place and press ${this.begun.which ? "[" : "]"} there. Esc drops it.`
        : "Drag farther across the curve.",
    );
  }

  tellPiece() {
    const {course, piece} = this,
      host = $("piece"),
      {of} = this.axes;
    host.replaceChildren();
    host.hidden = false;
    const y = course.of(of),
      {label} = course.quantity(of);
    made("h3", `This piece of the curve: ${this.placeOf(...piece)}`, host);
    if (page.moves) made("p", this.why(), host, "why");
    const change = number(y[piece[1]] - y[piece[0]], 3);
    made("p", `${label}: ${number(y[piece[0]], 4)} to ${number(y[piece[1]], 4)}, a change of ${change}.`, host);
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

  // How many contacts were damaged and broke in the piece, by mode and interface.
  get counts() {
    const rows = [],
      {modes, extent} = page.course;
    for (const mode in modes)
      for (const name of modes[mode]) {
        const of = (what) => this.course.change(`${mode}_${name}_${what}`, this.piece);
        rows.push({
          mode,
          name: name.replaceAll("_", "–"),
          damaged: of("damaged"),
          broken: of("broken"),
          extent: of(extent),
        });
      }
    return rows;
  }

  // Changes of energies in the piece, J, the largest first.
  get energies() {
    return page.course.energy_out
      .map(({column, label}) => ({column, label, value: this.course.change(column, this.piece)}))
      .filter((e) => Math.abs(e.value) > 1e-12)
      .sort((p, q) => Math.abs(q.value) - Math.abs(p.value));
  }
  get work() {
    return page.course.energy_in.reduce((sum, name) => sum + this.course.change(name, this.piece), 0);
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
    const lost = this.energies.filter((e) => !STORED.includes(e.column) && e.value > 0),
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
    const stored = this.energies.filter((e) => STORED.includes(e.column)).reduce((sum, e) => sum + e.value, 0);
    const balance = `${number(this.work)} J was put in, ${number(Math.abs(stored))} J `;
    return `${said.join("; ")}. ${balance}${stored < 0 ? "came out of what was stored" : "was stored"}.`;
  }

  tellBroken(host) {
    const rows = this.counts,
      unit = page.course.extent === "length_m" ? "mm" : "cm²",
      factor = unit === "mm" ? 1e3 : 1e4;
    if (!rows.length) return;
    made("h4", `Contacts, ${this.placeOf(...this.piece)}`, host);
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
    made("h4", `Energy, ${this.placeOf(...this.piece)}`, host);
    made("p", `Put in: ${number(this.work)} J. It went to (negative: it came from):`, host);
    table(
      host,
      ["energy", "J"],
      rows.map(({label, value}) => [label, number(value)]),
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
    const sums = [...interfaces, "of the lit ones"].map(() => losses.map(() => 0));
    for (let c = 0; c < this.body.contacts; c++)
      losses.forEach((name, k) => {
        const lost = this.body.arrays[name].at(to, c) - this.body.arrays[name].at(from, c);
        sums[kinds[c]][k] += lost;
        if (lit.has(c)) sums[interfaces.length][k] += lost;
      });
    const ends = [from, to].map((k) => this.frames[k]);
    made(
      "h4",
      `Energy that contacts lost [J], rounded to frames ${ends[0].number} to ${ends[1].number}: ` +
        this.placeOf(...ends.map((f) => f.row)),
      host,
    );
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

  // As the energies of the history are called.
  nameOfLoss(name) {
    const column = `dissipated_${name.replace("lost_", "")}_J`,
      found = page.course.energy_out.find((e) => e.column === column);
    return found ? found.label : name.replace("lost_", "");
  }
}
