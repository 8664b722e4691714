// A solid from outside, in parallel projection: triangles of its outline, of faces that cracked, and of those that
// blocks bared as they left. A graphics card finds the nearest triangle of each pixel by WebGL. Without one the painter
// of plane bodies paints them from the farthest to the nearest: it is faster than WebGL by the processor.

import {SolidBody} from "./solid.js";

const DARKEST = 0.62; // of a colour on a face that is seen from the side, as in figures
const [BEGIN_AZIMUTH, BEGIN_HEIGHT] = [0.72, 0.43]; // radians, of a view from the right, above and before
const SEEN_FROM = {left: [-1, 1, 1], bottom: [1, -1, 1], front: [1, 1, -1]}; // heated faces that this view hides
const MOST_ZOOM = 12;
const BY_PROCESSOR = /swiftshader|llvmpipe|softpipe|software|basic render/i; // names of WebGL without a graphics card

// A colour 0xAABBGGRR with a share of its brightness.
const shaded = (value, share) =>
  ((value & 0xff000000) |
    (Math.round((value & 0xff) * share) |
      (Math.round(((value >> 8) & 0xff) * share) << 8) |
      (Math.round(((value >> 16) & 0xff) * share) << 16))) >>>
  0;
const brightness = (light) => DARKEST + (1 - DARKEST) * light;

export class OutsideBody extends SolidBody {
  prepare() {
    super.prepare();
    const {outer, face, face_triangle: of, triangle_face: faces, bared, bared_by: by} = this.arrays;
    this.outline = [];
    outer.values.forEach((is, t) => is && this.outline.push(t));
    this.faces = face ? {of: of.values, on: faces.values, count: faces.values.length} : {of: [], on: [], count: 0};
    this.bared = bared ? {of: bared.values, by: by.values} : {of: [], by: []};
    this.space = new Float32Array(3 * this.points); // m, places in the frame, from the middle of the specimen
    this.view = new Float32Array(3 * this.points); // the same as the eye sees them
    this.first = new Int32Array(1); // of polygons, which only the painter makes
    Object.assign(this, {alone: false, zoom: 1, aside: [0, 0], raster: undefined});
    this.size();
    const [x, y, z] = SEEN_FROM[this.about.heated_face] || [1, 1, 1];
    this.look(Math.atan2(x * Math.sin(BEGIN_AZIMUTH), z * Math.cos(BEGIN_AZIMUTH)), y * BEGIN_HEIGHT);
  }

  get hasIsotherms() {
    return false;
  }

  // Middle and box of what all directions show, m.
  size() {
    const {point} = this.arrays,
      low = [Infinity, Infinity, Infinity],
      high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.points; i++)
      for (let k = 0; k < 3; k++) {
        low[k] = Math.min(low[k], point.at(i, k));
        high[k] = Math.max(high[k], point.at(i, k));
      }
    this.low = low;
    this.centre = low.map((v, k) => (v + high[k]) / 2);
    this.half = high.map((v, k) => (v - low[k]) / 2);
    this.radius = Math.hypot(...this.half);
    const air = 1.06,
      wide = air * Math.hypot(this.half[0], this.half[2]);
    this.box = {x0: -wide, x1: wide, y0: -air * this.radius, y1: air * this.radius};
  }

  // Turns the eye to an angle around the y axis, from z, and above the horizontal; radians.
  look(azimuth, height) {
    const h = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, height)),
      [c, s, ch, sh] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(h), Math.sin(h)];
    Object.assign(this, {azimuth, height: h});
    this.axes = [
      [c, 0, -s],
      [-s * sh, ch, -c * sh],
      [s * ch, sh, c * ch],
    ]; // to the right, up, towards the eye
  }

  lookFrom(axis, side) {
    if (axis === "y") this.look(0, (side * Math.PI) / 2);
    else this.look(axis === "x" ? (side * Math.PI) / 2 : side > 0 ? 0 : Math.PI, 0);
    this.zoomBy(0);
  }

  turnBy(right, up) {
    this.look(this.azimuth - right, this.height + up);
  }

  // Zooms about a place that stays where it is, m in the picture; 0: to all of it again.
  zoomBy(factor, x = 0, y = 0) {
    const zoom = Math.max(1, Math.min(MOST_ZOOM, this.zoom * factor)),
      kept = this.zoom / zoom;
    this.aside = zoom === 1 ? [0, 0] : [x - (x - this.aside[0]) * kept, y - (y - this.aside[1]) * kept];
    this.zoom = zoom;
  }

  // Where a pixel lies in the picture, m.
  fromPixels(x, y, W, H) {
    return [(x - W / 2) / this.scale + this.aside[0], (H / 2 - y) / this.scale + this.aside[1]];
  }

  place(frame, magnification) {
    const a = this.arrays,
      {centre, middles, space} = this,
      {values: rest, step} = a.point,
      m = this.moves ? magnification : 0;
    this.placed = {frame, magnification: m};
    for (let b = 0; b < this.blocks; b++) {
      const u = m ? this.displacement(frame, b) : [0, 0, 0],
        w = m ? ["x", "y", "z"].map((axis) => a[`turn_${axis}`].at(frame, b)) : [0, 0, 0];
      const [mx, my, mz] = middles.subarray(3 * b, 3 * b + 3),
        isGone = this.isGone(frame, b);
      for (let i = a.point_first.values[b]; i < a.point_first.values[b + 1]; i++) {
        const x = step * rest[3 * i],
          y = step * rest[3 * i + 1],
          z = step * rest[3 * i + 2],
          dx = x - mx,
          dy = y - my,
          dz = z - mz;
        space[3 * i] = x - centre[0] + m * (u[0] + w[1] * dz - w[2] * dy);
        space[3 * i + 1] = y - centre[1] + m * (u[1] + w[2] * dx - w[0] * dz);
        space[3 * i + 2] = z - centre[2] + m * (u[2] + w[0] * dy - w[1] * dx);
        if (isGone) for (let k = 0; k < 3; k++) space[3 * i + k] = middles[3 * b + k] - centre[k];
      }
    }
    this.choose(frame);
  }

  // Triangles that are shown, each with what it shows: a block, or behind all blocks a contact, for a face that
  // cracked the one that is damaged most.
  choose(frame) {
    const shown = [],
      shows = [];
    if (!this.alone)
      for (const t of this.outline) {
        shown.push(t);
        shows.push(this.blockOf[this.arrays.triangle.values[3 * t]]);
      }
    if (!this.alone)
      this.bared.of.forEach((t, k) => {
        if (!this.isGone(frame, this.bared.by[k])) return;
        shown.push(t);
        shows.push(this.blockOf[this.arrays.triangle.values[3 * t]]);
      });
    if (this.faces.count) {
      const worst = new Map();
      for (const c of super.cracks(frame)) {
        const face = this.arrays.face.values[c],
          damage = this.worst(frame, c)[1] + (this.lit && this.lit.has(c) ? 1 : 0);
        if (face >= 0 && !(worst.has(face) && worst.get(face)[1] >= damage)) worst.set(face, [c, damage]);
      }
      this.faces.of.forEach((t, k) => {
        const found = worst.get(this.faces.on[k]);
        if (!found) return;
        shown.push(t);
        shows.push(this.crackColoured ? this.blocks + found[0] : this.blockOf[this.arrays.triangle.values[3 * t]]);
      });
    }
    Object.assign(this, {shown, shows});
  }

  // Places of all points as the eye sees them: pixels, and towards the eye in pixels.
  project(W, H) {
    const {x0, x1, y0, y1} = this.box,
      {space, view} = this;
    this.scale = this.zoom * Math.min(W / (x1 - x0), H / (y1 - y0));
    Object.assign(this, {W, H});
    const [right, up, towards] = this.axes,
      {scale, aside} = this;
    for (let i = 0; i < 3 * this.points; i += 3) {
      const x = space[i],
        y = space[i + 1],
        z = space[i + 2];
      view[i] = W / 2 + scale * (right[0] * x + right[1] * y + right[2] * z - aside[0]);
      view[i + 1] = H / 2 - scale * (up[0] * x + up[1] * y + up[2] * z - aside[1]);
      view[i + 2] = scale * (towards[0] * x + towards[1] * y + towards[2] * z);
    }
    this.facing = new Float32Array(this.shown.length);
    for (let k = 0; k < this.shown.length; k++) this.facing[k] = this.facingOf(this.shown[k]);
  }

  // A place as the eye sees it.
  seen(x, y, z) {
    const [right, up, towards] = this.axes,
      {scale, aside} = this;
    return [
      this.W / 2 + scale * (right[0] * x + right[1] * y + right[2] * z - aside[0]),
      this.H / 2 - scale * (up[0] * x + up[1] * y + up[2] * z - aside[1]),
      scale * (towards[0] * x + towards[1] * y + towards[2] * z),
    ];
  }

  // How far a triangle faces the eye: 1 fully, negative where it turns away.
  facingOf(t) {
    const {view} = this,
      {values} = this.arrays.triangle,
      [p, q, r] = [3 * values[3 * t], 3 * values[3 * t + 1], 3 * values[3 * t + 2]];
    const ax = view[q] - view[p],
      ay = view[p + 1] - view[q + 1],
      az = view[q + 2] - view[p + 2],
      bx = view[r] - view[p],
      by = view[p + 1] - view[r + 1],
      bz = view[r + 2] - view[p + 2];
    const nx = ay * bz - az * by,
      ny = az * bx - ax * bz,
      nz = ax * by - ay * bx;
    return nz / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1);
  }

  // Polygons for the painter: triangles that face the eye, from the farthest to the nearest, each with its brightness.
  polygons() {
    const {view, shown, facing} = this,
      {values} = this.arrays.triangle,
      depth = new Float32Array(shown.length);
    let count = 0;
    const order = new Uint32Array(shown.length);
    for (let k = 0; k < shown.length; k++) {
      if (facing[k] <= 0) continue;
      for (let e = 0; e < 3; e++) depth[k] += view[3 * values[3 * shown[k] + e] + 2];
      order[count++] = k;
    }
    const sorted = order.subarray(0, count).sort((p, q) => depth[p] - depth[q]);
    this.first = Int32Array.from({length: count + 1}, (_, p) => 3 * p);
    this.owner = Int32Array.from(sorted, (k) => this.shows[k]);
    this.light = Float32Array.from(sorted, (k) => brightness(facing[k]));
    this.px = new Float64Array(3 * count);
    this.py = new Float64Array(3 * count);
    for (let n = 0; n < 3 * count; n++) {
      const i = 3 * values[3 * shown[sorted[Math.floor(n / 3)]] + (n % 3)];
      this.px[n] = view[i];
      this.py[n] = view[i + 1];
    }
  }

  paint(pixels, W, H, colour) {
    if (this.raster === undefined) this.raster = Raster.made();
    if (this.raster && this.raster.isLost) this.raster = null;
    if (!this.raster) {
      this.polygons();
      return super.paint(pixels, W, H, (b, p) => shaded(colour(b), this.light[p]));
    }
    if (!this.ids || this.ids.length !== W * H) this.ids = new Int32Array(W * H);
    const {ids, shows, facing} = this,
      inks = Uint32Array.from(shows, (b, k) => shaded(colour(b), brightness(Math.max(0, facing[k])))),
      found = this.raster.draw(this, W, H);
    for (let k = 0; k < found.length; k++) {
      const shown = found[k] & 0xffffff; // without its opacity
      ids[k] = shown ? shows[shown - 1] : -1;
      pixels[k] = shown ? inks[shown - 1] : 0;
    }
    this.closeSeams(pixels, W, H);
    return ids;
  }

  cracks(frame) {
    return super.cracks(frame).filter((c) => isFinite(this.line(c)[0]));
  }

  // Half an edge outside on which a contact lies, pixels; NaN where it is hidden or the contact lies inside.
  line(c) {
    const {trace, triangle} = this.arrays,
      hidden = [NaN, NaN, NaN, NaN],
      t = trace.values[c] >> 1;
    if (this.alone || t < 0) return hidden;
    if (this.facingOf(t) <= 0) return hidden;
    const {view, W, H} = this,
      [p, q] = [0, trace.values[c] & 1 ? 9 : 3].map((from) => {
        const at = this.moved(c, [...this.cells.subarray(12 * c + from, 12 * c + from + 3)], this.placed);
        return this.seen(...at.map((v, k) => v - this.centre[k]));
      });
    // a place on the triangle beside the line shows its block where nothing is before it
    const corners = [0, 1, 2].map((e) => 3 * triangle.values[3 * t + e]),
      [x, y] = [0, 1].map((k) => 0.4 * (p[k] + q[k]) + (0.2 / 3) * corners.reduce((sum, i) => sum + view[i + k], 0));
    if (!(x >= 0 && y >= 0 && x < W && y < H)) return hidden;
    return this.ids[Math.floor(y) * W + Math.floor(x)] === this.blockOf[triangle.values[3 * t]]
      ? [p[0], p[1], q[0], q[1]]
      : hidden;
  }

  within(block, x, y) {
    const {frame, magnification} = this.placed,
      u = this.moves ? this.displacement(frame, block) : [0, 0, 0],
      moved = this.axes.slice(0, 2).map((axis) => magnification * axis.reduce((sum, v, k) => sum + v * u[k], 0));
    return {rest: this.fromPixels(x, y, this.W, this.H).map((v, k) => v - moved[k])};
  }

  at(x, y, W, H, frame, reach) {
    const found = super.at(x, y, W, H, frame, reach);
    return found.block < this.blocks ? found : {block: -1, crack: found.block - this.blocks};
  }

  // Edges of the box around the body, pixels.
  get frameLines() {
    const lines = [];
    for (let k = 0; k < 3; k++)
      for (let corner = 0; corner < 8; corner++) {
        if (corner & (1 << k)) continue;
        const [p, q] = [corner, corner | (1 << k)].map((n) =>
          this.seen(...this.half.map((v, i) => (n & (1 << i) ? v : -v))),
        );
        lines.push([p[0], p[1], q[0], q[1]]);
      }
    return lines;
  }

  // Ways of x, y and z in pixels, of so long an axis.
  triad(length) {
    const [right, up] = this.axes;
    return [..."xyz"].map((name, k) => ({name, x: length * right[k], y: -length * up[k]}));
  }
}

// The nearest triangle of each pixel, by WebGL on a canvas out of sight.
class Raster {
  // null where the browser has no WebGL 2, or has it by the processor.
  static made() {
    const canvas = document.createElement("canvas"),
      gl = canvas.getContext("webgl2", {antialias: false, alpha: false});
    if (!gl || gl.isContextLost()) return null;
    const hides = gl.getParameter(gl.RENDERER) === "WebKit WebGL",
      names = hides && gl.getExtension("WEBGL_debug_renderer_info"),
      renderer = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
    return BY_PROCESSOR.test(renderer) ? null : new Raster(canvas, gl);
  }

  constructor(canvas, gl) {
    Object.assign(this, {canvas, gl, copy: document.createElement("canvas")});
    // reading a copy waits for less than reading WebGL's own pixels
    this.pixels = this.copy.getContext("2d", {willReadFrequently: true});
    const program = gl.createProgram();
    for (const [kind, source] of [
      [gl.VERTEX_SHADER, VERTEX],
      [gl.FRAGMENT_SHADER, FRAGMENT],
    ]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    const corner = gl.getAttribLocation(program, "corner");
    gl.enableVertexAttribArray(corner);
    gl.vertexAttribPointer(corner, 3, gl.FLOAT, false, 0, 0);
    this.uniforms = Object.fromEntries(
      ["axes", "scale", "aside"].map((name) => [name, gl.getUniformLocation(program, name)]),
    );
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.clearColor(0, 0, 0, 1);
  }

  get isLost() {
    return this.gl.isContextLost();
  }

  // (W H) numbers, in their lower 24 bits one more than the place of the triangle among those shown; 0 for none.
  draw(body, W, H) {
    const {gl, canvas, copy, uniforms} = this,
      {axes, scale, aside, radius} = body;
    for (const one of [canvas, copy])
      if (one.width !== W || one.height !== H) Object.assign(one, {width: W, height: H});
    gl.viewport(0, 0, W, H);
    if (this.shown !== body.shown) this.upload(body);
    gl.uniformMatrix3fv(uniforms.axes, true, axes.flat());
    gl.uniform3f(uniforms.scale, (2 * scale) / W, (2 * scale) / H, -0.4 / radius);
    gl.uniform2f(uniforms.aside, ...aside);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.drawArrays(gl.TRIANGLES, 0, 3 * body.shown.length);
    this.pixels.drawImage(canvas, 0, 0);
    return new Uint32Array(this.pixels.getImageData(0, 0, W, H).data.buffer);
  }

  upload({shown, arrays, space}) {
    const {gl} = this,
      corners = new Float32Array(9 * shown.length),
      {values} = arrays.triangle;
    shown.forEach((t, k) => {
      for (let e = 0; e < 3; e++) {
        const i = 3 * values[3 * t + e];
        corners.set(space.subarray(i, i + 3), 9 * k + 3 * e);
      }
    });
    gl.bufferData(gl.ARRAY_BUFFER, corners, gl.DYNAMIC_DRAW);
    this.shown = shown;
  }
}

const VERTEX = `#version 300 es
in vec3 corner;
uniform mat3 axes;
uniform vec3 scale;
uniform vec2 aside;
flat out uint shown;
void main() {
  vec3 place = axes * corner;
  gl_Position = vec4(scale * vec3(place.xy - aside, place.z), 1.0);
  shown = uint(gl_VertexID / 3) + 1u;
}`;
const FRAGMENT = `#version 300 es
precision highp float;
flat in highp uint shown;
out vec4 found;
void main() {
  found = vec4(uvec4(shown & 255u, (shown >> 8) & 255u, shown >> 16, 255u)) / 255.0;
}`;
