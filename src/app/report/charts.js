'use strict';
// Charts over time, drawn by dygraphs from the extremes of each pixel.

const kAxisWidth = 58;

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
    if (t.length === 0) return NaN;
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

/** Solution minus the solution that the reader chose. */
class DifferenceLine extends Line {
  series() {
    if (this.cached && this.cached.base === view.base) return this.cached;
    const own = this.source;
    const other = page.tables[page.groups[view.base].samples];
    const t = own.t;
    const v = new Float64Array(t.length).fill(NaN);
    if (other.has(this.column) && this.group !== view.base) {
      const mine = this.valuesOf(own);
      const theirs = this.valuesOf(other);
      for (let k = 0; k < t.length; k++) {
        v[k] = this.between(mine, theirs, other.t, t[k], k);
      }
    }
    this.cached = {t, v, base: view.base};
    return this.cached;
  }

  valuesOf(table) {
    return table.column(this.column);
  }

  between(mine, theirs, times, time, k) {
    const i = Math.min(Math.max(lowerBound(times, time), 1), times.length - 1);
    if (time < times[0] || time > times[times.length - 1]) return NaN;
    const share = times.length > 1 ?
        (time - times[i - 1]) / (times[i] - times[i - 1]) : 0;
    const step = this.wrap(theirs[i] - theirs[i - 1]);
    return this.wrap(mine[k] - theirs[i - 1] - share * step);
  }

  wrap(angle) {
    if (!['roll', 'pitch', 'heading'].includes(this.column)) return angle;
    return angle - 360 * Math.round(angle / 360);
  }
}

/** The standard deviation that such a difference may have. */
class DifferenceBound extends DifferenceLine {
  get sigma() {
    return kSigmaOf[this.column] || 'sd_' + this.column;
  }

  valuesOf(table) {
    return table.has(this.sigma) ? table.column(this.sigma) :
        new Float64Array(table.t.length).fill(NaN);
  }

  between(mine, theirs, times, time, k) {
    const other = theirs[nearestRow(times, time)];
    const alike = page.groups[this.group].forward ===
        page.groups[view.base].forward;
    const sigma = alike ? other :
        Math.sqrt(Math.abs(mine[k] * mine[k] - other * other));
    return this.factor * sigma;
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

function drawCross(g, name, context, x, y, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x - 3, y - 3);
  context.lineTo(x + 3, y + 3);
  context.moveTo(x - 3, y + 3);
  context.lineTo(x + 3, y - 3);
  context.stroke();
}

function drawRing(g, name, context, x, y, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1.2;
  context.beginPath();
  context.arc(x, y, 2.6, 0, 2 * Math.PI);
  context.stroke();
}

const kPointShapes = {rejected: drawCross, withheld: drawRing};

class ChartView {
  constructor(element) {
    this.element = element;
    this.spec = page.charts[element.dataset.chart];
    this.plot = element.querySelector('.plot');
    this.legend = element.querySelector('.legend');
    this.lines = linesOf(this.spec);
    this.onScreen = true;
    this.isLog = this.spec.log && this.isWide();
    this.canvas = document.createElement('div');
    this.canvas.className = 'canvas';
    this.plot.append(this.canvas);
    this.makeGraph();
    this.makeLegend();
    this.cursorLine = document.createElement('div');
    this.cursorLine.className = 'cursor';
    this.plot.append(this.cursorLine);
    addPointer(this.plot, (x) => this.graph.toDataXCoord(x));
  }

  /** Values span more than a factor of 20, and all are positive. */
  isWide() {
    let least = Infinity;
    let most = 0;
    for (const line of this.lines) {
      for (const v of line.series().v) {
        if (v > 0) {
          least = Math.min(least, v);
          most = Math.max(most, v);
        }
      }
    }
    return most > 20 * least;
  }

  get width() {
    return Math.max(100, this.canvas.clientWidth - kAxisWidth);
  }

  rows() {
    const rows = rowsOf(this.lines, view.window[0], view.window[1],
                        this.width);
    if (this.isLog) {
      for (const row of rows) {
        for (let i = 1; i < row.length; i++) {
          if (row[i] !== null && !(row[i] > 0)) row[i] = NaN;
        }
      }
    }
    if (rows.length === 0) {
      rows.push([view.window[0], ...this.lines.map(() => null)]);
    }
    return rows;
  }

  colours() {
    return this.lines.map((line) => colourOf(line.colour));
  }

  seriesOptions() {
    const options = {};
    this.lines.forEach((line, i) => {
      const points = line.style === 'points';
      options['s' + i] = {
        strokeWidth: points ? 0 : line.style === 'dash' ? 1 :
            line.group === 0 ? 2.6 : 1.2,
        strokePattern: line.style === 'dash' ? [5, 4] : null,
        drawPoints: points,
        pointSize: 1.6,
        ...(points && kPointShapes[line.label] ?
            {drawPointCallback: kPointShapes[line.label]} : {}),
      };
    });
    return options;
  }

  makeGraph() {
    this.graph = new Dygraph(this.canvas, this.rows(), {
      labels: ['t', ...this.lines.map((line, i) => 's' + i)],
      colors: this.colours(),
      series: this.seriesOptions(),
      dateWindow: view.window,
      visibility: this.lines.map((line) => this.shows(line)),
      valueRange: this.range(),
      logscale: this.isLog,
      connectSeparatedPoints: true,
      legend: 'never',
      interactionModel: {},
      highlightCircleSize: 0,
      axisLabelFontSize: 12,
      gridLineColor: styleValue('--grid'),
      axisLineColor: styleValue('--axis'),
      gridLineWidth: 1,
      rightGap: 8,
      yRangePad: 6,
      underlayCallback: (context, area, graph) =>
        this.drawUnderlay(context, area, graph),
      axes: {
        x: {
          drawGrid: true,
          ticker: (a, b, pixels) => timeTicks(a, b, pixels),
        },
        y: {
          axisLabelWidth: kAxisWidth - 6,
          pixelsPerLabel: 28,
          ticker: (a, b, pixels) => valueTicks(a, b, pixels, this.isLog),
        },
      },
    });
  }

  shows(line) {
    return view.shows(line.group) &&
        !(this.spec.difference && line.group === view.base);
  }

  /** A flat or empty chart gets a height of its own; else dygraphs decides. */
  range() {
    let least = Infinity;
    let most = -Infinity;
    for (const line of this.lines) {
      if (!this.shows(line)) continue;
      const {t, v} = line.series();
      const end = Math.min(t.length, lowerBound(t, view.window[1]) + 1);
      for (let i = lowerBound(t, view.window[0]); i < end; i++) {
        if (v[i] < least) least = v[i];
        if (v[i] > most) most = v[i];
      }
    }
    if (this.isLog) {
      return least > 0 && most / least < 1.5 ? [least / 1.5, most * 1.5] : null;
    }
    if (!(most >= least)) return [-1, 1];
    const size = Math.max(Math.abs(least), Math.abs(most));
    if (most - least > 1e-6 * size) return null;
    return size > 0 ? [least - 0.1 * size, most + 0.1 * size] : [-1, 1];
  }

  drawUnderlay(context, area, graph) {
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    context.fillStyle = styleValue('--outage');
    for (const span of page.time_line.spans) {
      if (span.kind !== 'withheld') continue;
      const left = graph.toDomXCoord(span.from);
      context.fillRect(left, area.y,
                       Math.max(1, graph.toDomXCoord(span.to) - left), area.h);
    }
    context.setLineDash([5, 4]);
    context.strokeStyle = styleValue('--bound');
    for (const level of this.spec.levels) {
      const y = graph.toDomYCoord(level);
      context.beginPath();
      context.moveTo(area.x, y);
      context.lineTo(area.x + area.w, y);
      context.stroke();
    }
    context.restore();
  }

  makeLegend() {
    this.values = [];
    this.lines.forEach((line) => {
      if (line.bound || line.factor < 0 || line.label === '') return;
      const chip = document.createElement('span');
      chip.className = 'chip ' + line.style;
      chip.style.setProperty('--own', `var(${line.colour < 0 ? '--bound' :
          '--c' + line.colour % 8})`);
      const name = document.createElement('span');
      name.textContent = line.label;
      const value = document.createElement('output');
      chip.append(name, value);
      if (line.group >= 0) chip.dataset.group = line.group;
      this.legend.append(chip);
      this.values.push({line, chip, value});
    });
  }

  showCursor() {
    const time = view.cursor;
    const inside = time !== null && time >= view.window[0] &&
        time <= view.window[1];
    this.cursorLine.hidden = !inside;
    if (inside) {
      this.cursorLine.style.transform =
          `translateX(${this.graph.toDomXCoord(time)}px)`;
    }
    for (const {line, chip, value} of this.values) {
      chip.classList.toggle('off', !this.shows(line));
      value.textContent = time === null ? '' : numberText(line.valueAt(time));
    }
  }

  draw() {
    this.dirty = false;
    this.graph.updateOptions({
      file: this.rows(),
      dateWindow: view.window,
      valueRange: this.range(),
      visibility: this.lines.map((line) => this.shows(line)),
      colors: this.colours(),
      gridLineColor: styleValue('--grid'),
      axisLineColor: styleValue('--axis'),
    });
    this.showCursor();
  }

  resize() {
    this.graph.resize();
    this.draw();
  }
}

/** Values of an axis: [{v, label}]. */
function valueTicks(low, high, pixels, isLog) {
  const ticks = [];
  const most = Math.max(2, Math.floor(pixels / 30));
  if (isLog && high > low && low > 0) {
    const decades = Math.log10(high / low);
    const factors = decades * 3 <= most ? [1, 2, 5] :
        decades * 2 <= most ? [1, 3] : [1];
    const skip = Math.max(1, Math.ceil(decades / most));
    for (let power = Math.floor(Math.log10(low));
      power <= Math.ceil(Math.log10(high)); power++) {
      if (factors.length === 1 && power % skip !== 0) continue;
      for (const factor of factors) {
        const v = factor * Math.pow(10, power);
        if (v >= low && v <= high) {
          ticks.push({v, label: numberText(parseFloat(v.toPrecision(3)))});
        }
      }
    }
    if (ticks.length >= 2) return ticks;
    ticks.length = 0;
  }
  const step = niceStep((high - low) / most);
  if (!(step > 1e-12 * Math.abs(high)) || !isFinite(low)) return ticks;
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  for (let k = Math.ceil(low / step); k * step <= high; k++) {
    const v = k * step;
    const label = Math.abs(v) >= 1e6 || decimals > 6 ?
        (v === 0 ? '0' : v.toExponential(1)) : (v + 0).toFixed(decimals);
    ticks.push({v, label});
  }
  return ticks;
}

/** Cursor, zoom by dragging, and all by a double click, on one element. */
function addPointer(plot, timeAt) {
  const band = document.createElement('div');
  band.className = 'band';
  band.hidden = true;
  plot.append(band);
  let start = null;
  const place = (event) => event.clientX - plot.getBoundingClientRect().left;
  plot.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    start = place(event);
    plot.setPointerCapture(event.pointerId);
  });
  plot.addEventListener('pointermove', (event) => {
    const x = place(event);
    view.load();
    view.setCursor(timeAt(x));
    if (start === null || Math.abs(x - start) < 5) return;
    band.hidden = false;
    band.style.left = Math.min(start, x) + 'px';
    band.style.width = Math.abs(x - start) + 'px';
  });
  plot.addEventListener('pointerup', (event) => {
    const x = place(event);
    band.hidden = true;
    if (start !== null && Math.abs(x - start) >= 5) {
      view.setWindow(timeAt(Math.min(start, x)), timeAt(Math.max(start, x)));
    } else if (start !== null) {
      view.setCursor(timeAt(x));
    }
    start = null;
  });
  plot.addEventListener('pointercancel', () => {
    start = null;
    band.hidden = true;
  });
  plot.addEventListener('dblclick', () => view.all());
}
