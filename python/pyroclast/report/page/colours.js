// Colours as [r, g, b]: stops from low to high, alike in dark and light themes, and those of materials.

export const TWO_SIDED = [
  [5, 68, 120],
  [120, 180, 220],
  [238, 238, 234],
  [240, 160, 90],
  [150, 55, 0],
];
export const ONE_SIDED = [
  [255, 246, 214],
  [253, 186, 107],
  [226, 80, 50],
  [140, 15, 50],
  [50, 0, 40],
];

export function colourAt(stops, share) {
  const at = Math.max(0, Math.min(0.99999, share)) * (stops.length - 1),
    k = Math.floor(at);
  return stops[k].map((v, i) => Math.round(v + (stops[k + 1][i] - v) * (at - k)));
}

export const ink = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
export const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;
export const mixed = (one, other, share) => one.map((v, k) => Math.round(v + share * (other[k] - v)));

// Of each material a colour: the named ones as in the figures, bearings dark, others in turn.
export function phaseColours(materials, numbers) {
  let more = 0;
  return materials.map(({name, bearing}) =>
    bearing
      ? numbers("--bearing")
      : ["aggregate", "mortar"].includes(name)
        ? numbers(`--${name}`)
        : numbers(`--phase-${more++ % 4}`),
  );
}
