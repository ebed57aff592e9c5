#include "tools/html/page_script.h"

namespace planetree::tools {

const char* const kPageScript = R"js('use strict';
(() => {
  const reach = 30;  // pixels from a point at which a pointer is on it
  const figures = JSON.parse(document.getElementById('figures').textContent);

  const element = (name, text) => {
    const made = document.createElement(name);
    made.textContent = text;
    return made;
  };
  const rowsOf = (key) =>
    [...document.querySelectorAll('tr[data-key]')].filter((row) => row.dataset.key === key);
  const middle = (point) => {
    const box = point.querySelector('.shape').getBoundingClientRect();
    return {x: box.left + box.width / 2, y: box.top + box.height / 2};
  };
  // Of a pointer from the area of a point, if it has one, or from the middle of its shape.
  const distance = (point, {clientX: x, clientY: y}) => {
    const hit = point.querySelector('.hit');
    if (!hit) return Math.hypot(middle(point).x - x, middle(point).y - y);
    const box = hit.getBoundingClientRect();
    return Math.hypot(Math.max(box.left - x, 0, x - box.right),
                      Math.max(box.top - y, 0, y - box.bottom));
  };

  const fill = (tip, key) => {
    const list = document.createElement('dl');
    for (const [name, value] of figures[key].values) {
      const pair = document.createElement('div');
      pair.append(element('dt', name), element('dd', value));
      list.append(pair);
    }
    tip.replaceChildren(element('strong', figures[key].title), list);
  };

  // Beside the point, within the drawing's width, above it in the lower half and below it in the
  // upper half.
  const move = (tip, canvas, at) => {
    const box = canvas.getBoundingClientRect();
    const x = at.x - box.left, y = at.y - box.top;
    const left = Math.max(0, Math.min(x - tip.offsetWidth / 2, box.width - tip.offsetWidth));
    tip.style.left = left + 'px';
    tip.style.top = (y > box.height / 2 ? y - tip.offsetHeight - 14 : y + 14) + 'px';
  };

  for (const canvas of document.querySelectorAll('.canvas')) {
    const svg = canvas.querySelector('svg'), tip = canvas.querySelector('.tip');
    const points = [...svg.querySelectorAll('.point')];
    let shown = null;

    const light = (point, on) => {
      point.classList.toggle('lit', on);
      for (const row of rowsOf(point.dataset.key)) row.classList.toggle('lit', on);
    };
    const show = (point) => {
      if (point === shown) return;
      if (shown) light(shown, false);
      shown = point;
      tip.classList.toggle('shown', point !== null);
      if (!point) return;
      light(point, true);
      fill(tip, point.dataset.key);
      move(tip, canvas, middle(point));
    };
    const nearest = (event) => {
      let best = null, least = reach;
      for (const point of points) {
        const away = distance(point, event);
        if (away <= least) [best, least] = [point, away];
      }
      return best;
    };
    // From left to right, then from top to bottom.
    const step = (by) => {
      const order = points.map((point) => [middle(point), point])
        .sort(([a], [b]) => a.x - b.x || a.y - b.y).map(([, point]) => point);
      const at = order.indexOf(shown);
      show(order[at < 0 ? (by > 0 ? 0 : order.length - 1)
                        : (at + by + order.length) % order.length]);
    };

    svg.addEventListener('pointermove', (event) => show(nearest(event)));
    svg.addEventListener('pointerdown', (event) => show(nearest(event)));
    svg.addEventListener('pointerleave', (event) => {
      if (event.pointerType !== 'touch') show(null);
    });
    svg.addEventListener('focus', () => {
      if (points.length > 0 && svg.matches(':focus-visible')) step(1);
    });
    svg.addEventListener('blur', () => show(null));
    svg.addEventListener('keydown', (event) => {
      const by = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
      if (event.key === 'Escape') show(null);
      if (!by || points.length === 0) return;
      step(by);
      event.preventDefault();
    });
  }
})();
)js";

}  // namespace planetree::tools
