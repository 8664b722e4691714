// A canvas with a body: blocks in the colours of a field, cracks, isotherms, a line across, and what is lit.

import {ONE_SIDED, TWO_SIDED, colourAt, css, ink, mixed, phaseColours} from "./colours.js";
import {shown, ticks} from "./curves.js";
import {entry, made, number, unitOf} from "./elements.js";

export const MAGNIFICATIONS = [1, 2, 5, 10, 20, 50, 100]; // of displacements, to choose from
const BEHIND = 0.75; // share of the ground in faces that have no halo where others do
const MOST_PLACES = 16; // that are tried for the name of an isotherm
const STEEP = 1.2; // radians

// Sides of a circle, pixels.
function circle(x, y, r, count = 28) {
  const at = (k) => [x + r * Math.cos((2 * Math.PI * k) / count), y + r * Math.sin((2 * Math.PI * k) / count)];
  return Array.from({length: count}, (_, k) => [...at(k), ...at(k + 1)]);
}

// A round length, and at most so long.
function barLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((f) => f * power).find((length) => length <= most * 1.0001);
}

function distanceTo([x0, y0, x1, y1], x, y) {
  const along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2 || 1),
    share = Math.max(0, Math.min(1, along));
  return Math.hypot(x0 + share * (x1 - x0) - x, y0 + share * (y1 - y0) - y);
}

// Turn of the line through points, radians, so that a text along it stands upright.
function slope(points) {
  const count = points.length,
    [mx, my] = [0, 1].map((k) => points.reduce((sum, p) => sum + p[k], 0) / count);
  let [xx, xy, yy] = [0, 0, 0];
  for (const [x, y] of points) {
    xx += (x - mx) ** 2;
    xy += (x - mx) * (y - my);
    yy += (y - my) ** 2;
  }
  const turn = 0.5 * Math.atan2(2 * xy, xx - yy);
  return turn > STEEP ? turn - Math.PI : turn; // upright names all read upwards
}

export class Specimen {
  constructor(canvas, body) {
    Object.assign(this, {canvas, body, frame: 0, colour: "material", cracks: "mode", magnification: 1});
    this.lit = null; // contacts with a halo, a Set
    this.ringed = new Set(); // contacts
    this.isOfDamage = false; // whether contacts damaged by less than a half are drawn too
    this.caption = ""; // over the picture
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
    const {colour} = this.strokeOf(c, theme),
      isBehind = this.lit && this.lit.size && !this.lit.has(c);
    return isBehind ? mixed(colour, theme.numbers("--ground"), BEHIND) : colour;
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
    const lit = this.lit || new Set();
    const addCracks = (contacts, least) => {
      const groups = new Map();
      for (const c of contacts) {
        const line = body.line(c);
        if (!isFinite(line[0]) || this.isCovered(line)) continue;
        const key = this.strokeOf(c, theme);
        if (!groups.has(key.name)) groups.set(key.name, {...key, lines: []});
        groups.get(key.name).lines.push(line);
      }
      for (const g of [...groups.values()].sort((p, q) => p.order - q.order))
        add(css(g.colour), Math.max(g.width, least), g.lines);
    };
    const hasCracks = body.modes.length && this.cracks !== "none";
    if (this.isOfDamage && hasCracks) this.addDamaged(add, theme);
    if (hasCracks) addCracks(body.cracks(frame).filter((c) => !lit.has(c)), 0);
    const halo = [...lit].map((c) => body.line(c)).filter((l) => isFinite(l[0]));
    add(theme.value("--lit"), 7, halo);
    add(theme.value("--ground"), 4.6, halo);
    if (hasCracks) addCracks(lit, 2.6);
    const rings = [...this.ringed].map((c) => body.line(c)).filter((l) => isFinite(l[0]));
    for (const [name, width] of [
      ["--ground", 5],
      ["--lit", 2.4],
    ])
      add(
        theme.value(name),
        width,
        rings.flatMap(([x0, y0, x1, y1]) => circle((x0 + x1) / 2, (y0 + y1) / 2, 11 * ratio)),
      );
    return all;
  }

  // Whether a platen covers the middle of a line, and is not to be looked through.
  isCovered([x0, y0, x1, y1]) {
    const [x, y] = [(x0 + x1) / 2, (y0 + y1) / 2].map(Math.floor);
    return !this.showsCovered && this.inksOfBearings.has(this.pixels[y * this.W + x]);
  }

  // Contacts that are damaged by a half at most, by their mode.
  addDamaged(add, theme) {
    const {body, frame} = this,
      lines = Object.fromEntries(body.modes.map((mode) => [mode, []])),
      shownAsCracks = new Set(body.cracks(frame));
    for (let c = 0; c < body.contacts; c++) {
      const [mode, damage] = body.worst(frame, c),
        line = damage > 0 && !shownAsCracks.has(c) ? body.line(c) : [NaN];
      if (isFinite(line[0]) && !this.isCovered(line)) lines[mode].push(line);
    }
    for (const mode of body.modes) add(theme.value(`--${mode}-tint`), 1, lines[mode]);
  }

  // Texts over the picture, [{text, x, y, align}], and the bar that tells its scale.
  labels() {
    const {body, W, H, ratio, caption, magnification} = this,
      length = barLength((0.22 * W) / body.scale),
      right = W - 8 * ratio,
      left = right - length * body.scale,
      low = H - 6 * ratio,
      texts = [{text: `${shown(1e3 * length)} mm`, x: left - 6 * ratio, y: low + 2 * ratio, align: "right"}];
    if (body.moves && magnification)
      texts.push({
        text: `displacements ×${magnification}`,
        x: (body.axes ? 64 : 6) * ratio, // beside the axes
        y: low + 2 * ratio,
        align: "left",
      });
    if (caption) texts.push({text: caption, x: 6 * ratio, y: 13 * ratio, align: "left"});
    const tick = 3 * ratio;
    return {
      texts,
      bar: [
        [left, low, right, low],
        [left, low - tick, left, low + tick],
        [right, low - tick, right, low + tick],
      ],
    };
  }

  drawLabels(theme) {
    const {texts, bar} = this.labels(),
      {context, ratio} = this;
    this.stroke(theme.value("--ground"), 4 * ratio, bar);
    this.stroke(theme.value("--ink"), 1.6 * ratio, bar);
    for (const {text, x, y, align} of texts) this.write(theme, text, x, y, align);
    context.textAlign = "center";
  }

  // A text that can be read on anything.
  write(theme, text, x, y, align = "center") {
    const {context, ratio} = this;
    Object.assign(context, {
      font: `${12 * ratio}px system-ui, sans-serif`,
      textAlign: align,
      lineWidth: 4 * ratio,
      lineJoin: "round",
      strokeStyle: theme.value("--ground"),
      fillStyle: theme.value("--ink"),
    });
    context.strokeText(text, x, y);
    context.fillText(text, x, y);
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
    this.inksOfBearings = new Set();
    body.paint(this.pixels, W, H, (b) => {
      let value = inks.get(b);
      if (value === undefined) inks.set(b, (value = ink(colour(b))));
      if (b < body.blocks && body.bearing[b]) this.inksOfBearings.add(value);
      return value;
    });
    context.putImageData(this.image, 0, 0);
    if (body.axes) this.drawFrame(theme);
    context.lineCap = "round";
    for (const {colour: stroke, width, lines} of this.strokes(theme)) this.stroke(stroke, width, lines);
    if (body.hasIsotherms) this.drawIsotherms(theme);
    if (this.across) this.drawAcross(theme);
    if (this.probe) this.drawProbe(theme);
    this.drawLabels(theme);
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
    const {body, frame, context, ratio} = this,
      values = body.values("temperature", frame);
    let low = Infinity,
      high = -Infinity;
    for (let b = 0; b < body.blocks; b++)
      if (!body.bearing[b]) {
        low = Math.min(low, values[b]);
        high = Math.max(high, values[b]);
      }
    const drawn = (high - low < 2 ? [] : ticks(low, high, 6).filter((t) => t > low && t < high))
        .map((level) => ({level, lines: body.isotherms(frame, level)}))
        .filter((one) => one.lines.length), // a plane through a solid may meet none
      lines = drawn.map((one) => one.lines);
    this.levels = drawn.map((one) => one.level);
    this.stroke(theme.value("--ground"), 2.6 * ratio, lines.flat());
    this.stroke(theme.value("--ink"), 1 * ratio, lines.flat());
    this.named = []; // places of the names of lines: [x, y, turn]
    this.levels.forEach((level, k) => {
      const others = lines.flatMap((l, n) => (n === k ? [] : l)),
        place = this.placeOfName(lines[k], others);
      if (!place) return;
      this.named.push(place);
      context.save();
      context.translate(place[0], place[1]);
      context.rotate(place[2]);
      this.write(theme, `${shown(level)} °C`, 0, 4 * ratio);
      context.restore();
    });
  }

  // Where the name of an isotherm fits along it: far from other lines and from other names; null where nothing fits.
  placeOfName(lines, others) {
    const {W, H, ratio} = this,
      half = 22 * ratio, // of a name's length
      away = (x, y) => others.reduce((least, line) => Math.min(least, distanceTo(line, x, y)), Infinity);
    let best = null,
      most = 8 * ratio;
    const middles = lines.map(([x0, y0, x1, y1]) => [(x0 + x1) / 2, (y0 + y1) / 2]),
      each = Math.max(1, Math.floor(middles.length / MOST_PLACES));
    for (let i = 0; i < middles.length; i += each) {
      const [x, y] = middles[i];
      const isNear = (other, reach) => Math.hypot(x - other[0], y - other[1]) < reach * half;
      if (this.named.some((other) => isNear(other, 2.6))) continue;
      if ([...this.ringed].some((c) => isNear(this.body.line(c), 1.8))) continue;
      const turn = slope(middles.filter(([p, q]) => Math.hypot(p - x, q - y) < half)),
        [dx, dy] = [0.8 * half * Math.cos(turn), 0.8 * half * Math.sin(turn)];
      const [wide, high] = [dx, dy].map((v) => 1.4 * Math.abs(v) + 8 * ratio);
      if (x < wide || y < high || x > W - wide || y > H - high) continue;
      const room = Math.min(away(x, y), away(x - dx, y - dy), away(x + dx, y + dy), 3 * half);
      if (room > most) [best, most] = [[x, y, turn], room];
    }
    return best;
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

  // Places on the line across, with the block that lies there: [{at, block, i, j, p, q}]. `at` is where the body was
  // made, from the first of these places along the line, m: displacements do not lengthen it.
  samples(count = 160) {
    const {body, W, H} = this,
      [x0, y0, x1, y1] = this.across,
      found = [];
    for (let k = 0; k <= count; k++) {
      const x = (x0 + ((x1 - x0) * k) / count) * W,
        y = (y0 + ((y1 - y0) * k) / count) * H;
      const block = body.at(x, y, W, H, this.frame, 0).block;
      if (block < 0 || body.bearing[block]) continue;
      found.push({block, ...body.within(block, x, y)});
    }
    if (found.length < 2) return found;
    const [from, to] = [found[0].rest, found[found.length - 1].rest],
      way = [to[0] - from[0], to[1] - from[1]],
      length = Math.hypot(...way) || 1;
    for (const one of found) one.at = ((one.rest[0] - from[0]) * way[0] + (one.rest[1] - from[1]) * way[1]) / length;
    return found;
  }

  // Values of the coloured field at samples in a frame: of temperature between the corners, else of the block.
  valuesAt(samples, field, frame) {
    const {body} = this;
    if (field !== "temperature" || !body.hasIsotherms) return samples.map((s) => body.values(field, frame)[s.block]);
    return samples.map(
      ({block, i, j, p, q}) =>
        (1 - p - q) * body.temperatureAmid(frame, block) +
        p * body.temperatureAt(frame, i) +
        q * body.temperatureAt(frame, j),
    );
  }
}

// Into a key: the scale of a field that blocks are coloured by.
export function tellScale(key, body, field) {
  const {low, high, isTwoSided} = body.range(field),
    stops = isTwoSided ? TWO_SIDED : ONE_SIDED,
    scale = made("span", null, key, "scale");
  scale.append(number(low));
  made("i", null, scale).style.background = `linear-gradient(90deg, ${stops.map(css).join(", ")})`;
  scale.append(`${number(high)} ${unitOf(body.fields.find((f) => f[0] === field)[1])}`);
  if (field.startsWith("stress")) key.append("tension positive");
}

// Into a key: cracks by their mode.
export function tellModes(key, body) {
  for (const mode of body.modes)
    key.append(
      entry({name: `${mode}, broken`, colour: `var(--${mode})`}),
      entry({name: `${mode}, damaged by more than half`, colour: `var(--${mode}-tint)`}),
    );
}
