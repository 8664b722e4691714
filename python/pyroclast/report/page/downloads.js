// Files that a page makes of what it holds.

import {css} from "./colours.js";

export function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export const saveText = (name, text, type = "text/csv") => save(name, new Blob([text], {type}));

const cell = (v) =>
  typeof v === "number"
    ? isFinite(v)
      ? String(v)
      : ""
    : v === null || v === undefined
      ? ""
      : /[",\n]/.test(v)
        ? `"${String(v).replaceAll('"', '""')}"`
        : String(v);

export const csv = (head, rows) => [head, ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";

const escaped = (text) => text.replace(/[&<>]/g, (c) => ({"&": "&amp;", "<": "&lt;", ">": "&gt;"})[c]);

// The picture of a specimen as SVG: polygons in their colours, cracks as lines, and texts.
export function frameAsSvg(specimen, title) {
  const {body, W, H, ratio} = specimen,
    theme = specimen.theme(),
    colour = specimen.painter(theme),
    {texts, bar} = specimen.labels(),
    [ink, ground, size] = [theme.value("--ink"), theme.value("--ground"), 12 * ratio],
    strokes = [...specimen.strokes(theme), {colour: ink, width: 1.6 * ratio, lines: bar}];
  body.polygons();
  const parts = [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${W} ${H}" width="${W}" height="${H}">`,
    `<title>${escaped(title)}</title>`,
  ];
  for (let p = 0; p + 1 < body.first.length; p++) {
    let path = "";
    for (let i = body.first[p]; i < body.first[p + 1]; i++)
      path += `${path ? " " : ""}${body.px[i].toFixed(1)},${body.py[i].toFixed(1)}`;
    const light = body.light ? body.light[p] : 1,
      fill = css(colour(body.owner ? body.owner[p] : p).map((v) => Math.round(v * light)));
    parts.push(`<polygon points="${path}" fill="${fill}" stroke="${fill}" stroke-width=".4"/>`);
  }
  for (const {colour: stroke, width, lines} of strokes)
    parts.push(
      `<path fill="none" stroke-linecap="round" stroke="${stroke}" stroke-width="${width}" d="${lines
        .map((l) => `M${l[0].toFixed(1)} ${l[1].toFixed(1)}L${l[2].toFixed(1)} ${l[3].toFixed(1)}`)
        .join("")}"/>`,
    );
  for (const {text, x, y, align} of texts)
    parts.push(
      `<text x="${x}" y="${y}" text-anchor="${align === "right" ? "end" : "start"}" font-family="sans-serif" ` +
        `font-size="${size}" fill="${ink}" stroke="${ground}" stroke-width="${size / 4}" ` +
        `paint-order="stroke">${escaped(text)}</text>`,
    );
  return parts.join("\n") + "\n</svg>\n";
}

// Records a canvas while `step(k)` draws frame k of `count`.
export async function film(canvas, count, step, perSecond = 12) {
  const stream = canvas.captureStream(0),
    track = stream.getVideoTracks()[0];
  const recorder = new MediaRecorder(stream, {mimeType: "video/webm"}),
    pieces = [];
  recorder.ondataavailable = (e) => pieces.push(e.data);
  const over = new Promise((done) => {
    recorder.onstop = done;
  });
  recorder.start();
  for (let k = 0; k < count; k++) {
    step(k);
    track.requestFrame();
    await new Promise((done) => setTimeout(done, 1000 / perSecond));
  }
  recorder.stop();
  await over;
  return new Blob(pieces, {type: "video/webm"});
}
