// A body of the plane: its blocks painted line by line into pixels, each pixel with the block that it shows, and its
// cracks as lines. Blocks are convex; the same frame gives the same pixels on every machine.

const ON_SIDE = 1e-4; // of a side: how near to it corners count as on it
export const SIDES = {x: ["left side", "right side"], y: ["lower side", "upper side"], z: ["front side", "back side"]};
const HOTTER = 0.25; // of the span of temperatures: how much hotter a heated side is than the coolest at least
const ONCE_ALONG = 0.15; // of a side: how much longer or shorter a line along it may be

export class Body {
  constructor(about, arrays, frames) {
    Object.assign(this, {about, arrays, frames, ranges: {}, kept: {}, owner: null});
    this.prepare();
  }

  // Takes what never changes from the arrays.
  prepare() {
    const {about, arrays} = this;
    this.corners = arrays.corner.shape[0];
    this.blocks = arrays.material.shape[0];
    this.contacts = arrays.side.shape[0];
    this.first = arrays.first.values;
    this.side = arrays.side.values;
    this.x = new Float64Array(this.corners); // m, of the frame that is placed
    this.y = new Float64Array(this.corners);
    this.px = new Float64Array(this.corners); // the same in pixels
    this.py = new Float64Array(this.corners);
    this.bearing = Uint8Array.from(arrays.material.values, (m) => about.materials[m].bearing);
    this.nodes = Int32Array.from({length: this.corners}, (_, i) => i);
    this.nodesFirst = this.first;
    this.middle();
    this.box = this.bounds();
  }

  // Middles of the corners of each block, m, where they were made.
  middle() {
    const {corner} = this.arrays;
    this.middleX = new Float64Array(this.blocks);
    this.middleY = new Float64Array(this.blocks);
    for (let b = 0; b < this.blocks; b++) {
      const from = this.first[b],
        to = this.first[b + 1];
      for (let i = from; i < to; i++) {
        this.middleX[b] += corner.at(i, 0) / (to - from);
        this.middleY[b] += corner.at(i, 1) / (to - from);
      }
    }
  }

  bounds() {
    const {corner} = this.arrays;
    const box = {x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity};
    for (let i = 0; i < this.corners; i++) takeIn(box, corner.at(i, 0), corner.at(i, 1));
    const air = 0.07 * Math.max(box.x1 - box.x0, 0.6 * (box.y1 - box.y0));
    return {x0: box.x0 - air, x1: box.x1 + air, y0: box.y0 - 0.8 * air, y1: box.y1 + 0.8 * air};
  }

  get moves() {
    return "move_x" in this.arrays || "shift_x" in this.arrays;
  }
  get modes() {
    return this.about.modes;
  }

  // Displacement of the middle of a block, m.
  displacement(frame, block) {
    const a = this.arrays;
    if (a.shift_x) return [a.shift_x.at(frame, block), a.shift_y.at(frame, block)];
    let u = 0,
      v = 0;
    const from = this.first[block],
      to = this.first[block + 1];
    for (let i = from; i < to; i++) {
      u += a.move_x.at(frame, i) / (to - from);
      v += a.move_y.at(frame, i) / (to - from);
    }
    return [u, v];
  }

  // Makes the polygons of a view that has none before it is painted; here they are there.
  polygons() {}

  // Puts all corners where they are in a frame, with displacements magnified.
  place(frame, magnification) {
    const a = this.arrays,
      {x, y, corners} = this,
      {values: rest, step} = a.corner;
    for (let i = 0; i < corners; i++) {
      x[i] = step * rest[2 * i];
      y[i] = step * rest[2 * i + 1];
    }
    this.displace(frame, magnification);
    for (let b = 0; b < this.blocks; b++)
      if (this.isGone(frame, b))
        for (let i = this.first[b]; i < this.first[b + 1]; i++) [x[i], y[i]] = [this.middleX[b], this.middleY[b]];
  }

  // Whether a block has left the body by a frame.
  isGone(frame, b) {
    return "gone" in this.arrays && this.arrays.gone.at(frame, b) > 0.5;
  }

  displace(frame, magnification) {
    const {x, y, corners, arrays: a} = this;
    if (a.move_x) {
      const u = a.move_x.values,
        v = a.move_y.values,
        row = a.move_x.row(frame);
      const kx = magnification * a.move_x.step,
        ky = magnification * a.move_y.step;
      for (let i = 0; i < corners; i++) {
        x[i] += kx * u[row + i];
        y[i] += ky * v[row + i];
      }
    } else if (a.shift_x) {
      for (let b = 0; b < this.blocks; b++) {
        const turn = a.turn.at(frame, b),
          c = Math.cos(turn) - 1,
          s = Math.sin(turn);
        const u = a.shift_x.at(frame, b),
          v = a.shift_y.at(frame, b);
        for (let i = this.first[b]; i < this.first[b + 1]; i++) {
          const dx = x[i] - this.middleX[b],
            dy = y[i] - this.middleY[b];
          x[i] += magnification * (u + c * dx - s * dy);
          y[i] += magnification * (v + s * dx + c * dy);
        }
      }
    }
  }

  // Fields that blocks can be coloured by: id and label.
  get fields() {
    const a = this.arrays,
      all = [["material", "material"]];
    if (a.temperature) all.push(["temperature", "temperature [°C]"]);
    if (a.pore_pressure) all.push(["pore_pressure", "pore pressure [MPa]"], ["saturation", "saturation [–]"]);
    if (a.stress_y)
      all.push(
        ["stress_y", "vertical stress [MPa]"],
        ["stress_1", "largest principal stress [MPa]"],
        ["stress_2", "least principal stress [MPa]"],
      );
    if (this.moves) all.push(["displacement", "displacement [mm]"]);
    if (a.creep_y) all.push(["creep_y", "vertical creep strain [10⁻³]"]);
    return all;
  }

  // (B,) values of a field in a frame.
  values(field, frame) {
    const key = `${field} ${frame}`;
    if (this.kept.key === key) return this.kept.values;
    const values = new Float32Array(this.blocks),
      a = this.arrays;
    for (let b = 0; b < this.blocks; b++) {
      if (field === "temperature") {
        const nodes = this.nodesOf(b);
        for (const n of nodes) values[b] += a.temperature.at(frame, n) / nodes.length;
      } else if (field === "displacement") {
        values[b] = 1e3 * Math.hypot(...this.displacement(frame, b));
      } else values[b] = (field === "creep_y" ? 1e3 : 1) * a[field].at(frame, b);
    }
    this.kept = {key, values};
    return values;
  }

  // Where the temperatures of a block stand in their array: at its corners in the plane, all of them in space.
  nodesOf(b) {
    return this.nodes.subarray(this.nodesFirst[b], this.nodesFirst[b + 1]);
  }

  // Of a corner of what is painted, °C.
  temperatureAt(frame, i) {
    return this.arrays.temperature.at(frame, i);
  }

  // In the middle of the corners of the polygon that shows a block, °C.
  temperatureAmid(frame, block) {
    const [from, to] = this.cornersOf(block);
    let sum = 0;
    for (let i = from; i < to; i++) sum += this.temperatureAt(frame, i);
    return sum / (to - from);
  }

  // What the ends of the colours stand for, over all frames; a few largest values may lie beyond.
  range(field) {
    if (this.ranges[field]) return this.ranges[field];
    if (field === "temperature") return (this.ranges[field] = this.temperatureRange());
    const all = [];
    const every = Math.max(1, Math.floor(this.frames.length / 24));
    for (let f = this.frames.length - 1; f >= 0; f -= every) {
      const values = this.values(field, f);
      for (let b = 0; b < this.blocks; b++) if (!this.bearing[b]) all.push(values[b]);
    }
    all.sort((p, q) => p - q);
    const at = (share) => all[Math.min(all.length - 1, Math.floor(share * all.length))];
    if (field.startsWith("stress") || field.startsWith("creep")) {
      const most = Math.max(-at(0.004), at(0.996), 1e-9);
      return (this.ranges[field] = {low: -most, high: most, isTwoSided: true});
    }
    const high = at(0.99);
    return (this.ranges[field] = {low: 0, high: high > 0 ? high : 1, isTwoSided: false});
  }

  // Over all frames and corners, so that its end is the highest temperature that the run tells.
  temperatureRange() {
    const {values, width, step} = this.arrays.temperature,
      isOf = new Uint8Array(width);
    let [low, high] = [Infinity, -Infinity];
    for (let b = 0; b < this.blocks; b++) if (!this.bearing[b]) for (const n of this.nodesOf(b)) isOf[n] = 1;
    for (let k = 0; k < values.length; k++) {
      if (!isOf[k % width]) continue;
      if (values[k] < low) low = values[k];
      if (values[k] > high) high = values[k];
    }
    return {low: step * low, high: high > low ? step * high : step * low + 1, isTwoSided: false};
  }

  // Of each contact the step at which its damage by any mode was first found above a half; -1 where it never was.
  get crackStep() {
    return this.arrays.crack_step.values;
  }

  // Contacts that cracked behind one step and up to another.
  crackedBetween(from, to) {
    const found = new Set();
    if (this.modes.length)
      this.crackStep.forEach((step, c) => {
        if (step > from && step <= to) found.add(c);
      });
    return found;
  }

  // Steps of the first and the last crack; null without cracks.
  get ages() {
    if (this.agesKept) return this.agesKept;
    const steps = this.crackStep.filter((step) => step >= 0).sort();
    return (this.agesKept = steps.length ? [steps[0], steps[steps.length - 1]] : null);
  }

  // The mode with the largest damage of a contact, and that damage.
  worst(frame, contact) {
    let mode = null,
      most = 0;
    for (const name of this.modes) {
      const damage = this.arrays[`damage_${name}`].at(frame, contact);
      if (damage > most) [mode, most] = [name, damage];
    }
    return [mode, most];
  }

  // Contacts that a frame shows as cracks: between blocks that are there.
  cracks(frame) {
    const found = [...this.crackedBetween(-1, this.frames[frame].step)];
    if (!("gone" in this.arrays)) return found;
    return found.filter((c) => !this.blocksBeside(c).some((b) => this.isGone(frame, b)));
  }

  // The two blocks that a contact joins.
  blocksBeside(c) {
    if (!this.blockOfCorner) {
      this.blockOfCorner = new Int32Array(this.corners);
      for (let b = 0; b < this.blocks; b++) this.blockOfCorner.fill(b, this.first[b], this.first[b + 1]);
    }
    return [this.blockOfCorner[this.side[4 * c]], this.blockOfCorner[this.side[4 * c + 2]]];
  }

  // Ends of the line that a contact is drawn as, pixels.
  line(contact) {
    const [a, b, c, d] = this.side.subarray(4 * contact, 4 * contact + 4),
      {px, py} = this;
    return [
      (px[a] + px[c]) / 2,
      (py[a] + py[c]) / 2,
      (px[a] + px[b] + px[c] + px[d]) / 4,
      (py[a] + py[b] + py[c] + py[d]) / 4,
    ];
  }

  // Where a block's middle and a contact's corner were made, m.
  whereBlock(b) {
    return [this.middleX[b], this.middleY[b]];
  }
  whereContact(c) {
    return [0, 1].map((k) => this.arrays.corner.at(this.side[4 * c], k));
  }
  contactNumber(c) {
    return c;
  }
  get hasIsotherms() {
    return "temperature" in this.arrays;
  }

  // Angle of a contact's line from the horizontal, radians.
  steepness(c) {
    const {corner} = this.arrays,
      [a, b] = [this.side[4 * c], this.side[4 * c + 1]];
    return Math.atan2(corner.at(b, 1) - corner.at(a, 1), corner.at(b, 0) - corner.at(a, 0));
  }

  // Height over width of a picture.
  get shape() {
    return (this.box.y1 - this.box.y0) / (this.box.x1 - this.box.x0);
  }

  // Places of the corners in a picture of W x H pixels.
  project(W, H) {
    const {x0, x1, y0, y1} = this.box;
    const scale = Math.min(W / (x1 - x0), H / (y1 - y0));
    const left = (W - scale * (x1 - x0)) / 2,
      low = (H + scale * (y1 - y0)) / 2;
    for (let i = 0; i < this.corners; i++) {
      this.px[i] = left + (this.x[i] - x0) * scale;
      this.py[i] = low - (this.y[i] - y0) * scale;
    }
    this.scale = scale;
  }

  // Paints all blocks into pixels (0xAABBGGRR). `colour(b, p)` is that of a block, with the number of its polygon.
  // Returns the block of each pixel, -1 for none. Stretches are so short that loops take less time than `fill`.
  paint(pixels, W, H, colour) {
    if (!this.ids || this.ids.length !== W * H) this.ids = new Int32Array(W * H);
    const ids = this.ids.fill(-1),
      {py, first} = this;
    pixels.fill(0);
    const from = new Float64Array(H),
      to = new Float64Array(H);
    for (let p = 0; p + 1 < first.length; p++) {
      let top = Infinity,
        low = -Infinity;
      for (let i = first[p]; i < first[p + 1]; i++) {
        top = Math.min(top, py[i]);
        low = Math.max(low, py[i]);
      }
      const start = Math.max(0, Math.ceil(top - 0.5)),
        end = Math.min(H - 1, Math.floor(low - 0.5));
      if (end < start) continue;
      for (let y = start; y <= end; y++) {
        from[y] = Infinity;
        to[y] = -Infinity;
      }
      for (let i = first[p], before = first[p + 1] - 1; i < first[p + 1]; before = i++)
        this.edge(before, i, start, end, from, to);
      const b = this.owner ? this.owner[p] : p,
        ink = colour(b, p);
      for (let y = start; y <= end; y++) {
        const a = y * W + Math.max(0, Math.ceil(from[y] - 0.5)),
          z = y * W + Math.min(W, Math.ceil(to[y] - 0.5));
        for (let k = a; k < z; k++) {
          pixels[k] = ink;
          ids[k] = b;
        }
      }
    }
    this.closeSeams(pixels, W, H);
    return ids;
  }

  // Widens the stretch of each line of pixels by an edge of a block.
  edge(i, j, start, end, from, to) {
    const {px, py} = this,
      u = py[i] <= py[j] ? i : j,
      v = u === i ? j : i;
    const slope = (px[v] - px[u]) / (py[v] - py[u]);
    for (let y = Math.max(start, Math.ceil(py[u] - 0.5)); y <= Math.min(end, Math.ceil(py[v] - 0.5) - 1); y++) {
      const x = px[u] + (y + 0.5 - py[u]) * slope;
      if (x < from[y]) from[y] = x;
      if (x > to[y]) to[y] = x;
    }
  }

  // Magnified elastic jumps open seams of a pixel between blocks that hold together; those are no cracks.
  closeSeams(pixels, W, H) {
    const {ids} = this;
    for (let y = 1; y < H - 1; y++)
      for (let k = y * W + 1, last = y * W + W - 1; k < last; k++) {
        if (ids[k] >= 0) continue;
        const near = ids[k - 1] >= 0 && ids[k + 1] >= 0 ? k - 1 : ids[k - W] >= 0 && ids[k + W] >= 0 ? k - W : -1;
        if (near >= 0) {
          ids[k] = ids[near];
          pixels[k] = pixels[near];
        }
      }
  }

  // The block at a pixel, or -1, and the crack nearest to it within so many pixels, or -1.
  at(x, y, W, H, frame, reach) {
    const block = x >= 0 && y >= 0 && x < W && y < H && this.ids ? this.ids[Math.floor(y) * W + Math.floor(x)] : -1;
    let crack = -1,
      least = reach * reach;
    for (const c of this.cracks(frame)) {
      const [x0, y0, x1, y1] = this.line(c);
      const along = Math.max(
        0,
        Math.min(1, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2 || 1)),
      );
      const distance = (x0 + along * (x1 - x0) - x) ** 2 + (y0 + along * (y1 - y0) - y) ** 2;
      if (distance < least) [crack, least] = [c, distance];
    }
    return {block, crack};
  }

  // Corners of the polygon that shows a block: the first and the one behind the last.
  cornersOf(block) {
    return [this.first[block], this.first[block + 1]];
  }

  // Where a corner was made, m in the plane of the picture.
  madeAt(i) {
    return [this.arrays.corner.at(i, 0), this.arrays.corner.at(i, 1)];
  }

  // Of a pixel that shows a block: corners i and j of the triangle about the block's middle in which it lies, their
  // shares p and q of its values, and `rest`, where the place was made, m in the plane of the picture.
  within(block, x, y) {
    const {px, py} = this,
      [from, to] = this.cornersOf(block);
    let cx = 0,
      cy = 0;
    const middle = [0, 0];
    for (let i = from; i < to; i++) {
      cx += px[i] / (to - from);
      cy += py[i] / (to - from);
      this.madeAt(i).forEach((v, k) => {
        middle[k] += v / (to - from);
      });
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
    const {i, j, p, q} = best,
      [one, other] = [this.madeAt(i), this.madeAt(j)];
    return {...best, rest: middle.map((v, k) => (1 - p - q) * v + p * one[k] + q * other[k])};
  }

  // Names of the sides of a picture, across and upwards.
  get sideNames() {
    return [SIDES.x, SIDES.y];
  }

  // Polygons of the specimen: their block, first corner, and the one behind the last.
  *polygonsOfSpecimen() {
    for (let p = 0; p + 1 < this.first.length; p++) {
      const b = this.owner ? this.owner[p] : p;
      if (!this.bearing[b]) yield [b, this.first[p], this.first[p + 1]];
    }
  }

  // The side of the specimen that is hottest in a frame, and how deep below it, on average along it, temperatures lie:
  // [[temperature, m]]. Only those whose isotherm goes along that side from end to end, once.
  depths(frame, levels) {
    const box = {x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity},
      [x, y] = [0, 1].map((k) => Float64Array.from({length: this.corners}, (_, i) => this.madeAt(i)[k])),
      corners = [];
    for (const [, from, to] of this.polygonsOfSpecimen()) for (let i = from; i < to; i++) corners.push(i);
    for (const i of corners) takeIn(box, x[i], y[i]);
    const [[left, right], [lower, upper]] = this.sideNames;
    const sides = [
      {side: left, from: x, along: y, at: box.x0, sign: 1, length: box.y1 - box.y0},
      {side: right, from: x, along: y, at: box.x1, sign: -1, length: box.y1 - box.y0},
      {side: lower, from: y, along: x, at: box.y0, sign: 1, length: box.x1 - box.x0},
      {side: upper, from: y, along: x, at: box.y1, sign: -1, length: box.x1 - box.x0},
    ];
    for (const s of sides) {
      const on = corners.filter((i) => Math.abs(s.from[i] - s.at) < ON_SIDE * s.length);
      s.heat = on.reduce((sum, i) => sum + this.temperatureAt(frame, i), 0) / on.length;
    }
    const heats = corners.map((i) => this.temperatureAt(frame, i)),
      [low, high] = [Math.min, Math.max].map((end) => heats.reduce((p, q) => end(p, q), heats[0])),
      coolest = Math.min(...sides.map((s) => s.heat)),
      hot = sides.reduce((p, q) => (q.heat > p.heat ? q : p)),
      isAcross = hot.from === x,
      found = [];
    // a plane through a solid along its heated face has no such side
    for (const level of hot.heat - coolest > HOTTER * (high - low) ? levels : []) {
      let [run, sum] = [0, 0];
      for (const [x0, y0, x1, y1] of this.isotherms(frame, level, x, y)) {
        const along = isAcross ? Math.abs(y1 - y0) : Math.abs(x1 - x0),
          middle = isAcross ? (x0 + x1) / 2 : (y0 + y1) / 2;
        run += along;
        sum += along * hot.sign * (middle - hot.at);
      }
      if (Math.abs(run / hot.length - 1) < ONCE_ALONG) found.push([level, sum / run]);
    }
    return {side: hot.side, depths: found};
  }

  // Lines of equal temperature: pieces [x0, y0, x1, y1], by linear triangles about the middle of each block. px, py:
  // places of the corners, pixels if not given.
  isotherms(frame, level, px = this.px, py = this.py) {
    const found = [];
    for (const [, from, to] of this.polygonsOfSpecimen()) {
      let low = Infinity,
        high = -Infinity,
        t = 0,
        x = 0,
        y = 0;
      for (let i = from; i < to; i++) {
        const at = this.temperatureAt(frame, i);
        low = Math.min(low, at);
        high = Math.max(high, at);
        t += at / (to - from);
        x += px[i] / (to - from);
        y += py[i] / (to - from);
      }
      if (level < low || level > high) continue;
      for (let i = from; i < to; i++) {
        const j = i + 1 < to ? i + 1 : from;
        const three = [
          [x, y, t],
          [px[i], py[i], this.temperatureAt(frame, i)],
          [px[j], py[j], this.temperatureAt(frame, j)],
        ];
        const cut = [];
        for (let k = 0; k < 3; k++) {
          const [p, q] = [three[k], three[(k + 1) % 3]];
          if (p[2] < level === q[2] < level) continue;
          const s = (level - p[2]) / (q[2] - p[2]);
          cut.push(p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]));
        }
        if (cut.length === 4) found.push(cut);
      }
    }
    return found;
  }
}

// Makes a box hold a point.
export function takeIn(box, x, y) {
  box.x0 = Math.min(box.x0, x);
  box.x1 = Math.max(box.x1, x);
  box.y0 = Math.min(box.y0, y);
  box.y1 = Math.max(box.y1, y);
}
