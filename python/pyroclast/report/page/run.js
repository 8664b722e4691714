// The page of a run: its panes, and what keys and downloads do.

import {CurvePane} from "./curve_pane.js";
import {Charts} from "./curves.js";
import {csv, film, frameAsSvg, save, saveText} from "./downloads.js";
import {$, pageData} from "./elements.js";
import {unpackedAll} from "./packing.js";
import {PieceTable} from "./piece_table.js";
import {Probes} from "./probes.js";
import {Scene} from "./scene.js";
import {Specimen} from "./specimen.js";
import {SpecimenPane} from "./specimen_pane.js";
import {Tabs} from "./tabs.js";

class RunPage {
  constructor(page, arrays) {
    const scene = new Scene(page, arrays),
      charts = new Charts(scene);
    Object.assign(this, {page, arrays, scene});
    if (scene.body) {
      this.specimen = new Specimen($("body"), scene.body);
      this.pane = new SpecimenPane(scene, this.specimen);
      this.probes = new Probes(scene, this.specimen); // hears of a frame once it is drawn
    }
    this.curve = new CurvePane(scene, charts);
    this.pieceTable = new PieceTable(scene);
    this.tabs = new Tabs(scene, charts, page.properties);
    this.downloads();
    if (!scene.body) return;
    this.keys();
    scene.show(scene.frame);
  }

  keys() {
    const {scene, probes} = this;
    addEventListener("keydown", (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey || e.target.matches("select, input, textarea, summary")) return;
      if (e.target.matches("button, [role=tab]") && [" ", "Enter"].includes(e.key)) return;
      const moves = {
        ArrowRight: () => scene.show(scene.frame + 1),
        ArrowLeft: () => scene.show(scene.frame - 1),
        Home: () => scene.show(0),
        End: () => scene.show(scene.frames.length - 1),
        " ": () => $("play").click(),
        "[": () => scene.pieceEnd(0),
        "]": () => scene.pieceEnd(1),
        Escape: () => {
          scene.dropPiece();
          probes.drop();
          scene.show(scene.frame);
        },
        p: () => probes.keep(),
        l: () => probes.toggleLine(),
        ...this.pane.keys,
      };
      const act = e.shiftKey && e.key.startsWith("Arrow") ? () => probes.move(e.key) : moves[e.key];
      if (!act) return;
      e.preventDefault();
      act();
    });
  }

  downloads() {
    const {page, scene, specimen: s, probes} = this,
      {course, frames} = scene,
      {name} = page,
      {columns} = course.about,
      digits = (c, i) => +course.columns[c][i].toPrecision(7),
      saveTable = (what, head, rows) => saveText(`${name}_${what}.csv`, csv(head, rows));
    $("save_history").onclick = () =>
      saveTable("history", columns, Array.from({length: course.rows}, (_, i) => columns.map((c) => digits(c, i))));
    $("save_deck").onclick = () => saveText(`${name}.toml`, $("deck").textContent, "application/toml");
    if (!scene.body) return;
    const keys = Object.keys(frames[0]).filter((k) => k !== "row"),
      file = (ending) => `${name}_frame_${frames[scene.frame].number}.${ending}`;
    $("save_frames").onclick = () => saveTable("frames", keys, frames.map((f) => keys.map((k) => f[k])));
    $("save_png").onclick = () => $("body").toBlob((blob) => save(file("png"), blob));
    $("save_svg").onclick = () =>
      saveText(file("svg"), frameAsSvg(s, `${page.title}, ${scene.told(scene.frame)}`), "image/svg+xml");
    $("save_film").hidden = !(window.MediaRecorder && HTMLCanvasElement.prototype.captureStream);
    $("save_film").onclick = async () => {
      const before = scene.frame;
      save(`${name}.webm`, await film($("body"), frames.length, (k) => scene.show(k)));
      scene.show(before);
    };
    $("save_probes").onclick = () =>
      saveTable("probes", ["frame", "step", "probe", "quantity", "value"], probes.rows);
  }
}

const born = performance.now();
const page = pageData();
unpackedAll(page.arrays).then((arrays) => {
  const decoded = performance.now() - born;
  window.pyroclast = new RunPage(page, arrays);
  window.pyroclast.times = {decoded, ready: performance.now() - born};
});
