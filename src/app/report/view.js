'use strict';
// What all charts and the map share: window, cursor, solutions shown.

const page = JSON.parse(document.getElementById('data').textContent);
page.tables = page.tables.map((json, number) => new Table(json, number));

function extentOfData() {
  let from = Infinity;
  let to = -Infinity;
  for (const group of page.groups) {
    const t = page.tables[group.table].t;
    from = Math.min(from, t[0]);
    to = Math.max(to, t[t.length - 1]);
  }
  return to > from ? [from, to] : [from - 0.5, from + 0.5];
}

const view = {
  extent: extentOfData(),
  window: null,
  cursor: null,
  hidden: new Set(),
  base: 0,
  loaded: false,
  listeners: {window: [], cursor: [], groups: [], theme: []},

  on(events, listener) {
    for (const event of events) this.listeners[event].push(listener);
  },

  tell(event) {
    for (const listener of this.listeners[event]) listener();
  },

  get isAll() {
    return this.window[0] <= this.extent[0] && this.window[1] >= this.extent[1];
  },

  setWindow(from, to) {
    const [begin, end] = this.extent;
    const least = Math.max((end - begin) * 1e-6, 1e-3);
    const length = Math.min(Math.max(to - from, least), end - begin);
    const middle = (from + to) / 2;
    let first = Math.max(begin, middle - length / 2);
    first = Math.min(first, end - length);
    this.window = [first, first + length];
    this.load();
    this.tell('window');
  },

  all() {
    this.setWindow(this.extent[0], this.extent[1]);
  },

  zoom(factor) {
    const [from, to] = this.window;
    const inside = this.cursor !== null && this.cursor >= from &&
        this.cursor <= to;
    const about = inside ? this.cursor : (from + to) / 2;
    this.setWindow(about - (about - from) * factor,
                   about + (to - about) * factor);
  },

  pan(share) {
    const step = share * (this.window[1] - this.window[0]);
    this.setWindow(this.window[0] + step, this.window[1] + step);
  },

  setCursor(time) {
    this.cursor = time === null ? null :
        Math.min(Math.max(time, this.extent[0]), this.extent[1]);
    this.tell('cursor');
  },

  toggle(group) {
    if (!this.hidden.delete(group)) this.hidden.add(group);
    this.tell('groups');
  },

  shows(group) {
    return group < 0 || !this.hidden.has(group);
  },

  /** All rows; draws anew when they are there. */
  async load() {
    if (this.loading) return this.loading;
    this.loading = (async () => {
      let any = false;
      for (const table of page.tables) any = await table.load() || any;
      this.loaded = true;
      document.documentElement.dataset.loaded = 'yes';
      if (any) {
        this.tell('window');
        this.tell('cursor');
      }
    })();
    return this.loading;
  },
};
view.window = view.extent.slice();

/** A variable of the style sheet: "--c0". */
function styleValue(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name)
      .trim();
}

function colourOf(number) {
  return number < 0 ? styleValue('--bound') : styleValue('--c' + number % 8);
}

const isLong = view.extent[1] - view.extent[0] > 7200;

function twoDigits(n) {
  return String(n).padStart(2, '0');
}

/** "123.4 s", or "3:25:07" on a page of more than two hours. */
function timeText(t, decimals) {
  if (!isLong) return t.toFixed(decimals) + ' s';
  const sign = t < 0 ? '-' : '';
  const whole = Math.floor(Math.abs(t) + 1e-9);
  const rest = Math.abs(t) - whole;
  let text = sign + Math.floor(whole / 3600) + ':' +
      twoDigits(Math.floor(whole / 60) % 60) + ':' + twoDigits(whole % 60);
  if (decimals > 0) text += rest.toFixed(decimals).slice(1);
  return text;
}

function utcText(t) {
  if (!page.utc) return '';
  const instant = new Date(Date.parse(page.utc) + 1000 * t);
  return isNaN(instant) ? '' : instant.toISOString().replace('T', ' ');
}

/** Times of an axis of `width` pixels: [{v, label}]. */
function timeTicks(from, to, width) {
  const most = Math.max(2, Math.floor(width / 85));
  const steps = isLong ?
      [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15,
       30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 21600, 43200,
       86400] : null;
  let step;
  if (steps) {
    step = steps.find((s) => (to - from) / s <= most) || 172800;
  } else {
    step = niceStep((to - from) / most);
  }
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const ticks = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to; k++) {
    ticks.push({v: k * step, label: timeText(k * step, decimals)});
  }
  return ticks;
}

/** The least of 1, 2, 5 times a power of ten that is not below `value`. */
function niceStep(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  for (const factor of [1, 2, 5, 10]) {
    if (factor * power >= value * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

/** A number in four digits. */
function numberText(value) {
  if (value === null || !isFinite(value)) return '\u2013';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
  return String(parseFloat(value.toPrecision(4)));
}
