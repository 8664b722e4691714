// A solid, shown as a plane through it by the painter of plane bodies. A plane cuts each polyhedron, which is convex,
// in a convex polygon; it goes with the body, so that displacements along it alone are seen.

import {Body, SIDES, takeIn} from "./body.js";

const IN_PLANE = {x: [2, 1], y: [0, 2], z: [0, 1]}; // axes that a view across x, y, z has to the right and up

// What all views of a solid have.
export class SolidBody extends Body {
  // Overrides what the constructor of a plane body asks for.
  prepare() {
    const a = this.arrays;
    this.blocks = a.material.shape[0];
    this.contacts = a.extent ? a.extent.shape[0] : 0;
    this.points = a.point.shape[0];
    this.bearing = Uint8Array.from(a.material.values, (m) => this.about.materials[m].bearing);
    this.nodes = a.node && a.node.values;
    this.nodesFirst = a.point_first.values;
    this.middles = new Float64Array(3 * this.blocks);
    this.ends = [
      [Infinity, -Infinity],
      [Infinity, -Infinity],
      [Infinity, -Infinity],
    ]; // of the specimen along each axis
    for (let b = 0; b < this.blocks; b++) {
      const from = a.point_first.values[b],
        to = a.point_first.values[b + 1];
      for (let i = from; i < to; i++)
        for (let k = 0; k < 3; k++) {
          const v = a.point.at(i, k);
          this.middles[3 * b + k] += v / (to - from);
          if (!this.bearing[b]) this.ends[k] = [Math.min(this.ends[k][0], v), Math.max(this.ends[k][1], v)];
        }
    }
    this.blockOf = new Int32Array(this.points);
    for (let b = 0; b < this.blocks; b++) this.blockOf.fill(b, a.point_first.values[b], a.point_first.values[b + 1]);
    if (this.contacts) this.prepareContacts();
  }

  // The blocks that contacts join, and the cells that contacts are drawn as: their point, the middle of the next edge,
  // that of the face, and that of the edge before.
  prepareContacts() {
    const {cell, face, face_triangle: of, triangle_face: faces, middle, point, triangle} = this.arrays,
      blocks = new Int32Array(2 * middle.shape[0]).fill(-1);
    of.values.forEach((t, k) => {
      const b = this.blockOf[triangle.values[3 * t]],
        f = 2 * faces.values[k];
      if (blocks[f] < 0) blocks[f] = b;
      else if (blocks[f] !== b) blocks[f + 1] = b;
    });
    this.beside = Int32Array.from({length: 2 * this.contacts}, (_, i) => blocks[2 * face.values[i >> 1] + (i & 1)]);
    this.cells = new Float64Array(12 * this.contacts);
    for (let c = 0; c < this.contacts; c++)
      for (let k = 0; k < 3; k++) {
        const [at, next, before] = [0, 1, 2].map((e) => point.at(cell.values[3 * c + e], k));
        [at, (at + next) / 2, middle.at(face.values[c], k), (at + before) / 2].forEach((v, e) => {
          this.cells[12 * c + 3 * e + k] = v;
        });
      }
  }

  // How a place of a block moves, m.
  motion(frame, b, [x, y, z]) {
    const u = this.displacement(frame, b),
      w = ["x", "y", "z"].map((axis) => this.arrays[`turn_${axis}`].at(frame, b)),
      [dx, dy, dz] = [x - this.middles[3 * b], y - this.middles[3 * b + 1], z - this.middles[3 * b + 2]];
    return [u[0] + w[1] * dz - w[2] * dy, u[1] + w[2] * dx - w[0] * dz, u[2] + w[0] * dy - w[1] * dx];
  }

  // Where a place of a contact is in a frame: between its two blocks.
  moved(c, place, {frame, magnification}) {
    const [p, q] = [0, 1].map((k) => this.motion(frame, this.beside[2 * c + k], place));
    return place.map((v, k) => v + (magnification * (p[k] + q[k])) / 2);
  }

  blocksBeside(c) {
    return [this.beside[2 * c], this.beside[2 * c + 1]];
  }

  get moves() {
    return "shift_x" in this.arrays;
  }

  // Displacement of the middle of a block, m.
  displacement(frame, b) {
    return ["x", "y", "z"].map((axis) => this.arrays[`shift_${axis}`].at(frame, b));
  }

  whereBlock(b) {
    return [0, 1, 2].map((k) => this.middles[3 * b + k]);
  }
  whereContact(c) {
    return [...this.cells.subarray(12 * c, 12 * c + 3)];
  }
  contactNumber(c) {
    return this.arrays.number.values[c];
  }
}

// A plane through a solid, across one of its axes.
export class CutBody extends SolidBody {
  prepare() {
    super.prepare();
    const {triangle} = this.arrays;
    this.trianglesOf = Array.from({length: this.blocks}, () => []);
    for (let t = 0; t < triangle.shape[0]; t++) this.trianglesOf[this.blockOf[triangle.values[3 * t]]].push(t);
    // a plane that goes into the depth below the heated face
    this.look(["front", "back"].includes(this.about.heated_face) ? "x" : "z", 0.5);
  }

  // Puts the plane across an axis at a share of the specimen's size.
  look(axis, share) {
    Object.assign(this, {axis, share});
    const [right, up] = IN_PLANE[axis],
      k = "xyz".indexOf(axis),
      polygons = [];
    this.offset = this.ends[k][0] + share * (this.ends[k][1] - this.ends[k][0]);
    for (let b = 0; b < this.blocks; b++) {
      const corners = this.cut(b, k, this.offset, right, up);
      if (corners.length > 2) polygons.push([b, corners]);
    }
    const count = polygons.reduce((sum, [, corners]) => sum + corners.length, 0);
    Object.assign(this, {
      right,
      up,
      k,
      corners: count,
      first: new Int32Array(polygons.length + 1),
      owner: new Int32Array(polygons.length),
      polygonOf: new Int32Array(this.blocks).fill(-1),
      rest: new Float64Array(3 * count),
      edges: new Int32Array(2 * count), // points that each corner lies between,
      shares: new Float64Array(count), // and the share of the second one in its values
      x: new Float64Array(count),
      y: new Float64Array(count),
      px: new Float64Array(count),
      py: new Float64Array(count),
    });
    let i = 0;
    polygons.forEach(([b, corners], p) => {
      this.owner[p] = b;
      this.polygonOf[b] = p;
      for (const {place, edge, share: s} of corners) {
        this.rest.set(place, 3 * i);
        this.edges.set(edge, 2 * i);
        this.shares[i++] = s;
      }
      this.first[p + 1] = i;
    });
    this.traces = this.cutCracks(k);
    this.box = this.bounds();
  }

  // Corners of the polygon in which a plane cuts a block, around its middle: where they are, and between which points.
  cut(b, k, at, right, up) {
    const {point, triangle} = this.arrays,
      found = [];
    let low = Infinity,
      high = -Infinity;
    const from = this.arrays.point_first.values[b],
      to = this.arrays.point_first.values[b + 1];
    for (let i = from; i < to; i++) {
      const v = point.at(i, k);
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
    if (at <= low || at >= high) return found;
    for (const t of this.trianglesOf[b])
      for (let e = 0; e < 3; e++) {
        const i = triangle.values[3 * t + e],
          j = triangle.values[3 * t + ((e + 1) % 3)];
        if (i > j) continue; // the other triangle of this edge has it too
        const p = point.at(i, k),
          q = point.at(j, k);
        if (p > at === q > at) continue;
        const s = (at - p) / (q - p);
        const place = [0, 1, 2].map((c) => point.at(i, c) + s * (point.at(j, c) - point.at(i, c)));
        found.push({place, edge: [i, j], share: s});
      }
    const middle = [right, up].map((c) => found.reduce((sum, p) => sum + p.place[c], 0) / found.length),
      turn = ({place}) => Math.atan2(place[up] - middle[1], place[right] - middle[0]);
    return found.sort((p, q) => turn(p) - turn(q));
  }

  // Ends of the line in which the plane cuts each crack, three coordinates each; NaN where it does not.
  cutCracks(k) {
    const ends = new Float64Array(6 * this.contacts).fill(NaN);
    for (let c = 0; c < this.contacts; c++) {
      const four = [0, 3, 6, 9].map((o) => [...this.cells.subarray(12 * c + o, 12 * c + o + 3)]),
        found = [];
      for (let e = 0; e < 4; e++) {
        const [p, q] = [four[e], four[(e + 1) % 4]];
        if (p[k] > this.offset === q[k] > this.offset) continue;
        const s = (this.offset - p[k]) / (q[k] - p[k]);
        found.push(...p.map((v, i) => v + s * (q[i] - v)));
      }
      if (found.length === 6) ends.set(found, 6 * c);
    }
    return ends;
  }

  cornersOf(block) {
    return [this.first[this.polygonOf[block]], this.first[this.polygonOf[block] + 1]];
  }
  temperatureAt(frame, i) {
    const {temperature} = this.arrays,
      [p, q] = [0, 1].map((e) => temperature.at(frame, this.nodes[this.edges[2 * i + e]]));
    return p + this.shares[i] * (q - p);
  }
  get sideNames() {
    return [this.right, this.up].map((k) => SIDES["xyz"[k]]);
  }
  madeAt(i) {
    return [this.rest[3 * i + this.right], this.rest[3 * i + this.up]];
  }

  bounds() {
    const box = {
      x0: this.ends[this.right][0],
      x1: this.ends[this.right][1],
      y0: this.ends[this.up][0],
      y1: this.ends[this.up][1],
    };
    for (let i = 0; i < this.corners; i++) takeIn(box, this.rest[3 * i + this.right], this.rest[3 * i + this.up]);
    const air = 0.09 * Math.max(box.x1 - box.x0, 0.6 * (box.y1 - box.y0));
    return {x0: box.x0 - air, x1: box.x1 + air, y0: box.y0 - 0.7 * air, y1: box.y1 + 0.7 * air};
  }

  place(frame, magnification) {
    const {rest, right, up} = this;
    this.placed = {frame, magnification};
    for (let p = 0; p < this.owner.length; p++) {
      const isGone = this.isGone(frame, this.owner[p]);
      for (let i = this.first[p]; i < this.first[p + 1]; i++) {
        if (isGone) {
          // a polygon without area
          [this.x[i], this.y[i]] = [right, up].map((k) => this.middles[3 * this.owner[p] + k]);
          continue;
        }
        const move = this.moves ? this.motion(frame, this.owner[p], rest.subarray(3 * i, 3 * i + 3)) : [0, 0, 0];
        this.x[i] = rest[3 * i + right] + magnification * move[right];
        this.y[i] = rest[3 * i + up] + magnification * move[up];
      }
    }
  }

  project(W, H) {
    super.project(W, H);
    const {x0, x1, y0, y1} = this.box;
    this.toPixels = (x, y) => [
      (W - this.scale * (x1 - x0)) / 2 + (x - x0) * this.scale,
      (H + this.scale * (y1 - y0)) / 2 - (y - y0) * this.scale,
    ];
  }

  // Cracks that the plane cuts.
  cracks(frame) {
    return super.cracks(frame).filter((c) => isFinite(this.traces[6 * c]));
  }

  line(c) {
    const {traces, right, up} = this;
    if (!isFinite(traces[6 * c])) return [NaN, NaN, NaN, NaN];
    return [0, 3].flatMap((end) => {
      const at = this.moved(c, [...traces.subarray(6 * c + end, 6 * c + end + 3)], this.placed);
      return this.toPixels(at[right], at[up]);
    });
  }
}

// A body of the plane, or a plane through a solid.
export const bodyOf = (about, arrays, frames) => new (about.solid ? CutBody : Body)(about, arrays, frames);
