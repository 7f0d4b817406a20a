'use strict';
// The time line: a lane for each stream, and for each kind of span.

const kLaneHeight = 36;

class TimeLineView {
  constructor(element) {
    this.element = element;
    this.lanes = page.time_line.lanes.map(
        (lane) => ({label: lane.label, table: page.tables[lane.table]}));
    this.kinds = [['rests', 'at rest'], ['gaps', 'no data'],
                  ['unobserved', 'not observed']]
        .map(([kind, label]) => ({
          kind, label,
          spans: page.time_line.spans.filter((span) => span.kind === kind),
        })).filter((lane) => lane.spans.length > 0);
    this.height = kLaneHeight * (this.lanes.length + this.kinds.length) + 26;
    element.style.height = this.height + 'px';
    this.canvas = document.createElement('canvas');
    element.append(this.canvas);
    this.cursorLine = document.createElement('div');
    this.cursorLine.className = 'cursor';
    element.append(this.cursorLine);
    addPointer(element, (x) => this.timeAt(x));
    this.makeLegend();
    this.draw();
  }

  makeLegend() {
    const legend = document.getElementById('lane-legend');
    for (const [label, colour] of [['used', '--c0'], ['rejected', '--bad'],
                                   ['withheld', '--c1']]) {
      const chip = document.createElement('span');
      chip.className = 'chip';
      chip.style.setProperty('--own', `var(${colour})`);
      chip.textContent = label;
      legend.append(chip);
    }
  }

  get plotWidth() {
    return this.element.clientWidth - 16;
  }

  timeAt(x) {
    const [from, to] = view.window;
    return from + (x - 8) / this.plotWidth * (to - from);
  }

  xOf(t) {
    const [from, to] = view.window;
    return 8 + (t - from) / (to - from) * this.plotWidth;
  }

  draw() {
    this.dirty = false;
    const width = this.element.clientWidth;
    const context = sizedContext(this.canvas, width, this.height);
    context.clearRect(0, 0, width, this.height);
    context.font = '12px system-ui, sans-serif';
    let y = 0;
    for (const lane of this.lanes) {
      this.drawLabel(context, lane.label, y);
      this.drawStream(context, lane.table, y + 16);
      y += kLaneHeight;
    }
    for (const lane of this.kinds) {
      const inside = lane.spans.filter((span) =>
        span.to >= view.window[0] && span.from <= view.window[1]);
      const names = [...new Set(inside.map((span) => span.label))]
          .filter((name) => name !== '');
      this.drawLabel(context, lane.label +
          (names.length ? ': ' + names.join(', ') : ''), y);
      context.fillStyle = styleValue(
          lane.kind === 'rests' ? '--c2' :
          lane.kind === 'gaps' ? '--axis' : '--c3');
      for (const span of inside) this.fillSpan(context, span, y + 16, 12);
      y += kLaneHeight;
    }
    this.drawAxis(context, y, width);
    this.showCursor();
  }

  drawLabel(context, text, y) {
    context.fillStyle = styleValue('--muted');
    context.textBaseline = 'top';
    let shown = text;
    while (shown.length > 4 &&
           context.measureText(shown).width > this.plotWidth) {
      shown = shown.slice(0, -2).replace(/…?$/, '') + '…';
    }
    context.fillText(shown, 8, y + 1);
    context.fillStyle = styleValue('--lane');
    context.fillRect(8, y + 16, this.plotWidth, 12);
  }

  fillSpan(context, span, y, height) {
    const left = Math.max(8, this.xOf(span.from));
    const right = Math.min(8 + this.plotWidth, this.xOf(span.to));
    context.fillRect(left, y, Math.max(1, right - left), height);
  }

  /** One mark a pixel; what was rejected is never hidden. */
  drawStream(context, table, y) {
    const fates = [['used', '--c0'], ['withheld', '--c1'],
                   ['rejected', '--bad']];
    const t = table.t;
    const begin = lowerBound(t, view.window[0]);
    const end = lowerBound(t, view.window[1] + 1e-9);
    const step = medianStep(t);
    for (const [fate, colour] of fates) {
      if (!table.has(fate)) continue;
      const v = table.column(fate);
      context.fillStyle = styleValue(colour);
      const high = fate === 'rejected';
      let drawn = -10;
      for (let i = begin; i < end; i++) {
        if (isNaN(v[i])) continue;
        const x = this.xOf(t[i]);
        const next = i + 1 < t.length ? t[i + 1] : t[i] + step;
        const right = high ? x + 1.5 :
            Math.max(x + 1.5, this.xOf(Math.min(next, t[i] + 1.5 * step)) -
                     (next - t[i] > 1.5 * step ? 0 : 0.25));
        if (right - drawn < 0.5) continue;
        context.fillRect(Math.max(x, drawn), high ? y - 3 : y,
                         right - Math.max(x, drawn), high ? 18 : 12);
        drawn = right;
      }
    }
  }

  drawAxis(context, y, width) {
    context.fillStyle = styleValue('--ink');
    context.textBaseline = 'top';
    for (const tick of timeTicks(view.window[0], view.window[1],
                                 this.plotWidth)) {
      const x = this.xOf(tick.v);
      const half = context.measureText(tick.label).width / 2;
      context.fillStyle = styleValue('--grid');
      context.fillRect(x, 0, 1, y);
      context.fillStyle = styleValue('--ink');
      context.fillText(tick.label,
                       Math.min(Math.max(x - half, 0), width - 2 * half),
                       y + 6);
    }
  }

  showCursor() {
    const time = view.cursor;
    const inside = time !== null && time >= view.window[0] &&
        time <= view.window[1];
    this.cursorLine.hidden = !inside;
    if (inside) {
      this.cursorLine.style.transform = `translateX(${this.xOf(time)}px)`;
    }
  }

  resize() {
    this.draw();
  }
}

/** The median of some steps: what is usual for a stream. */
function medianStep(t) {
  const steps = [];
  const stride = Math.max(1, Math.floor(t.length / 500));
  for (let i = 1; i < t.length; i += stride) steps.push(t[i] - t[i - 1]);
  steps.sort((a, b) => a - b);
  return steps.length ? steps[steps.length >> 1] : 0;
}

/** The context of a canvas of so many style pixels, sharp on any screen. */
function sizedContext(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1;
  const wide = Math.round(width * ratio);
  const high = Math.round(height * ratio);
  if (canvas.width !== wide || canvas.height !== high) {
    canvas.width = wide;
    canvas.height = high;
    canvas.style.width = width + 'px';
    canvas.style.height = height + 'px';
  }
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}
