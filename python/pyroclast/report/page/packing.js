// Arrays of numbers from the text of a page; report/packing.py writes them and tells how.

async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Numbers in whole steps, or as they are (step 1). `row(k)` is where the numbers of frame or row k begin.
class Numbers {
  constructor(values, shape, step) {
    this.values = values;
    this.shape = shape;
    this.step = step;
    this.width = shape.slice(1).reduce((a, b) => a * b, 1);
  }
  row(k) {
    return k * this.width;
  }
  at(k, i) {
    return this.step * this.values[k * this.width + i];
  }
}

async function unpacked(array) {
  const raw = await inflated(array.data);
  const size = array.bytes || 4;
  const count = raw.length / size;
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < size; k++) for (let i = 0; i < count; i++) bytes[i * size + k] = raw[k * count + i];
  if (!array.bytes) return new Numbers(new Float32Array(bytes.buffer), array.shape, 1);
  const turned = new {1: Uint8Array, 2: Uint16Array, 4: Uint32Array}[size](bytes.buffer);
  const values = new {1: Int8Array, 2: Int16Array, 4: Int32Array}[size](count);
  const numbers = new Numbers(values, array.shape, array.step || 1);
  for (let i = 0; i < count; i++) {
    const change = (turned[i] >>> 1) ^ -(turned[i] & 1);
    values[i] = i < numbers.width ? change : values[i - numbers.width] + change; // wraps around as it was written
  }
  return numbers;
}

export async function unpackedAll(arrays) {
  const names = Object.keys(arrays);
  const all = await Promise.all(names.map((name) => unpacked(arrays[name])));
  return Object.fromEntries(names.map((name, i) => [name, all[i]]));
}
