// The page of `planetree view`.

import {AnswerPanel, text} from './answer.js';
import {hasPicture} from './built.js';
import {InstancesPanel, nameOf} from './instances.js';
import {PagesPanel} from './pages.js';
import {Probe} from './probe.js';
import {showTimeline} from './timeline.js';

const byId = (id) => document.getElementById(id);
const kStep = 4;  // dots of the screen for a press of a key
const kStatsMs = 150;

const kLegends = [
  [],
  [['front', 'front, where normals point to'], ['back', 'back']],
  [['ramp', 'from the root to the finest level drawn']],
  [['resident', 'page in memory'], ['wanted', 'wanted'], ['evicted', 'evicted'], ['unread', 'not read']],
  [],
];

function alertOf(error) {
  byId('alert').hidden = false;
  byId('alert').textContent = error instanceof TypeError
    ? 'The session has ended: planetree view does not answer. Start it again and open its new address.'
    : `The data cannot be read: ${error.message}`;
}

function showLegend(mode) {
  byId('legend').hidden = kLegends[mode].length === 0;
  byId('legend').replaceChildren(...kLegends[mode].map(([key, words]) => {
    const item = document.createElement('li'), patch = document.createElement('span');
    patch.className = `key ${key}`;
    item.append(patch, words);
    return item;
  }));
}

function showFacts(info) {
  byId('file').textContent = info.file;
  document.title = `${info.file} - planetree view`;
  const size = info.core_upper.map((value, i) => text(value - info.core_lower[i], 4));
  const count = (number) => number.toLocaleString('en-US');
  byId('facts').textContent = [
    ...(info.instances
      ? [`${count(info.instances.length)} instances of ${count(info.models.length)} models`, `${count(info.triangles)} triangles`]
      : [`${count(info.triangles)} triangles`, info.watertight ? 'watertight' : 'not watertight', `${count(info.pages)} pages`]),
    `${size.join(' × ')} units`, `${(info.memory_bytes / 1048576).toFixed(0)} MiB of memory`].join(' · ');
  byId('stage').setAttribute('aria-label', `The surface of ${info.file} and the probe`);
}

// Beside a box, as the camera sees it at first; within the ball around it, which the view shows.
function placeBeside(lower, upper) {
  const direction = [0.5, 0.38, -0.05], edges = upper.map((value, i) => value - lower[i]);
  const length = Math.min(Math.max(...edges), 0.7 * Math.hypot(...edges));
  return lower.map((value, i) => (value + upper[i]) / 2 + length * direction[i]);
}

function explain(stage, words) {
  const place = byId('no-picture');
  place.hidden = false;
  place.textContent = words;
  for (const id of ['hint', 'notice', 'legend']) byId(id).hidden = true;
  document.querySelector('.tools').hidden = true;
  stage.classList.add('plain');
}

function hasWebGl() {
  const context = document.createElement('canvas').getContext('webgl2');
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return context !== null;
}

// The picture, or null with the reason on the page.
async function makePicture(stage, info, probe) {
  if (!hasPicture) {
    explain(stage, 'This planetree was built without three.js, so that it draws no picture. ' +
      'docs/view.md says how to add it. The numbers work as ever: move the probe by keys here, or give its position.');
    return null;
  }
  if (!hasWebGl()) {
    explain(stage, 'This browser has no WebGL 2, so that there is no picture. ' +
      'The numbers work as ever: move the probe by keys here, or give its position.');
    return null;
  }
  const {Picture} = await import('./picture.js');
  return new Picture(stage, info, probe);
}

function listenToKeys(stage, picture, probe, info) {
  const longest = Math.max(...info.core_upper.map((value, i) => value - info.core_lower[i]));
  const move = (right, up, away) => {
    if (picture) picture.moveProbe(right, up, away);
    else probe.moveTo(probe.position.map((value, i) => value + [right, up, -away][i] * longest / 1000));
  };
  const steps = {ArrowRight: [1, 0, 0], ArrowLeft: [-1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0],
                 PageUp: [0, 0, 1], PageDown: [0, 0, -1]};
  const turns = {a: [-0.1, 0], d: [0.1, 0], w: [0, 0.1], s: [0, -0.1], '+': [0, 0, 0.8], '=': [0, 0, 0.8], '-': [0, 0, 1.25]};
  stage.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = steps[event.key], turn = turns[event.key.toLowerCase()];
    const size = event.shiftKey ? 10 * kStep : kStep;
    if (step) move(...step.map((share) => share * size));
    else if (picture && turn) picture.turn(...turn);
    else if (picture && event.key === '0') picture.reset();
    else return;
    event.preventDefault();
  });
}

function listenToForm(probe) {
  const fields = ['x', 'y', 'z'].map(byId);
  const show = () => fields.forEach((field, i) => {
    if (document.activeElement !== field) field.value = Number(probe.position[i].toPrecision(7));
  });
  fields.forEach((field, i) => field.addEventListener('input', () => {
    if (field.value !== '') probe.moveTo(probe.position.map((value, at) => at === i ? Number(field.value) : value));
  }));
  byId('within').value = Number(probe.within.toPrecision(4));
  byId('within').addEventListener('input', () => {
    if (byId('within').value !== '') probe.setWithin(Number(byId('within').value));
  });
  byId('place').addEventListener('submit', (event) => event.preventDefault());
  probe.onChange(show);
}

function listenToTools(picture, pages) {
  byId('colour').addEventListener('change', () => {
    const mode = Number(byId('colour').value);
    picture.setMode(mode);
    showLegend(mode);
  });
  byId('up').addEventListener('change', () => picture.setUp(byId('up').value));
  byId('reset').addEventListener('click', () => picture.reset());
  picture.onDrawn = (shape) => {
    byId('drawn').textContent = `${shape.discs.toLocaleString('en-US')} discs, ${shape.triangles.toLocaleString('en-US')} triangles`;
  };
  picture.onError = alertOf;
  pages.onStates = (states) => picture.setPages(states);
  byId('stage').addEventListener('pointerdown', () => { byId('hint').hidden = true; }, {once: true});
  showLegend(0);
}

function listInstances(info, picture, probe) {
  return new InstancesPanel(info, (index) => {
    const {box_lower: lower, box_upper: upper} = info.instances[index];
    picture?.lookAt(lower, upper);
    probe.moveTo(placeBeside(lower, upper));
  });
}

// What the data does not have cannot be a colour.
function offerColours(info) {
  for (const option of [...byId('colour').options])
    if (option.value === (info.instances ? '3' : '4')) option.remove();
}

async function main() {
  const info = await (await fetch('info')).json();
  showFacts(info);
  offerColours(info);
  const longest = Math.max(...info.core_upper.map((value, i) => value - info.core_lower[i]));
  const probe = new Probe(placeBeside(info.core_lower, info.core_upper), longest / 4);
  const stage = byId('stage'), pages = new PagesPanel(!info.instances);
  const panel = new AnswerPanel(info.instances ? (index) => nameOf(info, index) : null);
  const picture = await makePicture(stage, info, probe);
  const instances = info.instances ? listInstances(info, picture, probe) : null;
  if (picture) listenToTools(picture, pages);
  listenToKeys(stage, picture, probe, info);
  listenToForm(probe);
  let timer = 0;
  probe.onChange((answer, error) => {
    if (error) return alertOf(error);
    if (answer) panel.show(answer, probe.isGivenUp());
    if (answer) instances?.mark(answer.instance);
    picture?.showAnswer(answer);
    // Pages come after answers that lacked some.
    if (answer && timer === 0)
      timer = setTimeout(() => { timer = 0; pages.update().catch(alertOf); }, kStatsMs);
  });
  probe.moveTo(probe.position);
  const redraw = showTimeline(await (await fetch('timeline')).json());
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { pages.draw(); redraw(); });
}

main().catch(alertOf);
