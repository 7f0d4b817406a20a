'use strict';
// Lines of charts, and the rows that are drawn of them in a window.

/** A series of a chart as it is drawn: its times and values. */
class Line {
  constructor(spec) {
    Object.assign(this, spec);
  }

  get source() {
    return page.tables[this.table];
  }

  series() {
    const source = this.source;
    if (this.cached && this.cached.full === source.full) return this.cached;
    let v = source.column(this.column);
    if (this.factor !== 1) v = v.map((x) => x * this.factor);
    if (this.centre) {
      const centre = source.column(this.centre);
      v = v.map((x, i) => centre[i] + x);
    }
    this.cached = {t: source.t, v, full: source.full};
    if (['heading', 'roll'].includes(this.column)) {
      Object.assign(this.cached, withoutWraps(source.t, v));
    }
    return this.cached;
  }

  valueAt(time) {
    const {t, v} = this.series();
    if (t.length === 0 || !this.source.isExact) return NaN;
    const i = nearestRow(t, time);
    return isNaN(v[i]) && i > 0 && t[i - 1] >= time - 1e-3 ? v[i - 1] : v[i];
  }
}

/** An angle with a gap wherever it goes from 180 to -180 deg or back. */
function withoutWraps(t, v) {
  const times = [];
  const values = [];
  for (let i = 0; i < t.length; i++) {
    if (i > 0 && Math.abs(v[i] - v[i - 1]) > 180) {
      times.push((t[i] + t[i - 1]) / 2);
      values.push(NaN);
    }
    times.push(t[i]);
    values.push(v[i]);
  }
  return {t: times, v: values};
}

const kSigmaOf = {north: 'sd_n', east: 'sd_e', height: 'sd_d'};

/** Solution minus the solution that the reader chose, where both have a row. */
class DifferenceLine extends Line {
  get wanted() {
    return this.column;
  }

  series() {
    const base = page.groups[view.base];
    const whole = page.tables[base.table];
    const other = whole.isExact && whole.has(this.wanted) ? whole :
        page.tables[base.samples];
    if (this.cached && this.cached.other === other) return this.cached;
    const own = this.source;
    const t = own.t;
    const v = new Float64Array(t.length).fill(NaN);
    if (other.has(this.wanted) && own.has(this.wanted) &&
        this.group !== view.base) {
      const mine = own.column(this.wanted);
      const theirs = other.column(this.wanted);
      for (let k = 0; k < t.length; k++) {
        const j = nearestRow(other.t, t[k]);
        if (Math.abs(other.t[j] - t[k]) > 1e-3) continue;
        v[k] = this.combine(mine[k], theirs[j]);
      }
    }
    this.cached = {t, v, other};
    return this.cached;
  }

  combine(mine, theirs) {
    const difference = mine - theirs;
    if (!['roll', 'pitch', 'heading'].includes(this.column)) return difference;
    return difference - 360 * Math.round(difference / 360);
  }
}

/** The standard deviation that such a difference may have. */
class DifferenceBound extends DifferenceLine {
  get wanted() {
    return kSigmaOf[this.column] || 'sd_' + this.column;
  }

  combine(mine, theirs) {
    const alike = page.groups[this.group].forward ===
        page.groups[view.base].forward;
    return this.factor * (alike ? theirs :
        Math.sqrt(Math.abs(mine * mine - theirs * theirs)));
  }
}

function linesOf(spec) {
  if (!spec.difference) return spec.lines.map((line) => new Line(line));
  const lines = [];
  for (const line of spec.lines) {
    for (const factor of [1, -1]) {
      lines.push(new DifferenceBound(
          {...line, factor, style: 'dash', label: '', bound: true}));
    }
    lines.push(new DifferenceLine(line));
  }
  return lines;
}

/** Rows of dygraphs: exact where there are few, else extremes of each pixel. */
function rowsOf(lines, from, to, width) {
  const parts = lines.map((line) => {
    const {t, v} = line.series();
    const begin = Math.max(0, lowerBound(t, from) - 1);
    const end = Math.min(t.length, lowerBound(t, to) + 2);
    return {t, v, begin, end};
  });
  const count = Math.max(0, ...parts.map((part) => part.end - part.begin));
  return count <= 2 * width ? exactRows(parts) :
      binnedRows(parts, from, to, width);
}

function exactRows(parts) {
  const rows = new Map();
  parts.forEach((part, column) => {
    for (let i = part.begin; i < part.end; i++) {
      let row = rows.get(part.t[i]);
      if (!row) {
        row = new Array(parts.length + 1).fill(null);
        row[0] = part.t[i];
        rows.set(part.t[i], row);
      }
      row[column + 1] = part.v[i];
    }
  });
  return [...rows.values()].sort((a, b) => a[0] - b[0]);
}

function binnedRows(parts, from, to, width) {
  const step = (to - from) / width;
  const rows = [];
  for (let bin = -1; bin <= width; bin++) {
    for (const share of [0.25, 0.75]) {
      const row = new Array(parts.length + 1).fill(null);
      row[0] = from + (bin + share) * step;
      rows.push(row);
    }
  }
  parts.forEach(({t, v, begin, end}, column) => {
    let i = begin;
    while (i < end) {
      const bin = Math.min(Math.max(Math.floor((t[i] - from) / step), -1),
                           width);
      const next = bin === width ? Infinity : from + (bin + 1) * step;
      let least = -1;
      let most = -1;
      // At least one row, whatever rounding says of its bin.
      do {
        if (!isNaN(v[i])) {
          if (least < 0 || v[i] < v[least]) least = i;
          if (most < 0 || v[i] > v[most]) most = i;
        }
        i++;
      } while (i < end && t[i] < next);
      const place = 2 * (bin + 1);
      rows[place][column + 1] = least < 0 ? NaN : v[Math.min(least, most)];
      rows[place + 1][column + 1] = least < 0 ? NaN : v[Math.max(least, most)];
    }
  });
  return rows;
}
