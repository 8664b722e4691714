// The history of a run: columns by name, quantities by id.

import {menu} from "./elements.js";

export class Course {
  constructor(about, numbers, columns = about.columns) {
    Object.assign(this, {about, rows: numbers.shape[0]});
    this.columns = {};
    columns.forEach((name, k) => {
      this.columns[name] = Float64Array.from({length: this.rows}, (_, i) => numbers.at(i, k));
    });
  }
  has(name) {
    return name in this.columns;
  }
  column(name) {
    return this.columns[name] || new Float64Array(this.rows).fill(NaN);
  }
  quantity(id) {
    return this.about.quantities.find((q) => q.id === id);
  }
  of(id) {
    const q = this.quantity(id);
    const stage = this.column("stage");
    return this.column(q.column).map((v, i) => (stage[i] < q.stage ? NaN : v * q.factor - q.offset));
  }
  varies(id) {
    const values = this.of(id).filter(isFinite);
    let [low, high] = [Infinity, -Infinity];
    for (const v of values) [low, high] = [Math.min(low, v), Math.max(high, v)];
    return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high));
  }
  // Where a chart over a quantity has its points.
  over(id) {
    return {x: this.of(id), label: this.quantity(id).label};
  }
  // Change of a column over a piece of rows; a cell that is empty counts as the nearest one that is not.
  change(name, [a, b]) {
    const values = this.column(name);
    let from = a,
      to = b;
    while (from < b && !isFinite(values[from])) from++;
    while (to > a && !isFinite(values[to])) to--;
    return isFinite(values[to] - values[from]) ? values[to] - values[from] : 0;
  }
}

// Menus of the quantities that a curve is drawn over and of; `act` follows a change of the axes {over, of}.
export function axesMenus(axes, quantities, act) {
  const entries = quantities.map((q) => [q.id, q.label]);
  for (const which of ["over", "of"]) menu(which, entries, axes[which], (id) => act((axes[which] = id)));
}
