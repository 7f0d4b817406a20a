'use strict';
// Charts over time, drawn by dygraphs from the extremes of each pixel.

const kAxisWidth = 58;

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

  /** Which rows count for the range: not those that say next to nothing. */
  counter(line, begin, end) {
    if (!line.spread) return () => true;
    const kMuch = 10;
    const spread = line.source.column(line.spread);
    const usual = spread.slice(begin, end).filter((x) => x > 0).sort();
    const limit = kMuch * usual[usual.length >> 1];
    return (i) => spread[i] <= limit;
  }

  /** A flat or empty chart gets a height of its own; else dygraphs decides. */
  range() {
    let least = Infinity;
    let most = -Infinity;
    for (const line of this.lines) {
      if (!this.shows(line)) continue;
      const {t, v} = line.series();
      const end = Math.min(t.length, lowerBound(t, view.window[1]) + 1);
      const begin = lowerBound(t, view.window[0]);
      const counts = this.counter(line, begin, end);
      for (let i = begin; i < end; i++) {
        if (!counts(i)) continue;
        if (v[i] < least) least = v[i];
        if (v[i] > most) most = v[i];
      }
    }
    if (this.lines.some((line) => line.spread) && most > least) {
      return [least - 0.05 * (most - least), most + 0.05 * (most - least)];
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
