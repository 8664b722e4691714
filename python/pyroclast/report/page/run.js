// The page of a run: specimen and curve, which move together, keys, files and tabs. Each class knows those before it.

class RunPage extends RunTabs {
  constructor(arrays) {
    super();
    this.course = new Course(page.course, arrays.history);
    this.parent = page.parent && new Course(page.course, arrays.parent, page.parent.columns);
    this.frames = page.frames;
    this.body = page.body && bodyOf(page.body, arrays, page.frames);
    this.frame = Math.max(0, this.frames.length - 1);
    this.piece = null; // first and last row
    this.begun = null; // row of one end of a piece whose other end is still open
    this.asked = null; // {row, name} of a place on the curve whose frame is shown
    this.pins = [];
    this.charts = [];
    this.axes = {over: page.course.over, of: page.course.drawn[0] || "", stage: ""};
    this.curve = this.chart("curve", {
      height: 320,
      name: "curve",
      pick: (row) => this.showRow(row),
      brush: (piece, isOver) => this.drag(piece, isOver),
    });
    if (this.body) this.makeSpecimen();
    this.makeAxes();
    this.makeMarks();
    this.tabs();
    this.keys();
    this.downloads();
    if (this.body) this.show(this.frame);
  }

  keys() {
    addEventListener("keydown", (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey || e.target.matches("select, input, textarea, summary")) return;
      if (e.target.matches("button, [role=tab]") && [" ", "Enter"].includes(e.key)) return;
      if (!this.body) return;
      if (e.shiftKey && e.key.startsWith("Arrow")) {
        this.moveProbe(e.key);
        e.preventDefault();
        return;
      }
      const act = {
        ArrowRight: () => this.show(this.frame + 1),
        ArrowLeft: () => this.show(this.frame - 1),
        Home: () => this.show(0),
        End: () => this.show(this.frames.length - 1),
        " ": () => this.play(),
        "[": () => this.pieceEnd(0),
        "]": () => this.pieceEnd(1),
        Escape: () => {
          this.clearPiece();
          this.specimen.probe = null;
          $("tip").hidden = true;
          this.show(this.frame);
        },
        p: () => this.specimen.probe && this.pin(...this.specimen.probe),
        l: () => this.toggleLine(),
        ...(this.body.axes
          ? {
              a: () => this.turn(-TURN_STEP, 0),
              d: () => this.turn(TURN_STEP, 0),
              w: () => this.turn(0, -TURN_STEP),
              s: () => this.turn(0, TURN_STEP),
              "+": () => this.zoom(ZOOM_STEP),
              "-": () => this.zoom(1 / ZOOM_STEP),
            }
          : {}),
      }[e.key];
      if (!act) return;
      e.preventDefault();
      act();
    });
  }

  moveProbe(key) {
    const s = this.specimen,
      step = 4 * s.ratio,
      [x, y] = s.probe || [s.W / 2, s.H / 2];
    s.probe = [
      x + step * ({ArrowRight: 1, ArrowLeft: -1}[key] || 0),
      y + step * ({ArrowDown: 1, ArrowUp: -1}[key] || 0),
    ];
    this.redraw();
    this.point(...s.probe);
  }

  // One end of a piece is put where the curve is looked at; the other stays, or is still open.
  pieceEnd(which) {
    if (this.begun && this.begun.which !== which) return this.closePiece(this.begun.row, this.row);
    if (this.piece) return this.closePiece(this.piece[1 - which], this.row);
    this.begun = {row: this.row, which};
    this.tellBegun();
  }

  closePiece(one, other) {
    if (one !== other) this.begun = null;
    this.brush([Math.min(one, other), Math.max(one, other)], true);
  }

  downloads() {
    const course = this.course,
      name = page.name;
    const columns = page.course.columns;
    $("save_history").onclick = () =>
      saveText(
        `${name}_history.csv`,
        csv(
          columns,
          Array.from({length: course.rows}, (_, i) => columns.map((c) => +course.columns[c][i].toPrecision(7))),
        ),
      );
    $("save_deck").onclick = () => saveText(`${name}.toml`, $("deck").textContent, "application/toml");
    if (!this.body) return;
    const keys = Object.keys(this.frames[0]).filter((k) => k !== "row");
    $("save_frames").onclick = () =>
      saveText(
        `${name}_frames.csv`,
        csv(
          keys,
          this.frames.map((f) => keys.map((k) => f[k])),
        ),
      );
    const s = this.specimen,
      file = (ending) => `${name}_frame_${this.frames[this.frame].number}.${ending}`;
    $("save_png").onclick = () => $("body").toBlob((blob) => save(file("png"), blob));
    $("save_svg").onclick = () => {
      const theme = s.theme(),
        {texts, bar} = s.labels(),
        look = {texts, ink: theme.value("--ink"), ground: theme.value("--ground"), size: 12 * s.ratio};
      saveText(
        file("svg"),
        frameAsSvg(
          this.body,
          s.W,
          s.H,
          s.painter(theme),
          [...s.strokes(theme), {colour: look.ink, width: 1.6 * s.ratio, lines: bar}],
          `${page.title}, ${this.told(this.frame)}`,
          look,
        ),
        "image/svg+xml",
      );
    };
    $("save_film").hidden = !(window.MediaRecorder && HTMLCanvasElement.prototype.captureStream);
    $("save_film").onclick = async () => {
      const before = this.frame;
      save(`${name}.webm`, await film($("body"), this.frames.length, (k) => this.show(k)));
      this.show(before);
    };
    $("save_probes").onclick = () =>
      saveText(
        `${name}_probes.csv`,
        csv(
          ["frame", "step", "probe", "quantity", "value"],
          this.pins.flatMap((pin) =>
            this.frames.flatMap((f, k) =>
              this.factsOf(pin, k).map(([what, v]) => [
                f.number,
                f.step,
                this.nameOf(pin),
                what,
                v.replace("−", "-"),
              ]),
            ),
          ),
        ),
      );
  }
}

const born = performance.now();
unpackedAll(page.arrays).then((arrays) => {
  const decoded = performance.now() - born;
  window.pyroclast = new RunPage(arrays);
  window.pyroclast.arrays = arrays;
  window.pyroclast.times = {decoded, ready: performance.now() - born};
});
