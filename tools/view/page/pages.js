// The pages of the file: counts, a strip of their states, and the levels of the tree.

import {fill} from './answer.js';

const kStates = ['--unread', '--resident', '--wanted', '--evicted'];
const count = (number) => number.toLocaleString('en-US');

export const cssColour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Makes the canvas as large as it is shown. Returns its context, in which a unit is a dot.
export function sized(canvas) {
  const scale = window.devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
  canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
  return canvas.getContext('2d');
}

export class PagesPanel {
  // hasStates: whether the states of single pages are known
  constructor(hasStates) {
    this.hasStates = hasStates;
    for (const part of document.querySelectorAll('.of-states')) part.hidden = !hasStates;
    this.list = document.getElementById('pages');
    this.strip = document.getElementById('strip');
    this.levels = document.querySelector('#levels tbody');
    this.states = new Uint8Array(0);
    this.changes = -1;
    this.onStates = () => {};
    new ResizeObserver(() => this.draw()).observe(this.strip);
  }

  // Asks for the counts, and for the states if they have changed.
  async update() {
    const stats = await (await fetch('stats')).json();
    this.show(stats);
    if (!this.hasStates || stats.changes === this.changes) return;
    this.changes = stats.changes;
    const bytes = new Uint8Array(await (await fetch('pages')).arrayBuffer());
    this.states = bytes.subarray(0, bytes.length / 2);
    this.draw();
    this.onStates(this.states);
  }

  show(stats) {
    const rows = [
      ['loaded', `${count(stats.loaded)} since the start`],
      ['in memory', `${count(stats.resident)}, room for ${count(stats.frames)}`],
      ...(this.hasStates ? [['wanted', count(stats.wanted)]] : []),
      ['evicted', count(stats.evicted)],
    ];
    if (this.hasStates) this.showStates(stats, rows);
    else rows.push(['lookups', `${count(stats.page_hits)}, and ${count(stats.page_misses)} that lacked a page`]);
    if (stats.quarantined_pages > 0) rows.push(['damaged', count(stats.quarantined_pages)]);
    fill(this.list, rows);
  }

  showStates(stats, rows) {
    for (const part of stats.parts)
      if (part.pages > 0) rows.push([`of the ${part.name}`, `${count(part.resident)} of ${count(part.pages)}`]);
    this.strip.setAttribute('aria-label', `All pages in the order of the file: ${count(stats.resident)} ` +
      `in memory, ${count(stats.wanted)} wanted, ${count(stats.evicted)} evicted so far`);
    this.showLevels(stats.levels);
  }

  showLevels(levels) {
    const shown = levels.map((level, number) => ({...level, number})).filter((level) => level.pages > 0);
    while (this.levels.rows.length > shown.length) this.levels.deleteRow(-1);
    shown.forEach((level, i) => {
      const row = this.levels.rows[i] ?? this.newRow();
      [level.number, count(level.pages), count(level.resident)].forEach((word, at) => {
        row.cells[at].textContent = word;
      });
      const meter = row.cells[3].firstChild;
      meter.max = level.pages;
      meter.value = level.resident;
      meter.setAttribute('aria-label', `share of level ${level.number} in memory`);
    });
  }

  newRow() {
    const row = this.levels.insertRow();
    for (let i = 0; i < 4; ++i) row.insertCell();
    row.cells[3].className = 'bar';
    row.cells[3].append(document.createElement('meter'));
    return row;
  }

  // A column shows the most telling state of its pages.
  draw() {
    const context = sized(this.strip);
    const {width, height} = this.strip;
    const colours = kStates.map(cssColour), order = [0, 3, 1, 2];
    const pages = this.states.length;
    for (let x = 0; x < width && pages > 0; ++x) {
      const first = Math.floor(x * pages / width);
      const last = Math.max(first + 1, Math.floor((x + 1) * pages / width));
      let found = 0;
      for (let page = first; page < last; ++page)
        if (order.indexOf(this.states[page]) > order.indexOf(found)) found = this.states[page];
      context.fillStyle = colours[found];
      context.fillRect(x, 0, 1, height);
    }
  }
}
