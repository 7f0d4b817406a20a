'use strict';
// Puts the page together: charts, map, time line, the bar at the top, keys.

const charts = [...document.querySelectorAll('figure[data-chart]')]
    .map((element) => new ChartView(element));
const lanes = document.getElementById('lanes');
const timeLine = lanes ? new TimeLineView(lanes) : null;
const mapElement = document.getElementById('map-view');
const map = mapElement ? new MapView(mapElement) : null;
const all = [...charts, timeLine, map].filter((one) => one !== null);

/** What is on the screen is drawn at once, the rest when it comes there. */
const observer = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    const one = all.find((other) => other.element === entry.target);
    one.onScreen = entry.isIntersecting;
    if (one.onScreen && one.dirty) one.draw();
    if (one.onScreen) one.showCursor();
  }
}, {rootMargin: '300px'});
for (const one of all) observer.observe(one.element);

function drawAll() {
  for (const one of all) {
    one.dirty = true;
    if (one.onScreen) one.draw();
  }
}

view.on(['window'], () => {
  drawAll();
  if (map) map.fit();
  showBar();
});
view.on(['cursor'], () => {
  for (const one of all) if (one.onScreen) one.showCursor();
  showBar();
});
view.on(['groups', 'theme'], () => {
  drawAll();
  showBar();
});

let resizing = 0;
let shownWidth = document.querySelector('main').clientWidth;
new ResizeObserver(([entry]) => {
  const width = entry.target.clientWidth;
  if (width === shownWidth) return;
  shownWidth = width;
  cancelAnimationFrame(resizing);
  resizing = requestAnimationFrame(() => {
    for (const one of all) one.resize();
  });
}).observe(document.querySelector('main'));

window.addEventListener('beforeprint', () => {
  for (const one of all) one.resize();
});
matchMedia('(prefers-color-scheme: dark)')
    .addEventListener('change', () => view.tell('theme'));

// The bar: solutions, window, cursor.

const bar = document.getElementById('bar');
const groupButtons = [];

function button(text, title, action) {
  const element = document.createElement('button');
  element.type = 'button';
  element.textContent = text;
  element.title = title;
  element.addEventListener('click', action);
  return element;
}

function makeBar() {
  bar.hidden = false;
  const solutions = document.createElement('div');
  solutions.className = 'solutions';
  page.groups.forEach((group, i) => {
    const one = button(group.label, 'show or hide ' + group.label,
                       () => view.toggle(i));
    one.className = 'solution';
    one.style.setProperty('--own', `var(--c${i % 8})`);
    groupButtons.push(one);
    solutions.append(one);
  });
  const tools = document.createElement('div');
  tools.className = 'window';
  tools.append(
      button('\u2212', 'zoom out (key -)', () => view.zoom(2)),
      button('+', 'zoom in (key +)', () => view.zoom(0.5)),
      button('All', 'show all (key 0)', () => view.all()));
  const range = document.createElement('span');
  range.id = 'range';
  const cursor = document.createElement('output');
  cursor.id = 'cursor-time';
  tools.append(range, cursor);
  const help = document.createElement('span');
  help.className = 'help';
  help.textContent = 'drag: zoom \u00b7 \u2190 \u2192 cursor \u00b7 + \u2212 ' +
      '0 zoom \u00b7 [ ] move';
  bar.append(solutions, tools, help);
}

function showBar() {
  groupButtons.forEach((one, i) =>
    one.setAttribute('aria-pressed', String(view.shows(i))));
  const [from, to] = view.window;
  const decimals = to - from < 1 ? 3 : to - from < 100 ? 1 : 0;
  document.getElementById('range').textContent =
      timeText(from, decimals) + ' \u2013 ' + timeText(to, decimals);
  const cursor = document.getElementById('cursor-time');
  cursor.textContent = view.cursor === null ? '' : 't = ' +
      timeText(view.cursor, 2) + (page.utc ? ', ' +
      utcText(view.cursor).slice(11, 22) + ' UTC' : '');
}

function makeBaseChoice() {
  const place = document.getElementById('base');
  if (!place) return;
  const select = document.createElement('select');
  select.setAttribute('aria-label', 'solution that is subtracted');
  page.groups.forEach((group, i) => select.add(new Option(group.label, i)));
  select.addEventListener('change', () => {
    view.base = Number(select.value);
    view.tell('groups');
  });
  place.replaceChildren(select);
}

// Rows of tables that lead to a time, and chips that switch solutions.

function zoomToRow(row) {
  const from = Number(row.dataset.from);
  const to = Number(row.dataset.to);
  view.setCursor((from + to) / 2);
  view.setWindow(from, to);
}

document.addEventListener('click', (event) => {
  const row = event.target.closest('tr.zooms');
  if (row) zoomToRow(row);
  const chip = event.target.closest('.chip[data-group]');
  if (chip) view.toggle(Number(chip.dataset.group));
});

const kKeys = {
  '+': () => view.zoom(0.5),
  '=': () => view.zoom(0.5),
  '-': () => view.zoom(2),
  '0': () => view.all(),
  'Home': () => view.all(),
  '[': () => view.pan(-0.5),
  ']': () => view.pan(0.5),
  'ArrowLeft': (event) => moveCursor(event.shiftKey ? -0.1 : -0.005),
  'ArrowRight': (event) => moveCursor(event.shiftKey ? 0.1 : 0.005),
};

function moveCursor(share) {
  const [from, to] = view.window;
  const start = view.cursor === null ? (from + to) / 2 : view.cursor;
  view.load();
  view.setCursor(start + share * (to - from));
}

document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.closest('select, input, textarea')) return;
  const row = event.target.closest('tr.zooms');
  if (row && event.key === 'Enter') zoomToRow(row);
  const action = kKeys[event.key];
  if (!action) return;
  event.preventDefault();
  action(event);
});

makeBar();
makeBaseChoice();
showBar();
document.documentElement.dataset.ready = 'yes';
// All rows, once the page is there to be seen.
window.addEventListener('load', () => setTimeout(() => view.load(), 50));
