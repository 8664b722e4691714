// A piece of the curve that is brushed out: what broke in it, and where the energy went.

class RunPiece extends RunCurve {
  brush(piece, isOver) {
    this.piece = piece;
    for (const chart of this.charts) chart.setPiece(piece);
    if (!isOver) return;
    if (this.body) {
      const [from, to] = piece.map((row) => this.course.column("step")[row]);
      this.show(this.frameAt(piece[1]), this.body.crackedBetween(from, to));
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
    if (rows.length) table(host, ["mode", "interface", "first damaged", "broken", `damaged [${unit}]`], rows);
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
    made("p", `Contacts lost from frame ${this.frames[from].number} to frame ${this.frames[to].number}, in J:`, host);
    table(
      host,
      ["interface", ...losses.map((name) => name.replace("lost_", ""))],
      rows.filter((row, k) => k === interfaces.length || sums[k].some((v) => v > 0)),
    );
  }
}
