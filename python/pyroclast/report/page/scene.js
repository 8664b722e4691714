// What a page shows of a run: a frame, a piece of the curve, and a place of the picture. Panes know the scene and not
// one another: they ask it for a change, and hear of each by one of three events:
//   frame: another frame is shown, or the same in another way;
//   piece (how, row): a piece of the curve is "dragged", "whole", "empty" at a row, "begun" or "dropped";
//   probe (place, isKept): a place [x, y] of the picture, pixels, is pointed at, or kept; null: none is.

import {Course} from "./course.js";
import {nearest, number, unitOf, withUnit} from "./elements.js";
import {bodyOf} from "./solid.js";

export class Scene {
  constructor(page, arrays) {
    this.course = new Course(page.course, arrays.history);
    this.parent = page.parent && new Course(page.course, arrays.parent, page.parent.columns);
    this.parentName = page.parent && page.parent.name;
    this.frames = page.frames;
    this.body = page.body && bodyOf(page.body, arrays, page.frames);
    this.moves = page.moves;
    this.frame = Math.max(0, this.frames.length - 1);
    this.asked = null; // {row, name} of a place on the curve whose frame is shown, with what it points at
    this.cracked = null; // contacts that the frame is shown for, a Set
    this.lit = null; // contacts with a halo, a Set
    this.piece = null; // first and last row
    this.begun = null; // {row, which} of one end of a piece whose other end is still open
    this.axes = {over: page.course.over, of: page.course.drawn[0] || ""}; // of the curve
    this.hearers = {frame: [], piece: [], probe: []};
  }

  on(event, hear) {
    this.hearers[event].push(hear);
  }
  tell(event, ...said) {
    for (const hear of this.hearers[event]) hear(...said);
  }

  // Shows a frame, for contacts that cracked (a Set) and for a place on the curve; null: for none.
  show(frame, cracked = null, asked = null) {
    this.frame = Math.max(0, Math.min(this.frames.length - 1, frame));
    Object.assign(this, {asked, cracked, lit: cracked || (this.piece ? this.lit : null)});
    this.tell("frame");
  }

  // Where the curve is looked at: the place that was asked for, else that of the frame.
  get row() {
    if (this.asked) return this.asked.row;
    return this.frames.length ? this.frames[this.frame].row : null;
  }

  // Shows the frame nearest to a row.
  showRow(row) {
    this.show(nearest(this.frames.map((f) => f.row), row));
  }

  // The first frame that was saved at a row or after it, and the last one at the row or before it.
  frameAt(row) {
    const found = this.frames.findIndex((f) => f.row >= row);
    return found < 0 ? this.frames.length - 1 : found;
  }
  frameBefore(row) {
    return this.frames.reduce((found, f, k) => (f.row <= row ? k : found), 0);
  }

  // What charts show as a piece.
  get brushed() {
    return this.piece || (this.begun && [this.begun.row, this.begun.row]);
  }

  brush([from, to], isOver) {
    const isEmpty = isOver && from === to;
    this.piece = isEmpty ? null : [from, to];
    if (isOver && !isEmpty && this.body) {
      const steps = this.piece.map((row) => this.course.column("step")[row]);
      this.show(this.frameAt(to), this.body.crackedBetween(...steps), {row: to, name: "the end of the piece"});
    }
    this.tell("piece", isEmpty ? "empty" : isOver ? "whole" : "dragged", from);
  }

  // A piece that is dragged out takes the place of one that had begun.
  drag(piece, isOver) {
    this.begun = null;
    this.brush(piece, isOver);
  }

  // Puts one end of a piece where the curve is looked at; the other stays, or is still open.
  pieceEnd(which) {
    const {row, begun, piece} = this;
    if (begun && begun.which !== which) this.closePiece(begun.row);
    else if (piece) this.closePiece(piece[1 - which]);
    else {
      this.begun = {row, which};
      this.tell("piece", "begun", row);
    }
  }
  closePiece(other) {
    if (other !== this.row) this.begun = null;
    this.brush([Math.min(other, this.row), Math.max(other, this.row)], true);
  }
  dropPiece() {
    this.piece = this.begun = null;
    this.tell("piece", "dropped");
  }

  // One value or two ends with their unit, in three digits, or four where three do not tell the ends apart.
  toldSpan(values, label) {
    const ends = [3, 4, 5].map((digits) => values.map((v) => number(v, digits))),
      [from, to] = ends.find(([p, q]) => p !== q) || ends[0];
    return withUnit(to === undefined ? from : `${from} to ${to}`, unitOf(label));
  }

  // Where rows lie on the curve: label and values there.
  at(...rows) {
    const {x, label} = this.course.over(this.course.about.over);
    return {label, values: rows.map((row) => x[row])};
  }
  // The same in words, such as "axial strain 2.77 to 2.86·10⁻³".
  placeOf(...rows) {
    const {label, values} = this.at(...rows);
    return `${label.split(/,| \[/)[0]} ${this.toldSpan(values, label)}`;
  }

  // A step, and where the curve was at it.
  toldStep(step) {
    const row = this.course.column("step").findIndex((s) => s >= step),
      {label, values} = this.at(row);
    return `step ${step}${isFinite(values[0]) ? ` (${this.toldSpan(values, label)})` : ""}`;
  }

  // A frame, with strain, stress and temperature.
  told(frame) {
    const f = this.frames[frame],
      [drawn] = this.course.about.drawn,
      y = this.course.quantity(drawn),
      said = [],
      isThere = (v) => v !== null && isFinite(v);
    if (isThere(f.strain)) said.push(`strain ${number(1e3 * f.strain, 3)}·10⁻³`);
    if (isThere(f.stress)) said.push(`stress ${number(f.stress, 3)} MPa`);
    if (f.strain === null && y)
      said.push(`${y.label.replace(/ \[.*/, "")} ${number(this.course.of(y.id)[f.row])} ${unitOf(y.label)}`);
    if (f.temperature > 25 && !(f.strain === null && drawn === "temperature"))
      said.push(`${number(f.temperature, 3)} °C`);
    if (f.heating_time > 0) said.push(`${number(f.heating_time / 60, 3)} min`);
    return `frame ${f.number} of ${this.frames[this.frames.length - 1].number}: ${said.join(", ")}`;
  }
}
