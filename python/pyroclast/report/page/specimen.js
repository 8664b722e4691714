// A canvas with a body: blocks in the colours of a field, cracks, isotherms, a line across, and what is lit.

class Specimen {
  constructor(canvas, body) {
    Object.assign(this, {canvas, body, frame: 0, colour: "material", cracks: "mode", magnification: 1});
    this.lit = null; // contacts that stand out, a Set
    this.across = null; // a line [x0, y0, x1, y1], shares of the picture
    this.probe = null; // [x, y] pixels
    this.context = canvas.getContext("2d");
  }

  // Fits the picture into a width, and a share of the window's height. CSS pixels.
  size(width, most) {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const height = Math.min(width * this.body.shape, most);
    Object.assign(this, {
      ratio,
      W: Math.max(8, Math.round(width * ratio)),
      H: Math.max(8, Math.round(height * ratio)),
    });
    this.canvas.width = this.W;
    this.canvas.height = this.H;
    this.canvas.style.height = `${height}px`;
    this.image = this.context.createImageData(this.W, this.H);
    this.pixels = new Uint32Array(this.image.data.buffer);
  }

  // Colours of the theme, read once for each picture.
  theme() {
    const style = getComputedStyle(document.documentElement);
    const value = (name) => style.getPropertyValue(name).trim();
    const numbers = (name) =>
      value(name)
        .match(/[0-9a-f]{2}/gi)
        .map((t) => parseInt(t, 16));
    return {value, numbers, phases: phaseColours(this.body.about.materials, numbers), bearing: numbers("--bearing")};
  }

  // Colour of each block, and behind all blocks of each contact, [r, g, b].
  painter(theme) {
    const {body} = this,
      ofBlock = this.blockPainter(theme);
    return (b) => (b < body.blocks ? ofBlock(b) : this.faceColour(b - body.blocks, theme));
  }

  faceColour(c, theme) {
    return this.lit && this.lit.has(c) ? theme.numbers("--lit") : this.strokeOf(c, theme).colour;
  }

  blockPainter(theme) {
    const {body, colour, frame} = this,
      material = body.arrays.material.values;
    if (colour === "material") return (b) => theme.phases[material[b]];
    const values = body.values(colour, frame),
      {low, high, isTwoSided} = body.range(colour);
    const table = Array.from({length: 256}, (_, k) => colourAt(isTwoSided ? TWO_SIDED : ONE_SIDED, (k + 0.5) / 256));
    return (b) =>
      body.bearing[b]
        ? theme.bearing
        : table[Math.max(0, Math.min(255, Math.floor((256 * (values[b] - low)) / (high - low))))];
  }

  // What is drawn over the blocks: [{colour, width, lines}], widths in pixels.
  strokes(theme) {
    const {body, frame, ratio} = this,
      all = [];
    const add = (colour, width, lines) => {
      if (lines.length) all.push({colour, width: width * ratio, lines});
    };
    if (body.modes.length && this.cracks !== "none") {
      const groups = new Map();
      for (const c of body.cracks(frame)) {
        const key = this.strokeOf(c, theme);
        if (!groups.has(key.name)) groups.set(key.name, {...key, lines: []});
        groups.get(key.name).lines.push(body.line(c));
      }
      for (const g of [...groups.values()].sort((p, q) => p.order - q.order)) add(css(g.colour), g.width, g.lines);
    }
    if (this.lit && this.lit.size) {
      const lines = [...this.lit].map((c) => body.line(c)).filter((l) => isFinite(l[0]));
      add(theme.value("--ground"), 6, lines);
      add(theme.value("--lit"), 3.6, lines);
    }
    return all;
  }

  strokeOf(c, theme) {
    const {body, frame, cracks} = this;
    if (cracks === "opening") {
      const opening = Math.max(0, 1e6 * body.arrays.opening.at(frame, c));
      const k = Math.min(5, Math.floor(Math.log2(1 + opening / 5))); // 5, 15, 35, 75, 155 µm
      return {name: `o${k}`, colour: colourAt(ONE_SIDED, (k + 1.5) / 7), width: 0.8 + 0.5 * k, order: k};
    }
    if (cracks === "age") {
      const [first, last] = body.ages,
        k = Math.round((11 * (body.crackStep[c] - first)) / Math.max(1, last - first));
      return {name: `a${k}`, colour: colourAt(ONE_SIDED, 0.95 - (0.8 * k) / 11), width: 1.6, order: k};
    }
    const [mode, damage] = body.worst(frame, c),
      whole = damage >= 1;
    return {
      name: `${mode}${whole}`,
      colour: theme.numbers(whole ? `--${mode}` : `--${mode}-tint`),
      width: whole ? (mode === "shear" ? 1.4 : 2.4) : 0.9,
      order: whole ? (mode === "shear" ? 3 : 2) : 1,
    };
  }

  draw() {
    const {body, frame, W, H, context} = this,
      theme = this.theme();
    Object.assign(body, {lit: this.lit, crackColoured: this.cracks !== "none"});
    body.place(frame, this.magnification);
    body.project(W, H);
    const colour = this.painter(theme),
      inks = new Map();
    body.paint(this.pixels, W, H, (b) => {
      let value = inks.get(b);
      if (value === undefined) inks.set(b, (value = ink(colour(b))));
      return value;
    });
    context.putImageData(this.image, 0, 0);
    if (body.axes) this.drawFrame(theme);
    context.lineCap = "round";
    for (const {colour: stroke, width, lines} of this.strokes(theme)) this.stroke(stroke, width, lines);
    if (body.hasIsotherms) this.drawIsotherms(theme);
    if (this.across) this.drawAcross(theme);
    if (this.probe) this.drawProbe(theme);
  }

  stroke(colour, width, lines) {
    const {context} = this;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    for (const [x0, y0, x1, y1] of lines) {
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
    }
    context.stroke();
  }

  drawIsotherms(theme) {
    const {body, frame, context, ratio, H} = this,
      values = body.values("temperature", frame);
    let low = Infinity,
      high = -Infinity;
    for (let b = 0; b < body.blocks; b++)
      if (!body.bearing[b]) {
        low = Math.min(low, values[b]);
        high = Math.max(high, values[b]);
      }
    this.levels = high - low < 2 ? [] : ticks(low, high, 6).filter((t) => t > low && t < high);
    this.levels.forEach((level, k) => {
      const lines = body.isotherms(frame, level);
      this.stroke(theme.value("--ground"), 2.6 * ratio, lines);
      this.stroke(theme.value("--ink"), 1 * ratio, lines);
      if (!lines.length) return;
      const height = H * (0.16 + 0.06 * (k % 8)); // one below the other, as lines may run close together
      const [x, y] = lines.reduce((p, q) => (Math.abs(q[1] - height) < Math.abs(p[1] - height) ? q : p));
      context.font = `${11 * ratio}px system-ui, sans-serif`;
      context.textAlign = "center";
      context.lineWidth = 3 * ratio;
      context.strokeStyle = theme.value("--ground");
      context.fillStyle = theme.value("--ink");
      const text = `${shown(level)} °C`;
      context.strokeText(text, x, y);
      context.fillText(text, x, y);
    });
  }

  // What tells how a solid is turned: its axes, and the box around it where its blocks are not shown.
  drawFrame(theme) {
    const {body, context, ratio, H} = this,
      [x, y] = [30 * ratio, H - 30 * ratio],
      ends = body.triad(20 * ratio);
    if (body.alone) this.stroke(theme.value("--faint"), 0.6 * ratio, body.frameLines);
    this.stroke(
      theme.value("--ink"),
      1.2 * ratio,
      ends.map((end) => [x, y, x + end.x, y + end.y]),
    );
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = theme.value("--ink");
    for (const end of ends)
      if (Math.hypot(end.x, end.y) > 4 * ratio) context.fillText(end.name, x + 1.4 * end.x, y + 1.4 * end.y);
    context.textBaseline = "alphabetic";
  }

  drawAcross(theme) {
    const {W, H, ratio} = this,
      [x0, y0, x1, y1] = this.across;
    const line = [[x0 * W, y0 * H, x1 * W, y1 * H]];
    this.stroke(theme.value("--ground"), 4 * ratio, line);
    this.stroke(theme.value("--accent"), 2 * ratio, line);
  }

  drawProbe(theme) {
    const {ratio} = this,
      [x, y] = this.probe,
      r = 8 * ratio;
    const cross = [
      [x - r, y, x + r, y],
      [x, y - r, x, y + r],
    ];
    this.stroke(theme.value("--ground"), 4 * ratio, cross);
    this.stroke(theme.value("--accent"), 1.6 * ratio, cross);
  }

  // Places on the line across, from its start, m, with the block that lies there: [{at, block, corners, shares}].
  samples(count = 160) {
    const {body, W, H} = this,
      [x0, y0, x1, y1] = this.across,
      found = [];
    for (let k = 0; k <= count; k++) {
      const x = (x0 + ((x1 - x0) * k) / count) * W,
        y = (y0 + ((y1 - y0) * k) / count) * H;
      const block = body.at(x, y, W, H, this.frame, 0).block;
      if (block < 0 || body.bearing[block]) continue;
      found.push({
        at: (Math.hypot((x1 - x0) * W, (y1 - y0) * H) * k) / count / body.scale,
        block,
        ...this.within(block, x, y),
      });
    }
    return found;
  }

  // Corners i and j of the triangle about a block's middle in which a place lies, and their shares of its values.
  within(block, x, y) {
    const {body} = this;
    if (!body.hasIsotherms) return {};
    const {px, py, first} = body,
      from = first[block],
      to = first[block + 1];
    let cx = 0,
      cy = 0;
    for (let i = from; i < to; i++) {
      cx += px[i] / (to - from);
      cy += py[i] / (to - from);
    }
    let best = {i: from, j: from, p: 0, q: 0, least: -Infinity};
    for (let i = from; i < to; i++) {
      const j = i + 1 < to ? i + 1 : from;
      const [ax, ay, bx, by] = [px[i] - cx, py[i] - cy, px[j] - cx, py[j] - cy],
        area = ax * by - ay * bx;
      const p = ((x - cx) * by - (y - cy) * bx) / area,
        q = (ax * (y - cy) - ay * (x - cx)) / area;
      const least = Math.min(p, q, 1 - p - q);
      if (least > best.least) best = {i, j, p, q, least};
    }
    return best;
  }

  // Values of the coloured field at samples in a frame: of temperature between the corners, else of the block.
  valuesAt(samples, field, frame) {
    const {body} = this,
      values = body.values(field, frame),
      t = body.arrays.temperature;
    if (field !== "temperature" || !body.hasIsotherms) return samples.map((s) => values[s.block]);
    return samples.map((s) => (1 - s.p - s.q) * values[s.block] + s.p * t.at(frame, s.i) + s.q * t.at(frame, s.j));
  }
}

// Of each material a colour: the named ones as in the figures, bearings dark, others in turn.
function phaseColours(materials, numbers) {
  let more = 0;
  return materials.map(({name, bearing}) =>
    bearing
      ? numbers("--bearing")
      : ["aggregate", "mortar"].includes(name)
        ? numbers(`--${name}`)
        : numbers(`--phase-${more++ % 4}`),
  );
}
