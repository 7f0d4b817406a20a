'use strict';
// The map: metres north and east of the first position, north up.

/** Dark blue to yellow, of equal steps in lightness (after viridis). */
const kRamp = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98],
               [253, 231, 37]];

const darkScheme = matchMedia('(prefers-color-scheme: dark)');

/** Without the end that the ground would swallow. */
function rampColour(share) {
  const part = Math.min(Math.max(share, 0), 1);
  const x = (darkScheme.matches ? 0.3 + 0.7 * part : 0.93 * part) *
      (kRamp.length - 1);
  const i = Math.min(Math.floor(x), kRamp.length - 2);
  const rgb = kRamp[i].map(
      (low, j) => Math.round(low + (x - i) * (kRamp[i + 1][j] - low)));
  return `rgb(${rgb.join(',')})`;
}

const kGrades = [['usable', '--usable'], ['doubtful', '--doubtful'],
                 ['not usable', '--unusable']];

/** The worst grade that the evidence leaves at a time: an index of kGrades. */
function gradeAt(time) {
  return Math.max(0, ...page.map.grades
      .filter((span) => span.from <= time && time <= span.to)
      .map((span) => span.grade));
}

class MapView {
  constructor(element) {
    this.element = element;
    this.canvas = document.createElement('canvas');
    element.append(this.canvas);
    this.modes = [['sd_h', 'horizontal sigma', 'm'], ['speed', 'speed', 'm/s'],
                  ['grade', 'grade', ''], ['', 'method', '']]
        .filter(([column]) => column === '' || column === 'grade' ||
            page.tables[page.groups[0].table].has(column));
    this.mode = this.modes[0];
    this.layers = {fixes: true, ellipses: true};
    this.makeTools();
    this.addPointer();
    this.fit();
  }

  makeTools() {
    const tools = document.getElementById('map-tools');
    const label = document.createElement('label');
    label.textContent = 'Colour by ';
    const select = document.createElement('select');
    this.modes.forEach(([, name], i) => select.add(new Option(name, i)));
    select.addEventListener('change', () => {
      this.mode = this.modes[select.value];
      this.draw();
    });
    label.append(select);
    tools.append(label);
    for (const name of Object.keys(this.layers)) {
      if (name === 'fixes' && page.map.fixes === undefined) continue;
      const box = document.createElement('label');
      const input = document.createElement('input');
      input.type = 'checkbox';
      input.checked = true;
      input.addEventListener('change', () => {
        this.layers[name] = input.checked;
        this.draw();
      });
      box.append(input, ' ' + name);
      tools.append(box);
    }
    this.key = document.createElement('span');
    this.key.className = 'key';
    tools.append(this.key);
  }

  /** Rows of a solution that are exact in place: all, or some. */
  track(group) {
    const table = page.tables[page.groups[group].table];
    return table.isExact ? table : page.tables[page.groups[group].samples];
  }

  /** Solutions shown; of others than the first those of which all rows are. */
  get groups() {
    return page.groups.map((group, i) => i).filter((i) => view.shows(i) &&
        this.track(i).has('north') &&
        (i === 0 || page.tables[page.groups[i].table].isExact));
  }

  /** Shows what the recommended solution does within the window. */
  fit() {
    const table = this.track(0);
    const north = table.column('north');
    const east = table.column('east');
    let box = null;
    const end = lowerBound(table.t, view.window[1] + 1e-9);
    for (let i = lowerBound(table.t, view.window[0]); i < end; i++) {
      if (isNaN(north[i])) continue;
      if (!box) box = [north[i], north[i], east[i], east[i]];
      box[0] = Math.min(box[0], north[i]);
      box[1] = Math.max(box[1], north[i]);
      box[2] = Math.min(box[2], east[i]);
      box[3] = Math.max(box[3], east[i]);
    }
    if (box) {
      this.centre = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2];
      const [width, height] = this.size();
      this.scale = Math.min((width - 90) / Math.max(box[3] - box[2], 1),
                            (height - 70) / Math.max(box[1] - box[0], 1));
    }
    this.draw();
  }

  size() {
    return [Math.max(this.element.clientWidth, 100),
            Math.max(this.element.clientHeight, 100)];
  }

  x(east) {
    return this.size()[0] / 2 + (east - this.centre[1]) * this.scale;
  }

  y(north) {
    return this.size()[1] / 2 - (north - this.centre[0]) * this.scale;
  }

  draw() {
    this.dirty = false;
    const [width, height] = this.size();
    const context = sizedContext(this.canvas, width, height);
    context.clearRect(0, 0, width, height);
    context.font = '12px system-ui, sans-serif';
    this.centreX = width / 2 - this.centre[1] * this.scale;
    this.centreY = height / 2 + this.centre[0] * this.scale;
    this.drawGrid(context, width, height);
    this.drawOutages(context);
    for (const group of this.groups.slice().reverse()) {
      this.drawTrack(context, group);
    }
    if (this.layers.fixes) this.drawFixes(context, width, height);
    if (this.layers.ellipses) this.drawEllipses(context, width, height);
    this.drawCursor(context);
    this.drawScale(context, width, height);
    this.showKey();
  }

  drawGrid(context, width, height) {
    const step = niceStep(90 / this.scale);
    const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
    context.lineWidth = 1;
    context.strokeStyle = styleValue('--grid');
    context.fillStyle = styleValue('--muted');
    const label = (k) => (k * step).toFixed(decimals);
    const left = -this.centreX / this.scale;
    context.textBaseline = 'bottom';
    context.textAlign = 'center';
    for (let k = Math.ceil(left / step); ; k++) {
      const x = this.centreX + k * step * this.scale;
      if (x > width) break;
      line(context, x, 0, x, height);
      if (x > 60 && x < width - 30) {
        context.fillText(label(k) + ' E', x, height - 4);
      }
    }
    const bottom = (this.centreY - height) / this.scale;
    context.textBaseline = 'middle';
    context.textAlign = 'left';
    for (let k = Math.ceil(bottom / step); ; k++) {
      const y = this.centreY - k * step * this.scale;
      if (y < 0) break;
      line(context, 0, y, width, y);
      if (y > 12 && y < height - 26) context.fillText(label(k) + ' N', 4, y);
    }
  }

  /** A path of the rows from `begin` to `end`, a point a pixel at most. */
  path(context, table, begin, end) {
    const north = table.column('north');
    const east = table.column('east');
    let open = false;
    let lastX = NaN;
    let lastY = NaN;
    context.beginPath();
    for (let i = begin; i < end; i++) {
      if (isNaN(north[i])) {
        open = false;
        continue;
      }
      const x = this.centreX + east[i] * this.scale;
      const y = this.centreY - north[i] * this.scale;
      if (!open) context.moveTo(x, y);
      else if (i + 1 < end && Math.abs(x - lastX) + Math.abs(y - lastY) < 0.7) {
        continue;
      } else context.lineTo(x, y);
      open = true;
      lastX = x;
      lastY = y;
    }
    context.stroke();
  }

  drawTrack(context, group) {
    const table = this.track(group);
    const begin = lowerBound(table.t, view.window[0]);
    const end = lowerBound(table.t, view.window[1] + 1e-9);
    context.lineJoin = 'round';
    context.lineWidth = 1;
    context.strokeStyle = styleValue('--faded');
    if (!view.isAll && group === 0) {
      this.path(context, table, 0, table.t.length);
    }
    if (group === 0 && this.mode[0] === 'grade') {
      this.drawGraded(context, table, begin, end);
      return;
    }
    if (group === 0 && this.mode[0] !== '') {
      this.drawColoured(context, table, begin, end);
      return;
    }
    context.lineWidth = group === 0 ? 2.2 : 1.2;
    context.strokeStyle = colourOf(group);
    this.path(context, table, begin, end);
  }

  drawColoured(context, table, begin, end) {
    const values = table.column(this.mode[0]);
    const [low, high] = this.bounds(values, begin, end);
    context.lineWidth = 3;
    let first = begin;
    const class_ = (i) => Math.round(24 * this.share(values[i], low, high));
    for (let i = begin + 1; i <= end; i++) {
      if (i < end && class_(i) === class_(first)) continue;
      context.strokeStyle = rampColour(class_(first) / 24);
      this.path(context, table, first, Math.min(i + 1, end));
      first = i;
    }
    this.shown = [low, high];
  }

  /** What evidence speaks of in the colour of the grade that it leaves. */
  drawGraded(context, table, begin, end) {
    context.lineWidth = 3;
    let first = begin;
    for (let i = begin + 1; i <= end; i++) {
      if (i < end && gradeAt(table.t[i]) === gradeAt(table.t[first])) continue;
      context.strokeStyle = styleValue(kGrades[gradeAt(table.t[first])][1]);
      this.path(context, table, first, Math.min(i + 1, end));
      first = i;
    }
  }

  bounds(values, begin, end) {
    const some = [];
    const step = Math.max(1, Math.floor((end - begin) / 2000));
    for (let i = begin; i < end; i += step) {
      if (values[i] >= 0) some.push(values[i]);
    }
    some.sort((a, b) => a - b);
    if (some.length === 0) return [0, 1];
    const low = some[Math.floor(0.01 * (some.length - 1))];
    const high = some[Math.ceil(0.99 * (some.length - 1))];
    return high > low ? [low, high] : [low * 0.99, low * 1.01 + 1e-12];
  }

  /** Sigma by its logarithm, speed as it is. */
  share(value, low, high) {
    if (this.mode[0] === 'sd_h' && low > 0) {
      return Math.min(Math.max(Math.log(value / low) / Math.log(high / low),
                               0), 1);
    }
    return Math.min(Math.max((value - low) / (high - low), 0), 1);
  }

  showKey() {
    this.key.hidden = this.mode[0] === '' ||
        (this.mode[0] !== 'grade' && !this.shown);
    if (this.key.hidden) return;
    if (this.mode[0] === 'grade') {
      this.key.replaceChildren(...kGrades.map(([name, colour]) => {
        const chip = document.createElement('span');
        chip.className = 'chip';
        chip.style.setProperty('--own', `var(${colour})`);
        chip.textContent = name;
        return chip;
      }));
      return;
    }
    const stops = [0, 0.25, 0.5, 0.75, 1].map(rampColour).join(',');
    this.key.innerHTML = '<span></span><i></i><span></span>';
    this.key.children[0].textContent = numberText(this.shown[0]);
    this.key.children[1].style.background =
        `linear-gradient(to right, ${stops})`;
    this.key.children[2].textContent = numberText(this.shown[1]) + ' ' +
        this.mode[2];
  }

  drawOutages(context) {
    const table = this.track(0);
    context.lineWidth = 11;
    context.lineCap = 'butt';
    context.strokeStyle = styleValue('--outage-track');
    for (const span of page.time_line.spans) {
      if (span.kind !== 'withheld') continue;
      const begin = lowerBound(table.t, Math.max(span.from, view.window[0]));
      const end = lowerBound(table.t, Math.min(span.to, view.window[1]));
      this.path(context, table, begin, end);
    }
  }

  /** Those used only so close together that the track stays to be seen. */
  drawFixes(context, width, height) {
    let lastX = -1e9;
    let lastY = -1e9;
    if (page.map.fixes === undefined) return;
    const table = page.tables[page.map.fixes];
    const north = table.column('north');
    const east = table.column('east');
    const fate = table.column('fate');
    const end = lowerBound(table.t, view.window[1] + 1e-9);
    const colours = [null, styleValue('--fix'), styleValue('--bad'),
                     styleValue('--c1'), styleValue('--faded')];
    for (let i = lowerBound(table.t, view.window[0]); i < end; i++) {
      const x = this.centreX + east[i] * this.scale;
      const y = this.centreY - north[i] * this.scale;
      if (x < 0 || y < 0 || x > width || y > height) continue;
      const colour = colours[fate[i]];
      if (fate[i] === 2) drawCross(null, '', context, x, y, colour);
      else if (fate[i] === 3) drawRing(null, '', context, x, y, colour);
      else if (Math.hypot(x - lastX, y - lastY) >= 9) {
        lastX = x;
        lastY = y;
        context.fillStyle = colour;
        context.fillRect(x - 1, y - 1, 2, 2);
      }
    }
  }

  /** One sigma, where it is large enough to be seen, 40 pixels apart. */
  drawEllipses(context, width, height) {
    const table = this.track(0);
    if (!table.has('sd_n') || !table.has('cov_ne')) return;
    const [n, e, sn, se, c] = ['north', 'east', 'sd_n', 'sd_e', 'cov_ne']
        .map((name) => table.column(name));
    const end = lowerBound(table.t, view.window[1] + 1e-9);
    context.strokeStyle = styleValue('--ink');
    context.lineWidth = 1;
    let lastX = -1e9;
    let lastY = -1e9;
    for (let i = lowerBound(table.t, view.window[0]); i < end; i++) {
      const x = this.centreX + e[i] * this.scale;
      const y = this.centreY - n[i] * this.scale;
      if (Math.hypot(x - lastX, y - lastY) < 40) continue;
      if (x < 0 || y < 0 || x > width || y > height) continue;
      const a = sn[i] * sn[i];
      const b = se[i] * se[i];
      const root = Math.hypot((a - b) / 2, c[i]);
      const major = Math.sqrt((a + b) / 2 + root) * this.scale;
      const minor = Math.sqrt(Math.max((a + b) / 2 - root, 0)) * this.scale;
      if (!(major > 4)) continue;
      const azimuth = Math.atan2(2 * c[i], a - b) / 2;
      context.beginPath();
      context.ellipse(x, y, major, minor, azimuth - Math.PI / 2, 0,
                      2 * Math.PI);
      context.stroke();
      lastX = x;
      lastY = y;
    }
  }

  drawCursor(context) {
    if (view.cursor === null) return;
    for (const group of this.groups.slice().reverse()) {
      const table = this.track(group);
      const i = nearestRow(table.t, view.cursor);
      const x = this.x(table.column('east')[i]);
      const y = this.y(table.column('north')[i]);
      context.beginPath();
      context.arc(x, y, group === 0 ? 6 : 4, 0, 2 * Math.PI);
      context.fillStyle = colourOf(group);
      context.fill();
      context.strokeStyle = styleValue('--paper');
      context.lineWidth = 2;
      context.stroke();
    }
  }

  drawScale(context, width, height) {
    const length = niceStep(70 / this.scale);
    const pixels = length * this.scale;
    const text = length >= 1000 ? length / 1000 + ' km' :
        numberText(length) + ' m';
    const x = width - pixels - 14;
    context.fillStyle = styleValue('--paper');
    context.globalAlpha = 0.8;
    context.fillRect(x - 8, height - 52, pixels + 16, 28);
    context.globalAlpha = 1;
    context.strokeStyle = styleValue('--ink');
    context.fillStyle = styleValue('--ink');
    context.lineWidth = 2;
    line(context, x, height - 30, x + pixels, height - 30);
    context.textAlign = 'center';
    context.textBaseline = 'bottom';
    context.fillText(text, x + pixels / 2, height - 34);
    context.textAlign = 'left';
  }

  showCursor() {
    this.draw();
  }

  resize() {
    this.fit();
  }

  zoomAt(x, y, factor) {
    const [width, height] = this.size();
    const east = this.centre[1] + (x - width / 2) / this.scale;
    const north = this.centre[0] - (y - height / 2) / this.scale;
    this.scale = Math.min(Math.max(this.scale * factor, 1e-5), 1e5);
    this.centre = [north + (y - height / 2) / this.scale,
                   east - (x - width / 2) / this.scale];
    view.load();
    this.draw();
  }

  /** The time at which the recommended solution is nearest to a place. */
  timeNear(x, y) {
    const table = this.track(0);
    const north = table.column('north');
    const east = table.column('east');
    let best = null;
    let least = 30 * 30;
    const end = lowerBound(table.t, view.window[1] + 1e-9);
    for (let i = lowerBound(table.t, view.window[0]); i < end; i++) {
      const dx = this.centreX + east[i] * this.scale - x;
      const dy = this.centreY - north[i] * this.scale - y;
      if (dx * dx + dy * dy < least) {
        least = dx * dx + dy * dy;
        best = table.t[i];
      }
    }
    return best;
  }

  addPointer() {
    const pointers = new Map();
    let moved = 0;
    const place = (event) => {
      const box = this.element.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.element.addEventListener('pointerdown', (event) => {
      this.element.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, place(event));
      moved = 0;
    });
    this.element.addEventListener('pointermove', (event) => {
      if (!pointers.has(event.pointerId)) return;
      const old = pointers.get(event.pointerId);
      const now = place(event);
      const others = [...pointers.keys()].filter((k) => k !== event.pointerId);
      if (others.length === 1) {
        const other = pointers.get(others[0]);
        const before = Math.hypot(old[0] - other[0], old[1] - other[1]);
        const after = Math.hypot(now[0] - other[0], now[1] - other[1]);
        if (before > 0) {
          this.zoomAt((now[0] + other[0]) / 2, (now[1] + other[1]) / 2,
                      after / before);
        }
      } else {
        this.centre[1] -= (now[0] - old[0]) / this.scale;
        this.centre[0] += (now[1] - old[1]) / this.scale;
        this.draw();
      }
      moved += Math.abs(now[0] - old[0]) + Math.abs(now[1] - old[1]);
      pointers.set(event.pointerId, now);
    });
    const end = (event) => pointers.delete(event.pointerId);
    this.element.addEventListener('pointerup', (event) => {
      end(event);
      if (moved > 4) return;
      const time = this.timeNear(...place(event));
      if (time !== null) {
        view.load();
        view.setCursor(time);
      }
    });
    this.element.addEventListener('pointercancel', end);
    this.element.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoomAt(...place(event), Math.exp(-event.deltaY / 400));
    }, {passive: false});
    this.element.addEventListener('dblclick', () => {
      view.all();
      this.fit();
    });
  }
}

function line(context, x1, y1, x2, y2) {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}
