'use strict';
// The series of the page: packed integers (src/io/write/packed_series.h) to
// numbers.

function bytesOfBase64(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/** Values from bytes[at.offset] on; at.offset is moved behind them. */
function unpackSeries(bytes, count, quantum, at) {
  const values = new Float64Array(count);
  const inverse = quantum < 1 ? Math.round(1 / quantum) : 0;
  let k = 0;
  let i = at.offset;
  for (let row = 0; row < count; row++) {
    let byte = bytes[i++];
    let code = byte & 127;
    let scale = 128;
    while (byte > 127) {
      byte = bytes[i++];
      code += (byte & 127) * scale;
      scale *= 128;
    }
    if (code === 0) {
      values[row] = NaN;
      continue;
    }
    const zigzag = code - 1;
    k += zigzag % 2 === 0 ? zigzag / 2 : -(zigzag + 1) / 2;
    values[row] = inverse ? k / inverse : k * quantum;
  }
  at.offset = i;
  return values;
}

const kTimeQuantum = 1e-6;

/** A table: what is drawn at first, and all rows once they are loaded. */
class Table {
  constructor(json, number) {
    this.json = json;
    this.number = number;
    this.full = !json.full;
    this.t = unpackSeries(bytesOfBase64(json.t), json.shown, kTimeQuantum,
                          {offset: 0});
    this.columns = {};
  }

  /** Whether every row is there, and not extremes or some rows alone. */
  get isExact() {
    return this.t.length === this.json.rows;
  }

  has(name) {
    return name in this.json.columns;
  }

  column(name) {
    if (!(name in this.columns)) {
      const column = this.json.columns[name];
      this.columns[name] = unpackSeries(bytesOfBase64(column.shown),
                                        this.json.shown, column.quantum,
                                        {offset: 0});
    }
    return this.columns[name];
  }

  async load() {
    if (this.full) return false;
    const element = document.getElementById('rows-' + this.number);
    const stream = new Blob([bytesOfBase64(element.textContent)]).stream()
        .pipeThrough(new DecompressionStream('deflate'));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const at = {offset: 0};
    const rows = this.json.rows;
    const t = unpackSeries(bytes, rows, kTimeQuantum, at);
    const columns = {};
    for (const [name, column] of Object.entries(this.json.columns)) {
      columns[name] = unpackSeries(bytes, rows, column.quantum, at);
    }
    this.t = t;
    this.columns = columns;
    this.full = true;
    return true;
  }
}

/** First index with t[i] >= time. */
function lowerBound(t, time) {
  let low = 0;
  let high = t.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (t[middle] < time) low = middle + 1; else high = middle;
  }
  return low;
}

/** Index of the row nearest to a time. */
function nearestRow(t, time) {
  const i = lowerBound(t, time);
  if (i === 0) return 0;
  if (i === t.length) return t.length - 1;
  return time - t[i - 1] < t[i] - time ? i - 1 : i;
}
