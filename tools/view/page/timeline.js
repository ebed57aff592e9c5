// What happened in a recorded session: pages by time.

import {cssColour, sized} from './pages.js';

function drawShares(canvas, {rows, shares}, windows, colour) {
  const context = sized(canvas);
  context.fillStyle = cssColour('--page');
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = cssColour(colour);
  const [w, h] = [canvas.width / windows, canvas.height / rows];
  for (let row = 0; row < rows; ++row)
    for (let at = 0; at < windows; ++at) {
      context.globalAlpha = shares[row * windows + at];
      context.fillRect(at * w, row * h, Math.ceil(w), Math.ceil(h));
    }
  context.globalAlpha = 1;
}

function drawBars(canvas, values, colour) {
  const context = sized(canvas);
  context.fillStyle = cssColour('--page');
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = cssColour(colour);
  const most = Math.max(1, ...values), w = canvas.width / values.length;
  values.forEach((value, at) => {
    const h = value / most * canvas.height;
    context.fillRect(at * w, canvas.height - h, Math.ceil(w), h);
  });
}

const sum = (values) => values.reduce((total, value) => total + value, 0);

export function showTimeline(timeline) {
  if (!timeline) return () => {};
  const windows = timeline.lookups.length;
  const seconds = windows * timeline.window_ms / 1000;
  const [lookups, misses, degraded] = [timeline.lookups, timeline.misses, timeline.degraded].map(sum);
  document.getElementById('timeline').hidden = false;
  document.getElementById('timeline-text').textContent =
    `${seconds.toFixed(1)} s from left to right; ${timeline.pages.toLocaleString('en-US')} pages from the coarse ` +
    `at the top to the fine. ${lookups.toLocaleString('en-US')} lookups, ${misses.toLocaleString('en-US')} of them ` +
    `lacked a page, ${degraded.toLocaleString('en-US')} degraded answers.`;
  const [lookedUp, resident, missed] = ['looked-up', 'resident', 'misses'].map((id) => document.getElementById(id));
  lookedUp.setAttribute('aria-label', `Pages that queries looked up, over ${seconds.toFixed(1)} s`);
  resident.setAttribute('aria-label', `Pages in memory: ${Math.max(...timeline.resident_pages)} at most`);
  missed.setAttribute('aria-label', `Lookups that lacked a page: ${misses} in all`);
  const draw = () => {
    drawShares(lookedUp, timeline.looked_up, windows, '--accent');
    drawShares(resident, timeline.resident, windows, '--resident');
    drawBars(missed, timeline.misses, '--wanted');
  };
  new ResizeObserver(draw).observe(lookedUp);
  draw();
  return draw;
}
